//! Tests verdicts along a motion: on intervals of time, and at the instants with different
//! verdicts. The motion of parallel cranks has a closed form: every crank has the angle θ(t), and
//! the coupler translates. At θ = 0 the configuration is singular.

use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;

use dynamics::{MotionOptions, PreparedMechanism, RowChoice, prepare, simulate};
use joints::RevoluteAngleDrive;
use model::{BodyRef, Drive, Function, Layout, Mechanism, Registry, StartOptions, System};
use pfaff::{RunOptions, Study};
use solvability::{
    AlongError, Continuation, MotionAnalysis, PassageKind, State, Stretches, Verdict, VerdictTrack,
    along_motion,
};
use tests::cranks::cranks;
use tests::robot::{robot, steering};

const LENGTH: f64 = 0.5;
const TWO: [f64; 2] = [0.0, 1.0];
const THREE: [f64; 3] = [0.0, 1.0, 1.7];

/// The state of cranks at angle θ with rate ω.
fn parallel(pivots: &[f64], theta: f64, omega: f64) -> State {
    let (sin, cos) = theta.sin_cos();
    let half = 0.5 * LENGTH;
    let (mut q, mut v) = (Vec::new(), Vec::new());
    for x in pivots {
        q.extend([x + half * cos, half * sin, theta]);
        v.extend([-half * omega * sin, half * omega * cos, omega]);
    }
    let middle = 0.5 * (pivots[0] + pivots[pivots.len() - 1]);
    q.extend([middle + LENGTH * cos, LENGTH * sin, 0.0]);
    v.extend([-LENGTH * omega * sin, LENGTH * omega * cos, 0.0]);
    State { q, v }
}

fn times(from: f64, to: f64, intervals: usize) -> Vec<f64> {
    let step = (to - from) / intervals as f64;
    (0..=intervals).map(|k| from + step * k as f64).collect()
}

fn free(pivots: &[f64]) -> Mechanism {
    Mechanism::build(&cranks(pivots, LENGTH, 1.0)).expect("builds")
}

fn motor(pair: [BodyRef; 2], motion: Function) -> Drive {
    let element = RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    Drive {
        tolerance: None,
        name: "motor".into(),
        bodies: pair.to_vec(),
        element: Box::new(element),
        motion,
    }
}

/// The first crank is driven by θ = θ₀ + f(t) − f(0).
fn driven(pivots: &[f64], start: f64, motion: Function) -> Mechanism {
    let mut d = cranks(pivots, LENGTH, start);
    d.drives
        .push(motor([BodyRef::Ground, BodyRef::Body(0)], motion));
    let mechanism = Mechanism::build(&d).expect("builds");
    let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic);
    p.expect("starts").mechanism
}

/// Returns the only singular configuration of a motion at which the rank drops: time, redundancy
/// there, how the motion continues, and the text.
fn one_drop(along: &MotionAnalysis) -> (f64, usize, Continuation, String) {
    let [passage] = along.passages.as_slice() else {
        panic!("one passage: {:?}", along.passages);
    };
    let PassageKind::RankDrops {
        redundancy,
        continuation,
    } = passage.kind.clone()
    else {
        panic!("the rank drops: {passage:?}");
    };
    (passage.time, redundancy, continuation, passage.text.clone())
}

