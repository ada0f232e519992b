//! Planar vectors as sums of parts, each in its own frame: `r_i + R_i·s_i` stores `s_i` in the
//! frame of body i. Products of parts in the same frame need no rotation (`(R·a)·(R·b) = a·b`), and
//! a part fixed in its body has the derivative `ω·Ω·s` in the same frame.

use std::collections::BTreeMap;

use symbolic::{Derivation, Expr, Graph};

/// Frame of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Frame {
    /// The ground.
    Ground,
    /// The body in this slot.
    Body(usize),
}

/// Cosine, sine and angular velocity of the body in each slot.
pub(crate) struct Turn {
    pub(crate) cos: Expr,
    pub(crate) sin: Expr,
    pub(crate) omega: Expr,
}

/// A vector.
#[derive(Clone, Debug, Default)]
pub(crate) struct Vector {
    parts: BTreeMap<Frame, [Expr; 2]>,
}

impl Vector {
    pub(crate) fn new(frame: Frame, components: [Expr; 2]) -> Self {
        Self {
            parts: BTreeMap::from([(frame, components)]),
        }
    }

    /// Components of all parts, each in its own frame.
    pub(crate) fn components(&self) -> impl Iterator<Item = Expr> + '_ {
        self.parts.values().flatten().copied()
    }

    /// `a·self + b·other`
    pub(crate) fn combine(&self, g: &mut Graph, a: f64, other: &Self, b: f64) -> Self {
        let mut parts = BTreeMap::new();
        let zero = g.number(0.0);
        for frame in self.parts.keys().chain(other.parts.keys()) {
            let p = self.parts.get(frame).copied().unwrap_or([zero; 2]);
            let q = other.parts.get(frame).copied().unwrap_or([zero; 2]);
            parts.insert(*frame, [0, 1].map(|k| g.sum(&[(a, p[k]), (b, q[k])])));
        }
        Self { parts }
    }

    /// `factor·self`
    pub(crate) fn scale(&self, g: &mut Graph, factor: Expr) -> Self {
        self.map(|c| c.map(|e| g.mul(factor, e)))
    }

    /// The vector turned by a right angle, counterclockwise.
    pub(crate) fn perp(&self, g: &mut Graph) -> Self {
        self.map(|[x, y]| [g.neg(y), x])
    }

    /// Time derivative; `time` differentiates components.
    pub(crate) fn rate(&self, g: &mut Graph, turns: &[Turn], time: &Derivation) -> Self {
        let parts = self
            .parts
            .iter()
            .map(|(&frame, &[x, y])| {
                let mut d = [time.apply(g, x), time.apply(g, y)];
                if let Frame::Body(slot) = frame {
                    let omega = turns[slot].omega;
                    let (turned_x, turned_y) = (g.mul(omega, y), g.mul(omega, x));
                    d = [g.sub(d[0], turned_x), g.add(d[1], turned_y)];
                }
                (frame, d)
            })
            .collect();
        Self { parts }
    }

    /// `self · other`
    pub(crate) fn dot(&self, g: &mut Graph, other: &Self, turns: &[Turn]) -> Expr {
        if self.parts.len() > 1 && other.parts.len() > 1 {
            let (a, b) = (self.to_ground(g, turns), other.to_ground(g, turns));
            return dot(g, a, b);
        }
        let (one, many) = if self.parts.len() == 1 {
            (self, other)
        } else {
            (other, self)
        };
        let Some((frame, &a)) = one.parts.first_key_value() else {
            return g.number(0.0);
        };
        let same = match many.parts.get(frame) {
            Some(&b) => dot(g, a, b),
            None => g.number(0.0),
        };
        let others = Self {
            parts: many
                .parts
                .iter()
                .filter(|(f, _)| *f != frame)
                .map(|(f, c)| (*f, *c))
                .collect(),
        };
        let (turned, rest) = (rotate(g, *frame, a, turns), others.to_ground(g, turns));
        let across = dot(g, turned, rest);
        g.add(across, same)
    }

    /// Global components.
    pub(crate) fn to_ground(&self, g: &mut Graph, turns: &[Turn]) -> [Expr; 2] {
        let rotated: Vec<_> = self
            .parts
            .iter()
            .map(|(frame, c)| rotate(g, *frame, *c, turns))
            .collect();
        [0, 1].map(|k| {
            let terms: Vec<_> = rotated.iter().map(|c| (1.0, c[k])).collect();
            g.sum(&terms)
        })
    }

    /// Components in the frame of the body in `slot`.
    pub(crate) fn in_body(&self, g: &mut Graph, slot: usize, turns: &[Turn]) -> [Expr; 2] {
        let zero = g.number(0.0);
        let own = self
            .parts
            .get(&Frame::Body(slot))
            .copied()
            .unwrap_or([zero; 2]);
        let others = Self {
            parts: self
                .parts
                .iter()
                .filter(|(f, _)| **f != Frame::Body(slot))
                .map(|(f, c)| (*f, *c))
                .collect(),
        };
        let [x, y] = others.to_ground(g, turns);
        let Turn { cos, sin, .. } = turns[slot];
        let (cx, sy, cy, sx) = (g.mul(cos, x), g.mul(sin, y), g.mul(cos, y), g.mul(sin, x));
        let turned = [g.add(cx, sy), g.sub(cy, sx)];
        [0, 1].map(|k| g.add(turned[k], own[k]))
    }

    /// Every part with its global components, for naming.
    pub(crate) fn rotated_parts<'a>(
        &'a self,
        g: &'a mut Graph,
        turns: &'a [Turn],
    ) -> impl Iterator<Item = (Frame, [Expr; 2])> + 'a {
        self.parts
            .iter()
            .map(move |(frame, c)| (*frame, rotate(g, *frame, *c, turns)))
    }

    fn map(&self, mut f: impl FnMut([Expr; 2]) -> [Expr; 2]) -> Self {
        Self {
            parts: self.parts.iter().map(|(k, c)| (*k, f(*c))).collect(),
        }
    }
}

/// `R·c`
fn rotate(g: &mut Graph, frame: Frame, [x, y]: [Expr; 2], turns: &[Turn]) -> [Expr; 2] {
    let Frame::Body(slot) = frame else {
        return [x, y];
    };
    let Turn { cos, sin, .. } = turns[slot];
    let (cx, sy, sx, cy) = (g.mul(cos, x), g.mul(sin, y), g.mul(sin, x), g.mul(cos, y));
    [g.sub(cx, sy), g.add(sx, cy)]
}

fn dot(g: &mut Graph, a: [Expr; 2], b: [Expr; 2]) -> Expr {
    let (x, y) = (g.mul(a[0], b[0]), g.mul(a[1], b[1]));
    g.add(x, y)
}

#[cfg(test)]
mod tests;
