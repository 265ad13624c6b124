//! `dda-line`: digital differential analyser, DDA (数字积分法), line of 2 to 6 axes.
//!
//! ```text
//!   for each axis i:      jvi ──► + ──► jri ──┐       2^n iterations
//!                                 ▲───────────┘       e ──► done
//!                                 │ carry
//!                                 └──► di ──► position i
//!
//!   with --adder serial:  jvi ──┬──► full ──► jri ──┐       n clocks an iteration
//!                          ▲────┘    adder          │
//!                                  ▲  ▲─────────────┘
//!                                  └──┴─ carry flip-flop; behind the last bit it is di
//! ```
//!
//! | register | width | load value |
//! |---|---|---|
//! | jvx, jvy, … | n | integrand J_V = abs(d) |
//! | jrx, jry, … | n | remainder J_R: the preset |
//! | e | n+1 | 2^n iterations (`iterations`), all steps (`total`), steps of the longest axis (`longest`) |
//! | ex, ey, … | n | steps of each axis (`per-axis`) |
//! | carry | 1 | kept carry of each axis (`--adder serial`) |
//! | place | as it needs | the bit, in radix 10 the digit, that is added next (`--adder serial`) |
//!
//! On every iteration {carry, J_R} := J_R + J_V; the carry is the axis's pulse. After t iterations the axis stands at
//! floor((t·abs(d) + P) / 2^n): at d after 2^n, for every preset P, and J_R is back at P. 2^n must be greater than every
//! abs(d). Normalised, all J_V are shifted left by the same Q until the largest has its top bit set, one bit a clock,
//! and e is halved as often: 2^(n-Q) iterations.
//!
//! The line (8, 6) in 4 bits, from the golden file `waves/dda-line-8-6.csv`; the wave stands beside it:
//!
//! ```text
#![doc = include_str!("../waves/dda-line-8-6.csv")]
//! ```
//!
//! Radix 10: J_V and J_R hold k BCD digits of 4 bits (n = 4k), each added by a binary adder whose sum beyond 9 is
//! corrected by 6 and carries to the next digit; 10^k iterations, which e counts in binary, as all end-point counters
//! do. The same line in one digit, from `waves/dda-line-decimal.csv`:
//!
//! ```text
#![doc = include_str!("../waves/dda-line-decimal.csv")]
//! ```
//!
//! Serial adder: one full adder and a carry flip-flop for each axis, the lowest bit first. J_R is a shift register, J_V
//! goes round, and an iteration takes n clocks; with its last one the step is completed and all registers stand as those
//! of the parallel form. In radix 10 one digit adder for each axis takes a digit a clock, k clocks an iteration. The
//! line (8, 6) in 4 bits, from `waves/dda-line-serial.csv`:
//!
//! ```text
#![doc = include_str!("../waves/dda-line-serial.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::Width;
use stepwave_netlist::dsl::Scope;
use stepwave_netlist::formula::{Clause, Formula, name, number};

use crate::claims::{Claims, Region, steps_left};
use crate::error::ModelError;
use crate::hardware::names::{END, JR, JV, LONGEST, POSITION, SIGN};
use crate::hardware::{Hardware, Pace, modulus};
use crate::machine::Words;
use crate::model::{Interpolates, Method, Model, RegisterDoc};
use crate::options::{ADDER, Adder, END_POINT, EndPoint, NORMALIZE, ON_OVERFLOW, PRESET, RADIX, Radix, WIDTH};
use crate::parts::{
    Block, DownCounter, Iteration, Normalizer, axis_counter, digits, integrator, population_count, rotated,
    shifted_left,
};
use crate::plan::Plan;
use crate::sizes;

const NAME: &str = "dda-line";

