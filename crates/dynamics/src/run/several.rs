//! Independent components that run at the same time. Each component runs on its own thread with its
//! own method, steps, events and break times. Each component computes the output that the plan
//! requests. A component may be ahead of the other components by a limited number of output rows. A
//! row is passed to the caller when all components have reached it. The module `plan::split`
//! decides how bodies are assigned to components.

use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, channel, sync_channel};
use std::thread::{self, ScopedJoinHandle};
use std::time::Instant;

use model::{Places, Reaction, System};
use solvability::Stretches;

use super::caller::{ShowRow, Stop, Watch};
use super::component::run_component;
use super::permits::Permits;
use super::sample::{OfChoice, RowValues, Sample, Source, Values, left_out};
use super::summary::{ComponentSummary, Failure, Summary, WholeEvents};
use crate::error::{MotionError, MotionFault};
use crate::events::Event;
use crate::limits::AHEAD;
use crate::plan::Plan;

/// An output row of a component with all requested values.
struct Row {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    work: f64,
    events: Vec<Event>,
    values: RowValues,
}

/// A component on its thread, in the form used by the thread that collects the rows.
struct Link<'p> {
    places: &'p Places,
    rows: Receiver<Row>,
}

type RunResult = Result<Summary, Box<Failure>>;

/// Runs all components of a plan and passes their combined rows to the caller.
pub(super) fn run(
    plan: &Plan<'_>,
    watched: (&Watch<'_>, &Stop<'_>),
    row: &mut ShowRow<'_>,
) -> RunResult {
    let clock = Instant::now();
    let whole = Places::default();
    let permits = Permits::new(plan.options().threads);
    let (outcomes, stopped) = thread::scope(|scope| {
        let mut links = Vec::with_capacity(plan.components.len());
        let mut handles = Vec::with_capacity(plan.components.len());
        for (k, component) in plan.components.iter().enumerate() {
            let (told, rows) = sync_channel(AHEAD);
            let permits = &permits;
            let work = move || {
                let mut permit = permits.take();
                let mut row = |sample: &mut Sample<'_, '_>| {
                    Ok(permit.leave_for(|| tell(sample, |row| told.send(row).is_ok())))
                };
                run_component(plan, k, watched, None, &mut row)
            };
            let places = component.places().unwrap_or(&whole);
            let (rows, handle) = match thread::Builder::new().spawn_scoped(scope, work) {
                Ok(handle) => (rows, Ok(handle)),
                // The system has no more threads. This thread runs the component before it collects
                // rows, and therefore must store the rows.
                Err(_) => {
                    let (told, rows) = channel();
                    let send = |own| told.send(own).is_ok();
                    let mut row = |sample: &mut Sample<'_, '_>| Ok(tell(sample, send));
                    let outcome = run_component(plan, k, watched, None, &mut row);
                    (rows, Err(outcome))
                }
            };
            handles.push(handle);
            links.push(Link { places, rows });
        }
        let stopped = show(plan, &links, row).map(Into::into);
        // The channels are closed, so that components that are ahead stop at their next row.
        drop(links);
        let outcomes = handles
            .into_iter()
            .map(|handle| handle.map_or_else(|own| own, joined));
        (outcomes.collect::<Vec<_>>(), stopped)
    });
    conclude(plan, outcomes, stopped, clock.elapsed().as_secs_f64())
}

