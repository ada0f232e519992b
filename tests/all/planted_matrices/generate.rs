//! Matrices of many kinds: exact redundancy, redundancy with rounding errors, near redundancy, and
//! combinations of these.

use tests::numbers::Numbers;

/// How a matrix is constructed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Product of sparse integer matrices.
    Product,
    /// The same product, with its rows recombined by a unimodular integer matrix.
    Recombined,
    /// Rows and columns multiplied by powers of two from 1e-8 to 1e8.
    PowersOfTwo,
    /// The same with powers of two from 1e-120 to 1e120.
    Extreme,
    /// Rows and columns multiplied by powers of ten such that all entries remain integers.
    PowersOfTen,
    /// Duplicates and multiples of rows, empty rows and columns, often many more rows than columns.
    Duplicates,
    /// The matrix of Kahan, whose pivots do not show its smallest singular value, with multiples of
    /// its rows.
    Kahan,
    /// Parallel cranks under one coupler at points that are integer multiples of a power of two.
    Cranks,
    /// Rows and columns multiplied by powers of ten from 1e-8 to 1e8, rounded.
    Decimals,
    /// Products of fractions, rounded.
    Fractions,
    /// Redundant except for one entry of 1e-6 to 1e-20, or 1e-100, that replaces a zero.
    Near,
    /// Near and exact redundancy.
    NearAndExact,
    /// Parallel cranks, one of them misaligned by 1e-6 to 1e-20, or 1e-100.
    MisalignedCranks,
    /// No zeros, and no redundancy unless there are more rows than columns.
    Dense,
}

impl Kind {
    pub(super) const ALL: [Self; 14] = [
        Self::Product,
        Self::Recombined,
        Self::PowersOfTwo,
        Self::Extreme,
        Self::PowersOfTen,
        Self::Duplicates,
        Self::Kahan,
        Self::Cranks,
        Self::Decimals,
        Self::Fractions,
        Self::Near,
        Self::NearAndExact,
        Self::MisalignedCranks,
        Self::Dense,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Product => "whole products",
            Self::Recombined => "recombined rows",
            Self::PowersOfTwo => "scaled by powers of two, 1e-8 to 1e8",
            Self::Extreme => "scaled by powers of two, 1e-120 to 1e120",
            Self::PowersOfTen => "scaled by powers of ten, exactly",
            Self::Duplicates => "multiples of rows, empty rows and columns",
            Self::Kahan => "Kahan's matrix with multiples of its rows",
            Self::Cranks => "parallel cranks",
            Self::Decimals => "scaled by powers of ten, 1e-8 to 1e8, rounded",
            Self::Fractions => "products of fractions, rounded",
            Self::Near => "nearly redundant, 1e-6 to 1e-20 and 1e-100",
            Self::NearAndExact => "nearly and exactly redundant",
            Self::MisalignedCranks => "misaligned cranks, 1e-6 to 1e-20 and 1e-100",
            Self::Dense => "dense",
        }
    }

    /// Whether the constructed redundancy survives rounding.
    pub(super) fn is_exactly_planted(self) -> bool {
        !matches!(
            self,
            Self::Decimals
                | Self::Fractions
                | Self::Near
                | Self::NearAndExact
                | Self::MisalignedCranks
                | Self::Dense
        )
    }
}

type Rows = Vec<Vec<f64>>;

