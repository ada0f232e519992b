//! Mass matrices that are diagonal except for a few rows: `M = diag(m) + Σ aₖ·gₖᵀ·gₖ`. Such a row
//! is the inertia of a part that moves with a combination of the velocities, for example of a rotor
//! that rotates with a joint coordinate.

/// The rows g of a mass matrix with their inertias a. The columns of a row are fixed when the row
/// is added; its values change along a motion.
///
/// ```
/// use pfaff_linalg::{AddedMass, MassMatrix};
/// // Two unit masses, and a rotor that rotates with their distance.
/// let mut added = AddedMass::default();
/// added.push(3.0, &[0, 1]);
/// added.values_mut(0).copy_from_slice(&[-1.0, 1.0]);
/// let mass = MassMatrix::new(&[1.0, 1.0], &added);
/// assert_eq!(mass.product(&[0.0, 1.0]), [-3.0, 4.0]);
/// assert_eq!(mass.between(&[0.0, 1.0], &[0.0, 1.0]), 4.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AddedMass {
    /// Start of each row, and the end of the last row; empty without rows.
    ends: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    inertias: Vec<f64>,
}

/// The rows of a diagonal mass matrix.
static NO_ROWS: AddedMass = AddedMass {
    ends: Vec::new(),
    columns: Vec::new(),
    values: Vec::new(),
    inertias: Vec::new(),
};

impl Default for AddedMass {
    fn default() -> Self {
        NO_ROWS.clone()
    }
}

impl AddedMass {
    /// Adds a row with this inertia and with entries in these columns. The entries are zero.
    pub fn push(&mut self, inertia: f64, columns: &[usize]) {
        self.columns.extend_from_slice(columns);
        self.values.resize(self.columns.len(), 0.0);
        self.ends.push(self.columns.len());
        self.inertias.push(inertia);
    }

    /// Returns whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.inertias.is_empty()
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.inertias.len()
    }

    fn range(&self, k: usize) -> std::ops::Range<usize> {
        k.checked_sub(1).map_or(0, |before| self.ends[before])..self.ends[k]
    }

    /// Returns the values of row `k`, in the order of its columns.
    ///
    /// # Panics
    /// Panics if the row does not exist.
    pub fn values_mut(&mut self, k: usize) -> &mut [f64] {
        let range = self.range(k);
        &mut self.values[range]
    }

    /// Returns the inertia, the columns and the values of row `k`.
    ///
    /// # Panics
    /// Panics if the row does not exist.
    #[must_use]
    pub fn row(&self, k: usize) -> (f64, &[usize], &[f64]) {
        let range = self.range(k);
        (
            self.inertias[k],
            &self.columns[range.clone()],
            &self.values[range],
        )
    }

    /// Returns the inertia, the columns and the values of each row.
    pub fn rows(&self) -> impl Iterator<Item = (f64, &[usize], &[f64])> {
        (0..self.n_rows()).map(|k| self.row(k))
    }

    /// Copies the values of other rows, multiplied by the unit of each column. The other rows have
    /// the same columns.
    ///
    /// # Panics
    /// Panics if the rows have other columns.
    pub fn take(&mut self, other: &Self, units: &[f64]) {
        let values = self.values.iter_mut().zip(&other.columns);
        for ((value, &column), from) in values.zip(&other.values) {
            *value = from * units[column];
        }
    }

    /// Returns the product of row `k` and x.
    ///
    /// # Panics
    /// Panics if the row does not exist, or if x is too short.
    #[must_use]
    pub fn times(&self, k: usize, x: &[f64]) -> f64 {
        let (_, columns, values) = self.row(k);
        columns.iter().zip(values).map(|(&j, g)| g * x[j]).sum()
    }

    /// Copies other rows without allocating memory, if the storage is large enough.
    pub(crate) fn copy(&mut self, other: &Self) {
        self.ends.clone_from(&other.ends);
        self.columns.clone_from(&other.columns);
        self.values.clone_from(&other.values);
        self.inertias.clone_from(&other.inertias);
    }

    /// Returns one more than the largest column.
    pub(crate) fn n_columns(&self) -> usize {
        self.columns.iter().max().map_or(0, |j| j + 1)
    }

    /// Returns the largest `a·‖g‖²`, which is zero without rows.
    pub(crate) fn heaviest(&self) -> f64 {
        let squared = |(a, _, g): (f64, &[usize], &[f64])| a * g.iter().map(|g| g * g).sum::<f64>();
        self.rows().map(squared).fold(0.0, f64::max)
    }

    /// Returns the first value or inertia that is not finite, or a negative inertia.
    pub(crate) fn wrong(&self) -> Option<(usize, f64)> {
        let inertias = self.inertias.iter().copied();
        let bad = inertias
            .enumerate()
            .find(|(_, a)| !(a.is_finite() && *a >= 0.0));
        let values = self.values.iter().copied();
        bad.or_else(|| values.enumerate().find(|(_, g)| !g.is_finite()))
    }
}

