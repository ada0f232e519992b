//! Tests results of `pfaff analyze`, as text and as a document: the published mechanism, and cases
//! that can be checked by hand.

use serde_json::{Value, json};

use super::bad_input::PENDULUM;
use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// A beam of 2 m has two hinges that both constrain it along its axis; the loads are its weight and
/// a force of 6 N along its axis.
const BEAM: &str = r#"
scene = { name = "beam", space = "plane", gravity = [0.0, -10.0] }
body = [{ name = "beam", mass = 1.0, inertia = 1.0 }]
joint = [
    { name = "left", type = "revolute", bodies = ["ground", "beam"], at = [-1.0, 0.0] },
    { name = "right", type = "revolute", bodies = ["ground", "beam"], at = [1.0, 0.0] },
]
force = [{ name = "pull", type = "point-force", body = "beam", at = [0.0, 0.0], force = [6.0, 0.0] }]
"#;

/// Parallel cranks of 0.5 m have a common coupler, and the first one is driven from −0.5 rad at 1
/// rad/s: all are in one line at t = 0.5 s.
fn cranks() -> String {
    let (sin, cos) = (-0.5_f64).sin_cos();
    let mut scene =
        "scene = { name = \"cranks\", space = \"plane\" }\nsimulate = { t_end = 1.0 }\n".to_owned();
    for (name, x) in [("one", 0.0), ("two", 1.0)] {
        let (tip_x, tip_y) = (x + 0.5 * cos, 0.5 * sin);
        scene += &format!(
            "[[body]]\nname = \"crank {name}\"\nmass = 1.0\ninertia = 0.02\nposition = [{:?}, {:?}]\nangle = -0.5\n\
             [[joint]]\nname = \"pivot {name}\"\ntype = \"revolute\"\nbodies = [\"ground\", \"crank {name}\"]\nat = [{x:?}, 0.0]\n\
             [[joint]]\nname = \"tip {name}\"\ntype = \"revolute\"\nbodies = [\"crank {name}\", \"coupler\"]\nat = [{tip_x:?}, {tip_y:?}]\n",
            x + 0.25 * cos,
            0.25 * sin,
        );
    }
    let (x, y) = (0.5 + 0.5 * cos, 0.5 * sin);
    scene += &format!(
        "[[body]]\nname = \"coupler\"\nmass = 2.0\ninertia = 0.2\nposition = [{x:?}, {y:?}]\n\
         [[drive]]\nname = \"motor\"\njoint = \"pivot one\"\ntype = \"angle\"\nmotion = {{ type = \"constant-rate\", rate = 1.0 }}\n"
    );
    scene
}

/// Three upright cranks carry a coupler; the pivot of one consists of two points on lines. The
/// cranks share a force along them: it has no component along x in the upright position, which
/// occurs only at the start.
const UPRIGHT: &str = r#"
scene = { name = "upright", space = "plane", gravity = [0.0, -10.0] }
body = [
    { name = "one", mass = 1.0, inertia = 0.02, position = [0.0, 0.25], angular_velocity = 2.0 },
    { name = "two", mass = 1.0, inertia = 0.02, position = [1.0, 0.25] },
    { name = "three", mass = 1.0, inertia = 0.02, position = [2.0, 0.25] },
    { name = "coupler", mass = 3.0, inertia = 1.0, position = [1.0, 0.5] },
]
joint = [
    { name = "pivot one", type = "revolute", bodies = ["ground", "one"], at = [0.0, 0.0] },
    { name = "sideways", type = "point-on-line", body = "two", at = [1.0, 0.0], line = [[1.0, -1.0], [1.0, 1.0]] },
    { name = "upwards", type = "point-on-line", body = "two", at = [1.0, 0.0], line = [[0.0, 0.0], [2.0, 0.0]] },
    { name = "pivot three", type = "revolute", bodies = ["ground", "three"], at = [2.0, 0.0] },
    { name = "tip one", type = "revolute", bodies = ["one", "coupler"], at = [0.0, 0.5] },
    { name = "tip two", type = "revolute", bodies = ["two", "coupler"], at = [1.0, 0.5] },
    { name = "tip three", type = "revolute", bodies = ["three", "coupler"], at = [2.0, 0.5] },
]
simulate = { t_end = 0.4, output_step = 0.1 }
"#;

