//! Runs step by step, compared with closed forms and with runs in one call.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use joints::{Distance, Revolute, RevoluteAngleDrive};
use model::{Body, BodyRef, Description, Function, Law, Mechanism, StartOptions, Wrench};

use super::*;
use crate::{RowChoice, prepare, simulate};

const O: [f64; 2] = [0.0, 0.0];

fn prepared(d: &Description) -> PreparedMechanism {
    let mechanism = Mechanism::build(d).expect("builds");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts")
}

fn options() -> MotionOptions {
    MotionOptions {
        rtol: 1e-11,
        atol: 1e-13,
        ..MotionOptions::to(0.0)
    }
}

/// A double pendulum: two rods of 1 m.
fn double_pendulum() -> Description {
    let mut d = Description::new("double pendulum");
    d.gravity = [0.0, -9.81];
    let [a, b] = [("a", 0.5), ("b", 1.5)].map(|(name, x)| {
        d.body(Body {
            position: [x, 0.0],
            ..Body::new(name, 1.0, 1.0 / 12.0)
        })
    });
    let pin = |s_i, s_j| Revolute { s_i, s_j };
    d.joint("first", &[BodyRef::Ground, a], pin(O, [-0.5, 0.0]));
    d.joint("second", &[a, b], pin([0.5, 0.0], [-0.5, 0.0]));
    d
}

/// The steps end at other times than the steps of a run, so the errors differ, but not by more than
/// the tolerance permits for this chaotic motion.
#[test]
fn steps_move_as_one_run() {
    let d = double_pendulum();
    let prepared = prepared(&d);
    let mut rows = Vec::new();
    let run = MotionOptions {
        t_end: 2.0,
        output_step: 0.1,
        ..options()
    };
    let summary = simulate(&prepared, &run, |row| {
        rows.push((row.t, row.q.to_vec(), row.v.to_vec()));
        Ok(ControlFlow::Continue(()))
    });
    let summary = summary.expect("moves");
    let mut simulator = Simulator::new(&prepared, &options(), &|| false).expect("starts");
    for (t, q, v) in &rows[1..] {
        assert!(simulator.step(*t).expect("moves").is_empty());
        let found = simulator.state();
        assert_eq!(found.0, *t);
        for (x, y) in found.1.iter().chain(found.2).zip(q.iter().chain(v)) {
            assert!((x - y).abs() < 1e-7, "{x} {y} at {t}");
        }
    }
    // Twenty more ends of steps need at most one step each.
    let most = summary.evaluations + 20 * 14;
    assert!(
        simulator.evaluations() <= most,
        "{} {most}",
        simulator.evaluations()
    );
}

/// A crank that is locked, then turns with a constant rate from 1 s on. The jump of the rate is at
/// the end of a step, within a step, or at the start.
#[test]
fn a_jump_of_a_rate_is_crossed_once() {
    let mut d = Description::new("crank");
    let crank = d.body(Body::new("crank", 1.0, 0.5));
    let bodies = [BodyRef::Ground, crank];
    d.joint("pin", &bodies, Revolute { s_i: O, s_j: O });
    let motion = Function::lines(&[0.0, 1.0, 2.0], &[0.0, 0.0, 3.0]).expect("a table");
    d.drive("motor", &bodies, RevoluteAngleDrive::new(O, O), motion);
    let prepared = prepared(&d);
    for times in [&[1.0, 1.5][..], &[0.7, 1.5], &[1.0, 1.2, 1.5]] {
        let mut simulator = Simulator::new(&prepared, &options(), &|| false).expect("starts");
        let mut events = Vec::new();
        for &t in times {
            events.extend(simulator.step(t).expect("moves"));
        }
        let (_, q, v) = simulator.state();
        assert!(
            (q[2] - 1.5).abs() < 1e-9 && (v[2] - 3.0).abs() < 1e-9,
            "{q:?}"
        );
        assert_eq!(events.len(), 1, "{times:?}: {events:?}");
    }
    let later = prepared
        .at(1.0, &[0.0; 3], &[0.0; 3])
        .expect("the jump is crossed");
    assert!((later.v[2] - 3.0).abs() < 1e-12);
    let mut simulator = Simulator::new(&later, &options(), &|| false).expect("starts");
    assert!(simulator.step(1.5).expect("moves").is_empty());
    assert!((simulator.state().1[2] - 1.5).abs() < 1e-9);
}

