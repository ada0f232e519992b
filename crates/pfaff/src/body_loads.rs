//! All loads on a body during a run, for finite element programs. The table is `body_NAME.csv`, or
//! `choice_body_NAME.csv` with the values of a choice.

use std::io::{BufRead, BufReader, BufWriter, Write};
use std::ops::ControlFlow;

use dynamics::Sample;
use model::words::SceneUnits;
use model::{BodyRef, ConstraintId, Loads, Mechanism, Reaction, Scratch, System};
use report::{OutputDirectory, OutputFile, Table, TableError, file_stems};
use solvability::{Stretches, VerdictTrack};

use crate::documents::{BodyOfRunDocument, Ending};
use crate::error::StudyError;
use crate::rows::{RowFault, RowSink};
use crate::tables_of_run::{TableRows, finished};

/// Name of the tables in messages.
const NAME: &str = "body_*.csv";

/// Owners of the loads that do not belong to a joint, drive or force element. Loads of armatures
/// have the names of their joint coordinates.
const OF_MASS: [&str; 2] = ["gravity", "inertia"];

/// Writer of the loads on one body. If some joints may not be determined, all rows are first
/// written to a file that is removed at the end.
pub(crate) struct BodyLoads<'m> {
    directory: &'m OutputDirectory,
    mechanism: &'m Mechanism,
    body: usize,
    /// The name of the body in file names.
    stem: String,
    /// The joints and drives that act on the body.
    joints: Vec<ConstraintId>,
    loads: Loads<'m>,
    s: Scratch,
    table: Option<Table<OutputFile>>,
    /// Whether every number is determined at all times.
    is_plain: bool,
    /// Whether the values of the first choice are written.
    is_chosen: bool,
    rows: TableRows,
    /// Data of the written table for the document of the run. The data are complete after
    /// `RowSink::end`.
    pub(crate) found: BodyOfRunDocument,
}

