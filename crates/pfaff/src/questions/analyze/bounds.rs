//! Bounds of the reactions that the model does not determine, for joints of any stiffness.

mod along;
mod answer;

use model::reaction::ConstraintGroup;
use model::words::{listed, marked, range};
use model::{ConstraintId, System};
use report::ByName;
use solvability::{BoundsError, ElasticBounds, Elasticity, Group, PartAnalysis, ReactionBounds};

pub use answer::{
    BoundsDocument, BoundsOfNumber, ElasticLoadDocument, MagnitudeDocument, RangeDocument,
};

use super::addition::{Addition, AnalysedMotion};
use super::options::Analyze;
use super::phrases::LINES;
use crate::configuration::ConfigurationAnalysis;
use crate::documents::analysis::components;
use crate::documents::{AlongDocument, AnalysisDocument, ComponentDocument};
use crate::error::StudyError;
use crate::refusal::Refusal;
use crate::words::{Block, Cell, grouped, load_unit};

/// Bounds for any stiffness.
pub(super) struct BoundsOfReactions;

impl Addition for BoundsOfReactions {
    fn check(&self, asked: &Analyze, of: &ConfigurationAnalysis<'_>) -> Result<(), Refusal> {
        elasticity(asked, of).map(|_| ())
    }

    fn add(
        &self,
        asked: &Analyze,
        of: &ConfigurationAnalysis<'_>,
        document: &mut AnalysisDocument,
    ) -> Result<(), StudyError> {
        // The options have been checked before.
        let Ok(Some(elasticity)) = elasticity(asked, of) else {
            return Ok(());
        };
        let reactions = document.reactions.iter().zip(&of.mechanism.layout().groups);
        let open = reactions.filter(|(r, _)| r.wrench.verdict != "unique");
        let open: Vec<&ConstraintGroup> = open.map(|(_, group)| group).collect();
        let has_tolerance = document.data.tolerance.is_some();
        let mut answer = BoundsDocument::new(&open, has_tolerance, elasticity.within.as_ref());
        if document.evidence.permanent == Some(false) {
            answer.reason = Some(SINGULAR.to_owned());
        } else if !of.analysis.decision.is_decided() {
            answer.reason = Some(BoundsError::Rank.to_string());
        } else {
            answer.rigid = elasticity.rigid.iter().map(|id| name(of, *id)).collect();
            let solution = of.solution()?;
            let found = of.bounds(solution, &elasticity).of_all_parts();
            of_reactions(of, &found, document, &mut answer);
            let groups = of.requested(&asked.combine)?;
            for (group, (_, asked)) in document.groups.iter_mut().zip(&groups) {
                let numbers = found.group(asked).unwrap_or_else(|e| {
                    answer.without.0.push((group.name.clone(), e.to_string()));
                    Vec::new()
                });
                for (number, bounds) in numbers {
                    answer.complete &= bounds.complete;
                    let own = group.components.iter_mut().find(|c| c.name == number);
                    let own = own.map_or(&mut group.elastic, |c| &mut c.elastic);
                    *own = RangeDocument::new(&bounds, of.mechanism.layout());
                }
            }
            answer.eliminations = found.sets();
        }
        document.answers.bounds = Some(answer);
        Ok(())
    }

    fn add_along(
        &self,
        asked: &Analyze,
        of: &AnalysedMotion<'_>,
        document: &mut AlongDocument,
    ) -> Result<(), Refusal> {
        match elasticity(asked, of.configuration)? {
            Some(elasticity) => along::add(&elasticity, of, document),
            None => Ok(()),
        }
    }

    fn sentence(
        &self,
        of: &ConfigurationAnalysis<'_>,
        document: &AnalysisDocument,
    ) -> Option<String> {
        let bounds = in_one_line(of, document)?;
        Some(format!(
            "for any stiffness (`--bounds` prints all): {bounds}"
        ))
    }

    fn words_along(&self, along: &AlongDocument) -> Vec<Block> {
        along::words(along)
    }

