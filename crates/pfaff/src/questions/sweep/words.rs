//! Text about the runs of a sweep.

use model::words::rough;
use report::SweepDocument;
use report::sweep::Runs;

use super::{SweepAnswer, SweepEnd};
use crate::documents::TRUSTED_BALANCE;
use crate::sweep::Shard;
use crate::words::{Block, count};

/// Largest number of gaps and shards that are listed.
const NAMED: usize = 10;

pub(super) fn of(answer: &SweepAnswer) -> Vec<Block> {
    let (d, shard) = (&answer.document, answer.shard);
    let all = count(d.runs as usize, "run", "runs");
    let mut of_all = match d.shard {
        None if shard == Shard::WHOLE => format!("{}: {} of {all}", d.scene, d.finished),
        None => format!("{}, shard {shard} of {all}: none", d.scene),
        Some(runs) => {
            let own = count(runs.count() as usize, "run", "runs");
            format!(
                "{}, shard {shard} of {all}: {} of {own}",
                d.scene, d.finished
            )
        }
    };
    of_all.push_str(&format!(": {} done", d.done));
    if d.opened > 0 {
        of_all.push_str(&format!(", {} ended when contacts opened", d.opened));
    }
    of_all.push_str(&format!(", {} stopped, {} rejected", d.stopped, d.refused));
    if d.crashed > 0 {
        of_all.push_str(&format!(", {} crashed", d.crashed));
    }
    let mut blocks = vec![Block::sentence(of_all)];
    if d.repeated > 0 {
        let repeated = count(d.repeated as usize, "run was", "runs were");
        let text = format!("{repeated} performed twice, with the same results");
        blocks.push(Block::sentence(text));
    }
    match answer.end {
        SweepEnd::Whole(_) => {}
        SweepEnd::Interrupted => {
            blocks.push(Block::sentence("interrupted; the same command resumes it"));
        }
        SweepEnd::Missing { shards } => blocks.extend(gaps(d, shards)),
    }
    for failure in &d.failures {
        let lead = format!("run {} {}: ", failure.run, failure.status);
        blocks.push(Block::after(lead, &failure.error));
    }
    let more = (d.stopped + d.refused + d.crashed).saturating_sub(d.failures.len() as u64);
    if more > 0 {
        let text = format!("and {more} more: see the column `error`");
        blocks.push(Block::sentence(text));
    }
    if let (Some(balance), Some(run)) = (d.max_energy_balance, d.max_energy_balance_run)
        && balance > TRUSTED_BALANCE
    {
        let text = format!(
            "the energy balance of run {run} is off by {balance} of its largest kinetic energy: do not trust runs with more than {TRUSTED_BALANCE:.0e} in the column `energy_balance`",
            balance = rough(balance)
        );
        blocks.push(Block::after("warning: ", text));
    }
    blocks
}

/// Lists the missing runs, with the shards that perform them.
fn gaps(d: &SweepDocument, shards: Option<u64>) -> Vec<Block> {
    let option = |shard: &Shard| format!("`--shard {shard}`");
    let known = |runs: &Runs| Shard::of(*runs, d.runs, shards?);
    let gap = |runs: &Runs| {
        let words = if runs.count() == 1 {
            ["run", "is"]
        } else {
            ["runs", "are"]
        };
        let makers = match known(runs) {
            Some(shards) => {
                let mut options: Vec<String> = shards.iter().take(NAMED).map(option).collect();
                if shards.len() > NAMED {
                    options.push(format!("and {} more", shards.len() - NAMED));
                }
                options.join(", ")
            }
            None => "the command without `--shard` performs the missing runs".to_owned(),
        };
        Block::sentence(format!(
            "{} {runs} {} missing: {makers}",
            words[0], words[1]
        ))
    };
    let mut blocks: Vec<Block> = d.missing.iter().take(NAMED).map(gap).collect();
    if d.missing.len() > NAMED {
        let more = d.missing.len() - NAMED;
        blocks.push(Block::sentence(format!("and {more} more gaps")));
    }
    blocks
}
