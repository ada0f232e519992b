//! Iterative refinement. After a factorisation in double precision, the residual of the equations
//! is computed in double-double, and the equations are solved for the residual. The refinement is
//! repeated until the solution, which is also double-double, has all digits of an `f64`.
//!
//! One round multiplies the error by about the error of the factorisation, so one or two rounds are
//! enough. The refined solution belongs to the given C, M, f and γ; rounding errors in these data
//! remain. Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd edition,
//! chapter 12; the extended iterate after J. Demmel et al., Error bounds from extra-precise
//! iterative refinement, ACM TOMS 32 (2006) 325–351.

use super::KeptRowSaddle;
use super::error::{SaddleError, check_length};
use crate::Dd;
use crate::kernels::max_abs;
use crate::limits::{REFINEMENT_NOISE, REFINEMENT_ROUNDS, SETTLED};

/// Storage for the refinement of solutions of n coordinates and r rows.
#[derive(Debug, Clone)]
pub struct Refinement {
    a: Unknowns,
    lambda: Unknowns,
    /// Residual of the forces, `f − M·a − Cᵀ·λ`.
    force: Vec<Dd>,
    /// The residual of the forces and the residual `γ − C·a`, rounded to `f64`.
    f: Vec<f64>,
    gamma: Vec<f64>,
}

/// The iterate of a or of λ.
#[derive(Debug, Clone)]
struct Unknowns {
    x: Vec<Dd>,
    /// Change of each unknown in the present round.
    change: Vec<f64>,
    /// Size of the change in the previous round.
    before: Vec<f64>,
    /// Reference sizes for changes: the largest value of each unknown.
    size: Vec<f64>,
    /// Changes of at most this size are rounding.
    noise: f64,
}

impl Unknowns {
    fn new(n: usize) -> Self {
        Self {
            x: vec![Dd::ZERO; n],
            change: vec![0.0; n],
            before: vec![0.0; n],
            size: vec![0.0; n],
            noise: 0.0,
        }
    }

    /// Starts with the first solution, which is stored in `change`. `balanced` is the size of the
    /// terms whose sum determines the unknowns: the sum of balanced terms is their rounding.
    fn begin(&mut self, balanced: f64) {
        self.x.fill(Dd::ZERO);
        self.before.fill(0.0);
        self.size.fill(0.0);
        self.noise = REFINEMENT_NOISE * max_abs(&self.change).max(balanced);
        self.add();
    }

    /// Adds the change. Returns the largest change relative to the size of the unknown, or NaN. For
    /// an unknown that is zero except for rounding, the size is its rounding error.
    fn add(&mut self) -> f64 {
        let mut largest = 0.0;
        for (i, change) in self.change.iter().enumerate() {
            self.x[i] += Dd::from(*change);
            let by = change.abs();
            self.size[i] = self.size[i].max(by);
            let is_noise = by <= self.noise && self.before[i] <= self.noise;
            if by.is_nan() || !is_noise && by > largest * self.size[i] {
                largest = by / self.size[i];
            }
            self.before[i] = by;
        }
        largest
    }

    fn round_to(&self, x: &mut [f64]) {
        for (rounded, x) in x.iter_mut().zip(&self.x) {
            *rounded = x.to_f64();
        }
    }
}

impl Refinement {
    /// Allocates storage for n coordinates and r rows.
    pub fn new(n: usize, r: usize) -> Self {
        Self {
            a: Unknowns::new(n),
            lambda: Unknowns::new(r),
            force: vec![Dd::ZERO; n],
            f: vec![0.0; n],
            gamma: vec![0.0; r],
        }
    }
}

