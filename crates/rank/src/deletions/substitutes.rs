//! Smallest deletions that make given combinations of multipliers unique.

use super::{DeletionError, require_rank};
use crate::dual::{Dual, Noise, Unclear, binomial, rank, subsets};
use crate::null_space::Support;
use crate::{RankDecision, components};
use linalg::{Matrix, kernels};

/// Limits of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Largest number of sets that are listed.
    pub sets: usize,
    /// Largest number of sets that are tried.
    pub trials: usize,
}

impl Default for Limits {
    /// Returns the default limits: a thousand sets, a hundred thousand trials.
    fn default() -> Self {
        Self {
            sets: 1_000,
            trials: 100_000,
        }
    }
}

/// Smallest sets of candidates whose deletion makes a target unique.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Substitutes {
    /// The sets. Each set lists the indices of candidates, ascending. All sets have the same,
    /// smallest number of candidates. The result is one empty set if the target is already unique,
    /// and no set if no deletion of candidates makes it unique.
    pub sets: Vec<Vec<usize>>,
    /// Whether all sets of the smallest size are listed. If not, a limit was reached.
    pub complete: bool,
}

/// Returns the smallest sets of candidates whose deletion does not change the motion and makes all
/// combinations `ℓᵀ·λ`, the rows of `target`, unique.
///
/// | argument | shape | meaning |
/// | --- | --- | --- |
/// | `target` | k×m | combinations of the multipliers of C as given: a unit row for one multiplier, `C_Xᵀ` for the reaction of a group X |
/// | `candidates` | – | rows that are deleted together; candidates that share a row with the target, or cannot be deleted, are skipped |
/// | `admits` | – | called with all rows of a set, ascending; `false` rejects the set. If a set is rejected, all larger sets that contain it should be rejected as well |
///
/// A set D is a solution iff its rows of Z are independent and span the rows `ℓᵀ·Z`. The sets have
/// the smallest possible size, so no proper subset of a set is sufficient.
///
/// ```
/// use linalg::Matrix;
/// use pfaff_rank::{Limits, decide, making_unique};
/// // Three times the same row, and an independent one: to make λ₀ unique, delete both others.
/// let c = Matrix::from_rows(&[[1.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0]]);
/// let decision = decide(&c, pfaff_rank::Accuracy::Rounding)?;
/// let target = Matrix::from_rows(&[[1.0, 0.0, 0.0, 0.0]]);
/// let rows = [vec![0], vec![1], vec![2], vec![3]];
/// let found = making_unique(&decision, &target, &rows, |_| true, Limits::default()).unwrap();
/// assert_eq!(found.sets, [[1, 2]]);
/// # Ok::<(), pfaff_rank::RankError>(())
/// ```
///
/// # Errors
/// - [`DeletionError::Rank`]: the rank is undecided.
/// - [`DeletionError::Unclear`]: a test is undecided.
/// - [`DeletionError::TargetShape`], [`DeletionError::NonFinite`],
///   [`DeletionError::RowOutOfRange`]: malformed input.
pub fn making_unique(
    decision: &RankDecision,
    target: &Matrix,
    candidates: &[Vec<usize>],
    admits: impl Fn(&[usize]) -> bool,
    limits: Limits,
) -> Result<Substitutes, DeletionError> {
    require_rank(decision)?;
    check(decision, target, candidates)?;
    let dual = whole(decision);
    let directions = Directions::new(decision, target, &dual);
    let wanted = rank(directions.vectors.clone(), directions.noise)?;
    if wanted == 0 {
        return Ok(Substitutes {
            sets: vec![Vec::new()],
            complete: true,
        });
    }
    let units = units(decision, target, candidates, &dual)?;
    let classes = replaceable(&units, &dual)?;
    let mut trials = limits.trials;
    for size in 1..=dual.dimension().min(classes.len()) {
        let mut found = Substitutes {
            sets: Vec::new(),
            complete: binomial(classes.len(), size).is_some_and(|n| n <= trials),
        };
        for chosen in subsets(classes.len(), size).take(trials) {
            let places: Vec<usize> = chosen
                .iter()
                .flat_map(|&k| units[classes[k][0]].places.iter().copied())
                .collect();
            if places.len() < wanted || !suffices(&places, &dual, &directions)? {
                continue;
            }
            for (count, set) in products(&chosen, &classes).enumerate() {
                if found.sets.len() == limits.sets || count == limits.trials {
                    found.complete = false;
                    break;
                }
                let mut set: Vec<usize> = set.iter().map(|&u| units[u].candidate).collect();
                set.sort_unstable();
                let mut rows: Vec<usize> = set
                    .iter()
                    .flat_map(|&k| candidates[k].iter().copied())
                    .collect();
                rows.sort_unstable();
                rows.dedup();
                if admits(&rows) {
                    found.sets.push(set);
                }
            }
        }
        if !found.sets.is_empty() || !found.complete {
            found.sets.sort();
            return Ok(found);
        }
        trials -= binomial(classes.len(), size).unwrap_or(trials).min(trials);
    }
    Ok(Substitutes {
        sets: Vec::new(),
        complete: true,
    })
}

