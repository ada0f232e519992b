//! Positions of the joints of a mechanism, and the kind of relative motion that each joint allows.
//! Both are derived from rows, wrenches and reference points, not from the names of joint types.

mod space;
#[cfg(test)]
mod tests;

use linalg::Matrix;
use model::reaction::ConstraintGroup;
use model::space::{cross, difference, norm};
use model::{BodyRef, ConstraintId, ConstraintKind, Mechanism, Scratch, SpaceKind, System};

use super::FigureError;
use super::projection::unit;
use super::symbol::Symbol;

/// Larger coordinates cannot be drawn, because their squares would overflow.
const LIMIT: f64 = 1e150;

/// Evaluates the poses of the bodies. Returns an error if q is not a configuration that can be
/// drawn.
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

/// A joint or drive at its reference point (global components, m).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Site {
    pub(crate) place: [f64; 3],
    pub(crate) symbol: Symbol,
    /// Point at which the only force of the joint acts on the other body. If there is no such
    /// point, this is the reference point.
    pub(crate) end: [f64; 3],
    /// Whether the joint or drive connects a body to the ground.
    pub(crate) grounded: bool,
    /// Circles that roll on each other, or one circle that rolls on the ground, at the reference
    /// point.
    pub(crate) pitch: Vec<Pitch>,
}

/// A rolling circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pitch {
    /// The body with the circle.
    pub(crate) body: BodyRef,
    /// Centre of the circle relative to the centre of mass (m), and unit vector normal to the
    /// circle, in the axes of the coordinates of the body.
    pub(crate) centre: [f64; 3],
    pub(crate) axis: [f64; 3],
    pub(crate) radius: f64,
}

/// All joints and drives, in the order of the layout, at the poses in `s`.
pub(crate) fn sites(mechanism: &Mechanism, s: &Scratch) -> Vec<Site> {
    let ids = mechanism.layout().constraint_ids();
    let mut all: Vec<Site> = ids.map(|id| site(mechanism, id, s)).collect();
    for id in mechanism.layout().constraint_ids() {
        if mechanism.layout().groups[id.0].spec.common.bearings {
            all[id.0].pitch = borne(mechanism, id, &all, s);
        }
    }
    all
}

/// One joint or drive.
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
    let teeth = match force {
        Some(force) if spec.common.points_apart => force.teeth(place, second()),
        _ => None,
    };
    let end = match (rows.only_force(), force) {
        (Some(_), _) if spec.common.points_apart => second(),
        (_, None) if !is_plane => second(),
        (_, force) => force.map_or(place, |f| f.point_nearest(place)),
    };
    let slides = spec.nonholonomic() > 0;
    let symbol = match (group.kind, slides, force) {
        _ if spec.common.bearings || teeth.is_some() => Symbol::Rotation,
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
    let points = || mechanism.points(id);
    let mesh = match (symbol, spec.rows.len(), teeth) {
        (_, _, Some(along)) => teeth_of(&points(), place, second(), along),
        (Symbol::Rotation, 1, _) if is_plane => mesh(group, map[(2, 0)], s),
        _ => None,
    };
    let rolls = || rolling(&points(), &map, place, s);
    let (place, pitch) = match mesh {
        Some((point, circles)) => (point, circles.to_vec()),
        None if !is_plane && spec.nonholonomic() == 2 => (place, rolls().into_iter().collect()),
        None => (place, Vec::new()),
    };
    Site {
        place,
        end: if symbol == Symbol::Rotation {
            place
        } else {
            end
        },
        pitch,
        symbol,
        grounded: !slides
            && group.kind == ConstraintKind::Joint
            && symbol != Symbol::Rotation
            && (group.bodies.len() == 1 || group.bodies.contains(&BodyRef::Ground)),
    }
}

/// Smallest difference between the ratio and one at which wheels are drawn. If the difference is
/// smaller, the rotations are equal.
const LEAST_SLIP: f64 = 1e-2;

/// Returns the contact point of two wheels. The second body rotates `ratio` times as fast as the
/// first body: r_i·ω_i = −r_j·ω_j for external contact, r_i·ω_i = r_j·ω_j for internal contact. The
/// ratio is the torque on the first body, because the coefficient of the second body in a row of
/// rotations is one.
fn mesh(group: &ConstraintGroup, ratio: f64, s: &Scratch) -> Option<([f64; 3], [Pitch; 2])> {
    // If a ring is part of the ground, its centre is on the carrier.
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
        centre: [0.0; 3],
        axis: UPRIGHT,
        radius: share.abs() * apart,
    };
    let circles = [circle(first, share), circle(second, 1.0 - share)];
    point
        .iter()
        .all(|x| within(*x, 2.0 * LIMIT))
        .then_some((point, circles))
}

/// Normal of the plane.
const UPRIGHT: [f64; 3] = [0.0, 0.0, 1.0];

