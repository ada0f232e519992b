//! Tests that a run does not do the work that its plan omits. They also test that components that
//! run separately move as they move alone.

mod driven;
mod stiff;
mod watched;

use std::ops::ControlFlow;

use joints::{
    Angle, Direction, Distance, PinInSlot, Revolute, RevoluteAngleDrive, SpringDamper,
    Translational,
};
use model::{Body, BodyRef, Description, Drive, Force, Function, Joint, Mechanism, StartOptions};

use super::*;
use crate::counts::{WorkKind, counted};
use crate::{Failure, Method, RowChoice, Summary, prepare};
use watched::{Calls, take, watch};

const GROUND: BodyRef = BodyRef::Ground;

fn body(name: &str, position: [f64; 2]) -> Body {
    Body {
        name: name.into(),
        mass: 1.0,
        inertia: 0.1,
        position,
        ..Body::default()
    }
}

/// Adds a pendulum of length 1 at a point `x` of the ground. The pendulum is at rest and
/// horizontal.
fn pendulum(d: &mut Description, name: &str, x: f64) {
    let k = d.bodies.len();
    d.bodies.push(body(name, [x + 1.0, 0.0]));
    let pin = Revolute {
        s_i: [x, 0.0],
        s_j: [-1.0, 0.0],
    };
    let name = format!("pin of {name}");
    d.joints
        .push(Joint::new(&name, &[GROUND, BodyRef::Body(k)], pin));
}

/// Adds a mass on a stiff damper: ẍ = −10⁴·x − 10⁸·ẋ.
fn stiff(d: &mut Description) {
    let k = d.bodies.len();
    d.bodies.push(body("stiff", [6.1, 0.0]));
    let spring = SpringDamper::new([5.0, 0.0], [0.0; 2], 1e4, 1e8).with_free_length(1.0);
    d.forces.push(Force {
        name: "damper".into(),
        bodies: vec![GROUND, BodyRef::Body(k)],
        element: Box::new(spring),
        functions: Vec::new(),
    });
}

fn scene(build: impl FnOnce(&mut Description)) -> PreparedMechanism {
    let mut d = Description {
        gravity: [0.0, -9.81],
        ..Description::default()
    };
    build(&mut d);
    let mechanism = Mechanism::build(&d).expect("builds");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts")
}

fn to(t_end: f64) -> MotionOptions {
    MotionOptions {
        output_step: t_end / 8.0,
        ..MotionOptions::to(t_end)
    }
}

fn go(plan: &Plan<'_>) -> Summary {
    plan.simulate(|sample| {
        sample.reactions()?;
        Ok(ControlFlow::Continue(()))
    })
    .expect("moves")
}

#[test]
fn independent_rows_are_neither_monitored_nor_judged() {
    let single = scene(|d| pendulum(d, "bob", 0.0));
    let plan = Plan::new(&single, &to(1.0), &OutputRequest::default()).expect("a plan");
    assert_eq!(plan.components[0].decisions.dropped.value, 0);
    let work = counted(|| drop(go(&plan)));
    let kept_row_work = [WorkKind::Monitors, WorkKind::Coefficients].map(&work);
    assert_eq!(kept_row_work, [0, 0]);
    // The same pendulum with two equal hinges has two redundant rows.
    let double = scene(|d| {
        pendulum(d, "bob", 0.0);
        let twin = d.joints[0].clone();
        d.joints.push(Joint {
            name: "twin".into(),
            ..twin
        });
    });
    let plan = Plan::new(&double, &to(1.0), &OutputRequest::default()).expect("a plan");
    assert_eq!(plan.components[0].decisions.dropped.value, 2);
    let work = counted(|| drop(go(&plan)));
    assert!(
        [WorkKind::Monitors, WorkKind::Coefficients]
            .map(&work)
            .iter()
            .all(|n| *n > 0)
    );
}

#[test]
fn solutions_are_refined_where_digits_would_be_lost() {
    let refinement = |p: &PreparedMechanism| {
        let plan = Plan::new(p, &to(1.0), &OutputRequest::default()).expect("a plan");
        let decided = &plan.components[0].decisions.refinement;
        (decided.value, decided.reason.clone())
    };
    let ordinary = scene(|d| pendulum(d, "bob", 0.0));
    let (refined, why) = refinement(&ordinary);
    assert!(!refined && why.contains("no digits cancel"), "{why}");
    let graded = scene(|d| {
        pendulum(d, "bob", 0.0);
        d.bodies[0].inertia = 1e-7;
    });
    let (refined, why) = refinement(&graded);
    let factor = "masses and inertias differ by a factor of 1e7; above 1e6";
    assert!(refined && why.starts_with(factor), "{why}");
    let large = scene(|d| {
        pendulum(d, "bob", 0.0);
        let pin = Revolute {
            s_i: [0.0; 2],
            s_j: [-1e7, 0.0],
        };
        d.bodies[0].position = [1e7, 0.0];
        d.bodies[0].inertia = 1e13;
        d.joints = vec![Joint::new("pin", &[GROUND, BodyRef::Body(0)], pin)];
    });
    let (refined, why) = refinement(&large);
    assert!(refined && why.contains("far from 1 m"), "{why}");
}

