//! Native code with branches, where selects that differ come to the same in a branch around them.

use std::fmt::Write;

use stepwave_engine::{Engine, EngineKind, Rows, Watch, branching_after};
use stepwave_netlist::cells::Net;
use stepwave_netlist::{elaborate, text};

/// A netlist in its text form.
#[derive(Default)]
struct Lines {
    text: String,
    count: u32,
}

impl Lines {
    fn add(&mut self, width: u32, op: &str) -> u32 {
        writeln!(self.text, "%{}:{width} = {op}", self.count).unwrap();
        self.count += 1;
        self.count - 1
    }

    /// Work enough for a branch.
    fn work(&mut self, from: u32, seed: u32) -> u32 {
        (0..9).fold(from, |value, place| {
            let constant = self.add(16, &format!("const 0x{:x}", (seed * 7919 + place * 4729) & 0xffff | 1));
            self.add(16, &format!("{} %{value} %{constant}", if place % 2 == 0 { "xor" } else { "mul" }))
        })
    }
}

/// A counter, and a register that where bit `c` of it decides takes the sum of two choices; their selects are written in
/// terms of the bits `c`, `t`, `u`. Gives the text and the nets of the two registers.
fn choices(first: &str, second: &str, where_high: bool) -> (String, [Net; 2]) {
    let mut lines = Lines::default();
    let counter = lines.add(16, "register reset 0x0 next %2");
    lines.add(16, "const 0x1");
    lines.add(16, "add %0 %1");
    let [c, t, u] = [3, 1, 4].map(|bit| lines.add(1, &format!("slice %0 {bit}")));
    let select = |lines: &mut Lines, op: &str| {
        let op = op.replace('c', &format!("%{c}")).replace('t', &format!("%{t}")).replace('u', &format!("%{u}"));
        match op.split(' ').collect::<Vec<_>>()[..] {
            [one] => one[1..].parse().unwrap(),
            _ => lines.add(1, &op.replace("AND", "and").replace("OR", "or").replace("MX", "mux")),
        }
    };
    let (first, second) = (select(&mut lines, first), select(&mut lines, second));
    let arms: Vec<u32> = (1..=5).map(|seed| lines.work(counter, seed)).collect();
    let one = lines.add(16, &format!("mux %{first} %{} %{}", arms[0], arms[1]));
    let other = lines.add(16, &format!("mux %{second} %{} %{}", arms[2], arms[3]));
    let sum = lines.add(16, &format!("add %{one} %{other}"));
    let [high, low] = if where_high { [sum, arms[4]] } else { [arms[4], sum] };
    let next = lines.add(16, &format!("mux %{c} %{high} %{low}"));
    let register = lines.add(16, &format!("register reset 0x0 next %{next}"));
    (format!("netlist choices\n{}", lines.text), [Net(counter), Net(register)])
}

fn samples(engine: &mut dyn Engine, columns: usize) -> Vec<Vec<u64>> {
    let mut rows = Rows::new(columns, 300);
    engine.run(299, &mut rows);
    (0..columns).map(|column| rows.column(column).to_vec()).collect()
}

#[test]
fn selects_that_come_to_the_same_in_a_branch_keep_their_own_arms() {
    let cases = [
        ("AND c t", "t", true),
        ("OR c t", "t", false),
        ("MX c t u", "t", true),
        ("AND c t", "MX c t u", true),
        ("OR c t", "OR c u", true),
        ("AND c t", "AND c u", false),
        ("AND u t", "t", true),
    ];
    for (first, second, where_high) in cases {
        let (netlist, nets) = choices(first, second, where_high);
        let design = elaborate(text::parse(&netlist).unwrap()).unwrap();
        let watch = Watch { columns: nets.to_vec(), stops: Vec::new() };
        let expected = samples(&mut *EngineKind::Gates.build(&design, &watch), 2);
        assert!(expected[1].iter().any(|&value| value != 0));
        for worth in [0, 1, 8] {
            let branching = samples(&mut *branching_after(&design, &watch, 2, worth), 2);
            assert_eq!(branching, expected, "{first}, {second}, worth {worth}");
        }
    }
}

/// A ring of registers, each the sum of the one before and one far off, every fifth of them chosen between two such sums
/// with work in them, where a bit of a counter decides; every ninth stays as it is for 128 clocks.
fn ring(count: u32) -> (String, Vec<Net>) {
    let mut lines = Lines::default();
    // Four cells of the counter come first; then the registers, whose next values come after all of them.
    let first = 5;
    let nexts = |place: u32| first + count + 3 * place;
    lines.add(16, "register reset 0x1 next %2");
    lines.add(16, "const 0x1");
    lines.add(16, "add %0 %1");
    lines.add(1, "slice %0 4");
    lines.add(1, "slice %0 7");
    // The work of every fifth comes after the three cells of each.
    let mut work_at = nexts(count);
    let mut work = Vec::new();
    for place in 0..count {
        let next = match place {
            _ if place % 5 == 0 => {
                work.push(place);
                work_at += 2 * 18 + 1;
                work_at - 1
            }
            _ if place % 9 == 0 => nexts(place) + 1,
            _ => nexts(place),
        };
        lines.add(16, &format!("register reset 0x{:x} next %{next}", (place * 977) & 0xffff | 1));
    }
    for place in 0..count {
        let [before, far] = [count - 1, 37].map(|step| first + (place + step) % count);
        let sum = lines.add(16, &format!("add %{before} %{far}"));
        let held = lines.add(16, &format!("mux %4 %{sum} %{}", first + place));
        lines.add(16, &format!("xor %{held} %{before}"));
    }
    for place in work {
        let [one, other] = [0, 2].map(|cell| lines.work(nexts(place) + cell, place + cell + 1));
        lines.add(16, &format!("mux %3 %{one} %{other}"));
    }
    (format!("netlist ring\n{}", lines.text), (first..first + count).map(Net).collect())
}

#[test]
fn registers_that_are_far_apart_are_found_again() {
    for count in [7, 18, 50, 200] {
        let (netlist, nets) = ring(count);
        let design = elaborate(text::parse(&netlist).unwrap()).unwrap();
        let watch = Watch { columns: nets, stops: Vec::new() };
        let columns = watch.columns.len();
        let expected = samples(&mut *EngineKind::Gates.build(&design, &watch), columns);
        assert!(expected.iter().all(|column| column.iter().any(|value| *value != column[0])));
        // Code made in one pass runs to the end, or for few clocks.
        for (warm_up, worth) in [(300, 0), (300, 8), (300, 1000), (2, 8), (100, 8)] {
            let branching = samples(&mut *branching_after(&design, &watch, warm_up, worth), columns);
            assert!(branching == expected, "{count} registers, warm-up {warm_up}, worth {worth}");
        }
    }
}
