//! The same mechanism in other units, at another place, turned, or in another order.

use model::BodyRef;

use super::{Sketch, Tie, Vector};

impl Sketch {
    /// All lengths multiplied by a factor, as in a change of units: from m to mm it is 1000.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut sketch = self.mapped(|p| p.map(|x| factor * x), |v| v);
        for body in &mut sketch.bodies {
            body.inertia *= factor * factor;
        }
        for link in &mut sketch.links {
            if let Tie::RackAndPinion { radius, .. } | Tie::Rolling { radius, .. } = &mut link.tie {
                *radius *= factor;
            }
        }
        sketch
    }

    /// Moved as a whole, including the ground.
    #[must_use]
    pub fn moved(&self, by: Vector) -> Self {
        self.mapped(|p| [p[0] + by[0], p[1] + by[1]], |v| v)
    }

    /// Turned about the origin as a whole, including the ground.
    #[must_use]
    pub fn turned(&self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        let turn = |p: Vector| [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]];
        let mut sketch = self.mapped(turn, turn);
        for body in &mut sketch.bodies {
            body.angle += angle;
        }
        sketch
    }

    /// Bodies in another order: body `order[k]` becomes body k.
    ///
    /// # Panics
    /// If `order` is not a permutation of all bodies.
    #[must_use]
    pub fn with_bodies(&self, order: &[usize]) -> Self {
        let place = |k: usize| order.iter().position(|&o| o == k).expect("an order");
        let mut sketch = self.clone();
        sketch.bodies = order.iter().map(|&k| self.bodies[k].clone()).collect();
        for body in sketch.links.iter_mut().flat_map(|l| &mut l.bodies) {
            if let BodyRef::Body(k) = body {
                *k = place(*k);
            }
        }
        sketch
    }

    /// Links in another order.
    #[must_use]
    pub fn with_links(&self, order: &[usize]) -> Self {
        Self {
            bodies: self.bodies.clone(),
            links: order.iter().map(|&k| self.links[k].clone()).collect(),
        }
    }

    /// Every point and every direction transformed.
    fn mapped(&self, point: impl Fn(Vector) -> Vector, vector: impl Fn(Vector) -> Vector) -> Self {
        let mut sketch = self.clone();
        for body in &mut sketch.bodies {
            body.position = point(body.position);
        }
        for link in &mut sketch.links {
            match &mut link.tie {
                Tie::Angle | Tie::AngleDrive | Tie::Gear { .. } => {}
                Tie::Revolute { at } | Tie::Fixed { at } => *at = point(*at),
                Tie::Distance { from, at } => (*from, *at) = (point(*from), point(*at)),
                Tie::Translational { from, at, axis }
                | Tie::PinInSlot { from, at, axis }
                | Tie::DisplacementDrive { from, at, axis } => {
                    (*from, *at, *axis) = (point(*from), point(*at), vector(*axis));
                }
                Tie::RackAndPinion { at, axis, .. } => {
                    (*at, *axis) = (point(*at), vector(*axis));
                }
                Tie::KnifeEdge { at, normal } => (*at, *normal) = (point(*at), vector(*normal)),
                Tie::Rolling { at, direction, .. } => {
                    (*at, *direction) = (point(*at), vector(*direction));
                }
            }
        }
        sketch
    }
}
