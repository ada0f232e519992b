//! Tests that stiff motions are computed by an implicit method.

use super::*;
use joints::TorsionSpringDamper;

/// Adds a body that a revolute joint connects to another body, with a spring (N·m/rad) and a damper
/// (N·m·s/rad) in the joint.
fn link(d: &mut Description, at: (Body, [[f64; 2]; 2]), [stiffness, damping]: [f64; 2]) {
    let k = d.bodies.len();
    let before = k.checked_sub(1).map_or(GROUND, BodyRef::Body);
    let (body, [s_i, s_j]) = at;
    let bodies = [before, BodyRef::Body(k)];
    let pin = format!("pin of {}", body.name);
    d.joints
        .push(Joint::new(&pin, &bodies, Revolute { s_i, s_j }));
    d.forces.push(Force {
        name: format!("spring of {}", body.name),
        bodies: bodies.to_vec(),
        element: Box::new(TorsionSpringDamper::new(stiffness, damping).with_free_angle(0.0)),
        functions: Vec::new(),
    });
    d.bodies.push(body);
}

fn method_of(p: &PreparedMechanism, options: &MotionOptions) -> (Method, String) {
    let plan = Plan::new(p, options, &OutputRequest::default()).expect("a plan");
    let method = &plan.components[0].decisions.method;
    (method.value, method.reason.clone())
}

/// A wheel oscillates with 1 rad/s on a torsion spring and carries a light wheel. A damper between
/// the wheels makes the light wheel follow, or a spring makes it oscillate.
#[test]
fn fast_decays_are_stiff_and_oscillations_are_not() {
    let wheels = |[stiffness, damping]: [f64; 2]| {
        scene(|d| {
            let wheel = |name: &str, inertia| Body {
                inertia,
                ..body(name, [0.0, 0.0])
            };
            let centred = [[0.0; 2]; 2];
            link(d, (wheel("heavy", 1.0), centred), [1.0, 0.0]);
            let inertia = 1e-3;
            let of_light = [stiffness * inertia, damping * inertia];
            link(d, (wheel("light", inertia), centred), of_light);
        })
    };
    let method = |[stiffness, damping]: [f64; 2], rtol| {
        let options = MotionOptions { rtol, ..to(60.0) };
        method_of(&wheels([stiffness, damping]), &options)
    };
    for (coefficients, rtol, expected) in [
        ([0.0, 10.0], 1e-6, Method::Dop853),
        ([0.0, 50.0], 1e-6, Method::Dop853),
        ([0.0, 300.0], 1e-6, Method::Radau5),
        ([0.0, 300.0], 1e-10, Method::Dop853),
        ([300.0 * 300.0, 0.0], 1e-6, Method::Dop853),
        ([300.0 * 300.0, 600.0], 1e-6, Method::Radau5),
    ] {
        let (found, why) = method(coefficients, rtol);
        assert_eq!(found, expected, "{coefficients:?}, {rtol}: {why}");
    }
}

/// Strong dampers make 40 links one rod, whose small oscillations about an end have the frequency
/// √(3·g/(2·L)). Longer chains than the estimate permits are computed explicitly.
#[test]
fn stiff_chains_are_implicit_with_many_free_motions() {
    let (length, first): (f64, f64) = (0.05, 1e-3);
    let chain = |count: usize| {
        scene(|d| {
            let (along, half) = ([first.sin(), -first.cos()], 0.5 * length);
            for k in 0..count {
                let distance = (k as f64 + 0.5) * length;
                let rod = Body {
                    inertia: length * length / 12.0,
                    angle: first,
                    ..body(&format!("link {k}"), along.map(|x| x * distance))
                };
                let before = if k == 0 { [0.0; 2] } else { [0.0, -half] };
                let damping = if k == 0 { 0.0 } else { 1e7 };
                link(d, (rod, [before, [0.0, half]]), [0.0, damping]);
            }
        })
    };
    let (p, options) = (chain(40), to(0.5));
    assert_eq!(method_of(&p, &options).0, Method::Radau5);
    let (rows, outcome) = record(&p, &options);
    outcome.expect("moves");
    let omega = (1.5 * 9.81 / (40.0 * length)).sqrt();
    for (t, q, ..) in &rows {
        let expected = first * (omega * t).cos();
        for k in [0, 19, 39] {
            let found = q[3 * k + 2];
            assert!(
                (found - expected).abs() < 2e-7,
                "{t}, {k}: {found} for {expected}"
            );
        }
    }
    let (method, why) = method_of(&chain(201), &options);
    assert_eq!(method, Method::Dop853, "{why}");
    assert!(why.contains("many free motions"), "{why}");
}

/// Implicit methods are refused where their matrices would be too large.
#[test]
fn too_many_free_motions_for_implicit_methods_are_refused_by_name() {
    let free = scene(|d| {
        let bodies = (0..342).map(|k| body(&format!("b{k}"), [k as f64, 0.0]));
        d.bodies.extend(bodies);
    });
    let options = MotionOptions {
        method: Method::Radau5,
        ..to(1.0)
    };
    let refused = Plan::new(&free, &options, &OutputRequest::default());
    let refused = refused.err().expect("1026 free motions").to_string();
    assert!(
        refused.contains("Schur complement") && refused.contains("explicit"),
        "{refused}"
    );
}
