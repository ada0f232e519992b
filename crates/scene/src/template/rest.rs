//! Creates the text of a scene that starts in other poses. The key `start` of each body is written,
//! and given velocities are set to zero or removed. The rest of the text does not
//! change. Points, initial values and comments still refer to the described configuration.

use model::{DescribedBody, FramePose};
use toml::de::DeTable;

use super::edit::{edited, entry};
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
    let bodies = scene.description.bodies();
    let still = bodies.iter().enumerate().flat_map(|(k, body)| {
        let zero = move |(name, given): (&str, usize)| {
            let zero = match given {
                1 => "0".to_owned(),
                n => format!("[{}]", vec!["0"; n].join(", ")),
            };
            (format!("body[{k}].{name}"), zero)
        };
        moving(&body.described).into_iter().map(zero)
    });
    written(scene, poses, still.collect())
}

/// Returns the text of a scene whose bodies start in these poses, in the order of the bodies. Given
/// velocities belong to other poses and are removed, so that the start finds consistent velocities.
///
/// ```
/// use model::FramePose;
/// let text = "[scene]\nname = \"drop\"\nspace = \"plane\"\n[[body]]\nname = \"bob\"\nvelocity = [1, 0] # m/s\nmass = 1\ninertia = 1\n";
/// let scene = pfaff_scene::read("drop.toml", text, &model::Registry::standard()).unwrap();
/// let there = pfaff_scene::posed(&scene, &[FramePose::Plane { position: [0.5, 2.0], angle: 0.25 }])?;
/// assert!(there.ends_with("[[body]]\nstart = { position = [0.5, 2], angle = 0.25 }\nname = \"bob\"\nmass = 1\ninertia = 1\n"));
/// # Ok::<(), pfaff_scene::KeyError>(())
/// ```
///
/// # Errors
/// Returns the errors of [`at_rest`].
///
/// # Panics
/// Panics if the number of poses differs from the number of bodies.
pub fn posed(scene: &Scene, poses: &[FramePose]) -> Result<String, KeyError> {
    let text = written(scene, poses, Vec::new())?;
    let root = DeTable::parse(&text).map_err(|_| KeyError::NotToml)?;
    let bodies = root.get_ref().get("body");
    let bodies = bodies.and_then(|bodies| bodies.get_ref().as_array());
    let mut edits = Vec::new();
    for body in bodies.into_iter().flatten() {
        let is_inline = text[body.span()].starts_with('{');
        let keys = body.get_ref().as_table().into_iter().flatten();
        for (key, value) in keys.filter(|(key, _)| VELOCITIES.contains(&key.get_ref().as_ref())) {
            let span = key.span().start..value.span().end;
            edits.push((entry(&text, span, is_inline), String::new()));
        }
    }
    edited(&text, edits).ok_or(KeyError::NotToml)
}

/// Returns the text of a scene that starts at a time (s), with its bodies in these poses and with
/// these velocities of their frames, in the order of the bodies. In space, angular velocities are
/// in ground axes.
///
/// ```
/// use model::FramePose;
/// let text = "[scene]\nname = \"drop\"\nspace = \"plane\"\n[[body]]\nname = \"bob\"\nmass = 1\ninertia = 1\n";
/// let scene = pfaff_scene::read("drop.toml", text, &model::Registry::standard()).unwrap();
/// let pose = FramePose::Plane { position: [0.5, 2.0], angle: 0.25 };
/// let there = pfaff_scene::in_motion(&scene, 1.5, &[pose], &[[[1.0, 0.0, 0.0], [0.0, 0.0, 3.0]]])?;
/// let found = pfaff_scene::read("drop.toml", &there, &model::Registry::standard()).unwrap();
/// let body = &found.description.plane().unwrap().bodies[0];
/// assert_eq!((body.velocity, body.angular_velocity), (Some([1.0, 0.0]), Some(3.0)));
/// assert_eq!(found.description.plane().unwrap().start_time, 1.5);
/// # Ok::<(), pfaff_scene::KeyError>(())
/// ```
///
/// # Errors
/// Returns the errors of [`at_rest`].
///
/// # Panics
/// Panics if the number of poses differs from the number of bodies.
pub fn in_motion(
    scene: &Scene,
    time: f64,
    poses: &[FramePose],
    velocities: &[[[f64; 3]; 2]],
) -> Result<String, KeyError> {
    let units = scene.units;
    let speed = |x: &f64| with_unit(*x, (units.length, Units::SI.length), "/s");
    let spin = |x: &f64| with_unit(*x, (units.angle, Units::SI.angle), "/s");
    let moving = velocities.iter().zip(poses).zip(0..);
    let values = moving.flat_map(|(([v, omega], pose), k)| {
        let (v, omega) = match pose {
            FramePose::Plane { .. } => (list(v[..2].iter().map(speed)), spin(&omega[2])),
            FramePose::Space3 { .. } => (list(v.iter().map(speed)), list(omega.iter().map(spin))),
        };
        let key = |name: &str| format!("body[{k}].{name}");
        [(key("velocity"), v), (key("angular_velocity"), omega)]
    });
    let mut values: Vec<(String, String)> = values.collect();
    let time = number(time);
    let text = scene.text().ok_or(KeyError::NotToml)?;
    let root = DeTable::parse(text).map_err(|_| KeyError::NotToml)?;
    if root.get_ref().get("start").is_some() {
        values.push(("start.time".to_owned(), time));
        return written(scene, poses, values);
    }
    let text = written(scene, poses, values)?;
    Ok(format!("{}\n\n[start]\ntime = {time}\n", text.trim_end()))
}

/// Keys of given velocities of a body.
const VELOCITIES: [&str; 2] = ["velocity", "angular_velocity"];

/// Writes the poses, and these keys with their values.
fn written(
    scene: &Scene,
    poses: &[FramePose],
    mut values: Vec<(String, String)>,
) -> Result<String, KeyError> {
    let text = scene.text().ok_or(KeyError::NotToml)?;
    let bodies = scene.description.bodies();
    assert_eq!(poses.len(), bodies.len(), "one pose for each body");
    for (k, pose) in poses.iter().enumerate() {
        let parts = parts(pose, scene.units);
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
    }
    let keys: Vec<&str> = values.iter().map(|(key, _)| key.as_str()).collect();
    let template = Template::of(text, &keys, SlotKind::Value)?;
    let texts: Vec<String> = values.iter().map(|(_, value)| value.clone()).collect();
    Ok(template.filled(&texts))
}

/// Returns the keys of a pose with their values.
fn parts(pose: &FramePose, units: Units) -> [(&'static str, String); 2] {
    let length = |x: &f64| with_unit(*x, (units.length, Units::SI.length), "");
    let angle = |x: f64| with_unit(x, (units.angle, Units::SI.angle), "");
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
/// unit. `per` is the rest of the unit.
fn with_unit(x: f64, (bare, si): (&str, &str), per: &str) -> String {
    if bare == si {
        number(x)
    } else {
        format!("\"{} {si}{per}\"", number(x))
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
