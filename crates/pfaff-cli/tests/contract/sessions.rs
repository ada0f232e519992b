//! Recorded command lines as files: the typed commands, and the output of each.
//!
//! A session is `NAME.out` in `tests/answers` or `tests/wrong`. A line `$ pfaff …` is a command.
//! Below it there are its exit code as `? 2` if it is not 0, its standard output, and its standard
//! error with `! ` before each line. `$ cat FILE` and `$ ls FOLDER` show the files that commands
//! have written. Commands run in a new folder with the scenes that they name: scenes of
//! `examples/`, the published robot, or scenes in the folder of the session. `UPDATE=1` writes the
//! recorded output again; review the changes before each commit.
//!
//! Words are compared exactly, numbers to the accuracy that all processors share: see [`agree`].

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::{Folder, stderr, stdout};

const HERE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests");
const SCENES: [&str; 2] = [
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples"),
    concat!(env!("CARGO_MANIFEST_DIR"), "/../robot-trolley"),
];

/// Numbers that differ by less than this fraction are the same.
const SAME: f64 = 1e-6;

/// Numbers below this value are rounding errors of others, which are of order one in these scenes.
const SMALL: f64 = 1e-8;

/// Number of sessions that are run at the same time.
const AT_ONCE: usize = 4;

/// Ratios above this value have a rounding error in their denominator.
const HUGE: f64 = 1e9;

/// Returns the files with this ending in a folder, sorted by name.
fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let mut files: Vec<_> = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|end| end == ending))
        .collect();
    files.sort();
    files
}

/// Returns the words of a command line; quoted words may contain blanks.
fn words(command: &str) -> Vec<String> {
    let quoted = command.split('"').enumerate();
    quoted
        .flat_map(|(k, piece)| match k % 2 {
            0 => piece.split_whitespace().map(str::to_owned).collect(),
            _ => vec![piece.to_owned()],
        })
        .collect()
}

/// Returns the output of one command line.
fn answer(command: &str, folder: &Path) -> String {
    let words = words(command);
    let (program, arguments) = words.split_first().expect("a command");
    let path = || folder.join(&arguments[0]);
    let (code, out, err) = match &**program {
        "pfaff" => {
            let mut pfaff = Command::new(env!("CARGO_BIN_EXE_pfaff"));
            // Help texts are not wrapped to a width.
            pfaff.env("COLUMNS", "1000").args(arguments);
            let output = pfaff.current_dir(folder).output();
            let output = output.expect("the command starts");
            (output.status.code(), stdout(&output), stderr(&output))
        }
        "cat" => {
            let read = fs::read_to_string(path());
            (Some(0), read.unwrap_or_default(), String::new())
        }
        "ls" => {
            let entries = fs::read_dir(path()).expect("a folder").flatten();
            let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
            let mut names: Vec<String> = names.collect();
            names.sort();
            (Some(0), names.join("\n") + "\n", String::new())
        }
        other => panic!("`{other}` is no command of a session"),
    };
    let mut answer = String::new();
    if code != Some(0) {
        writeln!(answer, "? {code:?}").expect("memory takes everything");
    }
    let lines = out.lines().map(|line| ("", line));
    for (lead, line) in lines.chain(err.lines().map(|line| ("! ", line))) {
        let line = if cfg!(windows) {
            line.replace('\\', "/")
        } else {
            line.to_owned()
        };
        writeln!(answer, "{}", format!("{lead}{line}").trim_end()).expect("memory");
    }
    answer
}

/// Returns the session with the same commands and their present output.
fn played(session: &Path) -> String {
    let name = session.file_stem().expect("a name").to_string_lossy();
    let folder = Folder::new(&format!("session-{name}"));
    let beside = session.parent().expect("a folder").to_string_lossy();
    fs::create_dir_all(&folder.0).expect("writable");
    let text = fs::read_to_string(session).expect("readable");
    let commands = || text.lines().filter_map(|line| line.strip_prefix("$ "));
    for name in commands()
        .flat_map(words)
        .filter(|word| word.ends_with(".toml"))
    {
        let folders = SCENES.into_iter().chain([&*beside]);
        let mut scenes = folders.map(|folder| Path::new(folder).join(&name));
        if let Some(scene) = scenes.find(|scene| scene.exists()) {
            fs::copy(scene, folder.0.join(&name)).expect("writable");
        }
    }
    let mut played = String::new();
    for command in commands() {
        let answer = answer(command, &folder.0);
        writeln!(played, "$ {command}\n{answer}").expect("memory takes everything");
    }
    played
}

