//! The arguments of a kernel, and the arguments that vary when a derivative is computed. The
//! varying arguments are one velocity component of one body, the time, or everything along the
//! motion.

use crate::bodies::Bodies;
use crate::case::{Case, Motion};
use crate::number::Number;

/// A curve through a state along which a derivative is computed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Along {
    /// The pose varies along one column of the block; all other arguments are constant.
    Pose(usize),
    /// The twist varies along one column of the block; all other arguments are constant.
    Twist(usize),
    /// The time varies, and the functions of time vary with it. The bodies do not move.
    Time,
    /// The bodies move by `x + τv` with constant v, and the time varies, too. Terms with
    /// accelerations are omitted.
    Motion,
}

/// The arguments of kernels at one point of a curve.
pub(crate) struct State<S: Bodies, D: Number> {
    pub(crate) x: Vec<S::Pose<D>>,
    /// Velocities and accelerations, one for each velocity component.
    pub(crate) v: Vec<D>,
    pub(crate) a: Vec<D>,
    pub(crate) f: Vec<[D; 3]>,
    pub(crate) lambda: Vec<D>,
}

impl<S: Bodies, D: Number> State<S, D> {
    /// Returns the twists of the bodies.
    pub(crate) fn twists(numbers: &[D]) -> Vec<S::Twist<D>> {
        numbers.chunks(S::N_DOF).map(S::twist).collect()
    }
}

impl Along {
    /// Returns the state at τ.
    pub(crate) fn state<S: Bodies, D: Number>(
        self,
        case: &Case<S>,
        motion: &Motion,
        tau: D,
    ) -> State<S, D> {
        let line = |start: f64, rate: f64| D::from(start) + D::from(rate) * tau;
        let unit = |column: usize, k: usize| if column == k { 1.0 } else { 0.0 };
        let rates: Vec<f64> = (0..motion.v.len())
            .map(|k| match self {
                Self::Pose(column) => unit(column, k),
                Self::Motion => motion.v[k],
                Self::Twist(_) | Self::Time => 0.0,
            })
            .collect();
        let bodies = case.x.iter().zip(rates.chunks(S::N_DOF));
        let v = motion.v.iter().enumerate().map(|(k, &v)| match self {
            Self::Twist(column) => line(v, unit(column, k)),
            _ => D::from(v),
        });
        let mut f: Vec<[D; 3]> = case
            .f
            .iter()
            .map(|&[f, f_t, f_tt]| match self {
                Self::Time | Self::Motion => [
                    line(f, f_t) + D::from(0.5 * f_tt) * tau * tau,
                    line(f_t, f_tt),
                    D::from(f_tt),
                ],
                _ => [f, f_t, f_tt].map(D::from),
            })
            .collect();
        if case.turning
            && let Some(angle) = f.pop()
        {
            f.extend(turn(angle));
        }
        for &known in &case.counted {
            let (sin, cos) = known.sin_cos();
            let zero = D::from(0.0);
            f.extend([known, cos, sin].map(|value| [D::from(value), zero, zero]));
        }
        State {
            x: bodies.map(|(x, v)| S::moved(x, v, tau)).collect(),
            v: v.collect(),
            a: motion.a.iter().map(|&a| D::from(a)).collect(),
            f,
            lambda: motion.lambda.iter().map(|&l| D::from(l)).collect(),
        }
    }
}

/// Returns the cosine and the sine of an angle, each with two derivatives.
fn turn<D: Number>([f, f_t, f_tt]: [D; 3]) -> [[D; 3]; 2] {
    let (sin, cos) = f.sin_cos();
    let square = f_t * f_t;
    [
        [cos, -(sin * f_t), -(cos * square) - sin * f_tt],
        [sin, cos * f_t, cos * f_tt - sin * square],
    ]
}
