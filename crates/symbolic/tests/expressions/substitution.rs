//! Tests the replacement of inputs.

use pfaff_symbolic::Graph;
use proptest::prelude::*;

use crate::config;
use crate::running::Running;
use crate::tree::{Order, graph, input_of, points, trees};

proptest! {
    #![proptest_config(config())]

    #[test]
    fn replacing_nothing_changes_nothing(tree in trees()) {
        let mut g = graph();
        let e = tree.build(&mut g, Order::Written);
        prop_assert_eq!(g.substitute(e, &[]), e);
    }

    #[test]
    fn the_value_is_that_at_the_replaced_inputs(
        tree in trees(), for_x in trees(), for_y in trees(), at in points(),
    ) {
        let mut g = graph();
        let e = tree.build(&mut g, Order::Written);
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let pairs = [
            (x, for_x.build(&mut g, Order::Written)),
            (y, for_y.build(&mut g, Order::Written)),
        ];
        let replaced = g.substitute(e, &pairs);

        let inputs = at.map(|x| Running::input(x, 0.0));
        let moved = [for_x.evaluate(&inputs), for_y.evaluate(&inputs), inputs[2]];
        let written = tree.evaluate(&moved).value();
        let ours = g.evaluate(replaced, &|s| input_of(&inputs, g.name(s))).value();
        prop_assume!(ours.tolerance(written).is_finite());
        prop_assert!(ours.agrees(written), "{ours:?} instead of {written:?}");
    }
}

#[test]
fn replacements_happen_at_once() {
    // a − b with a ↔ b is b − a.
    let mut g = Graph::new();
    let (a, b) = (g.symbol("a"), g.symbol("b"));
    let e = g.sub(a, b);
    let swapped = g.substitute(e, &[(a, b), (b, a)]);
    assert_eq!(swapped, g.neg(e));
}

#[test]
fn the_result_is_in_canonical_form() {
    // (a + b)·c with b = −a is 0.
    let mut g = Graph::new();
    let (a, b, c) = (g.symbol("a"), g.symbol("b"), g.symbol("c"));
    let ab = g.add(a, b);
    let e = g.mul(ab, c);
    let minus_a = g.neg(a);
    let zero = g.substitute(e, &[(b, minus_a)]);
    assert!(g.is_zero(zero));
}
