//! Cost at equal error: between two neighbouring tolerances of a series, log(cost) is interpolated
//! in log(error).

/// Error and cost of one run.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Error at the end.
    pub error: f64,
    /// Evaluations or seconds.
    pub cost: f64,
}

/// The cost of an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cost {
    /// This cost, between two tolerances.
    At(f64),
    /// At most this cost: every run was more accurate.
    AtMost(f64),
    /// No run was that accurate, or the errors are too irregular.
    Unknown,
}

/// The least cost at which a series, in the order of its tolerances, changes from errors above
/// `error` to errors below it.
pub fn cost_at(series: &[Point], error: f64) -> Cost {
    let crossings = series.windows(2).filter_map(|pair| {
        let [a, b] = [pair[0], pair[1]];
        let crosses = a.error > error && b.error <= error && b.error > 0.0;
        crosses.then(|| {
            let share = (a.error / error).ln() / (a.error / b.error).ln();
            (a.cost.ln() + share * (b.cost / a.cost).ln()).exp()
        })
    });
    match (crossings.reduce(f64::min), series.first()) {
        (Some(cost), _) => Cost::At(cost),
        (None, Some(first)) if first.error <= error => Cost::AtMost(first.cost),
        _ => Cost::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_at(cost: Cost, expected: f64) {
        let Cost::At(found) = cost else {
            panic!("{cost:?}")
        };
        assert!((found / expected - 1.0).abs() < 1e-12, "{found}");
    }

    #[test]
    fn a_method_of_order_four_is_met_on_its_line() {
        // error = cost⁻⁴: 10⁻⁶ costs 10^1.5.
        let series = [10.0, 20.0, 40.0, 80.0].map(|cost: f64| Point {
            error: cost.powi(-4),
            cost,
        });
        assert_at(cost_at(&series, 1e-6), 10f64.powf(1.5));
        assert_eq!(cost_at(&series, 1e-3), Cost::AtMost(10.0));
        assert_eq!(cost_at(&series, 1e-9), Cost::Unknown);
    }

    #[test]
    fn where_errors_grow_again_the_cheapest_passage_counts() {
        let points = [(1e-2, 10.0), (1e-4, 20.0), (1e-2, 30.0), (1e-4, 40.0)];
        let series = points.map(|(error, cost)| Point { error, cost });
        assert_at(cost_at(&series, 1e-3), 200f64.sqrt());
    }
}
