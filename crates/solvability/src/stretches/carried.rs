//! Determines the verdicts at instants of a motion on kept rows. The factors of these rows have
//! already been computed by the simulation.
//!
//! The rank is the rank of the current motion and is not decided again. Factored kept rows give
//! vectors of the left null space. The accuracy of these vectors is computed from the last full
//! decision, which uses the accuracy of the motion. If the vectors leave verdicts undecided, these
//! verdicts are decided in full at the first, second, fourth, eighth … of these instants in an
//! interval. The other instants give no verdict on these numbers.

use std::borrow::Cow;

use linalg::Matrix;
use model::{ConfigurationAccuracy, ConstraintId, Mechanism, Scratch, System};
use rank::RankStatus;

use super::recorder::Verdicts;
use super::{InstantOrder, Stretches, VerdictRecorder, VerdictTrack};
use crate::certificate::UncertainRows;
use crate::components::{all_components, judge_components, number_names};
use crate::error::AnalysisError;
use crate::groups::{Group, LinearForm, ReactionForms, RequestError};
use crate::limits::ROWS_MAX;
use crate::matrices::{self, Basis, QueryError, Solvability, orthonormal};
use crate::parts::{Extent, open_parts};
use crate::pose::evaluated;
use crate::sparse::SparseDecision;
use crate::verdict::Verdict;

/// The verdicts of a motion of a mechanism, collected during the simulation.
pub struct CarriedVerdicts<'m> {
    mechanism: &'m Mechanism,
    /// Length that makes C dimensionless (m).
    size: f64,
    accuracy: ConfigurationAccuracy,
    /// Accuracy of the configuration at the start. This configuration is exact as stored.
    at_start: ConfigurationAccuracy,
    parts: Vec<OpenPart<'m>>,
    groups: Vec<Group>,
    /// Numbers that have verdicts.
    numbers: Vec<JudgedNumber>,
    recorder: VerdictRecorder,
}

/// A basis of the left null space for rows of a part.
type BasisOf<'f, 'b> = dyn Fn(&[usize]) -> Cow<'b, Basis> + 'f;

/// Joints on common cycles whose rows depend on each other.
struct OpenPart<'m> {
    extent: Extent,
    mechanism: Cow<'m, Mechanism>,
    /// Rows in the mechanism, ascending.
    rows: Vec<usize>,
    redundancy: usize,
    /// Accuracy of vectors of the left null space, from the last full decision for the accuracy of
    /// the motion.
    known: Option<Accuracy>,
    /// Number of states since the last interval boundary at which the vectors left a number
    /// undecided.
    open: usize,
}

/// Accuracy of vectors of a left null space.
struct Accuracy {
    known: matrices::RowAccuracy,
    /// The smallest singular value of the equilibrated rows.
    sigma: f64,
    /// Factors of the columns of the mechanism in the equilibrated rows. The factor is zero for
    /// columns of other parts.
    columns: Vec<f64>,
}

/// A state of the motion, and vectors of the left null space of C at this state.
pub struct CarriedState<'s> {
    /// Time (s).
    pub t: f64,
    /// Coordinates, which satisfy the constraints.
    pub q: &'s [f64],
    /// Scratch in which Φ and C have been evaluated at this state.
    pub scratch: &'s Scratch,
    /// Dependencies of the rows of C, `Cᵀ·z = 0`, over all rows in SI units. There is one
    /// dependency for each dropped row, or [`crate::CARRIED_VECTORS`] sums of dependencies with
    /// random weights.
    pub dependencies: &'s [Vec<f64>],
}

