//! Tests whether finite reactions exist if the second-order conditions exclude a free motion. The
//! references are static solutions by hand.

use model::Registry;
use pfaff::dynamics::MotionOptions;
use pfaff::{RunOptions, Study, StudyError};
use solvability::{Choice, NormWeights, Value};

const GRAVITY: f64 = 9.81;

fn read(text: &str) -> Study {
    let found = Study::read("scene", text, &Registry::standard(), &RunOptions::default());
    found.unwrap_or_else(|e| panic!("{e}"))
}

/// Two bars of 1 kg are between two pins 2·c apart, and their middle is lower by `sag`; `more` is a
/// text that is appended to the scene.
fn truss(sag: f64, more: &str) -> Study {
    let c = 1.0;
    let angle = (sag / c).atan();
    read(&format!(
        r#"
scene = {{ name = "truss", space = "plane", gravity = [0.0, -{GRAVITY}] }}
body = [
  {{ name = "left", mass = 1.0, inertia = 0.1, position = [0.5, {y}], angle = -{angle} }},
  {{ name = "right", mass = 1.0, inertia = 0.1, position = [1.5, {y}], angle = {angle} }},
  {{ name = "bob", mass = 3.0, inertia = 0.1, position = [5.0, -1.0] }},
]
joint = [
  {{ name = "A", type = "revolute", bodies = ["ground", "left"], at = [0.0, 0.0] }},
  {{ name = "middle", type = "revolute", bodies = ["left", "right"], at = [1.0, {low}] }},
  {{ name = "B", type = "revolute", bodies = ["ground", "right"], at = [2.0, 0.0] }},
  {{ name = "hook", type = "revolute", bodies = ["ground", "bob"], at = [5.0, 0.0] }},
]
{more}
"#,
        y = -0.5 * sag,
        low = -sag,
    ))
}

/// Returns values of a joint for the choice of least norm.
fn values(study: &Study, joint: &str) -> Vec<(&'static str, Value)> {
    let start = study.analyse(0.0, None).expect("a start");
    let least = Choice::MinimumNorm(NormWeights::NEWTON_METRE);
    let found = start.distribution(&least).expect("a distribution");
    let own = found.reactions.into_iter().find(|r| r.name == joint);
    own.expect("a joint").components
}

/// Moments of the left bar about A give `H·sag = m·g·c/2`. H grows without bound, and the vertical
/// part remains m·g; horizontal bars have no value at all.
#[test]
fn a_truss_without_sag_has_no_reactions() {
    for sag in [1e-1, 1e-2, 1e-3] {
        let study = truss(sag, "");
        for (joint, side) in [("A", 1.0), ("B", -1.0)] {
            let found = values(&study, joint);
            let number = |name: &str| {
                let own = found.iter().find(|(n, _)| *n == name).expect("a component");
                own.1.in_solution().expect("finite")
            };
            assert!((number("Fy") + GRAVITY).abs() < 1e-9 / sag, "{found:?}");
            let horizontal = side * GRAVITY / (2.0 * sag);
            assert!(
                (number("Fx") - horizontal).abs() < 1e-9 * horizontal.abs() / sag,
                "{sag}: {found:?} {horizontal}"
            );
        }
    }
    let study = truss(0.0, "");
    for joint in ["A", "middle", "B"] {
        for (name, value) in values(&study, joint) {
            let why = value.no_finite_reaction();
            let why = why.unwrap_or_else(|| panic!("{joint}.{name}: {value:?}"));
            assert!(why.decided && why.loads == ["gravity"], "{why:?}");
            assert!(why.freedom.contains("`left` turns about `A`"), "{why:?}");
        }
    }
}

/// A reaction without a connection to the truss keeps its value: `−m·g` on the ground.
#[test]
fn reactions_of_other_bodies_keep_their_numbers() {
    let found = values(&truss(0.0, ""), "hook");
    let (_, vertical) = found.iter().find(|(name, _)| *name == "Fy").expect("Fy");
    assert!((vertical.in_solution().expect("finite") + 3.0 * GRAVITY).abs() < 1e-12);
}

/// Springs that carry the bars leave no resultant load: 1 kg at 1/4 of the length of each side, and
/// the pins carry the remaining m·g/2 each.
#[test]
fn loads_that_cancel_do_not_push() {
    let forces = |share: f64| {
        let force = share * GRAVITY;
        format!(
            "force = [ {{ name = \"prop\", type = \"point-force\", body = \"left\", point = [0.5, 0.0], force = [0.0, {force}] }} ]"
        )
    };
    // Together both bars have the weight m·g/2 + m·g/2 on the middle.
    let (_, vertical) = &values(&truss(0.0, &forces(1.0)), "A")[1];
    assert!(
        (vertical.in_solution().expect("finite") + 0.5 * GRAVITY).abs() < 1e-9,
        "{vertical:?}"
    );
    let value = &values(&truss(0.0, &forces(0.9)), "A")[1].1;
    let why = value.no_finite_reaction();
    let why = why.unwrap_or_else(|| panic!("{value:?}"));
    assert_eq!(why.loads, ["gravity", "`prop`"]);
}

