//! Modes: eigenvalues of A with the shapes that belong to them.

use super::Linearisation;

/// An eigenvalue and its shape; complex numbers as real and imaginary parts. Of a conjugate pair
/// only the one with the positive imaginary part is listed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Mode {
    /// The eigenvalue λ (1/s); exactly zero if rounding explains it.
    pub value: [f64; 2],
    /// Entries of the eigenvector, in the order of the states; the largest of the positions is 1,
    /// or of the velocities if no position takes part.
    pub states: Vec<[f64; 2]>,
}

impl Mode {
    /// |λ| (rad/s).
    #[must_use]
    pub fn natural_frequency(&self) -> f64 {
        self.value[0].hypot(self.value[1])
    }

    /// −Re λ/|λ|: 1 for a mode that decays without oscillation, −1 for one that grows so; `None`
    /// for λ = 0.
    #[must_use]
    pub fn damping_ratio(&self) -> Option<f64> {
        let size = self.natural_frequency();
        (size > 0.0).then(|| 0.0 - self.value[0] / size)
    }

    /// Whether it oscillates.
    #[must_use]
    pub fn oscillates(&self) -> bool {
        self.value[1] != 0.0
    }
}

/// What first order says of small motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stability {
    /// All small motions decay.
    Stable,
    /// Some neither decay nor grow at first order; terms of higher order decide.
    Marginal,
    /// Some grow.
    Unstable,
}

impl Stability {
    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Marginal => "marginal",
            Self::Unstable => "unstable",
        }
    }

    /// What the modes say.
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
    /// The modes of A, by their real parts, the largest first. `None` if they are not found.
    #[cfg(feature = "eigen")]
    #[must_use]
    pub fn modes(&self) -> Option<Vec<Mode>> {
        let pairs = linalg::eigenpairs(&self.a)?;
        let size = |z: &[f64; 2]| z[0].hypot(z[1]);
        let largest = pairs.iter().map(|p| size(&p.value)).fold(0.0, f64::max);
        let zero = crate::limits::ZERO_EIGENVALUE * largest;
        let modes = pairs.into_iter().map(|pair| {
            let value = match pair.value {
                value if size(&value) <= zero => [0.0; 2],
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

    /// The displacement of all bodies at a phase (rad) of a mode whose largest position is
    /// `amplitude`, n_v.
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
