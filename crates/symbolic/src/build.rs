//! Straight-line code, built operation by operation. Operations whose result is known are folded.
//! These are operations on constants, operations with zeros and ones, changes of sign, and `x − x`.
//! Terms are not regrouped. The caller therefore determines the order of operations, and with it
//! the rounding.

use rotation::angle_over_sine;

use crate::evaluate::Number;
use crate::graph::{Function, Symbol};
use crate::program::{Binary, Op, Program, Value};

impl Program {
    /// Creates a program without operations.
    ///
    /// ```
    /// use pfaff_symbolic::{Graph, Program};
    /// let mut names = Graph::new();
    /// let x = names.symbol("x");
    /// let mut p = Program::empty();
    /// let x = p.input(names.as_symbol(x).unwrap());
    /// let (zero, two) = (p.number(0.0), p.number(2.0));
    /// let (minus, nothing) = (p.neg(x), p.mul(zero, x));
    /// let y = p.mul(two, minus);
    /// let y = p.sub(y, nothing); // 2·(−x) − 0·x is −(2·x)
    /// let p = p.with_outputs(&[y]);
    /// assert_eq!(p.counts().to_string(), "1 mul, 1 neg");
    /// ```
    #[must_use]
    pub fn empty() -> Self {
        Self::default()
    }

    /// Returns a program that computes these outputs and contains only the operations that they
    /// need.
    #[must_use]
    pub fn with_outputs(&self, outputs: &[Value]) -> Self {
        let mut needed = vec![false; self.ops().len()];
        for v in outputs {
            needed[v.index()] = true;
        }
        for k in (0..needed.len()).rev() {
            if needed[k] {
                for v in self.ops()[k].operands() {
                    needed[v.index()] = true;
                }
            }
        }
        let mut kept = Self::empty();
        let mut places: Vec<Option<Value>> = vec![None; needed.len()];
        for (k, op) in self.ops().iter().enumerate().filter(|(k, _)| needed[*k]) {
            places[k] = op
                .with_operands(|v| places[v.index()])
                .map(|op| kept.push(op));
        }
        kept.outputs = outputs.iter().filter_map(|v| places[v.index()]).collect();
        kept
    }

    /// Adds an input.
    pub fn input(&mut self, s: Symbol) -> Value {
        self.push(Op::Input(s))
    }

    /// Adds a constant.
    pub fn number(&mut self, x: f64) -> Value {
        // The values −0 and 0 are one constant.
        self.push(Op::Number(if x == 0.0 { 0.0_f64 } else { x }.to_bits()))
    }

