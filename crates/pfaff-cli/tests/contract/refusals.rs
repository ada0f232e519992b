//! Every command rejects every kind of invalid input with a code of the table: as text on standard
//! error, and with `--json` as one document on standard output.

use std::collections::BTreeSet;
use std::io::Write;
use std::process::{Command, Output, Stdio};

use pfaff::model::codes::Code;
use serde_json::Value;

use super::{Folder, pfaff, stderr, stdout};

const DOOR: &[u8] = include_bytes!("../../../../examples/door.toml");

/// A fault in the input, and the code with which a command rejects it.
struct Fault {
    what: &'static str,
    code: &'static str,
    /// Arguments that replace the correct ones.
    arguments: Option<&'static str>,
    /// Additional arguments.
    more: &'static str,
    input: &'static [u8],
}

const NONE: Fault = Fault {
    what: "",
    code: "P0001",
    arguments: None,
    more: "",
    input: DOOR,
};

/// Faults that any command may have.
const OF_ALL: [Fault; 2] = [
    Fault {
        what: "unknown option",
        more: "--nonsense",
        ..NONE
    },
    Fault {
        what: "a flag with a value",
        more: "--json=yes",
        ..NONE
    },
];

/// Faults of commands that read a scene.
const OF_SCENES: [Fault; 7] = [
    Fault {
        what: "no scene",
        arguments: Some(""),
        ..NONE
    },
    Fault {
        what: "no such file",
        code: "P0002",
        arguments: Some("no-such-file.toml"),
        ..NONE
    },
    Fault {
        what: "a directory",
        code: "P0002",
        arguments: Some("."),
        ..NONE
    },
    Fault {
        what: "not UTF-8",
        code: "P0002",
        input: b"\xff\xfe",
        ..NONE
    },
    Fault {
        what: "not TOML",
        code: "P0101",
        input: b"[scene",
        ..NONE
    },
    Fault {
        what: "wrong scene",
        code: "P0114",
        input: b"[scene]\nname = \"x\"\nspace = \"moon\"\n[[body]]\nname = \"b\"\nmass = 1\ninertia = 1\n",
        ..NONE
    },
    Fault {
        what: "unknown number",
        code: "P0501",
        more: "--set body.absent.mass=1",
        ..NONE
    },
];

/// Faults of commands that write files; `taken` is a file in the folder.
const OF_PLACES: [Fault; 1] = [Fault {
    what: "not a place",
    code: "P0003",
    more: "--out taken/results.svg",
    ..NONE
}];

/// The commands with correct arguments, and whether these end with a scene and with a path.
const COMMANDS: [(&str, &str, bool, bool); 18] = [
    ("analyze", "-", true, false),
    ("simulate", "- --out run --t-end 1", true, true),
    ("cases", "- --out cases", true, true),
    ("plan", "-", true, false),
    (
        "sweep",
        "- --out sweep --vary body.leaf.mass=1,2",
        true,
        true,
    ),
    (
        "tolerance",
        "- --tolerance 1e-4 --runs 3 --out tolerance",
        true,
        true,
    ),
    ("work-precision", "- --out work --quick", true, true),
    ("check", "-", true, false),
    ("equilibrium", "- --out rest", true, true),
    ("linearise", "- --out modes", true, true),
    ("new", "door", false, true),
    ("import", "- --out -", false, false),
    ("view", "- --no-open", true, true),
    ("diff", "- ./door.toml", true, false),
    ("explain", "P0102", false, false),
    ("schema", "", false, false),
    ("completions", "bash", false, false),
    ("man", "analyze", false, false),
];

/// Further faults of single commands.
const OF_ONE: [(&str, &str, &str); 32] = [
    ("linearise", "- --coordinates leaf.tilt", "P0222"),
    ("linearise", "- --at-time soon", "P0001"),
    ("analyze", "- --drop 0", "P0001"),
    ("analyze", "- --drop 99", "P0403"),
    ("analyze", "- --combine absent.Fx", "P0311"),
    ("analyze", "- --make-unique absent", "P0310"),
    ("analyze", "- --choose nothing", "P0001"),
    ("analyze", "- --at-time soon", "P0001"),
    ("simulate", "- --out run --method gbs", "P0001"),
    ("simulate", "- --out run --t-end -1", "P0401"),
    ("simulate", "- --out run --t-end 1 --max-memory 1", "P0001"),
    ("cases", "- --out cases", "P0001"),
    ("sweep", "- --out sweep", "P0001"),
    ("sweep", "- --out sweep --vary body.leaf.mass", "P0001"),
    ("sweep", "--merge . --out sweep", "P0507"),
    ("tolerance", "-", "P0510"),
    ("tolerance", "- --tolerance 1e-4 --runs 0", "P0511"),
    ("tolerance", "- --tolerance 0", "P0001"),
    ("tolerance", "- --vary body.leaf.mass=2", "P0001"),
    ("tolerance", "- --vary body.absent.mass=±1%", "P0501"),
    ("tolerance", "- --vary body.leaf.mass=±200%", "P0513"),
    ("view", "- --out picture.gif", "P0001"),
    ("view", "- --scale 2 --out picture.svg", "P0001"),
    ("view", "- --scale 0 --out picture.png", "P0001"),
    ("view", "- --scale 20 --out picture.png", "P0001"),
    ("new", "no-such-template", "P0001"),
    ("import", "-", "P0001"),
    ("import", "- --out -", "P0601"),
    ("import", "no-such-file.xml --out -", "P0002"),
    ("import", "taken --out -", "P0601"),
    ("explain", "P9999", "P0001"),
    ("man", "analyze too many", "P0001"),
];

