//! The order in which rows are eliminated, and the best pivot coordinate of each row. Candidates
//! are all pairs of a row and a coordinate in which the row has a large entry. The pair with the
//! least work for the remaining rows comes first.
//!
//! If a row has e entries, and d other rows have entries in its pivot coordinate, the elimination
//! takes d·(e − 1) products and adds its other entries to the d rows. Source: H. M. Markowitz, The
//! elimination form of the inverse and its application to linear programming, Management Science 3
//! (1957) 255–269.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::lists::Entry;
use crate::limits::{PIVOT_PLANNED, REVISED};

/// Rows in the order of their elimination, each with its planned pivot coordinate. The planned
/// coordinate is used if its entry is large enough.
#[derive(Debug, Clone, Default)]
pub(super) struct Order {
    pub(super) rows: Vec<usize>,
    pub(super) wish: Vec<Option<usize>>,
}

impl Order {
    /// Determines the order for n coordinates and rows with these entries. The entries include
    /// values that are zero now but not at other configurations. `solvable` restricts the
    /// coordinates that can be pivots.
    pub(super) fn new(n: usize, rows: Vec<Vec<Entry>>, solvable: Option<&[bool]>) -> Self {
        if rows.iter().all(|row| row.len() == n) {
            // If all rows are dense, L and U are full in every order.
            return Self {
                wish: vec![None; rows.len()],
                rows: (0..rows.len()).collect(),
            };
        }
        let mut order = Self::default();
        let mut left = RemainingRows::new(n, rows, solvable);
        while let Some((row, wish)) = left.next() {
            order.rows.push(row);
            order.wish.push(wish);
        }
        order
    }

    /// Returns whether some rows have a planned pivot coordinate that reduces the work for other
    /// rows.
    pub(super) fn is_planned(&self) -> bool {
        self.wish.iter().any(Option::is_some)
    }
}

/// The work of eliminating a row, its number of entries, and the row.
type RowWork = (usize, usize, usize);

/// The rows that are not eliminated yet.
struct RemainingRows<'s> {
    solvable: Option<&'s [bool]>,
    /// Entries of each row, ascending.
    entries: Vec<Vec<Entry>>,
    /// Rows that have entries in each coordinate.
    rows: Vec<Vec<usize>>,
    is_eliminated: Vec<bool>,
    /// Each row with its present elimination work, or with a larger earlier value.
    queue: BinaryHeap<Reverse<RowWork>>,
}

impl<'s> RemainingRows<'s> {
    fn new(n: usize, mut entries: Vec<Vec<Entry>>, solvable: Option<&'s [bool]>) -> Self {
        let mut rows = vec![Vec::new(); n];
        for (row, entries) in entries.iter_mut().enumerate() {
            entries.sort_by_key(|entry| entry.index);
            entries.iter().for_each(|e| rows[e.index()].push(row));
        }
        let mut left = Self {
            solvable,
            is_eliminated: vec![false; entries.len()],
            queue: BinaryHeap::with_capacity(entries.len()),
            entries,
            rows,
        };
        (0..left.entries.len()).for_each(|row| left.revise(row));
        left
    }

    /// Returns the work of eliminating a row, and the entry of the coordinate with the least work.
    fn least(&self, row: usize) -> (RowWork, Option<Entry>) {
        let entries = self.entries[row].iter();
        let entries = entries.filter(|e| self.solvable.is_none_or(|solvable| solvable[e.index()]));
        let sizes = entries.clone().map(|e| e.value.abs());
        let least = PIVOT_PLANNED * sizes.fold(0.0, f64::max);
        let large = entries.filter(|e| e.value != 0.0 && e.value.abs() >= least);
        let rarest = large.copied().reduce(|a, b| {
            let [of_a, of_b] = [a, b].map(|e| self.rows[e.index()].len());
            if of_b < of_a || of_b == of_a && b.value.abs() > a.value.abs() {
                b
            } else {
                a
            }
        });
        let others = rarest.map_or(0, |e| self.rows[e.index()].len() - 1);
        let work = others * self.entries[row].len().saturating_sub(1);
        // Rows without an entry that can be a pivot come last.
        let work = if rarest.is_none() { usize::MAX } else { work };
        ((work, self.entries[row].len(), row), rarest)
    }

    fn revise(&mut self, row: usize) {
        let (work, _) = self.least(row);
        self.queue.push(Reverse(work));
    }

    /// Eliminates the next row.
    fn next(&mut self) -> Option<(usize, Option<usize>)> {
        loop {
            let Reverse(known) = self.queue.pop()?;
            let row = known.2;
            if self.is_eliminated[row] {
                continue;
            }
            let (work, rarest) = self.least(row);
            if work > known {
                self.queue.push(Reverse(work));
                continue;
            }
            self.eliminate(row, rarest);
            return Some((row, rarest.map(|e| e.index())));
        }
    }

