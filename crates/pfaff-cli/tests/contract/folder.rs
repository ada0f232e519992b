//! Helpers for tests of programs: a directory for each test, and the output of a program.

use std::path::{Path, PathBuf};
use std::process::Output;

pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

/// A directory of one test, removed at its end. Its path starts at this package where it can:
/// messages are wrapped, and where they break must not depend on where the checkout is.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let temporary = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let path = match temporary.strip_prefix(root.canonicalize().expect("the workspace")) {
            Ok(inside) => Path::new("../..").join(inside).join(name),
            Err(_) => temporary.join(name),
        };
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }

    pub(crate) fn text(&self) -> &str {
        self.0.to_str().expect("UTF-8")
    }

    pub(crate) fn read(&self, name: &str) -> String {
        let path = self.0.join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
