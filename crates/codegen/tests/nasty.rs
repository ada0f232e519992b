//! For any tokens `expand` returns Rust code or an error: no panic, no endless loop, no stack
//! overflow.

use std::thread;

use pfaff_codegen::{Kind, expand};
use proc_macro2::{TokenStream, TokenTree};
use proptest::prelude::*;
use quote::quote;

/// Stack size of the compiler's main thread, in which macros run (RUST_MIN_STACK).
const STACK: usize = 8 << 20;

/// Expands the text as both kinds; the result is valid Rust or an error with a message.
fn expand_any(text: &str) {
    let Ok(body) = text.parse::<TokenStream>() else {
        return;
    };
    for kind in [Kind::Constraint, Kind::Force] {
        match expand(kind, body.clone(), &quote!(::joints), text) {
            Ok(all) => {
                let mut files = all.into_iter().map(|e| syn::parse2::<syn::File>(e.items));
                assert!(files.all(|file| file.is_ok()), "{text}");
            }
            Err(e) => assert!(!e.to_string().is_empty(), "{text}"),
        }
    }
}

fn on_a_compiler_stack(run: impl FnOnce() + Send + 'static) {
    let thread = thread::Builder::new()
        .stack_size(STACK)
        .spawn(run)
        .expect("a thread");
    if let Err(panic) = thread.join() {
        std::panic::resume_unwind(panic);
    }
}

fn joint(items: &str) -> String {
    format!("plane A(i, j) {{ #[doc = \"Doc.\"] {items} rows: [x]; place: origin(i); }}")
}

fn phi(phi: &str) -> String {
    joint(&format!("phi: {phi};"))
}

#[test]
fn inputs_from_bad_dreams() {
    on_a_compiler_stack(|| {
        let texts = [
            String::new(),
            ";".into(),
            "plane".into(),
            "plane A".into(),
            "plane A(".into(),
            "plane A(i)".into(),
            "plane A(i) { /// Doc.".into(),
            "plane A(i) { /// Doc.\n }".into(),
            "plane r#type(i) {}".into(),
            "plane A(r#type) {}".into(),
            "plane _(i) {}".into(),
            "plane A(_) {}".into(),
            "plane A(self) {}".into(),
            "plane Φ(φ) { #[doc = \"Doc.\"] rows: [θ]; phi: angle(φ); place: origin(φ); }".into(),
            phi("1e99999"),
            phi("1e-99999"),
            phi("0x10 * angle(i)"),
            phi("99999999999999999999999999999999999999999999999999999999999999999999 * angle(i)"),
            phi("1.0 / 0.0"),
            phi("0.0 / 0.0"),
            phi("angle(i) / (1 - 1)"),
            phi("norm(origin(i) - origin(i))"),
            phi("norm(vector(i, [0, 0]))"),
            phi("rate(norm(origin(i) - origin(i)))"),
            phi("[]"),
            phi("[[[[angle(i)]]]]"),
            phi("[angle(i)][0]"),
            phi("[angle(i)][99999999999999999999999]"),
            phi("angle(i)()"),
            phi("angle(angle)"),
            phi("(|x| x)(1)"),
            phi("{ return; }"),
            phi("unsafe { 1 }"),
            phi("a!()"),
            phi("angle(i)?"),
            phi("'x'"),
            phi("b\"x\""),
            phi("loop {}"),
            joint("let a = a; phi: angle(i) + a;"),
            joint(
                "params { t0: Length, arm_i_x: Length, cos_i: Length, r_i_x: Length } phi: t0 + arm_i_x + cos_i + r_i_x + angle(i);",
            ),
            joint("params { s_i: Point in i, s_i_x: Length } phi: s_i_x + point(i, s_i)[0];"),
            joint("params { None: Length } phi: None * angle(i);"),
            joint("let None = angle(i); phi: None * None;"),
            joint("let out = angle(i); let x = out * out; let T = x * out; phi: T * x;"),
            joint("initial { out: Length = angle(i) } phi: angle(j) - out;"),
            joint("params { reader: Length } phi: reader * angle(i);"),
            joint("phi: angle(i); measure _a: angle(i); measure a: angle(i);"),
            joint("variant a {} phi: a;"),
            joint("variant a { \"\": 1, \"b c\": angle(i) } phi: a;"),
            joint("variant angle { \"b\": angle(i), \"b--c-\": angle(j) } phi: angle;"),
            joint("variant i { \"b\": angle(i), \"c\": angle(j) } phi: i;"),
        ];
        for text in &texts {
            expand_any(text);
        }
    });
}

