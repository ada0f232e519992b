//! Joints of the type `coupling`: a measure of one joint follows a measure of another.

use model::coupling::Measured;

use crate::active;
use crate::dimension::Dimension;
use crate::field::Field;
use crate::findings::Findings;
use crate::joint::{JointNames, Known, Read, dimension, must_be_active, of_name};
use crate::key::{Interval, Key, TYPE, Takes};
use crate::mistake::Mistake;
use crate::nearest::{list, nearest};
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;
use crate::tolerance;

const TWO_MEASURES: &str = "two measures [\"A.angle\", \"B.displacement\"]";
const MEASURES: Key = Key::required("measures", TWO_MEASURES, Takes::Texts(2)).doc(
    "Two measures of joints, each `joint.measure`: the second follows the first, both since the start",
);
const RATIO: Key = Key::required("ratio", "a number", Takes::Number(Interval::Any))
    .doc("Change of the second measure over that of the first; per radian or metre of the first");
const COEFFICIENTS: Key = Key::optional("coefficients", "a list of numbers", Takes::Numbers(1)).doc(
    "Coefficients of the square, the cube, … of the change of the first measure, which are added",
);

/// Keys of a coupling in addition to its name and its type.
pub(crate) const KEYS: [Key; 3] = [MEASURES, RATIO, COEFFICIENTS];

/// Reads one coupling.
pub(crate) fn read<'r, S: SceneSpace>(
    mut table: Table,
    name: String,
    joints: &JointNames<'_, 'r, S>,
    findings: &mut Findings,
) -> Read<'r, S> {
    let mut known = Known::named(&name, &table);
    known.is_coupling = true;
    let _ = table.optional(TYPE);
    let field = table.required(&MEASURES, findings);
    let measures = field
        .as_ref()
        .and_then(|field| measures(field, joints, findings));
    let [of_x, of_y] = match &measures {
        Some([x, y]) => [x.1, y.1],
        None => [Dimension::UNKNOWN; 2],
    };
    let per = |power: i8| of_y.times(of_x, -power);
    let ratio = table
        .required(&RATIO, findings)
        .and_then(|field| field.number(per(1), findings));
    let more = table.optional(&COEFFICIENTS).map(|field| {
        let power = |k: usize| i8::try_from(k + 2).unwrap_or(i8::MAX);
        field.any_numbers(|k| per(power(k)), findings)
    });
    known.tolerance = tolerance::read(&mut table, &tolerance::OF_JOINT, findings);
    known.is_active = active::read(&mut table, findings);
    if let (Some(field), true) = (&field, known.is_active) {
        for joint in joints_of(field, joints) {
            must_be_active(
                &table.subject,
                "couples",
                field.span(),
                Some(joint),
                findings,
            );
        }
    }
    let entry = Entry::switched(&name, &table, known.is_active);
    table.close(findings);
    let (Some(field), Some([x, y]), Some(ratio)) = (field, measures, ratio) else {
        return (known, None);
    };
    let more = match more {
        Some(None) => return (known, None),
        Some(Some(more)) => more,
        None => Vec::new(),
    };
    let coefficients = [vec![ratio], more].concat();
    match S::couple([x.0, y.0], &coefficients) {
        Ok((bodies, element)) => {
            let joint = model::Joint {
                name,
                bodies,
                element,
                functions: Vec::new(),
                tolerance: known.tolerance,
            };
            (known, Some((joint, entry)))
        }
        Err(error) => {
            findings.error(
                Mistake::UnknownMeasure,
                field.span(),
                format!("joint `{name}`: {error}"),
                "these cannot be coupled",
            );
            (known, None)
        }
    }
}

/// Both measures, with their dimensions.
fn measures<S: SceneSpace>(
    field: &Field,
    joints: &JointNames<S>,
    findings: &mut Findings,
) -> Option<[(Measured<S>, Dimension); 2]> {
    let items = field.items(TWO_MEASURES, findings)?;
    if items.len() != 2 {
        field.miscount(TWO_MEASURES, items.len(), 2, findings);
        return None;
    }
    let read = [0, 1].map(|k| measure(&items[k], joints, findings));
    let [Some(x), Some(y)] = read else {
        return None;
    };
    Some([x, y])
}

/// The joints that are named, as far as they exist.
fn joints_of<'j, 'r, S: SceneSpace>(
    field: &Field,
    joints: &JointNames<'j, 'r, S>,
) -> Vec<&'j Known<'r, S>> {
    let items = field.value.get_ref().as_array();
    let texts = items
        .into_iter()
        .flatten()
        .filter_map(|item| item.get_ref().as_str());
    let names = texts.filter_map(|text| Some(text.rsplit_once('.')?.0));
    names.filter_map(|name| joints.get(name)).collect()
}

/// A measure of a joint, written `joint.measure`; names of joints may have dots themselves.
fn measure<S: SceneSpace>(
    item: &Field,
    joints: &JointNames<S>,
    findings: &mut Findings,
) -> Option<(Measured<S>, Dimension)> {
    let text = item.text(TWO_MEASURES, findings)?;
    let Some((name, measure)) = text.rsplit_once('.') else {
        findings.error(
            Mistake::UnknownMeasure,
            item.span(),
            format!("{}: `{text}` is no measure of a joint", item.subject),
            "write `joint.measure`, for example \"A.angle\"",
        );
        return None;
    };
    let joint = of_name(name, item, joints, findings)?;
    let Some(definition) = joint.definition else {
        if joint.is_coupling {
            findings.error(
                Mistake::UnknownMeasure,
                item.span(),
                format!(
                    "{}: `{name}` is a coupling, which has no measure",
                    item.subject
                ),
                "couple the measures of its joints",
            );
        }
        return None;
    };
    let names = || definition.spec.measures.iter().map(|m| m.name);
    let Some(at) = names().position(|known| known == measure) else {
        let label = match nearest(measure, names()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "no such measure".to_owned(),
        };
        let help = match names().next() {
            Some(_) => format!("its measures are {}", list(names())),
            None => "joints of this type have no measure".to_owned(),
        };
        findings.error_with_help(
            Mistake::UnknownMeasure,
            item.span(),
            format!(
                "{}: joint `{name}` (`{}`) has no measure `{measure}`",
                item.subject, definition.spec.common.scene_type
            ),
            label,
            Some(help),
        );
        return None;
    };
    let drive = definition.drives.get(at)?;
    let (bodies, arguments) = joint.with_motion()?;
    let kernels = (drive.build)(&arguments).ok()?;
    Some(((bodies, kernels), dimension(joint, measure)?))
}
