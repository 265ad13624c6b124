//! What many samples come to is what a look at each of them finds.

use proptest::prelude::*;
use stepwave_engine::{Ahead, Digest, Engine, EngineKind, Extremes, Form, Rows, Term, Wanted, Watch, digesting_after};
use stepwave_netlist::dsl::Module;
use stepwave_netlist::{Design, Net, bits, elaborate};

use super::random::config;
use super::random::recipe::{build, recipe};

/// Clocks of a run.
const CLOCKS: u64 = 40_000;

/// Every net in every sample of a run that nothing stops.
struct Recorded {
    design: Design,
    rows: Rows,
}

impl Recorded {
    fn of(design: Design, inputs: &[(Net, u64)]) -> Recorded {
        Recorded::of_clocks(design, inputs, CLOCKS)
    }

    fn of_clocks(design: Design, inputs: &[(Net, u64)], clocks: u64) -> Recorded {
        let columns: Vec<Net> = design.netlist().nets().collect();
        let mut rows = Rows::new(columns.len(), usize::try_from(clocks).unwrap() + 1);
        let mut engine = EngineKind::Word.build(&design, &Watch { columns, stops: Vec::new() });
        start(engine.as_mut(), inputs, &mut rows);
        engine.run(clocks, &mut rows);
        Recorded { design, rows }
    }

    /// Of a machine without inputs that is put into a state.
    fn from_state(design: &Design, registers: &[u64], clocks: u64) -> Recorded {
        let columns: Vec<Net> = design.netlist().nets().collect();
        let mut rows = Rows::new(columns.len(), usize::try_from(clocks).unwrap() + 1);
        let mut engine = EngineKind::Word.build(design, &Watch { columns: columns.clone(), stops: Vec::new() });
        engine.restore(0, registers, &[], &[]);
        rows.push(0, |column| engine.value(columns[column]));
        engine.run(clocks, &mut rows);
        Recorded { design: design.clone(), rows }
    }

    fn value(&self, net: Net, clock: u64) -> u64 {
        self.rows.value(net.index(), usize::try_from(clock).unwrap())
    }

    /// What the number of a form is at a clock.
    fn form(&self, form: &Form, clock: u64) -> i64 {
        let number = |term: &Term| bits::to_signed(self.design.netlist().width(term.net), self.value(term.net, clock));
        form.terms().iter().map(|term| number(term) * term.linear + number(term).pow(2) * term.square).sum()
    }

    /// Extremes over some clocks, after those of the sample before.
    fn extremes(&self, net: Net, turned: u64, clocks: std::ops::Range<u64>) -> Extremes {
        let at = |clock: u64| self.value(net, clock) ^ turned;
        let one = |value: u64| Extremes { least: value, greatest: value, first: value, toggled: 0 };
        clocks.map(at).fold(one(at(0)), |all, value| all.and(one(value)))
    }
}

fn start(engine: &mut dyn Engine, inputs: &[(Net, u64)], rows: &mut Rows) {
    for &(net, value) in inputs {
        engine.set_input(net, value);
    }
    engine.reset(rows);
}

/// Takes digests wherever there are some, and compares each; their number.
fn compare(recorded: &Recorded, inputs: &[(Net, u64)], wanted: &Wanted, strides: &[u64]) -> Result<u64, TestCaseError> {
    let mut engine = digesting(&recorded.design, wanted);
    start(engine.as_mut(), inputs, &mut Rows::new(1, 512));
    compare_on(engine.as_mut(), recorded, wanted, strides)
}

fn digesting(design: &Design, wanted: &Wanted) -> Box<dyn Engine> {
    let watch = Watch { columns: vec![design.registers()[0]], stops: Vec::new() };
    digesting_after(design, &watch, wanted, 64)
}

