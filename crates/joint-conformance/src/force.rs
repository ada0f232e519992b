//! The kernels of a force, and the properties that are tested only for forces.

use joints::spec::{ForceSpec, Spec};
use joints::{Argument, ArgumentError, Definition, Force, ForceElement};

use crate::block::{Block, dot};
use crate::bodies::Bodies;
use crate::case::Motion;
use crate::check::{Check, is_internal};
use crate::failure::{Claim, Failure, Oracle, Property, fact};
use crate::kernels::{AnyForce, KernelNumber};
use crate::number::{Number, Traced};
use crate::pattern::Pattern;
use crate::state::{Along, State};
use crate::subject::{By, Derivative, Subject, sparse};

/// A force definition for a check.
#[derive(Clone, Copy)]
pub(crate) struct OfForce<S: Bodies> {
    spec: &'static ForceSpec,
    make: Make<S>,
}

type Make<S> = fn(&[Argument]) -> Result<Box<dyn AnyForce<S>>, ArgumentError>;

impl<S: Bodies> OfForce<S> {
    /// Creates the subject for the definition K.
    pub(crate) fn new<K: Force<S>>() -> Self {
        Self {
            spec: const { &K::SPEC },
            make: |arguments| Ok(Box::new(K::from_arguments(arguments)?)),
        }
    }

    fn q_pattern(self) -> Vec<[usize; 2]> {
        self.spec.q.iter().map(|&row| [row, 0]).collect()
    }
}

/// The kernels of a force.
#[derive(Clone, Copy)]
pub(crate) enum Kernel {
    Q,
    DqDx,
    DqDv,
}

const DERIVATIVES: [Derivative<Kernel>; 2] = [
    Derivative::new(Property::DqDx, Kernel::DqDx, 1.0, Kernel::Q, By::Poses),
    Derivative::new(Property::DqDv, Kernel::DqDv, 1.0, Kernel::Q, By::Twists),
];

impl<S: Bodies> Subject for OfForce<S> {
    type Space = S;
    type Made = Box<dyn AnyForce<S>>;
    type Kernel = Kernel;
    type Seen = ();

    const SLOPE: Kernel = Kernel::DqDx;
    const INVARIANTS: &'static [(Kernel, &'static str)] = &[(Kernel::Q, "Q")];

    fn common(self) -> &'static Spec {
        &self.spec.common
    }

    fn make(self, arguments: &[Argument]) -> Result<Self::Made, ArgumentError> {
        (self.make)(arguments)
    }

    fn definition(made: &mut Self::Made) -> &mut dyn Definition<S> {
        made.as_mut().definition()
    }

    fn kernel<D: KernelNumber>(
        self,
        made: &Self::Made,
        kernel: Kernel,
        at: &State<S, D>,
    ) -> Block<D> {
        let k = D::of_force(made.as_ref());
        let State { x, v, f, .. } = at;
        let v = &State::<S, D>::twists(v);
        let n = self.columns();
        match kernel {
            Kernel::Q => self.q(k, at),
            Kernel::DqDx => sparse([n, n], self.spec.dq_dx, |out| k.dq_dx(x, v, f, out)),
            Kernel::DqDv => sparse([n, n], self.spec.dq_dv, |out| k.dq_dv(x, v, f, out)),
        }
    }

    fn patterns(self) -> Result<Vec<(Kernel, Pattern)>, Failure> {
        let (n, name, spec) = (self.columns(), self.common().name, self.spec);
        let q = Pattern::new(name, "Q", [n, 1], self.q_pattern())?;
        let dq_dx = Pattern::new(name, "∂Q/∂x", [n, n], spec.dq_dx.to_vec())?;
        let dq_dv = Pattern::new(name, "∂Q/∂v", [n, n], spec.dq_dv.to_vec())?;
        Ok(vec![
            (Kernel::Q, q),
            (Kernel::DqDx, dq_dx),
            (Kernel::DqDv, dq_dv),
        ])
    }

    fn derivatives() -> impl Iterator<Item = &'static Derivative<Kernel>> {
        DERIVATIVES.iter()
    }

    /// The value of a force law is undefined only if a rotation vector is near half a revolution.
    fn is_defined(check: &Check<'_, Self>) -> bool {
        check.case.motions.iter().all(|motion| {
            let state = Along::Motion.state(check.case, motion, Traced::from(0.0));
            let q = check.of.q(check.made.traced(), &state);
            q.entries().iter().all(|entry| !entry.is_near_half_a_turn)
        })
    }

    fn properties(check: &Check<'_, Self>) -> Result<(), Failure> {
        for m in &check.case.motions {
            if is_internal(check.of) {
                let q = check.at(Kernel::Q, m);
                check.balance(&[q.entries()], q.largest() * check.case.size())?;
            }
            check.dissipation(m)?;
        }
        Ok(())
    }

    fn facts(self, (): &()) -> Result<(), Failure> {
        let depends_on_velocity = !self.spec.dq_dv.is_empty();
        if self.spec.dissipative == depends_on_velocity {
            return Ok(());
        }
        let entry = "`dissipative` of the spec against the pattern of ∂Q/∂v".to_owned();
        let facts = [self.spec.dissipative, depends_on_velocity].map(f64::from);
        Err(fact(self.common().name, Property::DqDv, entry, facts, None))
    }
}

impl<S: Bodies> OfForce<S> {
    /// Returns Q as a column.
    fn q<D: Number>(self, k: &dyn ForceElement<D, S>, at: &State<S, D>) -> Block<D> {
        let State { x, v, f, .. } = at;
        let v = &State::<S, D>::twists(v);
        let shape = [self.columns(), 1];
        sparse(shape, &self.q_pattern(), |out| k.q(x, v, f, out))
    }
}

impl<S: Bodies> Check<'_, OfForce<S>> {
    /// Checks `(Q(v) − Q(0))·v ≤ 0`, and `wᵀ·∂Q/∂v·w ≤ 0` at rest. In motion, the second condition
    /// is not necessary for dissipation; an example is the side force of a tyre, which decreases
    /// with the longitudinal speed.
    fn dissipation(&self, m: &Motion) -> Result<(), Failure> {
        let rest = Motion {
            v: vec![0.0; m.v.len()],
            ..m.clone()
        };
        let (still, q) = (self.at(Kernel::Q, &rest), self.at(Kernel::Q, m));
        let (v, a) = (&m.v, &m.a);
        let slope = self.at(Kernel::DqDv, &rest);
        let power = dot(q.zip(&still, |q, s| q - s).entries(), v);
        let curvature = dot(slope.times(a).entries(), a);
        let found = Block::column(vec![power, curvature]);
        let forces = q.largest() + still.largest() + slope.largest();
        let claim = Claim {
            property: Property::Dissipation,
            oracle: Oracle::identity(forces * (dot(v, v) + dot(a, a) + 1.0)),
            found: &found,
            expected: &found.map(|e| e.min(0.0)),
        };
        let names = ["power of the velocity terms", "curvature of the power"];
        self.decide(&claim, |row, _| names[row].to_owned())
    }
}
