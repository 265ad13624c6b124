//! Time that other programs on the machine hardly disturb.

use std::time::{Duration, Instant};

/// Time that this thread has been on a core; on systems that do not report it, the time that has passed.
pub(crate) fn own_time(start: Instant) -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = text.and_then(|text| text.split(' ').next()?.parse().ok());
    nanoseconds.map_or_else(|| start.elapsed(), Duration::from_nanos)
}
