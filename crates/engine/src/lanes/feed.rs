//! Jobs to workers, results back in the order of the jobs, with bounded memory: a job is handed out only while it is
//! less than a window ahead of the oldest result that is missing.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard};

/// Results that may wait for an older one.
const WINDOW: usize = 1 << 16;

struct Queue<I, R, S> {
    jobs: I,
    /// No further job will come: they are at their end, or a worker has failed.
    ended: bool,
    /// Jobs handed out.
    taken: u64,
    /// Results that have gone to the sink.
    given: u64,
    /// Results from `given` on, where they are there.
    waiting: VecDeque<Option<R>>,
    sink: S,
}

/// Where workers get jobs and leave results.
pub(super) struct Feed<I, R, S> {
    state: Mutex<Queue<I, R, S>>,
    moved: Condvar,
}

impl<J, R, I: Iterator<Item = J>, S: FnMut(R)> Feed<I, R, S> {
    pub(super) fn new(jobs: I, sink: S) -> Feed<I, R, S> {
        let state = Queue { jobs, ended: false, taken: 0, given: 0, waiting: VecDeque::new(), sink };
        Feed { state: Mutex::new(state), moved: Condvar::new() }
    }

    /// The state; none if another worker panicked while it held it.
    fn lock(&self) -> Option<MutexGuard<'_, Queue<I, R, S>>> {
        self.state.lock().ok()
    }

    /// Up to `most` jobs with their numbers; none while the window is full, or for good.
    pub(super) fn take(&self, most: usize, into: &mut VecDeque<(u64, J)>) {
        let Some(mut state) = self.lock() else { return };
        while into.len() < most && !state.ended && state.waiting.len() < WINDOW {
            let Some(job) = state.jobs.next() else {
                state.ended = true;
                self.moved.notify_all();
                break;
            };
            into.push_back((state.taken, job));
            state.taken += 1;
            state.waiting.push_back(None);
        }
    }

    /// Leaves results; those that are next in order go to the sink.
    pub(super) fn give(&self, results: impl Iterator<Item = (u64, R)>) {
        let Some(mut state) = self.lock() else { return };
        for (number, result) in results {
            let place = usize::try_from(number - state.given).unwrap_or(usize::MAX);
            if let Some(waiting) = state.waiting.get_mut(place) {
                *waiting = Some(result);
            }
        }
        let before = state.given;
        while let Some(Some(_)) = state.waiting.front() {
            if let Some(Some(result)) = state.waiting.pop_front() {
                state.given += 1;
                (state.sink)(result);
            }
        }
        if state.given > before {
            self.moved.notify_all();
        }
    }

    /// Waits until there may be a job for a worker that has none left; false if there will be none.
    pub(super) fn wait(&self) -> bool {
        let Some(state) = self.lock() else { return false };
        let full = |state: &mut Queue<I, R, S>| !state.ended && state.waiting.len() >= WINDOW;
        self.moved.wait_while(state, full).is_ok_and(|state| !state.ended)
    }

    /// No further job is handed out: a worker has failed and will never leave its results.
    pub(super) fn abort(&self) {
        if let Some(mut state) = self.lock() {
            state.ended = true;
        }
        self.moved.notify_all();
    }
}
