//! The machines of whole programs against the recurrences of their methods, block by block.

use proptest::prelude::*;
use stepwave::testbench::{
    BlockReport, Ending, Feeder, Next, Observer, ObserverError, Outcome, OverflowEvent, OverflowWatch, Part,
    RangeWatch, RegisterRange, Step, Testbench,
};
use stepwave_engine::EngineKind;
use stepwave_models::options::{NORMALIZE, ON_OVERFLOW, PRESET, WIDTH};
use stepwave_models::parts::PULSE_RATE;
use stepwave_models::program::{FASTEST_SPEED, Moves, Size};
use stepwave_models::{Hardware, Model, OnOverflow, Options, Preset, Promise, Words, catalogue};
use stepwave_nc::{
    Arc, Cause, Curve, Direction, Feed, Line, Others, PathControl, Place, Plane, Position, PulseBlock, Rounder,
    Segment, SegmentShape, Side, ToolMove,
};

use crate::reference::{self, EndPoint, Form, cim_arc, cim_line, dpm_line, mindev_arc, mindev_line, ppc_arc, ppc_line};

/// A move of the tool without compensation.
pub(super) fn tool_move(from: [f64; 3], to: [f64; 3], shape: SegmentShape) -> ToolMove {
    let segment = Segment { from, to, shape };
    let (place, cause) = (Place { line: 1, number: None }, Cause::Programmed);
    ToolMove {
        place,
        segment,
        feed: Feed::Rapid,
        cause,
        programmed: segment,
        side: Side::On,
        path: PathControl::default(),
        others: Others::default(),
        chord: false,
    }
}

/// A place of the largest machine.
fn position([x, y, z]: [i64; 3]) -> Position {
    [x, y, z, 0, 0, 0, 0, 0, 0]
}

/// Gives the machine its blocks, each with this rate of the pulse source and as a block of its own.
pub(super) struct Control<'a> {
    bench: &'a Testbench,
    blocks: std::vec::IntoIter<(PulseBlock, Words)>,
    rate: i128,
    given: u64,
}

impl Control<'_> {
    pub(super) fn new(bench: &Testbench, blocks: Vec<(PulseBlock, Words)>, rate: i128) -> Control<'_> {
        Control { bench, blocks: blocks.into_iter(), rate, given: 0 }
    }
}

impl Feeder for Control<'_> {
    fn next(&mut self) -> Result<Next, ObserverError> {
        let Some((block, words)) = self.blocks.next() else { return Ok(Next::End) };
        let words = words.set(PULSE_RATE, self.rate);
        let encoded = self.bench.machine().encode(self.bench.hardware(), &[words])?;
        self.given += 1;
        Ok(Next::Block(encoded.into_iter().next().unwrap(), Some(Box::new(Part::new(self.given, block)))))
    }
}

/// Keeps what a machine does.
#[derive(Default)]
struct Keep {
    /// The path of each block of the machine.
    paths: Vec<Vec<[i64; 3]>>,
    /// Clocks of steps.
    clocks: Vec<u64>,
}

impl Observer for Keep {
    fn block_begun(&mut self, _: &BlockReport) -> Result<(), ObserverError> {
        self.paths.push(Vec::new());
        Ok(())
    }

    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        if step.number > 0 {
            self.clocks.push(step.clock);
            self.paths.last_mut().unwrap().push(<[i64; 3]>::try_from(step.position.as_slice()).unwrap());
        }
        Ok(())
    }
}

/// The blocks of the machine for these of a program.
pub(super) fn of_machine(moves: &dyn Moves, hardware: &Hardware, blocks: &[PulseBlock]) -> Vec<(PulseBlock, Words)> {
    let parts = |block: &PulseBlock| {
        moves
            .words(hardware, block, FASTEST_SPEED)
            .unwrap()
            .into_iter()
            .map(|part| (block.clone(), part.words))
            .collect::<Vec<_>>()
    };
    blocks.iter().flat_map(parts).collect()
}

