//! `[[body]]`, and the names of bodies elsewhere in the file.

use std::collections::HashMap;
use std::ops::Range;

use model::{Body, BodyRef};

use crate::field::Field;
use crate::findings::Findings;
use crate::source_map::Entry;
use crate::table::Table;

/// The bodies that were read, with their places.
#[derive(Default)]
pub(crate) struct Bodies {
    pub(crate) list: Vec<Body>,
    pub(crate) entries: Vec<Entry>,
    /// Places in the list; of a name that is used twice, the first.
    by_name: HashMap<String, usize>,
}

impl Bodies {
    /// Reads one body. Numbers that cannot be read are zero; they have been reported.
    pub(crate) fn read(&mut self, mut table: Table, name: &str, findings: &mut Findings) {
        let mut required = |key: &'static str| {
            table
                .required(key, "a number ≥ 0", findings)
                .and_then(|field| field.number(findings))
                .unwrap_or_default()
        };
        let (mass, inertia) = (required("mass"), required("inertia"));
        let mut pair = |key: &'static str| {
            table
                .optional(key)
                .and_then(|field| field.pair("a pair [x, y]", findings))
                .unwrap_or_default()
        };
        let (position, velocity) = (pair("position"), pair("velocity"));
        let mut number = |key: &'static str| {
            table
                .optional(key)
                .and_then(|field| field.number(findings))
                .unwrap_or_default()
        };
        let (angle, angular_velocity) = (number("angle"), number("angular_velocity"));
        let at = self.list.len();
        self.by_name.entry(name.to_owned()).or_insert(at);
        self.list.push(Body {
            name: name.to_owned(),
            mass,
            inertia,
            position,
            angle,
            velocity,
            angular_velocity,
        });
        self.entries.push(Entry::of(name, &table));
        table.close(findings);
    }

    /// The body that a field names; `ground` is the ground.
    pub(crate) fn find(&self, field: &Field, findings: &mut Findings) -> Option<BodyRef> {
        let name = field.text("the name of a body", findings)?;
        if name == GROUND {
            return Some(BodyRef::Ground);
        }
        let at = self.position(name);
        if at.is_none() {
            self.unknown(field.span(), &field.subject, name, findings);
        }
        at.map(BodyRef::Body)
    }

    /// The place of a body in the list.
    pub(crate) fn position(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Reports a body that does not exist.
    pub(crate) fn unknown(
        &self,
        span: Range<usize>,
        subject: &str,
        name: &str,
        findings: &mut Findings,
    ) {
        let near = findings.suggest(name, self.list.iter().map(|body| body.name.as_str()));
        let label = match near.and_then(|near| self.entries.get(self.position(near)?)) {
            Some(entry) => format!(
                "no such body; `{}` is defined on line {}",
                entry.name,
                findings.line(entry.name_span().start)
            ),
            None => "no such body".to_owned(),
        };
        findings.error_with_help(
            span,
            format!("{subject} refers to the unknown body `{name}`"),
            label,
            near.map(|near| format!("did you mean `{near}`?")),
        );
    }

    /// The name of a body.
    pub(crate) fn name(&self, body: BodyRef) -> &str {
        match body {
            BodyRef::Ground => GROUND,
            BodyRef::Body(at) => self.list.get(at).map_or(GROUND, |body| &body.name),
        }
    }

    /// Where a global point of the described configuration is in the frame of a body.
    pub(crate) fn to_local(&self, body: BodyRef, point: [f64; 2]) -> [f64; 2] {
        match body {
            BodyRef::Ground => point,
            BodyRef::Body(at) => self
                .list
                .get(at)
                .map_or(point, |body| body.pose().to_local(point)),
        }
    }
}

/// The name of the ground.
pub(crate) const GROUND: &str = "ground";
