#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`ring`] | the number types kernels run on |
//! | [`recorded`] | the one that writes down what is done with it |
//! | [`plane`] | poses and twists of planar bodies |
//! | [`spec`] | what a definition says of itself: rows, parameters, patterns, counts |
//! | [`arguments`] | values for the parameters of a definition |
//! | [`definition`] | what constraints and forces store, as objects |
//! | [`constraint`] | the traits of constraints: a definition as a type, and its kernels |
//! | [`force`] | the same for forces |
//! | [`visitor`] | all definitions, one after the other, with their types |
//! | [`generated`] | one module for each file in `definitions/` |

pub mod arguments;
pub mod constraint;
pub mod definition;
pub mod force;
pub mod generated;
pub mod plane;
pub mod recorded;
pub mod ring;
pub mod spec;
pub mod visitor;

pub use arguments::{Argument, ArgumentError};
pub use constraint::{Constraint, Element};
pub use definition::Definition;
pub use force::{Force, ForceElement};
pub use generated::*;
pub use plane::{Direction, Line, Pose, Twist};
pub use recorded::Recorded;
pub use ring::{Magnitude, Real, Ring};
pub use spec::{ConstraintSpec, ForceSpec};
pub use visitor::Visitor;
