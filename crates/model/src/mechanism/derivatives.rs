//! Derivatives of the equations of motion, assembled from the derivative kernels of joints and
//! forces. Implicit methods and sensitivities need them, but explicit methods do not.
//!
//! All derivatives are directional derivatives along the velocity components, so every block has
//! n_v columns. `∂/∂q` means the derivative with respect to a displacement along each velocity
//! component.

use super::{ForceWithoutDerivatives, Mechanism};
use crate::element::Rates;
use crate::space::SpaceKind;
use crate::system::Scratch;

/// Derivatives at one instant, and the storage for them.
#[derive(Clone, Debug)]
pub struct Derivatives {
    /// Derivative of the forces, `∂Q/∂q`, n_v × n_v, without armatures.
    pub force_dq: Sparse,
    /// Derivative of the forces, `∂Q/∂v`, n_v × n_v, without armatures.
    pub force_dv: Sparse,
    /// Derivative of the loads of armatures, `∂(−gᵀ·a·s̈)/∂q`, n_v × n_v, at fixed accelerations.
    pub armature_dq: Sparse,
    /// Derivative of the loads of armatures, `∂(−gᵀ·a·s̈)/∂v`, n_v × n_v.
    pub armature_dv: Sparse,
    /// Derivative of the reactions, `∂(Cᵀ·λ)/∂q`, n_v × n_v.
    pub reaction_dq: Sparse,
    /// Derivative of the acceleration residuals, `∂(C·a − Γ)/∂q`, (m + h) × n_v.
    pub residual_dq: Sparse,
    /// Derivative of Γ, `∂Γ/∂v`, (m + h) × n_v.
    pub gamma_dv: Sparse,
    /// Derivative of the velocity residuals, `∂(C·v − b)/∂q`, (m + h) × n_v.
    pub velocity_dq: Sparse,
    /// Accelerations of the bodies of each element.
    slots: Rates,
    /// Multipliers of one constraint.
    own_lambda: Vec<f64>,
}

/// A matrix stored as a list of entries that are added. The entries are ordered by the elements of
/// the mechanism. The pattern is fixed.
#[derive(Clone, Debug, Default)]
pub struct Sparse {
    /// Row, column and index of the value; entries in columns of the ground are omitted.
    entries: Vec<(usize, usize, usize)>,
    values: Vec<f64>,
}

impl Sparse {
    /// Computes `y ← y + A·x`.
    ///
    /// # Panics
    /// Panics if a row or column of the matrix is outside `y` or `x`.
    pub fn add_product(&self, x: &[f64], y: &mut [f64]) {
        for (row, column, value) in self.iter() {
            y[row] += value * x[column];
        }
    }

    /// Computes `y ← y − A·x`.
    ///
    /// # Panics
    /// Panics under the same conditions as [`Sparse::add_product`].
    pub fn subtract_product(&self, x: &[f64], y: &mut [f64]) {
        for (row, column, value) in self.iter() {
            y[row] -= value * x[column];
        }
    }

    /// Returns the row, column and value of each entry. A pair of row and column may occur several
    /// times. In this case the values must be added.
    pub fn iter(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        self.entries
            .iter()
            .map(|&(row, column, at)| (row, column, self.values[at]))
    }

    /// Adds entries for one more block.
    fn push_block(
        &mut self,
        pattern: &[[usize; 2]],
        row: impl Fn(usize) -> Option<usize>,
        column: impl Fn(usize) -> Option<usize>,
    ) {
        let first = self.values.len();
        self.values.resize(first + pattern.len(), 0.0);
        for (k, &[i, j]) in pattern.iter().enumerate() {
            if let (Some(row), Some(column)) = (row(i), column(j)) {
                self.entries.push((row, column, first + k));
            }
        }
    }

    /// Returns the values of the blocks in sequence.
    fn blocks<'s>(&'s mut self) -> impl FnMut(usize) -> &'s mut [f64] {
        let mut rest = self.values.as_mut_slice();
        move |n| {
            let (block, tail) = std::mem::take(&mut rest).split_at_mut(n);
            rest = tail;
            block
        }
    }
}

