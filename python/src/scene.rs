//! The text of a scene, and everything that is computed of it.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pfaff::configuration::KeptAnalysis;
use pfaff::dynamics::linearise::LineariseOptions;
use pfaff::import::{Axes, Base, FixedLinks, Folder, Options};
use pfaff::model::{Mechanism, Registry, System, Tolerance};
use pfaff::refusal::{Refusal, json};
use pfaff::report::documents::{EventDocument, LinearisationDocument};
use pfaff::report::{
    AnalysisDocument, Column as ReportColumn, Origin, OutputDirectory, ReactionColumn, Trajectory,
};
use pfaff::scene::{KeyError, Template};
use pfaff::study::EndedRun;
use pfaff::{AssembledScene, Overrides, Study, StudyError, source};
use pyo3::prelude::*;

use crate::analysis::{Analysis, plain};
use crate::fault::{Fault, guarded, wrong};
use crate::functions::Functions;
use crate::hearing::{Hearing, heard};
use crate::options::{Choose, RunOptions, rows_from_zero, tolerance, unknown};
use crate::run::{Column, Recorded, Run, by_rows};

pub(crate) static REGISTRY: LazyLock<Registry> = LazyLock::new(Registry::standard);

/// A scene with its start.
pub(crate) enum Judged {
    /// It can move.
    Moves(Box<Study>),
    /// It can only be judged at its start.
    Stands {
        assembled: Box<AssembledScene>,
        kept: KeptAnalysis,
        /// Why, as a warning and as a refusal of what needs a motion.
        warning: String,
        refusal: Box<Refusal>,
    },
}

impl Judged {
    pub(crate) fn parts(&self) -> (&pfaff::scene::Scene, &Mechanism) {
        match self {
            Self::Moves(study) => (&study.scene, &study.prepared.mechanism),
            Self::Stands { assembled, .. } => (&assembled.scene, &assembled.mechanism),
        }
    }

    pub(crate) fn study(&self) -> Result<&Study, Fault> {
        match self {
            Self::Moves(study) => Ok(study),
            Self::Stands { refusal, .. } => Err(refusal.as_ref().clone().into()),
        }
    }

    /// Adds what speaks against a motion from the start, as the command does.
    pub(crate) fn add_warnings(&self, document: &mut AnalysisDocument) -> Result<(), Fault> {
        match self {
            Self::Moves(study) if document.configuration.time == 0.0 => {
                Ok(study.add_warnings(document)?)
            }
            Self::Moves(_) => Ok(()),
            Self::Stands { warning, .. } => {
                document.warnings.insert(0, warning.clone());
                Ok(())
            }
        }
    }
}

type Known = Option<(Tolerance, Arc<Judged>)>;

/// The text of a scene. It does not change; what was read from it is kept.
#[pyclass(frozen, module = "pfaff._pfaff")]
pub(crate) struct Scene {
    #[pyo3(get)]
    pub(crate) name: String,
    #[pyo3(get)]
    pub(crate) text: String,
    known: Mutex<Known>,
}

impl Scene {
    fn of(name: String, text: String) -> Self {
        Self {
            name,
            text,
            known: Mutex::new(None),
        }
    }

    /// An error with its places in the text.
    pub(crate) fn fault(&self, error: StudyError) -> Fault {
        Refusal::of((&self.name, &self.text), error).into()
    }

    pub(crate) fn assembled(&self, tolerance: Tolerance) -> Result<AssembledScene, Fault> {
        AssembledScene::read(&self.name, &self.text, &REGISTRY)
            .and_then(|assembled| assembled.stating(tolerance))
            .map_err(|e| self.fault(e))
    }

    fn prepared(&self, tolerance: Tolerance, drop: Option<Vec<usize>>) -> Result<Judged, Fault> {
        let overrides = Overrides {
            drop,
            ..Overrides::default()
        };
        let error = match self.assembled(tolerance)?.prepare(&overrides) {
            Ok(study) => return Ok(Judged::Moves(Box::new(study))),
            Err(e) => e,
        };
        let Some(warning) = error.only_motion() else {
            return Err(self.fault(error));
        };
        let refusal = Refusal::of((&self.name, &self.text), error);
        let mut assembled = self.assembled(tolerance)?;
        let kept = assembled.analyse(overrides.drop.as_deref());
        let kept = kept.map_err(|e| self.fault(e))?.kept();
        Ok(Judged::Stands {
            assembled: Box::new(assembled),
            kept,
            warning,
            refusal: Box::new(refusal),
        })
    }