/// A mass matrix `diag(m) + Σ aₖ·gₖᵀ·gₖ`. A slice is a diagonal mass matrix.
#[derive(Clone, Copy, Debug)]
pub struct MassMatrix<'a> {
    diagonal: &'a [f64],
    added: &'a AddedMass,
}

impl<'a> MassMatrix<'a> {
    /// Returns the matrix with this diagonal and these rows.
    #[must_use]
    pub fn new(diagonal: &'a [f64], added: &'a AddedMass) -> Self {
        Self { diagonal, added }
    }

    /// Returns m, without the contribution of the rows.
    #[must_use]
    pub fn diagonal(self) -> &'a [f64] {
        self.diagonal
    }

    /// Returns the rows.
    #[must_use]
    pub fn added(self) -> &'a AddedMass {
        self.added
    }

    /// Computes `y ← y + M·x`.
    ///
    /// # Panics
    /// Panics if x or y is too short for the rows.
    pub fn add_product(self, x: &[f64], y: &mut [f64]) {
        for ((y, m), x) in y.iter_mut().zip(self.diagonal).zip(x) {
            *y += m * x;
        }
        for (k, (inertia, columns, values)) in self.added.rows().enumerate() {
            let force = inertia * self.added.times(k, x);
            for (&j, g) in columns.iter().zip(values) {
                y[j] += g * force;
            }
        }
    }

    /// Returns `M·x`. The function allocates memory.
    ///
    /// # Panics
    /// Panics under the same conditions as [`Self::add_product`].
    #[must_use]
    pub fn product(self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.diagonal.len()];
        self.add_product(x, &mut y);
        y
    }

    /// Returns `xᵀ·M·y`.
    ///
    /// # Panics
    /// Panics if x or y is too short for the rows.
    #[must_use]
    pub fn between(self, x: &[f64], y: &[f64]) -> f64 {
        let terms = self.diagonal.iter().zip(x).zip(y);
        let diagonal: f64 = terms.map(|((m, x), y)| m * x * y).sum();
        let rows = self.added.rows().enumerate();
        rows.fold(diagonal, |sum, (k, (inertia, ..))| {
            sum + inertia * self.added.times(k, x) * self.added.times(k, y)
        })
    }

    /// Returns the diagonal of M, with the contribution of the rows. The function allocates memory.
    #[must_use]
    pub fn full_diagonal(self) -> Vec<f64> {
        let mut all = self.diagonal.to_vec();
        for (inertia, columns, values) in self.added.rows() {
            for (&j, g) in columns.iter().zip(values) {
                all[j] += inertia * g * g;
            }
        }
        all
    }
}

impl<'a> From<&'a [f64]> for MassMatrix<'a> {
    fn from(diagonal: &'a [f64]) -> Self {
        Self::new(diagonal, &NO_ROWS)
    }
}

impl<'a> From<&'a Vec<f64>> for MassMatrix<'a> {
    fn from(diagonal: &'a Vec<f64>) -> Self {
        Self::from(diagonal.as_slice())
    }
}

impl<'a, const N: usize> From<&'a [f64; N]> for MassMatrix<'a> {
    fn from(diagonal: &'a [f64; N]) -> Self {
        Self::from(diagonal.as_slice())
    }
}

