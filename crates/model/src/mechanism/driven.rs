//! What drives prescribe: which measure of which joint, and by how much.

use crate::mechanism::Mechanism;
use crate::reaction::ConstraintId;
use crate::system::{Scratch, System};

impl Mechanism {
    /// The joint whose measure a drive prescribes, and the name of the measure: a joint of the same
    /// bodies and points whose definition has this drive. `None` if there is none, or this is no
    /// drive.
    ///
    /// ```
    /// use joints::{Revolute, RevoluteAngleDrive};
    /// use model::{Body, BodyRef, ConstraintId, Description, Function, Mechanism};
    /// let mut d = Description::new("crank");
    /// let crank = d.body(Body::new("crank", 1.0, 1.0));
    /// let (bodies, s) = ([BodyRef::Ground, crank], [0.0, 0.0]);
    /// d.joint("pin", &bodies, Revolute { s_i: s, s_j: s });
    /// let motor = RevoluteAngleDrive { s_i: s, s_j: s, measure_0: 0.0 };
    /// d.drive("motor", &bodies, motor, Function::constant_rate(1.0).unwrap());
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// assert_eq!(mechanism.driven(ConstraintId(1)), Some((ConstraintId(0), "angle")));
    /// assert_eq!(mechanism.driven(ConstraintId(0)), None);
    /// ```
    ///
    /// # Panics
    /// If the mechanism has no such joint or drive.
    #[must_use]
    pub fn driven(&self, drive: ConstraintId) -> Option<(ConstraintId, &'static str)> {
        let groups = &self.layout().groups;
        let own = &groups[drive.0];
        if !own.is_drive() {
            return None;
        }
        let points = self.points(drive);
        let definition = own.spec.common.name;
        self.constraint_ids().find_map(|id| {
            let group = &groups[id.0];
            let mut measures = group.spec.measures.iter();
            let measure = measures.find(|measure| measure.drive == definition)?;
            let is_same = group.bodies == own.bodies && self.points(id) == points;
            is_same.then_some((id, measure.name))
        })
    }

    /// Value, rate and second derivative of each function of time that a joint or drive takes, at
    /// the time of the scratch. Those of a drive are the change of its measure since the start.
    ///
    /// # Panics
    /// If the mechanism has no such joint or drive.
    #[must_use]
    pub fn prescribed<'s>(&self, id: ConstraintId, s: &'s Scratch) -> &'s [[f64; 3]] {
        &s.jets[self.constraints()[id.0].functions.clone()]
    }
}
