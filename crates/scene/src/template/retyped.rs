//! Creates the text of a scene with other types of joints.

use joints::spec::{Shape, Spec};
use toml::{Table, Value};

use crate::direction;
use crate::key::TYPE;
use crate::limits;
use crate::section;

/// A joint of a scene with another type.
#[derive(Clone, Debug)]
pub struct RetypedJoint {
    /// Name of the joint.
    pub joint: String,
    /// The type in the text.
    pub from: &'static Spec,
    /// The new type.
    pub to: &'static Spec,
    /// Keys of directions with their vectors, in the frame of the first body. If the list is empty,
    /// the directions in the text are kept, as far as the new type has keys for them.
    pub directions: Vec<(&'static str, Vec<f64>)>,
}

/// Returns the text of a scene in which joints have other types. Returns `None` if the text is not
/// TOML or does not contain one of the joints. Bodies and points do not change. Comments are
/// removed.
///
/// ```
/// use model::Registry;
/// use pfaff_scene::RetypedJoint;
/// let registry = Registry::standard();
/// let spec = |name| &registry.space().constraints(name).next().unwrap().spec.common;
/// let text = "[[joint]]\nname = \"hinge\"\ntype = \"revolute\"\naxis = [0, 0, 1]\nat = [0, 0, 0]\n";
/// let ball = RetypedJoint {
///     joint: "hinge".into(),
///     from: spec("revolute"),
///     to: spec("spherical"),
///     directions: Vec::new(),
/// };
/// let changed = pfaff_scene::retyped(text, &[&ball]).unwrap();
/// assert_eq!(changed, "[[joint]]\nat = [0, 0, 0]\nname = \"hinge\"\ntype = \"spherical\"\n");
/// assert_eq!(pfaff_scene::retyped("[[joint]]\nname = \"slide\"\n", &[&ball]), None);
/// ```
#[must_use]
pub fn retyped(text: &str, joints: &[&RetypedJoint]) -> Option<String> {
    let is_small = limits::excess(text).is_none();
    let mut root: Table = is_small.then(|| text.parse().ok())??;
    for change in joints {
        let table = joint(&mut root, &change.joint)?;
        // If `frame` stayed in the table, the directions would be in other axes.
        if !change.directions.is_empty() && table.contains_key(direction::FRAME) {
            return None;
        }
        let known = keys(change.to);
        for key in keys(change.from) {
            if !change.directions.is_empty() || !known.contains(&key) {
                table.remove(key);
            }
        }
        table.insert(TYPE.to_owned(), change.to.scene_type.into());
        for (key, vector) in &change.directions {
            table.insert((*key).to_owned(), vector.clone().into());
        }
    }
    Some(root.to_string())
}

/// Returns the table of a joint.
fn joint<'t>(root: &'t mut Table, name: &str) -> Option<&'t mut Table> {
    let joints = root.get_mut(section::JOINT.name)?.as_array_mut()?;
    let mut tables = joints.iter_mut().filter_map(Value::as_table_mut);
    tables.find(|table| table.get("name").and_then(Value::as_str) == Some(name))
}

/// Returns the keys of the directions of a type.
fn keys(spec: &'static Spec) -> Vec<&'static str> {
    let is_direction = |shape| matches!(shape, Shape::Direction { .. } | Shape::Axes { .. });
    let own = spec.parameters.iter().filter(|p| is_direction(p.shape));
    own.map(|p| p.name).chain(direction::keys(spec)).collect()
}
