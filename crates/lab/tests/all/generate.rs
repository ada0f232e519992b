//! Tests of `lab generate`: scenes that the other commands can read, complete files or no file, and
//! clear errors.

use std::fs;

use serde_json::Value;

use super::{Folder, lab, pfaff, stderr, stdout};

const KINDS: [&str; 5] = ["n-four-bar", "parallelograms", "lattice", "fleet", "random"];

/// Creates an empty directory for one test.
fn place(name: &str) -> Folder {
    let folder = Folder::new(name);
    fs::create_dir_all(&folder.0).expect("writable");
    folder
}

/// Returns the names of the files of a directory.
fn names(folder: &Folder) -> Vec<String> {
    let entries = fs::read_dir(&folder.0).expect("readable").flatten();
    let mut names: Vec<_> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn what_is_generated_is_judged_as_its_head_says() {
    let folder = place("generate-judged");
    for kind in KINDS {
        let output = lab(&["generate", kind, "--n", "3"]);
        assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
        let scene = stdout(&output);
        let file = folder.0.join("scene.toml");
        fs::write(&file, &scene).expect("writable");
        let analysis = pfaff(&["analyze", file.to_str().expect("UTF-8"), "--json"]);
        let analysis: Value = serde_json::from_str(&analysis).expect("JSON");
        let number = |key: &str| analysis[key].as_u64().expect("a number");
        let known = format!(
            "{} rows, rank {}, redundancy {}, mobility {}.",
            number("rows"),
            number("rank"),
            number("redundancy"),
            number("mobility")
        );
        let head = scene.lines().nth(1).expect("a second line");
        assert!(head.starts_with(&format!("# Known: {} bodies, ", number("bodies"))));
        assert!(head.ends_with(&known), "{head}\n{known}");
    }
}

#[test]
fn a_file_is_the_same_as_standard_output_and_replaces_an_older_one() {
    let folder = place("generate-file");
    let file = folder.0.join("scene.toml");
    fs::write(&file, "older").expect("writable");
    let path = file.to_str().expect("UTF-8");
    let order = ["generate", "random", "--n", "40", "--seed", "7"];
    let output = lab(&[&order[..], &["--out", path]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("random-40: "), "{output:?}");
    assert_eq!(folder.read("scene.toml"), stdout(&lab(&order)));
    assert_eq!(names(&folder), ["scene.toml"]);

    let document = lab(&[&order[..], &["--out", path, "--json"]].concat());
    let document: Value = serde_json::from_slice(&document.stdout).expect("one JSON document");
    assert_eq!(document["scene"], "random-40");
    assert_eq!(document["bytes"], folder.read("scene.toml").len());
    let checked = pfaff(&["check", path, "--json"]);
    let checked: Value = serde_json::from_str(&checked).expect("one JSON document");
    assert_eq!(checked["bodies"], document["bodies"]);
    let rows = ["holonomic_rows", "nonholonomic_rows"].map(|key| checked[key].as_u64());
    assert_eq!(
        rows.into_iter().flatten().sum::<u64>(),
        document["rows"].as_u64().expect("a number")
    );
}

#[test]
fn impossible_orders_are_refused_before_anything_is_written() {
    let folder = place("generate-refused");
    let file = folder.0.join("scene.toml");
    let path = file.to_str().expect("UTF-8");
    for (order, pieces) in [
        (&["lattice", "--n", "0"][..], &["n = 0 is empty"][..]),
        (
            &["fleet", "--n", "1000000000"],
            &["would be a file of about", "GB, more than 10 GB"],
        ),
        (
            &["random", "--n", "18446744073709551615"],
            &["GB, more than 10 GB"],
        ),
        (&["random", "--n", "18446744073709551616"], &["--n"]),
        (&["random", "--n", "-3"], &["--n", "-3"]),
        (&["random"], &["--n"]),
        (
            &["spiders", "--n", "3"],
            &["spiders", "n-four-bar, parallelograms, lattice"],
        ),
        (
            &["random", "--n", "3", "--redundant", "1.5"],
            &["share is 1.5", "from 0 to 1"],
        ),
        (
            &["random", "--n", "3", "--redundant", "nan"],
            &["share is NaN"],
        ),
        (
            &["fleet", "--n", "3", "--redundant", "0.5"],
            &["fleet takes no redundant share"],
        ),
        (
            &["lattice", "--n", "3", "--seed", "1"],
            &["lattice takes no seed"],
        ),
    ] {
        let order = [&["generate"], order, &["--out", path]].concat();
        let output = lab(&order);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{order:?}: {text}");
        for piece in pieces {
            assert!(text.contains(piece), "{order:?}: {text}");
        }
    }
    assert!(names(&folder).is_empty());
    // Standard output must contain only the scene.
    let both = lab(&["generate", "lattice", "--n", "1", "--json"]);
    assert_eq!(both.status.code(), Some(2));
    let both: Value = serde_json::from_slice(&both.stdout).expect("one JSON document");
    assert_eq!(both["code"], "P0001");
    assert!(
        both["error"]
            .as_str()
            .is_some_and(|text| text.contains("--out")),
        "{both}"
    );
    let refusal = lab(&["generate", "lattice", "--n", "0", "--out", path, "--json"]);
    let refusal: Value = serde_json::from_slice(&refusal.stdout).expect("one JSON document");
    assert_eq!(
        (&refusal["ok"], &refusal["problems"]),
        (&false.into(), &Value::Array(vec![]))
    );
}

#[test]
fn a_directory_is_no_file() {
    let folder = place("generate-directory");
    let output = lab(&["generate", "lattice", "--n", "1", "--out", folder.text()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("is a directory, need a file"));
}

#[cfg(target_os = "linux")]
mod on_linux {
    use std::io::{BufRead, BufReader, Read};
    use std::os::unix::fs::{FileTypeExt, symlink};
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    use super::*;

    #[test]
    fn nobody_has_to_read_the_scene_to_its_end() {
        let mut child = Command::new(env!("CARGO_BIN_EXE_lab"))
            .args(["generate", "parallelograms", "--n", "100000"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        let mut line = String::new();
        BufReader::new(child.stdout.take().expect("piped"))
            .read_line(&mut line)
            .expect("a line");
        assert!(line.starts_with("# parallelograms-100000: "), "{line}");
        let output = child.wait_with_output().expect("it ends");
        assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
    }

    #[test]
    fn devices_stay_what_they_are_and_links_too() {
        let output = lab(&["generate", "lattice", "--n", "2", "--out", "/dev/null"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let null = fs::metadata("/dev/null").expect("Linux has it");
        assert!(null.file_type().is_char_device());
        let full = lab(&["generate", "lattice", "--n", "2", "--out", "/dev/full"]);
        assert_eq!(full.status.code(), Some(1));
        assert!(
            stderr(&full).contains("cannot write `/dev/full`: No space"),
            "{full:?}"
        );

        let folder = place("generate-link");
        fs::write(folder.0.join("scene.toml"), "older").expect("writable");
        let link = folder.0.join("link.toml");
        symlink("scene.toml", &link).expect("links");
        let path = link.to_str().expect("UTF-8");
        let output = lab(&["generate", "lattice", "--n", "2", "--out", path]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert!(folder.read("scene.toml").starts_with("# lattice-2: "));
    }

    #[test]
    fn a_full_disk_keeps_the_older_scene_and_no_half_of_a_new_one() {
        let folder = place("generate-full");
        let file = folder.0.join("scene.toml");
        fs::write(&file, "older").expect("writable");
        let path = file.to_str().expect("UTF-8");
        // With a limit of zero for file sizes, no byte can be written into a file.
        let script = "trap '' XFSZ; ulimit -f 0; exec \"$0\" \"$@\"";
        let mut limited = Command::new("sh");
        limited.args(["-c", script, env!("CARGO_BIN_EXE_lab")]);
        limited.args(["generate", "fleet", "--n", "200", "--out", path]);
        let output = limited.output().expect("it starts");
        assert_eq!(output.status.code(), Some(1));
        assert!(
            stderr(&output).contains("scene.toml.part`: File too large"),
            "{output:?}"
        );
        assert_eq!(names(&folder), ["scene.toml"]);
        assert_eq!(folder.read("scene.toml"), "older");
    }

    #[test]
    fn an_interrupted_scene_is_not_kept() {
        let folder = place("generate-interrupted");
        let file = folder.0.join("scene.toml");
        let path = file.to_str().expect("UTF-8");
        let mut child = Command::new(env!("CARGO_BIN_EXE_lab"))
            .args([
                "generate",
                "parallelograms",
                "--n",
                "5000000",
                "--out",
                path,
            ])
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        let part = folder.0.join("scene.toml.part");
        let begin = Instant::now();
        while !fs::metadata(&part).is_ok_and(|part| part.len() > 0) {
            assert!(
                begin.elapsed() < Duration::from_secs(60),
                "nothing is written"
            );
            std::thread::sleep(Duration::from_millis(1));
        }
        let sent = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status();
        assert!(sent.is_ok_and(|status| status.success()));
        assert_eq!(child.wait().expect("it ends").code(), Some(1));
        let mut text = String::new();
        let mut errors = child.stderr.take().expect("piped");
        errors.read_to_string(&mut text).expect("UTF-8");
        assert!(text.contains("interrupted; nothing is kept"), "{text}");
        assert!(names(&folder).is_empty());
    }
}
