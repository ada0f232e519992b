//! Solution with the factors, and correction of the rounding errors of the solution.

use super::added::{ExtendedSystem, begin};
use super::tiles::{
    Lane, SIDE, Tile, add_times, add_transposed_times, by_width, dot, of_columns, subtract_times,
    sum, times_and_size, triangle,
};
use super::{LdlFactors, SchurSaddle, SchurStructure, SolutionScratch};
use crate::kernels::all_finite;
use crate::limits::{SCHUR_CORRECTIONS, SCHUR_ENOUGH, SCHUR_POOR, SCHUR_PROGRESS, SCHUR_ROUNDING};
use crate::{SaddleError, SparseMatrix};

impl SchurSaddle {
    /// Solves `M·a + Cᵀ·λ = f`, `C·a = γ` with the rows of the last factorisation. Rows that are
    /// not satisfied to rounding are corrected with the same factors. The corrections end if the
    /// rows are satisfied, or if a correction brings no improvement. Skipped rows are ignored.
    ///
    /// | argument | shape | meaning |
    /// | --- | --- | --- |
    /// | `c` | r × n | as in the factorisation |
    /// | `f`, `gamma` | n, r | right-hand sides |
    /// | `a`, `lambda` | n, r | overwritten |
    ///
    /// # Errors
    /// - [`SaddleError::NotFactored`], [`SaddleError::Length`], [`SaddleError::NonFinite`]: bad
    ///   input.
    /// - [`SaddleError::Unrefined`]: the residual of a row stays above 1e-9 of its terms in spite
    ///   of corrections.
    pub fn solve(
        &mut self,
        c: &SparseMatrix,
        f: &[f64],
        gamma: &[f64],
        a: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        if self.solve_extended((f, gamma), a, lambda)? {
            return Ok(());
        }
        self.check(
            c,
            [("f", f.len()), ("a", a.len())],
            [("gamma", gamma.len()), ("lambda", lambda.len())],
        )?;
        self.take_values(c);
        let inverse_mass = &self.factors.inverse_mass;
        for ((free, f), inverse) in self.work.free.iter_mut().zip(f).zip(inverse_mass) {
            *free = f * inverse;
        }
        a.copy_from_slice(&self.work.free);
        lambda.fill(0.0);
        self.work.added.fill([0.0; SIDE]);
        self.take_residual(gamma, a);
        if !all_finite(self.work.x.as_flattened()) {
            return Err(first_non_finite([("f", f), ("gamma", gamma)]));
        }
        self.substitute();
        self.add_solution(a, lambda);
        let mut before = f64::INFINITY;
        for round in 1..=SCHUR_CORRECTIONS {
            let of_motion = self.take_misfit(gamma, a);
            if of_motion <= SCHUR_ENOUGH {
                return Ok(());
            }
            // The first round computes the solution, so there is no earlier residual.
            if round > 1 {
                let of_all = self.misfit_of_all(c, gamma);
                // If large multipliers balance each other, the rounding error of the multipliers
                // remains after a correction.
                if of_all <= SCHUR_ROUNDING {
                    return Ok(());
                }
                let is_stuck = of_motion > SCHUR_PROGRESS * before || round == SCHUR_CORRECTIONS;
                if of_motion.is_finite() && is_stuck {
                    if of_motion.min(before) <= SCHUR_POOR || of_all <= SCHUR_POOR {
                        return Ok(());
                    }
                    return Err(SaddleError::Unrefined {
                        rounds: round,
                        change: of_motion,
                    });
                }
            }
            if !of_motion.is_finite() {
                return Err(first_non_finite([("f", f), ("gamma", gamma)]));
            }
            before = of_motion;
            self.substitute();
            self.add_solution(a, lambda);
        }
        Ok(())
    }

    /// Computes the λ that minimises `‖Cᵀ·λ − (f − M·a)‖` in the metric of the inverse masses, for
    /// a known motion a. The result is not corrected.
    ///
    /// # Errors
    /// Returns the same errors as [`SchurSaddle::solve`].
    pub fn multipliers(
        &mut self,
        c: &SparseMatrix,
        f: &[f64],
        a: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), SaddleError> {
        if self.multipliers_extended(f, a, lambda)? {
            return Ok(());
        }
        self.check(
            c,
            [("f", f.len()), ("a", a.len())],
            [("lambda", lambda.len()), ("lambda", lambda.len())],
        )?;
        self.take_values(c);
        for (k, free) in self.work.free.iter_mut().enumerate() {
            *free = f[k] * self.factors.inverse_mass[k] - a[k];
        }
        let SolutionScratch { x, local, free, .. } = &mut self.work;
        x.fill([0.0; SIDE]);
        let x = x.as_flattened_mut();
        add_all_times(&self.structure, &self.assembly.values, free, local, x);
        self.substitute();
        let x = self.work.x.as_flattened();
        for (lambda, &place) in lambda.iter_mut().zip(&self.structure.rows.place) {
            *lambda = x[place];
        }
        if all_finite(lambda) {
            Ok(())
        } else {
            Err(first_non_finite([("f", f), ("a", a)]))
        }
    }

