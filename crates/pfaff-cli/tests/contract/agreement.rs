//! `check`, `analyze` and `simulate` use the same decision on whether redundant rows are
//! consistent. Their exit codes are equal, and if one command warns, the others do not continue.

use super::{Folder, stderr, stdout, with_scene};

/// A sleeve and a ring with one direction, given in ground axes, are around a rotated body that
/// slides.
const TWO_SLEEVES: &str = r#"
[scene]
name = "sleeve and ring"
space = "spatial"
gravity = [0.0, 0.0, -9.81]
[[body]]
name = "b"
mass = 0.5
inertia = [1.5, 2.0, 2.5]
position = [1.0, -1.0, -1.5]
orientation = { axis = [1, 2, 3], angle = 0.7 }
velocity = [0.0, 0.0, 0.06]
[[joint]]
name = "sleeve"
type = "cylindrical"
bodies = ["b", "ground"]
at = [-0.5, 0.5, 0.5]
axis = [0.0, 0.0, 1.0]
frame = "global"
[[joint]]
name = "ring"
type = "cylindrical"
bodies = ["ground", "b"]
at = [-0.5, 1.0, 1.5]
axis = [0.0, 0.0, 1.0]
frame = "global"
[simulate]
t_end = 0.5
"#;

/// The hip of a robot has three axes through one point, one of them geared to a rotor at that
/// point.
const HIP: &str = r#"
[scene]
name = "walker"
space = "spatial"
gravity = [0.0, 0.0, -9.81]
tolerance = 0.0005
[[body]]
name = "base"
mass = 6.6
inertia = [0.0523, 0.0243, 0.0523]
centre = [-0.02, 0.0, 0.0]
position = [-0.01, 0.0, 0.857]
[[body]]
name = "between"
mass = 0.0
inertia = [0.0, 0.0, 0.0]
position = [-0.01, -0.1, 0.817]
[[body]]
name = "thigh"
mass = 4.75
inertia = [[0.075, 0.0, 0.0], [0.0, 0.0749, 0.00196], [0.0, 0.00196, 0.0083]]
centre = [0.0, 0.005, -0.17]
position = [-0.01, -0.1, 0.817]
[[joint]]
name = "hip xz"
type = "universal"
bodies = ["base", "between"]
points = { "base" = [0.0, -0.1, -0.04], "between" = [0.0, 0.0, 0.0] }
axis = [1.0, 0.0, 0.0]
cross = [0.0, 0.0, 1.0]
[[joint]]
name = "hip y"
type = "revolute"
bodies = ["between", "thigh"]
points = { "between" = [0.0, 0.0, 0.0], "thigh" = [0.0, 0.0, 0.0] }
axis = [0.0, 1.0, 0.0]
[[body]]
name = "rotor"
mass = 0.0
inertia = [0.01, 0.01, 0.01]
position = [-0.01, -0.1, 0.817]
[[joint]]
name = "rotor bearing"
type = "revolute"
bodies = ["ground", "rotor"]
points = { ground = [-0.01, -0.1, 0.817], "rotor" = [0.0, 0.0, 0.0] }
axis = [0.0, 0.0, 1.0]
[[joint]]
name = "rotor gear"
type = "coupling"
measures = ["hip y.angle", "rotor bearing.angle"]
ratio = 1.0
[simulate]
t_end = 0.05
"#;

/// A slider is constrained by two gear meshes and an edge, within a tolerance larger than itself,
/// and a drive moves it.
const HELD_SLIDER: &str = r#"
[scene]
name = "held slider"
space = "plane"
tolerance = 1e-2
[[body]]
name = "b0"
mass = 2.5
inertia = 1e-6
position = [0.001, 0.0015]
[[joint]]
name = "j0"
type = "translational"
bodies = ["ground", "b0"]
at = [-0.0005, -0.0006807982685025955]
axis = [1.0, 0.8]
[[joint]]
name = "j1"
type = "mesh"
bodies = ["ground", "b0"]
at = [[0.0, 0.001], [-0.0005, -0.002]]
ratio = -0.402632377279722
[[joint]]
name = "j2"
type = "mesh"
bodies = ["ground", "b0"]
at = [[0.0, 0.0015], [0.000317492743454, -0.002]]
ratio = -0.75
[[joint]]
name = "j3"
type = "knife-edge"
body = "b0"
at = [0.002, 0.002]
normal = [0.0, -2.0]
[[drive]]
name = "d0"
joint = "j0"
type = "displacement"
motion = { type = "harmonic", amplitude = 2.0, omega = 3.0, phase = 2.0 }
[simulate]
t_end = 0.1
"#;

