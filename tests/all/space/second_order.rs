//! Tests of second-order conditions in space.

use joints::generated::space3::{Revolute, Spherical, Universal};
use joints::space3::{Axes, Direction, Distance, Pose};
use lab::fuzz::space::text::Precision;
use lab::fuzz::space::{catalogue, description};
use linalg::Matrix;
use model::{BodyRef, Mechanism, SpatialBody, SpatialDescription, System};
use solvability::{Continuation, analyse, blocked_velocities, decide, is_locked, second_order};

use super::verdicts::{Motion, TENSOR};

/// A rigid triangle has its corners at 120°·k + `turn`, radius 1, z = 1, and six bars. Each corner
/// is connected to two corners of the base, at 120°·k and 120°·(k + 1), radius 1, z = 0. Long bars
/// and short ones alternate.
fn triangle_on_bars(
    turn: f64,
    motion: &Motion,
    frame: [f64; 4],
    centre: [f64; 3],
) -> SpatialDescription {
    let mut d = SpatialDescription::new("triangle on six bars");
    let top = d.body(SpatialBody {
        position: motion.point([0.0, 0.0, 1.0]),
        orientation: frame,
        centre,
        ..SpatialBody::new("triangle", 1.0, TENSOR)
    });
    let corner = |degrees: f64, z: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        motion.point([cos, sin, z])
    };
    for k in 0..3 {
        for foot in [k, k + 1] {
            let bar = Distance::new(
                corner(120.0 * f64::from(foot), 0.0),
                d.local(top, corner(120.0 * f64::from(k) + turn, 1.0)),
            );
            d.joint(&format!("bar {k} {foot}"), &[BodyRef::Ground, top], bar);
        }
    }
    d
}

fn locked(d: &SpatialDescription) -> bool {
    let mechanism = Mechanism::build(d).expect("builds");
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    let decision = decide(&mechanism, &s, &q).expect("finite");
    assert!(decision.is_decided(), "{decision:?}");
    let found = is_locked(&mechanism, 0.0, &q, &decision).expect("a configuration");
    let n = mechanism.layout().n_v;
    let rest = second_order(
        &mechanism,
        0.0,
        &q,
        &vec![0.0; n],
        &decision,
        &Matrix::zeros(n, 0),
    );
    let rest = rest.expect("a state");
    assert_eq!(
        found == Some(true),
        rest == Continuation::Unique && decision.rank < n,
        "{rest:?}"
    );
    found == Some(true)
}

/// Case V24: rotated by 150°, the triangle may move as a screw about z at first order:
/// `v_z = −ω/2`. The second-order conditions exclude this motion.
#[test]
fn a_triangle_on_six_bars_is_blocked_at_second_order() {
    let frames = [
        ([1.0, 0.0, 0.0, 0.0], [0.0; 3]),
        ([0.9, 0.3, -0.2, 0.5], [0.2, -0.3, 0.4]),
    ];
    for motion in Motion::all() {
        for (frame, centre) in frames {
            let d = triangle_on_bars(150.0, &motion, frame, centre);
            let mechanism = Mechanism::build(&d).expect("builds");
            let (q, _) = mechanism.described_state();
            let found = analyse(&mechanism, 0.0, &q).expect("a verdict");
            let decision = &found.decision;
            assert!(decision.is_decided(), "{decision:?}");
            assert_eq!(
                [decision.rank, decision.redundancy, found.mobility()],
                [5, 1, 1]
            );
            assert!(
                found
                    .reactions
                    .iter()
                    .all(|r| !r.wrench.verdict.is_unique())
            );
            assert!(locked(&d));
            // In another position the six bars lock the triangle at first order.
            let d = triangle_on_bars(140.0, &motion, frame, centre);
            assert!(!locked(&d));
        }
    }
}

/// By hand, with tensions `z_k = ±L_k`, tension in long bars and compression in short ones, forces
/// and moments vanish. For ω = 1, v_z = −½ each bar has `L·Γ = −(¼ + cos β)` with the angle β
/// between its ends about z, 150° or 30°: `z·Γ = 3·√3`.
#[test]
fn its_self_stress_does_work_at_second_order() {
    let d = triangle_on_bars(150.0, &Motion(Pose::GROUND), [1.0, 0.0, 0.0, 0.0], [0.0; 3]);
    let mechanism = Mechanism::build(&d).expect("builds");
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    let v = [0.0, 0.0, -0.5, 0.0, 0.0, 1.0];
    mechanism.twist(&v, &mut s);
    mechanism.gamma(&mut s);
    let c = mechanism.layout().dense(&s);
    let root = 3.0_f64.sqrt();
    let z: [f64; 6] = std::array::from_fn(|k| match k % 2 {
        0 => (3.0 + root).sqrt(),
        _ => -(3.0 - root).sqrt(),
    });
    for j in 0..6 {
        let carried: f64 = (0..6).map(|i| z[i] * c[(i, j)]).sum();
        assert!(carried.abs() < 1e-14, "column {j}: {carried:e}");
        let rate: f64 = (0..6).map(|k| c[(j, k)] * v[k]).sum();
        assert!(rate.abs() < 1e-14, "row {j}: {rate:e}");
    }
    let work: f64 = z.iter().zip(&s.gamma).map(|(z, gamma)| z * gamma).sum();
    assert!((work - 3.0 * root).abs() < 1e-13, "{work}");
}

