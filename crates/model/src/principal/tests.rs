//! Tests one body in two descriptions: with a frame along its principal axes, and with a rotated
//! frame and products of inertia.

use joints::space3::{Axes, BodyPointForce, Pose, Revolute, SpringDamper};

use crate::description::{BodyRef, SpatialBody, SpatialDescription};
use crate::function::Function;
use crate::mechanism::{Derivatives, Mechanism, Sparse};
use crate::reaction::ConstraintId;
use crate::system::System;

/// A rotation by 3-4-5 angles about two axes. It transforms from the second frame to the principal
/// axes.
const BETWEEN: [f64; 4] = [0.48, 0.36, -0.64, 0.48];

const MOMENTS: [f64; 3] = [0.7, 1.1, 1.6];

/// A rotating body with a hinge and a spring. The frame of the body is rotated relative to its
/// principal axes.
fn described(between: [f64; 4]) -> Mechanism {
    let turn = Pose::new([0.0; 3], between);
    // Transforms a vector from the principal axes to the body frame.
    let framed = |v: [f64; 3]| turn.to_local(v);
    let inertia = [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            (0..3)
                .map(|k| turn.rot[k][i] * MOMENTS[k] * turn.rot[k][j])
                .sum()
        })
    });
    let symmetric: [[f64; 3]; 3] =
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| inertia[i.min(j)][i.max(j)]));
    let mut d = SpatialDescription::new("turned");
    d.gravity = [0.0, -3.0, 2.0];
    let body = d.body(SpatialBody {
        centre: framed([0.1, 0.2, -0.3]),
        orientation: between,
        velocity: Some([0.0; 3]),
        angular_velocity: Some([0.4, -1.2, 2.0]),
        ..SpatialBody::new("body", 2.0, symmetric)
    });
    let [s_i, s_j] = [BodyRef::Ground, body].map(|of| d.local(of, [0.0; 3]));
    let axis = Axes::FRAME;
    let axis_j = Axes::FRAME.map(framed);
    let hinge = Revolute {
        s_i,
        s_j,
        axis,
        axis_j,
    };
    d.joint("hinge", &[BodyRef::Ground, body], hinge);
    let [s_i, s_j] = [(BodyRef::Ground, [1.0, 2.0, 0.0]), (body, [0.6, -0.2, 0.4])]
        .map(|(of, p)| d.local(of, p));
    let spring = SpringDamper::new(s_i, s_j, 3.0, 0.5).with_free_length(0.7);
    d.force("spring", &[BodyRef::Ground, body], spring);
    // A force of 5 N along a direction fixed in the body.
    let push = BodyPointForce {
        s: d.local(body, [0.3, 0.1, 0.2]),
    };
    let thrust = framed([3.0, 0.0, 4.0]).map(|f| Function::constant(f).expect("a number"));
    d.force("thrust", &[body], push).functions = thrust.into();
    Mechanism::build(&d).expect("builds")
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-13 * (1.0 + a.abs())
}

#[test]
fn a_body_is_the_same_in_any_frame() {
    let told = [[1.0, 0.0, 0.0, 0.0], BETWEEN].map(|between| {
        let m = described(between);
        let (q, v) = m.described_state();
        let mut s = m.scratch();
        m.pose(0.0, &q, &mut s);
        m.twist(&v, &mut s);
        m.phi(&mut s);
        m.c(&mut s);
        m.gamma(&mut s);
        m.force(&mut s);
        // Force and torque in ground axes, including the gyroscopic torque.
        let axes = s.bodies.axes(0);
        let torque = [0, 1, 2].map(|k| (0..3).map(|a| axes[a][k] * s.force[3 + a]).sum::<f64>());
        let frame = m.frames().body(0, &q, &v);
        let of_hinge = m.reactions(&s);
        let wrench = of_hinge.wrench_map(ConstraintId(0));
        let marker = m.frames().point(0, [0.0; 3], &q, &v);
        let mut numbers: Vec<f64> = s.phi.clone();
        numbers.extend(&s.gamma);
        numbers.extend(&s.force[..3]);
        numbers.extend(torque);
        numbers.extend(
            frame
                .place
                .iter()
                .chain(&frame.velocity)
                .chain(&frame.omega),
        );
        numbers.extend(marker.place);
        numbers.extend((0..6).flat_map(|i| wrench.row(i).to_vec()));
        // The principal moments may be in another order.
        let mut mass = m.mass().to_vec();
        mass[3..].sort_by(f64::total_cmp);
        numbers.extend(mass);
        (numbers, frame.quaternion, m.bodies()[0].principal.is_some())
    });
    let [(a, q, diagonal), (b, p, turned)] = &told;
    assert_eq!((*diagonal, *turned), (false, true));
    assert_eq!(a.len(), b.len());
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        assert!(close(*a, *b), "{k}: {a} {b}");
    }
    // The frame of each body has the described pose.
    assert!(
        q.iter()
            .zip([1.0, 0.0, 0.0, 0.0])
            .all(|(a, b)| close(*a, b))
    );
    assert!(p.iter().zip(BETWEEN).all(|(a, b)| close(*a, b)), "{p:?}");
}

/// The derivatives of the force agree with difference quotients in both frames.
#[test]
fn derivatives_of_forces_are_their_slopes() {
    for between in [[1.0, 0.0, 0.0, 0.0], BETWEEN] {
        let m = described(between);
        let (q, v) = m.described_state();
        let force = |q: &[f64], v: &[f64]| {
            let mut s = m.scratch();
            m.pose(0.0, q, &mut s);
            m.twist(v, &mut s);
            m.force(&mut s);
            s.force
        };
        let mut s = m.scratch();
        m.pose(0.0, &q, &mut s);
        m.twist(&v, &mut s);
        let dense = |of: &Sparse| {
            let mut dense = [[0.0; 6]; 6];
            of.iter()
                .for_each(|(row, column, value)| dense[row][column] += value);
            dense
        };
        let told = Derivatives::of_forces(&m, &s).expect("none is called");
        let told = told.each_ref().map(dense);
        const STEP: f64 = 1e-6;
        for column in 0..6 {
            let moved = |sign: f64| {
                let mut step = [0.0; 6];
                step[column] = sign * STEP;
                let there = m.space().displaced(&q, 1.0, &step);
                let faster: Vec<f64> = v.iter().zip(step).map(|(v, step)| v + step).collect();
                [force(&there, &v), force(&q, &faster)]
            };
            let ([ahead_q, ahead_v], [back_q, back_v]) = (moved(1.0), moved(-1.0));
            for row in 0..6 {
                let slope = |a: &[f64], b: &[f64]| (a[row] - b[row]) / (2.0 * STEP);
                let found = [slope(&ahead_q, &back_q), slope(&ahead_v, &back_v)];
                for (told, found) in told.iter().zip(found) {
                    let told = told[row][column];
                    assert!(
                        (told - found).abs() < 1e-8,
                        "{row} {column}: {told} {found}"
                    );
                }
            }
        }
    }
}
