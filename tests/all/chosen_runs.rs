//! Choices along a run: at every written row they are solutions of the same equations, and they
//! equal the choices of a rank decision at that configuration.

use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::sync::Arc;

use dynamics::plan::{OutputRequest, Plan};
use dynamics::{MotionFault, MotionOptions, Sample};
use model::{ConfigurationAccuracy, ConstraintId, Mechanism, Registry, System};
use pfaff::{RunOptions, Study};
use solvability::{
    CARRIED_VECTORS, Choice, Compliance, NormWeights, Questions, ReactionVerdict, Solution,
    Verdict, analyse_known,
};
use tests::largest;

/// Beams of 1 kg, each on this number of parallel cranks of 1 m, inclined by 0.6, all on one body.
fn beams(beams: usize, cranks: usize, base: &str) -> String {
    let (sine, cosine) = 0.6_f64.sin_cos();
    let mut text = "[scene]\nname = \"beams\"\nspace = \"plane\"\ngravity = [1, -10]\n".to_owned();
    let mut body = |name: &str, [x, y]: [f64; 2]| {
        let _ = write!(
            text,
            "[[body]]\nname = \"{name}\"\nmass = 1.0\ninertia = 0.1\nposition = [{x}, {y}]\n"
        );
    };
    let place = |beam: usize, crank: usize| 10.0 * beam as f64 + crank as f64;
    if base != "ground" {
        body(base, [0.0, 0.0]);
    }
    for i in 0..beams {
        body(&format!("beam {i}"), [place(i, 1) + sine, cosine]);
        for k in 0..cranks {
            body(
                &format!("crank {i} {k}"),
                [place(i, k) + 0.5 * sine, 0.5 * cosine],
            );
        }
    }
    if base != "ground" {
        let _ = write!(
            text,
            "[[joint]]\nname = \"rail\"\ntype = \"translational\"\nbodies = [\"ground\", \"{base}\"]\nat = [0, 0]\naxis = [1, 0]\n"
        );
    }
    let mut pin = |name: String, bodies: [&str; 2], [x, y]: [f64; 2]| {
        let _ = write!(
            text,
            "[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = {bodies:?}\nat = [{x}, {y}]\n"
        );
    };
    for i in 0..beams {
        for k in 0..cranks {
            let crank = format!("crank {i} {k}");
            pin(format!("foot {i} {k}"), [base, &crank], [place(i, k), 0.0]);
            let top = [place(i, k) + sine, cosine];
            pin(format!("top {i} {k}"), [&crank, &format!("beam {i}")], top);
        }
    }
    text
}

fn study(text: &str) -> Study {
    let read = Study::read(
        "scene.toml",
        text,
        &Registry::standard(),
        &RunOptions::default(),
    );
    read.unwrap_or_else(|e| panic!("{e}"))
}

/// Returns the choices: least norm, springs of different stiffness in all joints, and no reaction
/// in rows other than the redundant rows of the run.
fn choices(study: &Study) -> Vec<Choice> {
    let start = study.analyse(0.0, None).expect("decided");
    let layout = study.prepared.mechanism.layout();
    let spring = |id: ConstraintId| Compliance {
        reaction: id,
        along: [1e-6 * (1.0 + id.0 as f64), 2e-6, 3e-6],
        rotation: 1e-5,
    };
    let sets = start.elimination_sets(40).expect("decided");
    vec![
        Choice::MinimumNorm(NormWeights::with_arm(0.3)),
        Choice::Compliance(
            layout
                .constraint_ids()
                .map(spring)
                .collect::<Vec<_>>()
                .into(),
        ),
        Choice::Elimination(sets.last().expect("redundant").clone()),
    ]
}

/// Runs a scene and compares the choices at each row; returns how many values were compared.
fn compared(study: &Study, choices: &[Choice], t_end: f64) -> usize {
    let mechanism = &study.prepared.mechanism;
    let start = study.analyse(0.0, None).expect("decided");
    let named = choices.iter().map(|choice| start.named(choice));
    let wanted = OutputRequest {
        choices: named
            .collect::<Result<_, _>>()
            .unwrap_or_else(|e| panic!("{e}")),
        ..OutputRequest::default()
    };
    let options = MotionOptions {
        output_step: t_end / 4.0,
        ..MotionOptions::to(t_end)
    };
    let plan = Plan::new(&study.prepared, &options, &wanted).expect("possible");
    let mut numbers = 0;
    let run = plan.simulate(|sample| {
        numbers += compare(mechanism, choices, sample)?;
        Ok(ControlFlow::Continue(()))
    });
    run.unwrap_or_else(|e| panic!("{}", e.error));
    numbers
}

