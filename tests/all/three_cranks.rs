//! Three parallel cranks under one coupler have one redundant constraint. The reference values come
//! from `reference/redundant_three_cranks.json`.

use dynamics::{KeptRowMotion, RowChoice, prepare};
use model::{BodyRef, Description, Mechanism, StartOptions, System};
use serde_json::Value;
use solvability::ChosenValues;
use tests::cranks::cranks;
use tests::{largest, rod};

const REFERENCE: &str = include_str!("../reference/redundant_three_cranks.json");

/// Accuracy of the reference: 13 digits.
const TOLERANCE: f64 = 1e-12;

fn numbers(case: &Value, key: &str) -> Vec<f64> {
    let value = &case["reference"][key];
    match value.as_array() {
        Some(list) => list.iter().filter_map(Value::as_f64).collect(),
        None => value.as_f64().into_iter().collect(),
    }
}

/// The case of the reference: its angle θ from the downward vertical is θ − π/2 from the x-axis.
fn mechanism(theta: f64, rate: f64) -> Mechanism {
    let (length, half_span, pivots) = (0.5, 0.8, [-0.8, 0.0, 0.8]);
    let mut d: Description = cranks(&pivots, length, theta - std::f64::consts::FRAC_PI_2);
    d.gravity = [0.0, -9.81];
    let tangent = [theta.cos(), theta.sin()];
    for crank in &mut d.bodies[..3] {
        let inertia = 1.2 * length * length / 12.0;
        (crank.mass, crank.inertia, crank.angular_velocity) = (1.2, inertia, Some(rate));
        crank.velocity = Some(tangent.map(|t| 0.5 * length * rate * t));
    }
    let coupler = rod("coupler", 3.0, [-half_span, 0.0], [half_span, 0.0]);
    (d.bodies[3].mass, d.bodies[3].inertia) = (coupler.mass, coupler.inertia);
    d.bodies[3].velocity = Some(tangent.map(|t| length * rate * t));
    Mechanism::build(&d).expect("the cranks build")
}

#[test]
fn every_number_of_the_case() {
    let case: Value = serde_json::from_str(REFERENCE).expect("the case is JSON");
    let theta = std::f64::consts::FRAC_PI_6;
    let start = StartOptions::default();
    let p = prepare(mechanism(theta, 1.5), &start, &RowChoice::Automatic).expect("starts");
    assert_eq!(p.decision.rank, 11);
    assert_eq!(p.decision.redundancy, 1);
    assert!(largest(p.velocity_correction.iter().copied()) < 1e-14);

    let mut motion = KeptRowMotion::new(&p).expect("moves");
    let mut a = vec![0.0; 12];
    let mut lambda = ChosenValues::new(vec![0.0; 12], Vec::new());
    motion
        .acceleration(0.0, &p.q, &p.v, &mut a)
        .expect("regular");
    motion
        .multipliers(0.0, &p.q, &p.v, &mut lambda)
        .expect("regular");
    let lambda = lambda.as_chosen();
    let alpha = numbers(&case, "angular_acceleration")[0];
    for crank in 0..3 {
        assert!((a[3 * crank + 2] - alpha).abs() < TOLERANCE * alpha.abs());
    }

    // The minimum norm has no component of λ in the null space, which is one-dimensional.
    let decision = solvability::analyse(&p.mechanism, 0.0, &p.q)
        .expect("regular")
        .whole()
        .expect("one part")
        .into_owned();
    let z = rank::dependencies(&decision);
    let z: Vec<f64> = (0..12).map(|i| z[(i, 0)]).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let share = dot(&z, lambda) / dot(&z, &z);
    let shortest: Vec<f64> = lambda.iter().zip(&z).map(|(l, z)| l - share * z).collect();

    let (radial, tangential) = ([theta.sin(), -theta.cos()], [theta.cos(), theta.sin()]);
    let on_second = |joint: usize, lambda: &[f64], along: [f64; 2]| {
        let id = model::ConstraintId(joint);
        let [fx, fy, _] = p
            .mechanism
            .reactions(motion.scratch())
            .reaction(id, lambda)
            .force;
        -(fx * along[0] + fy * along[1])
    };
    let (pivots, tips) = ([0, 2, 4], [1, 3, 5]);
    let close =
        |found: f64, expected: f64| (found - expected).abs() < TOLERANCE * expected.abs().max(1.0);

    let tangential_tip = numbers(&case, "tangential_tip_force_on_coupler_each_crank (unique)")[0];
    let radial_sum = numbers(&case, "sum_of_radial_tip_forces_on_coupler (unique)")[0];
    let tip_norm = numbers(&case, "radial_tip_forces_minimum_norm");
    let ground_norm = numbers(&case, "ground_radial_minimum_norm");
    let ground_tangential = numbers(&case, "ground_tangential (unique)");
    for k in 0..3 {
        assert!(close(
            on_second(tips[k], lambda, tangential),
            tangential_tip
        ));
        assert!(close(on_second(tips[k], &shortest, radial), tip_norm[k]));
        assert!(close(
            on_second(pivots[k], &shortest, radial),
            ground_norm[k]
        ));
        assert!(close(
            on_second(pivots[k], lambda, tangential),
            ground_tangential[k]
        ));
    }
    let sum: f64 = tips.iter().map(|&j| on_second(j, lambda, radial)).sum();
    assert!(close(sum, radial_sum));

    // The free direction consists of radial forces in the ratio 1 : −2 : 1 at tip and ground.
    let free: Vec<f64> = tips
        .iter()
        .chain(&pivots)
        .map(|&j| on_second(j, &z, radial))
        .collect();
    for (found, expected) in free.iter().zip([1.0, -2.0, 1.0, 1.0, -2.0, 1.0]) {
        assert!(close(found / free[0], expected), "{free:?}");
    }
    assert!(largest(tips.iter().map(|&j| on_second(j, &z, tangential))) < TOLERANCE);
    assert_eq!(p.mechanism.layout().groups[0].bodies[0], BodyRef::Ground);
}