    /// Solves the extended equations, if there are any.
    fn solve_extended(
        &mut self,
        (f, gamma): (&[f64], &[f64]),
        a: &mut [f64],
        lambda: &mut [f64],
    ) -> Result<bool, SaddleError> {
        self.with_extended((a, lambda), |this, system| {
            begin(&mut system.f, f, "f")?;
            begin(&mut system.gamma, gamma, "gamma")?;
            let ExtendedSystem {
                c,
                f,
                gamma,
                a,
                lambda,
                ..
            } = system;
            this.solve(c, f, gamma, a, lambda)
        })
    }

    /// Computes the multipliers of the extended equations for a motion, if there are any.
    fn multipliers_extended(
        &mut self,
        f: &[f64],
        a: &[f64],
        lambda: &mut [f64],
    ) -> Result<bool, SaddleError> {
        self.with_extended((&mut [], lambda), |this, system| {
            begin(&mut system.f, f, "f")?;
            begin(&mut system.a, a, "a")?;
            let ExtendedSystem {
                c,
                f,
                a: motion,
                lambda,
                ..
            } = system;
            for (k, i) in (this.structure.rows_of_c..c.nrows()).enumerate() {
                let rate = c.entries(i).filter(|(j, _)| *j < a.len());
                motion[a.len() + k] = rate.map(|(j, g)| g * a[j]).sum();
            }
            this.multipliers(c, f, motion, lambda)
        })
    }

    /// Calls a function with the extended equations and copies the solution of the original
    /// equations. Returns whether there are extended equations.
    fn with_extended(
        &mut self,
        (a, lambda): (&mut [f64], &mut [f64]),
        solve: impl FnOnce(&mut Self, &mut ExtendedSystem) -> Result<(), SaddleError>,
    ) -> Result<bool, SaddleError> {
        let Some(mut system) = self.extended.take() else {
            return Ok(false);
        };
        let solved = solve(self, &mut system);
        if solved.is_ok() {
            a.copy_from_slice(&system.a[..a.len()]);
            lambda.copy_from_slice(&system.lambda[..lambda.len()]);
        }
        self.extended = Some(system);
        solved.map(|()| true)
    }

