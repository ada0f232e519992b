//! The body of a definition: rows with their reaction, or laws with their coordinates.

use proc_macro2::TokenStream;
use quote::ToTokens;
use symbolic::Expr;

use super::check;
use super::model::ConstraintBody;
use super::scope::Scope;
use crate::parse::Definition;

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
        let (holonomic, expr) = match (&d.phi, &d.psi) {
            (Some(phi), _) => (true, phi),
            (None, Some(psi)) => (false, psi),
            (None, None) => unreachable!("the parser requires phi or psi"),
        };
        let rows = self.rows(expr)?;
        check_row_count(d, expr, rows.len())?;
        for &(row, at) in &rows {
            if holonomic {
                self.refuse_all(at, check::PHI)?;
            } else {
                self.refuse_all(at, check::PSI)?;
            }
            if !holonomic && !check::moves(&mut self.model, row) {
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
            let value = self.scalar(e)?;
            self.refuse_all(e, check::MEASURE)?;
            measures.push((name.clone(), value));
        }
        let (rows, at): (Vec<Expr>, Vec<TokenStream>) = rows
            .into_iter()
            .map(|(row, at)| (row, at.to_token_stream()))
            .unzip();
        Ok(ConstraintBody {
            holonomic,
            rows,
            at,
            place: place_value,
            component,
            measures,
        })
    }

    pub(super) fn forces(&mut self) -> syn::Result<Vec<(Expr, Expr)>> {
        let definition = self.definition;
        let mut terms = Vec::new();
        for (law, coordinate) in &definition.forces {
            let (l, c) = (self.scalar(law)?, self.scalar(coordinate)?);
            self.refuse_all(coordinate, check::COORDINATE)?;
            terms.push((l, c));
        }
        Ok(terms)
    }

    /// Scalars of a list of scalars and vectors, vectors as their global components.
    fn rows(&mut self, e: &'a syn::Expr) -> syn::Result<Vec<Row<'a>>> {
        match e {
            syn::Expr::Paren(inner) => self.rows(&inner.expr),
            syn::Expr::Group(inner) => self.rows(&inner.expr),
            syn::Expr::Array(list) => {
                let mut rows = Vec::new();
                for entry in &list.elems {
                    rows.extend(self.rows(entry)?);
                }
                Ok(rows)
            }
            _ => {
                let value = self.value(e)?;
                let scalars = self.components(value, e)?;
                Ok(scalars.into_iter().map(|row| (row, e)).collect())
            }
        }
    }
}

fn check_row_count(d: &Definition, expr: &syn::Expr, found: usize) -> syn::Result<()> {
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
    error.combine(syn::Error::new_spanned(
        expr,
        format!("this has {} (a vector counts as two, x and y)", rows(found)),
    ));
    Err(error)
}
