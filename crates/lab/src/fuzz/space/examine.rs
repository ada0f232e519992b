//! Compares the answers for drawings in space with exact arithmetic. These are cases of the
//! campaign in [`crate::fuzz::exact::tally`].

use serde_json::Value;

use super::drawing::Drawing;
use super::permanence::elsewhere;
use super::pose::Writing;
use super::scene;
use super::text::text;
use crate::fuzz::exact::answer::answer;
use crate::fuzz::exact::examine::ranks_and_reactions;
use crate::fuzz::exact::expected::Expected;
use crate::fuzz::exact::findings::Findings;
use crate::fuzz::exact::outcome::{JudgedStart, Outcome, judged};
use crate::fuzz::exact::truth::Truth;

/// Tests one scene with all digits of a double.
#[must_use]
pub fn outcome(seed: u64, number: u64) -> Outcome {
    let scene = scene(seed, number);
    let (right, judged) = judge(&scene.drawing);
    Outcome {
        family: scene.family.name(),
        way: scene.writing as usize,
        text: text(&scene.drawing),
        judged,
        truth: right.describe(),
        is_redundant: right.redundancy > 0,
        must_be_decided: scene.writing != Writing::Far,
    }
}

/// Returns the findings for a drawing.
#[must_use]
pub fn compared(drawing: &Drawing) -> Findings {
    judge(drawing).1.findings
}

fn judge(drawing: &Drawing) -> (Expected, JudgedStart) {
    let (truth, right) = drawing.right();
    let judged = judged(
        || answer(&text(drawing)),
        |document| JudgedStart::with_rank(compare(&truth, &right, document), document),
    );
    (right, judged)
}

impl Drawing {
    /// Returns the results of exact arithmetic.
    #[must_use]
    pub fn right(&self) -> (Truth, Expected) {
        let truth = Truth::of(self);
        let right = Expected::from_truth(&truth).with(elsewhere(&truth, self));
        (truth, right)
    }
}

fn compare(truth: &Truth, right: &Expected, document: &Value) -> Findings {
    let mut findings = Findings::default();
    ranks_and_reactions(truth, right, document, &mut findings);
    findings
}

/// Returns the findings for the document of a drawing.
#[must_use]
pub fn examine(drawing: &Drawing, document: &Value) -> Findings {
    let (truth, right) = drawing.right();
    compare(&truth, &right, document)
}
