//! Tests `sweep`: its tables, its shards, its errors, and that no finished run is lost or repeated,
//! however its process ends.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use pfaff::report::sweep::digest;
use serde_json::Value;

use super::bad_input::PENDULUM;
use super::{Folder, ROBOT, pfaff, stderr, stdout, with_scene};

/// The documented first columns; the columns of bodies and reactions follow.
const COLUMNS: &str = "status,error,method,t,steps,rejected,evaluations,projections,events,rank,redundancy,not_unique,fragile,seconds,\
max_position_residual,max_velocity_residual,energy_balance,start_correction,start_velocity_correction,t_state,";

/// Masses of the platform of the robot: enough values that a sweep can be stopped while it runs.
const MASSES: &str = "body.platform.mass=10:40:24";

/// Time limit for an event that must occur.
const PATIENCE: Duration = Duration::from_secs(120);

/// Returns a table, header included, cell by cell.
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

/// Returns the same table without the run times.
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

/// Returns lines of finished runs in the files of the folder `shards` with this ending, by run.
fn lines(folder: &Folder, ending: &str) -> BTreeMap<usize, String> {
    let entries = fs::read_dir(folder.0.join("shards")).into_iter().flatten();
    let paths = entries.map(|entry| entry.expect("readable").path());
    let mut all = BTreeMap::new();
    for path in paths.filter(|path| path.to_string_lossy().ends_with(ending)) {
        let text = fs::read_to_string(&path).unwrap_or_default();
        let whole = text
            .split_inclusive('\n')
            .filter_map(|line| line.strip_suffix('\n'));
        for (_, row) in whole.filter_map(|line| line.split_once(' ')) {
            if let Some(run) = row.split(',').next().and_then(|run| run.parse().ok()) {
                let before = all.insert(run, row.to_owned());
                assert!(before.is_none(), "run {run} was made twice");
            }
        }
    }
    all
}

