//! A motion on generated code: accelerations, multipliers and projections of a [`SceneCode`],
//! watched at every stage and step. Whatever the code is not sure of is left to the interpreter,
//! which begins again at the last accepted state; nothing here ends a run. Not here: whether code
//! belongs to a mechanism ([`crate::code`]).
//!
//! The interpreter sleeps while code is used. It wakes up at the last two accepted states, because
//! it foresees singular configurations from the pivots of two.

use std::sync::Arc;

use model::{Mechanism, System};

use super::{Correction, KeptRowMotion};
use crate::code::{LEAVE, SceneCode};
use crate::error::MotionFault;
use crate::events::{Event, EventKind};
use crate::guards::GUARDED;

/// Code comes back above this health.
const RETURN: f64 = 0.3;

/// Accepted steps before code comes back at first; twice as many after every further time it was
/// left.
const PATIENCE: u64 = 8;

/// Accelerations of code that comes back differ from interpreted ones by at most this share.
const SAME: f64 = 1e-9;

/// Corrections of the position per projection.
const CORRECTIONS: usize = 6;

/// Corrections of the velocity per projection.
const VELOCITY_PASSES: usize = 3;

/// Kept rows count as satisfied below this many roundings of their terms.
const ROUNDINGS: f64 = 50.0;

/// Rows of bodies at rest feel the rounding of others: their terms count as this share of the
/// largest.
const AT_REST: f64 = 1e-4;

/// Dropped rows count as implied by the kept ones below this share of the largest terms: as for the
/// interpreter.
const DROPPED_MISFIT: f64 = 1e-11;

/// Why code is not sure.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Doubt {
    /// A pivot is small, or has changed its sign.
    Health { health: f64 },
    /// A result is NaN or infinite.
    NotFinite,
    /// A kept row misses after all corrections.
    OffConstraints { row: usize, by: f64 },
    /// A dropped row is not implied.
    DroppedRow { row: usize, by: f64 },
}

impl std::fmt::Display for Doubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::Health { health } => write!(
                f,
                "its pivots have fallen to {health:.2} of those that it was generated for (limit {LEAVE})"
            ),
            Self::NotFinite => write!(f, "a result of it is not finite"),
            Self::OffConstraints { row, by } => {
                write!(f, "its corrections leave row {} off by {by:.3e}", row + 1)
            }
            Self::DroppedRow { row, by } => {
                write!(f, "the dropped row {} misses by {by:.3e}", row + 1)
            }
        }
    }
}

/// What evaluates at present.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// The code.
    Code,
    /// The interpreter, which has not woken up yet.
    Waking,
    /// The interpreter, for so many accepted steps.
    Interpreter(u64),
}

