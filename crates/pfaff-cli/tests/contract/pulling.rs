//! Contacts that pull, described sides of one-sided joints, and contacts that open in samples, runs
//! of sweeps and load cases.

use serde_json::Value;

use super::{Folder, stderr, stdout, with_scene};

/// A cart on three balls. Its weight of 98.1 N acts at x = `centre`, the balls A and B are at x =
/// −1 and C is at x = 1: C carries 98.1·(1 + centre)/2, and A and B share the rest.
fn cart(heading: &str, centre: f64, keys: &str) -> String {
    format!(
        r#"
scene = {{ name = "cart", space = "spatial", gravity = [0, 0, -9.81]{heading} }}
body = [{{ name = "cart", mass = 10, inertia = [1, 1, 1], position = [0, 0, 0.5], centre = [{centre}, 0, 0] }}]
joint = [
    {{ name = "A", type = "ball", body = "cart", point = [-1, 0.5, -0.3], radius = 0.2{keys} }},
    {{ name = "B", type = "ball", body = "cart", point = [-1, -0.5, -0.3], radius = 0.2{keys} }},
    {{ name = "C", type = "ball", body = "cart", point = [1, 0, -0.3], radius = 0.2{keys} }},
]
simulate = {{ t_end = 1 }}
"#
    )
}

/// A stone on a floor that a force of 20 N/s·t lifts: its weight of 19.62 N is carried until 0.981
/// s.
const LIFTED: &str = r#"
scene = { name = "stone", space = "spatial", format = 2, gravity = [0, 0, -9.81] }
parameters = { rate = 20.0 }
body = [{ name = "stone", mass = 2, inertia = [0.1, 0.1, 0.1] }]
joint = [{ name = "floor", type = "point-on-plane", bodies = ["ground", "stone"], at = [0, 0, 0], normal = [0, 0, 1] }]
force = [{ name = "crane", type = "point-force", body = "stone", at = [0, 0, 0], force = [0, 0, { type = "polynomial", coefficients = [0, "rate"] }] }]
case = [{ name = "slow", set = ["rate = 15"] }, { name = "fast", set = ["rate = 30"] }]
simulate = { t_end = 1.2, output_step = 0.01 }
"#;

fn one_sided(scene: &str) -> String {
    scene.replace(
        "normal = [0, 0, 1]",
        "normal = [0, 0, 1], one_sided = \"pushes\"",
    )
}

fn warnings(command: &str, scene: &str) -> Vec<String> {
    let out = Folder::new("pulling");
    let arguments = match command {
        "simulate" => vec![command, "-", "--out", out.text()],
        _ => vec![command, "-"],
    };
    let answer = with_scene(&arguments, scene);
    assert!(answer.status.success(), "{}", stderr(&answer));
    let text = stdout(&answer);
    // Compares without line breaks.
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let all = text.split("warning").skip(1);
    let own = all.filter_map(|text| text.split_once("`silence = [\"P0186\"]`"));
    own.map(|(told, _)| told.to_owned()).collect()
}

/// The forces of the cart whose centre of mass is in front of C follow from the lever.
#[test]
fn contacts_that_pull_are_one_warning() {
    for command in ["simulate", "analyze", "check"] {
        let told = warnings(command, &cart("", 1.5, ""));
        let [told] = told.as_slice() else {
            panic!("{command}: {told:?}");
        };
        let each = match command {
            "simulate" => "from t = 0 s on (up to 12.26 N)",
            _ => "at t = 0 s (12.26 N)",
        };
        let joints = format!("contacts pull: `A` {each}, `B` {each}");
        for part in [joints.as_str(), "one_sided"] {
            assert!(told.contains(part), "{command}: {told}");
        }
        assert!(!told.contains("`C`"), "{told}");
        // The centre of mass is between the balls, or just above C: no contact pulls.
        for centre in [0.0, 1.0] {
            assert!(warnings(command, &cart("", centre, "")).is_empty());
        }
        let silent = cart(", silence = [\"P0186\"]", 1.5, "");
        assert!(warnings(command, &silent).is_empty());
        // The loads of four legs are not unique: one of many solutions is no reason for a warning.
        let table = include_str!("../../../../examples/table.toml");
        assert!(warnings(command, table).is_empty());
    }
}

