//! Tests the complete translation, from tokens to the text of a module.

use pfaff_codegen::{Expansion, Kind, expand, expand_file, in_modules, kebab_case, snake_case};
use quote::quote;

const KNIFE_EDGE: &str = "joint! { plane KnifeEdge(i) {
    /// Point `s` has no velocity along `normal`.
    params { s: Point in i, normal: Direction in i }
    rows: [normal];
    psi: dot(direction(i, normal), velocity(point(i, s)));
    component N: direction(i, normal);
    place: point(i, s);
} }";

fn expansions(source: &str) -> Vec<Expansion> {
    expand_file(source, &quote!(::joints)).unwrap_or_else(|e| panic!("{e}"))
}

fn printed(source: &str) -> String {
    let [expansion] = &expansions(source)[..] else {
        panic!("several forms")
    };
    let file = syn::parse2(expansion.items.clone()).unwrap_or_else(|e| panic!("{e}"));
    prettyplease::unparse(&file)
}

#[test]
fn the_same_definition_gives_the_same_bytes() {
    let first = printed(KNIFE_EDGE);
    for _ in 0..5 {
        assert_eq!(printed(KNIFE_EDGE), first);
    }
}

#[test]
fn kernels_read_as_one_would_write_them() {
    let text = printed(KNIFE_EDGE);
    for piece in [
        "use ::joints::plane::{Direction, Line, Pose, Twist};",
        "pub normal: Direction,",
        "holonomic: 0,",
        "rows: &[Row::restricting_start(\"normal\")],",
        "Entry::constant(0, 0, 2)",
        "wrench: &[[0, 0], [1, 0]],",
        "component: Some(\"N\"),",
        "let normal_x = cos_i * normal_local_x - sin_i * normal_local_y;",
    ] {
        let squeezed = |s: &str| s.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            squeezed(&text).contains(&squeezed(piece)),
            "{piece}\n{text}"
        );
    }
}

#[test]
fn a_file_holds_one_definition() {
    let error = |source: &str| match expand_file(source, &quote!(crate)) {
        Ok(all) => format!("expanded `{}`", all[0].name),
        Err(e) => e.to_string(),
    };
    assert_eq!(error(KNIFE_EDGE), "expanded `KnifeEdge`");
    assert!(error("").contains("exactly one"));
    assert!(error(&format!("{KNIFE_EDGE}\n{KNIFE_EDGE}")).contains("exactly one"));
    assert!(error("fn main() {}").contains("exactly one"));
    assert!(error("hinge! { plane A(i) {} }").contains("expected `joint!` or `force!`"));
}

#[test]
fn the_author_text_travels() {
    let literal = proc_macro2::Literal::string(KNIFE_EDGE).to_string();
    let items = expansions(KNIFE_EDGE)[0].items.to_string();
    assert!(items.contains(&literal));
}

#[test]
fn a_module_is_named_after_its_definition() {
    let module = in_modules(&expansions(KNIFE_EDGE)).to_string();
    assert!(module.contains("mod __knife_edge {"), "{module}");
    assert_eq!(snake_case("PinInSlot"), "pin_in_slot");
    assert_eq!(kebab_case("PinInSlot"), "pin-in-slot");
}

/// Each form is a type with its own rows; the types have the same text.
#[test]
fn every_form_is_a_type() {
    let source = KNIFE_EDGE
        .replace("rows:", "variant along { \"no\": 0.0, \"yes\": 2.0 } rows:")
        .replace(
            ";\n    component",
            " - along * rate(angle(i));\n    component",
        );
    let all = expansions(&source);
    let names: Vec<&str> = all.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["KnifeEdge", "YesKnifeEdge"]);
    let literal = proc_macro2::Literal::string(&source).to_string();
    let texts: Vec<String> = all.iter().map(|e| e.items.to_string()).collect();
    for (text, [value, wrench]) in texts.iter().zip([
        ["value : \"no\" , default : true", "[[0 , 0] , [1 , 0]]"],
        [
            "value : \"yes\" , default : false",
            "[[0 , 0] , [1 , 0] , [2 , 0]]",
        ],
    ]) {
        assert!(text.contains("scene_type : \"knife-edge\""), "{text}");
        assert!(
            text.contains(value) && text.contains(&format!("wrench : & {wrench}")),
            "{text}"
        );
        assert!(text.contains(&literal), "{text}");
    }
    let modules = in_modules(&all).to_string();
    assert!(modules.contains("mod __yes_knife_edge {"), "{modules}");
}

/// The condition `(A || B) && C` is not `A || (B && C)`.
#[test]
fn conditions_keep_their_parentheses() {
    let body = "plane A(i) { /// Doc.
        params { k: Ratio }
        require \"words\": (k > 1 || k < 0) && k != 5;
        force: k on angle(i);
    }";
    let body = body.parse().expect("tokens");
    let all = expand(Kind::Force, body, &quote!(crate), "").unwrap_or_else(|e| panic!("{e}"));
    let text = all[0].items.to_string();
    let expected = quote!((k > 1.0 || k < 0.0) && k != 5.0).to_string();
    assert!(text.contains(&expected), "{text}");
}

#[test]
fn drives_of_one_joint_have_different_names() {
    let body = "plane A(i) { /// Doc.
        rows: [x];
        phi: angle(i);
        measure turn: angle(i);
        measure turn: origin(i)[0];
        place: origin(i);
    }";
    let body = body.parse().expect("tokens");
    let error = expand(Kind::Constraint, body, &quote!(crate), "").err();
    let message = error.map(|e| e.to_string()).unwrap_or_default();
    assert!(
        message.contains("two measures would have the drive `ATurnDrive`"),
        "{message}"
    );
}

#[test]
fn a_measure_that_nothing_moves_is_refused() {
    let body = "plane A(i) { /// Doc.
        params { l: Length }
        rows: [x];
        phi: angle(i);
        measure nothing: 2.0 * l;
        place: origin(i);
    }";
    let body = body.parse().expect("tokens");
    let error = expand(Kind::Constraint, body, &quote!(crate), "").err();
    let message = error.map(|e| e.to_string()).unwrap_or_default();
    assert!(message.contains("it restricts no motion"), "{message}");
}
