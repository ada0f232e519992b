//! The values of the parameters of a definition, and the construction of the element from them.

use std::ops::Range;

use joints::spec::{Parameter, Shape, Spec, Unit};
use joints::{Argument, ArgumentError, Plane};
use model::Function;

use crate::argument_source::ArgumentSource;
use crate::dimension::Dimension;
use crate::direction::{self, Directions};
use crate::field::{Field, all};
use crate::function::{self, Domain};
use crate::mistake::Mistake;
use crate::place::Place;
use crate::space::SceneSpace;
use crate::table::Table;

/// Values in the order of the parameters. A value that could not be read is replaced by a valid
/// one, so that the other values can still be checked.
pub(crate) struct Arguments {
    pub(crate) values: Vec<Argument>,
    pub(crate) functions: Vec<Function>,
    spans: Vec<Range<usize>>,
    complete: bool,
}

impl Arguments {
    /// Reads all parameters of a definition except the points; points are read together with the
    /// reference point.
    pub(crate) fn read<S: SceneSpace>(
        table: &mut Table,
        spec: &'static Spec,
        place: Place<S>,
        directions: &Directions<S>,
        domains: &mut Vec<Domain>,
    ) -> Self {
        let mut arguments = Self {
            values: Vec::new(),
            functions: Vec::new(),
            spans: Vec::new(),
            complete: true,
        };
        let mut points = place.points.into_iter();
        for (k, parameter) in spec.parameters.iter().enumerate() {
            if let Some((own, span)) = directions.given(spec, k) {
                arguments.push::<S>(own, parameter.shape, span);
                continue;
            }
            if let Shape::Point { .. } = parameter.shape {
                let point = points.next().flatten().map(S::argument);
                arguments.push::<S>(point, parameter.shape, place.span.clone());
                continue;
            }
            if let (Shape::Direction { slot }, ArgumentSource::Bearings(own)) =
                (parameter.shape, &directions.source)
            {
                let last = spec.parameters[..k].iter().rposition(is_point);
                let pitch = last.map(|at| &arguments.values[at]);
                let pitch = pitch.filter(|_| arguments.complete);
                let direction = |field: &Field| directions.direction(field, slot);
                let (line, span) = own.line(table, parameter.name, direction, pitch);
                arguments.push::<S>(line, parameter.shape, span);
                continue;
            }
            if let Shape::Axes { slot, like } = parameter.shape {
                let (axis, span) = match like {
                    Some(other) => arguments.like(spec, [other, slot], directions),
                    None => axis(table, parameter, slot, directions),
                };
                arguments.push::<S>(axis, parameter.shape, span);
                continue;
            }
            let key = parameter.name;
            let field = if parameter.optional {
                table.optional(key)
            } else {
                table.needed(key, parameter.shape.words(S::DIM))
            };
            let Some(field) = field else {
                let absent = parameter.optional.then_some(Argument::Absent);
                arguments.push::<S>(absent, parameter.shape, table.header.clone());
                continue;
            };
            let value = match parameter.shape {
                Shape::Functions(units) => {
                    let expected = parameter.shape.words(S::DIM).to_string();
                    let functions = functions(&field, units, &expected, domains);
                    arguments.complete &= functions.is_some();
                    arguments.functions.extend(functions.unwrap_or_default());
                    Some(Argument::Absent)
                }
                Shape::Direction { slot } => directions.direction(&field, slot),
                shape => value::<S>(&field, shape),
            };
            arguments.push::<S>(value, parameter.shape, field.span());
        }
        arguments
    }

    fn push<S: SceneSpace>(&mut self, value: Option<Argument>, shape: Shape, span: Range<usize>) {
        self.complete &= value.is_some();
        self.values
            .push(value.unwrap_or_else(|| harmless::<S>(shape)));
        self.spans.push(span);
    }

    /// Returns the stated value of a length that otherwise follows from the start, such as the free
    /// length of a spring, with its key and its position in the text.
    pub(crate) fn stated_length(&self, spec: &Spec) -> Option<(&'static str, f64, Range<usize>)> {
        let values = spec.parameters.iter().zip(&self.values).zip(&self.spans);
        let mut values = values.filter(|((parameter, _), _)| parameter.optional);
        values.find_map(
            |((parameter, value), span)| match (parameter.shape, value) {
                (Shape::Numbers([Unit::Length]), Argument::Numbers(stated)) => {
                    Some((parameter.name, *stated.first()?, span.clone()))
                }
                _ => None,
            },
        )
    }

    /// Returns the points, each relative to the centre of mass of its body.
    pub(crate) fn points<S: SceneSpace>(
        &self,
        spec: &Spec,
    ) -> impl Iterator<Item = S::Vector<f64>> {
        let all = spec.parameters.iter().zip(&self.values);
        let points = all.filter(|(parameter, _)| is_point(parameter));
        points.filter_map(|(_, value)| match value {
            Argument::Pair(point) => S::of_numbers(point),
            Argument::Triple(point) => S::of_numbers(point),
            _ => None,
        })
    }

