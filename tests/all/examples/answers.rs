//! Ranks and verdicts of the examples, each derived by hand before the program was run; pages and
//! table are compared with them.

use std::collections::BTreeSet;

use super::{files, page, read, root, scene, study};

/// The results that the page of an example derives.
struct Answer {
    name: &'static str,
    rank: usize,
    redundancy: usize,
    mobility: usize,
    not_unique: &'static [&'static str],
}

const fn answer(
    name: &'static str,
    [rank, redundancy, mobility]: [usize; 3],
    not_unique: &'static [&'static str],
) -> Answer {
    Answer {
        name,
        rank,
        redundancy,
        mobility,
        not_unique,
    }
}

/// The examples are in the order of the table.
const ANSWERS: [Answer; 34] = [
    answer("door", [3, 1, 0], &["lower", "upper"]),
    answer("carriage", [2, 2, 1], &["rear", "front"]),
    answer("truss", [12, 1, 0], &["AB", "BC", "CD", "DA", "AC", "BD"]),
    answer("four-bar", [9, 0, 0], &[]),
    answer("slider-crank", [9, 0, 0], &[]),
    answer("knife-edge", [1, 0, 2], &[]),
    answer("sleigh", [1, 1, 2], &["left", "right"]),
    answer("towed-cart", [6, 1, 0], &["left", "right"]),
    answer("scotch-yoke", [6, 2, 0], &["left", "right"]),
    answer(
        "three-cranks",
        [11, 1, 1],
        &["pivot-1", "tip-1", "pivot-2", "tip-2", "pivot-3", "tip-3"],
    ),
    answer(
        "gear-train",
        [11, 1, 1],
        &["in-1", "in-2", "out-1", "out-2"],
    ),
    answer(
        "planetary-gear",
        [14, 2, 1],
        &["sun-1", "sun-2", "sun-3", "ring-1", "ring-2", "ring-3"],
    ),
    answer("sweeper", [8, 1, 1], &["left-edge", "right-edge"]),
    answer(
        "car",
        [2, 2, 1],
        &["front-left", "front-right", "rear-left", "rear-right"],
    ),
    answer(
        "truck",
        [5, 2, 1],
        &["kingpin", "axle-1", "axle-2", "axle-3", "axle-4", "axle-5"],
    ),
    answer(
        "snakeboard",
        [11, 2, 1],
        &["front-left", "front-right", "rear-left", "rear-right"],
    ),
    answer(
        "pantograph",
        [15, 1, 0],
        &["O", "A", "B", "C", "E", "grip", "rail", "pen"],
    ),
    answer(
        "peaucellier",
        [21, 1, 0],
        &[
            "Q", "O-A", "O-C", "A-1", "A-2", "B-1", "B-2", "C-1", "C-2", "D", "guide",
        ],
    ),
    answer("chebyshev", [8, 1, 1], &["O1", "O2", "A", "B", "guide"]),
    answer(
        "five-bar",
        [12, 1, 0],
        &["A", "B", "C", "D", "E", "motor-A", "motor-B", "motor-E"],
    ),
    answer(
        "scissor-lift",
        [15, 2, 0],
        &[
            "foot-1", "slide-1", "middle-1", "top-1", "roller-1", "foot-2", "slide-2", "middle-2",
            "top-2", "roller-2",
        ],
    ),
    answer("andrews", [20, 0, 1], &[]),
    answer("hinges", [5, 10, 1], &["lower", "middle", "upper"]),
    answer("table", [3, 1, 3], &["A", "B", "C", "D"]),
    answer(
        "wagon",
        [29, 3, 1],
        &[
            "hub-front-left",
            "wheel-front-left",
            "hub-front-right",
            "wheel-front-right",
            "hub-rear-left",
            "wheel-rear-left",
            "hub-rear-right",
            "wheel-rear-right",
        ],
    ),
    answer(
        "robot-in-space",
        [71, 3, 1],
        &[
            "B", "C", "hub-1", "hub-2", "hub-3", "hub-4", "W1", "W2", "W3", "W4",
        ],
    ),
    answer("linkage", [18, 3, 0], &["A", "B", "C", "D"]),
    answer("hooke", [18, 3, 0], &["left", "arm-1", "arm-2", "right"]),
    answer(
        "sarrus",
        [30, 1, 0],
        &["foot-1", "knee-1", "head-1", "foot-2", "knee-2", "head-2"],
    ),
    answer("bricard", [29, 1, 1], &["H1", "H2", "H3", "H4", "H5", "H6"]),
    answer("bennett", [18, 3, 0], &["A", "B", "C", "D"]),
    answer("hexapod", [78, 0, 0], &[]),
    answer("top", [3, 0, 3], &[]),
    answer(
        "robot-trolley",
        [20, 2, 1],
        &["B", "C", "W1", "W2", "W3", "W4"],
    ),
];