impl<'m> CarriedVerdicts<'m> {
    /// Prepares verdicts for a motion that begins at time t with the coordinates q and drops these
    /// rows. The motion is integrated with a relative tolerance. Returns `None` if no row is
    /// dropped, because all numbers are then unique.
    #[must_use]
    pub fn new(
        mechanism: &'m Mechanism,
        (t, q): (f64, &[f64]),
        dropped: &[usize],
        rtol: f64,
        groups: &[Group],
    ) -> Option<Self> {
        if dropped.is_empty() {
            return None;
        }
        let open = open_parts(mechanism, (t, q), dropped).into_iter();
        let parts = open.map(|(extent, mechanism, redundancy)| OpenPart {
            rows: (0..mechanism.layout().rows())
                .map(|k| extent.row(k))
                .collect(),
            extent,
            mechanism,
            redundancy,
            known: None,
            open: 0,
        });
        let parts = parts.collect();
        let mut carried = Self {
            mechanism,
            size: model::start::scene_size(mechanism, q),
            accuracy: ConfigurationAccuracy::To(rtol),
            at_start: ConfigurationAccuracy::AsStored,
            parts,
            groups: groups.to_vec(),
            numbers: Vec::new(),
            recorder: VerdictRecorder::new(0),
        };
        carried.numbers = carried.all_numbers();
        carried.recorder = VerdictRecorder::new(carried.numbers.len());
        Some(carried)
    }

    /// Omits instants whose verdicts differ from the verdict on their interval, such as the start.
    /// The verdicts at these instants have only the accuracy of the motion, and are used for the
    /// next instants.
    pub fn leave_out_instants(&mut self) {
        self.at_start = self.accuracy;
    }

    /// Adds the verdicts at a state. If C cannot be analysed, the verdicts are undecided, and the
    /// reason is recorded.
    pub fn look(&mut self, at: &CarriedState<'_>, looked: InstantOrder) {
        let verdicts = self.verdicts(at).unwrap_or_else(|error| {
            let reason = error.to_string();
            vec![Some(Verdict::Undecided { reason }); self.recorder.numbers()]
        });
        self.recorder.see(at.t, looked, verdicts);
    }

    /// Returns the joints and drives for which neither the force nor the torque was determined at
    /// the last state. Components that are zero under any load are ignored.
    #[must_use]
    pub fn without_determined(&self) -> Vec<ConstraintId> {
        let layout = self.mechanism.layout();
        let (space, joints) = (layout.space, layout.groups.len());
        // Whether the force and the torque of each joint are free.
        let mut free: Vec<[Option<bool>; 2]> = vec![[None; 2]; joints];
        for (k, number) in self.numbers.iter().enumerate() {
            if let JudgedNumber::Component(id, name) = number
                && let Some(place) = space.component(name)
            {
                let is_free = self.recorder.latest(k) == Some(&Verdict::NotUnique);
                let vector = &mut free[id.0][usize::from(space.torques().contains(&place))];
                *vector = Some(is_free || *vector == Some(true));
            }
        }
        let is_open = |id: &ConstraintId| {
            let of = &free[id.0];
            of.contains(&Some(true)) && !of.contains(&Some(false))
        };
        layout.constraint_ids().filter(is_open).collect()
    }

    /// Returns whether a verdict was undecided at the last state.
    #[must_use]
    pub fn has_open(&self) -> bool {
        let mut all = 0..self.numbers.len();
        let is_decided = |k| self.recorder.latest(k).is_some_and(Verdict::is_decided);
        !all.all(is_decided)
    }

    /// Adds a state without verdicts on its interval, because the rank drops at this state.
    pub fn pass(&mut self, t: f64, looked: InstantOrder) {
        let nothing = vec![None; self.recorder.numbers()];
        self.recorder.see(t, looked, nothing);
    }

    /// Returns the verdicts at one instant on the components of the parts with redundant rows. All
    /// other numbers are unique. The verdicts are not recorded. If no state is given, the rank is
    /// lower at the instant, and the verdicts are undecided.
    pub fn components_at(
        &mut self,
        at: Option<&CarriedState<'_>>,
    ) -> Vec<(ConstraintId, &'static str, Verdict)> {
        let lower = "the rank at this instant is not that of the motion";
        let verdicts = match at.map(|at| self.verdicts(at)) {
            Some(Ok(verdicts)) => verdicts,
            Some(Err(error)) => {
                let reason = error.to_string();
                vec![Some(Verdict::Undecided { reason }); self.recorder.numbers()]
            }
            None => vec![None; self.recorder.numbers()],
        };
        let pairs = self.numbers.iter().zip(verdicts);
        let component = |(number, verdict): (&JudgedNumber, Option<Verdict>)| match *number {
            JudgedNumber::Component(id, name) => {
                let open = || Verdict::Undecided {
                    reason: lower.to_owned(),
                };
                Some((id, name, verdict.unwrap_or_else(open)))
            }
            JudgedNumber::Group(..) => None,
        };
        pairs.filter_map(component).collect()
    }

