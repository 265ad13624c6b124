//! Globs that select signals by name.

use std::borrow::Cow;

/// The longest glob, in bytes: longer ones, which no name needs, take long to match.
const LONGEST: usize = 1000;
/// The most alternatives that all braces of a glob give together.
const ALTERNATIVES: usize = 10_000;

/// A glob: `*` and `?` match dots too, and slashes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Glob {
    pattern: String,
    /// As it is matched.
    compiled: String,
}

impl Glob {
    /// It as it was given.
    #[must_use]
    pub fn pattern(&self) -> &str {
        &self.pattern
    }

    /// Whether a text fits.
    #[must_use]
    pub fn is_match(&self, text: &str) -> bool {
        fast_glob::glob_match(&self.compiled, without_slashes(text).as_ref())
    }
}

/// A name of signals has no parts between slashes, but the crate's `*` ends at one.
fn without_slashes(text: &str) -> Cow<'_, str> {
    if text.contains('/') { Cow::Owned(text.replace('/', "\u{1f}")) } else { Cow::Borrowed(text) }
}

/// Compiles a glob.
///
/// # Errors
/// Why the text is not one.
pub fn glob(pattern: &str) -> Result<Glob, String> {
    if pattern.len() > LONGEST {
        return Err(format!("it has {} bytes; at most {LONGEST} are read", pattern.len()));
    }
    let groups = pattern.split('{').skip(1).map(|group| group.matches(',').count() + 1);
    let alternatives = groups.fold(1_usize, usize::saturating_mul);
    if alternatives > ALTERNATIVES {
        return Err(format!("its braces give {alternatives} alternatives; at most {ALTERNATIVES} are read"));
    }
    let unopened = pattern.chars().try_fold(0_usize, |depth, c| match c {
        '{' => Some(depth + 1),
        '}' => depth.checked_sub(1),
        _ => Some(depth),
    });
    if unopened.is_none() {
        return Err("a } has no { before it".to_owned());
    }
    if let Some([first, _, last]) = empty_range(pattern) {
        return Err(format!("the range {first}-{last} is empty"));
    }
    fast_glob::validate(pattern).map_err(|error| error.to_string())?;
    let matched = without_slashes(pattern).into_owned();
    // The crate takes ! at the start for a negation; it is a character of names.
    let compiled = if matched.starts_with('!') { format!("\\{matched}") } else { matched };
    Ok(Glob { pattern: pattern.to_owned(), compiled })
}

/// A glob fits the path from some scope on, the leaf name and the whole path among these.
#[must_use]
pub fn fits_an_end(glob: &Glob, path: &str) -> bool {
    let ends = path.match_indices('.').map(|(at, _)| &path[at + 1..]);
    std::iter::once(path).chain(ends).any(|end| glob.is_match(end))
}

/// A range between brackets that begins after its end.
fn empty_range(pattern: &str) -> Option<[char; 3]> {
    let sets = pattern.split('[').skip(1).map(|set| set.split(']').next().unwrap_or_default());
    let ranges = sets.flat_map(|set| {
        let characters: Vec<char> = set.chars().collect();
        characters.windows(3).map(|range| [range[0], range[1], range[2]]).collect::<Vec<_>>()
    });
    ranges.into_iter().find(|[first, dash, last]| *dash == '-' && first > last)
}

/// A glob fits the leaf name, the dotted path, or the path without the design's name.
#[must_use]
pub fn fits(glob: &Glob, path: &str) -> bool {
    let leaf = path.rsplit('.').next().unwrap_or(path);
    let inner = path.split_once('.').map_or(path, |(_, inner)| inner);
    [leaf, path, inner].iter().any(|text| glob.is_match(text))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::glob;

    /// What a glob of these characters means, alternative by alternative and character by character.
    fn matches(pattern: &[char], text: &[char]) -> bool {
        match (pattern.split_first(), text.split_first()) {
            (None, _) => text.is_empty(),
            (Some(('*', rest)), _) => (0..=text.len()).any(|skipped| matches(rest, &text[skipped..])),
            (Some(('{', rest)), _) => {
                let end = rest.iter().position(|c| *c == '}').expect("closed");
                let alternatives = rest[..end].split(|c| *c == ',');
                alternatives.into_iter().any(|own| matches(&[own, &rest[end + 1..]].concat(), text))
            }
            (Some(('?', rest)), Some((_, after))) => matches(rest, after),
            (Some((wanted, rest)), Some((first, after))) => wanted == first && matches(rest, after),
            (Some(_), None) => false,
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

        #[test]
        fn stars_question_marks_and_braces_fit_what_they_mean(
            parts in prop::collection::vec(prop::sample::select(vec!["a", "b", ".", "/", "!", "*", "?", "{a,b*}", "{,a.b,?}"]), 0..7),
            text in prop::collection::vec(prop::sample::select(vec!['a', 'b', '.', '/', '!']), 0..7),
        ) {
            let pattern = parts.concat();
            let characters: Vec<char> = pattern.chars().collect();
            let written: String = text.iter().collect();
            prop_assert_eq!(glob(&pattern).unwrap().is_match(&written), matches(&characters, &text), "{} {}", pattern, written);
        }
    }

    #[test]
    fn what_is_no_glob_is_refused_and_never_panics() {
        assert!(glob("*.{x,y}[0-3]").is_ok_and(|glob| glob.is_match("m.x2") && !glob.is_match("m.x4")));
        for pattern in ["[z", "{a", "a}", "[z-a]", "{".repeat(9).as_str(), "{".repeat(5000).as_str(), &"a".repeat(1001)]
        {
            assert!(glob(pattern).is_err(), "{pattern}");
        }
        // Every short pattern of the characters that mean something.
        let characters = ['{', '}', '[', ']', ',', '*', '?', '\\', '!', '-', 'a', '/'];
        for number in 0..characters.len().pow(5) {
            let digit = |place: u32| characters[number / characters.len().pow(place) % characters.len()];
            let _ = glob(&(0..5).map(digit).collect::<String>());
        }
    }
}
