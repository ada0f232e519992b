//! Nodes on a line joined by distances: bars along one line have one load too many for each loop,
//! and a bar beside them changes nothing of that.

use super::super::drawing::{GROUND, Side, Vector};
use super::Pen;

impl Pen<'_> {
    pub(super) fn truss(&mut self) {
        let (origin, line) = (self.point(), self.direction());
        let n = 3 + self.numbers.below(3);
        let mut places = self.places(origin, line, n);
        if self.once_in(4) {
            // A near relative: one node beside the line.
            places[0] = self.beside(places[0], line);
        }
        let mut nodes: Vec<Side> = Vec::new();
        for k in 0..n {
            let is_shared = k > 0 && self.once_in(8);
            let side = match (k, self.once_in(8)) {
                (_, true) if k > 0 => GROUND,
                // Two nodes on one body.
                _ if is_shared => nodes[k - 1],
                _ => self.node(places[k]),
            };
            nodes.push(side);
        }
        // A ring, so that there is a loop, and chords.
        let mut bars: Vec<[usize; 2]> = (0..n).map(|k| [k, (k + 1) % n]).collect();
        if self.once_in(3) {
            bars.remove(0);
        }
        if self.once_in(3) && n > 3 {
            bars.push([0, 2]);
        }
        for [i, j] in bars {
            if nodes[i] != nodes[j] {
                self.bar([nodes[i], nodes[j]], places[i], places[j]);
            }
        }
        for _ in 0..1 + self.numbers.below(3) {
            self.oblique(&nodes, &places);
        }
    }

    /// A point mass, or a small body.
    fn node(&mut self, place: Vector) -> Side {
        match self.once_in(3) {
            true => self.body(),
            false => self.drawing.body_at(place),
        }
    }

    /// A bar from a node to the ground, or to a body that nothing else holds.
    fn oblique(&mut self, nodes: &[Side], places: &[Vector]) {
        let (k, end) = (self.numbers.below(nodes.len()), self.point());
        let other = match self.once_in(4) {
            true => self.body(),
            false => GROUND,
        };
        if nodes[k] != other {
            self.bar([nodes[k], other], places[k], end);
        }
    }
}
