//! Contacts that grip: a ladder, a car in a curve, a wheel that is pushed in any direction.

use pfaff::solvability::{GripVerdict, Holds};

use super::supports::car;
use super::{assert_push, range, study};

/// Width of the bounds of a least coefficient of friction, relative, if the contacts slip in one
/// direction: a condition that is violated by less than 1e-9 of the loads is undecided.
const FRICTION: f64 = 2e-8;

/// Rounding error of a coefficient of friction, relative.
const ROUNDING: f64 = 1e-11;

/// Accuracy with which polygons enclose the circle of a contact that slips in two directions: the
/// cosine of half of 1/32 of a turn differs from 1 by 0.48 %.
const POLYGON: f64 = 0.005;

/// Angle of the ladder from the floor (rad), its length (m), the weight of the man (N).
const ANGLE: f64 = 65.0 * std::f64::consts::PI / 180.0;
const LENGTH: f64 = 4.0;
const WEIGHT: f64 = 800.0;

/// A ladder without weight on a floor and a wall, with a man at a share of its length. `wall` is
/// the friction of the wall; a smooth wall has none.
pub(super) fn ladder(share: f64, floor: f64, wall: Option<f64>) -> String {
    let (x, y) = (LENGTH * ANGLE.cos(), LENGTH * ANGLE.sin());
    let wall = wall.map_or_else(String::new, |grip| {
        format!(
            "{{ name = \"wall tread\", type = \"knife-edge\", body = \"ladder\", at = [0.0, {y:?}], normal = [0.0, 1.0], \
             grip = {grip:?}, load = \"wall\" }},\n"
        )
    });
    format!(
        "scene = {{ name = \"ladder\", space = \"plane\" }}\n\
         body = [{{ name = \"ladder\", mass = 1.0, inertia = 1.0, position = [{:?}, {:?}] }}]\n\
         force = [{{ name = \"man\", type = \"point-force\", body = \"ladder\", at = [{:?}, {:?}], force = [0.0, -{WEIGHT:?}] }}]\n\
         joint = [\n\
         {{ name = \"floor\", type = \"point-on-line\", body = \"ladder\", at = [{x:?}, 0.0], line = [[0.0, 0.0], [1.0, 0.0]], \
         one_sided = \"pushes\", toward = [0.0, 1.0] }},\n\
         {{ name = \"floor tread\", type = \"knife-edge\", body = \"ladder\", at = [{x:?}, 0.0], normal = [1.0, 0.0], \
         grip = {floor:?}, load = \"floor\" }},\n\
         {{ name = \"wall\", type = \"point-on-line\", body = \"ladder\", at = [0.0, {y:?}], line = [[0.0, 0.0], [0.0, 1.0]], \
         one_sided = \"pushes\", toward = [1.0, 0.0] }},\n{wall}]\n",
        0.5 * x,
        0.5 * y,
        x * (1.0 - share),
        y * share,
    )
}

/// Returns the verdict on all contacts that grip, which depend on each other.
fn grip(text: &str) -> GripVerdict {
    let study = study(text);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.permitted(solution).expect("clear").expect("contacts");
    let verdicts = found.grips().unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(verdicts.len(), 1, "{verdicts:?}\n{text}");
    verdicts[0].clone()
}

/// Asserts that the bounds of the least coefficient contain this one, and are close together.
#[track_caller]
fn assert_least(found: &GripVerdict, expected: f64) {
    let [lowest, highest] = found.least.expect("enough friction");
    assert!(highest - lowest <= FRICTION * highest, "{found:?}");
    let rounding = ROUNDING * expected;
    let contains = lowest <= expected + rounding && expected - rounding <= highest;
    assert!(contains, "{found:?}, expected {expected}");
}

