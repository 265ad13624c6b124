//! Digital pulse multiplier (rate multiplier): a counter shared by all axes; the stage that goes
//! from 0 to 1 offers a pulse, which a bit of each axis' coefficient lets through or not.

use super::{AXES, Table, per_axis_columns};

/// The step table of a straight line in 2 to 6 axes, in BLU, with an `n`-bit binary counter.
///
/// Stage k of the counter (0 is the lowest) gives a pulse on the clock at which it goes from 0 to 1.
/// Bit n-1-k of the coefficient |d| lets it through. The last clock, from all ones to 0, gives none;
/// it ends the block after 2^n clocks.
///
/// The columns are `q` (the counter after the clock), then `dx`, `dy`, …, then `x`, `y`, ….
///
/// Source: the method of the digital pulse multiplier, straight line.
///
/// # Panics
/// When the slices differ in length, or a |d| does not fit `n` bits, or `n` > 30.
pub(crate) fn dpm_line(n: u32, from: &[i64], to: &[i64]) -> Table {
    let unit = Binary::new(n);
    let mut line = Line::load(from, to, 1 << n);
    let mut table = Table::new(line.columns(&["q"]));
    let mut q = 0;
    table.push(&[&[q], &line.pulse, &line.position]);
    for _ in 0..1_i64 << n {
        line.step(|word| unit.gives(word, q));
        q = unit.next(q);
        table.push(&[&[q], &line.pulse, &line.position]);
    }
    table.finished = true;
    table
}

/// The step table of a straight line in 2 to 6 axes, in BLU, with `units` cascaded binary units of `bits` bits each.
///
/// Every unit has a counter of its own and a word of `bits` bits of each |d|: the first, which counts every clock, the
/// highest ones. A further unit takes part in the clocks that find all units before it at all ones, where these give no
/// pulse. The carry of the last unit ends the block after 2^(`units`·`bits`) clocks.
///
/// The columns are `q1`, `q2`, … (the counters after the clock; `q` where there is but one), then `dx`, `dy`, …, then
/// `x`, `y`, ….
///
/// Source: the method of the digital pulse multiplier, units that add.
///
/// # Panics
/// When the slices differ in length, or a |d| does not fit, or there are no units or more than 30 bits.
pub(crate) fn dpm_line_cascade(units: u32, bits: u32, from: &[i64], to: &[i64]) -> Table {
    assert!(units >= 1 && units * bits <= 30, "1 to 30 bits in units");
    let unit = Binary::new(bits);
    let mut line = Line::load(from, to, 1 << (units * bits));
    let names: Vec<String> = match units {
        1 => vec!["q".to_owned()],
        _ => (1..=units).map(|index| format!("q{index}")).collect(),
    };
    let mut table = Table::new(line.columns(&names.iter().map(String::as_str).collect::<Vec<_>>()));
    let mut counters = vec![0; names.len()];
    table.push(&[&counters, &line.pulse, &line.position]);
    let mut running = true;
    while running {
        // The units before the first that is not at all ones go to 0 with it.
        let last = (1 << bits) - 1;
        let full = counters.iter().take_while(|&&q| q == last).count();
        let pulsing = counters.get(full).copied();
        line.step(|word| {
            let rank = u32::try_from(full).expect("few units");
            pulsing.is_some_and(|q| unit.gives((word >> (bits * (units - 1 - rank))) & last, q))
        });
        for q in counters.iter_mut().take(full + 1) {
            *q = unit.next(*q);
        }
        running = pulsing.is_some();
        table.push(&[&counters, &line.pulse, &line.position]);
    }
    table.finished = true;
    table
}

/// The step table of a straight line in 2 to 6 axes, in BLU, with `digits` cascaded decade units.
///
/// A unit passes as many of its ten clocks as its digit says; see [`decade_gives`]. The first unit,
/// which counts every clock, holds the most significant digit. Each further one is enabled in the
/// slots 9 of all units before it, where these give no pulse. A block lasts 10^`digits` clocks.
///
/// The columns are `q` (the clocks that were counted, modulo 10^`digits`: the first unit's count is
/// its units digit), then `dx`, `dy`, …, then `x`, `y`, ….
///
/// Source: the method of the digital pulse multiplier; the slots of a decade are the project's own.
///
/// # Panics
/// When the slices differ in length, or a |d| does not fit the digits, or there are more than 9.
pub(crate) fn dpm_line_decade(digits: u32, from: &[i64], to: &[i64]) -> Table {
    assert!((1..=9).contains(&digits), "1 to 9 digits");
    let clocks = 10_i64.pow(digits);
    let mut line = Line::load(from, to, clocks);
    let mut table = Table::new(line.columns(&["q"]));
    table.push(&[&[0], &line.pulse, &line.position]);
    for q in 0..clocks {
        line.step(|word| decades_give(digits, word, q));
        table.push(&[&[(q + 1) % clocks], &line.pulse, &line.position]);
    }
    table.finished = true;
    table
}

