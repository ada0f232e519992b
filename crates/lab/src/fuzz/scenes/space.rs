//! The tables of a random scene in space: bodies with orientations and tensors, joints with axes.

use super::Values;
use super::draft::Draft;
use super::functions::number_or_function;
use super::parts::{active, begin, own_place, place, stiff};

/// Frames in which directions are given. Axes of the ground and of bodies make parallel directions
/// frequent.
const FRAMES: [&str; 2] = ["\"global\"", "\"body\""];

/// Returns an orientation in one of its four forms, mostly a quarter turn or no rotation.
pub(super) fn orientation(values: &mut Values<'_>) -> String {
    match values.numbers.below(40) {
        0 => {
            let rows = [values.velocity(), values.velocity(), values.velocity()];
            format!("{{ matrix = [{}] }}", rows.join(", "))
        }
        1..5 => {
            let parts: Vec<String> = (0..4).map(|_| values.number()).collect();
            format!("{{ quaternion = [{}] }}", parts.join(", "))
        }
        5..10 => "{ quaternion = [0.8, 0.6, 0.0, 0.0] }".to_owned(),
        10..15 => {
            let angles = [values.angle(), values.angle(), values.angle()];
            format!("{{ rpy = [{}] }}", angles.join(", "))
        }
        15..20 => "{ matrix = [[0, -1, 0], [1, 0, 0], [0, 0, 1]] }".to_owned(),
        20..25 => "{ axis = [1, 0, 0], angle = 1.5707963267948966 }".to_owned(),
        _ => {
            let (axis, angle) = (values.direction(), values.angle());
            format!("{{ axis = {axis}, angle = {angle} }}")
        }
    }
}

/// Returns a tensor of inertia, mostly as principal moments. Some tensors are impossible for a real
/// body.
fn inertia(values: &mut Values<'_>) -> String {
    match values.numbers.below(16) {
        0 => values.list(Values::positive),
        1 => "[1.0, 1.0, 2.0]".to_owned(),
        2 => "[[2.0, 0.5, 0.0], [0.5, 2.0, 0.25], [0.0, 0.25, 3.0]]".to_owned(),
        3 => {
            let [xy, xz, yz] = [0.1, 0.1, 0.1].map(|size| size * values.numbers.unit());
            format!("[[1.0, {xy:?}, {xz:?}], [{xy:?}, 1.25, {yz:?}], [{xz:?}, {yz:?}, 1.5]]")
        }
        _ => {
            let moments = [0, 1, 2].map(|_| 0.25 * f64::from(values.numbers.between(3, 5)));
            format!("{moments:?}")
        }
    }
}

/// Adds the table `[[body]]`.
pub(super) fn body(draft: &mut Draft, values: &mut Values<'_>, k: usize) {
    let name = values.name("b", k);
    draft.line(&format!(
        "[[body]]\nname = {name}\nmass = {}\ninertia = {}",
        values.positive(),
        inertia(values)
    ));
    draft.line(&format!("position = {}", values.point()));
    if values.numbers.once_in(2) {
        draft.line(&format!("orientation = {}", orientation(values)));
    }
    let is_elsewhere = values.numbers.once_in(6);
    if is_elsewhere {
        draft.line(&format!("centre = {}", values.point()));
    }
    let is_moving = values.numbers.once_in(5);
    if is_moving {
        draft.line(&format!("velocity = {}", values.velocity()));
    }
    // If the origin of the frame is not the mass centre, a velocity also needs an angular velocity.
    if is_elsewhere && is_moving || values.numbers.once_in(5) {
        draft.line(&format!("angular_velocity = {}", values.velocity()));
    }
    draft.bodies.push(name);
}

/// Adds a holonomic joint of two bodies.
pub(super) fn joint(draft: &mut Draft, values: &mut Values<'_>, pair: [String; 2]) {
    let kinds = [
        "revolute",
        "revolute",
        "revolute",
        "revolute",
        "spherical",
        "spherical",
        "universal",
        "constant-velocity",
        "translational",
        "cylindrical",
        "cylindrical",
        "screw",
        "planar",
        "fixed",
        "distance",
        "point-on-line",
        "point-on-plane",
        "parallel",
        "perpendicular",
        "orientation",
        "mesh",
    ];
    let kind = kinds[values.numbers.below(kinds.len())];
    if kind == "mesh" {
        return mesh(draft, values);
    }
    begin(draft, values, kind);
    draft.line(&format!("bodies = [{}, {}]", pair[0], pair[1]));
    if kind == "screw" {
        draft.line(&format!("pitch = {}", values.number()));
    }
    let has_no_place = matches!(kind, "parallel" | "perpendicular" | "orientation");
    let has_an_axis = !matches!(kind, "fixed" | "orientation" | "spherical" | "distance");
    let markers = draft.markers.len();
    if has_an_axis && !has_no_place && markers > 1 && values.numbers.once_in(6) {
        let [a, b] = [0, 1].map(|_| values.numbers.below(markers));
        let [a, b] = [a, b].map(|k| draft.markers[k].clone());
        return draft.line(&format!("markers = [{a}, {b}]"));
    }
    if kind == "distance" {
        draft.line(&format!("at = [{}, {}]", values.point(), values.point()));
    } else if !has_no_place {
        place(draft, values, &pair);
    }
    if has_an_axis {
        axes(draft, values, kind, &pair);
    }
}

