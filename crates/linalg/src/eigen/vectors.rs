//! Computes eigenvalues and eigenvectors of a real Schur form, by substitution from the last row
//! upwards.

use super::francis::RealSchur;
use crate::Matrix;
use crate::limits::SUBSTITUTED;

/// A complex number as real and imaginary part.
pub(super) type Complex = [f64; 2];

fn times([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

fn minus([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a - c, b - d]
}

fn size([a, b]: Complex) -> f64 {
    a.abs().max(b.abs())
}

fn quotient(x: Complex, by: Complex) -> Complex {
    let scale = size(by);
    let [c, d] = by.map(|y| y / scale);
    let square = (c * c + d * d) * scale;
    times(x, [c, -d]).map(|x| x / square)
}

impl RealSchur {
    /// Returns all eigenvalues with their eigenvectors (not normalised); conjugate pairs are
    /// exactly conjugate.
    pub(super) fn pairs(&self) -> Vec<(Complex, Vec<Complex>)> {
        let n = self.t.nrows();
        let mut pairs = Vec::with_capacity(n);
        let mut k = 0;
        while k < n {
            if self.is_block(k) {
                let (value, vector) = self.of_block(k);
                let conjugate = vector.iter().map(|&[re, im]| [re, -im]).collect();
                pairs.push((value, vector));
                pairs.push(([value[0], -value[1]], conjugate));
                k += 2;
            } else {
                let value = [self.t[(k, k)], 0.0];
                let mut x = vec![[0.0; 2]; n];
                x[k] = [1.0, 0.0];
                pairs.push((value, self.vector(value, x, k)));
                k += 1;
            }
        }
        pairs
    }

    /// Returns whether rows k and k + 1 belong to a complex pair.
    fn is_block(&self, k: usize) -> bool {
        k + 1 < self.t.nrows() && self.t[(k + 1, k)] != 0.0
    }

    /// Returns the eigenvalue with positive imaginary part of the block at row k.
    fn of_block(&self, k: usize) -> (Complex, Vec<Complex>) {
        let t = &self.t;
        let (a, d) = (t[(k, k)], t[(k + 1, k + 1)]);
        let (b, c) = (t[(k, k + 1)], t[(k + 1, k)]);
        let half = 0.5 * (a - d);
        let im = (-(half * half + b * c)).max(0.0).sqrt();
        let value = [d + half, im];
        let mut x = vec![[0.0; 2]; t.nrows()];
        if b.abs() >= c.abs() {
            (x[k], x[k + 1]) = ([b, 0.0], [-half, im]);
        } else {
            (x[k], x[k + 1]) = ([half, im], [c, 0.0]);
        }
        let scale = size(x[k]).max(size(x[k + 1]));
        for entry in &mut x[k..k + 2] {
            *entry = entry.map(|x| x / scale);
        }
        (value, self.vector(value, x, k))
    }

    /// Returns the eigenvector of A whose entries from row `known` onwards, in the axes of T, are
    /// the entries of x.
    fn vector(&self, value: Complex, mut x: Vec<Complex>, known: usize) -> Vec<Complex> {
        let (t, n) = (&self.t, self.t.nrows());
        let least = (f64::EPSILON * t.max_abs()).max(f64::MIN_POSITIVE);
        let rest = |x: &[Complex], i: usize, from: usize| {
            let terms = t.row(i)[from..].iter().zip(&x[from..]);
            terms.fold([0.0; 2], |[re, im], (t, [a, b])| [re - t * a, im - t * b])
        };
        // A divisor that is zero to within rounding is replaced by the size of the rounding error.
        let divisor = |z: Complex| if size(z) < least { [least, 0.0] } else { z };
        let mut k = known;
        while k > 0 {
            let i = k - 1;
            if i > 0 && self.is_block(i - 1) {
                let (above, own) = (rest(&x, i - 1, k), rest(&x, i, k));
                let rows = [
                    [
                        minus([t[(i - 1, i - 1)], 0.0], value),
                        [t[(i - 1, i)], 0.0],
                        above,
                    ],
                    [[t[(i, i - 1)], 0.0], minus([t[(i, i)], 0.0], value), own],
                ];
                [x[i - 1], x[i]] = of_two(rows, divisor);
                k -= 2;
            } else {
                let own = minus([t[(i, i)], 0.0], value);
                x[i] = quotient(rest(&x, i, k), divisor(own));
                k -= 1;
            }
            let largest = x[k..].iter().fold(0.0_f64, |a, &z| a.max(size(z)));
            if largest > SUBSTITUTED {
                for z in &mut x[k..] {
                    *z = z.map(|x| x / largest);
                }
            }
        }
        let axes: &Matrix = &self.z;
        (0..n)
            .map(|i| {
                let terms = axes.row(i).iter().zip(&x);
                terms.fold([0.0; 2], |[re, im], (z, [a, b])| [re + z * a, im + z * b])
            })
            .collect()
    }
}

/// Solves two complex equations, given as rows `[a, b, right side]`, by elimination with the larger
/// pivot.
fn of_two([one, other]: [[Complex; 3]; 2], divisor: impl Fn(Complex) -> Complex) -> [Complex; 2] {
    let (pivot, below) = if size(one[0]) >= size(other[0]) {
        (one, other)
    } else {
        (other, one)
    };
    let factor = quotient(below[0], divisor(pivot[0]));
    let left = minus(below[1], times(factor, pivot[1]));
    let second = quotient(minus(below[2], times(factor, pivot[2])), divisor(left));
    let first = minus(pivot[2], times(pivot[1], second));
    [quotient(first, divisor(pivot[0])), second]
}
