//! By how many metres the data would have to be wrong for a lower rank, at one pose and at all
//! poses of a walk, and the least rank that data within a stated tolerance have.
//!
//! Rows that nearly depend on others at a pose are left out together, so that the mechanism walks
//! away from the pose on rows that are independent beyond doubt. Where it comes to it shows which
//! of them are independent in general: those are kept again, one rank after the other.

use crate::limits::{CLEAR_ENTRY, CURVED, PAIRS, WALKED};
use linalg::{Matrix, PivotedQr, Scaling};
use model::{DataBlock, Scratch, System};

use super::cone::{Equation, least_change};
use super::follow::Step;
use super::pose::{Candidate, Gradient, Pose, most_independent_of};
use super::share::{Question, StatedTolerance, equation, pairs, rounding};
use super::walk::{Walk, walk};

/// What the data would have to be wrong by (m; angles times the size) for one rank less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearness {
    /// At this pose alone.
    pub(crate) here: f64,
    /// By one change of the data that serves all poses of a walk: from there on a row is redundant.
    /// Infinite where none does.
    pub(crate) everywhere: f64,
    /// No change below this does, where nonholonomic rows lead: they hold no position, so that
    /// other poses are reached from a start that is known to the same change only.
    /// [`everywhere`](Self::everywhere) otherwise.
    pub(crate) at_least: f64,
    /// Whether the walk found the poses that it takes to tell a redundancy from a singular pose.
    pub(crate) is_walked: bool,
    /// Whether only angles change, because a tolerance is stated for them alone.
    pub(crate) by_angles: bool,
}

/// The least rank that data within a tolerance have.
pub(super) struct LeastRank {
    pub(super) rank: usize,
    /// How near the data are to it, or to one rank less where it stays.
    pub(super) nearness: Option<Nearness>,
    pub(super) certainty: Certainty,
}

/// Whether a rank is one less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Certainty {
    /// It is not.
    Decided,
    /// From a change of this length on (m), which is near the tolerance.
    From(f64),
    /// Nothing is known of other poses.
    OtherPoses,
}

/// A lower rank, asked for at a pose.
struct Lower<'q> {
    question: &'q Question<'q>,
    blocks: Vec<DataBlock>,
    /// C in one unit, with its factors.
    scaled: Matrix,
    scaling: Scaling,
    dimensions: Scaling,
    /// Rows that would be left, of those that are judged.
    kept: Vec<usize>,
    /// Changes are shares of this length (m), for each block of this change.
    least: f64,
    known: Vec<f64>,
    by_angles: bool,
    /// The change that one rank less takes at this pose alone (m).
    here: f64,
}

impl Question<'_> {
    /// How near the data are to one rank less than `rank`, if that is nearer than `limit` (m).
    pub(super) fn nearness(&self, rank: usize, limit: f64) -> Option<Nearness> {
        let lower = self.lower(rank.checked_sub(1)?, limit)?;
        Some(lower.near(&lower.walked(), &lower.kept))
    }

    /// The least rank up to `rank` of data within the tolerance, and how near they are to it, if
    /// that is nearer than `limit` (m).
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
            // Rows that are kept again may be singular here, and leave no way.
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

    /// Rows that are not kept, those first that are most independent of the kept ones where the
    /// walk leads.
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

    /// The rank `lower` on the rows that are most independent at this pose. `None` if it is farther
    /// than `limit` (m).
    fn lower(&self, lower: usize, limit: f64) -> Option<Lower<'_>> {
        let (scaled, _) = self.uniform(self.s);
        let order = PivotedQr::of_rows(scaled);
        self.lower_of(order.permutation()[..lower].to_vec(), limit)
    }

    /// The rank of these rows.
    fn lower_of(&self, kept: Vec<usize>, limit: f64) -> Option<Lower<'_>> {
        let stated = self.tolerance();
        let tolerance = stated.map(|stated| stated.metres);
        let (scaled, scaling) = self.uniform(self.s);
        let candidate = Candidate::of_rows(&scaled, kept);
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
        // Without a datum that changes it, it stays.
        if least.is_nan() || least > limit {
            return None;
        }
        // Shares of what one entry alone would need, so that rounding is no obstacle.
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
        lower.here = least * lower.change(&[asked], 1.0, Start::Known);
        (lower.here <= limit).then_some(lower)
    }
}

