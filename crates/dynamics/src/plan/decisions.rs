//! The decisions about one component. Each follows from a fact of its mechanism or its options, by
//! the same test that the code uses which carries it out.

use linalg::GRADED_MASSES;
use model::{System, Work};

use super::decided::{Decision, Line};
use super::saving::Cost;
use super::sizes::Sizes;
use super::split::elimination;
use crate::choose;
use crate::error::MotionError;
use crate::motion::KeptRowMotion;
use crate::options::{FORMULATION, Method, MotionOptions};
use crate::prepare::PreparedMechanism;

/// The decisions about one component.
#[derive(Clone, Debug, PartialEq)]
pub struct Decisions {
    /// Its integrator.
    pub method: Decision<Method>,
    /// Whether the integrator needs storage for linear systems; the first step that uses it
    /// allocates it.
    pub linear_systems: Decision<bool>,
    /// Rows and columns of the matrix that is eliminated densely.
    pub elimination: Decision<[usize; 2]>,
    /// Whether solutions are refined from the start on.
    pub refinement: Decision<bool>,
    /// Degrees of freedom; if there are none, the motion is a function of time.
    pub mobility: Decision<usize>,
    /// Rows that exist at velocity level only.
    pub nonholonomic: Decision<usize>,
    /// Dropped rows: monitored, and exchanged for kept ones if these become nearly dependent.
    pub dropped: Decision<usize>,
    /// Rows whose b and Φt are evaluated.
    pub of_time: Decision<usize>,
    /// Entries of C that are evaluated.
    pub entries: Decision<usize>,
    /// Rows whose Γ is evaluated.
    pub gamma: Decision<usize>,
    /// Bodies whose angle changes, so that sine and cosine are evaluated.
    pub turning: Decision<usize>,
    /// Applied forces.
    pub forces: Decision<usize>,
    /// Joints and drives whose reactions are computed at rows of output, among those of the
    /// component.
    pub reactions: Decision<Vec<usize>>,
}

impl Decisions {
    pub(super) fn new(
        prepared: &PreparedMechanism,
        options: &MotionOptions,
        reactions: Vec<usize>,
    ) -> Result<Self, MotionError> {
        let sizes = Sizes::of(prepared);
        let work = Work::of(&prepared.mechanism);
        let method = choose::method(prepared, options)?;
        Ok(Self {
            linear_systems: linear_systems(method.value, &sizes),
            elimination: elimination_of(prepared, &sizes, &work),
            refinement: refinement(prepared)?,
            mobility: mobility(prepared, options, &sizes, &work),
            nonholonomic: nonholonomic(&sizes),
            dropped: dropped(&sizes),
            of_time: of_time(&sizes, &work),
            entries: entries(&work),
            gamma: gamma(&sizes, &work),
            turning: turning(prepared, &work),
            forces: forces(prepared, &work),
            reactions: wanted(prepared, reactions),
            method,
        })
    }

    /// One line for each decision.
    #[must_use]
    pub fn lines(&self) -> Vec<Line<'_>> {
        vec![
            self.method.line("method"),
            self.linear_systems.line("linear systems"),
            self.elimination.line("elimination"),
            self.refinement.line("refinement"),
            self.mobility.line("freedom"),
            self.nonholonomic.line("nonholonomic rows"),
            self.dropped.line("dropped rows"),
            self.of_time.line("rows of time"),
            self.entries.line("varying entries"),
            self.gamma.line("rows of gamma"),
            self.turning.line("turning bodies"),
            self.forces.line("forces"),
            self.reactions.line("reactions"),
        ]
    }
}

fn linear_systems(method: Method, sizes: &Sizes) -> Decision<bool> {
    let (n, w) = (sizes.velocities, 2 * sizes.mobility());
    // Derivatives of [q; v] along each independent entry; the real system, and the complex one as a
    // real one of twice the order.
    let reduced = (2 * w * 2 * n + w * w + 4 * w * w) as u64;
    let (value, taken, why, left_out) = match method {
        Method::Radau5 => (true, "on independent coordinates", "is implicit", 0),
        _ => (false, "none", "is explicit", reduced),
    };
    let reason = format!("{} {why}", method.name());
    Decision::new(value, taken, reason).saving(left_out, reduced, Cost::Storage)
}

