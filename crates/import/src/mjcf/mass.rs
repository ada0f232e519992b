//! `<inertial>`, and masses of bodies.

use nalgebra::{Isometry3, Matrix3, Vector3};

use super::compiler::FromGeoms;
use super::source::{Item, Source};
use crate::findings::{Fault, NumberKind};
use crate::mass::Mass;
use crate::xml::Element;

impl<'a> Source<'a, '_> {
    /// Returns the mass of a body: the mass that the file states for the body, or the mass of the
    /// geoms.
    pub(super) fn mass(&mut self, body: Element<'a>, items: &[Item<'a>]) -> Mass {
        let own = items.iter().find(|item| item.element.name() == "inertial");
        let own = own.filter(|_| self.compiler.from_geoms != FromGeoms::Always);
        let mass = match own {
            Some(item) => self.inertial(item).unwrap_or_default(),
            None if self.compiler.from_geoms == FromGeoms::Never => Mass::default(),
            None => self.mass_of_geoms(body, items),
        };
        self.bounded(mass)
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
