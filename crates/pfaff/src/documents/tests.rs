//! Compares whole documents of small runs, byte for byte.

mod space;

use dynamics::{
    DropError, DroppedRows, Event, EventKind, Method, MotionError, MotionOptions, OutputRequest,
    Plan, PreparedMechanism, RowChoice, Summary, prepare,
};
use joints::{Revolute, RevoluteAngleDrive};
use linalg::Matrix;
use model::{
    Body, BodyRef, ConstraintId, DataUnit, Description, Function, Joint, Mechanism, SpaceKind,
    StartOptions, Tolerance,
};
use rank::{Certificate, Doubt, Evidence, Grounds, NearlyRedundant, RankDecision, RankStatus};
use serde_json::Value;
use solvability::{
    Analysis, ComponentVerdict, Datum, Dependency, Extent, Freedoms, Generic, Judgement,
    PartAnalysis, PartDecision, ReactionSensitivities, ReactionVerdict, RowVerdict, Sensitivities,
    Sensitivity, Stretches, Verdict, VerdictStretch, VerdictTrack, analyse,
};

use report::peaks::Peak;
use report::tables::{Selection, columns_of_reactions};

use crate::peaks_of_run::FoundPeaks;

use super::{
    AnalysisDocument, DataDocument, Ending, FreedomsDocument, Run, RunDocument, RunVerdicts,
};
use report::write_json;

fn judged(verdict: Verdict, margin: f64) -> Judgement {
    Judgement::new(verdict, margin)
}

/// A door on two hinges, with round numbers for the evidence.
fn analysis() -> Analysis {
    certified(None)
}

/// Returns the analysis of the door with this certificate.
fn certified(certificate: Option<Certificate>) -> Analysis {
    let c = Matrix::from_rows(&[
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 0.0],
    ]);
    let decision = RankDecision {
        kept: vec![0, 1, 2],
        dropped: vec![3],
        evidence: Evidence {
            singular_values: vec![2.0, 1.0, 0.5, 0.0],
            sigma_r: 0.5,
            sigma_next: 0.0,
            gap: f64::INFINITY,
            tolerance: 0.25,
            constraint_residual: 0.0,
            dependence_residual: 0.0,
            certificate: None,
        },
        ..rank::decide(&c, rank::Accuracy::Rounding).expect("finite")
    };
    Analysis {
        time: 0.5,
        bodies: 1,
        coordinates: 3,
        velocities: 3,
        size: 2.0,
        tolerance: Tolerance {
            length: Some(0.25),
            angle: None,
        },
        nearly_redundant: None,
        holonomic_rows: 4,
        nonholonomic_rows: 0,
        rank_holonomic: 3,
        rank_nonholonomic: 0,
        decision: (&decision).into(),
        parts: vec![PartAnalysis {
            extent: Extent::Whole,
            size: 2.0,
            rank_holonomic: 3,
            rank_nonholonomic: 0,
            without_drives: None,
            nearly_redundant: None,
            certificate,
            decision: PartDecision::Dense(Box::new(decision)),
        }],
        reactions: vec![reaction("upper", 0), reaction("lower \"2\"", 2)],
        dependencies: vec![Dependency {
            left_out: 0.0,
            rows: vec![1, 3],
            coefficients: vec![1.0, -1.0],
            text: "both hold the height".into(),
        }],
        warnings: Vec::new(),
    }
}

fn reaction(name: &str, row: usize) -> ReactionVerdict {
    let both = [
        judged(Verdict::Unique, 0.0),
        judged(Verdict::NotUnique, 0.5),
    ];
    let rows = both.iter().enumerate().map(|(k, j)| RowVerdict {
        row: row + k,
        judgement: j.clone(),
    });
    let components = ["Fx", "Fy"].into_iter().zip(&both);
    ReactionVerdict {
        id: ConstraintId(row / 2),
        name: name.into(),
        space: SpaceKind::Plane,
        kind: "revolute",
        wrench: both[1].clone(),
        multipliers: both[1].clone(),
        rows: rows.collect(),
        components: components
            .map(|(name, j)| ComponentVerdict {
                name,
                judgement: j.clone(),
            })
            .collect(),
        zero_components: Vec::new(),
        unique_directions: vec![vec![1.0, 0.0]],
        live_directions: Some(vec![vec![1.0, 0.0]]),
        directions_left_out: 0.0,
    }
}