#[test]
fn every_verdict_is_the_one_worked_out_by_hand() {
    for expected in &ANSWERS {
        let name = expected.name;
        let study = study(name, &read(&scene(name)));
        let found = study.analyse(0.0, None);
        let a = found.unwrap_or_else(|e| panic!("{name}: {e}")).analysis;
        assert_eq!(
            [a.decision.rank, a.decision.redundancy, a.mobility()],
            [expected.rank, expected.redundancy, expected.mobility],
            "{name}: rank, redundancy and mobility"
        );
        assert!(a.decision.is_decided(), "{name}");
        let words = a.reactions.iter();
        let not_unique: Vec<&str> = words
            .filter(|r| match r.wrench.verdict.word() {
                "unique" => false,
                "not_unique" => true,
                other => panic!("{name}: `{}` is {other}", r.name),
            })
            .map(|r| r.name.as_str())
            .collect();
        // Drives follow the joints, and nonholonomic rows are at the end; the page may list them in
        // any order.
        let sets = [not_unique, expected.not_unique.to_vec()].map(BTreeSet::from_iter);
        assert_eq!(sets[0], sets[1], "{name}");
    }
}

/// No start of an example needs a correction.
#[test]
fn every_start_is_consistent_as_it_is_written() {
    for Answer { name, .. } in &ANSWERS {
        let prepared = study(name, &read(&scene(name))).prepared;
        for correction in [&prepared.assembly.correction, &prepared.velocity_correction] {
            let largest = tests::largest(correction.iter().copied());
            assert!(largest < 1e-12, "{name}: {largest:e}");
        }
    }
}

#[test]
fn every_example_has_a_scene_a_page_and_a_row() {
    let answers: BTreeSet<String> = ANSWERS.iter().map(|a| a.name.to_owned()).collect();
    let mut scenes = files(".toml");
    scenes.insert("robot-trolley".to_owned());
    assert_eq!(scenes, answers, "scenes and answers of the test");
    assert_eq!(files(".md"), answers, "pages and answers of the test");
}

/// Rows of the tables: link, rank, redundancy, mobility, reactions that are not unique, difficulty,
/// purpose, picture.
#[test]
fn the_tables_say_what_is_expected() {
    let text = read(&root().join("examples/README.md"));
    let rows: Vec<Vec<&str>> = text
        .lines()
        .filter(|line| line.starts_with("| ["))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    assert_eq!(rows.len(), ANSWERS.len());
    for expected in &ANSWERS {
        let name = expected.name;
        let numbers = [expected.rank, expected.redundancy, expected.mobility];
        let [rank, redundancy, mobility] = numbers.map(|n| n.to_string());
        let not_unique = match expected.not_unique {
            [] => "none".to_owned(),
            names => names.join(", "),
        };
        let link = format!("[{name}]({name}.md)");
        let row = rows.iter().find(|row| row[0] == link);
        let row = row.unwrap_or_else(|| panic!("{name} has no row"));
        let cells = [link, rank, redundancy, mobility, not_unique];
        assert_eq!(row[..5], cells.each_ref().map(String::as_str), "{name}");
        let picture = format!(
            "<img src=\"../docs/images/examples/{name}.svg\" width=\"160\" alt=\"{name}\">"
        );
        assert_eq!(row[7..], [picture.as_str()], "{name}");
        assert!(["●", "●●", "●●●"].contains(&row[5]), "{name}: {}", row[5]);
        assert!(!row[6].is_empty(), "{name} teaches");
    }
}

/// All pages have the same sections in the same order.
#[test]
fn every_page_has_the_same_parts() {
    for Answer { name, .. } in &ANSWERS {
        let text = page(name);
        let parts: Vec<&str> = text.lines().filter(|l| l.starts_with("## ")).collect();
        let expected = [
            "## Question",
            "## Answer",
            "## Why",
            "## What to do",
            "## What moves",
        ];
        assert_eq!(parts, expected, "{name}");
        assert!(text.starts_with("# "), "{name}");
        let analyses = text.lines().filter(|l| l.starts_with("$ pfaff analyze "));
        assert!(analyses.count() > 0, "{name} shows no answer");
    }
}
