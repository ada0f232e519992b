//! A number of a scene with its values in a sweep.

use model::codes::Code;
use std::fmt;
use std::str::FromStr;

use scene::WithUnit;
use serde::Deserialize;

/// Largest number of runs of a sweep. The rows of all runs are in memory while tables are written.
const RUNS_MAX: usize = 10_000_000;

/// A key of a scene with the values of its number, such as `KEY=FROM:TO:N`, `KEY=FROM:TO:N:log` or
/// `KEY=1,2,5`.
///
/// `FROM:TO:N` means N ≥ 2 values including both ends. The values, or with `log` their logarithms,
/// are evenly spaced. Both ends are exact. Numbers may have a unit, and both ends of a range must
/// have the same unit, as in `L=300mm:500mm:21`. The values of an axis with a unit are in SI units.
/// The scene receives the values in their written form and checks the unit.
///
/// ```
/// use pfaff::sweep::Axis;
///
/// let axis: Axis = "simulate.rtol=1e-4:1e-10:3:log".parse()?;
/// assert_eq!((axis.key(), axis.values()), ("simulate.rtol", &[1e-4, 1e-7, 1e-10][..]));
/// assert_eq!("body.bob.mass=1,2,5".parse::<Axis>()?.values(), [1.0, 2.0, 5.0]);
/// assert_eq!("body.bob.mass=0:1:11".parse::<Axis>()?.values()[3], 0.3);
/// assert_eq!("L=300mm:500mm:21".parse::<Axis>()?.values()[1], 0.31);
/// # Ok::<(), pfaff::sweep::AxisError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "String")]
pub struct Axis {
    key: String,
    /// The text of the values.
    text: String,
    values: Vec<f64>,
    /// The values as the scene receives them, if they have a unit.
    written: Option<Vec<String>>,
}

/// Reason why an axis or grid is invalid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AxisError {
    /// The text is neither a range nor a list.
    #[error("`{text}` is not KEY=FROM:TO:N, KEY=FROM:TO:N:log or KEY=A,B,C")]
    Form {
        /// The text.
        text: String,
    },
    /// A value is not a finite number.
    #[error("`{text}`: `{value}` is not a finite number, with or without a unit")]
    Value {
        /// The text.
        text: String,
        /// The value.
        value: String,
    },
    /// Some values have a unit, and other values have no unit or a different unit.
    #[error("`{text}`: {problem}")]
    Units {
        /// The text.
        text: String,
        /// Description of the inconsistency.
        problem: &'static str,
    },
    /// A range has fewer than two values, or too many.
    #[error(
        "`{text}`: `{count}` is not a valid number of values from 2 to {RUNS_MAX}; a single value is `KEY=VALUE`"
    )]
    Count {
        /// The text.
        text: String,
        /// The number of values.
        count: String,
    },
    /// The ends of a logarithmic range have no logarithms.
    #[error("`{text}`: logarithmic spacing needs two ends of the same sign, neither of them 0")]
    Logarithm {
        /// The text.
        text: String,
    },
    /// There is no axis.
    #[error("nothing is varied")]
    Nothing,
    /// The grid has too many combinations.
    #[error("the grid has more than {RUNS_MAX} combinations")]
    TooLarge,
}

impl AxisError {
    /// Returns the code of the error; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Form { .. }
            | Self::Value { .. }
            | Self::Units { .. }
            | Self::Count { .. }
            | Self::Logarithm { .. }
            | Self::Nothing { .. }
            | Self::TooLarge { .. } => const { Code::new(502) },
        }
    }
}

impl Axis {
    /// Creates an axis with a key and any values.
    ///
    /// # Errors
    /// [`AxisError::Form`], [`AxisError::Value`]: there are no values, or they are not finite.
    pub fn list(key: &str, values: &[f64]) -> Result<Self, AxisError> {
        let texts: Vec<String> = values.iter().map(|x| format!("{x:?}")).collect();
        format!("{key}={}", texts.join(",")).parse()
    }

    /// Name of the number; see [`scene::Template`].
    #[must_use]
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Whether the values of the axis have no unit. Such values are in the units of the scene.
    pub(super) fn is_bare(&self) -> bool {
        self.written.is_none()
    }

    /// Returns the values of the axis.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.text)
    }
}

impl TryFrom<String> for Axis {
    type Error = AxisError;

    fn try_from(text: String) -> Result<Self, AxisError> {
        text.parse()
    }
}

impl FromStr for Axis {
    type Err = AxisError;

