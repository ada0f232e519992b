//! Rows of the mass matrix. Each row g with the inertia a is a row `g·v − w = 0` of the constraints,
//! and its velocity w has the mass a. The diagonal of S then contains 1/a for this row, and its
//! multiplier is the load of the inertia.

use super::{SchurSaddle, SchurStructure};
use crate::{AddedMass, MassMatrix, SaddleError, SparseMatrix};

/// The equations with the rows of the mass matrix as constraints, and their vectors.
#[derive(Clone, Debug)]
pub(super) struct ExtendedSystem {
    /// The rows of C, followed by the rows of the mass matrix.
    pub(super) c: SparseMatrix,
    mass: Vec<f64>,
    /// Positions of the values of one row.
    places: Vec<usize>,
    f: Vec<f64>,
    gamma: Vec<f64>,
    a: Vec<f64>,
    lambda: Vec<f64>,
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
    fn take(&mut self, c: &SparseMatrix, mass: MassMatrix<'_>) -> Result<(), SaddleError> {
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

impl SchurStructure {
    /// Works like [`SchurStructure::new`], for a mass matrix with these rows. The values of the
    /// rows are not used.
    #[must_use]
    pub fn with_added(
        c: &SparseMatrix,
        blocks: &[std::ops::Range<usize>],
        added: &AddedMass,
    ) -> Self {
        if added.is_empty() {
            return Self::new(c, blocks);
        }
        let n = c.ncols();
        let of_c = (0..c.nrows()).map(|i| c.entries(i).collect::<Vec<_>>());
        let of_added = added.rows().enumerate().map(|(k, (_, columns, values))| {
            let row = columns.iter().copied().zip(values.iter().copied());
            row.chain([(n + k, -1.0)]).collect()
        });
        let extended = SparseMatrix::from_rows(n + added.n_rows(), of_c.chain(of_added));
        match extended {
            Ok(extended) => Self {
                rows_of_c: c.nrows(),
                extended: Some(Box::new(extended.clone())),
                ..Self::new(&extended, blocks)
            },
            Err(_) => Self::new(c, blocks),
        }
    }
}

impl SchurSaddle {
    /// Factors the extended equations.
    pub(super) fn factor_extended(
        &mut self,
        floor: f64,
        c: &SparseMatrix,
        mass: MassMatrix<'_>,
    ) -> Result<(), SaddleError> {
        let Some(mut system) = self.extended.take() else {
            let found = mass.added().n_rows();
            return match found {
                0 => self.factor_diagonal(floor, c, mass.diagonal()),
                _ => Err(SaddleError::Length {
                    argument: "rows of the mass matrix",
                    found,
                    expected: 0,
                }),
            };
        };
        let taken = system.take(c, mass);
        let factored = taken.and_then(|()| self.factor_diagonal(floor, &system.c, &system.mass));
        self.extended = Some(system);
        factored
    }

    /// Solves the extended equations.
    pub(super) fn solve_extended(
        &mut self,
        (f, gamma): (&[f64], &[f64]),
        a: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<bool, SaddleError> {
        let Some(mut system) = self.extended.take() else {
            return Ok(false);
        };
        let ExtendedSystem {
            c,
            f: of_all,
            gamma: of_rows,
            a: motion,
            lambda: multipliers,
            ..
        } = &mut *system;
        let copied = begin(of_all, f, "f").and_then(|()| begin(of_rows, gamma, "gamma"));
        let solved = copied
            .and_then(|()| self.solve(c, of_all, of_rows, motion, multipliers))
            .map(|()| {
                a.copy_from_slice(&motion[..a.len()]);
                lambda.copy_from_slice(&multipliers[..lambda.len()]);
                true
            });
        self.extended = Some(system);
        solved
    }

    /// Computes the multipliers of the extended equations for a motion.
    pub(super) fn multipliers_extended(
        &mut self,
        f: &[f64],
        a: &[f64],
        lambda: &mut [f64],
    ) -> Result<bool, SaddleError> {
        let Some(mut system) = self.extended.take() else {
            return Ok(false);
        };
        let ExtendedSystem {
            c,
            f: of_all,
            a: motion,
            lambda: multipliers,
            ..
        } = &mut *system;
        let copied = begin(of_all, f, "f").and_then(|()| begin(motion, a, "a"));
        let found = copied
            .and_then(|()| {
                for (k, i) in (self.structure.rows_of_c..c.nrows()).enumerate() {
                    let rate = c.entries(i).filter(|(j, _)| *j < a.len());
                    motion[a.len() + k] = rate.map(|(j, g)| g * a[j]).sum();
                }
                self.multipliers(c, of_all, motion, multipliers)
            })
            .map(|()| {
                lambda.copy_from_slice(&multipliers[..lambda.len()]);
                true
            });
        self.extended = Some(system);
        found
    }
}

/// Copies the values to the start of a longer list and fills the rest with zeros.
fn begin(list: &mut [f64], values: &[f64], argument: &'static str) -> Result<(), SaddleError> {
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
