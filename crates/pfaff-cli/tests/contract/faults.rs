//! Tests faults of the environment: closed output, full disk, read-only directory, request to stop.
//! Computed results are kept and readable, and files with final names are complete. Older results
//! are kept until newer ones are complete.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::bad_input::PENDULUM;
use super::{Folder, ROBOT, pfaff, stderr, stdout};

/// Time limit for an event that must occur.
const PATIENCE: Duration = Duration::from_secs(120);

/// Longest time from a request to the end of the command.
const AT_ONCE: Duration = Duration::from_secs(1);

/// Creates a directory with the scene of a pendulum, which runs up to `t_end`.
fn place(name: &str, t_end: &str) -> (Folder, String) {
    let folder = Folder::new(name);
    fs::create_dir_all(&folder.0).expect("writable");
    let scene = folder.0.join("pendulum.toml");
    let text = PENDULUM.replace(
        "t_end = 1.0",
        &format!("t_end = {t_end}\noutput_step = 0.01"),
    );
    fs::write(&scene, text).expect("writable");
    let scene = scene.to_str().expect("UTF-8").to_owned();
    (folder, scene)
}

/// Returns every command that prints, with its arguments.
fn commands<'a>(scene: &'a str, out: &'a str) -> Vec<Vec<&'a str>> {
    vec![
        vec!["--help"],
        vec!["--version"],
        vec!["analyze", "--help"],
        vec!["check", scene],
        vec!["check", scene, "--json"],
        vec!["analyze", scene],
        vec!["analyze", scene, "--json"],
        vec!["analyze", scene, "--along"],
        vec!["plan", scene],
        vec!["plan", scene, "--json"],
        vec!["simulate", scene, "--out", out],
        vec!["simulate", scene, "--out", out, "--json"],
        vec!["sweep", scene, "--vary", "body.bob.mass=1,2", "--out", out],
        vec![
            "sweep",
            scene,
            "--vary",
            "body.bob.mass=1,2",
            "--out",
            out,
            "--json",
        ],
    ]
}

fn begun(arguments: &[&str], output: Stdio) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pfaff"));
    command
        .args(arguments)
        .stdout(output)
        .stderr(Stdio::piped());
    command.spawn().expect("the command starts")
}

