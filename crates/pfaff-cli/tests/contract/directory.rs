//! Tests directories and files of answers: an answer replaces the earlier one of the same command
//! completely, and no file from another source.

use std::fs;

use super::{Folder, pfaff, stderr, stdout, with_scene};

/// A rod on a pin.
const ROD: &str = r#"
scene = { name = "rod", space = "plane", gravity = [0.0, -9.81], tolerance = 1e-3 }
body = [{ name = "rod", mass = 2.0, inertia = 0.5, position = [0.0, -1.5] }]
joint = [{ name = "pin", type = "revolute", bodies = ["ground", "rod"], at = [0.0, 0.0] }]
simulate = { t_end = 0.1 }
"#;

/// The same rod with a load, which is an input.
const PUSHED: &str = r#"
force = [{ name = "push", type = "torque", body = "rod", torque = 0.0 }]
"#;

/// Each command with a directory, a file that another answer of it could contain, with its first
/// bytes, and a file of another command.
const COMMANDS: [(&[&str], &str, &str, &str); 6] = [
    (&["linearise", "-"], "mode-97.html", PAGE, "tolerance.csv"),
    (&["equilibrium", "-"], "at-rest.toml.part", "[sc", "a.csv"),
    (
        &["tolerance", "-", "--runs", "5"],
        "tolerance.csv.part",
        "s",
        "a.csv",
    ),
    (&["simulate", "-"], "choice_97.csv", "t,pin.Fx\n", "a.csv"),
    (
        &["work-precision", "-", "--quick"],
        "work_precision.png",
        PICTURE,
        "a.csv",
    ),
    (
        &["sweep", "-", "--vary", "body.rod.mass=1,2"],
        "summary.json.part",
        "{",
        "a.csv",
    ),
];

const PAGE: &str = "<html><meta name=\"generator\" content=\"pfaff 0.1.0\">";

/// The head of a PNG file with its program.
const PICTURE: &str = "\u{89}PNG";

fn head(content: &str) -> Vec<u8> {
    if content != PICTURE {
        return content.into();
    }
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    bytes.extend(14_u32.to_be_bytes());
    bytes.extend(b"tEXtSoftware\0pfaff");
    bytes
}

fn names(folder: &Folder) -> Vec<String> {
    let entries = fs::read_dir(&folder.0).expect("readable").flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names.filter(|name| name != "shards").collect();
    names.sort();
    names
}

#[test]
fn an_answer_removes_what_an_earlier_one_has_left() {
    for (command, stale, content, other) in COMMANDS {
        let folder = Folder::new(&format!("directory-{}", command[0]));
        let run = |more: &[&str]| {
            let arguments = [command, &["--out", folder.text()], more].concat();
            let output = with_scene(&arguments, ROD);
            assert_eq!(
                output.status.code(),
                Some(0),
                "{arguments:?}: {}",
                stderr(&output)
            );
            stdout(&output)
        };
        run(&[]);
        let answer = names(&folder);
        for (name, content) in [
            (stale, head(content)),
            // The file comes from another source, with a name that the command may or may not use.
            ("notes.txt", b"mine".to_vec()),
            ("mode-1.txt", b"mine".to_vec()),
            (other, b"A,rod.angle\nrod.angle,1\n".to_vec()),
        ] {
            fs::write(folder.0.join(name), content).expect("writable");
        }
        if other == "tolerance.csv" {
            fs::write(folder.0.join(other), "sample,status\n").expect("writable");
        }
        let words = run(&[]);
        let mut expected = [
            &answer[..],
            &["notes.txt", "mode-1.txt", other].map(str::to_owned),
        ]
        .concat();
        expected.sort();
        assert_eq!(names(&folder), expected, "{command:?}");
        assert_eq!(folder.read("notes.txt"), "mine");
        let told = format!("the directory also contains files of other commands: `{other}`");
        assert!(words.contains(&told), "{command:?}: {words}");
    }
}

