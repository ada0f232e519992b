//! What the kernels of a mechanism compute at each evaluation, and what they leave out, told from its structure. The kernels ask the same
//! questions of the same elements.

use super::{Mechanism, N_BODY};
use crate::system::System;

/// What is computed at each evaluation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Bodies whose angle the constraints hold at its initial value, ascending: their sine and cosine are those of the start.
    pub without_turning: Vec<usize>,
    /// Entries of C, columns of the ground left out.
    pub entries: usize,
    /// Those that depend on the configuration.
    pub varying_entries: usize,
    /// Rows whose b and Φt may differ from zero.
    pub rows_of_time: usize,
    /// Rows whose Γ may differ from zero.
    pub rows_of_gamma: usize,
    /// Functions of time.
    pub functions: usize,
    /// Applied forces; the weight is none.
    pub forces: usize,
}

impl Mechanism {
    /// What the kernels compute at each evaluation; allocates.
    ///
    /// ```
    /// use joints::{Direction, Translational};
    /// use model::{Body, BodyRef, Description, Joint, Mechanism};
    /// // A slider on the ground along x does not turn: its row `angle` says so.
    /// let guide = Translational { s_i: [0.0; 2], s_j: [0.0; 2], axis: Direction::X, angle_0: 0.0 };
    /// let d = Description {
    ///     bodies: vec![Body { name: "slider".into(), mass: 1.0, inertia: 1.0, ..Body::default() }],
    ///     joints: vec![Joint::new("guide", &[BodyRef::Ground, BodyRef::Body(0)], guide)],
    ///     ..Description::default()
    /// };
    /// let work = Mechanism::build(&d).unwrap().work();
    /// assert_eq!((work.without_turning, work.rows_of_time, work.forces), (vec![0], 0, 0));
    /// ```
    #[must_use]
    pub fn work(&self) -> Work {
        let mut work = Work {
            without_turning: (0..self.held.len()).filter(|&k| self.held[k]).collect(),
            functions: self.functions.len(),
            forces: self.forces.len(),
            ..Work::default()
        };
        for c in &self.constraints {
            let n = c.rows.len();
            work.rows_of_time += if c.depends_on_time() { n } else { 0 };
            work.rows_of_gamma += if c.has_gamma() { n } else { 0 };
        }
        let varying: Vec<usize> = self
            .constraints
            .iter()
            .flat_map(|c| c.varying.iter().map(|k| c.entries.start + k))
            .collect();
        let entries = &self.layout().pattern.entry;
        work.entries = entries.len();
        let varies = |entry: &&usize| varying.binary_search(entry).is_ok();
        work.varying_entries = entries.iter().filter(varies).count();
        work
    }

    /// For each body, whether its angle keeps its initial value: a holonomic row that does not depend on time holds it against the ground, or against
    /// bodies of which this is known. Only rows of angles alone, with constant entries, are asked, so that not all such bodies may be
    /// found.
    pub(super) fn held_bodies(&self) -> Vec<bool> {
        let rows: Vec<Vec<usize>> = self
            .constraints
            .iter()
            .filter(|c| !c.depends_on_time())
            .flat_map(|c| c.rows.clone())
            .filter(|&i| i < self.layout.m && self.is_angular(i))
            .filter_map(|i| self.constant_row(i))
            .collect();
        let mut held = vec![false; self.bodies.len()];
        loop {
            let free = |row: &Vec<usize>| {
                let mut free = row.iter().copied().filter(|&k| !held[k]);
                free.next().filter(|_| free.next().is_none())
            };
            let Some(body) = rows.iter().find_map(free) else {
                return held;
            };
            held[body] = true;
        }
    }

    /// Bodies in a row of C whose entries are constant, those with an entry of zero left out.
    fn constant_row(&self, i: usize) -> Option<Vec<usize>> {
        let pattern = &self.layout.pattern;
        let places = pattern.start[i]..pattern.start[i + 1];
        let varying = |entry: usize| {
            let of = self.constraints.iter().find(|c| c.entries.contains(&entry));
            of.is_some_and(|c| c.varying.contains(&(entry - c.entries.start)))
        };
        let mut bodies = Vec::new();
        for k in places {
            let entry = pattern.entry[k];
            if varying(entry) {
                return None;
            }
            if self.entries[entry] != 0.0 {
                bodies.push(pattern.column[k] / N_BODY);
            }
        }
        Some(bodies)
    }
}