fn run(folder: &Folder, arguments: &str, input: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pfaff"))
        .args(arguments.split_whitespace())
        .current_dir(&folder.0)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    // A command that does not read its input has already ended.
    let _ = child.stdin.take().expect("piped").write_all(input);
    child.wait_with_output().expect("the command ends")
}

/// Returns the errors in the two answers to an invalid input.
fn faults_of(folder: &Folder, arguments: &str, input: &[u8], code: &str) -> Option<String> {
    let words = run(folder, arguments, input);
    if words.status.code() != Some(2)
        || !words.stdout.is_empty()
        || !stderr(&words).starts_with(&format!("error[{code}]: "))
    {
        return Some(format!("{}{}", stdout(&words), stderr(&words)));
    }
    let json = run(folder, &format!("{arguments} --json"), input);
    let document: Value = serde_json::from_slice(&json.stdout).unwrap_or_default();
    let error = document["error"].as_str().unwrap_or_default();
    let is_refusal = json.status.code() == Some(2)
        && json.stderr.is_empty()
        && document["format"] == 2
        && document["version"] == env!("CARGO_PKG_VERSION")
        && document["ok"] == false
        && document["code"] == code
        && document["problems"].is_array()
        && !error.is_empty()
        && !error.contains('\n');
    (!is_refusal).then(|| format!("--json: {}{}", stdout(&json), stderr(&json)))
}

#[test]
fn every_command_refuses_with_a_code_in_words_and_as_a_document() {
    let folder = Folder::new("refusals");
    std::fs::create_dir_all(&folder.0).expect("writable");
    for (name, content) in [("taken", &b""[..]), ("door.toml", DOOR)] {
        std::fs::write(folder.0.join(name), content).expect("writable");
    }
    let mut cases: Vec<(String, &[u8], &str)> = Vec::new();
    for (command, right, has_scene, has_place) in COMMANDS {
        let mut faults: Vec<&Fault> = OF_ALL.iter().collect();
        if has_scene {
            faults.extend(&OF_SCENES);
        }
        if has_place {
            faults.extend(&OF_PLACES);
        }
        for fault in faults {
            assert!(Code::find(fault.code).is_some(), "{}", fault.what);
            let is_place = fault.more.starts_with("--out");
            let arguments = match (fault.arguments, right.split_once(' ')) {
                (Some(wrong), Some((_, others))) => format!("{wrong} {others}"),
                (Some(wrong), None) => wrong.to_owned(),
                (None, _) if is_place => {
                    let words = right.split_whitespace().collect::<Vec<_>>();
                    let out = words.iter().position(|word| *word == "--out");
                    let kept = words.iter().enumerate();
                    let kept =
                        kept.filter(|(k, _)| out.is_none_or(|out| *k != out && *k != out + 1));
                    kept.map(|(_, word)| format!("{word} ")).collect()
                }
                (None, _) => right.to_owned(),
            };
            let line = format!("{command} {arguments} {}", fault.more);
            cases.push((line, fault.input, fault.code));
        }
    }
    for (command, arguments, code) in OF_ONE {
        cases.push((format!("{command} {arguments}"), DOOR, code));
    }
    for line in ["", "nothing", "analyse -", "stress", "generate chain --n 3"] {
        cases.push((line.to_owned(), b"", "P0001"));
    }
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(arguments, input, code)| {
            let fault = faults_of(&folder, arguments, input, code)?;
            Some(format!("pfaff {arguments}\n  need {code}, found {fault}"))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn all_commands_are_walked() {
    let help = stdout(&pfaff(&["--help"]));
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names = listed
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help");
    let walked: BTreeSet<&str> = COMMANDS.iter().map(|(name, ..)| *name).collect();
    assert_eq!(names.collect::<BTreeSet<_>>(), walked);
}
