//! Dependencies as sentences.

use linalg::Circuit;
use model::Layout;

/// What a circuit means for the one who reads it. Nothing is said of sums that would be unique: rows may take part in other
/// circuits too.
pub(crate) fn describe(circuit: &Circuit, layout: &Layout) -> String {
    let labels: Vec<String> = circuit
        .rows
        .iter()
        .map(|&i| layout.labels[i].to_string())
        .collect();
    match labels.as_slice() {
        [row] => format!("row {row} constrains nothing here: its multiplier is not determined"),
        [a, b] => format!(
            "rows {a} and {b} forbid the same motion: how a load is shared between them is not determined \
             (forces in the ratio {} cancel out)",
            ratio(circuit)
        ),
        rows => format!(
            "of the rows {}, any {} imply the remaining one: how a load is shared among them is not determined \
             (forces in the ratio {} cancel out)",
            rows.join(", "),
            rows.len() - 1,
            ratio(circuit)
        ),
    }
}

/// Coefficients with the signs that are mostly positive, without trailing zeros.
fn ratio(circuit: &Circuit) -> String {
    let negative = circuit.coefficients.iter().filter(|c| **c < 0.0).count();
    let sign = if 2 * negative > circuit.coefficients.len() {
        -1.0
    } else {
        1.0
    };
    let parts: Vec<String> = circuit
        .coefficients
        .iter()
        .map(|c| short(sign * c))
        .collect();
    parts.join(" : ")
}

/// Four significant digits, a true minus sign.
fn short(x: f64) -> String {
    let size = x.abs();
    let text = match size {
        1e-3..1e4 => {
            let digits = (3.0 - size.log10().floor()).max(0.0) as usize;
            let text = format!("{x:.digits$}");
            match text.contains('.') {
                true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
                false => text,
            }
        }
        _ => format!("{x:.3e}"),
    };
    text.replace('-', "−")
}
