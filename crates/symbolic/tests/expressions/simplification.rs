//! Tests the identities that the constructors recognise, one line of algebra each.

use pfaff_symbolic::{Expr, Function, Graph};

/// Returns a graph with inputs `a`, `b`, `c`, `x`.
fn inputs() -> (Graph, [Expr; 4]) {
    let mut g = Graph::new();
    let inputs = ["a", "b", "c", "x"].map(|name| g.symbol(name));
    (g, inputs)
}

#[test]
fn a_term_common_to_two_sums_cancels() {
    // (a + b) − (a + c) = b − c
    let (mut g, [a, b, c, _]) = inputs();
    let (ab, ac) = (g.add(a, b), g.add(a, c));
    let difference = g.sub(ab, ac);
    assert_eq!(difference, g.sub(b, c));
}

#[test]
fn a_term_cancels_through_nested_sums() {
    // ((a + b) + c) − a = b + c
    let (mut g, [a, b, c, _]) = inputs();
    let ab = g.add(a, b);
    let abc = g.add(ab, c);
    let difference = g.sub(abc, a);
    assert_eq!(difference, g.add(b, c));
}

#[test]
fn a_term_cancels_below_a_common_factor() {
    // x·(a + b) − a·x = b·x
    let (mut g, [a, b, _, x]) = inputs();
    let ab = g.add(a, b);
    let (left, right) = (g.mul(x, ab), g.mul(a, x));
    let difference = g.sub(left, right);
    assert_eq!(difference, g.mul(b, x));
}

#[test]
fn a_term_cancels_in_a_scaled_sum() {
    // 2·(a + b) − 2·a = 2·b
    let (mut g, [a, b, _, _]) = inputs();
    let ab = g.add(a, b);
    let difference = g.sum(&[(2.0, ab), (-2.0, a)]);
    assert_eq!(difference, g.product(2.0, &[(b, 1)]));
}

#[test]
fn sums_without_a_cancelling_term_stay_as_they_were_written() {
    // (a + b) + a keeps the shared a + b.
    let (mut g, [a, b, _, _]) = inputs();
    let ab = g.add(a, b);
    let e = g.add(ab, a);
    assert!(g.children(e).contains(&ab), "{:?}", g.node(e));
}

#[test]
fn like_terms_merge() {
    // a·x + 2·a·x = 3·a·x
    let (mut g, [a, _, _, x]) = inputs();
    let ax = g.mul(a, x);
    let e = g.sum(&[(1.0, ax), (2.0, ax)]);
    assert_eq!(e, g.product(3.0, &[(a, 1), (x, 1)]));
}

#[test]
fn a_common_factor_moves_out() {
    // a·x² + b·x = x·(a·x + b)
    let (mut g, [a, b, _, x]) = inputs();
    let (axx, ax, bx) = (g.product(1.0, &[(a, 1), (x, 2)]), g.mul(a, x), g.mul(b, x));
    let e = g.add(axx, bx);
    let inner = g.add(ax, b);
    assert_eq!(e, g.mul(x, inner));
}

#[test]
fn a_common_denominator_moves_out() {
    // a/x − b/x² = (a − b/x)/x
    let (mut g, [a, b, _, x]) = inputs();
    let first = g.div(a, x);
    let second = g.product(1.0, &[(b, 1), (x, -2)]);
    let e = g.sub(first, second);
    let b_over_x = g.div(b, x);
    let inner = g.sub(a, b_over_x);
    assert_eq!(e, g.div(inner, x));
}

#[test]
fn the_sign_of_a_difference_moves_out() {
    // b − a = −(a − b), (b − a)² = (a − b)², (b − a)/(a − b) = −1
    let (mut g, [a, b, _, _]) = inputs();
    let (ab, ba) = (g.sub(a, b), g.sub(b, a));
    assert_eq!(ba, g.neg(ab));
    let squares = [g.mul(ba, ba), g.mul(ab, ab)];
    assert_eq!(squares[0], squares[1]);
    let quotient = g.div(ba, ab);
    assert_eq!(g.as_number(quotient), Some(-1.0));
}

#[test]
fn a_coefficient_common_to_all_terms_moves_out() {
    // 2·b − 2·a = −2·(a − b)
    let (mut g, [a, b, _, _]) = inputs();
    let e = g.sum(&[(2.0, b), (-2.0, a)]);
    let difference = g.sub(a, b);
    assert_eq!(e, g.product(-2.0, &[(difference, 1)]));
}

#[test]
fn the_square_of_a_root_is_its_radicand() {
    // (√u)² = u, (√u)³ = u·√u, (√u)⁻² = 1/u, (√u)⁻³ = 1/(u·√u) with u = a + b
    let (mut g, [a, b, _, _]) = inputs();
    let u = g.add(a, b);
    let root = g.call(Function::Sqrt, u);
    assert_eq!(g.mul(root, root), u);
    let cube = g.product(1.0, &[(root, 3)]);
    assert_eq!(cube, g.mul(u, root));
    let inverse = g.product(1.0, &[(root, -2)]);
    assert_eq!(inverse, g.product(1.0, &[(u, -1)]));
    let inverse_cube = g.product(1.0, &[(root, -3)]);
    assert_eq!(inverse_cube, g.product(1.0, &[(u, -1), (root, -1)]));
}

#[test]
fn the_square_of_an_input_below_a_root_is_not_the_input() {
    // √(x²) = |x|
    let (mut g, [.., x]) = inputs();
    let square = g.mul(x, x);
    let root = g.call(Function::Sqrt, square);
    assert_ne!(root, x);
    let input = |_| -3.0;
    assert_eq!(g.evaluate(root, &input), 3.0);
}

#[test]
fn numbers_fold() {
    let (mut g, [_, _, _, x]) = inputs();
    let (two, three, zero) = (g.number(2.0), g.number(3.0), g.number(0.0));
    let six = g.mul(two, three);
    assert_eq!(g.as_number(six), Some(6.0));
    for (k, expected) in [(-3, 0.125), (-1, 0.5), (0, 1.0), (1, 2.0), (5, 32.0)] {
        let power = g.product(1.0, &[(two, k)]);
        assert_eq!(g.as_number(power), Some(expected), "2^{k}");
    }
    let e = g.mul(x, zero);
    assert!(g.is_zero(e));
    assert_eq!(g.add(x, zero), x);
    let nine = g.number(9.0);
    let root = g.call(Function::Sqrt, nine);
    assert_eq!(g.as_number(root), Some(3.0));
    let quarter = g.number(4.0);
    let quarter = g.call(Function::RecipOrZero, quarter);
    assert_eq!(g.as_number(quarter), Some(0.25));
    let recip = g.call(Function::RecipOrZero, zero);
    assert!(g.is_zero(recip));
    let (sin, cos) = (g.call(Function::Sin, zero), g.call(Function::Cos, zero));
    assert_eq!((g.as_number(sin), g.as_number(cos)), (Some(0.0), Some(1.0)));
}

#[test]
fn inputs_are_those_that_are_left() {
    let (mut g, [a, b, _, x]) = inputs();
    let ab = g.add(a, b);
    let e = g.sub(ab, a);
    let e = g.mul(x, e);
    let names: Vec<_> = g.inputs(e).into_iter().map(|s| g.name(s)).collect();
    assert_eq!(names, ["b", "x"]);
}
