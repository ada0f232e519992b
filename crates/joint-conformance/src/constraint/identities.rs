//! Tests of identities between the kernels of a constraint without derivatives: wrench, reference
//! point, balance of forces, initial configuration.

use joints::spec::{Parameter, Role, Shape};

use super::{Kernel, OfConstraint};
use crate::block::Block;
use crate::bodies::Bodies;
use crate::case::{Case, Kind};
use crate::check::{Check, is_internal};
use crate::derivative::DualNumbers;
use crate::failure::{DUAL_TOLERANCE, Failure, Property};
use crate::state::{Along, State};
use crate::subject::{By, Subject};

/// Time step for differences of cosines and sines. Rounding and curvature each change a rate of
/// about 1 by less than 1e-8.
const STEP: f64 = 1e-5;
/// Largest permitted error of such a rate.
const OF_DIFFERENCE: f64 = 1e-7;

impl<S: Bodies> Check<'_, OfConstraint<S>> {
    fn first(&self, kernel: Kernel) -> Block {
        self.at(kernel, &self.case.motions[0])
    }

    /// Returns the reference point of the constraint. A constraint may require that a wheel touches
    /// a plane. If the wheel is parallel to the plane, no single contact point exists. The formula
    /// of the reference point then divides by zero, and the result of this function is `None`. For
    /// a constraint without a plane, a reference point that contains NaN is returned, and the check
    /// fails.
    fn place_of_reaction(&self) -> Option<Block> {
        let place = self.first(Kernel::Place);
        let nowhere = place.entries().iter().any(|p| p.is_nan());
        (!(nowhere && touches_plane(self.of.spec.common.parameters))).then_some(place)
    }

    /// Checks `F = −C_v`, `T = −C_ω − (place − origin) × F`.
    pub(super) fn wrench(&self) -> Result<(), Failure> {
        let Some(place) = self.place_of_reaction() else {
            return Ok(());
        };
        let x = &self.case.x;
        let c = self.first(Kernel::C);
        let mut expected = Block::filled(S::N_DOF, c.rows(), 0.0);
        for row in 0..c.rows() {
            let q: Vec<f64> = (0..S::N_DOF).map(|k| -c.get(row, k)).collect();
            let wrench = S::wrench(&x[0], &q, point(&place)).into_iter();
            wrench
                .enumerate()
                .for_each(|(k, w)| expected.set(k, row, w));
        }
        self.identity(Property::Wrench, &self.first(Kernel::Wrench), &expected)
    }

    /// Checks that the component is at most the force of each multiplier, or the torque of a
    /// multiplier without a force. For a drive, it checks that the component is the load that does
    /// work: `component·ḟ = b`.
    pub(super) fn component(&self) -> Result<(), Failure> {
        let wrench = self.first(Kernel::Wrench);
        let found = self.first(Kernel::Component);
        if self.of.spec.role == Role::Drive {
            let [_, rate, _] = self.case.f[self.case.f.len() - 1];
            let power = (0..found.rows()).map(|row| found.get(row, 0) * rate);
            let power = Block::column(power.collect());
            return self.identity(Property::Power, &power, &self.first(Kernel::B));
        }
        let length = |row, components: std::ops::Range<usize>| -> f64 {
            let squares = components.map(|k| wrench.get(k, row) * wrench.get(k, row));
            squares.sum::<f64>().sqrt()
        };
        let bound = |row| match length(row, 0..S::DIM) {
            // If the reference point does not exist at this pose, the torque about it is not
            // checked.
            0.0 => length(row, S::DIM..S::N_DOF).max(0.0),
            force => force,
        };
        // If the found value is within the bound, it is also the expected value; otherwise the
        // bound is expected, so that the error is the excess.
        let within = |row| {
            let (value, bound): (f64, f64) = (found.get(row, 0), bound(row));
            if value.is_nan() {
                0.0
            } else {
                value.clamp(-bound, bound)
            }
        };
        let expected = Block::column((0..found.rows()).map(within).collect());
        self.identity(Property::Component, &found, &expected)
    }

    /// Checks that the reference point is fixed in the first body. If joints support wheels on a
    /// carrier, it checks that the reference point is fixed in the carrier. If a body touches a
    /// plane of the ground, a rotation changes its contact point; in this case only translations
    /// are checked.
    pub(super) fn place(&self) -> Result<(), Failure> {
        let Some(place) = self.place_of_reaction() else {
            return Ok(());
        };
        let (x, motion) = (&self.case.x, &self.case.motions[0]);
        let found = self.derivative::<DualNumbers>(Kernel::Place, By::Poses, motion);
        let mut expected = Block::filled(S::DIM, self.of.columns(), 0.0);
        let owner = if self.of.spec.common.bearings { 2 } else { 0 };
        let velocities = S::point_velocities(&x[owner], point(&place)).into_iter();
        for (dof, velocity) in velocities.enumerate() {
            let touches = dof >= S::DIM && touches_plane(self.of.spec.common.parameters);
            let column = S::N_DOF * owner + dof;
            for (k, velocity) in velocity.into_iter().enumerate().take(S::DIM) {
                let value = if touches {
                    found.get(k, column)
                } else {
                    velocity
                };
                expected.set(k, column, value);
            }
        }
        self.identity(Property::Place, &found, &expected)
    }

    /// Checks that the rate of each unwrapped angle is c·ṡ − s·ċ, computed from its cosine and sine
    /// by differences.
    pub(super) fn turned(&self) -> Result<(), Failure> {
        let angles = self.of.spec.turns.max(usize::from(self.of.spec.turning));
        if self.case.kind != Kind::Ordinary {
            return Ok(());
        }
        let motion = &self.case.motions[0];
        let at = |number: usize, tau: f64| {
            let state = Along::Motion.state::<S, f64>(self.case, motion, tau);
            let v = State::<S, f64>::twists(&state.v);
            self.made.plain().turned(number, &state.x, &v)
        };
        for number in 0..angles {
            let [before, now, after] = [-STEP, 0.0, STEP].map(|tau| at(number, tau));
            let slope = |k: usize| (after[k] - before[k]) / (2.0 * STEP);
            let expected = now[0] * slope(1) - now[1] * slope(0);
            // If the constraint is violated, cosine and sine may be components of a vector that is
            // longer than one.
            let size = (now[0] * now[0] + now[1] * now[1]).max(1.0);
            if (now[2] - expected).abs() > OF_DIFFERENCE * size {
                let entry = format!("rate of counted angle {number}");
                return Err(self.fact(Property::Turned, entry, [now[2], expected]));
            }
        }
        Ok(())
    }

    /// Checks the programs. The programs are recorded from the kernels of one constraint and run
    /// for all constraints of its kind.
    pub(super) fn programs(&self) -> Result<(), Failure> {
        let (plain, spec) = (self.made.plain(), self.of.spec);
        let at = Along::Time.state::<S, f64>(self.case, &self.case.motions[0], 0.0);
        let v = State::<S, f64>::twists(&at.v);
        let (x, v, f) = (&at.x[..], &v[..], &at.f[..]);
        let mut stored = Vec::new();
        plain.stored(&mut stored);
        let rows = plain.programs().of(&stored);
        let agree = |n: usize, kernel: &dyn Fn(&mut [f64]), program: &dyn Fn(&mut [f64])| {
            let bits = |write: &dyn Fn(&mut [f64])| {
                let mut out = vec![f64::NAN; n];
                write(&mut out);
                out.into_iter().map(f64::to_bits).collect::<Vec<_>>()
            };
            bits(kernel) == bits(program)
        };
        let (m, entries) = (spec.rows.len(), spec.c.len());
        let component = if spec.component.is_some() { m } else { 0 };
        let all = [
            (
                "phi",
                agree(spec.holonomic, &|o| plain.phi(x, f, o), &|o| {
                    rows.phi::<S>(x, f, o);
                }),
            ),
            (
                "c",
                agree(entries, &|o| plain.c(x, f, o), &|o| rows.c::<S>(x, f, o)),
            ),
            (
                "c_constant",
                agree(entries, &|o| plain.c_constant(o), &|o| {
                    rows.c_constant::<S>(x, f, o);
                }),
            ),
            (
                "b",
                agree(m, &|o| plain.b(x, f, o), &|o| rows.b::<S>(x, f, o)),
            ),
            (
                "gamma",
                agree(m, &|o| plain.gamma(x, v, f, o), &|o| {
                    rows.gamma::<S>(x, v, f, o);
                }),
            ),
            (
                "component",
                agree(component, &|o| plain.component(x, f, o), &|o| {
                    rows.component::<S>(x, f, o);
                }),
            ),
        ];
        match all.iter().find(|(_, agrees)| !agrees) {
            Some((kernel, _)) => Err(self.fact(
                Property::Programs,
                format!("program of `{kernel}`"),
                [0.0, 1.0],
            )),
            None => Ok(()),
        }
    }

    /// Checks the balance of the rows only if Φ = 0. If Φ is not zero, the distance between two
    /// points that should coincide is a lever arm for the two forces.
    pub(super) fn rows_balance(&self) -> Result<(), Failure> {
        let ordinary = self.case.kind == Kind::Ordinary;
        if self.of.spec.holonomic == 0 || !(ordinary && is_internal(self.of)) {
            return Ok(());
        }
        let case = self.closed();
        let check = self.with(&case);
        let c = check.first(Kernel::C);
        let left = check.first(Kernel::Phi).norm();
        let floor = c.largest().max(1.0) * case.size() + left / DUAL_TOLERANCE;
        check.balance(
            &(0..self.of.spec.holonomic)
                .map(|row| c.row(row))
                .collect::<Vec<_>>(),
            floor,
        )
    }

    pub(super) fn with<'s>(&'s self, case: &'s Case<S>) -> Check<'s, OfConstraint<S>> {
        Check { case, ..*self }
    }

    /// Returns the case with changed poses, at which Φ is zero or nearly zero. The corrections use
    /// one row of C after another, so that no rank is needed.
    fn closed(&self) -> Case<S> {
        const SWEEPS: usize = 100;
        let mut case = self.case.clone();
        for _ in 0..SWEEPS {
            let phi = self.with(&case).first(Kernel::Phi);
            if phi.largest() <= f64::EPSILON * case.size() {
                break;
            }
            for row in 0..self.of.spec.holonomic {
                let phi = self.with(&case).first(Kernel::Phi).get(row, 0);
                let c = self.with(&case).first(Kernel::C);
                let square: f64 = c.row(row).iter().map(|e| e * e).sum();
                if phi == 0.0 || square == 0.0 {
                    continue;
                }
                for (x, c) in case.x.iter_mut().zip(c.row(row).chunks(S::N_DOF)) {
                    let d: Vec<f64> = c.iter().map(|c| -c * phi / square).collect();
                    *x = S::moved(x, &d, 1.0);
                }
            }
        }
        case
    }

    /// Checks that rows that store an initial value are zero at the initial configuration.
    pub(super) fn start(&self) -> Result<(), Failure> {
        let phi = phi_at_start(self);
        let kept = |row: usize| {
            let restricts = self.of.spec.rows[row].restricts_start;
            if restricts { phi.get(row, 0) } else { 0.0 }
        };
        let expected = Block::column((0..phi.rows()).map(kept).collect());
        self.identity(Property::Start, &phi, &expected)
    }
}

/// Converts a column of coordinates to a point.
fn point(place: &Block) -> [f64; 3] {
    std::array::from_fn(|k| {
        if k < place.rows() {
            place.get(k, 0)
        } else {
            0.0
        }
    })
}

/// Returns Φ at the initial configuration, with all functions of time equal to zero.
pub(super) fn phi_at_start<S: Bodies>(check: &Check<'_, OfConstraint<S>>) -> Block {
    let start = Case {
        x: check.case.start.clone(),
        f: vec![[0.0; 3]; check.case.f.len()],
        counted: vec![0.0; check.case.counted.len()],
        ..check.case.clone()
    };
    check.with(&start).first(Kernel::Phi)
}

/// Returns whether a body touches a plane of the ground, according to the parameters of the
/// definition.
fn touches_plane(parameters: &[Parameter]) -> bool {
    parameters
        .iter()
        .any(|p| matches!(p.shape, Shape::GroundPlane))
}
