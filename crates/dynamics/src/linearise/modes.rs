//! Modes: eigenvalues of A and their mode shapes.

use super::Linearisation;

/// An eigenvalue and its mode shape. Complex numbers are stored as real and imaginary parts. Only
/// the eigenvalue with the positive imaginary part is listed for a conjugate pair.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Mode {
    /// The eigenvalue λ (1/s). The value is exactly zero if it is not larger than the rounding
    /// error.
    pub value: [f64; 2],
    /// Entries of the eigenvector, in the order of the states. The largest position is 1. If all
    /// positions are zero, the largest velocity is 1.
    pub states: Vec<[f64; 2]>,
}

impl Mode {
    /// Returns |λ| (rad/s).
    #[must_use]
    pub fn natural_frequency(&self) -> f64 {
        self.value[0].hypot(self.value[1])
    }

    /// Returns −Re λ/|λ|. The ratio is 1 for a mode that decays without oscillation, and −1 for a
    /// mode that grows without oscillation. The result is `None` for λ = 0.
    #[must_use]
    pub fn damping_ratio(&self) -> Option<f64> {
        let size = self.natural_frequency();
        (size > 0.0).then(|| 0.0 - self.value[0] / size)
    }

    /// Returns whether the mode oscillates.
    #[must_use]
    pub fn oscillates(&self) -> bool {
        self.value[1] != 0.0
    }
}

/// Stability of small motions at first order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stability {
    /// All small motions decay.
    Stable,
    /// Some motions neither decay nor grow at first order. Terms of higher order decide whether
    /// these motions grow.
    Marginal,
    /// Some motions grow.
    Unstable,
}

impl Stability {
    /// Returns the name of the result in output.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Marginal => "marginal",
            Self::Unstable => "unstable",
        }
    }

    /// Returns the stability that the modes imply.
    #[must_use]
    pub fn of(modes: &[Mode]) -> Self {
        let largest = modes
            .iter()
            .map(Mode::natural_frequency)
            .fold(0.0, f64::max);
        let limit = crate::limits::NEITHER * largest;
        if modes.iter().any(|m| m.value[0] > limit) {
            Self::Unstable
        } else if modes.iter().all(|m| m.value[0] < -limit) {
            Self::Stable
        } else {
            Self::Marginal
        }
    }
}

impl Linearisation {
    /// Returns the modes of A, sorted by their real parts, the largest first. Returns `None` if the
    /// eigenvalues do not converge.
    #[must_use]
    pub fn modes(&self) -> Option<Vec<Mode>> {
        let pairs = linalg::eigenpairs(&self.a)?;
        let size = |z: &[f64; 2]| z[0].hypot(z[1]);
        let largest = pairs.iter().map(|p| size(&p.value)).fold(0.0, f64::max);
        let zero = crate::limits::ZERO_EIGENVALUE * largest;
        let around = self.around_zero(pairs.iter().map(|pair| size(&pair.value)));
        let modes = pairs.into_iter().map(|pair| {
            let value = match pair.value {
                value if size(&value) <= zero.max(around) => [0.0; 2],
                value => value,
            };
            let (positions, velocities) = pair.vector.split_at(self.positions.len());
            let most = |part: &[[f64; 2]]| {
                part.iter()
                    .copied()
                    .fold([0.0; 2], |a, b| if size(&b) > size(&a) { b } else { a })
            };
            let [re, im] = match most(positions) {
                z if size(&z) > zero.max(f64::MIN_POSITIVE) * size(&most(velocities)) => z,
                _ => most(velocities),
            };
            let square = re * re + im * im;
            let scaled =
                |[x, y]: [f64; 2]| [(x * re + y * im) / square, (y * re - x * im) / square];
            Mode {
                value,
                states: pair.vector.into_iter().map(scaled).collect(),
            }
        });
        Some(modes.filter(|mode| mode.value[1] >= 0.0).collect())
    }

    /// Returns the radius of a circle around zero. Eigenvalues inside the circle would be zero
    /// without rounding. In a Jordan block of k rows, rounding changes zero eigenvalues by up to
    /// `‖A‖·ε^(1/k)`. This change may be far more than the square root of the rounding error,
    /// because the block may contain all eigenvalues.
    fn around_zero(&self, sizes: impl Iterator<Item = f64>) -> f64 {
        let entries = self.a.as_slice().iter();
        let norm = entries.map(|x| x * x).sum::<f64>().sqrt();
        let share = crate::limits::ZERO_ENTRY * self.a.nrows() as f64;
        let zero = linalg::zero_eigenvalue(&self.a, share * norm);
        let Some(last) = zero.multiplicity.checked_sub(1) else {
            return 0.0;
        };
        let bound = norm * share.powf(1.0 / zero.index as f64);
        let mut sizes: Vec<f64> = sizes.collect();
        sizes.sort_by(f64::total_cmp);
        sizes[..=last]
            .iter()
            .copied()
            .filter(|x| *x <= bound)
            .fold(0.0, f64::max)
    }

