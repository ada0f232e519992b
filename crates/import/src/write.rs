//! Writes the text of a scene.

use std::fmt::Write;

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::findings::{Findings, Omission};
use crate::limits::WIDTH;
use crate::mechanism::{HeldWeight, Joint, JointKind, Load, Model};
use crate::names::Names;
use crate::pose::{Motion, along_z};

/// Data that are written in addition to the model.
pub(crate) struct Heading<'a> {
    /// Name of the file and name of its format.
    pub(crate) source: (&'a str, &'static str),
    /// Accuracy of lengths and directions (m, rad).
    pub(crate) tolerance: [Option<f64>; 2],
    /// The initial poses of the links, if these differ from the described poses, and whether the
    /// links have initial velocities.
    pub(crate) start: Option<(&'a [Motion], bool)>,
}

/// The scene of a model.
pub(crate) fn scene(model: &Model, heading: &Heading, findings: &mut Findings) -> String {
    let mut writer = Writer::new(model, findings);
    let mut body = String::new();
    writer.bodies(heading, &mut body);
    writer.joints(&mut body);
    writer.couplings(&mut body);
    writer.drives(&mut body);
    writer.loads(&mut body);
    writer.markers(&mut body);
    let needs_format = writer.needs_format;
    let mut out = head(heading, findings);
    out.push_str("[scene]\n");
    key(&mut out, "name", &text(&Names::default().free(&model.name)));
    out.push_str("space = \"spatial\"\n");
    if needs_format {
        out.push_str("format = 2\n");
    }
    key(&mut out, "gravity", &vector(model.gravity));
    for (name, value) in ["tolerance", "angle_tolerance"]
        .iter()
        .zip(heading.tolerance)
    {
        if let Some(value) = value {
            key(&mut out, name, &number(value));
        }
    }
    out + &body
}

/// Returns the comments at the start of the scene: the source of the scene, and the omitted
/// content.
fn head(heading: &Heading, findings: &Findings) -> String {
    let (file, format) = heading.source;
    let mut out = String::new();
    comment(
        &mut out,
        "# ",
        &format!(
            "Imported from {file} ({format}) by pfaff {}.",
            env!("CARGO_PKG_VERSION")
        ),
    );
    for remark in &findings.remarks {
        comment(&mut out, "# ", remark);
    }
    if findings.omissions.is_empty() {
        comment(&mut out, "# ", "The whole file was converted.");
    } else {
        comment(&mut out, "# ", "Left out, with the lines of the file:");
    }
    for (kind, list) in by_kind(&findings.omissions) {
        comment(&mut out, "# - ", &format!("{kind}: {}", list.join(", ")));
    }
    out.push('\n');
    out
}

