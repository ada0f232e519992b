//! Questions about scenes. Files of an answer are written to the directory of the module, which
//! belongs to the page.

use std::cell::RefCell;
use std::io::{Write, stdout};
use std::rc::Rc;

use pfaff::memory::{Budget, Bytes};
use pfaff::question::{Control, Ending, Place, Progress};
use pfaff::questions::Questions;
use pfaff::refusal::Refusal;
use pfaff::report::{FileError, OutputDirectory};
use pfaff::start::Start;
use pfaff::view::{Drawing, Form};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use serde_json::value::RawValue;

use crate::registry::REGISTRY;

/// Directory of the module for the files of answers.
const OUT: &str = "out";

/// The memory of a page (bytes). A module of 32-bit WebAssembly has at most 4 GiB, and a browser
/// ends a page earlier.
const MEMORY: u64 = 2_000_000_000;

/// A scene with its name in messages.
#[derive(Deserialize, Clone, PartialEq)]
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) text: String,
}

/// A question about scenes.
#[derive(Deserialize)]
pub(crate) struct Ask {
    question: String,
    #[serde(default)]
    options: Option<Value>,
    scenes: Vec<Source>,
    /// Whether the text of the answer has details.
    #[serde(default)]
    verbose: bool,
    /// Whether numbers of the text are in SI units without prefixes.
    #[serde(default)]
    si: bool,
    /// Whether files are also written that can be written after the computation.
    #[serde(default)]
    files: bool,
}

/// An answer.
#[derive(Serialize)]
struct Answered {
    document: Box<RawValue>,
    text: String,
    /// Whether the answer is complete.
    complete: bool,
}

thread_local! {
    /// The scene of the last request with its results, because a page asks several questions about
    /// the same text.
    static LAST: RefCell<Option<Rc<Start<'static>>>> = const { RefCell::new(None) };
}

/// Returns the start of a scene. Results for the same text are reused.
pub(crate) fn start(source: &Source) -> Rc<Start<'static>> {
    LAST.with_borrow_mut(|last| {
        if let Some(start) = last
            && (&start.name, &start.text) == (&source.name, &source.text)
        {
            return Rc::clone(start);
        }
        let budget = Budget {
            limit: Some(Bytes(MEMORY)),
            option: "a page",
        };
        let Source { name, text } = source.clone();
        let start = Rc::new(Start::new(name, text, &REGISTRY, budget));
        *last = Some(Rc::clone(&start));
        start
    })
}

/// Answers a question.
pub(crate) fn answered(asked: &Ask) -> Result<String, Refusal> {
    let options = asked
        .options
        .as_ref()
        .map_or("{}".to_owned(), Value::to_string);
    let question = Questions::read(&asked.question, &options)?;
    let scenes: Vec<Rc<Start<'static>>> = asked.scenes.iter().map(start).collect();
    let scenes: Vec<&Start<'_>> = scenes.iter().map(Rc::as_ref).collect();
    let output = question.facts().output;
    let output = output.filter(|output| asked.files || output.is_streamed());
    let directory = output.map(|_| OutputDirectory::create(OUT)).transpose()?;
    let control = Control {
        progress: &announce,
        wants_words: true,
        wants_files: directory.is_some(),
        directory: directory.as_ref(),
        is_si: asked.si,
        ..Control::quiet()
    };
    let answer = question.as_question().ask(&scenes, &control)?;
    if let (Some(output), Some(directory)) = (output, &directory)
        && !output.is_streamed()
    {
        answer.files(&mut Files(directory))?;
    }
    let document = RawValue::from_string(answer.json()?);
    let answered = Answered {
        document: document.map_err(|e| Refusal::stopped(e.to_string()))?,
        text: answer.text(asked.verbose),
        complete: answer.ending() == Ending::Complete,
    };
    serde_json::to_string(&answered).map_err(|e| Refusal::stopped(e.to_string()))
}

/// Returns the page of the start of a scene.
pub(crate) fn page(source: &Source, is_dragged: bool) -> Result<String, Refusal> {
    let (start, control) = (start(source), Control::quiet());
    let drawing = if is_dragged {
        Drawing::while_dragged(&start, &control)?
    } else {
        Drawing::new(&start, Form::Page, None, &control)?
    };
    Ok(text(&drawing))
}

/// Returns the start of a scene as an SVG picture.
pub(crate) fn picture(source: &Source) -> Result<String, Refusal> {
    let drawing = Drawing::new(&start(source), Form::Svg, None, &Control::quiet())?;
    Ok(text(&drawing))
}

fn text(drawing: &Drawing) -> String {
    String::from_utf8_lossy(&drawing.content).into_owned()
}

/// Writes the progress as one line of JSON to the standard output, which the page reads.
fn announce(progress: Progress) {
    let line = match progress {
        Progress::Stage(what, _) => serde_json::json!({ "what": what }),
        Progress::Count(what, done, all) => {
            serde_json::json!({ "what": what, "done": done, "all": all })
        }
        Progress::Runs(done, all, what) => {
            serde_json::json!({ "what": what, "done": done, "all": all })
        }
        Progress::Motion(what, t, end) => {
            serde_json::json!({ "what": what, "done": t, "all": end })
        }
        Progress::Writing(_) => return,
    };
    // A page that does not listen misses only the progress.
    let _ = writeln!(stdout(), "{line}");
}

/// The files of an answer, written into a directory.
struct Files<'d>(&'d OutputDirectory);

impl Place for Files<'_> {
    fn put(&mut self, name: &str, content: &[u8]) -> Result<(), FileError> {
        self.0.write(name, content).map(|_| ())
    }
}
