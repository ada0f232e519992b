//! Loads of force elements in tables, documents and texts.

use serde_json::Value;

use super::{Folder, stdout, with_scene};

/// A bed on four bushings with its centre of mass 40 mm and 20 mm from the middle.
const BED: &str = r#"
scene = { name = "bed", space = "spatial", format = 2, units = { length = "mm" }, gravity = [0, 0, -9810] }
body = [{ name = "bed", mass = 200, inertia = [2e7, 3e7, 4e7], centre = [40, 20, 0] }]
force = [
    { name = "M1", type = "bushing", bodies = ["bed", "ground"], at = [-500, -300, 0], stiffness = [500, 500, 1000, 0, 0, 0], damping = [5, 5, 10, 0, 0, 0] },
    { name = "M2", type = "bushing", bodies = ["bed", "ground"], at = [500, -300, 0], stiffness = [500, 500, 1000, 0, 0, 0], damping = [5, 5, 10, 0, 0, 0] },
    { name = "M3", type = "bushing", bodies = ["bed", "ground"], at = [-500, 300, 0], stiffness = [500, 500, 1000, 0, 0, 0], damping = [5, 5, 10, 0, 0, 0] },
    { name = "M4", type = "bushing", bodies = ["bed", "ground"], at = [500, 300, 0], stiffness = [500, 500, 1000, 0, 0, 0], damping = [5, 5, 10, 0, 0, 0] },
]
simulate = { t_end = 3 }
"#;

/// The share of each bushing in the weight, for a rigid bed on equal springs: 1/4 of the weight,
/// more by the distance of the centre of mass towards the bushing.
fn shares() -> [f64; 4] {
    let share = |x: f64, y: f64| 1962.0 / 4.0 * (1.0 + 40.0 / x + 20.0 / y);
    [
        share(-500.0, -300.0),
        share(500.0, -300.0),
        share(-500.0, 300.0),
        share(500.0, 300.0),
    ]
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&stdout(&with_scene(arguments, BED))).expect("JSON")
}

#[test]
fn an_equilibrium_has_the_loads_of_its_springs() {
    let d = json(&["equilibrium", "-", "--json"]);
    for (k, share) in shares().into_iter().enumerate() {
        let load = &d["loads"][format!("M{}", k + 1)];
        let found = load["Fz"].as_f64().expect("a number");
        // The bed leans by less than 1e-4, so the shares change by less than its square.
        assert!((found - share).abs() < 1e-5 * share, "M{}: {found}", k + 1);
    }
    let text = stdout(&with_scene(&["equilibrium", "-"], BED));
    assert!(text.contains("force on the first body"), "{text}");
}

#[test]
fn a_run_has_a_table_of_loads() {
    let folder = Folder::new("loads");
    with_scene(&["simulate", "-", "--out", folder.text()], BED);
    let table = std::fs::read_to_string(folder.0.join("loads.csv")).expect("written");
    let mut rows = table.lines();
    let header = rows.next().expect("a header");
    assert!(
        header.starts_with("t,M1.Fx,M1.Fy,M1.Fz,M1.Tx,M1.Ty,M1.Tz,M2.Fx"),
        "{header}"
    );
    let last: Vec<f64> = rows
        .last()
        .expect("rows")
        .split(',')
        .map(|x| x.parse().expect("a number"))
        .collect();
    for (k, share) in shares().into_iter().enumerate() {
        let found = last[3 + 6 * k];
        assert!((found - share).abs() < 1e-5 * share, "M{}: {found}", k + 1);
    }
    let summary = std::fs::read_to_string(folder.0.join("summary.json")).expect("written");
    let d: Value = serde_json::from_str(&summary).expect("JSON");
    let peak = d["loads"]["M4"]["peak"]["force"]["value"]
        .as_f64()
        .expect("a peak");
    assert!(peak > shares()[3], "it overshoots: {peak}");
    let page = std::fs::read_to_string(folder.0.join("report.html")).expect("written");
    assert!(page.contains("Peak loads</h2>") && page.contains("<td><b>M4</b></td>"));
}

#[test]
fn choices_of_reactions_come_with_the_loads() {
    let d = json(&["analyze", "-", "--json", "--choose", "minimum-norm"]);
    // The bushings have no load at the start.
    assert_eq!(d["loads"]["M2"]["Fz"].as_f64(), Some(0.0), "{d}");
    assert_eq!(json(&["analyze", "-", "--json"]).get("loads"), None);
}
