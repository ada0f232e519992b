//! Numbers and names of random scenes.

use suite::numbers::Numbers;

/// Extreme numbers, which are valid for some keys and invalid for most keys.
pub(crate) const EXTREMES: [&str; 30] = [
    "0",
    "0.0",
    "-0.0",
    "-1",
    "-1.0",
    "1e-320",
    "5e-324",
    "-5e-324",
    "2.3e-308",
    "1e-200",
    "1e-30",
    "1e-16",
    "1e-12",
    "1e-9",
    "1e-6",
    "1e6",
    "1e9",
    "1e12",
    "1e16",
    "1e30",
    "1e100",
    "-1e100",
    "1e160",
    "1e308",
    "-1.7976931348623157e308",
    "1e400",
    "nan",
    "inf",
    "-inf",
    "9223372036854775807",
];

/// Names that can be confused with other TOML syntax.
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

/// Generates numbers and names; the parameter `wild` determines the frequency of extreme numbers.
pub(crate) struct Values<'n> {
    pub(crate) numbers: &'n mut Numbers,
    /// The number of components of a point: 2 or 3.
    axes: usize,
    /// A number is extreme with probability 1/`wild`, or never if `wild` is 0.
    wild: usize,
    /// Unit of length (m).
    length: f64,
    has_names: bool,
    /// A number is an expression with probability 1/`expressions`, or never if `expressions` is 0.
    expressions: usize,
}

/// Parameters of scenes with expressions.
const PARAMETERS: [&str; 5] = ["p0", "p1", "p2", "p3", "p_4"];

/// Expressions without a unit; `#` is replaced by a number. Expressions with a unit are valid for
/// few keys.
const EXPRESSIONS: [&str; 16] = [
    "#",
    "-(#)",
    "2*#/2",
    "# + 0.25",
    "(#)^1",
    "# - 1e-3",
    "max(#, 0.1)",
    "min(abs(#), 5)",
    "sqrt(abs(#))",
    "#*cos(0)",
    "# + sin(pi)",
    "#*1 mm/mm",
    "atan2(#, 1)",
    "exp(-abs(#))",
    "log(#)",
    "#/(# - #)",
];

impl<'n> Values<'n> {
    pub(crate) fn new(numbers: &'n mut Numbers, axes: usize) -> Self {
        Self {
            axes,
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
            expressions: match numbers.below(5) {
                0 => 3,
                1 => 20,
                _ => 0,
            },
            numbers,
        }
    }

    /// Whether numbers may be expressions.
    pub(crate) fn has_expressions(&self) -> bool {
        self.expressions > 0
    }

    fn or_extreme(&mut self, value: f64) -> String {
        if self.wild > 0 && self.numbers.once_in(self.wild) {
            EXTREMES[self.numbers.below(EXTREMES.len())].to_owned()
        } else if self.is_expression() {
            self.expression(value)
        } else {
            format!("{value:?}")
        }
    }

    fn is_expression(&mut self) -> bool {
        self.expressions > 0 && self.numbers.once_in(self.expressions)
    }

    /// Returns an expression for a number without a unit.
    fn expression(&mut self, value: f64) -> String {
        let number = if self.numbers.once_in(4) {
            self.parameter().to_owned()
        } else {
            format!("{value:?}")
        };
        let text = self.one(&EXPRESSIONS).replace('#', &number);
        format!("\"{text}\"")
    }

