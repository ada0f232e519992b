//! One dense front: its assembly, and the elimination of its pivots.
//!
//! A front is the lower triangle of a matrix of [tiles](super::tiles), stored by columns of tiles.
//! The values above the diagonal of a diagonal tile are finite but meaningless.

use super::structure::{InParent, RowsOfLane};
use super::tiles::{
    Lane, SIDE, Tile, add_product, by_width, diagonal, of_columns, scaled, subtract_product, sum,
};

/// Adds the remainder of a child front to these rows and columns. The remainder is a triangle with
/// this number of row groups.
pub(super) fn add_update(
    front: &mut [Tile],
    (update, of_child): (&[Tile], usize),
    at: &[InParent],
) {
    let front = front.as_flattened_mut().as_flattened_mut();
    for (k, to) in at.iter().enumerate() {
        let lane = k / SIDE;
        let from = &update[diagonal(of_child, lane)..];
        let to = &mut front[to.column as usize..];
        let mut skipped = k % SIDE;
        for (tile, rows) in from.iter().zip(at[lane * SIDE..].chunks(SIDE)) {
            let update = &tile[k % SIDE][..rows.len()];
            for l in skipped..rows.len() {
                to[rows[l].row as usize] += update[l];
            }
            skipped = 0;
        }
    }
}

/// Adds `E·diag(weight)·Eᵀ` for the columns E of a block.
pub(super) fn add_element(
    (front, lanes): (&mut [Tile], usize),
    rows: &[RowsOfLane],
    (columns, e): (&[u32], &[Lane]),
    inverse_mass: &[f64],
) {
    by_width!(columns.len(), N => {
        let weights = of_columns::<N>(columns, inverse_mass);
        add_products((front, lanes), rows, e.as_chunks::<N>().0, weights);
    });
}

/// Works like [`add_element`], for blocks of this width.
fn add_products<const N: usize>(
    (front, lanes): (&mut [Tile], usize),
    rows: &[RowsOfLane],
    e: &[[Lane; N]],
    weights: [f64; N],
) {
    for (k, (of_lane, own)) in rows.iter().zip(e).enumerate() {
        let column = of_lane.lane as usize;
        let tiles = &mut front[diagonal(lanes, column)..][..lanes - column];
        let mut weighted = [[0.0; SIDE]; N];
        scaled(&mut weighted, own, &weights);
        for (x, to) in e[k..].iter().zip(&rows[k..]) {
            add_product(&mut tiles[to.lane as usize - column], x, &weighted);
        }
    }
}

/// Eliminates the first `p` pivots of a front and writes their columns of L: `F = L·D·Lᵀ + [0, 0;
/// 0, update]`. A pivot that is at most `floor` times its size is skipped. In this case, the column
/// of L of this pivot and the inverse of the pivot are zero. Returns the smallest ratio
/// `D_k/size_k` of the other pivots.
pub(super) fn eliminate(
    (front, lanes): (&mut [Tile], usize),
    (inverse, p): (&mut [Lane], usize),
    size: &[Lane],
    floor: f64,
    l: &mut [Tile],
) -> Result<FrontElimination, usize> {
    let mut found = FrontElimination {
        smallest: f64::INFINITY,
        n_left_out: 0,
    };
    let (mut front, mut l) = (front, l);
    for (k, (inverse, size)) in inverse.iter_mut().zip(size).enumerate() {
        let (panel, later) = front.split_at_mut(lanes - k);
        let (of_l, later_l) = l.split_at_mut(lanes - k);
        *inverse = [0.0; SIDE];
        let real = SIDE.min(p - k * SIDE);
        let pivots = (&mut inverse[..real], &size[..real]);
        eliminate_panel(panel, pivots, floor, &mut found).map_err(|at| k * SIDE + at)?;
        for (l, u) in of_l.iter_mut().zip(&*panel) {
            scaled(l, u, inverse);
        }
        let mut columns = &mut *later;
        for (k, l) in of_l.iter().enumerate().skip(1) {
            let panel = &panel[k..];
            let (own, others) = columns.split_at_mut(panel.len());
            for (tile, u) in own.iter_mut().zip(panel) {
                subtract_product(tile, u, l);
            }
            columns = others;
        }
        for (n, column) in of_l[0].iter_mut().enumerate() {
            column[..=n].fill(0.0);
        }
        (front, l) = (later, later_l);
    }
    Ok(found)
}

/// Eliminates the pivots of the first tile, which is the diagonal tile, from the columns of a
/// panel.
fn eliminate_panel(
    panel: &mut [Tile],
    (inverse, size): (&mut [f64], &[f64]),
    floor: f64,
    found: &mut FrontElimination,
) -> Result<(), usize> {
    // Subtracts factor[k][j] times column k from column j.
    let mut factors = [[0.0; SIDE]; SIDE];
    let (first, below) = panel.split_at_mut(1);
    let first = &mut first[0];
    for (k, (inverse, size)) in inverse.iter_mut().zip(size).enumerate() {
        let pivot = first[k][k];
        if !pivot.is_finite() {
            return Err(k);
        }
        let share = pivot / size;
        // A row of zeros is dependent.
        if share.is_nan() || share <= floor {
            found.n_left_out += 1;
            continue;
        }
        found.smallest = found.smallest.min(share);
        *inverse = 1.0 / pivot;
        for j in k + 1..SIDE {
            factors[k][j] = -(first[k][j] * *inverse);
            first[j] = sum(first[j], &[first[k]], &[factors[k][j]]);
        }
    }
    for tile in below {
        eliminate_within(tile, &factors);
    }
    Ok(())
}

/// Eliminates the pivots of a panel from the columns of one of its tiles.
#[inline(never)]
fn eliminate_within(tile: &mut Tile, factors: &[[f64; SIDE]; SIDE]) {
    let [[_, a1, a2, a3], [_, _, b2, b3], [_, _, _, c3], _] = *factors;
    let [u0, u1, u2, u3] = *tile;
    let u1 = sum(u1, &[u0], &[a1]);
    let u2 = sum(u2, &[u0, u1], &[a2, b2]);
    let u3 = sum(u3, &[u0, u1, u2], &[a3, b3, c3]);
    *tile = [u0, u1, u2, u3];
}

/// Result of an elimination.
pub(super) struct FrontElimination {
    /// Smallest ratio of a pivot in use.
    pub(super) smallest: f64,
    pub(super) n_left_out: usize,
}
