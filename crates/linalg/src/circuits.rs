//! Circuits: minimal sets of rows that depend on each other, the explanation of a redundancy in its smallest pieces.
//!
//! Redundancy belongs to circuits, never to a row. The p fundamental circuits (one for each dropped row) depend on which rows
//! were dropped and may be long; exchanging them pairwise gives short ones that say the same.

use crate::{RankDecision, equilibrate::scale, null_space::Support};

/// One minimal dependent set of rows: `Σ coefficients[l] · row rows[l] = 0`.
#[derive(Debug, Clone, PartialEq)]
pub struct Circuit {
    /// Rows with a non-zero coefficient, ascending.
    pub rows: Vec<usize>,
    /// Coefficients for the rows of C as given, the first largest of them normalised to +1.
    pub coefficients: Vec<f64>,
}

/// The fundamental circuit of each dropped row, in the order of `dropped`.
///
/// The support is decided on equilibrated coefficients relative to the largest of the circuit, against
/// [`support_tolerance`](crate::support_tolerance). A row of zeros is a circuit by itself.
#[must_use]
pub fn circuits(decision: &RankDecision) -> Vec<Circuit> {
    fundamental(decision)
        .iter()
        .map(|z| circuit(decision, z))
        .collect()
}

/// p independent dependencies as short as pairwise exchange makes them: two that share a row give a third without it, which
/// replaces the first if it is shorter. For p ≤ 2 they are circuits; for more, one of them may still contain a shorter one.
///
/// ```
/// use linalg::{Matrix, decide_dropping, short_circuits};
/// // Rows 2 and 3 are equal; each is the sum of rows 0 and 1.
/// let c = Matrix::from_rows(&[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 1.0]]);
/// let decision = decide_dropping(&c, 0.0, &[2, 3]).unwrap();
/// let rows: Vec<_> = short_circuits(&decision).into_iter().map(|c| c.rows).collect();
/// assert_eq!(rows, [vec![2, 3], vec![0, 1, 3]]);
/// ```
#[must_use]
pub fn short_circuits(decision: &RankDecision) -> Vec<Circuit> {
    let mut z = fundamental(decision);
    if work(&z) <= EXCHANGE_WORK {
        let noise = crate::support_tolerance(decision);
        while let Some((i, shorter)) = exchange(&z, noise) {
            z[i] = shorter;
        }
    }
    let mut found: Vec<Circuit> = z.iter().map(|z| circuit(decision, z)).collect();
    found.sort_by(|a, b| {
        a.rows
            .len()
            .cmp(&b.rows.len())
            .then_with(|| a.rows.cmp(&b.rows))
    });
    found
}

/// Multiplications that one round of exchanges may cost; above it the fundamental circuits stay.
const EXCHANGE_WORK: usize = 10_000_000;

/// Equilibrated coefficients by row, zeros left out.
type Sparse = Vec<(usize, f64)>;

fn fundamental(decision: &RankDecision) -> Vec<Sparse> {
    let support = Support::new(decision);
    (0..decision.redundancy)
        .map(|j| {
            let mut z: Sparse = (0..decision.rank)
                .filter(|&i| support.contains(j, i))
                .map(|i| (decision.kept[i], -support.t[(j, i)]))
                .chain([(decision.dropped[j], 1.0)])
                .collect();
            z.sort_unstable_by_key(|&(row, _)| row);
            z
        })
        .collect()
}

fn work(z: &[Sparse]) -> usize {
    let longest = z.iter().map(Vec::len).max().unwrap_or(0);
    z.len()
        .saturating_mul(z.len())
        .saturating_mul(longest * longest)
}

/// The first circuit that another one can shorten, with what it becomes.
fn exchange(z: &[Sparse], noise: f64) -> Option<(usize, Sparse)> {
    for i in 0..z.len() {
        for j in (0..z.len()).filter(|&j| j != i) {
            for &(row, a) in &z[i] {
                let Some(&(_, b)) = z[j].iter().find(|t| t.0 == row) else {
                    continue;
                };
                let combined = combine(&z[i], &z[j], -a / b, row, noise);
                if combined.len() < z[i].len() {
                    return Some((i, combined));
                }
            }
        }
    }
    None
}

/// `a + factor·b` without the row that cancels and without what is rounding.
fn combine(a: &Sparse, b: &Sparse, factor: f64, cancelled: usize, noise: f64) -> Sparse {
    let mut sum: Sparse = a.clone();
    for &(row, z) in b {
        match sum.iter_mut().find(|t| t.0 == row) {
            Some(t) => t.1 += factor * z,
            None => sum.push((row, factor * z)),
        }
    }
    let size = |z: &Sparse| z.iter().fold(0.0_f64, |s, t| s.max(t.1.abs()));
    let floor = noise * (size(a) + factor.abs() * size(b));
    sum.retain(|&(row, z)| row != cancelled && z.abs() > floor);
    sum.sort_unstable_by_key(|&(row, _)| row);
    sum
}

/// Equilibrated coefficients in the scaling of C, normalised.
fn circuit(decision: &RankDecision, z: &Sparse) -> Circuit {
    let exponents = &decision.scaling.rows;
    // z̃ᵀ·D_r·C·D_c = 0: the coefficient of row i of C is z̃_i·2^rows[i]. Exponents relative to one of the rows keep the
    // numbers in range.
    let reference = z.last().map_or(0, |&(row, _)| exponents[row]);
    let scaled: Vec<f64> = z
        .iter()
        .map(|&(row, z)| scale(z, exponents[row] - reference))
        .collect();
    let largest = scaled
        .iter()
        .fold(0.0_f64, |a, &b| if b.abs() > a.abs() { b } else { a });
    Circuit {
        rows: z.iter().map(|&(row, _)| row).collect(),
        coefficients: scaled.iter().map(|z| z / largest).collect(),
    }
}
