//! Distinguishes the two sides of a singular configuration. C is bordered by a fixed basis of its
//! null space. The determinant of the bordered matrix changes its sign if the rows lose their rank
//! by one, even if no integration step ends at the singular configuration.

use super::KeptRowSaddle;
use crate::lu::Determinant;

impl KeptRowSaddle {
    /// Writes a basis of the null space of the factored rows. The basis consists of k = n − r
    /// vectors of length n, one after the other.
    ///
    /// # Panics
    /// Panics if the length of `frame` is not k·n.
    pub fn null_frame(&self, frame: &mut [f64]) {
        let (n, k) = (self.lu.n, self.lu.n - self.lu.r);
        assert_eq!(frame.len(), k * n, "a frame of {k} vectors of {n}");
        frame.fill(0.0);
        for i in 0..n {
            for entry in self.free.basis.of(i) {
                frame[entry.index() * n + i] = entry.value;
            }
        }
    }

    /// Returns the determinant of `[Cᵀ B]` for k vectors B, stored one after the other.
    ///
    /// With `P·Cᵀ = L·U` and the null space basis N, the determinant is `sign(P)·Π u_jj·det(Nᵀ·B)`.
    ///
    /// ```
    /// use pfaff_linalg::KeptRowSaddle;
    /// let determinant = |angle: f64| -> Result<f64, pfaff_linalg::SaddleError> {
    /// // The row rotates; the frame stays the x-axis. They are parallel at angle 0.
    ///     let c = [angle.cos(), angle.sin()];
    ///     let mut saddle = KeptRowSaddle::new(2, 1)?;
    ///     saddle.factor(|_| &c, &[1.0, 1.0])?;
    ///     Ok(saddle.bordered(&[1.0, 0.0]).value())
    /// };
    /// assert!((determinant(0.1)? + 0.1_f64.sin()).abs() < 1e-15);
    /// assert!((determinant(-0.2)? - 0.2_f64.sin()).abs() < 1e-15);
    /// # Ok::<(), pfaff_linalg::SaddleError>(())
    /// ```
    ///
    /// # Panics
    /// Panics if the length of `frame` is not k·n.
    pub fn bordered(&mut self, frame: &[f64]) -> Determinant {
        let (n, r) = (self.lu.n, self.lu.r);
        let k = n - r;
        assert_eq!(frame.len(), k * n, "a frame of {k} vectors of {n}");
        self.border.resize(k);
        self.product.clear();
        self.product.resize(k * k, 0.0);
        for i in 0..n {
            for entry in self.free.basis.of(i) {
                for l in 0..k {
                    self.product[entry.index() * k + l] += entry.value * frame[l * n + i];
                }
            }
        }
        let product = &self.product;
        let entry = |c: usize, l: usize| product[c * k + l];
        if self.border.factor(entry).is_err() {
            return Determinant::ZERO;
        }
        let (sign, log) = self.lu.determinant();
        let border = self.border.determinant();
        Determinant {
            sign: sign * border.sign,
            log: log + border.log,
        }
    }

    /// Returns the sign of [`KeptRowSaddle::bordered`]: +1, −1, or 0 if the determinant is zero.
    /// Only values for the same B and neighbouring C are comparable.
    ///
    /// # Panics
    /// Panics if the length of `frame` is not k·n.
    pub fn orientation(&mut self, frame: &[f64]) -> f64 {
        self.bordered(frame).sign
    }
}
