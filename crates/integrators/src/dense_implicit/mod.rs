//! Implements [`Implicit`] for a plain problem, with a dense Jacobian (by a formula or by
//! differences) and dense LU decompositions.

mod complex;
pub(crate) mod lu;

use crate::implicit::Implicit;
use crate::ode::{Delicate, Ode, StepEnd, StepInfo};
use complex::Complex;
use lu::Lu;
use std::error::Error;
use thiserror::Error;

/// A problem with a dense Jacobian.
///
/// # Examples
///
/// The example solves y' = −10⁶·(y − cos t), y(0) = 1. The exact result is y(1) = cos 1 + 10⁻⁶·sin
/// 1 + … = 0.540303147.
///
/// ```
/// use pfaff_integrators::{DenseImplicit, Function, Interval, Options, Radau5, integrate};
/// use std::ops::ControlFlow;
///
/// let f = Function::new(1, |t: f64, y: &[f64], dy: &mut [f64]| dy[0] = -1e6 * (y[0] - t.cos()));
/// let mut ode = DenseImplicit::new(f, |_t: f64, _y: &[f64], j: &mut [f64]| j[0] = -1e6);
/// let interval = Interval::new(0.0, 1.0);
/// let end = integrate(&Radau5, &mut ode, &interval, &[1.0], &Options::default(), |_| ControlFlow::Continue(()))?;
/// assert!((end.y[0] - 0.540303147).abs() < 1e-8);
/// assert!(end.statistics.accepted < 40);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct DenseImplicit<O, J> {
    ode: O,
    jacobian: J,
    /// Jacobian J, row by row.
    j: Vec<f64>,
    real: Lu<f64>,
    complex: Lu<Complex>,
    x: Vec<Complex>,
}

/// Method for the Jacobian of a problem `O`: a closure `f(t, y, j)`, or [`Differences`].
pub trait Jacobian<O: Ode> {
    /// Writes J = ∂f/∂y at (t, y) to `j`, n×n row by row: `j[i·n + k]` = ∂f_i/∂y_k. On entry, `j`
    /// contains the last J.
    ///
    /// # Errors
    ///
    /// Returns errors of the problem.
    fn write(&mut self, ode: &mut O, t: f64, y: &[f64], j: &mut [f64]) -> Result<(), O::Error>;
}

impl<O: Ode, F: FnMut(f64, &[f64], &mut [f64])> Jacobian<O> for F {
    fn write(&mut self, _ode: &mut O, t: f64, y: &[f64], j: &mut [f64]) -> Result<(), O::Error> {
        self(t, y, j);
        Ok(())
    }
}

/// Forward differences with increments `√(eps·max(10⁻⁵, |y_k|))`, as in the program RADAU5. The
/// differences need n + 1 evaluations of f.
#[derive(Debug, Clone, Default)]
pub struct Differences {
    y: Vec<f64>,
    f: Vec<f64>,
    f_k: Vec<f64>,
}

impl<O: Ode> Jacobian<O> for Differences {
    fn write(&mut self, ode: &mut O, t: f64, y: &[f64], j: &mut [f64]) -> Result<(), O::Error> {
        let n = y.len();
        self.y.clear();
        self.y.extend_from_slice(y);
        self.f.resize(n, 0.0);
        self.f_k.resize(n, 0.0);
        ode.rhs(t, y, &mut self.f)?;
        for k in 0..n {
            let increment = (f64::EPSILON * y[k].abs().max(1e-5)).sqrt();
            self.y[k] = y[k] + increment;
            ode.rhs(t, &self.y, &mut self.f_k)?;
            // The actual increment after rounding is used instead of the intended increment.
            let increment = self.y[k] - y[k];
            for i in 0..n {
                j[i * n + k] = (self.f_k[i] - self.f[i]) / increment;
            }
            self.y[k] = y[k];
        }
        Ok(())
    }
}

/// Reason why a [`DenseImplicit`] problem cannot be evaluated or solved.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DenseError<E: Error + 'static> {
    /// An error of the wrapped problem.
    #[error("{0}")]
    Problem(#[source] E),
    /// The matrix `a·I − J` has no inverse in floating-point numbers.
    #[error(
        "the iteration matrix a·I − J, a = {re:.3e} + {im:.3e}i, is singular: no pivot in column {column} (counted from 0)"
    )]
    SingularIterationMatrix {
        /// Real part of a, a multiple of 1/h.
        re: f64,
        /// Imaginary part of a.
        im: f64,
        /// The column.
        column: usize,
    },
}

impl<O: Ode, J: Jacobian<O>> DenseImplicit<O, J> {
    /// Combines `ode` with its Jacobian.
    pub fn new(ode: O, jacobian: J) -> Self {
        let n = ode.dim();
        Self {
            ode,
            jacobian,
            j: vec![0.0; n * n],
            real: Lu::new(n),
            complex: Lu::new(n),
            x: vec![Complex::default(); n],
        }
    }

    /// Returns the wrapped problem.
    pub fn ode(&mut self) -> &mut O {
        &mut self.ode
    }
}

impl<O: Ode, J: Jacobian<O>> Ode for DenseImplicit<O, J> {
    type Error = DenseError<O::Error>;

    fn dim(&self) -> usize {
        self.ode.dim()
    }

    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Self::Error> {
        self.ode.rhs(t, y, dy).map_err(DenseError::Problem)
    }

    fn end_of_step(
        &mut self,
        step: &StepInfo<'_>,
        y: &mut [f64],
        dy: &mut [f64],
    ) -> Result<StepEnd, Self::Error> {
        self.ode
            .end_of_step(step, y, dy)
            .map_err(DenseError::Problem)
    }

    fn delicate_time(&self) -> Option<Delicate> {
        self.ode.delicate_time()
    }

    fn at_break(&mut self, t: f64, y: &mut [f64]) -> Result<(), Self::Error> {
        self.ode.at_break(t, y).map_err(DenseError::Problem)
    }
}

impl<O: Ode, J: Jacobian<O>> Implicit for DenseImplicit<O, J> {
    fn linearise(&mut self, t: f64, y: &[f64]) -> Result<(), Self::Error> {
        self.jacobian
            .write(&mut self.ode, t, y, &mut self.j)
            .map_err(DenseError::Problem)
    }

    fn factor(&mut self, real: f64, [re, im]: [f64; 2]) -> Result<(), Self::Error> {
        let (n, j) = (self.x.len(), &self.j);
        let diagonal = |i, k, a| if i == k { a } else { 0.0 };
        self.real
            .factor(|i, k| diagonal(i, k, real) - j[i * n + k])
            .map_err(|column| DenseError::SingularIterationMatrix {
                re: real,
                im: 0.0,
                column,
            })?;
        self.complex
            .factor(|i, k| Complex {
                re: diagonal(i, k, re) - j[i * n + k],
                im: diagonal(i, k, im),
            })
            .map_err(|column| DenseError::SingularIterationMatrix { re, im, column })
    }

    fn solve(&mut self, x: &mut [f64]) {
        self.real.solve(x);
    }

    fn solve_complex(&mut self, re: &mut [f64], im: &mut [f64]) {
        for (x, (re, im)) in self.x.iter_mut().zip(re.iter().zip(im.iter())) {
            *x = Complex { re: *re, im: *im };
        }
        self.complex.solve(&mut self.x);
        for (x, (re, im)) in self.x.iter().zip(re.iter_mut().zip(im.iter_mut())) {
            (*re, *im) = (x.re, x.im);
        }
    }
}
