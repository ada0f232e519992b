//! Gaps of loops at a pose, and their derivatives with respect to the joint coordinates.

use model::words::quantity;
use nalgebra::{DMatrix, DVector, Isometry3, Point3, UnitQuaternion, Vector3};

use super::State;
use crate::limits::{DIFFERENCE, OPEN};
use crate::mechanism::{Joint, JointKind, Model};
use crate::pose::{JointPlacement, placing, rotation};

/// A degree of freedom by which a joint moves the links after this joint.
#[derive(Clone, Copy)]
pub(super) struct Freedom {
    joint: usize,
    kind: Way,
}

#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// A coordinate of the joint.
    Coordinate(usize),
    /// A rotation about the k-th axis of the ground through the point of the joint.
    Turn(usize),
    /// A translation along the k-th axis of the ground.
    Shift(usize),
}

/// Gap of one loop or coupling.
pub(super) struct Gap {
    pub(super) name: String,
    miss: Miss,
    /// Length by which distances are divided (m).
    size: f64,
}

/// Rows of one gap.
#[derive(Default)]
struct Miss {
    /// Components of distances, divided by a length.
    shares: Vec<f64>,
    /// Angles (rad).
    angles: Vec<f64>,
}

impl Gap {
    fn rows(&self) -> impl Iterator<Item = f64> {
        self.miss.shares.iter().chain(&self.miss.angles).copied()
    }

    pub(super) fn size(&self) -> f64 {
        self.rows().fold(0.0, |most: f64, x| most.max(x.abs()))
    }

    /// The gap as text: distance and angle.
    pub(super) fn words(&self) -> String {
        let norm = |list: &[f64]| list.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (far, turned) = (norm(&self.miss.shares), norm(&self.miss.angles));
        let mut words = Vec::new();
        if far > OPEN {
            words.push(quantity(far * self.size, "m"));
        }
        if turned > OPEN {
            words.push(quantity(turned, "rad"));
        }
        words.join(" and ")
    }
}

/// The tree of links with the degrees of freedom that move the links.
#[derive(Clone)]
pub(super) struct Tree {
    pub(super) freedoms: Vec<Freedom>,
    /// Joints with the indices of coordinates whose values are fixed.
    pub(super) held: Vec<(usize, usize)>,
    /// For each link, the joints between the ground and the link.
    chains: Vec<Vec<usize>>,
    /// Length by which gaps between points are divided (m).
    pub(super) size: f64,
}

impl Tree {
    pub(super) fn new(model: &Model) -> Self {
        let before = placing(model);
        let chains: Vec<Vec<usize>> = (0..model.links.len())
            .map(|link| {
                let (mut chain, mut at) = (Vec::new(), Some(link));
                while let Some(joint) = at.and_then(|link| before[link]) {
                    chain.push(joint);
                    if chain.len() > model.joints.len() {
                        break;
                    }
                    at = model.joints[joint].links[0];
                }
                chain
            })
            .collect();
        let closing = |joint: &&Joint| !joint.places && joint.is_active;
        let mut moves = vec![false; model.joints.len()];
        for link in model
            .joints
            .iter()
            .filter(closing)
            .flat_map(|joint| joint.links)
            .flatten()
        {
            for &joint in &chains[link] {
                moves[joint] = true;
            }
        }
        for coupling in model.couplings.iter().filter(|coupling| coupling.is_active) {
            moves[coupling.y.0] = true;
        }
        let mut freedoms = Vec::new();
        for (k, joint) in model.joints.iter().enumerate().filter(|(k, _)| moves[*k]) {
            let mut add = |kind| freedoms.push(Freedom { joint: k, kind });
            match joint.kind {
                JointKind::Spherical => (0..3).for_each(|axis| add(Way::Turn(axis))),
                // Planar joints of the tree do not move. Only the loops correct steps out of the
                // plane.
                JointKind::Fixed | JointKind::Free | JointKind::Planar => {}
                kind => (0..kind.measures().len()).for_each(|c| add(Way::Coordinate(c))),
            }
            if joint.kind == JointKind::Free {
                (0..3).for_each(|axis| add(Way::Shift(axis)));
                (0..3).for_each(|axis| add(Way::Turn(axis)));
            }
        }
        let points = model.links.iter().map(|link| link.pose.translation.vector);
        let (low, high) = points.fold(
            (
                Vector3::repeat(f64::INFINITY),
                Vector3::repeat(f64::NEG_INFINITY),
            ),
            |(low, high), p| (low.inf(&p), high.sup(&p)),
        );
        let size = (high - low).norm();
        let size = if size > 0.0 && size.is_finite() {
            size
        } else {
            1.0
        };
        Self {
            freedoms,
            held: Vec::new(),
            chains,
            size,
        }
    }

