//! Tests whether redundancy is permanent, or exists only at a singular configuration, by a
//! comparison with other configurations.

use joints::{KnifeEdge, Revolute, RevoluteAngleDrive, Velocity, plane::Direction};
use model::{
    Body, BodyRef, ContactLimits, Description, Drive, Function, Joint, Mechanism, Registry,
};
use pfaff::{RunOptions, Study};
use solvability::{Generic, analyse, generic, generic_with_verdicts, is_permanent};
use tests::cranks::cranks;
use tests::robot::{robot, steering};

fn at_start(d: &Description) -> (usize, Option<Generic>) {
    let mechanism = Mechanism::build(d).expect("builds");
    let (q, _) = mechanism.described_state();
    let analysis = analyse(&mechanism, 0.0, &q).expect("finite");
    let found = generic(&mechanism, 0.0, &q);
    let permanent = is_permanent(&mechanism, 0.0, &q, &analysis.whole().expect("one part"));
    let redundancy = analysis.decision.redundancy;
    let expected = found.as_ref().map(|g| g.redundancy == redundancy);
    assert_eq!(permanent, expected);
    (redundancy, found)
}

fn driven(mut d: Description) -> Description {
    let element = RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    d.drives.push(Drive {
        tolerance: None,
        name: "motor".into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(0)],
        element: Box::new(element),
        motion: Function::constant_rate(1.0).expect("finite"),
    });
    d
}

/// The mechanism has n cranks: n − 2 redundant rows, and one more in the singular configuration,
/// with a drive (no degree of freedom remains) or without.
#[test]
fn cranks_are_compared_with_themselves_elsewhere() {
    for (pivots, usual) in [
        (&[0.0, 1.0][..], 0),
        (&[0.0, 1.0, 1.7], 1),
        (&[0.0, 0.3, 1.0, 1.7], 2),
    ] {
        for theta in [0.0, 0.4, 1.5] {
            let d = cranks(pivots, 0.5, theta);
            for d in [d.clone(), driven(d)] {
                let (here, found) = at_start(&d);
                let found = found.expect("cranks move");
                assert_eq!(here, usual + usize::from(theta == 0.0));
                assert_eq!(found.redundancy, usual);
                assert!(found.points.len() >= 3, "{}", found.points.len());
                let mut angles = vec![theta];
                let mut seen: Vec<&[f64]> = Vec::new();
                for point in &found.points {
                    assert_eq!((point.redundancy, point.time), (usual, 0.0));
                    let is_far = |other: &&[f64]| {
                        let pairs = other.iter().zip(&point.q);
                        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) > 0.05
                    };
                    assert!(seen.iter().all(is_far), "{found:?}");
                    seen.push(&point.q);
                    // Two cranks that start in the singular configuration may cross; all others
                    // have one angle.
                    if pivots.len() > 2 || theta != 0.0 {
                        let is_new = |a: &f64| (a - point.q[2]).abs() > 0.05;
                        assert!(angles.iter().all(is_new), "{found:?}");
                    }
                    angles.push(point.q[2]);
                }
            }
        }
    }
}

/// Returns the verdicts on a component here and at other configurations.
fn here_and_elsewhere(d: &Description, joint: &str, component: &str) -> [&'static str; 2] {
    let mechanism = Mechanism::build(d).expect("builds");
    let (q, _) = mechanism.described_state();
    let analysis = analyse(&mechanism, 0.0, &q).expect("finite");
    let (found, verdicts) = generic_with_verdicts(&mechanism, 0.0, &q).expect("it moves");
    assert_eq!(Some(found), generic(&mechanism, 0.0, &q));
    let verdicts = verdicts.expect("known");
    let here = analysis.reactions.iter().find(|r| r.name == joint);
    let here = here.expect("a joint");
    let own = here.components.iter().find(|c| c.name == component);
    let generic = verdicts[here.id.0].component(component);
    let own = own.expect("a component").judgement.verdict.word();
    [own, generic.expect("a component").word()]
}

/// Three cranks carry a load along the cranks that two of them could carry: in the upright position
/// it has no component along x. Two cranks are redundant only in the singular configuration.
#[test]
fn verdicts_elsewhere_are_those_of_components() {
    let unique = "unique";
    let open = "not_unique";
    let upright = cranks(&[0.0, 1.0, 1.7], 0.5, std::f64::consts::FRAC_PI_2);
    let oblique = cranks(&[0.0, 1.0, 1.7], 0.5, 1.0);
    let flat = cranks(&[0.0, 1.0], 0.5, 0.0);
    for joint in ["pivot 1", "tip 2", "pivot 3"] {
        let of = |d, component| here_and_elsewhere(d, joint, component);
        assert_eq!(of(&upright, "Fx"), [unique, open], "{joint}");
        assert_eq!(of(&upright, "Fy"), [open, open], "{joint}");
        assert_eq!(of(&oblique, "Fx"), [open, open], "{joint}");
    }
    for joint in ["pivot 1", "tip 2"] {
        assert_eq!(
            here_and_elsewhere(&flat, joint, "Fx"),
            [open, unique],
            "{joint}"
        );
    }
}

