//! One configuration of a scene, and everything that can be asked of its reactions. Each method answers one question; what
//! nobody asks is not computed.

mod document;
mod requests;

use linalg::{Certificate, DeletionError, Limits, Matrix, count_deletions, deletions};
use model::{ConstraintId, Known, Mechanism, Scratch, System};
use scene::Scene;
use solvability::{
    Allowed, Analysis, Choice, ChoiceError, Configuration, Continuation, Contradiction,
    Distribution, Equations, Explanation, ExplanationError, FrameVerdict, Generic, GroupVerdict,
    LinearForm, Proposals, Ranks, ReactionVerdict, RequestError, State, UnitCheck, Value,
    analyse_dropping, analyse_known, certify, check_units, contradictions, explain, generic,
    is_locked, make_unique, second_order,
};

use crate::error::StudyError;

/// Numbers of a group by name: `sum`, or `Fx`, `Fy` and `T`.
pub type Numbers = Vec<(&'static str, Value)>;

/// A configuration whose rank has been decided, with its verdicts.
///
/// ```
/// use pfaff::linalg::Limits;
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
/// let start = study.inquire(0.0, None)?;
/// assert_eq!(start.verdict("left")?.wrench.verdict.word(), "not_unique");
/// assert_eq!(start.eliminations()?, 2);
/// let left = start.reaction("left")?;
/// let ways = start.make_unique(left, &Allowed::Sensible, Limits::default())?.ways;
/// assert_eq!(ways[0].text, "delete `right`");
/// let wrong = start.verdict("lift").unwrap_err();
/// assert_eq!(wrong.to_string(), "there is no joint or drive `lift`; did you mean `left`?");
/// # Ok::<(), StudyError>(())
/// ```
pub struct Inquiry<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its mechanism.
    pub mechanism: &'a Mechanism,
    /// Coordinates and velocities; the latter are empty where the rank is undecided, because none are known to be consistent.
    pub state: State,
    /// Ranks and verdicts.
    pub analysis: Analysis,
    /// The proof of the rank, also where the caller chose the dropped rows.
    pub certificate: Option<Certificate>,
    configuration: Configuration<'a>,
    scratch: Scratch,
}

