//! Adders made of digits.

use super::super::{decimal_adder, digit_adder};
use super::bench::on_every_engine;
use crate::Radix;

#[test]
fn every_pair_of_digits_with_either_carry_gives_its_sum_and_carry() {
    for (radix, base, bits) in [(Radix::Binary, 2, 1), (Radix::Decimal, 10, 4)] {
        on_every_engine(
            |m| {
                let [a, b, carry] = [("a", bits), ("b", bits), ("carry", 1)].map(|(name, bits)| m.input(name, bits));
                let (over, sum) = digit_adder(m, radix, a, b, carry);
                m.name("over", over);
                m.name("sum", sum);
            },
            |bench| {
                for (a, b, carry) in (0..base).flat_map(|a| (0..base).flat_map(move |b| [(a, b, 0), (a, b, 1)])) {
                    bench.clock(&[("a", a), ("b", b), ("carry", carry)]);
                    let exact = a + b + carry;
                    let got = [bench.value("over"), bench.value("sum")];
                    assert_eq!(got, [exact / base, exact % base], "{a} + {b} + {carry}");
                }
            },
        );
    }
}

#[test]
fn a_decimal_sum_carries_from_digit_to_digit() {
    on_every_engine(
        |m| {
            let (carry, sum) = decimal_adder(m, m.input("a", 12), m.input("b", 12));
            m.name("carry", carry);
            m.name("sum", sum);
        },
        |bench| {
            for (a, b, carry, sum) in [
                (0x000, 0x000, 0, 0x000),
                (0x123, 0x456, 0, 0x579),
                (0x999, 0x001, 1, 0x000),
                (0x999, 0x999, 1, 0x998),
                (0x449, 0x551, 1, 0x000),
                (0x095, 0x005, 0, 0x100),
                (0x808, 0x909, 1, 0x717),
            ] {
                bench.clock(&[("a", a), ("b", b)]);
                assert_eq!([bench.value("carry"), bench.value("sum")], [carry, sum], "{a:03x} + {b:03x}");
            }
        },
    );
}
