//! The solutions y_m of a block and their weights.

use std::collections::BTreeMap;

/// The loads of a monomial with their exponents, in ascending order.
pub(super) type Monomial = Vec<(usize, u32)>;

/// A solution y_m of a block.
pub(super) struct HullPoint {
    pub(super) monomial: Monomial,
    /// Sum of the squared determinants of the sets in the monomial.
    pub(super) weight: f64,
    pub(super) y: Vec<f64>,
}

/// Sums of weighted solutions for each monomial.
#[derive(Default)]
pub(super) struct Sums(BTreeMap<Monomial, (f64, Vec<f64>)>);

impl Sums {
    pub(super) fn add(&mut self, monomial: Monomial, weight: f64, y: Vec<f64>) {
        let new = || (0.0, vec![0.0; y.len()]);
        let (total, sum) = self.0.entry(monomial).or_insert_with(new);
        *total += weight;
        for (sum, y) in sum.iter_mut().zip(&y) {
            *sum += weight * y;
        }
    }

    pub(super) fn points(self) -> Vec<HullPoint> {
        let all = self.0.into_iter();
        let all = all.map(|(monomial, (weight, sum))| HullPoint {
            monomial,
            weight,
            y: sum.iter().map(|x| x / weight).collect(),
        });
        all.collect()
    }
}

/// Returns the monomial of these loads.
pub(super) fn monomial(groups: impl Iterator<Item = usize>) -> Monomial {
    let mut all: Vec<usize> = groups.collect();
    all.sort_unstable();
    let same = all.chunk_by(|a, b| a == b);
    same.map(|same| (same[0], same.len() as u32)).collect()
}