    /// The same tree with the fixed coordinates `held`.
    pub(super) fn holding(&self, held: &[(usize, usize)]) -> Self {
        let mut tree = self.clone();
        tree.held = held.to_vec();
        tree.freedoms.retain(|freedom| {
            let is = |&(joint, c)| freedom.joint == joint && freedom.kind == Way::Coordinate(c);
            !held.iter().any(is)
        });
        tree
    }

    /// Gaps of every active loop and coupling at these poses.
    pub(super) fn gaps(&self, model: &Model, poses: &[Isometry3<f64>], q: &[[f64; 2]]) -> Vec<Gap> {
        let closing = model
            .joints
            .iter()
            .filter(|joint| !joint.places && joint.is_active);
        let mut gaps: Vec<Gap> = closing
            .filter(|joint| joint.kind != JointKind::Free)
            .map(|joint| Gap {
                name: joint.name.clone(),
                miss: self.miss(model, joint, poses),
                size: self.size,
            })
            .collect();
        for coupling in model.couplings.iter().filter(|coupling| coupling.is_active) {
            let (joint, c) = coupling.y;
            let x = coupling.x.map_or(0.0, |(joint, c)| q[joint][c]);
            let value = coupling
                .coefficients
                .iter()
                .rev()
                .fold(0.0, |sum, c| sum * x + c);
            let off = vec![q[joint][c] - value];
            let measure = model.joints[joint].kind.measures().get(c);
            let (shares, angles) = match measure {
                Some(&"displacement") => (off, Vec::new()),
                _ => (Vec::new(), off),
            };
            gaps.push(Gap {
                name: coupling.name.clone(),
                miss: Miss { shares, angles },
                size: 1.0,
            });
        }
        gaps
    }

    pub(super) fn residual(
        &self,
        model: &Model,
        poses: &[Isometry3<f64>],
        q: &[[f64; 2]],
    ) -> DVector<f64> {
        let gaps = self.gaps(model, poses, q);
        let rows: Vec<f64> = gaps.iter().flat_map(Gap::rows).collect();
        DVector::from_vec(rows)
    }

    /// Gaps of one joint: between points as a share of the size of the model, between directions in
    /// rad.
    fn miss(&self, model: &Model, joint: &Joint, poses: &[Isometry3<f64>]) -> Miss {
        let of =
            |side: usize| joint.links[side].map_or_else(Isometry3::identity, |link| poses[link]);
        let at = [of(0), of(1)];
        let point = |side: usize| (at[side] * Point3::from(joint.points[side])).coords;
        let apart = (point(1) - point(0)) / self.size;
        let axes = [0, 1].map(|side| at[side].rotation * joint.axes[side]);
        let across = apart - axes[0] * axes[0].dot(&apart);
        let tilt = axes[0].cross(&axes[1]);
        let frames = joint
            .frames
            .unwrap_or_else(|| joint.links.map(|link| model.pose(link).rotation.inverse()));
        let turned: UnitQuaternion<f64> =
            (at[1].rotation * frames[1]) * (at[0].rotation * frames[0]).inverse();
        let right = axes[0].dot(&(at[1].rotation * joint.cross));
        let (apart, angles) = match joint.kind {
            JointKind::Spherical => (apart, Vec::new()),
            JointKind::Revolute => (apart, tilt.as_slice().to_vec()),
            JointKind::Fixed => (apart, turned.scaled_axis().as_slice().to_vec()),
            JointKind::Translational => (across, turned.scaled_axis().as_slice().to_vec()),
            JointKind::Cylindrical | JointKind::Screw(_) => (across, tilt.as_slice().to_vec()),
            JointKind::Planar => (apart - across, tilt.as_slice().to_vec()),
            JointKind::Universal => (apart, vec![right]),
            JointKind::Free => return Miss::default(),
        };
        Miss {
            shares: apart.as_slice().to_vec(),
            angles,
        }
    }

