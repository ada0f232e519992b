//! Vectors as sums of parts. Each part has its own frame: `r_i + R_i·s_i` stores `s_i` in the frame
//! of body i. Products of parts in the same frame need no rotation (`(R·a)·(R·b) = a·b`). The
//! derivative of a part that is fixed in its body is `ω × s` in the same frame.

use std::collections::BTreeMap;

use symbolic::{Expr, Graph};

use crate::defined::{Along, Defined};

/// Frame of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Frame {
    /// The frame of the ground.
    Ground,
    /// The frame of the body in this slot.
    Body(usize),
}

/// Components in one frame: two components in the plane, three in space.
pub(crate) type Components = Vec<Expr>;

/// Rotation and angular velocity of the body in each slot.
#[derive(Clone)]
pub(crate) enum Turn {
    /// The cosine and the sine of the angle, and the angular velocity.
    Plane { cos: Expr, sin: Expr, omega: Expr },
    /// The slot, and the angular velocity in the frame of the body.
    Space3 {
        slot: usize,
        omega: [Expr; 3],
        defined: Defined,
    },
}

/// A vector as a sum of parts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Vector {
    parts: BTreeMap<Frame, Components>,
}

impl Vector {
    pub(crate) fn new(frame: Frame, components: Components) -> Self {
        Self {
            parts: BTreeMap::from([(frame, components)]),
        }
    }

    pub(crate) fn of_parts(parts: BTreeMap<Frame, Components>) -> Self {
        Self { parts }
    }

    /// Returns the parts with their frames.
    pub(crate) fn parts(&self) -> impl Iterator<Item = (Frame, &Components)> + '_ {
        self.parts.iter().map(|(&frame, c)| (frame, c))
    }

    /// Returns the components of all parts, each in its own frame.
    pub(crate) fn components(&self) -> impl Iterator<Item = Expr> + '_ {
        self.parts.values().flatten().copied()
    }

    /// Returns `a·self + b·other`.
    pub(crate) fn combine(&self, g: &mut Graph, a: f64, other: &Self, b: f64) -> Self {
        let mut parts = BTreeMap::new();
        let zero = g.number(0.0);
        for frame in self.parts.keys().chain(other.parts.keys()) {
            let (p, q) = (self.parts.get(frame), other.parts.get(frame));
            let n = p.or(q).map_or(0, Vec::len);
            let of = |part: Option<&Components>, k: usize| part.map_or(zero, |c| c[k]);
            let sums = (0..n).map(|k| g.sum(&[(a, of(p, k)), (b, of(q, k))]));
            parts.insert(*frame, sums.collect());
        }
        Self { parts }
    }

    /// Returns `factor·self`.
    pub(crate) fn scale(&self, g: &mut Graph, factor: Expr) -> Self {
        self.map(|c| c.iter().map(|&e| g.mul(factor, e)).collect())
    }

    /// Returns the planar vector rotated by a right angle, counterclockwise.
    pub(crate) fn perp(&self, g: &mut Graph) -> Self {
        self.map(|c| vec![g.neg(c[1]), c[0]])
    }

    /// Returns `self × other` in space. Parts in the same frame need no rotation.
    pub(crate) fn cross(&self, g: &mut Graph, other: &Self, turns: &[Turn]) -> Self {
        let (mine, theirs): (Vec<_>, Vec<_>) =
            (self.parts.iter().collect(), other.parts.iter().collect());
        if let ([(frame, a)], [(other, b)]) = (mine.as_slice(), theirs.as_slice())
            && frame == other
        {
            return Self::new(**frame, cross(g, a, b));
        }
        let (a, b) = (self.to_ground(g, turns), other.to_ground(g, turns));
        Self::new(Frame::Ground, cross(g, &a, &b))
    }

    /// Returns the time derivative. The derivation `time` differentiates the components.
    pub(crate) fn rate(&self, g: &mut Graph, turns: &[Turn], time: &Along) -> Self {
        let parts = self
            .parts
            .iter()
            .map(|(&frame, c)| {
                let d: Components = c.iter().map(|&e| time.apply(g, e)).collect();
                let d = match frame {
                    Frame::Ground => d,
                    Frame::Body(slot) => turns[slot].carried(g, c, d),
                };
                (frame, d)
            })
            .collect();
        Self { parts }
    }

    /// Returns `self · other`.
    pub(crate) fn dot(&self, g: &mut Graph, other: &Self, turns: &[Turn]) -> Expr {
        if let Some(Turn::Space3 { defined, .. }) = turns.first() {
            return defined.dot(g, self, other);
        }
        if self.parts.len() > 1 && other.parts.len() > 1 {
            let (a, b) = (self.to_ground(g, turns), other.to_ground(g, turns));
            return dot(g, &a, &b);
        }
        let (one, many) = if self.parts.len() == 1 {
            (self, other)
        } else {
            (other, self)
        };
        let Some((frame, a)) = one.parts.first_key_value() else {
            return g.number(0.0);
        };
        let same = match many.parts.get(frame) {
            Some(b) => dot(g, a, b),
            None => g.number(0.0),
        };
        let others = many.without(*frame);
        if others.parts.is_empty() {
            return same;
        }
        let (turned, rest) = (rotate(g, *frame, a, turns), others.to_ground(g, turns));
        let across = dot(g, &turned, &rest);
        g.add(across, same)
    }

    /// Returns the sum of the parts in other frames.
    fn without(&self, frame: Frame) -> Self {
        let others = self.parts.iter().filter(|(f, _)| **f != frame);
        Self {
            parts: others.map(|(f, c)| (*f, c.clone())).collect(),
        }
    }

    /// Returns the global components.
    pub(crate) fn to_ground(&self, g: &mut Graph, turns: &[Turn]) -> Components {
        let rotated: Vec<_> = self
            .parts
            .iter()
            .map(|(frame, c)| rotate(g, *frame, c, turns))
            .collect();
        let n = match (rotated.first(), turns.first()) {
            (Some(part), _) => part.len(),
            (None, Some(turn)) => turn.dim(),
            (None, None) => 0,
        };
        (0..n)
            .map(|k| {
                let terms: Vec<_> = rotated.iter().map(|c| (1.0, c[k])).collect();
                g.sum(&terms)
            })
            .collect()
    }

    /// Returns the components in the frame of the body in `slot`.
    pub(crate) fn in_body(&self, g: &mut Graph, slot: usize, turns: &[Turn]) -> Components {
        let zero = g.number(0.0);
        let frame = Frame::Body(slot);
        let others = self.without(frame).to_ground(g, turns);
        let turned = turns[slot].to_body(g, &others);
        let own = self.parts.get(&frame);
        let own = |k: usize| own.map_or(zero, |c| c[k]);
        let sums = turned.into_iter().enumerate();
        sums.map(|(k, e)| g.add(e, own(k))).collect()
    }

    /// Returns every part with its global components, so that the components can be named.
    pub(crate) fn rotated_parts<'a>(
        &'a self,
        g: &'a mut Graph,
        turns: &'a [Turn],
    ) -> impl Iterator<Item = (Frame, Components)> + 'a {
        self.parts
            .iter()
            .map(move |(frame, c)| (*frame, rotate(g, *frame, c, turns)))
    }

    fn map(&self, mut f: impl FnMut(&Components) -> Components) -> Self {
        Self {
            parts: self.parts.iter().map(|(k, c)| (*k, f(c))).collect(),
        }
    }
}

