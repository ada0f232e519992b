//! One configuration of a scene, and everything that can be asked of its reactions. Each method
//! answers one question; what nobody asks is not computed.

mod document;
mod requests;

use std::sync::Arc;

use linalg::Matrix;
use model::{ConstraintId, Known, Mechanism, System};
use rank::Limits;
use scene::Scene;
use solvability::{
    Allowed, Analysis, Choice, ChoiceError, Continuation, Contradiction, Distribution,
    EliminationError, Explanation, FrameVerdict, Freedoms, Generic, GroupVerdict, Numbers,
    Proposals, Questions, ReactionVerdict, Rows, Sensitivities, Solution, State, UnitCheck,
    analyse_decided, analyse_dropping, analyse_watched, generic, is_locked, second_order, solution,
};

use crate::error::StudyError;

/// A configuration whose rank has been decided, with its verdicts.
///
/// ```
/// use pfaff::rank::Limits;
/// use pfaff::prelude::*;
/// use pfaff::solvability::Allowed;
///
/// // A cart on two wheels of one axle: each stops the same sideways motion.
/// let mut cart = Description::new("cart");
/// let body = cart.body(Body::new("cart", 10.0, 1.0));
/// for (name, y) in [("left", 0.5), ("right", -0.5)] {
///     cart.joint(name, &[body], KnifeEdge { s: [0.0, y], normal: Direction::Y });
/// }
/// let study = Study::build(cart)?;
/// let start = study.analyse(0.0, None)?;
/// assert_eq!(start.verdict("left")?.wrench.verdict.word(), "not_unique");
/// assert_eq!(start.eliminations()?, 2);
/// let left = start.reaction("left")?;
/// let ways = start.make_unique(left, &Allowed::Sensible, Limits::default())?.ways;
/// assert_eq!(ways[0].text, "delete `right`");
/// let wrong = start.verdict("lift").unwrap_err();
/// assert_eq!(wrong.to_string(), "there is no joint or drive `lift`; did you mean `left`?");
/// # Ok::<(), StudyError>(())
/// ```
pub struct ConfigurationAnalysis<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its mechanism.
    pub mechanism: &'a Mechanism,
    /// Coordinates and velocities; the latter are empty where the rank is undecided, because none
    /// are known to be consistent.
    pub state: State,
    /// Ranks and verdicts.
    pub analysis: Arc<Analysis>,
    questions: Questions<'a>,
}

