//! `cargo xtask house` measures the project: lines of code, large types, circular dependencies of
//! modules, data files, numeric constants, and the limits on them. With `--check` it fails if a
//! limit is exceeded.
//!
//! The rules are documented where they are applied: [`lines`] defines a line of code, [`types`] a
//! stateful type, [`circles`] the uses between modules. All files are read with the tokenizer and
//! the parser of Rust. Code that macros write and files in other languages, such as `.js` or
//! `.toml`, are not counted.

mod circles;
mod constants;
mod data;
mod lines;
mod modules;
mod names;
mod source;
mod table;
#[cfg(test)]
mod tests;
mod types;

use serde_json::{Value, json};

use self::lines::Count;
use self::modules::Modules;
use self::names::Name;
use self::source::{Crate, Group};
use self::table::Table;
use self::types::Type;
use crate::tree::root;

// The limits were set to the measured values, and they may only decrease. Only a change that adds a
// feature may increase a size limit, in a separate commit.

/// Largest number of lines of code of all groups except tests and developers' tools.
const TOTAL_MOST: usize = 162_910;
/// Largest number of lines of code of the product.
const PRODUCT_MOST: usize = 125_640;
/// Largest number of tokens of the product; with this limit, longer lines do not help.
const TOKENS_MOST: usize = 1_197_400;
/// Largest number of lines of code of `dynamics`.
const DYNAMICS_MOST: usize = 11_970;
/// Largest number of stateful types above the bounds.
const STATEFUL_MOST: usize = 5;
/// Largest number of modules in a circle.
const CIRCLE_MOST: usize = 2;

/// The counts of one crate.
struct Counted {
    name: String,
    folder: String,
    group: Group,
    count: Count,
    types: Vec<Type>,
    names: Vec<Name>,
    circles: Vec<circles::Circle>,
}

/// Measures the workspace. With `check`, the function prints only the limits, and fails if a limit
/// is exceeded.
pub(crate) fn tell(is_json: bool, check: bool) -> Result<String, String> {
    let crates = source::crates(&root())?;
    let counted: Vec<Counted> = crates.iter().map(count).collect();
    let limits = limits(&counted);
    let exceeded = limits.rows.iter().any(|row| row[3] == "exceeded");
    let tables = if check {
        vec![faults(&counted), limits]
    } else {
        vec![
            lines_table(&counted),
            types_table("stateful types", &counted, true),
            types_table("plain data", &counted, false),
            circles_table(&counted),
            names_table(&counted),
            data_table(&crates),
            constants_table(&crates),
            limits,
        ]
    };
    let text = if is_json {
        table::json(&tables)
    } else {
        table::plain(&tables)
    };
    if check && exceeded {
        Err(text)
    } else {
        Ok(text)
    }
}

fn count(home: &Crate) -> Counted {
    let mut count = Count::default();
    for source in &home.files {
        count += lines::count(source);
    }
    let modules = Modules::of(home);
    Counted {
        name: home.name.clone(),
        folder: home.folder.clone(),
        group: home.group,
        count,
        types: types::large(&modules),
        names: names::unclear(&modules),
        circles: circles::circles(&modules, CIRCLE_MOST),
    }
}

/// Sum over groups of crates.
fn sum(counted: &[Counted], groups: &[Group]) -> Count {
    let mut sum = Count::default();
    for one in counted.iter().filter(|c| groups.contains(&c.group)) {
        sum += one.count;
    }
    sum
}

fn lines_table(counted: &[Counted]) -> Table {
    use Group::{Beside, Developers, Laboratory, Product, Tests};
    let row = |group: &str, name: &str, count: &Count| {
        let Count {
            code,
            tokens,
            tests,
            generated,
            examples,
        } = *count;
        let group = Value::from(group.to_lowercase());
        vec![
            group,
            name.into(),
            code.into(),
            tokens.into(),
            tests.into(),
            generated.into(),
            examples.into(),
        ]
    };
    let mut rows = Vec::new();
    for group in [Product, Beside, Laboratory, Developers, Tests] {
        let name = format!("{group:?}");
        let members = counted.iter().filter(|c| c.group == group);
        rows.extend(members.map(|c| row(&name, &c.name, &c.count)));
        rows.push(row(&name, "all", &sum(counted, &[group])));
    }
    let all = sum(counted, &[Product, Beside, Laboratory, Developers, Tests]);
    rows.push(row("all", "all", &all));
    Table {
        name: "lines",
        rule: "lines with a token that is no comment; code is hand-written, outside of tests"
            .into(),
        columns: &[
            "group",
            "crate",
            "code",
            "tokens",
            "tests",
            "generated",
            "examples",
        ],
        rows,
    }
}

fn types_table(name: &'static str, counted: &[Counted], is_stateful: bool) -> Table {
    let rows = counted.iter().flat_map(|home| {
        let types = home
            .types
            .iter()
            .filter(move |t| t.is_stateful == is_stateful);
        types.map(|t| {
            let file = format!("{}/{}", home.folder, t.file);
            let over = match (
                t.fields > types::FIELDS_MOST,
                t.methods > types::METHODS_MOST,
            ) {
                (true, true) => "both",
                (true, false) => "fields",
                _ => "methods",
            };
            vec![
                json!(t.name),
                json!(t.fields),
                json!(t.methods),
                json!(over),
                json!(file),
            ]
        })
    });
    let plain = if is_stateful {
        ""
    } else {
        "all fields open and no `&mut self`: "
    };
    Table {
        name,
        rule: format!(
            "{plain}more than {} fields or {} methods",
            types::FIELDS_MOST,
            types::METHODS_MOST
        ),
        columns: &["type", "fields", "methods", "too many", "file"],
        rows: rows.collect(),
    }
}