fn elimination_of(
    prepared: &PreparedMechanism,
    sizes: &Sizes,
    work: &Work,
) -> Decision<[usize; 2]> {
    let (rows, n, entries) = (sizes.rank, sizes.velocities, work.entries);
    if prepared.is_schur() {
        let reason = format!(
            "{FORMULATION}, {entries} entries of C; many motions are free, and the order of elimination is chosen once"
        );
        return Decision::new([rows, n], format!("Schur complement, {rows} × {n}"), reason);
    }
    let all = elimination(&prepared.mechanism, rows);
    // Cost of eliminating the whole saddle matrix by LU.
    let order = (n + rows) as u64;
    let whole = order * order * order / 3;
    let reason = format!(
        "{FORMULATION}, {entries} entries of C; saved against LU of the whole saddle matrix"
    );
    Decision::new([rows, n], format!("null space, {rows} × {n}"), reason).saving(
        whole.saturating_sub(all),
        whole,
        Cost::Elimination,
    )
}

fn refinement(prepared: &PreparedMechanism) -> Result<Decision<bool>, MotionError> {
    let decided = |value: bool, reason: String| {
        let taken = if value { "in double-double" } else { "none" };
        Ok(Decision::new(value, taken, reason))
    };
    if prepared.is_schur() {
        let why =
            "each solution through the Schur complement is compared with its rows, and corrected";
        return decided(false, why.to_owned());
    }
    let spread = prepared.mass_spread();
    let factor = format!("masses and inertias differ by a factor of {spread:.1e}");
    if spread >= GRADED_MASSES {
        let why = format!("{factor}, from {GRADED_MASSES:.0e} on plain solutions miss digits");
        return decided(true, why);
    }
    let size = prepared.assembly.size;
    if prepared.is_far() {
        let why = "far from a metre: weights and centrifugal terms differ by many powers of ten";
        return decided(true, format!("the mechanism measures {size:.1e} m, {why}"));
    }
    let mut equations = KeptRowMotion::new(prepared)?.equations;
    equations.factor_at(0.0, &prepared.q)?;
    let value = equations.velocity.are_refined();
    let why = if value {
        "but at the start digits cancel in the reduced mass"
    } else {
        "and no digits cancel in the reduced mass at the start; watched at every solution"
    };
    decided(value, format!("{factor}, {why}"))
}

fn mobility(
    prepared: &PreparedMechanism,
    options: &MotionOptions,
    sizes: &Sizes,
    work: &Work,
) -> Decision<usize> {
    let value = sizes.mobility();
    let by_time = prepared.code_for(options).is_err() && prepared.is_function_of_time(options);
    let function = || "a function of time".to_owned();
    let (taken, reason) = match (value, work.rows_of_time) {
        (0, 0) => ("none".to_owned(), "the constraints hold it where it is"),
        (0, _) if by_time => (
            function(),
            "driven, and nothing is free: stages lie on the constraints, and each time of a step is evaluated once",
        ),
        (0, _) => (
            function(),
            "driven, and nothing is free; functions are evaluated once at each time",
        ),
        (n, _) => (format!("{n}"), "velocities less independent rows"),
    };
    Decision::new(value, taken, reason)
}

/// A decision about a number that may be zero, with a reason for either case.
fn counted(value: usize, [none, some]: [&str; 2], what: &str) -> Decision<usize> {
    match value {
        0 => Decision::new(0, "none", none),
        n => Decision::new(n, format!("{n}{what}"), some),
    }
}

fn nonholonomic(sizes: &Sizes) -> Decision<usize> {
    let reasons = [
        "every row has a position level: no projection of velocities alone",
        "rows without position level: projected on velocity level",
    ];
    counted(sizes.nonholonomic, reasons, "")
}

