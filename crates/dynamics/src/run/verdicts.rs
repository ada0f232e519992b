//! The verdicts of a run. At accepted steps and output rows, the verdicts are computed from the
//! rows that are factored at these states.
//!
//! A parameter sweep needs only the verdicts on the whole run. For a sweep, the verdicts are
//! computed only at the ends of each time interval between two events.

use std::collections::HashMap;

use model::{ConstraintId, System};
use solvability::{CarriedState, CarriedVerdicts, Group, InstantOrder, Stretches, Value, Verdict};

use super::summary::DroppedRows;
use crate::error::MotionFault;
use crate::events::ReactionImpulse;
use crate::motion::KeptRowMotion;
use crate::options::MotionOptions;
use crate::plan::Verdicts;
use crate::prepare::PreparedMechanism;

/// Record of the verdicts of a run.
pub(super) struct RunVerdicts<'m> {
    /// The verdicts during the motion. `None` if no row is redundant, because all reactions are
    /// then unique.
    carried: Option<CarriedVerdicts<'m>>,
    /// Work memory for dependencies.
    dependencies: Vec<Vec<f64>>,
    /// The rows without multiplier at output rows.
    dropped: Vec<DroppedRows>,
    /// Time of the last event or break, or of the start (s).
    last_cut: f64,
    wanted: Verdicts,
    /// Number of steps.
    steps: usize,
    /// Whether the end of the last step is the first step end in its time interval.
    ends_first: bool,
}

impl<'m> RunVerdicts<'m> {
    /// Creates the record for a run with these independent rows.
    pub(super) fn new(
        motion: &KeptRowMotion<'m>,
        prepared: &PreparedMechanism,
        options: &MotionOptions,
        (groups, wanted): (&[Group], Verdicts),
    ) -> Self {
        let mechanism = motion.mechanism();
        let dropped = &prepared.decision.dropped;
        let start = (prepared.start_time(), prepared.q.as_slice());
        let mut carried = CarriedVerdicts::new(mechanism, start, dropped, options.rtol, groups);
        if let (Some(carried), Verdicts::OfRun) = (&mut carried, wanted) {
            carried.leave_out_instants();
        }
        Self {
            carried,
            dependencies: Vec::new(),
            dropped: Vec::new(),
            last_cut: prepared.start_time(),
            wanted,
            steps: 0,
            ends_first: false,
        }
    }

    /// Returns whether a verdict can change during the run.
    pub(super) fn may_change(&self) -> bool {
        self.carried.is_some()
    }

    /// Computes the verdicts at an output row if special instants are requested, and at the start.
    /// Records the rows without multiplier.
    pub(super) fn look_at_row(
        &mut self,
        motion: &mut KeptRowMotion<'_>,
        state: (f64, f64, &[f64]),
        is_factored: bool,
    ) -> Result<(), MotionFault> {
        self.note_row(motion, state.0);
        if self.wanted == Verdicts::OfRun && state.0 > motion.mechanism().layout().start_time {
            return Ok(());
        }
        self.look(motion, state, is_factored, InstantOrder::Next)
    }

    /// Computes the verdicts at a state. The state consists of its time, the time at which
    /// functions are evaluated, and its coordinates. `is_factored` states whether the rows are
    /// factored at this state.
    pub(super) fn look(
        &mut self,
        motion: &mut KeptRowMotion<'_>,
        (t, t_before, q): (f64, f64, &[f64]),
        is_factored: bool,
        looked: InstantOrder,
    ) -> Result<(), MotionFault> {
        let Some(carried) = &mut self.carried else {
            return Ok(());
        };
        let (equations, blind) = (&mut motion.equations, motion.watch.blind());
        if !is_factored {
            equations.factor_at(t_before, q)?;
        }
        let (at, rows) = (&equations.at, &mut equations.velocity);
        if rows.n_left_out() > 0 || rows.relative_pivot() < blind {
            carried.pass(t, looked);
            return Ok(());
        }
        rows.dependencies(at, &mut self.dependencies)?;
        let state = CarriedState {
            t,
            q,
            scratch: &at.s,
            dependencies: &self.dependencies,
        };
        carried.look(&state, looked);
        Ok(())
    }

