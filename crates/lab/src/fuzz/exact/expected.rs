//! The correct results for a mechanism, as plain data that are compared with an answer.

use super::truth::{Reaction, Truth};
use super::wrench::{Element, Meaning, Owner, Wrenches};

/// The correct results for a mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// Number of rows, including the rows of drives.
    pub rows: usize,
    /// The rank of C.
    pub rank: usize,
    /// Number of rows minus the rank.
    pub redundancy: usize,
    /// Number of velocities minus the rank.
    pub mobility: usize,
    /// The rank of the holonomic rows alone, including drives.
    pub rank_holonomic: usize,
    /// The rank of the nonholonomic rows alone.
    pub rank_nonholonomic: usize,
    /// The ranks without the rows of drives; `None` if there are no drives.
    pub without_drives: Option<WithoutDrives>,
    /// The redundancy according to theory, if it is known.
    pub theory: Option<usize>,
    /// The rank at other configurations, if it is known.
    pub elsewhere: Elsewhere,
    /// Joints and drives in the order of the file.
    pub reactions: Vec<ExpectedReaction>,
}

/// Ranks without the rows of drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WithoutDrives {
    /// The rank of the other rows.
    pub rank: usize,
    /// Number of the other rows minus their rank.
    pub redundancy: usize,
    /// Number of velocities minus the rank.
    pub mobility: usize,
}

/// The rank at almost all other configurations that the holonomic rows without drives allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elsewhere {
    /// The rank is the same as at this configuration.
    Same,
    /// The rank is the same, or lower if data within a stated tolerance have the lower rank.
    NotHigher,
    /// The rank is higher: this configuration is singular.
    Higher,
    /// The rank is unknown.
    Unknown,
}

impl Elsewhere {
    /// Returns a description of the value.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Same => "the same rank elsewhere",
            Self::NotHigher => "no higher rank elsewhere",
            Self::Higher => "a higher rank elsewhere",
            Self::Unknown => "unknown rank elsewhere",
        }
    }
}

/// The correct verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The value is the same in all solutions.
    Unique,
    /// The value is not the same in all solutions.
    NotUnique,
    /// The value is not the same in all solutions, but it may be the same for other data within the
    /// stated tolerance.
    Open,
}

impl Verdict {
    /// Whether the value is the same in all solutions.
    #[must_use]
    pub fn is_unique(self) -> bool {
        self == Self::Unique
    }
}

impl From<bool> for Verdict {
    fn from(is_unique: bool) -> Self {
        if is_unique {
            Self::Unique
        } else {
            Self::NotUnique
        }
    }
}

/// The unique parts of the reaction of a joint or drive. The reaction is the wrench on the first
/// body about the reference point on this body, in the axes of the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedReaction {
    /// The name of the joint or drive.
    pub name: String,
    /// Joint or drive of the reaction.
    pub owner: Owner,
    /// Whether the wrench is unique.
    pub is_unique: Verdict,
    /// Number of independent wrenches that the joint or drive can transmit, which is the rank of
    /// its rows.
    pub carried: usize,
    /// Number of independent directions in the space of these wrenches along which the reaction is
    /// not unique. The number of unique directions is `carried − free`.
    pub free: usize,
    /// Components of the wrench; `None` if the drawing does not define its reference point.
    pub wrench: Option<ExpectedWrench>,
    /// Rows of the reaction: index from 0, meaning, and whether the multiplier is unique.
    pub rows: Vec<(usize, Meaning, Verdict)>,
}

/// The unique components of a reaction.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedWrench {
    /// Components by name, and whether they are unique.
    pub components: Vec<(&'static str, Verdict)>,
    /// Whether the number of unique directions may differ within the stated tolerance.
    pub is_open: bool,
    /// Components in the self-stresses, one list for each independent self-stress, in units of the
    /// largest component.
    pub free: Vec<Vec<f64>>,
}

impl ExpectedReaction {
    /// Returns the rows of the reaction, from 0.
    #[must_use]
    pub fn own_rows(&self) -> Vec<usize> {
        self.rows.iter().map(|(i, ..)| *i).collect()
    }

