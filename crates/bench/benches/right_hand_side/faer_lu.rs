//! Solves the dense equations with faer. The method is LU with partial pivoting, in place and on
//! one thread. All storage is allocated in advance.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::{MatMut, MatRef, Par, Spec};

/// Storage of one solver.
pub(crate) struct FaerLu {
    n: usize,
    permutation: Vec<usize>,
    inverse: Vec<usize>,
    buffer: MemBuffer,
}

impl FaerLu {
    /// Allocates storage for matrices of order n.
    pub(crate) fn new(n: usize) -> Self {
        let factor = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Spec::default());
        let solve = solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq);
        Self {
            n,
            permutation: vec![0; n],
            inverse: vec![0; n],
            buffer: MemBuffer::new(StackReq::any_of(&[factor, solve])),
        }
    }

    /// Factors `matrix` (column-major) in place. On entry, `x` contains the right-hand side; on
    /// return, it contains the solution.
    pub(crate) fn solve(&mut self, matrix: &mut [f64], x: &mut [f64]) {
        let Self {
            n,
            permutation,
            inverse,
            buffer,
        } = self;
        let n = *n;
        let (_, permutation) = factor::lu_in_place(
            MatMut::from_column_major_slice_mut(matrix, n, n),
            permutation,
            inverse,
            Par::Seq,
            MemStack::new(buffer),
            Spec::default(),
        );
        let lu = MatRef::from_column_major_slice(matrix, n, n);
        let x = MatMut::from_column_major_slice_mut(x, n, 1);
        solve::solve_in_place(lu, lu, permutation, x, Par::Seq, MemStack::new(buffer));
    }
}
