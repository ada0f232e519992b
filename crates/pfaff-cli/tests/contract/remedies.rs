//! Joints of other types in place of joints whose reactions are not unique. The scenes with the
//! proposed joints are written here line by line, so that the analysis of each is independent of
//! the text that the program changed.

use std::time::{Duration, Instant};

use serde_json::Value;
use suite::numbers::Numbers;

use super::{Folder, stderr, stdout, with_scene};

const HATCH: &str = include_str!("../remedies/hatch.toml");
const SLIDER: &str = include_str!("../remedies/slider.toml");
const GANTRY: &str = include_str!("../remedies/gantry.toml");
const LIFT: &str = include_str!("../remedies/lift.toml");
const WISHBONE: &str = include_str!("../remedies/wishbone.toml");
const HINGES: &str = include_str!("../../../../examples/hinges.toml");

/// An analysis of a small mechanism takes less, also in a build without optimisation.
const LONGEST: Duration = Duration::from_secs(10);

fn analysed(scene: &str) -> Value {
    let output = with_scene(&["analyze", "-", "--json", "--remedies"], scene);
    assert!(output.status.success(), "{}\n{scene}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("a document")
}

/// Replaces the type of a joint whose table is one line, and its direction.
fn replaced(scene: &str, joint: &str, to: &str, direction: Option<(&str, &str)>) -> String {
    let named = format!("name = \"{joint}\"");
    let mut lines: Vec<String> = scene.lines().map(str::to_owned).collect();
    let line = lines.iter_mut().find(|line| line.contains(&named));
    let line = line.expect("a joint");
    let (before, after) = line.split_once("type = \"").expect("a type");
    let (_, after) = after.split_once('"').expect("a type");
    let mut new = format!("{before}type = \"{to}\"{after}");
    let takes_axis = !matches!(to, "spherical" | "point-on-plane") && direction.is_none();
    if let Some((before, after)) = new.clone().split_once(", axis = [")
        && !takes_axis
    {
        new = format!("{before}{}", after.split_once(']').expect("a list").1);
    }
    if let Some((key, vector)) = direction {
        let end = new.rfind('}').expect("a table");
        new.insert_str(end, &format!(", {key} = {vector} "));
    }
    *line = new;
    lines.join("\n")
}

/// Returns the scene with the joints of a proposal.
fn with_remedy(scene: &str, remedy: &Value) -> String {
    let all = remedy["replace"].as_array().expect("a list");
    assert!(!all.is_empty());
    all.iter().fold(scene.to_owned(), |scene, joint| {
        let text = |key: &str| joint[key].as_str().expect("a text");
        let given = joint["directions"].as_object();
        let directions = given.into_iter().flatten().next();
        let directions = directions.map(|(key, vector)| (key.clone(), vector.to_string()));
        let direction = directions.as_ref().map(|(k, v)| (k.as_str(), v.as_str()));
        replaced(&scene, text("joint"), text("to"), direction)
    })
}

/// Redundancy and mobility.
fn numbers(document: &Value) -> [u64; 2] {
    ["redundancy", "mobility"].map(|key| document[key].as_u64().expect("a number"))
}

fn are_unique(document: &Value) -> bool {
    let all = document["reactions"].as_array().expect("reactions");
    all.iter().all(|reaction| reaction["verdict"] == "unique")
}

/// For each scene: its redundancy and mobility, and the joints that an engineer would draw. The
/// latter make all reactions unique, so the redundancy is not a fact about the scene alone.
#[test]
fn six_machines_have_a_remedy() {
    type ByHand<'a> = &'a [(&'a str, &'a str, Option<(&'a str, &'a str)>)];
    let plane = |normal: &'static str| Some(("normal", normal));
    let [x, y, z] = ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"].map(plane);
    let (ball, line, flat) = ("spherical", "point-on-line", "point-on-plane");
    let hatch: ByHand<'_> = &[
        ("hinge 1", line, None),
        ("hinge 2", flat, x),
        ("hinge 3", flat, y),
        ("hinge 4", flat, z),
    ];
    let slider: ByHand<'_> = &[
        ("front left", line, None),
        ("rear left", flat, y),
        ("front right", flat, z),
        ("rear right", flat, z),
    ];
    let gantry: ByHand<'_> = &[
        ("left rail", "cylindrical", None),
        ("left bolts", ball, None),
        (
            "right bolts",
            "universal",
            Some(("axis", "[1, 0, 0], cross = [0, 0, 1]")),
        ),
    ];
    let wishbone: ByHand<'_> = &[
        ("lower front", ball, None),
        ("lower rear", line, None),
        ("upper front", ball, None),
        ("upper rear", line, None),
    ];
    let hinges: ByHand<'_> = &[
        ("lower", ball, None),
        ("middle", flat, x),
        ("upper", flat, y),
    ];
    let lift: ByHand<'_> = &[
        ("foot 1", ball, None),
        ("top 1", ball, None),
        ("low pin 1", ball, None),
        ("low pin 2", ball, None),
        ("high pin 1", line, None),
        ("middle 2", line, None),
        ("high pin 2", line, Some(("axis", "[0, 0, 1]"))),
    ];
    for (name, scene, [redundancy, mobility], by_hand) in [
        ("hatch", HATCH, [14, 1], hatch),
        ("slider", SLIDER, [15, 1], slider),
        ("gantry", GANTRY, [6, 0], gantry),
        ("lift", LIFT, [17, 0], lift),
        ("wishbone", WISHBONE, [10, 1], wishbone),
        ("hinges", HINGES, [10, 1], hinges),
    ] {
        let begun = Instant::now();
        let found = analysed(scene);
        assert!(begun.elapsed() < LONGEST, "{name}");
        assert_eq!(numbers(&found)[0], redundancy, "{name}");
        let drawn = by_hand
            .iter()
            .fold(scene.to_owned(), |scene, (joint, to, direction)| {
                replaced(&scene, joint, to, *direction)
            });
        let drawn = analysed(&drawn);
        assert_eq!(
            (numbers(&drawn), are_unique(&drawn)),
            ([0, mobility], true),
            "{name}"
        );
        let remedies = found["remedies"].as_array().expect("remedies");
        let all = remedies.iter();
        let all = all.fold(scene.to_owned(), |scene, remedy| {
            with_remedy(&scene, remedy)
        });
        let changed = analysed(&all);
        assert_eq!(
            (numbers(&changed), are_unique(&changed)),
            ([0, mobility], true),
            "{name}"
        );
        let text = stdout(&with_scene(&["analyze", "-"], scene));
        assert!(text.contains("Design change ("), "{text}");
        assert!(!text.contains("delete `"), "{text}");
    }
}

