//! Code that is not generated: dense elimination on the independent rows of a mechanism, with a
//! deliberate fault.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use dynamics::{CodeSpec, PreparedMechanism, SceneCode};
use linalg::KeptRowSaddle;
use model::{Mechanism, Scratch, System};

/// The fault of the code, which depends on the time t.
#[derive(Clone, Copy)]
pub(super) enum Fault {
    None,
    /// The health of the code has this value from 4.1 to 4.8 s.
    Health(f64),
    /// Accelerations are NaN from 4.1 to 4.8 s, although the code reports good health.
    NotFinite,
    /// A redundant row has a residual from 4.1 to 4.8 s.
    DroppedRow(usize),
    /// Corrections of the position are too large by this factor from 4.1 to 4.8 s.
    Correction(f64),
    /// Accelerations always have this relative error.
    Acceleration(f64),
    /// Multipliers always have this relative error.
    Multipliers(f64),
}

/// Code for a mechanism by dense elimination on its independent rows.
pub(super) struct Elimination {
    spec: CodeSpec,
    mechanism: Mechanism,
    fault: Fault,
    pub(super) evaluations: AtomicUsize,
    work: Mutex<Work>,
}

struct Work {
    s: Scratch,
    rows: Vec<Vec<f64>>,
    /// A basis of free motions and the pivots at the start, which are compared with later ones.
    frame: Vec<f64>,
    reference: f64,
}

impl Elimination {
    pub(super) fn new(p: &PreparedMechanism, fault: Fault) -> Arc<Self> {
        let layout = p.mechanism.layout();
        let spec = CodeSpec {
            name: "elimination".into(),
            n_q: layout.n_q,
            n_v: layout.n_v,
            m: layout.m,
            h: layout.h,
            kept: p.decision.kept.clone().into(),
            position_kept: p.position_decision.kept.clone().into(),
            break_times: layout.break_times.clone().into(),
            operations: "".into(),
        };
        let code = Self {
            spec,
            fault,
            evaluations: AtomicUsize::new(0),
            work: Mutex::new(Work {
                s: p.mechanism.scratch(),
                rows: Vec::new(),
                frame: Vec::new(),
                reference: 0.0,
            }),
            mechanism: p.mechanism.clone(),
        };
        {
            let mut work = code.work.lock().expect("one thread");
            code.pose(&mut work, 0.0, &p.q);
            let saddle = code.factor(&mut work, &code.spec.kept);
            let mut frame = vec![0.0; (layout.n_v - code.spec.kept.len()) * layout.n_v];
            saddle.null_frame(&mut frame);
            work.frame = frame;
            work.reference = saddle.orientation_of(&work.frame) * saddle.pivot_ratio();
        }
        Arc::new(code)
    }

    fn pose(&self, work: &mut Work, t: f64, q: &[f64]) {
        self.mechanism.pose(t, q, &mut work.s);
        self.mechanism.phi(&mut work.s);
        self.mechanism.c(&mut work.s);
        self.mechanism.b(&mut work.s);
    }

    fn factor(&self, work: &mut Work, kept: &[usize]) -> KeptRowSaddle {
        let n = self.spec.n_v;
        work.rows.resize(kept.len(), Vec::new());
        for (row, &i) in work.rows.iter_mut().zip(kept) {
            row.resize(n, 0.0);
            self.mechanism.layout().scatter_row(&work.s, i, row);
        }
        let mut saddle = KeptRowSaddle::new(n, kept.len()).expect("independent rows");
        saddle
            .factor_above(0.0, |k| &work.rows[k], self.mechanism.mass())
            .expect("masses");
        saddle
    }

    /// Solves on the independent rows; returns x, λ of these rows, and the health.
    fn solve(
        &self,
        work: &mut Work,
        kept: &[usize],
        force: &[f64],
        gamma: &[f64],
    ) -> (Vec<f64>, Vec<f64>, f64) {
        let saddle = &mut self.factor(work, kept);
        let (mut x, mut lambda) = (vec![0.0; force.len()], vec![0.0; kept.len()]);
        saddle
            .solve(force, gamma, &mut x, &mut lambda)
            .expect("factored");
        let health = if *kept == *self.spec.kept {
            saddle.orientation_of(&work.frame) * saddle.pivot_ratio() / work.reference
        } else {
            1.0
        };
        (x, lambda, health)
    }

