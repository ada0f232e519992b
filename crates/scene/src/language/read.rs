//! `format` and `units` of `[scene]`, and `[parameters]`.

use std::collections::BTreeMap;
use std::ops::Range;

use linalg::Dd;
use model::words::read_in;

use super::{Language, Units};
use crate::dimension::Dimension;
use crate::expression::{self, Bases, is_name, names_of, reserved, unit};
use crate::field::Field;
use crate::findings::Findings;
use crate::key::{Key, Takes};
use crate::mistake::Mistake;
use crate::nearest::{did_you_mean, list};
use crate::section;
use crate::table::Table;

/// The format in which texts may be expressions.
pub(crate) const COMPUTING: i64 = 2;

pub(crate) const FORMAT: Key = Key::optional("format", "1 or 2", Takes::Whole(1, COMPUTING))
    .doc("Format of the file; 2 allows `[parameters]`, `units`, and expressions where numbers are expected")
    .or(|| 1.into());
const UNITS: Key = Key::optional("units", "a table { length = \"mm\", … }", Takes::Units)
    .doc("Units of numbers that are written without a unit; metres and radians if it is not given");
const LENGTH: Key = Key::optional("length", "a unit of length", Takes::OneOf(lengths))
    .doc("Unit of lengths; with \"mm\", velocities are in mm/s, inertias in kg·mm², stiffnesses in N/mm")
    .or(|| "m".into());
const ANGLE: Key = Key::optional("angle", "a unit of angle", Takes::OneOf(angles))
    .doc("Unit of angles; with \"deg\", angular velocities are in deg/s")
    .or(|| "rad".into());

/// The keys of `[scene]` that determine how the rest of the file is read.
pub(crate) const SCENE_KEYS: [Key; 2] = [FORMAT, UNITS];
/// The keys of `units`.
pub(crate) const UNIT_KEYS: [Key; 2] = [LENGTH, ANGLE];

fn lengths() -> Vec<&'static str> {
    names_of(Dimension::LENGTH)
}

fn angles() -> Vec<&'static str> {
    names_of(Dimension::ANGLE)
}

/// Largest number of unfit names whose uses are recognised. The number is limited because each
/// error in an expression is compared with all of these names.
const UNFIT: usize = 100;

impl Language {
    /// Reads `format` and `units` of `[scene]`, and `[parameters]`. Further problems of these
    /// sections are reported elsewhere.
    pub(crate) fn read(root: &mut Table) -> Self {
        let mut language = Self::PLAIN;
        let entries = |field: &Field| field.value.get_ref().is_table();
        let scene = root.optional(section::SCENE.name).filter(entries);
        let head = scene.and_then(|field| field.table(""));
        let mut is_stated = false;
        let mut units = None;
        if let Some(mut head) = head {
            head.subject = "`[scene]`".into();
            let format = head.optional(&FORMAT);
            is_stated = format.is_some();
            let format = format.and_then(|field| whole(&field));
            // If the format could not be read, this has been reported.
            language.computes = format == Some(COMPUTING) || (is_stated && format.is_none());
            units = head.optional(&UNITS);
        }
        let needs_format = |span, what: &str| {
            let help = if is_stated {
                "write `format = 2` in `[scene]`"
            } else {
                "add `format = 2` to `[scene]`"
            };
            let message = format!("{what} needs the format 2");
            root.findings.error_with_help(
                Mistake::NeedsFormat,
                span,
                message,
                "not in format 1",
                help.to_owned(),
            );
        };
        if let Some(field) = units {
            if !language.computes {
                needs_format(field.span(), "`units`");
            }
            (language.bases, language.units) = bases(&field);
        }
        if let Some(field) = root.optional(section::PARAMETERS.name) {
            if !language.computes {
                needs_format(field.span(), "`[parameters]`");
                language.computes = true;
            }
            language.parameters(&field);
        }
        read_in(language.units.printed());
        language
    }

    /// Reads the parameters. Each parameter is read after the parameters that its expression
    /// contains.
    fn parameters(&mut self, field: &Field) {
        let Some(table) = field.table("one table `[parameters]`") else {
            return;
        };
        let mut list: Vec<Parameter> = Vec::new();
        for (key, mut value) in table.all() {
            value.subject = "`[parameters]`".into();
            let name = value.key.to_string();
            let fitness = check_name(&name, key.clone(), field.findings);
            if fitness == Fitness::Unfit && self.unfit.len() < UNFIT {
                self.unfit.push(name.clone());
            }
            let is_refused = fitness != Fitness::Fit;
            let declared = super::ParameterValue {
                value: None,
                name: key,
            };
            self.parameters.insert(name.clone(), declared);
            list.push(Parameter {
                name,
                value,
                is_refused,
            });
        }
        let at: BTreeMap<&str, usize> = (0..).zip(&list).map(|(k, p)| (&*p.name, k)).collect();
        let needs: Vec<Vec<(usize, Range<usize>)>> = list
            .iter()
            .map(|parameter| {
                let text = parameter.value.value.get_ref().as_str().unwrap_or_default();
                let names = expression::names(text).into_iter();
                names
                    .filter_map(|(name, span)| Some((*at.get(name)?, span)))
                    .collect()
            })
            .collect();
        let mut waits: Vec<usize> = needs.iter().map(Vec::len).collect();
        let mut users = vec![Vec::new(); list.len()];
        for (user, needed) in needs.iter().enumerate() {
            needed.iter().for_each(|(k, _)| users[*k].push(user));
        }
        let mut ready: Vec<usize> = (0..list.len()).filter(|k| waits[*k] == 0).collect();
        while let Some(k) = ready.pop() {
            let value = list[k].value.quantity("a number or an expression", self);
            let declared = self.parameters.get_mut(&list[k].name);
            // The value of a refused name stays unknown, so that its uses are not reported.
            if let Some(parameter) = declared.filter(|_| !list[k].is_refused) {
                parameter.value = value;
            }
            for &user in &users[k] {
                waits[user] -= 1;
                if waits[user] == 0 {
                    ready.push(user);
                }
            }
        }
        report_circles(&list, &needs, &waits);
    }
}

