//! Findings that are made while a file is read: problems that cause the rejection of the file,
//! content that the scene omits, and the number of digits.

use std::ops::Range;

use model::codes::Code;
use scene::{Diagnostic, SourceText};

use crate::angles::{Suspects, is_beyond_a_turn, is_common_in_radians};
use crate::digits::Digits;
use crate::limits::{LARGEST_NUMBER, MOST_PROBLEMS};
use crate::xml::{Element, Value};

/// Advice for converting a file with macros to one without macros.
pub(crate) const EXPAND: &str = "expand it with xacro: xacro robot.urdf.xacro > robot.urdf";

/// A kind of fault of a file.
#[derive(Clone, Copy)]
pub(crate) enum Fault {
    /// The root element belongs to no supported format.
    Format,
    /// An element or attribute is missing.
    Missing,
    /// A text is not of the expected kind, such as a number, a word, or a list of a given length.
    Value,
    /// A name that does not exist.
    Unknown,
    /// An attribute or element that does not exist in the format.
    Name,
    /// A name that is used twice.
    Twice,
    /// Content that changes the mechanism and is not supported.
    Unsupported,
    /// Links and joints that are inconsistent.
    Structure,
    /// A number that is not possible for a body or joint, such as a negative mass.
    Range,
    /// An included file that cannot be used.
    Include,
    /// A file of loop closures that cannot be read.
    Loops,
    /// Loops that are open at every pose that the search finds.
    Assembly,
}

impl Fault {
    fn code(self) -> Code {
        match self {
            Self::Format => const { Code::new(602) },
            Self::Missing => const { Code::new(604) },
            Self::Value => const { Code::new(605) },
            Self::Unknown => const { Code::new(606) },
            Self::Twice => const { Code::new(607) },
            Self::Unsupported => const { Code::new(608) },
            Self::Structure => const { Code::new(609) },
            Self::Range => const { Code::new(610) },
            Self::Include => const { Code::new(611) },
            Self::Loops => const { Code::new(612) },
            Self::Assembly => const { Code::new(613) },
            Self::Name => const { Code::new(614) },
        }
    }
}

/// Content of the file that the scene does not contain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Omission {
    /// Kind of the content, as text.
    pub kind: &'static str,
    /// Name of the content.
    pub subject: String,
    /// Name of the file, if it is an included file.
    pub file: Option<String>,
    /// Line of the content.
    pub line: usize,
}

/// All findings.
#[derive(Default)]
pub(crate) struct Findings {
    problems: Vec<Diagnostic>,
    more: usize,
    pub(crate) omissions: Vec<Omission>,
    /// Comments about the scene as a whole, for the first lines of its text.
    pub(crate) remarks: Vec<String>,
    /// Name of the given file. This file includes the other files.
    pub(crate) file: String,
    pub(crate) lengths: Digits,
    pub(crate) directions: Digits,
    /// Angles in rad that look like degrees.
    pub(crate) degrees: Suspects,
    /// Angles in degrees that look like rad.
    pub(crate) radians: Suspects,
}

/// Meaning of a number. Digits are counted separately for each meaning.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum NumberKind {
    Length,
    Direction,
    Other,
}

impl Findings {
    pub(crate) fn new(file: &str) -> Self {
        let file = file.to_owned();
        Self {
            file,
            ..Self::default()
        }
    }

    pub(crate) fn problem(&mut self, problem: Diagnostic) {
        if self.problems.len() < MOST_PROBLEMS {
            self.problems.push(problem);
        } else {
            self.more += 1;
        }
    }

    pub(crate) fn fault(
        &mut self,
        fault: Fault,
        source: &SourceText,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
    ) {
        self.problem(Diagnostic::error(
            fault.code(),
            source,
            span,
            message,
            label,
        ));
    }

    pub(crate) fn fault_with_help(
        &mut self,
        fault: Fault,
        source: &SourceText,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<Option<String>>,
    ) {
        let problem = Diagnostic::error(fault.code(), source, span, message, label);
        self.problem(problem.help(help));
    }

    /// A fault of an element.
    pub(crate) fn of(&mut self, fault: Fault, element: Element, message: impl Into<String>) {
        self.fault(fault, element.source, element.span(), message, "");
    }

    /// A fault of a value.
    pub(crate) fn at(&mut self, fault: Fault, value: &Value, message: impl Into<String>) {
        self.fault(fault, value.source, value.span.clone(), message, "");
    }

    pub(crate) fn missing(&mut self, element: Element, what: &str) {
        let message = format!("`<{}>` needs {what}", element.name());
        self.of(Fault::Missing, element, message);
    }

