//! Positions of the joints of a mechanism and the kind of freedom they leave, derived from their
//! rows, wrenches and places: no joint is known by name.

mod space;
#[cfg(test)]
mod tests;

use linalg::Matrix;
use model::reaction::ConstraintGroup;
use model::space::difference;
use model::{BodyRef, ConstraintId, ConstraintKind, Mechanism, Scratch, SpaceKind, System};

use super::FigureError;
use super::symbol::Symbol;

/// Larger coordinates cannot be drawn: their squares would overflow.
const LIMIT: f64 = 1e150;

/// Evaluates poses, if q is a configuration that can be drawn.
pub(crate) fn posed(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    s: &mut Scratch,
) -> Result<(), FigureError> {
    let expected = mechanism.layout().n_q;
    if q.len() != expected {
        return Err(FigureError::Coordinates {
            mechanism: mechanism.name().to_owned(),
            found: q.len(),
            expected,
        });
    }
    if let Some(k) = q.iter().position(|x| !within(*x, LIMIT)) {
        return Err(FigureError::Coordinate {
            mechanism: mechanism.name().to_owned(),
            number: k + 1,
            value: q[k],
            limit: LIMIT,
        });
    }
    mechanism.pose(t, q, s);
    Ok(())
}

/// A joint or drive at its place (global components, m).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Site {
    pub(crate) place: [f64; 3],
    pub(crate) symbol: Symbol,
    /// Point at which its only force acts on the other body; its place if there is no such point.
    pub(crate) end: [f64; 3],
    /// Whether it connects a body to the ground.
    pub(crate) grounded: bool,
    /// Circles that roll on each other at its place, if it couples two rotations.
    pub(crate) pitch: Option<[Pitch; 2]>,
}

/// A pitch circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pitch {
    /// The body at whose centre it is.
    pub(crate) body: BodyRef,
    pub(crate) radius: f64,
}

/// All joints and drives, in the order of the layout, at the poses of the scratch.
pub(crate) fn sites(mechanism: &Mechanism, s: &Scratch) -> Vec<Site> {
    mechanism
        .layout()
        .constraint_ids()
        .map(|id| site(mechanism, id, s))
        .collect()
}

/// One of them.
pub(crate) fn site(mechanism: &Mechanism, id: ConstraintId, s: &Scratch) -> Site {
    let group = &mechanism.layout().groups[id.0];
    let spec = group.spec;
    let place = finite_or(mechanism.reactions(s).place(id), [0.0; 3]);
    let map = mechanism.reactions(s).wrench_map(id);
    let rows = Rows::of(group);
    let is_plane = group.space != SpaceKind::Space3;
    // The line along which the only force acts.
    let force = rows.only_force().filter(|_| is_plane);
    let force = force.map(|row| Force::of(&map, row));
    let second = || other_end(mechanism, id, place, s);
    let end = match (rows.only_force(), force) {
        (Some(_), _) if spec.common.points_apart => second(),
        (_, None) if !is_plane => second(),
        (_, force) => force.map_or(place, |f| f.point_nearest(place)),
    };
    let slides = spec.nonholonomic() > 0;
    let symbol = match (group.kind, slides, force) {
        (_, false, _) if spec.common.points_apart && rows.only_force().is_some() => Symbol::Rod,
        _ if !is_plane => space::symbol(group, &map, difference(end, place)),
        (ConstraintKind::Drive, ..) => Symbol::Drive {
            axis: force.map(|f| f.direction),
        },
        (_, true, Some(f)) => Symbol::Edge {
            along: f.perpendicular(),
        },
        (_, false, Some(f)) if rows.torques > 0 => Symbol::Block {
            axis: f.perpendicular(),
        },
        (_, false, Some(f)) => Symbol::Slot {
            axis: f.perpendicular(),
        },
        (_, _, None) if rows.forces.is_empty() => Symbol::Rotation,
        _ if rows.torques > 0 => Symbol::Weld,
        _ => Symbol::Pin,
    };
    let mesh = match (symbol, spec.rows.len()) {
        (Symbol::Rotation, 1) if is_plane => mesh(group, map[(2, 0)], s),
        _ => None,
    };
    Site {
        place: mesh.map_or(place, |(point, _)| point),
        pitch: mesh.map(|(_, circles)| circles),
        symbol,
        end,
        grounded: !slides
            && group.kind == ConstraintKind::Joint
            && symbol != Symbol::Rotation
            && (group.bodies.len() == 1 || group.bodies.contains(&BodyRef::Ground)),
    }
}

