//! Hints for misspelt names.

/// Largest number of edits between a name and a hint.
const EDITS: usize = 2;

/// Returns the text `; did you mean …?`, or the list of the known names.
pub(crate) fn hint(text: &str, known: &[&str]) -> String {
    let nearest = known
        .iter()
        .map(|k| (distance(text, k), *k))
        .min()
        // A name with more than half of its letters changed is not similar.
        .filter(|(d, k)| *d <= EDITS && 2 * *d <= k.chars().count());
    match nearest {
        Some((_, k)) => format!("; did you mean `{k}`?"),
        None if known.is_empty() => String::new(),
        None => format!("; known are {}", list(known)),
    }
}

/// Returns the list of words in the form `a`, `b`, `c`.
pub(crate) fn list(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|w| format!("`{w}`")).collect();
    quoted.join(", ")
}

/// Returns the Levenshtein distance.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let substitution = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = substitution.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::{distance, hint};

    #[test]
    fn distances_of_the_textbook() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("phi", "phi"), 0);
    }

    #[test]
    fn a_near_name_is_proposed_and_a_far_one_is_not() {
        assert_eq!(hint("phy", &["rows", "phi"]), "; did you mean `phi`?");
        assert_eq!(hint("q", &["a", "b"]), "; known are `a`, `b`");
        assert_eq!(hint("q", &[]), "");
    }
}
