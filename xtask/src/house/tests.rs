//! Tests with small crates of a few modules, and the expected results.

use proc_macro2::{TokenStream, TokenTree};

use super::circles::circles;
use super::constants::{Constant, constants};
use super::modules::Modules;
use super::names::unclear;
use super::source::{Crate, Group, Kind, Source, crates, folders_in, group, kind, submodules};
use super::table::{Table, json, plain};
use super::types::large;
use super::{CIRCLE_MOST, Count, Counted, DYNAMICS_MOST, limits};
use crate::tree::root;

fn house(files: &[(&str, &str)]) -> Crate {
    let read = |(path, text): &(&str, &str)| Source::new((*path).to_owned(), kind(path), text);
    Crate {
        name: "house".into(),
        folder: "crates/house".into(),
        group: Group::Product,
        files: files
            .iter()
            .map(read)
            .collect::<Result<_, _>>()
            .expect("tokens"),
    }
}

/// The modules of each circle.
fn circles_of(files: &[(&str, &str)]) -> Vec<Vec<String>> {
    let home = house(files);
    let circles = circles(&Modules::of(&home), 1);
    circles.into_iter().map(|c| c.modules).collect()
}

#[test]
fn files_are_told_by_their_paths() {
    assert_eq!(kind("src/a/tests.rs"), Kind::Test);
    assert_eq!(kind("tests/contract/main.rs"), Kind::Test);
    assert_eq!(kind("src/a/tests/b.rs"), Kind::Test);
    assert_eq!(kind("src/generated/tests.rs"), Kind::Generated);
    assert_eq!(kind("benches/robot.rs"), Kind::Example);
    assert_eq!(kind("src/attests.rs"), Kind::Code);
    assert_eq!(submodules("src/lib.rs"), "src/");
    assert_eq!(submodules("src/a/mod.rs"), "src/a/");
    assert_eq!(submodules("src/a/lib.rs"), "src/a/lib/");
}

#[test]
fn the_product_is_what_the_command_depends_on_without_the_laboratory() {
    let said = "pfaff-cli v0.1.0 (/r/crates/pfaff-cli)\nserde v1.0.0\nsuite v0.1.0 (/r/crates/suite) (*)\n";
    let product = folders_in(said, "/r/");
    assert_eq!(product.len(), 2);
    let groups = ["pfaff-cli", "suite", "symbolic", "bench"]
        .map(|n| group(&format!("crates/{n}"), &product));
    assert_eq!(
        groups,
        [
            Group::Product,
            Group::Laboratory,
            Group::Beside,
            Group::Developers
        ]
    );
    assert_eq!(group("tests/peers", &product), Group::Tests);
}

#[test]
fn a_limit_is_exceeded_by_one_line() {
    let verdict = |code: usize| {
        let count = Count {
            code,
            ..Count::default()
        };
        let counted = Counted {
            name: "dynamics".into(),
            folder: "crates/dynamics".into(),
            group: Group::Product,
            count,
            types: Vec::new(),
            names: Vec::new(),
            circles: Vec::new(),
        };
        let rows = limits(&[counted]).rows;
        rows.iter().map(|r| r[3] == "exceeded").collect::<Vec<_>>()
    };
    assert_eq!(verdict(DYNAMICS_MOST), [false; 8]);
    assert_eq!(
        verdict(DYNAMICS_MOST + 1),
        [false, false, false, true, false, false, false, false]
    );
}

#[test]
fn tables_are_told_plainly_and_as_json() {
    let rows = vec![vec!["a".into(), 7.into()], vec!["bc".into(), 10.into()]];
    let table = Table {
        name: "t",
        rule: "r".into(),
        columns: &["c", "n"],
        rows,
    };
    assert_eq!(
        plain(std::slice::from_ref(&table)),
        "t: r\n  c    n\n  a    7\n  bc  10\n"
    );
    let read: serde_json::Value = serde_json::from_str(&json(&[table])).expect("JSON");
    assert_eq!(read["t"][1]["n"], 10);
}

