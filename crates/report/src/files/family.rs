//! The files that one command writes into a directory.

/// The possible file names of one kind of result. In a name, `*` represents a number.
///
/// ```
/// use pfaff_report::Family;
/// const PAGES: Family = Family(&["modes.csv", "mode-*.html"]);
/// assert!(PAGES.has("modes.csv") && PAGES.has("mode-12.html"));
/// assert!(!PAGES.has("mode-.html") && !PAGES.has("mode-1a.html"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Family(pub &'static [&'static str]);

impl Family {
    /// Whether a file with this name can belong to the family.
    #[must_use]
    pub fn has(self, name: &str) -> bool {
        self.0.iter().any(|pattern| match pattern.split_once('*') {
            None => *pattern == name,
            Some((before, after)) => {
                let number = name.strip_prefix(before);
                let number = number.and_then(|rest| rest.strip_suffix(after));
                number.is_some_and(|number| {
                    !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit())
                })
            }
        })
    }
}
