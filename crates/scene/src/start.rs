//! `[start]`: options of the start.

use std::collections::HashMap;

use model::StartOptions;
use model::start::{Coordinate, CorrectionLimit, KeepLevel};
use serde_json::json;

use crate::body::{Bodies, GROUND};
use crate::field::Field;
use crate::findings::Findings;
use crate::key::{Key, Takes};
use crate::mistake::Mistake;
use crate::nearest::{did_you_mean, list};
use crate::table::Table;

/// Coordinates and velocities of a planar body by name.
const COORDINATES: [(&str, usize, KeepLevel); 6] = [
    ("x", 0, KeepLevel::Position),
    ("y", 1, KeepLevel::Position),
    ("angle", 2, KeepLevel::Position),
    ("vx", 0, KeepLevel::Velocity),
    ("vy", 1, KeepLevel::Velocity),
    ("omega", 2, KeepLevel::Velocity),
];

const KEEP: Key = Key::optional(
    "keep",
    "a list of coordinates [\"body.angle\", …]",
    Takes::Texts(0),
)
.doc("Coordinates and velocities that the start holds exactly, as \"crank.angle\": x, y, angle, vx, vy, omega of a body; a velocity that is not given is held at zero")
.or(|| json!([]));
const ALLOW_CORRECTION: Key = Key::optional("allow_correction", "true or false", Takes::Flag)
    .doc("Whether the start may be corrected by more than a thousandth of the scene's size, and given velocities by more than a thousandth of the fastest that hang together with them")
    .or(|| false.into());

/// Keys of the section.
pub(crate) const KEYS: [Key; 2] = [KEEP, ALLOW_CORRECTION];

/// Reads the section.
pub(crate) fn read(mut table: Table, bodies: &Bodies, findings: &mut Findings) -> StartOptions {
    let mut kept: Vec<Coordinate> = Vec::new();
    let mut named = HashMap::new();
    let items = table
        .optional(&KEEP)
        .and_then(|field| field.items(KEEP.expected, findings))
        .unwrap_or_default();
    for item in items {
        let Some(coordinate) = coordinate(&item, bodies, findings) else {
            continue;
        };
        let Coordinate { body, dof, level } = coordinate;
        let thing = (body, dof, level == KeepLevel::Position);
        let twice = "`[start]`: `keep` names a coordinate twice";
        if findings.is_first(&mut named, thing, item.span(), twice) {
            kept.push(coordinate);
        }
    }
    let allowed = table
        .optional(&ALLOW_CORRECTION)
        .and_then(|field| field.boolean(findings));
    table.close(findings);
    StartOptions {
        keep: kept,
        // Positions are given with the bodies.
        correction: match allowed {
            Some(true) => CorrectionLimit::Any,
            _ => CorrectionLimit::Small,
        },
    }
}

/// Parses a coordinate such as `body.angle`.
fn coordinate(item: &Field, bodies: &Bodies, findings: &mut Findings) -> Option<Coordinate> {
    const EXPECTED: &str = "a coordinate of a body, as \"crank.angle\"";
    let text = item.text(EXPECTED, findings)?;
    let Some((body, name)) = text.rsplit_once('.') else {
        item.mismatch(EXPECTED, findings);
        return None;
    };
    if body == GROUND {
        findings.error(
            Mistake::UnknownCoordinate,
            item.span(),
            "`[start]`: `keep` names the ground, which has no coordinates",
            "the ground does not move",
        );
        return None;
    }
    let at = bodies.position(body);
    if at.is_none() {
        bodies.unknown(item.span(), "`[start]`", body, findings);
    }
    let found = COORDINATES.iter().find(|(known, ..)| *known == name);
    if found.is_none() {
        let names = || COORDINATES.iter().map(|(known, ..)| *known);
        findings.error_with_help(
            Mistake::UnknownCoordinate,
            item.span(),
            format!("`[start]`: `keep` names the unknown coordinate `{name}`"),
            "no such coordinate",
            did_you_mean(name, names()).or(Some(format!("there are {}", list(names())))),
        );
    }
    let &(_, dof, level) = found?;
    Some(Coordinate {
        body: at?,
        dof,
        level,
    })
}
