//! Functions of time, their first two derivatives, and the times at which a derivative jumps.
//! Nothing else in the crates depends explicitly on time.

mod expression;
mod lines;
mod parts;
mod spline;

use joints::LARGEST;

use crate::codes::Code;
use crate::law::{LawError, Operation};
use expression::Expression;
use lines::Lines;
use spline::Spline;

pub use parts::Parts;

/// A scalar function of time.
///
/// ```
/// use pfaff_model::Function;
/// let ramp = Function::steps(0.0, &[[1.0, 2.0, 0.5]])?; // from t = 1 to t = 2 by 0.5
/// assert_eq!(ramp.jet(0.0), [0.0, 0.0, 0.0]);
/// assert_eq!(ramp.jet(1.5)[0], 0.25);
/// assert_eq!(ramp.jet(3.0), [0.5, 0.0, 0.0]);
/// assert_eq!(ramp.break_times(), [1.0, 2.0]);
/// # Ok::<(), pfaff_model::FunctionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Function(TimeLaw);

#[derive(Clone, Debug, PartialEq)]
enum TimeLaw {
    Polynomial(Vec<f64>),
    Harmonic {
        amplitude: f64,
        omega: f64,
        phase: f64,
        offset: f64,
    },
    Steps {
        start: f64,
        steps: Vec<Step>,
    },
    Table(Spline),
    Lines(Lines),
    Expression(Expression),
}

/// A smooth step `by·(10s³ − 15s⁴ + 6s⁵)`, `s = (t − from)/(to − from)` clamped to [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    from: f64,
    to: f64,
    by: f64,
}

/// Error in a function of time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FunctionError {
    /// A value is NaN, infinite or above [`LARGEST`].
    #[error("`{name}` is {value:?}, need finite numbers up to {LARGEST:e}")]
    NotFinite {
        /// Name of the argument.
        name: &'static str,
        /// The value.
        value: f64,
    },
    /// The end time of a step is not after its start time.
    #[error("step {step} runs from t = {from} to t = {to}; `to` must be later than `from`")]
    EmptyStep {
        /// Number of the step (1-based).
        step: usize,
        /// Start time of the step.
        from: f64,
        /// End time of the step.
        to: f64,
    },
    /// A table has too few points.
    #[error("a table needs at least 2 points, found {found}")]
    ShortTable {
        /// Number of points.
        found: usize,
    },
    /// The times and the values of a table differ in number.
    #[error("{times} times and {values} values; a table needs equal numbers of both")]
    Uneven {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// The times are not increasing.
    #[error("times must increase: times[{index}] = {later} follows {earlier}")]
    NotIncreasing {
        /// Index of the later of the two times (0-based).
        index: usize,
        /// The time before the later time.
        earlier: f64,
        /// The later time, which is not larger than the earlier time.
        later: f64,
    },
    /// The operations of an expression are wrong.
    #[error(transparent)]
    Operations(#[from] LawError),
}

impl FunctionError {
    /// Returns the error code; see [`crate::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::NotFinite { .. } => const { Code::new(111) },
            Self::EmptyStep { .. } | Self::NotIncreasing { .. } => const { Code::new(117) },
            Self::Uneven { .. } | Self::ShortTable { .. } => const { Code::new(118) },
            Self::Operations(_) => const { Code::new(106) },
        }
    }
}

impl Function {
    /// Returns the constant function.
    ///
    /// # Errors
    /// Returns an error if the value is not finite, or above [`LARGEST`].
    pub fn constant(value: f64) -> Result<Self, FunctionError> {
        Self::polynomial(&[value])
    }

    /// Returns the function f(t) = t, an argument of drive laws.
    #[must_use]
    pub fn time() -> Self {
        Self(TimeLaw::Polynomial(vec![0.0, 1.0]))
    }

    /// Returns `rate·t`.
    ///
    /// # Errors
    /// Returns an error if the rate is not finite, or above [`LARGEST`].
    pub fn constant_rate(rate: f64) -> Result<Self, FunctionError> {
        usable("rate", &[rate])?;
        Self::polynomial(&[0.0, rate])
    }

    /// Returns `Σ coefficients[k]·tᵏ`.
    ///
    /// # Errors
    /// Returns an error if a coefficient is not finite, or above [`LARGEST`].
    pub fn polynomial(coefficients: &[f64]) -> Result<Self, FunctionError> {
        usable("coefficients", coefficients)?;
        Ok(Self(TimeLaw::Polynomial(coefficients.to_vec())))
    }

