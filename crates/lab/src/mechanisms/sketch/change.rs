//! The same mechanism in other units, translated, rotated, or in another order.

use model::BodyRef;

use super::{Sketch, Tie, Vector};

impl Sketch {
    /// Multiplies all lengths by a factor, as in a change of units. For a change from m to mm, the
    /// factor is 1000.
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

    /// Translates the whole mechanism, including the ground.
    #[must_use]
    pub fn moved(&self, by: Vector) -> Self {
        self.mapped(|p| [p[0] + by[0], p[1] + by[1]], |v| v)
    }

    /// Rotates the whole mechanism about the origin, including the ground.
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

    /// Changes the order of bodies: body `order[k]` becomes body k.
    ///
    /// # Panics
    /// Panics if `order` is not a permutation of all bodies.
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

    /// Changes the order of links.
    #[must_use]
    pub fn with_links(&self, order: &[usize]) -> Self {
        Self {
            bodies: self.bodies.clone(),
            links: order.iter().map(|&k| self.links[k].clone()).collect(),
        }
    }

    /// Transforms every point and every direction.
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
