//! Scenes of the plane, converted to space. The bodies can leave the plane unless joints prevent
//! it, and some joints get additional rows that constrain bodies to the plane.
//!
//! The graph of these joints has the ground as a node and L independent cycles. The redundancy
//! increases by 3·L. The mobility increases by 3 for each component of the graph without the
//! ground. The verdicts on in-plane components do not change. The out-of-plane components (Fz, Tx,
//! Ty) of a joint are not unique if and only if the joint is on a cycle. This rule follows from the
//! graph alone, without elimination.
//!
//! | in the plane | in space |
//! | --- | --- |
//! | revolute, translational, fixed | the same joint about z, or along the line |
//! | pin-in-slot | `planar`, and a `point-on-plane` with its normal perpendicular to the slot |
//! | point-on-line | `point-on-plane` with its normal perpendicular to the line |
//! | distance, knife-edge, velocity | the same joint: one row in the plane |
//! | drives of angles, displacements | the same drives |
//! | gravity, velocities of bodies | the same values |
//!
//! All other elements are omitted. Omitted joints and drives are listed by name; forces of all
//! kinds are omitted.

use joints::space3::{
    Axes, Direction, Distance, Fixed, KnifeEdge, Planar, PointOnPlane, Revolute,
    RevoluteAngleDrive, Translational, TranslationalDisplacementDrive, Velocity,
};
use model::start::assemble;
use model::{
    AnyDescription, BodyRef, ConstraintKernels, Description, Mechanism, Registry, SpatialBody,
    SpatialDescription, StartOptions,
};
use pfaff::AssembledScene;
use serde_json::Value;

use super::graph::Graph;
use crate::fuzz::exact;
use crate::fuzz::exact::answer::answer_of;
use crate::fuzz::exact::families::Family;
use crate::fuzz::exact::findings::{Findings, Kind, list};
use crate::fuzz::exact::outcome::{JudgedStart, Outcome, judged};
use crate::fuzz::exact::pose::Writing;

/// Suffix that is added to the name of a pin-in-slot joint to form the name of the
/// `point-on-plane`.
const SLOT: &str = " slot";

/// A planar scene with its equivalent in space.
pub struct Lifted {
    /// The part of the scene that can be converted.
    pub plane: Description,
    /// The equivalent in space.
    pub space: SpatialDescription,
    /// Names of joints and drives that are omitted.
    pub left_out: Vec<String>,
}

impl Lifted {
    /// Returns the answers in the plane and in space.
    ///
    /// # Errors
    /// Returns the message if one of the two scenes is rejected.
    pub fn answers(&self) -> Result<[Value; 2], String> {
        Ok([
            answer_of(|| AssembledScene::build(self.plane.clone()))?,
            answer_of(|| AssembledScene::build(self.space.clone()))?,
        ])
    }

    /// Returns the graph of the joints that keep bodies in the plane; the last node is the ground.
    #[must_use]
    pub fn graph(&self) -> Graph {
        let ground = self.plane.bodies.len();
        let node = |body: &BodyRef| body.moving().unwrap_or(ground);
        let is_flat = |joint: &&model::Joint| {
            let name = joint.element.spec().common.name;
            ["Revolute", "Translational", "Fixed", "PinInSlot"].contains(&name)
        };
        let flat = self.plane.joints.iter().filter(is_flat);
        Graph {
            nodes: ground + 1,
            edges: flat
                .map(|j| (j.name.clone(), [node(&j.bodies[0]), node(&j.bodies[1])]))
                .collect(),
        }
    }
}

