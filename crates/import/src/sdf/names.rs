//! The names of SDF: <http://sdformat.org/spec>, versions 1.3 to 1.12.

use crate::vocabulary::{Entry, Vocabulary};

const SIMULATOR: &str = "settings of a simulator";
const DEVICES: &str = "sensors and devices";

pub(crate) const NAMES: &Vocabulary = &Vocabulary {
    entries: ENTRIES,
    is_open: true,
};

const ENTRIES: &[Entry] = &[
    Entry::new("sdf", "version <world> <model> <include>")
        .idle("<light>")
        .left(&[("settings of the world", "<actor>")]),
    Entry::new("world", "name <model> <gravity> <include> <joint> <frame>")
        .idle("<light> <scene> <gui>")
        .left(&[(
            "settings of the world",
            "<physics> <magnetic_field> <atmosphere> <audio> <wind> <plugin> <road> \
             <spherical_coordinates> <state> <population> <actor>",
        )]),
    Entry::new(
        "model",
        "name canonical_link placement_frame <link> <joint> <pose> <frame> <static> <model> \
         <include> <plugin>",
    )
    .idle("namespace")
    .left(&[
        (
            SIMULATOR,
            "<self_collide> <allow_auto_disable> <enable_wind>",
        ),
        ("grippers", "<gripper>"),
    ]),
    Entry::new(
        "include",
        "merge <uri> <name> <pose> <placement_frame> <static> <plugin>",
    ),
    Entry::new("link", "name <pose> <inertial> <collision> <gravity>")
        .idle("<visual> <light> <must_be_base_link>")
        .left(&[
            (SIMULATOR, "<self_collide> <kinematic> <enable_wind>"),
            (
                "dampers of links: accelerations differ while the links move",
                "<velocity_decay>",
            ),
            (
                DEVICES,
                "<sensor> <projector> <audio_sink> <audio_source> <battery> <particle_emitter>",
            ),
            ("frames within links", "<frame>"),
        ]),
    Entry::new("inertial", "auto <pose> <mass> <inertia> <density>")
        .idle("<auto_inertia_params>")
        .left(&[
            (
                "masses of a fluid around a link: accelerations differ",
                "<fluid_added_mass>",
            ),
            ("frames within links", "<frame>"),
        ]),
    Entry::new("collision", "name <pose> <geometry> <density>")
        .idle("<auto_inertia_params> <laser_retro> <max_contacts> <surface>")
        .left(&[("frames within links", "<frame>")]),
    Entry::new(
        "geometry",
        "<empty> <box> <capsule> <cone> <cylinder> <ellipsoid> <sphere>",
    )
    .idle("<heightmap> <image> <mesh> <plane> <polyline>"),
    Entry::new("box", "<size>"),
    Entry::new("capsule", "<radius> <length>"),
    Entry::new("cone", "<radius> <length>"),
    Entry::new("cylinder", "<radius> <length>"),
    Entry::new("ellipsoid", "<radii>"),
    Entry::new("sphere", "<radius>"),
    Entry::new("inertia", "<ixx> <iyy> <izz> <ixy> <ixz> <iyz>"),
    Entry::new("pose", "relative_to frame degrees rotation_format"),
    Entry::new("frame", "name attached_to <pose>"),
    Entry::new(
        "joint",
        "name type <parent> <child> <pose> <axis> <axis2> <screw_thread_pitch> <thread_pitch> \
         <gearbox_ratio> <gearbox_reference_body>",
    )
    .left(&[
        (SIMULATOR, "<physics>"),
        (DEVICES, "<sensor>"),
        ("frames within joints", "<frame>"),
    ]),
    // In `<gazebo>` of a URDF the name may be an attribute.
    Entry::new("parent", "link"),
    Entry::new("child", "link"),
    Entry::new(
        "axis",
        "<xyz> <use_parent_model_frame> <limit> <dynamics> <mimic>",
    )
    .left(&[("first positions of joints", "<initial_position>")]),
    Entry::new(
        "axis2",
        "<xyz> <use_parent_model_frame> <limit> <dynamics> <mimic>",
    )
    .left(&[("first positions of joints", "<initial_position>")]),
    Entry::new("xyz", "expressed_in"),
    Entry::new("limit", "<lower> <upper> <effort>").idle("<velocity> <stiffness> <dissipation>"),
    Entry::new(
        "dynamics",
        "<damping> <friction> <spring_reference> <spring_stiffness>",
    ),
    Entry::new("mimic", "joint axis <multiplier> <offset> <reference>"),
];
