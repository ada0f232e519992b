//! Splits a mechanism into independent mechanisms. Two bodies belong to the same mechanism if a
//! joint, a drive or a force connects them. The ground does not connect bodies, because it does not
//! move under any force.

use linalg::DisjointSets;

use super::build::Builder;
use super::{FunctionForm, KernelInput, Mechanism};
use crate::body::BodyRef;
use crate::element::{PlacedForce, Site};
use crate::function::Function;

/// A mechanism that is a part of another mechanism.
#[derive(Clone)]
pub struct Part {
    /// The part as a mechanism. The rows of the part have the names and indices that they have in
    /// the whole mechanism.
    pub mechanism: Mechanism,
    /// Indices of the elements of the part in the whole mechanism.
    pub places: Places,
}

/// Indices of the elements of a part in the whole mechanism; all lists are in ascending order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Places {
    /// Indices of the bodies of the part.
    pub bodies: Vec<usize>,
    /// Indices of the coordinates of the part.
    pub coordinates: Vec<usize>,
    /// Indices of the velocities of the part.
    pub velocities: Vec<usize>,
    /// Indices of the rows of C of the part.
    pub rows: Vec<usize>,
    /// Indices of the joints and drives of the part in the list of groups.
    pub groups: Vec<usize>,
}

impl Mechanism {
    /// Returns the sets of connected bodies. Each set is in ascending order, and the sets are
    /// ordered by their first bodies.
    ///
    /// ```
    /// use joints::Revolute;
    /// use pfaff_model::{Body, BodyRef, Description, Joint, Mechanism};
    /// // Two pendulums on the same ground, the first of two bodies.
    /// let body = |name: &str| Body { name: name.into(), mass: 1.0, inertia: 1.0, ..Body::default() };
    /// let pin = |name: &str, i, j| Joint::new(name, &[i, j], Revolute { s_i: [0.0; 2], s_j: [0.0; 2] });
    /// let d = Description {
    ///     bodies: vec![body("arm"), body("other"), body("hand")],
    ///     joints: vec![
    ///         pin("shoulder", BodyRef::Ground, BodyRef::Body(0)),
    ///         pin("elsewhere", BodyRef::Ground, BodyRef::Body(1)),
    ///         pin("wrist", BodyRef::Body(0), BodyRef::Body(2)),
    ///     ],
    ///     ..Description::default()
    /// };
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// assert_eq!(mechanism.components(), [vec![0, 2], vec![1]]);
    /// let places = mechanism.part(&[0, 2]).places;
    /// assert_eq!((places.rows, places.groups), (vec![0, 1, 4, 5], vec![0, 2]));
    /// ```
    #[must_use]
    pub fn components(&self) -> Vec<Vec<usize>> {
        if !self.elements.controllers.is_empty() {
            return vec![(0..self.bodies.len()).collect()];
        }
        connected(self.bodies.len(), self.elements.sites())
    }

    /// Works like [`Mechanism::components`], but only these joints and drives connect bodies. A
    /// body without any of these joints and drives is a separate set. Forces do not connect bodies
    /// in this function. For example, a spring between two machines does not connect them.
    ///
    /// ```
    /// use joints::{Revolute, TorsionSpringDamper};
    /// use pfaff_model::{Body, BodyRef, Description, Mechanism};
    /// let mut d = Description::new("two pendulums on a spring");
    /// let [a, b] = ["a", "b"].map(|name| d.body(Body::new(name, 1.0, 1.0)));
    /// for body in [a, b] {
    ///     let pin = Revolute { s_i: [0.0; 2], s_j: [0.0; 2] };
    ///     d.joint(&format!("{body:?}"), &[BodyRef::Ground, body], pin);
    /// }
    /// let spring = TorsionSpringDamper::new(1.0, 0.0);
    /// d.force("spring", &[a, b], spring);
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// assert_eq!(mechanism.components(), [vec![0, 1]]);
    /// assert_eq!(mechanism.joined(&[0, 1]), [vec![0], vec![1]]);
    /// ```
    ///
    /// # Panics
    /// Panics if a group does not exist.
    #[must_use]
    pub fn joined(&self, groups: &[usize]) -> Vec<Vec<usize>> {
        let constraints = groups.iter().map(|&k| &self.elements.constraints[k]);
        connected(self.bodies.len(), constraints.map(|c| &c.site))
    }

    /// Returns the mechanism of some bodies with all joints, drives and forces on these bodies,
    /// which must not act on other bodies. The bodies are one or more sets of
    /// [`Mechanism::components`]. Initial values of the part are the initial values of the whole
    /// mechanism.
    ///
    /// # Panics
    /// Panics if the bodies are not in ascending order, do not exist, or are connected to other
    /// bodies by a joint, drive or force.
    #[must_use]
    pub fn part(&self, bodies: &[usize]) -> Part {
        assert!(
            bodies.is_sorted_by(|a, b| a < b),
            "bodies {bodies:?} are not in order"
        );
        let is_here = |b: &BodyRef| b.moving().is_some_and(|k| bodies.binary_search(&k).is_ok());
        let constraints = self.elements.constraints.iter().enumerate();
        let groups: Vec<usize> = constraints
            .filter(|(_, c)| c.site.bodies.iter().any(is_here))
            .map(|(k, _)| k)
            .collect();
        let forces = self.elements.forces.iter().enumerate();
        assembled(
            self,
            bodies,
            &groups,
            forces.filter(|(_, f)| f.site.bodies.iter().any(is_here)),
        )
    }

