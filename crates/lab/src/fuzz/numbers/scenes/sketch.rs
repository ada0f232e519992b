//! A mechanism while it is written as the text of a scene. Submechanisms are drawn in a plane,
//! which is the plane of the scene or any plane in space.

use std::fmt::Write;

use crate::fuzz::scenes::Space;
use suite::numbers::Numbers;

/// A point or direction in the plane of a submechanism.
pub(super) type Flat = [f64; 2];

/// A body by its name, or the ground.
pub(super) type Side = String;

/// The ground.
pub(super) fn ground() -> Side {
    "ground".to_owned()
}

/// Position of the plane of a submechanism.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    origin: [f64; 3],
    /// The first and the second axis of the plane, and its normal.
    axes: [[f64; 3]; 3],
}

impl Place {
    fn point(&self, [x, y]: Flat, height: f64) -> [f64; 3] {
        let [u, v, n] = self.axes;
        std::array::from_fn(|k| self.origin[k] + x * u[k] + y * v[k] + height * n[k])
    }

    fn direction(&self, [x, y]: Flat) -> [f64; 3] {
        let [u, v, _] = self.axes;
        std::array::from_fn(|k| x * u[k] + y * v[k])
    }
}

/// The scene so far.
pub(super) struct Sketch<'n> {
    pub(super) space: Space,
    pub(super) numbers: &'n mut Numbers,
    text: String,
    bodies: usize,
    joints: usize,
    drives: usize,
    forces: usize,
    /// Joints that a drive may move: name and joint coordinate.
    pub(super) measured: Vec<(String, &'static str)>,
}

impl<'n> Sketch<'n> {
    pub(super) fn new(space: Space, numbers: &'n mut Numbers) -> Self {
        Self {
            space,
            numbers,
            text: String::new(),
            bodies: 0,
            joints: 0,
            drives: 0,
            forces: 0,
            measured: Vec::new(),
        }
    }

    /// Returns the text of all tables.
    pub(super) fn finish(self) -> String {
        self.text
    }

    pub(super) fn line(&mut self, key: &str, value: &str) {
        // Writing to a `String` cannot fail.
        let _ = writeln!(self.text, "{key} = {value}");
    }

    pub(super) fn table(&mut self, head: &str) {
        let _ = writeln!(self.text, "\n{head}");
    }

