//! Bounds of any compliances: closed forms, and elastic supports of many compliances.

use model::{ConstraintId, System};
use pfaff::solvability::{BoundsError, Choice, Compliance, ElasticBounds, Elasticity, Group, Term};
use tests::numbers::Numbers;

use super::{CLAMPED, assert_range, of, random, rigid, study};

/// A rigid beam has n supports at equal distances and a unit load at 0.3 of its length. On two
/// supports a < b it is statically determinate: the load on a is (b − 0.3)/(b − a). The sets are
/// the pairs of supports.
#[test]
fn a_beam_rests_on_any_two_of_its_supports() {
    for (n, sets, first) in [
        (3, 3, [0.0, 0.7]),
        (5, 10, [-0.2, 0.7]),
        (8, 28, [-1.1, 0.7]),
    ] {
        let supports: Vec<String> = (0..n)
            .map(|k| {
                let x = k as f64 / (n - 1) as f64;
                format!(
                    "{{ name = \"s{k}\", type = \"point-on-line\", body = \"beam\", at = [{x}, 0.0], line = [[-1.0, 0.0], [2.0, 0.0]] }},"
                )
            })
            .collect();
        let text = format!(
            "scene = {{ name = \"beam\", space = \"plane\", gravity = [0.0, -1.0] }}\n\
             body = [{{ name = \"beam\", mass = 1.0, inertia = 1.0, position = [0.3, 0.0] }}]\njoint = [\n{}\n]",
            supports.join("\n")
        );
        let study = study(&text);
        let start = study.analyse(0.0, None).expect("small");
        let solution = start.solution().expect("decided");
        let found = start.bounds(solution, &Elasticity::default());
        // The reaction on the beam is the push.
        let of_first = of(&found, 0, "Fy");
        assert_eq!(found.sets(), sets, "{n}");
        assert_range(&of_first, first, &format!("{n} supports"));
        assert_eq!(of_first.reached, [true; 2]);
        // Closed form for every support, by all pairs.
        for k in 0..n {
            let at = |k: usize| k as f64 / (n - 1) as f64;
            let push = |a: usize, b: usize| match k {
                _ if k == a => (at(b) - 0.3) / (at(b) - at(a)),
                _ if k == b => (0.3 - at(a)) / (at(b) - at(a)),
                _ => 0.0,
            };
            let pairs = (0..n).flat_map(|b| (0..b).map(move |a| push(a, b)));
            let all: Vec<f64> = pairs.collect();
            let ends = [
                all.iter().copied().fold(f64::INFINITY, f64::min),
                all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ];
            assert_range(&of(&found, k, "Fy"), ends, &format!("support {k} of {n}"));
        }
    }
}

/// A bar of 1 m is clamped at the left and on a roller at the right, with a unit load at a quarter.
/// With the push R of the roller, the clamp has the force 1 − R and the moment 1/4 − R. R is 0 if
/// the roller gives way, 1 if the force of the clamp gives way, and 1/4 if its moment gives way.
#[test]
fn a_clamped_bar_has_three_soft_loads() {
    let study = study(CLAMPED);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.bounds(solution, &Elasticity::default());
    let ids = ["clamp", "roller"].map(|name| start.reaction(name).expect("known").0);
    assert_range(&of(&found, ids[1], "Fy"), [0.0, 1.0], "roller");
    assert_range(&of(&found, ids[0], "Fy"), [0.0, 1.0], "clamp");
    assert_range(&of(&found, ids[0], "T"), [-0.75, 0.25], "moment");
    // With a rigid clamp only the roller gives way.
    let stiff = start.bounds(solution, &rigid([ConstraintId(ids[0])]));
    assert_range(&of(&stiff, ids[1], "Fy"), [0.0, 0.0], "roller alone");
    // Two rigid joints leave one component undetermined.
    let both = start.bounds(solution, &rigid(ids.map(ConstraintId)));
    let term = Group::WrenchSum(vec![(1.0, ConstraintId(ids[1]))]);
    let refused = both.group(&term).expect_err("no joint gives way");
    assert!(
        refused.to_string().contains("one load component"),
        "{refused}"
    );
}

/// Elastic supports with any compliances, equal in all directions, stay within the bounds. The
/// values are computed by least squares, without the sets of the bounds.
#[test]
fn elastic_supports_stay_within_the_bounds() {
    let found = std::thread::scope(|scope| {
        let each = [0, 1, 2, 3].map(|quarter| scope.spawn(move || stay_within(quarter)));
        each.map(|found| found.join().expect("no panic"))
    });
    let sum = |of: fn(&[f64; 3]) -> f64| -> f64 { found.iter().map(of).sum() };
    assert!(sum(|found| found[0]) > 1e6, "{found:?}");
    assert!(sum(|found| found[1]) <= 8.0, "{found:?}");
    assert!(found.iter().all(|found| found[2] > 1.0), "{found:?}");
}

/// Examines 125 mechanisms, and returns the number of compared values, the number of mechanisms
/// without bounds, and the width of the widest bounds.
fn stay_within(quarter: u64) -> [f64; 3] {
    let mut numbers = Numbers::new(29_112_026 + quarter);
    let (mut compared, mut refused, mut widest) = (0.0, 0.0, 0.0_f64);
    for case in 0..125 {
        let text = random(&mut numbers, case % 2 == 0);
        let study = study(&text);
        let start = study.analyse(0.0, None).expect("small");
        if start.analysis.decision.redundancy == 0 || !start.analysis.decision.is_decided() {
            continue;
        }
        let solution = start.solution().expect("decided");
        let found = start.bounds(solution, &Elasticity::default());
        let layout = start.mechanism.layout();
        let names = |k: usize| layout.groups[k].component_names();
        let known: Result<Vec<Vec<ElasticBounds>>, BoundsError> = (0..layout.groups.len())
            .map(|k| {
                let term = |name: &str| {
                    let reaction = ConstraintId(k);
                    let component = name.to_owned();
                    Term {
                        reaction,
                        component,
                        coefficient: 1.0,
                    }
                };
                let of = |name| found.group(&Group::Combination(vec![term(name)]));
                names(k)
                    .map(|name| Ok::<_, BoundsError>(of(name)?[0].1.clone()))
                    .collect()
            })
            .collect();
        let Ok(known) = known else {
            refused += 1.0;
            continue;
        };
        for _ in 0..200 {
            let mut soft = || 10_f64.powf(numbers.within(-12.0, -4.0));
            let joints = (0..layout.groups.len()).map(|k| Compliance {
                reaction: ConstraintId(k),
                along: [soft(); 3],
                rotation: soft(),
            });
            let choice = Choice::Compliance(joints.collect::<Vec<_>>().into());
            let chosen = start.distribution(&choice).expect("all joints give way");
            for (reaction, bounds) in chosen.reactions.iter().zip(&known) {
                for ((name, value), bounds) in reaction.components.iter().zip(bounds) {
                    let value = value.in_solution().expect("a number");
                    let slack = 1e-6 * (1.0 + bounds.highest - bounds.lowest + value.abs());
                    assert!(
                        (bounds.lowest - slack..=bounds.highest + slack).contains(&value),
                        "{}.{name} = {value} is outside of {bounds:?}\n{text}",
                        reaction.name
                    );
                    widest = widest.max(bounds.highest - bounds.lowest);
                    compared += 1.0;
                }
            }
        }
    }
    [compared, refused, widest]
}
