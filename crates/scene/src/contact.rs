//! `one_sided`, `toward`, `grip` and `load`: limits on the reaction of a joint.

use joints::Argument;
use joints::spec::ConstraintSpec;
use model::{ContactLimits, Grip, GripLoad, OpenSide};

use crate::dimension::Dimension;
use crate::field::Field;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::table::Table;

/// Sine of an angle between a line and a direction. If the angle is larger, the direction selects
/// one side of the line. Directions to computed points are along the line only to within rounding.
const ALONG: f64 = 1e-9;

/// Values of `one_sided`.
const WAYS: [&str; 2] = ["pushes", "pulls"];

const ONE_SIDED: Key = Key::optional("one_sided", "\"pushes\" or \"pulls\"", Takes::OneOf(|| WAYS.to_vec()))
    .doc("The joint only pushes its second body (or its only one) along the normal, or only pulls it; the ends of a `distance` apart, or together [default: it pushes and pulls]");
const TOWARD: Key = Key::pair("toward")
    .doc("A direction to the side of the line on which the body is; `one_sided` needs it");
const GRIP: Key = Key::optional("grip", "a number ≥ 0", Takes::Number(Interval::NotNegative))
    .doc("Coefficient of friction: the contact slips if the force along it is more than this multiple of the force that presses it [default: it never slips]");
const LOAD: Key = Key::optional("load", "a force (N), or the name of a one-sided joint", Takes::Load)
    .unit(Dimension::FORCE)
    .doc("The force that presses the contact: a number, or the name of a one-sided joint [default: the force of the contact, which is one-sided]");

/// The keys of a joint with this definition.
pub(crate) fn keys(spec: &ConstraintSpec) -> Vec<Key> {
    let keys = [
        (ONE_SIDED, spec.has_gap()),
        (TOWARD, spec.is_gap_of_line()),
        (GRIP, spec.can_slip()),
        (LOAD, spec.can_slip()),
    ];
    keys.into_iter()
        .filter(|(_, takes)| *takes)
        .map(|(key, _)| key)
        .collect()
}

/// Reads the keys of a joint with this definition and these values of its parameters.
pub(crate) fn read(
    table: &mut Table,
    spec: &ConstraintSpec,
    arguments: &[Argument],
) -> ContactLimits {
    let mut limits = ContactLimits::default();
    if spec.has_gap() {
        limits.open_side = open_side(table, spec, arguments);
    }
    if spec.can_slip() {
        limits.grip = grip(table);
    }
    limits
}

fn open_side(table: &mut Table, spec: &ConstraintSpec, arguments: &[Argument]) -> Option<OpenSide> {
    let field = table.optional(&ONE_SIDED);
    let toward = spec.is_gap_of_line().then(|| table.optional(&TOWARD));
    let Some(field) = field else {
        if let Some(field) = toward.flatten() {
            let message = ": `toward` is the side of a one-sided joint";
            field.error(Mistake::Missing, message, "add `one_sided`, or remove it");
        }
        return None;
    };
    // A joint with a mistake in these keys counts as one-sided, so that a `load` may name this
    // joint.
    Some(side(table, &field, toward, arguments).unwrap_or(OpenSide::Positive))
}

/// Returns the side of the joint, or reports why the side is not known.
fn side(
    table: &Table,
    field: &Field<'_>,
    toward: Option<Option<Field<'_>>>,
    arguments: &[Argument],
) -> Option<OpenSide> {
    let pushes = match field.text(ONE_SIDED.expected)? {
        "pushes" => true,
        "pulls" => false,
        other => {
            let message = format!(": `one_sided` is `{other}`");
            let expected = format!("expected {}", ONE_SIDED.expected);
            field.error(Mistake::UnknownChoice, message, expected);
            return None;
        }
    };
    let along_gap = match toward {
        None => true,
        Some(None) => {
            let message = " needs `toward`: the side of the line on which the body is";
            table.missing(message, "add `toward = [x, y]`");
            return None;
        }
        Some(Some(field)) => {
            let [x, y] =
                <[f64; 2]>::try_from(field.numbers(2, TOWARD.expected, |_| TOWARD.unit)?).ok()?;
            let mut lines = arguments.iter().filter_map(|argument| match argument {
                Argument::Pairs(line) => Some(*line),
                _ => None,
            });
            let [[x0, y0], [x1, y1]] = lines.next_back()?;
            // The gap is measured along the line turned by a quarter to the left.
            let across = (x1 - x0) * y - (y1 - y0) * x;
            let size = (x1 - x0).hypot(y1 - y0) * x.hypot(y);
            if across.abs() <= ALONG * size {
                let message = match size {
                    0.0 => ": `toward` is zero",
                    _ => ": `toward` points along the line",
                };
                let label = "need a direction to the side of the line on which the body is";
                field.error(Mistake::NoDirection, message, label);
                return None;
            }
            across > 0.0
        }
    };
    Some(if pushes == along_gap {
        OpenSide::Positive
    } else {
        OpenSide::Negative
    })
}

fn grip(table: &mut Table) -> Option<Grip> {
    let field = table.optional(&GRIP);
    let load = table.optional(&LOAD);
    let friction = field
        .as_ref()
        .and_then(|field| field.number_expected(GRIP.expected, GRIP.unit));
    let Some(load) = load else {
        let load = GripLoad::Own;
        return Some(Grip {
            friction: friction?,
            load,
        });
    };
    if field.is_none() {
        let message = ": `load` presses a contact with `grip`";
        load.error(Mistake::Missing, message, "add `grip`");
        return None;
    }
    // A text that is an expression, or starts like a number, is a force.
    let is_number = |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let name = load.value.get_ref().as_str();
    let name = name.filter(|text| !is_number(text) && !load.is_expression());
    let load = match name {
        Some(name) => GripLoad::Joint(name.to_owned()),
        None => GripLoad::Constant(load.number_expected(LOAD.expected, LOAD.unit)?),
    };
    Some(Grip {
        friction: friction?,
        load,
    })
}