/// Returns the result of a thread. A panic in the thread is passed on.
fn joined(handle: ScopedJoinHandle<'_, RunResult>) -> RunResult {
    handle
        .join()
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Sends a row, as long as the receiver exists.
fn tell(sample: &mut Sample<'_, '_>, send: impl Fn(Row) -> bool) -> ControlFlow<()> {
    let row = Row {
        t: sample.t,
        q: sample.q.to_vec(),
        v: sample.v.to_vec(),
        work: sample.work,
        events: sample.events.to_vec(),
        values: sample.values(),
    };
    if send(row) {
        ControlFlow::Continue(())
    } else {
        ControlFlow::Break(())
    }
}

/// Passes rows to the caller as long as all components reach them and the caller continues. Returns
/// the fault of a row if a fault stopped the run.
fn show(plan: &Plan<'_>, links: &[Link<'_>], row: &mut ShowRow<'_>) -> Option<MotionFault> {
    let mechanism = &plan.prepared().mechanism;
    let layout = mechanism.layout();
    let nobody: Vec<Reaction> = (0..layout.groups.len())
        .map(|k| left_out(mechanism, k))
        .collect();
    let (mut q, mut v) = (vec![0.0; layout.n_q], vec![0.0; layout.n_v]);
    let places = links.iter().map(|link| link.places);
    let dropped = plan.components.iter();
    let dropped = dropped.map(|c| c.prepared().decision.dropped.as_slice());
    let mut whole = WholeEvents::new(places.zip(dropped));
    loop {
        let mut found: Vec<(usize, Event)> = Vec::new();
        let (mut time, mut work) = (None, 0.0);
        let mut without = Vec::new();
        let mut values = Values {
            acceleration: Ok(vec![f64::NAN; layout.n_v]),
            multipliers: Ok(vec![f64::NAN; layout.rows()]),
            reactions: Ok(nobody.clone()),
            chosen: Ok(vec![
                OfChoice {
                    multipliers: vec![f64::NAN; layout.rows()],
                    reactions: nobody.clone(),
                    refused: None,
                };
                plan.choices.len()
            ]),
        };
        for (k, Link { places, rows }) in links.iter().enumerate() {
            // A component that has ended has no more rows.
            let Ok(own) = rows.recv() else { return None };
            assert!(
                time.is_none_or(|known| known == own.t),
                "rows of components at {time:?} and {} s",
                own.t
            );
            time = Some(own.t);
            work += own.work;
            found.extend(own.events.into_iter().map(|event| (k, event)));
            spread(&own.q, &places.coordinates, &mut q);
            spread(&own.v, &places.velocities, &mut v);
            let ((own, dropped), all) = (own.values, &mut values);
            without.extend(dropped.iter().map(|&i| places.rows[i]));
            gather(own.acceleration, &places.velocities, &mut all.acceleration);
            gather(own.multipliers, &places.rows, &mut all.multipliers);
            gather(own.reactions, &places.groups, &mut all.reactions);
            gather_chosen(own.chosen, places, &mut all.chosen);
        }
        found.sort_by(|(_, a), (_, b)| a.time.total_cmp(&b.time));
        let found = found.iter().map(|(k, event)| whole.event(*k, event));
        let events: Vec<Event> = found.collect();
        without.sort_unstable();
        let shown = row(&mut Sample {
            t: time?,
            dropped: &without,
            choices: &plan.choices,
            q: &q,
            v: &v,
            work,
            events: &events,
            source: Source::Several(&values),
        });
        match shown {
            Ok(ControlFlow::Continue(())) => {}
            Ok(ControlFlow::Break(())) => return None,
            Err(fault) => return Some(fault),
        }
    }
}

/// Copies values of all parts into the list of the whole mechanism. Returns the first failure.
fn gather<T: Copy>(
    own: Result<Vec<T>, MotionFault>,
    places: &[usize],
    whole: &mut Result<Vec<T>, MotionFault>,
) {
    match (own, &mut *whole) {
        (Ok(own), Ok(whole)) => spread(&own, places, whole),
        (Err(fault), Ok(_)) => *whole = Err(fault),
        (_, Err(_)) => {}
    }
}

/// Copies the multipliers and reactions for the choices of all parts into the lists of the whole
/// mechanism. A component without reactions has no such values.
fn gather_chosen(
    own: Result<Vec<OfChoice>, MotionFault>,
    places: &Places,
    whole: &mut Result<Vec<OfChoice>, MotionFault>,
) {
    match (own, &mut *whole) {
        (Ok(own), Ok(whole)) => {
            for (own, whole) in own.into_iter().zip(whole) {
                spread(&own.multipliers, &places.rows, &mut whole.multipliers);
                spread(&own.reactions, &places.groups, &mut whole.reactions);
                whole.refused = whole.refused.take().or(own.refused);
            }
        }
        (Err(fault), Ok(_)) => *whole = Err(fault),
        (_, Err(_)) => {}
    }
}

/// Copies values of a part to the indices of the part in the whole mechanism.
fn spread<T: Copy>(own: &[T], places: &[usize], whole: &mut [T]) {
    for (x, &place) in own.iter().zip(places) {
        whole[place] = *x;
    }
}

/// Returns the result for the whole mechanism, combined from the results of its components.
fn conclude(
    plan: &Plan<'_>,
    outcomes: Vec<RunResult>,
    stopped: Option<MotionError>,
    wall_seconds: f64,
) -> RunResult {
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
    let mut summary = Summary::of_components(components, &dropped, wall_seconds);
    summary.verdicts = verdicts(plan, &summary);
    match stopped.or(earliest.map(|(_, error)| error)) {
        Some(error) => Err(Box::new(Failure { error, summary })),
        None => Ok(summary),
    }
}

/// Returns the verdicts on the whole mechanism, combined from the verdicts on its components.
/// Returns `None` if a component has no verdicts.
fn verdicts(plan: &Plan<'_>, summary: &Summary) -> Option<Stretches> {
    let mechanism = &plan.prepared().mechanism;
    let mut whole = Stretches::unique(mechanism, [0.0, summary.t], &plan.groups);
    for (component, own) in plan.components.iter().zip(&summary.components) {
        let Some(found) = &own.summary.verdicts else {
            continue;
        };
        let shares = plan.groups.iter().enumerate();
        let shares: Vec<usize> = shares
            .filter_map(|(k, group)| component.share(group).map(|_| k))
            .collect();
        whole.take(found, &own.places.groups, &shares);
    }
    whole.sum_up(&plan.groups);
    let known = |c: &ComponentSummary| c.summary.verdicts.is_some();
    summary.components.iter().any(known).then_some(whole)
}
