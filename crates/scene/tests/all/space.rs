//! Tests scenes in space: every type, all forms of orientations and directions, and errors that
//! occur only in space.

use std::collections::BTreeSet;

use joints::space3::Pose;
use model::{AnyDescription, Mechanism, Registry, SpatialBody, SpatialDescription};

use crate::diagnostics::check_in;
use crate::{assert_close, read};

/// The bodies are a at (1, 2, 3) with axes rotated by 90° about z, b at (3, 2, 3), and c at the
/// origin.
const BODIES: &str = r#"[scene]
name = "small"
space = "spatial"
gravity = [0.0, 0.0, -9.81]
silence = ["P0195"]

[[body]]
name = "a"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
position = [1.0, 2.0, 3.0]
orientation = { axis = [0, 0, 1], angle = 1.5707963267948966 }

[[body]]
name = "b"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
position = [3.0, 2.0, 3.0]

[[body]]
name = "c"
mass = 1.0
inertia = [1.0, 1.0, 1.0]

"#;

const AB: &str = "bodies = [\"a\", \"b\"]\n";

#[track_caller]
fn described(text: &str) -> SpatialDescription {
    let scene = read(text).unwrap_or_else(|problems| panic!("{text}\n{problems:#?}"));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    match scene.description {
        AnyDescription::Space3(d) => d,
        AnyDescription::Plane(_) => panic!("a planar description"),
    }
}

#[test]
fn every_type_is_read_and_built() {
    let place = "at = [1, 0, 0]";
    let wheel = "body = \"c\"\npoint = [0, 0, 0.3]\naxis = [0, 1, 0]\nradius = 0.3";
    let two = "at = [[1, 0, 0], [2, 0, 0]]";
    let joints = [
        ("spherical", format!("{AB}{place}")),
        ("revolute", format!("{AB}{place}\naxis = [0, 0, 1]")),
        (
            "universal",
            format!("{AB}{place}\naxis = [0, 0, 1]\ncross = [1, 0, 0]"),
        ),
        (
            "translational",
            format!("{AB}{place}\naxis = [0, 0, 1]\ncross = [1, 1, 0]"),
        ),
        ("cylindrical", format!("{AB}{place}\naxis = [0, 0, 1]")),
        ("planar", format!("{AB}{place}\nnormal = [0, 0, 1]")),
        ("fixed", format!("{AB}{place}")),
        (
            "point-on-line",
            format!("{AB}{place}\naxis = [0, 0, 1]\nframe = \"global\""),
        ),
        (
            "point-on-plane",
            format!("{AB}points = {{ a = [1, 0, 0], b = [1, 0, 0] }}\nnormal = [0, 0, 1]"),
        ),
        ("parallel", format!("{AB}axis = [0, 0, 1]")),
        (
            "perpendicular",
            format!("{AB}axis = [0, 0, 1]\ncross = [1, 0, 0]"),
        ),
        ("orientation", AB.to_owned()),
        ("distance", format!("{AB}{two}")),
        (
            "knife-edge",
            "body = \"c\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]".to_owned(),
        ),
        (
            "velocity",
            "body = \"c\"\npoint = [0, 0, 0]\ndirection = [1, 0, 0]\nrate = 0.5".to_owned(),
        ),
        ("wheel", wheel.to_owned()),
        (
            "wheel",
            format!("{wheel}\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}"),
        ),
        ("wheel", format!("{wheel}\ntube = 0.1")),
        (
            "ball",
            "body = \"c\"\npoint = [0, 0, 0.3]\nradius = 0.3".to_owned(),
        ),
        (
            "constant-velocity",
            format!("{AB}{place}\naxes = {{ a = [1, 0, 0], b = [1, 1, 0] }}"),
        ),
        (
            "screw",
            format!("{AB}{place}\naxis = [1, 0, 0]\npitch = 0.01"),
        ),
        (
            "mesh",
            format!("bearings = [\"A\", \"B\"]\nat = [2, 3, 0]\n{SHAFTS}"),
        ),
    ];
    let forces = [
        (
            "spring-damper",
            format!("{AB}{two}\nstiffness = 1.0\ndamping = 0.1"),
        ),
        (
            "point-force",
            "body = \"a\"\npoint = [0, 0, 0]\nforce = [1, 2, 3]".to_owned(),
        ),
        (
            "point-force",
            "body = \"a\"\npoint = [0, 0, 0]\nforce = [1, 2, 3]\nframe = \"body\"".to_owned(),
        ),
        (
            "bushing",
            format!("{AB}{place}\nstiffness = [1, 2, 3, 4, 5, 6]\ndamping = [0, 0, 0, 0, 0, 0]"),
        ),
        ("torque", "body = \"a\"\ntorque = [1, 2, 3]".to_owned()),
        ("torque", format!("{AB}torque = [1, 2, 3]")),
    ];
    let mut text = BODIES.to_owned();
    for (section, elements) in [("joint", &joints[..]), ("force", &forces[..])] {
        for (k, (name, keys)) in elements.iter().enumerate() {
            text +=
                &format!("[[{section}]]\nname = \"{section} {k}\"\ntype = \"{name}\"\n{keys}\n\n");
        }
    }
    let d = described(&text);
    let rows: Vec<usize> = d
        .joints
        .iter()
        .map(|j| j.element.spec().rows.len())
        .collect();
    assert_eq!(
        rows,
        [
            3, 5, 4, 5, 4, 3, 6, 2, 1, 2, 1, 3, 1, 1, 1, 3, 3, 3, 3, 4, 5, 1, 5, 4
        ]
    );
    assert_eq!(d.forces.len(), forces.len());
    assert!(Mechanism::build(&d).is_ok());
    let registry = Registry::standard();
    let of = registry.space();
    let all: BTreeSet<_> = of
        .constraint_specs()
        .chain(of.force_specs())
        .map(|spec| spec.scene_type)
        .collect();
    let given: BTreeSet<_> = joints
        .iter()
        .chain(&forces)
        .map(|(name, _)| *name)
        .collect();
    assert_eq!(given, all);
}

