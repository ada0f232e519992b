//! The check of one constraint or force: all cases of a definition, and the properties that are
//! tested in each case.

use joints::Space;
use joints::spec::Shape;

use crate::block::Block;
use crate::bodies::Bodies;
use crate::case::{Case, Kind, Motion};
use crate::derivative::{Curve, Differences, Differentiate, DualNumbers};
use crate::failure::{Claim, Failure, Oracle, Property, fact};
use crate::kernels::KernelNumber;
use crate::state::Along;
use crate::subject::{By, Derivative, Subject};

/// Tests all cases of one definition.
pub(crate) fn check<S: Subject>(of: S, seed: u64) -> Result<(), Failure> {
    let name = of.common().name;
    let mut patterns = of.patterns()?;
    let mut seen = S::Seen::default();
    let (mut cases, mut undefined) = (0, 0);
    let n_rows = of.rows().len();
    for case in Case::all(seed, of.common(), n_rows, of.turning(), of.turns()) {
        let (made, case) = assembled(of, &case)?;
        let check = Check {
            of,
            made: &made,
            case: &case,
        };
        cases += 1;
        if !S::is_defined(&check) {
            undefined += 1;
            continue;
        }
        S::before(&check)?;
        check.derivatives::<DualNumbers>(Oracle::DUAL_NUMBERS)?;
        if case.has_differences() {
            check.derivatives::<Differences>(Oracle::DIFFERENCES)?;
        }
        S::properties(&check)?;
        check.rigid_motion()?;
        for (kernel, pattern) in &mut patterns {
            pattern.see(&check.at(*kernel, &case.motions[0]));
        }
        S::see(&check, &mut seen);
    }
    if f64::from(undefined) > MOST_UNDEFINED * f64::from(cases) {
        let entry = format!("it is undefined at {undefined} of {cases} poses");
        let facts = [0.0, 1.0];
        return Err(fact(name, Property::Defined, entry, facts, None));
    }
    for (_, pattern) in &patterns {
        pattern.all_alive(name)?;
    }
    of.facts(&seen)
}

/// A force law may have no value in at most this fraction of the cases. In a tenth of the ordinary
/// cases, rotations exceed 3 rad. The special cases contain rotations by half a revolution.
const MOST_UNDEFINED: f64 = 0.25;

/// Number of initial configurations that are tried for one case. If no configuration satisfies the
/// requirements, the requirements count as impossible.
const STARTS: u64 = 100;

/// Constructs the definition with the parameters of a case, at an initial configuration that
/// satisfies its requirements.
fn assembled<S: Subject>(
    of: S,
    case: &Case<S::Space>,
) -> Result<(S::Made, Case<S::Space>), Failure> {
    let spec = of.common();
    let fail = |property, entry| {
        fact(
            spec.name,
            property,
            entry,
            [0.0, 1.0],
            Some(case as &dyn std::fmt::Display),
        )
    };
    let made = of.make(&case.arguments);
    let mut made = made.map_err(|e| fail(Property::Arguments, e.to_string()))?;
    let mut case = case.clone();
    for attempt in 0..STARTS {
        let definition = S::definition(&mut made);
        definition.initialise(&case.start);
        // A requirement with an index after the last one must always be satisfied.
        let mut all = 0..=spec.requirements.len();
        if all.all(|k| definition.requirement(k, &case.start)) {
            return Ok((made, case));
        }
        case = case.with_another_start(attempt);
    }
    let entry = format!(
        "{STARTS} random starts do not satisfy {:?}",
        spec.requirements
    );
    Err(fail(Property::Requirements, entry))
}

/// The check of one case of one definition.
pub(crate) struct Check<'a, S: Subject> {
    pub(crate) of: S,
    pub(crate) made: &'a S::Made,
    pub(crate) case: &'a Case<S::Space>,
}

/// A kernel as a function of the curve parameter.
struct Path<'a, S: Subject> {
    check: &'a Check<'a, S>,
    motion: &'a Motion,
    along: Along,
    kernel: S::Kernel,
}

