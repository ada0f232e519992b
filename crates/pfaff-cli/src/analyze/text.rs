//! The document of an analysis in words and columns: what a designer wants to know first comes first.

use pfaff::report::AnalysisDocument;
use pfaff::report::documents::{
    ComponentDocument, DistributionDocument, MakeUniqueDocument, MixingDocument, ReactionDocument,
    ValueDocument, VerdictDocument,
};

use super::{along, rank};
use crate::output::{columns, count, wrapped};

/// Ways that are listed for a reaction nobody asked about.
const WAYS: usize = 1;

/// Reactions for which they are listed.
pub(super) const HINTS: usize = 8;

pub(super) fn describe(d: &AnalysisDocument, hints: &[MakeUniqueDocument]) -> String {
    let mut out = format!(
        "{} at t = {} s\n{}, {}, {}: {} holonomic, {} nonholonomic\n",
        d.scene,
        d.time,
        count(d.bodies, "body", "bodies"),
        count(d.coordinates, "coordinate", "coordinates"),
        count(d.rows, "row", "rows"),
        d.holonomic_rows,
        d.nonholonomic_rows,
    );
    out.push_str(&rank::describe(d));
    out.push_str(&verdicts(d));
    out.push_str(&groups(d));
    out.push_str(&frames(d));
    out.push_str(&why(d));
    out.push_str(&deletions(d, hints));
    out.push_str(&choices(&d.choices));
    out.extend(d.along.as_ref().map(along::describe));
    let told = |warning: &&String| {
        let reason = d.evidence.reason.as_ref();
        !reason.is_some_and(|reason| warning.contains(reason.as_str()))
    };
    for warning in d.warnings.iter().filter(told) {
        out.push('\n');
        out.push_str(&wrapped("warning: ", warning));
    }
    out
}

/// `not_unique` as it is said.
fn spoken(word: &str) -> String {
    word.replace('_', " ")
}

fn verdicts(d: &AnalysisDocument) -> String {
    let mut out = "\n".to_owned();
    let words = ["unique", "not_unique", "undecided"];
    let named = words.map(|word| {
        let reactions = d.reactions.iter().filter(|r| r.wrench.verdict == word);
        let names: Vec<&str> = reactions.map(|r| r.name.as_str()).collect();
        (word, names)
    });
    for (word, names) in named.iter().filter(|(_, names)| !names.is_empty()) {
        let lead = format!("{:<12}", format!("{}:", spoken(word)));
        out.push_str(&wrapped(&lead, &names.join(", ")));
    }
    let header = [
        "reaction",
        "type",
        "rows",
        "verdict",
        "margin",
        "components",
    ];
    let mut table = vec![header.map(str::to_owned).to_vec()];
    table.extend(d.reactions.iter().map(line));
    out.push('\n');
    out.push_str(&columns(&table));
    out
}

fn line(r: &ReactionDocument) -> Vec<String> {
    let rows = match r.rows.as_slice() {
        [] => String::new(),
        [row] => row.to_string(),
        [first, .., last] => format!("{first}–{last}"),
    };
    let components = match r.wrench.verdict {
        "unique" => String::new(),
        _ => each(&r.components) + &oblique(r),
    };
    vec![
        r.name.clone(),
        r.kind.to_owned(),
        rows,
        spoken(r.wrench.verdict),
        margin(&r.wrench),
        components,
    ]
}

/// What is left of a margin by rounding is no number for people; the document has it.
fn margin(v: &VerdictDocument) -> String {
    match v.verdict {
        "unique" => "~0".to_owned(),
        _ => format!("{:.1e}", v.margin),
    }
}

fn each(components: &[ComponentDocument]) -> String {
    let words = components.iter();
    let words: Vec<String> = words
        .map(|c| format!("{} {}", c.name, spoken(c.verdict.verdict)))
        .collect();
    words.join(", ")
}

/// Unique directions between the axes: the components do not show them.
fn oblique(r: &ReactionDocument) -> String {
    let is_oblique = |d: &&Vec<f64>| d.iter().filter(|x| **x != 0.0).count() > 1;
    let told = r.unique_directions.iter().filter(is_oblique).map(|d| {
        let terms = d.iter().zip(&r.components).filter(|(x, _)| **x != 0.0);
        let terms: Vec<String> = terms.map(|(x, c)| format!("{x:.3}·{}", c.name)).collect();
        format!("; {} unique", terms.join(" + ").replace("+ -", "− "))
    });
    told.collect()
}

fn groups(d: &AnalysisDocument) -> String {
    let mut out = String::new();
    for g in &d.groups {
        let mut text = format!(
            "{} (margin {})",
            spoken(g.verdict.verdict),
            margin(&g.verdict)
        );
        if !g.components.is_empty() {
            text.push_str(&format!(": {}", each(&g.components)));
        }
        out.push_str(&wrapped(&format!("{}: ", g.name), &text));
    }
    match out.is_empty() {
        true => out,
        false => format!("\nSums and groups:\n{out}"),
    }
}

/// Only of what is not unique: the rest is unique in every frame.
fn frames(d: &AnalysisDocument) -> String {
    let header = ["reaction", "frame", "first axis", "components"];
    let mut table = vec![header.map(str::to_owned).to_vec()];
    let open = d.reactions.iter().filter(|r| r.wrench.verdict != "unique");
    for r in open {
        for f in &r.frames {
            let [x, y] = f.axes[0];
            table.push(vec![
                r.name.clone(),
                spoken(f.frame),
                format!("({x:.3}, {y:.3})"),
                each(&f.components),
            ]);
        }
    }
    match table.len() {
        1 => String::new(),
        _ => format!("\nIn other frames:\n{}", columns(&table)),
    }
}

