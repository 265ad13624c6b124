//! What the passes put in the place of a cell is worth the same, for every value: each operator on constants, on the
//! same net twice and on complements, and every pattern of two cells that has a simpler form. Lanes, which put still
//! other operations in their place, come to the same.

use std::collections::HashMap;

use stepwave_engine::EngineKind;
use stepwave_engine::lanes::{Job, LaneProgram, LaneWatch, Observe};
use stepwave_netlist::passes::simplify;
use stepwave_netlist::{Design, elaborate, text};

use super::{Probe, design_of_text, net, values};

/// The named nets are worth the same before and after, for all values of the inputs `a` (`bits` wide) and `s` (1 bit).
fn assert_same(bits: u32, lines: &[String]) {
    let mut netlist = format!("netlist m\n%0:{bits} = input\n%1:1 = input\n");
    let named = lines.len() + 1;
    for (index, line) in lines.iter().enumerate() {
        let (width, op) = line.split_once(' ').unwrap();
        netlist.push_str(&format!("%{}:{width} = {op}\n", index + 2));
    }
    netlist.push_str(&format!("%{}:1 = const 0x1\nname %{} in 0 \"done\" unsigned\n", named + 1, named + 1));
    for (net, name) in [(0, "a"), (1, "s"), (named, "r")] {
        netlist.push_str(&format!("name %{net} in 0 \"{name}\" unsigned\n"));
    }
    let before = design_of_text(&netlist);
    let after = elaborate(simplify(before.netlist(), &HashMap::new()).netlist).unwrap();
    let lanes = in_lanes(bits, &before);
    let [mut want, mut got] = [&before, &after].map(|design| Probe::new(design, EngineKind::Gates));
    for a in values(bits) {
        for s in [0, 1] {
            for (probe, design) in [(&mut want, &before), (&mut got, &after)] {
                probe.clock(&[(net(design, "a"), a), (net(design, "s"), s)]);
            }
            let [want, got] = [(&want, &before), (&got, &after)].map(|(probe, design)| probe.value(net(design, "r")));
            assert_eq!(want, got, "a = {a}, s = {s}\n{netlist}became\n{}", text::print(after.netlist()));
            let lane = &lanes[usize::try_from(2 * a + s).unwrap()];
            assert_eq!(lane, &[want, want], "a = {a}, s = {s} in lanes\n{netlist}");
        }
    }
}

/// The last and the greatest value of `r` for all values of the inputs.
fn in_lanes(bits: u32, design: &Design) -> Vec<Vec<u64>> {
    let [a, s, r, done] = ["a", "s", "r", "done"].map(|name| net(design, name));
    let observe = vec![Observe::Last(r), Observe::Max { net: r, signed: false }];
    let program = LaneProgram::new(design, &LaneWatch { observe, ..LaneWatch::new(done) });
    let blocks = values(bits).flat_map(|value| [0, 1].map(|select| vec![(a, value), (s, select)]));
    let ends = program.run_all(blocks.map(|block| Job { blocks: vec![block] }).collect());
    ends.into_iter().map(|end| end.values).collect()
}

fn lines<const N: usize>(lines: [String; N]) -> [String; N] {
    lines
}

/// Operators on two equally wide operands, and whether they say yes or no.
const BINARY: [(&str, bool); 11] = [
    ("and", false),
    ("or", false),
    ("xor", false),
    ("add", false),
    ("sub", false),
    ("carry", true),
    ("borrow", true),
    ("add-overflow", true),
    ("sub-overflow", true),
    ("equal", true),
    ("less-signed", true),
];

#[test]
fn operators_on_constants_equal_nets_and_complements() {
    for bits in 1..=3 {
        for (op, flag) in BINARY {
            let width = if flag { 1 } else { bits };
            for constant in values(bits) {
                for operands in ["%0 %2", "%2 %0", "%2 %2"] {
                    assert_same(
                        bits,
                        &lines([format!("{bits} const {constant:#x}"), format!("{width} {op} {operands}")]),
                    );
                }
            }
            for operands in ["%0 %0", "%0 %2", "%2 %0"] {
                assert_same(bits, &lines([format!("{bits} not %0"), format!("{width} {op} {operands}")]));
            }
        }
        assert_same(bits, &lines([format!("{bits} not %0"), format!("{bits} not %2")]));
    }
}

