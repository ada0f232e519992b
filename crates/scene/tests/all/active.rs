//! Tests `active = false`: an inactive element is read, checked and reported, but it is not in any
//! list.

use crate::diagnostics::check_in;
use crate::{BODIES, read};

/// Two hinges. A lock, which has a drive and a spring and is part of a sum, is parallel to the
/// second hinge.
const PARTS: &str = r#"
[[joint]]
name = "A"
type = "revolute"
bodies = ["ground", "a"]
at = [1.0, 2.0]

[[joint]]
name = "lock"
type = "revolute"
bodies = ["ground", "a"]
at = [1.0, 3.0]
active = false

[[joint]]
name = "B"
type = "revolute"
bodies = ["ground", "b"]
at = [3.0, 2.0]

[[drive]]
name = "motor"
joint = "lock"
type = "angle"
motion = { type = "table", times = [0, 0.5, 1], values = [0, 1, 2] }
active = false

[[drive]]
name = "other"
joint = "B"
type = "angle"
motion = 0

[[force]]
name = "load"
type = "torque"
body = "a"
torque = 1.0
active = false

[[group]]
name = "both"
members = ["A", "lock"]
active = false

[[group]]
name = "sum"
combine = "A.Fx + B.Fx"

[simulate]
t_end = 2.0
"#;

fn text() -> String {
    format!("{BODIES}{PARTS}")
}

#[test]
fn what_is_not_active_is_in_no_list() {
    let scene = read(&text()).unwrap_or_else(|problems| panic!("{problems:#?}"));
    let d = scene.description.plane().expect("a planar scene").clone();
    let joints: Vec<_> = d.joints.iter().map(|j| j.name.as_str()).collect();
    let drives: Vec<_> = d.drives.iter().map(|x| x.name.as_str()).collect();
    assert_eq!((joints, drives), (vec!["A", "B"], vec!["other"]));
    assert!(d.forces.is_empty());
    let groups: Vec<_> = scene.groups.iter().map(|g| g.name.as_str()).collect();
    assert_eq!(groups, ["sum"]);
    let inactive: Vec<_> = scene.inactive.iter().map(ToString::to_string).collect();
    assert_eq!(
        inactive,
        [
            "joint `lock`",
            "drive `motor`",
            "force `load`",
            "group `both`"
        ]
    );
    // The list of positions contains only the remaining elements.
    let map = scene.source.as_ref().expect("a text");
    let entries: Vec<_> = map.elements().map(|entry| entry.name.as_str()).collect();
    assert_eq!(entries, ["A", "B", "other"]);
    // The command-line option reports the same error.
    let error = scene
        .combination("A.Fx + lock.Fx")
        .expect_err("no reaction");
    assert_eq!(
        error.to_string(),
        "`lock` is not active, so there is no reaction"
    );
    assert!(scene.is_inactive("lock") && !scene.is_inactive("A") && !scene.is_inactive("load"));
}

#[test]
fn a_number_may_say_it() {
    let computed = text()
        .replace("[scene]\n", "[scene]\nformat = 2\n")
        .replace("[simulate]", "[parameters]\nlocked = 1\n[simulate]")
        .replace("active = false", "active = \"locked\"");
    let locked = read(&computed).expect_err("the table of the motor ends before the run");
    assert_eq!(locked.len(), 1, "{locked:#?}");
    assert!(locked[0].message.contains("motor"), "{locked:#?}");
    let locked = read(&computed.replace("t_end = 2.0", "t_end = 1.0")).expect("all is there");
    assert_eq!(
        locked
            .description
            .plane()
            .expect("a planar scene")
            .joints
            .len(),
        3
    );
    assert!(locked.inactive.is_empty());
    let free = read(&computed.replace("locked = 1", "locked = 0")).expect("as before");
    assert_eq!(
        (
            free.description
                .plane()
                .expect("a planar scene")
                .joints
                .len(),
            free.inactive.len()
        ),
        (2, 4)
    );
    let plain = read(&text().replace("active = false", "active = 0")).expect("a number");
    assert_eq!(plain.inactive.len(), 4);
}

#[test]
fn faults_have_their_places() {
    check_in(
        &text(),
        &[(
            "at = [1.0, 3.0]\nactive = false",
            "at = [1.0, 3.0]\nactive = «\"no\"»",
            "joint `lock`: `active` must be true or false, found the text \"no\"",
            "expected true or false",
        )],
    );
    // In each case, one part of the text is replaced.
    let motor = "values = [0, 1, 2] }\nactive = ";
    check_in(
        &text().replace(&format!("{motor}false"), &format!("{motor}0")),
        &[
            (
                "joint = \"lock\"\ntype = \"angle\"\nmotion = { type = \"table\", times = [0, 0.5, 1], values = [0, 1, 2] }\nactive = 0",
                "joint = «\"lock\"»\ntype = \"angle\"\nmotion = { type = \"table\", times = [0, 1, 3], values = [0, 1, 2] }",
                "drive `motor` drives joint `lock`, which is not active",
                "write `active = false` here, too, or remove it from the joint",
            ),
            (
                "members = [\"A\", \"lock\"]\nactive = false",
                "members = [\"A\", «\"lock\"»]",
                "group `both` refers to `lock`, which is not active",
                "not active",
            ),
            (
                "combine = \"A.Fx + B.Fx\"",
                "combine = \"A.Fx + «lock.Fx»\"",
                "group `sum`: `combine`: `lock` is not active, so there is no reaction",
                "here",
            ),
            (
                "[simulate]",
                "[output]\nreactions = [«\"motor\"»]\n[simulate]",
                "`[output]` refers to `motor`, which is not active",
                "not active",
            ),
            // Inactive elements are checked like all others.
            (
                "name = \"lock\"\ntype = \"revolute\"\nbodies = [\"ground\", \"a\"]",
                "name = \"lock\"\ntype = \"revolute\"\nbodies = «[\"ground\", \"ground\"]»",
                "`lock` connects the ground with itself",
                "at least one body must be able to move",
            ),
            (
                "name = \"load\"",
                "name = «\"A\"»",
                "the name `A` is used twice",
                "used again here",
            ),
            // Only rows of active elements are counted: A, B and the drive have five rows.
            (
                "t_end = 2.0",
                "t_end = 2.0\ndrop = [«6»]",
                "`[simulate]`: `drop` names row 6; rows are 1 to 5",
                "no such row",
            ),
        ],
    );
}
