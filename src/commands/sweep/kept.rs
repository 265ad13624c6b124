//! The rows of a sweep that outlive it: what is kept where it is stopped, and what is said of it.

use std::path::{Path, PathBuf};

use crate::study::{Row, Stage, StudyError, Sweep};

use crate::Error;
use crate::output::temporary;

/// A stage; while nothing is done it goes with the process, after that it is kept.
pub(super) struct Kept {
    /// Until it is finished.
    stage: Option<Stage>,
    files: [PathBuf; 2],
    /// Geometries of the sweep.
    all: u64,
}

impl Kept {
    /// Begins, or goes on.
    ///
    /// # Errors
    /// See [`Stage::open`].
    pub(super) fn open(target: &Path, sweep: &Sweep, resume: bool) -> Result<Kept, Error> {
        let files = Stage::files(target);
        let stage = temporary::undisturbed(|temporary| {
            let stage = Stage::open(target, sweep, resume)?;
            temporary.extend_from_slice(&files);
            Ok::<Stage, StudyError>(stage)
        })?;
        let kept = Kept { stage: Some(stage), files, all: sweep.geometries() };
        kept.note();
        Ok(kept)
    }

    /// Geometries done already.
    pub(super) fn done(&self) -> u64 {
        self.stage.as_ref().map_or(0, |stage| stage.done()[0])
    }

    /// Says what is kept where the sweep is stopped now.
    fn note(&self) {
        let (done, all) = (self.done(), self.all);
        if done > 0 {
            let what = format!("{done} of {all} geometries are done and kept: the same command with --resume goes on");
            temporary::keep(&self.files, Some(what));
        }
    }

    /// See [`Stage::append`].
    pub(super) fn append(&mut self, geometries: u64, rows: u64, lines: &[String]) -> Result<(), StudyError> {
        let result = self.stage.as_mut().map_or(Ok(()), |stage| stage.append(geometries, rows, lines));
        self.note();
        result
    }

    /// See [`Stage::replay`].
    pub(super) fn replay<E: From<StudyError>>(&mut self, each: impl FnMut(Row) -> Result<(), E>) -> Result<(), E> {
        self.stage.as_mut().map_or(Ok(()), |stage| stage.replay(each))
    }

    /// Removes everything.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub(super) fn discard(self) -> Result<(), StudyError> {
        self.finish(false)
    }

    /// See [`Stage::finish`].
    pub(super) fn finish(mut self, as_csv: bool) -> Result<(), StudyError> {
        let stage = self.stage.take();
        temporary::undisturbed(|_| stage.map(|stage| stage.finish(as_csv)).transpose())?;
        temporary::keep(&self.files, None);
        Ok(())
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        if let Some(stage) = self.stage.take_if(|stage| stage.done()[0] == 0) {
            // What stays does no harm.
            let _ = temporary::undisturbed(|_| stage.discard());
            temporary::keep(&self.files, None);
        }
    }
}
