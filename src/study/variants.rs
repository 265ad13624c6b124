//! The hardware choices of a sweep: some values of each, and the product of them all.

use stepwave_kernel::Width;
use stepwave_models::{Choice, Choices, Millionths, Named, Preset, StepTiming};

use super::{Range, StudyError};

/// Values of one choice, each with the word that one writes for it.
#[derive(Clone, Debug)]
pub struct Dimension {
    /// The choice.
    pub choice: Choice,
    values: Vec<(String, Setting)>,
}

/// One value of a choice; widths and presets may be of single registers.
#[derive(Clone, Debug)]
enum Setting {
    Widths(Vec<(Option<String>, Width)>),
    Presets(Vec<(Option<String>, Preset)>),
    Override(Option<u64>),
    Cascade(Option<Width>),
    PickOff(u64),
    Fraction(u32),
    Step(Millionths),
    Tolerance(Millionths),
    Timing(StepTiming),
    /// A value of a choice among words, by its index.
    Word(usize),
}

/// The value with this index.
fn nth<T: Named>(index: usize) -> Option<T> {
    T::ALL.get(index).map(|(_, value)| *value)
}

fn words<T: Named>() -> Vec<&'static str> {
    T::ALL.iter().map(|(word, _)| *word).collect()
}

/// The words of a choice among words.
fn words_of(choice: Choice) -> Vec<&'static str> {
    use stepwave_models::{Adder, Beats, Compare, EndPoint, Form, OnOverflow, Radix, System, Weights};
    match choice {
        Choice::Normalize => vec!["no", "yes"],
        Choice::Radix => words::<Radix>(),
        Choice::Adder => words::<Adder>(),
        Choice::EndPoint => words::<EndPoint>(),
        Choice::Form => words::<Form>(),
        Choice::Weights => words::<Weights>(),
        Choice::Beats => words::<Beats>(),
        Choice::Compare => words::<Compare>(),
        Choice::System => words::<System>(),
        Choice::OnOverflow => words::<OnOverflow>(),
        Choice::Width | Choice::Preset | Choice::Override => Vec::new(),
        Choice::Cascade | Choice::PickOff | Choice::Timing => Vec::new(),
        Choice::Fraction | Choice::Step | Choice::Tolerance => Vec::new(),
    }
}

impl Setting {
    fn apply(&self, choice: Choice, choices: &mut Choices) {
        match self {
            Setting::Widths(widths) => {
                for (name, width) in widths {
                    match name {
                        Some(name) => _ = choices.widths.insert(name.clone(), *width),
                        None => choices.width = Some(*width),
                    }
                }
            }
            Setting::Presets(presets) => {
                for (name, preset) in presets {
                    match name {
                        Some(name) => _ = choices.presets.insert(name.clone(), *preset),
                        None => choices.preset = Some(*preset),
                    }
                }
            }
            Setting::Override(percent) => choices.feed_override = *percent,
            Setting::Cascade(bits) => choices.cascade = *bits,
            Setting::PickOff(bit) => choices.pick_off = Some(*bit),
            Setting::Fraction(bits) => choices.fraction = Some(*bits),
            Setting::Step(way) => choices.step = Some(*way),
            Setting::Tolerance(length) => choices.tolerance = Some(*length),
            Setting::Timing(timing) => choices.timing = Some(*timing),
            Setting::Word(index) => match choice {
                Choice::Normalize => choices.normalize = *index == 1,
                Choice::Radix => choices.radix = nth(*index),
                Choice::Adder => choices.adder = nth(*index),
                Choice::EndPoint => choices.end_point = nth(*index),
                Choice::Form => choices.form = nth(*index),
                Choice::Weights => choices.weights = nth(*index),
                Choice::Beats => choices.beats = nth(*index),
                Choice::Compare => choices.compare = nth(*index),
                Choice::System => choices.system = nth(*index),
                Choice::OnOverflow => choices.on_overflow = nth(*index),
                _ => {}
            },
        }
    }
}

