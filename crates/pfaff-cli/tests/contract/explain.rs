//! Every code is explained, and every example reports its code.

use pfaff::model::codes::{Code, Example, entries};
use serde_json::Value;

use super::{Folder, pfaff, stderr, stdout};
use std::io::Write;
use std::process::{Command, Stdio};

#[test]
fn the_page_of_the_book_is_that_of_the_program() {
    assert_eq!(
        stdout(&pfaff(&["explain", "--book"])),
        include_str!("../../../../docs/book/errors.md"),
        "cargo run -p pfaff-cli -- explain --book > docs/book/errors.md"
    );
}

#[test]
fn codes_are_found() {
    let all = stdout(&pfaff(&["explain"]));
    assert_eq!(all.lines().count(), entries().len());
    for entry in entries() {
        let found = Code::find(&entry.code.to_string()).expect("in the table");
        assert_eq!(found.code, entry.code);
        assert!(all.contains(&format!("{}  {}\n", entry.code, entry.title)));
        assert!(entry.advice.ends_with('.') && !entry.title.ends_with('.'));
    }
    let text = stdout(&pfaff(&["explain", "P0102"]));
    assert!(
        text.starts_with("P0102: Unknown key in a table\n"),
        "{text}"
    );
    let document = |arguments: &[&str]| -> Value {
        serde_json::from_slice(&pfaff(arguments).stdout).expect("JSON")
    };
    let listed = &document(&["explain", "--json"])["codes"];
    assert_eq!(listed.as_array().map(Vec::len), Some(entries().len()));
    let one = document(&["explain", "102", "--json"]);
    assert_eq!(one["codes"][0]["code"], "P0102");
    assert_eq!(one["codes"][0]["arguments"], "check -");
    let output = pfaff(&["explain", "P9999"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).starts_with("error[P0001]: there is no code `P9999`"));
}

#[test]
fn every_example_has_its_code() {
    let folder = Folder::new("codes");
    std::fs::create_dir_all(&folder.0).expect("writable");
    let run = |arguments: &str, scene: &str| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_pfaff"))
            .args(arguments.split(' '))
            .current_dir(&folder.0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        // A command that does not read its input has already ended.
        let _ = child
            .stdin
            .take()
            .expect("piped")
            .write_all(scene.as_bytes());
        child.wait_with_output().expect("the command ends")
    };
    // A valid scene for commands without a scene.
    let door = include_str!("../../../../examples/door.toml");
    let mut wrong = Vec::new();
    for entry in entries() {
        let (arguments, scene) = match entry.example {
            Example::Scene(arguments, scene) => (arguments, scene),
            Example::Command(arguments) => (arguments, door),
            Example::None(reason) => {
                // A requirement or a dependency.
                let verbs = ["requires ", "depends on ", "reachable only "];
                assert!(verbs.iter().any(|verb| reason.contains(verb)), "{reason}");
                let said = stdout(&pfaff(&["explain", &entry.code.to_string()]));
                assert!(
                    said.contains(&format!("no short example: {reason}\n")),
                    "{said}"
                );
                continue;
            }
        };
        let output = run(arguments, scene);
        let said = stderr(&output) + &stdout(&output);
        let is_said = |word: &str| said.contains(&format!("{word}[{}]: ", entry.code));
        if !is_said("error") && !is_said("warning") {
            wrong.push(format!("{}: {arguments}: {said}", entry.code));
            continue;
        }
        // The document contains the same code.
        let output = run(&format!("{arguments} --json"), scene);
        let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(document["format"], 2, "{document:#}");
        let codes = document["problems"].as_array().expect("a list").iter();
        let mut codes = codes.map(|p| &p["code"]).chain([&document["code"]]);
        let code = entry.code.to_string();
        assert!(codes.any(|c| *c == code.as_str()), "{document:#}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
