//! The first divergence of two waves, and everything else in which they differ.
//!
//! # What is compared with what
//! By clock (the default), sample *k* of A with sample *k* + offset of B, a sample being what [`read`](super::read)
//! says; the clocks themselves are not compared. By time, the values after every change, the times of both sides taken
//! to one unit; if one file alone names no timescale, its times cannot be compared. Only what both sides have is
//! compared by value; that one side lasts longer is a difference of its own. With an offset it is enough that both have
//! the same number of cycles, or that they end together.
//!
//! Signals are matched by name:
//! 1. The name of a signal is its dotted path, without a bit range.
//! 2. The first rule `a=b` of [`Options::map`] that fits renames a signal of A: `a` is its whole path or its leading
//!    scopes, `b` takes their place.
//! 3. If then no name of A is a name of B, the leading scopes that all signals of A share are taken off, and those
//!    that all signals of B share: `tb.dut.jr` alone and `dda_line.jr` alone are both `jr`. As soon as one name is
//!    common, nothing is taken off.
//!
//! A signal that one side lacks, a different width, and a different kind (bits, real, text, event) are differences.
//! What counts as the same value is said at [`Value::same`].

mod frame;
mod pairing;
mod report;
#[cfg(test)]
mod tests;

pub(crate) use frame::{Frame, Frames, Walk};
pub(crate) use pairing::pairs;

use super::read::{ClockError, Signal, Timescale, Value, ValueKind, Wave};
use std::collections::HashMap;

/// What to compare and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The common axis.
    pub by: By,
    /// Only signals that one of these globs matches; no glob means all. Globs are matched against the dotted path on
    /// each side, the compared name, and the name without scopes; `*` matches dots too.
    pub signals: Vec<String>,
    /// Leave out signals that one of these globs matches.
    pub ignore: Vec<String>,
    /// Rules that rename signals of A, as the module says.
    pub map: Vec<(String, String)>,
    /// Rows of context before and after the first divergence.
    pub context: usize,
}

impl Default for Options {
    fn default() -> Self {
        let by = By::Clock { offset: 0 };
        Self { by, signals: Vec::new(), ignore: Vec::new(), map: Vec::new(), context: 5 }
    }
}

/// The axis along which two waves are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// The cycles of each side's clock; cycle *k* of A is paired with cycle *k* + `offset` of B.
    Clock {
        /// In cycles; positive if B starts late.
        offset: i64,
    },
    /// Time.
    Time,
}

/// Why two waves cannot be compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what the fields are")]
pub enum CompareError {
    /// Sampling needs one on each side.
    #[error(transparent)]
    Clock(#[from] ClockError),
    /// Not a pattern.
    #[error("`{pattern}` is not a glob: {reason}")]
    BadGlob { pattern: String, reason: String },
    /// A rule of the map without effect is a typing mistake.
    #[error("the map renames `{from}`, but the first wave has no such signal or scope{hint}")]
    UnusedMap { from: String, hint: String },
    /// Two signals of A would be compared with one of B.
    #[error("the map gives two signals of the first wave the name `{name}`")]
    MapCollision { name: String },
    /// "No difference" would be a hollow claim.
    #[error("no signal is left to compare{hint}; loosen --signals or --ignore")]
    NothingToCompare { hint: String },
    /// The offset is larger than the wave.
    #[error("an offset of {offset} cycles leaves nothing to compare: the waves have {a} and {b} cycles")]
    NoOverlap { offset: i64, a: u64, b: u64 },
    /// Its unit would be a guess.
    #[error(
        "{without} names no time scale, {with} counts in {unit}: write `$timescale {unit} $end`, or what is true, into the \
         header of {without}, or compare by clock"
    )]
    NoTimescale { without: String, with: String, unit: Timescale },
    /// Timescales of seconds and zeptoseconds, say.
    #[error("the times of the two waves do not fit one unit")]
    TimeRange,
}

impl CompareError {
    fn no_timescale(without: &Wave, with: &Wave, unit: Timescale) -> Self {
        CompareError::NoTimescale { without: without.name().into(), with: with.name().into(), unit }
    }
}

/// A place on the common axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    /// A cycle of A.
    Clock(u64),
    /// A time.
    Time {
        /// Number of units.
        count: u128,
        /// Common to both waves; none if neither names one.
        unit: Option<Timescale>,
    },
}

