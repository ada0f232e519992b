//! Is a redundancy permanent, or only of this configuration? The rank is constant on each connected component of the
//! configuration set except on a nowhere dense part of it, so a few other points of the same component tell.
//!
//! Drives are left free while the mechanism is moved to these points: what they prescribe changes with time.

use linalg::{Matrix, PivotedQr, RankDecision};
use model::start::{nearest_configuration, scene_size};
use model::{Mechanism, System};

use crate::mechanism::decide;

/// Points tried.
const POINTS: usize = 2;

/// How far they are: a share of the scene's size, or as many radians.
const DISTANCE: f64 = 0.15;

/// Each point is tried at this many halved distances, because not every displacement can be assembled again.
const HALVINGS: i32 = 5;

/// Whether the degree of redundancy is the same at other configurations. `None` if no other configuration was found, or a rank is
/// undecided.
#[must_use]
pub fn is_permanent(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
) -> Option<bool> {
    let layout = mechanism.layout();
    let rows: Vec<usize> = layout
        .groups
        .iter()
        .filter(|g| !g.spec.rheonomic)
        .flat_map(|g| g.rows.clone())
        .filter(|row| *row < layout.m)
        .collect();
    let directions = free_directions(mechanism, t, q, &rows)?;
    let size = scene_size(mechanism, q);
    for point in 0..POINTS {
        let step = mixed(&directions, point);
        let largest = (0..step.len())
            .map(|k| step[k].abs() / if k % 3 == 2 { 1.0 } else { size })
            .fold(0.0, f64::max);
        let other = (0..HALVINGS).find_map(|halving| {
            let length = DISTANCE * 0.5_f64.powi(halving) / largest;
            let moved: Vec<f64> = q.iter().zip(&step).map(|(q, d)| q + length * d).collect();
            nearest_configuration(mechanism, t, &rows, &moved).ok()
        })?;
        let mut s = mechanism.scratch();
        mechanism.pose(t, &other, &mut s);
        mechanism.phi(&mut s);
        mechanism.c(&mut s);
        // Drives were left free: their rows say nothing of this configuration.
        for i in (0..layout.m).filter(|i| !rows.contains(i)) {
            s.phi[i] = 0.0;
        }
        let there = decide(mechanism, &s, &other).ok()?;
        if !(decision.is_decided() && there.is_decided()) {
            return None;
        }
        if there.redundancy != decision.redundancy {
            return Some(false);
        }
    }
    Some(true)
}

/// Basis of the velocities that these rows of Φq allow, one in each row; `None` if there are none.
fn free_directions(mechanism: &Mechanism, t: f64, q: &[f64], rows: &[usize]) -> Option<Matrix> {
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.c(&mut s);
    let phi_q = mechanism.layout().dense(&s).select_rows(rows);
    let n = phi_q.ncols();
    let rank = linalg::decide(&phi_q, 0.0).ok()?.rank;
    let basis = PivotedQr::of_rows(phi_q).q_columns(rank..n);
    (rank < n).then(|| basis.transpose())
}

/// A combination of all directions with coefficients that do not repeat: the fractional parts of multiples of the golden ratio.
fn mixed(directions: &Matrix, point: usize) -> Vec<f64> {
    let golden = 0.618_033_988_749_894_9;
    let mut sum = vec![0.0; directions.ncols()];
    for i in 0..directions.nrows() {
        let place = (point * directions.nrows() + i + 1) as f64;
        let coefficient = (golden * place).fract() - 0.5;
        for (s, d) in sum.iter_mut().zip(directions.row(i)) {
            *s += coefficient * d;
        }
    }
    sum
}
