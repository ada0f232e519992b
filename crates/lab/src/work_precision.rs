//! Compares error and run time of the reference methods and of the methods of pfaff. Cases of the
//! suite are scenes with a known motion.

use std::time::Duration;

use dynamics::PreparedMechanism;
use pfaff::model::Registry;
use pfaff::report::CurveName;
use pfaff::work_precision::{
    Kind, Observation, Reference, ReferenceInstant, Rival, RivalFault, RivalRun, Subject,
};
use pfaff::{RunOptions, Study, StudyError};
use suite::{Case, Quantity};

use crate::comparators::{Comparator, Drift, Fault, Formulation, Method, run_within};

/// Returns the combinations that are compared with the methods of pfaff: every method with
/// independent rows and projection, and one method with every formulation and every treatment of
/// drift.
#[must_use]
pub fn ways() -> Vec<Comparator> {
    let way = |formulation, method, drift| Comparator {
        formulation,
        method,
        drift,
    };
    let (kept, projected) = (Formulation::KeptRows, Drift::Projection);
    let own = [Method::Gbs, Method::GeneralizedAlpha].map(|m| way(kept, m, projected));
    let others = Formulation::ALL.map(|f| way(f, Method::Dop853, projected));
    let pulled = way(kept, Method::Dop853, Drift::BAUMGARTE);
    // For this method, the curves of pfaff already contain a curve with independent rows.
    let others = others.into_iter().filter(|w| w.formulation != kept);
    own.into_iter().chain(others).chain([pulled]).collect()
}

/// Returns a case of the suite, with the known values of its motion.
///
/// # Errors
/// Returns the errors of [`Study::read`].
pub fn of_case(case: &Case) -> Result<Subject, StudyError> {
    let registry = Registry::standard();
    let study = Study::read(case.name, case.scene, &registry, &RunOptions::default())?;
    let known = case.reference();
    let instants = known.instants.iter().map(|instant| {
        let mut values: [Vec<(usize, f64)>; Kind::COUNT] = Default::default();
        for fact in &instant.facts {
            let (kind, name) = named(fact.quantity);
            let place = kind.place(&fact.of, name, &study.prepared.mechanism);
            values[kind as usize].extend(place.map(|place| (place, fact.value)));
        }
        ReferenceInstant {
            t: instant.t,
            values,
        }
    });
    let reference = Reference {
        instants: instants.collect(),
        limits: suite::Kind::ALL.map(|kind| known.trust.of(kind)),
        source: known.source,
    };
    Subject::known(study, case.title, reference)
}

/// Returns the name of a quantity of the suite in a mechanism.
fn named(quantity: Quantity) -> (Kind, &'static str) {
    match quantity {
        Quantity::X => (Kind::Position, "x"),
        Quantity::Y => (Kind::Position, "y"),
        Quantity::Angle => (Kind::Position, "angle"),
        Quantity::Vx => (Kind::Velocity, "x"),
        Quantity::Vy => (Kind::Velocity, "y"),
        Quantity::Omega => (Kind::Velocity, "angle"),
        Quantity::Ax => (Kind::Acceleration, "x"),
        Quantity::Ay => (Kind::Acceleration, "y"),
        Quantity::Alpha => (Kind::Acceleration, "angle"),
        Quantity::Fx => (Kind::Reaction, "Fx"),
        Quantity::Fy => (Kind::Reaction, "Fy"),
        Quantity::Torque => (Kind::Reaction, "T"),
        Quantity::Normal => (Kind::Reaction, "N"),
    }
}

impl Rival for Comparator {
    fn name(&self) -> CurveName {
        CurveName {
            formulation: self.formulation.name(),
            method: self.method.name(),
            stabilisation: self.drift.name(),
        }
    }

    fn run(
        &self,
        start: &PreparedMechanism,
        tolerance: f64,
        instants: &[f64],
        budget: Duration,
    ) -> Result<RivalRun, RivalFault> {
        let made = run_within(start, *self, tolerance, instants, budget);
        let made = made.map_err(|fault| match fault {
            Fault::TooLong { .. } => RivalFault::GivenUp(fault.to_string()),
            _ => RivalFault::Stopped(fault.to_string()),
        })?;
        let (space, rows) = (start.mechanism.space(), made.rows.into_iter());
        Ok(RivalRun {
            observations: rows
                .map(|r| Observation::new(space, r.t, [r.q, r.v, r.a], &r.reactions))
                .collect(),
            evaluations: made.evaluations,
            projections: made.projections,
            steps: made.steps - made.rejected,
            rejected: made.rejected,
            seconds: made.seconds,
        })
    }
}
