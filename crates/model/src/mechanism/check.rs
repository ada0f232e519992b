//! Finds all errors in a description.

use std::collections::HashSet;

use joints::spec::{ConstraintSpec, Role, Spec};
use joints::{LARGEST, is_usable};

use super::BuildError;
use crate::body::{Body, BodyRecord, BodyRef, DescribedBody, SpatialBody};
use crate::contact::{ContactLimits, Grip, GripLoad};
use crate::description::{Joint, MechanismDescription};
use crate::element::{BodySpace, ConstraintKernels, MOST_BODIES};
use crate::law::MEASURE_0;
use crate::observed::Observables;
use crate::principal::Principal;
use crate::tolerance::{Tolerance, ToleranceScope};

/// Returns all errors in a description; `records` are its bodies.
pub(super) fn faults<S: BodySpace>(
    d: &MechanismDescription<S>,
    records: &[BodyRecord],
) -> Vec<BuildError> {
    let mut errors = Vec::new();
    check_bodies(d, records, &mut errors);
    check_names(d, records, &mut errors);
    check_places(d, records, &mut errors);
    check_tolerances(d, records, &mut errors);
    check_limits(d, &mut errors);
    check_armatures(d, records, &mut errors);
    check_observed(d, &mut errors);
    errors
}

/// Returns whether a value is not a valid tolerance.
fn is_wrong(value: &f64) -> bool {
    !(is_usable(*value) && *value > 0.0)
}

/// Checks that the tolerances of the scene are finite and positive.
pub(super) fn tolerance(tolerance: Tolerance) -> Result<(), BuildError> {
    let fields = [
        ("tolerance", tolerance.length),
        ("angle tolerance", tolerance.angle),
    ];
    let mut wrong = fields
        .into_iter()
        .filter_map(|(field, value)| Some((field, value.filter(is_wrong)?)));
    wrong.next().map_or(Ok(()), |(field, value)| {
        Err(BuildError::Tolerance {
            of: ToleranceScope::Scene,
            field,
            value,
        })
    })
}

/// Reports every tolerance of a description that is not a finite number > 0.
fn check_tolerances<S: BodySpace>(
    d: &MechanismDescription<S>,
    records: &[BodyRecord],
    errors: &mut Vec<BuildError>,
) {
    errors.extend(tolerance(d.tolerance).err());
    let bodies = records.iter();
    let bodies = bodies.map(|b| (b.tolerance, ToleranceScope::Body(b.name.clone())));
    let joints = d.joints.iter();
    let joints = joints.map(|j| (j.tolerance, ToleranceScope::Joint(j.name.clone())));
    let drives = d.drives.iter();
    let drives = drives.map(|x| (x.tolerance, ToleranceScope::Drive(x.name.clone())));
    let markers = d.observed.markers.iter();
    let markers = markers.map(|m| (m.tolerance, ToleranceScope::Marker(m.name.clone())));
    for (value, of) in bodies.chain(joints).chain(drives).chain(markers) {
        if let Some(value) = value.filter(is_wrong) {
            let field = "tolerance";
            errors.push(BuildError::Tolerance { of, field, value });
        }
    }
}

/// Reports every joint that cannot have the limits that its description states.
fn check_limits<S: BodySpace>(d: &MechanismDescription<S>, errors: &mut Vec<BuildError>) {
    let is_open = |joint: &Joint<S>| joint.limits.open_side.is_some();
    for joint in &d.joints {
        let (spec, ContactLimits { open_side, grip }) = (joint.element.spec(), &joint.limits);
        let definition = spec.common.scene_type;
        let fault = match grip {
            _ if open_side.is_some() && !spec.has_gap() => {
                let reason = format!("a joint of type `{definition}` cannot be one-sided");
                Some(("one_sided", reason))
            }
            None => None,
            Some(_) if !spec.can_slip() => {
                let reason = format!("a joint of type `{definition}` cannot slip, so it has no grip");
                Some(("grip", reason))
            }
            Some(Grip { friction, .. }) if !(is_usable(*friction) && *friction >= 0.0) => {
                let reason = format!("`grip` is {friction}, need a coefficient of friction ≥ 0");
                Some(("grip", reason))
            }
            Some(Grip { load, .. }) => match load {
                GripLoad::Own if open_side.is_none() => Some((
                    "grip",
                    "the force that presses the contact is not known: make the joint one-sided, or state `load`"
                        .to_owned(),
                )),
                GripLoad::Constant(load) if !(is_usable(*load) && *load >= 0.0) => {
                    Some(("load", format!("`load` is {load} N, need a force ≥ 0")))
                }
                GripLoad::Joint(name) => match d.joints.iter().find(|other| other.name == *name) {
                    None => Some((
                        "load",
                        format!("there is no active joint `{name}`, which `load` names"),
                    )),
                    Some(other) if !is_open(other) => Some((
                        "load",
                        format!("`load` names `{name}`, which is not one-sided: add `one_sided` to it"),
                    )),
                    Some(_) => None,
                },
                GripLoad::Own | GripLoad::Constant(_) => None,
            },
        };
        errors.extend(fault.map(|(key, reason)| BuildError::Limits {
            name: joint.name.clone(),
            key,
            reason,
        }));
    }
}