#[test]
fn the_first_time_of_a_pull_is_that_of_the_row() {
    let out = Folder::new("first-pull");
    let answer = with_scene(&["simulate", "-", "--json", "--out", out.text()], LIFTED);
    assert!(answer.status.success(), "{}", stderr(&answer));
    let d: Value = serde_json::from_str(&stdout(&answer)).expect("JSON");
    let [pull] = d["pulls"].as_array().expect("pulls").as_slice() else {
        panic!("{}", d["pulls"]);
    };
    let number = |key: &str| pull[key].as_f64().expect("a number");
    assert_eq!(pull["joint"], "floor");
    assert!((number("from") - 0.99).abs() < 1e-12, "{pull}");
    assert!((number("time") - 1.2).abs() < 1e-12, "{pull}");
    assert!(
        (number("force") - (20.0 * 1.2 - 2.0 * 9.81)).abs() < 1e-9,
        "{pull}"
    );
}

#[test]
fn a_one_sided_joint_described_on_the_wrong_side_is_refused() {
    let keys = ", one_sided = \"pushes\"";
    let shifted = |z: f64| {
        let start = cart("", 0.0, keys)
            .replace("position = [0, 0, 0.5]", &format!("position = [0, 0, {z}]"));
        format!("start = {{ allow_correction = true }}\n{start}")
    };
    // 200 mm below the floor, although a correction of any size is permitted.
    let answer = with_scene(&["check", "-"], &shifted(0.3));
    let text = stderr(&answer);
    assert_eq!(answer.status.code(), Some(2), "{text}");
    for part in ["P0216", "`A` by 0.2 m"] {
        assert!(text.contains(part), "{text}");
    }
    // An open gap is closed, and a thousandth of the size is not a side.
    for z in [0.7, 0.4999] {
        let answer = with_scene(&["check", "-"], &shifted(z));
        assert!(answer.status.success(), "{}", stderr(&answer));
    }
    // A joint that is not one-sided has no side.
    let free = shifted(0.3).replace(keys, "");
    assert!(with_scene(&["check", "-"], &free).status.success());
}

#[test]
fn a_run_of_a_sweep_whose_contacts_open_has_its_own_status() {
    let out = Folder::new("opened-sweep");
    let arguments = ["sweep", "-", "--vary", "rate=10,20,40", "--out", out.text()];
    let answer = with_scene(&arguments, &one_sided(LIFTED));
    assert!(answer.status.success(), "{}", stderr(&answer));
    let text = stdout(&answer);
    assert!(
        text.contains("1 done, 2 ended when contacts opened"),
        "{text}"
    );
    let table = out.read("sweep.csv");
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let head = rows.headers().expect("a header").clone();
    let place = |name: &str| head.iter().position(|own| own == name).expect("a column");
    let (status, t, rate) = (place("status"), place("t"), place("rate"));
    for row in rows.records() {
        let row = row.expect("a row");
        let number = |k: usize| row[k].parse::<f64>().expect("a number");
        let opens = 19.62 / number(rate);
        if opens > 1.2 {
            assert_eq!(&row[status], "done");
        } else {
            assert_eq!(&row[status], "opened");
            assert!((number(t) - opens).abs() < 1e-9, "{row:?}");
        }
    }
}

#[test]
fn a_load_case_whose_contacts_open_is_told() {
    let out = Folder::new("opened-case");
    let answer = with_scene(
        &["cases", "-", "--json", "--out", out.text()],
        &one_sided(LIFTED),
    );
    let d: Value = serde_json::from_str(&stdout(&answer)).expect("JSON");
    let status = |k: usize| d["cases"][k]["status"].clone();
    assert_eq!([status(0), status(1)], ["done", "opened"]);
    let error = d["cases"][1]["error"].as_str().expect("a reason");
    assert!(
        error.contains("0.654") && error.contains("`floor`"),
        "{error}"
    );
}

