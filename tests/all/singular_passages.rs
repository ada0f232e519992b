//! Change points of linkages are passed on the smooth branch, and reported. Rows that become nearly
//! dependent, although the rank does not change, are exchanged, and this is reported.

use std::ops::ControlFlow;

use dynamics::{
    EventKind, Method, MotionOptions, OutputRequest, Plan, RowChoice, prepare, simulate,
};
use joints::RevoluteAngleDrive;
use model::start::CorrectionLimit;
use model::{BodyRef, Drive, Function, Mechanism, Registry, StartOptions};
use pfaff::{RunOptions, Study};
use tests::cranks::cranks;
use tests::robot::{robot, robot_of_size, steering, steering_of_size};

/// The motor rotates crank 1 with ω = 1 from `start`.
fn driven(pivots: &[f64], start: f64) -> dynamics::PreparedMechanism {
    let mut d = cranks(pivots, 0.5, start);
    let element = RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    d.drives.push(Drive {
        tolerance: None,
        name: "motor".into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(0)],
        element: Box::new(element),
        motion: Function::constant_rate(1.0).expect("finite"),
    });
    let options = StartOptions {
        correction: CorrectionLimit::Any,
        ..StartOptions::default()
    };
    let mechanism = Mechanism::build(&d).expect("builds");
    prepare(mechanism, &options, &RowChoice::Automatic).expect("starts")
}

/// A parallelogram that is driven through its singular configuration at θ = 0 can continue in two
/// ways: it remains a parallelogram, and the run reports that the constraints do not determine
/// this.
#[test]
fn a_driven_parallelogram_goes_on_smoothly_and_says_so() {
    for (start, rtol) in [
        (-0.05, 1e-8),
        (-0.05, 1e-4),
        (-0.5, 1e-8),
        (-0.3, 1e-6),
        (-0.5, 1e-12),
    ] {
        for method in [Method::Dopri5, Method::Dop853, Method::Tsit5] {
            let run = MotionOptions {
                rtol,
                atol: rtol,
                method,
                ..MotionOptions::to(1.0)
            };
            let mut q = Vec::new();
            let summary = simulate(&driven(&[0.0, 1.0], start), &run, |s| {
                q = s.q.to_vec();
                Ok(ControlFlow::Continue(()))
            })
            .unwrap_or_else(|e| panic!("from {start}, rtol {rtol}, {method:?}: {e}"));
            // The mechanism is driven: all values follow from the constraints.
            let theta = start + 1.0;
            for angle in [q[2], q[5]] {
                assert!(
                    (angle - theta).abs() < 1e-12,
                    "{start} {rtol} {method:?}: {q:?}"
                );
            }
            let [event] = summary.events.as_slice() else {
                panic!("one passage: {:?}", summary.events);
            };
            assert_eq!(event.kind, EventKind::SingularPassage);
            assert_eq!((event.redundancy_before, event.redundancy_after), (0, 1));
            assert!((event.time + start).abs() < 1e-3 * rtol.sqrt(), "{event:?}");
            assert!(event.text.contains("a bifurcation"), "{}", event.text);
        }
    }
}

/// Without a request, an event does not state whether the motion is unique. The event is otherwise
/// the same.
#[test]
fn uniqueness_is_stated_on_request() {
    let prepared = driven(&[0.0, 1.0], -0.5);
    let [stated, brief] = [true, false].map(|uniqueness| {
        let wanted = OutputRequest {
            uniqueness,
            ..OutputRequest::default()
        };
        let plan = Plan::new(&prepared, &MotionOptions::to(1.0), &wanted).expect("a plan");
        let run = plan.simulate(|_| Ok(ControlFlow::Continue(())));
        let summary = run.unwrap_or_else(|failure| panic!("{}", failure.error));
        let [event] = summary.events.try_into().expect("one passage");
        event
    });
    assert!(stated.text.contains("a bifurcation"), "{}", stated.text);
    assert!(!brief.text.contains("unique"), "{}", brief.text);
    let text = stated.text.clone();
    assert_eq!(stated, dynamics::Event { text, ..brief });
}