    /// Derivatives of the residuals with respect to the degrees of freedom, computed by central
    /// differences of rigid motions.
    pub(super) fn jacobian(
        &self,
        model: &Model,
        displaced: &[Isometry3<f64>],
        q: &[[f64; 2]],
    ) -> DMatrix<f64> {
        let poses: Vec<Isometry3<f64>> = displaced
            .iter()
            .zip(&model.links)
            .map(|(g, link)| g * link.pose)
            .collect();
        let rows = self.residual(model, &poses, q).len();
        let mut out = DMatrix::zeros(rows, self.freedoms.len());
        for (column, freedom) in self.freedoms.iter().enumerate() {
            let screw = self.screw(model, displaced, q, *freedom);
            let moved = |by: f64| {
                let motion = screw.motion(by * self.unit(model, *freedom));
                let mut poses = poses.clone();
                for (link, chain) in self.chains.iter().enumerate() {
                    if chain.contains(&freedom.joint) {
                        poses[link] = motion * poses[link];
                    }
                }
                let mut q = q.to_vec();
                if let Way::Coordinate(c) = freedom.kind {
                    q[freedom.joint][c] += by * self.unit(model, *freedom);
                }
                self.residual(model, &poses, &q)
            };
            let difference = (moved(DIFFERENCE) - moved(-DIFFERENCE)) / (2.0 * DIFFERENCE);
            out.set_column(column, &difference);
        }
        out
    }

    /// Unit of a degree of freedom: the size of the model (m) for translations, 1 rad for
    /// rotations.
    fn unit(&self, model: &Model, freedom: Freedom) -> f64 {
        match freedom.kind {
            Way::Shift(_) => self.size,
            Way::Turn(_) => 1.0,
            Way::Coordinate(c) => match model.joints[freedom.joint].kind.measures()[c] {
                "displacement" => self.size,
                _ => 1.0,
            },
        }
    }

    fn screw(
        &self,
        model: &Model,
        displaced: &[Isometry3<f64>],
        q: &[[f64; 2]],
        freedom: Freedom,
    ) -> Screw {
        let joint = &model.joints[freedom.joint];
        let place = JointPlacement::of(model, joint);
        let g = joint.links[0].map_or_else(Isometry3::identity, |link| displaced[link]);
        let point = (g * Point3::from(place.point)).coords;
        let axis = g.rotation * place.axis;
        let turn = |axis| Screw {
            point,
            axis,
            turns: true,
            advance: 0.0,
        };
        let shift = |axis| Screw {
            point,
            axis,
            turns: false,
            advance: 0.0,
        };
        let unit = |k: usize| Vector3::ith(k, 1.0);
        match (freedom.kind, joint.kind) {
            (Way::Turn(k), _) => turn(unit(k)),
            (Way::Shift(k), _) => shift(unit(k)),
            (Way::Coordinate(0), JointKind::Translational | JointKind::Cylindrical) => shift(axis),
            (Way::Coordinate(1), JointKind::Universal) => {
                let first = rotation(place.axis, q[freedom.joint][0]);
                turn(g.rotation * (first * place.cross))
            }
            (Way::Coordinate(_), JointKind::Screw(pitch)) => Screw {
                advance: pitch / std::f64::consts::TAU,
                ..turn(axis)
            },
            (Way::Coordinate(_), _) => turn(axis),
        }
    }

    /// Moves a state along the degrees of freedom.
    pub(super) fn advance(&self, model: &Model, state: &mut State, step: &DVector<f64>) {
        let displaced = state.displacements(model);
        for (freedom, by) in self.freedoms.iter().zip(step.iter()) {
            let by = by * self.unit(model, *freedom);
            match freedom.kind {
                Way::Coordinate(c) => state.q[freedom.joint][c] += by,
                Way::Turn(_) | Way::Shift(_) => {
                    let joint = &model.joints[freedom.joint];
                    let g = joint.links[0].map_or_else(Isometry3::identity, |link| displaced[link]);
                    let motion = self.screw(model, &displaced, &state.q, *freedom).motion(by);
                    let own = g.inverse() * motion * g;
                    state.moved[freedom.joint] = own * state.moved[freedom.joint];
                }
            }
        }
        for freedom in &self.freedoms {
            state.follow(model, freedom.joint);
        }
    }
}

/// A rigid motion with one degree of freedom, in ground axes.
struct Screw {
    point: Vector3<f64>,
    axis: Vector3<f64>,
    turns: bool,
    /// Advance (m/rad).
    advance: f64,
}

impl Screw {
    fn motion(&self, by: f64) -> Isometry3<f64> {
        if !self.turns {
            return Isometry3::from_parts((self.axis * by).into(), UnitQuaternion::identity());
        }
        let turned = rotation(self.axis, by);
        let shift = self.point - turned * self.point + self.axis * (self.advance * by);
        Isometry3::from_parts(shift.into(), turned)
    }
}
