//! An output that does not fill a disk by accident.

use std::io::{self, Seek, SeekFrom, Write};

/// Bytes above which a wave wants `--large`.
pub(crate) const LARGE: u64 = 1_000_000_000;
pub(crate) const REMEDIES: &str = "make it small by --trace-steps (one sample a step), --no-clk or, of a program, without --every-clock, \
    a window (--trace-from, --trace-to), fewer signals (--trace) or --fst; or give --large";

/// An output that takes no more than 1 GB, unless more is wanted.
pub(crate) struct Limited<W> {
    out: W,
    left: u64,
    remedies: String,
}

impl<W> Limited<W> {
    /// `remedies` says what is to be done where it takes no more.
    pub(crate) fn new(out: W, large: bool, remedies: &str) -> Limited<W> {
        Limited { out, left: if large { u64::MAX } else { LARGE }, remedies: remedies.to_owned() }
    }
}

impl<W: Write> Write for Limited<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if bytes.len() as u64 > self.left {
            let remedies = &self.remedies;
            return Err(io::Error::other(format!("the wave has come to 1 GB and was given up: {remedies}")));
        }
        let written = self.out.write(bytes)?;
        self.left -= written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl<W: Seek> Seek for Limited<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.out.seek(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_ends_at_its_limit_unless_more_is_wanted() {
        let mut limited = Limited { left: 10, ..Limited::new(Vec::new(), false, REMEDIES) };
        limited.write_all(b"0123456").expect("room");
        let refused = limited.write_all(b"789ab").expect_err("no room").to_string();
        assert!(
            refused.starts_with("the wave has come to 1 GB and was given up: ") && refused.contains("--large"),
            "{refused}"
        );
        assert_eq!(limited.out, b"0123456");
        assert_eq!((Limited::new((), false, "").left, Limited::new((), true, "").left), (1_000_000_000, u64::MAX));
    }
}