fn dropped(sizes: &Sizes) -> Decision<usize> {
    let reasons = [
        "all rows are independent: no row is monitored or exchanged",
        "implied by the kept ones; not solved for",
    ];
    let decided = counted(sizes.redundancy(), reasons, " monitored");
    let rows = sizes.rows() as u64;
    match decided.value {
        0 => decided.saving(rows, rows, Cost::Monitors),
        _ => decided,
    }
}

fn of_time(sizes: &Sizes, work: &Work) -> Decision<usize> {
    let (value, all) = (work.rows_of_time, sizes.rows() as u64);
    let none = || "b = 0".to_owned();
    let (taken, reason) = match (value, work.functions) {
        (0, 0) => (none(), "nothing depends on time".to_owned()),
        (0, n) => (
            none(),
            format!("no constraint depends on time; functions of forces: {n}"),
        ),
        (rows, n) => (
            format!("b and Φt of {rows}"),
            format!("driven; functions, evaluated once at each time: {n}"),
        ),
    };
    Decision::new(value, taken, reason).saving(all - value as u64, all, Cost::TimeRows)
}

/// A decision on how many of all items are evaluated, with a reason why all are, or why the others
/// are not.
fn evaluated(
    (value, all): (usize, usize),
    why_all: &str,
    others: &str,
    cost: Cost,
) -> Decision<usize> {
    let (left_out, all) = ((all - value) as u64, all as u64);
    let reason = match left_out {
        0 => why_all.to_owned(),
        n => format!("{n} {others}"),
    };
    Decision::new(value, format!("{value} evaluated"), reason).saving(left_out, all, cost)
}

fn entries(work: &Work) -> Decision<usize> {
    let counts = (work.varying_entries, work.entries);
    let all = "all depend on the configuration";
    evaluated(counts, all, "are constant", Cost::Entries)
}

fn gamma(sizes: &Sizes, work: &Work) -> Decision<usize> {
    let counts = (work.rows_of_gamma, sizes.rows());
    let others = "belong to joints with constant C: Γ = 0";
    evaluated(counts, "no joint has constant C", others, Cost::Gamma)
}

fn turning(prepared: &PreparedMechanism, work: &Work) -> Decision<usize> {
    let bodies = prepared.mechanism.bodies();
    let held = &work.without_turning;
    let names: Vec<&str> = held.iter().map(|&k| bodies[k].name.as_str()).collect();
    let (n, all) = (held.len(), bodies.len());
    let reason = match n {
        0 => "no row of angles holds one at its start; sine and cosine are computed again where an angle has changed".to_owned(),
        _ => format!("rows of angles hold {}", names.join(", ")),
    };
    let taken = format!("{} of {all}", all - n);
    Decision::new(all - n, taken, reason).saving(n as u64, all as u64, Cost::Trigonometry)
}

fn forces(prepared: &PreparedMechanism, work: &Work) -> Decision<usize> {
    let weight = prepared.mechanism.weight().iter().any(|w| *w != 0.0);
    let (taken, reason) = match (work.forces, weight) {
        (0, false) => ("Q = 0".to_owned(), "no forces, no gravity"),
        (0, true) => (
            "the weight alone".to_owned(),
            "no applied forces: Q is constant",
        ),
        (n, false) => (format!("{n}"), "no gravity"),
        (n, true) => (format!("{n} and the weight"), "applied forces"),
    };
    Decision::new(work.forces, taken, reason)
}

fn wanted(prepared: &PreparedMechanism, value: Vec<usize>) -> Decision<Vec<usize>> {
    let groups = &prepared.mechanism.layout().groups;
    let (all, n) = (groups.len(), value.len());
    let names: Vec<&str> = value.iter().map(|&k| groups[k].name.as_str()).collect();
    let (taken, reason) = match n {
        0 => (
            "none".to_owned(),
            "none is wanted: no multipliers are solved for at rows of output".to_owned(),
        ),
        n if n == all => (format!("all {n}"), "wanted at rows of output".to_owned()),
        n => (
            format!("{n} of {all}"),
            format!("wanted at rows of output: {}", names.join(", ")),
        ),
    };
    Decision::new(value, taken, reason).saving((all - n) as u64, all as u64, Cost::Reactions)
}
