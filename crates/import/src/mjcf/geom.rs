//! `<geom>`: only the mass is used; contacts are omitted.

use nalgebra::{Isometry3, Matrix3, UnitQuaternion, Vector3};

use super::source::{Item, Source};
use crate::findings::{Fault, Findings, NumberKind, unit};
use crate::limits::DENSITY;
use crate::mass::{Mass, Solid};
use crate::pose::along_z;
use crate::xml::{Element, Value};

/// Source of the mass of a geom.
#[derive(Clone, Copy)]
enum Weight {
    Mass(f64),
    Density(f64),
}

/// Geometry of geoms.
pub(super) struct Geoms;

impl Geoms {
    /// Midpoint, orientation and half length of the segment `fromto`.
    pub(super) fn ends(
        value: &Value,
        findings: &mut Findings,
    ) -> Option<(Vector3<f64>, UnitQuaternion<f64>, f64)> {
        let n = findings.numbers(value, [6, 6], NumberKind::Other)?;
        let (a, b) = (
            Vector3::new(n[0], n[1], n[2]),
            Vector3::new(n[3], n[4], n[5]),
        );
        let along = a - b;
        let length = along.norm();
        if length == 0.0 || !length.is_finite() {
            let message = format!("{}: its ends coincide", value.subject);
            findings.at(Fault::Range, value, message);
            return None;
        }
        Some(((a + b) * 0.5, along_z(unit(along)), 0.5 * length))
    }
}

/// The solid for a type and a size, or the reason why there is none.
fn solid_of(word: &str, size: &[f64]) -> Result<Solid, (Fault, String)> {
    let solid = match (word, size) {
        ("sphere", &[radius, ..]) => Solid::Sphere { radius },
        ("capsule", &[radius, half, ..]) => Solid::Capsule { radius, half },
        ("cylinder", &[radius, half, ..]) => Solid::Cylinder { radius, half },
        ("ellipsoid", &[a, b, c]) => Solid::Ellipsoid { half: [a, b, c] },
        ("box", &[a, b, c]) => Solid::Box { half: [a, b, c] },
        ("sphere" | "capsule" | "cylinder" | "ellipsoid" | "box", _) => {
            let message = format!("the `size` of a {word} has too few numbers");
            return Err((Fault::Missing, message));
        }
        _ => {
            let shown: String = word.chars().take(40).collect();
            return Err((Fault::Value, format!("there is no geom of type `{shown}`")));
        }
    };
    let used = match word {
        "sphere" => 1,
        "capsule" | "cylinder" => 2,
        _ => 3,
    };
    if size.iter().take(used).all(|x| *x > 0.0) {
        return Ok(solid);
    }
    let message = format!("the `size` of a {word} must be positive");
    Err((Fault::Range, message))
}

impl<'a> Source<'a, '_> {
    pub(super) fn mass_of_geoms(&mut self, body: Element<'a>, items: &[Item<'a>]) -> Mass {
        let mut sum = Mass::default();
        for item in items.iter().filter(|item| item.element.name() == "geom") {
            if let Some(mass) = self.geom(item) {
                sum = sum.plus(&mass);
            }
        }
        if !sum.mass.is_finite() || sum.inertia.iter().any(|x| !x.is_finite()) {
            self.findings
                .of(Fault::Range, body, "the mass of its geoms is not finite");
            return Mass::default();
        }
        sum
    }

    /// The mass of a geom in the axes of its body.
    fn geom(&mut self, item: &Item<'a>) -> Option<Mass> {
        let attributes = self.attributes(item.element, item.class);
        let keys = [
            "type",
            "size",
            "fromto",
            "mass",
            "density",
            "group",
            "shellinertia",
            "pos",
            "quat",
            "axisangle",
            "euler",
            "xyaxes",
            "zaxis",
            "mesh",
        ];
        let values = keys.map(|key| attributes.get(key));
        let get = |key: &str| {
            keys.iter()
                .position(|k| *k == key)
                .and_then(|k| values[k].clone())
        };
        let weight = self.weight_of(&get)?;
        let digits = (self.findings.lengths, self.findings.directions);
        let mut pose = self.compiler.pose(get, self.findings);
        (self.findings.lengths, self.findings.directions) = digits;
        let kind = get("type");
        let word = kind.as_ref().map_or("sphere", |value| value.text.trim());
        if matches!(word, "plane" | "hfield") {
            return None;
        }
        if matches!(word, "mesh" | "sdf") || get("mesh").is_some() {
            let name = item.element.attribute("name").map_or("", |name| name.text);
            let kind = "masses of meshes: the body lacks them, give it an <inertial>";
            self.findings.leave_element(kind, item.element, name);
            return None;
        }
        if get("shellinertia").is_some_and(|value| value.text.trim() == "true") {
            let message = "`shellinertia` is not supported: give the body an `<inertial>`";
            self.findings.of(Fault::Unsupported, item.element, message);
            return None;
        }
        let mut size = match get("size") {
            Some(value) => self.findings.numbers(&value, [1, 3], NumberKind::Other)?,
            None => Vec::new(),
        };
        if let Some(value) = get("fromto") {
            let (middle, axes, half) = Geoms::ends(&value, self.findings)?;
            pose = Isometry3::from_parts(middle.into(), axes);
            let radius = size.first().copied().unwrap_or(0.0);
            size = match word {
                "box" | "ellipsoid" => vec![radius, radius, half],
                _ => vec![radius, half],
            };
        }
        let solid = match solid_of(word, &size) {
            Ok(solid) => solid,
            Err((fault, message)) => {
                self.findings.of(fault, item.element, message);
                return None;
            }
        };
        let mass = match weight {
            Weight::Mass(mass) => mass,
            Weight::Density(density) => density * solid.volume(),
        };
        let moments = Matrix3::from_diagonal(&Vector3::from(solid.moments(mass)));
        let pose = item.frame * pose;
        Some(Mass::turned(
            mass,
            pose.translation.vector,
            pose.rotation,
            moments,
        ))
    }

    /// `None` if the geom has no mass.
    fn weight_of(&mut self, get: &impl Fn(&str) -> Option<Value<'a>>) -> Option<Weight> {
        let group = match get("group") {
            Some(group) => self.findings.number(&group, NumberKind::Other)?,
            None => 0.0,
        };
        let [first, last] = self.compiler.groups;
        if group < first || group > last {
            return None;
        }
        let given = match get("mass") {
            Some(value) => Some(self.findings.not_negative(&value, NumberKind::Other)?),
            None => None,
        };
        let density = match get("density") {
            Some(value) => self.findings.not_negative(&value, NumberKind::Other)?,
            None => DENSITY,
        };
        let weight = given.map_or(Weight::Density(density), Weight::Mass);
        let (Weight::Mass(size) | Weight::Density(size)) = weight;
        (size != 0.0).then_some(weight)
    }

    /// Records that a geom may have contacts.
    pub(super) fn contact_of(&mut self, item: &Item<'a>) {
        let attributes = self.attributes(item.element, item.class);
        let off = |value: Option<Value>| value.is_some_and(|value| value.text.trim() == "0");
        let (by_type, affinity) = (attributes.get("contype"), attributes.get("conaffinity"));
        if off(by_type) && off(affinity) {
            return;
        }
        let name = item.element.attribute("name").map_or("", |name| name.text);
        self.findings
            .leave_element("contacts of geoms", item.element, name);
    }
}
