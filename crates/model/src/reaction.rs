//! From multipliers to what an engineer calls a reaction: force and torque on the first body of the joint,
//! at the joint's place.

use std::ops::Range;

use joints::spec::ConstraintSpec;
use linalg::Matrix;

use crate::description::BodyRef;
use crate::mechanism::Mechanism;
use crate::system::{Scratch, System};

/// Place of a joint or drive in [`crate::Layout::groups`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ConstraintId(pub usize);

/// A joint or a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstraintKind {
    /// Connects bodies.
    Joint,
    /// Prescribes a relative motion.
    Drive,
}

/// A joint or drive with its rows.
#[derive(Clone, Debug)]
pub struct ConstraintGroup {
    /// Its name.
    pub name: String,
    /// Joint or drive.
    pub kind: ConstraintKind,
    /// Facts of its definition.
    pub spec: &'static ConstraintSpec,
    /// Its bodies.
    pub bodies: Vec<BodyRef>,
    /// Its rows of C.
    pub rows: Range<usize>,
}

/// Names of the three components of a planar wrench.
pub const COMPONENTS: [&str; 3] = ["Fx", "Fy", "T"];

impl ConstraintGroup {
    /// Components of the reaction that are not identically zero, as places in [`COMPONENTS`].
    #[must_use]
    pub fn components(&self) -> Vec<usize> {
        (0..COMPONENTS.len())
            .filter(|c| self.spec.wrench.iter().any(|[component, _]| component == c))
            .collect()
    }
}

/// A reaction: force (global components, N) and torque about the place (N·m), on the first body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reaction {
    /// Fx, Fy
    pub force: [f64; 2],
    /// T
    pub torque: f64,
    /// The named component of the definition: `N` of a knife edge, `drive` of a drive.
    pub component: Option<f64>,
}

impl Mechanism {
    /// The map `W` (3 × rows) with `[Fx, Fy, T] = W·λ` at the poses of the scratch; allocates.
    #[must_use]
    pub fn wrench_map(&self, id: ConstraintId, s: &Scratch) -> Matrix {
        let c = &self.constraints()[id.0];
        let spec = c.element.element().spec();
        let mut values = vec![0.0; spec.wrench.len()];
        let (x, f) = (&s.slot_poses[c.slots.clone()], &s.jets[c.functions.clone()]);
        c.element.element().wrench(x, f, &mut values);
        let mut map = Matrix::zeros(COMPONENTS.len(), c.rows.len());
        for (&[component, row], value) in spec.wrench.iter().zip(values) {
            map[(component, row)] = value;
        }
        map
    }

    /// Coefficients of a component of a reaction, `Σ coefficient·λ` over the rows of the joint or drive: `Fx`, `Fy`, `T`, or the
    /// named component of its definition. `None` if it has no such component; allocates.
    #[must_use]
    pub fn component_coefficients(
        &self,
        id: ConstraintId,
        name: &str,
        s: &Scratch,
    ) -> Option<Vec<f64>> {
        if let Some(k) = COMPONENTS.iter().position(|c| *c == name) {
            return Some(self.wrench_map(id, s).row(k).to_vec());
        }
        let c = &self.constraints()[id.0];
        let element = c.element.element();
        (element.spec().component == Some(name)).then(|| {
            let mut coefficients = vec![0.0; c.rows.len()];
            let (x, f) = (&s.slot_poses[c.slots.clone()], &s.jets[c.functions.clone()]);
            element.component(x, f, &mut coefficients);
            coefficients
        })
    }

    /// The reaction of a joint or drive for multipliers λ (all rows) at the poses of the scratch; allocates.
    #[must_use]
    pub fn reaction(&self, id: ConstraintId, s: &Scratch, lambda: &[f64]) -> Reaction {
        let c = &self.constraints()[id.0];
        let lambda = &lambda[c.rows.clone()];
        let wrench = self.wrench_map(id, s).times(lambda);
        let named = c.element.element().spec().component;
        let component = named
            .and_then(|name| self.component_coefficients(id, name, s))
            .map(|coefficients| coefficients.iter().zip(lambda).map(|(k, l)| k * l).sum());
        Reaction {
            force: [wrench[0], wrench[1]],
            torque: wrench[2],
            component,
        }
    }

    /// The point where the reaction of a joint or drive is reported, global components.
    #[must_use]
    pub fn place(&self, id: ConstraintId, s: &Scratch) -> [f64; 2] {
        let c = &self.constraints()[id.0];
        c.element.element().place(&s.slot_poses[c.slots.clone()])
    }

    /// Ids of all joints and drives, in the order of their rows.
    pub fn constraint_ids(&self) -> impl Iterator<Item = ConstraintId> + use<> {
        (0..self.layout().groups.len()).map(ConstraintId)
    }
}
