//! Drawings of full rank that are near a lower one: pins beside their place, dead centres, lines at
//! small angles, thin loops. Their data may be known to a third of what they are off by and less,
//! and nothing of them is redundant.

use crate::numbers::Numbers;

use super::super::drawing::{Drawing, GROUND, Side, Tie, Vector, along};
use super::super::ratio::Ratio;
use super::Pen;

/// A kind of such drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Slender {
    /// Parallel cranks, one pin beside its place.
    OffsetCrank,
    /// Two pins of one door.
    OffsetPin,
    /// A four-bar near its dead centre, its rocker held.
    DeadCentre,
    /// A slider-crank near its dead centre, its slider held.
    SliderCrank,
    /// A bar held by two others that nearly meet on its line.
    ThinTriangle,
    /// A parallelogram with short sides.
    ThinLoop,
    /// Edges whose normals are at a small angle.
    SteepEdges,
    /// A slot at a small angle to a slider.
    SteepSlot,
    /// Steered wheels that are nearly straight.
    Steering,
    /// A closed train whose ratios nearly multiply to one.
    Train,
}

impl Slender {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::OffsetCrank,
        Self::OffsetPin,
        Self::DeadCentre,
        Self::SliderCrank,
        Self::ThinTriangle,
        Self::ThinLoop,
        Self::SteepEdges,
        Self::SteepSlot,
        Self::Steering,
        Self::Train,
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::OffsetCrank => "offset cranks",
            Self::OffsetPin => "offset pins",
            Self::DeadCentre => "dead centres",
            Self::SliderCrank => "slider-cranks",
            Self::ThinTriangle => "thin triangles",
            Self::ThinLoop => "thin loops",
            Self::SteepEdges => "steep edges",
            Self::SteepSlot => "steep slots",
            Self::Steering => "steering near zero",
            Self::Train => "nearly closed trains",
        }
    }

    /// A drawing.
    #[must_use]
    pub fn draw(self, numbers: &mut Numbers) -> Drawing {
        let mut pen = Pen::new(numbers);
        pen.drawing.stretch = 1;
        match self {
            Self::OffsetCrank => pen.offset_crank(),
            Self::OffsetPin => pen.offset_pin(),
            Self::DeadCentre => pen.dead_centre(),
            Self::SliderCrank => pen.held_slider_crank(),
            Self::ThinTriangle => pen.thin_triangle(),
            Self::ThinLoop => pen.thin_loop(),
            Self::SteepEdges => pen.steep_edges(),
            Self::SteepSlot => pen.steep_slot(),
            Self::Steering => pen.steering(),
            Self::Train => pen.train(),
        }
        pen.drawing
    }
}

fn quarter([x, y]: Vector) -> Vector {
    [-y, x]
}

