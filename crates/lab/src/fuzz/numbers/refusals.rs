//! (d): mechanisms that the product refuses, and runs that it stops. Is there a reason?

use dynamics::MotionError;
use integrators::IntegrationError;
use model::{Mechanism, Registry, System};
use nalgebra::{DMatrix, DVector};
use pfaff::{AssembledScene, StudyError};

use super::decomposition::Decomposition;
use super::findings::{Count, Findings, Kind};
use super::moves::{marches, moves, ranks};
use super::oracle::{Fault, Instant, inverse};
use super::run::{Row, Run};
use crate::numbers::Numbers;

/// How long the motion is to go on where a run stopped (s).
const AFTER: f64 = 1e-3;

/// Velocities are possible if all rows hold to this share of their terms.
const POSSIBLE: f64 = 1e-9;

/// A mechanism that is refused.
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
        // The start is consistent as it is described.
        Err(_) => return findings.note(Kind::Refused, format!("not assembled: {error}")),
    };
    let mechanism = &assembled.mechanism;
    let [here, near] = ranks(mechanism, (0.0, &q), numbers);
    if here < near {
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

/// Whether there are velocities with the given ones. They are those of `angular_velocity` about the
/// normal of the plane, and in space all three.
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

/// A run that stopped.
pub(super) fn on_the_way(
    run: &Run,
    error: &MotionError,
    numbers: &mut Numbers,
    findings: &mut Findings,
) {
    let mechanism = &run.study.prepared.mechanism;
    let Some(row) = run.rows.last() else {
        let state = (0.0, &run.study.prepared.q[..]);
        let [here, near] = ranks(mechanism, state, numbers);
        if here < near {
            findings.count(Count::SingularStart, 1);
        } else if moves(mechanism, state, numbers) {
            findings.note(Kind::Refused, format!("at the start: {error}"));
        } else {
            findings.count(Count::DoesNotMove, 1);
        }
        return;
    };
    if matches!(error, MotionError::Integration(e) if matches!(**e, IntegrationError::TooManySteps { .. }))
    {
        return findings.count(Count::Cut, 1);
    }
    let is_singular = is_near_singular(mechanism, row) || {
        let [here, near] = ranks(mechanism, (row.t_before, &row.q), numbers);
        here < near
    };
    // From rest the motion goes anywhere, later on as it went.
    let goes_on = if row.t == 0.0 {
        moves(mechanism, (0.0, &row.q), numbers)
    } else {
        marches(
            mechanism,
            (row.t, &row.q, &row.v),
            run.reached - row.t + AFTER,
        )
    };
    if is_singular || !goes_on {
        findings.count(Count::Stopped, 1);
    } else {
        let text = format!("stopped after t = {} s: {error}", row.t);
        findings.note(Kind::Refused, text);
    }
}

fn is_near_singular(mechanism: &Mechanism, row: &Row) -> bool {
    match Instant::new(mechanism, (row.t_before, &row.q, &row.v)) {
        Ok(instant) => instant.sigma < 1e-3,
        Err(fault) => fault == Fault::Unclear,
    }
}
