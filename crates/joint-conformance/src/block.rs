//! A dense matrix of kernel results, for comparisons. The matrix is used only for comparisons.

use joints::Ring;

/// A dense matrix of computed or expected results of a kernel, stored by rows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block<T = f64> {
    rows: usize,
    columns: usize,
    entries: Vec<T>,
}

impl<T: Copy> Block<T> {
    /// Returns a block with this value in all entries.
    #[must_use]
    pub(crate) fn filled(rows: usize, columns: usize, value: T) -> Self {
        Self {
            rows,
            columns,
            entries: vec![value; rows * columns],
        }
    }

    /// Returns a block with one column.
    #[must_use]
    pub(crate) fn column(entries: Vec<T>) -> Self {
        Self {
            rows: entries.len(),
            columns: 1,
            entries,
        }
    }

    /// Returns a block whose columns are the columns of these blocks; all blocks must have the same
    /// number of rows.
    ///
    /// # Panics
    /// Panics if the numbers of rows differ.
    #[must_use]
    pub(crate) fn beside(blocks: &[Self]) -> Self {
        let rows = blocks.first().map_or(0, |b| b.rows);
        assert!(
            blocks.iter().all(|b| b.rows == rows),
            "blocks next to each other need equal heights"
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

    /// Returns the first `rows` rows, or all rows if there are fewer.
    #[must_use]
    pub(crate) fn head(&self, rows: usize) -> Self {
        let rows = rows.min(self.rows);
        Self {
            rows,
            columns: self.columns,
            entries: self.entries[..rows * self.columns].to_vec(),
        }
    }

    /// Returns the number of rows.
    #[must_use]
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// Returns all entries, by rows.
    #[must_use]
    pub(crate) fn entries(&self) -> &[T] {
        &self.entries
    }

    /// Returns one row.
    ///
    /// # Panics
    /// Panics if the row does not exist.
    #[must_use]
    pub(crate) fn row(&self, row: usize) -> &[T] {
        &self.entries[row * self.columns..][..self.columns]
    }

    /// Returns one entry.
    ///
    /// # Panics
    /// Panics if the entry does not exist.
    #[must_use]
    pub(crate) fn get(&self, row: usize, column: usize) -> T {
        self.row(row)[column]
    }

    /// Changes one entry.
    ///
    /// # Panics
    /// Panics if the entry does not exist.
    pub(crate) fn set(&mut self, row: usize, column: usize, value: T) {
        assert!(column < self.columns, "column {column} of {}", self.columns);
        self.entries[row * self.columns + column] = value;
    }

    /// Applies a function to each entry and returns the resulting block.
    #[must_use]
    pub(crate) fn map<U>(&self, f: impl Fn(T) -> U) -> Block<U> {
        Block {
            rows: self.rows,
            columns: self.columns,
            entries: self.entries.iter().map(|&e| f(e)).collect(),
        }
    }

    /// Combines the corresponding entries of two blocks of the same shape.
    ///
    /// # Panics
    /// Panics if the shapes differ.
    #[must_use]
    pub(crate) fn zip(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self {
        let mut combined = self.clone();
        combined.update(other, f);
        combined
    }

    /// Combines each entry with the corresponding entry of a block of the same shape, in place.
    ///
    /// # Panics
    /// Panics if the shapes differ.
    pub(crate) fn update(&mut self, other: &Self, f: impl Fn(T, T) -> T) {
        assert_eq!(
            (self.rows, self.columns),
            (other.rows, other.columns),
            "blocks entry by entry need equal shapes"
        );
        for (a, &b) in self.entries.iter_mut().zip(&other.entries) {
            *a = f(*a, b);
        }
    }
}

impl<T: Ring> Block<T> {
    /// Returns the product with a vector.
    #[must_use]
    pub(crate) fn times(&self, v: &[T]) -> Self {
        Self::column((0..self.rows).map(|r| dot(self.row(r), v)).collect())
    }

    /// Returns the product of the transpose with a vector.
    #[must_use]
    pub(crate) fn transpose_times(&self, v: &[T]) -> Self {
        let column = |k| (0..self.rows).map(|r| self.get(r, k)).collect::<Vec<_>>();
        Self::column((0..self.columns).map(|k| dot(&column(k), v)).collect())
    }
}

/// Returns the scalar product of two vectors.
pub(crate) fn dot<T: Ring>(a: &[T], b: &[T]) -> T {
    let products = a.iter().zip(b).map(|(&a, &b)| a * b);
    products.fold(T::from(0.0), |sum, product| sum + product)
}

impl Block {
    /// Returns the largest magnitude of an entry, or NaN if an entry is NaN.
    #[must_use]
    pub(crate) fn largest(&self) -> f64 {
        largest(self.entries.iter().copied())
    }

    /// Returns the Frobenius norm.
    #[must_use]
    pub(crate) fn norm(&self) -> f64 {
        self.entries.iter().map(|e| e * e).sum::<f64>().sqrt()
    }

    /// Returns the row and the column of the entry with the largest difference from the
    /// corresponding entry of `other`. A NaN counts as the largest difference. Returns `None` for
    /// empty blocks.
    #[must_use]
    pub(crate) fn worst(&self, other: &Self) -> Option<(usize, usize)> {
        let difference = self.zip(other, |a, b| (a - b).abs());
        let rank = |e: f64| if e.is_nan() { f64::INFINITY } else { e };
        let (at, _) = difference
            .entries
            .iter()
            .enumerate()
            .max_by(|(_, a), (_, b)| rank(**a).total_cmp(&rank(**b)))?;
        Some((at / self.columns, at % self.columns))
    }

    /// Returns the largest difference between corresponding entries. The difference is NaN if a
    /// difference is NaN, or if the shapes differ.
    #[must_use]
    pub(crate) fn difference(&self, other: &Self) -> f64 {
        if (self.rows, self.columns) == (other.rows, other.columns) {
            let differences = self.entries.iter().zip(&other.entries);
            largest(differences.map(|(a, b)| a - b))
        } else {
            f64::NAN
        }
    }
}

/// Returns the largest magnitude, or NaN if a value is NaN.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m: f64, e| {
        if m.is_nan() || e.is_nan() {
            f64::NAN
        } else {
            m.max(e.abs())
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_and_another_shape_equal_nothing() {
        let a = Block::column(vec![f64::NAN, 0.0]);
        assert!(a.difference(&a).is_nan());
        let short = Block::column(vec![0.0]);
        assert!(short.difference(&Block::column(vec![0.0, 0.0])).is_nan());
        assert_eq!(a.worst(&Block::column(vec![0.0, 9.0])), Some((0, 0)));
    }

    #[test]
    fn blocks_side_by_side_keep_their_rows() {
        let column = |a, b| Block::column(vec![a, b]);
        let c = Block::beside(&[column(1.0, 2.0), column(3.0, 5.0), column(4.0, 6.0)]);
        assert_eq!(
            (c.row(0), c.row(1)),
            (&[1.0, 3.0, 4.0][..], &[2.0, 5.0, 6.0][..])
        );
        let products = (c.times(&[1.0, 1.0, 2.0]), c.transpose_times(&[1.0, 1.0]));
        assert_eq!(products.0.entries(), [12.0, 19.0]);
        assert_eq!(products.1.entries(), [3.0, 8.0, 10.0]);
    }
}
