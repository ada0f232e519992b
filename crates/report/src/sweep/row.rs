//! One run of a sweep as a row, and the columns of all rows.

use super::{Cell, Column, Kind, SweepPlan};
use crate::peaks::Peak;

/// End of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepStatus {
    /// The run reached its end time.
    Done,
    /// The run ended at the instant after which not all one-sided joints can stay closed, or not
    /// all contacts can hold. The row contains the results up to this time.
    Opened,
    /// The run stopped early because of an error. The row contains the results up to this time.
    Stopped,
    /// The run did not start, because the mechanism or the motion does not exist for these values.
    Refused,
    /// In two attempts, the process made only this run and ended unexpectedly.
    Crashed,
}

impl SweepStatus {
    /// Returns whether the run ended with an error. The opening of one-sided joints is a result.
    #[must_use]
    pub fn is_failure(self) -> bool {
        !matches!(self, Self::Done | Self::Opened)
    }

    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Opened => "opened",
            Self::Stopped => "stopped",
            Self::Refused => "refused",
            Self::Crashed => "crashed",
        }
    }
}

/// The results of a run that started.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepMotion {
    /// Integration method.
    pub method: &'static str,
    /// Last time reached (s).
    pub t: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of accelerations.
    pub evaluations: u64,
    /// Projections of steps.
    pub projections: u64,
    /// Wall-clock time of the integration alone (s).
    pub seconds: f64,
    /// Largest |Φ|.
    pub max_position_residual: f64,
    /// Largest |C·v − b|.
    pub max_velocity_residual: f64,
    /// Largest |E − E₀ − work| relative to the largest kinetic energy.
    pub energy_balance: f64,
    /// Largest change of a coordinate during the assembly (m or rad).
    pub start_correction: f64,
    /// Largest change of a velocity during the assembly (m/s or rad/s).
    pub start_velocity_correction: f64,
    /// Number of events.
    pub events: u64,
    /// Rank of C at the initial state.
    pub rank: u64,
    /// Degree of redundancy at the initial state.
    pub redundancy: u64,
    /// Number of joints and drives whose reaction is not unique or is undecided on the run. `None`
    /// if no reaction is requested, because the run then has no verdicts on reactions.
    pub not_unique: Option<u64>,
    /// Number of joints and drives with a component that is unique at the initial state, but
    /// sensitive to data (`fragile`).
    pub fragile: u64,
    /// Time of the last output state (s). For a run that is done, this is the end time.
    pub t_state: f64,
    /// The last output state, body by body in the order of [`SweepPlan::state`]; NaN if no row was
    /// written.
    pub state: Vec<f64>,
    /// Peaks of |F| (N) and |T| (N·m) of the joints and drives of [`SweepPlan::reactions`]. `None`
    /// for a magnitude that is not determined throughout the run.
    pub peaks: Vec<[Option<Peak>; 2]>,
    /// Upper bounds of the reactions that are not unique, if the scene requests them.
    pub at_most: Option<BoundsOfRun>,
}

/// Upper bounds of force and torque over the output rows of a run, for joints of any stiffness.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundsOfRun {
    /// Number of output rows in which some reactions have no bounds. The largest bounds do not
    /// include these rows.
    pub rows_without: u64,
    /// The largest bounds of force (N) and torque (N·m) for the joints and drives of
    /// [`SweepPlan::reactions`]. Each bound is followed by the first time at which it occurs (s).
    /// Both numbers are NaN if the reaction is unique or has no bounds.
    pub largest: Vec<[[f64; 2]; 2]>,
}

impl SweepMotion {
    /// Returns the largest |F| and |T| of a joint or drive. Each value is followed by the first
    /// time at which it occurs. Both numbers are NaN if the magnitude is not determined.
    #[must_use]
    pub fn largest(&self, reaction: usize) -> [[f64; 2]; 2] {
        self.peaks[reaction].each_ref().map(|peak| {
            let value = peak
                .as_ref()
                .and_then(|peak| Some((peak.value.determined()?, peak.time)));
            value.map_or([f64::NAN; 2], |(value, time)| [value, time])
        })
    }
}

/// A run.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepRow {
    /// Index of the run in the grid, from 1.
    pub run: u64,
    /// The varied values.
    pub varied: Vec<f64>,
    /// End of the run.
    pub status: SweepStatus,
    /// Reason why the run is not done. The text is empty if the run is done.
    pub error: String,
    /// Results of the run, if it started.
    pub motion: Option<SweepMotion>,
}

