//! Compares answers for drawings with 3 … 16 significant digits with exact arithmetic. These are
//! cases of the campaign in [`crate::fuzz::exact::rounded`].
//!
//! The singular values of the dimensionless rows bound the distance of the drawing from a lower
//! rank and from other verdicts. A change of the matrix by δ does not change the rank if δ < σ_r,
//! and rotates its null space by at most δ/σ_r (Wedin 1972, doi 10.1007/BF01932678).

use linalg::{Matrix, small_svd};
use model::space::norm;

use super::drawing::Drawing;
use super::text::{Precision, text_within};
use super::vector::Vector;
use crate::fuzz::exact::answer::answer;
use crate::fuzz::exact::distance::{BEYOND_DOUBT, Distance, Left};
use crate::fuzz::exact::examine::{self, ranks_and_reactions, reactions};
use crate::fuzz::exact::expected::{Elsewhere, Expected, Verdict};
use crate::fuzz::exact::outcome::{JudgedStart, Outcome, judged};
use crate::fuzz::exact::precisions::DIGITS;
use crate::fuzz::exact::truth::Truth;
use crate::fuzz::exact::wrench::Wrench;

/// Largest change of a row, as a multiple of the tolerance: on each of two bodies, both ends of a
/// lever arm or a direction may change.
const CHANGES: f64 = 4.0;

/// Returns the results for one drawing with each number of digits. The drawing is translated by up
/// to its size.
#[must_use]
pub fn outcomes(seed: u64, drawn: u64) -> Vec<Outcome> {
    // The third variant.
    let scene = super::scene(seed, 4 * drawn + 2);
    let meant = Meant::of(&scene.drawing);
    let one = |(way, &digits): (usize, &usize)| {
        let mut precision = Precision::of_digits(&scene.drawing, digits);
        if digits == DIGITS[DIGITS.len() - 1] {
            precision.tolerance = None;
        }
        let known = precision.tolerance.map_or(0.0, |t| meant.known(t));
        let text = text_within(&scene.drawing, &precision);
        let judged = judged(
            || answer(&text),
            |document| meant.judge(document, precision.tolerance),
        );
        Outcome {
            family: scene.family.name(),
            way,
            text,
            truth: format!(
                "{}\nσ_r {:.2e}, C accurate to {known:.1e}, {}",
                meant.right.describe(),
                meant.sigma,
                meant.right.elsewhere.words()
            ),
            judged,
            must_be_decided: meant.distance(known).is_far(),
            is_redundant: meant.right.redundancy > 0,
        }
    };
    DIGITS.iter().enumerate().map(one).collect()
}

/// The correct results for a drawing, with the distance of the drawing from other results.
pub struct Meant {
    truth: Truth,
    right: Expected,
    /// Size of the drawing (m).
    size: f64,
    /// The smallest nonzero singular value, for rows of norm one.
    sigma: f64,
    margins: Margins,
}

impl Meant {
    /// Computes the correct results, from exact arithmetic.
    #[must_use]
    pub fn of(drawing: &Drawing) -> Self {
        let (truth, right) = drawing.right();
        let size = size(drawing);
        let margins = Margins::of(&truth, drawing, size);
        Self {
            truth,
            right,
            size,
            sigma: margins.sigma,
            margins,
        }
    }

    /// Returns the accuracy of C that follows from data with this tolerance (m).
    fn known(&self, tolerance: f64) -> f64 {
        CHANGES * (self.truth.rows.len() as f64).sqrt() * tolerance / self.size
    }

    fn distance(&self, known: f64) -> Distance {
        Distance {
            tolerance: known,
            to_lower_rank: self.sigma,
            is_permanent: self.right.elsewhere == Elsewhere::Same,
        }
    }

    /// Compares a document with the correct results. `tolerance` is the tolerance (m) that the
    /// scene states, if any.
    #[must_use]
    pub fn judge(&self, document: &serde_json::Value, tolerance: Option<f64>) -> JudgedStart {
        let mut judged = JudgedStart::default();
        let Some(tolerance) = tolerance else {
            ranks_and_reactions(&self.truth, &self.right, document, &mut judged.findings);
            return judged;
        };
        let (known, rank) = (self.known(tolerance), self.truth.rank());
        match self.distance(known).judge(rank, document, &mut judged) {
            Left::Nothing => {}
            Left::NoVerdict => {
                if self.right.elsewhere == Elsewhere::Same {
                    let right = self.right.clone().with(Elsewhere::NotHigher);
                    examine::elsewhere(&right, document, &mut judged.findings);
                }
            }
            Left::Verdicts => {
                let right = self.open(known / self.sigma);
                let rounding = self.truth.rounding.max(BEYOND_DOUBT * known / self.sigma);
                reactions(&right, rounding, document, &mut judged.findings);
                examine::elsewhere(&right, document, &mut judged.findings);
            }
        }
        judged
    }

