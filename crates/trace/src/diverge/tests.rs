use super::{By, CompareError, Mismatch, Moment, Options, compare, first_divergence};
use crate::read::Wave;
use crate::read::tests::{COUNTER, Counter, file, wave};

fn options(change: impl FnOnce(&mut Options)) -> Options {
    let mut options = Options::default();
    change(&mut options);
    options
}

fn report(a: &Wave, b: &Wave, options: &Options) -> String {
    compare(a, b, options).expect("a comparison").to_string()
}

fn same(a: &Wave, b: &Wave) -> bool {
    first_divergence(a, b, &Options::default()).expect("a comparison").is_none()
}

/// Signals `m.q` and nothing else, with a clock of two cycles.
fn pair(var: &str, a: &str, b: &str) -> [Wave; 2] {
    let one = |value: &str| wave(&file(&format!("$var wire 1 ! clk $end {var}"), &format!("#0 0! #5 1! {value}")));
    [one(a), one(b)]
}

#[test]
fn a_flipped_bit_is_found_with_its_clock_its_signal_and_both_values() {
    let (a, b) = (COUNTER.wave(), Counter { flip: Some(7), ..COUNTER }.wave());
    let divergence = first_divergence(&a, &b, &Options::default()).expect("a comparison").expect("a difference");
    let [first] = divergence.differences.as_slice() else { panic!("one signal differs") };
    assert_eq!((first.at, first.signal.path.as_str()), (Moment::Clock(7), "dda_line.x.count"));
    assert_eq!((first.a.to_string(), first.b.to_string()), ("0111 (7)".into(), "0011 (3)".into()));
    assert!(divergence.mismatches.is_empty() && divergence.lengths.is_none());
}

#[test]
fn the_report_shows_the_first_divergence_with_context_and_all_others() {
    let a = COUNTER.wave();
    // Cycle 2 is wrong in `e`, from cycle 3 on `odd`.
    let b = COUNTER.vcd().replace("b11111110 $", "b11111100 $").replace("1#\nb11111101", "0#\nb11111101");
    let options = options(|o| o.context = 2);
    assert_eq!(
        report(&a, &wave(&b), &options),
        "A: memory
B: memory

first divergence: clock 2, signal dda_line.x.e
  A  11111110 (-2)   clock begins at 20 ns
  B  11111100 (-4)   clock begins at 20 ns

          A e         B  A odd  B
  0  00000000  00000000      0  0
  1  11111111  11111111      1  1
  2  11111110  11111100      0  0  <
  3  11111101  11111101      1  0  <
  4  11111100  11111100      0  0

1 signal more, each where it diverges first:
  clock 3: dda_line.x.odd: A 1, B 0

compared: 3 signals over 12 cycles"
    );
}

#[test]
fn equal_waves_make_one_line() {
    let a = COUNTER.wave();
    assert_eq!(report(&a, &COUNTER.wave(), &Options::default()), "same: 3 signals over 12 cycles");
}

#[test]
fn the_unit_of_time_the_period_and_delays_within_a_cycle_play_no_part() {
    let a = COUNTER.wave();
    assert!(same(&a, &Counter { unit: "10 ps", ..COUNTER }.wave()));
    assert!(same(&a, &Counter { period: 1000, ..COUNTER }.wave()));
    assert!(same(&a, &Counter { delay: 3, ..COUNTER }.wave()));
    assert!(same(&Counter { delay: 4, unit: "1 us", ..COUNTER }.wave(), &a));
}

#[test]
fn by_time_the_units_are_converted_and_delays_count() {
    let by_time = options(|o| o.by = By::Time);
    let a = COUNTER.wave();
    let picoseconds = Counter { unit: "1 ps", period: 10_000, ..COUNTER }.wave();
    assert_eq!(report(&a, &picoseconds, &by_time), "same: 4 signals up to 120000 ps");
    let late = Counter { unit: "100 ps", period: 100, delay: 7, ..COUNTER }.wave();
    let divergence = first_divergence(&a, &late, &by_time).expect("a comparison").expect("a difference");
    // At time 0, the late side has no value yet.
    assert_eq!(divergence.differences[0].at.to_string(), "0 ps");
    // The clock is compared like any other signal, and it is not late.
    assert!(divergence.differences.iter().all(|difference| difference.signal.leaf() != "clk"));
    let early = Counter { flip: Some(3), ..COUNTER }.wave();
    let text = report(&a, &early, &options(|o| (o.by, o.context) = (By::Time, 1)));
    let table = "     A count     B
  20 ns     0010  0010
  30 ns     0011  0111  <
  40 ns     0100  0100
";
    assert!(text.contains(table), "{text}");
}

