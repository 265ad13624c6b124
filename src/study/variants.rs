//! The hardware options of a sweep: some values of each, and the product of them all.

use stepwave_models::options::{AnyOption, Options, Shape, Value};

use super::{Range, StudyError};

/// Values of one option, each with the word that one writes for it.
#[derive(Clone, Debug)]
pub struct Dimension {
    /// The option.
    pub option: &'static dyn AnyOption,
    values: Vec<Value>,
}

impl Dimension {
    /// The values that a list with commas gives: `8..12`, `zero,half`, `f=3..5`. Of widths and presets, what is said of
    /// all registers and of each single one makes a product of its own. A value with commas of its own is a list of
    /// one.
    ///
    /// # Errors
    /// A word is not a value of this option.
    pub fn parse(option: &'static dyn AnyOption, text: &str) -> Result<Dimension, StudyError> {
        let texts = match option.shape() {
            shape @ Shape::Commas if option.parse(text).is_err() && text.parse::<Range>().is_ok() => {
                values_of(option, &shape, text)?
            }
            Shape::Commas => vec![text.to_owned()],
            shape @ Shape::PerRegister { .. } => {
                let named = named(text.split(',').map(str::trim), |word| values_of(option, &shape, word))?;
                product(&named)
            }
            shape => {
                let words = text.split(',').map(|word| values_of(option, &shape, word.trim()));
                words.collect::<Result<Vec<_>, _>>()?.concat()
            }
        };
        let value = |text: String| option.parse(&text).map_err(|_| wrong(option, &text));
        Ok(Dimension { option, values: texts.into_iter().map(value).collect::<Result<_, _>>()? })
    }

    /// Number of values.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a list that is given has a value")]
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// With the values of another list of the same option.
    #[must_use]
    pub fn and(mut self, other: Dimension) -> Dimension {
        self.values.extend(other.values);
        self
    }
}

/// What there would have been to give.
fn wrong(option: &dyn AnyOption, word: &str) -> StudyError {
    let values = match option.shape() {
        Shape::Words(words) => words.join(", "),
        Shape::Numbers { values, .. } | Shape::PerRegister { values, .. } | Shape::Text { values, .. } => {
            values.to_owned()
        }
        Shape::Commas => format!("values of the form {}", option.value_name()),
    };
    StudyError::NoValue { word: word.to_owned(), option: option.name(), values }
}

