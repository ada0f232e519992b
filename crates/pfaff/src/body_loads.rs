//! All loads on a body during a run, for finite elements: `body_NAME.csv`.

use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::ops::ControlFlow;

use dynamics::Sample;
use model::{BodyRef, ConstraintId, Loads, Mechanism, Reaction, SpaceKind, System};
use report::{OutputDirectory, OutputFile, SceneUnits, Table, TableError};
use solvability::Stretches;

use crate::documents::Ending;
use crate::error::StudyError;
use crate::rows::{RowFault, RowSink};
use crate::tables_of_run::{TableRows, finished};

/// Name of the tables in messages.
const NAME: &str = "body_*.csv";

/// Returns the file name of the loads on a body. Characters that file names may not have are
/// replaced, and the number of the body follows.
///
/// # Panics
/// Panics if the body does not exist.
pub(crate) fn body_file(mechanism: &Mechanism, body: usize) -> String {
    let name = &mechanism.bodies()[body].name;
    let is_plain = |c: char| c.is_alphanumeric() || "-_. ".contains(c);
    if name.chars().all(is_plain) {
        return format!("body_{name}.csv");
    }
    let plain = name.replace(|c| !is_plain(c), "_");
    format!("body_{plain}.{}.csv", body + 1)
}

/// Writer of the loads on one body. If some joints are determined only on parts of the run, all
/// rows are first written to a file that is removed at the end.
pub(crate) struct BodyLoads<'m> {
    directory: &'m OutputDirectory,
    mechanism: &'m Mechanism,
    body: usize,
    /// The joints and drives that act on the body.
    joints: Vec<ConstraintId>,
    loads: Loads<'m>,
    table: Option<Table<OutputFile>>,
    /// Whether every row is written at once.
    is_final: bool,
    /// Whether the values of the first choice are written.
    is_chosen: bool,
    rows: TableRows,
}

impl<'m> BodyLoads<'m> {
    /// Creates the table. `is_plain` states that no row is redundant.
    ///
    /// # Errors
    /// [`StudyError::File`], [`StudyError::Table`].
    pub(crate) fn begin(
        directory: &'m OutputDirectory,
        mechanism: &'m Mechanism,
        body: usize,
        (rows, units): (TableRows, Option<SceneUnits>),
        (is_plain, is_chosen): (bool, bool),
    ) -> Result<Self, StudyError> {
        let layout = mechanism.layout();
        let joints = joints_of(mechanism, body);
        let loads = mechanism.loads();
        let own = BodyRef::Body(body);
        let forces = mechanism.applied_forces().iter();
        let forces = forces.filter(|force| force.bodies.contains(&own));
        let names = joints.iter().map(|id| layout.groups[id.0].name.as_str());
        let names = names.chain(forces.map(|force| force.name));
        let names = names.chain(["gravity", "inertia"]);
        let space = mechanism.space();
        let components = space.components();
        let of = |name: &str| {
            let column = |c: &&'static str| {
                let unit = space.load_unit(c).unwrap_or_default();
                (format!("{name}.{c}"), unit)
            };
            components.iter().map(column).collect::<Vec<_>>()
        };
        let columns: Vec<(String, &str)> = names.flat_map(of).collect();
        let file = body_file(mechanism, body);
        let is_final = is_plain || is_chosen;
        let out = if is_final {
            directory.file(&file)?
        } else {
            directory.scratch(&format!("all_{file}"))?
        };
        Ok(Self {
            directory,
            mechanism,
            body,
            joints,
            loads,
            table: Some(Table::over_time(NAME, out, columns, units)?),
            is_final,
            is_chosen,
            rows,
        })
    }

    /// Returns the wrenches on the body about its centre of mass along the axes of its frame.
    fn wrenches(&mut self, sample: &mut Sample<'_, '_>) -> Result<Vec<Reaction>, RowFault> {
        let (mechanism, body) = (self.mechanism, self.body);
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
        let mut s = mechanism.scratch();
        mechanism.pose(t, sample.q, &mut s);
        mechanism.c(&mut s);
        self.loads.at(t, sample.q, sample.v);
        let reactions = mechanism.reactions(&s);
        let map = reactions.body_wrench_map(body, s.bodies.origin(body));
        let joints = self.joints.iter().map(|id| {
            let rows = mechanism.layout().groups[id.0].rows.iter();
            let rows: Vec<usize> = rows.collect();
            let of = |k: usize| {
                let map = map.as_ref();
                let terms = rows
                    .iter()
                    .map(|&i| map.map_or(0.0, |map| map[(k, i)]) * lambda[i]);
                terms.sum::<f64>()
            };
            let components: Vec<f64> = (0..space.n_v()).map(of).collect();
            Reaction::new(space, &components, None)
        });
        let mut all: Vec<Reaction> = joints.collect();
        all.extend(self.loads.on_body(body).map(|(_, load)| load));
        let columns = space.columns_of(body);
        let weight = Reaction::new(space, &mechanism.weight()[columns.clone()], None);
        all.push(weight);
        let (mass, v) = (
            &mechanism.mass()[columns.clone()],
            &sample.v[columns.clone()],
        );
        let mut inertia: Vec<f64> = mass.iter().zip(&a[columns]).map(|(m, a)| -m * a).collect();
        if space == SpaceKind::Space3 {
            let axes = s.bodies.axes(body);
            let [w, j] = [v, mass].map(|of| [of[3], of[4], of[5]]);
            // −J·α − ω × J·ω in the axes of the coordinates, then in ground axes.
            let turning = [
                inertia[3] + (j[1] - j[2]) * w[1] * w[2],
                inertia[4] + (j[2] - j[0]) * w[2] * w[0],
                inertia[5] + (j[0] - j[1]) * w[0] * w[1],
            ];
            for k in 0..3 {
                inertia[3 + k] = (0..3).map(|axis| axes[axis][k] * turning[axis]).sum();
            }
        }
        all.push(Reaction::new(space, &inertia, None));
        let axes = reactions.frame_axes(BodyRef::Body(body));
        Ok(all.into_iter().map(|wrench| wrench.along(axes)).collect())
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
        // At an instant of lower rank the reactions have no values.
        if let Some(table) = &mut self.table
            && row.iter().all(|number| !number.is_nan())
        {
            table.row(&row)?;
        }
        Ok(ControlFlow::Continue(()))
    }

    fn end(&mut self, verdicts: Option<&Stretches>, ending: &Ending<'_>) -> Result<(), StudyError> {
        let Some(table) = self.table.take() else {
            return Ok(());
        };
        let mut all = table.finish()?;
        if self.is_final {
            finished(all, ending)?;
            return Ok(());
        }
        let tracks = self
            .joints
            .iter()
            .filter_map(|id| Some(&verdicts?.reactions.get(id.0)?.whole));
        let tracks: Vec<_> = tracks.collect();
        let is_determined = |line: &str| {
            let t = line.split(',').next().and_then(|t| t.parse().ok());
            t.is_none_or(|t: f64| tracks.iter().all(|track| track.at(t).is_unique()))
        };
        let mut out = self.directory.file(body_file(self.mechanism, self.body))?;
        let write = |source| TableError::Write {
            table: NAME,
            source,
        };
        let all: BufReader<File> = BufReader::new(all.written()?);
        let copied = (|| {
            let mut to = BufWriter::new(&mut out);
            for line in all.lines() {
                let line = line?;
                if is_determined(&line) {
                    writeln!(to, "{line}")?;
                }
            }
            to.flush()
        })();
        copied.map_err(write)?;
        finished(out, ending)?;
        Ok(())
    }
}
