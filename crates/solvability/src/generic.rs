//! Is a redundancy permanent, or present at this configuration only? The rank is constant on each
//! connected component of the configuration set except on a nowhere dense part of it, so the ranks
//! at a few other points of the same component decide.
//!
//! Other points are reached by steps along the free directions of the constraints. Drives are left
//! out, because the values they prescribe change with time. If other constraints depend on time,
//! time changes as well.

use crate::limits::{
    GENERIC_HALVINGS, GENERIC_STEP, GENERIC_STEPS, ONE_PART, POINTS, POINTS_APART, WALKS,
};
use crate::pose::{dimensionless, uncertainty, velocity_units};
use linalg::{Matrix, PivotedQr};
use model::start::{Metric, nearest_configuration, scene_size};
use model::{DataBlock, Mechanism, SHARED, System};
use rank::RankDecision;

use crate::certificate::{Rows, holding_together};

/// Redundancy at other configurations of the same component.
#[derive(Clone, Debug, PartialEq)]
pub struct Generic {
    /// The smallest redundancy found, which holds at almost all configurations.
    pub redundancy: usize,
    /// The configurations that were compared.
    pub points: Vec<OtherConfiguration>,
}

/// Another configuration.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct OtherConfiguration {
    /// Time (s).
    pub time: f64,
    /// Coordinates, n_q.
    pub q: Vec<f64>,
    /// Rank of C.
    pub rank: usize,
    /// Degree of redundancy.
    pub redundancy: usize,
}

/// Ranks at configurations other than (t, q), which must satisfy the constraints. Returns `None` if
/// no configuration was found at which the rank is decided (a structure that cannot move has no
/// others), if there are more than [`ONE_PART`] rows, or if t and q are not a configuration of this
/// mechanism.
#[must_use]
pub fn generic(mechanism: &Mechanism, t: f64, q: &[f64]) -> Option<Generic> {
    crate::state::check_configuration(mechanism, t, q).ok()?;
    if mechanism.layout().rows() > ONE_PART {
        return None;
    }
    let rows = Lasting::of(mechanism, t, q);
    let compared = compared_rows(mechanism, t, q)?;
    let size = scene_size(mechanism, q);
    let units = velocity_units(mechanism, size);
    let mut points: Vec<OtherConfiguration> = Vec::new();
    let mut visited = vec![(t, q.to_vec())];
    for walk in 0..WALKS {
        let from = &visited[visited.len() - 1];
        let Some(there) = walk_from(mechanism, from, &rows, &units, size, walk) else {
            continue;
        };
        let is_new = |(t, q): &(f64, Vec<f64>)| {
            let moved = mechanism.difference_of(&there.1, q).into_iter();
            there.0 != *t || length(moved, &units, size) >= POINTS_APART
        };
        if visited.iter().all(is_new) {
            points.extend(elsewhere(mechanism, &there, &compared));
        }
        visited.push(there);
        if points.len() == POINTS {
            break;
        }
    }
    let redundancy = points.iter().map(|p| p.redundancy).min()?;
    Some(Generic { redundancy, points })
}

/// The largest component of a displacement, as a fraction of the size of the mechanism or in
/// radians.
fn length(d: impl Iterator<Item = f64>, units: &[f64], size: f64) -> f64 {
    d.zip(units)
        .map(|(d, unit)| (d / unit / size).abs())
        .fold(0.0, f64::max)
}

/// Whether the degree of redundancy is the same at other configurations. Returns `None` if
/// [`generic`] does, or if the rank at this configuration is undecided.
#[must_use]
pub fn is_permanent(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
) -> Option<bool> {
    let found = generic(mechanism, t, q).filter(|_| decision.is_decided())?;
    Some(found.redundancy == decision.redundancy)
}

/// Rows of Φ that do not belong to drives.
struct Lasting {
    /// Rows that are satisfied at other points.
    held: Vec<usize>,
    /// Rows that are redundant within a stated tolerance, ascending: at other points they have
    /// residuals.
    dropped: Vec<usize>,
}

impl Lasting {
    fn of(mechanism: &Mechanism, t: f64, q: &[f64]) -> Self {
        let layout = mechanism.layout();
        let lasting = layout.groups.iter().filter(|g| !g.is_drive());
        let mut dropped: Vec<usize> = lasting.flat_map(|g| g.rows.holonomic.clone()).collect();
        let held = holding_together(mechanism, t, q, dropped.clone());
        dropped.retain(|row| !held.contains(row));
        Self { held, dropped }
    }

    /// Whether data within the tolerance explain the residuals of the dropped rows at a point at
    /// which the others are satisfied. On another branch of the held rows they do not.
    fn agree(&self, mechanism: &Mechanism, t: f64, q: &[f64]) -> bool {
        if self.dropped.is_empty() {
            return true;
        }
        let s = crate::pose::evaluated(mechanism, t, q);
        let c = dimensionless(mechanism, &s, scene_size(mechanism, q));
        let held = PivotedQr::of_rows(c.select_rows(&self.held));
        let blocks = mechanism.data().blocks(&s);
        self.dropped.iter().all(|&row| {
            // The dependency `row − Σ t_k·row k` of the held rows k.
            let mut t = c.row(row).to_vec();
            held.q_transpose_mul(&mut t);
            t.truncate(self.held.len());
            held.solve_r(&mut t);
            let mut z = vec![0.0; mechanism.layout().rows()];
            z[row] = 1.0;
            for (t, &k) in t.iter().zip(held.permutation()) {
                z[self.held[k]] = -t;
            }
            let explained = SHARED
                * mechanism
                    .data()
                    .phi_change(&s, &z, &blocks, DataBlock::known_to);
            s.phi[row].abs() <= explained
        })
    }
}

