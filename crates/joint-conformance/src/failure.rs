//! The report of a failed check. The report contains the definition, the property, the entry, both
//! values, and the case with which the failure can be reproduced.

use std::fmt;

use crate::block::Block;

/// A property that definitions must have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Property {
    /// The constructor accepts random parameters that agree with the specification.
    Arguments,
    /// The requirements are satisfied at some initial configuration, and a requirement with an
    /// index after the last one is always satisfied.
    Requirements,
    /// The entries of a pattern are within the block, occur only once, and are nonzero in some
    /// case.
    Pattern,
    /// `c_constant` writes the constant entries, and `c` writes the other entries. `b` writes only
    /// if the constraint depends on time.
    Writes,
    /// `C = ∂Φ/∂x` along the velocity components.
    C,
    /// `b = −∂Φ/∂t`
    B,
    /// `C·v − b = Φ̇`
    Velocity,
    /// `Γ = −Φ̈` along `x + τv`.
    GammaFromPhi,
    /// `Γ = −d(C·v − b)/dτ` along `x + τv`.
    Gamma,
    /// `∂(Cᵀλ)/∂x`
    DForceDx,
    /// `∂(C·a − Γ)/∂x`
    DResidualDx,
    /// `∂Γ/∂v`
    DGammaDv,
    /// `∂(C·v − b)/∂x`
    DVelocityDx,
    /// Cosine, sine and rate of an unwrapped angle are those of the same angle.
    Turned,
    /// `data` returns as many values as the specification contains, and `set_data` sets them.
    Data,
    /// `∂(λᵀ·Φ)/∂p`
    DPhiDp,
    /// `∂(λᵀ·(C·a − Γ))/∂p`
    DResidualDp,
    /// The programs of the rows give the same results as the kernels, bit for bit.
    Programs,
    /// The wrench is −C of the first body, transferred to the reference point.
    Wrench,
    /// The force law has a value at most poses.
    Defined,
    /// The reference point is fixed in the first body. If joints support wheels on a carrier, the
    /// reference point is fixed in the carrier.
    Place,
    /// The named component is the force along a unit vector, or a torque.
    Component,
    /// The component of a drive is the load that does work. The product of this load and the rate
    /// of the motion is b.
    Power,
    /// Forces on the bodies have neither a resultant force nor a resultant torque.
    Balance,
    /// A rigid motion of all bodies does not change the norm of any block.
    RigidMotion,
    /// Rows that store an initial value are zero at the initial configuration, and rows that
    /// restrict the initial configuration are not always zero.
    Start,
    /// `∂Q/∂x`
    DqDx,
    /// `∂Q/∂v`
    DqDv,
    /// The terms of a force that depend on velocities never add energy.
    Dissipation,
}

impl fmt::Display for Property {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Arguments => "parameters drawn from the spec are accepted",
            Self::Requirements => "some start satisfies the requirements",
            Self::Pattern => {
                "the pattern names each entry that does not vanish, once, and no other"
            }
            Self::Writes => "kernels write exactly their own entries",
            Self::C => "C = ∂Φ/∂x",
            Self::B => "b = −∂Φ/∂t",
            Self::Velocity => "C·v − b = dΦ/dt",
            Self::GammaFromPhi => "Γ = −d²Φ/dτ² along x + τv",
            Self::Gamma => "Γ = −d(C·v − b)/dτ along x + τv",
            Self::DForceDx => "d_force_dx = ∂(Cᵀλ)/∂x",
            Self::DResidualDx => "d_residual_dx = ∂(C·a − Γ)/∂x",
            Self::DGammaDv => "d_gamma_dv = ∂Γ/∂v",
            Self::DVelocityDx => "d_velocity_dx = ∂(C·v − b)/∂x",
            Self::Turned => "`turned` gives cosine, sine and rate of one angle that moves",
            Self::Data => {
                "`data` gives the numbers that the facts name, and `set_data` puts numbers back"
            }
            Self::DPhiDp => "the derivatives with respect to the data are ∂(λᵀ·Φ)/∂p",
            Self::DResidualDp => "the derivatives with respect to the data are ∂(λᵀ·(C·a − Γ))/∂p",
            Self::Programs => "the programs of the rows return the same values as the kernels",
            Self::Wrench => "the wrench is −C of the first body, about the reference point",
            Self::Defined => "the law has a value at most poses",
            Self::Place => "the reference point is fixed in its body",
            Self::Component => "the named component is not larger than the reaction",
            Self::Power => "the component of a drive times the rate of its motion is b",
            Self::Balance => "forces and moments on all bodies add up to zero",
            Self::RigidMotion => "moving all bodies as one leaves the norm of each block unchanged",
            Self::Start => "exactly the rows that lock a joint at its start are zero at the start",
            Self::DqDx => "dq_dx = ∂Q/∂x",
            Self::DqDv => "dq_dv = ∂Q/∂v",
            Self::Dissipation => "velocity terms never add energy",
        })
    }
}

/// The method that computes the expected value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reference {
    /// The derivative is computed with dual numbers.
    DualNumbers,
    /// The derivative is computed with central differences and extrapolation.
    Differences,
    /// The reference is an identity between kernels, or a statement of the specification.
    Identity,
}

