//! Finds a pose at which loops are closed. The search starts from a guess and uses least squares.
//! Its unknowns are the coordinates of the joints that define the positions of links. If the search
//! fails, the gaps of the guess are reduced in steps, and other guesses are tried.

mod loops;

use nalgebra::{DMatrix, DVector, Isometry3, Vector3};

use crate::couple;
use crate::limits::{ASSEMBLED, CLOSED, GUESSES, ITERATIONS, MOST_COORDINATES, OPEN};
use crate::mechanism::{JointKind, Model, redescribe};
use crate::pose::{JointPlacement, displaced, rotation};
use loops::{Gap, Tree};

/// A pose of all links.
pub(crate) struct Assembly {
    poses: Vec<Isometry3<f64>>,
    /// For each joint, the changes of the joint coordinates relative to the described pose.
    moved: Vec<[f64; 2]>,
    /// Displacements of the joints.
    displacements: Vec<Isometry3<f64>>,
    /// The largest remaining gap, as a share of the size of the model or in rad.
    pub(crate) gap: f64,
    /// Description of how the pose was found.
    pub(crate) way: &'static str,
}

impl Assembly {
    /// The pose of a keyframe that closes the loops. `moved` contains the changes of the joint
    /// coordinates.
    pub(crate) fn of_keyframe(
        model: &Model,
        moved: Vec<[f64; 2]>,
        displacements: Vec<Isometry3<f64>>,
    ) -> Self {
        let (q, moved) = (moved, displacements);
        let state = State { q, moved };
        Self {
            poses: state.poses(model),
            moved: state.q,
            displacements: state.moved,
            gap: 0.0,
            way: "",
        }
    }
}

/// Reason why no pose was found.
pub(crate) enum AssemblyFailure {
    /// The loop with the largest gap at the best pose, and this gap.
    Open(String, f64),
    /// The number of coordinates is above the limit.
    TooLarge(usize),
}

/// Returns the largest gap of a loop at the described pose.
pub(crate) fn gap(model: &Model) -> f64 {
    let tree = Tree::new(model);
    let state = State::new(model, &[]);
    let gaps = tree.gaps(model, &state.poses(model), &state.q);
    gaps.iter().map(Gap::size).fold(0.0, f64::max)
}

/// Returns the unit of gaps between points (m).
pub(crate) fn size(model: &Model) -> f64 {
    Tree::new(model).size
}

/// Returns the poses of the links for a guess of coordinate changes.
pub(crate) fn poses(model: &Model, guess: &[(usize, usize, f64)]) -> Vec<Isometry3<f64>> {
    State::new(model, guess).poses(model)
}

/// Returns descriptions of the gaps for these poses of the links and these coordinate changes. Each
/// description contains the name of the loop, the distance and the angle.
pub(crate) fn open(model: &Model, poses: &[Isometry3<f64>], moved: &[[f64; 2]]) -> Vec<String> {
    let gaps = Tree::new(model).gaps(model, poses, moved);
    let open = gaps.iter().filter(|gap| gap.size() > OPEN);
    open.map(|gap| format!("`{}` by {}", gap.name, gap.words()))
        .collect()
}

/// Assembles a model from a guess of the coordinate changes. Coordinates in `held` (joint,
/// coordinate) keep the values of the guess, if the loops can be closed with these values.
pub(crate) fn assemble(
    model: &Model,
    guess: &[(usize, usize, f64)],
    held: &[(usize, usize)],
) -> Result<Assembly, AssemblyFailure> {
    let tree = Tree::new(model);
    let n = tree.freedoms.len();
    if n > MOST_COORDINATES {
        return Err(AssemblyFailure::TooLarge(n));
    }
    let first = State::new(model, guess);
    // A requested pose is not replaced by a pose far away that leaves a gap.
    let needs_exact = !held.is_empty();
    let mut best = first.search(model, &tree.holding(held), needs_exact);
    if best.1 > ASSEMBLED && !held.is_empty() {
        let free = first.search(model, &tree, needs_exact);
        // If neither search closes the loops because the data have too few digits, the pose with
        // the requested values is used.
        if free.1 <= ASSEMBLED || best.1 > CLOSED {
            best = free;
        }
    }
    let (best, least, way) = best;
    let poses = best.poses(model);
    if least > CLOSED {
        let gaps = tree.gaps(model, &poses, &best.q);
        let worst = gaps.iter().max_by(|a, b| a.size().total_cmp(&b.size()));
        let name = worst.map_or_else(String::new, |gap| gap.name.clone());
        return Err(AssemblyFailure::Open(name, least));
    }
    Ok(Assembly {
        poses,
        moved: best.q,
        displacements: best.moved,
        gap: least,
        way,
    })
}

