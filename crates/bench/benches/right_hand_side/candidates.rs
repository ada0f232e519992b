//! The candidates of the comparison. Before its time is measured, each candidate is evaluated at
//! every state of the motion and must return the known result. A new candidate needs one line in
//! [`all`].

use std::hint::black_box;

use dynamics::{KeptRowMotion, SceneCode};
use lab::comparators::equations::Equations;
use lab::comparators::{Drift, MinimumNorm, Proximal, Solver};
use linalg::KeptRowSaddle;
use model::System;
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use robot_trolley::generated::automatic;

use crate::Outcome;
use crate::dual::DualRobot;
use crate::faer_lu::FaerLu;
use crate::nalgebra_lu::{self, N};
use crate::recursive;
use crate::robot::{Robot, State};
use crate::saddle::Saddle;

/// The result of a candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Group {
    /// (t, q, v) → v̇.
    RightHandSide,
    /// The assembled saddle equations → v̇ and λ. The coefficients are not evaluated.
    Solve,
    /// (t, q, v) → C and Γ.
    Matrices,
    /// Ten seconds of motion.
    Run,
}

impl Group {
    /// All groups in the order of the table.
    pub(crate) const ALL: [Self; 4] = [Self::RightHandSide, Self::Solve, Self::Matrices, Self::Run];

    /// The heading of the table.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::RightHandSide => "Right-hand side: (t, q, v) → accelerations of all bodies",
            Self::Solve => "The linear equations alone, already assembled",
            Self::Matrices => "C and Γ alone: (t, q, v) → 22 × 21 matrix and 22 values",
            Self::Run => "Ten seconds of motion, output excluded",
        }
    }
}

/// A measured candidate.
pub(crate) struct Work<'r> {
    /// Name of the candidate in commands and in the CSV file.
    pub(crate) key: &'static str,
    /// Description of the candidate.
    pub(crate) title: String,
    /// The group within which the candidate is compared.
    pub(crate) group: Group,
    /// Number of calls in one round of the measurement.
    pub(crate) calls: usize,
    /// Performs the calls of one lap.
    pub(crate) lap: Box<dyn FnMut() + 'r>,
}

/// Largest allowed difference from the known values, relative to the largest known value at any
/// state. The condition number of the problem is at most 1/σ_r ≈ 25. The bound has a margin for
/// solvers that square the condition number or truncate singular values.
const AGREES: f64 = 1e-10;
/// Singular values below this fraction of the largest singular value count as zero. If all rows are
/// used, the smallest nonzero singular value is 1e-3 times the largest.
const SINGULAR: f64 = 1e-9;

/// Returns the candidates, in the order of the table.
pub(crate) fn all(robot: &Robot) -> Outcome<Vec<Work<'_>>> {
    let list = List {
        robot,
        works: Vec::new(),
    };
    let list = list
        .right_hand_side(
            "by-hand",
            "minimal coordinates, by hand for this robot",
            by_hand(),
        )?
        .right_hand_side("generated", "**code generated for the scene**", generated())?
        .lanes::<4>("generated-4", "generated code, 4 states at once, each")?
        .lanes::<8>("generated-8", "generated code, 8 states at once, each")?
        .right_hand_side("kept-rows", "**kept rows, interpreted**", kept_rows(robot)?)?
        .right_hand_side(
            "dual-numbers",
            "kept rows, C and Γ by dual numbers (num-dual)",
            kept_rows_by_dual_numbers(robot)?,
        )?
        .right_hand_side(
            "minimum-norm",
            "all rows, shortest multipliers",
            all_rows(robot, |_, _, rank| Ok(Box::new(MinimumNorm::new(rank))))?,
        )?
        .right_hand_side(
            "proximal",
            "all rows, proximal iterations",
            all_rows(robot, |c, mass, rank| {
                Ok(Box::new(Proximal::new(c, mass, rank, 0.1 * AGREES)?))
            })?,
        )?
        .right_hand_side(
            "nalgebra",
            "dense saddle LU, nalgebra, 41 × 41 on the stack",
            dense_nalgebra(robot),
        )?
        .right_hand_side(
            "nalgebra-heap",
            "dense saddle LU, nalgebra, 41 × 41 on the heap",
            dense_nalgebra_on_heap(robot),
        )?
        .right_hand_side("faer", "dense saddle LU, faer, in place", dense_faer(robot))?
        .right_hand_side(
            "svd",
            "dense saddle SVD, nalgebra, all rows 43 × 43",
            dense_svd(robot),
        )?
        .solve(
            "solve-kept-rows",
            "**null space of kept rows**",
            solve_kept_rows(robot)?,
        )?
        .solve(
            "solve-nalgebra",
            "LU, nalgebra, on the stack",
            solve_nalgebra(),
        )?
        .solve("solve-faer", "LU, faer, in place", solve_faer())?
        .matrices("kernels", "**generated kernels**", kernels(robot))?
        .matrices(
            "dual-kernels",
            "dual numbers (num-dual)",
            dual_kernels(robot),
        );
    Ok(list?.works)
}