fn body(orientation: &str) -> SpatialBody {
    let d = described(&format!(
        "[scene]\nname = \"x\"\nspace = \"spatial\"\n[[body]]\nname = \"a\"\nmass = 1.0\n\
         inertia = [1, 1, 1]\norientation = {orientation}\n"
    ));
    d.bodies[0].clone()
}

/// A rotation by 180° about (0, 3, 4)/5 maps x to −x and y to (0, −0.28, 0.96).
#[test]
fn four_ways_of_an_orientation() {
    let expected = [[-1.0, 0.0, 0.0], [0.0, -0.28, 0.96], [0.0, 0.96, 0.28]];
    for way in [
        "{ quaternion = [0.0, 0.0, 0.6, 0.8] }",
        "{ quaternion = [0.0, 0.0, -0.6, -0.8] }",
        "{ axis = [0, 3, 4], angle = 3.141592653589793 }",
        // The first rotation is about x by ψ = atan2(0.96, 0.28), the second about z by π: y is
        // mapped to (0, −cos ψ, sin ψ).
        "{ rpy = [1.2870022175865687, 0.0, 3.141592653589793] }",
        "{ matrix = [[-1, 0, 0], [0, -0.28, 0.96], [0, 0.96, 0.28]] }",
    ] {
        let turned = Pose::new([0.0; 3], body(way).orientation);
        for (k, column) in expected.iter().enumerate() {
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            let found = turned.to_global(axis);
            let near = found.iter().zip(column).all(|(a, b)| (a - b).abs() < 1e-12);
            assert!(near, "{way}: axis {k} is {found:?}");
        }
    }
    // The rotations are about x, then y, then z. With right angles, the pitch maps x to −z, and the
    // yaw does not change this vector.
    let turned = Pose::new(
        [0.0; 3],
        body("{ rpy = [1.5707963267948966, 1.5707963267948966, 0.0] }").orientation,
    );
    assert_close(&turned.to_global([1.0, 0.0, 0.0]), &[0.0, 0.0, -1.0]);
    assert_close(&turned.to_global([0.0, 1.0, 0.0]), &[1.0, 0.0, 0.0]);
}

#[test]
fn an_orientation_with_few_digits_is_taken_with_a_warning() {
    let text = BODIES.replace(
        "{ axis = [0, 0, 1], angle = 1.5707963267948966 }",
        "{ matrix = [[0.0, -1.02, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]] }",
    );
    let scene = read(&text).expect("a scene");
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    let AnyDescription::Space3(d) = &scene.description else {
        panic!("a planar description");
    };
    let turned = Pose::new([0.0; 3], d.bodies[0].orientation);
    assert_close(&turned.to_global([1.0, 0.0, 0.0]), &[0.0, 1.0, 0.0]);
}

/// Returns the pose of a body after a rotation about a ground axis through (1, 0, 0).
fn turned(pose: Pose, axis: [f64; 3], angle: f64) -> Pose {
    let (sin, cos) = (0.5 * angle).sin_cos();
    let turn = Pose::new([0.0; 3], [cos, sin * axis[0], sin * axis[1], sin * axis[2]]);
    let arm = turn.to_global([pose.r[0] - 1.0, pose.r[1], pose.r[2]]);
    let column = |k: usize| turn.to_global([0, 1, 2].map(|row| pose.rot[row][k]));
    let columns = [0, 1, 2].map(column);
    Pose {
        r: [arm[0] + 1.0, arm[1], arm[2]],
        rot: [0, 1, 2].map(|row| columns.map(|column| column[row])),
    }
}

