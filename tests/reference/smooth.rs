//! Acceleration after the interpolator: moving sums and exponentials of the displacements of periods.

use super::Table;

/// What displacements go through.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Filter {
    /// The mean of the last k.
    Sum(i64),
    /// 2^-s of what has not come out.
    Exponential(u32),
}

/// The table of a displacement in periods of `step`, with the preset of the remainder: `left`, `s` and `rem` or `acc`, `jvx`, `jrx`,
/// `e`, `dx`, `x`.
pub(crate) fn smooth(filter: Filter, pulses: i64, step: i64, preset: i64) -> Table {
    let own: &[&str] = if let Filter::Sum(_) = filter { &["s", "rem"] } else { &["acc"] };
    let names = [&["left"][..], own, &["jvx", "jrx", "e", "dx", "x"]].concat();
    let mut table = Table::new(names.iter().map(|name| (*name).to_owned()).collect());
    let inputs: Vec<i64> = (0..).map(|i| (pulses - i * step).clamp(0, step)).take_while(|input| *input > 0).collect();
    let input = |period: usize| inputs.get(period).copied().unwrap_or(0);
    let (mut rem, mut acc, mut x) = (0, 0, 0);
    let mut row = |left: i64, own: [i64; 2], out: i64, x: i64| {
        let own = &own[..names.len() - 6];
        table.push(&[&[left], own, &[out, preset, pulses - x, out, x]]);
    };
    row(pulses, [0, 0], 0, 0);
    for period in 0.. {
        let left = pulses - (0..=period).map(input).sum::<i64>();
        let (own, out) = match filter {
            Filter::Sum(k) => {
                let first = (period + 1).saturating_sub(usize::try_from(k).unwrap());
                let sum: i64 = (first..=period).map(input).sum();
                let out = (sum + rem) / k;
                rem = (sum + rem) % k;
                ([sum, rem], out)
            }
            Filter::Exponential(s) => {
                acc += input(period);
                let out = (acc + (1 << s) - 1) >> s;
                acc -= out;
                ([acc, 0], out)
            }
        };
        x += out;
        row(left, own, out, x);
        if x == pulses {
            break;
        }
    }
    table.finished = true;
    table
}

/// What the pulses of one axis, one number for each sample, become after a filter with a sampling period of `period` clocks: one
/// number for each sample too. In the period after that in which they are counted the fine line makes 2^bits additions, the last
/// at its last clock.
pub(crate) fn smoothed(filter: Filter, period: usize, bits: u32, pulses: &[i64]) -> Vec<i64> {
    let counted: Vec<i64> = pulses.chunks(period).map(|pulses| pulses.iter().sum()).collect();
    let (mut rem, mut acc) = (0, 0);
    let filtered = |index: usize| match filter {
        Filter::Sum(k) => {
            let first = (index + 1).saturating_sub(usize::try_from(k).unwrap());
            let all: i64 = counted[first..=index].iter().sum::<i64>() + rem;
            rem = all.rem_euclid(k);
            all.div_euclid(k)
        }
        Filter::Exponential(s) => {
            acc += counted[index];
            let share = 1 << s;
            let out = acc.signum() * ((acc.abs() + share - 1) / share);
            acc -= out;
            out
        }
    };
    let out: Vec<i64> = (0..counted.len()).map(filtered).collect();
    let (scale, clocks) = (1_i64 << bits, i64::try_from(period).unwrap());
    let (mut rest, mut all) = (0, vec![0]);
    for sample in 0..pulses.len() - 1 {
        let period_before = (sample / period).checked_sub(1);
        let travel = period_before.map_or(0, |index| out[index]);
        let clock = i64::try_from(sample % period).unwrap();
        // One more of the 2^bits additions is due by the end of this clock.
        let due = |clocks_gone: i64| clocks_gone * scale / clocks;
        rest += if due(clock + 1) > due(clock) { travel.abs() } else { 0 };
        all.push(if rest >= scale { travel.signum() } else { 0 });
        rest %= scale;
    }
    all
}