/// Evaluates a candidate at a state and writes the result into the given slice.
type Call<'r> = Box<dyn FnMut(&State, &mut [f64]) -> bool + 'r>;

/// Values at L states. The last index selects the state.
struct Lanes<const L: usize> {
    t: [f64; L],
    q: [[f64; L]; automatic::N_Q],
    v: [[f64; L]; automatic::N_V],
}

impl<const L: usize> Lanes<L> {
    fn of(states: &[State]) -> Self {
        Self {
            t: std::array::from_fn(|l| states[l].t),
            q: std::array::from_fn(|k| std::array::from_fn(|l| states[l].q[k])),
            v: std::array::from_fn(|k| std::array::from_fn(|l| states[l].v[k])),
        }
    }
}

struct List<'r> {
    robot: &'r Robot,
    works: Vec<Work<'r>>,
}

impl<'r> List<'r> {
    fn right_hand_side(self, key: &'static str, title: &str, call: Call<'r>) -> Outcome<Self> {
        self.add(key, title, Group::RightHandSide, call, |state| &state.a)
    }

    fn solve(self, key: &'static str, title: &str, call: Call<'r>) -> Outcome<Self> {
        self.add(key, title, Group::Solve, call, |state| &state.a)
    }

    fn matrices(self, key: &'static str, title: &str, call: Call<'r>) -> Outcome<Self> {
        self.add(key, title, Group::Matrices, call, |state| {
            &state.c_and_gamma
        })
    }

    /// Adds generated code that evaluates L states at the same time. The result is checked at all
    /// states, and each state counts as one call.
    fn lanes<const L: usize>(mut self, key: &'static str, title: &str) -> Outcome<Self> {
        let states = &self.robot.states;
        let size = states
            .iter()
            .flat_map(|s| &s.a)
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        let groups: Vec<Lanes<L>> = states.chunks_exact(L).map(Lanes::of).collect();
        let mut a = [[0.0; L]; automatic::N_V];
        for (group, states) in groups.iter().zip(states.chunks_exact(L)) {
            automatic::acceleration_of(&group.t, &group.q, &group.v, &mut a);
            for (l, state) in states.iter().enumerate() {
                let pairs = state.a.iter().zip(&a);
                let by = pairs.map(|(known, a)| (known - a[l]).abs() / size);
                let by = by.fold(0.0, f64::max);
                let is_finite = a.iter().all(|a| a[l].is_finite());
                if !is_finite || by >= AGREES {
                    return Err(format!("{key} is wrong by {by:.1e} at t = {} s", state.t).into());
                }
            }
        }
        self.works.push(Work {
            key,
            title: title.to_owned(),
            group: Group::RightHandSide,
            calls: L * groups.len(),
            lap: Box::new(move || {
                for group in &groups {
                    let Lanes { t, q, v } = black_box(group);
                    black_box(automatic::acceleration_of(t, q, v, &mut a));
                    black_box(&a);
                }
            }),
        });
        Ok(self)
    }