/// A stool of two feet at ± 0.2 m with its centre of mass at 0.199 ± 0.005 m: the left foot opens
/// in a sample iff the centre of mass is beyond the right foot there.
#[test]
fn samples_in_which_contacts_open_are_counted() {
    let scene = r#"
scene = { name = "stool", space = "plane", gravity = [0, -9.81] }
body = [{ name = "seat", mass = 5, inertia = 0.2, position = [0.199, 0.5] }]
joint = [
    { name = "left", type = "point-on-line", body = "seat", at = [-0.2, 0], line = [[-1, 0], [1, 0]], one_sided = "pushes", toward = [0, 1] },
    { name = "right", type = "point-on-line", body = "seat", at = [0.2, 0], line = [[-1, 0], [1, 0]], one_sided = "pushes", toward = [0, 1] },
]
"#;
    let out = Folder::new("opened-samples");
    let vary = "body.seat.position[0]=±0.005";
    let arguments = [
        "tolerance",
        "-",
        "--runs",
        "200",
        "--vary",
        vary,
        "--json",
        "--out",
        out.text(),
    ];
    let answer = with_scene(&arguments, scene);
    assert!(answer.status.success(), "{}", stderr(&answer));
    let d: Value = serde_json::from_str(&stdout(&answer)).expect("JSON");
    let table = out.read("tolerance.csv");
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let head = rows.headers().expect("a header").clone();
    let share = head.iter().position(|own| own.starts_with("varied."));
    let share = share.expect("a column");
    let beyond = rows.records().filter(|row| {
        let row = row.as_ref().expect("a row");
        0.199 + 0.005 * row[share].parse::<f64>().expect("a number") > 0.2
    });
    let beyond = beyond.count() as u64;
    assert!((20..180).contains(&beyond), "{beyond}");
    assert_eq!(d["openings"]["samples"], beyond);
    assert_eq!(
        d["openings"]["joints"],
        serde_json::json!({ "left": beyond })
    );
}

/// The words without line breaks.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// With its centre 0.2 m in front of C, the cart tips about C: A and B pull 4.905 N each.
#[test]
fn an_equilibrium_says_whether_its_contacts_pull() {
    let answer = with_scene(&["equilibrium", "-"], &cart("", 1.2, ""));
    assert!(answer.status.success(), "{}", stderr(&answer));
    let text = flat(&stdout(&answer));
    let warning =
        "warning[P0186]: contacts pull: `A` at t = 0 s (4.905 N), `B` at t = 0 s (4.905 N);";
    assert!(text.contains(warning), "{text}");
    let sided = cart("", 1.2, ", one_sided = \"pushes\"");
    for (command, place) in [
        ("equilibrium", "the position found"),
        ("linearise", "the state at t = 0 s"),
    ] {
        let answer = with_scene(&[command, "-"], &sided);
        assert_eq!(answer.status.code(), Some(1));
        let text = flat(&stderr(&answer));
        let refusal = format!("error[P0429]: at {place} `A`, `B` open: no sharing of the loads");
        assert!(text.contains(&refusal), "{text}");
    }
    let closed = cart("", 0.8, ", one_sided = \"pushes\"");
    for command in ["equilibrium", "linearise"] {
        let answer = with_scene(&[command, "-"], &closed);
        assert!(answer.status.success(), "{}", stderr(&answer));
    }
}

/// A table at rest on four legs that only push.
fn table(centre: [f64; 2], keys: &str) -> String {
    let leg = |(name, at): (&str, [f64; 2])| {
        format!(
            "{{ name = \"{name}\", type = \"point-on-plane\", bodies = [\"ground\", \"top\"], at = [{:?}, {:?}, 0.0], \
             normal = [0, 0, 1]{keys} }},\n",
            at[0], at[1]
        )
    };
    let legs = [
        ("A", [0.6, 0.4]),
        ("B", [-0.6, 0.4]),
        ("C", [-0.6, -0.4]),
        ("D", [0.6, -0.4]),
    ];
    format!(
        "scene = {{ name = \"table\", space = \"spatial\", gravity = [0.0, 0.0, -9.81] }}\n\
         body = [{{ name = \"top\", mass = 12.0, inertia = [1.0, 2.0, 2.5], position = [{:?}, {:?}, 0.7] }}]\n\
         joint = [\n{}]\n",
        centre[0],
        centre[1],
        legs.into_iter().map(leg).collect::<String>()
    )
}

