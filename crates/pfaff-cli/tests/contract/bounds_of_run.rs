//! Tests `simulate --bounds`: bounds of reactions over a run.

use serde_json::Value;

use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// A cart of 10 kg has three wheels on one axle. It turns at 0.5 rad/s, and its speed is 1 m/s at
/// the start and grows by 0.5 m/s². The wheels push it sideways with 10·v·0.5 in total; each wheel
/// alone may carry all of it.
const CART: &str = r#"
    scene = { name = "cart", space = "plane" }
    body = [{ name = "cart", mass = 10.0, inertia = 1.0, velocity = [1.0, 0.0], angular_velocity = 0.5 }]
    joint = [
        { name = "left", type = "knife-edge", body = "cart", point = [0.0, 0.5], normal = [0.0, 1.0] },
        { name = "middle", type = "knife-edge", body = "cart", point = [0.0, 0.0], normal = [0.0, 1.0] },
        { name = "right", type = "knife-edge", body = "cart", point = [0.0, -0.5], normal = [0.0, 1.0] },
    ]
    force = [{ name = "push", type = "point-force", body = "cart", point = [0.0, 0.0], force = [5.0, 0.0], frame = "body" }]
    group = [
        { name = "axle", combine = "left.N + middle.N + right.N" },
        { name = "two", combine = "left.N + middle.N" },
    ]
    simulate = { t_end = 2.0, output_step = 0.25 }
"#;

type Table = (Vec<String>, Vec<Vec<f64>>);

fn table(folder: &Folder) -> Table {
    let text = folder.read("bounds.csv");
    let mut lines = text.lines();
    let header = lines
        .next()
        .expect("a header")
        .split(',')
        .map(str::to_owned);
    let numbers = |line: &str| -> Vec<f64> {
        let cells = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN));
        cells.collect()
    };
    (header.collect(), lines.map(numbers).collect())
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    let k = table.0.iter().position(|c| c == name).expect("a column");
    table.1.iter().map(|row| row[k]).collect()
}

fn summary(folder: &Folder) -> Value {
    serde_json::from_str(&folder.read("summary.json")).expect("JSON")
}

#[test]
fn a_wheel_carries_at_most_the_whole_force() {
    let folder = Folder::new("bounds-cart");
    let output = with_scene(&["simulate", "-", "--bounds", "--out", folder.text()], CART);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found = table(&folder);
    // The sum is unique, so it has no bounds.
    assert!(found.0.iter().all(|name| !name.starts_with("axle")));
    for (k, t) in column(&found, "t").into_iter().enumerate() {
        let total = 5.0 * (1.0 + 0.5 * t);
        for name in ["left.N", "middle.N", "right.N", "two"] {
            let ends = ["lowest", "highest"].map(|end| column(&found, &format!("{name}.{end}"))[k]);
            for (found, expected) in ends.into_iter().zip([0.0, total]) {
                assert!((found - expected).abs() < 1e-7, "{name} at {t} s: {ends:?}");
            }
        }
    }
    assert_eq!(found.1.len(), 9);
    let d = summary(&folder);
    let at = |path: &str| d.pointer(path).and_then(Value::as_f64).expect("a number");
    for name in ["left", "middle", "right"] {
        let most = format!("/reactions/{name}/magnitude_at_most");
        assert!((at(&format!("{most}/force/value")) - 10.0).abs() < 1e-7);
        assert_eq!(at(&format!("{most}/force/time")), 2.0);
        let range = format!("/reactions/{name}/components/N/bounds");
        assert!((at(&format!("{range}/highest/value")) - 10.0).abs() < 1e-7);
        assert!(at(&format!("{range}/lowest/value")).abs() < 1e-7);
    }
    assert!((at("/groups/two/bounds/highest/value") - 10.0).abs() < 1e-7);
    assert!(d["groups"]["axle"].get("bounds").is_none());
    assert!(d["bounds"].get("gap").is_none());
    let files = d["files"].as_array().expect("a list");
    assert!(files.contains(&"bounds.csv".into()), "{files:?}");
    let text = stdout(&output);
    assert!(text.contains("left      10                 2"), "{text}");
    assert!(text.contains("valid for joints that fit exactly"), "{text}");
    assert!(folder.read("report.html").contains("\"bounds\":{\"Fx\":["));
    // A run without the option removes the table and changes nothing else.
    let before = ["reactions.csv", "choice.csv", "trajectory.csv"].map(|name| folder.read(name));
    let output = with_scene(&["simulate", "-", "--out", folder.text()], CART);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(!folder.0.join("bounds.csv").exists());
    let after = ["reactions.csv", "choice.csv", "trajectory.csv"].map(|name| folder.read(name));
    assert!(before == after);
}

