//! Motions within a stated tolerance: rows that are redundant only within it are treated as
//! dependent, and their violations are a result. References are closed forms on the same
//! independent rows.

use dynamics::{MotionError, MotionFault};
use model::Registry;
use pfaff::documents::MisfitDocument;
use pfaff::documents::RunDocument;
use pfaff::{RunOptions, Study, StudyError};

/// Length of the cranks, and the offset of the third pin of the coupler (m).
const LENGTH: f64 = 0.4;
const OFF: f64 = 4e-4;

/// A mean angle of the cranks, the amplitude of the motor (rad), and its frequency (rad/s): θ =
/// MEAN − SWING·sin(RATE·t).
const MEAN: f64 = 1.1;
const SWING: f64 = 0.5;
const RATE: f64 = 2.0;

/// Three parallel cranks have the given lines for `[scene]`. Rows 1–12 belong to the joints A, B, C
/// on the ground and A2, B2, C2 on the coupler, and row 13 belongs to a motor on A.
fn cranks(stated: &str, motor: bool) -> String {
    let (sin, cos) = MEAN.sin_cos();
    let mut text =
        format!("[scene]\nname = \"cranks\"\nspace = \"plane\"\ngravity = [0, -9.81]\n{stated}\n");
    for (name, x) in [("a", 0.0), ("b", 0.5), ("c", 1.0)] {
        let centre = [x + 0.5 * LENGTH * cos, 0.5 * LENGTH * sin];
        text += &format!(
            "[[body]]\nname = \"{name}\"\nmass = 1.0\ninertia = 0.02\nposition = {centre:?}\nangle = {MEAN}\n"
        );
    }
    text += &format!(
        "[[body]]\nname = \"coupler\"\nmass = 3.0\ninertia = 0.3\nposition = {:?}\n",
        [LENGTH * cos, LENGTH * sin]
    );
    let half = 0.5 * LENGTH;
    for (name, body, x) in [("A", "a", 0.0), ("B", "b", 0.5), ("C", "c", 1.0)] {
        text += &format!(
            "[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = [\"ground\", \"{body}\"]\n\
             points = {{ ground = [{x:?}, 0.0], {body} = [{:?}, 0.0] }}\n",
            -half
        );
    }
    for (name, body, x) in [("A2", "a", 0.0), ("B2", "b", 0.5), ("C2", "c", 1.0 + OFF)] {
        text += &format!(
            "[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = [\"{body}\", \"coupler\"]\n\
             points = {{ {body} = [{half:?}, 0.0], coupler = [{x:?}, 0.0] }}\n"
        );
    }
    if motor {
        text += &format!(
            "[[drive]]\nname = \"motor\"\njoint = \"A\"\ntype = \"angle\"\n\
             motion = {{ type = \"harmonic\", amplitude = {:?}, omega = {RATE:?}, phase = 0.0, offset = 0.0 }}\n",
            -SWING
        );
    }
    text + "[start]\nkeep = [\"a.angle\"]\nallow_correction = true\n[simulate]\nt_end = 1.5\nrtol = 1e-9\natol = 1e-11\n"
}

/// A run on the rows that remain without the given ones, counted from 1.
fn run(text: &str, drop: Option<&[usize]>) -> Result<RunDocument, StudyError> {
    let overrides = RunOptions {
        drop: drop.map(|rows| rows.iter().map(|row| row - 1).collect()),
        ..RunOptions::default()
    };
    let study = Study::read("misfits.toml", text, &Registry::standard(), &overrides)?;
    let options = study.options.clone().expect("the scene says when it ends");
    Ok(study.motion(&options)?.summary)
}

fn only(run: &RunDocument) -> &MisfitDocument {
    let [misfit] = run.misfits.as_slice() else {
        panic!("one misfit: {:?}", run.misfits);
    };
    misfit
}

/// Without C2.x the third crank follows the height of its pin, so that it is parallel to the
/// others. The distance of the pins then equals the offset of one pin at all times.
#[test]
fn a_pin_misses_by_what_it_is_off() {
    let run = run(&cranks("tolerance = 1e-3", true), Some(&[11])).expect("runs");
    let misfit = only(&run);
    assert_eq!(
        (misfit.row, misfit.joint.as_str(), misfit.unit),
        (11, "C2", "m")
    );
    assert!((misfit.largest - OFF).abs() < 1e-9, "{misfit:?}");
    assert_eq!(misfit.time, 0.0);
    assert!(misfit.largest < misfit.bound, "{misfit:?}");
}

/// Without C2.y the third crank follows `L·cos φ = L·cos θ + off`. The distance of the pins is
/// `L·(sin θ − sin φ)`; it is largest for the smallest θ, at `sin(RATE·t)` = 1, which is between
/// two steps.
#[test]
fn the_largest_misfit_and_its_time_are_those_of_the_closed_form() {
    let run = run(&cranks("tolerance = 1e-3", true), Some(&[12])).expect("runs");
    let misfit = only(&run);
    let theta = MEAN - SWING;
    let phi = (theta.cos() + OFF / LENGTH).acos();
    let expected = LENGTH * (theta.sin() - phi.sin());
    assert_eq!((misfit.row, misfit.component.as_str()), (12, "y"));
    assert!(
        (misfit.largest / expected - 1.0).abs() < 1e-3,
        "{misfit:?}, not {expected}"
    );
    let time = 0.5 * std::f64::consts::PI / RATE;
    assert!((misfit.time - time).abs() < 0.02, "{misfit:?}, not {time}");
    assert!(run.energy_balance < 1e-7, "{}", run.energy_balance);
}

