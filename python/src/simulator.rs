//! A run that Python advances step by step. A thread owns the mechanism and its motion, and does
//! the work of each call. The calling thread checks for signals. Another start is made on another
//! thread, so that the motion remains if that start fails.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use numpy::{IntoPyArray, PyArray1};
use pfaff::documents::EventDocument;
use pfaff::dynamics::{MotionError, MotionOptions, Simulator as Motion};
use pfaff::forked::on_this_thread;
use pfaff::model::System;
use pfaff::refusal::{Refusal, json};
use pfaff::report::part_as_json;
use pfaff::start::document_of;
use pfaff::{AssembledScene, RunOptions, Study, StudyError};
use pyo3::prelude::*;

use crate::fault::{Fault, guarded, raised_by, wrong};
use crate::hearing::{BETWEEN, Hearing, STACK};
use crate::options::{RunKeywords, unknown};
use crate::scene::{Scene, Source};

/// A run that is advanced step by step.
#[pyclass(frozen, module = "pfaff._pfaff")]
pub(crate) struct Simulator {
    source: Arc<Source>,
    overrides: RunOptions,
    shared: Arc<Shared>,
    jobs: Mutex<Sender<Job>>,
    /// The process that has the thread.
    process: u32,
}

/// What the thread of a simulator shares with its callers.
struct Shared {
    options: MotionOptions,
    /// Values of commanded drives, by name.
    commands: Mutex<Vec<(String, f64)>>,
    /// Signals during the current call.
    hearing: Mutex<Arc<Hearing>>,
}