/// Three rods in the plane that meet at the centre of mass support it, and no moment acts on the
/// body about it. The load in this direction is a rounding error, for any direction of gravity, and
/// not a reason for an error.
#[test]
fn rods_that_meet_at_the_centre_of_mass_carry_it() {
    for gravity in [
        [0.0, 5.0],
        [1.8800935912111771, 5.761681116396184],
        [5.0, 1.0],
    ] {
        let scene = format!(
            r#"
scene = {{ name = "rods", space = "plane", gravity = {gravity:?} }}
body = [{{ name = "plate", mass = 1.0, inertia = 1.0, position = [1.0, -0.3333333333333333], angle = 3.141592653589793 }}]
joint = [
    {{ name = "left", type = "distance", bodies = ["ground", "plate"], at = [[-1.1428571428571428, -0.7619047619047619], [-1.8571428571428572, -0.9047619047619048]] }},
    {{ name = "below", type = "distance", bodies = ["ground", "plate"], at = [[1.0, -1.1904761904761905], [1.0, -0.047619047619047616]] }},
    {{ name = "right", type = "distance", bodies = ["ground", "plate"], points = {{ ground = [5.571428571428571, -4.904761904761905], plate = [-1.1428571428571428, 1.1428571428571428] }} }},
]
"#
        );
        let study = read(&scene);
        let start = study.analyse(0.0, None).expect("a start");
        let none = start.no_finite_reactions().expect("it is examined");
        assert!(none.is_empty(), "{gravity:?}: {none:?}");
    }
}

/// The run is rejected before its first row.
#[test]
fn a_run_of_an_impossible_motion_is_refused() {
    let study = truss(0.0, "");
    let mut rows = 0;
    let found = study.run(&MotionOptions::to(0.1), |_| {
        rows += 1;
        Ok(std::ops::ControlFlow::Continue(()))
    });
    let error = StudyError::from(found.expect_err("no motion").error);
    assert!(rows == 0 && error.is_input(), "{error}");
    assert_eq!(error.code().to_string(), "P0215", "{error}");
    let words = error.to_string();
    for part in [
        "no finite reaction exists",
        "gravity",
        "`left` turns about `A`",
    ] {
        assert!(words.contains(part), "{words}");
    }
}

/// A truss is on a rolling cart: whether the loads push along its sag follows from terms of higher
/// order, so the reactions have no value.
#[test]
fn bodies_that_move_are_undecided() {
    let study = read(
        r#"
scene = { name = "cart", space = "plane" }
body = [
  { name = "cart", mass = 1.0, inertia = 0.1, position = [1.0, -1.0], velocity = [1.0, 0.0] },
  { name = "left", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] },
  { name = "right", mass = 1.0, inertia = 0.1, position = [1.5, 0.0] },
]
joint = [
  { name = "rail", type = "translational", bodies = ["ground", "cart"], at = [1.0, -1.0], axis = [1.0, 0.0] },
  { name = "A", type = "revolute", bodies = ["cart", "left"], at = [0.0, 0.0] },
  { name = "middle", type = "revolute", bodies = ["left", "right"], at = [1.0, 0.0] },
  { name = "B", type = "revolute", bodies = ["cart", "right"], at = [2.0, 0.0] },
]
"#,
    );
    let found = values(&study, "A");
    let why = found[0].1.no_finite_reaction();
    let why = why.unwrap_or_else(|| panic!("{found:?}"));
    assert!(!why.decided, "{why:?}");
    assert!(
        study
            .run(&MotionOptions::to(1e-3), |_| Ok(
                std::ops::ControlFlow::Continue(())
            ))
            .is_ok()
    );
}

/// A bar between two rails has a locked left end: by a fixed joint, or by a drive at rest. A moving
/// drive moves the bar with it, and the other degree of freedom remains blocked.
#[test]
fn a_locked_drive_is_a_row_like_others() {
    let bar = |lock: &str, drive: &str, velocity: &str| {
        read(&format!(
            r#"
scene = {{ name = "bar", space = "plane" }}
body = [
  {{ name = "left", mass = 1.0, inertia = 0.1 }},
  {{ name = "right", mass = 1.0, inertia = 0.1, position = [1.0, 0.0]{velocity} }},
  {{ name = "bar", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] }},
]
joint = [
  {{ name = "left rail", bodies = ["ground", "left"], at = [0.0, 0.0], {lock} }},
  {{ name = "right rail", type = "translational", bodies = ["ground", "right"], at = [1.0, 0.0], axis = [0.0, 1.0] }},
  {{ name = "left pin", type = "revolute", bodies = ["left", "bar"], at = [0.0, 0.0] }},
  {{ name = "right pin", type = "revolute", bodies = ["right", "bar"], at = [1.0, 0.0] }},
]
{drive}
"#
        ))
    };
    let sliding = "type = \"translational\", axis = [0.0, 1.0]";
    let lock = |motion: &str| {
        format!(
            "drive = [ {{ name = \"lock\", joint = \"left rail\", type = \"displacement\", motion = {motion} }} ]"
        )
    };
    let moving = "{ type = \"constant-rate\", rate = 1.0 }";
    // A different velocity of the right end violates the second-order conditions, and no motion
    // begins.
    let along = ", velocity = [0.0, 1.0]";
    for (study, cannot_move, blocked) in [
        (bar("type = \"fixed\"", "", ""), Some(true), 1),
        (bar(sliding, &lock("0.0"), ""), Some(true), 1),
        (bar(sliding, "", ""), Some(false), 1),
        (bar(sliding, &lock(moving), along), None, 1),
    ] {
        let start = study.analyse(0.0, None).expect("a start");
        let found = start.freedoms().expect("its configuration");
        assert_eq!(
            (found.cannot_move, found.blocked.len()),
            (cannot_move, blocked),
            "{found:?}"
        );
        assert!(found.undecided.is_empty());
    }
}
