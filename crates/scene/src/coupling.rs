//! Joints of the type `coupling`: one joint coordinate depends on a joint coordinate of another
//! joint.

use model::coupling::AttachedConstraint;

use crate::dimension::Dimension;
use crate::joint_measure::Purpose;
use crate::joint_name::References;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::space::SceneSpace;
use crate::table::Table;

const TWO_MEASURES: &str = "two measures [\"A.angle\", \"B.displacement\"]";
const MEASURES: Key = Key::required("measures", TWO_MEASURES, Takes::Texts(2)).doc(
    "Two measures of joints, each `joint.measure`: the second follows the first, both since the start",
);
const RATIO: Key = Key::required("ratio", "a number", Takes::Number(Interval::Any))
    .doc("Change of the second measure over that of the first; per radian or metre of the first");
const COEFFICIENTS: Key = Key::optional("coefficients", "a list of numbers", Takes::Numbers(1)).doc(
    "Coefficients of the square, the cube, … of the change of the first measure, which are added",
);

/// Keys of a coupling, except its name and its type.
pub(crate) const KEYS: [Key; 3] = [MEASURES, RATIO, COEFFICIENTS];

/// Reads one coupling; `None` if it could not be read.
pub(crate) fn read<S: SceneSpace>(
    table: &mut Table,
    references: &References<'_, '_, '_, S>,
) -> Option<AttachedConstraint<S>> {
    let usage = (Purpose::Couple, references.is_active);
    let field = table.required(&MEASURES);
    let measures = field.as_ref().and_then(|field| {
        let joints = references.joints;
        joints.two_measures(field, TWO_MEASURES, usage)
    });
    let dimensions = match &measures {
        Some(measures) => measures.each_ref().map(|measure| measure.dimension),
        None => [Dimension::UNKNOWN; 2],
    };
    let [of_x, of_y] = dimensions;
    let per = |power: i8| of_y.times(of_x, -power);
    let ratio = table.of_key(&RATIO).and_then(|field| field.number(per(1)));
    let more = table
        .optional(&COEFFICIENTS)
        .map_or(Some(Vec::new()), |field| {
            let power = |k: usize| i8::try_from(k + 2).unwrap_or(i8::MAX);
            field.any_numbers(|k| per(power(k)))
        });
    let (field, [x, y]) = (field?, measures?);
    let coefficients = [vec![ratio?], more?].concat();
    let measures = [x.rows(&field)?, y.rows(&field)?];
    let couple = S::couple(measures, &coefficients);
    let refuse = |error| {
        field.error(
            Mistake::UnknownMeasure,
            format!(": {error}"),
            "these cannot be coupled",
        );
    };
    couple.map_err(refuse).ok()
}
