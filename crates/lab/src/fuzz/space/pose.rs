//! Variants of a drawing, which describe the same mechanism in different ways. The drawing is moved
//! as a whole, bodies have other frames and mass centres, bodies and joints are in another order,
//! and the first and the second body of some joints are exchanged. The uniqueness of a wrench is
//! the same for all variants; only the components of the wrench change.

use suite::numbers::Numbers;

pub use crate::fuzz::exact::pose::Writing;

use super::drawing::{Body, Directions, Drawing, Kind, Side};
use super::ratio::Ratio;
use super::rows;
use super::vector::{Motion, Rotation, Vector};

/// Creates a random variant of a drawing.
#[must_use]
pub fn posed(drawing: &Drawing, writing: Writing, numbers: &mut Numbers) -> Drawing {
    let mut posed = drawing.clone();
    let is_as_drawn = writing == Writing::AsDrawn;
    if !is_as_drawn {
        posed.moved(&motion(drawing, writing, numbers));
        swap(&mut posed, numbers);
        reorder(&mut posed, numbers);
    }
    for k in 0..posed.bodies.len() {
        dress(&mut posed, k, is_as_drawn, numbers);
    }
    style(&mut posed, is_as_drawn, numbers);
    posed
}

/// Returns the largest absolute coordinate of a point (m).
#[must_use]
pub fn extent(drawing: &Drawing) -> f64 {
    let places = drawing.joints.iter().filter_map(|j| j.kind.place());
    let numbers = places.flat_map(|p| p.0.iter().map(|x| x.abs().rounded()));
    numbers.fold(0.0, f64::max)
}

fn motion(drawing: &Drawing, writing: Writing, numbers: &mut Numbers) -> Motion {
    let turn = match writing {
        Writing::AsDrawn | Writing::Reordered => quarter(numbers),
        Writing::Moved | Writing::Far => any_turn(numbers),
    };
    let size = extent(drawing).ceil().clamp(1.0, 1e6) as i32;
    let most = match writing {
        Writing::AsDrawn => 0,
        Writing::Reordered => 1,
        Writing::Moved => size,
        Writing::Far => 10_i32.pow(3 + numbers.below(4) as u32),
    };
    let shift = [0; 3].map(|_| Ratio::new(numbers.between(-3 * most, 3 * most), 3));
    Motion::rigid(turn, Vector(shift))
}

/// Returns a rotation that exchanges the coordinate axes.
#[must_use]
pub fn quarter(numbers: &mut Numbers) -> Rotation {
    const TURNS: [[i64; 4]; 8] = [
        [1, 0, 0, 0],
        [1, 1, 0, 0],
        [1, 0, 1, 0],
        [1, 0, 0, -1],
        [0, 1, 0, 0],
        [0, 1, 1, 0],
        [1, 1, 1, 1],
        [1, -1, 1, -1],
    ];
    let one = |numbers: &mut Numbers| Rotation::whole(TURNS[numbers.below(TURNS.len())]);
    let first = one(numbers);
    first.after(&one(numbers))
}

/// Returns any rotation by a quaternion of small integers.
#[must_use]
pub fn any_turn(numbers: &mut Numbers) -> Rotation {
    loop {
        let q = [0; 4].map(|_| i64::from(numbers.between(-4, 4)));
        if q != [0; 4] {
            return Rotation::whole(q);
        }
    }
}

/// Exchanges the bodies of half of the joints that can be written in both orders.
fn swap(drawing: &mut Drawing, numbers: &mut Numbers) {
    for joint in &mut drawing.joints {
        if let Some(kind) = joint.kind.swapped().filter(|_| numbers.once_in(2)) {
            joint.kind = kind;
            joint.bodies.reverse();
        }
    }
}

/// Changes the order of bodies, joints and drives.
fn reorder(drawing: &mut Drawing, numbers: &mut Numbers) {
    let order = numbers.order(drawing.bodies.len());
    let place = inverse(&order);
    let bodies = order.iter().map(|&k| drawing.bodies[k].clone());
    drawing.bodies = bodies.collect();
    let order = numbers.order(drawing.joints.len());
    let joints = order.iter().map(|&k| drawing.joints[k].clone());
    drawing.joints = joints.collect();
    for joint in &mut drawing.joints {
        joint.bodies = joint.bodies.map(|side: Side| side.map(|k| place[k]));
    }
    let place = inverse(&order);
    let order = numbers.order(drawing.drives.len());
    let drives = order.iter().map(|&k| drawing.drives[k].clone());
    drawing.drives = drives.collect();
    for drive in &mut drawing.drives {
        drive.joint = place[drive.joint];
    }
}

