//! Directories that were created for results. A directory that remains empty is removed again.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Directories that did not exist before, starting with the innermost directory.
#[derive(Debug, Default)]
pub(super) struct NewDirectories(Vec<PathBuf>);

impl NewDirectories {
    /// Creates a directory and all directories above it.
    pub(super) fn all_of(path: &Path) -> io::Result<Self> {
        let is_missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let missing = path.ancestors().take_while(is_missing);
        let made = Self(missing.map(Path::to_owned).collect());
        fs::create_dir_all(path)?;
        Ok(made)
    }

    /// Removes the directories that are empty.
    pub(super) fn remove_empty(&self) {
        // Directories that contain files, and the directories above these directories, are not
        // removed.
        let _ = self.0.iter().try_for_each(fs::remove_dir);
    }
}

impl Drop for NewDirectories {
    fn drop(&mut self) {
        self.remove_empty();
    }
}
