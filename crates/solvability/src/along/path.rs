//! Moves the states of a motion onto the constraints, and samples them.

use crate::error::AnalysisError;
use crate::limits::{REGULAR_SAMPLE, ROWS_MAX};
use crate::pose::{dimensionless, evaluated, uncertainty};
use std::cell::OnceCell;

use linalg::{Matrix, Scaling};
use model::start::{Metric, nearest_configuration, scene_size};
use model::{Mechanism, Scratch, System};
use rank::RankDecision;

use super::data::AlongError;
use crate::certificate::{UncertainRows, holding_together};
use crate::components::judge_all;
use crate::matrices::Solvability;
use crate::state::{self, State};
use crate::verdict::Judgement;

/// Results that are determined at each sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// The rank.
    Rank,
    /// The rank, and the verdicts on components.
    Verdicts,
}

/// A motion of a mechanism.
pub(super) struct Path<'a, F> {
    pub(super) mechanism: &'a Mechanism,
    motion: F,
    /// Numbers of the rows of Φ along the motion.
    holonomic: Vec<usize>,
    /// Length that makes C dimensionless, the same along the motion.
    size: f64,
    /// The rank almost everywhere.
    pub(super) rank: usize,
    /// The instant (s) with this rank that is farthest from a singular configuration.
    pub(super) typical: f64,
    /// The equilibration of the best sample, used for all samples.
    scaling: Scaling,
    /// The samples in chronological order.
    pub(super) samples: Vec<Sample>,
}

/// The motion at one instant.
pub(super) struct Point {
    pub(super) t: f64,
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) s: Scratch,
    /// Dimensionless C.
    pub(super) c: Matrix,
    /// The accuracy of the entries of C, computed on the first request.
    known: OnceCell<Matrix>,
}

/// A point at which the rank has been determined.
pub(super) struct Sample {
    pub(super) t: f64,
    /// The r-th singular value of the equilibrated C. Here r is the rank almost everywhere.
    pub(super) sigma: f64,
    /// Whether the rank is decided and equal to r, and the configuration is not nearly singular.
    pub(super) regular: bool,
    /// C, equilibrated with the scaling of all samples.
    pub(super) c: Matrix,
    pub(super) decision: RankDecision,
    /// The verdicts on all components, in the order of joints and drives. The list is empty if only
    /// ranks are requested.
    pub(super) judged: Vec<Judgement>,
}

impl<'a, F: FnMut(f64) -> State> Path<'a, F> {
    /// Samples a motion and determines its rank almost everywhere: the largest rank of the samples.
    pub(super) fn new(
        mechanism: &'a Mechanism,
        mut motion: F,
        times: &[f64],
        detail: Detail,
    ) -> Result<Self, AlongError> {
        let layout = mechanism.layout();
        let first = motion(times[0]);
        state::check_state(mechanism, times[0], &first.q, &first.v)?;
        let mut path = Self {
            mechanism,
            motion,
            holonomic: holding_together(mechanism, times[0], &first.q, (0..layout.m).collect()),
            size: scene_size(mechanism, &first.q),
            rank: 0,
            typical: times[0],
            scaling: Scaling::identity(layout.rows(), layout.n_v),
            samples: Vec::new(),
        };
        for &t in times {
            let point = path.at(t)?;
            let decision = path.decide(&point, 0.0)?;
            let judged = match detail {
                Detail::Rank => Vec::new(),
                Detail::Verdicts => path.judged(&point, decision.clone())?,
            };
            path.samples.push(Sample {
                t,
                sigma: 0.0,
                regular: false,
                c: point.c,
                decision,
                judged,
            });
        }
        path.settle_rank()?;
        Ok(path)
    }

    /// Takes rank and equilibration from the samples, and evaluates all samples with this rank and
    /// equilibration.
    fn settle_rank(&mut self) -> Result<(), AlongError> {
        let sigma = |s: &Sample| s.decision.evidence.sigma_r;
        let decided = self.samples.iter().filter(|s| s.decision.is_decided());
        let best = decided.max_by(|a, b| {
            let ranks = a.decision.rank.cmp(&b.decision.rank);
            ranks.then(sigma(a).total_cmp(&sigma(b)))
        });
        let Some(best) = best else {
            let Sample { t, decision, .. } = &self.samples[self.samples.len() - 1];
            return Err(AlongError::Undecided {
                time: *t,
                sigma_r: decision.evidence.sigma_r,
                sigma_next: decision.evidence.sigma_next,
                tolerance: decision.evidence.tolerance,
            });
        };
        (self.rank, self.typical) = (best.decision.rank, best.t);
        self.scaling = best.decision.scaling.clone();
        for sample in &mut self.samples {
            sample.c = self.scaling.apply(&sample.c);
            let known = &sample.decision.evidence.singular_values;
            let same = sample.decision.scaling == self.scaling;
            sample.sigma = match self.rank.checked_sub(1).and_then(|k| known.get(k)) {
                Some(sigma) if same => *sigma,
                _ => singular_value(&sample.c, self.rank),
            };
        }
        let largest = self.samples.iter().map(|s| s.sigma).fold(0.0, f64::max);
        let limit = rank::NEARLY_REDUNDANT.min(REGULAR_SAMPLE * largest);
        for s in &mut self.samples {
            s.regular = s.decision.is_decided() && s.decision.rank == self.rank && s.sigma >= limit;
        }
        Ok(())
    }

