//! Writes the scene of a drawing as text, with each number rounded once.

use std::fmt::Write;

use suite::numbers::Numbers;

use super::drawing::{Side, Tie, Vector};
use super::pose::{Placed, Posed};
use super::ratio::{Ratio, Surd};
use crate::fuzz::space::text::Precision;

/// Returns the scene as text.
#[must_use]
pub fn text(posed: &Posed) -> String {
    text_within(posed, &Precision::default())
}

/// Returns the scene with numbers of a given precision.
#[must_use]
pub fn text_within(posed: &Posed, precision: &Precision) -> String {
    let mut scene = "name = \"exact\", space = \"plane\"".to_owned();
    if let Some(tolerance) = precision.tolerance {
        scene.push_str(&format!(", tolerance = {tolerance:?}"));
    }
    let [x, y, _] = precision.gravity;
    if [x, y] != [0.0; 2] {
        scene.push_str(&format!(", gravity = [{x:?}, {y:?}]"));
    }
    let mut pen = Pen {
        posed,
        precision,
        errors: posed.careless.map(Numbers::new),
        text: format!("scene = {{ {scene} }}\n"),
    };
    for &k in &posed.order {
        pen.body(k);
    }
    let links = || posed.links.iter();
    for placed in links().filter(|p| !p.link.tie.is_drive()) {
        pen.joint(placed);
    }
    for placed in links().filter(|p| p.link.tie.is_drive()) {
        pen.drive(placed);
    }
    pen.text
}

/// Returns the name of a side.
#[must_use]
pub fn name(side: Side) -> String {
    side.map_or("ground".to_owned(), |k| format!("b{k}"))
}

struct Pen<'a> {
    posed: &'a Posed,
    precision: &'a Precision,
    /// Random errors of the positions of bodies, if the drawing should have them.
    errors: Option<Numbers>,
    text: String,
}

