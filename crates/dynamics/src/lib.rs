#![doc = include_str!("../README.md")]
//!
//! # Code map, in the order of the data
//!
//! | module | content |
//! | --- | --- |
//! | [`options`] | what a run is asked to do |
//! | [`mod@prepare`] | consistent start, decided rank, kept rows |
//! | [`code`] | what a run asks of code generated for one mechanism |
//! | [`motion`] | the solved equations on kept rows: acceleration, projection, reactions, monitors |
//! | [`events`] | what happened on the way |
//! | [`mod@simulate`] | a run: integration, projected output, energy balance |

mod choose;
pub mod code;
mod error;
pub mod events;
pub mod motion;
pub mod options;
pub mod prepare;
pub mod simulate;

pub use code::{CodeMismatch, Facts, NoCode, SceneCode};
pub use error::{MotionError, Trip};
pub use events::{Event, EventKind};
pub use motion::{Correction, KeptRowMotion, Motion, Reduced};
pub use options::{Formulation, Method, MotionOptions, RowChoice, Stabilisation};
pub use prepare::{Prepared, prepare};
pub use simulate::{Failure, Sample, Summary, simulate};
