//! Netlists with a bench file run geometries as models do: the netlist of a model, whose ports a bench file describes, comes
//! to what the model comes to.

use std::fs;

use stepwave::models::{OnOverflow, Options, find};
use stepwave::nc::{Arc, Curve, Direction, Line};
use stepwave::netlist::Netlist;
use stepwave::netlist::cells::{Claim, Operator, Property, Word};
use stepwave::netlist::dsl::Module;
use stepwave::report::Report;
use stepwave::{Simulation, own};

use crate::cli::Folder;

/// What a bench file says of `dda-line` of 7 bits.
const DDA: &str = r#"
load = { jvx_in = "abs(dx)", jvy_in = "abs(dy)", sx_in = "dx < 0", sy_in = "dy < 0", e_in = "1 << 7" }
start = "load"
done = "done"
step = "busy"
table = ["jrx", "jry", "e"]
"#;

/// The netlist of a model for a curve, with more hardware after it.
pub(crate) fn netlist(model: &str, curve: &Curve, options: &str, more: impl FnOnce(&Module, &Netlist)) -> String {
    let model = find(model).expect("a model");
    let options = Options::parse(options.split_whitespace()).expect("options");
    let hardware = model.plan(curve, &options).expect("a plan");
    let netlist = model.machine(&hardware).expect("a machine").design.netlist().clone();
    let module = Module::continuing(netlist.clone());
    more(&module, &netlist);
    module.finish().expect("a netlist").to_string()
}

pub(super) fn line(to: [i64; 2]) -> Curve {
    Line::new(vec![0, 0], to.to_vec()).expect("a line").into()
}

/// The hardware of a netlist and a bench file, written into a folder.
pub(crate) fn written(folder: &Folder, netlist: &str, bench: &str) -> &'static stepwave::models::Model {
    fs::write(folder.path("own.net"), netlist).expect("written");
    fs::write(folder.path("own.toml"), bench).expect("written");
    let path = folder.path("own.net").display().to_string();
    own::model(&path, None).unwrap_or_else(|error| panic!("{error}"))
}

pub(super) fn run(model: &'static stepwave::models::Model, curve: &Curve, options: &str) -> Report {
    let options = Options::parse(options.split_whitespace()).expect("options");
    Simulation::new(model, curve.clone()).options(options).run().expect("a run")
}

/// Both come to the same place by the same pulses, with the same greatest error.
fn same(own: &Report, model: &Report) {
    assert!(own.failures().is_empty(), "{:?}", own.failures());
    assert_eq!((&own.outcome.reached, &own.outcome.pulses), (&model.outcome.reached, &model.outcome.pulses));
    assert_eq!(own.outcome.steps, model.outcome.steps);
    let worst =
        |report: &Report| report.curve().and_then(|of| of.worst.clone()).map(|worst| (worst.error, worst.position));
    assert_eq!(worst(own), worst(model));
}

/// Lines in every direction, as fast as the hardware pulses, and slow ones.
fn lines() -> Vec<Curve> {
    let ends = [[100, 60], [-100, 60], [100, -60], [-3, -127], [127, 127], [-127, 1], [1, 0], [0, -1], [5, 90]];
    ends.into_iter().map(line).collect()
}