impl Dimension {
    /// The values that a list with commas gives: `8..12`, `zero,half`, `f=3..5`. Of widths and presets, what is said of
    /// all registers and of each single one makes a product of its own.
    ///
    /// # Errors
    /// A word is no value of this choice.
    pub fn parse(choice: Choice, text: &str) -> Result<Dimension, StudyError> {
        let wrong = |word: &str, values: &str| StudyError::NoValue {
            word: word.to_owned(),
            option: choice.option(),
            values: values.to_owned(),
        };
        let parts = || text.split(',').map(str::trim);
        let numbers = |word: &str, least: i64, most: i64, values: &str| {
            let range: Range = word.parse().map_err(|error| match error {
                StudyError::NoRange(_) => wrong(word, values),
                error => error,
            })?;
            let ends = [range.at(0), range.at(range.count() - 1)];
            if ends[0] < least || ends[1] > most { Err(wrong(word, values)) } else { Ok(range) }
        };
        let values = match choice {
            Choice::Width => {
                let values = "bits from 1 to 64, such as 8..12 or f=9..11";
                let named = named(parts(), |word| {
                    let widths = numbers(word, 1, 64, values)?.numbers();
                    Ok(widths.filter_map(|bits| Width::new(bits.cast_unsigned()).ok()).collect())
                })?;
                product(named, |width| width.get().to_string(), Setting::Widths)
            }
            Choice::Preset => {
                let values = "zero, half, full or numbers from 0 on, such as 0..15";
                let named = named(parts(), |word| {
                    Ok(match word {
                        "zero" => vec![Preset::Zero],
                        "half" => vec![Preset::Half],
                        "full" => vec![Preset::Full],
                        word => {
                            let range = numbers(word, 0, i64::MAX, values)?;
                            if range.count() > MOST_VALUES {
                                return Err(wrong(word, "fewer presets than 65536"));
                            }
                            range.numbers().map(|value| Preset::Value(value.cast_unsigned())).collect()
                        }
                    })
                })?;
                product(named, Preset::to_string, Setting::Presets)
            }
            Choice::Override | Choice::Cascade | Choice::PickOff => {
                let (most, values) = match choice {
                    Choice::Override => (99, "none or percentages from 1 to 99"),
                    Choice::Cascade => (64, "none or bits from 1 to 64"),
                    _ => (62, "bits from 1 to 62"),
                };
                let mut all = Vec::new();
                for word in parts() {
                    if word == "none" && choice != Choice::PickOff {
                        let none =
                            if choice == Choice::Override { Setting::Override(None) } else { Setting::Cascade(None) };
                        all.push((word.to_owned(), none));
                        continue;
                    }
                    all.extend(numbers(word, 1, most, values)?.numbers().map(|number| {
                        let value = number.cast_unsigned();
                        let setting = match choice {
                            Choice::Override => Setting::Override(Some(value)),
                            Choice::Cascade => Setting::Cascade(Width::new(value).ok()),
                            _ => Setting::PickOff(value),
                        };
                        (number.to_string(), setting)
                    }));
                }
                all
            }
            Choice::Fraction => {
                let mut all = Vec::new();
                for word in parts() {
                    let range = numbers(word, 1, 63, "bits such as 8..12")?;
                    let bits = range.numbers().filter_map(|number| u32::try_from(number).ok());
                    all.extend(bits.map(|bits| (bits.to_string(), Setting::Fraction(bits))));
                }
                all
            }
            Choice::Step => {
                let way = |word: &str| {
                    let way = word.parse().ok().and_then(Millionths::nearest).filter(|way| way.0 > 0);
                    let way = way.ok_or_else(|| wrong(word, "ways in BLU such as 8,102.4"))?;
                    Ok((way.to_string(), Setting::Step(way)))
                };
                parts().map(way).collect::<Result<_, StudyError>>()?
            }
            Choice::Timing => return Err(wrong(text, "times such as length=2,space=2,setup=4,hold=4")),
            choice => {
                let words = words_of(choice);
                let value = |word: &str| {
                    let index = words.iter().position(|known| *known == word);
                    let index = index.ok_or_else(|| wrong(word, &words.join(", ")))?;
                    Ok((word.to_owned(), Setting::Word(index)))
                };
                parts().map(value).collect::<Result<Vec<_>, StudyError>>()?
            }
        };
        Ok(Dimension { choice, values })
    }

    /// One tolerance of chords.
    #[must_use]
    pub fn tolerance(length: Millionths) -> Dimension {
        Dimension { choice: Choice::Tolerance, values: vec![(length.to_string(), Setting::Tolerance(length))] }
    }

    /// Times of step and direction outputs.
    #[must_use]
    pub fn timings(timings: &[StepTiming]) -> Dimension {
        let value = |timing: &StepTiming| (timing.to_string(), Setting::Timing(*timing));
        Dimension { choice: Choice::Timing, values: timings.iter().map(value).collect() }
    }
}

/// Most numbers that a range of values may have.
const MOST_VALUES: u64 = 1 << 16;

/// Values with the register that they are for, or for all; in the order in which they are named first.
type NamedValues<T> = Vec<(Option<String>, Vec<T>)>;

fn named<'a, T>(
    parts: impl Iterator<Item = &'a str>,
    parse: impl Fn(&str) -> Result<Vec<T>, StudyError>,
) -> Result<NamedValues<T>, StudyError> {
    let mut all: NamedValues<T> = Vec::new();
    for part in parts {
        let (name, word) = match part.split_once('=') {
            Some((name, word)) => (Some(name.trim().to_owned()), word.trim()),
            None => (None, part),
        };
        let values = parse(word)?;
        match all.iter_mut().find(|(known, _)| *known == name) {
            Some((_, known)) => known.extend(values),
            None => all.push((name, values)),
        }
    }
    Ok(all)
}

