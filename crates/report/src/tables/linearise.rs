//! Tables of a linearised motion: `a.csv` to `k.csv`, and `modes.csv`.

use std::io::Write;

use super::{Table, TableError};
use crate::documents::LinearisationDocument;

/// A matrix of a linearised motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatrixTable {
    /// A of `ẋ = A·x + B·u`.
    A,
    /// B.
    B,
    /// M of `M·ÿ + D·ẏ + K·y`.
    M,
    /// D.
    D,
    /// K.
    K,
}

impl MatrixTable {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::A, Self::B, Self::M, Self::D, Self::K];

    /// Name of its file.
    #[must_use]
    pub fn file(self) -> &'static str {
        match self {
            Self::A => "a.csv",
            Self::B => "b.csv",
            Self::M => "m.csv",
            Self::D => "d.csv",
            Self::K => "k.csv",
        }
    }

    /// Writes the matrix: its letter and the names of the columns, then the name of each row and
    /// its numbers. Returns `None` if the linearisation has no such matrix.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn write<W: Write>(
        self,
        of: &LinearisationDocument,
        out: W,
    ) -> Result<Option<W>, TableError> {
        let second = of.second_order.as_ref();
        let (letter, matrix) = match self {
            Self::A => ("A", Some(&of.a)),
            Self::B => ("B", Some(&of.b).filter(|_| !of.inputs.is_empty())),
            Self::M => ("M", second.map(|s| &s.mass)),
            Self::D => ("D", second.map(|s| &s.damping)),
            Self::K => ("K", second.map(|s| &s.stiffness)),
        };
        let Some(matrix) = matrix else {
            return Ok(None);
        };
        let states = || of.states.iter().map(|state| state.name.clone());
        let columns: Vec<String> = match self {
            Self::A => states().collect(),
            Self::B => of
                .inputs
                .iter()
                .map(|input| format!("{}.{}", input.name, input.what))
                .collect(),
            _ => states().take(of.positions).collect(),
        };
        let header: Vec<String> = std::iter::once(letter.to_owned()).chain(columns).collect();
        let mut table = Table::new(self.file(), out, &header)?;
        for (name, row) in states().zip(matrix) {
            let numbers = row.iter().map(f64::to_string);
            table.record(std::iter::once(name).chain(numbers).collect::<Vec<_>>())?;
        }
        table.finish().map(Some)
    }
}

/// Writes `modes.csv`: eigenvalue, frequency with and without its damping, damping ratio and shape
/// of each mode; empty where there is no such value.
///
/// # Errors
/// - [`TableError::Write`]: the writer failed.
pub fn modes_table<W: Write>(of: &LinearisationDocument, out: W) -> Result<W, TableError> {
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
    let mut table = Table::new("modes.csv", out, &header)?;
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
