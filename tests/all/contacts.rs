//! Loads that contacts permit: supports that only push, ropes, and contacts that grip, compared
//! with closed forms and with vertices in rational arithmetic.

mod bounds;
mod fractions;
mod friction;
mod instants;
mod invariance;
mod oracle;
mod questions;
mod random;
mod supports;
mod unusual;

use model::{ConstraintId, System};
use pfaff::configuration::ConfigurationAnalysis;
use pfaff::prelude::*;
use pfaff::solvability::{
    Group, Impossible, PermittedError, PermittedRange, PermittedReactions, Term, lifted,
};

/// Accuracy of the forces, relative to the loads: rounding of the data and of a solution.
const FORCE: f64 = 1e-9;

fn study(text: &str) -> Study {
    Study::read(
        "contacts.toml",
        text,
        &Registry::standard(),
        &RunOptions::default(),
    )
    .unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn id_of(start: &ConfigurationAnalysis<'_>, name: &str) -> ConstraintId {
    start.reaction(name).unwrap_or_else(|e| panic!("{e}"))
}

fn name_of(start: &ConfigurationAnalysis<'_>, id: ConstraintId) -> String {
    start.mechanism.layout().groups[id.0].name.clone()
}

/// Returns the range of a sum of components, each written as `("A", "Fz", coefficient)`.
fn range(
    start: &ConfigurationAnalysis<'_>,
    found: &PermittedReactions<'_, '_>,
    terms: &[(&str, &str, f64)],
) -> Result<PermittedRange, PermittedError> {
    let term = |&(joint, component, coefficient): &(&str, &str, f64)| Term {
        reaction: id_of(start, joint),
        component: component.to_owned(),
        coefficient,
    };
    let group = Group::Combination(terms.iter().map(term).collect());
    let ranges = found.group(&group)?;
    Ok(ranges.into_iter().next().expect("one number").1)
}

/// The answers about the contacts of a scene at its start.
#[derive(Debug)]
struct Answers {
    /// The range of each component that was requested.
    ranges: Vec<PermittedRange>,
    impossible: Vec<Impossible>,
    /// The joints that open, with the accelerations of their gaps.
    lifts: Vec<(String, f64)>,
    accelerations: Vec<f64>,
}

/// Returns the answers about the contacts of a scene and some components.
fn answers(text: &str, components: &[(&str, &str)]) -> Answers {
    let study = study(text);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.permitted(solution).expect("clear");
    let found = found.expect("one-sided joints");
    let ranges = components.iter();
    let ranges = ranges.map(|&(joint, name)| range(&start, &found, &[(joint, name, 1.0)]));
    let ranges = ranges.map(|range| range.unwrap_or_else(|e| panic!("{e}\n{text}")));
    let ranges = ranges.collect();
    let impossible = found.impossible().expect("clear");
    let (mut lifts, mut accelerations) = (Vec::new(), Vec::new());
    if !impossible.is_empty() {
        let found = lifted(start.mechanism, (0.0, &start.state.q, &start.state.v))
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        let named = found
            .joints
            .iter()
            .map(|(id, a)| (name_of(&start, *id), *a));
        (lifts, accelerations) = (named.collect(), found.accelerations);
    }
    Answers {
        ranges,
        impossible,
        lifts,
        accelerations,
    }
}

/// Returns the values of both ends.
fn ends(range: &PermittedRange) -> [Option<f64>; 2] {
    match &range.ends {
        Some(ends) => ends.each_ref().map(|end| end.value()),
        None => [None; 2],
    }
}

fn near(found: f64, expected: f64, size: f64) -> bool {
    (found - expected).abs() <= FORCE * size
}

/// Compares the range of a force with the push on the other body; the reported reactions act on
/// the first body.
#[track_caller]
fn assert_push(range: &PermittedRange, expected: [f64; 2], size: f64) {
    let [Some(lowest), Some(highest)] = ends(range) else {
        panic!("{range:?}, expected the push {expected:?}");
    };
    let is_near = near(-highest, expected[0], size) && near(-lowest, expected[1], size);
    assert!(is_near, "{range:?}, expected the push {expected:?}");
}
