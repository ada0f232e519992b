//! States of the moving robot at which all candidates are evaluated, and the expected results.

use std::ops::ControlFlow;

use dynamics::{KeptRowMotion, MotionOptions, PreparedMechanism, simulate};
use linalg::Matrix;
use model::{Registry, System};
use pfaff::{RunOptions, Study};

use crate::Outcome;
use crate::saddle::Saddle;

/// Time between the states (s). The first state is at half of this interval, so that no state is at
/// a break time of the drive. The robot turns at half of the states.
const STEP: f64 = 0.5;

/// The robot and states of its motion.
pub(crate) struct Robot {
    /// The assembled mechanism with its independent rows.
    pub(crate) prepared: PreparedMechanism,
    /// States that satisfy the constraints, over ten seconds.
    pub(crate) states: Vec<State>,
}

/// A state and the expected results.
pub(crate) struct State {
    /// Time (s).
    pub(crate) t: f64,
    /// Coordinates.
    pub(crate) q: Vec<f64>,
    /// Velocities.
    pub(crate) v: Vec<f64>,
    /// Accelerations, computed by the interpreter with the independent rows.
    pub(crate) a: Vec<f64>,
    /// C by rows, then Γ, computed by the generated kernels.
    pub(crate) c_and_gamma: Vec<f64>,
    /// `[M, C_Kᵀ; C_K, 0]` and `[Q; Γ_K]`, assembled.
    pub(crate) saddle: (Vec<f64>, Vec<f64>),
}

impl Robot {
    /// Computes ten seconds of the motion of the robot.
    pub(crate) fn moving() -> Outcome<Self> {
        let case = suite::find("robot-trolley").ok_or("the suite has no robot")?;
        let study = Study::read(
            case.name,
            case.scene,
            &Registry::standard(),
            &RunOptions::default(),
        )?;
        let prepared = study.prepared;
        let options = MotionOptions {
            output_step: 0.5 * STEP,
            ..MotionOptions::to(10.0)
        };
        let mut rows = Vec::new();
        simulate(&prepared, &options, |row| {
            rows.push((row.t, row.q.to_vec(), row.v.to_vec()));
            Ok(ControlFlow::Continue(()))
        })?;
        let mut states = Vec::new();
        let mut motion = KeptRowMotion::new(&prepared)?;
        let mut saddle = Saddle::of_kept_rows(&prepared);
        for (t, q, v) in rows.into_iter().skip(1).step_by(2) {
            let mut a = vec![0.0; v.len()];
            motion.acceleration(t, &q, &v, &mut a)?;
            let (mut matrix, mut load) = (vec![0.0; saddle.n * saddle.n], vec![0.0; saddle.n]);
            saddle.fill(t, &q, &v, &mut matrix, &mut load);
            let c_and_gamma = c_and_gamma(&prepared, t, &q, &v);
            let saddle = (matrix, load);
            states.push(State {
                t,
                q,
                v,
                a,
                c_and_gamma,
                saddle,
            });
        }
        Ok(Self { prepared, states })
    }
}

fn c_and_gamma(prepared: &PreparedMechanism, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
    let mechanism = &prepared.mechanism;
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.c(&mut s);
    mechanism.twist(v, &mut s);
    mechanism.gamma(&mut s);
    let c: Matrix = mechanism.layout().dense(&s);
    let rows = (0..c.nrows()).flat_map(|i| c.row(i).to_vec());
    rows.chain(s.gamma.iter().copied()).collect()
}