    /// Checks the candidate at all states and adds it.
    fn add(
        mut self,
        key: &'static str,
        title: &str,
        group: Group,
        mut call: Call<'r>,
        known: fn(&State) -> &[f64],
    ) -> Outcome<Self> {
        let states = &self.robot.states;
        let size = states
            .iter()
            .flat_map(known)
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        let mut out = vec![f64::NAN; known(&states[0]).len()];
        for state in states {
            let done = call(state, &mut out);
            let pairs = known(state).iter().zip(&out);
            let difference = pairs.map(|(a, b)| (a - b).abs() / size).fold(0.0, f64::max);
            let is_finite = out.iter().all(|x| x.is_finite());
            if !(done && is_finite && difference < AGREES) {
                let t = state.t;
                return Err(format!("{key} is wrong by {difference:.1e} at t = {t} s").into());
            }
        }
        self.works.push(Work {
            key,
            title: title.to_owned(),
            group,
            calls: states.len(),
            lap: Box::new(move || {
                for state in states {
                    black_box(call(black_box(state), &mut out));
                    black_box(&out);
                }
            }),
        });
        Ok(self)
    }
}

/// The function is called in the same way as in a run.
fn generated<'r>() -> Call<'r> {
    let code: &dyn SceneCode = &automatic::Code;
    Box::new(move |s, a| code.acceleration(s.t, &s.q, &s.v, a) > 0.0)
}

fn by_hand<'r>() -> Call<'r> {
    Box::new(|s, a| {
        recursive::acceleration(s.t, &s.q, &s.v, a);
        true
    })
}

fn kept_rows(robot: &Robot) -> Outcome<Call<'_>> {
    let mut motion = KeptRowMotion::new(&robot.prepared)?;
    Ok(Box::new(move |s, a| {
        motion.acceleration(s.t, &s.q, &s.v, a).is_ok()
    }))
}

/// A reference method of the crate `lab`, constructed from C, M and the rank at the initial state.
fn all_rows<'r>(
    robot: &'r Robot,
    solver: impl FnOnce(
        &linalg::Matrix,
        &[f64],
        usize,
    ) -> Result<Box<dyn Solver + 'r>, lab::comparators::Fault>,
) -> Outcome<Call<'r>> {
    let (prepared, rank) = (&robot.prepared, robot.prepared.decision.rank);
    let solver = |c: &linalg::Matrix, mass: &[f64]| solver(c, mass, rank);
    let mut equations = Equations::new(prepared, Drift::None, solver)?;
    Ok(Box::new(move |s, a| {
        equations.accelerate(s.t, &s.q, &s.v, a).is_ok()
    }))
}

fn kept_rows_by_dual_numbers(robot: &Robot) -> Outcome<Call<'_>> {
    let mechanism = &robot.prepared.mechanism;
    let (n, rows) = (mechanism.layout().n_v, mechanism.layout().rows());
    let dual = dual_robot(robot);
    let mut both = vec![0.0; rows * (n + 1)];
    let kept = &robot.prepared.decision.kept;
    let mut saddle = KeptRowSaddle::new(n, kept.len())?;
    // Only the constraints act on the robot.
    let force = vec![0.0; n];
    let (mut gamma, mut lambda) = (vec![0.0; kept.len()], vec![0.0; kept.len()]);
    Ok(Box::new(move |s, a| {
        dual.c_and_gamma(s.t, &s.q, &s.v, &mut both);
        for (gamma, &i) in gamma.iter_mut().zip(kept) {
            *gamma = both[rows * n + i];
        }
        let row = |k: usize| &both[kept[k] * n..][..n];
        saddle.factor(row, mechanism.mass()).is_ok()
            && saddle.solve(&force, &gamma, a, &mut lambda).is_ok()
    }))
}

fn dense_nalgebra(robot: &Robot) -> Call<'_> {
    let mut saddle = Saddle::of_kept_rows(&robot.prepared);
    let mut matrix = SMatrix::<f64, N, N>::zeros();
    let mut x = SVector::<f64, N>::zeros();
    Box::new(move |s, a| {
        saddle.fill(s.t, &s.q, &s.v, matrix.as_mut_slice(), x.as_mut_slice());
        let done = nalgebra_lu::solve_static(matrix, &mut x);
        a.copy_from_slice(&x.as_slice()[..a.len()]);
        done
    })
}

fn dense_nalgebra_on_heap(robot: &Robot) -> Call<'_> {
    let mut saddle = Saddle::of_kept_rows(&robot.prepared);
    let mut x = DVector::zeros(saddle.n);
    Box::new(move |s, a| {
        let mut matrix = DMatrix::zeros(saddle.n, saddle.n);
        saddle.fill(s.t, &s.q, &s.v, matrix.as_mut_slice(), x.as_mut_slice());
        let done = nalgebra_lu::solve_dynamic(matrix, &mut x);
        a.copy_from_slice(&x.as_slice()[..a.len()]);
        done
    })
}

