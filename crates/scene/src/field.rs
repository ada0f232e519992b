//! One value of the file that is read as the expected type. If the type of the value differs, the
//! message contains both types.

use std::borrow::Cow;
use std::fmt::Display;
use std::ops::Range;
use std::rc::Rc;
use std::slice;

use joints::{LARGEST, Space3, is_usable};
use linalg::Dd;
use model::codes::Code;
use model::law::Operation;
use model::{Function, Law};
use toml::Spanned;
use toml::de::{DeInteger, DeValue};

use crate::dimension::Dimension;
use crate::expression::{Fault, Problem, Quantity, Scope, decimal};
use crate::findings::Findings;
use crate::language::Language;
use crate::mistake::Mistake;
use crate::plausible::angles::{Degrees, Number, degrees};
use crate::space::{self, SceneSpace};
use crate::table::Table;
use crate::{expression, nearest, units};

/// Relative accuracy of a value after half of its digits have cancelled.
const CANCELLED: f64 = 1e-8;

/// A value with its key.
#[derive(Clone)]
pub(crate) struct Field<'t> {
    /// Description of the table that contains the value.
    pub(crate) subject: Rc<str>,
    /// Key of the value.
    pub(crate) key: Cow<'t, str>,
    /// The value.
    pub(crate) value: &'t Spanned<DeValue<'t>>,
    /// Meaning of the numbers in the value.
    pub(crate) language: &'t Language,
    /// The list to which problems are added.
    pub(crate) findings: &'t Findings<'t>,
}

impl<'t> Field<'t> {
    pub(crate) fn span(&self) -> Range<usize> {
        self.value.span()
    }

    /// Reports an error at the value; the text before the message is the description of the table.
    pub(crate) fn error(
        &self,
        code: impl Into<Code>,
        message: impl Display,
        label: impl Into<String>,
    ) {
        self.error_with_help(code, message, label, None);
    }

    /// Reports an error at the value with advice.
    pub(crate) fn error_with_help(
        &self,
        code: impl Into<Code>,
        message: impl Display,
        label: impl Into<String>,
        help: impl Into<Option<String>>,
    ) {
        let message = format!("{}{message}", self.subject);
        let findings = self.findings;
        findings.error_with_help(code, self.span(), message, label, help);
    }

    /// Reports that a value of another kind was expected.
    pub(crate) fn mismatch(&self, expected: &str) {
        self.is_not(expected, Mistake::Type, None);
    }

    /// Reports a list of `found` values where a list of `n` values is expected.
    pub(crate) fn miscount(&self, expected: &str, found: usize, n: usize) {
        let mistake = if found == n {
            Mistake::Type
        } else {
            Mistake::Count
        };
        self.is_not(expected, mistake, None);
    }

    fn is_not(&self, expected: &str, mistake: Mistake, help: Option<String>) {
        let text = self.value.get_ref().as_str();
        let of_text = || {
            text.filter(|_| expected.contains("number"))
                .and_then(|text| {
                    if units::is_number(text) {
                        Some(format!(
                            "numbers have no quotes: write `{text}` instead of `\"{text}\"`"
                        ))
                    } else {
                        const COMPUTED: &str = "texts are computed with `format = 2` in `[scene]`";
                        units::advice(text).or_else(|| Some(COMPUTED.to_owned()))
                    }
                })
        };
        self.error_with_help(
            mistake,
            format!(
                ": `{}` must be {expected}, found {}",
                self.key,
                found(self.value.get_ref())
            ),
            format!("expected {expected}"),
            help.or_else(of_text),
        );
    }

