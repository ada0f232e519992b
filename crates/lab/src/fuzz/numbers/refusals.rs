//! Test (d): checks whether the product has a valid reason to reject a mechanism or to stop a run.

use dynamics::MotionError;
use integrators::IntegrationError;
use model::{Mechanism, Registry, System};
use nalgebra::{DMatrix, DVector};
use pfaff::{AssembledScene, StudyError};

use super::decomposition::Decomposition;
use super::findings::{Count, Findings, Kind};
use super::moves::{march, marches, moves, ranks};
use super::oracle::{Instant, inverse};
use super::run::Run;
use super::second_order::SecondOrder;
use suite::numbers::Numbers;

/// Time for which the motion must continue after a stopped run (s).
const AFTER: f64 = 1e-3;

/// Velocities are possible if the residuals of all rows are below this fraction of their terms.
const POSSIBLE: f64 = 1e-9;

/// Examines a mechanism that is rejected.
pub(super) fn at_start(
    text: &str,
    error: &StudyError,
    numbers: &mut Numbers,
    findings: &mut Findings,
) {
    let Ok(mut assembled) = AssembledScene::read("scene.toml", text, &Registry::standard()) else {
        return findings.count(Count::NoScene, 1);
    };
    let q = match assembled.assemble() {
        Ok(assembly) => assembly.q,
        // The described initial state is consistent, so it is an error of the product if the
        // mechanism is not assembled.
        Err(_) => return findings.note(Kind::Refused, format!("not assembled: {error}")),
    };
    let mechanism = &assembled.mechanism;
    if is_singular(mechanism, (0.0, &q), numbers) {
        return findings.count(Count::SingularStart, 1);
    }
    if !has_velocities(mechanism, &q) {
        return findings.count(Count::NoVelocities, 1);
    }
    if moves(mechanism, (0.0, &q), numbers) {
        findings.note(Kind::Refused, error.to_string());
    } else {
        findings.count(Count::DoesNotMove, 1);
    }
}

/// Whether possible velocities with the given values exist. The given values are the values of
/// `angular_velocity`: one value in the plane, three values in space.
fn has_velocities(mechanism: &Mechanism, q: &[f64]) -> bool {
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, q, &mut s);
    mechanism.c(&mut s);
    mechanism.b(&mut s);
    let (c, n) = (mechanism.layout().dense(&s), mechanism.layout().n_v);
    let mut rows: Vec<(Vec<f64>, f64)> = (0..c.nrows())
        .map(|i| (c.row(i).to_vec(), s.b[i]))
        .collect();
    for (column, value) in mechanism.frames().given_velocities(q).iter().enumerate() {
        let mut row = vec![0.0; n];
        row[column] = 1.0;
        rows.extend(value.map(|value| (row, value)));
    }
    let a = DMatrix::from_fn(rows.len(), n, |i, j| {
        rows[i].0[j] * inverse(DVector::from_column_slice(&rows[i].0).norm())
    });
    let b = DVector::from_fn(rows.len(), |i, _| {
        rows[i].1 * inverse(DVector::from_column_slice(&rows[i].0).norm())
    });
    let v = Decomposition::of(&a).above(1e-9).solve(&b);
    (a * v - &b).norm() <= POSSIBLE * b.norm().max(1.0)
}

/// Examines a run that stopped.
pub(super) fn on_the_way(
    run: &Run,
    error: &MotionError,
    numbers: &mut Numbers,
    findings: &mut Findings,
) {
    let mechanism = &run.study.prepared.mechanism;
    let Some(row) = run.rows.last() else {
        let at = (0.0, &run.study.prepared.q[..]);
        let reason = match error {
            MotionError::NoFiniteReaction(found) if found.decided && is_finite(run) => None,
            MotionError::NoFiniteReaction(_) => Some(Count::NoFinite),
            _ if is_singular(mechanism, at, numbers) => Some(Count::SingularStart),
            _ if moves(mechanism, at, numbers) => None,
            _ => Some(Count::DoesNotMove),
        };
        return match reason {
            Some(reason) => findings.count(reason, 1),
            None => findings.note(Kind::Refused, format!("at the start: {error}")),
        };
    };
    if matches!(error, MotionError::Integration(e) if matches!(**e, IntegrationError::TooManySteps { .. }))
    {
        return findings.count(Count::Cut, 1);
    }
    let (state, left) = ((row.t, &row.q[..], &row.v[..]), run.reached - row.t);
    let is_singular = is_near_singular(mechanism, (row.t_before, &row.q))
        || is_singular(mechanism, (row.t_before, &row.q), numbers)
        || march(mechanism, state, left)
            .is_some_and(|q| is_near_singular(mechanism, (run.reached, &q)));
    // The motion may continue with the present velocity or, from rest, along any free motion.
    let is_at_rest = row.v.iter().all(|v| *v == 0.0);
    let goes_on = marches(mechanism, state, left + AFTER)
        && (!is_at_rest || moves(mechanism, (row.t, &row.q), numbers));
    if is_singular || !goes_on {
        findings.count(Count::Stopped, 1);
    } else {
        let text = format!("stopped after t = {} s: {error}", row.t);
        findings.note(Kind::Refused, text);
    }
}

/// Whether the accelerations at the initial state satisfy the second-order equations.
fn is_finite(run: &Run) -> bool {
    let prepared = &run.study.prepared;
    let (mechanism, at) = (&prepared.mechanism, (0.0, &prepared.q[..]));
    let instant = Instant::new(mechanism, (0.0, &prepared.q, &prepared.v));
    let order = SecondOrder::at(mechanism, at);
    match (instant, order) {
        (Ok(instant), Some(mut order)) => order.holds(&instant.acceleration),
        _ => false,
    }
}

/// Whether a configuration is singular: the rank is lower than at neighbouring configurations, or
/// the second-order conditions exclude a motion that all rows allow to first order.
fn is_singular(mechanism: &Mechanism, at: (f64, &[f64]), numbers: &mut Numbers) -> bool {
    let [here, near] = ranks(mechanism, at, numbers);
    here < near || SecondOrder::at(mechanism, at).is_none_or(|mut o| o.is_restricted(numbers))
}

/// Whether a configuration is near a configuration of lower rank. The result does not depend on
/// velocities.
fn is_near_singular(mechanism: &Mechanism, at: (f64, &[f64])) -> bool {
    SecondOrder::at(mechanism, at).is_none_or(|order| order.sigma() < 1e-3)
}
