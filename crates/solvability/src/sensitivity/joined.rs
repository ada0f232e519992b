//! Bodies connected by joints, examined set by set, so that a machine has the same result alone and
//! among others.
//!
//! Springs do not connect sets. The force of a spring is a load, and its change with the bodies of
//! a set belongs to the set; the bodies at the other end are kept fixed.

use std::borrow::Cow;

use model::{CalledForce, Mechanism, SpaceKind, System};

use crate::choices::Solution;
use crate::parts::{Extent, Partition};

/// An entry of a derivative: row, column, value.
type Entry = (usize, usize, f64);

/// A set of bodies with the joints between them, and the forces on it.
pub(super) struct Joined<'a> {
    /// The mechanism of the set; without forces, unless it is the whole mechanism.
    pub(super) mechanism: &'a Mechanism,
    /// Joints, bodies and rows of the set in the whole mechanism.
    pub(super) extent: &'a Extent,
    /// Coordinates and velocities of the set.
    pub(super) q: Cow<'a, [f64]>,
    pub(super) v: Cow<'a, [f64]>,
    /// Applied forces, and their derivatives with respect to the coordinates and velocities of the
    /// set.
    pub(super) force: Cow<'a, [f64]>,
    pub(super) force_dq: Cow<'a, [Entry]>,
    pub(super) force_dv: Cow<'a, [Entry]>,
}

impl Joined<'_> {
    /// A part of the set with its own joints, given a solution of the whole set: the forces of the
    /// other joints on its bodies become constant loads.
    pub(super) fn of_part<'b>(
        &self,
        part: &'b Mechanism,
        extent: &'b Extent,
        t: f64,
        solution: &Solution,
    ) -> Joined<'b> {
        let own = |x: &[f64]| extent.velocities(x).into_owned();
        let entries = |all: &[Entry]| {
            let space = part.space();
            let place = |j: usize| {
                let body = extent.own_body(space.body_of(j))?;
                Some(space.n_v() * body + space.dof_of(j))
            };
            let entry = |&(i, j, value): &Entry| Some((place(i)?, place(j)?, value));
            Cow::Owned(all.iter().filter_map(entry).collect())
        };
        let q = extent.coordinates(&self.q).into_owned();
        let mut s = part.scratch();
        part.pose(t, &q, &mut s);
        part.c(&mut s);
        let lambda = extent.of_rows(&solution.multipliers);
        let mut force = own(&solution.acceleration);
        force.iter_mut().zip(part.mass()).for_each(|(f, m)| *f *= m);
        for (i, l) in lambda.iter().enumerate() {
            part.layout()
                .row(&s, i)
                .for_each(|(j, c)| force[j] += c * l);
        }
        Joined {
            mechanism: part,
            extent,
            q: q.into(),
            v: own(&self.v).into(),
            force: force.into(),
            force_dq: entries(&self.force_dq),
            force_dv: entries(&self.force_dv),
        }
    }
}

/// The sets of bodies that joints and drives connect.
struct Sets {
    partition: Partition,
    /// The set of each group; `None` for groups that move no body.
    of_group: Vec<Option<usize>>,
    /// The set of each body, and its index in that set.
    of_body: Vec<(usize, usize)>,
    count: usize,
}

impl Sets {
    fn of(mechanism: &Mechanism) -> Self {
        let groups = &mechanism.layout().groups;
        let all: Vec<usize> = (0..groups.len()).collect();
        let bodies = mechanism.joined(&all);
        let mut of_body = vec![(0, 0); mechanism.bodies().len()];
        for (set, bodies) in bodies.iter().enumerate() {
            for (place, &body) in bodies.iter().enumerate() {
                of_body[body] = (set, place);
            }
        }
        let first_body = |k: usize| groups[k].bodies.iter().find_map(|b| b.moving());
        let of_group: Vec<Option<usize>> = (all.iter())
            .map(|&k| first_body(k).map(|b| of_body[b].0))
            .collect();
        let mut members = vec![Vec::new(); bodies.len()];
        for (k, set) in of_group.iter().enumerate() {
            if let Some(set) = set {
                members[*set].push(k);
            }
        }
        let partition = match &members[..] {
            [one] if one.len() == groups.len() => Partition::One,
            // Bodies without joints have no reactions.
            _ => Partition::Several(members.into_iter().filter(|m| !m.is_empty()).collect()),
        };
        Self {
            partition,
            of_group,
            of_body,
            count: bodies.len(),
        }
    }

    /// Splits the entries of a derivative of forces by set, numbered within each set.
    fn entries(&self, space: SpaceKind, all: &model::Sparse) -> Vec<Vec<Entry>> {
        let mut own = vec![Vec::new(); self.count];
        for (row, column, value) in all.iter() {
            let [(i, a), (j, b)] = [row, column].map(|j| self.of_body[space.body_of(j)]);
            if i == j {
                let [row, column] =
                    [(row, a), (column, b)].map(|(j, place)| space.n_v() * place + space.dof_of(j));
                own[i].push((row, column, value));
            }
        }
        own
    }
}

/// Applies `f` to each set of bodies connected by joints and drives, at time t, coordinates q and
/// velocities v, on the `rayon` thread pool of the caller; to a force that calls a function in
/// place of the set if there is one, because no derivative of it is known.
pub(super) fn each_joined<T: Send>(
    mechanism: &Mechanism,
    (t, q, v): (f64, &[f64], &[f64]),
    f: impl Fn(Result<Joined<'_>, &CalledForce>, &Extent) -> T + Sync,
) -> Vec<T> {
    let sets = Sets::of(mechanism);
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.twist(v, &mut s);
    mechanism.force(&mut s);
    let by = model::Derivatives::of_forces(mechanism, &s);
    let by = by.map(|by| by.map(|all| sets.entries(mechanism.space(), &all)));
    let found = sets.partition.map(mechanism, |part, extent| {
        let first = extent.groups().first();
        let set = first.and_then(|&k| sets.of_group[k]).unwrap_or(0);
        let joined = by.as_ref().map(|[by_q, by_v]| Joined {
            mechanism: part,
            q: extent.coordinates(q),
            v: extent.velocities(v),
            force: extent.velocities(&s.force),
            force_dq: by_q[set][..].into(),
            force_dv: by_v[set][..].into(),
            extent: &extent,
        });
        Ok::<_, std::convert::Infallible>(f(joined, &extent))
    });
    match found {
        Ok(found) => found,
        Err(never) => match never {},
    }
}
