//! Choices of the reactions that a model does not determine, compared with closed forms, published
//! values, and runs with other independent rows.

use std::ops::ControlFlow;

use dynamics::{MotionOptions, PreparedMechanism, RowChoice, prepare, simulate};
use joints::plane::{Direction, Line};
use joints::{BodyPointForce, Fixed, PointForce, PointOnLine, Revolute, Velocity};
use model::{
    Body, BodyRef, ConstraintId, Description, Force, Frame, Function, Joint, Mechanism, Reaction,
    StartOptions, System,
};
use serde_json::Value as Json;
use solvability::{
    Choice, ChoiceError, Compliance, Configuration, Distribution, Equations, LinearForm,
    NormWeights, Value, analyse, minimise,
};
use tests::cranks::cranks;
use tests::robot::{robot, steering};
use tests::{largest, rod};

const THREE_CRANKS: &str = include_str!("../reference/redundant_three_cranks.json");

/// A mechanism at a given state.
struct State {
    mechanism: Mechanism,
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
}

impl State {
    fn at_start(d: &Description) -> Self {
        let p = started(d, &RowChoice::Automatic);
        Self {
            mechanism: p.mechanism,
            t: 0.0,
            q: p.q,
            v: p.v,
        }
    }

    fn configuration(&self) -> Configuration<'_> {
        let analysis = analyse(&self.mechanism, self.t, &self.q).expect("C is finite");
        Configuration::new(
            &self.mechanism,
            self.t,
            &self.q,
            &analysis.whole().expect("one part"),
        )
        .expect("fits")
    }

    fn lambda_0(&self) -> Result<Vec<f64>, ChoiceError> {
        let decision = self.configuration().solvability().decision().clone();
        let equations = Equations::of(&self.mechanism, self.t, &self.q, &self.v)?;
        Ok(equations.multipliers(&decision)?.as_chosen().to_vec())
    }

    fn distribute(&self, choice: &Choice) -> Result<Distribution, ChoiceError> {
        self.configuration().distribute(&self.lambda_0()?, choice)
    }
}

fn started(d: &Description, rows: &RowChoice) -> PreparedMechanism {
    let mechanism = Mechanism::build(d).expect("builds");
    prepare(mechanism, &StartOptions::default(), rows).expect("starts")
}

/// Returns the value, and whether it depends on the choice.
fn number(value: &Value) -> (f64, bool) {
    let chosen = value.of_choice().map(|(x, by)| {
        assert!(!by.to_string().is_empty());
        (x, true)
    });
    let determined = value.determined().map(|x| (x, false));
    chosen.or(determined).expect("a number")
}

fn component(d: &Distribution, joint: &str, name: &str) -> (f64, bool) {
    let reaction = d.reactions.iter().find(|r| r.name == joint).expect("joint");
    let found = reaction.components.iter().find(|(n, _)| *n == name);
    number(&found.expect("component").1)
}

fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let size = expected.abs().max(1.0);
    assert!(
        (found - expected).abs() <= tolerance * size,
        "{what}: {found} instead of {expected}"
    );
}

/// A force on body 0 at a point.
fn load(force: [f64; 2], s: [f64; 2]) -> Force {
    Force {
        name: "load".into(),
        bodies: vec![BodyRef::Body(0)],
        element: Box::new(PointForce { s }),
        functions: force
            .map(|x| Function::constant(x).expect("finite"))
            .to_vec(),
    }
}

fn bar(joints: Vec<Joint>, loads: Vec<Force>) -> Description {
    Description {
        name: "bar".into(),
        bodies: vec![Body {
            name: "bar".into(),
            mass: 1.0,
            inertia: 1.0,
            ..Body::default()
        }],
        joints,
        forces: loads,
        ..Description::default()
    }
}

