//! `crates/joints/definitions/*.rs` → `crates/joints/src/generated/`, and for space
//! `definitions/space/*.rs` → `generated/space3/`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use ::codegen::{Expansion, Kind, Space, expand_file, snake_case};

use crate::tree::root;

const DEFINITIONS: &str = "crates/joints/definitions";
const GENERATED: &str = "crates/joints/src/generated";

/// The folders of a space, relative to the folders of all spaces, and the form of the list of its
/// definitions.
struct Family {
    definitions: &'static str,
    generated: &'static str,
    /// Adjective for the definitions in texts.
    adjective: &'static str,
    /// Prefix of the functions that visit the definitions.
    prefix: &'static str,
    /// Trait bound of the visitors.
    visitor: &'static str,
    /// Start of the list of definitions.
    head: &'static str,
}

const FAMILIES: [Family; 2] = [
    Family {
        definitions: "",
        generated: "",
        adjective: "planar",
        prefix: "plane_",
        visitor: "Visitor",
        head: "use crate::visitor::Visitor;\n\npub mod space3;\n",
    },
    Family {
        definitions: "space/",
        generated: "space3/",
        adjective: "spatial",
        prefix: "",
        visitor: "Visitor<Space3>",
        head: "use crate::space::Space3;\nuse crate::visitor::Visitor;\n\n",
    },
];