/// Waits until journals contain this number of finished runs.
fn wait_for(folder: &Folder, runs: usize) {
    let begin = Instant::now();
    loop {
        let found = lines(folder, ".journal").len();
        if found >= runs {
            return;
        }
        assert!(begin.elapsed() < PATIENCE, "{found} runs");
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
    let mut kept = BTreeMap::new();
    for k in 1..=2 {
        let words = arguments(&killed, "2");
        let mut child = begun(&words.iter().map(String::as_str).collect::<Vec<_>>());
        wait_for(&killed, 4 * k);
        // After SIGKILL no code of the program runs.
        child.kill().expect("it runs");
        assert!(!child.wait().expect("it ends").success());
        let now = lines(&killed, ".journal");
        assert!(
            kept.iter().all(|(run, row)| now.get(run) == Some(row)),
            "a finished run was lost"
        );
        kept = now;
        assert!(kept.len() < 24, "it was too fast to be killed");
        // The line is incomplete, as after a power failure.
        for entry in fs::read_dir(killed.0.join("shards")).expect("begun") {
            let path = entry.expect("readable").path();
            if path.extension().is_some_and(|ending| ending == "journal") {
                let mut bytes = fs::read(&path).expect("readable");
                bytes.extend_from_slice(b"0123456789abcdef 1,2.5,do");
                fs::write(&path, &bytes).expect("writable");
            }
        }
    }
    assert_eq!(run(&killed, "2").status.code(), Some(0));
    assert_eq!(lines(&killed, ".journal").len(), 0);
    let sealed = lines(&killed, ".rows");
    assert_eq!(sealed.len(), 24);
    assert!(
        // The run times are also equal.
        kept.iter().all(|(run, row)| sealed.get(run) == Some(row)),
        "a finished run was made again"
    );
    assert_eq!(run(&whole, "1").status.code(), Some(0));
    assert_eq!(table(&killed), table(&whole));
    // A third call finds no unfinished run.
    assert_eq!(run(&killed, "1").status.code(), Some(0));
    assert_eq!(lines(&killed, ".rows"), sealed);
    assert_eq!(summary(&killed)["repeated"], 0);
}

#[test]
fn the_same_shard_in_two_processes_is_harmless() {
    let [twice, whole] = ["sweep-twice", "sweep-once"].map(Folder::new);
    let words = |folder| {
        [
            "sweep",
            ROBOT,
            "--vary",
            MASSES,
            "--shard",
            "1/2",
            "--threads",
            "1",
            "--out",
            folder,
        ]
    };
    let children = [0, 1].map(|_| begun(&words(twice.text())));
    for child in children {
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let text = stdout(&output);
        assert!(
            text.contains("shard 1/2 of 24 runs: 12 of 12 runs: 12 done"),
            "{text}"
        );
    }
    assert!(!twice.0.join("sweep.csv").exists());
    assert_eq!(lines(&twice, ".rows").len(), 12);
    let rest = ["sweep", ROBOT, "--vary", MASSES, "--out", twice.text()];
    assert_eq!(pfaff(&rest).status.code(), Some(0));
    let all = ["sweep", ROBOT, "--vary", MASSES, "--out", whole.text()];
    assert_eq!(pfaff(&all).status.code(), Some(0));
    assert_eq!(table(&twice), table(&whole));
}

/// There are two hundred shards, and a hundred of them are finished; a repeated run would have
/// another time.
#[test]
fn shards_that_are_finished_are_not_made_again() {
    let [folder, whole] = ["sweep-resumed", "sweep-in-one"].map(Folder::new);
    let sweep = |folder: &Folder, more: &[&str]| {
        let vary = "body.bob.mass=1:3:400";
        let words = [
            "sweep",
            "-",
            "--vary",
            vary,
            "--set",
            "simulate.t_end=0.01",
            "--out",
            folder.text(),
        ];
        with_scene(&[&words[..], more].concat(), PENDULUM)
    };
    let shards = |folder: &Folder, of: std::ops::RangeInclusive<usize>| {
        for k in of {
            let output = sweep(folder, &["--shard", &format!("{k}/200")]);
            assert_eq!(output.status.code(), Some(0), "{output:?}");
        }
    };
    shards(&folder, 1..=100);
    let before = lines(&folder, ".rows");
    assert_eq!(before.len(), 200);
    let merged = Folder::new("sweep-half");
    let output = pfaff(&["sweep", "--merge", folder.text(), "--out", merged.text()]);
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("runs 201-400 are missing: `--shard 101/200`, `--shard 102/200`"),
        "{text}"
    );
    assert!(text.contains("and 90 more"), "{text}");
    shards(&folder, 1..=200);
    let after = lines(&folder, ".rows");
    assert_eq!(after.len(), 400);
    assert!(before.iter().all(|(run, row)| after.get(run) == Some(row)));
    // The last one has written the tables.
    assert_eq!(sweep(&whole, &[]).status.code(), Some(0));
    assert_eq!(table(&folder), table(&whole));
    assert_eq!(summary(&folder)["finished"], 400);
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
    wait_for(&folder, 2);
    let interrupt = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(interrupt.is_ok_and(|status| status.success()));
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(
        (output.status.code(), stderr(&output).as_str()),
        (Some(1), "")
    );
    let mut document: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
    // The file is the same for any process that performed the runs; the reason why this command
    // performed no more runs is its own.
    let reason = document
        .as_object_mut()
        .map(|d| [d.remove("code"), d.remove("error")]);
    let [code, error] = reason.expect("an object");
    assert_eq!(code, Some(Value::from("P0008")));
    assert!(error.is_some_and(|error| error.as_str().is_some_and(|e| e.contains("resumes"))));
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
    assert_eq!(document["crashed"], 0);
    // The process ended on request, so that no run counts as the cause.
    let entries = fs::read_dir(folder.0.join("shards")).expect("begun");
    let paths = entries.map(|entry| entry.expect("readable").path());
    let journals: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "journal"))
        .collect();
    assert_eq!(journals.len(), 1);
    let text = fs::read_to_string(&journals[0]).expect("readable");
    assert!(text.lines().any(|line| line.ends_with(" end")), "{text}");
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
    for (folder, shard, runs) in [(&one, "1/2", 2), (&two, "2/2", 3)] {
        let output = sweep(folder, &["--shard", shard]);
        assert_eq!(output.status.code(), Some(0));
        let expected = format!(
            "shard {shard} of 5 runs: {runs} of {runs} runs: {runs} done, 0 stopped, 0 rejected\nkept in {}",
            folder.text()
        );
        assert!(stdout(&output).contains(&expected), "{}", stdout(&output));
        assert!(!folder.0.join("sweep.csv").exists());
        let part = File::open(folder.0.join(format!(
            "shards/{}.parquet",
            if runs == 2 { "1-2" } else { "3-5" }
        )));
        let part = SerializedFileReader::new(part.expect("a part")).expect("Parquet");
        assert_eq!(part.metadata().file_metadata().num_rows(), runs);
    }
    let missing = Folder::new("sweep-missing");
    let output = pfaff(&["sweep", "--merge", one.text(), "--out", missing.text()]);
    assert_eq!(output.status.code(), Some(1));
    let text = stdout(&output);
    assert!(text.contains("2 of 5 runs"), "{text}");
    assert!(
        text.contains("runs 3-5 are missing: `--shard 2/2`"),
        "{text}"
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
    // The same run with a different result.
    let path = two.0.join("shards/3-5.rows");
    let three = lines(&two, ".rows")[&3].clone();
    let changed = three.replacen("done", "done ", 1);
    let other = Folder::new("sweep-other");
    fs::create_dir_all(other.0.join("shards")).expect("writable");
    fs::copy(two.0.join("shards/plan"), other.0.join("shards/plan")).expect("writable");
    let line = |text: &str| format!("{:016x} {text}\n", digest(text.as_bytes()));
    let text = fs::read_to_string(&path).expect("readable");
    let head = text.lines().next().expect("a line");
    fs::write(
        other.0.join("shards/3-5.rows"),
        format!("{head}\n{}", line(&changed)),
    )
    .expect("writable");
    let output = pfaff(&[
        "sweep",
        "--merge",
        two.text(),
        other.text(),
        "--out",
        missing.text(),
    ]);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(
        text.starts_with(
            "error[P0509]: run 3 was performed twice, with different results: `status` is \"done\" in"
        ),
        "{text}"
    );
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

/// The script of the book runs with the variables that Slurm sets and fewer runs.
#[cfg(unix)]
#[test]
fn the_script_for_slurm_makes_the_sweep() {
    let [folder, whole] = ["sweep-slurm", "sweep-no-slurm"].map(Folder::new);
    let book = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/book/clusters.md");
    let page = fs::read_to_string(book).expect("readable");
    let script = page
        .split("```sh\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next());
    let script = script.expect("a script");
    for (text, count) in [
        ("#SBATCH --array=1-200\n", 1),
        ("/200\"", 1),
        (":50000", 1),
        ("cart", 2),
    ] {
        assert_eq!(script.matches(text).count(), count, "{text}");
    }
    let script = script
        .replace("/200", "/3")
        .replace(":50000", ":7")
        .replace("body.cart", "body.bob");
    fs::create_dir_all(&folder.0).expect("writable");
    fs::write(folder.0.join("cart.toml"), PENDULUM).expect("writable");
    fs::write(folder.0.join("sweep.sh"), script).expect("writable");
    let command = std::path::Path::new(env!("CARGO_BIN_EXE_pfaff"));
    let path = std::env::join_paths(
        command
            .parent()
            .map(std::path::Path::to_owned)
            .into_iter()
            .chain(std::env::split_paths(
                &std::env::var_os("PATH").unwrap_or_default(),
            )),
    );
    let path = path.expect("a path");
    // The order is arbitrary; the second shard is performed twice, as after the loss of a machine.
    for (k, last) in [("3", false), ("2", false), ("2", false), ("1", true)] {
        let output = Command::new("sh")
            .arg("sweep.sh")
            .current_dir(&folder.0)
            .env("PATH", &path)
            .env("SLURM_ARRAY_TASK_ID", k)
            .env("SLURM_ARRAY_TASK_COUNT", "4711")
            .env("SLURM_CPUS_PER_TASK", "1")
            .output()
            .expect("a shell");
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        assert_eq!(
            stdout(&output).contains("tables written to masses"),
            last,
            "{output:?}"
        );
    }
    let words = [
        "sweep",
        "-",
        "--vary",
        "body.bob.mass=5:20:7",
        "--out",
        whole.text(),
    ];
    assert_eq!(with_scene(&words, PENDULUM).status.code(), Some(0));
    assert_eq!(table(&Folder(folder.0.join("masses"))), table(&whole));
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
        ("body.bob.mass=-1,-2", "all 2 runs fail at the start"),
    ] {
        refused(&sweep(PENDULUM, vary), piece);
    }
    // A scene that is invalid without any variation is reported with its position.
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
        "does not contain a sweep",
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

#[test]
fn runs_are_read_within_the_tolerance_of_the_command() {
    // A second pivot is 10 µm away from the first one: with exact data the bar cannot turn.
    let bar = r#"
scene = { name = "bar", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "bar", mass = 1.0, inertia = 1.0, position = [1.0, 0.0] }]
joint = [
    { name = "pivot", type = "revolute", bodies = ["ground", "bar"], at = [0.0, 0.0] },
    { name = "twin", type = "revolute", bodies = ["ground", "bar"], at = [1e-5, 0.0] },
]
simulate = { t_end = 0.1 }
"#;
    let [exact, within] = ["sweep-exact", "sweep-within"].map(Folder::new);
    let sweep = |folder: &Folder, more: &[&str]| {
        let words = ["sweep", "-", "--vary", "body.bar.mass=1,2", "--out"];
        let words: Vec<&str> = words
            .iter()
            .chain(&[folder.text()])
            .chain(more)
            .copied()
            .collect();
        with_scene(&words, bar)
    };
    let redundancies = |folder: &Folder| -> Vec<String> {
        let table = table(folder);
        let place = table[0].iter().position(|name| name == "redundancy");
        let place = place.expect("a column");
        table[1..].iter().map(|row| row[place].clone()).collect()
    };
    let output = sweep(&exact, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(redundancies(&exact), ["1", "1"]);
    let output = sweep(&within, &["--tolerance", "0.1mm"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(redundancies(&within), ["2", "2"]);
    // This is a different sweep.
    let output = sweep(&exact, &["--tolerance", "0.1mm"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("belongs to another sweep"));
}