#[test]
fn a_ladder_holds_with_the_friction_of_textbooks() {
    // With a smooth wall, the moment about the foot gives the push s·W/tan θ of the wall, which the
    // floor must hold with its push W.
    for (share, textbook) in [(0.5, 0.2332), (0.9, 0.4197)] {
        let expected = share / ANGLE.tan();
        assert!((expected - textbook).abs() < 5e-5);
        assert_least(&grip(&ladder(share, 1.0, None)), expected);
        let holds = |factor: f64| grip(&ladder(share, factor * expected, None)).holds;
        assert_eq!(holds(1.0 + 1e-6), Some(Holds::Always));
        assert_eq!(holds(1.0 - 1e-6), Some(Holds::Never));
    }
    // Without any friction the ladder slides unless the man stands on the floor.
    assert_eq!(grip(&ladder(0.5, 0.0, None)).holds, Some(Holds::Never));
}

/// With friction at both ends, the man can climb to s* = (μ_f·tan θ + μ_f·μ_w)/(1 + μ_f·μ_w).
#[test]
fn a_man_on_a_ladder_climbs_to_the_limit_of_both_frictions() {
    let (floor, wall) = (0.3, 0.2);
    let product = floor * wall;
    let limit = (floor * ANGLE.tan() + product) / (1.0 + product);
    assert!((limit - 0.663_540).abs() < 1e-6);
    let holds = |share: f64| grip(&ladder(share, floor, Some(wall))).holds;
    assert_eq!(holds(limit - 1e-7), Some(Holds::Sometimes));
    assert_eq!(holds(limit + 1e-7), Some(Holds::Never));
    // The least common coefficient solves the same equation for μ = μ_f = μ_w.
    for share in [0.3, 0.663_540, 0.9] {
        let t = ANGLE.tan();
        let expected = 2.0 * share / (t + (t * t + 4.0 * share * (1.0 - share)).sqrt());
        assert_least(&grip(&ladder(share, floor, Some(wall))), expected);
    }
}

/// The pushes of the floor and of the wall: the limits of the friction of the wall in both
/// directions. N_w·tan θ + S_w = s·W, N_f = W − S_w, |S_w| ≤ μ_w·N_w.
#[test]
fn friction_limits_the_pushes_of_a_ladder() {
    let (share, friction) = (0.9, 0.4);
    let text = ladder(share, 0.6, Some(friction));
    let study = study(&text);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.permitted(solution).expect("clear").expect("contacts");
    let of_wall = |sign: f64| share * WEIGHT / (ANGLE.tan() + sign * friction);
    let wall = [of_wall(1.0), of_wall(-1.0)];
    let floor = wall.map(|n| WEIGHT - share * WEIGHT + n * ANGLE.tan());
    let rounded = |pair: [f64; 2]| pair.map(|x| (10.0 * x).round() / 10.0);
    assert_eq!(
        (rounded(floor), rounded(wall)),
        ([686.8, 965.1], [283.0, 412.7])
    );
    // The ladder is the first body, so the reported reactions are the pushes.
    let push =
        |joint, component| range(&start, &found, &[(joint, component, -1.0)]).expect("clear");
    assert_push(&push("wall", "Fx"), wall, WEIGHT);
    assert_push(&push("floor", "Fy"), floor, WEIGHT);
    let treads = push("floor tread", "Fx");
    assert_push(&treads, [-wall[1], -wall[0]], WEIGHT);
    let both = range(
        &start,
        &found,
        &[("floor", "Fy", -1.0), ("wall tread", "Fy", -1.0)],
    );
    assert_push(&both.expect("unique"), [WEIGHT; 2], WEIGHT);
}

/// All wheels slip together at μ·m·g = m·a.
#[test]
fn a_car_holds_a_curve_with_the_friction_of_its_acceleration() {
    for (a, textbook) in [(3.0, 0.305_81), (6.0, 0.611_62), (9.0, 0.917_43)] {
        let expected = a / car::GRAVITY;
        assert!((expected - textbook).abs() < 5e-6);
        assert_least(&grip(&car::pushed(a, "0.5")), expected);
        // On a circle so large that the wheels are parallel to within 1e-12.
        assert_least(&grip(&car::turning(a, 1e6, "0.5")), expected);
        let holds = |friction: f64| grip(&car::pushed(a, &format!("{friction:?}"))).holds;
        assert_eq!(holds(expected * (1.0 - 1e-6)), Some(Holds::Never));
        assert_eq!(holds(expected * (1.0 + 1e-6)), Some(Holds::Sometimes));
    }
}

