//! Problems found on the way. Reading goes on after each of them.

use std::ops::Range;

use crate::diagnostic::Diagnostic;
use crate::nearest::nearest;
use crate::text::SourceText;

/// Problems that come with suggested names. Comparing every unknown name with all known ones would take minutes where
/// thousands are wrong.
const SUGGESTIONS: usize = 100;

/// The problems of a file, as they are found.
pub(crate) struct Findings<'s> {
    /// Where they are.
    pub(crate) source: &'s SourceText,
    list: Vec<Diagnostic>,
}

impl<'s> Findings<'s> {
    pub(crate) fn new(source: &'s SourceText) -> Self {
        Self {
            source,
            list: Vec::new(),
        }
    }

    /// Reports a problem.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.list.push(diagnostic);
    }

    /// Reports an error with one place.
    pub(crate) fn error(
        &mut self,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
    ) {
        self.report(Diagnostic::error(self.source, span, message, label));
    }

    /// Reports an error with one place and advice.
    pub(crate) fn error_with_help(
        &mut self,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<Option<String>>,
    ) {
        self.report(Diagnostic::error(self.source, span, message, label).help(help));
    }

    /// Reports an error and the place of the thing it collides with.
    pub(crate) fn collision(
        &mut self,
        span: Range<usize>,
        message: impl Into<String>,
        label: &str,
        first: Range<usize>,
        first_label: &str,
    ) {
        let first = self.source.label(first, first_label);
        self.report(Diagnostic::error(self.source, span, message, label).and(first));
    }

    /// The known name that was probably meant, as long as there are few problems.
    pub(crate) fn suggest<'a>(
        &self,
        name: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Option<&'a str> {
        match self.list.len() < SUGGESTIONS {
            true => nearest(name, known),
            false => None,
        }
    }

    /// The line of an offset, for texts that refer to another place.
    pub(crate) fn line(&self, offset: usize) -> usize {
        self.source.position(offset).0
    }

    /// All problems in the order of the file, each once.
    pub(crate) fn sorted(mut self) -> Vec<Diagnostic> {
        self.list.sort_by_key(|d| d.primary.span.start);
        let mut unique: Vec<Diagnostic> = Vec::with_capacity(self.list.len());
        for diagnostic in self.list {
            let start = diagnostic.primary.span.start;
            let mut here = unique
                .iter()
                .rev()
                .take_while(|d| d.primary.span.start == start);
            if here.all(|d| *d != diagnostic) {
                unique.push(diagnostic);
            }
        }
        unique
    }
}
