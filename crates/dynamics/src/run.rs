//! Runs a plan. A run consists of the integration of q̇ = T·v and of the solved accelerations, the
//! projection after each step, projected output rows, and the energy balance.

use std::ops::ControlFlow;

mod by_time;
mod caller;
mod component;
mod contacts;
mod energy;
mod equations;
mod impulse;
mod integration;
mod passages;
mod permits;
mod record;
mod reduced;
mod sample;
mod several;
mod simulator;
mod span;
mod summary;
#[cfg(test)]
mod tests;
mod verdicts;

use crate::code::SceneCode;
use crate::error::MotionFault;
use crate::options::MotionOptions;
use crate::plan::{OutputRequest, Plan};
use crate::prepare::PreparedMechanism;
use caller::ShowRow;
use component::run_component;

pub use caller::{Stop, Watch};
pub use reduced::ReducedJacobian;
pub(crate) use reduced::derivatives;
pub use sample::{ChosenReactions, Sample};
pub use simulator::Simulator;
pub use summary::{ComponentSummary, DroppedRows, Failure, Summary};

/// Runs a prepared mechanism from its start. The function `row` is called for the rows at the
/// start, at every output step and at the end. The plan requests all output.
///
/// ```
/// use std::ops::ControlFlow;
/// use pfaff_dynamics::{MotionOptions, RowChoice, prepare, simulate};
/// use joints::{Revolute, RevoluteAngleDrive};
/// use model::{Body, BodyRef, Description, Law, Mechanism, StartOptions};
/// // A wheel that a controller brings to 2 rad, without overshoot: J = 0.5, k = 8, c = 2·√(k·J).
/// let mut d = Description::new("wheel");
/// let wheel = d.body(Body::new("wheel", 1.0, 0.5));
/// let (bodies, o) = ([BodyRef::Ground, wheel], [0.0, 0.0]);
/// d.joint("shaft", &bodies, Revolute { s_i: o, s_j: o });
/// let controller = Law::called(|at| Ok(8.0 * (2.0 - at.measure) - 4.0 * at.rate));
/// d.drive_by_law("motor", &bodies, RevoluteAngleDrive::new(o, o), controller)?;
/// let mechanism = Mechanism::build(&d).unwrap();
/// let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?;
/// let mut angle = 0.0;
/// simulate(&prepared, &MotionOptions::to(1.0), |row| {
///     angle = row.q[2];
///     Ok(ControlFlow::Continue(()))
/// })?;
/// // φ = 2 − 2·(1 + p·t)·e^(−p·t) with p = √(k/J) = 4.
/// assert!((angle - (2.0 - 10.0 * (-4.0_f64).exp())).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns a failure with the summary of the completed part. Rows passed before remain valid.
pub fn simulate(
    prepared: &PreparedMechanism,
    options: &MotionOptions,
    row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
) -> Result<Summary, Box<Failure>> {
    simulate_until(prepared, options, &|| false, row)
}

/// Works like [`simulate`], but `stop` is called at each evaluation. When `stop` returns true, the
/// run ends at the last accepted step.
///
/// # Errors
/// Returns the same errors as [`simulate`].
pub fn simulate_until(
    prepared: &PreparedMechanism,
    options: &MotionOptions,
    stop: &Stop<'_>,
    row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
) -> Result<Summary, Box<Failure>> {
    Plan::new(prepared, options, &OutputRequest::default())
        .map_err(component::not_begun)?
        .simulate_watched(&|_| ControlFlow::Continue(()), stop, row)
}

impl Plan<'_> {
    /// Runs the plan from the start and passes its rows to `row`.
    ///
    /// # Errors
    /// Returns a failure with the summary of the completed part. Rows passed before remain valid.
    pub fn simulate(
        &self,
        row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
    ) -> Result<Summary, Box<Failure>> {
        self.simulate_watched(&|_| ControlFlow::Continue(()), &|| false, row)
    }

    /// Works like [`Plan::simulate`], with two more functions. `watch` is called at each accepted
    /// step, also between rows. `stop` is called at each evaluation. When `stop` returns true, the
    /// run ends at the last accepted step.
    ///
    /// # Errors
    /// Returns the same errors as [`Plan::simulate`].
    pub fn simulate_watched(
        &self,
        watch: &Watch<'_>,
        stop: &Stop<'_>,
        mut row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
    ) -> Result<Summary, Box<Failure>> {
        self.go((watch, stop), None, &mut row)
    }

    /// Works like [`Plan::simulate_watched`], but `evaluator` evaluates the code of the mechanism.
    /// The evaluator must return the results of this code. This function is for callers that
    /// evaluate several runs at the same time. A plan without code runs as usual.
    ///
    /// # Errors
    /// Returns the same errors as [`Plan::simulate`].
    pub fn simulate_evaluated(
        &self,
        evaluator: &dyn SceneCode,
        stop: &Stop<'_>,
        mut row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
    ) -> Result<Summary, Box<Failure>> {
        self.go(
            (&|_| ControlFlow::Continue(()), stop),
            Some(evaluator),
            &mut row,
        )
    }

    fn go(
        &self,
        watched: (&Watch<'_>, &Stop<'_>),
        evaluator: Option<&dyn SceneCode>,
        row: &mut ShowRow<'_>,
    ) -> Result<Summary, Box<Failure>> {
        match self.components.len() {
            1 => run_component(self, 0, watched, evaluator, row),
            _ => several::run(self, watched, row),
        }
    }
}
