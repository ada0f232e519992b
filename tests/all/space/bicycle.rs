//! Compares the benchmark bicycle in one state of its motion with its published accelerations: P.
//! Basu-Mandal, A. Chatterjee, J. M. Papadopoulos, Hands-free circular motions of a benchmark
//! bicycle, Proc. R. Soc. A 463 (2007) 1983–2003, table 1. The values are in the package
//! DynamicistToolKit, `dtk/bicycle.py`.
//!
//! In that source z points up, and the rear hub is at (x, y, z). The frame is rotated by θ about z,
//! then by ψ about its new x, then by φ about its new z, which is the axis of the rear wheel, to
//! the left. The bicycle is upright and moves along −x at θ = 0, ψ = π/2, φ = π. The fork rotates
//! relative to the frame by ψ_f about the steering axis, upwards, and the wheels by β_r and β_f
//! about their axes, to the left.

use std::f64::consts::{FRAC_PI_2, PI};

use dynamics::KeptRowMotion;
use model::{Registry, System};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use pfaff::{RunOptions, Study};
use solvability::{Verdict, analyse};

use crate::bicycle::{PARTS, State, scene, steering_axis, steering_point};

type Vector = Vector3<f64>;

/// Height z of the rear hub, and the angles ψ, φ, ψ_f. The other coordinates are zero.
const PLACE: [f64; 4] = [
    0.244_047_210_292_5,
    0.950_129_285_147_2,
    3.125_707_301_489_4,
    0.231_138_513_574_3,
];

/// Rates of x, y, z, θ, ψ, φ, ψ_f, β_r, β_f.
const RATES: [f64; 9] = [
    -2.806_934_571_454_5,
    -0.148_098_239_600_1,
    0.105_877_874_626_1,
    0.783_003_352_706_5,
    0.606_842_583_541_8,
    -0.011_918_552_806_9,
    0.485_982_468_709_3,
    8.912_989_661_489_0,
    8.013_362_058_415_5,
];

/// Second derivatives of these coordinates, 13 decimals.
const ACCELERATIONS: [f64; 9] = [
    -0.504_162_631_504_7,
    -0.344_970_661_945_4,
    -1.460_452_833_298_0,
    0.835_328_170_637_9,
    -7.855_528_112_824_4,
    0.120_554_389_788_4,
    -4.619_890_403_940_3,
    1.847_255_414_421_7,
    2.454_807_290_455_0,
];

/// Largest difference, relative for values above 1.
const BOUND: f64 = 1e-11;

/// A rotation about a unit vector.
fn about(axis: Vector, angle: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Unit::new_normalize(axis), angle)
}

/// Returns the axes of θ, ψ and φ in the ground, and the orientation of the frame.
fn frame(psi: f64, phi: f64) -> ([Vector; 3], Rotation3<f64>) {
    let [x, z] = [Vector::x(), Vector::z()];
    let turned = |psi: f64, phi: f64| about(x, psi) * about(z, phi);
    // In upright motion along −x the axes of the frame are rotated by half a turn.
    let orientation = turned(psi, phi) * turned(FRAC_PI_2, PI).inverse() * about(z, PI);
    ([z, x, about(x, psi) * z], orientation)
}

