//! What a file may ask for. A wave of hardware stays far below; a file that does not was made to fill the memory.

/// The widest vector, in bits.
pub(super) const MAX_WIDTH: u32 = 1 << 20;
/// Scopes within one another.
pub(super) const MAX_DEPTH: usize = 256;
/// Bytes of a path, all scopes and the name.
pub(super) const MAX_PATH: usize = 4096;
/// Bytes of a line: it is read as a whole.
pub(super) const MAX_LINE: u64 = 32 << 20;
/// Bytes that a pipe may give: it has no end that can be seen in advance.
pub(super) const MAX_PIPE: u64 = 1 << 28;
/// Bytes that a compressed file of any size may inflate to, and what its size adds to that, by the byte.
const INFLATED: u64 = 64 << 20;
const INFLATED_BY: u64 = 32;
/// The same for all signals, each with its path.
const SIGNALS: u64 = 32 << 20;
const SIGNALS_BY: u64 = 64;
/// What a signal takes next to its path.
pub(super) const SIGNAL: u64 = 256;

/// Bytes that the content of a compressed file may take in memory.
pub(super) fn inflated(file: u64) -> u64 {
    INFLATED.saturating_add(file.saturating_mul(INFLATED_BY))
}

/// Bytes that all signals and their paths may take together.
pub(super) fn signals(file: u64) -> u64 {
    SIGNALS.saturating_add(file.saturating_mul(SIGNALS_BY))
}

/// A number of bytes for a message.
pub(super) fn mebibytes(bytes: u64) -> String {
    format!("{} MiB", bytes.div_ceil(1 << 20))
}
