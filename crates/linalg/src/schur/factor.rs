//! Factorisation: front by front, children before their parents.

use super::front::{add_element, add_update, eliminate};
use super::{Assembly, Factors, SchurSaddle};
use crate::limits::{SCHUR_NOISE, SCHUR_WHOLE};
use crate::{SaddleError, SparseMatrix};

impl SchurSaddle {
    /// Factors `S = C·M⁻¹·Cᵀ` for rows of the pattern of the structure and the diagonal of M.
    ///
    /// # Errors
    /// - [`SaddleError::Length`], [`SaddleError::NonFinite`], [`SaddleError::NegativeMass`]: bad
    ///   input.
    /// - [`SaddleError::ZeroMass`]: a coordinate without mass.
    /// - [`SaddleError::RankLost`]: a row depends on others to the accuracy of S: less than 1e-7 of
    ///   it remains.
    pub fn factor(&mut self, c: &SparseMatrix, mass: &[f64]) -> Result<(), SaddleError> {
        self.factor_above(0.0, c, mass)?;
        let Some(row) = (0..self.structure.n_rows()).find(|&k| !self.uses(k)) else {
            return Ok(());
        };
        self.is_factored = false;
        let entries = c.row(row).1.iter();
        Err(SaddleError::RankLost {
            row,
            pivot: SCHUR_NOISE,
            scale: entries.fold(0.0, |a: f64, x| a.max(x.abs())),
        })
    }

    /// Like [`Self::factor`], but skips rows of which at most the fraction `floor` remains: if rows
    /// are dependent for an instant, the others determine the solution. The multiplier of a skipped
    /// row is zero, and its equation does not hold.
    ///
    /// # Errors
    /// As [`SchurSaddle::factor`], without [`SaddleError::RankLost`].
    pub fn factor_above(
        &mut self,
        floor: f64,
        c: &SparseMatrix,
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        self.is_factored = false;
        self.take_mass(mass)?;
        self.check_shape(c)?;
        self.take_diagonal(c);
        let floor = floor.max(SCHUR_NOISE).powi(2);
        let (mut smallest, mut n_left_out) = (f64::INFINITY, 0);
        let s = &self.structure;
        let Factors {
            l,
            inverse,
            compared,
            inverse_mass,
            ..
        } = &mut self.factors;
        let Assembly {
            front,
            waiting,
            element,
        } = &mut self.assembly;
        waiting.clear();
        for piece in &s.fronts {
            let f = piece.order();
            let front = &mut front[..f * f];
            front.fill(0.0);
            for &child in &piece.children {
                let rest = s.fronts[child].rest.clone();
                let from = waiting.len() - rest.len() * (rest.len() + 1) / 2;
                add_update(front, f, &waiting[from..], &s.in_parent[rest]);
                waiting.truncate(from);
            }
            for block in &s.elements.of_fronts[piece.elements.clone()] {
                let columns = &s.elements.columns[block.columns.clone()];
                let at = &s.elements.in_front[block.rows.clone()];
                let entries = &s.elements.entries[block.entries..][..at.len() * columns.len()];
                let weight = |k: usize| inverse_mass[columns[k] as usize];
                add_element(front, f, at, (entries, c.values()), weight, element);
            }
            let pivots = piece.pivots.clone();
            let own = &mut inverse[pivots.clone()];
            let found = match eliminate(front, f, own, &compared[pivots.clone()], floor) {
                Ok(found) => found,
                Err(k) => return Err(not_finite(c, s.rows.row[pivots.start + k])),
            };
            smallest = smallest.min(found.smallest);
            n_left_out += found.n_left_out;
            let mut at = piece.l;
            for k in 0..pivots.len() {
                let column = &front[k * f + k + 1..(k + 1) * f];
                l[at..at + column.len()].copy_from_slice(column);
                at += column.len();
            }
            for k in pivots.len()..f {
                waiting.extend_from_slice(&front[k * f + k..(k + 1) * f]);
            }
        }
        self.factors.pivot_ratio = smallest.sqrt();
        self.factors.n_left_out = n_left_out;
        self.is_factored = true;
        Ok(())
    }

    fn take_mass(&mut self, mass: &[f64]) -> Result<(), SaddleError> {
        let expected = self.factors.inverse_mass.len();
        if mass.len() != expected {
            return Err(SaddleError::Length {
                argument: "mass",
                found: mass.len(),
                expected,
            });
        }
        for (index, (inverse, &value)) in self.factors.inverse_mass.iter_mut().zip(mass).enumerate()
        {
            *inverse = 1.0 / value;
            if inverse.is_normal() && value > 0.0 {
                continue;
            }
            return Err(match value {
                _ if !value.is_finite() => SaddleError::NonFinite {
                    argument: "mass",
                    index,
                    value,
                },
                _ if value < 0.0 => SaddleError::NegativeMass { index, value },
                _ => SaddleError::ZeroMass { index, value },
            });
        }
        Ok(())
    }

    pub(super) fn check_shape(&self, c: &SparseMatrix) -> Result<(), SaddleError> {
        let s = &self.structure;
        let shapes = [
            ("rows", c.nrows(), s.n_rows()),
            ("columns", c.ncols(), s.n_coordinates()),
            ("entries", c.nnz(), s.rows.nnz),
        ];
        match shapes
            .into_iter()
            .find(|(_, found, expected)| found != expected)
        {
            Some((argument, found, expected)) => Err(SaddleError::Length {
                argument,
                found,
                expected,
            }),
            None => Ok(()),
        }
    }

    fn take_diagonal(&mut self, c: &SparseMatrix) {
        let Factors {
            diagonal,
            compared,
            usual,
            inverse_mass,
            ..
        } = &mut self.factors;
        for (place, size) in diagonal.iter_mut().enumerate() {
            let terms = self.structure.rows.entries_at(place, c.values());
            *size = terms.map(|(j, x)| x * x * inverse_mass[j]).sum();
            compared[place] = *size * usual[place];
        }
    }

    /// Compares each row from now on with what is left of it now: the order of elimination does not
    /// change, so its pivot changes smoothly, and what is left of a row far from a singular
    /// configuration may be much more than of another row there. A factorisation of the same rows
    /// has the same [`SchurSaddle::pivot_ratio`] as before.
    pub fn keep_shares(&mut self) {
        let smallest = self.factors.pivot_ratio.powi(2);
        let Factors {
            usual,
            inverse,
            diagonal,
            ..
        } = &mut self.factors;
        for ((usual, inverse), size) in usual.iter_mut().zip(inverse).zip(diagonal) {
            let share = (1.0 / (*inverse * *size)).min(SCHUR_WHOLE.powi(2));
            let usually = share / smallest;
            *usual = if usually.is_finite() {
                usually.max(1.0)
            } else {
                1.0
            };
        }
    }
}

/// Finds the entry that is not finite, in a row or, if sums have overflowed, the row itself.
fn not_finite(c: &SparseMatrix, row: usize) -> SaddleError {
    let (row, column, value) = c.first_non_finite().unwrap_or((row, 0, f64::INFINITY));
    SaddleError::NonFinite {
        argument: "C",
        index: row * c.ncols() + column,
        value,
    }
}