/// A bob on two pivots at this distance (m).
fn twin(apart: f64) -> String {
    format!(
        "{PENDULUM}[[joint]]\nname = \"twin\"\ntype = \"revolute\"\nbodies = [\"ground\", \"bob\"]\nat = [{apart:e}, 0.0]\n"
    )
}

#[track_caller]
pub(super) fn document(output: &std::process::Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {output:?}"))
}

#[track_caller]
pub(super) fn contains(text: &str, pieces: &[&str]) {
    // Lines may be wrapped at any blank.
    let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for piece in pieces {
        assert!(flat.contains(piece), "`{piece}` is not in:\n{text}");
    }
}

#[test]
fn the_rank_comes_with_its_proof_and_what_it_was_compared_with() {
    let d = document(&pfaff(&["analyze", ROBOT, "--json"]));
    let e = &d["evidence"];
    assert_eq!(
        (&e["certified"], &e["permanent"]),
        (&json!(true), &json!(true))
    );
    assert_eq!(
        (&e["rank_at_least"], &e["grounds"]),
        (&json!(20), &json!("vanishes"))
    );
    assert!(
        e["sigma_bound"]
            .as_f64()
            .is_some_and(|x| 0.0 < x && x <= 0.187)
    );
    assert!(e["sigma_next_extended"].as_f64().is_some_and(|x| x < 1e-26));
    assert_eq!(e["nearly_redundant"], Value::Null);
    assert_eq!(d["generic"]["redundancy"], 2);
    let points = d["generic"]["points"].as_array().expect("a list");
    assert!(!points.is_empty() && points.iter().all(|p| p["rank"] == 20));
    // The proof is the same for any choice of the redundant rows.
    let dropped = document(&pfaff(&["analyze", ROBOT, "--json", "--drop", "6,21"]));
    assert_eq!(dropped["evidence"]["certified"], true);
    assert_eq!(dropped["dropped_rows"], json!([6, 21]));
}

#[test]
fn nearly_redundant_rows_are_judged_although_they_cannot_move() {
    for (apart, redundancy, piece) in [
        (1e-3, 1, "rank proved: it equals the number of columns"),
        (1e-9, 1, "reactions reach 1/σ_3 = 2e9 per unit of load"),
        (1e-14, 2, "rank at least 2 proved; "),
        (1e-18, 2, "rank at least 2 proved; "),
    ] {
        let output = with_scene(&["analyze", "-"], &twin(apart));
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        contains(
            &stdout(&output),
            &[piece, &format!("redundancy {redundancy},")],
        );
        let d = document(&with_scene(&["analyze", "-", "--json"], &twin(apart)));
        assert_eq!(d["redundancy"], redundancy);
        let sigma = d["evidence"]["nearly_redundant"]["sigma"].as_f64();
        assert_eq!(sigma.is_some(), apart > 1e-14, "{d:#}");
    }
    // Choices use the proved rank.
    let output = with_scene(&["analyze", "-", "--choose", "minimum-norm"], &twin(1e-9));
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    contains(&stdout(&output), &["choice 1: minimum norm"]);
    let output = with_scene(&["analyze", "-", "--choose", "minimum-norm"], &twin(4e-14));
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    contains(
        &stderr(&output),
        &["the rank is undecided, so no choice can be computed"],
    );
    // A distance is as small as the rounding of the data: both interpretations are reported.
    let output = with_scene(&["analyze", "-"], &twin(4e-14));
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    contains(
        &stdout(&output),
        &[
            "UNDECIDED:",
            "change the rank from 3 to 2",
            "pivot, twin revolute 1–2, 3–4 undecided",
        ],
    );
    let d = document(&with_scene(&["analyze", "-", "--json"], &twin(4e-14)));
    assert_eq!(
        (&d["evidence"]["certified"], &d["evidence"]["permanent"]),
        (&json!(false), &Value::Null)
    );
    assert_eq!(d["mixing"], json!([]));
}

