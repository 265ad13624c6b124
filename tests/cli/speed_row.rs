//! `run --trace-speed`: the speed over v_max as a row of the wave, next to the step table.

use std::collections::BTreeMap;

use super::{Folder, refused};

/// Values of a signal of a VCD by the clock from which on they are.
fn changes(text: &str, name: &str) -> BTreeMap<u64, u64> {
    let id = |name: &str| {
        let mut vars = text.lines().filter(|line| line.starts_with("$var"));
        vars.find_map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            (words[4] == name).then(|| words[3].to_owned())
        })
    };
    let (clk, own) = (id("clk").unwrap(), id(name).unwrap());
    let (mut edges, mut found) = (0, BTreeMap::new());
    for line in text.lines() {
        if *line == format!("1{clk}") {
            edges += 1;
        }
        if let Some((value, _)) =
            line.strip_prefix('b').and_then(|line| line.split_once(' ')).filter(|(_, id)| *id == own)
        {
            found.insert(edges, u64::from_str_radix(value, 2).unwrap());
        }
    }
    found
}

/// The speed after each step by its definition, from the step table: over the last 32 steps, in 10^-4 of v_max.
fn expected(table: &str, step_clocks: f64, axes: usize) -> BTreeMap<u64, u64> {
    let rows: Vec<Vec<i64>> =
        table.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let mut speeds = BTreeMap::from([(0, 0)]);
    let mut last = 0;
    for pair in rows.windows(33) {
        let ([from, .., to], places) = (pair, |row: &Vec<i64>| row[row.len() - axes..].to_vec()) else { continue };
        let square: i64 = places(to).iter().zip(places(from)).map(|(to, from)| (to - from).pow(2)).sum();
        let speed = 1e4 * step_clocks * (square as f64).sqrt() / (to[1] - from[1]) as f64;
        let speed = format!("{speed:.0}").parse().unwrap();
        if speed != last {
            speeds.insert(to[1].cast_unsigned(), speed);
            last = speed;
        }
    }
    speeds
}

#[test]
fn the_row_is_the_speed_over_32_steps_of_the_step_table() {
    for (words, step_clocks, axes) in [
        ("ppc-line --to 100,62 --beats 1", 1.0, 2),
        ("dda-line --to 100,-62,9", 1.0, 3),
        ("cim-arc --from -40,0 --to 0,40 --cw", 4.0, 2),
        ("ppc-arc --from 60,80 --to -80,60 --ccw", 4.0, 2),
    ] {
        let folder = Folder::new();
        folder.good(&format!("run {words} --vcd w.vcd --fst w.fst --steps s.csv --trace-speed"));
        let text = folder.read("w.vcd");
        let (seen, wanted) = (changes(&text, "speed_e4"), expected(&folder.read("s.csv"), step_clocks, axes));
        assert!(wanted.len() > 3, "{words}: {wanted:?}");
        assert_eq!(seen, wanted, "{words}");
        assert!(folder.good("diff w.vcd w.fst").starts_with("same"), "{words}");
        // All else is as without it.
        folder.good(&format!("run {words} --vcd plain.vcd"));
        assert!(!folder.read("plain.vcd").contains("speed_e4"));
        assert!(folder.good("diff w.vcd plain.vcd --ignore *.speed_e4").starts_with("same"), "{words}");
        let save = folder.read("w.gtkw");
        assert!(save.contains("testbench") && save.contains(".testbench.speed_e4[15:0]"), "{save}");
        assert!(text.contains("testbench.speed_e4 is of the test bench: v/v_max over 32 steps in 10^-4"), "{words}");
    }
}

#[test]
fn a_window_and_steps_alone_have_the_same_speeds() {
    let folder = Folder::new();
    let line = "run ppc-line --to 100,62 --trace-speed";
    folder.good(&format!("{line} --vcd w.vcd"));
    folder.good(&format!("{line} --vcd late.vcd --trace-from 300 --trace-to 350"));
    folder.good(&format!("{line} --vcd steps.vcd --trace-steps"));
    let all = changes(&folder.read("w.vcd"), "speed_e4");
    let at = |values: &BTreeMap<u64, u64>, clock: u64| values.range(..=clock).next_back().map(|(_, value)| *value);
    let late = changes(&folder.read("late.vcd"), "speed_e4");
    assert_eq!(late.first_key_value().map(|(_, value)| *value), at(&all, 300));
    assert_eq!(late.values().last().copied(), at(&all, 350));
    let values = |changes: &BTreeMap<u64, u64>| changes.values().copied().collect::<Vec<_>>();
    assert_eq!(values(&changes(&folder.read("steps.vcd"), "speed_e4")), values(&all));
}

#[test]
fn where_it_would_be_another_row_or_none_it_is_refused() {
    refused("run ppc-line --to 9,6 --trace-speed", &["--vcd"]);
    refused(
        "run ppc-line --to 9,6 --trace-speed --vcd w.vcd --checkpoints c.json",
        &["--trace-speed", "--checkpoints"],
    );
}