/// What a machine did with some moves.
struct Ran {
    blocks: Vec<PulseBlock>,
    /// The path of each block of the program.
    paths: Vec<Vec<[i64; 3]>>,
    clocks: Vec<u64>,
    outcome: Outcome,
    hardware: Hardware,
    bits: u32,
}

fn machine(name: &str) -> &'static Model {
    catalogue().machines().find(|model| model.method_name() == name).unwrap()
}

fn run(model: &Model, moves: &[ToolMove], choices: &Options, engine: EngineKind) -> Ran {
    let mut rounder = Rounder::new((!model.moves().unwrap().arcs()).then_some(0.5));
    let mut blocks = Vec::new();
    moves.iter().for_each(|of| {
        rounder.blocks(of, &mut blocks).unwrap();
    });
    run_blocks(model, blocks, choices, engine)
}

fn run_blocks(model: &Model, blocks: Vec<PulseBlock>, choices: &Options, engine: EngineKind) -> Ran {
    let mut size = Size::default();
    blocks.iter().for_each(|block| size.add(model.moves().unwrap().crossing(), block));
    let hardware = model.plan_program(&size, choices).unwrap();
    let machine = model.machine(&hardware).unwrap();
    let bench = Testbench::of_machine(hardware, machine).limited(1 << 20);
    let words: Vec<_> = blocks
        .iter()
        .map(|block| model.moves().unwrap().words(bench.hardware(), block, FASTEST_SPEED).unwrap())
        .collect();
    let all = of_machine(model.moves().unwrap(), bench.hardware(), &blocks);
    let mut control = Control { bench: &bench, blocks: all.into_iter(), rate: 1 << 31, given: 0 };
    let mut keep = Keep::default();
    let outcome = bench.run_fed(engine, &mut control, &mut [&mut keep]).unwrap();
    let mut paths = keep.paths.into_iter();
    let paths = words.iter().map(|words| words.iter().flat_map(|_| paths.next().unwrap_or_default()).collect());
    let bits = ["xi", "a", "jvx", "q", "events", "accx"]
        .map(|name| bench.hardware().widths.get(name).map_or(0, |width| width.get()));
    let bits = bits.into_iter().max().unwrap();
    Ran { paths: paths.collect(), blocks, clocks: keep.clocks, outcome, hardware: bench.hardware().clone(), bits }
}

/// After i of 2^k accumulations an axis is at floor(d·i / 2^k) steps from its start.
fn stepgen_path(from: [i64; 2], to: [i64; 2], accumulations: usize) -> Vec<[i64; 2]> {
    assert!(accumulations.is_power_of_two());
    let count = accumulations as i64;
    let at = |i: i64| [0, 1].map(|axis| from[axis] + ((to[axis] - from[axis]) * i).div_euclid(count));
    (1..=count).map(at).collect()
}

/// The path of a block by the recurrences of the method, without its start.
pub(super) fn reference(family: &str, block: &PulseBlock, bits: u32, normalize: bool, steps: usize) -> Vec<[i64; 2]> {
    let [from, to] = [block.from, block.to].map(|[x, y, ..]| [x, y]);
    let half = [1 << (bits - 1); 2];
    let table = match &block.curve {
        Curve::Line(_) => match family {
            "ppc" => ppc_line(from, to, Form::Magnitude, EndPoint::PerAxis),
            "cim" => cim_line(from, to),
            "mindev" => mindev_line(from, to),
            "bresenham" => reference::bresenham(&from, &to, Form::Magnitude, false),
            "stepgen" => return stepgen_path(from, to, steps),
            "dda" => reference::dda_line(bits, &from, &to, &half, normalize, EndPoint::PerAxis),
            _ => dpm_line(bits, &from, &to),
        },
        Curve::Arc(arc) => {
            let (center, clockwise) = (arc.center(), arc.direction() == Direction::Clockwise);
            match family {
                "ppc" => ppc_arc(from, to, center, clockwise, EndPoint::PerAxis),
                "cim" => cim_arc(from, to, center, clockwise, reference::Weights::Mid),
                "mindev" => mindev_arc(from, to, center, clockwise, EndPoint::PerAxis),
                _ => reference::dda_arc(bits, from, to, center, clockwise, half, normalize, EndPoint::PerAxis),
            }
        }
        _ => panic!("neither line nor arc"),
    };
    table.path().into_iter().skip(1).collect()
}