/// The runs must end, or must write a row, in the singular configuration or near it.
#[test]
fn a_run_may_end_in_the_flat_pose_or_beside_it() {
    for pivots in [&[0.0, 1.0][..], &[0.0, 1.0, 1.7]] {
        let p = driven(pivots, -0.5);
        let beside =
            (0..31).flat_map(|k| [1.0, -1.0].map(|s| s * 10.0_f64.powf(-1.0 - 0.5 * f64::from(k))));
        for offset in beside.chain([0.0]) {
            let run = MotionOptions {
                output_step: 0.25 * (0.5 + offset),
                method: Method::Dop853,
                ..MotionOptions::to(0.5 + offset)
            };
            let mut q = Vec::new();
            let outcome = simulate(&p, &run, |s| {
                q = s.q.to_vec();
                Ok(ControlFlow::Continue(()))
            });
            let summary = match outcome {
                Ok(summary) => summary,
                // FIXME: two cranks that end very near the singular configuration stop with an
                // error or not depending on the last digit of their initial velocities. Changed by
                // 1e-17 m/s, 26 of 40 starts stop at one of these offsets. With the exact
                // velocities of the start they stop.
                Err(e) => {
                    let is_known = pivots.len() == 2 && (0.9e-6..4e-6).contains(&offset.abs());
                    let said = e.to_string();
                    assert!(is_known, "{} cranks, offset {offset}: {said}", pivots.len());
                    assert!(said.contains("without a smooth continuation"), "{said}");
                    continue;
                }
            };
            for crank in 0..pivots.len() {
                assert!((q[3 * crank + 2] - offset).abs() < 1e-9, "{offset}: {q:?}");
            }
            assert!(
                summary.max_position_residual < 1e-12 && summary.max_velocity_residual < 1e-12,
                "{offset}: {summary:?}"
            );
        }
    }
}

/// The rear edge becomes parallel to the global y-axis twice between t = 6 and t = 7: at these
/// instants row 6 is in no dependency.
#[test]
fn rows_that_lose_their_independence_are_exchanged_and_come_back() {
    let run = |choice: &RowChoice| {
        let mechanism = Mechanism::build(&robot(steering())).expect("builds");
        let p = prepare(mechanism, &StartOptions::default(), choice).expect("starts");
        simulate(&p, &MotionOptions::to(10.0), |_| {
            Ok(ControlFlow::Continue(()))
        })
        .expect("moves")
    };
    let events = run(&RowChoice::Drop(vec![5, 20])).events;
    assert_eq!(events.len(), 2, "{events:?}");
    assert!(events.iter().all(|e| e.kind == EventKind::RowsExchanged));
    assert!(
        events.iter().all(|e| (6.0..7.0).contains(&e.time)),
        "{events:?}"
    );
    assert_ne!(events[0].dropped, [5, 20]);
    assert_eq!(events[1].dropped, [5, 20]);
    assert!(run(&RowChoice::Automatic).events.is_empty());
}

/// Verdicts do not depend on the size of a mechanism or on its position.
#[test]
fn size_and_place_do_not_matter() {
    for size in [1e-6, 1.0, 1e4] {
        for offset in [0.0, 1e3 * size] {
            let mut d = robot_of_size(size, steering_of_size(size));
            for body in &mut d.bodies {
                body.position = body.position.map(|x| x + offset);
            }
            let mechanism = Mechanism::build(&d).expect("builds");
            let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic);
            let p = p.unwrap_or_else(|e| panic!("size {size}, offset {offset}: {e}"));
            let mut q = Vec::new();
            let run = MotionOptions {
                atol: 1e-10 * size,
                output_step: 1.5,
                ..MotionOptions::to(1.5)
            };
            simulate(&p, &run, |s| {
                q = s.q.to_vec();
                Ok(ControlFlow::Continue(()))
            })
            .unwrap_or_else(|e| panic!("size {size}, offset {offset}: {e}"));
            let a = solvability::analyse(&p.mechanism, 1.5, &q).expect("finite");
            assert!(a.decision.is_decided(), "size {size}, offset {offset}");
            assert_eq!(
                (a.decision.rank, a.decision.redundancy),
                (20, 2),
                "size {size}, offset {offset}"
            );
            let not_unique: Vec<&str> = a
                .reactions
                .iter()
                .filter(|r| r.wrench.verdict.word() == "not_unique")
                .map(|r| r.name.as_str())
                .collect();
            assert_eq!(
                not_unique,
                ["B", "C", "W1", "W2", "W3", "W4"],
                "size {size}, offset {offset}"
            );
        }
    }
}