    /// Reads a text.
    pub(crate) fn text(&self, expected: &str) -> Option<&'t str> {
        let text = self.value.get_ref().as_str();
        if text.is_none() {
            self.mismatch(expected);
        }
        text
    }

    /// Reads `true` or `false`.
    pub(crate) fn boolean(&self) -> Option<bool> {
        let value = self.value.get_ref().as_bool();
        if value.is_none() {
            self.mismatch("true or false");
        }
        value
    }

    /// Returns whether the value may be a number, that is, a number or an expression.
    pub(crate) fn may_be_number(&self) -> bool {
        let value = self.value.get_ref();
        as_number(value).is_some() || (self.language.computes && value.is_str())
    }

    /// Reads a finite number of this dimension.
    pub(crate) fn number(&self, of: Dimension) -> Option<f64> {
        self.number_expected("a number", of)
    }

    /// Reads a finite number of this dimension; `expected` is a more detailed description of the
    /// number.
    pub(crate) fn number_expected(&self, expected: &str, of: Dimension) -> Option<f64> {
        let number = self.judged_later(expected, of)?;
        warn_of_degrees(slice::from_ref(self), &[number]);
        Some(number.value)
    }

    /// Returns whether the value is a text with the value of an expression.
    pub(crate) fn is_expression(&self) -> bool {
        let text = self.value.get_ref().as_str();
        let text = text.filter(|_| self.language.computes);
        text.is_some_and(|text| expression::evaluate(text, self.language).is_ok())
    }

    /// Reads a finite number of this dimension; the caller must check whether it is plausible.
    fn judged_later(&self, expected: &str, of: Dimension) -> Option<Number> {
        let written = self.quantity(expected, self.language)?;
        let bases = self.language.bases();
        match written.at(of, bases) {
            Ok(q) => {
                self.warn_if_cancelled(q);
                let one = Quantity::bare(Dd::ONE).at(of, bases);
                let scale = one.map_or(1.0, Quantity::to_f64);
                if written.dimension.is_none() && scale != 1.0 {
                    self.findings.scaled(self.span().start, scale);
                }
                Some(Number::new(q.to_f64(), &written, of, bases.angle))
            }
            Err(problem) => {
                let span = 0..self.value.get_ref().as_str().unwrap_or_default().len();
                self.report(Fault { span, problem }, self.language, &[]);
                None
            }
        }
    }

    /// Reads a finite number, or the value of an expression. Bare numbers do not have a dimension
    /// yet.
    pub(crate) fn quantity(&self, expected: &str, language: &Language) -> Option<Quantity> {
        if let Some(text) = self.value.get_ref().as_str().filter(|_| language.computes) {
            return self.accept(expression::evaluate(text, language), language, &[]);
        }
        let Some(value) = as_number(self.value.get_ref()) else {
            self.mismatch(expected);
            return None;
        };
        if !is_usable(value) {
            self.error(
                Mistake::NotFinite,
                format!(
                    ": `{}` is {value:?}, need a finite number up to {LARGEST:e}",
                    self.key
                ),
                "not a usable number",
            );
            return None;
        }
        Some(Quantity::bare(match self.value.get_ref() {
            DeValue::Float(x) if language.computes => decimal(x.as_str()),
            _ => value.into(),
        }))
    }

    /// Reads a force law along a joint coordinate of dimension `of`, with a force or torque of
    /// dimension `result`.
    pub(crate) fn law(&self, expected: &str, of: Dimension, result: Dimension) -> Option<Law> {
        let Some(text) = self.value.get_ref().as_str() else {
            let value = self.number_expected(expected, result)?;
            return Law::new(&[Operation::Number(value)]).ok();
        };
        let law = expression::law(text, of, result, self.language);
        self.accept(law, self.language, expression::OF_LAW)
    }

    /// Returns whether the value is an expression that contains the time.
    pub(crate) fn is_of_time(&self) -> bool {
        let text = self.value.get_ref().as_str();
        let text = text.filter(|_| self.language.computes).unwrap_or_default();
        let mut names = expression::names(text).into_iter();
        names.any(|(name, _)| name == expression::TIME)
    }

    /// Reads an expression of the time with values of this dimension.
    pub(crate) fn of_time(&self, of: Dimension) -> Option<Function> {
        let text = self.value.get_ref().as_str().unwrap_or_default();
        let function = expression::of_time(text, of, self.language);
        self.accept(function, self.language, expression::OF_TIME)
    }

    /// Reports the errors in an expression of these variables, or returns its value.
    fn accept<T>(
        &self,
        value: Result<T, Vec<Fault>>,
        language: &Language,
        variables: &[&str],
    ) -> Option<T> {
        let report = |faults: Vec<Fault>| {
            faults
                .into_iter()
                .for_each(|fault| self.report(fault, language, variables));
        };
        value.map_err(report).ok()
    }

    /// Reports an error in an expression, at its position.
    fn report(&self, fault: Fault, language: &Language, variables: &[&str]) {
        let Fault { span, problem } = fault;
        let text = self.value.get_ref().as_str().unwrap_or_default();
        if language.is_unfit(text, &span) {
            return;
        }
        if let Problem::Twice { name } = problem {
            // The error has the position of the parameter, so that all uses of the parameter are
            // one error.
            let place = language.position(name).unwrap_or_else(|| self.part(span));
            let code = Mistake::from(&problem);
            let (message, help) = (problem.to_string(), problem.help());
            let findings = self.findings;
            return findings.error_with_help(code, place, message, problem.label(), help);
        }
        let mut label = problem.label().to_owned();
        let mut help = problem.help();
        if let Problem::UnknownName { name } | Problem::UnknownFunction { name } = &problem {
            match self.findings.suggest(name, language.names()) {
                Some(near) => label = format!("did you mean `{near}`?"),
                None if help.is_some() => {}
                None => {
                    let parameters = nearest::all("parameters", language.own_names());
                    let variables = nearest::all("variables", variables.iter().copied());
                    let both: Vec<String> = variables.into_iter().chain(parameters).collect();
                    help = (!both.is_empty()).then(|| both.join(", "));
                }
            }
        }
        let message = format!("{}: `{}`: {problem}", self.subject, self.key);
        self.findings.error_with_help(
            Mistake::from(&problem),
            self.part(span),
            message,
            label,
            help,
        );
    }

    /// Warns if a difference of nearly equal numbers loses digits.
    fn warn_if_cancelled(&self, q: Quantity) {
        let value = q.to_f64();
        let share = q.error / value.abs();
        if value != 0.0 && share > CANCELLED {
            self.findings.warning(
                const { Code::new(190) },
                self.span(),
                format!(
                    "{}: `{}` is a small difference of larger numbers: it is accurate to {share:.0e} of its value",
                    self.subject, self.key
                ),
                "digits cancel",
                "write it in another way, or state a `tolerance`",
            );
        }
    }

    /// Reads an integer within the range of the type.
    pub(crate) fn integer(&self, expected: &str) -> Option<i64> {
        let value = match self.value.get_ref() {
            DeValue::Integer(n) => i64::from_str_radix(n.as_str(), n.radix()).ok(),
            _ => None,
        };
        if value.is_none() {
            self.mismatch(expected);
        }
        value
    }

    /// Returns the values of a list; each has the key of the list.
    pub(crate) fn items(&self, expected: &str) -> Option<Vec<Self>> {
        let Some(array) = self.value.get_ref().as_array() else {
            self.mismatch(expected);
            return None;
        };
        let item = |value| Self {
            value,
            ..self.clone()
        };
        Some(array.iter().map(item).collect())
    }

    /// Reads a list of `n` finite numbers.
    pub(crate) fn numbers(
        &self,
        n: usize,
        expected: &str,
        of: impl Fn(usize) -> Dimension,
    ) -> Option<Vec<f64>> {
        let items = self.items(expected)?;
        let is_nested = |item: &Self| item.value.get_ref().is_array();
        if items.len() != n || items.iter().any(is_nested) {
            self.miscount(expected, items.len(), n);
            return None;
        }
        each(&items, of)
    }

    /// Reads a list of any number of finite numbers; `of` is the dimension of each number.
    pub(crate) fn any_numbers(&self, of: impl Fn(usize) -> Dimension) -> Option<Vec<f64>> {
        each(&self.items("a list of numbers")?, of)
    }

    /// Reads the components of a vector, finite numbers of one dimension.
    pub(crate) fn vector<S: SceneSpace>(
        &self,
        expected: &str,
        of: Dimension,
    ) -> Option<S::Vector<f64>> {
        let length = self.value.get_ref().as_array().map(|list| list.len());
        if let Some(n) = length
            && let Some(space) = space::of_length(S::NAME, n)
        {
            let help = format!("vectors of {n} components belong to `space = \"{space}\"`");
            self.is_not(expected, Mistake::Count, Some(help));
            return None;
        }
        let numbers = self.numbers(S::DIM, expected, |_| of)?;
        S::of_numbers(&numbers)
    }

    /// Reads a matrix: three rows of three numbers.
    pub(crate) fn matrix(&self, expected: &str, of: Dimension) -> Option<[[f64; 3]; 3]> {
        let rows = self.items(expected)?;
        if rows.len() != 3 {
            self.miscount(expected, rows.len(), 3);
            return None;
        }
        let rows = all(&rows, |row| {
            row.vector::<Space3>("a row of three numbers", of)
        });
        rows?.try_into().ok()
    }

    /// Reads `n` points.
    pub(crate) fn points<S: SceneSpace>(
        &self,
        n: usize,
        expected: &str,
    ) -> Option<Vec<S::Vector<f64>>> {
        let items = self.items(expected)?;
        if items.len() != n || items.iter().any(|item| !item.value.get_ref().is_array()) {
            self.miscount(expected, items.len(), n);
            return None;
        }
        all(&items, |item| item.vector::<S>(S::POINT, Dimension::LENGTH))
    }

    /// Reads a table.
    pub(crate) fn table(&self, expected: &str) -> Option<Table<'t>> {
        let Some(entries) = self.value.get_ref().as_table() else {
            self.mismatch(expected);
            return None;
        };
        let subject = format!("{}: `{}`", self.subject, self.key);
        Some(Table::new(
            subject,
            self.span(),
            entries,
            (self.language, self.findings),
        ))
    }

    /// Returns the position in the file of a part of the text that this field contains. The
    /// argument is the range of the part within the text. If the file contains escape sequences in
    /// the text, the result is the position of the whole value.
    pub(crate) fn part(&self, part: Range<usize>) -> Range<usize> {
        let whole = self.span();
        let text = self.value.get_ref().as_str().unwrap_or_default();
        let written = self.findings.source.text().get(whole.clone());
        match written.unwrap_or_default().find(text) {
            Some(at) if !text.is_empty() => {
                let begin = whole.start + at;
                begin + part.start..begin + part.end
            }
            _ => whole,
        }
    }
}

