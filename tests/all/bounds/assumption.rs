//! The assumption of the bounds: loads that violate it leave them.

use model::{ConstraintId, System};
use pfaff::solvability::{Choice, Compliance, ElasticSupports, Elasticity, Group, Misfit};
use tests::numbers::Numbers;

use super::{TABLE, assert_range, of, random, study};

/// A leg that is too long by h takes more load; with legs of equal compliance c the self-stress is
/// h/(4·c). Such a preload is not in the bounds.
#[test]
fn a_leg_that_is_too_long_leaves_the_bounds() {
    let study = study(TABLE);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.bounds(solution, &Elasticity::default());
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
        let found = start.bounds(solution, &Elasticity::default());
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
    let found = start.bounds(solution, &Elasticity::default());
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
