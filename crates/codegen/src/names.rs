//! Conversion of type names into names of modules and scene types.

/// `PinInSlot` → `pin_in_slot`
#[must_use]
pub fn snake_case(name: &str) -> String {
    separated(name, '_')
}

/// `PinInSlot` → `pin-in-slot`
#[must_use]
pub fn kebab_case(name: &str) -> String {
    separated(name, '-')
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