/// Converts a planar description, at its consistent initial state.
///
/// # Errors
/// Returns the message if no consistent initial state exists.
pub fn lift(description: &Description, start: &StartOptions) -> Result<Lifted, String> {
    let mut mechanism = Mechanism::build(description).map_err(|faults| format!("{faults:?}"))?;
    let start = assemble(&mut mechanism, start).map_err(|e| e.to_string())?;
    let mut plane = Description {
        joints: Vec::new(),
        drives: Vec::new(),
        forces: Vec::new(),
        ..description.clone()
    };
    let mut lift = Lift {
        angles: start.q.chunks_exact(3).map(|q| q[2]).collect(),
        space: SpatialDescription::new(&description.name),
    };
    lift.space.tolerance = description.tolerance;
    let [gx, gy] = description.gravity;
    lift.space.gravity = [gx, gy, 0.0];
    for (body, q) in plane.bodies.iter_mut().zip(start.q.chunks_exact(3)) {
        let (sin, cos) = q[2].sin_cos();
        let [x, y] = body.centre;
        body.position = [q[0] - cos * x + sin * y, q[1] - sin * x - cos * y];
        body.angle = q[2];
        let j = body.inertia;
        let tensor = [[0.5 * j, 0.0, 0.0], [0.0, 0.5 * j, 0.0], [0.0, 0.0, j]];
        let (sin, cos) = (0.5 * q[2]).sin_cos();
        lift.space.body(SpatialBody {
            centre: [x, y, 0.0],
            position: [body.position[0], body.position[1], 0.0],
            orientation: [cos, 0.0, 0.0, sin],
            velocity: body.velocity.map(|[vx, vy]| [vx, vy, 0.0]),
            angular_velocity: body.angular_velocity.map(|omega| [0.0, 0.0, omega]),
            tolerance: body.tolerance,
            ..SpatialBody::new(&body.name, body.mass, tensor)
        });
    }
    let mut left_out = Vec::new();
    for joint in &description.joints {
        let found = Numbers::of(&*joint.element);
        let first = lift.space.joints.len();
        match lift.joint(&plane, joint, &found) {
            Some(()) => plane.joints.push(joint.clone()),
            None => left_out.push(joint.name.clone()),
        }
        for lifted in &mut lift.space.joints[first..] {
            lifted.tolerance = joint.tolerance;
        }
    }
    for drive in &description.drives {
        let found = Numbers::of(&*drive.element);
        match lift.drive(drive, &found) {
            Some(()) => plane.drives.push(drive.clone()),
            None => left_out.push(drive.name.clone()),
        }
    }
    Ok(Lifted {
        plane,
        space: lift.space,
        left_out,
    })
}

/// The values of an element, by name.
struct Numbers {
    name: &'static str,
    data: Vec<(&'static str, Vec<f64>)>,
}

impl Numbers {
    fn of(element: &dyn ConstraintKernels) -> Self {
        let spec = element.spec();
        let mut numbers = vec![0.0; spec.n_data()];
        element.data(&mut numbers);
        let data = spec.data.iter();
        Self {
            name: spec.common.name,
            data: data
                .map(|datum| (datum.name, numbers[datum.numbers()].to_vec()))
                .collect(),
        }
    }

    fn get(&self, name: &str) -> Option<&[f64]> {
        let found = self.data.iter().find(|(own, _)| *own == name);
        found.map(|(_, numbers)| numbers.as_slice())
    }

    /// Returns a point or direction, in the plane z = 0.
    fn vector(&self, name: &str) -> Option<[f64; 3]> {
        match *self.get(name)? {
            [x, y] => Some([x, y, 0.0]),
            _ => None,
        }
    }
}

struct Lift {
    angles: Vec<f64>,
    space: SpatialDescription,
}

impl Lift {
    fn angle(&self, body: BodyRef) -> f64 {
        body.moving().map_or(0.0, |k| self.angles[k])
    }

    /// Converts axes from the frame of the first body to the frame of the second body.
    fn carried(&self, [i, j]: [BodyRef; 2], axes: Axes) -> Axes {
        let (sin, cos) = (self.angle(i) - self.angle(j)).sin_cos();
        axes.map(|[x, y, z]| [cos * x - sin * y, sin * x + cos * y, z])
    }

    fn joint(&mut self, plane: &Description, joint: &model::Joint, found: &Numbers) -> Option<()> {
        let name = joint.name.as_str();
        if let [body] = joint.bodies[..] {
            return self.joint_of_one(plane, joint, body, found);
        }
        let &[i, j] = joint.bodies.as_slice() else {
            return None;
        };
        let (s_i, s_j) = (found.vector("s_i")?, found.vector("s_j")?);
        let frames = [Axes::FRAME, self.carried([i, j], Axes::FRAME)];
        match found.name {
            "Revolute" => {
                let [axis, axis_j] = frames;
                let element = Revolute {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                };
                self.space.joint(name, &[i, j], element);
            }
            "Fixed" => {
                // The points of the two bodies may be different in the plane.
                let there = plane.place_of(i, s_i);
                let s_j = self.space.local(j, there);
                let [axes, axes_j] = frames;
                let element = Fixed {
                    s_i,
                    s_j,
                    axes,
                    axes_j,
                };
                self.space.joint(name, &[i, j], element);
            }
            "Translational" => {
                let axis = Axes::new(found.vector("axis")?, Some([0.0, 0.0, 1.0]))?;
                let axis_j = self.carried([i, j], axis);
                let element = Translational {
                    s_i,
                    s_j,
                    axis,
                    axis_j,
                };
                self.space.joint(name, &[i, j], element);
            }
            "PinInSlot" => {
                let [x, y, _] = found.vector("axis")?;
                let [normal, normal_j] = frames;
                let element = Planar {
                    s_i,
                    s_j,
                    normal,
                    normal_j,
                };
                self.space.joint(name, &[i, j], element);
                let normal = Direction::new([-y, x, 0.0])?;
                let element = PointOnPlane { s_i, s_j, normal };
                self.space.joint(&format!("{name}{SLOT}"), &[i, j], element);
            }
            "Distance" => {
                let element = Distance::new(s_i, s_j);
                self.space.joint(name, &[i, j], element);
            }
            _ => return None,
        }
        Some(())
    }

