//! Tests couplings in loops. Every output contains the force of the coupling itself, with the
//! verdict on its uniqueness. The arm hangs from its pivot at rest, and the seat at its end does
//! not turn. The coupling carries the weight of the seat at its lever arm of a quarter of a metre,
//! 3 kg · 10 m/s² · 0.25 m. This torque acts on the arm between them twice, in opposite directions.

use serde_json::Value;

use super::{Folder, stderr, stdout, with_scene};

/// Derived by hand, on the arm: the first body of the joint with the dependent angle.
const LOAD: f64 = -7.5;

const SWING: &str = r#"
scene = { name = "swing", space = "plane", gravity = [0.0, -10.0] }
body = [
    { name = "arm", mass = 1.0, inertia = 0.1, position = [0.0, -0.5] },
    { name = "seat", mass = 3.0, inertia = 0.2, position = [0.25, -1.0] },
]
joint = [
    { name = "pivot", type = "revolute", bodies = ["ground", "arm"], at = [0.0, 0.0] },
    { name = "hinge", type = "revolute", bodies = ["arm", "seat"], at = [0.0, -1.0] },
    { name = "level", type = "coupling", measures = ["pivot.angle", "hinge.angle"], ratio = -1.0 },
MORE]
simulate = { t_end = 0.1 }
"#;

/// The same coupling a second time.
const AGAIN: &str = r#"    { name = "again", type = "coupling", measures = ["pivot.angle", "hinge.angle"], ratio = -1.0 },
"#;

fn document(arguments: &[&str], scene: &str) -> Value {
    let output = with_scene(arguments, scene);
    assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
    serde_json::from_str(&stdout(&output)).expect("one JSON document")
}

fn components(reaction: &Value) -> Vec<(String, String)> {
    let all = reaction["components"].as_array().expect("a list");
    let text = |c: &Value, key: &str| c[key].as_str().unwrap_or_default().to_owned();
    all.iter()
        .map(|c| (text(c, "name"), text(c, "verdict")))
        .collect()
}

/// Returns header and last row of a table.
fn last_row(folder: &Folder, name: &str) -> Vec<(String, String)> {
    let table = folder.read(name);
    let mut lines = table.lines();
    let header = lines.next().unwrap_or_default().split(',');
    let row = lines.next_back().unwrap_or_default().split(',');
    let pairs = header.zip(row);
    pairs.map(|(a, b)| (a.to_owned(), b.to_owned())).collect()
}

fn cell(row: &[(String, String)], name: &str) -> Option<f64> {
    let found = row.iter().find(|(column, _)| column == name);
    let (_, text) = found.unwrap_or_else(|| panic!("{name}: {row:?}"));
    (!text.is_empty()).then(|| text.parse().expect("a number"))
}

#[test]
fn a_coupling_in_a_loop_has_the_force_along_what_follows() {
    let scene = SWING.replace("MORE", "");
    let d = document(
        &["analyze", "-", "--json", "--combine", "level.load"],
        &scene,
    );
    assert_eq!(d["redundancy"], 0);
    let level = &d["reactions"][2];
    let unique = |name: &str| (name.to_owned(), "unique".to_owned());
    assert_eq!(components(level), [unique("T"), unique("load")]);
    let value = d["groups"][0]["values"][0]["value"].as_f64();
    assert!(value.is_some_and(|x| (x - LOAD).abs() < 1e-12), "{value:?}");
    // Both values are equal, so they have the same sensitivity to the data.
    let of = |k: usize| level["components"][k]["sensitivity"].as_f64();
    assert!(
        of(0).is_some_and(|x| x > 0.0) && of(0) == of(1),
        "{level:#}"
    );
    let folder = Folder::new("coupling-alone");
    document(&["simulate", "-", "--out", folder.text(), "--json"], &scene);
    let row = last_row(&folder, "reactions.csv");
    for (name, expected) in [
        ("level.Fx", 0.0),
        ("level.Fy", 0.0),
        ("level.T", LOAD),
        ("level.load", LOAD),
    ] {
        let found = cell(&row, name);
        assert!(
            found.is_some_and(|x| (x - expected).abs() < 1e-9),
            "{name}: {found:?}"
        );
    }
}

