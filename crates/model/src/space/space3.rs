//! Space, with unit quaternions as orientations.

use joints::Ring;

use super::number::Number;
use super::traits::{MOST_COORDINATES, Space};
use super::vector::norm;

/// Space: q = (x, y, z, w, x', y', z') with the quaternion of the body axes, v = (ẋ, ẏ, ż, ω) with
/// ω in the body axes.
///
/// Only the direction of the quaternion is used. Therefore the quaternion may leave the unit sphere
/// at a stage of an integrator; a displacement returns it to the sphere. A quaternion and its
/// negative represent the same pose.
#[derive(Clone, Copy, Debug)]
pub struct Space3;

impl Space for Space3 {
    const N_Q: usize = 7;
    const N_V: usize = 6;
    const N_TRANSLATIONS: usize = 3;
    const COORDINATES: &'static [&'static str] = &["x", "y", "z", "qw", "qx", "qy", "qz"];
    const COLUMNS: &'static [&'static str] = &[
        "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz",
    ];
    const ACCELERATIONS: &'static [&'static str] =
        &["ax", "ay", "az", "alphax", "alphay", "alphaz"];
    const DIRECTIONS: &'static [&'static str] = &[
        "x",
        "y",
        "z",
        "rotation about x",
        "rotation about y",
        "rotation about z",
    ];
    const COMPONENTS: &'static [&'static str] = &["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];
    const BODY_COMPONENTS: &'static [&'static str] = &["Fx'", "Fy'", "Fz'", "Tx'", "Ty'", "Tz'"];
    const JOINT_COMPONENTS: &'static [&'static str] = &["Fu", "Fv", "Fw", "Tu", "Tv", "Tw"];
    const EDGE_COMPONENTS: &'static [&'static str] = &["Fn", "Ft", "Fb", "Tn", "Tt", "Tb"];

    /// A rotation does not define an angle that includes full revolutions. Therefore the value is
    /// zero.
    fn position(q: &[f64], dof: usize) -> f64 {
        if dof < 3 { q[dof] } else { 0.0 }
    }

    /// Computes ė = ½·e∘(0, ω).
    fn rate<T: Ring>(q: &[T], v: &[T], qd: &mut [T]) {
        qd[..3].copy_from_slice(&v[..3]);
        let twice = quaternion_product(quaternion(q), [T::from(0.0), v[3], v[4], v[5]]);
        for (qd, e) in qd[3..].iter_mut().zip(twice) {
            *qd = T::from(0.5) * e;
        }
    }

    /// Computes the vector part of ω = 2·ē∘ė/|e|².
    fn velocity_from_rate(q: &[f64], dof: usize) -> [f64; MOST_COORDINATES] {
        let [w, x, y, z] = quaternion(q);
        let twice = 2.0 / (w * w + x * x + y * y + z * z);
        let of_rates = match dof {
            3 => [-x, w, z, -y],
            4 => [-y, -z, w, x],
            5 => [-z, y, -x, w],
            _ => return std::array::from_fn(|k| if k == dof { 1.0 } else { 0.0 }),
        };
        let [a, b, c, d] = of_rates.map(|e| twice * e);
        [0.0, 0.0, 0.0, a, b, c, d]
    }

    fn normal(q: &[f64]) -> Option<[f64; MOST_COORDINATES]> {
        let [w, x, y, z] = normalised(quaternion(q));
        Some([0.0, 0.0, 0.0, w, x, y, z])
    }

    /// Computes e∘exp(½·θ), where θ is the rotation vector in the body axes.
    fn displace<T: Number>(q: &mut [T], d: &[T]) {
        for (q, d) in q.iter_mut().zip(&d[..3]) {
            *q = *q + *d;
        }
        let turned = quaternion_product(quaternion(q), exponential([d[3], d[4], d[5]]));
        q[3..].copy_from_slice(&normalised(turned));
    }

    fn difference(q: &[f64], from: &[f64], d: &mut [f64]) {
        for k in 0..3 {
            d[k] = q[k] - from[k];
        }
        let [w, x, y, z] = quaternion(from);
        let [w, x, y, z] = quaternion_product([w, -x, -y, -z], quaternion(q));
        // A quaternion and its negative represent the same rotation; the quaternion with the
        // smaller angle is used.
        let sign = 1.0_f64.copysign(w);
        let length = norm(&[x, y, z]);
        let angle = 2.0 * length.atan2(w.abs());
        let factor = if length > 0.0 { angle / length } else { 0.0 };
        for (d, e) in d[3..].iter_mut().zip([x, y, z]) {
            *d = sign * factor * e;
        }
    }

    /// The whole orientation is copied for every rotational component, because rotations cannot be
    /// added along single axes.
    fn take(q: &mut [f64], from: &[f64], dof: usize) {
        match dof {
            0..3 => q[dof] = from[dof],
            _ => q[3..7].copy_from_slice(&from[3..7]),
        }
    }
}

/// Returns the quaternion (w, x, y, z) among the coordinates of a spatial body.
pub(crate) fn quaternion<T: Copy>(q: &[T]) -> [T; 4] {
    [q[3], q[4], q[5], q[6]]
}

/// Returns the quaternion product a∘b.
pub(crate) fn quaternion_product<T: Ring>(a: [T; 4], b: [T; 4]) -> [T; 4] {
    let [aw, ax, ay, az] = a;
    let [bw, bx, by, bz] = b;
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
    ]
}

/// Returns a quaternion scaled to length one; the quaternion must not be zero.
pub(crate) fn normalised<T: Number>(e: [T; 4]) -> [T; 4] {
    let [w, x, y, z] = e;
    let length = (w * w + x * x + y * y + z * z).root();
    e.map(|part| part / length)
}

/// If the square of half an angle is below this value, sine and cosine are summed as series. Six
/// terms of the series are then exact to the last digit of double-double.
const SERIES: f64 = 1e-4;

/// Returns the unit quaternion of a rotation vector: (cos ½|θ|, sin ½|θ|·θ/|θ|).
fn exponential<T: Number>(turn: [T; 3]) -> [T; 4] {
    let [x, y, z] = turn;
    let square = (x * x + y * y + z * z) * T::from(0.25);
    // Computes cos h and ½·sin(h)/h of h = ½·|θ|.
    let (cos, half_sinc) = if square.nearest() < SERIES {
        let series = |first: f64| {
            let mut sum = T::from(0.0);
            let mut term = T::from(1.0);
            for k in 0..8 {
                sum = sum + term;
                let n = 2.0 * f64::from(k) + first;
                term = -(term * square) / T::from(n * (n + 1.0));
            }
            sum
        };
        (series(1.0), T::from(0.5) * series(2.0))
    } else {
        let half = square.root();
        let (sin, cos) = half.sin_cos();
        (cos, T::from(0.5) * (sin / half))
    };
    [cos, half_sinc * x, half_sinc * y, half_sinc * z]
}
