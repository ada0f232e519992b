//! Tests mechanisms with hundreds of rows, which are analysed by parts and simulated on sparse
//! independent rows. References are the known results of the generators, the equation for one angle
//! of chains of four-bars, and the dense solver with all rows.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use dynamics::{KeptRowMotion, Method, MotionOptions, simulate};
use lab::comparators::equations::Equations;
use lab::comparators::{Drift, MinimumNorm};
use model::{Mechanism, Registry, System};
use pfaff::{RunOptions, Study};
use solvability::{Verdict, analyse};
use suite::generate::{Kind, Order};

use crate::generated_scenes::{angle, read, text};

fn study(order: &Order) -> Study {
    let overrides = RunOptions::default();
    Study::read(
        "generated.toml",
        &text(order),
        &Registry::standard(),
        &overrides,
    )
    .expect("starts")
}

/// Compares verdicts by parts with those that the generator states.
fn check(order: &Order) {
    let mechanism = Mechanism::build(&read(&text(order)).description).expect("builds");
    let (q, _) = mechanism.described_state();
    let found = analyse(&mechanism, 0.0, &q).expect("C is finite");
    let generator = order.generate().expect("a possible order");
    let answer = generator.answer();
    assert!(mechanism.layout().rows() > 600, "{order:?}");
    assert_eq!(found.dependencies.len(), answer.redundancy, "{order:?}");
    assert_eq!(
        [
            found.decision.rank,
            found.decision.redundancy,
            found.mobility()
        ],
        [answer.rank, answer.redundancy, answer.mobility],
        "{order:?}"
    );
    let free = generator.free_reactions();
    let free: BTreeSet<&str> = free.iter().map(|f| f.name.as_str()).collect();
    for reaction in &found.reactions {
        let expected = if free.contains(reaction.name.as_str()) {
            Verdict::NotUnique
        } else {
            Verdict::Unique
        };
        assert_eq!(reaction.wrench.verdict, expected, "{}", reaction.name);
    }
}

#[test]
fn large_scenes_have_the_answer_that_their_generator_states() {
    for (kind, n) in [
        (Kind::Parallelograms, 70),
        (Kind::Fleet, 30),
        (Kind::NFourBar, 110),
        (Kind::Random, 300),
        (Kind::Lattice, 14),
    ] {
        check(&Order::of(kind, n));
    }
}

#[test]
fn sparse_rows_accelerate_as_dense_ones_do() {
    // The weights of the lattice hang straight down: some accelerations are only the rounding
    // errors of balanced multipliers.
    for (kind, n) in [(Kind::Parallelograms, 12), (Kind::Lattice, 4)] {
        accelerate_alike(&Order::of(kind, n));
    }
}

fn accelerate_alike(order: &Order) {
    let study = study(order);
    let prepared = &study.prepared;
    let n = prepared.v.len();
    let (mut sparse, mut dense) = (vec![0.0; n], vec![0.0; n]);
    let mut motion = KeptRowMotion::new(prepared).expect("regular");
    motion
        .acceleration(0.0, &prepared.q, &prepared.v, &mut sparse)
        .expect("regular");
    // Solves all rows, by a complete orthogonal decomposition.
    let rank = prepared.decision.rank;
    Equations::new(prepared, Drift::None, |_, _| {
        Ok(Box::new(MinimumNorm::new(rank)))
    })
    .and_then(|mut all| all.accelerate(0.0, &prepared.q, &prepared.v, &mut dense))
    .expect("regular");
    let largest = dense.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    assert!(largest > 1.0, "{largest}");
    for (a, b) in sparse.iter().zip(&dense) {
        assert!((a - b).abs() < 1e-11 * largest, "{a} {b}");
    }
}

/// Twenty four-bars are in the singular configuration at 0.72 s and 1.24 s, at which 2²⁰ branches
/// meet.
#[test]
fn flat_poses_of_many_four_bars_are_passed_on_the_branch() {
    let n = 20;
    let study = study(&Order::of(Kind::NFourBar, n));
    for rtol in [0.9e-7, 1e-7, 1.1e-7] {
        let options = MotionOptions {
            rtol,
            atol: rtol,
            ..MotionOptions::to(2.0)
        };
        let mut last = Vec::new();
        simulate(&study.prepared, &options, |sample| {
            last = sample.q.to_vec();
            Ok(ControlFlow::Continue(()))
        })
        .unwrap_or_else(|failure| panic!("{}", failure.error));
        let expected = angle(n, 2.0);
        for upright in 0..=n {
            let theta = std::f64::consts::FRAC_PI_2 - last[3 * upright + 2];
            let turns = ((theta - expected) / std::f64::consts::TAU).round();
            let off = theta - expected - turns * std::f64::consts::TAU;
            assert!(off.abs() < 1e-5, "{upright} at {rtol}: {theta}, {expected}");
        }
    }
}

/// The test uses the benchmark A02 of the IFToMM/LIM library with forty loops: twenty seconds,
/// forty singular configurations. The library allows 1e-3.
#[test]
fn forty_four_bars_are_where_one_angle_says() {
    let n = 40;
    let study = study(&Order::of(Kind::NFourBar, n));
    let options = MotionOptions {
        rtol: 1e-7,
        atol: 1e-7,
        output_step: 2.0,
        ..MotionOptions::to(20.0)
    };
    let mut rows = 0;
    simulate(&study.prepared, &options, |sample| {
        // The top and the foot of the first upright rod have the same distance from its centre.
        let (sin, cos) = sample.q[2].sin_cos();
        let top = [sample.q[0] + 0.5 * cos, sample.q[1] + 0.5 * sin];
        let theta = angle(n, sample.t.max(1e-4));
        let theta = if sample.t == 0.0 { 0.0 } else { theta };
        let off = (top[0] - theta.sin()).hypot(top[1] - theta.cos());
        assert!(off < 1e-5, "{off:.1e} m at {} s", sample.t);
        rows += 1;
        Ok(ControlFlow::Continue(()))
    })
    .unwrap_or_else(|failure| panic!("{}", failure.error));
    assert_eq!(rows, 11);
}

#[test]
fn implicit_methods_compute_many_free_motions() {
    let study = study(&Order::of(Kind::Fleet, 20));
    let ended = |method: Method| {
        let options = MotionOptions {
            method,
            output_step: 1.0,
            ..MotionOptions::to(1.0)
        };
        let mut q = Vec::new();
        let row = |row: &mut dynamics::Sample<'_, '_>| {
            q = row.q.to_vec();
            Ok(ControlFlow::Continue(()))
        };
        simulate(&study.prepared, &options, row).expect("moves");
        q
    };
    let [implicit, explicit] = [Method::Radau5, Method::Dop853].map(ended);
    for (a, b) in implicit.iter().zip(&explicit) {
        assert!((a - b).abs() < 1e-8, "{a} and {b}");
    }
}
