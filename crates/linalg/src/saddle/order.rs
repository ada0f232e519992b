//! The order in which a factorisation uses coordinates, and the entries that may be non-zero in
//! that order.

use super::fill::{Fill, Lists};

/// Coordinates in the order of elimination.
#[derive(Debug, Clone)]
pub(super) struct Order {
    /// The columns outside which each row of C is zero.
    pub(super) columns: Lists,
    /// What elimination in this order leaves of that.
    pub(super) fill: Fill,
    pub(super) coordinates: Vec<usize>,
    /// How many of them, the first ones, may be solved for.
    pub(super) solvable: usize,
    /// +1 for an even permutation, −1 for an odd one.
    pub(super) parity: f64,
}

impl Order {
    /// The order of the numbers of the coordinates.
    pub(super) fn new(n: usize, columns: &[Vec<usize>]) -> Self {
        let columns = Lists::from_iter(columns);
        let coordinates = Vec::from_iter(0..n);
        Self {
            fill: Fill::new(&columns, &coordinates),
            columns,
            coordinates,
            solvable: n,
            parity: 1.0,
        }
    }

    /// Changes to another order of the same rows; does not allocate if `coordinates` does not.
    pub(super) fn change(&mut self, coordinates: impl Iterator<Item = usize>, solvable: usize) {
        self.coordinates.clear();
        self.coordinates.extend(coordinates);
        self.solvable = solvable;
        self.fill.follow(&self.columns, &self.coordinates);
        let p = &self.coordinates;
        let later = |i: usize| p[i + 1..].iter().filter(move |&&x| x < p[i]).count();
        let inversions: usize = (0..p.len()).map(later).sum();
        self.parity = if inversions.is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
    }
}
