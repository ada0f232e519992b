//! Dependencies of rows without rounding. The rows are eliminated modulo many primes, and the
//! coefficients are reconstructed from their residues.
//!
//! The matrix is scaled by powers of two to integers A (exact). For a row basis K with pivot
//! columns J, the dropped rows are `A_D = T·A_K`. Each coefficient is a quotient of minors of order
//! r: `T_ji = N_ji/det A_KJ`. Minors are computed modulo each prime. If the product of the primes
//! exceeds twice Hadamard's bound, the residues determine the minors completely, and the quotients
//! are known to full precision. If all minors of order r + 1 are zero modulo the same primes, this
//! proves that they are zero. The module `graded` determines the order in which rows are preferred.
//!
//! Source: mixed radix digits after H. L. Garner, The residue number system, IRE Trans. Electron.
//! Comput. EC-8 (1959) 140–147.

use crate::limits::{PRIME_BITS, WITNESSES};
use std::cmp::{Ordering, Reverse};

use crate::prime_field::{PrimeField, Residue, fields};
use crate::strong_basis::complement;
use linalg::powers::scale;
use linalg::{Matrix, Scaling};

/// The matrix `A = D·C·D_c` with integer entries: mantissa·2^shift, and the exponents of D.
pub(super) struct Integers {
    ncols: usize,
    entries: Vec<(i64, u32)>,
    /// Row i of A is `2^−exponents[i]` times the row of `C·D_c`.
    exponents: Vec<i32>,
    /// Upper bound on log₂ of the norm of each row.
    bits: Vec<u64>,
}

impl Integers {
    /// Scales the columns as in `scaling`, and the rows so that they become integers without a
    /// common factor of two.
    pub(super) fn new(c: &Matrix, scaling: &Scaling) -> Self {
        let (m, n) = (c.nrows(), c.ncols());
        let mut entries = Vec::with_capacity(m * n);
        let (mut exponents, mut bits) = (Vec::with_capacity(m), Vec::with_capacity(m));
        for i in 0..m {
            let row: Vec<(i64, i32)> = c
                .row(i)
                .iter()
                .zip(&scaling.cols)
                .map(|(&x, &e_c)| {
                    let (mantissa, e) = odd_mantissa(x);
                    (mantissa, e + e_c)
                })
                .collect();
            let nonzero = || row.iter().filter(|x| x.0 != 0);
            let lowest = nonzero().map(|x| x.1).min().unwrap_or(0);
            let shift = |e: i32| u32::try_from(e - lowest).unwrap_or(0);
            let highest = nonzero()
                .map(|x| u64::from(x.0.unsigned_abs().ilog2() + 1 + shift(x.1)))
                .max();
            // ‖row‖ ≤ √count·max, and √count ≤ 2^⌈log₂(count)/2⌉.
            let spread = u64::from(nonzero().count().max(1).ilog2() / 2 + 1);
            bits.push(highest.unwrap_or(0) + spread);
            exponents.push(lowest);
            entries.extend(row.iter().map(|&(mantissa, e)| (mantissa, shift(e))));
        }
        Self {
            ncols: n,
            entries,
            exponents,
            bits,
        }
    }

    /// Returns an upper bound of the bits of any minor of order at most `order`: Hadamard's bound.
    fn minor_bits(&self, order: usize) -> u64 {
        let mut bits = self.bits.clone();
        bits.sort_unstable_by(|a, b| b.cmp(a));
        bits.iter().take(order).sum()
    }

    fn modulo(&self, field: PrimeField) -> Vec<Residue> {
        let highest = self.entries.iter().map(|e| e.1).max().unwrap_or(0);
        let mut powers = vec![field.integer(1)];
        for k in 0..highest as usize {
            powers.push(field.plus(powers[k], powers[k]));
        }
        self.entries
            .iter()
            .map(|&(mantissa, shift)| {
                if mantissa == 0 {
                    return Residue::ZERO;
                }
                signed(field, mantissa, powers[shift as usize])
            })
            .collect()
    }
}