#[test]
fn the_reasons_are_in_words_and_ready_to_be_drawn() {
    let d = document(&with_scene(&["analyze", "-", "--json"], BEAM));
    let left = &d["reactions"][0];
    assert_eq!(
        left["explanation"],
        "the reaction of `left` is not determined: it shares loads with `right`; only Fy is determined"
    );
    let of = |k: usize| &d["reactions"][k]["free_directions"][0];
    assert_eq!(
        (&of(0)["place"], &of(1)["place"]),
        (&json!([-1.0, 0.0]), &json!([1.0, 0.0]))
    );
    // The load is one newton along the beam in one hinge, and minus one in the other.
    let force = |k: usize| [0, 1].map(|i| of(k)["force"][i].as_f64().expect("a number"));
    assert_eq!(force(0).map(f64::abs), [1.0, 0.0]);
    assert_eq!(force(1), force(0).map(|x| if x == 0.0 { x } else { -x }));
    assert_eq!(d["mixing"][0]["reactions"], json!(["left", "right"]));
    contains(
        &stdout(&with_scene(&["analyze", "-"], BEAM)),
        &[
            "Why:",
            "`left` and `right` both hold `beam` along the same line",
            "make `left` a pin on a line (`pin-in-slot`, axis = [1, 0]): all reactions are unique",
        ],
    );
}

#[test]
fn exactly_the_reactions_that_are_not_unique_are_explained() {
    for time in ["0", "1.5", "3.7", "9"] {
        let d = document(&pfaff(&["analyze", ROBOT, "--json", "--at-time", time]));
        for r in d["reactions"].as_array().expect("a list") {
            let open = r["verdict"] == "not_unique";
            assert_eq!(r["explanation"].is_string(), open, "{time}: {r:#}");
            let drawn = r["free_directions"]
                .as_array()
                .is_some_and(|list| !list.is_empty());
            assert_eq!(drawn, open, "{time}: {r:#}");
            // The values confirm the verdicts that follow from the structure.
            assert!(r["settled"].is_null() || r["verdict"] == "unique", "{r:#}");
        }
    }
}

#[test]
fn many_reasons_are_cut_in_words_but_not_in_the_document() {
    let mut scene = "scene = { name = \"doors\", space = \"plane\" }\n".to_owned();
    for k in 0..12 {
        let x = 3.0 * f64::from(k);
        scene += &format!(
            "[[body]]\nname = \"door {k}\"\nmass = 1.0\ninertia = 1.0\nposition = [{x:?}, 0.0]\n"
        );
        for (side, at) in [("left", x - 1.0), ("right", x + 1.0)] {
            scene += &format!(
                "[[joint]]\nname = \"{side} {k}\"\ntype = \"revolute\"\nbodies = [\"ground\", \"door {k}\"]\nat = [{at:?}, 0.0]\n"
            );
        }
    }
    let text = stdout(&with_scene(&["analyze", "-"], &scene));
    // The list contains one of two rows of each door.
    contains(
        &text,
        &[
            "- and 2 more (`--json` prints all)",
            "- and 7 more (`--json` prints all)",
        ],
    );
    // Joints that keep an angle have one row, which can only be deleted.
    let places = scene.lines().filter(|line| !line.starts_with("at = "));
    let angles = places
        .collect::<Vec<_>>()
        .join("\n")
        .replace("revolute", "angle");
    let text = stdout(&with_scene(&["analyze", "-"], &angles));
    contains(&text, &["; others: `--make-unique"]);
    let d = document(&with_scene(&["analyze", "-", "--json"], &scene));
    assert_eq!(d["dependencies"].as_array().map(Vec::len), Some(12));
    assert_eq!(d["eliminations"]["count"], 4096);
}

#[test]
fn what_makes_a_reaction_unique() {
    let ways = |time: &str, allow: &str| {
        let make = [
            "analyze",
            ROBOT,
            "--json",
            "--at-time",
            time,
            "--make-unique",
            "W3",
            "--allow",
            allow,
        ];
        let d = document(&pfaff(&make));
        let found = &d["make_unique"][0];
        assert_eq!(
            (&found["reaction"], &found["complete"]),
            (&json!("W3"), &json!(true))
        );
        let ways = found["ways"].as_array().expect("a list").iter();
        ways.map(|w| w["rows"].to_string()).collect::<Vec<_>>()
    };
    // The published sets are W4 and one of these rows, of four while the edges are straight.
    assert_eq!(
        ways("0", "sensible"),
        ["[4,21]", "[6,21]", "[18,21]", "[19,21]"]
    );
    let turned = ["[3,21]", "[4,21]", "[5,21]", "[6,21]", "[18,21]", "[19,21]"];
    assert_eq!(ways("1.5", "sensible"), turned);
    assert_eq!(ways("0", "rows:21,18,1"), ["[18,21]"]);
    assert_eq!(ways("0", "rows:1,2"), [""; 0]);
    let text = stdout(&pfaff(&[
        "analyze",
        ROBOT,
        "--make-unique",
        "W3",
        "--allow",
        "whole",
    ]));
    contains(&text, &["Ways to make W3 unique", "delete `W1` and `W4`"]);
}

