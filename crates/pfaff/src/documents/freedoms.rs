//! The possible motions, with the drives and without them.

use model::words::{ROLL_TOGETHER, listed};
use model::{Mechanism, System};
use serde::Serialize;
use solvability::{FreeMotion, Freedoms, LeftOut};

use super::ByName;

/// Free motions, and the mechanism without its drives.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FreedomsDocument {
    /// Rank, redundancy and free motions without the drives; `null` if there are no drives.
    pub without_drives: Option<WithoutDrivesDocument>,
    /// Motions that are possible while the drives are locked.
    pub free_motions: Vec<FreeMotionDocument>,
    /// Freedoms without a description of their motions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_motions_left_out: Option<LeftOutDocument>,
    /// A basis of the velocities that are free at first order but excluded at second order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub freedoms_blocked: Vec<FreeMotionDocument>,
    /// A basis of the velocities for which the second-order conditions neither exclude a motion nor
    /// prove one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub freedoms_undecided: Vec<FreeMotionDocument>,
    /// Whether no motion is possible; `null` if this is not decided.
    pub cannot_move: Option<bool>,
    /// Joints with nonholonomic rows, such as wheels, if these rows prevent every motion.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub prevented_by: Vec<String>,
}

/// The mechanism without its drives.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WithoutDrivesDocument {
    /// Number of drives.
    pub drives: usize,
    /// Rank of the other rows.
    pub rank: usize,
    /// Number of the other rows minus their rank.
    pub redundancy: usize,
    /// Mobility n_v − rank.
    pub mobility: usize,
    /// Motions that are possible.
    pub free_motions: Vec<FreeMotionDocument>,
    /// Freedoms without a description of their motions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_motions_left_out: Option<LeftOutDocument>,
}

/// A free motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FreeMotionDocument {
    /// Description.
    pub text: String,
    /// `[vx, vy, omega]` of the moving bodies (m/s, rad/s), in space `[vx, vy, vz, wx, wy, wz]` of
    /// their frames in ground axes, for each degree of freedom in the description. A body that is
    /// free as a whole has three or six degrees of freedom; every other free motion has one. The
    /// largest angular velocity is 1, or the largest velocity if nothing rotates.
    pub velocities: Vec<ByName<Vec<f64>>>,
}

/// Freedoms that are counted but not described.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LeftOutDocument {
    /// Number of these freedoms.
    pub freedoms: usize,
    /// Reason why these freedoms are not described.
    pub reason: String,
}

impl FreedomsDocument {
    /// Builds the document of the free motions of a mechanism.
    #[must_use]
    pub fn new(freedoms: &Freedoms, mechanism: &Mechanism) -> Self {
        let without_drives = freedoms.without_drives.as_ref();
        let groups = &mechanism.layout().groups;
        let wheels = freedoms.prevented_by.iter();
        Self {
            without_drives: without_drives.map(|without| WithoutDrivesDocument {
                drives: without.drives,
                rank: without.ranks.rank,
                redundancy: without.ranks.redundancy,
                mobility: without.mobility,
                free_motions: documents(&without.motions.motions, mechanism),
                free_motions_left_out: without.motions.left_out.as_ref().map(Into::into),
            }),
            free_motions: documents(&freedoms.motions.motions, mechanism),
            free_motions_left_out: freedoms.motions.left_out.as_ref().map(Into::into),
            freedoms_blocked: documents(&freedoms.blocked, mechanism),
            freedoms_undecided: documents(&freedoms.undecided, mechanism),
            cannot_move: freedoms.cannot_move,
            prevented_by: wheels.map(|id| groups[id.0].name.clone()).collect(),
        }
    }

    /// States that wheels prevent every motion, and lists changes that allow a motion.
    #[must_use]
    pub fn prevented(&self) -> Option<String> {
        let names = listed(&self.prevented_by);
        let is_prevented = !self.prevented_by.is_empty();
        is_prevented.then(|| format!("{names} prevent every motion: {ROLL_TOGETHER}"))
    }

    /// Returns the mobility as a phrase: "mobility 0 with its drive, 1 without", or "mobility 1" if
    /// there is no drive.
    #[must_use]
    pub fn sentence(&self, mobility: usize) -> String {
        match &self.without_drives {
            None => format!("mobility {mobility}"),
            Some(without) => format!(
                "mobility {mobility} with {}, {} without",
                without.possessive(),
                without.mobility
            ),
        }
    }

    /// Returns the phrase of [`Self::sentence`], with a remark if the mechanism cannot move, or if
    /// the second-order conditions do not decide whether the mechanism can move.
    #[must_use]
    pub fn summary(&self, mobility: usize) -> String {
        let sentence = self.sentence(mobility);
        match self.cannot_move {
            Some(true) if self.first_order(mobility).is_none() => sentence + ": it cannot move",
            Some(true) => sentence + self.comma() + " at first order: it cannot move",
            None if !self.freedoms_undecided.is_empty() => {
                sentence + self.comma() + " at first order, not decided at second order"
            }
            _ => sentence,
        }
    }

