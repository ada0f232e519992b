//! Uses only independent rows: the formulation of pfaff, without its monitors and refinement.

use linalg::{KeptRowSaddle, SaddleError};

use super::{Fault, Saddle, Solver};

/// A solver of the saddle equations that uses only independent rows. The multipliers of all other
/// rows are zero.
pub struct KeptRows {
    kept: Vec<usize>,
    saddle: KeptRowSaddle,
    gamma: Vec<f64>,
    lambda: Vec<f64>,
}

impl KeptRows {
    /// Creates a solver with these independent rows, for n coordinates.
    ///
    /// # Errors
    /// Returns an error if there are more rows than coordinates.
    pub fn new(n: usize, kept: &[usize]) -> Result<Self, SaddleError> {
        Ok(Self {
            saddle: KeptRowSaddle::new(n, kept.len())?,
            gamma: vec![0.0; kept.len()],
            lambda: vec![0.0; kept.len()],
            kept: kept.to_vec(),
        })
    }
}

impl Solver for KeptRows {
    fn solve(&mut self, at: &Saddle<'_>, a: &mut [f64], lambda: &mut [f64]) -> Result<(), Fault> {
        self.saddle.factor(|k| at.c.row(self.kept[k]), at.mass)?;
        for (gamma, &i) in self.gamma.iter_mut().zip(&self.kept) {
            *gamma = at.gamma[i];
        }
        self.saddle
            .solve(at.force, &self.gamma, a, &mut self.lambda)?;
        lambda.fill(0.0);
        for (&i, l) in self.kept.iter().zip(&self.lambda) {
            lambda[i] = *l;
        }
        Ok(())
    }
}