fn json(document: &impl serde::Serialize) -> String {
    let mut bytes = Vec::new();
    write_json(&mut bytes, document).expect("memory takes everything");
    let text = String::from_utf8(bytes).expect("JSON is UTF-8");
    // Every document begins with this head; the test compares the rest.
    let head = concat!(
        "{\n  \"format\": 2,\n  \"version\": \"",
        env!("CARGO_PKG_VERSION"),
        "\",\n"
    );
    let rest = text.strip_prefix(head).expect("a head");
    format!("{{\n{rest}")
}

/// Removes the white space of indentation from the golden text, which is indented to be readable
/// here.
fn squeezed(text: &str) -> String {
    let value: Value = serde_json::from_str(text).expect("valid JSON");
    value.to_string()
}

#[test]
fn analysis_has_the_keys_of_the_contract() {
    let found = json(&AnalysisDocument::new("door", &analysis(), None));
    let expected = r#"{
        "scene": "door", "time": 0.5, "bodies": 1, "coordinates": 3, "velocities": 3, "rows": 4,
        "holonomic_rows": 4, "nonholonomic_rows": 0,
        "rank": 3, "rank_holonomic": 3, "rank_nonholonomic": 0, "redundancy": 1, "mobility": 0,
        "without_drives": null, "free_motions": [], "cannot_move": null,
        "kept_rows": [1, 2, 3], "dropped_rows": [4],
        "data": { "tolerance": 0.25, "angle_tolerance": 0.125, "lower_rank_from": null, "lower_rank_from_angle": null, "lower_rank_here": null },
        "evidence": { "status": "decided", "sigma_r": 0.5, "sigma_next": 0.0, "gap": null,
            "tolerance": 0.25, "constraint_residual": 0.0, "permanent": null, "certified": false,
            "rank_at_least": null, "sigma_bound": null, "sigma_next_extended": null, "grounds": null,
            "uncertainty": null, "nearly_redundant": null },
        "generic": null,
        "reactions": [
            { "name": "upper", "type": "revolute", "rows": [1, 2],
              "verdict": "not_unique", "margin": 0.5, "within_tolerance": false, "generic_verdict": null, "sensitivity": null, "fragile": false, "multipliers": "not_unique",
              "row_verdicts": [ { "row": 1, "verdict": "unique", "margin": 0.0, "within_tolerance": false },
                                { "row": 2, "verdict": "not_unique", "margin": 0.5, "within_tolerance": false } ],
              "components": [ { "name": "Fx", "verdict": "unique", "margin": 0.0, "within_tolerance": false, "generic_verdict": null, "sensitivity": null, "fragile": false },
                              { "name": "Fy", "verdict": "not_unique", "margin": 0.5, "within_tolerance": false, "generic_verdict": null, "sensitivity": null, "fragile": false } ],
              "unique_directions": [[1.0, 0.0]],
              "settled": null, "explanation": null, "free_directions": [] },
            { "name": "lower \"2\"", "type": "revolute", "rows": [3, 4],
              "verdict": "not_unique", "margin": 0.5, "within_tolerance": false, "generic_verdict": null, "sensitivity": null, "fragile": false, "multipliers": "not_unique",
              "row_verdicts": [ { "row": 3, "verdict": "unique", "margin": 0.0, "within_tolerance": false },
                                { "row": 4, "verdict": "not_unique", "margin": 0.5, "within_tolerance": false } ],
              "components": [ { "name": "Fx", "verdict": "unique", "margin": 0.0, "within_tolerance": false, "generic_verdict": null, "sensitivity": null, "fragile": false },
                              { "name": "Fy", "verdict": "not_unique", "margin": 0.5, "within_tolerance": false, "generic_verdict": null, "sensitivity": null, "fragile": false } ],
              "unique_directions": [[1.0, 0.0]],
              "settled": null, "explanation": null, "free_directions": [] } ],
        "groups": [],
        "dependencies": [ { "rows": [2, 4], "joints": ["upper", "lower \"2\""],
            "coefficients": [1.0, -1.0], "text": "both hold the height" } ],
        "mixing": [],
        "notes": [],
        "warnings": [] }"#;
    assert_eq!(squeezed(&found), squeezed(expected));
    assert!(found.starts_with("{\n  \"scene\": \"door\",\n  \"time\": 0.5,"));
    assert!(found.ends_with("}\n"));
}

