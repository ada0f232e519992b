//! Defines when rows count as violated. The criterion is the same for positions, velocities and
//! accelerations.
//!
//! Let z be a dependency of rows, `zᵀ·C = 0`, between one dropped row and the kept rows that imply
//! the dropped row. For the intended mechanism, the sums of the residuals, `zᵀ·Φ`, `zᵀ·(C·v − b)`
//! and `zᵀ·(C·a − Γ)`, are zero. For the stored mechanism, the accuracy of such a sum has two
//! limits. The first limit is the rounding error of the terms of these rows, for any direction of
//! the axes ([`Scales::terms`]). The second limit is the change of the sum if data change within a
//! stated tolerance ([`crate::explained`]). A sum above both limits is a violation.
//!
//! Terms that are zero at the current state are included, too. For example, the velocity of a body
//! that moves along a row is zero across the row. However, the direction of the row has a rounding
//! error, and therefore this velocity has a rounding error, too.

use crate::data::{Data, DataBlock, explained};
use crate::mechanism::Mechanism;
use crate::scale::Scales;
use crate::system::{Scratch, System};

/// The level at which rows are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum ConstraintLevel {
    /// The constraint equations Φ = 0.
    Position,
    /// The velocity equations C·v = b.
    Velocity,
    /// The acceleration equations C·a = Γ.
    Acceleration,
}

impl ConstraintLevel {
    /// Returns the unit of the residual of a row; `angular` means that the row restricts an angle.
    #[must_use]
    pub fn unit(self, angular: bool) -> &'static str {
        match (self, angular) {
            (Self::Position, false) => "m",
            (Self::Velocity, false) => "m/s",
            (Self::Acceleration, false) => "m/s²",
            (Self::Position, true) => "rad",
            (Self::Velocity, true) => "rad/s",
            (Self::Acceleration, true) => "rad/s²",
        }
    }
}

impl std::fmt::Display for ConstraintLevel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Position => "positions",
            Self::Velocity => "velocities",
            Self::Acceleration => "accelerations",
        })
    }
}

/// The level of a comparison, and the motion at the compared state.
#[derive(Clone, Copy, Debug)]
pub struct Level<'a> {
    /// The level.
    pub of: ConstraintLevel,
    /// Velocities (n_v); empty for positions.
    v: &'a [f64],
    /// Accelerations (n_v), if they are known.
    a: Option<&'a [f64]>,
    /// The largest rate in the mechanism (1/s): angular velocities, and velocities divided by the
    /// size of the mechanism.
    rate: f64,
    /// The largest acceleration (1/s²): angular accelerations, and accelerations of points divided
    /// by the size.
    acceleration: f64,
    /// Size of the mechanism (m).
    size: f64,
}

/// Rates up to this value (1/s) count as rest. In one second, they move bodies by less than 100
/// times the rounding error of the positions.
const REST: f64 = 100.0 * f64::EPSILON;

impl<'a> Level<'a> {
    /// Creates the level of positions.
    #[must_use]
    pub fn positions() -> Self {
        Self {
            of: ConstraintLevel::Position,
            v: &[],
            a: None,
            rate: 0.0,
            acceleration: 0.0,
            size: 1.0,
        }
    }

    /// Creates the level of velocities for v (n_v); `size` is the size of the mechanism (m).
    #[must_use]
    pub fn velocities(mechanism: &Mechanism, size: f64, v: &'a [f64]) -> Self {
        Self {
            of: ConstraintLevel::Velocity,
            v,
            a: None,
            rate: fastest(mechanism, size, v),
            acceleration: 0.0,
            size,
        }
    }

    /// Creates the level of accelerations for a and v (n_v each). Without a, only the right-hand
    /// sides Γ are compared.
    #[must_use]
    pub fn accelerations(
        mechanism: &Mechanism,
        size: f64,
        v: &'a [f64],
        a: Option<&'a [f64]>,
    ) -> Self {
        Self {
            of: ConstraintLevel::Acceleration,
            v,
            a,
            rate: fastest(mechanism, size, v),
            acceleration: a.map_or(0.0, |a| fastest(mechanism, size, a)),
            size,
        }
    }
}

/// Returns whether the velocities v (n_v) count as rest; `size` is the size of the mechanism (m).
/// In one second, bodies at rest move by less than 100 times the rounding error of their positions.
/// The direction of such velocities is only rounding.
#[must_use]
pub fn is_at_rest(mechanism: &Mechanism, size: f64, v: &[f64]) -> bool {
    fastest(mechanism, size, v) <= REST
}

/// Returns the largest |v_j|; translations are divided by the size.
fn fastest(mechanism: &Mechanism, size: f64, v: &[f64]) -> f64 {
    let space = mechanism.space();
    let rates = v.iter().enumerate();
    rates.fold(0.0, |a: f64, (j, v)| a.max(v.abs() / space.unit(j, size)))
}

