//! Shortens a text that causes a failure, so that the text still causes the failure. Ranges of
//! lines are removed first, beginning with long ranges; parts of lines follow. Source: Zeller and
//! Hildebrandt 2002, doi 10.1109/32.988498, without complements.

/// Shortens a text while `fails` is true for the shortened text.
#[must_use]
pub fn shortest(text: &str, mut fails: impl FnMut(&str) -> bool) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    loop {
        let before = lines.clone();
        shorten(&mut lines, |lines| fails(&lines.join("\n")));
        for k in 0..lines.len() {
            let mut words: Vec<String> = words(&lines[k]);
            shorten(&mut words, |words| {
                let mut all = lines.clone();
                all[k] = words.concat();
                fails(&all.join("\n"))
            });
            lines[k] = words.concat();
        }
        if lines == before {
            return lines.join("\n") + "\n";
        }
    }
}

/// Removes parts that are not needed for the failure. The length of the removed ranges is halved in
/// each pass.
fn shorten(pieces: &mut Vec<String>, mut fails: impl FnMut(&[String]) -> bool) {
    let mut length = pieces.len().div_ceil(2);
    while length > 0 {
        let mut at = 0;
        while at < pieces.len() {
            let end = (at + length).min(pieces.len());
            let rest = [&pieces[..at], &pieces[end..]].concat();
            if fails(&rest) {
                *pieces = rest;
            } else {
                at = end;
            }
        }
        length = match length {
            1 => 0,
            n => n.div_ceil(2),
        };
    }
}

/// Returns the words of a line; separators belong to the preceding word.
fn words(line: &str) -> Vec<String> {
    line.split_inclusive([',', ' '])
        .map(str::to_owned)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_matters_is_left() {
        let text = "a\nb = [1, 2, 3]\nc\nd\ne\n";
        let fails = |text: &str| text.contains('2') && text.contains('d');
        assert_eq!(shortest(text, fails), "2,\nd\n");
    }
}
