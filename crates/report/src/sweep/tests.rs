//! Tests that damaged files can be read. Also tests that tables do not depend on interruptions or
//! on the process that made the rows.

use std::fs;
use std::path::PathBuf;

use solvability::{Value, Verdict};

use super::line::line;
use super::{
    Cell, Extent, JournalError, Records, Runs, Shards, SweepDocument, SweepMotion, SweepPlan,
    SweepRow, SweepStatus, digest, write_sweep,
};
use crate::files::process::Process;
use crate::files::{FileError, OutputDirectory};
use crate::peaks::Peak;
use crate::tables::TableError;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("pfaff-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("writable");
        Self(path)
    }

    fn shards(&self) -> Shards {
        Shards::open(&self.0, &plan()).expect("free")
    }

    /// Names of the files with this extension.
    fn names(&self, ending: &str) -> Vec<String> {
        let entries = fs::read_dir(self.0.join("shards")).expect("begun");
        let names = entries.map(|e| {
            e.expect("readable")
                .file_name()
                .to_string_lossy()
                .into_owned()
        });
        let mut names: Vec<String> = names.filter(|name| name.ends_with(ending)).collect();
        names.sort();
        names
    }

    /// The only journal.
    fn journal(&self) -> PathBuf {
        let names = self.names(".journal");
        assert_eq!(names.len(), 1, "{names:?}");
        self.0.join("shards").join(&names[0])
    }

    fn read(&self) -> Records {
        self.shards().read(runs(1, 4)).expect("whole")
    }
}

fn runs(first: u64, last: u64) -> Runs {
    Runs::new(first, last).expect("some")
}

