//! Creates the text of a scene whose initial state is at rest in other poses. The key `start` of
//! each body is written, and given velocities are set to zero. The rest of the text does not
//! change. Points, initial values and comments still refer to the described configuration.

use model::{DescribedBody, FramePose};
use toml::de::DeTable;

use super::key::SlotKind;
use super::{KeyError, Template, number};
use crate::language::Units;
use crate::scene::Scene;

/// Returns the text of a scene whose bodies are initially at rest in these poses, in the order of
/// the bodies.
///
/// ```
/// use model::FramePose;
/// let text = "[scene]\nname = \"drop\"\nspace = \"plane\"\n[[body]]\nname = \"bob\" # heavy\nmass = 1\ninertia = 1\n";
/// let scene = pfaff_scene::read("drop.toml", text, &model::Registry::standard()).unwrap();
/// let there = pfaff_scene::at_rest(&scene, &[FramePose::Plane { position: [0.5, 2.0], angle: 0.25 }])?;
/// assert!(there.contains("[[body]]\nstart = { position = [0.5, 2], angle = 0.25 }\nname = \"bob\" # heavy"));
/// # Ok::<(), pfaff_scene::KeyError>(())
/// ```
///
/// # Errors
/// - [`KeyError::NotToml`]: the scene was not read from a text.
/// - [`KeyError::NoRoom`]: a key cannot be added, because a body is given by dotted keys.
///
/// # Panics
/// Panics if the number of poses differs from the number of bodies.
pub fn at_rest(scene: &Scene, poses: &[FramePose]) -> Result<String, KeyError> {
    let text = scene.text().ok_or(KeyError::NotToml)?;
    let bodies = scene.description.bodies();
    assert_eq!(poses.len(), bodies.len(), "one pose for each body");
    let units = scene.units;
    let mut values: Vec<(String, String)> = Vec::new();
    for (k, (pose, body)) in poses.iter().zip(&bodies).enumerate() {
        let parts = parts(pose, units);
        let key = |name: &str| format!("body[{k}].{name}");
        if has_header(text, k) {
            // `[body.start]`
            let each = parts.into_iter();
            values.extend(each.map(|(name, value)| (key(&format!("start.{name}")), value)));
        } else {
            let each = parts
                .iter()
                .map(|(name, value)| format!("{name} = {value}"));
            let table = format!("{{ {} }}", each.collect::<Vec<_>>().join(", "));
            values.push((key("start"), table));
        }
        for (name, given) in moving(&body.described) {
            let zero = match given {
                1 => "0".to_owned(),
                n => format!("[{}]", vec!["0"; n].join(", ")),
            };
            values.push((key(name), zero));
        }
    }
    let keys: Vec<&str> = values.iter().map(|(key, _)| key.as_str()).collect();
    let template = Template::of(text, &keys, SlotKind::Value)?;
    let texts: Vec<String> = values.iter().map(|(_, value)| value.clone()).collect();
    Ok(template.filled(&texts))
}

/// Returns the keys of a pose with their values.
fn parts(pose: &FramePose, units: Units) -> [(&'static str, String); 2] {
    let length = |x: &f64| with_unit(*x, units.length, Units::SI.length);
    let angle = |x: f64| with_unit(x, units.angle, Units::SI.angle);
    match pose {
        FramePose::Plane {
            position,
            angle: turned,
        } => [
            ("position", list(position.iter().map(length))),
            ("angle", angle(*turned)),
        ],
        FramePose::Space3 {
            position,
            orientation,
        } => {
            let quaternion = list(orientation.iter().map(|x| number(*x)));
            [
                ("position", list(position.iter().map(length))),
                ("orientation", format!("{{ quaternion = {quaternion} }}")),
            ]
        }
    }
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}

/// Writes a number with its SI unit, if the unit `bare` of bare numbers in the scene is not the SI
/// unit.
fn with_unit(x: f64, bare: &str, si: &str) -> String {
    if bare == si {
        number(x)
    } else {
        format!("\"{} {si}\"", number(x))
    }
}

/// Returns the given velocities that are not zero, each with its number of components.
fn moving(body: &DescribedBody) -> Vec<(&'static str, usize)> {
    let (velocity, omega) = match body {
        DescribedBody::Plane(b) => (
            b.velocity.map(|v| v.to_vec()),
            b.angular_velocity.map(|w| vec![w]),
        ),
        DescribedBody::Space3(b) => (
            b.velocity.map(|v| v.to_vec()),
            b.angular_velocity.map(|w| w.to_vec()),
        ),
    };
    let all = [("velocity", velocity), ("angular_velocity", omega)].into_iter();
    all.filter_map(|(name, v)| {
        let v = v.filter(|v| v.iter().any(|x| *x != 0.0))?;
        Some((name, v.len()))
    })
    .collect()
}

/// Returns whether the key `start` of a body is a table with its own header.
fn has_header(text: &str, body: usize) -> bool {
    let has = || {
        let root = DeTable::parse(text).ok()?;
        let bodies = root.get_ref().get("body")?.get_ref().as_array()?;
        let start = bodies.get(body)?.get_ref().as_table()?.get("start")?;
        Some(!text[start.span()].starts_with('{'))
    };
    has().unwrap_or_default()
}
