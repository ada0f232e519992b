//! `<inertial>`, and masses of bodies.

use nalgebra::{Isometry3, Matrix3, Vector3};

use super::compiler::FromGeoms;
use super::source::{Item, Source};
use crate::findings::{Fault, NumberKind};
use crate::mass::Mass;
use crate::xml::Element;

impl<'a> Source<'a, '_> {
    /// Returns the mass of a body: the mass that the file states for the body, or the mass of the
    /// geoms. `pose` is the pose that the body states.
    ///
    /// If a body has no geom and no mass except by the bounds of `<compiler>`, the inertial frame
    /// of MuJoCo is a copy of the attributes of the body: it has the same pose relative to the body
    /// as the body has relative to the surrounding element. If the mass of the geoms is not read,
    /// as for meshes, the bounds apply at the origin of the body.
    pub(super) fn mass(
        &mut self,
        body: Element<'a>,
        pose: &Isometry3<f64>,
        items: &[Item<'a>],
    ) -> Mass {
        let mut stated = items.iter().filter(|i| i.element.name() == "inertial");
        let own = stated.next();
        if let (Some(first), Some(second)) = (own, stated.next()) {
            let line = first.element.line();
            let message =
                format!("a body has only one `<inertial>`, and the first is in line {line}");
            self.findings.of(Fault::Structure, second.element, message);
        }
        let from_geoms = self.compiler.from_geoms;
        let uses_geoms = match own {
            Some(_) => from_geoms == FromGeoms::Always,
            None => from_geoms != FromGeoms::Never,
        };
        let mut mass = Mass::default();
        if uses_geoms {
            mass = self.mass_of_geoms(body, items);
        }
        // MuJoCo uses the inertia of the file for bodies whose geoms have no mass.
        if let (0.0, Some(item)) = (mass.mass, own) {
            mass = self.inertial(item).unwrap_or_default();
        }
        let has_geoms = items.iter().any(|item| item.element.name() == "geom");
        if mass.is_nothing() && own.is_none() && !has_geoms {
            return self.bound_alone(body, pose);
        }
        self.bounded(mass)
    }

    /// The mass of a body to which only the bounds of `<compiler>` give a mass.
    fn bound_alone(&mut self, body: Element<'a>, pose: &Isometry3<f64>) -> Mass {
        let mass = self.bounded(Mass::default());
        if mass.mass == 0.0 {
            return mass;
        }
        if pose.translation.vector != Vector3::zeros() {
            let name = body.attribute("name").map_or("", |name| name.text.trim());
            let at = pose.translation.vector;
            self.findings.remarks.push(format!(
                "Body `{name}` (line {}) has only the mass of `boundmass`; as in MuJoCo, its centre is at its `pos` [{}, {}, {}] in its own axes.",
                body.line(), at.x, at.y, at.z
            ));
        }
        mass.seen(pose)
    }

    fn inertial(&mut self, item: &Item<'a>) -> Option<Mass> {
        let element = item.element;
        let get = |key: &str| element.attribute(key);
        let Some(mass) = get("mass") else {
            self.findings.missing(element, "a `mass`");
            return None;
        };
        let mass = self.findings.not_negative(&mass, NumberKind::Other)?;
        // The centre of mass is not the position of a joint, so the digits of the centre do not
        // indicate the accuracy of joint positions.
        let centre = match get("pos") {
            Some(value) => self.findings.vector(&value, NumberKind::Other)?,
            None => Vector3::zeros(),
        };
        let digits = self.findings.directions;
        let turned = self.compiler.orientation(get, self.findings);
        self.findings.directions = digits;
        let tensor = match (get("fullinertia"), get("diaginertia")) {
            (Some(full), None) => {
                let n = self.findings.numbers(&full, [6, 6], NumberKind::Other)?;
                let [xx, yy, zz, xy, xz, yz] = [n[0], n[1], n[2], n[3], n[4], n[5]];
                Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
            }
            (None, Some(diagonal)) => {
                Matrix3::from_diagonal(&self.findings.vector(&diagonal, NumberKind::Other)?)
            }
            (Some(full), Some(_)) => {
                let message = "`fullinertia` and `diaginertia` exclude each other";
                self.findings.at(Fault::Value, &full, message);
                return None;
            }
            (None, None) => {
                self.findings
                    .missing(element, "`diaginertia` or `fullinertia`");
                return None;
            }
        };
        let own = Mass::turned(mass, centre, turned, tensor);
        Some(if item.frame == Isometry3::identity() {
            own
        } else {
            own.seen(&item.frame)
        })
    }

    /// Applies the bounds of `<compiler>` to the principal moments.
    fn bounded(&self, mut mass: Mass) -> Mass {
        let compiler = &self.compiler;
        mass.mass = mass.mass.max(compiler.least_mass);
        if compiler.least_inertia == 0.0 && !compiler.balances {
            return mass;
        }
        let eigen = mass.inertia.symmetric_eigen();
        let mut moments = eigen.eigenvalues.map(|x| x.max(compiler.least_inertia));
        let [a, b, c] = [moments[0], moments[1], moments[2]];
        if compiler.balances && (a + b < c || a + c < b || b + c < a) {
            moments = Vector3::repeat((a + b + c) / 3.0);
        }
        if moments != eigen.eigenvalues {
            let axes = eigen.eigenvectors;
            mass.inertia = axes * Matrix3::from_diagonal(&moments) * axes.transpose();
            mass.inertia = (mass.inertia + mass.inertia.transpose()) * 0.5;
        }
        mass
    }
}