#[test]
fn pulses_of_every_kind_lead_where_those_of_the_model_lead() {
    let axes = |x: &str, y: &str| format!("{DDA}[axis.x]\n{x}\n[axis.y]\n{y}\n");
    let benches = [
        axes("pulse = \"dx\"", "pulse = \"dy\""),
        axes(
            "pulse = \"step_x\"\nnegative = \"dir_x\"",
            "step = \"step_y\"\ndirection = \"dir_y\"\ncount = \"clocks\"",
        ),
        axes("up = \"up_x\"\ndown = \"down_x\"\ncount = \"clocks\"", "position = \"y\""),
        axes("quadrature = [\"a_x\", \"b_x\"]", "quadrature = [\"a_y\", \"b_y\"]"),
        axes("position = \"x\"", "step = \"!idle_y\"\ndirection = \"!positive_y\"\ncount = \"clocks\""),
        axes("step = \"turns_x\"\ndirection = \"turns_back_x\"", "up = \"turns_up_y\"\ndown = \"turns_down_y\""),
    ];
    let text = netlist("dda-line", &line([127, 127]), "", |module, netlist| {
        let m = module.top();
        // A block whose pulses are late ends later.
        let late = ["late", "late_done"].map(|name| m.reg(name, 1));
        late[0].set(m.net(netlist.find("done").expect("a net").net, false));
        late[1].set(late[0].q);
        for axis in ["x", "y"] {
            let net = |name: &str| m.net(netlist.find(name).expect("a net").net, true);
            let (pulse, position) = (net(&format!("d{axis}")), net(axis));
            let (step, dir) = (pulse.is_nonzero(), pulse.msb());
            m.name(&format!("step_{axis}"), step);
            m.name(&format!("idle_{axis}"), !step);
            m.name(&format!("dir_{axis}"), dir);
            m.name(&format!("positive_{axis}"), !dir);
            m.name(&format!("up_{axis}"), step & !dir);
            m.name(&format!("down_{axis}"), step & dir);
            // The first signal leads in the positive direction.
            m.name(&format!("a_{axis}"), position.bit(0) ^ position.bit(1));
            m.name(&format!("b_{axis}"), position.bit(1));
            // An edge for each pulse, however close they are: the clock itself is between two samples.
            let rate = m.reg(&format!("turns_{axis}"), 1);
            rate.set(step & !rate.q);
            let down = m.reg(&format!("turns_back_{axis}"), 1);
            down.set(dir);
            m.name(&format!("turns_up_{axis}"), rate.q & !down.q);
            m.name(&format!("turns_down_{axis}"), rate.q & down.q);
        }
    });
    let model = find("dda-line").expect("a model");
    for (index, bench) in benches.iter().enumerate() {
        let folder = Folder::new();
        let late = bench.replace("done = \"done\"", "done = \"late_done\"");
        let own = written(&folder, &text, if index == 5 { &late } else { bench });
        for curve in lines() {
            let to = curve.to();
            // Edges are a clock late, and need a clock between them.
            if index == 5 && (to[0].abs() > 60 || to[1].abs() > 60) {
                continue;
            }
            let (own, model) = (run(own, &curve, ""), run(model, &curve, "--width 7"));
            if index == 5 {
                assert!(own.failures().is_empty(), "{to:?}: {:?}", own.failures());
                continue;
            }
            same(&own, &model);
            let clocks = |report: &Report| report.curve().and_then(|of| of.speed).map(|speed| speed.clocks);
            assert_eq!(clocks(&own), clocks(&model), "{to:?}");
        }
    }
}

#[test]
fn a_bench_of_arcs_loads_what_the_geometry_says() {
    let arc = |from, to, turn| -> Curve { Arc::new(from, to, [0, 0], turn).expect("an arc").into() };
    let (ccw, cw) = (Direction::CounterClockwise, Direction::Clockwise);
    let text = netlist("ppc-arc", &arc([200, 0], [0, 200], ccw), "", |_, _| {});
    let bench = r#"
load = { xi_in = "abs(dx0)", yi_in = "abs(dy0)", f_in = "dx0*dx0 + dy0*dy0 - r*r", e_in = "abs(dx) + abs(dy)", quad_in = "quadrant - 1", ccw_in = "!cw" }
start = "load"
done = "done"
reset = { port = "preset_position", active = 1, clocks = 3 }
[axis.x]
pulse = "dx"
[axis.y]
pulse = "dy"
"#;
    let folder = Folder::new();
    let own = written(&folder, &text, bench);
    let model = find("ppc-arc").expect("a model");
    let arcs = [
        arc([5, 0], [0, 5], ccw),
        arc([3, 4], [4, 3], cw),
        arc([-4, 3], [-3, -4], ccw),
        arc([0, -10], [10, 0], ccw),
        arc([6, -8], [-6, -8], cw),
    ];
    for curve in &arcs[..] {
        let crosses = curve.from().iter().zip(curve.to()).any(|(from, to)| from * to < 0);
        if !crosses {
            same(&run(own, curve, ""), &run(model, curve, ""));
        }
    }
    let refused = Simulation::new(own, line([8, 6])).run().expect_err("a line");
    assert!(refused.to_string().contains("interpolates arcs"), "{refused}");
}