    fn motion(&self, t: f64, q: &[f64], v: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
        let work = &mut *self.work.lock().expect("one thread");
        self.pose(work, t, q);
        self.mechanism.twist(v, &mut work.s);
        self.mechanism.gamma(&mut work.s);
        self.mechanism.force(&mut work.s);
        let gamma: Vec<f64> = self.spec.kept.iter().map(|&i| work.s.gamma[i]).collect();
        let force = work.s.force.clone();
        let (a, lambda, health) = self.solve(work, &self.spec.kept, &force, &gamma);
        let health = match self.fault {
            Fault::Health(health) if is_faulty(t) => health,
            _ => health,
        };
        (a, lambda, health)
    }
}

/// `orientation` needs mutable storage of the solver, but does not change the results of the
/// solver.
trait OrientationOf {
    fn orientation_of(&self, frame: &[f64]) -> f64;
}

impl OrientationOf for KeptRowSaddle {
    fn orientation_of(&self, frame: &[f64]) -> f64 {
        self.clone().orientation(frame)
    }
}

fn is_faulty(t: f64) -> bool {
    (4.1..4.8).contains(&t)
}

impl SceneCode for Elimination {
    fn spec(&self) -> &CodeSpec {
        &self.spec
    }

    fn acceleration(&self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> f64 {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
        let (found, _, health) = self.motion(t, q, v);
        a.copy_from_slice(&found);
        match self.fault {
            Fault::NotFinite if is_faulty(t) => a[0] = f64::NAN,
            Fault::Acceleration(share) => a.iter_mut().for_each(|a| *a *= 1.0 + share),
            _ => {}
        }
        health
    }

    fn multipliers(&self, t: f64, q: &[f64], v: &[f64], lambda: &mut [f64]) -> f64 {
        let (_, found, health) = self.motion(t, q, v);
        lambda.fill(0.0);
        for (&i, l) in self.spec.kept.iter().zip(found) {
            lambda[i] = l;
        }
        if let Fault::Multipliers(share) = self.fault {
            lambda.iter_mut().for_each(|l| *l *= 1.0 + share);
        }
        health
    }

    fn phi(&self, t: f64, q: &[f64], phi: &mut [f64]) {
        let work = &mut *self.work.lock().expect("one thread");
        self.pose(work, t, q);
        phi.copy_from_slice(&work.s.phi);
    }

    fn velocity_residual(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        let work = &mut *self.work.lock().expect("one thread");
        self.pose(work, t, q);
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.mechanism.layout().velocity_residual(&work.s, i, v);
        }
        match self.fault {
            Fault::DroppedRow(i) if is_faulty(t) => out[i] += 1e-6,
            _ => {}
        }
    }

    fn position_correction(&self, t: f64, q: &[f64], phi: &[f64], dq: &mut [f64]) -> f64 {
        let work = &mut *self.work.lock().expect("one thread");
        self.pose(work, t, q);
        let kept = &*self.spec.position_kept;
        let rhs: Vec<f64> = kept.iter().map(|&i| -phi[i]).collect();
        let (found, _, _) = self.solve(work, kept, &vec![0.0; dq.len()], &rhs);
        dq.copy_from_slice(&found);
        match self.fault {
            Fault::Correction(times) if is_faulty(t) => dq.iter_mut().for_each(|d| *d *= times),
            _ => {}
        }
        1.0
    }

    fn velocity_correction(&self, t: f64, q: &[f64], residual: &[f64], dv: &mut [f64]) -> f64 {
        let work = &mut *self.work.lock().expect("one thread");
        self.pose(work, t, q);
        let rhs: Vec<f64> = self.spec.kept.iter().map(|&i| -residual[i]).collect();
        let (found, _, health) = self.solve(work, &self.spec.kept, &vec![0.0; dv.len()], &rhs);
        dv.copy_from_slice(&found);
        health
    }
}
