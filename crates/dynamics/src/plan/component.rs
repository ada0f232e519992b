//! The plan of one component: bodies that feel each other.

use model::{Mechanism, Places, System};

use super::decisions::Decisions;
use crate::error::MotionError;
use crate::limits::NAMED;
use crate::options::MotionOptions;
use crate::prepare::Prepared;

/// What is done for a component, and what is not.
pub struct ComponentPlan<'a> {
    /// Its bodies in words.
    pub name: String,
    /// How large it is.
    pub sizes: Sizes,
    /// What was decided.
    pub decisions: Decisions,
    whose: Whose<'a>,
}

/// A prepared mechanism.
enum Whose<'a> {
    /// The whole.
    Whole(&'a Prepared),
    /// A part, and where it is.
    Part(Box<(Prepared, Places)>),
}

/// How large a component is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sizes {
    /// Bodies.
    pub bodies: usize,
    /// Velocities n_v.
    pub velocities: usize,
    /// Holonomic rows m.
    pub holonomic: usize,
    /// Nonholonomic rows h.
    pub nonholonomic: usize,
    /// Rank r of C.
    pub rank: usize,
}

impl Sizes {
    pub(super) fn of(prepared: &Prepared) -> Self {
        let layout = prepared.mechanism.layout();
        Self {
            bodies: prepared.mechanism.bodies().len(),
            velocities: layout.n_v,
            holonomic: layout.m,
            nonholonomic: layout.h,
            rank: prepared.decision.rank,
        }
    }

    /// All rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.holonomic + self.nonholonomic
    }

    /// Degrees of freedom n_v − r.
    #[must_use]
    pub fn mobility(&self) -> usize {
        self.velocities - self.rank
    }

    /// Degree of redundancy m + h − r.
    #[must_use]
    pub fn redundancy(&self) -> usize {
        self.rows() - self.rank
    }
}

impl<'a> ComponentPlan<'a> {
    /// The whole as one component, with reactions of the wanted groups.
    pub(super) fn whole(
        prepared: &'a Prepared,
        options: &MotionOptions,
        wanted: &[bool],
    ) -> Result<Self, MotionError> {
        let reactions = (0..wanted.len()).filter(|&k| wanted[k]).collect();
        Ok(Self {
            name: name(&prepared.mechanism),
            sizes: Sizes::of(prepared),
            decisions: Decisions::new(prepared, options, reactions)?,
            whose: Whose::Whole(prepared),
        })
    }

    /// A part; `wanted` are the groups of the whole.
    pub(super) fn part(
        (prepared, places): (Prepared, Places),
        options: &MotionOptions,
        wanted: &[bool],
    ) -> Result<Self, MotionError> {
        let groups = places.groups.iter().enumerate();
        let reactions = groups.filter(|(_, k)| wanted[**k]).map(|(own, _)| own);
        Ok(Self {
            name: name(&prepared.mechanism),
            sizes: Sizes::of(&prepared),
            decisions: Decisions::new(&prepared, options, reactions.collect())?,
            whose: Whose::Part(Box::new((prepared, places))),
        })
    }

    /// The mechanism with its start.
    #[must_use]
    pub fn prepared(&self) -> &Prepared {
        match &self.whose {
            Whose::Whole(prepared) => prepared,
            Whose::Part(part) => &part.0,
        }
    }

    /// Where it is in the whole; nothing if it is the whole.
    #[must_use]
    pub fn places(&self) -> Option<&Places> {
        match &self.whose {
            Whose::Whole(_) => None,
            Whose::Part(part) => Some(&part.1),
        }
    }
}

/// The bodies of a mechanism in words.
fn name(mechanism: &Mechanism) -> String {
    let names: Vec<&str> = mechanism.bodies().iter().map(|b| b.name.as_str()).collect();
    match names.len() {
        0..=NAMED => names.join(", "),
        n => format!("{}, … ({n} bodies)", names[..NAMED - 1].join(", ")),
    }
}