    /// Returns `amplitude·sin(omega·t + phase) + offset`.
    ///
    /// # Errors
    /// Returns an error if an argument is not finite, or above [`LARGEST`].
    pub fn harmonic(
        amplitude: f64,
        omega: f64,
        phase: f64,
        offset: f64,
    ) -> Result<Self, FunctionError> {
        usable("amplitude", &[amplitude])?;
        usable("omega", &[omega])?;
        usable("phase", &[phase])?;
        usable("offset", &[offset])?;
        Ok(Self(TimeLaw::Harmonic {
            amplitude,
            omega,
            phase,
            offset,
        }))
    }

    /// Returns the function that starts at the value `start` and adds smooth steps `[from, to,
    /// by]`. Between the times `from` and `to`, each step adds `by·(10s³ − 15s⁴ + 6s⁵)`.
    ///
    /// # Errors
    /// Returns an error if an argument is not finite or above [`LARGEST`], or if a step has no
    /// duration.
    pub fn steps(start: f64, steps: &[[f64; 3]]) -> Result<Self, FunctionError> {
        usable("start", &[start])?;
        for (k, &[from, to, by]) in steps.iter().enumerate() {
            usable("from", &[from])?;
            usable("to", &[to])?;
            usable("by", &[by])?;
            if to <= from {
                return Err(FunctionError::EmptyStep {
                    step: k + 1,
                    from,
                    to,
                });
            }
        }
        let steps = steps
            .iter()
            .map(|&[from, to, by]| Step { from, to, by })
            .collect();
        Ok(Self(TimeLaw::Steps { start, steps }))
    }

    /// Returns the natural cubic spline through a table. Outside the table, the spline continues as
    /// a straight line.
    ///
    /// # Errors
    /// Returns an error if there are fewer than two points, if times are not increasing, or if an
    /// entry is not finite or above [`LARGEST`].
    pub fn table(times: &[f64], values: &[f64]) -> Result<Self, FunctionError> {
        points(times, values, |earlier, later| later > earlier)?;
        Ok(Self(TimeLaw::Table(Spline::natural(times, values))))
    }

    /// Returns the piecewise linear function through a table. Outside the table, the first and the
    /// last line continue. If two points have the same time, the value jumps at this time; at all
    /// other points the rate jumps.
    ///
    /// ```
    /// use pfaff_model::Function;
    /// let f = Function::lines(&[0.0, 1.0, 1.0, 3.0], &[0.0, 2.0, 5.0, 5.0])?;
    /// assert_eq!(f.jet(0.5), [1.0, 2.0, 0.0]);
    /// assert_eq!((f.jet(1.0_f64.next_down())[1], f.jet(1.0)[0], f.jet(2.0)), (2.0, 5.0, [5.0, 0.0, 0.0]));
    /// # Ok::<(), pfaff_model::FunctionError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if there are fewer than two points, if times decrease, or if more than two
    /// times are equal. The function also returns an error if the first two or the last two times
    /// are equal, or if an entry is not finite or above [`LARGEST`].
    pub fn lines(times: &[f64], values: &[f64]) -> Result<Self, FunctionError> {
        points(times, values, |earlier, later| later >= earlier)?;
        let last = times.len() - 1;
        let has_no_line = |k: usize| {
            times[k] == times[k - 1] && (k == 1 || k == last || times[k] == times[k - 2])
        };
        if let Some(k) = (1..=last).find(|&k| has_no_line(k)) {
            return Err(FunctionError::NotIncreasing {
                index: k,
                earlier: times[k - 1],
                later: times[k],
            });
        }
        Ok(Self(TimeLaw::Lines(Lines::new(times, values))))
    }

    /// Returns the function of time that a list of operations computes, as in force laws.
    ///
    /// ```
    /// use pfaff_model::Function;
    /// use pfaff_model::law::{Operation, UnaryFunction};
    /// let f = Function::expression(&[Operation::Time, Operation::Apply(UnaryFunction::Whole(3))])?;
    /// assert_eq!(f.jet(2.0), [8.0, 12.0, 12.0]);
    /// # Ok::<(), pfaff_model::FunctionError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the operations do not produce exactly one value, need more than 64
    /// values at a time, or contain a joint coordinate or its rate.
    pub fn expression(operations: &[Operation]) -> Result<Self, FunctionError> {
        Ok(Self(TimeLaw::Expression(Expression::new(operations)?)))
    }

    /// Returns whether the function and its first two derivatives are continuous, except at
    /// [break times](Self::break_times).
    #[must_use]
    pub fn is_smooth(&self) -> bool {
        match &self.0 {
            TimeLaw::Expression(expression) => expression.is_smooth(),
            _ => true,
        }
    }

