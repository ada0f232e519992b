//! Runs the program as the README describes: its results next to the published ones, and its
//! figures.

use std::path::Path;
use std::process::Command;

#[test]
fn the_program_finds_what_was_published() {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("robot-trolley-figures");
    let _ = std::fs::remove_dir_all(&out);
    let ran = Command::new(env!("CARGO_BIN_EXE_robot-trolley"))
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    let text = String::from_utf8(ran.stdout).unwrap();
    let errors = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{errors}");

    let words = |line: &str| -> Vec<String> { line.split_whitespace().map(String::from).collect() };
    let lines: Vec<_> = text.lines().map(words).collect();
    for (row, number) in [("rows of C", "22"), ("rank C", "20"), ("redundancy p", "2")] {
        let row = words(row);
        let line = lines
            .iter()
            .find(|l| l.windows(row.len()).any(|w| w == row));
        let line = line.unwrap_or_else(|| panic!("no row {row:?} in\n{text}"));
        assert_eq!(line[line.len() - 2..], [number, number], "{line:?}");
    }
    // There are fourteen joints and drives: the computed verdict, and the published one.
    let table = text.split("‖B_X‖").nth(1).unwrap().lines().skip(1);
    let (mut unique, mut not_unique) = (0, 0);
    for line in table.take_while(|line| !line.trim().is_empty()) {
        if line.ends_with("not unique") {
            assert_eq!(line.matches("not unique").count(), 2, "{line}");
            not_unique += 1;
        } else {
            assert_eq!(line.matches("unique").count(), 2, "{line}");
            assert!(!line.contains("not unique"), "{line}");
            unique += 1;
        }
    }
    assert_eq!((unique, not_unique), (8, 6), "{text}");
    assert!(text.contains("at 201 of 201 instants"), "{text}");

    let report = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(
        report.contains("robot-trolley") && text.contains("\nreport: "),
        "{text}"
    );
    let figures = text
        .lines()
        .filter_map(|line| line.strip_prefix("written: "));
    let figures: Vec<_> = figures.map(std::fs::read_to_string).collect();
    assert!(figures.len() >= 3, "{text}");
    for figure in figures {
        assert!(figure.unwrap().starts_with("<svg"));
    }
}
