//! Proofs at one width at a time, of machines whose clocks do not depend on their coefficients.

use stepwave::study::proof::{CountMethod, Narrower, blocks, strobes};
use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_models::options::{CASCADE, OVERRIDE, WIDTH};
use stepwave_models::{Machine, Options, find};
use stepwave_netlist::cells::Op;
use stepwave_netlist::{Net, Width, elaborate};
use stepwave_prove::{AxisNets, LoadWord, Lost, follow, recount};

use crate::cli::Folder;

/// A pulse multiplier of coefficients of this many bits.
fn machine(k: u32, choices: &Options) -> Machine {
    let model = find("dpm-line").unwrap();
    let choices = choices.clone().with_all(&WIDTH, Width::new(u64::from(k)).ok());
    let largest = model.claims.unwrap().geometries.largest(k).unwrap();
    model.machine(&model.plan(&largest, &choices).unwrap()).unwrap()
}

#[test]
fn every_coefficient_is_counted_bit_by_bit_at_every_width() {
    let model = find("dpm-line").unwrap();
    for (k, method) in (1..=10).flat_map(|k| [(k, CountMethod::Follow), (k, CountMethod::Recount)]) {
        let found = blocks(model, &model.claims.unwrap(), &Options::default(), &Narrower::new(), k, method).unwrap();
        assert_eq!(found.len(), 4);
        for block in found {
            assert!(block.is_exact(), "{block}");
            assert_eq!(block.clocks, (1 << k) + 1, "{block}");
            let sign = |backward: &str| if backward.contains(&block.kind) { -1 } else { 1 };
            let (x, y) = (sign("Q2 Q3"), sign("Q3 Q4"));
            let end = |axis: usize, sign: i128| {
                let sum = block.ends[axis].clone().unwrap();
                let n = k as usize;
                (0..2 * n).all(|place| sum.factors[place] == if place / n == axis { sign << (place % n) } else { 0 })
            };
            assert!(end(0, x) && end(1, y), "{block}");
        }
    }
}

/// Compares what is said of every net in every sample with an engine; gives how many values were known.
fn assert_followed(machine: &Machine, known: &[(&str, u64)], unknowns: &[bool]) -> usize {
    let (design, netlist) = (&machine.design, machine.design.netlist());
    let inputs = machine.inputs.iter();
    let words: Vec<(Net, LoadWord)> = inputs
        .map(|(register, port)| {
            let given = known.iter().find(|(name, _)| name == register);
            (port.net, given.map_or(LoadWord::Unknown, |(_, bits)| LoadWord::Known(*bits)))
        })
        .collect();
    let watch = Watch { columns: netlist.nets().collect(), stops: Vec::new() };
    let mut engine = EngineKind::Gates.build(design, &watch);
    let mut place = 0;
    for (net, word) in &words {
        let bits = match word {
            LoadWord::Known(bits) => *bits,
            LoadWord::Unknown => {
                let width = netlist.width(*net).get() as usize;
                place += width;
                let own = &unknowns[place - width..place];
                own.iter().enumerate().fold(0, |word, (bit, is)| word | u64::from(*is) << bit)
            }
        };
        engine.set_input(*net, bits);
    }
    for strobe in [machine.load.net, machine.preset_position.net] {
        engine.set_input(strobe, 1);
    }
    let mut rows = Rows::new(watch.columns.len(), 1 << 14);
    engine.reset(&mut rows);
    for strobe in [machine.load.net, machine.preset_position.net] {
        engine.set_input(strobe, 0);
    }
    engine.run(1 << 13, &mut rows);
    let mut asserted = 0;
    let judge = |clock: u64, sample: &stepwave_prove::KnownSample<'_>| {
        let row = rows.row(usize::try_from(clock).unwrap());
        for net in netlist.nets() {
            if let Some(value) = sample.value(net, unknowns) {
                assert_eq!(value, row[net.index()], "{} at clock {clock}", netlist.describe(net));
                asserted += 1;
            }
        }
    };
    follow(design, strobes(machine), &words, &[], 1 << 13, judge).unwrap();
    asserted
}

#[test]
fn what_is_said_of_every_net_is_what_the_engine_has() {
    let cascade = Options::default().with(&CASCADE, Width::new(2).ok());
    let slow = Options::default().with(&OVERRIDE, Some(70));
    for choices in [Options::default(), cascade, slow] {
        let machine = machine(4, &choices);
        for signs in 0..4_u8 {
            let unknowns: Vec<bool> =
                (0..8).map(|bit| 0x9e37_79b9_u32.rotate_left(7 * u32::from(signs)) >> bit & 1 == 1).collect();
            let known =
                [("x", 0), ("y", 0), ("sx", u64::from(signs & 1)), ("sy", u64::from(signs >> 1)), ("percent", 0x70)];
            let asserted = assert_followed(&machine, &known, &unknowns);
            assert!(asserted > 500, "{asserted}");
        }
    }
}