fn certificate(grounds: Grounds) -> Certificate {
    Certificate {
        rank_at_least: 3,
        sigma_bound: 0.375,
        sigma_next: 0.0,
        grounds,
        uncertainty: 0.0,
        spread: 0.0,
        row_noise: Vec::new(),
        lower_rank_by_angles: false,
        row_data: None,
        row_turn: None,
        open_rows: Vec::new(),
        has_tolerance: false,
        nearly_redundant: None,
        lower_rank_here: None,
        lower_rank_from: None,
    }
}

#[test]
fn a_certificate_proves_a_decided_rank_that_it_reaches() {
    let told = |certificate: Certificate| {
        AnalysisDocument::new("door", &certified(Some(certificate)), None).evidence
    };
    for (grounds, word) in [
        (Grounds::FullRank, "full_rank"),
        (Grounds::Exact, "exact"),
        (Grounds::Vanishes, "vanishes"),
        (Grounds::WithinData, "within_data"),
    ] {
        let evidence = told(certificate(grounds));
        assert!(evidence.certified);
        assert_eq!(evidence.grounds, Some(word));
        assert_eq!(evidence.sigma_bound, Some(0.375));
    }
    // A point displaced by a micrometre in a mechanism of 2 m with σ_r = 1e-4.
    let near = Analysis {
        nearly_redundant: Some(NearlyRedundant {
            sigma: 1e-4,
            direction: vec![0.0, 0.0, 1.0, 0.0],
        }),
        ..analysis()
    };
    let change = AnalysisDocument::new("door", &near, None)
        .evidence
        .nearly_redundant
        .expect("is told")
        .change_per_micrometre;
    assert!((change - 5e-3).abs() < 1e-12, "{change}");
    let weaker = Certificate {
        rank_at_least: 2,
        ..certificate(Grounds::Vanishes)
    };
    assert!(!told(weaker).certified);
}

#[test]
fn permanent_means_the_same_redundancy_elsewhere() {
    for (redundancy, permanent) in [(1, true), (0, false)] {
        let generic = Generic {
            redundancy,
            points: Vec::new(),
        };
        let document = AnalysisDocument::new("door", &analysis(), Some(&generic));
        assert_eq!(document.evidence.permanent, Some(permanent));
    }
}

#[test]
fn an_undecided_rank_says_why() {
    let doubt = Doubt::NotPolished {
        sigma_max: 1.0,
        tolerance: 2.0,
    };
    let mut analysis = certified(Some(certificate(Grounds::Vanishes)));
    analysis.decision.status = RankStatus::Undecided(doubt);
    if let PartDecision::Dense(decision) = &mut analysis.parts[0].decision {
        decision.status = RankStatus::Undecided(doubt);
    }
    let reason = "the numbers do not decide".to_owned();
    analysis.reactions[0].wrench = judged(Verdict::Undecided { reason }, f64::NAN);
    let generic = Generic {
        redundancy: 1,
        points: Vec::new(),
    };
    let document = AnalysisDocument::new("door", &analysis, Some(&generic));
    let document: Value =
        serde_json::from_str(&json(&document)).expect("valid JSON in spite of NaN");
    let evidence = &document["evidence"];
    assert_eq!(evidence["status"], "undecided");
    assert_eq!(evidence["reason"], doubt.to_string());
    // A proved bound stays proved, but does not decide an undecided rank.
    assert_eq!(evidence["rank_at_least"], 3);
    assert_eq!(
        (&evidence["permanent"], &evidence["certified"]),
        (&Value::Null, &false.into())
    );
    assert_eq!(evidence["grounds"], Value::Null);
    let upper = &document["reactions"][0];
    assert_eq!(upper["verdict"], "undecided");
    assert_eq!(upper["reason"], "the numbers do not decide");
    assert_eq!(upper["margin"], Value::Null);
}