/// The motion after a restart is the rest of the motion.
#[test]
fn a_restarted_run_continues() {
    let mut d = double_pendulum();
    let law = Law::called(|at| Ok(-0.5 * at.rate + at.time.sin()));
    let angle = RevoluteAngleDrive::new(O, [-0.5, 0.0]);
    d.drive_by_law("motor", &[BodyRef::Ground, BodyRef::Body(0)], angle, law)
        .expect("one row");
    let first = prepared(&d);
    let mut whole = Simulator::new(&first, &options(), &|| false).expect("starts");
    whole.step(0.6).expect("moves");
    let (t, q, v) = whole.state();
    let (q, v) = (&q.to_vec(), &v.to_vec());
    let there = first.at(t, q, v).expect("a state of the motion");
    assert_eq!(
        (there.start_time(), there.q.as_slice()),
        (0.6, q.as_slice())
    );
    let mut rest = Simulator::new(&there, &options(), &|| false).expect("starts");
    whole.step(1.4).expect("moves");
    rest.step(1.4).expect("moves");
    for (x, y) in whole.state().1.iter().zip(rest.state().1) {
        assert!((x - y).abs() < 1e-9, "{x} {y}");
    }
    // A run in one call starts there, too.
    let mut times = Vec::new();
    let run = MotionOptions {
        t_end: 1.4,
        output_step: 0.3,
        ..options()
    };
    let mut last = Vec::new();
    simulate(&there, &run, |row| {
        times.push(row.t);
        last = row.q.to_vec();
        Ok(ControlFlow::Continue(()))
    })
    .expect("moves");
    assert!(
        (times[1] - 0.9).abs() < 1e-12 && times.len() == 4,
        "{times:?}"
    );
    for (x, y) in whole.state().1.iter().zip(&last) {
        assert!((x - y).abs() < 1e-9, "{x} {y}");
    }
    let before = simulate(&there, &MotionOptions::to(0.5), |_| {
        Ok(ControlFlow::Continue(()))
    });
    let error = before.expect_err("it ends before its start").error;
    assert!(error.to_string().contains("t_end is 0.5"), "{error}");
    let error = first.at(0.0, &[0.0], v).err().expect("one coordinate");
    assert!(
        error.to_string().contains("1 coordinates, need 6"),
        "{error}"
    );
    assert!(first.at(0.0, &[0.1; 6], v).is_err());
}

/// A controller sees the whole state at each evaluation, and is called once for each evaluation.
/// Two masses on a line attract each other with a force that depends on both positions and
/// velocities: m·ẍ = −k·(x − y) − c·(ẋ − ẏ) for the difference, so u = x − y solves m/2·ü + c·u̇ +
/// k·u = 0.
#[test]
fn a_controller_sees_the_whole_state() {
    use std::sync::atomic::AtomicU64;
    let (mass, k, c, start) = (2.0, 30.0, 0.8, 0.4);
    let mut d = Description::new("two masses");
    let bodies = [start, 0.0].map(|x| {
        d.body(Body {
            position: [x, 0.0],
            ..Body::new(&format!("at {x}"), mass, 0.1)
        })
    });
    let calls = Arc::new(AtomicU64::new(0));
    let counted = Arc::clone(&calls);
    d.control(&[], &bodies, move |state, efforts| {
        counted.fetch_add(1, Ordering::Relaxed);
        let (a, b) = (&state.bodies[0], &state.bodies[1]);
        let (x, v) = (a.position[0] - b.position[0], a.velocity[0] - b.velocity[0]);
        let force = -k * x - c * v;
        for (load, sign) in efforts.bodies.iter_mut().zip([1.0, -1.0]) {
            *load = Wrench {
                force: [sign * force, 0.0, 0.0],
                ..Wrench::default()
            };
        }
        Ok(())
    })
    .expect("no drives");
    let prepared = prepared(&d);
    let mut simulator = Simulator::new(&prepared, &options(), &|| false).expect("starts");
    calls.store(0, Ordering::Relaxed);
    simulator.step(1.5).expect("moves");
    let (delta, square) = (c / mass, 2.0 * k / mass);
    let omega = (square - delta * delta).sqrt();
    let (sin, cos) = (omega * 1.5_f64).sin_cos();
    let u = start * (-delta * 1.5_f64).exp() * (cos + delta / omega * sin);
    let (_, q, _) = simulator.state();
    assert!((q[0] - q[3] - u).abs() < 1e-9, "{q:?} {u}");
    let calls = calls.load(Ordering::Relaxed);
    assert!(
        calls <= simulator.evaluations() + 2,
        "{calls} calls in {} evaluations",
        simulator.evaluations()
    );
}

