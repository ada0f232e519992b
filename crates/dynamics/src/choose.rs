//! Chooses the method of a run if the user does not specify a method.

use linalg::{Eigenpair, Matrix, SaddleError, eigenpairs};
use model::words::rough;

use crate::error::MotionFault;
use crate::limits::{GAP, GAP_RTOL, POWER_ITERATIONS, STABLE, STIFF, STIFF_DECAY};
use crate::motion::KeptRowMotion;
use crate::options::{Method, MotionOptions, Stabilisation};
use crate::plan::Decision;
use crate::prepare::PreparedMechanism;
use crate::run::{ReducedJacobian, derivatives};

/// Returns the method of a run. If a method is given, this method is returned. Otherwise the method
/// is Radau IIA if forces make the motion stiff at its start, or else Dormand–Prince 8(5,3). The
/// motion of a mechanism without degrees of freedom needs no implicit method.
///
/// # Errors
/// Returns an error if an implicit method is requested or considered, but the motion has no
/// Jacobian at the start, or a force calls an external function.
pub(crate) fn method(
    prepared: &PreparedMechanism,
    options: &MotionOptions,
) -> Result<Decision<Method>, MotionFault> {
    let explicit = |why: &str| Ok(decided(Method::Dop853, why.to_owned()));
    let may_be_implicit = matches!(options.method, Method::Auto | Method::Radau5);
    if may_be_implicit && prepared.is_function_of_time(options) {
        return explicit("the state is a function of time: no free motion can be stiff");
    }
    if options.method.needs_independent_coordinates() && prepared.is_schur(options.method) {
        let rows = prepared.decision.kept.len();
        return Err(MotionFault::Saddle {
            time: 0.0,
            source: SaddleError::Large { rows },
        });
    }
    if options.method == Method::Radau5 {
        derivatives(&prepared.mechanism)?;
    }
    if options.method != Method::Auto {
        return Ok(decided(options.method, "requested".to_owned()));
    }
    if prepared.mechanism.applied_forces().is_empty() {
        return explicit("no applied forces that could be stiff");
    }
    let mut forces = prepared.mechanism.applied_forces().without_derivatives();
    if let Some(force) = forces.next() {
        let why = format!("{force} for implicit methods; stiffness was not estimated");
        return explicit(&why);
    }
    if !prepared.estimates_stiffness() {
        return explicit("stiffness was not estimated: a large mechanism with many free motions");
    }
    if options.stabilisation != Stabilisation::Projection {
        return explicit("implicit methods need projection");
    }
    let jacobian = jacobian_at_start(prepared)?;
    let duration = options.t_end - prepared.start_time();
    let steps = spectral_radius(&jacobian) * duration / STABLE;
    let about = || rough(steps);
    let (method, why) = if steps > STIFF {
        let why = format!("needs about {} steps, more than {STIFF:.0e}", about());
        (Method::Radau5, why)
    } else if steps > STIFF_DECAY {
        let others = rate_of_others(&jacobian).max(speed(prepared));
        let gap = steps * STABLE / duration / others;
        let least = GAP * (GAP_RTOL / options.rtol).powf(0.2);
        let (method, is) = if gap > least {
            (Method::Radau5, "more")
        } else {
            (Method::Dop853, "not more")
        };
        let why = format!(
            "needs about {} steps, because of a motion that decays {} times as fast as others change, {is} than {} times",
            about(),
            rough(gap),
            rough(least)
        );
        (method, why)
    } else {
        let few = if steps < 1.0 {
            "less than 1".to_owned()
        } else {
            format!("about {}", about())
        };
        let why = format!("needs {few} steps, not more than {STIFF_DECAY}");
        (Method::Dop853, why)
    };
    let why = format!("estimate at the start: for stability an explicit method {why}");
    Ok(decided(method, why))
}

fn decided(value: Method, reason: String) -> Decision<Method> {
    Decision::new(value, value.name(), reason)
}

/// Returns the Jacobian of the motion on independent coordinates at the start.
fn jacobian_at_start(prepared: &PreparedMechanism) -> Result<Matrix, MotionFault> {
    let options = MotionOptions {
        method: Method::Radau5,
        ..MotionOptions::to(prepared.start_time())
    };
    let mut motion = KeptRowMotion::with(prepared, &options)?;
    let mut reduced = ReducedJacobian::new(&motion);
    let y = [prepared.q.as_slice(), &prepared.v].concat();
    reduced.linearise(&mut motion, prepared.start_time(), &y)?;
    Ok(reduced.jacobian().clone())
}

