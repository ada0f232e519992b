//! The document of an analysis as text and tables. The most important facts for a designer come
//! first.

use model::words::{digits, marked, quantity, rough};
use std::collections::BTreeSet;

use crate::documents::AnalysisDocument;
use crate::documents::{
    GroupDocument, MixingDocument, ReactionDocument, ValueDocument, VerdictDocument,
};

use super::additions::ADDITIONS;
use super::document::Hints;
use super::phrases::{LINES, coordinates, each, hanging, spoken};
use super::{along, counts, data, deletions, numbers, rank, remedies};
use crate::words::{Block, Cell, count, count_of_rows, grouped, load_unit};

/// Number of reasons that are listed.
const REASONS: usize = 10;

/// Number of self-stresses of a set of joints that are listed.
const LISTED: usize = 5;

/// Number of warnings that are listed.
const WARNINGS: usize = 12;

pub(super) fn of(d: &AnalysisDocument, hints: &Hints) -> Vec<Block> {
    let has_lines = d.reactions.len() <= LINES;
    let mut out = vec![Block::sentence(format!(
        "{} at t = {} s",
        d.configuration.scene, d.configuration.time
    ))];
    out.extend(match d.reactions.as_slice() {
        [] => vec![Block::sentence(
            "no joint or drive, so there are no reactions",
        )],
        _ if has_lines => vec![table(d), margins()],
        _ => counts::verdicts(d),
    });
    out.push(Block::Gap);
    let fragile = fragile(d);
    if !fragile.is_empty() {
        out.extend(fragile);
        out.push(Block::Gap);
    }
    out.extend(elsewhere(d));
    out.push(size(d));
    out.extend(rank::of(d));
    out.extend(data::of(d));
    out.extend(groups(d));
    out.extend(ADDITIONS.iter().flat_map(|addition| addition.words(d)));
    out.extend(centres(d));
    out.extend(why(d));
    let sentences = hints.sentences.iter().map(Block::sentence);
    let beyond: Vec<Block> = sentences.chain(remedies::words(d)).collect();
    if let Some(Block::Sentence { .. }) = beyond.first() {
        out.push(Block::Gap);
    }
    out.extend(beyond);
    out.extend(deletions::of(d, &hints.ways));
    out.extend(stresses(d));
    out.extend(numbers::of(d));
    out.extend(d.answers.along.iter().flat_map(along::of));
    let is_new = |warning: &&String| {
        let reason = d.evidence.reason.as_ref();
        !reason.is_some_and(|reason| warning.contains(reason.as_str()))
    };
    let warnings: Vec<&String> = d.warnings.iter().filter(is_new).collect();
    for warning in warnings.iter().take(WARNINGS) {
        out.extend([Block::Gap, Block::after("warning: ", *warning)]);
    }
    if warnings.len() > WARNINGS {
        let more = warnings.len() - WARNINGS;
        out.push(Block::sentence(format!(
            "and {more} more warnings (`--json` prints all)"
        )));
    }
    // The notes on reactions from the definitions of the joints.
    for note in &d.notes {
        out.extend([Block::Gap, Block::after("note: ", &note.text)]);
    }
    out
}

/// The size of the analysed mechanism, and its ranks.
fn size(d: &AnalysisDocument) -> Block {
    let (c, ranks) = (&d.configuration, &d.ranks);
    let velocities = match c.velocities {
        // In the plane, both numbers are three times the number of bodies.
        n if n == c.coordinates => String::new(),
        n => format!(", {n} velocities"),
    };
    let bodies = count(c.bodies, "body", "bodies");
    let coordinates = count(c.coordinates, "coordinate", "coordinates");
    let rows = count_of_rows(c.holonomic_rows, c.nonholonomic_rows);
    let without = ranks.freedoms.without_drives.as_ref();
    let rank = match without {
        None => ranks.rank.to_string(),
        Some(without) => format!(
            "{} ({} without {})",
            ranks.rank,
            without.rank,
            without.possessive()
        ),
    };
    let redundancy = match without {
        Some(without) if without.redundancy != ranks.redundancy => {
            format!("{} ({} without)", ranks.redundancy, without.redundancy)
        }
        _ => ranks.redundancy.to_string(),
    };
    Block::sentence(format!(
        "{bodies}, {coordinates}{velocities}, {rows}: rank {rank}, redundancy {redundancy}, {}",
        ranks.freedoms.summary(ranks.mobility),
    ))
}

/// Lists the reaction components whose verdict at this configuration differs from the verdict at
/// most other configurations. Both verdicts are listed.
fn elsewhere(d: &AnalysisDocument) -> impl Iterator<Item = Block> {
    let differing = d.reactions.iter().flat_map(|r| r.differing());
    let verdicts = grouped(differing.map(|(name, verdicts)| (verdicts, name)));
    verdicts.into_iter().map(|([here, generic], names)| {
        let [here, generic] = [here, generic].map(spoken);
        let lead = format!("{here} here, {generic} elsewhere: ");
        Block::after(lead, names.join(", "))
    })
}

