//! Tests an output directory: complete files or no file, and errors with paths.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use pfaff_report::{Family, OutputDirectory, Replaces};

/// An empty directory for one test.
fn place(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    if path.exists() {
        fs::remove_dir_all(&path).expect("the place of an earlier run can be removed");
    }
    path
}

#[test]
fn a_file_has_its_name_when_it_is_finished() {
    let path = place("finished");
    let directory = OutputDirectory::create(path.join("a/b")).expect("makes directories");
    directory.write("x.csv", b"old").expect("writes");
    let mut file = directory.file("x.csv").expect("begins");
    file.write_all(b"new").expect("writes");
    assert_eq!(fs::read(path.join("a/b/x.csv")).expect("reads"), b"old");
    let finished = file.finish().expect("finishes");
    assert_eq!(finished, path.join("a/b/x.csv"));
    assert_eq!(fs::read(finished).expect("reads"), b"new");
    assert!(!path.join("a/b/x.csv.part").exists());
}

#[test]
fn a_file_that_is_given_up_leaves_nothing() {
    let path = place("abandoned");
    let directory = OutputDirectory::create(path.join("a/b")).expect("makes directories");
    let mut file = directory.file("x.csv").expect("begins");
    file.write_all(b"half").expect("writes");
    assert!(path.join("a/b/x.csv.part").exists());
    drop(file);
    assert_eq!(fs::read_dir(path.join("a/b")).expect("reads").count(), 0);
    let clone = directory.clone();
    drop(directory);
    assert!(path.join("a/b").exists(), "a clone has it");
    drop(clone);
    assert!(!path.exists(), "no file was written");
}

#[test]
fn directories_that_were_there_or_have_files_stay() {
    let path = place("stays");
    fs::create_dir_all(&path).expect("writable");
    drop(OutputDirectory::create(path.join("empty")).expect("makes it"));
    assert!(path.exists() && !path.join("empty").exists());
    let directory = OutputDirectory::create(path.join("a/b")).expect("makes directories");
    directory.write("x.csv", b"t\n").expect("writes");
    drop(directory);
    assert!(path.join("a/b/x.csv").exists());
    drop(OutputDirectory::create(path.join("a/c")).expect("makes it"));
    assert!(path.join("a").exists() && !path.join("a/c").exists());
}

#[test]
fn a_panic_keeps_what_was_written() {
    let path = place("panic");
    let directory = OutputDirectory::create(&path).expect("makes it");
    let mut file = directory.file("x.csv").expect("begins");
    let panicked = std::panic::catch_unwind(move || {
        file.write_all(b"t\n").expect("writes");
        file.flush().expect("writes");
        panic!("in the middle of a run");
    });
    assert!(panicked.is_err());
    assert_eq!(fs::read(path.join("x.csv.part")).expect("kept"), b"t\n");
}

#[test]
fn a_partial_run_keeps_what_it_has() {
    let path = place("partial");
    let directory = OutputDirectory::create(&path).expect("makes it");
    let mut file = directory.file("x.csv").expect("begins");
    file.write_all(b"t\n0\n").expect("writes");
    file.finish_partial().expect("renames");
    assert_eq!(fs::read(path.join("x.csv")).expect("reads"), b"t\n0\n");
}

#[test]
fn a_file_in_the_place_of_a_directory_is_named() {
    let path = place("taken");
    let directory = OutputDirectory::create(&path).expect("makes it");
    let file = directory.write("out", b"").expect("writes");
    let error = OutputDirectory::create(&file).expect_err("a file is no directory");
    let start = format!("cannot make the directory `{}`: ", file.display());
    assert!(error.to_string().starts_with(&start), "{error}");
    let error = OutputDirectory::create(file.join("deeper")).expect_err("nor has it any");
    assert!(error.to_string().contains("deeper"), "{error}");
}

#[test]
fn a_directory_in_the_place_of_a_file_is_named() {
    let path = place("directories");
    let directory = OutputDirectory::create(&path).expect("makes it");
    fs::create_dir_all(path.join("x.csv.part")).expect("makes it");
    let error = directory
        .file("x.csv")
        .expect_err("the part is a directory");
    assert!(error.to_string().contains("x.csv.part"), "{error}");
    fs::create_dir_all(path.join("y.csv/z")).expect("makes it");
    let error = directory
        .write("y.csv", b"1")
        .expect_err("the name is taken");
    assert!(error.to_string().contains("rename"), "{error}");
    assert_eq!(fs::read(path.join("y.csv.part")).expect("kept"), b"1");
}

