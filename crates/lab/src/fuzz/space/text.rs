//! Writes the scene of a drawing as text: `[scene] space = "spatial"`. Every number is a fraction
//! rounded once, to a double or to some significant digits.

#[cfg(test)]
mod tests;

use std::fmt::Write;

use super::drawing::{Body, Directions, Drawing, Drive, Joint, Kind, Measure, Side};
use super::ratio::Ratio;
use super::rows;
use super::vector::{Rotation, Vector};
use model::{AnyDescription, Registry, SpatialDescription};
use pfaff::AssembledScene;

/// The number of digits, and the data that the scene contains in addition to the drawing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Precision {
    /// Number of significant digits. `None` means all digits of a double.
    pub digits: Option<usize>,
    /// The tolerance that the scene states (m).
    pub tolerance: Option<f64>,
    /// Acceleration of gravity (m/s²).
    pub gravity: [f64; 3],
}

impl Precision {
    /// Returns the precision for a number of significant digits. The tolerance is twice the unit of
    /// the last digit of the largest coordinate.
    #[must_use]
    pub fn of_digits(drawing: &Drawing, digits: usize) -> Self {
        let unit = 10_f64.powi(1 - i32::try_from(digits).unwrap_or(i32::MAX));
        Self {
            digits: Some(digits),
            tolerance: Some(2.0 * unit * largest_coordinate(drawing)),
            ..Self::default()
        }
    }

    /// Rounds a number to these digits.
    #[must_use]
    pub fn rounded(&self, x: f64) -> f64 {
        match self.digits {
            Some(digits) => {
                let decimal = format!("{x:.*e}", digits.saturating_sub(1));
                decimal.parse().unwrap_or(x)
            }
            None => x,
        }
    }
}

/// Returns the scene as text, with all digits of a double.
#[must_use]
pub fn text(drawing: &Drawing) -> String {
    text_within(drawing, &Precision::default())
}

/// Returns the scene with numbers of a given precision.
#[must_use]
pub fn text_within(drawing: &Drawing, precision: &Precision) -> String {
    written(drawing, precision).text
}

/// Returns the description that is read from the text.
///
/// # Errors
/// Returns the message if the scene is rejected.
pub fn description(drawing: &Drawing, precision: &Precision) -> Result<SpatialDescription, String> {
    let text = text_within(drawing, precision);
    let read = AssembledScene::read("scene.toml", &text, &Registry::standard());
    match read.map_err(|e| e.to_string())?.scene.description {
        AnyDescription::Space3(description) => Ok(description),
        AnyDescription::Plane(_) => Err("the scene is planar".into()),
    }
}

/// Returns the largest coordinate in the text (m), at least 1.
#[must_use]
pub fn largest_coordinate(drawing: &Drawing) -> f64 {
    written(drawing, &Precision::default()).largest.max(1.0)
}

fn written<'a>(drawing: &'a Drawing, precision: &'a Precision) -> Pen<'a> {
    let mut pen = Pen {
        drawing,
        precision,
        largest: 0.0,
        text: String::new(),
    };
    pen.text.push_str("[scene]\n");
    pen.line("name", "\"exact\"");
    pen.line("space", "\"spatial\"");
    if let Some(tolerance) = precision.tolerance {
        pen.line("tolerance", &format!("{tolerance:?}"));
    }
    if precision.gravity != [0.0; 3] {
        pen.line("gravity", &format!("{:?}", precision.gravity));
    }
    if precision.digits.is_some() {
        pen.text.push_str("\n[start]\nallow_correction = true\n");
    }
    for body in &drawing.bodies {
        pen.body(body);
    }
    for joint in &drawing.joints {
        pen.joint(joint);
    }
    for drive in &drawing.drives {
        pen.drive(drive);
    }
    pen
}

struct Pen<'a> {
    drawing: &'a Drawing,
    precision: &'a Precision,
    /// The largest coordinate of a point so far.
    largest: f64,
    text: String,
}

