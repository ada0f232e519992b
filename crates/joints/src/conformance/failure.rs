//! The report of a check: the definition, the property, the entry, both values, and the case to
//! reproduce it.

use std::fmt;

use super::block::Block;
use super::case::Case;

/// A property of all definitions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Property {
    /// Parameters drawn from the specification are accepted.
    Arguments,
    /// The requirements hold at some start, and a requirement with a larger number always holds.
    Requirements,
    /// Entries of a pattern are within the block, occur once, and do not vanish in all cases.
    Pattern,
    /// `c_constant` writes the constant entries and `c` the others; `b` writes only if rheonomic.
    Writes,
    /// `C = ∂Φ/∂x` along the degrees of freedom.
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
    /// `data` returns the numbers in the specification, and `set_data` sets them.
    Data,
    /// `∂(λᵀ·Φ)/∂p`
    DPhiDp,
    /// `∂(λᵀ·(C·a − Γ))/∂p`
    DResidualDp,
    /// The wrench is −C of the first body, moved to the place.
    Wrench,
    /// The place is fixed in the first body.
    Place,
    /// The named component is the force along a unit vector, or the torque.
    Component,
    /// Forces on the bodies add up to zero force and zero moment.
    Balance,
    /// Moving all bodies as one rigid body leaves the norm of each block unchanged.
    RigidMotion,
    /// Rows that store an initial value are zero at the start, and rows that restrict it are not
    /// always.
    Start,
    /// `∂Q/∂x`
    DqDx,
    /// `∂Q/∂v`
    DqDv,
    /// The velocity terms of a force never add energy.
    Dissipation,
}

impl fmt::Display for Property {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Arguments => "parameters drawn from the spec are accepted",
            Self::Requirements => "the requirements hold at some start",
            Self::Pattern => {
                "the pattern names each entry that does not vanish, once, and no other"
            }
            Self::Writes => "kernels write exactly the entries that are theirs",
            Self::C => "C = ∂Φ/∂x",
            Self::B => "b = −∂Φ/∂t",
            Self::Velocity => "C·v − b = dΦ/dt",
            Self::GammaFromPhi => "Γ = −d²Φ/dτ² along x + τv",
            Self::Gamma => "Γ = −d(C·v − b)/dτ along x + τv",
            Self::DForceDx => "d_force_dx = ∂(Cᵀλ)/∂x",
            Self::DResidualDx => "d_residual_dx = ∂(C·a − Γ)/∂x",
            Self::DGammaDv => "d_gamma_dv = ∂Γ/∂v",
            Self::DVelocityDx => "d_velocity_dx = ∂(C·v − b)/∂x",
            Self::Data => {
                "`data` tells the numbers that the facts name, and `set_data` puts numbers back"
            }
            Self::DPhiDp => "d_phi_dp = ∂(λᵀ·Φ)/∂p",
            Self::DResidualDp => "d_residual_dp = ∂(λᵀ·(C·a − Γ))/∂p",
            Self::Wrench => "the wrench is −C of the first body, moved to the place",
            Self::Place => "the place is fixed in the first body",
            Self::Component => "the named component is not larger than the reaction",
            Self::Balance => "forces and moments on all bodies add up to zero",
            Self::RigidMotion => "moving all bodies as one leaves the norm of each block unchanged",
            Self::Start => "rows that keep the start, and only these, are zero there",
            Self::DqDx => "dq_dx = ∂Q/∂x",
            Self::DqDv => "dq_dv = ∂Q/∂v",
            Self::Dissipation => "velocity terms never add energy",
        })
    }
}

/// Source of the expected value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reference {
    /// A derivative by dual numbers.
    DualNumbers,
    /// A derivative by central differences, extrapolated.
    Differences,
    /// An identity between kernels, or a statement of the specification.
    Identity,
}

/// A property that a definition violates.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Name of the definition.
    pub definition: &'static str,
    /// The property.
    pub property: Property,
    /// Source of the expected value.
    pub reference: Reference,
    /// Description of the worst entry.
    pub entry: String,
    /// Row of the worst entry.
    pub row: usize,
    /// Column of the worst entry.
    pub column: usize,
    /// Value of the kernel.
    pub found: f64,
    /// Value of the reference.
    pub expected: f64,
    /// The size relative to which the difference is measured: usually the largest entry of the
    /// block.
    pub scale: f64,
    /// The largest difference allowed, relative to the scale.
    pub tolerance: f64,
    /// The case, if the property belongs to a single case.
    pub case: Option<Box<Case>>,
}

impl Failure {
    /// The difference relative to the scale.
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

/// Compares blocks for one case of one definition.
pub(super) struct Judge<'a> {
    pub(super) definition: &'static str,
    pub(super) case: &'a Case,
}

/// An assertion: two blocks are equal up to the tolerance, relative to their largest entry.
pub(super) struct Claim<'a> {
    pub(super) property: Property,
    pub(super) reference: Reference,
    pub(super) found: &'a Block,
    pub(super) expected: &'a Block,
    pub(super) tolerance: f64,
    /// Size to be used if the largest entry is smaller: that of the terms before they cancelled.
    pub(super) floor: f64,
}

impl Judge<'_> {
    /// Returns the worst entry if the assertion is violated, described by `entry`.
    pub(super) fn decide(
        &self,
        claim: &Claim<'_>,
        entry: impl Fn(usize, usize) -> String,
    ) -> Result<(), Failure> {
        let equal = approx::relative_eq!(
            claim.found,
            claim.expected,
            epsilon = claim.tolerance * claim.floor,
            max_relative = claim.tolerance
        );
        if equal {
            Ok(())
        } else {
            Err(self.failure(claim, entry))
        }
    }

    fn failure(&self, claim: &Claim<'_>, entry: impl Fn(usize, usize) -> String) -> Failure {
        let scale = claim
            .found
            .largest()
            .max(claim.expected.largest())
            .max(claim.floor);
        let (row, column) = claim.found.worst(claim.expected).unwrap_or((0, 0));
        Failure {
            definition: self.definition,
            property: claim.property,
            reference: claim.reference,
            entry: entry(row, column),
            row,
            column,
            found: claim.found.get(row, column),
            expected: claim.expected.get(row, column),
            scale,
            tolerance: claim.tolerance,
            case: Some(Box::new(self.case.clone())),
        }
    }
}

/// A failure that is not a comparison of blocks: `found` instead of `expected`.
pub(super) fn fact(
    definition: &'static str,
    property: Property,
    entry: String,
    [found, expected]: [f64; 2],
    case: Option<&Case>,
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
        case: case.map(|c| Box::new(c.clone())),
    }
}
