//! Parsers for values of options.

/// Parses a joint and a value of its coordinate.
pub(super) fn joint_value(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.rsplit_once('=').ok_or("expected JOINT=VALUE")?;
    let number = value.trim().parse().ok().filter(|x: &f64| x.is_finite());
    let number = number.ok_or_else(|| format!("`{value}` is not a finite number"))?;
    Ok((name.trim().to_owned(), number))
}
