//! `trajectory.csv`: positions and velocities of all bodies and markers, and the values of
//! measures.

use std::fmt;
use std::io::Write;

use model::{Marker, Mechanism, Scratch, System};

use super::{Table, TableError};

/// A column of a trajectory or of reactions, with its owner and the name of the quantity. As text
/// it is `<owner>.<quantity>`, or only the owner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the body, marker, measure, drive or joint.
    pub owner: String,
    /// `body`, `marker`, `measure`, `law` or `reaction`.
    pub kind: &'static str,
    /// Name of the quantity, such as `x` or `Fx`; empty for a measure, which has only one value.
    pub number: &'static str,
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.number {
            "" => f.write_str(&self.owner),
            number => write!(f, "{}.{number}", self.owner),
        }
    }
}

/// The values of a trajectory of a mechanism at one time. For each body:
/// `<body>.x, .y, .angle, .vx, .vy, .omega` of the origin of its frame (m, rad, m/s, rad/s), in
/// space `.x, .y, .z, .qw, .qx, .qy, .qz, .vx, .vy, .vz, .wx, .wy, .wz` (ground axes; the
/// quaternion changes continuously, starting with w ≥ 0). Then, for each marker that can move, its
/// position and velocity; in the plane also `.angle` and `.omega`, like a body, if the marker has
/// an angle. Then each measure. Then, for each drive with a force law, `<drive>.force` (N) or
/// `<drive>.torque` (N·m) on the second body of its joint.
pub struct Trajectory<'m> {
    mechanism: &'m Mechanism,
    columns: Vec<Column>,
    /// Work space for the evaluation of drives with force laws, if there are any.
    s: Option<Scratch>,
}

impl<'m> Trajectory<'m> {
    /// The trajectory of this mechanism.
    #[must_use]
    pub fn new(mechanism: &'m Mechanism) -> Self {
        let column = |kind, owner: &str, number| Column {
            owner: owner.to_owned(),
            kind,
            number,
        };
        let of_space = mechanism.space().columns();
        let mut columns = Vec::new();
        for body in mechanism.bodies() {
            let own = of_space.iter();
            columns.extend(own.map(|number| column("body", &body.name, number)));
        }
        let observed = mechanism.frames().observed();
        for marker in observed.markers.iter().filter(|m| is_written(m)) {
            let own = of_space.iter().filter(|number| has_column(marker, number));
            columns.extend(own.map(|number| column("marker", &marker.name, number)));
        }
        let measures = observed.measures.iter();
        columns.extend(measures.map(|m| column("measure", &m.name, "")));
        let n_columns = columns.len();
        let laws = mechanism.applied_forces().law_drives();
        columns.extend(laws.map(|(name, load)| column("law", name, load)));
        Self {
            mechanism,
            s: (columns.len() > n_columns).then(|| mechanism.scratch()),
            columns,
        }
    }

    /// Columns of the trajectory.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Adds the values for the state (q, v) at time t to `values`.
    ///
    /// # Panics
    /// Panics if q and v belong to another mechanism.
    pub fn extend(&mut self, values: &mut Vec<f64>, t: f64, q: &[f64], v: &[f64]) {
        for body in 0..self.mechanism.bodies().len() {
            values.extend(self.mechanism.frames().body(body, q, v).numbers());
        }
        let observed = self.mechanism.frames().observed();
        let markers = observed.markers.iter().enumerate();
        for (k, marker) in markers.filter(|(_, m)| is_written(m)) {
            let all = self
                .mechanism
                .frames()
                .marker(k, q, v)
                .numbers()
                .zip(self.mechanism.space().columns());
            let own = all.filter(|(_, column)| has_column(marker, column));
            values.extend(own.map(|(x, _)| x));
        }
        let measures =
            (0..observed.measures.len()).map(|k| self.mechanism.frames().measure(k, q, v));
        values.extend(measures);
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
    pub fn new(out: W, mechanism: &'m Mechanism) -> Result<Self, TableError> {
        let trajectory = Trajectory::new(mechanism);
        let columns = trajectory.columns().iter().map(Column::to_string);
        let header: Vec<String> = std::iter::once("t".to_owned()).chain(columns).collect();
        Ok(Self {
            table: Table::new("trajectory.csv", out, &header)?,
            trajectory,
            values: Vec::with_capacity(header.len()),
        })
    }

    /// Writes the state (q, v) at time t.
    ///
    /// # Errors
    /// - [`TableError::Length`]: q or v belong to another mechanism; nothing is written.
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(), TableError> {
        let layout = self.trajectory.mechanism.layout();
        self.table
            .check_length(t, "coordinates", q.len(), layout.n_q)?;
        self.table
            .check_length(t, "velocities", v.len(), layout.n_v)?;
        self.values.clear();
        self.values.push(t);
        self.trajectory.extend(&mut self.values, t, q, v);
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

/// Whether a marker has columns. A marker on the ground does not move and has no columns.
fn is_written(marker: &Marker) -> bool {
    marker.body.moving().is_some()
}

/// Whether a marker has this column of [`model::SpaceKind::columns`]; a marker without an angle is
/// a point.
fn has_column(marker: &Marker, column: &str) -> bool {
    marker.angle.is_some() || matches!(column, "x" | "y" | "z" | "vx" | "vy" | "vz")
}
