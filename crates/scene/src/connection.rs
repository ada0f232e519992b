//! The bodies that a joint or force connects: `body`, `bodies`, and the keys of further bodies. The
//! number of bodies and the key of a variant select one of the definitions that have the same type
//! in scenes.

use joints::spec::Spec;
use model::BodyRef;

use crate::body::BodyNames;
use crate::direction;
use crate::mistake::Mistake;
use crate::nearest::{did_you_mean, list, meant};
use crate::source_map::PLACE_KEYS;
use crate::table::Table;

/// Key for a single body.
pub(crate) const BODY: &str = "body";
/// Key for two bodies.
pub(crate) const BODIES: &str = "bodies";

/// Number of bodies in the value of `body` or `bodies`. Each further body has its own key.
pub(crate) fn listed(spec: &Spec) -> usize {
    spec.slots.len().min(2)
}

/// The bodies in `body` or `bodies`; `None` for a body that could not be read.
pub(crate) type NamedBodies = Vec<Option<BodyRef>>;

/// Reads `body` or `bodies`. If both keys are missing or no definition accepts this number of
/// bodies, the function reports this and returns `None`.
pub(crate) fn named(
    table: &mut Table,
    specs: &[&'static Spec],
    bodies: &BodyNames,
) -> Option<NamedBodies> {
    let takes = |n: usize| specs.iter().any(|spec| listed(spec) == n);
    let expected = match (takes(1), takes(2)) {
        (true, true) => "`body = …` or `bodies = [first, second]`",
        (true, false) => "`body = …`",
        _ => "`bodies = [first, second]`",
    };
    // A key that no definition accepts is read only if the text contains it; otherwise it would
    // count as a known key of the table.
    let mut read = |key, is_taken| {
        let asked = is_taken || table.has(key);
        asked.then(|| table.optional(key)).flatten()
    };
    let one = read(BODY, takes(1));
    let two = read(BODIES, takes(2));
    let wrong = |key: &str| format!("{} takes {expected}, not `{key}`", table.subject);
    match (one, two) {
        (Some(one), Some(two)) => {
            let first = (one.span(), "here one body is given");
            let second = (two.span(), "and here two bodies are given");
            table.exclusive(expected, [first, second]);
            None
        }
        (Some(one), None) if takes(1) => Some(vec![bodies.find(&one)]),
        (Some(one), None) => {
            table.findings.error(
                Mistake::BodyCount,
                one.span(),
                wrong("body"),
                format!("expected {expected}"),
            );
            None
        }
        (None, Some(two)) if takes(2) => {
            let items = two.items("two bodies [first, second]")?;
            if items.len() != 2 {
                two.miscount("two bodies [first, second]", items.len(), 2);
                return None;
            }
            Some(items.iter().map(|item| bodies.find(item)).collect())
        }
        (None, Some(two)) => {
            let name = specs.first().map_or("", |spec| spec.scene_type);
            table.findings.error_with_help(
                Mistake::BodyCount,
                two.span(),
                wrong("bodies"),
                format!("expected {expected}"),
                meant(name).map(|other| {
                    format!(
                        "`{name}` has one body; the `{name}` of other programs is `{other}` here"
                    )
                }),
            );
            None
        }
        (None, None) => {
            table.missing(format!(" needs {expected}"), "the bodies are missing here");
            None
        }
    }
}

/// If the definition is unknown, checks only that the bodies exist.
pub(crate) fn check_names(table: &mut Table, bodies: &BodyNames) {
    if let Some(one) = table.optional(BODY) {
        bodies.find(&one);
    }
    let two = table.optional(BODIES);
    for item in two
        .and_then(|two| two.items("two bodies [first, second]"))
        .iter()
        .flatten()
    {
        bodies.find(item);
    }
}

/// Returns all bodies of the definition: the listed bodies, followed by the bodies with their own
/// keys. If such a key is missing, the body is the ground.
pub(crate) fn slots(
    table: &mut Table,
    spec: &'static Spec,
    mut named: NamedBodies,
    bodies: &BodyNames,
) -> NamedBodies {
    for &slot in &spec.slots[listed(spec)..] {
        named.push(match table.optional(slot) {
            Some(field) => bodies.find(&field),
            None => Some(BodyRef::Ground),
        });
    }
    named
}

/// Selects a definition by the number of bodies and the key of the variant. Returns the index of
/// the definition in `specs`.
pub(crate) fn choose(table: &mut Table, specs: &[&'static Spec], n_named: usize) -> Option<usize> {
    let fitting: Vec<usize> = (0..specs.len())
        .filter(|&k| listed(specs[k]) == n_named)
        .collect();
    if let [only] = fitting[..] {
        // If there is only one variant, no selection is necessary, but the text may contain the
        // key.
        if specs[only].variant.is_none() {
            return Some(only);
        }
    }
    let variants = || {
        let variant = |&k: &usize| specs[k].variant.map(|variant| (k, variant));
        fitting.iter().filter_map(variant)
    };
    let Some((_, first)) = variants().next() else {
        let names: Vec<_> = fitting.iter().map(|&k| specs[k].name).collect();
        table.findings.error(
            Mistake::Registry,
            table.header.clone(),
            format!(
                "{}: it is not possible to distinguish the definitions {} that are registered under this type",
                table.subject,
                list(names)
            ),
            "the type is ambiguous",
        );
        return None;
    };
    let values = || variants().map(|(_, variant)| variant.value);
    let expected = list(values());
    let Some(field) = table.optional(first.key) else {
        let default = variants().find(|(_, variant)| variant.default);
        if default.is_none() {
            table.needed(first.key, &*expected);
        }
        return default.map(|(k, _)| k);
    };
    let value = field.text(&expected)?;
    let chosen = variants().find(|(_, variant)| variant.value == value);
    if chosen.is_none() {
        field.error_with_help(
            Mistake::UnknownChoice,
            format!(
                ": `{}` must be one of {expected}, found `{value}`",
                field.key
            ),
            "no such choice",
            did_you_mean(value, values()),
        );
    }
    chosen.map(|(k, _)| k)
}

/// Marks the keys of definitions as known, because the definition could not be selected.
pub(crate) fn forgive(table: &mut Table, specs: &[&'static Spec]) {
    for key in PLACE_KEYS {
        table.optional(key);
    }
    for spec in specs {
        for &key in spec.slots.iter().skip(listed(spec)) {
            table.optional(key);
        }
        for parameter in spec.parameters {
            table.optional(parameter.name);
        }
        for key in direction::keys(spec) {
            table.optional(key);
        }
        if let Some(variant) = spec.variant {
            table.optional(variant.key);
        }
    }
}
