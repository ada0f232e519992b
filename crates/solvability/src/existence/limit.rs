//! Finds limit positions of drives. The configurations of the constraints form a curve in
//! coordinates and time. At a limit position, time has a maximum on this curve. The rank of Φq
//! drops at the limit position, and no later configuration is nearby.
//!
//! The continuation uses the length of the curve as parameter and time as an additional unknown. At
//! the maximum the rows are dependent in the coordinates, but not in coordinates and time. If
//! `zᵀ·Φq = 0` at the maximum, a velocity w with `Φq·w = 0` changes time by `t'' = zᵀ·Γ(w) /
//! (zᵀ·Φ_t)`. Time has a maximum if this value is negative.

use linalg::{Matrix, PivotedQr, least_squares_step, symmetric_eigen};
use model::start::scene_size;
use model::words::quantity;
use model::{ConstraintId, Mechanism, Scratch, System};

use crate::limits::{
    LIMIT_ARRIVED, LIMIT_CORRECTIONS, LIMIT_FORMS, LIMIT_HALVINGS, LIMIT_ROUNDING, LIMIT_STEP,
    LIMIT_STEPS,
};
use crate::pose::velocity_units;
use crate::state::check_state;
use crate::words;

/// Drives that cannot continue, because no configuration exists beyond their limit position.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DriveLimit {
    /// The last time with a configuration (s).
    pub time: f64,
    /// The drives, and the joints with functions of time, that reach their limit together.
    pub drives: Vec<LimitedDrive>,
}

/// A drive at the last configuration that the drive reaches.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LimitedDrive {
    /// The drive, or the joint with a function of time.
    pub name: String,
    /// Whether it is a drive.
    pub is_drive: bool,
    /// The driven joint and its joint coordinate, if there is such a joint.
    pub joint: Option<(String, &'static str)>,
    /// The joint coordinate that the drive prescribes.
    pub measure: &'static str,
    /// Whether the joint coordinate is an angle.
    pub angular: bool,
    /// The value of the joint coordinate at the limit position (m, rad).
    pub value: Option<f64>,
}

impl std::fmt::Display for DriveLimit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.drives.as_slice() {
            [only] => {
                let word = if only.is_drive { "drive" } else { "joint" };
                let what = match (&only.joint, only.angular) {
                    (Some((joint, _)), true) => format!("turn `{joint}`"),
                    (Some((joint, _)), false) => format!("move `{joint}`"),
                    (None, _) => format!("bring its {}", only.measure),
                };
                let beyond = only.there().unwrap_or_else(|| "this place".to_owned());
                write!(f, "{word} `{}` cannot {what} beyond {beyond}", only.name)
            }
            drives => {
                let names = drives.iter().map(|drive| format!("`{}`", drive.name));
                let at = drives.iter().filter_map(|drive| {
                    let name = drive.joint.as_ref().map_or(&drive.name, |(joint, _)| joint);
                    Some(format!("`{name}` at {}", drive.there()?))
                });
                let at: Vec<String> = at.collect();
                let beyond = match at.as_slice() {
                    [] => "this place".to_owned(),
                    at => words::list(at),
                };
                let names: Vec<String> = names.collect();
                write!(
                    f,
                    "drives {} cannot continue together beyond {beyond}",
                    words::list(&names)
                )
            }
        }?;
        f.write_str(": there is no configuration")
    }
}

impl LimitedDrive {
    fn of(mechanism: &Mechanism, id: ConstraintId, s: &Scratch) -> Self {
        let groups = &mechanism.layout().groups;
        let group = &groups[id.0];
        let driven = mechanism.driven(id);
        let blocks = mechanism.data().blocks(s);
        // If no parameter states the value that a drive keeps from its start, the value is the
        // joint coordinate at the start.
        let is_stated = |name: &str| group.spec.common.parameters.iter().any(|p| p.name == name);
        let zero = blocks
            .iter()
            .find(|b| b.group == id.0 && !is_stated(b.name));
        let zero = zero.map(|b| mechanism.data().numbers()[b.numbers.start]);
        let value = match (zero, mechanism.prescribed(id, s)) {
            (Some(zero), [f]) => Some(zero + f[0]),
            _ => None,
        };
        Self {
            name: group.name.clone(),
            is_drive: group.is_drive(),
            joint: driven.map(|(joint, measure)| (groups[joint.0].name.clone(), measure)),
            measure: group.spec.common.scene_type,
            angular: mechanism.layout().is_angular(group.rows.row(0)),
            value: value.filter(|_| group.is_drive()),
        }
    }

    /// Returns the value of the joint coordinate with its unit.
    fn there(&self) -> Option<String> {
        let value = self.value?;
        if self.angular {
            return Some(format!("{:.1}°", value.to_degrees()));
        }
        Some(quantity(value, "m"))
    }
}