#[test]
fn admissible_eliminations_are_counted_and_listed() {
    let d = document(&pfaff(&["analyze", ROBOT, "--json"]));
    assert_eq!(d["eliminations"], json!({ "count": 9 }));
    let d = document(&pfaff(&[
        "analyze",
        ROBOT,
        "--json",
        "--at-time",
        "1.5",
        "--eliminations",
    ]));
    assert_eq!(d["eliminations"]["count"], 13);
    let sets = d["eliminations"]["sets"].as_array().expect("a list");
    assert_eq!((sets.len(), &sets[12]), (13, &json!([20, 21])));
    let text = stdout(&pfaff(&["analyze", ROBOT, "--eliminations", "2"]));
    contains(&text, &["9 sets of 2 rows", "{4,20} {4,21}"]);
    assert!(!text.contains("{6,20}"), "{text}");
}

#[test]
fn sums_have_components_and_frames_have_axes() {
    let combine = [
        "analyze",
        "-",
        "--json",
        "--combine",
        "left + right",
        "--frames",
    ];
    let d = document(&with_scene(&combine, BEAM));
    let sum = &d["groups"][0];
    assert_eq!(
        (&sum["name"], &sum["verdict"]),
        (&json!("left + right"), &json!("unique"))
    );
    assert_eq!(sum["components"].as_array().map(Vec::len), Some(3));
    let frames = d["reactions"][0]["frames"].as_array().expect("a list");
    assert_eq!(frames[0]["frame"], "global");
    assert_eq!(frames[0]["axes"], json!([[1.0, 0.0], [0.0, 1.0]]));
    let text = stdout(&pfaff(&["analyze", ROBOT, "--at-time", "1.5", "--frames"]));
    contains(&text, &["In other frames:", "Fn not unique; Ft, T unique"]);
    // The option was not given.
    let d = document(&pfaff(&["analyze", ROBOT, "--json"]));
    assert!(d["reactions"][0].get("frames").is_none());
}

#[test]
fn choices_are_labelled_and_facts_are_not() {
    let all = [
        "analyze",
        "-",
        "--json",
        "--choose",
        "minimum-norm",
        "--choose",
        "compliance:left=1e-6,right=2e-6",
        "--choose",
        "drop:3",
        "--choose",
        "minimum-norm:length=0.5",
    ];
    let d = document(&with_scene(&all, BEAM));
    // The ground carries −6 N along the beam; the shares are one half each, two to one, and all on
    // the left.
    for (k, left, right) in [(0, 3.0, 3.0), (1, 4.0, 2.0), (2, 6.0, 0.0), (3, 3.0, 3.0)] {
        let choice = &d["choices"][k];
        for (joint, along) in [(0, left), (1, right)] {
            let [x, y] = [0, 1].map(|c| &choice["reactions"][joint]["components"][c]);
            let value = x["value"].as_f64().expect("a number");
            assert!((value.abs() - along).abs() < 1e-12, "{choice:#}");
            assert_eq!(
                (&x["choice"], &x["nature"]),
                (&choice["label"], &json!("choice"))
            );
            // The value is half the weight, for every choice.
            assert!((y["value"].as_f64().expect("a number").abs() - 5.0).abs() < 1e-12);
            assert_eq!((y.get("choice"), &y["nature"]), (None, &json!("fact")));
        }
    }
    // A joint that is not listed is rigid, and both texts state this.
    let rigid = ["analyze", "-", "--choose", "compliance:left=1e-6"];
    let label = "elastic supports: `left` 1e-6 m/N; rigid: `right`";
    contains(&stdout(&with_scene(&rigid, BEAM)), &[label]);
    let d = document(&with_scene(&[&rigid[..], &["--json"]].concat(), BEAM));
    assert_eq!(d["choices"][0]["label"], label);
    let listed = "elastic supports: `left` 1e-6 m/N; `right` 2e-6 m/N";
    let d = document(&with_scene(&all, BEAM));
    assert_eq!(d["choices"][1]["label"], listed);
    let text = stdout(&with_scene(&["analyze", "-", "--choose", "drop:3"], BEAM));
    contains(&text, &["choice 1: no reaction in row 3 (`right`, x)"]);
}