impl Pen<'_> {
    fn line(&mut self, key: &str, value: &str) {
        // Writing to a `String` cannot fail.
        let _ = writeln!(self.text, "{key} = {value}");
    }

    fn number(&self, x: f64) -> String {
        format!("{:?}", self.precision.rounded(x))
    }

    fn list(&self, numbers: &[f64]) -> String {
        let numbers: Vec<String> = numbers.iter().map(|&x| self.number(x)).collect();
        format!("[{}]", numbers.join(", "))
    }

    fn length(&mut self, p: &Vector) -> String {
        let numbers = p.0.each_ref().map(Ratio::rounded);
        self.largest = numbers.iter().fold(self.largest, |a, x| a.max(x.abs()));
        self.list(&numbers)
    }

    fn name(&self, side: Side) -> &str {
        side.map_or("ground", |k| self.drawing.bodies[k].name.as_str())
    }

    fn body(&mut self, body: &Body) {
        self.text.push_str("\n[[body]]\n");
        self.line("name", &format!("\"{}\"", body.name));
        let mass = self.number(body.mass.rounded());
        self.line("mass", &mass);
        let inertia = self.inertia(&body.inertia);
        self.line("inertia", &inertia);
        let position = self.length(&body.position);
        self.line("position", &position);
        if !body.centre.is_zero() {
            let centre = self.length(&body.centre);
            self.line("centre", &centre);
        }
        if body.orientation != Rotation::none() {
            let quaternion = self.list(&body.orientation.rounded());
            self.line("orientation", &format!("{{ quaternion = {quaternion} }}"));
        }
    }

    fn inertia(&self, tensor: &[[Ratio; 3]; 3]) -> String {
        let is_diagonal = (0..3).all(|i| (0..3).all(|j| i == j || tensor[i][j].is_zero()));
        if is_diagonal {
            return self.list(&[0, 1, 2].map(|k| tensor[k][k].rounded()));
        }
        let rows = tensor.each_ref().map(|row| {
            let row = row.each_ref().map(Ratio::rounded);
            self.list(&row)
        });
        format!("[{}]", rows.join(", "))
    }

    fn joint(&mut self, joint: &Joint) {
        self.text.push_str("\n[[joint]]\n");
        self.line("name", &format!("\"{}\"", joint.name));
        self.line("type", &format!("\"{}\"", joint.kind.name()));
        let [first, second] = joint.bodies.map(|side| self.name(side).to_owned());
        if joint.kind.has_one_body() {
            self.line("body", &format!("\"{first}\""));
        } else {
            self.line("bodies", &format!("[\"{first}\", \"{second}\"]"));
        }
        match &joint.kind {
            Kind::Spherical { at } | Kind::Fixed { at } => self.place(joint, at, at),
            Kind::Revolute { at, axis } => {
                self.place(joint, at, at);
                self.axis(joint, "axis", axis);
            }
            Kind::Universal { at, first, second } => {
                self.place(joint, at, at);
                self.two_axes(joint, first, second);
            }
            Kind::Translational { from, at, axis }
            | Kind::Cylindrical { from, at, axis }
            | Kind::PointOnLine { from, at, axis } => {
                self.place(joint, from, at);
                self.axis(joint, "axis", axis);
            }
            Kind::Planar { from, at, normal } | Kind::PointOnPlane { from, at, normal } => {
                self.place(joint, from, at);
                self.axis(joint, "normal", normal);
            }
            Kind::Parallel { axis } => self.axis(joint, "axis", axis),
            Kind::Perpendicular { first, second } => self.two_axes(joint, first, second),
            Kind::Orientation => {}
            Kind::Distance { from, at } if joint.style.points_in_bodies => {
                self.place(joint, from, at);
            }
            Kind::Distance { from, at } => {
                let ends = format!("[{}, {}]", self.length(from), self.length(at));
                self.line("at", &ends);
            }
            Kind::KnifeEdge { at, normal } => {
                self.place(joint, at, at);
                self.axis(joint, "normal", normal);
            }
            Kind::Wheel { .. } => self.wheel(joint),
        }
    }

    fn wheel(&mut self, joint: &Joint) {
        let Kind::Wheel {
            centre,
            axis,
            contact,
            normal,
        } = &joint.kind
        else {
            return;
        };
        let point = self.point_in(joint.bodies[0], centre);
        self.line("point", &point);
        let in_body = self.direction_in(joint, joint.bodies[0], axis);
        self.line("axis", &in_body);
        let radius = self.number((contact - centre).square().root());
        self.line("radius", &radius);
        // The default plane is z = 0.
        let [x, y, z] = &normal.0;
        let is_default = x.is_zero() && y.is_zero() && Ratio::zero().is_below(z);
        if !(is_default && contact.0[2].is_zero() && joint.style.points_in_bodies) {
            let (point, normal) = (self.length(contact), self.direction_in(joint, None, normal));
            self.line(
                "plane",
                &format!("{{ point = {point}, normal = {normal} }}"),
            );
        }
    }

    fn drive(&mut self, drive: &Drive) {
        self.text.push_str("\n[[drive]]\n");
        self.line("name", &format!("\"{}\"", drive.name));
        let joint = &self.drawing.joints[drive.joint].name;
        self.line("joint", &format!("\"{joint}\""));
        let measure = match drive.measure {
            Measure::Angle => "angle",
            Measure::Displacement => "displacement",
            Measure::Length => "length",
        };
        self.line("type", &format!("\"{measure}\""));
        self.line("motion", "{ type = \"polynomial\", coefficients = [0.0] }");
    }

    /// Writes the position: one point of the ground, or two points in the frames of the bodies.
    fn place(&mut self, joint: &Joint, from: &Vector, at: &Vector) {
        if joint.is_placed_in_ground() {
            let at = self.length(at);
            return self.line("at", &at);
        }
        let [first, second] = joint.bodies;
        let from = self.point_in(first, from);
        if joint.kind.has_one_body() {
            return self.line("point", &from);
        }
        let at = self.point_in(second, at);
        let (first, second) = (self.name(first).to_owned(), self.name(second).to_owned());
        self.line(
            "points",
            &format!("{{ {first} = {from}, {second} = {at} }}"),
        );
    }

    fn point_in(&mut self, side: Side, p: &Vector) -> String {
        let local = self.drawing.frame(side).inverse().point(p);
        self.length(&local)
    }

    /// Writes the frame of directions, unless this frame is the frame of the first body. Returns
    /// the frame.
    fn directions_of(&mut self, joint: &Joint) -> Side {
        if joint.style.directions == Directions::Ground {
            self.line("frame", "\"global\"");
        }
        joint.frame_of_directions()
    }

    /// Writes an axis or normal, and the direction that selects the basis of rows.
    fn axis(&mut self, joint: &Joint, key: &str, axis: &Vector) {
        let [first, second] = joint.bodies;
        let frame = self.directions_of(joint);
        let in_frame = self.direction_in(joint, frame, axis);
        if joint.gives_both_axes() {
            let other = self.direction_in(joint, second, axis);
            let (first, second) = (self.name(first).to_owned(), self.name(second).to_owned());
            let axes = format!("{{ {first} = {in_frame}, {second} = {other} }}");
            self.line("axes", &axes);
        } else {
            self.line(key, &in_frame);
        }
        let cross = joint.cross.as_ref();
        if let Some(cross) = cross.filter(|_| rows::basis_axis(&joint.kind).is_some()) {
            let cross = self.direction_in(joint, frame, cross);
            self.line("cross", &cross);
        }
    }

    fn two_axes(&mut self, joint: &Joint, first: &Vector, second: &Vector) {
        let frame = self.directions_of(joint);
        let (first, second) = (
            self.direction_in(joint, frame, first),
            self.direction_in(joint, frame, second),
        );
        self.line("axis", &first);
        self.line("cross", &second);
    }

    fn direction_in(&self, joint: &Joint, side: Side, d: &Vector) -> String {
        self.list(&direction_in(self.drawing, joint, side, d))
    }
}

/// Returns a direction in the frame of a side, times the factor of the joint or divided by its
/// length.
fn direction_in(drawing: &Drawing, joint: &Joint, side: Side, d: &Vector) -> [f64; 3] {
    let local = drawing.frame(side).turn.inverse().of(d);
    match &joint.style.factor {
        Some(factor) => local.times(factor).0.each_ref().map(Ratio::rounded),
        None => {
            let square = local.square();
            let part = |x: &Ratio| {
                let share = &(x * x) / &square;
                share.root().copysign(x.rounded())
            };
            local.0.each_ref().map(part)
        }
    }
}
