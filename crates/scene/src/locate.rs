//! Finds the positions in the file for errors that name bodies, joints and rows.

use std::collections::BTreeSet;
use std::ops::Range;

use dynamics::{MotionError, MotionFault};
use joints::is_usable;
use model::codes::Code;
use model::start::VelocityConflict;
use model::{
    AnyDescription, BodyRecord, BodyRef, BuildError, RowLabel, StartError, ToleranceScope,
};

use crate::diagnostic::{Diagnostic, Severity};
use crate::source_map::{BODY_KEYS, Entry, PLACE_KEYS, SourceMap};

/// An error with its own code.
trait CodedError: std::error::Error {
    fn code(&self) -> Code;
}

impl CodedError for BuildError {
    fn code(&self) -> Code {
        self.code()
    }
}

impl CodedError for StartError {
    fn code(&self) -> Code {
        self.code()
    }
}

impl CodedError for MotionError {
    fn code(&self) -> Code {
        self.code()
    }
}

/// The position of an error of [`model::Mechanism::build`].
pub(crate) fn build(map: &SourceMap, d: &AnyDescription, error: &BuildError) -> Diagnostic {
    let (span, label) = match error {
        BuildError::NoBodies => (map.section("scene", ""), "no `[[body]]` in this scene"),
        BuildError::Gravity { .. } => (map.section("scene", "gravity"), "not a usable number"),
        BuildError::DuplicateName { name } => {
            let uses = uses(map, name);
            let mut diagnostics = duplicates(map, &uses[0], error);
            diagnostics.extend(duplicates(map, &uses[1], error));
            return diagnostics
                .into_iter()
                .next()
                .unwrap_or_else(|| at(map, map.section("scene", ""), error, "in this scene"));
        }
        BuildError::Ground => {
            let named = map.places().chain(map.elements());
            let found = named.into_iter().find(|entry| entry.name == "ground");
            let span = found.map_or_else(|| map.section("scene", ""), Entry::name_span);
            (span, "choose another name")
        }
        BuildError::NotFinite { body, field, .. } => (
            body_key(map, d, body, field, |x| !is_usable(x)),
            "not a usable number",
        ),
        BuildError::Negative { body, field, .. } => (
            body_key(map, d, body, field, |x| x < 0.0),
            "may not be negative",
        ),
        BuildError::NotSymmetric { body } | BuildError::NoSuchTensor { body, .. } => (
            body_key(map, d, body, "inertia", |_| true),
            "not the tensor of a body",
        ),
        BuildError::NoOrientation { body } => (
            body_key(map, d, body, "orientation", |_| true),
            "no orientation",
        ),
        BuildError::Measure { name, .. } => {
            let keys = ["axis", "axes", "about", "type"];
            (place_key(map, name, &keys), "no such measure")
        }
        BuildError::VelocityAlone { body } => (
            body_key(map, d, body, "velocity", |_| true),
            "needs `angular_velocity` too",
        ),
        BuildError::Tolerance { of, field, value } => {
            let key = field.replace(' ', "_");
            let span = match of {
                ToleranceScope::Scene => map.section("scene", &key),
                ToleranceScope::Body(body) => {
                    body_key(map, d, body, field, |x| x.to_bits() == value.to_bits())
                }
                ToleranceScope::Marker(name) => place_key(map, name, &[&key]),
                ToleranceScope::Joint(name) | ToleranceScope::Drive(name) => {
                    element_key(map, name, &[&key, "joint"])
                }
            };
            (span, "expected a number > 0")
        }
        BuildError::BodyCount { name, .. } | BuildError::UnknownBody { name, .. } => {
            (element_key(map, name, &BODY_KEYS), "these bodies")
        }
        BuildError::Limits { name, key, .. } => (
            element_key(map, name, &[key]),
            "cannot be used as described",
        ),
        BuildError::SameBody { name, .. } => (
            connection(map, d, name, |bodies| {
                (1..bodies.len()).any(|k| bodies[..k].contains(&bodies[k]))
            }),
            "give two different bodies",
        ),
        BuildError::GroundOnly { name } => (
            connection(map, d, name, |bodies| {
                bodies.iter().all(|body| *body == BodyRef::Ground)
            }),
            "at least one body must be able to move",
        ),
        BuildError::Marker { name, .. } => {
            (place_key(map, name, &["point"]), "not a usable number")
        }
        BuildError::SameMarker { name } | BuildError::UnknownMarker { name, .. } => (
            place_key(map, name, &["markers"]),
            "give two different places",
        ),
        BuildError::FunctionCount { name, .. } => (element_key(map, name, &[]), "defined here"),
        _ => (map.section("scene", ""), "in this scene"),
    };
    at(map, span, error, label)
}

