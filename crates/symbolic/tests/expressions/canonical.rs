//! Tests the canonical form: it does not depend on the order of construction.

use pfaff_symbolic::{Expr, Function, Graph, Node, Printer, Program, Scalar};
use proptest::prelude::*;

use crate::tree::{INPUTS, Order, graph, trees};
use crate::{config, interpreter};

proptest! {
    #![proptest_config(config())]

    #[test]
    fn commuted_construction_gives_the_same_handle(tree in trees()) {
        let mut g = graph();
        let written = tree.build(&mut g, Order::Written);
        let reversed = tree.build(&mut g, Order::Reversed);
        prop_assert_eq!(written, reversed);
    }

    #[test]
    fn two_graphs_print_the_same_bytes(first in trees(), second in trees()) {
        let mut g = graph();
        let outputs = [&first, &second].map(|t| t.build(&mut g, Order::Written));
        let mut h = graph();
        let mut reversed = [&second, &first].map(|t| t.build(&mut h, Order::Reversed));
        reversed.reverse();
        prop_assert_eq!(print(&g, &outputs), print(&h, &reversed));
    }

    #[test]
    fn every_node_is_in_the_documented_form(tree in trees()) {
        let mut g = graph();
        let e = tree.build(&mut g, Order::Written);
        let mut stack = vec![e];
        while let Some(e) = stack.pop() {
            prop_assert_eq!(violation(&g, e), None, "{:?}", g.node(e));
            stack.extend(g.children(e));
        }
    }
}

fn print(g: &Graph, outputs: &[Expr]) -> String {
    let program = Program::new(g, outputs);
    interpreter::text(Printer::new(g, &program, Scalar::F64, &[]).print())
}

/// The first violated guarantee of the documentation of [`Node`], if any.
fn violation(g: &Graph, e: Expr) -> Option<&'static str> {
    match g.node(e) {
        Node::Number(_) | Node::Symbol(_) => None,
        Node::Sum(terms) => {
            let scaled = |t: &Expr| matches!(g.node(*t), Node::Product(c, _) if *c != 1.0);
            let number = |t: &Expr| g.as_number(*t).is_some_and(|x| x != 1.0);
            let rules = [
                (terms.len() < 2, "fewer than two terms"),
                (terms[0].0 <= 0.0, "first coefficient not positive"),
                (terms.iter().any(|t| t.0 == 0.0), "coefficient zero"),
                (
                    terms.iter().any(|t| scaled(&t.1)),
                    "coefficient inside a term",
                ),
                (
                    terms.iter().any(|t| number(&t.1)),
                    "constant that is no multiple of 1",
                ),
                (
                    terms
                        .iter()
                        .rev()
                        .skip(1)
                        .any(|t| g.as_number(t.1).is_some()),
                    "constant not last",
                ),
                (has_duplicates(terms.iter().map(|t| t.1)), "like terms"),
            ];
            rules.into_iter().find(|r| r.0).map(|r| r.1)
        }
        Node::Product(c, factors) => {
            let nested = |f: &Expr| matches!(g.node(*f), Node::Product(..));
            let root = |f: &Expr| matches!(g.node(*f), Node::Call(Function::Sqrt, _));
            let rules = [
                (*c == 0.0, "coefficient zero"),
                (factors.is_empty(), "no factors"),
                (
                    *c == 1.0 && factors.len() == 1 && factors[0].1 == 1,
                    "a product of one",
                ),
                (factors.iter().any(|f| f.1 == 0), "exponent zero"),
                (factors.iter().any(|f| nested(&f.0)), "nested product"),
                (
                    factors.iter().any(|f| root(&f.0) && f.1.abs() > 1),
                    "power of a root",
                ),
                (has_duplicates(factors.iter().map(|f| f.0)), "like factors"),
            ];
            rules.into_iter().find(|r| r.0).map(|r| r.1)
        }
        Node::Call(_, u) => {
            let constant = g.as_number(*u) == Some(0.0);
            constant.then_some("function of zero")
        }
    }
}

fn has_duplicates(handles: impl Iterator<Item = Expr>) -> bool {
    let mut list: Vec<_> = handles.collect();
    let n = list.len();
    list.sort_unstable();
    list.dedup();
    list.len() < n
}

/// The expressions are `x + y`, `x + y + z`, `x·y`, `x·y·z`, `2·x·y`: each is the beginning of
/// another one, or differs by a number.
fn similar(g: &mut Graph, k: usize) -> Expr {
    let [x, y, z] = INPUTS.map(|name| g.symbol(name));
    match k {
        0 => g.add(x, y),
        1 => g.sum(&[(1.0, x), (1.0, y), (1.0, z)]),
        2 => g.mul(x, y),
        3 => g.product(1.0, &[(x, 1), (y, 1), (z, 1)]),
        _ => g.product(2.0, &[(x, 1), (y, 1)]),
    }
}

#[test]
fn similar_expressions_have_an_order() {
    for (i, k) in (0..5).flat_map(|i| (0..i).map(move |k| (i, k))) {
        let [first, second] = [(i, k), (k, i)].map(|(first, second)| {
            let mut g = graph();
            let terms = [first, second].map(|k| {
                let u = similar(&mut g, k);
                (1.0, g.call(Function::Sin, u))
            });
            let sum = g.sum(&terms);
            print(&g, &[sum])
        });
        assert_eq!(first, second);
    }
}

#[test]
fn products_are_associative_and_commutative() {
    let mut g = Graph::new();
    let (a, b, c) = (g.symbol("a"), g.symbol("b"), g.symbol("c"));
    let (ab, bc, ca) = (g.mul(a, b), g.mul(b, c), g.mul(c, a));
    let all = [g.mul(ab, c), g.mul(a, bc), g.mul(b, ca), g.mul(c, ab)];
    assert!(all.iter().all(|e| *e == all[0]), "{all:?}");
}

#[test]
fn nested_sums_stay_nested_but_their_difference_is_zero() {
    let mut g = Graph::new();
    let (a, b, c) = (g.symbol("a"), g.symbol("b"), g.symbol("c"));
    let (ab, bc) = (g.add(a, b), g.add(b, c));
    let (left, right) = (g.add(ab, c), g.add(a, bc));
    assert_ne!(left, right, "the nesting of a definition is kept");
    let difference = g.sub(left, right);
    assert!(g.is_zero(difference));
}

#[test]
fn terms_and_factors_are_ordered_by_first_use_of_their_inputs() {
    let mut g = Graph::new();
    // The order is not alphabetical on purpose.
    let (z, a) = (g.symbol("z"), g.symbol("a"));
    let one = g.number(1.0);
    let sum = g.sum(&[(1.0, one), (1.0, a), (1.0, z)]);
    assert_eq!(
        g.node(sum),
        &Node::Sum(vec![(1.0, z), (1.0, a), (1.0, one)])
    );
    let product = g.mul(a, z);
    assert_eq!(g.node(product), &Node::Product(1.0, vec![(z, 1), (a, 1)]));
}

#[test]
fn zero_has_one_handle() {
    let mut g = Graph::new();
    let (minus, plus) = (g.number(-0.0), g.number(0.0));
    assert_eq!(minus, plus);
}