/// The same with an engine that is in its first sample.
fn compare_on(
    engine: &mut dyn Engine,
    recorded: &Recorded,
    wanted: &Wanted,
    strides: &[u64],
) -> Result<u64, TestCaseError> {
    let (design, mut taken, mut digest) = (&recorded.design, 0, Digest::default());
    let end = recorded.rows.len() as u64 - 1;
    let mut rows = Rows::new(1, 512);
    let (mut past, mut shown) = (vec![None; wanted.ranges.len()], 0);
    for &stride in strides.iter().cycle() {
        rows.clear();
        let clock = engine.clock();
        if clock + stride >= end {
            break;
        }
        if engine.look_ahead(end - clock, &mut digest) != Ahead::Digest {
            engine.run(stride, &mut rows);
            continue;
        }
        taken += 1;
        prop_assert_eq!(engine.clock(), clock, "looking changes nothing");
        prop_assert_eq!(digest.first_clock, clock + 1);
        let clocks = clock + 1..clock + 1 + digest.clocks;
        // Extremes up to the digest continue those up to the one before.
        for (past, &(net, turned)) in past.iter_mut().zip(&wanted.ranges) {
            let since = recorded.extremes(net, turned, shown..clocks.start);
            *past = Some(past.map_or(since, |past: Extremes| past.and(since)));
        }
        shown = clocks.start;
        check(recorded, wanted, &digest, clocks.clone(), &past)?;
        engine.skip_ahead();
        prop_assert_eq!(engine.clock(), clocks.end - 1);
        for net in design.netlist().nets() {
            prop_assert_eq!(
                engine.value(net),
                recorded.value(net, clocks.end - 1),
                "{} after {:?}",
                net.index(),
                clocks
            );
        }
    }
    Ok(taken)
}

fn check(
    recorded: &Recorded,
    wanted: &Wanted,
    digest: &Digest,
    clocks: std::ops::Range<u64>,
    past: &[Option<Extremes>],
) -> Result<(), TestCaseError> {
    for &net in &wanted.never {
        prop_assert!(clocks.clone().all(|clock| recorded.value(net, clock) == 0), "flag {}", net.index());
    }
    for ((&(net, turned), &found), &past) in wanted.ranges.iter().zip(&digest.ranges).zip(past) {
        // The sample before may be among them.
        let before = recorded.extremes(net, turned, clocks.start - 1..clocks.start);
        let wanted = before.and(recorded.extremes(net, turned, clocks.clone()));
        let found = before.and(found);
        let all = past.unwrap();
        prop_assert_eq!(all.and(found), all.and(wanted), "range of {}\n{}", net.index(), recorded.design.netlist());
    }
    for (&net, train) in wanted.trains.iter().zip(&digest.trains) {
        let bits = train.iter().flat_map(|word| (0..digest.span).map(move |bit| word >> bit & 1 == 1));
        prop_assert!(bits.eq(clocks.clone().map(|clock| recorded.value(net, clock) != 0)), "train of {}", net.index());
    }
    for (form, &[least, greatest]) in wanted.forms.iter().zip(&digest.forms) {
        let before = recorded.form(form, clocks.start - 1);
        let all = || clocks.clone().map(|clock| recorded.form(form, clock)).chain([before]);
        let found = (least.min(before), greatest.max(before));
        prop_assert_eq!(Some(found), all().min().zip(all().max()), "{:?}", form);
    }
    Ok(())
}

/// A machine as an interpolator is one: a ring of beats, accumulators whose carries step counters at one of the beats.
#[derive(Clone, Debug)]
struct Shape {
    period: u64,
    beats: [u64; 3],
    bits: [u32; 4],
    increments: [u64; 2],
    start: i64,
    backward: bool,
}

fn shape() -> impl Strategy<Value = Shape> {
    let beats = prop::array::uniform3(0u64..8);
    let bits = prop::array::uniform4(3u32..42);
    let increments = prop::array::uniform2(any::<u64>());
    (1u64..=8, beats, bits, increments, any::<i64>(), any::<bool>()).prop_map(
        |(period, beats, bits, increments, start, backward)| {
            let beats = beats.map(|beat| beat % period);
            Shape { period, beats, bits, increments, start, backward }
        },
    )
}