    fn words(&self, d: &AnalysisDocument) -> Vec<Block> {
        let Some(answer) = &d.answers.bounds else {
            return Vec::new();
        };
        let heading = Block::Heading(match answer.within {
            None => "Bounds for any stiffness of the joints:".to_owned(),
            Some(factor) => format!("Bounds for compliances within a factor of {factor}:"),
        });
        if let Some(reason) = &answer.reason {
            return vec![heading, Block::sentence(format!("no bounds: {reason}"))];
        }
        let mut out = vec![heading];
        let reactions = d.reactions.iter();
        let of_reactions = reactions.flat_map(|r| r.components.iter().map(move |c| (&r.name, c)));
        let of_groups = d
            .groups
            .iter()
            .flat_map(|g| g.components.iter().map(move |c| (&g.name, c)));
        let of_components = of_reactions.chain(of_groups).filter_map(|(owner, c)| {
            let bounds = c.elastic.bounds.as_ref()?;
            Some((&c.verdict, (owner, c.name, load_unit(c.name), bounds)))
        });
        let sums = d.groups.iter().filter_map(|g| {
            let unit = g.unit.unwrap_or_default();
            Some((
                &g.verdict,
                (&g.name, "sum", unit, g.elastic.bounds.as_ref()?),
            ))
        });
        let all = of_components.chain(sums);
        let all = all.filter(|(verdict, _)| verdict.verdict == "not_unique");
        let all = all.map(|(_, line)| line);
        let lines: Vec<[Cell; 6]> = all
            .map(|(owner, component, unit, bounds)| {
                let at = |loads: &[ElasticLoadDocument], reached: bool| {
                    let names: Vec<String> = loads.iter().map(ToString::to_string).collect();
                    let outer = if reached { "" } else { " (outer)" };
                    format!("{}{outer}", listed(&names))
                };
                [
                    owner.into(),
                    component.into(),
                    Cell::quantity(bounds.lowest, unit),
                    Cell::quantity(bounds.highest, unit),
                    at(&bounds.at_lowest, bounds.reached[0]).into(),
                    at(&bounds.at_highest, bounds.reached[1]).into(),
                ]
            })
            .collect();
        let reached = reached(d);
        if lines.is_empty() && reached.is_none() && answer.without.0.is_empty() {
            out.push(Block::sentence("all components are unique"));
            return out;
        }
        let columns = [
            "reaction",
            "component",
            "lowest",
            "highest",
            "soft at lowest",
            "soft at highest",
        ];
        let has_bounds = !lines.is_empty();
        if has_bounds {
            out.push(Block::table(columns, lines));
        }
        let has_bounds = has_bounds || reached.is_some();
        out.extend(reached.into_iter().flatten());
        if !answer.rigid.is_empty() {
            out.push(Block::after("rigid: ", answer.rigid.join(", ")));
        }
        let magnitudes = d.reactions.iter().filter_map(|r| {
            let most = r.magnitude_at_most.as_ref()?;
            let number = |x: Option<f64>, unit| Cell::quantity(x, unit);
            Some([
                r.name.as_str().into(),
                number(most.force, "N"),
                number(most.moment, "N·m"),
            ])
        });
        let magnitudes: Vec<[Cell; 3]> = magnitudes.collect();
        if !magnitudes.is_empty() {
            out.push(Block::table(
                ["reaction", "force at most", "moment at most"],
                magnitudes,
            ));
        }
        for (name, reason) in &answer.without.0 {
            out.push(Block::after("no bounds: ", format!("`{name}`: {reason}")));
        }
        if has_bounds {
            out.push(Block::after("valid ", &answer.assumption));
        }
        out
    }
}

/// Number of lines in the table of reached ranges.
const REACHED: usize = 24;

/// If not all sets were examined, lists the ranges that are reached. The widest range comes first.
/// Returns `None` if there are no such ranges.
fn reached(d: &AnalysisDocument) -> Option<[Block; 3]> {
    let owners = d.reactions.iter().map(|r| (&r.name, &r.components));
    let owners = owners.chain(d.groups.iter().map(|g| (&g.name, &g.components)));
    let each = owners.flat_map(|(name, components)| components.iter().map(move |c| (name, c)));
    let each = each.filter_map(|(name, c)| Some((name, c.name, c.elastic.reached_at_least?)));
    let sums = d.groups.iter();
    let sums = sums.filter_map(|g| Some((&g.name, "sum", g.elastic.reached_at_least?)));
    let mut all: Vec<(&String, &str, [f64; 2])> = each.chain(sums).collect();
    let width = |(.., [from, to]): &(&String, &str, [f64; 2])| to - from;
    all.sort_by(|a, b| width(b).total_cmp(&width(a)));
    let more = all.len().saturating_sub(REACHED);
    let lines = all
        .iter()
        .take(REACHED)
        .map(|(name, component, [from, to])| {
            let unit = load_unit(component);
            [
                name.as_str().into(),
                (*component).into(),
                Cell::quantity(*from, unit),
                Cell::quantity(*to, unit),
            ]
        });
    let lines: Vec<[Cell; 4]> = lines.collect();
    let more = match more {
        0 => String::new(),
        n => format!("; `--json` prints {n} more"),
    };
    (!all.is_empty()).then(|| {
        let words = format!(
            "Ranges that some compliances reach (no bounds: {}{more}):",
            BoundsError::Many
        );
        [
            Block::Heading(words),
            Block::table(["reaction", "component", "reaches", "to"], lines),
            Block::Gap,
        ]
    })
}

/// Reason at a singular configuration.
const SINGULAR: &str = "this configuration is singular; analyse another time of the motion";

/// Number of reactions in the line of [`in_one_line`].
const LISTED: usize = 3;