/// A lift whose rod is shorter than the distance to its dead centre. The crank turns back at
/// `cos θ = (L − 0.15)/0.1`. This angle is close to the singular configuration θ = 0 of the rod of
/// 0.25 m. The table moves to the other side of the crankpin. Longer rods let the crank pass.
#[test]
fn a_crank_that_turns_back_close_to_a_singular_configuration_continues() {
    let lift = |length: f64| {
        let text = format!(
            r#"
scene = {{ format = 2, name = "lift", space = "plane", gravity = [0.0, -9.81] }}
parameters = {{ r = 0.1, L = {length:?}, e = -0.15, start = "-60 deg", h = "sqrt(L^2 - (e - r*cos(start))^2)" }}
body = [
  {{ name = "crank", mass = 2.0, inertia = 0.01, angle = "start" }},
  {{ name = "rod", mass = 0.5, inertia = "0.5*L^2/12", position = ["(e + r*cos(start))/2", "r*sin(start) + h/2"], angle = "atan2(h, e - r*cos(start))" }},
  {{ name = "table", mass = 20.0, inertia = 0.1, position = ["e", "r*sin(start) + h"] }},
]
joint = [
  {{ name = "shaft", type = "revolute", bodies = ["ground", "crank"], at = [0.0, 0.0] }},
  {{ name = "crankpin", type = "revolute", bodies = ["crank", "rod"], at = ["r*cos(start)", "r*sin(start)"] }},
  {{ name = "wristpin", type = "revolute", bodies = ["rod", "table"], at = ["e", "r*sin(start) + h"] }},
  {{ name = "guide", type = "translational", bodies = ["ground", "table"], at = ["e", 0.0], axis = [0.0, 1.0] }},
]
drive = [
  {{ name = "motor", joint = "shaft", type = "angle", torque = "33.0 - 400.0*(measure - 40 deg) - 30.0*rate" }},
  {{ name = "friction", joint = "guide", type = "displacement", force = "-50.0*rate" }},
]
simulate = {{ t_end = 3.0, output_step = 0.02 }}
output = {{ reactions = false }}
"#
        );
        let registry = Registry::standard();
        Study::read("lift.toml", &text, &registry, &RunOptions::default()).expect("starts")
    };
    for length in [0.249, 0.2492, 0.2495, 0.2499, 0.24999, 0.2501] {
        let study = lift(length);
        let options = study.options.clone().expect("an end");
        let (mut highest, mut side) = (f64::NEG_INFINITY, 0.0);
        let summary = simulate(&study.prepared, &options, |row| {
            highest = row.q[2].max(highest);
            side = row.q[7] - 0.1 * row.q[2].sin();
            Ok(ControlFlow::Continue(()))
        });
        let summary = summary.unwrap_or_else(|e| panic!("{length}: {}", e.error));
        assert_eq!(summary.t, 3.0);
        if length < 0.25 {
            let last = -((length - 0.15) / 0.1_f64).acos();
            assert!(highest < last + 1e-9, "{length}: {highest} beyond {last}");
            assert!(highest > last - 0.01, "{length}: {highest} far from {last}");
            assert!(side < 0.0, "{length}: {side}");
        } else {
            assert!(highest > 0.5 && side > 0.0, "{length}: {highest}, {side}");
        }
    }
}
