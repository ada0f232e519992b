//! Ranks and independent rows that prefer joints to drives. The redundant remainder of a drive is
//! the part that contradicts the other rows.

use linalg::{KeptRowSaddle, Matrix};
use model::start::scene_size;
use model::{ConstraintLevel, Level, Mechanism, Scratch, System};
use rank::{RankDecision, circuits, dropping_of_rank};

use super::{Contradiction, LevelValues};
use crate::certificate;
use crate::error::AnalysisError;
use crate::pose::{dimensionless, evaluated, uncertainty, velocity_units};

/// The ranks of a mechanism with a stated tolerance. The ranks apply to the data within this
/// tolerance, and no single matrix has these ranks. Without a tolerance, each configuration has its
/// own ranks.
pub(super) struct StatedRanks {
    /// Ranks of the rows of Φ; `None` if they are undecided.
    positions: Option<RanksOfRows>,
    /// Ranks of all rows; `None` if they are undecided.
    velocities: Option<RanksOfRows>,
}

/// The rank of some rows, and the rank of those rows among them that do not belong to drives.
#[derive(Clone, Copy)]
struct RanksOfRows {
    all: usize,
    joints: usize,
}

impl StatedRanks {
    /// Returns the ranks at a configuration, or `None` without a tolerance.
    pub(super) fn at(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
    ) -> Result<Option<Self>, AnalysisError> {
        if !mechanism.has_tolerances() {
            return Ok(None);
        }
        let s = evaluated(mechanism, t, q);
        let rows = certificate::UncertainRows::in_double(mechanism, &s, q);
        let rank = |some: &[usize]| {
            let decision = rows.select(some).decide()?;
            Ok::<_, AnalysisError>(decision.is_decided().then_some(decision.rank))
        };
        let of = |count: usize| {
            let rows: Vec<usize> = (0..count).collect();
            let ranks = (rank(&rows)?, rank(&without_drives(mechanism, &rows))?);
            Ok::<_, AnalysisError>(match ranks {
                (Some(all), Some(joints)) => Some(RanksOfRows { all, joints }),
                _ => None,
            })
        };
        let layout = mechanism.layout();
        Ok(Some(Self {
            positions: of(layout.m)?,
            velocities: of(layout.rows())?,
        }))
    }
}

/// Returns the rows that do not belong to a drive.
fn without_drives(mechanism: &Mechanism, rows: &[usize]) -> Vec<usize> {
    let drives = mechanism.layout().drive_rows();
    let is_joint = |row: &&usize| drives.binary_search(row).is_err();
    rows.iter().filter(is_joint).copied().collect()
}

/// Rank decision at a configuration. The decision prefers joints to drives as independent rows.
pub(super) struct JointsFirst {
    /// Scratch in which the rows have been evaluated.
    pub(super) s: Scratch,
    pub(super) decision: RankDecision,
}

impl JointsFirst {
    /// Returns the decision on the rows of Φ.
    pub(super) fn of_positions(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        ranks: Option<&StatedRanks>,
    ) -> Result<Option<Self>, AnalysisError> {
        match ranks.map(|ranks| ranks.positions) {
            Some(None) => Ok(None),
            ranks => Self::of(mechanism, t, q, (mechanism.layout().m, ranks.flatten())),
        }
    }

    /// Returns the decision on all rows.
    pub(super) fn of_velocities(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        ranks: Option<&StatedRanks>,
    ) -> Result<Option<Self>, AnalysisError> {
        match ranks.map(|ranks| ranks.velocities) {
            Some(None) => Ok(None),
            ranks => Self::of(
                mechanism,
                t,
                q,
                (mechanism.layout().rows(), ranks.flatten()),
            ),
        }
    }

