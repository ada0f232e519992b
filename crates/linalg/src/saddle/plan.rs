//! Decides the order of elimination of the rows, and the pivot coordinate of each row.

use super::lists::{Entry, Lists};
use super::order::Order;
use crate::limits::{CANDIDATE, LARGEST_REPEATED, PIVOT_CHOSEN, PIVOT_REPEATED};

/// Data that determine the pivot coordinates of the rows.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    /// Coordinates that may be pivots; `None` permits all coordinates.
    solvable: Option<Vec<bool>>,
    /// Whether smaller entries may be pivots to reduce the work for other rows. Smaller pivots are
    /// not allowed if they have no advantage, or if the pivots must indicate how suitable the given
    /// coordinates are.
    spares: bool,
    pub(super) order: Order,
    /// The position of each row in the order (empty before the order is chosen). For each
    /// coordinate, a second field contains the positions of the rows that can have entries in it,
    /// ascending.
    place: Vec<u32>,
    touching: Lists,
}

impl Plan {
    /// Creates a plan without an order for this number of rows and n coordinates.
    pub(super) fn new(n: usize, rows: usize, entries: usize) -> Self {
        Self {
            solvable: None,
            spares: false,
            order: Order::default(),
            place: Vec::with_capacity(rows),
            touching: Lists::with_capacity(n, entries),
        }
    }

    /// Permits only these coordinates as pivots from the next factorisation on; `None` permits all.
    /// The order must be chosen again.
    pub(super) fn solve_for(&mut self, solvable: Option<Vec<bool>>) {
        self.solvable = solvable;
        self.place.clear();
    }

    /// Returns whether the order must still be chosen.
    pub(super) fn is_due(&self, columns: &Lists) -> bool {
        self.place.len() < columns.len()
    }

    /// Chooses the order by the values of the rows in their columns.
    pub(super) fn choose<'c>(
        &mut self,
        n: usize,
        columns: &Lists,
        row: impl Fn(usize) -> &'c [f64],
    ) {
        let entries = |k: usize| {
            let entries = columns.of(k).iter().zip(row(k));
            entries.map(|(&i, &c)| Entry::new(i as usize, c)).collect()
        };
        let rows = (0..columns.len()).map(entries).collect();
        self.order = Order::new(n, rows, self.solvable.as_deref());
        self.spares = self.solvable.is_none() && self.order.is_planned();
        self.place.resize(columns.len(), 0);
        let mut touching = vec![Vec::new(); n];
        for (place, &row) in self.order.rows.iter().enumerate() {
            self.place[row] = place as u32;
            for &column in columns.of(row) {
                touching[column as usize].push(place as u32);
            }
        }
        self.touching.clear();
        touching
            .into_iter()
            .for_each(|list| self.touching.push(list));
    }

    /// Returns the criterion for the pivot entry of a row; it uses masses if they are graded.
    #[inline]
    pub(super) fn choice<'a>(&'a self, graded: Option<&'a [f64]>) -> Choice<'a> {
        Choice {
            solvable: self.solvable.as_deref(),
            graded,
            spares: self.spares,
        }
    }

    /// Returns the planned pivot coordinate of a row, if there is one. In this coordinate the row
    /// affects the other rows least. Also returns a function for the number of later rows that can
    /// have entries in a coordinate.
    pub(super) fn of_row(&self, row: usize) -> (Option<usize>, impl Fn(usize) -> usize) {
        let place = self.place[row];
        let later = move |i: usize| {
            let places = self.touching.of(i);
            places.len() - places.partition_point(|&p| p <= place)
        };
        (self.order.wish[place as usize], later)
    }
}

/// Criterion for the pivot entry of a row. The criterion uses the size of the entry. If the masses
/// are graded, the criterion also uses the masses. If they are not graded, it uses the number of
/// later rows in the coordinate of the entry.
#[derive(Clone, Copy)]
pub(super) struct Choice<'a> {
    solvable: Option<&'a [bool]>,
    graded: Option<&'a [f64]>,
    spares: bool,
}

