//! Imported robots have links with frames at their joints, massless bodies between the axes of a
//! hip, and rotors at the joints that they drive. If the robot is not at the origin and aligned,
//! zero distances become rounding errors. Such a lever arm must count as zero, so that each robot
//! moves and has the same rank at all positions and orientations.
//!
//! The rank is known in advance: a chain of joints without loops is never redundant, so the rank is
//! the number of rows. A closed loop of parallel axes has three rows that are redundant.
//!
//! With the variable `PFAFF_ROBOTS` each robot is tested at each position in each orientation: 10
//! 000 mechanisms instead of 1180.

use std::fmt::Write;

use model::System;
use pfaff::AssembledScene;
use pfaff::prelude::*;
use suite::numbers::Numbers;

/// Number of robots, of positions, and of orientations.
const ROBOTS: u64 = 10;
const PLACES: usize = 100;
const TURNS: usize = 10;

type Vector = [f64; 3];

/// A rotation of the world and a translation.
#[derive(Clone, Copy)]
struct World {
    axis: Vector,
    angle: f64,
    shift: Vector,
}

impl World {
    /// Rotates a direction by the formula of Rodrigues.
    fn turned(&self, v: Vector) -> Vector {
        let (n, (sin, cos)) = (self.axis, self.angle.sin_cos());
        let along: f64 = (0..3).map(|k| n[k] * v[k]).sum();
        let cross = [
            n[1] * v[2] - n[2] * v[1],
            n[2] * v[0] - n[0] * v[2],
            n[0] * v[1] - n[1] * v[0],
        ];
        [0, 1, 2].map(|k| cos * v[k] + sin * cross[k] + (1.0 - cos) * along * n[k])
    }

    fn place(&self, p: Vector) -> Vector {
        let turned = self.turned(p);
        [0, 1, 2].map(|k| turned[k] + self.shift[k])
    }
}

/// The text of a robot in a world, and the number of its redundant rows.
struct Robot {
    world: World,
    text: String,
    redundant: usize,
}

impl Robot {
    fn new(world: World) -> Self {
        let down = world.turned([0.0, 0.0, -9.81]);
        Self {
            text: format!("[scene]\nname = \"robot\"\nspace = \"spatial\"\ngravity = {down:?}\n"),
            world,
            redundant: 0,
        }
    }

    /// Adds a body whose frame is at a point; its centre of mass is elsewhere.
    fn body(&mut self, name: &str, at: Vector, (mass, inertia): (f64, f64), centre: Vector) {
        let World { axis, angle, .. } = self.world;
        let at = self.world.place(at);
        let _ = write!(
            self.text,
            "[[body]]\nname = {name:?}\nmass = {mass:?}\ninertia = {:?}\nposition = {at:?}\n\
             orientation = {{ axis = {axis:?}, angle = {angle:?} }}\ncentre = {centre:?}\n",
            [inertia, 1.5 * inertia, 1.25 * inertia]
        );
    }

    /// Adds a joint at a point of the world; `more` contains its directions.
    fn joint(
        &mut self,
        name: &str,
        kind: &str,
        bodies: [&str; 2],
        at: Vector,
        more: &[(&str, Vector)],
    ) {
        let at = self.world.place(at);
        let _ = write!(
            self.text,
            "[[joint]]\nname = {name:?}\ntype = {kind:?}\nbodies = {bodies:?}\nat = {at:?}\n"
        );
        for (key, direction) in more {
            let _ = writeln!(self.text, "{key} = {:?}", self.world.turned(*direction));
        }
        if !more.is_empty() {
            self.text.push_str("frame = \"global\"\n");
        }
    }

    fn coupling(&mut self, name: &str, measures: [&str; 2], ratio: f64) {
        let _ = write!(
            self.text,
            "[[joint]]\nname = {name:?}\ntype = \"coupling\"\nmeasures = {measures:?}\nratio = {ratio:?}\n"
        );
    }