    /// Returns the results of exact arithmetic; results that may be different for data within a
    /// tolerance are open. The data rotate the null space by at most the angle `turned`.
    fn open(&self, turned: f64) -> Expected {
        let (truth, margins) = (&self.truth, &self.margins);
        let mut right = self.right.clone();
        let opened = |verdict: &mut Verdict, combination: &[(usize, f64)]| {
            if *verdict == Verdict::NotUnique && margins.margin(combination) <= turned {
                *verdict = Verdict::Open;
            }
        };
        for reaction in &mut right.reactions {
            let own = reaction.own_rows();
            for (i, _, verdict) in &mut reaction.rows {
                opened(verdict, &[(*i, 1.0)]);
            }
            let is_open = reaction.rows.iter().any(|(.., v)| *v == Verdict::Open);
            let place = &truth.element(reaction.owner).place;
            let (Some(wrench), Some(place)) = (&mut reaction.wrench, place) else {
                continue;
            };
            let part = |i: usize| {
                let [_, (_, load)] = &truth.rows[i].loads[..] else {
                    return [0.0; 6];
                };
                about(load, place, self.size).map(|x| x * margins.factors[i])
            };
            let parts: Vec<[f64; 6]> = own.iter().map(|&i| part(i)).collect();
            let combination = |k: usize| -> Vec<(usize, f64)> {
                let own = own.iter().zip(&parts);
                own.map(|(i, part)| (*i, part[k])).collect()
            };
            for (k, (_, verdict)) in wrench.components.iter_mut().enumerate() {
                opened(verdict, &combination(k));
            }
            let images: Vec<Vec<f64>> = (0..6).map(|k| margins.free(&combination(k))).collect();
            let images = Matrix::from_fn(6, truth.rows.len(), |k, i| images[k][i]);
            let smallest = reaction.free.checked_sub(1);
            let smallest = smallest.map(|k| small_svd(&images).sigma[k]);
            wrench.is_open = is_open
                || wrench.components.iter().any(|(_, v)| *v == Verdict::Open)
                || smallest.is_some_and(|sigma| sigma <= turned);
            let is_firm = wrench
                .components
                .iter()
                .any(|(_, v)| *v == Verdict::NotUnique);
            if !is_firm && reaction.is_unique == Verdict::NotUnique {
                reaction.is_unique = Verdict::Open;
            }
        }
        right
    }
}

/// Returns the largest distance between the reference point of the first joint and the reference
/// point of another joint (m), at least 0.1.
fn size(drawing: &Drawing) -> f64 {
    let mut places = drawing.joints.iter().filter_map(|j| j.kind.place());
    let Some(first) = places.next() else {
        return 1.0;
    };
    let distances = places.map(|p| (p - first).square().root());
    distances.fold(0.1, f64::max)
}

/// Computes the distance of combinations of multipliers from unique combinations.
struct Margins {
    sigma: f64,
    /// Orthonormal combinations of rows that span the range of C, as columns.
    range: Matrix,
    /// The factors that scale the rows to norm one.
    factors: Vec<f64>,
}

impl Margins {
    fn of(truth: &Truth, drawing: &Drawing, size: f64) -> Self {
        let rows = truth.rows.iter();
        let factors: Vec<f64> = rows.map(|row| factor(&row.loads[0].1, size)).collect();
        let mut c = Matrix::zeros(truth.rows.len(), 6 * drawing.bodies.len());
        for (i, row) in truth.rows.iter().enumerate() {
            for (side, load) in &row.loads {
                let Some(body) = *side else { continue };
                let wrench = about(load, &drawing.bodies[body].position, size);
                for (k, x) in wrench.into_iter().enumerate() {
                    c[(i, 6 * body + k)] += factors[i] * x;
                }
            }
        }
        let rank = truth.rank();
        let svd = small_svd(&c);
        Self {
            sigma: rank.checked_sub(1).map_or(1.0, |k| svd.sigma[k]),
            range: Matrix::from_fn(c.nrows(), rank, |i, k| svd.u[(i, k)]),
            factors,
        }
    }

    /// Returns the norm of the part of a combination of multipliers in the null space, for rows of
    /// norm one.
    fn margin(&self, combination: &[(usize, f64)]) -> f64 {
        norm(&self.free(combination))
    }

    /// Returns the part of a combination of multipliers in the null space.
    fn free(&self, combination: &[(usize, f64)]) -> Vec<f64> {
        let mut left = vec![0.0; self.range.nrows()];
        for (i, x) in combination {
            left[*i] = *x;
        }
        for k in 0..self.range.ncols() {
            let share: f64 = combination
                .iter()
                .map(|(i, x)| self.range[(*i, k)] * x)
                .sum();
            for (i, left) in left.iter_mut().enumerate() {
                *left -= share * self.range[(i, k)];
            }
        }
        left
    }
}

/// Returns the wrench about a point, with moments divided by the size.
fn about(wrench: &Wrench, point: &Vector, size: f64) -> [f64; 6] {
    let moment = &wrench.moment - &point.cross(&wrench.force);
    let rounded = |v: &Vector| v.0.each_ref().map(super::ratio::Ratio::rounded);
    let ([x, y, z], [a, b, c]) = (rounded(&wrench.force), rounded(&moment));
    [x, y, z, a / size, b / size, c / size]
}

/// Returns the factor that scales a wrench so that its force, or its couple divided by `size`, has
/// the magnitude one.
fn factor(wrench: &Wrench, size: f64) -> f64 {
    match wrench.length() {
        0.0 => 1.0,
        length if wrench.force.is_zero() => size / length,
        length => length.recip(),
    }
}