    /// Returns the displacement of all bodies (n_v values) at a phase (rad) of a mode whose largest
    /// position is `amplitude`.
    #[must_use]
    pub fn shape(&self, mode: &Mode, phase: f64, amplitude: f64) -> Vec<f64> {
        let (sin, cos) = phase.sin_cos();
        let states = mode.states.iter().take(self.positions.len());
        let at: Vec<f64> = states
            .map(|[re, im]| amplitude * (re * cos - im * sin))
            .collect();
        self.shapes.transpose_times(&at)
    }
}

#[cfg(test)]
mod tests {
    use linalg::Matrix;

    use super::{Linearisation, Stability};
    use crate::linearise::Coordinate;

    /// Returns a linearisation with this matrix. Positions come before velocities.
    fn with(a: Matrix, positions: usize) -> Linearisation {
        let coordinate = |k: usize| Coordinate {
            name: format!("x{k}"),
            unit: "m",
            body: 0,
            direction: 0,
        };
        let n = a.nrows();
        Linearisation {
            time: 0.0,
            q: Vec::new(),
            positions: (0..positions).map(coordinate).collect(),
            velocities: (positions..n).map(coordinate).collect(),
            inputs: Vec::new(),
            held: Vec::new(),
            b: Matrix::zeros(n, 0),
            a,
            second_order: None,
            shapes: Matrix::zeros(positions, 0),
            accuracy: 0.0,
        }
    }

    /// A vehicle on four wheels of 0.1 m rolls straight ahead at 1 m/s. The heading of the vehicle,
    /// the rotations of its wheels and its lateral position are positions of the state, and its
    /// speed is a velocity. All eigenvalues are zero. Rounding changes two of them to 3e-15 ±
    /// 3e-8i.
    #[test]
    fn rounding_around_a_multiple_zero_neither_grows_nor_decays() {
        let mut a = Matrix::zeros(7, 7);
        for wheel in 1..5 {
            a[(wheel, 6)] = 10.000000000000002;
        }
        let rounded = [
            [
                5.134781488891349e-15,
                -4.841833503095033e-16,
                -3.1680806762338373e-16,
            ],
            [
                1.0000000000000002,
                1.946676397674564e-17,
                4.5698073364484277e-17,
            ],
            [
                -3.63678714201638e-17,
                6.796383020318501e-32,
                4.978111621419721e-32,
            ],
        ];
        let ends = [
            [-7.278080531453108e-16, -1.2053105130153914e-15],
            [2.6213719656373513e-16, -9.392059896533363e-17],
            [4.430923523425174e-32, 1.2079446063184507e-16],
        ];
        for (row, (front, end)) in [0, 5, 6].into_iter().zip(rounded.into_iter().zip(ends)) {
            a.row_mut(row)[..3].copy_from_slice(&front);
            a.row_mut(row)[5..].copy_from_slice(&end);
        }
        let modes = with(a.clone(), 6).modes().expect("converges");
        assert!(modes.iter().all(|mode| mode.value == [0.0; 2]), "{modes:?}");
        assert_eq!(Stability::of(&modes), Stability::Marginal);
        // A growth rate of 1e-4 1/s is larger than these rounding errors.
        a[(0, 0)] = 1e-4;
        let modes = with(a, 6).modes().expect("converges");
        assert_eq!(Stability::of(&modes), Stability::Unstable);
        // Heading and lateral position with their rounding errors: λ² − 1e-4·λ − a₀₅·a₅₀ = 0.
        let half = 0.5e-4_f64;
        let expected = half + (half * half - 7.278080531453108e-16).sqrt();
        assert!((modes[0].value[0] - expected).abs() < 1e-14, "{modes:?}");
    }

    /// Three masses: one mass on a soft spring, one on a stiff spring and one without a spring.
    #[test]
    fn slow_modes_are_not_taken_for_zero() {
        let mut a = Matrix::zeros(6, 6);
        for k in 0..3 {
            a[(k, 3 + k)] = 1.0;
        }
        (a[(3, 0)], a[(4, 1)]) = (-1e6, -1e-3);
        let modes = with(a, 3).modes().expect("converges");
        let mut sizes: Vec<f64> = modes.iter().map(|mode| mode.natural_frequency()).collect();
        sizes.sort_by(f64::total_cmp);
        assert_eq!(sizes[..2], [0.0; 2]);
        assert!((sizes[2] - 1e-3_f64.sqrt()).abs() < 1e-9, "{sizes:?}");
        assert!((sizes[3] - 1e3).abs() < 1e-9, "{sizes:?}");
    }
}
