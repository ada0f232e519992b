//! Velocities that are given and that no motion has: which one is at fault, what it contradicts,
//! and what to leave out.

use rank::Circuit;

use super::tier::Tier;
use super::velocity::{Hold, Miss, Start};
use super::{CorrectionLimit, StartError};
use crate::mechanism::N_BODY;
use crate::system::{RowLabel, System};

/// Given velocities that contradict the constraints, or what moves by itself.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}; {}", self.what(), self.advice())]
#[non_exhaustive]
pub struct VelocityConflict {
    /// The body of the velocity that is at fault: the one that is farthest from where it would be
    /// if it were left out with the others of its kind.
    pub body: String,
    /// `vx`, `vy` or `omega`.
    pub coordinate: &'static str,
    /// What it is given as.
    pub given: f64,
    /// Whether `keep` holds it.
    pub is_kept: bool,
    /// What it is in velocities that fit: if it is left out, or else in the nearest ones in the
    /// mass metric.
    pub nearest: f64,
    /// What the difference may be (m/s, rad/s).
    pub limit: f64,
    /// Rows that forbid it; those that prescribe a motion come first.
    pub rows: Vec<RowLabel>,
    /// Whether they forbid it only together with other velocities that are held.
    pub with_others: bool,
    /// Drives, and joints that prescribe a velocity, among these.
    pub drives: Vec<String>,
    /// Without these the others hold.
    pub leave_out: Vec<HeldVelocity>,
    /// Whether `leave_out` is enough; it is not where more velocities contradict the constraints
    /// than are looked for.
    pub is_enough: bool,
    /// Whether there are velocities that fit with what `keep` holds.
    pub can_be_corrected: bool,
}

/// What holds a velocity.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum HeldVelocity {
    /// `velocity` of a body.
    Velocity {
        /// The body.
        body: String,
    },
    /// `angular_velocity` of a body.
    AngularVelocity {
        /// The body.
        body: String,
    },
    /// An entry of `keep`.
    Keep {
        /// The body.
        body: String,
        /// `vx`, `vy` or `omega`.
        coordinate: &'static str,
    },
}

impl std::fmt::Display for HeldVelocity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Velocity { body } => write!(f, "`velocity` of body `{body}`"),
            Self::AngularVelocity { body } => write!(f, "`angular_velocity` of body `{body}`"),
            Self::Keep { body, coordinate } => write!(f, "`{body}.{coordinate}` in `keep`"),
        }
    }
}

/// Rows, and velocities to leave out, that a message names.
const NAMED: usize = 6;

/// Velocities to leave out that are looked for.
const LEFT_OUT: usize = 40;

/// A velocity takes no part in a sum of rows below this share of its terms: what is left is
/// rounding, also far from the origin.
const CANCELLED: f64 = 1e-10;

impl VelocityConflict {
    /// One for all: the worst is told, and what to leave out of all.
    pub(super) fn merged(conflicts: Vec<Self>) -> Option<Self> {
        let off = |c: &Self| (c.nearest - c.given).abs() / c.limit;
        conflicts.into_iter().reduce(|mut a, mut b| {
            if off(&b) > off(&a) {
                std::mem::swap(&mut a, &mut b);
            }
            a.leave_out.append(&mut b.leave_out);
            a.leave_out.sort();
            a.leave_out.dedup();
            a.is_enough &= b.is_enough;
            a.can_be_corrected &= b.can_be_corrected;
            a
        })
    }

