//! Tests printed code: the same values as direct evaluation, exactly the counted operations, and
//! the text.

use pfaff_symbolic::{Expr, Function, Graph, Printer, Program, Scalar};
use proptest::prelude::*;

use crate::config;
use crate::interpreter::{self, Run};
use crate::running::{Bounded, Running};
use crate::tree::{INPUTS, Order, graph, input_of, points, trees};

proptest! {
    #![proptest_config(config())]

    #[test]
    fn printed_code_computes_what_evaluation_computes(
        first in trees(), second in trees(), at in points(),
        scalar in prop::sample::select(vec![Scalar::F64, Scalar::Generic]),
    ) {
        let mut g = graph();
        let outputs = [first, second].map(|t| t.build(&mut g, Order::Written));
        let program = Program::new(&g, &outputs);
        let names = [(outputs[0], "first".to_owned())];
        let text = interpreter::text(Printer::new(&g, &program, scalar, &names).print());
        let inputs: Vec<_> = INPUTS.into_iter().zip(at).collect();
        let run = interpreter::run(&text, scalar, &inputs);
        let run = run.map_err(|e| TestCaseError::fail(format!("{e} in\n{text}")))?;

        prop_assert_eq!(run.counts, program.counts(), "{}", text);
        let inputs = at.map(|x| Running::input(x, 0.0));
        for (output, printed) in outputs.into_iter().zip(run.outputs) {
            let direct = g.evaluate(output, &|s| input_of(&inputs, g.name(s))).value();
            prop_assume!(direct.error.is_finite());
            // The same operations in another order have the same error bound.
            let printed = Bounded { value: printed, ..direct };
            prop_assert!(printed.agrees(direct), "{printed:?} instead of {direct:?} in\n{text}");
        }
    }
}

/// Returns the text of one output without `let`.
fn expression(g: &Graph, e: Expr) -> String {
    let program = Program::new(g, &[e]);
    let (statements, outputs) = Printer::new(g, &program, Scalar::F64, &[]).print();
    assert!(statements.is_empty(), "{statements:?}");
    let text = interpreter::text((statements, outputs));
    let (_, array) = text.split_once('[').expect("text() makes an array");
    let (array, _) = array.split_once(']').expect("text() makes an array");
    array.to_owned()
}

fn code(g: &Graph, outputs: &[Expr], scalar: Scalar, names: &[(Expr, &str)]) -> String {
    let program = Program::new(g, outputs);
    let names: Vec<_> = names.iter().map(|(e, n)| (*e, (*n).to_owned())).collect();
    interpreter::text(Printer::new(g, &program, scalar, &names).print())
}

fn abc() -> (Graph, [Expr; 3]) {
    let mut g = Graph::new();
    let inputs = ["a", "b", "c"].map(|name| g.symbol(name));
    (g, inputs)
}

#[test]
fn a_difference_on_the_right_keeps_its_parentheses() {
    let (mut g, [a, b, c]) = abc();
    let right = g.sub(b, c);
    let e = g.sub(a, right);
    assert_eq!(expression(&g, e), "a - (b - c)");
    let e = g.add(a, right);
    assert_eq!(expression(&g, e), "a + (b - c)");
}

#[test]
fn a_denominator_keeps_its_parentheses() {
    let (mut g, [a, b, c]) = abc();
    let bc = g.mul(b, c);
    let e = g.div(a, bc);
    assert_eq!(expression(&g, e), "a / (b * c)");
    let one = g.number(1.0);
    let e = g.div(one, a);
    assert_eq!(expression(&g, e), "1.0 / a");
}

#[test]
fn a_sum_below_a_sign_keeps_its_parentheses() {
    let (mut g, [a, b, c]) = abc();
    let sum = g.add(a, b);
    let e = g.neg(sum);
    assert_eq!(expression(&g, e), "-(a + b)");
    let product = g.mul(a, b);
    let e = g.neg(product);
    assert_eq!(expression(&g, e), "-(a * b)");
    let e = g.neg(c);
    assert_eq!(expression(&g, e), "-c");
}

#[test]
fn a_sum_in_a_product_keeps_its_parentheses() {
    let (mut g, [a, b, c]) = abc();
    let sum = g.add(b, c);
    let e = g.mul(a, sum);
    assert_eq!(expression(&g, e), "a * (b + c)");
}

#[test]
fn products_and_chains_need_no_parentheses() {
    let (mut g, [a, b, c]) = abc();
    let e = g.product(1.0, &[(a, 1), (b, 1), (c, 1)]);
    assert_eq!(expression(&g, e), "a * b * c");
    let ab = g.mul(a, b);
    let e = g.sum(&[(1.0, a), (-1.0, b), (-2.0, c)]);
    assert_eq!(expression(&g, e), "a - b - 2.0 * c");
    let e = g.sub(c, ab);
    assert_eq!(expression(&g, e), "c - a * b");
}

#[test]
fn a_function_is_a_method() {
    let (mut g, [a, b, _]) = abc();
    let sum = g.add(a, b);
    let e = g.call(Function::Sqrt, sum);
    assert_eq!(expression(&g, e), "(a + b).sqrt()");
    let minus_a = g.neg(a);
    let e = g.call(Function::Sin, minus_a);
    assert_eq!(expression(&g, e), "(-a).sin()");
    let e = g.call(Function::Cos, a);
    assert_eq!(expression(&g, e), "a.cos()");
}

