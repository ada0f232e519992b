//! The differential equation of a run: y = [q; v], and the work of drives and applied forces where
//! there are any. Steps are projected; where a rate jumps, so do the velocities.

use std::ops::ControlFlow;

use integrators::{Delicate, Implicit, IntegrationError, Ode, StepEnd, StepInfo, Tolerance};
use model::{Mechanism, System};

use super::by_time::ByTime;
use super::energy::{self, EnergyBalance};
use super::sample::{AtRows, OfMotion, Sample, Source};
use super::span::Span;
use crate::error::MotionFault;
use crate::events::Event;
use crate::guards::GUARDED;
use crate::motion::{Correction, KeptRowMotion, Reduced};
use crate::options::MotionOptions;
use crate::prepare::Prepared;

/// Nearest approach of the end of a step to a singular configuration, as share of the reference
/// pivots; and in units of the relative tolerance.
const NEAREST: f64 = 1e-3;
const NEAREST_TOLERANCES: f64 = 100.0;

/// Loose tolerances must not keep a motion far from everything.
const NEAREST_MAX: f64 = 0.1;

/// Singular configurations are foreseen for so many steps like the last one: no method lets steps
/// grow by more.
const FORESIGHT: f64 = 12.0;

/// Relative error of a step over a singular configuration that rounding may cause where steps are
/// short; 1e-10 was not enough at 1e-10 where generated code is left on the way to one.
const PASSED: f64 = 1e-9;

/// Steps that end at a contradiction collapse within this share of the run before it.
const JUST_AHEAD: f64 = 1e-9;

/// Reactions are not told nearer to a singular configuration than this share of the reference
/// pivots, or so many relative tolerances: a row off its motion by δ has reactions that are wrong
/// by δ divided by that share.
const BLIND: f64 = 1e-6;
const BLIND_TOLERANCES: f64 = 1e3;
const BLIND_MAX: f64 = 1e-2;

/// Largest relative correction of a step over a singular configuration, as share of the distance at
/// which it ends: other branches are as far away as that.
const SMOOTH: f64 = 0.01;

/// The equations of a run with what is noted on the way.
pub(super) struct Equations<'m> {
    pub(super) motion: KeptRowMotion<'m>,
    /// What is wanted at rows of output.
    wanted: AtRows,
    /// Of implicit methods, from their first step on.
    reduced: Option<Reduced>,
    pub(super) n_q: usize,
    pub(super) n_v: usize,
    /// Whether y carries the work.
    works: bool,
    /// Steps must not end nearer to a singular configuration, but where they have to.
    nearest: f64,
    t_end: f64,
    rtol: f64,
    energy: EnergyBalance,
    max_position_residual: f64,
    max_velocity_residual: f64,
    min_pivot_ratio: f64,
    events: Vec<Event>,
    /// Whether the last accepted step may have passed a singular configuration.
    is_suspect: bool,
    /// By the number of dependent rows, whether the motion is unique in a passage.
    uniqueness: Vec<(usize, String)>,
    /// Whether the stages of the present step are moved onto the constraints.
    is_careful: bool,
    /// Derivatives by time, where nothing is free.
    by_time: Option<ByTime>,
    /// Whether stages of the present step were evaluated by code that has been left since: it
    /// begins again.
    is_void: bool,
    /// When the motion is expected to pass a singular configuration.
    delicate: Option<f64>,
    /// When a step was refused last because of a dropped row, and which.
    contradicted: Option<(f64, MotionFault)>,
    /// The last accepted step.
    last: Span,
    /// The state before a projection; a stage on the constraints.
    before: Vec<f64>,
    stage: Vec<f64>,
}

