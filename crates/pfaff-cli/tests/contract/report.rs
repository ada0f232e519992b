//! Tests `report.html` of a run: one file, complete, safe, small, and the same for the same input.

use serde_json::{Value, json};
use suite::generate::Kind;

use super::bad_input::{PENDULUM, contradiction_at_half_a_second};
use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// Largest size of the page of the published mechanism (bytes); the specification allows 3 MB.
const ROBOT_MOST: usize = 600_000;

/// Runs a scene into a folder.
#[track_caller]
fn page(folder: &Folder, scene: &str) -> String {
    let output = with_scene(&["simulate", "-", "--out", folder.text()], scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    folder.read("report.html")
}

/// Returns the document that scripts can read.
#[track_caller]
pub(crate) fn data(page: &str) -> Value {
    let begin = "<script id=\"data\" type=\"application/json\">";
    let after = page.split_once(begin).expect("the page has data").1;
    let text = after.split_once("</script>").expect("the data end").0;
    serde_json::from_str(text).expect("the data are JSON")
}

/// Removes the run time, the only number that differs between runs.
pub(crate) fn without_time(page: &str) -> String {
    let (before, after) = page
        .split_once("<dt>Run time of the integration</dt>")
        .expect("the page contains the time");
    let after = after.split_once("</dd>").expect("a value").1;
    format!("{before}{after}")
}

fn joint<'a>(data: &'a Value, name: &str) -> (usize, &'a Value) {
    let joints = data["joints"].as_array().expect("a list");
    let found = joints.iter().enumerate().find(|(_, j)| j["name"] == name);
    found.unwrap_or_else(|| panic!("no joint `{name}`"))
}