/// A joint with one row has no weaker type.
#[test]
fn a_joint_without_a_weaker_type_keeps_its_deletion() {
    let table = include_str!("../../../../examples/table.toml");
    assert_eq!(analysed(table).get("remedies"), None);
    let text = stdout(&with_scene(&["analyze", "-"], table));
    assert!(text.contains("delete `A`"), "{text}");
    // A mechanism that second order blocks would move with other joints.
    let blocked = include_str!("../../../../examples/chebyshev.toml");
    assert_eq!(analysed(blocked).get("remedies"), None);
}

/// A ball joint has no coordinate that the motor could drive, so the driven hinge may only slide.
/// On three hinges, six rows would remain, and no types suffice.
#[test]
fn a_drive_keeps_its_coordinate() {
    let motor = "\ndrive = [\n    { name = \"motor\", joint = \"lower\", type = \"angle\", motion = { type = \"constant-rate\", rate = 0.1 } },\n]\nforce = [";
    let driven = HINGES.replace("\nforce = [", motor);
    assert_eq!(analysed(&driven).get("remedies"), None);
    let two = driven.lines().filter(|line| !line.contains("\"middle\""));
    let two = two.collect::<Vec<_>>().join("\n");
    let remedy = &analysed(&two)["remedies"][0];
    let joints = remedy["replace"].as_array().expect("a list");
    let types: Vec<&Value> = joints.iter().map(|joint| &joint["to"]).collect();
    assert_eq!(types, ["cylindrical", "point-on-plane"]);
    assert_eq!(numbers(&analysed(&with_remedy(&two, remedy))), [0, 0]);
}

/// A body in space on joints of random types and places, or a closed chain of links with parallel
/// or random axes.
fn random(numbers: &mut Numbers) -> String {
    let vector = |numbers: &mut Numbers| [0, 1, 2].map(|_| numbers.within(-1.0, 1.0));
    let types = [
        "revolute",
        "cylindrical",
        "spherical",
        "translational",
        "fixed",
        "point-on-line",
    ];
    let is_chain = numbers.below(2) == 0;
    let links = if is_chain { 2 + numbers.below(3) } else { 1 };
    let common = vector(numbers);
    let mut bodies = String::new();
    for k in 0..links {
        let at = vector(numbers);
        bodies += &format!(
            "    {{ name = \"b{k}\", mass = 1.0, inertia = [1.0, 1.0, 1.0], position = {at:?} }},\n"
        );
    }
    let mut joints = String::new();
    for k in 0..if is_chain {
        links + 1
    } else {
        2 + numbers.below(3)
    } {
        let [first, second] = match (is_chain, k) {
            (false, _) | (true, 0) => ["ground".to_owned(), "b0".to_owned()],
            (true, k) if k == links => [format!("b{}", k - 1), "ground".to_owned()],
            (true, k) => [format!("b{}", k - 1), format!("b{k}")],
        };
        let kind = types[if is_chain {
            0
        } else {
            numbers.below(types.len())
        }];
        let axis = match numbers.below(4) {
            0 => vector(numbers),
            _ => common,
        };
        let axis = match kind {
            "spherical" | "fixed" => String::new(),
            _ => format!(", axis = {axis:?}"),
        };
        let at = vector(numbers);
        joints += &format!(
            "    {{ name = \"j{k}\", type = \"{kind}\", bodies = [\"{first}\", \"{second}\"], at = {at:?}{axis} }},\n"
        );
    }
    format!(
        "scene = {{ name = \"random\", space = \"spatial\", gravity = [0.0, 0.0, -9.81] }}\nbody = [\n{bodies}]\njoint = [\n{joints}]\n"
    )
}

