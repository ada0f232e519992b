//! Functions of the language, and body slots, which only occur as arguments of functions.

use proc_macro2::Ident;
use symbolic::Function;

use super::check;
use super::expression::wrong;
use super::scope::Scope;
use super::value::Value;
use crate::nearest::{hint, list};
use crate::vector::{Frame, Vector};

/// Names of the functions with their numbers of arguments.
const FUNCTIONS: [(&str, usize); 15] = [
    ("point", 2),
    ("direction", 2),
    ("vector", 2),
    ("local", 2),
    ("origin", 1),
    ("angle", 1),
    ("start", 1),
    ("along", 1),
    ("velocity", 1),
    ("rate", 1),
    ("perp", 1),
    ("norm", 1),
    ("sin", 1),
    ("cos", 1),
    ("dot", 2),
];

impl<'a> Scope<'a> {
    pub(super) fn call(&mut self, call: &'a syn::ExprCall) -> syn::Result<Value> {
        let name = match &*call.func {
            syn::Expr::Path(p) if p.path.get_ident().is_some() => p.path.get_ident().cloned(),
            _ => None,
        };
        let Some(name) = name else {
            return Err(syn::Error::new_spanned(
                &call.func,
                "expected the name of a function",
            ));
        };
        let Some(&(function, arity)) = FUNCTIONS.iter().find(|(f, _)| name == f) else {
            let known: Vec<&str> = FUNCTIONS.iter().map(|f| f.0).collect();
            let text = name.to_string();
            return Err(syn::Error::new_spanned(
                &name,
                format!("unknown function `{text}`{}", hint(&text, &known)),
            ));
        };
        let args: Vec<&'a syn::Expr> = call.args.iter().collect();
        if args.len() != arity {
            return Err(syn::Error::new_spanned(
                call,
                format!(
                    "`{function}` takes {arity} argument{}, found {}",
                    if arity == 1 { "" } else { "s" },
                    args.len()
                ),
            ));
        }
        match function {
            "point" | "direction" | "vector" => self.placed(function, args[0], args[1]),
            "local" => {
                let slot = self.slot_argument(args[0])?;
                let v = self.vector(args[1])?;
                let model = &mut self.model;
                let pair = v.in_body(&mut model.g, slot, &model.turns);
                Ok(Value::Pair { slot, pair })
            }
            "origin" => {
                let slot = self.slot_argument(args[0])?;
                Ok(Value::Vector(self.origin(slot)))
            }
            "angle" => {
                let slot = self.slot_argument(args[0])?;
                Ok(Value::Scalar(self.model.inputs.slots[slot].pose[2]))
            }
            "start" | "along" => match self.value(args[0])? {
                Value::Line { start, along } => {
                    let pair = if function == "start" { start } else { along };
                    Ok(Value::Vector(Vector::new(Frame::Ground, pair)))
                }
                other => Err(wrong(args[0], "a line", &other)),
            },
            "perp" => {
                let v = self.vector(args[0])?;
                Ok(Value::Vector(v.perp(&mut self.model.g)))
            }
            "dot" => {
                let (a, b) = (self.vector(args[0])?, self.vector(args[1])?);
                let model = &mut self.model;
                Ok(Value::Scalar(a.dot(&mut model.g, &b, &model.turns)))
            }
            "norm" => {
                let v = self.vector(args[0])?;
                let model = &mut self.model;
                let square = v.dot(&mut model.g, &v, &model.turns);
                Ok(Value::Scalar(model.g.call(Function::Sqrt, square)))
            }
            "sin" | "cos" => {
                let angle = self.scalar(args[0])?;
                let function = match function {
                    "sin" => Function::Sin,
                    _ => Function::Cos,
                };
                Ok(Value::Scalar(self.model.g.call(function, angle)))
            }
            // "velocity" | "rate"
            _ => {
                let value = self.value(args[0])?;
                self.refuse(args[0], &value, check::DIFFERENTIABLE)?;
                let model = &mut self.model;
                match value {
                    Value::Vector(v) => Ok(Value::Vector(v.rate(
                        &mut model.g,
                        &model.turns,
                        &model.time,
                    ))),
                    Value::Scalar(e) if function == "rate" => {
                        Ok(Value::Scalar(model.time.apply(&mut model.g, e)))
                    }
                    other if function == "rate" => {
                        Err(wrong(args[0], "a scalar or a vector", &other))
                    }
                    other => Err(wrong(args[0], "a vector", &other)),
                }
            }
        }
    }

    /// `r_i`, or `r_i + R_i·s`, or `R_i·s`.
    fn placed(
        &mut self,
        function: &str,
        slot: &syn::Expr,
        what: &'a syn::Expr,
    ) -> syn::Result<Value> {
        let at = self.slot_argument(slot)?;
        let pair = match (function, self.value(what)?) {
            ("point", Value::Point { slot: own, pair })
            | ("direction", Value::Direction { slot: own, pair }) => {
                if own != at {
                    return Err(self.wrong_frame(what, own, at));
                }
                pair
            }
            ("vector", value @ Value::Pair { .. }) => self.pair_in(at, value, what)?,
            ("vector", Value::List(list)) => match list.as_slice() {
                [Value::Scalar(x), Value::Scalar(y)] => [*x, *y],
                _ => return Err(wrong(what, "two components", &Value::List(list))),
            },
            ("point", other) => return Err(wrong(what, "a `Point` parameter", &other)),
            ("direction", other) => {
                return Err(wrong(what, "a `Direction` parameter", &other));
            }
            (_, other) => return Err(wrong(what, "two components", &other)),
        };
        let turned = Vector::new(Frame::Body(at), pair);
        Ok(Value::Vector(match function {
            "point" => self
                .origin(at)
                .combine(&mut self.model.g, 1.0, &turned, 1.0),
            _ => turned,
        }))
    }

    fn origin(&self, slot: usize) -> Vector {
        let [x, y, ..] = self.model.inputs.slots[slot].pose;
        Vector::new(Frame::Ground, [x, y])
    }

    fn slot_argument(&self, e: &syn::Expr) -> syn::Result<usize> {
        match e {
            syn::Expr::Path(p) => match p.path.get_ident() {
                Some(name) => self.slot(name),
                None => Err(syn::Error::new_spanned(e, "expected a body slot")),
            },
            _ => Err(syn::Error::new_spanned(e, "expected a body slot")),
        }
    }

    pub(super) fn slot(&self, name: &Ident) -> syn::Result<usize> {
        let slots = &self.definition.slots;
        slots.iter().position(|s| s == name).ok_or_else(|| {
            let slots: Vec<String> = slots.iter().map(ToString::to_string).collect();
            let slots: Vec<&str> = slots.iter().map(String::as_str).collect();
            syn::Error::new_spanned(
                name,
                format!("`{name}` is no body slot; the slots are {}", list(&slots)),
            )
        })
    }
}
