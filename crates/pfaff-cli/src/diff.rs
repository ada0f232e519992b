//! `pfaff diff`: compares two scenes. A difference is an answer, not a failure.

use std::path::Path;

use pfaff::difference::{self, VerdictChange};
use pfaff::report::AnalysisDocument;
use pfaff::report::documents::{
    DependencyDocument, DiffChange, DiffDocument, DiffMotion, DiffReaction, ReactionDocument,
};
use pfaff::{Comparison, Overrides, StudyError};

use crate::args::{Diff, Known};
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, columns, wrapped};
use crate::start::Start;

/// Number of bodies whose motion is listed; the document contains all.
const LISTED: usize = 12;

pub(crate) fn run(arguments: &Diff, console: &Console<'_>) -> Outcome {
    if [&arguments.a, &arguments.b]
        .iter()
        .all(|path| path.as_os_str() == "-")
    {
        return Err(Failure::input(
            "standard input is one scene; give the other one as a file".to_owned(),
        ));
    }
    Interrupt::ends_at_once()?;
    let Known { settings, .. } = &arguments.known;
    let read =
        |path| Ok::<_, Failure>(Source::read(path, settings, console)?.known(&arguments.known));
    let sources = [read(&arguments.a)?, read(&arguments.b)?];
    arguments.resources.apply(console);
    let [a, b] = &sources;
    let starts = [
        Start::of(a, arguments.resources)?,
        Start::of(b, arguments.resources)?,
    ];
    let [x, y] = [&starts[0].document, &starts[1].document];
    let comparison = Comparison::of(x, y);
    let motion = motion(&sources, &starts, arguments)?;
    if arguments.json {
        console.document(&document([x, y], &comparison, &motion))
    } else {
        console.print(&describe(&names(&sources), [x, y], &comparison, &motion))
    }
}

/// The differences of the motions, or why they are not compared.
type Motion = Result<DiffMotion, String>;

/// Compares the motions if both scenes have one.
fn motion(sources: &[Source; 2], starts: &[Start; 2], arguments: &Diff) -> Result<Motion, Failure> {
    for (source, start) in sources.iter().zip(starts) {
        if start.scene.simulate.is_none() {
            let name = &source.name;
            return Ok(Err(format!("`{name}` has no [simulate]")));
        }
    }
    let mut studies = Vec::new();
    for source in sources {
        let assembled = arguments.resources.assembled(source)?;
        match assembled.prepare(&Overrides::default()) {
            Ok(study) => studies.push(study),
            Err(e) => return Ok(Err(cannot_move(&source.name, &e))),
        }
    }
    Ok(match difference::motions(&studies[0], &studies[1]) {
        Ok(Some(motion)) => Ok(motion),
        Ok(None) => Err("one of the scenes has no [simulate]".to_owned()),
        Err(e) => Err(format!("one of them stopped: {e}")),
    })
}

fn cannot_move(name: &str, e: &StudyError) -> String {
    format!("`{name}` cannot be moved: {e}")
}

fn document<'a>(
    sides: [&'a AnalysisDocument; 2],
    c: &'a Comparison<'a>,
    motion: &'a Motion,
) -> DiffDocument<'a> {
    let changed = |v: &VerdictChange<'a>| DiffChange {
        name: v.name,
        a: v.sides[0].into(),
        b: v.sides[1].into(),
    };
    DiffDocument {
        ok: true,
        a: sides[0].into(),
        b: sides[1].into(),
        removed: c.removed.iter().copied().map(DiffReaction::named).collect(),
        added: c.added.iter().copied().map(DiffReaction::named).collect(),
        changed: c.verdicts.iter().map(changed).collect(),
        dependencies_gone: &c.gone,
        dependencies_new: &c.new,
        motion: motion.as_ref().ok(),
        motion_not_compared: motion.as_ref().err().map(String::as_str),
    }
}

fn describe(
    names: &[String; 2],
    sides: [&AnalysisDocument; 2],
    c: &Comparison<'_>,
    motion: &Motion,
) -> String {
    let mut text = numbers(names, sides);
    text.push('\n');
    if c.is_empty() {
        text.push_str("no joint, drive, verdict or dependency differs\n");
    } else {
        text.push_str(&verdicts(names, c));
        for (title, list) in [("dependencies gone", &c.gone), ("dependencies new", &c.new)] {
            text.push_str(&dependencies(title, list));
        }
    }
    text.push('\n');
    text.push_str(&match motion {
        Ok(motion) => moved(motion),
        Err(reason) => format!("motions not compared: {reason}\n"),
    });
    text
}

/// Names of the files, with their directories only if the names are equal otherwise.
fn names(sources: &[Source; 2]) -> [String; 2] {
    let whole = || sources.each_ref().map(|source| source.name.clone());
    let short = sources.each_ref().map(|source| {
        let name = Path::new(&source.name).file_name();
        name.map_or_else(
            || source.name.clone(),
            |name| name.to_string_lossy().into_owned(),
        )
    });
    if short[0] == short[1] { whole() } else { short }
}

