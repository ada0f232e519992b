//! Sentences about the rank and its evidence.

use crate::documents::AnalysisDocument;
use crate::documents::{PartsDocument, ReactionDocument};
use model::SpaceKind;
use model::words::rough;
use solvability::ONE_PART;

use crate::words::{Block, Cell, count, grouped};

/// The text names a row of a near dependence if its weight exceeds this fraction of the largest
/// weight.
const NAMED: f64 = 0.1;

/// Describes the rank, its proof, and whether the rank is the same at other configurations.
pub(super) fn of(d: &AnalysisDocument) -> Vec<Block> {
    let mut blocks = vec![kinds(d)];
    let mut say = |text: String| blocks.push(Block::after("  ", text));
    say(match d.ranks.parts {
        Some(parts) => of_parts(d, parts),
        None => proof(d),
    });
    nearly(d).into_iter().for_each(&mut say);
    elsewhere(d).into_iter().for_each(&mut say);
    for (lead, motions) in grouped(d.ranks.freedoms.sentences()) {
        // Motions of several bodies contain semicolons.
        let is_short = motions.iter().all(|motion| !motion.contains(';'));
        let lines = if is_short {
            vec![motions.join("; also ")]
        } else {
            motions
        };
        blocks.extend(
            lines
                .into_iter()
                .map(|text| Block::after(format!("  {lead}: "), text)),
        );
    }
    let prevented = d.ranks.freedoms.prevented();
    blocks.extend(prevented.map(|text| Block::after("  ", text)));
    let continuation = d.answers.continuation.iter();
    blocks.extend(continuation.map(|c| Block::after("  ", &c.text)));
    blocks.extend(velocities(d));
    blocks
}

/// Describes the proof for a mechanism whose parts were analysed separately.
fn of_parts(d: &AnalysisDocument, parts: PartsDocument) -> String {
    let number = count(parts.number, "part", "parts");
    let largest = count(parts.largest, "row", "rows");
    let lead = format!("analysed in {number} without common cycles, the largest of {largest}; ");
    let e = &d.evidence;
    let said = match &e.reason {
        Some(reason) => format!("UNDECIDED in one part: {reason}"),
        None if e.certified => "the rank of each part is certified".to_owned(),
        None => format!(
            "decided by a clear gap in double precision, not proved for all parts: smallest σ_r = {}",
            rough(e.sigma_r)
        ),
    };
    lead + &said
}

/// Describes the ranks of the holonomic and of the nonholonomic rows.
fn kinds(d: &AnalysisDocument) -> Block {
    let (holonomic, nonholonomic) = (d.ranks.rank_holonomic, d.ranks.rank_nonholonomic);
    Block::detail(
        "  ",
        format!(
            "holonomic rows alone: rank {holonomic}; nonholonomic rows alone: rank {nonholonomic}"
        ),
    )
}

/// Lists the velocities of the free motions, in the order of their sentences.
fn velocities(d: &AnalysisDocument) -> Option<Block> {
    let space_of = |v: &[f64]| {
        let spaces = [SpaceKind::Plane, SpaceKind::Space3];
        spaces.into_iter().find(|space| space.n_v() == v.len())
    };
    let motions = d.ranks.freedoms.motions();
    let motions: Vec<_> = motions.iter().flat_map(|(_, m)| &m.velocities).collect();
    let first = motions.iter().find_map(|bodies| bodies.0.first());
    let space = space_of(&first?.1)?;
    let names = space.velocities();
    let mut table = vec![["motion", "body"].map(Cell::from).to_vec()];
    table[0].extend(names.iter().map(|name| Cell::from(*name)));
    for (k, bodies) in motions.iter().enumerate() {
        for (body, v) in &bodies.0 {
            let mut cells = vec![(k + 1).to_string().into(), body.as_str().into()];
            let numbers = names.iter().zip(v);
            cells.extend(numbers.map(|(name, x)| Cell::quantity(*x, space.column_unit(name))));
            table.push(cells);
        }
    }
    Some(Block::Detail(Box::new(Block::Table(table))))
}

fn proof(d: &AnalysisDocument) -> String {
    let e = &d.evidence;
    let r = d.ranks.rank;
    if let Some(reason) = &e.reason {
        return format!("UNDECIDED: {reason}");
    }
    if !e.certified {
        return format!(
            "decided by a clear gap in double precision, not proved: σ_{r} = {}, σ_{} = {}, tolerance {}",
            rough(e.sigma_r),
            r + 1,
            rough(e.sigma_next),
            rough(e.tolerance)
        );
    }
    let at_least = format!("rank at least {r} proved");
    let r = r + 1;
    let next = e.sigma_next_extended.unwrap_or(f64::NAN);
    let (sigma, rounding) = (rough(next), rough(e.tolerance));
    match e.grounds {
        Some("full_rank") if d.ranks.redundancy == 0 => match d.configuration.rows {
            1 => "rank proved: the only row is independent".to_owned(),
            rows => format!("rank proved: all {rows} rows are independent"),
        },
        Some("full_rank") => "rank proved: it equals the number of columns".to_owned(),
        Some("within_tolerance") => "rank decided only within the stated tolerance".to_owned(),
        Some("exact") => "rank proved in exact arithmetic".to_owned(),
        Some("vanishes") => {
            format!("{at_least}; σ_{r} is zero in double-double precision (below 1e-26)")
        }
        _ if next > e.tolerance => format!(
            "{at_least}; a change of the data by less than a third of their rounding makes σ_{r} = {sigma} zero"
        ),
        // The crate `rank` uses the same bound for entries that vanish.
        _ if next <= 1e-26 => format!(
            "{at_least}; with lever arms below rounding set to zero, σ_{r} is zero in double-double precision (below 1e-26)"
        ),
        _ => format!(
            "{at_least}; σ_{r} = {sigma} (double-double) is below the rounding of the data, {rounding}"
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
        "NEARLY REDUNDANT for the data as read: the rows of {} almost depend on each other; reactions reach 1/σ_{index} = {:.0e} \
         per unit of load",
        names.join(", "),
        nearly.sigma.recip(),
    ))
}

fn elsewhere(d: &AnalysisDocument) -> Option<String> {
    let compared = d.generic.as_ref().map(|g| {
        let n = count(
            g.points.len(),
            "other configuration",
            "other configurations",
        );
        (g.redundancy, n)
    });
    Some(match (d.evidence.permanent, compared) {
        (_, Some((p, n))) if p > d.ranks.redundancy => format!(
            "the redundancy is {p} at {n}, more than here: the additional rank depends on digits that the data may not have"
        ),
        (Some(true), Some((_, n))) => format!("permanent: the redundancy is the same at {n}"),
        (_, Some((p, n))) if d.evidence.permanent == Some(false) => {
            format!("SINGULAR: the redundancy is only {p} at {n}")
        }
        (_, Some((p, n))) => format!("the redundancy is {p} at {n}"),
        (_, None) if d.ranks.freedoms.cannot_move == Some(true) => return None,
        (_, None) if d.configuration.rows > ONE_PART => {
            format!("not compared with other configurations (skipped above {ONE_PART} rows)")
        }
        (_, None) => {
            "not compared with other configurations: no other configuration was reached".to_owned()
        }
    })
}
