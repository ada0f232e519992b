//! Tests of names, of shapes, and of the inputs on which each part of a definition may depend.

use super::Body;
use crate::Kind;
use crate::testing::{State, assert_close, constraint, error, model};

/// Returns the text of a constraint on two bodies with points, a direction, numbers and functions.
fn joint(items: &str) -> String {
    format!(
        "plane A(i, j) {{ /// Doc.
            params {{ s: Point in i, p: Point in j, n: Direction in j, g: GroundLine, l: Length, f: Function<Length> }}
            let all = dot(point(i, s), point(j, p)) + dot(direction(j, n), along(g)) + dot(start(g), start(g)) + l + f;
            {items}
        }}"
    )
}

fn with_phi(phi: &str) -> String {
    joint(&format!("rows: [x]; phi: [all + {phi}]; place: origin(i);"))
}

fn state() -> State {
    State {
        pose: vec![[0.1, 0.2, 0.7], [0.3, -0.5, -1.9]],
        twist: vec![[1.0, 2.0, 3.0], [-1.0, 0.5, -2.0]],
        parameters: vec![
            ("s[0]", 0.4),
            ("s[1]", -0.6),
            ("p[0]", 1.1),
            ("p[1]", 0.8),
            ("n.xy()[0]", 0.6),
            ("n.xy()[1]", 0.8),
            ("g.start()[0]", 5.0),
            ("g.start()[1]", 7.0),
            ("g.along().xy()[0]", 0.0),
            ("g.along().xy()[1]", 1.0),
            ("l", 2.5),
        ],
        f: vec![[0.25, 0.5, 0.75]],
    }
}

/// Returns the value of an expression of the language at [`state`].
fn value(expression: &str) -> f64 {
    let (model, body, _) = constraint(&with_phi(expression));
    let (base_model, base, _) = constraint(&with_phi("0.0"));
    state().value(&model, body.rows[0]) - state().value(&base_model, base.rows[0])
}

#[test]
fn functions_mean_what_they_say() {
    let (sin, cos) = 0.7_f64.sin_cos();
    let arm = [cos * 0.4 + sin * 0.6, sin * 0.4 - cos * 0.6];
    let (sin_j, cos_j) = (-1.9_f64).sin_cos();
    let n = [cos_j * 0.6 - sin_j * 0.8, sin_j * 0.6 + cos_j * 0.8];
    let cases = [
        ("origin(i)[0]", 0.1),
        ("origin(j)[1]", -0.5),
        ("angle(j)", -1.9),
        ("point(i, s)[0]", 0.1 + arm[0]),
        ("point(i, s)[1]", 0.2 + arm[1]),
        ("direction(j, n)[0]", n[0]),
        ("perp(direction(j, n))[0]", -n[1]),
        ("perp(direction(j, n))[1]", n[0]),
        ("local(i, point(i, s) - origin(i))[1]", -0.6),
        ("local(j, direction(j, n))[0]", 0.6),
        ("vector(i, [2.0 * l, 1])[0]", 5.0 * cos - sin),
        ("vector(i, local(i, origin(j)))[0]", 0.3),
        // Components in a frame have the same products and length as the vector itself.
        ("dot(local(i, origin(j)), local(i, origin(j)))", 0.34),
        (
            "dot(local(i, origin(j)), direction(j, n))",
            0.3 * n[0] - 0.5 * n[1],
        ),
        ("perp(local(i, origin(j)))[0]", 0.5),
        ("start(g)[1]", 7.0),
        ("along(g)[1]", 1.0),
        (
            "dot(direction(j, n), origin(j) - origin(i))",
            0.2 * n[0] - 0.7 * n[1],
        ),
        ("(origin(j) / 2.0)[0]", 0.15),
        ("(l * origin(j))[1]", -1.25),
        ("(-origin(j))[1]", 0.5),
        ("-l + 3 - 1e1", -9.5),
        ("f", 0.25),
    ];
    for (expression, expected) in cases {
        // `value` is a difference of terms of order 10².
        assert!(
            (value(expression) - expected).abs() < 1e-12,
            "{expression}: {}",
            value(expression)
        );
    }
}