    /// Returns the state at time t, moved onto the constraints.
    pub(super) fn at(&mut self, t: f64) -> Result<Point, AlongError> {
        let State { q, v } = (self.motion)(t);
        state::check_state(self.mechanism, t, &q, &v)?;
        let q = nearest_configuration(self.mechanism, t, &self.holonomic, &q, Metric::Mass)
            .map_err(|source| AlongError::OffConstraints { time: t, source })?;
        let s = evaluated(self.mechanism, t, &q);
        let c = dimensionless(self.mechanism, &s, self.size);
        Ok(Point {
            t,
            q,
            v,
            s,
            c,
            known: OnceCell::new(),
        })
    }

    /// Returns the accuracy of the entries of C at a point.
    fn known<'p>(&self, p: &'p Point) -> &'p Matrix {
        p.known
            .get_or_init(|| uncertainty(self.mechanism, &p.s, self.size))
    }

    /// Returns the length that makes C dimensionless.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Decides the rank at a point. `distance` is an upper bound of the distance between C at the
    /// point and the matrix whose rank is requested.
    pub(super) fn decide(&self, p: &Point, distance: f64) -> Result<RankDecision, AlongError> {
        let layout = self.mechanism.layout();
        if distance == 0.0 && self.mechanism.has_tolerances() && layout.rows() <= ROWS_MAX {
            let at = (&p.s, p.q.as_slice(), self.size);
            let rows = UncertainRows::of_matrix(self.mechanism, at, &p.c, self.known(p));
            return Ok(rows.decide()?);
        }
        let decision = match distance {
            0.0 => rank::decide(&p.c, self.known(p)),
            _ => {
                let mut known = self.known(p).clone();
                let entries = known.as_mut_slice().iter_mut();
                entries.for_each(|known| *known += distance);
                rank::decide(&p.c, &known)
            }
        };
        decision.map_err(|source| AnalysisError::Rank { time: p.t, source }.into())
    }

    /// Returns C at a point, equilibrated with the scaling of all samples.
    pub(super) fn equilibrated(&self, p: &Point) -> Matrix {
        self.scaling.apply(&p.c)
    }

    /// Returns the r-th singular value at time t.
    pub(super) fn sigma(&mut self, t: f64) -> Result<f64, AlongError> {
        let point = self.at(t)?;
        Ok(singular_value(&self.equilibrated(&point), self.rank))
    }

    /// Returns the verdicts on all components at time t.
    pub(super) fn judged_at(&mut self, t: f64) -> Result<Vec<Judgement>, AlongError> {
        let point = self.at(t)?;
        let decision = self.decide(&point, 0.0)?;
        self.judged(&point, decision)
    }

    /// Returns the verdicts on all components at a point with a decided rank.
    pub(super) fn judged(
        &self,
        p: &Point,
        decision: RankDecision,
    ) -> Result<Vec<Judgement>, AlongError> {
        let pose = (&p.s, &p.q[..], self.size);
        let rows = UncertainRows::of_matrix(self.mechanism, pose, &p.c, self.known(p));
        let solvability = Solvability::from_decision(&rows.matrix(), decision);
        let judged = judge_all(self.mechanism, &p.s, solvability.basis());
        judged.map_err(|source| AnalysisError::Query { time: p.t, source }.into())
    }

    /// Returns the first and last sample time (s).
    pub(super) fn extent(&self) -> [f64; 2] {
        [self.samples[0].t, self.samples[self.samples.len() - 1].t]
    }
}

/// Returns σ_r, or infinity if the rank is 0.
pub(super) fn singular_value(c: &Matrix, rank: usize) -> f64 {
    match rank {
        0 => f64::INFINITY,
        r => linalg::singular_values(c)[r - 1],
    }
}