    /// Returns `[f(t), ḟ(t), f̈(t)]`. The values are NaN if the operations of an
    /// [expression](Self::expression) have no value at this time.
    #[must_use]
    pub fn jet(&self, t: f64) -> [f64; 3] {
        match &self.0 {
            // Horner's scheme for the value and both derivatives.
            TimeLaw::Polynomial(c) => c.iter().rev().fold([0.0; 3], |[f, d, dd], &c| {
                [f * t + c, d * t + f, dd * t + 2.0 * d]
            }),
            TimeLaw::Harmonic {
                amplitude,
                omega,
                phase,
                offset,
            } => {
                let (sin, cos) = (omega * t + phase).sin_cos();
                [
                    amplitude * sin + offset,
                    amplitude * omega * cos,
                    -amplitude * omega * omega * sin,
                ]
            }
            TimeLaw::Steps { start, steps } => {
                steps.iter().fold([*start, 0.0, 0.0], |sum, step| {
                    let jet = step.jet(t);
                    [sum[0] + jet[0], sum[1] + jet[1], sum[2] + jet[2]]
                })
            }
            TimeLaw::Table(spline) => spline.jet(t),
            TimeLaw::Lines(lines) => lines.jet(t),
            TimeLaw::Expression(expression) => expression.jet(t),
        }
    }

    /// Returns whether the function has the same value at all times.
    ///
    /// ```
    /// use pfaff_model::Function;
    /// assert!(Function::polynomial(&[2.0, 0.0]).unwrap().is_constant());
    /// assert!(!Function::steps(0.0, &[[1.0, 2.0, 0.5]]).unwrap().is_constant());
    /// ```
    #[must_use]
    pub fn is_constant(&self) -> bool {
        match &self.0 {
            TimeLaw::Polynomial(coefficients) => coefficients.iter().skip(1).all(|c| *c == 0.0),
            TimeLaw::Harmonic {
                amplitude, omega, ..
            } => *amplitude == 0.0 || *omega == 0.0,
            TimeLaw::Steps { steps, .. } => steps.iter().all(|step| step.by == 0.0),
            TimeLaw::Table(spline) => spline.is_constant(),
            TimeLaw::Lines(lines) => lines.is_constant(),
            TimeLaw::Expression(expression) => expression.is_constant(),
        }
    }

    /// Returns the constant function with the value f(t).
    pub(crate) fn held_at(&self, t: f64) -> Self {
        Self(TimeLaw::Polynomial(vec![self.jet(t)[0]]))
    }

