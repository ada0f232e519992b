//! Random modules with known redundancy. Each module is mounted on a body of an earlier module or
//! on the ground.
//!
//! A module adds bodies and joints to one existing body, its base. The joints constrain the bodies
//! of the module relative to the base. The rows are invariant under rigid motions of module and
//! base together. Therefore a combination of rows that is zero on the bodies of the module is also
//! zero on the base. Hence C is block triangular, its redundancy is the sum of the redundancies of
//! the modules, and its self-stresses are the self-stresses of the modules.
//!
//! | module | bodies | rows | redundancy | not unique |
//! | --- | --- | --- | --- | --- |
//! | rod on a pin | 1 | 2 | 0 | |
//! | slider on a guide | 1 | 2 | 0 | |
//! | four-bar loop | 3 | 8 | 0 | |
//! | rod on a pin, doubled at the same point | 1 | 4 | 2 | both pins, in all directions |
//! | rod on two pins apart | 1 | 4 | 1 | both pins, along the line between them |
//! | slider on two parallel guides | 1 | 4 | 2 | both guides, across the axis, and their torques |
//! | parallelogram with three cranks | 4 | 12 | 1 | its six pins, along the cranks |
//! | cart with two wheels on one axle, on its own | 1 | 2 | 1 | both wheels, along the axle |

use std::io;

use super::answer::{Answer, Free, FreeReaction};
use super::family::Family;
use super::points::{direction, middle, step};
use super::text::{BodyText, SceneText};
use crate::numbers::Numbers;

pub(super) struct Random {
    n: usize,
    seed: u64,
    share: f64,
    answer: Answer,
}

/// A body on which later modules may be mounted.
#[derive(Clone, Copy)]
struct Place {
    /// Module of the body, and the name of the body in this module; `None` for the ground.
    body: Option<(usize, &'static str)>,
    at: [f64; 2],
    angle: f64,
}

const GROUND: Place = Place {
    body: None,
    at: [0.0; 2],
    angle: 0.0,
};

/// The kind of a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Build {
    Pin,
    Guide,
    FourBar,
    DoubledPin,
    TwoPins,
    TwoGuides,
    ThreeCranks,
    Cart,
}

const PLAIN: [Build; 3] = [Build::Pin, Build::Guide, Build::FourBar];

const REDUNDANT: [Build; 5] = [
    Build::DoubledPin,
    Build::TwoPins,
    Build::TwoGuides,
    Build::ThreeCranks,
    Build::Cart,
];

/// One module: its bodies, its joints, and the joint reactions that are not unique.
struct Module {
    number: usize,
    bodies: Vec<(&'static str, BodyText)>,
    joints: Vec<JointText>,
    rows: usize,
    redundancy: usize,
}

/// A joint of a module. Its first body is the base or a body of the module; its second body is a
/// body of the module.
struct JointText {
    name: &'static str,
    bodies: [Of; 2],
    at: [f64; 2],
    kind: JointKind,
    free: Option<Free>,
}

#[derive(Clone, Copy)]
enum Of {
    /// The body on which the module is mounted.
    Below,
    /// A body of the module.
    Own(&'static str),
}

#[derive(Clone, Copy)]
enum JointKind {
    Revolute,
    /// Axis in the frame of the first body.
    Translational([f64; 2]),
    /// Normal in the frame of the second body; the first body has no effect.
    KnifeEdge([f64; 2]),
}

impl Random {
    pub(super) fn new(n: usize, seed: u64, share: f64) -> Self {
        let mut random = Self {
            n,
            seed,
            share,
            answer: Answer::default(),
        };
        let (mut bodies, mut joints, mut rows, mut redundancy) = (0, 0, 0, 0);
        random
            .each(|_, module| {
                bodies += module.bodies.len();
                joints += module.joints.len();
                rows += module.rows;
                redundancy += module.redundancy;
                Ok(())
            })
            .unwrap_or_default();
        random.answer = Answer::new(bodies, joints, 0, rows, redundancy);
        random
    }

