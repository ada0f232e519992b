//! The parts of a function of time, for code generators.

use super::spline::Spline;
use super::{Function, TimeLaw, points};
use crate::law::Operation;

/// The kind of a function, with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum Parts<'a> {
    /// The polynomial `Σ c[k]·tᵏ`.
    Polynomial(&'a [f64]),
    /// The harmonic function `amplitude·sin(omega·t + phase) + offset`.
    Harmonic {
        /// Amplitude.
        amplitude: f64,
        /// Rate of the angle (rad/s).
        omega: f64,
        /// Angle at t = 0 (rad).
        phase: f64,
        /// Mean value.
        offset: f64,
    },
    /// The value `start` and smooth steps `[from, to, by]`, see [`Function::steps`].
    Steps {
        /// Value before all steps.
        start: f64,
        /// The steps.
        steps: Vec<[f64; 3]>,
    },
    /// A cubic spline with straight ends.
    Spline {
        /// Times of the points.
        times: &'a [f64],
        /// Values at these times.
        values: &'a [f64],
        /// Second derivatives at these times.
        curvatures: &'a [f64],
    },
    /// Straight lines through points. If two points have the same time, the value of the second
    /// point applies at this time.
    Lines {
        /// Times of the points.
        times: &'a [f64],
        /// Values at these times.
        values: &'a [f64],
    },
    /// Operations on the time, in the order of evaluation.
    Expression(&'a [Operation]),
}

impl Parts<'_> {
    /// Returns the name of the kind.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Polynomial(_) => "polynomial",
            Self::Harmonic { .. } => "harmonic",
            Self::Steps { .. } => "steps",
            Self::Spline { .. } => "spline",
            Self::Lines { .. } => "lines",
            Self::Expression(_) => "expression",
        }
    }

    /// Returns all parameters. The parameters are the coefficients; amplitude, omega, phase and
    /// offset; the start and each step; time, value and curvature of each point; or time and value
    /// of each point. An expression has no parameters, because its operations may depend on the
    /// values of its constants.
    #[must_use]
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Polynomial(c) => c.to_vec(),
            &Self::Harmonic {
                amplitude,
                omega,
                phase,
                offset,
            } => vec![amplitude, omega, phase, offset],
            Self::Steps { start, steps } => {
                let steps = steps.iter().flatten();
                std::iter::once(start).chain(steps).copied().collect()
            }
            Self::Spline {
                times,
                values,
                curvatures,
            } => {
                let points = times.iter().zip(*values).zip(*curvatures);
                points.flat_map(|((t, f), k)| [*t, *f, *k]).collect()
            }
            Self::Lines { times, values } => {
                let points = times.iter().zip(*values);
                points.flat_map(|(t, f)| [*t, *f]).collect()
            }
            Self::Expression(_) => Vec::new(),
        }
    }
}

impl Function {
    /// Returns the function of the same kind with these parameters, in the order of
    /// [`Parts::numbers`]. Returns `None` if the number of parameters is wrong, or if they are
    /// invalid for a function of this kind.
    ///
    /// ```
    /// let f = pfaff_model::Function::harmonic(2.0, 3.0, 0.1, 0.5).unwrap();
    /// let mut numbers = f.parts().numbers();
    /// numbers[0] = 4.0;
    /// assert_eq!(f.with_numbers(&numbers), pfaff_model::Function::harmonic(4.0, 3.0, 0.1, 0.5).ok());
    /// assert_eq!(f.with_numbers(&[1.0]), None);
    /// ```
    #[must_use]
    pub fn with_numbers(&self, numbers: &[f64]) -> Option<Self> {
        if numbers.len() != self.parts().numbers().len() {
            return None;
        }
        let every = |n: usize, from: usize| -> Vec<f64> {
            numbers.iter().skip(from).step_by(n).copied().collect()
        };
        match &self.0 {
            TimeLaw::Polynomial(_) => Self::polynomial(numbers).ok(),
            TimeLaw::Harmonic { .. } => {
                let &[amplitude, omega, phase, offset] = numbers else {
                    return None;
                };
                Self::harmonic(amplitude, omega, phase, offset).ok()
            }
            TimeLaw::Steps { .. } => {
                let (start, steps) = numbers.split_first()?;
                let (steps, _) = steps.as_chunks();
                Self::steps(*start, steps).ok()
            }
            TimeLaw::Table(_) => {
                let [times, values, curvatures] = [0, 1, 2].map(|from| every(3, from));
                points(&times, &values, |earlier, later| later > earlier).ok()?;
                Some(Self(TimeLaw::Table(Spline::of_points(
                    times, values, curvatures,
                ))))
            }
            TimeLaw::Lines(_) => Self::lines(&every(2, 0), &every(2, 1)).ok(),
            TimeLaw::Expression(_) => Some(self.clone()),
        }
    }

    /// Returns the kind of the function, with its parameters.
    ///
    /// ```
    /// use pfaff_model::{Function, function::Parts};
    /// let f = Function::constant_rate(3.0).unwrap();
    /// assert_eq!(f.parts(), Parts::Polynomial(&[0.0, 3.0]));
    /// ```
    #[must_use]
    pub fn parts(&self) -> Parts<'_> {
        match &self.0 {
            TimeLaw::Polynomial(c) => Parts::Polynomial(c),
            &TimeLaw::Harmonic {
                amplitude,
                omega,
                phase,
                offset,
            } => Parts::Harmonic {
                amplitude,
                omega,
                phase,
                offset,
            },
            TimeLaw::Steps { start, steps } => Parts::Steps {
                start: *start,
                steps: steps.iter().map(|s| [s.from, s.to, s.by]).collect(),
            },
            TimeLaw::Table(spline) => {
                let (times, values, curvatures) = spline.points();
                Parts::Spline {
                    times,
                    values,
                    curvatures,
                }
            }
            TimeLaw::Lines(lines) => {
                let (times, values) = lines.points();
                Parts::Lines { times, values }
            }
            TimeLaw::Expression(expression) => Parts::Expression(expression.operations()),
        }
    }
}
