#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`program`] | constraint rows as programs that run in any number type |
//! | [`ring`] | the number types of kernels |
//! | [`recorded`] | a number type that records its operations |
//! | [`slopes`] | derivatives with dual numbers |
//! | [`space`] | the plane and three-dimensional space as types |
//! | [`plane`], [`space3`] | poses and twists of bodies, and directions fixed in bodies |
//! | [`spec`] | specifications of definitions: rows, parameters, sparsity patterns, numbers of entries |
//! | [`arguments`] | values for the parameters of a definition |
//! | [`definition`] | the values stored by constraints and forces |
//! | [`element`] | the kernels of constraints in several number types: rows and reaction |
//! | [`constraint`] | a constraint definition as a type, and all its kernels |
//! | [`force`] | a force definition as a type, and its kernels |
//! | [`visitor`] | iteration over all definitions as types |
//! | [`generated`] | one module for each file in `definitions/` |

pub mod arguments;
pub mod constraint;
pub mod definition;
pub mod element;
pub mod force;
pub mod generated;
pub mod plane;
pub mod program;
pub mod recorded;
pub mod ring;
pub mod slopes;
pub mod space;
pub mod space3;
pub mod spec;
pub mod visitor;

pub use arguments::{Argument, ArgumentError, LARGEST, is_usable};
pub use constraint::{Constraint, ConstraintKernels};
pub use definition::Definition;
pub use element::{Element, Reaction};
pub use force::{Force, ForceElement};
pub use generated::*;
pub use plane::{Direction, Line, Pose, Twist};
pub use program::{Programs, Rows};
pub use recorded::RecordedNumber;
pub use ring::{Magnitude, Real, Ring, Scalar};
pub use slopes::{SlopedOutputs, Slopes};
pub use space::{Plane, Space, Space3};
pub use spec::{ConstraintSpec, ForceSpec};
pub use visitor::Visitor;
