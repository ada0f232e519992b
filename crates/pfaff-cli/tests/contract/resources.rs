//! Threads and memory: results do not depend on the number of threads, and a command that needs
//! more memory than is allowed is refused beforehand.

use super::{Folder, pfaff, stderr, stdout, with_scene};
use lab::generate::Kind;

/// Three uncoupled pendulums.
const APART: &str = r#"
scene = { name = "apart", space = "plane", gravity = [0.0, -9.81] }
body = [
    { name = "a", mass = 1.0, inertia = 0.1, position = [1.0, 0.0] },
    { name = "b", mass = 2.0, inertia = 0.1, position = [11.0, 0.0] },
    { name = "c", mass = 3.0, inertia = 0.1, position = [22.0, 0.0] },
]
joint = [
    { name = "A", type = "revolute", bodies = ["ground", "a"], at = [0.0, 0.0] },
    { name = "B", type = "revolute", bodies = ["ground", "b"], at = [10.0, 0.0] },
    { name = "C", type = "revolute", bodies = ["ground", "c"], at = [20.0, 0.0] },
]
simulate = { t_end = 2.0 }
"#;

#[test]
fn components_give_the_same_rows_on_any_number_of_threads() {
    let files = ["1", "2", "7"].map(|threads| {
        let folder = Folder::new(&format!("threads-{threads}"));
        let output = with_scene(
            &[
                "simulate",
                "-",
                "--out",
                folder.text(),
                "--threads",
                threads,
            ],
            APART,
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        [folder.read("trajectory.csv"), folder.read("reactions.csv")]
    });
    assert_eq!(files[0][0].lines().count(), 202);
    assert!(files[0] == files[1] && files[0] == files[2]);
}

#[test]
fn verdicts_are_the_same_on_any_number_of_threads() {
    let scene = super::generated(Kind::Random, 300);
    let documents = ["1", "2"].map(|threads| {
        let output = with_scene(&["analyze", "-", "--json", "--threads", threads], &scene);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        output.stdout
    });
    assert_eq!(documents[0], documents[1]);
}

#[test]
fn more_memory_than_allowed_is_refused_before_anything_is_written() {
    let scene = super::generated(Kind::Parallelograms, 300);
    let folder = Folder::new("memory");
    let limited = |arguments: &[&str], limit: &str| {
        with_scene(&[arguments, &["--max-memory", limit]].concat(), &scene)
    };
    let simulate = ["simulate", "-", "--out", folder.text(), "--t-end", "0.01"];
    for command in [
        &["analyze", "-"][..],
        &["check", "-"],
        &["plan", "-"],
        &simulate,
    ] {
        let refused = limited(command, "12MB");
        assert_eq!(refused.status.code(), Some(1), "{command:?}");
        assert_eq!(stdout(&refused), "");
        let said = stderr(&refused);
        let numbers = said.contains("of memory, --max-memory allows 12 MB");
        assert!(numbers, "{said}");
    }
    assert!(!folder.0.exists());
    let output = limited(&simulate, "4GB");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_refusal_is_a_document_where_one_was_asked_for() {
    let output = with_scene(&["analyze", "-", "--json", "--max-memory", "1MB"], APART);
    assert_eq!(output.status.code(), Some(1));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let error = document["error"].as_str().expect("text");
    assert!(
        error.starts_with("reading this scene takes about"),
        "{error}"
    );
}

#[test]
fn what_is_no_size_and_no_number_of_threads_is_named() {
    for (option, value, said) in [
        ("--max-memory", "4", "write a number with B, kB, MB"),
        ("--max-memory", "-1GB", "is no size"),
        ("--threads", "0", "--threads"),
        ("--threads", "many", "--threads"),
    ] {
        let output = pfaff(&["analyze", super::ROBOT, &format!("{option}={value}")]);
        assert_eq!(output.status.code(), Some(2), "{option} {value}");
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
    }
}

#[test]
fn a_plan_says_how_much_memory_its_run_takes() {
    let output = with_scene(&["plan", "-"], APART);
    let text = stdout(&output);
    assert!(
        text.lines()
            .next()
            .is_some_and(|l| l.ends_with("MB of memory")),
        "{text}"
    );
    let output = with_scene(&["plan", "-", "--json"], APART);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(
        document["memory"]
            .as_u64()
            .is_some_and(|bytes| bytes > 1 << 20)
    );
}