impl Derivatives {
    /// Allocates the derivatives of a mechanism; the values are zero.
    ///
    /// # Errors
    /// Returns an error if a force or a force law uses a callback, which has no derivatives.
    pub fn of(mechanism: &Mechanism) -> Result<Self, ForceWithoutDerivatives> {
        let [force_dq, force_dv] = force_patterns(mechanism)?;
        Ok(Self {
            force_dq,
            force_dv,
            ..Self::of_constraints(mechanism)
        })
    }

    /// Works like [`Derivatives::of`], without the applied forces: `∂Q/∂q` and `∂Q/∂v` have no
    /// entries.
    #[must_use]
    pub fn of_constraints(mechanism: &Mechanism) -> Self {
        let mut d = Self {
            force_dq: Sparse::default(),
            force_dv: Sparse::default(),
            armature_dq: Sparse::default(),
            armature_dv: Sparse::default(),
            reaction_dq: Sparse::default(),
            residual_dq: Sparse::default(),
            gamma_dv: Sparse::default(),
            velocity_dq: Sparse::default(),
            slots: Rates::zero(mechanism.space(), mechanism.elements.n_slots),
            own_lambda: Vec::new(),
        };
        for c in &mechanism.elements.constraints {
            let spec = c.spec();
            let column = |k: usize| c.site.column(k);
            let row = |i: usize| Some(c.rows.row(i));
            d.reaction_dq.push_block(spec.d_force_dx, column, column);
            d.residual_dq.push_block(spec.d_residual_dx, row, column);
            d.gamma_dv.push_block(spec.d_gamma_dv, row, column);
            d.velocity_dq.push_block(spec.d_velocity_dx, row, column);
        }
        for armature in &mechanism.elements.armatures {
            let column = |k: usize| armature.site.column(k);
            for matrix in [&mut d.armature_dq, &mut d.armature_dv] {
                matrix.push_block(armature.pairs(), column, column);
            }
        }
        d
    }

    /// Computes the derivatives at the configuration and the velocities in the work space, for
    /// accelerations `a` (n_v) and multipliers `lambda` (m + h). The function does not allocate
    /// memory.
    ///
    /// ```
    /// use joints::Revolute;
    /// use pfaff_model::{Body, BodyRef, Derivatives, Description, Joint, Mechanism, System};
    /// // A pendulum of length 2: Γ_y = −R_j·s_j·φ̇² = −2·φ̇², so ∂Γ_y/∂φ̇ = −4·φ̇.
    /// let bob = Body { name: "bob".into(), mass: 1.0, inertia: 0.1, ..Body::default() };
    /// let pivot = Revolute { s_i: [0.0, 0.0], s_j: [0.0, 2.0] };
    /// let pendulum = Description {
    ///     bodies: vec![bob],
    ///     joints: vec![Joint::new("pivot", &[BodyRef::Ground, BodyRef::Body(0)], pivot)],
    ///     ..Description::default()
    /// };
    /// let mechanism = Mechanism::build(&pendulum).unwrap();
    /// let (mut s, mut d) = (mechanism.scratch(), Derivatives::of(&mechanism)?);
    /// mechanism.pose(0.0, &[0.0, -2.0, 0.0], &mut s);
    /// mechanism.twist(&[6.0, 0.0, 3.0], &mut s);
    /// d.differentiate(&mechanism, &[0.0; 3], &[0.0; 2], &s);
    /// let mut gamma = [0.0; 2];
    /// d.gamma_dv.add_product(&[0.0, 0.0, 1.0], &mut gamma);
    /// assert_eq!(gamma, [0.0, -12.0]);
    /// # Ok::<(), pfaff_model::ForceWithoutDerivatives>(())
    /// ```
    ///
    /// # Panics
    /// Panics if a slice is too short, or if the derivatives were allocated for another mechanism.
    pub fn differentiate(&mut self, mechanism: &Mechanism, a: &[f64], lambda: &[f64], s: &Scratch) {
        self.differentiate_constraints(mechanism, a, lambda, s);
        differentiate_forces(mechanism, s, [&mut self.force_dq, &mut self.force_dv]);
    }

