//! The names of MJCF: <https://mujoco.readthedocs.io/en/stable/XMLreference.html>, including names
//! of earlier versions.

use crate::vocabulary::{Entry, Vocabulary};

const SOLVER: &str = "settings of MuJoCo's solver";

/// Elements that bodies and frames may contain.
macro_rules! contents {
    () => {
        "<body> <frame> <joint> <freejoint> <geom> <site> <inertial> <composite> <flexcomp> \
         <replicate> <attach>"
    };
}

/// Attributes of a position.
macro_rules! place {
    () => {
        "pos quat axisangle euler xyaxes zaxis"
    };
}

const PLUGINS: &[(&str, &str)] = &[("plugins", "<plugin>")];

pub(crate) const NAMES: &Vocabulary = &Vocabulary {
    entries: ENTRIES,
    is_open: false,
};

const ENTRIES: &[Entry] = &[
    Entry::new(
        "mujoco",
        "model <compiler> <option> <default> <worldbody> <equality> <keyframe> <actuator> <tendon> \
         <sensor> <contact> <deformable> <extension>",
    )
    .idle("<size> <statistic> <visual> <asset> <custom>"),
    Entry::new(
        "compiler",
        "angle coordinate eulerseq inertiafromgeom inertiagrouprange boundmass boundinertia \
         balanceinertia settotalmass autolimits alignfree",
    )
    .idle(
        "strippath meshdir texturedir assetdir discardvisual usethread fitaabb fusestatic \
         exactmeshinertia saveinertial convexhull conflict <lengthrange>",
    ),
    Entry::new("option", "gravity wind density viscosity magnetic <flag>").left(&[(
        SOLVER,
        "timestep apirate impratio tolerance ls_tolerance noslip_tolerance ccd_tolerance \
         mpr_tolerance sleep_tolerance o_margin o_solref o_solimp o_friction integrator collision \
         cone jacobian solver iterations ls_iterations noslip_iterations ccd_iterations \
         mpr_iterations sdf_iterations sdf_initpoints actuatorgroupdisable",
    )]),
    Entry::new("flag", "gravity spring damper passive equality").left(&[(
        SOLVER,
        "constraint frictionloss limit contact clampctrl warmstart filterparent actuation refsafe \
         sensor midphase eulerdamp autoreset nativeccd island multiccd override energy fwdinv \
         invdiscrete sensornoise sleep diagexact ipc",
    )]),
    Entry::new(
        "default",
        "class <default> <joint> <geom> <site> <equality> <general> <tendon>",
    )
    .idle(
        "<mesh> <material> <camera> <light> <pair> <motor> <position> <velocity> <intvelocity> \
         <orientation> <pid> <damper> <cylinder> <muscle> <adhesion> <dcmotor> <plugin>",
    ),
    Entry::new("default/equality", "active").idle("solref solimp"),
    Entry::new(
        "worldbody",
        concat!("name childclass ", place!(), " ", contents!()),
    )
    .idle("user <camera> <light>")
    .left(PLUGINS),
    Entry::new(
        "body",
        concat!(
            "name childclass mocap gravcomp ",
            place!(),
            " ",
            contents!()
        ),
    )
    .idle("user sleep simple fuse <camera> <light>")
    .left(PLUGINS),
    Entry::new(
        "frame",
        concat!("name childclass ", place!(), " ", contents!()),
    )
    .idle("user <camera> <light>")
    .left(PLUGINS),
    Entry::new(
        "inertial",
        concat!(place!(), " mass diaginertia fullinertia"),
    ),
    Entry::new(
        "joint",
        "name class type pos axis stiffness damping springref ref armature springdamper range \
         limited frictionloss",
    )
    .idle(
        "group margin solreflimit solimplimit solreffriction solimpfriction user actuatorfrcrange \
         actuatorfrclimited actuatorgravcomp",
    ),
    Entry::new("freejoint", "name class align").idle("group limited user"),
    Entry::new(
        "geom",
        concat!(
            "name class type size fromto mass density group shellinertia mesh contype conaffinity ",
            place!()
        ),
    )
    .idle(
        "condim priority material friction solmix solref solimp margin gap surfacevel adhesion \
         hfield fitscale rgba fluidshape fluidcoef user",
    )
    .left(PLUGINS),
    Entry::new("site", concat!("name class fromto ", place!()))
        .idle("type group material mesh size rgba user"),
    Entry::new(
        "equality",
        "<connect> <weld> <joint> <tendon> <flex> <flexvert> <flexstrain> <distance>",
    ),
    Entry::new(
        "connect",
        "name class active body1 body2 site1 site2 anchor",
    )
    .idle("solref solimp"),
    Entry::new(
        "weld",
        "name class active body1 body2 site1 site2 anchor relpose torquescale",
    )
    .idle("solref solimp"),
    Entry::new("equality/joint", "name class active joint1 joint2 polycoef").idle("solref solimp"),
    Entry::new(
        "equality/tendon",
        "name class active tendon1 tendon2 polycoef",
    )
    .idle("solref solimp"),
    Entry::new("mujoco/tendon", "<fixed> <spatial>"),
    Entry::new(
        "tendon/fixed",
        "name class stiffness damping frictionloss armature <joint>",
    )
    .idle(
        "group limited range solreflimit solimplimit solreffriction solimpfriction springlength \
         width material margin rgba user actuatorfrcrange actuatorfrclimited",
    ),
    Entry::new("fixed/joint", "joint coef"),
    Entry::new("keyframe", "<key>"),
    Entry::new("key", "name qpos qvel").idle("time act ctrl mpos mquat"),
];