/// A matrix, row by row, with its rows and columns in random order.
pub(super) fn rows(kind: Kind, numbers: &mut Numbers) -> Rows {
    let rows = match kind {
        Kind::Product => product(numbers),
        Kind::Recombined => {
            let mut rows = product(numbers);
            recombine(&mut rows, numbers);
            rows
        }
        Kind::PowersOfTwo => scaled(&product(numbers), numbers, |numbers| {
            2_f64.powi(numbers.between(-27, 27))
        }),
        Kind::Extreme => scaled(&product(numbers), numbers, |numbers| {
            2_f64.powi(numbers.between(-400, 400))
        }),
        Kind::PowersOfTen => scaled(&product(numbers), numbers, |numbers| {
            10_f64.powi(numbers.between(0, 6))
        }),
        Kind::Duplicates => duplicates(numbers),
        Kind::Kahan => {
            let mut rows = kahan(numbers);
            append_multiples(&mut rows, numbers);
            rows
        }
        Kind::Cranks => cranks(0.0, numbers),
        Kind::Decimals => scaled(&product(numbers), numbers, |numbers| {
            10_f64.powi(numbers.between(-8, 8))
        }),
        Kind::Fractions => fractions(numbers),
        Kind::Near => near(numbers),
        Kind::NearAndExact => {
            let mut rows = near(numbers);
            append_multiples(&mut rows, numbers);
            rows
        }
        Kind::MisalignedCranks => cranks(small(numbers), numbers),
        Kind::Dense => dense(numbers),
    };
    permuted(&rows, numbers)
}

fn permuted(rows: &Rows, numbers: &mut Numbers) -> Rows {
    let (down, across) = (numbers.order(rows.len()), numbers.order(rows[0].len()));
    let row = |&i: &usize| across.iter().map(|&k| rows[i][k]).collect();
    down.iter().map(row).collect()
}

/// Returns a value from 1e-6 to 1e-20, sometimes 1e-100.
fn small(numbers: &mut Numbers) -> f64 {
    if numbers.once_in(8) {
        return 1e-100;
    }
    10_f64.powi(-numbers.between(6, 20)) * (1.0 + numbers.unit().abs())
}

/// Returns integers from −2 to 2, mostly 0.
fn sparse(m: usize, n: usize, numbers: &mut Numbers) -> Rows {
    let mut entry = || {
        if numbers.once_in(3) {
            f64::from(numbers.between(-2, 2))
        } else {
            0.0
        }
    };
    (0..m).map(|_| (0..n).map(|_| entry()).collect()).collect()
}

/// Returns a shape and a rank that leaves redundancy, sometimes large.
fn shape(numbers: &mut Numbers) -> (usize, usize, usize) {
    let most = if numbers.once_in(10) { 24 } else { 12 };
    let (m, n) = (2 + numbers.below(most - 1), 1 + numbers.below(most));
    (m, n, 1 + numbers.below(m.min(n)))
}

fn product(numbers: &mut Numbers) -> Rows {
    let (m, n, r) = shape(numbers);
    let (mut a, mut b) = (sparse(m, r, numbers), sparse(r, n, numbers));
    // With ones on the diagonals the rank is r in most cases.
    for j in 0..r {
        a[j][j] = 1.0;
        b[j][j] = 1.0;
    }
    multiplied(&a, &b)
}

fn multiplied(a: &Rows, b: &Rows) -> Rows {
    let entry = |row: &[f64], k: usize| row.iter().zip(b).map(|(x, b)| x * b[k]).sum();
    a.iter()
        .map(|row| (0..b[0].len()).map(|k| entry(row, k)).collect())
        .collect()
}

/// Adds multiples of rows to others.
fn recombine(rows: &mut Rows, numbers: &mut Numbers) {
    for _ in 0..2 * rows.len() {
        let (from, to) = (numbers.below(rows.len()), numbers.below(rows.len()));
        if from != to {
            let factor = f64::from(numbers.between(-2, 2));
            let source = rows[from].clone();
            for (x, y) in rows[to].iter_mut().zip(source) {
                *x += factor * y;
            }
        }
    }
}

/// Multiplies rows and columns by factors.
fn scaled(rows: &Rows, numbers: &mut Numbers, factor: impl Fn(&mut Numbers) -> f64) -> Rows {
    let across: Vec<f64> = rows[0].iter().map(|_| factor(numbers)).collect();
    let by =
        |row: &Vec<f64>, down: f64| row.iter().zip(&across).map(|(x, f)| x * f * down).collect();
    rows.iter().map(|row| by(row, factor(numbers))).collect()
}