#[test]
fn three_modules_in_a_circle_are_found_and_a_chain_is_not() {
    let root = ("src/lib.rs", "mod a; mod b; mod c;");
    let a = ("src/a.rs", "use crate::b::B; pub(crate) struct A(B);");
    let b = ("src/b.rs", "pub(crate) struct B(super::c::C);");
    let c = "pub(crate) struct C; fn f() { println!(\"{}\", crate::a::A::f()) }";
    let all = ["crate::a", "crate::b", "crate::c"];
    assert_eq!(circles_of(&[root, a, b, ("src/c.rs", c)]), [all]);
    let chain = "pub(crate) struct C; #[cfg(test)] mod tests { use crate::a::A; }";
    assert!(circles_of(&[root, a, b, ("src/c.rs", chain)]).is_empty());
}

#[test]
fn a_reexport_is_no_use_but_leads_to_the_definition() {
    let parent = "mod b; mod c; pub use b::B; pub use c::C;";
    let files = |parent, b| {
        [
            ("src/lib.rs", "mod a;"),
            ("src/a.rs", parent),
            ("src/a/b.rs", b),
            ("src/a/c.rs", "pub struct C(super::B);"),
        ]
    };
    assert!(circles_of(&files(parent, "pub struct B;")).is_empty());
    let with_own = format!("{parent} pub struct P;");
    let of_parent = "pub struct B; fn f(_: super::P) {}";
    assert!(circles_of(&files(&with_own, of_parent)).is_empty());
    // Siblings that use each other through their parent form a circle without the parent.
    let siblings = circles_of(&files(parent, "pub struct B; fn f(_: super::C) {}"));
    assert_eq!(siblings, [["crate::a::b", "crate::a::c"]]);
    // The parent uses `c`, `c` uses `b`, and `b` uses an item of the parent.
    let working = "mod b; mod c; pub use b::B; struct P(B); fn p(_: c::C) {}";
    let all = circles_of(&files(working, of_parent));
    assert_eq!(all, [["crate::a", "crate::a::b", "crate::a::c"]]);
}

#[test]
fn an_imported_module_counts_by_what_is_named_through_it() {
    let root = ("src/lib.rs", "mod a; mod b;");
    let b = ("src/b.rs", "pub struct B; fn f(_: crate::a::A) {}");
    let of = |a| circles_of(&[root, ("src/a.rs", a), b]);
    let both = ["crate::a", "crate::b"];
    assert!(of("use super::b; pub struct A;").is_empty());
    assert_eq!(of("use super::b; pub struct A(b::B);"), [both]);
    assert_eq!(of("use super::b::*; pub struct A;"), [both]);
    assert_eq!(
        of("pub struct A; fn f() { use super::b as other; other::B; }"),
        [both]
    );
}

#[test]
fn one_type_over_several_files_makes_a_circle_by_its_own_methods() {
    let root = "mod a; mod b; pub struct S; impl S { fn f(&self) { self.g() } }";
    let a = "use crate::S; impl S { pub fn g(&self) { self.h() } }";
    let quiet = ("src/b.rs", "use super::S; impl S { pub fn h(&self) {} }");
    let loud = (
        "src/b.rs",
        "use super::S; impl S { pub fn h(&self) { self.f() } }",
    );
    let all = ["crate", "crate::a", "crate::b"];
    assert_eq!(
        circles_of(&[("src/lib.rs", root), ("src/a.rs", a), loud]),
        [all]
    );
    assert_eq!(
        circles_of(&[("src/lib.rs", root), ("src/a.rs", a), quiet]),
        [all]
    );
    let apart = "mod a; mod b; pub struct S;";
    let none = circles_of(&[("src/lib.rs", apart), ("src/a.rs", a), quiet]);
    assert!(none.is_empty(), "{none:?}");
}

