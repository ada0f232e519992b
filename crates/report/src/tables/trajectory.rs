//! `trajectory.csv`: positions and velocities of all bodies and markers, and measures.

use std::io::Write;

use model::{Marker, Mechanism, Scratch, System};

use super::{Table, TableError};

/// `t`, then for each body `<body>.x, .y, .angle, .vx, .vy, .omega` of the origin of its frame (s,
/// m, rad, m/s, rad/s), in space `.x, .y, .z, .qw, .qx, .qy, .qz, .vx, .vy, .vz, .wx, .wy, .wz`
/// (ground axes; the quaternion changes continuously, from one with w ≥ 0); then for each marker
/// that can move its place and velocity, in the plane with `.angle` and `.omega` as a body if it
/// has an angle; then each measure; then
/// for each drive by a law `<drive>.force` (N) or `<drive>.torque` (N·m), on the second body of its
/// joint.
pub struct TrajectoryTable<'m, W: Write> {
    table: Table<W>,
    mechanism: &'m Mechanism,
    /// To evaluate drives by laws, if there are any.
    s: Option<Scratch>,
    /// One row, reused.
    values: Vec<f64>,
}

impl<'m, W: Write> TrajectoryTable<'m, W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(out: W, mechanism: &'m Mechanism) -> Result<Self, TableError> {
        let mut header = vec!["t".to_owned()];
        let columns = mechanism.space().columns();
        for body in mechanism.bodies() {
            let own = columns.iter();
            header.extend(own.map(|column| format!("{}.{column}", body.name)));
        }
        let observed = mechanism.frames().observed();
        for marker in observed.markers.iter().filter(|m| is_written(m)) {
            let own = columns.iter().filter(|column| has_column(marker, column));
            header.extend(own.map(|column| format!("{}.{column}", marker.name)));
        }
        header.extend(observed.measures.iter().map(|m| m.name.clone()));
        let n_columns = header.len();
        let laws = mechanism.applied_forces().law_drives();
        header.extend(laws.map(|(name, load)| format!("{name}.{load}")));
        Ok(Self {
            table: Table::new("trajectory.csv", out, &header)?,
            mechanism,
            s: (header.len() > n_columns).then(|| mechanism.scratch()),
            values: Vec::with_capacity(header.len()),
        })
    }

    /// Writes the state (q, v) at time t.
    ///
    /// # Errors
    /// - [`TableError::Length`]: q or v belong to another mechanism; nothing is written.
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(), TableError> {
        let layout = self.mechanism.layout();
        self.table
            .check_length(t, "coordinates", q.len(), layout.n_q)?;
        self.table
            .check_length(t, "velocities", v.len(), layout.n_v)?;
        self.values.clear();
        self.values.push(t);
        for body in 0..self.mechanism.bodies().len() {
            self.values
                .extend(self.mechanism.frames().body(body, q, v).numbers());
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
            self.values.extend(own.map(|(x, _)| x));
        }
        let measures =
            (0..observed.measures.len()).map(|k| self.mechanism.frames().measure(k, q, v));
        self.values.extend(measures);
        if let Some(s) = &mut self.s {
            self.mechanism.pose(t, q, s);
            self.mechanism.twist(v, s);
            let laws = self.mechanism.applied_forces().of_laws(s);
            self.values.extend(laws);
        }
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

/// Whether a marker has columns: one of the ground stands still.
fn is_written(marker: &Marker) -> bool {
    marker.body.moving().is_some()
}

/// Whether a marker has this one of [`model::SpaceKind::columns`]; without an angle it is a point.
fn has_column(marker: &Marker, column: &str) -> bool {
    marker.angle.is_some() || matches!(column, "x" | "y" | "z" | "vx" | "vy" | "vz")
}
