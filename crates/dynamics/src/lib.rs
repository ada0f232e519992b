#![doc = include_str!("../README.md")]
//!
//! # Code map, in the order of the data
//!
//! | module | content |
//! | --- | --- |
//! | [`options`] | options of a run |
//! | [`mod@prepare`] | consistent start, decided rank, kept rows |
//! | [`code`] | what a run needs from code generated for one mechanism |
//! | [`plan`] | what a run does and omits, with reasons |
//! | `solve` | accelerations and multipliers at a state: null space, Schur complement, refined, generated |
//! | `manifold` | moves states onto the constraints and along them; the only writer of q and v |
//! | `watch` | checks the ends of steps: pivots, exchange of rows, singular passages, code |
//! | [`motion`] | these three for one mechanism |
//! | [`run`] | a run: integration, projected output, energy balance |
//! | [`events`] | events during a run |
//! | [`mod@linearise`] | small motions about a state at rest or a steady one |
//! | `limits` | every threshold, with its reason |

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
pub use options::{FORMULATION, Method, MotionOptions, RowChoice, Stabilisation};
pub use plan::{OutputRequest, Plan};
pub use prepare::{PreparedMechanism, prepare, prepare_after, start_velocity, unmovable};
pub use run::{
    ChosenReactions, ComponentSummary, DroppedRows, Failure, ReducedJacobian, Sample, Stop,
    Summary, simulate, simulate_until,
};
pub use solve::Misfit;
