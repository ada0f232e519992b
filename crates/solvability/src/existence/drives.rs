//! Finds drives that cannot follow their prescribed motion, at one configuration and along the
//! motion. The rank decision prefers rows of joints to rows of drives. If a redundant row can be a
//! row of a drive, a row of a drive is chosen. The violated row then belongs to a drive. Therefore
//! no joint is named as the cause, for any difference of the drives.

use std::cell::OnceCell;

use crate::error::AnalysisError;
use crate::limits::{DRIVE_HALVINGS, DRIVE_POSITIONS, DRIVE_STEPS, ONE_PART, RUNS_NOTICE, STRIDE};
use model::start::{Metric, nearest_configuration, scene_size};
use model::{ConstraintId, Level, Mechanism, RowLabel, Scratch, System};
use rank::components;

use super::Contradiction;
use super::joints_first::{JointsFirst, StatedRanks};
use crate::generic::{Generic, OtherConfiguration, generic};
use crate::state::check_configuration;

/// Returns contradictions between drives and the other constraints at time t and coordinates q.
/// Drives may prescribe different positions or velocities, or may prescribe a motion that the
/// joints prevent. Positions come before velocities, and the largest excess comes first. Velocities
/// are not needed. At q, the joints must be satisfied. Each drive that is independent of the joints
/// and of the previous drives must also be satisfied. The result is empty if the rank is undecided
/// in `f64`, or if there are more than [`ONE_PART`] rows.
///
/// # Errors
/// - [`AnalysisError::State`]: t or q is not finite, or q has not n_q entries.
/// - [`AnalysisError::Rank`]: C is not finite.
pub fn contradicting_drives(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
) -> Result<Vec<Contradiction>, AnalysisError> {
    check_configuration(mechanism, t, q)?;
    if is_beyond(mechanism) {
        return Ok(Vec::new());
    }
    let ranks = StatedRanks::at(mechanism, t, q)?;
    compared(mechanism, t, q, ranks.as_ref(), Notice::Rounding)
}

/// Returns the first contradiction of drives between the start and the last time. The drives are
/// checked at a dozen positions after the start. The bodies follow the drives to these positions.
/// Returns `None` if the drives cannot be followed or if there are more than [`ONE_PART`] rows. The
/// function ignores rows that depend on each other only at the start, and differences that are too
/// small to stop a simulation.
///
/// # Errors
/// Returns the same errors as [`contradicting_drives`].
pub fn contradicting_drives_along(
    mechanism: &Mechanism,
    start: &[f64],
    t_end: f64,
) -> Result<Option<Contradiction>, AnalysisError> {
    let mut found = None;
    check_configuration(mechanism, t_end, start)?;
    if is_beyond(mechanism) {
        return Ok(None);
    }
    let t0 = mechanism.layout().start_time;
    let ranks = StatedRanks::at(mechanism, t0, start)?;
    // Drives that are independent at the start do not contradict each other, because the rank is
    // lower only at single instants along the motion.
    match JointsFirst::of_velocities(mechanism, t0, start, ranks.as_ref())? {
        Some(rows) if rows.has_redundant_drives(mechanism) => {}
        _ => return Ok(None),
    }
    // Other configurations are computed once, and only if a contradiction is found.
    let elsewhere = OnceCell::new();
    let elsewhere = || {
        elsewhere
            .get_or_init(|| generic(mechanism, t0, start))
            .as_ref()
    };
    walk(mechanism, start, t_end, ranks.as_ref(), |t, q| {
        let all = compared(mechanism, t, q, ranks.as_ref(), Notice::RunTo(t_end))?;
        found = all
            .into_iter()
            .find(|one| lasts(mechanism, ranks.as_ref(), elsewhere(), one));
        Ok(found.is_none())
    })?;
    Ok(found)
}

/// Returns whether the drives of a contradiction are also redundant at other configurations that
/// can be reached from the start. At a singular start, a drive may be redundant although it is
/// independent at all configurations around the start.
fn lasts(
    mechanism: &Mechanism,
    ranks: Option<&StatedRanks>,
    elsewhere: Option<&Generic>,
    contradiction: &Contradiction,
) -> bool {
    let labels = &mechanism.layout().labels;
    let (drives, _) = contradiction.split_rows();
    let row = |label: &&RowLabel| labels.iter().position(|other| other == *label);
    let drives: Vec<usize> = drives.iter().filter_map(row).collect();
    let is_redundant = |there: &OtherConfiguration| {
        let rows = JointsFirst::of_velocities(mechanism, there.time, &there.q, ranks);
        rows.ok().flatten().is_none_or(|rows| {
            let needed = components(&rows.decision).coloops;
            drives.iter().any(|row| needed.binary_search(row).is_err())
        })
    };
    elsewhere.is_none_or(|found| found.points.iter().all(is_redundant))
}

/// Returns whether there are no drives, or too many rows.
fn is_beyond(mechanism: &Mechanism) -> bool {
    let layout = mechanism.layout();
    layout.drive_rows().is_empty() || layout.rows() > ONE_PART
}

