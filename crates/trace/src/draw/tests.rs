use std::fmt::Write;

use super::*;

/// A clock of 2 units; a bit, a counter with a sign, a state, an unknown bus, a text.
const VCD: &str = "$timescale 1 ns $end\n$scope module tb $end $scope module dut $end\n$var wire 1 ! clk $end\n\
    $var reg 1 a run $end\n$var integer 6 b f $end\n$var reg 4 c beat $end\n$var reg 8 d bus $end\n$upscope $end $upscope $end\n\
    $enddefinitions $end\n#0\n0!\n0a\nb0 b\nb0 c\nbx d\n#1\n1!\n1a\nb1 c\n#2\n0!\n#3\n1!\nb111101 b\nb10 c\nb1111 d\n#4\n0!\n#5\n1!\n0a\n\
    b101 b\n#6\n0!\n#7\n1!\nb100 c\n#8\n0!\n";

fn wave() -> Wave {
    Wave::from_bytes(VCD.as_bytes().to_vec()).unwrap()
}

fn drawn(drawing: &Drawing) -> String {
    let wave = wave();
    let signals: Vec<usize> =
        (0..wave.signals().len()).filter(|&index| wave.signals()[index].leaf() != "clk").collect();
    drawing.text(&wave, &signals).unwrap()
}

/// Sample k is after the k-th rising edge, sample 0 before the first; drawn by hand from the changes of [`VCD`].
#[test]
fn levels_numbers_and_what_is_unknown_have_a_cell_for_each_clock() {
    let text = drawn(&Drawing { ascii: true, ..Drawing::default() });
    let wanted = [
        "     0",
        r"run  ___/-----\_____",
        "f    |0    |-3|5",
        "beat |0 |1 |2    |4",
        "bus  |x    |15",
        "clock 0 to 4",
    ];
    assert_eq!(text.lines().collect::<Vec<_>>(), wanted);
    let text = drawn(&Drawing { from: 2, ..Drawing::default() });
    let wanted = ["     2", "run  ▔▔▔╲▁▁▁▁▁", "f    │-3│5", "beat │2    │4", "bus  │15", "clock 2 to 4"];
    assert_eq!(text.lines().collect::<Vec<_>>(), wanted);
}

#[test]
fn states_have_names_and_vectors_a_radix() {
    let names = BTreeMap::from([("beat".to_owned(), BTreeMap::from([("0010".to_owned(), "FEED".to_owned())]))]);
    let of = |radix| {
        let text = drawn(&Drawing { ascii: true, radix, names: names.clone(), ..Drawing::default() });
        text.lines()
            .skip(2)
            .take(3)
            .map(|line| line.split('|').skip(1).map(str::trim).map(str::to_owned).collect())
            .collect()
    };
    let cells = |rows: [&[&str]; 3]| -> Vec<Vec<String>> {
        rows.iter().map(|row| row.iter().map(|cell| (*cell).to_owned()).collect()).collect()
    };
    let declared: Vec<Vec<String>> = of(Radix::Declared);
    assert_eq!(declared, cells([&["0", "-3", "5"], &["0", "1", "FEED", "4"], &["x", "15"]]));
    assert_eq!(of(Radix::Hex), cells([&["00", "3d", "05"], &["0", "1", "FEED", "4"], &["x", "0f"]]));
    assert_eq!(of(Radix::Unsigned), cells([&["0", "61", "5"], &["0", "1", "FEED", "4"], &["x", "15"]]));
    let binary = [&["000000", "111101", "000101"][..], &["0000", "0001", "FEED", "0100"], &["x", "00001111"]];
    assert_eq!(of(Radix::Binary), cells(binary));
}

#[test]
fn times_of_changes_are_cells_and_a_long_window_has_several_lines() {
    let (wave, columns) = (wave(), LEAST_COLUMNS);
    let text = Drawing { ascii: true, by_time: true, to: Some(5), ..Drawing::default() }.text(&wave, &[0]).unwrap();
    assert_eq!(text, "    0         5\nclk __/-\\_/-\\_/-\ntime 0 to 5, in units of 1 ns\n");
    // 200 clocks in lines of 40 characters: the name, a blank, and 19 cells of 2.
    let mut vcd = "$var wire 1 ! clk $end $var wire 1 a b $end $enddefinitions $end\n#0\n0!\n1a\n".to_owned();
    for time in 1..400 {
        let _ = writeln!(vcd, "#{time}\n{}!\n{}a", time % 2, u8::from(time / 4 % 2 == 0));
    }
    let wave = Wave::from_bytes(vcd.into_bytes()).unwrap();
    let drawing = Drawing { columns, ascii: true, to: Some(199), ..Drawing::default() };
    let text = drawing.text(&wave, &[1]).unwrap();
    assert!(text.lines().all(|line| line.len() <= columns), "{text}");
    let levels: String = text.lines().filter_map(|line| line.strip_prefix("b ")).collect();
    assert_eq!((levels.len(), text.lines().last()), (2 * 200, Some("clock 0 to 199")));
    // Its value at clock k is that of time 2k, and an edge is drawn where it changes, also at the start of a line.
    let value = |clock: usize| (clock * 2 / 4).is_multiple_of(2);
    for clock in 0..200 {
        let (now, edge) = (value(clock), clock > 0 && value(clock - 1) != value(clock));
        let wanted = match (now, edge) {
            (true, false) => "--",
            (true, true) => "/-",
            (false, false) => "__",
            (false, true) => "\\_",
        };
        assert_eq!(&levels[2 * clock..2 * clock + 2], wanted, "clock {clock}: {text}");
    }
    let open = Drawing { to: None, ..drawing }.text(&wave, &[1]).unwrap();
    assert_eq!(open.lines().last(), Some("clock 0 to 18; 182 more: --from 19 shows the next"));
    assert_eq!(open.lines().count(), 3);
}

#[test]
fn a_window_after_the_end_is_refused_and_colours_are_only_added() {
    let wave = wave();
    let refused = Drawing { from: 5, ..Drawing::default() }.text(&wave, &[1]).unwrap_err();
    assert_eq!(refused, "nothing is left from clock 5 on: the wave ends at clock 4");
    let plain = drawn(&Drawing::default());
    let coloured = drawn(&Drawing { colour: true, ..Drawing::default() });
    let mut bare = coloured.clone();
    for code in ["\x1b[2m", "\x1b[31m", "\x1b[32m", "\x1b[0m"] {
        assert!(coloured.contains(code));
        bare = bare.replace(code, "");
    }
    let trimmed = |text: &str| text.lines().map(|line| line.trim_end().to_owned()).collect::<Vec<_>>();
    assert_eq!(trimmed(&bare), trimmed(&plain));
}