#[test]
fn a_function_of_a_constant_has_a_definite_type() {
    // `1.0.sin()` does not compile (E0689).
    let (mut g, [a, ..]) = abc();
    let arguments = [1.0, -1.0].map(|x| g.number(x));
    let outputs = arguments.map(|x| g.call(Function::Cos, x));
    let scaled = g.mul(a, outputs[0]);
    for scalar in [Scalar::F64, Scalar::Generic] {
        let text = code(&g, &[outputs[0], outputs[1], scaled], scalar, &[]);
        let run = interpreter::run(&text, scalar, &[("a", 2.0)]).expect(&text);
        let cos = 1.0_f64.cos();
        assert_eq!(run.outputs, [cos, cos, 2.0 * cos], "{text}");
    }
    assert_eq!(expression(&g, outputs[1]), "f64::cos(-1.0)");
}

#[test]
fn constant_outputs_are_literals() {
    let (mut g, [a, ..]) = abc();
    let outputs = [0.0, -1.5, 0.1].map(|x| g.number(x));
    let f64_text = code(&g, &outputs, Scalar::F64, &[(a, "unused")]);
    assert_eq!(f64_text, "fn f() {\n    [0.0, -1.5, 0.1]\n}\n");
    let generic = code(&g, &outputs, Scalar::Generic, &[]);
    assert_eq!(
        generic,
        "fn f() {\n    [T::from(0.0), T::from(-1.5), T::from(0.1)]\n}\n"
    );
}

#[test]
fn constants_read_back_as_the_same_bits() {
    let mut g = Graph::new();
    let values = [
        1.0 / 3.0,
        1e-300,
        1e300,
        f64::MIN_POSITIVE / 4.0,
        -0.1 - 0.2,
    ];
    let outputs = values.map(|x| g.number(x));
    for scalar in [Scalar::F64, Scalar::Generic] {
        let text = code(&g, &outputs, scalar, &[]);
        let run = interpreter::run(&text, scalar, &[]).expect(&text);
        assert_eq!(run.outputs, values, "{text}");
    }
}

#[test]
fn constants_that_are_not_finite_are_printed_by_name() {
    let mut g = Graph::new();
    let outputs = [f64::INFINITY, f64::NEG_INFINITY, f64::NAN].map(|x| g.number(x));
    for scalar in [Scalar::F64, Scalar::Generic] {
        let text = code(&g, &outputs, scalar, &[]);
        let run = interpreter::run(&text, scalar, &[]).expect(&text);
        assert_eq!(
            run.outputs[..2],
            [f64::INFINITY, f64::NEG_INFINITY],
            "{text}"
        );
        assert!(run.outputs[2].is_nan(), "{text}");
    }
}

#[test]
fn an_input_nobody_uses_is_not_mentioned() {
    let (mut g, [a, b, _]) = abc();
    let e = g.add(a, b);
    let e = g.sub(e, a);
    assert_eq!(code(&g, &[e], Scalar::F64, &[]), "fn f() {\n    [b]\n}\n");
}

#[test]
fn an_output_given_twice_is_computed_once() {
    let (mut g, [a, b, _]) = abc();
    let e = g.add(a, b);
    let text = code(&g, &[e, e], Scalar::F64, &[]);
    assert_eq!(text, "fn f() {\n    let t0 = a + b;\n    [t0, t0]\n}\n");
}

#[test]
fn names_appear_where_their_expression_is_part_of_another() {
    let (mut g, [a, b, c]) = abc();
    let arm = g.mul(a, b);
    let e = g.add(arm, c);
    let named = code(&g, &[e], Scalar::F64, &[(arm, "arm"), (e, "result")]);
    assert_eq!(named, "fn f() {\n    let arm = a * b;\n    [c + arm]\n}\n");
}

#[test]
fn temporaries_hide_no_input_and_no_name() {
    // Inputs may be called t0, and a given name may equal that of an input or be given twice.
    let mut g = Graph::new();
    let (t0, x) = (g.symbol("t0"), g.symbol("x"));
    let square = g.mul(x, x);
    let cube = g.product(1.0, &[(x, 3)]);
    let sine = g.call(Function::Sin, x);
    let cosine = g.call(Function::Cos, x);
    let outputs = [
        g.sum(&[(1.0, square), (1.0, t0)]),
        g.mul(cube, t0),
        g.sum(&[(1.0, sine), (1.0, x)]),
        g.mul(sine, cosine),
        g.mul(cosine, t0),
    ];
    let names = [(sine, "x"), (cube, "t1"), (cosine, "t1")];
    let text = code(&g, &outputs, Scalar::F64, &names);
    let run = interpreter::run(&text, Scalar::F64, &[("t0", 5.0), ("x", 2.0)]).expect(&text);
    let (s, c) = (2.0_f64.sin(), 2.0_f64.cos());
    let expected = Run {
        outputs: vec![9.0, 40.0, s + 2.0, s * c, c * 5.0],
        counts: Program::new(&g, &outputs).counts(),
    };
    assert_eq!(run, expected, "{text}");
}
