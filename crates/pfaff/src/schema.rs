//! Questions and answers as JSON schemas, for programs that generate interfaces from them.

use report::json::FORMAT;
use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use schemars::{JsonSchema, Schema, json_schema};

use crate::question::Question;

/// A question and its answer as JSON schemas.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct QuestionSchema {
    /// Name of the question.
    pub name: &'static str,
    /// Schema of the options.
    pub options: Schema,
    /// Schema of the answer document.
    pub answer: Schema,
}

impl QuestionSchema {
    /// Builds the schemas of one question.
    pub(crate) fn of<Q: Question<Answer: JsonSchema> + JsonSchema>() -> Self {
        let settings = SchemaSettings::draft2020_12;
        let read = settings().for_deserialize().into_generator();
        let written = settings().for_serialize().into_generator();
        let mut answer = written.into_root_schema_for::<Q::Answer>();
        Unknown.transform(&mut answer);
        add_head(&mut answer);
        Self {
            name: Q::NAME,
            options: read.into_root_schema_for::<Q>(),
            answer,
        }
    }
}

/// Adds the keys at the head of every document, and of an incomplete document.
fn add_head(document: &mut Schema) {
    let head = json_schema!({
        "format": { "const": FORMAT, "description": "Number of the format of documents" },
        "version": { "type": "string", "description": "Version of the program" },
        "code": { "type": "string", "description": "Code of the reason why the document is incomplete" },
        "error": { "type": "string", "description": "Why the document is not whole" },
    });
    let none = || json_schema!({}).to_value();
    let entries = document.ensure_object();
    let own = entries.entry("properties").or_insert_with(none);
    if let (Some(own), Some(head)) = (own.as_object_mut(), head.as_object()) {
        for (key, of) in head {
            // A document may define one of these keys itself.
            own.entry(key.clone()).or_insert_with(|| of.clone());
        }
    }
}

/// JSON has no NaN and no infinity, so any number of a document may be `null`.
struct Unknown;

impl Transform for Unknown {
    fn transform(&mut self, schema: &mut Schema) {
        if schema.get("type").is_some_and(|kind| kind == "number") {
            schema.insert("type".to_owned(), ["number", "null"].as_slice().into());
        }
        transform_subschemas(self, schema);
    }
}
