//! Generated scenes of small sizes, read and analysed: counts, ranks, and every verdict with its
//! directions equal those that the generator states.

use std::collections::BTreeMap;

use dynamics::{MotionOptions, simulate};
use model::{Mechanism, Registry, System};
use pfaff::Study;
use pfaff::scene::Scene;
use solvability::{ReactionVerdict, analyse};
use suite::generate::{Answer, Free, Kind, Order, n_four_bar};

pub(crate) fn text(order: &Order) -> String {
    let mut out = Vec::new();
    let generator = order.generate().expect("a possible order");
    generator.write(&mut out).expect("memory takes everything");
    String::from_utf8(out).expect("UTF-8")
}

pub(crate) fn read(text: &str) -> Scene {
    pfaff::scene::read("generated.toml", text, &Registry::standard())
        .unwrap_or_else(|problems| panic!("{}", problems[0]))
}

/// Compares all known results at the start with an analysis.
fn check(order: &Order) {
    let scene = read(&text(order));
    let mechanism = Mechanism::build(&scene.description).expect("what is read can be built");
    let (q, _) = mechanism.described_state();
    let analysis = analyse(&mechanism, 0.0, &q).expect("C is finite");
    let generator = order.generate().expect("a possible order");
    let d = &scene.description;
    let found = Answer {
        bodies: analysis.bodies,
        joints: d.joints().count(),
        drives: d.drives().count(),
        rows: mechanism.layout().rows(),
        rank: analysis.decision.rank,
        redundancy: analysis.decision.redundancy,
        mobility: analysis.mobility(),
    };
    assert_eq!(found, generator.answer(), "{order:?}");
    let free: BTreeMap<String, Free> = generator
        .free_reactions()
        .into_iter()
        .map(|reaction| (reaction.name, reaction.free))
        .collect();
    for reaction in &analysis.reactions {
        compare(reaction, free.get(&reaction.name), order);
    }
}

/// Rounding of directions that come from points with coordinates of size ten.
const ROUNDING: f64 = 1e-9;

fn compare(reaction: &ReactionVerdict, free: Option<&Free>, order: &Order) {
    let context = || format!("{} of {order:?}: {reaction:?}, {free:?}", reaction.name);
    let verdict = reaction.wrench.verdict.word();
    let unique = &reaction.unique_directions;
    let Some(free) = free else {
        assert_eq!(verdict, "unique", "{}", context());
        return;
    };
    assert_eq!(verdict, "not_unique", "{}", context());
    // Along any determined direction the free part has no component.
    let across = |[x, y]: [f64; 2]| {
        assert_eq!(unique.len(), 1, "{}", context());
        let along = unique[0][0] * x + unique[0][1] * y;
        assert!(along.abs() < ROUNDING, "{}", context());
    };
    match *free {
        Free::Force => assert!(unique.is_empty(), "{}", context()),
        Free::Along(direction) => across(direction),
        Free::AlongAndTorque(direction) => {
            across(direction);
            assert!(
                unique[0].get(2).is_none_or(|t| t.abs() < ROUNDING),
                "{}",
                context()
            );
        }
    }
}

#[test]
fn every_family_has_the_answer_that_it_states() {
    for &kind in Kind::ALL {
        for n in 1..=5 {
            check(&Order::of(kind, n));
        }
    }
}

#[test]
fn shares_and_seeds() {
    for share in [0.0, 0.5, 1.0] {
        for (kind, n) in [(Kind::Parallelograms, 6), (Kind::Lattice, 6)] {
            let redundant = Some(share);
            check(&Order {
                redundant,
                ..Order::of(kind, n)
            });
        }
    }
    for seed in 0..12 {
        let (seed, redundant) = (Some(seed), Some(0.6));
        check(&Order {
            seed,
            redundant,
            ..Order::of(Kind::Random, 16)
        });
        check(&Order {
            seed,
            ..Order::of(Kind::Parallelograms, 7)
        });
    }
}

