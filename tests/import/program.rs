//! Whole NC programs on netlists with a bench file: every block is what `run` makes of its displacement.

use std::fs;

use serde_json::Value;
use stepwave::models::{Model, find};
use stepwave::nc::{Arc, Curve, Direction, Line};
use stepwave::netlist::dsl::Module;
use stepwave::program::{Item, Preparation, Stream};
use stepwave::{Simulation, own};

use super::bench::{line, narrow, netlist, run, written};
use crate::cli::Folder;

/// `dda-line` of 7 bits.
const DDA: &str = "load = { jvx_in = \"abs(dx)\", jvy_in = \"abs(dy)\", sx_in = \"dx < 0\", sy_in = \"dy < 0\", e_in = \"1 << 7\" }\n\
    start = \"load\"\ndone = \"done\"\n[axis.x]\npulse = \"dx\"\n[axis.y]\npulse = \"dy\"\n";

/// What `program` says of a text in the folder of `own.net`: output and messages.
fn program(folder: &Folder, text: &str, options: &str, code: i32) -> String {
    fs::write(folder.path("part.ngc"), text).expect("written");
    let words = format!("program part.ngc --method own.net --blu 0.01mm {options}");
    let ran = folder.run_words(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(ran.code, code, "{words}: {ran:?}");
    ran.out + &ran.err
}

/// Its report.
fn report(folder: &Folder, text: &str, options: &str, code: i32) -> Value {
    program(folder, text, &format!("{options} --json r.json"), code);
    serde_json::from_str(&fs::read_to_string(folder.path("r.json")).expect("a report")).expect("JSON")
}

fn blocks(report: &Value) -> &[Value] {
    report["blocks"].as_array().map(Vec::as_slice).expect("blocks")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

#[test]
fn every_block_is_what_a_run_of_its_displacement_is() {
    let folder = Folder::new();
    let own = written(&folder, &netlist("dda-line", &line([127, 127]), "", |_, _| {}), DDA);
    // Dwells first and between, a chord of an arc, a move of no pulse, rapids, every direction.
    let text = "G21 G90 G4 P0.001\nG0 X1 Y0.6\nG1 X0.4 Y1.2 F60\nG4 P0.002\nX-0.5 Y-0.03\nX-0.5 Y-0.031\n\
        G2 X0.1 Y0.57 I0.6 J0\nG4 P0\nG1 X-1.17 Y0.57\nX-1.17 Y0.56\nG0 X0 Y0\nM30\n";
    let report = report(&folder, text, "--steps s.csv --vcd w.vcd --fst w.fst --plot p.svg", 0);
    assert_eq!(report["missed_end_points"], 0);
    assert_eq!((&report["reached"], &report["position_counters"]), (&[0, 0].into(), &[0, 0].into()));
    assert_eq!(report["left_out"]["moves"], 1);
    let ends = [[100, 60], [40, 120], [-50, -3], [10, 57], [-117, 57], [-117, 56], [0, 0]];
    let found: Vec<&Value> = blocks(&report).iter().map(|block| &block["end_point"]["wanted"]).collect();
    assert_eq!(found, ends.map(|[x, y]| Value::from(vec![x, y, 0])).iter().collect::<Vec<_>>());
    let mut from = [0, 0];
    for (block, to) in blocks(&report).iter().zip(ends) {
        assert_eq!(block["end_point"]["exact"], true, "{block}");
        let alone = run(own, &line([to[0] - from[0], to[1] - from[1]]), "");
        let pulses = [&block["pulses"]["x"], &block["pulses"]["y"]].map(|pulses| pulses.as_u64().expect("pulses"));
        if block["kind"] == "arc" {
            // Half a BLU of the chord and 1.5 of rounding besides what the lines are off.
            assert!(number(&block["compensated_contour_error"]) < 3.0, "{block}");
        } else {
            assert_eq!(pulses.to_vec(), alone.outcome.pulses, "{block}");
            assert_eq!(block["steps"], alone.outcome.steps, "{block}");
            let worst = alone.curve().and_then(|of| of.worst.as_ref()).map_or(0.0, |worst| worst.error);
            assert!((number(&block["path_error"]["greatest"]) - worst).abs() < 1e-9, "{block}: {worst}");
        }
        from = to;
    }
    let feed = blocks(&report).iter().map(|block| block["feed"]["source_hz"].is_null());
    assert!(feed.clone().all(|of_hardware| of_hardware) && feed.count() == ends.len());
    for file in ["s.csv", "w.vcd", "w.gtkw", "w.fst", "p.svg"] {
        assert!(folder.path(file).exists(), "{file}");
    }
    let wave = fs::read_to_string(folder.path("w.vcd")).expect("a wave");
    assert!(wave.contains("program part.ngc; method own.net; width"), "{}", &wave[..300]);
    let text = program(&folder, text, "--engine gates", 0);
    assert!(text.contains("feed: the hardware sets its own; F is reported as commanded"), "{text}");
    assert!(text.contains("60.0 → "), "{text}");
}

/// `ppc-arc` with one counter of both axes.
const PPC_ARC: &str = "load = { xi_in = \"abs(dx0)\", yi_in = \"abs(dy0)\", f_in = \"dx0*dx0 + dy0*dy0 - r*r\", \
    e_in = \"abs(dx) + abs(dy)\", quad_in = \"quadrant - 1\", ccw_in = \"!cw\" }\nstart = \"load\"\ndone = \"done\"\n";
const AXES: &str = "[axis.x]\npulse = \"dx\"\n[axis.y]\npulse = \"dy\"\n";

fn arc(from: [i64; 2], to: [i64; 2], center: [i64; 2], turn: Direction) -> Curve {
    Arc::new(from, to, center, turn).expect("an arc").into()
}

#[test]
fn arcs_are_loaded_whole_or_by_quadrants_as_the_bench_file_says() {
    let ccw = Direction::CounterClockwise;
    let text = netlist("ppc-arc", &arc([200, 0], [0, 200], [0, 0], ccw), "", |_, _| {});
    let parts = Folder::new();
    let own = written(&parts, &text, &format!("{PPC_ARC}split = \"quadrants\"\n{AXES}"));
    let whole = Folder::new();
    let once = written(&whole, &text, &format!("{PPC_ARC}{AXES}"));
    let three = arc([50, 0], [0, -50], [0, 0], ccw);
    let found = run(own, &three, "");
    assert!(found.failures().is_empty(), "{:?}", found.failures());
    assert_eq!((&found.outcome.reached[..], &found.outcome.pulses[..]), (&[0, -50][..], &[150, 150][..]));
    assert_eq!(found.curve().map(|of| of.blocks), Some(3));
    // As one block it has the steps of a displacement.
    assert_eq!(run(once, &three, "").outcome.pulses.iter().sum::<u64>(), 100);
    // Within a quadrant, through all, and a circle, from where the machine is.
    let program_text = "G21 G90 F60\nG3 X0.5 Y0.5 I0 J0.5\nG3 X0.5 Y0.5 I-0.5 J0\nG2 X-0.5 Y0.5 I-0.5 J0\n";
    let report = report(&parts, program_text, "", 0);
    let pulses: Vec<u64> = blocks(&report).iter().filter_map(|block| block["pulses"]["x"].as_u64()).collect();
    assert_eq!((pulses, &report["reached"]), (vec![50, 200, 100], &[-50, 50].into()));
    let refused = program(&parts, "G21 G90 F60\nG3 X0.5 Y0.5 I0 J0.5\nG1 X0\n", "", 2);
    assert!(
        refused.contains("part.ngc: line 3: ")
            && refused.contains("own.toml: it says that the hardware takes arcs alone"),
        "{refused}"
    );
    let wrong = Folder::new();
    fs::write(wrong.path("own.net"), netlist("dda-line", &line([127, 127]), "", |_, _| {})).expect("written");
    fs::write(wrong.path("own.toml"), format!("split = \"quadrants\"\n{DDA}")).expect("written");
    let refused = wrong.run_words(&["run", "own.net", "--to", "8,6"]);
    assert!(refused.code == 2 && refused.err.contains("own.toml:1: lines have no quadrants"), "{refused:?}");
}

#[test]
fn hardware_of_arcs_has_those_of_other_planes_and_helices_as_chords() {
    let folder = Folder::new();
    let line: Curve = Line::new(vec![0; 3], vec![127; 3]).expect("a line").into();
    let bench = format!("curves = \"both\"\n{DDA}[axis.z]\npulse = \"dz\"\n");
    let own = written(&folder, &netlist("dda-line", &line, "", |_, _| {}), &bench);
    let text = "G21 G90 F60 G3 X0.1 Y0.1 I0 J0.1\nG18 G2 X0.2 Z0.1 I0.1 K0\nG17 G2 X0.3 Y0.2 Z0.15 I0.1 J0\nG1 X0\n";
    let mut preparation = Preparation::default();
    preparation.reading.blu = 0.01;
    let stream = Stream::new(text.as_bytes(), own.moves().expect("moves"), &preparation).expect("a stream");
    let arcs = stream.map(|item| match item.expect("an item") {
        Item::Move(_, blocks) => blocks.iter().map(|block| matches!(block.curve, Curve::Arc(_))).collect(),
        other => panic!("{other:?}"),
    });
    let arcs: Vec<Vec<bool>> = arcs.collect();
    assert_eq!((&arcs[0][..], &arcs[3][..]), (&[true][..], &[false][..]));
    for chords in &arcs[1..3] {
        assert!(chords.len() > 1 && !chords.contains(&true), "{arcs:?}");
    }
}

/// A counter of pulses at a commanded rate: x alone, and a block of 13 pulses never ends.
fn paced(folder: &Folder, rate: &str) -> &'static Model {
    let module = Module::new("paced");
    let m = module.top();
    let (start, pulses, rate_in, back) =
        (m.input("start", 1), m.input("n", 8), m.input("rate", 32), m.input("back", 1));
    let (left, phase) = (m.reg("left", 8), m.reg("phase", 32));
    let (carry, sum) = phase.q.carrying_add(rate_in);
    let run = left.q.is_nonzero();
    let pulse = m.name("pulse", run & carry);
    phase.when(run, sum).else_hold();
    left.when(start, pulses).when(pulse, left.q.wrapping_sub(m.lit(8, 1))).else_hold();
    m.name("dir", back);
    m.name("zero", m.lit(1, 0));
    m.name("ready", !run & !pulses.equals(m.lit(8, 13)));
    let bench = format!(
        "load = {{ n = \"abs(dx)\", back = \"dx < 0\"{rate} }}\nstart = \"start\"\ndone = \"ready\"\n\
        [axis.x]\npulse = \"pulse\"\ndirection = \"dir\"\n[axis.y]\npulse = \"zero\"\n"
    );
    written(folder, &module.finish().expect("a netlist").to_string(), &bench)
}

#[test]
fn the_commanded_feed_paces_hardware_that_takes_it() {
    let folder = Folder::new();
    let own = paced(&folder, ", rate = \"rate\"");
    // 60 mm/min are 100 BLU a second, a pulse every 100 clocks of 10 kHz.
    let text = "G21 G90 G1 X0.4 F60\nX0 F240\nG0 X1\nG93 G1 X0.5 F6\nG94 G1 X1 F6000\n";
    let clocks =
        |report: &Value| -> Vec<u64> { blocks(report).iter().filter_map(|block| block["clocks"].as_u64()).collect() };
    let found = report(&folder, text, "--clock-hz 1e4", 0);
    // A pulse is counted a clock after it.
    let near = |clocks: u64, wanted: u64| clocks.abs_diff(wanted) <= 2 + wanted / 50;
    assert!(
        clocks(&found).into_iter().zip([4000, 1000, 100, 100_000, 50]).all(|(clocks, wanted)| near(clocks, wanted)),
        "{:?}",
        clocks(&found)
    );
    let reached = number(&blocks(&found)[0]["feed"]["reached_mm_per_min"]);
    assert!((59.0..62.0).contains(&reached), "{reached}");
    let rapid = report(&folder, text, "--clock-hz 1e4 --rapid 600", 0);
    assert!(near(clocks(&rapid)[2], 1000), "{:?}", clocks(&rapid));
    // More than a BLU a clock.
    let slow = program(&folder, text, "--clock-hz 1e3", 0);
    assert!(slow.contains("feed: the hardware sets it, by the commanded speed in `rate`"), "{slow}");
    let limited = program(&folder, text, "--clock-hz 9e3", 0);
    assert!(limited.contains("warning: 1 moves are commanded to go more than a BLU a clock"), "{limited}");
    // A run has no feed: as fast as it can.
    assert!(run(own, &line([50, 0]), "").outcome.clocks < 60);
    let without = Folder::new();
    paced(&without, "");
    let refused = program(&without, text, "--rapid 600", 2);
    assert!(
        refused.contains("--rapid 600: no expression of own.net reads rate, so the hardware sets its own feed"),
        "{refused}"
    );
}

#[test]
fn what_goes_wrong_in_a_program_is_said_with_its_line() {
    let folder = Folder::new();
    let own = paced(&folder, ", rate = 4294967295");
    let stalled = report(&folder, "G21 G90 F60 G1 X0.1\n\nX0.23\nX0.5\n", "", 1);
    assert_eq!((&stalled["ending"], &stalled["reached"]), (&"stalled".into(), &[23, 0].into()));
    let failure = stalled["failures"][0].as_str().expect("a failure");
    assert!(failure.starts_with("line 3: stalled at (23, 0)"), "{failure}");
    let long = program(&folder, "G21 G90 F60 G1 X0.1\nX3\n", "--vcd w.vcd", 2);
    assert!(
        long.contains("line 2: ")
            && long.contains("own.toml: load.n = abs(dx): 290 does not fit in its 8 bits, 0 to 255: divide the move"),
        "{long}"
    );
    assert!(!folder.path("w.vcd").exists());
    let cut = program(&folder, "G21 G90 F60 G1 X0.1\nX3\n", "--on-overflow wrap", 1);
    assert!(cut.contains("warning: line 2: load.n = 290 does not fit in its 8 bits: 34 was loaded"), "{cut}");
    assert!(cut.contains("line 2: the end point (300, 0, 0) was missed: the machine is at (44, 0, 0)"), "{cut}");
    let climbs = program(&folder, "G21 G90 F60 G1 X0.1\nX0.2 Z0.1\n", "", 2);
    assert!(
        climbs.contains("part.ngc: line 2: ")
            && climbs.contains("it says how x and y pulse, and this move goes along z: add [axis.z]"),
        "{climbs}"
    );
    for (option, said) in [("--width 8", "does not take --width"), ("--normalize", "does not take --normalize")] {
        let refused = program(&folder, "G21 G90 F60 G1 X0.1\n", option, 2);
        assert!(refused.contains(said), "{refused}");
    }
    assert!(Simulation::program(own, folder.path("none.ngc")).run().is_err());
    let family = folder.run_words(&["program", "part.ngc", "--method", "ppc", "--bench", "own.toml"]);
    assert!(family.code == 2 && family.err.contains("ppc-machine is a model of the catalogue"), "{family:?}");
}

#[test]
fn an_overflow_in_a_program_is_of_the_line_that_ran() {
    let folder = Folder::new();
    narrow(&folder);
    fs::rename(folder.path("t.net"), folder.path("own.net")).expect("renamed");
    fs::rename(folder.path("t.toml"), folder.path("own.toml")).expect("renamed");
    // Three pulses fit in its counter, nine do not.
    let text = "G21 G90 F60 G1 X0.03\nX0.05\nX0.14\nX0.16\n";
    let said = program(&folder, text, "", 0);
    assert!(said.contains("warning: line 3: overflow of t.narrow at clock"), "{said}");
    assert!(said.contains("(2 times, 3 bits would hold all)"), "{said}");
    assert_eq!(report(&folder, text, "", 0)["overflow"]["components"][0]["line"], 3);
    let strict = program(&folder, text, "--strict narrow", 1);
    assert!(strict.contains("stepwave: line 3: overflow of t.narrow at clock"), "{strict}");
    assert!(!program(&folder, text, "--wraps narrow", 0).contains("warning"));
}

#[test]
fn cases_and_exports_take_programs_of_own_hardware() {
    let folder = Folder::new();
    let path = folder.path("own.net").display().to_string();
    written(&folder, &netlist("dda-line", &line([127, 127]), "", |_, _| {}), DDA);
    fs::write(folder.path("part.ngc"), "G21 G90 G1 X0.08 Y0.06 F60\nG4 P0.001\nX0.01\n").expect("written");
    let case = "[[case]]\nname = \"part\"\nprogram = \"part.ngc\"\nargs = [\"--method=own.net\", \"--blu\", \"0.01mm\"]\n\
        [[case]]\nname = \"other\"\nprogram = \"part.ngc\"\nargs = [\"--blu\", \"0.01mm\", \"--method\", \"own.net\", \"--bench\", \"own.toml\"]\n";
    // The files of a case are in its folder.
    fs::create_dir(folder.path("waves")).expect("a folder");
    for file in ["own.net", "own.toml", "part.ngc"] {
        fs::copy(folder.path(file), folder.path("waves").join(file)).expect("a copy");
    }
    fs::write(folder.path("waves").join("cases.toml"), case).expect("written");
    fs::rename(folder.path("own.toml"), folder.path("bench.toml")).expect("renamed");
    for what in ["record", "check"] {
        let ran = folder.run_words(&["golden", what, "waves"]);
        assert_eq!(ran.code, 0, "{ran:?}");
    }
    fs::rename(folder.path("bench.toml"), folder.path("own.toml")).expect("renamed");
    let words = "export --program part.ngc --method own.net --blu 0.01mm --verilog own.v --testbench own_tb.v";
    let ran = folder.run_words(&words.split(' ').collect::<Vec<_>>());
    assert_eq!(ran.code, 0, "{ran:?}");
    // Neither file of the hardware is written over.
    let words = "export --program part.ngc --method own.net --blu 0.01mm --netlist own.net";
    assert_eq!(folder.run_words(&words.split(' ').collect::<Vec<_>>()).code, 2);
    assert_eq!(own::model(&path, None).map(|model| model.is_described()).ok(), Some(true));
    assert!(find("ppc-machine").is_ok_and(Model::is_buffered));
}

/// Hardware that is done one clock after its start, without a pulse.
const IDLE: &str = "netlist idle\n%0:1 = input\n%1:1 = register reset 0x0 next %0\n%2:1 = const 0x0\nname %0 in 0 \"go\" unsigned\n\
    name %1 in 0 \"ready\" unsigned\nname %2 in 0 \"px\" unsigned\nname %2 in 0 \"py\" unsigned\n";

#[test]
fn a_closed_curve_without_a_pulse_was_not_run() {
    let folder = Folder::new();
    folder.write("idle.net", IDLE);
    let bench =
        "curves = \"both\"\nstart = \"go\"\ndone = \"ready\"\n[axis.x]\npulse = \"px\"\n[axis.y]\npulse = \"py\"\n";
    folder.write("idle.toml", bench);
    let circle = "--from 5,0 --to 5,0 --center 0,0 --ccw";
    let ran = folder.run(&format!("run idle.net {circle}"));
    assert!(ran.code == 1 && ran.out.contains("end point (5, 0) missed: no pulse was given"), "{ran:?}");
    assert!(ran.err.contains("the closed curve from (5, 0) was not run: the machine gave no pulse"), "{ran:?}");
    let compared = folder.run(&format!("compare idle.net ppc-arc {circle}"));
    assert!(compared.out.contains("missed") && compared.out.contains("exact"), "{compared:?}");
    folder.write("circle.ngc", "G21 G17 G90 G0 X0.05\nG3 X0.05 Y0 I-0.05 J0 F100\nM2\n");
    let ran = folder.run("program circle.ngc --method idle.net --blu 0.01mm --clock-hz 1000 --json -");
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(
        ran.err.contains("line 2: the closed curve from (5, 0, 0) was not run")
            || ran.err.contains("line 1: the end point"),
        "{ran:?}"
    );
    // A third axis that the hardware does not have.
    let ran = folder.run("run idle.net --to 5,3,2");
    assert!(ran.code == 2 && ran.err.contains("the line has 3 axes, the hardware 2"), "{ran:?}");
    folder.write("idle.toml", &format!("set = {{ cfg = 0xffffffffffffffff }}\n{bench}"));
    let ran = folder.run("run idle.net --to 5,3");
    assert!(ran.code == 2 && ran.err.contains("in quotes"), "{ran:?}");
}