#[test]
fn a_whole_motion_has_one_verdict_and_exceptions() {
    let output = pfaff(&["analyze", ROBOT, "--json", "--along"]);
    assert_eq!(
        (output.status.code(), stderr(&output)),
        (Some(0), String::new())
    );
    let along = &document(&output)["along"];
    assert_eq!(
        (&along["to"], &along["stopped"]),
        (&json!(10.0), &Value::Null)
    );
    assert_eq!(along["generic"]["redundancy"], 2);
    let none: [Value; 0] = [];
    assert_eq!(along["stretches"], json!(none));
    assert_eq!(along["passages"], json!(none));
    // The robot moves straight for a second, and at the end of this second y is the direction
    // across the wheels.
    let found = &along["reactions"]["B"];
    assert_eq!(found["verdict"], "not_unique");
    assert_eq!(
        found["components"]["Fx"],
        json!({ "verdict": "not_unique", "determined": [[0.0, 1.0]] })
    );
    assert_eq!(
        found["components"]["Fy"],
        json!({ "verdict": "not_unique" })
    );
    let end = json!({ "time": 1.0, "name": "B", "component": "Fx", "verdict": "unique" });
    let special = along["special"].as_array().expect("a list");
    assert!(special.contains(&end), "{special:#?}");
    let text = stdout(&pfaff(&["analyze", ROBOT, "--along"]));
    contains(
        &text,
        &[
            "- `B`: Fx not unique (unique on 0 … 1 s), Fy not unique",
            "- only at the instant t = 1 s: unique: B.Fx, C.Fx, W1.Fx, W2.Fx, W3.Fx, W4.Fx",
        ],
    );
    let text = stdout(&pfaff(&["analyze", ROBOT, "--along", "0.5"]));
    contains(
        &text,
        &[
            "Along the motion, t = 0 to 0.5 s",
            "the verdicts are the same at all times",
        ],
    );
}

/// Returns the verdicts on a reaction and its components here, and the verdicts at nearly all
/// configurations.
fn here_and_generic(document: &Value, reaction: &str) -> Vec<(String, Value, Value)> {
    let reactions = document["reactions"].as_array().expect("a list");
    let found = reactions.iter().find(|r| r["name"] == reaction);
    let found = found.expect("a reaction");
    let components = found["components"].as_array().expect("a list");
    let all = std::iter::once(found).chain(components);
    all.map(|x| {
        let name = x["name"].as_str().expect("a name").to_owned();
        assert!(x.get("generic_verdict").is_some(), "{x:#}");
        (name, x["verdict"].clone(), x["generic_verdict"].clone())
    })
    .collect()
}

/// The test compares with other configurations or with the motion: the sideways force is determined
/// only in the upright position.
#[test]
fn a_verdict_has_the_one_that_holds_elsewhere_beside_it() {
    let at_once: &[&str] = &["analyze", "-", "--json"];
    for more in [&[][..], &["--along"], &["--along", "0.2"]] {
        let output = with_scene(&[at_once, more].concat(), UPRIGHT);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let found = document(&output);
        let words = |name: &str, reaction: &str| {
            let all = here_and_generic(&found, reaction);
            let own = all.into_iter().find(|(known, ..)| known == name);
            own.map(|(_, here, generic)| (here, generic))
        };
        let expected = Some((json!("unique"), json!("not_unique")));
        let open = Some((json!("not_unique"), json!("not_unique")));
        for name in ["sideways", "Fx"] {
            assert_eq!(words(name, "sideways"), expected, "{more:?}");
        }
        assert_eq!(words("Fx", "tip two"), expected, "{more:?}");
        assert_eq!(words("Fy", "tip two"), open, "{more:?}");
        assert_eq!(words("tip two", "tip two"), open, "{more:?}");
    }
    // At times during the motion both verdicts are the same. Across the line there is never a
    // force.
    let output = with_scene(&["analyze", "-", "--json", "--at-time", "0.2"], UPRIGHT);
    let found = here_and_generic(&document(&output), "sideways");
    let expected = ["not_unique", "not_unique", "unique"];
    let names: Vec<&str> = found.iter().map(|(name, ..)| name.as_str()).collect();
    assert_eq!(names, ["sideways", "Fx", "Fy"]);
    for ((name, here, generic), word) in found.iter().zip(expected) {
        assert_eq!((here, generic), (&json!(word), &json!(word)), "{name}");
    }
    let text = stdout(&with_scene(&["analyze", "-"], UPRIGHT));
    contains(
        &text,
        &["unique here, not unique elsewhere: pivot one.Fx, sideways.Fx, pivot three.Fx"],
    );
    // A beam on two hinges has no other configuration.
    let output = with_scene(&["analyze", "-", "--json"], BEAM);
    for (name, _, generic) in here_and_generic(&document(&output), "left") {
        assert_eq!(generic, Value::Null, "{name}");
    }
    assert!(!stdout(&with_scene(&["analyze", "-"], BEAM)).contains("elsewhere:"));
}

