//! Compares sweeps with closed forms. The tests use different numbers of threads and shards, and
//! interruptions.

mod code;

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use model::Registry;
use report::sweep::SweepMotion;
use report::{SweepDocument, SweepRow, SweepStatus};

use crate::{RunOptions, Study};

use super::{Shard, Sweep, SweepError, SweepOutcome, SweepProgress, SweepSettings, Tables, merge};

/// A point mass on a rod of length 1 m. The mass passes its lowest point at v = 10⁻⁴ m/s.
const PENDULUM: &str = r#"
scene = { name = "pendulum", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "bob", mass = 2.0, inertia = 0.0, velocity = [1e-4, 0.0] }]
joint = [{ name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0.0, 1.0] }]
start = { keep = ["bob.vx"] }
simulate = { t_end = 2.0, output_step = 0.5, rtol = 1e-10, atol = 1e-14 }
"#;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("pfaff-sweep-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        Self(path)
    }

    /// Returns the table, without the column of seconds.
    fn table(&self) -> Vec<Vec<String>> {
        let text = fs::read_to_string(self.0.join("sweep.csv")).expect("written");
        let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let mut rows: Vec<Vec<String>> = text.lines().map(cells).collect();
        let seconds = rows[0]
            .iter()
            .position(|name| name == "seconds")
            .expect("a column");
        for row in &mut rows {
            row.remove(seconds);
        }
        rows
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn sweep<'r>(registry: &'r Registry, scene: &str, vary: &[&str]) -> Sweep<'r> {
    let axes = vary.iter().map(|axis| axis.parse().expect("an axis"));
    Sweep::read("scene.toml", scene, registry, axes.collect()).unwrap_or_else(|e| panic!("{e}"))
}

fn run(sweep: &Sweep<'_>, folder: &Folder, shard: Shard, threads: usize) -> SweepDocument {
    outcome(sweep, folder, shard, threads).document
}

fn outcome(sweep: &Sweep<'_>, folder: &Folder, shard: Shard, threads: usize) -> SweepOutcome {
    let settings = SweepSettings { shard, threads };
    let done = sweep.run_into(&folder.0, &settings, || false, |_| {});
    done.unwrap_or_else(|e| panic!("{e}"))
}

fn shard(text: &str) -> Shard {
    text.parse().expect("a shard")
}

/// For small oscillations, x(t) = v/ω·sin ωt with ω² = g/L, and the largest tension at the bottom
/// is m·(g + v²/L). Terms of order θ² < 10⁻⁸ are neglected.
#[test]
fn a_pendulum_swings_as_its_length_says() {
    let registry = Registry::standard();
    let sweep = sweep(&registry, PENDULUM, &["joint.pivot.at[1]=0.25:4:9:log"]);
    let (v, g) = (1e-4, 9.81_f64);
    for run in 1..=sweep.runs() {
        let length = sweep.point(run)[0];
        let row = sweep.row(run);
        assert_eq!((row.status, row.error.as_str()), (SweepStatus::Done, ""));
        let motion = row.motion.expect("it moved");
        let omega = (g / length).sqrt();
        let (x, vx) = (v / omega * (2.0 * omega).sin(), v * (2.0 * omega).cos());
        assert_eq!(motion.t_state, 2.0);
        assert!(
            (motion.state[0] - x).abs() < 1e-8 * v,
            "L = {length}: {:e}",
            motion.state[0] - x
        );
        assert!(
            (motion.state[3] - vx).abs() < 1e-8 * v * omega,
            "L = {length}: {:e}",
            motion.state[3] - vx
        );
        let [[largest, _], _] = motion.largest(0);
        let pull = 2.0 * (g + v * v / length);
        assert!(
            (largest - pull).abs() < 1e-13 * pull,
            "L = {length}: {:e}",
            largest - pull
        );
        assert_eq!(
            (motion.rank, motion.redundancy, motion.not_unique),
            (2, 0, Some(0))
        );
    }
}