/// Ratios closer to one are drawn without wheels: equal rotations need none.
const LEAST_SLIP: f64 = 1e-2;

/// The contact point of two wheels, if the second body rotates `ratio` times as fast as the first
/// one: r_i·ω_i = −r_j·ω_j for external contact, r_i·ω_i = r_j·ω_j for internal contact. The ratio
/// is the torque on the first body, because rows of rotations have the coefficient one for the
/// second.
fn mesh(group: &ConstraintGroup, ratio: f64, s: &Scratch) -> Option<([f64; 3], [Pitch; 2])> {
    // A ring that is part of the ground is centred on the carrier.
    let wheel = |slot: usize| {
        let around = [slot, 2].map(|slot| group.bodies.get(slot)?.moving());
        let k = around[0].or(around[1])?;
        Some((BodyRef::Body(k), s.bodies.origin(k)))
    };
    let ((first, a), (second, b)) = (wheel(0)?, wheel(1)?);
    let far = a.iter().chain(&b).fold(0.0, |far: f64, x| far.max(x.abs()));
    let apart = (b[0] - a[0]).hypot(b[1] - a[1]);
    let are_apart = apart > 1e-9 * far;
    if !are_apart || !ratio.is_finite() || (ratio - 1.0).abs() < LEAST_SLIP {
        return None;
    }
    let share = ratio / (ratio - 1.0);
    let point = [0, 1, 2].map(|k| a[k] + share * (b[k] - a[k]));
    let circle = |body, share: f64| Pitch {
        body,
        radius: share.abs() * apart,
    };
    let circles = [circle(first, share), circle(second, 1.0 - share)];
    point
        .iter()
        .all(|x| within(*x, 2.0 * LIMIT))
        .then_some((point, circles))
}

/// Rows, classified by what they transmit.
struct Rows {
    forces: Vec<usize>,
    /// Number of rows that transmit only a torque.
    torques: usize,
}

impl Rows {
    fn of(group: &ConstraintGroup) -> Self {
        let n = group.spec.rows.len();
        let forces: Vec<usize> = (0..n).filter(|&row| group.pushes(row)).collect();
        Self {
            torques: n - forces.len(),
            forces,
        }
    }

    fn only_force(&self) -> Option<usize> {
        match self.forces[..] {
            [row] => Some(row),
            _ => None,
        }
    }
}

/// A force in the plane and its lever arm about the place.
#[derive(Clone, Copy)]
struct Force {
    direction: [f64; 3],
    arm: f64,
}

impl Force {
    fn of(map: &Matrix, row: usize) -> Self {
        let (x, y, torque) = (map[(0, row)], map[(1, row)], map[(2, row)]);
        let size = x.hypot(y);
        if !(size > 0.0 && size.is_finite()) {
            return Self {
                direction: [1.0, 0.0, 0.0],
                arm: 0.0,
            };
        }
        Self {
            direction: [x / size, y / size, 0.0],
            arm: torque / size,
        }
    }

    fn perpendicular(&self) -> [f64; 3] {
        [-self.direction[1], self.direction[0], 0.0]
    }

    /// The point of the line of action nearest to the place: offset × direction = arm.
    fn point_nearest(&self, place: [f64; 3]) -> [f64; 3] {
        let [x, y, _] = self.perpendicular();
        let [from_x, from_y, z] = place;
        finite_or([from_x - self.arm * x, from_y - self.arm * y, z], place)
    }
}

/// The second point of a joint, such as the other end of a rod, if its definition has two.
fn other_end(mechanism: &Mechanism, id: ConstraintId, place: [f64; 3], s: &Scratch) -> [f64; 3] {
    let points = mechanism.points(id);
    let end = points.get(1).map(|&(body, point)| match body {
        BodyRef::Ground => point,
        BodyRef::Body(k) => s.bodies.to_global(k, point),
    });
    finite_or(end.unwrap_or(place), place)
}

fn finite_or(point: [f64; 3], otherwise: [f64; 3]) -> [f64; 3] {
    if point.iter().all(|x| within(*x, 2.0 * LIMIT)) {
        point
    } else {
        otherwise
    }
}

/// Whether a number is finite and not too large; NaN is not.
fn within(x: f64, limit: f64) -> bool {
    x.abs() <= limit
}