/// A cart on two wheels of one axle: the wheels share a force along the axle, which turns with the
/// cart.
#[test]
fn a_cart_that_turns_has_both_components_open() {
    let wheel = |name: &str, y: f64| {
        let element = KnifeEdge {
            s: [0.0, y],
            normal: Direction::Y,
        };
        Joint::new(name, &[BodyRef::Body(0)], element)
    };
    let d = Description {
        bodies: vec![beam()],
        joints: vec![wheel("left", 0.5), wheel("right", -0.5)],
        ..Description::default()
    };
    for name in ["left", "right"] {
        let of = |component| here_and_elsewhere(&d, name, component);
        assert_eq!(of("Fx"), ["unique", "not_unique"]);
        assert_eq!(of("Fy"), ["not_unique", "not_unique"]);
    }
}

/// The robot with straight wheels has rank 20 there and at other configurations.
#[test]
fn the_robot_is_redundant_everywhere() {
    let (here, found) = at_start(&robot(steering()));
    let found = found.expect("the robot moves");
    assert_eq!((here, found.redundancy), (2, 2));
    assert!(found.points.iter().all(|p| p.rank == 20));
}

/// A structure has no other configuration, so the result is undecided.
#[test]
fn a_structure_cannot_be_compared() {
    let hinge = |name: &str, x: f64| {
        let element = Revolute {
            s_i: [x, 0.0],
            s_j: [x, 0.0],
        };
        Joint::new(name, &[BodyRef::Ground, BodyRef::Body(0)], element)
    };
    let d = Description {
        bodies: vec![beam()],
        joints: vec![hinge("left", -1.0), hinge("right", 1.0)],
        ..Description::default()
    };
    assert_eq!(at_start(&d), (1, None));
    let mechanism = Mechanism::build(&d).expect("builds");
    let (q, _) = mechanism.described_state();
    assert_eq!(generic_with_verdicts(&mechanism, 0.0, &q), None);
}

fn beam() -> Body {
    Body {
        name: "beam".into(),
        mass: 1.0,
        inertia: 1.0,
        ..Body::default()
    }
}

/// If a joint prescribes a velocity as a function of time, other configurations are compared at
/// other times.
#[test]
fn time_moves_where_a_joint_depends_on_it() {
    let pull = |name: &str| Joint {
        tolerance: None,
        name: name.into(),
        bodies: vec![BodyRef::Body(0)],
        element: Box::new(Velocity {
            s: [0.0, 0.0],
            direction: Direction::X,
        }),
        functions: vec![Function::constant_rate(1.0).expect("finite")],
        limits: ContactLimits::default(),
    };
    let d = Description {
        bodies: vec![beam()],
        joints: vec![pull("one"), pull("other")],
        ..Description::default()
    };
    let (here, found) = at_start(&d);
    let found = found.expect("a free body");
    assert_eq!((here, found.redundancy), (1, 1));
    assert!(found.points.iter().all(|p| p.time > 0.0));
}

/// Whether other configurations of a scene were found, and their results.
fn elsewhere(scene: &str) -> Option<Generic> {
    let study = Study::read(
        "scene",
        scene,
        &Registry::standard(),
        &RunOptions::default(),
    );
    let study = study.unwrap_or_else(|e| panic!("{scene}\n{e}"));
    let start = study.analyse(0.0, None).expect("a rank");
    start.generic()
}

