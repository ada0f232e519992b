//! Compares derivatives with dual numbers, and derivations with a closed form.

use pfaff_symbolic::{Derivation, Function, Graph};
use proptest::prelude::*;

use crate::config;
use crate::running::Running;
use crate::tree::{INPUTS, Order, graph, input_of, points, trees};

/// A point is well-conditioned if the bound of the rounding errors is at most this fraction of the
/// derivative.
const RELATIVE: f64 = 1e-12;

proptest! {
    #![proptest_config(config())]

    #[test]
    fn partial_derivatives_are_those_of_dual_numbers(
        tree in trees(), at in points(), by in 0..INPUTS.len(),
    ) {
        let mut g = graph();
        let e = tree.build(&mut g, Order::Written);
        let x = g.symbol(INPUTS[by]);
        let derivative = Derivation::partial(&mut g, x).apply(&mut g, e);

        let seeded: [Running; 3] =
            std::array::from_fn(|k| Running::input(at[k], if k == by { 1.0 } else { 0.0 }));
        let dual = tree.evaluate(&seeded).slope();
        let ours = g.evaluate(derivative, &|s| input_of(&seeded, g.name(s))).value();

        let tolerance = ours.tolerance(dual);
        prop_assume!(tolerance.is_finite());
        prop_assert!(ours.agrees(dual), "{ours:?} instead of {dual:?}");
        // The rest is a test of relative accuracy; too many ill-conditioned points make the test
        // fail. If terms cancel to zero there is no relative accuracy but only rounding, which was
        // checked above.
        if dual.value != 0.0 {
            prop_assume!(tolerance <= RELATIVE * dual.value.abs());
            prop_assert!((ours.value - dual.value).abs() <= RELATIVE * dual.value.abs());
        }
    }

    #[test]
    fn building_keeps_the_value(tree in trees(), at in points()) {
        let mut g = graph();
        let e = tree.build(&mut g, Order::Written);
        let inputs = at.map(|x| Running::input(x, 0.0));
        let written = tree.evaluate(&inputs).value();
        let ours = g.evaluate(e, &|s| input_of(&inputs, g.name(s))).value();
        prop_assume!(ours.tolerance(written).is_finite());
        prop_assert!(ours.agrees(written), "{ours:?} instead of {written:?}");
    }

    #[test]
    fn partial_derivatives_commute(tree in trees(), at in points()) {
        let mut g = graph();
        let e = tree.build(&mut g, Order::Written);
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let (by_x, by_y) = (Derivation::partial(&mut g, x), Derivation::partial(&mut g, y));
        let inner = by_x.apply(&mut g, e);
        let xy = by_y.apply(&mut g, inner);
        let inner = by_y.apply(&mut g, e);
        let yx = by_x.apply(&mut g, inner);
        let inputs = at.map(|x| Running::input(x, 0.0));
        let [xy, yx] = [xy, yx]
            .map(|e| g.evaluate(e, &|s| input_of(&inputs, g.name(s))).value());
        prop_assume!(xy.tolerance(yx).is_finite());
        prop_assert!(xy.agrees(yx), "{xy:?} and {yx:?}");
    }
}

/// A planar rotation by φ has `D(cos φ) = −sin φ`, `D(sin φ) = cos φ`.
fn turn(g: &mut Graph) -> Derivation {
    let (cos, sin) = (g.symbol("cos"), g.symbol("sin"));
    let minus_sin = g.neg(sin);
    Derivation::new(g, &[(cos, minus_sin), (sin, cos)])
}

#[test]
fn turning_twice_gives_minus_the_original() {
    let mut g = Graph::new();
    let turn = turn(&mut g);
    let (cos, sin) = (g.symbol("cos"), g.symbol("sin"));
    let (a, b, c) = (g.symbol("a"), g.symbol("b"), g.symbol("c"));
    // The expression is scaled and nested, as in (a − c)·cos − 3·b·sin.
    let arm = g.sub(a, c);
    let (arm_cos, b_sin) = (g.mul(arm, cos), g.mul(b, sin));
    let x = g.sum(&[(1.0, arm_cos), (-3.0, b_sin)]);
    let once = turn.apply(&mut g, x);
    let twice = turn.apply(&mut g, once);
    let minus_x = g.neg(x);
    assert_ne!(once, minus_x);
    assert_eq!(twice, minus_x);
}

#[test]
fn turning_keeps_the_square_of_the_length() {
    let mut g = Graph::new();
    let turn = turn(&mut g);
    let (cos, sin) = (g.symbol("cos"), g.symbol("sin"));
    let (a, b) = (g.symbol("a"), g.symbol("b"));
    let (a_cos, b_sin) = (g.mul(a, cos), g.mul(b, sin));
    let (a_sin, b_cos) = (g.mul(a, sin), g.mul(b, cos));
    let (x, y) = (g.sub(a_cos, b_sin), g.add(a_sin, b_cos));
    let (xx, yy) = (g.mul(x, x), g.mul(y, y));
    let square = g.add(xx, yy);
    let d = turn.apply(&mut g, square);
    assert!(g.is_zero(d), "{:?}", g.node(d));
}

#[test]
fn inputs_without_an_image_are_constants() {
    let mut g = Graph::new();
    let (x, a) = (g.symbol("x"), g.symbol("a"));
    let by_x = Derivation::partial(&mut g, x);
    let d = by_x.apply(&mut g, a);
    assert!(g.is_zero(d));
    let ax = g.mul(a, x);
    assert_eq!(by_x.apply(&mut g, ax), a);
}

#[test]
fn derivative_of_a_length_is_the_direction() {
    let mut g = Graph::new();
    let (x, y) = (g.symbol("x"), g.symbol("y"));
    let square = g.product(1.0, &[(x, 2)]);
    let other = g.product(1.0, &[(y, 2)]);
    let sum = g.add(square, other);
    let length = g.call(Function::Sqrt, sum);
    let d = Derivation::partial(&mut g, x).apply(&mut g, length);
    let recip = g.call(Function::RecipOrZero, length);
    assert_eq!(d, g.mul(x, recip));
    // The value is zero if the length is zero.
    assert_eq!(g.evaluate(d, &|_| 0.0), 0.0);
}
