//! The order in which a factorisation uses coordinates, and the entries that may be non-zero in
//! that order.

use super::fill::Fill;

/// Coordinates in the order of elimination.
#[derive(Debug, Clone)]
pub(super) struct Order {
    /// The columns outside which each row of C is zero.
    pub(super) columns: Vec<Vec<usize>>,
    /// What elimination in this order leaves of that.
    pub(super) fill: Fill,
    pub(super) coordinates: Vec<usize>,
    /// Where each coordinate stands among them.
    pub(super) place: Vec<usize>,
    /// Whether somebody has chosen it, or a factorisation has led to it.
    pub(super) is_chosen: bool,
    /// How many rows have entries in each coordinate.
    pub(super) rows_of: Vec<usize>,
    /// How many of them, the first ones, may be solved for.
    pub(super) solvable: usize,
    /// +1 for an even permutation, −1 for an odd one.
    pub(super) parity: f64,
}

impl Order {
    /// The order of the numbers of the coordinates.
    pub(super) fn new(n: usize, columns: &[Vec<usize>]) -> Self {
        let mut rows_of = vec![0; n];
        columns.iter().flatten().for_each(|&c| rows_of[c] += 1);
        let mut order = Self {
            is_chosen: false,
            rows_of,
            fill: Fill::new(n, columns.len()),
            columns: columns.to_vec(),
            coordinates: Vec::with_capacity(n),
            place: vec![0; n],
            solvable: n,
            parity: 1.0,
        };
        order.reset();
        order
    }

    /// That of the numbers of the coordinates, from which each row turns to its own.
    pub(super) fn reset(&mut self) {
        let n = self.place.len();
        self.change(0..n, n);
        self.is_chosen = false;
    }

    /// Changes to another order of the same rows; does not allocate if `coordinates` does not.
    pub(super) fn change(&mut self, coordinates: impl Iterator<Item = usize>, solvable: usize) {
        self.coordinates.clear();
        self.coordinates.extend(coordinates);
        self.solvable = solvable;
        self.is_chosen = true;
        let p = &self.coordinates;
        for (i, &coordinate) in p.iter().enumerate() {
            self.place[coordinate] = i;
        }
        self.fill.truncate(0);
        for columns in &self.columns {
            self.fill.push(columns, &self.place);
        }
        let later = |i: usize| p[i + 1..].iter().filter(move |&&x| x < p[i]).count();
        let inversions: usize = (0..p.len()).map(later).sum();
        self.parity = if inversions.is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
    }
}