/// A body that does not turn, on a wheel (or a ball) that touches a plane, which may be inclined.
/// The force `[along, across, normal]` of the plane on it is given.
fn held(contact: &str, lean: f64, slope: f64, friction: f64, force: [f64; 3]) -> String {
    let (sin, cos) = slope.sin_cos();
    // The plane is turned about y: axes along, across, normal.
    let axes = [[cos, 0.0, -sin], [0.0, 1.0, 0.0], [sin, 0.0, cos]];
    let global = |x: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|k| x[k] * axes[k][i]).sum())
    };
    let axis = global([0.0, lean.cos(), lean.sin()]);
    let height = if contact == "wheel" {
        0.3 * lean.cos()
    } else {
        0.3
    };
    let more = if contact == "wheel" {
        format!(", axis = {axis:?}")
    } else {
        String::new()
    };
    format!(
        "scene = {{ name = \"held\", space = \"spatial\" }}\n\
         body = [{{ name = \"hub\", mass = 2.0, inertia = [1.0, 1.0, 1.0], position = {:?} }}]\n\
         force = [{{ name = \"load\", type = \"point-force\", body = \"hub\", point = [0.0, 0.0, 0.0], force = {:?} }}]\n\
         joint = [\n\
         {{ name = \"still\", type = \"orientation\", bodies = [\"ground\", \"hub\"] }},\n\
         {{ name = \"contact\", type = \"{contact}\", body = \"hub\", at = {:?}, radius = 0.3{more}, \
         plane = {{ point = [0.0, 0.0, 0.0], normal = {:?} }}, one_sided = \"pushes\", grip = {friction:?} }},\n]\n",
        global([0.0, 0.0, height]),
        global(force.map(|x| -x)),
        global([0.0, 0.0, height]),
        axes[2],
    )
}

#[test]
fn a_wheel_grips_in_all_directions() {
    let (normal, expected) = (50.0, 0.4);
    for (contact, lean, slope) in [
        ("wheel", 0.0, 0.0),
        ("wheel", 0.5, 0.0),
        ("wheel", -0.3, 0.7),
        ("ball", 0.0, 0.0),
        ("ball", 0.0, 0.4),
    ] {
        for k in 0..48 {
            // The directions of the sides and of the corners of both polygons are among them.
            let angle = std::f64::consts::TAU * f64::from(k) / 48.0;
            let [x, y] = [angle.cos(), angle.sin()].map(|x| x * expected * normal);
            let what = format!("{contact}, lean {lean}, slope {slope}, direction {angle}");
            let of = |friction: f64| grip(&held(contact, lean, slope, friction, [x, y, normal]));
            let found = of(expected);
            let [lowest, highest] = found.least.expect("enough friction");
            let slack = ROUNDING * expected;
            assert!(
                lowest <= expected + slack && expected - slack <= highest,
                "{what}: {found:?}"
            );
            assert!(highest - lowest <= POLYGON * highest, "{what}: {found:?}");
            assert_eq!(of(expected * 1.005).holds, Some(Holds::Always), "{what}");
            assert_eq!(of(expected * 0.995).holds, Some(Holds::Never), "{what}");
        }
    }
}

/// If the one-sided joints open, there is no verdict on the grip, and the grip does not hide which
/// joints open.
#[test]
fn grip_does_not_hide_a_support_that_lifts() {
    for friction in ["0.1", "5.0"] {
        let text = car::pushed(1.001 * car::tipping(), friction);
        let found = grip(&text);
        assert_eq!((found.holds, found.least), (None, None));
        let found = super::answers(&text, &[]);
        let names: Vec<&str> = found.lifts.iter().map(|(name, _)| &name[..]).collect();
        assert_eq!(names, ["front left", "rear left"], "{friction}: {found:?}");
        assert!(
            found
                .impossible
                .iter()
                .any(pfaff::solvability::Impossible::is_opening),
            "{friction}: {found:?}"
        );
    }
}