/// A beam has two hinges. The force along the beam is not determined, so the tables contain no
/// value for this force.
#[test]
fn reactions_that_are_not_unique_have_no_number() {
    let beam = r#"
scene = { name = "beam", space = "plane", gravity = [0.0, -10.0] }
body = [{ name = "beam", mass = 3.0, inertia = 1.0 }]
joint = [
    { name = "left", type = "revolute", bodies = ["ground", "beam"], at = [-1.0, 0.0] },
    { name = "right", type = "revolute", bodies = ["ground", "beam"], at = [1.0, 0.0] },
]
simulate = { t_end = 0.1 }
"#;
    let registry = Registry::standard();
    let row = sweep(&registry, beam, &["body.beam.mass=1,2"]).row(2);
    let motion = row.motion.expect("it stands still");
    assert_eq!(
        (motion.rank, motion.redundancy, motion.not_unique),
        (3, 1, Some(2))
    );
    for k in 0..motion.peaks.len() {
        let [force, torque] = motion.largest(k);
        assert!(force.iter().all(|x| x.is_nan()), "{force:?}");
        // A hinge of the plane has no torque under any load.
        assert_eq!(torque, [0.0, 0.0]);
    }
    // A reaction that is not requested has no column.
    let named = format!("{beam}output = {{ reactions = [\"right\"] }}\n");
    let sweep = sweep(&registry, &named, &["body.beam.mass=1,2"]);
    assert_eq!(sweep.plan.reactions, ["right"]);
}

/// A beam on two hinges, with gravity along the beam and across the beam. Each hinge carries half
/// of the weight across the beam. Along the beam, each hinge carries a load between zero and the
/// whole weight.
#[test]
fn bounds_of_reactions_are_columns() {
    let beam = r#"
scene = { name = "beam", space = "plane", gravity = [-4.0, -10.0] }
body = [{ name = "beam", mass = 3.0, inertia = 1.0 }]
joint = [
    { name = "left", type = "revolute", bodies = ["ground", "beam"], at = [-1.0, 0.0] },
    { name = "right", type = "revolute", bodies = ["ground", "beam"], at = [1.0, 0.0] },
]
simulate = { t_end = 0.1 }
"#;
    let registry = Registry::standard();
    let bounded = |request: &str| format!("{beam}output = {{ bounds = {request} }}\n");
    let of = |request: &str| {
        let row = sweep(&registry, &bounded(request), &["body.beam.mass=1,2"]).row(2);
        let motion = row.motion.expect("it stands still");
        motion.at_most.expect("requested")
    };
    let found = of("true");
    assert_eq!(found.rows_without, 0, "{found:?}");
    for [force, torque] in found.largest {
        assert!((force[0] - 164.0_f64.sqrt()).abs() < 1e-12, "{force:?}");
        assert_eq!(force[1], 0.0);
        // A hinge of the plane has no torque under any load.
        assert!(torque[0].is_nan());
    }
    // The right hinge carries the whole weight along the beam if it alone is rigid.
    let found = of("{ rigid = [\"right\"] }");
    let [left, right] = [0, 1].map(|k: usize| found.largest[k][0][0]);
    assert!((left - 10.0).abs() < 1e-12 && (right - 164.0_f64.sqrt()).abs() < 1e-12);

    let folder = Folder::new("bounds");
    let sweep = sweep(&registry, &bounded("true"), &["body.beam.mass=1,2"]);
    run(&sweep, &folder, Shard::WHOLE, 1);
    let rows = folder.table();
    let column = rows[0].iter().position(|name| name == "right.F_at_most");
    let column = column.expect("a column");
    assert_eq!(
        &rows[0][column + 1..],
        ["right.F_at_most_t", "right.T_at_most", "right.T_at_most_t"]
    );
    let value: f64 = rows[2][column].parse().expect("a number");
    assert!((value - 164.0_f64.sqrt()).abs() < 1e-12, "{value}");

    // Bounds that cannot be computed are rejected before any run.
    for (request, said) in [
        ("{ within = 2, compliance = \"lefd=1\" }", "`lefd`"),
        ("true, reactions = false", "bounds need reactions"),
    ] {
        let axes = vec!["body.beam.mass=1,2".parse().expect("an axis")];
        let error = Sweep::read("scene.toml", &bounded(request), &registry, axes).err();
        let error = error.expect("refused").to_string();
        assert!(error.contains(said), "{error}");
    }
}

