//! The block loader and sequencer.

use stepwave_netlist::bits::Reading;
use stepwave_netlist::dsl::Scope;

use super::super::Block;
use super::bench::{loader, numbers, on_every_engine};
use crate::options::Radix;

fn sequencer(m: Scope<'_>) {
    let block = Block::new(m);
    m.name("preset", block.preset_position);
    block.close(block.load, m.input("step", 1), m.input("last", 1));
}

#[test]
fn a_block_is_busy_from_its_load_to_its_last_step_and_done_until_the_next_load() {
    on_every_engine(sequencer, |bench| {
        bench.play(&[
            ("load", "0100_0000_0100"),
            ("step", "0001_0101_0000"),
            // A last that comes without a step ends nothing.
            ("last", "0000_1001_0000"),
        ]);
        assert_eq!(bench.row("busy"), "0011_1111_0011");
        assert_eq!(bench.row("done"), "0000_0000_1100");
        assert_eq!(bench.row("loaded"), "0010_0000_0010");
        assert_eq!(bench.row("stepped"), "0000_1010_1000");
    });
}

#[test]
fn a_load_at_the_edge_of_the_last_step_starts_the_next_block() {
    on_every_engine(sequencer, |bench| {
        bench.play(&[("load", "0100_1000"), ("step", "0000_1000"), ("last", "0000_1000")]);
        assert_eq!(bench.row("busy"), "0011_1111");
        assert_eq!(bench.row("done"), "0000_0000");
        assert_eq!(bench.row("loaded"), "0010_0100");
    });
}

#[test]
fn positions_are_preset_only_together_with_a_load() {
    on_every_engine(sequencer, |bench| {
        bench.play(&[("load", "0110_0"), ("preset_position", "1010_1"), ("step", "0000_0"), ("last", "0000_0")]);
        assert_eq!(bench.row("preset"), "0010_0");
        assert_eq!(bench.row("busy"), "0011_1");
    });
}

#[test]
fn loaded_rises_with_ready_which_may_come_long_after_the_load() {
    on_every_engine(
        |m| {
            let block = Block::new(m);
            let finish = m.input("finish", 1);
            block.close(m.input("ready", 1), finish, finish);
        },
        |bench| {
            bench.play(&[("load", "0100_0010_0000"), ("ready", "0010_0000_0010"), ("finish", "0000_1000_0000")]);
            assert_eq!(bench.row("busy"), "0011_1001_1111");
            assert_eq!(bench.row("done"), "0000_0110_0000");
            assert_eq!(bench.row("loaded"), "0001_0000_0001");
        },
    );
}

#[test]
fn a_block_that_ends_after_its_last_step_is_busy_until_then() {
    on_every_engine(
        |m| {
            let block = Block::new(m);
            block.close_after(block.load, m.input("step", 1), m.input("finish", 1));
        },
        |bench| {
            bench.play(&[("load", "1000_0001_0000"), ("step", "0101_0000_0000"), ("finish", "0000_0100_0000")]);
            assert_eq!(bench.row("busy"), "0111_1100_1111");
            assert_eq!(bench.row("done"), "0000_0011_0000");
            assert_eq!(bench.row("stepped"), "0010_1000_0000");
        },
    );
}

#[test]
fn a_held_register_takes_its_word_at_the_load_and_no_other() {
    for bits in 1..=4 {
        on_every_engine(
            |m| {
                let block = loader(m);
                m.name("h", block.held(m, "held", bits));
                m.name("s", block.held_signed(m, "held_signed", bits));
            },
            |bench| {
                for (word, signed_word) in numbers(bits, false).zip(numbers(bits, true)) {
                    bench.clock(&[("load", 1), ("held_in", word), ("held_signed_in", signed_word)]);
                    bench.clock(&[
                        ("load", 0),
                        ("held_in", (1 << bits) - 1 - word),
                        ("held_signed_in", -1 - signed_word),
                    ]);
                    for _ in 0..2 {
                        assert_eq!((bench.value("h"), bench.value("held")), (word, word));
                        assert_eq!((bench.value("s"), bench.value("held_signed")), (signed_word, signed_word));
                        bench.clock(&[]);
                    }
                }
            },
        );
    }
}

#[test]
fn a_number_is_held_and_shown_in_its_radix() {
    on_every_engine(
        |m| {
            let block = loader(m);
            m.name("b", block.held_in(m, Radix::Binary, "binary", 8));
            m.name("d", block.held_in(m, Radix::Decimal, "decimal", 8));
        },
        |bench| {
            let reading = |name| bench.design().netlist().find(name).unwrap().format.reading();
            for name in ["binary", "binary_in"] {
                assert_eq!(reading(name), Reading::Unsigned);
            }
            for name in ["decimal", "decimal_in"] {
                assert_eq!(reading(name), Reading::Decimal);
            }
            bench.clock(&[("load", 1), ("binary_in", 0x42), ("decimal_in", 0x42)]);
            bench.clock(&[("load", 0), ("binary_in", 0), ("decimal_in", 0)]);
            bench.clock(&[]);
            assert_eq!((bench.value("b"), bench.value("d")), (0x42, 0x42));
        },
    );
}
