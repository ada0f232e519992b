//! An output directory: complete files or none, and errors with paths.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use report::OutputDirectory;

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
fn an_abandoned_file_stays_a_part() {
    let path = place("abandoned");
    let directory = OutputDirectory::create(&path).expect("makes it");
    let mut file = directory.file("x.csv").expect("begins");
    file.write_all(b"half").expect("writes");
    drop(file);
    assert!(!path.join("x.csv").exists());
    assert_eq!(fs::read(path.join("x.csv.part")).expect("reads"), b"half");
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

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_names_the_file() {
    let path = place("full");
    let directory = OutputDirectory::create(&path).expect("makes it");
    let full = || {
        std::os::unix::fs::symlink("/dev/full", path.join("x.csv.part")).expect("links");
        directory.file("x.csv").expect("opens")
    };
    let mut file = full();
    file.write_all(b"0").expect("still in the buffer");
    let error = file.finish().expect_err("the disk is full");
    assert!(error.to_string().contains("x.csv.part"), "{error}");
    assert!(!path.join("x.csv").exists());
    fs::remove_file(path.join("x.csv.part")).expect("removes the link");

    let mut file = full();
    let error = file
        .write_all(&[0; 1 << 20])
        .expect_err("more than the buffer takes");
    assert_eq!(error.kind(), std::io::ErrorKind::StorageFull);
    assert!(error.to_string().contains("x.csv.part"), "{error}");
    // Bytes after a gap would appear to belong to the end.
    let again = file.write_all(b"0").expect_err("it was refused");
    assert_eq!(again.kind(), std::io::ErrorKind::StorageFull);
    let error = file.finish_partial().expect_err("the end is missing");
    assert!(error.to_string().contains("the end of"), "{error}");
    // The written part has the final name nevertheless.
    assert!(path.join("x.csv").is_symlink());
}

#[cfg(target_os = "linux")]
#[test]
fn an_unwritable_directory_is_named() {
    // No user, not even root, can create files there.
    let error = OutputDirectory::create("/proc/results").expect_err("not writable");
    assert!(error.to_string().contains("/proc/results"), "{error}");
    let directory = OutputDirectory::create("/proc").expect("it is there");
    let error = directory.write("x.csv", b"").expect_err("not writable");
    assert!(error.to_string().contains("/proc/x.csv.part"), "{error}");
}