#[test]
fn every_command_takes_a_netlist_with_a_bench_file() {
    let folder = Folder::new();
    let text = netlist("dda-line", &line([127, 127]), "", |_, _| {});
    let bench = format!("{}[axis.x]\npulse = \"dx\"\n[axis.y]\npulse = \"dy\"\n", DDA.replace("step = \"busy\"\n", ""));
    fs::write(folder.path("own.net"), &text).expect("written");
    fs::write(folder.path("own.toml"), &bench).expect("written");
    let ran = |words: &[&str], code: u8| {
        let ran = folder.run_words(words);
        assert_eq!(ran.code, i32::from(code), "{words:?}: {ran:?}");
        ran.out + &ran.err
    };
    let run = ran(&["run", "own.net", "--to", "8,6", "--vcd", "w.vcd"], 0);
    assert!(run.contains("end point (8, 6) reached exactly") && run.contains("step  jrx  jry"), "{run}");
    let sweep = ran(&["sweep", "own.net", "--to-grid", "1..20x1..20"], 0);
    assert!(sweep.contains("400 done"), "{sweep}");
    let compare = ran(&["compare", "own.net", "dda-line", "--to", "8,6"], 0);
    assert!(compare.contains("own.net") && compare.contains("dda-line") && !compare.contains("ppc-line"), "{compare}");
    assert!(ran(&["compare", "own.net", "--to", "8,6"], 0).contains("ppc-line"));
    let widths = ran(&["widths", "own.net", "--box", "0..20x0..20"], 0);
    assert!(widths.contains("jvx            7      5"), "{widths}");
    let proved = ran(&["prove", "own.net", "--travel", "3"], 0);
    assert!(proved.contains("PROVED at these widths") && proved.contains("(48 geometries, exhausted)"), "{proved}");
    fs::write(folder.path("short.toml"), bench.replace("done = \"done\"", "clocks = 64")).expect("written");
    let missed = ran(&["prove", "own.net", "--bench", "short.toml", "--box", "1..3x0..0", "--vcd", "missed.vcd"], 1);
    assert!(
        missed.contains("COUNTEREXAMPLE: stepwave run own.net --bench short.toml --to 1,0 --vcd missed.vcd"),
        "{missed}"
    );
    assert!(missed.contains("the end point (1, 0) was missed") && folder.path("missed.vcd").exists(), "{missed}");
    let bits = ran(&["prove", "own.net", "--box", "2", "--bits", "3"], 2);
    assert!(bits.contains("--bits does not go with the geometries of a box"), "{bits}");
    ran(&["export", "own.net", "--to", "8,6", "--verilog", "own.v", "--testbench", "own_tb.v"], 0);
    fs::create_dir(folder.path("waves")).expect("a folder");
    for file in ["own.net", "own.toml"] {
        fs::copy(folder.path(file), folder.path("waves").join(file)).expect("a copy");
    }
    let case = "[[case]]\nname = \"line\"\nargs = [\"own.net\", \"--to\", \"8,6\"]\n";
    fs::write(folder.path("waves").join("cases.toml"), case).expect("written");
    ran(&["golden", "record", "waves"], 0);
    ran(&["golden", "check", "waves"], 0);
    fs::rename(folder.path("own.toml"), folder.path("other.toml")).expect("renamed");
    let missing = ran(&["run", "own.net", "--to", "8,6"], 2);
    assert!(missing.contains("own.net has no bench file") && missing.contains("--bench"), "{missing}");
    ran(&["run", "own.net", "--bench", "other.toml", "--to", "8,6"], 0);
    let wrong = ran(&["run", "dda-line", "--bench", "other.toml", "--to", "8,6"], 2);
    assert!(wrong.contains("dda-line is a model of the catalogue"), "{wrong}");
    let wrong = ran(&["prove", "dda-line", "--bench", "other.toml"], 2);
    assert!(wrong.contains("dda-line is a model of the catalogue"), "{wrong}");
    let narrow = ran(&["run", "own.net", "--bench", "other.toml", "--to", "200,6"], 2);
    assert!(narrow.contains("load.jvx_in = abs(dx): 200 does not fit in its 7 bits, 0 to 127"), "{narrow}");
    let cut = ran(&["run", "own.net", "--bench", "other.toml", "--to", "200,6", "--on-overflow", "wrap"], 1);
    assert!(cut.contains("load.jvx_in = 200 does not fit in its 7 bits: 72 was loaded"), "{cut}");
}

