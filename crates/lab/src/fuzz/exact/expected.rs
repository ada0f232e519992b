//! The right answer for a mechanism as plain data: what the comparison with an answer reads.

use super::truth::{Reaction, Truth};
use super::wrench::{Element, Meaning, Owner, Wrenches};

/// The right answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// Number of rows, those of drives included.
    pub rows: usize,
    /// The rank of C.
    pub rank: usize,
    /// Rows minus rank.
    pub redundancy: usize,
    /// Velocities minus rank.
    pub mobility: usize,
    /// The rank of the holonomic rows alone, drives included.
    pub rank_holonomic: usize,
    /// The rank of the nonholonomic rows alone.
    pub rank_nonholonomic: usize,
    /// The same without the rows of drives; `None` if there are no drives.
    pub without_drives: Option<WithoutDrives>,
    /// The redundancy that theory gives, if it does.
    pub theory: Option<usize>,
    /// What is known of the rank at other configurations.
    pub elsewhere: Elsewhere,
    /// Joints and drives in the order of the file.
    pub reactions: Vec<ExpectedReaction>,
}

/// Ranks without the rows of drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WithoutDrives {
    /// The rank.
    pub rank: usize,
    /// Rows that are left minus rank.
    pub redundancy: usize,
    /// Velocities minus rank.
    pub mobility: usize,
}

/// The rank at almost all other configurations that the holonomic rows without drives allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elsewhere {
    /// The same as at this one.
    Same,
    /// The same, or a lower one if data within a stated tolerance have it.
    NotHigher,
    /// A higher one: this configuration is singular.
    Higher,
    /// Not known.
    Unknown,
}

impl Elsewhere {
    /// In words.
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

/// The right verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The same in all solutions.
    Unique,
    /// Not the same in all solutions.
    NotUnique,
    /// Not the same in all solutions, but data within the stated tolerance may make it so.
    Open,
}

impl Verdict {
    /// Whether it is the same in all solutions.
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

/// What is unique of the reaction of a joint or drive: a wrench on its first body, about its place
/// on that body, in the axes of the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedReaction {
    /// The name of the joint or drive.
    pub name: String,
    /// Its joint or drive.
    pub owner: Owner,
    /// Whether the wrench is unique.
    pub is_unique: Verdict,
    /// Independent wrenches that it can carry: the rank of its rows.
    pub carried: usize,
    /// Independent directions of these along which it is not unique; the others are
    /// `carried − free`.
    pub free: usize,
    /// Its components; `None` if the drawing does not define its place.
    pub wrench: Option<ExpectedWrench>,
    /// Its rows: index from 0, meaning, and whether the multiplier is unique.
    pub rows: Vec<(usize, Meaning, Verdict)>,
}

/// What is unique of the components of a reaction.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedWrench {
    /// Its components by name, and whether they are unique.
    pub components: Vec<(&'static str, Verdict)>,
    /// Whether the number of unique directions may be another one within the stated tolerance.
    pub is_open: bool,
    /// Its components in the solutions without loads, one for each independent solution, in units
    /// of the largest.
    pub free: Vec<Vec<f64>>,
}

impl ExpectedReaction {
    /// Its rows, from 0.
    #[must_use]
    pub fn own_rows(&self) -> Vec<usize> {
        self.rows.iter().map(|(i, ..)| *i).collect()
    }

    /// Its components by name, and whether they are unique; none if its place is not known.
    #[must_use]
    pub fn components(&self) -> &[(&'static str, Verdict)] {
        self.wrench.as_ref().map_or(&[], |w| &w.components)
    }

    /// Whether its multipliers are unique.
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
    /// The right answer for a drawing.
    #[must_use]
    pub fn of(drawing: impl Into<Wrenches>) -> Self {
        Self::from_truth(&Truth::of(drawing))
    }

    /// The same after the elimination.
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

    /// The same where more is known of the rank at other configurations.
    #[must_use]
    pub fn with(self, elsewhere: Elsewhere) -> Self {
        Self { elsewhere, ..self }
    }

    /// The reaction of a name.
    #[must_use]
    pub fn reaction(&self, name: &str) -> Option<&ExpectedReaction> {
        self.reactions.iter().find(|r| r.name == name)
    }

    /// The answer in words, for the head of a file.
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
