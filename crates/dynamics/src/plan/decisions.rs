//! The decisions for one component. Each decision is based on a fact of the mechanism or of the
//! options. The code that executes the plan uses the same test.

use linalg::GRADED_MASSES;
use model::words::{estimate, rough};
use model::{System, Work};

use super::decided::{Decision, Line};
use super::saving::Cost;
use super::sizes::Sizes;
use super::split::elimination;
use crate::choose;
use crate::error::MotionError;
use crate::motion::KeptRowMotion;
use crate::options::{INDEPENDENT_ROWS, Method, MotionOptions};
use crate::prepare::PreparedMechanism;

/// The decisions for one component.
#[derive(Clone, Debug, PartialEq)]
pub struct Decisions {
    /// Integration method.
    pub method: Decision<Method>,
    /// Whether the integrator needs memory for linear systems. The memory is allocated by the first
    /// step that uses it.
    pub linear_systems: Decision<bool>,
    /// Number of rows and columns of the matrix that is eliminated densely.
    pub elimination: Decision<[usize; 2]>,
    /// Whether solutions are refined from the start on.
    pub refinement: Decision<bool>,
    /// Degrees of freedom. The motion of a mechanism without degrees of freedom is a function of
    /// time.
    pub mobility: Decision<usize>,
    /// Rows that exist only at velocity level.
    pub nonholonomic: Decision<usize>,
    /// Redundant rows. Redundant rows are monitored, and exchanged for independent rows if the
    /// independent rows become ill-conditioned.
    pub dropped: Decision<usize>,
    /// Rows whose b and Φt are evaluated.
    pub of_time: Decision<usize>,
    /// Entries of C that are evaluated.
    pub entries: Decision<usize>,
    /// Rows whose Γ is evaluated.
    pub gamma: Decision<usize>,
    /// Bodies whose angle changes. For these bodies, sine and cosine are evaluated.
    pub turning: Decision<usize>,
    /// Applied forces.
    pub forces: Decision<usize>,
    /// Joints and drives of the component whose reactions are computed at output rows.
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
        let is_schur = prepared.is_schur(method.value);
        Ok(Self {
            linear_systems: linear_systems(method.value, &sizes),
            elimination: elimination_of(prepared, is_schur, &sizes, &work),
            refinement: refinement(prepared, is_schur)?,
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

    /// Returns one line for each decision.
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
    // The stored values are the derivatives of [q; v] with respect to each independent entry, the
    // matrix of the real system, and the matrix of the complex system. The complex matrix is
    // written as a real matrix of twice the order.
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
    is_schur: bool,
    sizes: &Sizes,
    work: &Work,
) -> Decision<[usize; 2]> {
    let (rows, n, entries) = (sizes.rank, sizes.velocities, work.entries);
    if is_schur {
        let reason = format!(
            "{INDEPENDENT_ROWS}, {entries} entries of C; many motions are free, and the order of elimination is chosen once"
        );
        return Decision::new([rows, n], format!("Schur complement, {rows} × {n}"), reason);
    }
    let all = elimination(&prepared.mechanism, rows);
    // Cost of eliminating the whole saddle matrix by LU.
    let order = (n + rows) as u64;
    let whole = order * order * order / 3;
    let reason = format!(
        "{INDEPENDENT_ROWS}, {entries} entries of C; saved compared with an LU factorisation of the whole saddle matrix"
    );
    Decision::new([rows, n], format!("null space, {rows} × {n}"), reason).saving(
        whole.saturating_sub(all),
        whole,
        Cost::Elimination,
    )
}

fn refinement(prepared: &PreparedMechanism, is_schur: bool) -> Result<Decision<bool>, MotionError> {
    let decided = |value: bool, reason: String| {
        let taken = if value { "in double-double" } else { "none" };
        Ok(Decision::new(value, taken, reason))
    };
    if is_schur {
        let why = "each solution by the Schur complement is checked against its rows and corrected";
        return decided(false, why.to_owned());
    }
    let spread = prepared.mass_spread();
    let factor = format!(
        "masses and inertias differ by a factor of {spread}",
        spread = rough(spread)
    );
    if spread >= GRADED_MASSES {
        let why = format!("{factor}; above {GRADED_MASSES:.0e} unrefined solutions lose digits");
        return decided(true, why);
    }
    let size = prepared.assembly.size;
    if prepared.is_far() {
        let why = "the size is far from 1 m, so weights and centrifugal terms differ by many powers of ten";
        return decided(
            true,
            format!(
                "the mechanism measures {size}, {why}",
                size = estimate(size, "m")
            ),
        );
    }
    let mut equations = KeptRowMotion::new(prepared)?.equations;
    equations.factor_at(prepared.start_time(), &prepared.q)?;
    let value = equations.velocity.are_refined();
    let why = if value {
        "but digits cancel in the reduced mass at the start"
    } else {
        "and no digits cancel in the reduced mass at the start; monitored at every solution"
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
        (0, 0) => ("none".to_owned(), "the constraints allow no motion"),
        (0, _) if by_time => (
            function(),
            "driven, without free motions: all stages satisfy the constraints, and each time of a step is evaluated once",
        ),
        (0, _) => (
            function(),
            "driven, without free motions; functions are evaluated once at each time",
        ),
        (n, _) => (format!("{n}"), "velocities minus independent rows"),
    };
    Decision::new(value, taken, reason)
}

/// Returns a decision about a count. There is one reason for zero and one reason for a positive
/// count.
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
        "implied by the independent rows, so they are not solved",
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
        (0, 0) => (none(), "no function of time".to_owned()),
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

/// Returns a decision on the number of items that are evaluated. The reason states why all items
/// are evaluated, or why some items are not evaluated.
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
    let others = "their joints have constant C, so Γ = 0";
    evaluated(counts, "no joint has constant C", others, Cost::Gamma)
}

fn turning(prepared: &PreparedMechanism, work: &Work) -> Decision<usize> {
    let bodies = prepared.mechanism.bodies();
    let held = &work.without_turning;
    let names: Vec<&str> = held.iter().map(|&k| bodies[k].name.as_str()).collect();
    let (n, all) = (held.len(), bodies.len());
    let reason = match n {
        0 => "no constraint fixes an angle; sines and cosines are recomputed when an angle changes"
            .to_owned(),
        _ => format!("constraints fix the angles of {}", names.join(", ")),
    };
    let taken = format!("{} of {all}", all - n);
    Decision::new(all - n, taken, reason).saving(n as u64, all as u64, Cost::Trigonometry)
}

fn forces(prepared: &PreparedMechanism, work: &Work) -> Decision<usize> {
    let weight = prepared.mechanism.weight().iter().any(|w| *w != 0.0);
    let (taken, reason) = match (work.forces, weight) {
        (0, false) => ("Q = 0".to_owned(), "no forces, no gravity"),
        (0, true) => ("only weight".to_owned(), "no applied forces: Q is constant"),
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
            "not requested: no multipliers are computed for output rows".to_owned(),
        ),
        n if n == all => (format!("all {n}"), "requested at output rows".to_owned()),
        n => (
            format!("{n} of {all}"),
            format!("requested at output rows: {}", names.join(", ")),
        ),
    };
    Decision::new(value, taken, reason).saving((all - n) as u64, all as u64, Cost::Reactions)
}
