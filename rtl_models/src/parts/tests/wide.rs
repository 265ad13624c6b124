//! Numbers of several words: sums, differences, products and comparisons, with every carry.

use super::super::wide::Wide;
use super::bench::on_every_engine;

/// Words of 32 bits whose carries go on, stop and begin.
const WORDS: [u128; 5] = [0, 1, 0xFFFF_FFFE, 0xFFFF_FFFF, 0x8000_0000];

/// Every number of two such words.
fn numbers() -> impl Iterator<Item = u128> {
    WORDS.into_iter().flat_map(|high| WORDS.map(|low| (high << 32) | low))
}

fn bits(number: u128) -> i128 {
    i128::try_from(number).unwrap()
}

#[test]
fn numbers_of_three_words_are_added_subtracted_multiplied_and_compared() {
    on_every_engine(
        |m| {
            let wide = Wide::new(m, 96);
            let [a, b] = ["a", "b"].map(|name| m.input(name, 64));
            let factor = m.input("factor", 32);
            let whole = |name: &str, number: &[_]| {
                m.name(&format!("{name}_low"), wide.slice(number, 0, 60));
                m.name(&format!("{name}_high"), wide.slice(number, 60, 36));
            };
            let [a, b] = [wide.of(a), wide.of(b)];
            let sum = wide.sum(&a, &b);
            whole("sum", &sum);
            whole("difference", &wide.difference(&sum, &b));
            whole("product", &wide.product(&a, factor));
            m.name("at_most", wide.at_most(&a, &b));
        },
        |bench| {
            for (a, b) in numbers().flat_map(|a| numbers().map(move |b| (a, b))) {
                let factor = b & 0xFFFF_FFFF;
                bench.clock(&[("a", bits(a)), ("b", bits(b)), ("factor", bits(factor))]);
                let of =
                    |name: &str| bench.value(&format!("{name}_low")) | (bench.value(&format!("{name}_high")) << 60);
                assert_eq!(of("sum"), bits(a + b), "{a:x} + {b:x}");
                assert_eq!(of("difference"), bits(a), "{a:x} + {b:x} - {b:x}");
                assert_eq!(of("product"), bits(a * factor), "{a:x} * {factor:x}");
                assert_eq!(bench.value("at_most") == 1, a <= b, "{a:x} <= {b:x}");
            }
        },
    );
}
