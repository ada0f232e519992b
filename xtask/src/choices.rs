//! The cost of programs that use parts of the project: clean build time, size and dependencies. The
//! programs are the small programs in `xtask/choices` and the command itself. The programs are
//! built one after another. Each program is built in an empty target directory.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::time::Instant;

use crate::scene;
use crate::tree::{cargo, machine, root, run, said_by};

/// A scene, and the path of the generated module that the program with generated code includes.
const ROBOT: &str = "crates/robot-trolley/robot-trolley.toml";
const GENERATED: &str = "xtask/choices/generated/src/robot.rs";

const REPORT: &str = "docs/reports/choices/table.md";

/// A program and the crates that it uses.
struct Choice {
    package: &'static str,
    /// Name of the binary.
    binary: &'static str,
    uses: &'static str,
    /// The workspace that contains it, relative to the root.
    workspace: &'static str,
}

const fn small(package: &'static str, uses: &'static str) -> Choice {
    Choice {
        package,
        binary: package,
        uses,
        workspace: "xtask/choices",
    }
}

const CHOICES: [Choice; 9] = [
    small(
        "choice-integrators",
        "`integrators`: a differential equation",
    ),
    small("choice-rank", "`rank`: rank and dependent rows of a matrix"),
    small("choice-rank-faer", "the same with feature `faer`"),
    small(
        "choice-solvability",
        "`solvability`: unique multipliers of a matrix",
    ),
    small(
        "choice-dynamics",
        "`dynamics`: a mechanism built in code moves",
    ),
    small(
        "choice-generated",
        "`integrators` and code generated for one scene",
    ),
    small(
        "choice-pfaff-lean",
        "`pfaff` without features: a scene file to verdicts, motion and files",
    ),
    small("choice-pfaff", "`pfaff` with `macros`, the default"),
    Choice {
        package: "pfaff-cli",
        binary: "pfaff",
        uses: "the command `pfaff`",
        workspace: ".",
    },
];

/// The cost of one choice.
struct Cost {
    house: usize,
    others: usize,
    debug: Build,
    release: Build,
    /// Size of the stripped binary (bytes).
    size: u64,
}

/// A clean build.
struct Build {
    /// Wall-clock time (s).
    wall: f64,
    /// Time on all processors, if the system reports it (s).
    processor: Option<f64>,
}

/// The text below the table.
const NOTES: &str = "
Build times are those of the machine and its neighbours; processor seconds are of all cores together. Crates include procedural macros and what only build
scripts use. Profiles are cargo's own, `release` stripped; the debug profile of the command is that of the workspace, which optimises.
";

/// Builds all programs. The table is written after each program, so that an interruption loses only
/// the last program.
pub(crate) fn report() -> Result<String, String> {
    let target = std::env::temp_dir().join(format!("pfaff-choices-{}", std::process::id()));
    let path = root().join(REPORT);
    fs::create_dir_all(path.parent().unwrap_or(&path)).map_err(|e| format!("{REPORT}: {e}"))?;
    same_versions()?;
    let [scene, out] = [ROBOT, GENERATED].map(|path| root().join(path));
    scene::generate(&scene.to_string_lossy(), &["--out", &out.to_string_lossy()])?;
    let mut text = format!(
        "# What a part costs\n\nWritten by `cargo xtask choices` from the programs in `xtask/choices`: clean builds, one at a time, downloads not counted.\n\n{}\n\
         | program uses | crates of ours | others | release build | processor | debug build | processor | stripped binary |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
        machine()?
    );
    for choice in &CHOICES {
        let cost = measure(choice, &target);
        remove(&target)?;
        let line = line(choice, &cost?);
        println!("{line}");
        text += &line;
        text.push('\n');
        fs::write(&path, format!("{text}{NOTES}")).map_err(|e| format!("{REPORT}: {e}"))?;
    }
    Ok(format!("written to {REPORT}"))
}

