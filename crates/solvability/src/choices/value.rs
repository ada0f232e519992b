//! Numbers of a distribution: unique ones, and chosen ones with the name of the choice.

use crate::limits::{FIRST_NAMED, NAMED_ROWS};
use std::fmt;
use std::sync::Arc;

use model::{ConstraintId, Layout, RowLabel};

use super::error::{list, row_word};
use super::{Choice, Compliance};
use crate::finite::NoFiniteReaction;
use crate::words;

/// A number of a distribution.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// The same in every solution: determined by the model.
    Unique(f64),
    /// One of many possible values. A number whose verdict is undecided is also given as chosen.
    Chosen {
        /// The number.
        value: f64,
        /// The choice on which the number depends.
        by: Label,
    },
    /// No number, whatever the verdict and the choice: the equations have solutions, but the motion
    /// does not have finite reactions, or it is not decided whether it has.
    NotFinite(Arc<NoFiniteReaction>),
}

impl Value {
    /// The number with or without its label; `None` without a number.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Unique(value) | Self::Chosen { value, .. } => Some(*value),
            Self::NotFinite(_) => None,
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unique(value) => fmt::Display::fmt(value, f),
            Self::Chosen { value, by } => {
                fmt::Display::fmt(value, f)?;
                write!(f, " ({by})")
            }
            Self::NotFinite(why) => fmt::Display::fmt(why, f),
        }
    }
}

impl std::ops::Add for Value {
    type Output = Self;

    /// A sum is unique if both numbers are; a sum of two chosen numbers has the label of the first.
    /// Without one of the numbers there is no sum.
    fn add(self, other: Self) -> Self {
        match (self, other) {
            (Self::NotFinite(why), _) | (_, Self::NotFinite(why)) => Self::NotFinite(why),
            (Self::Unique(a), Self::Unique(b)) => Self::Unique(a + b),
            (Self::Unique(a), Self::Chosen { value, by })
            | (Self::Chosen { value, by }, Self::Unique(a)) => Self::Chosen {
                value: value + a,
                by,
            },
            (Self::Chosen { value, by }, Self::Chosen { value: other, .. }) => Self::Chosen {
                value: value + other,
                by,
            },
        }
    }
}

/// Names the choice that a number depends on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label(Arc<str>);

impl fmt::Display for Label {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Label {
    /// Name of a choice in which these joints and drives are rigid.
    pub(crate) fn of(layout: &Layout, choice: &Choice, rigid: &[ConstraintId]) -> Self {
        let text = match choice {
            Choice::MinimumNorm(w) => format!(
                "minimum norm, forces weighted by {}/N and torques by {}/(N·m)",
                w.force, w.torque
            ),
            Choice::Compliance(joints) => {
                let joint = |j: &Compliance| {
                    let name = &layout.groups[j.reaction.0].name;
                    let axes = ["x", "y", "z"].into_iter().zip(j.along);
                    let directions = axes.take(layout.space.n_translations());
                    let along = if directions.clone().all(|(_, along)| along == j.along[0]) {
                        format!("{:e} m/N", j.along[0])
                    } else {
                        let each = directions.map(|(axis, c)| format!("{c:e} m/N along {axis}"));
                        each.collect::<Vec<_>>().join(", ")
                    };
                    if j.rotation == 0.0 {
                        format!("`{name}` {along}")
                    } else {
                        format!("`{name}` {along}, {:e} rad/(N·m)", j.rotation)
                    }
                };
                let listed: Vec<String> = joints.iter().map(joint).collect();
                let rigid = match words::names(layout, rigid).as_slice() {
                    [] => String::new(),
                    names => format!("; rigid: {}", names.join(", ")),
                };
                format!("elastic supports: {}{rigid}", listed.join("; "))
            }
            Choice::Elimination(rows) => {
                let known = rows.iter().filter_map(|&i| layout.labels.get(i));
                let labels: Vec<RowLabel> = known.cloned().collect();
                // The label is repeated at every number, so it lists only the first rows.
                let (told, more) = if labels.len() > NAMED_ROWS {
                    labels.split_at(FIRST_NAMED)
                } else {
                    (&labels[..], &[][..])
                };
                let word = row_word(&labels);
                match more.len() {
                    0 => format!("no reaction in {word} {}", list(told)),
                    more => format!("no reaction in {word} {} and {more} more", list(told)),
                }
            }
        };
        Self(text.into())
    }
}
