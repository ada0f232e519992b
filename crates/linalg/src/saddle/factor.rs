//! Factorisation: LU of Cᵀ row by row, null space basis, reduced mass.

use super::{
    GRADED_MASSES, KeptRowSaddle, SaddleError, State, check_finite, check_length, mass_spread,
};
use crate::kernels::{axpy, dot, extremes, max_abs};

/// A pivot below this fraction of its row is rounding noise, whatever the configuration.
const PIVOT_FLOOR: f64 = 16.0 * f64::EPSILON;

/// Where some masses are zero, the others are graded from this spread on: nothing of a massless
/// coordinate's own is left in NᵀMN to stand against what cancels there. Below it pivots by mass
/// would only be smaller.
const GRADED_BESIDE_MASSLESS: f64 = 1e3;

/// Graded masses choose among the entries above this share of the largest one: multipliers of the
/// elimination stay below its inverse.
const CANDIDATE: f64 = 0.1;

/// What became of a row.
enum Elimination {
    Used,
    /// It depends on the rows before: its largest entry left, and the largest at first.
    Dependent {
        pivot: f64,
        scale: f64,
    },
}

impl KeptRowSaddle {
    /// Factors for the kept rows of C and the masses.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `row` | r calls, each n | `row(k)` is the k-th kept row of C |
    /// | `mass` | n | diagonal of M, entries ≥ 0 |
    ///
    /// Cost about n·r² + k·r²/2 + k²·r/2 multiplications; allocates nothing unless it fails.
    /// After an error the solver holds no factorisation.
    ///
    /// # Errors
    /// - [`SaddleError::Length`], [`SaddleError::NonFinite`], [`SaddleError::NegativeMass`]: bad
    ///   input.
    /// - [`SaddleError::RankLost`]: a row depends on the ones before it to working precision.
    /// - [`SaddleError::MasslessMotion`]: M is not positive definite on ker C; carries the motion.
    pub fn factor<'c>(
        &mut self,
        row: impl Fn(usize) -> &'c [f64],
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        self.prepare(mass)?;
        for j in 0..self.rows {
            if let Elimination::Dependent { pivot, scale } =
                self.eliminate(j, row(j), mass, PIVOT_FLOOR)?
            {
                return Err(SaddleError::RankLost {
                    row: j,
                    pivot,
                    scale,
                });
            }
        }
        self.finish(row, mass)
    }

    /// As [`KeptRowSaddle::factor`], but a row whose pivot is at most `floor` of its largest entry
    /// is left out: where rows are dependent for an instant, the others determine the solution. The
    /// multiplier of a row left out is zero, and its equation does not hold.
    ///
    /// ```
    /// use linalg::KeptRowSaddle;
    /// let rows = [[1.0, 0.0], [1.0, 1e-9]];
    /// let mut saddle = KeptRowSaddle::new(2, 2)?;
    /// saddle.factor_above(1e-6, |k| &rows[k], &[1.0, 1.0])?;
    /// let (mut a, mut lambda) = ([0.0; 2], [0.0; 2]);
    /// saddle.solve(&[3.0, 5.0], &[2.0, 7.0], &mut a, &mut lambda)?;
    /// assert_eq!((a, lambda, saddle.n_left_out()), ([2.0, 5.0], [1.0, 0.0], 1));
    /// # Ok::<(), linalg::SaddleError>(())
    /// ```
    ///
    /// # Errors
    /// As [`KeptRowSaddle::factor`], without [`SaddleError::RankLost`].
    pub fn factor_above<'c>(
        &mut self,
        floor: f64,
        row: impl Fn(usize) -> &'c [f64],
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        self.prepare(mass)?;
        for j in 0..self.rows {
            self.eliminate(j, row(j), mass, floor.max(PIVOT_FLOOR))?;
        }
        self.finish(row, mass)
    }

    fn prepare(&mut self, mass: &[f64]) -> Result<(), SaddleError> {
        self.state = State::Empty;
        check_length("mass", mass, self.n)?;
        check_finite("mass", mass, 0)?;
        let [lightest, heaviest] = extremes(mass);
        if let (true, Some(index)) = (lightest < 0.0, mass.iter().position(|&m| m < 0.0)) {
            return Err(SaddleError::NegativeMass {
                index,
                value: mass[index],
            });
        }
        self.mass_spread = match lightest > 0.0 {
            true => heaviest / lightest,
            false => mass_spread(mass),
        };
        let from = match lightest > 0.0 {
            true => GRADED_MASSES,
            false => GRADED_BESIDE_MASSLESS,
        };
        self.is_graded = self.mass_spread >= from;
        self.permutation.copy_from_slice(&self.order);
        for (i, &coordinate) in self.order.iter().enumerate() {
            self.place[coordinate] = i;
        }
        self.is_in_order = true;
        self.parity = self.order_parity;
        self.pivot_ratio = f64::INFINITY;
        self.r = 0;
        Ok(())
    }

    fn finish<'c>(
        &mut self,
        row: impl Fn(usize) -> &'c [f64],
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        for (m, &coordinate) in self.mass.iter_mut().zip(&self.permutation) {
            *m = mass[coordinate];
        }
        self.fill_null_basis();
        self.factor_reduced_mass(row)?;
        self.state = State::Factored;
        Ok(())
    }

    /// The next column of U and of L from a row of C: gather, eliminate with the rows before,
    /// pivot.
    fn eliminate(
        &mut self,
        row: usize,
        c_j: &[f64],
        mass: &[f64],
        floor: f64,
    ) -> Result<Elimination, SaddleError> {
        let (n, j) = (self.n, self.r);
        check_length("row of C", c_j, n)?;
        let (before, rest) = self.lu.split_at_mut(j * n);
        let x = &mut rest[..n];
        x.fill(0.0);
        // x·0 is NaN exactly for NaN and infinities.
        let (mut scale, mut zero) = (0.0_f64, 0.0);
        for &column in self.columns.of(row) {
            let c = c_j[column];
            x[self.place[column]] = c;
            zero += c * 0.0;
            scale = if c.abs() > scale { c.abs() } else { scale };
        }
        if zero != 0.0 {
            check_finite("C", c_j, row * n)?;
        }
        // As long as rows are solved for the coordinates of the order, their entries are those of
        // the lists.
        let below = match row == j && self.is_in_order {
            true => {
                for &k in self.fill.upper.of(j) {
                    let (u_kj, l_k) = (x[k], &before[k * n..(k + 1) * n]);
                    for &i in self.fill.lower.of(k) {
                        x[i] -= u_kj * l_k[i];
                    }
                }
                Some(self.fill.lower.of(j))
            }
            false => {
                for (k, l_k) in before.chunks_exact(n).enumerate() {
                    let u_kj = x[k];
                    if u_kj != 0.0 {
                        axpy(-u_kj, &l_k[k + 1..], &mut x[k + 1..]);
                    }
                }
                None
            }
        };

        let at = match (self.is_graded, below) {
            (false, Some(below)) => {
                let (mut at, mut largest) = (j, max_abs(&x[j..=j]));
                for &i in below {
                    if i < self.solvable && x[i].abs() > largest {
                        (at, largest) = (i, x[i].abs());
                    }
                }
                Some(at)
            }
            (false, None) => {
                // No entry is the largest one if all are NaN.
                let largest = max_abs(&x[j..self.solvable]);
                (j..self.solvable).find(|&i| x[i].abs() == largest)
            }
            (true, _) => {
                let largest = max_abs(&x[j..self.solvable]);
                let candidates = (j..self.solvable).filter(|&i| x[i].abs() >= CANDIDATE * largest);
                let mass = |i: usize| mass[self.permutation[i]];
                // Compares c²/m without quotients: masses may be zero.
                candidates.reduce(|a, b| match x[b] * x[b] * mass(a) > x[a] * x[a] * mass(b) {
                    true => b,
                    false => a,
                })
            }
        };
        let at = at.unwrap_or(j);
        let pivot = x[at];
        if scale > 0.0 {
            self.pivot_ratio = self.pivot_ratio.min(pivot.abs() / scale);
        }
        if pivot.is_nan() || pivot.abs() <= floor * scale {
            return Ok(Elimination::Dependent {
                pivot: pivot.abs(),
                scale,
            });
        }
        self.used[j] = row;
        self.r += 1;
        if at != j {
            self.permutation.swap(at, j);
            self.place[self.permutation[at]] = at;
            self.place[self.permutation[j]] = j;
            x.swap(at, j);
            for l_k in before.chunks_exact_mut(n) {
                l_k.swap(at, j);
            }
            self.is_in_order = false;
            self.parity = -self.parity;
        }
        let inverse = 1.0 / pivot;
        self.inverse[j] = inverse;
        for l in &mut x[j + 1..] {
            *l *= inverse;
        }
        Ok(Elimination::Used)
    }

    /// Solves `L₁ᵀ·Y = −L₂ᵀ` column by column.
    fn fill_null_basis(&mut self) {
        let (n, r) = (self.n, self.r);
        if r == 0 {
            return;
        }
        for (c, y) in self.null_basis[..(n - r) * r]
            .chunks_exact_mut(r)
            .enumerate()
        {
            for t in (0..r).rev() {
                let l_t = &self.lu[t * n..(t + 1) * n];
                y[t] = -l_t[r + c] - dot(&l_t[t + 1..r], &y[t + 1..r]);
            }
        }
    }

    /// Cholesky factorisation of `NᵀMN` without roots, L·D·Lᵀ.
    fn factor_reduced_mass<'c>(
        &mut self,
        row: impl Fn(usize) -> &'c [f64],
    ) -> Result<(), SaddleError> {
        let (r, k) = (self.r, self.n - self.r);
        let heaviest = max_abs(&self.mass);
        // What cancels in NᵀMN, and what rounding of N, which has no rounding in the free
        // coordinates, turns from zero into mass.
        let cancelled = k as f64 * f64::EPSILON;
        let spurious = (self.n as f64 * f64::EPSILON).powi(2) * max_abs(&self.mass[..r]);
        self.mass_ratio = f64::INFINITY;
        for i in 0..k {
            let y_i = &self.null_basis[i * r..(i + 1) * r];
            let (above, rest) = self.reduced_mass.split_at_mut(i * k);
            let l_i = &mut rest[..k];
            for j in 0..=i {
                let y_j = &self.null_basis[j * r..(j + 1) * r];
                l_i[j] = y_i
                    .iter()
                    .zip(y_j)
                    .zip(&self.mass)
                    .map(|((a, b), m)| a * m * b)
                    .sum();
            }
            l_i[i] += self.mass[r + i];
            let size = l_i[i];
            // First v_j = l_ij·d_j, then l_ij: L has a unit diagonal, d sits in its place.
            for j in 0..i {
                l_i[j] -= dot(&l_i[..j], &above[j * k..j * k + j]);
            }
            let mut reduced = size;
            for j in 0..i {
                let v_j = l_i[j];
                l_i[j] /= above[j * k + j];
                reduced -= v_j * l_i[j];
            }
            let floor =
                |share: f64| (cancelled * size).max(spurious * (share * share + dot(y_i, y_i)));
            let is_lost = reduced <= floor(1.0) && {
                // What a coordinate has in the rows, rounding of its null vector is relative to.
                let rows = self.used[..r].iter().map(|&j| row(j));
                let share = |c: &[f64]| c[self.permutation[r + i]].abs() / max_abs(c);
                reduced <= floor(rows.map(share).fold(0.0, f64::max))
            };
            if reduced.is_nan() || is_lost {
                return Err(SaddleError::MasslessMotion {
                    reduced,
                    size: size.max(heaviest),
                    motion: self.massless_motion(i),
                });
            }
            self.mass_ratio = self.mass_ratio.min(reduced / size);
            l_i[i] = reduced;
        }
        Ok(())
    }

    /// The motion `N·z` with `z = [−L₁₁⁻ᵀ·l_i; 1; 0]` that the failed pivot i stands for.
    fn massless_motion(&self, i: usize) -> Vec<f64> {
        let (r, k) = (self.r, self.n - self.r);
        let mut z = vec![0.0; k];
        z[i] = 1.0;
        for j in 0..i {
            z[j] = -self.reduced_mass[i * k + j];
        }
        for j in (0..i).rev() {
            let z_j = z[j];
            axpy(-z_j, &self.reduced_mass[j * k..j * k + j], &mut z[..j]);
        }
        let mut y = vec![0.0; self.n];
        for (c, &z_c) in z.iter().enumerate() {
            axpy(z_c, &self.null_basis[c * r..(c + 1) * r], &mut y[..r]);
            y[r + c] = z_c;
        }
        let largest = max_abs(&y);
        let mut motion = vec![0.0; self.n];
        for (&coordinate, y_i) in self.permutation.iter().zip(&y) {
            motion[coordinate] = y_i / largest;
        }
        motion
    }
}