fn machine(of: &Shape) -> (Design, Wanted, Vec<(Net, u64)>) {
    let module = Module::new("machine");
    let m = module.top();
    let beat = m.reg("beat", 4);
    let last = beat.q.equals(m.lit(4, of.period - 1));
    beat.set(last.mux(m.lit(4, 0), beat.q.wrapping_add(m.lit(4, 1))));
    let backward = m.input("backward", 1);
    let direction = m.reg("direction", 1);
    direction.when(m.lit(1, 1), backward).else_hold();
    let mut wanted = Wanted::default();
    let mut inputs = vec![(backward.net(), u64::from(of.backward))];
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let scope = m.scope(name);
        let increment = scope.input("increment", of.bits[axis]);
        inputs.push((increment.net(), of.increments[axis]));
        let sum = scope.reg("sum", of.bits[axis]);
        let (carry, more) = sum.q.carrying_add(increment);
        let now = beat.q.equals(m.lit(4, of.beats[axis]));
        sum.when(now, more).else_hold();
        let step = carry & now;
        let pulse = scope.reg("pulse", 2);
        pulse.set((step & direction.q).concat(step));
        let place = scope.reg_signed("place", of.bits[2]);
        let one = m.lit_signed(2, 1);
        let back = place.q.strict_sub(one, step & direction.q);
        place
            .when(step & direction.q, back)
            .when(step & !direction.q, place.q.strict_add(one, step & !direction.q))
            .else_hold();
        let left = scope.reg("left", of.bits[3]).reset(of.start.unsigned_abs() & ((1 << of.bits[3]) - 1));
        left.when(step, left.q.strict_sub(m.lit(1, 1), step)).else_hold();
        let short = scope.reg("short", 5);
        short.when(step, short.q.wrapping_add(m.lit(5, 1))).else_hold();
        let either = scope.reg_signed("either", 9);
        let up = sum.q.bit(1);
        let moved = up.mux(either.q.wrapping_add(m.lit_signed(9, 1)), either.q.wrapping_sub(m.lit_signed(9, 1)));
        either.when(beat.q.equals(m.lit(4, of.beats[2])), moved).else_hold();
        wanted.trains.extend([pulse.q.net(), step.net(), now.net(), sum.q.net()]);
    }
    let design = elaborate(module.finish().unwrap()).unwrap();
    let netlist = design.netlist();
    wanted.never = netlist.properties.iter().map(|property| property.never).collect();
    for named in netlist.names.iter().filter(|named| design.registers().contains(&named.net)) {
        let turned = if named.format.reading().is_signed() { netlist.width(named.net).sign_bit() } else { 0 };
        wanted.range(named.net, turned);
    }
    let places: Vec<Net> = netlist.names.iter().filter(|named| named.name == "place").map(|named| named.net).collect();
    let term = |axis: usize, linear, square| Term { net: places[axis], linear, square };
    for terms in [vec![term(0, -5, 0), term(1, 17, 0)], vec![term(0, 3, 1), term(1, -2, 1)]] {
        wanted.forms.extend(Form::new(netlist, terms));
    }
    (design, wanted, inputs)
}

proptest! {
    #![proptest_config(config(10))]

    #[test]
    fn digests_of_interpolating_machines_are_those_of_their_samples(
        shape in shape(), strides in prop::collection::vec(1u64..400, 1..8),
    ) {
        let (design, wanted, inputs) = machine(&shape);
        compare(&Recorded::of(design, &inputs), &inputs, &wanted, &strides)?;
    }

    #[test]
    fn digests_of_random_netlists_are_those_of_their_samples(
        recipe in recipe(), picks in prop::collection::vec(any::<prop::sample::Index>(), 12),
        flags in 0usize..3, strides in prop::collection::vec(1u64..400, 1..8), value in any::<u64>(),
    ) {
        let design = elaborate(build(&recipe)).unwrap();
        prop_assume!(!design.registers().is_empty());
        let netlist = design.netlist();
        let nets: Vec<Net> = netlist.nets().collect();
        let mut wanted = Wanted::default();
        for (number, &register) in design.registers().iter().enumerate() {
            wanted.range(register, if number % 2 == 0 { netlist.width(register).sign_bit() } else { 0 });
        }
        let (few, many) = picks.split_at(4);
        let bits = nets.iter().copied().filter(|&net| netlist.width(net).get() == 1).collect::<Vec<_>>();
        wanted.never = few.iter().take(flags).filter(|_| !bits.is_empty()).map(|pick| *pick.get(&bits)).collect();
        wanted.trains = many.iter().map(|pick| *pick.get(&nets)).collect();
        let terms = few.iter().map(|pick| Term { net: *pick.get(&nets), linear: 3, square: -1 }).collect();
        wanted.forms.extend(Form::new(netlist, terms));
        let inputs: Vec<(Net, u64)> = design.inputs().iter().map(|&net| (net, value)).collect();
        compare(&Recorded::of(design, &inputs), &inputs, &wanted, &strides)?;
    }
}

