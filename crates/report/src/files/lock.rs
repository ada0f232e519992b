//! The lock of an output directory. It is held by the open directory itself, or by a file in it
//! where directories cannot be locked; the operating system releases it when the process ends.

use std::fs::{File, TryLockError};
use std::path::Path;

use super::FileError;

/// The file that is locked where directories cannot be.
const LOCK: &str = "pfaff.lock";

/// The lock of a directory; `None` if the file system knows no locks.
///
/// # Errors
/// [`FileError::Busy`]: another process holds it.
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
