//! Compares which rows may be deleted: the number of sets whose deletion does not change the
//! motion, and the sets whose deletion makes a reaction unique.

use serde_json::Value;

use super::findings::{Findings, Kind, list, rows};
use super::truth::Truth;

/// If the number of sets is larger than this value, the sets are not counted.
const COUNTED: usize = 400;

/// Compares both results with the answer.
pub fn examine(truth: &Truth, answer: &Value, findings: &mut Findings) {
    let (all, redundancy) = (truth.rows.len(), truth.redundancy());
    if binomial(all, redundancy).is_some_and(|sets| sets <= COUNTED) {
        let right = count(truth, redundancy, 0, &mut Vec::new());
        let answer = &answer["eliminations"];
        if answer["count"].is_null() {
            findings.note(
                Kind::Undecided,
                format!("eliminations: {}", answer["reason"]),
            );
        } else {
            findings.number(Kind::Sentence, "eliminations", &answer["count"], right);
        }
    }
    for proposals in list(&answer["make_unique"]) {
        make_unique(truth, proposals, findings);
    }
}

/// Returns the number of sets of `missing` rows from `from` on that can be deleted together with
/// the rows of `deleted`.
fn count(truth: &Truth, missing: usize, from: usize, deleted: &mut Vec<usize>) -> usize {
    if missing == 0 {
        return usize::from(truth.keeps_motion(deleted));
    }
    let mut sum = 0;
    for row in from..truth.rows.len() {
        // A row that is independent of all other rows cannot be deleted.
        if !truth.row_is_unique(row) {
            deleted.push(row);
            sum += count(truth, missing - 1, row + 1, deleted);
            deleted.pop();
        }
    }
    sum
}

fn binomial(n: usize, k: usize) -> Option<usize> {
    (0..k).try_fold(1_usize, |product, i| {
        Some(product.checked_mul(n - i)? / (i + 1))
    })
}

fn make_unique(truth: &Truth, answer: &Value, findings: &mut Findings) {
    let name = answer["reaction"].as_str().unwrap_or_default();
    let mut elements = truth.elements.iter();
    let Some(element) = elements.find(|e| e.name == name) else {
        findings.note(Kind::Sentence, format!("`{name}` was not requested"));
        return;
    };
    if answer["reason"].is_string() {
        let text = format!("what makes `{name}` unique: {}", answer["reason"]);
        findings.note(Kind::Undecided, text);
        return;
    }
    let own = truth.rows_of(element.owner);
    let works =
        |deleted: &[usize]| truth.keeps_motion(deleted) && truth.is_unique_without(&own, deleted);
    let ways: Vec<Vec<usize>> = list(&answer["ways"])
        .iter()
        .map(|w| rows(&w["rows"]))
        .collect();
    for way in &ways {
        if !works(way) {
            let text = format!("`{name}` is not unique without rows (from 0) {way:?}");
            findings.note(Kind::Sentence, text);
        }
    }
    // The answer must contain all sets of the smallest size; rows of the reaction itself are not
    // deleted.
    let others = (0..truth.rows.len()).filter(|row| !own.contains(row));
    let alone: Vec<usize> = others.filter(|&row| works(&[row])).collect();
    let is_left_out = alone.iter().any(|row| !ways.contains(&vec![*row]));
    if answer["complete"] == true && is_left_out {
        let text = format!(
            "`{name}` is unique without each of rows (from 0) {alone:?}, answer are {ways:?}"
        );
        findings.note(Kind::Sentence, text);
    }
}
