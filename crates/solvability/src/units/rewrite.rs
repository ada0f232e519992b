//! The equations of a mechanism rewritten in other units.
//!
//! With `v'_j = s_j·v_j`, time in units of 1/τ s, a row multiplied by `ρ_i`, and power in units of
//! 1/w W:
//!
//! ```text
//! C'_ij = ρ_i·C_ij/s_j     a'_j = s_j·a_j/τ      Γ'_i = ρ_i·Γ_i/τ
//! Q'_j  = w·Q_j/s_j        M'_j = w·τ·M_j/s_j²   λ'_i = w·λ_i/ρ_i
//! ```
//!
//! They satisfy `M'·a' + C'ᵀ·λ' = Q'` and `C'·a' = Γ'` iff the unprimed ones satisfy theirs. So
//! scaling rows and columns is the same as rewriting the model in other units. ρ is arbitrary: rows
//! with translations use the unit of velocity, the others that of angular velocity.

use linalg::Matrix;
use model::ColumnKind;

use crate::choices::Equations;
use crate::groups::LinearForm;

/// Units, as numbers per SI unit: length 1000 for mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Per metre.
    pub length: f64,
    /// Per kilogram.
    pub mass: f64,
    /// Per second.
    pub time: f64,
}

/// Whether a number is a force or a torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// N
    Force,
    /// N·m
    Torque,
}

impl Units {
    /// m, kg, s
    pub const SI: Self = Self {
        length: 1.0,
        mass: 1.0,
        time: 1.0,
    };
    /// mm, kg, s
    pub const MILLIMETRE: Self = Self {
        length: 1e3,
        ..Self::SI
    };
    /// m, g, s
    pub const GRAM: Self = Self {
        mass: 1e3,
        ..Self::SI
    };
    /// m, kg, ms
    pub const MILLISECOND: Self = Self {
        time: 1e3,
        ..Self::SI
    };

    /// Units per N, or per N·m.
    #[must_use]
    pub fn of(self, dimension: Dimension) -> f64 {
        let force = self.mass * self.length / (self.time * self.time);
        match dimension {
            Dimension::Force => force,
            Dimension::Torque => force * self.length,
        }
    }

    /// Units per W.
    fn power(self) -> f64 {
        self.of(Dimension::Torque) / self.time
    }

    /// Units per m/s, or per rad/s.
    fn velocity(self, kind: ColumnKind) -> f64 {
        match kind {
            ColumnKind::Translation => self.length / self.time,
            ColumnKind::Rotation => self.time.recip(),
        }
    }
}

/// Factors of columns and rows.
pub(super) struct Rewriting {
    units: Units,
    /// Column factors s.
    columns: Vec<f64>,
    /// Row factors ρ.
    rows: Vec<f64>,
}

impl Rewriting {
    pub(super) fn new(equations: &Equations, units: Units, kinds: &[ColumnKind]) -> Self {
        let row = |i: usize| {
            let mut entries = equations.c.row(i).iter().zip(kinds);
            let translates = entries.any(|(c, kind)| *c != 0.0 && *kind == ColumnKind::Translation);
            units.velocity(if translates {
                ColumnKind::Translation
            } else {
                ColumnKind::Rotation
            })
        };
        Self {
            units,
            columns: kinds.iter().map(|&kind| units.velocity(kind)).collect(),
            rows: (0..equations.c.nrows()).map(row).collect(),
        }
    }

    /// The equations in other units: M', Q', C', Γ'.
    pub(super) fn equations(&self, old: &Equations) -> Equations {
        let (time, power) = (self.units.time, self.units.power());
        let of_columns = |x: &[f64], f: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
            x.iter()
                .zip(&self.columns)
                .map(|(x, s)| f(*x, *s))
                .collect()
        };
        let of_rows = |x: &[f64]| {
            x.iter()
                .zip(&self.rows)
                .map(|(x, r)| r * x / time)
                .collect()
        };
        Equations {
            mass: of_columns(&old.mass, &|m, s| power * time * m / (s * s)),
            force: of_columns(&old.force, &|q, s| power * q / s),
            c: Matrix::from_fn(old.c.nrows(), old.c.ncols(), |i, j| {
                self.rows[i] * old.c[(i, j)] / self.columns[j]
            }),
            gamma: of_rows(&old.gamma),
            gamma_terms: of_rows(&old.gamma_terms),
            may_miss: old.may_miss,
        }
    }

    /// `unit · ℓᵀ·λ` as a form of λ'.
    pub(super) fn form(&self, form: &LinearForm, unit: f64) -> LinearForm {
        let power = self.units.power();
        let rows: Vec<f64> = self.rows.iter().map(|r| unit * r / power).collect();
        form.times(&rows)
    }
}
