//! Tests whether reactions exist. This test precedes the test of uniqueness. Redundant rows must be
//! consistent. For each circuit `Σ z_i·row_i = 0`, the right-hand sides must satisfy the same sum.
//! If `Σ z_i·b_i ≠ 0`, no velocity exists; if `Σ z_i·Γ_i ≠ 0`, no acceleration exists. At position
//! level the residuals of Φ replace the right-hand sides. The sum of the residuals over a circuit
//! is not zero if a row is redundant only at another configuration.
//!
//! This module does not decide ranks; it uses the circuits of decided ranks. The error of a
//! contradiction contains its drives, and the motion that each drive prescribes.

mod demands;
mod drives;
mod joints_first;
mod limit;

use model::words::quantity;
use std::collections::BTreeSet;

use model::start::scene_size;
use model::{ConstraintId, ConstraintLevel, Level, Mechanism, RowLabel, Scratch, System};
use rank::{Circuit, RankDecision};

use crate::state::{self, StateError};
use crate::words;
pub use demands::Demand;
pub use drives::{contradicting_drives, contradicting_drives_along};
pub use limit::{DriveLimit, LimitedDrive, drive_limit};

/// Redundant rows that contradict each other.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("at t = {time} s {}. {}", self.what(), self.advice())]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Contradiction {
    /// Time (s).
    pub time: f64,
    /// The rows of one circuit.
    pub rows: Vec<RowLabel>,
    /// Position, velocity or acceleration.
    pub level: ConstraintLevel,
    /// Change of one row that would remove the contradiction. The row is the last row that depends
    /// on time, or otherwise the last row. At position level the change is accurate to first order.
    pub size: f64,
    /// Unit of `size`.
    pub unit: &'static str,
    /// Values of `size` up to this limit are rounding.
    pub tolerance: f64,
    /// Number of joints and drives with functions of time among the rows.
    pub drives: usize,
    /// The motions that the drives among the rows prescribe, in the order of the rows. A
    /// contradiction of accelerations may contain no drive. In this case, the list contains the
    /// motions prescribed by the drives that determine the velocities of the bodies.
    pub demands: Vec<Demand>,
    /// Whether these drives are not among the rows, but prescribe velocities with which the rows
    /// cannot be satisfied.
    pub is_forced: bool,
}

impl Contradiction {
    /// Returns whether a drive is among the rows.
    #[must_use]
    pub fn is_of_drives(&self) -> bool {
        !self.demands.is_empty()
    }

    /// Splits the rows into rows of drives and rows of joints.
    #[must_use]
    pub fn split_rows(&self) -> (Vec<&RowLabel>, Vec<&RowLabel>) {
        let is_drive = |row: &&RowLabel| self.demands.iter().any(|d| d.drive == row.joint);
        self.rows.iter().partition(is_drive)
    }

    /// Returns the names of the drives that force the contradicting rows. The list is empty if the
    /// drives are among the rows.
    #[must_use]
    pub fn forcing(&self) -> Vec<&str> {
        let demands = self.demands.iter().filter(|_| self.is_forced);
        demands.map(|d| d.drive.as_str()).collect()
    }

    fn what(&self) -> String {
        let Self {
            level, size, unit, ..
        } = self;
        let (_, joints) = self.split_rows();
        let rows: Vec<String> = joints.into_iter().map(RowLabel::to_string).collect();
        if self.is_forced {
            let asked = self.demands.iter().map(|d| {
                let rate = d.asked(ConstraintLevel::Velocity);
                format!("`{}` requires {} {rate}", d.drive, d.of_what())
            });
            let asked = words::list(&asked.collect::<Vec<_>>());
            let (word, verb) = match self.demands.len() {
                1 => ("drive", "requires a velocity"),
                _ => (
                    "drives",
                    "contradict each other: together they require velocities",
                ),
            };
            let drives = self.demands.iter().map(|d| format!("`{}`", d.drive));
            return format!(
                "{word} {} {verb} with which {} can no longer be satisfied: these then require different {level}, which differ by {size} ({asked})",
                words::list(&drives.collect::<Vec<_>>()),
                of_rows(&rows),
                size = quantity(*size, unit)
            );
        }
        match self.demands.as_slice() {
            [] => format!(
                "rows {} depend on each other but require different {level}, which differ by {size}",
                rows.join(", "),
                size = quantity(*size, unit)
            ),
            [only] => format!(
                "drive `{}` requires {} {}, which differs by {size} from the value that {} allow",
                only.drive,
                only.of_what(),
                only.asked(*level),
                of_rows(&rows),
                size = quantity(*size, unit)
            ),
            [first, others @ ..] => {
                let drives = self.demands.iter().map(|d| format!("`{}`", d.drive));
                let asked = |d: &Demand| {
                    format!("`{}` requires {} {}", d.drive, d.of_what(), d.asked(*level))
                };
                let mut all = vec![asked(first)];
                all.extend(others.iter().map(asked));
                let through = match rows.as_slice() {
                    [] => String::new(),
                    [_] => format!(", and {} connects them with each other", of_rows(&rows)),
                    rows => format!(", and {} connect them with each other", of_rows(rows)),
                };
                format!(
                    "drives {} contradict each other: they require different {level}, which differ by {size} ({}{through})",
                    words::list(&drives.collect::<Vec<_>>()),
                    words::list(&all),
                    size = quantity(*size, unit)
                )
            }
        }
    }