/// In every notation, a hinge rotates about the intended axis: y of the ground is x of a.
#[test]
fn directions_of_the_body_of_the_ground_and_of_both() {
    for axis in [
        "axis = [1, 0, 0]",
        "axis = [2, 0, 0]\ncross = [1, 1, 0]",
        "axis = [0, 1, 0]\nframe = \"global\"",
        "axes = { a = [1, 0, 0], b = [0, 1, 0] }",
    ] {
        let text = format!(
            "{BODIES}[[joint]]\nname = \"J\"\ntype = \"revolute\"\n{AB}at = [1, 0, 0]\n{axis}\n"
        );
        let d = described(&text);
        let [a, b] = [0, 1].map(|k| {
            let body = &d.bodies[k];
            Pose::new(body.position, body.orientation)
        });
        let mut element = d.joints[0].element.clone();
        element.initialise(&[a, b]);
        let phi = |second: Pose| {
            let mut out = [f64::NAN; 5];
            element.phi(&[a, second], &[], &mut out);
            out.iter().fold(0.0_f64, |m, x| m.max(x.abs()))
        };
        assert!(phi(b) < 1e-14, "{axis}: {}", phi(b));
        assert!(phi(turned(b, [0.0, 1.0, 0.0], 0.7)) < 1e-14, "{axis}");
        for other in [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]] {
            assert!(phi(turned(b, other, 0.7)) > 0.5, "{axis}");
        }
    }
}

/// On the ground, z of the marker points along −y and x along x; on body d, z points along its
/// x-axis and x along its −z-axis. In the pose of body d, the two markers coincide.
const MARKED: &str = r#"[[body]]
name = "d"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
centre = [0.0, 0.5, 0.0]
position = [1.0, 0.0, 0.0]
orientation = { matrix = [[0, 0, -1], [-1, 0, 0], [0, 1, 0]] }

[[marker]]
name = "bearing"
body = "ground"
point = [1.0, -2.0, 0.0]
orientation = { axis = [1, 0, 0], angle = 1.5707963267948966 }

[[marker]]
name = "journal"
body = "d"
point = [2.0, 0.0, 0.0]
orientation = { axis = [0, 1, 0], angle = 1.5707963267948966 }

[[joint]]
name = "J"
bodies = ["ground", "d"]
markers = ["bearing", "journal"]
"#;

/// The axis is z, and x is perpendicular to it. Every joint is satisfied if its markers coincide,
/// and it permits the motions of its type.
#[test]
fn a_joint_between_markers_has_their_places_and_axes() {
    let along = [0.0, 1.0, 0.0];
    let across = [1.0, 0.0, 0.0];
    // Whether a joint permits rotations about z and about x of the first marker.
    for (kind, allowed) in [
        ("revolute", [true, false]),
        ("cylindrical", [true, false]),
        ("translational", [false, false]),
        ("fixed", [false, false]),
        ("orientation", [false, false]),
        ("parallel", [true, false]),
        ("universal", [true, true]),
        ("constant-velocity", [false, true]),
        ("perpendicular", [true, true]),
        ("planar", [true, false]),
        ("point-on-line", [true, true]),
    ] {
        let d = described(&format!("{BODIES}{MARKED}type = \"{kind}\"\n"));
        let body = &d.bodies[3];
        let pose = Pose::new(body.position, body.orientation);
        let pose = Pose {
            r: pose.to_global(body.centre),
            ..pose
        };
        let mut element = d.joints[0].element.clone();
        element.initialise(&[Pose::GROUND, pose]);
        let phi = |second: Pose| {
            let mut out = vec![0.0; element.spec().rows.len()];
            element.phi(&[Pose::GROUND, second], &[], &mut out);
            out.iter().fold(0.0_f64, |m, x| m.max(x.abs()))
        };
        assert!(phi(pose) < 1e-15, "{kind}: {}", phi(pose));
        // The rotation is about the reference point of the joint, at (1, −2, 0).
        let moved = |by: f64, mut pose: Pose| {
            pose.r[1] += by;
            pose
        };
        for (axis, allowed) in [along, across].into_iter().zip(allowed) {
            let there = moved(-2.0, turned(moved(2.0, pose), axis, 0.7));
            assert_eq!(phi(there) < 1e-15, allowed, "{kind} about {axis:?}");
        }
    }
}