impl Turn {
    fn dim(&self) -> usize {
        match self {
            Self::Plane { .. } => 2,
            Self::Space3 { .. } => 3,
        }
    }

    /// Returns `R·c`.
    pub(crate) fn to_ground(&self, g: &mut Graph, c: &[Expr]) -> Components {
        match self {
            &Self::Plane { cos, sin, .. } => {
                let (x, y) = (c[0], c[1]);
                let (cx, sy, sx, cy) = (g.mul(cos, x), g.mul(sin, y), g.mul(sin, x), g.mul(cos, y));
                vec![g.sub(cx, sy), g.add(sx, cy)]
            }
            Self::Space3 { slot, defined, .. } => defined.rotated(g, *slot, true, c),
        }
    }

    /// Returns `Rᵀ·c`.
    fn to_body(&self, g: &mut Graph, c: &[Expr]) -> Components {
        match self {
            &Self::Plane { cos, sin, .. } => {
                let (x, y) = (c[0], c[1]);
                let (cx, sy, cy, sx) = (g.mul(cos, x), g.mul(sin, y), g.mul(cos, y), g.mul(sin, x));
                vec![g.add(cx, sy), g.sub(cy, sx)]
            }
            Self::Space3 { slot, defined, .. } => defined.rotated(g, *slot, false, c),
        }
    }

    /// Returns `d + ω × c`, the derivative of a vector. The components of the vector in the body
    /// are c, and the rates of these components are d.
    fn carried(&self, g: &mut Graph, c: &[Expr], d: Components) -> Components {
        match self {
            &Self::Plane { omega, .. } => {
                let (turned_x, turned_y) = (g.mul(omega, c[1]), g.mul(omega, c[0]));
                vec![g.sub(d[0], turned_x), g.add(d[1], turned_y)]
            }
            Self::Space3 { omega, .. } => {
                let turned = cross(g, omega, c);
                let terms = d.into_iter().zip(turned);
                terms.map(|(d, turned)| g.add(d, turned)).collect()
            }
        }
    }
}

/// Returns `R·c`.
fn rotate(g: &mut Graph, frame: Frame, c: &Components, turns: &[Turn]) -> Components {
    match frame {
        Frame::Ground => c.clone(),
        Frame::Body(slot) => turns[slot].to_ground(g, c),
    }
}

/// Returns `a · b`.
pub(crate) fn dot(g: &mut Graph, a: &[Expr], b: &[Expr]) -> Expr {
    let products: Vec<(f64, Expr)> = a.iter().zip(b).map(|(&a, &b)| (1.0, g.mul(a, b))).collect();
    g.sum(&products)
}

/// Returns `a × b`.
pub(crate) fn cross(g: &mut Graph, a: &[Expr], b: &[Expr]) -> Components {
    [[1, 2], [2, 0], [0, 1]]
        .into_iter()
        .map(|[j, k]| {
            let (plus, minus) = (g.mul(a[j], b[k]), g.mul(a[k], b[j]));
            g.sub(plus, minus)
        })
        .collect()
}

#[cfg(test)]
mod tests;