impl KeptRowSaddle {
    /// Works like [`KeptRowSaddle::solve`], but returns all digits that the given equations
    /// determine. The function does not allocate memory. The function takes two to three times the
    /// work of a factorisation. Most of this work is in double-double; see
    /// [`KeptRowSaddle::wants_refinement`].
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `row` | r calls | the rows of C, as in the last factorisation |
    /// | others | | as for [`KeptRowSaddle::solve`] |
    ///
    /// ```
    /// use pfaff_linalg::{KeptRowSaddle, Refinement};
    /// // Two carts tied together, 3 kg and 3e12 kg, with 6 N on the light one, almost all of which acts through the tie.
    /// let c = [1.0, -1.0];
    /// let mut saddle = KeptRowSaddle::new(2, 1)?;
    /// saddle.factor(|_| &c, &[3.0, 3e12])?;
    /// let (mut a, mut lambda) = ([0.0; 2], [0.0; 1]);
    /// saddle.solve_refined(&mut Refinement::new(2, 1), |_| &c, &[6.0, 0.0], &[0.0], &mut a, &mut lambda)?;
    /// assert_eq!(a, [6.0 / 3_000_000_000_003.0; 2]);
    /// assert_eq!(lambda, [18e12 / 3_000_000_000_003.0]);
    /// # Ok::<(), pfaff_linalg::SaddleError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowSaddle::solve`], and:
    /// - [`SaddleError::Length`]: the storage belongs to equations of another size.
    /// - [`SaddleError::Unrefined`]: the rounds do not converge.
    pub fn solve_refined<'c>(
        &mut self,
        refinement: &mut Refinement,
        row: impl Fn(usize) -> &'c [f64],
        f: &[f64],
        gamma: &[f64],
        a: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        check_length("refinement of a", &refinement.force, self.lu.n)?;
        check_length("refinement of lambda", &refinement.gamma, self.lu.n_rows())?;
        check_length("a", a, self.lu.n)?;
        check_length("lambda", lambda, self.lu.n_rows())?;
        let Refinement {
            a: to_a,
            lambda: to_lambda,
            ..
        } = refinement;
        self.solve(f, gamma, &mut to_a.change, &mut to_lambda.change)?;
        let masses = self.free.mass.iter();
        let each = masses.zip(f).filter(|(m, _)| **m > 0.0);
        to_a.begin(each.fold(0.0, |most: f64, (m, f)| most.max(f.abs() / m)));
        to_lambda.begin(0.0);

