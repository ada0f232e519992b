//! Directories that were made for results: those that stay empty are removed again.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Directories that did not exist before, the innermost first.
#[derive(Debug, Default)]
pub(super) struct NewDirectories(Vec<PathBuf>);

impl NewDirectories {
    /// Makes a directory and all above it.
    pub(super) fn all_of(path: &Path) -> io::Result<Self> {
        let is_missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let missing = path.ancestors().take_while(is_missing);
        let made = Self(missing.map(Path::to_owned).collect());
        fs::create_dir_all(path)?;
        Ok(made)
    }

    /// Removes those that are empty.
    pub(super) fn remove_empty(&self) {
        // Directories with files in them are not removed, nor are those above them.
        let _ = self.0.iter().try_for_each(fs::remove_dir);
    }
}

impl Drop for NewDirectories {
    fn drop(&mut self) {
        self.remove_empty();
    }
}