impl Lower<'_> {
    fn rows(&self, kept: &[usize]) -> Vec<usize> {
        kept.iter().map(|&k| self.question.places[k]).collect()
    }

    /// The walk on the rows that would be left.
    fn walked(&self) -> Walk {
        walk(self.question, &self.rows(&self.kept))
    }

    /// How near the data are, at poses that the rows `held` hold.
    fn near(&self, walked: &Walk, held: &[usize]) -> Nearness {
        let m = self.question.mechanism.layout().m;
        let is_led = self.rows(held).iter().any(|&row| row >= m);
        let mut poses = vec![self.at(self.question.s, held, &[])];
        for (q, way) in walked.poses() {
            let s = crate::pose::evaluated(self.question.mechanism, self.question.s.t, q);
            poses.push(self.at(&s, held, &way.collect::<Vec<_>>()));
        }
        let share = self.change(&poses, 1.0, Start::Known);
        let everywhere = self.least * self.change(&poses, share, Start::Known);
        let is_asked = self.question.tolerance().is_some() && is_led && everywhere > self.here;
        let at_least = if is_asked {
            everywhere.min(self.least * self.change(&poses, 1.0, Start::AsData))
        } else {
            everywhere
        };
        Nearness {
            here: self.here,
            everywhere,
            at_least,
            is_walked: walked.is_complete,
            by_angles: self.by_angles,
        }
    }

    /// What has to vanish at the pose of the scratch, where a way has led on the rows `held`.
    fn at(&self, s: &Scratch, held: &[usize], way: &[&Step]) -> Vec<Asked> {
        let question = self.question;
        // The scaling is that of the first pose: the equations have one unit.
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
        // Rows that are kept but not held say nothing of poses where they miss: there the rank
        // counts, which is nowhere larger where they hold, too.
        if is_first || held == self.kept {
            asked.extend(self.misfits(&pose, noise));
        }
        asked
    }

    /// Equations of lengths are those of entries, times the size. What nonholonomic rows lead
    /// follows the data along the way, from the start on, which is known as the data are.
    fn asked(&self, pose: &Pose<'_>, way: &[&Step], noise: f64) -> Vec<Asked> {
        let question = self.question;
        let (blocks, known) = (&self.blocks[..], &self.known[..]);
        let of_pair = |at: (usize, usize)| {
            let (target, mut gradient) = pose.entry(at.0, at.1);
            let Gradient { data, pose, .. } = &mut gradient;
            for step in way {
                step.carry_back(question.mechanism, pose, data);
            }
            Asked {
                equation: equation(target, &gradient.data, (blocks, known), noise),
                unit: 1.0,
                by_start: question.by_place(&gradient.pose, self.least, self.by_angles),
            }
        };
        pairs(pose).map(of_pair).collect()
    }

    /// What depends on each other must hold together, too.
    fn misfits(&self, pose: &Pose<'_>, noise: f64) -> Vec<Asked> {
        let question = self.question;
        let (blocks, known) = (&self.blocks[..], &self.known[..]);
        let noise = noise * question.size;
        let of_row = |a: usize| {
            let (target, gradient) = pose.misfit(a)?;
            Some(Asked {
                equation: equation(target, &gradient, (blocks, known), noise),
                unit: question.size,
                by_start: vec![[0.0; 2]; 2 * question.s.poses.len()],
            })
        };
        (0..pose.left.nrows().min(PAIRS))
            .filter_map(of_row)
            .collect()
    }

    /// The share of `least` by which the data have to change, where the second order of a change by
    /// at most `share` of it is left open.
    fn change(&self, poses: &[Vec<Asked>], share: f64, start: Start) -> f64 {
        let curved = CURVED * (self.least / self.question.size).powi(2) * share.min(1.0);
        let equations = poses.iter().flatten();
        let equations: Vec<Equation> = equations.map(|asked| asked.loose(curved, start)).collect();
        least_change(&equations).middle()
    }
}

/// Whether the pose where a walk begins is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    Known,
    /// To the change of the data.
    AsData,
}

/// What has to vanish at a pose.
struct Asked {
    equation: Equation,
    /// Unit of the equation (m, or one for an entry).
    unit: f64,
    /// Changes by where the bodies are at the start.
    by_start: Vec<[f64; 2]>,
}

impl Asked {
    /// The equation with the second order of a change left open.
    fn loose(&self, curved: f64, start: Start) -> Equation {
        let mut equation = self.equation.clone();
        equation.rounding = equation.rounding.max(curved * self.unit);
        if start == Start::AsData {
            equation.parts.extend(&self.by_start);
        }
        equation
    }
}
