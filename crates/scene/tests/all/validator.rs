//! A validator for the keywords of JSON schema (draft 2020-12) that the schema of scenes contains.
//! The test fails for an unknown keyword, so that no keyword is ignored.

use std::collections::BTreeSet;

use serde_json::Value;

/// Keywords that have no effect on validity.
const WORDS: [&str; 6] = [
    "$schema",
    "$defs",
    "title",
    "description",
    "default",
    "required",
];

/// Returns the reason why a value does not satisfy the schema; `None` if it does.
pub(crate) fn fault(root: &Value, schema: &Value, value: &Value) -> Option<String> {
    let schema = schema.as_object().expect("a schema is an object");
    if let Some(missing) = missing(schema.get("required"), value) {
        return Some(format!("`{missing}` is missing"));
    }
    let checks = schema
        .iter()
        .filter(|(key, _)| !WORDS.contains(&key.as_str()));
    checks
        .filter_map(|(key, of)| check(root, schema, key, of, value))
        .next()
}

fn missing<'s>(required: Option<&'s Value>, value: &Value) -> Option<&'s str> {
    let (names, table) = (required?.as_array()?, value.as_object()?);
    let names = names.iter().filter_map(Value::as_str);
    names.into_iter().find(|name| !table.contains_key(*name))
}

fn is_of_type(name: &str, value: &Value) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        other => panic!("type {other}"),
    }
}

fn check(
    root: &Value,
    schema: &serde_json::Map<String, Value>,
    key: &str,
    of: &Value,
    value: &Value,
) -> Option<String> {
    let refused = |bad: bool| bad.then(|| format!("{value} against {key} {of}"));
    let size = || of.as_u64().expect("a size") as usize;
    let each = |of: &Value, values: &[Value]| values.iter().find_map(|v| fault(root, of, v));
    match key {
        "$ref" => {
            let pointer = of.as_str().and_then(|r| r.strip_prefix('#'));
            let target = pointer.and_then(|p| root.pointer(p));
            fault(root, target.unwrap_or_else(|| panic!("{of}")), value)
        }
        "type" => {
            let one = std::slice::from_ref(of);
            let mut types = of.as_array().map_or(one, Vec::as_slice).iter();
            refused(!types.any(|name| is_of_type(name.as_str().expect("a type"), value)))
        }
        "const" => refused(value != of),
        "enum" => refused(!of.as_array().expect("values").contains(value)),
        "oneOf" => {
            let schemas = of.as_array().expect("schemas");
            let faults: Vec<_> = schemas.iter().map(|s| fault(root, s, value)).collect();
            let fits = faults.iter().filter(|fault| fault.is_none()).count();
            (fits != 1).then(|| format!("{value} fits {fits}: {faults:?}"))
        }
        "anyOf" => {
            let schemas = of.as_array().expect("schemas");
            refused(schemas.iter().all(|s| fault(root, s, value).is_some()))
        }
        "not" => refused(fault(root, of, value).is_none()),
        "allOf" => {
            let mut schemas = of.as_array().expect("schemas").iter();
            schemas.find_map(|schema| fault(root, schema, value))
        }
        "if" => {
            let branch = if fault(root, of, value).is_none() {
                "then"
            } else {
                "else"
            };
            fault(root, schema.get(branch)?, value)
        }
        "then" | "else" => None,
        "properties" => {
            let table = value.as_object()?;
            let known = of.as_object().expect("properties").iter();
            known
                .filter_map(|(name, of)| Some((of, table.get(name)?)))
                .find_map(|(of, value)| fault(root, of, value))
        }
        "additionalProperties" => {
            let known = schema.get("properties").and_then(Value::as_object);
            let mut others = value.as_object()?.iter();
            others.find_map(|(name, value)| {
                if known.is_some_and(|known| known.contains_key(name)) {
                    return None;
                }
                match of {
                    Value::Bool(false) => Some(format!("`{name}` is unknown")),
                    of => fault(root, of, value),
                }
            })
        }
        "items" => each(of, value.as_array()?),
        "prefixItems" => {
            let pairs = of
                .as_array()
                .expect("schemas")
                .iter()
                .zip(value.as_array()?);
            pairs
                .into_iter()
                .find_map(|(of, value)| fault(root, of, value))
        }
        "minItems" => refused(value.as_array()?.len() < size()),
        "maxItems" => refused(value.as_array()?.len() > size()),
        "minProperties" => refused(value.as_object()?.len() < size()),
        "maxProperties" => refused(value.as_object()?.len() > size()),
        "minLength" => refused(value.as_str()?.chars().count() < size()),
        "maxLength" => refused(value.as_str()?.chars().count() > size()),
        "uniqueItems" => {
            let texts: Vec<String> = value.as_array()?.iter().map(Value::to_string).collect();
            refused(texts.iter().collect::<BTreeSet<_>>().len() < texts.len())
        }
        "minimum" => refused(value.as_f64()? < of.as_f64()?),
        "maximum" => refused(value.as_f64()? > of.as_f64()?),
        "exclusiveMinimum" => refused(value.as_f64()? <= of.as_f64()?),
        "pattern" => {
            let pattern = regex_lite::Regex::new(of.as_str()?).expect("a pattern");
            refused(!pattern.is_match(value.as_str()?))
        }
        other => panic!("keyword {other}"),
    }
}
