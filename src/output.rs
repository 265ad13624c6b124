//! Files that appear whole or not at all: written under another name next to the final one and renamed at the end. No
//! output replaces what the command reads.

pub(crate) mod identity;
mod kept;
mod room;
pub(crate) mod temporary;

use std::borrow::Cow;
use std::fs::{File, Metadata};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use self::identity::{Identity, folder_of, is_shareable, numbers, resolved};
use self::room::Room;
use self::temporary::Temporary;
use crate::Error;
use crate::stop;

pub(crate) use self::identity::is_stream;
pub(crate) use self::kept::Kept;

/// An open output.
pub(crate) type Sink = BufWriter<Box<dyn Write + Send>>;

/// An open file in which one can go back.
pub(crate) type SeekableSink = BufWriter<Named>;

/// Outputs of one command.
#[derive(Default)]
pub(crate) struct Outputs {
    /// Files that the command reads.
    inputs: Vec<(Identity, PathBuf)>,
    staged: Vec<(Temporary, PathBuf)>,
    named: Vec<(Identity, PathBuf)>,
    stdout: bool,
    /// In place of files.
    kept: Option<Kept>,
}

fn cannot_write(path: &Path, error: &io::Error) -> Error {
    Error::Invalid(format!("cannot write {}: {error}", path.display()))
}

/// A folder for outputs that are found there by their viewer; one that is there stays as it is.
///
/// # Errors
/// It cannot be made.
pub(crate) fn make_folder(path: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(path).map_err(|error| cannot_write(path, &error))
}

impl Outputs {
    /// Of a command that reads these files.
    pub(crate) fn reading(inputs: impl IntoIterator<Item = impl AsRef<Path>>) -> Outputs {
        let input = |path: &Path| (Identity::of(path), path.to_owned());
        let inputs = inputs.into_iter().map(|path| input(path.as_ref())).collect();
        Outputs { inputs, ..Outputs::default() }
    }

    /// Outputs that stay in memory, and what they are then taken from.
    pub(crate) fn in_memory() -> (Kept, Outputs) {
        let kept = Kept::default();
        (kept.clone(), Outputs { kept: Some(kept), ..Outputs::default() })
    }

    /// Of a run that begins again: nothing is open.
    pub(crate) fn begun_again(&mut self) {
        *self = Outputs { inputs: std::mem::take(&mut self.inputs), kept: self.kept.take(), ..Outputs::default() };
    }

    /// Opens an output; `-` is standard output.
    ///
    /// # Errors
    /// The file cannot be created, the command reads it, or another output goes there already.
    pub(crate) fn open(&mut self, path: &Path) -> Result<Sink, Error> {
        if let Some(kept) = &self.kept {
            return Ok(BufWriter::with_capacity(1 << 16, Box::new(kept.file(path))));
        }
        if path == Path::new("-") {
            if std::mem::replace(&mut self.stdout, true) {
                return Err(Error::Invalid("two outputs cannot both go to standard output: name a file".to_owned()));
            }
            if let Some(found) = metadata_of_stdout().filter(|found| !is_shareable(found))
                && let Some(identity) = numbers(&found)
            {
                self.reserve(identity, path)?;
            }
            return Ok(BufWriter::new(Box::new(Stdout(io::stdout()))));
        }
        Ok(BufWriter::with_capacity(1 << 16, Box::new(self.file(path)?)))
    }

    /// Opens an output that is not written from the beginning to the end.
    ///
    /// # Errors
    /// The file cannot be created, it is not a file, the command reads it, or another output goes there already.
    pub(crate) fn open_seekable(&mut self, path: &Path) -> Result<SeekableSink, Error> {
        if is_stream(path) {
            return Err(Error::Invalid(format!(
                "cannot write {}: FST is written back and forth, which needs a file: name one, or take --vcd",
                path.display()
            )));
        }
        Ok(BufWriter::with_capacity(1 << 16, self.file(path)?))
    }

    /// Tries whether an output can be written, which is opened later, and keeps its name for it: gives the file that
    /// the path means. Nothing is written yet.
    ///
    /// # Errors
    /// The file cannot be created, or another output goes there already.
    pub(crate) fn claim(&mut self, path: &Path) -> Result<PathBuf, Error> {
        if path == Path::new("-") {
            self.open(path)?;
        } else if is_stream(path) {
            // Opened once only: the reader of a pipe takes its closing for the end.
            if !path.metadata().as_ref().is_ok_and(is_shareable) {
                self.keep_free(path)?;
            }
        } else {
            self.file(path)?;
            // The temporary file goes with its name.
            self.staged.clear();
        }
        Ok(resolved(path))
    }