/// Returns `x = mantissa·2^e` with an odd mantissa, or (0, 0) for zero.
fn odd_mantissa(x: f64) -> (i64, i32) {
    const FRACTION: u32 = 52;
    if x == 0.0 {
        return (0, 0);
    }
    let bits = x.to_bits();
    let field = ((bits >> FRACTION) & 0x7ff) as i32;
    let fraction = bits & ((1 << FRACTION) - 1);
    let (mantissa, e) = match field {
        0 => (fraction, -1074),
        _ => (fraction | (1 << FRACTION), field - 1075),
    };
    let zeros = mantissa.trailing_zeros();
    let mantissa = (mantissa >> zeros) as i64;
    (if x < 0.0 { -mantissa } else { mantissa }, e + zeros as i32)
}

fn signed(field: PrimeField, mantissa: i64, power: Residue) -> Residue {
    let x = field.times(field.integer(mantissa.unsigned_abs()), power);
    if mantissa < 0 { field.negative(x) } else { x }
}

/// Returns the value `x·2^e` modulo a prime.
fn dyadic(field: PrimeField, x: f64, e: i32) -> Residue {
    let (mantissa, e_x) = odd_mantissa(x);
    let e = e + e_x;
    let two = field.integer(2);
    let base = if e < 0 { field.inverse(two) } else { two };
    signed(
        field,
        mantissa,
        field.power(base, u64::from(e.unsigned_abs())),
    )
}

/// Result of the elimination of rows modulo a prime.
struct Reduction {
    /// Independent rows K, in the given order.
    kept: Vec<usize>,
    /// Pivot columns J of the rows.
    pivots: Vec<usize>,
    /// The determinant ± det A_KJ.
    determinant: Residue,
    /// T for the other rows in ascending order, p×r, stored row by row.
    t: Vec<Residue>,
}

/// Eliminates the rows of `a` (n columns) in the given order. A row is kept if it is independent of
/// the previous rows.
fn reduce(field: PrimeField, a: &[Residue], n: usize, order: &[usize]) -> Reduction {
    let mut kept = Vec::new();
    let mut pivots: Vec<usize> = Vec::new();
    let mut determinant = field.integer(1);
    // Rows of U, inverse pivots, and the strictly lower part of L, with row kept[k] = U_k + Σ
    // L_kl·U_l.
    let (mut upper, mut inverses, mut lower) = (Vec::<Residue>::new(), Vec::new(), Vec::new());
    let mut multipliers = vec![Vec::new(); order.len()];
    for &i in order {
        let mut row = a[i * n..(i + 1) * n].to_vec();
        let mut y = Vec::with_capacity(pivots.len());
        for (k, &j) in pivots.iter().enumerate() {
            let factor = field.times(row[j], inverses[k]);
            if !factor.is_zero() {
                field.subtract(factor, &upper[k * n..(k + 1) * n], &mut row);
            }
            y.push(factor);
        }
        match row.iter().position(|x| !x.is_zero()) {
            Some(j) => {
                kept.push(i);
                pivots.push(j);
                determinant = field.times(determinant, row[j]);
                inverses.push(field.inverse(row[j]));
                upper.extend(row);
                lower.push(y);
            }
            None => multipliers[i] = y,
        }
    }
    // The equation y·U = T·L·U gives T = y·L⁻¹, which is solved from the last column. Later rows of
    // K have coefficient zero.
    let mut in_order = kept.clone();
    in_order.sort_unstable();
    let mut t = Vec::with_capacity((order.len() - kept.len()) * kept.len());
    for i in complement(order.len(), &in_order) {
        let mut y = std::mem::take(&mut multipliers[i]);
        for k in (0..y.len()).rev() {
            let t_k = y[k];
            if !t_k.is_zero() {
                field.subtract(t_k, &lower[k], &mut y[..k]);
            }
        }
        y.resize(kept.len(), Residue::ZERO);
        t.extend(y);
    }
    Reduction {
        kept,
        pivots,
        determinant,
        t,
    }
}

