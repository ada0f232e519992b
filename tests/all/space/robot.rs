//! Compares the robot with its trolley in space, on wheels that turn, with references: its ranks
//! and verdicts with independently written constraints ([`oracle`]), and its motion with the motion
//! of the robot in the plane.

mod oracle;

use std::fmt::Write;
use std::ops::ControlFlow;

use dynamics::MotionOptions;
use joints::space3::Pose;
use model::{ConstraintId, Registry, System};
use oracle::{Answer, Pins, answer, idle_loads};
use pfaff::{RunOptions, Study};
use solvability::{Analysis, Choice, Compliance, NormWeights, analyse};
use suite::Quantity;
use tests::largest;

use crate::examples;

/// Reactions of the published model and of the wheels that are not unique.
const NOT_UNIQUE: [&str; 10] = [
    "B", "C", "W1", "W2", "W3", "W4", "hub-1", "hub-2", "hub-3", "hub-4",
];

/// Components of reactions.
const NAMES: [&str; 6] = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];

/// The bodies that also exist in the plane.
const BODIES: [&str; 7] = [
    "platform",
    "front-knuckle",
    "rear-knuckle",
    "front-link",
    "rear-link",
    "slider",
    "trolley",
];

/// Mass, spin inertia, moment about a diameter, and radius of each wheel.
const WHEEL: [f64; 4] = [0.5, 0.0008, 0.0004, 0.08];

fn scene() -> String {
    examples::read(&examples::scene("robot-in-space"))
}

fn study(text: &str) -> Study {
    let registry = Registry::standard();
    let study = Study::read("robot.toml", text, &registry, &RunOptions::default());
    study.unwrap_or_else(|e| panic!("{e}"))
}

/// Returns times and configurations of a run, 201 rows.
fn moved(study: &Study) -> Vec<(f64, Vec<f64>)> {
    let options = MotionOptions {
        rtol: 1e-12,
        atol: 1e-12,
        output_step: 0.05,
        ..MotionOptions::to(10.0)
    };
    let mut rows = Vec::new();
    let run = study.run(&options, |sample| {
        rows.push((sample.t, sample.q.to_vec()));
        Ok(ControlFlow::Continue(()))
    });
    run.unwrap_or_else(|e| panic!("{}", e.error));
    assert_eq!(rows.len(), 201);
    rows
}

/// Returns x, y and angle of the bodies of the plane, in a motion in space in which they remain
/// horizontal.
fn level(q: &[f64]) -> Vec<f64> {
    let bodies = q.chunks_exact(7).take(BODIES.len());
    let body = |q: &[f64]| {
        let pose = Pose::new([q[0], q[1], q[2]], [q[3], q[4], q[5], q[6]]);
        let [x, y, z] = pose.direction_to_global([1.0, 0.0, 0.0]);
        assert!(z.abs() < 1e-12, "level: {z:e}");
        [q[0], q[1], y.atan2(x)]
    };
    bodies.flat_map(body).collect()
}

/// Returns the difference of two entries of such lists; angles differ by less than a revolution.
fn gap(k: usize, a: f64, b: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    match k % 3 {
        2 => (a - b) - turn * ((a - b) / turn).round(),
        _ => a - b,
    }
}

/// Returns the largest difference of two lists.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(b).enumerate();
    largest(pairs.map(|(k, (a, b))| gap(k, *a, *b)))
}

/// Returns the scene with hinges instead of balls and crosses.
fn all_pins_are_hinges() -> String {
    let mut text = String::new();
    for line in scene().lines() {
        let pin = ["A", "D", "E", "F", "G"].map(|name| format!("{{ name = \"{name}\", type"));
        let start = pin.iter().find(|pin| line.contains(*pin));
        let Some(start) = start else {
            writeln!(text, "{line}").expect("a string");
            continue;
        };
        let from = line.find("bodies").expect("two bodies");
        let at = line.find("at = [").expect("a place");
        let to = at + line[at..].find(']').expect("its end");
        let place = &line[from..=to];
        writeln!(
            text,
            "{start} = \"revolute\", {place}, axis = [0, 0, 1] }},"
        )
        .expect("a string");
    }
    text
}

