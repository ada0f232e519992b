//! Combinations of formulation, method, and treatment of drift.

/// The treatment of redundant rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formulation {
    /// Independent rows, selected at the initial state.
    KeptRows,
    /// Null-space method: a basis of the motions that C allows.
    NullSpace,
    /// All rows, solved by a complete orthogonal decomposition.
    MinimumNorm,
    /// All rows, solved by proximal iterations. The parameters are computed at the initial state
    /// for the tolerance of the run.
    Proximal,
}

impl Formulation {
    /// All formulations.
    pub const ALL: [Self; 4] = [
        Self::KeptRows,
        Self::NullSpace,
        Self::MinimumNorm,
        Self::Proximal,
    ];

    /// Returns the name of the formulation in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::KeptRows => "kept-rows",
            Self::NullSpace => "null-space",
            Self::MinimumNorm => "minimum-norm",
            Self::Proximal => "proximal",
        }
    }
}

/// The integration method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Dormand–Prince 8(5,3).
    Dop853,
    /// Dormand–Prince 5(4).
    Dopri5,
    /// Tsitouras 5(4).
    Tsit5,
    /// Extrapolated midpoint rule, order 4 to 18.
    Gbs,
    /// Generalized-α for position constraints and independent rows, order 2. The formulation is
    /// used only for the initial accelerations and the accelerations in output rows.
    GeneralizedAlpha,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 5] = [
        Self::Dop853,
        Self::Dopri5,
        Self::Tsit5,
        Self::Gbs,
        Self::GeneralizedAlpha,
    ];

    /// Returns the name of the method in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Dop853 => "dop853",
            Self::Dopri5 => "dopri5",
            Self::Tsit5 => "tsit5",
            Self::Gbs => "gbs",
            Self::GeneralizedAlpha => "generalized-alpha",
        }
    }
}

/// The treatment of drift from the constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drift {
    /// States are projected in the mass metric after each step.
    Projection,
    /// Baumgarte stabilisation: `Γ − 2α·(C·v − b) − β²·Φ`, and `Γ − α·(C·v − b)` for nonholonomic
    /// rows.
    Baumgarte {
        /// Gain α (1/s).
        alpha: f64,
        /// Gain β (1/s).
        beta: f64,
    },
    /// No treatment of drift.
    None,
}

impl Drift {
    /// Baumgarte stabilisation with gains of 5/s.
    pub const BAUMGARTE: Self = Self::Baumgarte {
        alpha: 5.0,
        beta: 5.0,
    };

    /// All treatments of drift.
    pub const ALL: [Self; 3] = [Self::Projection, Self::BAUMGARTE, Self::None];

    /// Returns the name of the treatment in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Projection => "projection",
            Self::Baumgarte { .. } => "baumgarte",
            Self::None => "none",
        }
    }
}

/// A combination of formulation, method, and treatment of drift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparator {
    /// Treatment of redundancy.
    pub formulation: Formulation,
    /// Integrator.
    pub method: Method,
    /// Treatment of drift.
    pub drift: Drift,
}
