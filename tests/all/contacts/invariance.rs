//! Ranges, kinds and lifts do not depend on how contacts are written down.

use pfaff::solvability::RangeKind;

use super::{Answers, answers, ends, near, study};

/// Kinds and ends of all ranges, and the supports that lift with the accelerations of their gaps.
#[derive(Debug)]
struct Compared {
    ranges: Vec<(RangeKind, [Option<f64>; 2])>,
    lifts: Vec<(String, f64)>,
}

impl Compared {
    fn new(found: Answers) -> Self {
        let ranges = found.ranges.iter();
        let mut lifts = found.lifts;
        lifts.sort_by(|a, b| a.0.cmp(&b.0));
        Self {
            ranges: ranges.map(|range| (range.kind, ends(range))).collect(),
            lifts,
        }
    }

    /// Multiplies all forces and accelerations, and changes the sign of one range.
    fn scaled(mut self, [force, acceleration]: [f64; 2]) -> Self {
        let values = self.ranges.iter_mut().flat_map(|(_, ends)| ends);
        values.flatten().for_each(|x| *x *= force);
        self.lifts.iter_mut().for_each(|(_, a)| *a *= acceleration);
        self
    }

    fn negated(mut self, which: &[usize]) -> Self {
        for k in which {
            let (_, [lowest, highest]) = &mut self.ranges[*k];
            (*lowest, *highest) = (highest.map(|x| -x), lowest.map(|x| -x));
        }
        self
    }

    #[track_caller]
    fn assert_same(&self, other: &Self) {
        let all = self.ranges.iter().flat_map(|(_, ends)| ends).flatten();
        let size = all.fold(1.0_f64, |most, x| most.max(x.abs()));
        assert_eq!(self.ranges.len(), other.ranges.len());
        for ((kind, ends), (other_kind, other_ends)) in self.ranges.iter().zip(&other.ranges) {
            assert_eq!(kind, other_kind, "{self:?} {other:?}");
            for (end, other_end) in ends.iter().zip(other_ends) {
                let same = match (end, other_end) {
                    (Some(a), Some(b)) => near(*a, *b, size),
                    (None, None) => true,
                    _ => false,
                };
                assert!(same, "{self:?} {other:?}");
            }
        }
        let names = |of: &Self| {
            of.lifts
                .iter()
                .map(|(name, _)| name.clone())
                .collect::<Vec<_>>()
        };
        assert_eq!(names(self), names(other));
        for ((_, a), (_, b)) in self.lifts.iter().zip(&other.lifts) {
            assert!(near(*a, *b, 1.0 + a.abs()), "{self:?} {other:?}");
        }
    }
}

/// A beam on three supports and a rope, with a load at x. Each writer changes how one of the
/// contacts is written.
struct Beam {
    x: f64,
    /// Points of the lines of the supports in reverse order.
    reversed: bool,
    /// The rope is written from the beam to the ceiling.
    swapped: bool,
    /// Supports at the bottom of the beam push; seen from above the line, they do not pull.
    pulls: bool,
    order: [usize; 4],
}

const BEAM: Beam = Beam {
    x: 0.7,
    reversed: false,
    swapped: false,
    pulls: false,
    order: [0, 1, 2, 3],
};

impl Beam {
    fn text(&self) -> String {
        let support = |name: &str, x: f64| {
            let [a, b] = if self.reversed {
                [3.0, -2.0]
            } else {
                [-2.0, 3.0]
            };
            let (way, toward) = if self.pulls {
                ("pulls", "[0.4, -1.0]")
            } else {
                ("pushes", "[0.4, 1.0]")
            };
            format!(
                "{{ name = \"{name}\", type = \"point-on-line\", body = \"beam\", at = [{x:?}, 0.0], line = [[{a:?}, 0.0], [{b:?}, 0.0]], \
                 one_sided = \"{way}\", toward = {toward} }},\n"
            )
        };
        let (bodies, at) = if self.swapped {
            ("[\"beam\", \"ground\"]", "[[1.5, 0.0], [2.0, 1.5]]")
        } else {
            ("[\"ground\", \"beam\"]", "[[2.0, 1.5], [1.5, 0.0]]")
        };
        let joints = [
            support("left", 0.0),
            support("middle", 1.0),
            support("right", 2.0),
            format!(
                "{{ name = \"rope\", type = \"distance\", bodies = {bodies}, at = {at}, one_sided = \"pulls\" }},\n"
            ),
        ];
        let joints: String = self.order.iter().map(|k| &joints[*k][..]).collect();
        format!(
            "scene = {{ name = \"beam\", space = \"plane\", gravity = [0.0, -9.81] }}\n\
             body = [{{ name = \"beam\", mass = 3.0, inertia = 0.5, position = [{:?}, 0.0] }}]\n\
             joint = [\n{joints}\
             {{ name = \"stop\", type = \"point-on-line\", body = \"beam\", at = [0.0, 0.0], line = [[0.0, 0.0], [0.0, 1.0]] }},\n]\n",
            self.x
        )
    }

