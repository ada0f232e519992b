//! An expression in its written form, without simplification by the graph, and random expressions.

use pfaff_symbolic::{Expr, Function, Graph, Number};
use proptest::prelude::*;

/// Names of the inputs, in the order in which every graph registers them.
pub(crate) const INPUTS: [&str; 3] = ["x", "y", "z"];

#[derive(Clone, Debug)]
pub(crate) enum Tree {
    Input(usize),
    Constant(f64),
    Add(Box<Tree>, Box<Tree>),
    Sub(Box<Tree>, Box<Tree>),
    /// `Π base^exponent`
    Product(Vec<(Tree, i32)>),
    /// `√(1 + u²)`
    Root(Box<Tree>),
    /// The reciprocal `1/u`, or 0 if `u` is 0.
    RecipOrZero(Box<Tree>),
    Sin(Box<Tree>),
    Cos(Box<Tree>),
}

/// The order in which a tree is converted into nodes. All orders are mathematically equivalent.
#[derive(Clone, Copy)]
pub(crate) enum Order {
    Written,
    Reversed,
}

impl Tree {
    /// Builds the expression in the graph.
    pub(crate) fn build(&self, g: &mut Graph, order: Order) -> Expr {
        match self {
            Tree::Input(k) => g.symbol(INPUTS[*k]),
            Tree::Constant(c) => g.number(*c),
            Tree::Add(a, b) => {
                let (a, b) = build_pair(a, b, g, order);
                match order {
                    Order::Written => g.add(a, b),
                    Order::Reversed => g.add(b, a),
                }
            }
            Tree::Sub(a, b) => {
                let (a, b) = build_pair(a, b, g, order);
                match order {
                    Order::Written => g.sub(a, b),
                    Order::Reversed => g.sum(&[(-1.0, b), (1.0, a)]),
                }
            }
            Tree::Product(factors) => {
                let build = |(f, n): &(Tree, i32)| (f.build(g, order), *n);
                let factors: Vec<_> = match order {
                    Order::Written => factors.iter().map(build).collect(),
                    Order::Reversed => factors.iter().rev().map(build).collect(),
                };
                g.product(1.0, &factors)
            }
            Tree::Root(u) => {
                let u = u.build(g, order);
                let (one, square) = (g.number(1.0), g.mul(u, u));
                let radicand = g.add(one, square);
                g.call(Function::Sqrt, radicand)
            }
            Tree::RecipOrZero(u) => {
                let u = u.build(g, order);
                g.call(Function::RecipOrZero, u)
            }
            Tree::Sin(u) => {
                let u = u.build(g, order);
                g.call(Function::Sin, u)
            }
            Tree::Cos(u) => {
                let u = u.build(g, order);
                g.call(Function::Cos, u)
            }
        }
    }

    /// Returns the value, computed by the operations as written.
    pub(crate) fn evaluate<T: Number>(&self, inputs: &[T; 3]) -> T {
        match self {
            Tree::Input(k) => inputs[*k],
            Tree::Constant(c) => T::from(*c),
            Tree::Add(a, b) => a.evaluate(inputs) + b.evaluate(inputs),
            Tree::Sub(a, b) => a.evaluate(inputs) + -b.evaluate(inputs),
            Tree::Product(factors) => factors.iter().fold(T::from(1.0), |product, (f, n)| {
                let base = f.evaluate(inputs);
                let power = (0..n.unsigned_abs()).fold(T::from(1.0), |p, _| p * base);
                if *n < 0 {
                    product / power
                } else {
                    product * power
                }
            }),
            Tree::Root(u) => {
                let u = u.evaluate(inputs);
                (T::from(1.0) + u * u).call(Function::Sqrt)
            }
            Tree::RecipOrZero(u) => u.evaluate(inputs).call(Function::RecipOrZero),
            Tree::Sin(u) => u.evaluate(inputs).call(Function::Sin),
            Tree::Cos(u) => u.evaluate(inputs).call(Function::Cos),
        }
    }
}

fn build_pair(a: &Tree, b: &Tree, g: &mut Graph, order: Order) -> (Expr, Expr) {
    match order {
        Order::Written => {
            let a = a.build(g, order);
            (a, b.build(g, order))
        }
        Order::Reversed => {
            let b = b.build(g, order);
            (a.build(g, order), b)
        }
    }
}

/// Returns a graph that contains only the inputs.
pub(crate) fn graph() -> Graph {
    let mut g = Graph::new();
    for name in INPUTS {
        g.symbol(name);
    }
    g
}

/// Returns the value of the input called `name`.
pub(crate) fn input_of<T: Copy>(inputs: &[T; 3], name: &str) -> T {
    let k = INPUTS.iter().position(|n| *n == name);
    inputs[k.expect("only the inputs of INPUTS are used")]
}

/// Returns random trees. Constants are powers of two, so that the graph folds them without rounding
/// as long as no sum of constants is inverted.
pub(crate) fn trees() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        4 => (0..INPUTS.len()).prop_map(Tree::Input),
        1 => prop::sample::select(vec![-2.0, -1.0, 0.5, 1.0, 2.0]).prop_map(Tree::Constant),
    ];
    leaf.prop_recursive(5, 24, 3, |inner| {
        let boxed = || inner.clone().prop_map(Box::new);
        prop_oneof![
            3 => (boxed(), boxed()).prop_map(|(a, b)| Tree::Add(a, b)),
            3 => (boxed(), boxed()).prop_map(|(a, b)| Tree::Sub(a, b)),
            4 => prop::collection::vec((inner.clone(), -2..=3), 1..=3).prop_map(Tree::Product),
            1 => boxed().prop_map(Tree::Root),
            1 => boxed().prop_map(Tree::RecipOrZero),
            1 => boxed().prop_map(Tree::Sin),
            1 => boxed().prop_map(Tree::Cos),
        ]
    })
}

/// Returns random values of the inputs, away from zero.
pub(crate) fn points() -> impl Strategy<Value = [f64; 3]> {
    let coordinate = || prop_oneof![0.5..2.0, -2.0..-0.5];
    [coordinate(), coordinate(), coordinate()]
}
