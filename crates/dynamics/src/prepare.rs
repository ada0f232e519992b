//! Prepares an assembled mechanism for motion: a consistent start, a decided rank, and independent
//! rows. The rank is decided only in this module, at a corrected state. A run does not decide the
//! rank again. A start at another state uses the decision of the first start, if its independent
//! rows are far from dependent there ([`Rows::carried`]).

use std::sync::Arc;

use model::start::{
    CorrectionLimit, Metric, StartVelocity, assemble, assemble_state, consistent_velocity,
    nearest_configuration,
};
use model::{Assembly, Mechanism, Scratch, StartError, StartOptions, System};
use rank::{KeptRowsError, RankStatus};
use solvability::{
    ConstraintLevel, Contradiction, RowDecision, Rows, State, check_state, contradicting_drives,
    decide_rows_dropping, may_miss, rows as rows_of, rows_of_rank,
};

use crate::code::SharedCode;
use crate::error::{DropError, MotionError};
use crate::limits::{ESTIMATED_MOST, TAKES_PART};
use crate::motion::KeptRowMotion;
use crate::options::{Method, MotionOptions, RowChoice, Stabilisation};
use crate::solve::{self, Misfit, SolverNeeds};

/// A mechanism with a consistent start and independent rows.
#[derive(Clone)]
#[non_exhaustive]
pub struct PreparedMechanism {
    /// The mechanism, with initial values taken from the start.
    pub mechanism: Mechanism,
    /// Coordinates at the start.
    pub q: Vec<f64>,
    /// Velocities at the start.
    pub v: Vec<f64>,
    /// The requested choice of independent rows.
    pub choice: RowChoice,
    /// Options for the initial state, for example coordinates that the assembly must not change.
    pub start: StartOptions,
    /// Whether a tolerance is stated and there are redundant rows. These rows may be redundant only
    /// within the tolerance. In this case they have constraint violations, and the choice of the
    /// independent rows changes the motion by a similar amount.
    pub may_miss: bool,
    /// Rank and independent rows of C.
    pub decision: RowDecision,
    /// Rank and independent rows of Φq alone, which determine the configuration.
    pub position_decision: RowDecision,
    /// The rank decisions at the start, for each part of the mechanism. The verdicts at the start
    /// are computed from these decisions. `None` for a component of another mechanism.
    pub decided: Option<Arc<Rows>>,
    /// Result of the assembly of the configuration.
    pub assembly: Assembly,
    /// Velocities at the start minus the given velocities. The value is zero for velocities that
    /// are not given.
    pub velocity_correction: Vec<f64>,
    /// Code generated for this mechanism with these rows, if such code exists; see
    /// [`PreparedMechanism::with_code`].
    pub(crate) code: Option<Arc<SharedCode>>,
}

impl PreparedMechanism {
    /// Returns the time of the start (s).
    #[must_use]
    pub fn start_time(&self) -> f64 {
        self.mechanism.layout().start_time
    }

    /// Returns an estimated upper bound (bytes) on the memory of a run by this method, without the
    /// mechanism itself. The memory consists of solvers, stages and output rows. The estimate uses
    /// only sparsity patterns.
    #[must_use]
    pub fn memory(&self, method: Method) -> usize {
        let levels = [&self.decision, &self.position_decision].map(|d| d.kept.as_slice());
        let may_be_implicit = method == Method::Auto && self.estimates_stiffness();
        let method = if may_be_implicit {
            Method::Radau5
        } else {
            method
        };
        solve::memory(&self.mechanism, self.solver_needs(method), levels)
    }

    /// Returns the data that determine the solvers of a run by this method.
    pub(crate) fn solver_needs(&self, method: Method) -> SolverNeeds {
        SolverNeeds {
            size: self.assembly.size,
            rows: self.decision.kept.len(),
            are_coordinates_independent: method.needs_independent_coordinates(),
        }
    }

    /// Returns whether the independent rows are solved through the Schur complement of the masses
    /// in a run by this method.
    pub(crate) fn is_schur(&self, method: Method) -> bool {
        self.solver_needs(method).is_schur(&self.mechanism)
    }