    /// The scene with its start, read and assembled once.
    fn judged(&self, tolerance: Tolerance, drop: Option<Vec<usize>>) -> Result<Arc<Judged>, Fault> {
        if drop.is_some() {
            return Ok(Arc::new(self.prepared(tolerance, drop)?));
        }
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((of, judged)) = known().as_ref()
            && *of == tolerance
        {
            return Ok(Arc::clone(judged));
        }
        // Two threads may both do this; they find the same.
        let judged = Arc::new(self.prepared(tolerance, None)?);
        *known() = Some((tolerance, Arc::clone(&judged)));
        Ok(judged)
    }

    /// The scene with functions of Python in it, for one run.
    fn with_functions(
        &self,
        functions: Functions,
        (tolerance, overrides): (Tolerance, &Overrides),
        hearing: &Arc<Hearing>,
    ) -> Result<Study, Fault> {
        let mut assembled = self.assembled(tolerance)?;
        if !functions.is_empty() {
            let mut scene = assembled.scene;
            functions.put_into(&mut scene.description, hearing)?;
            assembled = AssembledScene::build(scene).map_err(|e| self.fault(e))?;
        }
        assembled.prepare(overrides).map_err(|e| self.fault(e))
    }

    fn recorded(
        &self,
        (options, functions): (&RunOptions, Functions),
        (numbers_of_choice, choices): (bool, &[Choose]),
        hearing: &Arc<Hearing>,
        [on_event, on_row]: [Option<&Py<PyAny>>; 2],
    ) -> Result<Recorded, Fault> {
        let overrides = options.overrides()?;
        let (judged, own);
        let study = if functions.is_empty() {
            judged = self.judged(options.tolerance(), overrides.drop.clone())?;
            judged.study()?
        } else {
            let of_scene = (options.tolerance(), &overrides);
            own = self.with_functions(functions, of_scene, hearing)?;
            &own
        };
        let start = study.analyse(0.0, None).map_err(|e| self.fault(e))?;
        options.check_names(&start)?;
        let mut wanted = options.wanted();
        for choice in choices {
            let choice = choice.choice(&|name| study.reaction(name))?;
            let named = start.named(&choice).map_err(|e| self.fault(e))?;
            wanted.choices.push(named);
        }
        let motion = study.options_with(&overrides);
        let mut motion = motion.ok_or_else(|| self.fault(StudyError::NoEnd))?;
        motion.output_step = options.output_step.unwrap_or(motion.output_step);
        let mechanism = &study.prepared.mechanism;
        let mut trajectory = Trajectory::new(mechanism);
        let names = wanted.choices.iter().map(|named| named.label.to_string());
        let mut rows = Recorded {
            chosen: names.map(|name| (name, Vec::new())).collect(),
            columns: trajectory.columns().iter().map(column).collect(),
            ..Recorded::default()
        };
        let space = mechanism.space();
        let stop = || hearing.ends();
        let ended = study.show(&motion, &wanted, &stop, |sample, numbers| {
            rows.t.push(sample.t);
            rows.q.extend(sample.q);
            rows.v.extend(sample.v);
            trajectory.extend(&mut rows.trajectory, sample.t, sample.q, sample.v);
            let all = std::iter::once(&mut rows.reactions);
            let all = all.chain(rows.chosen.iter_mut().map(|(_, own)| own));
            let of_each = std::iter::once(numbers).chain(&numbers.choices);
            for (own, numbers) in all.zip(of_each) {
                for reaction in numbers.reactions.as_chosen() {
                    own.extend(reaction.components(space));
                    own.extend(reaction.component);
                }
                own.extend(numbers.groups.as_chosen());
            }
            for event in sample.events {
                if let Some(on_event) = on_event {
                    let document =
                        plain(&EventDocument::new(event, mechanism.layout())).unwrap_or_default();
                    hearing.call(|py| on_event.call1(py, (document,)));
                }
            }
            if let Some(on_row) = on_row {
                hearing.call(|py| on_row.call1(py, (sample.t,)));
            }
            if hearing.ends() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        let EndedRun {
            document,
            stopped,
            stretches,
            columns,
            ..
        } = match ended {
            // The exception of Python tells more.
            Err(StudyError::Interrupted) => return Ok(rows),
            other => other.map_err(|e| self.fault(e))?,
        };
        rows.reaction_columns = columns.iter().map(|c| column(&c.column)).collect();
        rows.reaction_names = columns.iter().map(ReactionColumn::name).collect();
        if let Some(stretches) = stretches {
            rows.tell_determined(&columns, &stretches, numbers_of_choice);
        }
        rows.stopped = stopped.map(|error| Refusal::of((&self.name, &self.text), error.into()));
        rows.document = json(&document)?;
        Ok(rows)
    }
}

fn column(column: &ReportColumn) -> Column {
    let ReportColumn {
        kind,
        owner,
        number,
    } = column;
    ((*kind).to_owned(), owner.clone(), (*number).to_owned())
}

/// Kind, subject and line of what an import leaves out.
type Omission = (String, String, usize);

/// C, M (its diagonal), Γ, Q, b and Φ.
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

    /// Reads a file.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let (name, text) = guarded(py, || Ok(source::of_file(&path)?))?;
        Ok(Self::of(name, text))
    }

