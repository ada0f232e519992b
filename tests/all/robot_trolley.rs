//! Published results for the robot with its trolley (Wojtyra, Frączek 2013, section 4) with the
//! reconstructed dimensions: ranks, verdicts, motion, reactions, elimination variants.

use std::ops::ControlFlow;

use dynamics::{MotionOptions, PreparedMechanism, RowChoice, prepare, simulate};
use model::{ConfigurationAccuracy, Function, Mechanism, Reaction, Registry, StartOptions, System};
use pfaff::{AssembledScene, RunOptions};
use serde::Deserialize;
use solvability::{Analysis, Solvability, analyse, analyse_known};
use tests::largest;
use tests::robot::{robot, steering};

/// Reference motion, derived twice independently; see the file.
const REFERENCE: &str = include_str!("../reference/robot_trolley.json");

#[derive(Deserialize)]
struct Reference {
    rows: Vec<ReferenceRow>,
}

#[derive(Deserialize)]
struct ReferenceRow {
    t: f64,
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    unique_reactions: std::collections::BTreeMap<String, Vec<f64>>,
}

/// One output row of a run.
struct Row {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    reactions: Vec<Reaction>,
}

fn prepared(rows: &RowChoice) -> PreparedMechanism {
    let mechanism = Mechanism::build(&robot(steering())).expect("the robot builds");
    prepare(mechanism, &StartOptions::default(), rows).expect("the robot starts")
}

fn run(prepared: &PreparedMechanism, options: &MotionOptions) -> (Vec<Row>, dynamics::Summary) {
    let mut rows = Vec::new();
    let summary = simulate(prepared, options, |sample| {
        let (a, reactions) = (
            sample.acceleration()?,
            sample.reactions()?.as_chosen().to_vec(),
        );
        rows.push(Row {
            t: sample.t,
            q: sample.q.to_vec(),
            v: sample.v.to_vec(),
            a,
            reactions,
        });
        Ok(ControlFlow::Continue(()))
    })
    .expect("the robot moves");
    (rows, summary)
}

fn tight() -> MotionOptions {
    MotionOptions {
        rtol: 1e-11,
        atol: 1e-11,
        ..MotionOptions::to(10.0)
    }
}

#[test]
fn the_start_needs_no_correction() {
    let p = prepared(&RowChoice::Automatic);
    assert!(largest(p.assembly.correction.iter().copied()) < 1e-15);
    assert!(largest(p.velocity_correction.iter().copied()) < 1e-15);
}

#[test]
fn motion_agrees_with_the_reference() {
    let reference: Reference = serde_json::from_str(REFERENCE).expect("the reference is JSON");
    let p = prepared(&RowChoice::Automatic);
    let (rows, summary) = run(&p, &tight());
    let groups = &p.mechanism.layout().groups;
    let scale_a = largest(reference.rows.iter().flat_map(|r| r.qdd.iter().copied()));
    let mut worst = [0.0_f64; 4];
    for r in &reference.rows {
        let row = rows
            .iter()
            .find(|row| (row.t - r.t).abs() < 1e-9)
            .expect("a row at each listed time");
        let gap = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(a, b)| a - b));
        worst[0] = worst[0].max(gap(&row.q, &r.q));
        worst[1] = worst[1].max(gap(&row.v, &r.qd));
        worst[2] = worst[2].max(gap(&row.a, &r.qdd) / scale_a);
        for (name, expected) in &r.unique_reactions {
            let at = groups
                .iter()
                .position(|g| g.name == *name)
                .expect("the joint exists");
            let found = &row.reactions[at];
            let scale = largest(
                reference
                    .rows
                    .iter()
                    .flat_map(|r| r.unique_reactions[name].iter().copied()),
            );
            let mut values = vec![found.force[0], found.force[1], found.torque[2]];
            values.extend(found.component);
            values.truncate(expected.len());
            worst[3] = worst[3].max(gap(&values, expected) / scale);
        }
    }
    assert!(worst[0] <= 1e-9 && worst[1] <= 1e-9, "state: {worst:?}");
    assert!(worst[2] <= 1e-7, "accelerations: {worst:?}");
    assert!(worst[3] <= 1e-7, "unique reactions: {worst:?}");
    let limit = 1e-12;
    assert!(summary.max_position_residual <= limit && summary.max_velocity_residual <= limit);
}