/// Otherwise the matrix of inputs of one mechanism would be next to matrices of another mechanism.
#[test]
fn matrices_in_a_directory_are_of_one_mechanism() {
    let folder = Folder::new("directory-matrices");
    let out = ["linearise", "-", "--out", folder.text()];
    let inputs = folder.0.join("b.csv");
    assert_eq!(
        with_scene(&out, &format!("{ROD}{PUSHED}")).status.code(),
        Some(0)
    );
    assert!(inputs.is_file());
    assert_eq!(with_scene(&out, ROD).status.code(), Some(0));
    assert!(!inputs.exists());
    // A table from another source is neither replaced nor, with `--force`, removed.
    fs::write(&inputs, "B,year\n1,2\n").expect("writable");
    let refused = with_scene(&out, ROD);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        stderr(&refused).starts_with("error[P0004]: "),
        "{}",
        stderr(&refused)
    );
    let forced = with_scene(&[&out[..], &["--force"]].concat(), ROD);
    assert_eq!(forced.status.code(), Some(0), "{}", stderr(&forced));
    assert_eq!(folder.read("b.csv"), "B,year\n1,2\n");
}

/// A pendulum in the format of another program.
const MODEL: &str = "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/>\
    <inertial pos='0 0 -0.5' mass='1' diaginertia='0.1 0.1 0.01'/></body></worldbody></mujoco>";

/// Commands that write one file, with their input.
const SINGLE: [(&[&str], &str); 3] = [
    (&["new", "door"], ""),
    (&["import", "-"], MODEL),
    (&["view", "-", "--no-open"], ROD),
];

#[test]
fn nothing_but_a_file_is_replaced_by_a_file() {
    let folder = Folder::new("directory-single");
    fs::create_dir_all(&folder.0).expect("writable");
    let precious = folder.0.join("precious");
    fs::write(&precious, "mine").expect("writable");
    for (command, input) in SINGLE {
        let run = |name: &str| {
            let out = folder.0.join(name).display().to_string();
            let arguments = [command, &["--out", &out, "--force"]].concat();
            let output = with_scene(&arguments, input);
            (output.status.code(), stderr(&output))
        };
        let place = folder.0.join("place.svg");
        fs::create_dir(&place).expect("writable");
        let (code, text) = run("place.svg");
        assert_eq!(code, Some(2), "{command:?}: {text}");
        fs::remove_dir(&place).expect("empty");
        #[cfg(unix)]
        for target in ["precious", "nothing", "/dev/null"] {
            std::os::unix::fs::symlink(target, &place).expect("links");
            let (code, text) = run("place.svg");
            assert_eq!(code, Some(2), "{command:?} {target}: {text}");
            assert!(
                text.starts_with("error[P0003]: ") && text.contains("a link"),
                "{text}"
            );
            assert!(place.is_symlink());
            fs::remove_file(&place).expect("there");
        }
        let (code, text) = run("place.svg");
        assert_eq!(code, Some(0), "{command:?}: {text}");
        fs::remove_file(&place).expect("written");
        assert_eq!(names(&folder), ["precious"], "{command:?}");
    }
    assert_eq!(folder.read("precious"), "mine");
}

/// An existing file is kept for any error.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_no_part_of_a_file() {
    let folder = Folder::new("directory-full");
    fs::create_dir_all(&folder.0).expect("writable");
    let model = folder.0.join("model.xml").display().to_string();
    fs::write(&model, MODEL).expect("writable");
    let scene = folder.0.join("rod.toml").display().to_string();
    fs::write(&scene, ROD).expect("writable");
    let out = folder.0.join("out.svg").display().to_string();
    fs::write(&out, "mine").expect("writable");
    let results = folder.0.join("results").display().to_string();
    let before = names(&folder);
    for command in [
        &["new", "door", "--out", &out, "--force"][..],
        &["import", &model, "--out", &out, "--force"],
        &["view", &scene, "--no-open", "--out", &out, "--force"],
        &["linearise", &scene, "--out", &results],
        &["equilibrium", &scene, "--out", &results],
        &["tolerance", &scene, "--runs", "5", "--out", &results],
    ] {
        let output = super::faults::with_limit("-f 0", command);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{command:?}: {text}");
        assert!(
            text.starts_with("error[P0006]: cannot write "),
            "{command:?}: {text}"
        );
        assert_eq!(names(&folder), before, "{command:?}");
        assert_eq!(folder.read("out.svg"), "mine", "{command:?}");
    }
    assert_eq!(
        pfaff(&["new", "door", "--out", &out, "--force"])
            .status
            .code(),
        Some(0)
    );
}
