//! How much a reaction hangs on the data: by what share it changes when one point moves a little. A
//! reaction may be unique and yet be made of the last digits of a drawing.
//!
//! With the rank held, `M·a + C_Kᵀ·λ = Q`, `C_K·a = Γ` change with a point by its own part of C and
//! Γ, by the pose, which follows so that `Φ_K = 0`, and by the velocities, which follow so that
//! `C_K·v = b`. For a component `wᵀ·λ` one solution y of the same symmetric equations with
//! right-hand side (0, w) gives the change by all points at once:
//! `y_aᵀ·(δQ − δCᵀ·λ) + y_λᵀ·(δΓ − δC·a)`.
//!
//! Size and loads are those of the bodies that joints connect: a robot says the same of itself
//! alone and in a fleet, also where springs couple it to others.
//!
//! Without any load there is nothing that could change. The answer is then given for a load of 1 N
//! on each body, in directions that favour nothing, at rest and with equal masses: a combination of
//! rows of norm σ makes reactions of about 1/σ of it, which change by the share moved/(σ·size).
//!
//! Not here: data within which the rank itself changes (`meant`).

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
    /// What changes it most. `None` if nothing does.
    pub by: Option<Datum>,
}

/// A point, direction or number of a joint or drive, and how far it is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Datum {
    /// The joint or drive.
    pub joint: ConstraintId,
    /// Its name there.
    pub name: &'static str,
    /// How far it is moved (m or rad).
    pub moved: f64,
    /// The unit of that.
    pub unit: DataUnit,
    /// Whether it is a single number, not a point or a direction.
    pub is_number: bool,
}

impl Sensitivity {
    /// Whether it hangs on the data.
    #[must_use]
    pub fn is_fragile(&self) -> bool {
        self.change > FRAGILE
    }

    /// In words, for the reaction of this name: that it is unique but changes, by how much, and
    /// with what.
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
    /// That it is moved, and how far.
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

/// That so many reactions change by at most this share of their size. The share is of the first
/// order: it is a number only where it is small.
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

/// A number for people, with so many digits that count as the precision says.
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

/// A small length in words.
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
    /// Joints and drives in the order of their rows. `None` if the reaction is not unique, or if
    /// nothing can be said.
    pub each: Vec<Option<Sensitivity>>,
    /// Of which unique reactions nothing can be said, and why, in sentences.
    pub left_out: Vec<String>,
}

impl Sensitivities {
    /// The fragile ones.
    pub fn fragile(&self) -> impl Iterator<Item = (ConstraintId, &Sensitivity)> {
        let each = self.each.iter().enumerate();
        let known = each.filter_map(|(k, s)| Some((ConstraintId(k), s.as_ref()?)));
        known.filter(|(_, s)| s.is_fragile())
    }

    /// The fragile reactions in words: one sentence for those that hang most on the same point.
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
    /// How much each unique reaction hangs on the data, at the configuration of the analysis and
    /// velocities v that satisfy the constraints. Each set of bodies that joints and drives connect
    /// is asked alone, with its own size and loads, on the threads of the pool of `rayon` from
    /// which this is called. In sets with more rows than dense matrices are made of each part on
    /// common cycles is asked by its own data, with its own size and under what the rest of the set
    /// does to it. Nothing is said where the rank is undecided, and of parts that are as large.
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
                    "how much the reactions of {} hang on the data is not known: {reason}",
                    judged.extent.name(mechanism)
                )),
            }
        }
        Ok(all)
    }
}

/// Sensitivities by joints and drives.
type Found = Vec<(usize, Sensitivity)>;

/// What is known of a set of joined bodies.
struct JudgedSet {
    extent: Extent,
    /// By the joints and drives of the whole.
    found: Result<Found, SetError>,
}

/// Why nothing is known of a set.
#[derive(Debug, thiserror::Error)]
enum SetError {
    #[error("{rows} rows share cycles, and matrices of all of them are made up to {max} rows", max = ROWS_MAX)]
    TooLarge { rows: usize },
    #[error(transparent)]
    Equations(#[from] ChoiceError),
}

/// The sensitivities of the reactions that are wanted, set by set of bodies that joints connect.
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
    each_joined(mechanism, (t, q, v), |joined| JudgedSet {
        found: sensitivities(&joined),
        extent: joined.extent.clone(),
    })
}

/// Those of some rows of the whole, ascending, that are rows of this part, numbered there.
fn own_kept(kept: &[usize], extent: &Extent, part: &Mechanism) -> Vec<usize> {
    let is_kept = |&row: &usize| kept.binary_search(&extent.row(row)).is_ok();
    (0..part.layout().rows()).filter(is_kept).collect()
}

/// Numbers joints and drives as in the mechanism that this is a part of.
fn placed(found: &mut Found, extent: &Extent) {
    for (group, sensitivity) in found {
        *group = extent.group(*group);
        if let Some(by) = &mut sensitivity.by {
            by.joint = ConstraintId(extent.group(by.joint.0));
        }
    }
}

/// Those of the reactions of joined bodies that are wanted, by all their data; joints and drives by
/// their numbers there.
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

/// The same part by part, each by its own data; of parts that are too large nothing is found.
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
