//! One dense front: its assembly, and the elimination of its pivots.
//!
//! A front of order f is stored by columns, f numbers each, of which only those from the diagonal
//! on are used.

use super::structure::NONE;
use crate::kernels::axpy;

/// Adds the remaining triangle of a child, `later` × `later` packed by columns, at these ascending
/// indices.
pub(super) fn add_update(front: &mut [f64], f: usize, update: &[f64], at: &[u32]) {
    let mut from = 0;
    for (k, &j) in at.iter().enumerate() {
        let column = &mut front[j as usize * f..][..f];
        let own = &at[k..];
        for (u, &i) in update[from..from + own.len()].iter().zip(own) {
            column[i as usize] += u;
        }
        from += own.len();
    }
}

/// Adds `E·diag(weight)·Eᵀ` for a block: its rows at these ascending indices, and for each row and
/// column the place of the entry in `values`.
pub(super) fn add_element(
    front: &mut [f64],
    f: usize,
    at: &[u32],
    (entries, values): (&[u32], &[f64]),
    weight: impl Fn(usize) -> f64,
    scratch: &mut [f64],
) {
    let width = entries.len() / at.len().max(1);
    for (x, &entry) in scratch.iter_mut().zip(entries) {
        *x = if entry == NONE {
            0.0
        } else {
            values[entry as usize]
        };
    }
    let e = &scratch[..entries.len()];
    match width {
        // Bodies in the plane and in space.
        3 => add_products::<3>(front, f, at, e, std::array::from_fn(weight)),
        6 => add_products::<6>(front, f, at, e, std::array::from_fn(weight)),
        _ => {
            for (k, &j) in at.iter().enumerate() {
                let column = &mut front[j as usize * f..][..f];
                let own = &e[k * width..];
                for (l, &i) in at[k..].iter().enumerate() {
                    let product = |c: usize| own[l * width + c] * weight(c) * own[c];
                    column[i as usize] += (0..width).map(product).sum::<f64>();
                }
            }
        }
    }
}

/// As [`add_element`], for rows `e` of this width.
fn add_products<const WIDTH: usize>(
    front: &mut [f64],
    f: usize,
    at: &[u32],
    e: &[f64],
    weight: [f64; WIDTH],
) {
    let rows = e.as_chunks::<WIDTH>().0;
    for (k, (&j, own)) in at.iter().zip(rows).enumerate() {
        let column = &mut front[j as usize * f..][..f];
        let w: [f64; WIDTH] = std::array::from_fn(|c| own[c] * weight[c]);
        for (x, &i) in rows[k..].iter().zip(&at[k..]) {
            let mut sum = x[0] * w[0];
            for c in 1..WIDTH {
                sum += x[c] * w[c];
            }
            column[i as usize] += sum;
        }
    }
}

/// Eliminates the first pivots, as many as `inverse` has entries: `F = L·D·Lᵀ + [0, 0; 0, update]`.
/// Skips pivots that are at most `least[k]`: their column of L and their inverse are zero. Returns
/// the smallest ratio `D_k/size_k` of the others.
pub(super) fn eliminate(
    front: &mut [f64],
    f: usize,
    inverse: &mut [f64],
    size: &[f64],
    floor: f64,
) -> Result<Eliminated, usize> {
    let mut found = Eliminated {
        smallest: f64::INFINITY,
        n_left_out: 0,
    };
    for (k, (inverse, &size)) in inverse.iter_mut().zip(size).enumerate() {
        let (head, tail) = front.split_at_mut((k + 1) * f);
        let column = &mut head[k * f + k..];
        let pivot = column[0];
        if !pivot.is_finite() {
            return Err(k);
        }
        let share = pivot / size;
        // A row of zeros is dependent.
        if share.is_nan() || share <= floor {
            *inverse = 0.0;
            column.fill(0.0);
            found.n_left_out += 1;
            continue;
        }
        found.smallest = found.smallest.min(share);
        *inverse = 1.0 / pivot;
        let column = &mut column[1..];
        for (j, target) in tail.chunks_exact_mut(f).enumerate() {
            let factor = column[j] * *inverse;
            if factor != 0.0 {
                axpy(-factor, &column[j..], &mut target[k + 1 + j..]);
            }
        }
        column.iter_mut().for_each(|x| *x *= *inverse);
    }
    Ok(found)
}

/// Result of an elimination.
pub(super) struct Eliminated {
    /// Smallest ratio of a pivot that was used.
    pub(super) smallest: f64,
    pub(super) n_left_out: usize,
}
