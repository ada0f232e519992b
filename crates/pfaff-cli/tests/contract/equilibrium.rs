//! Tests `pfaff equilibrium`: texts, documents, files, errors.

use serde_json::Value;

use super::{Folder, pfaff, stderr, stdout, with_scene};

/// A horizontal rod of 2 kg is on a torsion spring of 100 N·m/rad: it leans by about −0.1 rad.
const ROD: &str = r#"[scene]
name = "rod"
space = "plane"
gravity = [0.0, -10.0]

[[body]] # steel
name = "rod"
mass = 2.0
inertia = 0.5
position = [0.5, 0.0]
angular_velocity = 3.0

[[joint]]
name = "pin"
type = "revolute"
bodies = ["ground", "rod"]
at = [0.0, 0.0]

[[force]]
name = "coil"
type = "torsion-spring-damper"
bodies = ["ground", "rod"]
stiffness = 100.0
damping = 1.0
"#;

#[test]
fn a_rod_rests_in_words_documents_and_files() {
    let output = with_scene(&["equilibrium", "-"], ROD);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    for words in [
        "rod: equilibrium found in ",
        "(functions of time at t = 0 s): forces balance",
        "stable: every displacement causes a restoring force",
        "\nrod   0.0497",
        "reaction  Fx (N)  Fy (N)",
        " −20     unique",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let folder = Folder::new("rested");
    let out = folder.0.join("rest").display().to_string();
    let output = with_scene(&["equilibrium", "-", "--out", &out, "--json"], ROD);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let d: Value = serde_json::from_str(&stdout(&output)).expect("one document");
    let turned = d["bodies"]["rod"]["turned"].as_f64().expect("a number");
    assert!((100.0 * turned + 10.0 * turned.cos()).abs() < 1e-13);
    let at = d["bodies"]["rod"]["at"]["x"].as_f64().expect("a number");
    assert!((at - 0.5 * turned.cos()).abs() < 1e-15);
    assert_eq!(
        (&d["stability"], &d["file"]),
        (&"stable".into(), &"at-rest.toml".into())
    );
    let pin = &d["reactions"]["pin"];
    assert_eq!(pin["verdict"], "unique");
    assert!((pin["values"]["Fy"]["value"].as_f64().expect("a number") + 20.0).abs() < 1e-12);
    let file = |name: &str| {
        let path = std::path::Path::new(&out).join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    assert_eq!(file("equilibrium.json"), stdout(&output));
    let scene = file("at-rest.toml");
    assert!(
        scene.contains("[[body]] # steel\nstart = { position = ["),
        "{scene}"
    );
    assert!(scene.contains("angular_velocity = 0\n"), "{scene}");
    // It remains there, may be linearised, and a second call replaces its own files.
    let there = format!("{out}/at-rest.toml");
    let run = folder.0.join("run").display().to_string();
    let output = pfaff(&["simulate", &there, "--out", &run, "--t-end", "1"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(
        !stdout(&output).contains("do not trust"),
        "{}",
        stdout(&output)
    );
    let output = pfaff(&["linearise", &there]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let again = with_scene(&["equilibrium", "-", "--out", &out], ROD);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
}

#[test]
fn an_upright_rod_is_left_when_it_is_asked() {
    let upright = ROD
        .replace("[0.5, 0.0]", "[0.0, 0.5]")
        .replace("100.0", "1.0");
    let output = with_scene(&["equilibrium", "-"], &upright);
    let text = stdout(&output);
    let words = "unstable along: `rod` turns about `pin`; `--stable` skips unstable equilibria";
    assert!(
        text.contains("the start is an equilibrium") && text.contains(words),
        "{text}"
    );
    let output = with_scene(&["equilibrium", "-", "--stable"], &upright);
    let text = stdout(&output);
    assert!(
        text.contains(" after 1 perturbation ") && text.contains("\nstable: "),
        "{text}"
    );
}

#[test]
fn what_does_not_rest_is_refused_with_its_code() {
    let driven = format!(
        "{ROD}\n[[drive]]\nname = \"motor\"\njoint = \"pin\"\ntype = \"angle\"\nmotion = {{ type = \"constant-rate\", rate = 2.0 }}\n"
    );
    let driven = driven.replace("angular_velocity = 3.0\n", "");
    let free = ROD
        .replace("stiffness = 100.0", "stiffness = 0.0")
        .replace("\"pin\"", "\"pin\"\nactive = false");
    for (scene, code, words) in [
        (
            &driven,
            "P0225",
            "drive `motor` prescribes 2 rad/s at the start",
        ),
        (
            &free,
            "P0226",
            "`rod` slides along (0, −1), pushed with 20 N by the weight",
        ),
    ] {
        let output = with_scene(&["equilibrium", "-"], scene);
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        let text = stderr(&output);
        assert!(text.contains(code) && text.contains(words), "{text}");
    }
    assert_eq!(pfaff(&["equilibrium"]).status.code(), Some(2));
    let output = with_scene(&["equilibrium", "-", "--force"], ROD);
    assert_eq!(output.status.code(), Some(2));
}

/// A motor supports a horizontal rod and swings it from there. At rest the motor carries only its
/// weight, and small motions about the written start are those with locked drives.
#[test]
fn drives_are_held_without_acceleration() {
    let swung = format!(
        "{}\n[[drive]]\nname = \"motor\"\njoint = \"pin\"\ntype = \"angle\"\n\
         motion = {{ type = \"harmonic\", amplitude = 0.4, omega = 5.0, phase = 1.5707963267948966 }}\n",
        ROD.replace("angular_velocity = 3.0\n", "")
    );
    let folder = Folder::new("rested-driven");
    let out = folder.0.join("rest").display().to_string();
    let output = with_scene(&["equilibrium", "-", "--out", &out], &swung);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    for words in [
        "drives locked at t = 0 s: `motor`",
        "a simulation from this position starts with other forces, because these functions of time have\naccelerations: `motor`",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let read = |name: &str| folder.read(&format!("rest/{name}"));
    let d: Value = serde_json::from_str(&read("equilibrium.json")).expect("one document");
    // The torque is 2 kg · 10 m/s² · 0.5 m; the acceleration would add (0.5 + 2·0.25)·0.4·25 N·m.
    let torque = d["reactions"]["motor"]["values"]["T"]["value"]
        .as_f64()
        .expect("a number");
    assert!((torque.abs() - 10.0).abs() < 1e-12, "{torque}");
    let output = pfaff(&["linearise", &format!("{out}/at-rest.toml")]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    assert!(
        text.contains("locked at t = 0 s, because the state is at rest: `motor`"),
        "{text}"
    );
}
