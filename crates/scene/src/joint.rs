//! `[[joint]]` and `[[drive]]`: constraints of the registry, and prescribed measures of joints.

use std::collections::HashMap;
use std::ops::Range;

use joints::Argument;
use joints::spec::Unit;
use model::codes::Code;
use model::registry::ConstraintDefinition;
use model::{BodyRef, Drive, Force, Function, Joint, Law};

use crate::active;
use crate::bodies::Bodies;
use crate::connection;
use crate::dimension::Dimension;
use crate::element::{self, Types};
use crate::field::Field;
use crate::findings::Findings;
use crate::force::Forces;
use crate::function::{self, Domain};
use crate::key::{Key, TYPE, Takes};
use crate::mistake::Mistake;
use crate::nearest::{all, list, nearest};
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;
use crate::tolerance;

pub(crate) const JOINT: Key =
    Key::required("joint", "the name of a joint", Takes::Text).doc("The joint that is driven");
const MOTION: Key = Key::optional("motion", "a function of time", Takes::Function)
    .doc("The measure is its initial value + f(t) − f(0); a number holds it (rad or m)");
const FORCE: Key = Key::optional("force", LAW, Takes::Law)
    .doc("A law in place of `motion`: the force (N) along a length, of `measure`, `rate` and `t`");
const TORQUE: Key = Key::optional("torque", LAW, Takes::Law).doc(
    "A law in place of `motion`: the torque (N·m) along an angle, of `measure`, `rate` and `t`",
);
const LAW: &str = "a number or an expression of `measure`, `rate` and `t`";

/// Keys of a drive in addition to its name and its type: a motion, or one of the laws.
pub(crate) const DRIVE_KEYS: [Key; 4] = [JOINT, MOTION, FORCE, TORQUE];

/// What a drive does to its measure.
enum Action {
    Motion(Function),
    Law(Law),
}

/// Description of the type of a drive.
pub(crate) const MEASURE: &str = "a measure of the joint";

/// The data of a joint to which drives and groups refer.
pub(crate) struct Known<'r, S: SceneSpace> {
    pub(crate) name: String,
    /// Place of its name.
    pub(crate) span: Range<usize>,
    /// Its definition, if its type is known.
    pub(crate) definition: Option<&'r ConstraintDefinition<S>>,
    /// Its bodies and arguments, if all could be read.
    complete: Option<(Vec<BodyRef>, Vec<Argument>)>,
    /// Tolerance of its data (m).
    pub(crate) tolerance: Option<f64>,
    pub(crate) is_active: bool,
    /// Whether it couples measures of other joints.
    pub(crate) is_coupling: bool,
}

impl<S: SceneSpace> Known<'_, S> {
    /// A joint of which nothing but the name is known.
    pub(crate) fn named(name: &str, table: &Table) -> Self {
        Self {
            name: name.to_owned(),
            span: table.span_of("name"),
            definition: None,
            complete: None,
            tolerance: None,
            is_active: true,
            is_coupling: false,
        }
    }

    /// Its bodies and arguments, if all could be read.
    pub(crate) fn complete(&self) -> Option<(&[BodyRef], &[Argument])> {
        let (bodies, arguments) = self.complete.as_ref()?;
        Some((bodies, arguments))
    }

    /// Its bodies, and its arguments with one for the motion of a drive of a measure.
    pub(crate) fn with_motion(&self) -> Option<(Vec<BodyRef>, Vec<Argument>)> {
        let (bodies, arguments) = self.complete.as_ref()?;
        let mut arguments = arguments.clone();
        arguments.push(Argument::Absent);
        Some((bodies.clone(), arguments))
    }
}

/// What was read of a joint: all, or what drives and groups must know.
pub(crate) type Read<'r, S> = (Known<'r, S>, Option<(Joint<S>, Entry)>);

/// The joints that were read.
pub(crate) struct Joints<'r, S: SceneSpace> {
    pub(crate) list: Vec<Joint<S>>,
    pub(crate) entries: Vec<Entry>,
    pub(crate) known: Vec<Known<'r, S>>,
}

impl<S: SceneSpace> Default for Joints<'_, S> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            entries: Vec::new(),
            known: Vec::new(),
        }
    }
}