fn numbers(records: &Records) -> Vec<u64> {
    records.rows.keys().copied().collect()
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn plan() -> SweepPlan {
    SweepPlan {
        scene: "drop".to_owned(),
        digest: "0123456789abcdef".to_owned(),
        version: "0.1.0".to_owned(),
        vary: vec!["body.bob.mass=1:4:4".to_owned()],
        runs: 4,
        keep_rows: false,
        keys: vec!["body.bob.mass".to_owned()],
        bodies: vec!["bob".to_owned()],
        state: super::planar(),
        reactions: vec!["pivot".to_owned()],
        bounds: false,
    }
}

fn row(run: u64) -> SweepRow {
    let x = run as f64;
    SweepRow {
        run,
        varied: vec![x / 3.0],
        status: SweepStatus::Done,
        error: String::new(),
        motion: Some(SweepMotion {
            method: "dop853",
            t: 1.0,
            steps: 10 * run,
            rejected: 0,
            evaluations: 120 * run,
            projections: 10,
            seconds: 1e-3,
            max_position_residual: 5e-324,
            max_velocity_residual: 1e-17,
            energy_balance: 1e-9 * x,
            start_correction: -0.0,
            start_velocity_correction: 0.5,
            events: 0,
            rank: 2,
            redundancy: 0,
            not_unique: Some(0),
            fragile: 0,
            t_state: 1.0,
            state: vec![0.1 + 0.2, -1e300, x, 1.0 / x, f64::NAN, f64::INFINITY],
            peaks: vec![[None, None]],
            at_most: None,
        }),
    }
}

fn refused(run: u64) -> SweepRow {
    SweepRow {
        status: SweepStatus::Refused,
        error: "mass is -1,\n need \"≥ 0\"".to_owned(),
        motion: None,
        ..row(run)
    }
}

/// An attempt that is ended intentionally.
fn fill(folder: &Folder, of: Runs, rows: &[SweepRow]) {
    let mut journal = folder.shards().begin(of).expect("free");
    for row in rows {
        journal.append(row).expect("writable");
    }
    journal.finish().expect("writable");
}

/// Writes a journal of a process that is no longer running. The journal contains the lines of a
/// running process with another header.
fn left_by(host: &str, folder: &Folder, name: &str, of: Runs, lines: &[&str]) {
    let own = Process::own();
    let host = if host.is_empty() { &own.host } else { host };
    let head = format!(
        r#"{{"plan":"{}","runs":[{},{}],"host":"{host}","pid":{},"born":{}}}"#,
        folder.shards().mark,
        of.first(),
        of.last(),
        own.pid,
        // No process with this identifier started at that time.
        own.born + 1,
    );
    let mut bytes = line(head.as_bytes());
    lines
        .iter()
        .for_each(|text| bytes.extend(line(text.as_bytes())));
    let path = folder
        .0
        .join("shards")
        .join(format!("{}.{name}.journal", of.name(4)));
    fs::write(path, bytes).expect("writable");
}

#[derive(Debug)]
struct Any(#[expect(dead_code, reason = "shown by expect")] String);
impl From<FileError> for Any {
    fn from(e: FileError) -> Self {
        Self(e.to_string())
    }
}
impl From<TableError> for Any {
    fn from(e: TableError) -> Self {
        Self(e.to_string())
    }
}

#[test]
fn a_row_comes_back_with_its_bits() {
    let folder = Folder::new("bits");
    fill(&folder, runs(1, 4), &[row(2), refused(1)]);
    let unsealed = folder.read();
    folder
        .shards()
        .seal(runs(1, 2), &unsealed)
        .expect("writable");
    folder.shards().tidy(runs(1, 4)).expect("writable");
    // The journal contains more runs.
    assert_eq!(folder.names(".journal").len(), 1);
    fs::remove_file(folder.journal()).expect("there");
    let sealed = folder.read();
    assert_eq!(sealed.sealed, [runs(1, 2)]);
    for records in [unsealed, sealed] {
        assert_eq!(records.plan, plan());
        assert_eq!((numbers(&records), records.repeated), (vec![1, 2], 0));
        assert_eq!(records.missing(runs(1, 4)), [runs(3, 4)]);
        for (expected, found) in [(refused(1), &records.rows[&1]), (row(2), &records.rows[&2])] {
            let expected = plan().cells(&expected);
            assert_eq!(found.len(), plan().columns().len());
            for (a, b) in expected.iter().zip(found) {
                assert!(a.is_same(b), "{a} {b}");
            }
        }
    }
}

/// If a journal is truncated at any position, the rows of its complete lines are read, and another
/// attempt makes the other runs.
#[test]
fn a_journal_may_be_cut_at_any_byte() {
    let folder = Folder::new("cut");
    fill(&folder, runs(1, 4), &[row(1), row(2), row(3)]);
    let path = folder.journal();
    let whole = fs::read(&path).expect("readable");
    for length in 0..whole.len() {
        fs::write(&path, &whole[..length]).expect("writable");
        let lines = whole[..length].iter().filter(|b| **b == b'\n').count();
        let expected: Vec<u64> = (1..lines.min(4) as u64).collect();
        assert_eq!(numbers(&folder.read()), expected, "cut at {length}");
    }
    fill(&folder, runs(1, 4), &[row(3), row(4)]);
    assert_eq!(numbers(&folder.read()), [1, 2, 3, 4]);
}

#[test]
fn damaged_lines_are_made_again() {
    let folder = Folder::new("damaged");
    fill(&folder, runs(1, 4), &[row(1), row(2), row(3)]);
    let path = folder.journal();
    let whole = fs::read(&path).expect("readable");
    let ends: Vec<usize> = (0..whole.len()).filter(|k| whole[*k] == b'\n').collect();
    // One digit of the second row is changed.
    let mut bytes = whole.clone();
    bytes[ends[1] + 40] ^= 1;
    // After a power failure, a file may contain zeros after its old end.
    bytes.extend([0; 100]);
    fs::write(&path, &bytes).expect("writable");
    assert_eq!(numbers(&folder.read()), [1, 3]);
    // A damaged shard does not count as finished.
    fs::write(&path, &whole).expect("writable");
    let shards = folder.shards();
    shards.seal(runs(1, 3), &folder.read()).expect("writable");
    fs::remove_file(&path).expect("there");
    assert_eq!(folder.read().sealed, [runs(1, 3)]);
    let sealed = folder.0.join("shards/1-3.rows");
    let mut bytes = fs::read(&sealed).expect("readable");
    let end = bytes.len() - 40;
    bytes[end] ^= 1;
    fs::write(&sealed, &bytes).expect("writable");
    let records = folder.read();
    assert_eq!((numbers(&records), records.sealed), (vec![1, 2], vec![]));
    // After a damaged first line, the meaning of the rows is unknown.
    bytes[30] ^= 1;
    for bytes in [bytes.as_slice(), b"# somebody's diary\n"] {
        fs::write(&sealed, bytes).expect("writable");
        let error = shards.read(runs(1, 4)).expect_err("damaged");
        assert!(matches!(error, JournalError::Damaged { .. }), "{error}");
    }
    fs::remove_file(&sealed).expect("there");
    fs::write(folder.0.join("shards/plan"), b"").expect("writable");
    for error in [
        Shards::open(&folder.0, &plan()).expect_err("damaged"),
        Records::merged(&[&folder.0]).expect_err("damaged"),
    ] {
        assert!(matches!(error, JournalError::Damaged { .. }), "{error}");
    }
}

#[test]
fn another_sweep_is_refused_by_name() {
    let folder = Folder::new("changed");
    fill(&folder, runs(1, 4), &[row(1)]);
    let before = folder.names("");
    for (other, what) in [
        (
            SweepPlan {
                digest: "f".to_owned(),
                ..plan()
            },
            "the text of the scene is f, and was 0123456789abcdef",
        ),
        (
            SweepPlan {
                vary: vec!["a=1:2:3".to_owned()],
                ..plan()
            },
            "the grid is a=1:2:3, and was body.bob.mass=1:4:4",
        ),
        (
            SweepPlan {
                version: "0.2.0".to_owned(),
                ..plan()
            },
            "the program is 0.2.0, and was 0.1.0",
        ),
        (
            SweepPlan {
                keep_rows: true,
                ..plan()
            },
            "it is with trajectories, and was without trajectories",
        ),
        (
            SweepPlan {
                bodies: Vec::new(),
                ..plan()
            },
            "what the rows have",
        ),
    ] {
        let error = Shards::open(&folder.0, &other).expect_err("another sweep");
        assert!(error.to_string().contains(what), "{error}");
        assert_eq!(folder.names(""), before);
    }
    // A file of another sweep that was copied into this folder.
    let (other, name) = (Folder::new("changed-too"), folder.journal());
    let beside = SweepPlan { runs: 5, ..plan() };
    let shards = Shards::open(&other.0, &beside).expect("free");
    shards
        .begin(runs(1, 4))
        .expect("free")
        .finish()
        .expect("writable");
    fs::copy(other.journal(), name).expect("writable");
    let error = folder.shards().read(runs(1, 4)).expect_err("another sweep");
    assert!(
        error.to_string().contains("the digest of its plan"),
        "{error}"
    );
    let error = Records::merged(&[&other.0, &folder.0]).expect_err("another sweep");
    assert!(matches!(error, JournalError::Changed { .. }), "{error}");
    let empty = Folder::new("empty");
    let error = Records::merged(&[&empty.0]).expect_err("nothing there");
    assert!(matches!(error, JournalError::Missing { .. }), "{error}");
}

/// Tests two rows of one run: a repetition is counted, a copy is not counted, and different rows
/// are rejected with an error.
#[test]
fn rows_of_one_run_must_agree() {
    let [one, two, three] = ["agree", "agree-too", "agree-not"].map(Folder::new);
    fill(&one, runs(1, 4), &[row(1), row(2)]);
    let slower = |run: u64| {
        let mut row = row(run);
        row.motion.as_mut().expect("it moved").seconds = 0.5;
        row
    };
    fill(&two, runs(2, 3), &[slower(2), row(3)]);
    let merged = Records::merged(&[&one.0, &two.0]).expect("they agree");
    assert_eq!((numbers(&merged), merged.repeated), (vec![1, 2, 3], 1));
    let merged = Records::merged(&[&one.0, &one.0]).expect("they agree");
    assert_eq!((numbers(&merged), merged.repeated), (vec![1, 2], 0));
    let other = |change: fn(&mut SweepMotion)| {
        let mut row = row(2);
        change(row.motion.as_mut().expect("it moved"));
        row
    };
    for (row, what) in [
        (
            other(|m| m.state[0] = 0.3),
            "`bob.x` is 0.30000000000000004 in",
        ),
        (
            other(|m| m.start_correction = 0.0),
            "`start_correction` is -0.0 in",
        ),
        (other(|m| m.steps = 21), "`steps` is 20 in"),
        (refused(2), "`status` is \"done\" in"),
    ] {
        let _ = fs::remove_dir_all(&three.0);
        fill(&three, runs(1, 4), &[row]);
        let error = Records::merged(&[&one.0, &three.0]).expect_err("they differ");
        assert!(
            matches!(&error, JournalError::Differs(d) if d.run == 2),
            "{error}"
        );
        assert!(error.to_string().contains(what), "{error}");
        assert!(
            error
                .to_string()
                .contains(&three.journal().display().to_string()),
            "{error}"
        );
    }
    // On one machine the process ended during a run, and on another machine it did not.
    let crashed = SweepRow {
        status: SweepStatus::Crashed,
        ..refused(2)
    };
    let _ = fs::remove_dir_all(&three.0);
    fill(&three, runs(1, 4), &[crashed, row(4)]);
    for order in [[&one.0, &three.0], [&three.0, &one.0]] {
        let merged = Records::merged(&order).expect("they agree");
        assert_eq!((numbers(&merged), merged.repeated), (vec![1, 2, 4], 1));
        let cells = plan().cells(&row(2));
        assert!(
            merged.rows[&2]
                .iter()
                .zip(&cells)
                .all(|(a, b)| a.is_same(b))
        );
    }
}

/// Runs are suspect if a process ended during these runs. They are not suspect if the process ended
/// intentionally, is still running, or has finished the runs. The runs of a process on another
/// machine are requested again only if the journal of that process is removed.
#[test]
fn only_an_end_without_a_word_makes_runs_suspect() {
    let folder = Folder::new("suspects");
    let suspects = |of: Runs| {
        let records = folder.shards().read(of).expect("whole");
        records.suspects.into_iter().collect::<Vec<_>>()
    };
    let mut running = folder.shards().begin(runs(1, 4)).expect("free");
    running.begin(&[1, 2]).expect("writable");
    assert_eq!(suspects(runs(1, 4)), []);
    running.finish().expect("writable");
    assert_eq!(suspects(runs(1, 4)), []);
    // The state after a panic or an error.
    let mut dropped = folder.shards().begin(runs(1, 4)).expect("free");
    dropped.begin(&[1, 2]).expect("writable");
    drop(dropped);
    assert_eq!(suspects(runs(1, 4)), []);
    // The state after an intended end of the process, while its threads may still be running.
    let mut ended = folder.shards().begin(runs(1, 4)).expect("free");
    ended.begin_alone(3).expect("writable");
    super::end_attempts(&folder.0);
    let bytes = fs::read_dir(folder.0.join("shards"))
        .expect("begun")
        .count();
    std::mem::forget(ended);
    assert_eq!((suspects(runs(1, 4)), bytes), (vec![], 4));

    if Process::own().born == 0 {
        return;
    }
    left_by(
        "",
        &folder,
        "a",
        runs(1, 4),
        &["begin 1 2 3", "begin 4", "end"],
    );
    assert_eq!(suspects(runs(1, 4)), []);
    left_by("", &folder, "b", runs(1, 4), &["begin 1 2 3", "begin 4"]);
    assert_eq!(suspects(runs(1, 4)).len(), 4);
    let row = String::from_utf8(super::line::record(&plan().cells(&row(2))).expect("fits"));
    let row = row.expect("UTF-8");
    left_by(
        "",
        &folder,
        "c",
        runs(1, 4),
        &["alone 1", "begin 2 3", &row],
    );
    assert_eq!(suspects(runs(1, 4)), [(1, 1), (3, 0), (4, 0)]);
    left_by("elsewhere", &folder, "d", runs(3, 4), &["alone 3"]);
    assert_eq!(suspects(runs(1, 4)), [(1, 1), (3, 0), (4, 0)]);
    let asked = suspects(runs(3, 4));
    assert!(
        asked.contains(&(3, 1)) && asked.contains(&(4, 0)),
        "{asked:?}"
    );
    left_by("", &folder, "e", runs(1, 4), &["alone 1"]);
    assert_eq!(suspects(runs(1, 4))[0], (1, 2));
}

/// Journals are removed when their runs are in finished shards, except journals of processes that
/// are still running.
#[test]
fn finished_shards_take_the_place_of_journals() {
    let folder = Folder::new("tidy");
    let shards = folder.shards();
    fill(&folder, runs(1, 2), &[row(1), row(2)]);
    fill(&folder, runs(1, 4), &[row(3)]);
    let mut running = shards.begin(runs(3, 4)).expect("free");
    running.append(&row(4)).expect("writable");
    shards.seal(runs(1, 2), &folder.read()).expect("writable");
    shards.tidy(runs(1, 2)).expect("writable");
    assert_eq!(folder.names(".journal").len(), 2);
    shards.seal(runs(3, 4), &folder.read()).expect("writable");
    shards.tidy(runs(1, 4)).expect("writable");
    assert_eq!(folder.names(".journal").len(), 1);
    running.finish().expect("writable");
    shards.tidy(runs(1, 4)).expect("writable");
    assert_eq!(folder.names(".journal").len(), 0);
    let records = folder.read();
    assert_eq!((numbers(&records), records.repeated), (vec![1, 2, 3, 4], 0));
    assert_eq!(shards.sealed().expect("readable"), [runs(1, 2), runs(3, 4)]);
    let parquet = folder.names(".parquet");
    if cfg!(feature = "parquet") {
        assert_eq!(parquet, ["1-2.parquet", "3-4.parquet"]);
    }
    // The bytes of a shard depend only on its rows, not on the process that writes the shard.
    let other = Folder::new("tidy-too");
    fill(&other, runs(1, 4), &[row(4), row(3)]);
    let records = other.read();
    other.shards().seal(runs(3, 4), &records).expect("writable");
    let bytes = |folder: &Folder| fs::read(folder.0.join("shards/3-4.rows")).expect("there");
    assert!(bytes(&folder) == bytes(&other));
    assert_eq!(other.names(".part").len(), 0);
}

#[test]
fn tables_do_not_depend_on_who_made_the_rows() {
    let (one, two) = (Folder::new("one"), Folder::new("two"));
    fill(&one, runs(1, 4), &[row(1), refused(2), row(3), row(4)]);
    fill(&two, runs(3, 4), &[row(4), row(3)]);
    two.shards()
        .seal(runs(3, 4), &two.read())
        .expect("writable");
    fill(&two, runs(1, 4), &[refused(2), row(1), row(4)]);
    let tables = |folder: &Folder| {
        let directory = OutputDirectory::create(&folder.0).expect("writable");
        let document: SweepDocument =
            write_sweep::<Any>(&directory, &folder.read()).expect("writable");
        let read = |name: &str| fs::read(folder.0.join(name)).expect("written");
        let mut files = vec![read("sweep.csv"), read("summary.json")];
        if cfg!(feature = "parquet") {
            files.push(read("sweep.parquet"));
        }
        (document, files)
    };
    let (document, files) = tables(&one);
    assert!(files == tables(&two).1);
    assert_eq!(
        (
            document.runs,
            document.finished,
            document.done,
            document.refused,
            document.partial
        ),
        (4, 4, 3, 1, false)
    );
    assert_eq!(
        (document.max_energy_balance, document.max_energy_balance_run),
        (Some(4e-9), Some(4))
    );
    assert_eq!(document.failures.len(), 1);
    assert_eq!(document.failures[0].error, "mass is -1, need \"≥ 0\"");
    let text = String::from_utf8(files[0].clone()).expect("UTF-8");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[0],
        "run,body.bob.mass,status,error,method,t,steps,rejected,evaluations,projections,events,rank,redundancy,not_unique,fragile,\
         seconds,max_position_residual,max_velocity_residual,energy_balance,start_correction,start_velocity_correction,t_state,bob.x,bob.y,bob.angle,bob.vx,\
         bob.vy,bob.omega,pivot.F_max,pivot.F_max_t,pivot.T_max,pivot.T_max_t"
    );
    assert_eq!(
        lines[1],
        "1,0.3333333333333333,done,,dop853,1.0,10,0,120,10,0,2,0,0,0,0.001,5e-324,1e-17,1e-9,-0.0,0.5,1.0,0.30000000000000004,-1e300,\
         1.0,1.0,NaN,inf,NaN,NaN,NaN,NaN"
    );
    assert!(lines[2].starts_with(
        "2,0.6666666666666666,refused,\"mass is -1, need \"\"≥ 0\"\"\",,NaN,,,,,,,,,,NaN,"
    ));
}

/// A summary states the missing runs.
#[test]
fn gaps_are_told_as_runs() {
    let folder = Folder::new("gaps");
    fill(&folder, runs(1, 4), &[row(3)]);
    let document = SweepDocument::new(&folder.read(), Extent::Whole);
    assert_eq!(document.missing, [runs(1, 2), runs(4, 4)]);
    assert!(document.partial && document.shard.is_none());
    let shard = folder.shards().read(runs(3, 3)).expect("whole");
    let document = SweepDocument::new(&shard, Extent::Shard(Runs::new(3, 3)));
    assert_eq!(
        (document.runs, document.finished, document.partial),
        (4, 1, false)
    );
    let text = serde_json::to_value(&document).expect("JSON");
    assert_eq!(text["shard"], serde_json::json!([3, 3]));
}

/// If a value is not determined, the time of the value is also omitted.
#[test]
fn cells_of_peaks_are_determined() {
    let plan = plan();
    let peak = |value| Peak {
        value,
        time: 0.5,
        over: vec![[0.0, 1.0]],
    };
    let mut row = row(1);
    let motion = row.motion.as_mut().expect("it began");
    let open = Value::new(3.0, Verdict::NotUnique, None);
    motion.peaks = vec![[Some(peak(Value::unique(2.0))), Some(peak(open))]];
    let cells = plan.cells(&row);
    let last: Vec<f64> = cells[cells.len() - 4..]
        .iter()
        .map(|cell| match cell {
            Cell::Number(x) => *x,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(last[..2], [2.0, 0.5]);
    assert!(last[2..].iter().all(|x| x.is_nan()), "{last:?}");
}

#[test]
fn digests_differ() {
    let texts: Vec<String> = (0..1000).map(|k| format!("mass = {k}")).collect();
    let digests: std::collections::BTreeSet<u64> =
        texts.iter().map(|t| digest(t.as_bytes())).collect();
    assert_eq!(digests.len(), texts.len());
}