    /// Builds the modules in sequence, and calls `then` with each module and the body on which it
    /// is mounted.
    fn each(&self, mut then: impl FnMut(Place, &Module) -> io::Result<()>) -> io::Result<()> {
        let mut numbers = Numbers::new(self.seed);
        let mut places = vec![GROUND];
        for number in 0..self.n {
            let below = places[numbers.below(places.len())];
            let of = if numbers.within(0.0, 1.0) < self.share {
                &REDUNDANT[..]
            } else {
                &PLAIN[..]
            };
            let build = of[numbers.below(of.len())];
            let module = Module::new(number, build, below, &mut numbers);
            then(below, &module)?;
            places.extend(module.bodies.iter().map(|(name, body)| Place {
                body: Some((number, name)),
                at: body.position,
                angle: body.angle,
            }));
        }
        Ok(())
    }
}

impl Module {
    fn new(number: usize, build: Build, below: Place, numbers: &mut Numbers) -> Self {
        let mut module = Self {
            number,
            bodies: Vec::new(),
            joints: Vec::new(),
            rows: 0,
            redundancy: 0,
        };
        let mut near = |length: f64| numbers.within(-length, length);
        let at = [below.at[0] + near(0.5), below.at[1] + near(0.5)];
        let turned = numbers.within(0.0, std::f64::consts::TAU);
        let length = numbers.within(0.4, 1.0);
        match build {
            Build::Pin => module.rod(at, turned, length, &[("pin", at)], None),
            Build::DoubledPin => {
                let pins = [("pin", at), ("pin-again", at)];
                module.redundancy = 2;
                module.rod(at, turned, length, &pins, Some(Free::Force));
            }
            Build::TwoPins => {
                let line = direction(turned);
                let pins = [("pin-a", at), ("pin-b", step(at, 0.5 * length, line))];
                module.redundancy = 1;
                module.rod(at, turned, length, &pins, Some(Free::Along(line)));
            }
            Build::Guide => module.slider(at, turned, below, &[("guide", at)], None),
            Build::TwoGuides => {
                let other = [at[0] + 0.3, at[1] - 0.2];
                let guides = [("guide-a", at), ("guide-b", other)];
                let [x, y] = direction(turned);
                module.redundancy = 2;
                let free = Free::AlongAndTorque([-y, x]);
                module.slider(at, turned, below, &guides, Some(free));
            }
            Build::FourBar => module.four_bar(at, length, numbers),
            Build::ThreeCranks => {
                module.redundancy = 1;
                module.three_cranks(at, length, direction(numbers.within(0.5, 2.6)));
            }
            Build::Cart => {
                module.redundancy = 1;
                module.cart(at, turned);
            }
        }
        module
    }

    fn joint(
        &mut self,
        name: &'static str,
        bodies: [Of; 2],
        at: [f64; 2],
        kind: JointKind,
        free: Option<Free>,
    ) {
        self.rows += match kind {
            JointKind::Revolute | JointKind::Translational(_) => 2,
            JointKind::KnifeEdge(_) => 1,
        };
        self.joints.push(JointText {
            name,
            bodies,
            at,
            kind,
            free,
        });
    }

    /// Adds a rod of 1 kg/m from one point to another.
    fn bar(&mut self, name: &'static str, from: [f64; 2], to: [f64; 2]) {
        let mass = (to[0] - from[0]).hypot(to[1] - from[1]);
        self.bodies.push((name, BodyText::rod(mass, from, to)));
    }

