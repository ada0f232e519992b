//! One output row, which consists of a state, and of values computed from the state on request.

use model::{Mechanism, Reaction, System};
use solvability::{CarriedChoices, CarriedSolution, ChoiceError, ChosenValues, NamedChoice};

use crate::error::MotionFault;
use crate::events::Event;
use crate::motion::KeptRowMotion;

/// One output row. A row consists of a state on the constraint manifold, and of values computed
/// from the state on request.
pub struct Sample<'s, 'm> {
    /// Time (s).
    pub t: f64,
    /// Coordinates. At a break time all values are the values just before it.
    pub q: &'s [f64],
    /// Velocities.
    pub v: &'s [f64],
    /// Work of drives and applied forces since the start (J), without the weight.
    pub work: f64,
    /// Events since the previous row. The times of these events may be later than the time of the
    /// row, by less than a step.
    pub events: &'s [Event],
    /// The constraint rows (counted from 0) that are redundant at this output row and whose
    /// multipliers are set to zero.
    pub dropped: &'s [usize],
    /// The additional choices for which reactions are requested.
    pub choices: &'s [NamedChoice],
    pub(super) source: Source<'s, 'm>,
}

/// Multipliers and reactions for one additional choice, at an output row.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ChosenReactions {
    /// Multipliers of all rows, NaN as in [`Sample::multipliers`].
    pub multipliers: ChosenValues<f64>,
    /// Reactions of all joints and drives, NaN as in [`Sample::reactions`].
    pub reactions: ChosenValues<Reaction>,
    /// Reason why the choice selects no solution at this row. In this case all values are NaN.
    pub refused: Option<ChoiceError>,
}

/// Source of the other values.
pub(super) enum Source<'s, 'm> {
    /// The motion of the whole mechanism.
    Motion(OfMotion<'s, 'm>),
    /// Motions of components, which have already computed the values.
    Several(&'s Values),
}

/// A motion, and the output requested from this motion.
pub(super) struct OfMotion<'s, 'm> {
    /// The time of the output row, or the last floating-point number before a break time.
    pub(super) t_before: f64,
    pub(super) wanted: &'s AtRows,
    pub(super) motion: &'s mut KeptRowMotion<'m>,
    pub(super) known: SolveProgress,
    /// The solver for the requested choices.
    pub(super) choices: Option<&'s CarriedChoices<'m>>,
    /// Multipliers, if a caller has requested them.
    pub(super) lambda: Option<Vec<f64>>,
    /// Multipliers and reactions for each choice, if a caller has requested them.
    pub(super) chosen: Option<Vec<OfChoice>>,
}

/// Progress of the solution of the equations at an output row. Each part is solved at most once.
pub(super) enum SolveProgress {
    Nothing,
    /// Rows are factored at the last evaluated pose, which is the pose of the output row.
    Factored,
    /// The accelerations of the last evaluation of the motion are available.
    Solved(Vec<f64>),
}

/// Values requested at the output rows of a component.
#[derive(Clone, Debug)]
pub(super) struct AtRows {
    /// Whether states are moved onto the constraint manifold.
    pub(super) on_constraints: bool,
    pub(super) accelerations: bool,
    /// Joints and drives whose reactions are requested, ascending.
    pub(super) reactions: Vec<usize>,
    /// Whether events at singular configurations state whether the motion is unique.
    pub(super) uniqueness: bool,
}

/// Values at an output row, of a component or of the whole mechanism.
#[derive(Clone)]
pub(super) struct Values {
    pub(super) acceleration: Result<Vec<f64>, MotionFault>,
    pub(super) multipliers: Result<Vec<f64>, MotionFault>,
    pub(super) reactions: Result<Vec<Reaction>, MotionFault>,
    /// Values for each requested choice.
    pub(super) chosen: Result<Vec<OfChoice>, MotionFault>,
}

/// Multipliers and reactions for one choice.
#[derive(Clone)]
pub(super) struct OfChoice {
    pub(super) multipliers: Vec<f64>,
    pub(super) reactions: Vec<Reaction>,
    pub(super) refused: Option<ChoiceError>,
}

/// All requested values of an output row, and the rows without multiplier.
pub(super) type RowValues = (Values, Vec<usize>);

impl Sample<'_, '_> {
    /// Returns all requested values of the output row.
    pub(super) fn values(&mut self) -> RowValues {
        let values = match &mut self.source {
            Source::Motion(source) => source.values(self.q, self.v),
            Source::Several(values) => (*values).clone(),
        };
        (values, self.dropped.to_vec())
    }