#[test]
fn multipliers_are_those_that_are_wanted() {
    let p = scene(|d| pendulum(d, "bob", 0.0));
    let solved = |reactions| {
        let wanted = OutputRequest {
            reactions,
            ..OutputRequest::default()
        };
        let plan = Plan::new(&p, &to(1.0), &wanted).expect("a plan");
        let work = counted(|| drop(go(&plan)));
        work(WorkKind::Multipliers)
    };
    let one = Reactions::Of(vec!["pin of bob".into()]);
    assert_eq!([solved(Reactions::All), solved(one)], [9, 9]);
    assert_eq!(solved(Reactions::None), 0);
    let nobody = OutputRequest {
        reactions: Reactions::Of(vec!["nobody".into()]),
        ..OutputRequest::default()
    };
    let refused = Plan::new(&p, &to(1.0), &nobody)
        .err()
        .expect("no such joint");
    assert!(matches!(refused, MotionError::NoReaction { name } if name == "nobody"));
}

#[test]
fn explicit_methods_have_no_linear_systems() {
    let p = scene(|d| pendulum(d, "bob", 0.0));
    let made = |method| {
        let options = MotionOptions { method, ..to(0.5) };
        let plan = Plan::new(&p, &options, &OutputRequest::default()).expect("a plan");
        let decided = plan.components[0].decisions.linear_systems.value;
        let work = counted(|| drop(go(&plan)));
        (decided, work(WorkKind::LinearSystems))
    };
    for method in [Method::Auto, Method::Dopri5, Method::Dop853, Method::Tsit5] {
        assert_eq!(made(method), (false, 0), "{method:?}");
    }
    assert_eq!(made(Method::Radau5), (true, 1));
}

