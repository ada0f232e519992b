//! Definitions with one wrong entry; the harness must detect each of them and name the violated
//! property.

use joints::generated::{
    DistanceLengthDrive, Fixed, KnifeEdge, PinInSlotDisplacementDrive, SpringDamper, Velocity,
};
use joints::spec::{ConstraintSpec, Datum, DatumShape, ForceSpec};
use joints::{
    Argument, ArgumentError, Constraint, ConstraintKernels, Definition, Element, Force,
    ForceElement, Pose, Programs, Reaction, Real, Ring, Scalar, Twist, Visitor,
};
use pfaff_joint_conformance::{Failure, Property, check_constraint, check_force};

use crate::SEED;

/// The wrong kernel is a constant parameter of the type of the mutant.
mod wrong {
    pub(super) const PHI: u8 = 0;
    pub(super) const C_CONSTANT: u8 = 1;
    pub(super) const C: u8 = 2;
    pub(super) const B: u8 = 3;
    pub(super) const GAMMA: u8 = 4;
    pub(super) const WRENCH: u8 = 5;
    pub(super) const COMPONENT: u8 = 6;
    pub(super) const PLACE: u8 = 7;
    pub(super) const D_FORCE_DX: u8 = 8;
    pub(super) const D_RESIDUAL_DX: u8 = 9;
    pub(super) const D_GAMMA_DV: u8 = 10;
    pub(super) const INITIALISE: u8 = 11;
    pub(super) const REQUIREMENT: u8 = 12;
    pub(super) const C_UNWRITTEN: u8 = 13;
    pub(super) const PATTERN: u8 = 14;
    pub(super) const RHEONOMIC: u8 = 15;
    pub(super) const D_VELOCITY_DX: u8 = 16;
    pub(super) const DATA: u8 = 17;
    pub(super) const SET_DATA: u8 = 18;
    pub(super) const STORED: u8 = 19;
    pub(super) const PROGRAM: u8 = 20;
    pub(super) const DATUM: u8 = 21;
    pub(super) const NORMALISED: u8 = 22;
}

/// The definition `K` with a change in the first entry of the kernel `WRONG`.
#[derive(Clone)]
struct Mutant<K, const WRONG: u8>(K);

/// Changes the sign of the first entry, or sets it to another value if it is zero.
fn change<T: Ring>(out: &mut [T], here: bool) {
    if let (true, Some(first)) = (here, out.first_mut()) {
        *first = T::from(0.125) - *first;
    }
}

impl<K: Constraint, const WRONG: u8> Constraint for Mutant<K, WRONG> {
    const SPEC: ConstraintSpec = {
        let mut spec = K::SPEC;
        if WRONG == wrong::PATTERN {
            // The pattern lacks one entry, whose derivative is not zero.
            let (_, rest) = spec.d_residual_dx.split_at(1);
            spec.d_residual_dx = rest;
        }
        if WRONG == wrong::RHEONOMIC {
            spec.rheonomic = !spec.rheonomic;
        }
        if WRONG == wrong::DATUM {
            // The first datum has the shape of a unit vector although it is a point, and the other
            // data are missing.
            const WRONG_SHAPE: [Datum; 1] =
                [Datum::new("s_i", DatumShape::Direction { slot: 0 }, 0, 2)];
            spec.data = &WRONG_SHAPE;
        }
        spec
    };

    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError> {
        K::from_arguments(arguments).map(Self)
    }
    fn visit_drives<V: Visitor>(_: &mut V) {}
    fn element<T: Scalar>(&self) -> &dyn Element<T> {
        self
    }
    fn reaction<T: Real>(&self) -> &dyn Reaction<T> {
        self
    }
}

impl<K: Constraint, const WRONG: u8> Definition for Mutant<K, WRONG> {
    fn initialise(&mut self, x: &[Pose]) {
        if WRONG != wrong::INITIALISE {
            self.0.initialise(x);
        }
    }
    fn requirement(&self, k: usize, x: &[Pose]) -> bool {
        WRONG != wrong::REQUIREMENT && self.0.requirement(k, x)
    }
    fn points(&self) -> Vec<[f64; 2]> {
        self.0.points()
    }
    fn data(&self, out: &mut [f64]) {
        let mut all = vec![0.0; K::SPEC.n_data()];
        self.0.data(&mut all);
        out.copy_from_slice(&all[..out.len()]);
        change(out, WRONG == wrong::DATA);
    }
    fn set_data(&mut self, numbers: &[f64]) {
        let mut numbers = numbers.to_vec();
        if WRONG == wrong::NORMALISED {
            for datum in K::SPEC.data {
                if let (DatumShape::Direction { .. }, [x, y]) =
                    (datum.shape, &mut numbers[datum.numbers()])
                {
                    let length = x.hypot(*y);
                    (*x, *y) = (*x / length, *y / length);
                }
            }
        }
        if WRONG != wrong::SET_DATA {
            self.0.set_data(&numbers);
        }
    }
}

