//! Rows of C of one joint or drive. The holonomic rows of C come first. A joint may have both
//! holonomic and nonholonomic rows. The values of the rows of a joint, in the order of its
//! definition, are the values of these two ranges in sequence.

use std::fmt;
use std::iter::Chain;
use std::ops::Range;

/// Rows of C that belong to one joint or drive, in ascending order.
///
/// ```
/// use pfaff_model::RowRanges;
/// // A wheel in a mechanism with five holonomic rows: it touches by one, rolls by two others.
/// let wheel = RowRanges { holonomic: 3..4, nonholonomic: 5..7 };
/// assert_eq!(wheel.iter().collect::<Vec<_>>(), [3, 5, 6]);
/// assert_eq!((wheel.len(), wheel.row(1), wheel.own(6), wheel.own(4)), (3, 5, Some(2), None));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RowRanges {
    /// Rows of Φ.
    pub holonomic: Range<usize>,
    /// Rows of Ψ.
    pub nonholonomic: Range<usize>,
}

impl RowRanges {
    /// Returns the number of rows.
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        self.holonomic.len() + self.nonholonomic.len()
    }

    /// Returns whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.holonomic.is_empty() && self.nonholonomic.is_empty()
    }

    /// Returns the rows, in ascending order.
    #[inline]
    pub fn iter(&self) -> Chain<Range<usize>, Range<usize>> {
        self.holonomic.clone().chain(self.nonholonomic.clone())
    }

    /// Returns whether a row of C belongs to these rows.
    #[must_use]
    pub fn contains(&self, row: usize) -> bool {
        self.holonomic.contains(&row) || self.nonholonomic.contains(&row)
    }

    /// Converts the index `own` of a row in the definition to the row of C.
    #[inline]
    #[must_use]
    pub fn row(&self, own: usize) -> usize {
        match own.checked_sub(self.holonomic.len()) {
            None => self.holonomic.start + own,
            Some(own) => self.nonholonomic.start + own,
        }
    }

    /// Converts a row of C to the index of the row in the definition. The result is `None` if the
    /// row does not belong to this joint or drive.
    #[must_use]
    pub fn own(&self, row: usize) -> Option<usize> {
        if self.holonomic.contains(&row) {
            Some(row - self.holonomic.start)
        } else {
            let is_here = self.nonholonomic.contains(&row);
            is_here.then(|| self.holonomic.len() + row - self.nonholonomic.start)
        }
    }

    /// Returns the rows as one range if they are consecutive in C.
    #[inline]
    fn adjacent(&self) -> Option<Range<usize>> {
        if self.nonholonomic.is_empty() {
            Some(self.holonomic.clone())
        } else if self.holonomic.is_empty() || self.holonomic.end == self.nonholonomic.start {
            let first = self.nonholonomic.start - self.holonomic.len();
            Some(first..self.nonholonomic.end)
        } else {
            None
        }
    }

    /// Selects the values of these rows from the values of all rows of C. The values are copied to
    /// `storage` only if the rows are not consecutive.
    ///
    /// # Panics
    /// Panics if `all` is too short.
    #[inline]
    pub fn of<'a, T: Copy>(&self, all: &'a [T], storage: &'a mut Vec<T>) -> &'a [T] {
        match self.adjacent() {
            Some(rows) => &all[rows],
            None => {
                storage.clear();
                storage.extend(self.iter().map(|row| all[row]));
                storage
            }
        }
    }

    /// Calls `write` to write the values of these rows. The values are written in place if the rows
    /// are consecutive.
    ///
    /// # Panics
    /// Panics if `all` is too short.
    #[inline]
    pub(crate) fn write<T: Copy>(
        &self,
        all: &mut [T],
        storage: &mut Vec<T>,
        write: impl FnOnce(&mut [T]),
    ) {
        match self.adjacent() {
            Some(rows) => write(&mut all[rows]),
            None => {
                storage.clear();
                storage.extend(self.iter().map(|row| all[row]));
                write(storage);
                for (row, value) in self.iter().zip(storage) {
                    all[row] = *value;
                }
            }
        }
    }
}

/// Prints the rows (1-based), for example `18`, `1–5`, or `6, 25–26`.
impl fmt::Display for RowRanges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut between = "";
        for rows in [&self.holonomic, &self.nonholonomic] {
            match rows.len() {
                0 => continue,
                1 => write!(f, "{between}{}", rows.end)?,
                _ => write!(f, "{between}{}–{}", rows.start + 1, rows.end)?,
            }
            between = ", ";
        }
        Ok(())
    }
}

impl IntoIterator for RowRanges {
    type Item = usize;
    type IntoIter = Chain<Range<usize>, Range<usize>>;

    #[inline]
    fn into_iter(self) -> Self::IntoIter {
        self.holonomic.chain(self.nonholonomic)
    }
}

impl IntoIterator for &RowRanges {
    type Item = usize;
    type IntoIter = Chain<Range<usize>, Range<usize>>;

    #[inline]
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranges(holonomic: Range<usize>, nonholonomic: Range<usize>) -> RowRanges {
        RowRanges {
            holonomic,
            nonholonomic,
        }
    }

    #[test]
    fn rows_are_found_both_ways() {
        for (rows, listed) in [
            (ranges(1..3, 0..0), vec![1, 2]),
            (ranges(0..0, 4..6), vec![4, 5]),
            (ranges(2..3, 3..5), vec![2, 3, 4]),
            (ranges(0..1, 4..6), vec![0, 4, 5]),
        ] {
            assert_eq!(rows.iter().collect::<Vec<_>>(), listed);
            assert_eq!(rows.clone().into_iter().collect::<Vec<_>>(), listed);
            assert_eq!((rows.len(), rows.is_empty()), (listed.len(), false));
            for row in 0..7 {
                let own = listed.iter().position(|&at| at == row);
                assert_eq!((rows.own(row), rows.contains(row)), (own, own.is_some()));
                assert_eq!(own.map(|own| rows.row(own)), own.map(|_| row));
            }
        }
    }

    #[test]
    fn rows_are_counted_from_one() {
        let told = [ranges(0..5, 0..0), ranges(5..6, 24..26), ranges(0..0, 7..8)];
        assert_eq!(told.map(|rows| rows.to_string()), ["1–5", "6, 25–26", "8"]);
        assert_eq!(RowRanges::default().to_string(), "");
    }

    #[test]
    fn values_of_two_ranges_are_read_and_written() {
        let (mut all, mut storage) = ([10, 11, 12, 13, 14, 15], Vec::new());
        for (rows, read) in [
            (ranges(0..1, 4..6), vec![10, 14, 15]),
            (ranges(2..3, 3..5), vec![12, 13, 14]),
            (ranges(0..0, 1..3), vec![11, 12]),
        ] {
            assert_eq!(rows.of(&all, &mut storage), read);
        }
        ranges(1..2, 4..6).write(&mut all, &mut storage, |own| {
            assert_eq!(own, [11, 14, 15]);
            own.copy_from_slice(&[1, 2, 3]);
        });
        ranges(0..0, 2..4).write(&mut all, &mut storage, |own| own.fill(7));
        assert_eq!(all, [10, 1, 7, 7, 2, 3]);
    }
}
