//! The same mechanism as a scene and as a program: all results are bitwise equal.

use pfaff::documents::MotionDocument;
use pfaff::dynamics::MotionError;
use pfaff::joints::{SpringDamper, Torque, Velocity};
use pfaff::model::{Force, Joint};
use pfaff::prelude::*;
use pfaff::report::OutputDirectory;
use serde_json::Value;

/// A coupler is supported by three parallel cranks, one of them redundant, with a spring and a
/// varying torque. The coupler has a slide with a drive, and a separate cart on two wheels of one
/// axle has a prescribed speed.
const SCENE: &str = r#"
scene = { name = "three cranks and a cart", space = "plane", gravity = [0.0, -9.81] }

body = [
    { name = "first", mass = 1.0, inertia = 0.1, position = [0.3, 0.4], angle = 0.9272952180016122, velocity = [-0.4, 0.3], angular_velocity = 1.0 },
    { name = "second", mass = 1.5, inertia = 0.2, position = [1.3, 0.4], angle = 0.9272952180016122, velocity = [-0.4, 0.3], angular_velocity = 1.0 },
    { name = "third", mass = 2.0, inertia = 0.3, position = [2.3, 0.4], angle = 0.9272952180016122, velocity = [-0.4, 0.3], angular_velocity = 1.0 },
    { name = "coupler", mass = 4.0, inertia = 0.7, position = [1.6, 0.8], velocity = [-0.8, 0.6] },
    { name = "slide", mass = 0.5, inertia = 0.1, position = [1.7, 0.8], velocity = [-0.5316718427, 0.7341640786] },
    { name = "cart", mass = 10.0, inertia = 1.0, position = [0.0, -3.0], velocity = [0.5, 0.0], angular_velocity = 1.0 },
]

joint = [
    { name = "A1", type = "revolute", bodies = ["ground", "first"], at = [0.0, 0.0] },
    { name = "A2", type = "revolute", bodies = ["ground", "second"], at = [1.0, 0.0] },
    { name = "A3", type = "revolute", bodies = ["ground", "third"], at = [2.0, 0.0] },
    { name = "B1", type = "revolute", bodies = ["first", "coupler"], at = [0.6, 0.8] },
    { name = "B2", type = "revolute", bodies = ["second", "coupler"], at = [1.6, 0.8] },
    { name = "B3", type = "revolute", bodies = ["third", "coupler"], at = [2.6, 0.8] },
    { name = "guide", type = "translational", bodies = ["coupler", "slide"], at = [1.6, 0.8], axis = [1.0, 0.5] },
    { name = "left", type = "knife-edge", body = "cart", point = [0.0, 0.5], normal = [0.0, 1.0] },
    { name = "right", type = "knife-edge", body = "cart", point = [0.0, -0.5], normal = [0.0, 1.0] },
    { name = "speed", type = "velocity", body = "cart", point = [0.0, 0.0], direction = [1.0, 0.0], rate = 0.5 },
]

drive = [{ name = "motor", joint = "guide", type = "displacement", motion = { type = "harmonic", amplitude = 0.1, omega = 3.0 } }]

force = [
    { name = "spring", type = "spring-damper", bodies = ["ground", "coupler"], at = [[0.0, 2.0], [1.1, 0.8]], stiffness = 30.0, damping = 0.5, free_length = 1.0 },
    { name = "push", type = "torque", body = "first", torque = { type = "polynomial", coefficients = [1.0, -0.5] } },
]
"#;

