//! The requests of a page, and their replies.
//!
//! A request is a JSON object with the key `call`. A reply is `{"done": …}`, or `{"refused": …}`
//! with the problems. All offsets are in UTF-16 units.

use std::collections::BTreeMap;

use pfaff::model::SpaceKind;
use pfaff::questions::Questions;
use pfaff::refusal::Refusal;
use pfaff::scene::{Diagnostic, RetypedJoint, retyped};
use pfaff::template::Template;
use pfaff::{explain, import};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::ask::{self, Ask, Source};
use crate::drag::{self, Pose};
use crate::keys;
use crate::position;
use crate::registry::REGISTRY;

/// A request.
#[derive(Deserialize)]
#[serde(tag = "call", rename_all = "kebab-case")]
enum Request {
    /// The questions, the examples, and the version.
    About,
    /// A question about scenes.
    Ask(Ask),
    /// The problems of a scene.
    Diagnose { scene: Source },
    /// The keys or values that can be written at an offset.
    Complete { text: String, offset: usize },
    /// The description of the key or value at an offset.
    Hover { text: String, offset: usize },
    /// The text of the scene whose body starts in another pose. The other bodies follow.
    Place {
        scene: Source,
        body: String,
        pose: Pose,
    },
    /// The text of the scene in which joints have other types.
    Retype {
        scene: Source,
        replace: Vec<Replacement>,
    },
    /// The start as a page.
    Page {
        scene: Source,
        /// Whether the user drags a body, so that the page must come soon.
        #[serde(default)]
        dragged: bool,
    },
    /// The start as an SVG picture.
    Picture { scene: Source },
    /// The text of a scene from a robot model.
    Import { name: String, text: String },
    /// The meaning of the code of an error.
    Explain { code: String },
}

/// A joint of another type, as the answer of `analyze` proposes it.
#[derive(Deserialize)]
struct Replacement {
    joint: String,
    from: String,
    to: String,
    #[serde(default)]
    directions: BTreeMap<String, Vec<f64>>,
}

/// A part of a text with a message.
#[derive(Serialize)]
struct Problem {
    severity: Value,
    code: String,
    message: String,
    help: Option<String>,
    marks: Vec<Mark>,
}

#[derive(Serialize)]
struct Mark {
    from: usize,
    to: usize,
    text: String,
}

/// Answers a request, which is a JSON text, with a JSON text.
///
/// ```
/// let reply = pfaff_web::answer(br#"{ "call": "explain", "code": "P0102" }"#);
/// assert!(reply.starts_with("{\"done\": \"P0102: "), "{reply}");
/// ```
#[must_use]
pub fn answer(request: &[u8]) -> String {
    let done = serde_json::from_slice(request)
        .map_err(|e| Refusal::input(format!("the request: {e}")))
        .and_then(answered);
    match done {
        Ok(done) => format!("{{\"done\": {done}}}"),
        Err(refusal) => format!("{{\"refused\": {}}}", refused(&refusal)),
    }
}

fn answered(request: Request) -> Result<String, Refusal> {
    match request {
        Request::About => json(&about()),
        Request::Ask(asked) => ask::answered(&asked),
        Request::Diagnose { scene } => json(&problems_of(&scene)),
        Request::Complete { text, offset } => json(&keys::complete(&text, offset)),
        Request::Hover { text, offset } => json(&keys::hover(&text, offset)),
        Request::Place { scene, body, pose } => json(&drag::placed(&scene, &body, &pose)?),
        Request::Retype { scene, replace } => json(&with_types(&scene, &replace)?),
        Request::Page { scene, dragged } => json(&ask::page(&scene, dragged)?),
        Request::Picture { scene } => json(&ask::picture(&scene)?),
        Request::Import { name, text } => json(&imported(&name, &text)?),
        Request::Explain { code } => json(&explain::words(explain::entry(&code)?)),
    }
}

fn json(value: &impl Serialize) -> Result<String, Refusal> {
    serde_json::to_string(value).map_err(|e| Refusal::stopped(e.to_string()))
}

