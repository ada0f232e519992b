//! Tests format 2 on the command line: `--set` for every command that reads a scene, and `sweep`
//! over parameters. A scene in millimetres and degrees is compared with the same scene in metres
//! and radians.

use serde_json::Value;

use super::bad_input::PENDULUM;
use super::{Folder, pfaff, stderr, stdout, with_scene};

/// A rod has a hinge and a second hinge at its other end on a rail: a driven slider-crank.
const DRAWING: &str = r#"
[scene]
name = "slider-crank"
space = "plane"
format = 2
units = { length = "mm", angle = "deg" }
gravity = [0, -9810]

[parameters]
r = 100
L = "3*r"
phi = 60
psi = "asin(r*sin(phi)/L)"
x = "r*cos(phi) + L*cos(psi)"

[[body]]
name = "crank"
mass = "200 g"
inertia = 200
position = ["r*cos(phi)/2", "r*sin(phi)/2"]
angle = "phi"

[[body]]
name = "rod"
mass = 0.5
inertia = "4e-3 kg*m^2"
position = ["(r*cos(phi) + x)/2", "r*sin(phi)/2"]
angle = "-psi"

[[body]]
name = "slider"
mass = 1
inertia = 1e3
position = ["x", 0]

[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "crank"]
at = [0, 0]

[[joint]]
name = "B"
type = "revolute"
bodies = ["crank", "rod"]
at = ["r*cos(phi)", "r*sin(phi)"]

[[joint]]
name = "C"
type = "revolute"
bodies = ["rod", "slider"]
at = ["x", 0]

[[joint]]
name = "rail"
type = "translational"
bodies = ["ground", "slider"]
points = { ground = [0, 0], slider = [0, 0] }
axis = [1, 0]

[[drive]]
name = "motor"
joint = "A"
type = "angle"
motion = { type = "constant-rate", rate = 90 }

[simulate]
t_end = "500 ms"
output_step = 0.05
"#;

/// The same values in metres and radians: sin ψ = √3/6, cos ψ = √33/6.
fn in_metres() -> String {
    let (cos, sin) = (0.5, 3_f64.sqrt() / 2.0);
    let (r, l) = (0.1, 0.3);
    let psi = (sin / 3.0).asin();
    let x = r * cos + l * 33_f64.sqrt() / 6.0;
    let begin = DRAWING.find("[parameters]").expect("there");
    let end = DRAWING.find("[[body]]").expect("there");
    let mut text = DRAWING.to_owned();
    text.replace_range(begin..end, "");
    for (from, to) in [
        (
            "format = 2\nunits = { length = \"mm\", angle = \"deg\" }\n",
            String::new(),
        ),
        ("-9810", "-9.81".to_owned()),
        ("\"200 g\"", "0.2".to_owned()),
        ("inertia = 200", "inertia = 2e-4".to_owned()),
        (
            "[\"r*cos(phi)/2\", \"r*sin(phi)/2\"]",
            format!("[{:?}, {:?}]", r * cos / 2.0, r * sin / 2.0),
        ),
        ("\"phi\"", "1.0471975511965976".to_owned()),
        ("\"4e-3 kg*m^2\"", "0.004".to_owned()),
        (
            "\"(r*cos(phi) + x)/2\", \"r*sin(phi)/2\"",
            format!("{:?}, {:?}", (r * cos + x) / 2.0, r * sin / 2.0),
        ),
        ("\"-psi\"", format!("{:?}", -psi)),
        ("inertia = 1e3", "inertia = 1e-3".to_owned()),
        ("\"x\"", format!("{x:?}")),
        (
            "[\"r*cos(phi)\", \"r*sin(phi)\"]",
            format!("[{:?}, {:?}]", r * cos, r * sin),
        ),
        ("rate = 90", "rate = 1.5707963267948966".to_owned()),
        ("\"500 ms\"", "0.5".to_owned()),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, &to);
    }
    text
}

