//! The instant at which one-sided joints of a run can no longer all stay closed.

use integrators::Step;
use linalg::kernels::max_abs;
use model::{ConstraintId, Mechanism, System};
use solvability::{CarriedContacts, Closure, opened};

use super::equations::RunEquations;
use crate::error::MotionFault;
use crate::events::{Event, EventKind};
use crate::limits::{OPENING_SEARCH, OPENING_TIME};

/// The one-sided joints of a run.
pub(super) struct RunContacts {
    joints: CarriedContacts,
    /// Longest time (s) between two states at which the joints are examined. Forces that do not
    /// move any body do not shorten the steps.
    every: f64,
}

impl RunContacts {
    /// Returns the one-sided joints, or `None` if there are no such joints. The joints are examined
    /// at steps and as often as there are output rows.
    pub(super) fn of(mechanism: &Mechanism, output_step: f64) -> Option<Self> {
        let joints = CarriedContacts::of(mechanism)?;
        Some(Self {
            joints,
            every: output_step,
        })
    }
}

/// The state at which one-sided joints open.
pub(super) struct Opening {
    /// Time (s).
    pub(super) t: f64,
    /// The state.
    pub(super) y: Vec<f64>,
    /// The error that ends the run.
    pub(super) fault: MotionFault,
}

/// Returns the state within an accepted step at which one-sided joints open, if one-sided joints
/// open in the step.
pub(super) fn opening(
    step: &mut Step<'_, RunEquations<'_>>,
) -> Result<Option<Opening>, MotionFault> {
    let Some(every) = step.ode().contacts.as_ref().map(|contacts| contacts.every) else {
        return Ok(None);
    };
    let (t0, t1) = (step.t0(), step.t1());
    let mut y = step.y1().to_vec();
    let count = ((t1 - t0) / every).ceil().max(1.0) as usize;
    let (mut closed, mut first) = (t0, None);
    for k in 1..=count {
        let share = k as f64 / count as f64;
        let t = if k == count {
            t1
        } else {
            t0 + (t1 - t0) * share
        };
        if step.interpolate_accurately(t, &mut y).is_err() {
            continue;
        }
        let found = step.ode().closure(t, &mut y, k == count)?;
        if found.is_clear() {
            first = Some((t, found));
            break;
        }
        closed = t;
    }
    let Some((mut open, found)) = first else {
        return Ok(None);
    };
    let last = open;
    for _ in 0..OPENING_SEARCH {
        let middle = f64::midpoint(closed, open);
        if open - closed <= OPENING_TIME * open || middle <= closed || middle >= open {
            break;
        }
        if step.interpolate_accurately(middle, &mut y).is_err() {
            break;
        }
        if step.ode().closure(middle, &mut y, false)?.is_lost {
            open = middle;
        } else {
            closed = middle;
        }
    }
    // Clearly after the instant, the accelerations of the gaps are not zero.
    let after = if open < last {
        f64::midpoint(open, last)
    } else {
        last
    };
    if step.interpolate_accurately(after, &mut y).is_ok() {
        step.ode().closure(after, &mut y, after == t1)?;
    }
    let fault = step.ode().fault((after, &y), closed, &found);
    if step.interpolate_accurately(closed, &mut y).is_err() {
        y.copy_from_slice(step.y0());
    }
    step.ode().note(closed, &fault);
    Ok(Some(Opening {
        t: closed,
        y,
        fault,
    }))
}

/// Returns the error of a start at which one-sided joints cannot all stay closed.
pub(super) fn opening_at_start(
    equations: &mut RunEquations<'_>,
    (t, y): (f64, &[f64]),
) -> Result<Option<MotionFault>, MotionFault> {
    if !equations.has_contacts() {
        return Ok(None);
    }
    let mut y = y.to_vec();
    let found = equations.closure(t, &mut y, false)?;
    if !found.is_clear() {
        return Ok(None);
    }
    let fault = equations.fault((t, &y), t, &found);
    equations.note(t, &fault);
    Ok(Some(fault))
}