impl<'m> Equations<'m> {
    pub(super) fn new(
        motion: KeptRowMotion<'m>,
        prepared: &Prepared,
        options: &MotionOptions,
        wanted: AtRows,
    ) -> Self {
        let (q, v) = (&prepared.q, &prepared.v);
        let mechanism = motion.mechanism();
        let layout = mechanism.layout();
        Self {
            n_q: layout.n_q,
            n_v: layout.n_v,
            works: layout.rheonomic || mechanism.has_applied_forces(),
            nearest: (NEAREST_TOLERANCES * options.rtol).clamp(NEAREST, NEAREST_MAX),
            t_end: options.t_end,
            rtol: options.rtol,
            energy: EnergyBalance::new(mechanism, q, v),
            max_position_residual: 0.0,
            max_velocity_residual: 0.0,
            min_pivot_ratio: f64::INFINITY,
            events: Vec::new(),
            is_suspect: false,
            uniqueness: Vec::new(),
            is_careful: false,
            by_time: ByTime::for_run(prepared, options),
            is_void: false,
            delicate: None,
            contradicted: None,
            last: Span::default(),
            before: Vec::new(),
            stage: Vec::new(),
            wanted,
            reduced: None,
            motion,
        }
    }

    /// y at the start, where the rows are factored.
    pub(super) fn initial_state(&mut self, q: &[f64], v: &[f64]) -> Vec<f64> {
        let mut y = [q, v].concat();
        y.extend(self.works.then_some(0.0));
        self.before = y.clone();
        self.stage = y.clone();
        self.is_careful = self.wants_care();
        self.min_pivot_ratio = self.motion.pivot_ratio();
        y
    }

    /// Whether stages are functions of time. On the way to a singular configuration, where branches
    /// meet, the integrator leads them.
    fn is_by_time(&self) -> bool {
        self.by_time.is_some() && self.delicate.is_none()
    }

    /// Whether the next stages have to be moved onto the constraints: near singular configurations,
    /// and where they become functions of time by that. On a chart all of them lie there; without
    /// projection none shall.
    fn wants_care(&self) -> bool {
        let off = self.motion.projects() && self.motion.independent().is_none();
        off && (self.is_by_time() || self.motion.is_delicate())
    }

    /// The work is measured, not controlled: its error has no weight. It still counts as a
    /// component of the mean, which makes the control looser by the factor √((n + 1)/n).
    pub(super) fn tolerance(&self, options: &MotionOptions) -> Tolerance {
        if !self.works {
            return Tolerance::Uniform {
                rtol: options.rtol,
                atol: options.atol,
            };
        }
        let mut rtol = vec![options.rtol; self.n_q + self.n_v];
        let mut atol = vec![options.atol; self.n_q + self.n_v];
        rtol.push(0.0);
        atol.push(f64::MAX);
        Tolerance::PerComponent { rtol, atol }
    }

    /// Numbers and events of the run so far.
    pub(super) fn summary(&self) -> super::Summary {
        super::Summary {
            max_position_residual: self.max_position_residual,
            max_velocity_residual: self.max_velocity_residual,
            energy_balance: energy::relative(
                self.energy.largest_gap(),
                self.energy.largest_kinetic(),
            ),
            energy_gap: self.energy.largest_gap(),
            largest_kinetic_energy: self.energy.largest_kinetic(),
            min_pivot_ratio: self.min_pivot_ratio,
            events: self.events.clone(),
            ..super::Summary::default()
        }
    }

