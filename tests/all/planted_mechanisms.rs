//! Mechanisms with constructed redundancy at configurations on a grid, analysed by `solvability`
//! and by exact arithmetic. The bodies have arbitrary angles, so the parameters in their frames are
//! rounded. The correct result is the result for the mechanism before this rounding.
//!
//! `PFAFF_CASES=20000 cargo test -p tests planted_mechanisms -- --nocapture` makes a longer run.

pub(crate) mod generate;

use exact::{Dyadic, Exact};
use model::Mechanism;
use solvability::analyse;
use tests::numbers::Numbers;
use tests::sketch::{Sketch, Tie};

use crate::tally::{Tally, cases};
use generate::{Drawn, Kind};

const SEED: u64 = 11_044_013;

const CASES: usize = 3000;

#[test]
fn no_verdict_is_wrong() {
    let mut numbers = Numbers::new(SEED);
    let mut tally = Tally::default();
    for case in 0..cases(CASES) {
        let kind = Kind::ALL[case % Kind::ALL.len()];
        tally.case(kind.name());
        judge(&generate::draw(kind, &mut numbers), &mut tally);
    }
    tally.conclude("mechanisms", SEED, Kind::ALL.map(Kind::name));
}

/// Compares every verdict of one mechanism.
fn judge(drawn: &Drawn, tally: &mut Tally) {
    let Drawn { sketch, redundancy } = drawn;
    let blocks = sketch.exact_rows();
    let c: Vec<Vec<Dyadic>> = blocks.iter().flat_map(|b| b.rows.clone()).collect();
    let exact = Exact::of_dyadic(&c);
    if let &Some(expected) = redundancy {
        tally.number(c.len() - exact.rank(), expected, || {
            format!("redundancy in exact arithmetic, by theory, of {sketch:?}")
        });
    }

    let mechanism = Mechanism::build(&sketch.description()).expect("the mechanism builds");
    let (q, _) = mechanism.described_state();
    let analysis = analyse(&mechanism, 0.0, &q).expect("C is finite");
    if !analysis.decision.is_decided() {
        return tally.undecided(|| format!("{:?} of {sketch:?}", analysis.decision.status));
    }
    tally.number(analysis.decision.rank, exact.rank(), || {
        format!("rank of {sketch:?}")
    });
    if analysis.warnings.is_empty() {
        let (holonomic, nonholonomic) = ranks_apart(sketch);
        tally.number(analysis.rank_holonomic, holonomic, || {
            format!("rank of Φq of {sketch:?}")
        });
        tally.number(analysis.rank_nonholonomic, nonholonomic, || {
            format!("rank of Ψ of {sketch:?}")
        });
    } else {
        // The rank of Φq or of Ψ alone is undecided.
        tally.undecided(|| format!("{:?} of {sketch:?}", analysis.warnings));
    }

    let mut first = 0;
    for block in &blocks {
        let rows: Vec<usize> = (first..first + block.rows.len()).collect();
        first += rows.len();
        let name = &block.name;
        let found = analysis
            .reactions
            .iter()
            .find(|r| r.name == *name)
            .expect("the joint is judged");
        let freedom = exact.freedom(&rows);
        tally.judgement(&found.wrench, freedom == 0, || {
            format!("wrench of {name} of {sketch:?}")
        });
        let unique = rows.iter().all(|&i| exact.row_is_unique(i));
        tally.judgement(&found.multipliers, unique, || {
            format!("multipliers of {name} of {sketch:?}")
        });
        for (k, row) in found.rows.iter().enumerate() {
            let unique = exact.row_is_unique(rows[k]);
            tally.judgement(&row.judgement, unique, || {
                format!("row {k} of {name} of {sketch:?}")
            });
        }
        let directions = found.components.len() - freedom;
        if directions > 0 && found.unique_directions.is_empty() {
            // The list is also empty if the number of directions is uncertain.
            tally.undecided(|| format!("unique directions of {name} of {sketch:?}"));
            continue;
        }
        tally.number(found.unique_directions.len(), directions, || {
            format!("unique directions of {name} of {sketch:?}")
        });
    }
}

/// Returns the ranks of Φq and of Ψ.
fn ranks_apart(sketch: &Sketch) -> (usize, usize) {
    let rank_where = |nonholonomic: bool| {
        let blocks = sketch.exact_rows().into_iter().zip(&sketch.links);
        let own = blocks.filter(|(_, link)| link.tie.is_nonholonomic() == nonholonomic);
        Exact::of_dyadic(&own.flat_map(|(block, _)| block.rows).collect::<Vec<_>>()).rank()
    };
    (rank_where(false), rank_where(true))
}

/// One body has three parallel edges, at many headings. If the normals are parallel to an axis up
/// to rounding, a column of C contains only rounding errors, which must not count.
#[test]
fn parallel_edges_at_any_heading() {
    let mut numbers = Numbers::new(SEED);
    let wrong: Vec<f64> = (0..2000)
        .map(|_| 3.0 * numbers.unit())
        .filter(|&angle| {
            let mut sketch = Sketch::default();
            let cart = sketch.body([0.0; 2], angle);
            // The normal is the same, rounded in three ways.
            for (at, length) in [([-1.0, 1.5], 1.0), ([0.5, -2.0], 3.0), ([2.0, 1.0], 7.0)] {
                let normal = [0.0, length];
                sketch.link(&[cart], Tie::KnifeEdge { at, normal });
            }
            let mechanism = Mechanism::build(&sketch.description()).expect("the cart builds");
            let (q, _) = mechanism.described_state();
            let decision = analyse(&mechanism, 0.0, &q)
                .expect("finite")
                .whole()
                .expect("one part")
                .into_owned();
            decision.is_decided() && decision.rank != 2
        })
        .collect();
    assert!(
        wrong.is_empty(),
        "rank 3 at {} headings, for example {}",
        wrong.len(),
        wrong[0]
    );
}
