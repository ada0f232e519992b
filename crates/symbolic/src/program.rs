//! Straight-line code of binary operations, with operation counts. Value numbering ensures that
//! shared values are computed once. A program is lowered from expressions ([`Program::new`]) or
//! built operation by operation, with known values folded.

use std::collections::HashMap;
use std::fmt;

use crate::graph::{Expr, Function, Symbol};

/// Handle of an operation of a [`Program`]; operands precede their uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(u32);

/// Operations with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// The sum `a + b`.
    Add,
    /// The difference `a − b`.
    Sub,
    /// The product `a · b`.
    Mul,
    /// The quotient `a / b`.
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
    /// Number of products.
    pub mul: usize,
    /// Number of sums and differences.
    pub add: usize,
    /// Number of changes of sign.
    pub neg: usize,
    /// Number of quotients.
    pub div: usize,
    /// Number of square roots and other functions.
    pub call: usize,
}

impl Counts {
    /// Returns the sum of all counts.
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
        if parts.is_empty() {
            f.write_str("none")
        } else {
            f.write_str(&parts.join(", "))
        }
    }
}

/// Straight-line code for a list of outputs.
#[derive(Clone, Default)]
pub struct Program {
    ops: Vec<Op>,
    pub(crate) outputs: Vec<Value>,
    pub(crate) values: HashMap<Expr, Value>,
    table: HashMap<Op, Value>,
}

impl Program {
    /// Returns the operations, operands first.
    #[must_use]
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// Returns the handle of each output.
    #[must_use]
    pub fn outputs(&self) -> &[Value] {
        &self.outputs
    }

    /// Returns the handle of an expression, if the program computes it.
    #[must_use]
    pub fn value_of(&self, e: Expr) -> Option<Value> {
        self.values.get(&e).copied()
    }

    /// Returns the operation that a handle refers to.
    #[must_use]
    pub fn op(&self, v: Value) -> Op {
        self.ops[v.0 as usize]
    }

    /// Returns the handle of the operation with this index in [`Program::ops`].
    ///
    /// # Panics
    /// Panics if the index is too large.
    #[must_use]
    pub fn value_at(&self, place: usize) -> Value {
        assert!(
            place < self.ops.len(),
            "operation {place} of {}",
            self.ops.len()
        );
        Value(place as u32)
    }

    /// Returns the number of uses of each operation by other operations and by outputs.
    #[must_use]
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![0; self.ops.len()];
        for v in self
            .ops
            .iter()
            .flat_map(Op::operands)
            .chain(self.outputs.iter().copied())
        {
            uses[v.0 as usize] += 1;
        }
        uses
    }

    /// Returns the number of operations of each kind.
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

    /// Returns the handle of an operation. If the program already contains the operation, its
    /// existing handle is returned.
    pub(crate) fn push(&mut self, op: Op) -> Value {
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
    /// Returns the index in [`Program::ops`].
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl Op {
    /// Returns the operands.
    pub fn operands(&self) -> impl Iterator<Item = Value> + use<> {
        let (a, b) = match *self {
            Op::Number(_) | Op::Input(_) => (None, None),
            Op::Binary(_, a, b) => (Some(a), Some(b)),
            Op::Neg(a) | Op::Call(_, a) => (Some(a), None),
        };
        a.into_iter().chain(b)
    }

    /// Returns this operation with other operands, if all operands have a replacement.
    pub(crate) fn with_operands(&self, to: impl Fn(Value) -> Option<Value>) -> Option<Self> {
        Some(match *self {
            Op::Number(_) | Op::Input(_) => *self,
            Op::Binary(kind, a, b) => Op::Binary(kind, to(a)?, to(b)?),
            Op::Neg(a) => Op::Neg(to(a)?),
            Op::Call(f, a) => Op::Call(f, to(a)?),
        })
    }
}
