#![doc = include_str!("../README.md")]
//!
//! # Code map, in the order of the data
//!
//! | module | content |
//! | --- | --- |
//! | [`options`] | options of a run |
//! | [`mod@prepare`] | consistent start, decided rank, independent rows |
//! | [`code`] | interface to code that was generated for one mechanism |
//! | [`plan`] | the computations that a run does and omits, with reasons |
//! | `solve` | accelerations and multipliers at a state: by the null space, the Schur complement, refinement or generated code |
//! | `manifold` | moves states onto the constraint manifold and along it; only this module writes q and v |
//! | `watch` | checks the ends of steps: pivots, exchange of independent rows, singular configurations, generated code |
//! | [`motion`] | combines `solve`, `manifold` and `watch` for one mechanism |
//! | [`run`] | a run: integration, projected output, energy balance |
//! | [`events`] | events during a run |
//! | [`mod@linearise`] | small motions about an equilibrium or a steady motion |
//! | `limits` | every threshold, with the reason for its value |

mod choose;
pub mod code;
mod counts;
mod differences;
pub mod equilibrium;
mod error;
pub mod events;
mod guards;
mod held;
mod limits;
pub mod linearise;
mod manifold;
pub mod motion;
pub mod options;
pub mod plan;
pub mod prepare;
pub mod run;
mod solve;
mod watch;

pub use code::{CodeInput, CodeInputs, CodeMismatch, CodeSpec, NoCode, SceneCode};
pub use error::{DropError, MotionError, MotionFault};
pub use events::{Event, EventKind, ReactionImpulse};
pub use manifold::Correction;
pub use motion::KeptRowMotion;
pub use options::{FORMULATION, INDEPENDENT_ROWS, Method, MotionOptions, RowChoice, Stabilisation};
pub use plan::{OutputRequest, Plan};
pub use prepare::{PreparedMechanism, prepare, prepare_after, start_velocity, unmovable};
pub use run::{
    ChosenReactions, ComponentSummary, DroppedRows, Failure, ReducedJacobian, Sample, Simulator,
    Stop, Summary, simulate, simulate_until,
};
pub use solve::Misfit;