fn assert_same(found: &Analysis, expected: &Answer, t: f64) {
    let ranks = [
        found.rank_holonomic,
        found.rank_nonholonomic,
        found.decision.rank,
    ];
    assert!(found.decision.is_decided(), "{t}");
    assert_eq!(ranks, expected.ranks, "{t}");
    assert_eq!(
        found.decision.redundancy,
        expected.rows - expected.ranks[2],
        "{t}"
    );
    assert_eq!(found.reactions.len(), expected.reactions.len());
    for (name, unique) in &expected.reactions {
        let reaction = found.reactions.iter().find(|r| r.name == *name);
        let reaction = reaction.unwrap_or_else(|| panic!("no `{name}`"));
        let word = |is_unique| if is_unique { "unique" } else { "not_unique" };
        let whole = unique.iter().all(|u| *u);
        assert_eq!(
            reaction.wrench.verdict.word(),
            word(whole),
            "{name} at t = {t}"
        );
        for (component, unique) in NAMES.iter().zip(unique) {
            // A component that is zero under any load is not in the list of components.
            let own = reaction.components.iter().find(|c| c.name == *component);
            let own = own.map_or("unique", |c| c.judgement.verdict.word());
            assert_eq!(own, word(*unique), "{name}.{component} at t = {t}");
        }
    }
}

/// Returns the verdicts at every row of the run.
fn verdicts_along_the_motion(study: &Study, pins: Pins) -> Vec<Answer> {
    let mechanism = &study.prepared.mechanism;
    moved(study)
        .iter()
        .map(|(t, q)| {
            let expected = answer(q, pins);
            let found = analyse(mechanism, *t, q).unwrap_or_else(|e| panic!("{e}"));
            assert_same(&found, &expected, *t);
            assert_eq!(found.mobility(), 1);
            expected
        })
        .collect()
}

/// The result is the in-plane result of the publication, with three further redundant rows: two of
/// side forces, and one of the four wheels under the platform. The trolley is supported by its
/// wheel and its hitch.
#[test]
fn ranks_and_verdicts_along_the_motion_are_those_of_constraints_written_apart() {
    for answer in verdicts_along_the_motion(&study(&scene()), Pins::Drawn) {
        assert_eq!((answer.rows, answer.ranks), (74, [63, 10, 71]));
        for (name, unique) in &answer.reactions {
            let is_open = NOT_UNIQUE.contains(name);
            assert_eq!(!unique.iter().all(|u| *u), is_open, "{name}");
        }
    }
}

/// Each of two loops of hinges with parallel axes has three redundant rows, and the trolley pushes
/// with its wheel against the ground of the platform: 2 + 2·3 + 2.
#[test]
fn the_linkage_with_hinges_only() {
    for answer in verdicts_along_the_motion(&study(&all_pins_are_hinges()), Pins::Hinges) {
        assert_eq!((answer.rows, answer.ranks[2]), (81, 71));
        for (name, unique) in &answer.reactions {
            let [in_plane @ .., _, _, _, _] = *unique;
            let is_open = NOT_UNIQUE.contains(name);
            assert_eq!(!in_plane.iter().all(|u| *u), is_open, "{name}: Fx, Fy");
            assert!(
                *name == "steering" || !unique[2] || *name == "H",
                "{name}: Fz"
            );
        }
    }
}

/// A wheel that rolls without slip on a horizontal body acts as a mass J/r² along its heading.
/// Across the heading it has no effect, because the knife edge constrains it. So in the plane the
/// wheel is a body with the mass m + J/r², fixed at its centre, which has the moment of inertia
/// about a diameter.
#[test]
fn wheels_with_inertia_are_masses_in_the_plane() {
    let [mass, spin, diameter, radius] = WHEEL;
    let mut plane = suite::ROBOT.to_owned();
    let places = [
        ("front-knuckle", [0.3, 0.0]),
        ("rear-knuckle", [-0.3, 0.0]),
        ("platform", [0.0, -0.2]),
        ("platform", [0.0, 0.2]),
        ("trolley", [-0.8, 0.0]),
    ];
    for (k, (body, at)) in places.into_iter().enumerate() {
        writeln!(
            plane,
            "[[body]]\nname = \"wheel {k}\"\nmass = {:?}\ninertia = {diameter:?}\nposition = {at:?}\n\
             velocity = [1.0, 0.0]\n[[joint]]\nname = \"fixed {k}\"\ntype = \"fixed\"\n\
             bodies = [\"{body}\", \"wheel {k}\"]\nat = {at:?}",
            mass + spin / (radius * radius)
        )
        .expect("a string");
    }
    let [space, plane] = [scene(), plane].map(|text| moved(&study(&text)));
    let worst = space.iter().zip(&plane).map(|((_, space), (_, plane))| {
        let bodies = &plane[..3 * BODIES.len()];
        apart(&level(space), bodies)
    });
    let worst = largest(worst);
    assert!(worst < 1e-10, "{worst:e}");
}

