//! Negation, magnitude, and the gain of a square.

use super::super::{magnitude, negated, square_gain};
use super::bench::{numbers, on_every_engine, wrapped};

#[test]
fn every_number_of_up_to_five_bits_is_negated_and_measured() {
    for bits in 1..=5 {
        on_every_engine(
            |m| {
                let value = m.input_signed("value", bits);
                m.name("negated", negated(m, value));
                m.name("magnitude", magnitude(m, value));
            },
            |bench| {
                for value in numbers(bits, true) {
                    bench.clock(&[("value", value)]);
                    assert_eq!(bench.value("negated"), wrapped(-value, bits, true), "-({value}) in {bits} bits");
                    assert_eq!(bench.value("magnitude"), value.abs(), "|{value}| in {bits} bits");
                }
            },
        );
    }
}

#[test]
fn the_gain_of_a_square_is_the_difference_of_two_squares() {
    for bits in 1..=5 {
        on_every_engine(
            |m| {
                let gain = square_gain(m, m.input("c", bits), m.input("grows", 1));
                m.name("gain", gain);
            },
            |bench| {
                for c in numbers(bits, false) {
                    bench.clock(&[("c", c), ("grows", 1)]);
                    assert_eq!(bench.value("gain"), (c + 1).pow(2) - c.pow(2));
                    if c > 0 {
                        bench.clock(&[("grows", 0)]);
                        assert_eq!(bench.value("gain"), c.pow(2) - (c - 1).pow(2));
                    }
                }
            },
        );
    }
}
