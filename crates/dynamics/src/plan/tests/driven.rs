//! A mechanism without degrees of freedom: its state is a function of time.

use super::*;

const RADIUS: f64 = 0.5;
const RATE: f64 = 4.0;

/// A Scotch yoke: a crank with a pin in the slot of a slider on the ground. If the crank has the
/// angle ω·t, the slider is at r·cos ω·t. The damping is so large that the motion would be stiff if
/// there were a degree of freedom.
fn yoke(d: &mut Description) {
    let (crank, slider) = (BodyRef::Body(0), BodyRef::Body(1));
    d.bodies = vec![body("crank", [0.0; 2]), body("slider", [RADIUS, 0.0])];
    let pin = Revolute {
        s_i: [0.0; 2],
        s_j: [0.0; 2],
    };
    let rail = Translational::new([0.0; 2], [0.0; 2], Direction::X);
    let slot = PinInSlot {
        s_i: [0.0; 2],
        s_j: [RADIUS, 0.0],
        axis: Direction::Y,
    };
    d.joints = vec![
        Joint::new("bearing", &[GROUND, crank], pin),
        Joint::new("rail", &[GROUND, slider], rail),
        Joint::new("slot", &[slider, crank], slot),
    ];
    d.drives.push(Drive {
        name: "motor".into(),
        bodies: vec![GROUND, crank],
        element: Box::new(RevoluteAngleDrive::new([0.0; 2], [0.0; 2])),
        motion: Function::constant_rate(RATE).expect("finite"),
        tolerance: None,
    });
    let damper = SpringDamper::new([-3.0, 0.0], [0.0; 2], 0.0, 1e9);
    d.forces.push(Force {
        name: "damper".into(),
        bodies: vec![GROUND, slider],
        element: Box::new(damper),
        functions: Vec::new(),
    });
}

#[test]
fn it_is_evaluated_once_at_each_time_of_a_step() {
    let p = scene(yoke);
    // One evaluation of a step is at a time that has already been evaluated, because the last stage
    // is at the end of the step.
    for (method, again) in [(Method::Dop853, 1), (Method::Dopri5, 1)] {
        let options = MotionOptions { method, ..to(3.0) };
        let wanted = OutputRequest {
            reactions: Reactions::None,
            ..OutputRequest::default()
        };
        let plan = Plan::new(&p, &options, &wanted).expect("a plan");
        let mut summary = Summary::default();
        let run = || {
            summary = plan
                .simulate(|_| Ok(ControlFlow::Continue(())))
                .expect("moves");
        };
        let done = counted(run)(WorkKind::Accelerations) as u64;
        assert!(
            done + again * summary.steps <= summary.evaluations,
            "{method:?}: {done} of {} in {} steps",
            summary.evaluations,
            summary.steps
        );
    }
}

#[test]
fn it_is_where_its_drive_is_by_every_method() {
    let p = scene(yoke);
    for method in [Method::Auto, Method::Radau5, Method::Dopri5] {
        let options = MotionOptions {
            method,
            rtol: 1e-6,
            atol: 1e-6,
            ..to(3.0)
        };
        let plan = Plan::new(&p, &options, &OutputRequest::default()).expect("a plan");
        let taken = plan.components[0].decisions.method.value;
        assert!(
            taken != Method::Radau5,
            "nothing is stiff where nothing is free"
        );
        let (rows, outcome) = record(&p, &options);
        outcome.expect("moves");
        for (t, q, v, a, _) in rows {
            let (sin, cos) = (RATE * t).sin_cos();
            let exact = [
                RADIUS * cos,
                -RADIUS * RATE * sin,
                -RADIUS * RATE * RATE * cos,
            ];
            for (x, exact) in [q[3], v[3], a[3]].into_iter().zip(exact) {
                assert!(
                    (x - exact).abs() < 1e-13 * RATE * RATE,
                    "{method:?} at {t}: {x} {exact}"
                );
            }
        }
    }
}
