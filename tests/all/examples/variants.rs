//! Tests statements of the pages about variants of their scenes: an additional hinge, one guide
//! less, a misaligned wheel.

use super::{in_one_line, page, read, scene, study};

/// A variant of an example.
struct Neighbour {
    name: &'static str,
    /// Text of the scene, and the text that replaces it.
    edits: &'static [(&'static str, &'static str)],
    /// Joints and drives whose lines are removed.
    without: &'static [&'static str],
    /// Rank, redundancy and mobility.
    numbers: [usize; 3],
    not_unique: &'static [&'static str],
    /// The statement of the page about the variant.
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
    // Both wheels are steered equally, instead of by the angles for which their normals meet.
    Neighbour {
        name: "car",
        edits: &[
            PARALLEL,
            // The variant cannot move.
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
            // The trailer is rotated about the kingpin by 2·atan(1/3).
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
        said: "Omit the guide",
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
    // Without one ring mesh, planet 1 is idle.
    Neighbour {
        name: "planetary-gear",
        edits: &[],
        without: &["ring-1"],
        numbers: [14, 1, 1],
        not_unique: &["sun-2", "sun-3", "ring-2", "ring-3"],
        said: "Without `ring-1`",
    },
];

/// Variants of the examples in space. The expected results follow from the screws around one loop,
/// and from bodies on parallel lines.
const IN_SPACE: [Neighbour; 15] = [
    Neighbour {
        name: "hinges",
        edits: &[
            (
                r#""lower", type = "revolute", bodies = ["ground", "leaf"], at = [0.0, 0.0, 0.25], axis = [0, 0, 1]"#,
                r#""lower", type = "spherical", bodies = ["ground", "leaf"], at = [0.0, 0.0, 0.25]"#,
            ),
            (
                r#""upper", type = "revolute""#,
                r#""upper", type = "point-on-line""#,
            ),
        ],
        without: &["middle"],
        numbers: [5, 0, 1],
        not_unique: &[],
        said: "3 + 2 rows, redundancy 0",
    },
    Neighbour {
        name: "hinges",
        edits: &[
            (
                r#""middle", type = "revolute""#,
                r#""middle", type = "cylindrical""#,
            ),
            (
                r#""upper", type = "revolute""#,
                r#""upper", type = "cylindrical""#,
            ),
        ],
        without: &[],
        numbers: [5, 8, 1],
        not_unique: &["lower", "middle", "upper"],
        said: "redundancy 8",
    },
    Neighbour {
        name: "linkage",
        edits: &[(r#""C", type = "revolute""#, r#""C", type = "cylindrical""#)],
        without: &[],
        numbers: [18, 2, 0],
        not_unique: &["A", "B", "C", "D"],
        said: "| R R C R | 2 |",
    },
    Neighbour {
        name: "linkage",
        edits: &[(
            r#""D", type = "revolute", bodies = ["ground", "rocker"], at = [1.4, 0.0, 0.0], axis = [0, 0, 1]"#,
            r#""D", type = "spherical", bodies = ["ground", "rocker"], at = [1.4, 0.0, 0.0]"#,
        )],
        without: &[],
        numbers: [18, 1, 0],
        not_unique: &["A", "B", "C", "D"],
        said: "| R R R S | 1 |",
    },
    Neighbour {
        name: "linkage",
        edits: &[
            (
                r#""C", type = "revolute", bodies = ["coupler", "rocker"], at = [1.5, 1.1, 0.0], axis = [0, 0, 1]"#,
                r#""C", type = "spherical", bodies = ["coupler", "rocker"], at = [1.5, 1.1, 0.0]"#,
            ),
            (r#""D", type = "revolute""#, r#""D", type = "cylindrical""#),
        ],
        without: &[],
        numbers: [18, 0, 0],
        not_unique: &[],
        said: "| R R S C, R S C R | 0 |",
    },
    Neighbour {
        name: "linkage",
        edits: &[
            (
                r#""B", type = "revolute", bodies = ["crank", "coupler"], at = [0.3, 0.8, 0.0], axis = [0, 0, 1]"#,
                r#""B", type = "spherical", bodies = ["crank", "coupler"], at = [0.3, 0.8, 0.0]"#,
            ),
            (r#""C", type = "revolute""#, r#""C", type = "cylindrical""#),
        ],
        without: &[],
        numbers: [18, 0, 0],
        not_unique: &[],
        said: "| R R S C, R S C R | 0 |",
    },
    Neighbour {
        name: "linkage",
        edits: &[
            (
                r#""B", type = "revolute", bodies = ["crank", "coupler"], at = [0.3, 0.8, 0.0], axis = [0, 0, 1]"#,
                r#""B", type = "spherical", bodies = ["crank", "coupler"], at = [0.3, 0.8, 0.0]"#,
            ),
            (
                r#""C", type = "revolute", bodies = ["coupler", "rocker"], at = [1.5, 1.1, 0.0], axis = [0, 0, 1]"#,
                r#""C", type = "spherical", bodies = ["coupler", "rocker"], at = [1.5, 1.1, 0.0]"#,
            ),
        ],
        without: &[],
        numbers: [17, 0, 1],
        not_unique: &[],
        said: "| R S S R | 0 |",
    },
    Neighbour {
        name: "hooke",
        edits: &[(
            r#""right", type = "revolute""#,
            r#""right", type = "point-on-line""#,
        )],
        without: &[],
        numbers: [18, 0, 0],
        not_unique: &[],
        said: "`point-on-line` in place of `revolute`",
    },
    Neighbour {
        name: "hooke",
        edits: &[(
            r#""right", type = "revolute""#,
            r#""right", type = "cylindrical""#,
        )],
        without: &[],
        numbers: [18, 2, 0],
        not_unique: &["left", "arm-1", "arm-2", "right"],
        said: "leaves redundancy 2",
    },
    Neighbour {
        name: "hooke",
        edits: &[(
            r#""arm-1", type = "revolute", bodies = ["input", "cross"], at = [0.0, 0.0, 0.0], axis = [0, 0, 1]"#,
            r#""fork", type = "universal", bodies = ["input", "output"], at = [0.0, 0.0, 0.0], axis = [0, 0, 1], cross = [-3, 4, 0]"#,
        )],
        without: &["cross", "arm-2"],
        numbers: [12, 3, 0],
        not_unique: &["left", "fork", "right"],
        said: "14 rows of rank 11",
    },
    Neighbour {
        name: "bennett",
        edits: &[
            (
                r#""B", type = "revolute", bodies = ["crank", "coupler"], at = [0.0, 3.0, 0.0], axis = [3, 0, 4]"#,
                r#""B", type = "spherical", bodies = ["crank", "coupler"], at = [0.0, 3.0, 0.0]"#,
            ),
            (r#""C", type = "revolute""#, r#""C", type = "cylindrical""#),
        ],
        without: &[],
        numbers: [18, 0, 0],
        not_unique: &[],
        said: "17 rows of the joints, redundancy 0",
    },
    Neighbour {
        name: "sarrus",
        edits: &[(
            r#""head-2", type = "revolute", bodies = ["upper-2", "plate"], at = [0.0, 1.0, 0.6], axis = [1, 0, 0]"#,
            r#""head-2", type = "universal", bodies = ["upper-2", "plate"], at = [0.0, 1.0, 0.6], axis = [1, 0, 0], cross = [0, 0, 1]"#,
        )],
        without: &[],
        numbers: [30, 0, 0],
        not_unique: &[],
        said: "the redundancy is 0, the motion is the same",
    },
    Neighbour {
        name: "bricard",
        edits: &[(
            r#""H4", type = "revolute""#,
            r#""H4", type = "cylindrical""#,
        )],
        without: &[],
        numbers: [29, 0, 1],
        not_unique: &[],
        said: "redundancy 0, and all reactions are unique",
    },
    Neighbour {
        name: "table",
        edits: &[],
        without: &["D"],
        numbers: [3, 0, 3],
        not_unique: &[],
        said: "Take one leg away",
    },
    Neighbour {
        name: "wagon",
        edits: &[
            (
                r#""front-left"], at = [0.6, 0.4, 0.3], axis = [0, 1, 0]"#,
                r#""front-left"], at = [0.6, 0.4, 0.3], axis = [-0.19866933079506122, 0.9800665778412416, 0.0]"#,
            ),
            (
                r#""front-left", point = [0.0, 0.0, 0.0], axis = [0, 1, 0]"#,
                r#""front-left", point = [0.0, 0.0, 0.0], axis = [-0.19866933079506122, 0.9800665778412416, 0.0]"#,
            ),
            (
                r#""front-right"], at = [0.6, -0.4, 0.3], axis = [0, 1, 0]"#,
                r#""front-right"], at = [0.6, -0.4, 0.3], axis = [-0.19866933079506122, 0.9800665778412416, 0.0]"#,
            ),
            (
                r#""front-right", point = [0.0, 0.0, 0.0], axis = [0, 1, 0]"#,
                r#""front-right", point = [0.0, 0.0, 0.0], axis = [-0.19866933079506122, 0.9800665778412416, 0.0]"#,
            ),
        ],
        without: &[],
        numbers: [30, 2, 0],
        not_unique: &[
            "hub-front-left",
            "hub-front-right",
            "hub-rear-left",
            "hub-rear-right",
            "wheel-front-left",
            "wheel-front-right",
            "wheel-rear-left",
            "wheel-rear-right",
        ],
        said: "rank 30, redundancy 2, mobility 0",
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
    for neighbour in NEIGHBOURS.iter().chain(&IN_SPACE) {
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
            in_one_line(&page(name)).contains(&in_one_line(neighbour.said)),
            "{name}: {}",
            neighbour.said
        );
    }
}