    fn found(&self) -> Compared {
        let names = [
            ("left", "Fy"),
            ("middle", "Fy"),
            ("right", "Fy"),
            ("rope", "Fy"),
        ];
        Compared::new(answers(&self.text(), &names))
    }
}

#[test]
fn ranges_do_not_depend_on_the_order_of_points_bodies_and_joints() {
    // The load between the supports, and beyond the right or the left one: the rope is then slack.
    let cases: [(f64, &[&str]); 3] = [
        (0.7, &[]),
        (2.5, &["left", "middle", "rope"]),
        (-0.3, &["middle", "right", "rope"]),
    ];
    for (x, lifts) in cases {
        let own = || Beam { x, ..BEAM };
        let first = own().found();
        let names: Vec<&str> = first.lifts.iter().map(|(name, _)| &name[..]).collect();
        assert_eq!(names, lifts);
        first.assert_same(
            &Beam {
                reversed: true,
                ..own()
            }
            .found(),
        );
        first.assert_same(
            &Beam {
                pulls: true,
                ..own()
            }
            .found(),
        );
        first.assert_same(
            &Beam {
                pulls: true,
                reversed: true,
                ..own()
            }
            .found(),
        );
        let swapped = Beam {
            swapped: true,
            ..own()
        }
        .found();
        first.assert_same(&swapped.negated(&[3]));
        for order in [[3, 2, 1, 0], [1, 3, 0, 2]] {
            first.assert_same(&Beam { order, ..own() }.found());
        }
    }
}

/// A table in space that may be turned as a whole, with swapped bodies and other normals.
fn table(y: f64, turn: [f64; 3], swapped: bool, pulls: bool, scale: [f64; 2]) -> String {
    let [length, mass] = scale;
    let angle = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
    // Rodrigues' formula.
    let turned = |x: [f64; 3]| -> [f64; 3] {
        if angle == 0.0 {
            return x;
        }
        let k = turn.map(|x| x / angle);
        let along: f64 = x.iter().zip(k).map(|(a, b)| a * b).sum();
        let cross = [
            k[1] * x[2] - k[2] * x[1],
            k[2] * x[0] - k[0] * x[2],
            k[0] * x[1] - k[1] * x[0],
        ];
        let (sin, cos) = angle.sin_cos();
        std::array::from_fn(|i| x[i] * cos + cross[i] * sin + k[i] * along * (1.0 - cos))
    };
    let place = |x: [f64; 3]| turned(x.map(|x| x * length));
    let legs = [[0.6, 0.4], [-0.6, 0.4], [-0.6, -0.4], [0.6, -0.4]];
    let leg = |(name, [x, y]): (&str, [f64; 2])| {
        let bodies = if swapped {
            "\"top\", \"ground\""
        } else {
            "\"ground\", \"top\""
        };
        let up = if swapped == pulls { 1.0 } else { -1.0 };
        let way = if pulls { "pulls" } else { "pushes" };
        format!(
            "{{ name = \"{name}\", type = \"point-on-plane\", bodies = [{bodies}], at = {:?}, normal = {:?}, one_sided = \"{way}\" }},\n",
            place([x, y, 0.0]),
            turned([0.0, 0.0, up])
        )
    };
    let joints: String = ["A", "B", "C", "D"]
        .into_iter()
        .zip(legs)
        .map(leg)
        .collect();
    format!(
        "scene = {{ name = \"table\", space = \"spatial\", gravity = {:?} }}\n\
         body = [{{ name = \"top\", mass = {:?}, inertia = [{:?}, {:?}, {:?}], position = {:?} }}]\njoint = [\n{joints}]\n",
        turned([0.0, 0.0, -9.81 * length]),
        12.0 * mass,
        mass * length * length,
        mass * length * length,
        mass * length * length,
        place([0.2, y, 0.7]),
    )
}