#[test]
fn faults_of_markers() {
    let scene = format!("{BODIES}{MARKED}type = \"revolute\"\n");
    const GIVEN: &str = "markers = [\"bearing\", \"journal\"]";
    check_in(
        &scene,
        &[
            (
                GIVEN,
                "markers = [\"bearing\", «\"jornal\"»]",
                "joint `J` refers to the unknown marker `jornal`",
                "no such marker",
            ),
            (
                GIVEN,
                "markers = [«\"journal\"», \"journal\"]",
                "joint `J`: marker `journal` belongs to `d`, and one of `ground` is needed here",
                "not a marker of this body",
            ),
            (
                GIVEN,
                "markers = «[\"bearing\"]»",
                "joint `J`: `markers` must be two markers [first, second], found a list of 1 value",
                "expected two markers [first, second]",
            ),
            (
                GIVEN,
                "markers = [\"bearing\", \"journal\"]\nat = «[1, 0, 0]»",
                "joint `J` takes `markers` or `at`, not both",
                "and here once more",
            ),
            (
                GIVEN,
                "markers = [\"bearing\", \"journal\"]\npoints = «{ ground = [1, 0, 0], d = [0, 0, 0] }»",
                "joint `J` takes `markers` or `points`, not both",
                "and here once more",
            ),
            (
                GIVEN,
                "markers = [\"bearing\", \"journal\"]\naxis = «[1, 0, 0]»",
                "joint `J` takes `markers` or `axis`, not both",
                "and here once more",
            ),
            (
                GIVEN,
                "markers = [\"bearing\", \"journal\"]\naxes = «{ ground = [1, 0, 0], d = [0, 0, 1] }»",
                "joint `J` takes `markers` or `axes`, not both",
                "and here once more",
            ),
            (
                GIVEN,
                "markers = [\"bearing\", \"journal\"]\nframe = «\"global\"»",
                "joint `J` takes `markers` or `frame`, not both",
                "and here once more",
            ),
            (
                GIVEN,
                "markers = [\"bearing\", \"journal\"]\ncross = «[1, 0, 0]»",
                "joint `J` takes `markers` or `cross`, not both",
                "and here once more",
            ),
        ],
    );
}

const SPACE: &str = r#"[scene]
name = "small"
space = "spatial"
gravity = [0.0, 0.0, -9.81]

[[body]]
name = "a"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
position = [0.0, 0.0, 0.5]
orientation = { quaternion = [1, 0, 0, 0] }

[[joint]]
name = "J"
type = "revolute"
bodies = ["ground", "a"]
at = [0.0, 0.0, 0.0]
axis = [0, 0, 1]

[[joint]]
name = "R"
type = "distance"
bodies = ["ground", "a"]
at = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]

[[joint]]
name = "W"
type = "wheel"
body = "a"
point = [0.0, 0.0, 0.0]
axis = [0, 1, 0]
radius = 0.5
"#;

const MOMENTS: &str = "inertia = [1.0, 1.0, 1.0]";
const TURNED: &str = "orientation = { quaternion = [1, 0, 0, 0] }";

#[test]
fn faults_in_space() {
    check_in(
        SPACE,
        &[
            (
                "axis = [0, 0, 1]",
                "axis = «[0, 0, 0]»",
                "joint `J`: `axis` has no direction: the vector is (0, 0, 0), of length zero",
                "has no direction",
            ),
            (
                TURNED,
                "orientation = { matrix = «[[1, 0, 0], [0, 1, 0], [0, 0, -1]]» }",
                "body `a`: `orientation`: `matrix` is a reflection: no rotation turns a right hand into a left one",
                "no orientation",
            ),
            (
                TURNED,
                "orientation = { matrix = «[[1, 0, 0], [0, 1, 0], [0, 0, 0]]» }",
                "body `a`: `orientation`: `matrix` is singular, so it is not an orientation",
                "no orientation",
            ),
            (
                TURNED,
                "orientation = { quaternion = «[0, 0, 0, 0]» }",
                "body `a`: `orientation`: `quaternion` is zero, so it is not an orientation",
                "no orientation",
            ),
            (
                TURNED,
                "orientation = «{ quaternion = [1, 0, 0, 0], rpy = [0, 0, 0] }»",
                "body `a`: `orientation` needs one of the keys `quaternion`, `axis`, `rpy`, `matrix`",
                "an orientation is written in one way",
            ),
            (
                TURNED,
                "orientation = { axis = «[1, 0, 0]» }",
                "body `a`: `orientation` has an `axis` without an `angle`",
                "turned by how much?",
            ),
            (
                MOMENTS,
                "inertia = «[1.0, 1.0, 3.0]»",
                "body `a`: no body has the principal moments [1.0, 1.0, 3.0]: the largest is above the sum of the others",
                "not the tensor of a body",
            ),
            (
                MOMENTS,
                "inertia = [1.0, 1.0, «-1.0»]",
                "body `a`: `inertia` has the moment -1",
                "may not be negative",
            ),
            (
                "axis = [0, 0, 1]",
                "axis = «[0, 0, 1]»\naxes = { ground = [0, 0, 1], a = [0, 0, 1] }",
                "joint `J` takes `axis` or `axes`, not both",
                "and here for the first",
            ),
            (
                "axis = [0, 0, 1]",
                "axes = «{ a = [0, 0, 1] }»",
                "joint `J`: `axes` needs the direction of `ground`",
                "`ground = [x, y, z]` is missing here",
            ),
            (
                "axis = [0, 0, 1]",
                "axis = [0, 0, 1]\nframe = «\"globl\"»",
                "joint `J`: `frame` must be \"body\" or \"global\", found `globl`",
                "no such choice",
            ),
        ],
    );
}

