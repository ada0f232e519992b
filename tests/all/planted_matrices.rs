//! Ten thousand matrices with constructed redundancy, analysed by `solvability` and by exact
//! arithmetic. The given entries are exact: a matrix whose rows are dependent except for one part
//! in 10¹⁰⁰ has full rank.
//!
//! `PFAFF_CASES=200000 cargo test -p tests planted_matrices -- --nocapture` makes a longer run.

mod generate;

use exact::Exact;
use linalg::Matrix;
use tests::numbers::Numbers;

use crate::plain::Plain;
use crate::tally::{Tally, cases};
use generate::Kind;

const SEED: u64 = 20_130_909;

const CASES: usize = 10_000;

/// Number of combinations of multipliers for each case.
const COMBINATIONS: usize = 4;

#[test]
fn no_verdict_is_wrong() {
    let mut numbers = Numbers::new(SEED);
    let mut tally = Tally::default();
    for case in 0..cases(CASES) {
        let kind = Kind::ALL[case % Kind::ALL.len()];
        tally.case(kind.name());
        judge(
            &generate::rows(kind, &mut numbers),
            &mut numbers,
            &mut tally,
        );
    }
    let planted = Kind::ALL.into_iter().filter(|k| k.is_exactly_planted());
    tally.conclude("matrices", SEED, planted.map(Kind::name));
}

/// Compares every verdict of one case.
fn judge(rows: &[Vec<f64>], numbers: &mut Numbers, tally: &mut Tally) {
    let m = rows.len();
    let exact = Exact::of(rows);
    let plain = Plain::of_rows(rows);
    let decision = plain.decision();
    if !decision.is_decided() {
        return tally.undecided(|| format!("{:?} of {rows:?}", decision.status));
    }
    tally.number(decision.rank, exact.rank(), || format!("rank of {rows:?}"));
    if numbers.once_in(8) {
        let kept: Vec<&Vec<f64>> = decision.kept.iter().map(|&i| &rows[i]).collect();
        let rank = Exact::of(&kept).rank();
        tally.number(rank, exact.rank(), || {
            format!("rank of the kept rows {kept:?}")
        });
    }
    for i in 0..m {
        let unique = exact.row_is_unique(i);
        tally.judgement(&plain.row(i), unique, || format!("row {i} of {rows:?}"));
    }
    for group in partition(m, numbers) {
        let unique = exact.freedom(&group) == 0;
        tally.judgement(&plain.group(&group), unique, || {
            format!("wrench {group:?} of {rows:?}")
        });
        let freedom = exact.multiplier_freedom(&group);
        tally.judgement(&plain.multipliers(&group), freedom == 0, || {
            format!("multipliers {group:?} of {rows:?}")
        });
        let directions = plain.unique_directions(&group);
        tally.number(directions, group.len() - freedom, || {
            format!("unique directions of {group:?} of {rows:?}")
        });
    }
    for _ in 0..COMBINATIONS {
        let l = combination(rows, numbers);
        let unique = exact.combination_is_unique(&l);
        tally.judgement(&plain.combination(&l), unique, || {
            format!("{l:?} of {rows:?}")
        });
        // The same combination as a component of all rows.
        let map = Matrix::from_fn(1, m, |_, i| l[i]);
        let all: Vec<usize> = (0..m).collect();
        tally.judgement(&plain.component(&map, 0, &all), unique, || {
            format!("component {l:?} of {rows:?}")
        });
    }
}

/// Returns the rows, in any order, in groups of one to three.
fn partition(m: usize, numbers: &mut Numbers) -> Vec<Vec<usize>> {
    let order = numbers.order(m);
    let mut rest = order.as_slice();
    let mut groups = Vec::new();
    while !rest.is_empty() {
        let (group, others) = rest.split_at(rest.len().min(1 + numbers.below(3)));
        groups.push(group.to_vec());
        rest = others;
    }
    groups
}

/// Returns a column of C, the difference of two columns, or a few random coefficients. The first is
/// always unique, and the second is unique up to rounding.
fn combination(rows: &[Vec<f64>], numbers: &mut Numbers) -> Vec<f64> {
    let n = rows[0].len();
    let (j, k) = (numbers.below(n), numbers.below(n));
    match numbers.below(3) {
        0 => rows.iter().map(|row| row[j]).collect(),
        1 => rows.iter().map(|row| row[j] - row[k]).collect(),
        _ => {
            let mut coefficient = || f64::from(numbers.between(-1, 1) * numbers.between(0, 1));
            rows.iter().map(|_| coefficient()).collect()
        }
    }
}