#[test]
fn a_position_that_is_too_narrow_is_not_proved_and_an_end_that_depends_is_not_followed() {
    let model = find("dpm-line").unwrap();
    let narrower = Narrower::from([("x".to_owned(), 2)]);
    for method in [CountMethod::Follow, CountMethod::Recount] {
        let lost = blocks(model, &model.claims.unwrap(), &Options::default(), &narrower, 5, method).unwrap_err();
        let lost = lost.to_string();
        // A counter that is too narrow does not count every pulse as one.
        let word = if method == CountMethod::Follow {
            "dpm_line.axis_x.x may overflow at clock "
        } else {
            "dpm_line.axis_x.x"
        };
        assert!(lost.contains(word), "{lost}");
    }
    // Loaded at clock 1, x of 5 bits can have come to 15 at clock 16, and to -16 at clock 17: a pulse more does not
    // fit.
    let largest = model.claims.unwrap().geometries.largest(5).unwrap();
    let widths = [("x".to_owned(), Width::new(5).unwrap())].into();
    let choices = Options::default().with_all(&WIDTH, Width::new(5).ok()).with_single(&WIDTH, widths);
    let machine = model.machine(&model.plan(&largest, &choices).unwrap()).unwrap();
    for (negative, clock) in [(0, 16), (1, 17)] {
        let word = |name: &str| match name {
            "mx" | "my" => LoadWord::Unknown,
            "sx" => LoadWord::Known(negative),
            _ => LoadWord::Known(0),
        };
        let words: Vec<(Net, LoadWord)> = machine.inputs.iter().map(|(name, port)| (port.net, word(name))).collect();
        let lost = follow(&machine.design, strobes(&machine), &words, &[], 100, |_, _| {}).unwrap_err().to_string();
        assert!(lost.contains(&format!("dpm_line.axis_x.x may overflow at clock {clock}")), "{lost}");
    }
    // A comparison of coordinates is not a sum of unknown bits.
    let model = find("ppc-line").unwrap();
    let largest = model.claims.unwrap().geometries.largest(3).unwrap();
    let machine = model.machine(&model.plan(&largest, &Options::default()).unwrap()).unwrap();
    let words: Vec<(Net, LoadWord)> = machine.inputs.values().map(|port| (port.net, LoadWord::Unknown)).collect();
    let lost = follow(&machine.design, strobes(&machine), &words, &[], 100, |_, _| {}).unwrap_err();
    assert!(matches!(lost, Lost::Claim { .. } | Lost::End { .. }), "{lost}");
}

#[test]
fn the_command_proves_and_checks_at_one_width_and_refutes_one_bit_less() {
    let folder = Folder::new();
    let printed = folder.good("prove dpm-line --bits 7 --certificate seven.cert");
    for claim in ["no register overflows", "the end point is reached exactly", "every block ends"] {
        assert!(printed.contains(&format!("PROVED at k = 7: {claim}\n")), "{printed}");
    }
    assert_eq!(folder.good("prove check seven.cert"), printed);
    let certificate = folder.read("seven.cert");
    assert!(certificate.contains("counted 7 Q1 clocks=129 x=0+1*mx.0+2*mx.1+4*mx.2"), "{certificate}");
    std::fs::write(folder.path("wrong.cert"), certificate.replacen("+2*mx.1", "+3*mx.1", 1)).unwrap();
    assert_eq!(folder.run("prove check wrong.cert").code, 1);
    let none: Vec<&str> = certificate.lines().filter(|line| !line.starts_with("counted")).collect();
    std::fs::write(folder.path("none.cert"), none.join("\n") + "\n").unwrap();
    assert_eq!(folder.run("prove check none.cert").code, 1);
    let ran = folder.run("prove dpm-line --bits 4 --narrower x=2 --vcd trap.vcd");
    assert!(ran.code == 1 && ran.out.starts_with("COUNTEREXAMPLE at k = 4: stepwave run dpm-line"), "{ran:?}");
    assert!(
        ran.err.contains("overflow of dpm_line.axis_x.x at clock ") && !folder.read("trap.vcd").is_empty(),
        "{ran:?}"
    );
    for (words, hint) in [
        ("prove ppc-line --bits 5", "leave --bits out"),
        ("prove dpm-line --bits 3 --any-preset", "leave --any-preset out"),
        ("prove dpm-line --bits 4 --radix 10", "leave --radix 10 out"),
        ("prove dpm-line --bits 21", "21"),
    ] {
        let ran = folder.run(words);
        assert!(ran.code == 2 && ran.err.contains(hint), "{words}: {ran:?}");
    }
    assert!(folder.good("widths dpm-line --box 4").contains("proved at k"));
}

