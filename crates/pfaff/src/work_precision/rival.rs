//! Ways to simulate a mechanism that are not part of this program, in rows of the same table.

use std::time::Duration;

use dynamics::PreparedMechanism;
use report::{CurveName, WorkPrecisionRow};

use super::observation::Observation;
use super::plan::ComparisonPlan;
use super::standard::{Errors, Standard};
use super::{GIVEN_UP, Subject};

/// A way to simulate a mechanism that is not part of this program.
pub trait Rival {
    /// Returns the name of the method in tables.
    fn name(&self) -> CurveName;

    /// Performs one run from the start to the last instant, with a row at each instant (s,
    /// ascending) and with equal relative and absolute tolerances. The run stops after its limit of
    /// computing time.
    ///
    /// # Errors
    /// Returns an error, with the reason as text, if the run was abandoned or stopped before the
    /// last instant.
    fn run(
        &self,
        start: &PreparedMechanism,
        tolerance: f64,
        instants: &[f64],
        budget: Duration,
    ) -> Result<RivalRun, RivalFault>;
}

/// Reason why a rival did not reach its last instant, as text.
#[derive(Clone, Debug, PartialEq)]
pub enum RivalFault {
    /// The run used up its limit of computing time.
    GivenUp(String),
    /// Any other reason.
    Stopped(String),
}

/// Results of a run of another library.
#[derive(Clone, Debug)]
pub struct RivalRun {
    /// Rows at the instants.
    pub observations: Vec<Observation>,
    /// Evaluations of accelerations.
    pub evaluations: u64,
    /// Projections of steps.
    pub projections: u64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Computing time (s).
    pub seconds: f64,
}

/// Performs runs of a rival at one tolerance and returns a row, or `None` if interrupted.
pub(super) fn row(
    subject: &Subject,
    rival: &dyn Rival,
    empty: WorkPrecisionRow,
    plan: &ComparisonPlan,
    standard: Option<&Standard>,
    interrupted: &(impl Fn() -> bool + Sync),
) -> Option<WorkPrecisionRow> {
    let empty = WorkPrecisionRow {
        reference_limit: standard.map_or(f64::NAN, Standard::motion_limit),
        ..empty
    };
    let budget = Duration::try_from_secs_f64(plan.budget).unwrap_or(Duration::MAX);
    let (instants, tolerance) = (subject.instants(), empty.tolerance);
    let mut best: Option<RivalRun> = None;
    let (mut repetitions, mut total) = (0, 0.0);
    while repetitions < plan.repetitions.max(1) || total < plan.seconds {
        if interrupted() {
            return None;
        }
        let made = match rival.run(subject.prepared(), tolerance, instants, budget) {
            Ok(made) => made,
            Err(fault) => {
                let status = match fault {
                    RivalFault::GivenUp(words) => format!("{GIVEN_UP}: {words}"),
                    RivalFault::Stopped(words) => format!("stopped: {words}"),
                };
                return Some(WorkPrecisionRow { status, ..empty });
            }
        };
        (repetitions, total) = (repetitions + 1, total + made.seconds);
        if best.as_ref().is_none_or(|b| made.seconds < b.seconds) {
            best = Some(made);
        }
    }
    let Some(best) = best else { return Some(empty) };
    let errors = standard.and_then(|s| s.errors(&best.observations));
    let errors = errors.unwrap_or(Errors::UNKNOWN);
    Some(WorkPrecisionRow {
        errors: errors.scaled,
        error_state: errors.state,
        evaluations: best.evaluations,
        projections: best.projections,
        steps: best.steps,
        rejected: best.rejected,
        seconds: best.seconds,
        repetitions,
        ..empty
    })
}
