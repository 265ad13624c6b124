//! Which file a path means, however it is spelt.

use std::ffi::OsString;
use std::fs::Metadata;
use std::path::{Component, Path, PathBuf};

/// Most links of one path that are followed, as in the system itself.
const MOST_LINKS: usize = 40;

/// A file, by what distinguishes it from all others.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Identity {
    /// One that exists: its device and its number there, which its hard links share.
    Numbered(u64, u64),
    /// One that does not exist yet, or whose system does not number files: its path with all links followed.
    Placed(PathBuf),
}

impl Identity {
    /// The file at a path.
    pub(crate) fn of(path: &Path) -> Identity {
        let target = resolved(path);
        target.metadata().ok().and_then(|found| numbers(&found)).unwrap_or(Identity::Placed(target))
    }

    /// The same file, if names of this folder may differ in the case of their letters.
    pub(super) fn differs_in_case(&self, other: &Identity) -> bool {
        let (Identity::Placed(one), Identity::Placed(other)) = (self, other) else { return false };
        let lower = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        one != other && one.parent() == other.parent() && lower(one) == lower(other)
    }
}

/// What numbers an open or existing file.
#[cfg(unix)]
pub(crate) fn numbers(found: &Metadata) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    Some(Identity::Numbered(found.dev(), found.ino()))
}

#[cfg(not(unix))]
pub(crate) fn numbers(_: &Metadata) -> Option<Identity> {
    None
}

/// The folder that holds a path.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// The file that a path means: links are followed, also to where nothing is yet, so that a link is kept and what it
/// points to is replaced. A file that does not exist yet is named by its folder.
pub(crate) fn resolved(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Ok(found) = path.canonicalize() {
            return found;
        }
        match path.read_link() {
            // One that leads somewhere leads to what has no name, such as the pipe of /dev/stdout.
            Ok(to) if path.metadata().is_err() => path = folder_of(&path).join(to),
            _ => break,
        }
    }
    // `a/..` is not simplified as text: `a` may be a link.
    match (folder_of(&path).canonicalize(), name_of(&path)) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path,
    }
}

fn name_of(path: &Path) -> Option<OsString> {
    match path.components().next_back() {
        Some(Component::Normal(name)) => Some(name.to_owned()),
        _ => None,
    }
}

/// Standard output, a pipe or a device: no other files belong next to it.
pub(crate) fn is_stream(path: &Path) -> bool {
    path == Path::new("-") || path.metadata().is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// A device that takes characters and keeps none to be replaced, such as /dev/null or a terminal: several outputs may
/// go there.
#[cfg(unix)]
pub(super) fn is_shareable(found: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    found.file_type().is_char_device()
}

#[cfg(not(unix))]
pub(super) fn is_shareable(_: &Metadata) -> bool {
    false
}