    /// Keeps the name of a file that something else writes.
    ///
    /// # Errors
    /// The command reads it, or an output goes there already.
    pub(crate) fn keep_free(&mut self, path: &Path) -> Result<(), Error> {
        self.reserve(Identity::of(path), path)
    }

    /// Takes a file for an output.
    fn reserve(&mut self, identity: Identity, path: &Path) -> Result<(), Error> {
        let name = |path: &Path| match path == Path::new("-") {
            true => "standard output".to_owned(),
            false => path.display().to_string(),
        };
        if let Some((_, input)) = self.inputs.iter().find(|(input, _)| *input == identity) {
            return Err(Error::Invalid(format!(
                "cannot write {}: it is the file {}, which this command reads and would destroy: name another file for the \
                 output",
                name(path),
                input.display()
            )));
        }
        let same = |other: &Identity| *other == identity || (identity.differs_in_case(other) && folds_case(path));
        if let Some((_, other)) = self.named.iter().find(|(other, _)| same(other)) {
            let also = if other == path { String::new() } else { format!(", also named {}", name(other)) };
            return Err(Error::Invalid(format!(
                "two outputs would go to {}{also}: give each its own file",
                name(path)
            )));
        }
        self.named.push((identity, path.to_owned()));
        Ok(())
    }

    fn file(&mut self, path: &Path) -> Result<Named, Error> {
        if path.as_os_str().as_encoded_bytes().ends_with(b"/") && !path.is_dir() {
            return Err(Error::Invalid(format!("cannot write {}: there is no such folder", path.display())));
        }
        let target = resolved(path);
        let found = target.metadata();
        if !found.as_ref().is_ok_and(is_shareable) {
            self.reserve(Identity::of(&target), path)?;
        }
        match found {
            Ok(found) if found.is_dir() => {
                Err(Error::Invalid(format!("cannot write {}: it is a folder", path.display())))
            }
            // A pipe or a device such as /dev/null is written as it is; renaming would replace it.
            Ok(found) if !found.is_file() => {
                let file = File::options().write(true).open(&target).map_err(|error| cannot_write(path, &error))?;
                Ok(Named::new(path, file))
            }
            // Such as a name that is too long: better said now than when other files have their final names already.
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(cannot_write(path, &error)),
            found => {
                let file = self.stage(path, &target)?;
                if let Ok(found) = found {
                    keep_owner_and_mode(&file, &found);
                }
                Ok(Named::new(path, file))
            }
        }
    }

    fn stage(&mut self, path: &Path, target: &Path) -> Result<File, Error> {
        let folder = folder_of(target);
        let (temporary, file) = Temporary::new(folder).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => {
                let folder = folder.display();
                Error::Invalid(format!("cannot write {}: the folder {folder} does not exist", path.display()))
            }
            // The temporary file's own name would only confuse.
            kind => cannot_write(path, &io::Error::from(kind)),
        })?;
        self.staged.push((temporary, target.to_owned()));
        Ok(file)
    }

    /// Writes a whole file.
    ///
    /// # Errors
    /// It cannot be written.
    pub(crate) fn write(&mut self, path: &Path, content: &str) -> Result<(), Error> {
        let mut sink = self.open(path)?;
        sink.write_all(content.as_bytes())?;
        Ok(sink.flush()?)
    }

    /// No output was opened.
    pub(crate) fn are_unopened(&self) -> bool {
        self.named.is_empty() && self.staged.is_empty() && !self.stdout
    }

    /// Standard output belongs to one of the outputs.
    pub(crate) fn uses_stdout(&self) -> bool {
        self.stdout
    }

    /// Gives every file its final name. All sinks must be flushed.
    ///
    /// # Errors
    /// A file cannot be renamed.
    pub(crate) fn commit(mut self) -> Result<(), Error> {
        self.commit_all()
    }

    /// As [`commit`](Self::commit), and keeps what [`uses_stdout`](Self::uses_stdout) says.
    ///
    /// # Errors
    /// A file cannot be renamed.
    pub(crate) fn commit_all(&mut self) -> Result<(), Error> {
        temporary::persist(&mut self.staged).map_err(|(target, error)| cannot_write(&target, &error))
    }
}

/// Of what standard output is, where the system says so.
#[cfg(unix)]
fn metadata_of_stdout() -> Option<Metadata> {
    use std::os::fd::AsFd;
    File::from(io::stdout().as_fd().try_clone_to_owned().ok()?).metadata().ok()
}

#[cfg(not(unix))]
fn metadata_of_stdout() -> Option<Metadata> {
    None
}