/// Sets the dependencies of the programs to the versions of the workspace. Cargo removes
/// dependencies that the programs do not need.
fn same_versions() -> Result<(), String> {
    let lock = |folder: &str| root().join(folder).join("Cargo.lock");
    let (from, to) = (lock("."), lock("xtask/choices"));
    let copied = fs::copy(&from, &to);
    copied
        .map(drop)
        .map_err(|e| format!("{}: {e}", to.display()))
}

fn line(choice: &Choice, cost: &Cost) -> String {
    let Cost {
        house,
        others,
        debug,
        release,
        size,
    } = cost;
    let seconds = |s: Option<f64>| s.map_or(String::new(), |s| format!("{s:.1} s"));
    format!(
        "| {} | {house} | {others} | {} | {} | {} | {} | {:.2} MB |",
        choice.uses,
        seconds(Some(release.wall)),
        seconds(release.processor),
        seconds(Some(debug.wall)),
        seconds(debug.processor),
        *size as f64 / 1e6
    )
}

fn measure(choice: &Choice, target: &Path) -> Result<Cost, String> {
    let folder = root().join(choice.workspace);
    run(cargo(&folder).args(["fetch", "--quiet"]))?;
    let (house, others) = dependencies(choice, &folder)?;
    let debug = build(choice, &folder, target, "dev")?;
    let release = build(choice, &folder, target, "release")?;
    let binary = target.join("release").join(choice.binary);
    let size = fs::metadata(&binary)
        .map_err(|e| format!("{}: {e}", binary.display()))?
        .len();
    Ok(Cost {
        house,
        others,
        debug,
        release,
        size,
    })
}

/// Returns the numbers of crates that are compiled with the program: crates of this project, and
/// crates of other projects.
fn dependencies(choice: &Choice, folder: &Path) -> Result<(usize, usize), String> {
    let tree = [
        "tree",
        "--edges",
        "normal,build",
        "--prefix",
        "none",
        "--package",
    ];
    let lines = said_by(cargo(folder).args(tree).arg(choice.package))?;
    let crates: BTreeSet<&str> = lines.lines().map(|l| l.trim_end_matches(" (*)")).collect();
    let others = crates
        .iter()
        .filter(|l| !l.contains("(/") && !l.contains(":\\"))
        .count();
    // The program is a crate of this project, but not a dependency.
    Ok((crates.len() - others - 1, others))
}

/// A build in an empty directory.
fn build(choice: &Choice, folder: &Path, target: &Path, profile: &str) -> Result<Build, String> {
    remove(target)?;
    let (clock, before) = (Instant::now(), processor_seconds());
    let mut command = cargo(folder);
    command
        .args([
            "build",
            "--quiet",
            "--package",
            choice.package,
            "--profile",
            profile,
        ])
        .env("CARGO_TARGET_DIR", target)
        .env("CARGO_PROFILE_RELEASE_STRIP", "true")
        .env("CARGO_PROFILE_RELEASE_DEBUG", "false");
    run(&mut command)?;
    let wall = clock.elapsed().as_secs_f64();
    let processor = before.zip(processor_seconds()).map(|(a, b)| b - a);
    Ok(Build { wall, processor })
}

fn remove(folder: &Path) -> Result<(), String> {
    match fs::remove_dir_all(folder) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
            Err(format!("{}: {e}", folder.display()))
        }
        _ => Ok(()),
    }
}

/// Returns the user and system time of all finished child processes (s). Linux counts this time in
/// hundredths of a second.
fn processor_seconds() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name is in parentheses and may contain spaces. The times of child processes are the 14th
    // and 15th values after the name.
    let (_, values) = stat.rsplit_once(')')?;
    let ticks: Vec<f64> = values
        .split_whitespace()
        .skip(13)
        .take(2)
        .filter_map(|v| v.parse().ok())
        .collect();
    match ticks[..] {
        [user, system] => Some((user + system) / 100.0),
        _ => None,
    }
}
