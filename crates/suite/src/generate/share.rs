//! Selects some of many cells so that they are distributed as evenly as possible.

/// `chosen` of `all` cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    pub(super) chosen: usize,
    all: usize,
}

impl Share {
    /// Selects the number nearest to this fraction (0 to 1) of all cells.
    pub(super) fn of(all: usize, share: f64) -> Self {
        #[expect(
            clippy::cast_sign_loss,
            clippy::cast_possible_truncation,
            reason = "between 0 and `all`"
        )]
        let chosen = (share * all as f64).round() as usize;
        Self {
            chosen: chosen.min(all),
            all,
        }
    }

    /// Whether a cell is selected. For a fraction of two thirds, the sequence is yes, yes, no, yes,
    /// yes, no, …
    pub(super) fn has(self, cell: usize) -> bool {
        self.before(cell + 1) > self.before(cell)
    }

    /// Returns the number of selected cells among the first `cells` cells, rounded upwards.
    fn before(self, cells: usize) -> u128 {
        (cells as u128 * self.chosen as u128).div_ceil(self.all.max(1) as u128)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_as_asked_for_and_evenly() {
        let two_thirds = Share::of(9, 2.0 / 3.0);
        let chosen: Vec<bool> = (0..9).map(|k| two_thirds.has(k)).collect();
        assert_eq!(chosen, [true, true, false].repeat(3));
        for (all, share, expected) in [(10, 0.0, 0), (10, 1.0, 10), (7, 0.5, 4), (1, 2.0 / 3.0, 1)]
        {
            let share = Share::of(all, share);
            assert_eq!(share.chosen, expected);
            assert_eq!((0..all).filter(|&k| share.has(k)).count(), expected);
        }
    }
}
