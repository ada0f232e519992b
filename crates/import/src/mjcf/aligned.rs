//! Free bodies whose axes MuJoCo moves to their inertial frame. Coordinates in the file then refer
//! to this frame, which the reader does not convert.

use std::collections::HashMap;

use super::source::{Item, Source};
use crate::findings::{Fault, Findings};
use crate::mechanism::{JointKind, Link};
use crate::xml::Element;

/// Links of aligned free bodies, with their joints.
#[derive(Default)]
pub(super) struct Alignments<'a>(HashMap<usize, Element<'a>>);

impl<'a> Alignments<'a> {
    /// Records a free body without child bodies that the file or the compiler aligns. `kind` is the
    /// kind of its last joint.
    pub(super) fn note(
        &mut self,
        link: usize,
        (items, kind): (&[Item<'a>], Option<JointKind>),
        source: &mut Source<'a, '_>,
    ) {
        let is = |item: &&Item, name: &str| item.element.name() == name;
        let mut joints = { items.iter() }.filter(|i| is(i, "joint") || is(i, "freejoint"));
        let (Some(joint), None) = (joints.next(), joints.next()) else {
            return;
        };
        if kind != Some(JointKind::Free) || items.iter().any(|item| is(&item, "body")) {
            return;
        }
        let own = joint.element.attribute("align");
        let own = own.filter(|value| value.text.trim() != "auto");
        let is_aligned = match own {
            Some(value) => source.findings.boolean(&value).unwrap_or(false),
            None => source.compiler.aligns_free,
        };
        if is_aligned {
            self.0.insert(link, joint.element);
        }
    }

    /// Rejects a constraint whose numbers refer to the inertial frame of an aligned body: `anchor`
    /// is in the axes of the first body of a connect, or of the second body of a weld.
    pub(super) fn refuse_ends(
        &self,
        (element, name, turns): (Element<'a>, &str, bool),
        ends: [Option<usize>; 2],
        links: &[Link],
        findings: &mut Findings,
    ) {
        let is_weld = element.name() == "weld";
        let has_pose = is_weld && element.attribute("relpose").is_some();
        let refers = [has_pose || !is_weld, has_pose || turns];
        let ends = ends.into_iter().zip(refers);
        for link in ends.filter_map(|(link, refers)| link.filter(|_| refers)) {
            let what = format!("the constraint `{name}`");
            self.refuse((link, links), &what, element, findings);
        }
    }

    /// Rejects a keyframe if its numbers refer to aligned bodies.
    pub(super) fn refuse_state(
        &self,
        (element, name): (Element<'a>, &str),
        links: &[Link],
        findings: &mut Findings,
    ) {
        let has = |key| element.attribute(key).is_some();
        if let Some(first) = self.0.keys().min().copied()
            && (has("qpos") || has("qvel"))
        {
            let what = format!("the keyframe `{name}`");
            self.refuse((first, links), &what, element, findings);
        }
    }

    /// Rejects numbers that refer to the inertial frame of an aligned free body. `what` contains
    /// the numbers.
    fn refuse(
        &self,
        (link, links): (usize, &[Link]),
        what: &str,
        at: Element<'a>,
        findings: &mut Findings,
    ) {
        let Some(joint) = self.0.get(&link) else {
            return;
        };
        let message = format!(
            "{what} refers to the inertial frame of body `{}`, because its free joint (line {}) is aligned",
            links[link].name,
            joint.line()
        );
        let help = "set align=\"false\" in its <freejoint>, and give the numbers for the frame of \
                    the body";
        let (source, span) = (at.source, at.span());
        let (kind, help) = (Fault::Unsupported, help.to_owned());
        findings.fault_with_help(kind, source, span, message, "", help);
    }
}