#[test]
fn modules_inside_a_file_belong_to_it() {
    let root = ("src/lib.rs", "mod a; mod b;");
    let a = (
        "src/a.rs",
        "pub mod inner { use super::super::b::B; pub struct A(B); }",
    );
    let b = (
        "src/b.rs",
        "pub struct B; fn f() { crate::a::inner::A::g(); }",
    );
    assert_eq!(circles_of(&[root, a, b]), [["crate::a", "crate::b"]]);
}

/// Fields `f0: u8, f1: u8, …`.
fn fields(n: usize, visibility: &str) -> String {
    (0..n).map(|i| format!("{visibility} f{i}: u8, ")).collect()
}

#[test]
fn large_types_are_stateful_unless_they_are_open_and_nothing_changes_them() {
    let files = |text: &str| house(&[("src/lib.rs", text)]);
    let found = |text: &str| {
        let home = files(text);
        let types = large(&Modules::of(&home));
        types
            .iter()
            .map(|t| (t.fields, t.methods, t.is_stateful))
            .collect::<Vec<_>>()
    };
    let [closed, open] = [fields(13, ""), fields(13, "pub")];
    assert_eq!(
        found(&format!("pub struct S {{ {closed} }}")),
        [(13, 0, true)]
    );
    assert_eq!(
        found(&format!("pub struct S {{ {open} }}")),
        [(13, 0, false)]
    );
    let changing = "impl Iterator for S { fn next(&mut self) {} }";
    assert_eq!(
        found(&format!("pub struct S {{ {open} }} {changing}")),
        [(13, 0, true)]
    );
    assert_eq!(
        found(&format!(
            "pub struct S {{ {} #[cfg(test)] t: u8 }}",
            fields(12, "")
        )),
        []
    );
    assert_eq!(
        found(&format!("enum E {{ A(u8), B {{ {closed} }} }}")),
        [(13, 0, false)]
    );
}

#[test]
fn methods_are_counted_over_all_files() {
    let methods = |from: usize, to: usize| -> String {
        (from..to)
            .map(|i| format!("fn m{i}(&self) {{}} "))
            .collect()
    };
    let root = format!(
        "mod a; mod b; pub struct S(u8); impl S {{ {} }}",
        methods(0, 16)
    );
    // `b` has another `S`, with its own methods.
    let a = format!(
        "use super::S; impl S {{ {} }} #[cfg(test)] impl S {{ fn t(&self) {{}} }}",
        methods(16, 31)
    );
    let b = format!("struct S; impl S {{ {} }}", methods(0, 16));
    let home = house(&[("src/lib.rs", &root), ("src/a.rs", &a), ("src/b.rs", &b)]);
    let types = large(&Modules::of(&home));
    let found: Vec<_> = types
        .iter()
        .map(|t| (t.file.as_str(), t.methods, t.is_stateful))
        .collect();
    assert_eq!(found, [("src/lib.rs", 31, true)]);
}

#[test]
fn numeric_constants_are_listed_with_value_and_line() {
    let text = "/// A. Unit: m.\n/// Test: `a_test`.\nconst A: f64 = 4.0 * f64::EPSILON;\nimpl S { const B: RangeInclusive<f64> = 0.0..=1.0; }\nconst C: &str = \"1\";\nfn f() { const D: usize =\n 3; }\n#[cfg(test)] const E: f64 = 1.0;\n";
    let expected = [
        ("A", "4.0 * f64::EPSILON", 3, ["m", "a_test"]),
        ("B", "0.0..=1.0", 4, ["", ""]),
        ("D", "3", 6, ["", ""]),
    ];
    let expected = expected.map(|(name, value, line, [unit, test])| Constant {
        place: format!("src/lib.rs:{line}"),
        name: name.into(),
        value: value.into(),
        unit: unit.into(),
        test: test.into(),
    });
    assert_eq!(constants(&house(&[("src/lib.rs", text)])), expected);
}

