//! Computes how close C is to a lower rank at one configuration of a mechanism, and how this
//! distance depends on the data.
//!
//! With r' kept rows K, the rank is r' iff `S = C_D·V` vanishes, where V is the null space of C_K.
//! With `U = [−Tᵀ; I]` and `T = C_D·C_K⁺`, S equals `Uᵀ·C·V` and changes with the data to first
//! order by `Uᵀ·δC·V`. δC has two parts: the change due to points and directions at a fixed
//! configuration, and the change due to the configuration. The configuration changes with the data
//! so that the kept rows of Φ stay satisfied: `δq = −C_K⁺·(Φ_K + ∂Φ_K/∂d·δd)`, with no component
//! along the free motions. Φ_K is not zero if rows contradict each other within a tolerance and the
//! residual of the start is distributed among them.

use crate::limits::{HOLONOMIC, RESOLVED};
use linalg::{Matrix, PivotedQr, RowBasis, Scaling, kernels, small_svd};
use model::{DataSlopes, ForceDerivatives, Mechanism, Scratch, System};

use super::follow::FollowedRows;

/// A configuration, and the rows and columns that are kept for a lower rank.
pub(super) struct Pose<'a> {
    mechanism: &'a Mechanism,
    s: &'a Scratch,
    /// Derivatives of the rows with respect to the data.
    slopes: DataSlopes<'a>,
    /// Rows of the mechanism in the scaled C.
    places: &'a [usize],
    /// Factors of columns and rows from C to its scaled form.
    columns: Vec<f64>,
    rows: Vec<f64>,
    /// The kept holonomic rows.
    positions: FollowedRows,
    /// The values that must vanish for the lower rank, `Uᵀ·C·V = diag(σ)`. The fields are the left
    /// vectors as rows (scaled), the right vectors as rows (scaled), and σ.
    pub(super) left: Matrix,
    pub(super) right: Matrix,
    pub(super) sigma: Vec<f64>,
}

/// Rows and columns of a scaled C that are kept for a rank, and the remaining rows and columns.
pub(super) struct Candidate {
    /// The r' kept rows.
    pub(super) kept: Vec<usize>,
    /// Factors of the kept rows, in this order.
    pub(super) factored: PivotedQr,
    left: Matrix,
    right: Matrix,
    sigma: Vec<f64>,
}

impl Candidate {
    /// Returns the motions that the kept rows leave free, one motion in each row. The motion that
    /// the other rows constrain most comes first.
    pub(super) fn into_free(self) -> Matrix {
        self.right
    }

    /// Returns the largest entry that must vanish.
    pub(super) fn weakest(&self) -> f64 {
        self.sigma.first().copied().unwrap_or(0.0)
    }

    /// Keeps the most independent rows. The number of these rows is the rank.
    pub(super) fn of_rank(scaled: &Matrix, rank: usize) -> Self {
        Self::of(RowBasis::most_independent(scaled.clone(), rank))
    }

    /// Keeps these rows.
    pub(super) fn of_rows(scaled: &Matrix, kept: Vec<usize>) -> Self {
        Self::of(RowBasis::of_rows(scaled, kept))
    }

    /// Keeps the rows of a basis.
    pub(super) fn of(rows: RowBasis) -> Self {
        let (kept, dropped) = (rows.kept().to_vec(), rows.dropped());
        let (n, r) = (rows.factored().dimension(), kept.len());
        let mut u = Matrix::zeros(dropped.len(), r + dropped.len());
        let mut rest = Matrix::zeros(dropped.len(), n - r);
        let mut t = vec![0.0; r];
        for (j, &row) in dropped.iter().enumerate() {
            rows.coefficients(j, &mut t);
            rest.row_mut(j).copy_from_slice(rows.outside(j));
            u[(j, row)] = 1.0;
            for (t, &k) in t.iter().zip(&kept) {
                u[(j, k)] = -t;
            }
            let size = u.row(j).iter().map(|x| x * x).sum::<f64>().sqrt();
            u.row_mut(j).iter_mut().for_each(|x| *x /= size);
            rest.row_mut(j).iter_mut().for_each(|x| *x /= size);
        }
        let factored = rows.into_factored();
        let v = factored.q_columns(r..n);
        let svd = small_svd(&rest);
        Self {
            kept,
            factored,
            left: complete(&svd.u, &svd.sigma).transpose().product(&u),
            right: complete(&svd.v, &svd.sigma)
                .transpose()
                .product(&v.transpose()),
            sigma: svd.sigma,
        }
    }
}

