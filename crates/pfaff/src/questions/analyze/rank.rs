//! The rank and the facts that it is based on, in sentences.

use crate::documents::AnalysisDocument;
use crate::documents::{PartsDocument, ReactionDocument};
use solvability::ONE_PART;

use crate::words::{Block, count};

/// A row of a near dependence is named if its weight exceeds this fraction of the largest weight.
const NAMED: f64 = 0.1;

/// Rank, proof, and whether the rank is the same at other configurations.
pub(super) fn of(d: &AnalysisDocument) -> Vec<Block> {
    let mut blocks = ranks(d);
    let mut say = |text: String| blocks.push(Block::after("  ", text));
    say(match d.ranks.parts {
        Some(parts) => of_parts(d, parts),
        None => proof(d),
    });
    nearly(d).into_iter().for_each(&mut say);
    say(elsewhere(d));
    let motions = d.ranks.freedoms.sentences().into_iter();
    blocks.extend(motions.map(|(lead, text)| Block::after(format!("  {lead}: "), text)));
    let continuation = d.answers.continuation.iter();
    blocks.extend(continuation.map(|c| Block::after("  ", &c.text)));
    blocks
}

/// The proof of a mechanism whose parts were analysed separately.
fn of_parts(d: &AnalysisDocument, parts: PartsDocument) -> String {
    let number = count(parts.number, "part", "parts");
    let largest = count(parts.largest, "row", "rows");
    let lead = format!("judged in {number} that share no cycle, the largest of {largest}; ");
    let e = &d.evidence;
    let said = match &e.reason {
        Some(reason) => format!("UNDECIDED in one of them: {reason}"),
        None if e.certified => "the rank of each is proved".to_owned(),
        None => format!(
            "decided with a clear gap in double precision, not all proved: the smallest σ_r is {:.1e}",
            e.sigma_r
        ),
    };
    lead + &said
}

/// The ranks with the drives, and without them if these differ.
fn ranks(d: &AnalysisDocument) -> Vec<Block> {
    let ranks = &d.ranks;
    let mut out = vec![Block::sentence(format!(
        "rank {} (Φq alone {}, Ψ alone {}), redundancy {}, {}",
        ranks.rank,
        ranks.rank_holonomic,
        ranks.rank_nonholonomic,
        ranks.redundancy,
        ranks.freedoms.sentence(ranks.mobility),
    ))];
    let without = ranks.freedoms.without_drives.as_ref();
    if let Some(without) = without.filter(|without| without.redundancy != ranks.redundancy) {
        let (rank, redundancy) = (without.rank, without.redundancy);
        let whose = without.possessive();
        let text = format!("without {whose} rank {rank} and redundancy {redundancy}");
        out.push(Block::after("  ", text));
    }
    out
}

fn proof(d: &AnalysisDocument) -> String {
    let e = &d.evidence;
    let r = d.ranks.rank;
    if let Some(reason) = &e.reason {
        return format!("UNDECIDED: {reason}");
    }
    if !e.certified {
        return format!(
            "decided with a clear gap in double precision, not proved: σ_{r} = {:.1e}, σ_{} = {:.1e}, tolerance {:.1e}",
            e.sigma_r,
            r + 1,
            e.sigma_next,
            e.tolerance
        );
    }
    let others = match d.ranks.redundancy {
        1 => "the other row is".to_owned(),
        p => format!("the {p} other rows are"),
    };
    let next = e.sigma_next_extended.unwrap_or(f64::NAN);
    match e.grounds {
        Some("full_rank") if d.ranks.redundancy == 0 => match d.configuration.rows {
            1 => "proved: the only row is independent".to_owned(),
            rows => format!("proved: all {rows} rows are independent"),
        },
        Some("full_rank") => {
            format!("proved: there are no more columns, so {others} redundant exactly")
        }
        Some("within_tolerance") => {
            format!(
                "rank {r}: {others} not redundant as read, but within the tolerance that is stated"
            )
        }
        Some("exact") => format!("proved in exact arithmetic: {others} redundant exactly"),
        Some("vanishes") => format!(
            "rank {r} proved; σ_{} vanishes in doubled precision (below 1e-26): {others} redundant exactly",
            r + 1
        ),
        _ if next > e.tolerance => format!(
            "rank {r}: σ_{} = {next:.1e} would vanish if the data were wrong by less than a third of their rounding: {others} redundant to \
             within the rounding of the data",
            r + 1
        ),
        // The bound of `rank` for what vanishes.
        _ if next <= 1e-26 => format!(
            "rank {r} proved; σ_{} vanishes in doubled precision (below 1e-26), where lever arms that are rounding count as zero: {others} \
             redundant to within the rounding of the data",
            r + 1
        ),
        _ => format!(
            "rank {r} proved; σ_{} = {next:.1e} stays in doubled precision, but is below the {:.1e} that the rounding of the data \
             leaves open: {others} redundant to within the rounding of the data",
            r + 1,
            e.tolerance
        ),
    }
}

fn nearly(d: &AnalysisDocument) -> Option<String> {
    let nearly = d.evidence.nearly_redundant.as_ref()?;
    let largest = nearly
        .direction
        .iter()
        .fold(0.0, |a: f64, x| a.max(x.abs()));
    let concerned = |r: &&ReactionDocument| {
        let mut rows = r.rows.iter();
        rows.any(|row| nearly.direction[row - 1].abs() > NAMED * largest)
    };
    let names: Vec<&str> = d
        .reactions
        .iter()
        .filter(concerned)
        .map(|r| r.name.as_str())
        .collect();
    let index = match d.ranks.parts {
        Some(_) => "r".to_owned(),
        None => d.ranks.rank.to_string(),
    };
    Some(format!(
        "NEARLY REDUNDANT: σ_{index} = {:.1e} is not zero, but the rows of {} almost depend on each other. The rank is that of the data as \
         read, and so are the verdicts; but reactions are of size 1/σ = {:.0e} per unit of load",
        nearly.sigma,
        names.join(", "),
        nearly.sigma.recip(),
    ))
}

fn elsewhere(d: &AnalysisDocument) -> String {
    let compared = d.generic.as_ref().map(|g| {
        let n = count(
            g.points.len(),
            "other configuration",
            "other configurations",
        );
        (g.redundancy, n)
    });
    match (d.evidence.permanent, compared) {
        (_, Some((p, n))) if p > d.ranks.redundancy => format!(
            "at {n} the redundancy is {p}, more than here: what is independent here depends on digits that the data may not have"
        ),
        (Some(true), Some((_, n))) => format!("permanent: the same redundancy at {n}"),
        (_, Some((p, n))) if d.evidence.permanent == Some(false) => {
            format!("ONLY HERE: at {n} the redundancy falls to {p}; this configuration is singular")
        }
        (_, Some((p, n))) => format!("at {n} the redundancy is {p}"),
        (_, None) if d.ranks.freedoms.cannot_move == Some(true) => {
            let sentence = d.ranks.freedoms.cannot_move_sentence(d.ranks.mobility);
            format!("{sentence}: there is no other configuration to compare with")
        }
        (_, None) if d.configuration.rows > ONE_PART => {
            format!("not compared with other configurations: that takes long above {ONE_PART} rows")
        }
        (_, None) => "not compared with other configurations: none could be reached".to_owned(),
    }
}