#[test]
fn what_a_bench_file_says_wrongly_is_refused_with_its_line() {
    let text = netlist("dda-line", &line([127, 127]), "", |_, _| {});
    let good = format!("{DDA}[axis.x]\npulse = \"dx\"\n[axis.y]\npulse = \"dy\"\n");
    let refused = [
        ("done = \"done\"", "done = \"dune\"", "own.toml:4: done: there is no signal 'dune'"),
        ("done = \"done\"", "", "nothing says when a block has ended"),
        ("start = \"load\"", "start = \"busy\"", "own.toml:3: start: there is no input 'busy'"),
        ("start = \"load\"", "start = \"e_in\"", "the input 'e_in' is driven by `load` already"),
        ("abs(dx)", "abs(dq)", "own.toml:2: load jvx_in: 'abs(dq)': there is no 'dq'"),
        ("jvx_in", "jvq_in", "own.toml:2: load jvq_in: there is no input 'jvq_in'"),
        ("table = [\"jrx\"", "table = [\"jrq\"", "own.toml:6: table: there is no signal 'jrq'"),
        ("pulse = \"dx\"", "step = \"dx\"", "axis x: 'dx' has 2 bits where a signal of 1 bit is needed"),
        ("pulse = \"dx\"", "pulse = \"dx\"\nup = \"dx\"", "axis x: give one of step, pulse, up and down"),
        ("pulse = \"dx\"", "pulse = \"dx\"\ndirection = \"sx\"", "axis x: its direction is in the pulses"),
        ("[axis.y]", "[axis.z]", "there is an axis z, but no axis y"),
        ("[axis.y]", "[axis.q]", "there is no axis 'q'"),
        ("start = \"load\"", "start = \"load\"\nstarts = 1", "unknown field `starts`"),
        ("start = \"load\"", "max_axes = 3\nstart = \"load\"", "max_axes = 3: give 2 to 2"),
        ("start = \"load\"", "start = \"load\"\nset = { x_in = 999 }", "set x_in: 999 does not fit in its 9 bits"),
        ("start = \"load\"", "start = \"load\"\nreset = { port = \"x_in\" }", "reset: 'x_in' has 9 bits"),
        ("start = \"load\"", "strobe = \"level\"", "strobe = \"level\" says how long `start` is 1"),
        ("start = \"load\"", "start = \"load\"\nclock = \"busy\"", "clock = \"busy\" is a signal of the netlist"),
        ("start = \"load\"", "start = \"load\"\nclocks = 128", "done and clocks both say"),
        ("start = \"load\"", "start = \"load\"\ncurves = \"circles\"", "unknown variant `circles`"),
    ];
    for (from, to, expected) in refused {
        let folder = Folder::new();
        fs::write(folder.path("own.net"), &text).expect("written");
        assert!(good.contains(from));
        fs::write(folder.path("own.toml"), good.replacen(from, to, 1)).expect("written");
        let ran = folder.run_words(&["run", "own.net", "--to", "8,6"]);
        assert!(ran.code == 2 && ran.err.contains(expected), "{to}: {ran:?}");
    }
}

