//! The data of a constraint: the values that the constraint stores, and the derivatives with
//! respect to each of these values. A value that is computed from other values is not a datum,
//! because its derivative follows from the derivatives of the other values by the chain rule.

use proc_macro2::Ident;
use quote::format_ident;
use symbolic::{Expr, Symbol};

use crate::defined::Along;
use crate::elaborate::Model;
use crate::identity;
use crate::parse::{Definition, Kept, ParamKind};
use crate::vector::cross;

/// A datum: the values that form one quantity, such as the two components of a point.
#[derive(Clone)]
pub(crate) struct Datum {
    /// Name of the datum in the specification.
    pub(crate) name: String,
    pub(crate) shape: Shape,
    /// The field that stores the datum.
    pub(crate) field: Ident,
    /// The optional parameter that overrides the field.
    pub(crate) overridden_by: Option<Ident>,
    /// The kernel inputs that represent the components of the datum, in order.
    pub(crate) symbols: Vec<Expr>,
}

impl Datum {
    /// Returns the number of independent components. Axes have three components, which form a
    /// rotation vector. An angle that is stored by its cosine and sine has one component.
    pub(crate) fn count(&self) -> usize {
        match self.shape {
            Shape::Axes(_) => 3,
            Shape::Turn => 1,
            _ => self.symbols.len(),
        }
    }
}

/// The meaning of the components of a datum.
#[derive(Clone)]
pub(crate) enum Shape {
    Point(Ident),
    Direction(Ident),
    /// Axes are represented by nine symbols. The components of the datum form a rotation vector.
    Axes(Ident),
    Line,
    Plane,
    /// A single value with its unit, and its index if it belongs to a list.
    Number(Ident, Option<usize>),
    Kept(Ident),
    /// An angle is stored by its cosine and sine. The datum is a change of the angle.
    Turn,
    KeptVector(Ident),
}

/// Returns the data in order: the parameters, then the values stored at the start.
pub(crate) fn stored(d: &Definition, model: &Model) -> Vec<Datum> {
    let mut data = Vec::new();
    for p in &d.params {
        let values = model.inputs.values(&p.name.to_string());
        let mut push = |name: String, shape: Shape, symbols: &[Expr]| {
            data.push(Datum {
                name,
                shape,
                field: p.name.clone(),
                overridden_by: None,
                symbols: symbols.to_vec(),
            });
        };
        let name = p.name.to_string();
        match &p.kind {
            ParamKind::Point(slot) => push(name, Shape::Point(slot.clone()), values),
            ParamKind::Direction(slot) => push(name, Shape::Direction(slot.clone()), values),
            ParamKind::Axes { slot, .. } => push(name, Shape::Axes(slot.clone()), values),
            ParamKind::GroundPlane => {
                // The direction along the plane is constant.
                push(name, Shape::Plane, &values[..6]);
            }
            ParamKind::GroundLine => {
                let (start, along) = model.inputs.line(&name);
                push(name, Shape::Line, &[start, along].concat());
            }
            ParamKind::Number(unit) if p.default.is_none() => {
                push(name, Shape::Number(unit.clone(), None), values);
            }
            ParamKind::Numbers(units) => {
                for (k, unit) in units.iter().enumerate() {
                    let shape = Shape::Number(unit.clone(), Some(k));
                    push(format!("{name}[{k}]"), shape, &values[k..=k]);
                }
            }
            // Optional values are stored at the start; functions of time are passed as jets.
            ParamKind::Number(_) | ParamKind::Function(_) | ParamKind::Functions(_) => {}
        }
    }
    for kept in model.kept.iter().filter(|k| !model.is_computed(k)) {
        data.push(Datum {
            name: match &kept.overridden_by {
                Some(parameter) => parameter.to_string(),
                None => kept.field.clone(),
            },
            shape: match (&kept.kind, &kept.overridden_by) {
                (Kept::Number(unit), None) => Shape::Kept(unit.clone()),
                (Kept::Turn, _) => Shape::Turn,
                (Kept::Number(unit), Some(_)) => Shape::Number(unit.clone(), None),
                (Kept::Vector(slot), _) => Shape::KeptVector(slot.clone()),
            },
            field: format_ident!("{}", kept.field),
            overridden_by: kept.overridden_by.clone(),
            symbols: kept.symbols.clone(),
        });
    }
    data
}

