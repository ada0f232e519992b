//! Drives from the actuators of each format.

use pfaff_import::{Drives, ImportedScene, Options};

use super::{import_text, read, value};

fn with(text: &str, drives: Drives) -> ImportedScene {
    let options = Options {
        drives,
        ..Options::default()
    };
    import_text(text, &options)
}

/// The names of the drives, with their joint, coordinate and load.
fn drives(done: &ImportedScene) -> Vec<String> {
    let tables = done.scene.split("[[drive]]\n").skip(1);
    let of = |table: &str| {
        let table = table.split("\n\n").next().unwrap_or_default();
        let values = table.lines().filter_map(|line| line.split_once(" = "));
        let values: Vec<String> = values
            .map(|(key, value)| format!("{key} {value}"))
            .collect();
        values.join(", ").replace('"', "")
    };
    tables.map(of).collect()
}

/// The kinds of the omissions, with their subjects.
fn left(done: &ImportedScene) -> Vec<(&str, &str)> {
    let omissions = done.omissions.iter();
    omissions
        .map(|omission| (omission.kind, omission.subject.as_str()))
        .collect()
}

const CONTENT: &str = "gear ratios, laws and limits of actuators: a drive acts on the joint itself";
const DEPENDENT: &str = "actuators of joints that follow other joints or are locked";
const SECOND: &str = "further actuators of joints that have a drive";

/// A cart on a slide with a spring, an arm with a follower and a ball joint.
fn cart(actuators: &str) -> String {
    format!(
        "<mujoco><worldbody><body name='cart'>\
         <joint name='slide' type='slide' axis='1 0 0' stiffness='2'/><geom size='0.1' contype='0' conaffinity='0'/>\
         <body name='arm'><joint name='hip' axis='0 1 0'/><geom size='0.1' contype='0' conaffinity='0'/>\
         <body name='hand'><joint name='knee' axis='0 1 0'/><geom size='0.1' contype='0' conaffinity='0'/>\
         <body name='tip' pos='0 0 1'><joint name='ball' type='ball'/><geom size='0.1' contype='0' conaffinity='0'/></body></body>\
         </body></body></worldbody><equality><joint joint1='knee' joint2='hip'/></equality>\
         <actuator>{actuators}</actuator></mujoco>"
    )
}

#[test]
fn actuators_of_mjcf_become_drives() {
    let text = cart(
        "<motor name='push' joint='slide'/><position name='hip' joint='hip' kp='9'/>\
         <velocity name='brake' joint='hip'/><general name='bend' joint='knee'/>\
         <motor name='turn' joint='ball'/><motor name='pull' tendon='t'/>",
    );
    let springs = ["name slide spring, joint slide, type displacement, force -2.0*(measure - 0.0)"];
    assert_eq!(drives(&with(&text, Drives::None)), springs);
    let done = with(&text, Drives::Torque);
    assert_eq!(
        drives(&done)[..2],
        [
            "name push, joint slide, type displacement, force 0",
            // A joint has the name of this actuator.
            "name hip drive, joint hip, type angle, torque 0",
        ]
    );
    assert_eq!(
        left(&done),
        [
            (CONTENT, "hip"),
            (SECOND, "brake"),
            (DEPENDENT, "bend"),
            ("actuators", "turn"),
            ("actuators", "pull"),
        ]
    );
    let remark = "Drives from actuators: `push` on `slide`, `hip drive` on `hip`.";
    assert!(
        done.remarks.iter().any(|r| r == remark),
        "{:?}",
        done.remarks
    );
    read(&done);
    let held = with(&text, Drives::Position);
    assert_eq!(
        drives(&held)[..2],
        [
            "name push, joint slide, type displacement, motion 0",
            "name hip drive, joint hip, type angle, motion 0",
        ]
    );
    read(&held);
}

/// A motor without gear and limits becomes a drive as a whole. A model without actuators has no
/// drives, because MJCF states all actuators.
#[test]
fn the_content_of_an_actuator_is_told() {
    for (motor, kinds) in [
        ("<motor name='m' joint='hip'/>", vec![]),
        (
            "<motor name='m' joint='hip' gear='1 0 0 0 0 0'/>",
            vec![(CONTENT, "m"); 0],
        ),
        (
            "<motor name='m' joint='hip' gear='50'/>",
            vec![(CONTENT, "m")],
        ),
        (
            "<motor name='m' joint='hip' ctrlrange='-1 1'/>",
            vec![(CONTENT, "m")],
        ),
        ("<general name='m' joint='hip'/>", vec![(CONTENT, "m")]),
    ] {
        assert_eq!(left(&with(&cart(motor), Drives::Torque)), kinds, "{motor}");
    }
    // Defaults of one kind of actuator apply to all kinds.
    let defaults = "<mujoco><default><general gear='3'/></default>";
    let text = cart("<motor name='m' joint='hip'/>").replace("<mujoco>", defaults);
    assert_eq!(left(&with(&text, Drives::Torque)), [(CONTENT, "m")]);
    let done = with(&cart(""), Drives::Torque);
    assert_eq!(drives(&done).len(), 1);
    assert!(
        done.remarks
            .iter()
            .any(|r| r.starts_with("No joint has a drive"))
    );
}

