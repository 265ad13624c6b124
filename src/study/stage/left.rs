//! Files with fixed names that an earlier run may have left: opened only where they are this user's own, no link leads
//! to them, and they are plain files.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::Path;

/// That a name is taken, and by what.
pub(super) fn occupied(path: &Path, what: &str) -> io::Error {
    let name = path.display();
    io::Error::other(format!("{name}, which a sweep needs, is in the way: {what}: delete it, or name another file"))
}

/// Opens what is left, to read and write; nothing where nothing is.
///
/// # Errors
/// It is a link, is not a plain file, has a second name, or is another user's; or it cannot be opened.
pub(super) fn open(path: &Path) -> io::Result<Option<File>> {
    match path.symlink_metadata() {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
        Ok(found) if found.is_symlink() => return Err(occupied(path, "it is a link")),
        Ok(found) if !found.is_file() => return Err(occupied(path, "it is no plain file")),
        Ok(_) => {}
    }
    let mut options = File::options();
    options.read(true).write(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        // It may have become a link or a pipe since.
        options.custom_flags((rustix::fs::OFlags::NOFOLLOW | rustix::fs::OFlags::NONBLOCK).bits().cast_signed());
    }
    let file = match options.open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        result => result?,
    };
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let found = file.metadata()?;
        if !found.is_file() {
            return Err(occupied(path, "it is no plain file"));
        }
        if found.nlink() > 1 {
            return Err(occupied(path, "it has a second name"));
        }
        if found.uid() != rustix::process::geteuid().as_raw() {
            return Err(occupied(path, "it is another user's"));
        }
    }
    Ok(Some(file))
}

/// Makes a new file, which no link leads to, in the place of what is left.
///
/// # Errors
/// It cannot be made.
pub(super) fn anew(path: &Path) -> io::Result<File> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    File::options().read(true).write(true).create_new(true).open(path)
}

/// A path still leads to an open file.
#[cfg(unix)]
pub(super) fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let open = file.metadata()?;
    Ok(path.symlink_metadata().is_ok_and(|found| (found.dev(), found.ino()) == (open.dev(), open.ino())))
}

#[cfg(not(unix))]
pub(super) fn is_at(_: &File, _: &Path) -> io::Result<bool> {
    Ok(true)
}
