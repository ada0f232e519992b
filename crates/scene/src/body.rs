//! `[[body]]`, and the names of bodies elsewhere in the file.

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use model::{Body, BodyRef};
use serde_json::json;

use crate::dimension::Dimension;
use crate::field::Field;
use crate::findings::Findings;
use crate::key::{Interval, Key, Takes};
use crate::marker::Markers;
use crate::mistake::Mistake;
use crate::nearest::all;
use crate::source_map::Entry;
use crate::table::Table;
use crate::tolerance;

const MASS: Key = number("mass", "a number ≥ 0", Interval::NotNegative)
    .needed()
    .unit(Dimension::MASS)
    .doc("Mass");
const INERTIA: Key = number("inertia", "a number ≥ 0", Interval::NotNegative)
    .needed()
    .unit(Dimension::INERTIA)
    .doc("Moment of inertia about the centre of mass");
const CENTRE: Key = pair("centre")
    .unit(Dimension::LENGTH)
    .doc("Centre of mass [x, y] in the frame of the body; points of joints, `position` and `velocity` belong to the frame")
    .or(|| json!([0.0, 0.0]));
const POSITION: Key = pair("position")
    .unit(Dimension::LENGTH)
    .doc("Origin [x, y] of the body's frame at the start: its centre of mass, unless `centre` says otherwise")
    .or(|| json!([0.0, 0.0]));
const VELOCITY: Key = pair("velocity").unit(Dimension::VELOCITY).doc(
    "Velocity [vx, vy] of the origin of the body's frame at the start; it follows from what is given and driven, with the least kinetic energy, where it is left out",
);
const ANGLE: Key = number("angle", "a number", Interval::Any)
    .unit(Dimension::ANGLE)
    .doc("Angle of the body's frame at the start")
    .or(|| 0.0.into());
const TOLERANCE: Key = tolerance::length(
    "What points and directions in the body's frame are known to; that of the scene where it is not given",
);
const ANGULAR_VELOCITY: Key = number("angular_velocity", "a number", Interval::Any)
    .unit(Dimension::ANGULAR_VELOCITY)
    .doc("Angular velocity at the start; it follows in the same way where it is left out");

/// Keys of a body in addition to its name.
pub(crate) const KEYS: [Key; 8] = [
    MASS,
    INERTIA,
    CENTRE,
    POSITION,
    ANGLE,
    VELOCITY,
    ANGULAR_VELOCITY,
    TOLERANCE,
];

const fn number(name: &'static str, expected: &'static str, range: Interval) -> Key {
    Key::optional(name, expected, Takes::Number(range))
}

const fn pair(name: &'static str) -> Key {
    Key::optional(name, "a pair [x, y]", Takes::Pair(Interval::Any))
}

/// The bodies that were read, with their places.
#[derive(Default)]
pub(crate) struct Bodies {
    pub(crate) list: Vec<Body>,
    pub(crate) entries: Vec<Entry>,
    /// Indices by name; if a name is used twice, the first body.
    by_name: HashMap<String, usize>,
    /// Number of bodies without a name. Each is assumed to have one of the unknown names.
    unnamed: usize,
    /// The names assumed for them.
    theirs: RefCell<BTreeSet<String>>,
    /// Their places by name.
    pub(crate) markers: Markers,
}

impl Bodies {
    /// Reads one body. Numbers that cannot be read are zero; they have been reported.
    pub(crate) fn read(&mut self, mut table: Table, name: &str, findings: &mut Findings) {
        let mut required = |key: &Key| {
            table
                .required(key, findings)
                .and_then(|field| field.number(key.unit, findings))
                .unwrap_or_default()
        };
        let (mass, inertia) = (required(&MASS), required(&INERTIA));
        let mut pair = |key: &Key| {
            table
                .optional(key)
                .and_then(|field| field.pair(key.expected, key.unit, findings))
        };
        let mut place = |key: &Key| pair(key).unwrap_or_default();
        let (centre, position) = (place(&CENTRE), place(&POSITION));
        let velocity = pair(&VELOCITY);
        let mut number = |key: &Key| {
            let field = table.optional(key);
            field.and_then(|field| field.number(key.unit, findings))
        };
        let (angle, angular_velocity) = (
            number(&ANGLE).unwrap_or_default(),
            number(&ANGULAR_VELOCITY),
        );
        let tolerance = tolerance::read(&mut table, &TOLERANCE, findings);
        let at = self.list.len();
        let is_own = table.peek("name") == Some(name) && name != GROUND;
        if !is_own || self.by_name.contains_key(name) {
            self.unnamed += 1;
        }
        self.by_name.entry(name.to_owned()).or_insert(at);
        self.list.push(Body {
            name: name.to_owned(),
            mass,
            inertia,
            centre,
            position,
            angle,
            velocity,
            angular_velocity,
            tolerance,
        });
        self.entries.push(Entry::of(name, &table));
        table.close(findings);
    }

    /// The body with the name in this field; `ground` is the ground.
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

    /// The index of a body.
    pub(crate) fn position(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Reports a body that does not exist, unless a problem reported for the bodies explains it.
    pub(crate) fn unknown(
        &self,
        span: Range<usize>,
        subject: &str,
        name: &str,
        findings: &mut Findings,
    ) {
        let near = findings.suggest(name, self.list.iter().map(|body| body.name.as_str()));
        if near.is_none() && (self.list.is_empty() || self.is_of_unnamed(name)) {
            return;
        }
        let label = match near.and_then(|near| self.entries.get(self.position(near)?)) {
            Some(entry) => format!(
                "no such body; `{}` is defined on line {}",
                entry.name,
                findings.line(entry.name_span().start)
            ),
            None => "no such body".to_owned(),
        };
        findings.error_with_help(
            Mistake::UnknownBody,
            span,
            format!("{subject} refers to the unknown body `{name}`"),
            label,
            match near {
                Some(near) => Some(format!("did you mean `{near}`?")),
                None => all("bodies", self.list.iter().map(|body| body.name.as_str())),
            },
        );
    }

    /// Whether an unknown name may belong to a body without a name.
    fn is_of_unnamed(&self, name: &str) -> bool {
        let mut theirs = self.theirs.borrow_mut();
        if theirs.len() < self.unnamed {
            theirs.insert(name.to_owned());
        }
        theirs.contains(name)
    }

    /// The name of a body.
    pub(crate) fn name(&self, body: BodyRef) -> &str {
        match body {
            BodyRef::Ground => GROUND,
            BodyRef::Body(at) => self.list.get(at).map_or(GROUND, |body| &body.name),
        }
    }
}

/// The name of the ground.
pub(crate) const GROUND: &str = "ground";
