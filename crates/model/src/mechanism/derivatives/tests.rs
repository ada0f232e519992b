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

/// The load of armatures at fixed accelerations is −(M·a − diag(mass)·a) + gᵀ·a·γ. The terms with γ
/// are the change of Q.
fn armature_load(m: &Mechanism, q: &[f64], v: &[f64], a: &[f64]) -> Vec<f64> {
    let mut s = m.scratch();
    m.pose(0.0, q, &mut s);
    m.twist(v, &mut s);
    m.force(&mut s);
    let bare: Vec<f64> = m.mass().iter().zip(a).map(|(m, a)| m * a).collect();
    let mut without = m.clone();
    without.elements.armatures.clear();
    let mut other = without.scratch();
    without.pose(0.0, q, &mut other);
    without.twist(v, &mut other);
    without.force(&mut other);
    let inertia = m.inertia(&s).product(a);
    let terms = inertia
        .iter()
        .zip(&bare)
        .zip(s.force.iter().zip(&other.force));
    terms
        .map(|((all, bare), (q, without))| q - without - (all - bare))
        .collect()
}

/// Removes the part of v along the rows, by orthogonal directions.
fn make_tangent(c: &linalg::Matrix, v: &mut [f64]) {
    let mut directions: Vec<Vec<f64>> = Vec::new();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let remove = |x: &mut [f64], of: &[f64]| {
        let part = dot(x, of);
        x.iter_mut().zip(of).for_each(|(x, y)| *x -= part * y);
    };
    for i in 0..c.nrows() {
        let mut row = c.row(i).to_vec();
        directions.iter().for_each(|of| remove(&mut row, of));
        let length = dot(&row, &row).sqrt();
        directions.push(row.iter().map(|x| x / length).collect());
    }
    directions.iter().for_each(|of| remove(v, of));
}