    /// Makes a scene of a model of a robot. Returns it, and what it says of itself: remarks, and
    /// what is left out as pairs of kind and subject.
    #[staticmethod]
    #[pyo3(signature = (format, path, text, base, fixed, snap, keyframe, pose, loops))]
    #[allow(clippy::too_many_arguments)]
    fn imported(
        py: Python<'_>,
        format: &str,
        path: PathBuf,
        text: Option<String>,
        base: &str,
        fixed: bool,
        snap: bool,
        keyframe: Option<String>,
        pose: Vec<(String, f64)>,
        loops: Option<PathBuf>,
    ) -> PyResult<(Self, Vec<String>, Vec<Omission>)> {
        guarded(py, || {
            let base = Base::ALL
                .into_iter()
                .find(|known| known.name() == base)
                .ok_or_else(|| unknown("base", base, &Base::ALL.map(Base::name)))?;
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
            let scene = Self::of(stem.display().to_string(), imported.scene);
            Ok((scene, imported.remarks, omissions.collect()))
        })
    }

    /// The same scene with other numbers or expressions.
    fn with_settings(
        &self,
        py: Python<'_>,
        keys: Vec<String>,
        expressions: Vec<String>,
    ) -> PyResult<Self> {
        let text = guarded(py, || {
            let of_keys: Vec<&str> = keys.iter().map(String::as_str).collect();
            let template = match Template::new(&self.text, &of_keys) {
                Ok(template) => template,
                // Its reader says what is wrong.
                Err(KeyError::NotToml) => return Ok(self.text.clone()),
                Err(e) => return Err(Refusal::input(e.to_string()).coded(e.code()).into()),
            };
            if keys.len() != expressions.len() {
                return Err(wrong("keys and expressions differ in number".to_owned()));
            }
            let expressions: Vec<&str> = expressions.iter().map(String::as_str).collect();
            Ok(template.with_expressions(&expressions))
        })?;
        Ok(Self::of(self.name.clone(), text))
    }

