//! Tests that the book shows the actual output of the command `lab`. The commands in `console`
//! blocks of `docs/book` are run, and their output is compared line by line. The tests of
//! `pfaff-cli` compare the output of other commands.

use std::fs;
use std::process::Command;

use super::{Folder, stdout};

const BOOK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/book");

/// The start of the command line, before the arguments of `lab`.
const COMMAND: &str = "$ cargo run -q --release -p lab -- ";

/// Returns commands of the laboratory with the lines shown below each.
fn examples(text: &str) -> Vec<(&str, Vec<&str>)> {
    let mut found = Vec::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let Some(command) = line.strip_prefix(COMMAND) else {
            continue;
        };
        let mut shown = Vec::new();
        while let Some(line) = lines.next_if(|l| !l.starts_with("$ ") && !l.starts_with("```")) {
            shown.push(line);
        }
        // If the output is piped to `pfaff`, the tests of `pfaff-cli` run the command.
        if !command.contains('|') {
            found.push((command, shown));
        }
    }
    found
}

#[test]
fn the_laboratory_writes_what_the_book_shows() {
    let mut seen = 0;
    for entry in fs::read_dir(BOOK).expect("the book is there") {
        let path = entry.expect("a chapter").path();
        if path.extension().is_none_or(|e| e != "md") {
            continue;
        }
        let text = fs::read_to_string(&path).expect("readable");
        for (command, shown) in examples(&text) {
            let folder = Folder::new("book");
            fs::create_dir_all(&folder.0).expect("a folder");
            let output = Command::new(env!("CARGO_BIN_EXE_lab"))
                .args(command.split(' '))
                .current_dir(&folder.0)
                .output()
                .expect("the command starts");
            assert!(output.status.success(), "{command}: {output:?}");
            let written = stdout(&output);
            if shown != ["…"] {
                assert_eq!(written.lines().collect::<Vec<_>>(), shown, "{command}");
            }
            seen += 1;
        }
    }
    assert!(seen >= 3, "{seen} commands");
}
