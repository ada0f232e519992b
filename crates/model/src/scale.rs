//! Reference sizes for residuals. Each row has its own size, computed from the terms that cancel in
//! the row. Therefore the comparison depends neither on units nor on the size or the position of a
//! mechanism.

use std::ops::Range;

use linalg::Scaling;

use crate::arms::farthest_joints;
use crate::mechanism::Mechanism;
use crate::space::norm;
use crate::system::{Scratch, System};

/// Reference sizes for residuals of a mechanism, at the configuration in a work space. The work
/// space must contain C for positions, C and b for velocities, and C and Γ for accelerations.
#[derive(Clone, Copy)]
pub struct Scales<'a> {
    pub(crate) mechanism: &'a Mechanism,
    pub(crate) s: &'a Scratch,
}

impl Mechanism {
    /// Returns the reference sizes for residuals at the configuration in the work space.
    #[must_use]
    pub fn scales<'a>(&'a self, s: &'a Scratch) -> Scales<'a> {
        Scales { mechanism: self, s }
    }
}

impl Scales<'_> {
    /// Returns the size of the terms of row `i` of Φ at the configuration in the work space:
    /// `Σ |C_ij|·|q_j|`. An angle counts as at least one radian, because the angle rotates the
    /// arms. A position counts as at least the longest arm of the body, because the position is
    /// accurate to the rounding error of the arms. The work space must contain C.
    #[must_use]
    pub fn position(self, i: usize) -> f64 {
        let counted = self.counted(i);
        let term = |(j, c): (usize, f64)| c.abs() * self.coordinate(j, counted);
        self.mechanism.layout().row(self.s, i).map(term).sum()
    }

    /// Returns the size of the coordinate of column j of C. `counted` is the largest unwrapped
    /// angle of the row.
    pub(crate) fn coordinate(self, j: usize, counted: f64) -> f64 {
        let space = self.mechanism.space();
        let at = self.s.bodies.position(space.body_of(j), space.dof_of(j));
        let turns = if space.is_rotation(j) { counted } else { 0.0 };
        let (at, least) = (at.abs().max(turns), least(self.mechanism, j));
        if at > least { at } else { least }
    }

    /// Returns the largest unwrapped angle (rad) of the joint or drive of a row. The rounding error
    /// of the angle grows with the number of revolutions.
    pub(crate) fn counted(self, i: usize) -> f64 {
        let owner = self.mechanism.layout().owners.get(i);
        let of_row = owner.map(|id| &self.mechanism.elements.constraints[id.0]);
        let Some(c) = of_row.filter(|c| c.spec().turns > 0) else {
            return 0.0;
        };
        let given = c.site.f(&self.s.slots);
        let angles = given[given.len() - 3 * c.spec().turns..].chunks_exact(3);
        angles.fold(0.0, |most, of| most.max(of[0][0].abs()))
    }

    /// Returns bounds on the entries of row `i` of C for any orientation of the bodies. Each item
    /// is a column and its bound. A force on a body counts with the same size in all directions,
    /// and the arm of a force is at most the longest arm of the body. The work space must contain C
    /// at its configuration. The function allocates memory.
    #[must_use]
    pub fn entry_bounds(self, i: usize) -> Vec<(usize, f64)> {
        let mut bounds = Vec::new();
        self.visit_bounds(i, |j, bound| bounds.push((j, bound)));
        bounds.sort_unstable_by_key(|bound| bound.0);
        bounds
    }

    /// Calls `visit` with the columns and bounds of [`Scales::entry_bounds`], body by body.
    pub(crate) fn visit_bounds(self, i: usize, mut visit: impl FnMut(usize, f64)) {
        let space = self.mechanism.space();
        let row = || self.mechanism.layout().row(self.s, i);
        for (k, (first, _)) in row().enumerate() {
            let body = space.body_of(first);
            if row().take(k).any(|(j, _)| space.body_of(j) == body) {
                continue;
            }
            let size = |columns: Range<usize>| {
                let mut entries = [0.0; 3];
                for (j, c) in row().filter(|(j, _)| columns.contains(j)) {
                    entries[j - columns.start] += c;
                }
                norm(&entries)
            };
            let force = size(space.translations_of(body));
            let turn = size(space.rotations_of(body)).max(force * self.mechanism.reach(body));
            for j in space.columns_of(body) {
                visit(j, if space.is_rotation(j) { turn } else { force });
            }
        }
    }

    /// Writes the sizes of the coordinates of the columns of C, n_v values. From these sizes and
    /// the [`Scales::entry_bounds`] of a row, the caller can compute the size of the terms of this
    /// row of Φ, as in [`Scales::position`].
    pub fn of_coordinates(mechanism: &Mechanism, q: &[f64], sizes: &mut [f64]) {
        let space = mechanism.space();
        for (j, size) in sizes.iter_mut().enumerate() {
            *size = space.position(q, j).abs().max(least(mechanism, j));
        }
    }

    /// Returns the size of the terms of row `i` of `C·v − b`. The work space must contain C and b
    /// at its configuration.
    #[must_use]
    pub fn velocity(self, i: usize, v: &[f64]) -> f64 {
        let terms = self
            .mechanism
            .layout()
            .row(self.s, i)
            .map(|(j, c)| (c * v[j]).abs());
        terms.sum::<f64>() + self.s.b[i].abs()
    }

    /// Returns the size of the terms of row `i` of `C·v − b` for any orientation of the bodies. A
    /// row that is perpendicular to the motion at this instant is accurate to the rounding error of
    /// these terms, although its present terms are smaller. The work space must contain C and b at
    /// its configuration. The function allocates memory.
    #[must_use]
    pub fn bounded_velocity(self, i: usize, v: &[f64]) -> f64 {
        let bounds = self.entry_bounds(i).into_iter();
        bounds.map(|(j, c)| c * v[j].abs()).sum::<f64>() + self.s.b[i].abs()
    }

    /// Returns the size of the terms of row `i` of `C·v̇ − Γ` at velocities v. The size is `|Γ_i|`
    /// plus the contributions of the centripetal terms of the bodies. These contributions are
    /// `|C_ij|·(|v_j|·ω + size·ω²)` for translations and `|C_ij|·ω²` for rotations, with the
    /// largest |ω| of the row. The work space must contain C and Γ.
    #[must_use]
    pub fn acceleration(self, i: usize, v: &[f64], size: f64) -> f64 {
        let row = || self.mechanism.layout().row(self.s, i);
        let space = self.mechanism.space();
        let rotations = row().map(|(j, _)| norm(&v[space.rotations_of(space.body_of(j))]));
        let omega = rotations.fold(0.0, f64::max);
        let term = |(j, c): (usize, f64)| {
            let rate = if space.is_rotation(j) {
                omega
            } else {
                v[j].abs() + size * omega
            };
            c.abs() * rate * omega
        };
        row().map(term).sum::<f64>() + self.s.gamma[i].abs()
    }

    /// Returns the size of the values that functions of time prescribe in row `i` at the time in
    /// the work space: the sum of `|f| + |ḟ| + |f̈|`. A rate counts as zero if it is less than the
    /// rounding error of this size.
    #[must_use]
    pub fn prescribed(self, i: usize) -> f64 {
        let mechanism = self.mechanism;
        let owner = mechanism.layout().owners.get(i);
        let of_row = owner.map(|id| &mechanism.elements.constraints[id.0]);
        let jets = of_row.map_or(&[][..], |c| c.site.f(&self.s.slots));
        jets.iter().flatten().map(|x| x.abs()).sum()
    }

    /// Returns the scaling of the columns of a dimensionless C by the arms of the bodies. All
    /// lengths have the same unit. The unit of the rotation of a body is the distance of the
    /// farthest joint of the body, if this distance exceeds its rounding error. Unlike an
    /// equilibration, this scaling does not depend on the directions of joints. The work space must
    /// contain the configuration.
    #[must_use]
    pub fn felt_scaling(self, size: f64) -> Scaling {
        let layout = self.mechanism.layout();
        let mut scaling = Scaling::identity(layout.rows(), layout.n_v);
        let arms = farthest_joints(self.mechanism, self.s).into_iter();
        for (body, arm) in arms.enumerate().filter(|(_, arm)| *arm != 0.0) {
            let exponent = (size / arm).log2().round();
            if exponent.is_finite() {
                scaling.cols[layout.space.rotations_of(body)].fill(exponent as i32);
            }
        }
        scaling
    }

    /// Returns a bound on the error of the entries of a dimensionless C at a configuration. For
    /// each row, the function divides |Φ_i| by the change of row `i` if the mechanism moves by its
    /// own size. The bound is the largest of these ratios. If |Φ_i| is less than the rounding error
    /// of its terms, the function uses this rounding error. The work space must contain Φ and C.
    #[must_use]
    pub fn relative_residual(self, size: f64, rows: impl IntoIterator<Item = usize>) -> f64 {
        let of_row = |i: usize| {
            let rounding = f64::EPSILON * self.position(i);
            self.relative_to_reach(i, size, self.s.phi[i].abs().max(rounding))
        };
        rows.into_iter().map(of_row).fold(0.0, f64::max)
    }

    /// Returns the ratio of `x` to the change of row `i` if the mechanism moves by its own size.
    /// The work space must contain C.
    #[must_use]
    pub fn relative_to_reach(self, i: usize, size: f64, x: f64) -> f64 {
        let space = self.mechanism.space();
        let reach = |(j, c): (usize, f64)| c.abs() * space.unit(j, size);
        let reach: f64 = self.mechanism.layout().row(self.s, i).map(reach).sum();
        if reach > 0.0 { x / reach } else { x }
    }
}

/// Returns the lower limit for the size of a coordinate in the terms of a row.
fn least(mechanism: &Mechanism, j: usize) -> f64 {
    let space = mechanism.space();
    if space.is_rotation(j) {
        1.0
    } else {
        mechanism.reach(space.body_of(j))
    }
}
