//! Benchmarks of the library with the 22 × 21 matrix of the robot: certificates of the rank, and
//! verdicts on reactions at a point whose rank is already certified. Each benchmark asserts its
//! result before its time is measured: `cargo bench -p bench --bench verdicts`.

use std::hint::black_box;

use divan::Bencher;
use dynamics::{PreparedMechanism, RowChoice, prepare};
use linalg::{DdMatrix, Matrix};
use model::{Mechanism, RowRanges, StartOptions, System};
use solvability::Solvability;
use tests::robot::{robot, steering};

fn main() {
    divan::main();
}

/// Returns the robot at its initial state.
fn prepared() -> PreparedMechanism {
    let mechanism = Mechanism::build(&robot(steering())).expect("the robot builds");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("the robot starts")
}

/// Returns C of the robot at its initial state, and the rows of its fourteen reactions.
fn matrix() -> (Matrix, Vec<RowRanges>) {
    let p = prepared();
    let mut s = p.mechanism.scratch();
    p.mechanism.pose(0.0, &p.q, &mut s);
    p.mechanism.c(&mut s);
    let layout = p.mechanism.layout();
    let groups = layout.groups.iter().map(|g| g.rows.clone()).collect();
    (layout.dense(&s), groups)
}

/// Counts the unique rows and groups.
fn unique(s: &Solvability, groups: &[RowRanges]) -> usize {
    let judged =
        |verdict: Result<solvability::Judgement, _>| verdict.is_ok_and(|j| j.verdict.is_unique());
    let rows = groups
        .iter()
        .flat_map(Clone::clone)
        .filter(|&i| judged(s.row(i)))
        .count();
    rows + groups
        .iter()
        .filter(|rows| judged(s.group((*rows).clone())))
        .count()
}

/// Computes rank, dependencies and proof. The entries count as exact values.
#[divan::bench]
fn certify_exact(bencher: Bencher<'_, '_>) {
    let (c, _) = matrix();
    assert!(rank::certify_exact(&c).is_ok_and(|d| d.rank >= 20));
    bencher.bench_local(|| rank::certify_exact(black_box(&c)));
}

/// Computes rank, dependencies and bounds. The entries are uncertain within the accuracy of the
/// data.
#[divan::bench]
fn certify_within(bencher: Bencher<'_, '_>) {
    let c = DdMatrix::from(&matrix().0);
    assert!(
        rank::certify_within(&c, rank::Accuracy::Absolute(1e-15))
            .is_ok_and(|d| d.rank == 20 && d.is_decided())
    );
    bencher.bench_local(|| rank::certify_within(black_box(&c), rank::Accuracy::Absolute(1e-15)));
}

/// Computes from the matrix alone whether the multipliers of each row and the reaction of each
/// group are unique.
#[divan::bench]
fn verdicts_from_the_matrix(bencher: Bencher<'_, '_>) {
    let (c, groups) = matrix();
    bencher.bench_local(|| {
        Solvability::of(black_box(&c), rank::Accuracy::Rounding).map(|s| unique(&s, &groups))
    });
}

/// Computes the verdict on every reaction of the robot, with its certificate and the smallest error
/// of the data that would reduce the rank.
#[divan::bench]
fn analysis(bencher: Bencher<'_, '_>) {
    let p = prepared();
    let analysed = || solvability::analyse(&p.mechanism, 0.0, black_box(&p.q));
    assert!(analysed().is_ok_and(|a| a.decision.rank == 20));
    bencher.bench_local(analysed);
}

/// Computes the sensitivity of each unique reaction of the robot to the data.
#[divan::bench]
fn sensitivities(bencher: Bencher<'_, '_>) {
    let p = prepared();
    let analysis = solvability::analyse(&p.mechanism, 0.0, &p.q).expect("finite");
    let told = || analysis.sensitivities(&p.mechanism, black_box(&p.q), &p.v);
    assert!(told().is_ok_and(
        |s| s.each.iter().filter(|own| own.largest().is_some()).count() == 8
            && s.fragile().count() == 0
    ));
    bencher.bench_local(told);
}
