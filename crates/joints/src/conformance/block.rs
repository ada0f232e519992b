//! A dense matrix of kernel results, compared relative to its largest entry. It is not used for
//! computations.

use approx::{AbsDiffEq, RelativeEq};

/// A dense matrix, row by row, of computed or expected kernel results.
///
/// Equality is in the maximum norm. The relative one refers to the largest entry of both blocks,
/// not entry by entry: an entry that is zero by cancellation may have the round-off of its
/// neighbours.
///
/// ```
/// use approx::assert_relative_eq;
/// use joints::conformance::Block;
/// let found = Block::from_rows(&[[1e3, 1e-13]]);
/// assert_relative_eq!(found, Block::from_rows(&[[1e3, 0.0]]), max_relative = 1e-15);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Block<T = f64> {
    rows: usize,
    columns: usize,
    entries: Vec<T>,
}

impl<T: Copy> Block<T> {
    /// A block with the same value everywhere.
    #[must_use]
    pub fn filled(rows: usize, columns: usize, value: T) -> Self {
        Self {
            rows,
            columns,
            entries: vec![value; rows * columns],
        }
    }

    /// One column.
    #[must_use]
    pub fn column(entries: Vec<T>) -> Self {
        Self {
            rows: entries.len(),
            columns: 1,
            entries,
        }
    }

    /// The block with these rows.
    #[must_use]
    pub fn from_rows<const N: usize>(rows: &[[T; N]]) -> Self {
        Self {
            rows: rows.len(),
            columns: N,
            entries: rows.iter().flatten().copied().collect(),
        }
    }

    /// Joins blocks with the same number of rows side by side.
    ///
    /// # Panics
    /// If the numbers of rows differ.
    #[must_use]
    pub fn beside(blocks: &[Self]) -> Self {
        let rows = blocks.first().map_or(0, |b| b.rows);
        assert!(
            blocks.iter().all(|b| b.rows == rows),
            "blocks side by side need equal heights"
        );
        let columns = blocks.iter().map(|b| b.columns).sum();
        let entries = (0..rows)
            .flat_map(|r| blocks.iter().flat_map(move |b| b.row(r).iter().copied()))
            .collect();
        Self {
            rows,
            columns,
            entries,
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// All entries, row by row.
    #[must_use]
    pub fn entries(&self) -> &[T] {
        &self.entries
    }

    /// One row.
    ///
    /// # Panics
    /// If there is no such row.
    #[must_use]
    pub fn row(&self, row: usize) -> &[T] {
        &self.entries[row * self.columns..][..self.columns]
    }

    /// One entry.
    ///
    /// # Panics
    /// If there is no such entry.
    #[must_use]
    pub fn get(&self, row: usize, column: usize) -> T {
        self.row(row)[column]
    }

    /// Changes one entry.
    ///
    /// # Panics
    /// If there is no such entry.
    pub fn set(&mut self, row: usize, column: usize, value: T) {
        assert!(column < self.columns, "column {column} of {}", self.columns);
        self.entries[row * self.columns + column] = value;
    }

    /// The block with a function applied to each entry.
    #[must_use]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> Block<U> {
        Block {
            rows: self.rows,
            columns: self.columns,
            entries: self.entries.iter().map(|&e| f(e)).collect(),
        }
    }

    /// Combines two blocks of the same shape entry by entry.
    ///
    /// # Panics
    /// If the shapes differ.
    #[must_use]
    pub fn zip(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self {
        assert_eq!(
            (self.rows, self.columns),
            (other.rows, other.columns),
            "blocks entry by entry need equal shapes"
        );
        let entries = self
            .entries
            .iter()
            .zip(&other.entries)
            .map(|(&a, &b)| f(a, b))
            .collect();
        Self {
            rows: self.rows,
            columns: self.columns,
            entries,
        }
    }
}

impl Block {
    /// The largest magnitude of an entry; NaN if there is one.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.entries
            .iter()
            .fold(0.0, |m, e| if e.is_nan() { *e } else { m.max(e.abs()) })
    }

    /// The Frobenius norm.
    #[must_use]
    pub fn norm(&self) -> f64 {
        self.entries.iter().map(|e| e * e).sum::<f64>().sqrt()
    }

    /// Row and column of the entry that differs most from the same entry of `other`; a NaN counts
    /// as the largest difference. Returns `None` for empty blocks.
    #[must_use]
    pub fn worst(&self, other: &Self) -> Option<(usize, usize)> {
        let difference = self.zip(other, |a, b| (a - b).abs());
        let rank = |e: f64| if e.is_nan() { f64::INFINITY } else { e };
        let (at, _) = difference
            .entries
            .iter()
            .enumerate()
            .max_by(|(_, a), (_, b)| rank(**a).total_cmp(&rank(**b)))?;
        Some((at / self.columns, at % self.columns))
    }

    fn difference(&self, other: &Self) -> f64 {
        if (self.rows, self.columns) == (other.rows, other.columns) {
            self.zip(other, |a, b| a - b)
                .entries
                .iter()
                .fold(0.0, |m: f64, e| {
                    if e.is_nan() || m.is_nan() {
                        f64::NAN
                    } else {
                        m.max(e.abs())
                    }
                })
        } else {
            f64::NAN
        }
    }
}

impl AbsDiffEq for Block {
    type Epsilon = f64;

    fn default_epsilon() -> f64 {
        f64::EPSILON
    }

    fn abs_diff_eq(&self, other: &Self, epsilon: f64) -> bool {
        self.difference(other) <= epsilon
    }
}

impl RelativeEq for Block {
    fn default_max_relative() -> f64 {
        f64::EPSILON
    }

    fn relative_eq(&self, other: &Self, epsilon: f64, max_relative: f64) -> bool {
        let largest = self.largest().max(other.largest());
        self.difference(other) <= epsilon.max(max_relative * largest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{abs_diff_eq, relative_eq};

    #[test]
    fn relative_equality_refers_to_the_largest_entry_of_both() {
        let a = Block::from_rows(&[[1e3, 0.0]]);
        let b = Block::from_rows(&[[1e3, 1e-10]]);
        assert!(relative_eq!(a, b, epsilon = 0.0, max_relative = 1e-12));
        assert!(!relative_eq!(a, b, epsilon = 0.0, max_relative = 1e-14));
        assert!(!abs_diff_eq!(a, b, epsilon = 1e-11));
    }

    #[test]
    fn nan_and_another_shape_equal_nothing() {
        let a = Block::from_rows(&[[f64::NAN, 0.0]]);
        assert!(!relative_eq!(a, a, max_relative = 1.0));
        assert!(!abs_diff_eq!(a, a, epsilon = 1.0));
        let narrow = Block::from_rows(&[[0.0]]);
        assert!(!abs_diff_eq!(
            narrow,
            Block::from_rows(&[[0.0, 0.0]]),
            epsilon = 1.0
        ));
        assert_eq!(a.worst(&Block::from_rows(&[[0.0, 9.0]])), Some((0, 0)));
    }

    #[test]
    fn blocks_side_by_side_keep_their_rows() {
        let a = Block::from_rows(&[[1.0], [2.0]]);
        let b = Block::from_rows(&[[3.0, 4.0], [5.0, 6.0]]);
        let c = Block::beside(&[a, b]);
        assert_eq!(c, Block::from_rows(&[[1.0, 3.0, 4.0], [2.0, 5.0, 6.0]]));
    }
}