    fn verdicts(&mut self, at: &CarriedState<'_>) -> Result<Verdicts, AnalysisError> {
        let mut verdicts = Vec::with_capacity(self.recorder.numbers());
        let forms = self.forms(at)?;
        let known = if at.t == self.mechanism.layout().start_time {
            self.at_start
        } else {
            self.accuracy
        };
        for part in &mut self.parts {
            verdicts.extend(part.verdicts(self.mechanism, at, known, &forms)?);
        }
        Ok(verdicts)
    }

    /// Starts another interval.
    pub fn cut(&mut self, t: f64) {
        self.parts.iter_mut().for_each(|part| part.open = 0);
        self.recorder.cut(t);
    }

    /// Returns whether no state has been examined since this time.
    #[must_use]
    pub fn is_blank_since(&self, t: f64) -> bool {
        self.recorder.is_blank_since(t)
    }

    /// Returns the linear forms of the numbers of all groups at a configuration.
    fn forms(&self, at: &CarriedState<'_>) -> Result<Vec<LinearForm>, AnalysisError> {
        if self.groups.is_empty() {
            return Ok(Vec::new());
        }
        let reactions = ReactionForms::at(self.mechanism, at.scratch, self.size);
        let numbers = self.groups.iter().map(|group| reactions.numbers(group));
        let numbers = numbers.collect::<Result<Vec<_>, RequestError>>();
        let failed = |source: RequestError| AnalysisError::Group {
            time: at.t,
            source: Box::new(source),
        };
        let forms = numbers.map_err(failed)?.into_iter().flatten();
        Ok(forms.map(|(_, form)| form).collect())
    }

    /// Returns the numbers that have verdicts, part by part: components of joints, then numbers of
    /// groups.
    fn all_numbers(&self) -> Vec<JudgedNumber> {
        let layout = self.mechanism.layout();
        let mut numbers = Vec::new();
        for part in &self.parts {
            for own in 0..part.mechanism.layout().groups.len() {
                let id = ConstraintId(part.extent.group(own));
                let names = number_names(&layout.groups[id.0]);
                numbers.extend(names.map(|name| JudgedNumber::Component(id, name)));
            }
            for (k, group) in self.groups.iter().enumerate() {
                let names = group.number_names(layout.space);
                numbers.extend(names.iter().map(|name| JudgedNumber::Group(k, name)));
            }
        }
        numbers
    }

    /// Returns the verdicts from start to end.
    #[must_use]
    pub fn finish(self, extent: [f64; 2]) -> Stretches {
        let mut stretches = Stretches::unique(self.mechanism, extent, &self.groups);
        for (number, track) in self.numbers.into_iter().zip(self.recorder.finish(extent)) {
            match number {
                JudgedNumber::Component(id, name) => {
                    let own = &mut stretches.reactions[id.0].components;
                    if let Some((_, known)) = own.iter_mut().find(|(n, _)| *n == name) {
                        *known = track;
                    }
                }
                JudgedNumber::Group(k, name) => {
                    let own = &mut stretches.groups[k].numbers;
                    if let Some((_, known)) = own.iter_mut().find(|(n, _)| *n == name) {
                        *known = VerdictTrack::together(&[known, &track]);
                    }
                }
            }
        }
        stretches.sum_up(&self.groups);
        stretches
    }
}