/// Splits a line into words and numbers, alternating.
fn parts(line: &str) -> impl Iterator<Item = (&str, Option<f64>)> {
    let mut rest = line;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let begin = rest
            .find(|c: char| c.is_ascii_digit())
            .unwrap_or(rest.len());
        let (words, number) = rest.split_at(begin);
        let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | '-' | '+');
        let mut end = number.find(|c| !is_of_number(c)).unwrap_or(number.len());
        // Finds the longest beginning that is a number: `1e-3.` is a number with a full stop.
        while end > 0 && number[..end].parse::<f64>().is_err() {
            end -= 1;
        }
        let (number, after) = number.split_at(end);
        rest = after;
        Some((words, number.parse().ok()))
    })
}

/// Whether two lines agree. Signs are part of the words before a number: they may differ if the
/// number is a rounding error.
fn agree(expected: &str, found: &str) -> bool {
    if expected == found {
        return true;
    }
    let same_number =
        |a: f64, b: f64| (a - b).abs() <= SAME * a.max(b) || a.max(b) <= SMALL || a.min(b) >= HUGE;
    let is_rounding = |a: Option<f64>| a.is_some_and(|a| a <= SMALL);
    let (mut expected, mut found) = (parts(expected), parts(found));
    loop {
        match (expected.next(), found.next()) {
            (None, None) => return true,
            (Some((words, a)), Some((other, b))) => {
                let same_words = words == other
                    || (is_rounding(a) && is_rounding(b))
                        && words.trim_end_matches(['-', '−']) == other.trim_end_matches(['-', '−']);
                let same = match (a, b) {
                    (Some(a), Some(b)) => same_number(a, b),
                    (a, b) => a.is_none() && b.is_none(),
                };
                if !same_words || !same {
                    return false;
                }
            }
            _ => return false,
        }
    }
}

/// Whether a line contains run times, which differ between runs.
fn is_run_time(line: &str) -> bool {
    line.contains("wall_seconds") || line.contains(" evaluations in ")
}

/// Returns the first line in which two sessions differ, with the command above it.
fn difference(expected: &str, found: &str) -> Option<String> {
    let mut command = "";
    let (mut expected, mut found) = (expected.lines(), found.lines());
    loop {
        let (old, new) = match (expected.next(), found.next()) {
            (None, None) => return None,
            (old, new) => (old.unwrap_or("(the end)"), new.unwrap_or("(the end)")),
        };
        if old.starts_with("$ ") {
            command = old;
        }
        let same = agree(old, new) || is_run_time(old) && is_run_time(new);
        if !same {
            return Some(format!("{command}\n  says       {new}\n  instead of {old}"));
        }
    }
}

fn compare(folder: &str) {
    let sessions = files(&format!("{HERE}/{folder}"), "out");
    assert!(sessions.len() >= 20, "{}", sessions.len());
    let differing = |session: &PathBuf| {
        let found = played(session);
        let expected = fs::read_to_string(session).expect("readable");
        let line = difference(&expected.replace("\r\n", "\n"), &found)?;
        // A session that differs only in run times is not changed.
        if std::env::var_os("UPDATE").is_some() {
            fs::write(session, &found).expect("writable");
            return None;
        }
        Some(format!("{}: {line}", session.display()))
    };
    let next = AtomicUsize::new(0);
    let work = || {
        let own = std::iter::from_fn(|| sessions.get(next.fetch_add(1, Ordering::Relaxed)));
        own.filter_map(differing).collect::<Vec<_>>()
    };
    let differing: Vec<String> = thread::scope(|scope| {
        let threads: Vec<_> = (0..AT_ONCE).map(|_| scope.spawn(work)).collect();
        let found = threads
            .into_iter()
            .map(|thread| thread.join().expect("an end"));
        found.flatten().collect()
    });
    assert!(
        differing.is_empty(),
        "UPDATE=1 writes the answers anew\n{}",
        differing.join("\n")
    );
}

#[test]
fn every_answer_is_that_of_its_session() {
    compare("answers");
}

#[test]
fn every_wrong_scene_has_its_text() {
    compare("wrong");
}

#[test]
fn every_scene_beside_sessions_is_asked_about() {
    for folder in ["answers", "wrong"] {
        for scene in files(&format!("{HERE}/{folder}"), "toml") {
            assert!(scene.with_extension("out").exists(), "{}", scene.display());
        }
    }
}

#[test]
fn numbers_agree_as_far_as_processors_do() {
    assert!(agree("x = 1.0000001 m", "x = 1.0000002 m"));
    assert!(!agree("x = 1.00001 m", "x = 1.00002 m"));
    assert!(!agree("x = 1.0 m", "x = -1.0 m"));
    assert!(agree("\"margin\": 3e-17,", "\"margin\": 0.0,"));
    assert!(agree("\"x\": -3e-17,", "\"x\": 0.0,"));
    assert!(agree("\"gap\": 3e15,", "\"gap\": 8e14,"));
    assert!(!agree("rank 3", "rank 4"));
    assert!(!agree("joint A", "joint B"));
    assert!(!agree("ends", "ends 1"));
}