fn compare(
    mechanism: &Mechanism,
    choices: &[Choice],
    sample: &mut Sample<'_, '_>,
) -> Result<usize, MotionFault> {
    let (t, q) = (sample.t, sample.q.to_vec());
    let analysis =
        analyse_known(mechanism, t, &q, ConfigurationAccuracy::To(1e-8)).expect("decided");
    let analysis = Arc::new(analysis);
    let questions = Questions::new(mechanism, &q, Arc::clone(&analysis));
    let solution = Solution {
        acceleration: sample.acceleration()?,
        multipliers: sample.multipliers()?,
        no_finite: Vec::new(),
    };
    let mut s = mechanism.scratch();
    mechanism.pose(t, &q, &mut s);
    mechanism.c(&mut s);
    let c = mechanism.layout().dense(&s);
    let load = c.transpose_times(solution.multipliers.as_chosen());
    let size = largest(load.iter().copied());
    assert!(size > 1.0, "{size}");
    let own = sample.reactions()?;
    let mut numbers = 0;
    for (chosen, choice) in sample.chosen()?.into_iter().zip(choices) {
        assert!(chosen.refused.is_none(), "{:?} at {t} s", chosen.refused);
        let lambda = chosen.multipliers.as_chosen();
        // The forces on every body are the same.
        let balance = c.transpose_times(lambda);
        let missed = largest(balance.iter().zip(&load).map(|(a, b)| a - b));
        assert!(missed < 1e-9 * size, "{missed} of {size} at {t} s");
        // The values equal those of a rank decision at this configuration.
        let here = questions.distribute(&solution, choice);
        let here = here.unwrap_or_else(|e| panic!("{e} at {t} s"));
        for (row, value) in here.multipliers.iter().enumerate() {
            let expected = value.in_solution().expect("finite");
            let off = (lambda[row] - expected).abs();
            assert!(off < 1e-8 * size, "row {row} at {t} s: {off} of {size}");
            numbers += 1;
        }
        for &row in choice.eliminated() {
            assert_eq!(lambda[row], 0.0, "row {row}");
        }
        // Unique values are the same; at least one other value differs from the run.
        let mut differs = 0.0_f64;
        let pairs = own.as_chosen().iter().zip(chosen.reactions.as_chosen());
        for ((own, other), verdict) in pairs.zip(&analysis.reactions) {
            for (k, unique) in are_unique(verdict).iter().enumerate() {
                let space = mechanism.space();
                let [own, other] = [own, other].map(|r| r.components(space).nth(k));
                let off = (own.expect("there") - other.expect("there")).abs();
                if *unique {
                    assert!(off < 1e-9 * size, "{off} of {size} at {t} s");
                } else {
                    differs = differs.max(off);
                }
            }
        }
        assert!(differs > 1e-3 * size, "{differs} of {size} at {t} s");
    }
    Ok(numbers)
}

/// Whether each component in the plane is unique.
fn are_unique(reaction: &ReactionVerdict) -> [bool; 3] {
    ["Fx", "Fy", "T"].map(|name| {
        let own = reaction.components.iter().find(|c| c.name == name);
        own.is_none_or(|c| c.judgement.verdict == Verdict::Unique)
    })
}

#[test]
fn choices_of_more_dependencies_than_are_carried() {
    let study = study(&beams(1, 2 * CARRIED_VECTORS, "ground"));
    assert_eq!(study.prepared.decision.redundancy, 2 * CARRIED_VECTORS - 2);
    assert!(compared(&study, &choices(&study), 0.4) > 400);
}

/// Beams on the ground are independent: each is simulated separately.
#[test]
fn choices_of_components() {
    let study = study(&beams(3, 3, "ground"));
    assert!(compared(&study, &choices(&study), 0.4) > 500);
}

/// On a sled they form one mechanism, whose parts are analysed separately.
#[test]
fn choices_of_parts() {
    let study = study(&beams(22, 3, "sled"));
    assert!(study.prepared.mechanism.layout().rows() > solvability::ONE_PART);
    assert!(compared(&study, &choices(&study), 0.1) > 3000);
}