    /// Returns whether stiffness is estimated if the caller does not choose a method. Stiffness is
    /// not estimated for large mechanisms with many free motions.
    pub(crate) fn estimates_stiffness(&self) -> bool {
        self.mechanism.layout().n_v <= ESTIMATED_MOST || !self.is_schur(Method::Dop853)
    }

    /// Returns whether the size is far from a metre, see [`solve::is_far`].
    pub(crate) fn is_far(&self) -> bool {
        solve::is_far(self.assembly.size)
    }

    /// Returns the same mechanism with another start: a time (s), coordinates (n_q) and velocities
    /// (n_v). Initial values of joints and drives do not change, so prescribed motions continue.
    /// The state is corrected like the start of a scene. At a break time, at which prescribed rates
    /// may jump, velocities before the jump become the velocities after the jump.
    ///
    /// The decision of the first start is carried to the state ([`Rows::carried`]) where possible,
    /// so the independent rows may differ from those of a scene that is described at the state.
    /// Starts in between have no influence.
    ///
    /// ```
    /// use joints::{Revolute, RevoluteAngleDrive};
    /// use model::{Body, BodyRef, Description, Function, Mechanism, StartOptions};
    /// use pfaff_dynamics::{RowChoice, prepare};
    /// // A crank that turns with 2 rad/s, at 0.5 s.
    /// let mut d = Description::new("crank");
    /// let crank = d.body(Body::new("crank", 1.0, 0.5));
    /// let (bodies, o) = ([BodyRef::Ground, crank], [0.0, 0.0]);
    /// d.joint("pin", &bodies, Revolute { s_i: o, s_j: o });
    /// d.drive("motor", &bodies, RevoluteAngleDrive::new(o, o), Function::constant_rate(2.0).unwrap());
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// let start = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?;
    /// let later = start.at(0.5, &[0.0, 0.0, 1.0], &[0.0, 0.0, 2.0])?;
    /// assert_eq!((later.start_time(), later.q[2]), (0.5, 1.0));
    /// assert!(start.at(0.5, &[0.0, 0.0, 1.2], &[0.0, 0.0, 2.0]).is_err());
    /// # Ok::<(), pfaff_dynamics::MotionError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the same errors as [`prepare`], and an error if the state has the wrong length or is
    /// not finite.
    pub fn at(&self, t: f64, q: &[f64], v: &[f64]) -> Result<Self, MotionError> {
        check_state(&self.mechanism, t, q, v)?;
        let start = StartOptions {
            keep: Vec::new(),
            state: Some(State {
                q: q.to_vec(),
                v: v.to_vec(),
            }),
            ..self.start.clone()
        };
        let prepared = |start: &StartOptions| {
            let mechanism = self.mechanism.clone().starting_at(t);
            let assembly = assemble_state(&mechanism, start)?;
            let is_known = self.assembly.has_configuration_of(&assembly);
            let known = self.decided.clone().filter(|_| is_known);
            let other = self.decided.as_ref();
            prepare_assembled((mechanism, assembly), start, &self.choice, (known, other))
        };
        let is_break = self.mechanism.layout().break_times.contains(&t);
        match prepared(&start) {
            Err(MotionError::Start(StartError::Velocities(_))) if is_break => {
                prepared(&StartOptions {
                    correction: CorrectionLimit::Any,
                    ..start
                })
            }
            other => other,
        }
    }

    /// Returns the ratio of the largest to the smallest mass, see [`solve::mass_spread`].
    pub(crate) fn mass_spread(&self) -> f64 {
        solve::mass_spread(&self.mechanism, self.assembly.size)
    }

    /// Returns another choice of redundant rows. Each violated row becomes independent, and the row
    /// with the largest coefficient in its dependency at the start becomes redundant. Returns
    /// `None` if these rows cannot be redundant together, or for a component of another mechanism.
    ///
    /// # Errors
    /// Returns an error if the equations have no solution at the start.
    pub fn other_rows(&self, misfits: &[Misfit]) -> Result<Option<Vec<usize>>, MotionError> {
        if self.decided.is_none() {
            return Ok(None);
        }
        let mut dropped = self.decision.dropped.clone();
        let mut motion = KeptRowMotion::new(self)?;
        for misfit in misfits {
            let Some(k) = dropped.iter().position(|&i| i == misfit.row) else {
                return Ok(None);
            };
            let taken = dropped.clone();
            match motion.equations.partner(&self.q, misfit.row, &taken)? {
                Some(partner) => dropped[k] = partner,
                None => return Ok(None),
            }
        }
        dropped.sort_unstable();
        Ok(Some(dropped))
    }