/// Three parallel cranks are upright at the start and rotate. One pivot consists of two points on
/// lines. The horizontal reaction of this pivot is unique only at the start.
const UPRIGHT: &str = r#"
scene = { name = "upright", space = "plane", gravity = [0.0, -10.0] }
body = [
    { name = "one", mass = 1.0, inertia = 0.02, position = [0.0, 0.25], angle = 1.5707963267948966, velocity = [-0.5, 0.0], angular_velocity = 2.0 },
    { name = "two", mass = 1.0, inertia = 0.02, position = [1.0, 0.25], angle = 1.5707963267948966, velocity = [-0.5, 0.0], angular_velocity = 2.0 },
    { name = "three", mass = 1.0, inertia = 0.02, position = [2.0, 0.25], angle = 1.5707963267948966, velocity = [-0.5, 0.0], angular_velocity = 2.0 },
    { name = "coupler", mass = 3.0, inertia = 1.0, position = [1.0, 0.5], velocity = [-1.0, 0.0] },
]
joint = [
    { name = "pivot one", type = "revolute", bodies = ["ground", "one"], at = [0.0, 0.0] },
    { name = "guide x", type = "point-on-line", body = "two", at = [1.0, 0.0], line = [[1.0, -1.0], [1.0, 1.0]] },
    { name = "guide y", type = "point-on-line", body = "two", at = [1.0, 0.0], line = [[0.0, 0.0], [2.0, 0.0]] },
    { name = "pivot three", type = "revolute", bodies = ["ground", "three"], at = [2.0, 0.0] },
    { name = "tip one", type = "revolute", bodies = ["one", "coupler"], at = [0.0, 0.5] },
    { name = "tip two", type = "revolute", bodies = ["two", "coupler"], at = [1.0, 0.5] },
    { name = "tip three", type = "revolute", bodies = ["three", "coupler"], at = [2.0, 0.5] },
]
simulate = { t_end = 0.4 }
"#;

#[test]
fn verdicts_of_a_row_are_those_of_its_run() {
    let registry = Registry::standard();
    let of = |more: &str| {
        let scene = format!("{UPRIGHT}{more}");
        let sweep = sweep(&registry, &scene, &["scene.gravity[1]=-10,-5"]);
        sweep.row(1).motion.expect("it runs")
    };
    let study = Study::read("upright.toml", UPRIGHT, &registry, &RunOptions::default());
    let study = study.expect("a scene");
    let start = study.analyse(0.0, None).expect("a start");
    assert!(
        start
            .verdict("guide x")
            .expect("exists")
            .wrench
            .verdict
            .is_unique()
    );
    let motion = of("");
    assert_eq!((motion.redundancy, motion.not_unique), (1, Some(7)));
    assert!((0..7).all(|k| motion.largest(k)[0][0].is_nan()));
    // All joints are counted, including joints whose reactions have no columns.
    let motion = of("output = { reactions = [\"guide x\"] }\n");
    assert_eq!((motion.not_unique, motion.peaks.len()), (Some(7), 1));
    // Without reactions there are no verdicts of the run.
    let motion = of("output = { reactions = false }\n");
    assert_eq!((motion.not_unique, motion.peaks.len()), (None, 0));
}

/// A bar is fixed at one end, and the other end is constrained along the bar. The force along the
/// bar is shared, but the torque of the fixed end is unique.
#[test]
fn force_and_torque_have_numbers_of_their_own() {
    let scene = r#"
scene = { name = "bar", space = "plane", gravity = [0.0, -10.0] }
body = [{ name = "bar", mass = 3.0, inertia = 1.0, position = [0.5, 0.0] }]
joint = [
    { name = "wall", type = "fixed", bodies = ["ground", "bar"], at = [0.0, 0.0] },
    { name = "stop", type = "point-on-line", body = "bar", at = [1.0, 0.0], line = [[1.0, -1.0], [1.0, 1.0]] },
]
simulate = { t_end = 0.1 }
"#;
    let registry = Registry::standard();
    let sweep = sweep(&registry, scene, &["body.bar.mass=3,6"]);
    let motion = sweep.row(2).motion.expect("it stands still");
    let [[force, _], [torque, _]] = motion.largest(0);
    // The load is 6 kg at 0.5 m.
    assert!(
        force.is_nan() && (torque - 30.0).abs() < 1e-12,
        "{force} {torque}"
    );
    assert_eq!(motion.not_unique, Some(2));
}

