//! How strongly a reaction depends on the data: by what fraction it changes if one point moves
//! slightly. A reaction may be unique and yet be determined by the last digits of a drawing.
//!
//! With the rank held, `M·a + C_Kᵀ·λ = Q`, `C_K·a = Γ` change with a point through its own entries
//! in C and Γ, through the pose, which follows so that `Φ_K = 0`, and through the velocities, which
//! follow so that `C_K·v = b`. For a component `wᵀ·λ` one solution y of the same symmetric
//! equations with right-hand side (0, w) gives the change with respect to all points at once:
//! `y_aᵀ·(δQ − δCᵀ·λ) + y_λᵀ·(δΓ − δC·a)`.
//!
//! Size and loads are those of a set of connected bodies: the result for a robot is the same alone
//! and in a fleet, even if springs couple it to others.
//!
//! Without any load no reaction could change. Then the result is computed for a load of 1 N on each
//! body, in directions without symmetry, at rest and with equal masses: a combination of rows of
//! norm σ has reactions of about 1/σ of it, which change by the fraction moved/(σ·size).
//!
//! Data whose uncertainty changes the rank itself are the subject of `numerical_rank`.

mod instant;
mod joined;
#[cfg(test)]
mod tests;

use crate::limits::{BEYOND, FRAGILE, MANY, ROWS_MAX};
use crate::row_decision::RowDecision;
use model::{ConstraintId, DataUnit, Layout, Mechanism, System};

use crate::analysis::Analysis;
use crate::choices::{ChoiceError, solution_under};
use crate::groups::check;
use crate::parts::{Extent, Partition};
use crate::words;
use instant::Instant;
use joined::{Joined, each_joined};

/// Changes of a reaction with one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Largest change, relative to the larger of the reaction and of the largest applied or
    /// inertial load, torques divided by the size.
    pub change: f64,
    /// The datum with the largest effect. `None` if nothing changes the reaction.
    pub by: Option<Datum>,
}

/// A point, direction or number of a joint or drive, and by how much it is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Datum {
    /// The joint or drive.
    pub joint: ConstraintId,
    /// Name of the datum in the joint or drive.
    pub name: &'static str,
    /// Displacement (m or rad).
    pub moved: f64,
    /// Unit of the displacement.
    pub unit: DataUnit,
    /// Whether it is a single number, not a point or a direction.
    pub is_number: bool,
}

impl Sensitivity {
    /// Whether the reaction is fragile: it changes by more than the limit.
    #[must_use]
    pub fn is_fragile(&self) -> bool {
        self.change > FRAGILE
    }

    /// A sentence about the reaction of this name: that it is unique but changes, by how much, and
    /// with which datum.
    #[must_use]
    pub fn sentence(&self, reaction: &str, layout: &Layout) -> String {
        match &self.by {
            None => format!("`{reaction}` is unique, and no point of the scene changes it"),
            Some(by) => format!(
                "`{reaction}` is unique but {} if {}",
                told(self.change, 1),
                by.condition(layout)
            ),
        }
    }
}

impl Datum {
    /// The displacement as a condition of the sentence.
    fn condition(&self, layout: &Layout) -> String {
        let (what, verb) = match (self.is_number, self.unit) {
            (true, _) => ("", "changes"),
            (false, DataUnit::Length) => ("point ", "moves"),
            (false, DataUnit::Angle) => ("direction ", "turns"),
        };
        let moved = match self.unit {
            DataUnit::Length => length(self.moved),
            DataUnit::Angle => format!("{:.1e} rad", self.moved),
        };
        let joint = &layout.groups[self.joint.0].name;
        format!("{what}`{}` of `{joint}` {verb} by {moved}", self.name)
    }
}

/// States that this number of reactions changes by at most this fraction of their size. The
/// fraction is of first order, so it is given as a number only if it is small.
fn told(change: f64, reactions: usize) -> String {
    let (verb, up_to, whose) = match reactions {
        1 => ("changes", "", "its"),
        _ => ("change", "up to ", "their"),
    };
    if change < BEYOND {
        return format!("{verb} by {up_to}about {:.2} %", Digits(100.0 * change));
    }
    let times = if change < MANY {
        "several times"
    } else {
        "many times"
    };
    format!("would change by {up_to}{times} {whose} size")
}

/// A number with as many significant digits as the precision of the format states.
struct Digits(f64);

