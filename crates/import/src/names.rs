//! Converts names of a file to names of a scene. Each resulting name is unique and valid in a
//! scene.

use std::collections::{HashMap, HashSet};

use crate::findings::Findings;
use crate::limits::LONGEST_NAME;

/// The name of the ground; no body of a scene may have this name.
const GROUND: &str = "ground";

/// The used names of one kind.
#[derive(Default)]
pub(crate) struct Names {
    taken: HashSet<String>,
    /// The next number to append to a repeated name.
    numbers: HashMap<String, usize>,
}

impl Names {
    /// Returns a name for a scene: the given name if it is not in use, otherwise the given name
    /// with a number.
    pub(crate) fn take(&mut self, name: &str, findings: &mut Findings) -> String {
        let free = self.free(name);
        if free != name {
            let (clean, own) = (fit(name), name.trim());
            let remark = match own {
                GROUND => {
                    format!("`{GROUND}` is a reserved name: the link is renamed to `{free}`.")
                }
                _ => format!("`{clean}` is called `{free}` here."),
            };
            findings.remarks.push(remark);
        }
        free
    }

    /// Returns an unused name that does not come from the file.
    pub(crate) fn free(&mut self, name: &str) -> String {
        let clean = fit(name);
        let mut free = clean.clone();
        let mut number = self.numbers.get(&clean).copied().unwrap_or(2);
        while self.taken.contains(&free) {
            free = format!("{clean} {number}");
            number += 1;
        }
        self.numbers.insert(clean, number);
        self.taken.insert(free.clone());
        free
    }
}

/// A name without characters that a scene rejects.
fn fit(name: &str) -> String {
    let clean: String = name
        .trim()
        .chars()
        .take(LONGEST_NAME)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    match clean.chars().next() {
        None => "unnamed".to_owned(),
        Some('=' | '+' | '-' | '@') => format!("_{clean}"),
        Some(_) if clean == GROUND => "ground of the file".to_owned(),
        Some(_) => clean,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_made_fit_and_told() {
        let (mut names, mut findings) = (Names::default(), Findings::default());
        let mut take = |name| names.take(name, &mut findings);
        assert_eq!(take("arm"), "arm");
        assert_eq!(take("arm"), "arm 2");
        assert_eq!(take("ground"), "ground of the file");
        assert_eq!(take("-x"), "_-x");
        assert_eq!(take("a\nb"), "a b");
        assert_eq!(take(&"n".repeat(2000)).len(), LONGEST_NAME);
        assert_eq!(findings.remarks.len(), 5);
        let reserved = "`ground` is a reserved name: the link is renamed to `ground of the file`.";
        assert_eq!(findings.remarks[1], reserved);
    }
}
