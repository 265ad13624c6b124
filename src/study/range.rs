//! Ranges of whole numbers, as one writes them: `5`, `0..255`, `0..255/5`; and grids of them: `0..9x-4..4`.

use std::fmt;
use std::str::FromStr;

use super::StudyError;

/// Whole numbers at equal distances, both ends among them where the step meets the last.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Range {
    first: i64,
    last: i64,
    step: u64,
}

impl Range {
    /// From `first` to `last`, in steps.
    ///
    /// # Errors
    /// The range is reversed, or the step is 0.
    pub fn new(first: i64, last: i64, step: u64) -> Result<Range, StudyError> {
        if last < first {
            return Err(StudyError::Reversed { first, last });
        }
        if step == 0 {
            return Err(StudyError::NoStep { first, last });
        }
        Ok(Range { first, last, step })
    }

    /// One number alone.
    #[must_use]
    pub fn one(number: i64) -> Range {
        Range { first: number, last: number, step: 1 }
    }

    /// The distance of two numbers.
    #[must_use]
    pub fn step(&self) -> u64 {
        self.step
    }

    /// How many numbers there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        (self.last.abs_diff(self.first) / self.step).saturating_add(1)
    }

    /// The number with this index, from 0; one beyond the last is not checked.
    #[must_use]
    pub fn at(&self, index: u64) -> i64 {
        self.first.saturating_add_unsigned(index.saturating_mul(self.step))
    }

    /// The index of a number, if the range holds it.
    #[must_use]
    pub fn index(&self, number: i64) -> Option<u64> {
        let offset = number.abs_diff(self.first);
        ((self.first..=self.last).contains(&number) && offset.is_multiple_of(self.step)).then(|| offset / self.step)
    }

    /// The numbers, from the least.
    pub fn numbers(self) -> impl Iterator<Item = i64> {
        (0..self.count()).map(move |index| self.at(index))
    }
}

impl FromStr for Range {
    type Err = StudyError;

    fn from_str(text: &str) -> Result<Range, StudyError> {
        let wrong = || StudyError::NoRange(text.to_owned());
        let number = |word: &str| word.trim().parse::<i64>().map_err(|_| wrong());
        let (ends, step) = match text.split_once('/') {
            Some((ends, step)) => (ends, step.trim().parse::<u64>().map_err(|_| wrong())?),
            None => (text, 1),
        };
        match ends.split_once("..") {
            Some((first, last)) => Range::new(number(first)?, number(last)?, step),
            None if step == 1 => number(ends).map(Range::one),
            None => Err(wrong()),
        }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.first == self.last, self.step) {
            (true, _) => write!(f, "{}", self.first),
            (false, 1) => write!(f, "{}..{}", self.first, self.last),
            (false, step) => write!(f, "{}..{}/{step}", self.first, self.last),
        }
    }
}

/// A range for each axis: the points of a grid.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Grid(pub Vec<Range>);

impl FromStr for Grid {
    type Err = StudyError;

    fn from_str(text: &str) -> Result<Grid, StudyError> {
        text.split('x').map(str::parse).collect::<Result<_, _>>().map(Grid)
    }
}

impl fmt::Display for Grid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ranges: Vec<String> = self.0.iter().map(Range::to_string).collect();
        f.write_str(&ranges.join("x"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_holds_both_ends_and_every_step_between() -> Result<(), StudyError> {
        let numbers = |text: &str| text.parse::<Range>().map(|range| range.numbers().collect::<Vec<_>>());
        assert_eq!(numbers("-2..2")?, [-2, -1, 0, 1, 2]);
        assert_eq!(numbers("0..11/5")?, [0, 5, 10]);
        assert_eq!(numbers("-7")?, [-7]);
        let range: Range = "3..9/3".parse()?;
        assert_eq!(
            (range.index(9), range.index(8), range.index(12), range.to_string()),
            (Some(2), None, None, "3..9/3".to_owned())
        );
        let whole: Range = format!("{}..{}", i64::MIN, i64::MAX).parse()?;
        assert_eq!((whole.count(), whole.at(u64::MAX)), (u64::MAX, i64::MAX));
        Ok(())
    }

    #[test]
    fn an_invalid_range_is_refused_with_a_remedy() {
        for (text, hint) in [
            ("9..3", "begins after its end"),
            ("0..9/0", "step of 0"),
            ("", "invalid range"),
            ("1..x", "invalid range"),
            ("5/2", "invalid range"),
        ] {
            let error = text.parse::<Range>().unwrap_err().to_string();
            assert!(error.contains(hint), "{text}: {error}");
        }
        assert_eq!("0..3x-1..1/2".parse::<Grid>().unwrap().to_string(), "0..3x-1..1/2");
    }
}
