//! Tests code for scenes in space: rotations by quaternions, velocities in principal axes,
//! gyroscopic torques, forces in the axes of a body frame, and drives of angles by cosine and sine.

#[path = "../../tests/space/mod.rs"]
mod scenes;

use model::System;
use scenes::scenes;

use super::{SAME, compare, corrections_are_exact, run, states, study, subject};
use crate::functions::{Functions, NamedView};

/// Number of states of each scene, and the smallest number of states at which the code must be
/// healthy. Many states of a chain that swings freely are outside the range of its pivots.
const STATES: usize = 1000;
const HEALTHY: usize = 800;

#[test]
fn code_equals_the_interpreter_at_a_thousand_states_of_every_scene_in_space() {
    for (name, text) in scenes() {
        let (compared, worst) = compare(&name, &text, STATES);
        assert!(compared >= HEALTHY, "{name}: {compared} states");
        assert!(worst < SAME, "{name}: {worst:e}");
    }
}

#[test]
fn corrections_in_space_are_those_of_a_saddle_solve() {
    for (name, text) in scenes() {
        corrections_are_exact(&name, &text);
    }
}

/// Compares q̇ = T(q)·v with the system, for quaternions of any length.
#[test]
fn rates_of_coordinates_are_those_of_the_mechanism() {
    for (name, text) in scenes() {
        let study = study(&name, &text);
        let subject = subject(&study, &name);
        let functions = Functions::new(&subject).unwrap_or_else(|e| panic!("{name}: {e}"));
        for mut state in states(&study, &subject, 10) {
            state.q.iter_mut().for_each(|q| *q *= 1.5);
            let (rate, _) = run(&functions, &subject, "rate", &state, |_| 0.0);
            let mut expected = vec![0.0; state.q.len()];
            study
                .prepared
                .mechanism
                .rate(&state.q, &state.v, &mut expected);
            for (rate, expected) in rate.iter().zip(&expected) {
                assert!(
                    (rate - expected).abs() <= 1e-15 * expected.abs().max(1.0),
                    "{name}"
                );
            }
        }
    }
}

/// Neither the length of a quaternion nor its sign changes a pose.
#[test]
fn accelerations_do_not_depend_on_lengths_of_quaternions() {
    for (name, text) in scenes() {
        let study = study(&name, &text);
        let subject = subject(&study, &name);
        let functions = Functions::new(&subject).unwrap_or_else(|e| panic!("{name}: {e}"));
        for mut state in states(&study, &subject, 5) {
            let none = |_| 0.0;
            let (a, health) = run(&functions, &subject, "acceleration", &state, none);
            for (body, q) in state.q.chunks_exact_mut(7).enumerate() {
                let length = if body % 2 == 0 { -1.7 } else { 0.6 };
                q[3..].iter_mut().for_each(|e| *e *= length);
            }
            let (same, _) = run(&functions, &subject, "acceleration", &state, none);
            let size = super::largest(&a).max(super::largest(&state.v).powi(2));
            if health < 0.1 {
                continue;
            }
            for (a, same) in a.iter().zip(&same) {
                assert!((a - same).abs() < SAME * size, "{name}: {a} {same}");
            }
        }
    }
}

/// Shafts that rotate by more than half a revolution, and a cart that rotates by more than 90°. In
/// fixed axes, every entry of C becomes zero at some state. In the axes of the supporting bodies,
/// or of the chassis, this does not happen.
#[test]
fn what_turns_keeps_its_pivots() {
    let view = |name: &str| {
        let mut all = scenes().into_iter();
        let (_, text) = all.find(|scene| scene.0 == name).expect("a scene");
        let study = study(name, &text);
        let functions = Functions::new(&subject(&study, name)).expect("code");
        assert_eq!(functions.unhealthy, 0, "{name}");
        functions.view
    };
    assert!(matches!(view("hooke"), NamedView::JointAxes));
    assert!(matches!(view("cart"), NamedView::Frame(body) if body == "chassis"));
}
