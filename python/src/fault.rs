//! Errors of the library and panics as exceptions of one hierarchy, which `pfaff._errors` defines.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use pfaff::StudyError;
use pfaff::forked::on_this_thread;
use pfaff::refusal::{Refusal, json};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

/// The reason why a call has no result.
pub(crate) enum Fault {
    /// The library has rejected the input, or its computation has stopped.
    Refused(Box<Refusal>),
    /// A Python exception: Ctrl-C, or an exception of a callback.
    Raised(PyErr),
}

impl From<Refusal> for Fault {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(Box::new(refusal))
    }
}

impl From<PyErr> for Fault {
    fn from(raised: PyErr) -> Self {
        Self::Raised(raised)
    }
}

/// Converts an error about an object that was not read from a text, so that the message quotes no
/// text.
impl From<StudyError> for Fault {
    fn from(error: StudyError) -> Self {
        Refusal::of(("", ""), error).into()
    }
}

/// Builds the error for invalid input of the caller.
pub(crate) fn wrong(message: String) -> Fault {
    Refusal::input(message).into()
}

impl Fault {
    /// Returns the exception.
    pub(crate) fn raised(self, py: Python<'_>) -> PyErr {
        match self {
            Self::Refused(refusal) => exception(py, &refusal),
            Self::Raised(raised) => raised,
        }
    }
}

/// Does work on this thread without the interpreter, so that other Python threads can run. The
/// function is for short work and for work that calls Python repeatedly. A panic becomes an
/// exception.
pub(crate) fn guarded<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, Fault> + Send,
) -> PyResult<T> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(|| on_this_thread(work)))) {
        Ok(outcome) => outcome.map_err(|fault| fault.raised(py)),
        Err(panic) => Err(raised_by(py, panic.as_ref())),
    }
}

/// Builds the exception for an error of the library.
pub(crate) fn exception(py: Python<'_>, refusal: &Refusal) -> PyErr {
    let class = match refusal {
        Refusal::Scene { .. } => "SceneError",
        Refusal::Input(..) => "InputError",
        Refusal::Stopped(..) => "ComputationError",
    };
    let document = json(&refusal.document()).unwrap_or_default();
    let words = with_keywords(refusal.words(false).trim_end());
    made(py, class, &words, &with_keywords(&document))
}

/// Replaces options of the command in a text, such as `--at-time 2`, by Python keywords, such as
/// `at_time=2`.
fn with_keywords(text: &str) -> String {
    let mut words = text.split("--");
    let mut out = words.next().unwrap_or_default().to_owned();
    for rest in words {
        let end = rest.find(|c: char| !(c.is_ascii_lowercase() || c == '-'));
        let (name, rest) = rest.split_at(end.unwrap_or(rest.len()));
        let is_option = name.starts_with(|c: char| c.is_ascii_lowercase())
            && out.ends_with([' ', '`', '"', '\n']);
        let is_quoted = out.ends_with('`');
        if is_option {
            out.push_str(&name.replace('-', "_"));
        } else {
            out.extend(["--", name]);
        }
        match rest.strip_prefix(' ') {
            Some(value) if is_option && is_quoted => out.extend(["=", value]),
            _ => out.push_str(rest),
        }
    }
    out
}

/// Builds the exception for a panic.
pub(crate) fn raised_by(py: Python<'_>, panic: &(dyn Any + Send)) -> PyErr {
    let message = panic.downcast_ref::<String>().map(String::as_str);
    let message = message.or_else(|| panic.downcast_ref::<&str>().copied());
    let words = format!(
        "internal error of pfaff, which is a fault of pfaff: {}",
        message.unwrap_or("without a message")
    );
    made(py, "InternalError", &words, "")
}

fn made(py: Python<'_>, class: &str, words: &str, document: &str) -> PyErr {
    static ERRORS: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let made = || {
        let import = || Ok::<_, PyErr>(py.import("pfaff._errors")?.unbind());
        let errors = ERRORS.get_or_try_init(py, import)?;
        let class = errors.bind(py).getattr(class)?;
        class.call1((words, document))
    };
    made().map_or_else(|e| e, PyErr::from_value)
}

/// Panics, for the test that no panic leaves this module.
#[pyfunction]
#[pyo3(name = "_panics")]
pub(crate) fn panics(py: Python<'_>) -> PyResult<()> {
    guarded(py, || panic!("as the test wants"))
}

/// Returns the code of invalid input.
#[pyfunction]
pub(crate) fn input_code() -> String {
    let code = Refusal::input(String::new()).code();
    code.map_or_else(String::new, |code| code.to_string())
}