/// The position of an error of [`model::start`].
pub(crate) fn start(map: &SourceMap, error: &StartError) -> Diagnostic {
    let (span, label) = match error {
        StartError::NoAssembly { misfits, .. } => {
            let joints = misfits.iter().map(|m| m.joint.as_str());
            let marks = ["contradicts other constraints", "misses too"];
            return at_joints(map, joints, error, marks);
        }
        StartError::NoVelocity { worst, .. } => (row(map, worst), "misses most"),
        StartError::Velocities(conflict) => return velocities(map, conflict, error),
        StartError::LargeCorrection { body, misfits, .. } => {
            let joints = misfits.iter().map(|m| m.joint.as_str());
            let marks = ["misses as described", "misses too"];
            let entry = map.body(body);
            let told = at_joints(map, joints, error, marks);
            return match entry.map(|entry| entry.first_of(&["start", "position", "angle"])) {
                Some(span) => told.and(map.text.label(span, "would have to move most")),
                None => told,
            };
        }
        StartError::WrongSide { joints } => {
            let joints = joints.iter().map(|(name, _)| name.as_str());
            return at_joints(
                map,
                joints,
                error,
                ["on the wrong side as described", "too"],
            );
        }
        StartError::Requirement { name, .. } => {
            let is_element = map.elements().any(|entry| entry.name == *name);
            let span = if is_element {
                element_key(map, name, &PLACE_KEYS)
            } else {
                place_key(map, name, &["about"])
            };
            (span, "required here")
        }
        StartError::KeptOrigin { .. } => (map.section("start", "keep"), "held here"),
        _ => (map.section("start", ""), "of this scene"),
    };
    at(map, span, error, label)
}

/// Returns the positions of given velocities that are impossible: first the drives, then the
/// velocity or the table that contains the velocity.
fn velocities(map: &SourceMap, conflict: &VelocityConflict, error: &StartError) -> Diagnostic {
    let span = match (conflict.is_kept, conflict.coordinate) {
        (true, _) => map.section("start", "keep"),
        (false, coordinate) => {
            let key = match coordinate {
                "omega" | "wx" | "wy" | "wz" => "angular_velocity",
                _ => "velocity",
            };
            let entry = map.body(&conflict.body);
            entry.map_or(0..0, |entry| entry.first_of(&[key]))
        }
    };
    let word = if conflict.is_kept {
        "held here"
    } else {
        "given here"
    };
    match conflict.drives.first() {
        Some(drive) => at(
            map,
            element_key(map, drive, &[]),
            error,
            "requires other velocities",
        )
        .and(map.text.label(span, word)),
        None => at(map, span, error, "not with these constraints"),
    }
}

