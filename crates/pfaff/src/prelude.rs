//! The names that a program needs to build, analyse and simulate a mechanism:
//! `use pfaff::prelude::*;`. The other joints and forces are in [`joints`], and the documents in
//! [`crate::documents`].

pub use dynamics::MotionOptions;
pub use joints::{Direction, KnifeEdge, Revolute, Translational};
pub use model::{Body, BodyRef, Description, Function, Registry};
pub use scene::Scene;

pub use crate::configuration::ConfigurationAnalysis;
pub use crate::error::StudyError;
pub use crate::run_options::RunOptions;
pub use crate::study::Study;