impl<'r, S: SceneSpace> Joints<'r, S> {
    /// Reads one joint.
    pub(crate) fn read(
        &mut self,
        mut table: Table,
        name: &str,
        types: &Types<'r, S>,
        bodies: &Bodies<S>,
        domains: &mut Vec<Domain>,
        findings: &mut Findings,
    ) {
        let mut known = Known::named(name, &table);
        let Some(scene_type) = element::scene_type(&mut table, types, findings) else {
            connection::check_names(&mut table, &bodies.names, findings);
            self.known.push(known);
            return;
        };
        let definitions: Vec<_> = types.registry.constraints(scene_type).collect();
        let mut own = Vec::new();
        let read = element::read(&mut table, &definitions, bodies, &mut own, findings);
        known.tolerance = tolerance::read(&mut table, &tolerance::OF_JOINT, findings);
        known.is_active = active::read(&mut table, findings);
        if known.is_active {
            domains.append(&mut own);
        }
        let entry = Entry::switched(name, &table, known.is_active);
        table.close(findings);
        known.definition = read.as_ref().map(|read| read.definition);
        if let Some(read) = read
            && let Some((bodies, element)) = read.element
        {
            known.complete = Some((bodies.clone(), read.arguments.values));
            self.list.push(Joint {
                name: name.to_owned(),
                bodies,
                element,
                functions: read.arguments.functions,
                tolerance: known.tolerance,
            });
            self.entries.push(entry);
        }
        self.known.push(known);
    }

    /// Leaves out joints in whose place a drive is.
    pub(crate) fn leave_out(&mut self, replaced: &[String]) {
        if !replaced.is_empty() {
            let stays = |name: &String| !replaced.contains(name);
            self.list.retain(|joint| stays(&joint.name));
            self.entries.retain(|entry| stays(&entry.name));
            self.known.retain(|joint| stays(&joint.name));
        }
    }
}

/// The joints by name, for drives.
pub(crate) struct JointNames<'j, 'r, S: SceneSpace> {
    list: &'j [Known<'r, S>],
    /// Indices by name; if a name is used twice, the first joint.
    by_name: HashMap<&'j str, &'j Known<'r, S>>,
}

impl<'j, 'r, S: SceneSpace> JointNames<'j, 'r, S> {
    pub(crate) fn of(joints: &'j Joints<'r, S>) -> Self {
        let list = joints.known.as_slice();
        let mut by_name = HashMap::with_capacity(list.len());
        for joint in list {
            by_name.entry(joint.name.as_str()).or_insert(joint);
        }
        Self { list, by_name }
    }

    pub(crate) fn get(&self, name: &str) -> Option<&'j Known<'r, S>> {
        self.by_name.get(name).copied()
    }
}

/// The drives that were read.
pub(crate) struct Drives<S: SceneSpace> {
    /// Names of all drives, complete or not, and whether they are active.
    pub(crate) known: Vec<(String, bool)>,
    pub(crate) list: Vec<Drive<S>>,
    pub(crate) entries: Vec<Entry>,
    /// Drives by laws, which are applied forces.
    pub(crate) laws: Forces<S>,
    /// Joints whose rows keep the driven measure: those of the drive take their place.
    pub(crate) replaced: Vec<String>,
}

impl<S: SceneSpace> Default for Drives<S> {
    fn default() -> Self {
        Self {
            known: Vec::new(),
            list: Vec::new(),
            entries: Vec::new(),
            laws: Forces::default(),
            replaced: Vec::new(),
        }
    }
}