/// Waits for a condition; the panic message names it.
#[track_caller]
fn wait_until(what: &str, mut is_true: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !is_true() {
        assert!(begin.elapsed() < PATIENCE, "{what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Runs the command under a limit of the shell: of the size of files (then no signal ends it), or
/// of memory.
pub(crate) fn with_limit(limit: &str, arguments: &[&str]) -> Output {
    let script = format!("trap '' XFSZ; ulimit {limit}; exec \"$0\" \"$@\"");
    let mut command = Command::new("sh");
    command.args(["-c", &script, env!("CARGO_BIN_EXE_pfaff")]);
    command.args(arguments).output().expect("it starts")
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status();
    assert!(sent.is_ok_and(|status| status.success()));
}

/// Checks that every row of a table has as many values as the header has names; returns the number
/// of rows and the first value of the last row.
fn rows(path: &Path) -> (usize, f64) {
    let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert!(
        text.ends_with('\n'),
        "the last row is not whole: {:?}",
        text.lines().last()
    );
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let (mut count, mut last) = (0, f64::NAN);
    for row in reader.records() {
        let row = row.expect("as long as the header");
        let numbers: Vec<f64> = row.iter().map(|x| x.parse().expect("a number")).collect();
        (count, last) = (count + 1, numbers[0]);
    }
    (count, last)
}

/// Returns names and contents of a directory.
fn contents(folder: &Folder) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(&folder.0).expect("readable").flatten();
    let mut files: Vec<_> = entries
        .map(|e| {
            (
                e.file_name().to_string_lossy().into_owned(),
                fs::read(e.path()).unwrap_or_default(),
            )
        })
        .collect();
    files.sort();
    files
}

#[test]
fn nobody_has_to_listen_to_the_end() {
    let (folder, scene) = place("faults-closed", "1.0");
    let out = folder.0.join("out");
    for command in commands(&scene, out.to_str().expect("UTF-8")) {
        let mut child = begun(&command, Stdio::piped());
        // The test corresponds to `| head -1`, but the pipe is closed before the first output.
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(
            (output.status.code(), stderr(&output).as_str()),
            (Some(0), ""),
            "{command:?}"
        );
    }
    let mut child = begun(&["plan", &scene], Stdio::piped());
    let mut line = String::new();
    BufReader::new(child.stdout.take().expect("piped"))
        .read_line(&mut line)
        .expect("a line");
    assert!(line.starts_with("pendulum"), "{line}");
    assert_eq!(child.wait().expect("it ends").code(), Some(0));
    // Invalid input is still reported as invalid.
    let mut child = begun(&["check", "no-such-file.toml", "--json"], Stdio::piped());
    drop(child.stdout.take());
    assert_eq!(child.wait().expect("it ends").code(), Some(2));
}

#[test]
fn an_output_that_takes_nothing_is_named() {
    let (folder, scene) = place("faults-full-output", "1.0");
    let out = folder.0.join("out");
    for command in commands(&scene, out.to_str().expect("UTF-8")) {
        let full = File::options()
            .write(true)
            .open("/dev/full")
            .expect("Linux has it");
        let output = begun(&command, full.into())
            .wait_with_output()
            .expect("it ends");
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{command:?}: {text}");
        assert!(
            text.starts_with("error[P0006]: cannot write to standard output: No space"),
            "{command:?}: {text}"
        );
    }
}

#[test]
fn a_full_disk_leaves_older_results_alone() {
    let (folder, scene) = place("faults-full", "1.0");
    let out = Folder(folder.0.join("out"));
    let simulate = ["simulate", &scene, "--out", out.text()];
    assert_eq!(pfaff(&simulate).status.code(), Some(0));
    let before = contents(&out);
    assert_eq!(before.len(), 4);
    // Each of its files reaches the full disk when the first bytes are written.
    for (name, output) in [
        ("trajectory.csv", "reactions = false"),
        ("reactions.csv", "trajectory = false"),
        ("summary.json", "trajectory = false\nreactions = false"),
    ] {
        let text = fs::read_to_string(&scene).expect("readable");
        let other = folder.0.join("other.toml");
        fs::write(&other, format!("{text}\n[output]\n{output}\n")).expect("writable");
        let other = other.to_str().expect("UTF-8");
        let output = with_limit("-f 0", &["simulate", other, "--out", out.text()]);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(
            text.contains(&format!("{name}.part`: File too large")),
            "{text}"
        );
        let whole: Vec<_> = contents(&out)
            .into_iter()
            .filter(|(name, _)| !name.ends_with(".part"))
            .collect();
        assert_eq!(whole, before, "after {name}");
    }
    // Files that remain from an earlier run cause no error.
    fs::write(out.0.join("trajectory.csv.part"), "half a li").expect("writable");
    assert_eq!(pfaff(&simulate).status.code(), Some(0));
    let names: Vec<_> = contents(&out).into_iter().map(|(name, _)| name).collect();
    let files = [
        "reactions.csv",
        "report.html",
        "summary.json",
        "trajectory.csv",
    ];
    assert_eq!(names, files);
}

#[test]
fn a_disk_that_fills_up_leaves_whole_rows() {
    let (folder, scene) = place("faults-filling", "10.0");
    let out = Folder(folder.0.join("out"));
    // The limit is at most 8 blocks of 512 or 1024 bytes for each file.
    let output = with_limit("-f 8", &["simulate", &scene, "--out", out.text()]);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains(".csv.part`: File too large"), "{text}");
    // No file has a final name unless it is complete, and the existing files are readable.
    let names: Vec<_> = contents(&out).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["reactions.csv.part", "trajectory.csv.part"]);
    let (count, t) = rows(&out.0.join("trajectory.csv.part"));
    assert!(count > 10 && t < 10.0, "{count} rows to {t} s");
}