    /// Returns the constant that a handle refers to, if the handle refers to a constant.
    #[must_use]
    pub fn as_number(&self, v: Value) -> Option<f64> {
        match self.op(v) {
            Op::Number(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// Returns whether a value is the constant 0.
    #[must_use]
    pub fn is_zero(&self, v: Value) -> bool {
        self.as_number(v) == Some(0.0)
    }

    /// Adds the sum `a + b`.
    pub fn add(&mut self, a: Value, b: Value) -> Value {
        match (self.as_number(a), self.as_number(b)) {
            (Some(x), Some(y)) => return self.number(x + y),
            (Some(0.0), _) => return b,
            (_, Some(0.0)) => return a,
            _ => {}
        }
        match (self.op(a), self.op(b)) {
            (_, Op::Neg(b)) => self.sub(a, b),
            (Op::Neg(a), _) => self.sub(b, a),
            _ => self.push(Op::Binary(Binary::Add, a.min(b), a.max(b))),
        }
    }

    /// Adds the difference `a − b`.
    pub fn sub(&mut self, a: Value, b: Value) -> Value {
        match (self.as_number(a), self.as_number(b)) {
            (Some(x), Some(y)) => return self.number(x - y),
            (Some(0.0), _) => return self.neg(b),
            (_, Some(0.0)) => return a,
            _ if a == b => return self.number(0.0),
            _ => {}
        }
        match (self.op(a), self.op(b)) {
            (_, Op::Neg(b)) => self.add(a, b),
            (Op::Neg(a), _) => {
                let sum = self.add(a, b);
                self.neg(sum)
            }
            _ => self.push(Op::Binary(Binary::Sub, a, b)),
        }
    }

    /// Adds the negative value `−a`.
    pub fn neg(&mut self, a: Value) -> Value {
        match self.op(a) {
            Op::Number(bits) => self.number(-f64::from_bits(bits)),
            Op::Neg(a) => a,
            Op::Binary(Binary::Sub, a, b) => self.push(Op::Binary(Binary::Sub, b, a)),
            _ => self.push(Op::Neg(a)),
        }
    }

    /// Adds the product `a · b`.
    pub fn mul(&mut self, a: Value, b: Value) -> Value {
        match (self.as_number(a), self.as_number(b)) {
            (Some(x), Some(y)) => return self.number(x * y),
            (Some(x), None) => return self.scale(x, b),
            (None, Some(y)) => return self.scale(y, a),
            (None, None) => {}
        }
        match (self.op(a), self.op(b)) {
            (Op::Neg(a), Op::Neg(b)) => self.mul(a, b),
            (Op::Neg(a), _) => {
                let product = self.mul(a, b);
                self.neg(product)
            }
            (_, Op::Neg(b)) => {
                let product = self.mul(a, b);
                self.neg(product)
            }
            _ => self.push(Op::Binary(Binary::Mul, a.min(b), a.max(b))),
        }
    }

    /// Adds the product of a constant and a value that is not a constant.
    fn scale(&mut self, x: f64, v: Value) -> Value {
        match (x, self.op(v)) {
            (0.0, _) => self.number(0.0),
            (1.0, _) => v,
            (-1.0, _) => self.neg(v),
            (_, Op::Neg(v)) => self.scale(-x, v),
            (x, _) if x < 0.0 => {
                let product = self.scale(-x, v);
                self.neg(product)
            }
            _ => {
                let x = self.number(x);
                self.push(Op::Binary(Binary::Mul, x, v))
            }
        }
    }

    /// Adds the quotient `a / b`. If `b` is a constant, the product with its reciprocal is added
    /// instead.
    pub fn div(&mut self, a: Value, b: Value) -> Value {
        match self.as_number(b) {
            Some(y) if y != 0.0 => {
                let inverse = self.number(1.0 / y);
                self.mul(a, inverse)
            }
            _ if self.is_zero(a) => a,
            _ => match (self.op(a), self.op(b)) {
                (Op::Neg(a), Op::Neg(b)) => self.div(a, b),
                (Op::Neg(a), _) => {
                    let quotient = self.div(a, b);
                    self.neg(quotient)
                }
                (_, Op::Neg(b)) => {
                    let quotient = self.div(a, b);
                    self.neg(quotient)
                }
                _ => self.push(Op::Binary(Binary::Div, a, b)),
            },
        }
    }

    /// Adds the function value `f(a)`.
    pub fn call(&mut self, f: Function, a: Value) -> Value {
        match (f, self.as_number(a)) {
            (Function::Sqrt, Some(x)) if x >= 0.0 => self.number(x.sqrt()),
            (Function::Sin, Some(x)) => self.number(x.sin()),
            (Function::Cos, Some(x)) => self.number(x.cos()),
            (Function::RecipOrZero, Some(0.0)) => self.number(0.0),
            (Function::RecipOrZero, Some(x)) => self.number(1.0 / x),
            (Function::AngleOverSine(order), Some(x)) => self.number(angle_over_sine(x, order)),
            _ => self.push(Op::Call(f, a)),
        }
    }

    /// Returns the values of the outputs if each input has the value `input(symbol)`. The values
    /// are equal to the results of the printed code, bit for bit.
    #[must_use]
    pub fn run(&self, input: impl Fn(Symbol) -> f64) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.ops().len());
        for op in self.ops() {
            values.push(op.evaluate(|v| values[v.index()], &input));
        }
        self.outputs().iter().map(|v| values[v.index()]).collect()
    }
}

impl Op {
    /// Returns the value of the operation if `of` returns the values of operands and `input`
    /// returns the values of inputs.
    pub fn evaluate(&self, of: impl Fn(Value) -> f64, input: impl Fn(Symbol) -> f64) -> f64 {
        match *self {
            Self::Number(bits) => f64::from_bits(bits),
            Self::Input(s) => input(s),
            Self::Neg(a) => -of(a),
            Self::Call(f, a) => of(a).call(f),
            Self::Binary(kind, a, b) => {
                let (a, b) = (of(a), of(b));
                match kind {
                    Binary::Add => a + b,
                    Binary::Sub => a - b,
                    Binary::Mul => a * b,
                    Binary::Div => a / b,
                }
            }
        }
    }
}