/// The same mechanism in Rust.
fn description() -> Description {
    let mut d = Description {
        gravity: [0.0, -9.81],
        ..Description::new("three cranks and a cart")
    };
    let cranks = [
        ("first", 1.0, 0.1),
        ("second", 1.5, 0.2),
        ("third", 2.0, 0.3),
    ];
    let cranks: Vec<BodyRef> = std::iter::zip(cranks, [0.3, 1.3, 2.3])
        .map(|((name, mass, inertia), x)| {
            d.body(Body {
                position: [x, 0.4],
                angle: 0.9272952180016122,
                velocity: Some([-0.4, 0.3]),
                angular_velocity: Some(1.0),
                ..Body::new(name, mass, inertia)
            })
        })
        .collect();
    let coupler = d.body(Body {
        position: [1.6, 0.8],
        velocity: Some([-0.8, 0.6]),
        ..Body::new("coupler", 4.0, 0.7)
    });
    let slide = d.body(Body {
        position: [1.7, 0.8],
        velocity: Some([-0.5316718427, 0.7341640786]),
        ..Body::new("slide", 0.5, 0.1)
    });
    let cart = d.body(Body {
        position: [0.0, -3.0],
        velocity: Some([0.5, 0.0]),
        angular_velocity: Some(1.0),
        ..Body::new("cart", 10.0, 1.0)
    });
    let at = |d: &Description, i, j, point| Revolute {
        s_i: d.local(i, point),
        s_j: d.local(j, point),
    };
    for (k, (&crank, x)) in cranks.iter().zip([0.0, 1.0, 2.0]).enumerate() {
        let pivot = at(&d, BodyRef::Ground, crank, [x, 0.0]);
        d.joint(&format!("A{}", k + 1), &[BodyRef::Ground, crank], pivot);
    }
    for (k, (&crank, x)) in cranks.iter().zip([0.6, 1.6, 2.6]).enumerate() {
        let pin = at(&d, crank, coupler, [x, 0.8]);
        d.joint(&format!("B{}", k + 1), &[crank, coupler], pin);
    }
    let (s_i, s_j) = (d.local(coupler, [1.6, 0.8]), d.local(slide, [1.6, 0.8]));
    let axis = Direction::new([1.0, 0.5]).expect("a direction");
    let guide = Translational::new(s_i, s_j, axis);
    d.joint("guide", &[coupler, slide], guide.clone());
    for (name, y) in [("left", 0.5), ("right", -0.5)] {
        let normal = Direction::Y;
        d.joint(
            name,
            &[cart],
            KnifeEdge {
                s: [0.0, y],
                normal,
            },
        );
    }
    let along = Velocity {
        s: [0.0, 0.0],
        direction: Direction::X,
    };
    d.joint("speed", &[cart], along).functions = vec![Function::constant(0.5).expect("finite")];
    let motion = Function::harmonic(0.1, 3.0, 0.0, 0.0).expect("finite");
    d.drive(
        "motor",
        &[coupler, slide],
        guide.displacement_drive(),
        motion,
    );
    let spring = SpringDamper::new([0.0, 2.0], d.local(coupler, [1.1, 0.8]), 30.0, 0.5)
        .with_free_length(1.0);
    d.force("spring", &[BodyRef::Ground, coupler], spring);
    let torque = Function::polynomial(&[1.0, -0.5]).expect("finite");
    d.force("push", &cranks[..1], Torque {}).functions = vec![torque];
    d
}

fn from_text() -> Study {
    let registry = Registry::standard();
    let study = Study::read("scene.toml", SCENE, &registry, &RunOptions::default());
    study.unwrap_or_else(|e| panic!("{e}"))
}

fn from_code() -> Study {
    Study::build(description()).unwrap_or_else(|e| panic!("{e}"))
}

/// Converts to JSON, in which numbers are written such that the same bits are read back.
fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).expect("plain data")
}

#[test]
fn verdicts_are_the_same_to_the_last_bit() {
    let sums = ["left.N + right.N".to_owned(), "A1 + A2 + A3".to_owned()];
    let document = |study: &Study| {
        let start = study.analyse(0.0, None).expect("a start");
        start.document(&sums).expect("verdicts")
    };
    let (text, code) = (document(&from_text()), document(&from_code()));
    assert_eq!(json(&text), json(&code));
    // One crank and one wheel are redundant.
    assert_eq!((code.configuration.rows, code.ranks.redundancy), (18, 2));
    assert_eq!(code.groups[0].verdict.verdict, "unique");
    assert!(
        code.reactions
            .iter()
            .any(|r| r.wrench.verdict == "not_unique")
    );
}

#[test]
fn motions_are_the_same_to_the_last_bit() {
    let options = MotionOptions::to(2.0);
    let motion = |study: Study| study.motion(&options).expect("it moves");
    let (text, code) = (motion(from_text()), motion(from_code()));
    assert_eq!(json(&text.rows), json(&code.rows));
    let timeless = |mut motion: MotionDocument| {
        motion.summary.wall_seconds = 0.0;
        json(&motion.summary)
    };
    let crank = |k: usize| code.rows[k].bodies["first"]["angle"];
    assert!((crank(200) - crank(0)).abs() > 0.1, "it stands still");
    assert_eq!(timeless(text), timeless(code));
}

