//! Components that do not feel each other, run at the same time: each on its own thread with its own method, steps, events and break
//! times. They meet at the rows of output, where they wait until the row is done with, and answer what is asked of it. Not here: who
//! belongs to which component (`plan::split`).

use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, RecvError, Sender, channel};
use std::thread::{self, ScopedJoinHandle};
use std::time::Instant;

use model::{Mechanism, Places, Reaction, System};

use super::sample::{Sample, Source, left_out};
use super::summary::{ComponentSummary, Failure, Summary};
use super::{Watch, run_component};
use crate::error::{MotionError, Trip};
use crate::plan::Plan;

/// What is asked of a component that waits at a row.
enum Question {
    Acceleration,
    Multipliers,
    Reactions,
    /// To go on to the next row.
    Next,
}

/// What it answers.
enum Answer {
    /// It has reached a row.
    Row {
        t: f64,
        q: Vec<f64>,
        v: Vec<f64>,
    },
    Numbers(Result<Vec<f64>, Trip>),
    Reactions(Result<Vec<Reaction>, Trip>),
}

/// A component on its thread, as seen from the rows.
struct Link {
    places: Places,
    questions: Sender<Question>,
    answers: Receiver<Answer>,
}

/// All components, waiting at a row.
pub(super) struct Several {
    links: Vec<Link>,
    /// Reactions where none is computed, which tell how many rows and joints there are.
    nobody: Vec<Reaction>,
    n_rows: usize,
    n_v: usize,
}

type Integrated = Result<Summary, Box<Failure>>;

/// Runs all components of a plan and shows their rows together.
pub(super) fn run<F>(plan: &Plan<'_>, watch: &Watch<'_>, row: F) -> Integrated
where
    F: FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, Trip>,
{
    let clock = Instant::now();
    let (outcomes, stopped) = thread::scope(|scope| {
        let mut several = Several::new(&plan.prepared().mechanism);
        let mut handles = Vec::with_capacity(plan.components.len());
        let mut refused = None;
        for (k, component) in plan.components.iter().enumerate() {
            let ((questions, asked), (told, answers)) = (channel(), channel());
            let work =
                move || run_component(plan, k, watch, |sample| Ok(serve(sample, &asked, &told)));
            match thread::Builder::new().spawn_scoped(scope, work) {
                Ok(handle) => handles.push(handle),
                Err(source) => {
                    let component = component.name.clone();
                    refused = Some(MotionError::Thread { component, source });
                    break;
                }
            }
            several.links.push(Link {
                places: component.places().cloned().unwrap_or_default(),
                questions,
                answers,
            });
        }
        let stopped = match refused {
            Some(error) => Some(error),
            None => several.go(&plan.prepared().mechanism, row).map(Into::into),
        };
        // Whoever waits goes no further.
        drop(several);
        (handles.into_iter().map(joined).collect::<Vec<_>>(), stopped)
    });
    conclude(plan, outcomes, stopped, clock.elapsed().as_secs_f64())
}

