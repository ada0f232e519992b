//! The left null space of a constraint matrix, derived from a rank decision, and the groups of rows
//! that the null space couples (components). The module `circuits` computes minimal dependent sets.
//!
//! Columns z with `Cᵀ·z = 0` are the self-stresses: if multipliers change by a self-stress, the
//! force on every body does not change. Other modules use the groups of rows for verdicts on joints
//! and reactions.

use crate::limits::COEFFICIENT_ROUNDING;
use crate::{CoefficientReading, RankDecision};
use linalg::{Matrix, PivotedQr, kernels};

/// Partition of the rows by common dependencies.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Components {
    /// Sets of coupled rows. Each list is ascending, and the lists are ordered by their first rows.
    pub coupled: Vec<Vec<usize>>,
    /// Rows that belong to no dependency (coloops), ascending. The multipliers of these rows are
    /// unique.
    pub coloops: Vec<usize>,
}

/// Returns Z (m×p) with `Cᵀ·Z = 0`. Column j is `[−T_jᵀ; e_j]` in the order (K, D), permuted to row
/// order. Column j states that `row dropped[j] = Σ T_ji · row kept[i]`.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{decide, dependencies};
/// let c = Matrix::from_rows(&[[1.0, 0.0], [0.0, 1.0], [0.5, 0.25]]);
/// let z = dependencies(&decide(&c, pfaff_rank::Accuracy::Rounding)?);
/// assert_eq!(z, Matrix::from_rows(&[[-0.5], [-0.25], [1.0]]));
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
pub fn dependencies(decision: &RankDecision) -> Matrix {
    scatter(decision, &decision.dependence())
}

/// Returns an orthonormal basis (m×p) of the left null space of the *equilibrated* rows
/// `D_r·C·D_c`.
///
/// The norm of row i is the margin of the statement "row i is unique". The margin is zero iff the
/// row belongs to no dependency, and one iff the row alone is dependent (a row of zeros). `D_r`
/// times a column is a self-stress of C.
pub fn orthonormal(decision: &RankDecision) -> Matrix {
    let z = scatter(decision, &decision.equilibrated_dependence());
    let p = z.ncols();
    PivotedQr::of_columns(&z).q_columns(0..p)
}

/// Returns the largest equilibrated coefficient that counts as zero:
/// [`RankDecision::coefficient_tolerance`].
pub fn support_tolerance(decision: &RankDecision) -> f64 {
    decision.coefficient_tolerance()
}

/// Returns the connected components of the graph with an edge between kept row i and dropped row j
/// if T_ji ≠ 0.
///
/// These sets are the components of the row matroid. Dependencies couple the rows of one list, but
/// never rows of different lists. The result does not depend on the choice of the kept rows.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{components, decide};
/// let c = Matrix::from_rows(&[[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [3.0, 0.0, 0.0], [1.0, 1.0, 1.0]]);
/// let found = components(&decide(&c, pfaff_rank::Accuracy::Rounding)?);
/// assert_eq!(found.coupled, [[0, 2]]);
/// assert_eq!(found.coloops, [1, 3]);
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
pub fn components(decision: &RankDecision) -> Components {
    components_of(decision, &Support::new(decision))
}

/// Returns rows of components for which a stated tolerance leaves undecided to which dependency, if
/// any, a row belongs. The rows ascend; the list is empty without a tolerance.
pub fn open_rows(decision: &RankDecision) -> Vec<usize> {
    if !decision.has_tolerance() {
        return Vec::new();
    }
    let mut support = Support::new(decision);
    let certificate = decision.evidence.certificate.as_ref();
    let told = certificate.map_or(&[][..], |c| &c.open_rows);
    for (open, row) in support.open.iter_mut().zip(&decision.kept) {
        *open |= told.binary_search(row).is_ok();
    }
    // Rows with an undecided membership belong to every component in which they have a coefficient.
    for (noise, _) in support.noise.iter_mut().zip(&support.open).filter(|x| *x.1) {
        *noise = COEFFICIENT_ROUNDING;
    }
    let is_open = |row: &usize| match decision.kept.binary_search(row) {
        Ok(i) => support.open[i],
        Err(_) => told.binary_search(row).is_ok(),
    };
    let coupled = components_of(decision, &support).coupled.into_iter();
    let mut rows: Vec<usize> = coupled
        .filter(|rows| rows.iter().any(is_open))
        .flatten()
        .collect();
    rows.sort_unstable();
    rows
}