/// A file that replaces another is as that was, as far as this user may.
#[cfg(unix)]
fn keep_owner_and_mode(file: &File, replaced: &Metadata) {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let (user, group) = (Some(replaced.uid()), Some(replaced.gid()));
    if let Ok(own) = file.metadata()
        && (own.uid(), own.gid()) != (replaced.uid(), replaced.gid())
        && fchown(file, user, group).is_err()
    {
        // The group may be another of the user's own.
        let _ = fchown(file, None, group);
    }
    // Some file systems have no modes.
    let _ = file.set_permissions(std::fs::Permissions::from_mode(replaced.mode() & 0o777));
}

#[cfg(not(unix))]
fn keep_owner_and_mode(_: &File, _: &Metadata) {}

/// Names in the folder of this file that differ in the case of their letters only mean one file.
fn folds_case(path: &Path) -> bool {
    let Ok((temporary, _)) = Temporary::new(folder_of(&resolved(path))) else { return false };
    let name = temporary.path().file_name().unwrap_or_default().to_string_lossy().to_uppercase();
    temporary.path().with_file_name(name).exists()
}

/// A file whose errors name it.
pub(crate) struct Named {
    path: PathBuf,
    file: File,
    room: Room,
}

impl Named {
    fn new(path: &Path, file: File) -> Named {
        Named { path: path.to_owned(), file, room: Room::default() }
    }

    fn named<T>(&self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|error| match error.kind() {
            io::ErrorKind::BrokenPipe => stop::reader_left(),
            kind => io::Error::new(kind, format!("cannot write {}: {error}", self.path.display())),
        })
    }
}

impl Write for Named {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.room.ask(&self.file, buffer.len());
        let result = self.file.write(buffer);
        self.room.take(*result.as_ref().unwrap_or(&0));
        self.named(result)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.room.give_back(&self.file).and_then(|()| self.file.flush());
        self.named(result)
    }
}

impl Seek for Named {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let result = self.room.give_up(&self.file).and_then(|()| self.file.seek(to));
        self.named(result)
    }
}

/// Standard output. A reader that leaves, as `head` does, ends the process.
struct Stdout(io::Stdout);

fn unless_left<T>(result: io::Result<T>) -> io::Result<T> {
    result.map_err(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => stop::reader_left(),
        kind => io::Error::new(kind, format!("cannot write standard output: {error}")),
    })
}

impl Write for Stdout {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        unless_left(self.0.write(buffer))
    }

    fn flush(&mut self) -> io::Result<()> {
        unless_left(self.0.flush())
    }
}

/// Text for people that comes bit by bit, on standard output, or on standard error where the other has a file; control
/// characters are [shown](shown). A write is whole characters.
pub(crate) struct Screen(BufWriter<Box<dyn Write>>);

impl Screen {
    pub(crate) fn new(on_error: bool) -> Screen {
        let to: Box<dyn Write> = if on_error { Box::new(io::stderr()) } else { Box::new(Stdout(io::stdout())) };
        Screen(BufWriter::new(to))
    }
}

impl Write for Screen {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.0.write_all(shown(&String::from_utf8_lossy(buffer)).as_bytes())?;
        Ok(buffer.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// Prints text for people on standard output: what files and users call things may hold control characters, which are
/// [shown](shown).
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn print(text: &str) -> Result<(), Error> {
    print_data(&shown(text))
}

/// Prints data of our own making, byte by byte, on standard output.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn print_data(text: &str) -> Result<(), Error> {
    let mut out = Stdout(io::stdout());
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}

/// The text with every character as an escape that would steer a terminal: control characters but line breaks, and
/// marks that turn the direction of writing.
pub(crate) fn shown(text: &str) -> Cow<'_, str> {
    let steers = |c: char| match c {
        '\n' => false,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        other => other.is_control(),
    };
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match u32::from(c) {
            _ if !steers(c) => safe.push(c),
            code @ ..0x100 => safe.push_str(&format!("\\x{code:02x}")),
            code => safe.push_str(&format!("\\u{{{code:x}}}")),
        }
    }
    Cow::Owned(safe)
}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn what_steers_a_terminal_is_shown_as_escapes() {
        let steers = "a\x1b[31m\x07\x7f\u{9b}2J\r\t\0\u{202e}\u{2066}\u{200f}z";
        assert_eq!(shown(steers), r"a\x1b[31m\x07\x7f\x9b2J\x0d\x09\x00\u{202e}\u{2066}\u{200f}z");
        assert_eq!(shown("two\nlines, µ and \u{5d0}"), "two\nlines, µ and \u{5d0}");
    }
}
