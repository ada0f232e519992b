//! Text about load cases.

use model::words::{listed, marked};

use super::{CaseDocument, CasePeaks, CaseSet, CasesAnswer, PeakOfCase};
use crate::words::{Block, Cell, count};

/// Largest number of cases with separate columns.
const COLUMNS: usize = 5;

pub(super) fn of(answer: &CasesAnswer) -> Vec<Block> {
    let cases = &answer.cases;
    let with = |status: &str| cases.iter().filter(|case| case.status == status).count();
    let counts = ["done", "opened", "stopped", "refused", "interrupted"];
    let counts = counts.map(|status| (with(status), status));
    let counts = counts.iter().filter(|(n, _)| *n > 0);
    let counts: Vec<String> = counts.map(|(n, status)| format!("{n} {status}")).collect();
    let mut out = vec![Block::sentence(format!(
        "{}: {}: {}",
        answer.scene,
        count(cases.len(), "load case", "load cases"),
        counts.join(", ")
    ))];
    for CaseDocument {
        name,
        status,
        error,
        warnings,
        ..
    } in cases
    {
        if let Some(error) = error {
            out.push(Block::after(format!("`{name}` {status}: "), error));
        }
        for warning in warnings {
            out.push(Block::after(format!("warning on `{name}`: "), warning));
        }
    }
    if answer.sets.len() > 1 {
        out.push(Block::sentence(
            "The cases have different ranks or verdicts. Compare peaks only within one table.",
        ));
    }
    for set in &answer.sets {
        out.push(Block::Gap);
        out.push(Block::sentence(of_set(set)));
        out.push(table(set));
    }
    out
}

/// States the ranks and verdicts of a set.
fn of_set(set: &CaseSet) -> String {
    let CaseSet {
        rank,
        redundancy,
        mobility,
        not_unique,
        undecided,
        ..
    } = set;
    let verdict = |names: &[String], what: &str| match names {
        [] => String::new(),
        names => format!(
            "; {what}: {}",
            listed(&names.iter().map(String::as_str).collect::<Vec<_>>())
        ),
    };
    let open =
        verdict(not_unique, "not determined by the model") + &verdict(undecided, "undecided");
    let open = if open.is_empty() {
        "; every reaction is unique"
    } else {
        &open
    };
    format!(
        "{}: rank {rank}, redundancy {redundancy}, mobility {mobility}{open}.",
        marked(&set.cases)
    )
}

/// Returns the table of the peaks.
fn table(set: &CaseSet) -> Block {
    let has_columns = (2..=COLUMNS).contains(&set.cases.len());
    let head = ["load", ""].into_iter();
    let cases = set.cases.iter().map(String::as_str).filter(|_| has_columns);
    let last = ["largest", "in", "at"];
    let head = head.chain(cases).chain(last).map(Cell::from).collect();
    let line = |peaks: &CasePeaks| {
        let value = |peak: Option<f64>| Cell::quantity(peak, peaks.unit);
        let each = peaks
            .cases
            .0
            .iter()
            .map(|(_, peak)| value(peak.map(|peak| peak.value)));
        let (case, largest) = match &peaks.largest {
            Some(PeakOfCase { case, peak }) => (case.as_str(), Some(*peak)),
            None => ("", None),
        };
        let [name, load] = [&peaks.name, &peaks.load].map(|text| Cell::from(text.as_str()));
        let last = [
            value(largest.map(|peak| peak.value)),
            case.into(),
            Cell::quantity(largest.map(|peak| peak.time), "s"),
        ];
        let line = [name, load].into_iter();
        line.chain(each.filter(|_| has_columns))
            .chain(last)
            .collect()
    };
    let known = |peaks: &&CasePeaks| peaks.cases.0.iter().any(|(_, peak)| peak.is_some());
    let lines: Vec<Vec<Cell>> = set.peaks.iter().filter(known).map(line).collect();
    if lines.is_empty() {
        return Block::sentence("No load is determined during a whole run.");
    }
    Block::Table(std::iter::once(head).chain(lines).collect())
}