/// Reactions of the same type with the same verdicts have one line.
fn table(d: &AnalysisDocument) -> Block {
    let alike = grouped(d.reactions.iter().map(|r| {
        let components = match r.wrench.verdict {
            "unique" => of_unique(r),
            _ => each(&r.components) + &oblique(r),
        };
        ([r.kind.to_owned(), r.said(), components], r)
    }));
    let header = [
        "reaction",
        "type",
        "rows",
        "verdict",
        "margin",
        "components",
    ];
    let lines = alike.into_iter().map(|([kind, verdict, components], all)| {
        let names = all.iter().map(|r| r.name.clone()).collect();
        let rows = all.iter().map(|r| ranges(&r.rows)).collect();
        let margins = all.iter().map(|r| &r.wrench);
        let least = margins.clone().min_by(|a, b| a.margin.total_cmp(&b.margin));
        let greatest = margins.max_by(|a, b| a.margin.total_cmp(&b.margin));
        let [least, greatest] = [least, greatest].map(|v| v.map_or(String::new(), margin));
        let margin = if least == greatest {
            least
        } else {
            format!("{least} … {greatest}")
        };
        [
            Cell::List(names),
            kind.into(),
            Cell::List(rows),
            verdict.into(),
            margin.into(),
            components.into(),
        ]
    });
    Block::table(header, lines)
}

/// Formats ascending numbers of rows as ranges, such as `59 and 65–66`.
fn ranges(rows: &[usize]) -> String {
    let adjacent = rows.chunk_by(|row, next| row + 1 == *next);
    let ranges = adjacent.map(|rows| match rows {
        [first, .., last] => format!("{first}–{last}"),
        [row] => row.to_string(),
        [] => String::new(),
    });
    ranges.collect::<Vec<_>>().join(" and ")
}

/// Lists the data on which ill-determined reactions depend.
fn fragile(d: &AnalysisDocument) -> Vec<Block> {
    let sentences = &d.fragile;
    let first = sentences.iter().take(REASONS);
    let mut out: Vec<Block> = first.map(|text| Block::after("FRAGILE: ", text)).collect();
    if sentences.len() > REASONS {
        let more = sentences.len() - REASONS;
        out.push(Block::sentence(format!(
            "and {more} more sentences (`--json` prints all)"
        )));
    }
    out
}

/// A margin that consists only of rounding error is not printed; the document contains it. The
/// margin of a reaction that is unique only within a tolerance is printed.
fn margin(v: &VerdictDocument) -> String {
    match v.verdict {
        "unique" if !v.within_tolerance => "~0".to_owned(),
        // Formats a number with two digits, without an exponent if it is short enough.
        _ if (1e-2..1e2).contains(&v.margin) => {
            let decimals = if v.margin < 1.0 { 2 } else { 1 };
            format!("{:.decimals$}", v.margin)
        }
        _ => rough(v.margin),
    }
}

/// Lists the components of a unique reaction. If the reaction is unique only within a tolerance,
/// the verdict and the margin of the reaction already state this.
fn of_unique(r: &ReactionDocument) -> String {
    let mut components = r.components.clone();
    for component in &mut components {
        component.verdict.within_tolerance = false;
    }
    each(&components)
}

/// Explains the margins of the table.
fn margins() -> Block {
    let meaning = "the part of a self-stress that acts in the joint or drive, for scaled rows; ~0: zero within rounding";
    let legend = Block::Legend("margin".to_owned(), meaning.to_owned());
    Block::Detail(Box::new(legend))
}

/// Lists unique directions that are not parallel to an axis, because the components do not show
/// these directions.
fn oblique(r: &ReactionDocument) -> String {
    let is_oblique = |d: &&Vec<f64>| d.iter().filter(|x| **x != 0.0).count() > 1;
    let names = r.direction_components();
    let directions = r.unique_directions.iter().flatten().enumerate();
    let words = directions.filter(|(_, d)| is_oblique(d)).map(|(k, d)| {
        let terms = d.iter().zip(&names).filter(|(x, _)| **x != 0.0);
        let terms: Vec<String> = terms
            .map(|(x, name)| format!("{}·{name}", digits(*x, 3)))
            .collect();
        let fragile = r.direction_sensitivities.get(k).map_or("", hanging);
        format!(
            "; {} unique{fragile}",
            terms.join(" + ").replace("+ −", "− ")
        )
    });
    words.collect()
}

fn groups(d: &AnalysisDocument) -> Vec<Block> {
    let mut out = Vec::new();
    for g in &d.groups {
        let mut text = format!(
            "{}{} (margin {})",
            spoken(g.verdict.verdict),
            // If the sum is not unique, its components show the verdicts.
            if g.verdict.verdict == "unique" {
                hanging(&g.data)
            } else {
                ""
            },
            margin(&g.verdict)
        );
        text.push_str(&numbers_of(g));
        out.push(Block::after(format!("{}: ", g.name), text));
    }
    if !out.is_empty() {
        out.insert(0, Block::Heading("Sums and groups:".to_owned()));
    }
    out
}

