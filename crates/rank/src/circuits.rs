//! Circuits: minimal sets of rows that depend on each other. Circuits are the smallest sets of rows
//! that cause a redundancy.
//!
//! Redundancy is a property of circuits, not of single rows. The p fundamental circuits (one for
//! each dropped row) depend on which rows were dropped and may be long. Every circuit is the
//! support of a vector `Z·y` that vanishes on a hyperplane of the dual. Therefore all circuits can
//! be computed from the hyperplanes. Short circuits describe the same dependencies with fewer rows.

use crate::limits::{HYPERPLANES_MAX, PIVOT_MIN};
use std::cmp::Ordering;

use crate::decision::Size;
use crate::dual::{Dual, binomial, eliminate, rank, subsets};
use crate::null_space::Support;
use crate::{RankDecision, components};
use linalg::{kernels, powers::scale};

/// One minimal dependent set of rows: `Σ coefficients[l] · row rows[l] = 0`.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Circuit {
    /// Rows with a non-zero coefficient, ascending.
    pub rows: Vec<usize>,
    /// Coefficients for the rows of C as given. The first of the largest coefficients is normalised
    /// to +1.
    pub coefficients: Vec<f64>,
    /// Some coefficients count as zero only because data within their stated tolerances could make
    /// them zero. This value is the largest of these coefficients, for equilibrated rows and
    /// divided by the largest coefficient of the circuit. The value is zero if there is no such
    /// coefficient.
    pub left_out: f64,
}

/// Returns the fundamental circuit of each dropped row, in the order of `dropped`.
///
/// To decide which rows belong to a circuit, the equilibrated coefficients are divided by the
/// largest coefficient and compared with the noise of their rows ([`RankDecision::row_noise`]). A
/// row with margin zero belongs to no circuit. A row of zeros is a circuit of one row.
#[must_use]
pub fn circuits(decision: &RankDecision) -> Vec<Circuit> {
    fundamental(decision)
        .iter()
        .map(|z| circuit(decision, z))
        .collect()
}

/// Returns p independent circuits that are as short as possible. The first circuit is the shortest
/// of all circuits. Each further circuit is the shortest that is independent of the previous
/// circuits. This choice minimises the total length. The circuits are sorted by length, then by
/// rows. The circuits do not depend on the dropped rows.
///
/// A component (a set of coupled rows) of redundancy p_c has at most as many circuits as subsets of
/// p_c − 1 of its rows. The function returns the fundamental circuits of the component in two
/// cases: if there are more than 20 000 such subsets, or if rounding hides which circuits a row
/// belongs to. Fundamental circuits are also minimal and independent, but may be longer.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{decide_dropping, short_circuits};
/// // Rows 2 and 3 are equal; each is the sum of rows 0 and 1.
/// let c = Matrix::from_rows(&[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 1.0]]);
/// let decision = decide_dropping(&c, pfaff_rank::Accuracy::Rounding, &[2, 3]).unwrap();
/// let rows: Vec<_> = short_circuits(&decision).into_iter().map(|c| c.rows).collect();
/// assert_eq!(rows, [vec![2, 3], vec![0, 1, 2]]);
/// ```
#[must_use]
pub fn short_circuits(decision: &RankDecision) -> Vec<Circuit> {
    let support = Support::new(decision);
    let fundamental = fundamental(decision);
    let mut found: Vec<Sparse> = Vec::with_capacity(decision.redundancy);
    for rows in components(decision).coupled {
        let dual = Dual::new(decision, &support, &rows);
        // A component with one dropped row has one circuit. The rows of this circuit have already
        // been decided.
        let shortest = (dual.dimension() > 1).then(|| shortest(&dual)).flatten();
        // Each row of a component belongs to at least one of its circuits. Otherwise noise has
        // hidden the row.
        let shortest = shortest.filter(|circuits| covers(circuits, &rows));
        match shortest {
            Some(circuits) => found.extend(circuits),
            None => found.extend(
                fundamental
                    .iter()
                    .filter(|z| rows.binary_search(&z[0].0).is_ok())
                    .cloned(),
            ),
        }
    }
    found.sort_by(by_length);
    found.iter().map(|z| circuit(decision, z)).collect()
}

/// Equilibrated coefficients by row, without zeros.
type Sparse = Vec<(usize, f64)>;

fn by_length(a: &Sparse, b: &Sparse) -> Ordering {
    let rows = |z: &Sparse| z.iter().map(|t| t.0).collect::<Vec<_>>();
    a.len().cmp(&b.len()).then_with(|| rows(a).cmp(&rows(b)))
}

/// Returns whether each of these rows belongs to one of the circuits.
fn covers(circuits: &[Sparse], rows: &[usize]) -> bool {
    let is_in = |row: usize| circuits.iter().flatten().any(|&(other, _)| other == row);
    rows.iter().all(|&row| is_in(row))
}

