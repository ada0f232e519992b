//! The properties of one constraint definition.

use super::block::Block;
use super::case::{Case, Kind, Motion};
use super::derivative::{Curve, Differences, Differentiate, DualNumbers};
use super::failure::{Claim, Failure, Judge, Property, Reference, fact};
use super::kernels;
use super::number::Number;
use super::pattern::Pattern;
use super::state::{Along, State};
use super::{
    DIFFERENCES, DUAL_NUMBERS, DUAL_TOLERANCE, Oracle, assembled, column_name, is_internal,
};
use crate::constraint::Constraint;
use crate::plane::{N_DOF, Pose, Twist};
use crate::spec::Level;

/// All cases of one definition.
pub(super) fn check<K: Constraint>(seed: u64) -> Result<(), Failure> {
    let definition = K::SPEC.common.name;
    let [m, n] = kernels::shape::<K>();
    let pattern = |block, shape, entries| Pattern::new(definition, block, shape, entries);
    let mut patterns = [
        pattern("C", [m, n], kernels::c_pattern::<K>())?,
        pattern("the wrench map", [N_DOF, m], K::SPEC.wrench.to_vec())?,
        pattern("∂(Cᵀλ)/∂x", [n, n], K::SPEC.d_force_dx.to_vec())?,
        pattern("∂(C·a − Γ)/∂x", [m, n], K::SPEC.d_residual_dx.to_vec())?,
        pattern("∂Γ/∂v", [m, n], K::SPEC.d_gamma_dv.to_vec())?,
    ];
    let mut restricts = vec![false; m];
    let mut depends_on_time = false;
    for case in Case::all(seed, &K::SPEC.common, m) {
        let (constraint, case) = assembled::<K>(&case)?;
        let check = Check {
            constraint: &constraint,
            case: &case,
        };
        check.all()?;
        for (pattern, block) in patterns.iter_mut().zip(check.sparse_blocks()) {
            pattern.see(&block);
        }
        depends_on_time |= kernels::b(&constraint, &case.x, &case.f).largest() > 0.0;
        let at_start = check.phi_at_start();
        for (seen, phi) in restricts.iter_mut().zip(at_start.entries()) {
            *seen |= phi.abs() > DUAL_TOLERANCE;
        }
    }
    patterns.iter().try_for_each(|p| p.all_alive(definition))?;
    if depends_on_time != K::SPEC.rheonomic {
        let entry = "`rheonomic` of the spec against b".to_owned();
        let facts = [K::SPEC.rheonomic, depends_on_time].map(f64::from);
        return Err(fact(definition, Property::B, entry, facts, None));
    }
    let idle = |(row, seen): (&crate::spec::Row, &bool)| row.restricts_start && !seen;
    match K::SPEC
        .rows
        .iter()
        .zip(&restricts)
        .find(|(row, seen)| idle((row, seen)))
    {
        Some((row, _)) if K::SPEC.level == Level::Holonomic => {
            let entry = format!("row `{}`, zero at every start", row.name);
            Err(fact(definition, Property::Start, entry, [0.0, 1.0], None))
        }
        _ => Ok(()),
    }
}

/// A column of kernel results along a curve.
struct Path<'a, K> {
    check: &'a Check<'a, K>,
    motion: &'a Motion,
    along: Along,
    quantity: Quantity,
}

#[derive(Clone, Copy)]
enum Quantity {
    /// Φ
    Phi,
    /// C·v − b
    Velocity,
    /// Γ
    Gamma,
    /// Cᵀλ
    Force,
    /// C·a − Γ
    Residual,
    /// The place
    Place,
}

