//! Data files that a program includes at compile time. Data files are a part of the program that is
//! not counted as code.

use std::fs;
use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};

use super::source::{Crate, Kind};

/// A file that a crate includes.
pub(super) struct DataFile {
    /// Path relative to the crate.
    pub(super) path: String,
    /// Size of the file.
    pub(super) bytes: usize,
    /// Number of lines; 0 if the file is not text.
    pub(super) lines: usize,
}

/// The files that the code of a crate includes by name, except the description of the crate.
pub(super) fn files(home: &Crate, root: &Path) -> Vec<DataFile> {
    let code = home.files.iter().filter(|file| file.kind == Kind::Code);
    let mut found: Vec<DataFile> = code
        .flat_map(|source| {
            let folder = source
                .path
                .rsplit_once('/')
                .map_or("", |(folder, _)| folder);
            let place = root.join(&home.folder);
            let names = included(source.tokens.clone()).into_iter();
            names.filter_map(move |name| read(&place, format!("{folder}/{name}")))
        })
        .collect();
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found.dedup_by(|a, b| a.path == b.path);
    found
}

fn read(place: &Path, path: String) -> Option<DataFile> {
    let content = fs::read(place.join(&path)).ok()?;
    let is_description = path.ends_with("README.md");
    (!is_description).then(|| DataFile {
        path,
        bytes: content.len(),
        lines: std::str::from_utf8(&content).map_or(0, |text| text.lines().count()),
    })
}

/// Names in `include_str!("…")` and `include_bytes!("…")`.
fn included(tokens: TokenStream) -> Vec<String> {
    let mut names = Vec::new();
    let trees: Vec<TokenTree> = tokens.into_iter().collect();
    for (k, tree) in trees.iter().enumerate() {
        let TokenTree::Group(group) = tree else {
            continue;
        };
        let is_included = k >= 2
            && matches!(&trees[k - 1], TokenTree::Punct(mark) if mark.as_char() == '!')
            && matches!(&trees[k - 2], TokenTree::Ident(name) if *name == "include_str" || *name == "include_bytes");
        match group.stream().into_iter().next() {
            Some(TokenTree::Literal(name)) if is_included => {
                names.push(name.to_string().trim_matches('"').to_owned());
            }
            _ => names.extend(included(group.stream())),
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::included;

    #[test]
    fn files_are_those_that_macros_name() {
        let code = r#"#[a(b = include_str!("x/y.txt"))] const F: &[u8] = include_bytes!("f.ttf"); let s = format!("no.txt");"#;
        let found = included(code.parse().expect("tokens"));
        assert_eq!(found, ["x/y.txt", "f.ttf"]);
    }
}
