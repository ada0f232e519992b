//! Names of a file as names of a scene: each once, and none that a scene refuses.

use std::collections::{HashMap, HashSet};

use crate::findings::Findings;
use crate::limits::LONGEST_NAME;

/// The name of what does not move, which no body of a scene may have.
const GROUND: &str = "ground";

/// Names of one kind that are taken.
#[derive(Default)]
pub(crate) struct Names {
    taken: HashSet<String>,
    /// The next number of names that were wanted again.
    numbers: HashMap<String, usize>,
}

impl Names {
    /// A name for a scene: the given one if it is free, else with a number.
    pub(crate) fn take(&mut self, name: &str, findings: &mut Findings) -> String {
        let free = self.free(name);
        if free != name {
            let (clean, own) = (fit(name), name.trim());
            let remark = match own {
                GROUND => format!("`{GROUND}` is reserved: it is called `{free}` here."),
                _ => format!("`{clean}` is called `{free}` here."),
            };
            findings.remarks.push(remark);
        }
        free
    }

    /// The same for a name that the file does not contain.
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

/// A name without signs that a scene refuses.
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
        let reserved = "`ground` is reserved: it is called `ground of the file` here.";
        assert_eq!(findings.remarks[1], reserved);
    }
}