fn document(arguments: &[&str], scene: &str) -> Value {
    let output = with_scene(arguments, scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("one document")
}

#[test]
fn a_drawing_is_judged_as_the_same_scene_in_metres() {
    let verdict = |scene: &str| {
        let d = document(&["analyze", "-", "--json"], scene);
        let reactions = d["reactions"].as_array().expect("a list").iter();
        let verdicts: Vec<Value> = reactions.map(|r| r["verdict"].clone()).collect();
        (
            d["rank"].clone(),
            d["redundancy"].clone(),
            d["mobility"].clone(),
            verdicts,
        )
    };
    assert_eq!(verdict(DRAWING), verdict(&in_metres()));
}

/// Motions agree to the differences that two runs with rounded data have.
const AGREED: f64 = 1e-9;

#[test]
fn a_drawing_moves_as_the_same_scene_in_metres() {
    let rows = |name: &str, scene: &str| -> Vec<f64> {
        let folder = Folder::new(name);
        document(&["simulate", "-", "--out", folder.text(), "--json"], scene);
        let tables = [folder.read("trajectory.csv"), folder.read("reactions.csv")];
        let lines = tables.iter().flat_map(|table| table.lines().skip(1));
        lines
            .flat_map(|line| line.split(','))
            .map(|cell| cell.parse().unwrap_or(f64::NAN))
            .collect()
    };
    let (drawing, metres) = (
        rows("language-drawing", DRAWING),
        rows("language-metres", &in_metres()),
    );
    assert_eq!(drawing.len(), metres.len());
    assert!(drawing.len() > 11 * 19);
    for (a, b) in drawing.iter().zip(&metres) {
        let is_near = (a - b).abs() <= AGREED * (1.0 + b.abs());
        assert!(is_near || (a.is_nan() && b.is_nan()), "{a} {b}");
    }
}

/// Sentences and errors have the units of the scene; `--si` selects SI units for them too.
#[test]
fn sentences_have_the_units_of_the_scene() {
    let text = |arguments: &[&str], scene: &str| {
        let output = with_scene(arguments, scene);
        let text = stdout(&output) + &stderr(&output);
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let rough = DRAWING.replace("format = 2", "format = 2\ntolerance = 0.02");
    let accuracy = text(&["analyze", "-"], &rough);
    assert!(accuracy.contains("data accurate to 0.02 mm"), "{accuracy}");
    let accuracy = text(&["analyze", "-", "--si"], &rough);
    assert!(accuracy.contains("data accurate to 2e-5 m"), "{accuracy}");

    // The point of the ground is 30 mm off the slider.
    let open = DRAWING.replace(
        "points = { ground = [0, 0], slider",
        "points = { ground = [0, 30], slider",
    );
    for arguments in [&["check", "-"][..], &["check", "-", "--json"]] {
        let refused = text(arguments, &open);
        for said in [
            "corrected by 5.412 deg (angle of",
            "violated: `rail` by 30 mm;",
        ] {
            assert!(refused.contains(said), "{refused}");
        }
    }
    let refused = text(&["check", "-", "--si"], &open);
    for said in [
        "corrected by 0.09446 rad (angle of",
        "violated: `rail` by 0.03 m;",
    ] {
        assert!(refused.contains(said), "{refused}");
    }
}

/// A comparison prints lengths and angles in the units of its first scene.
#[test]
fn the_first_scene_states_the_units_of_a_comparison() {
    let folder = Folder::new("language-comparison");
    std::fs::create_dir_all(&folder.0).expect("a folder");
    let slow = DRAWING.replace("rate = 90", "rate = 45");
    let scenes = [("drawing.toml", slow), ("metres.toml", in_metres())];
    let [drawing, metres] = scenes.map(|(name, text)| {
        let path = folder.0.join(name);
        std::fs::write(&path, text).expect("a scene");
        path.display().to_string()
    });
    let head = |scenes: [&str; 2]| {
        let text = stdout(&pfaff(&["diff", scenes[0], scenes[1]]));
        let head = text.lines().find(|line| line.starts_with("body "));
        head.unwrap_or_else(|| panic!("{text}")).to_owned()
    };
    let units = head([&drawing, &metres]);
    assert!(
        units.contains("place (mm)") && units.contains("angle (deg)"),
        "{units}"
    );
    let units = head([&metres, &drawing]);
    assert!(units.contains("angle (rad)"), "{units}");
}

/// Every command that reads a scene accepts changed values for it.
#[test]
fn set_changes_the_scene_of_every_command() {
    let folder = Folder::new("language-commands");
    std::fs::create_dir_all(&folder.0).expect("a directory");
    let inner = |name: &str| folder.0.join(name).display().to_string();
    let [file, out, page] = ["scene.toml", "run", "view.html"].map(inner);
    std::fs::write(&file, DRAWING).expect("a file");
    for command in [
        vec!["check", &file],
        vec!["analyze", &file],
        vec!["plan", &file],
        vec!["view", &file, "--out", &page, "--no-open"],
        vec!["diff", &file, &file],
        vec!["simulate", &file, "--out", &out],
        vec!["work-precision", &file, "--quick", "--out", &out],
        vec!["sweep", &file, "--vary", "phi=10,20", "--out", &out],
    ] {
        // The effect is visible: the crank is longer than its rod, and the start is not possible.
        let output = pfaff(&[&command[..], &["--set", "L=r/2"]].concat());
        assert_eq!(output.status.code(), Some(2), "{command:?}");
        assert!(
            stderr(&output).contains("`asin` is not defined for 1.73205"),
            "{command:?}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn set_takes_expressions_and_keys() {
    let x = |sets: &[&str]| {
        let folder = Folder::new("language-set");
        let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", *set]).collect();
        let arguments = [
            &["simulate", "-", "--out", folder.text(), "--json"],
            &sets[..],
        ]
        .concat();
        document(&arguments, DRAWING);
        let table = folder.read("trajectory.csv");
        let mut lines = table.lines();
        let column = lines
            .next()
            .expect("a header")
            .split(',')
            .position(|c| c == "slider.x");
        let first = lines
            .next()
            .expect("a row")
            .split(',')
            .nth(column.expect("there"));
        first
            .and_then(|cell| cell.parse::<f64>().ok())
            .expect("a number")
    };
    // At φ = 0 the slider is at the distance r + L.
    for (sets, expected) in [
        (&["phi=0"][..], 0.4),
        (&["phi = 0", "L = 2*r"], 0.3),
        (&["phi=0", "L=0.25 m", "r=5 cm"], 0.3),
        (&["parameters.phi=0 rad"], 0.4),
        (
            &["phi=0", "body.slider.mass=2 kg", "simulate.rtol=1e-6"],
            0.4,
        ),
    ] {
        let found = x(sets);
        assert!((found - expected).abs() < 1e-12, "{sets:?}: {found}");
    }
}

#[test]
fn wrong_settings_say_what_there_is() {
    for (set, expected) in [
        (
            "Lx=2",
            "--set: `Lx`: there is no `Lx` in `the scene`; did you mean `L`?",
        ),
        (
            "body.crank.name.x=2",
            "--set: `body.crank.name.x`: there is no `x` in `body.crank.name`",
        ),
        ("L", "need NAME=EXPR"),
        (
            "L=2*",
            "`[parameters]`: `L`: a number, a name or `(` is missing at the end",
        ),
        (
            "L=2 kg",
            "found a quantity (1/kg), need a number without a unit",
        ),
    ] {
        let output = with_scene(&["check", "-", "--set", set], DRAWING);
        assert_eq!(output.status.code(), Some(2), "{set}");
        assert!(
            stderr(&output).contains(expected),
            "{set}: {}",
            stderr(&output)
        );
    }
    let twice = ["check", "-", "--set", "L=1", "--set", "parameters.L=2"];
    let said = stderr(&with_scene(&twice, DRAWING));
    assert!(
        said.contains("`parameters.L` and `L` are the same number"),
        "{said}"
    );
    // For a text that is not TOML the message is the same as without settings.
    let said = stderr(&with_scene(&["check", "-", "--set", "L=1"], "[scene"));
    assert!(said.contains("<stdin>"), "{said}");
    // A scene of format 1 accepts changed values.
    let old = ["check", "-", "--set", "body.bob.mass=3"];
    assert_eq!(with_scene(&old, PENDULUM).status.code(), Some(0));
    let old = ["check", "-", "--set", "body.bob.mass=3 kg"];
    let said = stderr(&with_scene(&old, PENDULUM));
    assert!(said.contains("must be a number"), "{said}");
}

/// At φ = 0 the slider begins at r + L.
#[test]
fn a_parameter_is_swept_like_any_number() {
    let folder = Folder::new("language-sweep");
    let arguments = [
        "sweep",
        "-",
        "--vary",
        "L=200:300:3",
        "--set",
        "phi=0",
        "--out",
        folder.text(),
        "--keep-rows",
    ];
    let output = with_scene(&arguments, DRAWING);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let table = folder.read("sweep.csv");
    assert!(
        table.lines().next().expect("a header").contains("L,"),
        "{table}"
    );
    for (run, expected) in [("1", 0.3), ("2", 0.35), ("3", 0.4)] {
        let rows = folder.read(&format!("runs/{run}/trajectory.csv"));
        let mut lines = rows.lines();
        let column = lines
            .next()
            .expect("a header")
            .split(',')
            .position(|c| c == "slider.x");
        let first = lines
            .next()
            .expect("a row")
            .split(',')
            .nth(column.expect("there"));
        let x: f64 = first.expect("a cell").parse().expect("a number");
        assert!((x - expected).abs() < 1e-12, "{run}: {x}");
    }
    let wrong = ["sweep", "-", "--vary", "Lx=1:2:2", "--out", folder.text()];
    let said = stderr(&with_scene(&wrong, DRAWING));
    assert!(
        said.contains("there is no `Lx` in `the scene`; did you mean `L`?"),
        "{said}"
    );
}

/// Returns the first cells of a column of `sweep.csv`.
fn column(table: &str, name: &str) -> Vec<String> {
    let mut lines = table.lines();
    let header = lines.next().expect("a header");
    let at = header.split(',').position(|c| c == name);
    let at = at.unwrap_or_else(|| panic!("no {name} in {header}"));
    let cell = |line: &str| line.split(',').nth(at).unwrap_or_default().to_owned();
    lines.map(cell).collect()
}

/// The scene checks a unit, and the table is in SI.
#[test]
fn a_range_may_have_units() {
    let swept = |name: &str, vary: &str| {
        let folder = Folder::new(name);
        let arguments = [
            "sweep",
            "-",
            "--vary",
            vary,
            "--set",
            "phi=0",
            "--set",
            "r=10 cm",
            "--out",
            folder.text(),
        ];
        let output = with_scene(&arguments, DRAWING);
        (folder, output)
    };
    let (folder, output) = swept("language-units", "L=20cm:40cm:3");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let table = folder.read("sweep.csv");
    assert_eq!(column(&table, "L"), ["0.2", "0.3", "0.4"]);
    // At φ = 0 the motor has turned by 45°: sin ψ = r·sin φ/L, x = r·cos φ + L·cos ψ.
    for (found, l) in column(&table, "slider.x").iter().zip([0.2, 0.3, 0.4]) {
        let found: f64 = found.parse().expect("a number");
        let height = 0.1 * 0.5_f64.sqrt();
        let expected = height + (l * l - height * height).sqrt();
        assert!((found - expected).abs() < 1e-6, "{l}: {found} {expected}");
    }
    let (_, output) = swept("language-kind", "L=2kg:3kg:2");
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("found a quantity (m/kg), need a number"),
        "{said}"
    );
    let (_, output) = swept("language-mixed", "L=200:300mm:2");
    let said = stderr(&output);
    assert!(
        said.contains("both ends need the same unit, or none"),
        "{said}"
    );
}

/// The key `active` may be varied; a run without a reaction has no value for it in its row.
#[test]
fn what_is_active_may_be_varied() {
    let folder = Folder::new("language-active");
    let second = "[[joint]]\nname = \"B2\"\ntype = \"revolute\"\nbodies = [\"crank\", \"rod\"]\n\
                  at = [\"r*cos(phi)\", \"r*sin(phi)\"]\nactive = \"doubled\"\n\n[[joint]]\nname = \"C\"";
    let scene = DRAWING
        .replace("r = 100\n", "r = 100\ndoubled = 1\n")
        .replace("[[joint]]\nname = \"C\"", second);
    let arguments = [
        "sweep",
        "-",
        "--vary",
        "doubled=0,1",
        "--out",
        folder.text(),
    ];
    let output = with_scene(&arguments, &scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let table = folder.read("sweep.csv");
    assert_eq!(column(&table, "redundancy"), ["0", "2"], "{table}");
    let largest = |name: &str| column(&table, name);
    let (of_second, of_c) = (largest("B2.F_max"), largest("C.F_max"));
    assert!(
        of_second
            .iter()
            .all(|cell| cell.parse::<f64>().is_ok_and(f64::is_nan) || cell.is_empty()),
        "{table}"
    );
    let [free, doubled] = [0, 1].map(|k| of_c[k].parse::<f64>().expect("unique"));
    assert!((free - doubled).abs() < 1e-6 * free, "{free} {doubled}");
}

/// Curves are in the units of the drawing, and the page states this; files are in SI.
#[test]
fn a_report_has_the_units_of_the_scene() {
    let page = |name: &str, scene: &str| {
        let folder = Folder::new(name);
        document(&["simulate", "-", "--out", folder.text(), "--json"], scene);
        folder.read("report.html")
    };
    let drawing = page("language-page", DRAWING);
    let begin = drawing.find("\"units\":").expect("units");
    let units = &drawing[begin + "\"units\":".len()..];
    let end = units.find('}').expect("an end") + 1;
    let units: Value = serde_json::from_str(&units[..end]).expect("JSON");
    assert_eq!(units["m/s"], serde_json::json!(["mm/s", 1000.0]));
    let degrees = units["rad"][1].as_f64().expect("a number");
    assert!(units["rad"][0] == "deg" && (degrees - 57.295_779_513_082_32).abs() < 1e-12);
    assert!(drawing.contains("in the units of the scene (mm, deg)"));
    let metres = page("language-plain-page", &in_metres());
    assert!(metres.contains("\"units\":{}") && !metres.contains("units of the scene ("));
}
