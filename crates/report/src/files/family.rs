//! The files that one command writes into a directory.

/// The possible file names of one kind of result. In a name, `*` represents a number and `<name>`
/// any text.
///
/// ```
/// use pfaff_report::Family;
/// const PAGES: Family = Family(&["modes.csv", "mode-*.html", "body_<name>.csv"]);
/// assert!(PAGES.has("modes.csv") && PAGES.has("mode-12.html") && PAGES.has("body_arm.csv"));
/// assert!(!PAGES.has("mode-.html") && !PAGES.has("mode-1a.html") && !PAGES.has("body_arm.txt"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Family(pub &'static [&'static str]);

impl Family {
    /// Whether a file with this name can belong to the family.
    #[must_use]
    pub fn has(self, name: &str) -> bool {
        self.0.iter().any(|pattern| {
            let between = |wildcard: &str| {
                let (before, after) = pattern.split_once(wildcard)?;
                name.strip_prefix(before)?.strip_suffix(after)
            };
            let is_number =
                |text: &str| !text.is_empty() && text.bytes().all(|digit| digit.is_ascii_digit());
            *pattern == name
                || between("*").is_some_and(is_number)
                || between("<name>").is_some_and(|text| !text.is_empty())
        })
    }
}