/// Moves in the plane, each from where the one before ends: lines, and arcs about whole centres with both ends on them.
fn moves() -> impl Strategy<Value = Vec<ToolMove>> {
    let line = (-40i64..40, -40i64..40).prop_map(|(dx, dy)| (dx, dy, None));
    let quarter = (1i64..30, 0usize..4, 1usize..5, any::<bool>());
    // From a point on an axis through this many quadrants.
    let arc = quarter.prop_map(|(radius, axis, quarters, clockwise)| (radius, 0, Some((axis, quarters, clockwise))));
    // About the centre of a right triangle with sides 3, 4, 5.
    prop::collection::vec(prop_oneof![line, arc], 1..7).prop_map(|list| {
        let mut at = [0i64; 2];
        let real = |point: [i64; 2]| [point[0] as f64, point[1] as f64, 0.0];
        list.into_iter()
            .map(|(dx, dy, arc)| {
                let from = at;
                let Some((axis, quarters, clockwise)) = arc else {
                    at = [from[0] + dx, from[1] + dy];
                    return tool_move(real(from), real(at), SegmentShape::Line);
                };
                let about = |axis: usize| [[dx, 0], [0, dx], [-dx, 0], [0, -dx]][axis % 4];
                let start = about(axis);
                let end = about(if clockwise { axis + 4 - quarters } else { axis + quarters });
                let center = [from[0] - start[0], from[1] - start[1]];
                at = [center[0] + end[0], center[1] + end[1]];
                let direction = if clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
                let center = [center[0] as f64, center[1] as f64];
                tool_move(real(from), real(at), SegmentShape::Arc { plane: Plane::Xy, center, direction })
            })
            .collect()
    })
}

/// What a program is reported to have done.
#[derive(PartialEq, Debug)]
struct Reports {
    paths: Vec<Vec<[i64; 3]>>,
    clocks: Vec<u64>,
    outcome: Outcome,
    ranges: Vec<RegisterRange>,
    overflows: Vec<OverflowEvent>,
}

/// Runs a machine with a pulse every 2^`slow` clocks, and looks at every sample or not.
fn reports(model: &Model, moves: &[ToolMove], choices: &Options, slow: u32, every_sample: bool) -> Reports {
    let (mut rounder, mut blocks, mut size) =
        (Rounder::new((!model.moves().unwrap().arcs()).then_some(0.5)), Vec::new(), Size::default());
    moves.iter().for_each(|of| {
        rounder.blocks(of, &mut blocks).unwrap();
    });
    blocks.iter().for_each(|block| size.add(model.moves().unwrap().crossing(), block));
    let hardware = model.plan_program(&size, choices).unwrap();
    let bench = Testbench::of_machine(hardware.clone(), model.machine(&hardware).unwrap()).limited(1 << 20);
    let bench = if every_sample { bench } else { bench.without_wave() };
    let (blocks, rate) = (of_machine(model.moves().unwrap(), &hardware, &blocks).into_iter(), 1 << (32 - slow));
    let (mut control, mut keep) = (Control { bench: &bench, blocks, rate, given: 0 }, Keep::default());
    let (mut overflow, mut ranges) = (OverflowWatch::new(&bench), RangeWatch::new(&bench));
    let engine = if every_sample { EngineKind::Word } else { EngineKind::Compiled };
    let outcome = bench.run_fed(engine, &mut control, &mut [&mut keep, &mut overflow, &mut ranges]).unwrap();
    Reports { paths: keep.paths, clocks: keep.clocks, outcome, ranges: ranges.finish(), overflows: overflow.events() }
}

