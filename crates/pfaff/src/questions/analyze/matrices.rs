//! The matrices of the constraints with the names of their rows and columns.

mod answer;

use std::iter;

use model::System;
use report::{TableError, matrix_table};
use solvability::ONE_PART;

pub use answer::{MatricesDocument, MatrixRowDocument};
use answer::{PHI_Q, PSI};

use super::addition::Addition;
use super::options::Analyze;
use crate::configuration::ConfigurationAnalysis;
use crate::documents::AnalysisDocument;
use crate::error::StudyError;
use crate::refusal::Refusal;
use crate::words::{Block, Cell};

/// Width of the columns of one table (characters).
const WIDTH: usize = 90;

/// Matrices at the configuration.
pub(super) struct Matrices;

impl Addition for Matrices {
    fn check(&self, asked: &Analyze, of: &ConfigurationAnalysis<'_>) -> Result<(), Refusal> {
        let rows = of.mechanism.layout().rows();
        if !asked.matrices || rows <= ONE_PART {
            return Ok(());
        }
        Err(Refusal::input(format!(
            "--matrices prints at most {ONE_PART} rows, the mechanism has {rows}; `Scene.matrices` of Python returns larger matrices"
        )))
    }

    fn add(
        &self,
        asked: &Analyze,
        of: &ConfigurationAnalysis<'_>,
        document: &mut AnalysisDocument,
    ) -> Result<(), StudyError> {
        if asked.matrices {
            document.answers.matrices = Some(MatricesDocument::of(of));
        }
        Ok(())
    }

    fn words(&self, d: &AnalysisDocument) -> Vec<Block> {
        let Some(matrices) = &d.answers.matrices else {
            return Vec::new();
        };
        let [phi_q, psi] = [PHI_Q, PSI].map(|kind| matrices.rows_of(kind));
        let mut out = vec![Block::Heading(
            "Matrices in SI units (C is Φq above Ψ; C·v̇ = Γ):".to_owned(),
        )];
        for (name, rows) in [("Φq", phi_q), ("Ψ", psi)] {
            for columns in chunks(&matrices.columns) {
                let used = rows
                    .iter()
                    .filter(|(_, row)| !columns.clone().all(|j| row[j] == 0.0));
                let lines: Vec<Vec<Cell>> = used
                    .map(|(label, row)| {
                        let entries = columns.clone().map(|j| Cell::quantity(row[j], ""));
                        iter::once(label.as_str().into()).chain(entries).collect()
                    })
                    .collect();
                if !lines.is_empty() {
                    let names = columns.map(|j| matrices.columns[j].as_str().into());
                    let head = iter::once(name.into()).chain(names).collect();
                    out.push(Block::Table(iter::once(head).chain(lines).collect()));
                }
            }
        }
        let gamma = matrices.gamma.iter().flatten();
        let gamma = matrices.rows.iter().zip(gamma);
        let lines: Vec<[Cell; 2]> = gamma
            .map(|(row, x)| [row.label().into(), Cell::quantity(*x, "")])
            .collect();
        if !lines.is_empty() {
            out.push(Block::table(["row", "Γ"], lines));
        }
        out
    }

    fn files(&self, d: &AnalysisDocument) -> Result<Vec<(&'static str, Vec<u8>)>, TableError> {
        let Some(matrices) = &d.answers.matrices else {
            return Ok(Vec::new());
        };
        let [phi_q, psi] = [PHI_Q, PSI].map(|kind| matrices.rows_of(kind));
        let columns = &matrices.columns;
        let [phi_q, psi] = [&phi_q, &psi].map(|rows| rows.iter().map(|(label, row)| (label, *row)));
        let all = phi_q.clone().chain(psi.clone());
        let mut files = vec![
            ("phi_q.csv", matrix_table("phi_q", columns, phi_q)?),
            ("psi.csv", matrix_table("psi", columns, psi)?),
            ("c.csv", matrix_table("c", columns, all)?),
        ];
        if let Some(gamma) = &matrices.gamma {
            let labels = matrices.rows.iter().map(MatrixRowDocument::label);
            let labels: Vec<String> = labels.collect();
            let rows = labels.iter().zip(gamma.chunks(1));
            files.push((
                "gamma.csv",
                matrix_table("row", &["gamma".to_owned()], rows)?,
            ));
        }
        Ok(files)
    }
}

/// Splits the columns into ranges that fit on a page.
fn chunks(columns: &[String]) -> Vec<std::ops::Range<usize>> {
    let mut out: Vec<std::ops::Range<usize>> = Vec::new();
    let mut width = 0;
    for (j, name) in columns.iter().enumerate() {
        let own = name.chars().count() + 2;
        match out.last_mut().filter(|_| width + own <= WIDTH) {
            Some(last) => last.end = j + 1,
            None => {
                out.push(j..j + 1);
                width = 0;
            }
        }
        width += own;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_fit_on_a_page() {
        let names: Vec<String> = (0..12).map(|k| format!("platform-{k}.angle")).collect();
        assert_eq!(chunks(&names), [0..5, 5..10, 10..12]);
        assert_eq!(chunks(&["x".repeat(200)]).len(), 1);
        assert!(chunks(&[]).is_empty());
    }
}
