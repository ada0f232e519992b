//! Checks that need the whole mechanism. They find moments of inertia that contradict mass and
//! size, bodies without a joint, distant joints, and wheels that do not turn on the carrier of
//! their mesh.

use std::collections::HashMap;

use model::codes::Code;
use model::reaction::ConstraintGroup;
use model::space::norm;
use model::words::{quantity, rounded};
use model::{BodyRecord, BodyRef, ConstraintId, DescribedBody, Mechanism, SpaceKind, System};

use crate::findings::Findings;
use crate::language::LengthUnit;
use crate::source_map::{BODY_KEYS, Entry, PLACE_KEYS, SourceMap};

/// Largest plausible radius of gyration, as a multiple of the arms of the body. If all mass is
/// within an arm, the ratio is at most 1. It is about 5 for a flywheel on a small crank, and 58 if
/// the inertia of a rod in kg·cm² is read as kg·m².
const LARGEST_GYRATION: f64 = 20.0;

/// Smallest plausible radius of gyration, as a multiple of the arms of the body. The ratio is 0.6
/// for a rod and 0.01 for a small bob on a light rod. It is 0.0006 if the inertia of a rod in kg·m²
/// is read as kg·mm².
const SMALLEST_GYRATION: f64 = 1e-3;

/// Density (kg/m³) above which a body does not consist of any real material. The density of a body
/// is the density of a ball with the same mass and inertia. The density of osmium is 2.3e4. If the
/// inertia of a wheel in kg·m² is read as kg·mm², a density of 1e2 becomes 1e11. A point mass of 1
/// kg with a nominal inertia of 1e-6 kg·m² has a density of 6e7.
const DENSEST: f64 = 1e9;

/// Fraction of the size of the mechanism below which the radius of gyration of a body is small.
const SMALL: f64 = 1e-2;

/// Density of steel (kg/m³).
const STEEL: f64 = 7850.0;

/// Largest plausible distance from the centre of mass of a body to one of its joints, as a multiple
/// of the size of the mechanism. Lengths in cm that are read as m are 100 times too large; the
/// longest parts of a machine are about ten times as long as the median.
const FARTHEST: f64 = 100.0;

/// Points of a body at a distance below this fraction of the size count as one point. Coordinates
/// with six digits differ by 1e-6; centres of wheels are at least a tooth apart.
const AT_ONE_PLACE: f64 = 1e-4;

/// Warns about implausible values of a mechanism.
pub(crate) fn check(mechanism: &Mechanism, map: &SourceMap, unit: LengthUnit, findings: &Findings) {
    let records = mechanism.bodies();
    let joints = joints(mechanism, map);
    let bodies = bodies(mechanism, &joints);
    let size = size(records, &bodies);
    unheld(records, &bodies, map, findings);
    far(records, &joints, size, unit, findings);
    carriers(records, &joints, size, findings);
    inertia(records, &bodies, map, size, unit, findings);
}

/// A joint with its points; a drive has the points of its joint.
struct JointPoints<'m> {
    group: &'m ConstraintGroup,
    /// The table of the joint.
    entry: Option<&'m Entry>,
    points: Vec<(BodyRef, [f64; 3])>,
}

fn joints<'m>(mechanism: &'m Mechanism, map: &'m SourceMap) -> Vec<JointPoints<'m>> {
    let entries = map.joints.iter().filter(|entry| entry.is_active);
    let entries: HashMap<&str, &Entry> = entries.map(|e| (e.name.as_str(), e)).collect();
    let groups = mechanism.layout().groups.iter().enumerate();
    let joints = groups.filter(|(_, group)| !group.is_drive());
    joints
        .map(|(k, group)| JointPoints {
            group,
            entry: entries.get(group.name.as_str()).copied(),
            points: mechanism.points(ConstraintId(k)),
        })
        .collect()
}

/// Points and forces on a body.
#[derive(Clone, Default)]
struct BodyShape {
    /// Points of joints, forces and markers relative to the centre of mass.
    points: Vec<[f64; 3]>,
    is_held: bool,
    /// Number of forces that act on the body.
    forces: usize,
}

impl JointPoints<'_> {
    /// Whether this is a planar joint of this type.
    fn is_planar(&self, kind: &str) -> bool {
        self.group.space == SpaceKind::Plane && self.group.spec.common.scene_type == kind
    }
}

impl BodyShape {
    fn arms(&self) -> impl Iterator<Item = f64> {
        self.points.iter().map(|point| norm(point))
    }

    /// Returns whether not all points coincide.
    fn has_extent(&self) -> bool {
        self.points.windows(2).any(|pair| pair[0] != pair[1])
    }
}