/// Returns the largest |λ| (1/s) of the eigenvalues λ that are no decays. For a decay, −Re λ is at
/// least |λ|/2, so the motion ends within one oscillation. Returns infinity if the eigenvalues
/// cannot be computed.
fn rate_of_others(a: &Matrix) -> f64 {
    let Some(pairs) = eigenpairs(a) else {
        return f64::INFINITY;
    };
    let rate = |pair: &Eigenpair| {
        let [re, im] = pair.value;
        let rate = re.hypot(im);
        (re > -0.5 * rate).then_some(rate)
    };
    pairs.iter().filter_map(rate).fold(0.0, f64::max)
}

/// Returns the rate (1/s) at which the configuration changes at the start. Translations are divided
/// by the size of the mechanism.
fn speed(prepared: &PreparedMechanism) -> f64 {
    let space = prepared.mechanism.space();
    let rate = |(j, v): (usize, &f64)| {
        let unit = if space.is_rotation(j) {
            1.0
        } else {
            prepared.assembly.size
        };
        v.abs() / unit
    };
    prepared.v.iter().enumerate().map(rate).fold(0.0, f64::max)
}

/// Estimates the spectral radius. A vector is repeatedly multiplied by the matrix, and the growth
/// of the vector gives the estimate. The geometric mean of the growth factors is also valid for
/// complex conjugate eigenvalues.
fn spectral_radius(a: &Matrix) -> f64 {
    let k = a.nrows();
    // It is improbable that an eigenvector is orthogonal to this vector.
    let mut x: Vec<f64> = (0..k).map(|i| 1.0 + 0.1 * (i as f64).sin()).collect();
    let mut logs = 0.0;
    for iteration in 0..POWER_ITERATIONS {
        let next = a.times(&x);
        let norm = next.iter().map(|x| x * x).sum::<f64>().sqrt();
        if norm == 0.0 || !norm.is_finite() {
            return if norm == 0.0 { 0.0 } else { f64::INFINITY };
        }
        x = next.iter().map(|x| x / norm).collect();
        if 2 * iteration >= POWER_ITERATIONS {
            logs += norm.ln();
        }
    }
    (2.0 * logs / POWER_ITERATIONS as f64).exp()
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use integrators::{Dop853, Function, InitialStep, Interval, Options, Tolerance, integrate};

    use super::*;

    /// Returns the growth factor of one step of 1 s for y' = −z·y, starting from 1.
    fn growth(z: f64) -> f64 {
        let options = Options {
            tolerance: Tolerance::Uniform {
                rtol: 0.1,
                atol: 1e9,
            },
            initial_step: InitialStep::Given(1.0),
            ..Options::with_tolerance(0.1, 1e9)
        };
        let mut decay = Function::new(1, |_, y: &[f64], dy: &mut [f64]| dy[0] = -z * y[0]);
        let once = Interval::new(0.0, 1.0);
        let outcome = integrate(&Dop853, &mut decay, &once, &[1.0], &options, |_| {
            ControlFlow::Continue(())
        });
        let outcome = outcome.unwrap();
        assert_eq!(outcome.statistics.accepted, 1);
        outcome.y[0].abs()
    }

    #[test]
    fn explicit_steps_are_stable_up_to_the_limit_and_not_far_beyond() {
        assert!(growth(STABLE) <= 1.0, "{}", growth(STABLE));
        assert!(growth(1.2 * STABLE) > 1.0, "{}", growth(1.2 * STABLE));
    }

    #[test]
    fn the_fastest_rate_is_found_also_of_oscillations() {
        // ẍ = −k·x next to a slow decay: |λ| = √k.
        let k = 1e10;
        let a = Matrix::from_rows(&[[0.0, 1.0, 0.0], [-k, 0.0, 0.0], [0.0, 0.0, -3.0]]);
        let found = spectral_radius(&a);
        assert!((found / 1e5 - 1.0).abs() < 0.05, "{found}");
        let a = Matrix::from_rows(&[[-2e6, 1.0], [0.0, -3.0]]);
        assert!((spectral_radius(&a) / 2e6 - 1.0).abs() < 1e-6);
        assert_eq!(spectral_radius(&Matrix::zeros(3, 3)), 0.0);
    }

    /// ẍ = −k·x − d·ẋ has λ = (−d ± √(d² − 4·k))/2.
    #[test]
    fn decays_and_oscillations_are_distinguished() {
        let k: f64 = 1e8;
        let critical = 2.0 * k.sqrt();
        for (damping, rate) in [(0.0, 1e4), (0.4, 1e4), (0.6, 0.0), (3.0, 0.0)] {
            let a = Matrix::from_rows(&[[0.0, 1.0], [-k, -damping * critical]]);
            let found = rate_of_others(&a);
            assert!((found - rate).abs() < 1e-6, "{damping}: {found}");
        }
        // A growing motion does not decay.
        let a = Matrix::from_rows(&[[-1e4, 1.0], [0.0, 3.0]]);
        assert!((rate_of_others(&a) - 3.0).abs() < 1e-9);
    }
}