    /// Returns the impulses of all joints and drives for these multipliers of all rows, which
    /// belong to one choice. The verdicts refer to this instant, at which the rows are factored.
    pub(super) fn impulses(
        &mut self,
        motion: &mut KeptRowMotion<'_>,
        (t, q): (f64, &[f64]),
        multipliers: &[f64],
    ) -> Result<Vec<ReactionImpulse>, MotionFault> {
        let (equations, blind) = (&mut motion.equations, motion.watch.blind());
        let (at, rows) = (&equations.at, &mut equations.velocity);
        let mut open: HashMap<_, Verdict> = HashMap::new();
        if let Some(carried) = &mut self.carried {
            let is_singular = rows.n_left_out() > 0 || rows.relative_pivot() < blind;
            if !is_singular {
                rows.dependencies(at, &mut self.dependencies)?;
            }
            let state = CarriedState {
                t,
                q,
                scratch: &at.s,
                dependencies: &self.dependencies,
            };
            let found = carried.components_at((!is_singular).then_some(&state));
            let named = found.into_iter();
            open = named
                .map(|(id, name, verdict)| ((id, name), verdict))
                .collect();
        }
        let layout = at.mechanism.layout();
        let reactions = at.mechanism.reactions(&at.s);
        let of = |id: ConstraintId| {
            let group = &layout.groups[id.0];
            let found = reactions.reaction(id, multipliers);
            let all: Vec<f64> = found.components(group.space).collect();
            let names = group.space.components();
            let own = group.components().into_iter().map(|c| (names[c], all[c]));
            let named = group.spec.component.zip(found.component);
            let component = |(name, value): (&'static str, f64)| {
                let verdict = open.get(&(id, name)).cloned();
                let verdict = verdict.unwrap_or(Verdict::Unique);
                (name, Value::new(value, verdict, None))
            };
            ReactionImpulse {
                id,
                components: own.chain(named).map(component).collect(),
            }
        };
        Ok(layout.constraint_ids().map(of).collect())
    }

    /// Records the rows without multiplier at an output row.
    fn note_row(&mut self, motion: &KeptRowMotion<'_>, t: f64) {
        let dropped = motion.equations.without_multiplier();
        if self.dropped.last().is_none_or(|last| last.rows != *dropped) {
            self.dropped.push(DroppedRows {
                from: t,
                rows: dropped.to_vec(),
            });
        }
    }

    /// Returns the joints and drives for which neither the force nor the torque is determined on
    /// the whole run. Later steps cannot change this result. The list is empty unless only verdicts
    /// on the whole run are requested. The last evaluation was inside a time interval.
    pub(super) fn not_of_run(&self) -> Vec<ConstraintId> {
        let asked = self
            .carried
            .as_ref()
            .filter(|_| self.wanted == Verdicts::OfRun);
        asked.map_or_else(Vec::new, CarriedVerdicts::without_determined)
    }

    /// Returns whether the verdicts must be computed at the end of a step.
    pub(super) fn are_wanted_at_step(&self) -> bool {
        self.carried.as_ref().is_some_and(|carried| {
            self.wanted == Verdicts::WithInstants
                || self.ends_first
                || self.steps.is_power_of_two() && carried.has_open()
        })
    }

    /// Starts time intervals at events within a step, given in the order of time, and after the
    /// step if `ends_there`. Returns the times before the end of the step at which verdicts must be
    /// computed. There is one such time between any two boundaries that have no evaluation between
    /// them. Another such time is the start of the last step of an interval.
    pub(super) fn cut(&mut self, events: &[f64], [t0, t1]: [f64; 2], ends_there: bool) -> Vec<f64> {
        let Some(carried) = &mut self.carried else {
            return Vec::new();
        };
        let begins = self.last_cut >= t0;
        let is_cut = !events.is_empty() || ends_there;
        self.steps += 1;
        self.ends_first = !ends_there && (begins || is_cut);
        if !is_cut {
            return Vec::new();
        }
        let mut looks = Vec::new();
        let mut cuts = Vec::new();
        if begins && carried.is_blank_since(self.last_cut) {
            cuts.push(self.last_cut);
        } else if !begins && self.wanted == Verdicts::OfRun {
            looks.push(t0);
        }
        cuts.extend(events);
        if ends_there {
            cuts.push(t1);
        }
        cuts.dedup();
        events.iter().for_each(|&t| carried.cut(t));
        if let Some(&last) = cuts.last() {
            self.last_cut = self.last_cut.max(last);
        }
        let between = cuts.windows(2).filter(|pair| pair[0] < pair[1]);
        looks.extend(between.map(|pair| 0.5 * (pair[0] + pair[1])));
        looks
    }

    /// Returns the verdicts up to the end, and the rows without multiplier.
    pub(super) fn finish(
        self,
        motion: &KeptRowMotion<'_>,
        groups: &[Group],
        to: f64,
    ) -> (Stretches, Vec<DroppedRows>) {
        let (mechanism, extent) = (motion.mechanism(), [0.0, to]);
        let stretches = match self.carried {
            None => Stretches::unique(mechanism, extent, groups),
            Some(mut carried) => {
                let breaks = &mechanism.layout().break_times;
                breaks.iter().for_each(|&t| carried.cut(t));
                carried.finish(extent)
            }
        };
        (stretches, self.dropped)
    }
}
