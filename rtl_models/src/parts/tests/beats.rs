//! The four-beat ring and its one-beat form.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::Scope;

use super::super::{BeatRing, Block};
use super::bench::{Bench, on_every_engine};
use crate::options::Beats;

/// A ring with its block; what is decided is the input `choice`.
fn ring(m: Scope<'_>, beats: Beats) {
    let block = Block::new(m);
    let beat = BeatRing::new(m, beats, block.busy);
    for (name, net) in
        [("judge", beat.judge), ("feed", beat.feed), ("compute", beat.compute), ("compare", beat.compare)]
    {
        m.name(name, net);
    }
    let _ = beat.decided("decided", m.input("choice", 1));
    let last = m.input("last", 1);
    beat.close(block, last);
}

/// Beats that are 1 in each sample.
fn beats_at_once(bench: &Bench) -> Vec<i128> {
    let beats = ["judge", "feed", "compute", "compare"].map(|name| bench.numbers(name));
    (0..beats[0].len()).map(|sample| beats.iter().map(|beat| beat[sample]).sum()).collect()
}

#[test]
fn four_beats_follow_each_other_until_the_last_compare_and_then_rest() {
    on_every_engine(
        |m| ring(m, Beats::Four),
        |bench| {
            bench.play(&[
                ("load", "0100_0000_0000_00"),
                // Outside the compare beat it ends nothing.
                ("last", "0001_1000_0100_00"),
                ("choice", "0000_0000_0000_00"),
            ]);
            assert_eq!(bench.row("beat"), "0012_4812_4800_00");
            assert_eq!(bench.row("judge"), "0010_0010_0000_00");
            assert_eq!(bench.row("feed"), "0001_0001_0000_00");
            assert_eq!(bench.row("compute"), "0000_1000_1000_00");
            assert_eq!(bench.row("compare"), "0000_0100_0100_00");
            assert_eq!(bench.row("busy"), "0011_1111_1100_00");
            assert_eq!(beats_at_once(bench), bench.numbers("busy"));
        },
    );
}

#[test]
fn a_load_in_any_beat_begins_anew_with_the_judge_beat() {
    on_every_engine(
        |m| ring(m, Beats::Four),
        |bench| {
            for (load, beat) in [
                ("0110_0000", "0011_2481"),
                ("0101_0000", "0012_1248"),
                ("0100_1000", "0012_4124"),
                ("0100_0100", "0012_4812"),
            ] {
                bench.play(&[("load", load), ("last", "0000_0100"), ("choice", "0000_0000")]);
                assert_eq!(bench.row("beat"), beat, "loaded at {load}");
                assert_eq!(beats_at_once(bench), bench.numbers("busy"), "loaded at {load}");
            }
        },
    );
}

#[test]
fn what_the_judge_beat_decided_is_held_until_it_judges_again() {
    on_every_engine(
        |m| ring(m, Beats::Four),
        |bench| {
            bench.play(&[("load", "0100_0000_0000"), ("last", "0000_0000_0000"), ("choice", "1110_0001_1001")]);
            assert_eq!(bench.row("judge"), "0010_0010_0010");
            assert_eq!(bench.row("decided"), "0001_1110_0000");
        },
    );
}

#[test]
fn the_beats_bear_their_names_in_the_wave() {
    on_every_engine(
        |m| ring(m, Beats::Four),
        |bench| {
            let Format::States(states) = &bench.design().netlist().find("beat").unwrap().format else { panic!() };
            let states: Vec<String> = states.iter().map(|(value, name)| format!("{value} {name}")).collect();
            assert_eq!(states, ["0 IDLE", "1 JUDGE", "2 FEED", "4 COMPUTE", "8 COMPARE"]);
        },
    );
}

#[test]
fn in_the_one_beat_form_all_four_are_every_busy_clock_and_the_choice_is_a_net() {
    on_every_engine(
        |m| ring(m, Beats::One),
        |bench| {
            bench.play(&[("load", "0100_0000"), ("last", "1100_0100"), ("choice", "0101_0101")]);
            for name in ["judge", "feed", "compute", "compare", "busy"] {
                assert_eq!(bench.row(name), "0011_1100", "{name}");
            }
            assert_eq!(bench.row("done"), "0000_0011");
            assert_eq!(bench.row("decided"), bench.row("choice"));
            assert!(bench.design().netlist().find("beat").is_none());
        },
    );
}
