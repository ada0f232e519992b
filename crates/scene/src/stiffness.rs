//! `centre_of_stiffness`: the point about which the bodies of a joint rotate elastically under a
//! moment.

use model::{BodyRef, SpaceKind};

use crate::bodies::Bodies;
use crate::dimension::Dimension;
use crate::key::Key;
use crate::space::SceneSpace;
use crate::table::Table;

/// The point about which the bodies of a joint rotate elastically under a moment. It is used in
/// bounds and for elastic supports.
#[derive(Clone, Debug, PartialEq)]
pub struct CentreOfStiffness {
    /// Name of the joint.
    pub joint: String,
    /// The last body of the joint. The point is fixed to this body.
    pub body: BodyRef,
    /// The point in the frame of this body, or of the ground (m).
    pub point: [f64; 3],
}

/// The key of a joint in a space.
pub(crate) const fn key(space: SpaceKind) -> Key {
    let key = match space {
        SpaceKind::Space3 => Key::triple("centre_of_stiffness"),
        _ => Key::pair("centre_of_stiffness"),
    };
    key.unit(Dimension::LENGTH).doc(
        "The point about which the moment of the joint gives way, in global coordinates as described; the last body carries it. Only bounds and elastic supports use it [default: the reference point]",
    )
}

/// Reads the key of a joint between these bodies, if the bodies are known.
pub(crate) fn read<S: SceneSpace>(
    table: &mut Table,
    name: &str,
    joined: Option<&[BodyRef]>,
    bodies: &Bodies<S>,
) -> Option<CentreOfStiffness> {
    let point = table.vector::<S>(&key(S::KIND))?;
    let body = *joined?.last()?;
    let origin = bodies.about_centre(body, S::of_numbers(&[0.0; 3][..S::DIM])?);
    let [about, origin] = [bodies.to_local(body, point), origin].map(S::point);
    Some(CentreOfStiffness {
        joint: name.to_owned(),
        body,
        point: [0, 1, 2].map(|k| about[k] - origin[k]),
    })
}
