//! The differential equation of a run: y = [q; v], and the work of drives and applied forces if
//! there are drives or applied forces. Steps are projected. If a rate jumps, the velocities also
//! jump.
//!
//! All methods integrate this state. For implicit methods f reads only the independent entries of y
//! (`reduced`). Projection, dense output, output rows and changes of the independent coordinates
//! use the full state.

use std::ops::ControlFlow;

use integrators::{Delicate, Implicit, IntegrationError, Ode, StepEnd, StepInfo, Tolerance};
use model::{ConstraintId, Mechanism, System};
use solvability::{CarriedChoices, Group, InstantOrder, NamedChoice, Stretches};

use super::by_time::ByTime;
use super::caller::Stop;
use super::contacts::RunContacts;
use super::impulse::cross_break;
use super::record::Record;
use super::reduced::ReducedJacobian;
use super::sample::{AtRows, OfMotion, Sample, SolveProgress, Source};
use super::span::Span;
use super::summary::DroppedRows;
use super::verdicts::RunVerdicts;
use crate::error::MotionFault;
use crate::guards::GUARDED;
use crate::limits::{COARSE, IMPLICIT_REACH, QUATERNION_LENGTHS};
use crate::motion::KeptRowMotion;
use crate::options::MotionOptions;
use crate::prepare::PreparedMechanism;
use crate::solve::Misfit;
use crate::watch::{Next, Now, are_delicate};

/// The integration method near singular configurations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Leader {
    /// The method of the run integrates throughout.
    Alone,
    /// The method of the run integrates up to a singular configuration. `is_due` is true if a step
    /// has reached a singular configuration without a prediction.
    HandsOver { is_due: bool },
    /// The method that steps over singular configurations integrates.
    Passes,
}

/// The equations of a run, with its record.
pub(super) struct RunEquations<'m> {
    pub(super) motion: KeptRowMotion<'m>,
    pub(super) record: Record,
    /// Values requested at output rows.
    pub(super) wanted: AtRows,
    /// Additional assumptions (choices) for reactions at output rows, with their solvers.
    choices: &'m [NamedChoice],
    carried_choices: Option<CarriedChoices<'m>>,
    /// Verdicts during the run, if reactions are requested.
    verdicts: Option<RunVerdicts<'m>>,
    /// The one-sided joints, if there are any.
    pub(super) contacts: Option<RunContacts>,
    /// Linear systems of implicit methods, allocated by their first step.
    reduced: Option<ReducedJacobian>,
    until: EndCondition<'m>,
    passing: Passing,
    /// Whether stages of the current step were evaluated by generated code that is no longer in
    /// use. In this case the step starts again.
    is_void: bool,
    /// The fault of an external function that returned no value and therefore ended the run.
    pub(super) failed: Option<MotionFault>,
    /// Derivatives as functions of time, for a mechanism without degrees of freedom.
    by_time: Option<ByTime>,
    /// The last accepted step.
    last: Span,
    scratch: Scratch,
}

/// Treatment of singular configurations in a run.
struct Passing {
    leader: Leader,
    /// Whether coordinates are so large relative to the mechanism that their rounding errors affect
    /// stages before a singular configuration.
    is_coarse: bool,
    /// Whether the stages of the current step are moved onto the constraint manifold.
    is_careful: bool,
}

/// Conditions at which the run ends.
struct EndCondition<'m> {
    t_end: f64,
    stop: &'m Stop<'m>,
}

struct Scratch {
    /// The state before a projection.
    before: Vec<f64>,
    /// A stage on the constraint manifold.
    stage: Vec<f64>,
}

