//! Compiles the modules of all scenes: without imports, also without the standard library, for one
//! state and for several states at once.

use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use dynamics::{KeptRowMotion, simulate};
use pfaff::model::Registry;
use pfaff::{AssembledScene, RunOptions, Study};
use pfaff_scene_codegen::{Choices, Subject, generate};

mod space;

#[rustfmt::skip]
#[path = "generated/linkage.rs"]
mod linkage;

/// Number of states of each scene.
const STATES: usize = 4;

struct Expected {
    scene: String,
    values: Vec<f64>,
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("a folder for generated files");
    folder
}

fn rustc(folder: &Path, arguments: &[&str]) {
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let output = Command::new(compiler)
        .current_dir(folder)
        .args(["--edition", "2024", "-D", "warnings"])
        .args(arguments)
        .output()
        .expect("the compiler runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

fn study(name: &str, text: &str) -> Study {
    AssembledScene::read(name, text, &Registry::standard())
        .and_then(|b| b.prepare(&RunOptions::default()))
        .unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Returns names and texts of the scenes of the suite and of the scenes in space, except those with
/// the longest compilation.
fn cases() -> Vec<(String, String)> {
    let cases = suite::all().filter(|case| case.name != "a01-pendulum-2000s");
    let cases = cases.map(|case| (case.name.to_owned(), case.scene.to_owned()));
    let spatial = space::scenes().into_iter();
    cases
        .chain(
            spatial.filter(|scene| {
                !["delta", "hexapod", "robot-in-space"].contains(&scene.0.as_str())
            }),
        )
        .collect()
}

fn subject<'a>(study: &'a Study, name: &str) -> Subject<'a> {
    let options = study.options.as_ref().expect("the scene has a run");
    Subject::of_run(&study.prepared, options).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Prints the bits of accelerations that are computed for one state at a time, and asserts that the
/// results for several states at once have the same bits.
const HARNESS: &str = "
macro_rules! run { ($m:ident, $states:expr) => {{
    use $m::*;
    let states: [(f64, [f64; N_Q], [f64; N_V]); 4] = $states;
    let (mut t4, mut q4, mut v4) = ([0.0; 4], [[0.0; 4]; N_Q], [[0.0; 4]; N_V]);
    let (mut a, mut a4) = ([0.0; N_V], [[0.0; 4]; N_V]);
    for (l, (t, q, v)) in states.iter().enumerate() {
        t4[l] = *t;
        for k in 0..N_Q { q4[k][l] = q[k]; }
        for k in 0..N_V { v4[k][l] = v[k]; }
    }
    let health = acceleration_of(&t4, &q4, &v4, &mut a4);
    for (l, (t, q, v)) in states.iter().enumerate() {
        assert_eq!(acceleration(*t, q, v, &mut a), health[l]);
        assert!(health[l].abs() > 0.02, \"{}\", health[l]);
        for k in 0..N_V { assert_eq!(a[k], a4[k][l]); }
        let bits: Vec<String> = a.iter().map(|x| x.to_bits().to_string()).collect();
        println!(\"{}\", bits.join(\" \"));
    }
}}; }
";

#[test]
fn compiled_modules_have_the_accelerations_of_the_interpreter() {
    let folder = folder("modules");
    let mut source = String::from(HARNESS);
    let mut main = String::from("fn main() {\n");
    let mut expected = Vec::new();
    for (name, text) in cases() {
        let study = study(&name, &text);
        let subject = subject(&study, &name);
        let module = generate(&subject, &Choices::default()).expect("every scene has code");
        let mut motion = KeptRowMotion::new(&study.prepared).expect("moves");
        let mut states = String::new();
        let every = (subject.states.len() / STATES).max(1);
        for state in subject.states.iter().step_by(every).take(STATES) {
            let mut values = vec![0.0; state.v.len()];
            motion
                .acceleration(state.t, &state.q, &state.v, &mut values)
                .expect("solves");
            let scene = name.clone();
            expected.push(Expected { scene, values });
            write!(states, "({:?}, {:?}, {:?}),", state.t, state.q, state.v).expect("a string");
        }
        source += &module.as_item();
        writeln!(main, "run!({}, [{states}]);", module.name).expect("a string");
    }
    std::fs::write(folder.join("main.rs"), source + &main + "}\n").expect("written");
    rustc(&folder, &["-C", "opt-level=1", "main.rs", "-o", "main"]);
    let output = Command::new(folder.join("main")).output().expect("runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(output.stdout).expect("numbers");
    assert_eq!(text.lines().count(), expected.len());
    for (line, Expected { scene, values }) in text.lines().zip(expected) {
        let found = line
            .split(' ')
            .map(|bits| f64::from_bits(bits.parse().expect("bits")));
        let size = values.iter().fold(1.0, |a: f64, x| a.max(x.abs()));
        for (found, value) in found.zip(values) {
            assert!(
                (found - value).abs() < 1e-10 * size,
                "{scene}: {found} {value}"
            );
        }
    }
}

#[test]
fn modules_compile_without_the_standard_library() {
    let folder = folder("no-std");
    let stub = "#![no_std]
        pub fn sincos(_: f64) -> (f64, f64) { (0.0, 1.0) }
        pub fn sqrt(x: f64) -> f64 { x }";
    std::fs::write(folder.join("libm.rs"), stub).expect("written");
    rustc(
        &folder,
        &["--crate-type", "rlib", "--crate-name", "libm", "libm.rs"],
    );
    let choices = Choices {
        libm: true,
        ..Choices::default()
    };
    let mut source = String::from("#![no_std]\n");
    for name in ["andrews", "rolling-disk"] {
        let study = study(name, suite::find(name).expect("a case").scene);
        let module = generate(&subject(&study, name), &choices).expect("code");
        source += &module.as_item();
    }
    std::fs::write(folder.join("scenes.rs"), source).expect("written");
    let emit = [
        "--crate-type",
        "rlib",
        "--extern",
        "libm=liblibm.rlib",
        "scenes.rs",
    ];
    rustc(&folder, &emit);
}

/// The modules in the repository must be equal to those generated from their scenes; after a change
/// of the generator or of a scene they must be written again.
#[test]
fn the_checked_in_modules_agree_with_their_scenes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for (scene, out, dynamics) in [
        (
            "crates/robot-trolley/robot-trolley.toml",
            "crates/robot-trolley/src/generated/automatic.rs",
            "pfaff::dynamics",
        ),
        (
            "examples/linkage.toml",
            "crates/scene-codegen/tests/generated/linkage.rs",
            "dynamics",
        ),
    ] {
        let text = std::fs::read_to_string(root.join(scene)).expect("the scene");
        let choices = Choices {
            dynamics: Some(dynamics.into()),
            ..Choices::default()
        };
        let registry = Registry::standard();
        let module = pfaff_scene_codegen::scene_text(scene, &text, &registry, None, &choices);
        let command =
            format!("`cargo xtask codegen --scene {scene} --out {out} --dynamics {dynamics}`");
        let found = std::fs::read_to_string(root.join(out)).unwrap_or_default();
        assert!(
            found == module.expect("code").as_file(&command),
            "{out} is stale: run {command}"
        );
    }
}

/// A four-bar linkage with a driven crank: a run with the compiled module reaches the end.
#[test]
fn a_compiled_module_in_space_moves_the_linkage() {
    let scenes = space::scenes();
    let (name, text) = scenes
        .iter()
        .find(|(name, _)| name == "linkage")
        .expect("an example");
    let study = study(name, text);
    let coded = study
        .prepared
        .clone()
        .with_code(Arc::new(linkage::Code))
        .expect("its own code");
    let options = study.options.as_ref().expect("the scene has a run");
    let end = |prepared| {
        let mut last = Vec::new();
        let summary = simulate(prepared, options, |row| {
            last = row.q.to_vec();
            Ok(ControlFlow::Continue(()))
        });
        (last, summary.expect("runs").events.len())
    };
    let ((found, events), (expected, _)) = (end(&coded), end(&study.prepared));
    assert_eq!(events, 0);
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    // The crank has rotated by 0.5 rad about z; its quaternion may have any length.
    let (w, z) = (found[3], found[6]);
    assert!((2.0 * z.atan2(w) - 0.5).abs() < 1e-9, "{w} {z}");
}
