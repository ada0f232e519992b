//! What a run is asked to do.

use crate::error::MotionError;

/// How the equations of motion are integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// Dormand–Prince 5(4), the method of MATLAB's `ode45`.
    #[default]
    Dopri5,
    /// Tsitouras 5(4).
    Tsit5,
    /// Dormand–Prince 8(5,3).
    Dop853,
}

impl Method {
    /// Its name in scenes and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Dopri5 => "dopri5",
            Self::Tsit5 => "tsit5",
            Self::Dop853 => "dop853",
        }
    }
}

/// How redundant rows are dealt with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Formulation {
    /// r independent rows are kept, the others only monitored.
    #[default]
    KeptRows,
}

impl Formulation {
    /// Its name in scenes and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::KeptRows => "kept-rows",
        }
    }
}

/// How drift off the constraints is prevented.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stabilisation {
    /// Position and velocity are projected in the mass metric after each step.
    #[default]
    Projection,
}

impl Stabilisation {
    /// Its name in scenes and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Projection => "projection",
        }
    }
}

/// Which rows are kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum RowChoice {
    /// The rank decision chooses well-conditioned ones.
    #[default]
    Automatic,
    /// All but these rows, counted from 0.
    Drop(Vec<usize>),
}

/// What a run is asked to do.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionOptions {
    /// Last time (s); the first is 0.
    pub t_end: f64,
    /// Time between written rows (s).
    pub output_step: f64,
    /// Relative tolerance of the step control.
    pub rtol: f64,
    /// Absolute tolerance of the step control.
    pub atol: f64,
    /// Integrator.
    pub method: Method,
    /// Treatment of redundancy.
    pub formulation: Formulation,
    /// Treatment of drift.
    pub stabilisation: Stabilisation,
    /// Rows to keep: what [`crate::prepare()`] is given. A run has the rows of its [`crate::Prepared`].
    pub rows: RowChoice,
}

impl MotionOptions {
    /// Output steps of a run where none is given.
    pub const OUTPUT_STEPS: f64 = 200.0;
    /// Relative tolerance where none is given.
    pub const RTOL: f64 = 1e-8;
    /// Absolute tolerance where none is given.
    pub const ATOL: f64 = 1e-10;

    /// The defaults for a run to `t_end`.
    #[must_use]
    pub fn to(t_end: f64) -> Self {
        Self {
            t_end,
            output_step: t_end / Self::OUTPUT_STEPS,
            rtol: Self::RTOL,
            atol: Self::ATOL,
            method: Method::default(),
            formulation: Formulation::default(),
            stabilisation: Stabilisation::default(),
            rows: RowChoice::default(),
        }
    }

    /// Whether these numbers can be those of a run.
    ///
    /// # Errors
    /// [`MotionError::Option`]: one is not finite or out of range.
    pub fn check(&self) -> Result<(), MotionError> {
        let numbers = [
            ("t_end", self.t_end, self.t_end >= 0.0, "a finite time ≥ 0"),
            (
                "output_step",
                self.output_step,
                self.output_step > 0.0 || self.t_end == 0.0,
                "a time > 0",
            ),
            ("rtol", self.rtol, self.rtol > 0.0, "a number > 0"),
            ("atol", self.atol, self.atol > 0.0, "a number > 0"),
        ];
        for (name, value, right, expected) in numbers {
            if !(right && value.is_finite()) {
                return Err(MotionError::Option {
                    name,
                    value,
                    expected,
                });
            }
        }
        Ok(())
    }
}