/// Columns of a run that started, with their values.
type Columns<T, const N: usize> = [(&'static str, fn(&SweepMotion) -> T); N];

const COUNTS: Columns<Option<u64>, 9> = [
    ("steps", |m| Some(m.steps)),
    ("rejected", |m| Some(m.rejected)),
    ("evaluations", |m| Some(m.evaluations)),
    ("projections", |m| Some(m.projections)),
    ("events", |m| Some(m.events)),
    ("rank", |m| Some(m.rank)),
    ("redundancy", |m| Some(m.redundancy)),
    ("not_unique", |m| m.not_unique),
    ("fragile", |m| Some(m.fragile)),
];
const NUMBERS: Columns<f64, 7> = [
    ("seconds", |m| m.seconds),
    ("max_position_residual", |m| m.max_position_residual),
    ("max_velocity_residual", |m| m.max_velocity_residual),
    ("energy_balance", |m| m.energy_balance),
    ("start_correction", |m| m.start_correction),
    ("start_velocity_correction", |m| m.start_velocity_correction),
    ("t_state", |m| m.t_state),
];
const LARGEST: [&str; 4] = ["F_max", "F_max_t", "T_max", "T_max_t"];
const AT_MOST: [&str; 4] = ["F_at_most", "F_at_most_t", "T_at_most", "T_at_most_t"];

impl SweepPlan {
    /// The columns are `run`, the varied keys, `status`, `error`, `method`, `t`, counts and other
    /// values. Then follow the last state of each body, and the peaks of each requested joint and
    /// drive. If the scene requests bounds, the last columns are the number of rows without bounds
    /// and the bounds.
    #[must_use]
    pub fn columns(&self) -> Vec<Column> {
        let column = |kind: Kind| move |name: String| Column { name, kind };
        let own = |names: &'static [&'static str], kind| {
            names
                .iter()
                .map(|name| (*name).to_owned())
                .map(column(kind))
        };
        let [largest, at_most] = [LARGEST, AT_MOST].map(|names| names.map(str::to_owned));
        let bounded: &[String] = if self.bounds { &self.reactions } else { &[] };
        let without: &[&str] = if self.bounds {
            &["rows_without_bounds"]
        } else {
            &[]
        };
        let of = |things: &[String], parts: &[String]| {
            let names = things
                .iter()
                .flat_map(|thing| parts.iter().map(move |part| format!("{thing}.{part}")));
            names.map(column(Kind::Number)).collect::<Vec<_>>()
        };
        own(&["run"], Kind::Count)
            .chain(self.keys.iter().cloned().map(column(Kind::Number)))
            .chain(own(&["status", "error", "method"], Kind::Text))
            .chain(own(&["t"], Kind::Number))
            .chain(COUNTS.map(|(name, _)| column(Kind::Count)(name.to_owned())))
            .chain(NUMBERS.map(|(name, _)| column(Kind::Number)(name.to_owned())))
            .chain(of(&self.bodies, &self.state))
            .chain(of(&self.reactions, &largest))
            .chain(own(without, Kind::Count))
            .chain(of(bounded, &at_most))
            .collect()
    }

    /// A row with the columns of [`SweepPlan::columns`].
    pub(super) fn cells(&self, row: &SweepRow) -> Vec<Cell> {
        let motion = row.motion.as_ref();
        let number = |x: fn(&SweepMotion) -> f64| Cell::Number(motion.map_or(f64::NAN, x));
        let mut cells = vec![Cell::Count(Some(row.run))];
        cells.extend(row.varied.iter().copied().map(Cell::Number));
        cells.push(Cell::Text(row.status.name().to_owned()));
        cells.push(Cell::line(&row.error));
        cells.push(Cell::line(motion.map_or("", |m| m.method)));
        cells.push(number(|m| m.t));
        cells.extend(COUNTS.map(|(_, of)| Cell::Count(motion.and_then(of))));
        cells.extend(NUMBERS.map(|(_, of)| number(of)));
        match motion {
            Some(m) => cells.extend(m.state.iter().copied().map(Cell::Number)),
            None => {
                let states = self.state.len() * self.bodies.len();
                cells.extend(std::iter::repeat_n(Cell::Number(f64::NAN), states));
            }
        }
        for k in 0..self.reactions.len() {
            let values = motion.map_or([[f64::NAN; 2]; 2], |m| m.largest(k));
            cells.extend(values.into_iter().flatten().map(Cell::Number));
        }
        if self.bounds {
            let at_most = motion.and_then(|m| m.at_most.as_ref());
            cells.push(Cell::Count(at_most.map(|found| found.rows_without)));
            for k in 0..self.reactions.len() {
                let largest = at_most.map_or([[f64::NAN; 2]; 2], |found| found.largest[k]);
                cells.extend(largest.into_iter().flatten().map(Cell::Number));
            }
        }
        cells
    }
}
