//! Describes free motions as sentences. A sentence states which body rotates about which point or
//! axis, which body slides, and which bodies move with this body.

use crate::limits::{NAMED_BODIES, SAME_PLACE, TOLD_MOVEMENTS};
use model::space::{cross, difference, dot, norm};
use model::{BodyRef, ConstraintId, Mechanism, System};

use super::component::{Component, Velocities};
use super::movement::{Line, Movement, Twist};
use crate::words::{components, list, place};
use model::words::quantity;

/// Describes a motion of a component. Also returns the velocities of the motion with the sign that
/// the text implies: positive rotation, or translation along the first axis.
pub(super) fn tell(
    of: &Component<'_>,
    driven: &[usize],
    mut velocities: Velocities,
) -> (String, Velocities) {
    let moving: Vec<usize> = (0..velocities.len())
        .filter(|&b| velocities[b].iter().any(|v| *v != 0.0))
        .collect();
    let Some(leader) = leader(of, driven, &velocities, &moving) else {
        return ("nothing moves".to_owned(), velocities);
    };
    let Twist { velocity, omega } = twist(of, &velocities, leader);
    let first = omega.into_iter().chain(velocity).find(|v| *v != 0.0);
    if first.is_some_and(|v| v < 0.0) {
        let bodies = velocities.iter_mut().flatten();
        bodies.filter(|v| **v != 0.0).for_each(|v| *v = -*v);
    }
    let (together, others): (Vec<usize>, Vec<usize>) = moving
        .into_iter()
        .partition(|&b| moves_as(of, &velocities, leader, b));
    let mut text = sentence(of, &velocities, leader, &together);
    let said = with_it(of, &velocities, others);
    if !said.is_empty() {
        let it = if together.len() == 1 { "it" } else { "them" };
        text += &format!("; with {it} {}", list(&said));
    }
    (text, velocities)
}

/// Describes bodies of a mechanism that are joined only to each other.
pub(super) fn free(mechanism: &Mechanism, bodies: &[usize]) -> String {
    let names = named(mechanism, bodies);
    match bodies.len() {
        1 => format!("{names} is free"),
        _ => format!("{names} together are free"),
    }
}

/// Describes the motion of a body without joints.
pub(super) fn alone(mechanism: &Mechanism, body: usize, movement: Movement, size: f64) -> String {
    let name = named(mechanism, &[body]);
    let space = mechanism.space();
    let own = |p: [f64; 3]| p[space.forces()].to_vec();
    let line = |Line { point, along }: Line| match space.n_rotations() {
        1 => place(&own(point), size),
        _ => format!(
            "the line through {} along {}",
            place(&own(point), size),
            components(&own(along), 1.0)
        ),
    };
    match movement {
        Movement::Turn(about) => format!("{name} turns about {}", line(about)),
        Movement::Screw(about, pitch) => format!(
            "{name} turns about {} with a pitch of {} per turn",
            line(about),
            quantity(pitch, "m")
        ),
        Movement::Slide(along) => format!("{name} slides along {}", components(&own(along), 1.0)),
    }
}

/// Describes the motion of the other bodies. In space, a few sets of bodies that move together are
/// described like the first body. For more sets, and in the plane, the text only lists which bodies
/// rotate and which slide.
fn with_it(of: &Component<'_>, v: &Velocities, bodies: Vec<usize>) -> Vec<String> {
    if of.mechanism.space().n_rotations() == 1 {
        return verbs(of, v, bodies);
    }
    let mut said = Vec::new();
    let mut left = bodies.clone();
    while let Some(&first) = left.first() {
        if said.len() == TOLD_MOVEMENTS {
            return verbs(of, v, bodies);
        }
        let (alike, others): (Vec<usize>, Vec<usize>) =
            left.into_iter().partition(|&b| moves_as(of, v, first, b));
        said.push(sentence(of, v, first, &alike));
        left = others;
    }
    said
}

/// Describes bodies that move together, with the values of one of these bodies: "`nut` turns about
/// `A`".
fn sentence(of: &Component<'_>, v: &Velocities, one: usize, bodies: &[usize]) -> String {
    let names = named(of.mechanism, bodies);
    let (s, together) = match bodies.len() {
        1 => ("s", ""),
        _ => ("", " together"),
    };
    match movement(of, v, one) {
        Movement::Turn(line) => format!(
            "{names} turn{s}{together} about {}",
            about(of, bodies, line)
        ),
        Movement::Screw(line, pitch) => format!(
            "{names} turn{s}{together} about {} with a pitch of {} per turn",
            about(of, bodies, line),
            quantity(pitch, "m")
        ),
        Movement::Slide(along) => {
            format!("{names} slide{s}{together} along {}", direction(of, along))
        }
    }
}

/// Lists which bodies rotate and which bodies slide, without axis and position.
fn verbs(of: &Component<'_>, v: &Velocities, bodies: Vec<usize>) -> Vec<String> {
    let slides = |b: &usize| matches!(movement(of, v, *b), Movement::Slide(_));
    let (sliding, turning): (Vec<usize>, Vec<usize>) = bodies.into_iter().partition(slides);
    let said = [(turning, "turn"), (sliding, "slide")];
    let said = said.iter().filter(|(bodies, _)| !bodies.is_empty());
    said.map(|(bodies, verb)| {
        let s = if bodies.len() == 1 { "s" } else { "" };
        format!("{} {verb}{s}", named(of.mechanism, bodies))
    })
    .collect()
}

