#![doc = include_str!("../README.md")]
//!
//! # Notation
//!
//! | doc | code | meaning | shape |
//! | --- | --- | --- | --- |
//! | q, q̇ | `q`, `rate` | coordinates in the order of the bodies (x, y, φ), and their rates | n_q |
//! | v, v̇ | `v`, `a` | velocities and accelerations in the order of the bodies; in the plane v = q̇ | n_v |
//! | Φ | `phi` | holonomic constraints | m |
//! | Ψ, ψ | `psi` | Pfaffian rows, Ψ·v + ψ = 0 | h × n_v |
//! | C, b | `c`, `b` | all rows stacked, C = \[Φq; Ψ\], C·v = b = \[−Φt; −ψ\] | (m+h) × n_v |
//! | Γ | `gamma` | right-hand side of C·v̇ = Γ | m+h |
//! | M | `inertia` | mass matrix: the diagonal `mass`, and the rows of armatures | n_v × n_v |
//! | Q | `force` | applied forces, including gravity | n_v |
//! | λ | `lambda` | multipliers in M·v̇ + Cᵀ·λ = Q; the reaction of the joint X is −C_Xᵀ·λ_X | m+h |
//!
//! # Code map, in the order of the data
//!
//! | module | content |
//! | --- | --- |
//! | [`function`] | functions of time with their derivatives and break times |
//! | [`registry`] | definitions of joints and forces, found by their type in scenes |
//! | [`description`] | bodies, joints, drives and forces as plain data |
//! | [`frame`] | body frames whose origin is not the centre of mass, and states of points |
//! | `data` | points, directions and scalars stored by constraints, and derivatives of rows |
//! | [`coupling`] | couplings between joint coordinates |
//! | [`law`] | force laws: forces of drives as functions of a joint coordinate and its rate |
//! | [`mechanism`] | the assembled equations |
//! | `element` | kernels with the poses and velocities of their bodies |
//! | [`system`] | the interface of the equations for solvers |
//! | [`extended`] | constraints in double-double, for certificates of the rank |
//! | [`record`] | the equations as operation lists, for code generators |
//! | `group` | joints and drives with their rows |
//! | `size` | the length scale of a mechanism |
//! | `scale` | reference sizes for residuals |
//! | `tolerance` | stated tolerances of the data |
//! | `uncertainty` | the uncertainty of the entries of C |
//! | [`space`] | coordinates of bodies, and displacements of a configuration along velocities |
//! | [`start`] | consistent initial coordinates and velocities |
//! | `principal` | principal axes of bodies with products of inertia |
//! | `observed` | markers, and measures between them |
//! | `vectors` | poses, vectors and tensors of `nalgebra` for bodies in space |
//! | `contact` | joints that only push, and contacts that slip |
//! | `called` | forces that are computed by a callback of the caller |
//! | [`reaction`] | forces and torques of reactions, computed from multipliers |

mod agreement;
mod arms;
mod body;
mod called;
pub mod codes;
mod contact;
pub mod coupling;
mod data;
pub mod description;
mod element;
pub mod extended;
pub mod frame;
pub mod function;
mod group;
pub mod law;
pub mod mechanism;
mod observed;
mod principal;
pub mod reaction;
pub mod record;
pub mod registry;
mod rounding;
mod rows;
mod scale;
mod size;
pub mod space;
pub mod start;
pub mod system;
mod tolerance;
mod uncertainty;
mod vectors;
pub mod words;

pub use agreement::{ConstraintLevel, Level, is_at_rest};
pub use called::{
    BodyState, CallError, CalledWrench, ControlState, Controller, DriveState, Efforts, Wrench,
};
pub use contact::{ContactLimits, Grip, GripLoad, OpenSide};
pub use data::{
    Data, DataBlock, DataGradients, DataSlopes, DataUnit, ForceDerivatives, SHARED, explained,
};
pub use description::{
    AnyDescription, Armature, Body, BodyRecord, BodyRef, DescribedBody, Description, Drive, Force,
    FramePose, Joint, MechanismDescription, Motion, SetLawError, SpatialBody, SpatialDescription,
};
pub use element::{Bodies, BodySpace, ConstraintKernels, ForceKernels};
pub use extended::PolishedConfiguration;
pub use frame::{FrameState, Frames};
pub use function::{Function, FunctionError};
pub use law::Law;
pub use mechanism::{
    AppliedForce, AppliedForces, BuildError, Buildable, DerivativeGap, Derivatives, ForceMeasure,
    ForceWithoutDerivatives, InertiaAt, JointArmature, Load, Loads, Mechanism, Part, Places, Push,
    Sparse, UndefinedForce, Work,
};
/// The version of `nalgebra` for the poses, vectors and tensors of bodies in space.
pub use nalgebra;
pub use observed::{Marker, Measure, MeasureKind, Observables};
pub use principal::Principal;
pub use reaction::{Axes, ColumnKind, ConstraintId, ConstraintKind, Frame, Reaction, Reactions};
pub use record::RecordedEquations;
pub use registry::{ConstraintDefinition, Definitions, ForceDefinition, Registry};
pub use rounding::ROUNDING;
pub use rows::RowRanges;
pub use scale::Scales;
pub use space::{Space, SpaceKind};
pub use start::{Assembly, Coordinate, StartError, StartOptions, StartPose};
pub use system::{Layout, RowLabel, Scratch, System};
pub use tolerance::{Tolerance, ToleranceScope};
pub use uncertainty::ConfigurationAccuracy;
