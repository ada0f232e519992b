//! Nodes on a line are connected by distances. Bars along one line have one redundant constraint
//! for each loop, and a bar that is not on this line does not change the redundancy.

use super::super::drawing::{GROUND, Side, Vector};
use super::pen::Pen;

pub(super) fn truss(pen: &mut Pen<'_>) {
    let (origin, line) = (pen.point(), pen.direction());
    let n = 3 + pen.numbers.below(3);
    let mut places = pen.places(origin, line, n);
    if pen.once_in(4) {
        // A similar drawing that is not degenerate: one node is not on the line.
        places[0] = pen.beside(places[0], line);
    }
    let mut nodes: Vec<Side> = Vec::new();
    for k in 0..n {
        let is_shared = k > 0 && pen.once_in(8);
        let side = match (k, pen.once_in(8)) {
            (_, true) if k > 0 => GROUND,
            // Two nodes are on one body.
            _ if is_shared => nodes[k - 1],
            _ => node(pen, places[k]),
        };
        nodes.push(side);
    }
    // The bars form a ring, so that there is a loop, and chords.
    let mut bars: Vec<[usize; 2]> = (0..n).map(|k| [k, (k + 1) % n]).collect();
    if pen.once_in(3) {
        bars.remove(0);
    }
    if pen.once_in(3) && n > 3 {
        bars.push([0, 2]);
    }
    for [i, j] in bars {
        if nodes[i] != nodes[j] {
            pen.bar([nodes[i], nodes[j]], places[i], places[j]);
        }
    }
    for _ in 0..1 + pen.numbers.below(3) {
        oblique(pen, &nodes, &places);
    }
}

/// Adds a point mass, or a small body.
fn node(pen: &mut Pen<'_>, place: Vector) -> Side {
    if pen.once_in(3) {
        pen.body()
    } else {
        pen.drawing.body_at(place)
    }
}

/// Adds a bar from a node to the ground, or to a body without other joints.
fn oblique(pen: &mut Pen<'_>, nodes: &[Side], places: &[Vector]) {
    let (k, end) = (pen.numbers.below(nodes.len()), pen.point());
    let other = if pen.once_in(4) { pen.body() } else { GROUND };
    if nodes[k] != other {
        pen.bar([nodes[k], other], places[k], end);
    }
}
