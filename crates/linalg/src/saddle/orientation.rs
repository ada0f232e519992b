//! On which side of a singular configuration? The determinant of C bordered by a fixed frame of its
//! null space changes its sign where the rows lose their rank once, also if no step ends there.

use super::KeptRowSaddle;

impl KeptRowSaddle {
    /// Writes a basis of the null space of the factored rows, k = n − r vectors of n, one after the
    /// other.
    ///
    /// # Panics
    /// If `frame` has not k·n entries.
    pub fn null_frame(&self, frame: &mut [f64]) {
        let (n, r) = (self.n, self.r);
        assert_eq!(
            frame.len(),
            (n - r) * n,
            "a frame of {} vectors of {n}",
            n - r
        );
        frame.fill(0.0);
        for (c, vector) in frame.chunks_exact_mut(n.max(1)).enumerate() {
            for t in 0..r {
                vector[self.permutation[t]] = self.null_basis[c * r + t];
            }
            vector[self.permutation[r + c]] = 1.0;
        }
    }

    /// The sign of `det [Cᵀ B]` for k vectors B, one after the other: +1, −1, or 0 if they border
    /// nothing. Compare values for one B and neighbouring C only.
    ///
    /// With `P·Cᵀ = L·U` and the null space basis N it is `sign(P)·Π sign(u_jj)·sign det(Nᵀ·B)`.
    ///
    /// ```
    /// use linalg::KeptRowSaddle;
    /// let side = |angle: f64| -> Result<f64, linalg::SaddleError> {
    ///     // The row turns; the frame stays the x-axis. They are parallel at angle 0.
    ///     let c = [angle.cos(), angle.sin()];
    ///     let mut saddle = KeptRowSaddle::new(2, 1)?;
    ///     saddle.factor(|_| &c, &[1.0, 1.0])?;
    ///     Ok(saddle.orientation(&[1.0, 0.0]))
    /// };
    /// assert_eq!(side(0.1)?, -side(-0.1)?);
    /// assert_eq!(side(0.1)?, side(0.2)?);
    /// # Ok::<(), linalg::SaddleError>(())
    /// ```
    ///
    /// # Panics
    /// If `frame` has not k·n entries.
    pub fn orientation(&mut self, frame: &[f64]) -> f64 {
        let (n, r) = (self.n, self.r);
        let k = n - r;
        assert_eq!(frame.len(), k * n, "a frame of {k} vectors of {n}");
        for (c, row) in self.bordered[..k * k]
            .chunks_exact_mut(k.max(1))
            .enumerate()
        {
            for (x, b) in row.iter_mut().zip(frame.chunks_exact(n)) {
                let dependent = (0..r).map(|t| self.null_basis[c * r + t] * b[self.permutation[t]]);
                *x = b[self.permutation[r + c]] + dependent.sum::<f64>();
            }
        }
        let pivots: f64 = (0..r).map(|j| self.lu[j * n + j].signum()).product();
        self.parity * pivots * determinant_sign(&mut self.bordered, k)
    }
}

/// +1 for even permutations, −1 for odd ones.
pub(super) fn parity(p: &[usize]) -> f64 {
    let inversions: usize = (0..p.len())
        .map(|i| p[i + 1..].iter().filter(|&&x| x < p[i]).count())
        .sum();
    if inversions.is_multiple_of(2) {
        1.0
    } else {
        -1.0
    }
}

/// Sign of the determinant of a k×k matrix, by elimination with partial pivoting in place.
fn determinant_sign(a: &mut [f64], k: usize) -> f64 {
    let mut sign = 1.0;
    for j in 0..k {
        let larger = |p: usize, i: usize| {
            if a[i * k + j].abs() > a[p * k + j].abs() {
                i
            } else {
                p
            }
        };
        let at = (j..k).fold(j, larger);
        if at != j {
            for l in 0..k {
                a.swap(at * k + l, j * k + l);
            }
            sign = -sign;
        }
        let pivot = a[j * k + j];
        if pivot == 0.0 || pivot.is_nan() {
            return 0.0;
        }
        sign *= pivot.signum();
        for i in j + 1..k {
            let factor = a[i * k + j] / pivot;
            for l in j..k {
                a[i * k + l] -= factor * a[j * k + l];
            }
        }
    }
    sign
}
