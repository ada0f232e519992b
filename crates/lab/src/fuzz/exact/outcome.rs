//! The result for one scene.

use std::panic::{self, AssertUnwindSafe};

use serde_json::Value;

use super::findings::{Findings, Kind};
use super::pose::Writing;

/// The result for one scene.
#[derive(Debug)]
pub struct Outcome {
    /// Its family.
    pub family: &'static str,
    /// How it is written.
    pub writing: Writing,
    /// Its text.
    pub text: String,
    /// The findings.
    pub findings: Findings,
    /// The rank that the program gave, if any.
    pub rank: Option<u64>,
    /// The result of exact arithmetic, in words.
    pub truth: String,
    /// The redundancy by exact arithmetic.
    pub redundancy: usize,
}

impl Outcome {
    /// The worst finding.
    #[must_use]
    pub fn worst(&self) -> Option<Kind> {
        self.findings.0.iter().map(|f| f.kind).max()
    }

    /// The scene with the correct answer and that of the program in comments at its beginning.
    #[must_use]
    pub fn page(&self) -> String {
        let (family, writing) = (self.family, self.writing.name());
        let mut page = format!("# {family}, {writing}\n# Exact arithmetic:\n");
        for line in self.truth.lines() {
            page.push_str(&format!("#   {line}\n"));
        }
        match self.findings.0.as_slice() {
            [] => page.push_str("# Every answer is right.\n"),
            _ => page.push_str("# Told:\n"),
        }
        for finding in &self.findings.0 {
            let (kind, text) = (finding.kind.name(), finding.text.replace('\n', "\n#     "));
            page.push_str(&format!("#   {kind}: {text}\n"));
        }
        page + &self.text
    }
}

/// The findings for an answer, also if there is none, and its rank if it is decided.
pub fn judged(
    answer: impl FnOnce() -> Result<Value, String>,
    examine: impl FnOnce(&Value) -> Findings,
) -> (Findings, Option<u64>) {
    let mut findings = Findings::default();
    match panic::catch_unwind(AssertUnwindSafe(answer)) {
        Ok(Ok(document)) => {
            let is_decided = document["evidence"]["status"] == "decided";
            let rank = document["rank"].as_u64().filter(|_| is_decided);
            return (examine(&document), rank);
        }
        Ok(Err(refusal)) => findings.note(Kind::Refused, refusal),
        Err(_) => findings.note(Kind::Panic, "the analysis panicked".to_owned()),
    }
    (findings, None)
}