impl Scales<'_> {
    /// Returns the size of the terms that are added in row `i` at a level, for any orientation of
    /// the bodies. The residual of the row is accurate to the rounding error of these terms.
    ///
    /// | level | terms |
    /// | --- | --- |
    /// | position | `Σ c_ij·\|q_j\|` |
    /// | velocity | `ω·Σ c_ij·l_j + \|b_i\|`, and the prescribed values |
    /// | acceleration | `(α + ω_i·ω)·Σ c_ij·l_j + \|Γ_i\|`, and the prescribed values |
    ///
    /// c_ij are the bounds of [`Scales::entry_bounds`]. The sizes of coordinates have the lower
    /// limits of [`Scales::position`]. ω and α are the largest rate and the largest acceleration of
    /// the mechanism. ω_i is the largest rate of the bodies of the row, and l_j is the size of the
    /// mechanism for translations and 1 for rotations. All velocities are computed together, so
    /// each velocity has the rounding error of the largest one. The work space must contain C at
    /// its configuration, b for velocities, and Γ for accelerations.
    #[must_use]
    pub fn terms(self, i: usize, level: &Level<'_>) -> f64 {
        let given = match level.of {
            ConstraintLevel::Position => return self.bounded_position(i),
            ConstraintLevel::Velocity => self.s.b[i],
            ConstraintLevel::Acceleration => self.s.gamma[i],
        };
        let rate = match level.of {
            ConstraintLevel::Velocity => level.rate,
            _ => level.acceleration + self.rate(i, level) * level.rate,
        };
        rate * self.extent(i, level.size) + given.abs() + self.prescribed(i)
    }

    /// Returns the residual of row `i` below which the row counts as at rest. This residual is the
    /// rounding error of velocities that are zero.
    #[must_use]
    pub fn rest(self, i: usize, level: &Level<'_>) -> f64 {
        let rate = match level.of {
            ConstraintLevel::Position => return 0.0,
            ConstraintLevel::Velocity => REST,
            ConstraintLevel::Acceleration => REST * REST,
        };
        rate * self.bounded_position(i)
    }

    /// Returns the largest rate of the bodies of row `i` (1/s).
    fn rate(self, i: usize, level: &Level<'_>) -> f64 {
        let space = self.mechanism.space();
        let columns = self.mechanism.layout().row(self.s, i);
        columns.fold(0.0, |a: f64, (j, _)| {
            a.max(level.v[j].abs() / space.unit(j, level.size))
        })
    }

    /// Returns the change of row `i` if all bodies move by the size of the mechanism (m) in any
    /// direction.
    #[must_use]
    pub fn extent(self, i: usize, size: f64) -> f64 {
        let space = self.mechanism.space();
        let mut extent = 0.0;
        self.visit_bounds(i, |j, bound| extent += bound * space.unit(j, size));
        extent
    }

    fn bounded_position(self, i: usize) -> f64 {
        let counted = self.counted(i);
        let mut terms = 0.0;
        self.visit_bounds(i, |j, bound| terms += bound * self.coordinate(j, counted));
        terms
    }
}

impl Data<'_> {
    /// Sums the residuals of the rows at a level with weights z (m + h). Returns the part of this
    /// sum that can result from data within their stated tolerances. The result is [`explained`] of
    /// the gradient of this sum, which is written to `gradient` ([`Data::count`] values). The
    /// result is zero if no tolerance is stated, and infinite for accelerations that are not known.
    /// `blocks` are the result of [`Data::blocks`]. The work space must contain the configuration,
    /// and for accelerations also the velocities.
    #[must_use]
    pub fn explained(
        self,
        s: &Scratch,
        blocks: &[DataBlock],
        z: &[f64],
        level: &Level<'_>,
        gradient: &mut [f64],
    ) -> f64 {
        if !self.has_tolerances() {
            return 0.0;
        }
        gradient.fill(0.0);
        match (level.of, level.a) {
            (ConstraintLevel::Position, _) => self.slopes(s).add_phi(z, 1.0, gradient),
            (ConstraintLevel::Velocity, _) => self.slopes(s).add_power(z, level.v, 1.0, gradient),
            (ConstraintLevel::Acceleration, None) => return f64::INFINITY,
            (ConstraintLevel::Acceleration, Some(a)) => {
                let [none, still] = [vec![0.0; z.len()], vec![0.0; a.len()]];
                let of_rows = self.gradients(s, &none, [a, &still], level.v);
                of_rows.gradient(&still, [z, &none, &none], gradient);
            }
        }
        explained(blocks, gradient)
    }
}
