//! The names of URDF: <https://wiki.ros.org/urdf/XML>.

use crate::vocabulary::{Entry, Vocabulary};

pub(crate) const NAMES: &Vocabulary = &Vocabulary {
    entries: ENTRIES,
    is_open: true,
};

const ENTRIES: &[Entry] = &[
    Entry::new(
        "robot",
        "name <link> <joint> <loop_joint> <drake:ball_constraint> <gazebo> <transmission> \
         <ros2_control>",
    )
    .idle("version <material>"),
    Entry::new("link", "name <inertial> <collision>")
        .idle("type <visual>")
        .left(&[
            (
                "contacts of links",
                "<contact> <collision_checking> <self_collision_checking>",
            ),
            ("sensors and devices", "<sensor>"),
        ]),
    Entry::new("inertial", "<origin> <mass> <inertia>"),
    Entry::new("origin", "xyz rpy quat_xyzw"),
    Entry::new("mass", "value"),
    Entry::new("inertia", "ixx iyy izz ixy ixz iyz"),
    Entry::new(
        "joint",
        "name type <origin> <parent> <child> <axis> <limit> <dynamics> <mimic>",
    )
    .left(&[(
        "controllers and calibrations",
        "<safety_controller> <calibration>",
    )]),
    Entry::new("loop_joint", "name type <link1> <link2> <axis>").idle("<limit> <dynamics>"),
    Entry::new("link1", "link xyz rpy"),
    Entry::new("link2", "link xyz rpy"),
    Entry::new("parent", "link"),
    Entry::new("child", "link"),
    Entry::new("axis", "xyz"),
    Entry::new("dynamics", "damping friction"),
    Entry::new("limit", "lower upper").idle(
        "effort velocity acceleration deceleration jerk gear_velocity command_effort current",
    ),
    Entry::new("mimic", "joint multiplier offset"),
];
