//! Gears and racks: a closed train carries a load if the ratios around it multiply to one, and is
//! locked if they do not.

use super::super::drawing::{GROUND, Side, Tie, Vector, along};
use super::super::ratio::Ratio;
use super::Pen;

/// Ratios whose doubles are not exact, nor their products.
const RATIOS: [(i128, i128); 10] = [
    (1, 3),
    (-1, 3),
    (-1, 10),
    (-3, 7),
    (10, 1),
    (-2, 1),
    (-1, 1),
    (-7, 5),
    (-9, 11),
    (3, 10),
];

impl Pen<'_> {
    pub(super) fn gears(&mut self) {
        let kind = self.numbers.below(7);
        // Bearings of a tree leave one rotation to each wheel, and ratios do not change.
        self.drawing.has_constant_rank = kind < 5;
        match kind {
            0 | 1 => self.closed_train(),
            2 | 3 => self.planets(),
            4 => self.held(),
            _ => self.racks(),
        }
    }

    fn ratio(&mut self) -> Ratio {
        let (n, d) = RATIOS[self.numbers.below(RATIOS.len())];
        Ratio::new(n, d)
    }

    /// A wheel in a bearing of the carrier, mostly at its centre.
    fn geared(&mut self, carrier: Side) -> Side {
        let centre = self.point();
        let wheel = match self.once_in(4) {
            true => self.body(),
            false => self.drawing.body_at(centre),
        };
        if !self.once_in(8) {
            self.hinge([carrier, wheel], centre);
        }
        wheel
    }

    fn mesh(&mut self, first: Side, second: Side, carrier: Side, ratio: Ratio) {
        self.link(&[first, second, carrier], Tie::Gear { ratio });
    }

    /// A wheel held by two meshes with the ground: any ratios say the same.
    fn held(&mut self) {
        let wheel = self.geared(GROUND);
        for _ in 0..2 {
            let ratio = self.ratio();
            match self.once_in(2) {
                true => self.mesh(GROUND, wheel, GROUND, ratio),
                false => self.mesh(wheel, GROUND, GROUND, ratio),
            }
        }
        self.drawing.redundancy = Some(1);
    }

    /// Wheels in a ring.
    fn closed_train(&mut self) {
        let carrier = match self.once_in(2) {
            true => GROUND,
            false => {
                let (carrier, at) = (self.body(), self.point());
                if self.once_in(2) {
                    self.hinge([GROUND, carrier], at);
                }
                carrier
            }
        };
        let n = 2 + self.numbers.below(3);
        let wheels: Vec<Side> = (0..n).map(|_| self.geared(carrier)).collect();
        let mut product = Ratio::ONE;
        for pair in wheels.windows(2) {
            let ratio = self.ratio();
            self.mesh(pair[0], pair[1], carrier, ratio);
            product = product * ratio;
        }
        let is_locked = self.once_in(3);
        self.drawing.redundancy = Some(usize::from(!is_locked));
        let closing = match is_locked {
            // A near relative.
            true => product * Ratio::new(51, 50),
            false => product,
        };
        match self.once_in(2) {
            true => self.mesh(wheels[0], wheels[n - 1], carrier, closing),
            false => self.mesh(wheels[n - 1], wheels[0], carrier, closing.inverse()),
        }
    }

    /// A sun, a ring on the ground or free, and planets on a carrier.
    fn planets(&mut self) {
        let centre = self.point();
        let (sun, carrier) = (self.drawing.body_at(centre), self.drawing.body_at(centre));
        self.hinge([GROUND, sun], centre);
        self.hinge([GROUND, carrier], centre);
        let ring = match self.once_in(3) {
            true => {
                let ring = self.drawing.body_at(centre);
                self.hinge([GROUND, ring], centre);
                ring
            }
            false => GROUND,
        };
        let (inner, outer) = (Ratio::new(-2, 1), Ratio::new(1, 4));
        let shrink = self.ratio();
        let (count, mut is_locked) = (1 + self.numbers.below(3), false);
        for k in 0..count {
            let at = self.point();
            let planet = self.drawing.body_at(at);
            self.hinge([carrier, planet], at);
            let is_spoilt = k > 0 && self.once_in(4);
            is_locked |= is_spoilt;
            let spoil = match is_spoilt {
                true => Ratio::new(9, 10),
                false => Ratio::ONE,
            };
            // Planets of different sizes: the product of both meshes is that of sun and ring.
            let shrink = if k == 0 { Ratio::ONE } else { shrink };
            self.mesh(sun, planet, carrier, inner * shrink);
            self.mesh(planet, ring, carrier, outer * shrink.inverse() * spoil);
        }
        // Each planet says what the first one says of sun and ring; another ratio locks both, once.
        self.drawing.redundancy = Some(count - 1 - usize::from(is_locked));
    }

    /// A rack on a slider or free, and pinions on both sides, geared to each other.
    fn racks(&mut self) {
        let rack = self.body();
        let way = self.direction();
        // What pushes across the way once the plane is stretched: the axis of this slider is the
        // way.
        let (k, at) = (Ratio::whole(i64::from(self.drawing.stretch)), self.point());
        let normal = [-(k * way[1]), way[0]];
        if !self.once_in(4) {
            self.slider([GROUND, rack], at, normal);
        }
        let mut pinions: Vec<(Side, Ratio)> = Vec::new();
        for _ in 0..1 + self.numbers.below(3) {
            let centre = self.point();
            let radius = self.not_zero(5) * self.step;
            let pinion = self.drawing.body_at(centre);
            self.hinge([GROUND, pinion], centre);
            self.rack(rack, pinion, centre, way, radius);
            pinions.push((pinion, radius));
        }
        for pair in pinions.windows(2) {
            let ([first, second], [r, s]) = ([pair[0].0, pair[1].0], [pair[0].1, pair[1].1]);
            // −v = r·ω_1 = s·ω_2
            let ratio = match self.once_in(3) {
                true => r * s.inverse() * Ratio::new(5, 4),
                false => r * s.inverse(),
            };
            if self.once_in(2) {
                self.mesh(first, second, GROUND, ratio);
            }
        }
        if self.once_in(4) {
            // A second mesh of the same rack with the same pinion.
            let (pinion, radius) = pinions[0];
            let centre = pinion.and_then(|p| self.drawing.origins[p]);
            if let Some(centre) = centre {
                let beside = along(centre, Ratio::ONE, way);
                self.rack(rack, pinion, beside, way, radius);
            }
        }
    }

    fn rack(&mut self, rack: Side, pinion: Side, at: Vector, along: Vector, radius: Ratio) {
        self.link(&[rack, pinion], Tie::Rack { at, along, radius });
    }
}