    /// Returns the decision on the first `count` rows of C. If ranks are given, the decision uses
    /// them. Returns `None` if a rank is undecided.
    fn of(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        (count, ranks): (usize, Option<RanksOfRows>),
    ) -> Result<Option<Self>, AnalysisError> {
        let layout = mechanism.layout();
        let mut s = evaluated(mechanism, t, q);
        mechanism.b(&mut s);
        let size = scene_size(mechanism, q);
        let all: Vec<usize> = (0..count).collect();
        let c = dimensionless(mechanism, &s, size).select_rows(&all);
        // The residuals of drives are the quantities to compare. Therefore they do not count as
        // errors of the configuration.
        let mut of_joints = s.clone();
        for row in layout.drive_rows() {
            of_joints.phi[row] = 0.0;
        }
        let known = uncertainty(mechanism, &of_joints, size).select_rows(&all);
        let decided = |rows: &[usize], rank: Option<usize>| {
            let [c, known]: [Matrix; 2] = [&c, &known].map(|m| m.select_rows(rows));
            let decision = match rank {
                None => rank::decide(&c, &known),
                Some(rank) => rank::decide_of_rank(&c, &known, rank),
            };
            let decision = decision.map_err(|source| AnalysisError::Rank { time: t, source })?;
            Ok::<_, AnalysisError>(Some(decision).filter(RankDecision::is_decided))
        };
        let joints = without_drives(mechanism, &all);
        let whole = decided(&all, ranks.map(|ranks| ranks.all))?;
        let alone = decided(&joints, ranks.map(|ranks| ranks.joints))?;
        let (Some(whole), Some(alone)) = (whole, alone) else {
            return Ok(None);
        };
        let mut kept: Vec<usize> = alone.kept.iter().map(|&k| joints[k]).collect();
        for drive in layout.drive_rows() {
            if kept.len() == whole.rank {
                break;
            }
            kept.push(drive);
            kept.sort_unstable();
            match decided(&kept, None)? {
                Some(decision) if decision.redundancy == 0 => {}
                Some(_) => kept.retain(|row| *row != drive),
                None => return Ok(None),
            }
        }
        let dropped: Vec<usize> = all
            .into_iter()
            .filter(|row| kept.binary_search(row).is_err())
            .collect();
        let decision = dropping_of_rank(&c, &known, &dropped, whole.rank).ok();
        let decision = decision.filter(RankDecision::is_decided);
        Ok(decision.map(|decision| Self { s, decision }))
    }

    /// Returns whether a drive depends on the kept rows.
    pub(super) fn has_redundant_drives(&self, mechanism: &Mechanism) -> bool {
        let drives = mechanism.layout().drive_rows();
        let mut dropped = self.decision.dropped.iter();
        dropped.any(|row| drives.binary_search(row).is_ok())
    }

    /// Returns the smallest velocities that satisfy the kept rows and that data within a tolerance
    /// change. Returns `None` if they cannot be computed.
    pub(super) fn slowest(&self, mechanism: &Mechanism, q: &[f64]) -> Option<Vec<f64>> {
        let (layout, kept) = (mechanism.layout(), &self.decision.kept);
        let c = layout.dense(&self.s);
        let units = velocity_units(mechanism, scene_size(mechanism, q));
        let weights: Vec<f64> = units.iter().map(|unit| unit.powi(-2)).collect();
        let b: Vec<f64> = kept.iter().map(|&row| self.s.b[row]).collect();
        let n = units.len();
        let (mut v, mut lambda) = (vec![0.0; n], vec![0.0; kept.len()]);
        let mut saddle = KeptRowSaddle::new(n, kept.len()).ok()?;
        saddle.factor(|k| c.row(kept[k]), &weights).ok()?;
        saddle.solve(&vec![0.0; n], &b, &mut v, &mut lambda).ok()?;
        Some(v)
    }

    /// Returns the contradictions of redundant drives. A drive contradicts the other rows if the
    /// residual of its row is larger than `share` times the terms of this row.
    pub(super) fn contradictions(
        &self,
        mechanism: &Mechanism,
        level: Level<'_>,
        terms: &dyn Fn(usize) -> f64,
        share: f64,
    ) -> Vec<Contradiction> {
        let drives = mechanism.layout().drive_rows();
        let dropped = self.decision.dropped.iter().zip(circuits(&self.decision));
        let of_drives: Vec<_> = dropped
            .filter(|(row, _)| drives.binary_search(row).is_ok())
            .map(|(_, circuit)| circuit)
            .collect();
        let comparison = LevelValues {
            level,
            prescribed: &self.s,
            decision: &self.decision,
            values: match level.of {
                ConstraintLevel::Position => &self.s.phi,
                _ => &self.s.b,
            },
            scale: terms,
            share,
        };
        comparison.among(of_drives, mechanism, self.s.t)
    }
}
