//! Solves the equations of motion at one state with dense matrices: `M·a + Cᵀ·λ = Q`, `C·a = Γ`.
//! The rank, the left null space of C and all solutions λ come from the singular values of the
//! scaled C. C, Γ, M and Q come from the mechanism, but this module uses no rank decision and no
//! verdict of the product.

use model::start::scene_size;
use model::{Mechanism, System};
use nalgebra::{DMatrix, DVector};

use super::decomposition::Decomposition;
use super::forms::Form;

/// Singular values below this fraction of the largest singular value count as zero. Singular values
/// of redundant rows are 1e-15 at exact states and 1e-11 at states that a run has written. Rows
/// with an offset of a ten-thousandth of the size have singular values above 1e-6.
const ZERO: f64 = 1e-9;

/// A singular value between these two fractions of the largest singular value means that the
/// configuration is near a configuration of lower rank. Near a configuration of lower rank no
/// result is returned.
const UNCLEAR: [f64; 2] = [1e-11, 1e-6];

/// Reason why there is no solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// A value is not finite.
    NotFinite,
    /// The configuration is near a configuration of lower rank.
    Unclear,
    /// A motion without mass is possible.
    Massless,
    /// Redundant rows require different accelerations, which differ by this fraction of the largest
    /// term.
    Contradiction(f64),
}

/// All solutions at one state.
pub struct Instant {
    /// The size of the mechanism (m).
    pub size: f64,
    /// The rank of C.
    pub rank: usize,
    /// The smallest nonzero singular value, divided by the largest singular value.
    pub sigma: f64,
    /// The largest applied or inertial load (N; torques divided by the size).
    pub load: f64,
    /// Factors of the rows.
    row_scale: Vec<f64>,
    /// The solution of least norm of the scaled rows.
    lambda: DVector<f64>,
    /// Accelerations (n_v).
    pub acceleration: Vec<f64>,
    /// The left null space of the scaled C, orthonormal columns.
    pub null: DMatrix<f64>,
}

impl Instant {
    /// Solves the equations at a state.
    ///
    /// # Errors
    /// Returns a [`Fault`] if there is no solution.
    pub fn new(mechanism: &Mechanism, (t, q, v): (f64, &[f64], &[f64])) -> Result<Self, Fault> {
        let layout = mechanism.layout();
        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.c(&mut s);
        mechanism.twist(v, &mut s);
        mechanism.gamma(&mut s);
        mechanism.force(&mut s);
        let (m, n, size) = (layout.rows(), layout.n_v, scene_size(mechanism, q));
        let column_scale = units(mechanism, size);
        let dense = layout.dense(&s);
        let mut c = DMatrix::from_fn(m, n, |i, j| dense[(i, j)] * column_scale[j]);
        let row_scale: Vec<f64> = (0..m).map(|i| inverse(c.row(i).norm())).collect();
        for i in 0..m {
            c.row_mut(i).scale_mut(row_scale[i]);
        }
        let mass: Vec<f64> = mechanism.mass().to_vec();
        let gamma = DVector::from_fn(m, |i, _| row_scale[i] * s.gamma[i]);
        let parts = Parts::of(&c)?;
        let a = parts.acceleration(&column_scale, &mass, &gamma, &s.force)?;
        let a: Vec<f64> = a.iter().zip(&column_scale).map(|(a, d)| a * d).collect();
        let inertial: Vec<f64> = mass.iter().zip(&a).map(|(m, a)| m * a).collect();
        let missing: Vec<f64> = s.force.iter().zip(&inertial).map(|(q, f)| q - f).collect();
        let scaled = DVector::from_fn(n, |j, _| column_scale[j] * missing[j]);
        Ok(Self {
            size,
            rank: parts.range.rank(),
            sigma: parts.sigma,
            load: largest(mechanism, &s.force, &column_scale).max(largest(
                mechanism,
                &inertial,
                &column_scale,
            )),
            lambda: parts.range.solve_transposed(&scaled),
            null: complement(&parts.range.left, m - parts.range.rank()),
            acceleration: a,
            row_scale,
        })
    }

    /// Returns the degree of redundancy.
    #[must_use]
    pub fn redundancy(&self) -> usize {
        self.null.ncols()
    }

    /// Returns the solution of least norm of the scaled rows.
    #[must_use]
    pub fn least(&self) -> &DVector<f64> {
        &self.lambda
    }

    /// Returns the coefficients of a form for the scaled multipliers.
    #[must_use]
    pub fn scaled(&self, form: &Form) -> DVector<f64> {
        let mut w = DVector::zeros(self.row_scale.len());
        for &(row, coefficient) in &form.coefficients {
            w[row] += coefficient * self.row_scale[row];
        }
        w
    }