/// A support that constrains the height of a point of the bar.
fn roller(name: &str, x: f64) -> Joint {
    let line = Line::new([x, 0.0], [x + 1.0, 0.0]).expect("two points");
    Joint::new(name, &[BodyRef::Body(0)], PointOnLine { s: [x, 0.0], line })
}

/// A bar of 1 m is clamped at the left and pinned at the right, with a unit load at a quarter of
/// its length. With R on the right the other force is `1 − R` and the moment `1/4 − R`, so with
/// lengths in units of u (per metre) the minimum norm has `R = (1 + u²/4)/(2 + u²)`.
#[test]
fn clamped_and_pinned_bar() {
    let pair = [BodyRef::Ground, BodyRef::Body(0)];
    let ends = |x: f64| ([x, 0.0], [x, 0.0]);
    let ((s_i, s_j), (p_i, p_j)) = (ends(0.0), ends(1.0));
    let clamp = Fixed::new(s_i, s_j);
    let joints = vec![
        Joint::new("clamp", &pair, clamp),
        Joint::new("pin", &pair, Revolute { s_i: p_i, s_j: p_j }),
    ];
    let state = State::at_start(&bar(joints, vec![load([0.0, -1.0], [0.25, 0.0])]));
    let right = |weights| {
        let d = state
            .distribute(&Choice::MinimumNorm(weights))
            .expect("a norm");
        let (force, chosen) = component(&d, "pin", "Fy");
        assert!(chosen);
        // The load acts downwards on the ground.
        -force
    };
    assert_close(
        right(NormWeights::NEWTON_METRE),
        1.25 / 3.0,
        1e-14,
        "N and N·m",
    );
    let millimetres = (1.0 + 0.25e6) / (2.0 + 1e6);
    assert_close(
        right(NormWeights::NEWTON_MILLIMETRE),
        millimetres,
        1e-12,
        "N and N·mm",
    );
    assert_eq!(format!("{:.4}", right(NormWeights::NEWTON_METRE)), "0.4167");
    assert_eq!(
        format!("{:.4}", right(NormWeights::NEWTON_MILLIMETRE)),
        "0.2500"
    );
    // With the compliance 1/k of the pin and the rotational compliance c of the clamp, R·(1/k + c)
    // = c/4.
    let compliance = |joint, y, rotation| Compliance {
        reaction: ConstraintId(joint),
        along: [1e-9, y, 0.0],
        rotation,
    };
    let elastic =
        Choice::Compliance(vec![compliance(0, 0.0, 3e-4), compliance(1, 1e-4, 0.0)].into());
    let d = state.distribute(&elastic).expect("determined");
    assert_close(
        -component(&d, "pin", "Fy").0,
        0.25 * 3.0 / 4.0,
        1e-14,
        "elastic",
    );
}

/// A rigid beam on three springs at −1, 0, 1: `force·compliance` is a linear function along the
/// beam.
#[test]
fn beam_on_three_springs() {
    let supports = [("left", -1.0), ("middle", 0.0), ("right", 1.0)];
    let joints: Vec<Joint> = supports.map(|(name, x)| roller(name, x)).to_vec();
    let (load_size, at) = (10.0, 0.3);
    let state = State::at_start(&bar(joints, vec![load([0.0, -load_size], [at, 0.0])]));
    let elastic = |compliances: [f64; 3]| {
        let joint = |(k, y): (usize, f64)| Compliance {
            reaction: ConstraintId(k),
            along: [0.0, y, 0.0],
            rotation: 0.0,
        };
        state.distribute(&Choice::Compliance(
            compliances
                .into_iter()
                .enumerate()
                .map(joint)
                .collect::<Vec<_>>()
                .into(),
        ))
    };
    let forces = |d: &Distribution| supports.map(|(name, _)| component(d, name, "Fy").0);
    let expect = |found: [f64; 3], expected: [f64; 3]| {
        for (found, expected) in found.into_iter().zip(expected) {
            assert_close(found, expected, 1e-13, "support");
        }
    };
    // The ground pushes upwards.
    let arm = at * load_size / 2.0;
    let third = load_size / 3.0;
    expect(
        forces(&elastic([1e-6; 3]).expect("determined")),
        [third - arm, third, third + arm],
    );
    let share = 0.4 * load_size;
    expect(
        forces(&elastic([1e-6, 2e-6, 1e-6]).expect("determined")),
        [share - arm, 0.5 * share, share + arm],
    );
    // Between rigid supports an elastic support carries no load.
    expect(
        forces(&elastic([0.0, 1e-6, 0.0]).expect("determined")),
        [0.5 * load_size - arm, 0.0, 0.5 * load_size + arm],
    );
    assert!(matches!(
        elastic([0.0; 3]),
        Err(ChoiceError::Indeterminate { free: 1 })
    ));
    assert!(matches!(
        elastic([1.0, -1.0, 1.0]),
        Err(ChoiceError::Weight { .. })
    ));
    let norm =
        |force, torque| state.distribute(&Choice::MinimumNorm(NormWeights { force, torque }));
    assert!(matches!(
        norm(0.0, 1.0),
        Err(ChoiceError::NormWeight { .. })
    ));
    assert!(matches!(
        norm(1.0, f64::NAN),
        Err(ChoiceError::NormWeight { .. })
    ));
}

