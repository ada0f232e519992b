//! A scene as text: tables of the format, written in sequence.

use std::fmt::Display;
use std::io::{self, Write};

/// The destination of a scene.
pub(super) struct SceneText<'w> {
    out: &'w mut dyn Write,
}

/// A body in the form of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BodyText {
    pub(super) mass: f64,
    pub(super) inertia: f64,
    pub(super) position: [f64; 2],
    pub(super) angle: f64,
    pub(super) velocity: [f64; 2],
    pub(super) angular_velocity: f64,
}

impl BodyText {
    /// Returns a thin uniform rod at rest between two points. Its inertia is m·L²/12, and its
    /// x-axis is along the rod.
    pub(super) fn rod(mass: f64, from: [f64; 2], to: [f64; 2]) -> Self {
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        Self {
            mass,
            inertia: mass * (x * x + y * y) / 12.0,
            position: super::points::middle(from, to),
            angle: y.atan2(x),
            ..Self::default()
        }
    }
}

impl<'w> SceneText<'w> {
    pub(super) fn new(out: &'w mut dyn Write) -> Self {
        Self { out }
    }

    /// Writes one line of a comment.
    pub(super) fn comment(&mut self, line: &str) -> io::Result<()> {
        writeln!(self.out, "# {line}")
    }

    /// Writes text unchanged.
    pub(super) fn raw(&mut self, text: &str) -> io::Result<()> {
        self.out.write_all(text.as_bytes())
    }

    /// Writes the displayed form of a value, unchanged.
    pub(super) fn display(&mut self, text: impl Display) -> io::Result<()> {
        write!(self.out, "{text}")
    }

    pub(super) fn scene(&mut self, name: &str, gravity: [f64; 2]) -> io::Result<()> {
        let [x, y] = gravity;
        writeln!(
            self.out,
            "\n[scene]\nname = \"{name}\"\nspace = \"plane\"\ngravity = [{x:?}, {y:?}]"
        )
    }

    /// Writes a body. Zeros that are the default of the format are omitted.
    pub(super) fn body(&mut self, name: impl Display, body: &BodyText) -> io::Result<()> {
        let BodyText {
            mass,
            inertia,
            position: [x, y],
            angle,
            velocity: [vx, vy],
            angular_velocity,
        } = *body;
        writeln!(
            self.out,
            "\n[[body]]\nname = \"{name}\"\nmass = {mass:?}\ninertia = {inertia:?}\nposition = [{x:?}, {y:?}]"
        )?;
        if angle != 0.0 {
            writeln!(self.out, "angle = {angle:?}")?;
        }
        if [vx, vy] != [0.0; 2] {
            writeln!(self.out, "velocity = [{vx:?}, {vy:?}]")?;
        }
        if angular_velocity != 0.0 {
            writeln!(self.out, "angular_velocity = {angular_velocity:?}")?;
        }
        Ok(())
    }

    /// Writes a revolute joint between two bodies at a global point.
    pub(super) fn revolute(
        &mut self,
        name: impl Display,
        bodies: [&dyn Display; 2],
        at: [f64; 2],
    ) -> io::Result<()> {
        let ([first, second], [x, y]) = (bodies, at);
        writeln!(
            self.out,
            "\n[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = [\"{first}\", \"{second}\"]\nat = [{x:?}, {y:?}]"
        )
    }

    /// Writes a translational joint at a global point, with its axis in the frame of the first
    /// body.
    pub(super) fn translational(
        &mut self,
        name: impl Display,
        bodies: [&dyn Display; 2],
        at: [f64; 2],
        axis: [f64; 2],
    ) -> io::Result<()> {
        let ([first, second], [x, y], [ax, ay]) = (bodies, at, axis);
        writeln!(
            self.out,
            "\n[[joint]]\nname = \"{name}\"\ntype = \"translational\"\nbodies = [\"{first}\", \"{second}\"]\n\
             at = [{x:?}, {y:?}]\naxis = [{ax:?}, {ay:?}]"
        )
    }

    /// Writes a knife edge at a global point, with its normal in the frame of the body.
    pub(super) fn knife_edge(
        &mut self,
        name: impl Display,
        body: impl Display,
        at: [f64; 2],
        normal: [f64; 2],
    ) -> io::Result<()> {
        let ([x, y], [nx, ny]) = (at, normal);
        writeln!(
            self.out,
            "\n[[joint]]\nname = \"{name}\"\ntype = \"knife-edge\"\nbody = \"{body}\"\nat = [{x:?}, {y:?}]\nnormal = [{nx:?}, {ny:?}]"
        )
    }

    /// Writes the duration of the run.
    pub(super) fn run_to(&mut self, t_end: f64) -> io::Result<()> {
        writeln!(self.out, "\n[simulate]\nt_end = {t_end:?}")
    }
}