/// Reports every armature that is not a finite number ≥ 0 for a joint coordinate of a joint.
fn check_armatures<S: BodySpace>(
    d: &MechanismDescription<S>,
    records: &[BodyRecord],
    errors: &mut Vec<BuildError>,
) {
    for armature in &d.armatures {
        let (spec, inertia) = (armature.element.spec(), armature.inertia);
        let (name, points) = (&armature.joint, armature.element.points());
        check_role(name, spec, Role::Drive, "armatures", errors);
        check_place::<S>(
            records,
            name,
            &spec.common,
            &armature.bodies,
            (&points, 1),
            errors,
        );
        let has_coordinate = spec.turning || spec.data.iter().any(|d| d.name == MEASURE_0);
        let reason = if !(is_usable(inertia) && inertia >= 0.0) {
            format!("`armature` is {inertia}, need a number ≥ 0 up to {LARGEST:e}")
        } else if spec.rows.len() != 1 || spec.common.slots.len() > MOST_BODIES || !has_coordinate {
            format!(
                "`{}` is not a joint coordinate that can have an armature",
                spec.common.scene_type
            )
        } else if d.joints.iter().all(|joint| joint.name != *name) {
            "there is no active joint of this name, which has an armature".to_owned()
        } else {
            continue;
        };
        errors.push(BuildError::Limits {
            name: name.clone(),
            key: "armature",
            reason,
        });
    }
}

fn check_bodies<S: BodySpace>(
    d: &MechanismDescription<S>,
    records: &[BodyRecord],
    errors: &mut Vec<BuildError>,
) {
    if d.bodies.is_empty() {
        errors.push(BuildError::NoBodies);
    }
    let gravity = S::point(d.gravity);
    if !gravity.iter().all(|g| is_usable(*g)) {
        let gravity = gravity[..S::DIM].to_vec();
        errors.push(BuildError::Gravity { gravity });
    }
    for record in records {
        let fields: Vec<(&'static str, f64)> = match &record.described {
            DescribedBody::Plane(b) => planar_numbers(b),
            DescribedBody::Space3(b) => spatial_numbers(b),
        };
        let before = errors.len();
        for (field, value) in fields {
            let body = record.name.clone();
            if !is_usable(value) {
                errors.push(BuildError::NotFinite { body, field, value });
            } else if value < 0.0 && matches!(field, "mass" | "inertia") {
                errors.push(BuildError::Negative { body, field, value });
            }
        }
        match &record.described {
            DescribedBody::Plane(b)
                if b.velocity.is_some() && b.angular_velocity.is_none() && !b.is_centred() =>
            {
                let body = record.name.clone();
                errors.push(BuildError::VelocityAlone { body });
            }
            DescribedBody::Plane(_) => {}
            DescribedBody::Space3(b) if errors.len() == before => {
                errors.extend(check_spatial(b));
            }
            DescribedBody::Space3(_) => {}
        }
    }
}

fn planar_numbers(b: &Body) -> Vec<(&'static str, f64)> {
    vec![
        ("mass", b.mass),
        ("inertia", b.inertia),
        ("position", b.position[0]),
        ("position", b.position[1]),
        ("centre", b.centre[0]),
        ("centre", b.centre[1]),
        ("angle", b.angle),
        ("velocity", b.velocity.unwrap_or_default()[0]),
        ("velocity", b.velocity.unwrap_or_default()[1]),
        ("angular velocity", b.angular_velocity.unwrap_or_default()),
    ]
}

