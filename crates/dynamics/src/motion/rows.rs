//! Independent rows of C with everything that solving on them needs.

use linalg::{KeptRowSaddle, Matrix, SaddleError};
use model::{Mechanism, Scratch, System};

use crate::error::Trip;

/// Kept rows, their dense block of C, and the factored saddle matrix.
pub(super) struct KeptRows {
    /// Rows of C, ascending.
    pub(super) kept: Vec<usize>,
    /// The others of the same level.
    pub(super) dropped: Vec<usize>,
    /// Right-hand side, one value for each kept row.
    pub(super) rhs: Vec<f64>,
    /// Multipliers of the last solve.
    pub(super) lambda: Vec<f64>,
    c: Matrix,
    saddle: KeptRowSaddle,
    /// Pivot ratio when these rows were chosen: what later ones are compared with.
    reference_pivot: Option<f64>,
}

/// Other rows are kept once the pivots have fallen below this share of those at the choice: rounding of the kept
/// rows reaches the dropped ones through the inverse of the pivots.
const PIVOT_LOSS: f64 = 0.1;

/// Below this share the side of a singular configuration is not known: some √eps.
const PIVOT_SINGULAR: f64 = 1e-6;

/// Rows set aside come back above this share.
const PIVOT_RECOVERY: f64 = 0.2;

impl KeptRows {
    /// Storage for n velocities and these rows.
    pub(super) fn new(n: usize, kept: &[usize], dropped: &[usize]) -> Result<Self, SaddleError> {
        let r = kept.len();
        Ok(Self {
            kept: kept.to_vec(),
            dropped: dropped.to_vec(),
            rhs: vec![0.0; r],
            lambda: vec![0.0; r],
            c: Matrix::zeros(r, n),
            saddle: KeptRowSaddle::new(n, r)?,
            reference_pivot: None,
        })
    }

    /// Factors at the entries of C in the scratch.
    pub(super) fn factor(&mut self, mechanism: &Mechanism, s: &Scratch) -> Result<(), Trip> {
        for (k, &i) in self.kept.iter().enumerate() {
            mechanism.layout().scatter_row(s, i, self.c.row_mut(k));
        }
        let c = &self.c;
        match self.saddle.factor(|k| c.row(k), mechanism.mass()) {
            Ok(()) => {
                self.reference_pivot
                    .get_or_insert(self.saddle.pivot_ratio());
                Ok(())
            }
            Err(e) => Err(self.trip(mechanism, s, e)),
        }
    }

    /// Solves `M·x + Cᵀ·λ = force`, `C·x = rhs` with the factored matrix.
    pub(super) fn solve(
        &mut self,
        mechanism: &Mechanism,
        s: &Scratch,
        force: &[f64],
        x: &mut [f64],
    ) -> Result<(), Trip> {
        match self.saddle.solve(force, &self.rhs, x, &mut self.lambda) {
            Ok(()) => Ok(()),
            Err(e) => Err(self.trip(mechanism, s, e)),
        }
    }

    /// Smallest pivot of the last factorisation relative to its row.
    pub(super) fn pivot_ratio(&self) -> f64 {
        self.saddle.pivot_ratio()
    }

    /// Writes a frame of the motions that the factored rows allow.
    pub(super) fn null_frame(&self, frame: &mut Vec<f64>) {
        let n = self.saddle.n_coordinates();
        frame.resize((n - self.saddle.n_rows()) * n, 0.0);
        self.saddle.null_frame(frame);
    }

    /// Sign of the determinant of the factored rows bordered by a frame, 0 for a frame of another size.
    pub(super) fn orientation(&mut self, frame: &[f64]) -> f64 {
        let n = self.saddle.n_coordinates();
        match frame.len() == (n - self.saddle.n_rows()) * n {
            true => self.saddle.orientation(frame),
            false => 0.0,
        }
    }

    /// The present pivots are those that later ones are compared with.
    pub(super) fn confirm(&mut self) {
        self.reference_pivot = Some(self.pivot_ratio());
    }

    /// Whether the rows have become nearly dependent since they were chosen.
    pub(super) fn are_lost(&self) -> bool {
        self.reference_pivot
            .is_some_and(|r| self.pivot_ratio() < PIVOT_LOSS * r)
    }

    /// Whether the rows are as good as dependent: so near to a singular configuration that its position, known to √eps, does
    /// not tell the side. Without rows the ratio is infinite, and nothing is singular.
    pub(super) fn are_singular(&self) -> bool {
        self.reference_pivot
            .is_some_and(|r| self.pivot_ratio() < PIVOT_SINGULAR * r)
    }

    /// Whether rows that were lost are as independent as before.
    pub(super) fn are_recovered(&self) -> bool {
        self.reference_pivot
            .is_some_and(|r| self.pivot_ratio() > PIVOT_RECOVERY * r)
    }

    fn trip(&self, mechanism: &Mechanism, s: &Scratch, e: SaddleError) -> Trip {
        let time = s.t;
        match e {
            SaddleError::RankLost { row, pivot, scale } => {
                let row = mechanism.layout().labels[self.kept[row]].clone();
                Trip::RankLost {
                    time,
                    row,
                    pivot,
                    scale,
                }
            }
            SaddleError::MasslessMotion { motion, .. } => {
                let larger = |a: usize, b: usize| {
                    if motion[b].abs() > motion[a].abs() {
                        b
                    } else {
                        a
                    }
                };
                let (body, coordinate) = mechanism.coordinate((0..motion.len()).fold(0, larger));
                Trip::Massless {
                    time,
                    body: body.to_owned(),
                    coordinate,
                }
            }
            SaddleError::NonFinite {
                argument,
                index,
                value,
            } => Trip::NotFinite {
                time,
                what: format!("{argument}[{index}] = {value}"),
            },
            source => Trip::Saddle { time, source },
        }
    }
}