/// The test above would pass too if there were never a digest.
#[test]
fn machines_of_every_period_have_digests() {
    for period in 1..=8 {
        let shape = Shape {
            period,
            beats: [0, 1 % period, 2 % period],
            bits: [20, 33, 24, 24],
            increments: [777_777, 5_555_555_555],
            start: (1 << 24) - 1,
            backward: period % 2 == 0,
        };
        let (design, wanted, inputs) = machine(&shape);
        let taken = compare(&Recorded::of(design, &inputs), &inputs, &wanted, &[256]).unwrap();
        assert!(taken > 0, "none of period {period}");
    }
}

/// A counter that moves in every clock and comes to the end of its range after any number of clocks: its flag is 1 in that
/// sample, and it is the last of a digest in some of these runs.
#[test]
fn a_flag_that_rises_in_the_last_sample_of_a_digest_is_seen() {
    for up in [true, false] {
        let module = Module::new("counter");
        let m = module.top();
        let count = m.reg_signed("count", 17);
        let (one, enable) = (m.lit_signed(2, 1), m.lit(1, 1));
        count.set(if up { count.q.strict_add(one, enable) } else { count.q.strict_sub(one, enable) });
        let design = elaborate(module.finish().unwrap()).unwrap();
        let netlist = design.netlist();
        let register = design.registers()[0];
        let never = netlist.properties.iter().map(|property| property.never).collect();
        let ranges = vec![(register, netlist.width(register).sign_bit())];
        let wanted = Wanted { never, ranges, ..Wanted::default() };
        // One machine for all of them: its loops are compiled once.
        let mut engine = digesting(&design, &wanted);
        for clocks in 4000..6048 {
            let first = if up { 0xffff - clocks } else { 0x1_0000 + clocks };
            engine.restore(0, &[first], &[], &[]);
            let recorded = Recorded::from_state(&design, &[first], 8000);
            let taken = compare_on(engine.as_mut(), &recorded, &wanted, &[256]).unwrap();
            assert!(taken > 0, "no digest, end of the range after {clocks} clocks");
        }
    }
}

/// A counter that goes down by itself and comes to a number with which it is compared after any number of clocks, in the first
/// or in the last sample of a digest in some of these runs.
#[test]
fn a_comparison_that_ends_a_counter_is_seen_in_every_sample() {
    for end in [0, 1, 15, 16, 1000] {
        let module = Module::new("ending");
        let m = module.top();
        let (count, ended) = (m.reg("count", 20), m.reg("ended", 8));
        let is_there = count.q.equals(m.lit(20, end));
        count.set(count.q.wrapping_sub(m.lit(20, 1)));
        ended.set(ended.q.wrapping_add(is_there.extend(8)));
        let design = elaborate(module.finish().unwrap()).unwrap();
        let ended = design.registers()[1];
        let wanted = Wanted { ranges: vec![(ended, 0)], ..Wanted::default() };
        let mut engine = digesting(&design, &wanted);
        for clocks in (4000..6200).step_by(3) {
            let first = [end + clocks, 0];
            engine.restore(0, &first, &[], &[]);
            let recorded = Recorded::from_state(&design, &first, 8000);
            let taken = compare_on(engine.as_mut(), &recorded, &wanted, &[256]).unwrap();
            assert!(taken > 0, "no digest, {end} after {clocks} clocks");
        }
    }
}

#[test]
fn a_form_that_might_leave_62_bits_is_refused() {
    let module = Module::new("m");
    let m = module.top();
    let (narrow, wide) = (m.input("narrow", 31).net(), m.input("wide", 40).net());
    let netlist = module.finish().unwrap();
    let form = |net, linear, square| Form::new(&netlist, vec![Term { net, linear, square }]);
    assert!(form(narrow, 1, 1).is_some() && form(narrow, 1 << 32, 0).is_some() && form(narrow, 0, 4).is_some());
    assert!(form(narrow, 1 << 33, 0).is_none() && form(narrow, 1, 4).is_none() && form(wide, 0, 1).is_none());
}
