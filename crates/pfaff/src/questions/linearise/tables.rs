//! Tables of a linearised motion: each matrix, and the modes.

use report::{Table, TableError, matrix_table};

use super::answer::LineariseAnswer;

/// Returns matrices with the names of their files. The name of each matrix is a letter.
pub(super) fn matrices(of: &LineariseAnswer) -> Result<Vec<(&'static str, Vec<u8>)>, TableError> {
    let states: Vec<String> = of.states.iter().map(|state| state.name.clone()).collect();
    let inputs = of.inputs.iter().map(|i| format!("{}.{}", i.name, i.what));
    let inputs: Vec<String> = inputs.collect();
    let positions = &states[..of.positions];
    let mut all = vec![("a.csv", "A", &of.a, states.as_slice())];
    if !inputs.is_empty() {
        all.push(("b.csv", "B", &of.b, &inputs));
    }
    if let Some(second) = &of.second_order {
        all.extend([
            ("m.csv", "M", &second.mass, positions),
            ("d.csv", "D", &second.damping, positions),
            ("k.csv", "K", &second.stiffness, positions),
        ]);
    }
    let written = all.into_iter().map(|(file, letter, matrix, columns)| {
        let rows = states.iter().zip(matrix.iter().map(Vec::as_slice));
        Ok((file, matrix_table(letter, columns, rows)?))
    });
    written.collect()
}

/// Writes the eigenvalue, the damped and undamped frequency, the damping ratio and the shape of
/// each mode. Cells without a value are empty.
pub(super) fn modes(file: &'static str, of: &LineariseAnswer) -> Result<Vec<u8>, TableError> {
    let known = [
        "mode",
        "real",
        "imaginary",
        "frequency",
        "natural_frequency",
        "damping_ratio",
    ];
    let mut header: Vec<String> = known.map(str::to_owned).to_vec();
    for state in &of.states {
        header.extend(["re", "im"].map(|part| format!("{}.{part}", state.name)));
    }
    let mut table = Table::new(file, Vec::new(), &header)?;
    for (k, mode) in of.modes.iter().flatten().enumerate() {
        let known = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
        let mut row = vec![
            (k + 1).to_string(),
            mode.real.to_string(),
            mode.imaginary.to_string(),
            mode.frequency.to_string(),
            known(mode.natural_frequency),
            known(mode.damping_ratio),
        ];
        let shape = mode.shape.0.iter().flat_map(|(_, z)| z);
        row.extend(shape.map(f64::to_string));
        table.record(&row)?;
    }
    table.finish()
}
