//! Shows the current progress on a terminal. No progress is shown if standard error is not a
//! terminal.

use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use pfaff::memory::Bytes;
use pfaff::question;

/// Texts of at least this size (bytes) take long to read.
const LONG: usize = 1 << 20;

/// Number of steps of the bar over a whole motion.
const TICKS: f64 = 1000.0;

/// The progress lines on a terminal; the destructor removes them.
#[derive(Default)]
pub(crate) struct Progress {
    all: MultiProgress,
    lines: Mutex<Vec<Line>>,
}

/// A bar, and the quantity that it shows.
struct Line {
    what: &'static str,
    bar: ProgressBar,
}

impl Progress {
    pub(crate) fn show(&self, progress: question::Progress) {
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        match progress {
            question::Progress::Stage(what, bytes) => {
                lines.clear();
                if bytes >= LONG {
                    lines.push(self.stage(what, bytes));
                }
            }
            question::Progress::Count(what, done, of) => {
                let style = "{bar:40} {pos}/{len} {msg}, {per_sec}, {eta} left";
                let bar = self.bar(&mut lines, what, style, (done as u64, of as u64));
                bar.set_message(what);
                bar.set_position(done as u64);
                if done == of {
                    lines.retain(|line| line.what != what);
                }
            }
            question::Progress::Runs(done, of, note) => {
                let style = "{bar:40} {pos}/{len} runs, {per_sec}, {eta} left{msg}";
                let bar = self.bar(&mut lines, "runs", style, (done, of));
                bar.set_position(done);
                bar.set_message(note);
            }
            question::Progress::Writing(_) => {}
            question::Progress::Motion(what, t, t_end) => {
                let style = "{bar:40} {msg}, {eta} left";
                let bar = self.bar(&mut lines, what, style, (0, TICKS as u64));
                if !bar.is_hidden() {
                    bar.set_position((t / t_end * TICKS) as u64);
                    bar.set_message(format!("{what}: t = {t:.3} s"));
                }
            }
        }
    }

    /// Returns the bar for this quantity, and creates it if it does not exist.
    fn bar<'l>(
        &self,
        lines: &'l mut Vec<Line>,
        what: &'static str,
        style: &str,
        (done, of): (u64, u64),
    ) -> &'l ProgressBar {
        let known = lines.iter().position(|line| line.what == what);
        let place = known.unwrap_or_else(|| {
            let bar = self.all.add(ProgressBar::new(of));
            if let Ok(style) = ProgressStyle::with_template(style) {
                bar.set_style(style);
            }
            // The part that an earlier command completed does not count for the speed.
            bar.set_position(done);
            bar.reset_eta();
            lines.push(Line { what, bar });
            lines.len() - 1
        });
        &lines[place].bar
    }

    fn stage(&self, what: &'static str, bytes: usize) -> Line {
        let bar = self.all.add(ProgressBar::new_spinner());
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(format!("{what}: {}", Bytes(bytes as u64)));
        // The bar is updated on a separate thread. Without this thread, the bar does not change.
        if !bar.is_hidden() && thread::Builder::new().spawn(|| ()).is_ok() {
            bar.enable_steady_tick(Duration::from_millis(100));
        }
        Line { what, bar }
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