impl<K: Constraint> Curve for Path<'_, K> {
    fn at<D: Number>(&self, tau: D) -> Block<D> {
        let State { x, v, f } = self.along.state(self.check.case, self.motion, tau);
        let k = self.check.constraint;
        let stack =
            |t: &[Twist<D>]| -> Vec<D> { t.iter().flat_map(|t| [t.x, t.y, t.omega]).collect() };
        match self.quantity {
            Quantity::Phi => kernels::phi(k, &x, &f),
            Quantity::Velocity => {
                let velocity = times(&kernels::c(k, &x, &f), &stack(&v));
                velocity.zip(&kernels::b(k, &x, &f), |e, b| e - b)
            }
            Quantity::Gamma => kernels::gamma(k, &x, &v, &f),
            Quantity::Force => {
                let lambda: Vec<D> = self.motion.lambda.iter().map(|&l| D::from(l)).collect();
                transpose_times(&kernels::c(k, &x, &f), &lambda)
            }
            Quantity::Residual => {
                let a = self.motion.a.iter().flat_map(|a| [a.x, a.y, a.omega]);
                let a: Vec<D> = a.map(D::from).collect();
                let inertia = times(&kernels::c(k, &x, &f), &a);
                inertia.zip(&kernels::gamma(k, &x, &v, &f), |e, g| e - g)
            }
            Quantity::Place => Block::column(k.place(&x).to_vec()),
        }
    }
}

fn times<D: Number>(c: &Block<D>, v: &[D]) -> Block<D> {
    let row = |r| {
        c.row(r)
            .iter()
            .zip(v)
            .fold(D::from(0.0), |sum, (&c, &v)| sum + c * v)
    };
    Block::column((0..c.rows()).map(row).collect())
}

fn transpose_times<D: Number>(c: &Block<D>, lambda: &[D]) -> Block<D> {
    let column = |k| (0..c.rows()).fold(D::from(0.0), |sum, r| sum + c.get(r, k) * lambda[r]);
    Block::column((0..c.columns()).map(column).collect())
}

/// The case with its poses moved until Φ = 0, or nearly so: corrections along one row of C after the other, which need
/// no rank.
fn closed<K: Constraint>(k: &K, case: &Case) -> Case {
    const SWEEPS: usize = 100;
    let mut case = case.clone();
    for _ in 0..SWEEPS {
        if kernels::phi(k, &case.x, &case.f).largest() <= f64::EPSILON * case.size() {
            break;
        }
        for row in 0..K::SPEC.rows.len() {
            let phi = kernels::phi(k, &case.x, &case.f).get(row, 0);
            let c = kernels::c(k, &case.x, &case.f);
            let square: f64 = c.row(row).iter().map(|e| e * e).sum();
            if phi == 0.0 || square == 0.0 {
                continue;
            }
            for (x, c) in case.x.iter_mut().zip(c.row(row).chunks(N_DOF)) {
                let [dx, dy, turn] = [0, 1, 2].map(|dof| -c[dof] * phi / square);
                *x = Pose::new(x.x + dx, x.y + dy, x.angle + turn);
            }
        }
    }
    case
}

/// One case of one definition.
struct Check<'a, K> {
    constraint: &'a K,
    case: &'a Case,
}