    fn from_str(text: &str) -> Result<Self, AxisError> {
        let form = || AxisError::Form {
            text: text.to_owned(),
        };
        // Names may contain the sign `=`, but numbers do not.
        let (key, values) = text.rsplit_once('=').ok_or_else(form)?;
        if key.is_empty() {
            return Err(form());
        }
        fn number<'t>(text: &str, value: &'t str) -> Result<Number<'t>, AxisError> {
            Number::read(value).ok_or_else(|| AxisError::Value {
                text: text.to_owned(),
                value: value.to_owned(),
            })
        }
        let units = |problem: &'static str| AxisError::Units {
            text: text.to_owned(),
            problem,
        };
        let parts: Vec<&str> = values.split(':').collect();
        let (spacing, [from, to, n]) = match parts[..] {
            [list] => {
                let numbers = list
                    .split(',')
                    .map(|value| number(text, value))
                    .collect::<Result<Vec<_>, _>>()?;
                if numbers.iter().any(|other| !other.is_like(&numbers[0])) {
                    return Err(units("all values need a unit of one kind, or none"));
                }
                let written = numbers[0].unit.is_some();
                return Ok(Self {
                    key: key.to_owned(),
                    text: list.to_owned(),
                    values: numbers.iter().map(|x| x.in_si(x.number)).collect(),
                    written: written.then(|| numbers.iter().map(|x| x.text(x.number)).collect()),
                });
            }
            [from, to, n] => (Spacing::Even, [from, to, n]),
            [from, to, n, "log"] => (Spacing::Logarithmic, [from, to, n]),
            _ => return Err(form()),
        };
        let count = n.trim().parse().ok();
        let count = count.filter(|n| (2..=RUNS_MAX).contains(n));
        let n = count.ok_or_else(|| AxisError::Count {
            text: text.to_owned(),
            count: n.to_owned(),
        })?;
        let (first, last) = (number(text, from)?, number(text, to)?);
        if first.unit.map(|u| u.unit) != last.unit.map(|u| u.unit) {
            return Err(units("both ends need the same unit, or none"));
        }
        let (from, to) = (first.number, last.number);
        let has_logarithms = from != 0.0 && to != 0.0 && from.signum() == to.signum();
        if matches!(spacing, Spacing::Logarithmic) && !has_logarithms {
            return Err(AxisError::Logarithm {
                text: text.to_owned(),
            });
        }
        let numbers = (0..n).map(|k| spacing.value(from, to, k, n - 1));
        let written = first.unit.is_some();
        Ok(Self {
            key: key.to_owned(),
            text: values.to_owned(),
            values: numbers.clone().map(|x| first.in_si(x)).collect(),
            written: written.then(|| numbers.map(|x| first.text(x)).collect()),
        })
    }
}

/// A value of a swept parameter, as the user has written it.
#[derive(Clone, Copy)]
struct Number<'a> {
    number: f64,
    unit: Option<WithUnit<'a>>,
}

impl<'a> Number<'a> {
    fn read(text: &'a str) -> Option<Self> {
        if let Some(unit) = WithUnit::read(text) {
            let (number, unit) = (unit.number, Some(unit));
            return Some(Self { number, unit });
        }
        let number = text.trim().parse().ok().filter(|x: &f64| x.is_finite())?;
        Some(Self { number, unit: None })
    }

    fn is_like(&self, other: &Self) -> bool {
        match (&self.unit, &other.unit) {
            (Some(a), Some(b)) => a.is_like(b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }

    /// Converts another number with the same unit to SI. Without a unit, the number is unchanged.
    fn in_si(&self, number: f64) -> f64 {
        self.unit.map_or(number, |unit| unit.in_si(number))
    }

    /// Writes another number with the same unit, for a scene.
    fn text(&self, number: f64) -> String {
        let unit = self.unit.map_or("", |unit| unit.unit);
        format!("{number:?} {unit}")
    }
}

#[derive(Clone, Copy)]
enum Spacing {
    Even,
    Logarithmic,
}

impl Spacing {
    /// Returns value k of the values 0 … last.
    fn value(self, from: f64, to: f64, k: usize, last: usize) -> f64 {
        let share = k as f64 / last as f64;
        match self {
            _ if k == 0 => from,
            _ if k == last => to,
            // If the ends are whole numbers, the result is rounded only once, so that 0:1:11
            // contains 0.3.
            Self::Even if (from.abs() + to.abs()) * (last as f64) < f64::MAX => {
                (from * (last - k) as f64 + to * k as f64) / last as f64
            }
            Self::Even => from * (1.0 - share) + to * share,
            // The result is exact at powers of ten.
            Self::Logarithmic => {
                let exponent = from.abs().log10() * (1.0 - share) + to.abs().log10() * share;
                10_f64.powf(exponent).copysign(from)
            }
        }
    }
}

/// All combinations of the values of several axes. The last axis varies fastest.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid {
    pub(super) axes: Vec<Axis>,
    pub(super) len: usize,
}

impl Grid {
    pub(super) fn new(axes: Vec<Axis>) -> Result<Self, AxisError> {
        if axes.is_empty() {
            return Err(AxisError::Nothing);
        }
        let mut len = 1_usize;
        for axis in &axes {
            let product = len.checked_mul(axis.values.len());
            len = product
                .filter(|n| *n <= RUNS_MAX)
                .ok_or(AxisError::TooLarge)?;
        }
        Ok(Self { axes, len })
    }

    /// Returns the values of a combination. The index is 0-based.
    pub(super) fn point(&self, run: usize) -> Vec<f64> {
        self.each(run, |axis, k| axis.values[k])
    }