/// Work for the thread. The result is the thread of another run, which does the further work.
type Job = Box<dyn FnOnce(&Study, &mut Motion<'_>) -> Option<Next> + Send>;

/// Hands the work over to the thread of a run.
struct Next(Sender<Receiver<Job>>);

impl Shared {
    /// Starts a run at the start of a study, on its own thread. Another run on another thread may
    /// do the work until the new run has started; it continues if the new run cannot start.
    fn started(
        self: &Arc<Self>,
        source: &Source,
        study: Result<Study, StudyError>,
    ) -> Result<Next, Fault> {
        let study = study.map_err(|e| source.fault(e))?;
        let (next, handed) = channel::<Receiver<Job>>();
        let (answer, answered) = channel();
        let shared = Arc::clone(self);
        let work = move || {
            let stop = || own(&shared.hearing).has_ended();
            let until = MotionOptions::to(study.start_time());
            let options = MotionOptions {
                t_end: until.t_end,
                output_step: until.output_step,
                ..shared.options.clone()
            };
            let mut motion = match Motion::new(&study.prepared, &options, &stop) {
                Ok(motion) => motion,
                Err(error) => {
                    let _ = answer.send(Err(error));
                    return;
                }
            };
            let _ = answer.send(Ok(()));
            let Ok(jobs) = handed.recv() else {
                return;
            };
            if let Some(next) = jobs.iter().find_map(|job| job(&study, &mut motion)) {
                let _ = next.0.send(jobs);
            }
        };
        let thread = thread::Builder::new().stack_size(STACK);
        let thread = thread.spawn(move || on_this_thread(work));
        thread.map_err(|e| Refusal::stopped(format!("cannot start a thread: {e}")))?;
        match answered.recv() {
            Ok(Ok(())) => Ok(Next(next)),
            Ok(Err(error)) => Err(source.fault(error.into())),
            Err(_) => Err(Refusal::stopped("the thread of the simulator has ended".into()).into()),
        }
    }
}

#[pymethods]
impl Simulator {
    /// Starts a run at the start of a scene, or at a time, coordinates and velocities.
    #[new]
    #[pyo3(signature = (scene, options, start))]
    fn new(
        py: Python<'_>,
        scene: &Scene,
        options: RunKeywords,
        start: Option<(f64, Vec<f64>, Vec<f64>)>,
    ) -> PyResult<Self> {
        let source = Arc::clone(&scene.0);
        guarded(py, move || {
            let overrides = options.run()?;
            let within = (options.common.tolerance(), options.common.budget()?);
            let judged = source.judged(within, overrides.drop.clone())?;
            let study = source.started(judged.study()?, start.as_ref())?;
            let of_run = study.memory(source.text.len());
            let of_run = of_run.map_err(|e| source.fault(e))?;
            within.1.allow(of_run, "this simulator")?;
            let with = RunOptions {
                t_end: Some(study.start_time()),
                ..overrides.clone()
            };
            let options = study.options_with(&with);
            let options = options.ok_or_else(|| source.fault(StudyError::NoEnd))?;
            let shared = Arc::new(Shared {
                options,
                commands: Mutex::default(),
                hearing: Mutex::new(Arc::new(Hearing::new())),
            });
            let next = shared.started(&source, Ok(study))?;
            let (jobs, received) = channel();
            let _ = next.0.send(received);
            Ok(Self {
                source,
                overrides,
                shared,
                jobs: Mutex::new(jobs),
                process: std::process::id(),
            })
        })
    }

    /// Advances the run to a time (s). Returns the events of the step as JSON.
    fn step(&self, py: Python<'_>, to: f64) -> PyResult<Vec<String>> {
        let source = Arc::clone(&self.source);
        self.ask(py, move |study, motion| {
            let events = motion.step(to).map_err(|e| source.fault(e.into()))?;
            let layout = study.prepared.mechanism.layout();
            let documents = events.iter().map(|event| EventDocument::new(event, layout));
            let texts = documents.map(|document| part_as_json(&document).unwrap_or_default());
            Ok((texts.collect(), None))
        })
    }

    /// The time (s), the coordinates and the velocities.
    fn state(&self, py: Python<'_>) -> PyResult<StateArrays> {
        let (t, q, v) = self.ask(py, |_, motion| Ok((current(motion), None)))?;
        let [q, v] = [q, v].map(|x| x.into_pyarray(py).unbind());
        Ok((t, q, v))
    }

    /// Continues at another time (s), with other coordinates and velocities.
    fn reset(&self, py: Python<'_>, t: f64, q: Vec<f64>, v: Vec<f64>) -> PyResult<()> {
        let (source, shared) = (Arc::clone(&self.source), Arc::clone(&self.shared));
        self.ask(py, move |study, _| {
            Ok(((), Some(shared.started(&source, study.at(t, &q, &v))?)))
        })
    }

    /// Commands a drive by a law: its force or torque keeps this value until it is changed.
    fn command(&self, py: Python<'_>, drive: String, effort: f64) -> PyResult<()> {
        if !effort.is_finite() {
            let message = format!("the value of drive `{drive}` is {effort}, need a finite number");
            return Err(wrong(message).raised(py));
        }
        let is_known = {
            let mut commands = own(&self.shared.commands);
            let found = commands.iter_mut().find(|(name, _)| *name == drive);
            found.map(|(_, value)| *value = effort).is_some()
        };
        if is_known {
            return Ok(());
        }
        let (source, shared) = (Arc::clone(&self.source), Arc::clone(&self.shared));
        let overrides = self.overrides.clone();
        self.ask(py, move |study, motion| {
            let described = commanded(study, &drive, &shared)?;
            let (t, q, v) = current(motion);
            own(&shared.commands).push((drive, effort));
            let next = AssembledScene::build(described)
                .and_then(|assembled| assembled.prepare(&overrides))
                .and_then(|study| study.at(t, &q, &v));
            let next = shared.started(&source, next);
            if next.is_err() {
                own(&shared.commands).pop();
            }
            Ok(((), Some(next?)))
        })
    }

    /// The commanded drives with their values.
    fn commands(&self) -> Vec<(String, f64)> {
        own(&self.shared.commands).clone()
    }

    /// The verdicts at the current state as JSON, and all components of the reactions of each joint
    /// for the independent rows of the run, with their names.
    fn reactions(&self, py: Python<'_>) -> PyResult<(String, Vec<Components>)> {
        let source = Arc::clone(&self.source);
        self.ask(py, move |study, motion| {
            let (t, q, v) = current(motion);
            let there = study.at(t, &q, &v).map_err(|e| source.fault(e))?;
            let start = there.analyse(t, None).map_err(|e| source.fault(e))?;
            let document = document_of(&start).map_err(|e| source.fault(e))?;
            let space = study.prepared.mechanism.space();
            let mut numbers = Vec::new();
            let sampled = motion.sample(|sample| {
                if let Ok(reactions) = sample.reactions() {
                    let names = || space.components().iter().copied();
                    let all = reactions.as_chosen().iter();
                    numbers = all
                        .map(|r| names().zip(r.components(space)).collect())
                        .collect();
                }
            });
            sampled.map_err(|e| source.fault(MotionError::from(e).into()))?;
            Ok(((json(&document)?, numbers), None))
        })
    }

    /// The number of evaluations of accelerations by all steps since the last reset.
    fn evaluations(&self, py: Python<'_>) -> PyResult<u64> {
        self.ask(py, |_, motion| Ok((motion.evaluations(), None)))
    }
}

impl Simulator {
    /// Does work on the thread of the simulator.
    fn ask<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Study, &mut Motion<'_>) -> Result<(T, Option<Next>), Fault> + Send + 'static,
    ) -> PyResult<T> {
        let hearing = Arc::new(Hearing::new());
        let listening = Arc::clone(&hearing);
        let (done, waits) = channel();
        let job: Job = Box::new(move |study, motion| {
            let outcome = catch_unwind(AssertUnwindSafe(|| work(study, motion)));
            let (outcome, next) = match outcome {
                Ok(Ok((found, next))) => (Ok(Ok(found)), next),
                Ok(Err(fault)) => (Ok(Err(fault)), None),
                Err(panic) => (Err(panic), None),
            };
            // The caller waits for every result.
            let _ = done.send(outcome);
            next
        });
        let ended = || -> Fault {
            let words = if self.process == std::process::id() {
                "the thread of the simulator has ended"
            } else {
                "the simulator belongs to the process that created it: create another one"
            };
            Refusal::stopped(words.to_owned()).into()
        };
        let heard = &listening;
        let outcome = py.detach(move || {
            // Calls from several threads are made one after another.
            let jobs = own(&self.jobs);
            *own(&self.shared.hearing) = hearing;
            if self.process != std::process::id() || jobs.send(job).is_err() {
                return Err(ended());
            }
            loop {
                match waits.recv_timeout(BETWEEN) {
                    Ok(outcome) => return Ok(outcome),
                    Err(RecvTimeoutError::Timeout) => {
                        heard.ends();
                    }
                    Err(RecvTimeoutError::Disconnected) => return Err(ended()),
                }
            }
        });
        if let Some(raised) = listening.raised() {
            return Err(raised);
        }
        match outcome {
            Ok(Ok(Ok(found))) => Ok(found),
            Ok(Ok(Err(fault))) | Err(fault) => Err(fault.raised(py)),
            Ok(Err(panic)) => Err(raised_by(py, panic.as_ref())),
        }
    }
}

