//! Comparison of the answers for drawings in space with exact arithmetic: cases of the campaign of
//! [`crate::fuzz::exact::tally`].

use serde_json::Value;

use super::drawing::Drawing;
use super::expected::AXES;
use super::permanence::elsewhere;
use super::pose::extent;
use super::rows::{Meaning, Owner};
use super::text::text;
use super::truth::Truth;
use super::{Expected, scene};
use crate::fuzz::exact::answer::answer;
use crate::fuzz::exact::examine::ranks_and_reactions;
use crate::fuzz::exact::findings::{Findings, rounding_at};
use crate::fuzz::exact::outcome::{Outcome, judged};
use crate::fuzz::exact::reference::{
    Elsewhere, Ranks, Reference, RightReaction, RightWrench, Verdict,
};

/// Tests one scene with all digits of a double.
#[must_use]
pub fn outcome(seed: u64, number: u64) -> Outcome {
    let scene = scene(seed, number);
    let (findings, rank) = compared(&scene.drawing);
    let right = Expected::of(&scene.drawing);
    Outcome {
        family: scene.family.name(),
        writing: scene.writing,
        text: text(&scene.drawing),
        findings,
        rank,
        truth: right.describe(),
        redundancy: right.redundancy,
    }
}

/// The findings for a drawing, and the rank of the answer if it is decided.
#[must_use]
pub fn compared(drawing: &Drawing) -> (Findings, Option<u64>) {
    judged(
        || answer(&text(drawing)),
        |document| examine(drawing, document),
    )
}

/// The findings for the document of a drawing.
#[must_use]
pub fn examine(drawing: &Drawing, document: &Value) -> Findings {
    let truth = Truth::of(drawing);
    let right = Right {
        truth: &truth,
        elsewhere: elsewhere(&truth),
        known_to: 0.0,
    };
    let mut findings = Findings::default();
    ranks_and_reactions(&right, document, &mut findings);
    findings
}

/// What exact arithmetic says of a drawing.
pub(super) struct Right<'a> {
    pub(super) truth: &'a Truth<'a>,
    /// The rank at other poses.
    pub(super) elsewhere: Elsewhere,
    /// What directions are known to, beyond rounding.
    pub(super) known_to: f64,
}

impl Reference for Right<'_> {
    fn ranks(&self) -> Ranks {
        let truth = self.truth;
        let where_late = |wanted: bool| {
            truth.rank_of(&truth.rows_where(|row| row.meaning.is_nonholonomic() == wanted))
        };
        let drives = truth.drawing.drives.len();
        let left = truth.rows_where(|row| row.meaning != Meaning::Driven);
        Ranks {
            rows: truth.rows.len(),
            velocities: 6 * truth.drawing.bodies.len(),
            all: truth.rank(),
            holonomic: where_late(false),
            nonholonomic: where_late(true),
            without_drives: (drives > 0).then(|| [truth.rank_of(&left), drives]),
        }
    }

    fn rank_of(&self, rows: &[usize]) -> usize {
        self.truth.rank_of(rows)
    }

    fn reactions(&self) -> Vec<RightReaction> {
        let truth = self.truth;
        let mut reactions = Vec::new();
        for (k, joint) in truth.drawing.joints.iter().enumerate() {
            let own = truth.rows_of(Owner::Joint(k));
            reactions.push(self.reaction(joint.name.clone(), Owner::Joint(k), own));
        }
        for (k, drive) in truth.drawing.drives.iter().enumerate() {
            let own = truth.rows_of(Owner::Drive(k));
            reactions.push(self.reaction(drive.name.clone(), Owner::Drive(k), own));
        }
        reactions
    }

    fn elsewhere(&self) -> Elsewhere {
        self.elsewhere
    }

    fn rounding(&self) -> f64 {
        rounding_at(extent(self.truth.drawing)).max(self.known_to)
    }
}

impl Right<'_> {
    fn reaction(&self, name: String, owner: Owner, own: Vec<usize>) -> RightReaction {
        let truth = self.truth;
        let free = truth.free_of(&own, &truth.place(owner));
        let is_unique = |k: usize| free.iter().all(|w| w.is_zero(k));
        let components = AXES.into_iter().zip((0..6).map(is_unique));
        let components: Vec<(&str, Verdict)> =
            components.map(|(axis, u)| (axis, u.into())).collect();
        RightReaction {
            name,
            is_unique: (0..6).all(is_unique).into(),
            wrench: Some(RightWrench {
                components,
                live: truth.carried_directions_of(&own) - truth.free_directions_of(&own),
                is_open: false,
                free: free.iter().map(|w| w.rounded().to_vec()).collect(),
            }),
            rows: own
                .into_iter()
                .map(|i| (i, truth.row_is_unique(i).into()))
                .collect(),
        }
    }
}