/// The step table of a straight line as in [`dpm_line`], slowed down by a feed override of `percent`
/// (1 ..= 99).
///
/// Two decade units count every clock and hold the two digits of `percent`. The binary unit of the
/// line takes a step at the clocks at which they give a pulse, and only there.
///
/// Each row is a step of the binary unit. The columns are `clock` (the clocks since the load), `o`
/// (the count of the decade units after the clock, 0 ..= 99), then those of [`dpm_line`].
///
/// Source: the method of the digital pulse multiplier, units in series.
///
/// # Panics
/// As [`dpm_line`], and when `percent` is out of range.
pub(crate) fn dpm_line_override(n: u32, from: &[i64], to: &[i64], percent: i64) -> Table {
    assert!((1..=99).contains(&percent), "1 to 99 per cent");
    let unit = Binary::new(n);
    let mut line = Line::load(from, to, 1 << n);
    let mut table = Table::new(line.columns(&["clock", "o", "q"]));
    let (mut clock, mut o, mut q) = (0, 0, 0);
    table.push(&[&[clock, o, q], &line.pulse, &line.position]);
    let mut left = 1_i64 << n;
    while left > 0 {
        let passes = decades_give(2, percent, o);
        clock += 1;
        o = (o + 1) % 100;
        if passes {
            line.step(|word| unit.gives(word, q));
            q = unit.next(q);
            left -= 1;
            table.push(&[&[clock, o, q], &line.pulse, &line.position]);
        }
    }
    table.finished = true;
    table
}

/// A binary unit: a counter and the gates of its stages.
struct Binary {
    /// The number of stages.
    n: u32,
}

impl Binary {
    /// A unit of `n` stages.
    fn new(n: u32) -> Self {
        assert!((1..=30).contains(&n), "1 to 30 bits");
        Binary { n }
    }

    /// True when the clock that finds the counter at `q` gives a pulse for this coefficient.
    fn gives(&self, coefficient: i64, q: i64) -> bool {
        let mut pulse = false;
        for stage in 0..self.n {
            let lower_are_ones = (0..stage).all(|below| bit(q, below));
            let rises = lower_are_ones && !bit(q, stage);
            pulse |= rises && bit(coefficient, self.n - 1 - stage);
        }
        pulse
    }

    /// The counter after a clock: every stage toggles whose lower stages are all ones.
    fn next(&self, q: i64) -> i64 {
        let mut next = q;
        for stage in 0..self.n {
            if (0..stage).all(|below| bit(q, below)) {
                next ^= 1 << stage;
            }
        }
        next
    }
}

/// Bit `index` of a value that is not negative.
fn bit(value: i64, index: u32) -> bool {
    (value >> index) & 1 == 1
}

/// True when a decade unit that holds this digit gives a pulse in a slot (its count before the
/// clock). The bits 8, 4, 2, 1 of the digit have slots of their own; where the slots of two bits
/// coincide, no digit has both.
fn decade_gives(digit: i64, slot: i64) -> bool {
    let slots: [(u32, &[i64]); 4] = [(3, &[0, 1, 2, 3, 5, 6, 7, 8]), (2, &[1, 3, 5, 7]), (1, &[2, 6]), (0, &[4])];
    slots.into_iter().any(|(index, slots)| bit(digit, index) && slots.contains(&slot))
}

/// True when one of the cascaded decades gives a pulse on the clock that finds the count `q`.
fn decades_give(digits: u32, word: i64, q: i64) -> bool {
    let (mut enabled, mut pulse) = (true, false);
    for unit in 0..digits {
        let slot = q / 10_i64.pow(unit) % 10;
        let digit = word / 10_i64.pow(digits - 1 - unit) % 10;
        pulse |= enabled && decade_gives(digit, slot);
        enabled &= slot == 9;
    }
    pulse
}

/// The axes of a line in progress.
struct Line {
    /// The signed lengths; their magnitudes are the coefficients.
    d: Vec<i64>,
    /// The pulses of the last step.
    pulse: Vec<i64>,
    /// The machine position.
    position: Vec<i64>,
}

impl Line {
    /// The coefficients of a block, all below `limit`.
    fn load(from: &[i64], to: &[i64], limit: i64) -> Self {
        let axes = from.len();
        assert!((2..=AXES.len()).contains(&axes) && to.len() == axes, "2 to 6 axes");
        let d: Vec<i64> = to.iter().zip(from).map(|(to, from)| to - from).collect();
        assert!(d.iter().all(|d| d.abs() < limit), "every coefficient fits its register");
        Line { d, pulse: vec![0; axes], position: from.to_vec() }
    }

    /// One step: `gives` says for a coefficient whether there is a pulse.
    fn step(&mut self, gives: impl Fn(i64) -> bool) {
        for (axis, d) in self.d.iter().enumerate() {
            self.pulse[axis] = d.signum() * i64::from(gives(d.abs()));
            self.position[axis] += self.pulse[axis];
        }
    }

    /// The columns: the counters, the pulses and the position.
    fn columns(&self, counters: &[&str]) -> Vec<String> {
        let axes = self.d.len();
        let counters = counters.iter().map(|&name| name.to_owned());
        counters.chain(per_axis_columns("d", axes)).chain(per_axis_columns("", axes)).collect()
    }
}
