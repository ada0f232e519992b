//! Tests whether [`solvability::common_zero`] decides correctly whether quadratic forms with
//! integer coefficients have a common zero. An independent decision with integers gives the correct
//! result.
//!
//! Half of the sets are constructed: they have a common zero with integer coordinates or a double
//! zero, or are the forms of mechanisms at symmetric configurations. The other sets are random.

mod polynomial;
mod truth;

use std::collections::BTreeMap;
use std::fmt::Write;

use linalg::Matrix;
use solvability::{CommonZero, common_zero};

use suite::numbers::Numbers;
use truth::{Truth, all_vanish, has_zero_near, value};

/// A symmetric matrix of integers.
type Form = Vec<Vec<i64>>;

/// Origin of a set of forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// Random coefficients.
    Random,
    /// Forms with a common zero that has integer coordinates.
    Zero,
    /// Forms with a common zero at which the gradients are dependent.
    Double,
    /// Forms of a mechanism at a symmetric configuration.
    Mechanism,
}

/// A set of forms, with the constructed zero if the set has one.
#[derive(Clone, Debug)]
pub struct Forms {
    origin: Origin,
    forms: Vec<Form>,
    zero: Option<Vec<i64>>,
}

impl Forms {
    /// Draws the set with this number. A set has two to four unknowns; every second set is
    /// constructed.
    #[must_use]
    pub fn draw(seed: u64, number: u64) -> Self {
        let mut n = Numbers::new(seed ^ number.wrapping_mul(0x2545_f491_4f6c_dd1d));
        let unknowns = 2 + n.below(3);
        let count = 1 + n.below(unknowns + 1);
        let origin = match (number % 2, n.below(3)) {
            (0, _) => Origin::Random,
            (_, 0) => Origin::Zero,
            (_, 1) => Origin::Double,
            _ => Origin::Mechanism,
        };
        match origin {
            Origin::Random => Self {
                origin,
                forms: (0..count).map(|_| random(&mut n, unknowns)).collect(),
                zero: None,
            },
            Origin::Mechanism => Self {
                origin,
                forms: mechanism(&mut n, unknowns),
                zero: None,
            },
            Origin::Zero | Origin::Double => {
                let zero = point(&mut n, unknowns);
                let through = |n: &mut Numbers| through(random(n, unknowns), &zero);
                let forms = if origin == Origin::Zero {
                    (0..count).map(|_| through(&mut n)).collect()
                } else {
                    double(&mut n, count, &zero)
                };
                Self {
                    origin,
                    forms,
                    zero: Some(zero),
                }
            }
        }
    }

    fn unknowns(&self) -> usize {
        self.forms[0].len()
    }

    fn decided(&self) -> CommonZero {
        let matrix = |f: &Form| Matrix::from_fn(f.len(), f.len(), |i, j| f[i][j] as f64);
        let forms: Vec<Matrix> = self.forms.iter().map(matrix).collect();
        // The error bound is zero, because integers are exact.
        common_zero(&forms, 0.0)
    }

    /// Compares the decision with the correct result.
    fn compared(&self) -> Outcome {
        let planted = self
            .zero
            .as_ref()
            .is_some_and(|p| all_vanish(&self.forms, p));
        let known = truth::truth(&self.forms);
        match (self.decided(), known) {
            (CommonZero::None, Truth::Simple | Truth::Double) => Outcome::Wrong,
            (CommonZero::None, _) if planted => Outcome::Wrong,
            (CommonZero::None, Truth::None) => Outcome::None,
            (CommonZero::None, Truth::Open) => Outcome::NoneUnconfirmed,
            (CommonZero::Transversal(_), Truth::None) => Outcome::Wrong,
            (CommonZero::Transversal(a), _) => {
                if known == Truth::Simple || has_zero_near(&self.forms, &a) {
                    Outcome::Zero
                } else {
                    Outcome::Wrong
                }
            }
            (_, Truth::None) => Outcome::Undecided { is_double: false },
            // A simple zero of one form must be decided. A common zero of two or more forms in two
            // unknowns is a coincident root and may be undecided.
            (_, Truth::Simple) => Outcome::Undecided { is_double: false },
            (_, Truth::Double) => Outcome::Undecided { is_double: true },
            (_, Truth::Open) => Outcome::Undecided { is_double: planted },
        }
    }
}

