//! Verdicts cycle by cycle are those of the whole: random mechanisms with planted redundancy, and ranks by exact arithmetic.

use model::Mechanism;
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
        let blocks = sketch.exact_rows();
        let c: Vec<Vec<Dyadic>> = blocks.iter().flat_map(|b| b.rows.clone()).collect();
        let mechanism = Mechanism::build(&sketch.description()).expect("the mechanism builds");
        let (q, _) = mechanism.described_state();
        let whole = analyse(&mechanism, 0.0, &q).expect("C is finite");
        let mut told = 0;
        let found = survey(&mechanism, 0.0, &q, |n| told = n).expect("C is finite");
        assert_eq!(told, whole.reactions.len());
        apart += usize::from(found.parts.len() > 1);
        let is_decided = |a: &solvability::Analysis| a.decision.is_decided();
        if found.parts.iter().all(|p| is_decided(&p.analysis)) {
            for part in &found.parts {
                let own: Vec<Vec<Dyadic>> =
                    part.places.rows.iter().map(|&i| c[i].clone()).collect();
                let d = &part.analysis.decision;
                let rank = Exact::of_dyadic(&own).rank();
                assert_eq!(
                    d.rank, rank,
                    "{:?} of {sketch:?}\n{:?}",
                    part.places, d.evidence
                );
            }
            assert_eq!(found.rank(), Exact::of_dyadic(&c).rank(), "{sketch:?}");
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