    /// Projects a row of output, where states are projected, and shows it. At a break time it is
    /// the state just before.
    pub(super) fn show(
        &mut self,
        t: f64,
        y: &mut [f64],
        row: &mut super::ShowRow<'_>,
    ) -> Result<ControlFlow<()>, MotionFault> {
        let t_before = if t > 0.0 && self.is_break(t) {
            t.next_down()
        } else {
            t
        };
        let (q, rest) = y.split_at_mut(self.n_q);
        // On a chart only independent coordinates are interpolated, and code knows its own.
        let is_whole = self.motion.independent().is_none() && !self.motion.is_coded();
        let found = match self.wanted.on_constraints || !is_whole {
            true => Some(self.motion.end_row(t_before, q, &mut rest[..self.n_v])?),
            false => None,
        };
        let mechanism = self.motion.mechanism();
        if GUARDED {
            finite(mechanism, t, y)?;
            self.last.check(mechanism, self.motion.size(), t, y)?;
        }
        if let Some(found) = found {
            self.note(y, found);
        }
        let (q, v) = (&y[..self.n_q], &y[self.n_q..self.n_q + self.n_v]);
        let work = self.work(y);
        let blind = (BLIND_TOLERANCES * self.rtol).clamp(BLIND, BLIND_MAX);
        let source = OfMotion {
            t_before,
            blind,
            wanted: &self.wanted,
            motion: &mut self.motion,
        };
        row(&mut Sample {
            t,
            q,
            v,
            work,
            source: Source::Motion(source),
        })
    }

    /// The motion with its linear systems.
    fn implicit(&mut self) -> (&mut KeptRowMotion<'m>, &mut Reduced) {
        let new = || Reduced::new(&self.motion);
        let reduced = self.reduced.get_or_insert_with(new);
        (&mut self.motion, reduced)
    }

    /// Takes an accepted step, for the rows in it.
    pub(super) fn take_step(&mut self, times: [f64; 2], ends: [&[f64]; 4]) {
        self.last.take(times, ends);
    }

    /// Whether the last accepted step may have passed a singular configuration.
    pub(super) fn is_suspect(&self) -> bool {
        self.is_suspect
    }

    /// Share of the reference to which a pivot falls that vanishes, as well as this run knows.
    pub(super) fn passage_noise(&self) -> f64 {
        self.nearest
    }

    /// Whether steps have collapsed because of a singular configuration nearby.
    pub(super) fn is_lost(&self, error: &IntegrationError<MotionFault>) -> bool {
        let has_collapsed = matches!(error, IntegrationError::StepSizeCollapsed { .. });
        has_collapsed && self.motion.is_delicate()
    }

    /// The dropped row because of which steps have collapsed at time t: the ever smaller ones on
    /// this side of a contradiction are good, and say nothing of it.
    pub(super) fn contradiction(
        &mut self,
        error: &IntegrationError<MotionFault>,
        t: f64,
    ) -> Option<MotionFault> {
        let has_collapsed = matches!(error, IntegrationError::StepSizeCollapsed { .. });
        let (end, fault) = self.contradicted.take().filter(|_| has_collapsed)?;
        (end - t <= JUST_AHEAD * self.t_end).then_some(fault)
    }

    /// What is known of passages where so many rows are dependent.
    pub(super) fn uniqueness_of(&self, dependent: usize) -> Option<&str> {
        let known = self.uniqueness.iter().find(|(d, _)| *d == dependent);
        known.map(|(_, words)| words.as_str())
    }

    /// Keeps it.
    pub(super) fn remember_uniqueness(&mut self, dependent: usize, words: String) {
        self.uniqueness.push((dependent, words));
    }

    /// Numbers of coordinates and velocities.
    pub(super) fn sizes(&self) -> (usize, usize) {
        (self.n_q, self.n_v)
    }

    /// Records what happened.
    pub(super) fn record(&mut self, event: Event) {
        self.events.push(event);
    }

    /// The end of a step on generated code, which goes on as long as it is sure of itself.
    fn end_of_coded_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, MotionFault> {
        let ended = self.motion.end_coded_step(step.t_rhs, y, dy);
        self.note_departure();
        let Some(found) = ended? else {
            self.is_void = false;
            return Ok(StepEnd::Reject);
        };
        for (before, y) in self.before.iter_mut().zip(&*y) {
            *before -= y;
        }
        let (q, v) = (&y[..self.n_q], &y[self.n_q..self.n_q + self.n_v]);
        let a = &dy[self.n_q..self.n_q + self.n_v];
        self.motion.accept_coded((step.t, q, v, a));
        self.is_suspect = false;
        self.note(y, found);
        Ok(StepEnd::Projected {
            correction: step.norm(&self.before),
            evaluations: 1,
        })
    }

