//! One row of output: a state, and values computed from it on request.

use model::{Mechanism, Reaction, System};
use solvability::Chosen;

use crate::error::MotionFault;
use crate::events::Event;
use crate::motion::KeptRowMotion;

/// One row of output: a state on the constraints, and values computed from it on request.
pub struct Sample<'s, 'm> {
    /// Time (s).
    pub t: f64,
    /// Coordinates. At a break time all values are those just before it.
    pub q: &'s [f64],
    /// Velocities.
    pub v: &'s [f64],
    /// Work of drives and applied forces since the start (J), without the weight.
    pub work: f64,
    /// Events that were found since the row before; their times may be later than that of the row,
    /// by less than a step.
    pub events: &'s [Event],
    /// The rows (from 0) whose multipliers are zero by choice in this row of output.
    pub dropped: &'s [usize],
    pub(super) source: Source<'s, 'm>,
}

/// Source of the other values.
pub(super) enum Source<'s, 'm> {
    /// The motion of all bodies.
    Motion(OfMotion<'s, 'm>),
    /// Motions of components, which have already computed the values.
    Several(&'s Values),
}

/// A motion, and the output requested from it.
pub(super) struct OfMotion<'s, 'm> {
    /// The time of the row, or the last floating-point number before a break time.
    pub(super) t_before: f64,
    pub(super) wanted: &'s AtRows,
    pub(super) motion: &'s mut KeptRowMotion<'m>,
    pub(super) known: Known,
    /// Multipliers, once they were asked for.
    pub(super) lambda: Option<Vec<f64>>,
}

/// How far the equations of a row have been solved; they are solved at most once.
pub(super) enum Known {
    Nothing,
    /// Rows are factored at the pose of the scratch, which is that of the row.
    Factored,
    /// The accelerations are known from the last evaluation of the motion.
    Solved(Vec<f64>),
}

/// Output requested at the rows of a component.
#[derive(Clone, Debug)]
pub(super) struct AtRows {
    /// Whether states are moved onto the constraints.
    pub(super) on_constraints: bool,
    pub(super) accelerations: bool,
    /// Joints and drives whose reactions are requested, ascending.
    pub(super) reactions: Vec<usize>,
}

/// Values at a row, of a component or of the whole mechanism.
#[derive(Clone)]
pub(super) struct Values {
    pub(super) acceleration: Result<Vec<f64>, MotionFault>,
    pub(super) multipliers: Result<Vec<f64>, MotionFault>,
    pub(super) reactions: Result<Vec<Reaction>, MotionFault>,
}

/// All requested values of a row, and its rows without multiplier.
pub(super) type RowValues = (Values, Vec<usize>);

impl Sample<'_, '_> {
    /// All requested values of the row.
    pub(super) fn values(&mut self) -> RowValues {
        let values = match &mut self.source {
            Source::Motion(source) => source.values(self.q, self.v),
            Source::Several(values) => (*values).clone(),
        };
        (values, self.dropped.to_vec())
    }

    /// Accelerations, NaN if the plan omits them; allocates.
    ///
    /// # Errors
    /// If the equations have no unique solution at this state.
    pub fn acceleration(&mut self) -> Result<Vec<f64>, MotionFault> {
        match &mut self.source {
            Source::Motion(source) => source.acceleration(self.q, self.v),
            Source::Several(values) => values.acceleration.clone(),
        }
    }

    /// Multipliers of all rows as in [`KeptRowMotion::multipliers`]; NaN for rows of joints and
    /// drives whose reactions the plan omits; allocates.
    ///
    /// # Errors
    /// If the equations have no unique solution at this state.
    pub fn multipliers(&mut self) -> Result<Chosen<f64>, MotionFault> {
        let multipliers = match &mut self.source {
            Source::Motion(source) => source.multipliers(self.q, self.v).map(<[f64]>::to_vec),
            Source::Several(values) => values.multipliers.clone(),
        };
        Ok(Chosen::new(multipliers?, self.dropped.to_vec()))
    }

