//! Tests `simulate --choose`: tables of the values for several choices.

use serde_json::Value;

use super::bad_input::PENDULUM;
use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// A cart of 10 kg has three wheels on one axle and drives on a circle at 1 m/s and 0.5 rad/s. The
/// wheels push it sideways with 10·1·0.5 = 5 N in total, and share this force in an undetermined
/// way.
const CART: &str = r#"
    scene = { name = "cart", space = "plane" }
    body = [{ name = "cart", mass = 10.0, inertia = 1.0, velocity = [1.0, 0.0], angular_velocity = 0.5 }]
    joint = [
        { name = "left", type = "knife-edge", body = "cart", point = [0.0, 0.5], normal = [0.0, 1.0] },
        { name = "middle", type = "knife-edge", body = "cart", point = [0.0, 0.0], normal = [0.0, 1.0] },
        { name = "right", type = "knife-edge", body = "cart", point = [0.0, -0.5], normal = [0.0, 1.0] },
    ]
    group = [{ name = "axle", combine = "left.N + middle.N + right.N" }]
    simulate = { t_end = 2.0, output_step = 0.25 }
"#;

/// A table consists of names of columns, and rows of cells.
type Table = (Vec<String>, Vec<Vec<String>>);

fn table(folder: &Folder, name: &str) -> Table {
    let text = folder.read(name);
    let mut lines = text.lines().map(|line| {
        let cells = line.split(',').map(str::to_owned);
        cells.collect::<Vec<String>>()
    });
    (lines.next().expect("a header"), lines.collect())
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    let k = table.0.iter().position(|c| c == name).expect("a column");
    let number = |row: &Vec<String>| row[k].parse().unwrap_or(f64::NAN);
    table.1.iter().map(number).collect()
}

fn summary(folder: &Folder) -> Value {
    serde_json::from_str(&folder.read("summary.json")).expect("JSON")
}

fn near(found: &[f64], expected: f64, bound: f64) {
    let is_near = |x: &f64| (x - expected).abs() <= bound;
    assert!(found.iter().all(is_near), "{found:?}, not {expected}");
}