impl<S: Subject> Curve for Path<'_, S> {
    fn at<D: KernelNumber>(&self, tau: D) -> Block<D> {
        let Check { of, made, case } = *self.check;
        let state = self.along.state(case, self.motion, tau);
        of.kernel(made, self.kernel, &state)
    }
}

impl<S: Subject> Check<'_, S> {
    /// Returns a kernel at the state of the case.
    pub(crate) fn at(&self, kernel: S::Kernel, motion: &Motion) -> Block {
        let state = Along::Time.state(self.case, motion, 0.0);
        self.of.final_kernel(self.made, kernel, &state)
    }

    /// Returns a block whose columns are the columns of all motions.
    pub(crate) fn each(&self, block: impl Fn(&Motion) -> Block) -> Block {
        Block::beside(&self.case.motions.iter().map(block).collect::<Vec<_>>())
    }

    fn curve<'s>(&'s self, kernel: S::Kernel, along: Along, motion: &'s Motion) -> Path<'s, S> {
        Path {
            check: self,
            motion,
            along,
            kernel,
        }
    }

    fn derivatives<O: Differentiate>(&self, oracle: Oracle) -> Result<(), Failure> {
        S::derivatives().try_for_each(|derivative| {
            let Derivative {
                property,
                kernel,
                sign,
                of,
                by,
            } = *derivative;
            let expected = self.each(|m| self.derivative::<O>(of, by, m).map(|e| sign * e));
            let found = self.each(|m| self.at(kernel, m).head(expected.rows()));
            // Terms may cancel for every motion, for example ω × ω in Γ of a ball about its own
            // centre. In this case, the remaining rounding error is compared with the size of the
            // differentiated terms.
            let oracle = if found.largest() == 0.0 {
                oracle.with_floor(self.each(|m| self.at(of, m)).largest())
            } else {
                oracle
            };
            self.claim(property, oracle, &found, &expected)
        })
    }

    /// Computes a derivative of a kernel.
    pub(crate) fn derivative<O: Differentiate>(
        &self,
        of: S::Kernel,
        by: By,
        motion: &Motion,
    ) -> Block {
        let along_each = |along: fn(usize) -> Along| {
            let column = |c| O::first(&self.curve(of, along(c), motion));
            Block::beside(&(0..self.of.columns()).map(column).collect::<Vec<_>>())
        };
        match by {
            By::Poses => along_each(Along::Pose),
            By::Twists => along_each(Along::Twist),
            By::Time => O::first(&self.curve(of, Along::Time, motion)),
            By::Motion => O::first(&self.curve(of, Along::Motion, motion)),
            By::MotionTwice => O::second(&self.curve(of, Along::Motion, motion)),
        }
    }

    /// Checks that norms do not change if all bodies move as one rigid body.
    fn rigid_motion(&self) -> Result<(), Failure> {
        if self.case.kind != Kind::Ordinary || !is_internal(self.of) {
            return Ok(());
        }
        let (made, case) = assembled(self.of, &self.case.moved())?;
        let moved = Check {
            of: self.of,
            made: &made,
            case: &case,
        };
        let oracle = Oracle::identity(self.scale());
        S::INVARIANTS.iter().try_for_each(|&(kernel, name)| {
            let norm = |check: &Check<'_, S>| {
                Block::column(vec![check.each(|m| check.at(kernel, m)).norm()])
            };
            let claim = Claim {
                property: Property::RigidMotion,
                oracle,
                found: &norm(&moved),
                expected: &norm(self),
            };
            self.decide(&claim, |_, _| format!("norm of {name}"))
        })
    }

    /// Checks that the generalised forces on all bodies have neither a resultant force nor a
    /// resultant torque.
    pub(crate) fn balance(&self, loads: &[&[f64]], floor: f64) -> Result<(), Failure> {
        let sums = loads.iter().map(|load| resultant::<S>(&self.case.x, load));
        let sums = Block::beside(&sums.collect::<Vec<_>>());
        let none = Block::filled(n_dof::<S>(), loads.len(), 0.0);
        self.claim(Property::Balance, Oracle::identity(floor), &sums, &none)
    }

    /// Returns the change of Φ or Q for a relative error of 1 in the coordinates. The value is also
    /// used for changes of C, because the size of an entry of C is about one length.
    pub(crate) fn scale(&self) -> f64 {
        let slope = self.at(S::SLOPE, &self.case.motions[0]);
        slope.largest().max(1.0) * self.case.size()
    }

    /// Checks that two blocks are equal within the effect of errors in the coordinates.
    pub(crate) fn identity(
        &self,
        property: Property,
        found: &Block,
        expected: &Block,
    ) -> Result<(), Failure> {
        self.claim(property, Oracle::identity(self.scale()), found, expected)
    }

    /// Checks a claim; `property` determines the names of the entries.
    pub(crate) fn claim(
        &self,
        property: Property,
        oracle: Oracle,
        found: &Block,
        expected: &Block,
    ) -> Result<(), Failure> {
        let claim = Claim {
            property,
            oracle,
            found,
            expected,
        };
        self.decide(&claim, |row, column| entry(self.of, property, row, column))
    }

    /// Returns the entry with the largest error if the claim is false; `entry` returns its name.
    pub(crate) fn decide(
        &self,
        claim: &Claim<'_>,
        entry: impl Fn(usize, usize) -> String,
    ) -> Result<(), Failure> {
        claim.decide(self.of.common().name, self.case, entry)
    }

    /// Returns the failure for a fact about this case.
    pub(crate) fn fact(&self, property: Property, entry: String, facts: [f64; 2]) -> Failure {
        let name = self.of.common().name;
        fact(name, property, entry, facts, Some(self.case))
    }
}