/// Describes the bounds of reactions in parts that leave one load component undetermined. The text
/// contains only the component with the widest range of each reaction. The largest reactions come
/// first.
fn in_one_line(of: &ConfigurationAnalysis<'_>, d: &AnalysisDocument) -> Option<String> {
    let layout = of.mechanism.layout();
    let is_open = |id: &ConstraintId| d.reactions[id.0].wrench.verdict == "not_unique";
    let mut open = layout.constraint_ids().filter(is_open).peekable();
    open.peek()?;
    let has_one = |part: &PartAnalysis| part.decision.redundancy() == 1;
    let is_short = d.reactions.len() <= LINES && of.analysis.parts.iter().any(has_one);
    if !is_short || d.answers.bounds.is_some() || d.evidence.permanent == Some(false) {
        return None;
    }
    let solution = of.solution().ok()?;
    let found = of.bounds(solution, &Elasticity::default());
    let widest = open
        .filter(|id| found.has_one_free_component(*id))
        .filter_map(|id| {
            let own = found.group(&Group::WrenchSum(vec![(1.0, id)])).ok()?;
            let width = |bounds: &ElasticBounds| bounds.highest - bounds.lowest;
            let widest = own
                .into_iter()
                .max_by(|a, b| width(&a.1).total_cmp(&width(&b.1)))?;
            (width(&widest.1) > 0.0).then_some((id, widest))
        });
    let mut all: Vec<(ConstraintId, (&str, ElasticBounds))> = widest.collect();
    let size = |(_, bounds): &(&str, ElasticBounds)| bounds.lowest.abs().max(bounds.highest.abs());
    all.sort_by(|a, b| size(&b.1).total_cmp(&size(&a.1)));
    let words = all.iter().take(LISTED).map(|(id, (component, bounds))| {
        let (name, unit) = (&layout.groups[id.0].name, load_unit(component));
        let range = range(bounds.lowest, bounds.highest, unit);
        (range, format!("{name}.{component}"))
    });
    let words = grouped(words).into_iter();
    let words = words.map(|(range, names)| format!("{} {range}", marked(&names)));
    let words: Vec<String> = words.collect();
    (!words.is_empty()).then(|| words.join("; "))
}

fn name(of: &ConfigurationAnalysis<'_>, id: ConstraintId) -> String {
    of.mechanism.layout().groups[id.0].name.clone()
}

/// Reads the options. Returns `None` if no bounds are requested.
fn elasticity(
    asked: &Analyze,
    of: &ConfigurationAnalysis<'_>,
) -> Result<Option<Elasticity>, Refusal> {
    let Some(wanted) = asked.elastic.requested()? else {
        return Ok(None);
    };
    let named = |name: &str| {
        let found = of.reaction(name);
        found.map_err(|e| Refusal::input(e.to_string()).coded(e.code()))
    };
    crate::elasticity::elasticity(&wanted, of.mechanism.layout(), &named).map(Some)
}

fn is_reached(component: &ComponentDocument) -> bool {
    component.elastic.reached_at_least.is_some()
}

/// Adds the bounds of all reactions that are not unique.
fn of_reactions(
    of: &ConfigurationAnalysis<'_>,
    found: &ReactionBounds<'_, '_>,
    document: &mut AnalysisDocument,
    answer: &mut BoundsDocument,
) {
    let layout = of.mechanism.layout();
    let mut centres = Vec::new();
    for (id, reaction) in layout.constraint_ids().zip(&mut document.reactions) {
        if reaction.wrench.verdict == "unique" {
            continue;
        }
        let space = layout.space;
        let of_component = |name: &str| {
            let term = solvability::Term {
                reaction: id,
                component: name.to_owned(),
                coefficient: 1.0,
            };
            let numbers = found.group(&Group::Combination(vec![term]))?;
            Ok::<_, BoundsError>(numbers.into_iter().map(|(_, bounds)| bounds).next())
        };
        let mut reason: Option<String> = None;
        let mut has_moment = false;
        for component in &mut reaction.components {
            match of_component(component.name) {
                Ok(bounds) => {
                    let is_torque = space.load_unit(component.name) == Some("N·m");
                    has_moment |= is_torque && component.verdict.verdict != "unique";
                    if let Some(bounds) = bounds {
                        answer.complete &= bounds.complete;
                        component.elastic = RangeDocument::new(&bounds, layout);
                    }
                }
                Err(e) => {
                    reason.get_or_insert_with(|| format!("{}: {e}", component.name));
                }
            }
        }
        match found.largest_magnitudes(id) {
            Ok([force, moment]) => {
                reaction.magnitude_at_most = Some(MagnitudeDocument { force, moment });
            }
            // If not all sets were examined, there is a range, but no bound.
            Err(BoundsError::Many) if reaction.components.iter().any(is_reached) => {}
            Err(e) if reason.is_none() => reason = Some(e.to_string()),
            Err(_) => {}
        }
        let place = match of.centres().of(id) {
            Some(centre) => Ok(centre),
            None => of.reference_point(id),
        };
        if has_moment && let Ok(place) = place {
            centres.push((reaction.name.clone(), components(space, place)));
        }
        if let Some(reason) = reason {
            answer.without.0.push((reaction.name.clone(), reason));
        }
    }
    answer.centres = ByName(centres);
}
