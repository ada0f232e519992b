//! Figures as PNG: what every command says of them.

use pfaff::report::PngError;
use pfaff::report::figures::check_png;

use crate::output::Failure;

/// Refuses what cannot be painted before a long computation.
pub(crate) fn can_paint(scale: Option<f64>) -> Result<(), Failure> {
    check_png(scale).map_err(|e| unpainted(&e))
}

/// A figure that was not painted.
pub(crate) fn unpainted(error: &PngError) -> Failure {
    match error {
        PngError::Figure { .. } | PngError::Packing { .. } => Failure::stopped(error.to_string()),
        _ => Failure::input(error.to_string()),
    }
}

/// A line on characters that are boxes; empty if there are none.
pub(crate) fn missing(boxes: &str) -> String {
    if boxes.is_empty() {
        return String::new();
    }
    let named = boxes.chars().map(|c| match c {
        c if c.is_alphanumeric() => format!("`{c}`"),
        c => format!("U+{:04X}", u32::from(c)),
    });
    let named: Vec<String> = named.collect();
    format!("boxes, as no font here has them: {}\n", named.join(", "))
}