fn check(
    decision: &RankDecision,
    target: &Matrix,
    candidates: &[Vec<usize>],
) -> Result<(), DeletionError> {
    let rows = decision.rank + decision.redundancy;
    if target.ncols() != rows {
        let found = target.ncols();
        return Err(DeletionError::TargetShape { found, rows });
    }
    if let Some((combination, row, value)) = target.first_non_finite() {
        return Err(DeletionError::NonFinite {
            combination,
            row,
            value,
        });
    }
    match candidates.iter().flatten().find(|&&row| row >= rows) {
        Some(&row) => Err(DeletionError::RowOutOfRange { row, rows }),
        None => Ok(()),
    }
}

/// Returns the dual of all rows that belong to a dependency, with all p coordinates.
fn whole(decision: &RankDecision) -> Dual {
    let mut rows = components(decision).coupled.concat();
    rows.sort_unstable();
    Dual::new(decision, &Support::new(decision), &rows)
}

/// The rows `ℓᵀ·Z̃` of a target, relative to the longest ℓ.
struct Directions {
    vectors: Vec<Vec<f64>>,
    noise: Noise,
}

impl Directions {
    fn new(decision: &RankDecision, target: &Matrix, dual: &Dual) -> Self {
        let m = target.ncols();
        // λ_i of the given C is D_r,i times λ_i of the equilibrated rows.
        let scaled = Matrix::from_fn(target.nrows(), m, |k, i| {
            target[(k, i)] * decision.scaling.row_factor(i)
        });
        let longest = (0..scaled.nrows())
            .map(|k| kernels::norm(scaled.row(k)))
            .fold(0.0, f64::max);
        let unit = if longest > 0.0 { longest } else { 1.0 };
        let direction = |k: usize| {
            let mut sum = vec![0.0; dual.dimension()];
            for (&row, vector) in dual.rows.iter().zip(&dual.vectors) {
                kernels::axpy(scaled[(k, row)] / unit, vector, &mut sum);
            }
            sum
        };
        Self {
            vectors: (0..scaled.nrows()).map(direction).collect(),
            // A sum of m terms with unit norm adds the noise of each term.
            noise: dual.noise.times((m as f64).sqrt()),
        }
    }
}

/// A candidate that can be deleted, as indices into the dual.
struct Unit {
    candidate: usize,
    places: Vec<usize>,
}

/// Returns the candidates in the components that the target involves. Candidates that share a row
/// with the target or cannot be deleted are omitted.
fn units(
    decision: &RankDecision,
    target: &Matrix,
    candidates: &[Vec<usize>],
    dual: &Dual,
) -> Result<Vec<Unit>, Unclear> {
    let in_target = |row: usize| (0..target.nrows()).any(|k| target[(k, row)] != 0.0);
    let touched: Vec<usize> = components(decision)
        .coupled
        .into_iter()
        .filter(|rows| rows.iter().any(|&row| in_target(row)))
        .flatten()
        .collect();
    let mut units = Vec::new();
    for (candidate, rows) in candidates.iter().enumerate() {
        if rows.iter().any(|&row| in_target(row)) || !rows.iter().any(|row| touched.contains(row)) {
            continue;
        }
        let mut rows = rows.clone();
        rows.sort_unstable();
        rows.dedup();
        let places: Option<Vec<usize>> = rows
            .iter()
            .map(|row| dual.rows.binary_search(row).ok())
            .collect();
        if let Some(places) = places
            && !places.is_empty()
            && dual.rank(&places)? == places.len()
        {
            units.push(Unit { candidate, places });
        }
    }
    Ok(units)
}

/// Groups units that can replace each other. Such units consist of one row each with parallel
/// vectors. Every other unit forms a separate class.
fn replaceable(units: &[Unit], dual: &Dual) -> Result<Vec<Vec<usize>>, Unclear> {
    let mut classes: Vec<Vec<usize>> = Vec::new();
    'units: for (u, unit) in units.iter().enumerate() {
        if let [place] = unit.places[..] {
            for class in &mut classes {
                if let [other] = units[class[0]].places[..]
                    && dual.rank(&[other, place])? == 1
                {
                    class.push(u);
                    continue 'units;
                }
            }
        }
        classes.push(vec![u]);
    }
    Ok(classes)
}

/// Returns whether the deletion of these rows keeps the motion unchanged and makes the directions
/// unique.
fn suffices(places: &[usize], dual: &Dual, directions: &Directions) -> Result<bool, Unclear> {
    if dual.rank(places)? < places.len() {
        return Ok(false);
    }
    let mut vectors: Vec<Vec<f64>> = places.iter().map(|&k| dual.vectors[k].clone()).collect();
    vectors.extend(directions.vectors.iter().cloned());
    Ok(rank(vectors, directions.noise)? == places.len())
}

/// Returns all combinations with one unit of each chosen class, counted like the digits of a
/// number.
fn products(chosen: &[usize], classes: &[Vec<usize>]) -> impl Iterator<Item = Vec<usize>> {
    let digits: Vec<&[usize]> = chosen.iter().map(|&k| classes[k].as_slice()).collect();
    let total = digits
        .iter()
        .fold(1_usize, |n, d| n.saturating_mul(d.len()));
    (0..total).map(move |mut number| {
        digits
            .iter()
            .map(|d| {
                let unit = d[number % d.len()];
                number /= d.len();
                unit
            })
            .collect()
    })
}
