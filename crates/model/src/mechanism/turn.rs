//! Transforms the points and directions of constraints on bodies with products of inertia to
//! principal axes.

use joints::Space3;
use joints::spec::DatumShape;

use crate::body::{BodyRecord, BodyRef};
use crate::element::{AnyConstraint, ConstraintKernels, FramedConstraint};
use crate::principal::Principal;

/// Returns the principal axes of each body of an element, if they differ from the axes of the body
/// frame.
pub(super) fn principal(bodies: &[BodyRecord], slots: &[BodyRef]) -> Vec<Option<Principal>> {
    let of = |body: &BodyRef| bodies.get(body.moving()?)?.principal.clone();
    slots.iter().map(of).collect()
}

/// Returns a constraint of the description with its data transformed to the principal axes of its
/// bodies.
pub(super) fn constraint(
    element: AnyConstraint,
    bodies: &[BodyRecord],
    slots: &[BodyRef],
) -> FramedConstraint {
    FramedConstraint::new(element, |element| {
        let AnyConstraint::Space3(kernels) = element else {
            return;
        };
        for (slot, principal) in principal(bodies, slots).iter().enumerate() {
            if let Some(principal) = principal {
                turn_slot(kernels.as_mut(), slot, principal);
            }
        }
    })
}

fn turn_slot(kernels: &mut dyn ConstraintKernels<Space3>, slot: usize, principal: &Principal) {
    let spec = kernels.spec();
    let mut numbers = vec![0.0; spec.n_data()];
    kernels.data(&mut numbers);
    for datum in spec.data {
        let own = &mut numbers[datum.numbers()];
        let vector = |own: &[f64]| [own[0], own[1], own[2]];
        match datum.shape {
            DatumShape::Point { slot: at }
            | DatumShape::Direction { slot: at }
            | DatumShape::KeptVector { slot: at }
                if at == slot =>
            {
                own.copy_from_slice(&principal.own(vector(own)));
            }
            DatumShape::Axes { slot: at } if at == slot => {
                own.copy_from_slice(&principal.rotation_vector());
            }
            _ => {}
        }
    }
    kernels.set_data(&numbers);
}
