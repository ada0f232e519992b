//! Large mechanisms whose rank and unique rows are known without numerical computation; for tests
//! and the example `large_rank`.

use std::ops::Range;

use linalg::SparseMatrix;

/// A constraint matrix with results known without numerical computation.
pub(crate) struct Known {
    pub(crate) name: String,
    pub(crate) c: SparseMatrix,
    /// Columns of each body.
    pub(crate) bodies: Vec<Range<usize>>,
    pub(crate) redundancy: usize,
    /// Rows whose multiplier is unique.
    pub(crate) is_unique: Vec<bool>,
}

type Row = Vec<(usize, f64)>;

/// Returns the two rows of a revolute joint: equal velocities of the points at `arm` of each body;
/// no body means the ground.
fn revolute(sides: [Option<(usize, [f64; 2])>; 2]) -> [Row; 2] {
    let mut rows = [Vec::new(), Vec::new()];
    for (side, sign) in sides.into_iter().zip([1.0, -1.0]) {
        if let Some((body, [x, y])) = side {
            rows[0].extend([(3 * body, sign), (3 * body + 2, -sign * y)]);
            rows[1].extend([(3 * body + 1, sign), (3 * body + 2, sign * x)]);
        }
    }
    rows
}

/// Returns a stack of couplers, each on parallel cranks on the one below: three cranks or, in every
/// third cell, two.
pub(crate) fn chain(cells: usize) -> Known {
    let cranks = (0..cells).map(|cell| if cell % 3 == 2 { 2 } else { 3 });
    parallelograms(format!("chain {cells}"), cranks)
}

/// Returns one coupler on `legs` parallel cranks on the ground: all joints of the upper side are on
/// one body.
pub(crate) fn table(legs: usize) -> Known {
    parallelograms(format!("table {legs}"), [legs])
}

/// Returns cells with the given numbers of cranks. Two cranks keep the coupler parallel; each
/// further crank adds one redundancy, in which all multipliers of the cell take part.
fn parallelograms(name: String, cranks: impl IntoIterator<Item = usize>) -> Known {
    let (mut rows, mut is_unique) = (Vec::new(), Vec::new());
    let (mut bodies, mut redundancy) = (0, 0);
    let mut base = None;
    for (cell, cranks) in cranks.into_iter().enumerate() {
        redundancy += cranks - 2;
        let coupler = bodies + cranks;
        let angle = 0.3 + 0.9 * (1.7 * cell as f64).sin().abs();
        let half =
            [angle.cos(), angle.sin()].map(|a| (1.0 + 0.5 * (2.3 * cell as f64).sin()) * a / 2.0);
        for k in 0..cranks {
            let foot = k as f64 - (cranks as f64 - 1.0) / 2.0;
            let crank = bodies + k;
            rows.extend(revolute([
                Some((crank, half.map(|a| -a))),
                base.map(|base| (base, [foot, 0.1])),
            ]));
            rows.extend(revolute([
                Some((crank, half)),
                Some((coupler, [foot, -0.1])),
            ]));
        }
        is_unique.resize(rows.len(), cranks == 2);
        base = Some(coupler);
        bodies = coupler + 1;
    }
    known(name, rows, bodies, redundancy, is_unique)
}

/// Returns free bodies in a square grid with welded neighbours: a circuit of three rows for every
/// edge that is not in a spanning tree, and every edge in some circuit.
pub(crate) fn grid(side: usize) -> Known {
    let at = |x: usize, y: usize| side * y + x;
    let mut rows = Vec::new();
    let mut weld = |a: usize, b: usize, arm: [f64; 2]| {
        rows.extend(revolute([Some((a, arm)), Some((b, arm.map(|x| -x)))]));
        rows.push(vec![(3 * a + 2, 1.0), (3 * b + 2, -1.0)]);
    };
    for y in 0..side {
        for x in 1..side {
            weld(at(x - 1, y), at(x, y), [0.5, 0.0]);
            weld(at(y, x - 1), at(y, x), [0.0, 0.5]);
        }
    }
    let bodies = side * side;
    let redundancy = rows.len() - 3 * (bodies - 1);
    let is_unique = vec![false; rows.len()];
    known(format!("grid {side}"), rows, bodies, redundancy, is_unique)
}

fn known(
    name: String,
    rows: Vec<Row>,
    bodies: usize,
    redundancy: usize,
    is_unique: Vec<bool>,
) -> Known {
    Known {
        name,
        c: SparseMatrix::from_rows(3 * bodies, rows).expect("columns of bodies"),
        bodies: (0..bodies).map(|b| 3 * b..3 * b + 3).collect(),
        redundancy,
        is_unique,
    }
}
