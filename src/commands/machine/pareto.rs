//! Rows that nothing beats: of two rows that draw the same kind of curve one beats the other where it is nowhere worse and
//! somewhere better.

use super::{Answer, Row};
use crate::models::CurveKind;
use crate::study::machine::Size;

/// A row that was left out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Beaten {
    pub(super) model: &'static str,
    /// A row that is kept and that beats it.
    pub(super) by: &'static str,
}

/// What a row is judged by, less is better: the clock for the feed, or with costs minus the feed at the highest clock;
/// the error; bits of registers, or with costs LUTs and flip-flops.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Merit {
    is_arc: bool,
    numbers: [f64; 3],
}

impl Merit {
    /// `None` where something is not known: such a row neither beats nor is beaten.
    fn of(row: &Row, size: &Size) -> Option<Merit> {
        let found = &row.found;
        let (speed, size) = match row.cost {
            Some(cost) => (-row.feeds(size, cost.clock_hz?)?[0], (cost.luts + cost.flip_flops) as f64),
            None => (found.clock_hz(size.feed)?, found.register_bits.into()),
        };
        let error = found.worst()?.error;
        Some(Merit { is_arc: found.model.curve() == CurveKind::Arc, numbers: [speed, error, size] })
    }

    fn beats(&self, other: &Merit) -> bool {
        let pairs = || self.numbers.iter().zip(&other.numbers);
        self.is_arc == other.is_arc
            && pairs().all(|(own, other)| own <= other)
            && pairs().any(|(own, other)| own < other)
    }
}

/// For each row one that beats it and that nothing beats.
fn beaten_by(merits: &[Option<Merit>]) -> Vec<Option<usize>> {
    let beats = |by: usize, row: usize| merits[by].zip(merits[row]).is_some_and(|(own, other)| own.beats(&other));
    let rows = 0..merits.len();
    let kept: Vec<usize> = rows.clone().filter(|&row| !rows.clone().any(|by| beats(by, row))).collect();
    rows.map(|row| kept.iter().copied().find(|&by| beats(by, row))).collect()
}

/// Leaves out the rows that others beat.
pub(super) fn keep_unbeaten(answer: &mut Answer) {
    let merits: Vec<_> = answer.rows.iter().map(|row| Merit::of(row, &answer.size)).collect();
    let names: Vec<&'static str> = answer.rows.iter().map(|row| row.found.model.name).collect();
    let beaten_by = beaten_by(&merits);
    let beaten = names.iter().zip(&beaten_by);
    answer.beaten = Some(beaten.filter_map(|(&model, by)| by.map(|by| Beaten { model, by: names[by] })).collect());
    let mut judged = beaten_by.into_iter();
    answer.rows.retain(|_| judged.next().flatten().is_none());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_nowhere_better_is_beaten_by_one_that_is_kept() {
        let line = |numbers: [f64; 3]| Some(Merit { is_arc: false, numbers });
        let rows = [
            line([3.0, 1.0, 9.0]),
            line([2.0, 1.0, 9.0]),
            line([2.0, 1.0, 8.0]),
            line([9.0, 0.5, 8.0]),
            // As good as another, an arc, one of which nothing is known.
            line([2.0, 1.0, 8.0]),
            Some(Merit { is_arc: true, numbers: [9.0; 3] }),
            None,
        ];
        assert_eq!(beaten_by(&rows), [Some(2), Some(2), None, None, None, None, None]);
    }
}