    /// Adds a rotor at a joint with one axis, carried by a body and geared to the joint.
    fn rotor(&mut self, joint: &str, carrier: &str, at: Vector, axis: Vector, ratio: f64) {
        let [rotor, bearing] = [format!("{joint} rotor"), format!("{joint} bearing")];
        self.body(&rotor, at, (0.0, 1e-4), [0.0; 3]);
        self.joint(
            &bearing,
            "revolute",
            [carrier, &rotor],
            at,
            &[("axis", axis)],
        );
        let measures = [format!("{joint}.angle"), format!("{bearing}.angle")];
        let [of_joint, of_rotor] = [&measures[0], &measures[1]].map(String::as_str);
        self.coupling(&format!("{joint} gear"), [of_joint, of_rotor], ratio);
    }

    /// Adds a leg below a point of a body: a hip of three axes through one point, a knee, and a
    /// rotor in each joint with one axis. The hip has one of four forms.
    fn leg(&mut self, name: &str, base: &str, hip: Vector, way: u64, n: &mut Numbers) {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let of = |part: &str| format!("{name} {part}");
        let thigh = of("thigh");
        let inertia = (n.within(0.5, 5.0), n.within(0.01, 0.1));
        self.body(&thigh, hip, inertia, [0.0, 0.005, -0.17]);
        match way {
            0 => self.joint(&of("hip"), "spherical", [base, &thigh], hip, &[]),
            1 => {
                let between = of("between");
                self.body(&between, hip, (0.0, 0.0), [0.0; 3]);
                let cross = [("axis", x), ("cross", z)];
                self.joint(&of("hip xz"), "universal", [base, &between], hip, &cross);
                self.joint(
                    &of("hip y"),
                    "revolute",
                    [&between, &thigh],
                    hip,
                    &[("axis", y)],
                );
                self.rotor(&of("hip y"), &between, hip, y, 1.0);
            }
            2 => {
                let [first, second] = [of("first"), of("second")];
                self.body(&first, hip, (0.0, 0.0), [0.0; 3]);
                self.body(&second, hip, (0.0, 0.0), [0.0; 3]);
                self.joint(
                    &of("hip z"),
                    "revolute",
                    [base, &first],
                    hip,
                    &[("axis", z)],
                );
                self.joint(
                    &of("hip x"),
                    "revolute",
                    [&first, &second],
                    hip,
                    &[("axis", x)],
                );
                self.joint(
                    &of("hip y"),
                    "revolute",
                    [&second, &thigh],
                    hip,
                    &[("axis", y)],
                );
                self.rotor(&of("hip z"), base, hip, z, n.within(2.0, 100.0));
                self.rotor(&of("hip x"), "ground", hip, x, 1.0);
            }
            _ => {
                let cross = [("axis", x), ("cross", y)];
                self.joint(&of("hip"), "universal", [base, &thigh], hip, &cross);
            }
        }
        let knee = [hip[0], hip[1], hip[2] - n.within(0.2, 0.5)];
        let shank = of("shank");
        self.body(&shank, knee, (0.8, 0.01), [0.0, 0.0, -0.1]);
        self.joint(
            &of("knee"),
            "revolute",
            [&thigh, &shank],
            knee,
            &[("axis", y)],
        );
        self.rotor(&of("knee"), &thigh, knee, y, -9.0);
    }

    /// Adds a closed loop of parallel axes below a point: a parallelogram of three links.
    fn pantograph(&mut self, base: &str, at: Vector) {
        let y = [0.0, 1.0, 0.0];
        let along = |by: f64, down: f64| [at[0] + by, at[1], at[2] - down];
        for (name, from) in [("left", along(0.0, 0.0)), ("right", along(0.3, 0.0))] {
            self.body(name, from, (0.3, 0.002), [0.0, 0.0, -0.1]);
            self.joint(
                &format!("{name} top"),
                "revolute",
                [base, name],
                from,
                &[("axis", y)],
            );
        }
        self.body("foot", along(0.0, 0.2), (0.2, 0.001), [0.15, 0.0, 0.0]);
        self.joint(
            "left foot",
            "revolute",
            ["left", "foot"],
            along(0.0, 0.2),
            &[("axis", y)],
        );
        self.joint(
            "right foot",
            "revolute",
            ["right", "foot"],
            along(0.3, 0.2),
            &[("axis", y)],
        );
        self.redundant += 3;
    }
}

