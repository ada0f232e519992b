//! Unique reactions that depend on the last digits of the data: every output reports them, and no
//! output reports them for ordinary scenes.

use std::fs;
use suite::generate::Kind;

use serde_json::Value;

use super::{Folder, ROBOT, pfaff, stderr, stdout};

const NAMES: [&str; 6] = ["O1", "P1", "O2", "P2", "O3", "P3"];

/// A coupler is on three parallel cranks of half a metre, 6 kg in total. The pin of the third crank
/// on the ground is displaced by this length, and so is the hole of the crank there.
fn three_cranks(folder: &Folder, name: &str, off: f64) -> String {
    let (c, s) = (0.5 * 0.7_f64.cos(), 0.5 * 0.7_f64.sin());
    let mut bodies = String::new();
    let mut joints = String::new();
    for k in 0..3 {
        let (n, x) = (k + 1, f64::from(k));
        let pin = if k == 2 { x + off } else { x };
        bodies += &format!(
            "    {{ name = \"crank{n}\", mass = 1.0, inertia = 0.02, position = [{}, {}], angle = 0.7 }},\n",
            x + 0.5 * c,
            0.5 * s
        );
        joints += &format!(
            "    {{ name = \"O{n}\", type = \"revolute\", bodies = [\"ground\", \"crank{n}\"], at = [{pin}, 0.0] }},
    {{ name = \"P{n}\", type = \"revolute\", bodies = [\"crank{n}\", \"coupler\"], at = [{}, {s}] }},\n",
            x + c
        );
    }
    let text = format!(
        "scene = {{ name = \"three-cranks\", space = \"plane\", gravity = [0.0, -9.81] }}
body = [
{bodies}    {{ name = \"coupler\", mass = 3.0, inertia = 1.0, position = [{}, {s}] }},
]
joint = [
{joints}]
simulate = {{ t_end = 0.01 }}
",
        1.0 + c
    );
    fs::create_dir_all(&folder.0).expect("writable");
    let path = folder.0.join(name);
    fs::write(&path, text).expect("writable");
    path.to_str().expect("UTF-8").to_owned()
}

/// Returns the output of a command that must succeed.
fn said(arguments: &[&str]) -> String {
    let output = pfaff(arguments);
    assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
    stdout(&output)
}

fn document(arguments: &[&str]) -> Value {
    serde_json::from_str(&said(arguments)).expect("one JSON document")
}

/// Joins all lines, because lines may be wrapped at any blank.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_pin_that_is_off_is_told_in_every_output() {
    let folder = Folder::new("fragile-off");
    let off = three_cranks(&folder, "off.toml", 4e-4);
    let right = three_cranks(&folder, "right.toml", 0.0);

    let text = flat(&said(&["analyze", &off]));
    for words in [
        "O1, P1, O2, P2, O3, P3 revolute 1–2, 3–4, 5–6, 7–8, 9–10, 11–12 unique, FRAGILE",
        "`P3` are unique but would change by up to several times their size",
        "if the point of `O2` on its first body moves by 0.24 mm",
        "one row is redundant from a tolerance of 0.049 mm on",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(!text.contains("misalignment of 1e-6"), "{text}");

    let d = document(&["analyze", &off, "--json"]);
    for r in d["reactions"].as_array().expect("a list") {
        assert_eq!(
            (&r["verdict"], &r["fragile"]),
            (&"unique".into(), &true.into())
        );
        assert!(r["sensitivity"].as_f64().is_some_and(|x| x > 0.1), "{r:#}");
    }
    let from = d["data"]["lower_rank_from"].as_f64().expect("near");
    // The tolerance is an eighth of the violation, because eight points share it.
    assert!((from / 5e-5 - 1.0).abs() < 0.05, "{from}");
    assert!(d["evidence"]["nearly_redundant"]["change_per_micrometre"].is_number());

    let text = flat(&said(&["check", &off]));
    assert!(
        text.contains("warning: `O1`, `P1`, `O2`, `P2`, `O3` and `P3` are unique but would change"),
        "{text}"
    );
    // Rounding locks the mechanism: without the offset of the pins it moves.
    let locked =
        "warning: mobility 0 for data as written, but 1 if lengths are accurate only to 0.049 mm";
    assert!(text.contains(locked), "{text}");
    assert!(!said(&["check", &right]).contains("lengths are accurate only to"));

    let out = folder.0.join("run");
    let out = out.to_str().expect("UTF-8");
    let text = said(&["simulate", &off, "--out", out]);
    assert!(
        text.contains(
            "warning: unique but ill-determined (fragile) at the start: O1, P1, O2, P2, O3, P3."
        ),
        "{text}"
    );
    assert!(flat(&text).contains(locked), "{text}");
    let summary: Value = serde_json::from_str(&folder.read("run/summary.json")).expect("JSON");
    for name in NAMES {
        let r = &summary["reactions"][name];
        assert_eq!(
            (&r["verdict"], &r["fragile"]),
            (&"unique".into(), &true.into())
        );
        let of_name = |x: &&Value| x["name"] == name;
        let other = d["reactions"]
            .as_array()
            .and_then(|all| all.iter().find(of_name));
        assert_eq!(other.map(|r| &r["sensitivity"]), Some(&r["sensitivity"]));
    }
    let page = folder.read("run/report.html");
    assert!(page.contains("are unique but fragile"), "headline");
    assert!(
        page.contains("<span class=\"badge fragile\">unique, fragile</span>"),
        "table"
    );
    assert!(!page.contains("All reactions are unique"));

    let picture = folder.0.join("off.svg");
    let picture = picture.to_str().expect("UTF-8");
    let view = ["view", &off, "--no-open", "--out", picture];
    let text = said(&view);
    assert!(
        text.contains("0 not unique, 6 unique but FRAGILE"),
        "{text}"
    );
    let d = document(&[&view[..], &["--json"]].concat());
    assert_eq!((&d["not_unique"], &d["fragile"]), (&0.into(), &6.into()));

    let text = said(&["diff", &off, &right]);
    assert!(
        text.contains("unique, FRAGILE  not unique (Fx, Fy)"),
        "{text}"
    );
    let d = document(&["diff", &off, &right, "--json"]);
    assert_eq!(d["changed"][0]["a"]["fragile"], true);
    assert_eq!(d["changed"][0]["b"]["fragile"], false);

    let table = folder.0.join("sweep");
    let table = table.to_str().expect("UTF-8");
    said(&[
        "sweep",
        &off,
        "--vary",
        "body.coupler.mass=3,4",
        "--out",
        table,
    ]);
    let table = folder.read("sweep/sweep.csv");
    let mut lines = table.lines();
    let place = lines
        .next()
        .and_then(|head| head.split(',').position(|name| name == "fragile"));
    let place = place.expect("a column");
    let counts: Vec<_> = lines.map(|line| line.split(',').nth(place)).collect();
    assert_eq!(counts, [Some("6"), Some("6")]);
}

/// A lid of 18 kg has four hinges, one of them half a millimetre off the line of the others.
const HATCH: &str = "scene = { name = \"hatch\", space = \"spatial\", gravity = [0, 0, -9.81] }
body = [{ name = \"lid\", mass = 18, inertia = [0.8, 1.2, 2], centre = [0, 0.35, 0.02] }]
joint = [
    { name = \"hinge 1\", type = \"revolute\", bodies = [\"ground\", \"lid\"], at = [-0.4, 0, 0], axis = [1, 0, 0] },
    { name = \"hinge 2\", type = \"revolute\", bodies = [\"ground\", \"lid\"], at = [-0.15, 0, 0], axis = [1, 0, 0] },
    { name = \"hinge 3\", type = \"revolute\", bodies = [\"ground\", \"lid\"], at = [0.15, 0.0005, 0], axis = [1, 0, 0] },
    { name = \"hinge 4\", type = \"revolute\", bodies = [\"ground\", \"lid\"], at = [0.4, 0, 0], axis = [1, 0, 0] },
]
";

/// No hinge is unique, but one component of one hinge is unique. It comes from the half millimetre:
/// W·c/e = 124 kN.
#[test]
fn a_component_that_hangs_on_the_last_digits_is_told_in_every_output() {
    let folder = Folder::new("fragile-component");
    fs::create_dir_all(&folder.0).expect("writable");
    let hatch = folder.0.join("hatch.toml");
    fs::write(&hatch, HATCH).expect("writable");
    let hatch = hatch.to_str().expect("UTF-8");
    let (sum, all) = (
        "hinge 1.Fz + hinge 2.Fz + hinge 4.Fz",
        "hinge 1 + hinge 2 + hinge 3 + hinge 4",
    );
    let combine = ["--combine", sum, "--combine", all];
    let text = flat(&said(&[&["analyze", hatch][..], &combine].concat()));
    for words in [
        "hinge 3 revolute 11–15 not unique, unique parts FRAGILE",
        "Fz unique, FRAGILE",
        "FRAGILE: `hinge 3.Fz` is unique but",
        "hinge 1.Fz + hinge 2.Fz + hinge 4.Fz: unique, FRAGILE",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let arguments = [
        "analyze", hatch, "--json", "--frames", "--about", "0.15,0,0",
    ];
    let d = document(&[&arguments[..], &combine].concat());
    let hinge = &d["reactions"][2];
    assert_eq!(
        (&hinge["verdict"], &hinge["fragile"]),
        (&"not_unique".into(), &true.into())
    );
    let of = |list: &Value, name: &str| {
        let list = list.as_array().expect("a list").clone();
        list.into_iter()
            .find(|c| c["name"] == name)
            .expect("such a component")
    };
    let fz = of(&hinge["components"], "Fz");
    assert_eq!(
        (&fz["verdict"], &fz["fragile"]),
        (&"unique".into(), &true.into())
    );
    assert_eq!(fz["sensitivity"], hinge["sensitivity"]);
    assert!(
        fz["hangs_on"]
            .as_str()
            .is_some_and(|s| s.starts_with("`hinge 3.Fz` is unique but"))
    );
    let fx = of(&hinge["components"], "Fx");
    assert_eq!(
        (&fx["sensitivity"], &fx["fragile"]),
        (&Value::Null, &false.into())
    );
    assert_eq!(d["reactions"][0]["fragile"], false);
    let in_frame = of(&hinge["frames"][0]["components"], "Fz");
    assert_eq!(in_frame["sensitivity"], fz["sensitivity"]);
    assert_eq!(
        (&d["groups"][0]["verdict"], &d["groups"][0]["fragile"]),
        (&"unique".into(), &true.into())
    );
    // The weight is that of the lid, whatever the share of the hinges is.
    let whole = of(&d["groups"][1]["components"], "Fz");
    assert_eq!(
        (&whole["verdict"], &whole["fragile"]),
        (&"unique".into(), &false.into())
    );
    assert!(
        whole["sensitivity"].as_f64().is_some_and(|x| x < 1e-3),
        "{whole:#}"
    );

    assert!(flat(&said(&["check", hatch])).contains("warning: `hinge 3.Fz` is unique but"));
    let picture = folder.0.join("hatch.svg");
    let view = [
        "view",
        hatch,
        "--no-open",
        "--out",
        picture.to_str().expect("UTF-8"),
    ];
    assert!(said(&view).contains("4 not unique, 1 with FRAGILE components"));
    let page = folder.0.join("hatch.html");
    said(&[
        "view",
        hatch,
        "--no-open",
        "--out",
        page.to_str().expect("UTF-8"),
    ]);
    let page = folder.read("hatch.html");
    assert!(
        page.contains("Unique components of the reactions of hinge 3 are fragile"),
        "headline"
    );
    assert!(
        page.contains("not unique, unique components fragile"),
        "table"
    );
    let straight = folder.0.join("straight.toml");
    fs::write(&straight, HATCH.replace("0.0005", "0")).expect("writable");
    let straight = straight.to_str().expect("UTF-8");
    let text = said(&["diff", hatch, straight]);
    assert!(text.contains("FRAGILE: Fz"), "{text}");
}

/// The verdicts are equal, and only one of them depends on the last digits of the data.
#[test]
fn a_difference_in_nothing_else_is_told() {
    let folder = Folder::new("fragile-diff");
    let near = three_cranks(&folder, "near.toml", 4e-4);
    let far = three_cranks(&folder, "far.toml", 0.4);
    let d = document(&["diff", &near, &far, "--json"]);
    let changed = d["changed"].as_array().expect("a list");
    assert_eq!(changed.len(), 6, "{changed:#?}");
    for change in changed {
        assert_eq!(change["a"]["verdict"], change["b"]["verdict"]);
        assert_eq!(
            (&change["a"]["fragile"], &change["b"]["fragile"]),
            (&true.into(), &false.into())
        );
    }
}

#[test]
fn with_the_pin_where_it_belongs_nothing_is_fragile() {
    let folder = Folder::new("fragile-right");
    let right = three_cranks(&folder, "right.toml", 0.0);
    let d = document(&["analyze", &right, "--json"]);
    for r in d["reactions"].as_array().expect("a list") {
        assert_eq!(r["verdict"], "not_unique");
        assert_eq!(
            (&r["sensitivity"], &r["fragile"]),
            (&Value::Null, &false.into())
        );
    }
    for command in ["analyze", "check"] {
        assert!(!said(&[command, &right]).to_lowercase().contains("fragile"));
    }
}

/// A warning that appears in every scene would be useless.
#[test]
fn ordinary_scenes_have_no_fragile_reaction() {
    let folder = Folder::new("fragile-ordinary");
    fs::create_dir_all(&folder.0).expect("writable");
    let beam = folder.0.join("beam.toml");
    fs::write(
        &beam,
        "scene = { name = \"beam\", space = \"plane\", gravity = [0.0, -9.81] }
body = [{ name = \"beam\", mass = 4.0, inertia = 1.0, position = [1.0, 0.0] }]
joint = [
    { name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"beam\"], at = [0.0, 0.0] },
    { name = \"roller\", type = \"pin-in-slot\", bodies = [\"ground\", \"beam\"], at = [2.0, 0.0], axis = [1.0, 0.0] },
]
",
    )
    .expect("writable");
    let chain = folder.0.join("chain.toml");
    let chain = chain.to_str().expect("UTF-8");
    fs::write(chain, super::generated(Kind::NFourBar, 40)).expect("writable");
    let examples = fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples"));
    let examples = examples.expect("readable").flatten().map(|e| e.path());
    let mut scenes: Vec<_> = examples
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    assert!(scenes.len() > 10);
    scenes.extend([beam, ROBOT.into(), chain.into()]);
    let picture = folder.0.join("picture.svg");
    let picture = picture.to_str().expect("UTF-8");
    for scene in scenes {
        let scene = scene.to_str().expect("UTF-8");
        let d = document(&["view", scene, "--json", "--no-open", "--out", picture]);
        assert_eq!(d["fragile"], 0, "{scene}");
    }
}

/// Every robot of a fleet has the same report as a single robot, with and without springs between
/// them.
#[test]
fn robots_of_a_fleet_are_as_fragile_as_one() {
    let folder = Folder::new("fragile-fleet");
    fs::create_dir_all(&folder.0).expect("writable");
    let sensitivities = |scene: &str| -> Vec<(String, Option<f64>)> {
        let d = document(&["analyze", scene, "--json"]);
        let reactions = d["reactions"].as_array().expect("a list").iter();
        let told = reactions.map(|r| {
            assert_eq!(r["fragile"], false, "{r:#}");
            let name = r["name"].as_str().expect("a name");
            (name.to_owned(), r["sensitivity"].as_f64())
        });
        told.collect()
    };
    let alone = sensitivities(ROBOT);
    assert!(alone.iter().filter(|(_, s)| s.is_some()).count() >= 7);
    for n in [1, 2, 3, 10] {
        let path = folder.0.join(format!("fleet-{n}.toml"));
        let path = path.to_str().expect("UTF-8");
        fs::write(path, super::generated(Kind::Fleet, n)).expect("writable");
        let found = sensitivities(path);
        assert_eq!(found.len(), n * alone.len());
        for (name, sensitivity) in &found {
            let own = name.split_once('.').expect("of a robot").1;
            let expected = alone.iter().find(|(name, _)| name == own);
            let expected = expected.expect("the same joint").1;
            // Both are printed to three digits.
            let is_near = match (sensitivity, expected) {
                (Some(found), Some(alone)) => (found - alone).abs() <= 0.011 * alone,
                (found, alone) => found.is_none() && alone.is_none(),
            };
            assert!(is_near, "{n}, {name}: {sensitivity:?}, alone {expected:?}");
        }
    }
}

/// A weight is between a wall and a slope that is almost as steep: both push with 10/0.0001 N
/// against each other, and together they carry the weight. A sum of ill-determined components may
/// be ill-determined, or not.
const WEDGED: &str = r#"
scene = { name = "wedged", space = "plane", gravity = [0.0, -10.0] }
body = [{ name = "weight", mass = 1.0, inertia = 1.0 }]
joint = [
    { name = "wall", type = "knife-edge", body = "weight", at = [0.0, 0.0], normal = [1.0, 0.0] },
    { name = "slope", type = "knife-edge", body = "weight", at = [0.0, 0.0], normal = [1.0, 0.0001] },
]
group = [
    { name = "level", combine = "wall.Fx + slope.Fx" },
    { name = "skew", combine = "wall.Fx + 2*slope.Fx" },
    { name = "all", combine = "wall + slope" },
    { name = "pair", members = ["wall", "slope"] },
]
simulate = { t_end = 0.01 }
"#;

#[test]
fn groups_are_fragile_by_their_own_numbers() {
    let folder = Folder::new("wedged");
    fs::create_dir_all(&folder.0).expect("writable");
    let path = folder.0.join("wedged.toml");
    fs::write(&path, WEDGED).expect("writable");
    let (scene, out) = (path.to_str().expect("UTF-8"), folder.0.join("out"));
    let out = out.to_str().expect("UTF-8");
    let analysis = document(&["analyze", scene, "--json"]);
    let run = document(&["simulate", scene, "--out", out, "--json"]);
    let at = |name: &str| {
        let groups = analysis["groups"].as_array().expect("a list");
        groups.iter().find(|g| g["name"] == name).expect("exists")
    };
    for name in ["wall", "slope"] {
        assert_eq!(run["reactions"][name]["components"]["Fx"]["fragile"], true);
    }
    for (name, fragile) in [
        ("level", false),
        ("skew", true),
        ("all", true),
        ("pair", true),
    ] {
        let of_run = &run["groups"][name];
        assert_eq!(of_run["verdict"], "unique", "{name}");
        assert_eq!(of_run["fragile"], fragile, "{name}: {of_run:#}");
        assert!(of_run["sensitivity"].is_number(), "{name}: {of_run:#}");
        for key in ["fragile", "sensitivity", "hangs_on"] {
            assert_eq!(of_run[key], at(name)[key], "{name}.{key}");
        }
    }
    let components = run["groups"]["all"]["components"]
        .as_object()
        .expect("a sum of wrenches");
    for (name, component) in components {
        // Points that are no longer coincident are the arm of a couple. If one is 0.1 mm higher,
        // the weight slides down and rotates, ÿ = −φ̈: 10 N accelerate m + I, which has the size of
        // 2·m, and the supports carry 5 N. To first order there is no change.
        assert_eq!(component["fragile"], name != "Fx", "{name}: {component:#}");
        if name == "Fy" {
            let change = component["sensitivity"].as_f64().expect("a number");
            assert!((change - 0.5).abs() < 1e-3, "{component:#}");
        }
    }
    let sensitivity = &run["groups"]["level"]["sensitivity"];
    assert!(
        sensitivity.as_f64().is_some_and(|x| x < 1e-3),
        "{sensitivity}"
    );
    let table = folder.read("out/reactions.csv");
    let header = table.lines().next().expect("a header");
    let columns: Vec<&str> = header.split(',').collect();
    for name in [
        "level",
        "skew.fragile",
        "all.Fx",
        "all.Fy.fragile",
        "all.T.fragile",
    ] {
        assert!(columns.contains(&name), "{name}: {header}");
    }
    let simulated = said(&["simulate", scene, "--out", out]);
    let named = "ill-determined (fragile) at the start: wall, slope, skew, all, pair.";
    assert!(simulated.contains(named), "{simulated}");
    let checked = flat(&said(&["check", scene]));
    for name in ["`skew`", "`all.T`"] {
        let sentence = format!("{name} is unique but");
        assert!(checked.contains(&sentence), "{sentence}: {checked}");
    }
    assert!(
        !checked.contains("`level`") && !checked.contains("`pair`"),
        "{checked}"
    );
    let analyzed = flat(&said(&["analyze", scene]));
    assert!(analyzed.contains("skew: unique, FRAGILE"), "{analyzed}");
    assert!(analyzed.contains("level: unique (margin"), "{analyzed}");
}