fn choices(normalize: bool) -> Options {
    Options::default().with(&NORMALIZE, normalize).with(&ON_OVERFLOW, OnOverflow::Trap)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(30) })]

    #[test]
    fn every_machine_steps_as_its_method_does(moves in moves(), normalize: bool) {
        for model in catalogue().machines() {
            let normalize = normalize && model.method_name() == "dda";
            let ran = run(model, &moves, &choices(normalize), EngineKind::Word);
            prop_assert_eq!(ran.outcome.ending, Ending::Done, "{}", model.method_name());
            prop_assert_eq!(ran.blocks.len(), ran.paths.len());
            for (block, path) in ran.blocks.iter().zip(&ran.paths) {
                let wanted = reference(model.method_name(), block, ran.bits, normalize, path.len());
                let path: Vec<[i64; 2]> = path.iter().map(|&[x, y, _]| [x, y]).collect();
                prop_assert_eq!(&path, &wanted, "{} {:?}", model.method_name(), block.curve);
            }
        }
    }

    #[test]
    fn pulses_keep_their_distance_across_blocks_and_no_clock_is_lost(moves in moves()) {
        for model in catalogue().machines() {
            let ran = run(model, &moves, &choices(false), EngineKind::Word);
            // An interpolator that is not ready for every pulse holds its source between two blocks.
            if ["stepgen", "bresenham"].contains(&model.method_name()) {
                continue;
            }
            // After a block of one step the next may not be in the buffer yet.
            if ran.paths.iter().all(|path| path.len() > 3) && ran.blocks.iter().all(|b| matches!(b.curve, Curve::Line(_))) {
                prop_assert!(ran.clocks.windows(2).all(|pair| pair[1] - pair[0] == 2), "{}", model.method_name());
            }
        }
    }

    #[test]
    fn all_engines_agree(moves in moves()) {
        for model in catalogue().machines() {
            let [word, compiled, gates] = [EngineKind::Word, EngineKind::Compiled, EngineKind::Gates]
                .map(|engine| run(model, &moves, &choices(false), engine));
            prop_assert_eq!(&word.clocks, &compiled.clocks);
            prop_assert_eq!(&word.paths, &compiled.paths);
            prop_assert_eq!(&word.clocks, &gates.clocks);
            prop_assert_eq!(&word.paths, &gates.paths);
        }
    }

    #[test]
    fn the_other_planes_do_the_same_with_other_axes(moves in moves()) {
        for model in catalogue().machines() {
            let flat = run(model, &moves, &choices(false), EngineKind::Word);
            for plane in [Plane::Zx, Plane::Yz] {
                let turned: Vec<ToolMove> = moves.iter().map(|of| {
                    let turn = |point: [f64; 3]| plane.point(point);
                    let shape = match of.segment.shape {
                        other @ (SegmentShape::Line | SegmentShape::Bezier(_)) => other,
                        SegmentShape::Arc { center, direction, .. } => SegmentShape::Arc { plane, center, direction },
                    };
                    tool_move(turn(of.segment.from), turn(of.segment.to), shape)
                }).collect();
                let ran = run(model, &turned, &choices(false), EngineKind::Word);
                let back: Vec<Vec<[i64; 3]>> = ran.paths.iter()
                    .map(|path| path.iter().map(|at| plane.axes().map(|axis| at[axis])).collect()).collect();
                // A line along one axis lies in two planes, so that only its ends need be the same.
                prop_assert_eq!(back.iter().map(|path| path.last().copied()).collect::<Vec<_>>(),
                    flat.paths.iter().map(|path| path.last().copied()).collect::<Vec<_>>());
                if moves.iter().all(|of| of.segment.shape != SegmentShape::Line) {
                    prop_assert_eq!(&back, &flat.paths, "{}", model.method_name());
                }
            }
        }
    }

    #[test]
    fn a_third_axis_follows_within_a_pulse(to in [-60i64..60, -60..60, -60..60], radius in 20i64..200, quarters in 1usize..5, part in -90i64..90) {
        let [x, y, z] = to.map(|c| c as f64);
        // Up to nine tenths of what a third axis can follow.
        let climb = part * radius * quarters as i64 / 100;
        let center = [x - radius as f64, y];
        let about = [[radius, 0], [0, radius], [-radius, 0], [0, -radius]][quarters % 4];
        let end = [center[0] + about[0] as f64, center[1] + about[1] as f64, z + climb as f64];
        let direction = Direction::CounterClockwise;
        let moves = [
            tool_move([0.0; 3], [x, y, z], SegmentShape::Line),
            tool_move([x, y, z], end, SegmentShape::Arc { plane: Plane::Xy, center, direction }),
        ];
        for model in catalogue().machines() {
            let ran = run(model, &moves, &choices(false), EngineKind::Word);
            prop_assert_eq!(ran.outcome.ending, Ending::Done);
            let reached: Vec<f64> = ran.outcome.reached.iter().map(|&c| c as f64).collect();
            prop_assert_eq!(reached, end.to_vec(), "{}", model.method_name());
            for (block, path) in ran.blocks.iter().zip(&ran.paths) {
                let worst = path.iter().map(|&at| block.deviation(&position(at))).fold(0.0, f64::max);
                let bound = model.moves().unwrap().promise(&ran.hardware, block).map_or(2.5, Promise::bound);
                prop_assert!(worst <= bound, "{}: {} off {:?}", model.method_name(), worst, block.curve);
            }
        }
    }
}

