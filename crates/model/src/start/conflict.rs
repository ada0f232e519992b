//! Description of impossible given velocities.

use crate::system::RowLabel;
use crate::words::{ROLL_TOGETHER, digits, rough, units};

/// Given velocities that contradict the constraints or prescribed motions.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}; {}", self.what(), self.advice())]
#[non_exhaustive]
pub struct VelocityConflict {
    /// The body of the wrong velocity. Each wrong velocity has a value that is computed if no wrong
    /// velocity is given. For the reported velocity, the difference between this value and the
    /// given value is largest.
    pub body: String,
    /// Name of the velocity: `vx`, `vy` or `omega`; in space `vx` to `wz`, in ground axes.
    pub coordinate: &'static str,
    /// The given value.
    pub given: f64,
    /// Whether the velocity is in `keep`.
    pub is_kept: bool,
    /// Value of the velocity if the wrong velocities are not given. If such velocities do not
    /// exist, the value in the closest compatible velocities in the mass metric.
    pub nearest: f64,
    /// Largest permitted difference (m/s, rad/s).
    pub limit: f64,
    /// Rows that contradict the given velocity; rows that prescribe a motion come first.
    pub rows: Vec<RowLabel>,
    /// Whether the contradiction involves other given or kept velocities.
    pub with_others: bool,
    /// Drives, and joints that prescribe a velocity, to which these rows belong.
    pub drives: Vec<String>,
    /// Velocities that must be removed so that the remaining velocities are possible.
    pub leave_out: Vec<HeldVelocity>,
    /// Whether the removal of `leave_out` is sufficient. It is not sufficient if more velocities
    /// contradict the constraints than the search can find.
    pub is_enough: bool,
    /// Whether compatible velocities exist that contain all velocities in `keep`.
    pub can_be_corrected: bool,
    /// The locked bodies, if only zero velocities are possible.
    pub locked: Option<LockedBodies>,
}

/// Bodies whose independent rows permit only zero velocities, so that the mobility is 0.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LockedBodies {
    /// The bodies.
    pub bodies: Vec<String>,
    /// The joints and drives of the rows.
    pub joints: Vec<String>,
    /// The joints in `joints` with nonholonomic rows, such as wheels.
    pub wheels: Vec<String>,
}

/// The entry of a scene that prescribes an initial velocity.
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
        /// `vx`, `vy` or `omega`; in space `vx` to `wz`, or `omega`.
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

/// Number of significant digits of a given velocity. The digits are those of the scene also if the
/// unit of the scene is not the SI unit.
const GIVEN: usize = 15;

/// Largest number of rows, and of velocities to remove, in a message.
const NAMED: usize = 6;

/// A velocity does not contribute to a sum of rows if its coefficient is below this fraction of the
/// terms of the sum. The coefficient is then only rounding, even far from the origin.
pub(super) const CANCELLED: f64 = 1e-10;

impl VelocityConflict {
    /// Merges several conflicts into the conflict with the largest difference. The result lists all
    /// velocities that must be removed.
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
            body, coordinate, ..
        } = self;
        let unit = if coordinate.starts_with('v') {
            "m/s"
        } else {
            "rad/s"
        };
        let (unit, factor) = units().unprefixed(unit);
        let [given, nearest, limit] = [self.given, self.nearest, self.limit].map(|x| x / factor);
        let held = if self.is_kept {
            "fixed by `keep` at"
        } else {
            "given as"
        };
        let rows: Vec<String> = self.rows.iter().map(RowLabel::to_string).collect();
        let word = if rows.len() == 1 { "row" } else { "rows" };
        let off = if self.is_kept {
            String::new()
        } else {
            format!(", more than {} {unit} off", rough(limit))
        };
        let given_as = digits(given, GIVEN);
        let fact = format!("`{coordinate}` of body `{body}` is {held} {given_as} {unit}");
        if let Some(LockedBodies { bodies, joints, .. }) = &self.locked {
            let names = |all: &[String]| {
                let quoted = all.iter().map(|name| format!("`{name}`"));
                named(&quoted.collect::<Vec<_>>())
            };
            let word = if bodies.len() == 1 { "body" } else { "bodies" };
            return format!(
                "{fact}, but {word} {} cannot move, mobility 0: the joints {} leave no free velocity",
                names(bodies),
                names(joints)
            );
        }
        let nearest = format!(
            "in consistent velocities it is {} {unit}{off}",
            short(nearest, given)
        );
        let rows = named(&rows);
        match self.drives.as_slice() {
            [] if self.rows.is_empty() => {
                format!("{fact}, which the constraints do not allow: {nearest}")
            }
            [] => {
                let (do_not, beside) = match (self.rows.len(), self.with_others) {
                    (1, true) => ("does not", " together with the other given velocities"),
                    (1, false) => ("does not", ""),
                    (_, true) => ("do not", " together with the other given velocities"),
                    (_, false) => ("do not", ""),
                };
                format!("{fact}, which {word} {rows} {do_not} allow{beside}: {nearest}")
            }
            [only] => format!(
                "drive `{only}` requires velocities that the given ones do not allow: {fact}, and {nearest} ({word} {rows})"
            ),
            drives => {
                let drives: Vec<String> = drives.iter().map(|d| format!("`{d}`")).collect();
                format!(
                    "drives {} require velocities that the given ones do not allow: {fact}, and {nearest} ({word} {rows})",
                    named(&drives)
                )
            }
        }
    }

    fn advice(&self) -> String {
        let out: Vec<String> = self.leave_out.iter().map(HeldVelocity::to_string).collect();
        let mut ways = Vec::new();
        if let Some(LockedBodies { wheels, .. }) = &self.locked {
            let given = match out.as_slice() {
                [] => "the given velocities".to_owned(),
                [only] => only.clone(),
                [first @ .., last] => format!("{} and {last}", first.join(", ")),
            };
            let release = match wheels.as_slice() {
                [] => "release one of these joints",
                _ => ROLL_TOGETHER,
            };
            return format!(
                "omit {given}, so that they stay at rest; or {release}, if they should move"
            );
        }
        match out.as_slice() {
            [] => {}
            [only] => ways.push(format!(
                "omit {only}, so that it follows from the other velocities"
            )),
            // All of these velocities are listed, because the removal of fewer velocities would not
            // be sufficient.
            [first @ .., last] => ways.push(format!(
                "omit {} and {last}, so that they follow from the other velocities",
                first.join(", ")
            )),
        }
        if !self.is_enough {
            ways.push("check for further errors".to_owned());
        }
        if let [first, ..] = self.drives.as_slice() {
            ways.push(format!("or change what `{first}` prescribes"));
        }
        if self.can_be_corrected {
            let kept = match (self.is_kept, self.with_others) {
                (true, _) => ", with those in `keep` unchanged".to_owned(),
                (false, true) => format!(
                    "; with `keep = [\"{}.{}\"]` this one does not change",
                    self.body, self.coordinate
                ),
                (false, false) => String::new(),
            };
            ways.push(format!(
                "or set `allow_correction = true` in `[start]`, which uses the nearest consistent velocities{kept}"
            ));
        }
        ways.join("; ")
    }
}

/// Formats a velocity with five digits. The result is zero if the velocity is not larger than the
/// rounding error of `beside`.
fn short(x: f64, beside: f64) -> String {
    let x = if x.abs() <= CANCELLED * beside.abs() {
        0.0
    } else {
        x
    };
    digits(x, 5)
}

/// Returns the first names as a list, and the number of the remaining names.
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
