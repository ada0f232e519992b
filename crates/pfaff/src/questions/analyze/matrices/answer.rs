//! The matrices of the constraints.

use model::System;
use serde::Serialize;

use crate::configuration::ConfigurationAnalysis;

/// Kind of the rows of Φq.
pub(super) const PHI_Q: &str = "holonomic";

/// Kind of the rows of Ψ.
pub(super) const PSI: &str = "nonholonomic";

/// The constraint matrix C = (Φq; Ψ) and Γ of C·v̇ = Γ.
///
/// In space, the columns of Φq belong to velocities and angular velocities in place of the
/// derivatives of coordinates, as C·v = b requires.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MatricesDocument {
    /// Names of the columns: a body and a direction (m or rad).
    pub columns: Vec<String>,
    /// Names of the rows.
    pub rows: Vec<MatrixRowDocument>,
    /// C, row by row: first Φq, then Ψ.
    pub c: Vec<Vec<f64>>,
    /// Γ of each row (m/s² or rad/s²); absent if no velocities are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gamma: Option<Vec<f64>>,
}

/// A row of C.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MatrixRowDocument {
    /// Number of the row, from 1.
    pub number: usize,
    /// The joint or drive.
    pub joint: String,
    /// Name of the row within the joint.
    pub name: &'static str,
    /// `holonomic`, a row of Φq, or `nonholonomic`, a row of Ψ.
    pub kind: &'static str,
}

impl MatrixRowDocument {
    /// Returns the name of the row, such as `4 upper.y`.
    pub(super) fn label(&self) -> String {
        format!("{} {}.{}", self.number, self.joint, self.name)
    }
}

impl MatricesDocument {
    pub(super) fn of(configuration: &ConfigurationAnalysis<'_>) -> Self {
        let mechanism = configuration.mechanism;
        let (layout, state) = (mechanism.layout(), &configuration.state);
        let mut s = mechanism.scratch();
        mechanism.pose(configuration.analysis.time, &state.q, &mut s);
        mechanism.c(&mut s);
        let gamma = (state.v.len() == layout.n_v).then(|| {
            mechanism.twist(&state.v, &mut s);
            mechanism.gamma(&mut s);
            s.gamma.clone()
        });
        let name = |j: usize| {
            let (body, direction) = mechanism.coordinate(j);
            format!("{body}.{direction}")
        };
        let rows = layout.labels.iter().enumerate();
        let rows = rows.map(|(i, label)| MatrixRowDocument {
            number: label.number,
            joint: label.joint.clone(),
            name: label.row,
            kind: if i < layout.m { PHI_Q } else { PSI },
        });
        let c = (0..layout.rows()).map(|i| {
            let mut row = vec![0.0; layout.n_v];
            layout.scatter_row(&s, i, &mut row);
            row
        });
        Self {
            columns: (0..layout.n_v).map(name).collect(),
            rows: rows.collect(),
            c: c.collect(),
            gamma,
        }
    }

    /// Returns the named rows of one kind.
    pub(super) fn rows_of(&self, kind: &str) -> Vec<(String, &[f64])> {
        let rows = self.rows.iter().zip(&self.c);
        let own = rows.filter(|(row, _)| row.kind == kind);
        own.map(|(row, entries)| (row.label(), entries.as_slice()))
            .collect()
    }
}
