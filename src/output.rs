//! Files that appear whole or not at all: written under another name beside the final one and renamed at the end.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use crate::failure::Failure;

/// An open output.
pub(crate) type Sink = BufWriter<Box<dyn Write>>;

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
        // A link is kept, and what it points to is replaced.
        let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
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
                Ok(BufWriter::new(Box::new(Named { path: path.to_owned(), file })))
            }
            _ => {
                let file = self.stage(path, &target)?;
                Ok(BufWriter::with_capacity(1 << 16, Box::new(Named { path: path.to_owned(), file })))
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
    pub(crate) fn commit(self) -> Result<(), Failure> {
        for (temporary, target) in self.staged {
            temporary.persist(&target).map_err(|error| cannot_write(&target, &error.error))?;
        }
        Ok(())
    }
}

/// A file whose errors bear its name.
struct Named {
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

/// Standard output whose reader may leave early, as `head` does: that is no failure.
struct QuietPipe(io::Stdout);

impl Write for QuietPipe {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        match self.0.write(buffer) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(buffer.len()),
            result => result,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self.0.flush() {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            result => result,
        }
    }
}

/// Prints text on standard output.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = QuietPipe(io::stdout());
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|error| cannot_write(Path::new("-"), &error))
}