/// Omissions of each kind, in the order in which kinds were found.
pub(crate) fn by_kind(omissions: &[Omission]) -> Vec<(&'static str, Vec<String>)> {
    let mut kinds: Vec<(&'static str, Vec<String>)> = Vec::new();
    for omission in omissions {
        let place = match &omission.file {
            Some(file) => format!("line {} of {file}", omission.line),
            None => format!("line {}", omission.line),
        };
        let words = match omission.subject.as_str() {
            "" => place,
            subject => format!("{subject} ({place})"),
        };
        match kinds.iter_mut().find(|(kind, _)| *kind == omission.kind) {
            Some((_, list)) => list.push(words),
            None => kinds.push((omission.kind, vec![words])),
        }
    }
    kinds
}

/// Writes a comment and wraps it to lines. Characters that would end a comment are replaced.
fn comment(out: &mut String, lead: &str, words: &str) {
    let mut line = lead.to_owned();
    let mut is_empty = true;
    for word in words.split_whitespace() {
        let word: String = word
            .chars()
            .map(|c| if c.is_control() { '?' } else { c })
            .collect();
        if !is_empty && line.chars().count() + word.chars().count() >= WIDTH {
            out.push_str(&line);
            out.push('\n');
            line = format!("#{}", " ".repeat(lead.len() - 1));
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(&word);
        is_empty = false;
    }
    out.push_str(&line);
    out.push('\n');
}

struct Writer<'a> {
    model: &'a Model,
    findings: &'a mut Findings,
    /// Names of links and markers in the scene.
    links: Vec<String>,
    joints: Vec<String>,
    places: Names,
    elements: Names,
    needs_format: bool,
}

impl<'a> Writer<'a> {
    fn new(model: &'a Model, findings: &'a mut Findings) -> Self {
        let (mut places, mut elements) = (Names::default(), Names::default());
        let links = model
            .links
            .iter()
            .map(|link| places.take(&link.name, findings));
        let links = links.collect();
        let joints = model
            .joints
            .iter()
            .map(|joint| elements.take(&joint.name, findings));
        let joints = joints.collect();
        Self {
            model,
            findings,
            links,
            joints,
            places,
            elements,
            needs_format: false,
        }
    }

    fn link(&self, link: Option<usize>) -> &str {
        link.and_then(|link| self.links.get(link))
            .map_or("ground", String::as_str)
    }

    fn bodies(&self, heading: &Heading, out: &mut String) {
        for (k, link) in self.model.links.iter().enumerate() {
            table(out, "body", &self.links[k]);
            let mass = &link.mass;
            key(out, "mass", &number(mass.mass));
            let off = [(0, 1), (0, 2), (1, 2)];
            let inertia = if off.iter().all(|&at| mass.inertia[at] == 0.0) {
                vector(mass.inertia.diagonal())
            } else {
                let row = |k: usize| vector(mass.inertia.row(k).transpose());
                format!("[{}, {}, {}]", row(0), row(1), row(2))
            };
            key(out, "inertia", &inertia);
            if mass.centre != Vector3::zeros() {
                key(out, "centre", &vector(mass.centre));
            }
            let position = link.pose.translation.vector;
            if position != Vector3::zeros() {
                key(out, "position", &vector(position));
            }
            if link.pose.rotation != UnitQuaternion::identity() {
                key(out, "orientation", &orientation(link.pose.rotation));
            }
            if let Some((motions, moves)) = heading.start
                && let Some(motion) = motions.get(k)
            {
                let at = vector(motion.pose.translation.vector);
                let turned = orientation(motion.pose.rotation);
                key(
                    out,
                    "start",
                    &format!("{{ position = {at}, orientation = {turned} }}"),
                );
                if moves {
                    key(out, "velocity", &vector(motion.velocity));
                    key(out, "angular_velocity", &vector(motion.spin));
                }
            }
        }
    }

    fn joints(&mut self, out: &mut String) {
        for (k, joint) in self.model.joints.iter().enumerate() {
            let Some(kind) = joint.kind.name() else {
                continue;
            };
            let [first, second] = joint.links.map(|link| self.link(link).to_owned());
            let frames = joint.frames.map(|frames| self.ends(k, joint, frames, out));
            table(out, "joint", &self.joints[k]);
            key(out, "type", &text(kind));
            key(
                out,
                "bodies",
                &format!("[{}, {}]", text(&first), text(&second)),
            );
            if let Some([a, b]) = frames {
                key(out, "markers", &format!("[{}, {}]", text(&a), text(&b)));
            } else {
                let [a, b] = joint.points.map(vector);
                let points = format!("{{ {} = {a}, {} = {b} }}", text(&first), text(&second));
                key(out, "points", &points);
                match joint.kind {
                    JointKind::Spherical | JointKind::Fixed | JointKind::Free => {}
                    JointKind::Planar => key(out, "normal", &direction(joint.axes[0])),
                    JointKind::Universal => {
                        let [a, b] = joint.links.map(|link| self.model.pose(link).rotation);
                        key(out, "axis", &direction(joint.axes[0]));
                        key(out, "cross", &direction(a.inverse() * (b * joint.cross)));
                    }
                    _ => key(out, "axis", &direction(joint.axes[0])),
                }
            }
            if let JointKind::Screw(pitch) = joint.kind {
                key(out, "pitch", &number(pitch));
            }
            if let Some(value) = armature(joint) {
                key(out, "armature", &value);
            }
            if !joint.is_active {
                key(out, "active", "false");
            }
        }
    }

    /// Markers whose axes a joint aligns.
    fn ends(
        &mut self,
        k: usize,
        joint: &Joint,
        frames: [UnitQuaternion<f64>; 2],
        out: &mut String,
    ) -> [String; 2] {
        // For a slide, the joint axis is the z-axis of the marker.
        let own = match joint.kind {
            JointKind::Translational => along_z(frames[1].inverse() * joint.axes[1]),
            _ => UnitQuaternion::identity(),
        };
        [0, 1].map(|side| {
            let wanted = format!("{} {}", self.joints[k], ["first", "second"][side]);
            let name = self.places.free(&wanted);
            let pose = Isometry3::from_parts(joint.points[side].into(), frames[side] * own);
            self.marker(&name, joint.links[side], &pose, out);
            name
        })
    }

    fn marker(&self, name: &str, link: Option<usize>, pose: &Isometry3<f64>, out: &mut String) {
        table(out, "marker", name);
        key(out, "body", &text(self.link(link)));
        key(out, "point", &vector(pose.translation.vector));
        if pose.rotation != UnitQuaternion::identity() {
            key(out, "orientation", &orientation(pose.rotation));
        }
    }

    fn markers(&mut self, out: &mut String) {
        for frame in &self.model.frames {
            let name = self.places.take(&frame.name, self.findings);
            self.marker(&name, frame.link, &frame.pose, out);
        }
    }

    /// The joint coordinate of a coordinate, such as `joint.angle`.
    fn measure(&self, (joint, coordinate): (usize, usize)) -> String {
        let measures = self.model.joints[joint].kind.measures();
        let measure = measures.get(coordinate).unwrap_or(&"angle");
        format!("{}.{measure}", self.joints[joint])
    }

    /// The name of a coordinate. If several joints of the file were combined, it is the name of the
    /// original joint.
    fn coordinate(&self, joint: usize, coordinate: usize) -> &str {
        let of = &self.model.joints[joint];
        match of.names.get(coordinate) {
            Some(name) if *name != of.name => name,
            _ => &self.joints[joint],
        }
    }

    fn couplings(&mut self, out: &mut String) {
        for coupling in &self.model.couplings {
            let name = self.elements.take(&coupling.name, self.findings);
            let (joint, coordinate) = coupling.y;
            let Some(x) = coupling.x else {
                self.drive(&name, (joint, coordinate), out);
                key(out, "motion", "0");
                if !coupling.is_active {
                    key(out, "active", "false");
                }
                continue;
            };
            table(out, "joint", &name);
            key(out, "type", "\"coupling\"");
            let measures = [self.measure(x), self.measure(coupling.y)].map(|m| text(&m));
            key(out, "measures", &format!("[{}]", measures.join(", ")));
            key(
                out,
                "ratio",
                &number(coupling.coefficients.get(1).copied().unwrap_or(0.0)),
            );
            let more: Vec<f64> = coupling.coefficients.iter().skip(2).copied().collect();
            if more.iter().any(|c| *c != 0.0) {
                let more: Vec<String> = more.iter().map(|c| number(*c)).collect();
                key(out, "coefficients", &format!("[{}]", more.join(", ")));
            }
            if !coupling.is_active {
                key(out, "active", "false");
            }
        }
    }

    /// Writes a drive of a coordinate, without its motion or law. Returns the coordinate.
    fn drive(&self, name: &str, (joint, coordinate): (usize, usize), out: &mut String) -> &str {
        let measures = self.model.joints[joint].kind.measures();
        let measure = measures.get(coordinate).copied().unwrap_or("angle");
        table(out, "drive", name);
        key(out, "joint", &text(&self.joints[joint]));
        key(out, "type", &text(measure));
        measure
    }

    fn drives(&mut self, out: &mut String) {
        for drive in &self.model.drives {
            let name = self.elements.take(&drive.name, self.findings);
            let measure = self.drive(&name, drive.at, out);
            let load = match (drive.is_motion, measure) {
                (true, _) => "motion",
                (false, "displacement") => "force",
                (false, _) => "torque",
            };
            key(out, load, "0");
            self.needs_format |= !drive.is_motion;
        }
    }

    /// Springs and dampers of joints, and compensated weights.
    fn loads(&mut self, out: &mut String) {
        for (k, joint) in self.model.joints.iter().enumerate() {
            if !joint.is_active {
                continue;
            }
            for (coordinate, load) in joint.loads.iter().enumerate() {
                self.spring(k, coordinate, load, out);
            }
        }
        for (k, link) in self.model.links.iter().enumerate() {
            for held in HeldWeight::combined(&link.held) {
                let name = format!("held weight of {}", self.links[k]);
                table(out, "force", &self.elements.free(&name));
                key(out, "type", "\"point-force\"");
                key(out, "body", &text(&self.links[k]));
                key(out, "point", &vector(held.centre));
                let force = -self.model.gravity * held.mass;
                key(out, "force", &vector(force));
            }
        }
    }

    fn spring(&mut self, k: usize, coordinate: usize, load: &Load, out: &mut String) {
        let Load {
            stiffness,
            damping,
            reference,
            ..
        } = *load;
        if stiffness == 0.0 && damping == 0.0 {
            return;
        }
        let joint = &self.model.joints[k];
        let of = self.coordinate(k, coordinate).to_owned();
        let name = self.elements.free(&format!("{of} spring"));
        let of = |list: &[f64; 2]| list.get(coordinate).copied().unwrap_or(0.0);
        // A displacement is zero where the points of the joint coincide, an angle at the described
        // pose. The initial state does not determine the number of full revolutions of an angle, so
        // the full revolutions are added to the free angle of the spring.
        let turns = of(&joint.moved) / std::f64::consts::TAU;
        let free = match joint.kind.measures().get(coordinate) {
            Some(&"displacement") => reference - (of(&joint.zero) - of(&joint.described)),
            Some(_) => reference - of(&joint.zero) - turns.round() * std::f64::consts::TAU,
            None => reference,
        };
        let Some(measure) = joint.kind.measures().get(coordinate) else {
            let [first, second] = joint.links.map(|link| text(self.link(link)));
            let [a, b] = joint.points.map(vector);
            table(out, "force", &name);
            key(out, "type", "\"bushing\"");
            key(out, "bodies", &format!("[{first}, {second}]"));
            key(
                out,
                "points",
                &format!("{{ {first} = {a}, {second} = {b} }}"),
            );
            let of = number(stiffness);
            key(
                out,
                "stiffness",
                &format!("[0.0, 0.0, 0.0, {of}, {of}, {of}]"),
            );
            key(out, "damping", "[0.0, 0.0, 0.0, 0.0, 0.0, 0.0]");
            return;
        };
        if *measure == "displacement" {
            self.needs_format = true;
            self.drive(&name, (k, coordinate), out);
            key(out, "force", &text(&law(stiffness, damping, free)));
            return;
        }
        table(out, "force", &name);
        key(out, "type", "\"torsion-spring-damper\"");
        key(out, "joint", &text(&self.joints[k]));
        key(out, "measure", &text(measure));
        key(out, "stiffness", &number(stiffness));
        key(out, "damping", &number(damping));
        if stiffness != 0.0 {
            key(out, "free_angle", &number(free));
        }
    }
}

/// The armature of a joint. MuJoCo adds the armature of a coordinate to the diagonal of the mass
/// matrix, so its kinetic energy is ½·a·q̇².
fn armature(joint: &Joint) -> Option<String> {
    let measures = joint.kind.measures();
    let given = measures.iter().zip(&joint.loads);
    let given: Vec<(&str, String)> = given
        .filter(|(_, load)| load.armature != 0.0)
        .map(|(measure, load)| (*measure, number(load.armature)))
        .collect();
    let (_, first) = given.first()?;
    if measures.len() == 1 {
        return Some(first.clone());
    }
    let parts = given.iter().map(|(measure, a)| format!("{measure} = {a}"));
    Some(format!("{{ {} }}", parts.collect::<Vec<_>>().join(", ")))
}

/// The law of a spring with this free length, and of a damper.
fn law(stiffness: f64, damping: f64, free: f64) -> String {
    let sign = if free < 0.0 { '+' } else { '-' };
    let (k, c, free) = (number(stiffness), number(damping), number(free.abs()));
    match (stiffness != 0.0, damping != 0.0) {
        (true, false) => format!("-{k}*(measure {sign} {free})"),
        (false, _) => format!("-{c}*rate"),
        (true, true) => format!("-{k}*(measure {sign} {free}) - {c}*rate"),
    }
}

fn table(out: &mut String, kind: &str, name: &str) {
    let _ = write!(out, "\n[[{kind}]]\n");
    key(out, "name", &text(name));
}

fn key(out: &mut String, key: &str, value: &str) {
    let _ = writeln!(out, "{key} = {value}");
}

/// The number with the fewest digits that represent this double.
pub(crate) fn number(x: f64) -> String {
    if x == 0.0 {
        "0.0".to_owned()
    } else {
        format!("{x:?}")
    }
}

fn vector(v: Vector3<f64>) -> String {
    format!("[{}, {}, {}]", number(v.x), number(v.y), number(v.z))
}

/// Writes a direction. Components below the rounding error of the largest component are set to
/// zero.
fn direction(v: Vector3<f64>) -> String {
    let floor = 4.0 * f64::EPSILON * v.amax();
    vector(v.map(|x| if x.abs() < floor { 0.0 } else { x }))
}

fn orientation(q: UnitQuaternion<f64>) -> String {
    let numbers = [q.w, q.i, q.j, q.k].map(number);
    format!("{{ quaternion = [{}] }}", numbers.join(", "))
}

/// A text in TOML.
fn text(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04x}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_broken_into_lines() {
        let mut out = String::new();
        comment(&mut out, "# - ", &"words ".repeat(60));
        let lines: Vec<&str> = out.lines().collect();
        assert!(lines.len() > 3 && lines.iter().all(|line| line.len() <= WIDTH));
        assert!(lines[0].starts_with("# - words") && lines[1].starts_with("#   words"));
    }
}
