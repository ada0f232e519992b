//! Documents of mechanisms in space: a reaction has six components, a direction six numbers, and a
//! point three coordinates.

use std::sync::Arc;

use joints::space3::{Axes, Revolute};
use model::{BodyRef, ConstraintId, Mechanism, SpatialBody, SpatialDescription, System};
use serde_json::{Value, json};
use solvability::{Group, Questions, analyse};

use super::super::{AnalysisDocument, GroupDocument};

/// The planar four-bar A(0, 0), B(.3, .8), C(1.5, 1.1), D(1.4, 0) has four revolutes along z; the
/// ground is the first body of A and the rocker is the first body of D. The frame of the crank is
/// at A.
fn four_bar() -> Mechanism {
    let mut d = SpatialDescription::new("four-bar");
    let tensor = [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]];
    let mut bar = |name: &str, position: [f64; 3], centre: [f64; 3]| {
        d.body(SpatialBody {
            position,
            centre,
            ..SpatialBody::new(name, 1.0, tensor)
        })
    };
    let crank = bar("crank", [0.0; 3], [0.15, 0.4, 0.0]);
    let coupler = bar("coupler", [0.9, 0.95, 0.0], [0.0; 3]);
    let rocker = bar("rocker", [1.45, 0.55, 0.0], [0.0; 3]);
    for (name, bodies, at) in [
        ("A", [BodyRef::Ground, crank], [0.0, 0.0, 0.0]),
        ("B", [crank, coupler], [0.3, 0.8, 0.0]),
        ("C", [coupler, rocker], [1.5, 1.1, 0.0]),
        ("D", [rocker, BodyRef::Ground], [1.4, 0.0, 0.0]),
    ] {
        let [s_i, s_j] = bodies.map(|body| d.local(body, at));
        let hinge = Revolute {
            s_i,
            s_j,
            axis: Axes::FRAME,
            axis_j: Axes::FRAME,
        };
        d.joint(name, &bodies, hinge);
    }
    Mechanism::build(&d).expect("a four-bar")
}

/// Returns the document with all results, and the document of the sum of A and D.
fn documents(mechanism: &Mechanism) -> (Value, Value) {
    let (q, _) = mechanism.described_state();
    let analysis = analyse(mechanism, 0.0, &q).expect("a configuration");
    let questions = Questions::new(mechanism, &q, Arc::new(analysis.clone()));
    let freedoms = analysis
        .freedoms(mechanism, &q)
        .expect("the same configuration");
    let mut document =
        AnalysisDocument::new("four-bar", &analysis, None).with_freedoms(&freedoms, mechanism);
    let explanation = questions.explanation().expect("small").expect("decided");
    document.explain(&explanation, mechanism.layout());
    let joints = mechanism.layout().constraint_ids();
    for (id, reaction) in joints.zip(&mut document.reactions) {
        let frames = questions.frames(id).expect("small");
        reaction.frames = frames.iter().map(Into::into).collect();
    }
    let sum = Group::WrenchSum(vec![(1.0, ConstraintId(0)), (-1.0, ConstraintId(3))]);
    let sum = GroupDocument::new("A - D", &questions.group(&sum).expect("small"));
    let [document, sum] = [serde_json::to_value(document), serde_json::to_value(sum)]
        .map(|value| value.expect("serializes"));
    (document, sum)
}

/// Returns `[name, verdict]` of components.
fn verdicts(components: &Value) -> Vec<[&str; 2]> {
    let components = components.as_array().expect("a list").iter();
    let text = |c: &Value, key: &str| c[key].as_str().expect("a text").to_owned();
    components
        .map(|c| {
            assert!(!text(c, "name").is_empty());
            [
                c["name"].as_str().expect("a text"),
                c["verdict"].as_str().expect("a text"),
            ]
        })
        .collect()
}

/// V3: Fx and Fy are unique, Fz, Tx and Ty are not, and Tz is zero.
#[test]
fn an_analysis_in_space_has_forces_and_moments() {
    let (d, sum) = documents(&four_bar());
    assert_eq!(
        [
            &d["coordinates"],
            &d["rank"],
            &d["redundancy"],
            &d["mobility"]
        ],
        [21, 17, 3, 1]
    );
    let b = &d["reactions"][1];
    let [u, n] = ["unique", "not_unique"];
    let expected = [
        ["Fx", u],
        ["Fy", u],
        ["Fz", n],
        ["Tx", n],
        ["Ty", n],
        ["Tz", u],
    ];
    assert_eq!(verdicts(&b["components"]), expected);
    let directions = json!([
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]
    ]);
    assert_eq!(b["unique_directions"], directions);
    // The body is not rotated, and its axes are parallel to those of the joint.
    let names = [
        ("global", ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"]),
        ("first_body", ["Fx'", "Fy'", "Fz'", "Tx'", "Ty'", "Tz'"]),
        ("joint", ["Fu", "Fv", "Fw", "Tu", "Tv", "Tw"]),
    ];
    let frames = b["frames"].as_array().expect("a list");
    assert_eq!(frames.len(), names.len());
    for (found, (frame, names)) in frames.iter().zip(names) {
        assert_eq!(found["frame"], frame);
        let expected = [u, u, n, n, n, u];
        let expected: Vec<[&str; 2]> = names.into_iter().zip(expected).map(Into::into).collect();
        assert_eq!(verdicts(&found["components"]), expected);
        assert_eq!(
            found["axes"],
            json!([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        );
    }
    // A force f along z through D has the moment (1.1, −0.1)·f about C.
    let own = &d["reactions"][2]["free_directions"];
    let through_d = own.as_array().expect("a list").last().expect("three loads");
    assert_eq!(through_d["place"], json!([1.5, 1.1, 0.0]));
    let load = ["force", "torque"].map(|key| -> Vec<f64> {
        let numbers = through_d[key].as_array().expect("three numbers").iter();
        numbers.map(|x| x.as_f64().expect("a number")).collect()
    });
    let f = load[0][2];
    let derived = [[0.0, 0.0, f], [-1.1 * f, 0.1 * f, 0.0]];
    for (x, y) in load.iter().flatten().zip(derived.as_flattened()) {
        assert!((x - y).abs() < 1e-12 && f.abs() == 1.0, "{load:?}");
    }
    let words = "`A`, `B`, `C` and `D` share 3 load components that equilibrium does not determine (a load across \
        the plane of the linkage (force along z and two moments))";
    assert_eq!(d["mixing"][0]["text"], words);
    assert_eq!(sum["about"], json!([0.0, 0.0, 0.0]));
    assert_eq!(sum["components"].as_array().map(Vec::len), Some(6));
}

/// The crank turns about A, the origin of its frame; `wz` of the coupler is −1/5.16 times that of
/// the crank.
#[test]
fn free_motions_in_space_are_written_for_frames() {
    let (d, _) = documents(&four_bar());
    let motion = &d["free_motions"][0];
    let words = "`crank` turns about the axis through `A` along (0, 0, 1); with it `coupler` turns about the axis \
        through (1.848, 4.928, 0) m along (0, 0, −1) and `rocker` turns about the axis through `D` along (0, 0, 1)";
    assert_eq!(motion["text"], words);
    let v = &motion["velocities"][0];
    assert_eq!(v["crank"], json!([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]));
    let omega = v["coupler"][5].as_f64().expect("a number");
    assert!((omega + 1.0 / 5.16).abs() < 1e-12, "{omega}");
    assert_eq!(d["free_motions_left_out"], Value::Null);
}
