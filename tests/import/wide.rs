//! Words of more than 64 bits: one signal everywhere.

use serde_json::json;
use stepwave::export::{self, Checking, Options, Stimulus};
use stepwave::trace::timescale::ClockTime;

use super::{cell, module, name, port};
use crate::cli::Folder;
use crate::waves::read;

/// Bits of the accumulator.
const ACC: u32 = 87;

/// A signed accumulator of 87 bits that adds a signed input of 70 bits at every edge, imported as `t.net`.
fn accumulator() -> Folder {
    let folder = Folder::new();
    let (q, y, din): (Vec<u32>, Vec<u32>, Vec<u32>) =
        ((10..10 + ACC).collect(), (200..200 + ACC).collect(), (400..470).collect());
    let signs = ["A_SIGNED", "B_SIGNED"];
    let cells = json!({
        "add": cell("$add", &signs, json!({ "A": q, "B": din, "Y": y })),
        "ff": cell("$dff", &["CLK_POLARITY"], json!({ "CLK": [2], "D": y, "Q": q })),
    });
    let init = "0".repeat(ACC as usize);
    let names = json!({
        "clk": name([2]),
        "acc": { "hide_name": 0, "bits": q, "signed": 1, "attributes": { "init": init } },
        "u1.din": { "hide_name": 0, "bits": din, "attributes": {} },
        "din": { "hide_name": 0, "bits": din, "signed": 1, "attributes": {} },
    });
    let ports =
        json!({ "clk": port("input", [2]), "din": port("input", din.clone()), "acc": port("output", q.clone()) });
    folder.write("t.json", &module(ports, cells, names));
    folder.good("import --json t.json -o t.net");
    folder
}

/// Two's complement of the accumulator.
fn wrapped(number: i128) -> i128 {
    number << (128 - ACC) >> (128 - ACC)
}

#[test]
fn a_wide_word_is_one_signal_in_summary_stimulus_waves_and_report() {
    let folder = accumulator();
    let checked = folder.good("check t.net");
    assert!(checked.contains("1 registers of 87 bits together, 1 inputs, 4 names, 1 properties"), "{checked}");
    let given: [i128; 5] = [(1 << 69) - 1, -(1 << 69), 0x0012_3456_789a_bcde_f012, -5, 1 << 64];
    let texts =
        ["590295810358705651711", "-590295810358705651712", "0x123456789abcdef012", "-5", &format!("0b1{:064}", 0)];
    folder.write("in.csv", &format!("din\n{}\n", texts.join("\n")));
    folder.good("sim t.net --stimulus in.csv --clocks 9 --vcd t.vcd --fst t.fst --json r.json");
    let mut sums = vec![0];
    for edge in 0..9 {
        sums.push(wrapped(sums[edge] + given[edge.min(4)]));
    }
    let digits = |number: i128| format!("{:0128b}", number)[128 - ACC as usize..].to_owned();
    let ticks = 10;
    for wave in ["t.vcd", "t.fst"] {
        let shown = read(&std::fs::read(folder.path(wave)).expect("a wave"));
        let acc = &shown.variables["t.acc"];
        assert_eq!((acc.kind.as_str(), acc.width, acc.range), ("integer", ACC, None), "{wave}");
        for (clock, sum) in sums.iter().enumerate() {
            assert_eq!(acc.at(clock as u64 * ticks), Some(digits(*sum).as_str()), "{wave} clock {clock}");
        }
        assert_eq!(acc.changes.len(), 10, "{wave}");
        // The same nets under another name, and with another reading.
        let (din, alias) = (&shown.variables["t.din"], &shown.variables["t.u1.din"]);
        assert_eq!((&din.changes, alias.width, alias.range), (&alias.changes, 70, Some((69, 0))), "{wave}");
        assert!(shown.variables.len() == 5, "{wave}: {:?}", shown.variables.keys());
    }
    folder.good("diff t.vcd t.fst");
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    assert_eq!(report["last"]["t.acc"], json!(digits(sums[9])));
    let save = folder.read("t.gtkw");
    assert!(save.contains("\nt.acc\n") && save.contains("\nt.u1.din[69:0]\n"), "{save}");
}

#[test]
fn a_constant_on_a_wide_input_and_a_glob_for_a_wide_name() {
    let folder = accumulator();
    folder.good("sim t.net --set din=0x2000000000000000ff --clocks 3 --vcd t.vcd --trace acc --json r.json");
    let shown = read(&std::fs::read(folder.path("t.vcd")).expect("a wave"));
    let mut names: Vec<&String> = shown.variables.keys().collect();
    names.sort();
    assert_eq!(names, ["t.acc", "t.clk", "t.overflow.acc"]);
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    // 0x2000…00ff is negative in 70 bits.
    let sum = 3 * (0x20_0000_0000_0000_00ff - (1i128 << 70));
    assert_eq!(report["last"]["t.acc"], json!(format!("{sum:0128b}")[128 - 87..]));
    for (text, said) in [
        (
            "din=1180591620717411303424",
            "does not fit in 'din', which has 70 bits: -590295810358705651712 to 1180591620717411303423",
        ),
        ("din=0x", "'0x' is not a value for 'din'"),
    ] {
        let ran = folder.run_words(&["sim", "t.net", "--set", text, "--clocks", "3"]);
        assert!(ran.code == 2 && ran.err.contains(said), "{}", ran.err);
    }
    let twice = folder.run_words(&["sim", "t.net", "--set", "din=1", "--set", "din=1", "--clocks", "3"]);
    assert!(twice.code == 2 && twice.err.contains("'din' is given twice"), "{}", twice.err);
}