#[test]
fn velocities_are_those_of_the_bodies() {
    let (model, body, _) = constraint(&joint(
        "rows: [x, y, t, l, n, f];
         psi: [velocity(point(i, s)), rate(angle(j)), velocity(origin(j))[0], rate(perp(direction(j, n)))[0],
               all * rate(angle(i)) + rate(f)];
         place: origin(i);",
    ));
    let (sin, cos) = 0.7_f64.sin_cos();
    let arm = [cos * 0.4 + sin * 0.6, sin * 0.4 - cos * 0.6];
    let (sin_j, cos_j) = (-1.9_f64).sin_cos();
    let n = [cos_j * 0.6 - sin_j * 0.8, sin_j * 0.6 + cos_j * 0.8];
    let found = state().values(&model, &body.rows[..5]);
    // v + ω·Ω·R·s; d(Ω·n)/dt = ω·Ω²·n = −ω·n
    assert_close(
        &found,
        &[
            1.0 - 3.0 * arm[1],
            2.0 + 3.0 * arm[0],
            -2.0,
            -1.0,
            2.0 * n[0],
        ],
    );
    let all = state().value(&model, body.rows[5]);
    let (base_model, base, _) = constraint(&with_phi("0.0"));
    let all_0 = state().value(&base_model, base.rows[0]);
    assert!((all - (3.0 * all_0 + 0.5)).abs() < 1e-12);
}

#[test]
fn shapes_are_checked() {
    let cases = [
        ("zz", "unknown name `zz`"),
        ("i", "it is a body slot"),
        ("pont(i, s)[0]", "did you mean `point`?"),
        ("foo(1)", "unknown function `foo`; known are"),
        ("dot(l, origin(i))", "expected a vector, found a scalar"),
        ("norm(l)", "expected a vector, found a scalar"),
        ("perp(1.0)", "expected a vector, found a scalar"),
        ("velocity(l)", "expected a vector, found a scalar"),
        ("start(origin(i))", "expected a line, found a vector"),
        (
            "point(i, n)[0]",
            "expected a `Point` parameter, found a direction parameter",
        ),
        (
            "direction(i, s)[0]",
            "expected a `Direction` parameter, found a point parameter",
        ),
        (
            "point(j, s)[0]",
            "given in the frame of body `i`, and used in the frame of body `j`",
        ),
        (
            "vector(j, local(i, origin(j)))[0]",
            "in the frame of body `i`, and used",
        ),
        (
            "vector(i, [1.0])[0]",
            "expected two components, found a list",
        ),
        (
            "point(k, s)[0]",
            "`k` is no body slot; the slots are `i`, `j`",
        ),
        ("point(l + 1, s)[0]", "expected a body slot"),
        ("point(i)[0]", "`point` takes 2 arguments, found 1"),
        ("angle(i, j)", "`angle` takes 1 argument, found 2"),
        ("origin(i)", "`+` does not apply to a scalar and a vector"),
        ("s", "is `point(i, s)`"),
        ("n", "is `direction(i, n)`"),
        ("g", "`start(line)`"),
        ("origin(i)[2]", "there are 2 entries, counted from 0"),
        ("origin(i)[l]", "expected an index"),
        (
            "l[0]",
            "expected a list, a vector or components in a frame, found a scalar",
        ),
        ("(origin(i) * origin(j))", "is `dot(a, b)`"),
        ("l % 2.0", "`%` does not apply to a scalar and a scalar"),
        ("(!l)", "unknown operator"),
        ("l / 0", "division by zero"),
        ("(origin(i) / (l - l))[0]", "division by zero"),
        ("\"a\"", "expected a number"),
        ("1.0f32", "numbers have no suffix"),
        ("1e999", "out of bounds"),
        ("1e-300", "out of bounds"),
        ("1e40 * 1e40", "out of bounds"),
        ("if l { 1 } else { 2 }", "`if` is a word of Rust"),
        ("std::f64::consts::PI", "names have no `::`"),
        ("(l; l)", "expected"),
        ("(l, l)", "expected an expression of numbers"),
    ];
    for (expression, message) in cases {
        let found = error(Kind::Constraint, &with_phi(expression));
        assert!(found.contains(message), "{expression}: {found}");
    }
}

