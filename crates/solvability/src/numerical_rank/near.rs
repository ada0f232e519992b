//! The error of the data (m) that is necessary for a lower rank, at one pose and at all poses of a
//! walk; and the least rank of data within a stated tolerance.
//!
//! Rows that nearly depend on others at a pose are dropped together, so that the mechanism moves
//! away from the pose on rows that are certainly independent. The poses reached show which of the
//! dropped rows are independent in general: these are kept again, one rank after the other.

use crate::limits::{CLEAR_ENTRY, CURVED, PAIRS, WALKED};
use linalg::{Matrix, Scaling};
use model::{DataBlock, Scratch, System};

use super::cone::{Equation, least_change};
use super::follow::Step;
use super::pose::{Candidate, Gradient, Pose, most_independent_of};
use super::share::{Question, StatedTolerance, equation, pairs, rounding};
use super::walk::{Walk, walk};

/// The error of the data that is necessary for a rank that is lower by one (m; angles times the
/// size).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearness {
    /// At this pose only.
    pub(crate) here: f64,
    /// For one change of the data at all poses of a walk: from this change on, a row is redundant.
    /// Infinite if no change makes it redundant.
    pub(crate) everywhere: f64,
    /// A lower bound on that change if nonholonomic rows are kept: they constrain no position, so
    /// other poses are reached from a start that has the same uncertainty as the data. Equal to
    /// [`everywhere`](Self::everywhere) otherwise.
    pub(crate) at_least: f64,
    /// Whether the walk found enough poses to distinguish a redundancy from a singular pose.
    pub(crate) is_walked: bool,
    /// Whether only angles change, because a tolerance is stated for them alone.
    pub(crate) by_angles: bool,
}

/// The least rank of data within a tolerance.
pub(super) struct LeastRank {
    pub(super) rank: usize,
    /// Distance of the data from this rank, or from one rank less if the rank does not drop.
    pub(super) nearness: Option<Nearness>,
    pub(super) certainty: Certainty,
}

/// Whether the rank is one less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Certainty {
    /// Decided.
    Decided,
    /// Undecided: the rank is one less from a change of this length on (m), which is close to the
    /// tolerance.
    From(f64),
    /// Undecided: other poses could not be examined.
    OtherPoses,
}

/// A lower rank, examined at a pose.
struct Lower<'q> {
    question: &'q Question<'q>,
    blocks: Vec<DataBlock>,
    /// C with one unit for all lengths, with its factors.
    scaled: Matrix,
    scaling: Scaling,
    dimensions: Scaling,
    /// Rows that would be kept, numbered among the analysed rows.
    kept: Vec<usize>,
    /// Unit of changes (m), and the corresponding change of each block.
    least: f64,
    known: Vec<f64>,
    by_angles: bool,
    /// The change that lowers the rank by one at this pose only (m).
    here: f64,
}

impl Question<'_> {
    /// The distance of the data from one rank less than `rank`, if it is at most `limit` (m).
    pub(super) fn nearness(&self, rank: usize, limit: f64) -> Option<Nearness> {
        let lower = self.lower(rank.checked_sub(1)?, limit)?;
        Some(lower.near(&lower.walked(), &lower.kept))
    }

    /// The least rank up to `rank` of data within the tolerance, and their distance from it if that
    /// is at most `limit` (m).
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
            // Rows that are kept again may be singular at this pose, so that no motion is possible.
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

    /// The dropped rows, beginning with those that are most independent of the kept ones at the
    /// last pose of the walk.
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

    /// Examines the rank `lower` on the rows that are most independent at this pose. Returns `None`
    /// if its distance is above `limit` (m).
    fn lower(&self, lower: usize, limit: f64) -> Option<Lower<'_>> {
        let (scaled, scaling) = self.uniform(self.s);
        let candidate = Candidate::of_rank(&scaled, lower);
        self.examined(scaled, scaling, candidate, limit)
    }

    /// Examines the rank with only these rows kept.
    fn lower_of(&self, kept: Vec<usize>, limit: f64) -> Option<Lower<'_>> {
        let (scaled, scaling) = self.uniform(self.s);
        let candidate = Candidate::of_rows(&scaled, kept);
        self.examined(scaled, scaling, candidate, limit)
    }

    /// Examines the rank of a candidate for C with one unit for all lengths.
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
        // The rank stays if no datum changes it.
        if least.is_nan() || least > limit {
            return None;
        }
        // Relative to what a single entry would need, so that rounding does not interfere.
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

    /// The walk on the rows that would be kept.
    fn walked(&self) -> Walk {
        walk(self.question, &self.rows(&self.kept))
    }

    /// The distance of the data, at poses at which the rows `held` are satisfied.
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
            // A full rank rests on poses that the intended mechanism has whatever its data are
            // within the tolerance; a redundancy on poses that it has up to the change of the data
            // that makes a row redundant.
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

    /// The equations that must hold at the pose of the scratch, reached by a path on the rows
    /// `held`.
    fn at(&self, s: &Scratch, held: &[usize], way: &[&Step]) -> Vec<PoseEquation> {
        let question = self.question;
        // Uses the scaling of the first pose, so that all equations have the same unit.
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
        // Rows that are kept but not held may be violated at other poses; there only the rank is
        // examined, which is no larger where they are satisfied.
        if is_first || held == self.kept {
            asked.extend(self.misfits(&pose, noise));
        }
        asked
    }

    /// The equations for the entries. With nonholonomic rows the pose depends on the data along the
    /// path, from the start on, which has the uncertainty of the data.
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

    /// The equations for residuals: rows that depend on each other must also agree. Equations of
    /// lengths are divided by the size.
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

    /// The fraction of `least` by which the data have to change, if the second-order terms of
    /// changes up to `share` of it are left open.
    fn change(&self, poses: &[&[PoseEquation]], share: f64, start: Start) -> f64 {
        let curved = CURVED * (self.least / self.question.size).powi(2) * share.min(1.0);
        let equations = poses.iter().copied().flatten();
        let equations: Vec<Equation> = equations.map(|asked| asked.loose(curved, start)).collect();
        least_change(&equations).middle()
    }
}

/// Uncertainty of the pose at which a walk begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    Known,
    /// The same as that of the data.
    AsData,
}

/// An equation that must hold at a pose.
struct PoseEquation {
    equation: Equation,
    /// Unit of the equation (m, or 1 for an entry).
    unit: f64,
    /// Coefficients of changes of the body positions at the start.
    by_start: Vec<[f64; 3]>,
}

impl PoseEquation {
    /// The equation with the second-order terms of a change left open.
    fn loose(&self, curved: f64, start: Start) -> Equation {
        let mut equation = self.equation.clone();
        equation.rounding = equation.rounding.max(curved * self.unit);
        if start == Start::AsData {
            equation.parts.extend(&self.by_start);
        }
        equation
    }
}
