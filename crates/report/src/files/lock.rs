//! The lock of an output directory. The directory itself is locked. If directories cannot be
//! locked, a file in the directory is locked. The operating system releases the lock when the
//! process ends.

use std::fs::{File, TryLockError};
use std::path::Path;

use super::FileError;

/// The file that is locked if directories cannot be locked.
const LOCK: &str = "pfaff.lock";

/// Locks a directory. Returns `None` if the file system does not support locks.
///
/// # Errors
/// [`FileError::Busy`]: another process has the lock.
pub(super) fn of(
    directory: &Path,
    lock: fn(&File) -> Result<(), TryLockError>,
) -> Result<Option<File>, FileError> {
    let makers: [fn(&Path) -> std::io::Result<File>; 2] = [
        |path| File::open(path),
        |path| File::create(path.join(LOCK)),
    ];
    for make in makers {
        let Ok(file) = make(directory) else { continue };
        match lock(&file) {
            Ok(()) => return Ok(Some(file)),
            Err(TryLockError::WouldBlock) => {
                return Err(FileError::Busy {
                    directory: directory.to_owned(),
                });
            }
            Err(TryLockError::Error(_)) => {}
        }
    }
    Ok(None)
}
