//! The result for one scene.

use std::panic::{self, AssertUnwindSafe};

use serde_json::Value;

use super::findings::{Findings, Kind};

/// The result for one scene.
#[derive(Debug)]
pub struct Outcome {
    /// Family of the scene.
    pub family: &'static str,
    /// Index of the variant, of the number of digits, or of the tolerance in the list of the suite.
    pub way: usize,
    /// Text of the scene.
    pub text: String,
    /// Result of the comparison of the answer with exact arithmetic.
    pub judged: JudgedStart,
    /// The result of exact arithmetic as text.
    pub truth: String,
    /// Whether the scene is redundant by exact arithmetic.
    pub is_redundant: bool,
    /// Whether all results must be decided. This is the case if the scene is near the origin and
    /// far from a lower rank.
    pub must_be_decided: bool,
}

/// The result of a comparison.
#[derive(Debug, Default)]
pub struct JudgedStart {
    /// The findings of the comparison.
    pub findings: Findings,
    /// The rank in the answer of the program, if it is decided and no other rank is correct.
    pub rank: Option<u64>,
    /// The reason why another rank is also correct. If another rank is also correct, verdicts are
    /// not compared.
    pub other_rank: Option<&'static str>,
}

impl Outcome {
    /// Returns the worst finding.
    #[must_use]
    pub fn worst(&self) -> Option<Kind> {
        self.judged.findings.0.iter().map(|f| f.kind).max()
    }

    /// Returns the text of the scene. Comments at its beginning contain the correct answer and the
    /// answer of the program.
    #[must_use]
    pub fn page(&self, way: &str) -> String {
        let mut page = format!("# {}, {way}\n# Exact arithmetic:\n", self.family);
        for line in self.truth.lines() {
            page.push_str(&format!("#   {line}\n"));
        }
        match (&self.judged.findings.0[..], self.judged.other_rank) {
            ([], None) => page.push_str("# Every answer is right.\n"),
            ([], Some(why)) => page.push_str(&format!("# Verdicts are not compared: {why}.\n")),
            _ => page.push_str("# Told:\n"),
        }
        for finding in &self.judged.findings.0 {
            let (kind, text) = (finding.kind.name(), finding.text.replace('\n', "\n#     "));
            page.push_str(&format!("#   {kind}: {text}\n"));
        }
        page + &self.text
    }
}

/// Compares an answer; a missing answer is also a finding.
pub fn judged(
    answer: impl FnOnce() -> Result<Value, String>,
    examine: impl FnOnce(&Value) -> JudgedStart,
) -> JudgedStart {
    let refused = |kind: Kind, text: String| {
        let mut judged = JudgedStart::default();
        judged.findings.note(kind, text);
        judged
    };
    match panic::catch_unwind(AssertUnwindSafe(answer)) {
        Ok(Ok(document)) => examine(&document),
        Ok(Err(refusal)) => refused(Kind::Refused, refusal),
        Err(_) => refused(Kind::Panic, "the analysis panicked".to_owned()),
    }
}

impl JudgedStart {
    /// Returns the findings for a document in which no other rank is correct.
    #[must_use]
    pub fn with_rank(findings: Findings, document: &Value) -> Self {
        let is_decided = document["evidence"]["status"] == "decided";
        Self {
            findings,
            rank: document["rank"].as_u64().filter(|_| is_decided),
            other_rank: None,
        }
    }
}
