//! Tests invalid files: after any change of the text, reading ends with a scene or with diagnostics
//! inside the text.

use model::{Mechanism, Registry};
use proptest::prelude::*;

use crate::ROBOT;

/// A change of the text at a token or a line.
#[derive(Clone, Debug)]
enum Mutation {
    Delete,
    Duplicate,
    Replace(String),
    Swap(usize),
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let pieces = prop::sample::select(vec![
        "nan",
        "-inf",
        "1e999",
        "-1",
        "0",
        "true",
        "\"\"",
        "\"A\"",
        "\"ground\"",
        "\"platform\"",
        "[",
        "]",
        "[]",
        "{",
        "}",
        "{}",
        "=",
        ".",
        ",",
        "\"",
        "'",
        "\n",
        "[[body]]",
        "[[joint]]",
        "[joint]",
        "[[drive]]",
        "[drive.motion]",
        "[simulate]",
        "[[group]]",
        "combine = \"W3.N +\"\n",
        "drop = [0, 99, 6, 6]\n",
        "keep = [\"slider.x\", \"x\", \".\"]\n",
        "points = { platform = [0, 0] }\n",
        "body = \"slider\"\n",
        "type = \"gear\"\n",
        "type = \"table\"\n",
        "0x",
        "1979-05-27",
        "9223372036854775808",
        "é",
        "\u{feff}",
        "𝛗",
        "\"\\u0000\"",
    ]);
    prop_oneof![
        Just(Mutation::Delete),
        Just(Mutation::Duplicate),
        pieces.prop_map(|text| Mutation::Replace(text.to_owned())),
        any::<usize>().prop_map(Mutation::Swap),
        "\\PC{0,6}".prop_map(Mutation::Replace),
    ]
}

/// Splits the text into lines, or into words and single characters.
fn pieces(text: &str, by_line: bool) -> Vec<String> {
    if by_line {
        return text.split_inclusive('\n').map(str::to_owned).collect();
    }
    let mut pieces: Vec<String> = Vec::new();
    let mut in_word = false;
    for c in text.chars() {
        let word = c.is_alphanumeric() || "._-".contains(c);
        match pieces.last_mut() {
            Some(last) if word && in_word => last.push(c),
            _ => pieces.push(c.to_string()),
        }
        in_word = word;
    }
    pieces
}

fn mutate(text: &str, by_line: bool, at: usize, mutation: &Mutation) -> String {
    let mut pieces = pieces(text, by_line);
    if pieces.is_empty() {
        return String::new();
    }
    let at = at % pieces.len();
    match mutation {
        Mutation::Delete => pieces[at].clear(),
        Mutation::Duplicate => pieces[at] = pieces[at].repeat(2),
        Mutation::Replace(text) => pieces[at].clone_from(text),
        Mutation::Swap(other) => {
            let other = other % pieces.len();
            pieces.swap(at, other);
        }
    }
    pieces.concat()
}

fn check(text: &str) {
    let registry = Registry::standard();
    match pfaff_scene::read("mutated.toml", text, &registry) {
        Ok(scene) => assert!(Mechanism::build(&scene.description).is_ok()),
        Err(problems) => {
            assert!(!problems.is_empty());
            for d in &problems {
                for label in std::iter::once(&d.primary).chain(&d.secondary) {
                    assert!(text.get(label.span.clone()).is_some(), "{d}: {label:?}");
                    let before = &text[..label.span.start];
                    assert_eq!(label.line, before.matches('\n').count() + 1, "{d}");
                }
            }
        }
    }
}

