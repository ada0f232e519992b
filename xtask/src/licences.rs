//! `THIRD-PARTY.md`: the third-party crates and fonts that the command `pfaff` and the Python
//! package link, with their licences and licence texts, for all features. The data come from
//! `cargo tree` and from the sources of the crates. `cargo tree` resolves features in the same way
//! as a build.
//!
//! The programs cargo-about and cargo-deny have more functions, but users must first install these
//! programs. This module needs only the tools that build the workspace, and `--check` needs no
//! network.

mod spdx;
mod texts;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use self::spdx::taken;
use self::texts::texts;
use crate::platforms::PLATFORMS;
use crate::tree::{cargo, root, said_by};

/// A distributed product.
#[derive(Clone, Copy)]
struct Product {
    /// Folder of the workspace of the product.
    workspace: &'static str,
    package: &'static str,
    /// Name of the product in the file.
    name: &'static str,
}

const PRODUCTS: [Product; 2] = [
    Product {
        workspace: "",
        package: "pfaff-cli",
        name: "command",
    },
    Product {
        workspace: "python",
        package: "pfaff-python",
        name: "Python",
    },
];

/// Third-party content other than crates, with the file of its licence.
const OTHERS: [(&str, &str); 1] = [(
    "the fonts DejaVu Sans Condensed",
    "crates/report/fonts/LICENSE.txt",
)];

const FILE: &str = "THIRD-PARTY.md";
const WRITE: &str = "`cargo xtask licences` writes it anew";

/// Kinds of dependencies that are linked into the command. Dependencies that only build the command
/// are omitted.
const LINKED: &str = "normal,no-proc-macro";
const BUILDING: &str = "normal,build";

/// A third-party crate.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Package {
    name: String,
    version: String,
    /// SPDX expression.
    licence: String,
    repository: String,
}

/// Crates with the products and systems that use them.
type Packages = BTreeMap<Package, BTreeSet<(&'static str, &'static str)>>;

/// Whether cargo may download missing crates.
#[derive(Clone, Copy, PartialEq)]
enum Network {
    Allowed,
    None,
}

/// Writes the file.
pub(crate) fn write() -> Result<String, String> {
    let (mut linked, mut building) = (Packages::new(), Packages::new());
    let mut sources = BTreeMap::new();
    for product in PRODUCTS {
        for (target, system) in PLATFORMS {
            let of = |edges| product.packages(target, edges, Network::Allowed);
            let own = of(LINKED)?;
            let mut others = of(BUILDING)?;
            others.retain(|package| !own.contains(package));
            add(&mut linked, own, (product.name, system));
            add(&mut building, others, (product.name, system));
            sources.extend(metadata(&product.folder(), target)?);
        }
    }
    for package in linked.keys().chain(building.keys()) {
        taken(&package.licence).map_err(|e| format!("{}: {e}", package.name))?;
    }
    let text = document(&linked, &building, &sources)?;
    fs::write(root().join(FILE), text).map_err(|e| format!("{FILE}: {e}"))?;
    building.retain(|package, _| !linked.contains_key(package));
    Ok(format!(
        "{FILE}: {} crates linked, {} only for building",
        linked.len(),
        building.len()
    ))
}

/// Compares the tables of the file with the locked versions, without a network. If the crates of a
/// platform are not on this machine, they are compared with `Cargo.lock` only by name and version.
pub(crate) fn check() -> Result<String, String> {
    let text =
        fs::read_to_string(root().join(FILE)).map_err(|e| format!("{FILE}: {e}; {WRITE}"))?;
    let (mut faults, mut said) = (Vec::new(), Vec::new());
    for (name, licence) in OTHERS {
        if !text.contains(&other(name, licence)?) {
            faults.push(format!("{name}: the licence text differs from {licence}"));
        }
    }
    for product in PRODUCTS {
        product.check(&text, &mut faults, &mut said)?;
    }
    if faults.is_empty() {
        said.insert(0, format!("{FILE} is that of Cargo.lock"));
        return Ok(said.join("\n"));
    }
    faults.sort();
    faults.dedup();
    Err(format!(
        "{FILE} does not agree with Cargo.lock; {WRITE}:\n{}",
        faults.join("\n")
    ))
}

impl Product {
    fn folder(self) -> PathBuf {
        root().join(self.workspace)
    }

    /// Whether a cell of the file contains this product on a system.
    fn is_named(self, cell: &str, system: &str) -> bool {
        let on_system = format!("{} on {system}", self.name);
        cell.split(", ")
            .any(|on| on == self.name || on == on_system)
    }

