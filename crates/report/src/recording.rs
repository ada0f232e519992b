//! The output rows of a run that are stored for the report. The number of stored rows is limited,
//! so that the report is small. This module computes no values.

use model::Reaction;

/// Largest number of stored rows.
const FRAMES_MAX: usize = 1000;

/// Largest number of stored values, over all rows.
const NUMBERS_MAX: usize = 4_000_000;

/// Smallest number of stored rows for any mechanism. A run with fewer rows stores all rows.
const FRAMES_MIN: usize = 24;

/// An output row.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Time (s).
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Work of drives and applied forces since the initial time (J).
    pub work: f64,
    /// Reactions of all joints and drives; empty if no reactions are requested.
    pub reactions: Vec<Reaction>,
    /// Multipliers of all rows; empty if no other solutions for the multipliers are requested.
    pub multipliers: Vec<f64>,
    /// Multipliers of all rows, for each requested solution.
    pub chosen: Vec<Vec<f64>>,
}

impl Frame {
    /// A frame with coordinates only: all velocities are zero, and there are no reactions.
    #[must_use]
    pub fn at_rest(t: f64, q: &[f64], n_v: usize) -> Self {
        Self {
            t,
            q: q.to_vec(),
            v: vec![0.0; n_v],
            work: 0.0,
            reactions: Vec::new(),
            multipliers: Vec::new(),
            chosen: Vec::new(),
        }
    }
}

/// Rows of a run.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The stored rows, in the order of time.
    pub frames: Vec<Frame>,
    /// One row is stored for each group of this number of rows. The row at the end is also stored.
    pub stride: usize,
    seen: usize,
    t_end: f64,
}

impl Recording {
    /// Creates a recording for a run with about `rows` rows up to `t_end` and about `numbers`
    /// values in each row.
    #[must_use]
    pub fn new(t_end: f64, rows: f64, numbers: usize) -> Self {
        let affordable = NUMBERS_MAX / numbers.max(1);
        let most = affordable.clamp(FRAMES_MIN, FRAMES_MAX);
        // For extremely large numbers of rows the conversion gives the largest integer.
        let stride = (rows / most as f64).ceil().max(1.0) as usize;
        Self {
            frames: Vec::new(),
            stride,
            seen: 0,
            t_end,
        }
    }

    /// Whether the next row, at time t, is stored. The function must be called once for each row.
    pub fn wants(&mut self, t: f64) -> bool {
        let wanted = self.seen.is_multiple_of(self.stride) || t >= self.t_end;
        self.seen += 1;
        wanted
    }

    /// Number of rows passed so far.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(recording: &mut Recording, rows: usize) -> usize {
        (0..rows).filter(|k| recording.wants(*k as f64)).count()
    }

    #[test]
    fn short_runs_are_kept_whole_and_long_ones_thinned() {
        assert_eq!(kept(&mut Recording::new(200.0, 201.0, 60), 201), 201);
        // 100 001 rows at a stride of 101, and the last row.
        let mut long = Recording::new(1e5, 100_001.0, 60);
        assert_eq!((long.stride, kept(&mut long, 100_001)), (101, 992));
        // 1e5 values in a row: 40 rows.
        let mut large = Recording::new(200.0, 201.0, 100_000);
        assert_eq!((large.stride, kept(&mut large, 201)), (6, 35));
        assert_eq!(Recording::new(1.0, f64::INFINITY, 1).stride, usize::MAX);
    }
}