/// Adds a gear mesh of wheels that rotate about the axes of two joints, if there are two joints.
fn mesh(draft: &mut Draft, values: &mut Values<'_>) {
    let turns = |kind: &str| matches!(kind, "revolute" | "cylindrical" | "screw");
    let is_wild = values.numbers.once_in(8);
    let known = draft
        .joints
        .iter()
        .filter(|joint| is_wild || turns(joint.1));
    let known: Vec<String> = known.map(|joint| joint.0.clone()).collect();
    if known.len() < 2 {
        return;
    }
    begin(draft, values, "mesh");
    let first = values.numbers.below(known.len());
    let second = (first + 1 + values.numbers.below(known.len() - 1)) % known.len();
    draft.line(&format!("bearings = [{}, {}]", known[first], known[second]));
    if values.numbers.once_in(4) {
        let carrier = draft.body(values.numbers, 3);
        draft.line(&format!("carrier = {carrier}"));
    }
    own_place(draft, values);
    match values.numbers.below(4) {
        0 => draft.line(&format!("line = {}", values.direction())),
        1 => {}
        _ => draft.line(&format!("pressure_angle = {}", values.angle())),
    }
}

/// Adds `axis` or `normal`, or the axes of both bodies, with the keys that belong to these axes.
fn axes(draft: &mut Draft, values: &mut Values<'_>, kind: &str, pair: &[String; 2]) {
    let has_two = matches!(kind, "universal" | "perpendicular");
    if !has_two && values.numbers.once_in(8) {
        let (first, second) = (values.direction(), values.direction());
        draft.line(&format!(
            "axes = {{ {} = {first}, {} = {second} }}",
            pair[0], pair[1]
        ));
    } else {
        let key = match kind {
            "planar" | "point-on-plane" => "normal",
            _ => "axis",
        };
        draft.line(&format!("{key} = {}", values.direction()));
    }
    if has_two || values.numbers.once_in(8) {
        draft.line(&format!("cross = {}", values.direction()));
    }
    // Directions in the axes of the ground are parallel for any orientation of the bodies.
    if values.numbers.once_in(2) {
        let frame = if values.numbers.once_in(12) {
            values.one(&FRAMES)
        } else {
            FRAMES[0]
        };
        draft.line(&format!("frame = {frame}"));
    }
}

/// Adds a joint of one body with the ground: an edge, a given velocity, a wheel, or a ball.
pub(super) fn nonholonomic(draft: &mut Draft, values: &mut Values<'_>) {
    let kinds = ["knife-edge", "velocity", "wheel", "ball"];
    let kind = kinds[values.numbers.below(kinds.len())];
    begin(draft, values, kind);
    let body = draft.body(values.numbers, 100);
    draft.line(&format!("body = {body}"));
    match kind {
        "wheel" | "ball" => rolling(draft, values, kind),
        "velocity" => {
            own_place(draft, values);
            let (along, rate) = (values.direction(), number_or_function(values));
            draft.line(&format!("direction = {along}\nrate = {rate}"));
        }
        _ => {
            own_place(draft, values);
            draft.line(&format!("normal = {}", values.direction()));
        }
    }
}

/// Adds the keys of a wheel or of a ball. The distance of the plane from the centre is often one
/// radius.
fn rolling(draft: &mut Draft, values: &mut Values<'_>, kind: &str) {
    draft.line(&format!("point = {}", values.point()));
    if kind == "wheel" {
        draft.line(&format!("axis = {}", values.direction()));
    }
    draft.line(&format!("radius = {}", values.positive()));
    if values.numbers.once_in(2) {
        let (point, normal) = (values.point(), values.direction());
        draft.line(&format!("plane = {{ point = {point}, normal = {normal} }}"));
    }
}

/// Returns the joint coordinate of a joint that a drive can move, if there is such a joint.
pub(super) fn measure_of(values: &mut Values<'_>, kind: &str) -> Option<&'static str> {
    match kind {
        "revolute" => Some("angle"),
        "translational" => Some("displacement"),
        "cylindrical" | "screw" => Some(values.one(&["angle", "displacement"])),
        "distance" => Some("length"),
        _ => values.numbers.once_in(20).then_some("angle"),
    }
}

/// Adds the table `[[force]]`.
pub(super) fn force(draft: &mut Draft, values: &mut Values<'_>) {
    let kind = values.one(&["spring-damper", "point-force", "torque"]);
    let k = draft.text.len();
    let name = values.name("f", k);
    draft.line(&format!("[[force]]\nname = {name}\ntype = \"{kind}\""));
    active(draft, values);
    let pair = [
        draft.body(values.numbers, 3),
        draft.body(values.numbers, 10),
    ];
    let is_between = kind == "spring-damper" || kind == "torque" && values.numbers.once_in(3);
    if is_between {
        draft.line(&format!("bodies = [{}, {}]", pair[0], pair[1]));
    } else {
        draft.line(&format!("body = {}", pair[1]));
    }
    match kind {
        "spring-damper" => {
            draft.line(&format!("at = [{}, {}]", values.point(), values.point()));
            draft.line(&format!("stiffness = {}", stiff(values)));
            draft.line(&format!("damping = {}", stiff(values)));
            if values.numbers.once_in(2) {
                draft.line(&format!("free_length = {}", values.positive()));
            }
        }
        _ => {
            let key = if kind == "torque" { "torque" } else { "force" };
            if kind == "point-force" {
                own_place(draft, values);
            }
            let vector = values.list(number_or_function);
            draft.line(&format!("{key} = {vector}"));
            if values.numbers.once_in(3) {
                draft.line(&format!("frame = \"{}\"", values.one(&["body", "global"])));
            }
        }
    }
}
