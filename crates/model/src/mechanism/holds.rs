//! The points at which joints and drives act on bodies, for drawings. The points are computed from
//! the parameters of the joints and drives. The module also returns the coordinates that drives
//! prescribe, and the prescribed values.
//!
//! The reference point of a reaction is defined by [`crate::Reactions::place`].

use super::Mechanism;
use crate::body::BodyRef;
use crate::group::ConstraintId;
use crate::system::Scratch;

impl Mechanism {
    /// Returns the points at which a joint or drive acts (m). Each point is relative to the centre
    /// of mass of its body, in the axes of the coordinates of the body. [`crate::Frames::vector`]
    /// transforms them to the axes of the body frame. Points of the ground are in ground
    /// coordinates.
    ///
    /// ```
    /// use joints::Revolute;
    /// use pfaff_model::{Body, BodyRef, ConstraintId, Description, Joint, Mechanism};
    /// let pin = Revolute { s_i: [0.0, 0.0], s_j: [0.0, 2.0] };
    /// let d = Description {
    ///     bodies: vec![Body { name: "bob".into(), mass: 1.0, inertia: 1.0, ..Body::default() }],
    ///     joints: vec![Joint::new("pivot", &[BodyRef::Ground, BodyRef::Body(0)], pin)],
    ///     ..Description::default()
    /// };
    /// let points = Mechanism::build(&d).unwrap().points(ConstraintId(0));
    /// let [origin, top] = [[0.0; 3], [0.0, 2.0, 0.0]];
    /// assert_eq!(points, [(BodyRef::Ground, origin), (BodyRef::Body(0), top)]);
    /// ```
    ///
    /// # Panics
    /// Panics if the joint or drive does not exist.
    #[must_use]
    pub fn points(&self, id: ConstraintId) -> Vec<(BodyRef, [f64; 3])> {
        let c = &self.elements.constraints[id.0];
        let slots = c.spec().common.slots_of_points();
        slots
            .map(|slot| c.site.bodies[slot])
            .zip(c.kernels().points())
            .collect()
    }

    /// Returns the joint whose coordinate a drive prescribes, and the name of the coordinate. The
    /// joint has the same bodies and points as the drive, and its definition contains this drive.
    /// Returns `None` if this joint does not exist, or if the argument is not a drive.
    ///
    /// ```
    /// use joints::{Revolute, RevoluteAngleDrive};
    /// use pfaff_model::{Body, BodyRef, ConstraintId, Description, Function, Mechanism};
    /// let mut d = Description::new("crank");
    /// let crank = d.body(Body::new("crank", 1.0, 1.0));
    /// let (bodies, s) = ([BodyRef::Ground, crank], [0.0, 0.0]);
    /// d.joint("pin", &bodies, Revolute { s_i: s, s_j: s });
    /// let motor = RevoluteAngleDrive::new(s, s);
    /// d.drive("motor", &bodies, motor, Function::constant_rate(1.0).unwrap());
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// assert_eq!(mechanism.driven(ConstraintId(1)), Some((ConstraintId(0), "angle")));
    /// assert_eq!(mechanism.driven(ConstraintId(0)), None);
    /// ```
    ///
    /// # Panics
    /// Panics if the joint or drive does not exist.
    #[must_use]
    pub fn driven(&self, drive: ConstraintId) -> Option<(ConstraintId, &'static str)> {
        let groups = &self.layout.groups;
        let own = &groups[drive.0];
        if !own.is_drive() {
            return None;
        }
        let points = self.points(drive);
        let definition = own.spec.common.name;
        self.layout.constraint_ids().find_map(|id| {
            let group = &groups[id.0];
            let mut measures = group.spec.measures.iter();
            let measure = measures.find(|measure| measure.drive == definition)?;
            let is_same = group.bodies == own.bodies && self.points(id) == points;
            is_same.then_some((id, measure.name))
        })
    }

    /// Returns value, rate and second derivative of each function of time of a joint or drive, at
    /// the time in the work space. For a drive, the values are those of the change of the joint
    /// coordinate since the start.
    ///
    /// # Panics
    /// Panics if the joint or drive does not exist.
    #[must_use]
    pub fn prescribed<'s>(&self, id: ConstraintId, s: &'s Scratch) -> &'s [[f64; 3]] {
        self.elements.constraints[id.0].site.f(&s.slots)
    }
}