fn circles_table(counted: &[Counted]) -> Table {
    let mut rows = Vec::new();
    for home in counted {
        for (number, circle) in home.circles.iter().enumerate() {
            for (module, used, by) in &circle.uses {
                rows.push(vec![
                    json!(home.name),
                    json!(number + 1),
                    json!(circle.modules.len()),
                    json!(module),
                    json!(used),
                    json!(by),
                ]);
            }
        }
    }
    Table {
        name: "circles",
        rule: format!("more than {CIRCLE_MOST} modules that each reach each by uses"),
        columns: &["crate", "circle", "modules", "module", "uses", "of it"],
        rows,
    }
}

fn names_table(counted: &[Counted]) -> Table {
    let product = counted.iter().filter(|c| c.group == Group::Product);
    let rows = product.flat_map(|home| {
        home.names.iter().map(|name| {
            let noun = if name.is_noun { "" } else { "no" };
            vec![
                json!(home.name),
                json!(name.name),
                json!(name.files.len()),
                json!(noun),
                json!(name.files.join(" ")),
            ]
        })
    });
    Table {
        name: "names",
        rule:
            "of types of the product: what several types of a crate are called, and what is no noun"
                .into(),
        columns: &["crate", "name", "types", "noun", "files"],
        rows: rows.collect(),
    }
}

/// Data files that the product includes.
fn data_table(crates: &[Crate]) -> Table {
    let product = crates.iter().filter(|home| home.group == Group::Product);
    let rows = product.flat_map(|home| {
        let files = data::files(home, &root()).into_iter();
        files.map(|file| {
            vec![
                json!(home.name),
                json!(file.path),
                json!(file.bytes),
                json!(file.lines),
            ]
        })
    });
    Table {
        name: "data",
        rule: "files that the product includes when it is compiled, without examples".into(),
        columns: &["crate", "file", "bytes", "lines"],
        rows: rows.collect(),
    }
}

fn constants_table(crates: &[Crate]) -> Table {
    let homes = crates
        .iter()
        .filter(|c| constants::CRATES.contains(&c.name.as_str()));
    let rows = homes.flat_map(|home| {
        constants::constants(home).into_iter().map(|c| {
            let place = format!("{}/{}", home.folder, c.place);
            vec![
                json!(c.name),
                json!(c.value),
                json!(c.unit),
                json!(c.test),
                json!(place),
            ]
        })
    });
    Table {
        name: "constants",
        rule: format!(
            "numbers and ranges of numbers in {}",
            constants::CRATES.join(", ")
        ),
        columns: &["constant", "value", "unit", "test", "file"],
        rows: rows.collect(),
    }
}

/// Values that exceed a limit.
fn faults(counted: &[Counted]) -> Table {
    let mut rows = Vec::new();
    for home in counted {
        for t in home.types.iter().filter(|t| t.is_stateful) {
            let what = format!(
                "{} has {} fields and {} methods",
                t.name, t.fields, t.methods
            );
            rows.push(vec![
                json!(format!("{}/{}", home.folder, t.file)),
                json!(what),
            ]);
        }
        for circle in &home.circles {
            let names = &circle.modules;
            let what = format!("circle of {}: {}", names.len(), names.join(", "));
            rows.push(vec![json!(home.folder), json!(what)]);
        }
    }
    Table {
        name: "faults",
        rule: "stateful types and circles above their bounds".into(),
        columns: &["place", "fault"],
        rows,
    }
}

fn limits(counted: &[Counted]) -> Table {
    use Group::{Beside, Laboratory, Product};
    let dynamics = counted.iter().find(|c| c.name == "dynamics");
    let stateful = counted
        .iter()
        .flat_map(|c| &c.types)
        .filter(|t| t.is_stateful);
    let product = counted.iter().filter(|c| c.group == Product);
    let names = product.flat_map(|c| &c.names);
    let limits = [
        (
            "lines of product, laboratory and others",
            sum(counted, &[Product, Beside, Laboratory]).code,
            TOTAL_MOST,
        ),
        (
            "lines of the product",
            sum(counted, &[Product]).code,
            PRODUCT_MOST,
        ),
        (
            "tokens of the product",
            sum(counted, &[Product]).tokens,
            TOKENS_MOST,
        ),
        (
            "lines of `dynamics`",
            dynamics.map_or(0, |c| c.count.code),
            DYNAMICS_MOST,
        ),
        (
            "stateful types above the bounds",
            stateful.count(),
            STATEFUL_MOST,
        ),
        (
            "names of several types of one crate",
            names.clone().filter(|n| n.files.len() > 1).count(),
            names::SHARED_MOST,
        ),
        (
            "types that are no nouns",
            names.filter(|n| !n.is_noun).count(),
            0,
        ),
        (
            "circles of more than two modules",
            counted.iter().map(|c| c.circles.len()).sum(),
            0,
        ),
    ];
    let row = |(what, found, most): (&str, usize, usize)| {
        let verdict = if found > most { "exceeded" } else { "kept" };
        vec![json!(what), json!(found), json!(most), json!(verdict)]
    };
    Table {
        name: "limits",
        rule: "what is found must not exceed the most that is allowed".into(),
        columns: &["what", "found", "most", "limit"],
        rows: limits.into_iter().map(row).collect(),
    }
}
