//! Exact rank, left null space and uniqueness of multipliers for a matrix of `f64`.

use num_bigint::BigInt;
use num_traits::Zero;

use crate::dyadic::Dyadic;
use crate::elimination::eliminate;

/// Exact rank and left null space of a matrix.
///
/// ```
/// use pfaff_exact::Exact;
/// // Rows 0 and 1 differ by one part in 2⁶⁶⁴; row 2 is their sum.
/// let tiny = 2_f64.powi(-664);
/// let exact = Exact::of(&[[1.0, 0.0], [1.0, tiny], [2.0, tiny]]);
/// assert_eq!(exact.rank(), 2);
/// assert!(!exact.row_is_unique(0));
/// ```
#[derive(Clone, Debug)]
pub struct Exact {
    /// The rows as integers. Row i of the matrix is row i of these integers times
    /// `2^row_exponents[i]`, with each column multiplied by a power of two.
    rows: Vec<Vec<BigInt>>,
    row_exponents: Vec<i64>,
    rank: usize,
    /// Basis of the vectors z with `zᵀ·rows = 0`, one vector in each row.
    z: Vec<Vec<BigInt>>,
}

impl Exact {
    /// Analyses the matrix with these rows, which have equal lengths.
    ///
    /// # Panics
    /// Panics if an entry is not finite.
    pub fn of<R: AsRef<[f64]>>(rows: &[R]) -> Self {
        let dyadic = |row: &R| row.as_ref().iter().map(|&x| Dyadic::from(x)).collect();
        Self::of_dyadic(&rows.iter().map(dyadic).collect::<Vec<_>>())
    }

    /// Analyses a matrix with dyadic entries.
    #[must_use]
    pub fn of_dyadic(matrix: &[Vec<Dyadic>]) -> Self {
        let (rows, row_exponents) = whole(matrix);
        Self::of_scaled(rows, row_exponents)
    }

    /// Analyses a matrix with integer entries.
    ///
    /// ```
    /// use pfaff_exact::Exact;
    /// let rows = [[2, 4], [3, 6]].map(|row| row.map(Into::into).to_vec());
    /// let exact = Exact::of_whole(rows.to_vec());
    /// assert_eq!((exact.rank(), exact.null_space().len()), (1, 1));
    /// // 3·(first row) − 2·(second row) = 0
    /// assert!(exact.determines(&[2, 3].map(Into::into)));
    /// ```
    #[must_use]
    pub fn of_whole(rows: Vec<Vec<BigInt>>) -> Self {
        let exponents = vec![0; rows.len()];
        Self::of_scaled(rows, exponents)
    }

    fn of_scaled(rows: Vec<Vec<BigInt>>, row_exponents: Vec<i64>) -> Self {
        let m = rows.len();
        let n = rows.first().map_or(0, Vec::len);
        // The right part records the row combinations that reduce the left part to zero.
        let with_identity = rows.iter().enumerate().map(|(i, row)| {
            let identity = (0..m).map(|l| BigInt::from(u8::from(l == i)));
            row.iter().cloned().chain(identity).collect()
        });
        let (rank, reduced) = eliminate(with_identity.collect(), n);
        let z = reduced[rank..].iter().map(|row| row[n..].to_vec());
        Self {
            rank,
            z: z.collect(),
            rows,
            row_exponents,
        }
    }

    /// Returns the rank r.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Returns whether row `i` belongs to no dependency, that is, whether `Z_i = 0`.
    #[must_use]
    pub fn row_is_unique(&self, i: usize) -> bool {
        self.z.iter().all(|z| z[i].is_zero())
    }

    /// Returns a basis of the vectors z with `zᵀ·C = 0`, for a matrix C of integers. If C was given
    /// in another form, its rows were multiplied by powers of two, and the basis belongs to these
    /// scaled rows.
    #[must_use]
    pub fn null_space(&self) -> &[Vec<BigInt>] {
        &self.z
    }