impl<'m> RunEquations<'m> {
    /// Creates the equations of a motion at its start, at which the rows are factored.
    pub(super) fn new(
        motion: KeptRowMotion<'m>,
        prepared: &PreparedMechanism,
        options: &MotionOptions,
        (wanted, verdicts): (AtRows, Option<RunVerdicts<'m>>),
        (choices, carried_choices): (&'m [NamedChoice], Option<CarriedChoices<'m>>),
        stop: &'m Stop<'m>,
    ) -> Self {
        let (q, v, mechanism) = (&prepared.q, &prepared.v, motion.mechanism());
        let works = mechanism.layout().rheonomic || !mechanism.applied_forces().is_empty();
        let mut y0 = [q.as_slice(), v].concat();
        y0.extend(works.then_some(0.0));
        let mut equations = Self {
            record: Record::new(mechanism, q, v),
            wanted,
            choices,
            carried_choices,
            verdicts,
            contacts: RunContacts::of(mechanism, options.output_step),
            reduced: None,
            until: EndCondition {
                t_end: options.t_end,
                stop,
            },
            passing: Passing {
                leader: Leader::Alone,
                is_coarse: false,
                is_careful: false,
            },
            is_void: false,
            failed: None,
            by_time: ByTime::for_run(prepared, options),
            last: Span::default(),
            scratch: Scratch {
                before: y0.clone(),
                stage: y0,
            },
            motion,
        };
        let at = &equations.motion.equations.at;
        equations.passing.is_coarse = at
            .mechanism
            .scales(&at.s)
            .relative_residual(at.size, 0..at.mechanism.layout().m)
            > COARSE;
        equations.passing.is_careful = equations.wants_care();
        equations.record.min_pivot_ratio = equations.motion.pivot_ratio();
        equations
    }

    /// Returns the constraint violations of redundant rows so far.
    pub(super) fn misfits(&self) -> Vec<Misfit> {
        let misfits = self.motion.equations.misfits.as_ref();
        misfits.map_or_else(Vec::new, |m| m.found().to_vec())
    }

    /// Sets the time at which the run ends (s).
    pub(super) fn run_until(&mut self, t_end: f64) {
        self.until.t_end = t_end;
    }

    /// Returns y at the start, before any evaluation.
    pub(super) fn y0(&self) -> Vec<f64> {
        self.scratch.stage.clone()
    }

    /// Returns whether stages are functions of time. Near a singular configuration, at which
    /// branches meet, the stages instead follow the integrator.
    fn is_by_time(&self) -> bool {
        self.by_time.is_some() && self.motion.watch.delicate_time().is_none()
    }

    /// Returns whether the next stages must be moved onto the constraint manifold. The stages must
    /// be moved near singular configurations, and if the move makes the stages functions of time.
    /// With independent coordinates, all stages satisfy the constraints. Without projection, no
    /// stage is moved.
    fn wants_care(&self) -> bool {
        let motion = &self.motion;
        let off = motion.manifold.projects() && motion.independent().is_none();
        let is_expected = self.passing.is_coarse && motion.watch.delicate_time().is_some();
        let is_near = is_expected || are_delicate(&motion.equations.velocity);
        off && (self.is_by_time() || is_near)
    }

    /// From this step on, `leader` integrates all coordinates. An implicit method chooses
    /// independent coordinates instead.
    pub(super) fn follow(&mut self, leader: Leader) {
        let KeptRowMotion {
            manifold,
            equations,
            ..
        } = &mut self.motion;
        if leader == Leader::Passes && manifold.coordinates.take().is_some() {
            equations.velocity.forget_partition();
            equations.position.forget_partition();
        }
        self.passing.leader = leader;
        self.passing.is_careful = self.wants_care();
    }

    /// Returns whether another method must continue after an accepted step over these times.
    pub(super) fn hands_over(&self, [t0, t]: [f64; 2]) -> bool {
        let delicate = self.motion.watch.delicate_time();
        // Explicit steps up to the singular configuration would be far shorter than implicit steps.
        let reach = if self.motion.independent().is_some() {
            IMPLICIT_REACH * (t - t0)
        } else {
            f64::INFINITY
        };
        let is_foreseen = delicate.is_some_and(|at| at - t < reach);
        let hands_over = match self.passing.leader {
            Leader::Alone => false,
            Leader::HandsOver { is_due } => is_due || is_foreseen,
            Leader::Passes => !is_foreseen && !are_delicate(&self.motion.equations.velocity),
        };
        hands_over && !self.is_break(t)
    }

    /// The work is computed without error control, because its error has no weight. The work still
    /// counts as a component of the mean error, which loosens the control by the factor √((n +
    /// 1)/n).
    pub(super) fn tolerance(&self, options: &MotionOptions) -> Tolerance {
        let (rtol, atol) = (options.rtol, options.atol);
        let moving = self.motion.parts(&self.scratch.stage);
        let moving = moving.0.len() + moving.1.len();
        if moving == self.scratch.stage.len() {
            return Tolerance::Uniform { rtol, atol };
        }
        let [mut rtol, mut atol] = [rtol, atol].map(|tolerance| vec![tolerance; moving]);
        rtol.push(0.0);
        atol.push(f64::MAX);
        Tolerance::PerComponent { rtol, atol }
    }

    /// Passes an output row to the caller. The row is projected if states are projected. At a break
    /// time the row is the state just before the break time.
    pub(super) fn show(
        &mut self,
        t: f64,
        y: &mut [f64],
        row: &mut (dyn FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault> + '_),
    ) -> Result<ControlFlow<()>, MotionFault> {
        let start_time = self.motion.mechanism().layout().start_time;
        let t_before = if t > start_time && self.is_break(t) {
            t.next_down()
        } else {
            t
        };
        let (q, v, _) = self.motion.parts_mut(y);
        // If the motion uses independent coordinates, only these coordinates are interpolated.
        // Generated code uses its own coordinates.
        let is_whole = self.motion.independent().is_none() && !self.motion.is_on_code();
        self.lead_completion(t);
        let found = if self.wanted.on_constraints || !is_whole {
            Some(self.motion.end_row(t_before, (q, v))?)
        } else {
            None
        };
        let at = &self.motion.equations.at;
        if GUARDED {
            finite(at.mechanism, t, y)?;
            self.last.check(at.mechanism, at.size, t, y)?;
        }
        let (q, v) = self.motion.parts(y);
        let work = work(q, v, y);
        if let Some(found) = found {
            self.record.note(at.mechanism, (q, v, work), found);
            self.motion.equations.accept_misfits(false);
        }
        let is_settled = self.motion.manifold.projects() && !self.motion.is_on_code();
        let dropped = self.motion.equations.without_multiplier().to_vec();
        if let Some(verdicts) = &mut self.verdicts {
            let is_factored = found.is_some() && is_settled;
            let state = (t, t_before, q);
            verdicts.look_at_row(&mut self.motion, state, is_factored)?;
        }
        let source = OfMotion {
            known: if found.is_some() && is_settled {
                SolveProgress::Factored
            } else {
                SolveProgress::Nothing
            },
            t_before,
            wanted: &self.wanted,
            motion: &mut self.motion,
            choices: self.carried_choices.as_ref(),
            lambda: None,
            chosen: None,
        };
        let events = &self.record.events[self.record.shown..];
        let shown = row(&mut Sample {
            t,
            q,
            v,
            work,
            events,
            dropped: &dropped,
            choices: self.choices,
            source: Source::Motion(source),
        });
        self.record.shown = self.record.events.len();
        shown
    }

    /// Returns the motion and its linear systems.
    fn implicit(&mut self) -> (&mut KeptRowMotion<'m>, &mut ReducedJacobian) {
        let new = || ReducedJacobian::new(&self.motion);
        let reduced = self.reduced.get_or_insert_with(new);
        (&mut self.motion, reduced)
    }

    /// Stores an accepted step for the output rows within it.
    pub(super) fn take_step(&mut self, times: [f64; 2], ends: [&[f64]; 4]) {
        self.last.take(times, ends);
    }

    /// Starts new intervals of verdicts at the events of an accepted step, which are the events
    /// from `first_event` on. Returns one time between any two interval boundaries between which
    /// verdicts would otherwise not be evaluated.
    pub(super) fn cut_verdicts(&mut self, times: [f64; 2], first_event: usize) -> Vec<f64> {
        let ends_there = times[1] == self.until.t_end || self.is_break(times[1]);
        let Some(verdicts) = &mut self.verdicts else {
            return Vec::new();
        };
        let events = self.record.events[first_event..].iter();
        let cuts: Vec<f64> = events.filter(|e| e.kind.cuts()).map(|e| e.time).collect();
        verdicts.cut(&cuts, times, ends_there)
    }

    /// Computes the verdicts at a time within an accepted step, before its output rows. A state
    /// that violates the constraints is moved onto the constraint manifold first.
    pub(super) fn judge_ahead(
        &mut self,
        t: f64,
        y: &mut [f64],
        is_on_constraints: bool,
    ) -> Result<(), MotionFault> {
        let Some(mut verdicts) = self.verdicts.take() else {
            return Ok(());
        };
        let t_before = if self.is_break(t) { t.next_down() } else { t };
        if !is_on_constraints {
            self.lead_completion(t);
            let (q, v, _) = self.motion.parts_mut(y);
            self.motion.end_row(t_before, (q, v))?;
        }
        let (q, _) = self.motion.parts(y);
        let looked = verdicts.look(
            &mut self.motion,
            (t, t_before, q),
            false,
            InstantOrder::Ahead,
        );
        let not_of_run = verdicts.not_of_run();
        let wanted = &mut self.wanted.reactions;
        wanted.retain(|k| !not_of_run.contains(&ConstraintId(*k)));
        self.verdicts = Some(verdicts);
        looked
    }

    /// Returns whether verdicts are computed during the run.
    pub(super) fn reads_verdicts(&self) -> bool {
        self.verdicts.as_ref().is_some_and(RunVerdicts::may_change)
    }

    /// Returns whether verdicts are computed at the end of the accepted step.
    pub(super) fn reads_verdicts_at_step(&self) -> bool {
        let verdicts = self.verdicts.as_ref();
        verdicts.is_some_and(RunVerdicts::are_wanted_at_step)
    }

    /// Returns the number of events so far.
    pub(super) fn events(&self) -> usize {
        self.record.events.len()
    }

    /// Returns the verdicts up to this time, and the rows without multiplier.
    pub(super) fn finish_verdicts(
        &mut self,
        groups: &[Group],
        to: f64,
    ) -> Option<(Stretches, Vec<DroppedRows>)> {
        let verdicts = self.verdicts.take()?;
        Some(verdicts.finish(&self.motion, groups, to))
    }

    /// Returns the reason why the step size has collapsed at time t, if there is a reason. The
    /// reason is a singular configuration nearby, or a redundant row.
    pub(super) fn cause(
        &mut self,
        error: &IntegrationError<MotionFault>,
        t: f64,
    ) -> Option<MotionFault> {
        let motion = &mut self.motion;
        match error {
            // Error control fails near a singular configuration, because accelerations near it are
            // rounding errors.
            IntegrationError::StepSizeCollapsed { .. }
                if are_delicate(&motion.equations.velocity) =>
            {
                Some(motion.watch.no_way_over(t))
            }
            IntegrationError::StepSizeCollapsed { .. } => motion.watch.contradiction(t),
            _ => None,
        }
    }

    /// If the motion stopped using generated code, the interpreter continues from the last accepted
    /// state. The interpreter continues as if it had computed this state.
    fn note_departure(&mut self) {
        let motion = &mut self.motion;
        if let Some(code) = &mut motion.code
            && let Some(departure) = code.take_departure()
        {
            code.look_ahead(&motion.equations, &mut motion.watch);
            self.record.events.push(departure.event);
            self.is_void = departure.is_within_step;
            self.passing.is_careful = self.wants_care();
        }
    }

    /// Ends the run if an external function returns no value.
    fn note_failure(&mut self, fault: &MotionFault) {
        if matches!(fault, MotionFault::Function { .. }) {
            self.failed.get_or_insert_with(|| fault.clone());
        }
    }

    /// Within the last accepted step, the completion of states on independent coordinates starts
    /// from the interpolated path of the step. The integrator's values of the dependent coordinates
    /// are estimates over a whole step.
    pub(super) fn lead_completion(&mut self, t: f64) {
        if let Some(coordinates) = &mut self.motion.manifold.coordinates
            && let Some(led) = self.last.lead(t)
        {
            coordinates.begin_from(led);
        }
    }

    /// Computes f(t, y) by the interpreter.
    fn evaluate(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), MotionFault> {
        self.lead_completion(t);
        if !self.passing.is_careful {
            self.motion.derivative(t, y, dy)?;
            return match &mut self.reduced {
                Some(reduced) => reduced.follow_partition(&mut self.motion),
                None => Ok(()),
            };
        }
        self.scratch.stage.copy_from_slice(y);
        let (q, v, _) = self.motion.parts_mut(&mut self.scratch.stage);
        let equations = &mut self.motion.equations;
        self.motion.manifold.approach(equations, t, (q, v))?;
        self.motion.derivative(t, &self.scratch.stage, dy)
    }

    pub(super) fn is_break(&self, t: f64) -> bool {
        let times = &self.motion.mechanism().layout().break_times;
        times.binary_search_by(|b| b.total_cmp(&t)).is_ok()
    }

    /// Ends a step that passed its error test if the step can be accepted.
    fn end(&mut self, step: &StepInfo<'_>, y: &mut [f64], dy: &mut [f64]) -> Result<StepEnd, Next> {
        self.scratch.before.copy_from_slice(y);
        let known = self.by_time.as_mut();
        let is_known = known.is_some_and(|known| known.take(step.t_rhs, dy));
        if std::mem::take(&mut self.is_void) {
            return Err(Next::Reject);
        }
        let has_to_end = step.t == self.until.t_end || self.is_break(step.t);
        let motion = &mut self.motion;
        let on_code = motion.is_on_code();
        let (q, v, _) = motion.parts_mut(y);
        let found = motion.end_step(step.t_rhs, (q, v), has_to_end)?;
        if on_code {
            motion.derivative(step.t_rhs, y, dy)?;
            if !motion.is_on_code() {
                return Err(Next::Reject);
            }
        }
        let pivot_ratio = motion.pivot_ratio();
        for (before, y) in self.scratch.before.iter_mut().zip(&*y) {
            *before -= y;
        }
        let (q, v) = motion.parts(y);
        let (equations, watch) = (&mut motion.equations, &mut motion.watch);
        let projects = motion.manifold.projects();
        let may_have_passed = !on_code && watch.may_have_passed(equations, [step.t0, step.t]);
        if may_have_passed
            && self.passing.leader == (Leader::HandsOver { is_due: false })
            && watch.came_from_afar()
        {
            self.passing.leader = Leader::HandsOver { is_due: true };
            return Err(Next::Reject);
        }
        if may_have_passed && !projects {
            let missed = motion
                .manifold
                .missed_correction(equations, step.t_rhs, (q, v))?;
            self.scratch.before[..missed.len()].copy_from_slice(&missed);
        }
        let correction = step.norm(&self.scratch.before);
        if may_have_passed {
            let next = watch.judge_correction(equations, step.t, correction);
            next.stands()?;
        }
        let mechanism = motion.mechanism();
        if projects && !on_code {
            if may_have_passed || !is_known {
                motion.derivative_of_projected(step.t_rhs, y, dy)?;
            }
            let (equations, now) = (&motion.equations, now(mechanism, step.t, y, dy));
            let next = motion.watch.judge_motion(equations, now, may_have_passed);
            next.stands()?;
            if let Some(coordinates) = &mut motion.manifold.coordinates {
                coordinates.check_travel(&equations.at, (step.t_rhs, q, v))?;
            }
        }
        // From here on, the step is accepted.
        motion.equations.accept_misfits(true);
        self.record.note(mechanism, (q, v, work(q, v, y)), found);
        let layout = mechanism.layout();
        let (q, qd) = (mechanism.of_bodies_mut(y), mechanism.of_bodies_mut(dy));
        let scaled = layout.space.normalise(q, qd, &QUATERNION_LENGTHS);
        self.record.normalisations += scaled;
        let now = now(mechanism, step.t, y, dy);
        if let Some(code) = motion.code.as_mut().filter(|_| on_code) {
            motion.watch.is_suspect = false;
            code.accept(now);
        } else {
            let event = motion.accept(step.t, may_have_passed);
            self.record.events.extend(event);
            self.record.min_pivot_ratio = self.record.min_pivot_ratio.min(pivot_ratio);
        }
        if !projects {
            return Ok(match scaled {
                0 => StepEnd::Unchanged,
                _ => StepEnd::Projected {
                    correction: 0.0,
                    evaluations: 0,
                },
            });
        }
        if !on_code {
            self.look_ahead(now, step.t - step.t0, may_have_passed);
        }
        Ok(StepEnd::Projected {
            correction,
            evaluations: 1,
        })
    }

    /// Predicts singular configurations from an accepted, interpreted state, and returns to
    /// generated code if possible.
    fn look_ahead(&mut self, now: Now<'_>, step: f64, may_have_passed: bool) {
        let motion = &mut self.motion;
        let (equations, watch) = (&motion.equations, &mut motion.watch);
        watch.look_ahead(equations, now, step);
        let is_open = !may_have_passed && watch.delicate_time().is_none();
        if let Some(code) = motion.code.as_mut().filter(|_| is_open) {
            let event = code.come_back(equations, now);
            self.record.events.extend(event);
        }
        self.passing.is_careful = self.wants_care();
    }
}

/// Returns the state y with the accelerations of dy.
fn now<'a>(mechanism: &Mechanism, t: f64, y: &'a [f64], dy: &'a [f64]) -> Now<'a> {
    let (n_q, n_v) = (mechanism.layout().n_q, mechanism.layout().n_v);
    let (q, v, a) = (&y[..n_q], &y[n_q..n_q + n_v], &dy[n_q..n_q + n_v]);
    Now { t, q, v, a }
}

/// Returns the work of drives and applied forces (J) if y contains the work.
fn work(q: &[f64], v: &[f64], y: &[f64]) -> f64 {
    y.get(q.len() + v.len()).copied().unwrap_or(0.0)
}

/// Checks that the values of an output row y = [q; v; …] are finite, because sums may overflow even
/// if both ends of a step are finite.
fn finite(mechanism: &Mechanism, t: f64, y: &[f64]) -> Result<(), MotionFault> {
    let (n_q, n_v) = (mechanism.layout().n_q, mechanism.layout().n_v);
    let y = &y[..n_q + n_v];
    // x·0 is NaN if and only if x is NaN or infinite.
    if y.iter().map(|x| x * 0.0).sum::<f64>() == 0.0 {
        return Ok(());
    }
    let Some(k) = y.iter().position(|x| !x.is_finite()) else {
        return Ok(());
    };
    let (what, (body, coordinate)) = if k < n_q {
        ("", mechanism.coordinate_name(k))
    } else {
        ("rate of the ", mechanism.coordinate(k - n_q))
    };
    Err(MotionFault::NotFinite {
        time: t,
        what: format!("the {what}{coordinate} of `{body}`"),
    })
}

impl Ode for RunEquations<'_> {
    type Error = MotionFault;

    fn dim(&self) -> usize {
        self.scratch.stage.len()
    }

    fn is_stopped(&self) -> bool {
        self.failed.is_some() || (self.until.stop)()
    }

    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), MotionFault> {
        if self.is_stopped() {
            return Err(MotionFault::Interrupted { time: t });
        }
        if self.motion.is_on_code() {
            let evaluated = self.motion.derivative(t, y, dy);
            self.note_departure();
            return evaluated;
        }
        let by_time = self.is_by_time();
        let Some(mut known) = self.by_time.take_if(|_| by_time) else {
            let evaluated = self.evaluate(t, y, dy);
            return evaluated.inspect_err(|fault| self.note_failure(fault));
        };
        let evaluated = known.recall(t, dy, |dy| self.evaluate(t, y, dy));
        self.by_time = Some(known);
        evaluated.inspect_err(|fault| self.note_failure(fault))
    }

