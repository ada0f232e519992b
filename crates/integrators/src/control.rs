//! Step-size control from the estimated error: a PI controller with limits.
//!
//! The rule is `h_new = h · clamp(safety · err^(−α) · err_old^β)`. The rule is Gustafsson's
//! controller in the form of Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I,
//! 2nd ed., II.4 and of Hairer, Wanner, vol. II, IV.2. The formula is evaluated with one logarithm
//! and one exponential per step. The module `drive` handles failures of trials, and each method
//! computes its error estimate.

/// Determines the size of the next trial step.
pub trait StepControl {
    /// Resets the memory at the start of an interval between two break times.
    fn reset(&mut self);

    /// Returns the next step size after an accepted step of size `h` with error norm `error` ≤ 1.
    fn accept(&mut self, h: f64, error: f64) -> f64;

    /// Returns the next step size after a trial of size `h` with error norm `error` > 1. The error
    /// norm may be infinite.
    fn reject(&mut self, h: f64, error: f64) -> f64;

    /// Returns the next step size after a trial of size `h` that gave no error estimate or was
    /// rejected. `factor` is the step-size factor that the integration loop proposes.
    fn shorten(&mut self, h: f64, factor: f64) -> f64;
}

/// Constants of the controller, chosen by each method.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ControlConstants {
    /// α, exponent of the current error.
    pub(crate) alpha: f64,
    /// β, exponent of the previous error; 0 gives the classical controller.
    pub(crate) beta: f64,
    /// Safety factor: the step size is this fraction of the size whose estimated error equals the
    /// tolerance.
    pub(crate) safety: f64,
    /// Smallest permitted h_new / h.
    pub(crate) min_factor: f64,
    /// Largest permitted h_new / h.
    pub(crate) max_factor: f64,
}

/// The value ln 1e-4. An err_old below 1e-4 counts as 1e-4.
const LOG_ERROR_FLOOR: f64 = -9.210_340_371_976_182;

/// A PI controller and its memory.
#[derive(Debug, Clone)]
pub(crate) struct Control {
    constants: ControlConstants,
    /// Logarithm ln err_old.
    log_previous_error: f64,
    after_rejection: bool,
}

impl Control {
    pub(crate) fn new(constants: ControlConstants) -> Self {
        Self {
            constants,
            log_previous_error: LOG_ERROR_FLOOR,
            after_rejection: false,
        }
    }
}

impl StepControl for Control {
    fn reset(&mut self) {
        *self = Self::new(self.constants);
    }

    /// The step size is not increased directly after a rejection.
    fn accept(&mut self, h: f64, error: f64) -> f64 {
        let c = self.constants;
        // For an error of 0, ln 0 = −∞ leads to the factor +∞, which is then limited.
        let log_error = error.ln();
        let factor = c.safety * (c.beta * self.log_previous_error - c.alpha * log_error).exp();
        let limit = if self.after_rejection {
            1.0
        } else {
            c.max_factor
        };
        self.log_previous_error = log_error.max(LOG_ERROR_FLOOR);
        self.after_rejection = false;
        h * factor.clamp(c.min_factor, limit)
    }

    fn reject(&mut self, h: f64, error: f64) -> f64 {
        let c = self.constants;
        self.after_rejection = true;
        h * (c.safety * error.powf(-c.alpha)).max(c.min_factor)
    }

    fn shorten(&mut self, h: f64, factor: f64) -> f64 {
        self.after_rejection = true;
        h * factor
    }
}

/// Returns `√(1/n · Σ (d_i / scale_i)²)`, or 0 for n = 0. A component with d_i = 0 is ignored even
/// if its scale is 0.
pub(crate) fn weighted_rms(d: &[f64], scale: &[f64]) -> f64 {
    if d.is_empty() {
        return 0.0;
    }
    (weighted_square_sum(d, scale) / d.len() as f64).sqrt()
}

/// Returns `Σ (d_i / scale_i)²`.
pub(crate) fn weighted_square_sum(d: &[f64], scale: &[f64]) -> f64 {
    d.iter()
        .zip(scale)
        .map(|(d, s)| if *d == 0.0 { 0.0 } else { (d / s) * (d / s) })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONSTANTS: ControlConstants = ControlConstants {
        alpha: 0.17,
        beta: 0.04,
        safety: 0.9,
        min_factor: 0.2,
        max_factor: 10.0,
    };

    #[test]
    fn factors_follow_the_formula_and_its_limits() {
        let mut control = Control::new(CONSTANTS);
        let expected = 0.9 * 0.5_f64.powf(-0.17) * 1e-4_f64.powf(0.04);
        assert!((control.accept(1.0, 0.5) - expected).abs() < 1e-14);
        let expected = -2.0 * 0.9 * 0.1_f64.powf(-0.17) * 0.5_f64.powf(0.04);
        assert!((control.accept(-2.0, 0.1) - expected).abs() < 1e-14);
        assert_eq!(control.accept(1.0, 0.0), 10.0);
        assert_eq!(control.reject(1.0, f64::INFINITY), 0.2);
        assert_eq!(
            control.accept(1.0, 0.0),
            1.0,
            "no growth right after a rejection"
        );
        assert_eq!(control.accept(1.0, 0.0), 10.0);
    }

    #[test]
    fn norms_skip_components_without_error() {
        assert_eq!(weighted_rms(&[3.0, 4.0], &[1.0, 1.0]), 12.5_f64.sqrt());
        assert_eq!(weighted_rms(&[0.0, 2.0], &[0.0, 1.0]), 2.0_f64.sqrt());
        assert_eq!(weighted_rms(&[], &[]), 0.0);
        assert_eq!(weighted_rms(&[1.0], &[0.0]), f64::INFINITY);
    }
}
