//! Tests frames away from the centre of mass, markers and joint coordinates, with their values and
//! their errors.

use model::{AnyDescription, BodyRef, MeasureKind, ToleranceScope};
use pfaff_scene::OutputUnits;

use crate::diagnostics::check_in;
use crate::{assert_close, read};

/// A crank whose frame is at its shaft, a slider, and markers.
const SCENE: &str = r#"[scene]
name = "places"
space = "plane"

[[body]]
name = "crank"
mass = 1.0
inertia = 0.1
centre = [0.5, 0.0]
position = [1.0, 2.0]
angle = 1.5707963267948966

[[body]]
name = "slider"
mass = 1.0
inertia = 0.1

[[marker]]
name = "shaft"
body = "ground"
point = [1.0, 2.0]

[[marker]]
name = "tip"
body = "crank"
point = [1.0, 0.25]
angle = 0.5
tolerance = 1e-5

[[marker]]
name = "nose"
body = "slider"
point = [0.0, 1.0]

[[measure]]
name = "gap"
type = "distance"
markers = ["tip", "nose"]

[[measure]]
name = "turn"
type = "angle"
markers = ["tip"]

[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "crank"]
at = "shaft"

[[joint]]
name = "B"
type = "revolute"
bodies = ["crank", "slider"]
points = { crank = "tip", slider = [0.3, 0.0] }

[[joint]]
name = "W"
type = "knife-edge"
body = "slider"
point = "nose"
normal = [0.0, 1.0]

[[joint]]
name = "C"
type = "distance"
bodies = ["slider", "crank"]
at = ["nose", [1.0, 3.0]]

[[force]]
name = "S"
type = "spring-damper"
bodies = ["ground", "crank"]
points = { ground = [9.0, 9.0], crank = "tip" }
stiffness = 1.0
damping = 0.0
"#;

#[test]
fn points_are_relative_to_the_centre_of_mass() {
    let d = read(SCENE)
        .unwrap_or_else(|problems| panic!("{problems:#?}"))
        .description
        .plane()
        .expect("a planar scene")
        .clone();
    let crank = &d.bodies[0];
    assert_eq!((crank.position, crank.centre), ([1.0, 2.0], [0.5, 0.0]));
    let pose = crank.pose();
    assert_close(&[pose.x, pose.y], &[1.0, 2.5]);
    let points = |k: usize| d.joints[k].element.points().concat();
    // The shaft is 0.5 m behind the centre of mass.
    assert_close(&points(0), &[1.0, 2.0, -0.5, 0.0]);
    assert_eq!(points(1), [0.5, 0.25, 0.3, 0.0]);
    assert_eq!(points(2), [0.0, 1.0]);
    // For a marker, the point of each body is that of the marker; a point in ground coordinates is
    // converted to the body.
    assert_close(&points(3), &[0.0, 1.0, 0.5, 0.0]);
    assert_eq!(d.forces[0].element.points(), [[9.0, 9.0], [0.5, 0.25]]);
}

#[test]
fn a_marker_of_another_body_is_a_place() {
    // The position of the tip in the frame of the slider is (1, 2) + R·(1, 0.25).
    let text = SCENE.replace(
        "points = { crank = \"tip\", slider = [0.3, 0.0] }",
        "at = \"tip\"",
    );
    let d = read(&text)
        .expect("a scene")
        .description
        .plane()
        .expect("a planar scene")
        .clone();
    assert_close(
        &d.joints[1].element.points().concat(),
        &[0.5, 0.25, 0.75, 3.0],
    );
}