    fn end_of_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, MotionFault> {
        let on_code = self.motion.is_on_code();
        let ended = self.end(step, y, dy);
        if on_code {
            self.note_departure();
        }
        match ended {
            Ok(end) => Ok(end),
            Err(Next::Stop(fault)) => {
                self.note_failure(&fault);
                self.motion.watch.note_refused(step.t, &fault);
                Err(fault)
            }
            Err(Next::Accept | Next::Keep(_) | Next::Reject) => {
                self.is_void = false;
                self.passing.is_careful = self.wants_care();
                Ok(StepEnd::Reject)
            }
        }
    }

    fn delicate_time(&self) -> Option<Delicate> {
        self.motion.watch.delicate(self.motion.equations.at.size)
    }

    /// If rates jump, an impulse of the constraints causes a jump of the velocities.
    fn at_break(&mut self, t: f64, y: &mut [f64]) -> Result<(), MotionFault> {
        self.by_time.iter_mut().for_each(ByTime::forget);
        let (q, v, work) = self.motion.parts_mut(y);
        if let Some(mut impulse) = cross_break(&mut self.motion, t, (&mut *q, v))? {
            if let Some(work) = work {
                *work += impulse.energy;
            }
            if let Some(verdicts) = &mut self.verdicts {
                let multipliers = &impulse.multipliers;
                impulse.event.impulses =
                    verdicts.impulses(&mut self.motion, (t, q), multipliers)?;
            }
            self.record.events.push(impulse.event);
            self.check_impulse(t, &impulse.multipliers)?;
        }
        Ok(())
    }
}

impl Implicit for RunEquations<'_> {
    fn linearise(&mut self, t: f64, y: &[f64]) -> Result<(), MotionFault> {
        let (motion, reduced) = self.implicit();
        reduced.linearise(motion, t, y)
    }

    fn factor(&mut self, real: f64, complex: [f64; 2]) -> Result<(), MotionFault> {
        self.implicit().1.factor(real, complex)
    }

    fn solve(&mut self, x: &mut [f64]) {
        self.implicit().1.solve(x);
    }

    fn solve_complex(&mut self, re: &mut [f64], im: &mut [f64]) {
        self.implicit().1.solve_complex(re, im);
    }
}
