//! Quantities with two derivatives, and geometry in the plane with them.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A quantity with its first and second derivative: with respect to time, or to a stroke.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub(super) x: f64,
    pub(super) d: f64,
    pub(super) dd: f64,
}

impl Jet {
    pub(super) const fn constant(x: f64) -> Self {
        Self { x, d: 0.0, dd: 0.0 }
    }

    /// A function of this quantity, from its value and two derivatives.
    fn through(self, [f, d, dd]: [f64; 3]) -> Self {
        Self {
            x: f,
            d: d * self.d,
            dd: dd * self.d * self.d + d * self.dd,
        }
    }

    pub(super) fn sqrt(self) -> Self {
        let f = self.x.sqrt();
        self.through([f, 0.5 / f, -0.25 / (f * self.x)])
    }

    pub(super) fn sin(self) -> Self {
        let (s, c) = self.x.sin_cos();
        self.through([s, c, -s])
    }

    pub(super) fn cos(self) -> Self {
        let (s, c) = self.x.sin_cos();
        self.through([c, -s, -c])
    }

    pub(super) fn acos(self) -> Self {
        let w = (1.0 - self.x * self.x).sqrt();
        self.through([self.x.acos(), -1.0 / w, -self.x / (w * w * w)])
    }

    /// The angle of the vector (x, y): its rate is (x·ẏ − y·ẋ)/(x² + y²).
    pub(super) fn atan2(y: Self, x: Self) -> Self {
        let area = x.x * y.d - y.x * x.d;
        let square = x.x * x.x + y.x * y.x;
        let growth = 2.0 * (x.x * x.d + y.x * y.d);
        Self {
            x: y.x.atan2(x.x),
            d: area / square,
            dd: (x.x * y.dd - y.x * x.dd) / square - area * growth / (square * square),
        }
    }
}

impl From<f64> for Jet {
    fn from(x: f64) -> Self {
        Self::constant(x)
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self {
            x: self.x + b.x,
            d: self.d + b.d,
            dd: self.dd + b.dd,
        }
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self {
            x: self.x * b.x,
            d: self.d * b.x + self.x * b.d,
            dd: self.dd * b.x + 2.0 * self.d * b.d + self.x * b.dd,
        }
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, b: f64) -> Self {
        self * Self::constant(b)
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    fn add(self, b: f64) -> Self {
        self + Self::constant(b)
    }
}

impl Div for Jet {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let x = b.x;
        self * b.through([1.0 / x, -1.0 / (x * x), 2.0 / (x * x * x)])
    }
}

/// A point of the plane.
pub(super) type Point = [Jet; 2];

pub(super) fn point([x, y]: [f64; 2]) -> Point {
    [x.into(), y.into()]
}

pub(super) fn plus(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn length(a: Point, b: Point) -> Jet {
    let d = minus(a, b);
    (d[0] * d[0] + d[1] * d[1]).sqrt()
}

/// The vector, turned by an angle.
pub(super) fn turned(v: Point, angle: Jet) -> Point {
    let (s, c) = (angle.sin(), angle.cos());
    [c * v[0] - s * v[1], s * v[0] + c * v[1]]
}

/// The angle of a vector to the axis x.
pub(super) fn slope(v: Point) -> Jet {
    Jet::atan2(v[1], v[0])
}

/// The angle at a corner of a triangle between sides a and b; the third side is opposite. This is
/// the law of cosines.
pub(super) fn corner(a: f64, b: f64, opposite: Jet) -> Jet {
    ((opposite * opposite * -1.0 + (a * a + b * b)) * (0.5 / (a * b))).acos()
}

/// The point at these distances from two centres, to the left (1) or right (−1) of the line from
/// the first centre to the second.
pub(super) fn meeting(a: Point, from_a: Jet, b: Point, from_b: Jet, side: f64) -> Point {
    let d = minus(b, a);
    let square = d[0] * d[0] + d[1] * d[1];
    let along = (from_a * from_a - from_b * from_b + square) / (square * 2.0);
    let across = (from_a * from_a / square - along * along).sqrt() * side;
    plus(
        a,
        [along * d[0] - across * d[1], along * d[1] + across * d[0]],
    )
}

/// The steps of a drive, each (from, to, by): 10·s³ − 15·s⁴ + 6·s⁵ in the share s of its time.
pub(super) fn steps(steps: &[(f64, f64, f64)], t: f64) -> Jet {
    let step = |&(from, to, by): &(f64, f64, f64)| {
        let s = ((t - from) / (to - from)).clamp(0.0, 1.0);
        let rate = 1.0 / (to - from);
        Jet {
            x: by * s * s * s * (10.0 + s * (-15.0 + 6.0 * s)),
            d: by * rate * 30.0 * s * s * (1.0 - s) * (1.0 - s),
            dd: by * rate * rate * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s),
        }
    };
    steps.iter().map(step).fold(0.0.into(), |a, b| a + b)
}

/// Jets against difference quotients of the values.
#[test]
fn jets_have_the_derivatives_of_their_values() {
    let of = |t: f64| {
        let s = Jet {
            x: t,
            d: 1.0,
            dd: 0.0,
        };
        let p = meeting(
            point([0.0, 0.1]),
            s * s + 1.2,
            [s.sin(), s.cos()],
            s.sqrt() + 1.0,
            -1.0,
        );
        [p[0], corner(1.0, 1.3, p[1]), slope(p), p[1] / p[0]]
    };
    let (t, h) = (0.7, 1e-4);
    for k in 0..4 {
        let [before, now, after] = [t - h, t, t + h].map(|t| of(t)[k]);
        let d = (after.x - before.x) / (2.0 * h);
        let dd = (after.x - 2.0 * now.x + before.x) / (h * h);
        assert!(
            (now.d - d).abs() < 1e-6 && (now.dd - dd).abs() < 1e-5,
            "{k}: {now:?}, {d}, {dd}"
        );
    }
}