#[test]
fn a_wide_overflow_is_reported_with_operands_and_exact_result_and_is_strict_or_announced_by_its_name() {
    let folder = accumulator();
    // 2^69 - 1 fits 2^17 times in 2^86.
    let set = ["sim", "t.net", "--set", "din=590295810358705651711", "--clocks", "140000"];
    let ran = folder.run_words(&set);
    let (from, step): (i128, i128) = (131_072 * ((1 << 69) - 1), (1 << 69) - 1);
    let said = format!(
        "t.v:7: overflow of t.acc at clock 131072: {from} + {step} = {} does not fit in its 87 bits ({} to {}); \
         88 bits would hold it (once)",
        from + step,
        -(1i128 << 86),
        (1i128 << 86) - 1
    );
    assert!(ran.code == 0 && ran.out.contains(&said), "{said}\n{}", ran.out);
    let strict = folder.run_words(&[&set[..], &["--strict", "acc", "--json", "r.json"]].concat());
    assert!(strict.code == 1 && strict.out.starts_with("131072 clocks"), "{strict:?}");
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    let first = &report["events"][0]["first"];
    assert_eq!(
        (&first["left"], &first["exact"], &first["needed_width"], &first["width"]),
        (&json!(from.to_string()), &json!((from + step).to_string()), &json!(88), &json!(87))
    );
    let wraps = folder.run_words(&[&set[..], &["--wraps", "t.acc"]].concat());
    assert_eq!((wraps.code, wraps.out.as_str()), (0, "140000 clocks; no property was violated\n"));
}

#[test]
fn a_wide_input_is_one_port_of_exported_verilog_and_a_wide_name_one_net() {
    let folder = accumulator();
    let netlist = stepwave::netlist::text::parse(&folder.read("t.net")).expect("a netlist");
    let design = stepwave::netlist::elaborate(netlist).expect("a design");
    let options = Options { comment: &[], outputs: &[] };
    let text = export::verilog(&design, &options);
    for line in [
        "    input wire signed [69:0] din,\n",
        "    wire [63:0] _n0 = din[63:0];\n",
        "    wire [5:0] _n1 = din[69:64];\n",
        "    wire signed [86:0] acc = {_n3, _n2};\n",
        "        wire [69:0] din = {_n1, _n0};\n",
    ] {
        assert!(text.contains(line), "{line}{text}");
    }
    let time = ClockTime::from_hz(1e6).expect("a clock");
    let stimulus = Stimulus { steps: Vec::new(), done: Vec::new(), never: Vec::new(), always: false, stall: None };
    let bench = export::testbench(&design, &options, &stimulus, time, "w.vcd");
    assert!(bench.contains(".din({din_69_64_, din_63_0_})"), "{bench}");
    for text in [export::btor2(&design, &Checking::default()), export::smt2(&design, &Checking::default(), 1)] {
        assert!(text.expect("no memories").contains("t.acc.86_64"));
    }
}

#[test]
fn a_bench_file_loads_and_sets_inputs_of_more_than_64_bits() {
    // A register of 70 bits that takes an input, and compares with another one.
    let (d, k, q): (Vec<u32>, Vec<u32>, Vec<u32>) = ((100..170).collect(), (200..270).collect(), (300..370).collect());
    let cells = json!({
        "ff": cell("$dff", &["CLK_POLARITY"], json!({ "CLK": [2], "D": d, "Q": q })),
        "eq": cell("$eq", &[], json!({ "A": q, "B": k, "Y": [3] })),
        "zero": cell("$and", &[], json!({ "A": [3], "B": ["0"], "Y": [4] })),
    });
    let names = json!({
        "d": { "hide_name": 0, "bits": d, "signed": 1, "attributes": {} }, "k": name(k.clone()), "q": name(q.clone()),
        "same": name([3]), "none": name([4]),
    });
    let ports = json!({
        "clk": port("input", [2]), "d": port("input", d.clone()), "k": port("input", k.clone()),
        "same": port("output", [3]), "none": port("output", [4]), "q": port("output", q.clone()),
    });
    let folder = Folder::new();
    folder.write("t.json", &module(ports, cells, names));
    folder.good("import --json t.json -o t.net");
    let bench = |load: &str, set: &str| {
        let axes = "[axis.x]\npulse = \"same\"\n[axis.y]\npulse = \"none\"\n";
        let text = format!("clocks = 4\nload = {{ d = \"{load}\" }}\nset = {{ k = \"{set}\" }}\n{axes}");
        folder.write("t.toml", &text);
    };
    // The pulses say that both are the same, in five clocks from the edge on that takes the word.
    let same = |load: &str, set: &str| {
        bench(load, set);
        folder.run("run t.net --to 5,0").out.contains("end point (5, 0) reached exactly")
    };
    assert!(same("dx << 64 | 5", "0x50000000000000005"));
    assert!(!same("dx << 64 | 5", "0x50000000000000004") && !same("dx << 64 | 5", "0x40000000000000005"));
    assert!(same("-dx", "-5") && same("-dx", "0x3ffffffffffffffffb"));
    for (load, set, said) in [
        ("dx << 68", "0", "load.d[63:0] = dx << 68: 1475739525896764129280 does not fit in the 70 bits of its input"),
        ("dx", "0x400000000000000000", "does not fit in 'k', which has 70 bits"),
        ("dx", "five", "'five' is not a value for 'k'"),
    ] {
        bench(load, set);
        let ran = folder.run("run t.net --to 5,0");
        assert!(ran.code == 2 && ran.err.contains(said), "{load} {set}: {}", ran.err);
    }
    bench("dx << 68", "0");
    let ran = folder.run("run t.net --to 5,0 --on-overflow wrap");
    assert!(ran.code != 2, "{}", ran.err);
}
