//! Factorisation front by front, children before their parents.

use super::front::{add_element, add_update, eliminate};
use super::tiles::{SIDE, by_width, diagonal, of_columns, squares, triangle};
use super::{Assembly, LdlFactors, SchurSaddle, SchurStructure};
use crate::limits::{SCHUR_NOISE, SCHUR_WHOLE};
use crate::{MassMatrix, SaddleError, SparseMatrix};

impl SchurSaddle {
    /// Factors `S = C·M⁻¹·Cᵀ`. The rows C have the pattern of the structure, and `mass` is M,
    /// with the rows for which the structure was created.
    ///
    /// # Errors
    /// - [`SaddleError::Length`], [`SaddleError::NonFinite`], [`SaddleError::NegativeMass`]: bad
    ///   input.
    /// - [`SaddleError::ZeroMass`]: a coordinate has no mass.
    /// - [`SaddleError::RankLost`]: a row depends on other rows to the accuracy of S, because less
    ///   than 1e-7 of the row is independent.
    pub fn factor<'m>(
        &mut self,
        c: &SparseMatrix,
        mass: impl Into<MassMatrix<'m>>,
    ) -> Result<(), SaddleError> {
        self.factor_above(0.0, c, mass)?;
        let Some(row) = (0..self.structure.rows_of_c).find(|&k| !self.uses(k)) else {
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

    /// Works like [`Self::factor`], but skips a row if its independent fraction is at most `floor`.
    /// If rows are dependent for an instant, the other rows determine the solution. The multiplier
    /// of a skipped row is zero, and its equation is not satisfied.
    ///
    /// # Errors
    /// Returns the same errors as [`SchurSaddle::factor`], without [`SaddleError::RankLost`].
    pub fn factor_above<'m>(
        &mut self,
        floor: f64,
        c: &SparseMatrix,
        mass: impl Into<MassMatrix<'m>>,
    ) -> Result<(), SaddleError> {
        self.factor_extended(floor, c, mass.into())
    }

    /// Factors the extended equations.
    fn factor_extended(
        &mut self,
        floor: f64,
        c: &SparseMatrix,
        mass: MassMatrix<'_>,
    ) -> Result<(), SaddleError> {
        let Some(mut system) = self.extended.take() else {
            let found = mass.added().n_rows();
            return match found {
                0 => self.factor_diagonal(floor, c, mass.diagonal()),
                _ => Err(SaddleError::Length {
                    argument: "rows of the mass matrix",
                    found,
                    expected: 0,
                }),
            };
        };
        let taken = system.take(c, mass);
        let factored = taken.and_then(|()| self.factor_diagonal(floor, &system.c, &system.mass));
        self.extended = Some(system);
        factored
    }

    fn factor_diagonal(
        &mut self,
        floor: f64,
        c: &SparseMatrix,
        mass: &[f64],
    ) -> Result<(), SaddleError> {
        self.is_factored = false;
        self.take_mass(mass)?;
        self.check_shape(c)?;
        self.take_values(c);
        self.take_diagonal();
        let floor = floor.max(SCHUR_NOISE).powi(2);
        let (mut smallest, mut n_left_out) = (f64::INFINITY, 0);
        let s = &self.structure;
        let LdlFactors {
            l,
            inverse,
            compared,
            inverse_mass,
            ..
        } = &mut self.factors;
        let Assembly {
            values,
            front,
            waiting,
        } = &mut self.assembly;
        waiting.clear();
        for piece in &s.fronts {
            let [of_pivots, of_rest] = piece.lanes();
            let lanes = of_pivots + of_rest;
            let front = &mut front[..triangle(lanes)];
            front.fill([[0.0; SIDE]; SIDE]);
            for &child in &piece.children {
                let child = &s.fronts[child];
                let [_, of_child] = child.lanes();
                let from = waiting.len() - child.n_update();
                let at = &s.in_parent[child.rest.clone()];
                add_update(front, (&waiting[from..], of_child), at);
                waiting.truncate(from);
            }
            for block in &s.elements.of_fronts[piece.elements.clone()] {
                let rows = &s.elements.rows[block.rows.clone()];
                let columns = &s.elements.columns[block.columns.clone()];
                let e = (columns, &values[block.values.clone()]);
                add_element((front, lanes), rows, e, inverse_mass);
            }
            let own = (&mut inverse[piece.pivots.clone()], piece.n_pivots);
            let sizes = &compared[piece.pivots.clone()];
            let update = diagonal(lanes, of_pivots);
            let l = &mut l[piece.l..][..update];
            let found = match eliminate((front, lanes), own, sizes, floor, l) {
                Ok(found) => found,
                Err(k) => return Err(s.not_finite(c, SIDE * piece.pivots.start + k)),
            };
            smallest = smallest.min(found.smallest);
            n_left_out += found.n_left_out;
            waiting.extend_from_slice(&front[update..]);
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
        // Masses do not change along a motion.
        if self.factors.mass == mass {
            return Ok(());
        }
        self.factors.mass.fill(f64::NAN);
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
        self.factors.mass.copy_from_slice(mass);
        Ok(())
    }

    pub(super) fn check_shape(&self, c: &SparseMatrix) -> Result<(), SaddleError> {
        let s = &self.structure;
        let shapes = [
            ("rows", c.nrows(), s.n_rows()),
            ("columns", c.ncols(), s.n_coordinates()),
            ("entries", c.nnz(), s.elements.index.len()),
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

    /// Copies the values of C to the elements.
    pub(super) fn take_values(&mut self, c: &SparseMatrix) {
        let values = self.assembly.values.as_flattened_mut();
        for (&index, &value) in self.structure.elements.index.iter().zip(c.values()) {
            values[index as usize] = value;
        }
    }

    fn take_diagonal(&mut self) {
        let LdlFactors {
            diagonal,
            compared,
            usual,
            inverse_mass,
            ..
        } = &mut self.factors;
        let numbers = diagonal.as_flattened_mut();
        numbers.fill(0.0);
        let local = &mut self.work.local;
        let s = &self.structure.elements;
        for block in &s.of_fronts {
            let columns = &s.columns[block.columns.clone()];
            let rows = &s.rows[block.rows.clone()];
            let e = &self.assembly.values[block.values.clone()];
            by_width!(columns.len(), N => {
                let weights = of_columns::<N>(columns, inverse_mass);
                for (local, e) in local.iter_mut().zip(e.as_chunks::<N>().0) {
                    squares(&mut local[0], e, &weights);
                }
            });
            for (rows, [squares, _]) in rows.iter().zip(&*local) {
                rows.add_to(numbers, squares);
            }
        }
        let sizes = diagonal.as_flattened().iter().zip(usual.as_flattened());
        for (compared, (size, usual)) in compared.as_flattened_mut().iter_mut().zip(sizes) {
            *compared = size * usual;
        }
    }

    /// From now on, compares the independent share of each row with its present share. The order of
    /// elimination does not change, so the pivot of a row changes smoothly. Far from a singular
    /// configuration, the independent share of one row may be much larger than the share of another
    /// row. A factorisation of the same rows has the same [`SchurSaddle::pivot_ratio`] as before.
    pub fn keep_shares(&mut self) {
        let smallest = self.factors.pivot_ratio.powi(2);
        let LdlFactors {
            usual,
            inverse,
            diagonal,
            ..
        } = &mut self.factors;
        let pivots = inverse.as_flattened().iter().zip(diagonal.as_flattened());
        for (usual, (inverse, size)) in usual.as_flattened_mut().iter_mut().zip(pivots) {
            let share = (1.0 / (*inverse * *size)).min(SCHUR_WHOLE.powi(2));
            let usually = share / smallest;
            if *usual == 0.0 {
                continue;
            }
            *usual = if usually.is_finite() {
                usually.max(1.0)
            } else {
                1.0
            };
        }
    }
}

impl SchurStructure {
    /// Finds the entry that is not finite. If sums have overflowed, the function finds the row at
    /// this position.
    fn not_finite(&self, c: &SparseMatrix, place: usize) -> SaddleError {
        let row = self.rows.place.iter().position(|&p| p == place);
        let of_row = (row.unwrap_or_default(), 0, f64::INFINITY);
        let (row, column, value) = c.first_non_finite().unwrap_or(of_row);
        SaddleError::NonFinite {
            argument: "C",
            index: row * c.ncols() + column,
            value,
        }
    }
}