#[test]
fn markers_and_measures_are_read() {
    let scene = read(SCENE).expect("a scene");
    let observed = &scene.description.plane().expect("a planar scene").observed;
    let tip = &observed.markers[1];
    assert_eq!((tip.name.as_str(), tip.body), ("tip", BodyRef::Body(0)));
    assert_eq!(
        (tip.point, tip.angle, tip.tolerance),
        ([1.0, 0.25, 0.0], Some(0.5), Some(1e-5))
    );
    assert_eq!(observed.markers[0].body, BodyRef::Ground);
    let measures: Vec<_> = observed
        .measures
        .iter()
        .map(|m| (m.kind, m.between))
        .collect();
    assert_eq!(
        measures,
        [
            (MeasureKind::Distance, [Some(1), Some(2)]),
            (MeasureKind::ANGLE, [None, Some(1)])
        ]
    );
}

/// A wheel on a hub in space, with the angles of its axis y.
const HUB: &str = r#"[scene]
name = "hub"
space = "spatial"

[[body]]
name = "hub"
mass = 1.0
inertia = [0.1, 0.1, 0.1]

[[marker]]
name = "wheel"
body = "hub"
point = [0.0, 0.0, 0.0]

[[measure]]
name = "toe"
type = "angle"
markers = ["wheel"]
axes = ["y", "y"]
about = "z"

[[measure]]
name = "camber"
type = "inclination"
markers = ["wheel"]
axes = ["z", [0, 2, 0.5]]

[[measure]]
name = "bend"
type = "angle"
markers = ["ground", "wheel"]
axes = [[1, 0, 0], "z"]

[[measure]]
name = "track"
type = "component"
markers = ["wheel"]
axis = [3, 4, 0]

[simulate]
t_end = 1.0

[output]
accelerations = true
rpy = true
units = "scene"
"#;

#[test]
fn measures_have_directions() {
    let scene = read(HUB).expect("a scene");
    let AnyDescription::Space3(spatial) = &scene.description else {
        panic!("a spatial scene");
    };
    let observed = &spatial.observed;
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let angle = |directions, about| MeasureKind::Angle { directions, about };
    let kinds: Vec<_> = observed.measures.iter().map(|m| m.kind).collect();
    assert_eq!(
        kinds,
        [
            angle([y, y], Some(z)),
            MeasureKind::Inclination([z, [0.0, 2.0, 0.5]]),
            angle([x, z], None),
            MeasureKind::Along([3.0, 4.0, 0.0]),
        ]
    );
    let output = &scene.output;
    assert!(output.accelerations && output.rpy && output.units == OutputUnits::Scene);
    // In the plane the directions have two components, and `component` and `angle` take them.
    let planar = SCENE
        .replace(
            "type = \"distance\"\nmarkers",
            "type = \"component\"\naxis = [0.6, -0.8]\nmarkers",
        )
        .replace(
            "markers = [\"tip\"]",
            "markers = [\"tip\"]\naxes = [[0, 1], \"x\"]",
        );
    let scene = read(&planar).expect("a scene");
    let observed = &scene.description.plane().expect("a planar scene").observed;
    let kinds: Vec<_> = observed.measures.iter().map(|m| m.kind).collect();
    let along = MeasureKind::Along([0.6, -0.8, 0.0]);
    assert_eq!(kinds, [along, angle([y, x], None)]);
}

#[test]
fn directions_of_measures_that_make_no_sense_are_refused() {
    check_in(
        HUB,
        &[
            (
                "type = \"component\"\nmarkers = [\"wheel\"]\naxis = [3, 4, 0]",
                "type = \"component\"\nmarkers = [\"wheel\"]\naxis = «[0, 0, 0]»",
                "measure `track`: a direction needs finite components that are not all zero",
                "no such measure",
            ),
            (
                "axes = [\"y\", \"y\"]",
                "axes = «[\"z\", \"y\"]»",
                "measure `toe`: its first direction must not be parallel to `about`",
                "no such measure",
            ),
            (
                "axes = [\"y\", \"y\"]",
                "axes = [\"y\", «\"w\"»]",
                "measure `toe`: `axes` names the unknown axis `w`",
                "no such axis",
            ),
            (
                "axes = [\"y\", \"y\"]",
                "axes = «[\"y\"]»",
                "measure `toe`: `axes` must be two directions [\"x\", \"y\"], each an axis or a vector, found a list of 1 value",
                "expected two directions [\"x\", \"y\"], each an axis or a vector",
            ),
            (
                "about = \"z\"",
                "about = «3»",
                "measure `toe`: `about` must be an axis \"x\" or a vector, found the number 3",
                "expected an axis \"x\" or a vector",
            ),
            (
                "axis = [3, 4, 0]",
                "axis = «[3, 4]»",
                "measure `track`: `axis` must be an axis \"x\" or a vector, found a list of 2 values",
                "expected an axis \"x\" or a vector",
            ),
            (
                "units = \"scene\"",
                "units = «\"mm\"»",
                "`[output]`: `units` `mm` is unknown",
                "no such choice",
            ),
        ],
    );
}

