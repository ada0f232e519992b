//! Decides independently with integers whether quadratic forms have a common real zero.
//!
//! For one form the decision uses the signs of its principal minors. For two unknowns it uses the
//! greatest common divisor of the forms and its roots. For three unknowns it uses the resultants of
//! pairs of forms, in coordinates in which every common zero has a separate direction. For four
//! unknowns, the sphere is covered by boxes with integer corners; in each box, one form or a sum of
//! some forms has no zero.

use num_bigint::BigInt;
use num_traits::{Signed, Zero};

use super::Form;
use super::polynomial::Polynomial;

/// The correct result for forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Truth {
    /// The forms have no common zero.
    None,
    /// A common zero at which the gradients are independent.
    Simple,
    /// The forms have a common zero. At every common zero the gradients are dependent.
    Double,
    /// The result is unknown.
    Open,
}

/// Decides for one form, for forms in two or three unknowns, and for other forms if boxes prove
/// that they have no common zero.
pub(super) fn truth(forms: &[Form]) -> Truth {
    let unknowns = forms[0].len();
    match (forms, unknowns) {
        ([one], _) => of_one(one),
        (_, 2) => of_two_unknowns(forms),
        (_, 3) => (0..CHANGES)
            .map(|change| of_three_unknowns(&changed(forms, change)))
            .find(|truth| *truth != Truth::Open)
            .unwrap_or(Truth::Open),
        _ if covered(forms) => Truth::None,
        _ => Truth::Open,
    }
}

/// Number of changes of coordinates that are tried.
const CHANGES: i64 = 4;

/// Decides for one form. A definite form has no zero; its leading principal minors show the
/// definiteness. A form that is semidefinite and not definite has double zeros.
fn of_one(form: &Form) -> Truth {
    let n = form.len();
    let definite = |sign: i64| {
        (1..=n).all(|k| {
            let minor: Vec<Vec<BigInt>> = (0..k)
                .map(|i| (0..k).map(|j| BigInt::from(sign * form[i][j])).collect())
                .collect();
            determinant(minor).is_positive()
        })
    };
    if definite(1) || definite(-1) {
        return Truth::None;
    }
    // A form is semidefinite if all principal minors of the form, or of the negative form, are at
    // least zero.
    let semidefinite = |sign: i64| {
        (1..1_usize << n).all(|set| {
            let chosen: Vec<usize> = (0..n).filter(|i| set >> i & 1 == 1).collect();
            let minor = chosen.iter().map(|&i| {
                let row = chosen.iter();
                row.map(|&j| BigInt::from(sign * form[i][j])).collect()
            });
            !determinant(minor.collect()).is_negative()
        })
    };
    if semidefinite(1) || semidefinite(-1) {
        Truth::Double
    } else {
        Truth::Simple
    }
}

/// Computes the determinant by expansion along the first row.
fn determinant(m: Vec<Vec<BigInt>>) -> BigInt {
    if m.is_empty() {
        return BigInt::from(1);
    }
    (0..m.len())
        .map(|j| {
            let rest = m[1..].iter().map(|row| {
                let others = row.iter().enumerate().filter(|(k, _)| *k != j);
                others.map(|(_, x)| x.clone()).collect()
            });
            let term = &m[0][j] * determinant(rest.collect());
            if j % 2 == 0 { term } else { -term }
        })
        .sum()
}

/// Decides for two or more forms; coordinates are changed until no zero is at y = 0.
fn of_two_unknowns(forms: &[Form]) -> Truth {
    let forms = (0..8)
        .map(|k| changed(forms, k))
        .find(|forms| forms.iter().all(|f| f[0][0] != 0));
    let Some(forms) = forms else {
        return Truth::Open;
    };
    let of = |f: &Form| Polynomial::new([f[1][1], 2 * f[0][1], f[0][0]].map(BigInt::from).to_vec());
    let mut common = of(&forms[0]);
    for form in &forms[1..] {
        common = common.common(&of(form));
    }
    match (common.degree(), common.real_roots()) {
        (Some(0), _) | (_, 0) => Truth::None,
        // All forms are multiples of one form.
        (Some(2), 2) => Truth::Simple,
        _ => Truth::Double,
    }
}

/// Decides for two or more forms in three unknowns.
fn of_three_unknowns(forms: &[Form]) -> Truth {
    if forms[0][2][2] == 0 {
        return Truth::Open;
    }
    let first = resultant(&forms[0], &forms[1]);
    if first.degree() != Some(4) {
        return Truth::Open;
    }
    if forms.len() == 2 {
        // Every zero has a separate direction (x, y), and real directions belong to real zeros.
        return match (first.is_square_free(), first.real_roots()) {
            (_, 0) => Truth::None,
            (true, _) => Truth::Simple,
            (false, _) => Truth::Open,
        };
    }
    let others = forms[2..].iter().map(|form| resultant(&forms[0], form));
    let common = others.fold(first, |common, next| common.common(&next));
    match (common.degree(), common.real_roots()) {
        (Some(0), _) | (_, 0) => Truth::None,
        _ => Truth::Open,
    }
}

