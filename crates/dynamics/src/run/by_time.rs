//! The state as a function of time, for mechanisms without degrees of freedom. Stages are moved
//! onto the constraint manifold, and no time of a step is evaluated twice.

use crate::error::MotionFault;
use crate::limits::REMEMBERED;
use crate::options::MotionOptions;
use crate::prepare::PreparedMechanism;

/// Derivatives at the times of a step.
#[derive(Default)]
pub(super) struct ByTime {
    times: Vec<f64>,
    /// The derivatives, in sequence.
    derivatives: Vec<f64>,
}

impl ByTime {
    /// Returns work memory for a run that evaluates derivatives as functions of time, and otherwise
    /// `None`. The memory is not used with generated code. In this case the interpreter is called
    /// only near singular configurations, and the integrator determines the state.
    pub(super) fn for_run(prepared: &PreparedMechanism, options: &MotionOptions) -> Option<Self> {
        let is_interpreted = prepared.code_for(options).is_err();
        (is_interpreted && prepared.is_function_of_time(options)).then(Self::default)
    }

    /// Returns the derivative at time t. The derivative is the stored derivative, or the result of
    /// `evaluate`.
    pub(super) fn recall(
        &mut self,
        t: f64,
        dy: &mut [f64],
        evaluate: impl FnOnce(&mut [f64]) -> Result<(), MotionFault>,
    ) -> Result<(), MotionFault> {
        if self.copy(t, dy) {
            return Ok(());
        }
        if self.times.len() == REMEMBERED {
            self.forget();
        }
        evaluate(dy).inspect_err(|_| self.forget())?;
        self.times.push(t);
        self.derivatives.extend_from_slice(dy);
        Ok(())
    }

    /// Copies the derivative at the end of a step if a stage was at this time. Clears the stored
    /// values.
    pub(super) fn take(&mut self, t: f64, dy: &mut [f64]) -> bool {
        let is_known = self.copy(t, dy);
        self.forget();
        is_known
    }

    fn copy(&self, t: f64, dy: &mut [f64]) -> bool {
        let Some(k) = self.times.iter().position(|known| *known == t) else {
            return false;
        };
        dy.copy_from_slice(&self.derivatives[k * dy.len()..][..dy.len()]);
        true
    }

    /// Clears the stored values, because the state jumps.
    pub(super) fn forget(&mut self) {
        self.times.clear();
        self.derivatives.clear();
    }
}
