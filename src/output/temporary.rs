//! Temporary files, and other things that go with the process. They are listed, so that a signal can take them away,
//! and locked for as long as their process lives, so that a later run knows what a killed one has left.

use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tempfile::{TempDir, TempPath};

/// What temporary names begin with; the number of the process and random letters follow.
const PREFIX: &str = ".stepwave-";
/// What the names of temporary files end with.
const SUFFIX: &str = ".part";
/// Random letters of a name.
const LETTERS: usize = 8;
/// Nothing is between the making of a file and its locking for that long.
const LONG: Duration = Duration::from_secs(60);

/// What a signal, or a reader that leaves, has to look after.
struct Present {
    /// Files and folders to be removed.
    temporary: Vec<PathBuf>,
    /// Folders in which what killed runs have left was looked for.
    searched: Vec<PathBuf>,
    /// What is kept, in words.
    kept: Option<String>,
    /// Processes that were started, each with a group of its own.
    started: Vec<u32>,
}

static PRESENT: Mutex<Present> =
    Mutex::new(Present { temporary: Vec::new(), searched: Vec::new(), kept: None, started: Vec::new() });

fn present() -> MutexGuard<'static, Present> {
    PRESENT.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does something that a signal waits for, and lists the files that go with the process from then on.
pub(crate) fn undisturbed<T>(work: impl FnOnce(&mut Vec<PathBuf>) -> T) -> T {
    work(&mut present().temporary)
}

/// These files are no longer temporary; a process that is stopped says what is kept, if anything is.
pub(crate) fn keep(paths: &[PathBuf], what: Option<String>) {
    let mut present = present();
    present.temporary.retain(|listed| !paths.contains(listed));
    present.kept = what;
}

/// Starts or ends a process, which a signal waits for. The change is made in the list of processes that run: each ends
/// with ours, with all of its group.
pub(crate) fn attend(change: &mut dyn FnMut(&mut Vec<u32>)) {
    change(&mut present().started);
}

/// What is kept, in words.
pub(crate) fn kept() -> Option<String> {
    present().kept.clone()
}

/// Removes all temporary files, for a process that ends now, which is the last that `end` does. It is given what is
/// kept.
pub(crate) fn abandon(end: impl FnOnce(Option<&str>)) {
    let mut present = present();
    // First, so that none writes into a folder that is being removed.
    #[cfg(unix)]
    for number in present.started.drain(..).filter_map(|number| i32::try_from(number).ok()) {
        if let Some(group) = rustix::process::Pid::from_raw(number) {
            // One that has gone needs no end.
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
    }
    for path in present.temporary.drain(..) {
        // Nothing can be done about one that stays.
        let _ = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
    }
    end(present.kept.as_deref());
}

/// A temporary file, which goes when it is dropped.
pub(super) struct Temporary {
    path: Option<TempPath>,
    /// Holds the lock.
    _open: File,
}

impl Temporary {
    /// Makes a file next to where it will be, for this process alone, with these permissions or those of any new file.
    ///
    /// # Errors
    /// It cannot be made.
    pub(super) fn new(folder: &Path) -> io::Result<(Temporary, File)> {
        search(folder);
        let prefix = format!("{PREFIX}{}-", std::process::id());
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(SUFFIX).rand_bytes(LETTERS);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file: what the user's mask leaves.
            builder.permissions(Permissions::from_mode(0o666));
        }
        let mut present = present();
        let (file, path) = builder.tempfile_in(folder)?.into_parts();
        // Where files cannot be locked, nothing that is left is removed.
        let _ = file.try_lock();
        present.temporary.push(path.to_path_buf());
        drop(present);
        let open = file.try_clone()?;
        Ok((Temporary { path: Some(path), _open: open }, file))
    }

    pub(super) fn path(&self) -> &Path {
        self.path.as_deref().unwrap_or(Path::new(""))
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let mut present = present();
        if let Some(path) = self.path.take() {
            present.temporary.retain(|listed| **listed != *path);
        }
    }
}

/// A file that has its final name.
struct Placed {
    target: PathBuf,
    /// There was one before, and another name that was given to it.
    replaced: Option<Option<TempPath>>,
}

/// Gives every file its final name, all of them or, where a signal comes first or one cannot be renamed, none.
///
/// # Errors
/// A file cannot be renamed.
pub(super) fn persist(staged: &mut Vec<(Temporary, PathBuf)>) -> Result<(), (PathBuf, io::Error)> {
    let mut present = present();
    let mut result = Ok(());
    let (mut renamed, mut placed) = (Vec::new(), Vec::new());
    let several = staged.len() > 1;
    for (mut temporary, target) in staged.drain(..) {
        if let (Ok(()), Some(path)) = (&result, temporary.path.take()) {
            present.temporary.retain(|listed| **listed != *path);
            let replaced = target.exists().then(|| if several { second_name(&target) } else { None });
            match path.persist(&target) {
                Ok(()) => placed.push(Placed { target, replaced }),
                Err(error) => result = Err((target, error.error)),
            }
        }
        renamed.push(temporary);
    }
    if result.is_err() {
        placed.into_iter().rev().for_each(Placed::undo);
    }
    // What is dropped asks for the list.
    drop(present);
    result
}

