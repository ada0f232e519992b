//! Functions of the language, and body slots, which only occur as arguments of functions.

use proc_macro2::Ident;
use symbolic::Function;

use super::check;
use super::expression::wrong;
use super::scope::Scope;
use super::value::Value;
use crate::nearest::{hint, list};
use crate::space::Space;
use crate::vector::{Components, Frame, Vector};

/// Names of the functions of both spaces, each with its number of arguments.
const FUNCTIONS: [(&str, usize); 11] = [
    ("point", 2),
    ("direction", 2),
    ("vector", 2),
    ("local", 2),
    ("origin", 1),
    ("velocity", 1),
    ("rate", 1),
    ("norm", 1),
    ("sin", 1),
    ("cos", 1),
    ("dot", 2),
];

/// Names of the functions of the plane, each with its number of arguments.
const PLANE: [(&str, usize); 4] = [("angle", 1), ("start", 1), ("along", 1), ("perp", 1)];

/// Names of the functions of space, each with its number of arguments.
const SPACE3: [(&str, usize); 8] = [
    ("angle", 2),
    ("turn", 3),
    ("spin", 1),
    ("cross", 2),
    ("start", 1),
    ("along", 1),
    ("normal", 1),
    ("angle_over_sine", 1),
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
        let (own, other, other_word) = match self.definition.space {
            Space::Plane => (&PLANE[..], &SPACE3[..], Space::Space3.word()),
            Space::Space3 => (&SPACE3[..], &PLANE[..], Space::Plane.word()),
        };
        let functions = || FUNCTIONS.iter().chain(own);
        let Some(&(function, arity)) = functions().find(|(f, _)| name == f) else {
            let known: Vec<&str> = functions().map(|f| f.0).collect();
            let text = name.to_string();
            let message = if other.iter().any(|(f, _)| name == f) {
                format!("`{text}` is a function of a `{other_word}` definition")
            } else {
                format!("unknown function `{text}`{}", hint(&text, &known))
            };
            return Err(syn::Error::new_spanned(&name, message));
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
                let v = self.free_vector(args[1])?;
                let model = &mut self.model;
                let local = v.in_body(&mut model.g, slot, &model.turns);
                Ok(Value::Local { slot, local })
            }
            "origin" => {
                let slot = self.slot_argument(args[0])?;
                Ok(Value::Vector(self.origin(slot)))
            }
            "angle" if arity == 1 => {
                let slot = self.slot_argument(args[0])?;
                Ok(Value::Scalar(self.model.inputs.slots[slot].pose[2]))
            }
            "angle" => self.angle_about(args[0], args[1]),
            "turn" => {
                let (about, from) = (self.free_vector(args[0])?, self.free_vector(args[1])?);
                let to = self.free_vector(args[2])?;
                let model = &mut self.model;
                let across = from.cross(&mut model.g, &to, &model.turns);
                Ok(Value::Angle {
                    sin: about.dot(&mut model.g, &across, &model.turns),
                    cos: from.dot(&mut model.g, &to, &model.turns),
                })
            }
            "spin" => {
                let slot = self.slot_argument(args[0])?;
                let omega = self.model.inputs.slots[slot].twist[3..].to_vec();
                Ok(Value::Vector(Vector::new(Frame::Body(slot), omega)))
            }
            "cross" => {
                let (a, b) = (self.free_vector(args[0])?, self.free_vector(args[1])?);
                let model = &mut self.model;
                Ok(Value::Vector(a.cross(&mut model.g, &b, &model.turns)))
            }
            "start" | "along" => match self.value(args[0])? {
                Value::Line { start, along } => {
                    let components = if function == "start" { start } else { along };
                    Ok(Value::Vector(Vector::new(Frame::Ground, components)))
                }
                Value::Plane { start, along, .. } => {
                    let components = if function == "start" { start } else { along };
                    Ok(Value::Vector(Vector::new(Frame::Ground, components)))
                }
                other => {
                    let expected = match self.definition.space {
                        Space::Plane => "a line",
                        Space::Space3 => "a plane",
                    };
                    Err(wrong(args[0], expected, &other))
                }
            },
            "normal" => match self.value(args[0])? {
                Value::Plane { normal, .. } => {
                    Ok(Value::Vector(Vector::new(Frame::Ground, normal)))
                }
                other => Err(wrong(args[0], "a plane", &other)),
            },
            "perp" => {
                let v = self.free_vector(args[0])?;
                Ok(Value::Vector(v.perp(&mut self.model.g)))
            }
            "dot" => {
                let (a, b) = (self.free_vector(args[0])?, self.free_vector(args[1])?);
                let model = &mut self.model;
                Ok(Value::Scalar(a.dot(&mut model.g, &b, &model.turns)))
            }
            "norm" => {
                let v = self.free_vector(args[0])?;
                let model = &mut self.model;
                let square = v.dot(&mut model.g, &v, &model.turns);
                Ok(Value::Scalar(model.g.call(Function::Sqrt, square)))
            }
            "sin" | "cos" | "angle_over_sine" => {
                let angle = self.scalar(args[0])?;
                let function = match function {
                    "sin" => Function::Sin,
                    "angle_over_sine" => Function::AngleOverSine(0),
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

    /// Returns the angle of the axes `to` relative to the axes `from` about their common w. The
    /// angle is computed from its sine v·u' and its cosine u·u'.
    fn angle_about(&mut self, from: &'a syn::Expr, to: &'a syn::Expr) -> syn::Result<Value> {
        let mut axes = Vec::new();
        for e in [from, to] {
            match self.value(e)? {
                Value::Axes { slot, axes: own } => {
                    axes.push(own.map(|local| Vector::new(Frame::Body(slot), local)));
                }
                other => return Err(wrong(e, "an `Axes` parameter", &other)),
            }
        }
        let ([u, v, _], [other, ..]) = (&axes[0], &axes[1]);
        let model = &mut self.model;
        Ok(Value::Angle {
            sin: v.dot(&mut model.g, other, &model.turns),
            cos: u.dot(&mut model.g, other, &model.turns),
        })
    }

    /// Returns `r_i`, `r_i + R_i·s` or `R_i·s`. The vector `vector(ground, [a, b, c])` has ground
    /// components.
    fn placed(
        &mut self,
        function: &str,
        slot: &syn::Expr,
        what: &'a syn::Expr,
    ) -> syn::Result<Value> {
        if function == "vector" && is_ground(slot) {
            let value = self.value(what)?;
            let components = listed(self.definition.space, value, what)?;
            return Ok(Value::Vector(Vector::new(Frame::Ground, components)));
        }
        let at = self.slot_argument(slot)?;
        let local = match (function, self.value(what)?) {
            ("point", Value::Point { slot: own, local })
            | ("direction", Value::Direction { slot: own, local }) => {
                if own != at {
                    return Err(self.wrong_frame(what, own, at));
                }
                local
            }
            ("vector", value @ Value::Local { .. }) => self.local_in(at, value, what)?,
            ("vector", value @ Value::List(_)) => listed(self.definition.space, value, what)?,
            ("point", other) => return Err(wrong(what, "a `Point` parameter", &other)),
            ("direction", other) => {
                return Err(wrong(what, "a `Direction` parameter", &other));
            }
            (_, other) => {
                return Err(wrong(
                    what,
                    components_in_words(self.definition.space),
                    &other,
                ));
            }
        };
        let turned = Vector::new(Frame::Body(at), local);
        Ok(Value::Vector(match function {
            "point" => self
                .origin(at)
                .combine(&mut self.model.g, 1.0, &turned, 1.0),
            _ => turned,
        }))
    }

    fn origin(&self, slot: usize) -> Vector {
        let dim = self.definition.space.dim();
        let r = self.model.inputs.slots[slot].pose[..dim].to_vec();
        Vector::new(Frame::Ground, r)
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

/// Returns whether the frame is the ground.
fn is_ground(slot: &syn::Expr) -> bool {
    matches!(slot, syn::Expr::Path(p) if p.path.is_ident("ground"))
}

/// Returns the scalars of a list. The number of scalars must be the number of components of a
/// vector.
fn listed(space: Space, value: Value, at: &syn::Expr) -> syn::Result<Components> {
    let expected = components_in_words(space);
    let Value::List(list) = &value else {
        return Err(wrong(at, expected, &value));
    };
    let scalar = |value: &Value| match value {
        Value::Scalar(e) => Some(*e),
        _ => None,
    };
    let scalars: Option<Components> = list.iter().map(scalar).collect();
    scalars
        .filter(|s| s.len() == space.dim())
        .ok_or_else(|| wrong(at, expected, &value))
}

fn components_in_words(space: Space) -> &'static str {
    match space {
        Space::Plane => "two components",
        Space::Space3 => "three components",
    }
}
