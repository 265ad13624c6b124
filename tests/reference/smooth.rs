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
