//! `[[drive]]`: a drive prescribes a joint coordinate as a function of time, or it applies a load
//! along the joint coordinate. A force law defines the load.

use joints::spec::Unit;
use model::codes::Code;
use model::{Drive, Force, Function, Law};
use toml::de::DeValue;

use crate::active;
use crate::dimension::Dimension;
use crate::element;
use crate::field::Field;
use crate::function::{self, Domain};
use crate::joint_measure::Purpose;
use crate::joint_name::JointNames;
use crate::key::{Key, TYPE, Takes};
use crate::mistake::Mistake;
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;

const JOINT: Key =
    Key::required("joint", "the name of a joint", Takes::Text).doc("The joint that is driven");
const MOTION: Key = Key::optional("motion", "a function of time", Takes::Function)
    .doc("The measure is its initial value + f(t) − f(0); a number keeps it constant (rad or m)");
const FORCE: Key = Key::optional("force", LAW, Takes::Law)
    .doc("A law in place of `motion`: the force (N) along a length, of `measure`, `rate` and `t`");
const TORQUE: Key = Key::optional("torque", LAW, Takes::Law).doc(
    "A law in place of `motion`: the torque (N·m) along an angle, of `measure`, `rate` and `t`",
);
const LAW: &str = "a number or an expression of `measure`, `rate` and `t`";

/// Keys of a drive, except its name and its type. A drive has a joint, and either a motion or a
/// force law.
pub(crate) const DRIVE_KEYS: [Key; 4] = [JOINT, MOTION, FORCE, TORQUE];

/// Description of the value of the type of a drive.
pub(crate) const MEASURE: &str = "a measure of the joint";

/// A drive of the text; parts that could not be read are missing.
pub(crate) struct DriveRead<S: SceneSpace> {
    pub(crate) name: String,
    pub(crate) is_active: bool,
    pub(crate) action: Action<S>,
    /// The joint that the drive replaces. There is such a joint if its rows keep the joint
    /// coordinate constant.
    pub(crate) in_place_of: Option<String>,
}

impl<S: SceneSpace> DriveRead<S> {
    /// The drive with a prescribed motion, if it could be read.
    pub(crate) fn motion(&self) -> Option<&Drive<S>> {
        match &self.action {
            Action::Motion(Some((drive, _))) => Some(drive),
            Action::Motion(None) | Action::Law(_) => None,
        }
    }

    /// The drive with a prescribed motion, and its position in the text.
    pub(crate) fn into_motion(self) -> Option<(Drive<S>, Entry)> {
        match self.action {
            Action::Motion(motion) => motion,
            Action::Law(_) => None,
        }
    }
}

/// Action of a drive on its joint coordinate, if it could be read.
pub(crate) enum Action<S: SceneSpace> {
    /// The drive prescribes the joint coordinate.
    Motion(Option<(Drive<S>, Entry)>),
    /// The drive applies a load along the joint coordinate.
    Law(Option<(Force<S>, Entry)>),
}

