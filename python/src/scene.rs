//! The text of a scene, and all results that are computed from it.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pfaff::choice::choices;
use pfaff::documents::EventDocument;
use pfaff::import::{Axes, Base, Drives, FixedLinks, Folder, Options};
use pfaff::memory::Budget;
use pfaff::model::codes::Code;
use pfaff::model::{Mechanism, Registry, System, Tolerance};
use pfaff::page::Origin;
use pfaff::question::{Control, Output, Place};
use pfaff::questions::Questions;
use pfaff::refusal::{Refusal, json};
use pfaff::report::part_as_json;
use pfaff::report::{
    Column as ReportColumn, FileError, OutputDirectory, Provenance, ReactionColumn, Trajectory,
    load_columns, load_numbers,
};
use pfaff::scene::{KeyError, Template as Keys};
use pfaff::solvability::Choice;
use pfaff::start::{JudgedStart, Start};
use pfaff::study::{EndedRun, more_columns};
use pfaff::template::Template;
use pfaff::view::{Drawing, Form};
use pfaff::work_precision::provenance::{date, machine};
use pfaff::{AssembledScene, RunOptions, Study, StudyError, source};
use pyo3::prelude::*;

use crate::control::Kinematics;
use crate::fault::{Fault, wrong};
use crate::functions::Functions;
use crate::hearing::{Hearing, heard, heard_here};
use crate::options::{Common, RunKeywords, Size, budget, rows_from_zero, unknown};
use crate::run::{Column, Recorded, RecordedTable, Run, by_rows};

pub(crate) static REGISTRY: LazyLock<Registry> = LazyLock::new(Registry::standard);

/// The text of a scene. The text does not change; results that were computed from it are stored.
#[pyclass(frozen, module = "pfaff._pfaff")]
pub(crate) struct Scene(pub(crate) Arc<Source>);

impl Scene {
    fn of(name: String, text: String) -> Self {
        let start = Mutex::new(None);
        Self(Arc::new(Source { name, text, start }))
    }
}

/// A text with its name in messages, and the start for the last request.
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) text: String,
    start: Mutex<Option<Arc<Start<'static>>>>,
}

impl Source {
    /// Adds positions in the text to an error.
    pub(crate) fn fault(&self, error: StudyError) -> Fault {
        Refusal::of((&self.name, &self.text), error).into()
    }

    pub(crate) fn assembled(
        &self,
        tolerance: Tolerance,
        budget: Budget,
    ) -> Result<AssembledScene, Fault> {
        Ok(budget.assembled((&self.name, &self.text), &REGISTRY, tolerance)?)
    }