fn bodies(mechanism: &Mechanism, joints: &[JointPoints]) -> Vec<BodyShape> {
    let records = mechanism.bodies();
    let mut bodies = vec![BodyShape::default(); records.len()];
    let mut add = |points: &[(BodyRef, [f64; 3])]| {
        for (body, point) in points {
            if let BodyRef::Body(k) = body {
                bodies[*k].points.push(*point);
            }
        }
    };
    joints.iter().for_each(|joint| add(&joint.points));
    for marker in &mechanism.frames().observed().markers {
        add(&[(marker.body, marker.from_centre(records))]);
    }
    let forces: Vec<_> = mechanism.applied_forces().iter().collect();
    forces.iter().for_each(|force| add(&force.points));
    let held = joints.iter().flat_map(|joint| &joint.group.bodies);
    for body in held.filter_map(|body| body.moving()) {
        bodies[body].is_held = true;
    }
    let acted_on = forces.iter().flat_map(|force| force.bodies);
    for body in acted_on.filter_map(|body| body.moving()) {
        bodies[body].forces += 1;
    }
    bodies
}

/// Returns the largest radius of gyration of a body; `None` if the body has no mass or no inertia,
/// which is permitted.
fn gyration(body: &BodyRecord) -> Option<f64> {
    let inertia = match &body.described {
        DescribedBody::Plane(body) => body.inertia,
        DescribedBody::Space3(body) => (0..3).map(|k| body.inertia[k][k]).fold(0.0, f64::max),
    };
    let radius = (inertia / body.mass).sqrt();
    (radius.is_finite() && radius > 0.0).then_some(radius)
}

/// Returns the size of a mechanism: the upper median of all arms and radii of gyration. A few
/// distant points, or many joints near centres of mass, do not change the median. Returns `None` if
/// there are neither arms nor radii of gyration.
fn size(records: &[BodyRecord], bodies: &[BodyShape]) -> Option<f64> {
    let arms = bodies.iter().flat_map(BodyShape::arms);
    let mut sizes: Vec<f64> = arms.chain(records.iter().filter_map(gyration)).collect();
    sizes.retain(|size| *size > 0.0);
    let middle = sizes.len() / 2;
    sizes.sort_unstable_by(f64::total_cmp);
    sizes.get(middle).copied()
}

/// Warns about bodies without a joint, if the mechanism has joints.
fn unheld(records: &[BodyRecord], bodies: &[BodyShape], map: &SourceMap, findings: &Findings) {
    if !bodies.iter().any(|body| body.is_held) {
        return;
    }
    let all = records.iter().zip(bodies).zip(&map.bodies);
    for ((body, shape), entry) in all.filter(|((_, shape), _)| !shape.is_held) {
        let acts = match shape.forces {
            0 => "moves freely".to_owned(),
            1 => "moves under one force".to_owned(),
            n => format!("moves under {n} forces"),
        };
        findings.warning(
            const { Code::new(195) },
            entry.name_span(),
            format!("no joint supports body `{}`: it {acts}", body.name),
            "in no joint",
            "add a `[[joint]]` that names it",
        );
    }
}

/// Warns about joints far from the centre of mass of a body.
fn far(
    records: &[BodyRecord],
    joints: &[JointPoints],
    size: Option<f64>,
    unit: LengthUnit,
    findings: &Findings,
) {
    let Some(size) = size else { return };
    for joint in joints {
        let arm = |(body, point): &(BodyRef, [f64; 3])| Some((body.moving()?, norm(point)));
        let arms = joint.points.iter().filter_map(arm);
        let Some((body, arm)) = arms.max_by(|a, b| a.1.total_cmp(&b.1)) else {
            continue;
        };
        let Some(entry) = joint.entry.filter(|_| arm > FARTHEST * size) else {
            continue;
        };
        let keys = [&PLACE_KEYS[..], &BODY_KEYS[..]].concat();
        findings.warning(
            const { Code::new(196) },
            entry.first_of(&keys),
            format!(
                "joint `{}` is {} from the centre of mass of body `{}`, {} times the size of this mechanism, {}",
                joint.group.name,
                quantity(arm, "m"),
                records[body].name,
                rounded(arm / size),
                quantity(size, "m")
            ),
            "far away",
            &format!(
                "numbers without a unit are in {}: correct the point, or the `position` of the body",
                unit.name
            ),
        );
    }
}

