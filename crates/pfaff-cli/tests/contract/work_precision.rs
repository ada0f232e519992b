//! Tests `work-precision`: its files, its rows, its errors.

use serde_json::Value;

use super::bad_input::PENDULUM;
use super::{Folder, pfaff, stderr, stdout, with_scene};

/// The documented columns, in their order; more may follow.
const COLUMNS: &str = "scene,formulation,method,stabilisation,tolerance,error_position,error_velocity,error_acceleration,\
error_reaction,constraint_residual,evaluations,projections,factorisations,steps,seconds,status,";

/// Runs a scene with `--quick`; returns the lines of the table below its header.
fn quick(folder: &Folder, scene: &str) -> (std::process::Output, Vec<Vec<String>>) {
    let output = pfaff(&["work-precision", scene, "--quick", "--out", folder.text()]);
    let table = folder.read("work_precision.csv");
    let mut lines = table.lines();
    let header = lines.next().expect("a header");
    assert!(header.starts_with(COLUMNS), "{header}");
    let rows = lines.map(|line| line.split(',').map(str::to_owned).collect());
    (output, rows.collect())
}

#[test]
fn runs_that_fail_are_rows_with_their_reason() {
    let folder = Folder::new("work-precision-failing");
    // A deliberate contradiction: the pivot has a second drive, which agrees with the first until
    // half a second.
    let scene = super::bad_input::contradiction_at_half_a_second();
    let path = folder.0.join("scene.toml");
    std::fs::create_dir_all(&folder.0).expect("writable");
    std::fs::write(&path, scene).expect("writable");
    let (output, rows) = quick(&folder, path.to_str().expect("UTF-8"));
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(!rows.is_empty());
    for row in &rows {
        assert!(row[14] == "NaN" && row[15] != "done", "{row:?}");
    }
    let named = rows
        .iter()
        .filter(|row| row[15..].join(",").contains("t = 0.5"));
    assert!(named.count() > 3, "{rows:?}");
    assert!(stdout(&output).contains("did not reach their end"));
}

#[test]
fn a_scene_of_ones_own_is_compared_with_two_methods_that_agree() {
    let folder = Folder::new("work-precision-own");
    let arguments = [
        "work-precision",
        "-",
        "--quick",
        "--json",
        "--out",
        folder.text(),
        #[cfg(feature = "png")]
        "--png",
    ];
    let output = with_scene(&arguments, PENDULUM);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    #[cfg(feature = "png")]
    super::picture::is_the_figure(&folder, "work_precision");
    let document: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
    let reference = &document["scenes"][0]["reference"];
    let agreement = reference["agreement"].as_str().expect("a text");
    assert!(
        agreement.contains(" and ") && agreement.contains("agree to"),
        "{agreement}"
    );
    let limit = reference["limits"][0].as_f64().expect("known");
    assert!(limit > 0.0 && limit < 1e-9, "{limit:e}");
    assert_eq!(document["partial"], false);
}

#[test]
fn wrong_input_is_refused_before_anything_is_run() {
    let folder = Folder::new("work-precision-wrong");
    let out = folder.text();
    for (arguments, piece) in [
        (
            vec!["work-precision", "no-such-scene", "--out", out],
            "no-such-scene",
        ),
        (vec!["work-precision", "--out", out], "<SCENE>"),
        (
            vec![
                "work-precision",
                super::ROBOT,
                "--quick",
                "--all",
                "--out",
                out,
            ],
            "--all",
        ),
    ] {
        let output = pfaff(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            stderr(&output).contains(piece),
            "{arguments:?}: {}",
            stderr(&output)
        );
    }
    let (scene, _) = PENDULUM.split_once("[simulate]").expect("it has an end");
    let endless = with_scene(&["work-precision", "-", "--out", out], scene);
    assert_eq!(endless.status.code(), Some(2));
    assert!(stderr(&endless).contains("t_end"), "{}", stderr(&endless));
    assert!(!folder.0.exists());
}

#[test]
fn a_place_that_takes_no_results_is_wrong_input() {
    let folder = Folder::new("work-precision-occupied");
    std::fs::create_dir_all(&folder.0).expect("writable");
    let file = folder.0.join("file");
    std::fs::write(&file, "here first").expect("writable");
    let output = pfaff(&[
        "work-precision",
        super::ROBOT,
        "--quick",
        "--out",
        file.to_str().expect("UTF-8"),
    ]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(
        stderr(&output).contains("cannot make the directory"),
        "{}",
        stderr(&output)
    );
}