#[test]
fn a_block_of_so_many_clocks_needs_no_signal() {
    let text = netlist("dda-line", &line([127, 127]), "", |_, _| {});
    let bench = format!("{DDA}[axis.x]\npulse = \"dx\"\n[axis.y]\npulse = \"dy\"\n");
    let folder = Folder::new();
    let own = written(&folder, &text, &bench.replace("done = \"done\"", "clocks = \"(1 << 7) + 2\""));
    for curve in lines() {
        assert!(run(own, &curve, "").failures().is_empty());
    }
    // Too few: the last pulses are missing.
    let folder = Folder::new();
    let own = written(&folder, &text, &bench.replace("done = \"done\"", "clocks = 64"));
    let report = run(own, &line([100, 60]), "");
    assert_eq!(report.outcome.reached, [49, 29]);
    assert_eq!(report.hardware.get(&stepwave::models::options::ON_OVERFLOW), OnOverflow::Trap);
}

#[test]
fn a_level_is_held_until_the_block_has_ended() {
    // It counts while `run` is 1, and begins anew where it is 0.
    let module = Module::new("level");
    let m = module.top();
    let run_input = m.input("run", 1);
    let ends = ["x", "y"].map(|axis| {
        let (end, count) = (m.input(&format!("n{axis}"), 4), m.reg(&format!("c{axis}"), 4));
        let more = run_input & !count.q.equals(end);
        m.name(&format!("p{axis}"), more);
        count.when(more, count.q.wrapping_add(m.lit(4, 1))).when(run_input, count.q).otherwise(m.lit(4, 0));
        count.q.equals(end)
    });
    m.name("ready", ends[0] & ends[1]);
    let text = module.finish().expect("a netlist").to_string();
    let bench = r#"
load = { nx = "dx", ny = "dy" }
start = "run"
strobe = "level"
done = "ready"
[axis.x]
pulse = "px"
[axis.y]
pulse = "py"
"#;
    let folder = Folder::new();
    let own = written(&folder, &text, bench);
    for to in [[5, 3], [1, 15], [0, 2]] {
        let report = run(own, &line(to), "");
        assert!(report.failures().is_empty(), "{:?}", report.failures());
        assert_eq!(report.outcome.pulses, to.map(i64::unsigned_abs));
    }
    // For one clock it comes nowhere, and every register is what it was before.
    let folder = Folder::new();
    let own = written(&folder, &text, &bench.replace("strobe = \"level\"\n", ""));
    let failures = run(own, &line([5, 3]), "").failures();
    assert!(failures[0].contains("stalled at (1, 1)"), "{failures:?}");
    let refused = Simulation::new(own, line([-1, 3])).run().expect_err("a negative word");
    assert!(refused.to_string().contains("load.nx = dx: -1 does not fit in its 4 bits, 0 to 15"), "{refused}");
}

