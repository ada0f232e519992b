//! Tests positions of errors that are found after reading.

use dynamics::{DropError, MotionError, MotionFault, RowChoice, prepare};
use model::start::Misfit;
use model::{BuildError, Mechanism, StartError};
use pfaff_scene::{Label, Scene};

use crate::{BODIES, read, read_more};

fn scene() -> Scene {
    read_more(
        "[[joint]]\nname = \"A\"\ntype = \"distance\"\nbodies = [\"a\", \"b\"]\nat = [[1, 1], [1, 1]]\n\
         [simulate]\nt_end = 1.0\ndrop = [1]\n",
    )
}

/// Returns the text of a scene.
fn text_of(scene: &Scene) -> &str {
    scene.text().expect("it was read")
}

/// Returns the last line of the bodies.
fn lines_before() -> usize {
    BODIES.matches('\n').count()
}

#[test]
fn a_requirement_points_at_the_place_of_the_joint() {
    let scene = scene();
    let mut mechanism = Mechanism::build(&scene.description).expect("a mechanism");
    let error = model::start::assemble(&mut mechanism, &scene.start).expect_err("L = 0");
    let d = scene.locate_start(&error).expect("a place");
    let line = lines_before() + 5;
    assert_eq!(
        d.to_string(),
        format!(
            "x.toml:{line}:6: error: `A` requires at the start: the two points are apart (L > 0)"
        )
    );
    assert_eq!(scene.locate_motion(&MotionError::Start(error)), Some(d));
}

#[test]
fn a_large_correction_points_at_the_joint_that_misses() {
    let text = "[[joint]]\nname = \"A\"\ntype = \"revolute\"\nbodies = [\"ground\", \"b\"]\n\
                points = { ground = [0, 0], b = [0, 0] }\n";
    let scene = read_more(text);
    let mut mechanism = Mechanism::build(&scene.description).expect("a mechanism");
    let error = model::start::assemble(&mut mechanism, &scene.start).expect_err("far away");
    assert!(
        matches!(error, StartError::LargeCorrection { .. }),
        "{error}"
    );
    let d = scene.locate_start(&error).expect("a place");
    assert_eq!(&text_of(&scene)[d.primary.span.clone()], "\"A\"");
    // The violation is √(3² + 2²).
    assert!(
        error
            .to_string()
            .contains("these constraints are violated: `A` by 3.606 m;"),
        "{error}"
    );
}

#[test]
fn errors_of_a_run_point_at_rows_bodies_and_options() {
    let scene = scene();
    let mechanism = Mechanism::build(&scene.description).expect("a mechanism");
    let row = model::System::layout(&mechanism).labels[0].clone();
    let marked = |error: &MotionError| {
        let d = scene.locate_motion(error).expect("a place");
        text_of(&scene)[d.primary.span].to_owned()
    };
    let lost = MotionError::Fault(MotionFault::RankLost {
        time: 0.0,
        row,
        pivot: 0.0,
        scale: 1.0,
    });
    assert_eq!(marked(&lost), "\"A\"");
    assert_eq!(marked(&MotionError::Rows(DropError::NotRedundant)), "[1]");
    let massless = MotionError::Fault(MotionFault::Massless {
        time: 0.0,
        body: "b".into(),
        coordinate: "x",
    });
    assert_eq!(marked(&massless), "1.0");
    let option = MotionError::Option {
        name: "rtol",
        value: 0.0,
        expected: "a number > 0",
    };
    assert_eq!(marked(&option), "[simulate]");
}

/// Body c rotates about the origin; two drives of its rotation contradict each other.
const TWO_DRIVES: &str = r#"[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "c"]
at = [0, 0]
[[drive]]
name = "slow"
joint = "A"
type = "angle"
motion = { type = "constant-rate", rate = 1.0 }
[[drive]]
name = "fast"
joint = "A"
type = "angle"
motion = { type = "constant-rate", rate = 2.0 }
[simulate]
t_end = 1.0
"#;

/// Returns the first mark and the other marks.
fn marks(scene: &Scene, error: &MotionError) -> (String, Vec<String>) {
    let d = scene.locate_motion(error).expect("a place");
    let marked = |label: &Label| text_of(scene)[label.span.clone()].to_owned();
    (marked(&d.primary), d.secondary.iter().map(marked).collect())
}