#[test]
fn multiplexers_of_constants_of_each_other_and_of_counts() {
    for bits in 1..=3 {
        for [x, y] in values(bits).flat_map(|x| values(bits).map(move |y| [x, y])) {
            let constants =
                lines([format!("{bits} const {x:#x}"), format!("{bits} const {y:#x}"), "1 not %1".to_owned()]);
            for operands in ["%1 %2 %3", "%1 %0 %2", "%1 %2 %0", "%4 %2 %3", "%4 %0 %2", "%4 %2 %0", "%1 %0 %0"] {
                let mux = format!("{bits} mux {operands}");
                assert_same(bits, &[&constants[..], &[mux]].concat());
            }
            // One after another, with the same select or its complement, on either side.
            for (inner, outer) in [("%1", "%1"), ("%4", "%1"), ("%1", "%4"), ("%4", "%4")] {
                for (first, second) in [("%2 %0", "%5 %3"), ("%2 %0", "%3 %5"), ("%0 %2", "%5 %3"), ("%0 %2", "%3 %5")]
                {
                    let muxes = [format!("{bits} mux {inner} {first}"), format!("{bits} mux {outer} {second}")];
                    assert_same(bits, &[&constants[..], &muxes].concat());
                }
            }
        }
        // Counting by any number under a condition, up or down, on either side.
        for constant in values(bits) {
            for op in ["add %0 %2", "add %2 %0", "sub %0 %2", "sub %2 %0"] {
                for mux in ["mux %1 %3 %0", "mux %1 %0 %3"] {
                    let cells =
                        [format!("{bits} const {constant:#x}"), format!("{bits} {op}"), format!("{bits} {mux}")];
                    assert_same(bits, &cells);
                }
            }
        }
    }
    // A select that is constant.
    for select in [0, 1] {
        assert_same(3, &lines([format!("1 const {select:#x}"), "3 not %0".to_owned(), "3 mux %2 %0 %3".to_owned()]));
    }
}

#[test]
fn cuts_and_extensions_of_each_other() {
    let bits = 3;
    // Wide nets of one more cell, and what is cut out of them.
    for (width, wide) in [
        (3, "slice %0 0"),
        (2, "slice %0 1"),
        (4, "concat %1 %0"),
        (4, "concat %0 %1"),
        (6, "concat %0 %0"),
        (5, "zero-extend %0"),
        (5, "sign-extend %0"),
        (3, "zero-extend %0"),
        (3, "sign-extend %0"),
        (4, "zero-extend %1"),
        (4, "sign-extend %1"),
    ] {
        for low in 0..width {
            for cut in 1..=width - low {
                assert_same(bits, &lines([format!("{width} {wide}"), format!("{cut} slice %2 {low}")]));
            }
        }
        for extended in width..=8 {
            for op in ["zero-extend", "sign-extend"] {
                assert_same(bits, &lines([format!("{width} {wide}"), format!("{extended} {op} %2")]));
                // Next to one of another width, which must not be taken for it.
                let (first, second) = (format!("{} {op} %2", extended + 1), format!("{extended} {op} %2"));
                let both = format!("{} concat %3 %4", 2 * extended + 1);
                assert_same(bits, &lines([format!("{width} {wide}"), first, second, both]));
            }
        }
    }
    for constant in values(2) {
        for (width, op) in [(5, "concat %2 %0"), (5, "concat %0 %2"), (3, "concat %2 %1"), (4, "concat %2 %2")] {
            assert_same(bits, &lines([format!("2 const {constant:#x}"), format!("{width} {op}")]));
        }
        for (width, op) in
            [(4, "zero-extend %2"), (4, "sign-extend %2"), (1, "slice %2 0"), (1, "slice %2 1"), (2, "not %2")]
        {
            assert_same(bits, &lines([format!("2 const {constant:#x}"), format!("{width} {op}")]));
        }
    }
}

#[test]
fn sums_under_conditions_that_may_both_hold() {
    let bits = 3;
    for [x, y] in values(bits).flat_map(|x| values(bits).map(move |y| [x, y])) {
        for [first, second] in [["add", "add"], ["add", "sub"], ["sub", "add"], ["sub", "sub"]] {
            let cells = [
                format!("{bits} const {x:#x}"),
                format!("{bits} const {y:#x}"),
                "1 slice %0 1".to_owned(),
                format!("{bits} {first} %0 %2"),
                format!("{bits} {second} %0 %3"),
                format!("{bits} mux %4 %5 %0"),
                format!("{bits} mux %1 %6 %7"),
            ];
            assert_same(bits, &cells);
        }
    }
}

