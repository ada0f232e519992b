//! Decides whether an expression is zero for every pose. The module evaluates the expression at
//! fixed pseudo-random points that satisfy `cos² + sin² = 1` and have unit directions. The result
//! is used only to omit structural zeros from patterns.

use std::ops::{Add, Div, Mul, Neg};

use symbolic::{Expr, Function, Graph, Number};

use crate::elaborate::{Inputs, Source};

/// Number of points; the probability that a nonzero polynomial vanishes at all of them is zero.
const POINTS: u64 = 6;

/// Rounding error relative to the terms that cancel. The error is ε = 2.2e-16 for each operation,
/// of which there are at most some thousand.
const ROUNDING: f64 = 1e-12;

/// A value, and the size of its terms: the value that would result without cancellation.
#[derive(Clone, Copy)]
struct Measured {
    value: f64,
    size: f64,
}

impl From<f64> for Measured {
    fn from(value: f64) -> Self {
        let size = value.abs();
        Self { value, size }
    }
}

impl Add for Measured {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            size: self.size + other.size,
        }
    }
}

impl Mul for Measured {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            size: self.size * other.size,
        }
    }
}

impl Div for Measured {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self {
            value: self.value / other.value,
            size: self.size * other.size / (other.value * other.value),
        }
    }
}

impl Neg for Measured {
    type Output = Self;
    fn neg(self) -> Self {
        let value = -self.value;
        Self { value, ..self }
    }
}

impl Number for Measured {
    fn call(self, f: Function) -> Self {
        let value = self.value.call(f);
        let slope = match f {
            Function::Sqrt => 0.5 / value,
            Function::Sin | Function::Cos => 1.0,
            Function::RecipOrZero => value * value,
            Function::AngleOverSine(order) => self.value.call(Function::AngleOverSine(order + 1)),
        };
        Self {
            value,
            size: value.abs() + slope.abs() * self.size,
        }
    }
}

/// Returns whether `e` vanishes at every configuration.
pub(crate) fn is_zero(g: &mut Graph, inputs: &Inputs, e: Expr) -> bool {
    let e = inputs.defined.expand(g, e);
    g.is_zero(e)
        || (0..POINTS).all(|point| {
            let at = |s| value(inputs, g.name(s), inputs.source(s), point);
            let Measured { value, size } = g.evaluate(e, &|s| Measured::from(at(s)));
            value.abs() <= ROUNDING * size
        })
}

/// Returns the value of an input at a point.
fn value(inputs: &Inputs, name: &str, source: &Source, point: u64) -> f64 {
    let angle = |key: &str| 6.0 * sample(point, key);
    // The last index of an access like `self.axis.uvw()[1][2]`.
    let index = |access: &str, back: usize| {
        let digits = access
            .split(['[', ']'])
            .rev()
            .filter(|part| !part.is_empty());
        let digit = digits.clone().nth(back);
        digit
            .and_then(|digit| digit.parse::<usize>().ok())
            .unwrap_or_default()
    };
    match source {
        Source::Pose { slot, field: "cos" } => angle(&slot.to_string()).cos(),
        Source::Pose { slot, field: "sin" } => angle(&slot.to_string()).sin(),
        Source::Pose {
            slot,
            field: "angle",
        } => angle(&slot.to_string()),
        Source::Pose { slot, field } if field.starts_with("rot") => {
            rotation(point, &slot.to_string())[index(field, 1)][index(field, 0)]
        }
        Source::Parameter { access } if access.contains(".xy()") => {
            let direction = angle(access.split('.').nth(1).unwrap_or_default());
            if access.ends_with("[0]") {
                direction.cos()
            } else {
                direction.sin()
            }
        }
        Source::Parameter { access } if access.contains(".xyz()") || access.contains(".uvw()") => {
            let axes = rotation(point, access.split('.').nth(1).unwrap_or_default());
            // A direction along a plane is perpendicular to its normal.
            let row = match () {
                () if access.contains(".uvw()") => index(access, 1),
                () if access.contains(".along()") => 1,
                () => 0,
            };
            axes[row][index(access, 0)]
        }
        Source::Kept { access, .. } if access == "self.measure_0[0]" => angle("measure_0").cos(),
        Source::Kept { access, .. } if access == "self.measure_0[1]" => angle("measure_0").sin(),
        Source::Function { order: 0, .. } if inputs.is_motion_turn(name, 0) => {
            angle("motion").cos()
        }
        Source::Function { order: 0, .. } if inputs.is_motion_turn(name, 1) => {
            angle("motion").sin()
        }
        _ => 0.5 + sample(point, name),
    }
}

/// Returns a rotation that depends only on the arguments, by rows.
fn rotation(point: u64, key: &str) -> [[f64; 3]; 3] {
    let e = ["w", "x", "y", "z"].map(|part| 0.1 + sample(point, &format!("{key}.{part}")));
    let square: f64 = e.iter().map(|e| e * e).sum();
    let [w, x, y, z] = e.map(|e| e / square.sqrt());
    [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ],
        [
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        ],
        [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ]
}

/// Returns a value in [0, 1) that depends only on the arguments (FNV-1a).
fn sample(point: u64, key: &str) -> f64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64 ^ point.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for byte in key.bytes() {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    hash ^= hash >> 29;
    (hash.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests;
