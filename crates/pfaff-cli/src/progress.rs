//! What is done at present, on a terminal. Nothing is shown if standard error is none.

use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use pfaff::memory::Bytes;
use pfaff::question;

/// Texts of at least this size (bytes) take long to read.
const LONG: usize = 1 << 20;

/// The present line of a terminal; dropping it removes the line.
#[derive(Default)]
pub(crate) struct Progress(Mutex<Option<Line>>);

/// A bar, and what it counts; a stage counts nothing.
struct Line {
    counts: Option<&'static str>,
    bar: ProgressBar,
}

impl Progress {
    pub(crate) fn show(&self, progress: question::Progress) {
        let mut line = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match progress {
            question::Progress::Stage(what, bytes) => {
                // The one before is removed first.
                *line = None;
                *line = (bytes >= LONG).then(|| Line::stage(what, bytes));
            }
            question::Progress::Count(what, done, of) => {
                let is_counted = |line: &Line| line.counts == Some(what);
                if !line.as_ref().is_some_and(is_counted) {
                    *line = None;
                    *line = Some(Line::count(what, of));
                }
                if let Some(line) = line.as_ref() {
                    line.bar.set_position(done as u64);
                }
            }
        }
    }
}

impl Line {
    fn stage(what: &str, bytes: usize) -> Self {
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(format!("{what}: {}", Bytes(bytes as u64)));
        // The bar ticks on a thread of its own; without one it stands still.
        if !bar.is_hidden() && thread::Builder::new().spawn(|| ()).is_ok() {
            bar.enable_steady_tick(Duration::from_millis(100));
        }
        Self { counts: None, bar }
    }

    fn count(what: &'static str, of: usize) -> Self {
        let bar = ProgressBar::new(of as u64);
        let style = "{bar:40} {pos}/{len} {msg}, {per_sec}, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        bar.set_message(what);
        let counts = Some(what);
        Self { counts, bar }
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