/// Warns about a planar mesh with a wheel that does not turn on the carrier of the mesh.
fn carriers(
    records: &[BodyRecord],
    joints: &[JointPoints],
    size: Option<f64>,
    findings: &Findings,
) {
    let Some(near) = size.map(|size| AT_ONE_PLACE * size) else {
        return;
    };
    let name = |body: BodyRef| match body {
        BodyRef::Ground => "ground",
        BodyRef::Body(k) => &records[k].name,
    };
    let meshes: Vec<_> = joints
        .iter()
        .filter(|joint| joint.is_planar("mesh"))
        .collect();
    if meshes.is_empty() {
        return;
    }
    let mut pins = Pins::new();
    for pin in joints.iter().filter(|joint| joint.is_planar("revolute")) {
        let [a, b] = pin.points.as_slice() else {
            continue;
        };
        pins.entry(a.0).or_default().push([a, b]);
        pins.entry(b.0).or_default().push([b, a]);
    }
    for mesh in meshes {
        let (Some(&carrier), Some(entry)) = (mesh.group.bodies.get(2), mesh.entry) else {
            continue;
        };
        let points = mesh.points.iter();
        let borne: Vec<_> = points
            .map(|&from| (from.0, borne(from, &pins, near)))
            .collect();
        let is_wrong = |(wheel, borne): &&(BodyRef, Vec<BodyRef>)| {
            *wheel != carrier && !borne.is_empty() && !borne.contains(&carrier)
        };
        let Some((wheel, own)) = borne.iter().find(is_wrong) else {
            continue;
        };
        let is_common = |body: &&BodyRef| borne.iter().all(|(_, borne)| borne.contains(body));
        let Some(&meant) = own.iter().find(is_common).or(own.first()) else {
            continue;
        };
        let [wheel, carrier, meant] = [*wheel, carrier, meant].map(name);
        findings.warning(
            const { Code::new(187) },
            entry.first_of(&["carrier", "bodies"]),
            format!(
                "mesh `{}` measures the angles of its wheels from `{carrier}`, but `{wheel}` turns on `{meant}`",
                mesh.group.name
            ),
            "on another body?",
            &format!("write `carrier = \"{meant}\"`, the body on which both wheels turn"),
        );
    }
}

/// The pins of each body: the point on this body, and the point on the other body.
type Pins<'p> = HashMap<BodyRef, Vec<[&'p (BodyRef, [f64; 3]); 2]>>;

/// Returns the bodies that pins connect with a body at one of its points.
fn borne(from: (BodyRef, [f64; 3]), pins: &Pins<'_>, near: f64) -> Vec<BodyRef> {
    let mut known = vec![from];
    let mut next = 0;
    while let Some(&(body, point)) = known.get(next) {
        next += 1;
        for [own, other] in pins.get(&body).into_iter().flatten() {
            let apart = [0, 1, 2].map(|k| own.1[k] - point[k]);
            let is_new = known.iter().all(|(body, _)| *body != other.0);
            if norm(&apart) <= near && is_new {
                known.push(**other);
            }
        }
    }
    known.into_iter().skip(1).map(|(body, _)| body).collect()
}

/// Warns about moments of inertia that contradict the mass and the size of the body.
fn inertia(
    records: &[BodyRecord],
    bodies: &[BodyShape],
    map: &SourceMap,
    size: Option<f64>,
    unit: LengthUnit,
    findings: &Findings,
) {
    let Some(size) = size else { return };
    for ((body, shape), entry) in records.iter().zip(bodies).zip(&map.bodies) {
        if shape.arms().all(|arm| arm == 0.0) {
            dense(body, entry, size, unit, findings);
            continue;
        }
        // There is a separate warning for distant points.
        let near = shape.arms().filter(|arm| *arm <= FARTHEST * size);
        let arm = near.fold(0.0, f64::max);
        let Some(radius) = gyration(body).filter(|_| arm > 0.0) else {
            continue;
        };
        let is_large = shape.has_extent() && radius > LARGEST_GYRATION * arm.max(size);
        let is_small = radius < SMALLEST_GYRATION * arm;
        if !is_large && !is_small {
            continue;
        }
        findings.warning(
            const { Code::new(194) },
            entry.span("inertia"),
            format!(
                "body `{}`: with its mass of {} kg the inertia has a radius of gyration of {}, and points of the body are up to {} from its centre of mass",
                body.name,
                rounded(body.mass),
                quantity(radius, "m"),
                quantity(arm, "m")
            ),
            if is_large { "too large" } else { "too small" },
            &format!(
                "write `inertia` about the centre of mass, in kg·{}²: a rod twice as long has {}",
                unit.name,
                unit.inertia(body.mass * arm * arm / 3.0)
            ),
        );
    }
}

/// Warns about a body, for example a wheel, whose points are all at its centre of mass. The warning
/// is given if the radius of gyration is small relative to the mechanism and a ball with the same
/// mass and inertia would not consist of any real material.
fn dense(body: &BodyRecord, entry: &Entry, size: f64, unit: LengthUnit, findings: &Findings) {
    let Some(gyration) = gyration(body).filter(|radius| *radius < SMALL * size) else {
        return;
    };
    let volume = |radius: f64| 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    // J = 2/5·m·r².
    let density = body.mass / volume(gyration * 2.5_f64.sqrt());
    if density < DENSEST {
        return;
    }
    let steel = (body.mass / STEEL / volume(1.0)).cbrt();
    findings.warning(
        const { Code::new(194) },
        entry.span("inertia"),
        format!(
            "body `{}`: with its mass of {} kg the inertia has a radius of gyration of {}, as a ball of {} kg/m³ has",
            body.name,
            rounded(body.mass),
            quantity(gyration, "m"),
            rounded(density)
        ),
        "too small",
        &format!(
            "write `inertia` about the centre of mass, in kg·{}²: a ball of steel of that mass has {}",
            unit.name,
            unit.inertia(0.4 * body.mass * steel * steel)
        ),
    );
}