/// Returns whether a definition relates bodies to each other, according to its specification.
pub(crate) fn is_internal<S: Subject>(of: S) -> bool {
    let common = of.common();
    let on_ground =
        |p: &joints::spec::Parameter| matches!(p.shape, Shape::GroundLine | Shape::GroundPlane);
    common.slots.len() > 1 && !common.parameters.iter().any(on_ground)
}

/// Returns force and torque about the origin of the ground for a generalised force on all bodies.
fn resultant<S: Subject>(x: &[<S::Space as Space>::Pose<f64>], q: &[f64]) -> Block {
    let mut sum = vec![0.0; n_dof::<S>()];
    for (x, q) in x.iter().zip(q.chunks(n_dof::<S>())) {
        let wrench = S::Space::wrench(x, q, [0.0; 3]);
        sum.iter_mut().zip(wrench).for_each(|(sum, w)| *sum += w);
    }
    Block::column(sum)
}

/// Returns the number of velocity components of a body.
pub(crate) fn n_dof<S: Subject>() -> usize {
    <S::Space as Space>::N_DOF
}

/// Returns a description of an entry of a property. Blocks of several motions are joined column by
/// column.
pub(crate) fn entry<S: Subject>(of: S, property: Property, row: usize, column: usize) -> String {
    let n = of.columns();
    let row_name = |row: usize| match of.rows().get(row) {
        Some(r) => format!("row `{}`", r.name),
        None => format!("motion {row}"),
    };
    let dof = |column: usize| {
        let slots = of.common().slots;
        let slot = slots[column / n_dof::<S>() % slots.len()];
        format!("{slot}.{}", S::Space::DOFS[column % n_dof::<S>()])
    };
    let of_dof = || format!("column {}, motion {}", dof(column), column / n);
    match property {
        Property::DForceDx | Property::DqDx | Property::DqDv => {
            format!("row {}, {}", dof(row), of_dof())
        }
        Property::C | Property::DResidualDx | Property::DGammaDv | Property::DVelocityDx => {
            format!("{}, {}", row_name(row), of_dof())
        }
        Property::B | Property::Velocity | Property::Gamma | Property::GammaFromPhi => {
            format!("{}, motion {column}", row_name(row))
        }
        Property::Wrench => format!("{}, {}", S::Space::COMPONENTS[row], row_name(column)),
        Property::Balance => {
            format!("sum of {}, {}", S::Space::COMPONENTS[row], row_name(column))
        }
        Property::Place => format!("{}, column {}", ["x", "y", "z"][row], dof(column)),
        _ => row_name(row),
    }
}