/// Replaces the described pose by the pose that was found. Springs, couplings and the orientations
/// of welds still refer to the pose of the file. Springs of spherical joints that have rotated
/// cannot refer to the pose of the file. These springs are removed, and the names of their joints
/// are returned.
pub(crate) fn describe(model: &mut Model, found: &Assembly) -> Vec<String> {
    let mut removed = Vec::new();
    for k in 0..model.joints.len() {
        let [a, b] = model.joints[k].links.map(|link| model.pose(link).rotation);
        let joint = &mut model.joints[k];
        let keeps = matches!(joint.kind, JointKind::Fixed | JointKind::Translational);
        if keeps && !joint.places && joint.frames.is_none() {
            joint.frames = Some([a.inverse() * b, Default::default()]);
        }
        redescribe(joint, found.moved[k]);
        let turned = found.displacements[k] != Isometry3::identity();
        if joint.kind == JointKind::Spherical && joint.loads[0].stiffness != 0.0 && turned {
            joint.loads[0].stiffness = 0.0;
            removed.push(joint.name.clone());
        }
    }
    for coupling in &mut model.couplings {
        let x = coupling.x.map_or(0.0, |(joint, c)| found.moved[joint][c]);
        coupling.coefficients = couple::about(&coupling.coefficients, x);
    }
    for (link, pose) in model.links.iter_mut().zip(&found.poses) {
        link.pose = *pose;
    }
    removed
}

/// Coordinates of all joints.
#[derive(Clone)]
struct State {
    q: Vec<[f64; 2]>,
    /// Displacements of the joints.
    moved: Vec<Isometry3<f64>>,
}

impl State {
    fn new(model: &Model, guess: &[(usize, usize, f64)]) -> Self {
        let mut q = vec![[0.0; 2]; model.joints.len()];
        for &(joint, coordinate, value) in guess {
            q[joint][coordinate] = value;
        }
        let moved = vec![Isometry3::identity(); model.joints.len()];
        let mut state = Self { q, moved };
        for joint in 0..model.joints.len() {
            state.follow(model, joint);
        }
        state
    }

    /// Computes the displacement of a joint from the joint coordinates, if the joint has
    /// coordinates.
    fn follow(&mut self, model: &Model, joint: usize) {
        let of = &model.joints[joint];
        let n = of.kind.measures().len();
        if n > 0 {
            self.moved[joint] =
                JointPlacement::of(model, of).displacement(of.kind, &self.q[joint][..n]);
        }
    }

    /// Searches from this state. Returns the state with the smallest gap, the gap, and a
    /// description of how the state was found. If `needs_exact` is true, a state that was found at
    /// random must close the loops.
    fn search(&self, model: &Model, tree: &Tree, needs_exact: bool) -> (Self, f64, &'static str) {
        let mut best = self.clone();
        let mut least = best.descend(model, tree, None);
        let mut way = "from the guess";
        if least > ASSEMBLED {
            let mut state = self.clone();
            let found = state.continue_from(model, tree);
            if found < least {
                (best, least, way) = (state, found, "by continuation from the guess");
            }
        }
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        for _ in 0..GUESSES {
            if least <= ASSEMBLED {
                break;
            }
            let mut state = self.clone();
            state.shake(model, tree, &mut random);
            let found = state.descend(model, tree, None);
            if found <= ASSEMBLED || (found < least && !needs_exact) {
                (best, least, way) = (state, found, "from another guess, found at random");
            }
        }
        (best, least, way)
    }

