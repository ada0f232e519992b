//! Inputs: values that drives prescribe, and functions of forces.

use model::{Push, System};

use super::bases::Bases;
use super::curve::{Curves, Derivative};
use super::error::LineariseError;

/// A scalar, prescribed by a drive or a force function, that acts on the motion from outside.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Input {
    /// Name of the drive or of the force.
    pub name: String,
    /// The quantity that changes. For the row of a drive the quantity is `value`, `rate` or
    /// `acceleration` (m or rad, and per second). For a force it is the name of a function, with
    /// its axis if the function has several axes.
    pub what: String,
}

/// Returns the inputs of all forces and of all drives with independent rows, and the derivatives
/// with respect to these inputs. A drive that other rows imply has no input, because it does not
/// prescribe a motion by itself.
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
                found.push(("value", curves.along(&shift, &dv)?));
            }
            if let Some(k) = of_c.iter().position(|&i| i == row) {
                let dv = bases.velocity_of_row(k)?;
                found.push(("rate", curves.along(&still, &dv)?));
                let mut gamma = vec![0.0; of_c.len()];
                gamma[k] = 1.0;
                found.push(("acceleration", curves.pushed(&still, &gamma)?));
            }
        }
        for (what, column) in found {
            inputs.push(Input {
                name: group.name.clone(),
                what: what.to_owned(),
            });
            columns.push(column);
        }
    }
    let none = vec![0.0; of_c.len()];
    let pushes = curves.pushes();
    for (k, push) in pushes.iter().enumerate() {
        let same = |other: &&Push<'_>| (other.name, other.function) == (push.name, push.function);
        let what = match pushes.iter().filter(same).count() {
            1 => push.function.to_owned(),
            _ => {
                let before = pushes[..k].iter().filter(same).count();
                let axis = ["x", "y", "z"].get(before).copied().unwrap_or("more");
                format!("{}.{axis}", push.function)
            }
        };
        inputs.push(Input {
            name: push.name.to_owned(),
            what,
        });
        columns.push(curves.pushed(&push.q, &none)?);
    }
    Ok((inputs, columns))
}