    /// If code was left: the interpreter goes on from the last accepted state as if it had led
    /// there.
    fn note_departure(&mut self) {
        let Some(departure) = self.motion.take_departure() else {
            return;
        };
        self.events.push(departure.event);
        self.is_void = departure.is_within_step;
        self.delicate = self.motion.foresee_from_code(FORESIGHT);
        self.is_careful = self.wants_care();
    }

    /// f(t, y) by the interpreter.
    fn evaluate(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), MotionFault> {
        if !self.is_careful {
            self.motion.derivative(t, y, dy)?;
            return match &mut self.reduced {
                Some(reduced) => reduced.follow(&mut self.motion),
                None => Ok(()),
            };
        }
        let mut stage = std::mem::take(&mut self.stage);
        stage.copy_from_slice(y);
        let (q, rest) = stage.split_at_mut(self.n_q);
        let result = self
            .motion
            .approach(t, q, &mut rest[..self.n_v])
            .and_then(|()| self.motion.derivative(t, &stage, dy));
        self.stage = stage;
        result
    }

    fn is_break(&self, t: f64) -> bool {
        let times = &self.motion.mechanism().layout().break_times;
        times.binary_search_by(|b| b.total_cmp(&t)).is_ok()
    }

    /// Notes residuals and energy of a projected state.
    fn note(&mut self, y: &[f64], found: Correction) {
        if !GUARDED {
            return;
        }
        self.max_position_residual = self.max_position_residual.max(found.position_residual);
        self.max_velocity_residual = self.max_velocity_residual.max(found.velocity_residual);
        let (q, v) = (&y[..self.n_q], &y[self.n_q..self.n_q + self.n_v]);
        let work = self.work(y);
        self.energy.note(self.motion.mechanism(), q, v, work);
    }

    /// Work of drives and applied forces (J), where there are any.
    fn work(&self, y: &[f64]) -> f64 {
        y.get(self.n_q + self.n_v).copied().unwrap_or(0.0)
    }
}

/// A row of output y = [q; v; …] has finite numbers: between the finite ends of a step, sums may
/// leave their range.
fn finite(mechanism: &Mechanism, t: f64, y: &[f64]) -> Result<(), MotionFault> {
    let (n_q, n_v) = (mechanism.layout().n_q, mechanism.layout().n_v);
    let y = &y[..n_q + n_v];
    // x·0 is NaN exactly for NaN and infinities.
    if y.iter().map(|x| x * 0.0).sum::<f64>() == 0.0 {
        return Ok(());
    }
    let Some(k) = y.iter().position(|x| !x.is_finite()) else {
        return Ok(());
    };
    let (what, (body, coordinate)) = match k < n_q {
        true => ("", mechanism.coordinate_name(k)),
        false => ("rate of the ", mechanism.coordinate(k - n_q)),
    };
    Err(MotionFault::NotFinite {
        time: t,
        what: format!("the {what}{coordinate} of `{body}`"),
    })
}

