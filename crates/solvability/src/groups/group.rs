//! Groups of reactions that the user defines.

use model::{ConstraintId, Layout, SpaceKind};

use super::error::RequestError;

/// A group on which a verdict is requested.
#[derive(Clone, Debug, PartialEq)]
pub enum Group {
    /// The reactions of these joints and drives together. The reactions are unique iff each of the
    /// reactions is unique.
    Members(Vec<ConstraintId>),
    /// These joints and drives as one joint. The joint is unique iff the total wrench on each body
    /// is unique.
    OneJoint(Vec<ConstraintId>),
    /// The number `Σ coefficient · component`.
    Combination(Vec<Term>),
    /// The sum `Σ coefficient · wrench`, with each wrench on the first body of its joint. Torques
    /// refer to the reference point of the first joint.
    WrenchSum(Vec<(f64, ConstraintId)>),
    /// The sum of the reactions of all joints and drives that act on these bodies. Torques refer to
    /// the origin of the first body. The sum is unique by the Newton-Euler equations.
    Resultant(Vec<usize>),
}

/// One component of a reaction, times a coefficient.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// The joint or drive.
    pub reaction: ConstraintId,
    /// Name of the component: `Fx`, `Fy`, `T`, or the named component of the definition.
    pub component: String,
    /// The coefficient.
    pub coefficient: f64,
}

/// Error for a group without members.
pub(crate) const NO_REACTION: RequestError = RequestError::Empty {
    of: "joint or drive",
};

impl Group {
    /// Returns the names of the numbers: `sum`, or the components of a wrench. A group of several
    /// separate reactions has no numbers.
    #[must_use]
    pub fn number_names(&self, space: SpaceKind) -> &'static [&'static str] {
        match self {
            Self::Members(_) | Self::OneJoint(_) => &[],
            Self::Combination(_) => &["sum"],
            Self::WrenchSum(_) | Self::Resultant(_) => space.components(),
        }
    }

    /// Returns the SI unit of the sum if all of its terms have the same unit.
    #[must_use]
    pub fn unit(&self, layout: &Layout) -> Option<&'static str> {
        let Self::Combination(terms) = self else {
            return None;
        };
        let mut units = terms
            .iter()
            .map(|term| layout.load_unit(term.reaction, &term.component));
        let first = units.next()?;
        units.all(|unit| unit == first).then_some(first)
    }

    /// Returns the part of the group that belongs to some of the joints and drives, with the ids of
    /// this selection. Returns `None` if the group has no such part.
    #[must_use]
    pub fn share(&self, own: impl Fn(ConstraintId) -> Option<ConstraintId>) -> Option<Self> {
        let ids = |ids: &[ConstraintId]| ids.iter().filter_map(|&id| own(id)).collect::<Vec<_>>();
        let share = match self {
            Self::Members(members) => Self::Members(ids(members)),
            Self::OneJoint(members) => Self::OneJoint(ids(members)),
            Self::Combination(terms) => {
                let term = |term: &Term| {
                    Some(Term {
                        reaction: own(term.reaction)?,
                        ..term.clone()
                    })
                };
                Self::Combination(terms.iter().filter_map(term).collect())
            }
            Self::WrenchSum(terms) => {
                let terms = terms.iter();
                Self::WrenchSum(terms.filter_map(|&(c, id)| Some((c, own(id)?))).collect())
            }
            Self::Resultant(_) => return None,
        };
        (!share.is_empty()).then_some(share)
    }

    /// Returns whether the group lists this joint or drive.
    #[must_use]
    pub fn has(&self, id: ConstraintId) -> bool {
        self.share(|own| (own == id).then_some(own)).is_some()
    }

    fn is_empty(&self) -> bool {
        match self {
            Self::Members(all) | Self::OneJoint(all) => all.is_empty(),
            Self::Combination(terms) => terms.is_empty(),
            Self::WrenchSum(terms) => terms.is_empty(),
            Self::Resultant(bodies) => bodies.is_empty(),
        }
    }
}
