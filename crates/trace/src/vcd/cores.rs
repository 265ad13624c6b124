//! Which core a thread runs on. A guest's idle core counts as taken by another guest, so that Linux, asked to wake a thread
//! there, leaves it on the core of the one that wakes it: of two threads that wait for each other in turn one then always
//! waits, and the other core rests.

#[cfg(target_os = "linux")]
mod linux {
    use rustix::thread::{sched_getaffinity, sched_getcpu, sched_setaffinity};

    /// The core of the thread that calls this.
    pub(crate) fn current() -> usize {
        sched_getcpu()
    }

    /// Lets the thread that calls this run on any core that it may use but this one. What the system refuses is left as it is:
    /// only time depends on it.
    pub(crate) fn avoid(core: usize) {
        let Ok(mut cores) = sched_getaffinity(None) else { return };
        cores.unset(core);
        if cores.count() > 0 {
            let _ = sched_setaffinity(None, &cores);
        }
    }

    #[cfg(test)]
    mod tests {
        use std::thread;

        use super::{avoid, current};

        #[test]
        fn a_thread_leaves_the_core_to_another_where_there_are_two() {
            let cores = thread::available_parallelism().unwrap().get();
            let here = current();
            let there = thread::spawn(move || {
                avoid(here);
                current()
            });
            assert!(there.join().unwrap() != here || cores == 1);
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod other {
    pub(crate) fn current() -> usize {
        0
    }

    pub(crate) fn avoid(_core: usize) {}
}

#[cfg(target_os = "linux")]
pub(super) use linux::{avoid, current};
#[cfg(not(target_os = "linux"))]
pub(super) use other::{avoid, current};
