//! Valid syntax, and the messages for invalid syntax. The compile-fail cases of `joint-macro` test
//! the positions of errors.

use super::{Definition, Kept, Kind, ParamKind, definition};

/// Returns the definition, or its first form.
fn parse(kind: Kind, text: &str) -> syn::Result<Definition> {
    let mut forms = definition(kind, text.parse()?)?;
    Ok(forms.remove(0))
}

fn error(kind: Kind, text: &str) -> String {
    match parse(kind, text) {
        Ok(_) => "(no error)".to_owned(),
        Err(e) => e.to_string(),
    }
}

/// Returns a constraint that is complete except for the given items.
fn joint(items: &str) -> String {
    format!("plane A(i, j) {{ /// Doc.\n {items} }}")
}

#[test]
fn every_item_arrives() {
    let d = parse(
        Kind::Constraint,
        &joint(
            "/// Second line.
             params {
                /// The point.
                p: Point in i, d: Direction in j, g: GroundLine, l: Length = 2.0, n: [Length, Angle],
                f: Function<Force>, h: [Function<Force>, Function<Torque>],
             }
             points apart;
             let a = 1.0;
             initial { b: Vector in j = x, c: PerLength = y, }
             require \"words\": a > b;
             rows: [r, s,];
             phi: [a, b];
             measure m: a;
             place: q;
             component N: z;
             note \"what a reader \\
                   must know\";
             scene \"type\";",
        ),
    )
    .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(d.name, "A");
    assert_eq!(
        d.slots.iter().map(ToString::to_string).collect::<Vec<_>>(),
        ["i", "j"]
    );
    assert_eq!(d.doc, ["Doc.", "Second line."]);
    assert_eq!(d.params[0].doc, ["The point."]);
    let kinds: Vec<&str> = d.params.iter().map(|p| kind_name(&p.kind)).collect();
    assert_eq!(
        kinds,
        [
            "Point",
            "Direction",
            "GroundLine",
            "Number",
            "Numbers",
            "Function",
            "Functions"
        ]
    );
    assert!(d.params[3].default.is_some());
    assert!(d.points_apart);
    let kept: Vec<_> = d
        .bindings
        .iter()
        .map(|b| (b.name.to_string(), b.kept.is_some()))
        .collect();
    assert_eq!(
        kept,
        [
            ("a".to_owned(), false),
            ("b".to_owned(), true),
            ("c".to_owned(), true)
        ]
    );
    assert!(matches!(&d.bindings[1].kept, Some(Kept::Vector(slot)) if slot == "j"));
    assert_eq!(d.requirements.len(), 1);
    assert_eq!(d.rows.len(), 2);
    assert!(d.phi.is_some() && d.psi.is_none() && d.place.is_some());
    assert_eq!(d.measures[0].0, "m");
    assert_eq!(d.component.map(|c| c.0.to_string()), Some("N".to_owned()));
    assert_eq!(
        d.note.map(|n| n.value()),
        Some("what a reader must know".to_owned())
    );
    assert_eq!(d.scene.map(|s| s.value()), Some("type".to_owned()));
    assert!(d.variant.is_none());
}

/// Each form has its own name, description and expression.
#[test]
fn a_definition_has_several_forms() {
    let text = joint(
        "let a = 1.0;
         variant key { /// First.
            \"one\": a, \"two-three\": 2.0 * a }
         let b = key;
         rows: [x]; phi: b; place: origin(i);",
    );
    let forms = definition(Kind::Constraint, text.parse().expect("tokens"));
    let forms = forms.unwrap_or_else(|e| panic!("{e}"));
    let of = |d: &Definition| {
        let variant = d.variant.as_ref().expect("a form");
        let bindings = d.bindings.iter().map(|b| b.name.to_string());
        assert_eq!(bindings.collect::<Vec<_>>(), ["a", "key", "b"]);
        assert_eq!(
            d.scene.as_ref().map(syn::LitStr::value).as_deref(),
            Some("a")
        );
        assert_eq!(variant.key, "key");
        let value = variant.value.value();
        (d.name.to_string(), d.doc.join(" "), value, variant.default)
    };
    let [one, two] = &forms[..] else {
        panic!("{} forms", forms.len())
    };
    let expected = |name: &str, doc: &str, value: &str, default| {
        (name.to_owned(), doc.to_owned(), value.to_owned(), default)
    };
    assert_eq!(of(one), expected("A", "Doc. First.", "one", true));
    assert_eq!(of(two), expected("TwoThreeA", "Doc.", "two-three", false));
}

fn kind_name(kind: &ParamKind) -> &'static str {
    match kind {
        ParamKind::Point(_) => "Point",
        ParamKind::Direction(_) => "Direction",
        ParamKind::Axes { .. } => "Axes",
        ParamKind::GroundLine => "GroundLine",
        ParamKind::GroundPlane => "GroundPlane",
        ParamKind::Number(_) => "Number",
        ParamKind::Numbers(_) => "Numbers",
        ParamKind::Function(_) => "Function",
        ParamKind::Functions(_) => "Functions",
    }
}

