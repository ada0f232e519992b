//! Finds the values of the equations that a module takes as inputs.
//!
//! The scene is built with other values of the keys that the user wants to vary: each key alone,
//! and all keys together. A key affects the recorded values that change: data of joints and forces,
//! stored initial values, masses, gravity, principal axes, parameters of functions of time. These
//! values are the inputs. They are identified by their indices in the recording. Values that are
//! equal in all variants become one input.
//!
//! Choices that are not values of the equations cannot be inputs: the independent rows, the
//! structure, break times. A key that changes them is rejected with an error.
//!
//! Indices identify inputs uniquely, even if values are equal by chance. Indices also identify
//! values that are computed before the recording, for example principal axes and the weight.

use std::collections::HashMap;

use dynamics::{MotionOptions, PreparedMechanism};
use model::{Mechanism, RecordedEquations, System};
use scene::{KeyError, Template};

use crate::assembled::{SceneText, prepared};
use crate::error::{CodeError, NotAnInput};
use crate::functions::recordable;
use crate::parameters::{Inputs, Parameter, Variant};
use crate::subject::{State, Subject};

/// Relative changes of the values of keys; the largest change for which the scene is valid is used.
/// The states of these motions are also used for the choice of pivots.
const SHARES: [f64; 4] = [0.2, 0.05, 0.01, 1e-3];

/// Values are equal if their difference is at most this multiple of the rounding error.
const ROUNDINGS: f64 = 4.0;

/// Largest nesting depth of lists whose entries are treated as separate keys.
const NESTED: usize = 4;

/// A key as given by the user, which refers to one number or to a list of numbers.
struct Key {
    name: String,
    /// Indices of the numbers of this key in the list of all numbers.
    numbers: Vec<usize>,
}

/// Adds the inputs for these keys to the subject, and states of motions in which the inputs have
/// other values.
pub(crate) fn vary<'a>(
    scene: &SceneText<'_>,
    keys: &[String],
    mut subject: Subject<'a>,
) -> Result<Subject<'a>, CodeError> {
    recordable(&subject.prepared.mechanism)?;
    let search = Search::new(scene, keys, subject.prepared)?;
    let described = RecordedEquations::of(&subject.prepared.mechanism);
    let singles: Vec<Option<RecordedEquations>> = (0..search.keys.len())
        .map(|k| search.alone(k, &described))
        .collect::<Result<_, _>>()?;
    let mut together = Vec::new();
    for sign in [1.0, -1.0] {
        together.push(search.together(sign, &described)?);
    }
    let mut inputs = search.inputs(&described, &singles, &together);
    for (study, states) in together {
        let recording = RecordedEquations::of(&study.mechanism);
        let value = |p: &Parameter| recording.number(p.places[0]).unwrap_or(f64::NAN);
        inputs.variants.push(Variant {
            values: inputs.list.iter().map(value).collect(),
            functions: study.mechanism.functions().cloned().collect(),
        });
        let variant = Some(inputs.variants.len() - 1);
        subject.variants.extend(states.iter().map(|_| variant));
        subject.states.extend(states);
    }
    subject.inputs = inputs;
    Ok(subject)
}

struct Search<'s> {
    scene: &'s SceneText<'s>,
    prepared: &'s PreparedMechanism,
    template: Template,
    keys: Vec<Key>,
    /// For each number, the factor of its relative change, between ½ and 1; symmetric entries of a
    /// matrix have the same factor.
    shares: Vec<f64>,
}

/// A mechanism with changed values, and the run that its scene requests.
struct MechanismVariant {
    prepared: PreparedMechanism,
    options: Option<MotionOptions>,
}

impl<'s> Search<'s> {
    fn new(
        scene: &'s SceneText<'s>,
        names: &[String],
        prepared: &'s PreparedMechanism,
    ) -> Result<Self, CodeError> {
        let (mut keys, mut parts) = (Vec::new(), Vec::new());
        for name in names {
            let own = opened(scene.text, name, NESTED)?;
            let first = parts.len();
            parts.extend(own);
            keys.push(Key {
                name: name.clone(),
                numbers: (first..parts.len()).collect(),
            });
        }
        let all: Vec<&str> = parts.iter().map(String::as_str).collect();
        let template = Template::new(scene.text, &all)?;
        let mirrored: Vec<String> = parts.iter().map(|part| sorted(part)).collect();
        let share = |part: &String| {
            let first = mirrored.iter().position(|other| other == part);
            // Multiples of the golden ratio are used, so that no two factors are equal.
            let turns = 0.618_033_988_749_894_8 * (first.unwrap_or(0) + 1) as f64;
            0.5 + 0.5 * turns.fract()
        };
        let shares = mirrored.iter().map(share).collect();
        Ok(Self {
            scene,
            prepared,
            template,
            keys,
            shares,
        })
    }