/// The reference values are those of `reference/redundant_three_cranks.json` (computed there in
/// closed form), with 13 digits.
#[test]
fn three_cranks_with_least_norm() {
    let case: Json = serde_json::from_str(THREE_CRANKS).expect("the case is JSON");
    let list = |key: &str| -> Vec<f64> {
        let list = case["reference"][key].as_array().expect("a list");
        list.iter().filter_map(Json::as_f64).collect()
    };
    let theta = std::f64::consts::FRAC_PI_6;
    let state = State::at_start(&three_cranks(theta, 1.5));
    let d = state
        .distribute(&Choice::MinimumNorm(NormWeights::NEWTON_METRE))
        .expect("a norm");
    let configuration = state.configuration();
    let (radial, tangential) = (
        [theta.sin(), -theta.cos(), 0.0],
        [theta.cos(), theta.sin(), 0.0],
    );
    for (names, offset) in [("tip", 1), ("ground", 0)] {
        let norm = list(match names {
            "tip" => "radial_tip_forces_minimum_norm",
            _ => "ground_radial_minimum_norm",
        });
        for k in 0..3 {
            let id = ConstraintId(2 * k + offset);
            let along = |direction| {
                let form = configuration
                    .reactions()
                    .force(id, direction)
                    .expect("exists");
                number(&d.value(&configuration, &form).expect("fits"))
            };
            // The program reports the reaction on the first body; the reference gives the reaction
            // on the second.
            let (force, chosen) = along(radial);
            assert!(chosen);
            assert_close(-force, norm[k], 1e-12, "radial");
            let unique = match names {
                "tip" => case["reference"]["tangential_tip_force_on_coupler_each_crank (unique)"]
                    .as_f64()
                    .expect("a number"),
                _ => list("ground_tangential (unique)")[k],
            };
            let (force, chosen) = along(tangential);
            assert!(!chosen);
            assert_close(-force, unique, 1e-12, "tangential");
        }
    }
}

/// The case of the reference: its angle θ from the downward vertical is θ − π/2 from the x-axis.
fn three_cranks(theta: f64, rate: f64) -> Description {
    let (length, half_span) = (0.5, 0.8);
    let mut d = cranks(
        &[-0.8, 0.0, 0.8],
        length,
        theta - std::f64::consts::FRAC_PI_2,
    );
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
    d
}

/// The robot at t = 0, with a lateral force and a torque on the platform, so that the reactions are
/// not zero.
fn pushed_robot() -> Description {
    let mut d = robot(steering());
    d.forces.push(Force {
        name: "push".into(),
        bodies: vec![BodyRef::Body(0)],
        element: Box::new(BodyPointForce { s: [0.1, 0.07] }),
        functions: [3.0, 50.0]
            .map(|x| Function::constant(x).expect("finite"))
            .to_vec(),
    });
    d
}

