//! The loads that contacts permit: joints that only push or pull, and contacts that grip.

mod answer;
mod fault;
mod tips;

use model::words::{clause, listed, marked};
use model::{ConstraintId, Layout, System};
use report::ByName;
use solvability::{Group, PermittedError, PermittedReactions, Solution, Term, lifted};

pub use answer::{
    CertificateDocument, ConditionDocument, ContactsDocument, GripDocument, PermittedRangeDocument,
};

pub(crate) use fault::violated;

use crate::configuration::ConfigurationAnalysis;
use crate::documents::AnalysisDocument;
use crate::error::StudyError;
use crate::words::{Block, Cell, load_unit};
use tips::tips;

/// Describes the loads that contacts permit. Returns `None` if there are neither one-sided joints
/// nor contacts that grip.
pub(crate) fn blocks(d: &AnalysisDocument) -> Option<Vec<Block>> {
    let answer = d.answers.contacts.as_ref()?;
    if let Some(reason) = &answer.reason {
        return Some(vec![Block::sentence(format!("no ranges: {reason}"))]);
    }
    let mut out: Vec<Block> = answer.tips.iter().map(Block::sentence).collect();
    if !answer.lifts.is_empty() {
        out.push(Block::sentence(format!(
            "{} now: the reactions above are not those of the motion that follows",
            clause(&answer.lifts, ["opens", "open"])
        )));
    }
    out.extend(ranges(d));
    out.extend(answer.grips.iter().map(grip));
    for (name, reason) in &answer.without.0 {
        out.push(Block::after("no range: ", format!("`{name}`: {reason}")));
    }
    if out.is_empty() {
        let all = "all one-sided joints stay closed, and their reactions are unique";
        out.push(Block::sentence(all));
    }
    Some(out)
}

/// Adds the loads that contacts permit to a document with groups of these combinations, if the
/// scene has one-sided joints or grip.
pub(crate) fn add(
    combine: &[String],
    of: &ConfigurationAnalysis<'_>,
    document: &mut AnalysisDocument,
) -> Result<(), StudyError> {
    if !of.mechanism.layout().has_contact_limits() {
        return Ok(());
    }
    let mut answer = ContactsDocument::default();
    let filled = of.solution().map_err(|e| e.to_string());
    let filled = filled.and_then(|solution| {
        let filled = fill(combine, (of, solution), document, &mut answer);
        filled.map_err(|e| e.to_string())
    });
    answer.reason = filled.err();
    document.answers.contacts = Some(answer);
    Ok(())
}