fn components_of(decision: &RankDecision, support: &Support) -> Components {
    let m = decision.rank + decision.redundancy;
    let mut label: Vec<usize> = (0..m).collect();
    let mut coloop = vec![true; m];
    for j in 0..decision.redundancy {
        let row_j = decision.dropped[j];
        coloop[row_j] = false;
        for i in (0..decision.rank).filter(|&i| support.contains(j, i)) {
            let row_i = decision.kept[i];
            coloop[row_i] = false;
            let (a, b) = (root(&label, row_i), root(&label, row_j));
            // The smaller row becomes the root. Therefore the root is the first row of a component.
            label[a.max(b)] = a.min(b);
        }
    }
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); m];
    for row in (0..m).filter(|&row| !coloop[row]) {
        members[root(&label, row)].push(row);
    }
    Components {
        coupled: members
            .into_iter()
            .filter(|rows| !rows.is_empty())
            .collect(),
        coloops: (0..m).filter(|&row| coloop[row]).collect(),
    }
}

/// Decides which equilibrated coefficients count as non-zero. The margin of a row is the norm of
/// its row of [`orthonormal`]. A row belongs to no circuit if its margin counts as zero. Verdicts
/// use the margin, and circuits must be consistent with the verdicts.
pub(crate) struct Support {
    /// Coefficients T of the equilibrated rows.
    pub(crate) t: Matrix,
    /// Largest coefficient for each dropped row, at least one.
    size: Vec<f64>,
    /// Noise of the coefficients of each kept row, relative to the row; infinite if the margin is
    /// zero.
    noise: Vec<f64>,
    /// Whether it is undecided that the margin of a kept row is zero.
    open: Vec<bool>,
}

impl Support {
    pub(crate) fn new(decision: &RankDecision) -> Self {
        let t = decision.equilibrated_dependence();
        let z = orthonormal(decision);
        let noise = |&i: &usize| {
            if decision.is_exact() {
                return (0.0, false);
            }
            let (margin, noise) = (kernels::norm(z.row(i)), decision.row_noise(i));
            match decision.read_coefficient(margin, noise) {
                CoefficientReading::Zero => (f64::INFINITY, false),
                CoefficientReading::NonZero => (decision.largest_zero(noise), false),
                CoefficientReading::Unclear { .. } => (decision.largest_zero(noise), true),
            }
        };
        let (noise, open) = decision.kept.iter().map(noise).unzip();
        let size = (0..t.nrows())
            .map(|j| t.row(j).iter().fold(1.0_f64, |a, b| a.max(b.abs())))
            .collect();
        Self {
            t,
            size,
            noise,
            open,
        }
    }

    /// Returns whether kept row i is in the circuit of dropped row j.
    pub(crate) fn contains(&self, j: usize, i: usize) -> bool {
        self.t[(j, i)].abs() > self.size[j] * self.noise[i]
    }
}

fn scatter(decision: &RankDecision, t: &Matrix) -> Matrix {
    let mut z = Matrix::zeros(decision.rank + decision.redundancy, decision.redundancy);
    for (j, &row_j) in decision.dropped.iter().enumerate() {
        z[(row_j, j)] = 1.0;
        for (i, &row_i) in decision.kept.iter().enumerate() {
            z[(row_i, j)] = -t[(j, i)];
        }
    }
    z
}

