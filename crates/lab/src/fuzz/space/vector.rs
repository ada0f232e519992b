//! Vectors, rotations and similarity transformations in space, with rational numbers.

use std::ops::{Add, Neg, Sub};

use super::ratio::Ratio;

/// A point or vector.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vector(pub [Ratio; 3]);

/// Returns a vector of integers.
#[must_use]
pub fn whole(v: [i64; 3]) -> Vector {
    Vector(v.map(Ratio::whole))
}

/// Returns `v/divisor`.
#[must_use]
pub fn parts(v: [i64; 3], divisor: i64) -> Vector {
    Vector(v.map(|x| Ratio::new(x, divisor)))
}

impl Vector {
    /// The vector 0.
    #[must_use]
    pub fn zero() -> Self {
        whole([0; 3])
    }

    /// Returns the unit vector along coordinate `k`.
    #[must_use]
    pub fn unit(k: usize) -> Self {
        let mut v = [0; 3];
        v[k] = 1;
        whole(v)
    }

    /// Whether the vector is 0.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.0.iter().all(Ratio::is_zero)
    }

    /// Returns the product with a number.
    #[must_use]
    pub fn times(&self, factor: &Ratio) -> Self {
        let [x, y, z] = &self.0;
        Self([x * factor, y * factor, z * factor])
    }

    /// Returns the scalar product.
    #[must_use]
    pub fn dot(&self, other: &Self) -> Ratio {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        &(&(a * x) + &(b * y)) + &(c * z)
    }

    /// Returns the vector product.
    #[must_use]
    pub fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        Self([
            &(b * z) - &(c * y),
            &(c * x) - &(a * z),
            &(a * y) - &(b * x),
        ])
    }

    /// Returns the square of the length.
    #[must_use]
    pub fn square(&self) -> Ratio {
        self.dot(self)
    }

    /// Whether the vector is parallel to another vector; 0 is parallel to all vectors.
    #[must_use]
    pub fn is_along(&self, other: &Self) -> bool {
        self.cross(other).is_zero()
    }

    /// Returns the component perpendicular to a nonzero vector w, times the square of the length of
    /// w.
    #[must_use]
    pub fn across(&self, w: &Self) -> Self {
        &self.times(&w.square()) - &w.times(&self.dot(w))
    }

    /// Returns `self + factor·d`.
    #[must_use]
    pub fn along(&self, factor: &Ratio, d: &Self) -> Self {
        self + &d.times(factor)
    }
}

impl Add for &Vector {
    type Output = Vector;

    fn add(self, other: Self) -> Vector {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        Vector([a + x, b + y, c + z])
    }
}

impl Sub for &Vector {
    type Output = Vector;

    fn sub(self, other: Self) -> Vector {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        Vector([a - x, b - y, c - z])
    }
}

impl Neg for &Vector {
    type Output = Vector;

    fn neg(self) -> Vector {
        let [x, y, z] = &self.0;
        Vector([-x, -y, -z])
    }
}

/// A rotation as a quaternion (w, x, y, z) of any length except 0. The map `v ↦ q∘v∘q*/|q|²` is
/// rational.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rotation {
    /// The scalar part.
    pub w: Ratio,
    /// The vector part.
    pub u: Vector,
}

impl Rotation {
    /// Returns the quaternion of these integers.
    ///
    /// # Panics
    /// Panics if all components are 0.
    #[must_use]
    pub fn whole([w, x, y, z]: [i64; 4]) -> Self {
        assert!([w, x, y, z] != [0; 4], "a quaternion of length 0");
        Self {
            w: Ratio::whole(w),
            u: whole([x, y, z]),
        }
    }

    /// Returns the identity.
    #[must_use]
    pub fn none() -> Self {
        Self::whole([1, 0, 0, 0])
    }

    /// Returns the rotation about a **unit** vector, given by the tangent of half the angle.
    #[must_use]
    pub fn about(axis: &Vector, half_tangent: &Ratio) -> Self {
        Self {
            w: Ratio::one(),
            u: axis.times(half_tangent),
        }
    }

    /// Returns the half turn about a vector of any length.
    #[must_use]
    pub fn half_turn(axis: &Vector) -> Self {
        Self {
            w: Ratio::zero(),
            u: axis.clone(),
        }
    }