    /// Reads and assembles the scene; raises what is wrong with it.
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        guarded(py, || self.judged(Tolerance::default(), None).map(|_| ()))
    }

    /// The name that the scene gives itself, the names of its bodies, and of its joints and drives
    /// in the order of the rows.
    fn names(&self, py: Python<'_>) -> PyResult<(String, Vec<String>, Vec<String>)> {
        guarded(py, || {
            let judged = self.judged(Tolerance::default(), None)?;
            let (scene, mechanism) = judged.parts();
            let bodies = mechanism.bodies().iter().map(|body| body.name.clone());
            let groups = mechanism.layout().groups.iter();
            let groups = groups.map(|group| group.name.clone());
            Ok((scene.name().to_owned(), bodies.collect(), groups.collect()))
        })
    }

    /// Analyses a configuration.
    #[pyo3(signature = (t, length, angle, drop))]
    fn analyse(
        &self,
        py: Python<'_>,
        t: f64,
        length: Option<f64>,
        angle: Option<f64>,
        drop: Option<Vec<usize>>,
    ) -> PyResult<Analysis> {
        guarded(py, || {
            if !(t >= 0.0 && t.is_finite()) {
                return Err(wrong(format!("t is {t}, need a time ≥ 0")));
            }
            let drop = rows_from_zero(drop.as_deref())?;
            let judged = self.judged(tolerance(length, angle), drop.clone())?;
            let kept = match judged.as_ref() {
                Judged::Stands { kept, .. } if t == 0.0 => kept.clone(),
                judged => {
                    let study = judged.study()?;
                    let analysed = |ends: &(dyn Fn() -> bool + Sync)| {
                        let found = study.analyse_until(t, drop.as_deref(), ends);
                        Ok(found.map_err(|e| self.fault(e))?.kept())
                    };
                    heard(analysed)?
                }
            };
            Ok(Analysis::new(judged, kept))
        })
    }

    /// Runs the scene. With `numbers_of_choice` numbers that are not determined on their stretch of
    /// the run are those of the rows that the run keeps, otherwise NaN; `choices` have arrays of
    /// their own. `drives` are functions of time, measure and rate in place of laws, `forces`
    /// functions of the states of bodies, each with its name.
    #[pyo3(signature = (options, numbers_of_choice, choices, on_event, on_row, drives, forces))]
    #[allow(clippy::too_many_arguments)]
    fn simulate(
        &self,
        py: Python<'_>,
        options: RunOptions,
        numbers_of_choice: bool,
        choices: Vec<Choose>,
        on_event: Option<Py<PyAny>>,
        on_row: Option<Py<PyAny>>,
        drives: Vec<(String, Py<PyAny>)>,
        forces: Vec<(String, Py<PyAny>)>,
    ) -> PyResult<Run> {
        let recorded = guarded(py, || {
            let hearing = Arc::new(Hearing::new());
            let callbacks = [on_event.as_ref(), on_row.as_ref()];
            let asked = (&options, Functions { drives, forces });
            let chosen = (numbers_of_choice, choices.as_slice());
            let recorded = self.recorded(asked, chosen, &hearing, callbacks);
            match hearing.raised() {
                Some(raised) => Err(raised.into()),
                None => recorded,
            }
        })?;
        Ok(Run::new(py, recorded))
    }

    /// Runs the scene and writes the files of the command into a directory; returns the summary.
    /// With `until` the run ends at the row of this time (s), as one that was asked to end there.
    #[pyo3(signature = (directory, options, choices, until, drives, forces))]
    #[allow(clippy::too_many_arguments)]
    fn simulate_into(
        &self,
        py: Python<'_>,
        directory: PathBuf,
        options: RunOptions,
        choices: Vec<Choose>,
        until: Option<f64>,
        drives: Vec<(String, Py<PyAny>)>,
        forces: Vec<(String, Py<PyAny>)>,
    ) -> PyResult<String> {
        guarded(py, || {
            let hearing = Arc::new(Hearing::new());
            let overrides = options.overrides()?;
            let of_scene = (options.tolerance(), &overrides);
            let functions = Functions { drives, forces };
            let mut study = self.with_functions(functions, of_scene, &hearing)?;
            if let (Some(step), Some(motion)) = (options.output_step, &mut study.options) {
                motion.output_step = step;
            }
            let choices = choices.iter();
            let choices = choices.map(|choice| choice.choice(&|name| study.reaction(name)));
            study.choices = choices.collect::<Result<_, _>>()?;
            let place = OutputDirectory::create(&directory).and_then(OutputDirectory::exclusive);
            let place = place.map_err(|e| self.fault(e.into()))?;
            let origin = Origin {
                command: "called from Python".to_owned(),
                ..Origin::default()
            };
            let stop = || hearing.ends();
            let go_on = |t: f64| match until {
                Some(until) if t >= until => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            };
            let outcome = study.simulate_as(&origin, &place, &stop, go_on);
            if let Some(raised) = hearing.raised() {
                return Err(raised.into());
            }
            Ok(json(&outcome.map_err(|e| self.fault(e))?)?)
        })
    }

    /// C, the diagonal of M, Γ, Q, b and Φ at coordinates and velocities; those of the start if
    /// they are `None`.
    #[pyo3(signature = (q, v, t))]
    fn matrices(
        &self,
        py: Python<'_>,
        q: Option<Vec<f64>>,
        v: Option<Vec<f64>>,
        t: f64,
    ) -> PyResult<Matrices> {
        let (c, n, vectors) = guarded(py, || {
            let judged = self.judged(Tolerance::default(), None)?;
            let (own_q, own_v) = match judged.as_ref() {
                Judged::Moves(study) => (&study.prepared.q, &study.prepared.v),
                Judged::Stands { kept, .. } => (&kept.state.q, &kept.state.v),
            };
            let (_, mechanism) = judged.parts();
            let layout = mechanism.layout();
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
            let dense = layout.dense(&s);
            let rows = layout.rows();
            let c: Vec<f64> = (0..rows).flat_map(|i| dense.row(i).to_vec()).collect();
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

    /// The document that `pfaff linearise --json` writes.
    fn linearise(
        &self,
        py: Python<'_>,
        t: f64,
        coordinates: Vec<String>,
        follow: Vec<String>,
    ) -> PyResult<String> {
        guarded(py, || {
            if !(t >= 0.0 && t.is_finite()) {
                return Err(wrong(format!("t is {t}, need a time ≥ 0")));
            }
            let judged = self.judged(Tolerance::default(), None)?;
            let study = judged.study()?;
            let options = LineariseOptions {
                coordinates,
                follow,
            };
            let found = heard(|ends| {
                let found = study.linearise_until(t, &options, ends);
                found.map_err(|e| self.fault(e))
            })?;
            let modes = found.modes();
            let name = study.scene.name();
            Ok(json(&LinearisationDocument::new(
                name,
                &found,
                modes.as_deref(),
            ))?)
        })
    }
}

/// Numbers of the caller in the number that is needed, or those of the start.
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

/// The known name that is most similar to a name, if one is.
#[pyfunction]
pub(crate) fn nearest(name: &str, known: Vec<String>) -> Option<String> {
    pfaff::scene::nearest(name, known.iter().map(String::as_str)).map(str::to_owned)
}
