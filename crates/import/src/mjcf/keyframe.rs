//! `<keyframe>`: named states.

use super::reader::Reader;
use crate::findings::{Fault, NumberKind};
use crate::mechanism::{JointKind, Keyframe};
use crate::xml::Element;

/// Number of coordinates and number of velocities of a joint in a keyframe.
fn counts(kind: JointKind) -> (usize, usize) {
    match kind {
        JointKind::Free => (7, 6),
        JointKind::Spherical => (4, 3),
        _ => (1, 1),
    }
}

impl<'a> Reader<'a, '_> {
    pub(super) fn keyframes(&mut self, section: Element<'a>) {
        for (k, element) in self.source.children(section).into_iter().enumerate() {
            let name = element
                .attribute("name")
                .map(|name| name.text.trim().to_owned());
            let name = name
                .filter(|name| !name.is_empty())
                .unwrap_or_else(|| format!("{k}"));
            let known = self.source.findings.count();
            if let Some(state) = self.state(element, name.clone()) {
                self.model.states.push(state);
            } else if self.keyframe.as_ref() != Some(&name) {
                // A keyframe at which the scene does not start does not matter.
                let findings = &mut self.source.findings;
                findings.forget(known);
                findings.leave_element("keyframes that do not fit the model", element, &name);
            }
        }
    }

    fn state(&mut self, element: Element<'a>, name: String) -> Option<Keyframe> {
        if self.keyframe.as_deref() == Some(name.as_str()) {
            let (aligned, links) = (&self.aligned, &self.model.links);
            aligned.refuse_state((element, &name), links, self.source.findings);
        }
        let slots = self.slots.clone();
        let kinds: Vec<JointKind> = slots
            .iter()
            .map(|(joint, _)| self.model.joints[*joint].kind)
            .collect();
        let total = |of: fn((usize, usize)) -> usize| kinds.iter().map(|k| of(counts(*k))).sum();
        let (n_q, n_v): (usize, usize) = (total(|c| c.0), total(|c| c.1));
        let mut read = |key: &str, n: usize| match element.attribute(key) {
            Some(value) => self
                .source
                .findings
                .numbers(&value, [n, n], NumberKind::Other)
                .map(Some),
            None => Some(None),
        };
        let (q, v) = (read("qpos", n_q)?, read("qvel", n_v)?);
        let mut out_q = rest(&self.model.joints, |joint| match joint.kind {
            JointKind::Free => {
                let pose = self.model.pose(joint.links[1]);
                let (p, e) = (pose.translation.vector, pose.rotation);
                vec![p.x, p.y, p.z, e.w, e.i, e.j, e.k]
            }
            JointKind::Spherical => vec![1.0, 0.0, 0.0, 0.0],
            JointKind::Fixed | JointKind::Planar => Vec::new(),
            kind => joint.zero[..kind.measures().len()].to_vec(),
        });
        let mut out_v = rest(&self.model.joints, |joint| match joint.kind {
            JointKind::Free => vec![0.0; 6],
            JointKind::Spherical => vec![0.0; 3],
            JointKind::Fixed | JointKind::Planar => Vec::new(),
            kind => vec![0.0; kind.measures().len()],
        });
        let (mut at_q, mut at_v) = (0, 0);
        for ((joint, coordinate), kind) in slots.iter().zip(&kinds) {
            let (n, m) = counts(*kind);
            if let Some(q) = &q {
                let own = &q[at_q..at_q + n];
                let quaternion = &own[n - n.min(4)..];
                if n > 1 && quaternion.iter().all(|x| *x == 0.0) {
                    let message = format!("the keyframe `{name}` has a quaternion of zeros");
                    self.source.findings.of(Fault::Range, element, message);
                    return None;
                }
                out_q[*joint][*coordinate..*coordinate + n].copy_from_slice(own);
            }
            if let Some(v) = &v {
                out_v[*joint][*coordinate..*coordinate + m].copy_from_slice(&v[at_v..at_v + m]);
            }
            (at_q, at_v) = (at_q + n, at_v + m);
        }
        Some(Keyframe {
            name,
            line: element.line(),
            q: out_q,
            v: v.map(|_| out_v),
        })
    }
}

fn rest(
    joints: &[crate::mechanism::Joint],
    of: impl Fn(&crate::mechanism::Joint) -> Vec<f64>,
) -> Vec<Vec<f64>> {
    joints.iter().map(of).collect()
}