/// Digital differential analyser, line of 2 to 6 axes.
pub static MODEL: Model = Model {
    name: NAME,
    title: "Digital differential analyser, line of 2 to 6 axes",
    method: "digital differential analyser",
    source: "数字积分法, the DDA linear interpolator of early NC systems, as in Chinese NC textbooks",
    registers: &[
        RegisterDoc { name: "jvx, jvy, …", width: "n", about: "integrand J_V of each axis, |d|" },
        RegisterDoc { name: "jrx, jry, …", width: "n", about: "remainder J_R of each axis, from the preset" },
        RegisterDoc { name: "e", width: "n+1", about: "end-point down-counter (iterations, total, longest)" },
        RegisterDoc { name: "ex, ey, …", width: "n", about: "end-point down-counter of each axis (per-axis)" },
        RegisterDoc { name: "place", width: "as it needs", about: "digit that is added next, 0 the lowest (serial)" },
        RegisterDoc::AXIS_POSITIONS,
    ],
    options: &[
        &WIDTH.about("N or REGISTER=N,… (default: the least that holds the line)"),
        &PRESET,
        &NORMALIZE,
        &RADIX.only(
            Some(Radix::Binary),
            &[(Radix::Binary, ""), (Radix::Decimal, ", BCD digits of 4 bits, not normalised")],
            "",
        ),
        &ADDER.only(Some(Adder::Parallel), &[(Adder::Parallel, ""), (Adder::Serial, ", a digit a clock")], ""),
        &END_POINT.only(
            Some(EndPoint::Iterations),
            &[(EndPoint::Iterations, ""), (EndPoint::Total, ""), (EndPoint::PerAxis, ""), (EndPoint::Longest, "")],
            "",
        ),
        &ON_OVERFLOW,
    ],
    claims: Some(Claims {
        told_apart: |hardware| (hardware.get(&END_POINT) == EndPoint::Longest).then_some(Region::LinesByLength),
        rank,
        guesses,
        ..Claims::of(Region::Lines)
    }),
    interpolates: Interpolates::Lines(6, Method { plan, load }),
    hardware,
};

/// Iterations left of 2^n; where an axis stops by itself, what the remainders and the ends of both axes want of pulses.
fn rank(hardware: &Hardware) -> Option<Formula> {
    let modulus = || name("2^k");
    match hardware.get(&END_POINT) {
        EndPoint::Iterations => steps_left(hardware),
        EndPoint::Total | EndPoint::Longest => Some(modulus() - name("steps")),
        EndPoint::PerAxis => Some((name("ex") + name("ey") + 2) * modulus() - name("jrx") - name("jry")),
    }
}