fn spatial_numbers(b: &SpatialBody) -> Vec<(&'static str, f64)> {
    let all = |field: &'static str, values: &[f64]| -> Vec<(&'static str, f64)> {
        values.iter().map(|value| (field, *value)).collect()
    };
    let diagonal = [0, 1, 2].map(|k| b.inertia[k][k]);
    let products = [b.inertia[0][1], b.inertia[0][2], b.inertia[1][2]];
    [
        all("mass", &[b.mass]),
        all("inertia", &diagonal),
        all("product of inertia", &products),
        all("position", &b.position),
        all("centre", &b.centre),
        all("orientation", &b.orientation),
        all("velocity", &b.velocity.unwrap_or_default()),
        all("angular velocity", &b.angular_velocity.unwrap_or_default()),
    ]
    .concat()
}

/// Amount (fraction of the trace) by which principal moments may violate the triangle inequality.
const TRIANGLE: f64 = 1e-2;

/// Returns the errors of a spatial body whose values are finite.
fn check_spatial(b: &SpatialBody) -> Vec<BuildError> {
    let mut errors = Vec::new();
    let body = || b.name.clone();
    if b.orientation.iter().all(|e| *e == 0.0) {
        errors.push(BuildError::NoOrientation { body: body() });
    }
    let pairs = [[0, 1], [0, 2], [1, 2]];
    if pairs
        .iter()
        .any(|&[i, j]| b.inertia[i][j] != b.inertia[j][i])
    {
        errors.push(BuildError::NotSymmetric { body: body() });
    } else {
        let diagonal = [0, 1, 2].map(|k| b.inertia[k][k]);
        let moments = Principal::of(&b.inertia).map_or(diagonal, |own| own.moments);
        let trace: f64 = moments.iter().sum();
        let largest = moments.into_iter().fold(0.0, f64::max);
        let least = moments.into_iter().fold(0.0, f64::min);
        if 2.0 * largest - trace > TRIANGLE * trace || least < -TRIANGLE * trace {
            let body = body();
            errors.push(BuildError::NoSuchTensor { body, moments });
        }
    }
    if b.velocity.is_some() && b.angular_velocity.is_none() && b.centre != [0.0; 3] {
        errors.push(BuildError::VelocityAlone { body: body() });
    }
    errors
}

fn check_names<S: BodySpace>(
    d: &MechanismDescription<S>,
    records: &[BodyRecord],
    errors: &mut Vec<BuildError>,
) {
    let mut seen = HashSet::new();
    let bodies = records.iter().map(|b| &b.name);
    let markers = d.observed.markers.iter().map(|m| &m.name);
    let measures = d.observed.measures.iter().map(|m| &m.name);
    let bodies = bodies
        .chain(markers)
        .chain(measures)
        .map(|name| (name, "body"));
    let others = d
        .joints
        .iter()
        .map(|j| &j.name)
        .chain(d.drives.iter().map(|x| &x.name))
        .chain(d.forces.iter().map(|f| &f.name))
        .map(|name| (name, "joint"));
    for (name, space) in bodies.chain(others) {
        if name == "ground" {
            errors.push(BuildError::Ground);
        } else if !seen.insert((name, space)) {
            errors.push(BuildError::DuplicateName { name: name.clone() });
        }
    }
}

fn check_places<S: BodySpace>(
    d: &MechanismDescription<S>,
    records: &[BodyRecord],
    errors: &mut Vec<BuildError>,
) {
    let constraint = |element: &dyn ConstraintKernels<S>| (element.spec(), element.points());
    for j in &d.joints {
        let (spec, points) = constraint(j.element.as_ref());
        check_role(&j.name, spec, Role::Joint, "joints", errors);
        // A named component contains only the force on the first body.
        let on_ground = j.bodies.split_first().is_some_and(|(first, others)| {
            *first == BodyRef::Ground && others.contains(&BodyRef::Ground)
        });
        if on_ground && spec.component.is_some() {
            let (name, body) = (j.name.clone(), "ground".to_owned());
            errors.push(BuildError::SameBody { name, body });
        }
        let takes = (&points[..], j.functions.len());
        check_place::<S>(records, &j.name, &spec.common, &j.bodies, takes, errors);
    }
    for x in &d.drives {
        let (spec, points) = constraint(x.element.as_ref());
        check_role(&x.name, spec, Role::Drive, "drives", errors);
        check_place::<S>(
            records,
            &x.name,
            &spec.common,
            &x.bodies,
            (&points, 1),
            errors,
        );
    }
    for f in &d.forces {
        let (spec, points) = (&f.element.spec().common, f.element.points());
        let values = d.controllers.iter().flat_map(|of| &of.values);
        let signals = values.filter(|name| **name == f.name).count();
        let takes = (&points[..], f.functions.len() + signals);
        check_place::<S>(records, &f.name, spec, &f.bodies, takes, errors);
    }
}

