//! Piecewise linear functions through the points of a table. If two points have the same time, the
//! value jumps.

/// Points in the order of time. A time may occur twice, except at the ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lines {
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Lines {
    /// Returns whether all values are the same.
    pub(super) fn is_constant(&self) -> bool {
        self.values.windows(2).all(|pair| pair[0] == pair[1])
    }

    /// Returns a function through at least two points with different times.
    pub(super) fn new(times: &[f64], values: &[f64]) -> Self {
        Self {
            times: times.to_vec(),
            values: values.to_vec(),
        }
    }

    pub(super) fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the times and values of the points.
    pub(super) fn points(&self) -> (&[f64], &[f64]) {
        (&self.times, &self.values)
    }

    /// Returns the value and the derivatives at t. At a point, the values are those of the line
    /// that starts at the point.
    pub(super) fn jet(&self, t: f64) -> [f64; 3] {
        let (x, y) = (&self.times, &self.values);
        let behind = x.partition_point(|&x| x <= t);
        let k = behind.clamp(1, x.len() - 1);
        let rate = (y[k] - y[k - 1]) / (x[k] - x[k - 1]);
        [y[k - 1] + rate * (t - x[k - 1]), rate, 0.0]
    }
}