#[test]
fn threads_and_shards_leave_no_trace() {
    let registry = Registry::standard();
    // A mass of −1 is rejected.
    let sweep = sweep(
        &registry,
        PENDULUM,
        &["body.bob.mass=-1:8:10", "scene.gravity[1]=-1,-10"],
    );
    let folders = ["one", "two", "shards", "apart", "merged"].map(Folder::new);
    let [one, two, shards, apart, merged] = &folders;
    let document = run(&sweep, one, Shard::WHOLE, 1);
    // With mass 0, no motion is possible either. These two masses are two of ten values, and each
    // value occurs twice.
    assert_eq!(
        (document.runs, document.done, document.stopped),
        (20, 16, 0)
    );
    assert_eq!((document.refused, document.partial), (4, false));
    assert!(
        document.failures[0].error.contains("mass is -1"),
        "{:?}",
        document.failures
    );
    run(&sweep, two, Shard::WHOLE, 2);
    assert_eq!(one.table(), two.table());
    for text in ["2/3", "3/3"] {
        let outcome = outcome(&sweep, shards, shard(text), 2);
        let document = outcome.document;
        assert_eq!((document.finished, document.partial), (7, false));
        assert_eq!(outcome.tables, Tables::NotYet);
    }
    let document = run(&sweep, apart, shard("1/3"), 2);
    assert_eq!((document.finished, document.runs), (6, 20));
    let found = merge(&[shards.0.clone(), apart.0.clone()], &merged.0).expect("one sweep");
    let document = found.document;
    assert_eq!((document.finished, document.partial), (20, false));
    assert_eq!((document.repeated, found.shards), (0, Some(3)));
    assert_eq!(one.table(), merged.table());
    let found = merge(&[&shards.0], &merged.0).expect("one sweep");
    let missing: Vec<String> = found
        .document
        .missing
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        (missing.as_slice(), found.shards),
        (&["1-6".to_owned()][..], Some(3))
    );
    // The whole sweep in the directory of two shards performs only the third part.
    let mut begun = (0, 0);
    let settings = SweepSettings::default();
    let note = |progress: SweepProgress<'_>| match progress {
        SweepProgress::Begin { runs, finished } => begun = (runs, finished),
        SweepProgress::Finished(row) => assert!(row.run <= 6),
    };
    sweep
        .run_into(&shards.0, &settings, || false, note)
        .expect("continued");
    assert_eq!(begun, (20, 14));
    assert_eq!(one.table(), shards.table());
}

/// The process that ends last finds all runs and writes the tables. More shards than runs cause no
/// error.
#[test]
fn the_last_shard_writes_the_tables() {
    let registry = Registry::standard();
    let sweep = sweep(&registry, PENDULUM, &["body.bob.mass=1:3:3"]);
    let (folder, whole) = (Folder::new("last"), Folder::new("last-whole"));
    let mut tables = 0;
    for k in 1..=5 {
        let shard = Shard::new(k, 5).expect("a shard");
        let outcome = outcome(&sweep, &folder, shard, 1);
        assert_eq!(
            outcome.document.finished,
            u64::from(outcome.document.shard.is_some())
        );
        assert!(!outcome.document.partial);
        tables += usize::from(outcome.tables == Tables::Written);
    }
    assert_eq!(tables, 1);
    run(&sweep, &whole, Shard::WHOLE, 1);
    assert_eq!(folder.table(), whole.table());
}

