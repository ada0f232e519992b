//! References to joints and joint coordinates in other tables: one joint, two joints, two joint
//! coordinates.

use std::cell::OnceCell;
use std::collections::HashMap;

use model::BodyRef;

use crate::bodies::Bodies;
use crate::field::{Field, all};
use crate::joint_measure::{JointMeasure, Purpose};
use crate::joint_read::JointRead;
use crate::mistake::Mistake;
use crate::nearest;
use crate::space::SceneSpace;

/// The items to which the table of an element may refer.
pub(crate) struct References<'a, 'j, 'r, S: SceneSpace> {
    pub(crate) bodies: &'a Bodies<S>,
    pub(crate) joints: &'a JointNames<'j, 'r, S>,
    /// Whether the element is part of the mechanism.
    pub(crate) is_active: bool,
}

/// The joints, which can be found by name.
pub(crate) struct JointNames<'j, 'r, S: SceneSpace> {
    list: &'j [JointRead<'r, S>],
    /// Joints by name; if a name is used twice, the first joint.
    by_name: HashMap<&'j str, &'j JointRead<'r, S>>,
    /// Joints by body. This table is computed at the first use.
    by_body: OnceCell<HashMap<BodyRef, Vec<&'j JointRead<'r, S>>>>,
}

impl<'j, 'r, S: SceneSpace> JointNames<'j, 'r, S> {
    pub(crate) fn of(list: &'j [JointRead<'r, S>]) -> Self {
        let mut by_name = HashMap::with_capacity(list.len());
        for joint in list {
            by_name.entry(joint.name.as_str()).or_insert(joint);
        }
        Self {
            list,
            by_name,
            by_body: OnceCell::new(),
        }
    }

    /// All joints.
    pub(crate) fn all(&self) -> &'j [JointRead<'r, S>] {
        self.list
    }

    /// The joints of a body that could be read completely.
    pub(crate) fn of_body(&self, body: BodyRef) -> &[&'j JointRead<'r, S>] {
        let by_body = self.by_body.get_or_init(|| {
            let mut by_body: HashMap<_, Vec<_>> = HashMap::new();
            for joint in self.list {
                for &body in joint.complete.iter().flat_map(|own| &own.joint.bodies) {
                    by_body.entry(body).or_default().push(joint);
                }
            }
            by_body
        });
        by_body.get(&body).map_or(&[], Vec::as_slice)
    }

    /// Returns the joint with the name in this field. An active table must refer to active joints.
    pub(crate) fn find(
        &self,
        name: &str,
        field: &Field,
        (purpose, is_active): (Purpose, bool),
    ) -> Option<&'j JointRead<'r, S>> {
        let Some(joint) = self.by_name.get(name).copied() else {
            self.unknown(name, field);
            return None;
        };
        if is_active && !joint.is_active {
            field.findings.collision(
                Mistake::Inactive,
                field.span(),
                format!(
                    "{} {} joint `{name}`, which is not active",
                    field.subject,
                    purpose.verb()
                ),
                "write `active = false` here, too, or remove it from the joint",
                joint.span.clone(),
                "this joint is not active",
            );
        }
        Some(joint)
    }

    fn unknown(&self, name: &str, field: &Field) {
        let names = || self.list.iter().map(|joint| joint.name.as_str());
        let near = field.findings.suggest(name, names());
        let near = near.and_then(|near| self.by_name.get(near));
        let label = match near {
            Some(near) => format!(
                "no such joint; `{}` is defined on line {}",
                near.name,
                field.findings.line(near.span.start)
            ),
            None => "no such joint".to_owned(),
        };
        field.error_with_help(
            Mistake::UnknownJoint,
            format!(" refers to the unknown joint `{name}`"),
            label,
            match near {
                Some(near) => Some(format!("did you mean `{}`?", near.name)),
                None => nearest::all("joints", names()),
            },
        );
    }

    /// Reads the joint whose name is the value of a field.
    pub(crate) fn one(
        &self,
        field: &Field,
        usage: (Purpose, bool),
    ) -> Option<&'j JointRead<'r, S>> {
        let name = field.text("the name of a joint")?;
        self.find(name, field, usage)
    }

    /// Reads two joints.
    pub(crate) fn two(
        &self,
        field: &Field,
        expected: &str,
        usage: (Purpose, bool),
    ) -> Option<[&'j JointRead<'r, S>; 2]> {
        pair(field, expected, |item| {
            let name = item.text(expected)?;
            self.find(name, item, usage)
        })
    }

    /// Reads two joint coordinates, each in the form `joint.measure`; names of joints may contain
    /// dots.
    pub(crate) fn two_measures(
        &self,
        field: &Field,
        expected: &str,
        usage: (Purpose, bool),
    ) -> Option<[JointMeasure<'j, 'r, S>; 2]> {
        pair(field, expected, |item| {
            let text = item.text(expected)?;
            let Some((name, measure)) = text.rsplit_once('.') else {
                item.error(
                    Mistake::UnknownMeasure,
                    format!(": `{text}` is not a measure of a joint"),
                    "write `joint.measure`, for example \"A.angle\"",
                );
                return None;
            };
            let joint = self.find(name, item, usage)?;
            joint.measure(Some(measure), usage.0, item)
        })
    }
}

/// Reads both values of a list with two values.
fn pair<T>(field: &Field, expected: &str, read: impl Fn(&Field) -> Option<T>) -> Option<[T; 2]> {
    let items = field.items(expected)?;
    if items.len() != 2 {
        field.miscount(expected, items.len(), 2);
        return None;
    }
    all(&items, read)?.try_into().ok()
}
