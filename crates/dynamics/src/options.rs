//! What a run is asked to do.

#[cfg(test)]
mod tests;

use std::num::NonZeroUsize;
use std::ops::RangeInclusive;

use crate::error::MotionError;

/// How the equations of motion are integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// Dormand–Prince 8(5,3), or Radau IIA where forces make the motion stiff at its start.
    #[default]
    Auto,
    /// Dormand–Prince 5(4), the method of MATLAB's `ode45`.
    Dopri5,
    /// Tsitouras 5(4).
    Tsit5,
    /// Dormand–Prince 8(5,3).
    Dop853,
    /// Extrapolated midpoint rule of variable order, for very tight tolerances.
    Gbs,
    /// Radau IIA of order 5 on independent coordinates, for stiff forces.
    Radau5,
    /// Generalized-α on positions with ρ∞ = 0.8, order 2: for stiff forces at low accuracy.
    GeneralizedAlpha,
}

impl Method {
    /// All that can be asked for.
    pub const ALL: &[Self] = &[
        Self::Auto,
        Self::Dopri5,
        Self::Dop853,
        Self::Tsit5,
        Self::Gbs,
        Self::Radau5,
        Self::GeneralizedAlpha,
    ];

    /// Its name in scenes and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Dopri5 => "dopri5",
            Self::Tsit5 => "tsit5",
            Self::Dop853 => "dop853",
            Self::Gbs => "gbs",
            Self::Radau5 => "radau5",
            Self::GeneralizedAlpha => "generalized-alpha",
        }
    }

    /// Whether it needs the Jacobian of the motion, which only independent coordinates have.
    #[must_use]
    pub fn needs_independent_coordinates(self) -> bool {
        self == Self::Radau5
    }
}

/// How redundant rows are dealt with. The motion is the same; reactions that are not unique are not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Formulation {
    /// r independent rows are kept, the others only monitored.
    #[default]
    KeptRows,
    /// The same rows give dependent coordinates and velocities; the motion is one of the independent ones alone. Nothing drifts, and
    /// nothing is stabilised.
    NullSpace,
    /// All rows by a complete orthogonal decomposition of locked rank; of all reactions those with the least
    /// `Σ F² + T²` (N, N·m).
    MinimumNorm,
    /// All rows by proximal iterations, tuned once to the relative tolerance of the run.
    Proximal,
}

impl Formulation {
    /// All that can be asked for.
    pub const ALL: &[Self] = &[
        Self::KeptRows,
        Self::NullSpace,
        Self::MinimumNorm,
        Self::Proximal,
    ];

    /// Its name in scenes and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::KeptRows => "kept-rows",
            Self::NullSpace => "null-space",
            Self::MinimumNorm => "minimum-norm",
            Self::Proximal => "proximal",
        }
    }

    /// Whether reactions in dropped rows are zero by decree.
    #[must_use]
    pub fn drops_rows(self) -> bool {
        match self {
            Self::KeptRows | Self::NullSpace => true,
            Self::MinimumNorm | Self::Proximal => false,
        }
    }
}

/// How drift off the constraints is prevented.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Stabilisation {
    /// Position and velocity are projected in the mass metric after each step.
    #[default]
    Projection,
    /// Accelerations pull back what has drifted: `Γ − 2α·(C·v − b) − β²·Φ`, and `Γ − α·(C·v − b)` for nonholonomic rows. Nothing is projected;
    /// residuals show what is left.
    Baumgarte {
        /// α (1/s)
        alpha: f64,
        /// β (1/s)
        beta: f64,
    },
    /// None. Residuals show the drift.
    None,
}

impl Stabilisation {
    /// Baumgarte's method with the gains that are used where none are given.
    pub const BAUMGARTE: Self = Self::Baumgarte {
        alpha: 5.0,
        beta: 5.0,
    };

    /// All that can be asked for, with the usual gains.
    pub const ALL: &[Self] = &[Self::Projection, Self::BAUMGARTE, Self::None];

    /// Its name in scenes and results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Projection => "projection",
            Self::Baumgarte { .. } => "baumgarte",
            Self::None => "none",
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
    /// Largest step (s); infinite where error control alone decides.
    pub max_step: f64,
    /// Accepted and rejected steps of a component at most.
    pub max_steps: u64,
    /// Integrator.
    pub method: Method,
    /// Treatment of redundancy.
    pub formulation: Formulation,
    /// Treatment of drift.
    pub stabilisation: Stabilisation,
    /// Rows to keep: what [`crate::prepare()`] is given. A run has the rows of its [`crate::Prepared`].
    pub rows: RowChoice,
    /// Components that compute at the same time, where there are several; all of them if nothing is said. Results do not depend on it.
    pub threads: Option<NonZeroUsize>,
}

