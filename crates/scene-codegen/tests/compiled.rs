//! Modules of all scenes, compiled: without imports, also without the standard library, for one
//! state at a time and for several.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use dynamics::KeptRowMotion;
use pfaff::model::Registry;
use pfaff::{AssembledScene, Overrides, Study};
use scene_codegen::{Choices, Subject, generate};

/// Number of states of each scene.
const STATES: usize = 4;

struct Expected {
    scene: &'static str,
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

fn study(case: &suite::Case) -> Study {
    AssembledScene::read(case.name, case.scene, &Registry::standard())
        .and_then(|b| b.prepare(&Overrides::default()))
        .unwrap_or_else(|e| panic!("{}: {e}", case.name))
}

fn cases() -> impl Iterator<Item = &'static suite::Case> {
    suite::all().filter(|case| case.name != "a01-pendulum-2000s")
}

fn subject<'a>(study: &'a Study, name: &str) -> Subject<'a> {
    let options = study.options.as_ref().expect("the scene has a run");
    Subject::of_run(&study.prepared, options).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Prints the bits of accelerations computed for one state at a time, and asserts that several at
/// once give the same.
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
    for case in cases() {
        let study = study(case);
        let subject = subject(&study, case.name);
        let module = generate(&subject, &Choices::default()).expect("every scene has code");
        let mut motion = KeptRowMotion::new(&study.prepared).expect("moves");
        let mut states = String::new();
        let every = (subject.states.len() / STATES).max(1);
        for state in subject.states.iter().step_by(every).take(STATES) {
            let mut values = vec![0.0; state.v.len()];
            motion
                .acceleration(state.t, &state.q, &state.v, &mut values)
                .expect("solves");
            let scene = case.name;
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
        let study = study(suite::find(name).expect("a case"));
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

/// The module of the robot in the repository is that of its scene: after a change of the generator
/// or of the scene it must be written again.
#[test]
fn the_checked_in_module_agrees_with_its_scene() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let scene = "crates/robot-trolley/robot-trolley.toml";
    let text = std::fs::read_to_string(root.join(scene)).expect("the scene");
    let choices = Choices {
        dynamics: Some("pfaff::dynamics".into()),
        libm: false,
    };
    let registry = Registry::standard();
    let module = scene_codegen::scene_text(scene, &text, &registry, None, &choices).expect("code");
    let out = "crates/robot-trolley/src/generated/automatic.rs";
    let command =
        format!("`cargo xtask codegen --scene {scene} --out {out} --dynamics pfaff::dynamics`");
    let found = std::fs::read_to_string(root.join(out)).unwrap_or_default();
    assert!(
        found == module.as_file(&command),
        "{out} is stale: run {command}"
    );
}