/// If two modules need an item of each other, the item must move to a third module that both use.
#[test]
fn no_more_than_two_modules_of_this_house_reach_each_other() {
    let crates = crates(&root()).expect("sources");
    assert!(crates.len() > 20, "{}", crates.len());
    for home in &crates {
        let found = circles(&Modules::of(home), CIRCLE_MOST);
        let uses: Vec<_> = found.iter().flat_map(|circle| &circle.uses).collect();
        assert!(uses.is_empty(), "{}: {uses:#?}", home.name);
    }
}

/// Conditions for compiling parts only on some systems, except the conditions for Linux and for all
/// other systems. With `cfg!`, both branches are compiled on every system.
fn conditions_on_systems(tokens: &TokenStream) -> Vec<String> {
    let tokens: Vec<TokenTree> = tokens.clone().into_iter().collect();
    let mut found = Vec::new();
    for (k, token) in tokens.iter().enumerate() {
        let TokenTree::Group(group) = token else {
            continue;
        };
        let before = k.checked_sub(1).map(|before| tokens[before].to_string());
        if matches!(before.as_deref(), Some("cfg" | "cfg_attr")) {
            let words = group.stream().to_string();
            let known = words.replace("target_os = \"linux\"", "");
            let known = known.replace("target_family = \"wasm\"", "");
            let systems = [
                "unix",
                "windows",
                "target_os",
                "target_family",
                "target_vendor",
            ];
            if systems.iter().any(|system| known.contains(system)) {
                found.push(words);
            }
        }
        found.extend(conditions_on_systems(&group.stream()));
    }
    found
}

/// The sources distinguish only Linux from all other systems, and WebAssembly, which
/// `cargo xtask site --check` compiles. Therefore one other system represents all other systems in
/// [`crate::platforms`].
#[test]
fn sources_tell_linux_from_others_and_nothing_else() {
    for home in crates(&root()).expect("sources") {
        for file in home.files.iter().filter(|file| file.kind == Kind::Code) {
            let found = conditions_on_systems(&file.tokens);
            assert!(found.is_empty(), "{}/{}: {found:?}", home.folder, file.path);
        }
    }
}

#[test]
fn a_condition_on_another_system_is_seen() {
    let of = |text: &str| {
        let source = Source::new("src/lib.rs".to_owned(), Kind::Code, text);
        conditions_on_systems(&source.expect("tokens").tokens)
    };
    let linux = "#[cfg(target_os = \"linux\")] fn a() { #[cfg(not(target_os = \"linux\"))] b(); }";
    assert!(of(linux).is_empty());
    assert!(of("fn a() { if cfg!(unix) {} }").is_empty());
    assert_eq!(of("fn a() { #[cfg(unix)] b(); }"), ["unix"]);
    assert_eq!(
        of("#[cfg(all(test,\n windows))] mod a;"),
        ["all (test , windows)"]
    );
    assert_eq!(
        of("#[cfg(target_os = \"macos\")] mod a;"),
        ["target_os = \"macos\""]
    );
}

#[test]
fn names_are_unclear_if_two_types_have_them_or_they_are_no_nouns() {
    let home = house(&[
        ("src/lib.rs", "mod a; mod b; struct Speed; struct Known;"),
        (
            "src/a.rs",
            "struct Rows; enum Asked { A } struct KnownRows;",
        ),
        (
            "src/b.rs",
            "type Rows = usize; trait KeptRow {} #[cfg(test)] mod tests { struct Told; }",
        ),
    ]);
    let found = unclear(&Modules::of(&home));
    let found: Vec<_> = found
        .iter()
        .map(|n| (n.name.as_str(), n.files.len(), n.is_noun))
        .collect();
    let expected = [("Asked", 1, false), ("Known", 1, false), ("Rows", 2, true)];
    assert_eq!(found, expected);
}