/// Reads numbers with the dimension of each.
fn each(items: &[Field], of: impl Fn(usize) -> Dimension) -> Option<Vec<f64>> {
    let mut k = 0..;
    let numbers = all(items, |item| item.judged_later("a number", of(k.next()?)))?;
    warn_of_degrees(items, &numbers);
    Some(numbers.iter().map(|number| number.value).collect())
}

/// Warns if numbers in these fields look like angles in degrees.
fn warn_of_degrees(fields: &[Field], numbers: &[Number]) {
    let Some(language) = fields.first().map(|field| field.language) else {
        return;
    };
    if let Some(Degrees { at, message, help }) = degrees(numbers, language) {
        let Field { subject, key, .. } = &fields[at];
        fields[at].findings.warning(
            const { Code::new(192) },
            fields[at].span(),
            format!("{subject}: `{key}` {message}"),
            "in radians",
            &help,
        );
    }
}

/// Reads all values. A value that cannot be read does not prevent the reading of the other values.
pub(crate) fn all<X, Y>(from: &[X], read: impl FnMut(&X) -> Option<Y>) -> Option<Vec<Y>> {
    let read: Vec<_> = from.iter().map(read).collect();
    read.into_iter().collect()
}

/// Converts an integer or a float to a float; a value that is too large becomes infinite.
pub(crate) fn as_number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Float(x) => x.as_str().parse().ok(),
        DeValue::Integer(n) if n.radix() == 10 => n.as_str().parse().ok(),
        DeValue::Integer(n) => whole(n),
        _ => None,
    }
}

/// Converts an integer in another base, if a float can represent it.
fn whole(n: &DeInteger) -> Option<f64> {
    #[expect(
        clippy::cast_precision_loss,
        reason = "numbers in TOML are decimal fractions"
    )]
    u64::from_str_radix(n.as_str(), n.radix())
        .ok()
        .map(|n| n as f64)
}

/// Length of the longest text that a message quotes.
const EXCERPT: usize = 40;

/// Describes the type of a value.
pub(crate) fn found(value: &DeValue) -> String {
    match value {
        DeValue::String(text) if text.chars().count() <= EXCERPT => format!("the text {text:?}"),
        DeValue::String(_) => "a long text".to_owned(),
        DeValue::Integer(_) | DeValue::Float(_) => match as_number(value) {
            Some(x) => format!("the number {x}"),
            None => "a number that cannot be read".to_owned(),
        },
        DeValue::Boolean(value) => format!("`{value}`"),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(values) if values.len() == 1 => "a list of 1 value".to_owned(),
        DeValue::Array(values) => format!("a list of {} values", values.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