#[test]
fn the_page_of_the_robot_is_small_and_fetches_nothing() {
    let folder = Folder::new("report-robot");
    let output = pfaff(&["simulate", ROBOT, "--out", folder.text()]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(stdout(&output).contains("report.html"));
    let page = folder.read("report.html");
    assert!(page.len() < ROBOT_MOST, "{} bytes", page.len());
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
    let addresses: Vec<&str> = page
        .match_indices("http")
        .map(|(at, _)| page[at..].split('"').next().unwrap_or_default())
        .filter(|address| address.starts_with("http://") || address.starts_with("https://"))
        .collect();
    assert_eq!(
        addresses,
        ["http://www.w3.org/2000/svg"],
        "the name of SVG only"
    );
    for fetch in [
        "<link",
        "@import",
        "url(http",
        "fetch(",
        "import(",
        "src=\"http",
        "XMLHttp",
    ] {
        assert!(!page.contains(fetch), "`{fetch}`");
    }
    assert!(page.contains("default-src 'none'"));
    assert!(page.contains("22 constraint rows have rank 20: two rows are redundant"));
    assert!(page.contains("The reactions of B, C, W1, W2, W3 and W4 are not unique"));
}

#[test]
fn reactions_that_are_not_unique_come_with_several_choices() {
    let folder = Folder::new("report-choices");
    let output = pfaff(&["simulate", ROBOT, "--t-end", "2", "--out", folder.text()]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let data = data(&folder.read("report.html"));
    let compared: Vec<u64> = data["comparisons"]
        .as_array()
        .expect("a list")
        .iter()
        .flat_map(|c| c["joints"].as_array().expect("a list"))
        .filter_map(Value::as_u64)
        .collect();
    for j in data["joints"].as_array().expect("a list") {
        let (k, _) = joint(&data, j["name"].as_str().expect("a name"));
        let is_compared = compared.contains(&(k as u64));
        assert_eq!(is_compared, j["verdict"] == "not_unique", "{}", j["name"]);
    }
    let comparison = &data["comparisons"][0];
    let choices = comparison["choices"].as_array().expect("a list");
    assert!(choices.len() >= 4, "{}", choices.len());
    let labels: Vec<&str> = choices.iter().filter_map(|c| c["label"].as_str()).collect();
    assert!(labels[0].starts_with("this run: rows 20, 21"), "{labels:?}");
    assert!(labels[1].starts_with("least norm"), "{labels:?}");
    assert!(labels[2].starts_with("no reaction in rows"), "{labels:?}");
    // Fx of B is determined at the start, because B is on the axis of the platform, but not after
    // the platform has rotated.
    let (place, b) = joint(&data, "B");
    let at = compared.iter().position(|k| *k == place as u64);
    let at = at.expect("B is compared");
    assert_eq!(b["components"][0]["verdict"], "not_unique");
    assert_eq!(
        b["components"][0]["determined"],
        serde_json::json!([[0.0, 1.0]])
    );
    let free = &comparison["freedom"][at]["components"];
    assert_eq!(*free, serde_json::json!([true, true, false]));
    // An edge has a force only along its normal, which rotates with its body: the other direction
    // remains determined.
    let edge = joint(&data, "W1").0 as u64;
    let edge = compared.iter().position(|k| *k == edge);
    let edge = edge.expect("W1 is compared");
    let in_body = &comparison["freedom"][edge]["in_body"];
    assert_eq!(*in_body, serde_json::json!([false, true]));
    let curve = |choice: &Value| choice["wrenches"][at][1].to_string();
    assert!(choices.iter().any(|c| curve(c) != curve(&choices[0])));
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let folder = Folder::new("report-same");
    let first = without_time(&page(&folder, PENDULUM));
    assert_eq!(first, without_time(&page(&folder, PENDULUM)));
}

#[test]
fn names_are_text_wherever_they_stand() {
    let name = "</script><script>alert(1)</script>";
    let scene = PENDULUM
        .replace("bob", name)
        .replace("\"pivot\"", "\"<img src=x onerror=alert(2)>\"")
        .replace("name = \"pendulum\"", "name = \"]]><!-- & \\\"'\"");
    let folder = Folder::new("report-names");
    let page = page(&folder, &scene);
    // The page contains only the closing tags of its two scripts.
    assert_eq!(page.matches("</script>").count(), 2);
    assert!(
        !page.contains("<script>alert") && !page.contains("<img src=x") && !page.contains("<!-- &")
    );
    let data = data(&page);
    assert_eq!(data["drawing"]["bodies"][0]["name"], name);
    assert_eq!(data["name"], "]]><!-- & \"'");
    // The page contains the text of the scene.
    assert!(page.contains("name = &quot;&lt;/script&gt;"));
}

#[test]
fn a_page_that_is_not_wanted_is_not_made() {
    let folder = Folder::new("report-none");
    let scene = format!("{PENDULUM}\n[output]\nreport = false\n");
    let output = with_scene(&["simulate", "-", "--out", folder.text()], &scene);
    assert_eq!(output.status.code(), Some(0));
    assert!(!folder.0.join("report.html").exists());
    assert!(!stdout(&output).contains("report.html"));
}

#[test]
fn tables_have_the_rows_that_were_asked_for_whatever_the_page_needs() {
    let coarse = PENDULUM.replace("t_end = 1.0", "t_end = 1.0\noutput_step = 0.3");
    let folder = Folder::new("report-rows");
    let page = page(&folder, &coarse);
    let times: Vec<String> = folder
        .read("trajectory.csv")
        .lines()
        .skip(1)
        .filter_map(|line| line.split(',').next().map(str::to_owned))
        .collect();
    let (with, reactions) = (folder.read("trajectory.csv"), folder.read("reactions.csv"));
    assert_eq!(times.len(), 5, "{times:?}");
    assert!(data(&page)["t"].as_array().is_some_and(|t| t.len() >= 200));
    // The bytes are the same as without a page.
    let scene = format!("{coarse}\n[output]\nreport = false\n");
    let output = with_scene(&["simulate", "-", "--out", folder.text()], &scene);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(folder.read("trajectory.csv"), with);
    assert_eq!(folder.read("reactions.csv"), reactions);
}

#[test]
fn a_run_that_stops_has_a_page_that_says_so() {
    let folder = Folder::new("report-partial");
    let scene = contradiction_at_half_a_second();
    let output = with_scene(&["simulate", "-", "--out", folder.text()], &scene);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let page = folder.read("report.html");
    assert!(
        page.contains("<b>Partial:</b> the run ended at t = 0."),
        "no warning"
    );
    let last = data(&page)["t"]
        .as_array()
        .and_then(|t| t.last().and_then(Value::as_f64));
    assert!(last.is_some_and(|t| t <= 0.5), "{last:?}");
}

#[test]
fn a_large_mechanism_is_drawn_in_part_and_says_so() {
    let folder = Folder::new("report-large");
    let scene = super::generated(Kind::NFourBar, 800);
    let output = with_scene(
        &["simulate", "-", "--t-end", "0.01", "--out", folder.text()],
        &scene,
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let page = folder.read("report.html");
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
    assert!(page.contains("The picture and the curves show "));
    let drawn = data(&page)["joints"].as_array().map(Vec::len);
    assert!(
        drawn.is_some_and(|n| (1100..=1200).contains(&n)),
        "{drawn:?}"
    );
}

#[test]
fn a_comparison_of_methods_in_the_same_directory_is_taken_in() {
    let folder = Folder::new("report-comparison");
    std::fs::create_dir_all(&folder.0).expect("a directory");
    let figure = "<svg xmlns=\"http://www.w3.org/2000/svg\"><text>#1</text></svg>";
    std::fs::write(folder.0.join("work_precision.svg"), figure).expect("a file");
    let page = page(&folder, PENDULUM);
    assert!(
        page.contains("src=\"data:image/svg+xml,%3Csvg xmlns=%22http://www.w3.org/2000/svg%22%3E")
    );
    assert!(page.contains("%231"));
}

/// The configuration of meshing wheels contains unwrapped angles; pictures use only the bodies.
#[test]
fn wheels_in_mesh_have_a_page() {
    let scene = r#"
scene = { name = "spur", space = "spatial" }
body = [
  { name = "a", mass = 1.0, inertia = [0.1, 0.1, 0.1], angular_velocity = [0, 0, 3] },
  { name = "b", mass = 1.0, inertia = [0.1, 0.1, 0.1], position = [0.3, 0, 0] },
]
joint = [
  { name = "A", type = "revolute", bodies = ["ground", "a"], at = [0, 0, 0], axis = [0, 0, 1] },
  { name = "B", type = "revolute", bodies = ["ground", "b"], at = [0.3, 0, 0], axis = [0, 0, 1] },
  { name = "teeth", type = "mesh", bearings = ["A", "B"], at = [0.1, 0, 0] },
]
force = [{ name = "mount", type = "bushing", bodies = ["ground", "a"], at = [0, 0, 0],
  stiffness = [0, 0, 0, 0, 0, 5], damping = [0, 0, 0, 0, 0, 0.1] }]
simulate = { t_end = 1.0 }
"#;
    let folder = Folder::new("report-mesh");
    let page = page(&folder, scene);
    let data = data(&page);
    for name in ["A", "B"] {
        joint(&data, name);
    }
    // The symbol is at the contact of the teeth, and the wheels have the radii of the ratio.
    let (k, _) = joint(&data, "teeth");
    let site = &data["drawing"]["sites"][k];
    assert_eq!(site["symbol"], "rotation");
    assert_eq!(site["place"], json!({ "b": -1, "p": [0.1, 0, 0] }));
    assert_eq!(site["end"], Value::Null);
    let wheel = |b: i32, r: f64| json!({ "b": b, "p": [0, 0, 0], "axis": [0, 0, 1], "r": r });
    assert_eq!(site["wheels"], json!([wheel(0, 0.1), wheel(1, 0.2)]));
}

/// A wheel of radius 0.5 with the axis y is on the ground z = 0.
#[test]
fn a_wheel_on_the_ground_is_drawn_as_a_circle() {
    let scene = r#"
scene = { name = "wheel", space = "spatial", gravity = [0, 0, -9.81] }
body = [{ name = "disk", mass = 1.0, inertia = [0.1, 0.2, 0.1], position = [0, 0, 0.5], velocity = [1, 0, 0], angular_velocity = [0, 2, 0] }]
joint = [{ name = "tread", type = "wheel", body = "disk", point = [0, 0, 0], axis = [0, 1, 0], radius = 0.5 }]
simulate = { t_end = 1.0 }
"#;
    let folder = Folder::new("report-wheel");
    let data = data(&page(&folder, scene));
    let wheels = &data["drawing"]["sites"][0]["wheels"];
    assert_eq!(wheels.as_array().map(Vec::len), Some(1), "{wheels}");
    let number = |v: &Value| v.as_f64().expect("a number");
    assert!((number(&wheels[0]["r"]) - 0.5).abs() < 1e-6, "{wheels}");
    for (k, axis) in [0.0, 1.0, 0.0].into_iter().enumerate() {
        assert!(
            (number(&wheels[0]["axis"][k]).abs() - axis).abs() < 1e-6,
            "{wheels}"
        );
        assert!(number(&wheels[0]["p"][k]).abs() < 1e-6, "{wheels}");
    }
}

/// A bar of length 2 is on two pins, with a pendulum of length 1. The pins can push against each
/// other only along the bar, and the pendulum turns about its pin.
#[test]
fn self_stresses_and_free_motions_are_loads_and_velocities() {
    let scene = r#"
scene = { name = "bar", space = "plane" }
body = [
  { name = "bar", mass = 1.0, inertia = 0.3, position = [1, 0] },
  { name = "bob", mass = 1.0, inertia = 0.1, position = [0, -1] },
]
joint = [
  { name = "left", type = "revolute", bodies = ["ground", "bar"], at = [0, 0] },
  { name = "right", type = "revolute", bodies = ["ground", "bar"], at = [2, 0] },
  { name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0, 0] },
]
simulate = { t_end = 0.1 }
"#;
    let folder = Folder::new("report-first-order");
    let page = page(&folder, scene);
    let data = data(&page);
    let (left, right) = (joint(&data, "left").0, joint(&data, "right").0);
    let stresses = data["stresses"].as_array().expect("a list");
    assert_eq!(stresses.len(), 1);
    assert_eq!(stresses[0]["joints"], json!([left, right]));
    let loads = &stresses[0]["wrenches"];
    let sum: Vec<f64> = (0..3)
        .map(|k| {
            loads[0][k].as_f64().unwrap_or(f64::NAN) + loads[1][k].as_f64().unwrap_or(f64::NAN)
        })
        .collect();
    assert_eq!(sum, [0.0; 3], "{loads}");
    assert_eq!(loads[0][0].as_f64().map(f64::abs), Some(1.0), "{loads}");
    let motions = data["motions"].as_array().expect("a list");
    assert_eq!(motions.len(), 1);
    let moving = motions[0]["velocities"][0][0].as_array().expect("a body");
    assert_eq!(moving[0], 1);
    let v: Vec<f64> = moving[1]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_f64)
        .collect();
    // Its frame is one metre below the pivot: v = (ω, 0).
    assert_eq!(v.len(), 3);
    assert!(
        (v[0] - v[2]).abs() < 1e-9 && v[1].abs() < 1e-9 && v[2].abs() > 0.5,
        "{v:?}"
    );
    // Components that are not determined have no peak.
    let peaks = page
        .split_once("Peak loads</h2>")
        .expect("a table of peaks")
        .1;
    let row = |name: &str| {
        let begin = format!("<td><b>{name}</b></td>");
        peaks
            .split_once(&begin)
            .expect("a row")
            .1
            .split_once("</tr>")
            .expect("its end")
            .0
    };
    assert!(row("pivot").contains("every choice (unique reaction)"));
    let left = row("left");
    assert!(
        left.contains("the other components are not determined"),
        "{left}"
    );
    assert!(!left.contains("deleted"), "{left}");
}
