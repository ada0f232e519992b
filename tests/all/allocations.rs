//! An evaluation of the right-hand side allocates no memory, once the order of elimination has been
//! chosen at the start.

use dynamics::{KeptRowMotion, Method, MotionOptions, RowChoice, prepare};
use model::{Mechanism, StartOptions};
use solvability::ChosenValues;
use tests::robot::{robot, steering};

#[test]
fn evaluations_and_projections_allocate_nothing() {
    allocate_nothing(&robot(steering()));
    let mut armed = robot(steering());
    let pin = { armed.joints.iter() }.find(|j| j.element.spec().common.scene_type == "revolute");
    let (name, bodies) = pin
        .map(|j| (j.name.clone(), j.bodies.clone()))
        .expect("a pin");
    // The angle needs no points.
    let angle = joints::RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    armed.armature(&name, &bodies, angle, 0.3);
    allocate_nothing(&armed);
}

fn allocate_nothing(robot: &model::Description) {
    let mechanism = Mechanism::build(robot).expect("the robot builds");
    let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts");
    let mut motion = KeptRowMotion::new(&p).expect("moves");
    let (mut q, mut v) = (p.q.clone(), p.v.clone());
    let mut a = vec![0.0; v.len()];
    let mut lambda = ChosenValues::new(vec![0.0; 22], vec![0; 2]);
    // The state is slightly off the constraints, so that the projection is not trivial.
    let push = |q: &mut [f64], v: &mut [f64]| {
        q[4] += 1e-6;
        v[7] += 1e-6;
    };
    push(&mut q, &mut v);
    motion.project(0.0, &mut q, &mut v).expect("projects");
    push(&mut q, &mut v);
    let counted = allocation_counter::measure(|| {
        for step in 0..10 {
            let t = 1e-3 * f64::from(step);
            motion.acceleration(t, &q, &v, &mut a).expect("regular");
            motion.multipliers(t, &q, &v, &mut lambda).expect("regular");
        }
        let correction = motion.project(0.0, &mut q, &mut v).expect("projects");
        assert!(correction.iterations > 0);
    });
    assert_eq!(counted.count_total, 0, "{counted:?}");
}

#[test]
fn accelerations_of_every_method_allocate_nothing() {
    let mechanism = Mechanism::build(&robot(steering())).expect("the robot builds");
    let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts");
    let mut a = vec![0.0; p.v.len()];
    for &method in Method::ALL {
        let options = MotionOptions {
            method,
            ..MotionOptions::to(1.0)
        };
        let mut motion = KeptRowMotion::with(&p, &options).expect("moves");
        motion
            .acceleration(0.0, &p.q, &p.v, &mut a)
            .expect("regular");
        let counted = allocation_counter::measure(|| {
            motion
                .acceleration(1.5, &p.q, &p.v, &mut a)
                .expect("regular");
        });
        assert_eq!(counted.count_total, 0, "{method:?}: {counted:?}");
    }
}
