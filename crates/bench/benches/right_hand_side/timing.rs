//! Measures the times of candidates. All candidates run in each round, so that changes of the speed
//! of the machine affect all candidates equally. Other processes can only add time. Therefore the
//! least time over the rounds is the time that a candidate needs, and the median shows the time
//! added by other processes.

use std::time::{Duration, Instant};

use crate::candidates::Work;

/// Number of rounds over all candidates.
pub(crate) const ROUNDS: usize = 101;

/// A candidate is repeated in a round until this time has passed.
const ENOUGH: Duration = Duration::from_micros(500);

/// Time of one call.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Time {
    /// Median time over the rounds (s).
    pub(crate) median: f64,
    /// Minimum time over the rounds (s).
    pub(crate) least: f64,
}

/// Measures the times of all candidates. The first round is a warm-up and is not counted.
pub(crate) fn take_turns(works: &mut [Work<'_>]) -> Vec<Time> {
    let mut times = vec![Vec::with_capacity(ROUNDS); works.len()];
    for round in 0..=ROUNDS {
        for (work, times) in works.iter_mut().zip(&mut times) {
            let time = of_a_while(work);
            if round > 0 {
                times.push(time);
            }
        }
    }
    let sorted = times.into_iter().map(|mut times| {
        times.sort_by(f64::total_cmp);
        Time {
            median: times[ROUNDS / 2],
            least: times[0],
        }
    });
    sorted.collect()
}

fn of_a_while(work: &mut Work<'_>) -> f64 {
    let (clock, mut laps) = (Instant::now(), 0);
    loop {
        (work.lap)();
        laps += 1;
        let elapsed = clock.elapsed();
        if elapsed >= ENOUGH {
            return elapsed.as_secs_f64() / (laps * work.calls) as f64;
        }
    }
}