#[test]
fn registers_of_one_name_in_several_scopes_and_in_the_harness_are_kept_apart() {
    // `count` counts the clocks of a block, `s2.count` two of them, `x` and `go` are names of the harness too.
    let module = Module::new("twice");
    let m = module.top();
    let (start, end) = (m.input("start", 1), m.input("n", 4));
    let (count, go) = (m.reg("count", 6), m.reg("go", 1));
    let more = !count.q.slice(0, 4).equals(end);
    go.when(start, m.lit(1, 1)).when(more, go.q).otherwise(m.lit(1, 0));
    let pulse = m.name("pulse", go.q & more);
    count.when(start, m.lit(6, 0)).when(pulse, count.q.wrapping_add(m.lit(6, 1))).else_hold();
    let inner = m.scope("s2").reg("count", 6);
    inner.when(start, m.lit(6, 0)).when(pulse, inner.q.wrapping_add(m.lit(6, 2))).else_hold();
    let x = m.reg("x", 6);
    x.when(pulse, x.q.wrapping_add(m.lit(6, 3))).else_hold();
    m.name("ready", !go.q);
    m.name("zero", m.lit(1, 0));
    let text = module.finish().expect("a netlist").to_string();
    let bench = "load = { n = \"dx\" }\nstart = \"start\"\ndone = \"ready\"\n[axis.x]\npulse = \"pulse\"\n[axis.y]\npulse = \"zero\"\n";
    let folder = Folder::new();
    fs::create_dir(folder.path("a b")).expect("a folder");
    fs::write(folder.path("a b").join("t.net"), text).expect("written");
    fs::write(folder.path("a b").join("b.toml"), bench).expect("written");
    let words = ["widths", "a b/t.net", "--bench", "a b/b.toml", "--box", "1..9x0..0", "--json"];
    let ran = folder.run_words(&words);
    assert_eq!(ran.code, 0, "{ran:?}");
    let found: serde_json::Value = serde_json::from_str(&ran.out).expect("JSON");
    let registers = found["registers"].as_array().expect("registers");
    let of =
        |name: &str| registers.iter().find(|register| register["name"] == name).unwrap_or_else(|| panic!("{name}"));
    // The greatest values of nine pulses, and the bits that they need.
    for (name, greatest, needed) in
        [("count", 9, 4), ("twice.s2.count", 18, 5), ("twice.x", 27, 5), ("go", 1, 1), ("x", 9, 5)]
    {
        assert_eq!((&of(name)["greatest"], &of(name)["needed"]), (&greatest.into(), &needed.into()), "{name}");
    }
    let command = of("twice.x")["one_bit_below"].as_str().expect("a command");
    assert_eq!(command, "stepwave run 'a b/t.net' --bench 'a b/b.toml' --to 6,0");
    let again = folder.run_words(&["run", "a b/t.net", "--bench", "a b/b.toml", "--to", "6,0", "--vcd", "t.vcd"]);
    assert!(again.out.contains("twice.x 5/6") && again.out.contains("twice.s2.count 4/6"), "{again:?}");
    let wave = fs::read_to_string(folder.path("t.vcd")).expect("a wave");
    assert!(wave.contains("t.net; line"), "{}", &wave[..300]);
    // A case of a folder finds both files there, in two words or in one.
    let case = |args: &str| format!("[[case]]\nname = \"line\"\nargs = [\"t.net\", {args}, \"--to\", \"8,0\"]\n");
    for args in ["\"--bench\", \"b.toml\"", "\"--bench=b.toml\""] {
        fs::write(folder.path("a b").join("cases.toml"), case(args)).expect("written");
        let recorded = folder.run_words(&["golden", "record", "a b"]);
        assert_eq!(recorded.code, 0, "{recorded:?}");
        assert_eq!(folder.run_words(&["golden", "check", "a b"]).code, 0);
    }
}

/// Hardware that counts its pulses in two bits, as an import would have it.
pub(super) fn narrow(folder: &Folder) {
    let module = Module::new("t");
    let m = module.top();
    let (start, end) = (m.input("start", 1), m.input("n", 4));
    let (left, narrow) = (m.reg("left", 4), m.reg("narrow", 2));
    let pulse = m.name("pulse", left.q.is_nonzero());
    left.when(start, end).when(pulse, left.q.wrapping_sub(m.lit(4, 1))).else_hold();
    let one = m.lit(2, 1);
    narrow.when(start, m.lit(2, 0)).when(pulse, narrow.q.wrapping_add(one)).else_hold();
    let never = pulse & !start & narrow.q.equals(m.lit(2, 3));
    m.name("ready", !pulse);
    m.name("zero", m.lit(1, 0));
    let [left, right] = [narrow.q, one].map(|signal| Word { nets: vec![signal.net()], signed: false });
    let claim = Claim::Fits { operator: Operator::Add, left, right, bits: 2, signed: false, wraps: false };
    let property = Property { name: "t.narrow".to_owned(), never: never.net(), claim };
    let mut netlist = module.finish().expect("a netlist");
    netlist.properties.push(property);
    fs::write(folder.path("t.net"), netlist.to_string()).expect("written");
    let bench = "load = { n = \"dx\" }\nstart = \"start\"\ndone = \"ready\"\n[axis.x]\npulse = \"pulse\"\n[axis.y]\npulse = \"zero\"\n";
    fs::write(folder.path("t.toml"), bench).expect("written");
}