    /// Returns the mechanism of some joints and drives (in ascending order) with the bodies that
    /// they connect, for the analysis of constraints. The result has no forces. Initial values of
    /// the part are the initial values of the whole mechanism. The computing time is proportional
    /// to the size of the part.
    ///
    /// # Panics
    /// Panics if the groups are not in ascending order or do not exist.
    #[must_use]
    pub fn part_of_groups(&self, groups: &[usize]) -> Part {
        assert!(
            groups.is_sorted_by(|a, b| a < b),
            "groups {groups:?} are not in order"
        );
        let joined = groups
            .iter()
            .flat_map(|&k| self.elements.constraints[k].site.moving());
        let mut bodies: Vec<usize> = joined.collect();
        bodies.sort_unstable();
        bodies.dedup();
        assembled(self, &bodies, groups, std::iter::empty())
    }
}

/// Returns the mechanism of some bodies, groups and forces of `whole`.
fn assembled<'a>(
    whole: &Mechanism,
    bodies: &[usize],
    groups: &[usize],
    forces: impl Iterator<Item = (usize, &'a PlacedForce)>,
) -> Part {
    let here = |body: &BodyRef| match *body {
        BodyRef::Ground => Some(BodyRef::Ground),
        BodyRef::Body(k) => bodies.binary_search(&k).ok().map(BodyRef::Body),
    };
    let translated = |name: &str, of: &[BodyRef]| -> Vec<BodyRef> {
        let here: Option<Vec<BodyRef>> = of.iter().map(here).collect();
        assert!(here.is_some(), "`{name}` reaches beyond bodies {bodies:?}");
        here.unwrap_or_default()
    };
    let mut b = Builder::new(whole.space(), whole.layout.start_time);
    for &k in groups {
        let (c, group) = (&whole.elements.constraints[k], &whole.layout.groups[k]);
        b.constraint(
            &group.name,
            group.kind,
            &translated(&group.name, &c.site.bodies),
            c.framed().clone(),
            &laws(whole, &c.site),
            c.tolerance,
        );
        b.limit(&group.limits);
    }
    let rows = |own: usize| &whole.layout.groups[groups[own]].rows;
    let mut late: Vec<usize> = (0..groups.len()).collect();
    late.sort_by_key(|&own| rows(own).nonholonomic.start);
    b.number_rows(&late);
    let early = (0..groups.len()).flat_map(|own| rows(own).holonomic.clone());
    let late = late.iter().flat_map(|&own| rows(own).nonholonomic.clone());
    let rows: Vec<usize> = early.chain(late).collect();
    for (label, &row) in b.layout.labels.iter_mut().zip(&rows) {
        label.clone_from(&whole.layout.labels[row]);
    }
    let mut own_forces = Vec::new();
    b.elements
        .controllers
        .clone_from(&whole.elements.controllers);
    for (k, f) in forces {
        own_forces.push(k);
        let functions = laws(whole, &f.site);
        let to = translated(&f.name, &f.site.bodies);
        let turned = f.turned().cloned();
        b.force(&f.name, &to, (f.kernels().clone(), turned), &functions);
    }
    for armature in &whole.elements.armatures {
        let of_joint = |&k: &usize| whole.layout.groups[k].name == armature.joint;
        if groups.iter().any(of_joint) {
            let to = translated(&armature.joint, &armature.site.bodies);
            let framed = armature.framed().clone();
            b.armature(&armature.joint, &to, framed, armature.inertia);
        }
    }
    let places = |n: usize| -> Vec<usize> {
        let each = bodies.iter().flat_map(|k| n * k..n * (k + 1));
        each.collect()
    };
    let mut coordinates = places(whole.space().n_q());
    let counted = whole.elements.counted_of(groups, &own_forces);
    let angles = whole.layout.angles();
    coordinates.extend(counted.map(|k| angles.start + k));
    let states = whole.elements.states_of(&own_forces).into_iter();
    coordinates.extend(states.map(|k| angles.end + k));
    let velocities = places(whole.space().n_v());
    let own = bodies.iter().map(|&k| whole.bodies[k].clone()).collect();
    let weight = velocities.iter().map(|&j| whole.weight[j]).collect();
    if own_forces.len() < whole.elements.forces.len() {
        b.elements.controllers.clear();
        b.elements.signals.clear();
    }
    let mut mechanism = b.finish(&whole.name, own, weight);
    mechanism.tolerance = whole.tolerance;
    mechanism.observed = whole.observed.stated_for(here);
    let is_free = |(_, j): &(usize, &usize)| whole.free_spins.binary_search(j).is_ok();
    let spins = velocities.iter().enumerate().filter(is_free);
    mechanism.set_free_spins(spins.map(|(own, _)| own).collect());
    mechanism.reach = bodies.iter().map(|&k| whole.reach[k]).collect();
    let places = Places {
        bodies: bodies.to_vec(),
        coordinates,
        velocities,
        rows,
        groups: groups.to_vec(),
    };
    Part { mechanism, places }
}

/// Returns the functions of time of an element.
fn laws(whole: &Mechanism, site: &Site) -> Vec<Function> {
    let given = whole.elements.given[site.functions.clone()].iter();
    let functions = given.filter_map(KernelInput::function);
    let whole = functions.filter(|f| f.form != FunctionForm::Sine);
    whole.map(|f| f.function.clone()).collect()
}

/// Returns the sets of connected bodies. The bodies of each element are connected. Each set is in
/// ascending order, and the sets are ordered by their first bodies.
fn connected<'a>(bodies: usize, sites: impl Iterator<Item = &'a Site>) -> Vec<Vec<usize>> {
    let mut sets = DisjointSets::new(bodies);
    for site in sites {
        let mut members = site.moving();
        let Some(first) = members.next() else {
            continue;
        };
        members.for_each(|member| sets.join(first, member));
    }
    sets.sets()
}

#[cfg(test)]
mod tests;
