//! The `$timescale` of a VCD file.

use super::Timescale;

/// Reads the text between `$timescale` and `$end`: a number, also a decimal fraction, and a unit. The error says why it
/// cannot be read.
pub(super) fn parse(text: &str) -> Result<Timescale, String> {
    let packed: String = text.split_ascii_whitespace().collect();
    let unit = packed.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    let number = &packed[..packed.len() - unit.len()];
    let wrong = |why: &str| {
        format!("`$timescale {text}` cannot be read: {why}; write it as 1, 10 or 100 of a unit, as in `1 ns`")
    };
    let apart = text.split_ascii_whitespace().collect::<Vec<_>>();
    if !number.is_empty() && apart.len() > 1 && apart != [number, unit] {
        return Err(wrong("it is more than a number and a unit"));
    }
    let base = match unit {
        "s" => 0,
        "ms" => -3,
        "us" => -6,
        "ns" => -9,
        "ps" => -12,
        "fs" => -15,
        "as" => -18,
        "zs" => -21,
        "" => return Err(wrong("it has no unit")),
        _ => return Err(wrong(&format!("the unit `{unit}` is not one of s, ms, us, ns, ps, fs, as, zs"))),
    };
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    let fraction = fraction.trim_end_matches('0');
    let places = i32::try_from(fraction.len()).unwrap_or(i32::MAX);
    let mut count: u64 = match format!("{whole}{fraction}").parse() {
        Ok(0) => return Err(wrong("it is zero")),
        Ok(count) => count,
        Err(_) if number.is_empty() => return Err(wrong("it has no number")),
        Err(_) => return Err(wrong(&format!("`{number}` is not a number that fits"))),
    };
    let mut exponent = i32::saturating_sub(base, places);
    while count.is_multiple_of(10) {
        count /= 10;
        exponent += 1;
    }
    let third = (exponent.div_euclid(3) * 3).min(0);
    let factor = 10u64.checked_pow(exponent.abs_diff(third)).and_then(|ten| ten.checked_mul(count));
    match (factor.and_then(|factor| u32::try_from(factor).ok()), i8::try_from(third)) {
        (Some(factor), Ok(exponent @ -21..)) => Ok(Timescale { factor, exponent }),
        (_, Ok(-21..)) => Err(wrong("the number is too large")),
        _ => Err(wrong("it is finer than a zeptosecond")),
    }
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn every_unit_and_every_decimal_is_read_exactly_or_refused() {
        for (text, shown) in [
            ("1 ns", "1 ns"),
            ("1ns", "1 ns"),
            ("10us", "10 us"),
            ("100 ps", "100 ps"),
            ("1 s", "1 s"),
            ("1 zs", "1 zs"),
            ("0.1ps", "100 fs"),
            ("0.01 ns", "10 ps"),
            ("1.0 ns", "1 ns"),
            ("1000 ps", "1 ns"),
            ("5 ps", "5 ps"),
            ("2.5 us", "2500 ns"),
            ("1000 s", "1000 s"),
            ("100 as", "100 as"),
            ("10 ms", "10 ms"),
            ("1 fs", "1 fs"),
        ] {
            assert_eq!(parse(text).map(|scale| scale.to_string()).as_deref(), Ok(shown), "{text}");
        }
        for (text, why) in [
            ("1", "it has no unit"),
            ("ns", "it has no number"),
            ("0 ns", "it is zero"),
            ("1 sec", "the unit `sec` is not"),
            ("1 NS", "the unit `NS` is not"),
            ("0.1 zs", "finer than a zeptosecond"),
            ("-1 ns", "the unit `-1ns` is not"),
            ("1.2.3 ns", "is not a number"),
            ("99999999999999999999 ns", "is not a number"),
            ("5000000000 s", "too large"),
            ("", "it has no unit"),
            ("1/10 ns", "more than a number and a unit"),
            ("1/10ns", "the unit `/10ns` is not"),
            ("1 0 ns", "more than a number and a unit"),
            ("1 n s", "more than a number and a unit"),
            ("1n s", "more than a number and a unit"),
            ("1 ns 1 ns", "more than a number and a unit"),
        ] {
            let refused = parse(text).expect_err(text);
            assert!(refused.contains(why), "{text}: {refused}");
        }
    }
}
