//! Options of a run.

#[cfg(test)]
mod tests;

use std::num::NonZeroUsize;

use crate::error::MotionError;

/// Integration method of the equations of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Method {
    /// Dormand–Prince 8(5,3), or Radau IIA if forces make the motion stiff at its start.
    #[default]
    Auto,
    /// Dormand–Prince 5(4), the method of MATLAB's `ode45`.
    Dopri5,
    /// Tsitouras 5(4).
    Tsit5,
    /// Dormand–Prince 8(5,3).
    Dop853,
    /// Radau IIA of order 5 on independent coordinates, for stiff forces.
    Radau5,
}

impl Method {
    /// All methods that can be requested.
    pub const ALL: &[Self] = &[
        Self::Auto,
        Self::Dop853,
        Self::Dopri5,
        Self::Tsit5,
        Self::Radau5,
    ];

    /// Returns the name of the method in scenes and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Dopri5 => "dopri5",
            Self::Tsit5 => "tsit5",
            Self::Dop853 => "dop853",
            Self::Radau5 => "radau5",
        }
    }

    /// Returns whether the method needs the Jacobian of the motion. The Jacobian exists only for
    /// independent coordinates.
    #[must_use]
    pub fn needs_independent_coordinates(self) -> bool {
        self == Self::Radau5
    }
}

/// Treatment of redundant rows in every run. A run solves r independent rows and only monitors the
/// redundant rows. The value is the name in results, because reactions that are not unique depend
/// on this treatment.
pub const FORMULATION: &str = "kept-rows";

/// Description of [`FORMULATION`] in words.
pub const INDEPENDENT_ROWS: &str = "independent rows";

/// Method that prevents drift from the constraints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stabilisation {
    /// Position and velocity are projected in the mass metric after each step.
    #[default]
    Projection,
    /// No stabilisation. Residuals show the drift.
    None,
}

impl Stabilisation {
    /// All methods that can be requested.
    pub const ALL: &[Self] = &[Self::Projection, Self::None];

    /// Returns the name of the method in scenes and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Projection => "projection",
            Self::None => "none",
        }
    }
}

/// Choice of the independent rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum RowChoice {
    /// The rank decision chooses well-conditioned rows.
    #[default]
    Automatic,
    /// All rows except the given rows, counted from 0.
    Drop(Vec<usize>),
}

/// Options of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionOptions {
    /// End time (s), not before the start of the [`crate::PreparedMechanism`].
    pub t_end: f64,
    /// Time between output rows (s).
    pub output_step: f64,
    /// Relative tolerance of the step control.
    pub rtol: f64,
    /// Absolute tolerance of the step control.
    pub atol: f64,
    /// Maximum step (s); infinite if only error control limits the step.
    pub max_step: f64,
    /// Maximum number of accepted and rejected steps of a component.
    pub max_steps: u64,
    /// Integration method.
    pub method: Method,
    /// Method that prevents drift from the constraints.
    pub stabilisation: Stabilisation,
    /// Choice of independent rows, as passed to [`crate::prepare()`]. A run uses the rows of its
    /// [`crate::PreparedMechanism`].
    pub rows: RowChoice,
    /// Maximum number of components that are computed at the same time; `None` means no limit.
    /// Results do not depend on this number.
    pub threads: Option<NonZeroUsize>,
}

impl MotionOptions {
    /// Returns the default options for a run to `t_end`.
    #[must_use]
    pub fn to(t_end: f64) -> Self {
        Self {
            t_end,
            output_step: t_end / Self::OUTPUT_STEPS,
            rtol: Self::RTOL,
            atol: Self::ATOL,
            max_step: f64::INFINITY,
            max_steps: Self::MAX_STEPS,
            method: Method::default(),
            stabilisation: Stabilisation::default(),
            rows: RowChoice::default(),
            threads: None,
        }
    }

    /// Checks the options of a run.
    ///
    /// # Errors
    /// - [`MotionError::Option`]: an option is not finite or out of range.
    /// - [`MotionError::Combination`]: method and stabilisation cannot be combined.
    pub fn check(&self) -> Result<(), MotionError> {
        let numbers = [
            ("t_end", self.t_end, self.t_end >= 0.0, "a finite time ≥ 0"),
            (
                "output_step",
                self.output_step,
                self.output_step > 0.0 || self.t_end == 0.0,
                "a time > 0",
            ),
            (
                "output_step",
                self.output_step,
                self.t_end / self.output_step <= Self::MOST_ROWS || self.t_end == 0.0,
                "at least t_end/1e7, because the table would have too many rows",
            ),
            (
                "rtol",
                self.rtol,
                Self::RTOL_RANGE.contains(&self.rtol),
                Self::RTOL_EXPECTED,
            ),
            ("atol", self.atol, self.atol > 0.0, "a number > 0"),
        ];
        let max_step = |expected| {
            Err(MotionError::Option {
                name: "max_step",
                value: self.max_step,
                expected,
            })
        };
        if self.max_step.is_nan() || self.max_step <= 0.0 {
            return max_step("a time > 0");
        }
        if self.t_end / self.max_step > self.max_steps as f64 {
            return max_step(
                "at least t_end/max_steps, because otherwise the run cannot reach its end",
            );
        }
        for (name, value, right, expected) in numbers {
            if !(right && value.is_finite()) {
                return Err(MotionError::Option {
                    name,
                    value,
                    expected,
                });
            }
        }
        self.check_combination()
    }

    /// Checks that method and stabilisation can be combined.
    fn check_combination(&self) -> Result<(), MotionError> {
        let projects = self.stabilisation == Stabilisation::Projection;
        if self.method.needs_independent_coordinates() && !projects {
            Err(MotionError::Combination {
                chosen: self.method.name(),
                with: self.stabilisation.name(),
                why: "the method relies on projection",
            })
        } else {
            Ok(())
        }
    }
}