    /// Returns axes that are parallel to the axes of another parameter, and the position of the
    /// other parameter in the text.
    fn like<S: SceneSpace>(
        &self,
        spec: &Spec,
        [other, slot]: [usize; 2],
        directions: &Directions<S>,
    ) -> (Option<Argument>, Range<usize>) {
        let Shape::Axes { slot: from, .. } = spec.parameters[other].shape else {
            return (None, self.spans[other].clone());
        };
        let axes = directions.like(&self.values[other], [from, slot]);
        (Some(axes), self.spans[other].clone())
    }

    /// Builds the element and reports every error that its definition finds. Returns `None` if
    /// there is an error.
    pub(crate) fn build<S: SceneSpace, E>(
        &mut self,
        table: &Table,
        spec: &'static Spec,
        build: fn(&[Argument]) -> Result<E, ArgumentError>,
    ) -> Option<E> {
        // A definition reports only the first error, so the value is replaced by a valid one and
        // the construction is repeated.
        for _ in 0..=spec.parameters.len() {
            let error = match build(&self.values) {
                Ok(element) => return self.complete.then_some(element),
                Err(error) => error,
            };
            let at = error
                .parameter()
                .and_then(|name| spec.parameters.iter().position(|p| p.name == name))?;
            table.findings.error(
                Mistake::from(&error),
                self.spans[at].clone(),
                format!("{}: {error}", table.subject),
                label(&error),
            );
            self.values[at] = harmless::<S>(spec.parameters[at].shape);
            self.complete = false;
        }
        None
    }
}

fn is_point(parameter: &Parameter) -> bool {
    matches!(parameter.shape, Shape::Point { .. })
}

/// A value that every definition accepts.
fn harmless<S: SceneSpace>(shape: Shape) -> Argument {
    match shape {
        Shape::Point { .. } | Shape::Direction { .. } => S::argument(S::vector([1.0, 0.0, 0.0])),
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

/// Reads the value of a parameter that does not depend on time.
fn value<S: SceneSpace>(field: &Field, shape: Shape) -> Option<Argument> {
    let expected = shape.words(S::DIM).to_string();
    match shape {
        // Points, directions and axes were read earlier.
        Shape::Point { .. } | Shape::Direction { .. } | Shape::Axes { .. } => None,
        Shape::GroundPlane => plane::<S>(field, &expected),
        Shape::GroundLine => {
            let points = field.points::<Plane>(2, &expected)?;
            points.try_into().ok().map(Argument::Pairs)
        }
        Shape::Numbers([unit]) => {
            let number = field.number_expected(&expected, (*unit).into())?;
            Some(Argument::Numbers(vec![number]))
        }
        Shape::Numbers(units) => field
            .numbers(units.len(), &expected, |k| units[k].into())
            .map(Argument::Numbers),
        Shape::Functions(_) => Some(Argument::Absent),
    }
}

/// An axis, and its position in the text.
fn axis<S: SceneSpace>(
    table: &mut Table,
    parameter: &Parameter,
    slot: usize,
    directions: &Directions<S>,
) -> (Option<Argument>, Range<usize>) {
    let key = parameter.name;
    if parameter.optional {
        return (directions.axis(None, slot), table.header.clone());
    }
    let expected = parameter.shape.words(S::DIM);
    let field = if directions.has_own_axes() {
        table.optional(key)
    } else {
        table.needed(key, expected)
    };
    let span = |table: &Table| match &field {
        Some(field) => field.span(),
        None => table.span_of(direction::AXES),
    };
    let span = span(table);
    if let Some(field) = field.as_ref().filter(|_| directions.has_own_axes()) {
        let axes = table.span_of(direction::AXES);
        let first = (axes, "the axis is given here for both bodies");
        let second = (field.span(), "and here for the first");
        table.exclusive(format!("`{key}` or `{}`", direction::AXES), [first, second]);
        return (None, span);
    }
    let is_known = field.is_some() || directions.has_own_axes();
    let axis = directions.axis(field.as_ref(), slot);
    (axis.filter(|_| is_known), span)
}

/// A plane of the ground: a point and a normal.
fn plane<S: SceneSpace>(field: &Field, expected: &str) -> Option<Argument> {
    let mut table = field.table(expected)?;
    let point = table.needed("point", S::POINT);
    let normal = table.needed("normal", S::VECTOR);
    let point = point.and_then(|p| p.vector::<S>(S::POINT, Dimension::LENGTH));
    let normal = normal.and_then(|n| n.vector::<S>(S::VECTOR, Dimension::NONE));
    table.close();
    Some(Argument::Triples([S::point(point?), S::point(normal?)]))
}

/// One function, or a list of them.
fn functions(
    field: &Field,
    units: &[Unit],
    expected: &str,
    domains: &mut Vec<Domain>,
) -> Option<Vec<Function>> {
    if let [unit] = units {
        return function::read(field, (*unit).into(), domains).map(|f| vec![f]);
    }
    let items = field.items(expected)?;
    if items.len() != units.len() {
        field.miscount(expected, items.len(), units.len());
        return None;
    }
    let mut units = units.iter();
    all(&items, |item| {
        function::read(item, (*units.next()?).into(), domains)
    })
}