    fn what(&self) -> String {
        let Self {
            body,
            coordinate,
            given,
            nearest,
            ..
        } = self;
        let held = match self.is_kept {
            true => "held by `keep` at",
            false => "given as",
        };
        let rows: Vec<String> = self.rows.iter().map(RowLabel::to_string).collect();
        let word = if rows.len() == 1 { "row" } else { "rows" };
        let off = match self.is_kept {
            true => String::new(),
            false => format!(", more than {:.1e} off", self.limit),
        };
        // As it is written.
        let given_as = match (format!("{given}"), format!("{given:?}")) {
            (plain, scientific) if scientific.len() < plain.len() => scientific,
            (plain, _) => plain,
        };
        let fact = format!("`{coordinate}` of body `{body}` is {held} {given_as}");
        let nearest = format!(
            "in velocities that fit it is {}{off}",
            short(*nearest, *given)
        );
        let rows = named(&rows);
        match self.drives.as_slice() {
            [] if self.rows.is_empty() => {
                format!("{fact}, which the constraints do not allow: {nearest}")
            }
            [] => {
                let (do_not, beside) = match (self.rows.len(), self.with_others) {
                    (1, true) => ("does not", " beside what else is given"),
                    (1, false) => ("does not", ""),
                    (_, true) => ("do not", " beside what else is given"),
                    (_, false) => ("do not", ""),
                };
                format!("{fact}, which {word} {rows} {do_not} allow{beside}: {nearest}")
            }
            [only] => format!(
                "drive `{only}` asks for what the given velocities do not allow: {fact}, and {nearest} ({word} {rows})"
            ),
            drives => {
                let drives: Vec<String> = drives.iter().map(|d| format!("`{d}`")).collect();
                format!(
                    "drives {} ask for what the given velocities do not allow: {fact}, and {nearest} ({word} {rows})",
                    named(&drives)
                )
            }
        }
    }

    fn advice(&self) -> String {
        let out: Vec<String> = self.leave_out.iter().map(HeldVelocity::to_string).collect();
        let mut ways = Vec::new();
        match out.as_slice() {
            [] => {}
            [only] => ways.push(format!(
                "leave out {only}, so that it follows from the others"
            )),
            // All of them are told: less would not be enough.
            [first @ .., last] => ways.push(format!(
                "leave out {} and {last}, so that they follow from the others",
                first.join(", ")
            )),
        }
        if !self.is_enough {
            ways.push("look for more that are wrong".to_owned());
        }
        if let [first, ..] = self.drives.as_slice() {
            ways.push(format!("or change what `{first}` prescribes"));
        }
        if self.can_be_corrected {
            ways.push("or set `allow_correction = true` in `[start]`, which takes the nearest ones that fit".to_owned());
        }
        ways.join("; ")
    }
}

/// A velocity with five digits; what is rounding of another one is none.
fn short(x: f64, beside: f64) -> String {
    let x = if x.abs() <= CANCELLED * beside.abs() {
        0.0
    } else {
        x
    };
    let rounded = format!("{x:.4e}");
    match x.abs() {
        size if size != 0.0 && !(1e-4..1e6).contains(&size) => rounded,
        _ => rounded.parse::<f64>().map_or(rounded, |x| x.to_string()),
    }
}