/// The two coordinates of a universal joint have one drive each.
#[test]
fn parts_of_a_joint_have_their_own_drives() {
    let text = "<mujoco><worldbody><body><joint name='a' axis='1 0 0'/><joint name='b' axis='0 1 0'/>\
        <geom size='0.1' contype='0' conaffinity='0'/></body></worldbody><actuator><motor joint='b'/><motor joint='a'/></actuator>\
        </mujoco>";
    let done = with(text, Drives::Torque);
    let joint = value(&done.scene, "drive", "b drive", "joint").expect("a joint");
    let joint = joint.replace('"', "");
    assert_eq!(
        drives(&done),
        [
            format!("name b drive, joint {joint}, type second, torque 0"),
            format!("name a drive, joint {joint}, type first, torque 0"),
        ]
    );
    read(&done);
}

fn robot(more: &str) -> String {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' \
             ixz='0' iyz='0'/></inertial></link>"
        )
    };
    let joint = |name: &str, kind: &str, parent: &str, child: &str, more: &str| {
        format!(
            "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>\
             <axis xyz='0 0 1'/>{more}</joint>"
        )
    };
    let links: String = ["base", "a", "b", "c", "d"].map(link).concat();
    let joints = [
        joint("lift", "prismatic", "base", "a", ""),
        joint("turn", "continuous", "a", "b", ""),
        joint("grip", "revolute", "b", "c", "<mimic joint='turn'/>"),
        joint("mount", "fixed", "b", "d", ""),
    ];
    format!("<robot name='r'>{links}{}{more}</robot>", joints.concat())
}

#[test]
fn transmissions_of_urdf_become_drives() {
    let transmission = |joint: &str, reduction: &str| {
        format!(
            "<transmission name='t'><joint name='{joint}'/><actuator name='motor of {joint}'>\
             <mechanicalReduction>{reduction}</mechanicalReduction></actuator></transmission>"
        )
    };
    let done = with(&robot(&transmission("turn", "1")), Drives::Torque);
    assert_eq!(
        drives(&done),
        ["name motor of turn, joint turn, type angle, torque 0"]
    );
    assert!(done.omissions.is_empty(), "{:?}", done.omissions);
    for (joint, reduction, kind) in [
        ("turn", "50", CONTENT),
        ("grip", "1", DEPENDENT),
        ("mount", "1", "actuators"),
        ("none", "1", "actuators"),
    ] {
        let done = with(&robot(&transmission(joint, reduction)), Drives::Torque);
        assert_eq!(left(&done), [(kind, "t")], "{joint}");
    }
    let control = "<ros2_control name='c' type='system'><joint name='turn'><command_interface \
                   name='effort'/></joint><joint name='lift'><state_interface name='position'/>\
                   </joint></ros2_control>";
    let done = with(&robot(control), Drives::Position);
    assert_eq!(
        drives(&done),
        ["name turn drive, joint turn, type angle, motion 0"]
    );
    assert_eq!(left(&done), [(CONTENT, "<ros2_control> `c`")]);
    let none = with(&robot(control), Drives::None);
    assert_eq!(
        (left(&none), drives(&none).len()),
        (vec![("actuators", "<ros2_control> `c`")], 0)
    );
}

/// Many files of URDF and SDF state no actuators. In this case every independent joint with one
/// freedom has a drive, except joints that cannot have an effort.
#[test]
fn joints_without_actuators_have_drives() {
    let done = with(&robot(""), Drives::Torque);
    assert_eq!(
        drives(&done),
        [
            "name lift drive, joint lift, type displacement, force 0",
            "name turn drive, joint turn, type angle, torque 0",
        ]
    );
    assert!(
        done.remarks
            .iter()
            .any(|r| r.starts_with("The file has no actuators: each"))
    );
    read(&done);
    let joint = |name: &str, parent: &str, child: &str, effort: &str| {
        format!(
            "<joint name='{name}' type='revolute'><parent>{parent}</parent><child>{child}</child>\
             <axis><xyz>0 0 1</xyz><limit><effort>{effort}</effort></limit></axis></joint>"
        )
    };
    let model = |more: &str| {
        let joints = joint("a", "world", "x", "-1")
            + &joint("b", "x", "y", "0")
            + &joint("c", "x", "z", "2");
        format!(
            "<sdf version='1.9'><model name='m'><link name='x'/><link name='y'/><link name='z'/>\
             {joints}{more}</model></sdf>"
        )
    };
    let names = |more: &str| -> Vec<String> {
        let done = with(&model(more), Drives::Torque);
        read(&done);
        drives(&done)
            .iter()
            .map(|drive| drive.split(',').next().unwrap_or_default().to_owned())
            .collect()
    };
    assert_eq!(names(""), ["name a drive", "name c drive"]);
    // Controllers of Gazebo name their joints.
    let plugin = |name: &str, joints: &str| {
        format!(
            "<plugin name='gz::sim::systems::{name}' filename='gz-sim-system'>{joints}</plugin>"
        )
    };
    let position = plugin("JointPositionController", "<joint_name>b</joint_name>");
    assert_eq!(names(&position), ["name b drive"]);
    assert_eq!(left(&with(&model(&position), Drives::Torque))[0].0, CONTENT);
    assert_eq!(left(&with(&model(&position), Drives::None))[0].0, "plugins");
    let wheels = "<right_joint>c</right_joint><left_joint>a</left_joint><topic>b</topic>";
    assert_eq!(
        names(&plugin("DiffDrive", wheels)),
        ["name c drive", "name a drive"]
    );
    // Without names, a trajectory has all joints of the model.
    let all = ["name a drive", "name b drive", "name c drive"];
    assert_eq!(names(&plugin("JointTrajectoryController", "")), all);
}