    /// Reactions of all joints and drives in the order of their rows; NaN for those that the plan
    /// omits. Reactions that are not unique belong to the choice of this run (its kept rows) and to
    /// no other; allocates.
    ///
    /// # Errors
    /// If the equations have no unique solution at this state.
    pub fn reactions(&mut self) -> Result<Chosen<Reaction>, MotionFault> {
        let reactions = match &mut self.source {
            Source::Motion(source) => source.reactions(self.q, self.v),
            Source::Several(values) => values.reactions.clone(),
        };
        Ok(Chosen::new(reactions?, self.dropped.to_vec()))
    }
}

impl OfMotion<'_, '_> {
    fn acceleration(&mut self, q: &[f64], v: &[f64]) -> Result<Vec<f64>, MotionFault> {
        if self.wanted.accelerations {
            self.solve(q, v)
        } else {
            Ok(vec![f64::NAN; v.len()])
        }
    }

    fn solve(&mut self, q: &[f64], v: &[f64]) -> Result<Vec<f64>, MotionFault> {
        let mut a = vec![0.0; v.len()];
        match &self.known {
            Known::Nothing => self.motion.acceleration(self.t_before, q, v, &mut a)?,
            Known::Factored => self.motion.solve_factored(v, &mut a)?,
            Known::Solved(a) => return Ok(a.clone()),
        }
        self.known = Known::Solved(a.clone());
        Ok(a)
    }

    /// Multipliers, computed at the first request.
    fn multipliers(&mut self, q: &[f64], v: &[f64]) -> Result<&[f64], MotionFault> {
        let lambda = match self.lambda.take() {
            Some(lambda) => lambda,
            None => self.solve_multipliers(q, v)?,
        };
        Ok(self.lambda.insert(lambda))
    }

    fn solve_multipliers(&mut self, q: &[f64], v: &[f64]) -> Result<Vec<f64>, MotionFault> {
        let mechanism = self.motion.mechanism();
        let mut lambda = vec![f64::NAN; mechanism.layout().rows()];
        if self.wanted.reactions.is_empty() {
            return Ok(lambda);
        }
        if self.motion.is_on_code() || self.motion.equations.requested_rows.is_some() {
            self.motion
                .write_multipliers(self.t_before, q, v, &mut lambda)?;
        } else {
            let a = self.solve(q, v)?;
            self.motion.multipliers_for(&a, &mut lambda)?;
        }
        if self.motion.equations.velocity.relative_pivot() < self.motion.watch.blind() {
            lambda.fill(f64::NAN);
        }
        for (k, group) in mechanism.layout().groups.iter().enumerate() {
            if !self.wants(k) {
                group.rows.iter().for_each(|row| lambda[row] = f64::NAN);
            }
        }
        Ok(lambda)
    }

    fn reactions(&mut self, q: &[f64], v: &[f64]) -> Result<Vec<Reaction>, MotionFault> {
        self.multipliers(q, v)?;
        let lambda = self.lambda.as_deref().unwrap_or_default();
        let mechanism = self.motion.mechanism();
        let reactions = mechanism.reactions(self.motion.scratch());
        let mut block = Vec::new();
        let reaction = |(k, id)| {
            if self.wants(k) {
                reactions.reaction_in(&mut block, id, lambda)
            } else {
                left_out(mechanism, k)
            }
        };
        let ids = mechanism.layout().constraint_ids().enumerate();
        Ok(ids.map(reaction).collect())
    }

    fn values(&mut self, q: &[f64], v: &[f64]) -> Values {
        Values {
            acceleration: self.acceleration(q, v),
            multipliers: self.multipliers(q, v).map(<[f64]>::to_vec),
            reactions: self.reactions(q, v),
        }
    }

    fn wants(&self, group: usize) -> bool {
        self.wanted.reactions.binary_search(&group).is_ok()
    }
}

/// The reaction of a joint or drive that is not computed.
pub(super) fn left_out(mechanism: &Mechanism, group: usize) -> Reaction {
    let component = mechanism.layout().groups[group].spec.component;
    let space = mechanism.space();
    let unknown = [f64::NAN; 6];
    Reaction::new(space, &unknown[..space.n_v()], component.map(|_| f64::NAN))
}
