//! Tests a run in space: its files and its page.

use serde_json::Value;

use super::{Folder, stderr, stdout, with_scene};

/// A top starts at a quaternion with w < 0 and makes about nine revolutions.
const TOP: &str = r#"
[scene]
name = "top"
space = "spatial"
gravity = [0, 0, -9.81]

[[body]]
name = "top"
mass = 15
inertia = [0.234375, 0.46875, 0.234375]
position = [0, 0, 0]
centre = [0, 1, 0]
orientation = { quaternion = [-0.5, 0.5, 0.5, 0.5] }
velocity = [0, 0, 0]
angular_velocity = [3, 10, -4.6]

[[joint]]
name = "S"
type = "spherical"
bodies = ["ground", "top"]
at = [0, 0, 0]

[simulate]
t_end = 5.0
"#;

/// Returns the columns of a table by their names.
fn columns(csv: &str) -> Vec<(String, Vec<f64>)> {
    let mut lines = csv.lines();
    let header = lines.next().expect("a header").split(',');
    let mut columns: Vec<(String, Vec<f64>)> =
        header.map(|name| (name.to_owned(), Vec::new())).collect();
    for line in lines {
        for (column, x) in columns.iter_mut().zip(line.split(',')) {
            column.1.push(x.parse().expect("a number"));
        }
    }
    columns
}

#[test]
fn a_run_has_the_files_of_space() {
    for method in ["dop853", "radau5"] {
        let folder = Folder::new(&format!("space-{method}"));
        let arguments = ["simulate", "-", "--method", method, "--out", folder.text()];
        let output = with_scene(&arguments, TOP);
        assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));

        let table = columns(&folder.read("trajectory.csv"));
        let names: Vec<&str> = table.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(
            names.join(","),
            "t,top.x,top.y,top.z,top.qw,top.qx,top.qy,top.qz,top.vx,top.vy,top.vz,top.wx,top.wy,top.wz"
        );
        // The start has the given orientation, with the sign that makes w ≥ 0. The quaternion does
        // not jump to its negative later: at 11 rad/s and 0.025 s between rows its angle changes by
        // 0.14 rad.
        let quaternion = |row: usize| [4, 5, 6, 7].map(|k| table[k].1[row]);
        assert_eq!(quaternion(0), [0.5, -0.5, -0.5, -0.5]);
        let mut least = 1.0_f64;
        for row in 1..table[0].1.len() {
            let (a, b) = (quaternion(row - 1), quaternion(row));
            let dot: f64 = (0..4).map(|k| a[k] * b[k]).sum();
            assert!(dot > 0.98, "{method}: row {row}: {a:?} {b:?}");
            let length: f64 = b.iter().map(|e| e * e).sum();
            assert!((length - 1.0).abs() < 1e-6, "{method}: row {row}: {b:?}");
            least = least.min(b[0]);
        }
        assert!(
            least < -0.5,
            "{method}: the quaternion goes over its far side: {least}"
        );

        let header = folder.read("reactions.csv");
        let header = header.lines().next().expect("a header");
        assert_eq!(header, "t,S.Fx,S.Fy,S.Fz,S.Tx,S.Ty,S.Tz");
        let summary: Value = serde_json::from_str(&folder.read("summary.json")).expect("JSON");
        assert_eq!(summary["mobility"], 3);
        assert_eq!(summary["reactions"]["S"]["verdict"], "unique");
        assert!(summary["energy_balance"].as_f64().expect("a number") < 1e-6);
    }
}

#[test]
fn the_page_of_a_run_draws_space() {
    let folder = Folder::new("space-page");
    let output = with_scene(&["simulate", "-", "--out", folder.text()], TOP);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let page = folder.read("report.html");
    let (_, data) = page.split_once("type=\"application/json\">").expect("data");
    let (data, _) = data.split_once("</script>").expect("its end");
    let data: Value = serde_json::from_str(data).expect("JSON");
    // Gravity along −z means that z points straight up in the picture.
    let view = &data["drawing"]["view"];
    assert_eq!(view["right"][2], 0);
    assert_eq!(view["above"], serde_json::json!([0, 0, 1]));
    let up = view["up"][2].as_f64().expect("a number");
    assert!((up - 0.75_f64.sqrt()).abs() < 1e-6, "{up}");
    let components: Vec<&str> = data["components"]
        .as_array()
        .expect("components")
        .iter()
        .map(|c| c[0].as_str().expect("a name"))
        .collect();
    assert_eq!(components, ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"]);
    assert_eq!(data["components"][2][1], "N");
    assert_eq!(data["components"][5][1], "N·m");
    let wrench = data["joints"][0]["reaction"]["wrench"]
        .as_array()
        .expect("a reaction");
    assert_eq!(wrench.len(), 6);
    let body = &data["drawing"]["bodies"][0];
    for curve in [
        "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz",
    ] {
        assert!(
            body[curve].is_object() || body[curve].is_number(),
            "{curve}"
        );
    }
    for (id, wanted) in [("quantity-c", true), ("quantity-d", false)] {
        assert_eq!(page.contains(&format!("id=\"{id}\"")), wanted, "{id}");
    }
}

/// The axes of a universal joint and of its shafts meet at the origin, so that forces through it
/// are free, and moments about it are not free.
#[test]
fn moments_are_judged_about_any_point() {
    let hooke = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/hooke.toml");
    let scene = std::fs::read_to_string(hooke).expect("the example");
    let scene = format!(
        "{scene}\nmarker = [{{ name = \"meeting\", body = \"cross\", point = [0, 0, 0] }}]\n"
    );
    let asked = |about: &str| with_scene(&["analyze", "-", "--json", "--about", about], &scene);
    let verdicts = |about: &str| {
        let output = asked(about);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let document: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
        let left = &document["reactions"][0];
        let components = left["moment"]["components"].as_array().expect("components");
        let words: Vec<Value> = components.iter().map(|c| c["verdict"].clone()).collect();
        let centre = left["moment_unique_about"].as_array().expect("a point");
        assert!(
            centre
                .iter()
                .all(|x| x.as_f64().expect("a number").abs() < 1e-12)
        );
        // The reference point of an arm is this point.
        assert_eq!(document["reactions"][1].get("moment_unique_about"), None);
        words
    };
    assert_eq!(verdicts("0,0,0"), ["unique"; 3]);
    assert_eq!(verdicts("meeting"), ["unique"; 3]);
    assert_eq!(verdicts("0, 0, 1"), ["not_unique", "not_unique", "unique"]);
    for wrong in ["0,0", "0,0,x", "0,0,inf", "nowhere"] {
        let output = asked(wrong);
        assert_eq!(output.status.code(), Some(2), "{wrong}");
        let told = format!(
            "--about is `{wrong}`, need 3 numbers as X,Y,Z (m, or with units, as 310mm), or the name of a marker"
        );
        assert!(
            stderr(&output).contains(&told) || stdout(&output).contains(&told),
            "{wrong}"
        );
    }
}