#[test]
fn a_contradiction_points_at_all_its_drives() {
    let scene = read_more(TWO_DRIVES);
    let mechanism = Mechanism::build(&scene.description).expect("a mechanism");
    let error = prepare(mechanism, &scene.start, &RowChoice::Automatic)
        .err()
        .expect("1 rad/s or 2 rad/s");
    assert!(matches!(error, MotionError::Contradiction(_)), "{error}");
    let (first, others) = marks(&scene, &error);
    assert_eq!(first, "\"slow\"");
    assert_eq!(others, ["\"fast\""]);
}

#[test]
fn joints_that_miss_together_are_all_marked() {
    let scene = read_more(TWO_DRIVES);
    let mechanism = Mechanism::build(&scene.description).expect("a mechanism");
    let joints = model::System::layout(&mechanism).groups.iter();
    let misfits = joints.map(|joint| Misfit {
        joint: joint.name.clone(),
        distance: 1.0,
        angle: 0.0,
    });
    let error = MotionError::Start(StartError::NoAssembly {
        misfits: misfits.collect(),
        iterations: 1,
    });
    let (first, others) = marks(&scene, &error);
    assert_eq!(first, "\"A\"");
    assert_eq!(others, ["\"slow\"", "\"fast\""]);
}

#[test]
fn velocities_that_do_not_exist_point_at_the_drive() {
    let scene = read_more(
        &format!("{TWO_DRIVES}[start]\nkeep = [\"c.omega\"]\n").replace("rate = 2.0", "rate = 1.0"),
    );
    let mechanism = Mechanism::build(&scene.description).expect("a mechanism");
    let error = prepare(mechanism, &scene.start, &RowChoice::Automatic)
        .err()
        .expect("ω is kept at 0");
    let of_given = matches!(error, MotionError::Start(StartError::Velocities(_)));
    assert!(of_given, "{error}");
    let (first, others) = marks(&scene, &error);
    assert!(["\"slow\"", "\"fast\""].contains(&&first[..]), "{first}");
    assert_eq!(others, ["[\"c.omega\"]"]);
}

/// The description is changed after reading, as in a sweep.
#[test]
fn changed_numbers_point_at_their_keys() {
    let mut scene = scene();
    scene
        .description
        .plane_mut()
        .expect("a planar scene")
        .bodies[1]
        .mass = -1.0;
    scene
        .description
        .plane_mut()
        .expect("a planar scene")
        .bodies[2]
        .angular_velocity = Some(f64::NAN);
    let errors = Mechanism::build(&scene.description).err().expect("refused");
    let places: Vec<_> = errors
        .iter()
        .map(|error| {
            let d = scene.locate_build(error).expect("a place");
            text_of(&scene)[d.primary.span].to_owned()
        })
        .collect();
    // Body c has no key for an angular velocity, so its name is marked.
    assert_eq!(places, ["1.0", "\"c\""]);
    let unknown = BuildError::GroundOnly {
        name: "nobody".into(),
    };
    let place = scene.locate_build(&unknown).expect("a place");
    assert_eq!(place.primary.line, 1);
    // Without a text there are no positions.
    scene.source = None;
    assert_eq!(scene.locate_build(&unknown), None);
}

#[test]
fn diagnostics_are_data() {
    let problems = read("x = 1").expect_err("no scene");
    let json = serde_json::to_value(&problems[1]).expect("JSON");
    let expected = serde_json::json!({
        "severity": "error",
        "code": "P0102",
        "file": "x.toml",
        "message": "the scene has no key `x`",
        "primary": { "span": { "start": 0, "end": 1 }, "line": 1, "column": 1, "text": "unknown key" },
        "secondary": [],
        "help": "its keys are `scene`, `parameters`, `body`, `marker`, `measure`, `joint`, `drive`, `force`, `group`, `case`, `start`, `output`, `simulate`",
    });
    assert!(
        problems
            .iter()
            .any(|d| serde_json::to_value(d).ok().as_ref() == Some(&expected)),
        "{json:#}"
    );
}
