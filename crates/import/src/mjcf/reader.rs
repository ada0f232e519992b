//! The data read from a file so far: the model, and the names by which elements refer to its parts.

use std::collections::{HashMap, HashSet};

use nalgebra::Isometry3;

use super::aligned::Alignments;
use super::source::Source;
use crate::findings::Fault;
use crate::mechanism::Model;
use crate::xml::{Element, Value};

/// The data read from a file so far.
pub(super) struct Reader<'a, 'f> {
    pub(super) source: Source<'a, 'f>,
    pub(super) model: Model,
    /// Name of the keyframe at which the scene starts.
    pub(super) keyframe: Option<String>,
    /// Links by the names of their bodies; `world` is the ground.
    pub(super) bodies: HashMap<String, Option<usize>>,
    /// Joint and coordinate of the joints of the file, by name.
    pub(super) joints: HashMap<String, (usize, usize)>,
    /// Names of joints in the file.
    pub(super) names: HashSet<String>,
    /// Tendons by name.
    pub(super) tendons: HashMap<String, Element<'a>>,
    pub(super) sites: HashMap<String, (Option<usize>, Isometry3<f64>)>,
    /// Free bodies whose axes MuJoCo moves to the inertial frame.
    pub(super) aligned: Alignments<'a>,
    /// Joint and coordinate of the joints of the file, in their order.
    pub(super) slots: Vec<(usize, usize)>,
}

impl Reader<'_, '_> {
    /// The body of a value; `world` is the ground.
    pub(super) fn body(&mut self, value: &Value) -> Option<Option<usize>> {
        let found = self.bodies.get(value.text.trim()).copied();
        if found.is_none() {
            let near = scene::nearest(value.text, self.bodies.keys().map(String::as_str));
            let help = near.map(|near| format!("did you mean `{near}`?"));
            let message = format!("{}: there is no body `{}`", value.subject, value.text);
            let (source, span) = (value.source, value.span.clone());
            self.source.findings.fault_with_help(
                Fault::Unknown,
                source,
                span,
                message,
                "no such body",
                help,
            );
        }
        found
    }
}