#[test]
fn a_sweep_without_a_disk_says_so_and_goes_on_later() {
    let (folder, scene) = place("faults-sweep", "0.1");
    let out = Folder(folder.0.join("out"));
    let sweep = [
        "sweep",
        &scene,
        "--vary",
        "body.bob.mass=1:3:3",
        "--out",
        out.text(),
    ];
    // The plan cannot be written.
    let output = with_limit("-f 0", &sweep);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("shards/plan`: File too large"), "{text}");
    assert_eq!(pfaff(&sweep).status.code(), Some(0));
    let before = contents(&out);
    // All runs are in the journal; the first table cannot be written.
    let output = with_limit("-f 0", &sweep);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("out/sweep.csv."), "{text}");
    assert!(text.contains(".part`: File too large"), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    let whole: Vec<_> = contents(&out)
        .into_iter()
        .filter(|(name, _)| !name.ends_with(".part"))
        .collect();
    assert_eq!(whole, before);
    // The path of the summary is occupied by another object.
    let path = out.0.join("summary.json");
    fs::remove_file(&path).expect("removable");
    fs::create_dir(&path).expect("writable");
    let output = pfaff(&[&sweep[..], &["--force"]].concat());
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("summary.json"), "{text}");
    fs::remove_dir(&path).expect("removable");
    assert_eq!(pfaff(&sweep).status.code(), Some(0));
    assert_eq!(out.read("sweep.csv").lines().count(), 4);
}

#[test]
fn places_that_take_no_files_are_named() {
    let (folder, scene) = place("faults-places", "0.1");
    let file = folder.0.join("file");
    fs::write(&file, "here first").expect("writable");
    let inside = file.join("deeper");
    // No user, not even root, can create files in /proc.
    for out in [
        file.to_str(),
        inside.to_str(),
        Some("/proc/results"),
        Some("/proc"),
    ] {
        let out = out.expect("UTF-8");
        for mut command in [
            vec!["simulate", &scene],
            vec!["sweep", &scene, "--vary", "body.bob.mass=1,2"],
            vec!["work-precision", &scene, "--quick"],
        ] {
            command.extend(["--out", out]);
            let output = pfaff(&command);
            let text = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{command:?}: {text}");
            assert!(
                text.starts_with("error[P0003]: cannot ") && text.contains(out),
                "{text}"
            );
            assert_eq!(text.lines().count(), 1, "{text}");
        }
    }
    assert_eq!(fs::read_to_string(file).expect("still there"), "here first");
}

#[test]
fn an_interrupted_run_keeps_what_it_has() {
    for signal in ["-INT", "-TERM", "-HUP"] {
        let (folder, scene) = place(&format!("faults-interrupted{signal}"), "50000.0");
        let out = Folder(folder.0.join("out"));
        let child = begun(
            &["simulate", &scene, "--out", out.text(), "--json"],
            Stdio::piped(),
        );
        let part = out.0.join("trajectory.csv.part");
        wait_until("rows are written", || {
            fs::metadata(&part).is_ok_and(|m| m.len() > 100_000)
        });
        send(signal, &child);
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(
            (output.status.code(), stderr(&output).as_str()),
            (Some(1), "")
        );
        let summary: Value = serde_json::from_str(&out.read("summary.json")).expect("JSON");
        assert_eq!(summary["partial"], true);
        assert_eq!(
            serde_json::from_str::<Value>(&stdout(&output)).expect("JSON"),
            summary
        );
        let (count, t) = rows(&out.0.join("trajectory.csv"));
        assert!(count > 100 && t < 50_000.0);
        assert_eq!(rows(&out.0.join("reactions.csv")), (count, t));
        assert!(!part.exists());
    }
}

#[test]
fn an_interrupted_run_is_not_done_because_nobody_listens() {
    let (folder, scene) = place("faults-interrupted-closed", "50000.0");
    let out = Folder(folder.0.join("out"));
    let mut child = begun(&["simulate", &scene, "--out", out.text()], Stdio::piped());
    drop(child.stdout.take());
    let part = out.0.join("trajectory.csv.part");
    wait_until("rows are written", || {
        fs::metadata(&part).is_ok_and(|m| m.len() > 100_000)
    });
    send("-INT", &child);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(
        (output.status.code(), stderr(&output).as_str()),
        (Some(1), "")
    );
}