impl RunEquations<'_> {
    /// Returns whether a joint is one-sided.
    pub(super) fn has_contacts(&self) -> bool {
        self.contacts.is_some()
    }

    /// Decides whether all one-sided joints can stay closed. A state that violates the constraints
    /// is moved onto the constraint manifold first.
    fn closure(
        &mut self,
        t: f64,
        y: &mut [f64],
        is_on_constraints: bool,
    ) -> Result<Closure, MotionFault> {
        let t_before = if self.is_break(t) { t.next_down() } else { t };
        if !is_on_constraints {
            self.lead_completion(t);
            let (q, v, _) = self.motion.parts_mut(y);
            self.motion.end_row(t_before, (q, v))?;
        }
        let (q, v) = self.motion.parts(y);
        let layout = self.motion.mechanism().layout();
        let (mut a, mut multipliers) = (vec![0.0; layout.n_v], vec![0.0; layout.rows()]);
        self.motion.equations.factor_at(t_before, q)?;
        self.motion.solve_factored(v, &mut a)?;
        self.motion.multipliers_for(&a, &mut multipliers)?;
        let loads = max_abs(&self.motion.equations.at.s.force);
        self.closure_for(&multipliers, loads, false)
    }

    /// Decides whether contacts stay closed and hold for these multipliers with any self-stress.
    /// The rows are factored. `size` is the size of the loads. Impulses do not make contacts slip.
    fn closure_for(
        &mut self,
        multipliers: &[f64],
        size: f64,
        are_impulses: bool,
    ) -> Result<Closure, MotionFault> {
        let mechanism = self.motion.mechanism();
        let equations = &mut self.motion.equations;
        let mut dependencies = Vec::new();
        let (at, rows) = (&equations.at, &mut equations.velocity);
        let is_blind = rows.n_left_out() > 0 || rows.relative_pivot() < self.motion.watch.blind();
        let contacts = self.contacts.as_ref().filter(|_| !is_blind);
        let Some(contacts) = contacts else {
            return Ok(Closure::default());
        };
        if contacts.joints.are_kept(mechanism, &at.s, multipliers) {
            return Ok(Closure::default());
        }
        rows.all_dependencies(at, &mut dependencies)?;
        let state = (mechanism, &at.s);
        let permitted = (contacts.joints).permitted(state, (multipliers, size), &dependencies);
        Ok(if are_impulses {
            permitted.opening()
        } else {
            permitted.closure()
        })
    }

    /// Ends the run if an impulse with these multipliers must pull on a one-sided joint.
    ///
    /// # Errors
    /// [`MotionFault::Opens`]
    pub(super) fn check_impulse(&mut self, t: f64, multipliers: &[f64]) -> Result<(), MotionFault> {
        if !self.has_contacts() {
            return Ok(());
        }
        let found = self.closure_for(multipliers, max_abs(multipliers), true)?;
        if !found.is_clear() {
            return Ok(());
        }
        let joints = self.names(&found.opening);
        let fault = MotionFault::Opens { time: t, joints };
        self.note(t, &fault);
        Err(fault)
    }

    fn names(&self, ids: &[ConstraintId]) -> Vec<String> {
        let groups = &self.motion.mechanism().layout().groups;
        ids.iter().map(|id| groups[id.0].name.clone()).collect()
    }

    /// Returns the error that ends the run at this time, for contacts that are lost at a state.
    fn fault(&self, (t, y): (f64, &[f64]), time: f64, found: &Closure) -> MotionFault {
        if found.opening.is_empty() {
            let joints = self.names(&found.slipping);
            return MotionFault::Slips { time, joints };
        }
        let mechanism = self.motion.mechanism();
        let (q, v) = self.motion.parts(y);
        let joints = self.names(&opened(mechanism, (t, q, v), &found.opening));
        MotionFault::Opens { time, joints }
    }

    /// Records the event of an error that ends the run.
    fn note(&mut self, time: f64, fault: &MotionFault) {
        let kind = match fault {
            MotionFault::Slips { .. } => EventKind::Slips,
            _ => EventKind::Lifts,
        };
        let dropped = self.motion.equations.without_multiplier();
        let event = Event::at(time, kind, dropped, fault.to_string());
        self.record.events.push(event);
    }
}
