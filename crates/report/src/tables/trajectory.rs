//! `trajectory.csv`: coordinates and velocities of all bodies.

use std::io::Write;

use model::{Mechanism, System};

use super::{Table, TableError};

/// Number of coordinates of a planar body, and of its velocities.
const N_BODY: usize = 3;

/// `t`, then for each body `<body>.x, .y, .angle, .vx, .vy, .omega` (s, m, rad, m/s, rad/s), then
/// for each drive by a law `<drive>.force` (N) or `<drive>.torque` (N·m), on the second body of its
/// joint.
pub struct TrajectoryTable<W: Write> {
    table: Table<W>,
    n_bodies: usize,
    /// The mechanism, if it has drives by laws.
    laws: Option<Box<Mechanism>>,
    /// One row, reused.
    values: Vec<f64>,
}

impl<W: Write> TrajectoryTable<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(out: W, mechanism: &Mechanism) -> Result<Self, TableError> {
        let mut header = vec!["t".to_owned()];
        for body in mechanism.bodies() {
            let columns = ["x", "y", "angle", "vx", "vy", "omega"];
            header.extend(columns.map(|c| format!("{}.{c}", body.name)));
        }
        let laws = mechanism.law_drives();
        header.extend(laws.map(|(name, load)| format!("{name}.{load}")));
        let has_laws = mechanism.law_drives().next().is_some();
        Ok(Self {
            laws: has_laws.then(|| Box::new(mechanism.clone())),
            table: Table::new("trajectory.csv", out, &header)?,
            n_bodies: mechanism.layout().n_q / N_BODY,
            values: Vec::with_capacity(header.len()),
        })
    }

    /// Writes the state (q, v) at time t.
    ///
    /// # Errors
    /// - [`TableError::Length`]: q or v belong to another mechanism; nothing is written.
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(), TableError> {
        let n = N_BODY * self.n_bodies;
        self.table.check_length(t, "coordinates", q.len(), n)?;
        self.table.check_length(t, "velocities", v.len(), n)?;
        self.values.clear();
        self.values.push(t);
        for (q, v) in q.chunks_exact(N_BODY).zip(v.chunks_exact(N_BODY)) {
            self.values.extend_from_slice(q);
            self.values.extend_from_slice(v);
        }
        if let Some(mechanism) = &self.laws {
            self.values.extend(mechanism.law_forces(t, q, v));
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