impl Moment {
    fn time(position: i128, unit: Option<Timescale>) -> Self {
        Moment::Time { count: position.unsigned_abs(), unit }
    }
}

/// Where each side ends: the number of cycles, or the last time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lengths {
    /// Of the first wave.
    pub a: Moment,
    /// Of the second wave.
    pub b: Moment,
}

/// The outcome of a comparison. `Display` is the report for people: one line if the waves are the same.
#[derive(Debug)]
pub struct Comparison<'w> {
    /// The file names.
    pub waves: [&'w str; 2],
    /// Number of names that both sides have and that the options select.
    pub signals: usize,
    /// How far the comparison went: number of cycles, or the last time.
    pub extent: Moment,
    /// What differs, if anything.
    pub divergence: Option<Divergence<'w>>,
}

/// Everything in which two waves differ; at least one of the parts is not empty.
#[derive(Debug)]
pub struct Divergence<'w> {
    /// Signals whose values differ somewhere, by the moment of their first difference, then in the order of A.
    pub differences: Vec<Difference<'w>>,
    /// Signals that cannot be compared by value.
    pub mismatches: Vec<Mismatch<'w>>,
    /// Set if one side lasts longer.
    pub lengths: Option<Lengths>,
    /// The values around the first difference.
    pub context: Context<'w>,
}

/// The first difference of one signal.
#[derive(Debug)]
pub struct Difference<'w> {
    /// Cycle of A, or time.
    pub at: Moment,
    /// The beginning of this cycle in the time of each file, by clock only.
    pub times: Option<[String; 2]>,
    /// The signal in A.
    pub signal: &'w Signal,
    /// Its path in B.
    pub path_b: &'w str,
    /// Its value in A.
    pub a: Value<'w>,
    /// Its value in B.
    pub b: Value<'w>,
    /// Other names of this same pair of signals.
    pub aliases: Vec<String>,
}

/// A signal that cannot be compared by value.
#[derive(Debug)]
pub enum Mismatch<'w> {
    /// B lacks it.
    OnlyInA(&'w Signal),
    /// A lacks it.
    OnlyInB(&'w Signal),
    /// Unequal numbers of bits.
    Width(&'w Signal, &'w Signal),
    /// A real here, a vector there.
    Kind(&'w Signal, &'w Signal),
}

/// The values of the signals that diverge first, around the first difference.
#[derive(Debug, Default)]
pub struct Context<'w> {
    /// The signals as in A, at most [`COLUMNS`].
    pub signals: Vec<&'w Signal>,
    /// In the order of time.
    pub rows: Vec<ContextRow<'w>>,
}

/// One cycle, or one time at which one of the signals changes.
#[derive(Debug)]
pub struct ContextRow<'w> {
    /// Where.
    pub at: Moment,
    /// The value in A and the value in B of each signal.
    pub values: Vec<[Value<'w>; 2]>,
}

/// Signals in the table of context.
pub const COLUMNS: usize = 4;

/// What differs between two waves, if anything: [`compare`] without the numbers.
///
/// # Errors
/// [`CompareError`] if they cannot be compared as asked.
pub fn first_divergence<'w>(
    a: &'w Wave,
    b: &'w Wave,
    options: &Options,
) -> Result<Option<Divergence<'w>>, CompareError> {
    Ok(compare(a, b, options)?.divergence)
}