/// The requests of a scene in addition to its mechanism have the same names in the library.
#[test]
fn files_are_the_same() {
    let wants = Some(MotionOptions::to(0.5));
    let scene = Scene {
        simulate: wants,
        ..description().into()
    };
    let text = format!("{SCENE}simulate = {{ t_end = 0.5 }}\n");
    let registry = Registry::standard();
    let text =
        Study::read("scene.toml", &text, &registry, &RunOptions::default()).expect("a scene");
    let code = Study::build(scene).expect("a scene");
    let folder = std::env::temp_dir().join(format!("pfaff-from-rust-{}", std::process::id()));
    let written = |study: &Study, name: &str| {
        let path = folder.join(name);
        let directory = OutputDirectory::create(&path).expect("a folder");
        let goes_on = |_| std::ops::ControlFlow::Continue(());
        study.simulate_into(&directory, goes_on).expect("a run");
        let read = |file| std::fs::read_to_string(path.join(file)).expect("written");
        assert!(read("report.html").contains("</html>"));
        [read("trajectory.csv"), read("reactions.csv")]
    };
    let (text, code) = (written(&text, "text"), written(&code, "code"));
    let _ = std::fs::remove_dir_all(&folder);
    assert!(text == code, "tables differ");
}

/// Rows of the library have the values and names of the tables of the command.
#[test]
fn rows_are_those_of_the_tables() {
    let study = from_code();
    let motion = study.motion(&MotionOptions::to(0.1)).expect("it moves");
    let last = motion.rows.last().expect("rows");
    let value: Value = serde_json::to_value(last).expect("plain data");
    let keys = |value: &Value| -> Vec<String> {
        let object = value.as_object().expect("an object");
        object.keys().cloned().collect()
    };
    assert_eq!(keys(&value), ["bodies", "reactions", "t"]);
    let mut state = keys(&value["bodies"]["cart"]);
    state.sort();
    assert_eq!(state, ["angle", "omega", "vx", "vy", "x", "y"]);
    assert_eq!(keys(&value["reactions"]["left"]), ["Fx", "Fy", "N", "T"]);
    assert_eq!(
        keys(&value["reactions"]["motor"]),
        ["Fx", "Fy", "T", "drive"]
    );
    // The cart moves at half a metre per second and a radian per second, on a circle of half a
    // metre about (0, −2.5).
    let cart = &last.bodies["cart"];
    assert!((cart["x"] - 0.5 * 0.1_f64.sin()).abs() < 1e-9, "{cart:?}");
    assert!((cart["vx"] - 0.5 * 0.1_f64.cos()).abs() < 1e-9, "{cart:?}");
}

/// Without a text, errors have no positions, but they contain names and values.
#[test]
fn errors_have_names() {
    let build = |change: &dyn Fn(&mut Description)| {
        let mut d = description();
        change(&mut d);
        Study::build(d).err().expect("refused")
    };
    let error = build(&|d| d.bodies[3].mass = -4.0);
    assert!(matches!(&error, StudyError::Build(faults) if faults.len() == 1));
    assert_eq!(
        error.to_string(),
        "1 problem(s) in the description, the first: body `coupler`: mass is -4, need a number ≥ 0"
    );
    let far = build(&|d| d.bodies[4].position = [7.0, 7.0]);
    assert!(matches!(far, StudyError::Motion(MotionError::Start(_))));
    assert!(far.is_input());
    assert!(far.to_string().contains("of body `slide`"), "{far}");
    let nan = build(&|d| {
        let joint = Revolute {
            s_i: [f64::NAN, 0.0],
            s_j: [0.0; 2],
        };
        d.joints.push(Joint::new(
            "bad",
            &[BodyRef::Ground, BodyRef::Body(5)],
            joint,
        ));
    });
    assert!(nan.to_string().contains("`bad`"), "{nan}");
    let nan = build(&|d| {
        let push = SpringDamper::new([0.0, f64::INFINITY], [0.0; 2], 1.0, 1.0);
        let bodies = vec![BodyRef::Ground, BodyRef::Body(5)];
        let (element, functions) = (Box::new(push), Vec::new());
        d.forces.push(Force {
            name: "bad".into(),
            bodies,
            element,
            functions,
        });
    });
    assert!(nan.to_string().contains("`bad`"), "{nan}");
}