/// Values of all types that are valid TOML; most keys reject most of them.
const VALUES: [&str; 34] = [
    "nan",
    "-inf",
    "1e999",
    "-1",
    "0",
    "0x1F",
    "9223372036854775808",
    "1979-05-27",
    "true",
    "\"\"",
    "\"A\"",
    "\"H\"",
    "\"ground\"",
    "\"platform\"",
    "\"slider.vx\"",
    "\"W3.N - 2*W4.N\"",
    "\"\\u0041\"",
    "[]",
    "[0, 1, 1, 99]",
    "[[0, 0], [0, 0]]",
    "[[1, 2], [3, 4], 5]",
    "[\"platform\", \"platform\"]",
    "[\"ground\", \"slider\"]",
    "[\"slider\", \"nobody\", 1]",
    "{}",
    "{ platform = [0, 0], slider = [1, 1] }",
    "{ ground = 1 }",
    "{ type = \"table\", times = [0, 1], values = [1, 2] }",
    "{ type = \"table\", times = [1], values = [] }",
    "{ type = \"steps\", steps = [{ from = 1, to = 0, by = 1 }] }",
    "{ type = \"polynomial\", coefficients = [] }",
    "{ type = \"harmonic\", amplitude = 1, omega = 1e200 }",
    "[1.7e308, -1.7e308]",
    "\"auto\"",
];

/// Keys and types that change the kind of an item.
const LINES: [&str; 24] = [
    "type = \"gear\"",
    "type = \"distance\"",
    "type = \"rolling\"",
    "type = \"rack-and-pinion\"",
    "type = \"point-on-line\"",
    "type = \"velocity\"",
    "type = \"bushing\"",
    "type = \"table\"",
    "[[body]]",
    "[[joint]]",
    "[[drive]]",
    "[[force]]",
    "[[group]]",
    "[start]",
    "[output]",
    "reactions = [\"A\", \"Z\"]",
    "keep = [\"slider.x\", \"x\", \".\", \"slider.x\"]",
    "combine = \"W3.N +\"",
    "members = [\"A\", \"steering\"]",
    "drop = [0, 99, 6, 6]",
    "carrier = \"trolley\"",
    "body = \"slider\"",
    "points = { platform = [0, 0] }",
    "rate = [0, { type = \"steps\", steps = [] }]",
];

/// Changes whole lines, so that the text usually remains valid TOML and the reader of scenes is
/// tested, not only the parser.
fn change_line(text: &str, at: usize, kind: u8, piece: usize) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let at = at % lines.len();
    match kind % 5 {
        0 => lines[at].clear(),
        1 => lines[at] = LINES[piece % LINES.len()].to_owned(),
        2 => lines.insert(at, LINES[piece % LINES.len()].to_owned()),
        _ => {
            if let Some((key, _)) = lines[at].split_once('=') {
                lines[at] = format!("{key}= {}", VALUES[piece % VALUES.len()]);
            }
        }
    }
    lines.join("\n")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_mutation_panics(
        mutations in prop::collection::vec((any::<bool>(), any::<usize>(), mutation()), 1..6)
    ) {
        let mut text = ROBOT.to_owned();
        for (by_line, at, mutation) in &mutations {
            text = mutate(&text, *by_line, *at, mutation);
        }
        check(&text);
    }

    #[test]
    fn no_change_of_lines_panics(
        changes in prop::collection::vec((any::<usize>(), any::<u8>(), any::<usize>()), 1..8)
    ) {
        let mut text = ROBOT.to_owned();
        for &(at, kind, piece) in &changes {
            text = change_line(&text, at, kind, piece);
        }
        check(&text);
    }

    #[test]
    fn no_text_panics(text in "\\PC{0,60}") {
        check(&text);
    }
}

#[test]
fn a_robot_cut_anywhere_is_no_reason_to_panic() {
    for at in (0..ROBOT.len())
        .step_by(7)
        .filter(|&at| ROBOT.is_char_boundary(at))
    {
        check(&ROBOT[..at]);
    }
}

#[test]
fn deep_nesting_is_refused() {
    check(&format!("x = {}", "[".repeat(10_000)));
    check(&format!("x = {}", "{a=".repeat(10_000)));
    let text = format!("{}x = 1", "a.".repeat(10_000));
    check(&text);
}
