//! The natural cubic spline. The spline has two continuous derivatives, and its second derivative
//! is zero at both ends.

/// Values and second derivatives at given times.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spline {
    times: Vec<f64>,
    values: Vec<f64>,
    curvatures: Vec<f64>,
}

impl Spline {
    /// Returns whether all values are the same.
    pub(super) fn is_constant(&self) -> bool {
        self.values.windows(2).all(|pair| pair[0] == pair[1])
    }

    /// Returns the spline through a table of at least two points with increasing times.
    ///
    /// The curvatures κ solve the tridiagonal system `h₋κ₋ + 2(h₋ + h₊)κ + h₊κ₊ = 6(δ₊ − δ₋)`. Here
    /// h are the steps, and δ are the slopes of the chords.
    pub(super) fn natural(times: &[f64], values: &[f64]) -> Self {
        let n = times.len();
        let step = |k: usize| times[k + 1] - times[k];
        let slope = |k: usize| (values[k + 1] - values[k]) / step(k);
        let mut curvatures = vec![0.0; n];
        let mut upper = vec![0.0; n];
        // The elimination starts at the first inner point; the matrix is diagonally dominant.
        for k in 1..n - 1 {
            let diagonal = 2.0 * (step(k - 1) + step(k)) - step(k - 1) * upper[k - 1];
            upper[k] = step(k) / diagonal;
            let rhs = 6.0 * (slope(k) - slope(k - 1));
            curvatures[k] = (rhs - step(k - 1) * curvatures[k - 1]) / diagonal;
        }
        for k in (1..n - 1).rev() {
            curvatures[k] -= upper[k] * curvatures[k + 1];
        }
        Self {
            times: times.to_vec(),
            values: values.to_vec(),
            curvatures,
        }
    }

    /// Returns the spline with these values and second derivatives.
    pub(super) fn of_points(times: Vec<f64>, values: Vec<f64>, curvatures: Vec<f64>) -> Self {
        Self {
            times,
            values,
            curvatures,
        }
    }

    pub(super) fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the times, values and second derivatives.
    pub(super) fn points(&self) -> (&[f64], &[f64], &[f64]) {
        (&self.times, &self.values, &self.curvatures)
    }

    /// Returns the value and the derivatives at t. Outside the table, the spline continues along
    /// the tangents at the first and the last point.
    pub(super) fn jet(&self, t: f64) -> [f64; 3] {
        let last = self.times.len() - 1;
        if t < self.times[0] || t > self.times[last] {
            let (end, at) = if t < self.times[0] {
                (0, 0)
            } else {
                (last, last - 1)
            };
            let slope = self.inner(at, self.times[end])[1];
            return [self.values[end] + slope * (t - self.times[end]), slope, 0.0];
        }
        let at = self.times.partition_point(|&x| x <= t).clamp(1, last) - 1;
        self.inner(at, t)
    }

    /// Returns the value and the derivatives of the cubic between points `k` and `k + 1`.
    fn inner(&self, k: usize, t: f64) -> [f64; 3] {
        let h = self.times[k + 1] - self.times[k];
        let (a, b) = ((self.times[k + 1] - t) / h, (t - self.times[k]) / h);
        let (ka, kb) = (self.curvatures[k], self.curvatures[k + 1]);
        let (fa, fb) = (self.values[k], self.values[k + 1]);
        [
            a * fa + b * fb + h * h / 6.0 * (a * (a * a - 1.0) * ka + b * (b * b - 1.0) * kb),
            (fb - fa) / h + h / 6.0 * ((1.0 - 3.0 * a * a) * ka + (3.0 * b * b - 1.0) * kb),
            a * ka + b * kb,
        ]
    }
}
