//! Solves the dense equations with nalgebra: by LU with partial pivoting, for a matrix of static or
//! dynamic size, and by singular values.

use nalgebra::{DMatrix, DVector, SMatrix, SVector};

/// Order of the saddle matrix on independent rows.
pub(crate) const N: usize = 41;

/// Solves by LU of a matrix on the stack. On return `x` is `[a; λ]`.
pub(crate) fn solve_static(matrix: SMatrix<f64, N, N>, x: &mut SVector<f64, N>) -> bool {
    matrix.lu().solve_mut(x)
}

/// Solves by LU of a matrix on the heap. The function consumes the matrix, because nalgebra has no
/// function that reuses its storage.
pub(crate) fn solve_dynamic(matrix: DMatrix<f64>, x: &mut DVector<f64>) -> bool {
    matrix.lu().solve_mut(x)
}

/// Computes the least-norm solution of a singular system. Singular values below `tolerance` times
/// the largest singular value count as zero.
pub(crate) fn solve_singular(
    matrix: DMatrix<f64>,
    load: &DVector<f64>,
    tolerance: f64,
) -> Option<DVector<f64>> {
    let svd = matrix.svd(true, true);
    let largest = svd.singular_values.max();
    svd.solve(load, tolerance * largest).ok()
}
