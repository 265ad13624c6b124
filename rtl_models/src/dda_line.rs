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
//!                                  └──┴─ carry flip-flop; after the last bit it is di
//! ```
//!
//! On every iteration {carry, J_R} := J_R + J_V; the carry is the axis's pulse. After t iterations the axis is at
//! floor((t·abs(d) + P) / 2^n): at d after 2^n, for every preset P, and J_R is back at P. 2^n must be greater than
//! every abs(d). Normalised, all J_V are shifted left by the same Q until the largest has its top bit set, one bit a
//! clock, and e is halved as often: 2^(n-Q) iterations.
//!
//! The line (8, 6) in 4 bits, from the golden file `waves/dda-line-8-6.csv`; the wave is next to it:
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
//! rotates, and an iteration takes n clocks; with its last one the step is completed and all registers stand as
//! those of the parallel form. In radix 10 one digit adder for each axis takes a digit a clock, k clocks an iteration.
//! The line (8, 6) in 4 bits, from `waves/dda-line-serial.csv`:
//!
//! ```text
#![doc = include_str!("../waves/dda-line-serial.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::Width;
use stepwave_netlist::dsl::Scope;
use stepwave_netlist::formula::{Clause, Formula, name, number};

use crate::claims::{Claims, Kind, Region, steps_left};
use crate::error::ModelError;
use crate::hardware::{Hardware, Pace, modulus};
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{ADDER, Adder, END_POINT, EndPoint, NORMALIZE, ON_OVERFLOW, PRESET, RADIX, Radix, WIDTH};
use crate::parts::{
    Block, E, END, Iteration, JR, JV, LONGEST, Normalizer, PLACE, POSITION, SIGN, axis_scope, digits, integrator,
    population_count, rotated, shifted_left,
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
    registers: &[&(JV, JR), &E, &END, &PLACE, &POSITION],
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
        refined: |hardware| (hardware.get(&END_POINT) == EndPoint::Longest).then_some(Region::LinesByLength),
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
        EndPoint::PerAxis => {
            Some((END.of(0).value() + END.of(1).value() + 2) * modulus() - JR.of(0).value() - JR.of(1).value())
        }
    }
}