/// The pivot coordinate of a row, and the reference size for its entry: the largest entry of the
/// row or, for graded masses, the entry itself.
pub(super) type RowPivot = (usize, f64);

impl Choice<'_> {
    /// Returns the pivot coordinate, or `None` if no entry can be a pivot. The pivot coordinate is
    /// the planned coordinate if its entry is large enough. Otherwise it is the coordinate in which
    /// the fewest later rows can have entries.
    pub(super) fn best(
        self,
        x: &[f64],
        among: impl Iterator<Item = usize> + Clone,
        (wish, later): (Option<usize>, impl Fn(usize) -> usize),
    ) -> Option<RowPivot> {
        let among = among.filter(|&i| self.solvable.is_none_or(|solvable| solvable[i]));
        let larger = |a: usize, b: usize| {
            let is_larger = x[b].abs() > x[a].abs() || x[b].abs() == x[a].abs() && b < a;
            if is_larger || x[a].is_nan() { b } else { a }
        };
        let largest = among.clone().reduce(larger)?;
        let size = x[largest].abs();
        if self.graded.is_some() {
            let at = self.lightest(x, among, size)?;
            return Some((at, x[at].abs()));
        }
        let least = if self.spares { PIVOT_CHOSEN } else { 1.0 } * size;
        let candidates = among.filter(|&i| x[i].abs() >= least);
        if let Some(at) = candidates.clone().find(|i| Some(*i) == wish) {
            return Some((at, size));
        }
        let rarer = |a: (usize, usize), b: (usize, usize)| {
            let [rows, other] = [a.1, b.1];
            if other < rows || other == rows && larger(a.0, b.0) == b.0 {
                b
            } else {
                a
            }
        };
        let rarest = candidates.map(|i| (i, later(i))).reduce(rarer);
        Some((rarest.map_or(largest, |(at, _)| at), size))
    }

    /// Returns the coordinate with the largest c²/m among the large entries of graded masses.
    fn lightest(
        self,
        x: &[f64],
        among: impl Iterator<Item = usize>,
        largest: f64,
    ) -> Option<usize> {
        let mass = self.graded?;
        let candidates = among.filter(|&i| x[i].abs() >= CANDIDATE * largest);
        // The comparison of c²/m uses no quotients, because masses may be zero.
        let lighter = |a: usize, b: usize| {
            let [of_a, of_b] = [x[a] * x[a] * mass[b], x[b] * x[b] * mass[a]];
            if of_b > of_a || of_b == of_a && b < a {
                b
            } else {
                a
            }
        };
        candidates.reduce(lighter)
    }

    /// Returns the size of the largest possible pivot entry, if the entry of this coordinate is at
    /// least the share [`PIVOT_REPEATED`] of the best entry.
    pub(super) fn largest(
        self,
        x: &[f64],
        at: usize,
        others: impl Iterator<Item = usize> + Clone,
    ) -> Option<f64> {
        let pivot = x[at].abs();
        let larger = |m: f64, i: usize| if x[i].abs() > m { x[i].abs() } else { m };
        let Some(mass) = self.graded else {
            let largest = match self.solvable {
                None => others.fold(pivot, larger),
                Some(solvable) => others.filter(|&i| solvable[i]).fold(pivot, larger),
            };
            // The comparison is also false for NaN.
            let share = if self.spares {
                PIVOT_REPEATED
            } else {
                LARGEST_REPEATED
            };
            return (pivot >= share * largest).then_some(largest);
        };
        let others = others.filter(|&i| self.solvable.is_none_or(|solvable| solvable[i]));
        let all = others.chain([at]);
        let largest = all.clone().fold(0.0, larger);
        let best = self.lightest(x, all, largest)?;
        let share = LARGEST_REPEATED * x[best];
        let is_light = x[at] * x[at] * mass[best] >= share * share * mass[at];
        // A pivot with a light coordinate is compared with its own entry.
        (pivot >= CANDIDATE * largest && is_light).then_some(pivot)
    }
}