fn inverse(order: &[usize]) -> Vec<usize> {
    let mut place = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        place[old] = new;
    }
    place
}

/// Gives a body a frame, a mass centre that is not at the origin of the frame, and a tensor of
/// inertia.
fn dress(drawing: &mut Drawing, k: usize, is_as_drawn: bool, numbers: &mut Numbers) {
    let own = |side: &Side| *side == Some(k);
    let joints = drawing.joints.iter();
    let joints = joints.filter(|j| j.bodies.iter().any(own));
    let places: Vec<Vector> = joints.filter_map(|j| j.kind.place().cloned()).collect();
    let position = match numbers.below(3) {
        0 if is_as_drawn => Vector::zero(),
        1 | 2 if !places.is_empty() => places[numbers.below(places.len())].clone(),
        _ => near(places.first(), numbers),
    };
    let orientation = match numbers.below(4) {
        _ if is_as_drawn => Rotation::none(),
        0 => Rotation::none(),
        1 => quarter(numbers),
        _ => any_turn(numbers),
    };
    let centre = match numbers.below(3) {
        0 => Vector::zero(),
        _ => near(None, numbers),
    };
    let body: &mut Body = &mut drawing.bodies[k];
    (body.position, body.orientation, body.centre) = (position, orientation, centre);
    body.mass = Ratio::new(numbers.between(1, 30), 10);
    body.inertia = tensor(numbers);
}

/// Returns a point at a distance of some tenths of a metre from a given point.
fn near(point: Option<&Vector>, numbers: &mut Numbers) -> Vector {
    let offset = Vector([0; 3].map(|_| Ratio::new(numbers.between(-20, 20), 10)));
    point.map_or(offset.clone(), |p| p + &offset)
}

/// Returns three principal moments that satisfy the triangle inequality, along the axes of the
/// frame or rotated.
fn tensor(numbers: &mut Numbers) -> [[Ratio; 3]; 3] {
    // Returns the moments of a body with these mean squares of its coordinates.
    let [a, b, c] = [0; 3].map(|_| i64::from(numbers.between(1, 9)));
    let moments = [b + c, c + a, a + b].map(|x| Ratio::new(x, 20));
    let turn = if numbers.once_in(2) {
        Rotation::none()
    } else {
        any_turn(numbers)
    };
    let axes = turn.axes();
    let entry = |i: usize, j: usize| {
        let terms = axes.iter().zip(&moments);
        let terms = terms.map(|(axis, moment)| &(&axis.0[i] * &axis.0[j]) * moment);
        terms.fold(Ratio::zero(), |sum, x| &sum + &x)
    };
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}

/// Chooses the frames of points and directions. If rounding could change the basis of rows, the
/// basis is also chosen.
fn style(drawing: &mut Drawing, is_as_drawn: bool, numbers: &mut Numbers) {
    for k in 0..drawing.joints.len() {
        let joint = &drawing.joints[k];
        let (mut style, mut cross) = (joint.style.clone(), joint.cross.clone());
        if let Some(w) = rows::basis_axis(&joint.kind) {
            let is_needed = rows::basis_is_doubtful(drawing, joint, w);
            if cross.is_none() && (is_needed || numbers.once_in(4)) {
                cross = Some(across(w, numbers));
            }
        }
        style.points_in_bodies = numbers.once_in(2);
        style.directions = match numbers.below(4) {
            0 | 1 => Directions::First,
            2 => Directions::Ground,
            _ => Directions::Both,
        };
        style.factor = match numbers.below(3) {
            0 if !is_as_drawn => Some(Ratio::new(numbers.between(1, 30), 7)),
            1 => Some(Ratio::one()),
            _ => None,
        };
        let has_cross = !matches!(joint.kind, Kind::Universal { .. });
        (drawing.joints[k].style, drawing.joints[k].cross) = (style, cross.filter(|_| has_cross));
    }
}

/// Returns a direction that is far from parallel to w; it is not always perpendicular to w.
fn across(w: &Vector, numbers: &mut Numbers) -> Vector {
    loop {
        let d = Vector([0; 3].map(|_| Ratio::whole(numbers.between(-2, 2).into())));
        let cosine = d.dot(w).rounded();
        if 2.0 * cosine * cosine < d.square().rounded() * w.square().rounded() {
            return d;
        }
    }
}