/// The result of a thread; a panic of it is one of ours.
fn joined(handle: ScopedJoinHandle<'_, Integrated>) -> Integrated {
    handle
        .join()
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Waits at a row and answers until it is done with.
fn serve(
    sample: &mut Sample<'_, '_>,
    asked: &Receiver<Question>,
    told: &Sender<Answer>,
) -> ControlFlow<()> {
    let mut answer = Answer::Row {
        t: sample.t,
        q: sample.q.to_vec(),
        v: sample.v.to_vec(),
    };
    loop {
        // Nobody listens or asks any more where the run is over.
        if told.send(answer).is_err() {
            return ControlFlow::Break(());
        }
        answer = match asked.recv() {
            Ok(Question::Next) => return ControlFlow::Continue(()),
            Ok(Question::Acceleration) => Answer::Numbers(sample.acceleration()),
            Ok(Question::Multipliers) => Answer::Numbers(sample.multipliers()),
            Ok(Question::Reactions) => Answer::Reactions(sample.reactions()),
            Err(RecvError) => return ControlFlow::Break(()),
        };
    }
}

impl Several {
    fn new(mechanism: &Mechanism) -> Self {
        let layout = mechanism.layout();
        Self {
            links: Vec::new(),
            nobody: (0..layout.groups.len())
                .map(|k| left_out(mechanism, k))
                .collect(),
            n_rows: layout.rows(),
            n_v: layout.n_v,
        }
    }

    /// Shows rows as long as all components reach them and more are wanted. Why it was stopped by a row, if it was.
    fn go<F>(&mut self, mechanism: &Mechanism, mut row: F) -> Option<Trip>
    where
        F: FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, Trip>,
    {
        let (mut q, mut v) = (vec![0.0; mechanism.layout().n_q], vec![0.0; self.n_v]);
        while let Some(t) = self.next(&mut q, &mut v) {
            let shown = row(&mut Sample {
                t,
                q: &q,
                v: &v,
                source: Source::Several(self),
            });
            match shown {
                Ok(ControlFlow::Continue(())) => {}
                Ok(ControlFlow::Break(())) => return None,
                Err(trip) => return Some(trip),
            }
            for link in &self.links {
                // One that has ended is found out at the next row.
                let _ = link.questions.send(Question::Next);
            }
        }
        None
    }

    /// Takes the state of all components at the next row; nothing if one of them has ended.
    fn next(&mut self, q: &mut [f64], v: &mut [f64]) -> Option<f64> {
        let mut time = None;
        for link in &self.links {
            let Ok(Answer::Row {
                t,
                q: own_q,
                v: own_v,
            }) = link.answers.recv()
            else {
                return None;
            };
            assert!(
                time.is_none_or(|known| known == t),
                "rows of components at {time:?} and {t} s"
            );
            time = Some(t);
            spread(&own_q, &link.places.coordinates, q);
            spread(&own_v, &link.places.velocities, v);
        }
        time
    }

    pub(super) fn acceleration(&mut self) -> Result<Vec<f64>, Trip> {
        let a = vec![f64::NAN; self.n_v];
        self.numbers(|| Question::Acceleration, |places| &places.velocities, a)
    }

    pub(super) fn multipliers(&mut self) -> Result<Vec<f64>, Trip> {
        let lambda = vec![f64::NAN; self.n_rows];
        self.numbers(|| Question::Multipliers, |places| &places.rows, lambda)
    }

    pub(super) fn reactions(&mut self) -> Result<Vec<Reaction>, Trip> {
        self.ask(|| Question::Reactions);
        let mut reactions = self.nobody.clone();
        let mut outcome = Ok(());
        for link in &self.links {
            // All answers are taken, so that the next ones are those of the next question.
            if let Ok(Answer::Reactions(own)) = link.answers.recv() {
                match own {
                    Ok(own) => spread(&own, &link.places.groups, &mut reactions),
                    Err(trip) => outcome = outcome.and(Err(trip)),
                }
            }
        }
        outcome.map(|()| reactions)
    }

    fn numbers(
        &mut self,
        question: impl Fn() -> Question,
        places: impl Fn(&Places) -> &[usize],
        mut all: Vec<f64>,
    ) -> Result<Vec<f64>, Trip> {
        self.ask(question);
        let mut outcome = Ok(());
        for link in &self.links {
            if let Ok(Answer::Numbers(own)) = link.answers.recv() {
                match own {
                    Ok(own) => spread(&own, places(&link.places), &mut all),
                    Err(trip) => outcome = outcome.and(Err(trip)),
                }
            }
        }
        outcome.map(|()| all)
    }

    fn ask(&self, question: impl Fn() -> Question) {
        for link in &self.links {
            let _ = link.questions.send(question());
        }
    }
}

/// Puts values of a part to their places in the whole.
fn spread<T: Copy>(own: &[T], places: &[usize], whole: &mut [T]) {
    for (x, &place) in own.iter().zip(places) {
        whole[place] = *x;
    }
}

/// The outcome of the whole from those of its components.
fn conclude(
    plan: &Plan<'_>,
    outcomes: Vec<Integrated>,
    stopped: Option<MotionError>,
    wall_seconds: f64,
) -> Integrated {
    let mut components = Vec::with_capacity(outcomes.len());
    let mut earliest: Option<(f64, MotionError)> = None;
    for (component, outcome) in plan.components.iter().zip(outcomes) {
        let (summary, error) = match outcome {
            Ok(summary) => (summary, None),
            Err(failure) => (failure.summary, Some(failure.error)),
        };
        if let Some(error) = error
            && earliest.as_ref().is_none_or(|(t, _)| summary.t < *t)
        {
            let source = Box::new(error);
            let component = component.name.clone();
            earliest = Some((summary.t, MotionError::Component { component, source }));
        }
        // Where a thread was refused there are fewer outcomes than components.
        components.push(ComponentSummary {
            name: component.name.clone(),
            places: component.places().cloned().unwrap_or_default(),
            summary,
        });
    }
    let dropped: Vec<&[usize]> = plan
        .components
        .iter()
        .map(|c| c.prepared().decision.dropped.as_slice())
        .collect();
    let summary = Summary::of_components(components, &dropped, wall_seconds);
    match stopped.or(earliest.map(|(_, error)| error)) {
        Some(error) => Err(Box::new(Failure { error, summary })),
        None => Ok(summary),
    }
}