impl Ode for Equations<'_> {
    type Error = MotionFault;

    fn dim(&self) -> usize {
        self.n_q + self.n_v + usize::from(self.works)
    }

    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), MotionFault> {
        if self.motion.is_coded() {
            let evaluated = self.motion.derivative(t, y, dy);
            self.note_departure();
            return evaluated;
        }
        let by_time = self.is_by_time();
        let Some(mut known) = self.by_time.take_if(|_| by_time) else {
            return self.evaluate(t, y, dy);
        };
        let evaluated = known.recall(t, dy, |dy| self.evaluate(t, y, dy));
        self.by_time = Some(known);
        evaluated
    }

    fn end_of_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, MotionFault> {
        self.before.copy_from_slice(y);
        let known = self.by_time.as_mut();
        let is_known = known.is_some_and(|known| known.take(step.t_rhs, dy));
        if std::mem::take(&mut self.is_void) {
            return Ok(StepEnd::Reject);
        }
        if self.motion.is_coded() {
            return self.end_of_coded_step(step, y, dy);
        }
        // A step has to end at the break times and at the end of the run, wherever that is.
        let nearest = if step.t == self.t_end || self.is_break(step.t) {
            0.0
        } else {
            self.nearest
        };
        let (q, rest) = y.split_at_mut(self.n_q);
        let v = &mut rest[..self.n_v];
        let ended = self.motion.end_step(step.t_rhs, q, v, nearest);
        if let Err(fault @ MotionFault::DroppedRow { .. }) = &ended {
            self.contradicted = Some((step.t, fault.clone()));
        }
        let found = ended?;
        let pivot_ratio = self.motion.pivot_ratio();
        for (before, y) in self.before.iter_mut().zip(&*y) {
            *before -= y;
        }
        let foreseen = self.delicate.is_some_and(|t| step.t0 < t && t <= step.t);
        let is_suspect = foreseen || self.motion.may_have_passed();
        if is_suspect && !self.motion.projects() {
            let (q, v) = (&y[..self.n_q], &y[self.n_q..self.n_q + self.n_v]);
            let missed = self.motion.missed_correction(step.t_rhs, q, v)?;
            self.before[..missed.len()].copy_from_slice(&missed);
        }
        let correction = step.norm(&self.before);
        if is_suspect && correction * self.rtol > SMOOTH * self.motion.relative_pivot().max(NEAREST)
        {
            return Err(self.motion.no_way_over(step.t));
        }
        if self.motion.projects() {
            if is_suspect || !is_known {
                self.motion.derivative_of_projected(step.t_rhs, y, dy)?;
            }
            let a = &dy[self.n_q..self.n_q + self.n_v];
            let now = (step.t, &y[self.n_q..self.n_q + self.n_v], a);
            if is_suspect && !self.motion.goes_on_smoothly(now) {
                return Err(self.motion.no_way_over(step.t));
            }
            self.motion.note_sound(now);
            if self.motion.independent().is_some() {
                let (q, rest) = y.split_at(self.n_q);
                self.motion.check_travel(step.t_rhs, q, &rest[..self.n_v])?;
            }
        }
        // From here on the step stands.
        self.is_suspect = is_suspect;
        self.note(y, found);
        self.events.extend(self.motion.accept(step.t));
        self.min_pivot_ratio = self.min_pivot_ratio.min(pivot_ratio);
        if !self.motion.projects() {
            return Ok(StepEnd::Unchanged);
        }
        let (q, v) = (&y[..self.n_q], &y[self.n_q..self.n_q + self.n_v]);
        let now = (step.t, q, v, &dy[self.n_q..self.n_q + self.n_v]);
        self.delicate = self
            .motion
            .foresee(now, step.t + FORESIGHT * (step.t - step.t0));
        self.is_careful = self.wants_care();
        if !is_suspect && self.delicate.is_none() {
            let returned = self.motion.return_to_code(now);
            self.events.extend(returned);
        }
        Ok(StepEnd::Projected {
            correction,
            evaluations: 1,
        })
    }

    fn delicate_time(&self) -> Option<Delicate> {
        let slack = (PASSED / self.rtol).max(1.0);
        self.delicate.map(|t| Delicate { t, slack })
    }

    /// Rates that jump make the velocities jump, by an impulse of the constraints.
    fn at_break(&mut self, t: f64, y: &mut [f64]) -> Result<(), MotionFault> {
        let (q, rest) = y.split_at_mut(self.n_q);
        let (v, work) = rest.split_at_mut(self.n_v);
        self.by_time.iter_mut().for_each(ByTime::forget);
        if let Some(impulse) = self.motion.cross_break(t, q, v)? {
            if let Some(work) = work.first_mut() {
                *work += impulse.energy;
            }
            self.events.push(impulse.event);
        }
        Ok(())
    }
}

impl Implicit for Equations<'_> {
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
