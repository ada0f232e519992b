//! Makes random changes of a text. After most changes the text is still valid TOML, so that the
//! reader of scenes and the later stages are tested.

use crate::fuzz::scenes::{EXTREMES, Space};
use suite::numbers::Numbers;

/// Replacement values of all types.
const VALUES: [&str; 30] = [
    "true",
    "\"\"",
    "\" \"",
    "\"ground\"",
    "\"auto\"",
    "[]",
    "[0, 0]",
    "[0.0, 1.0]",
    "[1e308, -1e308]",
    "[0, 1, 1, 99]",
    "[[0, 0], [0, 0]]",
    "[[1, 2], [3, 4], 5]",
    "{}",
    "{ ground = [0, 0] }",
    "1979-05-27",
    "0x1F",
    "1_000",
    "{ type = \"table\", times = [0, 1, 2], values = [1, 2, 1] }",
    "{ type = \"steps\", steps = [{ from = 0.01, to = 0.01000000001, by = 1 }] }",
    "{ type = \"polynomial\", coefficients = [0, 0, 1e9] }",
    "{ type = \"harmonic\", amplitude = 1, omega = 1e9, phase = 0, offset = 0 }",
    "{ type = \"constant-rate\", rate = 1e6 }",
    "\"a\\nb\"",
    "\"\\u0000\"",
    "\"2 mm + 1 deg\"",
    "\"p0 + ((((1))))\"",
    "\"1/0\"",
    "\"10^10^10\"",
    "\"-rate*t\"",
    "\"45 deg\"",
];

/// Lines that change the kind of an element.
const LINES: [&str; 36] = [
    "type = \"revolute\"",
    "type = \"translational\"",
    "type = \"fixed\"",
    "type = \"gear\"",
    "type = \"distance\"",
    "type = \"rolling\"",
    "type = \"rack-and-pinion\"",
    "type = \"point-on-line\"",
    "type = \"velocity\"",
    "type = \"bushing\"",
    "type = \"knife-edge\"",
    "type = \"angle\"",
    "type = \"mesh\"",
    "type = \"tyre\"",
    "type = \"damper\"",
    "type = \"speed\"",
    "torque = \"rate/measure\"",
    "format = 2",
    "active = false",
    "centre = [1e3, 0.5]",
    "[[marker]]",
    "[[measure]]",
    "[[body]]",
    "[[joint]]",
    "[[drive]]",
    "[[force]]",
    "[[group]]",
    "[start]",
    "[output]",
    "[simulate]",
    "drop = [0, 99, 6, 6]",
    "drop = [1]",
    "at = [0.0, 0.0]",
    "mass = 0",
    "inertia = 0.0",
    "allow_correction = true",
];

/// Additional values for a scene in space.
const SPACE_VALUES: [&str; 16] = [
    "[0, 0, 0]",
    "[0.0, 0.0, 1.0]",
    "[1, 1e-9, 0]",
    "[1e308, -1e308, 0]",
    "[[0, 0, 0], [0, 0, 0]]",
    "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
    "{ ground = [0, 0, 0] }",
    "{ quaternion = [0, 0, 0, 0] }",
    "{ quaternion = [1, 1e-160, 0, 0] }",
    "{ axis = [0, 0, 0], angle = 1 }",
    "{ rpy = [1e6, 0, -1e6] }",
    "{ matrix = [[1, 0, 0], [0, 1, 0], [0, 0, -1]] }",
    "{ matrix = [[1, 0, 0], [1, 0, 0], [0, 0, 1]] }",
    "{ point = [0, 0, 0], normal = [0, 0, 0] }",
    "{ point = [0, 0, 1e9], normal = [0, 1, 1] }",
    "\"global\"",
];

/// Additional lines for a scene in space.
const SPACE_LINES: [&str; 14] = [
    "type = \"spherical\"",
    "type = \"universal\"",
    "type = \"cylindrical\"",
    "type = \"planar\"",
    "type = \"wheel\"",
    "type = \"orientation\"",
    "type = \"perpendicular\"",
    "space = \"plane\"",
    "orientation = { axis = [0, 0, 1], angle = 1 }",
    "cross = [0, 0, 1]",
    "axis = [0, 1, 0]",
    "frame = \"global\"",
    "at = [0.0, 0.0, 0.0]",
    "angular_velocity = [0, 0, 30]",
];

/// Returns additional changes for a scene in this space.
fn more(space: Space, words: &'static [&'static str]) -> &'static [&'static str] {
    match space {
        Space::Plane => &[],
        Space::Space => words,
    }
}

