//! Tests `pfaff linearise`: texts, documents, files, errors.

use serde_json::Value;

use super::{Folder, pfaff, stderr, stdout, with_scene};

/// A rod of 2 kg has its mass centre 1.5 m below its pin, with a damper:
/// `5·ÿ + 0.3·ẏ + 29.43·y = push`.
const ROD: &str = r#"
scene = { name = "rod", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "rod", mass = 2.0, inertia = 0.5, position = [0.0, -1.5] }]
joint = [{ name = "pin", type = "revolute", bodies = ["ground", "rod"], at = [0.0, 0.0] }]
force = [
    { name = "oil", type = "torsion-spring-damper", bodies = ["ground", "rod"], stiffness = 0.0, damping = 0.3 },
    { name = "push", type = "torque", body = "rod", torque = 0.0 },
]
"#;

#[test]
fn a_rod_is_linearised_in_words_documents_and_files() {
    let output = with_scene(&["linearise", "-"], ROD);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    for words in [
        "rod at t = 0 s: 1 position, 1 velocity, 1 input",
        "states: rod.angle (rad), rod.omega (rad/s)",
        "inputs: push.torque",
        "−0.03 ± 2.426i",
        "stable: all small motions decay",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let folder = Folder::new("linearised");
    let out = folder.0.join("modes").display().to_string();
    let output = with_scene(&["linearise", "-", "--out", &out, "--json"], ROD);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let d: Value = serde_json::from_str(&stdout(&output)).expect("one document");
    let number = |at: &str| d.pointer(at).and_then(Value::as_f64).expect("a number");
    assert!((number("/second_order/stiffness/0/0") - 29.43).abs() < 1e-11);
    assert!((number("/a/1/0") + 29.43 / 5.0).abs() < 1e-12);
    assert!((number("/b/1/0") - 0.2).abs() < 1e-14);
    assert!((number("/modes/0/real") + 0.03).abs() < 1e-12);
    assert_eq!(d["stability"], "stable");
    // Damped and undamped frequencies follow from λ² + 0.06·λ + 5.886 = 0.
    let natural = 5.886_f64.sqrt();
    let damped = (5.886 - 0.03 * 0.03_f64).sqrt();
    for (key, rate) in [("frequency", damped), ("natural_frequency", natural)] {
        let found = number(&format!("/modes/0/{key}")) * std::f64::consts::TAU;
        assert!((found - rate).abs() < 1e-11, "{key} {found}");
    }
    let [damped, natural] = [damped, natural].map(|x| x / std::f64::consts::TAU);
    assert!(text.contains("damped (Hz)  undamped (Hz)"), "{text}");
    assert!(
        text.contains(&format!("{damped:.4}       {natural:.4}")),
        "{text}"
    );
    let read = |name: &str| {
        let path = std::path::Path::new(&out).join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    assert!(read("a.csv").starts_with("A,rod.angle,rod.omega\nrod.angle,"));
    assert!(read("b.csv").starts_with("B,push.torque\nrod.angle,0\n"));
    assert!(read("k.csv").starts_with("K,rod.angle\nrod.angle,29.4"));
    assert!(
        read("modes.csv")
            .starts_with("mode,real,imaginary,frequency,natural_frequency,damping_ratio,")
    );
    assert!(read("mode-1.html").contains("eigenvalue −0.03 ± 2.426i"));
    assert_eq!(read("linearisation.json"), stdout(&output));
    // A second call replaces its own files.
    let again = with_scene(&["linearise", "-", "--out", &out], ROD);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
}

/// The scene has thirteen wheels without drives, followed by a pendulum.
#[test]
fn modes_that_move_by_themselves_have_pages_before_free_ones() {
    let wheels: String = (1..=13)
        .map(|k| {
            format!(
                "[[body]]\nname = \"w{k}\"\nmass = 1.0\ninertia = 1.0\nposition = [{k}.0, 0.0]\n\
                 [[joint]]\nname = \"a{k}\"\ntype = \"revolute\"\nbodies = [\"ground\", \"w{k}\"]\n\
                 at = [{k}.0, 0.0]\n"
            )
        })
        .collect();
    let scene = format!(
        "[scene]\nname = \"wheels\"\nspace = \"plane\"\ngravity = [0.0, -9.81]\n{wheels}\
         [[body]]\nname = \"rod\"\nmass = 2.0\ninertia = 0.5\nposition = [0.0, -1.5]\n\
         [[joint]]\nname = \"pin\"\ntype = \"revolute\"\nbodies = [\"ground\", \"rod\"]\nat = [0.0, 0.0]\n"
    );
    let folder = Folder::new("linearised-wheels");
    let out = folder.0.join("modes").display().to_string();
    let output = with_scene(&["linearise", "-", "--out", &out, "--json"], &scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let d: Value = serde_json::from_str(&stdout(&output)).expect("one document");
    let modes = d["modes"].as_array().expect("a list");
    let swings = |m: &Value| m["natural_frequency"].as_f64().is_some();
    let swinging = modes.iter().position(swings).expect("the rod swings");
    let page = |k: usize| {
        folder
            .0
            .join("modes")
            .join(format!("mode-{}.html", k + 1))
            .exists()
    };
    assert!(page(swinging));
    assert_eq!((0..modes.len()).filter(|k| page(*k)).count(), 12);
    let again = with_scene(&["linearise", "-", "--out", &out], &scene);
    let text = stdout(&again);
    assert!(
        text.contains("open the pages of the modes in a browser; no pages for modes "),
        "{text}"
    );
    assert!(text.contains("undecided at first order"), "{text}");
}

#[test]
fn what_cannot_be_linearised_is_refused_with_its_code() {
    let aside = ROD.replace("[0.0, -1.5]", "[0.1, -1.5]");
    for (arguments, scene, code, words) in [
        (
            &["linearise", "-"][..],
            aside.as_str(),
            "P0220",
            "body `rod` accelerates by",
        ),
        (
            &["linearise", "-", "--coordinates", "rod.y"],
            ROD,
            "P0222",
            "`rod.y` is not independent",
        ),
        (
            &["linearise", "-", "--coordinates", "bar.x"],
            ROD,
            "P0222",
            "there is no body `bar`",
        ),
        (
            &["linearise", "-", "--follow", "rod.angle"],
            ROD,
            "P0223",
            "the motion depends on `rod.angle`",
        ),
    ] {
        let output = with_scene(arguments, scene);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let text = stderr(&output);
        assert!(
            text.contains(code) && text.contains(words),
            "{arguments:?}: {text}"
        );
    }
    assert_eq!(pfaff(&["linearise"]).status.code(), Some(2));
}