#[test]
fn accelerations_of_the_published_state() {
    let [height, psi, phi, steer] = PLACE;
    let [vx, vy, vz, theta_1, psi_1, phi_1, steer_1, rear_1, front_1] = RATES;
    let (axes, of_frame) = frame(psi, phi);
    let axis = Vector::from(steering_axis());
    let of_fork = of_frame * about(axis, steer);
    let [left, head, left_of_fork] = [
        of_frame * Vector::y(),
        of_frame * axis,
        of_fork * Vector::y(),
    ];
    let omega = axes[0] * theta_1 + axes[1] * psi_1 + axes[2] * phi_1;
    let omega_fork = omega + head * steer_1;
    assert!((left - axes[2]).norm() < 1e-15);

    // The frame carries the steering axis, and the fork carries the parts beyond it.
    let hub = Vector::from(PARTS[0].centre);
    let (at, pivot) = (
        Vector::new(0.0, 0.0, height),
        Vector::from(steering_point()),
    );
    let arm = of_frame * (pivot - hub);
    let velocity = Vector::new(vx, vy, vz);
    let (pivot_at, pivot_velocity) = (at + arm, velocity + omega.cross(&arm));
    let states = std::array::from_fn(|k| {
        let centre = Vector::from(PARTS[k].centre);
        let (turn, from, start, moving, carrier) = if k < 2 {
            (of_frame, hub, at, velocity, omega)
        } else {
            (of_fork, pivot, pivot_at, pivot_velocity, omega_fork)
        };
        let arm = turn * (centre - from);
        let own = [
            left * rear_1,
            Vector::zeros(),
            Vector::zeros(),
            left_of_fork * front_1,
        ][k];
        let rows: Matrix3<f64> = turn.into_inner();
        State {
            centre: (start + arm).into(),
            orientation: std::array::from_fn(|i| std::array::from_fn(|j| rows[(i, j)])),
            velocity: (moving + carrier.cross(&arm)).into(),
            angular_velocity: (carrier + own).into(),
        }
    });
    let study = Study::read(
        "bicycle.toml",
        &scene(&states),
        &Registry::standard(),
        &RunOptions::default(),
    );
    let study = study.unwrap_or_else(|e| panic!("{e}"));
    let prepared = &study.prepared;
    // The values are rounded to 13 decimals, and they are consistent.
    for correction in [&prepared.assembly.correction, &prepared.velocity_correction] {
        assert!(tests::largest(correction.iter().copied()) < 1e-11);
    }
    let analysis = analyse(&prepared.mechanism, 0.0, &prepared.q).expect("C is finite");
    assert_eq!(
        (prepared.mechanism.layout().rows(), analysis.decision.rank),
        (21, 21)
    );
    let unique = |r: &solvability::ReactionVerdict| r.wrench.verdict == Verdict::Unique;
    assert!(analysis.reactions.iter().all(unique));

    let mut a = vec![0.0; prepared.v.len()];
    let mut motion = KeptRowMotion::new(prepared).expect("moves");
    motion
        .acceleration(0.0, &prepared.q, &prepared.v, &mut a)
        .expect("a regular state");
    // Computes angular accelerations in ground axes from those in the axes of each body.
    let alpha = |k: usize| {
        let q = &prepared.q[7 * k + 3..7 * k + 7];
        let pose = joints::space3::Pose::new([0.0; 3], [q[0], q[1], q[2], q[3]]);
        let own = [a[6 * k + 3], a[6 * k + 4], a[6 * k + 5]];
        Vector::from(pose.direction_to_global(own))
    };
    let [rear, of_the_frame, fork, front] = [0, 1, 2, 3].map(alpha);
    // The formula is α = Σ axis·angle'' + (the ψ axis changes with θ', the φ axis with θ' and ψ').
    let changing = (axes[0] * theta_1).cross(&(axes[1] * psi_1))
        + (axes[0] * theta_1 + axes[1] * psi_1).cross(&(axes[2] * phi_1));
    let angles = Matrix3::from_columns(&axes)
        .lu()
        .solve(&(of_the_frame - changing))
        .expect("ψ is not 0");
    // The axis of a part changes with its carrier.
    let relative = |alpha: Vector, carrier: Vector, omega: Vector, axis: Vector, rate: f64| {
        axis.dot(&(alpha - carrier - omega.cross(&(axis * rate))))
    };
    let found = [
        a[0],
        a[1],
        a[2],
        angles[0],
        angles[1],
        angles[2],
        relative(fork, of_the_frame, omega, head, steer_1),
        relative(rear, of_the_frame, omega, left, rear_1),
        relative(front, fork, omega_fork, left_of_fork, front_1),
    ];
    for (found, expected) in found.iter().zip(ACCELERATIONS) {
        assert!(
            (found - expected).abs() < BOUND * expected.abs().max(1.0),
            "{found} and {expected}: {:e}",
            found - expected
        );
    }
}