/// Returns the pitch point and the pitch circles of a gear mesh. The pitch point is on the line
/// between the centres of the two wheels, at a given distance from the first centre.
fn teeth_of(
    points: &[(BodyRef, [f64; 3])],
    first: [f64; 3],
    second: [f64; 3],
    along: f64,
) -> Option<([f64; 3], [Pitch; 2])> {
    let &[(wheel, s_i), (other, s_j), ..] = points else {
        return None;
    };
    let apart = difference(second, first);
    let length = norm(&apart);
    let circle = |body, centre, radius: f64| Pitch {
        body,
        centre,
        axis: UPRIGHT,
        radius: radius.abs(),
    };
    let point = [0, 1, 2].map(|k| first[k] + along / length * apart[k]);
    let circles = [
        circle(wheel, s_i, along),
        circle(other, s_j, length - along),
    ];
    point
        .iter()
        .all(|x| within(*x, 2.0 * LIMIT))
        .then_some((point, circles))
}

/// Returns the circle of a wheel that rolls on the ground. The circle is computed from the centre,
/// the contact point and the forces of the rows. The forces of the last two rows are along the
/// track and across the track. The axis of the wheel is perpendicular to the track and to the
/// radius.
fn rolling(
    points: &[(BodyRef, [f64; 3])],
    map: &Matrix,
    touches: [f64; 3],
    s: &Scratch,
) -> Option<Pitch> {
    let &[(body, centre)] = points else {
        return None;
    };
    let k = body.moving()?;
    let track = map.ncols().checked_sub(2)?;
    let track = [0, 1, 2].map(|axis| map[(axis, track)]);
    let down = difference(touches, s.bodies.to_global(k, centre));
    let axis = unit(cross(track, down))?;
    Some(Pitch {
        body,
        centre,
        axis: turned_back(body, axis, s),
        radius: norm(&down),
    })
}

/// The pitch circles of wheels that rotate in other joints. These joints define the axes of the
/// wheels.
fn borne(mechanism: &Mechanism, id: ConstraintId, all: &[Site], s: &Scratch) -> Vec<Pitch> {
    let points = mechanism.points(id);
    let touches = all[id.0].place;
    let wheel = |(body, bearing): (BodyRef, [f64; 3])| {
        let k = body.moving()?;
        let at = s.bodies.to_global(k, bearing);
        let near = |site: &Site| {
            let arm = norm(&difference(touches, at));
            norm(&difference(site.place, at)) <= 1e-6 * arm
        };
        let axis = all.iter().find_map(|site| match site.symbol {
            Symbol::Hinge { axis } if near(site) => Some(axis),
            _ => None,
        })?;
        let arm = difference(touches, at);
        let along: f64 = (0..3).map(|k| arm[k] * axis[k]).sum();
        let centre = [0, 1, 2].map(|k| at[k] + along * axis[k]);
        Some(Pitch {
            body,
            centre: s.bodies.to_local(k, centre),
            axis: turned_back(body, axis, s),
            radius: norm(&difference(touches, centre)),
        })
    };
    points.into_iter().take(2).filter_map(wheel).collect()
}

/// Converts a direction in ground axes to the axes of the coordinates of a body.
pub(crate) fn turned_back(body: BodyRef, d: [f64; 3], s: &Scratch) -> [f64; 3] {
    let along = |axis: [f64; 3]| (0..3).map(|k| axis[k] * d[k]).sum();
    body.moving().map_or(d, |k| s.bodies.axes(k).map(along))
}

/// Rows, classified by the force or torque that they transmit.
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

/// Lever arms below this fraction of the distance of two points are rounding errors.
const LEAST_ARM: f64 = 1e-9;

/// A force in the plane and its lever arm about the reference point.
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

    /// Returns the distance from the first point to the intersection of the line of action with the
    /// line through both points (m). Returns `None` if the force acts along the line through both
    /// points.
    fn teeth(&self, first: [f64; 3], second: [f64; 3]) -> Option<f64> {
        let apart = difference(second, first);
        let length = norm(&apart);
        let across = apart[0] * self.direction[1] - apart[1] * self.direction[0];
        let is_beside = self.arm.abs() > LEAST_ARM * length;
        let crosses = across.abs() > LEAST_ARM * length;
        (is_beside && crosses).then(|| self.arm * length / across)
    }

    fn perpendicular(&self) -> [f64; 3] {
        [-self.direction[1], self.direction[0], 0.0]
    }

    /// Returns the point of the line of action that is nearest to the reference point. The offset
    /// between the two points satisfies offset × direction = arm.
    fn point_nearest(&self, place: [f64; 3]) -> [f64; 3] {
        let [x, y, _] = self.perpendicular();
        let [from_x, from_y, z] = place;
        finite_or([from_x - self.arm * x, from_y - self.arm * y, z], place)
    }
}

/// Returns the second point of a joint, such as the other end of a rod. Returns `None` if the
/// definition of the joint does not have two points.
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

/// Whether a value is finite and its absolute value is below the limit; false for NaN.
fn within(x: f64, limit: f64) -> bool {
    x.abs() <= limit
}
