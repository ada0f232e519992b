//! Verdicts of a run whose degree of redundancy exceeds the number of vectors from which the
//! verdicts are computed.

use std::fmt::Write as _;
use std::ops::ControlFlow;

use dynamics::plan::Verdicts;
use dynamics::{MotionOptions, OutputRequest, Plan};
use model::{Registry, System};
use pfaff::{RunOptions, Study};
use solvability::{CARRIED_VECTORS, Stretches};

/// A beam of 1 kg/m is supported by this number of parallel cranks of 1 m, inclined by 0.6, and
/// carries a pendulum.
fn cranks(count: usize) -> String {
    let (sine, cosine) = 0.6_f64.sin_cos();
    let mut text = "[scene]\nname = \"cranks\"\nspace = \"plane\"\ngravity = [0, -10]\n".to_owned();
    let mut body = |name: &str, [x, y]: [f64; 2], angle: f64| {
        let _ = write!(
            text,
            "[[body]]\nname = \"{name}\"\nmass = 1.0\ninertia = 0.1\nposition = [{x}, {y}]\nangle = {angle}\n"
        );
    };
    let middle = (count - 1) as f64 / 2.0;
    body("beam", [middle + sine, cosine], 0.0);
    body("load", [middle + sine, cosine - 0.5], 0.0);
    for k in 0..count {
        body(
            &format!("crank-{k}"),
            [k as f64 + 0.5 * sine, 0.5 * cosine],
            0.0,
        );
    }
    let mut pin = |name: String, bodies: [&str; 2], [x, y]: [f64; 2]| {
        let _ = write!(
            text,
            "[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = {bodies:?}\nat = [{x}, {y}]\n"
        );
    };
    for k in 0..count {
        let crank = format!("crank-{k}");
        pin(format!("foot-{k}"), ["ground", &crank], [k as f64, 0.0]);
        pin(
            format!("top-{k}"),
            [&crank, "beam"],
            [k as f64 + sine, cosine],
        );
    }
    pin("hanger".into(), ["beam", "load"], [middle + sine, cosine]);
    text
}

/// Forces along the cranks whose sum and moment on the beam vanish load no other joint. While the
/// cranks are inclined, neither component of the reaction of their pins is unique; the reaction of
/// the pin of the pendulum is unique.
#[test]
fn many_dependencies_are_read_from_few_combinations() {
    let count = 2 * CARRIED_VECTORS;
    let registry = Registry::standard();
    let study = Study::read(
        "cranks.toml",
        &cranks(count),
        &registry,
        &RunOptions::default(),
    )
    .unwrap_or_else(|e| panic!("{e}"));
    let options = MotionOptions {
        output_step: 0.05,
        ..MotionOptions::to(0.2)
    };
    let run = study.run(&options, |_| Ok(ControlFlow::Continue(())));
    let run = run.unwrap_or_else(|e| panic!("{}", e.error));
    let found = run.verdicts.expect("reactions are computed");
    let groups = &study.prepared.mechanism.layout().groups;
    for (group, reaction) in groups.iter().zip(&found.reactions) {
        let expected = if group.name == "hanger" {
            "unique"
        } else {
            "not_unique"
        };
        for name in ["Fx", "Fy"] {
            let track = reaction.component(name).expect("a force in the plane");
            let words: Vec<&str> = track.stretches().iter().map(|s| s.verdict.word()).collect();
            assert_eq!(words, [expected], "{} {name}", group.name);
            assert_eq!(track.special(), [], "{} {name}", group.name);
        }
    }
}

/// A sweep computes verdicts only at the ends of each interval between events. They equal the
/// verdicts of a run that computes them at all steps and rows. The scenes turn, pass singular
/// configurations, or have drives with breaks.
#[test]
fn verdicts_on_stretches_do_not_depend_on_instants() {
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples");
    let registry = Registry::standard();
    let mut differ = Vec::new();
    for name in [
        "bricard",
        "car",
        "peaucellier",
        "robot-in-space",
        "table",
        "towed-cart",
    ] {
        let text = std::fs::read_to_string(format!("{examples}/{name}.toml")).expect("is read");
        let study = Study::read(name, &text, &registry, &RunOptions::default());
        let study = study.unwrap_or_else(|e| panic!("{name}: {e}"));
        let options = study.options.clone().expect("an end");
        let [all, few] = [Verdicts::WithInstants, Verdicts::OfRun].map(|verdicts| {
            let wanted = OutputRequest {
                verdicts,
                ..OutputRequest::default()
            };
            let plan = Plan::new(&study.prepared, &options, &wanted).expect("a plan");
            let run = plan.simulate(|_| Ok(ControlFlow::Continue(())));
            run.unwrap_or_else(|e| panic!("{name}: {}", e.error))
                .verdicts
                .expect("verdicts")
        });
        let words = |of: &Stretches, id: usize, component: &str| -> Vec<(f64, f64, &str)> {
            let track = of.reactions[id].component(component).expect("known");
            let stretches = track.stretches().iter();
            stretches
                .map(|s| (s.from, s.to, s.verdict.word()))
                .collect()
        };
        for (id, reaction) in all.reactions.iter().enumerate() {
            for (component, _) in &reaction.components {
                let [a, b] = [&all, &few].map(|of| words(of, id, component));
                if a != b {
                    differ.push(format!("{name}, {id}.{component}: {a:?}, in a sweep {b:?}"));
                }
            }
        }
    }
    assert!(differ.is_empty(), "{}", differ.join("\n"));
}