/// A parameter in the form given in the text.
struct Parameter<'t> {
    name: String,
    value: Field<'t>,
    /// Whether the name has been reported.
    is_refused: bool,
}

/// Whether expressions can contain the name of a parameter.
#[derive(Clone, Copy, PartialEq)]
enum Fitness {
    Fit,
    /// The name has another meaning in expressions.
    Reserved,
    Unfit,
}

/// Reports each cycle of parameters once. Parameters outside of a cycle that refer to the cycle are
/// not reported.
fn report_circles(list: &[Parameter], needs: &[Vec<(usize, Range<usize>)>], waits: &[usize]) {
    // Zero for a parameter that has not been visited; otherwise the number of the search that
    // reached it.
    let mut seen = vec![0; list.len()];
    for first in (0..list.len()).filter(|k| waits[*k] > 0) {
        let mut path: Vec<(usize, Range<usize>)> = Vec::new();
        let mut here = first;
        while seen[here] == 0 {
            seen[here] = first + 1;
            let next = needs[here].iter().find(|(k, _)| waits[*k] > 0);
            let Some((next, span)) = next else { break };
            path.push((here, span.clone()));
            here = *next;
        }
        let Some(begin) = path.iter().position(|(k, _)| *k == here) else {
            continue;
        };
        let circle = &path[begin..];
        let names = circle.iter().map(|(k, _)| list[*k].name.as_str());
        let names: Vec<&str> = names.chain([list[here].name.as_str()]).collect();
        let (at, span) = &circle[0];
        let value = &list[*at].value;
        let findings = value.findings;
        let message = match circle.len() {
            1 => format!("the parameter `{}` depends on itself", names[0]),
            _ => format!(
                "the parameters {} depend on each other",
                list_of(&names, " → ")
            ),
        };
        findings.error_with_help(
            Mistake::Circle,
            value.part(span.clone()),
            message,
            "closes the circle",
            "give one of them a value without the others".to_owned(),
        );
    }
}

/// Number of names that are listed in a message about a cycle.
const SHOWN: usize = 8;

fn list_of(names: &[&str], between: &str) -> String {
    let mut shown: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    if shown.len() > SHOWN {
        let last = shown.split_off(shown.len() - 1);
        shown.truncate(SHOWN - 2);
        shown.push("…".to_owned());
        shown.extend(last);
    }
    shown.join(between)
}

/// Reports a name that is not permitted in expressions, or that has another meaning in expressions.
fn check_name(name: &str, span: Range<usize>, findings: &Findings) -> Fitness {
    if let Some(what) = reserved(name) {
        findings.error_with_help(
            Mistake::ReservedName,
            span,
            format!("the parameter `{name}` has the same name as {what}"),
            "choose another name",
            format!("for example `{name}_1`"),
        );
        Fitness::Reserved
    } else if !is_name(name) {
        findings.error_with_help(
            Mistake::UnfitName,
            span,
            format!("the parameter {name:?} has a name that expressions cannot contain"),
            "choose another name",
            "names have letters, digits and `_`, and begin with no digit".to_owned(),
        );
        Fitness::Unfit
    } else {
        Fitness::Fit
    }
}

/// An integer that `format` accepts.
fn whole(field: &Field) -> Option<i64> {
    let format = field.integer(FORMAT.expected)?;
    if (1..=COMPUTING).contains(&format) {
        return Some(format);
    }
    field.findings.error(
        Mistake::OutOfRange,
        field.span(),
        format!("`[scene]`: `format` is {format}, need {}", FORMAT.expected),
        "no such format",
    );
    None
}

/// The units of bare numbers.
fn bases(field: &Field) -> (Bases, Units) {
    let Some(mut table) = field.table(UNITS.expected) else {
        return (Bases::SI, Units::SI);
    };
    let mut base = |key: &Key, of: Dimension| {
        let field = table.optional(key)?;
        let name = field.text(key.expected)?;
        let found = unit(name).filter(|(_, unit)| unit.dimension == Some(of));
        if found.is_none() {
            let names = names_of(of);
            field.error_with_help(
                Mistake::UnknownChoice,
                format!(": `{}` must be {}, found `{name}`", field.key, key.expected),
                "no such unit",
                did_you_mean(name, names.iter().copied())
                    .or(Some(format!("there are {}", list(names.iter().copied())))),
            );
        }
        found.map(|(name, unit)| (name, unit.value))
    };
    let length = base(&LENGTH, Dimension::LENGTH).unwrap_or((Units::SI.length, Dd::ONE));
    let angle = base(&ANGLE, Dimension::ANGLE).unwrap_or((Units::SI.angle, Dd::ONE));
    table.close();
    let bases = Bases {
        length: length.1,
        angle: angle.1,
    };
    let units = Units {
        length: length.0,
        angle: angle.0,
    };
    (bases, units)
}