#[test]
fn a_second_request_ends_the_program_at_once() {
    let (folder, scene) = place("faults-second", "50000.0");
    let out = Folder(folder.0.join("out"));
    fs::create_dir_all(&out.0).expect("writable");
    let part = out.0.join("trajectory.csv.part");
    let mut child = begun(
        &["simulate", &scene, "--out", out.text(), "--json"],
        Stdio::piped(),
    );
    wait_until("rows are written", || {
        fs::metadata(&part).is_ok_and(|m| m.len() > 100_000)
    });
    // The second signal arrives while the command completes its files, or has already ended.
    send("-INT", &child);
    send("-INT", &child);
    let begin = Instant::now();
    child.wait().expect("it ends");
    assert!(begin.elapsed() < AT_ONCE, "{:?}", begin.elapsed());
    let summary: Value = serde_json::from_str(&out.read("summary.json")).expect("JSON");
    assert_eq!(summary["partial"], true);
    assert!(rows(&out.0.join("trajectory.csv")).0 > 100);
}

#[track_caller]
fn wait_until_it_listens(child: &Child) {
    let state = format!("/proc/{}/status", child.id());
    // Bit 1 of the mask of caught signals is SIGINT.
    wait_until("it listens", || {
        let text = fs::read_to_string(&state).unwrap_or_default();
        let mask = text.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        mask.and_then(|m| u64::from_str_radix(m.trim(), 16).ok())
            .is_some_and(|m| m & 2 != 0)
    });
}

#[test]
fn an_interrupted_import_writes_nothing() {
    let folder = Folder::new("faults-import");
    fs::create_dir_all(&folder.0).expect("writable");
    let out = folder.0.join("scene.toml").display().to_string();
    for signal in ["-INT", "-TERM", "-HUP"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pfaff"));
        command.args(["import", "-", "--out", &out, "--json"]);
        // The command waits for the rest of its input.
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("the command starts");
        let input = child.stdin.take();
        wait_until_it_listens(&child);
        send(signal, &child);
        let output = child.wait_with_output().expect("it ends");
        drop(input);
        assert_eq!(output.status.code(), Some(1), "{signal}");
        let document: Value = serde_json::from_slice(&output.stdout).expect("one document");
        assert_eq!(document["code"], "P0008");
        assert_eq!(document["error"], "interrupted; nothing was written");
        assert_eq!(contents(&folder).len(), 0);
    }
}

#[test]
fn what_has_nothing_to_keep_ends_at_once() {
    // The motion takes several days, with verdicts along it.
    let (_folder, scene) = place("faults-along", "50000.0");
    let mut child = begun(&["analyze", &scene, "--along"], Stdio::piped());
    wait_until_it_listens(&child);
    send("-INT", &child);
    assert_eq!(child.wait().expect("it ends").code(), Some(1));
}

#[test]
fn a_killed_run_leaves_nothing_that_looks_whole() {
    let (folder, scene) = place("faults-killed", "50000.0");
    let out = Folder(folder.0.join("out"));
    let short = ["simulate", &scene, "--t-end", "0.5", "--out", out.text()];
    assert_eq!(pfaff(&short).status.code(), Some(0));
    let before = contents(&out);
    let mut child = begun(&["simulate", &scene, "--out", out.text()], Stdio::piped());
    let part = out.0.join("trajectory.csv.part");
    wait_until("rows are written", || {
        fs::metadata(&part).is_ok_and(|m| m.len() > 100_000)
    });
    child.kill().expect("it runs");
    child.wait().expect("it ends");
    let names: Vec<_> = contents(&out)
        .into_iter()
        .filter(|(name, _)| !name.ends_with(".part"))
        .collect();
    assert_eq!(names, before);
    // The same command again replaces the remaining files.
    assert_eq!(pfaff(&short).status.code(), Some(0));
    assert!(
        contents(&out)
            .iter()
            .all(|(name, _)| !name.ends_with(".part"))
    );
}

#[test]
fn an_interrupted_comparison_keeps_its_rows() {
    let folder = Folder::new("faults-comparison");
    let child = begun(
        &[
            "work-precision",
            ROBOT,
            "--all",
            "--out",
            folder.text(),
            "--json",
        ],
        Stdio::piped(),
    );
    // The directory is created before the first run. Some runs finish within three seconds, also on
    // a busy machine; all runs take longer.
    wait_until("it has begun", || folder.0.exists());
    std::thread::sleep(Duration::from_secs(3));
    send("-INT", &child);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(
        (output.status.code(), stderr(&output).as_str()),
        (Some(1), "")
    );
    let document: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
    assert_eq!(document["partial"], true);
    let text = folder.read("work_precision.csv");
    assert!(text.ends_with('\n') && text.lines().count() > 1);
    assert!(folder.read("report.html").ends_with("</html>\n"));
}