/// A row basis with exact dependencies of the other rows.
pub(super) struct ExactBasis {
    /// Kept rows, ascending.
    pub(super) kept: Vec<usize>,
    /// The other rows, ascending.
    pub(super) dropped: Vec<usize>,
    /// T̃ between rows equilibrated by the scaling, p×r, each entry rounded from its exact value.
    /// Non-zero entries stay non-zero.
    pub(super) t: Matrix,
}

/// Returns the rank and a row basis that prefers rows earlier in `order`, with exact dependencies
/// of the other rows.
pub(super) fn exact_basis(a: &Integers, scaling: &Scaling, order: &[usize]) -> ExactBasis {
    let (m, n) = (order.len(), a.ncols);
    let mut position = vec![0; m];
    for (k, &i) in order.iter().enumerate() {
        position[i] = k;
    }
    // If the prime divides minors, the rank modulo the prime is lower, or independent rows and
    // pivot columns are found later.
    let key = |r: &Reduction| {
        let rows: Vec<usize> = r.kept.iter().map(|&i| position[i]).collect();
        (Reverse(rows.len()), rows, r.pivots.clone())
    };
    let mut reference: Option<Reduction> = None;
    let mut digits = MixedRadix::default();
    for field in fields() {
        let now = reduce(field, &a.modulo(field), n, order);
        match reference
            .as_ref()
            .map_or(Ordering::Less, |r| key(&now).cmp(&key(r)))
        {
            Ordering::Less => digits = MixedRadix::default(),
            Ordering::Equal => {}
            Ordering::Greater => continue,
        }
        let rank = now.kept.len();
        if rank == m {
            reference = Some(now);
            break;
        }
        // An entry of T is zero iff the minor N of the entry is zero. The determinant comes last.
        let minors: Vec<Residue> = now
            .t
            .iter()
            .map(|&t| field.times(t, now.determinant))
            .chain([now.determinant])
            .collect();
        digits.extend(field, &minors);
        reference = Some(now);
        // Two additional bits are needed, for the sign and for "less than half".
        if digits.bits() >= a.minor_bits(rank + 1) + 2 {
            break;
        }
    }
    let (in_order, t) = match reference {
        Some(r) => (r.kept, digits),
        None => (Vec::new(), digits),
    };
    let mut kept = in_order.clone();
    kept.sort_unstable();
    let dropped = complement(m, &kept);
    let (rank, redundancy) = (kept.len(), dropped.len());
    let determinant = t.number(rank * redundancy);
    // Row i of A is 2^(−exponents[i] − rows[i]) times the equilibrated row.
    let weight = |i: usize| i64::from(a.exponents[i]) + i64::from(scaling.rows[i]);
    let mut out = Matrix::zeros(redundancy, rank);
    for (j, &row_j) in dropped.iter().enumerate() {
        for (k, &row_k) in in_order.iter().enumerate() {
            let minor = t.number(j * rank + k);
            if minor.mantissa != 0.0 {
                let e = minor.exponent - determinant.exponent + weight(row_j) - weight(row_k);
                let quotient = minor.mantissa / determinant.mantissa;
                let rounded = scale(quotient, e.clamp(-4000, 4000) as i32);
                let visible = rounded
                    .abs()
                    .clamp(f64::MIN_POSITIVE, f64::MAX)
                    .copysign(quotient);
                out[(j, kept.partition_point(|&i| i < row_k))] = visible;
            }
        }
    }
    ExactBasis {
        kept,
        dropped,
        t: out,
    }
}

