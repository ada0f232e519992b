//! Computes the reactions of a drawing at rest under gravity. The equations of motion are solved in
//! double precision with the rank from exact arithmetic. All bodies have 1 kg and 1 kg·m².

use pfaff::linalg::{Matrix, small_svd};

use super::doubles::Doubles;
use super::lift;
use super::pose::Posed;

/// Reactions, and the largest load.
#[derive(Clone)]
pub struct Reactions {
    /// For each joint or drive, Fx and Fy (N) and the torque about the reference point (N·m) on the
    /// first body, for the multipliers of minimum norm. The torque is `None` if the drawing does
    /// not define the reference point.
    pub each: Vec<([f64; 2], Option<f64>)>,
    /// The largest applied or inertial force (N; torques divided by the size).
    pub load: f64,
}

impl Doubles {
    /// Returns reactions at rest.
    #[must_use]
    pub fn reactions(&self, posed: &Posed, rank: usize, gravity: [f64; 2]) -> Reactions {
        let n = self.q.len();
        // Rotations are multiplied by the size, so a moment of inertia is divided by the square of
        // the size.
        let mass = |j: usize| match j % 3 {
            2 => 1.0 / (self.size * self.size),
            _ => 1.0,
        };
        let force = |j: usize| match j % 3 {
            2 => 0.0,
            axis => gravity[axis],
        };
        let c = self.c(&self.q, &self.data);
        // The equation is Aᵀ·λ = M^(−1/2)·Q. The part of Q that the rows cannot balance causes
        // accelerations.
        let a = Matrix::from_fn(c.nrows(), n, |i, j| c[(i, j)] / mass(j).sqrt());
        let svd = small_svd(&a);
        let mut lambda = vec![0.0; c.nrows()];
        for k in 0..rank.min(svd.sigma.len()) {
            let along: f64 = (0..n)
                .map(|j| svd.v[(j, k)] * force(j) / mass(j).sqrt())
                .sum();
            for (i, lambda) in lambda.iter_mut().enumerate() {
                *lambda += svd.u[(i, k)] * along / svd.sigma[k];
            }
        }
        let carried = c.transpose_times(&lambda);
        let load = (0..n).map(|j| (force(j) - carried[j]).abs().max(force(j).abs()));
        let each = (0..posed.links.len()).map(|link| self.reaction(posed, &c, &lambda, link));
        Reactions {
            each: each.collect(),
            load: load.fold(0.0, f64::max),
        }
    }

    fn reaction(
        &self,
        posed: &Posed,
        c: &Matrix,
        lambda: &[f64],
        link: usize,
    ) -> ([f64; 2], Option<f64>) {
        let tie = &posed.links[link].link;
        let own: Vec<usize> = (0..self.rows())
            .filter(|&i| self.links[i] == link)
            .collect();
        let on = |j: usize| -> f64 { own.iter().map(|&i| -c[(i, j)] * lambda[i]).sum() };
        let world = |p| {
            posed
                .point(p)
                .map(|x: super::ratio::Surd| x.rounded(posed.stretch))
        };
        let place = lift::place(&tie.tie).map(world);
        let moving = |body: usize| {
            let ([x, y], about) = (
                [on(3 * body), on(3 * body + 1)],
                self.size * on(3 * body + 2),
            );
            let origin = [self.q[3 * body], self.q[3 * body + 1]];
            let moment = place.map(|p| about + (origin[0] - p[0]) * y - (origin[1] - p[1]) * x);
            ([x, y], moment)
        };
        match tie.sides[0] {
            Some(body) => moving(body),
            None => {
                // The part of the load that the other bodies do not balance.
                let mut others: Vec<usize> = tie.sides[1..].iter().copied().flatten().collect();
                others.sort_unstable();
                others.dedup();
                let mut sum = ([0.0; 2], Some(0.0));
                for body in others {
                    let ([x, y], moment) = moving(body);
                    sum.0 = [sum.0[0] - x, sum.0[1] - y];
                    sum.1 = sum.1.zip(moment).map(|(a, b)| a - b);
                }
                sum
            }
        }
    }
}
