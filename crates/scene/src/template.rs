//! The text of a scene in which some numbers can be replaced by other numbers or expressions. The
//! rest of the text does not change. Therefore [`read`](crate::read()) checks the result like any
//! other scene, with the same line numbers.
//!
//! The caller chooses the values. This module does not check the values.

mod edit;
mod key;
mod rest;
mod retyped;
#[cfg(test)]
mod tests;

use std::ops::Range;

use toml::de::DeTable;

use key::SlotKind;

pub use key::KeyError;
pub use rest::{at_rest, in_motion, posed};
pub use retyped::{RetypedJoint, retyped};

use crate::limits;

/// Integers below this value are written without a decimal point, because some keys accept only
/// integers.
const WHOLE: f64 = 9_007_199_254_740_992.0;

/// The text of a scene with numbers that can be replaced.
///
/// A key is the name of a parameter, or a path: `body.platform.mass`, `joint.H.axis[0]`,
/// `drive.steer.motion.steps[0].by`, `scene.gravity[1]`, `simulate.rtol`. Named items are selected
/// by their names or by `[0]`, `[1]`, …; entries of lists are 0-based. If a key is missing in the
/// text, it is added to its table. The table must exist, and parameters are not added. The key
/// `active` counts as a number, and zero means false.
///
/// ```
/// let text = "[scene]\nname = \"drop\"\n[[body]]\nname = \"bob\"\nmass = 1.0 # kg\n";
/// let template = pfaff_scene::Template::new(text, &["body.bob.mass", "body.bob.angle"])?;
/// let changed = template.with(&[2.5, 0.1]);
/// let body = "[[body]]\nangle = 0.1\nname = \"bob\"\nmass = 2.5 # kg\n";
/// assert_eq!(changed, format!("[scene]\nname = \"drop\"\n{body}"));
///
/// let wrong = pfaff_scene::Template::new(text, &["body.bib.mass"]).err().unwrap();
/// let words = wrong.to_string();
/// assert_eq!(words, "`body.bib.mass`: there is no `bib` in `body`; did you mean `bob`?");
/// # Ok::<(), pfaff_scene::KeyError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Template {
    text: String,
    /// The positions of the numbers, in the order of the text. Each position has the index of its
    /// key.
    slots: Vec<(usize, Slot)>,
}

/// Change of a number in a template.
#[derive(Clone, Debug, PartialEq)]
pub enum Shift {
    /// Adds a value, in the unit of the number itself.
    By(f64),
    /// Adds a value with a unit; the scene must have format 2.
    Of(f64, String),
    /// Adds a fraction of the number itself.
    Share(f64),
}

/// Position of a number in the text, and the text to write around a new value.
#[derive(Clone, Debug)]
struct Slot {
    span: Range<usize>,
    before: String,
    after: &'static str,
    old: OldValue,
}

/// The current text at the position of a number.
#[derive(Clone, Debug)]
enum OldValue {
    /// The value is missing, or it is not a number.
    Other,
    /// A number.
    Number(f64),
    /// An expression.
    Expression(String),
}

impl Template {
    /// Finds the positions of the numbers with these keys.
    ///
    /// # Errors
    /// - [`KeyError::NotToml`]: the text cannot be parsed; [`read`](crate::read()) reports the
    ///   reason.
    /// - [`KeyError::Unknown`], [`KeyError::Index`]: a key does not exist.
    /// - [`KeyError::NotANumber`], [`KeyError::NoRoom`]: the value is not a number, or the key
    ///   cannot be added.
    /// - [`KeyError::Repeated`]: two keys refer to the same number.
    pub fn new(text: &str, keys: &[&str]) -> Result<Self, KeyError> {
        Self::of(text, keys, SlotKind::Number)
    }

