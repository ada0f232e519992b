//! Free motions as sentences: which body turns about which point, which body slides, and which
//! bodies move with it.

use crate::limits::{NAMED_BODIES, SAME_PLACE, VISIBLE};
use model::{BodyRef, ConstraintId, Mechanism, System};

use super::component::{Component, Velocities};
use crate::words::{list, short};

/// Movement of a body at an instant.
enum Movement {
    /// Rotation about a point (m).
    Turn([f64; 2]),
    /// Translation along a unit vector.
    Slide([f64; 2]),
}

/// Describes a motion of a component and returns its velocities with the sign that the text
/// implies: positive rotation, or translation along the first axis.
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
    let [x, y, turn] = planar(&velocities[leader]);
    let first = [turn, x, y].into_iter().find(|v| *v != 0.0);
    if first.is_some_and(|v| v < 0.0) {
        let bodies = velocities.iter_mut().flatten();
        bodies.filter(|v| **v != 0.0).for_each(|v| *v = -*v);
    }
    let (together, others): (Vec<usize>, Vec<usize>) = moving
        .into_iter()
        .partition(|&b| moves_as(of, &velocities, leader, b));
    let names = named(of.mechanism, &together);
    let is_one = together.len() == 1;
    let mut text = match (movement(of, &velocities, leader), is_one) {
        (Movement::Turn(centre), true) => {
            format!("{names} turns about {}", about(of, &together, centre))
        }
        (Movement::Turn(centre), false) => {
            format!(
                "{names} turn together about {}",
                about(of, &together, centre)
            )
        }
        (Movement::Slide(along), true) => format!("{names} slides along {}", point(along, 1.0)),
        (Movement::Slide(along), false) => {
            format!("{names} slide together along {}", point(along, 1.0))
        }
    };
    let (turning, sliding): (Vec<usize>, Vec<usize>) = others
        .into_iter()
        .partition(|&b| matches!(movement(of, &velocities, b), Movement::Turn(_)));
    let said = [(turning, "turn"), (sliding, "slide")];
    let said: Vec<String> = said
        .iter()
        .filter(|(bodies, _)| !bodies.is_empty())
        .map(|(bodies, verb)| {
            let s = if bodies.len() == 1 { "s" } else { "" };
            format!("{} {verb}{s}", named(of.mechanism, bodies))
        })
        .collect();
    if !said.is_empty() {
        let it = if is_one { "it" } else { "them" };
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

/// The body that is named first: preferably one that slides or turns about a joint, then one on
/// which a drive acts, then one that is joined to the ground.
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
        Movement::Turn(centre) => joint_at(of, &[b], centre).is_some(),
    };
    let rank = |b: usize| (!is_plain(b), !driven.contains(&b), !is_grounded(b));
    moving.iter().copied().min_by_key(|&b| rank(b))
}

/// Whether a body moves as if it were rigidly attached to another.
fn moves_as(of: &Component<'_>, v: &Velocities, leader: usize, body: usize) -> bool {
    let [p, o] = [body, leader].map(|b| of.origin(b));
    let [vx, vy, turn] = planar(&v[leader]);
    let carried = [vx - turn * (p[1] - o[1]), vy + turn * (p[0] - o[0])];
    let fastest = v.iter().fold(0.0_f64, |a, v| {
        let [x, y, turn] = planar(v);
        a.max(x.hypot(y)).max(turn.abs() * of.size)
    });
    let [x, y, own_turn] = planar(&v[body]);
    let apart = (x - carried[0]).hypot(y - carried[1]);
    apart.max((own_turn - turn).abs() * of.size) <= SAME_PLACE * fastest
}

/// Velocities of a planar body, of which alone these sentences tell: vx, vy and ω.
fn planar(v: &[f64]) -> [f64; 3] {
    [v[0], v[1], v[2]]
}

fn movement(of: &Component<'_>, v: &Velocities, body: usize) -> Movement {
    let ([x, y, turn], centre) = (planar(&v[body]), of.origin(body));
    let speed = x.hypot(y);
    if turn.abs() * of.size <= VISIBLE * speed {
        return Movement::Slide([x / speed, y / speed]);
    }
    Movement::Turn([centre[0] - y / turn, centre[1] + x / turn])
}

/// The joint of these bodies located at a point, or "its centre of mass", or the coordinates of the
/// point.
fn about(of: &Component<'_>, bodies: &[usize], centre: [f64; 2]) -> String {
    if let Some(joint) = joint_at(of, bodies, centre) {
        return format!("`{joint}`");
    }
    match bodies {
        [only] if is_at(of, of.origin(*only), centre) => "its centre of mass".to_owned(),
        _ => point(centre, of.size),
    }
}

/// The joint of these bodies located at a point; if there are several, the one that constrains
/// most.
fn joint_at<'m>(of: &Component<'m>, bodies: &[usize], centre: [f64; 2]) -> Option<&'m str> {
    let mechanism = of.mechanism;
    let groups = mechanism.layout().groups.iter().enumerate();
    let mut named: Option<(usize, &str)> = None;
    for (k, group) in groups {
        let is_theirs = |b: &usize| group.bodies.contains(&BodyRef::Body(*b));
        if !bodies.iter().any(is_theirs) || !is_at(of, of.place(ConstraintId(k)), centre) {
            continue;
        }
        let holds = group
            .rows
            .clone()
            .filter(|&row| !mechanism.layout().is_angular(row));
        let holds = holds.count();
        if holds > named.map_or(0, |(most, _)| most) {
            named = Some((holds, &group.name));
        }
    }
    named.map(|(_, name)| name)
}

/// Whether two points coincide at the scale of the mechanism.
fn is_at(of: &Component<'_>, [x, y, _]: [f64; 3], other: [f64; 2]) -> bool {
    (x - other[0]).hypot(y - other[1]) <= SAME_PLACE * of.size
}

/// "(0.25, −1)" without the quotes, in m.
fn point(p: [f64; 2], size: f64) -> String {
    let [x, y] = p.map(|x| short(if x.abs() > VISIBLE * size { x } else { 0.0 }));
    format!("({x}, {y})")
}

/// Names of bodies, with a count instead of a long list.
fn named(mechanism: &Mechanism, bodies: &[usize]) -> String {
    let name = |&b: &usize| format!("`{}`", mechanism.bodies()[b].name);
    // If only one name would be replaced by a count, it is named.
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