    fn check(
        &self,
        c: &SparseMatrix,
        of_n: [(&'static str, usize); 2],
        of_r: [(&'static str, usize); 2],
    ) -> Result<(), SaddleError> {
        if !self.is_factored {
            return Err(SaddleError::NotFactored);
        }
        self.check_shape(c)?;
        let (n, r) = (self.structure.n_coordinates(), self.structure.n_rows());
        let lengths = of_n.map(|a| (a, n)).into_iter().chain(of_r.map(|a| (a, r)));
        match lengths
            .into_iter()
            .find(|((_, found), expected)| found != expected)
        {
            Some(((argument, found), expected)) => Err(SaddleError::Length {
                argument,
                found,
                expected,
            }),
            None => Ok(()),
        }
    }

    /// Writes `C·a − γ` of the rows in use to x, in the order of elimination.
    fn take_residual(&mut self, gamma: &[f64], a: &[f64]) {
        let s = &self.structure;
        let SolutionScratch { x, local, .. } = &mut self.work;
        x.fill([0.0; SIDE]);
        let numbers = x.as_flattened_mut();
        for (gamma, &place) in gamma.iter().zip(&s.rows.place) {
            numbers[place] = -gamma;
        }
        add_all_times(s, &self.assembly.values, a, local, numbers);
        clear_unused(x, &self.factors);
    }

    /// Works like [`Self::take_residual`], but also returns the largest residual relative to its
    /// terms. The terms use the larger of two accelerations: the given ones, and the accelerations
    /// of free bodies.
    fn take_misfit(&mut self, gamma: &[f64], a: &[f64]) -> f64 {
        let s = &self.structure;
        let SolutionScratch {
            x,
            size,
            local,
            free,
            terms,
            ..
        } = &mut self.work;
        for ((terms, free), a) in terms.iter_mut().zip(&*free).zip(a) {
            *terms = free.abs().max(a.abs());
        }
        x.fill([0.0; SIDE]);
        size.fill([0.0; SIDE]);
        let (sums, sizes) = (x.as_flattened_mut(), size.as_flattened_mut());
        for (gamma, &place) in gamma.iter().zip(&s.rows.place) {
            (sums[place], sizes[place]) = (-gamma, gamma.abs());
        }
        let elements = &s.elements;
        for block in &elements.of_fronts {
            let columns = &elements.columns[block.columns.clone()];
            let rows = &elements.rows[block.rows.clone()];
            let e = &self.assembly.values[block.values.clone()];
            by_width!(columns.len(), N => {
                let (a, terms) = (of_columns::<N>(columns, a), of_columns::<N>(columns, terms));
                for (local, e) in local.iter_mut().zip(e.as_chunks::<N>().0) {
                    times_and_size(local, e, &a, &terms);
                }
            });
            for (rows, [sum, of_terms]) in rows.iter().zip(&*local) {
                rows.add_to(sums, sum);
                rows.add_to(sizes, of_terms);
            }
        }
        clear_unused(x, &self.factors);
        largest_share(x, size)
    }

    /// Returns the largest residual in x relative to all summed terms. If large multipliers balance
    /// each other, the accelerations are only rounding errors of their sum.
    fn misfit_of_all(&mut self, c: &SparseMatrix, gamma: &[f64]) -> f64 {
        let s = &self.structure;
        let SolutionScratch {
            x,
            size,
            added,
            local,
            free,
            terms,
        } = &mut self.work;
        let values = &mut self.assembly.values;
        for value in values.as_flattened_mut() {
            *value = value.abs();
        }
        // The sizes are subtracted below. Therefore the size of the free acceleration is negative,
        // too.
        for (terms, free) in terms.iter_mut().zip(&*free) {
            *terms = -free.abs();
        }
        let (added, weights) = (added.as_flattened(), &self.factors.inverse_mass);
        subtract_transposed(s, values, weights, (added, local), terms);
        size.fill([0.0; SIDE]);
        let sizes = size.as_flattened_mut();
        for (gamma, &place) in gamma.iter().zip(&s.rows.place) {
            sizes[place] = -gamma.abs();
        }
        add_all_times(s, values, terms, local, sizes);
        sizes.iter_mut().for_each(|size| *size = -*size);
        let share = largest_share(x, size);
        self.take_values(c);
        share
    }

    /// Adds the multipliers in x and their effect on the motion. Also adds their sizes to the total
    /// contributions.
    fn add_solution(&mut self, a: &mut [f64], lambda: &mut [f64]) {
        let s = &self.structure;
        let SolutionScratch {
            x, added, local, ..
        } = &mut self.work;
        let x = x.as_flattened();
        for (lambda, &place) in lambda.iter_mut().zip(&s.rows.place) {
            *lambda += x[place];
        }
        for (added, x) in added.as_flattened_mut().iter_mut().zip(x) {
            *added += x.abs();
        }
        let (values, weights) = (&self.assembly.values, &self.factors.inverse_mass);
        subtract_transposed(s, values, weights, (x, local), a);
    }

    /// Computes `x ← S⁻¹·x` in the order of elimination.
    fn substitute(&mut self) {
        let s = &self.structure;
        let LdlFactors { l, inverse, .. } = &self.factors;
        let SolutionScratch { x, local, .. } = &mut self.work;
        let local = local.as_flattened_mut();
        for front in &s.fronts {
            let [of_pivots, of_rest] = front.lanes();
            let lanes = of_pivots + of_rest;
            let rest = &mut local[..of_rest];
            for lane in &mut *rest {
                *lane = [0.0; SIDE];
            }
            let own = &mut x[front.pivots.clone()];
            let mut l = &l[front.l..];
            for k in 0..of_pivots {
                let (tiles, next) = l.split_at(lanes - k);
                let (own, below) = own[k..].split_at_mut(1);
                solve_within(&mut own[0], &tiles[0]);
                let (in_front, of_rest) = tiles[1..].split_at(below.len());
                for (x, tile) in below.iter_mut().zip(in_front) {
                    subtract_times(x, tile, &own[0]);
                }
                for (x, tile) in rest.iter_mut().zip(of_rest) {
                    subtract_times(x, tile, &own[0]);
                }
                l = next;
            }
            for (x, inverse) in own.iter_mut().zip(&inverse[front.pivots.clone()]) {
                for n in 0..SIDE {
                    x[n] *= inverse[n];
                }
            }
            let (x, rest) = (x.as_flattened_mut(), rest.as_flattened());
            for (&j, value) in s.later[front.rest.clone()].iter().zip(rest) {
                x[j as usize] += value;
            }
        }
        for front in s.fronts.iter().rev() {
            let [of_pivots, of_rest] = front.lanes();
            let lanes = of_pivots + of_rest;
            let rest = &mut local[..of_rest];
            if let Some(last) = rest.last_mut() {
                *last = [0.0; SIDE];
            }
            let numbers = x.as_flattened();
            for (value, &j) in rest
                .as_flattened_mut()
                .iter_mut()
                .zip(&s.later[front.rest.clone()])
            {
                *value = numbers[j as usize];
            }
            let own = &mut x[front.pivots.clone()];
            let mut l = &l[front.l..][..triangle(lanes) - front.n_update()];
            for k in (0..of_pivots).rev() {
                let (before, tiles) = l.split_at(l.len() - (lanes - k));
                let (own, below) = own[k..].split_at_mut(1);
                let mut sums = [0.0; SIDE];
                let (in_front, of_rest) = tiles[1..].split_at(below.len());
                for (x, tile) in below.iter().zip(in_front) {
                    add_transposed_times(&mut sums, tile, x);
                }
                for (x, tile) in rest.iter().zip(of_rest) {
                    add_transposed_times(&mut sums, tile, x);
                }
                let own = &mut own[0];
                for n in (0..SIDE).rev() {
                    own[n] -= sums[n] + dot(&tiles[0][n], own);
                }
                l = before;
            }
        }
    }
}

/// Eliminates the pivots of a diagonal tile from its own group of values. The tile has zeros on and
/// above its diagonal.
fn solve_within(own: &mut Lane, tile: &Tile) {
    let mut x = *own;
    for n in 0..SIDE {
        x = sum(x, &[tile[n]], &[-x[n]]);
    }
    *own = x;
}

/// Computes `out ← out + E·v` for all elements with these values, in the order of elimination.
fn add_all_times(
    s: &SchurStructure,
    values: &[Lane],
    v: &[f64],
    local: &mut [[Lane; 2]],
    out: &mut [f64],
) {
    let elements = &s.elements;
    for block in &elements.of_fronts {
        let columns = &elements.columns[block.columns.clone()];
        let rows = &elements.rows[block.rows.clone()];
        let e = &values[block.values.clone()];
        by_width!(columns.len(), N => {
            let v = of_columns::<N>(columns, v);
            for (local, e) in local.iter_mut().zip(e.as_chunks::<N>().0) {
                local[0] = [0.0; SIDE];
                add_times(&mut local[0], e, &v);
            }
        });
        for (rows, [sum, _]) in rows.iter().zip(&*local) {
            rows.add_to(out, sum);
        }
    }
}

/// Computes `out ← out − diag(weights)·Eᵀ·x` for all elements with these values.
fn subtract_transposed(
    s: &SchurStructure,
    values: &[Lane],
    weights: &[f64],
    (x, local): (&[f64], &mut [[Lane; 2]]),
    out: &mut [f64],
) {
    let elements = &s.elements;
    for block in &elements.of_fronts {
        let columns = &elements.columns[block.columns.clone()];
        let rows = &elements.rows[block.rows.clone()];
        let e = &values[block.values.clone()];
        for ([local, _], rows) in local.iter_mut().zip(rows) {
            *local = rows.take_from(x);
        }
        by_width!(columns.len(), N => {
            let mut sums = [0.0; N];
            for (e, [x, _]) in e.as_chunks::<N>().0.iter().zip(&*local) {
                add_transposed_times(&mut sums, e, x);
            }
            for (&j, sum) in columns.iter().zip(sums) {
                out[j as usize] -= weights[j as usize] * sum;
            }
        });
    }
}

/// Sets the residuals of skipped rows to zero.
fn clear_unused(x: &mut [Lane], factors: &LdlFactors) {
    if factors.n_left_out == 0 {
        return;
    }
    let inverse = factors.inverse.as_flattened();
    for (x, &inverse) in x.as_flattened_mut().iter_mut().zip(inverse) {
        *x = if inverse == 0.0 { 0.0 } else { *x };
    }
}

/// Returns the largest `|x|/size` of nonzero x, or NaN if a value is not finite.
fn largest_share(x: &[Lane], size: &[Lane]) -> f64 {
    let (mut largest, mut none) = ([0.0_f64; SIDE], [0.0; SIDE]);
    for (x, size) in x.iter().zip(size) {
        for l in 0..SIDE {
            let share = x[l].abs() / size[l];
            let share = if x[l] == 0.0 { 0.0 } else { share };
            none[l] += share * 0.0;
            largest[l] = if share > largest[l] {
                share
            } else {
                largest[l]
            };
        }
    }
    if all_finite(&none) {
        largest.into_iter().fold(0.0, f64::max)
    } else {
        f64::NAN
    }
}

fn first_non_finite(arguments: [(&'static str, &[f64]); 2]) -> SaddleError {
    let of = |(argument, values): (&'static str, &[f64])| {
        let index = values.iter().position(|x| !x.is_finite())?;
        Some((argument, index, values[index]))
    };
    let (argument, index, value) =
        arguments
            .into_iter()
            .find_map(of)
            .unwrap_or(("solution", 0, f64::INFINITY));
    SaddleError::NonFinite {
        argument,
        index,
        value,
    }
}