/// Returns the body that is named first. The function prefers a body that slides or rotates about a
/// joint, then a body on which a drive acts, then a body that is joined to the ground.
fn leader(
    of: &Component<'_>,
    driven: &[usize],
    velocities: &Velocities,
    moving: &[usize],
) -> Option<usize> {
    let groups = &of.mechanism.layout().groups;
    let is_grounded = |b: usize| {
        let mut on_it = groups
            .iter()
            .filter(|g| g.bodies.contains(&BodyRef::Body(b)));
        on_it.any(|g| g.bodies.len() == 1 || g.bodies.contains(&BodyRef::Ground))
    };
    let is_plain = |b: usize| match movement(of, velocities, b) {
        Movement::Slide(_) => true,
        Movement::Turn(line) | Movement::Screw(line, _) => !joints_on(of, &[b], line).is_empty(),
    };
    let rank = |b: usize| (!is_plain(b), !driven.contains(&b), !is_grounded(b));
    moving.iter().copied().min_by_key(|&b| rank(b))
}

/// Returns whether a body moves as if it were rigidly attached to another body.
fn moves_as(of: &Component<'_>, v: &Velocities, leader: usize, body: usize) -> bool {
    let [own, leads] = [body, leader].map(|b| twist(of, v, b));
    let carried = leads.carried(difference(of.origin(body), of.origin(leader)));
    let twists = (0..v.len()).map(|b| twist(of, v, b));
    let fastest = twists.fold(0.0_f64, |a, twist| a.max(twist.speed(of.size)));
    own.less(carried).speed(of.size) <= SAME_PLACE * fastest
}

fn twist(of: &Component<'_>, v: &Velocities, body: usize) -> Twist {
    Twist::new(of.mechanism.space(), &v[body])
}

fn movement(of: &Component<'_>, v: &Velocities, body: usize) -> Movement {
    twist(of, v, body).movement(of.origin(body), of.size)
}

/// Describes a line about which bodies rotate. In the plane, the text contains a point of the line:
/// a joint of the bodies, "its centre of mass", or coordinates. In space, the text contains such
/// points of the line, and the direction of the line.
fn about(of: &Component<'_>, bodies: &[usize], line: Line) -> String {
    let through = match (joints_on(of, bodies, line).as_slice(), bodies) {
        ([], [only]) if is_on(of, of.origin(*only), line) => "its centre of mass".to_owned(),
        ([], _) => {
            let point = line.nearest_to_origin();
            place(&point[of.mechanism.space().forces()], of.size)
        }
        (joints, _) => list(joints),
    };
    match of.mechanism.space().n_rotations() {
        1 => through,
        _ => format!(
            "the axis through {through} along {}",
            direction(of, line.along)
        ),
    }
}

/// Returns the joint of these bodies that is on a line. If there are several such joints, the
/// function returns the joint with the most constraints. In this case, it also returns another
/// joint with as many constraints at another point of the line.
fn joints_on(of: &Component<'_>, bodies: &[usize], line: Line) -> Vec<String> {
    let layout = of.mechanism.layout();
    let holds = |k: usize| {
        let rows = layout.groups[k].rows.iter();
        rows.filter(|&row| !layout.is_angular(row)).count()
    };
    let is_theirs = |b: &usize, k: usize| layout.groups[k].bodies.contains(&BodyRef::Body(*b));
    let place = |k: usize| of.place(ConstraintId(k));
    let on_it: Vec<usize> = (0..layout.groups.len())
        .filter(|&k| holds(k) > 0 && bodies.iter().any(|b| is_theirs(b, k)))
        .filter(|&k| is_on(of, place(k), line))
        .collect();
    let most = on_it.iter().map(|&k| holds(k)).max();
    let mut best = on_it.into_iter().filter(|&k| Some(holds(k)) == most);
    let first = best.next();
    let along = |k: usize| dot(place(k), line.along);
    let apart = |k: usize, other: usize| (along(k) - along(other)).abs() > SAME_PLACE * of.size;
    let other = best.find(|&k| first.is_some_and(|first| apart(k, first)));
    let name = |k: usize| format!("`{}`", layout.groups[k].name);
    first.into_iter().chain(other).map(name).collect()
}

/// Returns whether a point is on a line, at the scale of the mechanism.
fn is_on(of: &Component<'_>, point: [f64; 3], line: Line) -> bool {
    norm(&cross(difference(point, line.point), line.along)) <= SAME_PLACE * of.size
}

/// Formats a unit vector as "(0.6, −0.8)" without the quotes.
fn direction(of: &Component<'_>, unit: [f64; 3]) -> String {
    components(&unit[of.mechanism.space().forces()], 1.0)
}

/// Returns the names of bodies. A count replaces the end of a long list.
fn named(mechanism: &Mechanism, bodies: &[usize]) -> String {
    let name = |&b: &usize| format!("`{}`", mechanism.bodies()[b].name);
    // If a count would replace only one name, the name is printed.
    let told = if bodies.len() == NAMED_BODIES + 1 {
        NAMED_BODIES + 1
    } else {
        NAMED_BODIES
    };
    let mut names: Vec<String> = bodies.iter().take(told).map(name).collect();
    if bodies.len() > names.len() {
        names.push(format!("{} other bodies", bodies.len() - names.len()));
    }
    list(&names)
}