    /// Returns the text of the scene with some numbers changed by their factors.
    fn changed(
        &self,
        which: impl Fn(usize) -> bool,
        by: f64,
    ) -> Result<MechanismVariant, CodeError> {
        let shares = self.shares.iter().enumerate();
        let shares = shares.map(|(k, share)| if which(k) { by * share } else { 0.0 });
        let shares: Vec<f64> = shares.collect();
        let text = self
            .template
            .changed_by(&shares)
            .ok_or(CodeError::Input(NotAnInput::Switch))?;
        let SceneText {
            name,
            registry,
            drop,
            ..
        } = *self.scene;
        let (prepared, options) = prepared(&SceneText {
            name,
            text: &text,
            registry,
            drop,
        })?;
        Ok(MechanismVariant { prepared, options })
    }

    /// Returns a mechanism with the independent rows of the described mechanism, if the two
    /// mechanisms differ only in their values.
    fn compared(
        &self,
        other: &PreparedMechanism,
        recordings: [&RecordedEquations; 2],
    ) -> Result<PreparedMechanism, NotAnInput> {
        let breaks = |m: &Mechanism| m.layout().break_times.clone();
        let rows = [&self.prepared.decision, &self.prepared.position_decision];
        let [kept, position_kept] = rows.map(|d| d.kept.as_slice());
        if recordings[0].shape() != recordings[1].shape() {
            Err(NotAnInput::Structure)
        } else if breaks(&self.prepared.mechanism) != breaks(&other.mechanism) {
            Err(NotAnInput::BreakTimes)
        } else {
            other.on_rows(kept, position_kept).ok_or(NotAnInput::Rows)
        }
    }

    /// Returns the recording with one changed key. Returns `None` if the scene is not valid when
    /// only this key changes.
    fn alone(
        &self,
        k: usize,
        described: &RecordedEquations,
    ) -> Result<Option<RecordedEquations>, CodeError> {
        let key = &self.keys[k];
        let refused = |why| {
            CodeError::Input(NotAnInput::OfKey {
                key: key.name.clone(),
                why: Box::new(why),
            })
        };
        for share in SHARES.iter().flat_map(|share| [*share, -share]) {
            match self.changed(|n| key.numbers.contains(&n), share) {
                Ok(varied) => {
                    let recording = RecordedEquations::of(&varied.prepared.mechanism);
                    self.compared(&varied.prepared, [described, &recording])
                        .map_err(refused)?;
                    if places_apart(&[described, &recording]).is_empty() {
                        return Err(refused(NotAnInput::Nothing));
                    }
                    return Ok(Some(recording));
                }
                Err(CodeError::Input(why)) => return Err(refused(why)),
                Err(_) => {}
            }
        }
        Ok(None)
    }

    /// Returns a mechanism with all keys changed, and states of its motion.
    fn together(
        &self,
        sign: f64,
        described: &RecordedEquations,
    ) -> Result<(PreparedMechanism, Vec<State>), CodeError> {
        let mut first = None;
        for share in SHARES
            .iter()
            .flat_map(|share| [sign * share, -0.7 * sign * share])
        {
            let moved = self.changed(|_| true, share).and_then(|varied| {
                let recording = RecordedEquations::of(&varied.prepared.mechanism);
                let prepared = self.compared(&varied.prepared, [described, &recording])?;
                let states = match &varied.options {
                    Some(options) => Subject::of_run(&prepared, options)?.states,
                    None => Subject::at_start(&prepared).states,
                };
                Ok((prepared, states))
            });
            match moved {
                Ok(found) => return Ok(found),
                Err(e) => {
                    first.get_or_insert(e);
                }
            }
        }
        Err(CodeError::Varied {
            keys: self.names(),
            reason: first.map_or_else(String::new, |e| e.to_string()),
        })
    }

    fn names(&self) -> Vec<String> {
        self.keys.iter().map(|key| key.name.clone()).collect()
    }

