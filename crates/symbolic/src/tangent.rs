//! Derivatives of straight-line code along a direction of its inputs: every operation in turn, by
//! the chain rule.

use crate::graph::{Function, Symbol};
use crate::program::{Binary, Op, Program, Value};

impl Program {
    /// Appends code for the derivatives of `of` along the direction in which each input moves by
    /// `along(program, symbol, value)`.
    ///
    /// ```
    /// use symbolic::{Graph, Program};
    /// let mut names = Graph::new();
    /// let symbols = ["x", "dx"].map(|n| names.symbol(n)).map(|e| names.as_symbol(e).unwrap());
    /// let mut p = Program::empty();
    /// let [x, dx] = symbols.map(|s| p.input(s));
    /// let square = p.mul(x, x);
    /// let zero = p.number(0.0);
    /// let d = p.tangent(&[square], |_, s, _| if s == symbols[0] { dx } else { zero });
    /// let p = p.with_outputs(&d); // x·dx + x·dx
    /// assert_eq!(p.run(|s| if s == symbols[0] { 3.0 } else { 0.5 }), [3.0]);
    /// ```
    pub fn tangent(
        &mut self,
        of: &[Value],
        mut along: impl FnMut(&mut Self, Symbol, Value) -> Value,
    ) -> Vec<Value> {
        let last = of.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let zero = self.number(0.0);
        let mut d: Vec<Value> = Vec::with_capacity(last);
        for k in 0..last {
            let v = self.value_at(k);
            let derivative = match self.op(v) {
                Op::Number(_) => zero,
                Op::Input(s) => along(self, s, v),
                Op::Neg(a) => self.neg(d[a.index()]),
                Op::Binary(kind, a, b) => {
                    self.tangent_of_binary(kind, v, [a, b], [d[a.index()], d[b.index()]])
                }
                Op::Call(_, a) if self.is_zero(d[a.index()]) => zero,
                Op::Call(f, a) => {
                    let outer = match f {
                        // Zero at zero, as the graph has it.
                        Function::Sqrt => {
                            let (half, recip) =
                                (self.number(0.5), self.call(Function::RecipOrZero, v));
                            self.mul(half, recip)
                        }
                        Function::RecipOrZero => {
                            let square = self.mul(v, v);
                            self.neg(square)
                        }
                        Function::Sin => self.call(Function::Cos, a),
                        Function::Cos => {
                            let sin = self.call(Function::Sin, a);
                            self.neg(sin)
                        }
                    };
                    self.mul(outer, d[a.index()])
                }
            };
            d.push(derivative);
        }
        of.iter().map(|v| d[v.index()]).collect()
    }

    fn tangent_of_binary(
        &mut self,
        kind: Binary,
        v: Value,
        [a, b]: [Value; 2],
        [da, db]: [Value; 2],
    ) -> Value {
        match kind {
            Binary::Add => self.add(da, db),
            Binary::Sub => self.sub(da, db),
            Binary::Mul => {
                let (left, right) = (self.mul(da, b), self.mul(a, db));
                self.add(left, right)
            }
            // d(a/b) = (da − (a/b)·db)/b
            Binary::Div => {
                let moved = self.mul(v, db);
                let numerator = self.sub(da, moved);
                self.div(numerator, b)
            }
        }
    }
}
