//! Sparse rank decisions on large mechanisms whose results are known without numerical computation.

use linalg::SparseMatrix;
use mechanisms::{Known, chain, grid, table};
use pfaff_rank::{CoefficientReading, Sketch, decide_sparse};

mod mechanisms;

fn check(known: &Known) {
    let found = decide_sparse(&known.c, 0.0, &known.bodies, Sketch::default()).expect("finite");
    let name = &known.name;
    assert!(found.is_decided(), "{name}: {:?}", found.status);
    assert_eq!(found.redundancy, known.redundancy, "{name}");
    assert_eq!(found.kept.len(), found.rank, "{name}");
    for (i, is_unique) in known.is_unique.iter().enumerate() {
        let expected = if *is_unique {
            CoefficientReading::Zero
        } else {
            CoefficientReading::NonZero
        };
        assert_eq!(found.read_row(i), expected, "{name}: row {i}");
    }
    let e = &found.evidence;
    assert!(e.smallest_margin > 1e8 * e.largest_zero, "{name}: {e:?}");
    assert!(e.backward_error < 1e-11, "{name}: {e:?}");
    // Bodies have a bounded number of joints, so memory is proportional to the rows.
    assert!(e.bytes < 1200 * known.c.nrows(), "{name}: {e:?}");
}

#[test]
fn chains_of_parallelograms() {
    for cells in [1, 2, 3, 30, 3_000] {
        check(&chain(cells));
    }
}

#[test]
fn many_joints_at_one_body() {
    for legs in [2, 3, 20, 60] {
        check(&table(legs));
    }
}

#[test]
fn grids_of_welded_bodies() {
    for side in [2, 3, 10, 30] {
        check(&grid(side));
    }
}

#[test]
fn kept_rows_are_as_many_and_independent() {
    let known = chain(12);
    let found = decide_sparse(&known.c, 0.0, &known.bodies, Sketch::default()).expect("finite");
    let kept = pfaff_rank::decide(
        &known.c.select_rows(&found.kept).dense(),
        pfaff_rank::Accuracy::Rounding,
    )
    .expect("finite");
    assert_eq!((kept.rank, kept.redundancy), (found.rank, 0));
    assert!(kept.is_decided());
    assert_eq!(found.dropped.len(), known.redundancy);
}

/// Two rows differ by 1e-5, and a third one is orthogonal to the first: it is independent,
/// whichever of the two comes first.
#[test]
fn of_nearly_parallel_rows_one_is_kept() {
    let rows = [[1.0, 0.0], [1.0, 1e-5], [0.0, 1.0]];
    for order in [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0]] {
        let row = |k: usize| rows[k].into_iter().enumerate().filter(|(_, c)| *c != 0.0);
        let c = SparseMatrix::from_rows(2, order.map(row)).expect("two columns");
        let found = decide_sparse(&c, 0.0, &[0..1, 1..2], Sketch::default()).expect("finite");
        assert_eq!(found.rank, 2, "{order:?}");
        let kept: Vec<usize> = found.kept.iter().map(|&k| order[k]).collect();
        assert!(kept.contains(&2), "{order:?}: {kept:?}");
    }
}

/// Bodies and rows in another order, another unit of length, and one unit for each row give the
/// same results.
#[test]
fn order_and_units_do_not_matter() {
    let known = chain(20);
    let (m, n) = (known.c.nrows(), known.c.ncols());
    // A step without a common divisor visits all numbers.
    let step = |k: usize, of: usize| (k * 7919 + 3) % of;
    for (length, decades) in [(1e-9, 3), (1.0, 3), (1e6, 3), (1.0, 8)] {
        let row = |k: usize| {
            let (columns, values) = known.c.row(step(k, m));
            let unit = 10f64.powi(step(k, 37) as i32 % (2 * decades + 1) - decades);
            let entry = |(j, value): (&usize, &f64)| {
                let column = 3 * step(j / 3, n / 3) + j % 3;
                let length = if j % 3 == 2 { length } else { 1.0 };
                (column, value * unit * length)
            };
            columns.iter().zip(values).map(entry).collect::<Vec<_>>()
        };
        let c = SparseMatrix::from_rows(n, (0..m).map(row)).expect("columns of bodies");
        let found = decide_sparse(&c, 0.0, &known.bodies, Sketch::default()).expect("finite");
        if decades > 3 && !found.is_decided() {
            // The dense code does not do this either: equilibration cannot distinguish such units
            // from such sizes.
            let dense =
                pfaff_rank::decide(&c.dense(), pfaff_rank::Accuracy::Rounding).expect("finite");
            assert!(!dense.is_decided());
            continue;
        }
        assert!(found.is_decided(), "{:?}", found.status);
        assert_eq!(found.redundancy, known.redundancy);
        for k in 0..m {
            let is_unique = found.read_row(k) == CoefficientReading::Zero;
            assert_eq!(is_unique, known.is_unique[step(k, m)], "row {k}");
        }
    }
}
