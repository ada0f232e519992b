//! Tests the terms of other programs. The page of the book lists the terms that the reader
//! recognises, and each term refers to an element of a scene or of the command.

use std::collections::BTreeSet;

use model::Registry;
use pfaff_scene::ELSEWHERE;

const PAGE: &str = include_str!("../../../../docs/book/words.md");

/// Returns the texts between grave accents.
fn quoted(cell: &str) -> impl Iterator<Item = &str> {
    cell.split('`').skip(1).step_by(2)
}

#[test]
fn the_book_lists_the_words_that_hints_know() {
    let rows = PAGE.lines().filter(|line| line.starts_with("| `"));
    let listed: Vec<(&str, &str)> = rows
        .flat_map(|row| {
            let (words, here) = row.trim_matches('|').split_once('|').expect("two columns");
            let here = quoted(here).next().expect("a word");
            quoted(words).map(move |word| (word, here))
        })
        .collect();
    let [listed_once, known] =
        [&listed[..], ELSEWHERE].map(|pairs| pairs.iter().copied().collect::<BTreeSet<_>>());
    assert_eq!(listed.len(), listed_once.len(), "a word is listed twice");
    assert_eq!(listed_once, known);
}

#[test]
fn each_word_leads_to_something_that_is_there() {
    let schema = pfaff_scene::schema(&Registry::standard()).to_string();
    for (word, here) in ELSEWHERE {
        let is_option = here.starts_with("--");
        assert!(
            is_option || schema.contains(&format!("\"{here}\"")),
            "`{word}` leads to `{here}`, which no scene has"
        );
    }
}