/// What 2^n iterations have to do with a way that is left.
fn guesses(hardware: &Hardware) -> Vec<Clause> {
    if !matches!(hardware.get(&END_POINT), EndPoint::Total | EndPoint::Longest) {
        return Vec::new();
    }
    let left = [0, 1].map(|i| name(JV[i]) - (number(1) - 2 * name(SIGN[i])) * name(POSITION[i]));
    let early = || name("2^k") - 1 - name("steps");
    let ended = left.clone().map(|left| Clause::either("all iterations end an axis", [-left, early()]));
    [vec![Clause::either("an axis has not ended", left.map(|left| left - 1))], ended.to_vec()].concat()
}

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    let (axes, radix) = (plan.axes(), plan.get(&RADIX));
    let n = plan.magnitude_bits(sizes::longest(line));
    if radix == Radix::Decimal && plan.get(&NORMALIZE) {
        return Err(ModelError::Value {
            model: NAME,
            option: NORMALIZE.name,
            value: "with --radix 10".to_owned(),
            reason:
                "decimal registers shift by whole digits, which leaves the first digit as small as it was, and the \
                     iterations would have to be divided by 10: leave one of both out"
                    .to_owned(),
        });
    }
    for axis in 0..axes {
        plan.register(JV[axis], n).register(JR[axis], n);
    }
    // End points are counted in binary, whatever the radix.
    let steps = Width::needed_unsigned(modulus(radix, n) - 1);
    let end_point = plan.get(&END_POINT);
    match end_point {
        EndPoint::PerAxis => plan.end_counters(axes, steps),
        // The sum of up to 2, 4 or 6 axes.
        EndPoint::Total => plan.register("e", steps + axes.next_power_of_two().trailing_zeros()),
        EndPoint::Iterations => plan.register("e", Width::needed_unsigned(modulus(radix, plan.bits(JR[0])))),
        EndPoint::Longest => plan.register("e", steps + 1),
    };
    plan.positions(sizes::end_positions(line));
    let clocks = match plan.get(&ADDER) {
        Adder::Parallel => 1,
        Adder::Serial => plan.bits(JR[0]) / radix.digit_bits(),
    };
    plan.integrators(clocks.into())?;
    // With unequal presets one axis may lead while another lags.
    let equal = plan.presets()?.windows(2).all(|pair| pair[0] == pair[1]);
    plan.error_bound = (axes == 2 && end_point == EndPoint::Iterations && equal).then_some(1.0);
    plan.pace = Pace::Cycle(JR[0]);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let axes = 0..hardware.axes;
    let bits = |name: &str| hardware.bits(name);
    let block = Block::new(m);
    let normalizer = Normalizer::new(m, &block, hardware.get(&NORMALIZE));
    let scopes: Vec<_> = hardware.letters().iter().map(|letter| m.scope(&format!("axis_{letter}"))).collect();
    let integrand = |i: usize| scopes[i].reg(JV[i], bits(JV[i])).shown(digits(hardware));
    let integrands: Vec<_> = axes.clone().map(integrand).collect();
    let normalized = normalizer.close(&integrands.iter().map(|jv| jv.q).collect::<Vec<_>>(), 1);

    let counters: Option<Vec<_>> = (hardware.get(&END_POINT) == EndPoint::PerAxis)
        .then(|| axes.clone().map(|i| DownCounter::new(scopes[i], &block, END[i], bits(END[i]))).collect());
    if counters.is_some() {
        let left = axes.clone().map(|i| name(END[i])).fold(number(-1), |sum, end| sum + end);
        m.between_steps("a_way_is_left", [left]);
    }
    let iteration = Iteration::new(m, &block, hardware, normalized.run);
    let mut pulses = Vec::new();
    for i in axes {
        let (scope, jv) = (scopes[i], integrands[i]);
        // An exhausted axis stops adding.
        let step = counters.as_ref().map_or(iteration, |counters| iteration.only(counters[i].running()));
        let loaded = jv
            .when(block.load, block.word_in(hardware.get(&RADIX), JV[i], bits(JV[i])))
            .when(normalized.shift, shifted_left(scope, jv.q));
        match hardware.get(&ADDER) {
            Adder::Parallel => loaded.else_hold(),
            Adder::Serial => loaded.when(step.add, rotated(hardware, jv.q)).else_hold(),
        }
        let pulse = integrator(scope, &block, hardware, i, jv.q, step);
        let negative = block.held(scope, SIGN[i], 1);
        axis_counter(scope, &block, POSITION[i], bits(POSITION[i]), pulse, negative);
        pulses.push(pulse);
    }

    let e = || DownCounter::new(m, &block, "e", bits("e"));
    let last = match (hardware.get(&END_POINT), counters) {
        (_, Some(counters)) => {
            let ended = counters.into_iter().zip(&pulses).map(|(counter, pulse)| counter.count(*pulse));
            ended.reduce(|a, b| a & b).unwrap_or(block.load)
        }
        (EndPoint::Total, None) => e().count_pulses(population_count(m, 3, &pulses)),
        (EndPoint::Longest, None) => {
            let longest = (0..hardware.axes).map(|i| block.held(scopes[i], LONGEST[i], 1) & pulses[i]);
            e().count(longest.reduce(|a, b| a | b).unwrap_or(block.load))
        }
        (_, None) => e().count_or_halve(iteration.complete, normalized.shift),
    };
    block.close(normalized.ready, iteration.complete, last);
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let delta: Vec<i128> = line.delta().into_iter().map(i128::from).collect();
    let way = |axis: usize| delta[axis].abs();
    let longest = (0..hardware.axes).rev().max_by_key(|&axis| way(axis)).unwrap_or(0);
    let mut words = Words::new();
    for axis in 0..hardware.axes {
        words.push((JV[axis], way(axis)));
        words.push((JR[axis], hardware.preset(axis, JR[axis])));
        words.push((SIGN[axis], i128::from(delta[axis] < 0)));
        words.push((POSITION[axis], i128::from(line.from()[axis])));
        match hardware.get(&END_POINT) {
            EndPoint::PerAxis => words.push((END[axis], way(axis))),
            EndPoint::Longest => words.push((LONGEST[axis], i128::from(axis == longest))),
            EndPoint::Total | EndPoint::Iterations => {}
        }
    }
    match hardware.get(&END_POINT) {
        EndPoint::Iterations => {
            // At most 2^64.
            let iterations = hardware.modulus(hardware.bits(JR[0]));
            words.push(("e", i128::try_from(iterations).unwrap_or(i128::MAX)));
        }
        EndPoint::Total => words.push(("e", (0..hardware.axes).map(way).sum())),
        EndPoint::Longest => words.push(("e", way(longest))),
        EndPoint::PerAxis => {}
    }
    vec![words]
}