/// Fills in the answer and the ranges of the document.
fn fill(
    combine: &[String],
    (of, solution): (&ConfigurationAnalysis<'_>, &Solution),
    document: &mut AnalysisDocument,
    answer: &mut ContactsDocument,
) -> Result<(), PermittedError> {
    let layout = of.mechanism.layout();
    let Some(found) = of.permitted(solution)? else {
        return Ok(());
    };
    let impossible = found.impossible()?;
    let proofs = impossible.iter();
    answer.impossible = proofs
        .flat_map(|proof| answer::documents(&proof.weights, layout))
        .collect();
    let mut opening = impossible
        .iter()
        .filter(|proof| proof.is_opening())
        .peekable();
    let (t, q) = (of.analysis.time, &of.state.q[..]);
    if opening.peek().is_some() {
        let found = lifted(of.mechanism, (t, q, &of.state.v[..]));
        let lifts = found.as_ref().map_or(&[][..], |found| &found.joints);
        let motions = opening.map(|proof| tips((of.mechanism, q), t, proof, lifts));
        let mut words = motions.collect::<Vec<_>>().join("; ");
        if let Err(e) = &found {
            words += &format!("; which joints open is not decided: {e}");
        }
        let name = |id: ConstraintId| layout.groups[id.0].name.clone();
        answer.lifts = lifts.iter().map(|(id, _)| name(*id)).collect();
        let gaps = lifts.iter().map(|(id, a)| (name(*id), *a));
        answer.gap_accelerations = ByName(gaps.collect());
        answer.tips = Some(words);
    }
    let grips = found.grips()?;
    answer.grips = grips.iter().map(|g| GripDocument::new(g, layout)).collect();
    of_reactions(&found, document, answer, layout);
    if let Ok(groups) = of.requested(combine) {
        for (group, (_, asked)) in document.groups.iter_mut().zip(&groups) {
            match found.group(asked) {
                Ok(numbers) => {
                    let open = numbers.into_iter().filter(|(_, range)| !range.is_unique());
                    for (number, range) in open {
                        let range = Some(PermittedRangeDocument::new(&range, layout));
                        match group.components.iter_mut().find(|c| c.name == number) {
                            Some(own) => own.range = range,
                            None => group.range = range,
                        }
                    }
                }
                Err(e) => answer.without.0.push((group.name.clone(), e.to_string())),
            }
        }
    }
    Ok(())
}

/// Adds the ranges of all components that are not unique.
fn of_reactions(
    found: &PermittedReactions<'_, '_>,
    document: &mut AnalysisDocument,
    answer: &mut ContactsDocument,
    layout: &Layout,
) {
    for (id, reaction) in layout.constraint_ids().zip(&mut document.reactions) {
        for component in &mut reaction.components {
            if component.verdict.verdict == "unique" {
                continue;
            }
            let term = Term {
                reaction: id,
                component: component.name.to_owned(),
                coefficient: 1.0,
            };
            match found.group(&Group::Combination(vec![term])) {
                Ok(ranges) => {
                    let range = ranges.first();
                    component.range = range.map(|(_, r)| PermittedRangeDocument::new(r, layout));
                }
                Err(e) => {
                    let name = format!("{}.{}", reaction.name, component.name);
                    answer.without.0.push((name, e.to_string()));
                }
            }
        }
    }
}

/// The table of ranges.
fn ranges(d: &AnalysisDocument) -> Option<Block> {
    let owners = d.reactions.iter().map(|r| (&r.name, &r.components));
    let owners = owners.chain(d.groups.iter().map(|g| (&g.name, &g.components)));
    let each = owners.flat_map(|(name, components)| components.iter().map(move |c| (name, c)));
    let each =
        each.filter_map(|(name, c)| Some((name, c.name, load_unit(c.name), c.range.as_ref()?)));
    let sums = d.groups.iter().filter_map(|g| {
        let unit = g.unit.unwrap_or_default();
        Some((&g.name, "sum", unit, g.range.as_ref()?))
    });
    let lines = each.chain(sums).filter(|(.., range)| range.kind != "empty");
    let lines: Vec<[Cell; 5]> = lines
        .map(|(name, component, unit, range)| {
            let end = |value: Option<f64>| match value {
                Some(value) => Cell::quantity(value, unit),
                None => "no limit".into(),
            };
            let limits = match range.kind {
                "point" => "unique by its signs".to_owned(),
                _ => {
                    let ends = range.certificate.iter().flatten();
                    let ends = ends.map(|end| at(&end.conditions));
                    ends.collect::<Vec<_>>().join(" … ")
                }
            };
            [
                name.as_str().into(),
                component.into(),
                end(range.lowest),
                end(range.highest),
                limits.into(),
            ]
        })
        .collect();
    let columns = [
        "reaction",
        "component",
        "lowest",
        "highest",
        "at the ends, zero",
    ];
    (!lines.is_empty()).then(|| Block::table(columns, lines))
}

/// The conditions that are at their limit at an end of a range.
fn at(conditions: &[ConditionDocument]) -> String {
    let name = |c: &ConditionDocument| match c.condition {
        "grips" => format!("grip of {}", c.joint),
        _ => c.joint.clone(),
    };
    match conditions {
        [] => "–".to_owned(),
        _ => listed(&conditions.iter().map(name).collect::<Vec<_>>()),
    }
}

fn grip(grip: &GripDocument) -> Block {
    let who = marked(&grip.joints);
    let (hold, slip) = match grip.joints.len() {
        1 => ("holds", "slips"),
        _ => ("hold", "slip"),
    };
    let verdict = match grip.holds {
        Some("always") => format!("{who} {hold} for every sharing of the loads"),
        Some("sometimes") => {
            format!("{who} {hold} for some sharing of the loads (no promise)")
        }
        Some("never") => format!("{who} {slip} for every sharing of the loads"),
        Some(_) => format!("{who}: undecided, the friction is at the limit"),
        None => format!("{who}: no verdict, because one-sided joints open"),
    };
    let least = match grip.least_grip {
        Some([lowest, highest]) if highest - lowest <= 1e-6 * highest => {
            format!("; the least common coefficient of friction is {highest:.4}")
        }
        Some([lowest, highest]) => {
            format!(
                "; the least common coefficient of friction is between {lowest:.4} and {highest:.4}"
            )
        }
        None if grip.holds.is_some() => "; no coefficient of friction is large enough".to_owned(),
        None => String::new(),
    };
    Block::sentence(format!("{verdict}{least}"))
}