/// Returns the resultant of two forms as polynomials in z at y = 1. The resultant is zero if the
/// polynomials have a common root.
fn resultant(f: &Form, g: &Form) -> Polynomial {
    let parts = |f: &Form| {
        let whole = |c: &[i64]| Polynomial::new(c.iter().map(|x| BigInt::from(*x)).collect());
        [
            whole(&[f[2][2]]),
            whole(&[2 * f[1][2], 2 * f[0][2]]),
            whole(&[f[1][1], 2 * f[0][1], f[0][0]]),
        ]
    };
    let ([a, b, c], [d, e, h]) = (parts(f), parts(g));
    let ah = a.times(&h).minus(&c.times(&d));
    let ae = a.times(&e).minus(&b.times(&d));
    let bh = b.times(&h).minus(&c.times(&e));
    ah.times(&ah).minus(&ae.times(&bh))
}

/// Returns the forms in other coordinates x = T·x', with an integer matrix T of determinant one.
fn changed(forms: &[Form], change: i64) -> Vec<Form> {
    let n = forms[0].len();
    if change == 0 {
        return forms.to_vec();
    }
    // The matrix is a lower triangular matrix times an upper triangular matrix. Both factors have
    // ones on the diagonal.
    let entry = |i: usize, j: usize| -> i64 {
        let lower = |i: usize, k: usize| match i.cmp(&k) {
            std::cmp::Ordering::Less => 0,
            std::cmp::Ordering::Equal => 1,
            std::cmp::Ordering::Greater => change + (2 * i + k) as i64 % 3,
        };
        let upper = |k: usize, j: usize| match k.cmp(&j) {
            std::cmp::Ordering::Greater => 0,
            std::cmp::Ordering::Equal => 1,
            std::cmp::Ordering::Less => 1 - change + (k + 3 * j) as i64 % 4,
        };
        (0..n).map(|k| lower(i, k) * upper(k, j)).sum()
    };
    let of = |f: &Form| -> Form {
        (0..n)
            .map(|a| {
                (0..n)
                    .map(|b| {
                        let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
                        pairs
                            .map(|(i, j)| entry(i, a) * f[i][j] * entry(j, b))
                            .sum()
                    })
                    .collect()
            })
            .collect()
    };
    forms.iter().map(of).collect()
}

/// Largest number of bisections of a box, and largest number of boxes.
const HALVINGS: u32 = 9;
const BOXES: usize = 300_000;

/// Whether the sphere can be covered by boxes in which some form has no zero. A box has its centre
/// at c/2^h and the half width 1/2^h. All values are multiplied by 4^h, so that they are integers.
fn covered(forms: &[Form]) -> bool {
    let n = forms[0].len();
    // Linear combinations of the forms with small integer factors.
    let mut sums: Vec<Form> = Vec::new();
    for number in 0..3_usize.pow(forms.len() as u32) {
        let factors: Vec<i64> = (0..forms.len())
            .map(|s| (number / 3_usize.pow(s as u32) % 3) as i64 - 1)
            .collect();
        let first = factors.iter().find(|f| **f != 0);
        if first != Some(&1) {
            continue;
        }
        let entry = |i: usize, j: usize| -> i64 {
            let terms = factors.iter().zip(forms);
            terms.map(|(w, f)| w * f[i][j]).sum()
        };
        sums.push(
            (0..n)
                .map(|i| (0..n).map(|j| entry(i, j)).collect())
                .collect(),
        );
    }
    let mut open: Vec<(usize, u32, Vec<i64>)> = (0..n)
        .map(|face| (face, 0, (0..n).map(|k| i64::from(k == face)).collect()))
        .collect();
    let mut boxes = 0;
    while let Some((face, halvings, centre)) = open.pop() {
        boxes += 1;
        if sums.iter().any(|f| is_away(f, face, &centre)) {
            continue;
        }
        if halvings == HALVINGS || boxes > BOXES {
            return false;
        }
        let free: Vec<usize> = (0..n).filter(|k| *k != face).collect();
        for signs in 0..1_usize << free.len() {
            let mut next: Vec<i64> = centre.iter().map(|c| 2 * c).collect();
            for (bit, &k) in free.iter().enumerate() {
                next[k] += if signs >> bit & 1 == 1 { 1 } else { -1 };
            }
            open.push((face, halvings + 1, next));
        }
    }
    true
}

/// Whether a form has no zero in the box with this centre and a half width of one.
fn is_away(f: &Form, face: usize, centre: &[i64]) -> bool {
    let n = centre.len();
    let image: Vec<i64> = (0..n)
        .map(|i| (0..n).map(|j| f[i][j] * centre[j]).sum())
        .collect();
    let value: i64 = image.iter().zip(centre).map(|(m, c)| m * c).sum();
    let free = || (0..n).filter(|k| *k != face);
    let slope: i64 = free().map(|k| 2 * image[k].abs()).sum();
    let curvature: i64 = free()
        .flat_map(|k| free().map(move |l| (k, l)))
        .map(|(k, l)| f[k][l].abs())
        .sum();
    value.abs() > slope + curvature
}