#[test]
fn a_signal_that_one_side_lacks_is_a_difference() {
    let a = COUNTER.wave();
    let b = wave(&COUNTER.vcd().replace(" odd ", " even "));
    let divergence = first_divergence(&a, &b, &Options::default()).expect("a comparison").expect("a difference");
    let [Mismatch::OnlyInA(odd), Mismatch::OnlyInB(even)] = divergence.mismatches.as_slice() else { panic!("two") };
    assert_eq!((odd.path.as_str(), even.path.as_str()), ("dda_line.x.odd", "dda_line.x.even"));
    assert!(report(&a, &b, &Options::default()).contains("\nonly in A: dda_line.x.odd\nonly in B: dda_line.x.even\n"));
}

#[test]
fn another_width_or_kind_is_a_difference() {
    let [a, b] = [COUNTER.wave(), Counter { width: 5, ..COUNTER }.wave()];
    let text = report(&a, &b, &Options::default());
    assert!(text.contains("width differs: dda_line.x.count: 4 bits in A, 5 bits in B"), "{text}");
    let [a, _] = pair("$var wire 4 \" q $end", "b1 \"", "");
    let [b, _] = pair("$var real 64 \" q $end", "r1 \"", "");
    assert!(report(&a, &b, &Options::default()).contains("kind differs: m.q: 4 bits in A, real in B"));
}

#[test]
fn more_cycles_on_one_side_are_a_difference_of_their_own() {
    let (a, b) = (COUNTER.wave(), Counter { cycles: 13, ..COUNTER }.wave());
    let text = report(&a, &b, &Options::default());
    assert!(
        text.contains("no value differs in what both have, but:\nlength differs: 12 cycles in A, 13 in B"),
        "{text}"
    );
}

#[test]
fn an_offset_pairs_a_sample_with_a_later_or_an_earlier_one() {
    let (a, b) = (COUNTER.wave(), Counter { start: 3, cycles: 9, ..COUNTER }.wave());
    let by = |offset| options(|o| o.by = By::Clock { offset });
    assert!(!same(&a, &b));
    assert_eq!(report(&a, &b, &by(-3)), "same: 3 signals over 9 cycles");
    assert_eq!(report(&b, &a, &by(3)), "same: 3 signals over 9 cycles");
    let shifted = Counter { start: 2, ..COUNTER }.wave();
    assert_eq!(report(&a, &shifted, &by(-2)), "same: 3 signals over 10 cycles");
    assert!(matches!(compare(&a, &b, &by(9)), Err(CompareError::NoOverlap { offset: 9, a: 12, b: 9 })));
    assert!(compare(&a, &b, &by(i64::MIN)).is_err() && compare(&a, &b, &by(i64::MAX)).is_err());
}

#[test]
fn other_leading_scopes_are_taken_off_if_no_path_is_common() {
    let b = Counter { scopes: &["tb", "dut", "x_axis"], ..COUNTER }.wave();
    assert_eq!(report(&COUNTER.wave(), &b, &Options::default()), "same: 3 signals over 12 cycles");
}

#[test]
fn a_map_renames_scopes_and_signals_of_a() {
    // One path is common, so that nothing is taken off.
    let top = |text: &str| wave(&text.replacen("$scope module", "$var wire 1 % run $end $scope module", 1));
    let a = top(&COUNTER.vcd().replace("module x ", "module y ").replace(" odd ", " parity "));
    let b = top(&COUNTER.vcd());
    assert!(!same(&a, &b));
    let map = |rules: &[(&str, &str)]| {
        options(|o| o.map = rules.iter().map(|(a, b)| (a.to_string(), b.to_string())).collect())
    };
    let rules = [("dda_line.y.parity", "dda_line.x.odd"), ("dda_line.y", "dda_line.x")];
    assert_eq!(report(&a, &b, &map(&rules)), "same: 4 signals over 12 cycles");
    let unused = compare(&a, &b, &map(&[("dda_line.z", "q")])).expect_err("a rule without effect").to_string();
    assert_eq!(
        unused,
        "the map renames `dda_line.z`, but the first wave has no such signal or scope (did you mean 'dda_line.y'?)"
    );
    let collision = compare(&a, &b, &map(&[("dda_line.y.e", "run")]));
    assert!(matches!(collision, Err(CompareError::MapCollision { name }) if name == "run"));
}