#[test]
fn a_law_ends_where_its_coordinate_begins() {
    let d = parse(
        Kind::Force,
        "plane A(i) { /// Doc.
            force: -(k * x) on angle(i);
            force: f[0] on point(i, s)[0];
        }",
    )
    .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(d.forces.len(), 2);
}

#[test]
fn what_is_wrong_is_named() {
    let cases = [
        ("", "expected `plane Name(i, j) { … }`"),
        (
            "solid A(i) {}",
            "expected `plane Name(i, j) { … }` or `space",
        ),
        ("plane A() {}", "`A` has no body slot"),
        ("plane A(i, i) {}", "two body slots are called `i`"),
        ("plane A(i) {} more", "nothing may follow the definition"),
        ("plane A(i) {}", "`A` has no doc comment"),
        (
            "plane A(i) { #[inline] }",
            "only doc comments may stand here",
        ),
        ("plane A(fn) {}", "`fn` is a word of Rust"),
        ("plane r#fn(i) {}", "`fn` is a keyword of Rust"),
    ];
    for (text, message) in cases {
        let found = error(Kind::Constraint, text);
        assert!(found.contains(message), "{text}: {found}");
    }
    let cases = [
        ("", "`A` has no equation"),
        ("phi: 1.0;", "`A` has no names for its rows"),
        ("rows: [x]; phi: 1.0;", "`A` has no place"),
        ("phi: 1.0", "expected `;`"),
        ("phi 1.0;", "expected `:`"),
        ("fi: 1.0;", "unknown item `fi`"),
        ("meassure m: 1.0;", "did you mean `measure`?"),
        ("points: 3;", "expected `apart`"),
        ("force: 1.0 on x;", "`force` belongs into a `force!`"),
        ("phi: 1.0; phi: 2.0;", "`phi` is given twice"),
        ("psi: 2.0; phi: 1.0;", "`phi` stands before `psi`"),
        ("points apart; points apart;", "`points` is given twice"),
        (
            "bearings;",
            "`bearings` stands after the parameters of a `space` definition",
        ),
        ("params { a: Lengt }", "did you mean `Length`?"),
        ("params { a: Banana }", "known are `Point`, `Direction`"),
        (
            "params { a: Function<Lengt> }",
            "unknown unit `Lengt`; did you mean `Length`?",
        ),
        ("params { a: [] }", "a list holds units"),
        (
            "params { a: [Length, Function<Force>] }",
            "a list holds units",
        ),
        ("params { a: [Point in i] }", "a list holds units"),
        ("params { a: Point }", "expected `in`"),
        ("initial { a: Vectr in i = b }", "did you mean `Vector`?"),
        ("variant a { \"b\": 1 }", "`a` has 1 values: write 2 to 8"),
        ("variant a { \"B\": 1 }", "lower-case letters and hyphens"),
        (
            "variant a { \"b\": 1, \"b\": 2 }",
            "two variants have this value",
        ),
        (
            "variant a { \"b\": 1, \"c\": 2 } variant d { \"b\": 1, \"c\": 2 }",
            "`variant` is given twice",
        ),
        ("note \" \";", "`note` has no words"),
        ("note \"a\"; note \"b\";", "`note` is given twice"),
    ];
    for (items, message) in cases {
        let found = error(Kind::Constraint, &joint(items));
        assert!(found.contains(message), "{items}: {found}");
    }
    let found = error(Kind::Force, &joint("phi: 1.0;"));
    assert!(
        found.contains("`phi` belongs into a `joint!`, this is a `force!`"),
        "{found}"
    );
    let found = error(Kind::Force, &joint(""));
    assert!(found.contains("`A` has no law"), "{found}");
}

#[test]
fn bounds_are_told() {
    let deep = joint(&format!("phi: {}1{};", "(".repeat(40), ")".repeat(40)));
    assert!(error(Kind::Constraint, &deep).contains("nested more than 32 deep"));
    let long = joint(&format!("phi: 1{};", " + 1".repeat(2000)));
    assert!(error(Kind::Constraint, &long).contains("more than 2048 tokens"));
    let signs = joint("phi: - - - - - 1;");
    assert!(error(Kind::Constraint, &signs).contains("more than 4 operators in a row"));
}