/// What 2^n iterations have to do with a travel that is left.
fn guesses(hardware: &Hardware, _: &Kind) -> Vec<Clause> {
    if !matches!(hardware.get(&END_POINT), EndPoint::Total | EndPoint::Longest) {
        return Vec::new();
    }
    let left = [0, 1].map(|i| JV.of(i).value() - (number(1) - 2 * SIGN.of(i).value()) * POSITION.of(i).value());
    let early = || name("2^k") - 1 - name("steps");
    let ended = left.clone().map(|left| Clause::either("all iterations end an axis", [-left, early()]));
    [vec![Clause::either("an axis has not ended", left.map(|left| left - 1))], ended.to_vec()].concat()
}

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    let (axes, radix) = (plan.axes(), plan.get(&RADIX));
    plan.n = plan.magnitude_bits(sizes::longest(line));
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
    // End points are counted in binary, for every radix.
    let steps = Width::needed_unsigned(modulus(radix, plan.n) - 1);
    let end_point = plan.get(&END_POINT);
    let e = match end_point {
        // The sum of up to 2, 4 or 6 axes.
        EndPoint::Total => steps + axes.next_power_of_two().trailing_zeros(),
        EndPoint::Iterations => Width::needed_unsigned(modulus(radix, plan.bits(JR.of(0)))),
        EndPoint::Longest | EndPoint::PerAxis => steps + 1,
    };
    plan.set(E, e).set_each(END, steps);
    plan.positions(sizes::end_positions(line));
    let clocks = match plan.get(&ADDER) {
        Adder::Parallel => 1,
        Adder::Serial => plan.bits(JR.of(0)) / radix.digit_bits(),
    };
    plan.integrators(clocks.into())?;
    // With unequal presets one axis may lead while another lags.
    let equal = plan.presets()?.windows(2).all(|pair| pair[0] == pair[1]);
    plan.error_bound = (axes == 2 && end_point == EndPoint::Iterations && equal).then_some(1.0);
    plan.pace = Pace::Cycle(JR.of(0));
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let axes = 0..hardware.axes;
    let block = Block::new(m);
    let normalizer = Normalizer::new(m, &block, hardware.get(&NORMALIZE));
    let scopes: Vec<_> = axes.clone().map(|axis| axis_scope(m, axis)).collect();
    let integrand = |i: usize| hardware.reg(scopes[i], JV.of(i)).shown(digits(hardware));
    let integrands: Vec<_> = axes.clone().map(integrand).collect();
    let normalized = normalizer.close(&integrands.iter().map(|jv| jv.q).collect::<Vec<_>>(), 1);

    let counters: Option<Vec<_>> = (hardware.get(&END_POINT) == EndPoint::PerAxis)
        .then(|| axes.clone().map(|i| hardware.counter(scopes[i], &block, END.of(i))).collect());
    if counters.is_some() {
        let left = axes.clone().map(|i| END.of(i).value()).fold(number(-1), |sum, end| sum + end);
        m.between_steps("a_way_is_left", [left]);
    }
    let iteration = Iteration::new(m, &block, hardware, normalized.run);
    let mut pulses = Vec::new();
    for i in axes {
        let (scope, jv) = (scopes[i], integrands[i]);
        // An exhausted axis stops adding.
        let step = counters.as_ref().map_or(iteration, |counters| iteration.only(counters[i].running()));
        let loaded = jv
            .when(block.load, block.word_in(hardware.get(&RADIX), JV.of(i).name(), hardware.bits(JV.of(i))))
            .when(normalized.shift, shifted_left(scope, jv.q));
        match hardware.get(&ADDER) {
            Adder::Parallel => loaded.else_hold(),
            Adder::Serial => loaded.when(step.add, rotated(hardware, jv.q)).else_hold(),
        }
        let pulse = integrator(scope, &block, hardware, i, jv.q, step);
        hardware.axis(scope, &block, i, pulse, hardware.held(scope, &block, SIGN.of(i)));
        pulses.push(pulse);
    }

    let e = || hardware.counter(m, &block, E);
    let last = match (hardware.get(&END_POINT), counters) {
        (_, Some(counters)) => {
            let ended = counters.into_iter().zip(&pulses).map(|(counter, pulse)| counter.count(*pulse));
            ended.reduce(|a, b| a & b).unwrap_or(block.load)
        }
        (EndPoint::Total, None) => e().count_pulses(population_count(m, 3, &pulses)),
        (EndPoint::Longest, None) => {
            let longest = (0..hardware.axes).map(|i| hardware.held(scopes[i], &block, LONGEST.of(i)) & pulses[i]);
            e().count(longest.reduce(|a, b| a | b).unwrap_or(block.load))
        }
        (_, None) => e().count_or_halve(iteration.complete, normalized.shift),
    };
    block.close(normalized.ready, iteration.complete, last);
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let delta: Vec<i128> = line.delta().into_iter().map(i128::from).collect();
    let travel = |axis: usize| delta[axis].abs();
    let longest = (0..hardware.axes).rev().max_by_key(|&axis| travel(axis)).unwrap_or(0);
    let (end_point, mut words) = (hardware.get(&END_POINT), Words::new());
    for (axis, delta) in delta.iter().enumerate() {
        words = words.set(JV.of(axis), travel(axis)).set(JR.of(axis), hardware.preset(JR.of(axis)));
        words = words.set(SIGN.of(axis), *delta < 0).set(POSITION.of(axis), line.from()[axis]);
        words = match end_point {
            EndPoint::PerAxis => words.set(END.of(axis), travel(axis)),
            EndPoint::Longest => words.set(LONGEST.of(axis), axis == longest),
            EndPoint::Total | EndPoint::Iterations => words,
        };
    }
    vec![match end_point {
        // At most 2^64.
        EndPoint::Iterations => {
            words.set(E, i128::try_from(hardware.modulus(hardware.bits(JR.of(0)))).unwrap_or(i128::MAX))
        }
        EndPoint::Total => words.set(E, (0..hardware.axes).map(travel).sum::<i128>()),
        EndPoint::Longest => words.set(E, travel(longest)),
        EndPoint::PerAxis => words,
    }]
}