    fn joint_of_one(
        &mut self,
        plane: &Description,
        joint: &model::Joint,
        body: BodyRef,
        found: &Numbers,
    ) -> Option<()> {
        let (name, s) = (joint.name.as_str(), found.vector("s")?);
        match found.name {
            "PointOnLine" => {
                let &[_, _, x, y] = found.get("line")? else {
                    return None;
                };
                // The reference point of the reaction is the point of the joint.
                let s_i = plane.place_of(body, s);
                let normal = Direction::new([-y, x, 0.0])?;
                let element = PointOnPlane {
                    s_i,
                    s_j: s,
                    normal,
                };
                self.space.joint(name, &[BodyRef::Ground, body], element);
            }
            "KnifeEdge" => {
                let normal = Direction::new(found.vector("normal")?)?;
                self.space.joint(name, &[body], KnifeEdge { s, normal });
            }
            "Velocity" => {
                let direction = Direction::new(found.vector("direction")?)?;
                let lifted = self.space.joint(name, &[body], Velocity { s, direction });
                lifted.functions = joint.functions.clone();
            }
            _ => return None,
        }
        Some(())
    }

    fn drive(&mut self, drive: &model::Drive, found: &Numbers) -> Option<()> {
        let &[i, j] = drive.bodies.as_slice() else {
            return None;
        };
        let (name, motion) = (drive.name.as_str(), drive.motion.clone());
        let (s_i, s_j) = (found.vector("s_i")?, found.vector("s_j")?);
        match found.name {
            "RevoluteAngleDrive" => {
                let element = RevoluteAngleDrive::new(
                    s_i,
                    s_j,
                    Axes::FRAME,
                    self.carried([i, j], Axes::FRAME),
                );
                self.space.drive(name, &[i, j], element, motion);
            }
            "TranslationalDisplacementDrive" => {
                let axis = Axes::new(found.vector("axis")?, Some([0.0, 0.0, 1.0]))?;
                let element =
                    TranslationalDisplacementDrive::new(s_i, s_j, axis, self.carried([i, j], axis));
                self.space.drive(name, &[i, j], element, motion);
            }
            _ => return None,
        }
        Some(())
    }
}

/// Computes the position of a point of a body at the described initial state.
trait Placed {
    fn place_of(&self, body: BodyRef, point: [f64; 3]) -> [f64; 3];
}

impl Placed for Description {
    fn place_of(&self, body: BodyRef, [x, y, _]: [f64; 3]) -> [f64; 3] {
        let body = body.moving().and_then(|k| self.bodies.get(k));
        let [x, y] = body.map_or([x, y], |body| body.pose().to_global([x, y]));
        [x, y, 0.0]
    }
}

/// Compares both answers. The answer in space must follow from the planar answer and the rule of
/// this module.
#[must_use]
pub fn compared(lifted: &Lifted, plane: &Value, space: &Value) -> Findings {
    let mut findings = Findings::default();
    for (what, document) in [("plane", plane), ("space", space)] {
        if document["evidence"]["status"] != "decided" {
            findings.note(Kind::Undecided, format!("rank in the {what}"));
            return findings;
        }
    }
    let graph = lifted.graph();
    let number = |key: &str| plane[key].as_u64().unwrap_or(0) as usize;
    let (cycles, loose) = (graph.cycle_rank(), graph.components() - 1);
    for (key, right) in [
        ("rows", number("rows") + 3 * graph.edges.len()),
        ("redundancy", number("redundancy") + 3 * cycles),
        ("mobility", number("mobility") + 3 * loose),
    ] {
        findings.number(Kind::Rank, key, &space[key], right);
    }
    for reaction in list(&plane["reactions"]) {
        let name = reaction["name"].as_str().unwrap_or_default();
        let on_cycle = graph.is_on_cycle(name);
        let slot = format!("{name}{SLOT}");
        let has_slot = lifted.space.joints.iter().any(|j| j.name == slot);
        let in_plane = if has_slot { &slot } else { name };
        for (name, is_own) in [(in_plane, true), (name, !has_slot)] {
            reaction_in_space(
                name,
                is_own.then_some(reaction),
                on_cycle,
                space,
                &mut findings,
            );
        }
    }
    findings
}

/// Compares the verdicts on one reaction. Verdicts on in-plane components must be the same as in
/// the planar answer, and verdicts on out-of-plane components must follow from the graph.
fn reaction_in_space(
    name: &str,
    own: Option<&Value>,
    on_cycle: Option<bool>,
    space: &Value,
    findings: &mut Findings,
) {
    let mut all = list(&space["reactions"]).iter();
    let Some(told) = all.find(|r| r["name"] == name) else {
        findings.note(Kind::Verdict, format!("{name} has no verdict"));
        return;
    };
    let planar = own.map_or(&Value::Null, |own| &own["components"]);
    for component in list(&told["components"]) {
        let axis = component["name"].as_str().unwrap_or_default();
        let what = format!("{name}.{axis}");
        let in_plane = match axis {
            "Fx" | "Fy" => axis,
            "Tz" => "T",
            _ => {
                let is_free = on_cycle == Some(true) && !name.ends_with(SLOT);
                findings.verdict(&what, &component["verdict"], !is_free);
                continue;
            }
        };
        let right = list(planar).iter().find(|c| c["name"] == in_plane);
        // A component that does not exist is zero.
        match right.map_or(Some("unique"), |c| c["verdict"].as_str()) {
            Some("undecided") => findings.note(Kind::Undecided, what),
            right => findings.verdict(&what, &component["verdict"], right == Some("unique")),
        }
    }
}

/// Converts a text and compares the answers; `None` if no part of the scene can be converted.
///
/// # Errors
/// Returns an error if the text is not a scene with a consistent initial state.
pub fn examine(text: &str) -> Result<Option<(Lifted, JudgedStart)>, String> {
    let read = AssembledScene::read("scene.toml", text, &Registry::standard());
    let scene = read.map_err(|e| e.to_string())?.scene;
    let AnyDescription::Plane(description) = &scene.description else {
        return Ok(None);
    };
    let lifted = lift(description, &scene.start)?;
    if lifted.plane.joints.is_empty() {
        return Ok(None);
    }
    let documents = || {
        let [plane, space] = lifted.answers()?;
        Ok(serde_json::json!([plane, space]))
    };
    let judged = judged(documents, |both: &Value| {
        let findings = compared(&lifted, &both[0], &both[1]);
        JudgedStart {
            findings,
            rank: both[1]["rank"].as_u64(),
            other_rank: None,
        }
    });
    Ok(Some((lifted, judged)))
}

/// Tests one scene of the plane. Gears and racks are omitted, because they cannot be converted.
#[must_use]
pub fn outcome(seed: u64, number: u64) -> Outcome {
    let ways = Writing::ALL.len() as u64;
    let (all, gears) = (Family::ALL.len() as u64, Family::Gears as u64);
    let (drawn, way) = (number / ways, number % ways);
    let (round, family) = (drawn / (all - 1), drawn % (all - 1));
    let family = family + u64::from(family >= gears);
    let scene = exact::scene(seed, ways * (all * round + family) + way);
    let text = exact::text::text(&scene.posed);
    let mut outcome = Outcome {
        family: scene.family.name(),
        way: scene.writing as usize,
        text,
        judged: JudgedStart::default(),
        truth: "nothing can be lifted".to_owned(),
        is_redundant: false,
        must_be_decided: scene.writing != Writing::Far,
    };
    match examine(&outcome.text) {
        Ok(None) => {}
        Ok(Some((lifted, judged))) => {
            let graph = lifted.graph();
            outcome.truth = format!(
                "{} flat joints, {} cycles, left out {:?}",
                graph.edges.len(),
                graph.cycle_rank(),
                lifted.left_out
            );
            outcome.is_redundant = graph.cycle_rank() > 0;
            outcome.judged = judged;
        }
        Err(refusal) => outcome.judged.findings.note(Kind::Refused, refusal),
    }
    outcome
}