fn why(d: &AnalysisDocument) -> String {
    if d.dependencies.is_empty() {
        return String::new();
    }
    let mut out = "\nWhy:\n".to_owned();
    // One dependency among all that mix says it all.
    let is_told = |m: &&MixingDocument| d.dependencies.iter().any(|x| x.joints == m.reactions);
    let mixing = d
        .mixing
        .iter()
        .filter(|m| m.redundancy > 1 || !is_told(m))
        .map(|m| &m.text);
    for text in mixing.chain(d.dependencies.iter().map(|x| &x.text)) {
        out.push_str(&wrapped("- ", text));
    }
    out
}

fn deletions(d: &AnalysisDocument, hints: &[MakeUniqueDocument]) -> String {
    let mut out = String::new();
    if !hints.is_empty() && d.make_unique.is_empty() {
        out.push_str("\nWhat would make it unique (a decision of the designer, not a finding):\n");
        for hint in hints.iter().take(HINTS) {
            out.push_str(&wrapped(
                &format!("- {}: ", hint.reaction),
                &ways(hint, WAYS),
            ));
        }
    }
    if hints.len() > HINTS && d.make_unique.is_empty() {
        out.push_str("- others: `--make-unique NAME`\n");
    }
    for wanted in &d.make_unique {
        out.push_str(&format!(
            "\nTo make {} unique, with the motion as it is ({}):\n",
            wanted.reaction,
            match wanted.allowed {
                "sensible" => "no joint of several rows loses all of them",
                "whole" => "joints and drives as a whole",
                _ => "of the rows allowed",
            }
        ));
        match wanted.ways.as_slice() {
            [] => out.push_str(&wrapped("- ", &ways(wanted, 0))),
            all => all
                .iter()
                .for_each(|way| out.push_str(&wrapped("- ", &way.text))),
        }
        if !wanted.complete && wanted.reason.is_none() {
            out.push_str("- and others: the search was not finished\n");
        }
    }
    let Some(eliminations) = d.eliminations.as_ref().filter(|_| d.redundancy > 0) else {
        return out;
    };
    let number = eliminations.count.map(|n| n.to_string());
    let reason = eliminations.reason.clone().unwrap_or_default();
    let sets = match &eliminations.sets {
        None => " (`--eliminations` lists them)".to_owned(),
        Some(sets) => {
            let sets = sets.iter().map(|set| {
                let rows: Vec<String> = set.iter().map(usize::to_string).collect();
                format!("{{{}}}", rows.join(","))
            });
            format!(": {}", sets.collect::<Vec<_>>().join(" "))
        }
    };
    let rows = count(d.redundancy, "row", "rows");
    let sentence = match number {
        Some(n) => format!("{n} sets of {rows} can be eliminated without a change of motion{sets}"),
        None => format!("sets of {rows} that can be eliminated are not counted: {reason}{sets}"),
    };
    out.push('\n');
    out.push_str(&wrapped("", &sentence));
    out
}

/// The first ways in words, and how many more there are.
fn ways(found: &MakeUniqueDocument, most: usize) -> String {
    if let Some(reason) = &found.reason {
        return format!("not known: {reason}");
    }
    let texts: Vec<&str> = found
        .ways
        .iter()
        .take(most)
        .map(|w| w.text.as_str())
        .collect();
    let more = found.ways.len() - texts.len();
    match (texts.as_slice(), found.complete) {
        ([], true) => "nothing that is allowed to be deleted makes it so".to_owned(),
        ([], false) => "nothing was found in the sets that were tried".to_owned(),
        (texts, _) if more == 0 => texts.join("; or "),
        (texts, _) => format!(
            "{}; or {more} other {} (`--make-unique \"{}\"`)",
            texts.join("; or "),
            if more == 1 { "way" } else { "ways" },
            found.reaction
        ),
    }
}

/// Facts once; what depends on a choice in the column of the choice.
fn choices(choices: &[DistributionDocument]) -> String {
    let Some(first) = choices.first() else {
        return String::new();
    };
    let mut header = ["reaction", "component", "determined"]
        .map(str::to_owned)
        .to_vec();
    header.extend((1..=choices.len()).map(|k| format!("choice {k}")));
    let mut table = vec![header];
    let mut suspicious = Vec::new();
    for (i, reaction) in first.reactions.iter().enumerate() {
        for (j, component) in reaction.components.iter().enumerate() {
            let name = component.name.unwrap_or_default();
            let mut cells = vec![reaction.name.clone(), name.to_owned()];
            let number = |v: &ValueDocument| format!("{:>12.6e}", v.value);
            let is_fact = component.choice.is_none();
            match is_fact {
                true => cells.push(number(component)),
                false => {
                    cells.push(String::new());
                    let all = choices.iter();
                    cells.extend(all.map(|d| number(&d.reactions[i].components[j])));
                }
            }
            if component.nature == Some(if is_fact { "choice" } else { "fact" }) {
                suspicious.push(format!("{name} of {}", reaction.name));
            }
            table.push(cells);
        }
    }
    let mut out = format!(
        "\nReactions on the first body (N, N·m):\n{}",
        columns(&table)
    );
    for (k, choice) in choices.iter().enumerate() {
        out.push_str(&wrapped(&format!("choice {}: ", k + 1), &choice.label));
    }
    let sentence = match suspicious.as_slice() {
        [] => "A change of units leaves what is determined as it is, and changes the rest, as it must.".to_owned(),
        names => format!("warning: under a change of units {} behave otherwise than their verdicts say: do not trust them", names.join(", ")),
    };
    out.push_str(&wrapped("", &sentence));
    out
}