/// Signed integers stored by mixed radix digits, `d_0 + d_1·p_0 + d_2·p_0·p_1 + …`, extended prime
/// by prime.
#[derive(Default)]
struct MixedRadix {
    fields: Vec<PrimeField>,
    /// Digits of all integers, prime by prime.
    digits: Vec<Vec<u64>>,
}

/// The number `mantissa·2^exponent`.
struct Number {
    mantissa: f64,
    exponent: i64,
}

impl MixedRadix {
    /// Returns log₂ of the product of the primes, rounded down.
    fn bits(&self) -> u64 {
        u64::from(PRIME_BITS) * self.fields.len() as u64
    }

    /// Adds the residues of all integers modulo another prime.
    fn extend(&mut self, field: PrimeField, residues: &[Residue]) {
        let mut product = field.integer(1);
        let mut products = Vec::with_capacity(self.fields.len());
        for f in &self.fields {
            products.push(product);
            product = field.times(product, field.integer(f.p()));
        }
        if product.is_zero() {
            return; // this prime has been here before
        }
        let inverse = field.inverse(product);
        let digits = residues
            .iter()
            .enumerate()
            .map(|(l, &x)| {
                let known = self
                    .digits
                    .iter()
                    .zip(&products)
                    .fold(0, |sum: u64, (d, &p)| {
                        let sum = sum + field.times_plain(p, d[l]);
                        if sum >= field.p() {
                            sum - field.p()
                        } else {
                            sum
                        }
                    });
                field.value(field.times(field.minus(x, field.integer(known)), inverse))
            })
            .collect();
        self.fields.push(field);
        self.digits.push(digits);
    }

    /// Returns integer `l`, rounded to `f64`. The absolute value of the integer must be below a
    /// quarter of the product of the primes.
    fn number(&self, l: usize) -> Number {
        let (Some(last), Some(p_last)) = (self.digits.last(), self.fields.last()) else {
            return Number {
                mantissa: 1.0,
                exponent: 0,
            };
        };
        // If x is above half of the product P, it represents x − P. P − 1 − x has the complementary
        // digits.
        let negative = last[l] > p_last.p() / 2;
        let (mut mantissa, mut exponent) = (0.0_f64, 0_i64);
        for (digits, field) in self.digits.iter().zip(&self.fields).rev() {
            let digit = if negative {
                field.p() - 1 - digits[l]
            } else {
                digits[l]
            };
            let e = i32::try_from(-exponent).unwrap_or(i32::MIN);
            mantissa = mantissa * field.p() as f64 + scale(digit as f64, e.max(-4000));
            if mantissa > 1e100 {
                mantissa = scale(mantissa, -256);
                exponent += 256;
            }
        }
        if negative {
            mantissa =
                -(mantissa + scale(1.0, i32::try_from(-exponent).unwrap_or(i32::MIN).max(-4000)));
        }
        Number { mantissa, exponent }
    }
}

/// The left null space of a matrix modulo a few primes. The null space is used to test, without a
/// tolerance, whether a combination of rows vanishes on this space.
///
/// "Not zero" is proved. "Zero" is wrong with probability below 2⁻¹³⁰ for data that were not
/// constructed against the primes.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::ExactNullSpace;
/// // Row 2 is row 0 plus 1e-300 times row 1.
/// let c = Matrix::from_rows(&[[1.0, 0.0], [0.0, 1.0], [1.0, 1e-300]]);
/// let z = ExactNullSpace::new(&c)?;
/// assert!(!z.annihilates([(1, 1.0)])); // row 1 takes part
/// assert!(z.annihilates([(0, 1.0), (2, 1.0)])); // λ₀ + λ₂ is the force along the first column
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ExactNullSpace {
    n: usize,
    exponents: Vec<i32>,
    witnesses: Vec<Witness>,
}

#[derive(Debug, Clone)]
struct Witness {
    field: PrimeField,
    /// Residues of A, m×n.
    a: Vec<Residue>,
    /// Left null space Z of A, m×p.
    z: Vec<Residue>,
    p: usize,
}

