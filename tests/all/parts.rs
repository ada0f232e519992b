//! Verdicts by cycles equal the verdicts for the whole mechanism. The mechanisms are random, with
//! constructed redundancy, and ranks are computed by exact arithmetic.

use std::collections::{BTreeMap, BTreeSet};

use exact::{Dyadic, Exact};
use model::{ConstraintId, Mechanism, System};
use rank::Limits;
use solvability::{
    Analysis, Choice, ChosenValues, DeletableRows, Distribution, Group, GroupVerdict, NormWeights,
    Questions, Solution, Value, Verdict, analyse, analyse_by_cycles,
};
use tests::numbers::Numbers;

use crate::planted_mechanisms::generate::{Kind, draw};
use crate::tally::cases;

const SEED: u64 = 20_261_122;

const CASES: usize = 800;

#[test]
fn parts_say_what_the_whole_says() {
    let mut numbers = Numbers::new(SEED);
    let (mut apart, mut compared, mut not_unique) = (0, 0, 0);
    for case in 0..cases(CASES) {
        let drawn = draw(Kind::ALL[case % Kind::ALL.len()], &mut numbers);
        let sketch = &drawn.sketch;
        let mechanism = Mechanism::build(&sketch.description()).expect("the mechanism builds");
        let (q, _) = mechanism.described_state();
        // The rows of the mechanism, by the names of joints: in the mechanism the holonomic rows
        // come first.
        let mut rows_of = BTreeMap::new();
        for block in sketch.exact_rows() {
            rows_of.insert(block.name.clone(), block.rows);
        }
        let groups = mechanism.layout().groups.iter();
        let c: Vec<Vec<Dyadic>> = groups.flat_map(|g| rows_of[&g.name].clone()).collect();
        let whole = analyse(&mechanism, 0.0, &q).expect("C is finite");
        let found = analyse_by_cycles(&mechanism, 0.0, &q).expect("C is finite");
        apart += usize::from(found.parts.len() > 1);
        if found.decision.is_decided() {
            let exact = Exact::of_dyadic(&c).rank();
            let rows = &found.decision;
            assert_eq!(rows.rank, exact, "{}", described(&found, &whole));
            assert_eq!(
                [rows.kept.len(), rows.dropped.len()],
                [rows.rank, rows.redundancy]
            );
            let kept: Vec<Vec<Dyadic>> = rows.kept.iter().map(|&i| c[i].clone()).collect();
            assert_eq!(Exact::of_dyadic(&kept).rank(), kept.len(), "{sketch:?}");
        }
        if !whole.decision.is_decided() {
            continue;
        }
        for (a, b) in whole.reactions.iter().zip(&found.reactions) {
            assert_eq!((a.id, &a.name), (b.id, &b.name));
            let judged = a.components.iter().zip(&b.components);
            let judged = judged.map(|(a, b)| (&a.judgement.verdict, &b.judgement.verdict));
            for pair in judged.chain([(&a.wrench.verdict, &b.wrench.verdict)]) {
                if let (Verdict::Undecided { .. }, _) | (_, Verdict::Undecided { .. }) = pair {
                    continue;
                }
                assert_eq!(pair.0, pair.1, "{}: {sketch:?}", a.name);
                compared += 1;
                not_unique += usize::from(!pair.0.is_unique());
            }
        }
    }
    assert!(
        apart > CASES / 4 && compared > 10 * CASES && not_unique > CASES,
        "{apart} {compared} {not_unique}"
    );
}

fn described(found: &Analysis, whole: &Analysis) -> String {
    let parts = found.parts.iter().map(|part| {
        let own = found.reactions.iter();
        let own = own.filter(|r| part.extent.own_group(r.id.0).is_some());
        let names: Vec<&str> = own.map(|r| r.name.as_str()).collect();
        format!("{names:?}: {:?}\n", part.decision)
    });
    format!("{}whole: {:?}", parts.collect::<String>(), whole.decision)
}