/// The freedoms of the door.
fn freedoms(prepared: &PreparedMechanism) -> Freedoms {
    let (mechanism, q) = (&prepared.mechanism, &prepared.q);
    let analysis = analyse(mechanism, 0.0, q).expect("the door hangs");
    analysis.freedoms(mechanism, q).expect("its start")
}

/// The same door as a mechanism at rest.
fn prepared() -> PreparedMechanism {
    let hinge = |name: &str, y: f64| {
        let element = Revolute {
            s_i: [0.0, y],
            s_j: [-0.5, y],
        };
        Joint::new(name, &[BodyRef::Ground, BodyRef::Body(0)], element)
    };
    let door = Description {
        name: "door".into(),
        bodies: vec![Body {
            name: "leaf".into(),
            mass: 1.0,
            inertia: 1.0,
            position: [0.5, 0.0],
            ..Body::default()
        }],
        joints: vec![hinge("upper", 1.0), hinge("lower", -1.0)],
        ..Description::default()
    };
    let mechanism = Mechanism::build(&door).expect("the door builds");
    let rows = RowChoice::Drop(vec![3]);
    prepare(mechanism, &StartOptions::default(), &rows).expect("the door hangs")
}

/// A plan of two seconds of the motion of the door.
fn planned(prepared: &PreparedMechanism) -> Plan<'_> {
    Plan::new(prepared, &MotionOptions::to(2.0), &OutputRequest::default())
        .expect("the door has a plan")
}