/// Counts of both scenes and their difference.
fn numbers(names: &[String; 2], [a, b]: [&AnalysisDocument; 2]) -> String {
    let mut rows = vec![vec![
        String::new(),
        names[0].clone(),
        names[1].clone(),
        String::new(),
    ]];
    let counts = [
        ("bodies", a.configuration.bodies, b.configuration.bodies),
        ("joints and drives", a.reactions.len(), b.reactions.len()),
        ("rows", a.configuration.rows, b.configuration.rows),
        ("rank", a.ranks.rank, b.ranks.rank),
        ("redundancy", a.ranks.redundancy, b.ranks.redundancy),
        ("mobility", a.ranks.mobility, b.ranks.mobility),
        ("not unique", open(a), open(b)),
    ];
    let fragile = [a, b].map(|d| d.fragile_reactions().count());
    let fragile = (fragile != [0, 0]).then_some(("fragile", fragile[0], fragile[1]));
    // Of scenes without drives it is the same number again.
    let released = |d: &AnalysisDocument| d.ranks.freedoms.mobility_without_drives();
    let is_driven = released(a).is_some() || released(b).is_some();
    let [x, y] = [a, b].map(|d| released(d).unwrap_or(d.ranks.mobility));
    let released = is_driven.then_some(("mobility without drives", x, y));
    let (before, after) = counts.split_at(counts.len() - 1);
    for &(what, x, y) in before.iter().chain(&released).chain(after).chain(&fragile) {
        let change = match y.cmp(&x) {
            std::cmp::Ordering::Equal => String::new(),
            std::cmp::Ordering::Greater => format!("+{}", y - x),
            std::cmp::Ordering::Less => format!("−{}", x - y),
        };
        rows.push(vec![what.to_owned(), x.to_string(), y.to_string(), change]);
    }
    columns(&rows)
}

fn open(d: &AnalysisDocument) -> usize {
    let reactions = d.reactions.iter();
    reactions
        .filter(|r| r.wrench.verdict == "not_unique")
        .count()
}

/// Joints and drives that were added, removed or changed.
fn verdicts(names: &[String; 2], c: &Comparison<'_>) -> String {
    let mut rows = vec![vec![
        "reaction".to_owned(),
        names[0].clone(),
        names[1].clone(),
    ]];
    let absent = || "–".to_owned();
    for change in &c.verdicts {
        let [a, b] = change.sides;
        let both = a.kind != b.kind;
        rows.push(vec![change.name.to_owned(), words(a, both), words(b, both)]);
    }
    for gone in &c.removed {
        rows.push(vec![gone.name.clone(), words(gone, true), absent()]);
    }
    for came in &c.added {
        rows.push(vec![came.name.clone(), absent(), words(came, true)]);
    }
    match rows.len() {
        1 => String::new(),
        _ => columns(&rows),
    }
}

/// The verdict of a reaction, with its type if the types differ, and its components that are not
/// unique or fragile.
fn words(r: &ReactionDocument, with_type: bool) -> String {
    let verdict = r.said();
    let free = r
        .components
        .iter()
        .filter(|c| c.verdict.verdict == "not_unique");
    let free: Vec<&str> = free.map(|c| c.name).collect();
    let mut notes = free.join(", ");
    let names = r.fragile_names();
    if !names.is_empty() && names != [r.name.clone()] {
        let fragile = r.components.iter().filter(|c| c.data.fragile);
        let fragile: Vec<&str> = fragile.map(|c| c.name).collect();
        let separator = if notes.is_empty() { "" } else { "; " };
        notes.push_str(&format!("{separator}FRAGILE: {}", fragile.join(", ")));
    }
    let verdict = if notes.is_empty() {
        verdict
    } else {
        format!("{verdict} ({notes})")
    };
    if with_type {
        format!("{}, {verdict}", r.kind)
    } else {
        verdict
    }
}

fn dependencies(title: &str, list: &[&DependencyDocument]) -> String {
    if list.is_empty() {
        return String::new();
    }
    let mut text = format!("\n{title}:\n");
    for dependency in list {
        text.push_str(&wrapped("  - ", &dependency.text));
    }
    text
}

/// Bodies by the distance of their motions, the largest first.
fn moved(motion: &DiffMotion) -> String {
    if motion.bodies.is_empty() {
        return "no body has the same name in both scenes: no motion to compare\n".to_owned();
    }
    let mut bodies: Vec<_> = motion.bodies.iter().collect();
    bodies.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    let mut text = format!(
        "motion to t = {} s, largest difference of each body:\n",
        motion.t_end
    );
    let mut rows = vec![
        ["body", "place (m)", "at t (s)", "angle (rad)", "at t (s)"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for body in bodies.iter().take(LISTED) {
        let mut row = vec![body.body.clone()];
        for (value, t) in [(body.distance, body.t_distance), (body.angle, body.t_angle)] {
            row.push(format!("{value:.1e}"));
            row.push(format!("{t:.3}"));
        }
        rows.push(row);
    }
    text.push_str(&columns(&rows));
    if bodies.len() > LISTED {
        text.push_str(&format!(
            "and {} more, none farther apart\n",
            bodies.len() - LISTED
        ));
    }
    text
}
