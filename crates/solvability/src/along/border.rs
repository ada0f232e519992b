//! A signed function of time that vanishes if the kept rows become dependent. The function is the
//! determinant of these rows, bordered by a fixed basis of the motions that the rows allow at one
//! instant. The rows and the basis stay fixed, so the function is as smooth as the motion.

use linalg::{Determinant, KeptRowSaddle, Lu, Matrix, PivotedQr};

/// The kept rows, and a basis that is fixed at one instant.
pub(super) struct Border {
    kept: Vec<usize>,
    /// The basis vectors, one in each row.
    frame: Matrix,
    /// The factors of the kept rows; `None` if there are more rows than velocities.
    saddle: Option<KeptRowSaddle>,
    units: Vec<f64>,
    /// The determinant at the instant at which the basis was fixed.
    reference: Determinant,
}

impl Border {
    /// Fixes these rows of `c` and a basis of their null space.
    pub(super) fn new(c: &Matrix, kept: &[usize]) -> Self {
        let mut border = Self {
            kept: kept.to_vec(),
            frame: null_space(c, kept),
            saddle: KeptRowSaddle::new(c.ncols(), kept.len()).ok(),
            units: vec![1.0; c.ncols()],
            reference: Determinant::ZERO,
        };
        border.reference = border.determinant(c);
        border
    }

    /// Returns the determinant at another instant, relative to its value at the first instant. The
    /// result is zero if the rows are dependent to working precision.
    pub(super) fn value(&mut self, c: &Matrix) -> f64 {
        let now = self.determinant(c);
        now.sign * self.reference.sign * (now.log - self.reference.log).exp()
    }

    /// Returns the overlap of the fixed basis with the null space of the same rows at another
    /// instant, as a volume. The overlap is 1 if the null space has not rotated. `there` is the
    /// border fixed at the other instant, and `c` is C at this instant.
    pub(super) fn overlap(&self, there: &Self, c: &Matrix) -> f64 {
        let turned;
        let other = if self.kept == there.kept {
            &there.frame
        } else {
            turned = null_space(c, &self.kept);
            &turned
        };
        let common = self.frame.product(&other.transpose());
        let mut lu = Lu::new(common.nrows());
        match lu.factor(|i, j| common[(i, j)]) {
            Ok(()) => lu.determinant().value().abs(),
            Err(_) => 0.0,
        }
    }

    fn determinant(&mut self, c: &Matrix) -> Determinant {
        let Some(saddle) = &mut self.saddle else {
            return Determinant::ZERO;
        };
        match saddle.factor(|k| c.row(self.kept[k]), &self.units) {
            Ok(()) => saddle.bordered(self.frame.as_slice()),
            Err(_) => Determinant::ZERO,
        }
    }
}

/// Returns an orthonormal basis of the null space of the rows, one vector in each row.
fn null_space(c: &Matrix, kept: &[usize]) -> Matrix {
    let qr = PivotedQr::of_rows(c.select_rows(kept));
    qr.q_columns(kept.len()..c.ncols()).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rotating row is bordered by its null space at angle 0.4. The determinant is the cosine of
    /// the angle between them.
    #[test]
    fn a_turning_row() {
        let c = |angle: f64| Matrix::from_rows(&[[angle.cos(), angle.sin()]]);
        let mut border = Border::new(&c(0.4), &[0]);
        for angle in [0.4, 1.0, 1.9, 2.5, 4.0] {
            let expected = (angle - 0.4_f64).cos();
            assert!((border.value(&c(angle)) - expected).abs() < 1e-15);
            let there = Border::new(&c(angle), &[0]);
            let overlap = border.overlap(&there, &c(angle));
            assert!((overlap - expected.abs()).abs() < 1e-15);
        }
        // Two rows that become parallel: the determinant is the sine of their angle.
        let c = |angle: f64| Matrix::from_rows(&[[1.0, 0.0], [angle.cos(), angle.sin()]]);
        let mut border = Border::new(&c(0.5), &[0, 1]);
        assert!((border.value(&c(-0.25)) + 0.25_f64.sin() / 0.5_f64.sin()).abs() < 1e-15);
        assert_eq!(border.value(&c(0.0)), 0.0);
    }
}
