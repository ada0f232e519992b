//! Mechanisms with changed data: the changed values of a point, a direction or a scalar, and a
//! mechanism that stores these values.

use super::{Across, Data, DataBlock};
use crate::mechanism::Mechanism;
use crate::space::norm;
use crate::system::System;

impl DataBlock {
    /// Returns the number of independent directions in which the datum may change, for example two
    /// for a point in the plane, two for a direction in space, and one for a scalar.
    ///
    /// ```
    /// use joints::Revolute;
    /// use pfaff_model::{Body, BodyRef, Description, Mechanism, System};
    /// let mut d = Description::new("pendulum");
    /// let bob = d.body(Body::new("bob", 1.0, 1.0));
    /// d.joint("pin", &[BodyRef::Ground, bob], Revolute { s_i: [0.0; 2], s_j: [0.0, 2.0] });
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// let mut s = mechanism.scratch();
    /// mechanism.pose(0.0, &[0.0, -2.0, 0.0], &mut s);
    /// let blocks = mechanism.data().blocks(&s);
    /// assert_eq!(blocks[1].directions(), 2);
    /// assert_eq!(blocks[1].displaced(&[0.0, 2.0], [1e-3, 0.0, 0.0]), [1e-3, 2.0]);
    /// ```
    #[must_use]
    pub fn directions(&self) -> usize {
        match self.across {
            Some(Across::Along(_)) => 1,
            Some(Across::Normal(_)) => 2,
            None => self.numbers.len(),
        }
    }

    /// Returns the values of the datum after a change `by` (in the unit of the datum). Only the
    /// first [`Self::directions`] components of `by` are used. For a direction, the change is a
    /// rotation by this angle, so the length of the direction is constant. For axes, the change is
    /// a rotation vector.
    #[must_use]
    pub fn displaced(&self, own: &[f64], by: [f64; 3]) -> Vec<f64> {
        match (self.across, own) {
            (Some(Across::Along([x, y])), &[a, b]) => {
                let (sin, cos) = by[0].sin_cos();
                vec![a * cos + x * sin, b * cos + y * sin]
            }
            (Some(Across::Normal(n)), &[_, _, _]) => {
                let [first, second] = perpendicular(n);
                let angle = by[0].hypot(by[1]);
                if angle == 0.0 {
                    return own.to_vec();
                }
                let (sin, cos) = angle.sin_cos();
                let [u, v] = [by[0] / angle, by[1] / angle];
                let turned = |k: usize| n[k] * cos + (u * first[k] + v * second[k]) * sin;
                (0..3).map(turned).collect()
            }
            _ => own.iter().zip(by).map(|(x, by)| x + by).collect(),
        }
    }
}

impl DataBlock {
    /// Returns the unit vector along which a change of the datum has the largest effect on a
    /// quantity. `gradient` contains the derivatives of the quantity with respect to all stored
    /// values. The vector is zero if no change of the datum has an effect on the quantity.
    #[must_use]
    pub fn steepest(&self, gradient: &[f64]) -> [f64; 3] {
        let part = self.part(gradient);
        let along = match self.across {
            Some(Across::Normal(n)) => {
                let [u, v] = perpendicular(n).map(|e| (0..3).map(|k| e[k] * part[k]).sum());
                [u, v, 0.0]
            }
            _ => part,
        };
        let length = norm(&along);
        along.map(|x| if length > 0.0 { x / length } else { 0.0 })
    }
}

/// Returns two unit vectors perpendicular to a unit vector and to each other.
fn perpendicular(n: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).fold(0, |a, k| if n[k].abs() < n[a].abs() { k } else { a });
    let mut first: [f64; 3] = std::array::from_fn(|k| -n[least] * n[k]);
    first[least] += 1.0;
    let size = norm(&first);
    let first = first.map(|x| x / size);
    [first, crate::space::cross(n, first)]
}

impl Data<'_> {
    /// Returns all values that the constraints store, in the order of [`DataBlock::numbers`]. The
    /// function allocates memory.
    #[must_use]
    pub fn numbers(self) -> Vec<f64> {
        let mut all = vec![0.0; self.count()];
        for (c, places) in self.numbered() {
            c.kernels().data(&mut all[places]);
        }
        all
    }
}

