//! Stable codes of errors and warnings, and what each of them means: one table, from which the
//! command `pfaff explain` and a page of the book are made. A code is never used again for
//! something else. Each enum of errors gives its codes in `code()`, by a `match` over all variants.

mod table;

use std::fmt;

use serde::{Serialize, Serializer};

pub use table::TABLE;

/// The code of an error or a warning, written as `P0123`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(u16);

impl Code {
    /// A code of the table. In a `const` block a code that is missing there does not compile.
    ///
    /// # Panics
    /// If the table has no such code.
    #[must_use]
    pub const fn new(number: u16) -> Self {
        let mut k = 0;
        while k < TABLE.len() {
            if TABLE[k].code.0 == number {
                return Self(number);
            }
            k += 1;
        }
        panic!("a code that is not in the table");
    }

    /// The entry of a text such as `P0123` or `123`.
    #[must_use]
    pub fn find(text: &str) -> Option<&'static Entry> {
        let digits = text.trim_start_matches(['P', 'p']);
        let number: u16 = digits.parse().ok()?;
        TABLE.iter().find(|entry| entry.code.0 == number)
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "P{:04}", self.0)
    }
}

impl Serialize for Code {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

/// What a code means.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The code.
    pub code: Code,
    /// What is wrong, in one line.
    pub title: &'static str,
    /// What to do.
    pub advice: &'static str,
    /// Something that has this code.
    pub example: Example,
}

/// Something that has a code.
#[derive(Clone, Copy, Debug)]
pub enum Example {
    /// A scene on standard input of the command `pfaff` with these arguments.
    Scene(&'static str, &'static str),
    /// The command `pfaff` with these arguments.
    Command(&'static str),
    /// Why no example can be given in a few lines.
    None(&'static str),
}

/// The page of the book with all codes.
#[must_use]
pub fn page() -> String {
    let mut page = "# Codes of errors and warnings\n\n\
        This page is written by `pfaff explain --book`. Each error begins with its code, as in `error[P0102]`, and has \
        it as `code` in a document; `pfaff explain P0102` shows one entry. A code keeps its meaning.\n"
        .to_owned();
    for entry in TABLE {
        page.push_str(&format!(
            "\n## {}\n\n{}.\n\n{}\n",
            entry.code, entry.title, entry.advice
        ));
        match entry.example {
            Example::Scene(arguments, scene) => page.push_str(&format!(
                "\n`pfaff {arguments}` with this scene:\n\n```text\n{}\n```\n",
                scene.trim()
            )),
            Example::Command(arguments) => {
                page.push_str(&format!("\nFor example `pfaff {arguments}`.\n"));
            }
            Example::None(_) => {}
        }
    }
    page
}