/// Returns the initial value of the joint coordinate of a drive.
pub(crate) fn of_measure(model: &Model, unit: Ident) -> Datum {
    Datum {
        name: "measure_0".to_owned(),
        shape: Shape::Kept(unit),
        field: format_ident!("measure_0"),
        overridden_by: None,
        symbols: vec![model.inputs.measure_0],
    }
}

/// Returns the initial angle of the joint coordinate of a drive in space.
pub(crate) fn of_turn(model: &Model) -> Datum {
    Datum {
        name: "measure_0".to_owned(),
        shape: Shape::Turn,
        field: format_ident!("measure_0"),
        overridden_by: None,
        symbols: model.inputs.turn_0.to_vec(),
    }
}

/// Returns the derivation with respect to each component of the data, in order.
pub(crate) fn derivations(model: &mut Model, data: &[Datum]) -> Vec<Along> {
    let mut all = Vec::new();
    for datum in data {
        for k in 0..datum.count() {
            all.push(by(model, datum, k));
        }
    }
    all
}

/// Returns the images of the symbols of a datum for its component `k`.
fn images(model: &mut Model, datum: &Datum, k: usize) -> Vec<(Expr, Expr)> {
    let g = &mut model.g;
    match datum.shape {
        Shape::Axes(_) => {
            let (zero, one) = (g.number(0.0), g.number(1.0));
            let turn: Vec<Expr> = (0..3).map(|j| if j == k { one } else { zero }).collect();
            let mut images = Vec::new();
            for direction in datum.symbols.chunks(3) {
                let turned = cross(g, &turn, direction);
                images.extend(direction.iter().copied().zip(turned));
            }
            images
        }
        Shape::Turn => {
            let (cos, sin) = (datum.symbols[0], datum.symbols[1]);
            vec![(cos, g.neg(sin)), (sin, cos)]
        }
        _ => vec![(datum.symbols[k], g.number(1.0))],
    }
}

/// Returns the derivation with respect to one component of a datum. The image of each computed
/// value is its derivative. This derivative is computed with the images of all earlier values.
fn by(model: &mut Model, datum: &Datum, k: usize) -> Along {
    let mut images = images(model, datum, k);
    let mut along = model.inputs.derivation(&model.g, &images);
    for k in 0..model.kept.len() {
        if !model.is_computed(&model.kept[k]) {
            continue;
        }
        let pairs = model.kept[k].symbols.iter().zip(&model.kept[k].values);
        let pairs: Vec<(Expr, Expr)> = pairs.map(|(&symbol, &value)| (symbol, value)).collect();
        for (symbol, value) in pairs {
            let slope = along.apply(&mut model.g, value);
            if !identity::is_zero(&mut model.g, &model.inputs, slope) {
                images.push((symbol, slope));
            }
        }
        along = model.inputs.derivation(&model.g, &images);
    }
    along
}

/// Returns the inputs of the constraint in these expressions, in the order of their symbols.
pub(crate) fn read_by<'e>(model: &Model, outputs: impl Iterator<Item = &'e Expr>) -> Vec<Symbol> {
    let mut stored: Vec<Symbol> = outputs.flat_map(|&e| model.g.inputs(e)).collect();
    stored.sort_unstable();
    stored.dedup();
    stored.retain(|s| model.inputs.source(*s).access().1);
    stored
}

/// Returns the nonzero derivatives of stored values with respect to the data. Each entry contains
/// the index of the stored value, the index of the datum and the derivative.
pub(crate) fn slopes(
    model: &mut Model,
    stored: &[Symbol],
    data: &[Along],
) -> Vec<(usize, usize, Expr)> {
    let mut slopes = Vec::new();
    for (place, &symbol) in stored.iter().enumerate() {
        let value = model.g.symbol_expr(symbol);
        for (number, along) in data.iter().enumerate() {
            let slope = along.apply(&mut model.g, value);
            if !identity::is_zero(&mut model.g, &model.inputs, slope) {
                slopes.push((place, number, model.expand(slope)));
            }
        }
    }
    slopes
}
