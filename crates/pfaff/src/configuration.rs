//! One configuration of a scene, and all results for the reactions at this configuration. Each
//! method computes only one result.

mod document;
mod numbers;
pub(crate) mod requests;

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use linalg::Matrix;
use model::start::scene_size;
use model::{ConfigurationAccuracy, ConstraintId, Mechanism, System, is_at_rest};
use rank::Limits;
use scene::Scene;
use solvability::{
    Analysis, Centres, Choice, ChoiceError, ContactCondition, Continuation, Contradiction,
    DeletableRows, Distribution, ElasticSupports, Elasticity, EliminationError, Explanation,
    FrameVerdict, Freedoms, Generic, GenericVerdict, Group, GroupVerdict, MomentVerdict,
    NamedChoice, NoFiniteReaction, Numbers, PermittedError, PermittedReactions, Proposals,
    Questions, ReactionBounds, ReactionNumber, ReactionValues, ReactionVerdict, Replacements, Rows,
    Sensitivities, Sensitivity, Solution, State, analyse_decided, analyse_dropping,
    analyse_with_progress, generic, generic_with_verdicts, is_locked, no_finite_reactions,
    second_order, solution,
};

use crate::elasticity;
use crate::error::StudyError;

/// A configuration whose rank has been decided, with its verdicts.
///
/// ```
/// use pfaff::rank::Limits;
/// use pfaff::prelude::*;
/// use pfaff::solvability::DeletableRows;
///
/// // A cart on two wheels on one axle: each prevents the same sideways motion.
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
/// let ways = start.make_unique(left, &DeletableRows::Sensible, Limits::default())?.ways;
/// assert_eq!(ways[0].text, "delete `right`");
/// let wrong = start.verdict("lift").unwrap_err();
/// assert_eq!(wrong.to_string(), "there is no joint or drive `lift`; did you mean `left`?");
/// # Ok::<(), StudyError>(())
/// ```
pub struct ConfigurationAnalysis<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The mechanism of the scene.
    pub mechanism: &'a Mechanism,
    /// Coordinates and velocities. If the rank is undecided, consistent velocities are not known,
    /// and the list of velocities is empty.
    pub state: State,
    /// Ranks and verdicts.
    pub analysis: Arc<Analysis>,
    questions: Questions<'a>,
    results: Results,
}

/// Results that several requests use. They are computed on first use.
#[derive(Default)]
struct Results {
    freedoms: OnceLock<Freedoms>,
    no_finite: OnceLock<Vec<Arc<NoFiniteReaction>>>,
    solution: OnceLock<Solution>,
}

/// Returns a stored result. The result is computed if it is not stored yet.
fn once<T>(
    known: &OnceLock<T>,
    compute: impl FnOnce() -> Result<T, StudyError>,
) -> Result<&T, StudyError> {
    if let Some(known) = known.get() {
        return Ok(known);
    }
    let found = compute()?;
    Ok(known.get_or_init(|| found))
}

/// The results for a configuration, stored for later use.
#[derive(Clone)]
#[non_exhaustive]
pub struct KeptAnalysis {
    /// Coordinates and velocities.
    pub state: State,
    /// Ranks and verdicts.
    pub analysis: Arc<Analysis>,
}