/// A type that exists only in the other space is reported with the name of that space.
#[test]
fn the_other_space_is_named() {
    check_in(
        SPACE,
        &[
            (
                TURNED,
                "«angle» = 0.3",
                "body `a` has no key `angle`",
                "`angle` belongs to `space = \"plane\"`",
            ),
            (
                "type = \"revolute\"",
                "type = «\"pin-in-slot\"»",
                "joint `J` has the unknown type `pin-in-slot`",
                "`pin-in-slot` belongs to `space = \"plane\"`",
            ),
            (
                "radius = 0.5",
                "radius = 0.5\ntube = «-0.1»",
                "joint `W`: `tube` is -0.1, need a number ≥ 0",
                "may not be negative",
            ),
            (
                "radius = 0.5",
                "radius = 0.5\ntube = «nan»",
                "joint `W`: `tube` is NaN, need a finite number up to 1e60",
                "not a usable number",
            ),
            (
                "radius = 0.5",
                "radius = «-0.5»",
                "joint `W`: `radius` is -0.5, need a number ≥ 0",
                "may not be negative",
            ),
            (
                "at = [0.0, 0.0, 0.0]",
                "at = «[0.0, 0.0]»",
                "joint `J`: `at` must be a global point [x, y, z], found a list of 2 values",
                "expected a global point [x, y, z]",
            ),
        ],
    );
    const PLANE: &str = "[scene]\nname = \"small\"\nspace = \"plane\"\n\n[[body]]\nname = \"a\"\n\
        mass = 1.0\ninertia = 1.0\nangle = 0.0\n\n[[marker]]\nname = \"m\"\nbody = \"a\"\n\
        point = [0.0, 0.0]\n\n[[joint]]\nname = \"J\"\ntype = \"revolute\"\n\
        bodies = [\"ground\", \"a\"]\nat = [0.0, 0.0]\n";
    check_in(
        PLANE,
        &[
            (
                "angle = 0.0",
                "«orientation» = { rpy = [0, 0, 0] }",
                "body `a` has no key `orientation`",
                "`orientation` belongs to `space = \"spatial\"`",
            ),
            (
                "type = \"revolute\"",
                "type = «\"spherical\"»",
                "joint `J` has the unknown type `spherical`",
                "`spherical` belongs to `space = \"spatial\"`",
            ),
            (
                "at = [0.0, 0.0]",
                "at = «[0.0, 0.0, 0.0]»",
                "joint `J`: `at` must be a global point [x, y], found a list of 3 values",
                "expected a global point [x, y]",
            ),
            (
                "at = [0.0, 0.0]",
                "at = [0.0, 0.0]\n«cross» = [1, 0, 0]",
                "joint `J` has no key `cross`",
                "`cross` belongs to `space = \"spatial\"`",
            ),
            (
                "at = [0.0, 0.0]",
                "at = [0.0, 0.0]\n«markers» = [\"m\", \"m\"]",
                "joint `J` has no key `markers`",
                "`markers` belongs to `space = \"spatial\"`",
            ),
        ],
    );
    let problems = read(&PLANE.replace("[0.0, 0.0]\n\n", "[0.0, 0.0, 0.0]\n\n")).expect_err("");
    let help = problems[0].help.as_deref();
    assert_eq!(
        help,
        Some("vectors of 3 components belong to `space = \"spatial\"`")
    );
}

/// Two shafts on the ground whose axes meet at a right angle at the origin.
const SHAFTS: &str = r#"
[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "a"]
at = [1, 0, 0]
axis = [1, 0, 0]

[[joint]]
name = "B"
type = "cylindrical"
bodies = ["b", "ground"]
at = [0, 1, 0]
axis = [0, 1, 0]
"#;

/// Returns the mesh between the two shafts.
fn teeth(keys: &str) -> model::Joint<joints::Space3> {
    let text = format!(
        "{BODIES}[[joint]]\nname = \"M\"\ntype = \"mesh\"\nbearings = [\"A\", \"B\"]\n{keys}\n{SHAFTS}"
    );
    // The mesh has the position of its table in the list of joints, before its bearings.
    let first = described(&text).joints.into_iter().next();
    first.expect("a joint")
}

/// Returns the stored value of a joint with this name.
fn value(joint: &model::Joint<joints::Space3>, name: &str) -> Vec<f64> {
    let spec = joint.element.spec();
    let datum = spec.data.iter().find(|d| d.name == name).expect(name);
    let mut all = vec![0.0; spec.n_data()];
    joint.element.data(&mut all);
    all[datum.numbers()].to_vec()
}

