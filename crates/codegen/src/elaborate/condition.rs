//! Conditions on the assembled start.

use syn::BinOp;

use super::check;
use super::model::{Comparison, Condition};
use super::scope::Scope;

impl<'a> Scope<'a> {
    pub(super) fn condition(&mut self, e: &'a syn::Expr) -> syn::Result<Condition> {
        match e {
            syn::Expr::Paren(inner) => self.condition(&inner.expr),
            syn::Expr::Group(inner) => self.condition(&inner.expr),
            syn::Expr::Binary(b) => {
                let comparison = match b.op {
                    BinOp::And(_) => {
                        let (l, r) = (self.condition(&b.left)?, self.condition(&b.right)?);
                        return Ok(Condition::And(Box::new(l), Box::new(r)));
                    }
                    BinOp::Or(_) => {
                        let (l, r) = (self.condition(&b.left)?, self.condition(&b.right)?);
                        return Ok(Condition::Or(Box::new(l), Box::new(r)));
                    }
                    BinOp::Eq(_) => Comparison::Equal,
                    BinOp::Ne(_) => Comparison::NotEqual,
                    BinOp::Gt(_) => Comparison::Greater,
                    BinOp::Lt(_) => Comparison::Less,
                    _ => return Err(expected(e)),
                };
                let (left, right) = (self.scalar(&b.left)?, self.scalar(&b.right)?);
                self.refuse_all(&b.left, check::START)?;
                self.refuse_all(&b.right, check::START)?;
                Ok(Condition::Compare(comparison, left, right))
            }
            _ => Err(expected(e)),
        }
    }
}

fn expected(e: &syn::Expr) -> syn::Error {
    syn::Error::new_spanned(
        e,
        "expected a comparison: `==`, `!=`, `>`, `<`, joined by `&&`, `||`",
    )
}
