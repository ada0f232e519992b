//! A run as planned: integration of q̇ = T·v and the solved accelerations, projection after each
//! step, projected rows of output, and the balance of energy.

use std::ops::ControlFlow;

mod by_time;
mod component;
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
mod span;
mod summary;

use crate::error::MotionFault;
use crate::options::MotionOptions;
use crate::plan::{Plan, Wanted};
use crate::prepare::Prepared;
use component::run_component;

pub use component::Watch;
pub use reduced::Reduced;
pub use sample::Sample;
pub use summary::{ComponentSummary, Failure, Summary};

/// Runs a prepared mechanism from t = 0 and shows rows at 0, every output step and the end: its
/// plan with everything wanted.
///
/// # Errors
/// With the summary of what was reached; rows shown before stand.
pub fn simulate(
    prepared: &Prepared,
    options: &MotionOptions,
    row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
) -> Result<Summary, Box<Failure>> {
    Plan::new(prepared, options, &Wanted::default())
        .map_err(component::not_begun)?
        .simulate(row)
}

impl Plan<'_> {
    /// Runs it from t = 0 and shows its rows.
    ///
    /// # Errors
    /// With the summary of what was reached; rows shown before stand.
    pub fn simulate(
        &self,
        row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
    ) -> Result<Summary, Box<Failure>> {
        self.simulate_watched(&|_| ControlFlow::Continue(()), row)
    }

    /// The same, watched between rows, too.
    ///
    /// # Errors
    /// As [`Plan::simulate`].
    pub fn simulate_watched(
        &self,
        watch: &Watch<'_>,
        mut row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
    ) -> Result<Summary, Box<Failure>> {
        match self.components.len() {
            1 => run_component(self, 0, watch, &mut row),
            _ => several::run(self, watch, &mut row),
        }
    }
}
