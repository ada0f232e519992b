//! Which entries of L and U can be other than zero, for rows whose columns are known and an order
//! in which coordinates are solved for.
//!
//! Elimination in that order visits these entries only, and skips nothing but products with zero:
//! its results are those of visiting all. Where rows turn to other coordinates the lists say
//! nothing; then all entries are visited.

/// Lists of indices, those of list k at `start[k]..start[k + 1]`.
#[derive(Debug, Clone)]
pub(super) struct Lists {
    start: Vec<usize>,
    index: Vec<usize>,
}

impl Lists {
    fn with_capacity(lists: usize, indices: usize) -> Self {
        let mut start = Vec::with_capacity(lists + 1);
        start.push(0);
        Self {
            start,
            index: Vec::with_capacity(indices),
        }
    }

    fn clear(&mut self) {
        self.start.truncate(1);
        self.index.clear();
    }

    fn push(&mut self, list: impl Iterator<Item = usize>) {
        self.index.extend(list);
        self.start.push(self.index.len());
    }

    pub(super) fn of(&self, k: usize) -> &[usize] {
        &self.index[self.start[k]..self.start[k + 1]]
    }

    fn len(&self) -> usize {
        self.start.len() - 1
    }
}

impl<'a> FromIterator<&'a Vec<usize>> for Lists {
    fn from_iter<I: IntoIterator<Item = &'a Vec<usize>>>(lists: I) -> Self {
        let mut all = Self::with_capacity(0, 0);
        lists
            .into_iter()
            .for_each(|list| all.push(list.iter().copied()));
        all
    }
}

/// Entries of the rows of `lu`, by position.
#[derive(Debug, Clone)]
pub(super) struct Fill {
    /// Row j: the rows k < j that it is eliminated with, ascending.
    pub(super) upper: Lists,
    /// Row j: positions above j, ascending.
    pub(super) lower: Lists,
    place: Vec<usize>,
    is_there: Vec<bool>,
}

impl Fill {
    /// For rows with entries in these columns, row j solved for the coordinate `order[j]`.
    pub(super) fn new(columns: &Lists, order: &[usize]) -> Self {
        let (r, n) = (columns.len(), order.len());
        let mut fill = Self {
            upper: Lists::with_capacity(r, r * r),
            lower: Lists::with_capacity(r, r * n),
            place: vec![0; n],
            is_there: vec![false; n],
        };
        fill.follow(columns, order);
        fill
    }

    /// The same for another order; allocates nothing.
    pub(super) fn follow(&mut self, columns: &Lists, order: &[usize]) {
        let Self {
            upper,
            lower,
            place,
            is_there,
        } = self;
        upper.clear();
        lower.clear();
        for (i, &coordinate) in order.iter().enumerate() {
            place[coordinate] = i;
        }
        for j in 0..columns.len() {
            is_there.fill(false);
            for &column in columns.of(j) {
                is_there[place[column]] = true;
            }
            for k in 0..j {
                if is_there[k] {
                    lower.of(k).iter().for_each(|&i| is_there[i] = true);
                }
            }
            upper.push((0..j).filter(|&k| is_there[k]));
            lower.push((j + 1..order.len()).filter(|&i| is_there[i]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KeptRowSaddle, SaddleError};

    /// Rows of four entries in twelve columns, in an order that is kept.
    #[test]
    fn known_columns_change_no_bit() {
        const N: usize = 12;
        let columns: Vec<Vec<usize>> = (0..8)
            .map(|k| vec![k, (k + 3) % N, (2 * k + 5) % N, (3 * k + 7) % N])
            .collect();
        let mass = [
            1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0,
        ];
        let mut sparse = KeptRowSaddle::with_columns(N, &columns).unwrap();
        let mut dense = KeptRowSaddle::new(N, columns.len()).unwrap();

        for round in 0..20 {
            let mut rows = vec![[0.0; N]; columns.len()];
            for (k, columns) in columns.iter().enumerate() {
                for (l, &column) in columns.iter().enumerate() {
                    rows[k][column] = (0.02 * f64::from(round) + (5 * k + 11 * l) as f64).sin();
                }
            }
            let [found, expected] = [&mut sparse, &mut dense].map(|saddle| {
                saddle.factor(|k| &rows[k], &mass).unwrap();
                let (mut a, mut lambda) = ([0.0; N], [0.0; 8]);
                saddle.solve(&mass, &[0.5; 8], &mut a, &mut lambda).unwrap();
                let solved_for = saddle.solved_for().to_vec();
                if round == 0 {
                    saddle.keep_order();
                }
                (a, lambda, saddle.pivot_ratio(), solved_for)
            });
            assert_eq!(found, expected, "round {round}");
        }
    }

    #[test]
    fn columns_and_rows_that_there_are_not() {
        let wrong = KeptRowSaddle::with_columns(2, &[vec![0, 2]]).unwrap_err();
        let text = "row 0 has an entry in column 2, need columns below 2";
        assert_eq!(wrong.to_string(), text);
        let many = KeptRowSaddle::new(2, usize::MAX).unwrap_err();
        assert_eq!(
            many,
            SaddleError::TooManyRows {
                n: 2,
                r: usize::MAX
            }
        );
    }

    #[test]
    fn a_chain_closed_by_its_last_row_fills_what_is_between() {
        let columns = [vec![0, 1], vec![1, 2], vec![0, 3]];
        let fill = Fill::new(&columns.iter().collect(), &[0, 1, 2, 3]);
        let of = |lists: &Lists| -> Vec<Vec<usize>> {
            (0..lists.len()).map(|k| lists.of(k).to_vec()).collect()
        };
        // Row 2 takes up column 1 from row 0, and with it column 2 from row 1.
        assert_eq!(of(&fill.upper), [vec![], vec![], vec![0, 1]]);
        assert_eq!(of(&fill.lower), [vec![1], vec![2], vec![3]]);
        // Solved for its own column, the last row meets no other.
        let fill = Fill::new(&columns.iter().collect(), &[1, 2, 3, 0]);
        assert_eq!(of(&fill.upper), [vec![], vec![0], vec![]]);
        assert_eq!(of(&fill.lower), [vec![3], vec![3], vec![3]]);
    }
}