/// A property that a definition violates.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Name of the definition.
    pub definition: &'static str,
    /// The property.
    pub property: Property,
    /// The method that computes the expected value.
    pub reference: Reference,
    /// Description of the entry with the largest error.
    pub entry: String,
    /// Row of this entry.
    pub row: usize,
    /// Column of this entry.
    pub column: usize,
    /// The value that the kernel computes.
    pub found: f64,
    /// The expected value.
    pub expected: f64,
    /// The size to which the difference is relative, usually the largest entry of the block.
    pub scale: f64,
    /// The largest permitted difference, relative to `scale`.
    pub tolerance: f64,
    /// Description of the case, if the property belongs to a single case.
    pub case: Option<String>,
}

impl Failure {
    /// Returns the difference relative to `scale`.
    #[must_use]
    pub fn relative_error(&self) -> f64 {
        (self.found - self.expected).abs() / self.scale
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "`{}`: violated: {}", self.definition, self.property)?;
        writeln!(f, "  at {}", self.entry)?;
        writeln!(
            f,
            "  found {:?}, expected {:?} by {}: relative error {:.1e}, at most {:.1e} of {:.3e}",
            self.found,
            self.expected,
            match self.reference {
                Reference::DualNumbers => "dual numbers",
                Reference::Differences => "differences",
                Reference::Identity => "identity",
            },
            self.relative_error(),
            self.tolerance,
            self.scale,
        )?;
        match &self.case {
            Some(case) => write!(f, "{case}"),
            None => write!(f, "  over all cases"),
        }
    }
}

impl std::error::Error for Failure {}

/// Tolerance for comparisons with dual numbers and for identities. Both sides have the rounding
/// error of about ten operations, which is about 1e-15. For coordinates or angles of up to 1e3,
/// this error is up to 1e3 times larger.
pub const DUAL_TOLERANCE: f64 = 1e-12;

/// Tolerance for comparisons with finite differences. Even with the best step, about a third of the
/// digits of a first derivative are lost. Extrapolation recovers most of these digits. The
/// tolerance is determined by second derivatives.
pub const DIFFERENCE_TOLERANCE: f64 = 1e-9;

/// A method that computes expected values, with its accuracy.
#[derive(Clone, Copy)]
pub(crate) struct Oracle {
    pub(crate) reference: Reference,
    pub(crate) tolerance: f64,
    /// Lower limit of the size to which a difference is relative. This limit is the size of the
    /// terms before cancellation.
    pub(crate) floor: f64,
}

impl Oracle {
    /// If a block is zero, the derivatives in all dual numbers are zero, too, unless terms cancel
    /// each other.
    pub(crate) const DUAL_NUMBERS: Self = Self {
        reference: Reference::DualNumbers,
        tolerance: DUAL_TOLERANCE,
        floor: 0.0,
    };

    /// In ordinary cases, coordinates, velocities and parameters are about 1.
    pub(crate) const DIFFERENCES: Self = Self {
        reference: Reference::Differences,
        tolerance: DIFFERENCE_TOLERANCE,
        floor: 1.0,
    };

    /// Returns the same method with a floor that is at least this large.
    pub(crate) fn with_floor(self, floor: f64) -> Self {
        Self {
            floor: self.floor.max(floor),
            ..self
        }
    }

    /// Returns the method for an identity between terms of the size `floor`.
    pub(crate) fn identity(floor: f64) -> Self {
        Self {
            reference: Reference::Identity,
            tolerance: DUAL_TOLERANCE,
            floor,
        }
    }
}

/// The claim that two blocks are equal up to the tolerance. The difference is relative to the
/// largest entry of the blocks, or to the floor of the method.
pub(crate) struct Claim<'a> {
    pub(crate) property: Property,
    pub(crate) oracle: Oracle,
    pub(crate) found: &'a Block,
    pub(crate) expected: &'a Block,
}

impl Claim<'_> {
    /// If the claim is false, returns the entry with the largest error; `entry` returns its name.
    pub(crate) fn decide(
        &self,
        definition: &'static str,
        case: &dyn fmt::Display,
        entry: impl Fn(usize, usize) -> String,
    ) -> Result<(), Failure> {
        let (found, expected) = (self.found, self.expected);
        let Oracle {
            reference,
            tolerance,
            floor,
        } = self.oracle;
        let scale = found.largest().max(expected.largest()).max(floor);
        if found.difference(expected) <= tolerance * scale {
            return Ok(());
        }
        let (row, column) = found.worst(expected).unwrap_or((0, 0));
        Err(Failure {
            definition,
            property: self.property,
            reference,
            entry: entry(row, column),
            row,
            column,
            found: found.get(row, column),
            expected: expected.get(row, column),
            scale,
            tolerance,
            case: Some(case.to_string()),
        })
    }
}

/// Returns the failure of a check that compares two values and not two blocks of entries. `found`
/// is the computed value, and `expected` is the required value.
pub(crate) fn fact(
    definition: &'static str,
    property: Property,
    entry: String,
    [found, expected]: [f64; 2],
    case: Option<&dyn fmt::Display>,
) -> Failure {
    Failure {
        definition,
        property,
        reference: Reference::Identity,
        entry,
        row: 0,
        column: 0,
        found,
        expected,
        scale: 1.0,
        tolerance: 0.0,
        case: case.map(ToString::to_string),
    }
}