#[test]
fn rows_that_nobody_wants_are_not_computed() {
    let p = scene(|d| pendulum(d, "bob", 0.0));
    let wanted = OutputRequest {
        rows: Rows::Ends,
        accelerations: false,
        reactions: Reactions::None,
        ..OutputRequest::default()
    };
    let plan = Plan::new(&p, &to(2.0), &wanted).expect("a plan");
    let mut times = Vec::new();
    let ends = plan
        .simulate(|sample| {
            times.push(sample.t);
            Ok(ControlFlow::Continue(()))
        })
        .expect("moves");
    assert_eq!(times, [0.0, 2.0]);
    let all = go(&Plan::new(&p, &to(2.0), &OutputRequest::default()).expect("a plan"));
    assert_eq!(ends.steps, all.steps);
    assert!(
        ends.evaluations < all.evaluations,
        "{} {}",
        ends.evaluations,
        all.evaluations
    );
    // Steps are reported nevertheless, and may end the run.
    let mut rows = 0;
    let stopped = plan
        .simulate_watched(
            &|t| {
                if t < 0.5 {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            },
            &|| false,
            |_| {
                rows += 1;
                Ok(ControlFlow::Continue(()))
            },
        )
        .expect("moves");
    assert!(stopped.t < 2.0 && rows == 1, "{} {rows}", stopped.t);
}

/// A run of a pendulum with interpolated rows takes the same steps. In these rows, the violation of
/// the hinge constraint is at most the tolerance.
#[test]
fn interpolated_rows_are_those_on_the_constraints_to_the_tolerance() {
    let p = scene(|d| pendulum(d, "bob", 0.0));
    let states = |rows: Rows| {
        let wanted = OutputRequest {
            rows,
            accelerations: false,
            reactions: Reactions::None,
            ..OutputRequest::default()
        };
        let plan = Plan::new(&p, &to(2.0), &wanted).expect("a plan");
        let mut states = Vec::new();
        let summary = plan.simulate(|sample| {
            states.push((sample.t, [sample.q, sample.v].concat()));
            Ok(ControlFlow::Continue(()))
        });
        (states, summary.expect("moves"))
    };
    let (on, all) = states(Rows::Every);
    let (off, fewer) = states(Rows::Interpolated);
    assert_eq!(all.steps, fewer.steps);
    assert_eq!(on.len(), off.len());
    let mut largest = 0.0_f64;
    for ((t, x), (same, y)) in on.iter().zip(&off) {
        assert_eq!(t, same);
        let apart = x.iter().zip(y).map(|(x, y)| (x - y).abs());
        largest = apart.fold(largest, f64::max);
    }
    assert!(0.0 < largest && largest < 1e-6, "{largest:e}");
}

/// A mass of 1 kg on a spring of 1 N/m is released at 1 m and at 10 µm: `x = x₀·cos t`. Runs with
/// default tolerances are accurate to 1e-7 and to a nanometre, respectively.
#[test]
fn motions_without_stated_tolerances_have_the_digits_that_are_read() {
    for (x_0, most) in [(1.0, 1e-7), (1e-5, 1e-9)] {
        let p = scene(|d| {
            d.gravity = [0.0; 2];
            d.bodies.push(body("mass", [1.0 + x_0, 0.0]));
            let spring = SpringDamper::new([-9.0, 0.0], [0.0; 2], 1.0, 0.0);
            d.forces.push(Force {
                name: "spring".into(),
                bodies: vec![GROUND, BodyRef::Body(0)],
                element: Box::new(spring.with_free_length(10.0)),
                functions: Vec::new(),
            });
        });
        let mut largest = 0.0_f64;
        let plan = Plan::new(&p, &to(20.0), &OutputRequest::default()).expect("a plan");
        plan.simulate(|sample| {
            largest = largest.max((sample.q[0] - 1.0 - x_0 * sample.t.cos()).abs());
            Ok(ControlFlow::Continue(()))
        })
        .expect("moves");
        assert!(largest < most, "{x_0}: {largest:e}");
    }
}

/// One row: time, q, v, accelerations, reactions.
type Row = (f64, Vec<f64>, Vec<f64>, Vec<f64>, Vec<model::Reaction>);

fn record(
    p: &PreparedMechanism,
    options: &MotionOptions,
) -> (Vec<Row>, Result<Summary, Box<Failure>>) {
    let mut rows = Vec::new();
    let outcome = crate::simulate(p, options, |s| {
        let (a, reactions) = (s.acceleration()?, s.reactions()?.as_chosen().to_vec());
        rows.push((s.t, s.q.to_vec(), s.v.to_vec(), a, reactions));
        Ok(ControlFlow::Continue(()))
    });
    (rows, outcome)
}

#[test]
fn components_move_as_they_do_alone_and_each_at_its_own_pace() {
    let both = scene(|d| {
        stiff(d);
        pendulum(d, "bob", 0.0);
    });
    let [slow, fast] = [scene(stiff), scene(|d| pendulum(d, "bob", 0.0))];
    let options = to(2.0);
    let plan = Plan::new(&both, &options, &OutputRequest::default()).expect("a plan");
    let methods: Vec<Method> = plan
        .components
        .iter()
        .map(|c| c.decisions.method.value)
        .collect();
    assert_eq!(methods, [Method::Radau5, Method::Dop853]);
    let (rows, summary) = record(&both, &options);
    let summary = summary.expect("moves");
    let [(first, a), (second, b)] = [&slow, &fast].map(|p| record(p, &options));
    let (a, b) = (a.expect("moves"), b.expect("moves"));
    assert_eq!(rows.len(), 9);
    for (row, (first, second)) in rows.iter().zip(first.iter().zip(&second)) {
        assert_eq!((row.0, row.0), (first.0, second.0));
        assert_eq!(row.1, [first.1.as_slice(), &second.1].concat());
        assert_eq!(row.2, [first.2.as_slice(), &second.2].concat());
        assert_eq!(row.3, [first.3.as_slice(), &second.3].concat());
        assert_eq!(row.4, [first.4.as_slice(), &second.4].concat());
    }
    assert_eq!(summary.method, Method::Auto);
    assert_eq!(summary.evaluations, a.evaluations + b.evaluations);
    let own: Vec<u64> = summary
        .components
        .iter()
        .map(|c| c.summary.evaluations)
        .collect();
    assert_eq!(own, [a.evaluations, b.evaluations]);
    let bound =
        (a.energy_gap + b.energy_gap) / a.largest_kinetic_energy.max(b.largest_kinetic_energy);
    assert_eq!(summary.energy_balance, bound);
}

#[test]
fn the_first_component_to_stop_stops_all() {
    // An arm of length 1 rotates downwards, away from a rail at 0.8. Its rod of length 1 touches
    // the rail as long as sin t < 0.2.
    let p = scene(|d| {
        pendulum(d, "bob", 0.0);
        d.bodies.push(body("arm", [9.5, 0.0]));
        let pin = Revolute {
            s_i: [9.0, 0.0],
            s_j: [-0.5, 0.0],
        };
        let motor = RevoluteAngleDrive::new([9.0, 0.0], [-0.5, 0.0]);
        let arm = BodyRef::Body(1);
        d.joints.push(Joint::new("shoulder", &[GROUND, arm], pin));
        d.drives.push(Drive {
            name: "motor".into(),
            bodies: vec![GROUND, arm],
            element: Box::new(motor),
            motion: Function::constant_rate(-1.0).expect("finite"),
            tolerance: None,
        });
        d.bodies.push(body("block", [10.6, 0.8]));
        let rod = Distance::new([0.5, 0.0], [0.0; 2]);
        let block = BodyRef::Body(2);
        d.joints.push(Joint::new("rod", &[arm, block], rod));
        let slot = PinInSlot {
            s_i: [9.0, 0.8],
            s_j: [0.0; 2],
            axis: Direction::X,
        };
        d.joints.push(Joint::new("rail", &[GROUND, block], slot));
        d.joints
            .push(Joint::new("upright", &[GROUND, block], Angle::new()));
    });
    let plan = Plan::new(&p, &to(0.4), &OutputRequest::default()).expect("a plan");
    assert_eq!(plan.components.len(), 2);
    assert_eq!(
        plan.components[1].decisions.mobility.taken,
        "a function of time"
    );
    let (rows, outcome) = record(&p, &to(0.4));
    let failure = outcome.expect_err("the rod is too short");
    let MotionError::Component { component, .. } = &failure.error else {
        panic!("{}", failure.error);
    };
    assert_eq!(component, "arm, block");
    assert_eq!(failure.summary.components.len(), 2);
    let stopped = failure.summary.t;
    assert!(
        0.15 < stopped && stopped < 0.2_f64.asin() + 1e-6,
        "{stopped}"
    );
    // All rows before the failure remain valid. There is one row every 0.05 s.
    assert_eq!(rows.len(), (stopped / 0.05).floor() as usize + 1);
}

/// Returns the calls of the kernels of the first joint in a run with this plan, without the calls
/// at the start.
fn calls(
    build: impl FnOnce(&mut Description),
    options: &MotionOptions,
    wanted: &OutputRequest,
) -> Calls {
    let mut notes = None;
    let p = scene(|d| {
        build(d);
        notes = Some(watch(&mut d.joints[0]));
    });
    let notes = notes.expect("there is a joint");
    let plan = Plan::new(&p, options, wanted).expect("a plan");
    take(&notes);
    go(&plan);
    take(&notes)
}

#[test]
fn kernels_of_what_is_left_out_are_not_called() {
    let everything = OutputRequest::default();
    let fall = |d: &mut Description| pendulum(d, "bob", 0.0);
    let calls = |wanted: &OutputRequest, method| {
        let options = MotionOptions { method, ..to(1.0) };
        calls(fall, &options, wanted)
    };
    let all = calls(&everything, Method::Dop853);
    assert!(all.phi > 0 && all.c > 0 && all.gamma > 0, "{all:?}");
    assert_eq!(
        (all.b, all.derivatives),
        (0, 0),
        "nothing depends on time, nothing is stiff"
    );
    assert_eq!(all.wrench, 9, "one for each row");
    let nobody = OutputRequest {
        reactions: Reactions::None,
        ..OutputRequest::default()
    };
    assert_eq!(calls(&nobody, Method::Dop853).wrench, 0);
    assert!(calls(&everything, Method::Radau5).derivatives > 0);
}

#[test]
fn a_component_does_not_work_for_another() {
    let fall = |d: &mut Description| pendulum(d, "bob", 0.0);
    let both = |d: &mut Description| {
        pendulum(d, "bob", 0.0);
        stiff(d);
    };
    // For rows that are passed on together, only the requested values are computed in advance.
    let wanted = OutputRequest {
        accelerations: false,
        ..OutputRequest::default()
    };
    let [with, alone] = [
        calls(both, &to(1.0), &wanted),
        calls(fall, &to(1.0), &wanted),
    ];
    assert!(with == alone, "{} and {} of C", with.c, alone.c);
}

/// Adds a block on a rail through the ground. The slope of the rail is 0.6 in 1. A drive moves the
/// block along the rail, and a weight is suspended from the block.
fn guided(d: &mut Description) {
    let axis = Direction::new([0.8, 0.6]).expect("a direction");
    let [block, held, bob] = [0, 1, 2].map(BodyRef::Body);
    d.bodies.push(Body {
        angle: 0.7,
        ..body("block", [0.0, 0.0])
    });
    d.bodies.push(body("held", [2.0, 1.0]));
    d.bodies.push(body("bob", [1.0, -1.0]));
    let rail = Translational::new([0.0; 2], [0.3, 0.2], axis);
    let mut rail = Joint::new("rail", &[GROUND, block], rail);
    // The sliding point of the block is on the rail.
    d.bodies[0].position = [
        -(0.7_f64.cos() * 0.3 - 0.7_f64.sin() * 0.2),
        -(0.7_f64.sin() * 0.3 + 0.7_f64.cos() * 0.2),
    ];
    rail.name = "rail".into();
    d.joints.push(rail);
    d.joints
        .push(Joint::new("hold", &[block, held], Angle::new()));
    let pin = |name: &str, i, j, at: [f64; 2], bodies: &[Body]| {
        let local = |b| match b {
            BodyRef::Ground => at,
            BodyRef::Body(k) => bodies[k].pose().to_local(at),
        };
        Joint::new(
            name,
            &[i, j],
            Revolute {
                s_i: local(i),
                s_j: local(j),
            },
        )
    };
    d.joints
        .push(pin("hook", block, bob, [0.5, -0.5], &d.bodies));
    d.joints.push(pin("tie", held, bob, [1.5, 0.0], &d.bodies));
    let motor = joints::TranslationalDisplacementDrive::new([0.0; 2], [0.3, 0.2], axis);
    d.drives.push(Drive {
        name: "motor".into(),
        bodies: vec![GROUND, block],
        element: Box::new(motor),
        motion: Function::harmonic(0.3, 5.0, 0.2, 0.0).expect("finite"),
        tolerance: None,
    });
}

#[test]
fn bodies_that_do_not_turn_have_one_sine_and_cosine() {
    let p = scene(guided);
    let plan = Plan::new(&p, &to(2.0), &OutputRequest::default()).expect("a plan");
    let turning = &plan.components[0].decisions.turning;
    assert_eq!((turning.value, turning.taken.as_str()), (1, "1 of 3"));
    for turn in 0..2 {
        let seen = calls(
            |d| {
                guided(d);
                d.joints.swap(0, turn);
            },
            &to(2.0),
            &OutputRequest::default(),
        );
        assert_eq!(seen.sines.len(), 1, "joint {turn}: {:?}", seen.sines);
        // Rows of angles have a constant C and no Γ.
        assert_eq!((seen.c == 0, seen.gamma == 0), (turn == 1, turn == 1));
        assert!(seen.phi > 0);
    }
}

#[test]
fn too_many_components_stay_one() {
    let free = |n: usize| {
        scene(|d| {
            let one = |k: usize| body(&format!("body {k}"), [k as f64, 0.0]);
            d.bodies = (0..n).map(one).collect();
        })
    };
    let components = |p: &PreparedMechanism| {
        let plan = Plan::new(p, &to(1.0), &OutputRequest::default()).expect("a plan");
        (plan.components.len(), plan.apart.reason)
    };
    assert_eq!(components(&free(256)).0, 256);
    let (n, reason) = components(&free(257));
    assert_eq!(
        (n, reason.split(',').next()),
        (1, Some("257 independent components"))
    );
    // The bodies fall nevertheless.
    let (rows, _) = record(&free(256), &to(1.0));
    let fallen = rows.last().expect("there are rows").1[3 * 40 + 1];
    assert!((fallen + 0.5 * 9.81).abs() < 1e-12, "{fallen}");
}

/// If there are too many free bodies for separate threads, the bodies are solved together, without
/// a matrix of all their velocities.
#[test]
fn free_bodies_take_memory_in_proportion() {
    let of = |count: usize| {
        let free = scene(|d| {
            let bodies = (0..count).map(|k| body(&format!("b{k}"), [k as f64, 0.0]));
            d.bodies.extend(bodies);
        });
        free.memory(Method::Auto)
    };
    let (few, many) = (of(400), of(4000));
    assert!(many < 11 * few, "{few} and {many} bytes");
    // Some hundred values of eight bytes for each velocity.
    assert!(many < 4000 * 3 * 256 * 8, "{many} bytes");
}
