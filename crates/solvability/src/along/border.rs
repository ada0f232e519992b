//! A signed function of time that vanishes where kept rows lose their rank: the determinant of
//! these rows, bordered by a frozen frame of the motions that they allow at one instant. Rows and
//! frame are frozen, so it is as smooth as the motion.

use linalg::{Matrix, PivotedQr};

/// Rows and frame of one instant.
pub(super) struct Border {
    kept: Vec<usize>,
    /// Rows: the frame.
    frame: Matrix,
    /// Sign and logarithm of the determinant at the instant.
    reference: (f64, f64),
}

impl Border {
    /// Freezes these rows of `c` and a frame of their null space.
    pub(super) fn new(c: &Matrix, kept: &[usize]) -> Self {
        let mut border = Self {
            kept: kept.to_vec(),
            frame: null_space(c, kept),
            reference: (1.0, 0.0),
        };
        border.reference = border.determinant(c);
        border
    }

    /// The determinant at another instant, relative to that where it was frozen: 1 there.
    pub(super) fn value(&self, c: &Matrix) -> f64 {
        let (sign, log) = self.determinant(c);
        sign * self.reference.0 * (log - self.reference.1).exp()
    }

    /// Volume of the frame in the null space of the same rows elsewhere: 1 where it has not turned.
    pub(super) fn overlap(&self, c: &Matrix) -> f64 {
        let other = null_space(c, &self.kept);
        determinant(self.frame.product(&other.transpose())).1.exp()
    }

    fn determinant(&self, c: &Matrix) -> (f64, f64) {
        let (r, n) = (self.kept.len(), c.ncols());
        determinant(Matrix::from_fn(n, n, |i, j| match i.checked_sub(r) {
            Some(k) => self.frame[(k, j)],
            None => c[(self.kept[i], j)],
        }))
    }
}

/// An orthonormal basis of the null space of rows, one vector in each row.
fn null_space(c: &Matrix, kept: &[usize]) -> Matrix {
    let qr = PivotedQr::of_rows(c.select_rows(kept));
    qr.q_columns(kept.len()..c.ncols()).transpose()
}

/// Sign and logarithm of the determinant, by elimination with partial pivoting: (0, −∞) for a
/// singular matrix.
fn determinant(mut a: Matrix) -> (f64, f64) {
    let n = a.nrows();
    let (mut sign, mut log) = (1.0, 0.0);
    for j in 0..n {
        let larger = |p: usize, i: usize| {
            if a[(i, j)].abs() > a[(p, j)].abs() {
                i
            } else {
                p
            }
        };
        let at = (j..n).fold(j, larger);
        if at != j {
            a.swap_rows(at, j);
            sign = -sign;
        }
        let pivot = a[(j, j)];
        if pivot == 0.0 {
            return (0.0, f64::NEG_INFINITY);
        }
        sign *= pivot.signum();
        log += pivot.abs().ln();
        for i in j + 1..n {
            let factor = a[(i, j)] / pivot;
            for l in j..n {
                a[(i, l)] -= factor * a[(j, l)];
            }
        }
    }
    (sign, log)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row that turns, bordered by what it allowed at angle 0.4: the determinant is the cosine of
    /// the angle between them.
    #[test]
    fn a_turning_row() {
        let c = |angle: f64| Matrix::from_rows(&[[angle.cos(), angle.sin()]]);
        let border = Border::new(&c(0.4), &[0]);
        for angle in [0.4, 1.0, 1.9, 2.5, 4.0] {
            let expected = (angle - 0.4_f64).cos();
            assert!((border.value(&c(angle)) - expected).abs() < 1e-15);
            assert!((border.overlap(&c(angle)) - expected.abs()).abs() < 1e-15);
        }
        // Two rows that become parallel: the sine.
        let c = |angle: f64| Matrix::from_rows(&[[1.0, 0.0], [angle.cos(), angle.sin()]]);
        let border = Border::new(&c(0.5), &[0, 1]);
        assert!((border.value(&c(-0.25)) + 0.25_f64.sin() / 0.5_f64.sin()).abs() < 1e-15);
        assert_eq!(border.value(&c(0.0)), 0.0);
    }
}