#[test]
fn summary_has_the_keys_of_the_contract() {
    let mut analysis = analysis();
    analysis.reactions[0].wrench = judged(Verdict::Unique, 0.0);
    let summary = Summary {
        method: Method::Dopri5,
        t: 2.0,
        steps: 10,
        rejected: 1,
        evaluations: 70,
        factorisations: 0,
        projections: 10,
        normalisations: 0,
        wall_seconds: 0.125,
        max_position_residual: 0.0,
        max_velocity_residual: f64::NAN,
        energy_balance: 0.0,
        energy_gap: 0.0,
        largest_kinetic_energy: 0.0,
        min_pivot_ratio: 1.0,
        misfits: Vec::new(),
        events: Vec::new(),
        components: Vec::new(),
        verdicts: None,
        dropped: vec![DroppedRows::new(0.0, vec![3])],
    };
    let prepared = prepared();
    let freedoms = freedoms(&prepared);
    let plan = planned(&prepared);
    let sensitivity = Sensitivity {
        change: 0.25,
        by: Some(Datum {
            joint: ConstraintId(1),
            name: "s_i",
            moved: 2e-4,
            unit: DataUnit::Length,
            is_number: false,
        }),
    };
    let upper = ReactionSensitivities {
        components: vec![("Fx", sensitivity)],
        directions: Vec::new(),
        is_whole: true,
    };
    let sensitivities = Sensitivities {
        each: vec![upper, ReactionSensitivities::default()],
        left_out: Vec::new(),
    };
    // The reaction of `lower` is determined along x up to 1 s.
    let mut stretches = Stretches::unique(&prepared.mechanism, [0.0, 2.0], &[]);
    let stretch = |from, to, verdict| VerdictStretch { from, to, verdict };
    let along_x = VerdictTrack::of([
        stretch(0.0, 1.0, Verdict::Unique),
        stretch(1.0, 2.0, Verdict::NotUnique),
    ]);
    stretches.reactions[1].components[0].1 = along_x;
    stretches.reactions[1].components[1].1 =
        VerdictTrack::of([stretch(0.0, 2.0, Verdict::NotUnique)]);
    stretches.sum_up(&[]);
    let columns = columns_of_reactions(&prepared.mechanism, &Selection::All, &[], |_| false);
    let columns = columns.expect("it exists");
    let peak = Peak {
        value: solvability::Value::unique(-3.5),
        time: 0.25,
        over: vec![[0.0, 2.0]],
    };
    let found = [None, Some(peak), None, None, None, None];
    let peaks = FoundPeaks {
        columns: columns.into_iter().zip(found).collect(),
        magnitudes: Vec::new(),
    };
    let run = Run {
        verdicts: Some(RunVerdicts {
            stretches: &stretches,
            groups: &[],
            peaks: &peaks,
        }),
        rows: 3,
        files: &["trajectory.csv", "summary.json"].map(str::to_owned),
        gaps: &[],
        plan: &plan,
        reactions: &analysis.reactions,
        sensitivities: &sensitivities,
        data: DataDocument::new(&analysis),
        freedoms: &freedoms,
        summary: &summary,
        spread: None,
        ending: Ending::Complete,
    };
    let found = json(&RunDocument::new(&run));
    let expected = r#"{
        "method": "dopri5", "formulation": "kept-rows", "stabilisation": "projection", "partial": false, "code": null, "error": null,
        "t_end": 2.0, "rows": 3, "files": ["trajectory.csv", "summary.json"], "steps": 10, "rejected": 1, "evaluations": 70, "projections": 10,
        "normalisations": 0, "wall_seconds": 0.125, "max_position_residual": 0.0, "max_velocity_residual": null,
        "energy_balance": 0.0, "start_correction": 0.0, "start_velocity_correction": 0.0,
        "rank": 3, "redundancy": 1, "mobility": 0, "without_drives": null, "free_motions": [], "cannot_move": true,
        "data": { "tolerance": 0.25, "angle_tolerance": 0.125, "lower_rank_from": null, "lower_rank_from_angle": null, "lower_rank_here": null },
        "misfits": [], "spread": null, "events": [],
        "reactions": {
            "upper": { "verdict": "unique", "sensitivity": 0.25, "fragile": true,
                "hangs_on": "`upper` is unique but changes by about 25 % if the point of `lower` on its first body moves by 0.2 mm",
                "at_start": { "verdict": "unique", "margin": 0.0, "within_tolerance": false },
                "components": {
                    "Fx": { "verdict": "unique", "sensitivity": 0.25, "fragile": true,
                        "hangs_on": "`upper.Fx` is unique but changes by about 25 % if the point of `lower` on its first body moves by 0.2 mm" },
                    "Fy": { "verdict": "unique", "sensitivity": null, "fragile": false,
                        "peak": { "value": -3.5, "verdict": "unique", "fragile": false, "sensitivity": null, "time": 0.25, "over": [[0.0, 2.0]] } } } },
            "lower \"2\"": { "verdict": "not_unique", "sensitivity": null, "fragile": false,
                "at_start": { "verdict": "not_unique", "margin": 0.5, "within_tolerance": false },
                "components": {
                    "Fx": { "verdict": "not_unique", "determined": [[0.0, 1.0]], "sensitivity": null, "fragile": false },
                    "Fy": { "verdict": "not_unique", "sensitivity": null, "fragile": false } } } },
        "special": [],
        "choice": [ { "from": 0.0, "to": 2.0, "name": "kept-rows", "deleted_rows": [4] } ],
        "plan": { "components": "solved as one", "generated_code": "interpreted", "rows_of_output": "201", "accelerations": "at output rows", "method": "dop853", "linear_systems": "none",
            "elimination": "null space, 3 × 3", "refinement": "none", "freedom": "none", "nonholonomic_rows": "none", "dropped_rows": "1 monitored",
            "rows_of_time": "b = 0", "varying_entries": "4 evaluated", "rows_of_gamma": "4 evaluated", "turning_bodies": "1 of 1",
            "forces": "Q = 0", "reactions": "all 2" } }"#;
    assert_eq!(squeezed(&found), squeezed(expected));
}

