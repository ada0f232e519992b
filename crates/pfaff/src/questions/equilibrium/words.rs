//! Text on the equilibrium.

use model::words::rounded;

use super::answer::EquilibriumAnswer;
use crate::words::{Block, count, marked};

/// Numbers below this fraction of the largest number of their kind are shown as zero.
const VISIBLE: f64 = 1e-12;

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
        say("nonholonomic rows restrict the path, not the position: other paths lead to other equilibria".to_owned());
    }
    if !d.held.is_empty() {
        let held = marked(&d.held);
        say(format!("drives locked at t = {} s: {held}", d.time));
    }
    if !d.moving_on.is_empty() {
        let names = marked(&d.moving_on);
        say(format!(
            "a simulation from here starts with other forces, because these functions of time accelerate: {names}"
        ));
    }
    blocks.push(bodies(d));
    if let Some(why) = &d.no_reactions_because {
        blocks.push(Block::sentence(format!("no reactions: {why}")));
    } else if !d.reactions.0.is_empty() {
        blocks.push(reactions(d));
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
        left => format!("forces balance to {left:.1e} of the largest force"),
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

fn bodies(d: &EquilibriumAnswer) -> Block {
    let places = d.bodies.0.iter().flat_map(|(_, body)| body.at.0.iter());
    let largest = places.fold(0.0, |a: f64, (_, x)| a.max(x.abs()));
    let lines = d.bodies.0.iter().map(|(name, body)| {
        let at = body.at.0.iter();
        let at = at.map(|(name, x)| format!("{name} = {}", short(*x, largest)));
        [
            name.clone(),
            short(body.moved, largest),
            short(body.turned, 1.0),
            at.collect::<Vec<_>>().join(", "),
        ]
    });
    Block::table(
        ["body", "displacement (m)", "rotation (rad)", "position"],
        lines,
    )
}

fn reactions(d: &EquilibriumAnswer) -> Block {
    let values = d.reactions.0.iter().flat_map(|(_, r)| r.values.0.iter());
    let values = values.filter_map(|(_, x)| x.determined());
    let largest = values.fold(0.0, |a: f64, x| a.max(x.abs()));
    let lines = d.reactions.0.iter().map(|(name, reaction)| {
        let values = reaction.values.0.iter();
        // Components that are not determined have no number.
        let values = values.map(|(name, x)| match x.determined() {
            None => format!("{name} = –"),
            Some(x) => format!("{name} = {}", short(x, largest)),
        });
        [
            name.clone(),
            values.collect::<Vec<_>>().join(", "),
            reaction.verdict.verdict.replace('_', " "),
        ]
    });
    Block::table(["reaction", "value on the first body", "verdict"], lines)
}

/// Formats a number with six digits; a rounding error relative to the largest number of its kind is
/// shown as zero.
fn short(x: f64, largest: f64) -> String {
    match x.abs() {
        size if size <= VISIBLE * largest => "0".to_owned(),
        _ => rounded(x),
    }
}