fn one_of(words: &[&str], more: &[&str], numbers: &mut Numbers) -> String {
    let k = numbers.below(words.len() + more.len());
    let word = words.get(k).or_else(|| more.get(k - words.len()));
    word.map_or_else(String::new, |word| (*word).to_owned())
}

/// Random characters: characters with a meaning in TOML, and other characters.
const SIGNS: [&str; 16] = [
    "[", "]", "{", "}", "=", ",", ".", "\"", "'", "\n", "#", "-", "é", "\u{feff}", "𝛗", "\u{0}",
];

/// Returns the text with one change.
#[must_use]
pub fn damaged(space: Space, text: &str, numbers: &mut Numbers) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    if lines.is_empty() {
        return SIGNS[numbers.below(SIGNS.len())].to_owned();
    }
    let at = numbers.below(lines.len());
    match numbers.below(32) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[at].clone()),
        2 => {
            let other = numbers.below(lines.len());
            lines.swap(at, other);
        }
        3 => lines.insert(at, one_of(&LINES, more(space, &SPACE_LINES), numbers)),
        4 => {
            // Repeats a range of lines: the result has elements with the same name, or arrays that
            // are twice as long.
            let end = (at + 1 + numbers.below(8)).min(lines.len());
            let copy = lines[at..end].to_vec();
            lines.splice(at..at, copy);
        }
        5 => {
            let end = (at + 1 + numbers.below(8)).min(lines.len());
            lines.drain(at..end);
        }
        6 => lines[at] = with_sign(&lines[at], numbers),
        7..=9 => lines[at] = with_value(space, &lines[at], numbers),
        10..=12 => lines[at] = with_value_of_another(&lines, at, numbers),
        13..=17 => lines[at] = with_other_name(text, &lines[at], numbers),
        _ => lines[at] = with_other_number(&lines[at], numbers),
    }
    lines.join("\n")
}

/// Adds, removes or replaces one character.
fn with_sign(line: &str, numbers: &mut Numbers) -> String {
    let mut signs: Vec<String> = line.chars().map(String::from).collect();
    let sign = SIGNS[numbers.below(SIGNS.len())].to_owned();
    let at = numbers.below(signs.len() + 1);
    match (numbers.below(3), at < signs.len()) {
        (0, true) => drop(signs.remove(at)),
        (1, true) => signs[at] = sign,
        _ => signs.insert(at, sign),
    }
    signs.concat()
}

fn with_value(space: Space, line: &str, numbers: &mut Numbers) -> String {
    match line.split_once('=') {
        Some((key, _)) => {
            let value = one_of(&VALUES, more(space, &SPACE_VALUES), numbers);
            format!("{key}= {value}")
        }
        None => line.to_owned(),
    }
}

fn with_value_of_another(lines: &[String], at: usize, numbers: &mut Numbers) -> String {
    let other = &lines[numbers.below(lines.len())];
    match (lines[at].split_once('='), other.split_once('=')) {
        (Some((key, _)), Some((_, value))) => format!("{key}={value}"),
        _ => other.clone(),
    }
}

/// Replaces one of the quoted texts of the line by another quoted text of the file.
fn with_other_name(text: &str, line: &str, numbers: &mut Numbers) -> String {
    let names: Vec<&str> = text.split('"').skip(1).step_by(2).collect();
    let mut parts: Vec<&str> = line.split('"').collect();
    let quoted = parts.len() / 2;
    if quoted == 0 || names.is_empty() {
        return line.to_owned();
    }
    parts[2 * numbers.below(quoted) + 1] = names[numbers.below(names.len())];
    parts.join("\"")
}

/// Replaces one of the numbers of the line by an extreme number or a slightly changed number.
fn with_other_number(line: &str, numbers: &mut Numbers) -> String {
    let is_part = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    let mut pieces: Vec<String> = Vec::new();
    let mut in_number = false;
    for c in line.chars() {
        match pieces.last_mut() {
            Some(last) if in_number == is_part(c) => last.push(c),
            _ => pieces.push(c.to_string()),
        }
        in_number = is_part(c);
    }
    let places: Vec<usize> = (0..pieces.len())
        .filter(|&k| pieces[k].parse::<f64>().is_ok())
        .collect();
    if places.is_empty() {
        return line.to_owned();
    }
    let place = places[numbers.below(places.len())];
    let value: f64 = pieces[place].parse().unwrap_or(0.0);
    pieces[place] = match numbers.below(4) {
        0 => format!("{:?}", value * (1.0 + 1e-9 * numbers.unit())),
        1 => format!("{:?}", value + numbers.unit()),
        _ => EXTREMES[numbers.below(EXTREMES.len())].to_owned(),
    };
    pieces.concat()
}