impl Placed {
    /// Puts back what was there. Nothing can be done where that fails too.
    fn undo(self) {
        match self.replaced {
            Some(Some(before)) => drop(before.persist(&self.target)),
            Some(None) => {}
            None => drop(fs::remove_file(&self.target)),
        }
    }
}

/// Gives an existing file a second name, where its file system can.
fn second_name(target: &Path) -> Option<TempPath> {
    let prefix = format!("{PREFIX}{}-", std::process::id());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX).rand_bytes(LETTERS);
    let link = builder.make_in(super::folder_of(target), |name| fs::hard_link(target, name));
    Some(link.ok()?.into_temp_path())
}

/// A temporary folder, which goes when it is dropped.
pub(crate) struct Folder {
    dir: Option<TempDir>,
    /// Holds the lock.
    _open: Option<File>,
}

impl Folder {
    /// Makes an empty folder where temporary files belong.
    ///
    /// # Errors
    /// It cannot be made.
    pub(crate) fn new() -> io::Result<Folder> {
        search(&std::env::temp_dir());
        let prefix = format!("{PREFIX}{}-", std::process::id());
        let mut present = present();
        let dir = tempfile::Builder::new().prefix(&prefix).suffix(SUFFIX).rand_bytes(LETTERS).tempdir()?;
        let open = File::open(dir.path()).ok();
        // As with files.
        let _ = open.as_ref().map(File::try_lock);
        present.temporary.push(dir.path().to_path_buf());
        Ok(Folder { dir: Some(dir), _open: open })
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        self.dir.as_ref().map_or(Path::new(""), TempDir::path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let mut present = present();
        if let Some(dir) = self.dir.take() {
            present.temporary.retain(|listed| listed != dir.path());
        }
    }
}

/// Removes what killed runs have left in a folder, once.
fn search(folder: &Path) {
    let mut present = present();
    if present.searched.iter().any(|searched| searched == folder) {
        return;
    }
    present.searched.push(folder.to_owned());
    drop(present);
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if let Some(process) = maker(&entry.file_name()) {
            remove_if_left(&entry.path(), process);
        }
    }
}

/// The number of the process that made a temporary file, if it is one by its name.
fn maker(name: &OsStr) -> Option<u32> {
    let (number, letters) = name.to_str()?.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?.split_once('-')?;
    let random = letters.len() == LETTERS && letters.bytes().all(|letter| letter.is_ascii_alphanumeric());
    number.parse().ok().filter(|_| random)
}

/// Removes a temporary file or folder if it is this user's and its process is surely gone. One that is still used is
/// locked, but for the moment after it was made.
#[cfg(unix)]
fn remove_if_left(path: &Path, process: u32) {
    use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
    let no_follow = (rustix::fs::OFlags::NOFOLLOW | rustix::fs::OFlags::NONBLOCK).bits().cast_signed();
    let Ok(file) = File::options().read(true).custom_flags(no_follow).open(path) else { return };
    let Ok(found) = file.metadata() else { return };
    let own = found.uid() == rustix::process::geteuid().as_raw();
    let plain = found.is_dir() || (found.is_file() && found.nlink() == 1);
    if !own || !plain || file.try_lock().is_err() {
        return;
    }
    let number = i32::try_from(process).ok().and_then(rustix::process::Pid::from_raw);
    let gone = number.is_none_or(
        |number| matches!(rustix::process::test_kill_process(number), Err(error) if error == rustix::io::Errno::SRCH),
    );
    let written = found.is_file() && found.len() > 0;
    let old = found.modified().ok().and_then(|at| at.elapsed().ok()).is_some_and(|age| age > LONG);
    // The name may mean another file by now.
    let same = path.symlink_metadata().is_ok_and(|now| (now.dev(), now.ino()) == (found.dev(), found.ino()));
    if same && (gone || written || old) {
        // What stays does no harm.
        let _ = if found.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    }
}

#[cfg(not(unix))]
fn remove_if_left(_: &Path, _: u32) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_one_file_cannot_be_renamed_all_are_as_they_were() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("old"), "before").expect("a file");
        for last in ["blocked", "free"] {
            let mut staged = Vec::new();
            for name in ["old", "new", last] {
                let (temporary, mut file) = Temporary::new(folder.path()).expect("a temporary file");
                io::Write::write_all(&mut file, b"after").expect("a text");
                staged.push((temporary, at(name)));
            }
            // Since the last was staged a folder has come to its place.
            fs::create_dir_all(at("blocked/inside")).expect("a folder");
            let refused = persist(&mut staged).err().map(|(target, _)| target);
            assert_eq!(refused, (last == "blocked").then(|| at("blocked")));
            let text = |name: &str| fs::read_to_string(at(name)).ok();
            let (old, new) = if last == "free" { ("after", Some("after".to_owned())) } else { ("before", None) };
            assert_eq!((text("old").as_deref(), text("new")), (Some(old), new), "{last}");
            let hidden = |entry: &fs::DirEntry| entry.file_name().to_string_lossy().starts_with('.');
            assert_eq!(fs::read_dir(folder.path()).expect("the folder").flatten().filter(hidden).count(), 0);
        }
    }
}