impl ExactNullSpace {
    /// Computes the left null space of `c` (m×n).
    ///
    /// # Errors
    /// [`RankError::NonFinite`](crate::RankError::NonFinite): an entry is NaN or infinite.
    pub fn new(c: &Matrix) -> Result<Self, crate::RankError> {
        super::check_finite(c)?;
        Ok(Self::of(&Integers::new(c, &linalg::equilibrate(c))))
    }

    fn of(a: &Integers) -> Self {
        let m = a.exponents.len();
        let order: Vec<usize> = (0..m).collect();
        let mut witnesses: Vec<Witness> = Vec::new();
        for field in fields() {
            let entries = a.modulo(field);
            let r = reduce(field, &entries, a.ncols, &order);
            let (rank, p) = (r.kept.len(), m - r.kept.len());
            // A prime that divides minors has a larger null space.
            match witnesses.first().map_or(p, |w| w.p) {
                least if least < p => continue,
                least if least > p => witnesses.clear(),
                _ => {}
            }
            let mut z = vec![Residue::ZERO; m * p];
            for (j, row_j) in complement(m, &r.kept).into_iter().enumerate() {
                z[row_j * p + j] = field.integer(1);
                for (k, &row_k) in r.kept.iter().enumerate() {
                    z[row_k * p + j] = field.negative(r.t[j * rank + k]);
                }
            }
            witnesses.push(Witness {
                field,
                a: entries,
                z,
                p,
            });
            if witnesses.len() == WITNESSES {
                break;
            }
        }
        Self {
            n: a.ncols,
            exponents: a.exponents.clone(),
            witnesses,
        }
    }

    /// Returns whether `ℓᵀ·Z = 0` for the combination of rows of C with these coefficients (row,
    /// ℓ_row).
    ///
    /// # Panics
    /// Panics if a row does not exist.
    pub fn annihilates(&self, combination: impl IntoIterator<Item = (usize, f64)>) -> bool {
        self.rank_of(&[combination.into_iter().collect()]) == 0
    }

    /// Returns the rank of `W·Z` for combinations W of the rows of C, each given as a list of (row,
    /// coefficient).
    ///
    /// # Panics
    /// Panics if a row does not exist.
    #[must_use]
    pub fn rank_of(&self, combinations: &[Vec<(usize, f64)>]) -> usize {
        let order: Vec<usize> = (0..combinations.len()).collect();
        self.witnesses
            .iter()
            .map(|w| {
                let images: Vec<Residue> = combinations
                    .iter()
                    .flat_map(|combination| self.image(w, combination))
                    .collect();
                reduce(w.field, &images, w.p, &order).kept.len()
            })
            .max()
            .unwrap_or(0)
    }

    fn image(&self, w: &Witness, combination: &[(usize, f64)]) -> Vec<Residue> {
        let f = w.field;
        let mut image = vec![Residue::ZERO; w.p];
        for &(i, l) in combination.iter().filter(|x| x.1 != 0.0) {
            // Z of C is Z of A times 2^−exponents[i].
            let weight = f.negative(dyadic(f, l, -self.exponents[i]));
            f.subtract(weight, &w.z[i * w.p..(i + 1) * w.p], &mut image);
        }
        image
    }

    /// Returns whether `B_X = C_Xᵀ·Z_X` is zero for the rows X, each of which is listed once.
    ///
    /// # Panics
    /// Panics if a row does not exist.
    #[must_use]
    pub fn wrench_vanishes(&self, rows: &[usize]) -> bool {
        self.witnesses.iter().all(|w| {
            (0..self.n).all(|k| {
                let mut b = vec![Residue::ZERO; w.p];
                for &i in rows {
                    let c = w.field.negative(w.a[i * self.n + k]);
                    w.field.subtract(c, &w.z[i * w.p..(i + 1) * w.p], &mut b);
                }
                b.iter().all(|b| b.is_zero())
            })
        })
    }
}
