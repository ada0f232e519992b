//! Dimensions of quantities: the dimension of a unit, the dimension that a key requires, and
//! whether the two agree.

use std::fmt;

use joints::spec::Unit;

/// Exponents of kg, N, m, s and rad. Force has its own exponent, so that bare numbers in mm can
/// mean N/mm and N·mm, as on drawings; comparisons use kg·m/s².
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dimension([i8; 5]);

/// Units of stored values.
const SYMBOLS: [&str; 5] = ["kg", "N", "m", "s", "rad"];

impl Dimension {
    pub(crate) const NONE: Self = Self([0; 5]);
    pub(crate) const MASS: Self = Self([1, 0, 0, 0, 0]);
    pub(crate) const FORCE: Self = Self([0, 1, 0, 0, 0]);
    pub(crate) const LENGTH: Self = Self([0, 0, 1, 0, 0]);
    pub(crate) const TIME: Self = Self([0, 0, 0, 1, 0]);
    pub(crate) const ANGLE: Self = Self([0, 0, 0, 0, 1]);
    pub(crate) const INERTIA: Self = Self([1, 0, 2, 0, 0]);
    pub(crate) const VELOCITY: Self = Self([0, 0, 1, -1, 0]);
    pub(crate) const ACCELERATION: Self = Self([0, 0, 1, -2, 0]);
    pub(crate) const ANGULAR_VELOCITY: Self = Self([0, 0, 0, -1, 1]);
    pub(crate) const PER_TIME: Self = Self([0, 0, 0, -1, 0]);
    pub(crate) const PRESSURE: Self = Self([0, 1, -2, 0, 0]);
    pub(crate) const POWER: Self = Self([0, 1, 1, -1, 0]);

    /// The unknown dimension of a value in a wrong context; it agrees with every dimension.
    pub(crate) const UNKNOWN: Self = Self([i8::MIN; 5]);

    /// Returns the dimension of the product of a quantity of this dimension and a power of a
    /// quantity of another dimension. Exponents outside of the range of `i8` are set to the ends of
    /// the range.
    pub(crate) fn times(self, other: Self, power: i8) -> Self {
        if self == Self::UNKNOWN {
            return self;
        }
        let mut product = self.0;
        for (a, b) in product.iter_mut().zip(other.0) {
            *a = a.saturating_add(b.saturating_mul(power));
        }
        Self(product)
    }

    /// Returns the dimension of a square root, if it exists.
    pub(crate) fn root(self) -> Option<Self> {
        let is_even = self.0.iter().all(|e| e % 2 == 0);
        is_even.then(|| Self(self.0.map(|e| e / 2)))
    }

    /// Returns the exponents of length and angle, the two quantities whose units a scene may
    /// choose.
    pub(crate) fn chosen(self) -> [i8; 2] {
        if self == Self::UNKNOWN {
            return [0; 2];
        }
        [self.0[2], self.0[4]]
    }

    /// Returns whether a value of this dimension is permitted if `expected` is required. Radians
    /// count as dimensionless in products: r·ω is a velocity and s/r an angle. However, a single
    /// angle is not a ratio.
    pub(crate) fn fits(self, expected: Self) -> bool {
        let mechanical = |Self([kg, n, m, s, _]): Self| {
            let [kg, n, m, s] = [kg, n, m, s].map(i32::from);
            [kg + n, m + n, s - 2 * n]
        };
        let same = mechanical(self) == mechanical(expected);
        let (angle, of) = (self.0[4], expected.0[4]);
        let is_unknown = expected == Self::UNKNOWN;
        is_unknown || same && (angle == of || angle == 0 || mechanical(self) != [0; 3])
    }

    /// Name of the quantity with its unit.
    pub(crate) fn words(self) -> String {
        let name = match self {
            Self::NONE => return "a number without a unit".to_owned(),
            Self::MASS => "a mass",
            Self::FORCE => "a force",
            Self::LENGTH => "a length",
            Self::TIME => "a time",
            Self::ANGLE => "an angle",
            Self::VELOCITY => "a velocity",
            Self::ACCELERATION => "an acceleration",
            Self::INERTIA => "a moment of inertia",
            Self::ANGULAR_VELOCITY => "an angular velocity",
            Self::PRESSURE => "a pressure",
            Self::POWER => "a power",
            _ => "a quantity",
        };
        format!("{name} ({self})")
    }
}

