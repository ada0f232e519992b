//! The values of the parameters of a definition, and the element built from them.

use std::ops::Range;

use joints::spec::{Shape, Spec, Unit};
use joints::{Argument, ArgumentError};
use model::Function;

use crate::dimension::Dimension;
use crate::field::{Field, all};
use crate::findings::Findings;
use crate::function::{self, Domain};
use crate::mistake::Mistake;
use crate::place::Place;
use crate::table::Table;

/// Values in the order of the parameters. A value that could not be read is replaced by a valid
/// one, so that the others are still checked.
pub(crate) struct Arguments {
    pub(crate) values: Vec<Argument>,
    pub(crate) functions: Vec<Function>,
    spans: Vec<Range<usize>>,
    complete: bool,
}

impl Arguments {
    /// Reads all parameters of a definition except the points, which are read with its place.
    pub(crate) fn read(
        table: &mut Table,
        spec: &'static Spec,
        place: Place,
        domains: &mut Vec<Domain>,
        findings: &mut Findings,
    ) -> Self {
        let mut arguments = Self {
            values: Vec::new(),
            functions: Vec::new(),
            spans: Vec::new(),
            complete: true,
        };
        let mut points = place.points.into_iter();
        for parameter in spec.parameters {
            if let Shape::Point { .. } = parameter.shape {
                let point = points.next().flatten().map(Argument::Pair);
                arguments.push(point, parameter.shape, place.span.clone());
                continue;
            }
            let key = parameter.name;
            let field = if parameter.optional {
                table.optional(key)
            } else {
                table.needed(key, parameter.shape.words(2), findings)
            };
            let Some(field) = field else {
                let absent = parameter.optional.then_some(Argument::Absent);
                arguments.push(absent, parameter.shape, table.header.clone());
                continue;
            };
            let value = match parameter.shape {
                Shape::Functions(units) => {
                    let functions = functions(&field, units, parameter.shape, domains, findings);
                    arguments.complete &= functions.is_some();
                    arguments.functions.extend(functions.unwrap_or_default());
                    Some(Argument::Absent)
                }
                shape => value(&field, shape, findings),
            };
            arguments.push(value, parameter.shape, field.span());
        }
        arguments
    }

    fn push(&mut self, value: Option<Argument>, shape: Shape, span: Range<usize>) {
        self.complete &= value.is_some();
        self.values.push(value.unwrap_or_else(|| harmless(shape)));
        self.spans.push(span);
    }

    /// Builds the element and reports everything that its definition refuses. Returns `None` if
    /// anything is wrong.
    pub(crate) fn build<E>(
        &mut self,
        spec: &'static Spec,
        subject: &str,
        build: fn(&[Argument]) -> Result<E, ArgumentError>,
        findings: &mut Findings,
    ) -> Option<E> {
        // A definition reports only its first fault: replace the value by a valid one and try
        // again.
        for _ in 0..=spec.parameters.len() {
            let error = match build(&self.values) {
                Ok(element) => return self.complete.then_some(element),
                Err(error) => error,
            };
            let at = error
                .parameter()
                .and_then(|name| spec.parameters.iter().position(|p| p.name == name))?;
            findings.error(
                Mistake::from(&error),
                self.spans[at].clone(),
                format!("{subject}: {error}"),
                label(&error),
            );
            self.values[at] = harmless(spec.parameters[at].shape);
            self.complete = false;
        }
        None
    }
}

/// A value that every definition accepts.
fn harmless(shape: Shape) -> Argument {
    match shape {
        Shape::Point { .. } | Shape::Direction { .. } => Argument::Pair([1.0, 0.0]),
        Shape::Axes { .. } => Argument::Triple([1.0, 0.0, 0.0]),
        Shape::GroundLine => Argument::Pairs([[0.0, 0.0], [1.0, 0.0]]),
        Shape::GroundPlane => Argument::Triples([[0.0; 3], [0.0, 0.0, 1.0]]),
        Shape::Numbers(units) => Argument::Numbers(vec![1.0; units.len()]),
        Shape::Functions(_) => Argument::Absent,
    }
}

fn label(error: &ArgumentError) -> &'static str {
    match error {
        ArgumentError::Negative { .. } => "may not be negative",
        ArgumentError::NoDirection { .. } => "has no direction",
        ArgumentError::NotFinite { .. } => "not a usable number",
        _ => "not possible",
    }
}

/// The value of a parameter that does not depend on time.
fn value(field: &Field, shape: Shape, findings: &mut Findings) -> Option<Argument> {
    let expected = shape.words(2).to_string();
    match shape {
        Shape::Point { .. } => {
            let pair = field.pair(&expected, Dimension::LENGTH, findings);
            pair.map(Argument::Pair)
        }
        Shape::Direction { .. } => {
            let pair = field.pair(&expected, Dimension::NONE, findings);
            pair.map(Argument::Pair)
        }
        // Definitions of space are in no registry of scenes.
        Shape::Axes { .. } | Shape::GroundPlane => None,
        Shape::GroundLine => {
            let points = field.pairs(2, &expected, findings)?;
            points.try_into().ok().map(Argument::Pairs)
        }
        Shape::Numbers([unit]) => {
            let number = field.number_expected(&expected, (*unit).into(), findings)?;
            Some(Argument::Numbers(vec![number]))
        }
        Shape::Numbers(units) => field
            .numbers(units.len(), &expected, |k| units[k].into(), findings)
            .map(Argument::Numbers),
        Shape::Functions(_) => Some(Argument::Absent),
    }
}

/// One function, or a list of them.
fn functions(
    field: &Field,
    units: &[Unit],
    shape: Shape,
    domains: &mut Vec<Domain>,
    findings: &mut Findings,
) -> Option<Vec<Function>> {
    if let [unit] = units {
        return function::read(field, (*unit).into(), domains, findings).map(|f| vec![f]);
    }
    let items = field.items(&shape.words(2).to_string(), findings)?;
    if items.len() != units.len() {
        field.miscount(
            &shape.words(2).to_string(),
            items.len(),
            units.len(),
            findings,
        );
        return None;
    }
    let mut units = units.iter();
    all(&items, |item| {
        function::read(item, (*units.next()?).into(), domains, findings)
    })
}