/// Two processes, here two threads, perform the same shard at the same time.
#[test]
fn the_same_shard_twice_at_once_is_harmless() {
    let registry = Registry::standard();
    let sweep = sweep(&registry, PENDULUM, &["body.bob.mass=1:40:40"]);
    let (folder, whole) = (Folder::new("twice"), Folder::new("twice-whole"));
    let settings = SweepSettings {
        threads: 1,
        ..SweepSettings::default()
    };
    // Both threads begin before one of them has finished a run.
    let barrier = std::sync::Barrier::new(2);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                let note = |progress: SweepProgress<'_>| {
                    if matches!(progress, SweepProgress::Begin { .. }) {
                        barrier.wait();
                    }
                };
                let outcome = sweep.run_into(&folder.0, &settings, || false, note);
                assert_eq!(outcome.expect("done").document.finished, 40);
            });
        }
    });
    run(&sweep, &whole, Shard::WHOLE, 2);
    assert_eq!(folder.table(), whole.table());
    let names: Vec<String> = fs::read_dir(folder.0.join("shards"))
        .expect("begun")
        .map(|entry| {
            entry
                .expect("readable")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    assert!(names.contains(&"01-40.rows".to_owned()), "{names:?}");
    assert!(
        names.iter().all(|name| !name.ends_with(".part")),
        "{names:?}"
    );
}

/// Runs are the same alone and in a group.
#[test]
fn groups_leave_no_trace() {
    let registry = Registry::standard();
    let sweep = sweep(&registry, PENDULUM, &["body.bob.mass=-1:8:10"]);
    let alone: Vec<_> = (1..=10).map(|run| sweep.row(run)).collect();
    for size in [1, 3, 10] {
        let mut rows = Vec::new();
        let runs: Vec<u64> = (1..=10).collect();
        for group in runs.chunks(size) {
            let mut sink = |row| {
                rows.push(row);
                Ok(())
            };
            sweep
                .make(group, super::job::Keep::Rows, &|| false, &mut sink)
                .expect("made");
        }
        for (a, mut b) in alone.iter().zip(rows) {
            if let (Some(a), Some(b)) = (&a.motion, &mut b.motion) {
                b.seconds = a.seconds;
            }
            // NaN values are equal as texts.
            assert_eq!(format!("{a:?}"), format!("{b:?}"));
        }
    }
}

/// Runs that end their process. Only the test reads this variable.
const FATAL: &str = "PFAFF_TEST_FATAL_RUNS";

/// Called before a run is performed.
pub(super) fn begins(run: u64) {
    if let Ok(fatal) = std::env::var(FATAL)
        && fatal.split(' ').any(|fatal| fatal == run.to_string())
    {
        std::process::abort();
    }
}

const MASSES: &str = "body.bob.mass=1:60:60";

/// A separate process that performs a sweep, if a test has started it.
#[test]
fn a_process_that_may_be_ended() {
    if let (Ok(_), Ok(folder)) = (std::env::var(FATAL), std::env::var("PFAFF_TEST_FOLDER")) {
        let registry = Registry::standard();
        let settings = SweepSettings {
            threads: 2,
            ..SweepSettings::default()
        };
        let sweep = sweep(&registry, PENDULUM, &[MASSES]);
        sweep
            .run_into(folder.as_ref(), &settings, || false, |_| {})
            .expect("made");
    }
}

#[test]
fn a_run_that_ends_its_process_twice_is_named() {
    let registry = Registry::standard();
    let (folder, whole) = (Folder::new("fatal"), Folder::new("fatal-whole"));
    let mut deaths = 0;
    loop {
        let child = std::process::Command::new(std::env::current_exe().expect("known"))
            .args(["--exact", "sweep::tests::a_process_that_may_be_ended"])
            .env(FATAL, "7 45")
            .env("PFAFF_TEST_FOLDER", &folder.0)
            .output()
            .expect("it begins");
        if child.status.success() {
            break;
        }
        deaths += 1;
        assert!(deaths <= 6, "{child:?}");
    }
    // Each run ends the process twice alone. It also ends the process once together with other
    // runs, unless both runs ended the process at the same time.
    assert!((5..=6).contains(&deaths), "{deaths}");
    let sweep = sweep(&registry, PENDULUM, &[MASSES]);
    let document = run(&sweep, &folder, Shard::WHOLE, 1);
    assert_eq!(
        (document.finished, document.crashed, document.done),
        (60, 2, 58)
    );
    assert_eq!(document.repeated, 0);
    let failures: Vec<_> = document
        .failures
        .iter()
        .map(|f| (f.run, f.status.as_str()))
        .collect();
    assert_eq!(failures, [(7, "crashed"), (45, "crashed")]);
    run(&sweep, &whole, Shard::WHOLE, 1);
    let (found, expected) = (folder.table(), whole.table());
    for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
        assert_eq!(found == expected, ![7, 45].contains(&k), "{found:?}");
    }
    // Stored results remain available.
    let again = SweepSettings::default();
    let note = |progress: SweepProgress<'_>| {
        assert!(matches!(
            progress,
            SweepProgress::Begin {
                runs: 60,
                finished: 60
            }
        ));
    };
    sweep
        .run_into(&folder.0, &again, || false, note)
        .expect("nothing is left");
    // On request, the rows of the crashed runs are deleted. Then only these two runs are repeated.
    assert_eq!(super::forget_crashed(&folder.0).expect("forgotten"), 2);
    assert_eq!(super::forget_crashed(&folder.0).expect("forgotten"), 0);
    let (mut finished, mut made) = (0, Vec::new());
    let note = |progress: SweepProgress<'_>| match progress {
        SweepProgress::Begin { finished: n, .. } => finished = n,
        SweepProgress::Finished(row) => made.push(row.run),
    };
    let outcome = sweep.run_into(&folder.0, &again, || false, note);
    let document = outcome.expect("made").document;
    made.sort_unstable();
    assert_eq!((finished, made), (58, vec![7, 45]));
    assert_eq!((document.done, document.crashed), (60, 0));
    assert_eq!(folder.table(), whole.table());
}