/// Returns coefficients from −9 to 9.
fn random(n: &mut Numbers, unknowns: usize) -> Form {
    let mut form = vec![vec![0; unknowns]; unknowns];
    for i in 0..unknowns {
        for j in 0..=i {
            let x = i64::from(n.between(-9, 9));
            (form[i][j], form[j][i]) = (x, x);
        }
    }
    if form.iter().flatten().all(|x| *x == 0) {
        form[0][0] = 1;
    }
    form
}

/// Returns a random point with one coordinate equal to 1.
fn point(n: &mut Numbers, unknowns: usize) -> Vec<i64> {
    let one = n.below(unknowns);
    (0..unknowns)
        .map(|k| {
            if k == one {
                1
            } else {
                i64::from(n.between(-4, 4))
            }
        })
        .collect()
}

/// Returns the form f minus `f(p)·x_k²`, for an index k with `p_k = 1`. The result is zero at p.
fn through(mut form: Form, p: &[i64]) -> Form {
    let k = p.iter().position(|x| *x == 1).unwrap_or(0);
    form[k][k] -= value(&form, p);
    form
}

/// Returns forms that are zero at p and have parallel gradients at p: f, and forms
/// `c·f + (∇f(p)·x)²`. A single form is the square of a linear form.
fn double(n: &mut Numbers, count: usize, p: &[i64]) -> Vec<Form> {
    let unknowns = p.len();
    let square = |l: &[i64], c: i64| -> Form {
        (0..unknowns)
            .map(|i| (0..unknowns).map(|j| c * l[i] * l[j]).collect())
            .collect()
    };
    let first = through(random(n, unknowns), p);
    let gradient: Vec<i64> = first
        .iter()
        .map(|row| row.iter().zip(p).map(|(m, x)| m * x).sum())
        .collect();
    let is_flat = gradient.iter().all(|g| *g == 0);
    if count == 1 || is_flat {
        // The linear form satisfies l·p = 0.
        let (a, b) = (n.below(unknowns), n.below(unknowns));
        let mut l = vec![0; unknowns];
        l[a] += p[b];
        l[b] -= p[a];
        if l.iter().all(|x| *x == 0) {
            let k = p.iter().position(|x| *x == 1).unwrap_or(0);
            let other = (k + 1) % unknowns;
            (l[other], l[k]) = (1, -p[other]);
        }
        return vec![square(&l, 1)];
    }
    let mut forms = vec![first.clone()];
    for _ in 1..count.min(unknowns.min(2)) {
        let (a, c) = (i64::from(n.between(-3, 3)), i64::from(n.between(1, 3)));
        let other = square(&gradient, c);
        let sum = |i: usize, j: usize| a * first[i][j] + other[i][j];
        let sum = (0..unknowns).map(|i| (0..unknowns).map(|j| sum(i, j)).collect());
        forms.push(sum.collect());
    }
    forms
}

/// Returns forms of mechanisms at symmetric configurations.
fn mechanism(n: &mut Numbers, unknowns: usize) -> Vec<Form> {
    let zero = || vec![vec![0; unknowns]; unknowns];
    let add = |form: &mut Form, i: usize, j: usize, c: i64| {
        form[i][j] += c;
        if i != j {
            form[j][i] += c;
        }
    };
    match n.below(3) {
        // A straight chain between two pins has rods that point forward or backward. The form of
        // the chain is Σ ±(y − y')²/l, times 12.
        0 => {
            let mut form = zero();
            for k in 0..=unknowns {
                let c = 12 / i64::from(n.between(1, 4)) * if n.once_in(3) { -1 } else { 1 };
                if k > 0 {
                    add(&mut form, k - 1, k - 1, c);
                }
                if k < unknowns {
                    add(&mut form, k, k, c);
                }
                if k > 0 && k < unknowns {
                    add(&mut form, k - 1, k, -c);
                }
            }
            vec![form]
        }
        // Platforms on three equal legs have two degrees of freedom each and the forms x² − y² and
        // x·y, here in rotated axes.
        1 => {
            let mut forms = Vec::new();
            for k in 0..unknowns / 2 {
                let (x, y) = (2 * k, 2 * k + 1);
                let (a, b) = (i64::from(n.between(1, 5)), i64::from(n.between(-5, 5)));
                let mut real = zero();
                add(&mut real, x, x, a);
                add(&mut real, y, y, -a);
                add(&mut real, x, y, b);
                let mut imaginary = zero();
                add(&mut imaginary, x, x, -b);
                add(&mut imaginary, y, y, b);
                add(&mut imaginary, x, y, a);
                forms.extend([real, imaginary]);
            }
            if unknowns == 3 {
                let mut last = zero();
                add(&mut last, 2, 2, i64::from(n.between(1, 9)));
                add(&mut last, 0, 2, i64::from(n.between(-9, 9)));
                forms.push(last);
            }
            forms
        }
        // A row of four-bars in the singular configuration has the equation (v' − v)·[(v' + v)/L −
        // (v' − v)/d] = 0 for each coupler.
        _ => {
            let (length, pitch) = (i64::from(n.between(1, 6)), i64::from(n.between(7, 9)));
            (1..unknowns)
                .map(|k| {
                    let mut form = zero();
                    add(&mut form, k, k, pitch - length);
                    add(&mut form, k - 1, k - 1, -pitch - length);
                    add(&mut form, k - 1, k, length);
                    form
                })
                .collect()
        }
    }
}