#[test]
fn sums_that_are_cut_and_numbers_that_still_fit_when_they_are() {
    let bits = 3;
    for extend in ["zero-extend", "sign-extend"] {
        for (wide, cut) in (4..=6).flat_map(|wide| (1..=wide).map(move |cut| (wide, cut))) {
            for op in ["add %3 %4", "add %4 %3", "sub %3 %4", "sub %4 %3"] {
                let short = "2 slice %0 1".to_owned();
                let operands = [short, format!("{wide} {extend} %0"), format!("{wide} zero-extend %2")];
                let result = [format!("{wide} {op}"), format!("{cut} slice %5 0")];
                assert_same(bits, &[&operands[..], &result].concat());
            }
        }
        for cut in 1..bits {
            let fits = [format!("{cut} slice %0 0"), format!("{bits} {extend} %2"), "1 equal %3 %0".to_owned()];
            assert_same(bits, &fits);
            let unfit = ["1 not %4".to_owned(), "1 and %1 %5".to_owned(), "1 slice %0 1".to_owned()];
            assert_same(bits, &[&fits[..], &unfit, &["1 or %6 %7".to_owned()]].concat());
        }
    }
}

#[test]
fn concatenations_of_parts_that_meet_are_repeated_or_are_selected_together() {
    for bits in 1..=4u32 {
        let parts = || (0..bits).flat_map(|low| (1..=bits - low).map(move |width| (width, low)));
        for ((w, high), (v, low)) in parts().flat_map(|high| parts().map(move |low| (high, low))) {
            let two = lines([format!("{w} slice %0 {high}"), format!("{v} slice %0 {low}")]);
            assert_same(bits, &[&two[..], &[format!("{} concat %2 %3", w + v)]].concat());
            // With the whole word, and a further part, below.
            let whole = [format!("{} concat %2 %0", w + bits), format!("{} concat %3 %4", v + w + bits)];
            assert_same(bits, &[&two[..], &whole].concat());
            let three = [format!("{} concat %3 %2", v + w), format!("{} concat %2 %4", w + v + w)];
            assert_same(bits, &[&two[..], &three].concat());
            if w == 1 {
                let signs = [
                    "3 sign-extend %2".to_owned(),
                    format!("{} concat %4 %3", 3 + v),
                    format!("{} concat %2 %5", 4 + v),
                    format!("{} concat %3 %4", 3 + v),
                    format!("{} concat %6 %7", 7 + 2 * v),
                ];
                assert_same(bits, &[&two[..], &signs].concat());
            }
            for select in ["%2 %4", "%4 %2"] {
                let chosen = [
                    format!("{w} const 0x1"),
                    format!("{v} const 0x0"),
                    format!("{w} mux %1 {select}"),
                    format!("{v} mux %1 {}", select.replace('2', "3").replace('4', "5")),
                    format!("{} concat %6 %7", w + v),
                    format!("{} concat %7 %8", w + v + v),
                ];
                assert_same(bits, &[&two[..], &chosen].concat());
            }
        }
    }
}

#[test]
fn comparisons_with_constants_through_other_cells() {
    let bits = 3;
    for constant in values(bits) {
        for other in values(bits) {
            let known = [format!("{bits} const {constant:#x}"), format!("{bits} const {other:#x}")];
            let through = |width: u32, op: &str| {
                for value in values(width) {
                    let cells = [format!("{width} {op}"), format!("{width} const {value:#x}")];
                    for equal in ["1 equal %4 %5", "1 equal %5 %4"] {
                        assert_same(bits, &[&known[..], &cells, &[equal.to_owned()]].concat());
                    }
                }
            };
            through(3, "xor %0 %2");
            through(3, "xor %2 %0");
            through(3, "mux %1 %2 %3");
            through(3, "mux %1 %0 %2");
            through(6, "concat %2 %0");
            through(6, "concat %0 %2");
            if other == 0 {
                through(3, "and %0 %2");
                through(5, "sign-extend %0");
                through(5, "zero-extend %0");
                through(3, "not %0");
                through(4, "concat %1 %0");
                through(4, "concat %0 %1");
            }
        }
    }
    // Bit by bit, of all zeros, all ones and all that is between.
    for value in values(5) {
        let cells = lines([
            "1 slice %0 2".to_owned(),
            "1 slice %0 1".to_owned(),
            "2 concat %1 %2".to_owned(),
            "3 concat %3 %4".to_owned(),
            "1 not %3".to_owned(),
            "4 concat %6 %5".to_owned(),
            "5 concat %2 %7".to_owned(),
            format!("5 const {value:#x}"),
            "1 equal %8 %9".to_owned(),
        ]);
        assert_same(bits, &cells);
        assert_same(bits, &[&cells[..], &["1 not %10".to_owned()]].concat());
    }
}