    fn check(
        self,
        text: &str,
        faults: &mut Vec<String>,
        said: &mut Vec<String>,
    ) -> Result<(), String> {
        let lock = fs::read_to_string(self.folder().join("Cargo.lock"))
            .map_err(|e| format!("Cargo.lock: {e}"))?;
        let rows: Vec<&str> = text.lines().filter(|line| line.starts_with("| ")).collect();
        let mut now: BTreeMap<&str, Result<BTreeSet<String>, ()>> = BTreeMap::new();
        let mut missing = 0;
        for (target, system) in PLATFORMS {
            let of = |edges| self.packages(target, edges, Network::None);
            match of(LINKED).and_then(|linked| Ok((linked, of(BUILDING)?))) {
                Ok((linked, building)) => {
                    for package in linked.iter().chain(&building) {
                        if let Err(e) = taken(&package.licence) {
                            faults.push(format!("{}: {e}", package.name));
                        }
                    }
                    let known = now.entry(system).or_insert_with(|| Ok(BTreeSet::new()));
                    if let Ok(known) = known {
                        known.extend(linked.iter().chain(&building).map(Package::cells));
                    }
                }
                Err(_) => {
                    now.insert(system, Err(()));
                    missing += 1;
                    said.push(format!(
                        "{} on {target} is not compared: its crates are not installed on this machine",
                        self.name
                    ));
                }
            }
        }
        for (system, known) in now {
            let written: BTreeSet<String> = rows
                .iter()
                .filter_map(|row| row.trim_end_matches(" |").rsplit_once(" | "))
                .filter(|(_, on)| self.is_named(on, system))
                .map(|(cells, _)| cells.to_owned())
                .collect();
            match known {
                Ok(known) => {
                    let differ = written.symmetric_difference(&known);
                    faults.extend(differ.map(|row| format!("{} on {system}: {row}", self.name)));
                }
                Err(()) => faults.extend(written.iter().filter_map(|row| {
                    let mut cells = row.trim_start_matches("| ").split(" | ");
                    let (name, version) = (cells.next()?, cells.next()?);
                    let locked = format!("name = \"{name}\"\nversion = \"{version}\"\n");
                    (!lock.contains(&locked))
                        .then(|| format!("not in Cargo.lock: {name} {version}"))
                })),
            }
        }
        if missing == PLATFORMS.len() {
            let name = self.name;
            faults.push(format!(
                "no platform of {name} could be compared: build it first"
            ));
        }
        Ok(())
    }

    /// Returns the third-party crates on which the product depends on a platform. Only dependencies
    /// of these kinds count.
    fn packages(
        self,
        target: &str,
        edges: &str,
        network: Network,
    ) -> Result<BTreeSet<Package>, String> {
        let mut tree = cargo(&self.folder());
        tree.args(["tree", "--locked", "-p", self.package, "--all-features"]);
        tree.args(["--prefix", "none"]);
        tree.args([
            "--target",
            target,
            "--edges",
            edges,
            "--format",
            "{p}|{l}|{r}",
        ]);
        if network == Network::None {
            tree.arg("--offline");
        }
        let lines = said_by(&mut tree)?;
        Ok(lines.lines().filter_map(package).collect())
    }
}

/// The products and systems of a crate as text.
fn words(on: &BTreeSet<(&'static str, &'static str)>) -> String {
    let systems: BTreeSet<&str> = PLATFORMS.iter().map(|(_, system)| *system).collect();
    let mut list = Vec::new();
    for Product { name, .. } in PRODUCTS {
        let own: Vec<&str> = on
            .iter()
            .filter(|(of, _)| *of == name)
            .map(|on| on.1)
            .collect();
        if own.len() == systems.len() {
            list.push(name.to_owned());
        } else {
            list.extend(own.iter().map(|system| format!("{name} on {system}")));
        }
    }
    list.join(", ")
}

