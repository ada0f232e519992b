//! Translation of expressions into straight-line code.

use crate::graph::{Expr, Graph, Node};
use crate::program::{Binary, Op, Program, Value};

impl Program {
    /// Creates code that computes `outputs`, in this order.
    #[must_use]
    pub fn new(g: &Graph, outputs: &[Expr]) -> Self {
        let mut program = Self::default();
        program.outputs = outputs.iter().map(|&e| program.lower(g, e)).collect();
        program
    }

    fn lower(&mut self, g: &Graph, e: Expr) -> Value {
        if let Some(&v) = self.values.get(&e) {
            return v;
        }
        let v = match g.node(e) {
            Node::Number(x) => self.push(Op::Number(x.to_bits())),
            Node::Symbol(s) => self.push(Op::Input(*s)),
            Node::Call(f, u) => {
                let u = self.lower(g, *u);
                self.push(Op::Call(*f, u))
            }
            Node::Sum(terms) => self.lower_sum(g, terms),
            Node::Product(c, factors) => self.lower_product(g, *c, factors),
        };
        self.values.insert(e, v);
        v
    }

    /// Adds the terms from left to right. The first coefficient is positive in canonical form, so
    /// no change of sign is needed.
    fn lower_sum(&mut self, g: &Graph, terms: &[(f64, Expr)]) -> Value {
        let mut sum = None;
        for &(c, e) in terms {
            let term = self.lower(g, e);
            let constant = match self.op(term) {
                Op::Number(bits) => Some(f64::from_bits(bits) * c.abs()),
                _ => None,
            };
            let term = match constant {
                Some(x) => self.push(Op::Number(x.to_bits())),
                None => self.scaled(c.abs(), term),
            };
            sum = Some(match sum {
                None => term,
                Some(sum) if c > 0.0 => self.push(Op::Binary(Binary::Add, sum, term)),
                Some(sum) => self.push(Op::Binary(Binary::Sub, sum, term)),
            });
        }
        sum.expect("a sum in canonical form has at least two terms")
    }

    /// Computes powers first, so that a square is shared. At most one quotient follows, and the
    /// sign comes last.
    fn lower_product(&mut self, g: &Graph, c: f64, factors: &[(Expr, i32)]) -> Value {
        let mut numerator = None;
        let mut denominator = None;
        for &(e, n) in factors {
            let base = self.lower(g, e);
            let power = (1..n.unsigned_abs()).fold(base, |power, _| {
                self.push(Op::Binary(Binary::Mul, power, base))
            });
            let side = if n > 0 {
                &mut numerator
            } else {
                &mut denominator
            };
            *side = Some(match *side {
                None => power,
                Some(so_far) => self.push(Op::Binary(Binary::Mul, so_far, power)),
            });
        }
        let magnitude = match (numerator, denominator) {
            (Some(n), None) => self.scaled(c.abs(), n),
            (Some(n), Some(d)) => {
                let n = self.scaled(c.abs(), n);
                self.push(Op::Binary(Binary::Div, n, d))
            }
            (None, Some(d)) => {
                let n = self.push(Op::Number(c.abs().to_bits()));
                self.push(Op::Binary(Binary::Div, n, d))
            }
            (None, None) => unreachable!("a product in canonical form has factors"),
        };
        if c < 0.0 {
            self.push(Op::Neg(magnitude))
        } else {
            magnitude
        }
    }

    fn scaled(&mut self, c: f64, v: Value) -> Value {
        if c == 1.0 {
            return v;
        }
        let c = self.push(Op::Number(c.to_bits()));
        self.push(Op::Binary(Binary::Mul, c, v))
    }
}
