//! Dependencies as sentences.

use linalg::Circuit;
use model::Layout;

/// What a circuit means for the one who reads it.
pub(crate) fn describe(circuit: &Circuit, layout: &Layout) -> String {
    let label = |i: usize| {
        let label = &layout.labels[i];
        format!("{} of {}", label.row, label.joint)
    };
    match circuit.rows.as_slice() {
        [row] => format!(
            "row {} ({}) constrains nothing here: its multiplier is not determined.",
            row + 1,
            label(*row)
        ),
        [a, b] => format!(
            "rows {} ({}) and {} ({}) forbid the same motion: only the combination {} of their forces is \
             determined, not each of them.",
            a + 1,
            label(*a),
            b + 1,
            label(*b),
            determined(circuit, layout)
        ),
        rows => {
            let list: Vec<String> = rows
                .iter()
                .map(|&i| format!("{} ({})", i + 1, label(i)))
                .collect();
            format!(
                "any {} of the rows {} imply the remaining one: forces on them in the ratio {} cancel out and move \
                 nothing, so none of these rows has a force of its own that the model determines.",
                rows.len() - 1,
                list.join(", "),
                ratio(circuit)
            )
        }
    }
}

/// The combination of two rows that stays the same: orthogonal to (c₁, c₂).
fn determined(circuit: &Circuit, layout: &Layout) -> String {
    let [a, b] = [circuit.rows[0], circuit.rows[1]];
    let [ca, cb] = [circuit.coefficients[0], circuit.coefficients[1]];
    let (ja, jb) = (&layout.labels[a].joint, &layout.labels[b].joint);
    let factor = -ca / cb;
    let sign = if factor < 0.0 { '−' } else { '+' };
    match (factor.abs() - 1.0).abs() < 1e-9 {
        true => format!("{ja} {sign} {jb}"),
        false => format!("{ja} {sign} {:.4}·{jb}", factor.abs()),
    }
}

fn ratio(circuit: &Circuit) -> String {
    let parts: Vec<String> = circuit
        .coefficients
        .iter()
        .map(|c| format!("{c:.4}"))
        .collect();
    parts.join(" : ")
}
