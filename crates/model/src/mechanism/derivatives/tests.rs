//! Compares the assembled derivatives with central differences of the assembled equations, for a
//! mechanism with constraints and forces of every kind, at a state that violates its constraints.

use joints::plane::Direction;
use joints::{
    Bushing, Distance, KnifeEdge, Revolute, RevoluteAngleDrive, Rolling, SpringDamper,
    TorsionSpringDamper, Translational, Velocity,
};

use super::*;
use crate::description::{Body, BodyRef, Description, Drive, Force, Joint};
use crate::element::ForceKernels;
use crate::function::Function;
use crate::system::System;

const G: BodyRef = BodyRef::Ground;
const fn b(k: usize) -> BodyRef {
    BodyRef::Body(k)
}

fn force(name: &str, bodies: [BodyRef; 2], element: impl ForceKernels + 'static) -> Force {
    Force {
        name: name.into(),
        bodies: bodies.to_vec(),
        element: Box::new(element),
        functions: Vec::new(),
    }
}

fn mechanism() -> Mechanism {
    let bodies = (0..4)
        .map(|k| Body {
            name: format!("body {k}"),
            mass: 1.0,
            inertia: 0.5,
            position: [f64::from(k), 0.4 * f64::from(k * k)],
            angle: 0.3 * f64::from(k),
            ..Body::default()
        })
        .collect();
    let axis = Direction::new([0.6, 0.8]).expect("a direction");
    let swing = Function::harmonic(0.2, 3.0, 0.1, 0.0).expect("finite");
    let pivot = Revolute {
        s_i: [0.1, 0.2],
        s_j: [-0.3, 0.5],
    };
    let slide = Translational::new([0.2, -0.1], [0.4, 0.3], axis);
    let rod = Distance::new([0.3, 0.0], [0.0, -0.2]);
    let edge = KnifeEdge {
        s: [0.5, 0.1],
        normal: axis,
    };
    let wheel = Rolling {
        s: [0.2, 0.2],
        direction: axis,
        radius: 0.3,
    };
    let mut pushed = Joint::new(
        "pushed",
        &[b(3)],
        Velocity {
            s: [0.1, -0.4],
            direction: axis,
        },
    );
    pushed.functions.push(swing.clone());
    let drive = Drive {
        name: "drive".into(),
        bodies: vec![G, b(0)],
        element: Box::new(RevoluteAngleDrive::new([0.1, 0.2], [-0.3, 0.5])),
        motion: swing,
        tolerance: None,
    };
    let spring = SpringDamper::new([0.2, 0.1], [-0.2, 0.3], 7.0, 0.9);
    let torsion = TorsionSpringDamper::new(3.0, 0.4);
    let bushing = Bushing::new([0.3, 0.2], [0.1, 0.1], [5.0, 4.0, 3.0], [0.5, 0.4, 0.3]);
    let d = Description {
        gravity: [0.3, -9.81],
        bodies,
        joints: vec![
            Joint::new("pivot", &[G, b(0)], pivot),
            Joint::new("slide", &[b(0), b(1)], slide),
            Joint::new("rod", &[b(1), b(2)], rod),
            Joint::new("edge", &[b(2)], edge),
            Joint::new("wheel", &[b(2), b(3)], wheel),
            pushed,
        ],
        drives: vec![drive],
        forces: vec![
            force("spring", [b(0), b(2)], spring),
            force("torsion", [G, b(3)], torsion),
            force("bushing", [b(1), b(3)], bushing),
        ],
        ..Description::default()
    };
    Mechanism::build(&d).expect("a mechanism")
}

/// The values to be differentiated: Q, Cᵀ·λ, C·a − Γ, Γ, C·v − b.
type Equations = [Vec<f64>; 5];

fn equations(m: &Mechanism, q: &[f64], v: &[f64], a: &[f64], lambda: &[f64]) -> Equations {
    let mut s = m.scratch();
    m.pose(0.7, q, &mut s);
    m.c(&mut s);
    m.b(&mut s);
    m.twist(v, &mut s);
    m.gamma(&mut s);
    m.force(&mut s);
    let c = m.layout().dense(&s);
    let less = |x: Vec<f64>, y: &[f64]| x.iter().zip(y).map(|(x, y)| x - y).collect();
    [
        s.force.clone(),
        c.transpose_times(lambda),
        less(c.times(a), &s.gamma),
        s.gamma.clone(),
        less(c.times(v), &s.b),
    ]
}

/// Returns values between −1 and 1 without a regular pattern.
fn numbers(n: usize, seed: f64) -> Vec<f64> {
    (0..n)
        .map(|k| ((k as f64 + seed) * 12.9898).sin() * 43.7)
        .map(|x| 2.0 * (x - x.floor()) - 1.0)
        .collect()
}

#[test]
fn products_are_differences_of_the_equations() {
    const H: f64 = 1e-5;
    let m = mechanism();
    let layout = m.layout();
    let (n, rows) = (layout.n_v, layout.rows());
    for seed in 0..8 {
        let [q, v, a, along] = [0.1, 0.2, 0.3, 0.4].map(|x| numbers(n, f64::from(seed) + x));
        let lambda = numbers(rows, f64::from(seed) + 0.5);
        let mut d = Derivatives::of(&m).expect("none is called");
        let mut s = m.scratch();
        m.pose(0.7, &q, &mut s);
        m.twist(&v, &mut s);
        d.differentiate(&m, &a, &lambda, &s);
        let moved = |x: &[f64], h: f64| -> Vec<f64> {
            x.iter().zip(&along).map(|(x, d)| x + h * d).collect()
        };
        let dq = [1.0, -1.0].map(|h| equations(&m, &moved(&q, h * H), &v, &a, &lambda));
        let dv = [1.0, -1.0].map(|h| equations(&m, &q, &moved(&v, h * H), &a, &lambda));
        let check = |name: &str, matrix: &Sparse, [plus, minus]: &[Equations; 2], k: usize| {
            let mut found = vec![0.0; plus[k].len()];
            matrix.add_product(&along, &mut found);
            for (i, found) in found.iter().enumerate() {
                let expected = (plus[k][i] - minus[k][i]) / (2.0 * H);
                // The truncation error is H² times the third derivative; a stiffness of 7 acts on
                // lengths that may be near 0.1.
                assert!(
                    (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                    "{name}, seed {seed}, row {i}: {found}, by differences {expected}"
                );
            }
        };
        check("∂Q/∂q", &d.force_dq, &dq, 0);
        check("∂Q/∂v", &d.force_dv, &dv, 0);
        check("∂(Cᵀλ)/∂q", &d.reaction_dq, &dq, 1);
        check("∂(C·a − Γ)/∂q", &d.residual_dq, &dq, 2);
        check("∂Γ/∂v", &d.gamma_dv, &dv, 3);
        check("∂(C·v − b)/∂q", &d.velocity_dq, &dq, 4);
    }
}
