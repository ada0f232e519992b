#![doc = include_str!("../README.md")]
//!
//! # Code map, in the order of the data
//!
//! | module | content |
//! | --- | --- |
//! | [`options`] | what a run is asked to do |
//! | [`mod@prepare`] | consistent start, decided rank, kept rows |
//! | [`code`] | what a run asks of code generated for one mechanism |
//! | [`plan`] | what a run does and leaves out, with reasons |
//! | [`motion`] | the solved equations on kept rows: acceleration, projection, reactions, monitors |
//! | [`events`] | what happened on the way |
//! | [`mod@simulate`] | a run: integration, projected output, energy balance |

mod choose;
pub mod code;
mod counts;
mod error;
pub mod events;
mod guards;
pub mod motion;
pub mod options;
pub mod plan;
pub mod prepare;
pub mod simulate;

pub use code::{CodeMismatch, Facts, NoCode, SceneCode};
pub use error::{DropError, MotionError, MotionFault};
pub use events::{Event, EventKind};
pub use motion::{Correction, KeptRowMotion, Motion, Reduced};
pub use options::{FORMULATION, Method, MotionOptions, RowChoice, Stabilisation};
pub use plan::{Plan, Wanted};
pub use prepare::{Prepared, prepare, start_velocity};
pub use simulate::{ComponentSummary, Failure, Sample, Summary, simulate};