    /// Returns the start with this tolerance of the data, within this memory limit. Stored results
    /// for the configuration remain available.
    fn start(&self, tolerance: Tolerance, budget: Budget) -> Arc<Start<'static>> {
        let mut last = self.start.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(start) = last.as_ref()
            && (start.tolerance, start.budget) == (tolerance, budget)
        {
            return Arc::clone(start);
        }
        let mut start = Start::new(self.name.clone(), self.text.clone(), &REGISTRY, budget);
        start.tolerance = tolerance;
        if let Some(known) = last.as_ref().filter(|known| known.tolerance == tolerance) {
            start = start.knowing(known);
        }
        let start = Arc::new(start);
        *last = Some(Arc::clone(&start));
        start
    }

    /// Returns the scene with its start. The scene is read and assembled only once.
    pub(crate) fn judged(
        &self,
        (tolerance, budget): (Tolerance, Budget),
        drop: Option<Vec<usize>>,
    ) -> Result<Arc<JudgedStart>, Fault> {
        let start = self.start(tolerance, budget);
        let with = RunOptions {
            drop,
            ..RunOptions::default()
        };
        Ok(match with.drop {
            None => start.judged(&Control::quiet())?,
            Some(_) => Arc::new(start.judged_with(&with, &Control::quiet())?),
        })
    }

    /// Returns the scene with Python functions in it, for one run.
    fn with_functions(
        &self,
        functions: Functions,
        start: Option<&(f64, Vec<f64>, Vec<f64>)>,
        (options, overrides): (&RunKeywords, &RunOptions),
        hearing: &Arc<Hearing>,
    ) -> Result<Study, Fault> {
        let within = (options.common.tolerance(), options.common.budget()?);
        if functions.is_empty() && start.is_none() {
            let assembled = self.assembled(within.0, within.1)?;
            return assembled.prepare(overrides).map_err(|e| self.fault(e));
        }
        let judged = self.judged(within, overrides.drop.clone())?;
        let study = self.started(judged.study()?, start)?;
        let mut scene = study.scene.clone();
        functions.put_into(&mut scene.description, &study, hearing)?;
        let own = AssembledScene::build(scene).and_then(|own| own.prepare(overrides));
        let own = own.map_err(|e| self.fault(e))?;
        let started =
            start.map(|_| own.at(study.start_time(), &study.prepared.q, &study.prepared.v));
        Ok(started
            .transpose()
            .map_err(|e| self.fault(e))?
            .unwrap_or(own))
    }

    /// Returns a study with this start, or with its own start.
    pub(crate) fn started(
        &self,
        study: &Study,
        start: Option<&(f64, Vec<f64>, Vec<f64>)>,
    ) -> Result<Study, Fault> {
        let Some((t, q, v)) = start else {
            return Ok(study.clone());
        };
        study.at(*t, q, v).map_err(|e| self.fault(e))
    }

    /// Reads choices in the syntax of the command.
    fn choices(&self, texts: &[String], study: &Study) -> Result<Vec<Choice>, Fault> {
        let layout = study.prepared.mechanism.layout();
        let source = (self.name.as_str(), self.text.as_str());
        let reaction = |name: &str| {
            let found = study.reaction(name);
            found.map_err(|e| Refusal::of(source, e))
        };
        let found = choices(texts, (layout.space, layout.rows(), &reaction))?;
        let has_misfit = |choice: &Choice| match choice {
            Choice::Compliance(supports) => !supports.misfits.is_empty(),
            _ => false,
        };
        if found.iter().any(has_misfit) {
            let message = "a misfit is stated in ground axes at one instant: use `Scene.analyze(at_time=…).reactions`";
            return Err(wrong(message.to_owned()));
        }
        Ok(found)
    }

    fn recorded(&self, asked: RunAsked, hearing: &Arc<Hearing>) -> Result<Recorded, Fault> {
        let RunAsked {
            options,
            numbers_of_choice,
            choices,
            functions,
            start,
            on_event,
            on_row,
        } = asked;
        let overrides = options.run()?;
        let budget = options.common.budget()?;
        let (judged, own);
        let study = if functions.is_empty() && start.is_none() {
            judged = self.judged((options.common.tolerance(), budget), overrides.drop.clone())?;
            judged.study()?
        } else {
            own =
                self.with_functions(functions, start.as_ref(), (&options, &overrides), hearing)?;
            &own
        };
        let of_run = study.memory(self.text.len()).map_err(|e| self.fault(e))?;
        budget.allow(of_run, "this run")?;
        let start = study
            .analyse(study.start_time(), None)
            .map_err(|e| self.fault(e))?;
        options.check_names(&start)?;
        let mut wanted = options.wanted();
        for choice in self.choices(&choices, study)? {
            let named = start.named(&choice).map_err(|e| self.fault(e))?;
            wanted.choices.push(named);
        }
        let elasticity = options.elasticity(study)?;
        let motion = study.options_with(&overrides);
        let mut motion = motion.ok_or_else(|| self.fault(StudyError::NoEnd))?;
        motion.output_step = options.output_step.unwrap_or(motion.output_step);
        let mechanism = &study.prepared.mechanism;
        wanted.accelerations = study.scene.output.accelerations;
        let mut trajectory = Trajectory::new(mechanism, more_columns(&study.scene.output));
        let names = wanted.choices.iter().map(|named| named.label.to_string());
        let mut rows = Recorded {
            chosen: names.map(|name| (name, Vec::new())).collect(),
            trajectory: RecordedTable {
                columns: trajectory.columns().iter().map(column).collect(),
                ..RecordedTable::default()
            },
            loads: RecordedTable {
                columns: columns_of_loads(mechanism),
                ..RecordedTable::default()
            },
            ..Recorded::default()
        };
        let space = mechanism.space();
        let mut room = Room {
            expected: ((motion.t_end - study.start_time()) / motion.output_step).ceil() + 1.0,
            budget,
            of_run,
            refused: None,
        };
        let stop = || hearing.ends();
        let ended = study.show_bounded(
            &motion,
            &wanted,
            elasticity.as_ref(),
            &stop,
            |sample, numbers| {
                rows.t.push(sample.t);
                rows.q.extend(sample.q);
                rows.v.extend(sample.v);
                let a = trajectory
                    .has_accelerations()
                    .then(|| sample.acceleration());
                let a = a.and_then(Result::ok);
                let state = (sample.q, sample.v);
                trajectory.extend(&mut rows.trajectory.numbers, sample.t, state, a.as_deref());
                let all = std::iter::once(&mut rows.reactions.numbers);
                let all = all.chain(rows.chosen.iter_mut().map(|(_, own)| own));
                let of_each = std::iter::once(numbers).chain(&numbers.choices);
                for (own, numbers) in all.zip(of_each) {
                    for reaction in numbers.reactions.as_chosen() {
                        own.extend(reaction.components(space));
                        own.extend(reaction.component);
                    }
                    own.extend(numbers.groups.as_chosen());
                }
                let loads = numbers.loads.iter();
                let loads = loads.flat_map(|load| load_numbers(space, load));
                rows.loads.numbers.extend(loads);
                for event in sample.events {
                    if let Some(on_event) = &on_event {
                        let document = EventDocument::new(event, mechanism.layout());
                        let document = part_as_json(&document).unwrap_or_default();
                        hearing.call(|py| on_event.call1(py, (document,)));
                    }
                }
                if let Some(on_row) = &on_row {
                    hearing.call(|py| on_row.call1(py, (sample.t,)));
                }
                room.make(&mut rows);
                if room.refused.is_some() || hearing.ends() {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        if let Some(refusal) = room.refused {
            return Err(refusal.into());
        }
        let EndedRun {
            document,
            stopped,
            stretches,
            columns,
            bounds,
            ..
        } = match ended {
            // The Python exception contains more information.
            Err(StudyError::Interrupted) => return Ok(rows),
            other => other.map_err(|e| self.fault(e))?,
        };
        rows.reactions.columns = columns.iter().map(|c| column(&c.column)).collect();
        rows.reaction_names = columns.iter().map(ReactionColumn::name).collect();
        if let Some(stretches) = stretches {
            rows.tell_determined(&columns, &stretches, numbers_of_choice);
        }
        for (k, own) in rows.bounds.iter_mut().enumerate() {
            let ends = bounds.iter().flat_map(|(_, row)| row);
            *own = ends.map(|ends| ends[k]).collect();
        }
        rows.stopped = stopped.map(|error| Refusal::of((&self.name, &self.text), error.into()));
        rows.document = json(&document)?;
        Ok(rows)
    }
}

/// The request for a run.
struct RunAsked {
    options: RunKeywords,
    numbers_of_choice: bool,
    choices: Vec<String>,
    functions: Functions,
    start: Option<(f64, Vec<f64>, Vec<f64>)>,
    on_event: Option<Py<PyAny>>,
    on_row: Option<Py<PyAny>>,
}

/// Limits of the memory for the rows of a run. A request for too much memory is rejected before the
/// allocation.
struct Room {
    /// Number of rows without the rows of events.
    expected: f64,
    budget: Budget,
    /// Memory (bytes) of the run without its rows.
    of_run: usize,
    refused: Option<Refusal>,
}

impl Room {
    /// Reserves memory for all rows after the first row, and later for one row at a time.
    fn make(&mut self, rows: &mut Recorded) {
        let count = rows.t.len();
        let fixed = [
            &mut rows.t,
            &mut rows.q,
            &mut rows.v,
            &mut rows.trajectory.numbers,
            &mut rows.reactions.numbers,
            &mut rows.loads.numbers,
        ];
        let chosen = rows.chosen.iter_mut().map(|(_, numbers)| numbers);
        let mut tables: Vec<&mut Vec<f64>> = fixed.into_iter().chain(chosen).collect();
        if count == 1 {
            let width: usize = tables.iter().map(|table| table.len()).sum();
            let bytes = self.expected * (width * size_of::<f64>()) as f64;
            let all = self.of_run.saturating_add(bytes as usize);
            if let Err(refusal) = self.budget.allow(all, "this run with its rows") {
                self.refused = Some(refusal);
                return;
            }
            for table in &mut tables {
                // If the reservation fails, the table grows step by step.
                let _ = table.try_reserve_exact(table.len().saturating_mul(self.expected as usize));
            }
        }
        for table in tables {
            let width = table.len() / count.max(1);
            if table.try_reserve(width).is_err() {
                let words = format!("the memory does not suffice for more than {count} rows");
                self.refused = Some(Refusal::stopped(words).coded(const { Code::new(7) }));
            }
        }
    }
}

fn columns_of_loads(mechanism: &Mechanism) -> Vec<Column> {
    let (space, loads) = (mechanism.space(), mechanism.loads());
    let all = loads.forces();
    let all = all.flat_map(|(name, measure)| load_columns(space, name, measure));
    all.map(|own| column(&own)).collect()
}

fn column(column: &ReportColumn) -> Column {
    let ReportColumn {
        kind,
        owner,
        number,
        ..
    } = column;
    ((*kind).to_owned(), owner.clone(), (*number).to_owned())
}

/// Kind, subject and line of an element that an import omits.
type Omission = (String, String, usize);

/// The matrices C, M (its diagonal), Γ, Q, b and Φ.
type Matrices = (
    Py<PyArray2<f64>>,
    Py<PyArray1<f64>>,
    Py<PyArray1<f64>>,
    Py<PyArray1<f64>>,
    Py<PyArray1<f64>>,
    Py<PyArray1<f64>>,
);

#[pymethods]
impl Scene {
    #[new]
    fn new(name: String, text: String) -> Self {
        Self::of(name, text)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    #[getter]
    fn text(&self) -> &str {
        &self.0.text
    }

    /// Reads a file.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let (name, text) = heard(py, move |_| Ok(source::of_file(&path)?))?;
        Ok(Self::of(name, text))
    }

    /// Returns the scene of a template.
    #[staticmethod]
    fn of_template(name: &str) -> PyResult<Self> {
        let known = Template::ALL.iter().find(|known| known.name() == name);
        let names: Vec<&str> = Template::ALL.iter().map(|known| known.name()).collect();
        let template = known
            .ok_or_else(|| Python::attach(|py| unknown("template", name, &names).raised(py)))?;
        let file = format!("{name}.toml");
        let text = template.scene(&file);
        Ok(Self::of(file, text))
    }

    /// Converts a robot model to a scene. Returns the scene, its remarks, and the omitted elements
    /// as pairs of kind and subject.
    #[staticmethod]
    #[pyo3(signature = (format, path, text, base, fixed, snap, keyframe, model, drives, pose, loops))]
    #[allow(clippy::too_many_arguments)]
    fn imported(
        py: Python<'_>,
        format: String,
        path: PathBuf,
        text: Option<String>,
        base: String,
        fixed: bool,
        snap: bool,
        keyframe: Option<String>,
        model: Option<String>,
        drives: String,
        pose: Vec<(String, f64)>,
        loops: Option<PathBuf>,
    ) -> PyResult<(Self, Vec<String>, Vec<Omission>)> {
        let made = heard(py, move |_| {
            let base = Base::ALL
                .into_iter()
                .find(|known| known.name() == base)
                .ok_or_else(|| unknown("base", &base, &Base::ALL.map(Base::name)))?;
            let drives = Drives::ALL
                .into_iter()
                .find(|known| known.name() == drives)
                .ok_or_else(|| unknown("kind of drive", &drives, &Drives::ALL.map(Drives::name)))?;
            let folder = match &text {
                Some(_) => Folder::None,
                None => Folder::of(&path),
            };
            let (name, text) = match text {
                Some(text) => (path.display().to_string(), text),
                None => source::of_file(&path)?,
            };
            let options = Options {
                folder,
                base,
                fixed: if fixed {
                    FixedLinks::Kept
                } else {
                    FixedLinks::Merged
                },
                axes: if snap { Axes::Snapped } else { Axes::Told },
                loops: loops.as_deref().map(source::of_file).transpose()?,
                pose,
                keyframe,
                model,
                drives,
            };
            let imported = pfaff::import::import(&name, &text, &options);
            let imported = imported.map_err(|refusal| Refusal::from(*refusal))?;
            if imported.format != format {
                return Err(wrong(format!(
                    "`{name}` is {}, not {format}",
                    imported.format
                )));
            }
            let omissions = imported.omissions.into_iter();
            let omissions = omissions.map(|o| (o.kind.to_owned(), o.subject, o.line));
            let stem = Path::new(&name).with_extension("toml");
            let scene = (stem.display().to_string(), imported.scene);
            Ok((scene, imported.remarks, omissions.collect()))
        });
        made.map(|((name, text), remarks, omissions)| (Self::of(name, text), remarks, omissions))
    }

    /// Returns the scene with the values of one of its load cases.
    fn case(&self, py: Python<'_>, name: String) -> PyResult<Self> {
        let own = Arc::clone(&self.0);
        let text = heard(py, move |_| {
            Ok(source::with_case(own.text.clone(), &name, &REGISTRY)?)
        })?;
        Ok(Self::of(self.0.name.clone(), text))
    }

    /// Returns the same scene with other numbers or expressions.
    fn with_settings(
        &self,
        py: Python<'_>,
        keys: Vec<String>,
        expressions: Vec<String>,
    ) -> PyResult<Self> {
        let own = Arc::clone(&self.0);
        let text = heard(py, move |_| {
            let of_keys: Vec<&str> = keys.iter().map(String::as_str).collect();
            let template = match Keys::new(&own.text, &of_keys) {
                Ok(template) => template,
                // The reader of scenes reports the error.
                Err(KeyError::NotToml) => return Ok(own.text.clone()),
                Err(e) => return Err(Refusal::input(e.to_string()).coded(e.code()).into()),
            };
            if keys.len() != expressions.len() {
                return Err(wrong("keys and expressions differ in number".to_owned()));
            }
            let expressions: Vec<&str> = expressions.iter().map(String::as_str).collect();
            Ok(template.with_expressions(&expressions))
        })?;
        Ok(Self::of(self.0.name.clone(), text))
    }

    /// Returns the name that the scene states, the names of its bodies, of its joints and drives in
    /// the order of the rows, and of its load cases.
    fn names(&self, py: Python<'_>) -> PyResult<(String, [Vec<String>; 3])> {
        let own = Arc::clone(&self.0);
        heard(py, move |_| {
            let judged = own.judged((Tolerance::default(), budget(None)?), None)?;
            let (scene, mechanism) = judged.parts();
            let bodies = mechanism.bodies().iter().map(|body| body.name.clone());
            let groups = mechanism.layout().groups.iter();
            let groups = groups.map(|group| group.name.clone());
            let cases = scene.cases.iter().map(|case| case.name.clone());
            let names = [bodies.collect(), groups.collect(), cases.collect()];
            Ok((scene.name().to_owned(), names))
        })
    }

    /// Returns the assembled start as a page or a picture, selected by the extension of a file
    /// name, and the characters of a PNG that no font contains.
    fn view(
        &self,
        py: Python<'_>,
        path: PathBuf,
        scale: Option<f64>,
        common: Common,
    ) -> PyResult<(Vec<u8>, String)> {
        let own = Arc::clone(&self.0);
        heard(py, move |_| {
            let form = Form::of(&path).ok_or_else(|| {
                let path = path.display();
                wrong(format!(
                    "path is `{path}`, need a name that ends with .html, .svg or .png"
                ))
            })?;
            if let (Some(_), Form::Page | Form::Svg) = (scale, form) {
                return Err(wrong(
                    "--scale requires a file name that ends with .png".to_owned(),
                ));
            }
            let start = own.start(common.tolerance(), common.budget()?);
            let drawing = Drawing::new(&start, form, scale, &Control::quiet())?;
            Ok((drawing.content, drawing.boxes))
        })
    }

    /// Returns coordinates and velocities at a time of the motion; the velocities are empty if they
    /// are unknown.
    fn state(
        &self,
        py: Python<'_>,
        t: f64,
        common: Common,
        drop: Option<Vec<usize>>,
    ) -> PyResult<(Vec<f64>, Vec<f64>)> {
        let own = Arc::clone(&self.0);
        heard(py, move |hearing| {
            let drop = rows_from_zero(drop.as_deref())?;
            let judged = own.judged((common.tolerance(), common.budget()?), drop)?;
            let state = match judged.as_ref() {
                JudgedStart::Stands(stands) if t == judged.start_time() => {
                    stands.kept.state.clone()
                }
                judged => {
                    let found = judged.study()?.state_until(t, &|| hearing.has_ended());
                    found.map_err(|e| own.fault(e))?
                }
            };
            Ok((state.q, state.v))
        })
    }

    /// Runs the scene. With `numbers_of_choice`, numbers that are not determined on their stretch
    /// of the run have the values for the independent rows of the run; otherwise they are NaN.
    /// `choices` have separate arrays. `drives` are functions of time, joint coordinate and rate
    /// that replace laws; `forces` are functions of the states of bodies. Each has its name.
    #[pyo3(signature = (options, numbers_of_choice, choices, on_event, on_row, drives, forces, controller, start))]
    #[allow(clippy::too_many_arguments)]
    fn simulate(
        &self,
        py: Python<'_>,
        options: RunKeywords,
        numbers_of_choice: bool,
        choices: Vec<String>,
        on_event: Option<Py<PyAny>>,
        on_row: Option<Py<PyAny>>,
        drives: Vec<(String, Py<PyAny>)>,
        forces: Vec<(String, Py<PyAny>)>,
        controller: Option<Py<PyAny>>,
        start: Option<(f64, Vec<f64>, Vec<f64>)>,
    ) -> PyResult<Run> {
        let own = Arc::clone(&self.0);
        let asked = RunAsked {
            options,
            numbers_of_choice,
            choices,
            functions: Functions {
                drives,
                forces,
                controller,
            },
            start,
            on_event,
            on_row,
        };
        let recorded = if !asked.functions.is_empty() {
            heard_here(py, |hearing| own.recorded(asked, hearing))?
        } else if asked.on_event.is_some() || asked.on_row.is_some() {
            // Ctrl-C also works during the assembly.
            let (own, options) = (Arc::clone(&own), asked.options.clone());
            heard(py, move |_| {
                let within = (options.common.tolerance(), options.common.budget()?);
                own.judged(within, options.run()?.drop)
            })?;
            heard_here(py, |hearing| self.0.recorded(asked, hearing))?
        } else {
            heard(py, move |hearing| own.recorded(asked, hearing))?
        };
        Ok(Run::new(py, recorded))
    }

    /// Runs the scene and writes the files of the command into a directory; returns the summary.
    /// With `until` the run ends at the row of this time (s), like a run that was requested to end
    /// there.
    #[pyo3(signature = (directory, options, choices, until, drives, forces, controller, start))]
    #[allow(clippy::too_many_arguments)]
    fn simulate_into(
        &self,
        py: Python<'_>,
        directory: PathBuf,
        options: RunKeywords,
        choices: Vec<String>,
        until: Option<f64>,
        drives: Vec<(String, Py<PyAny>)>,
        forces: Vec<(String, Py<PyAny>)>,
        controller: Option<Py<PyAny>>,
        start: Option<(f64, Vec<f64>, Vec<f64>)>,
    ) -> PyResult<String> {
        let own = Arc::clone(&self.0);
        let functions = Functions {
            drives,
            forces,
            controller,
        };
        let is_alone = functions.is_empty();
        let work = move |hearing: &Arc<Hearing>| {
            let overrides = options.run()?;
            let mut study =
                own.with_functions(functions, start.as_ref(), (&options, &overrides), hearing)?;
            if let (Some(step), Some(motion)) = (options.output_step, &mut study.options) {
                motion.output_step = step;
            }
            let of_run = study.memory(own.text.len()).map_err(|e| own.fault(e))?;
            options.common.budget()?.allow(of_run, "this run")?;
            study.choices = own.choices(&choices, &study)?;
            study.bounds = options.elasticity(&study)?;
            if hearing.ends() {
                return Err(own.fault(StudyError::Interrupted));
            }
            let place = OutputDirectory::create(&directory).and_then(OutputDirectory::exclusive);
            let place = place.map_err(|e| own.fault(e.into()))?;
            let origin = Origin {
                command: FROM_PYTHON.to_owned(),
                ..Origin::default()
            };
            let stop = || hearing.ends();
            let go_on = |t: f64| match until {
                Some(until) if t >= until => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            };
            let outcome = study.simulate_as(&origin, &place, &stop, go_on);
            Ok(json(&outcome.map_err(|e| own.fault(e))?)?)
        };
        if is_alone {
            heard(py, work)
        } else {
            heard_here(py, work)
        }
    }

    /// Returns the text of the scene that starts at a time, coordinates and velocities.
    fn started_text(&self, py: Python<'_>, t: f64, q: Vec<f64>, v: Vec<f64>) -> PyResult<Self> {
        let own = Arc::clone(&self.0);
        let text = heard(py, move |_| {
            let judged = own.judged((Tolerance::default(), budget(None)?), None)?;
            let study = judged.study()?;
            pfaff::solvability::check_state(&study.prepared.mechanism, t, &q, &v)
                .map_err(|e| wrong(e.to_string()))?;
            let text = study.text_at(t, &q, &v);
            Ok(text.map_err(|e| Refusal::input(e.to_string()).coded(e.code()))?)
        })?;
        Ok(Self::of(self.0.name.clone(), text))
    }

    /// Returns positions, joint coordinates and measures at any state.
    fn kinematics(&self, py: Python<'_>) -> PyResult<Kinematics> {
        let own = Arc::clone(&self.0);
        heard(py, move |_| {
            let judged = own.judged((Tolerance::default(), budget(None)?), None)?;
            Ok(Kinematics::of(judged.parts().1))
        })
    }

    /// Returns C, the diagonal of M, Γ, Q, b and Φ at coordinates and velocities; `None` selects
    /// those of the start.
    #[pyo3(signature = (q, v, t, max_memory))]
    fn matrices(
        &self,
        py: Python<'_>,
        q: Option<Vec<f64>>,
        v: Option<Vec<f64>>,
        t: f64,
        max_memory: Option<Size>,
    ) -> PyResult<Matrices> {
        let own = Arc::clone(&self.0);
        let (c, n, vectors) = heard(py, move |_| {
            let budget = budget(max_memory.as_ref())?;
            let judged = own.judged((Tolerance::default(), budget), None)?;
            let (own_q, own_v) = match judged.as_ref() {
                JudgedStart::Moves(study) => (&study.prepared.q, &study.prepared.v),
                JudgedStart::Stands(stands) => (&stands.kept.state.q, &stands.kept.state.v),
            };
            let (_, mechanism) = judged.parts();
            let layout = mechanism.layout();
            // C and M are both dense.
            let rows = layout.rows();
            let bytes = (rows.saturating_add(layout.n_v)).saturating_mul(layout.n_v);
            let bytes = bytes.saturating_mul(size_of::<f64>());
            budget.allow(bytes, "this set of dense matrices")?;
            let q = numbers("q", q, own_q, (layout.n_q, "coordinates"))?;
            let v = numbers("v", v, own_v, (layout.n_v, "velocities"))?;
            if !t.is_finite() {
                return Err(wrong(format!("t is {t}, need a finite time")));
            }
            let mut s = mechanism.scratch();
            mechanism.pose(t, &q, &mut s);
            mechanism.phi(&mut s);
            mechanism.c(&mut s);
            mechanism.b(&mut s);
            mechanism.twist(&v, &mut s);
            mechanism.gamma(&mut s);
            mechanism.force(&mut s);
            let mut c = Vec::new();
            let reserved = c.try_reserve_exact(rows * layout.n_v);
            reserved.map_err(|e| Refusal::stopped(e.to_string()).coded(const { Code::new(7) }))?;
            c.resize(rows * layout.n_v, 0.0);
            for (i, row) in c.chunks_exact_mut(layout.n_v.max(1)).enumerate() {
                layout.scatter_row(&s, i, row);
            }
            let mass = mechanism.mass().to_vec();
            Ok((c, rows, [mass, s.gamma, s.force, s.b, s.phi]))
        })?;
        let width = vectors[0].len();
        let c = if n == 0 {
            PyArray2::zeros(py, [0, width], false).unbind()
        } else {
            by_rows(py, c, n)
        };
        let [mass, gamma, force, b, phi] = vectors.map(|x| x.into_pyarray(py).unbind());
        Ok((c, mass, gamma, force, b, phi))
    }

    /// Answers a question, given by its name, about this scene and further scenes, with its options
    /// as a JSON object; returns the document, and the files if they are requested.
    fn ask(
        &self,
        py: Python<'_>,
        question: String,
        options: String,
        others: Vec<PyRef<'_, Self>>,
        common: Common,
        files: bool,
    ) -> PyResult<(String, Vec<NamedFile>)> {
        let others = others.iter().map(|other| Arc::clone(&other.0));
        let all: Vec<_> = std::iter::once(Arc::clone(&self.0)).chain(others).collect();
        heard(py, move |hearing| {
            let asked = Questions::read(&question, &options)?;
            let (tolerance, budget) = (common.tolerance(), common.budget()?);
            let starts: Vec<_> = all.iter().map(|own| own.start(tolerance, budget)).collect();
            let provenance = Provenance {
                machine: MACHINE.clone(),
                versions: format!("pfaff {}", env!("CARGO_PKG_VERSION")),
                date: date(),
                command: FROM_PYTHON.to_owned(),
            };
            let control = Control {
                stop: &|| hearing.has_ended(),
                provenance: &provenance,
                wants_files: files || common.out.is_some(),
                threads: common.threads()?,
                ..Control::quiet()
            };
            let starts: Vec<&Start<'_>> = starts.iter().map(Arc::as_ref).collect();
            let answer = asked.as_question().ask(&starts, &control)?;
            let mut place = Files::default();
            if control.wants_files {
                answer.files(&mut place)?;
            }
            if let Some(out) = &common.out {
                place.write(out, asked.facts().output)?;
            }
            Ok((answer.json()?, place.0))
        })
    }
}

/// Name of the machine, determined once.
static MACHINE: LazyLock<String> = LazyLock::new(machine);

/// Text that pages show instead of a command.
const FROM_PYTHON: &str = "called from Python";

/// A file with its name.
type NamedFile = (String, Vec<u8>);

/// The files of an answer in memory.
#[derive(Default)]
struct Files(Vec<NamedFile>);

impl Place for Files {
    fn put(&mut self, name: &str, content: &[u8]) -> Result<(), FileError> {
        self.0.push((name.to_owned(), content.to_vec()));
        Ok(())
    }
}

impl Files {
    /// Writes all files into a directory. If a file cannot be written, no file is written.
    fn write(&self, path: &Path, output: Option<Output>) -> Result<(), Refusal> {
        let Some(Output { family, .. }) = output else {
            return Ok(());
        };
        let directory = OutputDirectory::create(path)?.exclusive()?.whole();
        directory.check_ours(family)?;
        let mut written = Vec::new();
        for (name, content) in &self.0 {
            let mut file = directory.file(name)?;
            file.put(content)?;
            written.push(file);
        }
        directory.finish(family, written)?;
        Ok(())
    }
}

/// Checks that the caller gives the required number of values. Without values, returns the values
/// at the start.
fn numbers(
    name: &str,
    given: Option<Vec<f64>>,
    own: &[f64],
    (n, what): (usize, &str),
) -> Result<Vec<f64>, Fault> {
    let numbers = given.unwrap_or_else(|| own.to_vec());
    if numbers.len() != n {
        let found = numbers.len();
        return Err(wrong(format!(
            "{name} has {found} numbers, the scene has {n} {what}"
        )));
    }
    match numbers.iter().position(|x| !x.is_finite()) {
        Some(k) => Err(wrong(format!(
            "{name}[{k}] is {}, need a finite number",
            numbers[k]
        ))),
        None => Ok(numbers),
    }
}

/// Returns names of the templates, each with its description.
#[pyfunction]
pub(crate) fn templates() -> Vec<(&'static str, String)> {
    let all = Template::ALL.iter();
    all.map(|known| (known.name(), known.summary())).collect()
}

/// Returns the meaning of the code of an error, and the possible remedies.
#[pyfunction]
pub(crate) fn explain(py: Python<'_>, code: &str) -> PyResult<String> {
    let entry = pfaff::explain::entry(code);
    let entry = entry.map_err(|refusal| Fault::from(refusal).raised(py))?;
    Ok(pfaff::explain::words(entry))
}

/// Returns the known name that is most similar to a name, if there is one.
#[pyfunction]
pub(crate) fn nearest(name: &str, known: Vec<String>) -> Option<String> {
    pfaff::scene::nearest(name, known.iter().map(String::as_str)).map(str::to_owned)
}