/// A block of this machine on the judge of engines: its clocks and the places of its axes, if it ends without an
/// overflow.
fn ran(machine: &Machine, words: &[(Net, u64)], limit: u64) -> Option<(u64, Vec<i128>)> {
    let mut engine = EngineKind::Gates.build(&machine.design, &Watch::default());
    words.iter().for_each(|(net, word)| engine.set_input(*net, *word));
    let strobes = [machine.load.net, machine.preset_position.net];
    strobes.iter().for_each(|strobe| engine.set_input(*strobe, 1));
    let mut rows = Rows::new(0, 0);
    engine.reset(&mut rows);
    strobes.iter().for_each(|strobe| engine.set_input(*strobe, 0));
    for clock in 0..=limit {
        let mut claims = machine.design.netlist().properties.iter();
        if claims.any(|claim| engine.value(claim.never) == 1) {
            return None;
        }
        if clock > 0 && engine.value(machine.done.net) == 1 {
            let place = |port: &stepwave_models::Port| port.reading.number(port.width, engine.value(port.net));
            return Some((clock, machine.positions.iter().map(place).collect()));
        }
        engine.run(1, &mut rows);
    }
    None
}

/// The same machine with one cell of another kind, where there is such.
fn changed(machine: &Machine, net: Net) -> Option<Machine> {
    let mut netlist = machine.design.netlist().clone();
    let cell = &mut netlist.cells[net.index()];
    cell.op = match cell.op {
        Op::And(a, b) => Op::Or(a, b),
        Op::Or(a, b) => Op::And(a, b),
        Op::Xor(a, b) => Op::Or(a, b),
        Op::Add(a, b) => Op::Sub(a, b),
        Op::Sub(a, b) => Op::Add(a, b),
        Op::Mux { select, high, low } => Op::Mux { select, high: low, low: high },
        Op::AddOverflow(a, b) | Op::Carry(a, b) => Op::LessSigned(a, b),
        Op::Slice { of, low } if low > 0 => Op::Slice { of, low: low - 1 },
        Op::Const(word) => Op::Const(word ^ 1),
        _ => return None,
    };
    Some(Machine { design: elaborate(netlist).ok()?, ..machine.clone() })
}

#[test]
fn what_is_counted_pulse_by_pulse_is_so_for_every_coefficient_of_machines_that_were_spoilt() {
    let sound = machine(3, &Options::default());
    let (mut refused, mut other, mut same) = (0, 0, 0);
    for machine in sound.design.netlist().nets().filter_map(|net| changed(&sound, net)) {
        let word = |name: &str| match name {
            "mx" | "my" => LoadWord::Unknown,
            "sx" => LoadWord::Known(1),
            _ => LoadWord::Known(0),
        };
        let words: Vec<(Net, LoadWord)> = machine.inputs.iter().map(|(name, port)| (port.net, word(name))).collect();
        let axes = machine.pulses.iter().zip(&machine.positions);
        let axes: Vec<AxisNets> =
            axes.map(|(pulse, position)| AxisNets { pulse: pulse.net, position: position.net }).collect();
        let Ok(found) = recount(&machine.design, strobes(&machine), &words, &axes, 64) else {
            refused += 1;
            continue;
        };
        let mut usual = true;
        for coefficients in 0..64_u64 {
            let unknowns: Vec<bool> = (0..6).map(|bit| coefficients >> bit & 1 == 1).collect();
            let mut left = coefficients;
            let mut put = |word: LoadWord| match word {
                LoadWord::Known(word) => word,
                LoadWord::Unknown => (left & 7, left >>= 3).0,
            };
            let words: Vec<(Net, u64)> = words.iter().map(|(net, word)| (*net, put(*word))).collect();
            let ends: Vec<i128> = found.ends.iter().map(|end| end.as_ref().unwrap().at(&unknowns)).collect();
            let (x, y) = (-i128::from(coefficients & 7), i128::from(coefficients >> 3));
            usual &= ends == [x, y];
            assert_eq!(ran(&machine, &words, 64), Some((found.clocks, ends)), "{coefficients}");
        }
        if usual { same += 1 } else { other += 1 }
    }
    assert!(refused > 20 && other > 5 && same > 5, "{refused} refused, {other} of other ends, {same} of the same");
}

#[test]
fn a_certificate_that_says_something_else_is_refused_before_anything_is_counted() {
    let folder = Folder::new();
    folder.good("prove dpm-line --bits 2 --certificate two.cert");
    let text = folder.read("two.cert");
    // Blocks of 2^20 clocks, none of which ends as a coefficient of 20 bits does.
    for (from, to) in
        [("counted 2 ", "counted 20 "), ("clocks=5 ", ""), ("clocks=5 ", "clocks=5, "), ("+2*mx.1", "+3*mx.1")]
    {
        assert!(text.contains(from));
        std::fs::write(folder.path("other.cert"), text.replace(from, to)).unwrap();
        let start = std::time::Instant::now();
        let ran = folder.run("prove check other.cert");
        assert!(ran.code == 1 && ran.err.contains("does not say what its blocks come to"), "{to}: {ran:?}");
        assert!(start.elapsed().as_secs() < 5, "{to}");
    }
    std::fs::write(folder.path("other.cert"), text.replace("clocks=5", "clocks=6")).unwrap();
    assert_eq!(folder.run("prove check other.cert").code, 1);
}