    /// Returns the accelerations, or NaN if the plan omits them. The function allocates memory.
    ///
    /// # Errors
    /// Returns an error if the equations have no unique solution at this state.
    pub fn acceleration(&mut self) -> Result<Vec<f64>, MotionFault> {
        match &mut self.source {
            Source::Motion(source) => source.acceleration(self.q, self.v),
            Source::Several(values) => values.acceleration.clone(),
        }
    }

    /// Returns the multipliers of all rows as in [`KeptRowMotion::multipliers`]. The multipliers
    /// are NaN for rows of joints and drives whose reactions the plan omits. The function allocates
    /// memory.
    ///
    /// # Errors
    /// Returns an error if the equations have no unique solution at this state.
    pub fn multipliers(&mut self) -> Result<ChosenValues<f64>, MotionFault> {
        let multipliers = match &mut self.source {
            Source::Motion(source) => source.multipliers(self.q, self.v),
            Source::Several(values) => values.multipliers.clone(),
        };
        Ok(ChosenValues::new(multipliers?, self.dropped.to_vec()))
    }

    /// Returns the reactions of all joints and drives in the order of their rows. Reactions that
    /// the plan omits are NaN. Reactions that are not unique are valid only for the choice of this
    /// run (its independent rows). The function allocates memory.
    ///
    /// # Errors
    /// Returns an error if the equations have no unique solution at this state.
    pub fn reactions(&mut self) -> Result<ChosenValues<Reaction>, MotionFault> {
        let reactions = match &mut self.source {
            Source::Motion(source) => source.reactions(self.q, self.v),
            Source::Several(values) => values.reactions.clone(),
        };
        Ok(ChosenValues::new(reactions?, self.dropped.to_vec()))
    }

