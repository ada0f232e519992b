//! Displacements and velocities that change one independent coordinate or one row, and no other
//! coordinate or row.

use linalg::{DampedRows, Matrix};

use super::chosen::CoordinateChoice;
use super::coordinate::Coordinate;
use super::curve::Curves;
use super::error::LineariseError;

/// Displacements and velocities that change one independent coordinate each.
pub(crate) struct Bases {
    /// The displacements, with one row of n_v values for each position.
    pub(crate) shifts: Matrix,
    positions: DampedRows,
    velocities: DampedRows,
    /// Numbers of independent rows of Φ and of C.
    kept: [usize; 2],
    free: [usize; 2],
    free_velocities: Vec<Coordinate>,
}

impl Bases {
    pub(crate) fn new(
        curves: &Curves<'_>,
        chosen: &CoordinateChoice,
    ) -> Result<Self, LineariseError> {
        let weights = curves.squared_units();
        let square = |kept: &[usize], free: &[Coordinate]| {
            let c = curves.rows(kept);
            let all = Matrix::from_fn(kept.len() + free.len(), weights.len(), |i, j| {
                if i < kept.len() {
                    c[(i, j)]
                } else {
                    curves.frames[(free[i - kept.len()].row(), j)]
                }
            });
            DampedRows::new(&all, &weights, 0.0).map_err(|_| LineariseError::Singular)
        };
        let [of_phi, of_c] = curves.kept();
        let positions = square(of_phi, &chosen.positions)?;
        let (m, d) = (of_phi.len(), chosen.positions.len());
        let mut shifts = Matrix::zeros(d, weights.len());
        for k in 0..d {
            let shift = unit_step(&positions, m + d, m + k)?;
            shifts.row_mut(k).copy_from_slice(&shift);
        }
        Ok(Self {
            shifts,
            velocities: square(of_c, &chosen.velocities)?,
            positions,
            kept: [m, of_c.len()],
            free: [d, chosen.velocities.len()],
            free_velocities: chosen.velocities.clone(),
        })
    }

    /// Returns the displacement that changes independent position k by one unit.
    pub(crate) fn shift(&self, k: usize) -> Vec<f64> {
        self.shifts.row(k).to_vec()
    }

    /// Returns the velocities of all bodies that change independent velocity k by one unit.
    pub(crate) fn velocity(&self, k: usize) -> Result<Vec<f64>, LineariseError> {
        let [_, r] = self.kept;
        unit_step(&self.velocities, r + self.free[1], r + k)
    }

    /// Returns the displacement that changes the independent row `k` of Φ by one, and no
    /// independent position.
    pub(crate) fn shift_of_row(&self, k: usize) -> Result<Vec<f64>, LineariseError> {
        unit_step(&self.positions, self.kept[0] + self.free[0], k)
    }

    /// Returns the velocity that changes the independent row `k` of C·v by one, and no independent
    /// velocity.
    pub(crate) fn velocity_of_row(&self, k: usize) -> Result<Vec<f64>, LineariseError> {
        unit_step(&self.velocities, self.kept[1] + self.free[1], k)
    }

    /// Returns the change of velocities along a displacement if the independent velocities are
    /// constant.
    pub(crate) fn velocity_kept_by(
        &self,
        curves: &Curves<'_>,
        shift: &[f64],
    ) -> Result<Vec<f64>, LineariseError> {
        let missed = curves.missed_velocities(shift, &self.free_velocities);
        let step = self.velocities.step(&missed);
        step.map_err(|_| LineariseError::Singular)
    }
}

/// Returns the step that changes row k of `of` by one and no other row.
fn unit_step(of: &DampedRows, rows: usize, k: usize) -> Result<Vec<f64>, LineariseError> {
    let mut residual = vec![0.0; rows];
    residual[k] = -1.0;
    of.step(&residual).map_err(|_| LineariseError::Singular)
}