/// Compares two waves.
///
/// # Errors
/// [`CompareError`] if they cannot be compared as asked; a difference is not an error.
pub fn compare<'w>(a: &'w Wave, b: &'w Wave, options: &Options) -> Result<Comparison<'w>, CompareError> {
    let frames = Frames::new(a, b, options.by)?;
    let mut signals = 0;
    let mut mismatches = Vec::new();
    // One entry for each pair of stored signals, however many names it has.
    let mut groups: Vec<Group<'w>> = Vec::new();
    let mut group_of = HashMap::new();
    for pair in pairs(&frames, options)? {
        signals += usize::from(pair.a.is_some() && pair.b.is_some());
        match (pair.a, pair.b) {
            (Some(a), Some(b)) if class(a.kind) != class(b.kind) => mismatches.push(Mismatch::Kind(a, b)),
            (Some(a), Some(b)) if a.width != b.width => mismatches.push(Mismatch::Width(a, b)),
            (Some(a), Some(b)) => {
                let group = *group_of.entry((a.stored, b.stored)).or_insert(groups.len());
                match groups.get_mut(group) {
                    Some(group) => group.aliases.push(a.path.clone()),
                    None => groups.push(Group { a, b, aliases: Vec::new() }),
                }
            }
            (Some(a), None) => mismatches.push(Mismatch::OnlyInA(a)),
            (None, Some(b)) => mismatches.push(Mismatch::OnlyInB(b)),
            (None, None) => {}
        }
    }
    let differs = |group: Group<'w>| Some((frames.first_difference(group.a, group.b)?, group));
    let mut found: Vec<(i128, Group<'w>)> = groups.into_iter().filter_map(differs).collect();
    found.sort_by_key(|(position, _)| *position);

    let lengths = frames.lengths;
    let extent = match options.by {
        By::Clock { .. } => Moment::Clock(u64::try_from(frames.common.end - frames.common.start).unwrap_or(0)),
        By::Time => frames.moment(frames.common.end - 1),
    };
    let same = found.is_empty() && mismatches.is_empty() && lengths.is_none();
    let divergence = (!same).then(|| Divergence {
        context: context(&frames, &found, options.context),
        differences: found.into_iter().map(|(position, group)| group.difference(&frames, position)).collect(),
        mismatches,
        lengths,
    });
    Ok(Comparison { waves: [a.name(), b.name()], signals, extent, divergence })
}

struct Group<'w> {
    a: &'w Signal,
    b: &'w Signal,
    aliases: Vec<String>,
}

impl<'w> Group<'w> {
    fn difference(self, frames: &Frames<'w>, position: i128) -> Difference<'w> {
        let time = |frame: &Frame<'_>| {
            let unit = frame.wave.timescale();
            let time = frame.time_of(position)?;
            Some(unit.map_or_else(|| format!("#{time}"), |unit| unit.show(time.into())))
        };
        Difference {
            at: frames.moment(position),
            times: time(&frames.a).zip(time(&frames.b)).filter(|_| !frames.by_time).map(|(a, b)| [a, b]),
            signal: self.a,
            path_b: &self.b.path,
            a: frames.a.value_at(self.a, position),
            b: frames.b.value_at(self.b, position),
            aliases: self.aliases,
        }
    }
}

/// Kinds whose values compare: a sign changes only how bits are shown.
fn class(kind: ValueKind) -> ValueKind {
    if kind == ValueKind::Signed { ValueKind::Unsigned } else { kind }
}

fn context<'w>(frames: &Frames<'w>, found: &[(i128, Group<'w>)], lines: usize) -> Context<'w> {
    let Some((first, _)) = found.first() else { return Context::default() };
    let reach = i128::try_from(lines).unwrap_or(i128::MAX);
    let range = first.saturating_sub(reach).max(frames.common.start)
        ..first.saturating_add(reach).saturating_add(1).min(frames.common.end);
    let shown = |position: i128| if frames.by_time { position == *first } else { range.contains(&position) };
    let shown: Vec<&Group<'w>> =
        found.iter().filter(|(position, _)| shown(*position)).map(|(_, group)| group).take(COLUMNS).collect();
    let positions: Vec<i128> = if !frames.by_time {
        range.collect()
    } else {
        let mut all = vec![*first];
        for group in &shown {
            for (frame, signal) in [(&frames.a, group.a), (&frames.b, group.b)] {
                let inside = frame.changes(signal).map(|(position, _)| position).filter(|p| frames.common.contains(p));
                all.extend(inside);
            }
        }
        all.sort_unstable();
        all.dedup();
        let at = all.partition_point(|position| position < first);
        all[at.saturating_sub(lines)..at.saturating_add(lines).saturating_add(1).min(all.len())].to_vec()
    };
    let row = |position: i128| ContextRow {
        at: frames.moment(position),
        values: shown.iter().map(|g| [frames.a.value_at(g.a, position), frames.b.value_at(g.b, position)]).collect(),
    };
    Context { signals: shown.iter().map(|group| group.a).collect(), rows: positions.into_iter().map(row).collect() }
}