impl<'a> From<&'a Box<[f64]>> for MassMatrix<'a> {
    fn from(diagonal: &'a Box<[f64]>) -> Self {
        Self::from(&**diagonal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KeptRowSaddle, Refinement, SchurSaddle, SchurStructure, SparseMatrix};

    /// Numbers in -1..1 without pattern.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    /// The reference has the velocities of the added inertias as coordinates, and the rows
    /// `g·v − w = 0` as constraints.
    #[test]
    fn rows_of_the_mass_matrix_are_inertias_on_their_own_coordinates() {
        for (seed, n, r, k) in [(1, 6, 2, 1), (2, 9, 3, 4), (3, 7, 6, 2), (4, 8, 0, 3)] {
            let mut x = numbers(seed);
            let c: Vec<Vec<f64>> = (0..r).map(|_| (0..n).map(|_| x()).collect()).collect();
            let mass: Vec<f64> = (0..n).map(|_| 1.5 + x()).collect();
            let [f, gamma] = [n, r].map(|n| (0..n).map(|_| x()).collect::<Vec<f64>>());
            let mut added = AddedMass::default();
            let columns: Vec<usize> = (0..n).rev().step_by(2).collect();
            let mut extended: Vec<Vec<f64>> = c.clone();
            for row in 0..k {
                added.push(10.0_f64.powf(2.0 * x()), &columns);
                let mut whole = vec![0.0; n + k];
                for (value, &j) in added.values_mut(row).iter_mut().zip(&columns) {
                    *value = x();
                    whole[j] = *value;
                }
                whole[n + row] = -1.0;
                extended.push(whole);
            }
            extended.iter_mut().for_each(|row| row.resize(n + k, 0.0));
            let masses: Vec<f64> = { mass.iter().copied() }
                .chain(added.rows().map(|(a, ..)| a))
                .collect();
            let mut reference = KeptRowSaddle::new(n + k, r + k).unwrap();
            reference.factor(|i| &extended[i], &masses).unwrap();
            let longer = |x: &[f64]| [x, &vec![0.0; k]].concat();
            let (mut a, mut lambda) = (vec![0.0; n + k], vec![0.0; r + k]);
            reference
                .solve(&longer(&f), &longer(&gamma), &mut a, &mut lambda)
                .unwrap();
            let expected = [&a[..n], &lambda[..r]].concat();

            let matrix = MassMatrix::new(&mass, &added);
            let close = |a: &[f64], lambda: &[f64]| {
                let size = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
                let found = a.iter().chain(lambda).zip(&expected);
                found.fold(0.0, |most: f64, (x, y)| most.max((x - y).abs())) < 1e-11 * size
            };
            let (mut a, mut lambda) = (vec![0.0; n], vec![0.0; r]);
            let mut saddle = KeptRowSaddle::new(n, r).unwrap();
            saddle.factor(|i| &c[i], matrix).unwrap();
            saddle.solve(&f, &gamma, &mut a, &mut lambda).unwrap();
            assert!(close(&a, &lambda), "{seed}: {a:?} {lambda:?} {expected:?}");
            let mut refinement = Refinement::new(n, r);
            saddle
                .solve_refined(&mut refinement, |i| &c[i], &f, &gamma, &mut a, &mut lambda)
                .unwrap();
            assert!(close(&a, &lambda), "{seed}: {a:?} {lambda:?} {expected:?}");

            let rows = c.iter().map(|row| row.iter().copied().enumerate());
            let sparse = SparseMatrix::from_rows(n, rows).unwrap();
            let mut schur =
                SchurSaddle::new(SchurStructure::with_added(&sparse, &[0..2, 2..n], &added));
            schur.factor(&sparse, matrix).unwrap();
            schur
                .solve(&sparse, &f, &gamma, &mut a, &mut lambda)
                .unwrap();
            assert!(close(&a, &lambda), "{seed}: {a:?} {lambda:?} {expected:?}");
            let mut again = vec![0.0; r];
            schur.multipliers(&sparse, &f, &a, &mut again).unwrap();
            assert!(close(&a, &again), "{seed}: {again:?} {expected:?}");

            let force = matrix.product(&a);
            assert!((matrix.between(&a, &a) - crate::kernels::dot(&a, &force)).abs() < 1e-12);
        }
    }

    /// Only the added inertia makes the mass of this motion positive.
    #[test]
    fn a_coordinate_without_mass_moves_with_an_added_inertia() {
        let mut added = AddedMass::default();
        added.push(2.0, &[0]);
        added.values_mut(0)[0] = 1.0;
        let mut saddle = KeptRowSaddle::new(1, 0).unwrap();
        assert!(saddle.factor(|_| &[], &[0.0]).is_err());
        saddle
            .factor(|_| &[], MassMatrix::new(&[0.0], &added))
            .unwrap();
        let mut a = [0.0];
        saddle.solve(&[3.0], &[], &mut a, &mut []).unwrap();
        assert_eq!(a, [1.5]);
    }

    #[test]
    fn inertias_that_are_negative_or_not_finite_are_rejected() {
        for (inertia, value) in [(-1.0, 1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            let mut added = AddedMass::default();
            added.push(inertia, &[0]);
            added.values_mut(0)[0] = value;
            let mut saddle = KeptRowSaddle::new(1, 0).unwrap();
            assert!(
                saddle
                    .factor(|_| &[], MassMatrix::new(&[1.0], &added))
                    .is_err()
            );
        }
        let mut added = AddedMass::default();
        added.push(1.0, &[1]);
        let mut saddle = KeptRowSaddle::new(1, 0).unwrap();
        assert!(
            saddle
                .factor(|_| &[], MassMatrix::new(&[1.0], &added))
                .is_err()
        );
    }
}
