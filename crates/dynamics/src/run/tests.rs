//! Forces that call a function: closed-form solutions, methods that reject these forces, and runs
//! that end because such a force fails.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use joints::{Direction, Translational, TranslationalDisplacementDrive};
use model::law::{Join, Operation};
use model::{
    Body, BodyRef, CallError, Description, DriveState, Law, Mechanism, SpatialBody,
    SpatialDescription, StartOptions, Wrench,
};

use super::*;
use crate::equilibrium::{EquilibriumError, EquilibriumOptions, equilibrium};
use crate::linearise::{LineariseError, LineariseOptions, linearise};
use crate::{Method, MotionError, RowChoice, prepare};

const MASS: f64 = 2.0;
const STIFFNESS: f64 = 50.0;
const DAMPING: f64 = 1.2;
const START: f64 = 0.3;

/// A mass on a guide along x, with a drive whose force law depends on the position of the mass.
fn guided(d: &mut Description, name: &str, y: f64, law: Law) {
    let body = d.body(Body {
        position: [START, y],
        ..Body::new(name, MASS, 0.1)
    });
    let (bodies, s_i) = ([BodyRef::Ground, body], [0.0, y]);
    let guide = Translational::new(s_i, [0.0; 2], Direction::X);
    d.joint(&format!("guide of {name}"), &bodies, guide);
    let drive = TranslationalDisplacementDrive::new(s_i, [0.0; 2], Direction::X);
    d.drive_by_law(&format!("motor of {name}"), &bodies, drive, law)
        .expect("one row");
}

fn prepared(d: &Description) -> PreparedMechanism {
    let mechanism = Mechanism::build(d).expect("builds");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts")
}

fn of_law(law: Law) -> PreparedMechanism {
    let mut d = Description::new("oscillator");
    guided(&mut d, "mass", 0.0, law);
    prepared(&d)
}

fn called(
    f: impl Fn(&DriveState) -> Result<f64, CallError> + Send + Sync + 'static,
) -> PreparedMechanism {
    of_law(Law::called(f))
}

/// The force `−k·x − c·ẋ` as recorded operations, with the same rounding as the function below.
fn written() -> Law {
    Law::new(&[
        Operation::Number(-STIFFNESS),
        Operation::Measure,
        Operation::Join(Join::Multiply),
        Operation::Number(DAMPING),
        Operation::Rate,
        Operation::Join(Join::Multiply),
        Operation::Join(Join::Subtract),
    ])
    .expect("complete")
}

fn spring(at: &DriveState) -> Result<f64, CallError> {
    Ok(-STIFFNESS * at.measure - DAMPING * at.rate)
}

fn options(method: Method) -> MotionOptions {
    MotionOptions {
        method,
        rtol: 1e-11,
        atol: 1e-13,
        ..MotionOptions::to(2.0)
    }
}

/// Returns the times, coordinates and velocities of all rows.
fn rows(prepared: &PreparedMechanism, method: Method) -> Vec<(f64, Vec<f64>, Vec<f64>)> {
    let mut rows = Vec::new();
    simulate(prepared, &options(method), |sample| {
        rows.push((sample.t, sample.q.to_vec(), sample.v.to_vec()));
        Ok(ControlFlow::Continue(()))
    })
    .expect("moves");
    rows
}

const EXPLICIT: [Method; 4] = [Method::Auto, Method::Dop853, Method::Dopri5, Method::Tsit5];

/// The solution is x = e^(−δt)·(x₀·cos ωt + x₀·δ/ω·sin ωt), accurate to the tolerance of the run.
#[test]
fn a_called_oscillator_swings_as_by_hand() {
    let delta = DAMPING / (2.0 * MASS);
    let omega = (STIFFNESS / MASS - delta * delta).sqrt();
    for method in EXPLICIT {
        for (t, q, _) in rows(&called(spring), method) {
            let (sin, cos) = (omega * t).sin_cos();
            let x = START * (-delta * t).exp() * (cos + delta / omega * sin);
            assert!((q[0] - x).abs() < 1e-8, "{method:?} at {t}: {} {x}", q[0]);
        }
    }
}

#[test]
fn a_called_law_moves_as_its_operations_do() {
    for method in [Method::Dop853, Method::Dopri5, Method::Tsit5] {
        assert_eq!(
            rows(&called(spring), method),
            rows(&of_law(written()), method)
        );
    }
}

