//! Tests choices for mechanisms. The result of each choice can be derived by hand.

use std::ops::ControlFlow;

use crate::page::Comparison;
use dynamics::MotionOptions;
use model::{Registry, System};
use report::{Frame, Recording};
use solvability::{Verdict, analyse};

use super::compare;
use crate::run_options::RunOptions;
use crate::study::Study;

/// Returns the comparisons of a scene over one second.
fn compared(scene: &str) -> (Study, Vec<Comparison>) {
    let study = Study::read(
        "scene.toml",
        scene,
        &Registry::standard(),
        &RunOptions::default(),
    );
    let study = study.expect("the scene is right");
    let mut recording = Recording::new(1.0, 21.0, 1);
    let options = MotionOptions {
        output_step: 0.05,
        ..MotionOptions::to(1.0)
    };
    let outcome = study.run(&options, |sample| {
        assert!(recording.wants(sample.t));
        recording.frames.push(Frame {
            t: sample.t,
            q: sample.q.to_vec(),
            v: sample.v.to_vec(),
            work: sample.work,
            reactions: sample.reactions()?.as_chosen().to_vec(),
            multipliers: sample.multipliers()?.as_chosen().to_vec(),
            chosen: Vec::new(),
        });
        Ok(ControlFlow::Continue(()))
    });
    outcome.expect("it moves");
    let mechanism = &study.prepared.mechanism;
    let analysis = analyse(mechanism, 0.0, &study.prepared.q).expect("decided");
    let (comparisons, left_out) = {
        let is_open = |k: usize| analysis.reactions[k].wrench.verdict == Verdict::NotUnique;
        compare(mechanism, &recording, is_open, &["this run".to_owned()])
    };
    assert_eq!(left_out, [""; 0]);
    (study, comparisons)
}

/// A cart has two wheels on one axle and is pushed sideways with 6 N.
const CART: &str = r#"
scene = { name = "cart", space = "plane" }
body = [{ name = "cart", mass = 10.0, inertia = 1.0, velocity = [1.0, 0.0] }]
joint = [
    { name = "left", type = "knife-edge", body = "cart", point = [0.0, 0.5], normal = [0.0, 1.0] },
    { name = "right", type = "knife-edge", body = "cart", point = [0.0, -0.5], normal = [0.0, 1.0] },
]
force = [{ name = "push", type = "point-force", body = "cart", point = [0.0, 0.0], force = [0.0, 6.0] }]
"#;

#[test]
fn two_wheels_of_one_axle_share_in_any_way() {
    let (_, comparisons) = compared(CART);
    let [c] = comparisons.as_slice() else {
        panic!("{} comparisons", comparisons.len())
    };
    assert_eq!(c.reactions, [0, 1]);
    let labels: Vec<&str> = c.choices.iter().map(|x| x.label.as_str()).collect();
    assert_eq!(labels.len(), 3, "{labels:?}");
    let mut shares: Vec<[f64; 2]> = Vec::new();
    for choice in &c.choices {
        for frame in &choice.values {
            let [left, right] = [frame[0][1], frame[1][1]];
            assert!(
                (left + right + 6.0).abs() < 1e-9,
                "{}: {left} {right}",
                choice.label
            );
        }
        shares.push([choice.values[0][0][1], choice.values[0][1][1]]);
    }
    // The expected choices are the choice of the run, the least norm, and the choice in which the
    // other wheel has no force.
    assert!(shares[0].iter().any(|x| x.abs() < 1e-12));
    assert!(shares[1].iter().all(|x| (x + 3.0).abs() < 1e-12));
    assert_eq!(
        shares[0].map(|x| x.abs() < 1e-12),
        shares[2].map(|x| x.abs() > 1e-12)
    );
    for freedom in c.freedom.iter().flatten() {
        // The force is free across the cart, and only in this direction.
        assert!(freedom.angle.cos().abs() < 1e-12 && !freedom.plane);
        assert_eq!(freedom.components[..3], [false, true, false]);
    }
}

/// Three equal cranks support one coupler. The degree of redundancy is one, and every choice gives
/// the same accelerations of the bodies.
#[test]
fn choices_differ_by_loads_that_cancel_on_every_body() {
    let text = suite::find("three-cranks").expect("a case").scene;
    let (study, comparisons) = compared(text);
    let mechanism = &study.prepared.mechanism;
    let c = &comparisons[0];
    let own = &c.choices[0].values;
    for choice in &c.choices[1..] {
        let mut differs = false;
        for (frame, reference) in choice.values.iter().zip(own) {
            let mut force = vec![[0.0; 2]; mechanism.bodies().len()];
            for ((&k, f), r) in c.reactions.iter().zip(frame).zip(reference) {
                let change = [f[0] - r[0], f[1] - r[1]];
                differs |= change[0].hypot(change[1]) > 1e-3;
                // The sign is positive on the first body and negative on the second.
                for (body, sign) in mechanism.layout().groups[k].bodies.iter().zip([1.0, -1.0]) {
                    if let Some(b) = body.moving() {
                        force[b][0] += sign * change[0];
                        force[b][1] += sign * change[1];
                    }
                }
            }
            assert!(
                force.iter().flatten().all(|x| x.abs() < 1e-7),
                "{}: {force:?}",
                choice.label
            );
        }
        assert!(differs, "{} is the choice of the run", choice.label);
    }
}

#[test]
fn nothing_is_compared_where_all_reactions_are_unique() {
    let text = suite::find("n-four-bar").expect("a case").scene;
    assert!(compared(text).1.is_empty());
}
