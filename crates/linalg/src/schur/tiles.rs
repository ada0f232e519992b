//! Tiles are blocks of 4 × 4 entries of fronts and factors. Lanes are groups of four rows for the
//! columns of elements. Rows are padded with zeros to whole tiles. Therefore no loop has a
//! remainder, and the data of a tile stay in registers.

/// Number of rows and columns of a tile.
pub(super) const SIDE: usize = 4;

/// One value for each of four rows.
pub(super) type Lane = [f64; SIDE];

/// Four columns of four rows.
pub(super) type Tile = [Lane; SIDE];

/// Returns the number of groups of four for n rows.
pub(super) const fn lanes(n: usize) -> usize {
    n.div_ceil(SIDE)
}

/// Returns the number of tiles of the lower triangle of a matrix with this number of row groups.
pub(super) const fn triangle(lanes: usize) -> usize {
    lanes * (lanes + 1) / 2
}

/// Returns the index of the diagonal tile of a column of tiles, in a lower triangle stored by
/// columns.
pub(super) const fn diagonal(lanes: usize, column: usize) -> usize {
    triangle(lanes) - triangle(lanes - column)
}

/// Calls `work` for a block of columns of this width: six for bodies in space, three for bodies in
/// the plane, and one for all other columns.
macro_rules! by_width {
    ($width:expr, $n:ident => $work:expr) => {
        match $width {
            6 => {
                const $n: usize = 6;
                $work
            }
            3 => {
                const $n: usize = 3;
                $work
            }
            _ => {
                const $n: usize = 1;
                $work
            }
        }
    };
}

pub(super) use by_width;

// Functions of one tile or group are never inlined. If they were inlined, the compiler would
// vectorise the loop over tiles instead of each tile, which needs more shuffles than products.

/// Computes `T ← T + X·Yᵀ`.
#[inline(never)]
pub(super) fn add_product<const N: usize>(t: &mut Tile, x: &[Lane; N], y: &[Lane; N]) {
    for j in 0..SIDE {
        let mut column = t[j];
        for n in 0..N {
            for l in 0..SIDE {
                column[l] += x[n][l] * y[n][j];
            }
        }
        t[j] = column;
    }
}

/// Computes `T ← T − X·Yᵀ`.
#[inline(never)]
pub(super) fn subtract_product(t: &mut Tile, x: &Tile, y: &Tile) {
    for j in 0..SIDE {
        let mut column = t[j];
        for n in 0..SIDE {
            for l in 0..SIDE {
                column[l] -= x[n][l] * y[n][j];
            }
        }
        t[j] = column;
    }
}

/// Computes `X·diag(s)`.
#[inline(never)]
pub(super) fn scaled<const N: usize>(y: &mut [Lane; N], x: &[Lane; N], s: &[f64; N]) {
    for n in 0..N {
        for l in 0..SIDE {
            y[n][l] = x[n][l] * s[n];
        }
    }
}

/// Computes `y ← y + X·s`.
#[inline(never)]
pub(super) fn add_times<const N: usize>(y: &mut Lane, x: &[Lane; N], s: &[f64; N]) {
    *y = sum(*y, x, s);
}

/// Computes `y ← y − X·s`.
#[inline(never)]
pub(super) fn subtract_times(y: &mut Lane, x: &Tile, s: &Lane) {
    *y = sum(*y, x, &[-s[0], -s[1], -s[2], -s[3]]);
}

/// Computes `y ← y + Xᵀ·z`.
#[inline(never)]
pub(super) fn add_transposed_times<const N: usize>(y: &mut [f64; N], x: &[Lane; N], z: &Lane) {
    for k in 0..N {
        y[k] += dot(&x[k], z);
    }
}

/// Computes `X·s` and `|X|·t`.
#[inline(never)]
pub(super) fn times_and_size<const N: usize>(
    [y, z]: &mut [Lane; 2],
    x: &[Lane; N],
    s: &[f64; N],
    t: &[f64; N],
) {
    *y = sum([0.0; SIDE], x, s);
    *z = [0.0; SIDE];
    for k in 0..N {
        for l in 0..SIDE {
            z[l] += t[k] * x[k][l].abs();
        }
    }
}

/// Computes `Σ s_k·x_k²`, element by element.
#[inline(never)]
pub(super) fn squares<const N: usize>(y: &mut Lane, x: &[Lane; N], s: &[f64; N]) {
    *y = [0.0; SIDE];
    for k in 0..N {
        for l in 0..SIDE {
            y[l] += s[k] * (x[k][l] * x[k][l]);
        }
    }
}

/// Computes `y + Σ s_k·x_k`, adding the terms one after the other.
#[inline(always)]
pub(super) fn sum<const N: usize>(mut y: Lane, x: &[Lane; N], s: &[f64; N]) -> Lane {
    for k in 0..N {
        for l in 0..SIDE {
            y[l] += s[k] * x[k][l];
        }
    }
    y
}

/// Computes `xᵀ·y`.
#[inline(always)]
pub(super) fn dot(x: &Lane, y: &Lane) -> f64 {
    (x[0] * y[0] + x[2] * y[2]) + (x[1] * y[1] + x[3] * y[3])
}

/// Returns the values of a block of columns.
#[inline(always)]
pub(super) fn of_columns<const N: usize>(columns: &[u32], v: &[f64]) -> [f64; N] {
    let mut of_block = [0.0; N];
    for (of_block, &j) in of_block.iter_mut().zip(columns) {
        *of_block = v[j as usize];
    }
    of_block
}