/// A number that has a verdict.
enum JudgedNumber {
    Component(ConstraintId, &'static str),
    Group(usize, &'static str),
}

impl OpenPart<'_> {
    /// Returns the verdicts on the numbers of the part at a state.
    fn verdicts(
        &mut self,
        whole: &Mechanism,
        at: &CarriedState<'_>,
        known: ConfigurationAccuracy,
        forms: &[LinearForm],
    ) -> Result<Verdicts, AnalysisError> {
        let of_motion = known != ConfigurationAccuracy::AsStored;
        if of_motion && let Some(accuracy) = &self.known {
            let basis = self.carried_basis(whole, at, accuracy);
            let found = self.judged(whole, at, forms, &|_| Cow::Borrowed(&basis));
            let found = found.map_err(|source| AnalysisError::Query { time: at.t, source })?;
            if found.iter().all(Verdict::is_decided) {
                return Ok(found.into_iter().map(Some).collect());
            }
            // A full decision takes as long as many steps. Therefore the distance between full
            // decisions increases.
            self.open += 1;
            if !self.open.is_power_of_two() {
                let told = found.into_iter().map(|v| v.is_decided().then_some(v));
                return Ok(told.collect());
            }
        }
        self.decided(whole, at, known, forms)
    }

    /// Returns the verdicts of a full decision at a state. All verdicts are `None` if the rank at
    /// this state differs from the rank of the motion. The instant is then a singular configuration
    /// and has no verdict on its interval.
    fn decided(
        &mut self,
        whole: &Mechanism,
        at: &CarriedState<'_>,
        known: ConfigurationAccuracy,
        forms: &[LinearForm],
    ) -> Result<Verdicts, AnalysisError> {
        let q = self.extent.coordinates(at.q);
        let query = |source| AnalysisError::Query { time: at.t, source };
        let (found, accuracy) = if self.rows.len() <= ROWS_MAX {
            // For a configuration with the accuracy of the motion, double-double has no advantage.
            let s = evaluated(&self.mechanism, at.t, &q);
            let rows = if known == ConfigurationAccuracy::AsStored {
                UncertainRows::new(&self.mechanism, at.t, &q, known)?
            } else {
                UncertainRows::at(&self.mechanism, Cow::Borrowed(&s), &q, known)
            };
            let decision = if known == ConfigurationAccuracy::AsStored {
                Some(rows.decide()?)
            } else {
                rows.of_rank(self.rows.len() - self.redundancy)?
            };
            let Some(decision) = decision else {
                return Ok(self.nothing(forms));
            };
            let is_of_motion =
                decision.status == RankStatus::Decided && decision.redundancy == self.redundancy;
            let solvability = Solvability::from_decision(&rows.matrix(), decision);
            let basis = solvability.basis();
            let found = self.judged(whole, at, forms, &|_| Cow::Borrowed(basis));
            let (scaling, sigma) = {
                let decision = solvability.decision();
                (&decision.scaling, decision.evidence.sigma_r)
            };
            let accuracy = is_of_motion.then(|| {
                self.accuracy(
                    whole,
                    rows.size(),
                    basis.known.clone(),
                    &scaling.cols,
                    sigma,
                )
            });
            (found.map_err(query)?, accuracy)
        } else {
            let s = evaluated(&self.mechanism, at.t, &q);
            let decided = SparseDecision::of(&self.mechanism, &s, &q, 0..self.rows.len())?;
            let is_of_motion =
                decided.found.is_decided() && decided.found.redundancy == self.redundancy;
            let basis = |rows: &[usize]| Cow::Owned(decided.basis(rows));
            let found = self.judged(whole, at, forms, &basis);
            let all: Vec<usize> = (0..self.rows.len()).collect();
            let size = model::start::scene_size(&self.mechanism, &q);
            let (scaling, sigma) = (&decided.found.scaling, decided.found.evidence.sigma_r);
            let accuracy = is_of_motion
                .then(|| self.accuracy(whole, size, decided.known(&all, 0), &scaling.cols, sigma));
            (found.map_err(query)?, accuracy)
        };
        let is_of_motion = accuracy.is_some();
        if known != ConfigurationAccuracy::AsStored {
            self.known = accuracy.or(self.known.take());
        }
        Ok(if is_of_motion {
            found.into_iter().map(Some).collect()
        } else {
            vec![None; found.len()]
        })
    }

    /// Returns the result for an instant without verdicts on its interval.
    fn nothing(&self, forms: &[LinearForm]) -> Verdicts {
        let own = all_components(self.mechanism.layout()).count();
        vec![None; own + forms.len()]
    }

    /// Returns the accuracy of a decision. The columns were scaled with these exponents of two.
    fn accuracy(
        &self,
        whole: &Mechanism,
        size: f64,
        known: matrices::RowAccuracy,
        exponents: &[i32],
        sigma: f64,
    ) -> Accuracy {
        let dimensions = self.mechanism.layout().dimension_scaling(size).cols;
        let own = dimensions.iter().zip(exponents);
        let own: Vec<f64> = own.map(|(a, b)| f64::from(a + b).exp2()).collect();
        Accuracy {
            columns: self
                .extent
                .put_velocities(&own, vec![0.0; whole.layout().n_v]),
            known,
            sigma,
        }
    }

    /// Returns vectors of the left null space from the motion, orthonormal in equilibrated rows.
    /// The accuracy of these vectors is the accuracy of the last full decision, or the accuracy to
    /// which the vectors satisfy `Cᵀ·z = 0`.
    fn carried_basis(
        &self,
        whole: &Mechanism,
        at: &CarriedState<'_>,
        accuracy: &Accuracy,
    ) -> Basis {
        let mut known = accuracy.known.clone();
        let m = self.rows.len();
        let own: Vec<&[f64]> = at.dependencies.iter().map(Vec::as_slice).collect();
        let columns = own.len().min(self.redundancy);
        let z = orthonormal(&own, &self.rows, &known.row_factor, columns);
        // Dependencies may be almost parallel. This increases the error of their orthonormal
        // vectors.
        let missed = (0..columns).map(|j| self.missed(whole, at, (&z, j), accuracy));
        let off = missed.fold(0.0, f64::max) / accuracy.sigma.min(1.0);
        for noise in &mut known.row_noise {
            *noise = noise.max(rank::NOISE_FACTOR * off);
        }
        // If there are many dependencies, only some combinations are available. Each combination
        // has its share of the size of the dependencies.
        let share = (self.redundancy as f64 / columns as f64).sqrt();
        let z = if share > 1.0 {
            Matrix::from_fn(m, columns, |i, j| share * z[(i, j)])
        } else {
            z
        };
        Basis {
            c: Matrix::zeros(m, 0),
            z,
            known,
            exact: None,
        }
    }

    /// Returns ‖Cᵀ·z‖ of a vector in equilibrated rows of the part.
    fn missed(
        &self,
        whole: &Mechanism,
        at: &CarriedState<'_>,
        (z, j): (&Matrix, usize),
        accuracy: &Accuracy,
    ) -> f64 {
        let layout = whole.layout();
        let mut sums = vec![0.0; layout.n_v];
        for (i, &row) in self.rows.iter().enumerate() {
            let z = z[(i, j)] * accuracy.known.row_factor[i];
            for (column, c) in layout.row(at.scratch, row) {
                sums[column] += z * c;
            }
        }
        let sums = sums.iter().zip(&accuracy.columns);
        sums.map(|(sum, factor)| sum * factor).fold(0.0, f64::hypot)
    }

    /// Returns the verdicts on all numbers of the part, with a basis for rows of the part. A basis
    /// of all rows may be given; it is then used for some of the rows.
    fn judged<'b>(
        &self,
        whole: &Mechanism,
        at: &CarriedState<'_>,
        forms: &[LinearForm],
        basis: &BasisOf<'_, 'b>,
    ) -> Result<Vec<Verdict>, QueryError> {
        let mut verdicts = Vec::new();
        for (own, group) in self.mechanism.layout().groups.iter().enumerate() {
            let id = ConstraintId(self.extent.group(own));
            let rows: Vec<usize> = group.rows.iter().collect();
            let basis = basis(&rows);
            let places = places(&basis, &rows, self.rows.len());
            let judged = judge_components(whole, id, at.scratch, &basis, &places)?;
            verdicts.extend(judged.into_iter().map(|j| j.verdict));
        }
        for form in forms {
            let own: Vec<usize> = (0..self.rows.len())
                .filter(|&i| form.has_term(self.rows[i]))
                .collect();
            let basis = basis(&own);
            let places = places(&basis, &own, self.rows.len());
            let all: Vec<usize> = own.iter().map(|&i| self.rows[i]).collect();
            let map = form.map_of(&all);
            verdicts.push(basis.mapped(&map, places)?.component(0)?.verdict);
        }
        Ok(verdicts)
    }
}

/// Returns the indices of these rows of a part in a basis. The basis covers all rows or only these
/// rows.
fn places(basis: &Basis, rows: &[usize], all: usize) -> Vec<usize> {
    if basis.z.nrows() == all {
        rows.to_vec()
    } else {
        (0..rows.len()).collect()
    }
}
