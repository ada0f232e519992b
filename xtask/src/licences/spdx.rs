//! The allowed licences, and the choice between several licences of a crate.

/// Allowed licences in the order of preference, with the reason for each licence.
pub(super) const ALLOWED: [(&str, &str); 11] = [
    (
        "MIT",
        "requires its text and the names of the authors, listed below",
    ),
    (
        "Apache-2.0",
        "the same, with the notices of the authors; patents are granted",
    ),
    (
        "Zlib",
        "requires marks in changed sources; no source was changed",
    ),
    ("BSD-2-Clause", "as MIT"),
    (
        "BSD-3-Clause",
        "as MIT, and no advertising with the names of the authors",
    ),
    ("ISC", "as MIT"),
    ("BSL-1.0", "as MIT, for sources only"),
    ("Unicode-3.0", "as MIT, for tables of characters"),
    (
        "Apache-2.0 WITH LLVM-exception",
        "as Apache-2.0, without conditions on programs",
    ),
    ("0BSD", "asks for nothing"),
    ("Unlicense", "asks for nothing"),
];

/// Returns the licences of an SPDX expression that are chosen for a crate. All parts of an `AND`
/// are chosen, and the first allowed part of an `OR`.
pub(super) fn taken(expression: &str) -> Result<Vec<&'static str>, String> {
    // Before SPDX, crates wrote `A/B` for `A OR B`.
    let spaced = expression
        .replace('/', " OR ")
        .replace('(', " ( ")
        .replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut at = 0;
    let found = any(&words, &mut at).filter(|_| at == words.len());
    let ranks = found.ok_or_else(|| format!("`{expression}` has no licence that is allowed"))?;
    Ok(ranks.into_iter().map(|rank| ALLOWED[rank].0).collect())
}

/// Ranks of the chosen licences, `None` if no combination is allowed.
type Ranks = Option<Vec<usize>>;

fn any(words: &[&str], at: &mut usize) -> Ranks {
    let mut best = all(words, at);
    while words.get(*at) == Some(&"OR") {
        *at += 1;
        let other = all(words, at);
        best = match (best, other) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
    }
    best
}

fn all(words: &[&str], at: &mut usize) -> Ranks {
    let mut ranks = one(words, at);
    while words.get(*at) == Some(&"AND") {
        *at += 1;
        let more = one(words, at);
        ranks = ranks.zip(more).map(|(mut a, b)| {
            a.extend(b);
            a
        });
    }
    ranks
}

fn one(words: &[&str], at: &mut usize) -> Ranks {
    let word = *words.get(*at)?;
    *at += 1;
    if word == "(" {
        let ranks = any(words, at);
        let is_closed = words.get(*at) == Some(&")");
        *at += 1;
        return ranks.filter(|_| is_closed);
    }
    let mut name = word.to_owned();
    if words.get(*at) == Some(&"WITH") {
        name = format!("{word} WITH {}", words.get(*at + 1)?);
        *at += 2;
    }
    let rank = ALLOWED.iter().position(|(allowed, _)| *allowed == name)?;
    Some(vec![rank])
}

#[cfg(test)]
mod tests {
    use super::taken;

    #[test]
    fn the_first_allowed_licence_is_taken() {
        for (expression, expected) in [
            ("MIT", &["MIT"][..]),
            ("Apache-2.0 OR MIT", &["MIT"]),
            ("Unlicense/MIT", &["MIT"]),
            ("Apache-2.0 OR BSL-1.0", &["Apache-2.0"]),
            ("GPL-3.0-only OR Zlib", &["Zlib"]),
            (
                "(MIT OR Apache-2.0) AND Unicode-3.0",
                &["MIT", "Unicode-3.0"],
            ),
            (
                "Apache-2.0 WITH LLVM-exception",
                &["Apache-2.0 WITH LLVM-exception"],
            ),
        ] {
            assert_eq!(taken(expression).as_deref(), Ok(expected), "{expression}");
        }
    }

    #[test]
    fn others_are_refused() {
        for expression in [
            "",
            "GPL-3.0-only",
            "MIT AND GPL-3.0-only",
            "(MIT",
            "MIT)",
            "MIT WITH",
        ] {
            let message = taken(expression).expect_err(expression);
            assert!(message.contains("no licence that is allowed"), "{message}");
        }
    }
}
