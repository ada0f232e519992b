//! Where joints, drives and forces take hold of bodies, told from their parameters: for pictures.
//! Where a reaction is reported is another question ([`Mechanism::place`]).

use joints::spec::{ForceSpec, Shape, Spec};

use super::Mechanism;
use crate::description::BodyRef;
use crate::reaction::ConstraintId;

/// An applied force as a picture needs it.
#[derive(Clone, Debug)]
pub struct AppliedForce<'m> {
    /// Its name.
    pub name: &'m str,
    /// Facts of its definition.
    pub spec: &'static ForceSpec,
    /// Its bodies.
    pub bodies: &'m [BodyRef],
    /// Points that it takes hold of, each in the frame of its body (m).
    pub points: Vec<(BodyRef, [f64; 2])>,
}

impl Mechanism {
    /// The points that a joint or drive takes hold of, each in the frame of its body (m; the
    /// ground's frame is the global one).
    ///
    /// ```
    /// use joints::Revolute;
    /// use model::{Body, BodyRef, ConstraintId, Description, Joint, Mechanism};
    /// let pin = Revolute { s_i: [0.0, 0.0], s_j: [0.0, 2.0] };
    /// let d = Description {
    ///     bodies: vec![Body { name: "bob".into(), mass: 1.0, inertia: 1.0, ..Body::default() }],
    ///     joints: vec![Joint::new("pivot", &[BodyRef::Ground, BodyRef::Body(0)], pin)],
    ///     ..Description::default()
    /// };
    /// let points = Mechanism::build(&d).unwrap().points(ConstraintId(0));
    /// assert_eq!(points, [(BodyRef::Ground, [0.0, 0.0]), (BodyRef::Body(0), [0.0, 2.0])]);
    /// ```
    ///
    /// # Panics
    /// If the mechanism has no such joint or drive.
    #[must_use]
    pub fn points(&self, id: ConstraintId) -> Vec<(BodyRef, [f64; 2])> {
        let c = &self.constraints[id.0];
        let element = c.element.element();
        placed(&element.spec().common, &c.bodies, element.points())
    }

    /// Its applied forces; the weight is none.
    pub fn applied_forces(&self) -> impl Iterator<Item = AppliedForce<'_>> {
        self.forces.iter().map(|f| {
            let element = f.element.element();
            let spec = element.spec();
            AppliedForce {
                name: &f.name,
                spec,
                bodies: &f.bodies,
                points: placed(&spec.common, &f.bodies, element.points()),
            }
        })
    }
}

/// Points with the bodies of their slots.
fn placed(spec: &Spec, bodies: &[BodyRef], points: Vec<[f64; 2]>) -> Vec<(BodyRef, [f64; 2])> {
    let slots = spec.parameters.iter().filter_map(|p| match p.shape {
        Shape::Point { slot } => Some(slot),
        _ => None,
    });
    slots.map(|slot| bodies[slot]).zip(points).collect()
}
