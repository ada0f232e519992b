//! Results of a run, and of a run with separate components.

use model::{ConstraintId, Places};

use super::energy;
use crate::error::MotionError;
use crate::events::{Event, ReactionImpulse};
use crate::options::Method;
use crate::solve::Misfit;
use solvability::Stretches;

/// Results of a run.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Summary {
    /// Last time reached (s).
    pub t: f64,
    /// Integration method, given or chosen. The value is `auto` if components have different
    /// methods.
    pub method: Method,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Number of evaluations of accelerations, including rejected steps, start, projections and
    /// output.
    pub evaluations: u64,
    /// Number of projections of steps.
    pub projections: u64,
    /// Number of quaternions that were scaled at accepted steps because their length was far from
    /// one.
    pub normalisations: u64,
    /// Number of factorisations of iteration matrices of implicit methods.
    pub factorisations: u64,
    /// Wall-clock time of the integration alone (s).
    pub wall_seconds: f64,
    /// Largest |Φ| at accepted steps and output rows.
    pub max_position_residual: f64,
    /// Largest |C·v − b| at accepted steps and output rows.
    pub max_velocity_residual: f64,
    /// Largest |E − E₀ − work of drives and applied forces| relative to the largest kinetic energy.
    /// For components that ran separately the value is an upper bound: the sum of their largest
    /// energy errors relative to the largest of their kinetic energies.
    pub energy_balance: f64,
    /// Largest |E − E₀ − work| (J).
    pub energy_gap: f64,
    /// Largest kinetic energy (J). For components that ran separately, it is the largest kinetic
    /// energy of any component.
    pub largest_kinetic_energy: f64,
    /// Smallest pivot ratio of the independent rows at the start and at accepted steps without
    /// generated code.
    pub min_pivot_ratio: f64,
    /// Largest violations, by row, of the rows that are redundant only within a stated tolerance.
    pub misfits: Vec<Misfit>,
    /// Events of the run.
    pub events: Vec<Event>,
    /// Verdicts on reactions and groups, by time intervals. `None` if no reactions were requested.
    pub verdicts: Option<Stretches>,
    /// The rows whose multipliers were zero by choice in output rows, and the time from which this
    /// choice was used. The list is empty if no reactions were requested.
    pub dropped: Vec<DroppedRows>,
    /// Components that ran separately. The list is empty if the mechanism was not split.
    pub components: Vec<ComponentSummary>,
}

/// Rows whose multipliers were zero by choice from some time on.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DroppedRows {
    /// Time of the first output row (s).
    pub from: f64,
    /// The rows, from 0, ascending.
    pub rows: Vec<usize>,
}

/// Results of a component that ran separately.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ComponentSummary {
    /// Names of the bodies of the component.
    pub name: String,
    /// Indices of the component in the whole mechanism.
    pub places: Places,
    /// Results of the component. Rows and degrees of redundancy refer to the component.
    pub summary: Summary,
}

impl DroppedRows {
    /// Creates the list of the constraint rows without multipliers, valid from time `from` (s). The
    /// constraint rows are counted from 0, in ascending order.
    #[must_use]
    pub fn new(from: f64, rows: Vec<usize>) -> Self {
        Self { from, rows }
    }

    /// Merges the lists of all components, with the rows renumbered as in the whole mechanism.
    pub(super) fn together(components: &[ComponentSummary]) -> Vec<Self> {
        let each = components.iter().map(|c| &c.summary.dropped);
        let mut times: Vec<f64> = each.flatten().map(|dropped| dropped.from).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let at = |from: f64| {
            let own = components.iter().flat_map(|c| {
                let begun = c.summary.dropped.partition_point(|d| d.from <= from);
                let last = begun.checked_sub(1).map(|k| &c.summary.dropped[k].rows);
                last.map_or_else(Vec::new, |rows| of_whole(&c.places.rows, rows))
            });
            let mut rows: Vec<usize> = own.collect();
            rows.sort_unstable();
            Self { from, rows }
        };
        times.into_iter().map(at).collect()
    }
}

/// A run that stopped early, with the results up to the stop.
#[derive(Debug, thiserror::Error)]
#[error("{error}")]
#[non_exhaustive]
pub struct Failure {
    /// Reason why the run stopped.
    pub error: MotionError,
    /// Results up to the stop.
    pub summary: Summary,
}

impl Summary {
    /// Returns the results for the whole mechanism: sums of work, the largest residuals, and all
    /// events in the order of time. The time reached is the smallest time of the components.
    /// `dropped` contains the redundant rows of each component at the start, with the numbers of
    /// the component.
    pub(super) fn of_components(
        components: Vec<ComponentSummary>,
        dropped: &[&[usize]],
        wall_seconds: f64,
    ) -> Self {
        let all = || components.iter().map(|c| &c.summary);
        let sum = |count: fn(&Self) -> u64| all().map(count).sum();
        let largest = |x: fn(&Self) -> f64| all().map(x).fold(0.0, energy::larger);
        let smallest = |x: fn(&Self) -> f64| all().map(x).fold(f64::INFINITY, f64::min);
        let method = all().next().map_or(Method::Auto, |s| s.method);
        let same = all().all(|s| s.method == method);
        let gap = all().map(|s| s.energy_gap).sum();
        let kinetic = largest(|s| s.largest_kinetic_energy);
        Self {
            t: smallest(|s| s.t),
            method: if same { method } else { Method::Auto },
            steps: sum(|s| s.steps),
            rejected: sum(|s| s.rejected),
            evaluations: sum(|s| s.evaluations),
            projections: sum(|s| s.projections),
            normalisations: sum(|s| s.normalisations),
            factorisations: sum(|s| s.factorisations),
            wall_seconds,
            max_position_residual: largest(|s| s.max_position_residual),
            max_velocity_residual: largest(|s| s.max_velocity_residual),
            energy_balance: energy::relative(gap, kinetic),
            energy_gap: gap,
            largest_kinetic_energy: kinetic,
            min_pivot_ratio: smallest(|s| s.min_pivot_ratio),
            misfits: misfits(&components),
            events: events(&components, dropped),
            verdicts: None,
            dropped: DroppedRows::together(&components),
            components,
        }
    }
}

