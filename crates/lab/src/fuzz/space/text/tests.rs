//! Tests that an independent reader of the text, which uses doubles, obtains every joint at its
//! drawn position.

use std::collections::BTreeMap;

use toml::{Table, Value};

use super::super::{catalogue, scenes};
use super::*;

/// Relative error of points and directions that are computed from the text in doubles.
const ROUNDING: f64 = 1e-13;

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    let number = |x: &Value| x.as_float().expect("a number with a point");
    list.iter().map(number).collect()
}

fn vector(value: &Value) -> [f64; 3] {
    numbers(value).try_into().expect("three numbers")
}

fn word<'a>(table: &'a Table, key: &str) -> &'a str {
    table[key].as_str().expect("a word")
}

/// A frame in doubles: position, and the columns of its rotation.
struct Frame {
    position: [f64; 3],
    axes: [[f64; 3]; 3],
}

impl Frame {
    fn of(body: &Table) -> Self {
        let quaternion = body.get("orientation").map(|o| numbers(&o["quaternion"]));
        let q = quaternion.unwrap_or(vec![1.0, 0.0, 0.0, 0.0]);
        let [w, x, y, z] = q[..] else {
            panic!("four numbers")
        };
        let length = (w * w + x * x + y * y + z * z).sqrt();
        assert!((length - 1.0).abs() < ROUNDING, "{length}");
        let axes = [
            [
                w * w + x * x - y * y - z * z,
                2.0 * (x * y + w * z),
                2.0 * (x * z - w * y),
            ],
            [
                2.0 * (x * y - w * z),
                w * w - x * x + y * y - z * z,
                2.0 * (y * z + w * x),
            ],
            [
                2.0 * (x * z + w * y),
                2.0 * (y * z - w * x),
                w * w - x * x - y * y + z * z,
            ],
        ];
        Self {
            position: vector(&body["position"]),
            axes,
        }
    }

    fn ground() -> Self {
        Self {
            position: [0.0; 3],
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        }
    }

    fn direction(&self, v: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| (0..3).map(|k| self.axes[k][i] * v[k]).sum())
    }

    fn point(&self, p: [f64; 3]) -> [f64; 3] {
        let turned = self.direction(p);
        [0, 1, 2].map(|i| self.position[i] + turned[i])
    }
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// Returns the points of the first and of the second body, in the axes of the ground.
fn points(joint: &Table, names: &[&str], frames: &BTreeMap<String, Frame>) -> Vec<[f64; 3]> {
    if let Some(at) = joint.get("at") {
        let list = at.as_array().expect("a list");
        return match list[0] {
            Value::Array(_) => list.iter().map(vector).collect(),
            _ => vec![vector(at), vector(at)],
        };
    }
    if let Some(point) = joint.get("point") {
        return vec![frames[names[0]].point(vector(point))];
    }
    let Some(points) = joint.get("points") else {
        return Vec::new();
    };
    let place = |name: &&str| frames[*name].point(vector(&points[*name]));
    names.iter().map(place).collect()
}

/// Returns the unit vectors along the first and the second axis, in the axes of the ground.
fn directions(joint: &Table, names: &[&str], frames: &BTreeMap<String, Frame>) -> Vec<[f64; 3]> {
    let is_global = joint.get("frame").is_some();
    let frame = &frames[if is_global { "ground" } else { names[0] }];
    let in_frame = |value: &Value| unit(frame.direction(vector(value)));
    if let Some(axes) = joint.get("axes") {
        let first = in_frame(&axes[names[0]]);
        let second = unit(frames[names[1]].direction(vector(&axes[names[1]])));
        return vec![first, second];
    }
    let has_two = ["universal", "perpendicular"].contains(&word(joint, "type"));
    let keys: &[&str] = if has_two {
        &["axis", "cross"]
    } else {
        &["axis", "normal"]
    };
    let found = keys.iter().filter_map(|key| joint.get(*key));
    found.map(in_frame).collect()
}

/// Returns points and directions as drawn.
fn drawn(kind: &Kind) -> (Vec<&Vector>, Vec<&Vector>) {
    match kind {
        Kind::Spherical { at } | Kind::Fixed { at } => (vec![at, at], vec![]),
        Kind::Revolute { at, axis } => (vec![at, at], vec![axis]),
        Kind::Universal { at, first, second } => (vec![at, at], vec![first, second]),
        Kind::Translational { from, at, axis }
        | Kind::Cylindrical { from, at, axis }
        | Kind::PointOnLine { from, at, axis } => (vec![from, at], vec![axis]),
        Kind::Planar { from, at, normal } | Kind::PointOnPlane { from, at, normal } => {
            (vec![from, at], vec![normal])
        }
        Kind::Parallel { axis } => (vec![], vec![axis]),
        Kind::Perpendicular { first, second } => (vec![], vec![first, second]),
        Kind::Orientation => (vec![], vec![]),
        Kind::Distance { from, at } => (vec![from, at], vec![]),
        Kind::KnifeEdge { at, normal } => (vec![at], vec![normal]),
        Kind::Wheel { centre, axis, .. } => (vec![centre], vec![axis]),
    }
}

