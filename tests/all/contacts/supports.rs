//! Ranges of pushes, and the supports that lift: a table, and a car in a curve.

use pfaff::solvability::RangeKind;

use super::{Answers, answers, assert_push, ends, near};

/// Mass of the table (kg), its moment of inertia about x (kg·m²) and gravity (m/s²).
const MASS: f64 = 12.0;
const INERTIA: f64 = 1.0;
const GRAVITY: f64 = 9.81;

const LEGS: [(&str, [f64; 2]); 4] = [
    ("A", [0.6, 0.4]),
    ("B", [-0.6, 0.4]),
    ("C", [-0.6, -0.4]),
    ("D", [0.6, -0.4]),
];

/// A table on four legs that only push, with its mass centre at these coordinates.
pub(super) fn table(centre: [f64; 2]) -> String {
    let [x, y] = centre;
    let leg = |(name, [x, y]): &(&str, [f64; 2])| {
        format!(
            "{{ name = \"{name}\", type = \"point-on-plane\", bodies = [\"ground\", \"top\"], at = [{x:?}, {y:?}, 0.0], \
             normal = [0, 0, 1], one_sided = \"pushes\" }},\n"
        )
    };
    format!(
        "scene = {{ name = \"table\", space = \"spatial\", gravity = [0.0, 0.0, -{GRAVITY}] }}\n\
         body = [{{ name = \"top\", mass = {MASS:?}, inertia = [{INERTIA:?}, 1.0, 2.0], position = [{x:?}, {y:?}, 0.7] }}]\n\
         joint = [\n{}]\n",
        LEGS.iter().map(leg).collect::<String>()
    )
}

fn of_table(centre: [f64; 2]) -> Answers {
    answers(&table(centre), &LEGS.map(|(name, _)| (name, "Fz")))
}

/// The four tables on three legs, by hand; each leg presses.
#[test]
fn a_table_presses_on_each_leg_within_limits() {
    let found = of_table([0.2, 0.1]);
    let expected = [
        [34.335, 73.575],
        [0.0, 39.24],
        [0.0, 39.24],
        [4.905, 44.145],
    ];
    for (range, expected) in found.ranges.iter().zip(expected) {
        assert_eq!(range.kind, RangeKind::Interval);
        assert_push(range, expected, MASS * GRAVITY);
    }
    assert!(found.impossible.is_empty() && found.lifts.is_empty());
}

/// Above a leg or an edge the pushes have one value, although one load component is undetermined.
#[test]
fn loads_above_a_leg_or_an_edge_are_unique_by_their_signs() {
    let weight = MASS * GRAVITY;
    let cases = [
        ([0.6, 0.4], [weight, 0.0, 0.0, 0.0]),
        // The lever of the edge AB: the load is 0.9 m from B and 0.3 m from A.
        ([0.3, 0.4], [0.75 * weight, 0.25 * weight, 0.0, 0.0]),
        ([-0.6, 0.1], [0.0, 0.625 * weight, 0.375 * weight, 0.0]),
    ];
    for (centre, expected) in cases {
        let found = of_table(centre);
        for (range, expected) in found.ranges.iter().zip(expected) {
            assert_eq!(range.kind, RangeKind::Point, "{centre:?}");
            assert_push(range, [expected; 2], weight);
        }
        assert!(found.lifts.is_empty());
    }
}