#[test]
fn names_of_derivatives_are_reserved_if_they_are_written() {
    let taken = HUB.replace("\"camber\"", "\"toe.rate\"");
    assert!(read(&taken).is_err());
    assert!(read(&taken.replace("accelerations = true", "")).is_ok());
    assert!(read(&format!("{SCENE}\n[output]\nrpy = true\n")).is_err());
    assert!(read(&format!("{SCENE}\n[output]\nrpy = false\n")).is_ok());
    let taken = HUB.replace("\"camber\"", "\"hub.yaw\"");
    assert!(read(&taken).is_err());
    assert!(read(&taken.replace("rpy = true", "")).is_ok());
}

/// The tolerance of a marker applies to its points. It takes precedence over the tolerances of body
/// and scene, and the tolerance of the joint takes precedence over it.
#[test]
fn a_tolerance_of_a_marker_is_that_of_its_point() {
    use model::{Mechanism, System};
    let stated = |text: &str| -> Vec<(String, Option<f64>)> {
        let d = read(text)
            .expect("a scene")
            .description
            .plane()
            .expect("a planar scene")
            .clone();
        let mechanism = Mechanism::build(&d).expect("a mechanism");
        let mut s = mechanism.scratch();
        mechanism.pose(0.0, &mechanism.described_state().0, &mut s);
        let blocks = mechanism.data().blocks(&s).into_iter();
        let name = |group: usize| mechanism.layout().groups[group].name.clone();
        let all = blocks.map(|b| (format!("{}.{}", name(b.group), b.name), b.tolerance));
        all.filter(|(name, _)| name.starts_with("B.")).collect()
    };
    let tolerances = |text: &str| -> Vec<Option<f64>> {
        stated(text)
            .into_iter()
            .map(|(_, tolerance)| tolerance)
            .collect()
    };
    assert_eq!(tolerances(SCENE), [Some(1e-5), None]);
    let with_scene = SCENE.replace(
        "space = \"plane\"\n",
        "space = \"plane\"\ntolerance = 1e-3\n",
    );
    assert_eq!(tolerances(&with_scene), [Some(1e-5), Some(1e-3)]);
    let with_joint = SCENE.replace("name = \"B\"\n", "name = \"B\"\ntolerance = 1e-2\n");
    assert_eq!(tolerances(&with_joint), [Some(1e-2); 2]);
    // A part of the mechanism has the same tolerance.
    let d = read(SCENE)
        .expect("a scene")
        .description
        .plane()
        .expect("a planar scene")
        .clone();
    let part = Mechanism::build(&d)
        .expect("a mechanism")
        .part_of_groups(&[1]);
    assert_eq!(part.mechanism.frames().observed().markers.len(), 1);
    let of = ToleranceScope::Marker("tip".to_owned());
    assert_eq!(of.to_string(), "marker `tip`");
}

