//! Units of the lengths and angles that texts print.

use std::cell::Cell;

use super::Prefix;

/// Units of lengths and angles that a scene chooses, with their values in metres and radians.
/// `None` for SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneUnits {
    /// Unit of lengths.
    pub length: Option<(&'static str, f64)>,
    /// Unit of angles.
    pub angle: Option<(&'static str, f64)>,
}

impl SceneUnits {
    /// Returns the unit of the scene that replaces an SI unit, and the value of this unit in the SI
    /// unit.
    ///
    /// ```
    /// let units = pfaff_model::words::SceneUnits { length: Some(("mm", 1e-3)), angle: None };
    /// assert_eq!(units.unit("m/s²"), Some(("mm/s²".to_owned(), 1e-3)));
    /// assert_eq!(units.unit("rad"), None);
    /// ```
    #[must_use]
    pub fn unit(&self, si: &str) -> Option<(String, f64)> {
        let (base, rest) = si.split_at(si.find('/').unwrap_or(si.len()));
        let (name, value) = match base {
            "m" => self.length?,
            "rad" => self.angle?,
            _ => return None,
        };
        Some((format!("{name}{rest}"), value))
    }
}

/// Units of printed quantities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UnitSystem {
    /// Units of the scene, otherwise SI units with prefixes.
    Scene(SceneUnits),
    /// SI units without prefixes.
    Si,
}

impl UnitSystem {
    /// SI units with prefixes.
    const PREFIXED: Self = Self::Scene(SceneUnits {
        length: None,
        angle: None,
    });

    /// Returns the unit for numbers up to this size in an SI unit, and the value of this unit in
    /// the SI unit.
    #[must_use]
    pub fn unit(&self, largest: f64, si: &str) -> (String, f64) {
        let Self::Scene(units) = self else {
            return (si.to_owned(), 1.0);
        };
        units.unit(si).unwrap_or_else(|| {
            let Prefix { symbol, factor } = Prefix::of(largest, si);
            (format!("{symbol}{si}"), factor)
        })
    }

    /// Returns the unit of the scene that replaces an SI unit, otherwise the SI unit, and the value
    /// of this unit in the SI unit.
    #[must_use]
    pub fn unprefixed(&self, si: &str) -> (String, f64) {
        self.unit(1.0, si)
    }
}

thread_local! {
    /// The units of texts that this thread formats, and whether a scene may replace these units.
    static CURRENT: Cell<(UnitSystem, bool)> = const { Cell::new((UnitSystem::PREFIXED, false)) };
}

/// The units of texts that this thread formats.
#[must_use]
pub fn units() -> UnitSystem {
    CURRENT.get().0
}

/// Sets the units back when it is dropped, also after a panic.
struct Former((UnitSystem, bool));

impl Drop for Former {
    fn drop(&mut self) {
        CURRENT.set(self.0);
    }
}

fn with<T>(units: (UnitSystem, bool), format: impl FnOnce() -> T) -> T {
    let _former = Former(CURRENT.replace(units));
    format()
}

/// Calls a function whose texts print lengths and angles in these units: a locale of this thread.
/// Texts of other threads do not change.
///
/// ```
/// use pfaff_model::words::{SceneUnits, UnitSystem, in_units, quantity};
///
/// let millimetres = SceneUnits { length: Some(("mm", 1e-3)), angle: None };
/// let text = || quantity(0.15, "m");
/// assert_eq!(in_units(UnitSystem::Scene(millimetres), text), "150 mm");
/// assert_eq!(text(), "0.15 m");
/// ```
pub fn in_units<T>(units: UnitSystem, format: impl FnOnce() -> T) -> T {
    with((units, false), format)
}

/// Returns a function whose texts have the units of the calling thread, for other threads.
pub fn in_same_units<X, Y>(format: impl Fn(X) -> Y) -> impl Fn(X) -> Y {
    let own = units();
    move |x| in_units(own, || format(x))
}

/// Calls a function that reads scenes. From then on, its texts print lengths and angles in the
/// units of the first scene.
pub fn in_units_of_scenes<T>(format: impl FnOnce() -> T) -> T {
    with((UnitSystem::PREFIXED, true), format)
}

/// States the units of a scene that is read; see [`in_units_of_scenes`].
pub fn read_in(scene: SceneUnits) {
    if let (_, true) = CURRENT.get() {
        CURRENT.set((UnitSystem::Scene(scene), false));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::{estimate, quantity, range, vector};
    use std::panic::catch_unwind;
    use std::thread;

    const DRAWING: SceneUnits = SceneUnits {
        length: Some(("mm", 1e-3)),
        angle: Some(("deg", std::f64::consts::PI / 180.0)),
    };

    #[test]
    fn every_kind_of_quantity_has_the_unit_of_the_scene() {
        let texts = || {
            [
                quantity(-1.25, "m"),
                quantity(0.5, "rad/s"),
                quantity(0.02, "N·m"),
                estimate(std::f64::consts::FRAC_PI_3 / 1e3, "rad"),
                range(-2e-5, 0.1, "m"),
                vector(&[0.25, -1.0], 1.0, "m"),
            ]
        };
        let of_scene = in_units(UnitSystem::Scene(DRAWING), texts);
        let expected = [
            "−1250 mm",
            "28.65 deg/s",
            "20 mN·m",
            "0.06 deg",
            "−0.02 … 100 mm",
            "(250, −1000) mm",
        ];
        assert_eq!(of_scene, expected);
        let si = in_units(UnitSystem::Si, texts);
        let expected = [
            "−1.25 m",
            "0.5 rad/s",
            "0.02 N·m",
            "0.001 rad",
            "−2e-5 … 0.1 m",
            "(0.25, −1) m",
        ];
        assert_eq!(si, expected);
    }

    #[test]
    fn the_first_scene_states_the_units() {
        let inches = SceneUnits {
            length: Some(("in", 0.0254)),
            angle: None,
        };
        read_in(DRAWING);
        assert_eq!(
            quantity(2.54, "m"),
            "2.54 m",
            "no text is formatted for a scene"
        );
        let texts = in_units_of_scenes(|| {
            let before = quantity(2.54, "m");
            read_in(inches);
            read_in(DRAWING);
            [before, quantity(2.54, "m")]
        });
        assert_eq!(texts, ["2.54 m", "100 in"]);
        let si = in_units(UnitSystem::Si, || {
            read_in(inches);
            quantity(2.54, "m")
        });
        assert_eq!(si, "2.54 m");
    }

    #[test]
    fn units_end_with_their_function_and_stay_in_their_thread() {
        let failed = catch_unwind(|| in_units(UnitSystem::Scene(DRAWING), || panic!("wanted")));
        assert!(failed.is_err() && quantity(1.0, "m") == "1 m");
        let other = in_units(UnitSystem::Scene(DRAWING), || {
            thread::spawn(|| quantity(1.0, "m")).join()
        });
        assert_eq!(other.ok().as_deref(), Some("1 m"));
        let other = in_units(UnitSystem::Scene(DRAWING), || {
            let text = in_same_units(|x| quantity(x, "m"));
            thread::spawn(move || text(1.0)).join()
        });
        assert_eq!(other.ok().as_deref(), Some("1000 mm"));
    }
}