    /// Returns `|q|²`.
    #[must_use]
    pub fn square(&self) -> Ratio {
        &(&self.w * &self.w) + &self.u.square()
    }

    /// Returns the rotated vector: `R·v = ((w² − u·u)·v + 2·(u·v)·u + 2·w·(u × v))/|q|²`
    #[must_use]
    pub fn of(&self, v: &Vector) -> Vector {
        let (w, u, two) = (&self.w, &self.u, Ratio::whole(2));
        let straight = v.times(&(&(w * w) - &u.square()));
        let sum = &straight.along(&(&two * &u.dot(v)), u) + &u.cross(v).times(&(&two * w));
        sum.times(&(&Ratio::one() / &self.square()))
    }

    /// Returns the inverse rotation.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self {
            w: self.w.clone(),
            u: -&self.u,
        }
    }

    /// Returns the rotation that applies first `other`, then `self`. This is the product of the
    /// quaternions.
    #[must_use]
    pub fn after(&self, other: &Self) -> Self {
        let w = &(&self.w * &other.w) - &self.u.dot(&other.u);
        let u = &other.u.times(&self.w) + &self.u.times(&other.w);
        Self {
            w,
            u: &u + &self.u.cross(&other.u),
        }
    }

    /// Returns the columns of R: the coordinate axes after the rotation.
    #[must_use]
    pub fn axes(&self) -> [Vector; 3] {
        [0, 1, 2].map(|k| self.of(&Vector::unit(k)))
    }

    /// Returns the components of the unit quaternion as `f64`, each accurate to one unit in the
    /// last place.
    #[must_use]
    pub fn rounded(&self) -> [f64; 4] {
        let square = self.square();
        let [x, y, z] = &self.u.0;
        [&self.w, x, y, z].map(|c| (&(c * c) / &square).root().copysign(c.rounded()))
    }
}

/// The transformation `p ↦ scale·R·p + shift`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Motion {
    /// The rotation.
    pub turn: Rotation,
    /// The factor of all lengths.
    pub scale: Ratio,
    /// The translation, applied after rotation and scaling.
    pub shift: Vector,
}

impl Motion {
    /// Creates a rotation followed by a translation.
    #[must_use]
    pub fn rigid(turn: Rotation, shift: Vector) -> Self {
        Self {
            turn,
            scale: Ratio::one(),
            shift,
        }
    }

    /// Returns the identity.
    #[must_use]
    pub fn none() -> Self {
        Self::rigid(Rotation::none(), Vector::zero())
    }

    /// Returns the image of a direction; its length is unchanged.
    #[must_use]
    pub fn direction(&self, v: &Vector) -> Vector {
        self.turn.of(v)
    }

    /// Returns the image of a point.
    #[must_use]
    pub fn point(&self, p: &Vector) -> Vector {
        self.shift.along(&self.scale, &self.turn.of(p))
    }

    /// Returns the transformation that applies first `other`, then `self`.
    #[must_use]
    pub fn after(&self, other: &Self) -> Self {
        Self {
            turn: self.turn.after(&other.turn),
            scale: &self.scale * &other.scale,
            shift: self.point(&other.shift),
        }
    }

    /// Returns the inverse motion.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let (turn, scale) = (self.turn.inverse(), &Ratio::one() / &self.scale);
        let shift = -&turn.of(&self.shift).times(&scale);
        Self { turn, scale, shift }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_of_a_turn_permutes_the_axes() {
        let turn = Rotation::whole([1, 1, 1, 1]);
        assert_eq!(turn.of(&whole([1, 2, 3])), whole([3, 1, 2]));
        assert_eq!(turn.rounded(), [0.5; 4]);
        let full = turn.after(&turn).after(&turn);
        assert_eq!(full.of(&whole([1, 2, 3])), whole([1, 2, 3]));
    }

    #[test]
    fn a_motion_and_its_inverse_cancel() {
        let motion = Motion {
            turn: Rotation::whole([3, -1, 2, 5]),
            scale: Ratio::new(3, 7),
            shift: parts([1, -2, 5], 3),
        };
        let there = motion.point(&whole([2, 3, -1]));
        assert_eq!(motion.inverse().point(&there), whole([2, 3, -1]));
        let none = motion.after(&motion.inverse());
        assert_eq!(none.point(&whole([4, 5, 6])), whole([4, 5, 6]));
    }
}