#[test]
fn doubled_couplings_share_one_force() {
    let group = "group = [{ name = \"both\", combine = \"level.load + again.load\" }]\n";
    let scene = SWING.replace("MORE", AGAIN) + group;
    let d = document(&["analyze", "-", "--json"], &scene);
    assert_eq!(d["redundancy"], 1);
    for k in [2, 3] {
        let open = |name: &str| (name.to_owned(), "not_unique".to_owned());
        assert_eq!(d["reactions"][k]["verdict"], "not_unique");
        assert_eq!(components(&d["reactions"][k]), [open("T"), open("load")]);
    }
    let text = stdout(&with_scene(&["analyze", "-"], &scene));
    let line = text.lines().find(|line| line.starts_with("level, again "));
    let line = line.expect("a line of the coupling");
    assert!(line.ends_with("T, load not unique"), "{line}");
    let folder = Folder::new("coupling-doubled");
    let summary = document(&["simulate", "-", "--out", folder.text(), "--json"], &scene);
    let row = last_row(&folder, "reactions.csv");
    for name in ["level", "again"] {
        let own = |component: &str| cell(&row, &format!("{name}.{component}"));
        assert_eq!(
            [own("Fx"), own("Fy"), own("T"), own("load")],
            [Some(0.0), Some(0.0), None, None]
        );
        let found = &summary["reactions"][name];
        assert_eq!(found["verdict"], "not_unique");
        for component in ["T", "load"] {
            assert_eq!(found["components"][component]["verdict"], "not_unique");
        }
    }
    let sum = cell(&row, "both");
    assert!(sum.is_some_and(|x| (x - LOAD).abs() < 1e-9), "{sum:?}");
    let choice = last_row(&folder, "choice.csv");
    let of = |name: &str| cell(&choice, name).expect("all cells are filled");
    assert!(
        (of("level.T") + of("again.T") - LOAD).abs() < 1e-9,
        "{choice:?}"
    );
}

/// A coupling of two joint coordinates of one joint also has its load in the answer. A nut of 2 kg
/// is on a vertical spindle of 1 m per radian, with 0.5 kg·m² about it. It falls with m·g/(m +
/// I/r²), so that the thread carries m·g·I/(I + m·r²).
#[test]
fn a_coupling_within_a_joint_has_its_load() {
    let scene = r#"
scene = { name = "nut", space = "spatial", gravity = [0.0, 0.0, -10.0] }
body = [{ name = "nut", mass = 2.0, inertia = [0.3, 0.3, 0.5] }]
joint = [
    { name = "spindle", type = "cylindrical", bodies = ["ground", "nut"], at = [0.0, 0.0, 0.0], axis = [0.0, 0.0, 1.0] },
    { name = "thread", type = "coupling", measures = ["spindle.angle", "spindle.displacement"], ratio = 1.0 },
]
"#;
    let combine = ["thread.load", "thread.Fz"];
    let asked: Vec<&str> = combine.iter().flat_map(|sum| ["--combine", sum]).collect();
    let d = document(&[&["analyze", "-", "--json"][..], &asked].concat(), scene);
    let thread = &d["reactions"][1];
    let names: Vec<String> = components(thread)
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    assert!(names.contains(&"load".to_owned()), "{names:?}");
    for k in 0..2 {
        let value = d["groups"][k]["values"][0]["value"].as_f64();
        // The force acts downwards on the ground, the first body of the spindle.
        let expected = -20.0 * 0.5 / 2.5;
        assert!(
            value.is_some_and(|x| (x - expected).abs() < 1e-12),
            "{}: {value:?}",
            combine[k]
        );
    }
}

/// A gear of ratio zero would fix the second wheel to the carrier, without the first wheel, on
/// which its reaction is given.
#[test]
fn a_gear_of_ratio_zero_is_refused() {
    let scene = r#"
scene = { name = "gear", space = "plane" }
body = [{ name = "a", mass = 1.0, inertia = 0.1 }, { name = "b", mass = 1.0, inertia = 0.1, position = [1.0, 0.0] }]
joint = [
    { name = "A", type = "revolute", bodies = ["ground", "a"], at = [0.0, 0.0] },
    { name = "B", type = "revolute", bodies = ["ground", "b"], at = [1.0, 0.0] },
    { name = "teeth", type = "gear", bodies = ["a", "b"], ratio = 0.0 },
]
"#;
    let output = with_scene(&["analyze", "-"], scene);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    let said = stderr(&output);
    assert!(
        said.contains("teeth") && said.contains("the ratio is not zero"),
        "{said}"
    );
}
