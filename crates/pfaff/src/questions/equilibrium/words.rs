//! Text about the equilibrium.

use std::iter;

use model::words::{marked, rough};

use super::answer::EquilibriumAnswer;
use crate::pulls::{PullTimes, PullWarning};
use crate::words::{Block, Cell, count, load_unit};

pub(super) fn of(d: &EquilibriumAnswer) -> Vec<Block> {
    let mut blocks = vec![Block::sentence(found(d)), Block::sentence(stability(d))];
    let mut say = |text: String| blocks.push(Block::sentence(text));
    if !d.idle.is_empty() {
        say(format!(
            "neutral free motions (equilibrium at every position along them): {}",
            d.idle.join("; ")
        ));
    }
    if d.depends_on_way {
        say("nonholonomic rows restrict the path, not the position: other paths have other equilibria".to_owned());
    }
    if !d.held.is_empty() {
        let held = marked(&d.held);
        say(format!("drives locked at t = {} s: {held}", d.time));
    }
    if !d.moving_on.is_empty() {
        let names = marked(&d.moving_on);
        say(format!(
            "a simulation from this position starts with other forces, because these functions of time have accelerations: {names}"
        ));
    }
    blocks.push(bodies(d));
    if let Some(why) = &d.no_reactions_because {
        blocks.push(Block::sentence(format!("no reactions: {why}")));
    } else if !d.reactions.0.is_empty() {
        blocks.push(reactions(d));
    }
    if !d.loads.is_empty() {
        blocks.push(loads(d));
    }
    if let Some(warning) = PullWarning::new(&d.pulls, PullTimes::Instant) {
        blocks.push(Block::after(PullWarning::lead(), warning.to_string()));
    }
    if let Some(file) = d.file {
        blocks.push(Block::sentence(format!(
            "`{file}` starts at the equilibrium, e.g. for `pfaff simulate` and `pfaff linearise`"
        )));
    }
    blocks
}

fn found(d: &EquilibriumAnswer) -> String {
    let balance = match d.residual {
        0.0 => "forces balance".to_owned(),
        left => format!(
            "the remaining force is {left} of the largest force",
            left = rough(left)
        ),
    };
    let steps = count(d.steps, "step", "steps");
    let found = match (d.steps, d.pushes) {
        (0, 0) => "the start is an equilibrium".to_owned(),
        (_, 0) => format!("equilibrium found in {steps}"),
        (_, pushes) => {
            let pushes = count(pushes, "perturbation", "perturbations");
            format!("equilibrium found in {steps} after {pushes}")
        }
    };
    let (scene, time) = (&d.scene, d.time);
    format!("{scene}: {found} (functions of time at t = {time} s): {balance}")
}

fn stability(d: &EquilibriumAnswer) -> String {
    match d.stability {
        "immovable" => "no body can move".to_owned(),
        "stable" => "stable: every displacement causes a restoring force".to_owned(),
        "idle" => "neutral: no displacement grows, but some cause no restoring force".to_owned(),
        "unstable" => format!(
            "unstable along: {}; `--stable` skips unstable equilibria",
            d.falling.join("; ")
        ),
        _ => format!(
            "stability is undecided: {}",
            d.not_judged_because.unwrap_or_default()
        ),
    }
}

/// A line of a table: its first cells, named numbers, and its last cells.
type Line<'a> = (Vec<Cell>, Vec<(&'a str, Cell)>, Vec<Cell>);

/// Builds a table with one column for each name of a number. The columns `before` and `after` are
/// on both sides of these columns.
fn table(before: &[&str], after: &[&str], lines: &[Line<'_>]) -> Block {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in lines.iter().flat_map(|(_, named, _)| named) {
        if !names.contains(name) {
            names.push(name);
        }
    }
    let head = before.iter().chain(&names).chain(after);
    let head = head.map(|name| Cell::from(*name)).collect();
    let cells = |(first, named, last): &Line<'_>| {
        let cell = |name: &&str| {
            let found = named.iter().find(|(own, _)| own == name);
            found.map_or(Cell::from(""), |(_, cell)| cell.clone())
        };
        let named: Vec<Cell> = names.iter().map(cell).collect();
        [first.clone(), named, last.clone()].concat()
    };
    Block::Table(iter::once(head).chain(lines.iter().map(cells)).collect())
}

fn bodies(d: &EquilibriumAnswer) -> Block {
    let unit = |name: &str| match name {
        "angle" => "rad",
        name if name.starts_with('q') => "",
        _ => "m",
    };
    let lines = d.bodies.0.iter().map(|(name, body)| {
        let moved = [("m", body.moved), ("rad", body.turned)];
        let moved = moved.map(|(unit, x)| Cell::quantity(x, unit));
        let at = body.at.0.iter();
        let at = at.map(|(name, x)| (name.as_str(), Cell::quantity(*x, unit(name))));
        let first = iter::once(name.into()).chain(moved);
        (first.collect(), at.collect(), Vec::new())
    });
    let before = ["body", "displacement", "rotation"];
    table(&before, &[], &lines.collect::<Vec<_>>())
}

fn reactions(d: &EquilibriumAnswer) -> Block {
    let lines = d.reactions.0.iter().map(|(name, reaction)| {
        let values = reaction.values.0.iter();
        // Components that are not determined have no number.
        let values = values.map(|(name, x)| {
            (
                name.as_str(),
                Cell::quantity(x.determined(), load_unit(name)),
            )
        });
        let verdict = reaction.verdict.verdict.replace('_', " ");
        (vec![name.into()], values.collect(), vec![verdict.into()])
    });
    table(&["reaction"], &["verdict"], &lines.collect::<Vec<_>>())
}

fn loads(d: &EquilibriumAnswer) -> Block {
    let lines = d.loads.0.iter().map(|(name, numbers)| {
        let numbers = numbers.0.iter();
        // The equilibrium is at rest.
        let numbers = numbers.filter(|(number, _)| number != "rate");
        let cells = numbers.map(|(number, x)| (number.as_str(), Cell::quantity(*x, unit(number))));
        (vec![name.into()], cells.collect(), Vec::new())
    });
    table(
        &["force on the first body"],
        &[],
        &lines.collect::<Vec<_>>(),
    )
}

/// The SI unit of a number of a load.
fn unit(number: &str) -> &'static str {
    match number {
        "length" => "m",
        "angle" => "rad",
        component => load_unit(component),
    }
}