fn dense(numbers: &mut Numbers) -> Rows {
    let (m, n, _) = shape(numbers);
    (0..m)
        .map(|_| (0..n).map(|_| numbers.unit()).collect())
        .collect()
}

fn duplicates(numbers: &mut Numbers) -> Rows {
    let (m, n, r) = shape(numbers);
    let base = sparse(r, n, numbers);
    let mut rows: Rows = (0..2 * m)
        .map(|_| {
            let factor = 2_f64.powi(numbers.between(-27, 27));
            base[numbers.below(r)].iter().map(|x| x * factor).collect()
        })
        .collect();
    let (row, column) = (numbers.below(rows.len()), numbers.below(n));
    rows[row].fill(0.0);
    if n > 1 {
        for row in &mut rows {
            row[column] = 0.0;
        }
    }
    rows
}

/// Appends a few rows times powers of two.
fn append_multiples(rows: &mut Rows, numbers: &mut Numbers) {
    for _ in 0..1 + numbers.below(3) {
        let factor = -2_f64.powi(numbers.between(-27, 27));
        let multiple = rows[numbers.below(rows.len())].iter().map(|x| x * factor);
        let multiple = multiple.collect();
        rows.push(multiple);
    }
}

/// Returns `diag(1, s, s², …)` times the unit upper triangle with −c above the diagonal, s² + c²
/// = 1.
fn kahan(numbers: &mut Numbers) -> Rows {
    let n = 6 + numbers.below(15);
    let (s, c) = (0.4 + 1.1 * numbers.unit().abs()).sin_cos();
    let entry = |i: usize, k: usize| match i.cmp(&k) {
        std::cmp::Ordering::Less => -c,
        std::cmp::Ordering::Equal => 1.0,
        std::cmp::Ordering::Greater => 0.0,
    };
    (0..n)
        .map(|i| (0..n).map(|k| s.powi(i as i32) * entry(i, k)).collect())
        .collect()
}

fn fractions(numbers: &mut Numbers) -> Rows {
    let (m, n, r) = shape(numbers);
    let (mut a, mut b) = (sparse(m, r, numbers), sparse(r, n, numbers));
    for x in a.iter_mut().chain(&mut b).flatten() {
        *x /= f64::from(numbers.between(1, 9));
    }
    multiplied(&a, &b)
}

/// Returns a product with one zero replaced, if it has a zero.
fn near(numbers: &mut Numbers) -> Rows {
    let mut rows = product(numbers);
    let places = (0..rows.len()).flat_map(|i| (0..rows[0].len()).map(move |k| (i, k)));
    let zeros: Vec<(usize, usize)> = places.filter(|&(i, k)| rows[i][k] == 0.0).collect();
    if !zeros.is_empty() {
        let (i, k) = zeros[numbers.below(zeros.len())];
        rows[i][k] = small(numbers);
    }
    rows
}

/// Three or four cranks have the same vector `a` from pivot to tip, under one coupler. The tip of
/// the last crank on the coupler is displaced by `error` across the line of the tips. Each crank
/// rotates about its pivot and has one column. The coupler has three columns.
fn cranks(error: f64, numbers: &mut Numbers) -> Rows {
    let count = 3 + numbers.below(2);
    let size = 2_f64.powi(numbers.between(-27, 27));
    let mut whole = |low: i32, high: i32| size * f64::from(numbers.between(low, high));
    let a = [whole(-40, 40), whole(1, 40)];
    let spread = whole(1, 50);
    let mut rows = Vec::new();
    for crank in 0..count {
        // Position of the tip relative to the middle of the coupler.
        let x = spread * (crank as f64 - 1.0);
        let y = if crank + 1 == count {
            error * size
        } else {
            0.0
        };
        for axis in 0..2 {
            let mut row = vec![0.0; count + 3];
            row[crank] = [-a[1], a[0]][axis];
            row[count + axis] = -1.0;
            row[count + 2] = [y, -x][axis];
            rows.push(row);
        }
    }
    rows
}