#[test]
fn an_overflow_of_own_hardware_is_reported_traps_or_is_announced_as_the_user_says() {
    let folder = Folder::new();
    narrow(&folder);
    let ran = |words: &str, code: i32| {
        let ran = folder.run_words(&words.split(' ').collect::<Vec<_>>());
        assert_eq!(ran.code, code, "{words}: {ran:?}");
        ran.out + &ran.err
    };
    // The go at clock 1, the first pulse at 2, the fourth at 5.
    let event = "overflow of t.narrow at clock 5: 3 + 1 = 4 does not fit in its 2 bits (0 to 3); 3 bits would hold it";
    let run = ran("run t.net --to 9,0", 0);
    assert!(run.contains(&format!("warning: {event} (2 times, 3 bits would hold all)")), "{run}");
    let strict = ran("run t.net --to 9,0 --strict narrow", 1);
    assert!(
        strict.contains("stopped by an overflow at (3, 0)") && strict.contains(&format!("stepwave: {event}\n")),
        "{strict}"
    );
    let wraps = ran("run t.net --to 9,0 --wraps narrow", 0);
    assert!(!wraps.contains("overflow"), "{wraps}");
    assert!(ran("run t.net --to 9,0 --wraps narrow --strict narrow", 2).contains("announced to lose its carry"));
    assert!(
        ran("run t.net --to 9,0 --strict nothing", 2)
            .contains("it matches no property that it can be of; there are: t.narrow")
    );
    // Lanes see what a run sees.
    let sweep = ran("sweep t.net --to-grid 1..9x0..0 --csv -", 0);
    let overflows = |row: &str| row.split(',').nth(16).map(str::to_owned);
    let found: Vec<Option<String>> = sweep.lines().skip(1).map(overflows).collect();
    assert_eq!(found.iter().flatten().collect::<Vec<_>>(), ["0", "0", "0", "1", "1", "1", "1", "2", "2"], "{sweep}");
    assert_eq!(ran("sweep t.net --to-grid 1..9x0..0 --strict narrow --csv -", 0).matches(",trapped,").count(), 6);
    // What nine pulses need of a wider counter no run of this one shows.
    let widths = ran("widths t.net --box 1..9x0..0", 1);
    assert!(
        widths.contains("narrow of 2 bits is too narrow, it needs 3 or more: stepwave run t.net --to 4,0"),
        "{widths}"
    );
    assert!(widths.contains("at least: results did not fit"), "{widths}");
    assert!(ran("widths t.net --box 1..3x0..0", 0).contains("narrow         2      2"));
    assert!(ran("prove t.net --box 1..3x0..0", 0).contains("PROVED at these widths"));
    assert!(ran("prove t.net --box 1..9x0..0", 1).contains("COUNTEREXAMPLE: stepwave run t.net --to 4,0\n"));
    assert!(ran("prove t.net --box 1..9x0..0 --wraps narrow", 0).contains("(9 geometries, exhausted)"));
    // An exported test bench ends where the run does.
    let bench = |options: &str| {
        ran(&format!("export t.net --to 9,0{options} --testbench tb.v"), 0);
        let text = fs::read_to_string(folder.path("tb.v")).expect("a test bench");
        text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(bench(""), bench(" --wraps narrow"));
    assert_ne!(bench(""), bench(" --strict narrow"));
}

#[test]
fn a_machine_of_one_axis_never_pulses_along_y() {
    let folder = Folder::new();
    let bench = format!("max_axes = 1\n{DDA}[axis.x]\npulse = \"dx\"\n");
    let reaches = |to: [i64; 2]| {
        let model = written(&folder, &netlist("dda-line", &line([127, 127]), "--width 7", |_, _| {}), &bench);
        let report = run(model, &line(to), "");
        (report.outcome.reached == to.to_vec(), report.outcome.pulses.clone())
    };
    assert_eq!(reaches([100, 0]), (true, vec![100, 0]));
    assert_eq!(reaches([-3, 0]), (true, vec![3, 0]));
    assert!(!reaches([100, 60]).0);
}