#[test]
fn what_needs_derivatives_refuses_a_called_law_by_name() {
    let prepared = called(spring);
    let refused = simulate(&prepared, &options(Method::Radau5), |_| {
        Ok(ControlFlow::Continue(()))
    });
    let error = refused.expect_err("it needs a Jacobian").error;
    assert_eq!(
        error.to_string(),
        "method radau5 needs derivatives of all forces, and drive `motor of mass` calls a function, which has no \
         derivatives; use an explicit method: dop853, dopri5, tsit5 or auto"
    );
    let state = (0.0, prepared.q.as_slice(), prepared.v.as_slice());
    let error = linearise(&prepared, state, &LineariseOptions::default()).expect_err("derivatives");
    let named = matches!(
        &error,
        LineariseError::Fault(MotionFault::NoDerivatives { source, .. }) if source.name == "motor of mass"
    );
    assert!(named, "{error}");
    let error = equilibrium(&prepared, &EquilibriumOptions::default()).expect_err("derivatives");
    let named = matches!(&error, EquilibriumError::NoDerivatives(of) if of.name == "motor of mass");
    assert!(named, "{error}");
    // With recorded operations, all three calls succeed.
    let prepared = of_law(written());
    assert!(equilibrium(&prepared, &EquilibriumOptions::default()).is_ok());
    let state = (0.0, &[0.0; 3][..], &[0.0; 3][..]);
    let found = linearise(&prepared, state, &LineariseOptions::default()).expect("at rest");
    assert!(
        (found.a[(1, 0)] + STIFFNESS / MASS).abs() < 1e-9,
        "{:?}",
        found.a
    );
    // An additional force of the motor is an input: m·Δẍ = ΔF.
    let [motor] = &found.inputs[..] else {
        panic!("{:?}", found.inputs);
    };
    assert_eq!(
        (motor.name.as_str(), motor.what.as_str()),
        ("motor of mass", "force")
    );
    assert!(
        (found.b[(1, 0)] - 1.0 / MASS).abs() < 1e-12,
        "{:?}",
        found.b
    );
    assert_eq!(
        rows(&prepared, Method::Radau5).len(),
        rows(&prepared, Method::Dop853).len()
    );
}

#[test]
fn auto_chooses_an_explicit_method_and_one_clock() {
    let two = |law: &dyn Fn() -> Law| {
        let mut d = Description::new("two");
        guided(&mut d, "a", 0.0, law());
        guided(&mut d, "b", 1.0, law());
        prepared(&d)
    };
    let (functions, operations) = (two(&|| Law::called(spring)), two(&written));
    let plan = |p| Plan::new(p, &options(Method::Auto), &OutputRequest::default());
    let own = plan(&operations).expect("a plan");
    assert_eq!(own.components.len(), 2);
    let own = plan(&functions).expect("a plan");
    assert_eq!(own.components.len(), 1);
    assert!(
        own.apart.reason.contains("`motor of a` calls a function"),
        "{}",
        own.apart.reason
    );
    let method = &own.components[0].decisions.method;
    assert_eq!(method.value, Method::Dop853);
    assert!(method.reason.contains("`motor of a`"), "{}", method.reason);
}

/// The run ends immediately. No shorter steps are tried, and the last accepted state is before the
/// fault. Later calls only determine the name of the cause.
#[test]
fn a_function_without_a_value_ends_the_run_by_name() {
    let faults: [fn() -> Result<f64, CallError>; 3] = [
        || Ok(f64::NAN),
        || Ok(f64::INFINITY),
        || Err("no sensor".into()),
    ];
    let words = ["returned NaN", "returned inf", "failed: no sensor"];
    for (fault, words) in faults.into_iter().zip(words) {
        for method in EXPLICIT {
            let after = Arc::new(AtomicUsize::new(0));
            let counted = Arc::clone(&after);
            let prepared = called(move |at| {
                if at.time <= 0.5 {
                    return spring(at);
                }
                counted.fetch_add(1, Ordering::Relaxed);
                fault()
            });
            let ended = simulate(&prepared, &options(method), |_| {
                Ok(ControlFlow::Continue(()))
            });
            let failure = ended.expect_err("no value after 0.5 s");
            let text = failure.error.to_string();
            let MotionError::Fault(MotionFault::Function { time, source }) = &failure.error else {
                panic!("{text}");
            };
            assert!(*time > 0.5 && failure.summary.t <= 0.5, "{time}");
            assert!(text.contains("drive `motor of mass`"), "{text}");
            assert!(text.contains(words), "{text}");
            assert!(
                text.contains("measure = ") && text.contains("rate = "),
                "{source}"
            );
            // There is one call for the force at the stage. Two more calls determine the name of
            // the force.
            assert!(after.load(Ordering::Relaxed) <= 3, "{after:?}");
        }
    }
    // If the fault is at the start, no run takes place.
    let prepared = called(|_| Ok(f64::NAN));
    let ended = simulate(&prepared, &options(Method::Auto), |_| {
        Ok(ControlFlow::Continue(()))
    });
    let error = ended.expect_err("no value at the start").error;
    assert!(
        matches!(&error, MotionError::Fault(MotionFault::Function { time, .. }) if *time == 0.0),
        "{error}"
    );
}

