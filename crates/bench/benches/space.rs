//! Benchmarks of mechanisms in space: the kernels of one joint, and all verdicts on a four-bar and
//! on a Delta robot. Each benchmark asserts its result before its time is measured:
//! `cargo bench -p bench --bench space`.

use std::hint::black_box;

use divan::Bencher;
use joints::space3::{Axes, Pose, Revolute, Twist};
use joints::{Element, Space3};
use lab::fuzz::space::catalogue::{Flat, delta, four_bar};
use lab::fuzz::space::text::Precision;
use lab::fuzz::space::{Drawing, description};
use model::Mechanism;
use solvability::analyse;

fn main() {
    divan::main();
}

/// Computes C and Γ of one revolute joint.
#[divan::bench]
fn kernel_revolute(bencher: Bencher<'_, '_>) {
    let axis = Axes::new([0.2, -0.3, 0.9], None).expect("a direction");
    let joint = Revolute {
        s_i: [0.3, 0.1, -0.2],
        s_j: [-0.2, 0.4, 0.1],
        axis,
        axis_j: axis,
    };
    let x = [
        Pose::new([0.1, 0.2, 0.3], [0.9, 0.1, -0.2, 0.3]),
        Pose::new([0.4, 0.5, 0.6], [0.8, -0.3, 0.1, 0.2]),
    ];
    let v = [
        Twist {
            v: [1.0, 0.0, 0.3],
            omega: [0.5, -0.2, 0.1],
        },
        Twist {
            v: [0.0, 1.0, -0.4],
            omega: [-0.5, 0.3, 0.2],
        },
    ];
    let joint: &dyn Element<f64, Space3> = &joint;
    let (mut c, mut gamma) = (vec![0.0; joint.spec().c.len()], [0.0; 5]);
    joint.gamma(&x, &v, &[], &mut gamma);
    assert!(gamma[0] != 0.0);
    bencher.bench_local(|| {
        let joint = black_box(joint);
        joint.c(black_box(&x), &[], &mut c);
        joint.gamma(black_box(&x), black_box(&v), &[], &mut gamma);
        black_box((&c, &gamma));
    });
}

/// Computes all verdicts on a drawing with this rank.
fn verdicts(bencher: Bencher<'_, '_>, drawing: &Drawing, rank: usize) {
    let description = description(drawing, &Precision::default()).expect("a mechanism");
    let mechanism = Mechanism::build(&description).expect("builds");
    let (q, _) = mechanism.described_state();
    let analysed = || analyse(&mechanism, 0.0, black_box(&q));
    assert!(analysed().is_ok_and(|a| a.decision.rank == rank && a.decision.is_decided()));
    bencher.bench_local(analysed);
}

/// Four-bar, with a 20 × 18 matrix.
#[divan::bench]
fn analysis_four_bar(bencher: Bencher<'_, '_>) {
    verdicts(bencher, &four_bar([Flat::R; 4]), 17);
}

/// Delta robot, with a 105 × 96 matrix.
#[divan::bench]
fn analysis_delta(bencher: Bencher<'_, '_>) {
    verdicts(bencher, &delta(), 93);
}