    /// Returns the same values in the form that a scene receives.
    pub(super) fn written(&self, run: usize) -> Vec<String> {
        self.each(run, |axis, k| match &axis.written {
            Some(written) => written[k].clone(),
            None => format!("{:?}", axis.values[k]),
        })
    }

    /// For each axis, calls `of` with the index of the value of the axis in a combination, and
    /// returns the results.
    fn each<T>(&self, run: usize, of: impl Fn(&Axis, usize) -> T) -> Vec<T> {
        let mut rest = run;
        let mut point: Vec<T> = self
            .axes
            .iter()
            .rev()
            .map(|axis| {
                let n = axis.values.len();
                let value = of(axis, rest % n);
                rest /= n;
                value
            })
            .collect();
        point.reverse();
        point
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, AxisError, Grid};

    fn axis(text: &str) -> Axis {
        text.parse().unwrap_or_else(|e: AxisError| panic!("{e}"))
    }

    #[test]
    fn values_meet_what_was_written() {
        assert_eq!(axis("k=0:1:5").values(), [0.0, 0.25, 0.5, 0.75, 1.0]);
        let tenths = axis("k=0.1:0.9:9");
        for (k, x) in tenths.values().iter().enumerate() {
            let written: f64 = format!("0.{}", k + 1).parse().expect("a number");
            assert!((x - written).abs() <= f64::EPSILON * written, "{x}");
        }
        assert_eq!(axis("k=1:1000:4:log").values(), [1.0, 10.0, 100.0, 1000.0]);
        assert_eq!(axis("k=-0.01:-100:3:log").values(), [-0.01, -1.0, -100.0]);
        assert_eq!(axis("k=1e-300:1e300:3:log").values()[1], 1.0);
        assert_eq!(axis("k=-1.7e308:1.7e308:3").values()[1], 0.0);
        assert_eq!(axis("a=b.mass=2").key(), "a=b.mass");
        assert_eq!(axis("k=2:1:2").to_string(), "k=2:1:2");
        let lengths = axis("L=300mm:500 mm:3");
        assert_eq!(lengths.values(), [0.3, 0.4, 0.5]);
        assert_eq!(lengths.to_string(), "L=300mm:500 mm:3");
        let grid = Grid::new(vec![lengths]).expect("small");
        assert_eq!(grid.written(1), ["400.0 mm"]);
        assert_eq!(axis("k=2 kg,500g").values(), [2.0, 0.5]);
        assert_eq!(axis("w=90 deg/s,1 rad/s").values()[1], 1.0);
        assert_eq!(
            Axis::list("k", &[0.1, -2.0]).map(|a| a.to_string()),
            Ok("k=0.1,-2.0".to_owned())
        );
    }

    #[test]
    fn what_is_no_axis_is_refused() {
        for (text, piece) in [
            ("mass", "is not KEY=FROM:TO:N"),
            ("=1:2:3", "is not KEY=FROM:TO:N"),
            ("k=1:2", "is not KEY=FROM:TO:N"),
            ("k=1:2:3:lin", "is not KEY=FROM:TO:N"),
            ("k=", "`` is not a finite number"),
            ("k=1,,2", "`` is not a finite number"),
            ("k=nan", "`nan` is not a finite number"),
            ("k=0:inf:3", "`inf` is not a finite number"),
            ("k=0:1:1", "`1` is not a valid number of values"),
            ("k=0:1:-3", "`-3` is not a valid number of values"),
            ("k=0:1:1e3", "`1e3` is not a valid number of values"),
            ("k=0:1:99999999", "is not a valid number of values"),
            ("k=0:1:3:log", "neither of them 0"),
            ("k=1:0:3:log", "neither of them 0"),
            ("k=-1:-0.0:3:log", "neither of them 0"),
            ("k=-1:1:3:log", "neither of them 0"),
            ("L=300mm:0.5m:3", "both ends need the same unit, or none"),
            ("L=300:500mm:3", "both ends need the same unit, or none"),
            ("L=300mm,2", "all values need a unit of one kind, or none"),
            (
                "L=300mm,2 kg",
                "all values need a unit of one kind, or none",
            ),
            ("L=3 furlongs:4 furlongs:2", "with or without a unit"),
        ] {
            let error = text.parse::<Axis>().expect_err(text);
            assert!(error.to_string().contains(piece), "{error}");
        }
        let wide = axis("k=0:1:10000");
        assert_eq!(
            Grid::new(vec![wide.clone(), wide]),
            Err(AxisError::TooLarge)
        );
        assert_eq!(Grid::new(Vec::new()), Err(AxisError::Nothing));
    }

    #[test]
    fn the_last_axis_runs_fastest() {
        let grid = Grid::new(vec![axis("a=1,2"), axis("b=3,4,5")]).expect("small");
        let points: Vec<Vec<f64>> = (0..grid.len).map(|k| grid.point(k)).collect();
        assert_eq!(points.len(), 6);
        assert_eq!(
            points[..4],
            [[1.0, 3.0], [1.0, 4.0], [1.0, 5.0], [2.0, 3.0]]
        );
    }
}