#[test]
fn variants_differ_in_non_unique_reactions_only() {
    let drops = [[6, 21], [18, 21], [19, 21]];
    let runs: Vec<(PreparedMechanism, Vec<Row>)> = drops
        .iter()
        .map(|d| {
            let choice = RowChoice::Drop(d.iter().map(|r| r - 1).collect());
            let p = prepared(&choice);
            let (rows, summary) = run(
                &p,
                &MotionOptions {
                    rows: choice,
                    ..tight()
                },
            );
            let limit = 1e-12;
            assert!(
                summary.max_position_residual <= limit && summary.max_velocity_residual <= limit
            );
            (p, rows)
        })
        .collect();
    let groups = &runs[0].0.mechanism.layout().groups;
    for pair in [(0, 1), (0, 2), (1, 2)] {
        let (a, b) = (&runs[pair.0].1, &runs[pair.1].1);
        let mut motion = 0.0_f64;
        let mut differences = vec![0.0_f64; groups.len()];
        for (x, y) in a.iter().zip(b) {
            motion = motion.max(largest(x.q.iter().zip(&y.q).map(|(x, y)| x - y)));
            motion = motion.max(largest(x.v.iter().zip(&y.v).map(|(x, y)| x - y)));
            for (d, (r, s)) in differences
                .iter_mut()
                .zip(x.reactions.iter().zip(&y.reactions))
            {
                let parts = [
                    r.force[0] - s.force[0],
                    r.force[1] - s.force[1],
                    r.torque[2] - s.torque[2],
                ];
                *d = d.max(largest(parts));
            }
        }
        assert!(motion <= 1e-10, "variants {pair:?}: {motion:e}");
        for (group, d) in groups.iter().zip(&differences) {
            let differs = ["B", "C", "W1", "W2", "W3", "W4"].contains(&group.name.as_str());
            if group.name == "W4" {
                // The row is redundant in all three variants, and so its multiplier is zero by
                // definition.
                assert_eq!(*d, 0.0);
            } else if differs {
                assert!(*d > 1.0, "{} is the same in {pair:?}", group.name);
            } else {
                assert!(
                    *d <= 1e-8,
                    "{} differs by {d:e} between {pair:?}",
                    group.name
                );
            }
        }
    }
}

/// Asserts the results that hold at every configuration of the motion.
fn assert_facts(analysis: &Analysis) {
    assert_eq!(analysis.rank_holonomic, 17);
    assert_eq!(analysis.rank_nonholonomic, 4);
    assert_eq!(analysis.decision.rank, 20);
    assert_eq!(analysis.decision.redundancy, 2);
    assert_eq!(analysis.mobility(), 1);
    for r in &analysis.reactions {
        let not_unique = ["B", "C", "W1", "W2", "W3", "W4"].contains(&r.name.as_str());
        let expected = if not_unique { "not_unique" } else { "unique" };
        assert_eq!(
            r.wrench.verdict.word(),
            expected,
            "{} at t = {}: {:?}",
            r.name,
            analysis.time,
            r.wrench
        );
    }
}

#[test]
fn ranks_and_verdicts_hold_along_the_motion() {
    let p = prepared(&RowChoice::Automatic);
    let (rows, _) = run(
        &p,
        &MotionOptions {
            output_step: 0.05,
            ..tight()
        },
    );
    assert_eq!(rows.len(), 201);
    for row in &rows {
        assert_facts(&analyse(&p.mechanism, row.t, &row.q).expect("C is finite"));
    }
}

/// Returns pairs of rows (from 1) whose deletion does not change the motion.
fn admissible_pairs(p: &PreparedMechanism, t: f64, q: &[f64]) -> Vec<[usize; 2]> {
    let mut s = p.mechanism.scratch();
    p.mechanism.pose(t, q, &mut s);
    p.mechanism.c(&mut s);
    let c = p.mechanism.layout().dense(&s);
    let mut pairs = Vec::new();
    for a in 0..22 {
        for b in a + 1..22 {
            if rank::decide_dropping(&c, rank::Accuracy::Rounding, &[a, b]).is_ok() {
                pairs.push([a + 1, b + 1]);
            }
        }
    }
    pairs
}

fn product(left: &[usize]) -> Vec<[usize; 2]> {
    let mut pairs: Vec<[usize; 2]> = left.iter().flat_map(|&a| [[a, 20], [a, 21]]).collect();
    pairs.push([20, 21]);
    pairs.sort_unstable();
    pairs
}

fn non_unique_rows(analysis: &Analysis) -> Vec<usize> {
    let rows = analysis.reactions.iter().flat_map(|r| &r.rows);
    let mut found: Vec<usize> = rows
        .filter(|r| !r.judgement.verdict.is_unique())
        .map(|r| r.row + 1)
        .collect();
    found.sort_unstable();
    found
}