    /// Returns a comma if the phrase already contains a comma, and otherwise an empty string.
    fn comma(&self) -> &'static str {
        if self.without_drives.is_some() {
            ","
        } else {
            ""
        }
    }

    /// Returns the mobility at first order as a phrase, if it is not zero. The phrase is "mobility
    /// 1", or "mobility 1 without its drive" if only the drive removes the last degree of freedom.
    #[must_use]
    pub fn first_order(&self, mobility: usize) -> Option<String> {
        match (&self.without_drives, mobility) {
            (Some(without), 0) if without.mobility > 0 => Some(format!(
                "mobility {} without {}",
                without.mobility,
                without.possessive()
            )),
            (_, 0) => None,
            (_, mobility) => Some(format!("mobility {mobility}")),
        }
    }

    /// States that the mechanism cannot move, as a sentence without a full stop.
    #[must_use]
    pub fn cannot_move_sentence(&self, mobility: usize) -> String {
        match &self.without_drives {
            None => "this mechanism cannot move".to_owned(),
            Some(without) if mobility > 0 => format!(
                "this mechanism cannot move while {} locked",
                without.are_locked()
            ),
            Some(without) => format!(
                "this mechanism cannot move, with {} or without",
                without.possessive()
            ),
        }
    }

    /// The mobility without the drives; `None` if there are no drives.
    #[must_use]
    pub fn mobility_without_drives(&self) -> Option<usize> {
        self.without_drives.as_ref().map(|without| without.mobility)
    }

    /// Returns the free motions as sentences with introductions. The motions with the drives come
    /// first, then the motions that the drives prescribe, each once, then the motions that are
    /// excluded at second order. The introductions distinguish these three kinds.
    #[must_use]
    pub fn sentences(&self) -> Vec<(String, String)> {
        let told = self.told().into_iter();
        told.map(|(lead, text, _)| (lead, text)).collect()
    }

    /// Returns the described motions of these sentences, with their introductions.
    #[must_use]
    pub fn motions(&self) -> Vec<(String, &FreeMotionDocument)> {
        let told = self.told().into_iter();
        told.filter_map(|(lead, _, motion)| Some((lead, motion?)))
            .collect()
    }

    fn told<'a>(&'a self) -> Vec<MotionSentence<'a>> {
        let mut told: Vec<MotionSentence<'a>> = Vec::new();
        let is_restricted = self.cannot_move == Some(true)
            || !self.freedoms_blocked.is_empty()
            || !self.freedoms_undecided.is_empty();
        let lead = if is_restricted {
            "free at first order"
        } else {
            "free"
        };
        let left_out = self.free_motions_left_out.as_ref();
        tell(&mut told, lead, &self.free_motions, left_out);
        if let Some(without) = &self.without_drives {
            let lead = format!("free without {}", without.possessive());
            let left_out = without.free_motions_left_out.as_ref();
            tell(&mut told, &lead, &without.free_motions, left_out);
        }
        let mut add = |lead: &str, motions: &'a [FreeMotionDocument]| {
            let motions = motions.iter();
            told.extend(motions.map(|motion| (lead.to_owned(), motion.text.clone(), Some(motion))));
        };
        if self.cannot_move != Some(true) {
            add("blocked at second order", &self.freedoms_blocked);
        }
        add("not decided at second order", &self.freedoms_undecided);
        told
    }
}

/// Introduction, sentence, and the motion if it is described.
type MotionSentence<'a> = (String, String, Option<&'a FreeMotionDocument>);

/// Adds the motions that the list does not contain yet, and the number of free motions that are
/// only counted.
fn tell<'a>(
    told: &mut Vec<MotionSentence<'a>>,
    lead: &str,
    motions: &'a [FreeMotionDocument],
    left_out: Option<&LeftOutDocument>,
) {
    for motion in motions {
        if told.iter().all(|(_, text, _)| *text != motion.text) {
            told.push((lead.to_owned(), motion.text.clone(), Some(motion)));
        }
    }
    if let Some(LeftOutDocument { freedoms, reason }) = left_out {
        let more = if motions.is_empty() { "" } else { " more" };
        let noun = if *freedoms == 1 {
            "freedom"
        } else {
            "freedoms"
        };
        let text = format!("{freedoms} {noun}{more} ({reason})");
        told.push((lead.to_owned(), text, None));
    }
}

impl WithoutDrivesDocument {
    /// Returns "its drive" or "its drives".
    #[must_use]
    pub fn possessive(&self) -> &'static str {
        match self.drives {
            1 => "its drive",
            _ => "its drives",
        }
    }

    /// Returns "its drive is" or "its drives are".
    fn are_locked(&self) -> &'static str {
        match self.drives {
            1 => "its drive is",
            _ => "its drives are",
        }
    }
}

fn shown_all(v: &[f64]) -> Vec<f64> {
    v.iter().copied().map(shown).collect()
}

fn documents(motions: &[FreeMotion], mechanism: &Mechanism) -> Vec<FreeMotionDocument> {
    let told = |motion: &FreeMotion| FreeMotionDocument {
        text: motion.text.clone(),
        velocities: motion
            .velocities
            .iter()
            .map(|bodies| {
                let named = bodies
                    .iter()
                    .map(|(b, v)| (mechanism.bodies()[*b].name.clone(), shown_all(v)));
                ByName(named.collect())
            })
            .collect(),
    };
    motions.iter().map(told).collect()
}

/// Rounds a number to 13 digits, the accuracy of a null space.
fn shown(x: f64) -> f64 {
    format!("{x:.12e}").parse().unwrap_or(x)
}

impl From<&LeftOut> for LeftOutDocument {
    fn from(left_out: &LeftOut) -> Self {
        Self {
            freedoms: left_out.freedoms,
            reason: left_out.reason.clone(),
        }
    }
}
