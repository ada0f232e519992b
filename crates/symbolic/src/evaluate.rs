//! Direct evaluation of an expression for any numeric type. Direct evaluation is used for constants
//! of definitions, and as the reference in tests of printed code.

use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg};

use rotation::angle_over_sine;

use crate::graph::{Expr, Function, Graph, Node, Symbol};

/// The operations of a numeric type that direct evaluation needs.
pub trait Number:
    Copy + From<f64> + Add<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Returns `f(self)`.
    fn call(self, f: Function) -> Self;
}

impl Number for f64 {
    fn call(self, f: Function) -> Self {
        match f {
            Function::Sqrt => self.sqrt(),
            Function::Sin => self.sin(),
            Function::Cos => self.cos(),
            Function::RecipOrZero => {
                if self == 0.0 {
                    0.0
                } else {
                    1.0 / self
                }
            }
            Function::AngleOverSine(order) => angle_over_sine(self, order),
        }
    }
}

impl Graph {
    /// Returns the value of `e` if each input has the value `input(symbol)`.
    pub fn evaluate<T: Number>(&self, e: Expr, input: &impl Fn(Symbol) -> T) -> T {
        self.value(e, input, &mut HashMap::new())
    }

    fn value<T: Number>(
        &self,
        e: Expr,
        input: &impl Fn(Symbol) -> T,
        done: &mut HashMap<Expr, T>,
    ) -> T {
        if let Some(&v) = done.get(&e) {
            return v;
        }
        let v = match self.node(e) {
            Node::Number(x) => T::from(*x),
            Node::Symbol(s) => input(*s),
            Node::Sum(terms) => terms.iter().fold(T::from(0.0), |sum, &(c, t)| {
                sum + T::from(c) * self.value(t, input, done)
            }),
            Node::Product(c, factors) => factors.iter().fold(T::from(*c), |product, &(f, n)| {
                let base = self.value(f, input, done);
                (0..n.unsigned_abs()).fold(product, |p, _| if n > 0 { p * base } else { p / base })
            }),
            Node::Call(f, u) => self.value(*u, input, done).call(*f),
        };
        done.insert(e, v);
        v
    }
}