    /// Returns the name of a parameter.
    pub(crate) fn parameter(&mut self) -> &'static str {
        self.one(&PARAMETERS)
    }

    /// Adds `[parameters]`: mostly numbers and values that can be computed from these numbers, and,
    /// with probability 1/40, a parameter with a circular definition.
    pub(crate) fn parameters(&mut self) -> String {
        let mut text = "[parameters]\n".to_owned();
        for (k, name) in PARAMETERS.iter().enumerate() {
            let value = match self.numbers.below(40) {
                0 => format!("\"{}\"", self.parameter()),
                1 => "\"2 kg\"".to_owned(),
                2..8 => format!("{:?}", self.numbers.unit()),
                8..16 if k > 0 => format!("\"2*{}\"", PARAMETERS[k - 1]),
                _ => format!("{:?}", 0.5 * f64::from(self.numbers.between(1, 4))),
            };
            text.push_str(&format!("{name} = {value}\n"));
        }
        text
    }

    /// Returns a number as a text with a unit, if expressions are allowed.
    fn with_unit(&mut self, value: f64, units: &[(&str, f64)]) -> Option<String> {
        if !self.is_expression() {
            return None;
        }
        let (unit, size) = units[self.numbers.below(units.len())];
        Some(format!("\"{:?} {unit}\"", value / size))
    }

    /// Returns an angle (rad).
    pub(crate) fn angle(&mut self) -> String {
        let value = 0.25 * f64::from(self.numbers.between(-8, 8));
        self.with_unit(value, &[("deg", 1.0_f64.to_radians()), ("rad", 1.0)])
            .unwrap_or_else(|| self.or_extreme(value))
    }

    /// Returns a number of any sign, mostly with few digits.
    pub(crate) fn number(&mut self) -> String {
        let value = match self.numbers.below(4) {
            0 => f64::from(self.numbers.between(-2, 2)),
            1 => self.numbers.unit(),
            _ => 0.25 * f64::from(self.numbers.between(-8, 8)),
        };
        self.or_extreme(value)
    }

    /// Returns a number that is mostly > 0, and 0 with probability 1/12.
    pub(crate) fn positive(&mut self) -> String {
        let value = match self.numbers.below(12) {
            0 => 0.0,
            1 => 10.0_f64.powi(self.numbers.between(-9, 9)),
            _ => 0.5 * f64::from(self.numbers.between(1, 8)),
        };
        self.or_extreme(value)
    }

    /// Returns a coordinate of a point (m).
    pub(crate) fn length(&mut self) -> String {
        let value = match self.numbers.below(6) {
            0 => self.numbers.unit(),
            _ => 0.5 * f64::from(self.numbers.between(-4, 4)),
        };
        let value = value * self.length;
        self.with_unit(
            value,
            &[("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("in", 0.0254)],
        )
        .unwrap_or_else(|| self.or_extreme(value))
    }

    /// Returns a list with one number for each axis.
    pub(crate) fn list(&mut self, mut number: impl FnMut(&mut Self) -> String) -> String {
        let all: Vec<String> = (0..self.axes).map(|_| number(self)).collect();
        format!("[{}]", all.join(", "))
    }

    /// Returns a velocity (m/s), or any other vector of numbers.
    pub(crate) fn velocity(&mut self) -> String {
        self.list(Self::number)
    }

    pub(crate) fn point(&mut self) -> String {
        self.list(Self::length)
    }

    /// Returns a direction, mostly along an axis.
    pub(crate) fn direction(&mut self) -> String {
        let plane = [
            "[1.0, 1e-9]",
            "[0.6, 0.8]",
            "[0.0, -2.0]",
            "[0.0, 1.0]",
            "[1.0, 0.0]",
        ];
        let space = [
            "[1.0, 1e-9, 0.0]",
            "[0.6, 0.0, 0.8]",
            "[0.0, -2.0, 0.0]",
            "[0.0, 1.0, 0.0]",
            "[1.0, 0.0, 0.0]",
            "[0.0, 0.0, 1.0]",
            "[0.0, 0.0, 1.0]",
        ];
        let known: &[&str] = if self.axes == 2 { &plane } else { &space };
        match self.numbers.below(known.len() + 1) {
            0 => self.velocity(),
            k => known[k - 1].to_owned(),
        }
    }

    /// Returns a name in quotes.
    pub(crate) fn name(&mut self, kind: &str, k: usize) -> String {
        if self.has_names && self.numbers.once_in(3) {
            format!("\"{}{k}\"", NAMES[self.numbers.below(NAMES.len())])
        } else {
            format!("\"{kind}{k}\"")
        }
    }

    /// Returns one of several words.
    pub(crate) fn one<'w>(&mut self, words: &[&'w str]) -> &'w str {
        words[self.numbers.below(words.len())]
    }
}
