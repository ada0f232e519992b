//! Ends of bounds that are reached.
//!
//! `PFAFF_CASES=60000 cargo test -p tests ends_of_two -- --nocapture` makes a longer run.

use model::{ConstraintId, Layout, System};
use pfaff::solvability::{BoundsError, Elasticity, Group, Term};
use tests::numbers::Numbers;

use super::equilibrium::{Loads, MASS};
use super::parts::{Kind, Part};
use super::{TABLE, assert_range, of, study};
use crate::tally::cases;

const SEED: u64 = 1_122_026;

const PARTS: usize = 3000;

/// Number of sums of two components, of each part.
const SUMS: usize = 4;

/// Number of random compliances in each of three ranges, of each part.
const SAMPLES: usize = 30;

/// One soft joint at a time reaches the ends if one component is undetermined.
#[test]
fn soft_joints_reach_the_ends_of_one_component() {
    let study = study(TABLE);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.bounds(solution, &Elasticity::default());
    // Tables on three legs, by hand: the loads of the four legs without one of them.
    let expected = [
        [-78.48, 0.0],
        [-73.575, 4.905],
        [-44.145, 34.335],
        [-78.48, 0.0],
    ];
    for (k, expected) in expected.into_iter().enumerate() {
        let bounds = of(&found, k, "Fz");
        assert_range(&bounds, expected, &format!("leg {k}"));
        assert_eq!(bounds.reached, [true; 2]);
        assert_eq!((bounds.at_lowest.len(), bounds.at_highest.len()), (1, 1));
        let most = found.largest_magnitudes(ConstraintId(k)).expect("bounds")[0];
        let expected = expected[0].abs().max(expected[1].abs());
        assert!((most.expect("a force") - expected).abs() < 1e-9);
    }
}

/// Powers of ten by which soft loads are softer than the others.
const POWERS: [f64; 5] = [2.0, 4.0, 8.0, 16.0, 32.0];

/// Largest distance of a reached end from a value of some compliances, relative to the width of the
/// bounds.
const REACHED: f64 = 1e-3;

/// Rounding error of the bounds, relative to the largest load of a part.
const ROUNDING: f64 = 1e-9;

/// Results for parts with two undetermined load components.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    /// Parts without bounds, because something is undecided.
    undecided: usize,
    /// Parts without finite reactions, because their configuration is singular.
    singular: usize,
    /// Ends that are marked as reached.
    reached: usize,
    /// Ends that are not marked as reached.
    outer: usize,
    /// Ends that are not marked, although some compliances come within [`REACHED`] of them.
    close: usize,
}

/// Parts with two undetermined load components, in the plane and in space. Each end that is marked
/// as reached is approached if the loads that give way there are soft, equally or one of them more
/// than the other, and all others have a compliance of 1. No compliances leave the bounds. Of the
/// ends of 60 000 parts, 2.2 % are not marked.
#[test]
#[expect(
    clippy::print_stdout,
    reason = "a longer run is read by a person, with --nocapture"
)]
fn ends_of_two_components_are_reached_or_not_marked() {
    let kinds = Kind::ALL.len();
    let each = cases(PARTS).div_ceil(kinds);
    let found: Vec<Counts> = std::thread::scope(|scope| {
        let of = |kind: usize| scope.spawn(move || of_kind(Kind::ALL[kind], each, kind as u64));
        let all: Vec<_> = (0..kinds).map(of).collect();
        all.into_iter()
            .map(|found| found.join().expect("no panic"))
            .collect()
    });
    let sum = |of: fn(&Counts) -> usize| -> usize { found.iter().map(of).sum() };
    let [undecided, singular] = [sum(|c| c.undecided), sum(|c| c.singular)];
    let [reached, outer, close] = [sum(|c| c.reached), sum(|c| c.outer), sum(|c| c.close)];
    for (kind, found) in Kind::ALL.iter().zip(&found) {
        println!("{kind:?}: {found:?}");
        assert!(
            found.reached > 10 * each && found.outer > 0,
            "{kind:?}: {found:?}"
        );
    }
    println!("undecided {undecided}, singular {singular}");
    println!("reached {reached}, not marked {outer}, of these close to some values {close}");
    let parts = each * kinds;
    assert!(200 * undecided < parts && 50 * singular < parts);
    let share = outer as f64 / (reached + outer) as f64;
    assert!(
        (0.015..0.03).contains(&share),
        "{share} of the ends are not marked"
    );
    assert!(10 * close < outer, "{close} of {outer} ends are close");
}

/// Examines parts of a kind, in turn in the plane and in space.
fn of_kind(kind: Kind, parts: usize, seed: u64) -> Counts {
    let mut numbers = Numbers::new(SEED + seed);
    let mut counts = Counts::default();
    for case in 0..parts {
        let (part, loads) = Part::draw(kind, case % 2 == 1, &mut numbers);
        examine(&part, &loads, &mut numbers, &mut counts);
    }
    counts
}