/// Returns the shortest independent circuits of one component by a greedy search, which is optimal
/// in a matroid. Returns `None` if there are too many circuits, or if noise hides them.
fn shortest(dual: &Dual) -> Option<Vec<Sparse>> {
    let p = dual.dimension();
    let classes = dual.parallel_classes().ok()?;
    if binomial(classes.len(), p - 1)? > HYPERPLANES_MAX {
        return None;
    }
    let mut all: Vec<(Sparse, Vec<f64>)> = subsets(classes.len(), p - 1)
        .filter_map(|chosen| {
            let vectors = chosen.iter().map(|&k| &dual.vectors[classes[k][0]]);
            vanishing_on(vectors.cloned().collect(), p, dual)
        })
        .collect();
    all.sort_by(|a, b| by_length(&a.0, &b.0));
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut circuits = Vec::new();
    for (circuit, y) in all {
        let mut larger = basis.clone();
        larger.push(y);
        if rank(larger.clone(), dual.noise) == Ok(larger.len()) {
            basis = larger;
            circuits.push(circuit);
        }
        if circuits.len() == p {
            return Some(circuits);
        }
    }
    None
}

/// Returns the circuit `Z̃·y` that vanishes on p − 1 independent vectors, together with y. Returns
/// `None` if the vectors are dependent, or if they are too noisy to decide which other rows belong
/// to the circuit.
fn vanishing_on(vectors: Vec<Vec<f64>>, p: usize, dual: &Dual) -> Option<(Sparse, Vec<f64>)> {
    let hyperplane = eliminate(vectors, dual.noise).ok()?;
    if hyperplane.pivots.len() != p - 1 || hyperplane.smallest < PIVOT_MIN {
        return None;
    }
    let free = (0..p).find(|c| !hyperplane.pivots.contains(c))?;
    let mut y = vec![0.0; p];
    y[free] = 1.0;
    for (vector, &pivot) in hyperplane.vectors.iter().zip(&hyperplane.pivots).rev() {
        let sum: f64 = vector.iter().zip(&y).map(|(v, y)| v * y).sum();
        y[pivot] = -sum / vector[pivot];
    }
    let largest = kernels::max_abs(&y);
    y.iter_mut().for_each(|y| *y /= largest);
    // An error of the vectors changes y by that error divided by the smallest pivot.
    let growth = p as f64 * (1.0 + hyperplane.smallest.recip());
    let noise = dual.noise.times(growth);
    let mut circuit = Sparse::new();
    for (&row, vector) in dual.rows.iter().zip(&dual.vectors) {
        let z = kernels::dot(vector, &y);
        match noise.size(z) {
            Size::Zero => {}
            Size::Unclear => return None,
            Size::NonZero => circuit.push((row, z)),
        }
    }
    Some((circuit, y))
}

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

/// Returns the largest coefficient of the dependency that counts as zero although it is larger than
/// rounding. The value is relative to the largest of all coefficients.
fn left_out(decision: &RankDecision, z: &Sparse) -> f64 {
    if !decision.has_tolerance() {
        return 0.0;
    }
    let of = |row: usize| {
        let at = z.binary_search_by_key(&row, |&(row, _)| row);
        at.map_or(0.0, |k| z[k].1)
    };
    let mut left = vec![0.0; decision.rank];
    for (j, &row) in decision.dropped.iter().enumerate() {
        kernels::axpy(of(row), decision.coefficients.row(j), &mut left);
    }
    let largest = z.iter().fold(0.0_f64, |a, (_, z)| a.max(z.abs()));
    let kept = decision.kept.iter().zip(&left);
    let left = kept.filter(|(row, _)| of(**row) == 0.0);
    let left = left.map(|(row, x)| (row, x.abs() / largest));
    let left = left.filter(|(row, x)| *x > decision.row_rounding(**row));
    left.fold(0.0, |most, (_, x)| f64::max(most, x))
}

/// Returns the equilibrated coefficients in the scaling of C, normalised.
fn circuit(decision: &RankDecision, z: &Sparse) -> Circuit {
    let exponents = &decision.scaling.rows;
    // z̃ᵀ·D_r·C·D_c = 0: the coefficient of row i of C is z̃_i·2^rows[i]. Exponents relative to the
    // exponent of one of the rows keep the coefficients in range.
    let reference = z.last().map_or(0, |&(row, _)| exponents[row]);
    let scaled: Vec<f64> = z
        .iter()
        .map(|&(row, z)| scale(z, exponents[row] - reference))
        .collect();
    let largest = scaled
        .iter()
        .fold(0.0_f64, |a, &b| if b.abs() > a.abs() { b } else { a });
    Circuit {
        left_out: left_out(decision, z),
        rows: z.iter().map(|&(row, _)| row).collect(),
        coefficients: scaled.iter().map(|z| z / largest).collect(),
    }
}

#[cfg(test)]
mod tests;