/// Sums, choices and deletions are computed for the parts and for the whole, which are two methods
/// with different null spaces.
#[test]
fn questions_are_answered_by_parts_as_by_the_whole() {
    let mut numbers = Numbers::new(SEED + 1);
    let (mut apart, mut sums, mut distributions, mut deletions) = (0, 0, 0, 0);
    for case in 0..cases(CASES / 2) {
        let drawn = draw(Kind::ALL[case % Kind::ALL.len()], &mut numbers);
        let sketch = &drawn.sketch;
        let mechanism = Mechanism::build(&sketch.description()).expect("the mechanism builds");
        let (q, _) = mechanism.described_state();
        let judged = [analyse, analyse_by_cycles].map(|f| f(&mechanism, 0.0, &q).expect("finite"));
        if judged[1].parts.len() == 1 || !judged.iter().all(|a| a.decision.is_decided()) {
            continue;
        }
        apart += 1;
        let redundancy = judged[0].decision.redundancy;
        let [whole, parts] = judged.map(|a| Questions::new(&mechanism, &q, a.into()));
        let ids: Vec<ConstraintId> = mechanism.layout().constraint_ids().collect();
        let some = |numbers: &mut Numbers| ids[numbers.below(ids.len())];
        let (a, b, c) = (some(&mut numbers), some(&mut numbers), some(&mut numbers));
        let groups = [
            Group::WrenchSum(vec![(1.0, a), (-2.0, b), (0.5, c)]),
            Group::Members(vec![a, b]),
            Group::OneJoint(vec![a, b, c]),
            Group::Resultant((0..mechanism.bodies().len()).collect()),
        ];
        for group in &groups {
            let [x, y] = [&whole, &parts].map(|q| q.group(group).expect("it exists"));
            let verdicts = |g: &GroupVerdict| -> Vec<&'static str> {
                let components = g.components.iter().map(|c| c.judgement.verdict.word());
                components.chain([g.judgement.verdict.word()]).collect()
            };
            for (x, y) in verdicts(&x).into_iter().zip(verdicts(&y)) {
                assert!(
                    x == y || x == "undecided" || y == "undecided",
                    "{group:?}: {x} {y}, {sketch:?}"
                );
                sums += 1;
            }
        }
        // All multipliers that differ by a vector of the null space are equivalent, so any of them
        // may be used.
        let multipliers: Vec<f64> = (0..mechanism.layout().rows())
            .map(|_| numbers.unit())
            .collect();
        let solution = Solution {
            acceleration: vec![0.0; mechanism.layout().n_v],
            multipliers: ChosenValues::new(multipliers, Vec::new()),
            no_finite: Vec::new(),
        };
        let least = Choice::MinimumNorm(NormWeights::NEWTON_METRE);
        let [x, y] = [&whole, &parts].map(|q| q.distribute(&solution, &least));
        if let (Ok(x), Ok(y)) = (&x, &y) {
            let number = |value: &Value| value.in_solution().expect("nothing is examined");
            let all = |d: &Distribution| -> Vec<f64> {
                let each = d.reactions.iter().flat_map(|r| &r.components);
                each.map(|(_, value)| number(value)).collect()
            };
            let (x, y) = (all(x), all(y));
            let largest = x.iter().fold(1.0_f64, |a, x| a.max(x.abs()));
            for (x, y) in x.iter().zip(&y) {
                assert!((x - y).abs() < 1e-7 * largest, "{x:e} {y:e}: {sketch:?}");
            }
            distributions += usize::from(redundancy > 0);
        }
        let [x, y] = [&whole, &parts].map(Questions::eliminations);
        if let (Ok(x), Ok(y)) = (x, y) {
            assert_eq!(x, y, "{sketch:?}");
            if x <= 500 {
                let sets = |q: &Questions<'_>| -> BTreeSet<Vec<usize>> {
                    let sets = q.elimination_sets(1000).expect("they were counted");
                    sets.into_iter().collect()
                };
                assert_eq!(sets(&whole), sets(&parts), "{sketch:?}");
                deletions += usize::from(x > 1);
            }
        }
        let limits = Limits::default();
        let ways = |q: &Questions<'_>| {
            let found = q.make_unique(a, &DeletableRows::Sensible, limits).ok()?;
            let complete = found.complete;
            let rows: BTreeSet<Vec<usize>> = found.ways.into_iter().map(|w| w.rows).collect();
            complete.then_some(rows)
        };
        if let (Some(x), Some(y)) = (ways(&whole), ways(&parts)) {
            assert_eq!(x, y, "{sketch:?}");
        }
    }
    assert!(
        apart > 60 && sums > 500 && distributions > 20 && deletions > 20,
        "{apart} {sums} {distributions} {deletions}"
    );
}