impl<S: SceneSpace> Drives<S> {
    /// Reads one drive. Two drives of one measure are redundant, which is not an error.
    pub(crate) fn read(
        &mut self,
        mut table: Table,
        name: &str,
        joints: &JointNames<S>,
        domains: &mut Vec<Domain>,
        findings: &mut Findings,
    ) {
        let mut own = Vec::new();
        let joint = joint(&mut table, joints, findings);
        let measure = table.needed(TYPE, MEASURE, findings);
        let law = [FORCE, TORQUE].map(|key| table.optional(&key));
        let motion = match &law {
            [None, None] => table.required(&MOTION, findings),
            _ => table.optional(&MOTION),
        };
        let measure =
            measure.and_then(|field| Some((field.text(MEASURE, findings)?, field.span())));
        let of = match (joint, measure.as_ref()) {
            (Some(joint), Some((measure, _))) => dimension(joint, measure),
            _ => None,
        };
        let is_law = law.iter().any(Option::is_some);
        let action = match (motion, law) {
            (Some(field), [None, None]) => {
                let of = of.unwrap_or(Dimension::UNKNOWN);
                let function = function::read(&field, of, &mut own, findings);
                if field.may_be_number()
                    && let Some(function) = &function
                {
                    warn_if_held(&field, function, findings);
                }
                function.map(Action::Motion)
            }
            (None, [Some(field), None] | [None, Some(field)]) => {
                read_law(&field, of, findings).map(Action::Law)
            }
            (None, [None, None]) => None,
            _ => {
                let message = format!(
                    "{} has several of `motion`, `force` and `torque`",
                    table.subject
                );
                let label = "a drive does one of them";
                findings.error(Mistake::Exclusive, table.header.clone(), message, label);
                None
            }
        };
        let is_active = active::read(&mut table, findings);
        if !is_law {
            self.known.push((name.to_owned(), is_active));
        }
        if is_active {
            domains.append(&mut own);
            let at = table.span_of(JOINT.name);
            must_be_active(&table.subject, "drives", at, joint, findings);
        }
        let entry = Entry::switched(name, &table, is_active);
        table.close(findings);
        let (Some(joint), Some((measure, span))) = (joint, measure) else {
            return;
        };
        let Some(definition) = joint.definition else {
            if joint.is_coupling {
                findings.error(
                    Mistake::UnknownMeasure,
                    span,
                    format!(
                        "drive `{name}`: `{}` is a coupling, which has no measure",
                        joint.name
                    ),
                    "drive a measure of one of its joints",
                );
            }
            return;
        };
        let measures = || definition.spec.measures.iter().map(|m| m.name);
        let Some(at) = measures().position(|m| m == measure) else {
            let help = match measures().next() {
                Some(_) => format!("its measures are {}", list(measures())),
                None => "joints of this type cannot be driven".to_owned(),
            };
            let label = match nearest(measure, measures()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "no such measure".to_owned(),
            };
            findings.error_with_help(
                Mistake::UnknownMeasure,
                span,
                format!(
                    "drive `{name}`: joint `{}` (`{}`) has no measure `{measure}`",
                    joint.name, definition.spec.common.scene_type
                ),
                label,
                Some(help),
            );
            return;
        };
        let (Some((bodies, arguments)), Some(action)) = (joint.with_motion(), action) else {
            return;
        };
        let Some(drive) = definition.drives.get(at) else {
            return findings.error(
                Mistake::Registry,
                span,
                format!(
                    "drive `{name}`: the definition of the drive of `{measure}` is not registered"
                ),
                "no such definition",
            );
        };
        // The joint accepted these arguments, and its drive differs only in the motion.
        let refused = match action {
            Action::Motion(motion) => match (drive.build)(&arguments) {
                Ok(element) => {
                    self.list.push(Drive {
                        name: name.to_owned(),
                        bodies: bodies.clone(),
                        element,
                        motion,
                        tolerance: joint.tolerance,
                    });
                    self.entries.push(entry);
                    None
                }
                Err(error) => Some(error.to_string()),
            },
            Action::Law(law) => match (drive.law)(&arguments, law) {
                Ok(element) => {
                    self.laws.list.push(Force {
                        name: name.to_owned(),
                        bodies: bodies.clone(),
                        element,
                        functions: vec![Function::time()],
                    });
                    self.laws.entries.push(entry);
                    None
                }
                Err(error) => Some(error.to_string()),
            },
        };
        if let Some(error) = refused {
            findings.error(
                Mistake::Registry,
                span,
                format!("drive `{name}`: {error}"),
                "not possible",
            );
        } else if definition.spec.measures[at].is_kept && is_active {
            self.replaced.push(joint.name.clone());
        }
    }
}

