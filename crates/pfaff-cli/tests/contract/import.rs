//! Tests the answers of `pfaff import`: counts, exit codes, documents.

use std::fs;

use serde_json::Value;

use super::{Folder, pfaff, stdout, with_scene};

/// A pendulum with an armature; the moments of inertia are given.
fn pendulum(moments: &str) -> String {
    format!(
        "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' armature='0.1'/>\
         <inertial pos='0 0 -0.5' mass='1' diaginertia='{moments}'/></body></worldbody></mujoco>"
    )
}

/// An armature is a key of its joint, and the answer of `import` counts the armatures.
#[test]
fn armatures_are_keys_of_joints() {
    let folder = Folder::new("import-armatures");
    fs::create_dir_all(&folder.0).expect("a folder");
    let out = folder.0.join("scene.toml").display().to_string();
    let arguments = ["import", "-", "--out", &out];
    let words = stdout(&with_scene(&arguments, &pendulum("0.1 0.1 0.01")));
    let counts = "MJCF: 1 body, 1 joint or coupling with 1 armature (gyroscopic terms of rotors";
    assert!(words.starts_with(counts), "{words}");
    let scene = fs::read_to_string(&out).expect("a scene");
    assert!(scene.contains("\narmature = 0.1\n"), "{scene}");
    let checked = stdout(&pfaff(&["check", &out]));
    assert!(checked.contains("1 body, 1 joint"), "{checked}");
}

/// No real body has moments of which one is above the sum of the others. The scene is written, so
/// that it can be corrected, and the command ends with an error.
#[test]
fn a_scene_with_an_error_is_no_success() {
    let folder = Folder::new("import-error");
    fs::create_dir_all(&folder.0).expect("a folder");
    let out = folder.0.join("scene.toml").display().to_string();
    let text = pendulum("0.1 0.1 0.9");
    let output = with_scene(&["import", "-", "--out", &out], &text);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stdout(&output).contains("body `rod`"),
        "{}",
        stdout(&output)
    );
    assert!(fs::read_to_string(&out).is_ok_and(|scene| scene.contains("[[body]]")));
    let arguments = ["import", "-", "--out", &out, "--force", "--json"];
    let output = with_scene(&arguments, &text);
    assert_eq!(output.status.code(), Some(1));
    let document: Value = serde_json::from_str(&stdout(&output)).expect("one document");
    assert_eq!(document["ok"], false);
    assert_eq!(document["armatures"], 1);
    assert!(document["scene_error"].is_string(), "{document}");
}

/// The drive replaces the motor, and the motion can be computed.
#[test]
fn actuators_become_drives() {
    let folder = Folder::new("import-drives");
    fs::create_dir_all(&folder.0).expect("a folder");
    let out = folder.0.join("scene.toml").display().to_string();
    let motor = "<actuator><motor name='motor' joint='hinge' gear='9'/></actuator></mujoco>";
    let text = pendulum("0.1 0.1 0.01").replace("</mujoco>", motor);
    let words = stdout(&with_scene(&["import", "-", "--out", &out], &text));
    assert!(
        words.contains("omitted: actuators: motor (line 1)"),
        "{words}"
    );
    let arguments = [
        "import", "-", "--out", &out, "--force", "--drives", "torque",
    ];
    let words = stdout(&with_scene(&arguments, &text));
    assert!(
        words.contains("note: Drives from actuators: `motor` on `hinge`."),
        "{words}"
    );
    assert!(words.contains("omitted: gear ratios"), "{words}");
    let arguments = [
        "import", "-", "--out", &out, "--force", "--drives", "position",
    ];
    stdout(&with_scene(&arguments, &text));
    let checked = stdout(&pfaff(&["check", &out]));
    assert!(checked.contains("2 joints and drives"), "{checked}");
}

/// The other model of the file is reported.
#[test]
fn one_model_of_a_file_is_chosen() {
    let folder = Folder::new("import-model");
    fs::create_dir_all(&folder.0).expect("a folder");
    let out = folder.0.join("scene.toml").display().to_string();
    let model = |name: &str| {
        format!(
            "<model name='{name}'><link name='rod'/><joint name='pin' type='ball'>\
             <parent>world</parent><child>rod</child></joint></model>"
        )
    };
    let text = format!("<sdf version='1.9'>{}{}</sdf>", model("a"), model("b"));
    let arguments = ["import", "-", "--out", &out, "--model", "b"];
    let words = stdout(&with_scene(&arguments, &text));
    assert!(
        words.starts_with("SDF: 1 body, 1 joint or coupling"),
        "{words}"
    );
    assert!(
        words.contains("omitted: models that are not chosen: a (line 1)"),
        "{words}"
    );
    let output = with_scene(&["import", "-", "--out", &out, "--model", "c"], &text);
    assert_eq!(output.status.code(), Some(2));
}
