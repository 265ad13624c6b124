//! True time in a wave: from a clock frequency to a timescale and ticks.

use std::fmt;

/// Units of a VCD timescale, in seconds as a power of ten.
const UNITS: [(i8, &str, ::vcd::TimescaleUnit); 6] = [
    (0, "s", ::vcd::TimescaleUnit::S),
    (-3, "ms", ::vcd::TimescaleUnit::MS),
    (-6, "us", ::vcd::TimescaleUnit::US),
    (-9, "ns", ::vcd::TimescaleUnit::NS),
    (-12, "ps", ::vcd::TimescaleUnit::PS),
    (-15, "fs", ::vcd::TimescaleUnit::FS),
];

/// A clock in the time of a wave file: one tick is `magnitude` units, one period an even number of ticks.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ClockTime {
    hz: f64,
    magnitude: u32,
    unit: usize,
    ticks: u64,
}

/// A clock frequency that no wave can carry.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("a clock of {0} Hz is not possible: give a frequency from 1e-3 to 1e14 Hz")]
pub struct ClockError(pub f64);

impl ClockTime {
    /// The coarsest timescale in which half a period of `hz` is a whole number of ticks; where there is none, the
    /// coarsest that is true to 1 in 10^9, or else femtoseconds.
    ///
    /// # Errors
    /// `hz` is not a number from 1e-3 to 1e14.
    pub fn from_hz(hz: f64) -> Result<ClockTime, ClockError> {
        if !(1e-3..=1e14).contains(&hz) {
            return Err(ClockError(hz));
        }
        let scales = (0..UNITS.len()).flat_map(|unit| [100, 10, 1].map(|magnitude| (unit, magnitude)));
        let mut rounded = None;
        for (unit, magnitude) in scales {
            // The exponent is at most 15 and the magnitude a power of ten: exact in f64 for every usual frequency.
            let per_second = 10f64.powi(-i32::from(UNITS[unit].0)) / f64::from(magnitude);
            let half = per_second / hz / 2.0;
            let whole = half.round();
            if whole < 1.0 {
                continue;
            }
            // Below 2^62, since hz >= 1e-3 and a second has 1e15 fs.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let time = ClockTime { hz, magnitude, unit, ticks: 2 * whole as u64 };
            #[allow(clippy::float_cmp)]
            let exact = whole * 2.0 * hz == per_second;
            if exact {
                return Ok(time);
            }
            let finest = unit == UNITS.len() - 1 && magnitude == 1;
            if finest || (half - whole).abs() <= 1e-9 * half {
                rounded.get_or_insert(time);
            }
        }
        rounded.ok_or(ClockError(hz))
    }

    /// The frequency in Hz.
    #[must_use]
    pub fn hz(self) -> f64 {
        self.hz
    }

    /// Ticks of one period; even.
    #[must_use]
    pub fn ticks(self) -> u64 {
        self.ticks
    }

    /// Units of one tick: 1, 10 or 100.
    pub(super) fn magnitude(self) -> u32 {
        self.magnitude
    }

    /// One tick is ten to this power, in seconds.
    pub(super) fn exponent(self) -> i8 {
        let unit = UNITS[self.unit].0;
        unit + if self.magnitude == 100 { 2 } else { i8::from(self.magnitude == 10) }
    }

    pub(super) fn unit(self) -> ::vcd::TimescaleUnit {
        UNITS[self.unit].2
    }
}

/// The timescale: `100 ns`.
impl fmt::Display for ClockTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.magnitude, UNITS[self.unit].1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_timescale_is_the_coarsest_in_which_half_a_period_is_whole() {
        for (hz, scale, ticks) in [
            (1e6, "100 ns", 10),
            (50e6, "10 ns", 2),
            (1.0, "100 ms", 10),
            (8e6, "100 ps", 1250 / 10 * 10),
            (2.5e6, "100 ns", 4),
            (1e14, "1 fs", 10),
            (250.0, "1 ms", 4),
        ] {
            let time = ClockTime::from_hz(hz).unwrap();
            assert_eq!((time.to_string().as_str(), time.ticks()), (scale, ticks), "{hz} Hz");
        }
    }

    #[test]
    fn a_period_that_is_no_whole_number_of_ticks_is_rounded_as_finely_as_the_format_allows() {
        let time = ClockTime::from_hz(33_333_333.0).unwrap();
        assert_eq!((time.to_string().as_str(), time.ticks()), ("1 fs", 30_000_000));
        let slow = ClockTime::from_hz(0.7).unwrap();
        let period = 1.0 / 0.7;
        let unit = match slow.to_string().as_str() {
            "1 ns" => 1e-9,
            "100 ps" => 1e-10,
            other => panic!("{other}"),
        };
        #[allow(clippy::cast_precision_loss)]
        let written = slow.ticks() as f64 * unit;
        assert!((written - period).abs() < 2e-9 * period);
    }

    #[test]
    fn frequencies_that_make_no_wave_are_refused() {
        for hz in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e15] {
            assert!(ClockTime::from_hz(hz).is_err(), "{hz}");
        }
    }
}
