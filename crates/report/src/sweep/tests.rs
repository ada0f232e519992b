//! Journals survive damage to files; tables are the same after any interruption.

use std::fs;
use std::path::{Path, PathBuf};

use super::{
    Cell, Extreme, Journal, JournalError, Journals, SweepMotion, SweepPlan, SweepRow, SweepStatus,
    digest, write_sweep,
};
use crate::files::{FileError, OutputDirectory};
use crate::tables::TableError;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("pfaff-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("writable");
        Self(path)
    }

    fn journal(&self) -> PathBuf {
        self.0.join("sweep.journal")
    }
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
            not_unique: 0,
            fragile: 0,
            t_state: 1.0,
            state: vec![0.1 + 0.2, -1e300, x, 1.0 / x, f64::NAN, f64::INFINITY],
            extremes: vec![Extreme::UNKNOWN],
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

fn fill(folder: &Path, name: &str, rows: &[SweepRow]) {
    let mut journal = Journal::open(folder, name, &plan()).expect("free");
    for row in rows {
        journal.append(row).expect("writable");
    }
    journal.finish().expect("writable");
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
impl From<JournalError> for Any {
    fn from(e: JournalError) -> Self {
        Self(e.to_string())
    }
}

#[test]
fn a_row_comes_back_with_its_bits() {
    let folder = Folder::new("bits");
    fill(&folder.0, "sweep", &[row(2), refused(1)]);
    let journals = Journals::read(&[&folder.0]).expect("whole");
    assert_eq!(journals.plan, plan());
    assert_eq!(journals.rows.keys().copied().collect::<Vec<_>>(), [1, 2]);
    for (expected, found) in [
        (refused(1), &journals.rows[&1]),
        (row(2), &journals.rows[&2]),
    ] {
        let expected = plan().cells(&expected);
        assert_eq!(found.len(), plan().columns().len());
        for (a, b) in expected.iter().zip(found) {
            match (a, b) {
                (Cell::Number(a), Cell::Number(b)) if a.is_nan() => assert!(b.is_nan()),
                (Cell::Number(a), Cell::Number(b)) => assert_eq!(a.to_bits(), b.to_bits()),
                _ => assert_eq!(a, b),
            }
        }
    }
}

/// A journal that was cut off anywhere keeps the rows of its complete lines and is continued with
/// the others.
#[test]
fn a_journal_may_be_cut_at_any_byte() {
    let folder = Folder::new("cut");
    fill(&folder.0, "sweep", &[row(1), row(2), row(3)]);
    let whole = fs::read(folder.journal()).expect("readable");
    for length in 0..whole.len() {
        fs::write(folder.journal(), &whole[..length]).expect("writable");
        let lines = whole[..length].iter().filter(|b| **b == b'\n').count();
        let rows = Journals::read(&[&folder.0]).map_or(0, |j| j.rows.len());
        assert_eq!(rows, lines.saturating_sub(1), "cut at {length}");
        if length % 37 == 0 || length + 5 > whole.len() {
            let rest = [row(1), row(2), row(3)];
            fill(&folder.0, "sweep", &rest[rows..]);
            assert!(
                fs::read(folder.journal()).expect("readable") == whole,
                "cut at {length}"
            );
        }
    }
}

#[test]
fn damaged_lines_are_made_again() {
    let folder = Folder::new("damaged");
    fill(&folder.0, "sweep", &[row(1), row(2), row(3)]);
    let whole = fs::read(folder.journal()).expect("readable");
    let ends: Vec<usize> = (0..whole.len()).filter(|k| whole[*k] == b'\n').collect();
    // One digit of the second row is changed.
    let mut bytes = whole.clone();
    bytes[ends[1] + 40] ^= 1;
    // The possible result of a power failure: zeros after the old end of a file.
    bytes.extend([0; 100]);
    fs::write(folder.journal(), &bytes).expect("writable");
    let rows = Journals::read(&[&folder.0]).expect("readable").rows;
    assert_eq!(rows.keys().copied().collect::<Vec<_>>(), [1, 3]);
    fill(&folder.0, "sweep", &[row(2)]);
    let rows = Journals::read(&[&folder.0]).expect("readable").rows;
    assert_eq!(rows.len(), 3);
    // After a damaged first line, the meaning of the rows is unknown.
    bytes[30] ^= 1;
    for bytes in [bytes.as_slice(), b"# somebody's diary\n"] {
        fs::write(folder.journal(), bytes).expect("writable");
        for error in [
            Journal::open(&folder.0, "sweep", &plan()).err(),
            Journals::read(&[&folder.0]).err(),
        ] {
            assert!(
                matches!(error, Some(JournalError::Damaged { .. })),
                "{error:?}"
            );
        }
        assert_eq!(fs::read(folder.journal()).expect("readable"), bytes);
    }
}

#[test]
fn another_sweep_is_refused_by_name() {
    let folder = Folder::new("changed");
    fill(&folder.0, "sweep", &[row(1)]);
    let before = fs::read(folder.journal()).expect("readable");
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
        let error = Journal::open(&folder.0, "sweep", &other).expect_err("another sweep");
        assert!(error.to_string().contains(what), "{error}");
        assert_eq!(fs::read(folder.journal()).expect("readable"), before);
    }
    // Another journal cannot begin in the same directory either.
    let beside = SweepPlan { runs: 5, ..plan() };
    assert!(Journal::open(&folder.0, "sweep-1-of-2", &beside).is_err());
    assert!(!folder.0.join("sweep-1-of-2.journal").exists());
    let _held = Journal::open(&folder.0, "sweep", &plan()).expect("free");
    let error = Journal::open(&folder.0, "sweep", &plan()).expect_err("held");
    assert!(matches!(error, JournalError::Busy { .. }), "{error}");
    let empty = Folder::new("empty");
    let error = Journals::read(&[&folder.0, &empty.0]).expect_err("nothing there");
    assert!(matches!(error, JournalError::Missing { .. }), "{error}");
}

#[test]
fn tables_do_not_depend_on_who_made_the_rows() {
    let (one, two) = (Folder::new("one"), Folder::new("two"));
    fill(&one.0, "sweep", &[row(1), refused(2), row(3), row(4)]);
    fill(&two.0, "sweep-2-of-2", &[row(4), refused(2)]);
    fill(&two.0, "sweep-1-of-2", &[row(3), row(1), row(4)]);
    let tables = |folder: &Folder| {
        let directory = OutputDirectory::create(&folder.0).expect("writable");
        let read = || Journals::read(&[&folder.0]).map_err(Any::from);
        let document = write_sweep(&directory, read).expect("writable");
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

#[test]
fn extremes_are_the_first_largest_values() {
    let mut extreme = Extreme::UNKNOWN;
    for (t, force, torque) in [
        (0.0, f64::NAN, 0.0),
        (1.0, 0.0, 0.0),
        (2.0, 3.0, f64::NAN),
        (3.0, 3.0, 0.5),
    ] {
        extreme.include(t, force, torque);
    }
    assert_eq!((extreme.force, extreme.force_time), (3.0, 2.0));
    assert_eq!((extreme.torque, extreme.torque_time), (0.5, 3.0));
}

#[test]
fn digests_differ() {
    let texts: Vec<String> = (0..1000).map(|k| format!("mass = {k}")).collect();
    let digests: std::collections::BTreeSet<u64> =
        texts.iter().map(|t| digest(t.as_bytes())).collect();
    assert_eq!(digests.len(), texts.len());
}