#[test]
fn names_do_not_leave_the_directory() {
    let directory = OutputDirectory::create(place("names")).expect("makes it");
    for name in ["", ".", "..", "../x", "a/b", "/etc/x", "a/"] {
        let error = directory.file(name).expect_err(name);
        assert!(error.to_string().starts_with(&format!("`{name}` is not")));
    }
}

/// The environment variable for a process that cannot write any byte into a file.
#[cfg(target_os = "linux")]
const FULL: &str = "PFAFF_TEST_FULL";

/// Runs in a separate process with a limit of zero for the size of files.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_names_the_file() {
    use std::process::Command;

    if std::env::var_os(FULL).is_some() {
        return on_a_full_disk();
    }
    let script = "trap '' XFSZ; ulimit -f 0; exec \"$0\" --exact a_full_disk_names_the_file";
    let test = std::env::current_exe().expect("it runs");
    let mut command = Command::new("sh");
    command.args(["-c", script]).arg(test).env(FULL, "1");
    let output = command.output().expect("it starts");
    assert!(output.status.success(), "{output:?}");
}

#[cfg(target_os = "linux")]
fn on_a_full_disk() {
    use std::io::ErrorKind::FileTooLarge;

    let path = place("full");
    let directory = OutputDirectory::create(&path).expect("makes it");
    let mut file = directory.file("x.csv").expect("opens");
    file.write_all(b"0").expect("still in the buffer");
    let error = file.finish().expect_err("the disk is full");
    assert!(error.to_string().contains("x.csv.part"), "{error}");
    assert!(!path.join("x.csv").exists());

    let mut file = directory.file("x.csv").expect("opens");
    let error = file
        .write_all(&[0; 1 << 20])
        .expect_err("more than the buffer takes");
    assert_eq!(error.kind(), FileTooLarge);
    assert!(error.to_string().contains("x.csv.part"), "{error}");
    // After a failed write no bytes are accepted, because the file would have a gap.
    let again = file.write_all(b"0").expect_err("it was refused");
    assert_eq!(again.kind(), FileTooLarge);
    let error = file.finish_partial().expect_err("the end is missing");
    assert!(error.to_string().contains("the end of"), "{error}");
    // The written part has the final name nevertheless.
    assert!(path.join("x.csv").exists());
}

#[test]
fn one_process_at_a_time_has_a_directory() {
    let path = place("locked");
    let open = || OutputDirectory::create(&path).expect("makes it");
    let first = open().exclusive().expect("free");
    let error = open().exclusive().expect_err("taken").to_string();
    assert!(
        error.starts_with("another run of pfaff is writing into"),
        "{error}"
    );
    open().shared().expect_err("taken");
    let kept = first.clone();
    drop(first);
    open().exclusive().expect_err("a clone has it");
    drop(kept);
    let shards = [open().shared(), open().shared()];
    assert!(shards.iter().all(Result::is_ok), "{shards:?}");
    open().exclusive().expect_err("shared");
    drop(shards);
    let last = open().exclusive().expect("free again");
    assert_eq!(fs::read_dir(&path).expect("readable").count(), 0);
    drop(last);
}

#[test]
fn a_process_that_is_ended_leaves_whole_lines_and_a_summary() {
    let path = place("ended");
    let empty = OutputDirectory::create(path.join("empty")).expect("makes it");
    assert!(!empty.abandon(), "nothing has begun");
    assert!(!path.join("empty").exists());
    let directory = OutputDirectory::create(&path).expect("makes it");
    directory.write("b.csv", b"t,b.x\n0,0\n").expect("writes");
    let earlier = OutputDirectory::create(&path).expect("makes it");
    let mut table = earlier.file("a.csv").expect("begins");
    table.write_all(b"t,a.x\n0,1\n0.1,").expect("writes");
    const FAMILY: Family = Family(&["a.csv", "b.csv", "summary.json"]);
    assert!(earlier.abandon_as("summary.json", b"{}", FAMILY));
    let read = |name: &str| fs::read_to_string(path.join(name)).unwrap_or_default();
    assert_eq!(read("a.csv"), "t,a.x\n0,1\n");
    assert_eq!(read("summary.json"), "{}");
    // This file belongs to an earlier run.
    assert!(!path.join("b.csv").exists());
    table.write_all(b"2\n").expect_err("it is over");
    assert_eq!(read("a.csv"), "t,a.x\n0,1\n");
}

