//! From expressions to straight-line code: binary operations with value numbering, so that what is
//! shared is computed once, and the count of what is left.

use std::collections::HashMap;
use std::fmt;

use crate::graph::{Expr, Function, Graph, Node, Symbol};

/// Handle of an operation of a [`Program`]; operands come before their uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(u32);

/// Operations of two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// `a + b`
    Add,
    /// `a − b`
    Sub,
    /// `a · b`
    Mul,
    /// `a / b`
    Div,
}

/// One operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// A constant, as bits.
    Number(u64),
    /// An input.
    Input(Symbol),
    /// Sum, difference, product or quotient.
    Binary(Binary, Value, Value),
    /// Change of sign.
    Neg(Value),
    /// A function of one argument.
    Call(Function, Value),
}

/// Number of operations of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Products.
    pub mul: usize,
    /// Sums and differences.
    pub add: usize,
    /// Changes of sign.
    pub neg: usize,
    /// Quotients.
    pub div: usize,
    /// Square roots and other functions.
    pub call: usize,
}

impl Counts {
    /// All of them.
    #[must_use]
    pub fn total(&self) -> usize {
        self.mul + self.add + self.neg + self.div + self.call
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts: Vec<String> = [
            (self.mul, "mul"),
            (self.add, "add"),
            (self.neg, "neg"),
            (self.div, "div"),
            (self.call, "call"),
        ]
        .iter()
        .filter(|(n, _)| *n > 0)
        .map(|(n, kind)| format!("{n} {kind}"))
        .collect();
        match parts.is_empty() {
            true => f.write_str("none"),
            false => f.write_str(&parts.join(", ")),
        }
    }
}

/// Straight-line code for a list of outputs.
pub struct Program {
    ops: Vec<Op>,
    outputs: Vec<Value>,
    values: HashMap<Expr, Value>,
    table: HashMap<Op, Value>,
}

impl Program {
    /// Code that computes `outputs`, in this order.
    #[must_use]
    pub fn new(g: &Graph, outputs: &[Expr]) -> Self {
        let mut program = Self {
            ops: Vec::new(),
            outputs: Vec::new(),
            values: HashMap::new(),
            table: HashMap::new(),
        };
        program.outputs = outputs.iter().map(|&e| program.lower(g, e)).collect();
        program
    }

    /// The operations, operands first.
    #[must_use]
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// Where each output is found.
    #[must_use]
    pub fn outputs(&self) -> &[Value] {
        &self.outputs
    }

    /// Where an expression is found, if the program computes it on its way.
    #[must_use]
    pub fn value_of(&self, e: Expr) -> Option<Value> {
        self.values.get(&e).copied()
    }

    /// The operation behind a handle.
    #[must_use]
    pub fn op(&self, v: Value) -> Op {
        self.ops[v.0 as usize]
    }

    /// The handle of the operation at a place of [`Program::ops`].
    ///
    /// # Panics
    /// If there is no such place.
    #[must_use]
    pub fn value_at(&self, place: usize) -> Value {
        assert!(
            place < self.ops.len(),
            "operation {place} of {}",
            self.ops.len()
        );
        Value(place as u32)
    }

    /// How often each operation is used by others and by outputs.
    #[must_use]
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![0; self.ops.len()];
        for v in self
            .ops
            .iter()
            .flat_map(operands)
            .chain(self.outputs.iter().copied())
        {
            uses[v.0 as usize] += 1;
        }
        uses
    }

    /// Number of operations of each kind.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for op in &self.ops {
            match op {
                Op::Number(_) | Op::Input(_) => {}
                Op::Binary(Binary::Add | Binary::Sub, ..) => counts.add += 1,
                Op::Binary(Binary::Mul, ..) => counts.mul += 1,
                Op::Binary(Binary::Div, ..) => counts.div += 1,
                Op::Neg(_) => counts.neg += 1,
                Op::Call(..) => counts.call += 1,
            }
        }
        counts
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

    /// Left to right; the first coefficient is positive in canonical form, so no sign is wasted.
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

    /// Powers first, so that a square is shared; one quotient at the end; the sign last.
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
        match c < 0.0 {
            true => self.push(Op::Neg(magnitude)),
            false => magnitude,
        }
    }

    fn scaled(&mut self, c: f64, v: Value) -> Value {
        if c == 1.0 {
            return v;
        }
        let c = self.push(Op::Number(c.to_bits()));
        self.push(Op::Binary(Binary::Mul, c, v))
    }

    fn push(&mut self, op: Op) -> Value {
        if let Some(&v) = self.table.get(&op) {
            return v;
        }
        let v = Value(self.ops.len() as u32);
        self.ops.push(op);
        self.table.insert(op, v);
        v
    }
}

impl Value {
    /// Place in [`Program::ops`].
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

fn operands(op: &Op) -> impl Iterator<Item = Value> + use<> {
    let (a, b) = match *op {
        Op::Number(_) | Op::Input(_) => (None, None),
        Op::Binary(_, a, b) => (Some(a), Some(b)),
        Op::Neg(a) | Op::Call(_, a) => (Some(a), None),
    };
    a.into_iter().chain(b)
}