#[test]
fn each_choice_has_its_table() {
    let folder = Folder::new("chosen-cart");
    let out = folder.text();
    // Parallel springs share a force by their stiffness: 1 : 1/2 : 1/4.
    let compliant = "compliance:left=1e-6,middle=2e-6,right=4e-6";
    let mut arguments = vec!["simulate", "-", "--out", out];
    for choice in ["minimum-norm", compliant, "drop:1,3"] {
        arguments.extend(["--choose", choice]);
    }
    let output = with_scene(&arguments, CART);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    assert!(
        text.contains(
            "choice_2.csv contains one of many solutions (elastic supports: `left` 1e-6 m/N;"
        ),
        "{text}"
    );
    let determined = table(&folder, "reactions.csv");
    let files = ["choice.csv", "choice_2.csv", "choice_3.csv"];
    let shares = [
        [5.0 / 3.0, 5.0 / 3.0, 5.0 / 3.0],
        [20.0 / 7.0, 10.0 / 7.0, 5.0 / 7.0],
        [0.0, 5.0, 0.0],
    ];
    let times = column(&determined, "t");
    assert_eq!(times.len(), 9);
    for (file, shares) in files.into_iter().zip(shares) {
        let chosen = table(&folder, file);
        assert_eq!(chosen.0, determined.0, "{file}");
        // All cells are filled, and determined components have the same text.
        for (chosen, determined) in chosen.1.iter().zip(&determined.1) {
            assert!(chosen.iter().all(|cell| !cell.is_empty()), "{chosen:?}");
            let mut cells = chosen.iter().zip(determined);
            assert!(cells.all(|(c, d)| d.is_empty() || c == d), "{chosen:?}");
        }
        let [mut fx, mut fy] = [vec![0.0; 9], vec![0.0; 9]];
        for (wheel, share) in ["left", "middle", "right"].into_iter().zip(shares) {
            near(&column(&chosen, &format!("{wheel}.N")), share, 1e-9);
            let of = |name: &str| column(&chosen, &format!("{wheel}.{name}"));
            let add = |sum: &mut Vec<f64>, own: Vec<f64>| {
                sum.iter_mut().zip(own).for_each(|(sum, x)| *sum += x);
            };
            add(&mut fx, of("Fx"));
            add(&mut fy, of("Fy"));
        }
        // The three forces together turn the velocity of the cart: m·a = 5 N towards the centre.
        for (k, t) in times.iter().enumerate() {
            let angle = 0.5 * t;
            assert!((fx[k] + 5.0 * angle.sin()).abs() < 1e-8, "{file} at {t} s");
            assert!((fy[k] - 5.0 * angle.cos()).abs() < 1e-8, "{file} at {t} s");
        }
    }
    near(&column(&determined, "axle"), 5.0, 1e-9);
    assert!(column(&determined, "left.N").iter().all(|x| x.is_nan()));
    let document = summary(&folder);
    let choices = document["choice"].as_array().expect("a list");
    let named: Vec<&str> = choices.iter().filter_map(|c| c["file"].as_str()).collect();
    assert_eq!(named, files);
    let rows: Vec<&Value> = choices.iter().map(|c| &c["deleted_rows"]).collect();
    let none = serde_json::json!([]);
    assert_eq!(rows, [&none, &none, &serde_json::json!([1, 3])]);
    assert!(choices.iter().all(|c| c["from"] == 0.0 && c["to"] == 2.0));
    assert!(
        choices[0]["name"]
            .as_str()
            .expect("a name")
            .starts_with("minimum norm")
    );
    let written = document["files"].as_array().expect("a list");
    assert!(
        files
            .iter()
            .all(|file| written.contains(&Value::from(*file)))
    );
    // The page names the choices at their curves.
    let page = folder.read("report.html");
    assert!(page.contains("elastic supports") && !page.contains("this run: row"));

    // A single choice has no separate file in the summary, and no file of the earlier run remains.
    let output = with_scene(
        &["simulate", "-", "--out", out, "--choose", "drop:2,3"],
        CART,
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    near(&column(&table(&folder, "choice.csv"), "left.N"), 5.0, 1e-9);
    let document = summary(&folder);
    assert!(document["choice"][0].get("file").is_none());
    let names = std::fs::read_dir(&folder.0).expect("there");
    let names = names.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut names: Vec<String> = names.collect();
    names.sort_unstable();
    let expected = [
        "choice.csv",
        "reactions.csv",
        "report.html",
        "summary.json",
        "trajectory.csv",
    ];
    assert_eq!(names, expected);
}

/// The values of a row equal the values that `analyze` prints for the time of the row.
#[test]
fn rows_of_a_choice_are_those_of_analyze() {
    let folder = Folder::new("chosen-robot");
    let choices = ["minimum-norm:length=0.5", "drop:6,21"];
    let mut arguments = vec!["simulate", ROBOT, "--t-end", "2", "--out", folder.text()];
    let asked = choices.iter().flat_map(|choice| ["--choose", choice]);
    arguments.extend(asked.clone());
    let output = pfaff(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for at in ["0", "1.5"] {
        let mut arguments = vec!["analyze", ROBOT, "--at-time", at, "--json"];
        arguments.extend(asked.clone());
        let output = pfaff(&arguments);
        let document: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        let t: f64 = at.parse().expect("a number");
        for (k, file) in ["choice.csv", "choice_2.csv"].into_iter().enumerate() {
            let chosen = table(&folder, file);
            let times = column(&chosen, "t");
            let row = times.iter().position(|x| (x - t).abs() < 1e-12);
            let row = row.expect("a row at this time");
            let reactions = document["choices"][k]["reactions"].as_array();
            let mut seen = 0;
            for reaction in reactions.expect("a list") {
                let name = reaction["name"].as_str().expect("a name");
                for component in reaction["components"].as_array().expect("a list") {
                    let number = component["name"].as_str().expect("a name");
                    let expected = component["value"].as_f64().expect("a value");
                    let found = column(&chosen, &format!("{name}.{number}"))[row];
                    assert!(
                        (found - expected).abs() < 1e-6 * expected.abs().max(1.0),
                        "{file}, {name}.{number} at {t} s: {found}, {expected} by analyze"
                    );
                    seen += 1;
                }
            }
            assert!(seen >= 30, "{seen}");
        }
    }
}

/// At one instant row 6 takes part in no dependency: no choice exists that deletes it.
#[test]
fn a_choice_that_does_not_exist_at_an_instant_has_empty_cells() {
    let folder = Folder::new("chosen-gap");
    let scene = std::fs::read_to_string(ROBOT).expect("the scene exists");
    let [instant, step] = ["6.48545727", "3.242728635"];
    let set = format!("simulate.output_step={step}");
    let mut arguments = vec!["simulate", "-", "--t-end", instant, "--set", &set];
    arguments.extend([
        "--out",
        folder.text(),
        "--choose",
        "drop:6,21",
        "--choose",
        "minimum-norm",
    ]);
    let output = with_scene(&arguments, &scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    assert!(
        text.contains("warning: choice.csv has empty cells in 1 row, the first at t = 6.485"),
        "{text}"
    );
    let [chosen, least] = ["choice.csv", "choice_2.csv"].map(|file| table(&folder, file));
    let determined = table(&folder, "reactions.csv");
    let is_filled = |row: &[String]| row.iter().all(|cell| !cell.is_empty());
    assert!(least.1.iter().all(|row| is_filled(row)));
    assert!(is_filled(&chosen.1[1]) && !is_filled(&chosen.1[2]));
    // Determined components have their values.
    assert_eq!(chosen.1[2], determined.1[2]);
    let gap = &summary(&folder)["choice"][0]["gap"];
    assert_eq!(gap["rows"], 1);
    let reason = gap["reason"].as_str().expect("a reason");
    assert!(
        reason.starts_with("no solution has zero reactions in the rows 6"),
        "{reason}"
    );
}

#[test]
fn a_choice_that_is_not_possible_is_refused_before_the_run() {
    for (choice, piece) in [
        (
            "compliance:left=1e-6",
            "the choice does not determine all loads",
        ),
        (
            "compliance:lift=1e-6",
            "there is no joint or drive `lift`; did you mean `left`?",
        ),
        ("drop:1", "drop exactly 2"),
        ("drop:1,4", "there is no row 4"),
        ("minimum", "--choose is `minimum`, need"),
    ] {
        let folder = Folder::new("chosen-refused");
        let of_run = ["simulate", "-", "--out", folder.text(), "--choose", choice];
        let run = with_scene(&of_run, CART);
        let here = with_scene(&["analyze", "-", "--choose", choice], CART);
        assert_eq!(run.status.code(), Some(2), "{choice}");
        assert_eq!(stderr(&run), stderr(&here), "{choice}");
        assert!(stderr(&run).contains(piece), "{}", stderr(&run));
        assert!(!folder.0.exists(), "{choice}");
    }
    let quiet = format!("{CART}\n    output = {{ reactions = false }}\n");
    let folder = Folder::new("chosen-quiet");
    let simulate = [
        "simulate",
        "-",
        "--out",
        folder.text(),
        "--choose",
        "minimum-norm",
    ];
    let output = with_scene(&simulate, &quiet);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("choices and bounds need reactions"),
        "{}",
        stderr(&output)
    );
    assert!(!folder.0.exists());
}

#[test]
fn a_choice_has_no_table_where_every_number_is_determined() {
    let folder = Folder::new("chosen-plain");
    let simulate = [
        "simulate",
        "-",
        "--out",
        folder.text(),
        "--choose",
        "minimum-norm",
    ];
    let output = with_scene(&simulate, PENDULUM);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(!folder.0.join("choice.csv").exists());
    assert_eq!(summary(&folder)["choice"], serde_json::json!([]));
}

/// Within a tolerance further rows are redundant, and choices apply to these rows, too.
#[test]
fn choices_within_a_tolerance() {
    // The right wheel is 0.1 mm ahead.
    let scene = CART.replace("point = [0.0, -0.5]", "point = [1e-4, -0.5]");
    let folder = Folder::new("chosen-tolerance");
    let mut arguments = vec![
        "simulate",
        "-",
        "--tolerance",
        "1mm",
        "--out",
        folder.text(),
    ];
    arguments.extend(["--choose", "minimum-norm", "--choose", "drop:1,2"]);
    let output = with_scene(&arguments, &scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let [least, right] = ["choice.csv", "choice_2.csv"].map(|file| table(&folder, file));
    // The rows of the right wheel are independent. Its force accelerates the rotation of the cart:
    // 5 N · 1e-4 m on 1 kg·m².
    for (k, t) in column(&least, "t").into_iter().enumerate() {
        let side = 10.0 * (0.5 + 5e-4 * t);
        for wheel in ["left.N", "middle.N", "right.N"] {
            near(&column(&least, wheel)[k..=k], side / 3.0, 1e-4 * side);
        }
        near(&column(&right, "right.N")[k..=k], side, 1e-4 * side);
    }
    near(&column(&right, "left.N"), 0.0, 0.0);
}

/// A rejected run does not change the directory.
#[test]
fn a_refusal_leaves_nothing_behind() {
    // Two collinear bars are between two pins: the weight has no finite reaction.
    let flat = r#"
        scene = { name = "flat", space = "plane", gravity = [0.0, -9.81] }
        body = [
            { name = "a", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] },
            { name = "b", mass = 1.0, inertia = 0.1, position = [1.5, 0.0] },
        ]
        joint = [
            { name = "A", type = "revolute", bodies = ["ground", "a"], at = [0.0, 0.0] },
            { name = "M", type = "revolute", bodies = ["a", "b"], at = [1.0, 0.0] },
            { name = "B", type = "revolute", bodies = ["b", "ground"], at = [2.0, 0.0] },
        ]
        simulate = { t_end = 1.0 }
    "#;
    let none: [&str; 0] = [];
    for (scene, more) in [
        (flat, &none[..]),
        (CART, &["--rtol=-1"][..]),
        (CART, &["--drop", "9,10"]),
    ] {
        let folder = Folder::new("refused-run");
        let deep = folder.0.join("a/b");
        let deep = deep.to_str().expect("UTF-8");
        let simulate = [&["simulate", "-", "--out", deep][..], more].concat();
        let output = with_scene(&simulate, scene);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(!folder.0.exists(), "{more:?}");
        // An existing directory remains, with its contents.
        std::fs::create_dir_all(deep).expect("writable");
        std::fs::write(folder.0.join("a/b/notes.txt"), "mine").expect("writable");
        assert_eq!(with_scene(&simulate, scene).status.code(), Some(2));
        let entries = std::fs::read_dir(deep).expect("there").count();
        assert_eq!(entries, 1, "{more:?}");
    }
}

/// The table of reactions of a mechanism without joints contains only times.
#[test]
fn no_joints_are_an_empty_table() {
    let stone = r#"
        scene = { name = "stone", space = "plane", gravity = [0.0, -9.81] }
        body = [{ name = "stone", mass = 1.0, inertia = 0.1 }]
        simulate = { t_end = 1.0, output_step = 0.5 }
    "#;
    let folder = Folder::new("no-joints");
    let output = with_scene(&["simulate", "-", "--out", folder.text()], stone);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(folder.read("reactions.csv"), "t\n0.0\n0.5\n1.0\n");
    let entries = std::fs::read_dir(&folder.0).expect("there");
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    assert!(names.into_iter().all(|name| !name.ends_with(".part")));
}