/// Points and axes are those of the bearings, in the frames of the wheels and of the carrier. The
/// line of action is the normal of the plane of both axes, rotated about the line from the apex to
/// the pitch point.
#[test]
fn teeth_are_placed_by_their_bearings() {
    let joint = teeth("at = [2, 3, 0]");
    let bodies = [1, 0, 2].map(|k| joint.bodies[k]);
    assert_eq!(
        bodies,
        [
            model::BodyRef::Body(1),
            model::BodyRef::Body(0),
            model::BodyRef::Ground
        ]
    );
    // Body a is at (1, 2, 3), rotated by 90° about z; b is at (3, 2, 3).
    assert_close(&value(&joint, "s_i"), &[-2.0, 0.0, -3.0]);
    assert_close(&value(&joint, "s_j"), &[-3.0, -1.0, -3.0]);
    assert_close(&value(&joint, "p_i"), &[1.0, 0.0, 0.0]);
    assert_close(&value(&joint, "p_j"), &[0.0, 1.0, 0.0]);
    assert_close(&value(&joint, "pitch"), &[2.0, 3.0, 0.0]);
    assert_close(&value(&joint, "line"), &[0.0, 0.0, 1.0]);
    // The normal is N × g with g = (0.8, 0.6, 0).
    let joint = teeth("at = [4, 3, 0]\npressure_angle = 0.3");
    let (sin, cos) = 0.3_f64.sin_cos();
    assert_close(&value(&joint, "line"), &[-0.6 * sin, 0.8 * sin, cos]);
    let joint = teeth("point = [4, 3, 0]\nline = [0, 3, 4]\nframe = \"global\"");
    assert_close(&value(&joint, "line"), &[0.0, 0.6, 0.8]);
}

#[test]
fn bearings_of_teeth() {
    let scene = format!(
        "{BODIES}{SHAFTS}[[joint]]\nname = \"C\"\ntype = \"revolute\"\nbodies = [\"a\", \"c\"]\nat = [0, 1, 0]\naxis = [0, 0, 1]\n\
         [[joint]]\nname = \"D\"\ntype = \"spherical\"\nbodies = [\"ground\", \"c\"]\nat = [0, 0, 2]\n\
         [[joint]]\nname = \"E\"\ntype = \"revolute\"\nbodies = [\"ground\", \"c\"]\nat = [0, 2, 2]\naxis = [0, 0, 1]\n\
         [[joint]]\nname = \"M\"\ntype = \"mesh\"\nbearings = [\"A\", \"B\"]\nat = [2, 3, 0]\n"
    );
    let skew =
        "joint `M` needs the key `line`: the axes of the wheels neither meet nor are parallel";
    let follows = "the line of action does not follow from these";
    check_in(
        &scene,
        &[
            (
                "[\"A\", \"B\"]",
                "[\"A\", «\"nothing\"»]",
                "joint `M` refers to the unknown joint `nothing`",
                "no such joint",
            ),
            (
                "[\"A\", \"B\"]",
                "«[\"A\", \"D\"]»",
                "joint `M`: `D` bears no wheel: a joint with one axis and one angle is needed",
                "no bearing",
            ),
            (
                "[\"A\", \"B\"]",
                "«[\"B\", \"C\"]»",
                "joint `M`: `B` and `C` connect no common body, and there is no body on which both wheels turn; the axis of `E` is 1 m away from the axis of `C`",
                "both wheels turn on one carrier",
            ),
            (
                "[\"A\", \"B\"]",
                "«[\"A\", \"A\"]»",
                "joint `M`: `A` and `A` both connect `ground` and `a`: there is one wheel only",
                "two wheels and a carrier are three bodies",
            ),
            ("[\"A\", \"B\"]", "«[\"A\", \"E\"]»", skew, follows),
        ],
    );
    let plane =
        "joint `M` needs the key `line`: the pitch point does not lie in the plane of both axes";
    let meets = "joint `M` needs the key `line`: the axes of the wheels meet in the pitch point";
    let misses =
        "joint `M`: the line of action meets the axis of the first wheel, or is parallel to it";
    let place = scene.replace(
        "bearings = [\"A\", \"B\"]\nat = [2, 3, 0]",
        "at = [2, 3, 0]\nbearings = [\"A\", \"B\"]",
    );
    check_in(
        &place,
        &[
            (
                "at = [2, 3, 0]\nbearings = [\"A\", \"B\"]",
                "at = [2, 3, 1e-3]\nbearings = «[\"A\", \"B\"]»",
                plane,
                follows,
            ),
            (
                "at = [2, 3, 0]\nbearings = [\"A\", \"B\"]",
                "at = [0, 0, 0]\nbearings = «[\"A\", \"B\"]»",
                meets,
                follows,
            ),
            (
                "at = [2, 3, 0]\nbearings = [\"A\", \"B\"]",
                "at = [2, 3, 0]\nline = «[2, 0, 0]»\nbearings = [\"A\", \"B\"]",
                misses,
                "turns nothing",
            ),
            (
                "at = [2, 3, 0]\nbearings = [\"A\", \"B\"]",
                "at = [2, 3, 0]\nline = «[0, 0, 0]»\nbearings = [\"A\", \"B\"]",
                "joint `M`: `line` has no direction: the vector is (0, 0, 0), of length zero",
                "has no direction",
            ),
            (
                "at = [2, 3, 0]\nbearings = [\"A\", \"B\"]",
                "at = [2, 3, 0]\nline = [0, 0, 1]\npressure_angle = «0.3»\nbearings = [\"A\", \"B\"]",
                "joint `M` takes `line` or `pressure_angle`, not both",
                "and here by an angle",
            ),
            (
                "at = [2, 3, 0]\nbearings = [\"A\", \"B\"]",
                "at = [2, 3, 0]\npoint = «[2, 3, 0]»\nbearings = [\"A\", \"B\"]",
                "joint `M` takes `at` or `point`, not both",
                "and here in the frame of the body",
            ),
            (
                "at = [2, 3, 0]\nbearings = [\"A\", \"B\"]",
                "«bodies» = [\"a\", \"b\"]\nat = [2, 3, 0]\nbearings = [\"A\", \"B\"]",
                "joint `M` has no key `bodies`",
                "unknown key",
            ),
        ],
    );
    // A few digits are sufficient, because the limit is a fraction of the distance from the apex.
    let digits = scene.replace("at = [2, 3, 0]\n", "at = [2, 3, 1e-6]\n");
    assert!(read(&digits).is_ok());
    // An inactive joint cannot be a bearing.
    let off = scene.replacen("name = \"A\"\n", "name = \"A\"\nactive = false\n", 1);
    let problems = read(&off).expect_err("a bearing is off");
    let message = problems[0].to_string();
    assert!(
        message.contains("joint `A`, which is not active"),
        "{message}"
    );
}

