//! Computes the smallest error of the data (m) for a lower rank, at one configuration and at all
//! configurations of a continuation. The module also computes the lowest rank of data within a
//! stated tolerance.
//!
//! Rows that nearly depend on other rows at a configuration are dropped together. Therefore the
//! mechanism moves away from this configuration on rows that are certainly independent. At the
//! configurations that the mechanism reaches, the module determines which dropped rows are
//! independent in general. These rows are kept again, one rank after the other.

use crate::limits::{CLEAR_ENTRY, CURVED, PAIRS, WALKED};
use linalg::{Matrix, Scaling};
use model::{DataBlock, Scratch, System};

use super::cone::{Equation, least_change};
use super::follow::Step;
use super::pose::{Candidate, Gradient, Pose, most_independent_of};
use super::share::{Question, StatedTolerance, equation, pairs, rounding};
use super::walk::{Walk, walk};

/// The smallest error of the data for a rank that is lower by one (m). Angles are multiplied by the
/// size of the mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearness {
    /// Error in the data for a lower rank at this configuration alone.
    pub(crate) here: f64,
    /// Error for one change of the data at all configurations of a continuation. From this change
    /// upwards, a row is redundant. The change is infinite if no change makes a row redundant.
    pub(crate) everywhere: f64,
    /// A lower bound of this error if nonholonomic rows are kept. Such rows do not constrain
    /// positions. Therefore other configurations are reached from a start with the uncertainty of
    /// the data. Without nonholonomic rows, the value equals [`everywhere`](Self::everywhere).
    pub(crate) at_least: f64,
    /// Whether the continuation found enough configurations to distinguish a redundancy from a
    /// singular configuration.
    pub(crate) is_walked: bool,
    /// Whether only angles change, because a tolerance is stated only for angles.
    pub(crate) by_angles: bool,
}

/// The lowest rank of data within a tolerance.
pub(super) struct LeastRank {
    pub(super) rank: usize,
    /// Distance of the data from this rank. If the rank does not drop, it is the distance from one
    /// rank less.
    pub(super) nearness: Option<Nearness>,
    pub(super) certainty: Certainty,
}

/// Whether the rank is one less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Certainty {
    /// The rank is decided.
    Decided,
    /// Undecided. The rank is one less for changes above this length (m), which is close to the
    /// tolerance.
    From(f64),
    /// Undecided, because other configurations could not be examined.
    OtherPoses,
}

/// A lower rank, examined at a configuration.
struct Lower<'q> {
    question: &'q Question<'q>,
    blocks: Vec<DataBlock>,
    /// C with one unit for all lengths, and its factors.
    scaled: Matrix,
    scaling: Scaling,
    dimensions: Scaling,
    /// Rows that would be kept, as indices of the analysed rows.
    kept: Vec<usize>,
    /// Unit of changes (m), and the corresponding change of each block.
    least: f64,
    known: Vec<f64>,
    by_angles: bool,
    /// The change that lowers the rank by one at this configuration only (m).
    here: f64,
}

