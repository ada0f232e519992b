//! Numbers and names of random scenes.

use crate::numbers::Numbers;

use crate::fuzz::damage::EXTREMES;

/// Names that a writer might confuse with another syntax.
const NAMES: [&str; 12] = [
    "a,b",
    "a b",
    "a.b",
    "=1+2",
    "+A1",
    "-x",
    "@sum",
    "é𝛗",
    "x.N + y.N",
    "\\\"q\\\"",
    "two\\nlines",
    "ground ",
];

/// A stream of numbers and names; the parameter `wild` sets how often extreme ones occur.
pub(crate) struct Values<'n> {
    pub(crate) numbers: &'n mut Numbers,
    /// One number out of this many is extreme; none if it is 0.
    wild: usize,
    /// Unit of length (m).
    length: f64,
    has_names: bool,
}

impl<'n> Values<'n> {
    pub(crate) fn new(numbers: &'n mut Numbers) -> Self {
        Self {
            wild: match numbers.below(3) {
                0 => 30,
                1 => 200,
                _ => 0,
            },
            length: match numbers.below(20) {
                0 => 1e-6,
                1 => 1e6,
                2 => 10.0_f64.powi(numbers.between(-12, 12)),
                _ => 1.0,
            },
            has_names: numbers.once_in(25),
            numbers,
        }
    }

    fn or_extreme(&mut self, value: f64) -> String {
        if self.wild > 0 && self.numbers.once_in(self.wild) {
            EXTREMES[self.numbers.below(EXTREMES.len())].to_owned()
        } else {
            format!("{value:?}")
        }
    }

    /// A number: mostly simple, of any sign.
    pub(crate) fn number(&mut self) -> String {
        let value = match self.numbers.below(4) {
            0 => f64::from(self.numbers.between(-2, 2)),
            1 => self.numbers.unit(),
            _ => 0.25 * f64::from(self.numbers.between(-8, 8)),
        };
        self.or_extreme(value)
    }

    /// A number: mostly > 0, once in 12 times 0.
    pub(crate) fn positive(&mut self) -> String {
        let value = match self.numbers.below(12) {
            0 => 0.0,
            1 => 10.0_f64.powi(self.numbers.between(-9, 9)),
            _ => 0.5 * f64::from(self.numbers.between(1, 8)),
        };
        self.or_extreme(value)
    }

    /// A coordinate of a point (m).
    pub(crate) fn length(&mut self) -> String {
        let value = match self.numbers.below(6) {
            0 => self.numbers.unit(),
            _ => 0.5 * f64::from(self.numbers.between(-4, 4)),
        };
        let length = self.length;
        self.or_extreme(value * length)
    }

    pub(crate) fn point(&mut self) -> String {
        format!("[{}, {}]", self.length(), self.length())
    }

    /// A direction, mostly along an axis.
    pub(crate) fn direction(&mut self) -> String {
        match self.numbers.below(6) {
            0 => format!("[{}, {}]", self.number(), self.number()),
            1 => "[1.0, 1e-9]".to_owned(),
            2 => "[0.6, 0.8]".to_owned(),
            3 => "[0.0, -2.0]".to_owned(),
            4 => "[0.0, 1.0]".to_owned(),
            _ => "[1.0, 0.0]".to_owned(),
        }
    }

    /// A name in quotes.
    pub(crate) fn name(&mut self, kind: &str, k: usize) -> String {
        if self.has_names && self.numbers.once_in(3) {
            format!("\"{}{k}\"", NAMES[self.numbers.below(NAMES.len())])
        } else {
            format!("\"{kind}{k}\"")
        }
    }

    /// One of several words.
    pub(crate) fn one<'w>(&mut self, words: &[&'w str]) -> &'w str {
        words[self.numbers.below(words.len())]
    }
}
