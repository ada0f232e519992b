//! Problems that are found while a file is read. Reading continues after each problem.

use std::cell::{Cell, RefCell};
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::hash::Hash;
use std::ops::Range;

use model::codes::Code;

use crate::diagnostic::{Diagnostic, Severity};
use crate::mistake::Mistake;
use crate::nearest::nearest;
use crate::text::SourceText;

/// Names are suggested for at most this number of problems. If thousands of names are wrong, a
/// comparison of each wrong name with all known names would take minutes.
const SUGGESTIONS: usize = 100;

/// Largest number of names compared for suggestions in one file.
const COMPARED: usize = 1_000_000;

/// Largest number of problems that are listed; further problems are only counted. This number is
/// sufficient even if every line contains the same mistake.
pub(crate) const LISTED: usize = 5000;

/// Largest number of warnings of one kind that are listed; further warnings are only counted.
const WARNED: usize = 10;

/// Largest number of warnings of one kind about a whole scene that are listed.
const ONCE: usize = 1;

/// The problems of a file, in the order of their detection. Tables and fields contain a reference
/// to this list, so that they can report errors.
pub(crate) struct Findings<'s> {
    /// The text to which positions refer.
    pub(crate) source: &'s SourceText,
    lists: RefCell<Lists>,
    compared: Cell<usize>,
}

/// The lists of problems.
#[derive(Default)]
struct Lists {
    problems: Vec<Diagnostic>,
    /// Warnings: the scene is valid, but it is probably not what the author intended.
    warnings: Vec<Diagnostic>,
    /// For each kind of warning, the number of listed warnings and the number of warnings that are
    /// only counted.
    warned: BTreeMap<Code, (usize, usize)>,
    /// Codes of warnings that the user suppresses.
    silenced: Vec<Code>,
    /// Bare numbers that are not in SI units because `units` chooses other units: the start
    /// position of each number, and the size of its unit in SI.
    scales: Vec<(usize, f64)>,
    /// Indices of problems that are only consequences of other problems.
    explained: Vec<usize>,
    /// Number of problems that are not listed.
    more: usize,
}

impl<'s> Findings<'s> {
    pub(crate) fn new(source: &'s SourceText) -> Self {
        Self {
            source,
            lists: RefCell::default(),
            compared: Cell::new(0),
        }
    }

    /// Reports a problem.
    pub(crate) fn report(&self, diagnostic: Diagnostic) {
        if self.is_full() {
            self.count(1);
        } else {
            self.lists.borrow_mut().problems.push(diagnostic);
        }
    }

    /// Returns the index of the next problem, for [`Findings::explain`].
    pub(crate) fn next(&self) -> usize {
        self.lists.borrow().problems.len()
    }

    /// Removes a problem that is only a consequence of another problem, so that one mistake causes
    /// one message.
    pub(crate) fn explain(&self, place: usize) {
        self.lists.borrow_mut().explained.push(place);
    }

    /// Returns whether further problems are only counted; their positions are then unnecessary.
    pub(crate) fn is_full(&self) -> bool {
        self.next() >= LISTED
    }

    /// Counts problems without describing them.
    pub(crate) fn count(&self, more: usize) {
        self.lists.borrow_mut().more += more;
    }

    /// Reports an error with one position.
    pub(crate) fn error(
        &self,
        code: impl Into<Code>,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
    ) {
        if self.is_full() {
            return self.count(1);
        }
        self.report(Diagnostic::error(code, self.source, span, message, label));
    }

    /// Reports an error with one position and with advice.
    pub(crate) fn error_with_help(
        &self,
        code: impl Into<Code>,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<Option<String>>,
    ) {
        if self.is_full() {
            return self.count(1);
        }
        self.report(Diagnostic::error(code, self.source, span, message, label).help(help));
    }

    /// Records that the unit of the bare number at this position has the size `scale` in SI.
    pub(crate) fn scaled(&self, at: usize, scale: f64) {
        self.lists.borrow_mut().scales.push((at, scale));
    }

    /// The recorded units of bare numbers.
    pub(crate) fn take_scales(&self) -> Vec<(usize, f64)> {
        std::mem::take(&mut self.lists.borrow_mut().scales)
    }

    /// Suppresses warnings with this code.
    pub(crate) fn silence(&self, code: Code) {
        self.lists.borrow_mut().silenced.push(code);
    }

    /// The codes of suppressed warnings, after all warnings have been taken.
    pub(crate) fn take_silenced(&self) -> Vec<Code> {
        std::mem::take(&mut self.lists.borrow_mut().silenced)
    }

    /// Adds a warning. A file with warnings is valid. The advice ends with the code that suppresses
    /// the warning. After [`WARNED`] warnings of one kind, further warnings are only counted.
    pub(crate) fn warning(
        &self,
        code: Code,
        span: Range<usize>,
        message: impl Into<String>,
        label: &str,
        help: &str,
    ) {
        self.warn((code, WARNED), span, message, label, help);
    }