const SIDED: &str = ", one_sided = \"pushes\"";

/// With the load above the edge AB, the least norm lets the leg C pull with 14.715 N.
#[test]
fn choices_that_contacts_do_not_permit_are_named() {
    let ask = [
        "analyze",
        "-",
        "--choose",
        "minimum-norm",
        "--choose",
        "drop:3",
    ];
    let answer = with_scene(&ask, &table([0.3, 0.4], SIDED));
    assert!(answer.status.success(), "{}", stderr(&answer));
    let text = flat(&stdout(&answer));
    let said = "; the contacts do not permit these reactions: `C` pulls choice 2:";
    assert!(text.contains(said), "{text}");
    assert_eq!(text.matches("do not permit").count(), 1, "{text}");
    let answer = with_scene(&[&ask[..], &["--json"]].concat(), &table([0.3, 0.4], SIDED));
    let document: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
    let of = |k: usize| document["choices"][k]["not_permitted"].clone();
    assert_eq!(of(0), serde_json::json!(["`C` pulls"]));
    assert!(of(1).is_null());
}

/// The four tables on three legs, by hand; errors of 1 µm change the loads by less than 1 mN.
#[test]
fn samples_have_the_ranges_that_contacts_permit() {
    let scene = table([0.2, 0.1], SIDED);
    let ask = ["tolerance", "-", "--tolerance", "1e-6", "--runs", "20"];
    let answer = with_scene(&[&ask[..], &["--json"]].concat(), &scene);
    assert!(answer.status.success(), "{}", stderr(&answer));
    let document: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
    let expected = [
        ("A", [34.335, 73.575]),
        ("B", [0.0, 39.24]),
        ("C", [0.0, 39.24]),
        ("D", [4.905, 44.145]),
    ];
    let reactions = document["reactions"].as_array().expect("a list");
    assert_eq!(reactions.len(), expected.len());
    for (name, [least, most]) in expected {
        let own = reactions.iter().find(|r| r["name"] == name).expect(name);
        let values = own["values"].as_array().expect("numbers");
        let along = values.iter().find(|value| value["name"] == "Fz");
        let range = &along.expect("a component")["permitted"];
        let [low, high] = ["lowest", "highest"].map(|end| range[end].as_f64().expect("a limit"));
        // The ground is the first body, so reported reactions are the negative pushes.
        let is_near = (low + most).abs() < 1e-3 && (high + least).abs() < 1e-3;
        let is_wide = low <= -most + 1e-9 && high >= -least - 1e-9;
        assert!(is_near && is_wide, "{name}: {range}");
    }
    let answer = with_scene(&ask, &scene);
    let text = flat(&stdout(&answer));
    let said = "Loads with which the one-sided joints stay closed (contacts may slip), over all samples: reaction what lowest (N) highest (N) ";
    assert!(text.contains(said), "{text}");
    let answer = with_scene(&[&ask[..], &["--json"]].concat(), &table([0.2, 0.1], ""));
    let document: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
    assert!(document["reactions"][0]["values"][0]["permitted"].is_null());
}

#[test]
fn differences_and_pictures_show_one_sided_joints() {
    let folder = Folder::new("pulling-diff");
    std::fs::create_dir_all(&folder.0).expect("writable");
    let path = |name: &str| folder.0.join(name).display().to_string();
    let (two, one) = (path("two.toml"), path("one.toml"));
    std::fs::write(&two, table([0.2, 0.1], "")).expect("writable");
    std::fs::write(&one, table([0.2, 0.1], SIDED)).expect("writable");
    let answer = super::pfaff(&["diff", &two, &one]);
    assert!(answer.status.success(), "{}", stderr(&answer));
    let text = stdout(&answer);
    let changed = text
        .lines()
        .filter(|line| line.contains("two-sided, ") && line.contains("one-sided, "));
    assert_eq!(changed.count(), 4, "{text}");
    let picture = path("table.svg");
    let answer = super::pfaff(&["view", &one, "--out", &picture, "--no-open"]);
    assert!(answer.status.success(), "{}", stderr(&answer));
    let svg = folder.read("table.svg");
    assert!(svg.contains(">A 1 one-sided</text>"), "{svg}");
}