    fn advice(&self) -> &'static str {
        if self.is_forced {
            return "The joints do not allow the motion that is prescribed: prescribe another one, or begin at another configuration";
        }
        match (self.drives, self.level) {
            (1, _) => {
                "The remaining rows do not allow the motion that one row prescribes: the mechanism is locked, or in a singular configuration. Begin at \
                 another configuration, or prescribe another motion"
            }
            (2.., _) => {
                "Redundant drives must follow the same motion; delete or correct one of them"
            }
            (0, ConstraintLevel::Position) => {
                "The rows are redundant here but not at other configurations: correct the dimensions, or delete one of them"
            }
            (0, _) => {
                "The configuration is singular and cannot be left with these velocities: change the velocities or the start"
            }
        }
    }
}

/// Returns "row 1 (`A`, x)" or "rows 1 (`A`, x) and 2 (`A`, y)".
fn of_rows(rows: &[String]) -> String {
    let word = if rows.len() == 1 { "row" } else { "rows" };
    format!("{word} {}", words::list(rows))
}

/// Rank decisions at one configuration.
#[derive(Clone, Copy, Debug)]
pub struct Ranks<'a> {
    /// Rank decision on all rows of C.
    pub all: &'a RankDecision,
    /// Rank decision on the rows of Φq alone.
    pub holonomic: &'a RankDecision,
}

/// Returns the contradictions between redundant rows at time t, coordinates q and velocities v at
/// all three levels. The contradiction with the largest excess over the tolerance comes first. The
/// independent rows K must be satisfied: `Φ_K = 0` and `C_K·v = b_K` to rounding.
///
/// The sum over a circuit is compared with the size of the terms that are added in its rows
/// ([`model::Scales::terms`]), times the noise of the coefficients, [`rank::support_tolerance`].
/// Near a singular configuration, the coefficients that express redundant rows by independent rows
/// have errors of 1/σ_r rounding errors, so the rows cannot agree better. Only rows that are
/// coupled with the rows of the circuit count. Therefore large terms in other rows do not hide a
/// contradiction.
///
/// # Errors
/// The function returns an error if the state has the wrong number of values, or if a value is not
/// finite.
pub fn contradictions(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    v: &[f64],
    ranks: Ranks<'_>,
) -> Result<Vec<Contradiction>, StateError> {
    state::check_state(mechanism, t, q, v)?;
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    mechanism.b(&mut s);
    mechanism.twist(v, &mut s);
    mechanism.gamma(&mut s);
    let size = scene_size(mechanism, q);
    let scales = mechanism.scales(&s);
    let compared = |level: Level<'_>, decision, values| {
        let comparison = LevelValues {
            level,
            prescribed: &s,
            decision,
            values,
            scale: &|i| scales.terms(i, &level),
            share: 0.0,
        };
        comparison.contradictions(mechanism, t)
    };
    // Rows that are redundant within a tolerance may become inconsistent. The residuals of these
    // rows then determine whether the rows contradict each other.
    let mut found = [
        compared(Level::positions(), ranks.holonomic, &s.phi),
        compared(Level::velocities(mechanism, size, v), ranks.all, &s.b),
        compared(
            Level::accelerations(mechanism, size, v, None),
            ranks.all,
            &s.gamma,
        ),
    ]
    .concat();
    let excess = |c: &Contradiction| c.size / c.tolerance;
    found.sort_by(|a, b| excess(b).total_cmp(&excess(a)));
    Ok(found)
}