    /// Finds the positions of these keys.
    fn of(text: &str, keys: &[&str], kind: SlotKind) -> Result<Self, KeyError> {
        if limits::excess(text).is_some() {
            return Err(KeyError::NotToml);
        }
        let root = DeTable::parse(text).map_err(|_| KeyError::NotToml)?;
        let find = |key: &&str| key::find(key, text, root.get_ref(), kind);
        let found = keys.iter().map(find).collect::<Result<Vec<_>, _>>()?;
        let mut slots: Vec<(usize, Slot)> = found.into_iter().enumerate().collect();
        slots.sort_by_key(|(k, slot)| (slot.span.start, *k));
        let same = |pair: &&[(usize, Slot)]| {
            let [(_, a), (_, b)] = pair else { return false };
            a.span == b.span && a.before == b.before
        };
        if let Some([(first, _), (second, _)]) = slots.windows(2).find(same) {
            return Err(KeyError::Repeated {
                key: keys[*second].to_owned(),
                first: keys[*first].to_owned(),
            });
        }
        Ok(Self {
            text: text.to_owned(),
            slots,
        })
    }

    /// Returns the text with these values, in the order of the keys.
    ///
    /// # Panics
    /// Panics if the number of values differs from the number of keys.
    #[must_use]
    pub fn with(&self, values: &[f64]) -> String {
        let texts: Vec<String> = values.iter().map(|x| number(*x)).collect();
        self.filled(&texts)
    }

    /// Returns the text with these numbers or expressions, in the order of the keys. Expressions
    /// require a scene of format 2.
    ///
    /// ```
    /// let text = "[scene]\nformat = 2\n[parameters]\nL = 0.3\n";
    /// let template = pfaff_scene::Template::new(text, &["L"])?;
    /// assert!(template.with_expressions(&["2*0.2 m"]).ends_with("L = \"2*0.2 m\"\n"));
    /// assert!(template.with_expressions(&["0.5"]).ends_with("L = 0.5\n"));
    /// # Ok::<(), pfaff_scene::KeyError>(())
    /// ```
    ///
    /// # Panics
    /// Panics if the number of expressions differs from the number of keys.
    #[must_use]
    pub fn with_expressions(&self, expressions: &[&str]) -> String {
        self.placed(expressions).0
    }

    /// Returns the same text, and the start position of each expression in it.
    ///
    /// # Panics
    /// Panics if the number of expressions differs from the number of keys.
    #[must_use]
    pub fn placed(&self, expressions: &[&str]) -> (String, Vec<usize>) {
        let text = |text: &&str| match text.trim().parse() {
            Ok(value) => number(value),
            Err(_) => toml::Value::from(*text).to_string(),
        };
        let texts: Vec<String> = expressions.iter().map(text).collect();
        let mut places = vec![0; texts.len()];
        let text = self.filled_at(&texts, &mut places);
        (text, places)
    }

    /// Returns the text with every number changed by a fraction of its value, in the order of the
    /// keys. A zero, or a number that is missing in the text, is set to the fraction. Returns
    /// `None` if the value of a key is not a number.
    ///
    /// ```
    /// let head = "[scene]\nformat = 2\n[parameters]\n";
    /// let text = &format!("{head}L = 0.5\nH = \"L + 20 mm\"\nx = 0.0\n");
    /// let template = pfaff_scene::Template::new(text, &["L", "H", "x"])?;
    /// let changed = template.changed_by(&[0.5, 0.25, 0.125]).unwrap();
    /// assert!(changed.ends_with("L = 0.75\nH = \"(L + 20 mm)*1.25\"\nx = 0.125\n"));
    /// # Ok::<(), pfaff_scene::KeyError>(())
    /// ```
    ///
    /// # Panics
    /// Panics if the number of fractions differs from the number of keys.
    #[must_use]
    pub fn changed_by(&self, shares: &[f64]) -> Option<String> {
        let mut texts = vec![String::new(); self.slots.len()];
        for (k, slot) in &self.slots {
            let share = shares[*k];
            texts[*k] = match &slot.old {
                _ if share == 0.0 => self.text[slot.span.clone()].to_owned(),
                OldValue::Number(x) if *x == 0.0 => number(share),
                OldValue::Number(x) => number(x * (1.0 + share)),
                OldValue::Expression(text) => {
                    let factor = number(1.0 + share);
                    toml::Value::from(format!("({text})*{factor}")).to_string()
                }
                OldValue::Other if slot.span.is_empty() => number(share),
                OldValue::Other => return None,
            };
        }
        Some(self.filled(&texts))
    }

