//! Implementations of the traits of kernels for the plane and for space: joints, force laws, called
//! wrenches and couplings.

use joints::{Constraint, ConstraintKernels, Plane, PointForce, Space3, Torque, space3};

use super::kernels::{
    AnyConstraint, AnyForce, AttachedConstraint, AttachedMeasure, BodySpace, ForceKernels,
};
use crate::body::{Body, SpatialBody};
use crate::called::CalledWrench;
use crate::coupling::{CouplingError, couple};
use crate::law::{Law, LawError, law_drive};
use crate::space::SpaceKind;

impl BodySpace for Plane {
    type Body = Body;

    const KIND: SpaceKind = SpaceKind::Plane;

    fn any_constraint(kernels: Box<dyn ConstraintKernels>) -> AnyConstraint {
        AnyConstraint::Plane(kernels)
    }

    fn any_force(kernels: Box<dyn ForceKernels>) -> AnyForce {
        AnyForce::Plane(kernels)
    }

    fn point([x, y]: [f64; 2]) -> [f64; 3] {
        [x, y, 0.0]
    }

    fn vector([x, y, _]: [f64; 3]) -> [f64; 2] {
        [x, y]
    }

    fn to_local(body: &Body, point: [f64; 2]) -> [f64; 2] {
        body.pose().to_local(point)
    }

    fn law<K: Constraint>(drive: K, law: Law) -> Result<Box<dyn ForceKernels>, LawError> {
        law_drive(drive, law)
    }

    fn wrench(wrench: CalledWrench) -> Box<dyn ForceKernels> {
        Box::new(wrench)
    }

    fn loads() -> [Box<dyn ForceKernels>; 2] {
        [Box::new(PointForce::new([0.0; 2])), Box::new(Torque::new())]
    }

    fn couple(
        measures: [AttachedMeasure<Self>; 2],
        coefficients: &[f64],
    ) -> Result<AttachedConstraint<Self>, CouplingError> {
        couple(measures, coefficients)
    }
}

impl BodySpace for Space3 {
    type Body = SpatialBody;

    const KIND: SpaceKind = SpaceKind::Space3;

    fn any_constraint(kernels: Box<dyn ConstraintKernels<Self>>) -> AnyConstraint {
        AnyConstraint::Space3(kernels)
    }

    fn any_force(kernels: Box<dyn ForceKernels<Self>>) -> AnyForce {
        AnyForce::Space3(kernels)
    }

    fn point(point: [f64; 3]) -> [f64; 3] {
        point
    }

    fn vector(components: [f64; 3]) -> [f64; 3] {
        components
    }

    fn to_local(body: &SpatialBody, point: [f64; 3]) -> [f64; 3] {
        body.pose().to_local(point)
    }

    fn law<K: Constraint<Self>>(
        drive: K,
        law: Law,
    ) -> Result<Box<dyn ForceKernels<Self>>, LawError> {
        law_drive(drive, law)
    }

    fn wrench(wrench: CalledWrench) -> Box<dyn ForceKernels<Self>> {
        Box::new(wrench)
    }

    fn loads() -> [Box<dyn ForceKernels<Self>>; 2] {
        let force = space3::PointForce::new([0.0; 3]);
        [Box::new(force), Box::new(space3::Torque::new())]
    }

    fn couple(
        measures: [AttachedMeasure<Self>; 2],
        coefficients: &[f64],
    ) -> Result<AttachedConstraint<Self>, CouplingError> {
        couple(measures, coefficients)
    }
}