fn is_near(found: [f64; 3], right: [f64; 3], error: f64) -> bool {
    found.iter().zip(right).all(|(a, b)| (a - b).abs() <= error)
}

/// Reads a text and compares it with its drawing.
fn compare(drawing: &Drawing, what: &str) {
    let text = text(drawing);
    let table: Table = text.parse().expect("TOML");
    assert_eq!(
        word(table["scene"].as_table().expect("a table"), "space"),
        "spatial"
    );
    let list = |key: &str| match table.get(key) {
        Some(list) => list.as_array().expect("tables").as_slice(),
        None => &[],
    };
    let mut frames = BTreeMap::from([("ground".to_owned(), Frame::ground())]);
    for body in list("body").iter().filter_map(Value::as_table) {
        frames.insert(word(body, "name").to_owned(), Frame::of(body));
    }
    assert_eq!(frames.len(), drawing.bodies.len() + 1, "{what}");
    let size = largest_coordinate(drawing);
    let joints = list("joint").iter().filter_map(Value::as_table);
    let joints: Vec<_> = joints.collect();
    assert_eq!(joints.len(), drawing.joints.len(), "{what}");
    for (read, joint) in joints.into_iter().zip(&drawing.joints) {
        assert_eq!(word(read, "name"), joint.name, "{what}");
        let names: Vec<&str> = match read.get("bodies") {
            Some(pair) => {
                let pair = pair.as_array().expect("two names");
                pair.iter().filter_map(Value::as_str).collect()
            }
            None => vec![word(read, "body"), "ground"],
        };
        let named = joint
            .bodies
            .map(|side| side.map_or("ground", |k| drawing.bodies[k].name.as_str()));
        assert_eq!(names, named, "{what}");
        let (places, axes) = drawn(&joint.kind);
        let found = points(read, &names, &frames);
        for (found, right) in found.iter().zip(&places) {
            let right = right.0.each_ref().map(Ratio::rounded);
            let error = ROUNDING * size;
            assert!(
                is_near(*found, right, error),
                "{what} {}: {found:?}",
                joint.name
            );
        }
        assert_eq!(found.is_empty(), places.is_empty(), "{what} {}", joint.name);
        let found = directions(read, &names, &frames);
        let right = axes.iter().chain(axes.last());
        for (found, right) in found.iter().zip(right) {
            let right = unit(right.0.each_ref().map(Ratio::rounded));
            assert!(
                is_near(*found, right, ROUNDING),
                "{what} {}: {found:?}",
                joint.name
            );
        }
        assert!(found.len() >= axes.len(), "{what} {}", joint.name);
    }
    for (read, drive) in list("drive").iter().zip(&drawing.drives) {
        let joint = read["joint"].as_str();
        assert_eq!(joint, Some(drawing.joints[drive.joint].name.as_str()));
    }
}

#[test]
fn the_text_says_where_everything_is() {
    for scene in scenes(2).take(12 * 4 * 6) {
        let what = format!("{} {}", scene.number, scene.family.name());
        compare(&scene.drawing, &what);
    }
    for (name, drawing) in catalogue::all() {
        compare(&drawing, name);
    }
}

#[test]
fn a_door_is_written_as_drawn() {
    let axis = Vector::unit(2);
    let hinge = catalogue::revolute(&super::super::vector::parts([1, 0, 2], 10), &axis);
    let drawing = catalogue::door(&[hinge]);
    assert_eq!(
        text(&drawing),
        r#"[scene]
name = "exact"
space = "spatial"

[[body]]
name = "b0"
mass = 1.0
inertia = [0.3, 0.4, 0.5]
position = [0.0, 0.0, 0.0]

[[joint]]
name = "j0"
type = "revolute"
bodies = ["ground", "b0"]
at = [0.1, 0.0, 0.2]
axis = [0.0, 0.0, 1.0]
"#
    );
}

#[test]
fn few_digits_come_with_their_tolerance() {
    let scene = super::super::scene(4, 2);
    let precision = Precision::of_digits(&scene.drawing, 3);
    let largest = largest_coordinate(&scene.drawing);
    assert_eq!(precision.tolerance, Some(2.0 * 1e-2 * largest));
    let text = text_within(&scene.drawing, &precision);
    assert!(text.contains("tolerance = "), "{text}");
    let bodies = text.split("[[body]]").skip(1);
    for number in bodies.flat_map(|part| part.split([' ', ',', '[', ']', '\n'])) {
        let Ok(x) = number.parse::<f64>() else {
            continue;
        };
        assert_eq!(precision.rounded(x), x, "{number}");
        let digits = number.trim_start_matches(['-', '0', '.']);
        let digits = digits.split('e').next().unwrap_or_default();
        let significant = digits
            .trim_end_matches(".0")
            .trim_end_matches('0')
            .replace('.', "");
        assert!(significant.len() <= 3, "{number}");
    }
}
