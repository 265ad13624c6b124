//! Files that appear whole or not at all: written under another name beside the final one and renamed at the end.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use crate::failure::Failure;

/// An open output.
pub(crate) type Sink = BufWriter<Box<dyn Write + Send>>;

/// An open file in which one can go back.
pub(crate) type SeekSink = BufWriter<Named>;

/// Outputs of one command.
#[derive(Default)]
pub(crate) struct Outputs {
    staged: Vec<(TempPath, PathBuf)>,
    named: Vec<PathBuf>,
    stdout: bool,
}

fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    Failure::Trouble(format!("cannot write {}: {error}", path.display()))
}

/// The file that a path means: links are followed, so that a link is kept and what it points to is replaced. A file that
/// does not exist yet is named by its folder.
fn resolved(path: &Path) -> PathBuf {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    path.canonicalize().unwrap_or_else(|_| match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    })
}

/// Standard output, a pipe or a device: no other files belong beside it.
pub(crate) fn is_stream(path: &Path) -> bool {
    path == Path::new("-") || path.metadata().is_ok_and(|found| !found.is_file() && !found.is_dir())
}

impl Outputs {
    /// Opens an output; `-` is standard output.
    ///
    /// # Errors
    /// The file cannot be created, or another output goes there already.
    pub(crate) fn open(&mut self, path: &Path) -> Result<Sink, Failure> {
        if path == Path::new("-") {
            if std::mem::replace(&mut self.stdout, true) {
                return Err(Failure::Trouble("two outputs cannot both go to standard output: name a file".to_owned()));
            }
            return Ok(BufWriter::new(Box::new(QuietPipe(io::stdout()))));
        }
        Ok(BufWriter::with_capacity(1 << 16, Box::new(self.file(path)?)))
    }

    /// Opens an output that is not written from the beginning to the end.
    ///
    /// # Errors
    /// The file cannot be created, it is no file, or another output goes there already.
    pub(crate) fn open_seekable(&mut self, path: &Path) -> Result<SeekSink, Failure> {
        if is_stream(path) {
            return Err(Failure::Trouble(format!(
                "cannot write {}: FST is written back and forth, which needs a file: name one, or take --vcd",
                path.display()
            )));
        }
        Ok(BufWriter::with_capacity(1 << 16, self.file(path)?))
    }

    /// Tries whether an output can be written, which is opened later, and keeps its name for it: gives the file that the
    /// path means. Nothing is written yet.
    ///
    /// # Errors
    /// The file cannot be created, or another output goes there already.
    pub(crate) fn claim(&mut self, path: &Path) -> Result<PathBuf, Failure> {
        if path != Path::new("-") {
            self.file(path)?;
            // The temporary file goes with its name.
            self.staged.clear();
        }
        Ok(resolved(path))
    }

    fn file(&mut self, path: &Path) -> Result<Named, Failure> {
        if path.as_os_str().as_encoded_bytes().ends_with(b"/") && !path.is_dir() {
            return Err(Failure::Trouble(format!("cannot write {}: there is no such folder", path.display())));
        }
        let target = resolved(path);
        if self.named.contains(&target) {
            let message = format!("two outputs would go to {}: give each its own file", path.display());
            return Err(Failure::Trouble(message));
        }
        self.named.push(target.clone());
        match target.metadata() {
            Ok(found) if found.is_dir() => {
                Err(Failure::Trouble(format!("cannot write {}: it is a folder", path.display())))
            }
            // A pipe or a device such as /dev/null is written as it is; renaming would replace it.
            Ok(found) if !found.is_file() => {
                let file = File::options().write(true).open(&target).map_err(|error| cannot_write(path, &error))?;
                Ok(Named { path: path.to_owned(), file })
            }
            // Such as a name that is too long: better said now than when other files have their final names already.
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(cannot_write(path, &error)),
            _ => {
                let file = self.stage(path, &target)?;
                Ok(Named { path: path.to_owned(), file })
            }
        }
    }

    fn stage(&mut self, path: &Path, target: &Path) -> Result<File, Failure> {
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".stepwave-").suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file: what the user's mask leaves.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let staged = builder.tempfile_in(folder).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => {
                let folder = folder.display();
                Failure::Trouble(format!("cannot write {}: the folder {folder} does not exist", path.display()))
            }
            // The temporary file's own name would only confuse.
            kind => cannot_write(path, &io::Error::from(kind)),
        })?;
        let (file, temporary) = staged.into_parts();
        self.staged.push((temporary, target.to_owned()));
        Ok(file)
    }

    /// Writes a whole file.
    ///
    /// # Errors
    /// It cannot be written.
    pub(crate) fn write(&mut self, path: &Path, content: &str) -> Result<(), Failure> {
        let mut sink = self.open(path)?;
        sink.write_all(content.as_bytes())?;
        Ok(sink.flush()?)
    }

    /// Standard output belongs to one of the outputs.
    pub(crate) fn uses_stdout(&self) -> bool {
        self.stdout
    }

    /// Gives every file its final name. All sinks must be flushed.
    ///
    /// # Errors
    /// A file cannot be renamed.
    pub(crate) fn commit(mut self) -> Result<(), Failure> {
        self.commit_all()
    }

    /// As [`commit`](Self::commit), and goes on to tell what [`uses_stdout`](Self::uses_stdout).
    ///
    /// # Errors
    /// A file cannot be renamed.
    pub(crate) fn commit_all(&mut self) -> Result<(), Failure> {
        for (temporary, target) in self.staged.drain(..) {
            temporary.persist(&target).map_err(|error| cannot_write(&target, &error.error))?;
        }
        Ok(())
    }
}

/// A file whose errors bear its name.
pub(crate) struct Named {
    path: PathBuf,
    file: File,
}

impl Named {
    fn named<T>(&self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|error| io::Error::new(error.kind(), format!("cannot write {}: {error}", self.path.display())))
    }
}

impl Write for Named {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        let result = self.file.write(buffer);
        self.named(result)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.file.flush();
        self.named(result)
    }
}

impl Seek for Named {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let result = self.file.seek(to);
        self.named(result)
    }
}

/// Standard output whose reader may leave early, as `head` does: that is no failure.
struct QuietPipe(io::Stdout);

fn unless_closed<T>(result: io::Result<T>, closed: T) -> io::Result<T> {
    result.or_else(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => Ok(closed),
        kind => Err(io::Error::new(kind, format!("cannot write standard output: {error}"))),
    })
}

impl Write for QuietPipe {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        unless_closed(self.0.write(buffer), buffer.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        unless_closed(self.0.flush(), ())
    }
}

/// Prints text for people on standard output: what files and users call things may hold control characters, which are
/// [shown](shown).
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    print_data(&shown(text))
}

/// Prints data of our own making, byte by byte, on standard output.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn print_data(text: &str) -> Result<(), Failure> {
    let mut out = QuietPipe(io::stdout());
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