/// Without mass and inertia the wheels are knife edges: the motion equals that of the reference.
#[test]
fn wheels_without_inertia_are_knife_edges() {
    let [mass, spin, diameter, _] = WHEEL;
    let given = format!("mass = {mass:?}, inertia = [{diameter:?}, {spin:?}, {diameter:?}]");
    let text = scene().replace(&given, "mass = 0.0, inertia = [0.0, 0.0, 0.0]");
    let light = study(&text);
    assert_eq!(text.matches("mass = 0.0").count(), 5);
    let rows = moved(&light);
    let reference = suite::find("robot-trolley").expect("a case").reference();
    let (mut worst, mut compared) = (0.0_f64, 0);
    for instant in &reference.instants {
        let (_, q) = rows
            .iter()
            .find(|(t, _)| (t - instant.t).abs() < 1e-9)
            .expect("a row at each time");
        let found = level(q);
        for fact in &instant.facts {
            let Some(body) = BODIES.iter().position(|b| *b == fact.of) else {
                continue;
            };
            let k = match fact.quantity {
                Quantity::X => 0,
                Quantity::Y => 1,
                Quantity::Angle => 2,
                _ => continue,
            };
            worst = worst.max(gap(k, found[3 * body + k], fact.value).abs());
            compared += 1;
        }
    }
    assert!(compared >= 3 * BODIES.len() * 5, "{compared} numbers");
    assert!(worst < 1e-10, "{worst:e}");
    // Ranks and verdicts do not depend on masses, so they are the same.
    let (t, q) = &rows[30];
    let found = analyse(&light.prepared.mechanism, *t, q).expect("C is finite");
    assert_same(&found, &answer(q, Pins::Drawn), *t);
    assert_eq!(light.prepared.mechanism.layout().rows(), 74);
}

/// A sum of weighted squares is minimal if its first-order change is zero for any load that needs
/// no force on a body. The test does this for the norm with an arm of 0.3 m, and for supports with
/// very different compliances, as consecutive primes.
#[test]
fn choices_cannot_be_improved_by_a_load_that_nothing_feels() {
    let text = scene().replace("t_end = 10.0", "t_end = 10.0, rtol = 1e-12, atol = 1e-12");
    let study = study(&text);
    let rows = moved(&study);
    let groups = &study.prepared.mechanism.layout().groups;
    let compliances: Vec<[f64; 2]> = (0..groups.len())
        .map(|k| [1.0 + (3 * k % 7) as f64, 20.0 + (5 * k % 11) as f64].map(|x| 1e-6 * x))
        .collect();
    let elastic = compliances.iter().enumerate().map(|(k, c)| Compliance {
        reaction: ConstraintId(k),
        along: [c[0]; 3],
        rotation: c[1],
    });
    let norm = Choice::MinimumNorm(NormWeights::with_arm(0.3));
    let of_norm = vec![[1.0, 1.0 / 0.09]; groups.len()];
    for (choice, weights) in [
        (norm, of_norm),
        (
            Choice::Compliance(elastic.collect::<Vec<_>>().into()),
            compliances.clone(),
        ),
    ] {
        for (t, q) in [&rows[0], &rows[30], &rows[150]] {
            let analysis = study.analyse(*t, None).unwrap_or_else(|e| panic!("{e}"));
            let found = analysis.distribution(&choice);
            let found = found.unwrap_or_else(|e| panic!("{choice:?}: {e}"));
            let idle = idle_loads(q, Pins::Drawn);
            assert_eq!(idle.len(), 3);
            for load in idle {
                let (mut change, mut size) = (0.0, 0.0);
                for (reaction, weights) in found.reactions.iter().zip(&weights) {
                    let own = load.iter().find(|(name, _)| *name == reaction.name);
                    let (_, own) = own.expect("the same joints");
                    for (name, value) in &reaction.components {
                        let k = NAMES.iter().position(|n| n == name).expect("a component");
                        let value = value.in_solution().expect("finite reactions");
                        let term = weights[k / 3] * value * own[k];
                        change += term;
                        size += term.abs();
                    }
                }
                assert!(change.abs() < 1e-9 * size, "{t}: {change:e} of {size:e}");
                assert!(size > 0.0);
            }
        }
    }
}
