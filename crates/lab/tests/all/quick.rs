//! Runs the fast families in the same way as the command.

use std::num::NonZeroUsize;

use lab::stress::Tally;

#[test]
fn nothing_is_silently_wrong() {
    let names = [
        "trivial",
        "starts",
        "massless",
        "bad-numbers",
        "duplicates",
        "singular",
    ];
    let families: Vec<_> = names
        .iter()
        .map(|name| lab::stress::find(name).unwrap_or_else(|| panic!("no family {name}")))
        .collect();
    let two = NonZeroUsize::MIN.saturating_add(1);
    let rows = lab::stress::run(&families, two, &|| false, |_| {});
    let failing: Vec<_> = rows.iter().filter(|row| !row.judgement.passes()).collect();
    assert!(failing.is_empty(), "{failing:#?}");
    let tally = Tally::of(rows.iter().map(|row| row.judgement));
    assert_eq!(tally.silently_wrong, 0);
    assert!(tally.right > 100 && tally.refused > 100, "{tally:?}");
}

#[test]
fn names_of_families_differ() {
    let mut names: Vec<&str> = lab::stress::families().iter().map(|f| f.name).collect();
    names.sort_unstable();
    let all = names.len();
    names.dedup();
    assert_eq!(names.len(), all);
}