#[test]
fn two_runs_exclude_each_other_and_a_killed_one_is_no_obstacle() {
    let (folder, scene) = place("faults-two", "50000.0");
    let out = Folder(folder.0.join("out"));
    let short = ["simulate", &scene, "--t-end", "0.5", "--out", out.text()];
    let mut first = begun(&["simulate", &scene, "--out", out.text()], Stdio::piped());
    let part = out.0.join("trajectory.csv.part");
    wait_until("rows are written", || {
        fs::metadata(&part).is_ok_and(|m| m.len() > 100_000)
    });
    for other in [
        &short[..],
        &["work-precision", &scene, "--quick", "--out", out.text()],
        &[
            "sweep",
            &scene,
            "--vary",
            "body.bob.mass=1,2",
            "--out",
            out.text(),
        ],
    ] {
        let second = pfaff(other);
        let text = stderr(&second);
        assert_eq!(second.status.code(), Some(1), "{text}");
        assert!(
            text.starts_with("error[P0005]: another run of pfaff"),
            "{text}"
        );
        assert!(text.contains(out.text()), "{text}");
    }
    first.kill().expect("it runs");
    first.wait().expect("it ends");
    assert_eq!(pfaff(&short).status.code(), Some(0));
    assert_eq!(contents(&out).len(), 4);
}

#[test]
fn files_of_others_are_replaced_by_force_only() {
    let (folder, scene) = place("faults-foreign", "0.1");
    let out = Folder(folder.0.join("out"));
    fs::create_dir_all(&out.0).expect("writable");
    let mine = out.0.join("report.html");
    fs::write(&mine, "<html>mine</html>").expect("writable");
    let simulate = ["simulate", &scene, "--out", out.text()];
    let output = pfaff(&simulate);
    assert_eq!(output.status.code(), Some(2));
    let text = stderr(&output);
    assert!(text.starts_with("error[P0004]: "), "{text}");
    assert!(
        text.contains("report.html") && text.contains("--force"),
        "{text}"
    );
    assert_eq!(contents(&out).len(), 1);
    assert_eq!(
        pfaff(&[&simulate[..], &["--force"]].concat()).status.code(),
        Some(0)
    );
    assert!(out.read("report.html").ends_with("</html>\n"));
    // From now on the files belong to this command.
    assert_eq!(pfaff(&simulate).status.code(), Some(0));
    // A run that does not write tables removes those of the earlier run.
    let text = fs::read_to_string(&scene).expect("readable");
    fs::write(
        &scene,
        format!("{text}\n[output]\nreactions = false\nreport = false\n"),
    )
    .expect("writable");
    assert_eq!(pfaff(&simulate).status.code(), Some(0));
    let names: Vec<_> = contents(&out).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["summary.json", "trajectory.csv"]);
    let summary: Value = serde_json::from_str(&out.read("summary.json")).expect("JSON");
    assert_eq!(
        summary["files"],
        serde_json::json!(["trajectory.csv", "summary.json"])
    );
    // The page is in a different directory.
    let page = folder.0.join("page.html");
    fs::write(&page, "mine").expect("writable");
    let page = page.to_str().expect("UTF-8");
    let view = ["view", &scene, "--no-open", "--out", page];
    assert_eq!(pfaff(&view).status.code(), Some(2));
    assert_eq!(fs::read_to_string(page).expect("there"), "mine");
    assert_eq!(
        pfaff(&[&view[..], &["--force"]].concat()).status.code(),
        Some(0)
    );
    assert_eq!(pfaff(&view).status.code(), Some(0));
}

#[test]
fn a_run_of_one_row_is_interrupted() {
    one_row_interrupted("dop853");
}

#[test]
fn an_implicit_run_of_one_row_is_interrupted() {
    one_row_interrupted("radau5");
}

