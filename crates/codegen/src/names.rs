//! Conversion of type names into names of modules and scene types, and of words into type names.

/// Converts a name as in `PinInSlot` → `pin_in_slot`.
#[must_use]
pub fn snake_case(name: &str) -> String {
    separated(name, '_')
}

/// Converts a name as in `PinInSlot` → `pin-in-slot`.
#[must_use]
pub fn kebab_case(name: &str) -> String {
    separated(name, '-')
}

/// Converts words as in `in-slot`, `in_slot` → `InSlot`.
pub(crate) fn camel_case(name: &str) -> String {
    let mut out = String::new();
    for word in name.split(['_', '-']) {
        let mut letters = word.chars();
        out.extend(letters.next().map(|c| c.to_ascii_uppercase()));
        out.push_str(letters.as_str());
    }
    out
}

fn separated(name: &str, separator: char) -> String {
    let mut out = String::new();
    for (k, c) in name.chars().enumerate() {
        if c.is_uppercase() && k > 0 {
            out.push(separator);
        }
        out.extend(c.to_lowercase());
    }
    out
}
