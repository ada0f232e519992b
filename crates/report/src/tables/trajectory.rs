//! `trajectory.csv`: positions and velocities of all bodies and markers, and the values of
//! measures; on request also accelerations.

use std::fmt;
use std::io::Write;

use model::{FrameState, Marker, MeasureKind, Mechanism, Scratch, SpaceKind, System};

use super::{Table, TableError};
use model::words::SceneUnits;

/// A column of a trajectory or of reactions. It has an owner and the name of a quantity. The text
/// of a column is `<owner>.<quantity>`, or only the owner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the body, marker, measure, drive or joint.
    pub owner: String,
    /// `body`, `marker`, `measure`, `law` or `reaction`.
    pub kind: &'static str,
    /// Name of the quantity, such as `x` or `Fx`; empty for the value of a measure.
    pub number: &'static str,
    /// SI unit; empty for quantities without a unit.
    pub unit: &'static str,
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.number {
            "" => f.write_str(&self.owner),
            number => write!(f, "{}.{number}", self.owner),
        }
    }
}

/// Columns of a trajectory that are written on request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MoreColumns {
    /// Accelerations of bodies and markers, and derivatives of measures.
    pub accelerations: bool,
    /// Orientations in space as roll, pitch and yaw.
    pub angles: bool,
}

impl MoreColumns {
    fn has_angles(self, space: SpaceKind) -> bool {
        self.angles && space == SpaceKind::Space3
    }
}

/// The values of a trajectory of a mechanism at one time. For each body:
/// `<body>.x, .y, .angle, .vx, .vy, .omega` of the origin of its frame (m, rad, m/s, rad/s), in
/// space `.x, .y, .z, .qw, .qx, .qy, .qz, .vx, .vy, .vz, .wx, .wy, .wz` (ground axes; the
/// quaternion changes continuously, starting with w ≥ 0). Then, for each marker that can move, its
/// position and velocity; in the plane also `.angle` and `.omega`, like a body, if the marker has
/// an angle. Then each measure. Then, for each drive with a force law, `<drive>.force` (N) or
/// `<drive>.torque` (N·m) on the second body of its joint.
///
/// With accelerations, the velocities of each body and marker are followed by
/// `.ax, .ay, .alpha` (m/s², rad/s²), in space `.ax, .ay, .az, .alphax, .alphay, .alphaz`, and each
/// measure by its derivatives: `<measure>.rate`, and `<measure>.acceleration` unless the measure is
/// itself a velocity. With angles, the numbers of each body in space, and of each marker with an
/// orientation, contain `.roll, .pitch, .yaw` (rad) after the velocities, see
/// [`FrameState::roll_pitch_yaw`].
pub struct Trajectory<'m> {
    mechanism: &'m Mechanism,
    more: MoreColumns,
    columns: Vec<Column>,
    /// Work space for the evaluation of drives with force laws, if there are any.
    s: Option<Scratch>,
}

impl<'m> Trajectory<'m> {
    /// The trajectory of this mechanism.
    #[must_use]
    pub fn new(mechanism: &'m Mechanism, more: MoreColumns) -> Self {
        let space = mechanism.space();
        let column = |kind, owner: &str, number, unit| Column {
            owner: owner.to_owned(),
            kind,
            number,
            unit,
        };
        let mut columns = Vec::new();
        for body in mechanism.bodies() {
            let own = numbers(mechanism, more);
            let own =
                own.map(|number| column("body", &body.name, number, space.column_unit(number)));
            columns.extend(own);
        }
        let observed = mechanism.frames().observed();
        for marker in observed.markers.iter().filter(|m| is_written(m)) {
            let own = numbers(mechanism, more).filter(|number| has_column(marker, number));
            let own =
                own.map(|number| column("marker", &marker.name, number, space.column_unit(number)));
            columns.extend(own);
        }
        for measure in &observed.measures {
            let units = measure.kind.units().into_iter().zip(MeasureKind::COLUMNS);
            let own = units.take(derivatives(more));
            let own = own
                .filter_map(|(unit, number)| Some(column("measure", &measure.name, number, unit?)));
            columns.extend(own);
        }
        let n_columns = columns.len();
        let laws = mechanism.applied_forces().law_drives();
        columns.extend(laws.map(|(name, load)| {
            let unit = if load == "torque" { "N·m" } else { "N" };
            column("law", name, load, unit)
        }));
        Self {
            mechanism,
            more,
            s: (columns.len() > n_columns).then(|| mechanism.scratch()),
            columns,
        }
    }

    /// Columns of the trajectory.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Whether the trajectory contains accelerations.
    #[must_use]
    pub fn has_accelerations(&self) -> bool {
        self.more.accelerations
    }