fn examine(part: &Part, loads: &Loads, numbers: &mut Numbers, counts: &mut Counts) {
    let text = part.scene();
    let study = study(&text);
    let start = study.analyse(0.0, None).expect("small");
    if !start.analysis.decision.is_decided() {
        counts.undecided += 1;
        return;
    }
    assert_eq!(start.analysis.decision.redundancy, 2, "{text}");
    let solution = start.solution().expect("decided");
    let found = start.bounds(solution, &Elasticity::default());
    let samples: Vec<Vec<f64>> = compliances(part, numbers)
        .iter()
        .map(|c| loads.shared(c))
        .collect();
    let size = 10.0 * MASS + tests::largest(samples.iter().flatten().copied());
    for (terms, form) in forms(part, start.mechanism.layout(), numbers) {
        let value = |loads: &[f64]| -> f64 { form.iter().zip(loads).map(|(a, b)| a * b).sum() };
        let bounds = match found.group(&Group::Combination(terms.clone())) {
            Ok(bounds) => bounds[0].1.clone(),
            Err(BoundsError::Undecided { .. } | BoundsError::Verdict) => {
                counts.undecided += 1;
                return;
            }
            Err(BoundsError::NoFinite(_)) => {
                counts.singular += 1;
                return;
            }
            Err(error) => panic!("{error}\n{text}"),
        };
        let slack = ROUNDING * size;
        let near = REACHED * (bounds.highest - bounds.lowest) + slack;
        let values: Vec<f64> = samples.iter().map(|loads| value(loads)).collect();
        for x in &values {
            let inside = bounds.lowest - slack..=bounds.highest + slack;
            assert!(
                inside.contains(x),
                "{terms:?} = {x} is outside of {bounds:?}\n{text}"
            );
        }
        if bounds.highest - bounds.lowest <= slack {
            continue;
        }
        let ends = [
            (bounds.lowest, &bounds.at_lowest),
            (bounds.highest, &bounds.at_highest),
        ];
        for ((end, soft), is_reached) in ends.into_iter().zip(bounds.reached) {
            if !is_reached {
                counts.outer += 1;
                counts.close += usize::from(values.iter().any(|x| (x - end).abs() < near));
                continue;
            }
            counts.reached += 1;
            let soft: Vec<usize> = soft.iter().map(|load| part.load_of(*load)).collect();
            let tried: Vec<f64> = graded(part.loads.len(), &soft)
                .iter()
                .map(|c| value(&loads.shared(c)))
                .collect();
            assert!(
                tried.iter().any(|x| (x - end).abs() < near),
                "{:?} {terms:?}: {end} is not reached with {soft:?}: {tried:?}, {bounds:?}\n{text}",
                part.kind
            );
        }
    }
}

/// Returns all components of reactions and some sums of two of them, with their coefficients of the
/// unit loads.
fn forms(part: &Part, layout: &Layout, numbers: &mut Numbers) -> Vec<(Vec<Term>, Vec<f64>)> {
    let mut forms = Vec::new();
    for reaction in layout.constraint_ids() {
        for name in layout.groups[reaction.0].component_names() {
            let term = Term {
                reaction,
                component: name.to_owned(),
                coefficient: 1.0,
            };
            forms.push((vec![term], part.component(reaction, name)));
        }
    }
    let count = forms.len();
    for _ in 0..SUMS {
        let [(a, of_a), (b, of_b)] = [0; 2].map(|_| forms[numbers.below(count)].clone());
        let coefficient = numbers.unit();
        let b = b.into_iter().map(|b| Term { coefficient, ..b });
        let sum = of_a.iter().zip(&of_b).map(|(a, b)| a + coefficient * b);
        forms.push((a.into_iter().chain(b).collect(), sum.collect()));
    }
    forms
}

/// Returns compliances in which these loads are soft, and the others have a compliance of 1.
fn graded(count: usize, soft: &[usize]) -> Vec<Vec<f64>> {
    let ratios: &[[f64; 2]] = match soft {
        [_] => &[[1.0, 1.0]],
        _ => &[[1.0, 1.0], [1.0, 0.5], [0.5, 1.0]],
    };
    let all = POWERS
        .iter()
        .flat_map(|power| ratios.iter().map(move |ratio| (power, ratio)));
    let of = |(power, ratio): (&f64, &[f64; 2])| {
        let mut c = vec![1.0; count];
        for (load, ratio) in soft.iter().zip(ratio) {
            c[*load] = 10_f64.powf(power * ratio);
        }
        c
    };
    all.map(of).collect()
}

/// Returns graded compliances for each load and each pair of loads, and random ones.
fn compliances(part: &Part, numbers: &mut Numbers) -> Vec<Vec<f64>> {
    let n = part.loads.len();
    let mut all: Vec<Vec<f64>> = (0..n).flat_map(|k| graded(n, &[k])).collect();
    all.extend((0..n).flat_map(|j| (0..j).flat_map(move |k| graded(n, &[j, k]))));
    for range in [1.0, 4.0, 12.0] {
        all.extend((0..SAMPLES).map(|_| {
            (0..n)
                .map(|_| 10_f64.powf(numbers.within(-range, range)))
                .collect()
        }));
    }
    all
}