        let (mut rounds, mut before) = (0, 1.0);
        loop {
            self.find_residual(refinement, &row, f, gamma)?;
            let Refinement {
                a: to_a,
                lambda: to_lambda,
                f,
                gamma,
                ..
            } = refinement;
            self.solve(f, gamma, &mut to_a.change, &mut to_lambda.change)?;
            // The sum preserves NaN.
            let change = to_a.add() + to_lambda.add();
            rounds += 1;
            // The expected change of the next round is the change of this round times the ratio of
            // the two changes.
            if change * change <= SETTLED * before {
                to_a.round_to(a);
                to_lambda.round_to(lambda);
                return Ok(());
            }
            if rounds == REFINEMENT_ROUNDS {
                return Err(SaddleError::Unrefined { rounds, change });
            }
            before = change;
        }
    }

    /// Computes f − M·a − Cᵀ·λ and, for the rows in use, γ − C·a.
    fn find_residual<'c>(
        &self,
        refinement: &mut Refinement,
        row: &impl Fn(usize) -> &'c [f64],
        f: &[f64],
        gamma: &[f64],
    ) -> Result<(), SaddleError> {
        let Refinement {
            a, lambda, force, ..
        } = refinement;
        for (coordinate, &m) in self.free.mass.iter().enumerate() {
            force[coordinate] = Dd::from(f[coordinate]) - a.x[coordinate] * m;
        }
        for (inertia, columns, values) in self.free.added.rows() {
            let terms = columns.iter().zip(values);
            let rate = terms.fold(Dd::ZERO, |sum, (&j, g)| sum + a.x[j] * *g);
            for (&j, g) in columns.iter().zip(values) {
                force[j] -= rate * inertia * *g;
            }
        }
        refinement.gamma.fill(0.0);
        for &k in self.lu.used() {
            let c_k = row(k);
            let columns = self.lu.columns.of(k);
            check_length("row of C", c_k, columns.len())?;
            let mut left = Dd::from(gamma[k]);
            for (&i, &c) in columns.iter().zip(c_k).filter(|(_, c)| **c != 0.0) {
                let i = i as usize;
                left -= a.x[i] * c;
                force[i] -= lambda.x[k] * c;
            }
            refinement.gamma[k] = left.to_f64();
        }
        for (f, left) in refinement.f.iter_mut().zip(force) {
            *f = left.to_f64();
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Matrix;

    /// Returns a solver with factors for these rows and masses.
    fn factored(c: &Matrix, mass: &[f64]) -> KeptRowSaddle {
        let mut saddle = KeptRowSaddle::new(c.ncols(), c.nrows()).unwrap();
        saddle.factor(|k| c.row(k), mass).unwrap();
        saddle
    }

    /// Bound of the rounding of a zero in double-double if other values are as large as 2⁵³.
    const ZERO_LEFT: f64 = 1e-15 * f64::EPSILON;

    /// All values are integers below 2⁵³, so f = M·a + Cᵀ·λ and γ = C·a are exact: every bit of a
    /// and λ must be reproduced.
    #[test]
    fn whole_numbers_come_back_exactly() {
        const N: usize = 9;
        for seed in 0..40_i64 {
            let whole = |k: i64, most: i64| {
                ((k * k + 7 * k + 13 * seed * k + seed) % (2 * most + 1) - most) as f64
            };
            let r = 1 + seed as usize % 7;
            let c = Matrix::from_fn(r, N, |i, j| {
                if i == j {
                    11.0
                } else {
                    whole((i * N + j) as i64, 3)
                }
            });
            let mass: Vec<f64> = (0..N)
                .map(|j| 3.0 * 2_f64.powi((j as i32 * (seed as i32 + 5)) % 41))
                .collect();
            let a: Vec<f64> = (0..N).map(|j| whole(j as i64 + 100, 9)).collect();
            let lambda: Vec<f64> = (0..r).map(|j| whole(j as i64 + 200, 99)).collect();
            let gamma = c.times(&a);
            let f: Vec<f64> = (0..N)
                .map(|j| mass[j] * a[j] + (0..r).map(|i| c[(i, j)] * lambda[i]).sum::<f64>())
                .collect();
            let mut saddle = factored(&c, &mass);
            let (mut found_a, mut found_lambda) = (vec![0.0; N], vec![0.0; r]);
            let mut refinement = Refinement::new(N, r);
            saddle
                .solve_refined(
                    &mut refinement,
                    |k| c.row(k),
                    &f,
                    &gamma,
                    &mut found_a,
                    &mut found_lambda,
                )
                .unwrap();
            for (found, exact) in found_a
                .iter()
                .chain(&found_lambda)
                .zip(a.iter().chain(&lambda))
            {
                let is_exact = found == exact || *exact == 0.0 && found.abs() < ZERO_LEFT;
                assert!(is_exact, "seed {seed}: {found} instead of {exact}");
            }
        }
    }

    /// A ball joint carries a body exactly below it, so its acceleration is zero. Its weight and
    /// the force of the joint balance up to rounding, which is no acceleration that could be
    /// refined.
    #[test]
    fn balanced_forces_are_settled() {
        let mut refused = Vec::new();
        for k in 0..400_u32 {
            let d = [1, 2, 3].map(|n| f64::from(1 + (k * n) % 7));
            let mass = 1.0 + f64::from(k % 64) * f64::EPSILON;
            let inertia = mass / 600.0;
            let [x, y, z]: [f64; 3] = d;
            // The rows of a ball joint at −d: v − ω × d.
            let rows = [
                [1.0, 0.0, 0.0, 0.0, -z, y],
                [0.0, 1.0, 0.0, z, 0.0, -x],
                [0.0, 0.0, 1.0, -y, x, 0.0],
            ];
            let c = Matrix::from_fn(3, 6, |i, j| rows[i][j]);
            let mut saddle = factored(&c, &[mass, mass, mass, inertia, inertia, inertia]);
            let f = [mass * x, mass * y, mass * z, 0.0, 0.0, 0.0];
            let (mut a, mut lambda) = ([0.0; 6], [0.0; 3]);
            let found = saddle.solve_refined(
                &mut Refinement::new(6, 3),
                |k| c.row(k),
                &f,
                &[0.0; 3],
                &mut a,
                &mut lambda,
            );
            match found {
                Ok(()) => {
                    let left = a.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
                    // The product of mass and gravity is rounded.
                    assert!(left < 1e-11, "{k}: {a:?}");
                    assert!((lambda[0] - f[0]).abs() < 1e-14, "{k}: {lambda:?}");
                }
                Err(error) => refused.push((k, error)),
            }
        }
        assert!(
            refused.is_empty(),
            "{} of 400: {:?}",
            refused.len(),
            refused.first()
        );
    }

    /// Five carts are tied to each other, and a force acts at the end: a = F/Σm, and each tie
    /// transmits the force for the carts behind it. Plain solutions are accurate to rounding for
    /// any position of the heavy carts.
    #[test]
    fn light_coordinates_are_solved_for() {
        const N: usize = 5;
        let c = Matrix::from_fn(N - 1, N, |i, j| {
            f64::from(i8::from(i == j) - i8::from(i + 1 == j))
        });
        for heavy in [1e6, 1e-6, 1e12, 1e-12, 1e24, 1e-24] {
            for places in 0_u32..1 << N {
                let mass: Vec<f64> = (0..N)
                    .map(|j| if places >> j & 1 == 1 { heavy } else { 1.0 })
                    .collect();
                let mut f = [0.0; N];
                f[0] = 7.0;
                let (mut a, mut lambda) = ([0.0; N], [0.0; N - 1]);
                let mut saddle = factored(&c, &mass);
                saddle
                    .solve(&f, &[0.0; N - 1], &mut a, &mut lambda)
                    .unwrap();
                let total: f64 = mass.iter().sum();
                for j in 0..N {
                    assert!(
                        (a[j] / (7.0 / total) - 1.0).abs() < 1e-14,
                        "{mass:?}: {a:?}"
                    );
                }
                for i in 0..N - 1 {
                    let carried = 7.0 * (mass[i + 1..].iter().sum::<f64>() / total);
                    assert!(
                        (lambda[i] / carried - 1.0).abs() < 1e-14,
                        "{mass:?}: {lambda:?}"
                    );
                }
            }
        }
    }

    /// A value that is exactly zero in a plain solution is a rounding error of double-double
    /// numbers in a refined solution. This error must not prevent convergence.
    #[test]
    fn unknowns_that_are_zero_do_not_keep_others_waiting() {
        // The first two rows fix x and y. The third and fourth rows connect z and w to x and y by
        // coefficients without an exact binary representation.
        let c = Matrix::from_rows(&[
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [0.1, 0.3, 0.0, 0.0, 0.0],
            [0.7, 0.1, 0.3, 0.0, 0.0],
            [0.1, 0.7, 1.1, 0.9, 0.0],
        ]);
        let mut saddle = factored(&c, &[1.0, 3.0, 1e-7, 0.3, 1e3]);
        let mut refinement = Refinement::new(5, 4);
        for gamma in [[3e-9, 3e-10, 2.1e-9, 3e-10], [0.1, 0.01, 0.07, 0.01]] {
            let (mut a, mut lambda) = ([0.0; 5], [0.0; 4]);
            saddle
                .solve_refined(
                    &mut refinement,
                    |k| c.row(k),
                    &[0.0; 5],
                    &gamma,
                    &mut a,
                    &mut lambda,
                )
                .unwrap();
            assert!(
                (a[0] / gamma[0] - 1.0).abs() < f64::EPSILON && a[4].abs() < 1e-30,
                "{a:?}"
            );
        }
    }

    #[test]
    fn refinement_is_wanted_where_digits_are_lost() {
        let c = Matrix::from_rows(&[[1.0, -1.0]]);
        assert!(!factored(&c, &[1.0, 0.99e6]).wants_refinement());
        assert!(factored(&c, &[1.0, 1.01e6]).wants_refinement());
        assert!(!factored(&c, &[1.0, 0.0]).wants_refinement());
        // The free coordinates are x and y. Without the heavy z, they hardly move relative to each
        // other.
        let c = Matrix::from_rows(&[[1.0, 1.0, 1.0]]);
        let mut saddle = KeptRowSaddle::new(3, 1).unwrap();
        saddle.partition(&[2]).unwrap();
        // After elimination, (1 + 2·m)/(1 + m) remains of 1 + m.
        for (heavy, wants) in [(1.9e3, false), (2.1e3, true), (1e5, true)] {
            saddle.factor(|k| c.row(k), &[1.0, 1.0, heavy]).unwrap();
            assert_eq!(saddle.wants_refinement(), wants);
        }
    }

    #[test]
    fn rounds_that_do_not_converge_are_named() {
        let rows = Matrix::from_rows(&[[1.0, -1.0, 0.0]]);
        let mut saddle = factored(&rows, &[1.0; 3]);
        let other = [1.0, 3.0, 0.5];
        let (mut a, mut lambda) = ([7.0; 3], [7.0]);
        let error = saddle
            .solve_refined(
                &mut Refinement::new(3, 1),
                |_| &other,
                &[1.0, 2.0, 3.0],
                &[1.0],
                &mut a,
                &mut lambda,
            )
            .unwrap_err();
        assert!(
            matches!(
                error,
                SaddleError::Unrefined {
                    rounds: REFINEMENT_ROUNDS,
                    ..
                }
            ),
            "{error}"
        );
        assert_eq!((a, lambda), ([7.0; 3], [7.0]));
        let text = error.to_string();
        assert!(
            text.starts_with("refinement of the solution does not converge: after 8 rounds"),
            "{text}"
        );
    }

    #[test]
    fn storage_of_another_size_is_refused() {
        let rows = Matrix::from_rows(&[[1.0, -1.0]]);
        let mut saddle = factored(&rows, &[1.0; 2]);
        let error = saddle
            .solve_refined(
                &mut Refinement::new(3, 1),
                |k| rows.row(k),
                &[0.0; 2],
                &[0.0],
                &mut [0.0; 2],
                &mut [0.0],
            )
            .unwrap_err();
        assert_eq!(error.to_string(), "refinement of a has 3 entries, need 2");
    }
}