/// One of each kind of file.
const EVERY: Family = Family(&[
    "trajectory.csv",
    "work_precision.csv",
    "sweep.csv",
    "summary.json",
    "report.html",
    "scene.toml",
    "binary.svg",
]);

#[test]
fn what_somebody_else_has_written_is_recognised() {
    let path = place("foreign");
    let directory = OutputDirectory::create(&path).expect("makes it");
    for (name, content, is_own) in [
        ("trajectory.csv", "t,bob.x,bob.y\n0,1,2\n", true),
        ("trajectory.csv", "t,x,y\n0,1,2\n", false),
        ("trajectory.csv", "", true),
        ("work_precision.csv", "scene,formulation,method,x\n", true),
        ("sweep.csv", "run,body.bob.mass,status,error\n", true),
        ("sweep.csv", "run,distance\n", false),
        (
            "summary.json",
            "{\n  \"format\": 1,\n  \"version\": \"0.1.0\",\n",
            true,
        ),
        (
            "summary.json",
            "{\"name\": \"package\", \"version\": \"0.1.0\"}",
            false,
        ),
        (
            "report.html",
            "<html><meta name=\"generator\" content=\"pfaff 0.1.0\">",
            true,
        ),
        (
            "report.html",
            "<html><meta name=\"generator\" content=\"mdBook\">",
            false,
        ),
        ("scene.toml", "[scene]", false),
        ("binary.svg", "\u{0}\u{1}", false),
    ] {
        fs::write(path.join(name), content).expect("writable");
        let found = directory.check_ours(EVERY);
        assert_eq!(found.is_ok(), is_own, "{name}: {content}");
        if let Err(error) = found {
            assert!(
                error.to_string().contains(name) && error.is_place(),
                "{error}"
            );
        }
        fs::remove_file(path.join(name)).expect("written");
    }
}

#[cfg(unix)]
#[test]
fn nothing_is_written_through_a_link() {
    use std::os::unix::fs::symlink;

    let path = place("links");
    let directory = OutputDirectory::create(&path).expect("makes it");
    let precious = path.join("precious");
    fs::write(&precious, "mine").expect("writable");
    for name in ["x.csv", "x.csv.part"] {
        symlink(&precious, path.join(name)).expect("links");
    }
    directory.write("x.csv", b"1\n").expect("writes");
    assert!(!path.join("x.csv").is_symlink() && !path.join("x.csv.part").exists());
    // A single file that the user names is not a link.
    let single = path.join("y.html");
    symlink(&precious, &single).expect("links");
    let error = OutputDirectory::around(&single, Replaces::Files).expect_err("a link");
    assert!(
        error.is_place() && error.to_string().contains("y.html"),
        "{error}"
    );
    // The command never removes a link.
    symlink(path.join("x.csv"), path.join("a.csv")).expect("links");
    fs::write(path.join("x.csv"), "t,a.x\n0,1\n").expect("writable");
    let family = Family(&["a.csv", "x.csv"]);
    let removed = directory.keep(family, &["b.csv"]).expect("removes");
    assert_eq!(removed, ["x.csv"]);
    assert!(path.join("a.csv").is_symlink());
    assert_eq!(fs::read_to_string(precious).expect("readable"), "mine");
}

#[cfg(target_os = "linux")]
#[test]
fn an_unwritable_directory_is_named() {
    // No user, not even root, can create files in this directory.
    let error = OutputDirectory::create("/proc/results").expect_err("not writable");
    assert!(error.to_string().contains("/proc/results"), "{error}");
    let directory = OutputDirectory::create("/proc").expect("it is there");
    let error = directory.write("x.csv", b"").expect_err("not writable");
    assert!(error.to_string().contains("/proc/x.csv.part"), "{error}");
}
