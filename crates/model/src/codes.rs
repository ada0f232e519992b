//! Stable codes of errors and warnings, and the meanings of the codes. The codes are defined on one
//! page, `codes/codes.md`; the command `pfaff explain` and the book print this page. A code is
//! never reused for another meaning. Each error enum returns its codes in `code()`, by a `match`
//! over all variants.
//!
//! Codes below 100 concern the command and its files. Codes from 100 concern the text of a scene,
//! from 200 its initial state and its rank, from 300 requests, from 400 simulations, from 500
//! sweeps, and from 600 imported files.

mod entry;

use std::fmt;

use serde::{Serialize, Serializer};

pub use entry::{Entry, Example, entries};

/// The page with all codes, as printed in the book.
pub const PAGE: &str = include_str!("codes/codes.md");

/// For each number, whether the page has a heading with this code number, for example `## P0123`.
const IS_CODE: [bool; 1000] = {
    const fn digit(byte: u8) -> usize {
        (byte - b'0') as usize
    }
    let page = PAGE.as_bytes();
    let mut codes = [false; 1000];
    let mut k = 8;
    while k < page.len() {
        if page[k - 8] == b'\n' && page[k - 7] == b'#' && page[k - 4] == b'P' {
            let [a, b, c] = [digit(page[k - 2]), digit(page[k - 1]), digit(page[k])];
            codes[100 * a + 10 * b + c] = true;
        }
        k += 1;
    }
    codes
};

/// The code of an error or a warning, written as `P0123`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(u16);

impl Code {
    /// Returns the code with this number. In a `const` block, a number without a heading on the
    /// page is a compilation error.
    ///
    /// # Panics
    /// Panics if the page has no such code.
    #[must_use]
    pub const fn new(number: u16) -> Self {
        assert!(
            (number as usize) < IS_CODE.len() && IS_CODE[number as usize],
            "a code that is missing from the page"
        );
        Self(number)
    }

    /// Returns the page entry for a text such as `P0123` or `123`.
    #[must_use]
    pub fn find(text: &str) -> Option<&'static Entry> {
        let digits = text.trim_start_matches(['P', 'p']);
        let number: u16 = digits.parse().ok()?;
        entries().iter().find(|entry| entry.code.0 == number)
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "P{:04}", self.0)
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Code {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Code".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "string", "pattern": "^P[0-9]{4}$" })
    }
}

impl Serialize for Code {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}