#[test]
fn a_controller_without_values_ends_the_run_by_name() {
    let mut d = Description::new("wheel");
    let wheel = d.body(Body::new("wheel", 1.0, 0.5));
    let bodies = [BodyRef::Ground, wheel];
    d.joint("shaft", &bodies, Revolute { s_i: O, s_j: O });
    let still = Law::called(|_| Ok(0.0));
    d.drive_by_law("motor", &bodies, RevoluteAngleDrive::new(O, O), still)
        .expect("one row");
    let refused = d.control(&["moter"], &[], |_, _| Ok(()));
    assert_eq!(
        refused.expect_err("a wrong name").to_string(),
        "there is no drive `moter`"
    );
    d.control(&["motor"], &[], |state, efforts| {
        if state.time > 0.5 {
            return Err("no sensor".into());
        }
        efforts.drives[0] = 1.0;
        Ok(())
    })
    .expect("a drive");
    let prepared = prepared(&d);
    let mut simulator = Simulator::new(&prepared, &options(), &|| false).expect("starts");
    let error = simulator.step(1.0).expect_err("no value after 0.5 s");
    assert!(
        error
            .to_string()
            .contains("the controller (its function failed: no sensor)"),
        "{error}"
    );
    assert!(simulator.state().0 <= 0.5);
    let radau = MotionOptions {
        method: Method::Radau5,
        ..options()
    };
    let error = Simulator::new(&prepared, &radau, &|| false)
        .err()
        .expect("no derivatives");
    assert!(
        error.to_string().contains("drive `motor` calls a function"),
        "{error}"
    );
}

/// A stopped step keeps the last accepted state and can be continued.
#[test]
fn a_stopped_step_continues() {
    let prepared = prepared(&double_pendulum());
    let stop = AtomicBool::new(true);
    let is_stopped = || stop.load(Ordering::Relaxed);
    let mut simulator = Simulator::new(&prepared, &options(), &is_stopped).expect("starts");
    let error = simulator.step(1.0).expect_err("stopped");
    assert_eq!(error.code().to_string(), "P0008");
    stop.store(false, Ordering::Relaxed);
    simulator.step(1.0).expect("moves");
    assert_eq!(simulator.state().0, 1.0);
    assert!(simulator.step(1.0).is_err() && simulator.step(f64::NAN).is_err());
}

/// A rod on a second rod that is as long as its distance carries no load: the pose is singular, and
/// the reactions of the sample belong to the state.
#[test]
fn a_sample_has_the_reactions_of_the_state() {
    let mut d = Description::new("pendulum");
    d.gravity = [0.0, -9.81];
    let bob = d.body(Body {
        position: [0.0, -2.0],
        ..Body::new("bob", 3.0, 0.1)
    });
    let rod = Distance::new(O, O);
    d.joint("rod", &[BodyRef::Ground, bob], rod);
    let prepared = prepared(&d);
    let mut simulator = Simulator::new(&prepared, &options(), &|| false).expect("starts");
    simulator.step(0.5).expect("rests");
    let mut force = [0.0; 3];
    simulator
        .sample(|sample| force = sample.reactions().expect("unique").as_chosen()[0].force)
        .expect("unique");
    // The rod pulls the ground down with the weight.
    assert!((force[1] + 3.0 * 9.81).abs() < 1e-9, "{force:?}");
}
