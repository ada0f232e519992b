//! From an assembled mechanism to one that can move: a consistent start, a decided rank, kept rows. The rank is
//! decided here, at a polished point, and nowhere else during a run.

use std::sync::Arc;

use linalg::RankStatus;
use model::start::{assemble, consistent_velocity, velocity_correction};
use model::{Assembly, Mechanism, StartOptions, System};
use solvability::{RowDecision, Rows, decide_rows_dropping, rows as rows_of};

use crate::code::SceneCode;
use crate::error::{DropError, MotionError};
use crate::options::{Method, MotionOptions, RowChoice, Stabilisation};

/// A mechanism with a consistent start and kept rows.
#[derive(Clone)]
#[non_exhaustive]
pub struct Prepared {
    /// The mechanism, with initial values taken from the start.
    pub mechanism: Mechanism,
    /// Coordinates at t = 0.
    pub q: Vec<f64>,
    /// Velocities at t = 0.
    pub v: Vec<f64>,
    /// What was asked of the rows.
    pub choice: RowChoice,
    /// Rank and kept rows of C.
    pub decision: RowDecision,
    /// Rank and kept rows of Φq alone: what holds the configuration.
    pub position_decision: RowDecision,
    /// The decisions of the start part by part, which its verdicts are read from; `None` for a component of another mechanism.
    pub decided: Option<Arc<Rows>>,
    /// How the configuration was assembled.
    pub assembly: Assembly,
    /// Velocities at the start minus the described ones.
    pub velocity_correction: Vec<f64>,
    /// Code generated for this mechanism on these rows, if there is some: see [`Prepared::with_code`].
    pub(crate) code: Option<Arc<dyn SceneCode>>,
}

impl Prepared {
    /// Bytes that a run takes at most, about, beside the mechanism itself: solvers, stages, rows of output. An estimate from patterns alone.
    #[must_use]
    pub fn memory(&self) -> usize {
        crate::motion::memory(self)
    }

    /// Whether a run evaluates the state as a function of time: no coordinate and no velocity is free, and the run evaluates derivatives
    /// of states alone, on kept rows.
    pub(crate) fn is_function_of_time(&self, options: &MotionOptions) -> bool {
        let layout = self.mechanism.layout();
        let is_held = self.decision.rank == layout.n_v && self.position_decision.rank == layout.n_q;
        let evaluates_states = !matches!(options.method, Method::Hem4 | Method::GeneralizedAlpha);
        let on_kept_rows = options.formulation.drops_rows();
        is_held
            && evaluates_states
            && on_kept_rows
            && options.stabilisation == Stabilisation::Projection
    }
}

/// Assembles the start, decides the rank there, chooses rows, and makes the velocities consistent.
///
/// # Errors
/// - [`MotionError::Start`]: no consistent configuration or velocities.
/// - [`MotionError::Contradiction`]: redundant rows ask for different positions, velocities or accelerations.
/// - [`MotionError::Inseparable`]: independent rows differ by too little to move on.
/// - [`MotionError::RankUndecided`], [`MotionError::Rows`]: no rows can be chosen, or not the ones asked for.
pub fn prepare(
    mut mechanism: Mechanism,
    start: &StartOptions,
    rows: &RowChoice,
) -> Result<Prepared, MotionError> {
    let assembly = assemble(&mut mechanism, start)?;
    let layout = mechanism.layout();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &assembly.q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    let found = rows_of(&mechanism, 0.0, &assembly.q)?;
    if let Some(nearly) = found.inseparable(&mechanism, 0.0, &assembly.q) {
        return Err(MotionError::inseparable(&nearly, &layout.labels));
    }
    for decision in [&found.all, &found.holonomic] {
        if let RankStatus::Undecided(doubt) = decision.status {
            return Err(MotionError::RankUndecided(doubt));
        }
    }
    let decision = match rows {
        RowChoice::Automatic => found.all.clone(),
        RowChoice::Drop(dropped) => decide_rows_dropping(&mechanism, &s, &assembly.q, dropped)
            .map_err(|e| DropError::new(e, &layout.labels, found.all.redundancy))?,
    };
    let v = consistent_velocity(&mechanism, start, &assembly.q, &assembly.v, &decision.kept)?;
    let velocity_correction = velocity_correction(&mechanism, start, &assembly.q, &assembly.v, &v)?;
    let contradictions = found.contradictions(&mechanism, 0.0, &assembly.q, &v)?;
    if let Some(worst) = contradictions.into_iter().next() {
        return Err(worst.into());
    }
    let q = assembly.q.clone();
    Ok(Prepared {
        mechanism,
        q,
        v,
        choice: rows.clone(),
        decision,
        position_decision: found.holonomic.clone(),
        decided: Some(Arc::new(found)),
        assembly,
        velocity_correction,
        code: None,
    })
}
