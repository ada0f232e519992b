//! Bounds for compliances within a factor of nominal ones.

use model::{ConstraintId, System};
use pfaff::solvability::{
    BoundsError, Choice, Compliance, ComplianceRange, ElasticLoad, Elasticity, Group,
    NominalCompliance, Term,
};
use tests::numbers::Numbers;

use super::{CLAMPED, TABLE, assert_range, of, random, study};

/// Compliances between nominal ones and a multiple of them.
fn within(factor: f64, nominal: Option<Vec<NominalCompliance>>) -> Elasticity {
    Elasticity {
        within: Some(ComplianceRange { factor, nominal }),
        ..Elasticity::default()
    }
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
        let found = start.bounds(solution, &within(factor, Some(nominal.clone())));
        let wide = start.bounds(solution, &Elasticity::default());
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
    let found = start.bounds(solution, &within(2.0, None));
    let refused = found.group(&group).expect_err("a force and a moment");
    assert!(matches!(refused, BoundsError::Mixed { .. }), "{refused}");
    let found = start.bounds(solution, &within(2.0, Some(Vec::new())));
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
    let found = start.bounds(solution, &within(2.0, Some(nominal)));
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
        let found = start.bounds(solution, &within(factor, None));
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
    let found = start.bounds(solution, &Elasticity::default());
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