/// The normal of a leg decides where it pushes: the second body along +n. A reversed normal with
/// `pulls` states the same.
#[test]
fn ranges_do_not_depend_on_the_axes_of_the_scene_and_on_swapped_bodies() {
    for y in [0.1, 0.4, 0.47] {
        let legs = |text: &str, turn: [f64; 3]| {
            // The sum of the components along the normal.
            let study = study(text);
            let start = study.analyse(0.0, None).expect("small");
            let solution = start.solution().expect("decided");
            let found = start.permitted(solution).expect("clear").expect("legs");
            let of = |name: &&str| {
                let along = ["Fx", "Fy", "Fz"].into_iter().zip(turn);
                let terms: Vec<(&str, &str, f64)> = along.map(|(c, x)| (*name, c, x)).collect();
                super::range(&start, &found, &terms).expect("clear")
            };
            let mut answers = answers(text, &[]);
            answers.ranges = ["A", "B", "C", "D"].iter().map(of).collect();
            Compared::new(answers)
        };
        let up = [0.0, 0.0, 1.0];
        let of = |swapped, pulls| legs(&table(y, [0.0; 3], swapped, pulls, [1.0; 2]), up);
        let first = of(false, false);
        assert_eq!(first.lifts.is_empty(), y < 0.41, "{first:?}");
        first.assert_same(&of(false, true));
        let all = [0, 1, 2, 3];
        first.assert_same(&of(true, false).negated(&all));
        first.assert_same(&of(true, true).negated(&all));
        for turn in [
            [0.3, -0.5, 1.1],
            [2.0, 1.0, 0.2],
            [0.0, std::f64::consts::PI, 0.0],
        ] {
            let text = table(y, turn, false, false, [1.0; 2]);
            // The normal is that of leg A in the text.
            let (_, rest) = text.split_once("normal = [").expect("a normal");
            let (normal, _) = rest.split_once(']').expect("a list");
            let n: Vec<f64> = normal
                .split(", ")
                .map(|x| x.parse().expect("a number"))
                .collect();
            first.assert_same(&legs(&text, [n[0], n[1], n[2]]));
        }
        // Lengths, with gravity, and masses in other units.
        for (length, mass) in [
            (1e3, 1.0),
            (1.0, 1e-3),
            (1e-3, 1e6),
            (1e-6, 1e-9),
            (1e6, 1e9),
        ] {
            let scaled = legs(&table(y, [0.0; 3], false, false, [length, mass]), up);
            first.assert_same(&scaled.scaled([1.0 / (mass * length), 1.0 / length]));
        }
    }
}

/// The units of a scene.
#[test]
fn ranges_do_not_depend_on_the_units_of_a_scene() {
    let scene = |head: &str, factor: f64| {
        let x = |x: f64| x * factor;
        format!(
            "scene = {{ format = 2, name = \"beam\", space = \"plane\", gravity = [0.0, {:?}]{head} }}\n\
             body = [{{ name = \"beam\", mass = 3.0, inertia = {:?}, position = [{:?}, 0.0] }}]\n\
             joint = [\n\
             {{ name = \"left\", type = \"point-on-line\", body = \"beam\", at = [0.0, 0.0], line = [[0.0, 0.0], [{:?}, 0.0]], one_sided = \"pushes\", toward = [0.0, 1.0] }},\n\
             {{ name = \"middle\", type = \"point-on-line\", body = \"beam\", at = [{:?}, 0.0], line = [[0.0, 0.0], [{:?}, 0.0]], one_sided = \"pushes\", toward = [0.0, 1.0] }},\n\
             {{ name = \"right\", type = \"point-on-line\", body = \"beam\", at = [{:?}, 0.0], line = [[0.0, 0.0], [{:?}, 0.0]], one_sided = \"pushes\", toward = [0.0, 1.0] }},\n]\n",
            x(-9.81),
            x(x(0.5)),
            x(0.7),
            x(1.0),
            x(1.0),
            x(1.0),
            x(2.0),
            x(1.0),
        )
    };
    let names = [("left", "Fy"), ("middle", "Fy"), ("right", "Fy")];
    let metres = Compared::new(answers(&scene("", 1.0), &names));
    let text = scene(", units = { length = \"mm\" }", 1000.0);
    let millimetres = Compared::new(answers(&text, &names));
    assert_eq!(metres.ranges[0].0, RangeKind::Interval);
    metres.assert_same(&millimetres);
}