    /// Returns whether `ℓᵀ·λ` is unique (`ℓᵀ·Z = 0`), for a matrix with integer entries.
    #[must_use]
    pub fn determines(&self, l: &[BigInt]) -> bool {
        let product = |z: &Vec<BigInt>| z.iter().zip(l).map(|(z, l)| z * l).sum::<BigInt>();
        self.z.iter().all(|z| product(z).is_zero())
    }

    /// Returns the rank of `B_X = C_Xᵀ·Z_X`, which is the number of directions in which the
    /// reaction of the rows X is not unique.
    #[must_use]
    pub fn freedom(&self, rows: &[usize]) -> usize {
        let n = self.rows.first().map_or(0, Vec::len);
        let b_x = |z: &Vec<BigInt>| {
            let entry = |k: usize| rows.iter().map(|&i| &self.rows[i][k] * &z[i]).sum();
            (0..n).map(entry).collect()
        };
        eliminate(self.z.iter().map(b_x).collect(), n).0
    }

    /// Returns the rank of `Z_X`, which is the number of directions in which the multipliers of the
    /// rows X are not unique.
    #[must_use]
    pub fn multiplier_freedom(&self, rows: &[usize]) -> usize {
        let z_x = |z: &Vec<BigInt>| rows.iter().map(|&i| z[i].clone()).collect();
        eliminate(self.z.iter().map(z_x).collect(), rows.len()).0
    }

    /// Returns whether `ℓᵀ·λ` is unique, that is, whether `ℓᵀ·Z = 0`.
    ///
    /// # Panics
    /// Panics if a coefficient is not finite.
    #[must_use]
    pub fn combination_is_unique(&self, l: &[f64]) -> bool {
        // The product of `2^−row_exponents` and z annihilates the original rows.
        let term = |(i, z): (usize, &BigInt)| {
            Dyadic::from(l[i]).times(&Dyadic::new(z.clone(), -self.row_exponents[i]))
        };
        let sum = |z: &Vec<BigInt>| {
            let terms = z.iter().enumerate().map(term);
            terms.fold(Dyadic::from(0.0), |a, b| a.plus(&b))
        };
        self.z.iter().all(|z| sum(z).is_zero())
    }
}

/// Multiplies the rows and columns of the matrix by powers of two so that the entries are small
/// integers. Returns these integers and the exponents of the rows.
fn whole(matrix: &[Vec<Dyadic>]) -> (Vec<Vec<BigInt>>, Vec<i64>) {
    let n = matrix.first().map_or(0, Vec::len);
    let entries: Vec<(usize, usize, i64)> = matrix
        .iter()
        .enumerate()
        .flat_map(|(i, row)| row.iter().enumerate().map(move |(k, x)| (i, k, x)))
        .filter_map(|(i, k, x)| Some((i, k, x.exponent()?)))
        .collect();
    let (mut down, mut across) = (vec![0; matrix.len()], vec![0; n]);
    for _ in 0..SWEEPS {
        let above = entries.iter().map(|&(i, k, e)| (i, e - across[k]));
        down = means(matrix.len(), above);
        let above = entries.iter().map(|&(i, k, e)| (k, e - down[i]));
        across = means(n, above);
    }
    // No exponent may remain negative.
    for (i, e) in down.iter_mut().enumerate() {
        let own = entries.iter().filter(|entry| entry.0 == i);
        *e = own.map(|&(_, k, e)| e - across[k]).min().unwrap_or(0);
    }
    let rows = matrix.iter().zip(&down).map(|(row, down)| {
        let entries = row.iter().zip(&across);
        entries.map(|(x, k)| x.over_power(down + k)).collect()
    });
    (rows.collect(), down)
}

/// Number of sweeps that adjust the powers of two of rows and columns towards their least-squares
/// values. More sweeps would not change the result, only the time of the later steps.
const SWEEPS: usize = 12;

/// Returns the mean of the values that belong to each index.
fn means(n: usize, values: impl Iterator<Item = (usize, i64)>) -> Vec<i64> {
    let mut sums = vec![(0, 0); n];
    for (place, value) in values {
        sums[place] = (sums[place].0 + value, sums[place].1 + 1);
    }
    sums.iter().map(|&(sum, n)| sum / n.max(1)).collect()
}