/// The case of the suite and the generator describe the same mechanism.
#[test]
fn two_loops_are_the_case_of_the_suite() {
    let case = suite::find("n-four-bar").expect("the case exists");
    let (case, generated) = (read(case.scene), read(&text(&Order::of(Kind::NFourBar, 2))));
    let [case, generated] = [&case, &generated].map(|scene| scene.description.plane());
    let (case, generated) = (case.expect("planar"), generated.expect("planar"));
    assert_eq!(case.bodies, generated.bodies);
    assert_eq!(case.gravity, generated.gravity);
    let joints = |d: &model::Description| -> Vec<_> {
        d.joints
            .iter()
            .map(|j| (j.name.clone(), j.bodies.clone()))
            .collect()
    };
    assert_eq!(joints(case), joints(generated));
}

/// Integrates the equation for the angle θ over a time, by the classical Runge–Kutta method with
/// steps of 0.1 ms: its error is below 1e-13.
pub(crate) fn angle(n: usize, t: f64) -> f64 {
    let steps = (t / 1e-4).round() as usize;
    let h = t / steps as f64;
    let f = |[theta, omega]: [f64; 2]| [omega, n_four_bar::acceleration(n, theta)];
    let along = |y: [f64; 2], h: f64, k: [f64; 2]| [y[0] + h * k[0], y[1] + h * k[1]];
    let mut y = [0.0, 1.0];
    for _ in 0..steps {
        let a = f(y);
        let b = f(along(y, h / 2.0, a));
        let c = f(along(y, h / 2.0, b));
        let d = f(along(y, h, c));
        y = std::array::from_fn(|k| y[k] + h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]));
    }
    y[0]
}

#[test]
fn loops_move_as_one_angle_does() {
    for n in [1, 3] {
        let (registry, overrides) = (Registry::standard(), pfaff::RunOptions::default());
        let scene = text(&Order::of(Kind::NFourBar, n));
        let study = Study::read("generated.toml", &scene, &registry, &overrides).expect("starts");
        assert!(
            study
                .prepared
                .assembly
                .correction
                .iter()
                .all(|x| x.abs() < 1e-15)
        );
        assert!(
            study
                .prepared
                .velocity_correction
                .iter()
                .all(|x| x.abs() < 1e-15)
        );
        let mut last = Vec::new();
        let options = MotionOptions {
            rtol: 1e-12,
            atol: 1e-13,
            ..MotionOptions::to(0.5)
        };
        simulate(&study.prepared, &options, |sample| {
            last = sample.q.to_vec();
            Ok(std::ops::ControlFlow::Continue(()))
        })
        .unwrap_or_else(|failure| panic!("{}", failure.error));
        let expected = angle(n, 0.5);
        for upright in 0..=n {
            let theta = std::f64::consts::FRAC_PI_2 - last[3 * upright + 2];
            assert!(
                (theta - expected).abs() < 1e-10,
                "{upright} of {n}: {theta}, {expected}"
            );
        }
    }
}

/// The robots of a fleet move like the single robot: the springs between them remain unstressed.
#[test]
fn a_fleet_moves_as_its_robot() {
    let last = |scene: &str| {
        let (registry, overrides) = (Registry::standard(), pfaff::RunOptions::default());
        let study = Study::read("generated.toml", scene, &registry, &overrides).expect("starts");
        let mut last = Vec::new();
        simulate(&study.prepared, &MotionOptions::to(2.5), |sample| {
            last = sample.q.to_vec();
            Ok(std::ops::ControlFlow::Continue(()))
        })
        .unwrap_or_else(|failure| panic!("{}", failure.error));
        last
    };
    let robot = last(suite::find("robot-trolley").expect("the case exists").scene);
    let fleet = last(&text(&Order::of(Kind::Fleet, 2)));
    for (k, q) in fleet.iter().enumerate() {
        let y_0 = if k >= 21 && k % 3 == 1 { 1.5 } else { 0.0 };
        assert!((q - y_0 - robot[k % 21]).abs() < 1e-6, "coordinate {k}");
    }
}