    /// Returns the same mechanism with these redundant rows. Returns `None` if the rows cannot be
    /// redundant together, or for a component of another mechanism.
    ///
    /// # Errors
    /// Returns the same errors as [`prepare`].
    pub fn dropping(&self, dropped: &[usize]) -> Result<Option<Self>, MotionError> {
        let Some(found) = &self.decided else {
            return Ok(None);
        };
        let (mechanism, assembly) = (self.mechanism.clone(), self.assembly.clone());
        let choice = RowChoice::Drop(dropped.to_vec());
        match on_rows(mechanism, assembly, Arc::clone(found), &self.start, &choice) {
            Err(MotionError::Rows(_)) => Ok(None),
            other => other.map(Some),
        }
    }

    /// Returns the same mechanism with these independent rows of C and of Φq, ascending, for
    /// example the rows of generated code. Returns `None` if the rows are dependent at the start,
    /// if their number differs from the rank, or if the caller chose other rows. The function also
    /// returns `None` if rows are chosen by another method. Rows are chosen by another method
    /// within stated tolerances, in a large mechanism, and in a component of another mechanism.
    #[must_use]
    pub fn on_rows(&self, kept: &[usize], position_kept: &[usize]) -> Option<Self> {
        if kept == self.decision.kept && position_kept == self.position_decision.kept {
            return Some(self.clone());
        }
        let found = self.decided.as_ref()?;
        let is_own = kept == self.decision.kept || self.choice == RowChoice::Automatic;
        if !is_own || self.may_miss || self.is_schur(Method::Auto) {
            return None;
        }
        let layout = self.mechanism.layout();
        let mut s = self.mechanism.scratch();
        self.mechanism.pose(self.start_time(), &self.q, &mut s);
        self.mechanism.phi(&mut s);
        self.mechanism.c(&mut s);
        let others = |kept: &[usize], n: usize| -> Vec<usize> {
            (0..n).filter(|i| kept.binary_search(i).is_err()).collect()
        };
        let dropped = others(kept, layout.rows());
        let of_positions = others(position_kept, layout.m);
        let decision = if kept == self.decision.kept {
            self.decision.clone()
        } else {
            decide_rows_dropping(&self.mechanism, &s, &self.q, &dropped).ok()?
        };
        let holonomic = (layout.m, found.holonomic.rank);
        let (mechanism, asked) = (&self.mechanism, Some(of_positions.as_slice()));
        let position_decision = rows_of_rank(mechanism, &s, &self.q, holonomic, asked).ok()?;
        if decision.kept != kept || position_decision.kept != position_kept {
            return None;
        }
        let started = start_velocity(mechanism, &self.start, found, &self.q, kept);
        let (StartVelocity { v, correction }, None) = started.ok()? else {
            return None;
        };
        let choice = if kept == self.decision.kept {
            self.choice.clone()
        } else {
            RowChoice::Drop(dropped)
        };
        Some(Self {
            v,
            velocity_correction: correction,
            decision,
            position_decision,
            choice,
            code: None,
            ..self.clone()
        })
    }

    /// Returns whether a run evaluates the state as a function of time. The state is evaluated as a
    /// function of time if no coordinate or velocity is free and states are projected.
    pub(crate) fn is_function_of_time(&self, options: &MotionOptions) -> bool {
        let ranks = [self.decision.rank, self.position_decision.rank];
        let is_held = ranks == [self.mechanism.layout().n_v; 2];
        let is_held = is_held && self.mechanism.layout().states == 0;
        is_held && options.stabilisation == Stabilisation::Projection
    }
}

/// Assembles the start, decides its rank, chooses rows, and makes the velocities consistent.
///
/// # Errors
/// - [`MotionError::Start`]: no consistent configuration or velocities exist.
/// - [`MotionError::Contradiction`]: redundant rows require different positions, velocities or
///   accelerations.
/// - [`MotionError::Inseparable`]: the independent rows are too ill-conditioned for a motion.
/// - [`MotionError::RankUndecided`], [`MotionError::Rows`]: no rows can be chosen, or the requested
///   rows cannot be chosen.
pub fn prepare(
    mechanism: Mechanism,
    start: &StartOptions,
    rows: &RowChoice,
) -> Result<PreparedMechanism, MotionError> {
    prepare_after(mechanism, start, rows, None)
}