/// A sun and an arm in the housing, and a planet on the arm. The axes of the sun and of the arm are
/// opposite, and the frames of the bodies are not parallel.
const PLANETARY: &str = r#"
scene = { name = "planetary", space = "spatial" }
body = [
  { name = "sun", mass = 1.0, inertia = [1, 1, 1], position = [0, 0, 0.2] },
  { name = "arm", mass = 1.0, inertia = [1, 1, 1], position = [0.1, 0, 0], orientation = { axis = [0, 0, 1], angle = 1.5707963267948966 } },
  { name = "planet", mass = 1.0, inertia = [1, 1, 1], position = [0.3, 0, 0] },
]
[[joint]]
name = "sun bearing"
type = "revolute"
bodies = ["ground", "sun"]
at = [0, 0, 0.2]
axis = [0, 0, 1]
[[joint]]
name = "arm bearing"
type = "revolute"
bodies = ["arm", "ground"]
at = [0, 0, -0.2]
axis = [0, 0, -1]
[[joint]]
name = "planet bearing"
type = "revolute"
bodies = ["arm", "planet"]
at = [0.3, 0, 0]
axis = [0, 0, 1]
[[joint]]
name = "M"
type = "mesh"
bearings = ["sun bearing", "planet bearing"]
carrier = "arm"
at = [0.2, 0, 0]
"#;

/// The wheels and the carrier are found if `carrier` is given, and if it is not. The axis of the
/// sun on the arm is that of the bearing of the arm, in the direction of the axis of the sun.
#[test]
fn wheels_of_a_housing() {
    for text in [
        PLANETARY.to_owned(),
        PLANETARY.replace("carrier = \"arm\"\n", ""),
    ] {
        let joint = described(&text).joints.pop().expect("a joint");
        assert_eq!(joint.bodies, [0, 2, 1].map(model::BodyRef::Body));
        assert_close(&value(&joint, "s_i"), &[0.0, 0.0, 0.0]);
        assert_close(&value(&joint, "p_i"), &[0.0, 0.1, -0.2]);
        assert_close(&value(&joint, "p_j"), &[0.0, -0.2, 0.0]);
        assert_close(&value(&joint, "pitch"), &[0.0, -0.1, 0.0]);
        assert_close(&value(&joint, "line"), &[1.0, 0.0, 0.0]);
    }
    // The ring is the housing, or a further body in it.
    let ring = PLANETARY.replace(
        "[\"sun bearing\", \"planet bearing\"]",
        "[\"planet bearing\", \"arm bearing\"]",
    );
    let joint = described(&ring).joints.pop().expect("a joint");
    let bodies = [
        model::BodyRef::Body(2),
        model::BodyRef::Ground,
        model::BodyRef::Body(1),
    ];
    assert_eq!(joint.bodies, bodies);
    // The sun has a second bearing in the housing.
    let second = "[[joint]]\nname = \"second\"\ntype = \"cylindrical\"\nbodies = [\"sun\", \"ground\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";
    let joints = described(&format!("{PLANETARY}{second}")).joints;
    let joint = joints.iter().find(|joint| joint.name == "M");
    assert_eq!(
        joint.expect("the mesh").bodies,
        [0, 2, 1].map(model::BodyRef::Body)
    );
}