/// Returns whether redundant rows may require accelerations that differ from those of the rows that
/// imply them. Such rows may be violated later. If a tolerance is stated, rows may be redundant
/// only within this tolerance. The independent rows then have a motion and reactions, until the
/// violation of a row exceeds the violation that data within the tolerance can cause.
#[must_use]
pub fn may_miss(mechanism: &Mechanism) -> bool {
    mechanism.has_tolerances()
}

/// Values of all rows at one level, and the size of their terms.
struct LevelValues<'a> {
    level: Level<'a>,
    /// Scratch in which the functions of time have been evaluated.
    prescribed: &'a Scratch,
    decision: &'a RankDecision,
    values: &'a [f64],
    scale: &'a dyn Fn(usize) -> f64,
    /// Contradictions below this fraction of the terms are not reported, even if they exceed
    /// rounding.
    share: f64,
}

impl LevelValues<'_> {
    /// Returns the contradictions of the shortest circuits.
    fn contradictions(&self, mechanism: &Mechanism, time: f64) -> Vec<Contradiction> {
        match self.decision.redundancy {
            0 => Vec::new(),
            _ if self.agree() => Vec::new(),
            _ => self.among(rank::short_circuits(self.decision), mechanism, time),
        }
    }

    /// Returns whether the dependencies of the redundant rows show that no circuit contradicts. In
    /// equilibrated rows, a circuit is the sum of these dependencies with its own coefficients at
    /// the redundant rows as weights. Therefore the sum over a circuit is at most its largest
    /// coefficient times the sum over all dependencies. The tolerance of the circuit is at least
    /// its largest coefficient times the noise of the terms in one of its redundant rows. No
    /// circuit has to be known for this comparison.
    fn agree(&self) -> bool {
        let RankDecision {
            kept,
            dropped,
            scaling,
            coefficients,
            ..
        } = self.decision;
        let value = |i: usize| scaling.row_factor(i) * self.values[i];
        let own: Vec<f64> = kept.iter().map(|&i| value(i)).collect();
        let sums = dropped.iter().enumerate().map(|(j, &row)| {
            let implied: f64 = coefficients
                .row(j)
                .iter()
                .zip(&own)
                .map(|(t, x)| t * x)
                .sum();
            (value(row) - implied).abs()
        });
        let sum: f64 = sums.sum();
        let terms = |&row: &usize| scaling.row_factor(row) * (self.scale)(row);
        let noise = rank::support_tolerance(self.decision);
        // NaN values show nothing.
        sum == 0.0 || dropped.iter().all(|row| sum <= noise * terms(row))
    }

    /// Returns the contradictions of the given circuits.
    fn among(
        &self,
        circuits: Vec<Circuit>,
        mechanism: &Mechanism,
        time: f64,
    ) -> Vec<Contradiction> {
        let rows = rank::components(self.decision);
        let noise = rank::support_tolerance(self.decision);
        let term = |&i: &usize| self.decision.scaling.row_factor(i) * (self.scale)(i);
        // For rows without a dependency, the remaining coefficients are rounding.
        let left = self.decision.equilibrated_dependence();
        let coefficient = |i: &usize| {
            let k = self.decision.kept.binary_search(i).ok();
            let column = |k: usize| (0..left.nrows()).map(move |j| (j, k));
            k.map_or(0.0, |k| {
                column(k).map(|at| left[at].abs()).fold(0.0, f64::max)
            })
        };
        let aside: f64 = rows.coloops.iter().map(|i| coefficient(i) * term(i)).sum();
        circuits
            .iter()
            .filter_map(|circuit| {
                let first = circuit.rows.first()?;
                // Coefficients of rows that are coupled with these rows may have an error of this
                // size. This also applies to coefficients that count as zero.
                let component = rows.coupled.iter().find(|rows| rows.contains(first))?;
                let terms: f64 = component.iter().map(term).sum();
                self.contradiction(mechanism, time, circuit, noise * terms + aside)
            })
            .collect()
    }

    fn contradiction(
        &self,
        mechanism: &Mechanism,
        time: f64,
        circuit: &Circuit,
        noise: f64,
    ) -> Option<Contradiction> {
        let terms = || circuit.rows.iter().copied().zip(&circuit.coefficients);
        let sum: f64 = terms().map(|(i, z)| z * self.values[i]).sum();
        let equilibrated = terms().map(|(i, z)| z.abs() / self.decision.scaling.row_factor(i));
        let scales = mechanism.scales(self.prescribed);
        let rest: f64 = terms()
            .map(|(i, z)| z.abs() * scales.rest(i, &self.level))
            .sum();
        let tolerance =
            noise * equilibrated.fold(0.0, f64::max) + rest + self.within_data(mechanism, circuit);
        if sum.abs() <= tolerance {
            return None;
        }
        let layout = mechanism.layout();
        let driven_by = |row: usize| {
            let owner = layout.owners.get(row)?.0;
            layout.groups[owner].spec.rheonomic.then_some(owner)
        };
        let drives: BTreeSet<usize> = terms().filter_map(|(i, _)| driven_by(i)).collect();
        let forced = match (drives.is_empty(), self.level.of) {
            (true, ConstraintLevel::Acceleration) => self.forcing(mechanism, &circuit.rows),
            _ => BTreeSet::new(),
        };
        let is_forced = !forced.is_empty();
        let drives = if is_forced { forced } else { drives };
        let demands = drives
            .iter()
            .filter_map(|&k| Demand::of(mechanism, ConstraintId(k), self.prescribed));
        let driven = terms().rfind(|&(i, _)| driven_by(i).is_some());
        let (row, z) = driven.or_else(|| terms().next_back())?;
        let largest = terms().map(|(i, _)| (self.scale)(i)).fold(0.0, f64::max);
        let (size, tolerance) = (
            (sum / z).abs(),
            (tolerance / z.abs()).max(self.share * largest),
        );
        if size <= tolerance {
            return None;
        }
        Some(Contradiction {
            time,
            rows: terms().map(|(i, _)| layout.labels[i].clone()).collect(),
            level: self.level.of,
            size,
            unit: self.level.of.unit(mechanism.layout().is_angular(row)),
            tolerance,
            demands: demands.collect(),
            drives: drives.len(),
            is_forced,
        })
    }

    /// Returns how much data within a stated tolerance change the sum over a circuit, or zero if no
    /// tolerance is stated.
    fn within_data(&self, mechanism: &Mechanism, circuit: &Circuit) -> f64 {
        if !mechanism.has_tolerances() {
            return 0.0;
        }
        let mut weights = vec![0.0; mechanism.layout().rows()];
        for (&row, z) in circuit.rows.iter().zip(&circuit.coefficients) {
            weights[row] = *z;
        }
        let (data, s) = (mechanism.data(), self.prescribed);
        let mut gradient = vec![0.0; data.count()];
        data.explained(s, &data.blocks(s), &weights, &self.level, &mut gradient)
    }

    /// Returns the drives (numbers of groups) that move the bodies of these rows. Together with the
    /// joints, these drives determine the velocities of the bodies. The set is empty if the bodies
    /// have other possible velocities with which the rows might remain satisfied.
    fn forcing(&self, mechanism: &Mechanism, rows: &[usize]) -> BTreeSet<usize> {
        let layout = mechanism.layout();
        let group = |row: usize| layout.owners[row].0;
        let bodies = |k: usize| layout.groups[k].bodies.iter().filter_map(|b| b.moving());
        let Some(first) = rows.first().and_then(|&row| bodies(group(row)).next()) else {
            return BTreeSet::new();
        };
        let all = mechanism.components().into_iter();
        let Some(component) = all.into_iter().find(|set| set.contains(&first)) else {
            return BTreeSet::new();
        };
        let is_here = |k: usize| bodies(k).any(|body| component.binary_search(&body).is_ok());
        let kept = self
            .decision
            .kept
            .iter()
            .filter(|&&row| is_here(group(row)));
        let freedoms = component.len() * layout.n_v / mechanism.bodies().len();
        if kept.count() < freedoms {
            return BTreeSet::new();
        }
        let moves = |k: &usize| {
            let functions = mechanism.prescribed(ConstraintId(*k), self.prescribed);
            layout.groups[*k].is_drive() && functions.iter().any(|[_, rate, _]| *rate != 0.0)
        };
        (0..layout.groups.len())
            .filter(|&k| is_here(k))
            .filter(moves)
            .collect()
    }
}