    fn eliminate(&mut self, row: usize, pivot: Option<Entry>) {
        self.is_eliminated[row] = true;
        let own = std::mem::take(&mut self.entries[row]);
        for e in &own {
            self.rows[e.index()].retain(|&other| other != row);
        }
        if let Some(pivot) = pivot {
            for other in std::mem::take(&mut self.rows[pivot.index()]) {
                self.subtract(other, &own, pivot);
                self.revise(other);
            }
        }
        // Fewer rows now have entries in the coordinates of the eliminated row.
        for e in own {
            let rows = &self.rows[e.index()];
            if rows.len() <= REVISED {
                for other in rows.clone() {
                    self.revise(other);
                }
            }
        }
    }

    /// Eliminates the entry of another row in the coordinate of this pivot.
    fn subtract(&mut self, other: usize, own: &[Entry], pivot: Entry) {
        let before = std::mem::take(&mut self.entries[other]);
        let at = before.binary_search_by_key(&pivot.index, |e| e.index);
        let factor = at.map_or(0.0, |at| before[at].value / pivot.value);
        let mut joined = Vec::with_capacity(before.len() + own.len());
        let mut rest = before.into_iter().peekable();
        for e in own {
            while let Some(first) = rest.next_if(|first| first.index < e.index) {
                joined.push(first);
            }
            let known = rest.next_if(|first| first.index == e.index);
            if known.is_none() {
                self.rows[e.index()].push(other);
            }
            if e.index != pivot.index {
                let value = known.map_or(0.0, |known| known.value) - factor * e.value;
                joined.push(Entry::new(e.index(), value));
            }
        }
        joined.extend(rest);
        self.entries[other] = joined;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::KeptRowSaddle;

    fn order(n: usize, rows: &[&[(usize, f64)]]) -> Order {
        let entries = |row: &&[(usize, f64)]| row.iter().map(|&(i, x)| Entry::new(i, x)).collect();
        Order::new(n, rows.iter().map(entries).collect(), None)
    }

    /// Three links on a hub. The rows of the links come first, with pivots in coordinates that no
    /// other row contains.
    #[test]
    fn the_hub_comes_last() {
        let hub: &[_] = &[(0, 1.0), (1, 0.7)];
        let links = [2, 3, 4].map(|own| [(0, 1.0), (own, 0.5)]);
        let found = order(5, &[hub, &links[0], &links[1], &links[2]]);
        assert_eq!(found.wish[..3], [1, 2, 3].map(Some));
        assert_eq!(found.rows[..3], [0, 1, 2]);
        // An entry that is too small or zero is not planned as a pivot.
        let small = [(0, 1.0), (2, 0.49)];
        let found = order(5, &[hub, &small, &[(0, 1.0), (3, 0.0)], &links[2]]);
        assert_eq!(
            (found.rows[..2].to_vec(), found.wish[..2].to_vec()),
            (vec![0, 3], vec![Some(1), Some(4)])
        );
    }

    #[test]
    fn each_row_comes_once_and_rows_without_entries_come_last() {
        for seed in 0..30_usize {
            let n = 40;
            let row = |k: usize| -> Vec<(usize, f64)> {
                let columns = [
                    k,
                    (7 * k + seed) % n,
                    (5 * k + 3) % n,
                    (11 * k + 2 * seed) % n,
                ];
                let mut row: Vec<_> = columns
                    .iter()
                    .map(|&i| (i, (0.3 + (seed + 3 * k + 5 * i) as f64).sin()))
                    .collect();
                row.sort_by_key(|e| e.0);
                row.dedup_by_key(|e| e.0);
                if k == seed { Vec::new() } else { row }
            };
            let rows: Vec<Vec<(usize, f64)>> = (0..30).map(row).collect();
            let rows: Vec<&[(usize, f64)]> = rows.iter().map(Vec::as_slice).collect();
            let found = order(n, &rows);
            let mut sorted = found.rows.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..30), "{:?}", found.rows);
            assert_eq!((found.rows[29], found.wish[29]), (seed, None));
            let mut wishes = found.wish.clone();
            wishes.sort_unstable();
            wishes.dedup();
            assert_eq!(wishes.len(), 30, "{:?}", found.wish);
            let again = order(n, &rows);
            assert_eq!((again.rows, again.wish), (found.rows, found.wish));
        }
    }

    /// The planned entry of the first row is later zero. The largest entry of the row is then in
    /// the coordinate of both other rows, and another entry is in a coordinate that no other row
    /// contains.
    #[test]
    fn a_row_is_solved_for_what_few_later_rows_have_entries_in() {
        let columns = [vec![0, 1, 4], vec![0, 2, 5, 6], vec![0, 3, 7, 8]];
        for (share, solved_for) in [(0.11, 1), (0.09, 0)] {
            let mut saddle = KeptRowSaddle::with_columns(9, &columns).expect("fewer rows");
            let mut first = |row: &[f64; 3]| {
                let row = |k: usize| if k == 0 { &row[..] } else { &[1.0; 4] };
                saddle.factor(row, &[1.0; 9]).expect("independent");
                saddle.solved_for()[0]
            };
            assert_eq!(first(&[0.4, 0.4, 1.0]), 4);
            assert_eq!(first(&[1.0, share, 0.0]), solved_for);
        }
    }
}