/// Returns robot k in a world: its random properties do not depend on the world.
fn robot(k: u64, world: World) -> Robot {
    let mut n = Numbers::new(7 + k);
    let mut robot = Robot::new(world);
    let base = [n.within(-0.1, 0.1), 0.0, n.within(0.8, 1.0)];
    robot.body("base", base, (6.6, 0.05), [-0.02, 0.0, 0.0]);
    // Every second robot is fixed to the ground.
    if k.is_multiple_of(2) {
        robot.joint("bolt", "fixed", ["ground", "base"], base, &[]);
    }
    for leg in 0..1 + k % 2 {
        let side = [-0.1, 0.1][leg as usize];
        let hip = [base[0], base[1] + side, base[2] - 0.04];
        robot.leg(
            &format!("leg {leg}"),
            "base",
            hip,
            (k / 2 + leg) % 4,
            &mut n,
        );
    }
    if k >= 6 {
        robot.pantograph("base", [base[0] + 0.2, base[1], base[2]]);
    }
    robot
}

/// Returns a rotation of the world: none, a quarter turn about its axes, or another one.
fn turn(k: usize, n: &mut Numbers) -> (Vector, f64) {
    let quarter = std::f64::consts::FRAC_PI_2;
    match k {
        0 => ([0.0, 0.0, 1.0], 0.0),
        1 => ([0.0, 0.0, 1.0], quarter),
        2 => ([0.0, 1.0, 0.0], quarter),
        3 => ([1.0, 0.0, 0.0], 2.0 * quarter),
        _ => {
            let axis = [0; 3].map(|_| n.within(-1.0, 1.0));
            let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            (axis.map(|x| x / length), n.within(-3.0, 3.0))
        }
    }
}

/// Returns a translation of the world: the origin, round numbers, or others up to 100 m away.
fn shift(k: usize, n: &mut Numbers) -> Vector {
    let far = 10_f64.powi(k as i32 % 4 - 1);
    match k {
        0 => [0.0; 3],
        1 => [1.0, -2.0, 0.5],
        _ => [0; 3].map(|_| far * n.within(-1.0, 1.0)),
    }
}

/// Returns the rank of a robot, or the reason why it does not move.
fn rank(robot: &Robot) -> Result<[usize; 2], String> {
    let scene = AssembledScene::read("robot.toml", &robot.text, &Registry::standard());
    let study = scene.and_then(|scene| scene.prepare(&RunOptions::default()));
    let prepared = study.map_err(|e| e.to_string())?.prepared;
    Ok([prepared.decision.rank, prepared.mechanism.layout().rows()])
}

#[test]
fn robots_move_wherever_they_stand_and_whichever_way_they_are_turned() {
    let mut n = Numbers::new(2026);
    let turns: Vec<_> = (0..TURNS).map(|k| turn(k, &mut n)).collect();
    let shifts: Vec<_> = (0..PLACES).map(|k| shift(k, &mut n)).collect();
    let is_whole = std::env::var_os("PFAFF_ROBOTS").is_some();
    let mut refused = Vec::new();
    for k in 0..ROBOTS {
        for (place, &shift) in shifts.iter().enumerate() {
            // Each position has one of the orientations, and the first positions have all of them.
            let is_asked = |turn: &usize| is_whole || place < 2 || place % TURNS == *turn;
            for turn in (0..TURNS).filter(is_asked) {
                let (axis, angle) = turns[turn];
                let robot = robot(k, World { axis, angle, shift });
                match rank(&robot) {
                    Ok([rank, rows]) if rank + robot.redundant == rows => {}
                    other => {
                        refused.push(format!("robot {k}, place {place}, turn {turn}: {other:?}"));
                    }
                }
            }
        }
    }
    assert!(
        refused.is_empty(),
        "{} refused:\n{}",
        refused.len(),
        refused.join("\n")
    );
}