/// A state of an accepted step.
#[derive(Clone, Debug, Default)]
struct Accepted {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl Accepted {
    fn take(&mut self, (t, q, v, a): (f64, &[f64], &[f64], &[f64])) {
        self.t = t;
        for (kept, x) in [(&mut self.q, q), (&mut self.v, v), (&mut self.a, a)] {
            kept.clear();
            kept.extend_from_slice(x);
        }
    }
}

/// Generated code in use.
pub(super) struct Coded {
    code: Arc<dyn SceneCode>,
    phase: Phase,
    /// Evaluations of the code since the last accepted step.
    evaluations: u64,
    /// Accepted steps before it may come back.
    patience: u64,
    /// The last two accepted states of the code, the last one first, and how many there are.
    accepted: [Accepted; 2],
    n_accepted: usize,
    departure: Option<Departure>,
    /// Rows of Φ and of C that the code keeps.
    keeps_position: Vec<bool>,
    keeps: Vec<bool>,
    /// What coordinates are measured by.
    units: Vec<f64>,
    /// For each row columns of C and what its entries there are at most.
    bounds: Vec<Vec<(usize, f64)>>,
    /// Sizes of the terms of each row.
    sizes: Vec<f64>,
    phi: Vec<f64>,
    residual: Vec<f64>,
    dq: Vec<f64>,
    dv: Vec<f64>,
}

/// Code was left.
pub(crate) struct Departure {
    /// Where the interpreter goes on.
    pub(crate) event: Event,
    /// Whether stages of the present step are the code's, so that the step has to begin again.
    pub(crate) is_within_step: bool,
}

fn are_finite(x: &[f64]) -> bool {
    x.iter().all(|x| x.is_finite())
}

/// NaN is never healthy.
fn check(health: f64, results: &[f64]) -> Result<(), Doubt> {
    if !GUARDED {
        return Ok(());
    }
    if health.is_nan() || health < LEAVE {
        return Err(Doubt::Health { health });
    }
    match are_finite(results) {
        true => Ok(()),
        false => Err(Doubt::NotFinite),
    }
}

fn add(x: &mut [f64], dx: &[f64]) {
    for (x, dx) in x.iter_mut().zip(dx) {
        *x += dx;
    }
}

/// The largest |x_j| in its unit; beyond those that have one, as it is.
fn largest(x: &[f64], units: &[f64]) -> f64 {
    let units = units.iter().chain(std::iter::repeat(&1.0));
    let shares = x.iter().zip(units).map(|(x, unit)| x.abs() / unit);
    shares.fold(0.0, f64::max)
}

/// The row that misses most of those that are kept, by how much, and as share of the size of its
/// terms; infinite where that is not a number.
fn worst_kept(x: &[f64], keeps: &[bool], sizes: &[f64]) -> (usize, f64, f64) {
    let rows = x.iter().zip(keeps).zip(sizes).enumerate();
    let rows = rows.filter(|(_, ((x, keeps), _))| **keeps && **x != 0.0);
    rows.fold((0, 0.0, 0.0), |worst, (i, ((x, _), size))| {
        match (x.abs(), x.abs() / size) {
            (by, share) if share > worst.2 => (i, by, share),
            (_, share) if share.is_nan() => (i, f64::INFINITY, f64::INFINITY),
            _ => worst,
        }
    })
}

/// Dropped rows that miss what the kept ones imply: beside the largest row, because rounding of all
/// of them reaches these.
fn check_dropped(x: &[f64], keeps: &[bool], sizes: &[f64]) -> Result<(), Doubt> {
    if !GUARDED {
        return Ok(());
    }
    let largest = sizes.iter().fold(0.0, |a, size| f64::max(a, *size));
    let misses = |x: &f64| x.is_nan() || x.abs() > DROPPED_MISFIT * largest;
    let mut dropped = x.iter().zip(keeps).enumerate();
    match dropped.find(|(_, (x, keeps))| !**keeps && misses(x)) {
        Some((row, (x, _))) => Err(Doubt::DroppedRow { row, by: x.abs() }),
        None => Ok(()),
    }
}

impl Coded {
    fn new(code: Arc<dyn SceneCode>, motion: &KeptRowMotion<'_>, t: f64, q: &[f64]) -> Self {
        let mechanism = motion.mechanism;
        let layout = mechanism.layout();
        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.c(&mut s);
        let units: Vec<f64> = (0..layout.n_v)
            .map(|j| mechanism.unit(j, motion.size))
            .collect();
        let bounds = (0..layout.rows()).map(|i| mechanism.entry_bounds(&s, i));
        let bounds: Vec<Vec<(usize, f64)>> = bounds.collect();
        let keeps = |kept: &[usize], rows: usize| (0..rows).map(|i| kept.contains(&i)).collect();
        Self {
            phase: Phase::Code,
            evaluations: 0,
            patience: PATIENCE,
            accepted: Default::default(),
            n_accepted: 0,
            departure: None,
            keeps_position: keeps(&motion.position.kept, layout.m),
            keeps: keeps(&motion.velocity.kept, layout.rows()),
            sizes: vec![0.0; bounds.len()],
            bounds,
            units,
            phi: vec![0.0; layout.m],
            residual: vec![0.0; layout.rows()],
            dq: vec![0.0; layout.n_v],
            dv: vec![0.0; layout.n_v],
            code,
        }
    }