impl<'m> BodyLoads<'m> {
    /// Creates the table. `is_plain` states that no row is redundant. `is_chosen` states that the
    /// run has a choice.
    ///
    /// # Errors
    /// [`StudyError::File`], [`StudyError::Table`]; [`StudyError::LoadName`]: a joint or force has
    /// the name of another load.
    pub(crate) fn begin(
        directory: &'m OutputDirectory,
        mechanism: &'m Mechanism,
        body: usize,
        (rows, units): (TableRows, Option<SceneUnits>),
        (is_plain, is_chosen): (bool, bool),
    ) -> Result<Self, StudyError> {
        let layout = mechanism.layout();
        let joints = joints_of(mechanism, body);
        let own = BodyRef::Body(body);
        let forces = mechanism.applied_forces().iter();
        let forces = forces.filter(|force| force.bodies.contains(&own));
        let names = joints.iter().map(|id| layout.groups[id.0].name.as_str());
        let names: Vec<&str> = names.chain(forces.map(|force| force.name)).collect();
        let armatures = mechanism.armatures();
        let armatures = armatures.filter(|armature| armature.bodies.contains(&own));
        let armatures: Vec<String> = armatures.map(|armature| armature.to_string()).collect();
        if let Some(name) = names.iter().find(|name| OF_MASS.contains(name)) {
            return Err(StudyError::LoadName {
                body: mechanism.bodies()[body].name.clone(),
                name: (*name).to_owned(),
            });
        }
        let space = mechanism.space();
        let of = |name: &str| {
            let column = |c: &&'static str| {
                let unit = space.load_unit(c).unwrap_or_default();
                (format!("{name}.{c}"), unit)
            };
            space.components().iter().map(column).collect::<Vec<_>>()
        };
        let names = names.into_iter().chain(OF_MASS);
        let names = names.chain(armatures.iter().map(String::as_str));
        let columns: Vec<(String, &str)> = names.flat_map(of).collect();
        let bodies = mechanism.bodies().iter().map(|body| body.name.as_str());
        let stem = file_stems(bodies).swap_remove(body);
        let out = if is_plain {
            directory.file(format!("body_{stem}.csv"))?
        } else {
            directory.scratch(&format!("all_body_{stem}.csv"))?
        };
        Ok(Self {
            directory,
            mechanism,
            body,
            stem,
            joints,
            loads: mechanism.loads(),
            s: mechanism.scratch(),
            table: Some(Table::over_time(NAME, out, columns, units)?),
            is_plain,
            is_chosen,
            rows,
            found: BodyOfRunDocument::default(),
        })
    }

    /// Returns the wrenches on the body about its centre of mass along the axes of its frame.
    fn wrenches(&mut self, sample: &mut Sample<'_, '_>) -> Result<Vec<Reaction>, RowFault> {
        let (mechanism, body, s) = (self.mechanism, self.body, &mut self.s);
        let space = mechanism.space();
        let mut chosen = Vec::new();
        if self.is_chosen {
            chosen = sample.chosen()?;
        }
        let own = sample.multipliers()?;
        let lambda = match chosen.first() {
            Some(first) => first.multipliers.as_chosen(),
            None => own.as_chosen(),
        };
        let a = sample.acceleration()?;
        let t = mechanism.layout().before_break(sample.t);
        mechanism.pose(t, sample.q, s);
        mechanism.c(s);
        self.loads.set(t, sample.q, sample.v);
        let reactions = mechanism.reactions(s);
        let map = reactions.body_wrench_map(body, s.bodies.origin(body));
        let joints = self.joints.iter().map(|id| {
            let rows = &mechanism.layout().groups[id.0].rows;
            let of = |k: usize| {
                let entry = |i: usize| map.as_ref().map_or(0.0, |map| map[(k, i)]);
                rows.iter().map(|i| entry(i) * lambda[i]).sum::<f64>()
            };
            let components: Vec<f64> = (0..space.n_v()).map(of).collect();
            Reaction::new(space, &components, None)
        });
        let joints: Vec<Reaction> = joints.collect();
        let forces = self.loads.on_body(body).map(|(_, load)| load);
        let all = joints.into_iter().chain(forces);
        let all = all.chain(self.loads.of_mass(body, &a));
        let all = all.chain(self.loads.of_armatures(body, &a).map(|(_, load)| load));
        let axes = reactions.frame_axes(BodyRef::Body(body));
        Ok(all.map(|wrench| wrench.along(axes)).collect())
    }

    /// Copies the rows at which all loads are determined. With a choice, copies all rows.
    fn copy(
        &mut self,
        mut all: OutputFile,
        tracks: &[&VerdictTrack],
    ) -> Result<OutputFile, StudyError> {
        let is_determined = |t: f64| tracks.iter().all(|track| track.at(t).is_unique());
        let is_open = tracks.iter().any(|track| !track.of_run().is_unique());
        self.found.choice = self.is_chosen && is_open;
        if self.found.choice {
            self.found.file.insert_str(0, "choice_");
        }
        let mut out = self.directory.file(&self.found.file)?;
        let all = BufReader::new(all.written()?);
        let copied = (|| {
            let mut to = BufWriter::new(&mut out);
            for line in all.lines() {
                let line = line?;
                let t = line.split(',').next().and_then(|t| t.parse().ok());
                if self.found.choice || t.is_none_or(is_determined) {
                    writeln!(to, "{line}")?;
                } else {
                    self.found.rows_left_out += 1;
                }
            }
            to.flush()
        })();
        copied.map_err(|source| TableError::Write {
            table: NAME,
            source,
        })?;
        Ok(out)
    }
}

/// Returns the joints and drives that act on a body.
pub(crate) fn joints_of(mechanism: &Mechanism, body: usize) -> Vec<ConstraintId> {
    let layout = mechanism.layout();
    let acts = |id: &ConstraintId| layout.groups[id.0].bodies.contains(&BodyRef::Body(body));
    layout.constraint_ids().filter(acts).collect()
}

impl RowSink for BodyLoads<'_> {
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault> {
        if !self.rows.take(sample.t) || self.table.is_none() {
            return Ok(ControlFlow::Continue(()));
        }
        let space = self.mechanism.space();
        let wrenches = self.wrenches(sample)?;
        let numbers = wrenches.into_iter().flat_map(|w| w.components(space));
        let row: Vec<f64> = std::iter::once(sample.t).chain(numbers).collect();
        // At an instant of lower rank, the reactions have no values.
        if row.iter().any(|number| number.is_nan()) {
            self.found.rows_left_out += 1;
        } else if let Some(table) = &mut self.table {
            table.row(&row)?;
        }
        Ok(ControlFlow::Continue(()))
    }

    fn end(&mut self, verdicts: Option<&Stretches>, ending: &Ending<'_>) -> Result<(), StudyError> {
        let Some(table) = self.table.take() else {
            return Ok(());
        };
        let mut out = table.finish()?;
        self.found.file = format!("body_{}.csv", self.stem);
        if !self.is_plain {
            let joints = self.joints.iter();
            let tracks = joints.filter_map(|id| Some(&verdicts?.reactions.get(id.0)?.whole));
            let tracks: Vec<&VerdictTrack> = tracks.collect();
            out = self.copy(out, &tracks)?;
        }
        finished(out, ending)?;
        Ok(())
    }
}
