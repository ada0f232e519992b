//! One row of the comparison: what a run costs and how good it is. Times are those of this thread, the least of several runs.

use std::time::Duration;

use cpu_time::ThreadTime;

/// Where rows come from, and with which options.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Series {
    /// The problem.
    pub problem: &'static str,
    /// The crate.
    pub library: &'static str,
    /// Its method.
    pub method: &'static str,
    /// What is done about times at which the right-hand side is not smooth.
    pub breaks: Breaks,
}

/// What is done about times at which the right-hand side is not smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Breaks {
    /// There are none.
    None,
    /// Nothing.
    Ignored,
    /// A step ends there, and the method begins anew.
    Honoured,
}

impl Breaks {
    /// As it stands in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Ignored => "ignored",
            Self::Honoured => "honoured",
        }
    }
}

/// What came out of one run.
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
    /// Where it belongs.
    pub series: Series,
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance.
    pub atol: f64,
    /// Does it.
    pub go: Box<dyn Fn() -> Result<Outcome, String> + 'p>,
}

/// A run with its time.
pub struct Row {
    /// Where it belongs.
    pub series: Series,
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance.
    pub atol: f64,
    /// What came out, or what the library said.
    pub result: Result<Outcome, String>,
    /// Least time (s).
    pub seconds: f64,
}

/// Rounds over all runs, so that a disturbance of some seconds does not spoil all repetitions of a run.
const ROUNDS: usize = 3;

/// Each run is repeated in each round until this has passed …
const ENOUGH: Duration = Duration::from_millis(60);

/// … and at least so often, unless one takes longer than that.
const REPETITIONS: usize = 3;

/// Makes all runs. The first one of each is the warm-up and gives the result.
pub fn measure(runs: &[Run<'_>]) -> Vec<Row> {
    let mut rows: Vec<Row> = runs.iter().map(first).collect();
    for _ in 0..ROUNDS {
        for (run, row) in runs.iter().zip(&mut rows) {
            if row.result.is_ok() {
                row.seconds = row.seconds.min(least_time(run));
            }
        }
    }
    rows
}

fn first(run: &Run<'_>) -> Row {
    Row {
        series: run.series.clone(),
        rtol: run.rtol,
        atol: run.atol,
        result: (run.go)(),
        seconds: f64::INFINITY,
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
