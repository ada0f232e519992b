//! When rows are violated: one measure for positions, velocities and accelerations.
//!
//! Let z combine rows to zero, `zᵀ·C = 0`: one dropped row and the kept rows that imply it. For the
//! intended mechanism the sum of their residuals `zᵀ·Φ`, `zᵀ·(C·v − b)`, `zᵀ·(C·a − Γ)` is zero.
//! The sum of a mechanism as stored is known to the rounding of the terms that are added in these
//! rows, whichever way the axes point ([`Scales::terms`]), and to what data within a stated
//! tolerance change ([`crate::explained`]). What is more than that is a violation.
//!
//! Terms are never those that happen to be present: a body that moves along a row has no velocity
//! across it, but the direction of the row is known to a rounding, and so is the velocity across
//! it.

use crate::data::{Data, DataBlock, explained};
use crate::mechanism::Mechanism;
use crate::scale::Scales;
use crate::system::{Scratch, System};

/// The level at which rows are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum ConstraintLevel {
    /// Φ = 0
    Position,
    /// C·v = b
    Velocity,
    /// C·a = Γ
    Acceleration,
}

impl ConstraintLevel {
    /// Unit of a row, for lengths or for angles.
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

/// A level, and the motion at the state that is compared.
#[derive(Clone, Copy, Debug)]
pub struct Level<'a> {
    /// The level.
    pub of: ConstraintLevel,
    /// Velocities (n_v); empty for positions.
    v: &'a [f64],
    /// Accelerations (n_v), if they are known.
    a: Option<&'a [f64]>,
    /// The fastest rate in the mechanism (1/s): rotations, and translations divided by its size.
    rate: f64,
    /// The largest acceleration (1/s²), in the same measure.
    acceleration: f64,
    /// Size of the mechanism (m).
    size: f64,
}

/// Rates up to so many roundings of a second are rest (1/s): bodies move by less than a hundred
/// roundings of their places in a second.
const REST: f64 = 100.0 * f64::EPSILON;

impl<'a> Level<'a> {
    /// Positions.
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

    /// Velocities v (n_v) of a mechanism of this size (m).
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

    /// Accelerations a at velocities v (n_v each); without a, only the right-hand sides Γ are
    /// compared.
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

/// Whether velocities v (n_v) of a mechanism of this size (m) are rest: bodies move by less than a
/// hundred roundings of their places in a second. What is left of them has no direction.
#[must_use]
pub fn is_at_rest(mechanism: &Mechanism, size: f64, v: &[f64]) -> bool {
    fastest(mechanism, size, v) <= REST
}

/// The largest |v_j|, translations divided by the size.
fn fastest(mechanism: &Mechanism, size: f64, v: &[f64]) -> f64 {
    let space = mechanism.space();
    let rates = v.iter().enumerate();
    rates.fold(0.0, |a: f64, (j, v)| a.max(v.abs() / space.unit(j, size)))
}

impl Scales<'_> {
    /// Size of the terms that are added in row `i` at a level, for any orientation of the bodies:
    /// the residual of the row is known to the rounding of these.
    ///
    /// | level | terms |
    /// | --- | --- |
    /// | position | `Σ c_ij·\|q_j\|` |
    /// | velocity | `ω·Σ c_ij·l_j + \|b_i\|`, and the prescribed values |
    /// | acceleration | `(α + ω_i·ω)·Σ c_ij·l_j + \|Γ_i\|`, and the prescribed values |
    ///
    /// c_ij are the bounds of [`Scales::entry_bounds`], coordinates count at least as in
    /// [`Scales::position`], ω and α are the fastest rate and the largest acceleration of the
    /// mechanism, ω_i is the fastest rate of the bodies of the row, and l_j is the size of the
    /// mechanism for translations and 1 for rotations. All velocities are computed together, so
    /// each is known to the rounding of the fastest. Needs C at the pose of the scratch; b for
    /// velocities, Γ for accelerations.
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

    /// The residual of row `i` at a level that is rest: what is left of velocities that are zero to
    /// rounding.
    #[must_use]
    pub fn rest(self, i: usize, level: &Level<'_>) -> f64 {
        let rate = match level.of {
            ConstraintLevel::Position => return 0.0,
            ConstraintLevel::Velocity => REST,
            ConstraintLevel::Acceleration => REST * REST,
        };
        rate * self.bounded_position(i)
    }

    /// The fastest rate of the bodies of row `i` (1/s).
    fn rate(self, i: usize, level: &Level<'_>) -> f64 {
        let space = self.mechanism.space();
        let columns = self.mechanism.layout().row(self.s, i);
        columns.fold(0.0, |a: f64, (j, _)| {
            a.max(level.v[j].abs() / space.unit(j, level.size))
        })
    }

    /// The change of row `i` if the mechanism moves by its size (m) in any direction.
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
    /// What data within their stated tolerances explain of the sum of the residuals of rows with
    /// weights z (m + h) at a level: [`explained`] of its gradient, which is written to `gradient`
    /// ([`Data::count`] values). Zero if no tolerance is stated; infinite for accelerations that
    /// are not known. `blocks` are those of [`Data::blocks`]. Needs the poses of the scratch, and
    /// for accelerations the twist.
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
                let of_rows = self.gradients(s, &none, a, level.v);
                of_rows.gradient(&still, [z, &none, &none], gradient);
            }
        }
        explained(blocks, gradient)
    }
}