#[test]
fn a_stopped_run_is_partial_and_says_by_which_rows_its_numbers_are_chosen() {
    let analysis = analysis();
    let mut prepared = prepared();
    prepared.choice = RowChoice::Automatic;
    let freedoms = freedoms(&prepared);
    let plan = planned(&prepared);
    let summary = Summary {
        t: 1.5,
        events: vec![Event {
            time: 1.25,
            kind: EventKind::RowsExchanged,
            redundancy_before: 1,
            redundancy_after: 1,
            dropped: vec![1],
            text: "row 2 for row 4".into(),
            impulses: Vec::new(),
        }],
        dropped: vec![
            DroppedRows::new(0.0, vec![3]),
            DroppedRows::new(1.25, vec![1]),
        ],
        ..Summary::default()
    };
    let error = MotionError::from(DropError::NotRedundant);
    let sensitivities = Sensitivities::default();
    let stretches = Stretches::unique(&prepared.mechanism, [0.0, 1.5], &[]);
    let columns = columns_of_reactions(&prepared.mechanism, &Selection::All, &[], |_| false);
    let columns = columns.expect("all of them");
    let files = ["trajectory.csv", "summary.json"].map(str::to_owned);
    let peaks = FoundPeaks {
        columns: columns.into_iter().map(|column| (column, None)).collect(),
        magnitudes: Vec::new(),
    };
    let run = |ending, stretches| Run {
        rows: 3,
        files: &files,
        gaps: &[],
        plan: &plan,
        reactions: &analysis.reactions,
        sensitivities: &sensitivities,
        data: DataDocument::new(&analysis),
        freedoms: &freedoms,
        verdicts: Some(RunVerdicts {
            stretches,
            groups: &[],
            peaks: &peaks,
        }),
        summary: &summary,
        spread: None,
        ending,
    };
    let document = RunDocument::new(&run(Ending::Stopped(&error), &stretches));
    assert!(document.partial);
    assert_eq!(document.error, Some(error.to_string()));
    assert_eq!(document.t_end, 1.5);
    assert_eq!(document.events[0].kind, "rows-exchanged");
    // If every number is determined, there is no choice.
    assert_eq!(document.choice, []);
    let mut partly = stretches.clone();
    partly.reactions[0].components[0].1 = VerdictTrack::constant([0.0, 1.5], Verdict::NotUnique);
    let open = RunDocument::new(&run(Ending::Interrupted, &partly));
    assert!(open.partial);
    assert_eq!(open.error.as_deref(), Some("it was interrupted"));
    let choices = open.choice.iter();
    let choices = choices.map(|c| (c.from, c.to, c.deleted_rows.as_slice()));
    let expected = [(0.0, 1.25, &[4][..]), (1.25, 1.5, &[2])];
    assert_eq!(choices.collect::<Vec<_>>(), expected);
    assert_eq!(open.choice[1].to_string(), "row 2 deleted");
}

/// The mechanism is a crank with its motor. The document contains `null` without drives, and
/// otherwise ranks and motions of the other rows; moving bodies are given by name.
#[test]
fn freedoms_are_told_with_the_drives_and_without() {
    let mut d = Description::new("crank");
    let crank = d.body(Body {
        position: [0.5, 0.0],
        ..Body::new("crank", 1.0, 1.0)
    });
    let bodies = [BodyRef::Ground, crank];
    let (s_i, s_j) = ([0.0, 0.0], [-0.5, 0.0]);
    d.joint("pin", &bodies, Revolute { s_i, s_j });
    let told = |d: &Description| {
        let mechanism = Mechanism::build(d).expect("a crank");
        let (q, _) = mechanism.described_state();
        let analysis = analyse(&mechanism, 0.0, &q).expect("a start");
        let freedoms = analysis.freedoms(&mechanism, &q).expect("a start");
        let document = FreedomsDocument::new(&freedoms, &mechanism);
        let summary = document.summary(freedoms.mobility);
        (summary, document)
    };
    let turns = r#"[ { "text": "`crank` turns about `pin`", "velocities": [ { "crank": [0.0, 0.5, 1.0] } ] } ]"#;
    let (summary, free) = told(&d);
    assert_eq!(summary, "mobility 1");
    let expected =
        format!(r#"{{ "without_drives": null, "free_motions": {turns}, "cannot_move": false }}"#);
    assert_eq!(squeezed(&json(&free)), squeezed(&expected));
    assert_eq!(free.sentences().len(), 1);

    let motor = RevoluteAngleDrive::new(s_i, s_j);
    let rate = Function::constant_rate(1.0).expect("finite");
    d.drive("motor", &bodies, motor, rate);
    let (summary, driven) = told(&d);
    assert_eq!(summary, "mobility 0 with its drive, 1 without");
    let expected = format!(
        r#"{{ "without_drives": {{ "drives": 1, "rank": 2, "redundancy": 0, "mobility": 1, "free_motions": {turns} }},
            "free_motions": [], "cannot_move": false }}"#
    );
    assert_eq!(squeezed(&json(&driven)), squeezed(&expected));
    let told_once = [(
        "free without its drive".to_owned(),
        "`crank` turns about `pin`".to_owned(),
    )];
    assert_eq!(driven.sentences(), told_once);
}