#[test]
fn an_integrator_that_would_be_off_an_axis_steps_at_once() {
    // From (3, 14) to (15, 0) clockwise about the origin in 8 bits: with half presets the pair stalls there.
    let arc = Arc::new([3, 14], [15, 0], [0, 0], Direction::Clockwise).unwrap();
    let line = Line::new(vec![0, 0, 0], vec![3, 14, 0]).unwrap();
    let block = |curve: Curve, from, to| {
        let of = tool_move([0.0; 3], [0.0; 3], SegmentShape::Line);
        let (axes, from, to) = (vec![0, 1], position(from), position(to));
        PulseBlock { of, axes, curve, from, to }
    };
    let blocks =
        [block(Curve::Line(line), [0; 3], [3, 14, 0]), block(Curve::Arc(arc), [3, 14, 0], [15, 0, 0])].to_vec();
    for preset in [Preset::Half, Preset::Zero, Preset::Full] {
        let width = Some(stepwave_netlist::Width::new(8).unwrap());
        let choices = choices(false).with_all(&PRESET, preset).with_all(&WIDTH, width);
        let ran = run_blocks(machine("dda"), blocks.clone(), &choices, EngineKind::Word);
        assert_eq!((ran.outcome.ending, ran.outcome.reached), (Ending::Done, vec![15, 0, 0]), "{preset}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(4) })]

    #[test]
    fn a_report_is_the_same_where_idle_clocks_are_passed_over(moves in moves(), slow in 6u32..9, narrow: bool) {
        for model in catalogue().machines() {
            // The position overflows during the run; the loops are compiled after 16384 clocks.
            let widths = [("x".to_owned(), stepwave_netlist::Width::new(4).unwrap())].into_iter().filter(|_| narrow);
            let choices = Options::default().with(&ON_OVERFLOW, OnOverflow::Wrap).with_single(&WIDTH, widths.collect());
            let moves: Vec<ToolMove> = moves.iter().cycle().take(if model.moves().unwrap().arcs() { 12 } else { 3 }).copied().collect();
            let all = reports(model, &moves, &choices, slow, true);
            let some = reports(model, &moves, &choices, slow, false);
            prop_assert_eq!(all, some, "{}", model.method_name());
        }
    }
}
