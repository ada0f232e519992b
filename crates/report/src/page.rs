//! Common parts of all pages: start and end, style, and format of numbers.

use std::fmt::Write;

use crate::figures::escape;
use crate::work_precision::Provenance;

/// The colours depend on the colour scheme of the reader, like the colours of the figure.
const STYLE: &str = "
:root { color-scheme: light dark; --ink: #222; --grey: #5f6870; --line: #d5d9dd; --page: #fff; --best: #e3f2e8; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8eaec; --grey: #a3abb3; --line: #343a41; --page: #14171a; --best: #1d3a29; }
}
body { font: 15px/1.5 Helvetica, Arial, 'Liberation Sans', sans-serif; color: var(--ink); background: var(--page);
  max-width: 1140px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { font-size: 1.2em; margin-top: 2.2em; border-top: 1px solid var(--line); padding-top: 1em; }
p, li { max-width: 64em; } .grey { color: var(--grey); }
svg { max-width: 100%; height: auto; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: 2px 9px; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { font-weight: 600; } .name { text-align: left; } .best { background: var(--best); }
td.status { text-align: left; white-space: normal; min-width: 14em; }
@media print { body { max-width: none; margin: 0; } svg, tr { break-inside: avoid; } .wide { overflow: visible; } }
details { margin: .8em 0; } summary { cursor: pointer; }
dt { font-weight: 600; } dd { margin: 0 0 .3em 1.5em; }
";

/// Content security policy: a page without scripts that loads no resources.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

/// The start of a page, up to its title.
#[must_use]
pub fn open(title: &str) -> String {
    let title = safe(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"generator\" content=\"pfaff {}\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n",
        env!("CARGO_PKG_VERSION")
    )
}

/// The end of a page, with its provenance.
pub fn close(page: &mut String, p: &Provenance) {
    page.push_str("<h2>How this page was made</h2>\n<dl>\n");
    for (what, value) in [
        ("Machine", &p.machine),
        ("Versions", &p.versions),
        ("Date", &p.date),
        ("Command", &p.command),
    ] {
        add(
            page,
            format_args!("<dt>{what}</dt><dd>{}</dd>\n", safe(value)),
        );
    }
    page.push_str("</dl>\n</body>\n</html>\n");
}

/// Writes sentences as a list.
pub fn list(page: &mut String, sentences: &[String]) {
    if sentences.is_empty() {
        return;
    }
    page.push_str("<ul>\n");
    for sentence in sentences {
        add(page, format_args!("<li>{}</li>\n", safe(sentence)));
    }
    page.push_str("</ul>\n");
}

/// An error with two digits.
#[must_use]
pub fn short(number: f64) -> String {
    match number.is_finite() {
        true if number == 0.0 => "0".to_owned(),
        true => format!("{number:.1e}"),
        false if number.is_nan() => "–".to_owned(),
        false => "∞".to_owned(),
    }
}

/// A time with three digits in a suitable unit.
#[must_use]
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "–".to_owned();
    }
    let units = [(1.0, "s"), (1e-3, "ms"), (1e-6, "µs")];
    let (unit, name) = units
        .into_iter()
        .find(|(u, _)| seconds >= *u)
        .unwrap_or(units[2]);
    let value = seconds / unit;
    let decimals = match value {
        100.0.. => 0,
        10.0.. => 1,
        _ => 2,
    };
    format!("{value:.decimals$} {name}")
}

/// Escapes text for a page.
#[must_use]
pub fn safe(text: &str) -> String {
    let mut out = String::new();
    escape(text, &mut out);
    out
}

/// Adds formatted text.
pub fn add(page: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = page.write_fmt(text);
}
