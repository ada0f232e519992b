//! Random scenes of several separate mechanisms, with and without redundant rows, drives, locked
//! parts and singular configurations, at any size and position.

use std::fmt::Write;

use tests::numbers::Numbers;

/// A body of a scene, with the velocities that the text states.
#[derive(Clone, Debug)]
pub(super) struct BodyText {
    pub(super) name: String,
    pub(super) mass: f64,
    pub(super) inertia: f64,
    pub(super) position: [f64; 2],
    pub(super) angle: f64,
    pub(super) velocity: Option<[f64; 2]>,
    pub(super) angular_velocity: Option<f64>,
}

/// A scene as text, with variable velocities.
#[derive(Clone, Debug, Default)]
pub(super) struct Sketch {
    pub(super) bodies: Vec<BodyText>,
    rest: String,
    /// Entries of the key `keep`.
    pub(super) keep: Vec<(usize, usize)>,
    /// Whether drives may contradict each other.
    pub(super) is_singular: bool,
    size: f64,
    origin: [f64; 2],
    count: usize,
}

/// Velocities of a body in `keep`.
pub(super) const NAMES: [&str; 3] = ["vx", "vy", "omega"];

impl Sketch {
    /// Draws one to three mechanisms.
    pub(super) fn random(numbers: &mut Numbers) -> Self {
        let size = 10_f64.powi(3 * numbers.between(-2, 2));
        let far = [0.0, 0.0, 100.0][numbers.below(3)] * size;
        let mut scene = Self {
            size,
            origin: [far * numbers.unit(), far * numbers.unit()],
            ..Self::default()
        };
        for _ in 0..=numbers.below(3) {
            match numbers.below(6) {
                0 => scene.four_bar(numbers),
                1 => scene.parallelogram(numbers),
                2 => scene.locked(numbers),
                3 => scene.chain(numbers),
                4 => scene.slide(numbers),
                _ => scene.cart(numbers),
            }
            scene.origin[0] += 8.0 * size;
        }
        scene
    }

