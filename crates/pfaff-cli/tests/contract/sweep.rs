//! `sweep`: its tables, its refusals, and that no finished run is lost or repeated after any
//! interruption.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use serde_json::Value;

use super::bad_input::PENDULUM;
use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// The documented first columns; those of bodies and reactions follow.
const COLUMNS: &str = "status,error,method,t,steps,rejected,evaluations,projections,events,rank,redundancy,not_unique,fragile,seconds,\
max_position_residual,max_velocity_residual,energy_balance,start_correction,start_velocity_correction,t_state,";

/// Masses of the robot's platform: enough of them that a sweep can be stopped while it runs.
const MASSES: &str = "body.platform.mass=10:40:24";

/// How long a test waits for an event that must occur.
const PATIENCE: Duration = Duration::from_secs(120);

/// A table, header included, cell by cell.
fn cells(folder: &Folder) -> Vec<Vec<String>> {
    let text = folder.read("sweep.csv");
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(text.as_bytes());
    let rows = reader
        .records()
        .map(|row| row.expect("a row").iter().map(str::to_owned).collect());
    rows.collect()
}

/// The same without the run times.
fn table(folder: &Folder) -> Vec<Vec<String>> {
    let mut rows = cells(folder);
    let seconds = rows[0]
        .iter()
        .position(|name| name == "seconds")
        .expect("a column");
    rows.iter_mut().for_each(|row| drop(row.remove(seconds)));
    rows
}

fn begun(arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pfaff"));
    command
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command.spawn().expect("the command starts")
}