/// The verdicts along the motion equal those of `summary.json` of the run, with the special
/// verdicts at the start.
#[test]
fn along_the_motion_and_in_its_run_verdicts_are_the_same() {
    for scene in [UPRIGHT.to_owned(), cranks()] {
        let along = with_scene(&["analyze", "-", "--along", "--json"], &scene);
        let along = &document(&along)["along"];
        let folder = Folder::new("along-and-run");
        let run = with_scene(&["simulate", "-", "--json", "--out", folder.text()], &scene);
        let run = document(&run);
        let reactions = run["reactions"].as_object().expect("an object");
        for (name, reaction) in reactions {
            let same = |own: &Value, of_run: &Value| {
                for key in ["verdict", "determined"] {
                    assert_eq!(own.get(key), of_run.get(key), "{name} {own:#}");
                }
            };
            let own = &along["reactions"][name];
            same(own, reaction);
            let components = reaction["components"].as_object().expect("an object");
            for (component, of_run) in components {
                same(&own["components"][component], of_run);
            }
        }
        let listed = along["special"].as_array().expect("a list");
        for special in run["special"].as_array().expect("a list") {
            assert!(listed.contains(special), "{special:#} in {listed:#?}");
        }
    }
    let along = with_scene(&["analyze", "-", "--along", "--json"], UPRIGHT);
    let start = json!({ "time": 0.0, "name": "sideways", "component": "Fx", "verdict": "unique" });
    let special = document(&along)["along"]["special"].clone();
    assert!(
        special.as_array().is_some_and(|all| all.contains(&start)),
        "{special:#}"
    );
}

#[test]
fn a_motion_through_a_bifurcation_is_judged() {
    let output = with_scene(&["analyze", "-", "--along"], &cranks());
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    contains(
        &stdout(&output),
        &[
            "at t = 0.5 s the configuration is singular: the redundancy rises from 0 to 1 for an instant",
            "a bifurcation: another branch is compatible with the constraints",
        ],
    );
    let output = with_scene(&["analyze", "-", "--along", "--json"], &cranks());
    assert_eq!(
        (output.status.code(), stderr(&output)),
        (Some(0), String::new())
    );
    let along = &document(&output)["along"];
    assert_eq!(
        (&along["to"], &along["stopped"]),
        (&json!(1.0), &Value::Null)
    );
    let passage = &along["passages"][0];
    let time = passage["time"].as_f64().expect("a number");
    assert!((time - 0.5).abs() < 1e-9, "{time}");
    assert_eq!(passage["continuation"], "bifurcation");
}

/// The cranks come to rest in the singular configuration: no velocity determines on which branch
/// they continue.
#[test]
fn a_motion_that_stops_at_a_passage_is_judged_beyond_it() {
    let rests = cranks().replace(
        "{ type = \"constant-rate\", rate = 1.0 }",
        "{ type = \"steps\", steps = [{ from = 0.0, to = 0.5, by = 0.5 }] }",
    );
    let output = with_scene(&["analyze", "-", "--along", "--json"], &rests);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let along = &document(&output)["along"];
    let to = along["to"].as_f64().expect("a number");
    assert!((0.4..0.5).contains(&to), "{to}");
    let stopped = along["stopped"].as_str().expect("a reason");
    assert!(stopped.contains("singular configuration"), "{stopped}");
}

