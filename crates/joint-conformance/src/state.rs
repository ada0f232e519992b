//! What a kernel takes, and what of it moves while a derivative is taken: one degree of freedom of
//! one body, time, or everything along the motion.

use joints::plane::{N_DOF, Pose, Twist};

use crate::case::{Case, Motion};
use crate::number::Number;

/// The curve through a state.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Along {
    /// The pose along one column of the block, all else fixed.
    Pose(usize),
    /// The twist along one column of the block, everything else fixed.
    Twist(usize),
    /// Time, with fixed bodies: the functions of time advance.
    Time,
    /// `x + τv` with v fixed, and the functions of time advance; acceleration terms are omitted.
    Motion,
}

/// What kernels take, at one point of a curve.
pub(crate) struct State<D> {
    pub(crate) x: Vec<Pose<D>>,
    pub(crate) v: Vec<Twist<D>>,
    pub(crate) a: Vec<Twist<D>>,
    pub(crate) f: Vec<[D; 3]>,
    pub(crate) lambda: Vec<D>,
}

impl Along {
    /// The state at τ.
    pub(crate) fn state<D: Number>(self, case: &Case, motion: &Motion, tau: D) -> State<D> {
        let line = |start: f64, rate: f64| D::from(start) + D::from(rate) * tau;
        let unit = |column: usize, k: usize| if column == k { 1.0 } else { 0.0 };
        let x = case
            .x
            .iter()
            .zip(&motion.v)
            .enumerate()
            .map(|(slot, (x, v))| {
                let rate = |dof: usize| match self {
                    Self::Pose(column) => unit(column, N_DOF * slot + dof),
                    Self::Motion => [v.x, v.y, v.omega][dof],
                    Self::Twist(_) | Self::Time => 0.0,
                };
                let angle = line(x.angle, rate(2));
                let (sin, cos) = angle.sin_cos();
                Pose {
                    x: line(x.x, rate(0)),
                    y: line(x.y, rate(1)),
                    angle,
                    cos,
                    sin,
                }
            });
        let v = motion.v.iter().enumerate().map(|(slot, v)| {
            let rate = |dof: usize| match self {
                Self::Twist(column) => unit(column, N_DOF * slot + dof),
                _ => 0.0,
            };
            Twist {
                x: line(v.x, rate(0)),
                y: line(v.y, rate(1)),
                omega: line(v.omega, rate(2)),
            }
        });
        let a = motion.a.iter().map(|a| Twist {
            x: D::from(a.x),
            y: D::from(a.y),
            omega: D::from(a.omega),
        });
        let f = case.f.iter().map(|&[f, f_t, f_tt]| match self {
            Self::Time | Self::Motion => [
                line(f, f_t) + D::from(0.5 * f_tt) * tau * tau,
                line(f_t, f_tt),
                D::from(f_tt),
            ],
            _ => [f, f_t, f_tt].map(D::from),
        });
        State {
            x: x.collect(),
            v: v.collect(),
            a: a.collect(),
            f: f.collect(),
            lambda: motion.lambda.iter().map(|&l| D::from(l)).collect(),
        }
    }
}

/// Twists as one vector, degree of freedom by degree of freedom.
pub(crate) fn stacked<D: Copy>(twists: &[Twist<D>]) -> Vec<D> {
    twists.iter().flat_map(|t| [t.x, t.y, t.omega]).collect()
}
