//! Elements of other programs that change the mechanism: each closes the loop of one four-bar, or
//! is refused by name.

use model::{Mechanism, System};
use pfaff_import::{ImportedScene, Options};

use super::{import_text, read, refused, value};

/// A crank of 0.3 m, a coupler of 0.4 m and a rocker of 0.3 m, and more content. The end of the
/// coupler is at the end of the rocker.
fn four_bar(more: &str) -> String {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0 0 -0.1'/><mass value='1'/>\
             <inertia ixx='0.01' iyy='0.01' izz='0.001' ixy='0' ixz='0' iyz='0'/></inertial></link>"
        )
    };
    let joint = |name: &str, parent: &str, child: &str, at: &str| {
        format!(
            "<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/>\
             <origin xyz='{at}'/><axis xyz='0 1 0'/></joint>"
        )
    };
    format!(
        "<robot name='r' xmlns:drake='http://drake.mit.edu'><link name='base'/>{}{}{}{}{}{}\n{more}</robot>",
        link("crank"),
        link("rocker"),
        link("coupler"),
        joint("A", "base", "crank", "0 0 0"),
        joint("B", "base", "rocker", "0.4 0 0"),
        joint("C", "crank", "coupler", "0 0 -0.3"),
    )
}

/// The number of rows of a scene, and its independent motions by Grübler's count in space.
fn rows(imported: &ImportedScene) -> usize {
    let mechanism = Mechanism::build(&read(imported).description).expect("a mechanism");
    mechanism.layout().m
}

const LOOP: &str = "<loop_joint name='D' type='continuous'>\
    <link1 link='coupler' rpy='0 0 0' xyz='0.4 0 0'/><link2 link='rocker' rpy='0 0 0' xyz='0 0 -0.3'/>\
    <axis xyz='0 1 0'/></loop_joint>";

const BALL: &str = "<drake:ball_constraint><drake:ball_constraint_body_A name='coupler'/>\
    <drake:ball_constraint_body_B name='rocker'/><drake:ball_constraint_p_AP value='0.4 0 0'/>\
    <drake:ball_constraint_p_BQ value='0 0 -0.3'/></drake:ball_constraint>";

const DETACHABLE: &str = "<gazebo><plugin filename='gz-sim-detachable-joint-system' \
    name='gz::sim::systems::DetachableJoint'><parent_link>coupler</parent_link>\
    <child_model>r</child_model><child_link>rocker</child_link></plugin></gazebo>";

#[test]
fn loops_of_other_programs_are_closed() {
    let open = import_text(&four_bar(""), &Options::default());
    assert_eq!((open.counts, rows(&open)), ([3, 3], 15));
    for (text, name, kind, more) in [
        (LOOP, "D", "revolute", 5),
        (BALL, "ball_constraint_1", "spherical", 3),
        (DETACHABLE, "coupler holds rocker", "fixed", 6),
    ] {
        let closed = import_text(&four_bar(text), &Options::default());
        assert_eq!(
            (closed.counts, rows(&closed)),
            ([3, 4], 15 + more),
            "{name}"
        );
        let found = value(&closed.scene, "joint", name, "type");
        assert_eq!(
            found.as_deref(),
            Some(format!("\"{kind}\"").as_str()),
            "{}",
            closed.scene
        );
        assert!(closed.omissions.is_empty(), "{:?}", closed.omissions);
    }
    // A prefix of another program is not the constraint of Drake.
    let other = BALL.replace("drake:", "own:");
    let other = four_bar(&other).replace("xmlns:drake", "xmlns:own");
    assert_eq!(refused(&other).diagnostics[0].code.to_string(), "P0608");
}

#[test]
fn an_open_loop_is_not_closed_silently() {
    let far = LOOP.replace("0.4 0 0", "4 0 0");
    assert_eq!(
        refused(&four_bar(&far)).diagnostics[0].code.to_string(),
        "P0613"
    );
}

#[test]
fn other_content_that_changes_the_mechanism_is_refused_by_name() {
    let mimic = "<gazebo><plugin name='m' filename='libroboticsgroup_gazebo_mimic_joint_plugin.so'>\
        <joint>A</joint><mimicJoint>B</mimicJoint></plugin></gazebo>";
    for (text, name, advice) in [
        (
            "<drake:linear_bushing_rpy/>",
            "linear_bushing_rpy",
            "halfway between both frames; a `bushing` uses the rotation vector",
        ),
        ("<drake:rubber_bushing/>", "rubber_bushing", "add a force"),
        ("<drake:tendon_constraint/>", "tendon_constraint", "add"),
        ("<loop_closure link='a'/>", "loop_closure", "<loop_joint>"),
        (mimic, "mimic", "<mimic joint"),
        (&DETACHABLE.replace(">r<", ">box<"), "`box`", ""),
        (&LOOP.replace("'continuous'", "'helical'"), "helical", ""),
        (
            &LOOP.replace("'coupler'", "'copuler'"),
            "copuler",
            "coupler",
        ),
        (&LOOP.replace("'coupler'", "'rocker'"), "itself", ""),
        (&BALL.replace("p_AP", "p_AX"), "ball_constraint_p_AP", ""),
    ] {
        let refusal = refused(&four_bar(text));
        let problem = &refusal.diagnostics[0];
        assert!(problem.message.contains(name), "{name}: {problem}");
        let help = problem.help.as_deref().unwrap_or_default();
        assert!(help.contains(advice), "{name}: {help}");
        assert_eq!(problem.primary.line, 2, "{name}");
    }
}