/// Returns the document of a refusal, with marks in the text of the scene.
fn refused(refusal: &Refusal) -> String {
    #[derive(Serialize)]
    struct Refused<'r> {
        error: String,
        code: Option<String>,
        problems: &'r [Problem],
    }
    let text = match refusal {
        Refusal::Scene { text, .. } => text,
        Refusal::Input(..) | Refusal::Stopped(..) => "",
    };
    let document = refusal.document();
    let problems = refusal.problems().iter();
    let problems: Vec<Problem> = problems.map(|d| problem(text, d)).collect();
    let refused = Refused {
        error: document.error,
        code: document.code.map(|code| code.to_string()),
        problems: &problems,
    };
    serde_json::to_string(&refused).unwrap_or_default()
}

fn problem(text: &str, diagnostic: &Diagnostic) -> Problem {
    let labels = std::iter::once(&diagnostic.primary).chain(&diagnostic.secondary);
    let mark = |label: &pfaff::scene::Label| Mark {
        from: position::to_utf16(text, label.span.start),
        to: position::to_utf16(text, label.span.end),
        text: label.text.clone(),
    };
    Problem {
        severity: serde_json::to_value(diagnostic.severity).unwrap_or_default(),
        code: diagnostic.code.to_string(),
        message: diagnostic.message.clone(),
        help: diagnostic.help.clone(),
        marks: labels.map(mark).collect(),
    }
}

/// Returns the errors of a scene, or the warnings of a valid scene.
fn problems_of(scene: &Source) -> Vec<Problem> {
    let read = pfaff::scene::read(&scene.name, &scene.text, &REGISTRY);
    let found = read.map_or_else(|errors| errors, |read| read.warnings);
    found.iter().map(|d| problem(&scene.text, d)).collect()
}

/// The content of the program that a page lists.
#[derive(Serialize)]
struct About {
    version: &'static str,
    questions: Vec<Value>,
    examples: Vec<Value>,
}

fn about() -> About {
    let question = |facts: &pfaff::questions::Facts| serde_json::json!({ "name": facts.name, "scenes": facts.scenes });
    let example = |own: &Template| serde_json::json!({ "name": own.name(), "summary": own.summary(), "text": own.text() });
    About {
        version: env!("CARGO_PKG_VERSION"),
        questions: Questions::FACTS.iter().map(question).collect(),
        examples: Template::ALL.iter().map(example).collect(),
    }
}

fn with_types(scene: &Source, replace: &[Replacement]) -> Result<String, Refusal> {
    let spec = |name: &str| {
        let all = [SpaceKind::Plane, SpaceKind::Space3];
        let mut specs = all
            .into_iter()
            .flat_map(|space| REGISTRY.constraints_in(space));
        let found = specs.find(|spec| spec.common.scene_type == name);
        found.map(|spec| &spec.common)
    };
    let change = |own: &Replacement| {
        let (from, to) = (spec(&own.from)?, spec(&own.to)?);
        let known = |name: &str| to.parameters.iter().find(|p| p.name == name);
        let directions = own.directions.iter();
        let directions = directions.map(|(key, v)| Some((known(key)?.name, v.clone())));
        Some(RetypedJoint {
            joint: own.joint.clone(),
            from,
            to,
            directions: directions.collect::<Option<_>>()?,
        })
    };
    let changes: Option<Vec<RetypedJoint>> = replace.iter().map(change).collect();
    let text = changes.and_then(|own| retyped(&scene.text, &own.iter().collect::<Vec<_>>()));
    text.ok_or_else(|| {
        Refusal::input("the joints cannot be replaced: edit the text instead".to_owned())
    })
}

fn imported(name: &str, text: &str) -> Result<Value, Refusal> {
    let imported = import::import(name, text, &import::Options::default());
    let imported = imported.map_err(|refusal| Refusal::from(*refusal))?;
    let left_out = imported.left_out();
    Ok(serde_json::json!({
        "text": imported.scene,
        "format": imported.format,
        "remarks": imported.remarks,
        "left_out": left_out,
    }))
}