impl Pen<'_> {
    /// 1e-4 to 5e-2, of either sign.
    fn little(&mut self) -> Ratio {
        let [n, d] = [
            [1, 2, 5][self.numbers.below(3)],
            [100, 1_000, 10_000][self.numbers.below(3)],
        ];
        let sign = 1 - 2 * self.numbers.below(2) as i128;
        Ratio::new(sign * n, d)
    }

    /// A vector of the grid, turned by a small angle.
    fn turned(&mut self, v: Vector) -> Vector {
        let little = self.little();
        along(v, little, quarter(v))
    }

    fn offset_crank(&mut self) {
        let (arm, coupler) = (self.vector(6), self.body());
        let pivots: Vec<Vector> = match self.once_in(2) {
            true => {
                let (origin, line) = (self.point(), self.direction());
                self.places(origin, line, 3)
            }
            false => (0..3).map(|_| self.point()).collect(),
        };
        for (k, pivot) in pivots.into_iter().enumerate() {
            let crank = self.body();
            let pin = match k {
                2 => {
                    let (little, off) = (self.little(), self.vector(3));
                    along(pivot, little, off)
                }
                _ => pivot,
            };
            self.hinge([GROUND, crank], pin);
            self.hinge([crank, coupler], along(pivot, Ratio::ONE, arm));
        }
    }

    fn offset_pin(&mut self) {
        let door = self.body();
        let base = match self.once_in(2) {
            true => self.body(),
            false => GROUND,
        };
        let (at, off, little) = (self.point(), self.vector(5), self.little());
        self.hinge([base, door], at);
        let beside = along(at, little, off);
        match self.once_in(3) {
            // One row of a second pin.
            true => {
                let u = self.direction();
                let axis = self.drawing.across(u);
                let from = self.on_line(beside, axis, 2);
                self.link(
                    &[base, door],
                    Tie::PinInSlot {
                        from,
                        at: beside,
                        along: u,
                    },
                );
            }
            false => {
                // Without the row along the line of the pins, which is there already.
                let u = quarter(off);
                let from = beside;
                self.link(
                    &[base, door],
                    Tie::PinInSlot {
                        from,
                        at: beside,
                        along: u,
                    },
                );
            }
        }
        if self.once_in(2) {
            // Something beside it that is well held, and makes the whole larger.
            let (far, end) = (self.point(), self.point());
            let other = self.body();
            self.hinge([door, other], far);
            self.bar([GROUND, other], end, along(far, Ratio::ONE, quarter(off)));
        }
    }

    fn dead_centre(&mut self) {
        let (a, arm) = (self.point(), self.vector(4));
        let b = along(a, Ratio::ONE, arm);
        let bent = self.turned(arm);
        let share = self.not_zero(3);
        let c = along(b, share, bent);
        let d = along(self.point(), self.step, quarter(arm));
        let bars = [0; 3].map(|_| self.body());
        self.hinge([GROUND, bars[0]], a);
        self.hinge([bars[0], bars[1]], b);
        self.hinge([bars[1], bars[2]], c);
        let bearing = self.hinge([bars[2], GROUND], d);
        match self.once_in(2) {
            true => self.drawing.drive(bearing),
            false => {
                let across = quarter([c[0] - d[0], c[1] - d[1]]);
                self.bar([bars[2], GROUND], c, along(c, Ratio::whole(2), across));
            }
        }
    }

    fn held_slider_crank(&mut self) {
        let (pivot, way) = (self.point(), self.vector(3));
        let bent = self.turned(way);
        let (first, second) = (self.not_zero(3), self.not_zero(5));
        let tip = along(pivot, first, bent);
        let end = along(pivot, first + second, way);
        let [crank, rod, slider] = [0; 3].map(|_| self.body());
        self.hinge([GROUND, crank], pivot);
        self.hinge([crank, rod], tip);
        self.hinge([rod, slider], end);
        self.slider([GROUND, slider], end, quarter(way));
        let anchor = along(end, Ratio::whole(2), way);
        self.bar([GROUND, slider], anchor, end);
    }

    fn thin_triangle(&mut self) {
        let (node, line) = (self.point(), self.vector(4));
        let body = self.drawing.body_at(node);
        let bent = self.turned(line);
        let (first, second) = (self.not_zero(4), self.not_zero(4));
        self.bar([GROUND, body], along(node, first, line), node);
        self.bar([GROUND, body], along(node, second, bent), node);
    }

    fn thin_loop(&mut self) {
        let (a, long) = (self.point(), self.vector(6));
        let (little, side) = (self.little(), self.vector(5));
        let [b, c, d] = [
            along(a, Ratio::ONE, long),
            along(along(a, Ratio::ONE, long), little, side),
            along(a, little, side),
        ];
        let bars = [0; 3].map(|_| self.body());
        self.hinge([GROUND, bars[0]], a);
        self.hinge([bars[0], bars[1]], b);
        self.hinge([bars[1], bars[2]], c);
        self.hinge([bars[2], GROUND], d);
    }

    fn steep_edges(&mut self) {
        let (body, at, normal) = (self.body(), self.point(), self.vector(4));
        let other = match self.once_in(2) {
            true => self.on_line(at, normal, 5),
            false => at,
        };
        let bent = self.turned(normal);
        self.link(&[body], Tie::KnifeEdge { at, along: normal });
        self.link(
            &[body],
            Tie::KnifeEdge {
                at: other,
                along: bent,
            },
        );
        if self.once_in(2) {
            let far = self.point();
            self.link(
                &[body],
                Tie::KnifeEdge {
                    at: along(far, self.step, normal),
                    along: quarter(normal),
                },
            );
        }
    }

    fn steep_slot(&mut self) {
        let (body, at, u) = (self.body(), self.point(), self.vector(4));
        let base = match self.once_in(2) {
            true => self.body(),
            false => GROUND,
        };
        self.slider([base, body], at, u);
        let bent = self.turned(u);
        let (pin, axis) = (self.point(), self.drawing.across(bent));
        let from = self.on_line(pin, axis, 3);
        self.link(
            &[base, body],
            Tie::PinInSlot {
                from,
                at: pin,
                along: bent,
            },
        );
    }

    /// A rear wheel, and two front wheels that are steered alike: no common centre.
    fn steering(&mut self) {
        let (rear, ahead) = (self.point(), self.vector(5));
        let side = quarter(ahead);
        let chassis = self.drawing.body_at(rear);
        self.link(
            &[chassis],
            Tie::KnifeEdge {
                at: rear,
                along: side,
            },
        );
        let bent = self.turned(side);
        let is_forked = self.once_in(2);
        for share in [Ratio::new(1, 3), Ratio::new(-1, 3)] {
            let at = along(along(rear, Ratio::ONE, ahead), share, side);
            let steered: Side = match is_forked {
                false => chassis,
                true => {
                    let fork = self.body();
                    let pivot = self.hinge([chassis, fork], at);
                    self.drawing.drive(pivot);
                    fork
                }
            };
            self.link(&[steered], Tie::KnifeEdge { at, along: bent });
        }
    }

    fn train(&mut self) {
        let wheels: Vec<Side> = (0..2 + self.numbers.below(2))
            .map(|_| {
                let at = self.point();
                let wheel = self.drawing.body_at(at);
                self.hinge([GROUND, wheel], at);
                wheel
            })
            .collect();
        let mut product = Ratio::ONE;
        for pair in wheels.windows(2) {
            let ratio = Ratio::new([-1, -2, 3][self.numbers.below(3)], 2);
            self.link(&[pair[0], pair[1], GROUND], Tie::Gear { ratio });
            product = product * ratio;
        }
        let ratio = product * (Ratio::ONE + self.little());
        self.link(
            &[wheels[0], wheels[wheels.len() - 1], GROUND],
            Tie::Gear { ratio },
        );
    }
}