impl<T: Scalar, K: Constraint, const WRONG: u8> Element<T> for Mutant<K, WRONG> {
    fn spec(&self) -> &'static ConstraintSpec {
        &<Self as Constraint>::SPEC
    }
    fn phi(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        self.0.element::<T>().phi(x, f, out);
        change(out, WRONG == wrong::PHI);
    }
    fn c_constant(&self, out: &mut [T]) {
        self.0.element::<T>().c_constant(out);
        change(out, WRONG == wrong::C_CONSTANT);
    }
    fn c(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        if WRONG != wrong::C_UNWRITTEN {
            self.0.element::<T>().c(x, f, out);
        }
        change(out, WRONG == wrong::C);
    }
    fn b(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        self.0.element::<T>().b(x, f, out);
        change(out, WRONG == wrong::B);
    }
    fn gamma(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        self.0.element::<T>().gamma(x, v, f, out);
        change(out, WRONG == wrong::GAMMA);
    }
    fn component(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        self.0.element::<T>().component(x, f, out);
        if WRONG == wrong::COMPONENT {
            out.iter_mut().for_each(|e| *e = *e + *e);
        }
    }
}

impl<T: Real, K: Constraint, const WRONG: u8> Reaction<T> for Mutant<K, WRONG> {
    fn wrench(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]) {
        self.0.reaction::<T>().wrench(x, f, out);
        change(out, WRONG == wrong::WRENCH);
    }
    fn place(&self, x: &[Pose<T>]) -> [T; 2] {
        let [x_p, y_p] = self.0.reaction::<T>().place(x);
        if WRONG == wrong::PLACE {
            [y_p, x_p]
        } else {
            [x_p, y_p]
        }
    }
}

impl<K: Constraint, const WRONG: u8> ConstraintKernels for Mutant<K, WRONG> {
    fn programs(&self) -> &Programs {
        if WRONG != wrong::PROGRAM {
            return self.0.programs();
        }
        let mut stored = Vec::new();
        self.stored(&mut stored);
        let other = Mutant::<K, { wrong::B }>(self.0.clone());
        Box::leak(Box::new(Programs::record(&other, stored.len())))
    }
    fn stored(&self, out: &mut Vec<f64>) {
        self.0.stored(out);
    }
    fn d_stored_dp(&self, entry: &mut dyn FnMut(usize, usize, f64)) {
        let mut is_changed = WRONG == wrong::STORED;
        self.0.d_stored_dp(&mut |place, number, slope| {
            let mut slope = [slope];
            change(&mut slope, is_changed);
            is_changed = false;
            entry(place, number, slope[0]);
        });
    }
    fn d_force_dx(&self, x: &[Pose], f: &[[f64; 3]], lambda: &[f64], out: &mut [f64]) {
        self.0.d_force_dx(x, f, lambda, out);
        change(out, WRONG == wrong::D_FORCE_DX);
    }
    fn d_residual_dx(&self, x: &[Pose], v: &[Twist], a: &[Twist], f: &[[f64; 3]], out: &mut [f64]) {
        let mut all = vec![0.0; K::SPEC.d_residual_dx.len()];
        self.0.d_residual_dx(x, v, a, f, &mut all);
        out.copy_from_slice(&all[all.len() - out.len()..]);
        change(out, WRONG == wrong::D_RESIDUAL_DX);
    }
    fn d_gamma_dv(&self, x: &[Pose], v: &[Twist], f: &[[f64; 3]], out: &mut [f64]) {
        self.0.d_gamma_dv(x, v, f, out);
        change(out, WRONG == wrong::D_GAMMA_DV);
    }
    fn d_velocity_dx(&self, x: &[Pose], v: &[Twist], f: &[[f64; 3]], out: &mut [f64]) {
        self.0.d_velocity_dx(x, v, f, out);
        change(out, WRONG == wrong::D_VELOCITY_DX);
    }
    fn boxed(&self) -> Box<dyn ConstraintKernels> {
        Box::new(self.clone())
    }
}

/// The definition `K` with a change in the first entry of Q or of a derivative, or with the
/// opposite sign in all entries.
#[derive(Clone)]
struct ForceMutant<K, const WRONG: u8>(K);