impl Question<'_> {
    /// Returns the distance (m) of the data from a rank that is one less than `rank`, if the
    /// distance is at most `limit`.
    pub(crate) fn nearness(&self, rank: usize, limit: f64) -> Option<Nearness> {
        let lower = self.lower(rank.checked_sub(1)?, limit)?;
        Some(lower.near(&lower.walked(), &lower.kept))
    }

    /// Returns the lowest rank, at most `rank`, of data within the tolerance. Also returns the
    /// distance of the data from this rank if the distance is at most `limit` (m).
    pub(super) fn least_rank(
        &self,
        rank: usize,
        tolerance: StatedTolerance,
        limit: f64,
    ) -> LeastRank {
        let share = |length: f64| length / tolerance.metres;
        let is_near = |lower| self.lower(lower, rank::BEYOND_DOUBT * tolerance.metres);
        let stays = |nearness: Option<Nearness>| LeastRank {
            rank,
            nearness: nearness.or_else(|| self.nearness(rank, limit)),
            certainty: Certainty::Decided,
        };
        let Some(lowest) = (0..rank).rev().map_while(is_near).last() else {
            return stays(None);
        };
        let away = lowest.walked();
        let order = self.most_independent(&lowest, &away);
        let first = lowest.kept.len();
        let mut last = None;
        for lower in first..rank {
            let mut kept = lowest.kept.clone();
            kept.extend(&order[..lower - first]);
            kept.sort_unstable();
            let Some(asked) = self.lower_of(kept, limit) else {
                continue;
            };
            let own = if lower == first {
                asked.near(&away, &asked.kept)
            } else {
                asked.near(&asked.walked(), &asked.kept)
            };
            // Rows that are kept again may be singular at this configuration. In this case no
            // motion is possible.
            let is_unknown = !own.is_walked && share(own.everywhere) <= rank::BEYOND_DOUBT;
            let near = if is_unknown && lower > first {
                asked.near(&away, &lowest.kept)
            } else {
                own
            };
            let found = |rank, certainty| LeastRank {
                rank,
                nearness: Some(near),
                certainty,
            };
            if share(near.everywhere) < (1.0 / rank::BEYOND_DOUBT) {
                return if near.is_walked {
                    found(lower, Certainty::Decided)
                } else {
                    found(lower + 1, Certainty::OtherPoses)
                };
            }
            if share(near.everywhere) <= rank::BEYOND_DOUBT {
                return found(lower + 1, Certainty::From(near.everywhere));
            }
            if share(near.at_least) <= rank::BEYOND_DOUBT {
                return found(lower + 1, Certainty::OtherPoses);
            }
            last = (lower + 1 == rank).then_some(near);
        }
        stays(last)
    }

    /// Returns the dropped rows. The rows that are most independent of the kept rows at the last
    /// configuration of the continuation come first.
    fn most_independent(&self, lowest: &Lower<'_>, away: &Walk) -> Vec<usize> {
        let scaled = match away.farthest() {
            None => lowest.scaled.clone(),
            Some(q) => {
                let s = crate::pose::evaluated(self.mechanism, self.s.t, q);
                lowest.scaling.apply(&self.dimensionless(&s))
            }
        };
        most_independent_of(&scaled, &lowest.kept)
    }

    /// Examines the rank `lower`. The rows that are most independent at this configuration are
    /// kept. Returns `None` if this rank requires a change of the data by more than `limit` (m).
    fn lower(&self, lower: usize, limit: f64) -> Option<Lower<'_>> {
        let (scaled, scaling) = self.uniform(self.s);
        let candidate = Candidate::of_rank(&scaled, lower);
        self.examined(scaled, scaling, candidate, limit)
    }

    /// Examines the rank of C if only the rows `kept` are independent.
    fn lower_of(&self, kept: Vec<usize>, limit: f64) -> Option<Lower<'_>> {
        let (scaled, scaling) = self.uniform(self.s);
        let candidate = Candidate::of_rows(&scaled, kept);
        self.examined(scaled, scaling, candidate, limit)
    }

    /// Examines whether C could have the lower rank of `candidate` after a change of data. `scaled`
    /// is C with the same unit for all lengths. Returns `None` if the necessary change is above
    /// `limit` (m).
    fn examined(
        &self,
        scaled: Matrix,
        scaling: Scaling,
        candidate: Candidate,
        limit: f64,
    ) -> Option<Lower<'_>> {
        let stated = self.tolerance();
        let tolerance = stated.map(|stated| stated.metres);
        if candidate.weakest() > CLEAR_ENTRY {
            return None;
        }
        let dimensions = self.mechanism.layout().dimension_scaling(self.size);
        let blocks = self.mechanism.data().blocks(self.s);
        let unit: Vec<f64> = blocks.iter().map(|b| self.unit(b, tolerance)).collect();
        let kept = candidate.kept.clone();
        let matrices = (&scaled, &dimensions, &scaling);
        let here = Pose::new(self.mechanism, self.s, self.places, matrices, candidate);
        let (weakest, gradient) = here.entry(0, 0);
        let parts = blocks.iter().zip(&unit);
        let parts = parts.map(|(block, unit)| block.change(&gradient.data, *unit));
        let least = weakest.abs() / parts.sum::<f64>();
        // The rank does not change if no datum changes it.
        if least.is_nan() || least > limit {
            return None;
        }
        // The unit is relative to the change that a single entry needs, so that rounding has no
        // effect.
        let least = least.max(self.size * f64::EPSILON);
        let mut lower = Lower {
            question: self,
            known: unit.iter().map(|unit| unit * least).collect(),
            by_angles: stated.is_some_and(|stated| stated.by_angles),
            here: 0.0,
            blocks,
            scaling,
            dimensions,
            kept,
            least,
            scaled,
        };
        let noise = rounding(&lower.scaled);
        let mut asked = lower.asked(&here, &[], noise);
        asked.extend(lower.misfits(&here, noise));
        lower.here = least * lower.change(&[&asked[..]], 1.0, Start::Known);
        (lower.here <= limit).then_some(lower)
    }
}

