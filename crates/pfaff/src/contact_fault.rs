//! Contacts that open or slip where an answer needs them closed.

use std::fmt;

use model::words::clause;
use solvability::PermittedError;

/// The reason why contacts do not all stay closed and hold at a configuration.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ContactFault {
    /// No sharing of the loads presses on all one-sided joints; these joints open.
    Opens(Vec<String>),
    /// Every sharing of the loads makes one of these contacts slip.
    Slips(Vec<String>),
    /// The question has no certain answer.
    Undecided(PermittedError),
}

impl fmt::Display for ContactFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Opens(joints) => write!(
                f,
                "{}: no sharing of the loads presses on all one-sided joints; leave out `one_sided` for contacts \
                 that can pull",
                clause(joints, ["opens", "open"])
            ),
            Self::Slips(joints) => write!(
                f,
                "{} for every sharing of the loads; increase `grip`, or leave it out for contacts that never slip",
                clause(joints, ["slips", "slip"])
            ),
            Self::Undecided(e) => {
                write!(f, "it is not decided whether all contacts stay closed: {e}")
            }
        }
    }
}