/// A run whose only output row is far away ends within a second after a signal.
fn one_row_interrupted(method: &str) {
    let (folder, scene) = place(&format!("faults-one-row-{method}"), "50000.0");
    let text = fs::read_to_string(&scene).expect("readable");
    fs::write(
        &scene,
        text.replace("output_step = 0.01", "output_step = 50000.0"),
    )
    .expect("writable");
    let out = Folder(folder.0.join("out"));
    let arguments = ["simulate", &scene, "--method", method, "--out", out.text()];
    let child = begun(&arguments, Stdio::piped());
    wait_until("it runs", || out.0.join("trajectory.csv.part").exists());
    std::thread::sleep(Duration::from_millis(200));
    let begin = Instant::now();
    send("-TERM", &child);
    let output = child.wait_with_output().expect("it ends");
    assert!(begin.elapsed() < AT_ONCE, "{:?}", begin.elapsed());
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&output);
    assert!(
        said.contains("interrupted at t = ") && said.contains("kept: 1 row in "),
        "{said}"
    );
}

#[test]
fn no_character_of_a_file_reaches_a_terminal_as_a_command() {
    let scene = PENDULUM.replace("\"bob\"", "\"b\u{202e}ob\u{7f}\"");
    for arguments in [&["check", "-"][..], &["check", "-", "--json"]] {
        let output = super::with_scene(arguments, &scene);
        let said = stdout(&output) + &stderr(&output);
        assert!(!said.is_empty());
        let obeyed = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
        assert!(!said.chars().any(obeyed), "{said:?}");
    }
}

/// Kills, interrupts and limits occur at random times: in every case, files with their final names
/// are complete and belong to one run.
fn mishaps(name: &str, count: u32) {
    let (folder, scene) = place(name, "50000.0");
    let out = Folder(folder.0.join("out"));
    let short = ["simulate", &scene, "--t-end", "0.5", "--out", out.text()];
    assert_eq!(pfaff(&short).status.code(), Some(0));
    // The random numbers come from Wichmann's multiplicative generator, so that the events are the
    // same each time.
    let mut seed: u64 = 171;
    for k in 0..count {
        seed = seed * 171 % 30_269;
        let wait = Duration::from_millis(seed % 60);
        let before = contents(&out);
        let whole = |all: &[(String, Vec<u8>)]| -> Vec<(String, Vec<u8>)> {
            let all = all.iter().filter(|(name, _)| !name.ends_with(".part"));
            all.cloned().collect()
        };
        if k % 3 == 2 {
            let blocks = format!("-f {}", seed % 40);
            let output = with_limit(&blocks, &["simulate", &scene, "--out", out.text()]);
            assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
            assert_eq!(whole(&contents(&out)), whole(&before), "{k}: a full disk");
            continue;
        }
        let mut child = begun(&["simulate", &scene, "--out", out.text()], Stdio::null());
        std::thread::sleep(wait);
        if k % 3 == 0 {
            child.kill().expect("it runs");
            child.wait().expect("it ends");
            assert_eq!(whole(&contents(&out)), whole(&before), "{k}: killed");
        } else {
            send("-INT", &child);
            // If interrupts are ignored until a handler exists, as in the background of a shell,
            // the first one may come too early.
            let mut sent = Instant::now();
            while child.try_wait().expect("it runs").is_none() {
                std::thread::sleep(Duration::from_millis(2));
                if sent.elapsed() > 2 * AT_ONCE {
                    send("-INT", &child);
                    sent = Instant::now();
                }
            }
            let summary: Value = serde_json::from_str(&out.read("summary.json")).expect("JSON");
            if whole(&contents(&out)) != whole(&before) {
                assert_eq!(summary["partial"], true, "{k}");
                let (count, t) = rows(&out.0.join("trajectory.csv"));
                assert_eq!(rows(&out.0.join("reactions.csv")), (count, t), "{k}");
                assert_eq!(summary["rows"], count, "{k}");
            }
        }
    }
    assert_eq!(pfaff(&short).status.code(), Some(0));
    assert_eq!(contents(&out).len(), 4);
}

#[test]
fn twenty_mishaps_lose_and_mix_nothing() {
    mishaps("faults-twenty", 20);
}

#[test]
#[ignore = "takes long"]
fn two_hundred_mishaps_lose_and_mix_nothing() {
    mishaps("faults-two-hundred", 200);
}
