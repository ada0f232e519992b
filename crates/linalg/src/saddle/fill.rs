//! Which entries of L and U can be other than zero, for rows whose columns are known and an order
//! in which coordinates are solved for. Factors are stored, and visited, at these entries only.

use std::ops::Range;

/// Entries of the rows of the factors, row after row. All storage is made at the beginning.
#[derive(Debug, Clone)]
pub(super) struct Fill {
    rows: Vec<Row>,
    /// Position of each entry.
    position: Vec<usize>,
    is_there: Vec<bool>,
}

/// Where the entries of row j stand: those of U above the diagonal, which are the rows that it is
/// eliminated with, ascending; the diagonal; those of L.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub(super) start: usize,
    pub(super) diagonal: usize,
    pub(super) end: usize,
}

impl Row {
    pub(super) fn upper(self) -> Range<usize> {
        self.start..self.diagonal
    }

    pub(super) fn lower(self) -> Range<usize> {
        self.diagonal + 1..self.end
    }
}

impl Fill {
    /// Room for so many rows of n entries.
    pub(super) fn new(n: usize, rows: usize) -> Self {
        Self {
            rows: Vec::with_capacity(rows),
            position: Vec::with_capacity(rows * n),
            is_there: vec![false; n],
        }
    }

    pub(super) fn row(&self, j: usize) -> Row {
        self.rows[j]
    }

    pub(super) fn positions(&self, entries: Range<usize>) -> &[usize] {
        &self.position[entries]
    }

    /// Appends a row with entries in these columns, column c at position `place[c]`.
    pub(super) fn push(&mut self, columns: &[usize], place: &[usize]) {
        let (j, start) = (self.rows.len(), self.position.len());
        self.is_there.fill(false);
        for &column in columns {
            self.is_there[place[column]] = true;
        }
        for k in 0..j {
            if self.is_there[k] {
                self.position.push(k);
                for &i in &self.position[self.rows[k].lower()] {
                    self.is_there[i] = true;
                }
            }
        }
        let diagonal = self.position.len();
        self.position.push(j);
        let below = self.is_there.iter().enumerate().skip(j + 1);
        let below = below.filter_map(|(i, is_there)| is_there.then_some(i));
        self.position.extend(below);
        let end = self.position.len();
        self.rows.push(Row {
            start,
            diagonal,
            end,
        });
    }

    /// Keeps so many rows.
    pub(super) fn truncate(&mut self, rows: usize) {
        self.rows.truncate(rows);
        let end = self.rows.last().map_or(0, |row| row.end);
        self.position.truncate(end);
    }

    /// Takes the first rows of another one instead of its own.
    pub(super) fn copy_first(&mut self, rows: usize, other: &Self) {
        self.rows.clear();
        self.rows.extend_from_slice(&other.rows[..rows]);
        let end = self.rows.last().map_or(0, |row| row.end);
        self.position.clear();
        self.position.extend_from_slice(&other.position[..end]);
    }

    /// The last row is solved for the coordinate at another position, one of its own: both change
    /// places in the rows before. In its own list stands what was solved for until now.
    pub(super) fn swap(&mut self, at: usize) {
        let j = self.rows.len() - 1;
        for i in &mut self.position[..self.rows[j].start] {
            *i = match *i {
                i if i == at => j,
                i if i == j => at,
                i => i,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KeptRowSaddle, SaddleError};

    /// Rounding of eight independent rows of entries up to 1: pivots are above 1e-2 of them.
    const AGREES: f64 = 1e-12;

    /// Rows of four entries in twelve columns, in an order that is kept, begun anew, and turned
    /// from.
    #[test]
    fn known_columns_change_rounding_only() {
        const N: usize = 12;
        let columns: Vec<Vec<usize>> = (0..8)
            .map(|k| vec![k, (k + 3) % N, (2 * k + 5) % N, (3 * k + 7) % N])
            .collect();
        let mass = [
            1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0,
        ];
        let mut sparse = KeptRowSaddle::with_columns(N, &columns).unwrap();
        let mut dense = KeptRowSaddle::new(N, columns.len()).unwrap();
        let mut turns = 0;
        for round in 0..60 {
            let mut rows = vec![[0.0; N]; columns.len()];
            for (k, columns) in columns.iter().enumerate() {
                for (l, &column) in columns.iter().enumerate() {
                    rows[k][column] = (0.05 * f64::from(round) + (5 * k + 11 * l) as f64).sin();
                }
            }
            let [found, expected] = [&mut sparse, &mut dense].map(|saddle| {
                saddle.factor(|k| &rows[k], &mass).unwrap();
                let (mut a, mut lambda) = ([0.0; N], [0.0; 8]);
                saddle.solve(&mass, &[0.5; 8], &mut a, &mut lambda).unwrap();
                turns += usize::from(saddle.lu.has_turned());
                if round % 4 == 0 {
                    saddle.keep_order();
                }
                if round == 30 {
                    saddle.forget_partition();
                }
                [&a[..], &lambda].concat()
            });
            let size = expected.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < AGREES * size, "round {round}: {a} {b}");
            }
        }
        assert!((30..90).contains(&turns), "{turns} turns");
    }

    #[test]
    fn columns_and_rows_that_there_are_not() {
        let wrong = KeptRowSaddle::with_columns(2, &[vec![0, 2]]).unwrap_err();
        let text = "row 0 has an entry in column 2, need columns below 2";
        assert_eq!(wrong.to_string(), text);
        let many = KeptRowSaddle::new(2, usize::MAX).unwrap_err();
        assert_eq!(
            many,
            SaddleError::TooManyRows {
                n: 2,
                r: usize::MAX
            }
        );
    }

    #[test]
    fn a_chain_closed_by_its_last_row_fills_what_is_between() {
        let columns = [vec![0, 1], vec![1, 2], vec![0, 3]];
        let of_order = |place: [usize; 4]| {
            let mut fill = Fill::new(4, 3);
            columns.iter().for_each(|row| fill.push(row, &place));
            fill
        };
        let of = |fill: &Fill, entries: fn(Row) -> Range<usize>| -> Vec<Vec<usize>> {
            let rows = fill.rows.iter();
            rows.map(|&row| fill.positions(entries(row)).to_vec())
                .collect()
        };
        let fill = of_order([0, 1, 2, 3]);
        // Row 2 takes up column 1 from row 0, and with it column 2 from row 1.
        assert_eq!(of(&fill, Row::upper), [vec![], vec![], vec![0, 1]]);
        assert_eq!(of(&fill, Row::lower), [vec![1], vec![2], vec![3]]);
        // Solved for its own column, the last row meets no other.
        let fill = of_order([3, 0, 1, 2]);
        assert_eq!(of(&fill, Row::upper), [vec![], vec![0], vec![]]);
        assert_eq!(of(&fill, Row::lower), [vec![3], vec![3], vec![3]]);
    }
}
