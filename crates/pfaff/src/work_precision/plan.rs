//! The runs of a comparison.

use dynamics::{FORMULATION, Method, Stabilisation};
use report::CurveName;

/// A way to simulate a mechanism. Over all tolerances, it gives a curve of error against time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Integrator.
    pub method: Method,
    /// Method against constraint drift.
    pub stabilisation: Stabilisation,
}

impl Curve {
    /// Returns the names of the curve in tables.
    #[must_use]
    pub fn name(&self) -> CurveName {
        CurveName {
            formulation: FORMULATION,
            method: self.method.name(),
            stabilisation: self.stabilisation.name(),
        }
    }
}

/// Returns the methods that are compared. These are all methods except the automatic choice.
fn methods() -> impl Iterator<Item = Method> {
    Method::ALL.iter().copied().filter(|m| *m != Method::Auto)
}

/// The explicit method with which stabilisations are compared.
const EXPLICIT: Method = Method::Dop853;

/// Stabilisation in the comparison of methods.
const STABILISATION: Stabilisation = Stabilisation::Projection;

/// Exact powers of ten.
const TOLERANCES: [f64; 11] = [
    1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13,
];

/// Methods whose order is high enough for a reference.
pub(super) const ACCURATE: [Method; 4] = [
    Method::Dop853,
    Method::Radau5,
    Method::Tsit5,
    Method::Dopri5,
];

/// The runs of a comparison, the same for every scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparisonPlan {
    /// The curves.
    pub curves: Vec<Curve>,
    /// Tolerances. Each value is both the relative and the absolute tolerance. The loosest
    /// tolerance comes first.
    pub tolerances: Vec<f64>,
    /// Smallest number of timed runs.
    pub repetitions: u32,
    /// Smallest total time of these runs (s).
    pub seconds: f64,
    /// Largest time of a run (s). If a run takes longer, this run and the runs of the same curve
    /// with tighter tolerances are abandoned.
    pub budget: f64,
}

impl ComparisonPlan {
    /// The plan has every method with projection, and one explicit method with every stabilisation.
    /// The tolerances are 1e-3, 1e-4, … 1e-13.
    #[must_use]
    pub fn standard() -> Self {
        let curves = everything()
            .into_iter()
            .filter(|curve| curve.method == EXPLICIT || curve.stabilisation == STABILISATION);
        Self {
            curves: curves.collect(),
            tolerances: TOLERANCES.to_vec(),
            repetitions: 3,
            seconds: 0.02,
            budget: 10.0,
        }
    }

    /// The plan has the same curves at three tolerances, for a first impression.
    #[must_use]
    pub fn quick() -> Self {
        Self {
            tolerances: vec![1e-4, 1e-7, 1e-10],
            seconds: 0.0,
            budget: 1.0,
            ..Self::standard()
        }
    }

    /// The plan has every method with every stabilisation.
    #[must_use]
    pub fn everything() -> Self {
        Self {
            curves: everything(),
            ..Self::standard()
        }
    }

    /// Returns the number of runs for each scene.
    #[must_use]
    pub fn runs(&self) -> usize {
        self.curves.len() * self.tolerances.len()
    }

    /// Returns the curve of a method in the comparison of methods.
    pub(super) fn usual(method: Method) -> Curve {
        Curve {
            method,
            stabilisation: STABILISATION,
        }
    }
}

/// Returns all curves. The methods come first, then the stabilisations that are compared with one
/// method.
fn everything() -> Vec<Curve> {
    let mut curves: Vec<Curve> = methods().map(ComparisonPlan::usual).collect();
    for method in methods() {
        for &stabilisation in Stabilisation::ALL {
            let curve = Curve {
                method,
                stabilisation,
            };
            if !curves.contains(&curve) {
                curves.push(curve);
            }
        }
    }
    curves
}