#[test]
fn wrong_questions_have_clear_answers() {
    for (option, value, piece) in [
        (
            "--make-unique",
            "W33",
            "there is no joint or drive `W33`; did you mean `W3`?",
        ),
        ("--allow", "all", "--allow is `all`, need `sensible`"),
        (
            "--allow",
            "rows:4,99",
            "there is no row 99; rows are 1 to 22",
        ),
        ("--along", "-1", "--along goes to -1, need a time > 0"),
        ("--along", "nan", "--along goes to NaN, need a time > 0"),
        ("--eliminations", "many", "invalid value 'many'"),
        (
            "--choose",
            "best",
            "--choose is `best`, need `minimum-norm`",
        ),
        ("--choose", "minimum-norm:length=0", "an arm in m > 0"),
        (
            "--choose",
            "compliance:Q=1",
            "there is no joint or drive `Q`",
        ),
        (
            "--choose",
            "compliance:W3=-1",
            "the compliance of `W3` is -1, need",
        ),
        ("--choose", "compliance:W3", "need NAME=COMPLIANCE"),
        (
            "--choose",
            "compliance:W3=1e-6",
            "give a compliance to at least one more",
        ),
        (
            "--choose",
            "drop:1,2",
            "those of 1 (`A`, x), 2 (`A`, y) are unique",
        ),
        ("--choose", "drop:6", "drop exactly 2"),
        ("--choose", "drop:6,6", "row 6 is listed twice"),
        ("--choose", "drop:0,6", "row 0 does not exist"),
        (
            "--choose",
            "drop:6,99",
            "there is no row 99; rows are 1 to 22",
        ),
        ("--drop", "1,2", "cannot be dropped"),
    ] {
        let output = pfaff(&["analyze", ROBOT, option, value]);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{option} {value}: {text}");
        assert!(text.contains(piece), "{option} {value}: {text}");
        assert!(output.stdout.is_empty(), "{option} {value}");
    }
    // The scene states no duration.
    let output = with_scene(&["analyze", "-", "--along"], BEAM);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
}

#[test]
fn contradictions_come_before_verdicts() {
    let drive = |name: &str, rate: f64| {
        format!(
            "[[drive]]\nname = \"{name}\"\njoint = \"pivot\"\ntype = \"angle\"\nmotion = {{ type = \"constant-rate\", rate = {rate:?} }}\n"
        )
    };
    let scene = format!("{PENDULUM}{}{}", drive("slow", 1.0), drive("fast", 2.5));
    for command in ["analyze", "check"] {
        let output = with_scene(&[command, "-"], &scene);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        let text = stderr(&output);
        contains(
            &text,
            &[
                "`slow`",
                "`fast`",
                "different velocities",
                "differ by 1.5 rad/s",
            ],
        );
    }
}

#[test]
fn help_shows_examples() {
    let text = stdout(&pfaff(&["analyze", "--help"]));
    contains(
        &text,
        &[
            "Examples:",
            "--make-unique W3",
            "--choose compliance:B=1e-6,W3=1e-6,W4=2e-6",
            "--along",
        ],
    );
}

/// Two edges are parallel except for ε: they are independent for the given data, and reported as
/// nearly dependent.
#[test]
fn nearly_parallel_edges_are_told() {
    for (apart, said) in [
        (
            "1e-3",
            "one row is redundant from a tolerance of 0.49 mm on",
        ),
        (
            "1e-9",
            "`left` and `right` are unique but would change by up to many times their size",
        ),
    ] {
        let scene = format!(
            r#"scene = {{ name = "edges", space = "plane" }}
            body = [{{ name = "sled", mass = 1.0, inertia = 1.0 }}]
            joint = [
                {{ name = "left", type = "knife-edge", body = "sled", point = [0.0, 0.5], normal = [0.0, 1.0] }},
                {{ name = "right", type = "knife-edge", body = "sled", point = [0.0, -0.5], normal = [{apart}, 1.0] }},
            ]"#
        );
        let text = stdout(&with_scene(&["analyze", "-"], &scene));
        contains(
            &text,
            &[
                "redundancy 0,",
                "NEARLY REDUNDANT",
                "the rows of left, right",
                said,
            ],
        );
    }
}