impl Pen<'_> {
    fn line(&mut self, key: &str, value: &str) {
        // Writing to a `String` cannot fail.
        let _ = writeln!(self.text, "{key} = {value}");
    }

    fn number(&self, x: Surd) -> f64 {
        self.rounded(x.rounded(self.posed.stretch))
    }

    fn rounded(&self, x: f64) -> f64 {
        self.precision.rounded(x)
    }

    fn pair(&self, p: [Surd; 2]) -> String {
        let [x, y] = p.map(|x| self.number(x));
        format!("[{x:?}, {y:?}]")
    }

    fn body(&mut self, k: usize) {
        let frame = &self.posed.frames[k];
        let mut position = self.posed.point(frame.origin).map(|x| self.number(x));
        if let Some(errors) = &mut self.errors {
            for x in position.iter_mut().filter(|x| **x != 0.0) {
                *x = if errors.once_in(2) {
                    x.next_down()
                } else {
                    x.next_up()
                };
            }
        }
        let [x, y] = position;
        let [c, s] = frame.turn.map(Ratio::rounded);
        let angle = self.rounded(s.atan2(c));
        self.text.push_str("\n[[body]]\n");
        self.line("name", &format!("\"b{k}\""));
        self.line("mass", "1.0");
        self.line("inertia", "1.0");
        self.line("position", &format!("[{x:?}, {y:?}]"));
        self.line("angle", &format!("{angle:?}"));
    }

    fn joint(&mut self, placed: &Placed) {
        let link = &placed.link;
        let sides = &link.sides;
        self.text.push_str("\n[[joint]]\n");
        self.line("name", &format!("\"{}\"", link.name));
        self.line("type", &format!("\"{}\"", kind(&link.tie)));
        match sides.as_slice() {
            [one] => self.line("body", &format!("\"{}\"", name(*one))),
            [first, second, ..] => {
                let names = format!("[\"{}\", \"{}\"]", name(*first), name(*second));
                self.line("bodies", &names);
            }
            [] => {}
        }
        match link.tie {
            Tie::Revolute { at } | Tie::Fixed { at } => {
                self.place(placed, &[(0, at), (1, at)], false);
            }
            Tie::Translational { from, at, along } | Tie::PinInSlot { from, at, along } => {
                self.place(placed, &[(0, from), (1, at)], false);
                let axis = self.direction(placed, self.across(sides[0], along));
                self.line("axis", &axis);
            }
            Tie::PointOnLine { at, along } => {
                self.place(placed, &[(0, at)], false);
                let [dx, dy] = self.across(None, along);
                let [x, y] = self.posed.point(at);
                let point = |f: i64| {
                    let f = Ratio::whole(f);
                    self.pair([x + dx.times(f), y + dy.times(f)])
                };
                let line = format!("[{}, {}]", point(-1), point(2));
                self.line("line", &line);
            }
            Tie::Distance { from, at } => self.place(placed, &[(0, from), (1, at)], true),
            Tie::Angle | Tie::AngleDrive { .. } => {}
            Tie::Gear { ratio } => {
                self.line("ratio", &format!("{:?}", self.rounded(ratio.rounded())));
                // The ground may be omitted.
                if sides[2].is_some() || placed.is_local {
                    self.line("carrier", &format!("\"{}\"", name(sides[2])));
                }
            }
            Tie::Rack { at, along, radius } => {
                self.place(placed, &[(1, at)], false);
                self.rolls(placed, "axis", along, radius);
            }
            Tie::Rolling { at, along, radius } => {
                self.place(placed, &[(0, at)], false);
                self.rolls(placed, "direction", along, radius);
            }
            Tie::KnifeEdge { at, along } => {
                self.place(placed, &[(0, at)], false);
                let normal = self.posed.vector_in(sides[0], along);
                let normal = self.direction(placed, normal);
                self.line("normal", &normal);
            }
            Tie::Velocity { at, along } => {
                self.place(placed, &[(0, at)], false);
                let direction = self.posed.vector_in(sides[0], along);
                let direction = self.direction(placed, direction);
                self.line("direction", &direction);
                self.line("rate", "0.0");
            }
        }
    }

    fn drive(&mut self, placed: &Placed) {
        let Tie::AngleDrive { joint } = placed.link.tie else {
            return;
        };
        self.text.push_str("\n[[drive]]\n");
        self.line("name", &format!("\"{}\"", placed.link.name));
        self.line("joint", &format!("\"j{joint}\""));
        self.line("type", "\"angle\"");
        self.line("motion", "{ type = \"polynomial\", coefficients = [0.0] }");
    }

    /// Writes points. Each point is given with the index of its body in the argument list of the
    /// joint.
    fn place(&mut self, placed: &Placed, points: &[(usize, Vector)], is_apart: bool) {
        let sides = &placed.link.sides;
        let is_one = points.windows(2).all(|w| w[0].1 == w[1].1);
        if !(placed.is_local || !is_apart && !is_one) {
            let world = |p: Vector| self.pair(self.posed.point(p));
            let at = if is_apart {
                format!("[{}, {}]", world(points[0].1), world(points[1].1))
            } else {
                world(points[0].1)
            };
            return self.line("at", &at);
        }
        let local = |&(slot, p): &(usize, Vector)| self.pair(self.posed.point_in(sides[slot], p));
        match sides.as_slice() {
            [_] => {
                let point = local(&points[0]);
                self.line("point", &point);
            }
            _ => {
                let all = points.iter();
                let all: Vec<String> = all
                    .map(|point| format!("{} = {}", name(sides[point.0]), local(point)))
                    .collect();
                self.line("points", &format!("{{ {} }}", all.join(", ")));
            }
        }
    }

    /// Returns the direction of `along`, rotated by −90°, in the frame of a side.
    fn across(&self, side: Side, along: Vector) -> [Surd; 2] {
        let [x, y] = self.posed.vector_in(side, along);
        [y, x.times(-Ratio::ONE)]
    }

    fn direction(&self, placed: &Placed, v: [Surd; 2]) -> String {
        match placed.factor {
            Some(factor) => self.pair(v.map(|x| x.times(factor))),
            None => {
                let [x, y] = v.map(|x| x.rounded(self.posed.stretch));
                let length = x.hypot(y);
                let [x, y] = [x, y].map(|x| self.rounded(x / length));
                format!("[{x:?}, {y:?}]")
            }
        }
    }

    /// Writes direction and radius. The given torque belongs to the force `along`, so the radius is
    /// the torque divided by the length of `along`.
    fn rolls(&mut self, placed: &Placed, key: &str, along: Vector, radius: Ratio) {
        let direction = self.posed.vector_in(placed.link.sides[0], along);
        let direction = self.direction(placed, direction);
        self.line(key, &direction);
        let radius = self.rounded(self.posed.lever(along, radius));
        self.line("radius", &format!("{radius:?}"));
    }
}

/// Returns the value of `type`.
fn kind(tie: &Tie) -> &'static str {
    match tie {
        Tie::Revolute { .. } => "revolute",
        Tie::Fixed { .. } => "fixed",
        Tie::Translational { .. } => "translational",
        Tie::PinInSlot { .. } => "pin-in-slot",
        Tie::PointOnLine { .. } => "point-on-line",
        Tie::Distance { .. } => "distance",
        Tie::Angle => "angle",
        Tie::Gear { .. } => "gear",
        Tie::Rack { .. } => "rack-and-pinion",
        Tie::KnifeEdge { .. } => "knife-edge",
        Tie::Velocity { .. } => "velocity",
        Tie::Rolling { .. } => "rolling",
        Tie::AngleDrive { .. } => "angle",
    }
}
