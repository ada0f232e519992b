//! Loads of force elements against closed forms, and the balance of all loads on each body.

use std::ops::ControlFlow;

use pfaff::dynamics::{MotionOptions, OutputRequest, Plan, Sample};
use pfaff::model::space::norm;
use pfaff::model::{Load, Mechanism, Registry, SpaceKind, System};
use pfaff::{RunOptions, Study};

fn study(text: &str) -> Study {
    let options = RunOptions::default();
    Study::read("scene.toml", text, &Registry::standard(), &options)
        .unwrap_or_else(|e| panic!("{e}"))
}

/// The load of the only force of a scene with one or two bodies, at velocities v.
fn load(text: &str, v: &[f64]) -> Load {
    let study = study(text);
    let prepared = &study.prepared;
    let mut v_all = vec![0.0; prepared.v.len()];
    v_all[..v.len()].copy_from_slice(v);
    let loads = prepared.mechanism.loads().at(0.0, &prepared.q, &v_all);
    assert_eq!(loads.len(), 1);
    loads[0]
}

fn assert_near(found: [f64; 3], expected: [f64; 3], what: &str) {
    let error = (0..3).map(|k| (found[k] - expected[k]).abs());
    let error = error.fold(0.0, f64::max);
    assert!(error < 1e-12, "{what}: {found:?}, expected {expected:?}");
}

const PLANE: &str = r#"
scene = { name = "loads", space = "plane" }
body = [
    { name = "a", mass = 2.0, inertia = 0.5, position = [3.0, 0.0], angle = 1.5707963267948966 },
    { name = "b", mass = 1.0, inertia = 0.5, position = [3.0, 5.0] },
]
"#;

const SPACE: &str = r#"
scene = { name = "loads", space = "spatial" }
body = [
    { name = "a", mass = 2.0, inertia = [0.1, 0.2, 0.25], position = [3.0, 0.0, 1.0], orientation = { axis = [0, 0, 1], angle = 1.5707963267948966 } },
    { name = "b", mass = 1.0, inertia = [0.1, 0.2, 0.25], position = [3.0, 5.0, 1.0] },
]
"#;

#[test]
fn loads_of_the_plane_are_those_by_hand() {
    let of = |force: &str, v: &[f64]| load(&format!("{PLANE}force = [{force}]"), v);
    // From (3, 1) on `a`, one metre ahead of its centre, to (3, 5): length 4, 1 shorter than at
    // rest. The end on `a` moves by its rotation of 2 rad/s with (−2, 0), `b` with (0, 3).
    let v = [0.0, 0.0, 2.0, 0.0, 3.0, 0.0];
    let spring = r#"{ name = "f", type = "spring-damper", bodies = ["a", "b"], points = { a = [1.0, 0.0], b = [0.0, 0.0] }, stiffness = 10.0, damping = 2.0, free_length = 5.0 }"#;
    let found = of(spring, &v);
    // The tension −10 + 2·3 = −4 pulls `a` towards `b`.
    assert_near(found.wrench.force, [0.0, -4.0, 0.0], "spring");
    assert_near(found.wrench.torque, [0.0; 3], "about its own point");
    assert_near(found.place, [3.0, 1.0, 0.0], "place");
    let [length, rate] = found.measure.expect("a length");
    assert!((length - 4.0).abs() < 1e-12 && (rate - 3.0).abs() < 1e-12);
    // The first body is the ground: the load on it is opposite.
    let ground = spring.replace(
        "[\"a\", \"b\"], points = { a = [1.0, 0.0], b = [0.0, 0.0] }",
        "[\"ground\", \"b\"], points = { ground = [3.0, 1.0], b = [0.0, 0.0] }",
    );
    assert_near(of(&ground, &v).wrench.force, [0.0, -4.0, 0.0], "ground");

    // A torque of the spring on `b` of −3·(0 − π/2 − 0.5) − 0.5·(1 − 2).
    let torsion = r#"{ name = "f", type = "torsion-spring-damper", bodies = ["a", "b"], stiffness = 3.0, damping = 0.5, free_angle = 0.5 }"#;
    let quarter = std::f64::consts::FRAC_PI_2;
    let found = of(torsion, &[0.0, 0.0, 2.0, 0.0, 0.0, 1.0]);
    let on_b = 3.0 * (quarter + 0.5) + 0.5;
    assert_near(found.wrench.torque, [0.0, 0.0, -on_b], "torsion");
    let [angle, rate] = found.measure.expect("an angle");
    assert!((angle + quarter).abs() < 1e-12 && (rate + 1.0).abs() < 1e-12);

    let push =
        r#"{ name = "f", type = "point-force", body = "a", at = [3.0, 2.0], force = [5.0, 0.0] }"#;
    let found = of(push, &[]);
    assert_near(found.wrench.force, [5.0, 0.0, 0.0], "push");
    assert_near(found.wrench.torque, [0.0; 3], "about its point");
    assert_eq!(found.measure, None);
    let turn = r#"{ name = "f", type = "torque", bodies = ["a", "b"], torque = 7.0 }"#;
    assert_near(of(turn, &[]).wrench.torque, [0.0, 0.0, -7.0], "torque");
    // At the speed 4 along the tyre and 3 across it: −20·3/√(4² + 0) across, which is −y here,
    // because `a` is turned by a quarter and its y axis is −x of the ground.
    let tyre = r#"{ name = "f", type = "tyre", body = "a", point = [0.5, 0.0], normal = [0.0, 1.0], stiffness = 20.0, low_speed = 1e-9 }"#;
    assert_near(
        of(tyre, &[-3.0, 4.0]).wrench.force,
        [15.0, 0.0, 0.0],
        "tyre",
    );
}