#[test]
fn each_part_depends_on_what_it_may() {
    let cases = [
        (
            "rows: [x]; phi: all + norm(origin(i)); place: origin(i);",
            "no quotient and no `norm`",
        ),
        (
            "rows: [x]; phi: all / l; place: origin(i);",
            "no quotient and no `norm`",
        ),
        (
            "rows: [x]; phi: rate(all); place: origin(i);",
            "a constraint on the level of velocities is `psi`",
        ),
        (
            "rows: [x]; phi: all + rate(f); place: origin(i);",
            "`phi` takes a function of time, not its rate",
        ),
        (
            "rows: [x]; psi: all; place: origin(i);",
            "a constraint on the level of positions is `phi`",
        ),
        (
            "rows: [x]; psi: rate(all) * rate(angle(i)); place: origin(i);",
            "not linear in the velocities",
        ),
        (
            "rows: [x]; psi: rate(all) + rate(rate(f)); place: origin(i);",
            "`psi` takes a function of time and its rate",
        ),
        (
            "rows: [x]; psi: rate(rate(all)); place: origin(i);",
            "contains a velocity already",
        ),
        (
            "rows: [x]; psi: rate(rate(rate(f))) + all; place: origin(i);",
            "not a third",
        ),
        (
            "rows: [x]; phi: all; place: velocity(origin(i));",
            "a place depends on positions and parameters",
        ),
        (
            "rows: [x]; phi: all; place: f * origin(i);",
            "not on functions of time",
        ),
        (
            "rows: [x]; phi: all; place: l;",
            "expected a vector, found a scalar",
        ),
        (
            "rows: [x]; phi: all; place: origin(i); component N: velocity(origin(i));",
            "not on velocities",
        ),
        (
            "rows: [x]; phi: all; place: origin(i); measure m: rate(angle(i));",
            "a measure is a relative position",
        ),
        (
            "rows: [x]; phi: all; place: origin(i); measure m: f * angle(i);",
            "not on functions of time",
        ),
        (
            "rows: [x]; phi: all; place: origin(i); measure m: norm(origin(i));",
            "no quotient",
        ),
        (
            "rows: [x]; phi: all; place: origin(i); measure l, kept;",
            "no number of `initial` that depends on the start is called `l`",
        ),
        (
            "initial { a: Angle = angle(i), b: Angle = a } rows: [x]; phi: all + b; place: origin(i); measure a, kept;",
            "no row contains `a`",
        ),
        (
            "initial { a: Angle = angle(i) } rows: [x]; psi: rate(all) + a; place: origin(i); measure a, kept;",
            "only `phi` keeps",
        ),
        (
            "initial { a: Length = f } rows: [x]; phi: all + a; place: origin(i);",
            "not on functions of time",
        ),
        (
            "initial { a: Length = rate(angle(i)) } rows: [x]; phi: all + a; place: origin(i);",
            "velocities are not known",
        ),
        (
            "initial { a: Vector in i = local(j, origin(i)) } rows: [x]; phi: all; place: vector(i, a);",
            "frame of body `j`",
        ),
        (
            "initial { a: Vector in i = origin(i) } rows: [x]; phi: all; place: vector(i, a);",
            "`local(i, …)`",
        ),
        (
            "initial { a: Vector in k = local(i, origin(i)) } rows: [x]; phi: all; place: vector(i, a);",
            "`k` is no body slot",
        ),
        (
            "require \"w\": rate(angle(i)) > 0; rows: [x]; phi: all; place: origin(i);",
            "velocities are not known",
        ),
        (
            "require \"w\": f > 0; rows: [x]; phi: all; place: origin(i);",
            "not on functions of time",
        ),
        (
            "require \"w\": l; rows: [x]; phi: all; place: origin(i);",
            "expected a comparison",
        ),
        (
            "require \"w\": l + 1; rows: [x]; phi: all; place: origin(i);",
            "expected a comparison",
        ),
        (
            "let b = l; rows: [x]; phi: all; place: origin(i);",
            "`b` is never used",
        ),
        (
            "let l = 1; rows: [x]; phi: all; place: origin(i);",
            "`l` is defined twice",
        ),
        (
            "let i = 1; rows: [x]; phi: all + i; place: origin(i);",
            "`i` is a body slot already",
        ),
        (
            "rows: [x, y, z]; phi: [all, origin(i)[0]]; place: origin(i);",
            "`rows` names 3 rows, but the equation has 2 rows",
        ),
        (
            "let a = l * l * l * l; let b = a * a * a * a; let c = b * b * b; rows: [x]; phi: all + c; place: origin(i);",
            "the power 48 is too high",
        ),
    ];
    for (items, message) in cases {
        let found = error(Kind::Constraint, &joint(items));
        assert!(found.contains(message), "{items}: {found}");
    }
}