#[test]
fn an_interrupted_sweep_goes_on_where_it_was() {
    let registry = Registry::standard();
    let sweep = sweep(&registry, PENDULUM, &["body.bob.mass=1:12:12"]).keeping_rows();
    let (folder, whole) = (Folder::new("interrupted"), Folder::new("whole"));
    let count = AtomicUsize::new(0);
    let settings = SweepSettings {
        threads: 2,
        ..SweepSettings::default()
    };
    let mut seen = Vec::new();
    for limit in [4, 1000] {
        count.store(0, Ordering::Relaxed);
        let interrupted = || count.load(Ordering::Relaxed) >= limit;
        let note = |progress: SweepProgress<'_>| {
            if let SweepProgress::Finished(row) = progress {
                count.fetch_add(1, Ordering::Relaxed);
                seen.push(row.run);
            }
        };
        let document = sweep
            .run_into(&folder.0, &settings, interrupted, note)
            .expect("written")
            .document;
        assert_eq!(document.finished as usize, seen.len());
        assert_eq!(document.partial, limit == 4);
    }
    seen.sort_unstable();
    assert_eq!(seen, (1..=12).collect::<Vec<_>>());
    run(&sweep, &whole, Shard::WHOLE, 1);
    assert_eq!(folder.table(), whole.table());
    for run in 1..=12 {
        let name = format!("runs/{run:02}/trajectory.csv");
        let [a, b] = [&folder, &whole].map(|f| fs::read(f.0.join(&name)).expect("kept"));
        assert!(
            a == b && a.iter().filter(|b| **b == b'\n').count() == 6,
            "{name}"
        );
    }
}