fn root(label: &[usize], mut row: usize) -> usize {
    while label[row] != row {
        row = label[row];
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{circuits, decide};

    /// Rows: two independent groups {0, 1, 2} and {3, 4}, a coloop 5, a row of zeros 6.
    fn grouped() -> Matrix {
        Matrix::from_rows(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [2.0, -4.0, 0.0, 0.0],
            [0.0, 0.0, 1e6, 0.0],
            [0.0, 0.0, 3.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [0.0, 0.0, 0.0, 0.0],
        ])
    }

    #[test]
    fn circuits_by_hand() {
        let decision = decide(&grouped(), crate::Accuracy::Rounding).unwrap();
        let found = circuits(&decision);
        let rows: Vec<_> = found.iter().map(|c| c.rows.clone()).collect();
        assert_eq!(rows.len(), 3);
        for (expected, coefficients) in [
            (vec![0, 1, 2], vec![-0.5, 1.0, 0.25]),
            (vec![3, 4], vec![-3e-6, 1.0]),
            (vec![6], vec![1.0]),
        ] {
            let circuit = found.iter().find(|c| c.rows == expected).expect("circuit");
            for (a, b) in circuit.coefficients.iter().zip(&coefficients) {
                assert!((a - b).abs() < 1e-15 * b.abs().max(1e-3), "{circuit:?}");
            }
        }
        let parts = components(&decision);
        assert_eq!(parts.coupled, [vec![0, 1, 2], vec![3, 4], vec![6]]);
        assert_eq!(parts.coloops, [5]);
    }

    #[test]
    fn bases_annihilate_the_rows_they_belong_to() {
        let c = grouped();
        let decision = decide(&c, crate::Accuracy::Rounding).unwrap();
        let scaled = decision.scaling.apply(&c);
        let z = orthonormal(&decision);
        approx::assert_abs_diff_eq!(
            z.transpose().product(&z),
            Matrix::identity(3),
            epsilon = 1e-15
        );
        assert!(scaled.transpose().product(&z).max_abs() < 1e-15);
        assert!(c.transpose().product(&dependencies(&decision)).max_abs() < 1e-9);
        // Margins: zero for the coloop, one for the row of zeros.
        let margin = |i: usize| z.row(i).iter().map(|a| a * a).sum::<f64>().sqrt();
        assert!(margin(5) < 1e-15 && (margin(6) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn full_rank_has_no_dependencies() {
        let decision = decide(&Matrix::identity(3), crate::Accuracy::Rounding).unwrap();
        assert_eq!(orthonormal(&decision), Matrix::zeros(3, 0));
        assert!(circuits(&decision).is_empty());
        assert_eq!(components(&decision).coloops, [0, 1, 2]);
    }

    /// Row 3 is the mean of rows 0 and 2, and row 4 is `row 1 + x·row 2`, in whole multiples of
    /// powers of two. A tolerance that makes row 2 undecided couples them by row 2, if x exceeds
    /// rounding.
    #[test]
    fn an_open_row_joins_what_it_belongs_to_beyond_rounding() {
        for (exponent, joined) in [(-37, vec![0, 1, 2, 3, 4]), (-44, vec![0, 2, 3])] {
            let c = Matrix::from_rows(&[
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [0.5, 0.0, 0.5],
                [0.0, 1.0, 2_f64.powi(exponent)],
            ]);
            let exact = crate::certify_exact(&c).unwrap();
            let mut decision = crate::with_dropped(&exact, &c, &[3, 4]).unwrap();
            let certificate = decision.evidence.certificate.as_mut().unwrap();
            certificate.has_tolerance = true;
            certificate.open_rows = vec![2];
            assert_eq!(open_rows(&decision), joined, "2^{exponent}");
        }
    }

    #[test]
    fn a_row_that_is_unique_is_in_no_circuit() {
        // Sixteen unit rows and their sum, in which the last row has the coefficient x and the
        // other fifteen rows have the coefficient 1. The dependency has norm 4, so the margin is
        // x/4. A coefficient of twice the noise is not rounding by itself, but its row is unique.
        let matrix = |x: f64| {
            Matrix::from_fn(17, 17, |i, j| match (i, j) {
                (16, 15) => x,
                (16, 16) => 0.0,
                (16, _) => 1.0,
                _ => f64::from(u8::from(i == j)),
            })
        };
        let decide = |x: f64| {
            crate::decide_dropping(&matrix(x), crate::Accuracy::Absolute(1e-12), &[16]).unwrap()
        };
        let noise = decide(0.0).row_noise(15);
        for (roundings, is_in) in [(0.5, false), (2.0, false), (5.0, true)] {
            let decision = decide(roundings * noise);
            let margin = kernels::norm(orthonormal(&decision).row(15));
            let is_zero = decision.read_coefficient(margin, decision.row_noise(15))
                == CoefficientReading::Zero;
            assert_eq!(is_zero, !is_in, "{roundings}: {margin:e} of {noise:e}");
            assert_eq!(circuits(&decision)[0].rows.contains(&15), is_in);
            assert_eq!(components(&decision).coloops.contains(&15), !is_in);
        }
    }
}