/// Returns the other rows of a scaled C. The rows that are most independent of the kept rows come
/// first.
pub(super) fn most_independent_of(scaled: &Matrix, kept: &[usize]) -> Vec<usize> {
    let own = RowBasis::of_rows(scaled, kept.to_vec());
    let others = own.dropped();
    let mut rest = Matrix::zeros(others.len(), scaled.ncols() - kept.len());
    for j in 0..others.len() {
        rest.row_mut(j).copy_from_slice(own.outside(j));
    }
    let rest = PivotedQr::of_rows(rest);
    rest.permutation().iter().map(|&j| others[j]).collect()
}

/// Returns an orthonormal basis that begins with the given singular vectors. Singular vectors that
/// are only rounding are replaced.
fn complete(columns: &Matrix, sigma: &[f64]) -> Matrix {
    let n = columns.nrows();
    let largest = sigma.iter().copied().fold(0.0, f64::max);
    let known: Vec<usize> = (0..sigma.len())
        .filter(|&j| sigma[j] > RESOLVED * largest)
        .collect();
    let set = Matrix::from_fn(known.len(), n, |i, j| columns[(j, known[i])]);
    let rest = PivotedQr::of_rows(set).q_columns(known.len()..n);
    let mut all = Matrix::zeros(n, n);
    let mut next = 0;
    for j in 0..n {
        let at = known.iter().position(|&known| known == j);
        for i in 0..n {
            all[(i, j)] = match at {
                Some(_) => columns[(i, j)],
                None => rest[(i, next)],
            };
        }
        next += usize::from(at.is_none());
    }
    all
}

/// Gradient of one entry of `Uᵀ·C·V`.
pub(super) struct Gradient {
    /// Derivatives with respect to the numbers of the constraints.
    pub(super) data: Vec<f64>,
    /// Derivatives with respect to the coordinates, along the motions that the kept rows leave free
    /// (physical units), n_v values.
    pub(super) pose: Vec<f64>,
    /// Change of the entry if the data are fixed and the configuration is moved onto the kept rows.
    pub(super) onto_kept: f64,
}

impl Gradient {
    /// Returns the gradient of a sum of entries with these weights.
    pub(super) fn sum(entries: &[Self], weights: &[f64]) -> Self {
        let total = |of: &dyn Fn(&Self) -> &[f64]| {
            let mut total = vec![0.0; entries.first().map_or(0, |entry| of(entry).len())];
            for (entry, weight) in entries.iter().zip(weights) {
                kernels::axpy(*weight, of(entry), &mut total);
            }
            total
        };
        let onto_kept = entries.iter().zip(weights).map(|(e, w)| e.onto_kept * w);
        Self {
            data: total(&|entry| &entry.data),
            pose: total(&|entry| &entry.pose),
            onto_kept: onto_kept.sum(),
        }
    }
}

impl<'a> Pose<'a> {
    /// Evaluates the configuration of the scratch, in which C must have been evaluated. `scaled`
    /// contains the rows `places` of C, scaled by `dimensions` and then by `scaling`. Positions
    /// change with the data so that the kept rows stay satisfied.
    pub(super) fn new(
        mechanism: &'a Mechanism,
        s: &'a Scratch,
        places: &'a [usize],
        matrices: (&Matrix, &Scaling, &Scaling),
        candidate: Candidate,
    ) -> Self {
        let held = candidate.kept.clone();
        Self::held(mechanism, s, places, matrices, candidate, &held)
    }

    /// Works like [`Self::new`], but other independent rows stay satisfied.
    pub(super) fn held(
        mechanism: &'a Mechanism,
        s: &'a Scratch,
        places: &'a [usize],
        (scaled, dimensions, scaling): (&Matrix, &Scaling, &Scaling),
        candidate: Candidate,
        held: &[usize],
    ) -> Self {
        let factor = |e: i32| f64::from(e).exp2();
        let columns: Vec<f64> = dimensions
            .cols
            .iter()
            .zip(&scaling.cols)
            .map(|(a, b)| factor(a + b))
            .collect();
        let rows: Vec<f64> = (0..scaled.nrows()).map(|i| scaling.row_factor(i)).collect();
        let is_holonomic = |&i: &usize| places[i] < mechanism.layout().m;
        let holonomic: Vec<usize> = held.iter().copied().filter(is_holonomic).collect();
        let of_mechanism = holonomic.iter().map(|&i| (places[i], rows[i])).collect();
        // In most mechanisms these are the kept rows, which have been factored.
        let factored = if holonomic == candidate.kept {
            candidate.factored
        } else {
            PivotedQr::of_rows(scaled.select_rows(&holonomic))
        };
        let positions = FollowedRows::new(factored, of_mechanism, columns.clone());
        Self {
            mechanism,
            s,
            slopes: mechanism.data().slopes(s),
            places,
            columns,
            rows,
            positions,
            left: candidate.left,
            right: candidate.right,
            sigma: candidate.sigma,
        }
    }

