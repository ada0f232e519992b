//! Numbers of a scene that vary in addition to its tolerances: masses, stiffnesses, parameters.

use std::fmt;
use std::str::FromStr;

use model::{Mechanism, Registry, System, Tolerance};
use scene::{Shift, Template, WithUnit};
use serde::Deserialize;

use super::draw::Stream;
use super::error::ToleranceError;
use super::failed::SampleFailure;
use super::nominal::{Base, DisplacedDatum, Nominal, displaced};
use crate::assembled::AssembledScene;

/// Index of the first stream of random numbers for varied numbers.
const FIRST: u64 = 1 << 32;

/// The reason for samples whose varied numbers give no valid scene.
const UNREADABLE: &str = "the scene with varied numbers cannot be assembled";

/// A number of a scene that is uniformly distributed in an interval around its value, such as
/// `KEY=±VALUE` or `KEY=±P%`. The sign may be written as `+-`. A value may have a unit.
///
/// ```
/// use pfaff::tolerance::Variation;
/// let mass: Variation = "body.crank.mass=±2%".parse()?;
/// assert_eq!((mass.key(), mass.to_string()), ("body.crank.mass", "body.crank.mass=±2%".to_owned()));
/// assert_eq!("L=+-0.5mm".parse::<Variation>()?.to_string(), "L=±0.5mm");
/// assert!("L=0.5".parse::<Variation>().is_err() && "L=±-1".parse::<Variation>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "String")]
pub struct Variation {
    key: String,
    /// The text after the sign.
    text: String,
    /// The largest change.
    most: Shift,
}

impl Variation {
    /// Returns the key of the number; see [`scene::Template`].
    #[must_use]
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Returns the text of the largest change.
    pub(super) fn by(&self) -> String {
        format!("± {}", self.text)
    }

    /// Returns a fraction, from −1 to 1, of the largest change.
    fn share(&self, share: f64) -> Shift {
        match &self.most {
            Shift::By(most) => Shift::By(share * most),
            Shift::Of(most, unit) => Shift::Of(share * most, unit.clone()),
            Shift::Share(most) => Shift::Share(share * most),
        }
    }
}

impl fmt::Display for Variation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}=±{}", self.key, self.text)
    }
}

impl TryFrom<String> for Variation {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl FromStr for Variation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let form =
            || format!("`{text}` is not KEY=±VALUE or KEY=±P%, as mass=±0.1, L=±0.5mm or k=±10%");
        // Names may contain the sign `=`, but numbers do not.
        let (key, value) = text.rsplit_once('=').ok_or_else(form)?;
        let value = ["±", "+-", "+/-"]
            .into_iter()
            .find_map(|sign| value.trim().strip_prefix(sign))
            .ok_or_else(form)?;
        let value = value.trim();
        let plain = |text: &str| text.trim().parse::<f64>().ok();
        let most = match (value.strip_suffix('%'), WithUnit::read(value)) {
            (Some(percent), _) => plain(percent).map(|p| Shift::Share(p / 100.0)),
            (None, Some(of)) => Some(Shift::Of(of.number, of.unit.to_owned())),
            (None, None) => plain(value).map(Shift::By),
        };
        let size = |most: &Shift| match most {
            Shift::By(x) | Shift::Of(x, _) | Shift::Share(x) => *x,
        };
        let most = most.filter(|most| size(most).is_finite() && size(most) > 0.0);
        match (key.trim(), most) {
            (key, Some(most)) if !key.is_empty() => Ok(Self {
                key: key.to_owned(),
                text: value.to_owned(),
                most,
            }),
            _ => Err(form()),
        }
    }
}

/// The text of a scene in which numbers vary.
pub struct VariedText<'r> {
    name: String,
    template: Template,
    pub(super) list: Vec<Variation>,
    /// Tolerance that replaces the tolerances of the scene.
    tolerance: Tolerance,
    registry: &'r Registry,
}

impl<'r> VariedText<'r> {
    /// Finds the numbers in a text. `name` is the file name in messages. `tolerance` takes
    /// precedence over the tolerance of the scene.
    ///
    /// # Errors
    /// - [`ToleranceError::Key`]: a key does not refer to a number of the scene.
    /// - [`ToleranceError::Vary`]: the scene cannot be assembled at one end of an interval.
    pub fn new(
        (name, text): (&str, &str),
        registry: &'r Registry,
        tolerance: Tolerance,
        list: Vec<Variation>,
    ) -> Result<Self, ToleranceError> {
        let keys: Vec<&str> = list.iter().map(Variation::key).collect();
        let varied = Self {
            name: name.to_owned(),
            template: Template::new(text, &keys)?,
            list,
            tolerance,
            registry,
        };
        // Each end is tested separately, so that the error can name the invalid number.
        for k in 0..varied.list.len() {
            for end in [-1.0, 1.0] {
                let share = |other: usize| if other == k { end } else { 0.0 };
                let shares: Vec<f64> = (0..varied.list.len()).map(share).collect();
                if let Err(reason) = varied.mechanism(&shares) {
                    return Err(ToleranceError::Vary {
                        variation: varied.list[k].to_string(),
                        reason,
                    });
                }
            }
        }
        Ok(varied)
    }

    /// Returns the mechanism for these fractions of the largest changes, and its start.
    fn mechanism(&self, shares: &[f64]) -> Result<(Mechanism, Vec<f64>), String> {
        let all = self.list.iter().zip(shares);
        let shifts: Vec<Shift> = all
            .map(|(variation, share)| variation.share(*share))
            .collect();
        let text = self.template.shifted(&shifts);
        let text = text.ok_or("the scene has no number for this key")?;
        let read = AssembledScene::read(&self.name, &text, self.registry)
            .and_then(|assembled| assembled.stating(self.tolerance));
        let mut assembled = read.map_err(|e| e.to_string())?;
        let assembly = assembled.assemble().map_err(|e| e.to_string())?;
        Ok((assembled.mechanism, assembly.q))
    }

    /// Returns the fractions of the largest changes in a sample.
    pub(super) fn shares(&self, seed: u64, number: u64) -> Vec<f64> {
        (0..self.list.len() as u64)
            .map(|k| Stream::new(seed, number, FIRST + k).uniform())
            .collect()
    }

    /// Returns the described mechanism of a sample, the state from which it is assembled, and its
    /// displaced data.
    pub(super) fn described(
        &self,
        nominal: &Nominal,
        shares: &[f64],
    ) -> Result<(Mechanism, Base, Vec<DisplacedDatum>), SampleFailure> {
        let failed = |detail: String| SampleFailure::new(UNREADABLE, detail);
        let (mechanism, q) = self.mechanism(shares).map_err(failed)?;
        if mechanism.layout().labels != nominal.mechanism.layout().labels {
            return Err(failed("it has other rows".to_owned()));
        }
        let mut s = mechanism.scratch();
        let start_time = mechanism.layout().start_time;
        mechanism.pose(start_time, &q, &mut s);
        let data = displaced(&mechanism, mechanism.data().blocks(&s));
        let mut base = nominal.base.clone();
        if nominal.t == start_time {
            let given = mechanism.frames().given_velocities(&q);
            for (v, given) in base.v.iter_mut().zip(given) {
                *v = given.unwrap_or(*v);
            }
            base.q = q;
        }
        Ok((mechanism, base, data))
    }
}