/// Waits until a journal contains this number of finished runs.
fn wait_for(journal: &Path, runs: usize) {
    let begin = Instant::now();
    loop {
        let lines = fs::read(journal).map_or(0, |b| b.iter().filter(|b| **b == b'\n').count());
        if lines > runs {
            return;
        }
        assert!(
            begin.elapsed() < PATIENCE,
            "{lines} lines in {}",
            journal.display()
        );
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn summary(folder: &Folder) -> Value {
    serde_json::from_str(&folder.read("summary.json")).expect("JSON")
}

#[test]
fn a_killed_sweep_loses_nothing_and_repeats_nothing() {
    let [killed, whole] = ["sweep-killed", "sweep-whole"].map(Folder::new);
    let arguments = |folder: &Folder, threads: &str| {
        let words = [
            "sweep",
            ROBOT,
            "--vary",
            MASSES,
            "--threads",
            threads,
            "--out",
            folder.text(),
        ];
        words.map(str::to_owned).to_vec()
    };
    let run = |folder: &Folder, threads: &str| {
        let words = arguments(folder, threads);
        pfaff(&words.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let journal = killed.0.join("sweep.journal");
    let mut kept = Vec::new();
    for k in 1..=2 {
        let words = arguments(&killed, "2");
        let mut child = begun(&words.iter().map(String::as_str).collect::<Vec<_>>());
        wait_for(&journal, 3 * k);
        // SIGKILL: no code of the program runs after it.
        child.kill().expect("it runs");
        assert!(!child.wait().expect("it ends").success());
        let mut bytes = fs::read(&journal).expect("written");
        let end = bytes.iter().rposition(|b| *b == b'\n').expect("lines") + 1;
        assert!(bytes.starts_with(&kept), "finished runs were made again");
        kept = bytes[..end].to_vec();
        assert!(
            kept.iter().filter(|b| **b == b'\n').count() < 25,
            "it was too fast to be killed"
        );
        // Half of a line, as a power failure leaves it.
        bytes.truncate(end);
        bytes.extend_from_slice(&kept[kept.len() - 100..kept.len() - 1]);
        fs::write(&journal, &bytes).expect("writable");
    }
    assert_eq!(run(&killed, "2").status.code(), Some(0));
    let bytes = fs::read(&journal).expect("written");
    assert!(bytes.starts_with(&kept), "finished runs were made again");
    assert_eq!(bytes.iter().filter(|b| **b == b'\n').count(), 25);
    assert_eq!(run(&whole, "1").status.code(), Some(0));
    assert_eq!(table(&killed), table(&whole));
    // A third run finds nothing to do.
    assert_eq!(run(&killed, "1").status.code(), Some(0));
    assert_eq!(fs::read(&journal).expect("written"), bytes);
}

#[cfg(unix)]
#[test]
fn an_interrupted_sweep_says_so_and_has_code_1() {
    let folder = Folder::new("sweep-interrupted");
    let child = begun(&[
        "sweep",
        ROBOT,
        "--vary",
        MASSES,
        "--json",
        "--out",
        folder.text(),
    ]);
    wait_for(&folder.0.join("sweep.journal"), 2);
    let interrupt = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(interrupt.is_ok_and(|status| status.success()));
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(
        (output.status.code(), stderr(&output).as_str()),
        (Some(1), "")
    );
    let document: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
    assert_eq!(document, summary(&folder));
    assert_eq!(
        (&document["partial"], &document["runs"]),
        (&Value::Bool(true), &Value::from(24))
    );
    // The finished runs are in the table, in the order of the grid.
    let runs: Vec<usize> = table(&folder)[1..]
        .iter()
        .map(|r| r[0].parse().expect("a run"))
        .collect();
    assert_eq!(document["finished"], runs.len());
    assert!(runs.is_sorted() && runs.len() < 24);
}

#[test]
fn shards_make_the_whole() {
    let [whole, one, two] = ["sweep-all", "sweep-first", "sweep-second"].map(Folder::new);
    let sweep = |folder: &Folder, more: &[&str]| {
        let words = [
            "sweep",
            "-",
            "--vary",
            "body.bob.mass=1:3:5",
            "--out",
            folder.text(),
        ];
        with_scene(&[&words[..], more].concat(), PENDULUM)
    };
    assert_eq!(sweep(&whole, &[]).status.code(), Some(0));
    for (folder, shard) in [(&one, "1/2"), (&two, "2/2")] {
        assert_eq!(sweep(folder, &["--shard", shard]).status.code(), Some(0));
        assert_eq!(summary(folder)["partial"], true);
    }
    let missing = Folder::new("sweep-missing");
    let output = pfaff(&["sweep", "--merge", one.text(), "--out", missing.text()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stdout(&output).contains("3 of 5 runs") && stdout(&output).contains("runs are missing")
    );
    let output = pfaff(&[
        "sweep",
        "--merge",
        one.text(),
        two.text(),
        "--out",
        two.text(),
    ]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(table(&two), table(&whole));
    let output = pfaff(&[
        "sweep",
        "--merge",
        one.text(),
        "--out",
        missing.text(),
        "--shard",
        "1/2",
    ]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn parquet_has_what_csv_has() {
    let folder = Folder::new("sweep-parquet");
    let words = [
        "sweep",
        "-",
        "--vary",
        "body.bob.mass=-1,1,2",
        "--out",
        folder.text(),
    ];
    let output = with_scene(&words, PENDULUM);
    assert_eq!(
        output.status.code(),
        Some(1),
        "a run was refused: {output:?}"
    );
    assert!(
        stdout(&output).contains("run 1 refused: body `bob`: mass is -1"),
        "{}",
        stdout(&output)
    );
    let rows = cells(&folder);
    let header = rows[0].join(",");
    assert!(
        header.starts_with(&format!("run,body.bob.mass,{COLUMNS}bob.x,")),
        "{header}"
    );
    assert!(
        header.ends_with("bob.omega,pivot.F_max,pivot.F_max_t,pivot.T_max,pivot.T_max_t"),
        "{header}"
    );
    let file = File::open(folder.0.join("sweep.parquet")).expect("written");
    let reader = SerializedFileReader::new(file).expect("Parquet");
    let about = reader.metadata().file_metadata().key_value_metadata();
    let about = about.and_then(|pairs| pairs.iter().find(|pair| pair.key == "pfaff.sweep"));
    assert!(about.is_some_and(|pair| {
        pair.value
            .as_deref()
            .is_some_and(|v| v.contains("body.bob.mass=-1,1,2"))
    }));
    let found: Vec<_> = reader.get_row_iter(None).expect("rows").collect();
    assert_eq!((found.len(), rows.len()), (3, 4));
    for (row, written) in found.into_iter().zip(&rows[1..]) {
        let row = row.expect("a row");
        assert_eq!(row.len(), written.len());
        for (((name, field), column), cell) in row.get_column_iter().zip(&rows[0]).zip(written) {
            assert_eq!(name, column);
            match field {
                Field::Null => assert_eq!(cell, "", "{name}"),
                Field::Long(value) => assert_eq!(cell.parse(), Ok(*value), "{name}"),
                Field::Double(value) => {
                    let cell: f64 = cell.parse().expect("a number");
                    assert!(
                        cell.to_bits() == value.to_bits() || cell.is_nan() && value.is_nan(),
                        "{name}"
                    );
                }
                Field::Str(value) => assert_eq!(cell, value, "{name}"),
                other => panic!("{name}: {other}"),
            }
        }
    }
}

#[test]
fn wrong_keys_and_changed_sweeps_have_code_2() {
    let folder = Folder::new("sweep-wrong");
    let sweep = |scene: &str, vary: &str| -> Output {
        with_scene(
            &["sweep", "-", "--vary", vary, "--out", folder.text()],
            scene,
        )
    };
    #[track_caller]
    fn refused(output: &Output, piece: &str) {
        let text = stderr(output);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.contains(piece), "`{piece}` is not in:\n{text}");
    }
    for (vary, piece) in [
        (
            "body.bib.mass=1:2:3",
            "there is no `bib` in `body`; did you mean `bob`?",
        ),
        (
            "body.bob.mas=1:2:3",
            "body `bob` has no key `mas`; did you mean `mass`?",
        ),
        (
            "scene.gravity=1:2:3",
            "its parts are `scene.gravity[0]`, `scene.gravity[1]`",
        ),
        ("body.bob.name=1,2", "is the text \"bob\", not a number"),
        ("body.bob.mass=-1,-2", "none of the 2 runs can begin"),
    ] {
        refused(&sweep(PENDULUM, vary), piece);
    }
    // A scene that is wrong without any variation is reported with its place.
    refused(
        &sweep(&PENDULUM.replace("inertia", "inertja"), "body.bob.mass=1,2"),
        "<stdin>:10:1",
    );
    assert!(!folder.0.exists());
    assert_eq!(sweep(PENDULUM, "body.bob.mass=1,2").status.code(), Some(0));
    refused(
        &sweep(PENDULUM, "body.bob.mass=1,3"),
        "belongs to another sweep: the grid is body.bob.mass=1,3",
    );
    let heavier = PENDULUM.replace("inertia = 0.1", "inertia = 0.2");
    refused(
        &sweep(&heavier, "body.bob.mass=1,2"),
        "belongs to another sweep: the text of the scene",
    );
    refused(
        &pfaff(&[
            "sweep",
            "--merge",
            folder.0.join("..").to_str().expect("UTF-8"),
            "--out",
            folder.text(),
        ]),
        "no sweep was begun",
    );
    refused(
        &pfaff(&[
            "sweep",
            ROBOT,
            "--vary",
            "body.platform.mass=1:2",
            "--out",
            folder.text(),
        ]),
        "is not KEY=FROM:TO:N",
    );
    for arguments in [
        vec!["sweep", ROBOT, "--out", folder.text()],
        vec!["sweep", ROBOT, "--vary", MASSES],
        vec![
            "sweep",
            ROBOT,
            "--vary",
            MASSES,
            "--out",
            folder.text(),
            "--shard",
            "3/2",
        ],
        vec![
            "sweep",
            ROBOT,
            "--vary",
            MASSES,
            "--out",
            folder.text(),
            "--threads",
            "0",
        ],
    ] {
        assert_eq!(pfaff(&arguments).status.code(), Some(2), "{arguments:?}");
    }
}
