//! What a program needs that builds a mechanism, asks and moves it: `use pfaff::prelude::*;`. The
//! other joints and forces are in [`joints`], what comes out in [`report::documents`].

pub use dynamics::MotionOptions;
pub use joints::{Direction, KnifeEdge, Revolute, Translational};
pub use model::{Body, BodyRef, Description, Function, Registry};
pub use scene::Scene;

pub use crate::configuration::ConfigurationAnalysis;
pub use crate::error::StudyError;
pub use crate::study::{Overrides, Study};