/// The position of an error of a run.
pub(crate) fn motion(map: &SourceMap, error: &MotionError) -> Diagnostic {
    let (span, label) = match error {
        MotionError::Start(error) => return start(map, error),
        MotionError::Component { source, .. } => return motion(map, source),
        MotionError::Contradiction(contradiction) => {
            return contradicting(
                map,
                contradiction.split_rows(),
                &contradiction.forcing(),
                error,
            );
        }
        MotionError::Option { name, .. } => (map.section("simulate", name), "not possible"),
        MotionError::Rows(_) => (map.section("simulate", "drop"), "not these rows"),
        MotionError::Fault(MotionFault::Drives { contradiction, .. }) => {
            return contradicting(
                map,
                contradiction.split_rows(),
                &contradiction.forcing(),
                error,
            );
        }
        MotionError::Fault(fault) => match fault {
            MotionFault::RankLost { row: label, .. } => (row(map, label), "becomes dependent"),
            MotionFault::OffConstraints { row: label, .. } => (row(map, label), "misses most"),
            MotionFault::SingularStart { row: label, .. } => {
                (row(map, label), "redundant at the start alone")
            }
            MotionFault::DroppedRow { row: label, .. } => (row(map, label), "is violated"),
            MotionFault::NoConfiguration { limit } => {
                let first = limit.drives.first().map(|drive| drive.name.as_str());
                let span = first.map_or(0..0, |name| element_key(map, name, &[]));
                (span, "cannot continue")
            }
            MotionFault::Opens { joints, .. } => {
                let first = joints
                    .first()
                    .map(|name| element_key(map, name, &["one_sided"]));
                (first.unwrap_or(0..0), "opens")
            }
            MotionFault::Slips { joints, .. } => {
                let first = joints.first().map(|name| element_key(map, name, &["grip"]));
                (first.unwrap_or(0..0), "slips")
            }
            MotionFault::Massless { body, .. } => {
                let entry = map.body(body);
                let span = entry.map(|entry| entry.first_of(&["mass"]));
                (span.unwrap_or(0..0), "can move freely")
            }
            MotionFault::NoDerivatives { source, .. } => {
                (element_key(map, &source.name, &[]), "calls a function")
            }
            MotionFault::Function { source, .. } => {
                (element_key(map, source.name(), &[]), "calls a function")
            }
            _ => (map.section("simulate", ""), "in this run"),
        },
        _ => (map.section("simulate", ""), "in this run"),
    };
    at(map, span, error, label)
}

/// Returns the positions of redundant rows that prescribe different motions. These are the
/// positions of the drives, or of all rows if there are no drives.
fn contradicting(
    map: &SourceMap,
    (drives, others): (Vec<&RowLabel>, Vec<&RowLabel>),
    forcing: &[&str],
    error: &impl CodedError,
) -> Diagnostic {
    // If a row is violated because of a drive, the row itself is not wrong.
    let mut spans = forcing
        .iter()
        .take(MARKS)
        .map(|drive| element_key(map, drive, &[]));
    if let Some(first) = spans.next() {
        return spans.fold(
            at(map, first, error, "requires what cannot continue"),
            |d, span| d.and(map.text.label(span, "together with this one")),
        );
    }
    let (rows, marks) = match drives.as_slice() {
        [] => (others, ["contradicts the others", "contradicts too"]),
        [drive] => {
            let rows = std::iter::once(*drive).chain(others);
            let marks = ["requires what the others forbid", "holds it"];
            (rows.collect(), marks)
        }
        // The joints that connect the drives are not wrong.
        _ => (drives, ["contradicts the others", "contradicts too"]),
    };
    at_rows(map, rows, error, marks)
}

/// Largest number of marked positions for one error.
const MARKS: usize = 20;

fn at(map: &SourceMap, span: Range<usize>, error: &impl CodedError, label: &str) -> Diagnostic {
    Diagnostic::error(error.code(), &map.text, span, error.to_string(), label)
}

/// Creates an error that concerns several rows, with one mark for each of their joints and drives.
/// The first mark belongs to the first row.
fn at_rows<'a>(
    map: &SourceMap,
    labels: impl IntoIterator<Item = &'a RowLabel>,
    error: &impl CodedError,
    marks: [&str; 2],
) -> Diagnostic {
    let joints = labels.into_iter().map(|label| label.joint.as_str());
    at_joints(map, joints, error, marks)
}

/// Creates an error that concerns several joints and drives, with one mark for each.
fn at_joints<'a>(
    map: &SourceMap,
    names: impl IntoIterator<Item = &'a str>,
    error: &impl CodedError,
    [first_mark, mark]: [&str; 2],
) -> Diagnostic {
    let mut seen = BTreeSet::new();
    let joints = names.into_iter().filter(|name| seen.insert(*name));
    let mut spans = joints.take(MARKS).map(|name| element_key(map, name, &[]));
    let first = spans.next().unwrap_or_else(|| map.section("scene", ""));
    spans.fold(at(map, first, error, first_mark), |d, span| {
        d.and(map.text.label(span, mark))
    })
}

