#![doc = include_str!("../README.md")]
//!
//! ## Code map
//!
//! | module | content |
//! | --- | --- |
//! | `ode` | the problem: [`Ode`], the hook at the end of a step |
//! | `interval` | the interval: [`Interval`], break times, one-sided evaluation |
//! | `options` | options: [`Options`], [`Tolerance`], [`InitialStep`] |
//! | `method` | the choice of a method, and the interface of a method |
//! | `drive` | the loop of trials, rejections and accepted steps, shared by all methods |
//! | `control`, `start` | step-size control and the automatic first step |
//! | `step` | an accepted step with its dense output: [`Step`] |
//! | `events`, `root` | zeros of a function of the solution: [`Crossings`] in observers, [`integrate_until`] otherwise |
//! | `rows`, `sample` | rows at given output times: [`Rows`] in observers, [`sample()`] otherwise |
//! | `combine` | sums of stages |
//! | `rk5` | Dormand–Prince 5(4) and Tsitouras 5(4): `dopri5` and `tsit5` (tables), `step`, `dense` |
//! | `dop853` | Dormand–Prince 8(5,3): `tableau`, `step`, `dense` |
//! | `implicit` | problems with a Jacobian: [`Implicit`] |
//! | `dense_implicit` | a plain problem with a dense Jacobian: [`DenseImplicit`] |
//! | `radau5` | Radau IIA of order 5: `tableau`, `scale`, `newton`, `step`, `dense` |
//! | `convergence` | convergence test of Newton's iterations |

#![forbid(unsafe_code)]

mod combine;
mod control;
mod convergence;
mod dense_implicit;
mod dop853;
mod drive;
mod error;
mod events;
mod implicit;
mod interval;
mod method;
mod ode;
mod options;
mod radau5;
mod rk5;
mod root;
mod rows;
mod sample;
mod start;
mod statistics;
mod step;

#[cfg(test)]
mod trees;

pub use dense_implicit::{DenseError, DenseImplicit, Differences, Jacobian};
pub use dop853::Dop853;
pub use drive::integrate;
pub use error::{Cause, Failure, IntegrationError};
pub use events::{Crossing, Crossings, Direction, integrate_until};
pub use implicit::Implicit;
pub use interval::Interval;
pub use method::{End, Method, Outcome};
pub use ode::{Delicate, Function, Ode, StepEnd, StepInfo};
pub use options::{InitialStep, Options, Tolerance};
pub use radau5::Radau5;
pub use rk5::{Dopri5, Tsit5};
pub use rows::{OutputTimes, Rows};
pub use sample::sample;
pub use statistics::Statistics;
pub use step::{OutputError, Step};