fn dense_faer(robot: &Robot) -> Call<'_> {
    let mut saddle = Saddle::of_kept_rows(&robot.prepared);
    let (mut matrix, mut x) = (vec![0.0; saddle.n * saddle.n], vec![0.0; saddle.n]);
    let mut faer = FaerLu::new(saddle.n);
    Box::new(move |s, a| {
        saddle.fill(s.t, &s.q, &s.v, &mut matrix, &mut x);
        faer.solve(&mut matrix, &mut x);
        a.copy_from_slice(&x[..a.len()]);
        true
    })
}

fn dense_svd(robot: &Robot) -> Call<'_> {
    let mut saddle = Saddle::of_all_rows(&robot.prepared);
    let mut load = DVector::zeros(saddle.n);
    Box::new(move |s, a| {
        let mut matrix = DMatrix::zeros(saddle.n, saddle.n);
        saddle.fill(s.t, &s.q, &s.v, matrix.as_mut_slice(), load.as_mut_slice());
        let x = nalgebra_lu::solve_singular(matrix, &load, SINGULAR);
        x.map(|x| a.copy_from_slice(&x.as_slice()[..a.len()]))
            .is_some()
    })
}

/// The rows of C_K come from the assembled matrix of a state. In this matrix, the columns after the
/// mass matrix are C_Kᵀ.
fn solve_kept_rows(robot: &Robot) -> Outcome<Call<'_>> {
    let mass = robot.prepared.mechanism.mass();
    let (n, r) = (mass.len(), robot.prepared.decision.kept.len());
    let mut saddle = KeptRowSaddle::new(n, r)?;
    let mut lambda = vec![0.0; r];
    let order = n + r;
    Ok(Box::new(move |s, a| {
        let (matrix, load) = &s.saddle;
        let row = |k: usize| &matrix[order * (n + k)..][..n];
        saddle.factor(row, mass).is_ok()
            && saddle.solve(&load[..n], &load[n..], a, &mut lambda).is_ok()
    }))
}

fn solve_nalgebra<'r>() -> Call<'r> {
    Box::new(|s, a| {
        let matrix = SMatrix::<f64, N, N>::from_column_slice(&s.saddle.0);
        let mut x = SVector::<f64, N>::from_column_slice(&s.saddle.1);
        let done = nalgebra_lu::solve_static(matrix, &mut x);
        a.copy_from_slice(&x.as_slice()[..a.len()]);
        done
    })
}

fn solve_faer<'r>() -> Call<'r> {
    let mut faer = FaerLu::new(N);
    let (mut matrix, mut x) = (vec![0.0; N * N], vec![0.0; N]);
    Box::new(move |s, a| {
        matrix.copy_from_slice(&s.saddle.0);
        x.copy_from_slice(&s.saddle.1);
        faer.solve(&mut matrix, &mut x);
        a.copy_from_slice(&x[..a.len()]);
        true
    })
}

fn kernels(robot: &Robot) -> Call<'_> {
    let mechanism = &robot.prepared.mechanism;
    let mut s = mechanism.scratch();
    Box::new(move |state, out| {
        mechanism.pose(state.t, &state.q, &mut s);
        mechanism.c(&mut s);
        mechanism.twist(&state.v, &mut s);
        mechanism.gamma(&mut s);
        let layout = mechanism.layout();
        let (c, gamma) = out.split_at_mut(layout.rows() * layout.n_v);
        for (i, row) in c.chunks_exact_mut(layout.n_v).enumerate() {
            layout.scatter_row(&s, i, row);
        }
        gamma.copy_from_slice(&s.gamma);
        true
    })
}

fn dual_kernels(robot: &Robot) -> Call<'_> {
    let dual = dual_robot(robot);
    Box::new(move |s, out| {
        dual.c_and_gamma(s.t, &s.q, &s.v, out);
        true
    })
}

fn dual_robot(robot: &Robot) -> DualRobot {
    DualRobot::new(&robot.prepared.mechanism, tests::robot::steering())
}