    /// Adds the values for the state (q, v) at time t to `values`. `a` contains the accelerations
    /// of the bodies (n_v). Without accelerations, derived values are NaN.
    ///
    /// # Panics
    /// Panics if q, v and a belong to another mechanism.
    pub fn extend(
        &mut self,
        values: &mut Vec<f64>,
        t: f64,
        (q, v): (&[f64], &[f64]),
        a: Option<&[f64]>,
    ) {
        let frames = self.mechanism.frames();
        let frames = a.map_or(frames, |a| frames.with_accelerations(a));
        let more = self.more;
        let all = |state: FrameState| {
            let angles = state.roll_pitch_yaw().into_iter();
            let rates = state.accelerations().filter(move |_| more.accelerations);
            let angles = angles.filter(move |_| more.has_angles(state.space));
            state.numbers().chain(angles).chain(rates)
        };
        for body in 0..self.mechanism.bodies().len() {
            values.extend(all(frames.body(body, q, v)));
        }
        let observed = frames.observed();
        let markers = observed.markers.iter().enumerate();
        for (k, marker) in markers.filter(|(_, m)| is_written(m)) {
            let names = numbers(self.mechanism, more);
            let all = all(frames.marker(k, q, v)).zip(names);
            let own = all.filter(|(_, column)| has_column(marker, column));
            values.extend(own.map(|(x, _)| x));
        }
        for (k, measure) in observed.measures.iter().enumerate() {
            let own = frames.measure_rates(k, q, v).into_iter();
            let own = own.zip(measure.kind.units()).take(derivatives(more));
            values.extend(own.filter_map(|(value, unit)| unit.map(|_| value)));
        }
        if let Some(s) = &mut self.s {
            self.mechanism.pose(t, q, s);
            self.mechanism.twist(v, s);
            values.extend(self.mechanism.applied_forces().of_laws(s));
        }
    }
}

/// `t`, followed by the columns of a [`Trajectory`].
pub struct TrajectoryTable<'m, W: Write> {
    table: Table<W>,
    trajectory: Trajectory<'m>,
    /// Buffer for one row, reused.
    values: Vec<f64>,
}

impl<'m, W: Write> TrajectoryTable<'m, W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(
        out: W,
        trajectory: Trajectory<'m>,
        units: Option<SceneUnits>,
    ) -> Result<Self, TableError> {
        let columns = trajectory.columns().iter();
        let columns = columns.map(|column| (column.to_string(), column.unit));
        Ok(Self {
            table: Table::over_time("trajectory.csv", out, columns, units)?,
            values: Vec::with_capacity(trajectory.columns().len() + 1),
            trajectory,
        })
    }

    /// Whether the table contains accelerations.
    #[must_use]
    pub fn has_accelerations(&self) -> bool {
        self.trajectory.has_accelerations()
    }

    /// Writes the state (q, v) at time t, and the accelerations a if the table contains them.
    ///
    /// # Errors
    /// - [`TableError::Length`]: q, v or a belong to another mechanism; nothing is written.
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(
        &mut self,
        t: f64,
        (q, v): (&[f64], &[f64]),
        a: Option<&[f64]>,
    ) -> Result<(), TableError> {
        let layout = self.trajectory.mechanism.layout();
        self.table
            .check_length(t, "coordinates", q.len(), layout.n_q)?;
        self.table
            .check_length(t, "velocities", v.len(), layout.n_v)?;
        if let Some(a) = a {
            self.table
                .check_length(t, "accelerations", a.len(), layout.n_v)?;
        }
        self.values.clear();
        self.values.push(t);
        self.trajectory.extend(&mut self.values, t, (q, v), a);
        self.table.row(&self.values)
    }

    /// Writes the buffer and returns the writer.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn finish(self) -> Result<W, TableError> {
        self.table.finish()
    }
}

/// Returns the number of values of a measure that are written.
fn derivatives(more: MoreColumns) -> usize {
    if more.accelerations {
        MeasureKind::COLUMNS.len()
    } else {
        1
    }
}

/// Names of the numbers of a frame.
fn numbers(mechanism: &Mechanism, more: MoreColumns) -> impl Iterator<Item = &'static str> {
    let space = mechanism.space();
    let angles = FrameState::ANGLES
        .iter()
        .filter(move |_| more.has_angles(space));
    let rates = space
        .accelerations()
        .iter()
        .filter(move |_| more.accelerations);
    space.columns().iter().chain(angles).chain(rates).copied()
}

/// Whether a marker has columns. A marker on the ground does not move and has no columns.
fn is_written(marker: &Marker) -> bool {
    marker.body.moving().is_some()
}

/// Whether a marker has this column of [`model::SpaceKind::columns`]. A marker without an angle is
/// a point.
fn has_column(marker: &Marker, column: &str) -> bool {
    marker.angle.is_some()
        || marker.orientation.is_some() && FrameState::ANGLES.contains(&column)
        || matches!(
            column,
            "x" | "y" | "z" | "vx" | "vy" | "vz" | "ax" | "ay" | "az"
        )
}
