//! `armature`: the inertia of a rotor that rotates with a joint coordinate.

use joints::spec::{ConstraintSpec, Measure};
use model::Armature;

use crate::dimension::Dimension;
use crate::field::Field;
use crate::joint_measure::Purpose;
use crate::joint_read::JointRead;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::nearest::list;
use crate::space::SceneSpace;
use crate::table::Table;

const NUMBER: &str = "a number ≥ 0";
const TABLE: &str = "a table with a number ≥ 0 for each joint coordinate";

/// The key of a joint with one joint coordinate.
const ARMATURE: Key =
    Key::optional("armature", NUMBER, Takes::Number(Interval::NotNegative)).doc(
        "Inertia a of a rotor that rotates with the joint coordinate s, for example of a geared motor (its own inertia times the square of the gear ratio): the kinetic energy contains ½·a·ṡ²; kg·m² for an angle, kg for a displacement. Gyroscopic terms of the rotor are neglected",
    );

/// The key of a joint with several joint coordinates.
const ARMATURES: Key = Key::optional("armature", TABLE, Takes::Inertias).doc(
    "Inertias of rotors that rotate with the joint coordinates, as { COORDINATE = a }: the kinetic energy contains ½·a·ṡ² for each; kg·m² for an angle, kg for a displacement. Gyroscopic terms of the rotors are neglected",
);

/// The joint coordinates that can have an armature. A coordinate that the joint keeps constant
/// cannot have one.
fn measures(spec: &ConstraintSpec) -> impl Iterator<Item = &'static Measure> + Clone {
    spec.measures.iter().filter(|measure| !measure.is_kept)
}

/// The key of a joint with this definition; `None` if the joint cannot have an armature.
pub(crate) fn key(spec: &ConstraintSpec) -> Option<Key> {
    match measures(spec).count() {
        0 => None,
        1 => Some(ARMATURE),
        _ => Some(ARMATURES),
    }
}

/// Returns the value of the key. A joint without joint coordinates does not have the key, but the
/// value is returned nevertheless, because [`read`] explains the error.
pub(crate) fn field<'t>(table: &mut Table<'t>, spec: &ConstraintSpec) -> Option<Field<'t>> {
    let is_read = key(spec).is_some() || table.has(ARMATURE.name);
    is_read.then(|| table.optional(&ARMATURE)).flatten()
}

/// Reads the armatures of a joint from the value of its key.
pub(crate) fn read<S: SceneSpace>(field: &Field, joint: &JointRead<'_, S>) -> Vec<Armature<S>> {
    let Some(definition) = joint.definition() else {
        return Vec::new();
    };
    let scene_type = definition.spec.common.scene_type;
    let is_table = field.value.get_ref().is_table();
    let mut of_measures = measures(definition.spec);
    let names = || list(measures(definition.spec).map(|measure| measure.name));
    match (of_measures.clone().count(), is_table) {
        (0, _) => {
            field.error_with_help(
                Mistake::UnknownMeasure,
                format!(": a joint of type `{scene_type}` has no joint coordinate that can have an armature"),
                "an inertia of a joint coordinate",
                "remove `armature`, and add the inertia to a body of the joint".to_owned(),
            );
            return Vec::new();
        }
        (1, true) => {
            field.error_with_help(
                Mistake::Type,
                format!(": `armature` must be {NUMBER}, because the joint has one coordinate"),
                "a table",
                "write `armature = …`".to_owned(),
            );
            return Vec::new();
        }
        (1, false) => {
            let armature = of_measures
                .next()
                .and_then(|measure| one(field, joint, measure));
            return armature.into_iter().collect();
        }
        (_, false) => {
            let help = format!("its joint coordinates are {}", names());
            field.error_with_help(
                Mistake::Type,
                format!(": `armature` must be {TABLE}, because the joint has several coordinates"),
                "which coordinate?",
                of_measures.next().map(|measure| {
                    format!("write `armature = {{ {} = … }}`; {help}", measure.name)
                }),
            );
            return Vec::new();
        }
        (_, true) => {}
    }
    let Some(mut table) = field.table(TABLE) else {
        return Vec::new();
    };
    let read = of_measures.filter_map(|measure| {
        let field = table.optional(measure.name)?;
        one(&field, joint, measure)
    });
    let read = read.collect();
    table.close();
    read
}

/// Reads the armature of one joint coordinate.
fn one<S: SceneSpace>(
    field: &Field,
    joint: &JointRead<'_, S>,
    measure: &Measure,
) -> Option<Armature<S>> {
    let coordinate = joint.measure(Some(measure.name), Purpose::Drive, field)?;
    let unit = match coordinate.dimension {
        Dimension::ANGLE => Dimension::INERTIA,
        _ => Dimension::MASS,
    };
    let inertia = field.number_expected(NUMBER, unit)?;
    if inertia < 0.0 {
        let message = format!(": `{}` is {inertia}, need {NUMBER}", field.key);
        field.error(Mistake::OutOfRange, message, "an inertia is not negative");
        return None;
    }
    let (bodies, element) = coordinate.rows(field)?;
    Some(Armature {
        joint: joint.name.clone(),
        bodies,
        element,
        inertia,
    })
}