    /// Moves q and v onto the constraints and checks all rows.
    fn project(
        &mut self,
        mechanism: &Mechanism,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<Correction, Doubt> {
        let Self {
            code,
            keeps_position,
            keeps,
            bounds,
            sizes,
            phi,
            residual,
            dq,
            dv,
            ..
        } = self;
        for (size, bounds) in sizes.iter_mut().zip(&*bounds) {
            *size = mechanism.bounded_position_scale(bounds, q);
        }
        let mut iterations = 0;
        code.phi(t, q, phi);
        loop {
            iterations += 1;
            check(code.position_correction(t, q, phi, dq), dq)?;
            mechanism.displace(q, dq);
            code.phi(t, q, phi);
            let (row, by, share) = worst_kept(phi, keeps_position, sizes);
            if share <= ROUNDINGS * f64::EPSILON {
                break;
            }
            if iterations == CORRECTIONS {
                return Err(Doubt::OffConstraints { row, by });
            }
        }
        check_dropped(phi, keeps_position, &sizes[..phi.len()])?;
        let mut passes = 0;
        code.velocity_residual(t, q, v, residual);
        loop {
            passes += 1;
            check(code.velocity_correction(t, q, residual, dv), dv)?;
            add(v, dv);
            code.velocity_residual(t, q, v, residual);
            for (size, bounds) in sizes.iter_mut().zip(&*bounds) {
                *size = bounds.iter().map(|&(j, c)| c * v[j].abs()).sum();
            }
            let least = AT_REST * sizes.iter().fold(0.0, |a, size| f64::max(a, *size));
            for size in sizes.iter_mut() {
                *size = size.max(least);
            }
            let (row, by, share) = worst_kept(residual, keeps, sizes);
            if share <= ROUNDINGS * f64::EPSILON {
                break;
            }
            if passes == VELOCITY_PASSES {
                return Err(Doubt::OffConstraints { row, by });
            }
        }
        check_dropped(residual, keeps, sizes)?;
        let largest = |x: &[f64]| x.iter().fold(0.0, |a, x| f64::max(a, x.abs()));
        Ok(Correction {
            iterations,
            position_residual: largest(phi),
            velocity_residual: largest(residual),
        })
    }
}

impl KeptRowMotion<'_> {
    /// Uses code from the state q at time t on.
    pub(super) fn use_code(&mut self, code: Arc<dyn SceneCode>, t: f64, q: &[f64]) {
        self.coded = Some(Coded::new(code, self, t, q));
    }

    /// Whether code evaluates at present.
    pub(crate) fn is_coded(&self) -> bool {
        matches!(&self.coded, Some(coded) if coded.phase == Phase::Code)
    }

    /// Accelerations by code; `false` where there is none in use or it is not sure, and the
    /// interpreter has to answer.
    pub(super) fn coded_acceleration(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        a: &mut [f64],
    ) -> bool {
        match &self.coded {
            Some(coded) if coded.phase == Phase::Code => {
                check(coded.code.acceleration(t, q, v, a), a).is_ok()
            }
            _ => false,
        }
    }

    /// The same for an evaluation of a run. Code that is not sure is left, and the interpreter
    /// wakes up.
    pub(super) fn coded_stage(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        a: &mut [f64],
    ) -> Result<bool, MotionFault> {
        let Some(coded) = &mut self.coded else {
            return Ok(false);
        };
        if coded.phase == Phase::Code {
            match check(coded.code.acceleration(t, q, v, a), a) {
                Ok(()) => {
                    coded.evaluations += 1;
                    return Ok(true);
                }
                Err(doubt) => self.leave_code(t, doubt),
            }
        }
        self.wake_up()?;
        Ok(false)
    }

    /// Multipliers by code, with the pose of the state in the scratch, where reactions are read;
    /// `false` as for accelerations.
    pub(super) fn coded_multipliers(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        lambda: &mut [f64],
    ) -> bool {
        let Some(coded) = self.coded.as_ref().filter(|c| c.phase == Phase::Code) else {
            return false;
        };
        if check(coded.code.multipliers(t, q, v, lambda), lambda).is_err() {
            return false;
        }
        self.mechanism.pose(t, q, &mut self.s);
        self.mechanism.c(&mut self.s);
        true
    }

    /// Projects a row of output by code; nothing, and q and v as they were, if it is not sure.
    pub(super) fn coded_row(&mut self, t: f64, q: &mut [f64], v: &mut [f64]) -> Option<Correction> {
        let coded = self.coded.as_mut().filter(|c| c.phase == Phase::Code)?;
        self.guess.copy_from_slice(q);
        self.delta.copy_from_slice(v);
        match coded.project(self.mechanism, t, q, v) {
            Ok(found) => Some(found),
            Err(_) => {
                q.copy_from_slice(&self.guess);
                v.copy_from_slice(&self.delta);
                None
            }
        }
    }

