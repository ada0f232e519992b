//! Text about the plan of a run.

use dynamics::INDEPENDENT_ROWS;

use super::answer::{PlanAnswer, PlannedDecision};
use crate::memory::Bytes;
use crate::words::{Block, count};

/// Returns one table for the whole mechanism, and one table for each component if there are several
/// components.
pub(super) fn of(d: &PlanAnswer) -> Vec<Block> {
    let memory = Bytes(d.memory as u64);
    let (scene, t_end) = (&d.scene, d.t_end);
    let stabilisation = d.stabilisation;
    let mut blocks = vec![
        Block::sentence(format!(
            "{scene}: plan of a run to t = {t_end} s ({INDEPENDENT_ROWS}, {stabilisation}), about {memory} of memory"
        )),
        table(d, None),
    ];
    if d.components.len() > 1 {
        for component in &d.components {
            let rows = component.holonomic_rows + component.nonholonomic_rows;
            let velocities = count(component.velocities, "velocity", "velocities");
            let rows = count(rows, "row", "rows");
            let (name, rank) = (&component.name, component.rank);
            let heading = format!("{name}: {velocities}, {rows}, rank {rank}");
            blocks.push(Block::Heading(heading));
            blocks.push(table(d, Some(name)));
        }
    }
    if let Some(sweep) = &d.sweep {
        blocks.push(Block::after("sweep: ", sweep));
    }
    blocks
}

/// Lists the decisions about a component, or about the whole mechanism.
fn table(d: &PlanAnswer, component: Option<&str>) -> Block {
    let of = |line: &&PlannedDecision| line.component.as_deref() == component;
    let lines = d.decisions.iter().filter(of).map(|line| {
        [
            in_words(&line.decision),
            line.taken.clone(),
            line.saves
                .as_ref()
                .map_or(String::new(), ToString::to_string),
            line.reason.clone(),
        ]
    });
    Block::table(["decision", "result", "saves", "reason"], lines)
}

/// Returns the question that a decision answers, as it is printed.
fn in_words(decision: &str) -> String {
    match decision {
        "dropped_rows" => "redundant rows".to_owned(),
        "rows_of_gamma" => "rows with Γ".to_owned(),
        "rows_of_time" => "driven rows".to_owned(),
        key => key.replace('_', " "),
    }
}
