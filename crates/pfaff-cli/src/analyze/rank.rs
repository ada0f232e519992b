//! The rank and what is behind it, in sentences.

use pfaff::report::AnalysisDocument;
use pfaff::solvability::{GENERIC_ROWS, Survey};

use crate::output::{count, wrapped};

/// Rows of a near dependence are named if their weight is above this share of the largest.
const NAMED: f64 = 0.1;

/// Rank, proof, and whether it is so elsewhere.
pub(super) fn describe(d: &AnalysisDocument) -> String {
    let mut out = format!(
        "rank {} (Φq alone {}, Ψ alone {}), redundancy {}, mobility {}\n",
        d.rank, d.rank_holonomic, d.rank_nonholonomic, d.redundancy, d.mobility,
    );
    out.push_str(&wrapped("  ", &proof(d)));
    if let Some(sentence) = nearly(d) {
        out.push_str(&wrapped("  ", &sentence));
    }
    out.push_str(&wrapped("  ", &elsewhere(d)));
    if let Some(continuation) = &d.continuation {
        out.push_str(&wrapped("  ", &continuation.text));
    }
    out
}

/// Rank and proof of a mechanism that was judged by parts.
pub(super) fn by_parts(d: &AnalysisDocument, survey: &Survey) -> String {
    let mut out = format!(
        "rank {} (Φq alone {}, Ψ alone {}), redundancy {}, mobility {}\n",
        d.rank, d.rank_holonomic, d.rank_nonholonomic, d.redundancy, d.mobility,
    );
    let largest = survey.parts.iter().map(|part| part.places.rows.len()).max();
    let parts = count(survey.parts.len(), "part", "parts");
    let largest = count(largest.unwrap_or(0), "row", "rows");
    let lead = format!("judged in {parts} that share no cycle, the largest of {largest}; ");
    let e = &d.evidence;
    let said = match &e.reason {
        Some(reason) => format!("UNDECIDED in one of them: {reason}"),
        None if e.certified => "the rank of each is proved".to_owned(),
        None => format!(
            "decided with a clear gap in double precision, not all proved: the smallest σ_r is {:.1e}",
            e.sigma_r
        ),
    };
    out.push_str(&wrapped("  ", &(lead + &said)));
    out
}

fn proof(d: &AnalysisDocument) -> String {
    let e = &d.evidence;
    let r = d.rank;
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
    let others = match d.redundancy {
        1 => "the other row is".to_owned(),
        p => format!("the {p} other rows are"),
    };
    let next = e.sigma_next_extended.unwrap_or(f64::NAN);
    match e.grounds {
        Some("full_rank") if d.redundancy == 0 => match d.rows {
            1 => "proved: the only row is independent".to_owned(),
            rows => format!("proved: all {rows} rows are independent"),
        },
        Some("full_rank") => {
            format!("proved: there are no more columns, so {others} redundant exactly")
        }
        Some("exact") => format!("proved in exact arithmetic: {others} redundant exactly"),
        Some("vanishes") => format!(
            "rank {r} proved; σ_{} vanishes in doubled precision (below 1e-26): {others} redundant exactly",
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
    let concerned = |r: &&pfaff::report::documents::ReactionDocument| {
        let mut rows = r.rows.iter();
        rows.any(|row| nearly.direction[row - 1].abs() > NAMED * largest)
    };
    let names: Vec<&str> = d
        .reactions
        .iter()
        .filter(concerned)
        .map(|r| r.name.as_str())
        .collect();
    let change = match nearly.change_per_micrometre {
        share if share < 0.5 => format!("by about {:.1} %", 100.0 * share),
        times => format!("by about {times:.0e} times their own size"),
    };
    Some(format!(
        "NEARLY REDUNDANT: σ_{} = {:.1e} is not zero, but the rows of {} almost depend on each other. The rank is that of the data as \
         read, and so are the verdicts; but reactions are of size 1/σ = {:.0e} per unit of load, and a misalignment of 1e-6 m changes \
         them {change}",
        d.rank,
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
        (_, Some((p, n))) if p > d.redundancy => format!(
            "at {n} the redundancy is {p}, more than here: what is independent here hangs on digits that the data may not have"
        ),
        (Some(true), Some((_, n))) => format!("permanent: the same redundancy at {n}"),
        (_, Some((p, n))) if d.evidence.permanent == Some(false) => {
            format!("ONLY HERE: at {n} the redundancy falls to {p}; this configuration is singular")
        }
        (_, Some((p, n))) => format!("at {n} the redundancy is {p}"),
        (_, None) if d.rows > GENERIC_ROWS => format!(
            "not compared with other configurations: that takes long above {GENERIC_ROWS} rows"
        ),
        (_, None) => "not compared with other configurations: none could be reached".to_owned(),
    }
}