/// Writes all generated files, and removes generated files without a definition.
pub(crate) fn write() -> Result<String, String> {
    let root = root();
    let files = generate(&root)?;
    let folder = root.join(GENERATED);
    for Family { generated, .. } in &FAMILIES {
        let folder = folder.join(generated);
        fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    for name in all_present(&folder)? {
        if !files.contains_key(&name) {
            let path = folder.join(&name);
            fs::remove_file(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        }
    }
    for (name, text) in &files {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(format!("{} files written to {GENERATED}", files.len()))
}

/// Compares all generated files with their expected contents.
pub(crate) fn check() -> Result<String, String> {
    let root = root();
    let files = generate(&root)?;
    let folder = root.join(GENERATED);
    let mend = "run `cargo xtask codegen` and commit the result";
    for name in all_present(&folder)? {
        if !files.contains_key(&name) {
            return Err(format!(
                "{GENERATED}/{name} no longer has a definition: {mend}"
            ));
        }
    }
    for (name, text) in &files {
        let path = folder.join(name);
        let found = fs::read_to_string(&path)
            .map_err(|e| format!("{GENERATED}/{name}: {e}; {mend}"))?
            .replace("\r\n", "\n");
        if let Some((line, old, new)) = first_difference(&found, text) {
            return Err(format!(
                "{GENERATED}/{name}:{line} differs from its definition\n  found:    {old}\n  expected: {new}\n{mend}"
            ));
        }
    }
    Ok(format!(
        "{} files in {GENERATED} agree with their definitions",
        files.len()
    ))
}

/// Names of the Rust files in a folder.
fn present(folder: &Path) -> Result<Vec<String>, String> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut names = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|e| format!("{}: {e}", folder.display()))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.ends_with(".rs") {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

/// Names of the existing generated files of all spaces.
fn all_present(folder: &Path) -> Result<Vec<String>, String> {
    let mut all = Vec::new();
    for Family { generated, .. } in &FAMILIES {
        let names = present(&folder.join(generated))?.into_iter();
        all.extend(names.map(|name| format!("{generated}{name}")));
    }
    Ok(all)
}

/// All generated files by name.
fn generate(root: &Path) -> Result<BTreeMap<String, String>, String> {
    let mut files = BTreeMap::new();
    for family in &FAMILIES {
        let folder = root.join(DEFINITIONS).join(family.definitions);
        let mut expansions = Vec::new();
        for file in present(&folder)? {
            let name = format!("{}{file}", family.definitions);
            let path = folder.join(&file);
            let source = fs::read_to_string(&path)
                .map_err(|e| format!("{}: {e}", path.display()))?
                .replace("\r\n", "\n");
            let runtime = "crate".parse().map_err(|e| format!("{e}"))?;
            let forms = expand_file(&source, &runtime).map_err(|e| located(&name, &e))?;
            let named = |expansion: &Expansion| format!("{}.rs", snake_case(&expansion.name));
            if let Some(first) = forms.first().filter(|first| file != named(first)) {
                return Err(format!("{DEFINITIONS}/{name} defines `{}`", first.name));
            }
            for expansion in forms {
                if (expansion.space == Space::Plane) != family.definitions.is_empty() {
                    return Err(format!(
                        "{DEFINITIONS}/{name} does not belong to the space of its folder"
                    ));
                }
                let text = print(&name, &expansion)?;
                files.insert(format!("{}{}", family.generated, named(&expansion)), text);
                expansions.push(expansion);
            }
        }
        expansions.sort_by_cached_key(|expansion| snake_case(&expansion.name));
        let index = print_index(family, &expansions)?;
        files.insert(format!("{}mod.rs", family.generated), index);
    }
    Ok(files)
}

fn located(name: &str, e: &syn::Error) -> String {
    let start = e.span().start();
    format!(
        "{DEFINITIONS}/{name}:{}:{}: {e}",
        start.line,
        start.column + 1
    )
}

fn print(name: &str, expansion: &Expansion) -> Result<String, String> {
    let file = syn::parse2(expansion.items.clone())
        .map_err(|e| format!("the expansion of {name} is not valid Rust: {e}"))?;
    Ok(format!(
        "//! Generated by `cargo xtask codegen` from `{DEFINITIONS}/{name}`. Do not edit.\n\n{}",
        prettyplease::unparse(&file)
    ))
}

/// The module that lists all definitions and passes them to visitors.
fn print_index(family: &Family, expansions: &[Expansion]) -> Result<String, String> {
    use std::fmt::Write;
    let Family {
        definitions,
        adjective,
        prefix,
        visitor,
        head,
        ..
    } = family;
    let mut text = format!(
        "//! Generated by `cargo xtask codegen` from `{DEFINITIONS}/{definitions}`. Do not edit.\n\n{head}"
    );
    let mut modules = String::new();
    let (mut constraints, mut forces) = (String::new(), String::new());
    for e in expansions {
        let module = snake_case(&e.name);
        let visits = match e.kind {
            Kind::Constraint => &mut constraints,
            Kind::Force => &mut forces,
        };
        let method = match e.kind {
            Kind::Constraint => "constraint",
            Kind::Force => "force",
        };
        writeln!(
            modules,
            "#[rustfmt::skip]\npub mod {module};\npub use {module}::*;"
        )
        .and_then(|()| writeln!(visits, "visitor.{method}::<{}>();", e.name))
        .map_err(|e| e.to_string())?;
    }
    write!(
        text,
        "{}",
        prettyplease::unparse(
            &syn::parse_str(&format!(
                "{modules}
                /// Shows all {adjective} constraints to a visitor, in alphabetical order.
                pub fn {prefix}constraints<V: {visitor}>(visitor: &mut V) {{ {constraints} }}
                /// Shows all {adjective} forces to a visitor, in alphabetical order.
                pub fn {prefix}forces<V: {visitor}>(visitor: &mut V) {{ {forces} }}"
            ))
            .map_err(|e| e.to_string())?
        )
    )
    .map_err(|e| e.to_string())?;
    Ok(text)
}

fn first_difference(found: &str, expected: &str) -> Option<(usize, String, String)> {
    let (mut a, mut b) = (found.lines(), expected.lines());
    let mut line = 0;
    loop {
        line += 1;
        match (a.next(), b.next()) {
            (None, None) => return None,
            (x, y) if x == y => {}
            (x, y) => {
                let show = |s: Option<&str>| s.unwrap_or("(end of file)").to_owned();
                return Some((line, show(x), show(y)));
            }
        }
    }
}
