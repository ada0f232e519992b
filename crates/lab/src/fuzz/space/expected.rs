//! The right answer for a drawing as plain data, in the order and under the names of its text.

use super::drawing::Drawing;
use super::rows::{Meaning, Owner};
use super::truth::Truth;

/// The right answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// Number of rows, those of drives included.
    pub rows: usize,
    /// The rank of C.
    pub rank: usize,
    /// Rows minus rank.
    pub redundancy: usize,
    /// Velocities, six for each body, minus rank.
    pub mobility: usize,
    /// The rank of the holonomic rows alone, drives included.
    pub rank_holonomic: usize,
    /// The rank of the nonholonomic rows alone.
    pub rank_nonholonomic: usize,
    /// The same without the rows of drives; `None` if there are no drives.
    pub without_drives: Option<WithoutDrives>,
    /// The redundancy that theory gives, if it does.
    pub theory: Option<usize>,
    /// Joints in the order of the file, then drives.
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

/// What is unique of the reaction of a joint or drive: a wrench on its first body, about its place
/// on that body, in the axes of the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedReaction {
    /// The name of the joint or drive.
    pub name: String,
    /// Its joint or drive.
    pub owner: Owner,
    /// Whether the wrench is unique.
    pub is_unique: bool,
    /// Whether its force is unique.
    pub force_is_unique: bool,
    /// Whether its moment about the place is unique.
    pub moment_is_unique: bool,
    /// Whether Fx, Fy, Fz, Tx, Ty, Tz are unique.
    pub components: [bool; 6],
    /// Independent wrenches that it can carry: the rank of its rows.
    pub carried: usize,
    /// Independent directions of these along which it is not unique; the others are
    /// `carried − free`.
    pub free: usize,
    /// Wrenches that it carries in the solutions without loads, one for each independent solution
    /// in which it is not zero; the largest number of size 1.
    pub free_wrenches: Vec<[f64; 6]>,
    /// Its rows: index from 0, meaning, and whether the multiplier is unique.
    pub rows: Vec<(usize, Meaning, bool)>,
}

impl Expected {
    /// The right answer for a drawing.
    #[must_use]
    pub fn of(drawing: &Drawing) -> Self {
        Self::from_truth(&Truth::of(drawing))
    }

    /// The same after the elimination.
    #[must_use]
    pub fn from_truth(truth: &Truth<'_>) -> Self {
        let drawing = truth.drawing;
        let is_late = |wanted: bool| {
            let rows = truth.rows_where(|row| row.meaning.is_nonholonomic() == wanted);
            truth.rank_of(&rows)
        };
        let without_drives = (!drawing.drives.is_empty()).then(|| {
            let left = truth.rows_where(|row| row.meaning != Meaning::Driven);
            let rank = truth.rank_of(&left);
            WithoutDrives {
                rank,
                redundancy: left.len() - rank,
                mobility: 6 * drawing.bodies.len() - rank,
            }
        });
        let joints = drawing.joints.iter().map(|j| &j.name).enumerate();
        let joints = joints.map(|(k, name)| (Owner::Joint(k), name));
        let drives = drawing.drives.iter().map(|d| &d.name).enumerate();
        let drives = drives.map(|(k, name)| (Owner::Drive(k), name));
        Self {
            rows: truth.rows.len(),
            rank: truth.rank(),
            redundancy: truth.redundancy(),
            mobility: truth.mobility(),
            rank_holonomic: is_late(false),
            rank_nonholonomic: is_late(true),
            without_drives,
            theory: drawing.redundancy,
            reactions: joints
                .chain(drives)
                .map(|(owner, name)| reaction(truth, owner, name))
                .collect(),
        }
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
            let rows = reaction.rows.iter().filter(|(_, _, is_unique)| !is_unique);
            let rows: Vec<usize> = rows.map(|(i, _, _)| i + 1).collect();
            if rows.is_empty() {
                continue;
            }
            let axes = AXES.into_iter().zip(reaction.components);
            let free: Vec<&str> = axes.filter(|(_, u)| !u).map(|(axis, _)| axis).collect();
            let word = if reaction.is_unique {
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

/// Names of the components of a reaction.
pub const AXES: [&str; 6] = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];

fn reaction(truth: &Truth<'_>, owner: Owner, name: &str) -> ExpectedReaction {
    let free = truth.free_wrenches(owner);
    let components = [0, 1, 2, 3, 4, 5].map(|k| free.iter().all(|w| w.is_zero(k)));
    let all_of = |part: &[bool]| part.iter().all(|&is_unique| is_unique);
    let rows = truth.rows_of(owner).into_iter();
    let rows = rows.map(|i| (i, truth.rows[i].meaning, truth.row_is_unique(i)));
    let is_live = |w: &[f64; 6]| w.iter().any(|&x| x != 0.0);
    ExpectedReaction {
        name: name.to_owned(),
        owner,
        is_unique: all_of(&components),
        force_is_unique: all_of(&components[..3]),
        moment_is_unique: all_of(&components[3..]),
        components,
        carried: truth.carried_directions(owner),
        free: truth.free_directions(owner),
        free_wrenches: free.iter().map(|w| w.rounded()).filter(is_live).collect(),
        rows: rows.collect(),
    }
}