#[test]
fn carriers_of_wheels() {
    const GIVEN: &str = "bearings = [\"sun bearing\", \"planet bearing\"]\ncarrier = \"arm\"";
    macro_rules! given {
        ($carrier:literal) => {
            concat!(
                "bearings = «[\"sun bearing\", \"planet bearing\"]»\n",
                $carrier
            )
        };
    }
    macro_rules! on {
        ($rest:literal) => {
            concat!(
                "joint `M`: no joints about the axis of `sun bearing` connect `ground` and `sun` with the carrier ",
                $rest
            )
        };
    }
    let free = "body = [\n  { name = \"free\", mass = 1.0, inertia = [1, 1, 1], position = [0.3, 0, 0] },\n";
    let planetary = PLANETARY.replace("body = [\n", free);
    let one = "both wheels turn on one carrier";
    check_in(
        &planetary,
        &[
            (
                "carrier = \"arm\"",
                "carrier = «\"amr\"»",
                "joint `M` refers to the unknown body `amr`",
                "no such body; `arm` is defined on line 6",
            ),
            (
                "carrier = \"arm\"",
                "carrier = «[\"arm\"]»",
                "joint `M`: `carrier` must be the name of a body, found a list of 1 value",
                "expected the name of a body",
            ),
            (GIVEN, given!("carrier = \"free\""), on!("`free`"), one),
            (
                GIVEN,
                given!("carrier = \"planet\""),
                on!(
                    "`planet`; the axis of `planet bearing` is 0.3 m away from the axis of `sun bearing`"
                ),
                one,
            ),
            (
                GIVEN,
                given!("carrier = \"sun\""),
                "joint `M`: no joints about the axis of `planet bearing` connect `arm` and `planet` with the carrier `sun`",
                one,
            ),
        ],
    );
    let refused = |scene: &str, message: &str| {
        let problems = read(scene).expect_err(message);
        let [problem] = &problems[..] else {
            panic!("{problems:#?}");
        };
        assert_eq!(problem.message, message);
    };
    // The bearing of the arm has another axis, or the arm has no bearing.
    let turned = |from: &str, to: &str| planetary.replace(from, to);
    let away = "the axis of `arm bearing` is 1 mm away from the axis of `sun bearing`";
    let inclined = "the axis of `arm bearing` is inclined by 1 mrad to the axis of `sun bearing`";
    let scenes = [
        (
            turned("at = [0, 0, -0.2]", "at = [0, 1e-3, -0.2]"),
            format!("; {away}"),
        ),
        (
            turned("axis = [0, 0, -1]", "axis = [1e-3, 0, -1]"),
            format!("; {inclined}"),
        ),
        (
            turned(
                "name = \"arm bearing\"\n",
                "name = \"arm bearing\"\nactive = false\n",
            ),
            String::new(),
        ),
        (
            turned(
                "type = \"revolute\"\nbodies = [\"arm\", \"ground\"]",
                "type = \"spherical\"\nbodies = [\"arm\", \"ground\"]",
            )
            .replace("axis = [0, 0, -1]\n", ""),
            String::new(),
        ),
    ];
    for (scene, miss) in scenes {
        let alone = "joint `M`: `sun bearing` and `planet bearing` connect no common body, and there is no body on which both wheels turn";
        let without = scene.replace("carrier = \"arm\"\n", "");
        for (scene, message) in [
            (&scene, format!("{}{miss}", on!("`arm`"))),
            (&without, format!("{alone}{miss}")),
        ] {
            refused(scene, &message);
        }
    }
    // A few digits are sufficient.
    assert!(read(&turned("at = [0, 0, -0.2]", "at = [0, 1e-7, -0.2]")).is_ok());
    // The arm bears the sun, too: both bodies of its bearing turn on the arm.
    let helper = "[[joint]]\nname = \"helper\"\ntype = \"revolute\"\nbodies = [\"arm\", \"sun\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";
    refused(
        &format!("{planetary}{helper}"),
        "joint `M`: `sun bearing` connects `ground` and `sun`, which both turn on `arm`: name the joint that connects the wheel with `arm`",
    );
    // A body on the axis of the sun that also bears the planet.
    let other = "[[joint]]\nname = \"free bearing\"\ntype = \"revolute\"\nbodies = [\"ground\", \"free\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
         [[joint]]\nname = \"free pin\"\ntype = \"revolute\"\nbodies = [\"free\", \"planet\"]\nat = [0.3, 0, 0]\naxis = [0, 0, 1]\n";
    let both = format!("{planetary}{other}");
    assert!(read(&both).is_ok());
    check_in(
        &both,
        &[(
            GIVEN,
            given!(""),
            "joint `M`: both wheels turn on `arm` and `free`: write which one is the `carrier`",
            "the carrier is not determined",
        )],
    );
}