    /// Works like [`Derivatives::differentiate`], but only for the constraints and the armatures.
    /// The function does not allocate memory.
    ///
    /// # Panics
    /// Panics under the same conditions as [`Derivatives::differentiate`].
    pub fn differentiate_constraints(
        &mut self,
        mechanism: &Mechanism,
        a: &[f64],
        lambda: &[f64],
        s: &Scratch,
    ) {
        self.slots.take(mechanism.elements.sites(), a);
        let mut reaction_dq = self.reaction_dq.blocks();
        let mut residual_dq = self.residual_dq.blocks();
        let mut gamma_dv = self.gamma_dv.blocks();
        let mut velocity_dq = self.velocity_dq.blocks();
        for c in &mechanism.elements.constraints {
            let (spec, s) = (c.spec(), &s.slots);
            let lambda = c.rows.of(lambda, &mut self.own_lambda);
            c.d_force_dx(s, lambda, reaction_dq(spec.d_force_dx.len()));
            c.d_residual_dx(s, &self.slots, residual_dq(spec.d_residual_dx.len()));
            c.d_gamma_dv(s, gamma_dv(spec.d_gamma_dv.len()));
            c.d_velocity_dx(s, velocity_dq(spec.d_velocity_dx.len()));
        }
        let (mut by_q, mut by_v) = (self.armature_dq.blocks(), self.armature_dv.blocks());
        for armature in &mechanism.elements.armatures {
            let n = armature.pairs().len();
            armature.derivatives(&s.slots, &self.slots, [by_q(n), by_v(n)]);
        }
    }

    /// Computes only `∂Q/∂q` and `∂Q/∂v`, at the configuration and the velocities in the work
    /// space, without armatures. The function allocates memory.
    ///
    /// # Errors
    /// Returns the same errors as [`Derivatives::of`].
    pub fn of_forces(
        mechanism: &Mechanism,
        s: &Scratch,
    ) -> Result<[Sparse; 2], ForceWithoutDerivatives> {
        let [mut by_q, mut by_v] = force_patterns(mechanism)?;
        differentiate_forces(mechanism, s, [&mut by_q, &mut by_v]);
        Ok([by_q, by_v])
    }
}

/// Allocates `∂Q/∂q` and `∂Q/∂v` if all forces have derivatives.
fn force_patterns(mechanism: &Mechanism) -> Result<[Sparse; 2], ForceWithoutDerivatives> {
    mechanism
        .applied_forces()
        .without_derivatives()
        .next()
        .map_or(Ok(()), Err)?;
    let mut patterns = [Sparse::default(), Sparse::default()];
    for f in &mechanism.elements.forces {
        let column = |k: usize| f.site.column(k);
        patterns[0].push_block(f.pattern_dx(), column, column);
        patterns[1].push_block(f.pattern_dv(), column, column);
    }
    for body in gyroscopic(mechanism) {
        let first = mechanism.space().rotations_of(body).start;
        let column = |k: usize| Some(first + k);
        patterns[1].push_block(&GYROSCOPIC, column, column);
    }
    Ok(patterns)
}

/// Pattern of the derivative of `−ω × J·ω` with respect to ω in principal axes.
const GYROSCOPIC: [[usize; 2]; 6] = [[0, 1], [0, 2], [1, 2], [1, 0], [2, 0], [2, 1]];

/// Returns the bodies with a gyroscopic torque. In space these are all bodies.
fn gyroscopic(mechanism: &Mechanism) -> std::ops::Range<usize> {
    match mechanism.space() {
        SpaceKind::Space3 => 0..mechanism.bodies.len(),
        _ => 0..0,
    }
}

fn differentiate_forces(mechanism: &Mechanism, s: &Scratch, [by_q, by_v]: [&mut Sparse; 2]) {
    let (mut force_dq, mut force_dv) = (by_q.blocks(), by_v.blocks());
    for force in &mechanism.elements.forces {
        force.dq_dx(&s.slots, force_dq(force.pattern_dx().len()));
        force.dq_dv(&s.slots, force_dv(force.pattern_dv().len()));
    }
    for body in gyroscopic(mechanism) {
        let [jx, jy, jz] = mechanism.moments(body);
        let [x, y, z] = s.spins[body];
        let (a, b, c) = (jy - jz, jz - jx, jx - jy);
        let values = [a * z, a * y, b * x, b * z, c * y, c * x];
        force_dv(GYROSCOPIC.len()).copy_from_slice(&values);
    }
}

#[cfg(test)]
mod tests;