/// The other choice keeps C2.y and releases the height of the pin of the second crank. The coupler
/// tilts about the pin of the first crank, by the violation of C2.y divided by their distance.
#[test]
fn two_choices_differ_by_what_rows_miss() {
    let run = run(&cranks("tolerance = 1e-3", true), Some(&[12])).expect("runs");
    let spread = run.spread.as_ref().expect("a row misses");
    assert_eq!(
        (spread.deleted_rows.as_slice(), &spread.error),
        (&[10][..], &None)
    );
    let tilt = only(&run).largest / (1.0 + OFF);
    assert!(
        (spread.angle / tilt - 1.0).abs() < 1e-2,
        "{spread:?}, not {tilt}"
    );
}

/// A slider on a line has a rod of length 1 across it: for short displacements the rod is redundant
/// within two hundredths. A motor moves it by x. The rod is violated by x²/2 and its velocities by
/// x·ẋ. The run stops with an error when data within the tolerance no longer explain these
/// violations. Both bounds are about 3·0.02·3.2, so that the velocities reach their bound first.
#[test]
fn beyond_the_tolerance_a_run_stops_by_name() {
    let slider = r#"
        scene = { name = "slider", space = "plane", tolerance = 0.02 }
        body = [{ name = "slider", mass = 1.0, inertia = 0.1 }]
        drive = [{ name = "push", joint = "line", type = "displacement", motion = { type = "constant-rate", rate = 1.0 } }]
        simulate = { t_end = 4.0 }
        [[joint]]
        name = "line"
        type = "translational"
        bodies = ["ground", "slider"]
        at = [0.0, 0.0]
        axis = [1.0, 0.0]
        [[joint]]
        name = "rod"
        type = "distance"
        bodies = ["ground", "slider"]
        at = [[0.0, -1.0], [0.0, 0.0]]
        "#;
    let error = run(slider, Some(&[3])).expect_err("it stops");
    let StudyError::Motion(MotionError::Fault(MotionFault::BeyondTolerance {
        time,
        level,
        residual,
        bound,
        ref row,
        ..
    })) = error
    else {
        panic!("beyond the tolerance: {error}");
    };
    assert_eq!((row.number, level), (3, "velocity"));
    assert!(residual > bound && residual < 1.01 * bound, "{error}");
    assert!((residual / time - 1.0).abs() < 1e-9, "{error}");
    assert!(
        error
            .to_string()
            .contains("`slider` turned by 0.0° and moved by"),
        "{error}"
    );
}

/// Cranks swing freely: gravity rotates them, so that velocities and accelerations of redundant
/// rows also differ by amounts that the data explain.
#[test]
fn free_cranks_move_within_their_tolerance() {
    let text = cranks("tolerance = 1e-3", false)
        .replace("name = \"a\"\n", "name = \"a\"\nangular_velocity = 2.0\n")
        .replace("t_end = 1.5", "t_end = 0.3");
    let run = run(&text, None).expect("runs");
    assert!(only(&run).largest > 0.1 * OFF, "{:?}", run.misfits);
    assert!(run.energy_balance < 1e-7, "{}", run.energy_balance);
}

/// A leaf has two hinges at one point of the leaf, which are half a millimetre apart in the ground.
#[test]
fn a_door_on_two_hinges_misses_by_their_distance() {
    let door = r#"
        scene = { name = "door", space = "plane", tolerance = 1e-3 }
        body = [{ name = "leaf", mass = 20.0, inertia = 5.0, position = [0.5, 0.0] }]
        drive = [{ name = "push", joint = "top", type = "angle", motion = { type = "constant-rate", rate = 1.0 } }]
        simulate = { t_end = 2.0 }
        [[joint]]
        name = "top"
        type = "revolute"
        bodies = ["ground", "leaf"]
        at = [0.0, 0.0]
        [[joint]]
        name = "bottom"
        type = "revolute"
        bodies = ["ground", "leaf"]
        points = { ground = [0.0005, 0.0], leaf = [-0.5, 0.0] }
        "#;
    let run = run(door, None).expect("runs");
    let misfit = only(&run);
    assert_eq!((misfit.unit, misfit.time), ("m", 0.0));
    assert!((misfit.largest - 5e-4).abs() < 1e-12, "{misfit:?}");
    // The other choice fixes the leaf at the other hinge.
    let spread = run.spread.as_ref().expect("a row misses");
    assert!(
        (spread.position - 5e-4).abs() < 1e-9 && spread.angle < 1e-9,
        "{spread:?}"
    );
}

/// A stated tolerance has no effect if rows are exactly redundant.
#[test]
fn rows_that_are_redundant_exactly_miss_nothing() {
    let exact = |stated: &str| cranks(stated, true).replace("[1.0004, 0.0]", "[1.0, 0.0]");
    let stated = run(&exact("tolerance = 1e-3"), None).expect("runs");
    assert_eq!(
        (stated.misfits.as_slice(), &stated.spread),
        (&[][..], &None)
    );
    let silent = run(&exact(""), None).expect("runs");
    assert_eq!(
        (stated.steps, stated.evaluations),
        (silent.steps, silent.evaluations)
    );
}