    /// Returns `u_aᵀ·C·v_b` (scaled) at satisfied kept rows, and its gradient.
    pub(super) fn entry(&self, a: usize, b: usize) -> (f64, Gradient) {
        let here = if a == b {
            self.sigma.get(a).copied().unwrap_or(0.0)
        } else {
            0.0
        };
        let gradient = self.gradient_between(self.left.row(a), self.right.row(b));
        (here + gradient.onto_kept, gradient)
    }

    /// Returns `u_aᵀ·Φ` and its gradient with respect to the data of the constraints. Returns
    /// `None` if nonholonomic rows take part, because a dependency of velocities implies no
    /// dependency of positions.
    pub(super) fn misfit(&self, a: usize) -> Option<(f64, Vec<f64>)> {
        let u = self.spread(self.left.row(a));
        let (holonomic, others) = u.split_at(self.mechanism.layout().m);
        let size = |x: &[f64]| x.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        if size(others) > HOLONOMIC * size(holonomic) {
            return None;
        }
        let target = holonomic
            .iter()
            .zip(&self.s.phi)
            .map(|(u, phi)| u * phi)
            .sum();
        let mut gradient = vec![0.0; self.mechanism.data().count()];
        self.slopes.add_phi(&u, 1.0, &mut gradient);
        Some((target, gradient))
    }

    /// Returns weights of all rows of the mechanism, from scaled weights of the analysed rows.
    fn spread(&self, scaled: &[f64]) -> Vec<f64> {
        let mut u = vec![0.0; self.mechanism.layout().rows()];
        for ((&row, weight), factor) in self.places.iter().zip(scaled).zip(&self.rows) {
            u[row] = weight * factor;
        }
        u
    }

    /// Returns the gradient of `uᵀ·C·v` (scaled); u has one entry for each analysed row.
    pub(super) fn gradient_between(&self, u: &[f64], v: &[f64]) -> Gradient {
        self.gradient_at(&self.forces(u), v)
    }

    /// Returns the forces `Cᵀ·u` for weights u of the analysed rows.
    pub(super) fn forces(&self, u: &[f64]) -> Forces {
        let u = self.spread(u);
        Forces {
            derivatives: self.mechanism.data().force_derivatives(self.s, &u),
            u,
        }
    }

    /// Works like [`Self::gradient_between`], for forces that are used with several velocities.
    pub(super) fn gradient_at(&self, forces: &Forces, v: &[f64]) -> Gradient {
        let v: Vec<f64> = v.iter().zip(&self.columns).map(|(x, f)| x * f).collect();
        let mut data = vec![0.0; self.mechanism.data().count()];
        self.slopes.add_power(&forces.u, &v, 1.0, &mut data);
        let mut turned = vec![0.0; v.len()];
        forces.derivatives.add_power(&v, &mut turned);
        let (lambda, pose) = self.positions.split(&turned, forces.u.len());
        self.slopes.add_phi(&lambda, -1.0, &mut data);
        let onto_kept = -lambda
            .iter()
            .zip(&self.s.phi)
            .map(|(l, phi)| l * phi)
            .sum::<f64>();
        Gradient {
            data,
            pose,
            onto_kept,
        }
    }
}

/// Weights of all rows of the mechanism, and the derivatives of their forces on the bodies with
/// respect to the configuration.
pub(super) struct Forces {
    u: Vec<f64>,
    derivatives: ForceDerivatives,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The second vector belongs to a singular value that is zero to rounding. The second vector is
    /// not orthogonal to the first vector.
    #[test]
    fn singular_vectors_of_rounding_are_replaced() {
        let columns = Matrix::from_rows(&[[1.0, 0.6], [0.0, 0.8], [0.0, 0.0]]);
        for (sigma, is_kept) in [(0.7e-13, false), (1.4e-13, true)] {
            let all = complete(&columns, &[1.0, sigma]);
            assert_eq!(all[(0, 0)], 1.0);
            assert_eq!(all[(0, 1)].abs() > 1e-15, is_kept, "{sigma}");
        }
    }
}