    /// Returns the times at which the function or one of its derivatives jumps, in ascending order.
    #[must_use]
    pub fn break_times(&self) -> Vec<f64> {
        let mut times = match &self.0 {
            TimeLaw::Polynomial(_) | TimeLaw::Harmonic { .. } | TimeLaw::Expression(_) => {
                Vec::new()
            }
            TimeLaw::Steps { steps, .. } => steps.iter().flat_map(|s| [s.from, s.to]).collect(),
            TimeLaw::Table(spline) => spline.times().to_vec(),
            TimeLaw::Lines(lines) => lines.times().to_vec(),
        };
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}

impl Step {
    fn jet(self, t: f64) -> [f64; 3] {
        let Self { from, to, by } = self;
        if t <= from {
            return [0.0; 3];
        }
        if t >= to {
            return [by, 0.0, 0.0];
        }
        let span = to - from;
        let s = (t - from) / span;
        [
            by * s * s * s * (10.0 + s * (6.0 * s - 15.0)),
            by / span * 30.0 * s * s * (s - 1.0) * (s - 1.0),
            by / (span * span) * 60.0 * s * (s - 1.0) * (2.0 * s - 1.0),
        ]
    }
}

/// Returns the points of a table. The function first checks the order of the times.
fn points(
    times: &[f64],
    values: &[f64],
    follows: impl Fn(f64, f64) -> bool,
) -> Result<(), FunctionError> {
    usable("times", times)?;
    usable("values", values)?;
    if times.len() != values.len() {
        return Err(FunctionError::Uneven {
            times: times.len(),
            values: values.len(),
        });
    }
    if times.len() < 2 {
        return Err(FunctionError::ShortTable { found: times.len() });
    }
    if let Some(k) = (1..times.len()).find(|&k| !follows(times[k - 1], times[k])) {
        return Err(FunctionError::NotIncreasing {
            index: k,
            earlier: times[k - 1],
            later: times[k],
        });
    }
    Ok(())
}

fn usable(name: &'static str, values: &[f64]) -> Result<(), FunctionError> {
    match values.iter().find(|x| !joints::is_usable(**x)) {
        Some(&value) => Err(FunctionError::NotFinite { name, value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Limit for the error of central differences of a smooth function with step 1e-4. The error is
    /// about 1e-8 times the third derivative.
    const DIFFERENCE: f64 = 1e-6;

    #[test]
    fn derivatives_agree_with_differences() {
        let functions = [
            Function::polynomial(&[1.0, -2.0, 0.5, 0.25]).unwrap(),
            Function::harmonic(0.7, 3.0, 0.4, 1.0).unwrap(),
            Function::steps(0.3, &[[0.0, 1.0, 2.0], [0.5, 2.0, -1.0]]).unwrap(),
            Function::table(&[-1.0, 0.0, 0.7, 2.0], &[0.0, 1.0, -1.0, 0.5]).unwrap(),
        ];
        let h = 1e-4;
        for f in &functions {
            for t in [-0.4, 0.2, 0.55, 0.8, 1.3] {
                let [before, now, after] = [f.jet(t - h), f.jet(t), f.jet(t + h)];
                for k in 0..2 {
                    let difference = (after[k] - before[k]) / (2.0 * h);
                    assert!(
                        (difference - now[k + 1]).abs() < DIFFERENCE * 100.0,
                        "{f:?} at {t}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_spline_reproduces_a_straight_line_exactly_also_outside() {
        let f = Function::table(&[0.0, 1.0, 4.0], &[1.0, 3.0, 9.0]).unwrap();
        for t in [-2.0, 0.0, 0.5, 1.0, 3.0, 4.0, 6.0] {
            let [value, rate, second] = f.jet(t);
            assert!((value - (1.0 + 2.0 * t)).abs() < 1e-14);
            assert!((rate - 2.0).abs() < 1e-14 && second.abs() < 1e-14);
        }
    }

    #[test]
    fn a_spline_has_two_continuous_derivatives_at_its_points() {
        let f = Function::table(&[0.0, 1.0, 1.5, 4.0], &[1.0, -3.0, 2.0, 0.0]).unwrap();
        for t in [0.0, 1.0, 1.5, 4.0] {
            let (before, after) = (f.jet(t - 1e-9), f.jet(t + 1e-9));
            for k in 0..3 {
                assert!((before[k] - after[k]).abs() < 1e-6, "derivative {k} at {t}");
            }
        }
    }

    #[test]
    fn lines_are_one_sided_at_their_points() {
        let f = Function::lines(&[0.0, 1.0, 1.0, 2.0], &[1.0, 3.0, 0.0, -1.0]).unwrap();
        assert_eq!(f.jet(-1.0), [-1.0, 2.0, 0.0]);
        assert_eq!(f.jet(0.0), [1.0, 2.0, 0.0]);
        assert_eq!(f.jet(1.0), [0.0, -1.0, 0.0]);
        assert_eq!(f.jet(2.0), [-1.0, -1.0, 0.0]);
        assert_eq!(f.jet(4.0), [-3.0, -1.0, 0.0]);
        assert_eq!(f.break_times(), [0.0, 1.0, 2.0]);
        for times in [
            [0.0, 0.0, 1.0, 2.0],
            [0.0, 1.0, 2.0, 2.0],
            [0.0, 2.0, 1.0, 3.0],
        ] {
            assert!(Function::lines(&times, &[0.0; 4]).is_err(), "{times:?}");
        }
    }

    #[test]
    fn wrong_data_are_named() {
        assert_eq!(
            Function::steps(0.0, &[[1.0, 1.0, 2.0]])
                .unwrap_err()
                .to_string(),
            "step 1 runs from t = 1 to t = 1; `to` must be later than `from`"
        );
        assert!(matches!(
            Function::table(&[0.0, 1.0, 1.0], &[0.0; 3]),
            Err(FunctionError::NotIncreasing { index: 2, .. })
        ));
        assert!(matches!(
            Function::table(&[0.0], &[0.0]),
            Err(FunctionError::ShortTable { found: 1 })
        ));
        assert!(matches!(
            Function::constant(f64::NAN),
            Err(FunctionError::NotFinite { .. })
        ));
        assert!(Function::constant(-LARGEST).is_ok());
        assert_eq!(
            Function::constant(1.1e60).unwrap_err().to_string(),
            "`coefficients` is 1.1e60, need finite numbers up to 1e60"
        );
    }
}
