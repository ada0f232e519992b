//! The five-minute test of docs/reports/first-minutes: the results of the scene that the page
//! describes, compared with closed forms, and each mistake with the message that the page quotes.

use std::fs;
use std::path::PathBuf;

use super::{Folder, pfaff, stderr, stdout, with_scene};

/// Returns the path of a file of the report.
fn place(name: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/reports/first-minutes");
    folder.join(name).display().to_string()
}

fn page(name: &str) -> String {
    fs::read_to_string(place(name)).expect("the report is there")
}

/// A mistake, and the messages about it: texts of the program that the page quotes.
const SLIPS: [(&str, &str, &[&str]); 8] = [
    (
        "type = \"revolute\"",
        "type = \"hinge\"",
        &[
            "joint `A` has the unknown type `hinge`",
            "did you mean `revolute`?",
        ],
    ),
    (
        "markers = [\"foot\"]",
        "markers = [\"rocker tip\"]",
        &[
            "measure `swing` refers to the unknown marker `rocker tip`",
            "the markers are `P`, `foot`, `tip`",
        ],
    ),
    (
        "markers = [\"foot\"]",
        "markers = [\"foot\", \"tip\"]",
        &[
            "measure `swing`: its markers move together, with one body: it never changes",
            "name markers of two bodies, or one marker alone to measure it from the ground",
        ],
    ),
    (
        "rod*coupler^3/12",
        "rod*copler^3/12",
        &[
            "body `coupler`: `inertia`: there is no parameter `copler`",
            "did you mean `coupler`?",
        ],
    ),
    (
        "crank = \"30 mm\"",
        "crank = \"30 deg\"",
        &["body `crank`: `centre`: found an angle (rad), need a length (m)"],
    ),
    (
        "ground = \"80 mm\"",
        "ground = \"230 mm\"",
        &["`[parameters]`: `psi`: `acos` is not defined for 1.2007"],
    ),
    (
        "t_end = \"1 s\"",
        "t_end = 1 s",
        &[
            "a number with a unit",
            "values with units need quotes: write `\"1 s\"`",
        ],
    ),
    (
        "coupler = [0, 0]",
        "coupler = [\"coupler\", 0]",
        &[
            "the start must be corrected by 350.4 deg (angle of body `crank`), more than the allowed 0.0573 deg: as described, these constraints are violated: `B` by 100 mm; correct the scene, or set `allow_correction = true` in `[start]`",
        ],
    ),
];

/// Returns a text on one line: line breaks and borders of tables in the terminal become spaces.
fn flat(text: &str) -> String {
    let words = text.split_whitespace().filter(|word| *word != "│");
    words.collect::<Vec<_>>().join(" ")
}

#[test]
fn first_minutes_slips_are_answered_as_the_page_says() {
    let (scene, page) = (page("four-bar.toml"), flat(&page("README.md")));
    for (right, wrong, answers) in SLIPS {
        let slipped = scene.replace(right, wrong);
        assert_ne!(slipped, scene, "{right}");
        let output = with_scene(&["check", "-"], &slipped);
        let said = flat(&(stdout(&output) + &stderr(&output)));
        for answer in answers {
            assert!(said.contains(answer), "{wrong}: {said}");
            assert!(page.contains(answer), "the page lacks: {answer}");
        }
    }
}

#[test]
fn first_minutes_slips_of_commands_are_answered_as_the_page_says() {
    let page = flat(&page("README.md"));
    for (arguments, answers) in [
        (
            &["run", "four-bar.toml"][..],
            [
                "unrecognized subcommand 'run'",
                "a similar subcommand exists: 'simulate'",
            ],
        ),
        (
            &["simulate", "four-bar.toml", "-o", "run"],
            [
                "unexpected argument '-o' found",
                "a similar argument exists: '--out'",
            ],
        ),
    ] {
        let output = pfaff(arguments);
        assert_eq!(output.status.code(), Some(2));
        let said = flat(&stderr(&output));
        for answer in answers {
            assert!(said.contains(answer), "{arguments:?}: {said}");
            assert!(page.contains(answer), "the page lacks: {answer}");
        }
    }
}