impl MotionOptions {
    /// Output steps of a run where none is given.
    pub const OUTPUT_STEPS: f64 = 200.0;
    /// Relative tolerance where none is given.
    pub const RTOL: f64 = 1e-8;
    /// Absolute tolerance where none is given.
    pub const ATOL: f64 = 1e-10;
    /// Relative tolerances that can be asked for: below, rounding of a step is larger; above, its error is no longer small.
    pub const RTOL_RANGE: RangeInclusive<f64> = 1e-15..=0.1;
    /// That in words.
    pub const RTOL_EXPECTED: &str = "a number from 1e-15 (rounding) to 0.1";
    /// Most rows of output: a hundred bodies of six numbers then take some 100 GB.
    pub const MOST_ROWS: f64 = 1e7;
    /// Accepted and rejected steps at most, where no other limit is given.
    pub const MAX_STEPS: u64 = 1_000_000;

    /// Whether the motion is one of independent coordinates alone.
    #[must_use]
    pub fn is_on_chart(&self) -> bool {
        self.formulation == Formulation::NullSpace || self.method.needs_independent_coordinates()
    }

    /// The defaults for a run to `t_end`.
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
            formulation: Formulation::default(),
            stabilisation: Stabilisation::default(),
            rows: RowChoice::default(),
            threads: None,
        }
    }

    /// Whether these options can be those of a run.
    ///
    /// # Errors
    /// - [`MotionError::Option`]: one is not finite or out of range.
    /// - [`MotionError::Combination`]: method, formulation and stabilisation do not go together.
    /// - [`MotionError::NothingToDrop`]: rows are dropped, but the formulation uses all.
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
                "at least t_end/1e7: more rows are too many to write",
            ),
            (
                "rtol",
                self.rtol,
                Self::RTOL_RANGE.contains(&self.rtol),
                Self::RTOL_EXPECTED,
            ),
            ("atol", self.atol, self.atol > 0.0, "a number > 0"),
        ];
        let gains = match self.stabilisation {
            Stabilisation::Baumgarte { alpha, beta } => [alpha, beta],
            Stabilisation::Projection | Stabilisation::None => [0.0; 2],
        };
        let gains = gains.map(|gain| {
            (
                "a gain of baumgarte",
                gain,
                gain >= 0.0,
                "a number ≥ 0 (1/s)",
            )
        });
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
            return max_step("at least t_end/max_steps: the run would never end");
        }
        for (name, value, right, expected) in numbers.into_iter().chain(gains) {
            if !(right && value.is_finite()) {
                return Err(MotionError::Option {
                    name,
                    value,
                    expected,
                });
            }
        }
        self.check_combination()?;
        self.check_rows(&self.rows)
    }

    /// Whether method, formulation and stabilisation go together.
    fn check_combination(&self) -> Result<(), MotionError> {
        let method = self.method;
        let combination = |with, why| {
            Err(MotionError::Combination {
                chosen: self.formulation.name(),
                with,
                why,
            })
        };
        let has_own_equations = matches!(method, Method::Radau5 | Method::GeneralizedAlpha);
        if has_own_equations && !self.formulation.drops_rows() {
            return combination(method.name(), "the method solves equations on kept rows");
        }
        if method == Method::GeneralizedAlpha && self.formulation == Formulation::NullSpace {
            // Velocities miss their constraints by h² there. Completing them from independent ones changes the speed by as much, and the
            // method has order 1; a projection in the mass metric does not.
            return combination(
                method.name(),
                "the method integrates all coordinates, and only a projection in the mass metric keeps its order: use kept-rows",
            );
        }
        if self.stabilisation == Stabilisation::Projection {
            return Ok(());
        }
        if self.formulation == Formulation::NullSpace {
            return combination(self.stabilisation.name(), "nothing drifts there");
        }
        match has_own_equations {
            true => Err(MotionError::Combination {
                chosen: method.name(),
                with: self.stabilisation.name(),
                why: "the method relies on projection",
            }),
            false => Ok(()),
        }
    }

    /// Whether rows that the user dropped have a meaning.
    pub(crate) fn check_rows(&self, rows: &RowChoice) -> Result<(), MotionError> {
        match rows {
            RowChoice::Drop(_) if !self.formulation.drops_rows() => {
                Err(MotionError::NothingToDrop {
                    formulation: self.formulation.name(),
                })
            }
            _ => Ok(()),
        }
    }
}