/// Reads one drive. Two drives of the same joint coordinate are redundant, which is not an error.
pub(crate) fn read<S: SceneSpace>(
    mut table: Table,
    name: &str,
    joints: &JointNames<S>,
    domains: &mut Vec<Domain>,
) -> DriveRead<S> {
    let is_active = active::read(&table);
    let joint = table.required(&JOINT);
    let joint = joint.and_then(|field| joints.one(&field, (Purpose::Drive, is_active)));
    let field = table.needed(TYPE, MEASURE);
    let measure = field.and_then(|field| {
        let name = field.text(MEASURE)?;
        let measure = joint?.measure(Some(name), Purpose::Drive, &field)?;
        Some((measure, field))
    });
    let dimension = measure.as_ref().map(|(measure, _)| measure.dimension);
    let laws = [FORCE, TORQUE].map(|key| table.optional(&key));
    let motion = match &laws {
        [None, None] => table.required(&MOTION),
        _ => table.optional(&MOTION),
    };
    let is_law = laws.iter().any(Option::is_some);
    let (mut drive, mut force) = (None, None);
    match (motion, laws) {
        (Some(field), [None, None]) => {
            let mut own = Vec::new();
            let motion = motion_of(&field, dimension, &mut own);
            if is_active {
                domains.append(&mut own);
            }
            drive = measure
                .as_ref()
                .zip(motion)
                .and_then(|((measure, field), motion)| {
                    let (bodies, element) = measure.rows(field)?;
                    Some(Drive {
                        name: name.to_owned(),
                        bodies,
                        element,
                        motion,
                        tolerance: measure.tolerance(),
                    })
                });
        }
        (None, [Some(field), None] | [None, Some(field)]) => {
            let law = read_law(&field, dimension);
            let acting = measure.as_ref().zip(law);
            force = acting.and_then(|((measure, field), law)| measure.force(name, law, field));
        }
        (None, [None, None]) => {}
        _ => {
            let message = format!(
                "{} has several of `motion`, `force` and `torque`",
                table.subject
            );
            let label = "a drive has either a motion or a force law";
            table
                .findings
                .error(Mistake::Exclusive, table.header.clone(), message, label);
        }
    }
    let is_complete = drive.is_some() || force.is_some();
    let replaced = measure.map(|(measure, _)| measure);
    let replaced = replaced.filter(|own| own.spec.is_kept && is_active && is_complete);
    let entry = element::end(table, name, is_active);
    DriveRead {
        name: name.to_owned(),
        is_active,
        action: if is_law {
            Action::Law(force.map(|force| (force, entry)))
        } else {
            Action::Motion(drive.map(|drive| (drive, entry)))
        },
        in_place_of: replaced.map(|measure| measure.joint.name.clone()),
    }
}

/// Reads the motion of a joint coordinate of this dimension.
fn motion_of(
    field: &Field,
    dimension: Option<Dimension>,
    domains: &mut Vec<Domain>,
) -> Option<Function> {
    let of = dimension.unwrap_or(Dimension::UNKNOWN);
    let motion = function::read(field, of, domains)?;
    if motion.is_constant() && field.may_be_number() {
        warn_if_held(field, &motion);
    }
    Some(motion)
}

/// Reads a force law along a joint coordinate of this dimension.
fn read_law(field: &Field, of: Option<Dimension>) -> Option<Law> {
    let of = of?;
    let (result, key) = if of == Dimension::ANGLE {
        (Unit::Torque.into(), TORQUE.name)
    } else {
        (Unit::Force.into(), FORCE.name)
    };
    if field.key != key {
        field.error_with_help(
            Mistake::OtherLoad,
            format!(": `{}` does not act along {}", field.key, of.words()),
            "another kind of load is needed",
            format!("write `{key} = …`"),
        );
        return None;
    }
    field.law(LAW, of, result)
}

/// Warns about a motion that is a constant other than zero. The author may have intended the
/// constant as a speed or a position, but the motion of a drive is f(t) − f(0).
fn warn_if_held(motion: &Field, function: &Function) {
    let [held, ..] = function.jet(0.0);
    if held == 0.0 {
        return;
    }
    // The value is written as in the text, because the advice is in the units of the scene.
    let value = match motion.value.get_ref() {
        DeValue::String(text) => format!("{text:?}"),
        DeValue::Integer(number) => number.as_str().to_owned(),
        DeValue::Float(number) => number.as_str().to_owned(),
        _ => held.to_string(),
    };
    motion.findings.warning(
        const { Code::new(191) },
        motion.span(),
        format!(
            "{}: `motion = {value}` is constant, and a drive follows f(t) − f(0), so the measure is held at its initial value",
            motion.subject
        ),
        "holds the measure",
        &format!(
            "for a stroke write `motion = {{ type = \"steps\", steps = [{{ from = 0, to = 1, by = {value} }}] }}`, for a constant speed `motion = {{ type = \"constant-rate\", rate = {value} }}`, to hold the measure `motion = 0`"
        ),
    );
}