    /// Returns the components by name, and whether they are unique; empty if the reference point is
    /// unknown.
    #[must_use]
    pub fn components(&self) -> &[(&'static str, Verdict)] {
        self.wrench.as_ref().map_or(&[], |w| &w.components)
    }

    /// Whether the multipliers are unique.
    #[must_use]
    pub fn multipliers(&self) -> Verdict {
        let has = |verdict| self.rows.iter().any(|(.., v)| *v == verdict);
        if has(Verdict::NotUnique) {
            Verdict::NotUnique
        } else if has(Verdict::Open) {
            Verdict::Open
        } else {
            Verdict::Unique
        }
    }
}

impl Expected {
    /// Computes the correct results for a drawing.
    #[must_use]
    pub fn of(drawing: impl Into<Wrenches>) -> Self {
        Self::from_truth(&Truth::of(drawing))
    }

    /// Computes the correct results from the results of the elimination.
    #[must_use]
    pub fn from_truth(truth: &Truth) -> Self {
        let is_late = |wanted: bool| {
            let rows = truth.rows_where(|row| row.meaning.is_nonholonomic() == wanted);
            truth.rank_of(&rows)
        };
        let left = truth.rows_where(|row| row.meaning != Meaning::Driven);
        let without_drives = (left.len() < truth.rows.len()).then(|| {
            let rank = truth.rank_of(&left);
            WithoutDrives {
                rank,
                redundancy: left.len() - rank,
                mobility: truth.velocities.len() * truth.bodies - rank,
            }
        });
        let elements = truth.elements.iter();
        Self {
            rows: truth.rows.len(),
            rank: truth.rank(),
            redundancy: truth.redundancy(),
            mobility: truth.mobility(),
            rank_holonomic: is_late(false),
            rank_nonholonomic: is_late(true),
            without_drives,
            theory: truth.theory,
            elsewhere: Elsewhere::Unknown,
            reactions: elements.map(|element| reaction(truth, element)).collect(),
        }
    }

    /// Adds information about the rank at other configurations.
    #[must_use]
    pub fn with(self, elsewhere: Elsewhere) -> Self {
        Self { elsewhere, ..self }
    }

    /// Finds the reaction with this name.
    #[must_use]
    pub fn reaction(&self, name: &str) -> Option<&ExpectedReaction> {
        self.reactions.iter().find(|r| r.name == name)
    }

    /// Describes the results as text, for the head of a file.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = format!(
            "rank {} of {} rows, redundancy {}, mobility {}; alone Φq {}, Ψ {}\n",
            self.rank,
            self.rows,
            self.redundancy,
            self.mobility,
            self.rank_holonomic,
            self.rank_nonholonomic
        );
        if let Some(left) = self.without_drives {
            text.push_str(&format!(
                "without drives: rank {}, redundancy {}, mobility {}\n",
                left.rank, left.redundancy, left.mobility
            ));
        }
        for reaction in &self.reactions {
            let rows = reaction.rows.iter().filter(|(.., v)| !v.is_unique());
            let rows: Vec<usize> = rows.map(|(i, ..)| i + 1).collect();
            if rows.is_empty() {
                continue;
            }
            let axes = reaction.components().iter();
            let free: Vec<&str> = axes.filter(|(_, v)| !v.is_unique()).map(|a| a.0).collect();
            let word = if reaction.is_unique.is_unique() {
                "unique"
            } else {
                "not unique"
            };
            text.push_str(&format!(
                "{}: {word}, free are {free:?} ({} of {} directions), and rows {rows:?}\n",
                reaction.name, reaction.free, reaction.carried
            ));
        }
        text + "everything else is unique"
    }
}

fn reaction(truth: &Truth, element: &Element) -> ExpectedReaction {
    let rows = truth.rows_of(element.owner);
    let free = truth.free_directions(&rows);
    let components = |free: &[Reaction]| {
        let components = truth.components.iter().enumerate();
        let is_unique = |k: usize| free.iter().all(|w| truth.is_zero(w, k));
        components
            .map(|(k, component)| (component.name, is_unique(k).into()))
            .collect()
    };
    let wrench = truth
        .free_wrenches(element.owner)
        .map(|free| ExpectedWrench {
            components: components(&free),
            is_open: false,
            free: free.iter().map(|w| truth.rounded(w, &w.size())).collect(),
        });
    ExpectedReaction {
        name: element.name.clone(),
        owner: element.owner,
        is_unique: (free == 0).into(),
        carried: truth.carried_directions(&rows),
        free,
        wrench,
        rows: rows
            .into_iter()
            .map(|i| (i, truth.rows[i].meaning, truth.row_is_unique(i).into()))
            .collect(),
    }
}