/// A door has three hinges, the third off the line of the others, and a motor opens it.
fn door(beside: f64, tolerance: f64, motion: &str) -> String {
    let hinges: String = [("a", 0.0, 0.0), ("b", 0.0, 1.0), ("c", beside, 2.0)]
        .iter()
        .map(|(name, x, z)| {
            format!(
                "[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = [\"ground\", \"door\"]\n\
                 at = [{x:?}, 0.0, {z:?}]\naxis = [0.0, 0.0, 1.0]\n"
            )
        })
        .collect();
    format!(
        "[scene]\nname = \"door\"\nspace = \"spatial\"\ngravity = [0.0, 0.0, -9.81]\ntolerance = {tolerance:?}\n\
         [[body]]\nname = \"door\"\nmass = 20.0\ninertia = [5.0, 3.0, 2.0]\nposition = [0.5, 0.0, 1.0]\n{hinges}\
         [[drive]]\nname = \"motor\"\njoint = \"a\"\ntype = \"angle\"\nmotion = {motion}\n\
         [simulate]\nt_end = 0.5\n"
    )
}

/// Returns the exit codes of the three commands, and their output.
fn codes(name: &str, scene: &str) -> ([Option<i32>; 3], String) {
    let folder = Folder::new(name);
    let commands: [&[&str]; 3] = [
        &["check", "-"],
        &["analyze", "-"],
        &["simulate", "-", "--out", folder.text()],
    ];
    let mut said = String::new();
    let codes = commands.map(|arguments| {
        let output = with_scene(arguments, scene);
        said += &stdout(&output);
        said += &stderr(&output);
        output.status.code()
    });
    (codes, said)
}

#[test]
fn rows_that_agree_to_rounding_are_moved_by_all_commands() {
    let opens = "{ type = \"constant-rate\", rate = 1.0 }";
    for (name, scene) in [
        ("agreement-sleeves", TWO_SLEEVES.to_owned()),
        ("agreement-hip", HIP.to_owned()),
        ("agreement-door", door(5e-4, 1e-3, opens)),
    ] {
        let (codes, said) = codes(name, &scene);
        assert_eq!(codes, [Some(0); 3], "{name}: {said}");
        assert!(!said.contains("cannot be simulated"), "{name}: {said}");
        assert!(!said.contains("NEARLY REDUNDANT"), "{name}: {said}");
    }
}

/// The drive moves a coordinate that the joints constrain. This is also an error if data within the
/// tolerance would explain the violation of each joint, and if the motor begins slowly.
#[test]
fn a_drive_that_the_joints_forbid_is_refused_by_all_commands() {
    let opens = "{ type = \"constant-rate\", rate = 1.0 }";
    for (name, scene, drive) in [
        ("agreement-slider", HELD_SLIDER.to_owned(), "d0"),
        ("agreement-jammed", door(5e-4, 1e-5, opens), "motor"),
    ] {
        let (codes, said) = codes(name, &scene);
        assert_eq!(codes, [Some(2); 3], "{name}: {said}");
        assert!(
            said.contains("P0210") && said.contains(&format!("drive `{drive}`")),
            "{said}"
        );
    }
    let slowly = "{ type = \"steps\", start = 0.0, steps = [{ from = 0.1, to = 0.5, by = 1.0 }] }";
    let (codes, said) = codes("agreement-slowly", &door(5e-4, 1e-5, slowly));
    let [check, _, simulate] = codes;
    assert_eq!([check, simulate], [Some(2); 2], "{said}");
}
