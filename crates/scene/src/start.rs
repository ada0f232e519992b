//! `[start]`: options for the computation of the initial state.

use std::collections::HashMap;

use model::StartOptions;
use model::start::{Coordinate, CorrectionLimit, KeepLevel};
use serde_json::json;

use crate::body::{BodyNames, GROUND};
use crate::dimension::Dimension;
use crate::field::Field;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::nearest::{did_you_mean, list};
use crate::simulate::bounded;
use crate::space::{BodyCoordinate, SceneSpace};
use crate::table::Table;

const KEEP: Key = Key::optional(
    "keep",
    "a list of coordinates [\"body.angle\", …]",
    Takes::Texts(0),
)
.doc("Coordinates and velocities that the start keeps exactly, as \"crank.angle\": x, y, angle, vx, vy, omega of a body, in space x, y, z, rotation, vx, vy, vz, wx, wy, wz (ground axes), omega for these three; a velocity that is not given is held at zero")
.or(|| json!([]));
const ALLOW_CORRECTION: Key = Key::optional("allow_correction", "true or false", Takes::Flag)
    .doc("Whether the start may be corrected by more than a thousandth of the scene's size, and given velocities by more than a thousandth of the fastest that hang together with them")
    .or(|| false.into());

const TIME: Key = Key::optional(
    "time",
    "a finite time ≥ 0",
    Takes::Number(Interval::NotNegative),
)
.unit(Dimension::TIME)
.doc("Time of the start, at which runs begin; the described configuration belongs to the time 0")
.or(|| json!(0.0));

/// Keys of the section.
pub(crate) const KEYS: [Key; 3] = [KEEP, ALLOW_CORRECTION, TIME];

/// Reads the section: the options of the start, and its time (s).
pub(crate) fn read<S: SceneSpace>(mut table: Table, bodies: &BodyNames) -> (StartOptions, f64) {
    let mut keep: Vec<Coordinate> = Vec::new();
    let mut named = HashMap::new();
    for item in table.items(&KEEP) {
        let Some((body, found)) = coordinate::<S>(&item, bodies) else {
            continue;
        };
        let BodyCoordinate { dofs, level, .. } = found;
        let twice = "`[start]`: `keep` names a coordinate twice";
        for dof in dofs.clone() {
            let level = *level;
            let thing = (body, dof, level == KeepLevel::Position);
            if !table
                .findings
                .is_first(&mut named, thing, item.span(), twice)
            {
                break;
            }
            keep.push(Coordinate { body, dof, level });
        }
    }
    let allowed = table.flag(&ALLOW_CORRECTION);
    let time = table
        .optional(&TIME)
        .and_then(|field| bounded(&field, &TIME));
    table.close();
    let options = StartOptions {
        keep,
        correction: match allowed {
            Some(true) => CorrectionLimit::Any,
            _ => CorrectionLimit::Small,
        },
        // The initial poses are given in the tables of the bodies.
        poses: Vec::new(),
        state: None,
    };
    (options, time.unwrap_or_default())
}

/// Parses a coordinate such as `body.angle`.
fn coordinate<S: SceneSpace>(
    item: &Field,
    bodies: &BodyNames,
) -> Option<(usize, &'static BodyCoordinate)> {
    const EXPECTED: &str = "a coordinate of a body, as \"crank.angle\"";
    let text = item.text(EXPECTED)?;
    let Some((body, name)) = text.rsplit_once('.') else {
        item.mismatch(EXPECTED);
        return None;
    };
    if body == GROUND {
        item.findings.error(
            Mistake::UnknownCoordinate,
            item.span(),
            "`[start]`: `keep` names the ground, which has no coordinates",
            "the ground does not move",
        );
        return None;
    }
    let at = bodies.position(body);
    if at.is_none() {
        bodies.unknown(item, body);
    }
    let found = S::COORDINATES.iter().find(|known| known.name == name);
    if found.is_none() {
        let names = || S::COORDINATES.iter().map(|known| known.name);
        item.findings.error_with_help(
            Mistake::UnknownCoordinate,
            item.span(),
            format!("`[start]`: `keep` names the unknown coordinate `{name}`"),
            "no such coordinate",
            did_you_mean(name, names()).or(Some(format!("there are {}", list(names())))),
        );
    }
    Some((at?, found?))
}
