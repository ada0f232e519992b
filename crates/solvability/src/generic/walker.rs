//! Continuation to other configurations along the motions that the constraints allow without the
//! drives. Also determines the ranks at these configurations.

use linalg::{Matrix, PivotedQr};
use model::start::{Metric, nearest_configuration, scene_size};
use model::{DataBlock, Mechanism, SHARED, System};

use super::leaving::Leaving;
use super::{DecidedRows, OtherConfiguration};
use crate::certificate::{UncertainRows, holding_together};
use crate::limits::{
    GENERIC_HALVINGS, GENERIC_HOLDS, GENERIC_STEP, GENERIC_STEPS, GENERIC_STRAYED,
};
use crate::pose::dimensionless;

/// Rows of Φ that do not belong to drives.
pub(super) struct LastingRows {
    /// Rows that are satisfied at all points.
    held: Vec<usize>,
    /// Rows that are redundant within a stated tolerance, ascending. At other points the residuals
    /// of these rows are not zero.
    dropped: Vec<usize>,
}

impl LastingRows {
    pub(super) fn of(mechanism: &Mechanism, t: f64, q: &[f64]) -> Self {
        let layout = mechanism.layout();
        let lasting = layout.groups.iter().filter(|g| !g.is_drive());
        let mut dropped: Vec<usize> = lasting.flat_map(|g| g.rows.holonomic.clone()).collect();
        let held = holding_together(mechanism, t, q, dropped.clone());
        dropped.retain(|row| !held.contains(row));
        Self { held, dropped }
    }