/// What is known or asked of the rows of a configuration.
pub(crate) enum AskedRows<'r> {
    /// Nothing.
    Any,
    /// They have been decided there.
    Decided(&'r Rows),
    /// These carry the dependencies, from 0.
    Dropped(&'r [usize]),
}

impl<'a> ConfigurationAnalysis<'a> {
    /// A state that satisfies the constraints at time t, and how well its configuration is known.
    /// `progress` gets the number of joints that are judged.
    pub(crate) fn new(
        scene: &'a Scene,
        mechanism: &'a Mechanism,
        t: f64,
        state: State,
        known: Known,
        rows: AskedRows<'_>,
        progress: impl Fn(usize) + Sync,
    ) -> Result<Self, StudyError> {
        let q = &state.q;
        let analysis = Arc::new(match rows {
            AskedRows::Any => analyse_watched(mechanism, t, q, known, progress)?,
            AskedRows::Decided(rows) => analyse_decided(mechanism, t, q, rows, progress)?,
            AskedRows::Dropped(rows) => analyse_dropping(mechanism, t, q, rows)?,
        });
        Ok(Self {
            scene,
            mechanism,
            questions: Questions::new(mechanism, q, Arc::clone(&analysis)),
            state,
            analysis,
        })
    }

    /// The joint or drive of this name.
    ///
    /// # Errors
    /// [`StudyError::UnknownReaction`], with the nearest name.
    pub fn reaction(&self, name: &str) -> Result<ConstraintId, StudyError> {
        requests::reaction(self.scene, self.mechanism, name)
    }

    /// The verdict of the joint or drive of this name.
    ///
    /// # Errors
    /// [`StudyError::UnknownReaction`], with the nearest name.
    pub fn verdict(&self, name: &str) -> Result<&ReactionVerdict, StudyError> {
        let ConstraintId(place) = self.reaction(name)?;
        Ok(&self.analysis.reactions[place])
    }

    /// Verdicts by name: the groups of the scene, then sums of components as `W3.N + W4.N`, or of
    /// whole wrenches as `W3 + W4`.
    ///
    /// # Errors
    /// If a sum cannot be read, names something unknown, or touches a part that is too large.
    pub fn groups(&self, combine: &[String]) -> Result<Vec<(String, GroupVerdict)>, StudyError> {
        requests::groups(self.scene, self.mechanism, combine)?
            .into_iter()
            .map(|(name, group)| Ok((name, self.questions.group(&group)?)))
            .collect()
    }

    /// The verdict of one such sum.
    ///
    /// # Errors
    /// If it cannot be read, names something unknown, or touches a part that is too large.
    pub fn group(&self, combination: &str) -> Result<GroupVerdict, StudyError> {
        let group = requests::combination(self.scene, self.mechanism, combination)?;
        Ok(self.questions.group(&group)?)
    }

    /// The numbers of the same groups that every solution shares, by name; several reactions side
    /// by side have none.
    ///
    /// # Errors
    /// As [`ConfigurationAnalysis::groups`], and [`StudyError::Choice`]: there are no reactions, or
    /// the rank is undecided.
    pub fn determined(&self, combine: &[String]) -> Result<Vec<Numbers>, StudyError> {
        let solution = self.solution()?;
        let groups = requests::groups(self.scene, self.mechanism, combine)?;
        let numbers = groups
            .iter()
            .map(|(_, group)| self.questions.determined(group, &solution));
        Ok(numbers.collect::<Result<_, _>>()?)
    }

    /// All numbers of the same groups as a choice gives them.
    ///
    /// # Errors
    /// As [`ConfigurationAnalysis::groups`].
    pub fn chosen(
        &self,
        combine: &[String],
        distribution: &Distribution,
    ) -> Result<Vec<Numbers>, StudyError> {
        let groups = requests::groups(self.scene, self.mechanism, combine)?;
        let numbers = groups
            .iter()
            .map(|(_, group)| self.questions.chosen(group, distribution));
        Ok(numbers.collect::<Result<_, _>>()?)
    }

    /// How much each unique reaction hangs on the data. Nothing is known of it where the rank is
    /// undecided.
    ///
    /// ```
    /// use pfaff::prelude::*;
    ///
    /// // A bar between a wall and a slope that is nearly parallel to it pushes with 1/tan of the angle: 1e-3 rad here.
    /// let mut bar = Description { gravity: [0.0, -10.0], ..Description::new("bar") };
    /// let body = bar.body(Body::new("bar", 1.0, 1.0));
    /// bar.joint("wall", &[body], KnifeEdge { s: [-1.0, 0.0], normal: Direction::X });
    /// let slope = Direction::new([1.0, 1e-3]).expect("a direction");
    /// bar.joint("slope", &[body], KnifeEdge { s: [-1.0, 0.0], normal: slope });
    /// let study = Study::build(bar)?;
    /// let hanging = study.analyse(0.0, None)?.sensitivities()?;
    /// assert_eq!(hanging.fragile().count(), 2);
    /// # Ok::<(), StudyError>(())
    /// ```
    ///
    /// # Errors
    /// [`StudyError::Choice`]
    pub fn sensitivities(&self) -> Result<Sensitivities, StudyError> {
        let State { q, v } = &self.state;
        Ok(self.analysis.sensitivities(self.mechanism, q, v)?)
    }

    /// What can move here, with the drives and without them.
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn freedoms(&self) -> Result<Freedoms, StudyError> {
        Ok(self.analysis.freedoms(self.mechanism, &self.state.q)?)
    }

    /// Ranks at other configurations of the same component; `None` if none could be reached.
    #[must_use]
    pub fn generic(&self) -> Option<Generic> {
        generic(self.mechanism, self.analysis.time, &self.state.q)
    }

    /// How the motion goes on at a singular configuration, where the redundancy is larger than
    /// elsewhere: along one branch only, or not determined by the constraints. Nothing where the
    /// configuration is not singular, or where the velocities of the scene do not say which motion
    /// is meant: it stands still, or has several freedoms.
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn continuation(&self, generic: &Generic) -> Result<Option<Continuation>, StudyError> {
        let State { q, v } = &self.state;
        let Some(decision) = self.analysis.whole() else {
            return Ok(None);
        };
        if generic.redundancy >= decision.redundancy || v.is_empty() {
            return Ok(None);
        }
        let rank = decision.rank + decision.redundancy - generic.redundancy;
        let regular = match self.analysis.velocities - rank {
            0 => Matrix::zeros(v.len(), 0),
            1 if v.iter().any(|v| *v != 0.0) => Matrix::from_fn(v.len(), 1, |i, _| v[i]),
            _ => return Ok(None),
        };
        let found = second_order(
            self.mechanism,
            self.analysis.time,
            q,
            v,
            &decision,
            &regular,
        )?;
        Ok(Some(found))
    }

    /// Whether the mechanism cannot move although it has freedoms of first order: second order
    /// blocks all of them. Not asked of mechanisms with too many rows for matrices of all of them.
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn is_locked(&self) -> Result<bool, StudyError> {
        match self.analysis.whole() {
            Some(decision) => {
                let (t, q) = (self.analysis.time, &self.state.q);
                Ok(is_locked(self.mechanism, t, q, &decision)?)
            }
            None => Ok(false),
        }
    }

    /// Whether no motion is possible: the rows allow no velocity and do not depend on time, or
    /// second order blocks every velocity that they allow ([`ConfigurationAnalysis::is_locked`]).
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn cannot_move(&self) -> Result<bool, StudyError> {
        let (decision, layout) = (&self.analysis.decision, self.mechanism.layout());
        let is_fixed = decision.is_decided() && decision.rank == layout.n_v && !layout.rheonomic;
        Ok(is_fixed || self.is_locked()?)
    }

    /// Why the reactions are not unique; nothing while the rank is undecided, where every sentence
    /// would build on one of two readings.
    ///
    /// # Errors
    /// [`StudyError::Explanation`]
    pub fn explanation(&self) -> Result<Option<Explanation>, StudyError> {
        Ok(self.questions.explanation()?)
    }

    /// The number of sets of rows that can be deleted without a change of motion, as many rows as
    /// the degree of redundancy.
    ///
    /// # Errors
    /// [`EliminationError`]: the rank or one of the sets is undecided, they are too many, or a part
    /// is too large.
    pub fn eliminations(&self) -> Result<u128, EliminationError> {
        self.questions.eliminations()
    }

    /// The first of these sets, rows from 0.
    ///
    /// # Errors
    /// [`EliminationError`]: the rank or one of the sets is undecided, or a part is too large.
    pub fn elimination_sets(&self, limit: usize) -> Result<Vec<Vec<usize>>, EliminationError> {
        self.questions.elimination_sets(limit)
    }

    /// The smallest deletions that make a reaction unique without a change of motion.
    ///
    /// # Errors
    /// [`EliminationError`]: the rank or an answer is undecided, a row that is allowed does not
    /// exist, or its part is too large.
    pub fn make_unique(
        &self,
        id: ConstraintId,
        allowed: &Allowed,
        limits: Limits,
    ) -> Result<Proposals, EliminationError> {
        self.questions.make_unique(id, allowed, limits)
    }

    /// The verdicts of a reaction in all frames that it has.
    ///
    /// # Errors
    /// [`StudyError::Request`]
    pub fn frames(&self, id: ConstraintId) -> Result<Vec<FrameVerdict>, StudyError> {
        Ok(self.questions.frames(id)?)
    }

    /// The reactions that a choice gives at these velocities: what is unique, and one of many for
    /// the rest.
    ///
    /// # Errors
    /// [`StudyError::Choice`]: there is no such distribution, or the rank is undecided.
    pub fn distribution(&self, choice: &Choice) -> Result<Distribution, StudyError> {
        if let Choice::Elimination(rows) = choice {
            self.check_rows(rows)?;
        }
        Ok(self.questions.distribute(&self.solution()?, choice)?)
    }

    /// Which components are facts, and which depend on a choice: told by a change of units, without
    /// any verdict.
    ///
    /// # Errors
    /// [`StudyError::Units`]: there is nothing to compare, or the rank depends on the units.
    pub fn facts(&self) -> Result<Vec<UnitCheck>, StudyError> {
        let solution = self.solution()?;
        Ok(self.questions.facts(&self.state.v, &solution)?)
    }

    /// What redundant rows contradict each other in, the worst first; nothing is known of this
    /// where the rank is undecided.
    ///
    /// # Errors
    /// If the configuration cannot be judged.
    pub fn contradictions(&self) -> Result<Vec<Contradiction>, StudyError> {
        let State { q, v } = &self.state;
        let t = self.analysis.time;
        let rows = solvability::rows(self.mechanism, t, q)?;
        if !rows.all.is_decided() || !rows.holonomic.is_decided() || v.is_empty() {
            return Ok(Vec::new());
        }
        Ok(rows.contradictions(self.mechanism, t, q, v)?)
    }

    /// Checks that rows (from 0) exist.
    ///
    /// # Errors
    /// [`StudyError::UnknownRow`]
    pub fn check_rows(&self, rows: &[usize]) -> Result<(), StudyError> {
        let n = self.mechanism.layout().rows();
        match rows.iter().find(|row| **row >= n) {
            Some(&row) => Err(StudyError::UnknownRow { row, rows: n }),
            None => Ok(()),
        }
    }

    /// One solution of the equations of motion.
    fn solution(&self) -> Result<Solution, StudyError> {
        let decision = &self.analysis.decision;
        if let rank::RankStatus::Undecided(doubt) = decision.status {
            return Err(ChoiceError::Undecided(doubt).into());
        }
        let state = (self.analysis.time, &self.state.q[..], &self.state.v[..]);
        Ok(solution(self.mechanism, state, decision)?)
    }
}
