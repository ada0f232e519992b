//! Bounds of reactions for joints of any stiffness, compared with closed forms and with elastic
//! supports of many compliances, which are computed by least squares.

use model::{ConstraintId, System};
use pfaff::prelude::*;
use pfaff::solvability::{
    BoundsError, Choice, Compliance, ComplianceRange, ElasticBounds, ElasticLoad, ElasticSupports,
    Elasticity, Group, Misfit, NominalCompliance, ReactionBounds, Term,
};
use tests::numbers::Numbers;

fn study(text: &str) -> Study {
    let options = RunOptions {
        t_end: Some(1.0),
        ..RunOptions::default()
    };
    Study::read("bounds.toml", text, &Registry::standard(), &options)
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Returns the bounds of a component.
fn of(found: &ReactionBounds<'_, '_>, id: usize, name: &str) -> ElasticBounds {
    let term = Term {
        reaction: ConstraintId(id),
        component: name.to_owned(),
        coefficient: 1.0,
    };
    let numbers = found
        .group(&Group::Combination(vec![term]))
        .expect("bounds");
    numbers[0].1.clone()
}

/// The joints that do not give way.
fn rigid(ids: impl Into<Vec<ConstraintId>>) -> Elasticity {
    Elasticity {
        rigid: ids.into(),
        ..Elasticity::default()
    }
}

/// Compliances between nominal ones and a multiple of them.
fn within(factor: f64, nominal: Option<Vec<NominalCompliance>>) -> Elasticity {
    Elasticity {
        within: Some(ComplianceRange { factor, nominal }),
        ..Elasticity::default()
    }
}

fn assert_range(found: &ElasticBounds, expected: [f64; 2], what: &str) {
    let size = 1e-9 * (1.0 + expected[0].abs().max(expected[1].abs()));
    for (found, expected) in [found.lowest, found.highest].into_iter().zip(expected) {
        assert!(
            (found - expected).abs() < size,
            "{what}: {found} {expected}"
        );
    }
}

/// A bar of 1 m, clamped at the left, on a roller at the right.
const CLAMPED: &str = r#"scene = { name = "bar", space = "plane", gravity = [0.0, -1.0] }
        body = [{ name = "bar", mass = 1.0, inertia = 1.0, position = [0.25, 0.0] }]
        joint = [
            { name = "clamp", type = "fixed", bodies = ["bar", "ground"], at = [0.0, 0.0] },
            { name = "roller", type = "point-on-line", body = "bar", at = [1.0, 0.0], line = [[0.0, 0.0], [1.0, 0.0]] },
        ]"#;

/// A table on four legs whose mass centre is not at the middle.
const TABLE: &str = r#"scene = { name = "table", space = "spatial", gravity = [0.0, 0.0, -9.81] }
        body = [{ name = "top", mass = 12.0, inertia = [1.0, 1.0, 2.0], position = [0.2, 0.1, 0.0] }]
        joint = [
            { name = "A", type = "point-on-plane", bodies = ["ground", "top"], at = [0.6, 0.4, 0.0], normal = [0, 0, 1] },
            { name = "B", type = "point-on-plane", bodies = ["ground", "top"], at = [-0.6, 0.4, 0.0], normal = [0, 0, 1] },
            { name = "C", type = "point-on-plane", bodies = ["ground", "top"], at = [-0.6, -0.4, 0.0], normal = [0, 0, 1] },
            { name = "D", type = "point-on-plane", bodies = ["ground", "top"], at = [0.6, -0.4, 0.0], normal = [0, 0, 1] },
        ]"#;

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
        let found = start.bounds(&solution, &Elasticity::default());
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
    let found = start.bounds(&solution, &Elasticity::default());
    let ids = ["clamp", "roller"].map(|name| start.reaction(name).expect("known").0);
    assert_range(&of(&found, ids[1], "Fy"), [0.0, 1.0], "roller");
    assert_range(&of(&found, ids[0], "Fy"), [0.0, 1.0], "clamp");
    assert_range(&of(&found, ids[0], "T"), [-0.75, 0.25], "moment");
    // With a rigid clamp only the roller gives way.
    let stiff = start.bounds(&solution, &rigid([ConstraintId(ids[0])]));
    assert_range(&of(&stiff, ids[1], "Fy"), [0.0, 0.0], "roller alone");
    // Two rigid joints leave one component undetermined.
    let both = start.bounds(&solution, &rigid(ids.map(ConstraintId)));
    let term = Group::WrenchSum(vec![(1.0, ConstraintId(ids[1]))]);
    let refused = both.group(&term).expect_err("no joint gives way");
    assert!(
        refused.to_string().contains("one load component"),
        "{refused}"
    );
}