#[test]
fn loads_in_space_are_those_by_hand() {
    let of = |force: &str, v: &[f64]| load(&format!("{SPACE}force = [{force}]"), v);
    // The columns of v are the velocity of the centre and the angular velocity about own axes.
    let v = [0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 3.0];
    let spring = r#"{ name = "f", type = "spring-damper", bodies = ["a", "b"], points = { a = [1.0, 0.0, 0.0], b = [0.0, 0.0, 0.0] }, stiffness = 10.0, damping = 2.0, free_length = 5.0 }"#;
    let found = of(spring, &v);
    assert_near(found.wrench.force, [0.0, -4.0, 0.0], "spring");
    assert_near(found.place, [3.0, 1.0, 1.0], "place");
    let [length, rate] = found.measure.expect("a length");
    assert!((length - 4.0).abs() < 1e-12 && (rate - 3.0).abs() < 1e-12);
    let push = r#"{ name = "f", type = "point-force", frame = "body", body = "a", point = [0.0, 0.0, 2.0], force = [5.0, 0.0, 0.0] }"#;
    let found = of(push, &[]);
    assert_near(
        found.wrench.force,
        [0.0, 5.0, 0.0],
        "the x axis of `a` is y",
    );
    assert_near(found.wrench.torque, [0.0; 3], "about its point");
    // A bushing at (3, 2, 1): `b` moves away with (0, 3, 0), so the damper pulls `a` after it.
    let bushing = r#"{ name = "f", type = "bushing", bodies = ["a", "b"], at = [3.0, 2.0, 1.0], stiffness = [1, 1, 1, 0, 0, 0], damping = [4, 0, 0, 0, 0, 6] }"#;
    let found = of(
        bushing,
        &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.5],
    );
    assert_near(
        found.wrench.force,
        [0.0, 12.0, 0.0],
        "along the x axis of `a`",
    );
    assert_near(found.wrench.torque, [0.0, 0.0, 3.0], "about z");
}

/// Adds the moment of a force at a place about another point.
fn moved(force: [f64; 3], torque: [f64; 3], arm: [f64; 3]) -> [f64; 3] {
    [
        torque[0] + arm[1] * force[2] - arm[2] * force[1],
        torque[1] + arm[2] * force[0] - arm[0] * force[2],
        torque[2] + arm[0] * force[1] - arm[1] * force[0],
    ]
}