/// Pseudo-random values in [−1, 1).
fn noise(t: f64, k: usize) -> f64 {
    let mut x = t.to_bits() ^ (k as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    for _ in 0..3 {
        x ^= x >> 31;
        x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    }
    (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

#[test]
fn three_cranks_pass_their_flat_pose_on_one_way() {
    let (start, omega) = (-0.5, 1.3);
    let exact = -start / omega;
    let motion = |t: f64| parallel(&THREE, start + omega * t, omega);
    let by_hand = free(&THREE);
    let by_drive = driven(
        &THREE,
        start,
        Function::constant_rate(omega).expect("finite"),
    );
    for (mechanism, intervals) in [
        (&by_hand, 40),
        (&by_drive, 40),
        (&by_hand, 3),
        (&by_drive, 2),
    ] {
        let along = along_motion(mechanism, motion, &times(0.0, 1.0, intervals)).expect("judged");
        assert_eq!(along.generic.redundancy, 1);
        assert!(along.stretches.is_empty());
        let (time, redundancy, continuation, text) = one_drop(&along);
        assert!((time - exact).abs() < 1e-10, "{time}");
        assert_eq!((redundancy, continuation), (2, Continuation::Unique));
        for part in [
            "rises from 1 to 2",
            "the motion stays unique (second order)",
            "nearly singular from",
        ] {
            assert!(text.contains(part), "{text}");
        }
        let [from, to] = along.passages[0].nearly_singular;
        // The singular value σ is about 0.4·θ.
        assert!(0.3e-3 < exact - from && exact - from < 10e-3, "{from}");
        assert!(((to - exact) / (exact - from) - 1.0).abs() < 1e-2, "{to}");
    }
}

#[test]
fn noise_in_the_states_blurs_the_time_by_as_much() {
    let (start, omega) = (-0.5, 1.3);
    let noisy = |t: f64| {
        let mut state = parallel(&THREE, start + omega * t, omega);
        let numbers = state.q.iter_mut().chain(&mut state.v).enumerate();
        numbers.for_each(|(k, x)| *x += 1e-9 * noise(t, k));
        state
    };
    let along = along_motion(&free(&THREE), noisy, &times(0.0, 1.0, 40)).expect("judged");
    let (time, redundancy, continuation, _) = one_drop(&along);
    assert!((time + start / omega).abs() < 1e-7, "{time}");
    assert_eq!((redundancy, continuation), (2, Continuation::Unique));
}

#[test]
fn two_cranks_bifurcate_also_where_a_sample_hits() {
    let motion = |t: f64| parallel(&TWO, t - 0.5, 1.0);
    let drive = driven(&TWO, -0.5, Function::constant_rate(1.0).expect("finite"));
    for mechanism in [free(&TWO), drive] {
        let along = along_motion(&mechanism, motion, &times(0.0, 1.0, 20)).expect("judged");
        assert_eq!(along.generic.redundancy, 0);
        let (time, redundancy, continuation, text) = one_drop(&along);
        assert!((time - 0.5).abs() < 1e-10, "{time}");
        assert_eq!(redundancy, 1);
        let Continuation::Bifurcation { branches } = continuation else {
            panic!("{continuation:?}");
        };
        assert_eq!(branches.len(), 1);
        // The second-order condition (v2 − v1)·[(v2 + v1)/L − (v2 − v1)/d] = 0 with L = 0.5, d = 1
        // gives v2 = −3·v1.
        assert!(
            (branches[0][5] / branches[0][2] + 3.0).abs() < 1e-8,
            "{branches:?}"
        );
        assert!(
            text.contains("bifurcation") && text.contains("`pivot 1`"),
            "{text}"
        );
        let became: Vec<_> = along.passages[0]
            .differences
            .iter()
            .filter(|d| d.component.is_none())
            .map(|d| (d.reaction.as_str(), d.here.clone()))
            .collect();
        let expected = ["pivot 1", "tip 1", "pivot 2", "tip 2"].map(|j| (j, Verdict::NotUnique));
        assert_eq!(became, expected);
    }
}

/// The motion θ = (t − 0.4)² touches the singular configuration and turns back: no quantity changes
/// its sign.
#[test]
fn a_flat_pose_that_is_only_touched_is_found() {
    let law = |t: f64| (t - 0.4) * (t - 0.4);
    let motion = |t: f64| parallel(&THREE, law(t), 2.0 * (t - 0.4));
    for intervals in [7, 50] {
        let along =
            along_motion(&free(&THREE), motion, &times(0.0, 1.0, intervals)).expect("judged");
        let (time, redundancy, _, _) = one_drop(&along);
        assert!((time - 0.4).abs() < 1e-6, "{time}");
        assert_eq!(redundancy, 2);
    }
}

/// The motion turns back just before the singular configuration. The configuration there is nearly
/// singular; at 1e-9 rad from the singular one, the rank is undecided.
#[test]
fn a_flat_pose_that_is_nearly_reached_is_told_with_its_singular_value() {
    let nearest = |offset: f64| {
        let motion = |t: f64| parallel(&THREE, offset + (t - 0.4) * (t - 0.4), 2.0 * (t - 0.4));
        let along = along_motion(&free(&THREE), motion, &times(0.0, 1.0, 50)).expect("judged");
        assert_eq!(along.generic.redundancy, 1);
        let [passage] = along.passages.as_slice() else {
            panic!("{:?}", along.passages);
        };
        assert!((passage.time - 0.4).abs() < 1e-5, "{}", passage.text);
        passage.kind.clone()
    };
    let sigma = |offset: f64| match nearest(offset) {
        PassageKind::NearlySingular { sigma } => sigma,
        other => panic!("{other:?}"),
    };
    // The singular value σ is proportional to θ.
    assert!((sigma(1e-4) / sigma(1e-5) - 10.0).abs() < 1e-3);
    assert!(matches!(nearest(1e-9), PassageKind::Undecided { .. }));
}

/// Returns the special instants of a component of the verdicts along a motion, with their verdicts.
fn special(along: &MotionAnalysis, reaction: usize, component: &str) -> Vec<(f64, &'static str)> {
    let track = along.verdicts.reactions[reaction].component(component);
    let special = track.expect("a component").special().iter();
    special.map(|s| (s.time, s.verdict.word())).collect()
}

/// In three full revolutions the cranks are in the horizontal singular configuration six times, and
/// upright six times. In the upright positions all forces along them are vertical. In both
/// positions a component is unique that is not unique between them.
#[test]
fn every_flat_pose_and_every_upright_one_of_several_turns() {
    let motion = |t: f64| parallel(&THREE, 0.3 + t, 1.0);
    let joints = cranks(&THREE, LENGTH, 1.0).joints;
    let tip = joints.iter().position(|joint| joint.name == "tip 2");
    let tip = tip.expect("a joint");
    for intervals in [60, 20] {
        let times = times(0.0, 19.0, intervals);
        let along = along_motion(&free(&THREE), motion, &times).expect("judged");
        assert_eq!(along.passages.len(), 6, "{intervals}");
        for (k, p) in along.passages.iter().enumerate() {
            let exact = FRAC_PI_2 * (2 * k + 2) as f64 - 0.3;
            assert!((p.time - exact).abs() < 1e-10, "{}", p.text);
            assert!(matches!(p.kind, PassageKind::RankDrops { .. }));
            let mut differences = p.differences.iter();
            let difference = differences
                .find(|d| d.reaction == "tip 2")
                .expect("differs");
            assert_eq!(difference.component, Some("Fy"));
            assert_eq!(difference.here, Verdict::Unique);
        }
        for (first, component) in [(1, "Fx"), (2, "Fy")] {
            let track = along.verdicts.reactions[tip].component(component);
            let of_run = track.expect("a component").of_run();
            assert_eq!(*of_run, Verdict::NotUnique);
            let found = special(&along, tip, component);
            assert_eq!(found.len(), 6, "{component}: {found:?}");
            for (k, (time, word)) in found.iter().enumerate() {
                let exact = FRAC_PI_2 * (2 * k + first) as f64 - 0.3;
                let is_there = (time - exact).abs() < 1e-10;
                assert!(is_there && *word == "unique", "{found:?}");
            }
        }
    }
    // Samples more than a quarter turn apart do not show upright positions, but they show every
    // change of the rank.
    let along = along_motion(&free(&THREE), motion, &times(0.0, 19.0, 11)).expect("judged");
    assert_eq!(along.passages.len(), 6);
}

/// With θ = π/2 + t⁶ the cranks are upright to rounding for some samples, and for further samples
/// this is undecided. The special instant is the start.
#[test]
fn cranks_that_leave_their_upright_pose_slowly_are_upright_once() {
    let motion = |t: f64| parallel(&THREE, FRAC_PI_2 + t.powi(6), 6.0 * t.powi(5));
    let along = along_motion(&free(&THREE), motion, &times(0.0, 1.0, 300)).expect("judged");
    for reaction in 0..along.verdicts.reactions.len() {
        assert_eq!(special(&along, reaction, "Fx"), [(0.0, "unique")]);
        assert_eq!(special(&along, reaction, "Fy"), []);
    }
}

/// The motion θ = 3·(t − 0.41…)·(t − 0.97) is 1.2 and 0.05 at the two samples and passes zero twice
/// between them.
#[test]
fn a_motion_that_turns_back_between_two_samples_passes_twice() {
    let flat = [0.412_345_678_9, 0.97];
    let motion = |t: f64| {
        let [a, b] = flat.map(|flat| t - flat);
        parallel(&THREE, 3.0 * a * b, 3.0 * (a + b))
    };
    let along = along_motion(&free(&THREE), motion, &[0.0, 1.0]).expect("judged");
    let times: Vec<f64> = along.passages.iter().map(|p| p.time).collect();
    assert_eq!(times.len(), 2, "{times:?}");
    for (time, exact) in times.iter().zip(flat) {
        assert!((time - exact).abs() < 1e-10, "{time}");
    }
    // The text has seven digits of a time that a search has found.
    let text = &along.passages[0].text;
    assert!(text.starts_with("at t = 0.4123457 s "), "{text}");
}

/// Degrees of freedom that are independent of the cranks do not change how the cranks continue.
#[test]
fn a_pendulum_beside_the_cranks() {
    for (pivots, drive) in [
        (&TWO[..], None),
        (&THREE[..], None),
        (&THREE[..], Some(2.0)),
    ] {
        let mut d = cranks(pivots, LENGTH, 1.0);
        let rod = tests::rod("pendulum", 1.0, [5.0, 0.0], [5.0, -1.0]);
        let pendulum = BodyRef::Body(d.bodies.len());
        d.bodies.push(rod);
        let pair = [BodyRef::Ground, pendulum];
        d.joints
            .push(tests::revolute("hinge", &d.bodies, pair, [5.0, 0.0]));
        if let Some(rate) = drive {
            // The pendulum is driven, the cranks rotate freely.
            let motion = Function::constant_rate(rate).expect("finite");
            d.drives.push(motor(pair, motion));
        }
        let mechanism = Mechanism::build(&d).expect("builds");
        let (turn, initial) = (drive.unwrap_or(2.0), -FRAC_PI_2);
        let motion = |t: f64| {
            let mut state = parallel(pivots, t - 0.5, 1.0);
            // The vector points from the hinge to the centre of mass at the prescribed angle −π/2 +
            // 2t.
            let (sin, cos) = (initial + turn * t).sin_cos();
            state
                .q
                .extend([5.0 + 0.5 * cos, 0.5 * sin, initial + turn * t]);
            state.v.extend([-0.5 * turn * sin, 0.5 * turn * cos, turn]);
            state
        };
        let mechanism = match drive {
            None => mechanism,
            Some(_) => {
                let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic);
                p.expect("starts").mechanism
            }
        };
        let along = along_motion(&mechanism, motion, &times(0.0, 0.9, 20)).expect("judged");
        let [p] = along.passages.as_slice() else {
            panic!("{:?}", along.passages);
        };
        let PassageKind::RankDrops { continuation, .. } = &p.kind else {
            panic!("{}", p.text);
        };
        let unique = *continuation == Continuation::Unique;
        assert_eq!(unique, pivots.len() == 3, "{}", p.text);
        assert_eq!(
            p.text.contains("bifurcation"),
            pivots.len() == 2,
            "{}",
            p.text
        );
    }
}

/// A drive rests in the singular configuration: the motion is singular on an interval, which ends
/// at the break time of the drive.
#[test]
fn a_rest_in_a_singular_pose_is_a_stretch() {
    const UNTIL: f64 = 1.012_345_678_912;
    let law = Function::steps(0.0, &[[UNTIL, 2.0, 0.5]]).expect("ordered");
    let mechanism = driven(&THREE, 0.0, law.clone());
    let motion = |t: f64| {
        let [theta, omega, _] = law.jet(t);
        parallel(&THREE, theta, omega)
    };
    let along = along_motion(&mechanism, motion, &times(0.0, 3.0, 15)).expect("judged");
    assert_eq!(along.generic.redundancy, 1);
    let [rest] = along.stretches.as_slice() else {
        panic!("{:?}", along.stretches);
    };
    assert_eq!((rest.from, rest.to, rest.redundancy), (0.0, UNTIL, 2));
    // The text has ten digits of a time that the law prescribes.
    let says = "from t = 0 s to t = 1.012345679 s ";
    assert!(rest.text.starts_with(says), "{}", rest.text);
    assert!(along.passages.is_empty(), "{:?}", along.passages);
}

/// The robot has rank 20 throughout. While it moves straight along the x-axis, the x-rows of B and
/// C are unique. When an edge becomes parallel to the global y-axis, the y-row of its joint is
/// unique for an instant.
#[test]
fn the_robot_has_one_verdict_and_one_stretch_with_another() {
    let mechanism = Mechanism::build(&robot(steering())).expect("builds");
    let p = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts");
    let run = MotionOptions {
        output_step: 0.01,
        ..MotionOptions::to(10.0)
    };
    let (motion, verdicts) = recorded(&p, &run);
    let times = times(0.0, 10.0, 200);
    let along = along_motion(&p.mechanism, motion, &times).expect("judged");
    assert_eq!(along.generic.rank, 20);
    assert!(along.stretches.is_empty() && along.passages.is_empty());
    let layout = p.mechanism.layout();
    let open: Vec<&str> = (along.verdicts.reactions.iter())
        .filter(|r| *r.whole.of_run() == Verdict::NotUnique)
        .map(|r| layout.groups[r.id.0].name.as_str())
        .collect();
    assert_eq!(open, ["B", "C", "W1", "W2", "W3", "W4"]);
    // The robot moves straight up to 1 s: up to that time the forces that are not unique are
    // parallel to y.
    for name in &open {
        let k = layout.groups.iter().position(|g| g.name == *name);
        let k = k.expect("a joint");
        let track = |component| {
            let track = along.verdicts.reactions[k].component(component);
            track.expect("a component")
        };
        assert_eq!(track("Fx").determined(), [[0.0, 1.0]], "{name}");
        assert_eq!(*track("Fx").at(1.0), Verdict::NotUnique, "{name}");
        assert_eq!(track("Fy").determined(), [[0.0; 2]; 0], "{name}");
        // At the end of the straight part the robot still moves straight.
        assert_eq!(special(&along, k, "Fx")[0], (1.0, "unique"), "{name}");
    }
    // Twice within a tenth of a second the edge of the rear wheels is parallel to y, and row 6 (y
    // of C) is in no dependency. The margins of neighbouring samples have one common minimum for
    // both instants.
    let c = layout.groups.iter().position(|g| g.name == "C");
    let found = special(&along, c.expect("a joint"), "Fy");
    for expected in [6.485457, 6.566298] {
        let near = |(t, word): &(f64, &str)| (t - expected).abs() < 1e-4 && *word == "unique";
        assert!(found.iter().any(near), "{expected} in {found:?}");
    }
    assert_agree(&along, &verdicts, layout);
}

/// Runs a mechanism, and returns its motion by cubic interpolation between rows, and the verdicts
/// of the run.
fn recorded(p: &PreparedMechanism, options: &MotionOptions) -> (impl Fn(f64) -> State, Stretches) {
    let mut rows = Vec::new();
    let summary = simulate(p, options, |s| {
        let mut rate = vec![0.0; s.q.len()];
        p.mechanism.rate(s.q, s.v, &mut rate);
        rows.push((s.t, s.q.to_vec(), rate, s.v.to_vec()));
        Ok(ControlFlow::Continue(()))
    });
    let verdicts = summary.expect("moves").verdicts.expect("requested");
    let motion = move |t: f64| {
        let k = rows.partition_point(|r| r.0 <= t).clamp(1, rows.len() - 1);
        let ((a, x, x_rate, v), (b, y, y_rate, w)) = (&rows[k - 1], &rows[k]);
        let (h, u) = (b - a, (t - a) / (b - a));
        let at = |i: usize| {
            let (d, f, g) = (y[i] - x[i], h * x_rate[i], h * y_rate[i]);
            let (c_2, c_3) = (3.0 * d - 2.0 * f - g, f + g - 2.0 * d);
            x[i] + u * (f + u * (c_2 + u * c_3))
        };
        let between = v.iter().zip(w).map(|(v, w)| v + u * (w - v));
        State {
            q: (0..x.len()).map(at).collect(),
            v: between.collect(),
        }
    };
    (motion, verdicts)
}

/// The test uses the motions of all examples, up to 2 s.
#[test]
fn along_the_motion_of_an_example_the_verdicts_are_those_of_its_run() {
    let names = super::examples::files(".toml");
    assert!(names.len() > 30, "{names:?}");
    for name in names {
        let text = super::examples::read(&super::examples::scene(&name));
        let study = Study::read(&name, &text, &Registry::standard(), &RunOptions::default());
        let study = study.unwrap_or_else(|e| panic!("{name}: {e}"));
        let base = study.options.clone().expect("every example says how long");
        let t_end = base.t_end.min(2.0);
        let options = MotionOptions {
            t_end,
            output_step: t_end / 400.0,
            ..base
        };
        let (motion, verdicts) = recorded(&study.prepared, &options);
        let mechanism = &study.prepared.mechanism;
        let along = along_motion(mechanism, motion, &times(0.0, t_end, 100));
        let along = along.unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_agree(&along, &verdicts, mechanism.layout());
        // The motion that the library runs itself gives the same result.
        let own = study.verdicts_along_motion(Some(t_end), |_| {});
        let own = own.unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_agree(&own.along, &verdicts, mechanism.layout());
    }
}

/// The verdicts along a motion equal the verdicts that a run computes from its factors: the same
/// verdict for each component on each interval between events, with the special verdicts at the
/// start. Later rows of a run are less accurate: near a special instant they may count as special.
fn assert_agree(along: &MotionAnalysis, run: &Stretches, layout: &Layout) {
    assert_eq!(along.verdicts.reactions.len(), run.reactions.len());
    for (found, expected) in along.verdicts.reactions.iter().zip(&run.reactions) {
        let name = &layout.groups[found.id.0].name;
        let components = found.components.iter().zip(&expected.components);
        for ((component, found), (_, expected)) in components {
            let words = |track: &VerdictTrack| -> Vec<(f64, f64, &str)> {
                let each = track.stretches().iter();
                each.map(|s| (s.from, s.to, s.verdict.word())).collect()
            };
            assert_eq!(words(found), words(expected), "{name}.{component}");
            let at_start = |track: &VerdictTrack| -> Vec<&str> {
                let special = track.special().iter();
                let special = special.filter(|s| s.time == 0.0 && s.verdict.is_decided());
                special.map(|s| s.verdict.word()).collect()
            };
            assert_eq!(at_start(found), at_start(expected), "{name}.{component}");
        }
    }
}

#[test]
fn bad_input_is_named() {
    let motion = |t: f64| parallel(&TWO, t, 1.0);
    let with = |times: &[f64]| along_motion(&free(&TWO), motion, times).unwrap_err();
    for (times, wrong) in [
        (&[][..], 0),
        (&[0.0], 1),
        (&[0.0, 0.0], 1),
        (&[0.0, f64::NAN], 1),
        (&[f64::INFINITY, 1.0], 0),
    ] {
        let error = with(times);
        assert!(
            matches!(error, AlongError::Times { index, .. } if index == wrong),
            "{error}"
        );
    }
    let short = |_| State {
        q: vec![0.0],
        v: vec![],
    };
    let error = along_motion(&free(&TWO), short, &[0.0, 1.0]).unwrap_err();
    assert!(matches!(error, AlongError::State(_)), "{error}");
    let apart = |_| State {
        q: vec![1e9; 9],
        v: vec![0.0; 9],
    };
    let error = along_motion(&free(&TWO), apart, &[0.0, 1.0]).unwrap_err();
    assert!(
        matches!(error, AlongError::OffConstraints { .. }),
        "{error}"
    );
}
