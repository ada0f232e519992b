//! Tests threads and memory: results do not depend on the number of threads, and a command that
//! needs more memory than is allowed is rejected before it starts.

use super::{Folder, pfaff, stderr, stdout, with_scene};
use suite::generate::Kind;

/// Three pendulums without connection.
const APART: &str = r#"
scene = { name = "apart", space = "plane", gravity = [0.0, -9.81] }
body = [
    { name = "a", mass = 1.0, inertia = 0.1, position = [1.0, 0.0] },
    { name = "b", mass = 2.0, inertia = 0.1, position = [11.0, 0.0] },
    { name = "c", mass = 3.0, inertia = 0.1, position = [22.0, 0.0] },
]
joint = [
    { name = "A", type = "revolute", bodies = ["ground", "a"], at = [0.0, 0.0] },
    { name = "B", type = "revolute", bodies = ["ground", "b"], at = [10.0, 0.0] },
    { name = "C", type = "revolute", bodies = ["ground", "c"], at = [20.0, 0.0] },
]
simulate = { t_end = 2.0 }
"#;

#[test]
fn components_give_the_same_rows_on_any_number_of_threads() {
    let files = ["1", "2", "7"].map(|threads| {
        let folder = Folder::new(&format!("threads-{threads}"));
        let output = with_scene(
            &[
                "simulate",
                "-",
                "--out",
                folder.text(),
                "--threads",
                threads,
            ],
            APART,
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        [folder.read("trajectory.csv"), folder.read("reactions.csv")]
    });
    assert_eq!(files[0][0].lines().count(), 202);
    assert!(files[0] == files[1] && files[0] == files[2]);
}

#[test]
fn verdicts_are_the_same_on_any_number_of_threads() {
    let scene = super::generated(Kind::Random, 300);
    let documents = ["1", "2"].map(|threads| {
        let output = with_scene(&["analyze", "-", "--json", "--threads", threads], &scene);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        output.stdout
    });
    assert_eq!(documents[0], documents[1]);
}

#[test]
fn more_memory_than_allowed_is_refused_before_anything_is_written() {
    let scene = super::generated(Kind::Parallelograms, 300);
    let folder = Folder::new("memory");
    let limited = |arguments: &[&str], limit: &str| {
        with_scene(&[arguments, &["--max-memory", limit]].concat(), &scene)
    };
    let simulate = ["simulate", "-", "--out", folder.text(), "--t-end", "0.01"];
    for command in [
        &["analyze", "-"][..],
        &["check", "-"],
        &["plan", "-"],
        &simulate,
    ] {
        let refused = limited(command, "12MB");
        assert_eq!(refused.status.code(), Some(1), "{command:?}");
        assert_eq!(stdout(&refused), "");
        let said = stderr(&refused);
        let numbers = said.contains("of memory, --max-memory allows 12 MB");
        assert!(numbers, "{said}");
    }
    assert!(!folder.0.exists());
    let output = limited(&simulate, "4GB");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_refusal_is_a_document_where_one_was_asked_for() {
    let output = with_scene(&["analyze", "-", "--json", "--max-memory", "1MB"], APART);
    assert_eq!(output.status.code(), Some(1));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let error = document["error"].as_str().expect("text");
    assert!(
        error.starts_with("reading this scene takes about"),
        "{error}"
    );
}

#[test]
fn what_is_no_size_and_no_number_of_threads_is_named() {
    for (option, value, said) in [
        ("--max-memory", "4", "write a number with B, kB, MB"),
        ("--max-memory", "-1GB", "is not a size"),
        ("--threads", "0", "--threads"),
        ("--threads", "many", "--threads"),
    ] {
        let output = pfaff(&["analyze", super::ROBOT, &format!("{option}={value}")]);
        assert_eq!(output.status.code(), Some(2), "{option} {value}");
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
    }
}

#[test]
fn a_plan_says_how_much_memory_its_run_takes() {
    let output = with_scene(&["plan", "-"], APART);
    let text = stdout(&output);
    assert!(
        text.lines()
            .next()
            .is_some_and(|l| l.ends_with("MB of memory")),
        "{text}"
    );
    let output = with_scene(&["plan", "-", "--json"], APART);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(
        document["memory"]
            .as_u64()
            .is_some_and(|bytes| bytes > 1 << 20)
    );
}

/// Runs the command for a user who may have one thread. Limits of threads do not apply to root.
#[cfg(target_os = "linux")]
fn with_one_thread(arguments: &[&str]) -> std::process::Output {
    let is_root = std::fs::metadata("/proc/self").is_ok_and(|own| {
        use std::os::unix::fs::MetadataExt;
        own.uid() == 0
    });
    let mut command = std::process::Command::new("prlimit");
    command.arg("--nproc=1:1");
    if is_root {
        command.args([
            "setpriv",
            "--reuid=65534",
            "--regid=65534",
            "--clear-groups",
        ]);
    }
    command.arg(env!("CARGO_BIN_EXE_pfaff"));
    command.args(arguments).output().expect("it starts")
}

/// One thread computes everything, with the same results, and the command prints this once.
#[cfg(target_os = "linux")]
#[test]
fn without_threads_one_thread_goes_on() {
    use std::os::unix::fs::PermissionsExt;

    let folder = Folder::new("threads-none");
    std::fs::create_dir_all(&folder.0).expect("writable");
    let all = std::fs::Permissions::from_mode(0o777);
    std::fs::set_permissions(&folder.0, all).expect("its own");
    let scene = folder.0.join("apart.toml").display().to_string();
    std::fs::write(&scene, APART.replace("t_end = 2.0", "t_end = 0.1")).expect("writable");
    let commands: [&[&str]; 4] = [
        &["sweep", &scene, "--vary", "body.a.mass=1:2:5"],
        &["tolerance", &scene, "--tolerance", "1e-3", "--runs", "20"],
        &["simulate", &scene],
        &["equilibrium", &scene],
    ];
    for (k, command) in commands.into_iter().enumerate() {
        let all = |name: &str| folder.0.join(format!("{name}-{k}")).display().to_string();
        let (few, many) = (all("few"), all("many"));
        let output = pfaff(&[command, &["--threads", "2", "--out", &few]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let output = with_one_thread(&[command, &["--threads", "2", "--out", &many]].concat());
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{command:?}: {text}");
        assert_eq!(
            text,
            "note: the system could not start the requested threads: one thread computes everything\n",
            "{command:?}"
        );
        for name in [
            "sweep.csv",
            "tolerance.csv",
            "trajectory.csv",
            "at-rest.toml",
        ] {
            let read = |place: &str| {
                let text = std::fs::read_to_string(std::path::Path::new(place).join(name));
                text.map_or(Vec::new(), |text| without_seconds(&text))
            };
            assert!(read(&few) == read(&many), "{command:?}: {name}");
        }
    }
}

/// Returns the cells of a table without those that contain run times.
#[cfg(target_os = "linux")]
fn without_seconds(table: &str) -> Vec<String> {
    let names: Vec<&str> = table
        .lines()
        .next()
        .unwrap_or_default()
        .split(',')
        .collect();
    let cells = |line: &str| {
        let cells = line.split(',').zip(&names);
        let cells = cells.filter(|(_, name)| **name != "seconds");
        cells.map(|(cell, _)| cell.to_owned()).collect::<Vec<_>>()
    };
    table.lines().flat_map(cells).collect()
}

/// Returns a row of bodies, each on a pin to the previous one, on a pin to the ground, or free.
#[cfg(target_os = "linux")]
fn row_of(bodies: usize, is_spatial: bool, joined: Joined) -> String {
    use std::fmt::Write as _;

    let (space, inertia, zero, axis) = if is_spatial {
        let axis = "axis = [0.0, 0.0, 1.0]\n";
        ("spatial", "[1.0, 1.0, 1.0]", ", 0.0", axis)
    } else {
        ("plane", "1.0", "", "")
    };
    let mut scene = format!("[scene]\nname = \"row\"\nspace = \"{space}\"\n");
    for k in 0..bodies {
        let _ = writeln!(
            scene,
            "[[body]]\nname = \"b{k}\"\nmass = 1.0\ninertia = {inertia}\nposition = [{}.5, 0.0{zero}]",
            2 * k
        );
        let before = match (joined, k) {
            (Joined::Free, _) => continue,
            (Joined::InAChain, 1..) => format!("b{}", k - 1),
            _ => "ground".to_owned(),
        };
        let _ = writeln!(
            scene,
            "[[joint]]\nname = \"j{k}\"\ntype = \"revolute\"\nbodies = [\"{before}\", \"b{k}\"]\nat = [{}.0, 0.0{zero}]\n{axis}",
            2 * k
        );
    }
    scene + "[simulate]\nt_end = 0.001\noutput_step = 0.001\n"
}

#[cfg(target_os = "linux")]
#[derive(Clone, Copy, Debug)]
enum Joined {
    Free,
    ToGround,
    InAChain,
}

/// Returns the largest memory (bytes) of a command, as Linux counts it.
#[cfg(target_os = "linux")]
fn peak(arguments: &[&str]) -> f64 {
    use std::process::{Command, Stdio};

    let mut command = Command::new(env!("CARGO_BIN_EXE_pfaff"));
    command.args(arguments).stdout(Stdio::null());
    let mut child = command.spawn().expect("it starts");
    let status = format!("/proc/{}/status", child.id());
    let mut most = 0.0;
    while child.try_wait().expect("its own").is_none() {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let number = line.and_then(|line| line.split_whitespace().next());
        most = number.and_then(|n| n.parse().ok()).unwrap_or(most);
        std::thread::sleep(std::time::Duration::from_micros(500));
    }
    assert!(child.wait().expect("it ends").success(), "{arguments:?}");
    1024.0 * most
}

/// Returns the largest estimate (bytes) of a command: the smallest limit that it accepts.
#[cfg(target_os = "linux")]
fn estimate(arguments: &[&str]) -> f64 {
    let mut most: f64 = 1.0;
    loop {
        // Estimates are shown in whole megabytes.
        let limit = format!("{}B", most + 1e6);
        let output = pfaff(&[arguments, &["--max-memory", &limit]].concat());
        if output.status.code() == Some(0) {
            return most;
        }
        let text = stderr(&output);
        let said = text.split("about ").nth(1).unwrap_or_default();
        let number = said.split(" MB").next().and_then(|n| n.parse::<f64>().ok());
        let number = number.unwrap_or_else(|| panic!("{text}"));
        assert!(1e6 * number > most, "{text}");
        most = 1e6 * number;
    }
}

/// The estimate decides whether a command is rejected.
#[cfg(target_os = "linux")]
#[test]
fn estimates_of_memory_are_right_to_a_fifth() {
    const FIFTH: f64 = 0.2;
    let folder = Folder::new("memory-estimates");
    std::fs::create_dir_all(&folder.0).expect("writable");
    let file = folder.0.join("row.toml").display().to_string();
    let out = folder.0.join("out").display().to_string();
    for (bodies, is_spatial, joined) in [
        (400, true, Joined::Free),
        (3000, true, Joined::Free),
        (3000, false, Joined::ToGround),
        (1000, true, Joined::ToGround),
        (1000, false, Joined::InAChain),
        (1000, true, Joined::InAChain),
        (3000, false, Joined::InAChain),
    ] {
        for command in [
            &["check", &file][..],
            &["analyze", &file],
            &["simulate", &file, "--out", &out],
        ] {
            let command = [command, &["--threads", "1"]].concat();
            let [(least, floor), (estimate, peak)] = [1, bodies].map(|bodies| {
                std::fs::write(&file, row_of(bodies, is_spatial, joined)).expect("writable");
                // Short runs can end before their memory is read.
                let runs = if bodies < 1000 { 10 } else { 1 };
                let peaks = (0..runs).map(|_| peak(&command));
                (estimate(&command), peaks.fold(0.0, f64::max))
            });
            // A program without optimisation is larger, for any scene.
            let estimate = estimate + floor - least;
            let case = format!("{bodies} {joined:?} {is_spatial} {}", command[0]);
            let error = (estimate / peak - 1.0).abs();
            assert!(error < FIFTH, "{case}: {estimate:.2e} {peak:.2e}");
        }
    }
}
