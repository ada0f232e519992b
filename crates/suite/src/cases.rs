//! The cases of the suite by name.

use crate::closed_forms;
use crate::reference::Reference;
use crate::table;

/// A mechanism with a known motion.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name of the case and of its scene.
    pub name: &'static str,
    /// A short description.
    pub title: &'static str,
    /// The scene, with the duration and an output step. All times of the reference are multiples of
    /// this step.
    pub scene: &'static str,
    known: Known,
}

/// The source of the reference.
#[derive(Clone, Copy, Debug)]
enum Known {
    Table(&'static str),
    Formula(fn() -> Reference),
}

impl Case {
    /// Returns the reference values of the motion of the mechanism.
    ///
    /// ```
    /// // The three cranks start from the angle of 30° with the angular acceleration −(1.5·mc + M)·g·sin θ/((mc + M)·L).
    /// let start = suite::find("three-cranks").unwrap().reference().instants[0].clone();
    /// let alpha = start.facts.iter().find(|f| f.quantity == suite::Quantity::Alpha).unwrap().value;
    /// assert!((alpha + 4.8 * 9.81 * 0.5 / (4.2 * 0.5)).abs() < 1e-14);
    /// ```
    #[must_use]
    pub fn reference(&self) -> Reference {
        match self.known {
            Known::Table(text) => table::read(text),
            Known::Formula(formula) => formula(),
        }
    }
}

/// Defines a case of this crate. The names of the files are derived from the name of the case.
macro_rules! case {
    ($name:literal, $title:literal) => {
        case!(
            $name,
            $title,
            Known::Table(include_str!(concat!("../references/", $name, ".txt")))
        )
    };
    ($name:literal, $title:literal, $known:expr) => {
        case!(
            $name,
            $title,
            include_str!(concat!("../scenes/", $name, ".toml")),
            $known
        )
    };
    ($name:literal, $title:literal, $scene:expr, $known:expr) => {
        Case {
            name: $name,
            title: $title,
            scene: $scene,
            known: $known,
        }
    };
}

/// The scene of the robot with its trolley.
pub const ROBOT: &str = include_str!("../scenes/robot-trolley.toml");

/// Cases for the comparison of methods. The cases have different difficulties, and each run takes
/// less than a second.
pub const COMPARED: [Case; 11] = [
    case!(
        "robot-trolley",
        "Robot with trolley, two redundant rows",
        ROBOT,
        Known::Table(include_str!("../references/robot-trolley.txt"))
    ),
    case!("three-cranks", "Three cranks, one redundant row"),
    case!("turning-cranks", "Three cranks that turn over"),
    case!("n-four-bar", "N-four-bar, N = 2 (A02)"),
    case!("andrews", "Andrews' squeezing mechanism"),
    case!("a01-pendulum", "Pendulum (A01), 10 s"),
    case!("sleigh", "Chaplygin sleigh"),
    case!(
        "knife-edge",
        "Knife edge on a slope",
        Known::Formula(closed_forms::knife_edge)
    ),
    case!(
        "rolling-disk",
        "Vertical rolling disk",
        Known::Formula(closed_forms::rolling_disk)
    ),
    case!("stiff-spring-pendulum", "Spring pendulum, k = 10⁴"),
    case!("stiff-cranks", "Three cranks, spring of 10¹²"),
];

/// Cases that only test the accuracy of a method.
pub const CHECKED: [Case; 3] = [
    case!("a01-pendulum-2000s", "Pendulum (A01), 2000 s"),
    case!("sundials-pendulum", "Pendulum with a period of 2 s"),
    case!("cash-pendulum", "Pendulum of a point mass, 1 s"),
];

/// Every case.
pub fn all() -> impl Iterator<Item = &'static Case> {
    COMPARED.iter().chain(&CHECKED)
}

/// Finds the case with this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Case> {
    all().find(|case| case.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::Kind;

    #[test]
    fn every_case_has_facts_of_its_own_and_says_how_far_to_trust_them() {
        for case in all() {
            let reference = case.reference();
            assert!(
                case.scene.contains(&format!("name = \"{}\"", case.name)),
                "{}",
                case.name
            );
            assert!(reference.source.len() > 20, "{}", case.name);
            let times: Vec<f64> = reference.instants.iter().map(|i| i.t).collect();
            assert!(
                !times.is_empty() && times.is_sorted_by(|a, b| a < b),
                "{}: {times:?}",
                case.name
            );
            for fact in reference.instants.iter().flat_map(|i| &i.facts) {
                let named = format!("name = \"{}\"", fact.of);
                assert!(case.scene.contains(&named), "{}: {fact:?}", case.name);
                let bound = reference.trust.of(fact.quantity.kind());
                assert!(
                    fact.value.is_finite() && bound > 0.0 && bound <= 1e-9,
                    "{}: {fact:?}",
                    case.name
                );
            }
            let kinds = [Kind::Position, Kind::Velocity];
            for kind in kinds {
                let known = |i: &crate::Instant| i.facts.iter().any(|f| f.quantity.kind() == kind);
                assert!(
                    reference.instants.iter().all(known),
                    "{}: no {kind:?}",
                    case.name
                );
            }
        }
    }
}