/// The last point of one walk, if it moved away from the start.
fn walk_from(
    mechanism: &Mechanism,
    from: &(f64, Vec<f64>),
    rows: &Lasting,
    units: &[f64],
    size: f64,
    walk: usize,
) -> Option<(f64, Vec<f64>)> {
    let moves_time = has_lasting_function(mechanism);
    // Different step lengths prevent the walks from returning to the start.
    let stride = GENERIC_STEP * (1.0 + 0.5 * spread(walk + 1));
    let (mut t, mut q) = from.clone();
    let mut heading: Option<Vec<f64>> = None;
    for _ in 0..GENERIC_STEPS {
        let directions = free_directions(mechanism, t, &q, &rows.held, units)?;
        if directions.nrows() == 0 && !moves_time {
            return None;
        }
        let mut step = match &heading {
            None => mixed(&directions, walk),
            // The projection of the last step onto the free directions.
            Some(last) => directions.transpose_times(&directions.times(last)),
        };
        heading = Some(step.clone());
        step.iter_mut().zip(units).for_each(|(d, unit)| *d *= unit);
        let largest = length(step.iter().copied(), units, size);
        let time = if moves_time { stride } else { 0.0 };
        let next = (0..GENERIC_HALVINGS).find_map(|halving| {
            let share = 0.5_f64.powi(halving);
            let factor = if largest > 0.0 {
                stride * share / largest
            } else {
                0.0
            };
            let moved = mechanism.space().displaced(&q, factor, &step);
            let later = t + time * share;
            let there =
                nearest_configuration(mechanism, later, &rows.held, &moved, Metric::Length).ok()?;
            rows.agree(mechanism, later, &there)
                .then_some((later, there))
        });
        let Some(next) = next else {
            break;
        };
        (t, q) = next;
    }
    ((t, &q) != (from.0, &from.1)).then_some((t, q))
}

/// Whether a constraint that is not a drive depends on time.
fn has_lasting_function(mechanism: &Mechanism) -> bool {
    let mut groups = mechanism.layout().groups.iter();
    groups.any(|g| g.spec.rheonomic && !g.is_drive())
}

/// The rows whose rank is compared: all, but of the rows that are dropped at (t, q) only those that
/// are dependent to rounding. The others are redundant within a stated tolerance, which has been
/// found at several configurations.
fn compared_rows(mechanism: &Mechanism, t: f64, q: &[f64]) -> Option<Vec<usize>> {
    let all = (0..mechanism.layout().rows()).collect();
    if !mechanism.has_tolerances() {
        return Some(all);
    }
    let s = crate::pose::evaluated(mechanism, t, q);
    let here = Rows::in_double(mechanism, &s, q).decide().ok()?;
    let size = scene_size(mechanism, q);
    let c = dimensionless(mechanism, &s, size);
    let known = uncertainty(mechanism, &s, size);
    let is_dependent = |row: usize| {
        let mut rows = here.kept.clone();
        rows.push(row);
        let found = rank::decide(&c.select_rows(&rows), &known.select_rows(&rows));
        found.is_ok_and(|found| found.is_decided() && found.rank == here.rank)
    };
    let dependent = here
        .dropped
        .iter()
        .copied()
        .filter(|&row| is_dependent(row));
    let mut rows: Vec<usize> = here.kept.iter().copied().chain(dependent).collect();
    rows.sort_unstable();
    Some(rows)
}

/// The rank of the compared rows at a point, if it is decided there.
fn elsewhere(
    mechanism: &Mechanism,
    (t, q): &(f64, Vec<f64>),
    compared: &[usize],
) -> Option<OtherConfiguration> {
    let mut s = crate::pose::evaluated(mechanism, *t, q);
    // Drives were left out of the walk, and have other values at this configuration. A row that was
    // left out because it is redundant within a tolerance has to agree there with the others.
    let drives = mechanism.layout().groups.iter().filter(|g| g.is_drive());
    for rows in drives.map(|g| g.rows.holonomic.clone()) {
        s.phi[rows].fill(0.0);
    }
    let decision = Rows::in_double(mechanism, &s, q)
        .select(compared)
        .decide()
        .ok()?;
    decision.is_decided().then(|| OtherConfiguration {
        time: *t,
        q: q.clone(),
        rank: decision.rank,
        redundancy: mechanism.layout().rows() - decision.rank,
    })
}

/// Basis of the dimensionless velocities that these rows of Φq allow, one velocity in each row.
fn free_directions(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    rows: &[usize],
    units: &[f64],
) -> Option<Matrix> {
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.c(&mut s);
    let mut phi_q = mechanism.layout().dense(&s).select_rows(rows);
    for i in 0..phi_q.nrows() {
        let row = phi_q.row_mut(i).iter_mut();
        row.zip(units).for_each(|(entry, unit)| *entry *= unit);
    }
    let n = phi_q.ncols();
    let decision = rank::decide(&phi_q, 0.0).ok()?;
    let kept = phi_q.select_rows(&decision.kept);
    Some(
        PivotedQr::of_rows(kept)
            .q_columns(decision.rank..n)
            .transpose(),
    )
}

/// A combination of all directions with coefficients that do not repeat.
fn mixed(directions: &Matrix, walk: usize) -> Vec<f64> {
    let first = walk * directions.nrows() + 1;
    let coefficients: Vec<f64> = (0..directions.nrows()).map(|i| spread(first + i)).collect();
    directions.transpose_times(&coefficients)
}

/// Numbers spread evenly between −½ and ½: the fractional parts of multiples of the golden ratio.
fn spread(k: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (GOLDEN * k as f64).fract() - 0.5
}