#[test]
fn bits_that_are_cleared_twice_or_by_a_shift_there_and_back() {
    for bits in 2..=4u32 {
        for (one, other) in values(bits).flat_map(|one| values(bits).map(move |other| (one, other))) {
            let masks = [format!("{bits} const {one:#x}"), format!("{bits} const {other:#x}")];
            for (first, second) in [("%0 %2", "%4 %3"), ("%2 %0", "%3 %4"), ("%2 %0", "%4 %3")] {
                let and = [format!("{bits} and {first}"), format!("{bits} and {second}")];
                assert_same(bits, &[&masks[..], &and].concat());
            }
            for (low, cut) in (0..bits).flat_map(|low| (1..=bits - low).map(move |cut| (low, cut))) {
                let part = [format!("{bits} and %0 %2"), format!("{cut} slice %4 {low}")];
                assert_same(bits, &[&masks[..], &part].concat());
            }
        }
        for (low, cut) in (0..bits).flat_map(|low| (1..=bits - low).map(move |cut| (low, cut))) {
            for zeros in 1..=4 {
                let back = [
                    format!("{cut} slice %0 {low}"),
                    format!("{zeros} const 0x0"),
                    format!("{} concat %2 %3", cut + zeros),
                ];
                assert_same(bits, &back);
                assert_same(bits, &[&back[..], &[format!("{} concat %4 %0", cut + zeros + bits)]].concat());
            }
        }
    }
}

#[test]
fn sums_and_flags_whose_operand_is_chosen_by_the_bit_around_them() {
    let bits = 3;
    for (op, flag) in BINARY {
        let width = if flag { 1 } else { bits };
        for chosen in ["mux %1 %0 %2", "mux %1 %2 %0", "mux %4 %0 %2", "mux %4 %2 %0"] {
            for operands in ["%0 %5", "%5 %0", "%5 %5"] {
                let cells = [
                    format!("{bits} const 0x5"),
                    "2 slice %0 1".to_owned(),
                    "1 not %1".to_owned(),
                    format!("{bits} {chosen}"),
                    format!("{width} {op} {operands}"),
                ];
                for around in ["mux %1 %6 %7", "mux %1 %7 %6", "mux %4 %6 %7", "and %6 %7"] {
                    let other = format!("{width} slice %0 0");
                    assert_same(bits, &[&cells[..], &[other, format!("{width} {around}")]].concat());
                }
                for bit in ["and %1 %7", "and %7 %4"] {
                    let low = format!("1 slice %6 {}", width - 1);
                    assert_same(bits, &[&cells[..], &[low, format!("1 {bit}")]].concat());
                }
            }
        }
        // A choice in fewer bits, extended.
        for extend in ["zero-extend %5", "sign-extend %5"] {
            for operands in ["%0 %6", "%6 %0"] {
                let cells = [
                    "2 const 0x2".to_owned(),
                    "2 slice %0 1".to_owned(),
                    "1 not %1".to_owned(),
                    "2 mux %1 %2 %3".to_owned(),
                    format!("{bits} {extend}"),
                    format!("{width} {op} {operands}"),
                    format!("1 slice %7 {}", width - 1),
                ];
                for around in ["1 and %1 %8", "1 and %8 %4", "1 mux %1 %8 %4", "1 mux %1 %4 %8"] {
                    assert_same(bits, &[&cells[..], &[around.to_owned()]].concat());
                }
                let whole = [format!("{width} mux %1 %7 %9"), format!("{width} mux %4 %9 %7")];
                for around in whole {
                    assert_same(bits, &[&cells[..], &[format!("{width} slice %0 0"), around]].concat());
                }
            }
        }
    }
}