#[test]
fn faults_have_their_places() {
    check_in(
        SCENE,
        &[
            (
                "at = \"shaft\"",
                "at = «\"shaf\"»",
                "joint `A` refers to the unknown marker `shaf`",
                "no such marker",
            ),
            (
                "slider = [0.3, 0.0]",
                "slider = «\"tip\"»",
                "joint `B`: `points`: marker `tip` belongs to `crank`, and a point of `slider` is needed; \
                 `at = \"tip\"` uses the position of the marker",
                "not a marker of this body",
            ),
            (
                "point = \"nose\"",
                "point = «\"shaft\"»",
                "joint `W`: marker `shaft` belongs to `ground`, and a point of `slider` is needed; \
                 `at = \"shaft\"` uses the position of the marker",
                "not a marker of this body",
            ),
            (
                "at = [\"nose\", [1.0, 3.0]]",
                "at = «\"nose\"»",
                "joint `C`: `at` must be 2 global points [[x, y], …], found the text \"nose\"",
                "expected 2 global points [[x, y], …]",
            ),
            (
                "body = \"slider\"\npoint = [0.0, 1.0]",
                "body = «\"sliders\"»\npoint = [0.0, 1.0]",
                "marker `nose` refers to the unknown body `sliders`",
                "no such body; `slider` is defined on line 14",
            ),
            (
                "point = [1.0, 0.25]",
                "point = «[1.0]»",
                "marker `tip`: `point` must be a point [x, y], found a list of 1 value",
                "expected a point [x, y]",
            ),
            (
                "tolerance = 1e-5",
                "tolerance = «0.0»",
                "marker `tip`: tolerance is 0.0, need a finite number > 0 up to 1e60",
                "expected a number > 0",
            ),
            (
                "type = \"distance\"\nmarkers",
                "type = «\"length\"»\nmarkers",
                "measure `gap` has the unknown type `length`",
                "unknown type",
            ),
            (
                "[\"tip\", \"nose\"]",
                "[\"tip\", «\"noes\"»]",
                "measure `gap` refers to the unknown marker `noes`",
                "no such marker",
            ),
            (
                "[\"tip\", \"nose\"]",
                "«[\"tip\", \"tip\"]»",
                "measure `gap` is between two identical points",
                "give two different places",
            ),
            (
                "[\"tip\", \"nose\"]",
                "«[\"tip\", \"nose\", \"shaft\"]»",
                "measure `gap`: `markers` must be one or two markers [\"a\", \"b\"], found a list of 3 values",
                "expected one or two markers [\"a\", \"b\"]",
            ),
            (
                "markers = [\"tip\"]",
                "markers = «[\"ground\"]»",
                "measure `turn` is between two identical points",
                "give two different places",
            ),
            (
                "name = \"turn\"",
                "name = «\"slider\"»",
                "the name `slider` is used twice",
                "used again here",
            ),
            (
                "name = \"gap\"",
                "name = «\"t\"»",
                "measure `t` has the name of another column of `trajectory.csv`",
                "choose another name",
            ),
            (
                "name = \"gap\"",
                "name = «\"crank.vx\"»",
                "measure `crank.vx` has the name of another column of `trajectory.csv`",
                "choose another name",
            ),
            (
                "centre = [0.5, 0.0]",
                "velocity = «[0.0, 0.0]»\ncentre = [0.5, 0.0]",
                "body `crank`: `velocity` is that of the origin of its frame, which is not its centre of mass, \
                 so `angular_velocity` is needed with it",
                "needs `angular_velocity` too",
            ),
            (
                "centre = [0.5, 0.0]",
                "centre = «0.5»",
                "body `crank`: `centre` must be a pair [x, y], found the number 0.5",
                "expected a pair [x, y]",
            ),
        ],
    );
}

/// In a scene without markers, a text is not the name of a marker.
#[test]
fn numbers_with_units_are_no_markers() {
    let text = "[scene]\nname = \"x\"\nspace = \"plane\"\n[[body]]\nname = \"a\"\nmass = 1\ninertia = 1\n\
                [[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"a\"]\nat = \"500 mm\"\n";
    let problems = read(text).expect_err("no point");
    assert!(
        problems[0]
            .message
            .contains("must be a global point [x, y]"),
        "{problems:#?}"
    );
}
