//! Inputs: what drives prescribe, and the functions of forces.

use model::System;

use super::Bases;
use super::curve::{Curves, Derivative};
use super::error::LineariseError;

/// Number that acts on the motion from outside.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Input {
    /// Name of the drive or of the force.
    pub name: String,
    /// What of it changes.
    pub kind: InputKind,
}

/// What of a drive or a force changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// A function of a force, by its name in the definition.
    Function(&'static str),
    /// The prescribed value of the row of a drive (m or rad).
    Value,
    /// Its rate.
    Rate,
    /// The rate of that.
    Acceleration,
}

impl InputKind {
    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Function(name) => name,
            Self::Value => "value",
            Self::Rate => "rate",
            Self::Acceleration => "acceleration",
        }
    }
}

/// The inputs of all forces, and of all drives whose rows are kept, and the derivatives with respect
/// to them. A drive that other rows imply prescribes nothing alone.
pub(crate) fn all(
    curves: &mut Curves<'_>,
    bases: &Bases,
) -> Result<(Vec<Input>, Vec<Derivative>), LineariseError> {
    let mechanism = curves.mechanism();
    let [of_phi, of_c] = curves.kept();
    let (mut inputs, mut columns) = (Vec::new(), Vec::new());
    let drives = mechanism.layout().groups.iter().filter(|g| g.is_drive());
    for group in drives {
        let mut found = Vec::new();
        for row in group.rows.iter() {
            let still = vec![0.0; mechanism.layout().n_v];
            if let Some(k) = of_phi.iter().position(|&i| i == row) {
                let shift = bases.shift_of_row(k)?;
                let dv = bases.velocity_kept_by(curves, &shift)?;
                found.push((InputKind::Value, curves.along(&shift, &dv)?));
            }
            if let Some(k) = of_c.iter().position(|&i| i == row) {
                let dv = bases.velocity_of_row(k)?;
                found.push((InputKind::Rate, curves.along(&still, &dv)?));
                let mut gamma = vec![0.0; of_c.len()];
                gamma[k] = 1.0;
                found.push((InputKind::Acceleration, curves.pushed(&still, &gamma)?));
            }
        }
        for (kind, column) in found {
            inputs.push(Input {
                name: group.name.clone(),
                kind,
            });
            columns.push(column);
        }
    }
    let none = vec![0.0; of_c.len()];
    for push in curves.pushes() {
        inputs.push(Input {
            name: push.name.to_owned(),
            kind: InputKind::Function(push.function),
        });
        columns.push(curves.pushed(&push.q, &none)?);
    }
    Ok((inputs, columns))
}
