//! Several runs on one thread, with a combined evaluation of their code. Each run is a coroutine
//! that waits whenever it needs a function of its code. When all runs wait, the function that most
//! runs need is evaluated for a number of runs that fills whole SIMD batches. Each run has its own
//! steps, projections and events. Its results are bitwise equal to the results of the run alone.
//!
//! We rejected three alternatives: a separate loop for several runs; threads in place of
//! coroutines, because a switch of threads costs more than an evaluation; and code that is compiled
//! at run time, because it needs `unsafe`.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use corosensei::stack::DefaultStack;
use corosensei::{Coroutine, CoroutineResult, Yielder};
use dynamics::code::{CodeFunction, CodeSpec};
use dynamics::{SceneCode, Stop};
use scene_codegen::{LANES, Tape, TapeCall};

use super::SweepError;
use super::job::Job;
use super::run::MadeRun;

/// Size of the stack of a run (bytes). Only the used part of the stack needs memory.
const STACK: usize = 2 << 20;

/// Result of a run: `None` if it was interrupted.
type Outcome = Result<Option<MadeRun>, SweepError>;

/// The function that a waiting run needs next.
struct Wait {
    function: CodeFunction,
    call: Box<TapeCall>,
}

type Lane = Coroutine<Option<Box<TapeCall>>, Wait, Outcome, DefaultStack>;

/// Performs the runs and passes on each result as soon as the result is available.
pub(super) fn together(
    jobs: Vec<Job>,
    interrupted: &Stop<'_>,
    done: &mut dyn FnMut(u64, Outcome) -> Result<(), SweepError>,
) -> Result<(), SweepError> {
    let stopped = Arc::new(AtomicBool::new(false));
    let mut waiting: [Vec<(u64, Lane)>; CodeFunction::ALL.len()] = Default::default();
    let mut calls: [Vec<Box<TapeCall>>; CodeFunction::ALL.len()] = Default::default();
    let together = jobs.len() > 1;
    for job in jobs {
        let run = job.run;
        let stack = together.then(|| DefaultStack::new(STACK).ok()).flatten();
        let (Some(stack), Some(tape)) = (stack, job.begun.code.clone()) else {
            done(run, job.go(None, interrupted))?;
            continue;
        };
        let stopped = Arc::clone(&stopped);
        // The initial data of a coroutine must be small.
        let job = Box::new(job);
        let mut lane = Lane::with_stack(stack, move |yielder, _| {
            let waits = Waits {
                spec: tape.clone(),
                call: RefCell::new(Some(Box::new(TapeCall::new(tape)))),
                yielder,
            };
            job.go(Some(&waits), &|| stopped.load(Ordering::Relaxed))
        });
        match lane.resume(None) {
            CoroutineResult::Yield(Wait { function, call }) => {
                waiting[function.index()].push((run, lane));
                calls[function.index()].push(call);
            }
            CoroutineResult::Return(outcome) => done(run, outcome)?,
        }
    }
    let (mut lanes, mut answers) = (Vec::new(), Vec::new());
    loop {
        if interrupted() {
            stopped.store(true, Ordering::Relaxed);
        }
        let needed = CodeFunction::ALL
            .iter()
            .max_by_key(|f| calls[f.index()].len());
        let Some(&function) = needed.filter(|f| !calls[f.index()].is_empty()) else {
            return Ok(());
        };
        // If other runs can continue, runs that would leave a SIMD batch incomplete wait for more
        // runs.
        let count = calls[function.index()].len();
        let count = if count < LANES {
            count
        } else {
            count - count % LANES
        };
        lanes.extend(waiting[function.index()].drain(..count));
        answers.extend(calls[function.index()].drain(..count));
        Tape::evaluate_all(function, &mut answers);
        for ((run, mut lane), answer) in lanes.drain(..).zip(answers.drain(..)) {
            match lane.resume(Some(answer)) {
                CoroutineResult::Yield(Wait { function, call }) => {
                    waiting[function.index()].push((run, lane));
                    calls[function.index()].push(call);
                }
                CoroutineResult::Return(outcome) => done(run, outcome)?,
            }
        }
    }
}

/// The code of a run. The run waits until a function is evaluated.
struct Waits<'y> {
    spec: Tape,
    /// Storage for arguments and results. It is empty during an evaluation.
    call: RefCell<Option<Box<TapeCall>>>,
    yielder: &'y Yielder<Option<Box<TapeCall>>, Wait>,
}

impl Waits<'_> {
    fn evaluate(
        &self,
        function: CodeFunction,
        t: f64,
        (q, with): (&[f64], &[f64]),
        out: &mut [f64],
    ) -> f64 {
        let Some(mut call) = self.call.take() else {
            return f64::NAN;
        };
        call.set(t, q, with, out.len());
        let answer = self.yielder.suspend(Wait { function, call });
        let health = answer.as_ref().map_or(f64::NAN, |call| {
            out.copy_from_slice(&call.out);
            call.health
        });
        self.call.replace(answer);
        health
    }
}

impl SceneCode for Waits<'_> {
    fn spec(&self) -> &CodeSpec {
        self.spec.spec()
    }

    fn acceleration(&self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> f64 {
        self.evaluate(CodeFunction::Acceleration, t, (q, v), a)
    }

    fn multipliers(&self, t: f64, q: &[f64], v: &[f64], lambda: &mut [f64]) -> f64 {
        self.evaluate(CodeFunction::Multipliers, t, (q, v), lambda)
    }

    fn phi(&self, t: f64, q: &[f64], phi: &mut [f64]) {
        self.evaluate(CodeFunction::Phi, t, (q, &[]), phi);
    }

    fn velocity_residual(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.evaluate(CodeFunction::VelocityResidual, t, (q, v), out);
    }

    fn position_correction(&self, t: f64, q: &[f64], phi: &[f64], dq: &mut [f64]) -> f64 {
        self.evaluate(CodeFunction::PositionCorrection, t, (q, phi), dq)
    }

    fn velocity_correction(&self, t: f64, q: &[f64], residual: &[f64], dv: &mut [f64]) -> f64 {
        self.evaluate(CodeFunction::VelocityCorrection, t, (q, residual), dv)
    }
}
