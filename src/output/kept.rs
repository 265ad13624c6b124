//! Outputs that stay in memory, for a command that shows what another would write.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Files in memory, by their names.
#[derive(Clone, Default)]
pub(crate) struct Kept(Arc<Mutex<BTreeMap<PathBuf, Vec<u8>>>>);

impl Kept {
    /// An empty file of this name, in the place of one that is there.
    pub(super) fn file(&self, path: &Path) -> KeptFile {
        self.with(|files| files.insert(path.to_owned(), Vec::new()));
        KeptFile { kept: self.clone(), path: path.to_owned() }
    }

    /// The bytes of a file, which is then gone.
    pub(crate) fn take(&self, path: &Path) -> Option<Vec<u8>> {
        self.with(|files| files.remove(path))
    }

    fn with<T>(&self, change: impl FnOnce(&mut BTreeMap<PathBuf, Vec<u8>>) -> T) -> T {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// One of them, open.
pub(super) struct KeptFile {
    kept: Kept,
    path: PathBuf,
}

impl Write for KeptFile {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.kept.with(|files| files.entry(self.path.clone()).or_default().extend_from_slice(buffer));
        Ok(buffer.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