/// Whether the signs of the forms on the sides of a box around a point prove a zero in the box
/// (theorem of Poincaré and Miranda). This is possible at zeros with independent gradients. The
/// computation uses fixed-point numbers: the integer 2^BITS represents 1.
pub(super) fn has_zero_near(forms: &[Form], at: &[f64]) -> bool {
    const BITS: i32 = 24;
    const RADIUS: i128 = 1 << 8;
    let one = f64::from(1 << BITS);
    let largest = (0..at.len()).fold(0, |k, i| if at[i].abs() > at[k].abs() { i } else { k });
    let point: Vec<i128> = at
        .iter()
        .map(|x| (x / at[largest] * one).round() as i128)
        .collect();
    let e = forms.len();
    // Computes rows of gradients at the point.
    let gradient = |f: &Form| -> Vec<i128> {
        let row = |i: usize| -> i128 {
            (0..at.len())
                .map(|j| 2 * i128::from(f[i][j]) * point[j])
                .sum()
        };
        (0..at.len()).map(row).collect()
    };
    let gradients: Vec<Vec<i128>> = forms.iter().map(gradient).collect();
    let free: Vec<usize> = (0..at.len()).filter(|k| *k != largest).collect();
    subsets(&free, e).into_iter().any(|chosen| {
        let square: Vec<Vec<f64>> = gradients
            .iter()
            .map(|row| chosen.iter().map(|&k| row[k] as f64 / one).collect())
            .collect();
        inverse(square).is_some_and(|inverse| {
            signs_change(forms, &gradients, &point, &chosen, &inverse, RADIUS)
        })
    })
}

/// Whether each combination of the forms has one sign on one side of the box, and the opposite sign
/// on the opposite side.
fn signs_change(
    forms: &[Form],
    gradients: &[Vec<i128>],
    point: &[i128],
    chosen: &[usize],
    inverse: &[Vec<f64>],
    radius: i128,
) -> bool {
    const WEIGHT: f64 = 65536.0;
    (0..chosen.len()).all(|k| {
        let weights: Vec<i128> = inverse[k]
            .iter()
            .map(|w| (w * WEIGHT).round() as i128)
            .collect();
        let sum = |of: &dyn Fn(usize) -> i128| -> i128 {
            weights.iter().enumerate().map(|(s, w)| w * of(s)).sum()
        };
        let value = sum(&|s| {
            let n = point.len();
            let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            pairs
                .map(|(i, j)| i128::from(forms[s][i][j]) * point[i] * point[j])
                .sum()
        });
        let slope = |column: usize| sum(&|s| gradients[s][chosen[column]]);
        let others: i128 = (0..chosen.len())
            .filter(|l| *l != k)
            .map(|l| slope(l).abs())
            .sum();
        let curvature: i128 = chosen
            .iter()
            .flat_map(|i| chosen.iter().map(move |j| (i, j)))
            .map(|(&i, &j)| sum(&|s| i128::from(forms[s][i][j])).abs())
            .sum();
        slope(k) * radius > value.abs() + others * radius + curvature * radius * radius
    })
}

fn subsets(of: &[usize], count: usize) -> Vec<Vec<usize>> {
    let chosen = |set: usize| -> Vec<usize> {
        let bits = of.iter().enumerate().filter(|(bit, _)| set >> bit & 1 == 1);
        bits.map(|(_, k)| *k).collect()
    };
    let sets = (0..1_usize << of.len()).map(chosen);
    sets.filter(|set| set.len() == count).collect()
}

/// Computes the inverse by elimination with the largest pivot.
fn inverse(mut m: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let n = m.len();
    for (i, row) in m.iter_mut().enumerate() {
        row.extend((0..n).map(|j| f64::from(i == j)));
    }
    for k in 0..n {
        let pivot = (k..n).max_by(|&a, &b| m[a][k].abs().total_cmp(&m[b][k].abs()))?;
        m.swap(k, pivot);
        let scale = m[k][k];
        if scale.abs() < 1e-9 {
            return None;
        }
        m[k].iter_mut().for_each(|x| *x /= scale);
        for i in (0..n).filter(|i| *i != k) {
            let factor = m[i][k];
            let row = m[k].clone();
            m[i].iter_mut()
                .zip(&row)
                .for_each(|(x, y)| *x -= factor * y);
        }
    }
    Some(m.into_iter().map(|row| row[n..].to_vec()).collect())
}

/// Returns the value of a form at a point.
pub(super) fn value(f: &Form, p: &[i64]) -> i64 {
    let n = p.len();
    let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    pairs.map(|(i, j)| f[i][j] * p[i] * p[j]).sum()
}

/// Whether all forms vanish at a point.
pub(super) fn all_vanish(forms: &[Form], p: &[i64]) -> bool {
    forms.iter().all(|f| value(f, p).is_zero())
}