/// Prints the unit of stored values, such as `N·m/rad`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let factors = |sign: i32| -> Vec<String> {
            let powers = SYMBOLS.iter().zip(self.0.map(|e| i32::from(e) * sign));
            let factor = |(symbol, e): (&&str, i32)| match e {
                1 => Some((*symbol).to_owned()),
                2 => Some(format!("{symbol}²")),
                3 => Some(format!("{symbol}³")),
                e if e > 3 => Some(format!("{symbol}^{e}")),
                _ => None,
            };
            powers.filter_map(factor).collect()
        };
        let (above, below) = (factors(1), factors(-1));
        let above = if above.is_empty() {
            "1".to_owned()
        } else {
            above.join("·")
        };
        match &below[..] {
            [] => f.write_str(&above),
            [one] => write!(f, "{above}/{one}"),
            several => write!(f, "{above}/({})", several.join("·")),
        }
    }
}

impl From<Unit> for Dimension {
    fn from(unit: Unit) -> Self {
        Self(match unit {
            Unit::Length | Unit::Radius => return Self::LENGTH,
            Unit::Angle => return Self::ANGLE,
            Unit::Ratio => return Self::NONE,
            Unit::Velocity => return Self::VELOCITY,
            Unit::AngularVelocity => return Self::ANGULAR_VELOCITY,
            Unit::Force => return Self::FORCE,
            Unit::Torque => [0, 1, 1, 0, 0],
            Unit::Stiffness => [0, 1, -1, 0, 0],
            Unit::TorsionStiffness => [0, 1, 1, 0, -1],
            Unit::Damping => [0, 1, -1, 1, 0],
            Unit::TorsionDamping => [0, 1, 1, 1, -1],
            Unit::CorneringStiffness => [0, 1, 0, 0, -1],
            Unit::PerLength => [0, 0, -1, 0, 0],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_written_as_definitions_write_them() {
        for unit in [
            Unit::Length,
            Unit::Radius,
            Unit::Angle,
            Unit::Ratio,
            Unit::Velocity,
            Unit::AngularVelocity,
            Unit::Force,
            Unit::Torque,
            Unit::Stiffness,
            Unit::TorsionStiffness,
            Unit::Damping,
            Unit::TorsionDamping,
            Unit::CorneringStiffness,
            Unit::PerLength,
        ] {
            assert_eq!(Dimension::from(unit).to_string(), unit.to_string());
        }
        assert_eq!(Dimension::INERTIA.to_string(), "kg·m²");
        assert_eq!(Dimension::ACCELERATION.to_string(), "m/s²");
        let per_both = Dimension::MASS.times(Dimension::ANGULAR_VELOCITY, 4);
        assert_eq!(per_both.to_string(), "kg·rad^4/s^4");
        let least = Dimension([-128, 127, 0, 0, -1]);
        assert_eq!(least.to_string(), "N^127/(kg^128·rad)");
        assert_eq!(least.times(least, 127), Dimension([-128, 127, 0, 0, -128]));
    }

    #[test]
    fn radians_are_numbers_but_angles_are_no_ratios() {
        let (length, angle) = (Dimension::LENGTH, Dimension::ANGLE);
        let arc = Dimension::ANGULAR_VELOCITY.times(length, 1);
        for (found, expected, fit) in [
            (length, length, true),
            (arc, Dimension::VELOCITY, true),
            (Dimension::NONE, angle, true),
            (angle, Dimension::NONE, false),
            (angle, length, false),
            (angle.times(angle, 1), angle, false),
            (Dimension([1, 0, 1, -2, 0]), Dimension::FORCE, true),
            (Dimension::FORCE, Dimension::MASS, false),
            (Unit::Torque.into(), Unit::TorsionStiffness.into(), true),
        ] {
            assert_eq!(found.fits(expected), fit, "{found} {expected}");
        }
        assert_eq!(Dimension::INERTIA.root(), None);
        assert_eq!(length.times(length, 1).root(), Some(length));
    }
}