/// A platform has three legs of fixed length, each between two universal joints whose first axes
/// are radial. The platform tilts at first order about any horizontal axis, in two ways. Two
/// self-stresses resist at second order with forms like x² − y² and x·y: no combination of them is
/// definite, and they have no common zero.
#[test]
fn a_platform_on_three_legs_is_blocked_without_a_definite_combination() {
    let mut d = SpatialDescription::new("platform on three legs");
    let platform = d.body(body("platform", [0.0, 0.0, 0.8]));
    for k in 0..3 {
        let (sin, cos) = (0.3 + f64::from(k) * 120.0_f64.to_radians()).sin_cos();
        let [foot, head] =
            [(0.4, 0.0), (0.25, 0.8)].map(|(radius, z)| [radius * cos, radius * sin, z]);
        let leg = d.body(body(&format!("leg {k}"), [0.325 * cos, 0.325 * sin, 0.4]));
        for (name, other, place) in [("base", BodyRef::Ground, foot), ("top", platform, head)] {
            let s_i = match other {
                BodyRef::Ground => place,
                _ => d.local(other, place),
            };
            let hooke = Universal::new(
                s_i,
                d.local(leg, place),
                Direction::new([cos, sin, 0.0]).expect("a direction"),
                Direction::new([-sin, cos, 0.0]).expect("a direction"),
            );
            d.joint(&format!("{name} {k}"), &[other, leg], hooke);
        }
    }
    assert!(locked(&d));
    assert_eq!(blocked(&d).len(), 2);
}

/// A linkage that moves along a path is not blocked, although Grübler's formula gives no degree of
/// freedom, and neither is a linkage with branches.
#[test]
fn linkages_that_move_are_not_blocked() {
    for drawing in [
        catalogue::bennett(),
        catalogue::bricard(),
        catalogue::sarrus(&[0, 1, 2]),
        catalogue::parallelograms(1, [3, 4]),
        catalogue::parallelograms(1, [5, 0]),
    ] {
        assert!(!locked(
            &description(&drawing, &Precision::default()).expect("a mechanism")
        ));
    }
}

/// Returns the velocities of bodies that the second-order conditions exclude according to the
/// program.
fn blocked(d: &SpatialDescription) -> Vec<Vec<f64>> {
    let mechanism = Mechanism::build(d).expect("builds");
    let (q, _) = mechanism.described_state();
    let found = analyse(&mechanism, 0.0, &q).expect("a verdict");
    let decision = found.whole().expect("small");
    blocked_velocities(&mechanism, 0.0, &q, &decision).expect("a configuration")
}

fn body(name: &str, position: [f64; 3]) -> SpatialBody {
    SpatialBody {
        position,
        ..SpatialBody::new(name, 1.0, TENSOR)
    }
}

/// Connects a body to the ground by a hinge.
fn hang(d: &mut SpatialDescription, door: BodyRef, place: [f64; 3], axis: [f64; 3]) {
    let axis = Axes::new(axis, None).expect("a direction");
    let hinge = Revolute {
        s_i: place,
        s_j: d.local(door, place),
        axis,
        axis_j: axis,
    };
    let name = format!("hinge {door:?}");
    d.joint(&name, &[BodyRef::Ground, door], hinge);
}

/// A door is next to a rod that is connected by a ball joint and a Hooke joint at both ends. The
/// length between these joints is always constrained twice, and no quadratic form has a non-zero
/// entry.
#[test]
fn what_rounding_leaves_of_a_self_stress_blocks_nothing() {
    for k in 0..24 {
        let turn = 0.27 * f64::from(k);
        let (sin, cos) = turn.sin_cos();
        let mut d = SpatialDescription::new("a door and a rod");
        let rod = d.body(body("rod", [0.5, 1.0, -1.0]));
        let door = d.body(body("door", [-2.0, 1.0, 1.5]));
        let [a, b] = [[0.5, 2.0, 0.5], [-1.0, -2.0, -2.0]];
        let hooke = Universal::new(
            a,
            d.local(rod, a),
            Direction::new([-1.0, 0.0, 0.0]).expect("a direction"),
            Direction::new([0.0, cos, sin]).expect("a direction"),
        );
        d.joint("a", &[BodyRef::Ground, rod], hooke);
        let s_j = d.local(rod, b);
        d.joint("b", &[BodyRef::Ground, rod], Spherical { s_i: b, s_j });
        hang(&mut d, door, [0.5, 1.0, 1.0], [0.3, cos, sin]);
        assert_eq!(blocked(&d), Vec::<Vec<f64>>::new(), "{turn}");
    }
}

/// Case V24 with n separate doors: the free motion of V24 is blocked, and the free motions of the
/// doors are not.
#[test]
fn a_blocked_freedom_beside_many_others() {
    for n in [0_u8, 1, 4, 9, 20] {
        let mut d = triangle_on_bars(150.0, &Motion(Pose::GROUND), [1.0, 0.0, 0.0, 0.0], [0.0; 3]);
        for k in 0..n {
            let place = [5.0 + f64::from(k), 0.5, 0.0];
            let door = d.body(body(&format!("door {k}"), [place[0], 0.0, 0.0]));
            hang(&mut d, door, place, [0.0, 0.0, 1.0]);
        }
        let [v] = &blocked(&d)[..] else {
            panic!("{n} doors: {:?}", blocked(&d));
        };
        // The velocity is v_z = −ω/2, and the doors are at rest.
        assert!((v[2] + 0.5 * v[5]).abs() < 1e-12 * v[5].abs(), "{v:?}");
        assert!(
            v[6..].iter().all(|v_k| v_k.abs() < 1e-12 * v[5].abs()),
            "{v:?}"
        );
    }
}