/// Works like [`prepare`], but makes no new decision. The function uses the decisions for another
/// mechanism with the same constraints at the same configuration.
///
/// # Errors
/// Returns the same errors as [`prepare`].
pub fn prepare_after(
    mut mechanism: Mechanism,
    start: &StartOptions,
    rows: &RowChoice,
    other: Option<&PreparedMechanism>,
) -> Result<PreparedMechanism, MotionError> {
    let assembly = assemble(&mut mechanism, start)?;
    let known = other.filter(|other| {
        other.assembly.has_configuration_of(&assembly)
            && mechanism.has_constraints_of(&other.mechanism)
    });
    let known = known.and_then(|other| other.decided.clone());
    prepare_assembled((mechanism, assembly), start, rows, (known, None))
}

/// Works like [`prepare`], for an assembled mechanism. The decisions for the configuration may be
/// known, or carried from another configuration of the mechanism.
fn prepare_assembled(
    (mechanism, assembly): (Mechanism, Assembly),
    start: &StartOptions,
    rows: &RowChoice,
    (known, other): (Option<Arc<Rows>>, Option<&Arc<Rows>>),
) -> Result<PreparedMechanism, MotionError> {
    let t = mechanism.layout().start_time;
    let carried = || Some(Arc::new(other?.carried(&mechanism, t, &assembly.q)?));
    if let Some(found) = known.or_else(carried) {
        return on_rows(mechanism, assembly, found, start, rows);
    }
    let found = rows_of(&mechanism, t, &assembly.q)?.after(other);
    if let Some(error) = unmovable(&mechanism, &found, &assembly.q) {
        // A cause that prevents any motion is reported first, because it also causes an error of
        // the analysis.
        return Err(if found.are_certified() {
            start_velocity(&mechanism, start, &found, &assembly.q, &found.all.kept)
                .err()
                .filter(|e| !matches!(e, MotionError::Start(StartError::NoVelocity { .. })))
                .unwrap_or(error)
        } else {
            error
        });
    }
    on_rows(mechanism, assembly, Arc::new(found), start, rows)
}