/// The equations of motion are m·ẍ = F and J·φ̈ = T − c·φ̇ in the plane. The force is a function of
/// the state of the body.
#[test]
fn a_body_is_pushed_by_a_called_wrench() {
    let (force, torque, drag, inertia) = ([3.0, -1.0, 0.0], 0.4, 0.5, 0.1);
    let mut d = Description::new("puck");
    let puck = d.body(Body::new("puck", MASS, inertia));
    d.called_force("push", puck, move |at| {
        let [.., omega] = at.angular_velocity;
        let torque = [0.0, 0.0, torque - drag * omega];
        Ok(Wrench { force, torque })
    });
    for method in EXPLICIT {
        for (t, q, v) in rows(&prepared(&d), method) {
            let [x, y, _] = force.map(|f| 0.5 * f / MASS * t * t);
            let omega = torque / drag * (1.0 - (-drag / inertia * t).exp());
            for (found, expected) in [(q[0], x), (q[1], y), (v[2], omega)] {
                assert!((found - expected).abs() < 1e-8, "{method:?} at {t}");
            }
        }
    }
    d.called_force("wind", puck, |at| {
        let force = [if at.time < 1.0 { 0.0 } else { f64::NAN }, 0.0, 0.0];
        Ok(Wrench {
            force,
            ..Wrench::default()
        })
    });
    let ended = simulate(&prepared(&d), &options(Method::Auto), |_| {
        Ok(ControlFlow::Continue(()))
    });
    let text = ended.expect_err("no value after 1 s").error.to_string();
    assert!(
        text.contains("force `wind` (its function returned the force [NaN, 0.0, 0.0]"),
        "{text}"
    );
}

/// A torque about the vertical axis of the ground rotates a body about this axis, for any axes of
/// the body. The inertia tensor of the body has products of inertia, and y is a principal axis.
#[test]
fn a_called_wrench_of_space_is_in_ground_axes() {
    let torque = 0.6;
    // The body is rotated by 30° about the vertical and by 90° about x, so the vertical is y of the
    // body.
    let (half, quarter) = (15.0_f64.to_radians(), 45.0_f64.to_radians());
    let (w, x) = (half.cos() * quarter.cos(), half.cos() * quarter.sin());
    let (y, z) = (half.sin() * quarter.sin(), half.sin() * quarter.cos());
    let tensor = [[0.5, 0.0, 0.2], [0.0, 0.8, 0.0], [0.2, 0.0, 0.6]];
    let mut d = SpatialDescription::new("block");
    let block = d.body(SpatialBody {
        orientation: [w, x, y, z],
        ..SpatialBody::new("block", MASS, tensor)
    });
    d.called_force("turn", block, move |at| {
        // R·(0, 1, 0) is the vertical.
        let up = at.rotation.map(|row| row[1]);
        let off = [up[0], up[1], up[2] - 1.0].map(f64::abs);
        if off.iter().any(|off| *off > 1e-9) {
            return Err("the vertical has turned".into());
        }
        let [wx, wy, _] = at.angular_velocity.map(f64::abs);
        if wx.max(wy) > 1e-9 {
            return Err("it turns about another axis".into());
        }
        Ok(Wrench {
            force: [0.0, 0.0, MASS],
            torque: [0.0, 0.0, torque],
        })
    });
    let mechanism = Mechanism::build(&d).expect("builds");
    let prepared =
        prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts");
    for (t, q, v) in rows(&prepared, Method::Auto) {
        let spin = v[3..6].iter().map(|w| w * w).sum::<f64>().sqrt();
        assert!((spin - torque / 0.8 * t).abs() < 1e-9, "{spin} at {t}");
        assert!((q[2] - 0.5 * t * t).abs() < 1e-9);
    }
}
