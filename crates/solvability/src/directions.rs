//! Readable bases of directions, with as many directions as possible along one component.

use crate::limits::{SHARE_OF_PIVOT, VISIBLE};
use model::space::norm;

/// Returns a readable basis of the same space. Every component that lies in the space by itself is
/// a separate basis vector. The basis consists of reduced rows, as unit vectors whose largest entry
/// is positive. The elimination uses the first components with sufficiently large entries.
pub(crate) fn readable(mut directions: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let components = directions.first().map_or(0, Vec::len);
    for done in 0..directions.len() {
        // Returns the largest entry of a component, and the row of this entry.
        let largest = |c: usize| {
            let sizes = directions[done..]
                .iter()
                .map(|row| row[c].abs())
                .zip(done..);
            sizes.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
        };
        let all = (0..components).map(|c| largest(c).0).fold(0.0, f64::max);
        let mut pivots = (0..components).map(|c| (c, largest(c)));
        let Some((c, (_, best))) = pivots.find(|(_, (size, _))| *size >= SHARE_OF_PIVOT * all)
        else {
            break;
        };
        directions.swap(done, best);
        let pivot = directions[done].clone();
        if pivot[c] == 0.0 {
            break;
        }
        for (i, row) in directions.iter_mut().enumerate() {
            if i != done {
                let factor = row[c] / pivot[c];
                let pairs = row.iter_mut().zip(&pivot);
                pairs.for_each(|(x, p)| *x -= factor * p);
                row[c] = 0.0;
                normalise(row);
            }
        }
    }
    directions.iter_mut().for_each(|row| normalise(row));
    directions
}

fn normalise(row: &mut [f64]) {
    let larger = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
    let largest = row.iter().fold(0.0, larger);
    let size = norm(row);
    if size > 0.0 {
        for x in row {
            let shown = *x * largest.signum() / size;
            *x = if shown.abs() > VISIBLE { shown } else { 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::readable;

    /// The plane of (1, 0, 0, 0), (0, 1, 0, 0) and (0, 0, 3, 4), defined by other vectors.
    #[test]
    fn components_that_are_unique_alone_stand_alone() {
        let given = vec![
            vec![0.6, 0.8, 0.0, 0.0],
            vec![-0.8, 0.6, 0.0, 0.0],
            vec![0.48, -0.36, -0.48, -0.64],
        ];
        let found = readable(given);
        let expected = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.6, 0.8],
        ];
        for (found, expected) in found.iter().zip(expected) {
            let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-15, "{found:?}");
        }
        assert!(readable(Vec::new()).is_empty());
    }

    /// The plane of the second and the third component. Both vectors have data errors, and the
    /// elimination must not divide by these errors.
    #[test]
    fn what_the_data_miss_is_not_multiplied() {
        let found = readable(vec![
            vec![1e-7, 0.6, 0.8, 0.0],
            vec![-2e-7, 0.8, -0.6, 3e-7],
        ]);
        for (found, expected) in found
            .iter()
            .zip([[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
        {
            let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-6, "{found:?}");
        }
    }
}