    pub(super) fn text(&self) -> String {
        let mut text = "[scene]\nname = \"starts\"\nspace = \"plane\"\n".to_owned();
        for b in &self.bodies {
            let [x, y] = b.position;
            write!(
                text,
                "[[body]]\nname = \"{}\"\nmass = {:?}\ninertia = {:?}\nposition = [{x:?}, {y:?}]\nangle = {:?}\n",
                b.name, b.mass, b.inertia, b.angle
            )
            .expect("memory");
            if let Some([vx, vy]) = b.velocity {
                writeln!(text, "velocity = [{vx:?}, {vy:?}]").expect("memory");
            }
            if let Some(omega) = b.angular_velocity {
                writeln!(text, "angular_velocity = {omega:?}").expect("memory");
            }
        }
        text.push_str(&self.rest);
        let keep = self
            .keep
            .iter()
            .map(|&(body, dof)| format!("\"{}.{}\"", self.bodies[body].name, NAMES[dof]));
        write!(
            text,
            "[start]\nkeep = [{}]\n",
            keep.collect::<Vec<_>>().join(", ")
        )
        .expect("memory");
        text
    }

    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.origin[0] + self.size * x,
            self.origin[1] + self.size * y,
        ]
    }

    fn name(&mut self, kind: &str) -> String {
        self.count += 1;
        format!("{kind}{}", self.count)
    }

    /// Adds a bar between two points of the mechanism.
    fn bar(&mut self, numbers: &mut Numbers, from: [f64; 2], to: [f64; 2]) -> String {
        let name = self.name("bar");
        let middle = [0, 1].map(|k| 0.5 * (from[k] + to[k]));
        let mass = 10_f64.powf(numbers.unit());
        self.bodies.push(BodyText {
            name: name.clone(),
            mass,
            inertia: 0.2 * mass * self.size * self.size,
            position: self.at(middle),
            angle: (to[1] - from[1]).atan2(to[0] - from[0]),
            velocity: None,
            angular_velocity: None,
        });
        name
    }

    fn joint(&mut self, kind: &str, bodies: [&str; 2], place: [f64; 2], more: &str) -> String {
        let name = self.name("j");
        let [x, y] = self.at(place);
        let [i, j] = bodies;
        writeln!(
            self.rest,
            "[[joint]]\nname = \"{name}\"\ntype = \"{kind}\"\nbodies = [\"{i}\", \"{j}\"]\nat = [{x:?}, {y:?}]\n{more}"
        )
        .expect("memory");
        name
    }

    fn drive(&mut self, joint: &str, measure: &str, rate: f64) {
        let name = self.name("d");
        writeln!(
            self.rest,
            "[[drive]]\nname = \"{name}\"\njoint = \"{joint}\"\ntype = \"{measure}\"\nmotion = {{ type = \"constant-rate\", rate = {rate:?} }}"
        )
        .expect("memory");
    }

    /// Adds a linkage at any angle of its crank: driven, driven twice, or free.
    fn four_bar(&mut self, numbers: &mut Numbers) {
        let angle = 3.0 * numbers.unit();
        let (crank, coupler, rocker, frame) = (0.8, 2.4, 1.9, 2.1);
        let a = [crank * angle.cos(), crank * angle.sin()];
        let d = [frame - a[0], -a[1]];
        let r = d[0].hypot(d[1]);
        let along = (coupler * coupler - rocker * rocker + r * r) / (2.0 * r);
        let across = (coupler * coupler - along * along).sqrt();
        let b = [
            a[0] + (along * d[0] - across * d[1]) / r,
            a[1] + (along * d[1] + across * d[0]) / r,
        ];
        let bars = [([0.0, 0.0], a), (a, b), (b, [frame, 0.0])];
        let [i, j, k] = bars.map(|(from, to)| self.bar(numbers, from, to));
        let pivot = self.joint("revolute", ["ground", &i], [0.0, 0.0], "");
        self.joint("revolute", [&i, &j], a, "");
        self.joint("revolute", [&j, &k], b, "");
        let other = self.joint("revolute", [&k, "ground"], [frame, 0.0], "");
        if numbers.once_in(2) {
            self.drive(&pivot, "angle", numbers.unit());
            if numbers.once_in(3) {
                self.drive(&other, "angle", numbers.unit());
            }
        }
    }

    /// Adds two to four equal cranks under one coupler, sometimes in the singular configuration.
    fn parallelogram(&mut self, numbers: &mut Numbers) {
        let is_flat = numbers.once_in(6);
        self.is_singular |= is_flat;
        let angle: f64 = if is_flat { 0.0 } else { 1.5 + numbers.unit() };
        let tip = [0.5 * angle.cos(), 0.5 * angle.sin()];
        let n = 2 + numbers.below(3);
        let feet: Vec<f64> = (0..n).map(|k| 0.9 * k as f64).collect();
        let last = [feet[n - 1] + tip[0], tip[1]];
        let coupler = self.bar(numbers, tip, last);
        let mut first = None;
        for x in feet {
            let end = [x + tip[0], tip[1]];
            let crank = self.bar(numbers, [x, 0.0], end);
            let pivot = self.joint("revolute", ["ground", &crank], [x, 0.0], "");
            self.joint("revolute", [&crank, &coupler], end, "");
            first.get_or_insert(pivot);
        }
        if let Some(pivot) = first.filter(|_| numbers.once_in(3)) {
            self.drive(&pivot, "angle", numbers.unit());
        }
    }

    /// Adds a part that cannot move, locked by one joint or by two.
    fn locked(&mut self, numbers: &mut Numbers) {
        let bar = self.bar(numbers, [0.0, 0.0], [1.0, 0.3]);
        if numbers.once_in(2) {
            self.joint("fixed", ["ground", &bar], [0.2, 0.1], "");
        } else {
            self.joint("revolute", ["ground", &bar], [0.0, 0.0], "");
            self.joint("revolute", ["ground", &bar], [1.0, 0.3], "");
        }
    }

    /// Adds an open chain with some driven joints.
    fn chain(&mut self, numbers: &mut Numbers) {
        let mut before = "ground".to_owned();
        let mut at = [0.0, 0.0];
        for _ in 0..=numbers.below(4) {
            let angle = 3.0 * numbers.unit();
            let end = [at[0] + 0.7 * angle.cos(), at[1] + 0.7 * angle.sin()];
            let bar = self.bar(numbers, at, end);
            let pin = self.joint("revolute", [&before, &bar], at, "");
            if numbers.once_in(3) {
                self.drive(&pin, "angle", numbers.unit());
            }
            (before, at) = (bar, end);
        }
    }

    /// Adds a beam on one or two rails, with no drive, one drive, two consistent drives or two
    /// inconsistent drives.
    fn slide(&mut self, numbers: &mut Numbers) {
        let beam = self.bar(numbers, [0.0, -1.0], [0.0, 1.0]);
        let axis = "axis = [0.8, 0.6]";
        let mut rails = vec![self.joint("translational", ["ground", &beam], [0.0, 1.0], axis)];
        if numbers.once_in(2) {
            rails.push(self.joint("translational", ["ground", &beam], [0.0, -1.0], axis));
        }
        let rate = self.size * numbers.unit();
        match (numbers.below(4), rails.last()) {
            (1, Some(rail)) => {
                let rail = rail.clone();
                self.drive(&rail, "displacement", rate);
            }
            (which @ (2 | 3), Some(rail)) => {
                let rail = rail.clone();
                self.drive(&rails[0], "displacement", rate);
                self.drive(
                    &rail,
                    "displacement",
                    if which == 2 { rate } else { 2.0 * rate },
                );
            }
            _ => {}
        }
    }

    /// Adds a cart on two wheels of one axle that tows another cart.
    fn cart(&mut self, numbers: &mut Numbers) {
        let cart = self.bar(numbers, [0.0, 0.0], [1.0, 0.0]);
        let size = self.size;
        let mut edge = |body: &str, y: f64| {
            self.count += 1;
            writeln!(
                self.rest,
                "[[joint]]\nname = \"w{}\"\ntype = \"knife-edge\"\nbody = \"{body}\"\npoint = [{:?}, {:?}]\nnormal = [0.0, 1.0]",
                self.count,
                -0.4 * size,
                y * size
            )
            .expect("memory");
        };
        edge(&cart, 0.3);
        edge(&cart, -0.3);
        if numbers.once_in(2) {
            let angle = numbers.unit();
            let end = [1.0 + angle.cos(), angle.sin()];
            let trailer = self.bar(numbers, [1.0, 0.0], end);
            self.joint("revolute", [&cart, &trailer], [1.0, 0.0], "");
        }
    }
}