mod wrong_force {
    pub(super) const Q: u8 = 0;
    pub(super) const DQ_DX: u8 = 1;
    pub(super) const DQ_DV: u8 = 2;
    pub(super) const SIGN: u8 = 3;
    pub(super) const FLAG: u8 = 4;
}

impl<K: Force, const WRONG: u8> ForceMutant<K, WRONG> {
    fn change<T: Real>(out: &mut [T], kernel: u8) {
        change(out, WRONG == kernel);
        Self::turn_round(out);
    }

    fn turn_round<T: Real>(out: &mut [T]) {
        if WRONG == wrong_force::SIGN {
            out.iter_mut().for_each(|e| *e = -*e);
        }
    }
}

impl<K: Force, const WRONG: u8> Force for ForceMutant<K, WRONG> {
    const SPEC: ForceSpec = {
        let mut spec = K::SPEC;
        spec.dissipative = spec.dissipative != (WRONG == wrong_force::FLAG);
        spec
    };

    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError> {
        K::from_arguments(arguments).map(Self)
    }
    fn element<T: Real>(&self) -> &dyn ForceElement<T> {
        self
    }
}

impl<K: Force, const WRONG: u8> Definition for ForceMutant<K, WRONG> {
    fn initialise(&mut self, x: &[Pose]) {
        self.0.initialise(x);
    }
    fn requirement(&self, k: usize, x: &[Pose]) -> bool {
        self.0.requirement(k, x)
    }
    fn points(&self) -> Vec<[f64; 2]> {
        self.0.points()
    }
}

impl<T: Real, K: Force, const WRONG: u8> ForceElement<T> for ForceMutant<K, WRONG> {
    fn spec(&self) -> &'static ForceSpec {
        &<Self as Force>::SPEC
    }
    fn q(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        self.0.element::<T>().q(x, v, f, out);
        if WRONG == wrong_force::Q {
            // A constant load without an opposite load, which checks of derivatives do not detect.
            out[0] = out[0] + T::from(1.0);
        }
        Self::turn_round(out);
    }
    fn dq_dx(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        self.0.element::<T>().dq_dx(x, v, f, out);
        Self::change(out, wrong_force::DQ_DX);
    }
    fn dq_dv(&self, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]], out: &mut [T]) {
        self.0.element::<T>().dq_dv(x, v, f, out);
        Self::change(out, wrong_force::DQ_DV);
    }
}

fn found(result: Result<(), Failure>) -> Property {
    result.expect_err("the mutant is wrong").property
}

type Drive<const WRONG: u8> = Mutant<PinInSlotDisplacementDrive, WRONG>;
type Cylinder<const WRONG: u8> = Mutant<DistanceLengthDrive, WRONG>;

#[test]
fn a_definition_without_a_change_passes() {
    const NONE: u8 = u8::MAX;
    assert!(check_constraint::<Drive<NONE>, _>(SEED).is_ok());
    assert!(check_force::<ForceMutant<SpringDamper, NONE>, _>(SEED).is_ok());
}

