//! Benchmarks of the robot with its trolley, from one kernel to the whole run. Each benchmark
//! asserts its result before its time is measured. Compare only ratios within one run:
//! `cargo bench -p bench`.

use std::hint::black_box;
use std::ops::ControlFlow;

use divan::Bencher;
use dynamics::{KeptRowMotion, MotionOptions, PreparedMechanism, RowChoice, prepare, simulate};
use joints::{Element, Pose, Revolute, Twist};
use model::{Mechanism, StartOptions, System};
use tests::robot::{robot, steering};

fn main() {
    divan::main();
}

fn prepared() -> PreparedMechanism {
    let mechanism = Mechanism::build(&robot(steering())).expect("the robot builds");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("the robot starts")
}

/// Computes C and Γ of one revolute joint.
#[divan::bench]
fn kernel_revolute(bencher: Bencher<'_, '_>) {
    let joint = Revolute {
        s_i: [0.3, 0.1],
        s_j: [-0.2, 0.4],
    };
    let x = [Pose::new(0.1, 0.2, 0.3), Pose::new(0.4, 0.5, 0.6)];
    let v = [
        Twist {
            x: 1.0,
            y: 0.0,
            omega: 0.5,
        },
        Twist {
            x: 0.0,
            y: 1.0,
            omega: -0.5,
        },
    ];
    let (mut c, mut gamma) = ([0.0; 8], [0.0; 2]);
    let joint: &dyn Element = &joint;
    joint.gamma(&x, &v, &[], &mut gamma);
    assert!(gamma[0] != 0.0);
    bencher.bench_local(|| {
        let joint = black_box(joint);
        joint.c(black_box(&x), &[], &mut c);
        joint.gamma(black_box(&x), black_box(&v), &[], &mut gamma);
        black_box((&c, &gamma));
    });
}

/// Computes poses, C, Γ and Q of the whole mechanism.
#[divan::bench]
fn assembly(bencher: Bencher<'_, '_>) {
    let p = prepared();
    let m = &p.mechanism;
    let mut s = m.scratch();
    bencher.bench_local(|| {
        m.pose(1.5, black_box(&p.q), &mut s);
        m.c(&mut s);
        m.twist(black_box(&p.v), &mut s);
        m.gamma(&mut s);
        m.force(&mut s);
        black_box(&s);
    });
}

/// Makes one certified rank decision of the 22 × 21 matrix.
#[divan::bench]
fn rank_decision(bencher: Bencher<'_, '_>) {
    let p = prepared();
    let mut s = p.mechanism.scratch();
    p.mechanism.pose(0.0, &p.q, &mut s);
    p.mechanism.c(&mut s);
    let c = p.mechanism.layout().dense(&s);
    assert_eq!(
        rank::decide(&c, rank::Accuracy::Rounding)
            .expect("finite")
            .rank,
        20
    );
    bencher.bench_local(|| rank::decide(black_box(&c), rank::Accuracy::Rounding));
}

/// Performs the whole analysis: ranks, verdicts on fourteen reactions, undetermined directions,
/// dependencies.
#[divan::bench]
fn analysis(bencher: Bencher<'_, '_>) {
    let p = prepared();
    bencher.bench_local(|| solvability::analyse(&p.mechanism, 0.0, black_box(&p.q)));
}

/// Computes one acceleration with the independent rows, which is the right-hand side of the
/// integration.
#[divan::bench]
fn right_hand_side(bencher: Bencher<'_, '_>) {
    let p = prepared();
    let mut motion = KeptRowMotion::new(&p).expect("moves");
    let mut a = vec![0.0; p.v.len()];
    bencher.bench_local(|| motion.acceleration(black_box(1.5), &p.q, &p.v, black_box(&mut a)));
}

/// For comparison, solves saddle-point equations of the same size with the dense LU of nalgebra.
/// The assembly of the matrix is not measured.
#[divan::bench]
fn dense_lu_41_of_nalgebra(bencher: Bencher<'_, '_>) {
    let a = nalgebra::DMatrix::from_fn(41, 41, |i, j| {
        if i == j {
            4.0
        } else {
            1.0 / (1.0 + (i + 2 * j) as f64)
        }
    });
    let b = nalgebra::DVector::from_element(41, 1.0);
    assert!(a.clone().lu().solve(&b).is_some());
    bencher.bench_local(|| black_box(&a).clone().lu().solve(black_box(&b)));
}

/// Performs the whole run of ten seconds at the default tolerances. The output rows contain no
/// reactions.
#[divan::bench(sample_count = 20)]
fn whole_run(bencher: Bencher<'_, '_>) {
    let p = prepared();
    let options = MotionOptions::to(10.0);
    let summary = simulate(&p, &options, |_| Ok(ControlFlow::Continue(()))).expect("moves");
    assert!(summary.max_position_residual < 1e-12);
    bencher.bench_local(|| simulate(&p, black_box(&options), |_| Ok(ControlFlow::Continue(()))));
}
