//! The mass of a link: stated numbers, or the masses of its collision shapes (`auto`).

use nalgebra::{Isometry3, Matrix3, Vector3};

use super::READER;
use super::frames::{Frames, pose_of};
use crate::changing::refuse_second;
use crate::findings::{Fault, Findings, NumberKind};
use crate::limits::DENSITY;
use crate::mass::{Mass, Solid};
use crate::solids::tensor;
use crate::xml::Element;

/// A link of a model.
pub(super) struct ModelLink<'l, 'a> {
    pub(super) element: Element<'a>,
    /// The name in the scene.
    pub(super) name: &'l str,
    /// The pose in ground axes.
    pub(super) pose: Isometry3<f64>,
    pub(super) frames: &'l Frames,
}

/// The mass of a link in the axes of the link.
pub(super) fn mass_of(link: &ModelLink, findings: &mut Findings) -> Option<Mass> {
    let name = link.name;
    let Some(inertial) = link.element.child("inertial") else {
        findings.remarks.push(format!(
            "Link `{name}` has no inertia: 1 kg and 1 kg·m² are assumed, as SDF requires."
        ));
        return Some(Mass {
            mass: 1.0,
            centre: Vector3::zeros(),
            inertia: Matrix3::identity(),
        });
    };
    refuse_second(inertial, &["pose", "mass", "inertia"], READER, findings);
    let is_auto = match inertial.attribute("auto") {
        Some(value) => findings.boolean(&value)?,
        None => false,
    };
    if is_auto {
        of_shapes(link, inertial, findings)
    } else {
        stated(inertial, name, findings)
    }
}

fn stated(element: Element, link: &str, findings: &mut Findings) -> Option<Mass> {
    let pose = match element.child("pose") {
        Some(pose) => pose_of(pose, NumberKind::Other, findings)?,
        None => Isometry3::identity(),
    };
    let mass = match element.text_of("mass") {
        Some(value) => findings.not_negative(&value, NumberKind::Other)?,
        None => {
            findings.remarks.push(format!(
                "Link `{link}` has no mass: 1 kg is assumed, as SDF requires."
            ));
            1.0
        }
    };
    let mut numbers = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    match element.child("inertia") {
        Some(inertia) => {
            for (number, key) in numbers
                .iter_mut()
                .zip(["ixx", "iyy", "izz", "ixy", "ixz", "iyz"])
            {
                if let Some(value) = inertia.text_of(key) {
                    *number = findings.number(&value, NumberKind::Other)?;
                }
            }
        }
        None => {
            findings.remarks.push(format!(
                "Link `{link}` has no moments: 1 kg·m² is assumed, as SDF requires."
            ));
        }
    }
    Some(Mass::turned(
        mass,
        pose.translation.vector,
        pose.rotation,
        tensor(numbers),
    ))
}

/// The mass of all collision shapes. A stated mass scales this mass; other stated numbers of
/// `<inertial>` are not used.
fn of_shapes(link: &ModelLink, inertial: Element, findings: &mut Findings) -> Option<Mass> {
    let name = link.name;
    let density = density_of(inertial, DENSITY, findings)?;
    let mut whole = Mass::default();
    let children = link.element.children();
    for collision in children.filter(|child| child.name() == "collision") {
        whole = whole.plus(&of_collision(collision, density, link, findings)?);
    }
    if whole.mass == 0.0 {
        let message = format!(
            "`auto` computes the mass of link `{name}` from its collision shapes, and their mass is \
             zero"
        );
        refuse(inertial, message, findings);
        return None;
    }
    if inertial.child("pose").is_some() || inertial.child("inertia").is_some() {
        findings.remarks.push(format!(
            "`auto` replaces the stated centre of mass and moments of link `{name}`."
        ));
    }
    match inertial.text_of("mass") {
        Some(value) => {
            let mass = findings.not_negative(&value, NumberKind::Other)?;
            Some(whole.scaled(mass / whole.mass))
        }
        None => Some(whole),
    }
}

fn density_of(element: Element, default: f64, findings: &mut Findings) -> Option<f64> {
    match element.text_of("density") {
        Some(value) => findings.not_negative(&value, NumberKind::Other),
        None => Some(default),
    }
}

/// The mass of a collision shape in the axes of the link.
fn of_collision(
    collision: Element,
    density: f64,
    link: &ModelLink,
    findings: &mut Findings,
) -> Option<Mass> {
    let density = density_of(collision, density, findings)?;
    let pose = match collision.child("pose") {
        Some(pose) => link.frames.pose_in_link(pose, &link.pose, findings)?,
        None => Isometry3::identity(),
    };
    let Some(geometry) = collision.child("geometry") else {
        findings.missing(collision, "a `<geometry>`");
        return None;
    };
    let mut whole = Mass::default();
    for shape in geometry.children() {
        let Some((solid, centre)) = solid(shape, link.name, findings)? else {
            continue;
        };
        let mass = density * solid.volume();
        let own = Mass {
            mass,
            centre: Vector3::new(0.0, 0.0, centre),
            inertia: Matrix3::from_diagonal(&Vector3::from(solid.moments(mass))),
        };
        whole = whole.plus(&own.seen(&pose));
    }
    Some(whole)
}

/// A shape, and the coordinate z of its centre of mass in its axes. The result is `None` for an
/// empty shape.
fn solid(shape: Element, link: &str, findings: &mut Findings) -> Option<Option<(Solid, f64)>> {
    let mut size = |key| lengths::<1>(shape, key, findings).map(|[x]| x);
    let solid = match shape.name() {
        "empty" => return Some(None),
        "sphere" => Solid::Sphere {
            radius: size("radius")?,
        },
        "cylinder" => Solid::Cylinder {
            radius: size("radius")?,
            half: 0.5 * size("length")?,
        },
        "capsule" => Solid::Capsule {
            radius: size("radius")?,
            half: 0.5 * size("length")?,
        },
        // The origin of a cone is at half of its height.
        "cone" => {
            let (radius, half) = (size("radius")?, 0.5 * size("length")?);
            return Some(Some((Solid::Cone { radius, half }, -0.5 * half)));
        }
        "box" => Solid::Box {
            half: lengths(shape, "size", findings)?.map(|x| 0.5 * x),
        },
        "ellipsoid" => Solid::Ellipsoid {
            half: lengths(shape, "radii", findings)?,
        },
        other => {
            let shown: String = other.chars().take(40).collect();
            let message =
                format!("`auto` does not compute the mass of link `{link}` from a `<{shown}>`");
            refuse(shape, message, findings);
            return None;
        }
    };
    Some(Some((solid, 0.0)))
}

/// The lengths in a child element, which may not be negative.
fn lengths<const N: usize>(shape: Element, key: &str, findings: &mut Findings) -> Option<[f64; N]> {
    let Some(value) = shape.text_of(key) else {
        findings.missing(shape, &format!("a `<{key}>`"));
        return None;
    };
    findings.not_negatives(&value, NumberKind::Other)
}

fn refuse(element: Element, message: String, findings: &mut Findings) {
    let (source, span) = (element.source, element.span());
    let help = "give `<mass>`, `<pose>` and `<inertia>` in `<inertial>`, without `auto`".to_owned();
    findings.fault_with_help(Fault::Unsupported, source, span, message, "", help);
}