/// Number of random mechanisms, and the smallest number of remedies among them.
const RANDOM: [usize; 2] = [60, 20];

#[test]
fn remedies_of_random_mechanisms_are_sufficient() {
    let mut seed = Numbers::new(1);
    let mut count = 0;
    for _ in 0..RANDOM[0] {
        let scene = random(&mut seed);
        let output = with_scene(&["analyze", "-", "--json", "--remedies"], &scene);
        let Ok(found) = serde_json::from_slice::<Value>(&output.stdout) else {
            panic!("{}\n{scene}", stderr(&output));
        };
        let Some(remedies) = found["remedies"].as_array() else {
            continue;
        };
        let changed = remedies.iter();
        let changed = changed.fold(scene.clone(), |scene, remedy| with_remedy(&scene, remedy));
        let changed = analysed(&changed);
        let [before, mobility] = numbers(&found);
        let [after, kept] = numbers(&changed);
        assert_eq!(mobility, kept, "{scene}");
        assert!(after < before, "{scene}");
        for name in remedies
            .iter()
            .flat_map(|remedy| remedy["reactions"].as_array())
            .flatten()
        {
            let name = name.as_str().expect("a name");
            let reactions = changed["reactions"].as_array().expect("reactions");
            let own = reactions.iter().find(|reaction| reaction["name"] == name);
            let verdict = own.map(|reaction| &reaction["verdict"]);
            assert_eq!(verdict, Some(&Value::from("unique")), "{name}\n{scene}");
        }
        count += 1;
    }
    assert!(count >= RANDOM[1], "{count}");
}

/// A bar whose rotation is blocked at second order has no remedy, also with a wheel that turns:
/// a weaker joint would free it.
#[test]
fn a_blocked_motion_is_not_freed() {
    let scene = r#"
        scene = { name = "blocked", space = "plane" }
        body = [
            { name = "bar", mass = 1.0, inertia = 0.5, position = [0.0, 2.0] },
            { name = "wheel", mass = 1.0, inertia = 0.5, position = [5.0, 0.0] },
        ]
        joint = [
            { name = "pin", type = "revolute", bodies = ["bar", "ground"], at = [2.0, 2.0] },
            { name = "roller", type = "point-on-line", body = "bar", at = [2.0, 1.0], line = [[2.0, 1.0], [3.0, 1.0]] },
            { name = "hub", type = "revolute", bodies = ["ground", "wheel"], at = [5.0, 0.0] },
        ]
    "#;
    let text = stdout(&with_scene(&["analyze", "-"], scene));
    assert!(text.contains("blocked at second order"), "{text}");
    assert!(!text.contains("Design change ("), "{text}");
}

/// Directions of a remedy belong to the first body; a joint whose directions are global has none.
#[test]
fn global_directions_stay_global() {
    let scene = |frame: &str| {
        format!(
            r#"
            scene = {{ name = "leaf", space = "spatial", gravity = [0.0, 0.0, -9.81] }}
            body = [{{ name = "leaf", mass = 20.0, inertia = [1.0, 1.0, 1.0], position = [0.5, 0.0, 1.0], orientation = {{ axis = [1, 0, 0], angle = 0.9 }} }}]
            joint = [
                {{ name = "lower", type = "revolute", bodies = ["leaf", "ground"], at = [0, 0, 0], axis = [0, 0, 1]{frame} }},
                {{ name = "middle", type = "revolute", bodies = ["leaf", "ground"], at = [0, 0, 1], axis = [0, 0, 1]{frame} }},
                {{ name = "upper", type = "revolute", bodies = ["leaf", "ground"], at = [0, 0, 2], axis = [0, 0, 1]{frame} }},
            ]
            "#
        )
    };
    let remedies = |scene: &str| {
        let output = with_scene(&["analyze", "-", "--json", "--remedies"], scene);
        let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        d["remedies"].as_array().cloned().unwrap_or_default()
    };
    for remedy in remedies(&scene(", frame = \"global\"")) {
        for replaced in remedy["replace"].as_array().expect("a list") {
            assert!(replaced.get("directions").is_none(), "{replaced}");
        }
    }
}

/// The report lists the remedy, and no deletion of a joint that has one.
#[test]
fn the_report_has_the_remedy() {
    let folder = Folder::new("remedy-report");
    let carriage = include_str!("../../../../examples/carriage.toml");
    with_scene(&["simulate", "-", "--out", folder.text()], carriage);
    let page = std::fs::read_to_string(folder.0.join("report.html")).expect("written");
    assert!(page.contains("Make each of <b>rear</b> and <b>front</b> a pin on a line"));
    assert!(!page.contains("delete <b>"));
}
