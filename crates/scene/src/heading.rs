//! `[scene]`: name, space, gravity and tolerances.

use joints::{Plane, Space, Space3};
use model::Tolerance;
use toml::de::DeTable;

use crate::cover::Cover;
use crate::key::{Key, Takes};
use crate::language;
use crate::mistake::Mistake;
use crate::nearest::{did_you_mean, list, nearest};
use crate::plausible;
use crate::section;
use crate::silence;
use crate::space::SceneSpace;
use crate::table::Table;
use crate::tolerance;

/// Names of the spaces of scenes.
fn spaces() -> Vec<&'static str> {
    vec![Plane::NAME, Space3::NAME]
}

const NAME: Key = Key::required("name", "the name of the scene", Takes::Text)
    .doc("Name of the scene in reports and figures");
const SPACE: Key = Key::required("space", "\"plane\" or \"spatial\"", Takes::OneOf(spaces))
    .doc("The space of the bodies");

/// Keys of `[scene]`, except the keys for gravity, tolerances and the title of reports.
pub(crate) const SCENE_KEYS: [Key; 2] = [NAME, SPACE];

/// `[scene]`
pub(crate) struct Heading<S: SceneSpace> {
    pub(crate) name: String,
    pub(crate) gravity: S::Vector<f64>,
    pub(crate) tolerance: Tolerance,
    pub(crate) cover: Cover,
}

impl<S: SceneSpace> Default for Heading<S> {
    fn default() -> Self {
        Self {
            name: String::new(),
            gravity: S::vector([0.0; 3]),
            tolerance: Tolerance::default(),
            cover: Cover::default(),
        }
    }
}

impl<S: SceneSpace> Heading<S> {
    /// Reads the section.
    pub(crate) fn read(mut table: Table) -> Self {
        let name = table.required(&NAME).and_then(|field| {
            let name = field.text(NAME.expected)?;
            if let Some((reason, label)) = section::unfit(name) {
                let message = format!("`[scene]`: `name` {reason}");
                table
                    .findings
                    .error(Mistake::UnfitName, field.span(), message, label);
            }
            Some(name.to_owned())
        });
        let space = table.required(&SPACE);
        if let Some(field) = space
            && let Some(space) = field.text(SPACE.expected)
            && space != S::NAME
        {
            let known = list(spaces());
            table.findings.error(
                Mistake::UnknownChoice,
                field.span(),
                format!("`[scene]`: `space` is \"{space}\", there are {known}"),
                did_you_mean(space, spaces()).unwrap_or_else(|| "no such space".to_owned()),
            );
        }
        let gravity = table.optional(&S::GRAVITY).and_then(|field| {
            let Key { expected, unit, .. } = S::GRAVITY;
            let gravity = field.vector::<S>(expected, unit)?;
            plausible::gravity(&field, gravity.as_ref());
            Some(gravity)
        });
        let tolerance = tolerance::of_scene(&mut table);
        for key in &language::read::SCENE_KEYS {
            table.optional(key);
        }
        silence::read(&mut table);
        let cover = Cover::read(&mut table);
        table.close();
        Self {
            name: name.unwrap_or_default(),
            gravity: gravity.unwrap_or_else(|| S::vector([0.0; 3])),
            tolerance,
            cover,
        }
    }
}

/// Returns whether the bodies of the scene move in space. If the key is missing or unknown, the
/// function uses the number of components of the first position or point, so that one mistake does
/// not cause many messages. If there is no position or point, the function uses the known name that
/// is most similar to the unknown name.
pub(crate) fn is_spatial(root: &DeTable) -> bool {
    let heading = root.get(section::SCENE.name);
    let space = heading.and_then(|heading| heading.get_ref().get(SPACE.name));
    let space = space.and_then(|space| space.get_ref().as_str());
    if let Some(known) = spaces().into_iter().find(|known| space == Some(*known)) {
        return known == Space3::NAME;
    }
    let points = [("body", "position"), ("joint", "at")].map(|(section, key)| {
        let entries = root.get(section).and_then(|all| all.get_ref().as_array());
        let points = entries.into_iter().flatten();
        let mut points = points.filter_map(|entry| entry.get_ref().get(key)?.get_ref().as_array());
        points.next().map(|point| point.len())
    });
    match points.into_iter().flatten().next() {
        Some(numbers) => numbers == Space3::DIM,
        None => space.and_then(|space| nearest(space, spaces())) == Some(Space3::NAME),
    }
}
