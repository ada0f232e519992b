//! The rows of a left null space basis as vectors: the dual of the row matroid.
//!
//! Row i of Z̃ (m×p, of the equilibrated rows) is the vector of constraint i. A set D of
//! constraints may be deleted without a change of motion iff its vectors are independent. Rows with
//! parallel vectors can replace each other. If `Z̃·y` vanishes on a hyperplane of the dual, the
//! other rows form a circuit.
//!
//! Every test is a rank of a few vectors, computed by elimination with complete pivoting. The
//! multipliers of the elimination are at most one. Therefore the noise of all entries remains the
//! noise of the decision. An entry between "zero" and "certainly not zero" is reported as an error.

use crate::decision::{CoefficientReading, Readings, Size, size};
use crate::null_space::Support;
use crate::{RankDecision, support_tolerance};

/// A rank depends on a value between "zero" and "certainly not zero".
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unclear {
    pub(crate) value: f64,
    pub(crate) noise: f64,
}

/// The accuracy of values, and the rule by which values count as nonzero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Noise {
    pub(crate) value: f64,
    /// The rules of a stated tolerance, which are also used for verdicts on reactions; `None` if
    /// only rounding is considered.
    stated: Option<Readings>,
}

impl Noise {
    fn of(decision: &RankDecision) -> Self {
        Self {
            value: support_tolerance(decision),
            stated: decision.has_tolerance().then(|| decision.readings()),
        }
    }

    /// Returns the noise of values with `factor` times the uncertainty.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            ..self
        }
    }

    pub(crate) fn size(self, x: f64) -> Size {
        match self.stated.map(|rules| rules.read(x.abs(), self.value)) {
            None => size(x, self.value),
            Some(CoefficientReading::Zero) => Size::Zero,
            Some(CoefficientReading::NonZero) => Size::NonZero,
            Some(CoefficientReading::Unclear { .. }) => Size::Unclear,
        }
    }
}

/// Rows of Z̃, restricted to the rows and coordinates of a set of components.
#[derive(Debug, Clone)]
pub(crate) struct Dual {
    /// The constraints, ascending.
    pub(crate) rows: Vec<usize>,
    /// Vectors of the rows, in the same order.
    pub(crate) vectors: Vec<Vec<f64>>,
    /// Noise of the entries. The largest entry is about one.
    pub(crate) noise: Noise,
}

impl Dual {
    /// Creates the vectors of `rows` (ascending). The coordinates of the vectors belong to the
    /// dropped rows in `rows`, so `rows` must be a union of components.
    pub(crate) fn new(decision: &RankDecision, support: &Support, rows: &[usize]) -> Self {
        let inside = |row: &usize| rows.binary_search(row).is_ok();
        let coordinates: Vec<usize> = (0..decision.redundancy)
            .filter(|&j| inside(&decision.dropped[j]))
            .collect();
        // Coordinates are scaled by their largest coefficient. This scaling is a change of basis
        // that makes their noise equal.
        let unit = |j: usize| support.t.row(j).iter().fold(1.0_f64, |a, b| a.max(b.abs()));
        let vector = |row: usize| -> Vec<f64> {
            let of = |j: usize| match decision.kept.binary_search(&row) {
                Ok(i) if support.contains(j, i) => -support.t[(j, i)] / unit(j),
                Err(_) if decision.dropped[j] == row => unit(j).recip(),
                _ => 0.0,
            };
            coordinates.iter().map(|&j| of(j)).collect()
        };
        Self {
            rows: rows.to_vec(),
            vectors: rows.iter().map(|&row| vector(row)).collect(),
            noise: Noise::of(decision),
        }
    }

    /// Returns the number of coordinates, which is the rank of all vectors together.
    pub(crate) fn dimension(&self) -> usize {
        self.vectors.first().map_or(0, Vec::len)
    }

    /// Returns the rank of the vectors with these indices.
    pub(crate) fn rank(&self, places: &[usize]) -> Result<usize, Unclear> {
        let vectors = places.iter().map(|&k| self.vectors[k].clone()).collect();
        rank(vectors, self.noise)
    }

    /// Returns indices grouped by direction; zero vectors are omitted.
    pub(crate) fn parallel_classes(&self) -> Result<Vec<Vec<usize>>, Unclear> {
        let mut classes: Vec<Vec<usize>> = Vec::new();
        'places: for k in 0..self.rows.len() {
            if self.rank(&[k])? == 0 {
                continue;
            }
            for class in &mut classes {
                if self.rank(&[class[0], k])? == 1 {
                    class.push(k);
                    continue 'places;
                }
            }
            classes.push(vec![k]);
        }
        Ok(classes)
    }
}