/// Returns the drives that cannot continue just after time t, at coordinates q and velocities v.
/// The rows `kept` of Φ must be independent at q. Returns `None` if time has no maximum near this
/// point on the curve of configurations, or if several free motions leave this undecided.
#[must_use]
pub fn drive_limit(
    mechanism: &Mechanism,
    kept: &[usize],
    (t, q, v): (f64, &[f64], &[f64]),
) -> Option<DriveLimit> {
    check_state(mechanism, t, q, v).ok()?;
    let curve = Curve::new(mechanism, kept, t, q)?;
    let mut at = CurvePoint {
        t,
        q: q.to_vec(),
        ahead: curve.given(v),
    };
    at.ahead = curve.tangent(&at)?;
    for _ in 0..LIMIT_STEPS {
        let next = curve.step(&at, LIMIT_STEP)?;
        if curve.rate_of_time(&next) < 0.0 {
            let highest = curve.highest(at);
            return curve.limit(&highest);
        }
        at = next;
    }
    None
}

/// A point of the curve, and the direction in which the curve continues. The direction consists of
/// dimensionless coordinates and time.
struct CurvePoint {
    t: f64,
    q: Vec<f64>,
    ahead: Vec<f64>,
}

/// The curve of configurations in coordinates and time.
struct Curve<'m> {
    mechanism: &'m Mechanism,
    kept: &'m [usize],
    /// Displacements of one unit: the size of the mechanism, or a radian.
    units: Vec<f64>,
    /// Units of the values of the kept rows.
    row_units: Vec<f64>,
    /// Time in which the fastest function of time changes by one unit (s).
    second: f64,
}

impl<'m> Curve<'m> {
    /// Creates the curve, or returns `None` if no row depends on time.
    fn new(mechanism: &'m Mechanism, kept: &'m [usize], t: f64, q: &[f64]) -> Option<Self> {
        let size = scene_size(mechanism, q);
        let units = velocity_units(mechanism, size);
        let of_row = |&i: &usize| {
            if mechanism.layout().is_angular(i) {
                1.0
            } else {
                size
            }
        };
        let mut curve = Self {
            mechanism,
            kept,
            units: units.iter().map(|unit| unit * size).collect(),
            row_units: kept.iter().map(of_row).collect(),
            second: 1.0,
        };
        let s = curve.evaluated(t, q);
        let rates = kept.iter().zip(&curve.row_units);
        let fastest = rates
            .map(|(&i, unit)| s.b[i].abs() / unit)
            .fold(0.0, f64::max);
        curve.second = fastest.recip();
        (fastest > 0.0 && curve.second.is_finite()).then_some(curve)
    }

    fn evaluated(&self, t: f64, q: &[f64]) -> Scratch {
        let mut s = crate::pose::evaluated(self.mechanism, t, q);
        self.mechanism.b(&mut s);
        s
    }

    /// Returns the dimensionless rows of Φq.
    fn of_coordinates(&self, s: &Scratch) -> Matrix {
        let c = self.mechanism.layout().dense(s).select_rows(self.kept);
        Matrix::from_fn(c.nrows(), c.ncols(), |i, j| c[(i, j)] * self.units[j])
    }

    /// Returns these rows with an additional column for time.
    fn of_all(&self, s: &Scratch) -> Matrix {
        let c = self.of_coordinates(s);
        Matrix::from_fn(c.nrows(), c.ncols() + 1, |i, j| {
            if j < c.ncols() {
                c[(i, j)]
            } else {
                -s.b[self.kept[i]] * self.second
            }
        })
    }

    /// Returns the direction of a motion with these velocities.
    fn given(&self, v: &[f64]) -> Vec<f64> {
        let own = v
            .iter()
            .zip(&self.units)
            .map(|(v, unit)| v * self.second / unit);
        own.chain([1.0]).collect()
    }

    /// Returns the direction of the curve that is nearest to the direction stored in the point.
    fn tangent(&self, at: &CurvePoint) -> Option<Vec<f64>> {
        let rows = self.of_all(&self.evaluated(at.t, &at.q));
        if rows.first_non_finite().is_some() || rows.nrows() >= rows.ncols() {
            return None;
        }
        let (r, n) = (rows.nrows(), rows.ncols());
        let along = PivotedQr::of_rows(rows).q_columns(r..n);
        let mut ahead = along.times(&along.transpose_times(&at.ahead));
        let length = linalg::kernels::norm(&ahead);
        ahead.iter_mut().for_each(|x| *x /= length);
        (length > 0.0).then_some(ahead)
    }

    fn rate_of_time(&self, at: &CurvePoint) -> f64 {
        at.ahead.last().copied().unwrap_or(0.0)
    }

    /// Moves a point along its tangent by a vector of this length.
    fn moved(&self, (t, q): (f64, &[f64]), along: &[f64], length: f64) -> (f64, Vec<f64>) {
        let n = self.units.len();
        let step: Vec<f64> = along
            .iter()
            .zip(&self.units)
            .map(|(x, unit)| x * unit)
            .collect();
        let q = self.mechanism.space().displaced(q, length, &step[..n]);
        (t + length * along[n] * self.second, q)
    }

