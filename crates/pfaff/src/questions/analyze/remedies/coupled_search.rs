//! The search for the cheapest replacement of coupled joints. The search tests cheap types first.

use solvability::{CoupledJoints, WeakerJoint};

use super::answer::RemedyDocument;
use super::types::OtherType;

/// The search for a remedy of coupled joints.
pub(super) struct CoupledSearch<'t> {
    pub(super) set: &'t CoupledJoints,
    /// The other types of each joint. The cheapest type comes first.
    types: &'t [Vec<OtherType>],
    /// The weaker joints that were found, with their costs.
    pub(super) weaker: Vec<(WeakerJoint, usize)>,
    /// The types of the weaker joints.
    others: Vec<&'t OtherType>,
    /// Sets of weaker joints that are not verified.
    rejected: Vec<Vec<usize>>,
    pub(super) remedy: Option<RemedyDocument>,
}

impl<'t> CoupledSearch<'t> {
    pub(super) fn new(set: &'t CoupledJoints, types: &'t [Vec<OtherType>]) -> Self {
        Self {
            set,
            types,
            weaker: Vec::new(),
            others: Vec::new(),
            rejected: Vec::new(),
            remedy: None,
        }
    }

    /// Returns the types that one round tries: one type for each joint.
    pub(super) fn tried(&self, round: usize) -> impl Iterator<Item = &'t OtherType> {
        let types = self.types.iter();
        types.filter_map(move |own| own.get(round))
    }

    /// Adds a weaker joint of one of these types, if it belongs to the coupled joints.
    pub(super) fn add(&mut self, joint: &WeakerJoint, tried: &[&'t OtherType]) {
        let other = tried.iter().find(|other| other.id == joint.joint);
        if let Some(other) = other.filter(|_| self.set.joints.contains(&joint.joint)) {
            self.weaker.push((joint.clone(), other.cost));
            self.others.push(other);
        }
    }

    /// Returns the smallest cost of the types of this round and of all later rounds. Returns `None`
    /// if there are no types. A set that contains such a type costs at least this much.
    pub(super) fn least_cost(&self, round: usize) -> Option<usize> {
        // The types of a joint are sorted by their cost.
        self.tried(round).map(|other| other.cost).min()
    }

    /// Returns the first set of weaker joints that is verified.
    pub(super) fn verified(
        &mut self,
        ways: Vec<Vec<usize>>,
        is_verified: impl Fn(&[&OtherType]) -> bool,
    ) -> Option<Vec<&'t OtherType>> {
        for way in ways {
            if self.rejected.contains(&way) {
                continue;
            }
            let mut types: Vec<&OtherType> = way.iter().map(|&k| self.others[k]).collect();
            types.sort_by_key(|other| other.id);
            if is_verified(&types) {
                return Some(types);
            }
            self.rejected.push(way);
        }
        None
    }
}