    fn displacements(&self, model: &Model) -> Vec<Isometry3<f64>> {
        displaced(model, &self.moved)
    }

    fn poses(&self, model: &Model) -> Vec<Isometry3<f64>> {
        let displaced = self.displacements(model);
        let links = model.links.iter().zip(displaced);
        links.map(|(link, g)| g * link.pose).collect()
    }

    /// Sets random values of all coordinates that are not in `held`.
    fn shake(&mut self, model: &Model, tree: &Tree, random: &mut Random) {
        for (k, joint) in model
            .joints
            .iter()
            .enumerate()
            .filter(|(_, joint)| joint.places)
        {
            for c in 0..joint.kind.measures().len() {
                let range = match joint.kind.measures()[c] {
                    "displacement" => 0.2,
                    _ => 1.5,
                };
                let by = range * random.signed();
                if !tree.held.contains(&(k, c)) {
                    self.q[k][c] += by;
                }
            }
            if joint.kind == JointKind::Spherical {
                let axis = Vector3::new(random.signed(), random.signed(), random.signed());
                let place = JointPlacement::of(model, joint);
                let turn = place.turn(rotation(
                    axis.try_normalize(1e-9).unwrap_or_default(),
                    random.signed(),
                ));
                self.moved[k] = turn * self.moved[k];
            }
            self.follow(model, k);
        }
    }

    /// Closes the loops in steps by reducing the gaps of the guess gradually.
    fn continue_from(&mut self, model: &Model, tree: &Tree) -> f64 {
        let start = tree.residual(model, &self.poses(model), &self.q);
        let (mut share, mut step): (f64, f64) = (1.0, 0.125);
        while share > 0.0 && step > 1e-3 {
            let next = (share - step).max(0.0);
            let mut trial = self.clone();
            let target = &start * next;
            if trial.descend(model, tree, Some(&target)) <= ASSEMBLED {
                *self = trial;
                share = next;
                step *= 1.5;
            } else {
                step *= 0.5;
            }
        }
        self.descend(model, tree, None)
    }

    /// Least squares with Levenberg–Marquardt steps towards a target, by default zero; returns the
    /// largest residual.
    fn descend(&mut self, model: &Model, tree: &Tree, target: Option<&DVector<f64>>) -> f64 {
        let off = |state: &Self| {
            let r = tree.residual(model, &state.poses(model), &state.q);
            target.map_or_else(|| r.clone(), |target| &r - target)
        };
        let mut r = off(self);
        let mut damping = 1e-3;
        for _ in 0..ITERATIONS {
            if r.amax() <= ASSEMBLED * 1e-3 {
                break;
            }
            let j = tree.jacobian(model, &self.displacements(model), &self.q);
            let (normal, gradient) = (j.transpose() * &j, j.transpose() * &r);
            let mut improved = false;
            for _ in 0..12 {
                let n = normal.nrows();
                let damped = &normal + DMatrix::identity(n, n) * damping;
                let Some(factor) = damped.cholesky() else {
                    damping *= 8.0;
                    continue;
                };
                let mut step = factor.solve(&gradient);
                // The step is at most half a radian, or half of the size of the model.
                let longest = step.amax();
                if longest > 0.5 {
                    step *= 0.5 / longest;
                }
                let mut trial = self.clone();
                tree.advance(model, &mut trial, &(-step));
                let found = off(&trial);
                if found.norm() < r.norm() {
                    *self = trial;
                    r = found;
                    damping = (damping * 0.1).max(1e-14);
                    improved = true;
                    break;
                }
                damping *= 8.0;
            }
            if !improved {
                break;
            }
        }
        let largest = r.amax();
        if largest.is_finite() {
            largest
        } else {
            f64::INFINITY
        }
    }
}

/// A pseudo-random number generator (xorshift64*).
struct Random(u64);

impl Random {
    /// A number from −1 to 1.
    fn signed(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = u32::try_from(self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32).unwrap_or(0);
        f64::from(high) / f64::from(u32::MAX) * 2.0 - 1.0
    }
}
