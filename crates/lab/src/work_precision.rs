//! Error against run time: the methods of the product and the comparators, on a case of the suite
//! or on a scene, in the rows of one table.

use std::time::Duration;

use pfaff::StudyError;
use pfaff::report::{CurveName, WorkPrecisionRow};
use pfaff::work_precision::{Observation, Plan, Subject, Yardstick};

use crate::comparators::{Drift, Formulation, Method, Run, Way, run_within};

/// The ways that are compared beside those of the product: every method on kept rows with
/// projection, and by one of them every formulation and every treatment of drift.
#[must_use]
pub fn ways() -> Vec<Way> {
    let way = |formulation, method, drift| Way {
        formulation,
        method,
        drift,
    };
    let (kept, projected) = (Formulation::KeptRows, Drift::Projection);
    let own = [Method::Gbs, Method::GeneralizedAlpha].map(|m| way(kept, m, projected));
    let others = Formulation::ALL.map(|f| way(f, Method::Dop853, projected));
    let pulled = way(kept, Method::Dop853, Drift::BAUMGARTE);
    // Kept rows by the same method are the product's own curve.
    let others = others.into_iter().filter(|w| w.formulation != kept);
    own.into_iter().chain(others).chain([pulled]).collect()
}

/// All runs of a plan by the product, then the comparators at the same tolerances. A comparator
/// that does not reach its end has a row that says why.
///
/// # Errors
/// As [`Subject::compare`].
pub fn work_precision(subject: &Subject, plan: &Plan) -> Result<Vec<WorkPrecisionRow>, StudyError> {
    let product = subject.compare::<StudyError>(plan, &|| false, |_| Ok(()))?;
    let yardstick = subject.yardstick(plan)?;
    let mut rows = product.scene.rows;
    for way in ways() {
        for &tolerance in &plan.tolerances {
            rows.push(row(subject, plan, &yardstick, way, tolerance));
        }
    }
    Ok(rows)
}

fn row(
    subject: &Subject,
    plan: &Plan,
    yardstick: &Yardstick,
    way: Way,
    tolerance: f64,
) -> WorkPrecisionRow {
    let curve = CurveName {
        formulation: way.formulation.name(),
        method: way.method.name(),
        stabilisation: way.drift.name(),
    };
    let empty = WorkPrecisionRow {
        reference_limit: yardstick.limit(),
        ..WorkPrecisionRow::empty(subject.name(), curve, tolerance)
    };
    let budget = Duration::try_from_secs_f64(plan.budget).unwrap_or(Duration::MAX);
    let mut best: Option<Run> = None;
    let (mut repetitions, mut total) = (0, 0.0);
    while repetitions < plan.repetitions.max(1) || total < plan.seconds {
        let made = run_within(
            subject.prepared(),
            way,
            tolerance,
            subject.instants(),
            budget,
        );
        match made {
            Ok(made) => {
                (repetitions, total) = (repetitions + 1, total + made.seconds);
                if best.as_ref().is_none_or(|best| made.seconds < best.seconds) {
                    best = Some(made);
                }
            }
            Err(fault) => {
                return WorkPrecisionRow {
                    status: format!("stopped: {fault}"),
                    ..empty
                };
            }
        }
    }
    let Some(best) = best else { return empty };
    let motion: Vec<Observation> = best
        .rows
        .iter()
        .map(|r| Observation::new(r.t, [r.q.clone(), r.v.clone(), r.a.clone()], &r.reactions))
        .collect();
    let errors = yardstick.errors(&motion);
    WorkPrecisionRow {
        errors: errors.map_or([f64::NAN; 4], |e| e.scaled),
        error_state: errors.map_or(f64::NAN, |e| e.state),
        evaluations: best.evaluations,
        projections: best.projections,
        steps: best.steps - best.rejected,
        rejected: best.rejected,
        seconds: best.seconds,
        repetitions,
        ..empty
    }
}