    /// Returns the point after a step of this length.
    fn step(&self, from: &CurvePoint, length: f64) -> Option<CurvePoint> {
        let (mut t, mut q) = self.moved((from.t, &from.q), &from.ahead, length);
        let weights = vec![1.0; self.units.len() + 1];
        for _ in 0..LIMIT_CORRECTIONS {
            let s = self.evaluated(t, &q);
            let missing: Vec<f64> = self.kept.iter().map(|&i| s.phi[i]).collect();
            let step = least_squares_step(&self.of_all(&s), &missing, &weights, f64::EPSILON);
            let step = step.ok()?;
            (t, q) = self.moved((t, &q), &step, 1.0);
            let largest = step.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
            if largest.is_nan() || largest > length.max(LIMIT_STEP) {
                return None;
            }
            if largest <= LIMIT_ARRIVED {
                let ahead = from.ahead.clone();
                let mut there = CurvePoint { t, q, ahead };
                there.ahead = self.tangent(&there)?;
                return Some(there);
            }
        }
        None
    }

    /// Returns the last point before time decreases. The given point is one step before it.
    fn highest(&self, from: CurvePoint) -> CurvePoint {
        let (mut at, mut length) = (from, LIMIT_STEP);
        for _ in 0..LIMIT_HALVINGS {
            length *= 0.5;
            if let Some(next) = self.step(&at, length)
                && self.rate_of_time(&next) >= 0.0
            {
                at = next;
            }
        }
        at
    }

    /// Returns the drives that cannot continue if no velocity increases time at second order.
    fn limit(&self, at: &CurvePoint) -> Option<DriveLimit> {
        let mut s = self.evaluated(at.t, &at.q);
        let c = self.of_coordinates(&s);
        let (r, n) = (c.nrows(), c.ncols());
        let stress = PivotedQr::of_columns(&c).q_columns(r - 1..r);
        let stress: Vec<f64> = (0..r).map(|i| stress[(i, 0)]).collect();
        let free = PivotedQr::of_rows(c).q_columns(r - 1..n);
        let drawn: Vec<f64> = self
            .kept
            .iter()
            .zip(&stress)
            .map(|(&i, z)| z * s.b[i])
            .collect();
        // The derivative of the rows with respect to time is Φ_t = −b.
        let of_time = -drawn.iter().sum::<f64>();
        // If branches meet at a point, the rows are also dependent in coordinates and time.
        let parts = stress.iter().zip(&self.row_units);
        let largest = parts.fold(0.0_f64, |a, (z, unit)| a.max((z * unit).abs()));
        if of_time.abs() * self.second <= LIMIT_ROUNDING * largest {
            return None;
        }
        let mut curvature = |w: &[f64]| {
            let v: Vec<f64> = w
                .iter()
                .zip(&self.units)
                .map(|(w, unit)| w * unit)
                .collect();
            let mut gamma = |v: &[f64]| -> f64 {
                self.mechanism.twist(v, &mut s);
                self.mechanism.gamma(&mut s);
                self.kept
                    .iter()
                    .zip(&stress)
                    .map(|(&i, z)| z * s.gamma[i])
                    .sum()
            };
            let rest = gamma(&vec![0.0; n]);
            (gamma(&v) - rest) / of_time
        };
        if !highest_of_form(&free, &mut curvature) {
            return None;
        }
        let largest = drawn.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let mut groups: Vec<usize> = Vec::new();
        for (&row, drawn) in self.kept.iter().zip(&drawn) {
            let group = self.mechanism.layout().owners[row].0;
            if drawn.abs() > LIMIT_ROUNDING * largest && !groups.contains(&group) {
                groups.push(group);
            }
        }
        let drives = groups
            .into_iter()
            .map(|k| LimitedDrive::of(self.mechanism, ConstraintId(k), &s));
        Some(DriveLimit {
            time: at.t,
            drives: drives.collect(),
        })
    }
}

/// Returns whether a quadratic form of the columns of `free` has a maximum at zero. The form must
/// be negative along one column and must not be positive in any direction.
fn highest_of_form(free: &Matrix, form: &mut impl FnMut(&[f64]) -> f64) -> bool {
    let n = free.ncols();
    if n > LIMIT_FORMS {
        return false;
    }
    let mut of = |a: usize, b: usize| {
        let sum: Vec<f64> = (0..free.nrows())
            .map(|i| free[(i, a)] + free[(i, b)])
            .collect();
        form(&sum)
    };
    // Polarisation: 2·f(a, b) = f(a + b) − f(a) − f(b), and f(a + a) = 4·f(a).
    let own: Vec<f64> = (0..n).map(|a| 0.25 * of(a, a)).collect();
    let mut matrix = Matrix::zeros(n, n);
    for a in 0..n {
        matrix[(a, a)] = own[a];
        for b in 0..a {
            let mixed = 0.5 * (of(a, b) - own[a] - own[b]);
            (matrix[(a, b)], matrix[(b, a)]) = (mixed, mixed);
        }
    }
    if matrix.first_non_finite().is_some() {
        return false;
    }
    let values = symmetric_eigen(&matrix).values;
    let least = values.iter().copied().fold(0.0, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    least < 0.0 && most <= LIMIT_ROUNDING * -least
}

#[cfg(test)]
mod tests;
