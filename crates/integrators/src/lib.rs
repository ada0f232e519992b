#![doc = include_str!("../README.md")]
//!
//! ## Code map
//!
//! | module | idea |
//! | --- | --- |
//! | `ode` | the problem: [`Ode`], the hook at the end of a step |
//! | `interval` | where to integrate: [`Interval`], break times, one-sided evaluation |
//! | `options` | how to integrate: [`Options`], [`Tolerance`], [`InitialStep`] |
//! | `method` | the choice of a method and what a method must provide |
//! | `drive` | the loop of trials, rejections and accepted steps, shared by all methods |
//! | `control`, `start` | step-size control and the automatic first step |
//! | `step` | an accepted step with its dense output: [`Step`] |
//! | `sample` | rows at given output times: [`sample()`] |
//! | `implicit` | problems with a Jacobian: [`Implicit`] |
//! | `dense_implicit` | a plain problem with a dense Jacobian: [`DenseImplicit`] |
//! | `dopri5` | Dormand–Prince 5(4): `tableau`, `step`, `dense` |
//! | `radau5` | Radau IIA of order 5: `tableau`, `scale`, `newton`, `step`, `dense` |
//! | `constrained` | problems with constraints as equations of their own: [`Constrained`] |
//! | `hem4` | half-explicit Runge–Kutta method of order 4: `tableau`, `step` |
//! | `generalized_alpha` | generalized-α on positions: `newton`, `step` |
//! | `convergence` | when Newton's iterations end |
//! | `hermite` | dense output from both ends of a step |

#![forbid(unsafe_code)]

mod constrained;
mod control;
mod convergence;
mod dense_implicit;
mod dopri5;
mod drive;
mod error;
mod generalized_alpha;
mod hem4;
mod hermite;
mod implicit;
mod interval;
mod method;
mod ode;
mod options;
mod radau5;
mod sample;
mod start;
mod statistics;
mod step;

pub use constrained::{Constrained, Linearisation, Sizes, Target};
pub use dense_implicit::{DenseError, DenseImplicit, Differences, Jacobian};
pub use dopri5::Dopri5;
pub use error::{Cause, Failure, IntegrationError};
pub use generalized_alpha::GeneralizedAlpha;
pub use hem4::Hem4;
pub use implicit::Implicit;
pub use interval::Interval;
pub use method::{End, Method, Outcome, integrate};
pub use ode::{Function, Ode, StepEnd, StepInfo};
pub use options::{InitialStep, Options, Tolerance};
pub use radau5::Radau5;
pub use sample::{OutputTimes, sample};
pub use statistics::Statistics;
pub use step::{OutputError, Step};