    /// Returns multipliers and reactions for each of [`Self::choices`]. All of them have the same
    /// accelerations. Values that the model determines are the same for all choices. The function
    /// allocates memory.
    ///
    /// # Errors
    /// Returns an error if the equations have no unique solution at this state.
    pub fn chosen(&mut self) -> Result<Vec<ChosenReactions>, MotionFault> {
        let chosen = match &mut self.source {
            Source::Motion(source) => source.chosen(self.q, self.v).map(<[OfChoice]>::to_vec),
            Source::Several(values) => values.chosen.clone(),
        };
        let each = chosen?.into_iter().zip(self.choices);
        let each = each.map(|(own, choice)| ChosenReactions {
            multipliers: ChosenValues::by(own.multipliers, choice),
            reactions: ChosenValues::by(own.reactions, choice),
            refused: own.refused,
        });
        Ok(each.collect())
    }
}

impl<'m> OfMotion<'_, 'm> {
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
            SolveProgress::Nothing => self.motion.acceleration(self.t_before, q, v, &mut a)?,
            SolveProgress::Factored => self.motion.solve_factored(v, &mut a)?,
            SolveProgress::Solved(a) => return Ok(a.clone()),
        }
        self.known = SolveProgress::Solved(a.clone());
        Ok(a)
    }

    /// Returns the requested multipliers.
    fn multipliers(&mut self, q: &[f64], v: &[f64]) -> Result<Vec<f64>, MotionFault> {
        let mut lambda = self.all_multipliers(q, v)?.to_vec();
        self.leave_out(&mut lambda);
        Ok(lambda)
    }

    /// Returns the multipliers of all rows, computed at the first request. The multipliers are NaN
    /// if no multipliers are requested.
    fn all_multipliers(&mut self, q: &[f64], v: &[f64]) -> Result<&[f64], MotionFault> {
        let lambda = match self.lambda.take() {
            Some(lambda) => lambda,
            None => self.solve_multipliers(q, v)?,
        };
        Ok(self.lambda.insert(lambda))
    }

    fn solve_multipliers(&mut self, q: &[f64], v: &[f64]) -> Result<Vec<f64>, MotionFault> {
        let mut lambda = self.no_multipliers();
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
        self.blind(&mut lambda);
        Ok(lambda)
    }

    fn no_multipliers(&self) -> Vec<f64> {
        vec![f64::NAN; self.motion.mechanism().layout().rows()]
    }

    /// Sets all multipliers to NaN if the independent rows are ill-conditioned at this instant.
    fn blind(&self, lambda: &mut [f64]) {
        if self.motion.equations.velocity.relative_pivot() < self.motion.watch.blind() {
            lambda.fill(f64::NAN);
        }
    }

    /// Sets values that are not requested to NaN.
    fn leave_out(&self, lambda: &mut [f64]) {
        let groups = self.motion.mechanism().layout().groups.iter().enumerate();
        for (_, group) in groups.filter(|(k, _)| !self.wants(*k)) {
            group.rows.iter().for_each(|row| lambda[row] = f64::NAN);
        }
    }

    fn reactions(&mut self, q: &[f64], v: &[f64]) -> Result<Vec<Reaction>, MotionFault> {
        self.all_multipliers(q, v)?;
        Ok(self.reactions_of(self.lambda.as_deref().unwrap_or_default()))
    }

    /// Returns the requested reactions for these multipliers.
    fn reactions_of(&self, lambda: &[f64]) -> Vec<Reaction> {
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
        ids.map(reaction).collect()
    }

    /// Returns the multipliers and reactions for each choice, computed at the first request.
    fn chosen(&mut self, q: &[f64], v: &[f64]) -> Result<&[OfChoice], MotionFault> {
        let chosen = match (self.chosen.take(), self.choices) {
            (Some(chosen), _) => chosen,
            (None, None) => Vec::new(),
            (None, Some(choices)) => self.choose(choices, q, v)?,
        };
        Ok(self.chosen.insert(chosen))
    }

    /// Solves for the choices with the independent rows of the motion.
    fn choose(
        &mut self,
        choices: &CarriedChoices<'m>,
        q: &[f64],
        v: &[f64],
    ) -> Result<Vec<OfChoice>, MotionFault> {
        let mut multipliers = self.all_multipliers(q, v)?.to_vec();
        self.motion.equations.factor_at(self.t_before, q)?;
        if self.motion.equations.requested_rows.is_some() {
            // The requested rows are ill-conditioned at this state.
            let mut a = vec![0.0; v.len()];
            self.motion.solve_factored(v, &mut a)?;
            self.motion.multipliers_for(&a, &mut multipliers)?;
            self.blind(&mut multipliers);
        }
        let equations = &mut self.motion.equations;
        let (at, rows) = (&equations.at, &mut equations.velocity);
        let mut dependencies = Vec::new();
        rows.all_dependencies(at, &mut dependencies)?;
        let found = choices.at(&CarriedSolution {
            t: self.t_before,
            q,
            scratch: &at.s,
            dropped: &rows.dropped,
            dependencies: &dependencies,
            multipliers: &multipliers,
        });
        let numbers = found.into_iter().map(|found| {
            let (mut multipliers, refused) = match found {
                Ok(lambda) => (lambda, None),
                Err(error) => (self.no_multipliers(), Some(error)),
            };
            self.leave_out(&mut multipliers);
            OfChoice {
                reactions: self.reactions_of(&multipliers),
                multipliers,
                refused,
            }
        });
        Ok(numbers.collect())
    }

    fn values(&mut self, q: &[f64], v: &[f64]) -> Values {
        Values {
            acceleration: self.acceleration(q, v),
            multipliers: self.multipliers(q, v),
            reactions: self.reactions(q, v),
            chosen: self.chosen(q, v).map(<[OfChoice]>::to_vec),
        }
    }

    fn wants(&self, group: usize) -> bool {
        self.wanted.reactions.binary_search(&group).is_ok()
    }
}

/// Returns the reaction of a joint or drive that is not computed.
pub(super) fn left_out(mechanism: &Mechanism, group: usize) -> Reaction {
    let component = mechanism.layout().groups[group].spec.component;
    let space = mechanism.space();
    let unknown = [f64::NAN; 6];
    Reaction::new(space, &unknown[..space.n_v()], component.map(|_| f64::NAN))
}