impl Lower<'_> {
    fn rows(&self, kept: &[usize]) -> Vec<usize> {
        kept.iter().map(|&k| self.question.places[k]).collect()
    }

    /// Returns the continuation on those rows that would be kept.
    fn walked(&self) -> Walk {
        walk(self.question, &self.rows(&self.kept))
    }

    /// Returns the distance of the data at configurations that satisfy the rows `held`.
    fn near(&self, walked: &Walk, held: &[usize]) -> Nearness {
        let m = self.question.mechanism.layout().m;
        let is_led = self.rows(held).iter().any(|&row| row >= m);
        let start = self.at(self.question.s, held, &[]);
        let sides = [0, 1].map(|side| {
            let poses = walked.poses(side).map(|(q, way)| {
                let s = crate::pose::evaluated(self.question.mechanism, self.question.s.t, q);
                self.at(&s, held, &way.collect::<Vec<_>>())
            });
            poses.collect::<Vec<_>>()
        });
        let poses = |reach: [usize; 2]| -> Vec<&[PoseEquation]> {
            let [one, other] = &sides;
            let others = one[..reach[0]].iter().chain(&other[..reach[1]]);
            std::iter::once(&start)
                .chain(others)
                .map(|x| &**x)
                .collect()
        };
        let change = |reach: [usize; 2]| {
            let share = self.change(&poses(reach), 1.0, Start::Known);
            self.least * self.change(&poses(reach), share, Start::Known)
        };
        let (mut reach, known) = (walked.reach(), walked.known_reach());
        let mut everywhere = change(reach);
        let mut certain = reach;
        if let Some(stated) = self.question.tolerance() {
            // A full rank requires configurations that the intended mechanism has for all data
            // within the tolerance. A redundancy requires configurations that the intended
            // mechanism has up to the change of the data that makes a row redundant.
            let is_full = |length: f64| length > rank::BEYOND_DOUBT * stated.metres;
            if is_full(everywhere) && (known == reach || is_full(change(known))) {
                certain = known;
            } else {
                while let Some(shorter) = walked.shorter(reach, everywhere / stated.metres) {
                    reach = shorter;
                    everywhere = change(reach);
                }
                certain = reach;
            }
        }
        let is_asked = self.question.tolerance().is_some() && is_led && everywhere > self.here;
        let at_least = if is_asked {
            everywhere.min(self.least * self.change(&poses(certain), 1.0, Start::AsData))
        } else {
            everywhere
        };
        Nearness {
            here: self.here,
            everywhere,
            at_least,
            is_walked: walked.is_complete(reach),
            by_angles: self.by_angles,
        }
    }

    /// Returns the equations that must be satisfied at the configuration of the scratch. A path on
    /// the rows `held` leads to this configuration.
    fn at(&self, s: &Scratch, held: &[usize], way: &[&Step]) -> Vec<PoseEquation> {
        let question = self.question;
        // All equations use the scaling of the first configuration. Therefore they have the same
        // unit.
        let scaled = self.scaling.apply(&question.dimensionless(s));
        let candidate = Candidate::of_rows(&scaled, self.kept.clone());
        let matrices = (&scaled, &self.dimensions, &self.scaling);
        let pose = Pose::held(
            question.mechanism,
            s,
            question.places,
            matrices,
            candidate,
            held,
        );
        let is_first = std::ptr::eq(s, question.s);
        let noise = if is_first { rounding(&scaled) } else { WALKED };
        let mut asked = self.asked(&pose, way, noise);
        // Rows that are kept but not in `held` may be violated at other configurations. At these
        // configurations, only the rank is examined. The rank is not larger if these rows are
        // satisfied.
        if is_first || held == self.kept {
            asked.extend(self.misfits(&pose, noise));
        }
        asked
    }

    /// Returns the equations for the entries. With nonholonomic rows, the configuration depends on
    /// the data along the path and on the start. The start has the uncertainty of the data.
    fn asked(&self, pose: &Pose<'_>, way: &[&Step], noise: f64) -> Vec<PoseEquation> {
        let question = self.question;
        let (blocks, known) = (&self.blocks[..], &self.known[..]);
        let of_pair = |at: (usize, usize)| {
            let (target, mut gradient) = pose.entry(at.0, at.1);
            let Gradient { data, pose, .. } = &mut gradient;
            for step in way {
                step.carry_back(question.mechanism, pose, data);
            }
            PoseEquation {
                equation: equation(target, &gradient.data, (blocks, known), noise),
                unit: 1.0,
                by_start: question.by_place(&gradient.pose, self.least, self.by_angles),
            }
        };
        pairs(pose).map(of_pair).collect()
    }

    /// Returns the equations for residuals, because rows that depend on each other must also be
    /// consistent. Equations of lengths are divided by the size.
    fn misfits(&self, pose: &Pose<'_>, noise: f64) -> Vec<PoseEquation> {
        let question = self.question;
        let (blocks, known) = (&self.blocks[..], &self.known[..]);
        let noise = noise * question.size;
        let of_row = |a: usize| {
            let (target, gradient) = pose.misfit(a)?;
            Some(PoseEquation {
                equation: equation(target, &gradient, (blocks, known), noise),
                unit: question.size,
                by_start: vec![[0.0; 3]; 2 * question.s.bodies.len()],
            })
        };
        (0..pose.left.nrows().min(PAIRS))
            .filter_map(of_row)
            .collect()
    }

    /// Returns the necessary change of the data as a fraction of `least`. Second-order terms of
    /// changes up to `share` times `least` are unknown.
    fn change(&self, poses: &[&[PoseEquation]], share: f64, start: Start) -> f64 {
        let curved = CURVED * (self.least / self.question.size).powi(2) * share.min(1.0);
        let equations = poses.iter().copied().flatten();
        let equations: Vec<Equation> = equations.map(|asked| asked.loose(curved, start)).collect();
        least_change(&equations).middle()
    }
}

/// Uncertainty of the configuration at which a continuation begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    Known,
    /// The uncertainty of the data.
    AsData,
}

/// An equation that must be satisfied at a configuration.
struct PoseEquation {
    equation: Equation,
    /// Unit of the equation (m, or 1 for an entry).
    unit: f64,
    /// Coefficients of changes of the body positions at the start.
    by_start: Vec<[f64; 3]>,
}

impl PoseEquation {
    /// Returns the equation with an unknown that represents the second-order terms of a change.
    fn loose(&self, curved: f64, start: Start) -> Equation {
        let mut equation = self.equation.clone();
        equation.rounding = equation.rounding.max(curved * self.unit);
        if start == Start::AsData {
            equation.parts.extend(&self.by_start);
        }
        equation
    }
}
