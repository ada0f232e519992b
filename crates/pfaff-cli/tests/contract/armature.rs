//! Armatures of joints in the commands: loads on bodies, sweeps, equilibria and differences.

use std::fs;

use serde_json::Value;

use super::{Folder, stdout, with_scene};

/// A wheel with J = 0.5 kg·m² and a motor of 0.75 kg·m² under a constant torque of 5 N·m.
const WHEEL: &str = r#"
scene = { name = "wheel", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "wheel", mass = 2.0, inertia = 0.5 }]
joint = [{ name = "pin", type = "revolute", bodies = ["ground", "wheel"], at = [0.0, 0.0], armature = 0.75 }]
force = [{ name = "push", type = "torque", body = "wheel", torque = 5.0 }]
output = { bodies = ["wheel"] }
simulate = { t_end = 1.0, output_step = 0.25 }
"#;

/// Returns a table as its header and its rows.
fn table(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
    let header = lines.next().expect("a header").collect();
    (header, lines.map(Iterator::collect).collect())
}

fn number(header: &[String], row: &[String], name: &str) -> f64 {
    let at = header.iter().position(|column| column == name);
    let at = at.unwrap_or_else(|| panic!("{name} in {header:?}"));
    row[at].parse().expect("a number")
}

/// The torque is 5 = (J + a)·α with α = 4, so the armature carries 3 N·m and the wheel 2 N·m.
#[test]
fn the_load_of_an_armature_is_one_of_the_loads_on_a_body() {
    let folder = Folder::new("armature-loads");
    stdout(&with_scene(
        &["simulate", "-", "--out", folder.text()],
        WHEEL,
    ));
    let text = fs::read_to_string(folder.0.join("body_wheel.csv")).expect("written");
    let (header, rows) = table(&text);
    assert_eq!(rows.len(), 5);
    for row in &rows {
        let of = |name: &str| number(&header, row, name);
        assert!(
            (of("armature of pin.angle.T") + 3.0).abs() < 1e-12,
            "{row:?}"
        );
        assert!((of("inertia.T") + 2.0).abs() < 1e-12, "{row:?}");
        for component in ["Fx", "Fy", "T"] {
            let own = header
                .iter()
                .filter(|name| name.ends_with(&format!(".{component}")));
            let sum: f64 = own.map(|name| of(name)).sum();
            assert!(sum.abs() < 1e-12, "{component}: {row:?}");
        }
    }
}

/// The described scene has no armature, so its generated code must not be used for the other runs.
#[test]
fn a_sweep_varies_an_armature() {
    for described in ["0.75", "0.0"] {
        let folder = Folder::new(&format!("armature-sweep-{described}"));
        let text = WHEEL.replace("armature = 0.75", &format!("armature = {described}"));
        let vary = [
            "--vary",
            "joint.pin.armature=0:2:121",
            "--out",
            folder.text(),
        ];
        stdout(&with_scene(&[&["sweep", "-"][..], &vary].concat(), &text));
        let (header, rows) = table(&folder.read("sweep.csv"));
        assert_eq!(rows.len(), 121);
        for row in &rows {
            let armature = number(&header, row, "joint.pin.armature");
            let omega = number(&header, row, "wheel.omega");
            let expected = 5.0 / (0.5 + armature);
            assert!(
                (omega - expected).abs() < 1e-6 * expected,
                "{armature}: {omega}"
            );
        }
    }
}

/// An armature changes neither an equilibrium nor its stability.
#[test]
fn an_equilibrium_does_not_depend_on_armatures() {
    let hanging = |armature: &str, y: &str| {
        let text = format!(
            "scene = {{ name = \"rod\", space = \"plane\", gravity = [0.0, -9.81] }}
body = [{{ name = \"rod\", mass = 2.0, inertia = 0.5, position = [0.0, {y}] }}]
joint = [{{ name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"rod\"], at = [0.0, 0.0]{armature} }}]
"
        );
        let output = with_scene(&["equilibrium", "-", "--json"], &text);
        serde_json::from_str::<Value>(&stdout(&output)).expect("JSON")
    };
    for y in ["-1.5", "1.5"] {
        let (bare, own) = (hanging("", y), hanging(", armature = 3.0", y));
        for key in ["bodies", "stability", "largest_force", "steps"] {
            assert_eq!(own[key], bare[key], "{key}");
        }
        let values = |d: &Value| d["reactions"]["pin"]["values"]["Fy"]["value"].clone();
        assert_eq!(values(&own), values(&bare));
    }
}

/// Two scenes that differ only in an armature have the same verdicts and other motions.
#[test]
fn a_difference_of_armatures_changes_the_motion_only() {
    let folder = Folder::new("armature-diff");
    fs::create_dir_all(&folder.0).expect("a folder");
    let path = |name: &str, text: &str| {
        let path = folder.0.join(name);
        fs::write(&path, text).expect("written");
        path.display().to_string()
    };
    let one = path("one.toml", WHEEL);
    let other = path("other.toml", &WHEEL.replace("0.75", "1.5"));
    let output = super::pfaff(&["diff", &one, &other, "--json"]);
    let d: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(d["ok"], true, "{d}");
    let text = String::from_utf8_lossy(&super::pfaff(&["diff", &one, &other]).stdout).into_owned();
    assert!(text.contains("wheel"), "{text}");
}