/// Result for one set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    None,
    NoneUnconfirmed,
    Zero,
    Undecided { is_double: bool },
    Wrong,
}

/// Results for many sets.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    counts: BTreeMap<(usize, Origin, Outcome), u64>,
    /// Indices of the sets with a wrong decision, and of the sets in two unknowns that were not
    /// decided although no roots coincide, with descriptions.
    pub faults: Vec<(u64, String)>,
}

impl Tally {
    /// Tests the sets of a seed, beginning with `from`; `done` is called after each set.
    #[must_use]
    pub fn of(seed: u64, from: u64, sets: u64, done: impl Fn()) -> Self {
        let mut tally = Self::default();
        for number in from..from + sets {
            let set = Forms::draw(seed, number);
            let outcome = set.compared();
            let open = outcome == Outcome::Undecided { is_double: false };
            if outcome == Outcome::Wrong || (open && set.unknowns() == 2) {
                let found = format!("{outcome:?} {:?} {:?}", set.origin, set.forms);
                tally.faults.push((number, found));
            }
            let key = (set.unknowns(), set.origin, outcome);
            *tally.counts.entry(key).or_default() += 1;
            done();
        }
        tally
    }

    /// Returns two numbers for random forms in this number of unknowns: the undecided sets, and all
    /// sets.
    #[must_use]
    pub fn undecided(&self, unknowns: usize) -> [u64; 2] {
        let random = self.counts.iter();
        let random =
            random.filter(|((n, origin, _), _)| *n == unknowns && *origin == Origin::Random);
        random.fold([0, 0], |[open, all], ((_, _, outcome), count)| {
            let is_open = matches!(outcome, Outcome::Undecided { .. });
            [open + if is_open { *count } else { 0 }, all + count]
        })
    }

    /// Whether no decision is wrong and few sets are undecided. In two unknowns, only sets with
    /// coincident zeros may be undecided. In three unknowns, at most one of twenty random sets may
    /// be undecided.
    #[must_use]
    pub fn passes(&self) -> bool {
        let [open, all] = self.undecided(3);
        self.faults.is_empty() && 20 * open <= all
    }

    /// Returns a table, and a line for each fault.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = String::new();
        // Writing into a string does not fail.
        for ((unknowns, origin, outcome), count) in &self.counts {
            let outcome = match outcome {
                Outcome::None => "no common zero",
                Outcome::NoneUnconfirmed => "no common zero, not confirmed",
                Outcome::Zero => "a common zero",
                Outcome::Undecided { is_double: true } => "undecided, a double zero",
                Outcome::Undecided { is_double: false } => "undecided",
                Outcome::Wrong => "WRONG",
            };
            let _ = writeln!(
                text,
                "{unknowns} unknowns, {origin:?}: {count:>5} {outcome}"
            );
        }
        for unknowns in 2..=4 {
            let [open, all] = self.undecided(unknowns);
            let _ = writeln!(
                text,
                "{unknowns} unknowns: {open} of {all} random sets undecided"
            );
        }
        for (number, fault) in &self.faults {
            let _ = writeln!(text, "set {number}: {fault}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_are_decided_as_whole_numbers_say() {
        let tally = Tally::of(1, 0, 200, || {});
        assert!(tally.passes(), "{}", tally.describe());
    }
}