    /// Projects a step of the code that passed its error test, and evaluates its end; nothing where
    /// the step has to begin again with the interpreter.
    pub(crate) fn end_coded_step(
        &mut self,
        t: f64,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<Option<Correction>, MotionFault> {
        let n_q = self.mechanism.layout().n_q;
        let n_v = self.mechanism.layout().n_v;
        let Some(coded) = &mut self.coded else {
            return Ok(None);
        };
        let (q, rest) = y.split_at_mut(n_q);
        let v = &mut rest[..n_v];
        match coded.project(self.mechanism, t, q, v) {
            Ok(found) => {
                self.derivative(t, y, dy)?;
                Ok(self.is_coded().then_some(found))
            }
            Err(doubt) => {
                self.leave_code(t, doubt);
                self.wake_up()?;
                Ok(None)
            }
        }
    }

    /// Takes an accepted state of the code.
    pub(crate) fn accept_coded(&mut self, now: (f64, &[f64], &[f64], &[f64])) {
        if !GUARDED {
            return;
        }
        if let Some(coded) = &mut self.coded {
            coded.accepted.swap(0, 1);
            coded.accepted[0].take(now);
            coded.n_accepted = (coded.n_accepted + 1).min(2);
            coded.evaluations = 0;
        }
    }

    /// Velocities have jumped at t: states before tell nothing of what follows.
    pub(super) fn restart_code(&mut self, t: f64) {
        if let Some(coded) = self.coded.as_mut().filter(|c| c.phase == Phase::Code) {
            coded.n_accepted = 0;
            self.passage.take(&mut self.velocity, t);
        }
    }

    /// Told once when code was left.
    pub(crate) fn take_departure(&mut self) -> Option<Departure> {
        self.coded.as_mut().and_then(|c| c.departure.take())
    }

    /// When the motion will be singular, as [`KeptRowMotion::foresee`] sees it from the last two
    /// states that the code has accepted, for so many steps like that between them.
    pub(crate) fn foresee_from_code(&self, steps: f64) -> Option<f64> {
        let coded = self.coded.as_ref().filter(|c| c.n_accepted == 2)?;
        let [Accepted { t, q, v, a }, before] = &coded.accepted;
        self.foresee((*t, q, v, a), t + steps * (t - before.t))
    }

    /// Goes back to code at an accepted, interpreted state far from singular configurations, if it
    /// is as good as before there and has been left long enough ago.
    pub(crate) fn return_to_code(
        &mut self,
        (t, q, v, a): (f64, &[f64], &[f64], &[f64]),
    ) -> Option<Event> {
        let coded = self.coded.as_mut()?;
        let Phase::Interpreter(steps) = &mut coded.phase else {
            return None;
        };
        *steps += 1;
        let facts = coded.code.facts();
        let has_its_rows = self.aside.is_none()
            && *self.velocity.kept == *facts.kept
            && *self.position.kept == *facts.position_kept;
        if *steps < coded.patience || !has_its_rows || self.velocity.are_delicate() {
            return None;
        }
        let units = &coded.units;
        let found = &mut coded.dv;
        let health = coded.code.acceleration(t, q, v, found);
        for (found, a) in found.iter_mut().zip(a) {
            *found -= a;
        }
        let is_same =
            largest(found, units) <= SAME * largest(a, units).max(largest(v, units).powi(2));
        let is_sound = health >= RETURN && is_same && are_finite(found);
        if !is_sound {
            return None;
        }
        coded.phase = Phase::Code;
        coded.patience = coded.patience.saturating_mul(2);
        coded.n_accepted = 0;
        coded.evaluations = 0;
        let text = format!(
            "the generated code `{}` is used again: its pivots are at {health:.2} of those that it was generated for. The motion is the same.",
            facts.name
        );
        Some(self.code_event(EventKind::CodeUsed, t, text))
    }

    fn leave_code(&mut self, t: f64, doubt: Doubt) {
        let Some(coded) = &mut self.coded else {
            return;
        };
        coded.phase = Phase::Waking;
        let is_within_step = coded.evaluations > 0;
        let since = match coded.n_accepted {
            0 => self.passage.since(),
            _ => coded.accepted[0].t,
        };
        let text = format!(
            "the generated code `{}` is left, because at t = {t} s {doubt}; from here on the equations are interpreted. The motion is the same.",
            coded.code.facts().name
        );
        let event = self.code_event(EventKind::CodeLeft, since, text);
        if let Some(coded) = &mut self.coded {
            coded.departure = Some(Departure {
                event,
                is_within_step,
            });
        }
    }

    /// Lets the interpreter see the last accepted states of the code, if it has not yet.
    fn wake_up(&mut self) -> Result<(), MotionFault> {
        let Some(mut coded) = self.coded.take_if(|c| c.phase == Phase::Waking) else {
            return Ok(());
        };
        let seen = coded.accepted[..coded.n_accepted]
            .iter_mut()
            .rev()
            .try_for_each(|state| {
                self.settle(state.t, &mut state.q)?;
                self.passage.take(&mut self.velocity, state.t);
                self.note_sound((state.t, &state.v, &state.a));
                Ok(())
            });
        if seen.is_ok() {
            coded.phase = Phase::Interpreter(0);
        }
        self.coded = Some(coded);
        seen
    }

    fn code_event(&self, kind: EventKind, time: f64, text: String) -> Event {
        let redundancy = self.velocity.dropped.len();
        Event {
            time,
            kind,
            redundancy_before: redundancy,
            redundancy_after: redundancy,
            dropped: self.velocity.dropped.clone(),
            text,
        }
    }
}