/// Formats the number of a value. The text is `none` if the value has no number.
fn number(value: &ValueDocument, unit: &str) -> String {
    let number = value.value.in_solution();
    number.map_or("none".to_owned(), |x| {
        quantity(x, unit).trim_end().to_owned()
    })
}

/// Lists the components of a group. A unique component has its number, if the number is known.
/// Every other component has its verdict.
fn numbers_of(g: &GroupDocument) -> String {
    let value = |name: &str| {
        let given = |v: &&ValueDocument| {
            v.value.in_solution().is_some() || v.value.no_finite_reaction().is_some()
        };
        let mut all = g.values.iter();
        all.find(|v| v.name == Some(name)).filter(given)
    };
    if let Some(sum) = value("sum") {
        return format!(": {}", number(sum, g.unit.unwrap_or_default()));
    }
    let components = g.components.iter().map(|c| match value(c.name) {
        Some(known) => {
            let (value, fragile) = (number(known, load_unit(c.name)), hanging(&c.data));
            format!("{} = {value}{fragile}", c.name)
        }
        None => format!("{} {}", c.name, spoken(c.verdict.verdict)),
    });
    let components: Vec<String> = components.collect();
    let about = g.about.as_deref().map(coordinates);
    match (components.as_slice(), about) {
        ([], _) => String::new(),
        (all, Some(about)) => {
            let torque = if all.len() > 3 { "moments" } else { "T" };
            format!(": {}; {torque} about {about}", all.join(", "))
        }
        (all, None) => format!(": {}", all.join(", ")),
    }
}

/// Lists points about which moments are unique.
fn centres(d: &AnalysisDocument) -> Option<Block> {
    let centres = d.reactions.iter().filter_map(|r| {
        let centre = coordinates(r.moment_unique_about.as_ref()?);
        Some((centre, r.name.as_str()))
    });
    let centres = grouped(centres).into_iter();
    let centres = centres.map(|(centre, names)| format!("{} about {centre}", marked(&names)));
    let centres: Vec<String> = centres.collect();
    let lead = "moments that are unique, but not about the reference point: ";
    (!centres.is_empty()).then(|| Block::sentence(format!("{lead}{}", centres.join("; "))))
}

fn why(d: &AnalysisDocument) -> Vec<Block> {
    let (mixing, dependencies) = (&d.reasons.mixing, &d.reasons.dependencies);
    if dependencies.is_empty() {
        return Vec::new();
    }
    // The joints of a large set can load each other in so many ways that the list is less useful
    // than the sums.
    let is_large = |m: &&MixingDocument| m.redundancy > LISTED;
    let large: Vec<&MixingDocument> = mixing.iter().filter(is_large).collect();
    let is_in_large = |joints: &[String]| {
        large
            .iter()
            .any(|m| joints.iter().all(|joint| m.reactions.contains(joint)))
    };
    let listed = dependencies.iter().filter(|x| !is_in_large(&x.joints));
    // If one dependency contains all rows of a set, the dependency is listed in place of the set.
    let of_dependencies: BTreeSet<&Vec<String>> = listed.clone().map(|x| &x.joints).collect();
    let is_said = |m: &&MixingDocument| of_dependencies.contains(&m.reactions);
    let sets = mixing.iter().filter(|m| m.redundancy > 1 || !is_said(m));
    let reasons: Vec<&String> = sets
        .map(|m| &m.text)
        .chain(listed.map(|x| &x.text))
        .collect();
    let mut out = vec![Block::Heading("Why:".to_owned())];
    let item = |text: &str| Block::after("- ", text);
    out.extend(reasons.iter().take(REASONS).map(|text| item(text)));
    if reasons.len() > REASONS {
        let more = reasons.len() - REASONS;
        out.push(item(&format!("and {more} more (`--json` prints all)")));
    }
    out
}

/// Lists the loads of each self-stress.
fn stresses(d: &AnalysisDocument) -> Vec<Block> {
    let of = |k: usize| {
        let loads = d.reactions.iter().flat_map(move |r| r.loads_in(k));
        let loads = loads.map(|(name, value)| {
            let unit = name.rsplit('.').next().map_or("", load_unit);
            format!("`{name}` = {}", quantity(value, unit))
        });
        loads.collect::<Vec<_>>().join(", ")
    };
    let all = (0..d.reasons.dependencies.len()).map(of);
    let mut out: Vec<Block> = all
        .filter(|loads| !loads.is_empty())
        .map(|loads| Block::detail("- ", loads))
        .collect();
    if !out.is_empty() {
        let heading =
            "Self-stresses (loads on the first body of each joint, about its reference point):";
        out.insert(
            0,
            Block::Detail(Box::new(Block::Heading(heading.to_owned()))),
        );
    }
    out
}
