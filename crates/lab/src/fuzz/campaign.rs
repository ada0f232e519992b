//! Tests many inputs, several at the same time. A text that fails is shortened and stored in a
//! file.

use clap::ValueEnum;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::fuzz::scenes::Space;
use crate::fuzz::trial::Reach;
use crate::fuzz::watch::{Fault, Limits, Worker, one};
use crate::fuzz::{input, minimise};

/// Number of inputs that one process tests.
const CHUNK: u64 = 2000;

/// Time limit for shortening one text. If a text causes an endless loop, each trial takes as long
/// as the time limit of a trial.
const SHORTEN: Duration = Duration::from_secs(20);

/// A set of inputs to test.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// The space of all inputs.
    pub space: Space,
    /// Seed of all inputs.
    pub seed: u64,
    /// The first input.
    pub from: u64,
    /// Number of inputs.
    pub inputs: u64,
    /// Number of processes at the same time.
    pub threads: usize,
    /// Settings and limits of the processes.
    pub limits: Limits,
    /// Directory for texts that fail.
    pub found: PathBuf,
}

/// The results of a campaign.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Number of texts by the last stage that they reached.
    pub reached: BTreeMap<Reach, u64>,
    /// Failures by their location in the program.
    pub faults: BTreeMap<String, Found>,
}

/// The failures at one location in the program.
#[derive(Clone, Debug)]
pub struct Found {
    /// Number of failures.
    pub count: u64,
    /// The number of the first input.
    pub first: u64,
    /// The failure.
    pub fault: Fault,
    /// The file with the shortest text that causes the failure.
    pub file: PathBuf,
}

impl Campaign {
    /// Tests all inputs. `progress` is called from time to time with the number of finished inputs.
    ///
    /// # Errors
    /// Returns an error if processes cannot be started, or texts cannot be stored.
    pub fn run(&self, progress: impl Fn(u64) + Sync) -> io::Result<Tally> {
        let next = AtomicU64::new(0);
        let tally = Mutex::new(Tally::default());
        let work = || -> io::Result<()> {
            loop {
                let at = next.fetch_add(CHUNK, Ordering::Relaxed);
                if at >= self.inputs {
                    return Ok(());
                }
                let to = (at + CHUNK).min(self.inputs);
                self.stretch(self.from + at, self.from + to, &tally)?;
                progress(to);
            }
        };
        thread::scope(|scope| {
            let threads: Vec<_> = (0..self.threads.max(1))
                .map(|_| scope.spawn(work))
                .collect();
            let ends = threads.into_iter().map(|t| {
                t.join()
                    .unwrap_or_else(|_| Err(io::Error::other("a thread of the campaign panicked")))
            });
            ends.collect::<io::Result<()>>()
        })?;
        Ok(tally.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// Tests a range of inputs. A new process is started after each failure.
    fn stretch(&self, from: u64, to: u64, tally: &Mutex<Tally>) -> io::Result<()> {
        let mut at = from;
        while at < to {
            let space = self.space.to_possible_value();
            let space = space.as_ref().map_or("", |value| value.get_name());
            let numbers = [self.seed, at, to].map(|n| n.to_string());
            let mut worker = Worker::begin(
                &self.limits,
                &[
                    "work",
                    "--suite",
                    space,
                    &numbers[0],
                    &numbers[1],
                    &numbers[2],
                ],
                None,
            )?;
            while at < to {
                let answer = worker.answer(self.limits.deadline);
                at += 1;
                match answer {
                    Ok(reach) => {
                        let mut tally = tally.lock().unwrap_or_else(PoisonError::into_inner);
                        *tally.reached.entry(reach).or_default() += 1;
                    }
                    Err(fault) => {
                        self.note(at - 1, fault, tally)?;
                        break;
                    }
                }
            }
            worker.end();
        }
        Ok(())
    }

    /// Counts a failure. For the first failure at each location, a shortened text is stored.
    fn note(&self, number: u64, fault: Fault, tally: &Mutex<Tally>) -> io::Result<()> {
        let place = fault.place().to_owned();
        {
            let mut tally = tally.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(found) = tally.faults.get_mut(&place) {
                found.count += 1;
                return Ok(());
            }
            let file = self.found.join(format!("{}-{number}.toml", self.seed));
            tally.faults.insert(
                place.clone(),
                Found {
                    count: 1,
                    first: number,
                    fault: fault.clone(),
                    file,
                },
            );
        }
        let text = input::text(self.space, self.seed, number);
        let clock = Instant::now();
        let fails = |text: &str| {
            clock.elapsed() < SHORTEN
                && one(&self.limits, text)
                    .is_ok_and(|answer| answer.is_err_and(|f| f.place() == place))
        };
        let (text, note) = if fails(&text) {
            (minimise::shortest(&text, fails), "")
        } else {
            (text, "# Does not fail again by itself.\n")
        };
        let words = match &fault {
            Fault::Died { words, .. } => words.replace('\n', "\n# "),
            Fault::Hung { place } => place.clone(),
        };
        fs::create_dir_all(&self.found)?;
        let file = self.found.join(format!("{}-{number}.toml", self.seed));
        fs::write(
            file,
            format!(
                "# Input {number} of seed {}:\n# {words}\n{note}{text}",
                self.seed
            ),
        )
    }
}