/// Returns the scene in which the value of a command replaces the law of a drive.
fn commanded(
    study: &Study,
    drive: &str,
    shared: &Arc<Shared>,
) -> Result<pfaff::scene::Scene, Fault> {
    let mut scene = study.scene.clone();
    let known: Vec<String> = scene.description.laws().map(str::to_owned).collect();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    if !known.contains(&drive) && scene.description.drives().all(|(name, _)| name != drive) {
        return Err(unknown("drive by a law", drive, &known));
    }
    let (name, shared) = (drive.to_owned(), Arc::clone(shared));
    let added = scene.description.control(&[drive], &[], move |_, efforts| {
        let commands = own(&shared.commands);
        let found = commands.iter().find(|(known, _)| *known == name);
        efforts
            .drives
            .fill(found.ok_or("the drive is not commanded")?.1);
        Ok(())
    });
    added.map_err(|e| wrong(e.to_string()))?;
    Ok(scene)
}

fn current(motion: &Motion<'_>) -> (f64, Vec<f64>, Vec<f64>) {
    let (t, q, v) = motion.state();
    (t, q.to_vec(), v.to_vec())
}

/// The components of a reaction with their names.
type Components = Vec<(&'static str, f64)>;

/// Time, coordinates and velocities.
type StateArrays = (f64, Py<PyArray1<f64>>, Py<PyArray1<f64>>);

fn own<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}