/// In space, the velocities satisfy the rows of the joints, because the row of an angle is valid
/// only for parallel axes.
fn check_armatures(m: &Mechanism, q: &[f64]) {
    const H: f64 = 1e-5;
    let n = m.layout().n_v;
    for seed in 0..4 {
        let [mut v, a, along] = [0.2, 0.3, 0.4].map(|x| numbers(n, f64::from(seed) + x));
        let mut d = Derivatives::of_constraints(m);
        let mut s = m.scratch();
        m.pose(0.0, q, &mut s);
        m.c(&mut s);
        if m.space() == SpaceKind::Space3 {
            make_tangent(&m.layout().dense(&s), &mut v);
        }
        m.twist(&v, &mut s);
        d.differentiate_constraints(m, &a, &vec![0.0; m.layout().rows()], &s);
        let at = |h: f64| {
            let mut moved = q.to_vec();
            m.displace(&mut moved, &along.iter().map(|x| h * x).collect::<Vec<_>>());
            let other: Vec<f64> = v.iter().zip(&along).map(|(v, x)| v + h * x).collect();
            [
                armature_load(m, &moved, &v, &a),
                armature_load(m, q, &other, &a),
            ]
        };
        let (plus, minus) = (at(H), at(-H));
        for (k, matrix) in [&d.armature_dq, &d.armature_dv].into_iter().enumerate() {
            let mut found = vec![0.0; n];
            matrix.add_product(&along, &mut found);
            assert!(found.iter().any(|x| x.abs() > 1e-3), "{k}: {found:?}");
            for (i, found) in found.iter().enumerate() {
                let expected = (plus[k][i] - minus[k][i]) / (2.0 * H);
                assert!(
                    (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                    "{k}, seed {seed}, row {i}: {found}, by differences {expected}"
                );
            }
        }
        // The rate of the kinetic energy is the power of M·a without the quadratic terms of Q.
        let energy = |h: f64| {
            let mut moved = q.to_vec();
            m.displace(&mut moved, &v.iter().map(|x| h * x).collect::<Vec<_>>());
            let faster: Vec<f64> = v.iter().zip(&a).map(|(v, a)| v + h * a).collect();
            m.kinetic_energy(&moved, &faster)
        };
        m.force(&mut s);
        let rate = (energy(H) - energy(-H)) / (2.0 * H);
        let mut still = m.clone();
        still.weight.fill(0.0);
        let found = still.energy_rate(&s, &v, &a);
        assert!(
            (found - rate).abs() < 1e-6 * (1.0 + rate.abs()),
            "{found}, {rate}"
        );
    }
}

#[test]
fn loads_of_armatures_in_the_plane_have_their_derivatives() {
    let mut d = Description::new("slides");
    let axis = Direction::new([0.6, 0.8]).expect("a direction");
    let [one, other] = ["one", "other"].map(|name| d.body(Body::new(name, 1.0, 0.5)));
    let (s_i, s_j) = ([0.2, -0.1], [0.4, 0.3]);
    d.joint("slide", &[one, other], Translational::new(s_i, s_j, axis));
    d.joint("pin", &[G, one], Revolute::new(s_i, s_j));
    let slide = joints::TranslationalDisplacementDrive::new(s_i, s_j, axis);
    d.armature("slide", &[one, other], slide, 3.0);
    d.armature("pin", &[G, one], RevoluteAngleDrive::new(s_i, s_j), 0.7);
    let m = Mechanism::build(&d).expect("a mechanism");
    check_armatures(&m, &numbers(6, 0.1));
}

/// The rows of an angle in space are valid for parallel axes, so the state satisfies them.
#[test]
fn loads_of_armatures_in_space_have_their_derivatives() {
    use joints::space3::{self, Axes};

    use crate::{SpatialBody, SpatialDescription};
    let tensor = [[0.3, 0.05, 0.0], [0.05, 0.4, 0.02], [0.0, 0.02, 0.5]];
    let s_i = [0.2, -0.1, 0.3];
    let axes = Axes::new([0.0, 0.6, 0.8], None).expect("axes");
    let first = space3::Pose::new([0.3, -0.2, 0.5], [0.8, 0.1, -0.5, 0.3]);
    // The second body has turned by 0.7 rad about the axis and moved by 0.4 m along it.
    let (sin, cos) = 0.35_f64.sin_cos();
    let ([w, x, y, z], [u, v, t]) = ([0.8, 0.1, -0.5, 0.3], [0.0, 0.6 * sin, 0.8 * sin]);
    let turned = [
        w * cos - x * u - y * v - z * t,
        w * u + x * cos + y * t - z * v,
        w * v - x * t + y * cos + z * u,
        w * t + x * v - y * u + z * cos,
    ];
    let arm = space3::Pose::new([0.0; 3], turned).to_global(s_i);
    let at = first.to_global([0.2, -0.1 + 0.4 * 0.6, 0.3 + 0.4 * 0.8]);
    let place = [0, 1, 2].map(|k| at[k] - arm[k]);
    let mut d = SpatialDescription::new("joints");
    let poses = [([0.3, -0.2, 0.5], [w, x, y, z]), (place, turned)];
    let [one, other] = [0, 1].map(|k| {
        d.body(SpatialBody {
            position: poses[k].0,
            orientation: poses[k].1,
            ..SpatialBody::new(["one", "other"][k], 1.0, tensor)
        })
    });
    let both = [one, other];
    let pin = space3::Cylindrical {
        s_i,
        s_j: s_i,
        axis: axes,
        axis_j: axes,
    };
    d.joint("pin", &both, pin);
    let angle = space3::CylindricalAngleDrive::new(s_i, s_i, axes, axes);
    let along = space3::CylindricalDisplacementDrive::new(s_i, s_i, axes, axes);
    d.armature("pin", &both, angle, 0.7);
    d.armature("pin", &both, along, 2.0);
    let m = Mechanism::build(&d).expect("a mechanism");
    let (q, _) = m.described_state();
    let mut s = m.scratch();
    m.pose(0.0, &q, &mut s);
    m.phi(&mut s);
    assert!(s.phi.iter().all(|x| x.abs() < 1e-15), "{:?}", s.phi);
    check_armatures(&m, &q);
}
