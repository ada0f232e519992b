//! Counts admissible deletions, component by component. The method is deletion and contraction on
//! classes of rows that can replace each other.

use super::{DeletionError, duals};
use crate::RankDecision;
use crate::dual::{Dual, Noise, Unclear, rank};
use crate::limits::COUNT_STEPS;

/// Returns the number of admissible sets of p rows. The number is a product over all components
/// (coupled rows).
///
/// The number of sets in a component is computed exactly: `b = w·b(contracted) + b(deleted)` for a
/// class of w parallel vectors. Closed forms are used for redundancy 1 (the number of rows) and 2
/// (pairs of rows of different classes).
///
/// # Errors
/// - [`DeletionError::Rank`]: the rank is undecided.
/// - [`DeletionError::Unclear`]: it is undecided whether some set is admissible.
/// - [`DeletionError::TooMany`]: a component is too large, or the number exceeds 128 bits.
pub fn count_deletions(decision: &RankDecision) -> Result<u128, DeletionError> {
    let mut product = 1_u128;
    for dual in duals(decision)? {
        let redundancy = dual.dimension();
        let mut steps = COUNT_STEPS;
        product = count(weighted(&dual), dual.noise, redundancy, &mut steps)?
            .and_then(|n| product.checked_mul(n))
            .ok_or(DeletionError::TooMany { redundancy })?;
    }
    Ok(product)
}

/// A class of rows with parallel vectors.
#[derive(Clone)]
struct Class {
    vector: Vec<f64>,
    weight: u128,
}

fn weighted(dual: &Dual) -> Vec<Class> {
    let class = |vector: &Vec<f64>| Class {
        vector: vector.clone(),
        weight: 1,
    };
    dual.vectors.iter().map(class).collect()
}

/// Returns the sum over all bases of the product of weights. Returns `None` if the limit of steps
/// is reached or 128 bits are not sufficient.
fn count(
    classes: Vec<Class>,
    noise: Noise,
    p: usize,
    steps: &mut usize,
) -> Result<Option<u128>, Unclear> {
    if p == 0 {
        return Ok(Some(1));
    }
    if *steps == 0 {
        return Ok(None);
    }
    *steps -= 1;
    let mut classes = merged(classes, noise)?;
    if p <= 2 {
        return Ok(pairs_or_singles(&classes, p));
    }
    let vectors = |classes: &[Class]| classes.iter().map(|c| c.vector.clone()).collect();
    if rank(vectors(&classes), noise)? < p {
        return Ok(Some(0));
    }
    // The vector with the largest coordinate is used for the elimination. The multipliers of the
    // contraction are therefore at most one, and the noise does not grow.
    let size = |c: &Class| linalg::kernels::max_abs(&c.vector);
    let Some(at) =
        (0..classes.len()).max_by(|&a, &b| size(&classes[a]).total_cmp(&size(&classes[b])))
    else {
        return Ok(Some(0));
    };
    let taken = classes.swap_remove(at);
    let with = count(
        contracted(&classes, &taken.vector),
        noise.times(2.0),
        p - 1,
        steps,
    )?;
    let without = count(classes, noise, p, steps)?;
    Ok(with
        .and_then(|n| n.checked_mul(taken.weight))
        .zip(without)
        .and_then(|(a, b)| a.checked_add(b)))
}

/// Merges classes with parallel vectors and removes zero vectors.
fn merged(classes: Vec<Class>, noise: Noise) -> Result<Vec<Class>, Unclear> {
    let mut distinct: Vec<Class> = Vec::new();
    'classes: for class in classes {
        if rank(vec![class.vector.clone()], noise)? == 0 {
            continue;
        }
        for other in &mut distinct {
            if rank(vec![other.vector.clone(), class.vector.clone()], noise)? == 1 {
                other.weight += class.weight;
                continue 'classes;
            }
        }
        distinct.push(class);
    }
    Ok(distinct)
}

/// Returns Σ w for p = 1, and Σ w_a·w_b over pairs for p = 2. Different classes must be
/// independent.
fn pairs_or_singles(classes: &[Class], p: usize) -> Option<u128> {
    let (mut singles, mut pairs) = (0_u128, 0_u128);
    for class in classes {
        pairs = pairs.checked_add(singles.checked_mul(class.weight)?)?;
        singles = singles.checked_add(class.weight)?;
    }
    Some(if p == 1 { singles } else { pairs })
}

/// Returns the vectors modulo `taken`. The largest coordinate of `taken` is eliminated and removed.
fn contracted(classes: &[Class], taken: &[f64]) -> Vec<Class> {
    let largest = |a: usize, b: usize| {
        if taken[b].abs() > taken[a].abs() {
            b
        } else {
            a
        }
    };
    let pivot = (0..taken.len()).fold(0, largest);
    let project = |class: &Class| {
        let factor = class.vector[pivot] / taken[pivot];
        let coordinates = (0..taken.len()).filter(|&c| c != pivot);
        Class {
            vector: coordinates
                .map(|c| class.vector[c] - factor * taken[c])
                .collect(),
            weight: class.weight,
        }
    };
    classes.iter().map(project).collect()
}
