//! The body of a definition: rows and their reaction, or force laws and their coordinates.

use proc_macro2::{Ident, TokenStream};
use quote::ToTokens;
use symbolic::Expr;

use super::check;
use super::expression::as_scalar;
use super::model::{ConstraintBody, Measure};
use super::scope::Scope;
use super::value::Value;
use crate::elaborate::Source;
use crate::parse::{Definition, Kept};
use crate::space::Space;
use crate::vector::Vector;

/// A scalar row with the source text of its expression.
type Row<'a> = (Expr, &'a syn::Expr);

impl<'a> Scope<'a> {
    pub(super) fn require(&mut self) -> syn::Result<()> {
        let definition = self.definition;
        for (_, condition) in &definition.requirements {
            let condition = self.condition(condition)?;
            self.model.requirements.push(condition);
        }
        Ok(())
    }

    pub(super) fn constraint(&mut self) -> syn::Result<ConstraintBody> {
        let d = self.definition;
        let (mut rows, mut vectors) = (Vec::new(), Vec::new());
        let mut counts = [0; 2];
        for (expr, count) in [&d.phi, &d.psi].into_iter().zip(&mut counts) {
            if let Some(expr) = expr {
                let before = rows.len();
                self.rows(expr, &mut rows, &mut vectors)?;
                *count = rows.len() - before;
            }
        }
        check_row_count(d, counts)?;
        let [holonomic, _] = counts;
        if d.has_gap && holonomic != 1 {
            return Err(syn::Error::new_spanned(
                &d.rows[0],
                format!("a gap is the only row of `phi`, which has {holonomic}"),
            ));
        }
        for (k, &(row, at)) in rows.iter().enumerate() {
            if k < holonomic {
                self.refuse_all(at, check::PHI)?;
                continue;
            }
            self.refuse_all(at, check::PSI)?;
            if !check::moves(&mut self.model, row) {
                return Err(syn::Error::new_spanned(
                    at,
                    "this row of `psi` contains no velocity: a constraint on the level of positions is `phi`",
                ));
            }
        }
        let place = d.place.as_ref().expect("the parser requires a place");
        let place_value = self.vector(place)?;
        self.refuse_all(place, check::PLACE)?;
        let component = match &d.component {
            None => None,
            Some((name, e)) => {
                let along = self.vector(e)?;
                self.refuse_all(e, check::COMPONENT)?;
                Some((name.clone(), along))
            }
        };
        let mut measures = Vec::new();
        for (name, e) in &d.measures {
            let measure = match e {
                Some(e) => {
                    let value = self.value(e)?;
                    self.refuse_all(e, check::MEASURE)?;
                    match value {
                        Value::Angle { sin, cos } => Measure::Angle { sin, cos },
                        other => Measure::Of(as_scalar(other, e)?),
                    }
                }
                None if !self.model.counted.is_empty() => {
                    return Err(syn::Error::new_spanned(
                        name,
                        "a joint that counts turns has no measure that is `kept`: give it an expression",
                    ));
                }
                None => Measure::Kept(self.moved(name, &rows[..holonomic])?),
            };
            measures.push((name.clone(), measure));
        }
        let (rows, at): (Vec<Expr>, Vec<TokenStream>) = rows
            .into_iter()
            .map(|(row, at)| (row, at.to_token_stream()))
            .unzip();
        Ok(ConstraintBody {
            holonomic,
            rows,
            vectors,
            at,
            place: place_value,
            component,
            measures,
        })
    }

    /// Returns the stored value with this name. These rows of Φ must contain the value.
    fn moved(&self, name: &Ident, rows: &[Row<'_>]) -> syn::Result<Expr> {
        let kept = self.model.kept.iter().find(|k| *name == k.field);
        let number = kept.filter(|k| matches!(k.kind, Kept::Number(_)) && k.of_start);
        let error = |why| Err(syn::Error::new_spanned(name, why));
        if self.definition.phi.is_none() {
            return error(format!(
                "only `phi` keeps `{name}` where it is at the start"
            ));
        }
        let Some(number) = number else {
            return error(format!(
                "no number of `initial` that depends on the start is called `{name}`: `kept` is for one of those"
            ));
        };
        let reads = |s: &Source| matches!(s, Source::Kept { field, .. } if *field == number.field);
        if rows
            .iter()
            .any(|(row, _)| self.model.depends_on(*row, reads))
        {
            Ok(number.symbols[0])
        } else {
            error(format!(
                "no row contains `{name}`: a drive of it would move nothing"
            ))
        }
    }

    pub(super) fn forces(&mut self) -> syn::Result<Vec<(Expr, Expr)>> {
        let definition = self.definition;
        let mut terms = Vec::new();
        for (law, coordinate) in &definition.forces {
            let (l, c) = (self.scalar(law)?, self.scalar(coordinate)?);
            let refusals = match definition.space {
                Space::Plane => check::COORDINATE,
                Space::Space3 => check::COORDINATE_OR_RATE,
            };
            self.refuse_all(coordinate, refusals)?;
            terms.push((l, c));
        }
        Ok(terms)
    }

    /// Appends the scalars of a list of scalars and vectors. A vector is appended as its global
    /// components. The vector is recorded with the index of its first row.
    fn rows(
        &mut self,
        e: &'a syn::Expr,
        rows: &mut Vec<Row<'a>>,
        vectors: &mut Vec<(usize, Vector)>,
    ) -> syn::Result<()> {
        match e {
            syn::Expr::Paren(inner) => self.rows(&inner.expr, rows, vectors),
            syn::Expr::Group(inner) => self.rows(&inner.expr, rows, vectors),
            syn::Expr::Array(list) => {
                let mut entries = list.elems.iter();
                entries.try_for_each(|entry| self.rows(entry, rows, vectors))
            }
            _ => {
                let value = self.value(e)?;
                if let Value::Vector(v) = &value {
                    vectors.push((rows.len(), v.clone()));
                }
                let scalars = self.components(value, e)?;
                rows.extend(scalars.into_iter().map(|row| (row, e)));
                Ok(())
            }
        }
    }
}

/// Compares the number of row names with the number of rows in `phi` and `psi`.
fn check_row_count(d: &Definition, counts: [usize; 2]) -> syn::Result<()> {
    let found = counts.iter().sum();
    if found == d.rows.len() {
        return Ok(());
    }
    let rows = |n: usize| match n {
        1 => "1 row".to_owned(),
        n => format!("{n} rows"),
    };
    let names = d.rows.iter().map(ToTokens::to_token_stream);
    let names: TokenStream = names.collect();
    let mut error = syn::Error::new_spanned(
        names,
        format!(
            "`rows` names {}, but the equation has {}",
            rows(d.rows.len()),
            rows(found)
        ),
    );
    let vector = match d.space {
        Space::Plane => "a vector counts as two, x and y",
        Space::Space3 => "a vector counts as three, x, y and z",
    };
    for (expr, found) in [&d.phi, &d.psi].into_iter().zip(counts) {
        if let Some(expr) = expr {
            let words = format!("this has {} ({vector})", rows(found));
            error.combine(syn::Error::new_spanned(expr, words));
        }
    }
    Err(error)
}