/// The largest imbalance of the loads on a body relative to the largest of them: joints and drives
/// of one solution, force elements on both bodies, weight and inertia.
pub(crate) fn imbalance(study: &Study, sample: &mut Sample<'_, '_>) -> f64 {
    let mechanism: &Mechanism = &study.prepared.mechanism;
    let space = mechanism.space();
    let lambda = sample.multipliers().expect("solved");
    let lambda = lambda.as_chosen();
    let a = sample.acceleration().expect("solved");
    let mut s = mechanism.scratch();
    let t = mechanism.layout().before_break(sample.t);
    mechanism.pose(t, sample.q, &mut s);
    mechanism.c(&mut s);
    let loads = mechanism.loads().at(t, sample.q, sample.v);
    let forces: Vec<_> = mechanism.applied_forces().iter().collect();
    let reactions = mechanism.reactions(&s);
    let places = mechanism
        .layout()
        .constraint_ids()
        .map(|id| reactions.place(id));
    let apart = places.map(|p| [0, 1, 2].map(|k| p[k] - s.bodies.origin(0)[k]));
    let size = apart.map(|d| norm(&d)).fold(0.1, f64::max);
    let (mut worst, mut largest): (f64, f64) = (0.0, 0.0);
    for body in 0..mechanism.bodies().len() {
        let centre = s.bodies.origin(body);
        let mut parts: Vec<([f64; 3], [f64; 3])> = Vec::new();
        let map = mechanism.reactions(&s).body_wrench_map(body, centre);
        let map = map.expect("a body");
        let rows = 0..lambda.len();
        let component = |k: usize| rows.clone().map(|i| map[(k, i)] * lambda[i]).sum::<f64>();
        let spread = |values: &dyn Fn(usize) -> f64| {
            let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
            for k in space.forces() {
                force[k] = values(k);
            }
            for k in space.torques() {
                torque[space.axis_of(k)] = values(k);
            }
            (force, torque)
        };
        parts.push(spread(&component));
        for (force, load) in forces.iter().zip(&loads) {
            let place = force.bodies.iter().position(|b| b.moving() == Some(body));
            let sign = match place {
                None => continue,
                Some(0) => 1.0,
                Some(_) => -1.0,
            };
            let push = load.wrench.force.map(|x| sign * x);
            let arm = [0, 1, 2].map(|k| load.place[k] - centre[k]);
            let turn = moved(push, load.wrench.torque.map(|x| sign * x), arm);
            parts.push((push, turn));
        }
        let columns = space.columns_of(body);
        let (mass, weight) = (mechanism.mass(), mechanism.weight());
        let (force, _) = spread(&|k| weight[columns.start + k]);
        parts.push((force, [0.0; 3]));
        let (inertia, mut turning) = spread(&|k| -mass[columns.start + k] * a[columns.start + k]);
        if space == SpaceKind::Space3 {
            // The equation of Euler in the axes of the body.
            let (j, w) = (&mass[columns.start + 3..], &sample.v[columns.start + 3..]);
            let own = moved(
                [j[0] * w[0], j[1] * w[1], j[2] * w[2]],
                [0.0; 3],
                [w[0], w[1], w[2]],
            );
            turning = s
                .bodies
                .turned(body, [0, 1, 2].map(|k| turning[k] - own[k]));
        }
        parts.push((inertia, turning));
        let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
        for (f, t) in parts {
            for k in 0..3 {
                force[k] += f[k];
                torque[k] += t[k];
                largest = largest.max(f[k].abs()).max(t[k].abs() / size);
            }
        }
        let of_body = force
            .map(f64::abs)
            .into_iter()
            .chain(torque.map(|x| x.abs() / size));
        worst = of_body.fold(worst, f64::max);
    }
    if largest == 0.0 { 0.0 } else { worst / largest }
}

#[test]
fn loads_on_each_body_of_the_examples_balance() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    let scenes = std::fs::read_dir(folder).expect("examples");
    let scenes = scenes.filter_map(|entry| {
        let path = entry.expect("an entry").path();
        (path.extension()? == "toml").then_some(path)
    });
    let (mut rows, mut with_forces) = (0, 0);
    for path in scenes {
        let text = std::fs::read_to_string(&path).expect("readable");
        let options = RunOptions::default();
        // Scenes that cannot move have no run.
        let Ok(study) = Study::read("scene.toml", &text, &Registry::standard(), &options) else {
            continue;
        };
        let Some(options) = study.options.clone() else {
            continue;
        };
        let short = MotionOptions {
            t_end: options.t_end.min(0.5),
            ..options
        };
        let plan = Plan::new(&study.prepared, &short, &OutputRequest::default()).expect("a plan");
        with_forces += usize::from(!study.prepared.mechanism.applied_forces().is_empty());
        let mut worst = (0.0, 0.0);
        let run = plan.simulate(|sample: &mut Sample<'_, '_>| {
            let found = imbalance(&study, sample);
            // Rows near singular configurations have no multipliers.
            if found > worst.0 {
                worst = (found, sample.t);
            }
            rows += 1;
            Ok(ControlFlow::Continue(()))
        });
        assert!(run.is_ok(), "{}", path.display());
        assert!(
            worst.0 < 1e-9,
            "{}: {:e} at {} s",
            path.display(),
            worst.0,
            worst.1
        );
    }
    assert!(
        rows > 1000 && with_forces > 3,
        "{rows} rows, {with_forces} scenes with forces"
    );
}
