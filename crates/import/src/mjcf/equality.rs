//! `<equality>`: soft constraints of MuJoCo, which become exact constraints in a scene.

use nalgebra::{Isometry3, Point3, Vector3};

use super::reader::Reader;
use crate::findings::{Fault, Findings, NumberKind};
use crate::mechanism::{Coupling, Joint, JointKind};
use crate::pose::quaternion;
use crate::xml::{Element, Value};

impl<'a> Reader<'a, '_> {
    pub(super) fn equalities(&mut self, section: Element<'a>) {
        let mut lines = Vec::new();
        for (k, element) in self.source.children(section).into_iter().enumerate() {
            let name = element
                .attribute("name")
                .map(|name| name.text.trim().to_owned());
            let name = name.filter(|name| !name.is_empty());
            let name = name.unwrap_or_else(|| format!("{} {}", element.name(), k + 1));
            let is_exact = matches!(element.name(), "connect" | "weld" | "joint" | "tendon");
            if is_exact {
                lines.push(element.line().to_string());
            }
            match element.name() {
                "connect" | "weld" => {
                    if let Some(joint) = self.closure(element, name) {
                        self.model.joints.push(joint);
                    }
                }
                "joint" => {
                    if let Some(coupling) = self.coupling(element, name) {
                        self.model.couplings.push(coupling);
                    }
                }
                "tendon" => {
                    if let Some(coupling) = self.coupling_of_tendons(element, name) {
                        self.model.couplings.push(coupling);
                    }
                }
                // An inactive constraint has no effect.
                _ if !self.is_active(element) => {
                    let subject = format!("{name}, <{}>", element.name());
                    let kind = "constraints that are not active";
                    self.source.findings.leave_element(kind, element, &subject);
                }
                other => {
                    let message = format!(
                        "`<{other}>` of `<equality>` removes degrees of freedom and is not supported"
                    );
                    self.refuse(element, message);
                }
            }
        }
        if !lines.is_empty() {
            self.source.findings.remarks.push(format!(
                "Constraints of <equality> (line {}) are exact here; in MuJoCo they are soft.",
                lines.join(", ")
            ));
        }
    }

    /// Rejects an unsupported constraint.
    fn refuse(&mut self, element: Element<'a>, message: String) {
        let help = "give it active=\"false\" to leave it out".to_owned();
        let (source, span) = (element.source, element.span());
        self.source
            .findings
            .fault_with_help(Fault::Unsupported, source, span, message, "", help);
    }

    fn is_active(&mut self, element: Element<'a>) -> bool {
        let value = self.equality_attribute(element, "active");
        value.is_none_or(|value| self.source.findings.boolean(&value).unwrap_or(true))
    }

    /// An attribute of an element, or of its class of `<equality>`.
    fn equality_attribute(&mut self, element: Element<'a>, key: &str) -> Option<Value<'a>> {
        let class = element
            .attribute("class")
            .map_or(0, |value| self.source.class(&value));
        element
            .attribute(key)
            .or_else(|| self.source.defaults.get(class, "equality", key))
    }

    /// `<connect>` and `<weld>`.
    fn closure(&mut self, element: Element<'a>, name: String) -> Option<Joint> {
        let is_weld = element.name() == "weld";
        let turns = is_weld && turns_freely(element, &name, self.source.findings)?;
        let kind = if is_weld && !turns {
            JointKind::Fixed
        } else {
            JointKind::Spherical
        };
        let is_active = self.is_active(element);
        let joint = |links, points, frames| Joint {
            places: false,
            frames,
            is_active,
            ..Joint::new(name.clone(), kind, links, points, [Vector3::z(); 2])
        };
        if let (Some(a), Some(b)) = (element.attribute("site1"), element.attribute("site2")) {
            let [a, b] = [self.site_of(&a), self.site_of(&b)];
            let ((first, a), (second, b)) = (a?, b?);
            let points = [a.translation.vector, b.translation.vector];
            let frames = (kind == JointKind::Fixed).then_some([a.rotation, b.rotation]);
            return self
                .between(element, [first, second])
                .then(|| joint([first, second], points, frames));
        }
        let Some(first) = element.attribute("body1") else {
            self.source
                .findings
                .missing(element, "`body1`, or `site1` and `site2`");
            return None;
        };
        let first = self.body(&first)?;
        let second = match element.attribute("body2") {
            Some(second) => self.body(&second)?,
            None => None,
        };
        if !self.between(element, [first, second]) {
            return None;
        }
        let (aligned, links) = (&self.aligned, &self.model.links);
        let findings = &mut *self.source.findings;
        aligned.refuse_ends((element, &name, turns), [first, second], links, findings);
        let anchor = match element.attribute("anchor") {
            Some(value) => Some(self.source.findings.vector(&value, NumberKind::Length)?),
            None => None,
        };
        let [a, b] = [first, second].map(|link| self.model.pose(link));
        let relation = b.inverse() * a;
        if !is_weld {
            let Some(anchor) = anchor else {
                self.source.findings.missing(element, "an `anchor`");
                return None;
            };
            let other = (relation * Point3::from(anchor)).coords;
            return Some(joint([first, second], [anchor, other], None));
        }
        let given = element.attribute("relpose");
        let given = match given {
            Some(value) => Some(
                self.source
                    .findings
                    .numbers(&value, [7, 7], NumberKind::Other)?,
            ),
            None => None,
        };
        // If all components of the quaternion are zero, the relative pose at the described pose is
        // used.
        let given = given.filter(|n| n[3..].iter().any(|x| *x != 0.0));
        let anchor = anchor.unwrap_or_default();
        match given {
            None => {
                let at = (relation.inverse() * Point3::from(anchor)).coords;
                Some(joint([first, second], [at, anchor], None))
            }
            Some(n) => {
                // The position of `relpose` is the position of the anchor point of the second body.
                let at = Vector3::new(n[0], n[1], n[2]);
                let turned = quaternion([n[3], n[4], n[5], n[6]]);
                let frames = (kind == JointKind::Fixed).then_some([turned, Default::default()]);
                Some(joint([first, second], [at, anchor], frames))
            }
        }
    }

    fn between(&mut self, element: Element<'a>, [first, second]: [Option<usize>; 2]) -> bool {
        if first == second {
            let message = "a constraint between a body and itself";
            self.source.findings.of(Fault::Structure, element, message);
        }
        first != second
    }

    fn site_of(&mut self, value: &Value<'a>) -> Option<(Option<usize>, Isometry3<f64>)> {
        let found = self.sites.get(value.text.trim()).copied();
        if found.is_none() {
            let message = format!("{}: there is no site `{}`", value.subject, value.text);
            self.source.findings.at(Fault::Unknown, value, message);
        }
        found
    }

    /// `<joint>`: y − y₀ = P(x − x₀).
    fn coupling(&mut self, element: Element<'a>, name: String) -> Option<Coupling> {
        let Some(y) = element.attribute("joint1") else {
            self.source.findings.missing(element, "`joint1`");
            return None;
        };
        let y = self.coordinate(&y)?;
        let x = match element.attribute("joint2") {
            Some(x) => Some(self.coordinate(&x)?),
            None => None,
        };
        let mut coefficients = vec![0.0, 1.0, 0.0, 0.0, 0.0];
        if let Some(value) = element.attribute("polycoef") {
            let given = self
                .source
                .findings
                .numbers(&value, [1, 5], NumberKind::Other)?;
            coefficients[..given.len()].copy_from_slice(&given);
        }
        let is_active = self.is_active(element);
        Some(Coupling {
            name,
            x,
            y,
            coefficients,
            is_active,
        })
    }

    /// `<tendon>`: L₁ − L₁₀ = P(L₂ − L₂₀) with lengths L = Σ cᵢ·qᵢ of fixed tendons. The constraint
    /// is a coupling if it contains two coordinates: one coordinate of each tendon, or two
    /// coordinates of the first tendon.
    fn coupling_of_tendons(&mut self, element: Element<'a>, name: String) -> Option<Coupling> {
        let is_active = self.is_active(element);
        let Some(first) = element.attribute("tendon1") else {
            self.source.findings.missing(element, "`tendon1`");
            return None;
        };
        let first = self.length(element, &first)?;
        let second = match element.attribute("tendon2") {
            Some(second) => Some(self.length(element, &second)?),
            None => None,
        };
        let mut given = [0.0, 1.0, 0.0, 0.0, 0.0];
        if let Some(value) = element.attribute("polycoef") {
            let numbers = self
                .source
                .findings
                .numbers(&value, [1, 5], NumberKind::Other)?;
            given[..numbers.len()].copy_from_slice(&numbers);
        }
        let (x, y, coefficients) = match (first.as_slice(), second.as_deref()) {
            (&[(y, c)], None) => (None, y, vec![given[0] / c]),
            (&[(y, c), (x, d)], None) => (Some(x), y, vec![given[0] / c, -d / c]),
            (&[(y, c)], Some(&[(x, d)])) => {
                let powers = std::iter::successors(Some(1.0), |power| Some(power * d));
                let of_x = given.iter().zip(powers).map(|(a, power)| a * power / c);
                (Some(x), y, of_x.collect())
            }
            _ => {
                let message = "a `<tendon>` of `<equality>` is read with two joints, and this one \
                               has others";
                self.refuse(element, message.to_owned());
                return None;
            }
        };
        if x == Some(y) {
            let message = "a constraint between a joint and itself";
            self.source.findings.of(Fault::Structure, element, message);
            return None;
        }
        Some(Coupling {
            name,
            x,
            y,
            coefficients,
            is_active,
        })
    }

    /// The coordinates of a fixed tendon with their nonzero coefficients.
    fn length(
        &mut self,
        element: Element<'a>,
        name: &Value<'a>,
    ) -> Option<Vec<((usize, usize), f64)>> {
        let Some(tendon) = self.tendons.get(name.text.trim()).copied() else {
            let message = format!("{}: there is no tendon `{}`", name.subject, name.text);
            self.source.findings.at(Fault::Unknown, name, message);
            return None;
        };
        if tendon.name() != "fixed" {
            let message = format!(
                "`{}` is a tendon in space, and constraints of its length are not supported",
                name.text
            );
            self.refuse(element, message);
            return None;
        }
        let mut out = Vec::new();
        for part in self.source.children(tendon) {
            let (Some(joint), Some(coefficient)) =
                (part.attribute("joint"), part.attribute("coef"))
            else {
                self.source.findings.missing(part, "a `joint` and a `coef`");
                return None;
            };
            let joint = self.coordinate(&joint)?;
            let coefficient = self
                .source
                .findings
                .number(&coefficient, NumberKind::Other)?;
            if coefficient != 0.0 {
                out.push((joint, coefficient));
            }
        }
        Some(out)
    }

    fn coordinate(&mut self, value: &Value<'a>) -> Option<(usize, usize)> {
        let Some(found) = self.joints.get(value.text.trim()).copied() else {
            let message = format!("{}: there is no joint `{}`", value.subject, value.text);
            self.source.findings.at(Fault::Unknown, value, message);
            return None;
        };
        if self.model.joints[found.0]
            .kind
            .measures()
            .get(found.1)
            .is_none()
        {
            let message = format!(
                "{}: `{}` is neither hinge nor slide",
                value.subject, value.text
            );
            self.source.findings.at(Fault::Structure, value, message);
            return None;
        }
        Some(found)
    }
}

/// Whether a weld has the factor zero for its rotations, so that it only holds the anchor point.
/// Other factors change the softness of the weld, but not the exact constraint.
fn turns_freely(element: Element<'_>, name: &str, findings: &mut Findings) -> Option<bool> {
    let Some(value) = element.attribute("torquescale") else {
        return Some(false);
    };
    let turns = findings.number(&value, NumberKind::Other)? == 0.0;
    if turns {
        findings.remarks.push(format!(
            "The weld `{name}` (line {}) has `torquescale=\"0\"`: it holds only its anchor point.",
            element.line()
        ));
    }
    Some(turns)
}
