//! Names that are nearly the one given, for messages about unknown names.

/// Longer names are not compared.
const LONGEST: usize = 100;

/// ` (did you mean 'NAME'?)` with the known name that differs from the one given by a typing error; nothing where none
/// does. Capitals do not count, nor whether words are joined by `-` or `_`.
///
/// ```
/// use stepwave_netlist::did_you_mean;
/// assert_eq!(did_you_mean("ppc-lien", ["dda-line", "ppc-line"]), " (did you mean 'ppc-line'?)");
/// assert_eq!(did_you_mean("quadrant", ["dda-line", "ppc-line"]), "");
/// ```
#[must_use]
pub fn did_you_mean<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let plain = |name: &str| name.to_lowercase().replace('_', "-");
    let wanted = plain(given);
    let letters = wanted.chars().count();
    if letters > LONGEST {
        return String::new();
    }
    // One letter in three may be wrong; of a single letter nothing would be left.
    let most = (letters / 3).max(1).min(letters.saturating_sub(1));
    // Only what is about as long is worth the comparison.
    let about = |name: &&str| name.chars().take(LONGEST + 1).count().abs_diff(letters) <= most;
    let near = known.into_iter().filter(about);
    let distances = near.map(|name| (strsim::damerau_levenshtein(&wanted, &plain(name)), name));
    match distances.filter(|(distance, _)| *distance <= most).min_by_key(|(distance, _)| *distance) {
        Some((_, name)) => format!(" (did you mean '{name}'?)"),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::did_you_mean;

    #[test]
    fn a_slip_of_the_pen_is_seen_and_a_guess_is_not_made() {
        let registers = ["jrx", "jry", "f", "quad"];
        for (given, meant) in [("jxr", "jrx"), ("JRY", "jry"), ("jr", "jrx"), ("qaud", "quad"), ("fx", "f")] {
            assert_eq!(did_you_mean(given, registers), format!(" (did you mean '{meant}'?)"), "{given}");
        }
        for given in ["g", "", "abc", "quotient"] {
            assert_eq!(did_you_mean(given, registers), "", "{given}");
        }
        assert_eq!(did_you_mean("dda_arc", ["dda-line", "dda-arc"]), " (did you mean 'dda-arc'?)");
    }
}