/// The test compares the swing of the rocker between its dead positions, and a point of the coupler
/// after half a revolution, which follows from the intersection of two circles.
#[test]
fn first_minutes_numbers_are_those_of_closed_forms() {
    let folder = Folder::new("first-minutes");
    fs::create_dir_all(&folder.0).expect("a folder");
    let file = folder.0.join("four-bar.toml");
    fs::write(&file, page("four-bar.toml")).expect("writable");
    let file = file.to_str().expect("UTF-8").to_owned();
    let out = Folder(folder.0.join("run"));
    let output = pfaff(&["simulate", &file, "--out", out.text()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let mut table = csv::Reader::from_path(out.0.join("trajectory.csv")).expect("readable");
    let names = table.headers().expect("a header").clone();
    let rows: Vec<Vec<f64>> = table
        .deserialize()
        .map(|row| row.expect("numbers"))
        .collect();
    let column = |name: &str| {
        let k = names.iter().position(|x| x == name).expect("a column");
        rows.iter().map(move |row| row[k])
    };
    let swing = column("swing").fold(f64::MIN, f64::max) - column("swing").fold(f64::MAX, f64::min);
    let at_ground = |line: f64| {
        ((0.09_f64.powi(2) + 0.08_f64.powi(2) - line * line) / (2.0 * 0.09 * 0.08)).acos()
    };
    let exact = at_ground(0.13) - at_ground(0.07);
    // Rows are 5 ms apart: the error of the largest value is at most half of ω̇·(2.5 ms)² = 3e-4
    // rad.
    assert!(
        swing < exact + 1e-8 && swing > exact - 3e-4,
        "{swing} {exact}"
    );
    let half = column("t")
        .position(|t| (t - 0.5).abs() < 1e-9)
        .expect("a row");
    for (name, exact) in [("P.x", -2.096 / 73.0), ("P.y", 1.988 / 73.0)] {
        let found = column(name).nth(half).expect("a number");
        assert!((found - exact).abs() < 1e-8, "{name}: {found} {exact}");
    }
    // A crank that cannot make a full revolution stops, and its rows are kept.
    let output = pfaff(&[
        "simulate",
        &file,
        "--set",
        "crank=75mm",
        "--out",
        out.text(),
        "--force",
    ]);
    assert_eq!(output.status.code(), Some(1));
    let said = flat(&stderr(&output));
    assert!(
        said.contains("at t = 0.732197 s drive `motor` cannot turn `A` beyond 353.6°"),
        "{said}"
    );
}

/// The models of the three first hours in space are read, and have the ranks that their users
/// counted.
#[test]
fn models_of_the_first_hours_are_read() {
    let folder = Folder::new("first-hours");
    fs::create_dir_all(&folder.0).expect("a folder");
    let gripper = folder.0.join("gripper.toml");
    let gripper = gripper.to_str().expect("a path");
    let (urdf, yaml) = (place("gripper.urdf"), place("gripper.yaml"));
    let imported = pfaff(&["import", &urdf, "--loops", &yaml, "--out", gripper]);
    assert!(imported.status.success(), "{}", stderr(&imported));
    for (scene, counted) in [
        (
            place("excavator.toml"),
            "rank 36 (34 without its drives), redundancy 10 (9 without), mobility 0",
        ),
        (
            place("propeller-shaft.toml"),
            "rank 18 (17 without its drive), redundancy 11",
        ),
        (gripper.to_owned(), "redundancy 1, mobility"),
    ] {
        let output = pfaff(&["analyze", &scene]);
        let said = flat(&stdout(&output));
        assert!(said.contains(counted), "{scene}: {said}{}", stderr(&output));
    }
}