#[test]
fn a_wrong_entry_of_any_constraint_kernel_is_named() {
    use Property as P;
    let cases = [
        (
            found(check_constraint::<Drive<{ wrong::PHI }>, _>(SEED)),
            P::C,
        ),
        (
            found(check_constraint::<Mutant<Fixed, { wrong::C_CONSTANT }>, _>(
                SEED,
            )),
            P::C,
        ),
        (
            found(check_constraint::<Drive<{ wrong::C }>, _>(SEED)),
            P::C,
        ),
        (
            found(check_constraint::<Drive<{ wrong::B }>, _>(SEED)),
            P::B,
        ),
        (
            found(check_constraint::<Drive<{ wrong::GAMMA }>, _>(SEED)),
            P::GammaFromPhi,
        ),
        (
            found(check_constraint::<Drive<{ wrong::WRENCH }>, _>(SEED)),
            P::Wrench,
        ),
        (
            found(check_constraint::<Drive<{ wrong::COMPONENT }>, _>(SEED)),
            P::Power,
        ),
        (
            found(check_constraint::<Cylinder<{ wrong::COMPONENT }>, _>(SEED)),
            P::Power,
        ),
        (
            found(check_constraint::<Cylinder<{ wrong::B }>, _>(SEED)),
            P::B,
        ),
        (
            found(check_constraint::<Mutant<KnifeEdge, { wrong::COMPONENT }>, _>(SEED)),
            P::Component,
        ),
        (
            found(check_constraint::<Drive<{ wrong::D_FORCE_DX }>, _>(SEED)),
            P::DForceDx,
        ),
        (
            found(check_constraint::<Drive<{ wrong::D_RESIDUAL_DX }>, _>(SEED)),
            P::DResidualDx,
        ),
        (
            found(check_constraint::<Drive<{ wrong::D_GAMMA_DV }>, _>(SEED)),
            P::DGammaDv,
        ),
        (
            found(check_constraint::<Drive<{ wrong::D_VELOCITY_DX }>, _>(SEED)),
            P::DVelocityDx,
        ),
        (
            found(check_constraint::<Drive<{ wrong::INITIALISE }>, _>(SEED)),
            P::Start,
        ),
        (
            found(check_constraint::<Drive<{ wrong::REQUIREMENT }>, _>(SEED)),
            P::Requirements,
        ),
        (
            found(check_constraint::<Drive<{ wrong::C_UNWRITTEN }>, _>(SEED)),
            P::Writes,
        ),
        (
            found(check_constraint::<Drive<{ wrong::PATTERN }>, _>(SEED)),
            P::DResidualDx,
        ),
        (
            found(check_constraint::<Drive<{ wrong::RHEONOMIC }>, _>(SEED)),
            P::Writes,
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
    // The check of the wrench about a wrong point fails before the check of the point itself.
    let place = found(check_constraint::<Drive<{ wrong::PLACE }>, _>(SEED));
    assert!(matches!(place, P::Wrench | P::Place), "{place:?}");
}

#[test]
fn a_wrong_entry_of_a_velocity_row_is_named() {
    // Γ is compared with C and b, so this check detects an error in either.
    for found in [
        found(check_constraint::<Mutant<Velocity, { wrong::C }>, _>(SEED)),
        found(check_constraint::<Mutant<Velocity, { wrong::B }>, _>(SEED)),
        found(check_constraint::<Mutant<Velocity, { wrong::GAMMA }>, _>(
            SEED,
        )),
    ] {
        assert_eq!(found, Property::Gamma);
    }
}

#[test]
fn a_wrong_derivative_by_the_data_is_named() {
    use Property as P;
    type Edge<const WRONG: u8> = Mutant<Velocity, WRONG>;
    let cases = [
        (
            found(check_constraint::<Drive<{ wrong::DATA }>, _>(SEED)),
            P::Data,
        ),
        (
            found(check_constraint::<Drive<{ wrong::SET_DATA }>, _>(SEED)),
            P::Data,
        ),
        (
            found(check_constraint::<Drive<{ wrong::DATUM }>, _>(SEED)),
            P::Data,
        ),
        (
            found(check_constraint::<Drive<{ wrong::NORMALISED }>, _>(SEED)),
            P::Data,
        ),
        (
            found(check_constraint::<Drive<{ wrong::PROGRAM }>, _>(SEED)),
            P::Programs,
        ),
        (
            found(check_constraint::<Drive<{ wrong::STORED }>, _>(SEED)),
            P::DPhiDp,
        ),
        (
            found(check_constraint::<Edge<{ wrong::STORED }>, _>(SEED)),
            P::DResidualDp,
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
}

#[test]
fn a_wrong_entry_of_any_force_kernel_is_named() {
    use wrong_force::{DQ_DV, DQ_DX, FLAG, Q, SIGN};
    type Spring<const WRONG: u8> = ForceMutant<SpringDamper, WRONG>;
    assert_eq!(found(check_force::<Spring<Q>, _>(SEED)), Property::Balance);
    assert_eq!(found(check_force::<Spring<DQ_DX>, _>(SEED)), Property::DqDx);
    assert_eq!(found(check_force::<Spring<DQ_DV>, _>(SEED)), Property::DqDv);
    assert_eq!(
        found(check_force::<Spring<SIGN>, _>(SEED)),
        Property::Dissipation
    );
    assert_eq!(found(check_force::<Spring<FLAG>, _>(SEED)), Property::DqDv);
}

#[test]
fn a_failure_says_what_a_joint_author_needs() {
    let failure = check_constraint::<Drive<{ wrong::C }>, _>(SEED).expect_err("C is wrong");
    assert_eq!(failure.definition, "PinInSlotDisplacementDrive");
    assert!(failure.relative_error() > failure.tolerance);
    let text = failure.to_string();
    for part in [
        "violated: C = ∂Φ/∂x",
        "row `displacement`, column i.x",
        "pose (x ",
        "dual numbers",
    ] {
        assert!(text.contains(part), "`{part}` is not in\n{text}");
    }
}
