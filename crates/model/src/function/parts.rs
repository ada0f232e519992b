//! The parts of a function of time, for generators of code.

use super::{Function, Law};

/// The kind of a function, with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub enum Parts<'a> {
    /// `Σ c[k]·tᵏ`
    Polynomial(&'a [f64]),
    /// `amplitude·sin(omega·t + phase) + offset`
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
    /// `start` and smooth steps `[from, to, by]`, see [`Function::steps`].
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
    /// Straight lines through points; if a time occurs twice, the second value holds at this time.
    Lines {
        /// Times of the points.
        times: &'a [f64],
        /// Values at these times.
        values: &'a [f64],
    },
}

impl Function {
    /// The kind of the function, with its numbers.
    ///
    /// ```
    /// use model::{Function, function::Parts};
    /// let f = Function::constant_rate(3.0).unwrap();
    /// assert_eq!(f.parts(), Parts::Polynomial(&[0.0, 3.0]));
    /// ```
    #[must_use]
    pub fn parts(&self) -> Parts<'_> {
        match &self.0 {
            Law::Polynomial(c) => Parts::Polynomial(c),
            &Law::Harmonic {
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
            Law::Steps { start, steps } => Parts::Steps {
                start: *start,
                steps: steps.iter().map(|s| [s.from, s.to, s.by]).collect(),
            },
            Law::Table(spline) => {
                let (times, values, curvatures) = spline.points();
                Parts::Spline {
                    times,
                    values,
                    curvatures,
                }
            }
            Law::Lines(lines) => {
                let (times, values) = lines.points();
                Parts::Lines { times, values }
            }
        }
    }
}