/// The decision on the rows of a configuration. It may have been made earlier, or be requested.
pub(crate) enum AskedRows<'r> {
    /// No decision was made or is requested.
    Any,
    /// The rows have already been decided at this configuration.
    Decided(&'r Rows),
    /// These rows (0-based) must be treated as redundant.
    Dropped(&'r [usize]),
}

impl<'a> ConfigurationAnalysis<'a> {
    /// Analyses a state that satisfies the constraints at time t. `known` is the accuracy of the
    /// configuration. `progress` is called with the number of joints analysed.
    pub(crate) fn new(
        scene: &'a Scene,
        mechanism: &'a Mechanism,
        t: f64,
        state: State,
        known: ConfigurationAccuracy,
        rows: AskedRows<'_>,
        progress: impl Fn(usize) + Sync,
    ) -> Result<Self, StudyError> {
        let q = &state.q;
        let analysis = Arc::new(match rows {
            AskedRows::Any => analyse_with_progress(mechanism, t, q, known, progress)?,
            AskedRows::Decided(rows) => analyse_decided(mechanism, t, q, rows, progress)?,
            AskedRows::Dropped(rows) => analyse_dropping(mechanism, t, q, rows)?,
        });
        Ok(Self {
            scene,
            mechanism,
            questions: Questions::new(mechanism, q, Arc::clone(&analysis)),
            state,
            analysis,
            results: Results::default(),
        })
    }

    /// Returns the results without the scene to which they belong.
    #[must_use]
    pub fn kept(&self) -> KeptAnalysis {
        KeptAnalysis {
            state: self.state.clone(),
            analysis: Arc::clone(&self.analysis),
        }
    }

    /// Restores a configuration from its stored results without a new decision. The results must
    /// belong to this scene and this mechanism.
    ///
    /// ```
    /// use pfaff::ConfigurationAnalysis;
    /// use pfaff::prelude::*;
    ///
    /// let mut sleigh = Description::new("sleigh");
    /// let body = sleigh.body(Body::new("sleigh", 10.0, 1.0));
    /// sleigh.joint("blade", &[body], KnifeEdge { s: [0.0, 0.0], normal: Direction::Y });
    /// let study = Study::build(sleigh)?;
    /// let kept = study.analyse(0.0, None)?.kept();
    /// let again = ConfigurationAnalysis::again(&study.scene, &study.prepared.mechanism, &kept);
    /// assert!(again.verdict("blade")?.wrench.verdict.is_unique());
    /// # Ok::<(), StudyError>(())
    /// ```
    #[must_use]
    pub fn again(scene: &'a Scene, mechanism: &'a Mechanism, kept: &KeptAnalysis) -> Self {
        let KeptAnalysis { state, analysis } = kept;
        Self {
            scene,
            mechanism,
            questions: Questions::new(mechanism, &state.q, Arc::clone(analysis)),
            state: state.clone(),
            analysis: Arc::clone(analysis),
            results: Results::default(),
        }
    }

    /// Finds the joint or drive with this name.
    ///
    /// # Errors
    /// [`StudyError::UnknownReaction`], with the most similar name.
    pub fn reaction(&self, name: &str) -> Result<ConstraintId, StudyError> {
        requests::reaction(self.scene, self.mechanism, name)
    }

    /// Returns the verdict on the joint or drive with this name.
    ///
    /// # Errors
    /// [`StudyError::UnknownReaction`], with the most similar name.
    pub fn verdict(&self, name: &str) -> Result<&ReactionVerdict, StudyError> {
        let ConstraintId(place) = self.reaction(name)?;
        Ok(&self.analysis.reactions[place])
    }

    /// Returns the verdicts on the groups of the scene, followed by the verdicts on sums. Each
    /// verdict has a name. A sum contains components, such as `W3.N + W4.N`, or whole wrenches,
    /// such as `W3 + W4`.
    ///
    /// # Errors
    /// Returns an error if a sum cannot be parsed, contains an unknown name, or involves a part
    /// that is too large.
    pub fn groups(&self, combine: &[String]) -> Result<Vec<(String, GroupVerdict)>, StudyError> {
        requests::groups(self.scene, self.mechanism, combine)?
            .into_iter()
            .map(|(name, group)| Ok((name, self.questions.group(&group)?)))
            .collect()
    }

    /// Returns the verdict on one sum, such as `W3.N + W4.N`.
    ///
    /// # Errors
    /// Returns an error if the sum cannot be parsed, contains an unknown name, or involves a part
    /// that is too large.
    pub fn group(&self, combination: &str) -> Result<GroupVerdict, StudyError> {
        let group = requests::combination(self.scene, self.mechanism, combination)?;
        Ok(self.questions.group(&group)?)
    }

    /// Returns the unique numbers of the groups and sums of [`ConfigurationAnalysis::groups`], with
    /// their names. Groups of several separate reactions have no numbers.
    ///
    /// # Errors
    /// Returns the errors of [`ConfigurationAnalysis::groups`], and [`StudyError::Choice`] if there
    /// are no reactions or the rank is undecided.
    pub fn determined(&self, combine: &[String]) -> Result<Vec<Numbers>, StudyError> {
        let solution = self.solution()?;
        let groups = requests::groups(self.scene, self.mechanism, combine)?;
        let numbers = groups
            .iter()
            .map(|(_, group)| self.questions.determined(group, solution));
        Ok(numbers.collect::<Result<_, _>>()?)
    }

    /// Returns all numbers of these groups and sums for a given choice.
    ///
    /// # Errors
    /// Returns the errors of [`ConfigurationAnalysis::groups`].
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

    /// Computes the sensitivity of each unique component of a reaction to the data. If the rank is
    /// undecided, reactions are omitted.
    ///
    /// ```
    /// use pfaff::prelude::*;
    ///
    /// // A bar between a wall and a nearly parallel slope pushes with 1/tan of the angle between them, here 1e-3 rad.
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
        if self.has_no_velocities() {
            let reactions = &self.analysis.reactions;
            let are_asked = self.analysis.decision.is_decided()
                && reactions.iter().any(|r| r.wrench.verdict.is_unique());
            let unknown = are_asked.then(|| {
                "the sensitivity of reactions to the data is unknown: no velocities that satisfy the constraints are available"
                    .to_owned()
            });
            return Ok(Sensitivities::unknown(reactions.len(), unknown));
        }
        Ok(self.analysis.sensitivities(self.mechanism, q, v)?)
    }

    /// Computes the sensitivity of other unique numbers of the reactions to the data, such as sums,
    /// moments and components in other frames. Unknown sensitivities are `None`.
    ///
    /// # Errors
    /// [`StudyError::Choice`]
    pub fn sensitivities_of(
        &self,
        numbers: &[ReactionNumber],
    ) -> Result<Vec<Option<Sensitivity>>, StudyError> {
        let State { q, v } = &self.state;
        if self.has_no_velocities() {
            return Ok(vec![None; numbers.len()]);
        }
        Ok(self
            .analysis
            .sensitivities_of(self.mechanism, q, v, numbers)?)
    }

    /// Whether the velocities at this configuration are unknown. In this case, the rank can be
    /// proved, but cannot be used in `f64`.
    fn has_no_velocities(&self) -> bool {
        self.state.v.is_empty() && self.mechanism.layout().n_v > 0
    }

    /// The possible motions at this configuration, with the drives and without them.
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn freedoms(&self) -> Result<&Freedoms, StudyError> {
        once(&self.results.freedoms, || {
            Ok(self.analysis.freedoms(self.mechanism, &self.state.q)?)
        })
    }

    /// Computes the ranks at other configurations of the same component. Returns `None` if no other
    /// configuration could be reached.
    #[must_use]
    pub fn generic(&self) -> Option<Generic> {
        generic(self.mechanism, self.analysis.time, &self.state.q)
    }

    /// Computes the ranks of [`Self::generic`], and the verdicts on all joints and drives at these
    /// configurations. The result contains the worst verdicts at the configurations with the
    /// smallest redundancy. They are `None` if the verdicts are unknown.
    #[must_use]
    pub fn generic_with_verdicts(&self) -> Option<(Generic, Option<Vec<GenericVerdict>>)> {
        generic_with_verdicts(self.mechanism, self.analysis.time, &self.state.q)
    }

    /// Determines how the motion continues at a singular configuration, that is, at a configuration
    /// with a larger redundancy than at most other configurations. The motion may continue along
    /// one branch or along several branches, or the constraints do not determine the continuation.
    /// Returns `None` if the configuration is not singular. Also returns `None` if the velocities
    /// of the scene do not determine the motion, because the mechanism is at rest or has several
    /// degrees of freedom.
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
        let moves = !is_at_rest(self.mechanism, scene_size(self.mechanism, q), v);
        // If a mechanism is rigid at other configurations, it moves only through configurations
        // with the same rank as this configuration.
        let is_driven = self.mechanism.layout().rheonomic;
        let regular = match self.analysis.velocities - rank {
            0 if is_driven || !moves => Matrix::zeros(v.len(), 0),
            0 | 1 if moves => Matrix::from_fn(v.len(), 1, |i, _| v[i]),
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

    /// Whether the mechanism cannot move although the rows do not determine all velocities. In this
    /// case, the second-order conditions exclude all free velocities, with constant values of the
    /// functions of time. Returns `None` if the second-order conditions do not decide, and for
    /// mechanisms with too many rows for dense matrices.
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn is_locked(&self) -> Result<Option<bool>, StudyError> {
        match self.analysis.whole() {
            Some(decision) => {
                let (t, q) = (self.analysis.time, &self.state.q);
                Ok(is_locked(self.mechanism, t, q, &decision)?)
            }
            None => Ok(None),
        }
    }

    /// Whether no motion is possible; see [`Freedoms::cannot_move`].
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn cannot_move(&self) -> Result<Option<bool>, StudyError> {
        Ok(self.freedoms()?.cannot_move)
    }

    /// Finds the sets of reactions that have no finite value at these velocities. In such a set,
    /// the loads act along a freedom that the second-order conditions exclude. The result is empty
    /// if the rank is undecided, and for mechanisms with too many rows for dense matrices.
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn no_finite_reactions(&self) -> Result<&[Arc<NoFiniteReaction>], StudyError> {
        let found = once(&self.results.no_finite, || {
            let Some(decision) = self.analysis.whole().filter(|_| !self.has_no_velocities()) else {
                return Ok(Vec::new());
            };
            let state = (self.analysis.time, &self.state.q[..], &self.state.v[..]);
            let found = no_finite_reactions(self.mechanism, state, &decision)?;
            Ok(found.into_iter().map(Arc::new).collect())
        });
        found.map(Vec::as_slice)
    }

    /// Explains the non-unique reactions. Returns `None` if the rank is undecided.
    ///
    /// # Errors
    /// [`StudyError::Explanation`]
    pub fn explanation(&self) -> Result<Option<Explanation>, StudyError> {
        Ok(self.questions.explanation()?)
    }

    /// Counts the sets of rows that can be deleted without a change of the motion. The number of
    /// rows in each set is the degree of redundancy.
    ///
    /// # Errors
    /// [`EliminationError`]: the rank or one of the sets is undecided, there are too many sets, or
    /// a part is too large.
    pub fn eliminations(&self) -> Result<u128, EliminationError> {
        self.questions.eliminations()
    }

    /// Returns the first sets of rows that can be deleted without a change of the motion (rows
    /// 0-based).
    ///
    /// # Errors
    /// [`EliminationError`]: the rank or one of the sets is undecided, or a part is too large.
    pub fn elimination_sets(&self, limit: usize) -> Result<Vec<Vec<usize>>, EliminationError> {
        self.questions.elimination_sets(limit)
    }

    /// Finds the smallest sets of rows that can be deleted so that a reaction becomes unique and
    /// the motion does not change.
    ///
    /// # Errors
    /// [`EliminationError`]: the rank or an answer is undecided, an allowed row does not exist, or
    /// the part of the reaction is too large.
    pub fn make_unique(
        &self,
        id: ConstraintId,
        allowed: &DeletableRows,
        limits: Limits,
    ) -> Result<Proposals, EliminationError> {
        self.questions.make_unique(id, allowed, limits)
    }

    /// Returns the verdicts on a reaction in all frames in which its components are given.
    ///
    /// # Errors
    /// [`StudyError::Request`]
    pub fn frames(&self, id: ConstraintId) -> Result<Vec<FrameVerdict>, StudyError> {
        Ok(self.questions.frames(id)?)
    }

    /// Returns the verdict on the moment of a reaction about a point (m, ground axes).
    ///
    /// # Errors
    /// [`StudyError::Request`]
    pub fn moment(&self, id: ConstraintId, about: [f64; 3]) -> Result<MomentVerdict, StudyError> {
        Ok(self.questions.moment(id, about)?)
    }

    /// Finds the nearest point about which the moment of a reaction is unique, if the moment about
    /// its reference point is not unique.
    ///
    /// # Errors
    /// [`StudyError::Request`]
    pub fn centre_of_moments(&self, id: ConstraintId) -> Result<Option<[f64; 3]>, StudyError> {
        Ok(self.questions.centre_of_moments(id)?)
    }

    /// Returns the position of a marker (m, ground axes). Returns `None` if there is no marker with
    /// this name.
    #[must_use]
    pub fn marker(&self, name: &str) -> Option<[f64; 3]> {
        let frames = self.mechanism.frames();
        let k = frames
            .observed()
            .markers
            .iter()
            .position(|m| m.name == name)?;
        let still = vec![0.0; self.mechanism.layout().n_v];
        Some(frames.marker(k, &self.state.q, &still).place)
    }

    /// Computes the reactions for a given choice at these velocities. The result contains the
    /// unique numbers, and one of many possible values for each other number.
    ///
    /// # Errors
    /// [`StudyError::Choice`]: there is no such distribution, or the rank is undecided.
    pub fn distribution(&self, choice: &Choice) -> Result<Distribution, StudyError> {
        if let Choice::Elimination(rows) = choice {
            self.check_rows(rows)?;
        }
        let choice = match choice {
            Choice::Compliance(supports) => Cow::Owned(Choice::Compliance(ElasticSupports {
                centres: self.centres(),
                ..supports.clone()
            })),
            choice => Cow::Borrowed(choice),
        };
        let mut found = self.questions.distribute(self.solution()?, &choice)?;
        self.sensitivities()?.add_to(&mut found.reactions);
        Ok(found)
    }

    /// Returns the conditions of contacts that a distribution violates.
    ///
    /// # Errors
    /// [`PermittedError`]
    pub fn violated(
        &self,
        distribution: &Distribution,
    ) -> Result<Vec<ContactCondition>, PermittedError> {
        let solution = self.solution();
        let solution = solution.map_err(|e| PermittedError::Accelerations(e.to_string()))?;
        self.questions.violated(solution, distribution)
    }

    /// Returns the components of all reactions with their verdicts, without values for the
    /// components that are not determined.
    ///
    /// # Errors
    /// [`StudyError::Choice`]: the rank is undecided; [`StudyError::Request`].
    pub fn determined_reactions(&self) -> Result<Vec<ReactionValues>, StudyError> {
        let mut found = self.questions.determined_reactions(self.solution()?)?;
        self.sensitivities()?.add_to(&mut found);
        Ok(found)
    }

    /// Returns the centres of stiffness of joints, if the scene states such points.
    pub(crate) fn centres(&self) -> Centres {
        elasticity::centres(self.scene, self.mechanism, &self.state.q)
    }

    /// Returns bounds of the reactions for elastic joints, from one solution. The centres of
    /// stiffness are the points that the scene states.
    ///
    /// # Errors
    /// Each number has its own error.
    pub fn bounds<'s>(
        &'s self,
        solution: &'s Solution,
        elasticity: &Elasticity,
    ) -> ReactionBounds<'s, 'a> {
        let centres = self.centres();
        let elasticity = Elasticity {
            centres,
            ..elasticity.clone()
        };
        self.questions.bounds(solution, &elasticity)
    }

    /// Returns the loads that one-sided joints and contacts that grip permit, from one solution;
    /// `None` if there are none.
    ///
    /// # Errors
    /// [`PermittedError`]
    pub fn permitted<'s>(
        &'s self,
        solution: &'s Solution,
    ) -> Result<Option<PermittedReactions<'s, 'a>>, PermittedError> {
        self.questions.permitted(solution)
    }

    /// Returns the search for replacements of joints. Returns `None` if the mechanism was not
    /// analysed as one part.
    pub(crate) fn replacements(&self) -> Result<Option<Replacements<'_, 'a>>, StudyError> {
        Ok(self.questions.replacements()?)
    }

    /// Returns the groups of the scene and these combinations, with their names.
    pub(crate) fn requested(&self, combine: &[String]) -> Result<Vec<(String, Group)>, StudyError> {
        requests::groups(self.scene, self.mechanism, combine)
    }

    /// Returns the reference point of a joint or drive (m).
    pub(crate) fn reference_point(&self, id: ConstraintId) -> Result<[f64; 3], StudyError> {
        Ok(self.questions.reference_point(id)?)
    }

    /// Returns a choice with its name, after a check that the choice is possible at this
    /// configuration.
    ///
    /// # Errors
    /// Returns the errors of [`Self::distribution`].
    pub fn named(&self, choice: &Choice) -> Result<NamedChoice, StudyError> {
        let label = self.distribution(choice)?.label;
        Ok(NamedChoice {
            label,
            choice: choice.clone(),
        })
    }

    /// Finds contradictions between redundant rows. The largest contradiction comes first. The
    /// result is empty if the rank is undecided.
    ///
    /// # Errors
    /// Returns an error if the configuration cannot be analysed.
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

    /// Computes one solution of the equations of motion.
    ///
    /// # Errors
    /// [`StudyError::Choice`]: the rank is undecided.
    pub fn solution(&self) -> Result<&Solution, StudyError> {
        once(&self.results.solution, || self.solved())
    }

    fn solved(&self) -> Result<Solution, StudyError> {
        let decision = &self.analysis.decision;
        if let rank::RankStatus::Undecided(doubt) = decision.status {
            return Err(ChoiceError::Undecided(doubt).into());
        }
        if self.has_no_velocities() {
            let rows = solvability::rows(self.mechanism, self.analysis.time, &self.state.q)?;
            if let rank::RankStatus::Undecided(doubt) = rows.all.status {
                return Err(ChoiceError::Undecided(doubt).into());
            }
        }
        let state = (self.analysis.time, &self.state.q[..], &self.state.v[..]);
        let mut found = solution(self.mechanism, state, decision)?;
        found.no_finite = self.no_finite_reactions()?.to_vec();
        Ok(found)
    }
}
