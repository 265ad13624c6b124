//! Acceleration after the interpolator.

use proptest::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::Options;

use super::{check, line, run};
use crate::reference::{Filter, smooth};

const NAME: &str = "ramp-after";

fn check_filter(filter: Filter, pulses: i64, step: i64, preset: &str, engine: EngineKind) {
    let of = match filter {
        Filter::Sum(k) => format!("sum={k}"),
        Filter::Exponential(s) => format!("exp={s}"),
    };
    let options = ["--smooth", &of, "--step", &step.to_string(), "--preset", preset].map(str::to_owned);
    let options = Options::parse(options.iter().map(String::as_str)).unwrap();
    let bits = i64::BITS - step.leading_zeros();
    let start = if preset == "half" { 1 << (bits - 1) } else { 0 };
    check(NAME, &line(&[0], &[pulses]), &options, engine, &smooth(filter, pulses, step, start));
}

#[test]
fn every_small_displacement_comes_out_whole() {
    for (pulses, step) in (1..40).flat_map(|pulses| [1, 2, 3, 5, 7, 50].map(|step| (pulses, step))) {
        for filter in [1, 2, 3, 4, 7].map(Filter::Sum).into_iter().chain([1, 2, 3].map(Filter::Exponential)) {
            check_filter(filter, pulses, step, "zero", EngineKind::Word);
        }
    }
}

#[test]
fn the_worked_periods_on_every_engine() {
    for engine in EngineKind::ALL {
        check_filter(Filter::Sum(4), 60, 10, "half", engine);
        check_filter(Filter::Exponential(2), 40, 10, "zero", engine);
        check_filter(Filter::Sum(64), 1000, 31, "zero", engine);
        check_filter(Filter::Exponential(7), 1000, 31, "half", engine);
    }
}

/// Too narrow a sum, exponential or integrand is reported where it overflows.
#[test]
fn narrow_registers_trap() {
    for (words, register) in
        [(["--smooth", "sum=4", "--width", "s=5"], "s"), (["--smooth", "exp=2", "--width", "acc=4"], "acc")]
    {
        let ran = run(NAME, &line(&[0], &[60]), &Options::parse(words).unwrap(), EngineKind::Word);
        assert_eq!(ran.outcome.ending, stepwave::testbench::Ending::Trapped, "{register}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn any_displacement_follows_the_recurrence(pulses in 1..3000i64, step in 1..400i64, k in 1..=64i64, s in 1..=9u32) {
        check_filter(Filter::Sum(k), pulses, step, "zero", EngineKind::Compiled);
        check_filter(Filter::Exponential(s), pulses, step, "half", EngineKind::Compiled);
    }
}