impl std::fmt::Display for Digits {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(2) as i32;
        let places = match self.0.abs() {
            x if x > 0.0 && x.is_finite() => digits - 1 - x.log10().floor() as i32,
            _ => 0,
        };
        let unit = 10f64.powi(places);
        let rounded = (self.0 * unit).round() / unit;
        write!(f, "{rounded:.*}", places.clamp(0, 12) as usize)
    }
}

/// A small length as text.
#[must_use]
pub fn length(metres: f64) -> String {
    match metres.abs() {
        x if x >= 1.0 => format!("{:.2} m", Digits(metres)),
        x if x >= 1e-5 => format!("{:.2} mm", Digits(1e3 * metres)),
        x if x >= 1e-9 => format!("{:.2} µm", Digits(1e6 * metres)),
        _ => format!("{metres:.1e} m"),
    }
}

/// Sensitivities of the reactions of a mechanism of any size.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensitivities {
    /// Sensitivities of joints and drives in the order of their rows. `None` if the reaction is not
    /// unique, or if the sensitivity cannot be computed.
    pub each: Vec<Option<Sensitivity>>,
    /// Sentences on unique reactions whose sensitivity cannot be computed, with the reason.
    pub left_out: Vec<String>,
}

impl Sensitivities {
    /// The fragile reactions.
    pub fn fragile(&self) -> impl Iterator<Item = (ConstraintId, &Sensitivity)> {
        let each = self.each.iter().enumerate();
        let known = each.filter_map(|(k, s)| Some((ConstraintId(k), s.as_ref()?)));
        known.filter(|(_, s)| s.is_fragile())
    }

    /// Sentences on the fragile reactions: one sentence for those whose largest change comes from
    /// the same point.
    #[must_use]
    pub fn sentences(&self, layout: &Layout) -> Vec<String> {
        let mut groups: Vec<(Option<Datum>, f64, Vec<ConstraintId>)> = Vec::new();
        for (id, s) in self.fragile() {
            match groups.iter_mut().find(|(by, ..)| *by == s.by) {
                Some((_, change, ids)) => {
                    *change = change.max(s.change);
                    ids.push(id);
                }
                None => groups.push((s.by, s.change, vec![id])),
            }
        }
        let sentence = |(by, change, ids): (Option<Datum>, f64, Vec<ConstraintId>)| {
            let condition = by.map(|by| by.condition(layout)).unwrap_or_default();
            let names = words::list(&words::names(layout, &ids));
            let are = if ids.len() == 1 { "is" } else { "are" };
            let change = told(change, ids.len());
            format!("{names} {are} unique but {change} if {condition}")
        };
        groups.into_iter().map(sentence).collect()
    }
}

impl Analysis {
    /// Computes how strongly each unique reaction depends on the data, at the configuration of the
    /// analysis and velocities v that satisfy the constraints. Each set of bodies connected by
    /// joints and drives is examined separately, with its own size and loads, on the `rayon` thread
    /// pool of the caller. In sets with too many rows for dense matrices, each part on common
    /// cycles is examined with its own data and size, under the loads from the rest of the set.
    /// Parts that are themselves too large, or whose rank is undecided, are left out.
    ///
    /// # Errors
    /// [`ChoiceError::Request`]: q or v do not fit the mechanism.
    pub fn sensitivities(
        &self,
        mechanism: &Mechanism,
        q: &[f64],
        v: &[f64],
    ) -> Result<Sensitivities, ChoiceError> {
        let layout = mechanism.layout();
        let mut all = Sensitivities {
            each: vec![None; layout.groups.len()],
            left_out: Vec::new(),
        };
        let is_unique = |group: usize| self.reactions[group].wrench.verdict.is_unique();
        if !self.decision.is_decided() || !(0..layout.groups.len()).any(is_unique) {
            return Ok(all);
        }
        check("q", q, layout.n_q)?;
        check("v", v, layout.n_v)?;
        let kept = &self.decision.kept;
        for judged in by_sets(mechanism, (self.time, q, v), kept, is_unique) {
            match judged.found {
                Ok(found) => {
                    for (group, sensitivity) in found {
                        all.each[group] = Some(sensitivity).filter(|s| s.change.is_finite());
                    }
                }
                Err(reason) => all.left_out.push(format!(
                    "the sensitivity of the reactions of {} to the data is not known: {reason}",
                    judged.extent.name(mechanism)
                )),
            }
        }
        Ok(all)
    }
}

/// Sensitivities with the numbers of their joints and drives.
type Found = Vec<(usize, Sensitivity)>;

/// Result for a set of connected bodies.
struct JudgedSet {
    extent: Extent,
    /// Sensitivities, by joints and drives of the whole mechanism.
    found: Result<Found, SetError>,
}

