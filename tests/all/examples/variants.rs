//! Statements of the pages about variants of their scenes: an additional hinge, a guide less, a
//! misaligned wheel.

use super::{page, read, scene, study};

/// A variant of an example.
struct Neighbour {
    name: &'static str,
    /// Text of the scene, and its replacement.
    edits: &'static [(&'static str, &'static str)],
    /// Joints and drives whose lines are removed.
    without: &'static [&'static str],
    /// Rank, redundancy and mobility.
    numbers: [usize; 3],
    not_unique: &'static [&'static str],
    /// The statement of its page.
    said: &'static str,
}

const PARALLEL: (&str, &str) = ("normal = [-0.8, 0.6]", "normal = [-0.6, 0.8]");

const NEIGHBOURS: [Neighbour; 12] = [
    Neighbour {
        name: "door",
        edits: &[(
            "joint = [",
            r#"joint = [
    { name = "middle", type = "revolute", bodies = ["ground", "leaf"], at = [0.0, 1.0] },"#,
        )],
        without: &[],
        numbers: [3, 3, 0],
        not_unique: &["middle", "lower", "upper"],
        said: "redundancy 3",
    },
    Neighbour {
        name: "carriage",
        edits: &[("\"translational\"", "\"pin-in-slot\"")],
        without: &[],
        numbers: [2, 0, 1],
        not_unique: &[],
        said: "both unique",
    },
    Neighbour {
        name: "scotch-yoke",
        edits: &[(
            "\"left\", type = \"translational\"",
            "\"left\", type = \"pin-in-slot\"",
        )],
        without: &[],
        numbers: [6, 1, 0],
        not_unique: &["left", "right"],
        said: "redundancy 1, on both sides 0",
    },
    Neighbour {
        name: "scotch-yoke",
        edits: &[("\"translational\"", "\"pin-in-slot\"")],
        without: &[],
        numbers: [6, 0, 0],
        not_unique: &[],
        said: "redundancy 1, on both sides 0",
    },
    Neighbour {
        name: "scissor-lift",
        edits: &[(
            r#""top-2", type = "revolute", bodies = ["table", "down-2"],"#,
            r#""top-2", type = "pin-in-slot", bodies = ["table", "down-2"], axis = [1.0, 0.0],"#,
        )],
        without: &["roller-2"],
        numbers: [15, 0, 0],
        not_unique: &[],
        said: "15 rows and redundancy 0",
    },
    // Both steered equally, instead of by the angles for which the lines meet.
    Neighbour {
        name: "car",
        edits: &[
            PARALLEL,
            // It cannot move.
            (", velocity = [1.0, 0.48], angular_velocity = 0.4", ""),
        ],
        without: &[],
        numbers: [3, 1, 0],
        not_unique: &["rear-left", "rear-right"],
        said: "rank 3, mobility 0",
    },
    Neighbour {
        name: "truck",
        edits: &[
            // Turned about the kingpin by 2·atan(1/3).
            (
                "position = [-6.0, 0.0], velocity = [20.0, 0.0]",
                "position = [-5.2, -2.4], angle = 0.6435011087932844",
            ),
            ("velocity = [20.0, 0.0]", "angular_velocity = 0.0"),
            ("at = [-8.5, 0.0]", "point = [-2.5, 0.0]"),
            ("at = [-9.8, 0.0]", "point = [-3.8, 0.0]"),
        ],
        without: &[],
        numbers: [6, 1, 0],
        not_unique: &["axle-1", "axle-2", "axle-3"],
        said: "rank 6",
    },
    Neighbour {
        name: "pantograph",
        edits: &[],
        without: &["pen"],
        numbers: [15, 0, 0],
        not_unique: &[],
        said: "Leave out the guide",
    },
    Neighbour {
        name: "peaucellier",
        edits: &[],
        without: &["guide"],
        numbers: [21, 0, 0],
        not_unique: &[],
        said: "Leave the guide out",
    },
    Neighbour {
        name: "chebyshev",
        edits: &[],
        without: &["guide"],
        numbers: [8, 0, 1],
        not_unique: &[],
        said: "delete its line",
    },
    Neighbour {
        name: "five-bar",
        edits: &[("- motor-B.drive ", "")],
        without: &["motor-B"],
        numbers: [12, 0, 0],
        not_unique: &[],
        said: "delete motor-B",
    },
    // A ring mesh less: planet 1 runs idle.
    Neighbour {
        name: "planetary-gear",
        edits: &[],
        without: &["ring-1"],
        numbers: [14, 1, 1],
        not_unique: &["sun-2", "sun-3", "ring-2", "ring-3"],
        said: "Without `ring-1`",
    },
];

fn edited(neighbour: &Neighbour) -> String {
    let mut text = read(&scene(neighbour.name));
    for (old, new) in neighbour.edits {
        assert!(text.contains(old), "{}: {old}", neighbour.name);
        text = text.replace(old, new);
    }
    let is_out = |line: &&str| {
        let names = neighbour.without.iter();
        names
            .clone()
            .any(|name| line.contains(&format!("{{ name = \"{name}\"")))
    };
    let out = text.lines().filter(is_out).count();
    assert_eq!(out, neighbour.without.len(), "{}", neighbour.name);
    let kept = text.lines().filter(|line| !is_out(line));
    kept.flat_map(|line| [line, "\n"]).collect()
}

#[test]
fn neighbours_are_as_the_pages_say() {
    for neighbour in &NEIGHBOURS {
        let name = neighbour.name;
        let study = study(name, &edited(neighbour));
        let found = study.analyse(0.0, None);
        let a = found.unwrap_or_else(|e| panic!("{name}: {e}")).analysis;
        let numbers = [a.decision.rank, a.decision.redundancy, a.mobility()];
        assert_eq!(numbers, neighbour.numbers, "{name}: {}", neighbour.said);
        let reactions = a.reactions.iter();
        let mut not_unique: Vec<&str> = reactions
            .filter(|r| r.wrench.verdict.word() != "unique")
            .map(|r| r.name.as_str())
            .collect();
        let mut expected = neighbour.not_unique.to_vec();
        not_unique.sort_unstable();
        expected.sort_unstable();
        assert_eq!(not_unique, expected, "{name}: {}", neighbour.said);
        assert!(
            page(name).contains(neighbour.said),
            "{name}: {}",
            neighbour.said
        );
    }
}