/// Creates a warning that concerns several joints.
pub(crate) fn warning<'a>(
    map: &SourceMap,
    code: Code,
    joints: impl IntoIterator<Item = &'a str>,
    (message, help): (&str, &str),
) -> Diagnostic {
    let joints = joints.into_iter().take(MARKS);
    let mut spans = joints.map(|name| element_key(map, name, &[]));
    let first = spans.next().unwrap_or_else(|| map.section("scene", ""));
    let warning = Diagnostic {
        severity: Severity::Warning,
        ..Diagnostic::error(code, &map.text, first, message, "here")
    };
    let warning = warning.help(help.to_owned());
    spans.fold(warning, |d, span| d.and(map.text.label(span, "and here")))
}

/// The position of the joint or drive of a row.
fn row(map: &SourceMap, label: &RowLabel) -> Range<usize> {
    element_key(map, &label.joint, &[])
}

/// Returns the position of the first of these keys in the table of a joint, drive or force. If the
/// table has none of these keys, returns the position of the name.
fn element_key(map: &SourceMap, name: &str, keys: &[&str]) -> Range<usize> {
    let entry = map.element(name);
    entry.map_or_else(|| map.section("scene", ""), |entry| entry.first_of(keys))
}

/// Returns the position of the first of these keys in the table of a body, marker or measure. If
/// the table has none of these keys, returns the position of the name.
fn place_key(map: &SourceMap, name: &str, keys: &[&str]) -> Range<usize> {
    let entry = map.places().find(|entry| entry.name == name);
    entry.map_or_else(|| map.section("scene", ""), |entry| entry.first_of(keys))
}

/// Positions of a name in the two name spaces: bodies, markers and measures; joints, drives and
/// forces.
fn uses(map: &SourceMap, name: &str) -> [Vec<Range<usize>>; 2] {
    let of = |entries: &mut dyn Iterator<Item = &Entry>| {
        let same = entries.filter(|entry| entry.name == name);
        same.map(Entry::name_span).collect()
    };
    [of(&mut map.places()), of(&mut map.elements())]
}

/// Creates one diagnostic for each use of a name after the first use, in the order of the file.
pub(crate) fn duplicates(
    map: &SourceMap,
    uses: &[Range<usize>],
    error: &BuildError,
) -> Vec<Diagnostic> {
    let mut uses = uses.to_vec();
    uses.sort_by_key(|span| span.start);
    let Some((first, later)) = uses.split_first() else {
        return Vec::new();
    };
    let first = map.text.label(first.clone(), "first used here");
    let again =
        |span: &Range<usize>| at(map, span.clone(), error, "used again here").and(first.clone());
    later.iter().map(again).collect()
}

/// The position of a wrong number of the body with this name.
fn body_key(
    map: &SourceMap,
    d: &AnyDescription,
    name: &str,
    field: &str,
    fault: impl Fn(f64) -> bool,
) -> Range<usize> {
    let records = d.bodies();
    let mut of_name = records.iter().zip(&map.bodies);
    let is_wrong =
        |body: &BodyRecord| body.name == name && body.numbers(field).into_iter().any(&fault);
    let found = of_name.find(|(body, _)| is_wrong(body));
    let key = field.replace(' ', "_");
    found.map_or(0..0, |(_, entry)| entry.span(&key))
}

/// Returns the position of the wrong bodies of the element with this name. The bodies of a drive
/// are the bodies of its joint.
fn connection(
    map: &SourceMap,
    d: &AnyDescription,
    name: &str,
    fault: impl Fn(&[BodyRef]) -> bool,
) -> Range<usize> {
    let mut elements = d.connections().zip(map.elements());
    let found = elements.find(|((of, bodies), _)| *of == name && fault(bodies));
    found.map_or(0..0, |(_, entry)| {
        entry.first_of(&["bodies", "body", "joint"])
    })
}