#[test]
fn a_row_has_the_bounds_of_an_analysis() {
    let folder = Folder::new("bounds-robot");
    let output = pfaff(&[
        "simulate",
        ROBOT,
        "--t-end",
        "3",
        "--bounds",
        "--rigid",
        "B",
        "--out",
        folder.text(),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found = table(&folder);
    let time = column(&found, "t");
    for t in [0.0, 1.5, 3.0] {
        let at = t.to_string();
        let output = pfaff(&[
            "analyze",
            ROBOT,
            "--bounds",
            "--rigid",
            "B",
            "--at-time",
            &at,
            "--json",
        ]);
        let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        let row = time.iter().position(|x| *x == t).expect("a row");
        let mut compared = 0;
        for reaction in d["reactions"].as_array().expect("a list") {
            let name = reaction["name"].as_str().expect("a name");
            for component in reaction["components"].as_array().expect("a list") {
                if component["verdict"] != "not_unique" {
                    continue;
                }
                for end in ["lowest", "highest"] {
                    let known = component["bounds"][end].as_f64().expect("a number");
                    let of = format!(
                        "{name}.{}.{end}",
                        component["name"].as_str().expect("a name")
                    );
                    let own = column(&found, &of)[row];
                    assert!(
                        (own - known).abs() < 1e-4 * (1.0 + known.abs()),
                        "{of} at {t} s: {own} {known}"
                    );
                    compared += 1;
                }
            }
        }
        assert!(compared >= 12, "{compared}");
    }
}

#[test]
fn a_scene_requests_bounds() {
    let folder = Folder::new("bounds-scene");
    let run = |scene: &str, options: &[&str]| {
        let mut arguments = vec!["simulate", "-", "--out", folder.text()];
        arguments.extend(options);
        with_scene(&arguments, scene)
    };
    let with = |bounds: &str| format!("{CART}\noutput = {{ bounds = {bounds} }}");
    // A rigid wheel carries the whole force of a softer one.
    let output = run(CART, &["--bounds", "--rigid", "left"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found = table(&folder);
    let ends = ["lowest", "highest"].map(|end| column(&found, &format!("left.N.{end}"))[0]);
    assert!(ends.iter().all(|end| (end - 5.0).abs() < 1e-9), "{ends:?}");
    let output = run(CART, &["--bounds", "--within", "3"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let by_option = folder.read("bounds.csv");
    // The share of a wheel that is three times as soft as the others, or of one that is three times
    // as stiff: 1/7 and 3/5.
    let found = table(&folder);
    let ends = ["lowest", "highest"].map(|end| column(&found, &format!("middle.N.{end}"))[0]);
    for (end, expected) in ends.into_iter().zip([5.0 / 7.0, 3.0]) {
        assert!((end - expected).abs() < 1e-9, "{ends:?}");
    }
    let output = run(&with("{ rigid = [], within = 3 }"), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(folder.read("bounds.csv"), by_option);
    let output = run(&with("true"), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_ne!(folder.read("bounds.csv"), by_option);
    let output = run(&with("false"), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(!folder.0.join("bounds.csv").exists());
    for (bounds, words) in [
        (r#"{ rigid = ["lefd"] }"#, "did you mean `left`?"),
        ("{ within = 0.5 }", "need a ratio ≥ 1"),
        ("{ withim = 2 }", "within"),
        ("{ compliance = \"left=1e-6\" }", "add `within`"),
        ("3", "true, false, or a table"),
    ] {
        let output = run(&with(bounds), &[]);
        assert_eq!(output.status.code(), Some(2), "{bounds}");
        assert!(
            stderr(&output).contains(words),
            "{bounds}: {}",
            stderr(&output)
        );
    }
    for (options, words) in [
        (&["--rigid", "left"][..], "add --bounds"),
        (&["--within", "2"], "add --bounds"),
        (&["--compliance", "left=1e-6"], "add --bounds --within K"),
        (
            &["--bounds", "--within", "2", "--compliance", "left"],
            "NAME=COMPLIANCE",
        ),
        (
            &["--choose", "compliance:left=1e-6;misfit:left=0,0"],
            "analyze --at-time",
        ),
    ] {
        let output = run(CART, options);
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(
            stderr(&output).contains(words),
            "{options:?}: {}",
            stderr(&output)
        );
    }
    let without = with("true").replace("bounds = true", "bounds = true, reactions = false");
    let output = run(&without, &[]);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
}

/// A scissor lift in space has 17 redundant rows and more than 100 000 sets of components. Some
/// compliances reach a range, which is not called bounds.
#[test]
fn ranges_of_many_sets_are_no_bounds() {
    let lift = include_str!("../remedies/lift.toml");
    let output = with_scene(&["analyze", "-", "--bounds", "--json"], lift);
    let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert_eq!(d["bounds"]["complete"], false);
    let mut reached = 0;
    for reaction in d["reactions"].as_array().expect("a list") {
        for component in reaction["components"].as_array().expect("a list") {
            if let Some(range) = component.get("reached_at_least") {
                let ends = [&range[0], &range[1]].map(|end| end.as_f64().expect("a number"));
                assert!(ends[0] <= ends[1] && component.get("bounds").is_none());
                reached += 1;
            }
        }
        assert!(reaction.get("magnitude_at_most").is_none());
    }
    assert!(reached > 20, "{reached}");
    let text = stdout(&with_scene(&["analyze", "-", "--bounds"], lift));
    assert!(text.contains("no bounds: more than 100 000 sets"), "{text}");
    let output = with_scene(
        &["analyze", "-", "--bounds", "--within", "2", "--json"],
        lift,
    );
    let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert!(
        d["bounds"]["without"]
            .as_object()
            .is_some_and(|without| !without.is_empty())
    );
}

#[test]
fn an_analysis_along_the_motion_bounds_it() {
    let arguments = ["analyze", "-", "--along", "2", "--bounds"];
    let output = with_scene(&[&arguments[..], &["--json"]].concat(), CART);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let along = |path: &str| {
        let found = d.pointer(&format!("/along/{path}")).and_then(Value::as_f64);
        found.unwrap_or_else(|| panic!("{path}: {}", d["along"]))
    };
    let most = along("reactions/left/magnitude_at_most/force/value");
    assert!((most - 10.0).abs() < 1e-7, "{most}");
    assert_eq!(along("reactions/left/magnitude_at_most/force/time"), 2.0);
    assert!((along("reactions/left/bounds/N/highest/value") - 10.0).abs() < 1e-7);
    assert!(d["along"]["bounds"]["assumption"].is_string());
    let text = stdout(&with_scene(&arguments, CART));
    assert!(text.contains("force at most (N)  at (s)"), "{text}");
    let output = with_scene(&["analyze", "-", "--along", "2", "--json"], CART);
    let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert!(d["along"].get("bounds").is_none());
}

/// Two bars on two hinges each, in one scene.
const TWO_BARS: &str = r#"
    scene = { name = "two bars", space = "plane", gravity = [0.0, -9.81] }
    body = [
        { name = "b1", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] },
        { name = "b2", mass = 1.0, inertia = 0.1, position = [5.5, 0.0] },
    ]
    joint = [
        { name = "A", type = "revolute", bodies = ["ground", "b1"], at = [0.0, 0.0] },
        { name = "B", type = "revolute", bodies = ["ground", "b1"], at = [1.0, 0.0] },
        { name = "C", type = "revolute", bodies = ["ground", "b2"], at = [5.0, 0.0] },
        { name = "D", type = "revolute", bodies = ["ground", "b2"], at = [6.0, 0.0] },
    ]
    simulate = { t_end = 0.1 }
"#;

/// Rigid joints leave loads of their own mechanism undetermined, and no others.
#[test]
fn rigid_joints_affect_only_what_depends_on_them() {
    let output = with_scene(
        &["analyze", "-", "--bounds", "--rigid", "C,D", "--json"],
        TWO_BARS,
    );
    let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let number = |k: usize, what: &str| {
        d.pointer(&format!("/reactions/{k}/{what}"))
            .and_then(Value::as_f64)
    };
    for k in [0, 1] {
        let most = number(k, "magnitude_at_most/force").expect("a bound");
        assert!((most - 4.905).abs() < 1e-9, "{most}");
    }
    for k in [2, 3] {
        assert_eq!(number(k, "magnitude_at_most/force"), None);
    }
    let without = d["bounds"]["without"].as_object().expect("names");
    assert_eq!(without.keys().collect::<Vec<_>>(), ["C", "D"]);
    // The component that is not unique is named.
    let reason = without["C"].as_str().expect("a reason");
    assert!(reason.starts_with("Fx: "), "{reason}");
}

/// A list of written reactions does not change the bounds of these reactions.
#[test]
fn bounds_do_not_depend_on_the_written_reactions() {
    let folder = Folder::new("bounds-written");
    let run = |output: &str| {
        let scene = format!("{TWO_BARS}\noutput = {{ {output} }}");
        let output = with_scene(
            &["simulate", "-", "--bounds", "--out", folder.text()],
            &scene,
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(!stdout(&output).contains("warning"), "{}", stdout(&output));
        table(&folder)
    };
    let all = run("report = false");
    let one = run(r#"report = false, reactions = ["B"]"#);
    assert_eq!(one.0, ["t", "B.Fx.lowest", "B.Fx.highest"]);
    assert_eq!(column(&one, "B.Fx.highest"), column(&all, "B.Fx.highest"));
}

/// Options of the command replace the keys of the scene one by one.
#[test]
fn options_replace_keys_of_the_scene() {
    let folder = Folder::new("bounds-keys");
    let scene = format!(
        "{CART}\noutput = {{ report = false, bounds = {{ within = 3, compliance = \"left=1e-6,middle=1e-6,right=2e-6\" }} }}"
    );
    let ends = |options: &[&str]| {
        let arguments = [&["simulate", "-", "--out", folder.text()], options].concat();
        let output = with_scene(&arguments, &scene);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let found = table(&folder);
        ["lowest", "highest"].map(|end| column(&found, &format!("right.N.{end}"))[0])
    };
    // The share of `right` is (1/c) over the sum: c = 2 … 6, and 1 … 3 of the others.
    let expect = |found: [f64; 2], expected: [f64; 2]| {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    };
    let share = |right: f64, others: f64| 5.0 / right / (1.0 / right + 2.0 / others);
    expect(ends(&[]), [share(6.0, 1.0), share(2.0, 3.0)]);
    expect(ends(&["--bounds"]), [share(6.0, 1.0), share(2.0, 3.0)]);
    expect(ends(&["--within", "2"]), [share(4.0, 1.0), share(2.0, 2.0)]);
}

/// Small compliances and large factors stay in the range of numbers.
#[test]
fn compliances_of_any_size_have_bounds() {
    let legs: Vec<String> = (0..40)
        .map(|k| {
            format!(
                "{{ name = \"s{k}\", type = \"point-on-line\", body = \"beam\", at = [0.0, 0.0], line = [[-1.0, 0.0], [1.0, 0.0]] }},"
            )
        })
        .collect();
    let scene = format!(
        "scene = {{ name = \"stack\", space = \"plane\", gravity = [0.0, -10.0] }}\n\
         body = [{{ name = \"beam\", mass = 4.0, inertia = 1.0 }}]\njoint = [\n{}\n]",
        legs.join("\n")
    );
    let list: Vec<String> = (0..40).map(|k| format!("s{k}=1e-12")).collect();
    let list = list.join(",");
    let output = with_scene(
        &[
            "analyze",
            "-",
            "--bounds",
            "--within",
            "2",
            "--compliance",
            &list,
            "--json",
        ],
        &scene,
    );
    let d: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let at = |end: &str| {
        let path = format!("/reactions/0/components/1/bounds/{end}");
        d.pointer(&path).and_then(Value::as_f64)
    };
    let [lowest, highest] = ["lowest", "highest"].map(|end| at(end).expect("a number"));
    // All legs alike carry 1 N; 40 springs in parallel within a factor of 2 carry 40/79 … 80/41.
    assert!(lowest <= 40.0 / 79.0 + 1e-9 && highest >= 80.0 / 41.0 - 1e-9);
    assert!(
        lowest >= -1e-9 && highest <= 40.0 + 1e-9,
        "{lowest} {highest}"
    );
}

/// Requests that cannot be satisfied are found before a run.
#[test]
fn a_wrong_request_is_found_by_check() {
    for (bounds, words) in [
        ("{ within = 0 }", "need a ratio"),
        (r#"{ within = 2, compliance = "zz=1" }"#, "zz"),
        (r#"{ within = 2, compliance = "left=banana" }"#, "banana"),
    ] {
        let scene = format!("{CART}\noutput = {{ bounds = {bounds} }}");
        let output = with_scene(&["check", "-"], &scene);
        assert_eq!(output.status.code(), Some(2), "{bounds}");
        assert!(
            stderr(&output).contains(words),
            "{bounds}: {}",
            stderr(&output)
        );
    }
}
