//! Random mechanisms that move, in the plane and in space. Submechanisms with more constraints than
//! necessary are mounted on carriers that rotate, slide or roll. In most initial configurations
//! bodies are upright, straight or perpendicular. The drawings of the suites of exact arithmetic,
//! under gravity, are also used.

mod carriers;
mod pieces;
mod sketch;

use crate::fuzz::exact::families::Family as OfPlane;
use crate::fuzz::exact::pose::{Posed, Writing};
use crate::fuzz::exact::text as text_of_plane;
use crate::fuzz::scenes::Space;
use crate::fuzz::space::families::Family as OfSpace;
use crate::fuzz::space::text::{self as text_of_space, Precision};
use suite::numbers::Numbers;

use carriers::{Carrier, drive_one};
use pieces::Stand;
use sketch::{Place, Sketch};

/// End time of all runs (s).
pub const T_END: f64 = 0.5;
/// Number of output steps.
pub const STEPS: usize = 6;

/// A scene of the campaign.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Description of the contents.
    pub family: String,
    /// Text of the scene.
    pub text: String,
}

/// Scene `number` of a seed.
#[must_use]
pub fn scene(seed: u64, number: u64) -> Scene {
    let mut numbers = Numbers::new(seed ^ Numbers::new(number).bits());
    let space = if number.is_multiple_of(2) {
        Space::Plane
    } else {
        Space::Space
    };
    if numbers.once_in(6) {
        drawn(space, &mut numbers)
    } else {
        sketched(space, &mut numbers)
    }
}

/// Returns a drawing of the suites of exact arithmetic, with gravity in any direction.
fn drawn(space: Space, numbers: &mut Numbers) -> Scene {
    let precision = Precision {
        gravity: [0; 3].map(|_| 9.0 * numbers.unit()),
        ..Precision::default()
    };
    let (name, text) = match space {
        Space::Plane => {
            let family = OfPlane::ALL[numbers.below(OfPlane::ALL.len())];
            let drawing = family.draw(numbers);
            let posed = Posed::new(&drawing, Writing::Reordered, numbers);
            let text = text_of_plane::text_within(&posed, &precision);
            (family.name(), text)
        }
        Space::Space => {
            let family = OfSpace::ALL[numbers.below(OfSpace::ALL.len())];
            let text = text_of_space::text_within(&family.draw(numbers), &precision);
            (family.name(), text)
        }
    };
    Scene {
        family: format!("{}: drawn, {name}", word(space)),
        text: text + &ending(),
    }
}

fn word(space: Space) -> &'static str {
    match space {
        Space::Plane => "plane",
        Space::Space => "space",
    }
}

fn ending() -> String {
    let step = T_END / STEPS as f64;
    format!("\n[simulate]\nt_end = {T_END:?}\noutput_step = {step:?}\n")
}

type Piece = fn(&mut Sketch<'_>, &Place, &Stand) -> Stand;

/// Submechanisms with their names.
const PIECES: [(&str, Piece); 6] = [
    ("cranks", pieces::cranks),
    ("chain", pieces::chain),
    ("slider", pieces::slider),
    ("gears", pieces::gears),
    ("braced body", pieces::braced),
    ("slightly off", pieces::slightly_off),
];

/// Returns one or two submechanisms on a carrier.
fn sketched(space: Space, numbers: &mut Numbers) -> Scene {
    let carrier = Carrier::ALL[numbers.below(Carrier::ALL.len())];
    let (name, piece) = PIECES[numbers.below(PIECES.len())];
    let gravity = match numbers.below(4) {
        0 => [0.0; 3],
        1 => [0.0, -9.81, 0.0],
        2 => [0.0, 0.0, -9.81],
        _ => [3.0, -8.0, -4.0],
    };
    let mut s = Sketch::new(space, numbers);
    let gravity = s.written(gravity);
    let place = s.place();
    let stand = carrier.draw(&mut s, &place);
    let first = s.measured.len();
    let mut family = format!("{}: {name} {}", word(space), carrier.name());
    let tip = piece(&mut s, &place, &stand);
    if s.numbers.once_in(4) {
        // The second submechanism is mounted at the tip of the first submechanism.
        family.push_str(", and another piece");
        let (_, another) = PIECES[s.numbers.below(PIECES.len())];
        another(&mut s, &place, &tip);
    }
    if s.numbers.once_in(3) {
        let from = [tip.1[0] - 0.35, tip.1[1] + 0.4];
        s.spring(&place, [&sketch::ground(), &tip.0], [from, tip.1]);
    }
    drive_one(&mut s, first, 4);
    let kind = match space {
        Space::Plane => "plane",
        Space::Space => "spatial",
    };
    let head = format!(
        "[scene]\nname = \"numbers\"\nspace = \"{kind}\"\nformat = 2\ngravity = {gravity}\n"
    );
    Scene {
        family,
        text: head + &s.finish() + &ending(),
    }
}