/// A load beyond the edge AB lets C and D lift. The table turns about AB: with the distance d of
/// the mass centre from AB, α = m·g·d/(I + m·d²), and its mass centre falls with α·d.
#[test]
fn a_load_beyond_the_edge_lifts_two_legs() {
    for (d, depth) in [(0.1, 0.8), (0.001, 0.8), (2.0, 0.8)] {
        let found = of_table([0.3, 0.4 + d]);
        for range in &found.ranges {
            assert_eq!((range.kind, ends(range)), (RangeKind::Empty, [None; 2]));
        }
        let alpha = MASS * GRAVITY * d / (INERTIA + MASS * d * d);
        let names: Vec<&str> = found.lifts.iter().map(|(name, _)| &name[..]).collect();
        assert_eq!(names, ["C", "D"]);
        for (name, gap) in &found.lifts {
            assert!(near(*gap, depth * alpha, alpha), "{name}: {gap}, {alpha}");
        }
        // The edge AB is at y = 0.4 + 0 and the mass centre beyond it falls: ω_x is negative.
        let expected = [0.0, 0.0, -alpha * d, -alpha, 0.0, 0.0];
        // The table slides so that its legs A and B do not: its mass centre is 0.7 m above the
        // floor.
        for (k, (found, expected)) in found.accelerations.iter().zip(expected).enumerate() {
            assert!(
                near(*found, expected, alpha.max(GRAVITY)),
                "{k}: {found} {expected}"
            );
        }
        if d == 0.1 {
            assert!((alpha - 10.510_714).abs() < 1e-6 && (alpha * d - 1.051_071).abs() < 1e-6);
        }
        let [impossible] = &found.impossible[..] else {
            panic!("{:?}", found.impossible);
        };
        // The motion: rates of the gaps in proportion to the distance from AB.
        assert!(impossible.is_opening());
        let weights: Vec<f64> = impossible.weights.iter().map(|(_, w)| *w).collect();
        assert!(impossible.sum < 0.0 && (weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}

/// Car of 1200 kg with axles at ±1.3 m and wheels at ±0.75 m, its mass centre 0.55 m above the
/// road.
pub(super) mod car {
    /// Mass (kg), half of the wheel base, half of the track, height of the mass centre (m), gravity
    /// (m/s²).
    pub(crate) const MASS: f64 = 1200.0;
    pub(crate) const BASE: f64 = 1.3;
    pub(crate) const TRACK: f64 = 0.75;
    pub(crate) const HEIGHT: f64 = 0.55;
    pub(crate) const GRAVITY: f64 = 9.81;

    /// The wheels, with the inner side of a curve to the left on positive y.
    pub(crate) const WHEELS: [(&str, [f64; 2]); 4] = [
        ("front left", [BASE, TRACK]),
        ("front right", [BASE, -TRACK]),
        ("rear left", [-BASE, TRACK]),
        ("rear right", [-BASE, -TRACK]),
    ];

    /// Lateral acceleration at which the inner wheels lift (m/s²): half of the weight is on each
    /// side at rest, and m·a·h moves from the inner to the outer side over the track.
    pub(crate) fn tipping() -> f64 {
        GRAVITY * TRACK / HEIGHT
    }

    fn joints(normal: impl Fn([f64; 2]) -> [f64; 2], grip: &str) -> String {
        let one = |(name, at): &(&str, [f64; 2])| {
            let ([x, y], [nx, ny]) = (*at, normal(*at));
            format!(
                "{{ name = \"{name}\", type = \"point-on-plane\", bodies = [\"ground\", \"car\"], at = [{x:?}, {y:?}, 0.0], \
                 normal = [0, 0, 1], one_sided = \"pushes\" }},\n\
                 {{ name = \"{name} tread\", type = \"knife-edge\", body = \"car\", at = [{x:?}, {y:?}, 0.0], \
                 normal = [{nx:?}, {ny:?}, 0.0]{} }},\n",
                if grip.is_empty() {
                    String::new()
                } else {
                    format!(", grip = {grip}, load = \"{name}\"")
                }
            )
        };
        WHEELS.iter().map(one).collect()
    }

    fn body(more: &str) -> String {
        format!(
            "scene = {{ name = \"car\", space = \"spatial\", gravity = [0.0, 0.0, -{GRAVITY:?}] }}\n\
             body = [{{ name = \"car\", mass = {MASS:?}, inertia = [400.0, 1600.0, 1800.0], position = [0.0, 0.0, {HEIGHT:?}]{more} }}]\n"
        )
    }

    /// The car at rest under the inertia force of a lateral acceleration.
    pub(crate) fn pushed(a: f64, grip: &str) -> String {
        format!(
            "{}force = [{{ name = \"inertia\", type = \"point-force\", body = \"car\", point = [0.0, 0.0, 0.0], \
             force = [0.0, {:?}, 0.0] }}]\njoint = [\n{}]\n",
            body(""),
            -MASS * a,
            joints(|_| [0.0, 1.0], grip)
        )
    }

    /// The car in a curve to the left about (0, radius): all wheels are steered.
    pub(crate) fn turning(a: f64, radius: f64, grip: &str) -> String {
        let v = (a * radius).sqrt();
        let motion = format!(
            ", velocity = [{v:?}, 0.0, 0.0], angular_velocity = [0.0, 0.0, {:?}]",
            v / radius
        );
        format!(
            "{}joint = [\n{}]\n",
            body(&motion),
            joints(|[x, y]| [-x, radius - y], grip)
        )
    }
}

/// The inner wheels together carry m·g/2·(1 − a/a_t) of the car, and each of them all or nothing of
/// it. Beyond the limit a_t both lift.
#[test]
fn inner_wheels_of_a_car_lift_at_the_limit_of_the_curve() {
    let limit = car::tipping();
    let inner = [("front left", "Fz"), ("rear left", "Fz")];
    let scenes: [fn(f64) -> String; 3] = [
        |a| car::pushed(a, ""),
        |a| car::turning(a, 20.0, ""),
        |a| car::turning(a, 30.0, "2.0"),
    ];
    for (what, scene) in scenes.iter().enumerate() {
        let found = answers(&scene(0.999 * limit), &inner);
        let most = 0.5 * car::MASS * car::GRAVITY * 0.001;
        assert!((most - 5.886).abs() < 1e-9);
        for range in &found.ranges {
            assert_push(range, [0.0, most], car::MASS * car::GRAVITY);
        }
        let found = answers(&scene(1.001 * limit), &inner);
        assert!(
            found
                .ranges
                .iter()
                .all(|range| range.kind == RangeKind::Empty),
            "{what}"
        );
        let names: Vec<&str> = found.lifts.iter().map(|(name, _)| &name[..]).collect();
        assert_eq!(names, ["front left", "rear left"], "{what}: {found:?}");
        assert!(
            found
                .impossible
                .iter()
                .all(pfaff::solvability::Impossible::is_opening),
            "{what}"
        );
    }
}