/// The values of a word of a list: itself, or all numbers of a range.
fn values_of(option: &'static dyn AnyOption, shape: &Shape, word: &str) -> Result<Vec<String>, StudyError> {
    let (least, most, words): (u64, u64, &[&str]) = match shape {
        Shape::Words(words) if words.contains(&word) => return Ok(vec![word.to_owned()]),
        Shape::Words(_) => return Err(wrong(option, word)),
        Shape::Text { .. } => {
            // As the option writes it, so that equal values have equal words.
            let value = option.parse(word).map_err(|_| wrong(option, word))?;
            return Ok(vec![value.text().to_owned()]);
        }
        Shape::Numbers { least, most, none, .. } => (*least, *most, if *none { &["none"] } else { &[] }),
        Shape::PerRegister { words, least, most, .. } => (*least, *most, words),
        Shape::Commas => (0, u64::MAX, &[]),
    };
    if words.contains(&word) {
        return Ok(vec![word.to_owned()]);
    }
    let range: Range = match word.parse() {
        // A number with a unit.
        Err(_) if option.parse(word).is_ok() => return Ok(vec![word.to_owned()]),
        Err(StudyError::NoRange(_)) => return Err(wrong(option, word)),
        range => range?,
    };
    let within = |number: i64| u64::try_from(number).is_ok_and(|number| (least..=most).contains(&number));
    if !within(range.at(0)) || !within(range.at(range.count() - 1)) {
        return Err(wrong(option, word));
    }
    if range.count() > MOST_VALUES {
        let values = format!("fewer values than {MOST_VALUES}");
        return Err(StudyError::NoValue { word: word.to_owned(), option: option.name(), values });
    }
    Ok(range.numbers().map(|number| number.to_string()).collect())
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

/// Every choice of one value for each name, as texts: `8,f=9`.
fn product(named: &NamedValues<String>) -> Vec<String> {
    let mut all = vec![String::new()];
    for (name, values) in named {
        let word = |value: &String| match name {
            Some(name) => format!("{name}={value}"),
            None => value.clone(),
        };
        let longer = |list: &String| -> Vec<String> {
            let comma = if list.is_empty() { "" } else { "," };
            values.iter().map(|value| format!("{list}{comma}{}", word(value))).collect()
        };
        all = all.iter().flat_map(longer).collect();
    }
    all
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

    /// The options of one of them, and the word for each dimension.
    #[must_use]
    pub fn at(&self, mut index: usize) -> (Options, Vec<&str>) {
        let (mut options, mut words) = (Options::at_1_mhz(), Vec::new());
        for dimension in self.0.iter().rev() {
            let count = dimension.values.len().max(1);
            if let Some(value) = dimension.values.get(index % count) {
                options.set(value.clone());
                words.insert(0, value.text());
            }
            index /= count;
        }
        (options, words)
    }

    /// The words of every dimension.
    pub(super) fn words(&self) -> impl Iterator<Item = (&'static dyn AnyOption, Vec<&str>)> {
        self.0.iter().map(|dimension| (dimension.option, dimension.values.iter().map(Value::text).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stepwave_models::options::{BEATS, Beats, END_POINT, EndPoint, NORMALIZE, OVERRIDE, PICK_OFF, PRESET, WIDTH};
    use stepwave_netlist::Width;

    fn words(option: &'static dyn AnyOption, text: &str) -> Vec<String> {
        Dimension::parse(option, text).unwrap().values.iter().map(|value| value.text().to_owned()).collect()
    }

    #[test]
    fn lists_ranges_and_single_registers_make_a_product() {
        assert_eq!(words(&WIDTH, "8..10,12"), ["8", "9", "10", "12"]);
        assert_eq!(words(&WIDTH, "8,f=9..10,xe=7"), ["8,f=9,xe=7", "8,f=10,xe=7"]);
        assert_eq!(words(&PRESET, "zero,half,3..5"), ["zero", "half", "3", "4", "5"]);
        assert_eq!(words(&NORMALIZE, "yes,no"), ["yes", "no"]);
        assert_eq!(words(&OVERRIDE, "none,50"), ["none", "50"]);
    }

    #[test]
    fn every_pair_of_values_occurs_once_and_the_last_changes_fastest() {
        let dimensions: [(&'static dyn AnyOption, &str); 3] =
            [(&END_POINT, "total,per-axis"), (&BEATS, "4,1"), (&WIDTH, "f=5")];
        let variants = Variants(dimensions.map(|(choice, text)| Dimension::parse(choice, text).unwrap()).into());
        let all: Vec<(Options, Vec<&str>)> = (0..4).map(|index| variants.at(index)).collect();
        assert_eq!(variants.count(), 4);
        assert_eq!(all[1].1, ["total", "1", "f=5"]);
        let choices = &all[2].0;
        assert_eq!((choices.get(&END_POINT), choices.get(&BEATS)), (Some(&EndPoint::PerAxis), Some(&Beats::Four)));
        assert_eq!(choices.of_single(&WIDTH).get("f"), Width::new(5).ok().as_ref());
    }

    #[test]
    fn an_invalid_value_is_reported_with_the_valid_ones() {
        let wrong: [(&'static dyn AnyOption, &str, &str); 6] = [
            (&WIDTH, "8,65", "invalid value '65' of --width: give bits from 1 to 64"),
            (&WIDTH, "12..8", "begins after its end"),
            (&PRESET, "quarter", "zero, half, full"),
            (&END_POINT, "total,both", "invalid value 'both' of --end-point: give total, per-axis"),
            (&NORMALIZE, "maybe", "no, yes"),
            (&PICK_OFF, "none", "bits from 1 to 62"),
        ];
        for (option, text, hint) in wrong {
            let error = Dimension::parse(option, text).unwrap_err().to_string();
            assert!(error.contains(hint), "{text}: {error}");
        }
    }
}