/// Returns the rank of vectors whose entries have the given noise.
pub(crate) fn rank(vectors: Vec<Vec<f64>>, noise: Noise) -> Result<usize, Unclear> {
    Ok(eliminate(vectors, noise)?.pivots.len())
}

/// Vectors after elimination: the pivot rows first, upper trapezoidal in the order of the pivots.
pub(crate) struct EchelonForm {
    pub(crate) vectors: Vec<Vec<f64>>,
    /// Coordinate of each pivot.
    pub(crate) pivots: Vec<usize>,
    /// Absolute value of the last pivot; infinite if there is no pivot.
    pub(crate) smallest: f64,
}

/// Performs Gaussian elimination with complete pivoting.
pub(crate) fn eliminate(mut vectors: Vec<Vec<f64>>, noise: Noise) -> Result<EchelonForm, Unclear> {
    let mut pivots = Vec::new();
    let mut smallest = f64::INFINITY;
    let dimension = vectors.first().map_or(0, Vec::len);
    for step in 0..vectors.len().min(dimension) {
        let (mut at, mut value) = ((step, 0), 0.0_f64);
        for (k, vector) in vectors.iter().enumerate().skip(step) {
            for (c, z) in vector.iter().enumerate() {
                if z.abs() > value {
                    (at, value) = ((k, c), z.abs());
                }
            }
        }
        let noise = noise.times((step + 1) as f64);
        match noise.size(value) {
            Size::Zero => break,
            Size::Unclear => {
                let noise = noise.value;
                return Err(Unclear { value, noise });
            }
            Size::NonZero => {}
        }
        vectors.swap(step, at.0);
        let (done, rest) = vectors.split_at_mut(step + 1);
        let pivot = &done[step];
        for vector in rest {
            let factor = vector[at.1] / pivot[at.1];
            for (v, p) in vector.iter_mut().zip(pivot) {
                *v -= factor * p;
            }
            vector[at.1] = 0.0;
        }
        pivots.push(at.1);
        smallest = value;
    }
    Ok(EchelonForm {
        vectors,
        pivots,
        smallest,
    })
}

/// Returns all subsets of `0..n` with k elements, in lexicographic order.
pub(crate) fn subsets(n: usize, k: usize) -> impl Iterator<Item = Vec<usize>> {
    let mut next = (k <= n).then(|| (0..k).collect::<Vec<_>>());
    std::iter::from_fn(move || {
        let current = next.take()?;
        if let Some(at) = (0..k).rfind(|&at| current[at] < n - k + at) {
            let mut following = current.clone();
            following[at] += 1;
            for later in at + 1..k {
                following[later] = following[later - 1] + 1;
            }
            next = Some(following);
        }
        Some(current)
    })
}

/// Returns the number of subsets of `0..n` with k elements, `None` above the largest `usize`.
pub(crate) fn binomial(n: usize, k: usize) -> Option<usize> {
    if k > n {
        return Some(0);
    }
    (0..k.min(n - k)).try_fold(1_usize, |b, i| Some(b.checked_mul(n - i)? / (i + 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subsets_are_as_many_as_binomials() {
        for n in 0..7 {
            for k in 0..8 {
                assert_eq!(Some(subsets(n, k).count()), binomial(n, k), "{n} over {k}");
            }
        }
        assert_eq!(
            subsets(3, 2).collect::<Vec<_>>(),
            [vec![0, 1], vec![0, 2], vec![1, 2]]
        );
        assert_eq!(binomial(400, 200), None);
    }

    #[test]
    fn a_pivot_in_the_noise_is_an_error_only_where_it_decides() {
        let vectors = |x: f64| vec![vec![1.0, 1.0], vec![1.0, 1.0 + x]];
        let noise = Noise {
            value: 1e-12,
            stated: None,
        };
        assert_eq!(rank(vectors(1e-13), noise).ok(), Some(1));
        assert_eq!(rank(vectors(1e-6), noise).ok(), Some(2));
        assert!(rank(vectors(1e-10), noise).is_err());
    }

    /// If the data are accurate to a thousandth of the size, they are accurate enough to
    /// distinguish a coefficient of one from zero.
    #[test]
    fn within_a_tolerance_a_pivot_clears_what_the_data_move_it_by() {
        let rules = Readings {
            is_certified: true,
            has_tolerance: true,
            smallest: f64::INFINITY,
        };
        let noise = Noise {
            value: 5e-3,
            stated: Some(rules),
        };
        let vectors = |x: f64| vec![vec![1.0, 1.0], vec![1.0, 1.0 + x]];
        assert_eq!(rank(vectors(1e-4), noise).ok(), Some(1));
        assert_eq!(rank(vectors(0.5), noise).ok(), Some(2));
        assert!(rank(vectors(0.02), noise).is_err());
    }
}
