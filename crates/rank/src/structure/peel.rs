//! Peeling: removes blocks on which the remaining rows are independent, together with these rows.

use std::collections::VecDeque;

use super::incidence::Incidence;
use crate::decision::independent;
use linalg::Matrix;

/// Removes rows until no block can be removed. Every row is removed at most once, so each block is
/// examined at most once more than rows are removed from it.
pub(super) fn peel(incidence: &mut Incidence, uncertainty: f64) {
    let mut rows_of: Vec<Vec<usize>> = vec![Vec::new(); incidence.blocks.len()];
    for (row, touched) in incidence.touches.iter().enumerate() {
        if incidence.active[row] {
            touched.iter().for_each(|&b| rows_of[b].push(row));
        }
    }
    let mut waiting = vec![true; incidence.blocks.len()];
    let mut queue: VecDeque<usize> = (0..incidence.blocks.len()).collect();
    while let Some(block) = queue.pop_front() {
        waiting[block] = false;
        rows_of[block].retain(|&row| incidence.active[row]);
        let (rows, columns) = (&rows_of[block], &incidence.blocks[block]);
        if rows.is_empty() || rows.len() > columns.len() {
            continue;
        }
        let own = Matrix::from_fn(rows.len(), columns.len(), |i, j| {
            incidence.c[(rows[i], columns[j])]
        });
        if !independent(&own, uncertainty) {
            continue;
        }
        for &row in rows {
            incidence.active[row] = false;
            for &other in &incidence.touches[row] {
                if !std::mem::replace(&mut waiting[other], true) {
                    queue.push_back(other);
                }
            }
        }
    }
}