/// The test uses long and deep expressions of every kind that a recursive parser processes.
#[test]
fn long_and_deep_expressions() {
    on_a_compiler_stack(|| {
        for n in [10, 30, 100, 500, 5000] {
            for (head, piece, tail) in [
                ("angle(i)", " + angle(i)", ""),
                ("angle(i)", " * angle(j)", ""),
                ("angle(i)", " = 1", ""),
                ("", "- ", "1"),
                ("", "!", "1"),
                ("", "& ", "1"),
                ("", "* ", "1"),
                ("", "|x| ", "1"),
                ("", "|| ", "1"),
                ("", "return ", "1"),
                ("", "break ", "1"),
                ("", "move || ", "1"),
                ("", "if 1 {} else ", "{}"),
                ("", "let x = ", "1"),
                ("", ".. ", "1"),
                ("", "async move || ", "1"),
                ("1", " as f64", ""),
                ("1", "?", ""),
                ("1", ".a", ""),
                ("1", "(1)", ""),
                ("1", "[1]", ""),
                ("1", " && 1", ""),
                ("1", " == 1", ""),
                ("a", "::a", ""),
                ("a", "::<a", ""),
                ("1 as ", "&", "a"),
                ("1 < ", "a < ", "1"),
                ("", "a { b : ", "1"),
                ("1 as ", "fn() -> ", "a"),
            ] {
                expand_any(&phi(&format!("{head}{}{tail}", piece.repeat(n))));
            }
            for [open, close] in [
                ["(", ")"],
                ["[", "]"],
                ["{", "}"],
                ["dot(", ",1)"],
                ["norm(", ")"],
            ] {
                expand_any(&phi(&format!("{}1{}", open.repeat(n), close.repeat(n))));
            }
            let sums: String = (0..n)
                .map(|k| match k {
                    0 => "let a0 = angle(i);".to_owned(),
                    _ => format!("let a{k} = (a{0} + 1) * (a{0} + 2) - a{0};", k - 1),
                })
                .take(20)
                .collect();
            expand_any(&joint(&format!("{sums} phi: a{};", n.min(20) - 1)));
            let powers: String = (1..n.min(100))
                .map(|k| format!("let a{k} = a{0} * a{0};", k - 1))
                .collect();
            expand_any(&joint(&format!(
                "let a0 = angle(i); {powers} phi: a{};",
                n.min(100) - 1
            )));
        }
    });
}

const SHIPPED: [&str; 4] = [
    "plane Translational(i, j) {
        /// A point on a line.
        params { s_i: Point in i, s_j: Point in j, axis: Direction in i }
        let d = point(j, s_j) - point(i, s_i);
        initial { angle_0: Angle = angle(j) - angle(i) }
        rows: [normal, angle];
        phi: [dot(perp(direction(i, axis)), d), angle(j) - angle(i) - angle_0];
        measure displacement: dot(direction(i, axis), d);
        place: point(i, s_i);
    }",
    "plane KnifeEdge(i) {
        /// No velocity along a direction.
        params { s: Point in i, normal: Direction in i, f: Function<Velocity> }
        rows: [normal];
        psi: dot(direction(i, normal), velocity(point(i, s))) - f;
        component N: direction(i, normal);
        place: point(i, s);
    }",
    "plane Distance(i, j) {
        /// A distance.
        params { s_i: Point in i, s_j: Point in j }
        points apart;
        let d = point(j, s_j) - point(i, s_i);
        initial { length: Length = norm(d), half_inverse: PerLength = 0.5 / length, o: Vector in i = local(i, d) }
        require \"apart\": length > 0.0 && (length < 9 || length == 2);
        rows: [distance];
        phi: (dot(d, d) - length * length) * half_inverse + dot(d, vector(i, o));
        place: point(i, s_i);
    }",
    "plane SpringDamper(i, j) {
        /// A spring.
        params { s_i: Point in i, s_j: Point in j, k: [Stiffness, Damping], l0: Length = norm(point(j, s_j) - point(i, s_i)) }
        variant l { \"far\": norm(point(j, s_j) - point(i, s_i)), \"near\": angle(i) }
        force: -(k[0] * (l - l0) + k[1] * rate(l)) on l;
    }",
];

/// Lists the tokens one by one; brackets are two separate tokens.
fn flat(tokens: TokenStream, out: &mut Vec<String>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => {
                let text = TokenTree::Group(group.clone()).to_string();
                let mut ends = text.chars();
                let (open, close) = (ends.next(), ends.next_back());
                out.extend(open.map(String::from));
                flat(group.stream(), out);
                out.extend(close.map(String::from));
            }
            other => out.push(other.to_string()),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// Correct definitions with some tokens removed, doubled or replaced by tokens of other
    /// definitions.
    #[test]
    fn mutated_definitions(
        which in 0..SHIPPED.len(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..3_u8), 1..4),
    ) {
        let mut words = Vec::new();
        let mut all = Vec::new();
        for (k, text) in SHIPPED.iter().enumerate() {
            let tokens: TokenStream = text.parse().expect("tokens");
            flat(tokens.clone(), &mut all);
            if k == which {
                flat(tokens, &mut words);
            }
        }
        for (at, other, edit) in edits {
            let at = at.index(words.len());
            match edit {
                0 => drop(words.remove(at)),
                1 => words.insert(at, words[at].clone()),
                _ => words[at].clone_from(&all[other.index(all.len())]),
            }
        }
        expand_any(&words.join(" "));
    }
}