    /// Returns the text with every number changed by a shift, in the order of the keys. Returns
    /// `None` if the text has neither a number nor an expression for a key.
    ///
    /// ```
    /// use pfaff_scene::{Shift, Template};
    /// let text = "[scene]\nformat = 2\n[parameters]\nL = 0.5\nH = \"L + 20 mm\"\n";
    /// let template = Template::new(text, &["L", "H"])?;
    /// let shifts = [Shift::By(0.25), Shift::Of(0.5, "mm".into())];
    /// let shifted = template.shifted(&shifts).unwrap();
    /// assert!(shifted.ends_with("L = 0.75\nH = \"(L + 20 mm) + 0.5 mm\"\n"));
    /// assert!(template.shifted(&[Shift::Share(0.5), Shift::Share(0.0)]).unwrap().contains("L = 0.75\n"));
    /// # Ok::<(), pfaff_scene::KeyError>(())
    /// ```
    ///
    /// # Panics
    /// Panics if the number of shifts differs from the number of keys.
    #[must_use]
    pub fn shifted(&self, shifts: &[Shift]) -> Option<String> {
        let mut texts = vec![String::new(); self.slots.len()];
        for (k, slot) in &self.slots {
            let computed = |text: &str| toml::Value::from(text).to_string();
            texts[*k] = match (&slot.old, &shifts[*k]) {
                (OldValue::Other, _) => return None,
                (OldValue::Number(x), Shift::By(by)) => number(x + by),
                (OldValue::Number(x), Shift::Share(share)) => number(x * (1.0 + share)),
                (OldValue::Number(x), Shift::Of(by, unit)) => {
                    computed(&format!("{} + {} {unit}", number(*x), number(*by)))
                }
                (OldValue::Expression(text), Shift::By(by)) => {
                    computed(&format!("({text}) + {}", number(*by)))
                }
                (OldValue::Expression(text), Shift::Share(share)) => {
                    computed(&format!("({text})*{}", number(1.0 + share)))
                }
                (OldValue::Expression(text), Shift::Of(by, unit)) => {
                    computed(&format!("({text}) + {} {unit}", number(*by)))
                }
            };
        }
        Some(self.filled(&texts))
    }

    /// Returns the text with these values, which are already in the syntax of TOML.
    fn filled(&self, texts: &[String]) -> String {
        self.filled_at(texts, &mut vec![0; texts.len()])
    }

    /// Returns the text with these values, and writes their start positions to `places`.
    fn filled_at(&self, texts: &[String], places: &mut [usize]) -> String {
        let n = self.slots.len();
        assert!(
            texts.len() == n,
            "{} values for {n} keys of a template",
            texts.len()
        );
        let mut out = String::with_capacity(self.text.len() + 32 * n);
        let mut at = 0;
        for (k, slot) in &self.slots {
            out.push_str(&self.text[at..slot.span.start]);
            at = slot.span.end;
            if texts[*k].is_empty() {
                continue;
            }
            out.push_str(&slot.before);
            places[*k] = out.len();
            out.push_str(&texts[*k]);
            out.push_str(slot.after);
        }
        out.push_str(&self.text[at..]);
        out
    }
}

/// Returns the shortest decimal text from which the same bits are read.
fn number(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < WHOLE {
        format!("{value:.0}")
    } else if value.is_nan() {
        "nan".to_owned()
    } else {
        format!("{value:?}")
    }
}
