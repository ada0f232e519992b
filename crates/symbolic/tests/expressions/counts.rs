//! Compares operation counts of small programs with counts by hand.

use pfaff_symbolic::{Counts, Expr, Function, Graph, Op, Program};

fn counts(g: &Graph, outputs: &[Expr]) -> Counts {
    Program::new(g, outputs).counts()
}

#[test]
fn a_shared_square_is_counted_once() {
    // The program is x²·y and x²·z, with the products x·x, ·y, ·z.
    let mut g = Graph::new();
    let (x, y, z) = (g.symbol("x"), g.symbol("y"), g.symbol("z"));
    let outputs = [y, z].map(|e| g.product(1.0, &[(x, 2), (e, 1)]));
    let expected = Counts {
        mul: 3,
        ..Counts::default()
    };
    assert_eq!(counts(&g, &outputs), expected);
}

#[test]
fn a_cube_uses_the_square() {
    let mut g = Graph::new();
    let x = g.symbol("x");
    let outputs = [2, 3].map(|n| g.product(1.0, &[(x, n)]));
    assert_eq!(counts(&g, &outputs).mul, 2);
}

#[test]
fn a_point_of_a_turned_body() {
    // The program is [x + (a·cos − b·sin), y + (a·sin + b·cos)].
    let mut g = Graph::new();
    let [x, y, cos, sin, a, b] = ["x", "y", "cos", "sin", "a", "b"].map(|name| g.symbol(name));
    let (a_cos, b_sin) = (g.mul(a, cos), g.mul(b, sin));
    let (a_sin, b_cos) = (g.mul(a, sin), g.mul(b, cos));
    let (arm_x, arm_y) = (g.sub(a_cos, b_sin), g.add(a_sin, b_cos));
    let outputs = [g.add(x, arm_x), g.add(y, arm_y)];
    let expected = Counts {
        mul: 4,
        add: 4,
        ..Counts::default()
    };
    assert_eq!(counts(&g, &outputs), expected);
}

#[test]
fn a_unit_vector_shares_its_length() {
    // The program is x/√(x² + y²), y/√(x² + y²).
    let mut g = Graph::new();
    let (x, y) = (g.symbol("x"), g.symbol("y"));
    let (xx, yy) = (g.mul(x, x), g.mul(y, y));
    let square = g.add(xx, yy);
    let length = g.call(Function::Sqrt, square);
    let outputs = [g.div(x, length), g.div(y, length)];
    let expected = Counts {
        mul: 2,
        add: 1,
        div: 2,
        call: 1,
        neg: 0,
    };
    assert_eq!(counts(&g, &outputs), expected);
    assert_eq!(expected.total(), 6);
    assert_eq!(expected.to_string(), "2 mul, 1 add, 2 div, 1 call");
}

#[test]
fn several_denominators_are_one_quotient() {
    // The program is a/(b·c).
    let mut g = Graph::new();
    let (a, b, c) = (g.symbol("a"), g.symbol("b"), g.symbol("c"));
    let e = g.product(1.0, &[(a, 1), (b, -1), (c, -1)]);
    assert_eq!(counts(&g, &[e]).to_string(), "1 mul, 1 div");
}

#[test]
fn a_sign_costs_one_operation_and_a_difference_none() {
    let mut g = Graph::new();
    let (a, b) = (g.symbol("a"), g.symbol("b"));
    let (difference, sum) = (g.sub(a, b), g.add(a, b));
    let minus_sum = g.neg(sum);
    assert_eq!(counts(&g, &[difference]).to_string(), "1 add");
    assert_eq!(counts(&g, &[minus_sum]).to_string(), "1 add, 1 neg");
}

#[test]
fn inputs_and_constants_are_free() {
    let mut g = Graph::new();
    let (x, two) = (g.symbol("x"), g.number(2.0));
    let free = counts(&g, &[x, two, x]);
    assert_eq!(free, Counts::default());
    assert_eq!(free.to_string(), "none");
    assert_eq!(counts(&g, &[]), Counts::default());
}

#[test]
fn operands_come_before_their_uses() {
    let mut g = Graph::new();
    let (x, y) = (g.symbol("x"), g.symbol("y"));
    let sin = g.call(Function::Sin, x);
    let product = g.mul(sin, y);
    let e = g.sum(&[(2.0, product), (-1.0, y)]);
    let program = Program::new(&g, &[e, product]);
    for (k, op) in program.ops().iter().enumerate() {
        let operands = match *op {
            Op::Number(_) | Op::Input(_) => vec![],
            Op::Neg(a) | Op::Call(_, a) => vec![a],
            Op::Binary(_, a, b) => vec![a, b],
        };
        assert!(operands.iter().all(|v| v.index() < k), "{op:?} at {k}");
    }
    assert_eq!(program.value_of(product), Some(program.outputs()[1]));
    let absent = g.symbol("absent");
    assert_eq!(program.value_of(absent), None);
}
