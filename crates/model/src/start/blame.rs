//! Finds the given velocity that is impossible, the rows that contradict it, and the velocities to
//! remove from the scene.

use rank::Circuit;

use super::conflict::{CANCELLED, HeldVelocity, LockedBodies, VelocityConflict};
use super::dependent::{DependentVelocities, Equations};
use super::error::StartError;
use super::options::CorrectionLimit;
use super::velocity::{Hold, Miss, Start};
use crate::space::SpaceKind;
use crate::system::{RowLabel, System};

/// Largest number of velocities that the search proposes to remove.
const LEFT_OUT: usize = 40;

/// Returns the names in the given order, without repetition.
fn each_once<'a>(names: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut once: Vec<String> = Vec::new();
    for name in names {
        if !once.contains(name) {
            once.push(name.clone());
        }
    }
    once
}

/// A velocity that contradicts the rows.
struct Fault {
    column: usize,
    /// The contradicting rows; rows that prescribe a motion come first.
    rows: Vec<RowLabel>,
    /// The names of the drives of these rows.
    drives: Vec<String>,
    /// Whether other given or kept velocities contribute to the contradiction.
    with_others: bool,
}

impl Start<'_> {
    /// Returns a description of the contradiction if some rows have no acceptable velocities.
    /// `miss` is the first problem that was found.
    ///
    /// # Errors
    /// [`StartError::NoVelocity`]: the rows do not permit any velocities.
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
        let closest = nearest.clone();
        let mut v = self.written.clone();
        let can_be_corrected = self
            .solve(rows, &self.hold, CorrectionLimit::Any, &mut v)?
            .is_none();
        let (leave_out, hold, is_enough) = self.leave_out(rows, &columns)?;
        // The candidates are velocities whose computed value, if they are not given, differs from
        // the given value. The search selects the candidate with the largest difference. Given
        // velocities without a difference are correct.
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
        let body = &mechanism.bodies()[mechanism.space().body_of(column)];
        let (coordinate, [given, fitting]) = self.as_written(column, &closest, &nearest);
        Ok(VelocityConflict {
            body: body.name.clone(),
            coordinate,
            given,
            is_kept: self.hold[column] == Hold::Kept,
            nearest: fitting,
            limit: self.allowed(column, &columns, &self.hold, &nearest),
            rows: rows_at_fault,
            with_others,
            drives,
            leave_out,
            is_enough,
            can_be_corrected,
            locked: self.locked(rows, &columns),
        })
    }

    /// Returns the bodies of these velocities and the joints of these rows, if the independent rows
    /// permit only zero velocities.
    fn locked(&self, rows: &[usize], columns: &[usize]) -> Option<LockedBodies> {
        let Equations { mechanism, s, .. } = &self.equations;
        if rows.len() < columns.len() || rows.iter().any(|&i| s.b[i] != 0.0) {
            return None;
        }
        let space = mechanism.space();
        let bodies = columns
            .iter()
            .map(|&j| &mechanism.bodies()[space.body_of(j)].name);
        let layout = mechanism.layout();
        let joints = |rows: &[usize]| each_once(rows.iter().map(|&i| &layout.labels[i].joint));
        let rolling: Vec<usize> = rows.iter().copied().filter(|&i| i >= layout.m).collect();
        Some(LockedBodies {
            bodies: each_once(bodies),
            joints: joints(rows),
            wheels: joints(&rolling),
        })
    }

    /// Returns the name of a velocity component, its given value and its value in the velocities
    /// `other`. Scenes contain angular velocities in space in ground axes. Therefore, the function
    /// selects the ground component with the largest difference between the given velocities and
    /// the closest compatible velocities.
    fn as_written(
        &self,
        column: usize,
        closest: &[f64],
        other: &[f64],
    ) -> (&'static str, [f64; 2]) {
        let space = self.equations.mechanism.space();
        let own = space.dof_of(column);
        if space != SpaceKind::Space3 || !space.is_rotation(column) || self.is_component(column) {
            return (
                space.velocities()[own],
                [self.written[column], other[column]],
            );
        }
        let body = space.body_of(column);
        let [given, closest, other] = [&self.written, closest, other].map(|v| {
            let v = self.equations.velocities(v);
            let mechanism = self.equations.mechanism;
            mechanism.frames().body(body, &self.equations.q, &v).omega
        });
        let off = |k: usize| (closest[k] - given[k]).abs();
        let farthest = (1..3).fold(0, |a, k| if off(k) > off(a) { k } else { a });
        let name = space.velocities()[space.n_translations() + farthest];
        (name, [given[farthest], other[farthest]])
    }

    /// Returns whether a column is a kept rotation of a body that also has rotations that are not
    /// kept.
    fn is_component(&self, column: usize) -> bool {
        let space = self.equations.mechanism.space();
        let mut rotations = space.rotations_of(space.body_of(column));
        self.hold[column] == Hold::Kept && rotations.any(|j| self.hold[j] != Hold::Kept)
    }

    /// Returns the given or kept velocity that differs most from the closest compatible velocities.
    /// The compatible velocities are computed as if no velocity were kept. Returns `None` if there
    /// are no compatible velocities. Writes the compatible velocities to `nearest`.
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

    /// Returns the first of these velocities that contradicts the rows while the other given or
    /// kept velocities do not change.
    fn fault(&self, rows: &[usize], candidates: &[usize]) -> Result<Fault, StartError> {
        let of = &self.equations;
        let mut v = self.written.clone();
        let mut dependent = DependentVelocities::new(of, rows, |j| self.hold[j] == Hold::No)?;
        dependent.follow(of, &mut v)?;
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
            let open = dependent.open(of, &v).filter(|c| takes_part(c, column));
            Some((column, open.min_by_key(|c| c.rows.len())?))
        });
        let (column, found, with_others) = match shortest {
            Some((column, circuit)) => {
                let columns = of.columns(&circuit.rows).into_iter();
                let mut others = columns.filter(|&j| j != column && self.hold[j] != Hold::No);
                let with_others = others.any(|j| takes_part(circuit, j));
                (column, circuit.rows.clone(), with_others)
            }
            // For large sets, circuits are not computed; the violated rows are used instead.
            None => {
                let is_open = |&i: &usize| of.residual(i, &v).abs() > of.rounding(i, &v);
                let open = rows.iter().copied().filter(is_open);
                (candidates[0], open.collect::<Vec<_>>(), true)
            }
        };
        let layout = of.mechanism.layout();
        let prescribes = |i: &usize| layout.owner(*i).spec.rheonomic;
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

    /// Returns the given velocities that must be removed so that the remaining velocities are
    /// possible, the largest difference first. All velocities of the list must be removed. The
    /// function also returns which velocities remain given or kept, and whether the removal is
    /// sufficient.
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
            // If the given velocity of a `keep` entry is removed, the entry would keep the value
            // zero.
            let is_other = |&(j, was): &(usize, Hold)| {
                was == Hold::Kept && hold[j] == Hold::No && self.is_written[j]
            };
            if before.iter().any(is_other)
                || self.solve(rows, &tried, self.limit, &mut v)?.is_some()
            {
                needed.push(what);
            } else {
                hold = tried;
            }
        }
        needed.extend(last.map(|(what, _)| what));
        Ok((needed, hold, true))
    }

    /// Frees a velocity by removing one entry of the scene. Also returns the previous states of the
    /// freed velocities.
    fn free(&self, column: usize, hold: &mut [Hold]) -> (HeldVelocity, Vec<(usize, Hold)>) {
        let mechanism = self.equations.mechanism;
        let (space, at) = (mechanism.space(), mechanism.space().body_of(column));
        let body = mechanism.bodies()[at].name.clone();
        let turns = space.is_rotation(column);
        let own = if turns {
            space.rotations_of(at)
        } else {
            space.translations_of(at)
        };
        // A `keep` entry is removed before the given velocity. Otherwise the entry would keep the
        // value zero.
        if let Some(kept) = own.clone().find(|&j| hold[j] == Hold::Kept) {
            let to = if self.is_written[kept] {
                Hold::Given
            } else {
                Hold::No
            };
            // If all components of an angular velocity are kept, the scene has a single entry for
            // all components.
            let is_whole = turns && own.clone().all(|j| self.hold[j] == Hold::Kept);
            let (coordinate, entry) = if is_whole {
                ("omega", own)
            } else {
                (space.velocities()[space.dof_of(kept)], kept..kept + 1)
            };
            let before = entry.map(|j| (j, std::mem::replace(&mut hold[j], to)));
            return (HeldVelocity::Keep { body, coordinate }, before.collect());
        }
        let what = if turns {
            HeldVelocity::AngularVelocity { body }
        } else {
            HeldVelocity::Velocity { body }
        };
        let before = own.map(|j| (j, std::mem::replace(&mut hold[j], Hold::No)));
        (what, before.collect())
    }
}