/// Returns the constraint violations of components as rows of the whole mechanism.
fn misfits(components: &[ComponentSummary]) -> Vec<Misfit> {
    let of_component = |c: &ComponentSummary| {
        let places = c.places.rows.clone();
        let own = c.summary.misfits.clone().into_iter();
        own.map(move |m| Misfit {
            row: places[m.row],
            ..m
        })
    };
    let mut all: Vec<Misfit> = components.iter().flat_map(of_component).collect();
    all.sort_by_key(|m| m.row);
    all
}

/// Returns the events of components in the order of time, as events of the whole mechanism.
fn events(components: &[ComponentSummary], dropped: &[&[usize]]) -> Vec<Event> {
    let places = components.iter().map(|c| &c.places);
    let mut whole = WholeEvents::new(places.zip(dropped.iter().copied()));
    let mut all: Vec<(usize, &Event)> = components
        .iter()
        .enumerate()
        .flat_map(|(k, c)| c.summary.events.iter().map(move |e| (k, e)))
        .collect();
    all.sort_by(|(_, a), (_, b)| a.time.total_cmp(&b.time));
    all.into_iter()
        .map(|(k, event)| whole.event(k, event))
        .collect()
}

/// Events of components with the rows and the degree of redundancy of the whole mechanism, in the
/// order in which they are given.
pub(super) struct WholeEvents<'p> {
    /// Joints and rows of each component in the whole mechanism.
    places: Vec<&'p Places>,
    /// Redundant rows of each component, numbered in the whole mechanism.
    now: Vec<Vec<usize>>,
}

impl<'p> WholeEvents<'p> {
    /// Creates the list from components with their indices, and from their redundant rows at the
    /// start.
    pub(super) fn new<'d>(components: impl Iterator<Item = (&'p Places, &'d [usize])>) -> Self {
        let (places, now) = components
            .map(|(places, dropped)| (places, of_whole(&places.rows, dropped)))
            .unzip();
        Self { places, now }
    }

    /// Returns the next event, which is an event of component `k`.
    pub(super) fn event(&mut self, k: usize, event: &Event) -> Event {
        self.now[k] = of_whole(&self.places[k].rows, &event.dropped);
        let mut dropped = self.now.concat();
        dropped.sort_unstable();
        let others = dropped.len() - event.dropped.len();
        let groups = &self.places[k].groups;
        let impulses = event.impulses.iter().map(|impulse| ReactionImpulse {
            id: ConstraintId(groups[impulse.id.0]),
            components: impulse.components.clone(),
        });
        Event {
            redundancy_before: event.redundancy_before + others,
            redundancy_after: event.redundancy_after + others,
            dropped,
            impulses: impulses.collect(),
            ..event.clone()
        }
    }
}

/// Returns the rows of a component with the numbers of the whole mechanism.
fn of_whole(places: &[usize], rows: &[usize]) -> Vec<usize> {
    rows.iter().map(|&i| places[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::events::EventKind;

    fn event(time: f64, before: usize, dropped: &[usize]) -> Event {
        Event {
            time,
            kind: EventKind::RowsExchanged,
            redundancy_before: before,
            redundancy_after: dropped.len(),
            dropped: dropped.to_vec(),
            text: String::new(),
            impulses: Vec::new(),
        }
    }

    fn component(rows: &[usize], t: f64, events: Vec<Event>) -> ComponentSummary {
        ComponentSummary {
            name: String::new(),
            places: Places {
                rows: rows.to_vec(),
                ..Places::default()
            },
            summary: Summary {
                t,
                steps: 10,
                energy_gap: 0.25,
                largest_kinetic_energy: t,
                events,
                ..Summary::default()
            },
        }
    }

    #[test]
    fn events_of_components_are_told_with_the_rows_of_the_whole() {
        // One component has the rows 0, 2, 4, of which row 2 is redundant at the start. The other
        // component has the rows 1, 3, of which row 1 is redundant at the start.
        let components = vec![
            component(
                &[0, 2, 4],
                2.0,
                vec![event(0.5, 1, &[0]), event(1.5, 1, &[2])],
            ),
            component(&[1, 3], 1.0, vec![event(1.0, 1, &[1])]),
        ];
        let whole = Summary::of_components(components, &[&[1], &[0]], 0.125);
        let told: Vec<(f64, &[usize])> = whole
            .events
            .iter()
            .map(|e| (e.time, e.dropped.as_slice()))
            .collect();
        assert_eq!(told, [(0.5, &[0, 1][..]), (1.0, &[0, 3]), (1.5, &[3, 4])]);
        let redundancy = |e: &Event| [e.redundancy_before, e.redundancy_after];
        assert!(whole.events.iter().all(|e| redundancy(e) == [2, 2]));
        // The time reached is the time of the slower component. The energy balance is a bound.
        assert_eq!((whole.t, whole.steps), (1.0, 20));
        assert_eq!(whole.energy_balance, (0.25 + 0.25) / 2.0);
    }
}