#[test]
fn wrong_sweeps_are_refused_before_anything_is_written() {
    let registry = Registry::standard();
    let folder = Folder::new("refused");
    let refused = |scene: &str, vary: &[&str]| {
        let axes = vary
            .iter()
            .map(|axis| axis.parse().expect("an axis"))
            .collect();
        let sweep = match Sweep::read("scene.toml", scene, &registry, axes) {
            Ok(sweep) => sweep,
            Err(error) => return error,
        };
        let settings = SweepSettings::default();
        let begun = sweep.run_into(&folder.0, &settings, || false, |_| {});
        begun.expect_err("refused")
    };
    let endless = PENDULUM.replace("simulate", "# simulate");
    let wrong = PENDULUM.replace("mass = 2.0", "mass = -2.0");
    for (error, piece) in [
        (refused(PENDULUM, &[]), "nothing is varied"),
        (
            refused(PENDULUM, &["body.bib.mass=1,2"]),
            "there is no `bib` in `body`; did you mean `bob`?",
        ),
        (
            refused(PENDULUM, &["body.bob.mass=1,2", "body[0].mass=3,4"]),
            "are the same number",
        ),
        (
            refused(PENDULUM, &["body.bob.mas=1,2"]),
            "all 2 runs fail at the start; the first, with body.bob.mas = 1: body `bob` has no key `mas`; did you mean `mass`?",
        ),
        (refused(PENDULUM, &["body.bob.mass=-1,-2"]), "mass is -1"),
        (refused(&endless, &["body.bob.mass=1,2"]), "t_end"),
        (refused(&wrong, &["body.bob.mass=1,2"]), "mass is -2"),
    ] {
        assert!(
            error.is_input() && error.to_string().contains(piece),
            "{error}"
        );
    }
    assert!(!folder.0.exists());
    // A directory with results of another sweep is not changed.
    run(
        &sweep(&registry, PENDULUM, &["body.bob.mass=1,2"]),
        &folder,
        Shard::WHOLE,
        1,
    );
    let before = folder.table();
    for (scene, vary, piece) in [
        (
            PENDULUM,
            "body.bob.mass=1,3",
            "the grid is body.bob.mass=1,3, and was body.bob.mass=1,2",
        ),
        (
            &PENDULUM.replace("9.81", "9.8"),
            "body.bob.mass=1,2",
            "the text of the scene is",
        ),
    ] {
        let error = refused(scene, &[vary]);
        assert!(matches!(error, SweepError::Journal(_)) && error.is_input());
        assert!(error.to_string().contains(piece), "{error}");
        assert_eq!(folder.table(), before);
    }
}

/// The columns of varied numbers are in SI units, in any notation of the input, like all other
/// columns.
#[test]
fn varied_numbers_are_in_si_whatever_was_typed() {
    let scene = "
[scene]
name = \"arm\"
space = \"plane\"
format = 2
units = { length = \"mm\", angle = \"deg\" }
[[body]]
name = \"arm\"
mass = 1.0
inertia = 100.0
position = [50.0, 0.0]
[[joint]]
name = \"pin\"
type = \"revolute\"
bodies = [\"ground\", \"arm\"]
at = [0.0, 0.0]
[simulate]
t_end = 0.1
";
    let registry = Registry::standard();
    let told = |vary: &str| {
        let sweep = sweep(&registry, scene, &[vary]);
        (1..=2).map(|run| sweep.point(run)[0]).collect::<Vec<f64>>()
    };
    let near = |found: &[f64], expected: [f64; 2]| {
        let is_near = |(a, b): (&f64, f64)| (a - b).abs() <= 1e-15 * b;
        found.iter().zip(expected).all(is_near)
    };
    // The cases are kg·mm², for which the scene has no separate unit, and mm, deg and plain
    // numbers.
    for (bare, with_unit, expected) in [
        ("body.arm.inertia=100,200", None, [1e-4, 2e-4]),
        (
            "body.arm.position[0]=50:60:2",
            Some("body.arm.position[0]=5cm:6cm:2"),
            [0.05, 0.06],
        ),
        (
            "body.arm.angle=10:20:2",
            Some("body.arm.angle=10deg:20deg:2"),
            {
                let degree = std::f64::consts::PI / 180.0;
                [10.0 * degree, 20.0 * degree]
            },
        ),
        ("body.arm.mass=2,3", None, [2.0, 3.0]),
        ("simulate.t_end=0.1,0.2", None, [0.1, 0.2]),
    ] {
        for vary in std::iter::once(bare).chain(with_unit) {
            let found = told(vary);
            assert!(near(&found, expected), "{vary}: {found:?}");
        }
    }
}