/// The first of some names, and how many more.
fn named(all: &[String]) -> String {
    let first = all
        .iter()
        .take(NAMED)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    match all.len().saturating_sub(NAMED) {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}

/// A velocity that rows forbid.
struct Fault {
    column: usize,
    /// What prescribes a motion comes first.
    rows: Vec<RowLabel>,
    /// What prescribes a motion.
    drives: Vec<String>,
    /// Whether others that are held take part.
    with_others: bool,
}

impl Start<'_> {
    /// Why some rows have no velocities that may be taken, `miss` being what was found first.
    ///
    /// # Errors
    /// [`StartError::NoVelocity`]: they have none, whichever are given.
    pub(super) fn conflict(
        &self,
        rows: &[usize],
        miss: Miss,
    ) -> Result<VelocityConflict, StartError> {
        let mechanism = self.equations.mechanism;
        let columns = self.equations.columns(rows);
        let mut nearest = self.written.clone();
        let Some(column) = self.culprit(rows, &columns, &self.hold, &mut nearest)? else {
            let row = match miss {
                Miss::Open(row) => row,
                Miss::Far => rows[0],
            };
            return Err(StartError::NoVelocity {
                worst: mechanism.layout().labels[row].clone(),
                residual: self.equations.residual(row, &nearest),
            });
        };
        let mut v = self.written.clone();
        let can_be_corrected = self
            .solve(rows, &self.hold, CorrectionLimit::Any, &mut v)?
            .is_none();
        let (leave_out, hold, is_enough) = self.leave_out(rows, &columns)?;
        // Of what is to be left out the one that then is farthest from what is given: the rest is
        // not at fault.
        let mut candidates = vec![column];
        if is_enough && self.solve(rows, &hold, self.limit, &mut v)?.is_none() {
            let by = |j: usize| self.equations.arm(j) * (v[j] - self.written[j]).abs();
            let freed = columns.iter().copied().filter(|&j| hold[j] != self.hold[j]);
            let mut freed: Vec<usize> = freed.filter(|&j| by(j) > 0.0).collect();
            if !freed.is_empty() {
                freed.sort_by(|&a, &b| by(b).total_cmp(&by(a)));
                candidates = freed;
                nearest.copy_from_slice(&v);
            }
        }
        let Fault {
            column,
            rows: rows_at_fault,
            drives,
            with_others,
        } = self.fault(rows, &candidates)?;
        let body = &mechanism.bodies()[column / N_BODY];
        Ok(VelocityConflict {
            body: body.name.clone(),
            coordinate: NAMES[column % N_BODY],
            given: self.written[column],
            is_kept: self.hold[column] == Hold::Kept,
            nearest: nearest[column],
            limit: self.allowed(column, &columns, &self.hold, &nearest),
            rows: rows_at_fault,
            with_others,
            drives,
            leave_out,
            is_enough,
            can_be_corrected,
        })
    }

    /// The held velocity that is farthest from the nearest ones that fit, where all may move;
    /// `None` if there are none. Writes these.
    fn culprit(
        &self,
        rows: &[usize],
        columns: &[usize],
        hold: &[Hold],
        nearest: &mut [f64],
    ) -> Result<Option<usize>, StartError> {
        let mut all = hold.to_vec();
        for &j in columns.iter().filter(|&&j| hold[j] == Hold::Kept) {
            all[j] = Hold::Given;
        }
        if self
            .solve(rows, &all, CorrectionLimit::Any, nearest)?
            .is_some()
        {
            return Ok(None);
        }
        let by = |j: usize| self.equations.arm(j) * (nearest[j] - self.written[j]).abs();
        let held = || columns.iter().copied().filter(|&j| hold[j] != Hold::No);
        let is_far = |j: &usize| {
            (nearest[*j] - self.written[*j]).abs() > self.allowed(*j, columns, hold, nearest)
        };
        let farthest = |a: &usize, b: &usize| by(*a).total_cmp(&by(*b));
        Ok(held()
            .filter(is_far)
            .max_by(farthest)
            .or_else(|| held().max_by(farthest)))
    }

    /// The first of these velocities that rows forbid while the rest of what is held holds.
    fn fault(&self, rows: &[usize], candidates: &[usize]) -> Result<Fault, StartError> {
        let of = &self.equations;
        let mut v = self.written.clone();
        let mut tier = Tier::new(of, rows, |j| self.hold[j] == Hold::No)?;
        tier.follow(of, &mut v)?;
        let takes_part = |circuit: &Circuit, column: usize| {
            let c = of.matrix(&circuit.rows, &[column]);
            let terms = || {
                circuit
                    .coefficients
                    .iter()
                    .zip(c.as_slice())
                    .map(|(z, c)| z * c)
            };
            let size: f64 = terms().map(f64::abs).sum();
            terms().sum::<f64>().abs() > CANCELLED * size
        };
        let shortest = candidates.iter().find_map(|&column| {
            let open = tier.open(of, &v).filter(|c| takes_part(c, column));
            Some((column, open.min_by_key(|c| c.rows.len())?))
        });
        let (column, found, with_others) = match shortest {
            Some((column, circuit)) => {
                let columns = of.columns(&circuit.rows).into_iter();
                let mut others = columns.filter(|&j| j != column && self.hold[j] != Hold::No);
                let with_others = others.any(|j| takes_part(circuit, j));
                (column, circuit.rows.clone(), with_others)
            }
            // Of large sets there are no circuits: the rows that do not hold.
            None => {
                let is_open = |&i: &usize| of.residual(i, &v).abs() > of.rounding(i, &v);
                let open = rows.iter().copied().filter(is_open);
                (candidates[0], open.collect::<Vec<_>>(), true)
            }
        };
        let layout = of.mechanism.layout();
        let prescribes = |i: &usize| {
            let at = layout.groups.partition_point(|g| g.rows.end <= *i);
            layout.groups[at].spec.rheonomic
        };
        let (drives, joints): (Vec<usize>, Vec<usize>) = found.into_iter().partition(prescribes);
        let mut names: Vec<String> = drives
            .iter()
            .map(|&i| layout.labels[i].joint.clone())
            .collect();
        names.dedup();
        let labels = drives
            .into_iter()
            .chain(joints)
            .map(|i| layout.labels[i].clone());
        Ok(Fault {
            column,
            rows: labels.collect(),
            drives: names,
            with_others,
        })
    }

    /// Given velocities without which the others hold, the farthest off first, none of which could
    /// stay; what is held then; and whether these are enough.
    fn leave_out(
        &self,
        rows: &[usize],
        columns: &[usize],
    ) -> Result<(Vec<HeldVelocity>, Vec<Hold>, bool), StartError> {
        let mut hold = self.hold.clone();
        let mut v = self.written.clone();
        let mut freed: Vec<(HeldVelocity, Vec<(usize, Hold)>)> = Vec::new();
        while self.solve(rows, &hold, self.limit, &mut v)?.is_some() {
            let mut nearest = self.written.clone();
            let worst = self.culprit(rows, columns, &hold, &mut nearest)?;
            let (Some(column), true) = (worst, freed.len() < LEFT_OUT) else {
                let freed = freed.into_iter().map(|(what, _)| what);
                return Ok((freed.collect(), hold, false));
            };
            freed.push(self.free(column, &mut hold));
        }
        let mut needed = Vec::new();
        let last = freed.pop();
        for (what, before) in freed {
            let mut tried = hold.clone();
            for &(j, was) in &before {
                tried[j] = was;
            }
            // An entry of `keep` whose velocity is left out would hold zero.
            let is_other = |&(j, was): &(usize, Hold)| {
                was == Hold::Kept && hold[j] == Hold::No && self.is_written[j]
            };
            match before.iter().any(is_other)
                || self.solve(rows, &tried, self.limit, &mut v)?.is_some()
            {
                false => hold = tried,
                true => needed.push(what),
            }
        }
        needed.extend(last.map(|(what, _)| what));
        Ok((needed, hold, true))
    }

    /// Frees a velocity by what one who writes scenes can take away, and says how the velocities
    /// were held that this frees.
    fn free(&self, column: usize, hold: &mut [Hold]) -> (HeldVelocity, Vec<(usize, Hold)>) {
        let body = self.equations.mechanism.bodies()[column / N_BODY]
            .name
            .clone();
        let first = column - column % N_BODY;
        let own = match column % N_BODY {
            2 => column..column + 1,
            _ => first..first + 2,
        };
        // An entry of `keep` goes before what it holds: without the latter it would hold zero.
        if let Some(kept) = own.clone().find(|&j| hold[j] == Hold::Kept) {
            let to = match self.is_written[kept] {
                true => Hold::Given,
                false => Hold::No,
            };
            let coordinate = NAMES[kept % N_BODY];
            let before = std::mem::replace(&mut hold[kept], to);
            return (
                HeldVelocity::Keep { body, coordinate },
                vec![(kept, before)],
            );
        }
        let what = match column % N_BODY {
            2 => HeldVelocity::AngularVelocity { body },
            _ => HeldVelocity::Velocity { body },
        };
        let before = own.map(|j| (j, std::mem::replace(&mut hold[j], Hold::No)));
        (what, before.collect())
    }
}

/// Velocities of a body.
const NAMES: [&str; N_BODY] = ["vx", "vy", "omega"];
