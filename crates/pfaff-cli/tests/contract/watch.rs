//! Tests `pfaff check --watch`: a result for each change, and an end that does not count as a
//! failure.

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use super::{Folder, pfaff, stderr, stdout};

/// Time limit for one check, longer than any machine needs.
const PATIENCE: Duration = Duration::from_secs(60);

/// Reads lines until one contains this text.
fn until(lines: &Receiver<String>, words: &str) -> String {
    let mut seen = String::new();
    loop {
        let line = lines
            .recv_timeout(PATIENCE)
            .unwrap_or_else(|e| panic!("{e}: {words} after {seen}"));
        seen.push_str(&line);
        seen.push('\n');
        if line.contains(words) {
            return seen;
        }
    }
}

#[test]
fn each_change_is_checked_until_somebody_stops_it() {
    let folder = Folder::new("watch");
    fs::create_dir_all(&folder.0).expect("writable");
    let file = folder.0.join("scene.toml");
    let right = "scene = { name = \"stone\", space = \"plane\" }\nbody = [{ name = \"stone\", mass = 1.0, inertia = 1.0 }]\n";
    fs::write(&file, right).expect("writable");
    let mut child = Command::new(env!("CARGO_BIN_EXE_pfaff"))
        .args(["check", "--watch"])
        .arg(&file)
        .stdout(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let out = BufReader::new(child.stdout.take().expect("piped"));
    let (send, lines) = channel();
    thread::spawn(move || {
        for line in out.lines().map_while(Result::ok) {
            if send.send(line).is_err() {
                return;
            }
        }
    });
    let separator = format!("──── {} ────", file.display());
    let first = until(&lines, "assembled");
    assert!(
        first.starts_with(&format!("{separator}\nstone: 1 body")),
        "{first}"
    );

    fs::write(&file, right.replace("mass = 1.0", "mass = -10.0")).expect("writable");
    let second = until(&lines, "mass is -10, need a number");
    assert!(second.starts_with(&separator), "{second}");
    assert!(
        !second.contains('\u{1b}'),
        "colours are for terminals: {second}"
    );

    fs::remove_file(&file).expect("removable");
    until(&lines, "error[P0002]: cannot read");
    fs::write(&file, right).expect("writable");
    until(&lines, "assembled");

    if !cfg!(unix) {
        // On this system a test cannot press Ctrl-C.
        child.kill().expect("it runs");
        child.wait().expect("ends");
        return;
    }
    let id = child.id().to_string();
    let asked = Command::new("kill")
        .args(["-INT", &id])
        .status()
        .expect("kill");
    assert!(asked.success());
    assert_eq!(child.wait().expect("ends").code(), Some(0));
}

#[test]
fn what_cannot_be_watched_is_refused() {
    for (arguments, message) in [
        (
            &["check", "-", "--watch"][..],
            "--watch looks at a file again and again; standard input comes once",
        ),
        (
            &["check", "no-such.toml", "--watch"],
            "cannot read `no-such.toml`",
        ),
        (
            &["check", "x.toml", "--watch", "--json"],
            "cannot be used with '--json'",
        ),
    ] {
        let output = pfaff(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        // With `--json` an error is a document.
        let said = if arguments.contains(&"--json") {
            stdout(&output)
        } else {
            stderr(&output)
        };
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
}
