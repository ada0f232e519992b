//! Text about the differences between two scenes.

use std::cmp::Ordering;

use crate::documents::{DependencyDocument, ExtremeDocument};

use super::answer::{DiffAnswer, DiffLoad, DiffMotion, DiffReaction};
use crate::words::{Block, Cell};

/// Peaks that differ by less than this fraction of the larger peak are not listed, because they
/// agree in the four digits that tables show.
const VISIBLE: f64 = 5e-5;

/// Number of listed bodies, and number of listed loads. The document contains all bodies and loads.
const LISTED: usize = 12;

pub(super) fn of(d: &DiffAnswer) -> Vec<Block> {
    let mut blocks = vec![numbers(d)];
    let reactions = reactions(d);
    let dependencies = [
        ("dependencies gone:", &d.dependencies_gone),
        ("dependencies new:", &d.dependencies_new),
    ];
    let is_same = reactions.is_none() && dependencies.iter().all(|(_, list)| list.is_empty());
    if is_same {
        let same = "no joint, drive, verdict or dependency differs";
        blocks.push(Block::sentence(same));
    }
    blocks.extend(reactions);
    for (heading, list) in dependencies {
        if !list.is_empty() {
            blocks.push(Block::Heading(heading.to_owned()));
            let text = |d: &DependencyDocument| Block::after("  - ", &d.text);
            blocks.extend(list.iter().map(text));
        }
    }
    match (&d.motion, &d.motion_not_compared) {
        (Some(motion), _) => {
            blocks.extend(moved(motion));
            blocks.extend(loaded(motion, [&d.a.file, &d.b.file]));
        }
        (None, Some(why)) => blocks.extend([
            Block::Gap,
            Block::sentence(format!("motions not compared: {why}")),
        ]),
        (None, None) => {}
    }
    blocks
}

/// Lists counts of both scenes and their differences.
fn numbers(d: &DiffAnswer) -> Block {
    let (a, b) = (&d.a, &d.b);
    // For scenes without drives, the second number would be equal to the first number.
    let is_driven = [a, b].iter().any(|d| d.mobility_without_drives.is_some());
    let [x, y] = [a, b].map(|d| d.mobility_without_drives.unwrap_or(d.mobility));
    let released = is_driven.then_some(("mobility without drives", x, y));
    let ([all, open, fragile], [all_b, open_b, fragile_b]) = (a.reactions, b.reactions);
    let fragile = (fragile + fragile_b > 0).then_some(("fragile", fragile, fragile_b));
    let counts = [
        ("bodies", a.bodies, b.bodies),
        ("joints and drives", all, all_b),
        ("rows", a.rows, b.rows),
        ("rank", a.rank, b.rank),
        ("redundancy", a.redundancy, b.redundancy),
        ("mobility", a.mobility, b.mobility),
    ];
    let counts = counts.into_iter().chain(released);
    let counts = counts.chain([("not unique", open, open_b)]).chain(fragile);
    let lines = counts.map(|(what, x, y)| {
        let change = match y.cmp(&x) {
            Ordering::Equal => String::new(),
            Ordering::Greater => format!("+{}", y - x),
            Ordering::Less => format!("−{}", x - y),
        };
        [what.to_owned(), x.to_string(), y.to_string(), change]
    });
    Block::table(["", &a.file, &b.file, ""], lines)
}

/// Lists joints and drives that were added, removed or changed. Returns `None` if there are no
/// changes.
fn reactions(d: &DiffAnswer) -> Option<Block> {
    let absent = || "–".to_owned();
    let name = |r: &DiffReaction| r.name.clone().unwrap_or_default();
    let changed = d.changed.iter().map(|change| {
        let shown = [
            change.a.kind != change.b.kind,
            change.a.contact != change.b.contact,
        ];
        let [a, b] = [&change.a, &change.b].map(|r| words(r, shown));
        [change.name.clone(), a, b]
    });
    let gone = d
        .removed
        .iter()
        .map(|r| [name(r), words(r, [true; 2]), absent()]);
    let new = d
        .added
        .iter()
        .map(|r| [name(r), absent(), words(r, [true; 2])]);
    let lines: Vec<_> = changed.chain(gone).chain(new).collect();
    let columns = ["reaction", &d.a.file, &d.b.file];
    (!lines.is_empty()).then(|| Block::table(columns, lines))
}

/// Describes the verdict on a reaction, with its type and with its contact if they are shown.
fn words(r: &DiffReaction, [with_type, with_contact]: [bool; 2]) -> String {
    let contact = r.contact.as_deref().unwrap_or("two-sided");
    // Most joints are two-sided, which is said only where it is a difference.
    let with_contact = with_contact && (r.contact.is_some() || !with_type);
    let kind = with_type.then_some(r.kind);
    let contact = with_contact.then_some(contact);
    let all = kind.into_iter().chain(contact).chain([r.said.as_str()]);
    all.collect::<Vec<_>>().join(", ")
}

/// Lists bodies by the distance between their motions. The largest distance comes first.
fn moved(motion: &DiffMotion) -> Vec<Block> {
    if motion.bodies.is_empty() {
        let none = "no body has the same name in both scenes: no motion to compare";
        return vec![Block::Gap, Block::sentence(none)];
    }
    let mut bodies: Vec<_> = motion.bodies.iter().collect();
    bodies.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    let lines = bodies.iter().take(LISTED).map(|body| {
        [
            Cell::from(&body.body),
            Cell::quantity(body.distance, "m"),
            Cell::quantity(body.t_distance, "s"),
            Cell::quantity(body.angle, "rad"),
            Cell::quantity(body.t_angle, "s"),
        ]
    });
    let columns = ["body", "place", "at t", "angle", "at t"];
    let heading = format!(
        "motion to t = {} s, largest difference of each body:",
        motion.t_end
    );
    let mut blocks = vec![Block::Heading(heading), Block::table(columns, lines)];
    if bodies.len() > LISTED {
        let more = bodies.len() - LISTED;
        blocks.push(Block::sentence(format!(
            "and {more} more with equal or smaller differences"
        )));
    }
    blocks
}

/// Lists the loads with different peaks. The largest change comes first.
fn loaded(motion: &DiffMotion, files: [&str; 2]) -> Vec<Block> {
    let mut changed: Vec<&DiffLoad> = motion.loads.iter().collect();
    let all = changed.len();
    changed.retain(|load| load.change() > VISIBLE);
    if changed.is_empty() {
        let text = match all {
            0 => return Vec::new(),
            _ => "peak loads: no difference",
        };
        return vec![Block::Gap, Block::sentence(text)];
    }
    changed.sort_by(|a, b| b.change().total_cmp(&a.change()));
    let lines = changed.iter().take(LISTED).map(|own| {
        let value =
            |peak: Option<ExtremeDocument>| Cell::quantity(peak.map(|peak| peak.value), own.unit);
        let change = match (own.a, own.b) {
            (Some(a), Some(b)) if a.value != 0.0 => {
                format!("{:+.1} %", 100.0 * (b.value / a.value - 1.0)).replace('-', "−")
            }
            _ => String::new(),
        };
        let [name, load] = [&own.name, &own.load].map(|text| Cell::from(text.as_str()));
        [name, load, value(own.a), value(own.b), change.into()]
    });
    let [a, b] = files;
    let heading = "peak loads that differ:".to_owned();
    let table = Block::table(["load", "", a, b, ""], lines);
    let mut blocks = vec![Block::Heading(heading), table];
    let more = changed.len().saturating_sub(LISTED);
    if more > 0 {
        blocks.push(Block::sentence(format!(
            "and {more} more, which differ less"
        )));
    }
    blocks
}