    /// Returns the values that differ. Each value has the keys that change this value.
    fn inputs(
        &self,
        described: &RecordedEquations,
        singles: &[Option<RecordedEquations>],
        together: &[(PreparedMechanism, Vec<State>)],
    ) -> Inputs {
        let together: Vec<RecordedEquations> = together
            .iter()
            .map(|(p, _)| RecordedEquations::of(&p.mechanism))
            .collect();
        let mut all = vec![described];
        all.extend(singles.iter().flatten());
        all.extend(&together);
        let mut inputs = Inputs::new(described.shape(), self.names());
        let mut known: HashMap<Vec<u64>, usize> = HashMap::new();
        for place in places_apart(&all) {
            let values = all.iter().filter_map(|r| r.number(place));
            let bits: Vec<u64> = values.map(f64::to_bits).collect();
            let parameter = *known.entry(bits).or_insert_with(|| {
                let by = self.keys.iter().zip(singles).filter(|(_, single)| {
                    let pair = single.as_ref().map(|s| [described, s]);
                    pair.is_none_or(|pair| differ(&pair, place))
                });
                let by: Vec<&str> = by.map(|(key, _)| key.name.as_str()).collect();
                let by = match by.as_slice() {
                    [] => "all of them together".to_owned(),
                    by => by.join(", "),
                };
                inputs.list.push(Parameter {
                    name: format!("{} ({by})", self.described_place(described, place)),
                    described: described.number(place).unwrap_or(f64::NAN),
                    places: Vec::new(),
                });
                inputs.list.len() - 1
            });
            inputs.add_place(parameter, place);
        }
        inputs
    }

    /// Returns a description of the value at an index.
    fn described_place(&self, recording: &RecordedEquations, place: usize) -> String {
        let mechanism = &self.prepared.mechanism;
        let space = mechanism.space();
        let at = |list: &[joints::RecordedNumber]| list.iter().position(|r| r.place() == place);
        if let Some(column) = at(&recording.beside.mass) {
            let (body, direction) = mechanism.coordinate(column);
            return if space.is_rotation(column) {
                format!("moment of inertia of `{body}`, {direction}")
            } else {
                format!("mass of `{body}`")
            };
        }
        if let Some(column) = at(&recording.weight) {
            let (body, direction) = mechanism.coordinate(column);
            return format!("weight of `{body}`, {direction}");
        }
        for (body, axes) in mechanism.bodies().iter().zip(&recording.beside.principal) {
            if axes.as_ref().and_then(|axes| at(axes)).is_some() {
                return format!("principal axes of `{}`", body.name);
            }
        }
        if let Some(k) = recording
            .beside
            .functions
            .iter()
            .position(|f| at(f).is_some())
        {
            return format!("number of function of time {}", k + 1);
        }
        let mut rows = recording.c.iter().zip(&mechanism.layout().labels);
        let owner = rows.find(|(row, _)| row.iter().any(|(_, r)| r.place() == place));
        if let Some((_, label)) = owner {
            return format!("number of `{}`", label.joint);
        }
        let after = recording
            .owners
            .partition_point(|(first, _)| *first <= place);
        match after.checked_sub(1).map(|k| &recording.owners[k]) {
            Some((_, owner)) => format!("number of `{owner}`"),
            None => "difference of moments of inertia".to_owned(),
        }
    }
}

/// Returns the indices at which the values of recordings with the same shape differ.
fn places_apart(all: &[&RecordedEquations]) -> Vec<usize> {
    let places = 0..all[0].tape.len();
    places.filter(|&place| differ(all, place)).collect()
}

/// Returns whether the values at an index differ by more than their rounding error.
fn differ(all: &[&RecordedEquations], place: usize) -> bool {
    let Some(first) = all[0].number(place) else {
        return false;
    };
    all[1..].iter().any(|other| {
        let other = other.number(place).unwrap_or(f64::NAN);
        let size = f64::max(first.abs(), other.abs());
        let by = (first - other).abs();
        by.is_nan() || by > ROUNDINGS * f64::EPSILON * size
    })
}

/// Returns the keys of the numbers in a list. If the value of the key is not a list, returns the
/// key itself.
fn opened(text: &str, key: &str, depth: usize) -> Result<Vec<String>, CodeError> {
    match Template::new(text, &[key]) {
        Ok(_) => Ok(vec![key.to_owned()]),
        Err(KeyError::NotANumber { parts, .. })
            if depth > 0 && parts.iter().any(|part| part.ends_with(']')) =>
        {
            let own = parts.iter().map(|part| opened(text, part, depth - 1));
            Ok(own.collect::<Result<Vec<_>, _>>()?.concat())
        }
        Err(e) => Err(e.into()),
    }
}

/// Sorts the two indices in the key of a matrix entry: `…[1][0]` becomes `…[0][1]`.
fn sorted(key: &str) -> String {
    let indices = |key: &str| -> Option<(usize, usize, usize)> {
        let (rest, last) = key.strip_suffix(']')?.rsplit_once('[')?;
        let (rest, first) = rest.strip_suffix(']')?.rsplit_once('[')?;
        Some((rest.len(), first.parse().ok()?, last.parse().ok()?))
    };
    match indices(key) {
        Some((end, a, b)) => format!("{}[{}][{}]", &key[..end], a.min(b), a.max(b)),
        None => key.to_owned(),
    }
}
