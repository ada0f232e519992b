//! Tolerances and limits of an integration, as plain data, and a check of these values.

use crate::error::IntegrationError;
use std::error::Error;

/// Options of an integration. `Options::default()` is a good initial choice. The documentation of
/// each field states the default.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Permitted local error. Default: rtol = 1e-8, atol = 1e-10.
    pub tolerance: Tolerance,
    /// First trial step. Default: [`InitialStep::Automatic`].
    pub initial_step: InitialStep,
    /// Largest step size, > 0, in units of t. The last step before a break time or the end may be 1
    /// % longer. Default: infinite.
    pub max_step: f64,
    /// Limit on accepted and rejected steps together. Default: 1 000 000.
    pub max_steps: u64,
    /// Number of consecutive rejected trials after which the step size counts as collapsed.
    /// Default: 40.
    pub max_failures: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: Tolerance::Uniform {
                rtol: 1e-8,
                atol: 1e-10,
            },
            initial_step: InitialStep::Automatic,
            max_step: f64::INFINITY,
            max_steps: 1_000_000,
            max_failures: 40,
        }
    }
}

impl Options {
    /// Returns the default options with the same tolerances for all components.
    #[must_use]
    pub fn with_tolerance(rtol: f64, atol: f64) -> Self {
        Self {
            tolerance: Tolerance::Uniform { rtol, atol },
            ..Self::default()
        }
    }
}

/// Permitted local error of a step in each component: `atol + rtol·max(|y0|, |y1|)`. The components
/// are combined as a root mean square.
#[derive(Debug, Clone, PartialEq)]
pub enum Tolerance {
    /// The same tolerances for all components. Both tolerances are finite and ≥ 0, and not both are
    /// 0.
    Uniform {
        /// Relative part.
        rtol: f64,
        /// Absolute part, in the unit of y.
        atol: f64,
    },
    /// One pair of tolerances for each component; both lists have length n.
    PerComponent {
        /// Relative parts.
        rtol: Vec<f64>,
        /// Absolute parts, each in the unit of its component.
        atol: Vec<f64>,
    },
}

impl Tolerance {
    /// Writes `atol + rtol·max(|y0|, |y1|)` to `scale`.
    pub(crate) fn scale(&self, y0: &[f64], y1: &[f64], scale: &mut [f64]) {
        let sizes = y0.iter().zip(y1).map(|(a, b)| a.abs().max(b.abs()));
        match self {
            Self::Uniform { rtol, atol } => {
                for (s, size) in scale.iter_mut().zip(sizes) {
                    *s = atol + rtol * size;
                }
            }
            Self::PerComponent { rtol, atol } => {
                for (i, (s, size)) in scale.iter_mut().zip(sizes).enumerate() {
                    *s = atol[i] + rtol[i] * size;
                }
            }
        }
    }

    /// Returns the relative part for component `i`.
    pub(crate) fn rtol(&self, i: usize) -> f64 {
        match self {
            Self::Uniform { rtol, .. } => *rtol,
            Self::PerComponent { rtol, .. } => rtol[i],
        }
    }

    fn check<E: Error + 'static>(&self, dim: usize) -> Result<(), IntegrationError<E>> {
        match self {
            Self::Uniform { rtol, atol } => check_pair(*rtol, *atol),
            Self::PerComponent { rtol, atol } => {
                for (tolerance, list) in [("rtol", rtol), ("atol", atol)] {
                    if list.len() != dim {
                        return Err(IntegrationError::ToleranceLength {
                            tolerance,
                            expected: dim,
                            found: list.len(),
                        });
                    }
                }
                rtol.iter()
                    .zip(atol)
                    .try_for_each(|(&r, &a)| check_pair(r, a))
            }
        }
    }
}

/// The first trial step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InitialStep {
    /// The size of the first step is computed from the sizes of y, of f, and of the change of f
    /// over a small Euler step. The computation costs one evaluation. This computation is always
    /// used after a break time.
    Automatic,
    /// The first step has this size (> 0), for either direction of integration.
    Given(f64),
}

impl Options {
    /// Checks all options that do not depend on the state.
    pub(crate) fn check<E: Error + 'static>(&self, dim: usize) -> Result<(), IntegrationError<E>> {
        self.tolerance.check(dim)?;
        check_positive("max_step", self.max_step)?;
        if let InitialStep::Given(h) = self.initial_step {
            if h == f64::INFINITY {
                return Err(invalid("initial_step", h, "a finite positive number"));
            }
            check_positive("initial_step", h)?;
        }
        Ok(())
    }
}

fn check_pair<E: Error + 'static>(rtol: f64, atol: f64) -> Result<(), IntegrationError<E>> {
    for (option, value) in [("rtol", rtol), ("atol", atol)] {
        if !(value.is_finite() && value >= 0.0) {
            return Err(invalid(option, value, "a finite number ≥ 0"));
        }
    }
    if rtol == 0.0 && atol == 0.0 {
        return Err(invalid("rtol", rtol, "rtol > 0 or atol > 0"));
    }
    Ok(())
}

fn check_positive<E: Error + 'static>(
    option: &'static str,
    value: f64,
) -> Result<(), IntegrationError<E>> {
    if value > 0.0 {
        Ok(())
    } else {
        Err(invalid(option, value, "a positive number"))
    }
}

pub(crate) fn invalid<E: Error + 'static>(
    option: &'static str,
    value: f64,
    expected: &'static str,
) -> IntegrationError<E> {
    IntegrationError::InvalidOption {
        option,
        value,
        expected,
    }
}
