//! One row of the comparison, with the cost and error of a run. Times are those of this thread.

use std::time::Duration;

use cpu_time::ThreadTime;

/// The origin of rows, with their options.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Series {
    /// The problem.
    pub problem: &'static str,
    /// The crate.
    pub library: &'static str,
    /// Its method.
    pub method: &'static str,
    /// How the run treats times at which the right-hand side is not smooth.
    pub breaks: Breaks,
}

/// The treatment of times at which the right-hand side is not smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Breaks {
    /// There are no such times.
    None,
    /// They are ignored.
    Ignored,
    /// A step ends there, and the method restarts.
    Honoured,
}

impl Breaks {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Ignored => "ignored",
            Self::Honoured => "honoured",
        }
    }
}

/// The result of one run.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// Error at the end, as the problem measures it.
    pub error: f64,
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// Accepted steps.
    pub steps: u64,
}

/// A run that can be repeated.
pub struct Run<'p> {
    /// The series that it belongs to.
    pub series: Series,
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance.
    pub atol: f64,
    /// Makes the run.
    pub go: Box<dyn Fn() -> Result<Outcome, String> + 'p>,
}

/// A run with its time.
pub struct Row {
    /// The series that it belongs to.
    pub series: Series,
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance.
    pub atol: f64,
    /// The result, or the error of the library.
    pub result: Result<Outcome, String>,
    /// Time (s), NaN if there is no result.
    pub seconds: f64,
}

/// A result with this relative error, or this error in metres and radians, is wrong.
const WRONG: f64 = 1.0;

impl Row {
    /// The result, if it is not wrong.
    pub fn good(&self) -> Option<&Outcome> {
        self.result.as_ref().ok().filter(|r| r.error < WRONG)
    }

    /// The reason why there is no result.
    pub fn trouble(&self) -> Option<String> {
        match &self.result {
            Err(text) => Some(format!("failed: {text}")),
            Ok(r) if r.error >= WRONG => Some(format!(
                "no answer, and no notice of it: error {:.1e}",
                r.error
            )),
            Ok(_) => None,
        }
    }
}

/// Number of rounds over all runs, so that a disturbance of some seconds does not affect all
/// repetitions of a run.
const ROUNDS: usize = 9;

/// Each run is repeated in each round for at least this time …
const ENOUGH: Duration = Duration::from_millis(20);

/// … and at least this number of times, unless one takes longer than that.
const REPETITIONS: usize = 3;

/// Makes all runs. The first one of each is the warm-up and gives the result.
///
/// The shortest time of a round is not affected by interruptions. The median over the rounds is a
/// time at the usual speed of the processor, while the shortest time over all rounds would favour
/// runs that happened at a moment of higher clock speed.
pub fn measure(runs: &[Run<'_>]) -> Vec<Row> {
    let mut rows: Vec<Row> = runs.iter().map(first).collect();
    let mut times = vec![Vec::with_capacity(ROUNDS); runs.len()];
    for _ in 0..ROUNDS {
        for ((run, row), times) in runs.iter().zip(&rows).zip(&mut times) {
            if row.result.is_ok() {
                times.push(least_time(run));
            }
        }
    }
    for (row, times) in rows.iter_mut().zip(&mut times) {
        times.sort_by(f64::total_cmp);
        row.seconds = times.get(times.len() / 2).copied().unwrap_or(f64::NAN);
    }
    rows
}

fn first(run: &Run<'_>) -> Row {
    Row {
        series: run.series.clone(),
        rtol: run.rtol,
        atol: run.atol,
        result: (run.go)(),
        seconds: f64::NAN,
    }
}

fn least_time(run: &Run<'_>) -> f64 {
    let (mut least, mut sum) = (Duration::MAX, Duration::ZERO);
    for i in 0.. {
        if sum >= ENOUGH && (i >= REPETITIONS || least >= ENOUGH) {
            break;
        }
        let clock = ThreadTime::now();
        let done = (run.go)();
        let time = clock.elapsed();
        std::hint::black_box(&done);
        least = least.min(time);
        sum += time;
    }
    least.as_secs_f64()
}