/// An assembled mechanism with a choice of rows.
fn on_rows(
    mechanism: Mechanism,
    assembly: Assembly,
    found: Arc<Rows>,
    start: &StartOptions,
    rows: &RowChoice,
) -> Result<PreparedMechanism, MotionError> {
    let mut s = mechanism.scratch();
    mechanism.pose(mechanism.layout().start_time, &assembly.q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    let labels = &mechanism.layout().labels;
    let refused = |e| DropError::new(e, labels, found.all.redundancy);
    let may_miss = may_miss(&mechanism) && found.all.redundancy > 0;
    let (decision, position_decision) = match rows {
        RowChoice::Automatic => (found.all.clone(), found.holonomic.clone()),
        RowChoice::Drop(dropped) if may_miss => {
            drop_within_tolerance(&mechanism, &found, &s, &assembly.q, dropped).map_err(refused)?
        }
        RowChoice::Drop(dropped) => {
            let decision = decide_rows_dropping(&mechanism, &s, &assembly.q, dropped);
            (decision.map_err(refused)?, found.holonomic.clone())
        }
    };
    let mut q = if may_miss {
        let kept = &position_decision.kept;
        nearest_configuration(
            &mechanism,
            mechanism.layout().start_time,
            kept,
            &assembly.q,
            Metric::Start(start),
        )?
    } else {
        assembly.q.clone()
    };
    let (StartVelocity { v, correction }, against) =
        start_velocity(&mechanism, start, &found, &q, &decision.kept)?;
    if start.state.is_none() {
        mechanism.start_states(&mut q, &v);
    }
    if let Some(contradiction) = against {
        return Err(contradiction.into());
    }
    Ok(PreparedMechanism {
        mechanism,
        q,
        v,
        choice: rows.clone(),
        start: start.clone(),
        decision,
        position_decision,
        may_miss,
        decided: Some(found),
        assembly,
        velocity_correction: correction,
        code: None,
    })
}

/// Returns the rows of C and of Φq that are requested to be redundant. For Φq, these are the
/// holonomic rows among the requested rows.
fn drop_within_tolerance(
    mechanism: &Mechanism,
    found: &Rows,
    s: &Scratch,
    q: &[f64],
    dropped: &[usize],
) -> Result<(RowDecision, RowDecision), KeptRowsError> {
    let layout = mechanism.layout();
    let of_all = (layout.rows(), found.all.rank);
    let all = rows_of_rank(mechanism, s, q, of_all, Some(dropped))?;
    let of_positions: Vec<usize> = dropped.iter().copied().filter(|i| *i < layout.m).collect();
    let requested = Some(of_positions.as_slice());
    let requested = requested.filter(|rows| rows.len() == found.holonomic.redundancy);
    let of_holonomic = (layout.m, found.holonomic.rank);
    let positions = rows_of_rank(mechanism, s, q, of_holonomic, requested)?;
    Ok((all, positions))
}

/// Returns the reason why no motion can start at a configuration, if there is such a reason. Either
/// the rank is undecided, or rows that are certified to be independent are too ill-conditioned for
/// `f64`.
#[must_use]
pub fn unmovable(mechanism: &Mechanism, found: &Rows, q: &[f64]) -> Option<MotionError> {
    if let Some(nearly) = found.inseparable(mechanism, mechanism.layout().start_time, q) {
        let largest = nearly
            .direction
            .iter()
            .fold(0.0, |a: f64, w| a.max(w.abs()));
        let weights = nearly.direction.iter().zip(&mechanism.layout().labels);
        let rows = weights.filter(|(w, _)| w.abs() > TAKES_PART * largest);
        return Some(MotionError::Inseparable {
            rows: rows.map(|(_, label)| label.to_string()).collect(),
            sigma: nearly.sigma,
            required: rank::NEARLY_SINGULAR,
        });
    }
    let decisions = [&found.all, &found.holonomic];
    decisions
        .into_iter()
        .find_map(|decision| match decision.status {
            RankStatus::Undecided(doubt) => Some(MotionError::RankUndecided(doubt)),
            _ => None,
        })
}

/// Returns the velocities of an assembled start, see [`consistent_velocity`], and a contradiction
/// between the accelerations at the start, if there is one. Such a contradiction exists if
/// redundant rows allow the velocities but no motion that starts with these velocities. Rows that
/// contradict each other for all initial velocities, such as rows of drives, are reported before
/// given velocities that contradict the rows.
///
/// # Errors
/// - [`MotionError::Start`]: the given velocities are impossible.
/// - [`MotionError::Contradiction`]: redundant rows require different positions or velocities.
pub fn start_velocity(
    mechanism: &Mechanism,
    start: &StartOptions,
    rows: &Rows,
    q: &[f64],
    kept: &[usize],
) -> Result<(StartVelocity, Option<Contradiction>), MotionError> {
    let given = match &start.state {
        Some(state) => state.v.iter().copied().map(Some).collect(),
        None => mechanism.frames().given_velocities(q),
    };
    let found = consistent_velocity(mechanism, start, q, &given, kept);
    if !rows.all.is_decided() || !rows.holonomic.is_decided() {
        return Ok((found?, None));
    }
    let free;
    let v = match &found {
        Ok(found) => &found.v,
        Err(_) => {
            let nothing = vec![None; given.len()];
            free = consistent_velocity(mechanism, &StartOptions::default(), q, &nothing, kept)?;
            &free.v
        }
    };
    let t = mechanism.layout().start_time;
    let mut all = rows.contradictions(mechanism, t, q, v)?;
    if all.is_empty() && mechanism.has_tolerances() && rows.all.redundancy > 0 {
        // The violation of a joint that a drive moves may result from data within the tolerance. As
        // in a check of the drives, the prescribed motion of a drive is therefore compared with the
        // motion that the joints allow.
        all = contradicting_drives(mechanism, t, q)?;
    }
    let is_late = |c: &Contradiction| c.level == ConstraintLevel::Acceleration;
    let (late, now): (Vec<_>, Vec<_>) = all.into_iter().partition(is_late);
    match now.into_iter().next() {
        Some(worst) => Err(worst.into()),
        None => Ok((found?, late.into_iter().next())),
    }
}