#[test]
fn rows_and_admissible_pairs_depend_on_the_angle_of_the_edges() {
    let p = prepared(&RowChoice::Automatic);
    let (rows, _) = run(&p, &tight());
    let at = |t: f64| {
        rows.iter()
            .find(|r| (r.t - t).abs() < 1e-9)
            .expect("a row at this time")
    };
    for t in [0.0, 0.5, 1.0] {
        let row = at(t);
        let analysis = analyse(&p.mechanism, t, &row.q).expect("C is finite");
        assert_eq!(
            non_unique_rows(&analysis),
            [4, 6, 18, 19, 20, 21],
            "t = {t}"
        );
        assert_eq!(
            admissible_pairs(&p, t, &row.q),
            product(&[4, 6, 18, 19]),
            "t = {t}"
        );
    }
    for t in [1.5, 2.5, 5.0, 7.0, 9.5] {
        let row = at(t);
        let analysis = analyse(&p.mechanism, t, &row.q).expect("C is finite");
        assert_eq!(
            non_unique_rows(&analysis),
            [3, 4, 5, 6, 18, 19, 20, 21],
            "t = {t}"
        );
        assert_eq!(
            admissible_pairs(&p, t, &row.q),
            product(&[3, 4, 5, 6, 18, 19]),
            "t = {t}"
        );
    }
}

#[test]
fn steered_edges_at_a_right_angle_split_the_circuits() {
    for displacement in [-0.135_153_013_442_6, 0.089_750_156_055_0] {
        // The drive moves the slider at rest: there is no other velocity, so that the platform does
        // not move.
        let ramp = Function::steps(0.0, &[[0.0, 1.0, displacement]]).expect("a step");
        let mut description = robot(ramp);
        for body in &mut description.bodies {
            body.velocity = None;
        }
        let mechanism = Mechanism::build(&description).expect("the robot builds");
        let p =
            prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("starts");
        let mut q = Vec::new();
        let options = MotionOptions {
            output_step: 1.0,
            rtol: 1e-12,
            atol: 1e-12,
            ..MotionOptions::to(1.0)
        };
        simulate(&p, &options, |s| {
            q = s.q.to_vec();
            Ok(ControlFlow::Continue(()))
        })
        .expect("the robot steers at rest");
        // The displacement is accurate to 13 digits, and so are the angles of the edges.
        let analysis = analyse_known(&p.mechanism, 1.0, &q, ConfigurationAccuracy::To(1e-12))
            .expect("C is finite");
        assert_eq!(non_unique_rows(&analysis), [3, 5, 18, 19, 20, 21]);
        assert_eq!(analysis.decision.rank, 20);
        let components = rank::components(&analysis.whole().expect("one part"));
        assert_eq!(components.coupled, [vec![2, 4, 17, 18], vec![19, 20]]);
        let (c, _) = solvability_at(&p, 1.0, &q);
        let (w3, w4) = (19, 20);
        let others: Vec<usize> = (0..22).filter(|&i| i != w4).collect();
        let without_w4 = Solvability::of(&c.select_rows(&others), rank::Accuracy::Rounding)
            .expect("C is finite");
        assert_eq!(without_w4.row(w3).expect("a row").verdict.word(), "unique");
        assert_eq!(admissible_pairs(&p, 1.0, &q), {
            let mut pairs = product(&[3, 5, 18, 19]);
            pairs.retain(|p| *p != [20, 21]);
            pairs
        });
    }
}

/// Returns C at a configuration, and the verdicts on its multipliers.
fn solvability_at(p: &PreparedMechanism, t: f64, q: &[f64]) -> (linalg::Matrix, Solvability) {
    let mut s = p.mechanism.scratch();
    p.mechanism.pose(t, q, &mut s);
    p.mechanism.c(&mut s);
    let c = p.mechanism.layout().dense(&s);
    let solvability = Solvability::of(&c, rank::Accuracy::Rounding).expect("C is finite");
    (c, solvability)
}