/// Returns the reactions of a run with other independent rows, at its start or at t > 0.
fn run_without(d: &Description, rows: &[usize], t: f64) -> (State, Vec<Reaction>) {
    let rows = RowChoice::Drop(rows.to_vec());
    let p = started(d, &rows);
    let (mut last, mut reactions) = ((0.0, Vec::new(), Vec::new()), Vec::new());
    let options = MotionOptions {
        rows,
        output_step: t.max(1.0),
        ..MotionOptions::to(t)
    };
    simulate(&p, &options, |sample| {
        last = (sample.t, sample.q.to_vec(), sample.v.to_vec());
        reactions = sample.reactions()?.as_chosen().to_vec();
        Ok(ControlFlow::Continue(()))
    })
    .expect("moves");
    let (t, q, v) = last;
    let state = State {
        mechanism: p.mechanism,
        t,
        q,
        v,
    };
    (state, reactions)
}

/// Compares eliminations with runs that keep exactly these rows, and with the components that all
/// choices have in common.
#[test]
fn eliminations_of_the_robot_are_runs_without_these_rows() {
    for (t, rows) in [
        (0.0, [6, 21]),
        (0.0, [18, 21]),
        (0.0, [19, 21]),
        (1.5, [6, 21]),
        (1.5, [18, 21]),
    ] {
        let rows = rows.map(|r| r - 1);
        let (state, expected) = run_without(&pushed_robot(), &rows, t);
        assert_eq!(state.t, t);
        let size = largest(expected.iter().flat_map(|r| r.force));
        assert!(size > 10.0, "something to share");
        let d = state
            .distribute(&Choice::Elimination(rows.to_vec()))
            .expect("admissible");
        for row in rows {
            assert_eq!(number(&d.multipliers[row]), (0.0, true));
        }
        for (found, expected) in d.reactions.iter().zip(&expected) {
            for (name, value) in &found.components {
                let wrench = [expected.force[0], expected.force[1], expected.torque[2]];
                let k = ["Fx", "Fy", "T"]
                    .iter()
                    .position(|n| n == name)
                    .expect("one");
                assert_close(number(value).0, wrench[k], 1e-10 * size, &found.name);
            }
        }
        // Unique components have the same value for any other choice; here the choice consists of
        // rows that the run did not keep.
        let norm = state
            .distribute(&Choice::MinimumNorm(NormWeights::NEWTON_METRE))
            .expect("a norm");
        let mut chosen = Vec::new();
        for (a, (b, run)) in norm.reactions.iter().zip(d.reactions.iter().zip(&expected)) {
            for ((name, x), (_, y)) in a.components.iter().zip(&b.components) {
                let ((x, x_chosen), (y, y_chosen)) = (number(x), number(y));
                assert_eq!(x_chosen, y_chosen);
                if x_chosen {
                    chosen.push(format!("{}.{name}", a.name));
                } else {
                    assert_eq!(x, y);
                    let wrench = [run.force[0], run.force[1], run.torque[2]];
                    let k = ["Fx", "Fy", "T"]
                        .iter()
                        .position(|n| n == name)
                        .expect("one");
                    assert_close(x, wrench[k], 1e-10 * size, &a.name);
                }
            }
        }
        chosen.retain(|name| !name.starts_with('W'));
        match t {
            0.0 => assert_eq!(chosen, ["B.Fy", "C.Fy"]),
            _ => assert_eq!(chosen, ["B.Fx", "B.Fy", "C.Fx", "C.Fy"]),
        }
        assert!(norm.label.to_string().starts_with("minimum norm"));
        let shown = d.label.to_string();
        assert!(shown.contains("`W4`") && shown.contains("21"), "{shown}");
    }
}