    /// Adds a warning of a kind that is listed only once for a scene. Further warnings of this kind
    /// are only counted.
    pub(crate) fn warning_once(
        &self,
        code: Code,
        span: Range<usize>,
        message: impl Into<String>,
        label: &str,
        help: &str,
    ) {
        self.warn((code, ONCE), span, message, label, help);
    }

    /// Adds a warning, if fewer than `most` warnings with this code are listed.
    fn warn(
        &self,
        (code, most): (Code, usize),
        span: Range<usize>,
        message: impl Into<String>,
        label: &str,
        help: &str,
    ) {
        let lists = &mut *self.lists.borrow_mut();
        let (listed, more) = lists.warned.entry(code).or_default();
        if *listed == most {
            *more += 1;
            return;
        }
        *listed += 1;
        let help = format!("{help}; if it is meant, `silence = [\"{code}\"]` in `[scene]`");
        lists.warnings.push(Diagnostic {
            severity: Severity::Warning,
            ..Diagnostic::error(code, self.source, span, message, label).help(help)
        });
    }

    /// Returns the warnings in the order of the file. The last listed warning of a kind contains
    /// the number of warnings that are not listed.
    pub(crate) fn take_warnings(&self) -> Vec<Diagnostic> {
        let lists = &mut *self.lists.borrow_mut();
        let mut warnings = std::mem::take(&mut lists.warnings);
        warnings.retain(|d| !lists.silenced.contains(&d.code));
        warnings.sort_by_key(|d| d.primary.span.start);
        for (code, (_, more)) in std::mem::take(&mut lists.warned) {
            let of_kind = warnings.iter_mut().rfind(|d| d.code == code);
            if let Some(last) = of_kind.filter(|_| more > 0) {
                last.message = format!("{} (and {more} more like this)", last.message);
            }
        }
        warnings
    }

    /// Reports an error, with the position of the conflicting item.
    pub(crate) fn collision(
        &self,
        code: impl Into<Code>,
        span: Range<usize>,
        message: impl Into<String>,
        label: &str,
        first: Range<usize>,
        first_label: &str,
    ) {
        if self.is_full() {
            return self.count(1);
        }
        let first = self.source.label(first, first_label);
        self.report(Diagnostic::error(code, self.source, span, message, label).and(first));
    }

    /// Returns whether this is the first use of a name or entry that may occur only once; otherwise
    /// reports both positions.
    pub(crate) fn is_first<T: Eq + Hash>(
        &self,
        named: &mut HashMap<T, Range<usize>>,
        thing: T,
        span: Range<usize>,
        twice: impl Into<String>,
    ) -> bool {
        match named.entry(thing) {
            Entry::Occupied(first) => {
                let first = first.get().clone();
                let label = "named again here";
                self.collision(
                    Mistake::Twice,
                    span,
                    twice,
                    label,
                    first,
                    "first named here",
                );
                false
            }
            Entry::Vacant(place) => {
                place.insert(span);
                true
            }
        }
    }

    /// Returns the known name that was probably intended. Returns a name only if there are few
    /// problems and few names.
    pub(crate) fn suggest<'a>(
        &self,
        name: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Option<&'a str> {
        let compared = self.compared.get();
        if self.next() >= SUGGESTIONS || compared >= COMPARED {
            return None;
        }
        let mut n = 0;
        let found = nearest(name, known.into_iter().inspect(|_| n += 1));
        self.compared.set(compared + n);
        found
    }

    /// Returns the line of an offset, for messages that refer to another position.
    pub(crate) fn line(&self, offset: usize) -> usize {
        self.source.line(offset)
    }

    /// Returns all problems in the order of the file without repetitions. If there are too many
    /// problems, the last entry states how many are not listed.
    pub(crate) fn sorted(self) -> Vec<Diagnostic> {
        let Lists {
            mut problems,
            mut explained,
            more,
            ..
        } = self.lists.into_inner();
        explained.sort_unstable();
        let mut place = 0;
        problems.retain(|_| {
            place += 1;
            explained.binary_search(&(place - 1)).is_err()
        });
        problems.sort_by_key(|d| d.primary.span.start);
        let mut unique: Vec<Diagnostic> = Vec::with_capacity(problems.len());
        for diagnostic in problems {
            let start = diagnostic.primary.span.start;
            let mut here = unique
                .iter()
                .rev()
                .take_while(|d| d.primary.span.start == start);
            if here.all(|d| *d != diagnostic) {
                unique.push(diagnostic);
            }
        }
        if more > 0 {
            let place = unique.last().map_or(0..0, |last| last.primary.span.clone());
            let message = format!("and {more} more problems: only the first {LISTED} are listed");
            let label = "the last one of the list";
            unique.push(Diagnostic {
                severity: Severity::Note,
                ..Diagnostic::error(Mistake::More, self.source, place, message, label)
            });
        }
        unique
    }
}
