//! Tests the published robot with its trolley: the numbers of elements and rows, and the assembly
//! of its joints.

use dynamics::{MotionOptions, RowChoice};
use model::{Mechanism, StartOptions, System};
use pfaff_scene::{Combination, Output};

use crate::{ROBOT, read};

#[test]
fn the_robot_reads() {
    let scene = read(ROBOT).expect("the pattern of all scenes");
    let d = scene.description.plane().expect("a planar scene").clone();
    assert_eq!(scene.name(), "robot-trolley");
    assert_eq!((d.bodies.len(), d.joints.len()), (7, 13));
    assert_eq!((d.drives.len(), d.forces.len()), (1, 0));
    assert_eq!(scene.simulate, Some(MotionOptions::to(10.0)));
    assert_eq!(scene.start, StartOptions::default());
    assert_eq!(scene.output, Output::default());
    assert!(scene.groups.is_empty());
    // The drive has moved 0.02 m at t = 2 and is back at t = 4.
    let motion = &d.drives[0].motion;
    assert_eq!(motion.jet(2.5), [0.02, 0.0, 0.0]);
    assert_eq!(motion.jet(5.0), [0.0, 0.0, 0.0]);
    assert_eq!(motion.break_times().len(), 8);
}

/// The indices of rows are those of the published model.
#[test]
fn rows_have_the_numbers_of_the_contract() {
    let scene = read(ROBOT).expect("a scene");
    let mechanism = Mechanism::build(&scene.description).expect("a mechanism");
    let groups: Vec<_> = mechanism
        .layout()
        .groups
        .iter()
        .map(|g| {
            let last = g.rows.row(g.rows.len() - 1);
            (g.name.as_str(), g.rows.row(0) + 1, last + 1)
        })
        .collect();
    let expected = [
        ("A", 1, 2),
        ("B", 3, 4),
        ("C", 5, 6),
        ("D", 7, 8),
        ("E", 9, 10),
        ("F", 11, 12),
        ("G", 13, 14),
        ("H", 15, 16),
        ("steering", 17, 17),
        ("W1", 18, 18),
        ("W2", 19, 19),
        ("W3", 20, 20),
        ("W4", 21, 21),
        ("W5", 22, 22),
    ];
    assert_eq!(groups, expected);
}

/// A point in ground coordinates is converted to the same point in the frames of both bodies, so no
/// correction is necessary.
#[test]
fn the_joints_close_without_correction() {
    let scene = read(ROBOT).expect("a scene");
    let mut mechanism = Mechanism::build(&scene.description).expect("a mechanism");
    let start = model::start::assemble(&mut mechanism, &scene.start).expect("a start");
    let largest = start.correction.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    assert!(largest < 1e-15, "correction {largest:e}");
}

#[test]
fn everything_optional_is_read() {
    let more = r#"
method = "dopri5"
stabilisation = "projection"
rtol = 1e-6
atol = 1e-9
output_step = 0.5
drop = [6, 21]

[start]
keep = ["platform.vx", "front-knuckle.angle"]
allow_correction = true

[output]
trajectory = false
reactions = ["steering", "W3"]
report = false

[[group]]
name = "wheels"
members = ["W3", "W4"]

[[group]]
name = "sum"
combine = "W3.N + 2*W4.N - steering.drive"
"#;
    let scene = read(&format!("{ROBOT}{more}")).expect("a scene");
    let options = scene.simulate.expect("a run");
    assert_eq!(options.rows, RowChoice::Drop(vec![5, 20]));
    assert_eq!(
        (options.rtol, options.atol, options.output_step),
        (1e-6, 1e-9, 0.5)
    );
    use model::start::{Coordinate, CorrectionLimit, KeepLevel};
    assert_eq!(scene.start.correction, CorrectionLimit::Any);
    let coordinate = |body, dof, level| Coordinate { body, dof, level };
    assert_eq!(
        scene.start.keep,
        [
            coordinate(0, 0, KeepLevel::Velocity),
            coordinate(1, 2, KeepLevel::Position)
        ]
    );
    assert_eq!(
        scene.output,
        Output {
            trajectory: false,
            reactions: pfaff_scene::WantedReactions::Of(vec!["steering".into(), "W3".into()]),
            report: false,
            bounds: None,
            ..Output::default()
        }
    );
    assert_eq!(
        scene.groups[0].content,
        pfaff_scene::GroupContent::Members(vec!["W3".into(), "W4".into()])
    );
    let pfaff_scene::GroupContent::Combination(Combination::Components(sum)) =
        &scene.groups[1].content
    else {
        panic!("{:?}", scene.groups[1]);
    };
    let terms: Vec<_> = sum
        .iter()
        .map(|t| (t.coefficient, t.reaction.as_str(), t.component.as_str()))
        .collect();
    assert_eq!(
        terms,
        [
            (1.0, "W3", "N"),
            (2.0, "W4", "N"),
            (-1.0, "steering", "drive")
        ]
    );
}

#[test]
fn combinations_of_the_command_line_are_read_with_the_names_of_the_scene() {
    let scene = read(ROBOT).expect("a scene");
    let terms = |text: &str| match scene.combination(text).expect("known") {
        Combination::Components(terms) => ("components", terms.len()),
        Combination::Wrenches(terms) => ("wrenches", terms.len()),
    };
    assert_eq!(terms("W3.N + W4.N"), ("components", 2));
    assert_eq!(terms("W3 + W4"), ("wrenches", 2));
    // The component is identically zero, but it may still be requested.
    assert_eq!(terms("W3.T"), ("components", 1));
    assert_eq!(
        scene.combination("A.N").expect_err("unknown").to_string(),
        "the reaction of `A` has no component `N`; it has `Fx`, `Fy`, `T`"
    );
}