/// Two wheels, each supported at its centre, have two gears between them: no body has a lever arm.
/// The result must not depend on position, size or mass.
#[test]
fn wheels_are_compared_wherever_they_are_and_whatever_they_weigh() {
    for mass in [0.9, 1.0, 2.0, 3.0] {
        for size in [1.0, 1e-3, 1e3] {
            for (x, y) in [(0.0, 0.0), (0.3, -0.7), (1e4, 0.0)] {
                let [x, y, top] = [size * x, size * y, size * (y + 0.12)];
                let scene = format!(
                    r#"
scene = {{ name = "wheels", space = "plane" }}
body = [
    {{ name = "a", mass = {mass:?}, inertia = 0.01, position = [{x:?}, {y:?}] }},
    {{ name = "b", mass = {mass:?}, inertia = 0.01, position = [{x:?}, {top:?}] }},
]
joint = [
    {{ name = "A", type = "revolute", bodies = ["ground", "a"], at = [{x:?}, {y:?}] }},
    {{ name = "B", type = "revolute", bodies = ["ground", "b"], at = [{x:?}, {top:?}] }},
    {{ name = "one", type = "gear", bodies = ["a", "b"], ratio = -1.0 }},
    {{ name = "other", type = "gear", bodies = ["a", "b"], ratio = -1.0 }},
]
"#
                );
                let found = elsewhere(&scene).unwrap_or_else(|| panic!("{scene}"));
                assert_eq!((found.redundancy, found.points.len()), (1, 4), "{scene}");
            }
        }
    }
}

/// The crank of a Scotch yoke rotates about the origin, and its pin moves along the slot. At this
/// instant no row depends on the lever arm of the crank, for any direction of the slot.
#[test]
fn a_pin_that_moves_along_its_slot_has_an_arm() {
    for turn in [0.0, 0.3, 0.7, 1.0, 2.5] {
        let at = |x: f64| format!("[{:?}, {:?}]", x * f64::cos(turn), x * f64::sin(turn));
        let scene = format!(
            r#"
scene = {{ name = "yoke", space = "plane" }}
body = [
    {{ name = "crank", mass = 1.5, inertia = 0.01, angle = {turn:?} }},
    {{ name = "yoke", mass = 2.0, inertia = 0.05, position = {pin}, angle = {turn:?} }},
]
joint = [
    {{ name = "pivot", type = "revolute", bodies = ["ground", "crank"], at = [0.0, 0.0] }},
    {{ name = "slot", type = "pin-in-slot", bodies = ["yoke", "crank"], at = {pin}, axis = [0.0, 1.0] }},
    {{ name = "left", type = "translational", bodies = ["ground", "yoke"], at = {left}, axis = {axis} }},
    {{ name = "right", type = "translational", bodies = ["ground", "yoke"], at = {right}, axis = {axis} }},
]
"#,
            pin = at(0.1),
            left = at(-0.4),
            right = at(0.4),
            axis = at(1.0),
        );
        let found = elsewhere(&scene).unwrap_or_else(|| panic!("{scene}"));
        assert_eq!((found.redundancy, found.points.len()), (2, 4), "{scene}");
    }
}

/// A platform on four equal parallel legs moves on a sphere without rotation, and the legs remain
/// redundant. The second-order conditions exclude the rotation about their direction. Crossed legs
/// are another branch of the same joints, on which all four are independent.
#[test]
fn legs_that_stay_parallel_are_not_compared_with_those_that_do_not() {
    let legs = |feet: &[[f64; 3]], lean: [f64; 3]| {
        let mut scene = String::from(
            r#"
scene = { name = "legs", space = "spatial" }
body = [{ name = "platform", mass = 1.0, inertia = [1.0, 1.0, 1.0] }]
joint = [
"#,
        );
        for (k, foot) in feet.iter().enumerate() {
            let top: Vec<f64> = foot.iter().zip(lean).map(|(x, l)| x + l).collect();
            scene += &format!(
                "{{ name = \"leg {k}\", type = \"distance\", bodies = [\"ground\", \"platform\"], at = [{foot:?}, {top:?}] }},\n"
            );
        }
        scene + "]\n"
    };
    let feet = [
        [1.0, 0.0, 0.0],
        [-0.6, 0.8, 0.0],
        [-0.6, -0.8, 0.0],
        [0.0, 1.0, 0.0],
        [0.3, -0.2, 0.0],
    ];
    // Four feet are on a circle. In the upright position of the legs a branch begins on which they
    // rotate together, so the upright start of four legs belongs to both branches.
    for (lean, counts) in [
        ([1.0, 0.5, 2.0], 4..=5),
        ([0.0, 0.0, 2.0], 5..=5),
        ([0.3, -0.4, 1.0], 4..=5),
    ] {
        for count in counts {
            let scene = legs(&feet[..count], lean);
            let found = elsewhere(&scene).unwrap_or_else(|| panic!("{scene}"));
            assert_eq!(found.redundancy, count - 3, "{lean:?} {count}: {found:?}");
            // The orientation at the start is that of the ground.
            for point in &found.points {
                assert!(point.q[4..].iter().all(|x| x.abs() < 1e-9), "{found:?}");
            }
        }
    }
}