impl<K: Constraint> Check<'_, K> {
    fn all(&self) -> Result<(), Failure> {
        self.writes()?;
        self.derivatives::<DualNumbers>(DUAL_NUMBERS)?;
        if self.case.has_differences() {
            self.derivatives::<Differences>(DIFFERENCES)?;
        }
        self.wrench()?;
        self.place()?;
        self.component()?;
        self.start()?;
        if self.case.kind == Kind::Ordinary {
            self.balance()?;
            self.rigid_motion()?;
        }
        Ok(())
    }

    fn derivatives<O: Differentiate>(
        &self,
        Oracle {
            reference,
            tolerance,
            floor,
        }: Oracle,
    ) -> Result<(), Failure> {
        use Quantity as Q;
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let one = &self.case.motions[0];
        let each = |block: &dyn Fn(&Motion) -> Block| self.case.for_each_motion(block);
        let claim = |property, found: Block, expected: Block| {
            let (found, expected) = (&found, &expected);
            self.judge().decide(
                &Claim {
                    property,
                    reference,
                    found,
                    expected,
                    tolerance,
                    floor,
                },
                |row, column| self.entry(property, row, column),
            )
        };
        if K::SPEC.level == Level::Holonomic {
            claim(
                Property::C,
                kernels::c(k, x, f),
                self.jacobian::<O>(Q::Phi, Along::Pose, one),
            )?;
            let phi_t = O::first(&self.curve(Q::Phi, Along::Time, one));
            claim(Property::B, kernels::b(k, x, f), phi_t.map(|e| -e))?;
            claim(
                Property::Velocity,
                each(&|m| self.curve(Q::Velocity, Along::Time, m).at(0.0)),
                each(&|m| O::first(&self.curve(Q::Phi, Along::Motion, m))),
            )?;
            claim(
                Property::GammaFromPhi,
                each(&|m| kernels::gamma(k, x, &m.v, f)),
                each(&|m| O::second(&self.curve(Q::Phi, Along::Motion, m)).map(|e| -e)),
            )?;
        }
        claim(
            Property::Gamma,
            each(&|m| kernels::gamma(k, x, &m.v, f)),
            each(&|m| O::first(&self.curve(Q::Velocity, Along::Motion, m)).map(|e| -e)),
        )?;
        claim(
            Property::DForceDx,
            each(&|m| kernels::d_force_dx(k, x, f, &m.lambda)),
            each(&|m| self.jacobian::<O>(Q::Force, Along::Pose, m)),
        )?;
        claim(
            Property::DResidualDx,
            each(&|m| kernels::d_residual_dx(k, x, &m.v, &m.a, f)),
            each(&|m| self.jacobian::<O>(Q::Residual, Along::Pose, m)),
        )?;
        claim(
            Property::DGammaDv,
            each(&|m| kernels::d_gamma_dv(k, x, &m.v, f)),
            each(&|m| self.jacobian::<O>(Q::Gamma, Along::Twist, m)),
        )
    }

    fn curve<'s>(&'s self, quantity: Quantity, along: Along, motion: &'s Motion) -> Path<'s, K> {
        Path {
            check: self,
            motion,
            along,
            quantity,
        }
    }

    /// Derivatives along each degree of freedom, side by side.
    fn jacobian<O: Differentiate>(
        &self,
        quantity: Quantity,
        along: fn(usize) -> Along,
        motion: &Motion,
    ) -> Block {
        let column = |c| O::first(&self.curve(quantity, along(c), motion));
        Block::beside(
            &(0..kernels::shape::<K>()[1])
                .map(column)
                .collect::<Vec<_>>(),
        )
    }

    fn judge(&self) -> Judge<'_> {
        Judge {
            definition: K::SPEC.common.name,
            case: self.case,
        }
    }

    /// The entry in words.
    fn entry(&self, property: Property, row: usize, column: usize) -> String {
        let n = kernels::shape::<K>()[1];
        let row_name = |row: usize| format!("row `{}`", K::SPEC.rows[row].name);
        let dof = |column: usize| column_name(K::SPEC.common.slots, column % n);
        match property {
            Property::C => format!("{}, column {}", row_name(row), dof(column)),
            Property::DForceDx => {
                format!(
                    "row {}, column {}, multipliers {}",
                    dof(row),
                    dof(column),
                    column / n
                )
            }
            Property::DResidualDx | Property::DGammaDv => {
                format!(
                    "{}, column {}, motion {}",
                    row_name(row),
                    dof(column),
                    column / n
                )
            }
            Property::Velocity | Property::Gamma | Property::GammaFromPhi => {
                format!("{}, motion {column}", row_name(row))
            }
            Property::Wrench => format!("{}, {}", ["Fx", "Fy", "T"][row], row_name(column)),
            Property::Balance => {
                format!("sum of {}, {}", ["Fx", "Fy", "T"][row], row_name(column))
            }
            Property::Place => format!("{}, column {}", ["x", "y"][row], dof(column)),
            _ => row_name(row),
        }
    }

    fn writes(&self) -> Result<(), Failure> {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let mut constant = vec![f64::NAN; K::SPEC.c.len()];
        k.c_constant(&mut constant);
        let mut varying = vec![f64::NAN; K::SPEC.c.len()];
        k.c(x, f, &mut varying);
        let mut b = vec![f64::NAN; K::SPEC.rows.len()];
        k.b(x, f, &mut b);
        let entries = K::SPEC.c.iter().zip(constant.iter().zip(&varying));
        let c = entries.flat_map(|(e, (c, v))| {
            let name = self.entry(Property::C, e.row, N_DOF * e.slot + e.dof);
            [
                (format!("c_constant, {name}"), !c.is_nan(), e.constant),
                (format!("c, {name}"), !v.is_nan(), !e.constant),
            ]
        });
        let b = b.iter().enumerate().map(|(row, b)| {
            (
                format!("b, {}", self.entry(Property::B, row, 0)),
                !b.is_nan(),
                K::SPEC.rheonomic,
            )
        });
        match c.chain(b).find(|(_, written, due)| written != due) {
            Some((entry, written, due)) => {
                let facts = [written, due].map(f64::from);
                Err(fact(
                    K::SPEC.common.name,
                    Property::Writes,
                    entry,
                    facts,
                    Some(self.case),
                ))
            }
            None => Ok(()),
        }
    }

    /// `F = −C_v`, `T = −C_ω − (place − origin) × F`.
    fn wrench(&self) -> Result<(), Failure> {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let c = kernels::c(k, x, f);
        let place = k.place(x);
        let lever = [place[0] - x[0].x, place[1] - x[0].y];
        let mut expected = Block::filled(N_DOF, c.rows(), 0.0);
        for row in 0..c.rows() {
            let force = [-c.get(row, 0), -c.get(row, 1)];
            expected.set(0, row, force[0]);
            expected.set(1, row, force[1]);
            let moment = lever[0] * force[1] - lever[1] * force[0];
            expected.set(2, row, -c.get(row, 2) - moment);
        }
        self.identity(Property::Wrench, &kernels::wrench(k, x, f), &expected)
    }

    /// Equality up to what an error of the coordinates can do.
    fn identity(&self, property: Property, found: &Block, expected: &Block) -> Result<(), Failure> {
        let claim = Claim {
            property,
            reference: Reference::Identity,
            found,
            expected,
            tolerance: DUAL_TOLERANCE,
            floor: self.scale(),
        };
        self.judge()
            .decide(&claim, |row, column| self.entry(property, row, column))
    }

    /// What a relative error of 1 in the coordinates does to Φ and, the rows of C having a size of about one length, to C.
    fn scale(&self) -> f64 {
        let c = kernels::c(self.constraint, &self.case.x, &self.case.f);
        c.largest().max(1.0) * self.case.size()
    }

    /// At most the force of each multiplier, or its torque where it has no force.
    fn component(&self) -> Result<(), Failure> {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        if K::SPEC.component.is_none() {
            return Ok(());
        }
        let wrench = kernels::wrench(k, x, f);
        let found = kernels::component(k, x, f);
        let bound = |row| match wrench.get(0, row).hypot(wrench.get(1, row)) {
            0.0 => wrench.get(2, row).abs(),
            force => force,
        };
        // Equal where within the bound, else the bound: what exceeds it is the error.
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

    fn place(&self) -> Result<(), Failure> {
        let n = kernels::shape::<K>()[1];
        let (x, motion) = (&self.case.x, &self.case.motions[0]);
        let found = self.jacobian::<DualNumbers>(Quantity::Place, Along::Pose, motion);
        let place = self.constraint.place(x);
        let mut expected = Block::filled(2, n, 0.0);
        expected.set(0, 0, 1.0);
        expected.set(1, 1, 1.0);
        expected.set(0, 2, -(place[1] - x[0].y));
        expected.set(1, 2, place[0] - x[0].x);
        self.identity(Property::Place, &found, &expected)
    }

    /// Only where Φ = 0: elsewhere two points that should coincide give the pair of forces a lever.
    fn balance(&self) -> Result<(), Failure> {
        if !is_internal(&K::SPEC.common) || K::SPEC.level != Level::Holonomic {
            return Ok(());
        }
        let case = closed(self.constraint, self.case);
        let c = kernels::c(self.constraint, &case.x, &case.f);
        let left = kernels::phi(self.constraint, &case.x, &case.f).norm();
        let sum = |row| super::resultant(&case.x, c.row(row));
        let claim = Claim {
            property: Property::Balance,
            reference: Reference::Identity,
            found: &Block::beside(&(0..c.rows()).map(sum).collect::<Vec<_>>()),
            expected: &Block::filled(N_DOF, c.rows(), 0.0),
            tolerance: DUAL_TOLERANCE,
            floor: c.largest().max(1.0) * case.size() + left / DUAL_TOLERANCE,
        };
        Judge {
            case: &case,
            ..self.judge()
        }
        .decide(&claim, |row, column| {
            self.entry(Property::Balance, row, column)
        })
    }

    fn rigid_motion(&self) -> Result<(), Failure> {
        if !is_internal(&K::SPEC.common) {
            return Ok(());
        }
        let (moved, moved_case) = assembled::<K>(&self.case.moved())?;
        let there = Check {
            constraint: &moved,
            case: &moved_case,
        };
        let names = ["Φ", "C", "Γ", "the wrench map", "the component"];
        let norms = |check: &Check<'_, K>| check.invariant_blocks().map(|b| b.norm());
        let (here, there) = (norms(self), norms(&there));
        for (name, (found, expected)) in names.iter().zip(there.into_iter().zip(here)) {
            let (found, expected) = (Block::column(vec![found]), Block::column(vec![expected]));
            let claim = Claim {
                property: Property::RigidMotion,
                reference: Reference::Identity,
                found: &found,
                expected: &expected,
                tolerance: DUAL_TOLERANCE,
                floor: self.scale(),
            };
            self.judge()
                .decide(&claim, |_, _| format!("norm of {name}"))?;
        }
        Ok(())
    }

    fn invariant_blocks(&self) -> [Block; 5] {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let phi = match K::SPEC.level {
            Level::Holonomic => kernels::phi(k, x, f),
            Level::Nonholonomic => Block::column(Vec::new()),
        };
        let gamma = self
            .case
            .motions
            .iter()
            .map(|m| kernels::gamma(k, x, &m.v, f));
        [
            phi,
            kernels::c(k, x, f),
            Block::beside(&gamma.collect::<Vec<_>>()),
            kernels::wrench(k, x, f),
            kernels::component(k, x, f),
        ]
    }

    fn phi_at_start(&self) -> Block {
        match K::SPEC.level {
            Level::Holonomic => {
                let f = vec![[0.0; 3]; self.case.f.len()];
                kernels::phi(self.constraint, &self.case.start, &f)
            }
            Level::Nonholonomic => Block::filled(K::SPEC.rows.len(), 1, 0.0),
        }
    }

    fn start(&self) -> Result<(), Failure> {
        let phi = self.phi_at_start();
        let keeps = |row: usize| !K::SPEC.rows[row].restricts_start;
        let kept = |row| if keeps(row) { 0.0 } else { phi.get(row, 0) };
        let expected = Block::column((0..phi.rows()).map(kept).collect());
        self.identity(Property::Start, &phi, &expected)
    }

    /// Blocks in the order of their patterns in [`check`].
    fn sparse_blocks(&self) -> [Block; 5] {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let m = &self.case.motions[0];
        [
            kernels::c(k, x, f),
            kernels::wrench(k, x, f),
            kernels::d_force_dx(k, x, f, &m.lambda),
            kernels::d_residual_dx(k, x, &m.v, &m.a, f),
            kernels::d_gamma_dv(k, x, &m.v, f),
        ]
    }
}
