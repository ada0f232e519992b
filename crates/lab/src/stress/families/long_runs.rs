//! Very long runs: a pendulum for a thousand seconds in steps of a millisecond, mechanisms in space
//! for a hundred seconds, and the drift of constant values.

use std::time::Duration;

use dynamics::{Method, MotionOptions, PreparedMechanism};
use model::SpatialDescription;

use crate::mechanisms::space;
use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{last_row, moving, prepared, study, worst};

/// A pendulum in a million steps, and mechanisms in space.
pub(super) const FAMILY: Family = Family {
    name: "long-runs",
    about: "a pendulum for 1000 s in a million steps: drift off the constraints, energy, and its amplitude and period; a top and overconstrained linkages in space for 100 s",
    cases,
};

const T_END: f64 = 1000.0;

/// Size of the steps (s).
const STEP: f64 = 1e-3;

const TIME_LIMIT: Duration = Duration::from_secs(120);

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for method in [Method::Dop853, Method::Tsit5] {
        let options = MotionOptions {
            method,
            rtol: 1e-14,
            atol: 1e-14,
            max_step: STEP,
            max_steps: 2_000_000,
            output_step: T_END,
            ..MotionOptions::to(T_END)
        };
        let right = Expected::answer(
            1.0,
            "in units of what is allowed: 1e-12 for every |Φ| and |C·v − b|; 1e-12 for energy, on which no work is done; 1e-8 rad and rad/s against \
             Jacobi's elliptic functions: a speed off by the energy's 1e-12 moves the phase of 500 swings by 1e-9",
        );
        let made = moving("a million steps", options, right, |options| {
            drifted(&study(&pendulum())?.prepared, options)
        });
        cases.push(made.within(TIME_LIMIT));
    }
    cases.extend(in_space());
    cases
}

/// A function that returns a description, or the reason why it cannot be created.
type Made = fn() -> Result<SpatialDescription, Outcome>;

/// Returns cases for a top, and for linkages that move although Grübler's formula gives zero
/// degrees of freedom.
fn in_space() -> impl Iterator<Item = Case> {
    let mechanisms: [(&str, Made); 3] = [
        ("a top", || Ok(space::top())),
        ("Bricard's linkage", || Ok(space::bricard())),
        ("Bennett's linkage", || {
            space::bennett().map_err(Outcome::refused)
        }),
    ];
    mechanisms.into_iter().map(|(name, description)| {
        let t_end = 100.0;
        let options = MotionOptions {
            method: Method::Dop853,
            rtol: 1e-14,
            atol: 1e-14,
            max_steps: 2_000_000,
            output_step: t_end / 100.0,
            ..MotionOptions::to(t_end)
        };
        let right = Expected::answer(
            1.0,
            "in units of what is allowed: 1e-12 for every |Φ| relative to the size, and |C·v − b| relative to the largest velocity at the end; 1e-11 for energy, on which no work is done",
        );
        let made = moving(name, options, right, move |options| {
            let prepared = prepared(&description()?)?;
            let (row, s) = last_row(&prepared, options)?;
            let fastest = worst(row.v).max(1.0);
            let position = s.max_position_residual / prepared.assembly.size.max(1.0);
            let residual = worst([position, s.max_velocity_residual / fastest]);
            let detail = format!(
                "{} steps, residuals {residual:.1e}, energy {:.1e}",
                s.steps, s.energy_balance
            );
            let error = worst([residual / 1e-12, s.energy_balance / 1e-11]);
            Ok(Outcome::answer(error, detail))
        });
        made.within(TIME_LIMIT)
    })
}

/// Returns the drift in a run, relative to the allowed drift.
fn drifted(prepared: &PreparedMechanism, options: &MotionOptions) -> Result<Outcome, Outcome> {
    let (row, s) = last_row(prepared, options)?;
    let [angle, omega] = swing(row.t);
    let phase = worst([row.q[2] - angle, row.v[2] - omega]);
    let residual = worst([s.max_position_residual, s.max_velocity_residual]);
    let detail = format!(
        "{} steps, residuals {residual:.1e}, energy {:.1e}, phase {phase:.1e} rad",
        s.steps, s.energy_balance
    );
    let error = worst([residual / 1e-12, s.energy_balance / 1e-12, phase / 1e-8]);
    Ok(Outcome::answer(error, detail))
}