#[test]
fn inadmissible_eliminations_are_refused_by_name() {
    let state = State::at_start(&robot(steering()));
    let refused = |rows: &[usize]| {
        let choice = Choice::Elimination(rows.iter().map(|r| r - 1).collect());
        state
            .distribute(&choice)
            .expect_err("not admissible")
            .to_string()
    };
    assert_eq!(
        refused(&[1, 21]),
        "no solution has zero reactions in the rows 1 (`A`, x), 21 (`W4`, normal): that of 1 (`A`, x) is unique"
    );
    // These rows are in dependencies, but not in a common one.
    let text = refused(&[6, 18]);
    assert!(
        text.contains("6 (`C`, y)") && text.contains("dependent"),
        "{text}"
    );
    assert!(refused(&[21]).contains("drop exactly 2"));
    assert!(refused(&[21, 21]).contains("twice"));
    assert!(refused(&[21, 99]).contains("does not exist"));
}

/// Two drives prescribe one velocity: if the velocities are equal, the drives share the load; if
/// the accelerations differ, there are no reactions.
#[test]
fn contradicting_drives_have_no_reactions() {
    let drive = |name: &str, rate: [f64; 2]| {
        let element = Velocity {
            s: [0.0, 0.0],
            direction: Direction::X,
        };
        Joint {
            functions: vec![Function::polynomial(&rate).expect("finite")],
            ..Joint::new(name, &[BodyRef::Body(0)], element)
        }
    };
    let with = |rates: [[f64; 2]; 2]| {
        let joints = vec![drive("first", rates[0]), drive("second", rates[1])];
        let mut d = bar(joints, vec![load([10.0, 0.0], [0.0, 0.0])]);
        d.bodies[0].velocity = Some([2.0, 0.0]);
        // The test does not call `prepare`, which rejects such drives itself.
        let mechanism = Mechanism::build(&d).expect("builds");
        let (q, v) = mechanism.described_state();
        State {
            mechanism,
            t: 0.0,
            q,
            v,
        }
    };
    let d = with([[2.0, 1.0]; 2])
        .distribute(&Choice::MinimumNorm(NormWeights::NEWTON_METRE))
        .expect("they agree");
    // A mass of 1 kg at 1 m/s² needs 1 N of 10 N; the drives carry 4.5 N each, and −4.5 N on the
    // bar.
    assert_close(component(&d, "first", "Fx").0, -4.5, 1e-15, "half");
    assert_close(component(&d, "second", "Fx").0, -4.5, 1e-15, "half");
    let error = with([[2.0, 1.0], [2.0, 1.1]])
        .lambda_0()
        .expect_err("they do not");
    assert!(matches!(error, ChoiceError::Contradiction { by, .. } if (by - 0.1).abs() < 1e-12));
}

/// Values of reactions of a mechanism, and the wrenches in the definition of the least norm.
struct Numbers<'a> {
    configuration: &'a Configuration<'a>,
    /// Each value with its unit for a force of 1 N, and whether it is unique.
    forms: Vec<(LinearForm, f64, bool)>,
    /// The components of each joint, and whether they are torques.
    wrenches: Vec<(ConstraintId, bool, LinearForm)>,
}

impl<'a> Numbers<'a> {
    /// Torques are taken only in the global frame.
    fn of(mechanism: &Mechanism, configuration: &'a Configuration<'a>) -> Self {
        let (mut forms, mut wrenches) = (Vec::new(), Vec::new());
        let (layout, reactions) = (mechanism.layout(), configuration.reactions());
        let is_torque = |k: usize| layout.space.torques().contains(&k);
        for id in layout.constraint_ids() {
            for k in layout.groups[id.0].components() {
                let name = layout.space.components()[k];
                let form = reactions.component(id, name).expect("a component");
                wrenches.push((id, is_torque(k), form));
            }
            for verdicts in configuration.frames(id).expect("exists") {
                let found = reactions.in_frame(id, verdicts.frame).expect("exists");
                let components = found.expect("has verdicts").components;
                let each = components.into_iter().zip(verdicts.components).enumerate();
                for (k, ((_, form), verdict)) in each {
                    let size = if is_torque(k) {
                        configuration.size()
                    } else {
                        1.0
                    };
                    if verdicts.frame == Frame::Global || !is_torque(k) {
                        forms.push((form, size, verdict.judgement.verdict.is_unique()));
                    }
                }
            }
        }
        Self {
            configuration,
            forms,
            wrenches,
        }
    }