    /// Returns whether the residuals of the dropped rows can result from data within the tolerance.
    /// The other rows must be satisfied at the point. On another branch of the satisfied rows, the
    /// residuals are larger.
    fn agree(&self, mechanism: &Mechanism, t: f64, q: &[f64]) -> bool {
        if self.dropped.is_empty() {
            return true;
        }
        let s = crate::pose::evaluated(mechanism, t, q);
        let c = dimensionless(mechanism, &s, scene_size(mechanism, q));
        let held = PivotedQr::of_rows(c.select_rows(&self.held));
        let blocks = mechanism.data().blocks(&s);
        self.dropped.iter().all(|&row| {
            // The dependency is `row − Σ t_k·row k` of the satisfied rows k.
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

/// Continuation along the motions that the constraints allow without the drives.
pub(super) struct Walker<'m> {
    pub(super) mechanism: &'m Mechanism,
    pub(super) rows: LastingRows,
    /// Units of the velocities in a mechanism of 1 m.
    pub(super) units: Vec<f64>,
    pub(super) size: f64,
    pub(super) leaving: Leaving<'m>,
    /// Whether a constraint other than a drive depends on time.
    pub(super) moves_time: bool,
}

impl Walker<'_> {
    /// Returns the last point of one continuation if the continuation moved away from the start.
    pub(super) fn walk_from(&self, from: &(f64, Vec<f64>), walk: usize) -> Option<(f64, Vec<f64>)> {
        // Different step lengths prevent the continuations from returning to the start.
        let stride = GENERIC_STEP * (1.0 + 0.5 * spread(walk + 1));
        let (mut t, mut q) = from.clone();
        let mut before = from.clone();
        let mut heading: Option<Vec<f64>> = None;
        for _ in 0..GENERIC_STEPS {
            let (free, kept) = self.free_directions(t, &q)?;
            let Some(directions) = self.leaving.possible(free, (t, &q), &self.units) else {
                (t, q) = before;
                break;
            };
            if directions.nrows() == 0 && !self.moves_time {
                break;
            }
            let ahead = match &heading {
                None => mixed(&directions, walk),
                // Projects the last step onto the free directions.
                Some(last) => directions.transpose_times(&directions.times(last)),
            };
            let step = |ahead: Vec<f64>| {
                let there = self.step((t, &q), &kept, &ahead, stride)?;
                Some((there, ahead))
            };
            // If branches meet at a point, a mixture of their directions may not be a possible
            // motion.
            let next = step(ahead).or_else(|| {
                let mut branches = match heading {
                    None => self.leaving.branches((t, &q), &self.units),
                    Some(_) => Vec::new(),
                };
                let first = walk % branches.len().max(1);
                branches.rotate_left(first);
                branches.into_iter().find_map(step)
            });
            let Some(((later, there), ahead)) = next else {
                break;
            };
            heading = Some(ahead);
            before = (t, q);
            (t, q) = (later, there);
        }
        ((t, &q) != (from.0, &from.1)).then_some((t, q))
    }

    /// Returns the configuration after a step along a dimensionless velocity. The length of the
    /// step is the stride, which may be halved several times.
    fn step(
        &self,
        (t, q): (f64, &[f64]),
        kept: &[usize],
        ahead: &[f64],
        stride: f64,
    ) -> Option<(f64, Vec<f64>)> {
        let mechanism = self.mechanism;
        let step: Vec<f64> = ahead
            .iter()
            .zip(&self.units)
            .map(|(d, unit)| d * unit)
            .collect();
        let largest = self.length(step.iter().copied());
        let time = if self.moves_time { stride } else { 0.0 };
        (0..GENERIC_HALVINGS).find_map(|halving| {
            let share = 0.5_f64.powi(halving);
            let length = if largest > 0.0 { stride * share } else { 0.0 };
            let factor = if largest > 0.0 { length / largest } else { 0.0 };
            let moved = mechanism.space().displaced(q, factor, &step);
            let later = t + time * share;
            let on = |rows: &[usize]| {
                let there = nearest_configuration(mechanism, later, rows, &moved, Metric::Length);
                let there = there.ok()?;
                // If a correction is as long as the step, it leads to another branch.
                let has_strayed =
                    !self.moves_time && self.apart(&there, &moved) > GENERIC_STRAYED * length;
                (!has_strayed).then_some(there)
            };
            // If rows remain redundant, the kept rows determine more digits. The other rows block a
            // rotation only to the square root of rounding.
            let there = on(kept).filter(|there| self.hold(later, there));
            let there = there.or_else(|| on(&self.rows.held))?;
            self.rows
                .agree(mechanism, later, &there)
                .then_some((later, there))
        })
    }

    /// Returns whether all required rows are satisfied to rounding.
    fn hold(&self, t: f64, q: &[f64]) -> bool {
        let s = crate::pose::evaluated(self.mechanism, t, q);
        let scales = self.mechanism.scales(&s);
        let mut held = self.rows.held.iter();
        held.all(|&i| s.phi[i].abs() <= GENERIC_HOLDS * scales.position(i))
    }

    /// Returns a basis of the dimensionless velocities that these rows of Φq allow, one velocity in
    /// each row, and the independent rows.
    fn free_directions(&self, t: f64, q: &[f64]) -> Option<(Matrix, Vec<usize>)> {
        let s = crate::pose::evaluated(self.mechanism, t, q);
        let mut phi_q = self
            .mechanism
            .layout()
            .dense(&s)
            .select_rows(&self.rows.held);
        for i in 0..phi_q.nrows() {
            let row = phi_q.row_mut(i).iter_mut();
            row.zip(&self.units)
                .for_each(|(entry, unit)| *entry *= unit);
        }
        let n = phi_q.ncols();
        // The next correction shows whether these rows imply the other rows.
        let kept = rank::promising_rows(&phi_q, rank::Accuracy::Rounding).ok()?;
        let free = PivotedQr::of_rows(phi_q.select_rows(&kept)).q_columns(kept.len()..n);
        let rows = kept.iter().map(|&k| self.rows.held[k]);
        Some((free.transpose(), rows.collect()))
    }

    /// Returns the rank of the compared rows at a point if this rank is decided.
    pub(super) fn elsewhere(
        &self,
        (t, q): &(f64, Vec<f64>),
        compared: &[usize],
    ) -> Option<(OtherConfiguration, DecidedRows)> {
        let mechanism = self.mechanism;
        let mut s = crate::pose::evaluated(mechanism, *t, q);
        // The continuation omitted drives. At this configuration, drives have other values. A row
        // that was omitted because it is redundant within a tolerance must agree with the other
        // rows at this configuration.
        let drives = mechanism.layout().groups.iter().filter(|g| g.is_drive());
        for rows in drives.map(|g| g.rows.holonomic.clone()) {
            s.phi[rows].fill(0.0);
        }
        let (decision, c) = if self.leaving.excludes() {
            // Rows that block a rotation at second order restrict it only to the square root of
            // rounding.
            let known = f64::EPSILON.sqrt();
            let c = dimensionless(mechanism, &s, scene_size(mechanism, q)).select_rows(compared);
            (rank::decide(&c, rank::Accuracy::Absolute(known)).ok()?, c)
        } else {
            let rows = UncertainRows::in_double(mechanism, &s, q).select(compared);
            (rows.decide().ok()?, rows.matrix())
        };
        let point = OtherConfiguration {
            time: *t,
            q: q.clone(),
            rank: decision.rank,
            redundancy: mechanism.layout().rows() - decision.rank,
        };
        decision
            .is_decided()
            .then_some((point, DecidedRows { decision, c }))
    }

    /// Returns the largest component of a displacement, as a fraction of the size of the mechanism
    /// or in radians.
    fn length(&self, d: impl Iterator<Item = f64>) -> f64 {
        d.zip(&self.units)
            .map(|(d, unit)| (d / unit / self.size).abs())
            .fold(0.0, f64::max)
    }

    /// Returns the distance of two configurations, as a fraction of the size of the mechanism or in
    /// radians.
    pub(super) fn apart(&self, a: &[f64], b: &[f64]) -> f64 {
        self.length(self.mechanism.difference_of(a, b).into_iter())
    }
}

/// Returns whether a constraint other than a drive depends on time.
pub(super) fn has_lasting_function(mechanism: &Mechanism) -> bool {
    let mut groups = mechanism.layout().groups.iter();
    groups.any(|g| g.spec.rheonomic && !g.is_drive())
}

/// Returns a combination of all directions with coefficients that do not repeat.
fn mixed(directions: &Matrix, walk: usize) -> Vec<f64> {
    let first = walk * directions.nrows() + 1;
    let coefficients: Vec<f64> = (0..directions.nrows()).map(|i| spread(first + i)).collect();
    directions.transpose_times(&coefficients)
}

/// Returns numbers that are spread evenly between −½ and ½. The numbers are the fractional parts of
/// multiples of the golden ratio.
fn spread(k: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (GOLDEN * k as f64).fract() - 0.5
}