fn product<T: Copy>(
    named: NamedValues<T>,
    word: impl Fn(&T) -> String,
    setting: impl Fn(Vec<(Option<String>, T)>) -> Setting,
) -> Vec<(String, Setting)> {
    let mut all: Vec<Vec<(Option<String>, T)>> = vec![Vec::new()];
    for (name, values) in &named {
        let longer = |list: &Vec<(Option<String>, T)>| {
            let list = list.clone();
            values.iter().map(move |value| [list.clone(), vec![(name.clone(), *value)]].concat()).collect::<Vec<_>>()
        };
        all = all.iter().flat_map(longer).collect();
    }
    let text = |(name, value): &(Option<String>, T)| match name {
        Some(name) => format!("{name}={}", word(value)),
        None => word(value),
    };
    all.into_iter().map(|list| (list.iter().map(text).collect::<Vec<_>>().join(","), setting(list))).collect()
}

/// The product of some dimensions; the last changes fastest.
#[derive(Clone, Debug, Default)]
pub struct Variants(pub Vec<Dimension>);

impl Variants {
    /// How many there are; saturates.
    #[must_use]
    pub fn count(&self) -> u128 {
        self.0.iter().fold(1, |count, dimension| count.saturating_mul(dimension.values.len() as u128))
    }

    /// The choices of one of them, and the word for each dimension.
    #[must_use]
    pub fn at(&self, mut index: usize) -> (Choices, Vec<&str>) {
        let (mut choices, mut words) = (Choices::at_1_mhz(), Vec::new());
        for dimension in self.0.iter().rev() {
            let count = dimension.values.len().max(1);
            if let Some((word, setting)) = dimension.values.get(index % count) {
                setting.apply(dimension.choice, &mut choices);
                words.insert(0, word.as_str());
            }
            index /= count;
        }
        (choices, words)
    }

    /// The words of every dimension.
    pub(super) fn words(&self) -> impl Iterator<Item = (Choice, Vec<&str>)> {
        self.0
            .iter()
            .map(|dimension| (dimension.choice, dimension.values.iter().map(|(word, _)| word.as_str()).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stepwave_models::{Beats, EndPoint};

    fn words(choice: Choice, text: &str) -> Vec<String> {
        Dimension::parse(choice, text).unwrap().values.into_iter().map(|(word, _)| word).collect()
    }

    #[test]
    fn lists_ranges_and_single_registers_make_a_product() {
        assert_eq!(words(Choice::Width, "8..10,12"), ["8", "9", "10", "12"]);
        assert_eq!(words(Choice::Width, "8,f=9..10,xe=7"), ["8,f=9,xe=7", "8,f=10,xe=7"]);
        assert_eq!(words(Choice::Preset, "zero,half,3..5"), ["zero", "half", "3", "4", "5"]);
        assert_eq!(words(Choice::Normalize, "yes,no"), ["yes", "no"]);
        assert_eq!(words(Choice::Override, "none,50"), ["none", "50"]);
    }

    #[test]
    fn every_pair_of_values_stands_once_and_the_last_changes_fastest() {
        let dimensions = [(Choice::EndPoint, "total,per-axis"), (Choice::Beats, "4,1"), (Choice::Width, "f=5")];
        let variants = Variants(dimensions.map(|(choice, text)| Dimension::parse(choice, text).unwrap()).into());
        let all: Vec<(Choices, Vec<&str>)> = (0..4).map(|index| variants.at(index)).collect();
        assert_eq!(variants.count(), 4);
        assert_eq!(all[1].1, ["total", "1", "f=5"]);
        let choices = &all[2].0;
        assert_eq!((choices.end_point, choices.beats), (Some(EndPoint::PerAxis), Some(Beats::Four)));
        assert_eq!(choices.widths.get("f"), Width::new(5).ok().as_ref());
    }

    #[test]
    fn what_is_no_value_is_told_with_those_there_are() {
        for (choice, text, hint) in [
            (Choice::Width, "8,65", "'65' is no value of --width: give bits from 1 to 64"),
            (Choice::Width, "12..8", "begins behind its end"),
            (Choice::Preset, "quarter", "zero, half, full"),
            (Choice::EndPoint, "total,both", "'both' is no value of --end-point: give total, per-axis"),
            (Choice::Normalize, "maybe", "no, yes"),
            (Choice::PickOff, "none", "bits from 1 to 62"),
        ] {
            let error = Dimension::parse(choice, text).unwrap_err().to_string();
            assert!(error.contains(hint), "{text}: {error}");
        }
    }
}