    /// Computes the least norm with a torque unit multiplied by this factor, and with the wrench of
    /// one joint multiplied by another factor.
    fn least(&self, lambda: &[f64], torque: f64, alone: Option<ConstraintId>) -> Vec<f64> {
        let weighted = |(id, is_torque, form): &(ConstraintId, bool, LinearForm)| {
            let unit = if *is_torque { torque } else { 1.0 };
            let own = if alone == Some(*id) { 1e3 } else { 1.0 };
            (form.clone(), (unit * own).powi(2))
        };
        let terms: Vec<_> = self.wrenches.iter().map(weighted).collect();
        let lambda = minimise(self.configuration.solvability(), lambda, &terms).expect("least");
        let numbers = self.forms.iter();
        numbers
            .map(|(form, unit, _)| form.value(&lambda) / unit)
            .collect()
    }
}

/// A least norm adds newtons to newton metres, so it depends on their units. Exactly the values
/// that are not unique change with the units of all joints or of one joint. Without a load every
/// least norm is zero. Therefore the test also starts from multipliers without any symmetry, which
/// belong to some load.
#[test]
fn facts_do_not_depend_on_units() {
    let robot_turning = run_without(&pushed_robot(), &[20, 19], 1.5).0;
    let robot_straight = State::at_start(&robot(steering()));
    let cranks = State::at_start(&three_cranks(0.5, 1.5));
    // The 14 reactions of the robot have 3 + 2 components; 7 of the reactions have two more, along
    // and across their edge. B and C are not unique in either frame. W1 to W4 are not unique across
    // their edges, which affects both of their global components while they turn. Of the 6 bearings
    // of the cranks, only those at the tips are reported in the frame of a crank, in which the
    // force across it is unique.
    for (name, state, facts, choices) in [
        ("turning", robot_turning, 60, 24),
        ("straight, without load", robot_straight, 68, 16),
        ("cranks", cranks, 9, 21),
    ] {
        let configuration = state.configuration();
        let numbers = Numbers::of(&state.mechanism, &configuration);
        let real = state.lambda_0().expect("consistent");
        let golden = |k: usize| (0.618_033_988_749_894_9 * (k + 1) as f64).fract() - 0.5;
        let probe: Vec<f64> = (0..real.len()).map(golden).collect();
        let mut changes = vec![0.0_f64; numbers.forms.len()];
        for lambda in [real, probe] {
            let reference = numbers.least(&lambda, 1.0, None);
            let scale = reference.iter().fold(1e-9, |a: f64, x| a.max(x.abs()));
            let alone = state.mechanism.layout().constraint_ids();
            let others = alone.map(|id| numbers.least(&lambda, 1.0, Some(id)));
            for other in others.chain([numbers.least(&lambda, 1e3, None)]) {
                for (change, (a, b)) in changes.iter_mut().zip(other.iter().zip(&reference)) {
                    *change = change.max((a - b).abs() / scale);
                }
            }
        }
        let mut counts = [0, 0];
        for (change, (form, _, is_unique)) in changes.iter().zip(&numbers.forms) {
            // The limit is the rounding of the largest value.
            assert_eq!(*change < 1e-9, *is_unique, "{name}: {change:e} {form:?}");
            counts[usize::from(!is_unique)] += 1;
        }
        assert_eq!(counts, [facts, choices], "{name}");
    }
}
