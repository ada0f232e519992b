//! Axes of the loads. These axes do not depend on the axes of the scene.

use linalg::kernels::{dot, norm};
use linalg::{Matrix, PivotedQr, symmetric_eigen};

use super::element::{Element, HullError, Zero};
use crate::limits::EQUAL_LEVERAGE;

/// Returns orthonormal directions that span the rows of the elements.
pub(super) fn span_of(elements: &[Element], p: usize, zero: Zero) -> Vec<Vec<f64>> {
    let size = |e: &Element| norm(&e.row).max(f64::MIN_POSITIVE);
    let rows = Matrix::from_fn(p, elements.len(), |i, j| {
        elements[j].row[i] / size(&elements[j])
    });
    let qr = PivotedQr::of_columns(&rows);
    let rank = qr.r_diagonal().filter(|r| r.abs() > zero.zero).count();
    let direction = |k: usize| {
        let mut unit = vec![0.0; p];
        unit[k] = 1.0;
        qr.q_mul(&mut unit);
        unit
    };
    (0..rank).map(direction).collect()
}

/// Rotates the components of each load to the principal axes of its leverage `A_X·(Σ AᵀA)⁻¹·A_Xᵀ`.
/// These axes do not depend on the axes of the scene. Each load is scaled to size one. Components
/// that do not depend on y are left out. The function also returns the sizes.
pub(super) fn principal(
    elements: &[Element],
    p: usize,
    zero: Zero,
) -> Result<(Vec<Element>, Vec<f64>), HullError> {
    let groups = elements.chunk_by(|a, b| a.group == b.group);
    let size = |group: &[Element]| {
        let squares = group.iter().map(|e| dot(&e.row, &e.row));
        squares.sum::<f64>().sqrt()
    };
    let sizes: Vec<f64> = groups.clone().map(size).collect();
    let scaled = groups.zip(&sizes).map(|(group, &size)| {
        let scale = |e: &Element| Element {
            row: e.row.iter().map(|x| x / size).collect(),
            value: e.value / size,
            ..*e
        };
        group.iter().map(scale).collect::<Vec<_>>()
    });
    let scaled: Vec<Vec<Element>> = scaled.collect();
    let all: Vec<&Element> = scaled.iter().flatten().collect();
    let matrix = Matrix::from_fn(all.len(), p, |i, j| all[i].row[j]);
    let qr = PivotedQr::of_columns(&matrix);
    let rank = qr.r_diagonal().filter(|r| r.abs() > zero.zero).count();
    if rank < p {
        return Err(HullError::Free { free: p - rank });
    }
    let mut out = Vec::new();
    for group in &scaled {
        // The products of R⁻ᵀ·Aᵀ are the leverage.
        let mapped = group.iter().map(|e| {
            let mut x: Vec<f64> = qr.permutation().iter().map(|&k| e.row[k]).collect();
            qr.solve_r_transpose(&mut x);
            x
        });
        let mapped: Vec<Vec<f64>> = mapped.collect();
        let n = group.len();
        let leverage = Matrix::from_fn(n, n, |i, j| dot(&mapped[i], &mapped[j]));
        for axis in axes_of(&leverage) {
            let sum = |of: &dyn Fn(&Element) -> f64| -> f64 {
                axis.iter().zip(group).map(|(a, e)| a * of(e)).sum()
            };
            let row: Vec<f64> = (0..p).map(|j| sum(&|e| e.row[j])).collect();
            let own = group[0].group;
            if !zero.holds(norm(&row), own)? {
                let value = sum(&|e| e.value);
                out.push(Element {
                    group: own,
                    row,
                    value,
                });
            }
        }
    }
    Ok((out, sizes))
}

/// Returns orthonormal eigenvectors. For equal eigenvalues, the eigenvectors are along the given
/// axes.
fn axes_of(leverage: &Matrix) -> Vec<Vec<f64>> {
    let n = leverage.nrows();
    let eigen = symmetric_eigen(leverage);
    let values = &eigen.values;
    let vector = |k: usize| -> Vec<f64> { (0..n).map(|i| eigen.vectors[(i, k)]).collect() };
    let mut axes: Vec<Vec<f64>> = Vec::new();
    let mut from = 0;
    while from < n {
        let equal = |k: &usize| (values[*k] - values[from]).abs() <= EQUAL_LEVERAGE;
        let to = from + (from..n).take_while(equal).count();
        let space: Vec<Vec<f64>> = (from..to).map(vector).collect();
        // Projections of the given axes on the eigenspace, the longest projections first.
        let project = |i: usize| -> Vec<f64> {
            let parts = space.iter().map(|v| v.iter().map(|x| x * v[i]));
            parts.fold(vec![0.0; n], |mut sum, part| {
                sum.iter_mut().zip(part).for_each(|(s, x)| *s += x);
                sum
            })
        };
        let mut candidates: Vec<Vec<f64>> = (0..n).map(project).collect();
        candidates.sort_by(|a, b| norm(b).total_cmp(&norm(a)));
        let known = axes.len();
        for mut candidate in candidates {
            if axes.len() - known == space.len() {
                break;
            }
            for axis in &axes[known..] {
                let along = dot(axis, &candidate);
                candidate
                    .iter_mut()
                    .zip(axis)
                    .for_each(|(x, a)| *x -= along * a);
            }
            let size = norm(&candidate);
            if size > EQUAL_LEVERAGE.sqrt() {
                axes.push(candidate.iter().map(|x| x / size).collect());
            }
        }
        from = to;
    }
    axes
}