fn document(
    linked: &Packages,
    building: &Packages,
    sources: &BTreeMap<(String, String), Source>,
) -> Result<String, String> {
    let table = |packages: &Packages| {
        let mut rows = String::from(
            "| crate | version | licence | source | in |\n| --- | --- | --- | --- | --- |\n",
        );
        for (package, on) in packages {
            rows.push_str(&format!("{} | {} |\n", package.cells(), words(on)));
        }
        rows
    };
    let mut out = format!(
        "# Licences of others\n\nWritten by `cargo xtask licences`; `.ci/run` compares it with `Cargo.lock`. \
         The command `pfaff` and the Python package `pfaff` themselves are licensed under MIT or Apache-2.0.\n\n\
         ## Linked\n\n{}\n## Used for building alone\n\n{}",
        table(linked),
        table(building),
    );
    out.push_str(
        "\n## Texts\n\nOf several licences that a crate offers, the first of these is taken:\n\n",
    );
    for (name, reason) in spdx::ALLOWED {
        out.push_str(&format!("- {name}: {reason}\n"));
    }
    for (text, crates) in texts(linked.keys(), sources)? {
        // A code fence that is longer than any fence in the text.
        out.push_str(&format!(
            "\n### {}\n\n````text\n{text}\n````\n",
            crates.join("; ")
        ));
    }
    for (name, licence) in OTHERS {
        out.push_str(&other(name, licence)?);
    }
    Ok(out)
}

/// The licence of content that is not a crate, as printed in the file.
fn other(name: &str, licence: &str) -> Result<String, String> {
    let text = fs::read_to_string(root().join(licence)).map_err(|e| format!("{licence}: {e}"))?;
    Ok(format!(
        "\n### {name}\n\n````text\n{}\n````\n",
        text.trim_end()
    ))
}

impl Package {
    /// The cells of a row, without the systems.
    fn cells(&self) -> String {
        let Self {
            name,
            version,
            licence,
            repository,
        } = self;
        format!("| {name} | {version} | {licence} | {repository}")
    }
}

fn add(all: &mut Packages, more: BTreeSet<Package>, on: (&'static str, &'static str)) {
    for package in more {
        all.entry(package).or_default().insert(on);
    }
}

/// Reads a line such as `either v1.2.3|MIT OR Apache-2.0|https://…`. Returns `None` for crates of
/// the workspace, which have a path.
fn package(line: &str) -> Option<Package> {
    let mut parts = line.split('|');
    let (name, licence) = (parts.next()?, parts.next()?);
    let repository = parts.next()?.trim_end_matches(" (*)");
    let (name, version) = name.split_once(" v")?;
    if version.contains("(/") || version.contains(":\\") {
        return None;
    }
    Some(Package {
        name: name.to_owned(),
        version: version.split(' ').next()?.to_owned(),
        licence: licence.to_owned(),
        repository: repository.to_owned(),
    })
}

/// Information about a crate in its sources.
struct Source {
    manifest: String,
    /// Names of the authors without their addresses.
    authors: Vec<String>,
}

/// The sources of all crates of a platform, by name and version.
fn metadata(folder: &Path, target: &str) -> Result<BTreeMap<(String, String), Source>, String> {
    let mut metadata = cargo(folder);
    metadata.args([
        "metadata",
        "--locked",
        "--format-version=1",
        "--filter-platform",
        target,
    ]);
    let said: Value = serde_json::from_str(&said_by(&mut metadata)?).map_err(|e| e.to_string())?;
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let packages = said["packages"]
        .as_array()
        .map(Vec::as_slice)
        .unwrap_or_default();
    let source = |p: &Value| {
        let authors = p["authors"]
            .as_array()
            .map(Vec::as_slice)
            .unwrap_or_default();
        let name = |author: &Value| Some(author.as_str()?.split('<').next()?.trim().to_owned());
        let source = Source {
            manifest: text(&p["manifest_path"]),
            authors: authors.iter().filter_map(name).collect(),
        };
        ((text(&p["name"]), text(&p["version"])), source)
    };
    Ok(packages.iter().map(source).collect())
}

#[cfg(test)]
mod tests {
    use super::package;

    #[test]
    fn lines_of_the_tree_are_crates_of_others() {
        let found = package("toml v1.2.1+spec-1.1.0|MIT OR Apache-2.0|https://a.b/c (*)");
        let found = found.expect("a crate of others");
        assert_eq!(
            found.cells(),
            "| toml | 1.2.1+spec-1.1.0 | MIT OR Apache-2.0 | https://a.b/c"
        );
        let procedural = package("serde_derive v1.0.2 (proc-macro)|MIT|").expect("of others");
        assert_eq!(procedural.version, "1.0.2");
        assert!(package("pfaff-model v0.1.0 (/home/x/crates/model)|MIT|").is_none());
        assert!(package("pfaff-model v0.1.0 (C:\\x\\crates\\model)|MIT|").is_none());
    }
}