impl<'a> Inquiry<'a> {
    /// A state that satisfies the constraints at time t, and how well its configuration is known.
    pub(crate) fn new(
        scene: &'a Scene,
        mechanism: &'a Mechanism,
        t: f64,
        state: State,
        known: Known,
        drop: Option<&[usize]>,
    ) -> Result<Self, StudyError> {
        let q = &state.q;
        let (analysis, certificate) = match drop {
            None => {
                let analysis = analyse_known(mechanism, t, q, known)?;
                let certificate = analysis.decision.evidence.certificate.clone();
                (analysis, certificate)
            }
            Some(rows) => {
                let analysis = analyse_dropping(mechanism, t, q, rows)?;
                let certified = certify(mechanism, t, q)?;
                let same = certified.is_decided() && certified.rank == analysis.decision.rank;
                let certificate = certified.evidence.certificate.filter(|_| same);
                (analysis, certificate)
            }
        };
        let configuration = Configuration::new(mechanism, t, q, &analysis.decision)?;
        let mut scratch = mechanism.scratch();
        mechanism.pose(t, q, &mut scratch);
        mechanism.phi(&mut scratch);
        mechanism.c(&mut scratch);
        Ok(Self {
            scene,
            mechanism,
            state,
            analysis,
            certificate,
            configuration,
            scratch,
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

    /// Verdicts by name: the groups of the scene, then sums of components as `W3.N + W4.N`, or of whole wrenches as `W3 + W4`.
    ///
    /// # Errors
    /// If a sum cannot be read or names something unknown.
    pub fn groups(&self, combine: &[String]) -> Result<Vec<(String, GroupVerdict)>, StudyError> {
        requests::groups(self.scene, self.mechanism, combine)?
            .into_iter()
            .map(|(name, group)| Ok((name, self.configuration.group(&group)?)))
            .collect()
    }

    /// The verdict of one such sum.
    ///
    /// # Errors
    /// If it cannot be read or names something unknown.
    pub fn group(&self, combination: &str) -> Result<GroupVerdict, StudyError> {
        let group = requests::combination(self.scene, self.mechanism, combination)?;
        Ok(self.configuration.group(&group)?)
    }

    /// The numbers of the same groups that every solution shares, by name; several reactions side by side have none.
    ///
    /// # Errors
    /// As [`Inquiry::groups`], and [`StudyError::Choice`]: there are no reactions, or the rank is undecided.
    pub fn determined(&self, combine: &[String]) -> Result<Vec<Numbers>, StudyError> {
        let lambda_0 = self.multipliers()?;
        self.numbers(combine, |form| {
            let is_unique = self.configuration.judge(form)?.verdict.is_unique();
            let value = || Value::Unique(self.configuration.value(form, &lambda_0));
            Ok(is_unique.then(value))
        })
    }

    /// All numbers of the same groups as a choice gives them.
    ///
    /// # Errors
    /// As [`Inquiry::groups`].
    pub fn chosen(
        &self,
        combine: &[String],
        distribution: &Distribution,
    ) -> Result<Vec<Numbers>, StudyError> {
        self.numbers(combine, |form| {
            Ok(Some(distribution.value(&self.configuration, form)?))
        })
    }

    fn numbers(
        &self,
        combine: &[String],
        value: impl Fn(&LinearForm) -> Result<Option<Value>, RequestError>,
    ) -> Result<Vec<Numbers>, StudyError> {
        requests::groups(self.scene, self.mechanism, combine)?
            .iter()
            .map(|(_, group)| {
                let forms = self.configuration.numbers(group)?;
                let values = forms.iter().filter_map(|(name, form)| {
                    let value = value(form).transpose()?;
                    Some(value.map(|value| (*name, value)))
                });
                Ok(values.collect::<Result<_, _>>()?)
            })
            .collect()
    }

    /// Ranks at other configurations of the same component; nothing if none could be reached.
    #[must_use]
    pub fn generic(&self) -> Option<Generic> {
        generic(self.mechanism, self.analysis.time, &self.state.q)
    }

    /// How the motion goes on at a singular configuration, where the redundancy is larger than elsewhere: along one branch only, or
    /// not determined by the constraints. Nothing where the configuration is not singular, or where the velocities of the scene do
    /// not say which motion is meant: it stands still, or has several freedoms.
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn continuation(&self, generic: &Generic) -> Result<Option<Continuation>, StudyError> {
        let (decision, State { q, v }) = (&self.analysis.decision, &self.state);
        if generic.redundancy >= decision.redundancy || v.is_empty() {
            return Ok(None);
        }
        let rank = decision.rank + decision.redundancy - generic.redundancy;
        let regular = match self.analysis.velocities - rank {
            0 => Matrix::zeros(v.len(), 0),
            1 if v.iter().any(|v| *v != 0.0) => Matrix::from_fn(v.len(), 1, |i, _| v[i]),
            _ => return Ok(None),
        };
        let found = second_order(self.mechanism, self.analysis.time, q, v, decision, &regular)?;
        Ok(Some(found))
    }

    /// Whether the mechanism cannot move although it has freedoms of first order: second order blocks all of them.
    ///
    /// # Errors
    /// [`StudyError::State`]
    pub fn is_locked(&self) -> Result<bool, StudyError> {
        let analysis = &self.analysis;
        let (t, decision) = (analysis.time, &analysis.decision);
        Ok(is_locked(self.mechanism, t, &self.state.q, decision)?)
    }

    /// Why the reactions are not unique; nothing while the rank is undecided, where every sentence would build on one of two
    /// readings.
    ///
    /// # Errors
    /// [`StudyError::Explanation`]
    pub fn explanation(&self) -> Result<Option<Explanation>, StudyError> {
        let (q, solvability) = (&self.state.q, self.configuration.solvability());
        match explain(self.mechanism, &self.scratch, q, solvability) {
            Ok(explanation) => Ok(Some(explanation)),
            Err(ExplanationError::Undecided(_)) => Ok(None),
            Err(e) => Err(e.into()),
        }
    }

    /// The number of sets of rows that can be deleted without a change of motion, as many rows as the degree of redundancy.
    ///
    /// # Errors
    /// [`DeletionError`]: the rank or one of the sets is undecided, or they are too many.
    pub fn eliminations(&self) -> Result<u128, DeletionError> {
        count_deletions(&self.analysis.decision)
    }

    /// The first of these sets, rows from 0.
    ///
    /// # Errors
    /// [`DeletionError`]: the rank or one of the sets is undecided.
    pub fn elimination_sets(&self, limit: usize) -> Result<Vec<Vec<usize>>, DeletionError> {
        deletions(&self.analysis.decision, limit)
    }

    /// The smallest deletions that make a reaction unique without a change of motion.
    ///
    /// # Errors
    /// [`DeletionError`]: the rank or an answer is undecided, or a row that is allowed does not exist.
    pub fn make_unique(
        &self,
        id: ConstraintId,
        allowed: &Allowed,
        limits: Limits,
    ) -> Result<Proposals, DeletionError> {
        let solvability = self.configuration.solvability();
        make_unique(self.mechanism, solvability, id, allowed, limits)
    }

    /// The verdicts of a reaction in all frames that it has.
    ///
    /// # Errors
    /// [`StudyError::Request`]
    pub fn frames(&self, id: ConstraintId) -> Result<Vec<FrameVerdict>, StudyError> {
        Ok(self.configuration.frames(id)?)
    }

    /// The reactions that a choice gives at these velocities: what is unique, and one of many for the rest.
    ///
    /// # Errors
    /// [`StudyError::Choice`]: there is no such distribution, or the rank is undecided.
    pub fn distribution(&self, choice: &Choice) -> Result<Distribution, StudyError> {
        if let Choice::Elimination(rows) = choice {
            self.check_rows(rows)?;
        }
        let lambda_0 = self.multipliers()?;
        Ok(self.configuration.distribute(&lambda_0, choice)?)
    }

    /// Which components are facts, and which depend on a choice: told by a change of units, without any verdict.
    ///
    /// # Errors
    /// [`StudyError::Units`]: there is nothing to compare, or the rank depends on the units.
    pub fn facts(&self) -> Result<Vec<UnitCheck>, StudyError> {
        let v = self.velocities()?;
        let (t, decision) = (self.analysis.time, &self.analysis.decision);
        Ok(check_units(self.mechanism, t, &self.state.q, v, decision)?)
    }

    /// What redundant rows contradict each other in, the worst first; nothing is known of this where the rank is undecided
    /// in `f64`.
    ///
    /// # Errors
    /// If the configuration cannot be judged.
    pub fn contradictions(&self) -> Result<Vec<Contradiction>, StudyError> {
        let (s, q) = (&self.scratch, &self.state.q);
        // Velocities are known to the rounding of `f64`, so they are compared by ranks decided in `f64`.
        let all = solvability::decide(self.mechanism, s, q)?;
        let holonomic = solvability::decide_holonomic(self.mechanism, s, q)?;
        if !all.is_decided() || !holonomic.is_decided() || self.state.v.is_empty() {
            return Ok(Vec::new());
        }
        let ranks = Ranks {
            all: &all,
            holonomic: &holonomic,
        };
        let t = self.analysis.time;
        Ok(contradictions(self.mechanism, t, q, &self.state.v, ranks)?)
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
    fn multipliers(&self) -> Result<Vec<f64>, StudyError> {
        let v = self.velocities()?;
        let equations = Equations::of(self.mechanism, self.analysis.time, &self.state.q, v)?;
        Ok(equations.multipliers(&self.analysis.decision)?)
    }

    fn velocities(&self) -> Result<&[f64], StudyError> {
        match self.analysis.decision.status {
            linalg::RankStatus::Undecided(doubt) => Err(ChoiceError::Undecided(doubt).into()),
            _ => Ok(&self.state.v),
        }
    }
}