    /// Returns how far a form is from being determined: the length of its part in the left null
    /// space, divided by the length of the longest form of its joint. This reference is used
    /// because the form of a component that is zero under any load consists of rounding errors.
    #[must_use]
    pub fn margin(&self, form: &Form, forms: &[Form]) -> f64 {
        let own = forms.iter().filter(|f| f.group == form.group);
        let longest = own.map(|f| self.scaled(f).norm()).fold(0.0, f64::max);
        (self.null.transpose() * self.scaled(form)).norm() * inverse(longest)
    }
}

/// The decomposition of the scaled C.
struct Parts {
    range: Decomposition,
    sigma: f64,
}

impl Parts {
    fn of(c: &DMatrix<f64>) -> Result<Self, Fault> {
        if c.iter().any(|x| !x.is_finite()) {
            return Err(Fault::NotFinite);
        }
        let all = Decomposition::of(c);
        let largest = inverse(all.values.first().copied().unwrap_or(0.0));
        let share = |x: &f64| x * largest;
        let is_unclear = |x: &f64| (UNCLEAR[0]..UNCLEAR[1]).contains(&share(x));
        if all.values.iter().any(is_unclear) {
            return Err(Fault::Unclear);
        }
        let range = all.above(ZERO);
        Ok(Self {
            sigma: range.values.last().map_or(1.0, share),
            range,
        })
    }

    /// Computes scaled accelerations as the sum of two parts: the part that `Γ` requires, and the
    /// part along free motions that balances all forces.
    fn acceleration(
        &self,
        scale: &[f64],
        mass: &[f64],
        gamma: &DVector<f64>,
        force: &[f64],
    ) -> Result<DVector<f64>, Fault> {
        let along = self.range.left.transpose() * gamma;
        let left_over = (gamma - &self.range.left * &along).norm();
        let n = scale.len();
        let required = self.range.solve(gamma);
        let most = gamma.norm().max(required.norm());
        if left_over > 1e-6 * most.max(1e-6) {
            return Err(Fault::Contradiction(left_over / most));
        }
        let free = complement(&self.range.right, n - self.range.rank());
        if free.ncols() == 0 {
            return Ok(required);
        }
        let mut heavy = free.clone();
        for j in 0..n {
            heavy.row_mut(j).scale_mut(mass[j] * scale[j] * scale[j]);
        }
        let unbalanced = DVector::from_fn(n, |j, _| {
            scale[j] * (force[j] - mass[j] * scale[j] * required[j])
        });
        let reduced = free.transpose() * &heavy;
        let solved = reduced.cholesky().ok_or(Fault::Massless)?;
        Ok(required + &free * solved.solve(&(free.transpose() * unbalanced)))
    }
}

/// Returns `count` orthonormal columns that are perpendicular to the given orthonormal columns. The
/// new columns are computed from the unit vectors with the smallest components along the given
/// columns.
fn complement(given: &DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let n = given.nrows();
    let mut rest = DMatrix::identity(n, n) - given * given.transpose();
    let mut found = DMatrix::zeros(n, count);
    for k in 0..count {
        let lengths: Vec<f64> = rest.column_iter().map(|c| c.norm()).collect();
        let best = (0..n).fold(0, |a, j| if lengths[j] > lengths[a] { j } else { a });
        let mut column = rest.column(best).into_owned();
        // The orthogonalisation is done twice, so that rounding errors leave no component along the
        // other columns.
        for _ in 0..2 {
            column -= given * (given.transpose() * &column);
            let before = found.columns(0, k);
            column -= before * (before.transpose() * &column);
        }
        column.normalize_mut();
        let shares = column.transpose() * &rest;
        rest -= &column * shares;
        found.set_column(k, &column);
    }
    found
}

/// Returns the units of velocities (1 m/s, and 1/size rad/s) by column.
pub(super) fn units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let turned = inverse(size);
    let layout = mechanism.layout();
    let unit = |j| {
        if layout.space.is_rotation(j) {
            turned
        } else {
            1.0
        }
    };
    (0..layout.n_v).map(unit).collect()
}

/// Returns 1/x, or 1 for zero.
pub(super) fn inverse(x: f64) -> f64 {
    if x > 0.0 { 1.0 / x } else { 1.0 }
}

/// Returns the largest magnitude of a force, or of a torque divided by the size, on a body.
/// Magnitudes of vectors are used because single components depend on the axes.
fn largest(mechanism: &Mechanism, load: &[f64], scale: &[f64]) -> f64 {
    let space = mechanism.space();
    let length =
        |columns: std::ops::Range<usize>| columns.map(|j| load[j] * scale[j]).fold(0.0, f64::hypot);
    let of_body = |body| length(space.translations_of(body)).max(length(space.rotations_of(body)));
    let bodies = 0..mechanism.bodies().len();
    bodies.map(of_body).fold(0.0, f64::max)
}
