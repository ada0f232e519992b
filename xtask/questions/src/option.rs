//! An option of a question. Its text comes from the command line, and its type from the schema.

use clap::Arg;
use serde_json::Value;

/// An option.
pub(crate) struct QuestionOption {
    /// Key of the option, such as `at_time`.
    pub(crate) key: String,
    /// Key of the object that contains the option; `None` for the question itself.
    pub(crate) inside: Option<String>,
    /// Form on the command line, such as `--at-time T`.
    pub(crate) flag: String,
    /// Description of the option.
    pub(crate) help: String,
    /// Default on the command line. The text is empty if there is no default.
    pub(crate) default: String,
    /// Type of the option.
    pub(crate) kind: Kind,
    /// Whether the option may be absent.
    pub(crate) optional: bool,
}

/// The type of an option.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Flag,
    Count,
    Number,
    Text,
    /// A number, or a word in place of the number.
    NumberOrWord,
    /// Rows, from 1.
    Rows,
    Texts,
    /// Texts in the form `KEY=VALUE`.
    Settings,
}

impl QuestionOption {
    /// Creates the description of a command-line argument. `options` is the JSON schema of the
    /// options to which the argument belongs.
    pub(crate) fn new(argument: &Arg, options: &Value) -> Self {
        let key = argument.get_id().to_string();
        let (inside, schema) = place(&key, options);
        let (mut kind, optional) = kind(schema, options);
        let names = argument.get_value_names().unwrap_or_default();
        if kind == Kind::Texts && names.first().is_some_and(|name| name.starts_with("KEY=")) {
            kind = Kind::Settings;
        }
        let takes_values = argument.get_num_args().is_some_and(|n| n.takes_values());
        let may_be_bare = argument.get_num_args().is_some_and(|n| n.min_values() == 0);
        let value = match (takes_values, names.first()) {
            (true, Some(name)) if may_be_bare => format!(" [{name}]"),
            (true, Some(name)) => format!(" {name}"),
            _ => String::new(),
        };
        let help = argument.get_help().map(ToString::to_string);
        let defaults = argument.get_default_values().iter();
        let defaults: Vec<String> = defaults.map(|x| x.to_string_lossy().into_owned()).collect();
        Self {
            flag: format!("--{}{value}", key.replace('_', "-")),
            key,
            inside,
            help: help.unwrap_or_default().replace('\n', " "),
            default: if takes_values {
                defaults.join(",")
            } else {
                String::new()
            },
            kind,
            optional,
        }
    }
}

/// Position of an option: the key of an object of options, and its schema.
fn place<'v>(key: &str, options: &'v Value) -> (Option<String>, &'v Value) {
    let own = &options["properties"];
    if let Some(schema) = own.get(key) {
        return (None, schema);
    }
    let objects = own.as_object().into_iter().flatten();
    let mut found = objects.filter_map(|(name, of)| {
        let schema = resolved(of, options)["properties"].get(key)?;
        Some((Some(name.clone()), schema))
    });
    found.next().unwrap_or((None, &Value::Null))
}

/// The schema to which a reference refers.
fn resolved<'v>(schema: &'v Value, options: &'v Value) -> &'v Value {
    let name = schema["$ref"].as_str();
    let name = name.and_then(|name| name.strip_prefix("#/$defs/"));
    name.map_or(schema, |name| &options["$defs"][name])
}

/// The type of a schema, and whether it may be `null`.
///
/// # Panics
/// Panics if the type is unknown. Such a type must be added to the generator.
fn kind(schema: &Value, options: &Value) -> (Kind, bool) {
    let schema = resolved(schema, options);
    if let Some(any) = schema["anyOf"].as_array() {
        let is_null = |one: &&Value| one["type"] == "null";
        let of: Vec<&Value> = any.iter().filter(|one| !is_null(one)).collect();
        let optional = of.len() < any.len();
        if let [one] = of[..] {
            return (kind(one, options).0, optional);
        }
        let types: Vec<&Value> = of
            .iter()
            .map(|one| &resolved(one, options)["type"])
            .collect();
        assert!(
            types.iter().all(|t| **t == "number" || **t == "string"),
            "{schema}"
        );
        return (Kind::NumberOrWord, optional);
    }
    let (name, optional) = match &schema["type"] {
        Value::Array(both) => (&both[0], true),
        one => (one, false),
    };
    let of = match name.as_str() {
        Some("boolean") => Kind::Flag,
        Some("integer") => Kind::Count,
        Some("number") => Kind::Number,
        Some("string") => Kind::Text,
        Some("array") if schema["items"]["type"] == "integer" => Kind::Rows,
        Some("array") if schema["items"]["type"] == "string" => Kind::Texts,
        _ => panic!("options of this type are not supported: {schema}"),
    };
    (of, optional)
}