    /// Adds one rod with pins along its length.
    fn rod(
        &mut self,
        at: [f64; 2],
        turned: f64,
        length: f64,
        pins: &[(&'static str, [f64; 2])],
        free: Option<Free>,
    ) {
        self.bar("rod", at, step(at, length, direction(turned)));
        for &(name, at) in pins {
            self.joint(
                name,
                [Of::Below, Of::Own("rod")],
                at,
                JointKind::Revolute,
                free,
            );
        }
    }

    /// Adds one block that slides on parallel guides.
    fn slider(
        &mut self,
        at: [f64; 2],
        turned: f64,
        below: Place,
        guides: &[(&'static str, [f64; 2])],
        free: Option<Free>,
    ) {
        let block = BodyText {
            mass: 0.6,
            inertia: 0.01,
            position: at,
            angle: turned,
            ..BodyText::default()
        };
        self.bodies.push(("slider", block));
        let kind = JointKind::Translational(direction(turned - below.angle));
        for &(name, at) in guides {
            self.joint(name, [Of::Below, Of::Own("slider")], at, kind, free);
        }
    }

    /// Adds two cranks that are one metre apart, and a rod between their tops. The three bars are
    /// never all in one line.
    fn four_bar(&mut self, at: [f64; 2], length: f64, numbers: &mut Numbers) {
        let other = [at[0] + 1.0, at[1]];
        let mut up = || direction(numbers.within(0.9, 2.2));
        let (top, other_top) = (step(at, length, up()), step(other, 0.7, up()));
        self.bar("crank-a", at, top);
        self.bar("crank-b", other, other_top);
        self.bar("coupler", top, other_top);
        let [a, b, coupler] = ["crank-a", "crank-b", "coupler"].map(Of::Own);
        let pin = JointKind::Revolute;
        self.joint("foot-a", [Of::Below, a], at, pin, None);
        self.joint("foot-b", [Of::Below, b], other, pin, None);
        self.joint("top-a", [a, coupler], top, pin, None);
        self.joint("top-b", [b, coupler], other_top, pin, None);
    }

    /// Adds three parallel cranks half a metre apart under a horizontal coupler.
    fn three_cranks(&mut self, at: [f64; 2], length: f64, up: [f64; 2]) {
        const CRANKS: [[&str; 3]; 3] = [
            ["crank-a", "foot-a", "top-a"],
            ["crank-b", "foot-b", "top-b"],
            ["crank-c", "foot-c", "top-c"],
        ];
        let free = Some(Free::Along(up));
        let foot = |k: usize| [at[0] + 0.5 * k as f64, at[1]];
        let tops = [0, 1, 2].map(|k| step(foot(k), length, up));
        for (k, [crank, ..]) in CRANKS.into_iter().enumerate() {
            self.bar(crank, foot(k), tops[k]);
        }
        self.bar("coupler", tops[0], tops[2]);
        for (k, [crank, low, top]) in CRANKS.into_iter().enumerate() {
            let (crank, pin) = (Of::Own(crank), JointKind::Revolute);
            self.joint(low, [Of::Below, crank], foot(k), pin, free);
            self.joint(top, [crank, Of::Own("coupler")], tops[k], pin, free);
        }
    }

    /// Adds a separate body on two wheels with a common axle.
    fn cart(&mut self, at: [f64; 2], turned: f64) {
        let [x, y] = direction(turned);
        let axle = [-y, x];
        let (left, right) = (step(at, 0.3, axle), step(at, -0.3, axle));
        let cart = BodyText {
            mass: 5.0,
            inertia: 0.4,
            position: middle(left, right),
            angle: turned,
            ..BodyText::default()
        };
        self.bodies.push(("cart", cart));
        for (name, at) in [("wheel-left", left), ("wheel-right", right)] {
            let (of, edge) = (Of::Own("cart"), JointKind::KnifeEdge([0.0, 1.0]));
            self.joint(name, [of, of], at, edge, Some(Free::Along(axle)));
        }
    }
}

impl Family for Random {
    fn answer(&self) -> Answer {
        self.answer
    }

    fn free_reactions(&self) -> Vec<FreeReaction> {
        let mut found = Vec::new();
        let listed = self.each(|_, module| {
            for joint in &module.joints {
                if let Some(free) = joint.free {
                    let name = format!("m{}.{}", module.number, joint.name);
                    found.push(FreeReaction::new(name, free));
                }
            }
            Ok(())
        });
        // No text is written, so no error can occur.
        listed.unwrap_or_default();
        found
    }

    fn words(&self) -> Vec<String> {
        vec![
            format!(
                "{} modules at random, each on an earlier body; seed {}, redundant share {:.3}.",
                self.n, self.seed, self.share
            ),
            "Not unique: doubled pins (pin, pin-again), two pins (pin-a, pin-b) along their line, two guides across".to_owned(),
            "their axis and in torque, the six pins of three cranks along the cranks, two wheels along their axle.".to_owned(),
        ]
    }

    fn write(&self, name: &str, scene: &mut SceneText) -> io::Result<()> {
        scene.scene(name, [0.0, -9.81])?;
        self.each(|_, module| {
            let m = module.number;
            for (name, body) in &module.bodies {
                scene.body(format_args!("m{m}.{name}"), body)?;
            }
            Ok(())
        })?;
        self.each(|below, module| module.write_joints(below, scene))?;
        scene.run_to(1.0)
    }
}

impl Module {
    fn write_joints(&self, below: Place, scene: &mut SceneText) -> io::Result<()> {
        let m = self.number;
        let below = match below.body {
            None => "ground".to_owned(),
            Some((module, body)) => format!("m{module}.{body}"),
        };
        let of = |body: Of| match body {
            Of::Below => below.clone(),
            Of::Own(name) => format!("m{m}.{name}"),
        };
        for joint in &self.joints {
            let name = format_args!("m{m}.{}", joint.name);
            let [first, second] = joint.bodies.map(of);
            match joint.kind {
                JointKind::Revolute => scene.revolute(name, [&first, &second], joint.at),
                JointKind::Translational(axis) => {
                    scene.translational(name, [&first, &second], joint.at, axis)
                }
                JointKind::KnifeEdge(normal) => scene.knife_edge(name, &second, joint.at, normal),
            }?;
        }
        Ok(())
    }
}