/// Reason why a set has no result.
#[derive(Debug, thiserror::Error)]
enum SetError {
    #[error("{rows} rows share cycles, and matrices of all of them are made up to {max} rows", max = ROWS_MAX)]
    TooLarge { rows: usize },
    #[error(transparent)]
    Equations(#[from] ChoiceError),
}

/// The sensitivities of the requested reactions, one set of connected bodies after the other.
fn by_sets(
    mechanism: &Mechanism,
    (t, q, v): (f64, &[f64], &[f64]),
    kept: &[usize],
    is_wanted: impl Fn(usize) -> bool + Sync,
) -> Vec<JudgedSet> {
    let sensitivities = |joined: &Joined<'_>| {
        let extent = joined.extent;
        let kept = own_kept(kept, extent, joined.mechanism);
        let is_wanted = |k: usize| is_wanted(extent.group(k));
        let mut found = if joined.mechanism.layout().rows() <= ROWS_MAX {
            of_joined(joined, t, &kept, is_wanted)
        } else {
            by_parts(joined, t, kept, is_wanted)
        }?;
        placed(&mut found, extent);
        Ok(found)
    };
    each_joined(mechanism, (t, q, v), |joined, extent| JudgedSet {
        found: match joined {
            Ok(joined) => sensitivities(&joined),
            Err(force) => Err(ChoiceError::from(force.clone()).into()),
        },
        extent: extent.clone(),
    })
}

/// The rows of the whole mechanism (ascending) that belong to this part, numbered in the part.
fn own_kept(kept: &[usize], extent: &Extent, part: &Mechanism) -> Vec<usize> {
    let is_kept = |&row: &usize| kept.binary_search(&extent.row(row)).is_ok();
    (0..part.layout().rows()).filter(is_kept).collect()
}

/// Renumbers joints and drives from the part to the whole mechanism.
fn placed(found: &mut Found, extent: &Extent) {
    for (group, sensitivity) in found {
        *group = extent.group(*group);
        if let Some(by) = &mut sensitivity.by {
            by.joint = ConstraintId(extent.group(by.joint.0));
        }
    }
}

/// The sensitivities of the requested reactions of connected bodies with respect to all their data;
/// joints and drives are numbered within the set.
fn of_joined(
    joined: &Joined<'_>,
    t: f64,
    kept: &[usize],
    is_wanted: impl Fn(usize) -> bool,
) -> Result<Found, SetError> {
    let groups = 0..joined.mechanism.layout().groups.len();
    let wanted: Vec<usize> = groups.filter(|&k| is_wanted(k)).collect();
    if wanted.is_empty() {
        return Ok(Found::new());
    }
    let mut instant = Instant::new(joined, t, kept)?;
    let of = |k: usize| Ok((k, instant.of(ConstraintId(k))?));
    wanted.into_iter().map(of).collect()
}

/// Like [`of_joined`], part by part, each with respect to its own data; parts that are too large
/// are left out.
fn by_parts(
    joined: &Joined<'_>,
    t: f64,
    kept: Vec<usize>,
    is_wanted: impl Fn(usize) -> bool + Sync,
) -> Result<Found, SetError> {
    let layout = joined.mechanism.layout();
    let rows = layout.rows();
    let is_kept = |row: &usize| kept.binary_search(row).is_ok();
    let decision = RowDecision {
        rank: kept.len(),
        redundancy: rows - kept.len(),
        dropped: (0..rows).filter(|row| !is_kept(row)).collect(),
        kept: kept.clone(),
        ..RowDecision::empty()
    };
    let state = (t, &joined.q[..], &joined.v[..]);
    let solution = solution_under(joined.mechanism, state, &joined.force, &decision)?;
    let parts = Partition::by_cycles(joined.mechanism, t, &joined.q);
    let found = parts.map(joined.mechanism, |part, extent| {
        if part.layout().rows() > ROWS_MAX {
            return Ok(Found::new());
        }
        let is_wanted = |k: usize| is_wanted(extent.group(k));
        if !(0..part.layout().groups.len()).any(is_wanted) {
            return Ok(Found::new());
        }
        let kept = own_kept(&kept, &extent, part);
        let within = joined.of_part(part, &extent, t, &solution);
        let mut found = of_joined(&within, t, &kept, is_wanted)?;
        placed(&mut found, &extent);
        Ok::<_, SetError>(found)
    })?;
    match parts {
        Partition::One => Err(SetError::TooLarge { rows }),
        Partition::Several(_) => Ok(found.into_iter().flatten().collect()),
    }
}