fn check_role(
    name: &str,
    spec: &ConstraintSpec,
    role: Role,
    list: &'static str,
    errors: &mut Vec<BuildError>,
) {
    if spec.role != role {
        errors.push(BuildError::Role {
            name: name.to_owned(),
            definition: spec.common.name,
            list,
        });
    }
}

fn check_place<S: BodySpace>(
    all: &[BodyRecord],
    name: &str,
    spec: &'static Spec,
    bodies: &[BodyRef],
    (points, functions): (&[S::Vector<f64>], usize),
    errors: &mut Vec<BuildError>,
) {
    let name = || name.to_owned();
    let is_none = |p: &&S::Vector<f64>| !p.as_ref().iter().all(|x| is_usable(*x));
    if let Some(point) = points.iter().find(is_none) {
        let point = point.as_ref().to_vec();
        errors.push(BuildError::Point {
            name: name(),
            point,
        });
    }
    if bodies.len() != spec.slots.len() {
        let (expected, found) = (spec.slots.len(), bodies.len());
        errors.push(BuildError::BodyCount {
            name: name(),
            definition: spec.name,
            expected,
            found,
        });
    }
    let expected = spec.functions().count();
    if functions != expected {
        let definition = spec.name;
        errors.push(BuildError::FunctionCount {
            name: name(),
            definition,
            expected,
            found: functions,
        });
    }
    for (k, &body) in bodies.iter().enumerate() {
        if let BodyRef::Body(body) = body
            && body >= all.len()
        {
            errors.push(BuildError::UnknownBody {
                name: name(),
                body,
                n_bodies: all.len(),
            });
        } else if let BodyRef::Body(at) = body
            && bodies[..k].contains(&body)
        {
            errors.push(BuildError::SameBody {
                name: name(),
                body: all[at].name.clone(),
            });
        }
    }
    if bodies.iter().all(|b| *b == BodyRef::Ground) {
        errors.push(BuildError::GroundOnly { name: name() });
    }
}

/// Reports markers and measures that cannot be evaluated.
fn check_observed<S: BodySpace>(d: &MechanismDescription<S>, errors: &mut Vec<BuildError>) {
    let Observables { markers, measures } = &d.observed;
    for marker in markers {
        let name = || marker.name.clone();
        if let Some(body) = marker.body.moving().filter(|k| *k >= d.bodies.len()) {
            errors.push(BuildError::UnknownBody {
                name: name(),
                body,
                n_bodies: d.bodies.len(),
            });
        }
        let (point, angle) = (marker.point, marker.angle.unwrap_or_default());
        let orientation = marker.orientation.iter().flatten();
        let mut numbers = point.iter().chain([&angle]).chain(orientation);
        let is_zero = marker.orientation == Some([0.0; 4]);
        if is_zero || !numbers.all(|x| is_usable(*x)) {
            errors.push(BuildError::Marker {
                name: name(),
                point: point[..S::DIM].to_vec(),
                angle,
            });
        }
    }
    for measure in measures {
        let [first, second] = measure.between;
        let name = measure.name.clone();
        let unknown = |k: &usize| *k >= markers.len();
        if let Some(marker) = [first, second].into_iter().flatten().find(unknown) {
            errors.push(BuildError::UnknownMarker {
                name,
                marker,
                n_markers: markers.len(),
            });
        } else if first == second {
            errors.push(BuildError::SameMarker { name });
        } else if let Some(reason) = measure.kind.fault(S::KIND) {
            errors.push(BuildError::Measure { name, reason });
        }
    }
}
