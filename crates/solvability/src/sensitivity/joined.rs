//! Analyses bodies connected by joints set by set. Therefore a machine has the same result alone
//! and among other machines.
//!
//! Springs do not connect sets, because the force of a spring is a load.

use std::borrow::Cow;

use model::{Mechanism, System};

use crate::choices::Solution;
use crate::parts::{Extent, Partition};

/// A set of bodies, the joints between the bodies, and the forces on the set.
pub(super) struct JoinedBodies<'a> {
    /// The mechanism of the set. The mechanism of a set has no forces, unless the set is the whole
    /// mechanism.
    pub(super) mechanism: &'a Mechanism,
    /// Joints, bodies and rows of the set in the whole mechanism.
    pub(super) extent: &'a Extent,
    /// Coordinates and velocities of the set.
    pub(super) q: Cow<'a, [f64]>,
    pub(super) v: Cow<'a, [f64]>,
    /// Applied forces.
    pub(super) force: Cow<'a, [f64]>,
}

impl JoinedBodies<'_> {
    /// Returns a part of the set with its own joints, given a solution of the whole set. The forces
    /// that the other joints exert on bodies of the part become constant loads.
    pub(super) fn of_part<'b>(
        &self,
        part: &'b Mechanism,
        extent: &'b Extent,
        t: f64,
        solution: &Solution,
    ) -> JoinedBodies<'b> {
        let own = |x: &[f64]| extent.velocities(x).into_owned();
        let q = extent.coordinates(&self.q).into_owned();
        let mut s = part.scratch();
        part.pose(t, &q, &mut s);
        part.c(&mut s);
        let lambda = extent.of_rows(solution.multipliers.as_chosen());
        let mut force = part.inertia(&s).product(&own(&solution.acceleration));
        for (i, l) in lambda.iter().enumerate() {
            part.layout()
                .row(&s, i)
                .for_each(|(j, c)| force[j] += c * l);
        }
        JoinedBodies {
            mechanism: part,
            extent,
            q: q.into(),
            v: own(&self.v).into(),
            force: force.into(),
        }
    }
}

/// Returns the sets of joints and drives on the bodies that they connect. Joints that move no body
/// belong to no set.
fn sets(mechanism: &Mechanism) -> Partition {
    let groups = &mechanism.layout().groups;
    let all: Vec<usize> = (0..groups.len()).collect();
    let bodies = mechanism.joined(&all);
    let mut of_body = vec![0; mechanism.bodies().len()];
    for (set, bodies) in bodies.iter().enumerate() {
        bodies.iter().for_each(|&body| of_body[body] = set);
    }
    let mut members = vec![Vec::new(); bodies.len()];
    for (k, group) in groups.iter().enumerate() {
        if let Some(body) = group.bodies.iter().find_map(|b| b.moving()) {
            members[of_body[body]].push(k);
        }
    }
    match &members[..] {
        [one] if one.len() == groups.len() => Partition::One,
        // Bodies without joints have no reactions.
        _ => Partition::Several(members.into_iter().filter(|m| !m.is_empty()).collect()),
    }
}

/// Applies `f` to each set of bodies connected by joints and drives, at time t, coordinates q and
/// velocities v, on the `rayon` thread pool of the caller.
pub(super) fn each_joined<T: Send>(
    mechanism: &Mechanism,
    (t, q, v): (f64, &[f64], &[f64]),
    f: impl Fn(&JoinedBodies<'_>, &Extent) -> T + Sync,
) -> Vec<T> {
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.twist(v, &mut s);
    mechanism.force(&mut s);
    let found = sets(mechanism).map(mechanism, |part, extent| {
        let joined = JoinedBodies {
            mechanism: part,
            q: extent.coordinates(q),
            v: extent.velocities(v),
            force: extent.velocities(&s.force),
            extent: &extent,
        };
        Ok::<_, std::convert::Infallible>(f(&joined, &extent))
    });
    match found {
        Ok(found) => found,
        Err(never) => match never {},
    }
}