/// Returns a point mass on a massless rod of 1 m, released from the horizontal.
fn pendulum() -> String {
    suite::find("a01-pendulum").map_or_else(String::new, |case| case.scene.to_owned())
}

/// Returns the angle φ of the bob relative to its initial position, and its rate, at t. The bob is
/// released to the left of the pivot at the same height. Then `φ̈ = (g/L)·cos φ`, with φ from 0 to
/// π and back. With `ψ = φ − π/2` the solution is `sin(ψ/2) = −k·cd(ω₀t)`, `k = sin(45°)`.
pub(super) fn swing(t: f64) -> [f64; 2] {
    let omega_0 = 9.81_f64.sqrt();
    let m = 0.5_f64;
    let [sn, cn, dn] = jacobi(omega_0 * t, m);
    // The function is −cd(u) = −cn/dn, and its derivative is (1 − m)·sn/dn².
    let k = m.sqrt();
    let half = k * -cn / dn;
    let half_rate = k * omega_0 * (1.0 - m) * sn / (dn * dn);
    let angle = 2.0 * half.asin();
    [
        angle + std::f64::consts::FRAC_PI_2,
        2.0 * half_rate / (1.0 - half * half).sqrt(),
    ]
}

/// Returns sn, cn, dn of (u | m) by descending Landen transformations. Source: Abramowitz and
/// Stegun, 16.4.
fn jacobi(u: f64, m: f64) -> [f64; 3] {
    const LEVELS: usize = 8;
    let (mut a, mut c) = ([1.0; LEVELS + 1], [m.sqrt(); LEVELS + 1]);
    let mut b = (1.0 - m).sqrt();
    for n in 0..LEVELS {
        a[n + 1] = 0.5 * (a[n] + b);
        c[n + 1] = 0.5 * (a[n] - b);
        b = (a[n] * b).sqrt();
    }
    // Whole periods are subtracted first, because the doublings would lose digits for a large
    // amplitude.
    let period = 2.0 * std::f64::consts::PI / a[LEVELS];
    let u = u - period * (u / period).round();
    let mut phi = 2.0_f64.powi(LEVELS as i32) * a[LEVELS] * u;
    let mut after = phi;
    for n in (1..=LEVELS).rev() {
        after = phi;
        phi = 0.5 * (phi + (c[n] / a[n] * phi.sin()).asin());
    }
    let (sin, cos) = phi.sin_cos();
    let dn = match (after - phi).cos() {
        small if small.abs() < 0.1 => (1.0 - m * sin * sin).sqrt(),
        divisor => cos / divisor,
    };
    [sin, cos, dn]
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;
    use crate::stress::motion::outcome;

    /// The solution satisfies the differential equation, and its quarter period equals K(1/2) =
    /// 1.85407467730137192.
    #[test]
    fn the_closed_form_swings() {
        let quarter = 1.854_074_677_301_371_9 / 9.81_f64.sqrt();
        let [angle, omega] = swing(quarter);
        assert!(
            (angle - std::f64::consts::FRAC_PI_2).abs() < 1e-14,
            "{angle}"
        );
        assert!((omega - (2.0 * 9.81_f64).sqrt()).abs() < 1e-14, "{omega}");
        for t in [0.0, 0.3, 1.0, 7.7, 1000.0] {
            let [angle, omega] = swing(t);
            let energy = 0.5 * omega * omega - 9.81 * angle.sin();
            assert!(energy.abs() < 1e-12, "{t}: {energy}");
        }
    }

    #[test]
    fn a_swing_of_another_pendulum_is_silently_wrong() {
        let options = MotionOptions::to(10.0);
        let shorter = pendulum().replace("[-1.0, 0.0]", "[-0.999, 0.0]");
        for (text, expected) in [
            (pendulum(), Judgement::Right),
            (shorter, Judgement::SilentlyWrong),
        ] {
            let found = outcome(&text, &options, |row, _| {
                let [angle, omega] = swing(row.t);
                worst([row.q[2] - angle, row.v[2] - omega])
            });
            assert_eq!(
                judge(&Expected::answer(1e-5, "closed form"), &found),
                expected
            );
        }
    }
}