#[test]
fn globs_select_and_ignore_by_path_and_by_name() {
    let (a, b) = (COUNTER.wave(), Counter { flip: Some(7), ..COUNTER }.wave());
    let ignore = |glob: &str| report(&a, &b, &options(|o| o.ignore = vec![glob.into()]));
    assert_eq!(ignore("count"), "same: 2 signals over 12 cycles");
    assert_eq!(ignore("*.x.c*"), "same: 2 signals over 12 cycles");
    let select = |glob: &str| compare(&a, &b, &options(|o| o.signals = vec![glob.into()])).map(|c| c.signals);
    assert!(matches!(select("{odd,e}"), Ok(2)));
    assert!(matches!(select("nothing"), Err(CompareError::NothingToCompare { .. })));
    assert!(matches!(select("[z"), Err(CompareError::BadGlob { pattern, .. }) if pattern == "[z"));
}

#[test]
fn x_is_only_x_in_either_case_and_short_vectors_are_extended() {
    let vector = |a, b| {
        let [a, b] = pair("$var wire 4 \" q $end", a, b);
        same(&a, &b)
    };
    assert!(vector("bx \"", "bXXXX \"") && vector("b01 \"", "b1 \"") && vector("bz0 \"", "bZZZ0 \""));
    assert!(vector("b1x \"", "b001X \""), "a leading 1 is extended by 0");
    assert!(vector("bx \"", ""), "never set is x");
    assert!(!vector("bx \"", "bz \"") && !vector("b000x \"", "b0 \""));
}

#[test]
fn reals_and_texts_compare_by_value() {
    let other = |kind: &str, a, b| {
        let [a, b] = pair(&format!("$var {kind} 1 \" q $end"), a, b);
        same(&a, &b)
    };
    assert!(other("real", "r0.5 \"", "r5e-1 \"") && !other("real", "r0.5 \"", "r0.25 \""));
    assert!(other("real", "rnan \"", "rNaN \"") && other("real", "r0 \"", "r-0 \""));
    assert!(other("string", "sUP \"", "sUP \"") && !other("string", "sUP \"", "sup \""));
    assert!(other("event", "1\"", "1\"") && !other("event", "1\"", ""));
}

#[test]
fn two_names_of_one_signal_are_one_difference_with_both_names() {
    let [a, b] = pair("$var wire 2 \" q $end $var wire 2 \" r $end", "b1 \"", "b10 \"");
    let comparison = compare(&a, &b, &Options::default()).expect("a comparison");
    assert_eq!(comparison.signals, 2);
    assert!(comparison.to_string().contains("clock 1, signal m.q = m.r\n  A  01 (1)"));
}

#[test]
fn the_clocks_may_have_different_names() {
    let b = wave(&COUNTER.vcd().replace(" clk ", " osc ")).with_clock("x.osc").expect("that clock");
    assert!(same(&COUNTER.wave(), &b));
}

#[test]
fn by_time_a_fraction_of_a_unit_is_the_finer_unit_and_a_missing_unit_is_not_guessed() {
    let by_time = options(|o| o.by = By::Time);
    let unit = |unit: &'static str| Counter { unit, ..COUNTER }.wave();
    assert_eq!(report(&unit("0.1ps"), &unit("100 fs"), &by_time), "same: 4 signals up to 12000 fs");
    assert!(report(&unit("0.1ps"), &unit("1 ps"), &by_time).contains("differs: A ends at 12000 fs, B at 120000 fs"));
    let none = || wave(&COUNTER.vcd().replace("$timescale 1 ns $end", ""));
    assert_eq!(report(&none(), &none(), &by_time), "same: 4 signals up to #120");
    let guess = compare(&none(), &unit("1 ns"), &by_time).expect_err("no unit").to_string();
    assert_eq!(
        guess,
        "memory names no time scale, memory counts in 1 ns: write `$timescale 1 ns $end`, or what is true, into the header \
         of memory, or compare by clock"
    );
    assert!(same(&none(), &unit("1 ns")));
}