/// Reads a law along a measure of this dimension.
fn read_law(field: &Field, of: Option<Dimension>, findings: &mut Findings) -> Option<Law> {
    let of = of?;
    let (result, key) = if of == Dimension::ANGLE {
        (Unit::Torque.into(), TORQUE.name)
    } else {
        (Unit::Force.into(), FORCE.name)
    };
    if field.key != key {
        findings.error_with_help(
            Mistake::OtherLoad,
            field.span(),
            format!(
                "{}: `{}` does not act along {}",
                field.subject,
                field.key,
                of.words()
            ),
            "another kind of load is needed",
            format!("write `{key} = …`"),
        );
        return None;
    }
    field.law(LAW, of, result, findings)
}

/// Warns of a motion that is a number other than zero: whoever writes one may expect a speed or a
/// place, but a drive follows f(t) − f(0).
fn warn_if_held(motion: &Field, function: &Function, findings: &mut Findings) {
    let [held, ..] = function.jet(0.0);
    if held == 0.0 {
        return;
    }
    let value = match motion.value.get_ref().as_str() {
        Some(text) => format!("{text:?}"),
        None => held.to_string(),
    };
    findings.warning(
        const { Code::new(191) },
        motion.span(),
        format!(
            "{}: `motion = {value}` is constant, and a drive follows f(t) − f(0), so the measure is held at its initial value",
            motion.subject
        ),
        "holds the measure",
        &format!(
            "for a constant speed write `motion = {{ type = \"constant-rate\", rate = {value} }}`, to hold the measure `motion = 0`"
        ),
    );
}

/// Reports a joint that is to be driven or coupled and is not active.
pub(crate) fn must_be_active<S: SceneSpace>(
    subject: &str,
    verb: &str,
    at: Range<usize>,
    joint: Option<&Known<S>>,
    findings: &mut Findings,
) {
    let Some(joint) = joint.filter(|joint| !joint.is_active) else {
        return;
    };
    let message = format!(
        "{subject} {verb} joint `{}`, which is not active",
        joint.name
    );
    findings.collision(
        Mistake::Inactive,
        at,
        message,
        "write `active = false` here, too, or remove it from the joint",
        joint.span.clone(),
        "this joint is not active",
    );
}

/// The dimension of a measure of a joint, if it has this measure.
pub(crate) fn dimension<S: SceneSpace>(joint: &Known<S>, measure: &str) -> Option<Dimension> {
    let definition = joint.definition?;
    let mut measures = definition.spec.measures.iter();
    let at = measures.position(|m| m.name == measure)?;
    let of_drive = definition.drives.get(at)?.spec.common.functions();
    of_drive.last().map(|(_, unit)| unit.into())
}

/// The joint that a drive names.
fn joint<'j, 'r, S: SceneSpace>(
    table: &mut Table,
    joints: &JointNames<'j, 'r, S>,
    findings: &mut Findings,
) -> Option<&'j Known<'r, S>> {
    let field = table.required(&JOINT, findings)?;
    let name = field.text(JOINT.expected, findings)?;
    of_name(name, &field, joints, findings)
}

/// The joint of this name, which stands in a field.
pub(crate) fn of_name<'j, 'r, S: SceneSpace>(
    name: &str,
    field: &Field,
    joints: &JointNames<'j, 'r, S>,
    findings: &mut Findings,
) -> Option<&'j Known<'r, S>> {
    let found = joints.get(name);
    if found.is_none() {
        let near = findings.suggest(name, joints.list.iter().map(|j| j.name.as_str()));
        let near = near.and_then(|near| joints.get(near));
        let label = match near {
            Some(near) => format!(
                "no such joint; `{}` is defined on line {}",
                near.name,
                findings.line(near.span.start)
            ),
            None => "no such joint".to_owned(),
        };
        findings.error_with_help(
            Mistake::UnknownJoint,
            field.span(),
            format!("{} refers to the unknown joint `{name}`", field.subject),
            label,
            match near {
                Some(near) => Some(format!("did you mean `{}`?", near.name)),
                None => all("joints", joints.list.iter().map(|j| j.name.as_str())),
            },
        );
    }
    found
}
