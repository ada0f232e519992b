//! The variation along which a derivative is taken: one degree of freedom of one body, time, or the
//! whole motion.

use super::case::{Case, Motion};
use super::number::Number;
use crate::plane::{N_DOF, Pose, Twist};

/// The curve through a state.
#[derive(Clone, Copy, Debug)]
pub(super) enum Along {
    /// The pose along one column of the block, everything else fixed.
    Pose(usize),
    /// The twist along one column of the block, everything else fixed.
    Twist(usize),
    /// Time, with fixed bodies: the functions of time advance.
    Time,
    /// `x + τv` with v fixed, and the functions of time advance; acceleration terms are omitted.
    Motion,
}

/// Poses, twists and functions of time at one point of a curve.
pub(super) struct State<D> {
    pub(super) x: Vec<Pose<D>>,
    pub(super) v: Vec<Twist<D>>,
    pub(super) f: Vec<[D; 3]>,
}

impl Along {
    /// The state at τ.
    pub(super) fn state<D: Number>(self, case: &Case, motion: &Motion, tau: D) -> State<D> {
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
            f: f.collect(),
        }
    }
}