#[test]
fn fields_do_not_collide() {
    let cases = [
        (
            "params { a: Length = 1.0, a_0: Length }",
            "would be called `a_0`, which is taken",
        ),
        (
            "params { a: Length = 1.0 } initial { a_0: Length = 2.0 }",
            "would be called `a_0`, which is taken",
        ),
        (
            "initial { measure_0: Length = 2.0 }",
            "would be called `measure_0`, which is taken",
        ),
        (
            "params { motion: Length }",
            "`motion` is a name that generated code uses",
        ),
        (
            "params { a: Point in i = 3.0 }",
            "only a single number may have a default",
        ),
    ];
    for (items, message) in cases {
        let text = format!(
            "plane A(i) {{ /// Doc.\n {items} rows: [x]; phi: angle(i); place: origin(i); }}"
        );
        let found = error(Kind::Constraint, &text);
        assert!(found.contains(message), "{items}: {found}");
    }
    let direction = "plane Pose(i) { /// Doc.\n rows: [x]; phi: angle(i); place: origin(i); }";
    assert!(
        error(Kind::Constraint, direction).contains("`Pose` is a type that generated code uses")
    );
}

/// A force law may contain a function of time and both of its derivatives.
#[test]
fn laws_take_rates() {
    let text = "plane A(i) { /// Doc.
        params { f: Function<Torque> }
        force: f + rate(f) + rate(rate(f)) on angle(i);
    }";
    let model = model(Kind::Force, text).unwrap_or_else(|e| panic!("{e}"));
    let Body::Force(terms) = &model.body else {
        panic!("a force")
    };
    assert_close(&[state().value(&model, terms[0].0)], &[0.25 + 0.5 + 0.75]);
}

/// Returns the text of a constraint in space with points, axes and a plane.
fn spatial(items: &str) -> String {
    format!(
        "space A(i, j) {{ /// Doc.
            params {{ s: Point in i, p: Point in j, a: Axes in i, b: Axes in j like a, g: GroundPlane }}
            let all = dot(point(i, s) - start(g), direction(j, b[2])) + dot(normal(g), point(j, p))
                + dot(direction(i, a[0]), direction(i, a[1]));
            {items}
        }}"
    )
}

#[test]
fn what_belongs_to_one_space_is_refused_in_the_other() {
    let plane = |phi: &str| error(Kind::Constraint, &with_phi(phi));
    let space = |phi: &str| {
        let items = format!("rows: [x]; phi: all + {phi}; place: origin(i);");
        error(Kind::Constraint, &spatial(&items))
    };
    let cases = [
        (
            plane("dot(cross(origin(i), origin(j)), origin(i))"),
            "`cross` is a function of a `space` definition",
        ),
        (
            plane("dot(spin(i), origin(i))"),
            "`spin` is a function of a `space` definition",
        ),
        (
            space("dot(perp(origin(i)), origin(j))"),
            "`perp` is a function of a `plane` definition",
        ),
        (space("angle(i)"), "`angle` takes 2 arguments, found 1"),
        (
            space("angle(a, b)"),
            "an angle in space, which only a measure can be",
        ),
        (
            space("a"),
            "`+` does not apply to a scalar and a parameter of axes",
        ),
        (
            space("direction(i, b[0])"),
            "given in the frame of body `j`, and used in the frame of body `i`",
        ),
        (space("direction(i, a[3])"), "there are 3 entries"),
        (
            space("dot(origin(i), vector(ground, [1.0, 2.0]))"),
            "expected three components",
        ),
        (
            space("dot(spin(i), origin(i))"),
            "`phi` depends on a velocity",
        ),
    ];
    for (found, expected) in cases {
        assert!(found.contains(expected), "{found:?}, expected {expected:?}");
    }
    let kinds = [
        (
            "plane A(i) { /// D.\n params { a: Axes in i } rows: [x]; phi: a; place: origin(i); }",
            "`Axes` is a kind of a `space` definition",
        ),
        (
            "space A(i) { /// D.\n params { a: GroundLine } rows: [x]; phi: a; place: origin(i); }",
            "`GroundLine` is a kind of a `plane` definition",
        ),
        (
            "space A(i) { /// D.\n params { a: Axes in i like b } rows: [x]; phi: a; place: origin(i); }",
            "`b` is no `Axes` parameter before `a`",
        ),
    ];
    for (text, expected) in kinds {
        let found = error(Kind::Constraint, text);
        assert!(found.contains(expected), "{found:?}, expected {expected:?}");
    }
}
