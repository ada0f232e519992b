//! Verdicts cycle by cycle are those of the whole: random mechanisms with planted redundancy, and ranks by exact arithmetic.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use model::{Mechanism, System};
use solvability::{Verdict, analyse, survey};
use stress::reference::{Dyadic, Exact};
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
        // Rows of the mechanism, by the names of joints: holonomic ones come first there.
        let mut rows_of = BTreeMap::new();
        for block in sketch.exact_rows() {
            rows_of.insert(block.name.clone(), block.rows);
        }
        let groups = mechanism.layout().groups.iter();
        let c: Vec<Vec<Dyadic>> = groups.flat_map(|g| rows_of[&g.name].clone()).collect();
        let whole = analyse(&mechanism, 0.0, &q).expect("C is finite");
        let told = AtomicUsize::new(0);
        let found = survey(&mechanism, 0.0, &q, |n| {
            told.fetch_max(n, Ordering::Relaxed);
        })
        .expect("C is finite");
        assert_eq!(told.into_inner(), whole.reactions.len());
        apart += usize::from(found.parts.len() > 1);
        let is_decided = |a: &solvability::Analysis| a.decision.is_decided();
        if found.parts.iter().all(|p| p.verdicts.rows.is_decided()) {
            let exact = Exact::of_dyadic(&c).rank();
            assert_eq!(found.rank(), exact, "{}", described(&found, &whole));
            let [kept, dropped] = found.rows();
            assert_eq!(
                [kept.len(), dropped.len()],
                [found.rank(), found.redundancy()]
            );
            let kept: Vec<Vec<Dyadic>> = kept.iter().map(|&i| c[i].clone()).collect();
            assert_eq!(Exact::of_dyadic(&kept).rank(), kept.len(), "{sketch:?}");
        }
        if !is_decided(&whole) {
            continue;
        }
        for (a, b) in whole.reactions.iter().zip(found.reactions()) {
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

fn described(found: &solvability::Survey, whole: &solvability::Analysis) -> String {
    let parts = found.parts.iter().map(|part| {
        let names: Vec<&str> = part
            .verdicts
            .reactions
            .iter()
            .map(|r| r.name.as_str())
            .collect();
        format!("{names:?}: {:?}\n", part.verdicts.rows)
    });
    format!("{}whole: {:?}", parts.collect::<String>(), whole.decision)
}
