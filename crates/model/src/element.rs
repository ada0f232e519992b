//! Elements in a mechanism: the kernels of joints, drives and forces, together with the poses and
//! velocities of their bodies.
//!
//! Only this module depends on the data types in which kernels receive poses and velocities. The
//! other modules of the crate evaluate a [`PlacedConstraint`] or a [`PlacedForce`] with [`Slots`],
//! and read poses of bodies from [`Bodies`]. Elements whose kernels need other data types must be
//! added in this module.

mod armature;
mod bodies;
mod constraint;
mod extended;
mod force;
mod kernels;
mod recorded;
mod slots;
mod spaces;
mod turned;

pub(crate) use armature::{MOST_BODIES, PlacedArmature};
pub use bodies::Bodies;
pub(crate) use bodies::{angle_at, axes_at, turned_at};
pub(crate) use constraint::{FramedConstraint, PlacedConstraint};
pub(crate) use extended::ExtendedSlots;
pub(crate) use force::PlacedForce;
pub use joints::ConstraintKernels;
use kernels::with;
pub(crate) use kernels::{AnyConstraint, AnyForce, DriveScalar, RowsAt, stored};
pub use kernels::{AttachedConstraint, AttachedMeasure, BodySpace, ForceKernels};
pub use recorded::Input;
pub(crate) use recorded::RecordedSlots;
pub(crate) use slots::{Kinematics, PoseOf, Rates, Site, Slots, TwistOf};
pub(crate) use turned::TurnedSlots;