impl Mechanism {
    /// Returns a mechanism whose constraints store other values, in the order of [`Data::numbers`].
    /// The new values also replace the stored initial values. Rows, names, tolerances and forces do
    /// not change, and no configuration is computed.
    ///
    /// # Panics
    /// Panics if the number of values differs from [`Data::count`].
    #[must_use]
    pub fn with_numbers(&self, numbers: &[f64]) -> Self {
        let count = self.data().count();
        assert!(
            numbers.len() == count,
            "{} numbers are given for constraints that store {count}",
            numbers.len()
        );
        let mut changed = self.clone();
        let elements = &mut changed.elements;
        let mut first = 0;
        for (c, group) in elements.constraints.iter_mut().zip(&self.layout().groups) {
            let own = first..first + c.spec().n_data();
            first = own.end;
            c.set_data(&numbers[own.clone()]);
            let entries = c.entries.clone();
            c.kernels().c_constant(&mut elements.entries[entries]);
            let armatures = elements.armatures.iter_mut();
            for armature in armatures.filter(|a| a.joint == group.name) {
                armature.share(c.spec(), &numbers[own.clone()]);
            }
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use joints::{Direction, PinInSlot, Translational, space3};

    use super::perpendicular;
    use crate::space::norm;
    use crate::{
        Body, BodyRef, Description, Mechanism, SpatialBody, SpatialDescription, System, Tolerance,
    };

    fn slider(axis: Direction, pin: [f64; 2]) -> Mechanism {
        let mut d = Description::new("slider");
        d.tolerance = Tolerance {
            length: Some(1e-3),
            angle: None,
        };
        let block = d.body(Body::new("block", 1.0, 1.0));
        let both = [BodyRef::Ground, block];
        let slide = Translational::new([0.0; 2], [0.0; 2], axis);
        d.joint("slide", &both, slide);
        let slot = PinInSlot {
            s_i: pin,
            s_j: [0.0; 2],
            axis,
        };
        d.joint("slot", &both, slot);
        Mechanism::build(&d).expect("it builds")
    }

    /// The direction on the ground determines constant entries of C.
    #[test]
    fn a_mechanism_with_other_numbers_is_the_one_built_with_them() {
        let old = slider(Direction::X, [0.0, 0.0]);
        let turned = Direction::new([0.6, 0.8]).expect("a direction");
        let new = slider(turned, [0.3, 0.4]);
        let changed = old.with_numbers(&new.data().numbers());
        let at = |m: &Mechanism| {
            let mut s = m.scratch();
            m.pose(0.0, &[0.1, 0.2, 0.3], &mut s);
            m.phi(&mut s);
            m.c(&mut s);
            (s.phi.clone(), m.layout().dense(&s))
        };
        assert_eq!(at(&changed), at(&new));
        assert_ne!(at(&old), at(&new));
    }

    #[test]
    fn tolerances_go_and_nothing_else() {
        let stated = slider(Direction::X, [0.0, 0.0]);
        assert!(stated.has_tolerances());
        let exact = stated.clone().without_tolerances();
        assert!(!exact.has_tolerances());
        assert_eq!(exact.data().numbers(), stated.data().numbers());
    }

    #[test]
    fn directions_turn_and_keep_their_length() {
        let plane = slider(Direction::X, [0.0, 0.0]);
        let mut s = plane.scratch();
        plane.pose(0.0, &[0.0; 3], &mut s);
        let blocks = plane.data().blocks(&s);
        let axis = blocks.iter().find(|b| b.name == "axis").expect("an axis");
        assert_eq!(axis.directions(), 1);
        let turned = axis.displaced(&[1.0, 0.0], [0.1, 9.0, 9.0]);
        assert!((turned[0] - 0.1_f64.cos()).abs() < 1e-16);
        assert!((turned[1] - 0.1_f64.sin()).abs() < 1e-16);
        let n = [0.48, 0.6, 0.64];
        let [a, b] = perpendicular(n);
        let dot = |x: [f64; 3], y: [f64; 3]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        for (x, y) in [(a, b), (a, n), (b, n)] {
            assert!(dot(x, y).abs() < 1e-15);
        }
        assert!((norm(&a) - 1.0).abs() < 1e-15 && (norm(&b) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn axes_of_space_turn_by_their_rotation_vector() {
        let mut d = SpatialDescription::new("door");
        let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let leaf = d.body(SpatialBody::new("leaf", 1.0, unit));
        let hinge = space3::Revolute {
            s_i: [0.0; 3],
            s_j: [0.0; 3],
            axis: space3::Axes::FRAME,
            axis_j: space3::Axes::FRAME,
        };
        d.joint("hinge", &[BodyRef::Ground, leaf], hinge);
        let door = Mechanism::build(&d).expect("it builds");
        let mut s = door.scratch();
        let (q, _) = door.described_state();
        door.pose(0.0, &q, &mut s);
        let blocks = door.data().blocks(&s);
        let mut numbers = door.data().numbers();
        let turned: Vec<_> = blocks.iter().filter(|b| b.name.contains("axis")).collect();
        assert!(!turned.is_empty());
        for block in &turned[..1] {
            let own = block.displaced(&numbers[block.numbers.clone()], [0.0, 1e-3, 0.0]);
            numbers[block.numbers.clone()].copy_from_slice(&own);
        }
        let changed = door.with_numbers(&numbers);
        changed.pose(0.0, &q, &mut s);
        changed.phi(&mut s);
        // The directions of the axes of the two bodies now differ by 1 mrad, and the points have
        // not moved.
        let largest = s.phi.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        assert!((largest - 1e-3).abs() < 1e-9, "{:?}", s.phi);
    }
}
