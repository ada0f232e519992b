//! The kernels of a force, and the properties that forces alone have.

use joints::spec::{Row, Spec};
use std::marker::PhantomData;

use joints::{Argument, ArgumentError, Definition, Force};

use crate::block::{Block, dot};
use crate::bodies::Bodies;
use crate::case::Motion;
use crate::check::{Check, is_internal};
use crate::failure::{Claim, Failure, Oracle, Property, fact};
use crate::number::{Number, Traced};
use crate::pattern::Pattern;
use crate::state::{Along, State};
use crate::subject::{By, Derivative, Subject, sparse};

/// A force as a subject of the harness.
pub(crate) struct OfForce<K, S>(K, PhantomData<S>);

/// Kernels of a force.
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

impl<K: Force<S>, S: Bodies> Subject for OfForce<K, S> {
    type Space = S;
    type Kernel = Kernel;
    type Seen = ();

    const COMMON: Spec = K::SPEC.common;
    const ROWS: &'static [Row] = &[];
    const SLOPE: Kernel = Kernel::DqDx;
    const INVARIANTS: &'static [(Kernel, &'static str)] = &[(Kernel::Q, "Q")];

    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError> {
        K::from_arguments(arguments).map(|k| Self(k, PhantomData))
    }

    fn definition(&mut self) -> &mut dyn Definition<S> {
        &mut self.0
    }

    fn kernel<D: Number>(&self, kernel: Kernel, at: &State<S, D>) -> Block<D> {
        let k = self.0.element::<D>();
        let State { x, v, f, .. } = at;
        let v = &State::<S, D>::twists(v);
        let n = Self::columns();
        match kernel {
            Kernel::Q => sparse([n, 1], &q_pattern::<K, S>(), |out| k.q(x, v, f, out)),
            Kernel::DqDx => sparse([n, n], K::SPEC.dq_dx, |out| k.dq_dx(x, v, f, out)),
            Kernel::DqDv => sparse([n, n], K::SPEC.dq_dv, |out| k.dq_dv(x, v, f, out)),
        }
    }

    fn patterns() -> Result<Vec<(Kernel, Pattern)>, Failure> {
        let (n, name, spec) = (Self::columns(), Self::COMMON.name, &K::SPEC);
        let q = Pattern::new(name, "Q", [n, 1], q_pattern::<K, S>())?;
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

    /// A law has no value where a rotation vector is near half a turn, and there only.
    fn is_defined(check: &Check<'_, Self>) -> bool {
        check.case.motions.iter().all(|motion| {
            let state = Along::Motion.state(check.case, motion, Traced::from(0.0));
            let q = check.subject.kernel(Kernel::Q, &state);
            q.entries().iter().all(|entry| !entry.is_near_half_a_turn)
        })
    }

    fn properties(check: &Check<'_, Self>) -> Result<(), Failure> {
        for m in &check.case.motions {
            if is_internal::<Self>() {
                let q = check.at(Kernel::Q, m);
                check.balance(&[q.entries()], q.largest() * check.case.size())?;
            }
            check.dissipation(m)?;
        }
        Ok(())
    }

    fn facts((): &()) -> Result<(), Failure> {
        let depends_on_velocity = !K::SPEC.dq_dv.is_empty();
        if K::SPEC.dissipative == depends_on_velocity {
            return Ok(());
        }
        let entry = "`dissipative` of the spec against the pattern of ∂Q/∂v".to_owned();
        let facts = [K::SPEC.dissipative, depends_on_velocity].map(f64::from);
        Err(fact(Self::COMMON.name, Property::DqDv, entry, facts, None))
    }
}

fn q_pattern<K: Force<S>, S: Bodies>() -> Vec<[usize; 2]> {
    K::SPEC.q.iter().map(|&row| [row, 0]).collect()
}

impl<K: Force<S>, S: Bodies> Check<'_, OfForce<K, S>> {
    /// `(Q(v) − Q(0))·v ≤ 0`, and `wᵀ·∂Q/∂v·w ≤ 0` at rest. Away from rest a force may fall with a
    /// velocity and still take energy: the side force of a tyre with its speed along.
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
