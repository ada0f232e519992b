//! What the entries of C are known to. Data stand in `f64`, rounded: an entry that is made of terms of size one and is 1e-17 may
//! as well be zero, one that is made of terms of size 1e-8 and is 1e-9 means something.

use joints::{Magnitude, Pose};
use linalg::Matrix;

use crate::description::BodyRef;
use crate::mechanism::{Mechanism, N_BODY, pose_of};
use crate::system::{Scratch, System};

/// Relative rounding error of a number stored in `f64`.
const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// How well a configuration is known along the motions that the constraints leave free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// As stored: it is the one that is meant.
    AsStored,
    /// To this share of a radian and of the lengths of the mechanism: what an integrator reached with about this tolerance.
    To(f64),
}

impl Known {
    /// Relative error of entries that turn with the bodies.
    fn relative(self) -> f64 {
        match self {
            Self::AsStored => UNIT_ROUNDOFF,
            Self::To(share) => share.abs().max(UNIT_ROUNDOFF),
        }
    }
}

impl Mechanism {
    /// How far each entry of C may be from that of the mechanism meant, (m+h) × n_v, in the units of C; allocates.
    ///
    /// An entry is known to the relative error of the data times the size of the terms it adds up, which its kernel on magnitudes
    /// gives. Points of bodies are known to the rounding of the positions of the bodies, because they are often read from global
    /// ones, and to what the constraints leave open, |Φ_i|. `size` is that of the mechanism. Needs Φ and C at the pose of the
    /// scratch.
    #[must_use]
    pub fn uncertainty(&self, s: &Scratch, q: &[f64], size: f64, known: Known) -> Matrix {
        let layout = self.layout();
        let of_entries = self.uncertainty_of_entries(s, q, size, known);
        let mut u = Matrix::zeros(layout.rows(), layout.n_v);
        for i in 0..layout.rows() {
            for k in layout.pattern.start[i]..layout.pattern.start[i + 1] {
                u[(i, layout.pattern.column[k])] += of_entries[k];
            }
        }
        u
    }

    /// The same for each entry of the pattern of C, in its order.
    #[must_use]
    pub fn uncertainty_of_entries(
        &self,
        s: &Scratch,
        q: &[f64],
        size: f64,
        known: Known,
    ) -> Vec<f64> {
        let layout = self.layout();
        let entries = self.magnitudes(s);
        let relative = known.relative() + self.relative_opening(s, size);
        let mut u = Vec::with_capacity(layout.pattern.column.len());
        for i in 0..layout.rows() {
            for k in layout.pattern.start[i]..layout.pattern.start[i + 1] {
                let mut by = relative * entries[layout.pattern.entry[k]].value();
                if layout.pattern.column[k] % N_BODY == 2 {
                    by += self.shift(s, i, q);
                }
                u.push(by);
            }
        }
        u
    }

    /// Sizes of the terms of all entries of C.
    fn magnitudes(&self, s: &Scratch) -> Vec<Magnitude> {
        let constant = self.constant_entries().iter();
        let mut entries: Vec<Magnitude> = constant.map(|&e| Magnitude::from(e)).collect();
        for c in self.constraints().iter().filter(|c| !c.varying.is_empty()) {
            // Between bodies only relative positions count, wherever they are.
            let origin = match (c.bodies.contains(&BodyRef::Ground), c.bodies.first()) {
                (false, Some(&first)) => pose_of(&s.poses, first),
                _ => Pose::GROUND,
            };
            let x: Vec<Pose<Magnitude>> = c
                .bodies
                .iter()
                .map(|&body| magnitude(&pose_of(&s.poses, body), &origin))
                .collect();
            let jets = s.jets[c.functions.clone()].iter();
            let f: Vec<[Magnitude; 3]> = jets.map(|jet| jet.map(Magnitude::from)).collect();
            c.element
                .magnitude()
                .c(&x, &f, &mut entries[c.entries.clone()]);
        }
        entries
    }

    /// How far the points of row `i` may be from where they are meant: rounding of positions, and |Φ_i|.
    fn shift(&self, s: &Scratch, i: usize, q: &[f64]) -> f64 {
        let translations = self.layout().row(s, i).filter(|(j, _)| j % N_BODY != 2);
        let rounding = translations.map(|(j, c)| c.abs() * q[j].abs()).sum::<f64>();
        UNIT_ROUNDOFF * rounding + s.phi.get(i).map_or(0.0, |phi| phi.abs())
    }
}

/// Sizes of what a pose contributes to a polynomial, with positions from an origin; cosine and sine are known to the rounding of their angle.
fn magnitude(pose: &Pose, origin: &Pose) -> Pose<Magnitude> {
    let turned = Magnitude::from(pose.angle.abs().max(1.0));
    Pose {
        x: (pose.x - origin.x).into(),
        y: (pose.y - origin.y).into(),
        angle: pose.angle.into(),
        cos: turned,
        sin: turned,
    }
}