/// A body on random joints in the plane or in space.
fn random(numbers: &mut Numbers, in_space: bool) -> String {
    let mut joints = String::new();
    let point = |numbers: &mut Numbers| {
        let n = if in_space { 3 } else { 2 };
        let all: Vec<String> = (0..n).map(|_| format!("{:.3}", numbers.unit())).collect();
        format!("[{}]", all.join(", "))
    };
    let kinds: &[&str] = if in_space {
        &[
            "spherical",
            "spherical",
            "revolute",
            "fixed",
            "point-on-plane",
        ]
    } else {
        &["revolute", "revolute", "fixed", "point-on-line"]
    };
    // Joints in a line or on the same point are the degenerate cases.
    let line = numbers.once_in(4);
    let count = if in_space { 3 } else { 4 };
    for k in 0..count + numbers.below(2) {
        let kind = kinds[numbers.below(kinds.len())];
        let at = if line {
            let x = k as f64 - 1.0;
            if in_space {
                format!("[{x}, 0.0, 0.5]")
            } else {
                format!("[{x}, 0.5]")
            }
        } else {
            point(numbers)
        };
        let more = match kind {
            "revolute" if in_space => ", axis = [1.0, 0.0, 0.0]".to_owned(),
            "point-on-plane" => ", normal = [0.0, 0.0, 1.0]".to_owned(),
            "point-on-line" => format!(", line = [{at}, [2.0, {:.3}]]", numbers.unit()),
            _ => String::new(),
        };
        let of = match kind {
            "point-on-line" => "body = \"lid\"",
            _ => "bodies = [\"lid\", \"ground\"]",
        };
        joints.push_str(&format!(
            "{{ name = \"j{k}\", type = \"{kind}\", {of}, at = {at}{more} }},\n"
        ));
    }
    let (space, gravity, inertia) = if in_space {
        (
            "spatial",
            format!("[{:.3}, 1.0, -9.81]", numbers.unit()),
            "[1.0, 2.0, 1.5]",
        )
    } else {
        ("plane", format!("[{:.3}, -9.81]", numbers.unit()), "1.0")
    };
    format!(
        "scene = {{ name = \"lid\", space = \"{space}\", gravity = {gravity} }}\n\
         body = [{{ name = \"lid\", mass = 2.0, inertia = {inertia}, position = {} }}]\njoint = [\n{joints}]",
        point(numbers)
    )
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
        let found = start.bounds(&solution, &Elasticity::default());
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

/// Compliances within a factor of nominal ones stay within narrower bounds. An end that is reached
/// is the value with the soft loads at the factor and the others at their nominal compliances.
#[test]
fn bounds_within_a_factor_are_those_of_corners() {
    let mut numbers = Numbers::new(30_112_026);
    let (mut compared, mut reached, mut outer, mut one) = (0, 0, 0, 0);
    for case in 0..120 {
        let text = random(&mut numbers, case % 2 == 0);
        let study = study(&text);
        let start = study.analyse(0.0, None).expect("small");
        if start.analysis.decision.redundancy == 0 || !start.analysis.decision.is_decided() {
            continue;
        }
        let solution = start.solution().expect("decided");
        let layout = start.mechanism.layout();
        let factor = [1.0, 1.3, 4.0, 100.0][case % 4];
        let mut soft = || 10_f64.powf(numbers.within(-7.0, -5.0));
        let nominal = |reaction| NominalCompliance {
            reaction,
            force: soft(),
            moment: soft(),
        };
        let nominal: Vec<NominalCompliance> = layout.constraint_ids().map(nominal).collect();
        let found = start.bounds(&solution, &within(factor, Some(nominal.clone())));
        let wide = start.bounds(&solution, &Elasticity::default());
        let compliances = |of: &dyn Fn(ElasticLoad) -> f64| {
            let joints = nominal.iter().map(|c| {
                let load = |is_moment| ElasticLoad {
                    reaction: c.reaction,
                    is_moment,
                };
                // The moment of a joint without force, and the load of a drive, are single loads.
                let own = layout.groups[c.reaction.0].own_load();
                let moment = own.is_none();
                Compliance {
                    reaction: c.reaction,
                    along: [c.force * of(load(false)); 3],
                    rotation: c.moment * of(load(moment)),
                }
            });
            let choice = Choice::Compliance(joints.collect::<Vec<_>>().into());
            start.distribution(&choice).expect("all joints give way")
        };
        let values = |of: &dyn Fn(ElasticLoad) -> f64, k: usize, name: &str| {
            let chosen = compliances(of);
            let mut components = chosen.reactions[k].components.iter();
            let found = components.find(|(known, _)| *known == name);
            let value = found.expect("a component").1.in_solution();
            value.expect("a number")
        };
        for k in 0..layout.groups.len() {
            for name in layout.groups[k].component_names() {
                let term = Term {
                    reaction: ConstraintId(k),
                    component: name.to_owned(),
                    coefficient: 1.0,
                };
                let group = Group::Combination(vec![term]);
                let (Ok(own), Ok(all)) = (found.group(&group), wide.group(&group)) else {
                    continue;
                };
                let (own, all) = (&own[0].1, &all[0].1);
                let size = 1e-6
                    * (all.highest - all.lowest)
                        .max(1e-3 * all.highest.abs())
                        .max(1e-9);
                assert!(own.lowest >= all.lowest - size && own.highest <= all.highest + size);
                let power = numbers.within(0.0, 1.0);
                let random = |load: ElasticLoad| {
                    let turn = (load.reaction.0 as f64 * 1.7 + f64::from(load.is_moment)).sin();
                    factor.powf((power + turn.abs()) % 1.0)
                };
                let value = values(&random, k, name);
                assert!(
                    (own.lowest - size..=own.highest + size).contains(&value),
                    "{name} of {k} = {value} is outside of {own:?} for {factor}\n{text}"
                );
                compared += 1;
                one += usize::from(factor == 1.0);
                if factor == 1.0 {
                    assert!((own.highest - own.lowest).abs() < size, "{own:?}");
                }
                let ends = [(own.lowest, &own.at_lowest), (own.highest, &own.at_highest)];
                for ((end, soft), is_reached) in ends.into_iter().zip(own.reached) {
                    if !is_reached {
                        outer += 1;
                        continue;
                    }
                    let corner = |load| if soft.contains(&load) { factor } else { 1.0 };
                    let value = values(&corner, k, name);
                    assert!(
                        (value - end).abs() < size,
                        "{name} of {k} = {value} is not {end}: {own:?} for {factor}\n{text}"
                    );
                    reached += 1;
                }
            }
        }
    }
    assert!(compared > 500 && one > 50, "{compared} {one}");
    assert!(reached > 300 && outer > 50, "{reached} {outer}");
}

/// Without nominal compliances, a force and a moment cannot be compared.
#[test]
fn forces_and_moments_need_nominal_compliances() {
    let study = study(CLAMPED);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let group = Group::WrenchSum(vec![(1.0, ConstraintId(1))]);
    let found = start.bounds(&solution, &within(2.0, None));
    let refused = found.group(&group).expect_err("a force and a moment");
    assert!(matches!(refused, BoundsError::Mixed { .. }), "{refused}");
    let found = start.bounds(&solution, &within(2.0, Some(Vec::new())));
    let refused = found.group(&group).expect_err("no joint gives way");
    assert!(
        refused.to_string().contains("one load component"),
        "{refused}"
    );
    // Push of the roller: y = (c_F + c_T/4)/(c_R + c_F + c_T).
    let nominal = |k: usize, force: f64, moment: f64| NominalCompliance {
        reaction: ConstraintId(k),
        force,
        moment,
    };
    let nominal = vec![nominal(0, 1.0, 2.0), nominal(1, 3.0, 0.0)];
    let found = start.bounds(&solution, &within(2.0, Some(nominal)));
    let [lowest, highest] = [
        (1.0 + 2.0 / 4.0) / (6.0 + 1.0 + 2.0),
        (2.0 + 2.0 / 4.0) / (3.0 + 2.0 + 2.0),
    ];
    assert_range(&of(&found, 1, "Fy"), [lowest, highest], "roller");
}

/// The legs of a table have compliances within a factor of each other, and laws of Hertz with play.
/// With the loads f₀ of three legs and the self-stress z = (1, −1, 1, −1), the loads are f₀ + y·z
/// with `Σ z·δ(f₀ + y·z) = 0`.
#[test]
fn a_table_on_similar_legs() {
    let study = study(TABLE);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let (z, f_0) = ([1.0, -1.0, 1.0, -1.0], [-34.335, -39.24, 0.0, -44.145]);
    for factor in [1.2_f64, 2.0] {
        let found = start.bounds(&solution, &within(factor, None));
        let corners = (0..16).map(|corner: usize| {
            let c: Vec<f64> = (0..4)
                .map(|k| if corner >> k & 1 == 1 { factor } else { 1.0 })
                .collect();
            let sum: f64 = (0..4).map(|k| c[k] * z[k] * f_0[k]).sum();
            f_0[0] - sum / c.iter().sum::<f64>()
        });
        let corners: Vec<f64> = corners.collect();
        let ends = [
            corners.iter().copied().fold(f64::INFINITY, f64::min),
            corners.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ];
        assert_range(&of(&found, 0, "Fz"), ends, "similar legs");
        let published = if factor == 2.0 {
            [-56.4, -36.8]
        } else {
            [-49.3, -43.9]
        };
        for (end, published) in ends.into_iter().zip(published) {
            assert!((end - published).abs() < 0.06, "{ends:?}");
        }
    }
    let found = start.bounds(&solution, &Elasticity::default());
    let mut numbers = Numbers::new(5);
    for _ in 0..200 {
        let laws: Vec<[f64; 3]> = (0..4)
            .map(|_| {
                let power = |numbers: &mut Numbers, a, b| 10_f64.powf(numbers.within(a, b));
                let stiff = power(&mut numbers, -9.0, -4.0);
                let exponent = power(&mut numbers, -1.0, 0.5);
                [stiff, exponent, power(&mut numbers, -9.0, -4.0)]
            })
            .collect();
        let gap = |y: f64| -> f64 {
            let each = laws.iter().enumerate().map(|(k, [stiff, exponent, play])| {
                let f = f_0[k] + y * z[k];
                z[k] * f.signum() * (stiff * f.abs().powf(*exponent) + play)
            });
            each.sum()
        };
        // The sum increases with y.
        let [mut low, mut high] = [-1e3, 1e3];
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if gap(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        for k in 0..4 {
            let (bounds, load) = (of(&found, k, "Fz"), f_0[k] + 0.5 * (low + high) * z[k]);
            let inside = bounds.lowest - 1e-9..=bounds.highest + 1e-9;
            assert!(inside.contains(&load), "{load} {bounds:?} {laws:?}");
        }
    }
}

/// A leg that is too long by h takes more load; with legs of equal compliance c the self-stress is
/// h/(4·c). Such a preload is not in the bounds.
#[test]
fn a_leg_that_is_too_long_leaves_the_bounds() {
    let study = study(TABLE);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.bounds(&solution, &Elasticity::default());
    let (compliance, h) = (1e-6, 1e-3);
    let supports = |h: f64| ElasticSupports {
        compliances: (0..4)
            .map(|k| Compliance {
                reaction: ConstraintId(k),
                along: [compliance; 3],
                rotation: 0.0,
            })
            .collect(),
        misfits: vec![Misfit {
            reaction: ConstraintId(2),
            // The second body is the table: its point is too low by h.
            along: [0.0, 0.0, -h],
            rotation: [0.0; 3],
        }],
        ..ElasticSupports::default()
    };
    let loads = |h: f64| -> Vec<f64> {
        let choice = Choice::Compliance(supports(h));
        let chosen = start.distribution(&choice).expect("all legs give way");
        let of = |k: usize| {
            let mut components = chosen.reactions[k].components.iter();
            let fz = components.find(|(name, _)| *name == "Fz").expect("a force");
            fz.1.in_solution().expect("a number")
        };
        (0..4).map(of).collect()
    };
    let (fits, long) = (loads(0.0), loads(h));
    // The reaction is the force on the ground: a longer leg presses more on it.
    let change = -h / (4.0 * compliance);
    for (k, z) in [1.0, -1.0, 1.0, -1.0].into_iter().enumerate() {
        assert!((long[k] - fits[k] - change * z).abs() < 1e-9 * change.abs());
        let bounds = of(&found, k, "Fz");
        assert!((bounds.lowest..=bounds.highest).contains(&fits[k]));
        assert!(!(bounds.lowest..=bounds.highest).contains(&long[k]));
    }
}

/// Wheels slip, so a misfit of the trolley causes no lasting load in a circuit with them.
#[test]
fn a_misfit_that_loads_wheels_is_refused() {
    let study = study(
        r#"scene = { name = "cart", space = "plane" }
        body = [{ name = "cart", mass = 10.0, inertia = 1.0 }]
        joint = [
            { name = "left", type = "knife-edge", body = "cart", at = [0.0, 0.5], normal = [0.0, 1.0] },
            { name = "right", type = "knife-edge", body = "cart", at = [0.0, -0.5], normal = [0.0, 1.0] },
        ]"#,
    );
    let start = study.analyse(0.0, None).expect("small");
    let supports = |along: [f64; 3]| {
        let compliance = |k| Compliance {
            reaction: ConstraintId(k),
            along: [1e-6; 3],
            rotation: 0.0,
        };
        Choice::Compliance(ElasticSupports {
            compliances: vec![compliance(0), compliance(1)],
            misfits: vec![Misfit {
                reaction: ConstraintId(0),
                along,
                rotation: [0.0; 3],
            }],
            ..ElasticSupports::default()
        })
    };
    let refused = start.distribution(&supports([0.0, 1e-3, 0.0]));
    let refused = refused.expect_err("wheels slip").to_string();
    assert!(
        refused.contains("the misfit of `left` loads `left`"),
        "{refused}"
    );
    assert!(start.distribution(&supports([1e-3, 0.0, 0.0])).is_ok());
    let refused = start.distribution(&supports([0.0, f64::NAN, 0.0]));
    assert!(refused.expect_err("no number").to_string().contains("NaN"));
}

/// One soft joint at a time reaches the ends if one component is undetermined.
#[test]
fn soft_joints_reach_the_ends_of_one_component() {
    let study = study(TABLE);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.bounds(&solution, &Elasticity::default());
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

/// Bounds belong to the mechanism: not to the axes of the scene, nor to the order of joints.
#[test]
fn bounds_do_not_depend_on_the_axes_of_the_scene() {
    let lid = |angle: f64, order: [usize; 4]| {
        let (c, s) = (angle.cos(), angle.sin());
        let at = |x: f64, y: f64| format!("[{:?}, {:?}]", c * x - s * y, s * x + c * y);
        let places = [[0.0, 0.0], [1.0, 0.3], [0.4, 1.0], [-0.7, 0.2]];
        let joints: Vec<String> = order
            .iter()
            .map(|&k| {
                let at = at(places[k][0], places[k][1]);
                format!("{{ name = \"j{k}\", type = \"revolute\", bodies = [\"lid\", \"ground\"], at = {at} }},")
            })
            .collect();
        format!(
            "scene = {{ name = \"lid\", space = \"plane\", gravity = {} }}\n\
             body = [{{ name = \"lid\", mass = 2.0, inertia = 1.0, position = {} }}]\njoint = [\n{}\n]",
            at(3.0, -9.81),
            at(0.3, 0.4),
            joints.join("\n")
        )
    };
    let magnitudes = |angle: f64, order: [usize; 4]| -> Vec<f64> {
        let study = study(&lid(angle, order));
        let start = study.analyse(0.0, None).expect("small");
        let solution = start.solution().expect("decided");
        let found = start.bounds(&solution, &Elasticity::default());
        let of = |k: usize| {
            let (id, _) = (order.iter().position(|j| *j == k).expect("listed"), ());
            found.largest_magnitudes(ConstraintId(id)).expect("bounds")[0].expect("a force")
        };
        (0..4).map(of).collect()
    };
    let first = magnitudes(0.0, [0, 1, 2, 3]);
    for (angle, order) in [
        (0.7, [0, 1, 2, 3]),
        (-2.1, [3, 1, 0, 2]),
        (0.0, [2, 3, 1, 0]),
    ] {
        let turned = magnitudes(angle, order);
        for (a, b) in first.iter().zip(&turned) {
            assert!((a - b).abs() < 1e-8 * a, "{first:?} {turned:?}");
        }
    }
}

/// Supports that are stiff in one direction and soft in another do not give way in the direction of
/// their force: they leave the bounds, as the assumption states.
#[test]
fn supports_with_oblique_stiffness_leave_the_bounds() {
    let mut numbers = Numbers::new(7);
    let mut outside = 0;
    for _ in 0..20 {
        let study = study(&random(&mut numbers, false));
        let start = study.analyse(0.0, None).expect("small");
        let solution = start.solution().expect("decided");
        let found = start.bounds(&solution, &Elasticity::default());
        let Ok(bounds) = found.group(&Group::WrenchSum(vec![(1.0, ConstraintId(0))])) else {
            continue;
        };
        for _ in 0..40 {
            let mut soft = || 10_f64.powf(numbers.within(-12.0, -4.0));
            let joints = (0..start.mechanism.layout().groups.len()).map(|k| Compliance {
                reaction: ConstraintId(k),
                along: [soft(), soft(), 0.0],
                rotation: soft(),
            });
            let choice = Choice::Compliance(joints.collect::<Vec<_>>().into());
            let chosen = start.distribution(&choice).expect("all joints give way");
            let components = &chosen.reactions[0].components;
            outside += usize::from(components.iter().any(|(name, value)| {
                let value = value.in_solution().expect("a number");
                let own = bounds.iter().find(|(known, _)| known == name);
                let own = &own.expect("a component").1;
                let slack = 1e-3 * (own.highest - own.lowest);
                value < own.lowest - slack || value > own.highest + slack
            }));
        }
    }
    assert!(outside > 10, "{outside}");
}

/// A body on a slide and a clamp. The place of a slide along its own axis has no meaning, but its
/// moment depends on it. With a centre of stiffness the bounds and the loads for elastic supports
/// are those of the mechanism. The names of the bodies in a joint may be swapped.
#[test]
fn a_centre_of_stiffness_decides_where_a_moment_gives_way() {
    let scene = |at: [f64; 3], swapped: bool, centre: &str, turned: bool| {
        // The whole scene may be turned by a quarter about z.
        let t = |[x, y, z]: [f64; 3]| if turned { [-y, x, z] } else { [x, y, z] };
        let order = if swapped {
            "\"ground\", \"top\""
        } else {
            "\"top\", \"ground\""
        };
        let (axis, clamp) = (t([1.0, 0.0, 0.0]), t([0.5, 1.0, 0.0]));
        let (at, load) = (t(at), t([0.2, 0.3, 0.1]));
        format!(
            "scene = {{ name = \"slide\", space = \"spatial\", gravity = {:?} }}\n\
             body = [{{ name = \"top\", mass = 10.0, inertia = [1.0, 1.0, 1.0], position = {load:?} }}]\n\
             joint = [\n\
             {{ name = \"slide\", type = \"translational\", bodies = [{order}], at = {at:?}, axis = {axis:?}{centre} }},\n\
             {{ name = \"clamp\", type = \"fixed\", bodies = [{order}], at = {clamp:?} }},\n]",
            t([1.0, 2.0, -9.81])
        )
    };
    let found = |text: &str| -> Vec<[f64; 2]> {
        let study = study(text);
        let start = study.analyse(0.0, None).expect("small");
        let solution = start.solution().expect("decided");
        let bounds = start.bounds(&solution, &Elasticity::default());
        let components = ["Fx", "Fy", "Fz"];
        let mut all: Vec<[f64; 2]> = components
            .map(|name| {
                let own = of(&bounds, 1, name);
                [own.lowest, own.highest]
            })
            .into();
        let soft = start
            .mechanism
            .layout()
            .constraint_ids()
            .map(|reaction| Compliance {
                reaction,
                along: [1e-6; 3],
                rotation: 2e-6,
            });
        let choice = Choice::Compliance(soft.collect::<Vec<_>>().into());
        let chosen = start.distribution(&choice).expect("both give way");
        let clamp = &chosen.reactions[1].components;
        all.extend(components.map(|name| {
            let value = clamp.iter().find(|(known, _)| *known == name);
            [value.expect("a force").1.in_solution().expect("a number"); 2]
        }));
        all
    };
    let near = |a: &[[f64; 2]], b: &[[f64; 2]]| {
        let size = a.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
    };
    let centre = ", centre_of_stiffness = [0.25, 0.0, 0.0]";
    let place = found(&scene([0.0, 0.0, 0.0], false, "", false));
    let moved = found(&scene([1.0, 0.0, 0.0], false, "", false));
    assert!(
        near(&place, &moved) > 1e-3,
        "the place matters: {place:?} {moved:?}"
    );
    let first = found(&scene([0.0, 0.0, 0.0], false, centre, false));
    let again = found(&scene([1.0, 0.0, 0.0], false, centre, false));
    assert!(near(&first, &again) < 1e-8, "{first:?} {again:?}");
    // The same point as the place.
    let same = found(&scene([0.25, 0.0, 0.0], false, "", false));
    assert!(near(&first, &same) < 1e-8, "{first:?} {same:?}");
    // With swapped bodies the reactions have the other sign.
    let swapped = found(&scene([1.0, 0.0, 0.0], true, centre, false));
    let negated: Vec<[f64; 2]> = swapped.iter().map(|[a, b]| [-b, -a]).collect();
    assert!(near(&first, &negated) < 1e-8, "{first:?} {swapped:?}");
    let turned = found(&scene(
        [1.0, 0.0, 0.0],
        false,
        ", centre_of_stiffness = [0.0, 0.25, 0.0]",
        true,
    ));
    let back = [1, 0, 2, 4, 3, 5].map(|k| turned[k]);
    let sign = |k: usize, [a, b]: [f64; 2]| if k % 3 == 1 { [-b, -a] } else { [a, b] };
    let back: Vec<[f64; 2]> = (0..6).map(|k| sign(k, back[k])).collect();
    assert!(near(&first, &back) < 1e-8, "{first:?} {back:?}");
}

/// A support and a wheel both prevent the same sideways motion. The support gives way by c·f_h, the
/// wheel slips at the rate s·f_n, and f_h + f_n is the load: `c·ḟ_h = s·(F − f_h)`. After a load of
/// 10 N has reversed, the support still carries a part of the old load, outside of the bounds. If
/// the load has not changed for a while, the support is inside: the assumption says so.
#[test]
fn a_support_that_shares_with_a_slipping_wheel_has_a_memory() {
    let study = study(
        r#"scene = { name = "sled", space = "plane" }
        body = [{ name = "sled", mass = 1.0, inertia = 1.0 }]
        joint = [
            { name = "support", type = "point-on-line", body = "sled", at = [0.0, 0.0], line = [[-1.0, 0.0], [1.0, 0.0]] },
            { name = "wheel", type = "knife-edge", body = "sled", at = [0.0, 0.0], normal = [0.0, 1.0] },
        ]
        force = [{ name = "push", type = "point-force", body = "sled", at = [0.0, 0.0], force = [0.0, -10.0] }]"#,
    );
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.bounds(&solution, &Elasticity::default());
    // The reaction on the sled is opposite to the load.
    let bounds = of(&found, 0, "Fy");
    assert_range(&bounds, [0.0, 10.0], "support");
    let rate = 3.0;
    let after = |t: f64| 10.0 - 20.0 * (-rate * t).exp();
    let is_inside = |t: f64| (bounds.lowest..=bounds.highest).contains(&after(t));
    let known = 2.0_f64.ln() / rate;
    assert!(!is_inside(0.0) && !is_inside(0.99 * known));
    assert!(is_inside(1.01 * known) && is_inside(10.0));
}
