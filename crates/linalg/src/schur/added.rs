//! Rows of the mass matrix. Each row g with the inertia a is a row `g·v − w = 0` of the
//! constraints, and its velocity w has the mass a. The diagonal of S then contains 1/a for this
//! row, and its multiplier is the load of the inertia.

use crate::{AddedMass, MassMatrix, SaddleError, SparseMatrix};

/// The equations with the rows of the mass matrix as constraints, and their vectors.
#[derive(Clone, Debug)]
pub(super) struct ExtendedSystem {
    /// The rows of C, followed by the rows of the mass matrix.
    pub(super) c: SparseMatrix,
    pub(super) mass: Vec<f64>,
    /// Positions of the values of one row.
    places: Vec<usize>,
    pub(super) f: Vec<f64>,
    pub(super) gamma: Vec<f64>,
    pub(super) a: Vec<f64>,
    pub(super) lambda: Vec<f64>,
}

impl ExtendedSystem {
    pub(super) fn new(c: SparseMatrix) -> Self {
        let (r, n) = (c.nrows(), c.ncols());
        Self {
            mass: vec![0.0; n],
            places: Vec::with_capacity(n),
            f: vec![0.0; n],
            gamma: vec![0.0; r],
            a: vec![0.0; n],
            lambda: vec![0.0; r],
            c,
        }
    }

    /// Copies the rows of C and of the mass matrix, and the masses.
    pub(super) fn take(
        &mut self,
        c: &SparseMatrix,
        mass: MassMatrix<'_>,
    ) -> Result<(), SaddleError> {
        let (diagonal, added) = (mass.diagonal(), mass.added());
        let expected = self.mass.len().saturating_sub(added.n_rows());
        if diagonal.len() != expected {
            return Err(SaddleError::Length {
                argument: "mass",
                found: diagonal.len(),
                expected,
            });
        }
        let (r, k) = (c.nrows(), added.n_rows());
        if self.c.nrows() != r + k || self.c.start(r) != c.nnz() {
            return Err(SaddleError::Length {
                argument: "rows",
                found: r + k,
                expected: self.c.nrows(),
            });
        }
        self.c.values_mut()[..c.nnz()].copy_from_slice(c.values());
        for (k, (_, columns, g)) in added.rows().enumerate() {
            let start = self.c.start(r + k);
            let own = self.c.row(r + k).0;
            let last = start + own.len() - 1;
            let places = columns
                .iter()
                .map(|&j| start + own.partition_point(|&i| i < j));
            self.places.clear();
            self.places.extend(places);
            let values = self.c.values_mut();
            values[start..last].fill(0.0);
            values[last] = -1.0;
            for (&place, g) in self.places.iter().zip(g) {
                values[place] += g;
            }
        }
        self.mass[..diagonal.len()].copy_from_slice(diagonal);
        for (mass, (inertia, ..)) in self.mass[diagonal.len()..].iter_mut().zip(added.rows()) {
            *mass = inertia;
        }
        Ok(())
    }
}

/// Copies the values to the start of a longer list and fills the rest with zeros.
pub(super) fn begin(
    list: &mut [f64],
    values: &[f64],
    argument: &'static str,
) -> Result<(), SaddleError> {
    let expected = list.len();
    let Some((own, rest)) = list.split_at_mut_checked(values.len()) else {
        return Err(SaddleError::Length {
            argument,
            found: values.len(),
            expected,
        });
    };
    own.copy_from_slice(values);
    rest.fill(0.0);
    Ok(())
}

/// Returns the rows of C, followed by the rows of the mass matrix; `None` without such rows.
pub(super) fn extended(c: &SparseMatrix, added: &AddedMass) -> Option<SparseMatrix> {
    if added.is_empty() {
        return None;
    }
    let n = c.ncols();
    let of_c = (0..c.nrows()).map(|i| c.entries(i).collect::<Vec<_>>());
    let of_added = added.rows().enumerate().map(|(k, (_, columns, values))| {
        let row = columns.iter().copied().zip(values.iter().copied());
        row.chain([(n + k, -1.0)]).collect()
    });
    SparseMatrix::from_rows(n + added.n_rows(), of_c.chain(of_added)).ok()
}
