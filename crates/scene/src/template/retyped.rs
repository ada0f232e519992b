//! Creates the text of a scene with other types of joints.

use joints::spec::{Shape, Spec};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::edit::{Edits, edited, entry};
use super::number;
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
/// TOML or does not contain one of the joints. The rest of the text does not change, comments
/// included.
///
/// ```
/// use model::Registry;
/// use pfaff_scene::RetypedJoint;
/// let registry = Registry::standard();
/// let spec = |name| &registry.space().constraints(name).next().unwrap().spec.common;
/// let text = "[[joint]]\nname = \"hinge\"\ntype = \"revolute\" # a pin\naxis = [0, 0, 1]\nat = [0, 0, 0]\n";
/// let ball = RetypedJoint {
///     joint: "hinge".into(),
///     from: spec("revolute"),
///     to: spec("spherical"),
///     directions: Vec::new(),
/// };
/// let changed = pfaff_scene::retyped(text, &[&ball]).unwrap();
/// assert_eq!(changed, "[[joint]]\nname = \"hinge\"\ntype = \"spherical\" # a pin\nat = [0, 0, 0]\n");
/// assert_eq!(pfaff_scene::retyped("[[joint]]\nname = \"slide\"\n", &[&ball]), None);
/// ```
#[must_use]
pub fn retyped(text: &str, joints: &[&RetypedJoint]) -> Option<String> {
    let is_small = limits::excess(text).is_none();
    let root = is_small.then(|| DeTable::parse(text).ok())??;
    let mut edits = Vec::new();
    for change in joints {
        edits.extend(edits_of(
            text,
            joint(root.get_ref(), &change.joint)?,
            change,
        )?);
    }
    edited(text, edits)
}

/// Returns the changes of the table of a joint.
fn edits_of(text: &str, table: &Spanned<DeValue<'_>>, change: &RetypedJoint) -> Option<Edits> {
    let is_inline = text[table.span()].starts_with('{');
    let table = table.get_ref().as_table()?;
    // If `frame` stayed in the table, the directions would be in other axes.
    if !change.directions.is_empty() && table.contains_key(direction::FRAME) {
        return None;
    }
    let known = keys(change.to);
    let mut edits = Vec::new();
    for (key, value) in table {
        let name = key.get_ref().as_ref();
        let is_gone = !change.directions.is_empty() || !known.contains(&name);
        if is_gone && keys(change.from).contains(&name) {
            let span = key.span().start..value.span().end;
            edits.push((entry(text, span, is_inline), String::new()));
        }
    }
    let mut new = format!("\"{}\"", change.to.scene_type);
    let between = if is_inline { ", " } else { "\n" };
    for (key, vector) in &change.directions {
        let vector: Vec<String> = vector.iter().map(|x| number(*x)).collect();
        new += &format!("{between}{key} = [{}]", vector.join(", "));
    }
    let old = table.get(TYPE)?.span();
    // A comment after the type stays with the type.
    let line = &text[old.end..];
    let comment = line[..line.find('\n').unwrap_or(line.len())].trim_end();
    if !is_inline && let Some((kind, directions)) = new.split_once('\n') {
        let end = old.end + comment.len();
        edits.push((old.start..end, format!("{kind}{comment}\n{directions}")));
    } else {
        edits.push((old, new));
    }
    Some(edits)
}

/// Returns the table of a joint.
fn joint<'t>(root: &'t DeTable<'t>, name: &str) -> Option<&'t Spanned<DeValue<'t>>> {
    let joints = root.get(section::JOINT.name)?.get_ref().as_array()?;
    joints.iter().find(|joint| {
        let own = joint
            .get_ref()
            .as_table()
            .and_then(|table| table.get("name"));
        own.and_then(|own| own.get_ref().as_str()) == Some(name)
    })
}

/// Returns the keys of the directions of a type.
fn keys(spec: &'static Spec) -> Vec<&'static str> {
    let is_direction = |shape| matches!(shape, Shape::Direction { .. } | Shape::Axes { .. });
    let own = spec.parameters.iter().filter(|p| is_direction(p.shape));
    own.map(|p| p.name).chain(direction::keys(spec)).collect()
}