#[test]
fn directions_and_sums_that_are_unique() {
    let p = prepared(&RowChoice::Automatic);
    let (rows, _) = run(&p, &tight());
    let row = rows
        .iter()
        .find(|r| (r.t - 1.5).abs() < 1e-9)
        .expect("a row at this time");
    let (_, s) = solvability_at(&p, row.t, &row.q);
    let front = row.q[5];
    let (edge, normal) = ([front.cos(), front.sin()], [-front.sin(), front.cos()]);
    let (b, w1, w3, w4) = (2..4, 17, 19, 20);
    let frame = linalg::Matrix::from_rows(&[edge, normal]);
    assert_eq!(
        s.component(&frame, 0, b.clone())
            .expect("rows exist")
            .verdict
            .word(),
        "unique",
        "B along the edge of W1"
    );
    assert_eq!(
        s.component(&frame, 1, b)
            .expect("rows exist")
            .verdict
            .word(),
        "not_unique",
        "B across the edge of W1"
    );
    for k in 0..2 {
        // On the knuckle the force is +λ_B of the joint and −λ·n of the edge.
        let mut sum = vec![0.0; 22];
        (sum[2 + k], sum[w1]) = (1.0, -normal[k]);
        assert_eq!(
            s.combination(&sum).expect("rows exist").verdict.word(),
            "unique",
            "B + W1, component {k}"
        );
    }
    let mut sum = vec![0.0; 22];
    (sum[w3], sum[w4]) = (1.0, 1.0);
    assert_eq!(
        s.combination(&sum).expect("rows exist").verdict.word(),
        "not_unique",
        "W3 + W4"
    );
}

#[test]
fn near_the_axis_the_margin_is_the_sine_of_the_angle() {
    let p = prepared(&RowChoice::Automatic);
    let (rows, _) = run(&p, &tight());
    let row = rows
        .iter()
        .find(|r| (r.t - 1.1).abs() < 1e-9)
        .expect("a row at this time");
    let (_, s) = solvability_at(&p, row.t, &row.q);
    let (x, y) = (
        s.row(2).expect("row 2").margin,
        s.row(3).expect("row 3").margin,
    );
    let front = row.q[5];
    assert!(front.abs() < 0.01, "{front}");
    assert!(
        (x / x.hypot(y) - front.sin().abs()).abs() < 1e-9 * front.abs(),
        "{x} {y} {front}"
    );
}

/// Rows between steps come from dense output and are then projected: they must be as accurate as
/// the steps.
#[test]
fn written_rows_are_as_accurate_as_steps() {
    let p = prepared(&RowChoice::Automatic);
    let every = 0.01;
    let (exact, _) = run(
        &p,
        &MotionOptions {
            output_step: every,
            ..tight()
        },
    );
    let coarse = MotionOptions {
        rtol: 1e-6,
        atol: 1e-6,
        output_step: every,
        ..MotionOptions::to(10.0)
    };
    let (rows, summary) = run(&p, &coarse);
    assert!(
        summary.steps < 200,
        "about ten rows in each step: {}",
        summary.steps
    );
    let error = |k: usize| {
        let (a, b) = (&rows[k], &exact[k]);
        largest(
            a.q.iter()
                .zip(&b.q)
                .chain(a.v.iter().zip(&b.v))
                .map(|(a, b)| a - b),
        )
    };
    // Steps end at the break times of the drive, and at the end time.
    let steps = [1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0, 9.0, 10.0];
    let at_steps = steps.map(|t: f64| error((t / every).round() as usize));
    let worst_step = largest(at_steps);
    let worst_row = largest((0..rows.len()).map(error));
    assert!(
        worst_step > 1e-9,
        "the run is coarse enough to compare: {worst_step:e}"
    );
    assert!(
        worst_row <= 2.0 * worst_step,
        "rows {worst_row:e}, steps {worst_step:e}"
    );
}

/// A table has a row at a time, and the same time is analysed: both are bitwise the same state, so
/// the values of the reactions are the same.
#[test]
fn a_row_of_a_table_is_the_state_that_is_analysed_there() {
    let text = include_str!("../../crates/suite/scenes/robot-trolley.toml");
    let assembled = AssembledScene::read("robot.toml", text, &Registry::standard());
    let study = assembled.and_then(|scene| scene.prepare(&RunOptions::default()));
    let study = study.expect("the robot starts");
    let options = study.options.clone().expect("the scene states its end");
    let mut rows = Vec::new();
    let ended = simulate(&study.prepared, &options, |sample| {
        rows.push((sample.t, sample.q.to_vec(), sample.v.to_vec()));
        Ok(ControlFlow::Continue(()))
    });
    ended.expect("the robot moves");
    let count = rows.len();
    for k in [1, count / 3, count / 2, 3 * count / 5, count - 1] {
        let (t, q, v) = &rows[k];
        let state = study.state_until(*t, &|| false).expect("it is reached");
        assert_eq!((&state.q, &state.v), (q, v), "t = {t} s");
    }
}
