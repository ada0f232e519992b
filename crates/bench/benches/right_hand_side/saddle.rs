//! The equations of motion as one dense matrix, for general solvers.

use dynamics::PreparedMechanism;
use model::{Mechanism, Scratch, System};

/// `[M, C_Rᵀ; C_R, 0]·[a; λ] = [Q; Γ_R]` with a selection R of rows, column-major.
pub(crate) struct Saddle<'p> {
    mechanism: &'p Mechanism,
    s: Scratch,
    rows: Vec<usize>,
    /// Order of the matrix.
    pub(crate) n: usize,
}

impl<'p> Saddle<'p> {
    /// Uses the independent rows: the matrix is 41 × 41 and regular.
    pub(crate) fn of_kept_rows(prepared: &'p PreparedMechanism) -> Self {
        Self::of_rows(prepared, prepared.decision.kept.clone())
    }

    /// Uses all rows: the matrix is 43 × 43 and has rank 41.
    pub(crate) fn of_all_rows(prepared: &'p PreparedMechanism) -> Self {
        Self::of_rows(prepared, (0..prepared.mechanism.layout().rows()).collect())
    }

    fn of_rows(prepared: &'p PreparedMechanism, rows: Vec<usize>) -> Self {
        let mechanism = &prepared.mechanism;
        Self {
            s: mechanism.scratch(),
            n: mechanism.layout().n_v + rows.len(),
            mechanism,
            rows,
        }
    }

    /// Evaluates and assembles the equations at one instant.
    pub(crate) fn fill(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        matrix: &mut [f64],
        load: &mut [f64],
    ) {
        let Self {
            mechanism,
            s,
            rows,
            n,
        } = self;
        let n_v = mechanism.layout().n_v;
        mechanism.pose(t, q, s);
        mechanism.c(s);
        mechanism.twist(v, s);
        mechanism.gamma(s);
        mechanism.force(s);
        matrix.fill(0.0);
        for (i, m) in mechanism.mass().iter().enumerate() {
            matrix[i + *n * i] = *m;
        }
        load[..n_v].copy_from_slice(&s.force);
        for (k, &i) in rows.iter().enumerate() {
            for (j, c) in mechanism.layout().row(s, i) {
                matrix[(n_v + k) + *n * j] += c;
                matrix[j + *n * (n_v + k)] += c;
            }
            load[n_v + k] = s.gamma[i];
        }
    }
}