    /// Returns an attribute that the element must have.
    pub(crate) fn needed<'a>(&mut self, element: Element<'a>, key: &str) -> Option<Value<'a>> {
        let value = element.attribute(key);
        if value.is_none() {
            self.missing(element, &format!("`{key}`"));
        }
        value
    }

    /// Records content that the scene does not contain.
    pub(crate) fn leave(
        &mut self,
        kind: &'static str,
        subject: impl Into<String>,
        source: &SourceText,
        line: usize,
    ) {
        let file = (source.name() != self.file).then(|| source.name().to_owned());
        let subject = subject.into();
        self.omissions.push(Omission {
            kind,
            subject,
            file,
            line,
        });
    }

    /// Records an element that the scene does not contain.
    pub(crate) fn leave_element(&mut self, kind: &'static str, element: Element, subject: &str) {
        self.leave(kind, subject, element.source, element.line());
    }

    pub(crate) fn has_problems(&self) -> bool {
        !self.problems.is_empty()
    }

    /// Number of problems so far.
    pub(crate) fn count(&self) -> usize {
        self.problems.len() + self.more
    }

    /// Removes all problems after the first `count`.
    pub(crate) fn forget(&mut self, count: usize) {
        self.more = count.saturating_sub(self.problems.len());
        self.problems.truncate(count);
    }

    /// All problems, if there are any.
    pub(crate) fn refusal(&mut self) -> Option<(Vec<Diagnostic>, usize)> {
        let is_fine = self.problems.is_empty();
        (!is_fine).then(|| (std::mem::take(&mut self.problems), self.more))
    }

    /// The numbers of a value, which must be finite. At least `least` and at most `most` numbers
    /// are required.
    pub(crate) fn numbers(
        &mut self,
        value: &Value,
        [least, most]: [usize; 2],
        counted: NumberKind,
    ) -> Option<Vec<f64>> {
        let mut numbers = Vec::new();
        for word in value.text.split_whitespace() {
            let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
            let number = number.filter(|x| x.abs() <= LARGEST_NUMBER);
            let Some(number) = number else {
                let shown: String = word.chars().take(40).collect();
                let message = format!("{}: `{shown}` is not a finite number", value.subject);
                let help = word.contains("${").then(|| EXPAND.to_owned());
                let (source, span) = (value.source, value.span.clone());
                self.fault_with_help(Fault::Value, source, span, message, "", help);
                return None;
            };
            if numbers.len() > most {
                break;
            }
            match counted {
                NumberKind::Length => self.lengths.see(word),
                NumberKind::Direction => self.directions.see(word),
                NumberKind::Other => {}
            }
            numbers.push(number);
        }
        if (least..=most).contains(&numbers.len()) {
            return Some(numbers);
        }
        let need = if least == most {
            format!("{least}")
        } else {
            format!("{least} to {most}")
        };
        let found = numbers.len();
        let message = format!("{}: needs {need} numbers, found {found}", value.subject);
        self.at(Fault::Value, value, message);
        None
    }

    pub(crate) fn number(&mut self, value: &Value, counted: NumberKind) -> Option<f64> {
        self.numbers(value, [1, 1], counted)?.first().copied()
    }

    /// A number ≥ 0.
    pub(crate) fn not_negative(&mut self, value: &Value, counted: NumberKind) -> Option<f64> {
        let [number] = self.not_negatives(value, counted)?;
        Some(number)
    }

    /// `N` numbers ≥ 0.
    pub(crate) fn not_negatives<const N: usize>(
        &mut self,
        value: &Value,
        counted: NumberKind,
    ) -> Option<[f64; N]> {
        let numbers = self.numbers(value, [N, N], counted)?;
        if let Some(number) = numbers.iter().find(|x| **x < 0.0) {
            let message = format!("{} is {number}, which may not be negative", value.subject);
            self.at(Fault::Range, value, message);
            return None;
        }
        numbers.try_into().ok()
    }

    pub(crate) fn vector(
        &mut self,
        value: &Value,
        counted: NumberKind,
    ) -> Option<nalgebra::Vector3<f64>> {
        let numbers = self.numbers(value, [3, 3], counted)?;
        Some(nalgebra::Vector3::from_column_slice(&numbers))
    }

    /// A nonzero vector, scaled to length 1.
    pub(crate) fn direction(&mut self, value: &Value) -> Option<nalgebra::Vector3<f64>> {
        let vector = self.vector(value, NumberKind::Direction)?;
        let length = vector.norm();
        if length > 0.0 && length.is_finite() {
            return Some(unit(vector));
        }
        let message = format!("{} has length zero", value.subject);
        self.at(Fault::Range, value, message);
        None
    }

    /// Records angles in rad that look like degrees.
    pub(crate) fn look_for_degrees(&mut self, value: &Value, radians: &[f64]) {
        if let Some(angle) = radians.iter().find(|x| is_beyond_a_turn(**x)) {
            self.degrees.see(&value.subject, *angle, value.line());
        }
    }

    /// Records angles in degrees that look like rad.
    pub(crate) fn look_for_radians(&mut self, value: &Value, degrees: &[f64]) {
        if let Some(angle) = degrees.iter().find(|x| is_common_in_radians(**x)) {
            self.radians.see(&value.subject, *angle, value.line());
        }
    }

    /// `true` or `false`.
    pub(crate) fn boolean(&mut self, value: &Value) -> Option<bool> {
        match value.text.trim() {
            "true" | "1" => Some(true),
            "false" | "0" => Some(false),
            other => {
                let shown: String = other.chars().take(40).collect();
                let message = format!("{}: `{shown}` is neither true nor false", value.subject);
                self.at(Fault::Value, value, message);
                None
            }
        }
    }
}

/// Scales a vector to length 1. If its length is already 1 to within rounding, the digits do not
/// change.
pub(crate) fn unit(vector: nalgebra::Vector3<f64>) -> nalgebra::Vector3<f64> {
    let scaled = vector / vector.amax();
    let length = scaled.norm() * vector.amax();
    if (length - 1.0).abs() < 4.0 * f64::EPSILON {
        vector
    } else {
        scaled / scaled.norm()
    }
}