/// Calls `see` with the positions along the motion. The function ends if a position cannot be
/// reached or `see` returns `false`.
fn walk(
    mechanism: &Mechanism,
    start: &[f64],
    t_end: f64,
    ranks: Option<&StatedRanks>,
    mut see: impl FnMut(f64, &[f64]) -> Result<bool, AnalysisError>,
) -> Result<(), AnalysisError> {
    check_configuration(mechanism, t_end, start)?;
    if is_beyond(mechanism) {
        return Ok(());
    }
    let t0 = mechanism.layout().start_time;
    let mut walk = DriveWalk {
        mechanism,
        ranks,
        size: scene_size(mechanism, start),
        t: t0,
        q: start.to_vec(),
        steps: 0,
    };
    for k in 1..=DRIVE_POSITIONS {
        let to = match k {
            DRIVE_POSITIONS => t_end,
            k => t0 + (t_end - t0) * f64::from(k) / f64::from(DRIVE_POSITIONS),
        };
        // If the continuation ends early, drives that contradict each other already differ at the
        // last position.
        let is_there = walk.go(to)?;
        if !see(walk.t, &walk.q)? || !is_there {
            break;
        }
    }
    Ok(())
}

/// The configuration reached by following the drives.
struct DriveWalk<'m> {
    mechanism: &'m Mechanism,
    ranks: Option<&'m StatedRanks>,
    /// Size of the mechanism (m).
    size: f64,
    t: f64,
    q: Vec<f64>,
    steps: usize,
}

impl DriveWalk<'_> {
    /// Continues to a later time. Returns whether this time has been reached.
    fn go(&mut self, to: f64) -> Result<bool, AnalysisError> {
        while self.t < to {
            if self.steps == DRIVE_STEPS {
                return Ok(false);
            }
            self.steps += 1;
            let Some(rows) =
                JointsFirst::of_positions(self.mechanism, self.t, &self.q, self.ranks)?
            else {
                return Ok(false);
            };
            let kept = &rows.decision.kept;
            let mut next = to;
            let mut halvings = 0;
            while self.stride(&rows, next) > STRIDE && next > self.t {
                next = self.t + 0.5 * (next - self.t);
            }
            let reached = loop {
                match nearest_configuration(self.mechanism, next, kept, &self.q, Metric::Mass) {
                    Ok(there) => break Some(there),
                    Err(_) if halvings < DRIVE_HALVINGS => next = self.t + 0.5 * (next - self.t),
                    Err(_) => break None,
                }
                halvings += 1;
            };
            match reached {
                Some(there) if next > self.t => (self.t, self.q) = (next, there),
                _ => return Ok(false),
            }
        }
        Ok(true)
    }

    /// Returns the largest change of a followed drive between the time of these rows and `next`.
    fn stride(&self, rows: &JointsFirst, next: f64) -> f64 {
        let now = &rows.s;
        let mut then = self.mechanism.scratch();
        self.mechanism.pose(next, &self.q, &mut then);
        let groups = &self.mechanism.layout().groups;
        let ids = self.mechanism.layout().constraint_ids();
        let kept = &rows.decision.kept;
        let is_followed = |id: &ConstraintId| {
            let group = &groups[id.0];
            group.is_drive() && kept.binary_search(&group.rows.row(0)).is_ok()
        };
        let changes = ids.filter(is_followed).map(|id| {
            let value = |s: &Scratch| {
                self.mechanism
                    .prescribed(id, s)
                    .iter()
                    .map(|f| f[0])
                    .sum::<f64>()
            };
            let change = (value(&then) - value(now)).abs();
            if self.mechanism.layout().is_angular(groups[id.0].rows.row(0)) {
                change
            } else {
                change / self.size
            }
        });
        changes.fold(0.0, f64::max)
    }
}

/// The contradictions that are reported.
#[derive(Clone, Copy)]
enum Notice {
    /// All contradictions above rounding.
    Rounding,
    /// The contradictions that would stop a simulation to this time.
    RunTo(f64),
}

/// Returns the contradictions of positions and of velocities.
fn compared(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    ranks: Option<&StatedRanks>,
    notice: Notice,
) -> Result<Vec<Contradiction>, AnalysisError> {
    let (share, per_second) = match notice {
        Notice::Rounding => (0.0, 0.0),
        Notice::RunTo(t_end) => (RUNS_NOTICE, t_end.recip()),
    };
    let mut found = Vec::new();
    let mut add = |mut of_level: Vec<Contradiction>| {
        let excess = |c: &Contradiction| c.size / c.tolerance;
        of_level.sort_by(|a, b| excess(b).total_cmp(&excess(a)));
        found.extend(of_level);
    };
    // Contradictions of positions are reported before contradictions of velocities.
    if let Some(positions) = JointsFirst::of_positions(mechanism, t, q, ranks)? {
        let level = Level::positions();
        let terms = |i| mechanism.scales(&positions.s).terms(i, &level);
        add(positions.contradictions(mechanism, level, &terms, share));
    }
    if let Some(all) = JointsFirst::of_velocities(mechanism, t, q, ranks)? {
        let v = all
            .slowest(mechanism, q)
            .unwrap_or_else(|| vec![0.0; mechanism.layout().n_v]);
        let level = Level::velocities(mechanism, scene_size(mechanism, q), &v);
        // Different rates count as equal if the difference of the positions at the end of the
        // simulation is too small to be noticed by the simulation.
        let slow = |i| per_second * mechanism.scales(&all.s).position(i);
        let terms = |i| mechanism.scales(&all.s).terms(i, &level) + slow(i);
        add(all.contradictions(mechanism, level, &terms, share));
    }
    Ok(found)
}

#[cfg(test)]
mod tests;