    /// Returns one of these values, chosen with equal probabilities.
    pub(super) fn one<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.numbers.below(from.len())]
    }

    /// Returns a length in steps of 5 cm.
    pub(super) fn length(&mut self, low: i32, high: i32) -> f64 {
        0.05 * f64::from(self.numbers.between(low, high))
    }

    /// Returns a unit vector, which in three of five cases is vertical, horizontal or diagonal.
    pub(super) fn heading(&mut self) -> Flat {
        match self.numbers.below(10) {
            0 | 1 => [0.0, 1.0],
            2 => [0.0, -1.0],
            3 => [1.0, 0.0],
            4 => [-1.0, 0.0],
            5 => [0.6, 0.8],
            _ => self.any_heading(),
        }
    }

    /// Returns a unit vector without symmetry.
    pub(super) fn any_heading(&mut self) -> Flat {
        let (sin, cos) = self.numbers.within(0.1, 6.1).sin_cos();
        [cos, sin]
    }

    /// Returns a plane for a submechanism: in a planar scene the plane of the scene, in space one
    /// of the coordinate planes or any plane.
    pub(super) fn place(&mut self) -> Place {
        let origin = [0, 1, 2].map(|_| self.numbers.below(3) as f64 * 0.25);
        if self.space == Space::Plane {
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            return Place {
                origin: [origin[0], origin[1], 0.0],
                axes,
            };
        }
        let axes = match self.numbers.below(4) {
            0 => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            1 => [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
            2 => [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
            _ => turned(self.numbers.within(0.0, 6.2), self.numbers.within(0.3, 2.8)),
        };
        Place { origin, axes }
    }

    /// Returns a point in the axes of the ground.
    pub(super) fn written(&self, p: [f64; 3]) -> String {
        match self.space {
            Space::Plane => format!("[{:?}, {:?}]", p[0], p[1]),
            Space::Space => format!("[{:?}, {:?}, {:?}]", p[0], p[1], p[2]),
        }
    }

    pub(super) fn point(&self, place: &Place, p: Flat) -> String {
        self.written(place.point(p, 0.0))
    }

    /// Adds a body with its mass centre at a point.
    pub(super) fn body(&mut self, place: &Place, centre: Flat) -> Side {
        self.moving_body(place, centre, None)
    }

    /// Adds a body that may have an angular velocity about the normal of the plane (rad/s).
    pub(super) fn moving_body(&mut self, place: &Place, centre: Flat, omega: Option<f64>) -> Side {
        let name = format!("b{}", self.bodies);
        self.bodies += 1;
        let mass = self.numbers.between(2, 40) as f64 / 10.0;
        let arm = self.numbers.within(0.1, 0.4);
        self.table("[[body]]");
        self.line("name", &format!("\"{name}\""));
        self.line("mass", &format!("{mass:?}"));
        let about = mass * arm * arm;
        match self.space {
            Space::Plane => self.line("inertia", &format!("{about:?}")),
            Space::Space => {
                let inertia = [about, 1.25 * about, 1.5 * about];
                self.line("inertia", &format!("{inertia:?}"));
            }
        }
        let at = self.point(place, centre);
        self.line("position", &at);
        if let Some(omega) = omega {
            self.turning(place, omega);
        }
        name
    }

    fn turning(&mut self, place: &Place, omega: f64) {
        let value = match self.space {
            Space::Plane => format!("{omega:?}"),
            Space::Space => self.written(place.axes[2].map(|n| n * omega)),
        };
        self.line("angular_velocity", &value);
    }

    /// Adds the velocities of the last body.
    pub(super) fn velocity(&mut self, place: &Place, v: Flat, omega: f64) {
        let value = self.written(place.direction(v));
        self.line("velocity", &value);
        self.turning(place, omega);
    }

    /// Adds a joint of two bodies, without its position.
    pub(super) fn joint(&mut self, kind: &str, [a, b]: [&Side; 2]) -> String {
        let name = self.head(kind);
        self.line("bodies", &format!("[\"{a}\", \"{b}\"]"));
        name
    }

    /// Adds a joint of one body, without its position.
    pub(super) fn single(&mut self, kind: &str, body: &Side) -> String {
        let name = self.head(kind);
        self.line("body", &format!("\"{body}\""));
        name
    }

    /// Adds a coupling of the angles of two joints, without its ratio.
    pub(super) fn coupling(&mut self, [a, b]: [&str; 2]) {
        self.head("coupling");
        self.line("measures", &format!("[\"{a}.angle\", \"{b}.angle\"]"));
    }

    fn head(&mut self, kind: &str) -> String {
        let name = format!("j{}", self.joints);
        self.joints += 1;
        self.table("[[joint]]");
        self.line("name", &format!("\"{name}\""));
        self.line("type", &format!("\"{kind}\""));
        name
    }

    /// Adds a key with a point at `height` above the plane of the submechanism.
    pub(super) fn at_height(&mut self, place: &Place, p: Flat, height: f64) {
        let at = self.written(place.point(p, height));
        self.line("at", &at);
    }

    /// Adds a key with a direction in the plane of the submechanism.
    pub(super) fn direction(&mut self, key: &str, place: &Place, d: Flat) {
        let value = self.written(place.direction(d));
        self.line(key, &value);
        self.in_ground_axes();
    }

    /// Adds a key with the normal of the plane of the submechanism.
    pub(super) fn normal(&mut self, key: &str, place: &Place) {
        let value = self.written(place.axes[2]);
        self.line(key, &value);
        self.in_ground_axes();
    }

    /// At the initial configuration, planar bodies have the axes of the ground.
    fn in_ground_axes(&mut self) {
        if self.space == Space::Space {
            self.line("frame", "\"global\"");
        }
    }

    /// Adds a massless bar between two points.
    pub(super) fn bar(&mut self, place: &Place, pair: [&Side; 2], [p, q]: [Flat; 2]) {
        self.joint("distance", pair);
        let ends = [p, q].map(|p| self.point(place, p));
        self.line("at", &format!("[{}, {}]", ends[0], ends[1]));
    }

    /// Adds a bar between two points, each at a height above the plane.
    pub(super) fn bar_in_space(&mut self, place: &Place, pair: [&Side; 2], ends: [(Flat, f64); 2]) {
        self.joint("distance", pair);
        let ends = ends.map(|(p, height)| self.written(place.point(p, height)));
        self.line("at", &format!("[{}, {}]", ends[0], ends[1]));
    }

    /// Adds a drive of a joint.
    pub(super) fn drive(&mut self, joint: &str, measure: &str, motion: &str) {
        let name = format!("d{}", self.drives);
        self.drives += 1;
        self.table("[[drive]]");
        self.line("name", &format!("\"{name}\""));
        self.line("joint", &format!("\"{joint}\""));
        self.line("type", &format!("\"{measure}\""));
        self.line("motion", motion);
    }

    /// Adds a spring between two points.
    pub(super) fn spring(&mut self, place: &Place, pair: [&Side; 2], [p, q]: [Flat; 2]) {
        let name = format!("f{}", self.forces);
        self.forces += 1;
        let stiffness = self.numbers.between(10, 400);
        let damping = self.numbers.below(5);
        self.table("[[force]]");
        self.line("name", &format!("\"{name}\""));
        self.line("type", "\"spring-damper\"");
        self.line("bodies", &format!("[\"{}\", \"{}\"]", pair[0], pair[1]));
        let ends = [p, q].map(|p| self.point(place, p));
        self.line("at", &format!("[{}, {}]", ends[0], ends[1]));
        self.line("stiffness", &format!("{stiffness}"));
        self.line("damping", &format!("{damping}"));
        self.line("free_length", "0.3");
    }
}

/// Returns axes that are rotated about z by the first angle, then about the new x-axis by the
/// second.
fn turned(first: f64, second: f64) -> [[f64; 3]; 3] {
    let ((s, c), (sin, cos)) = (first.sin_cos(), second.sin_cos());
    [
        [c, s, 0.0],
        [-s * cos, c * cos, sin],
        [s * sin, -c * sin, cos],
    ]
}

/// Returns `p + factor·d`.
pub(super) fn along([x, y]: Flat, factor: f64, d: Flat) -> Flat {
    [x + factor * d[0], y + factor * d[1]]
}

/// Returns the direction rotated by a quarter turn.
pub(super) fn across([x, y]: Flat) -> Flat {
    [-y, x]
}
