//! Step generators of today: their tables, and the known mistakes as their users meet them.

use super::{Csv, Folder, engines, good, run_refused};

/// What a run that fails a check says, which is the same on every engine.
fn fails(words: &str) -> String {
    let said: Vec<String> = engines()
        .map(|engine| {
            let ran = Folder::new().run(&format!("run {words} --engine {engine}"));
            assert_eq!(ran.code, 1, "{words}: {ran:?}");
            ran.err
        })
        .collect();
    assert!(said.windows(2).all(|pair| pair[0] == pair[1]), "{said:?}");
    said[0].clone()
}

#[test]
fn a_line_by_accumulators() {
    let table = Csv::of("stepgen --to 3,-2");
    assert_eq!(table.heading.join(","), "step,clock,ratex,accx,ratey,accy,e,dx,dy,x,y");
    // 2^4 accumulations of 3 and -2; a step where the whole part of acc/16 changes.
    assert_eq!(table.column("accx"), (0..=16).map(|t| 3 * t).collect::<Vec<_>>());
    assert_eq!(table.column("accy"), (0..=16).map(|t| -2 * t).collect::<Vec<_>>());
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![6, 11, 16], vec![1, 9]));
    assert_eq!(table.path().last(), Some(&(3, -2)));
    // The first accumulation is a step of Y: at clock 2 it turns, 4 clocks of set-up. The others wait for nothing.
    assert_eq!(table.column("clock"), [vec![1], (6..=21).collect()].concat());
}

#[test]
fn times_of_outputs_delay_accumulations_and_nothing_else() {
    let table = Csv::of("stepgen --to 3,-2");
    let slow = Csv::of("stepgen --to 3,-2 --width e=5 --timing length=9,space=7,setup=30,hold=2");
    for name in table.heading.iter().filter(|name| *name != "clock") {
        assert_eq!(table.column(name), slow.column(name), "{name}");
    }
    // X steps at 6 and 11, five accumulations apart: 16 clocks.
    let clock = slow.column("clock");
    assert_eq!((clock[1], clock[6], clock[11] - clock[6]), (2 + 30, 31 + 6, 16));
}

#[test]
fn a_pick_off_bit_of_its_own_makes_the_same_path() {
    let table = Csv::of("stepgen --to 3,-2");
    for choices in ["--pick-off 32 --width acc=48,rate=32", "--pick-off 7", "--pick-off 50"] {
        let other = Csv::of(&format!("stepgen --to 3,-2 {choices}"));
        assert_eq!(other.path(), table.path(), "{choices}");
    }
    assert_eq!(Csv::of("stepgen --to 3,-2 --pick-off 32").column("accx")[1], 3 << 28);
}

#[test]
fn an_accumulator_too_narrow_for_its_pick_off_is_trapped_at_its_clock() {
    // 2^5 accumulations of 6, one a clock from clock 2 on; after 5 of them, at clock 6, acc is 30.
    let sentence = "overflow of stepgen.axis_x.accx at clock 6: 30 + 6 = 36 does not fit in its 6 bits (-32 to 31); 7 bits \
                    would hold it: give --width accx=7, or go on with --on-overflow wrap or saturate";
    assert_eq!(fails("stepgen --to 6,4 --width acc=6"), format!("stepwave: {sentence}\n"));
    // 9 bits hold all of 6·2^5.
    good("run stepgen --to 6,4 --width acc=9");
}

#[test]
fn an_accumulator_without_its_pick_off_bit_makes_wrong_steps_when_it_goes_on() {
    let words = "stepgen --to 6,4 --width acc=5 --on-overflow";
    let missed = "stepwave: the end point (6, 4) was missed: the machine is at";
    assert_eq!(fails(&format!("{words} wrap")), format!("{missed} (12, 8)\n"));
    assert_eq!(fails(&format!("{words} saturate")), format!("{missed} (0, 0)\n"));
    // With its pick-off bit 5 it still makes every step, and the overflows are reported.
    let printed = good("run stepgen --to 6,4 --width acc=6 --on-overflow wrap");
    assert!(printed.contains("5 overflow(s), the first: overflow of stepgen.axis_x.accx at clock 6: 30 + 6 = 36"));
}

#[test]
fn choices_of_a_step_generator_that_cannot_be_are_refused() {
    run_refused("stepgen --to 6,4 --pick-off 2", &["pick-off bit 2", "a fraction", "give --pick-off 3 or more"]);
    run_refused("stepgen --to 6,4 --width e=3", &["4 accumulations", "6 steps", "give --width e=4 or more"]);
    run_refused("stepgen --to 6,4 --width rate=2", &["ratex = 6", "4 bits would hold it: give --width ratex=4"]);
    run_refused("stepgen --to 6,4 --preset 32", &["--preset 32", "from 0 to 31", "pick-off bit 5"]);
    run_refused("stepgen --to 6,4 --preset jrx=1", &["no register 'jrx'", "accx, accy"]);
    run_refused("stepgen --to 6,4 --pick-off 63", &["63", "--pick-off"]);
    run_refused("stepgen --to 6,4 --timing length=0", &["invalid time '0': it must be from 1 to 1048576"]);
    run_refused("stepgen --to 6,4 --timing wait=3", &["there is no time 'wait'"]);
    run_refused("stepgen --to 6,4 --compare gt", &["stepgen does not take --compare"]);
    run_refused("bresenham --to 6,4 --timing setup=3", &["bresenham does not take --timing"]);
    run_refused("bresenham --to 6,4 --compare lt", &["possible values: ge, gt"]);
}

#[test]
fn a_line_by_counters_of_firmware() {
    let table = Csv::of("bresenham --to 5,3");
    assert_eq!(table.heading.join(","), "step,clock,stepsx,cntx,stepsy,cnty,events,e,dx,dy,x,y");
    // From 5/2 = 2; 2 + 3 = 5 steps, 0 + 3 does not, 3 + 3 does, …
    assert_eq!(table.column("cnty"), [2, 0, 3, 1, 4, 2]);
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![1, 2, 3, 4, 5], vec![1, 3, 5]));
    // An event takes two clocks.
    assert_eq!(table.column("clock"), [1, 3, 5, 7, 9, 11]);
    let later = Csv::of("bresenham --to 5,3 --compare gt");
    assert_eq!((later.column("cnty"), later.pulses("y")), (vec![2, 5, 3, 1, 4, 2], vec![2, 3, 5]));
    // The signed form is 5 lower, from -2.
    let signed = Csv::of("bresenham --to 5,3 --form signed");
    assert_eq!((signed.column("cnty"), signed.pulses("y")), (vec![-2, -4, -1, -3, 0, -2], vec![1, 3, 5]));
}

#[test]
fn a_block_of_one_step_does_not_move_with_the_test_of_early_firmware() {
    for (to, shown) in [("1,0", "(1, 0)"), ("0,-1", "(0, -1)"), ("-1,1", "(-1, 1)"), ("1,1,-1", "(1, 1, -1)")] {
        let stays = if to.split(',').count() == 3 { "(0, 0, 0)" } else { "(0, 0)" };
        let missed = format!("stepwave: the end point {shown} was missed: the machine is at {stays}\n");
        assert_eq!(fails(&format!("bresenham --to {to} --compare gt")), missed);
        good(&format!("run bresenham --to {to} --compare ge"));
        good(&format!("run bresenham --to {to} --form signed"));
    }
    good("run bresenham --to 2,1 --compare gt");
}

#[test]
fn a_block_of_one_step_moves_the_idle_axis_with_the_other_test_of_the_signed_form() {
    let missed = "stepwave: the end point (0, 1) was missed: the machine is at (1, 1)\n";
    assert_eq!(fails("bresenham --to 0,1 --form signed --compare ge"), missed);
    good("run bresenham --to 0,2 --form signed --compare ge");
}

#[test]
fn a_counter_one_bit_too_narrow_is_trapped_at_the_sum_that_it_cannot_hold() {
    // Y: 2 + 4 = 6 to 1, 5 to 0, 4 (no step), and the fourth addition, after clock 1 + 2·3, comes to 8.
    let sentence = "overflow of bresenham.axis_y.cnty at clock 7: 4 + 4 = 8 does not fit in its 3 bits (0 to 7); 4 bits \
                    would hold it: give --width cnty=4, or go on with --on-overflow wrap or saturate";
    assert_eq!(fails("bresenham --to 5,4 --width cnt=3"), format!("stepwave: {sentence}\n"));
    good("run bresenham --to 5,4 --width cnt=4");
    // Going on, 8 becomes 0, and two steps are lost.
    let words = "bresenham --to 5,4 --width cnt=3 --on-overflow wrap";
    assert!(fails(words).starts_with("stepwave: the end point (5, 4) was missed: the machine is at (5, 2)\n"));
}

#[test]
fn both_stand_in_a_comparison_of_all_methods() {
    let rows = good("compare --to 100,62");
    let row = |name: &str| {
        let row = rows.lines().find(|line| line.starts_with(&format!("{name}  "))).unwrap_or_else(|| panic!("{rows}"));
        row.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).map(str::to_owned).collect::<Vec<_>>()
    };
    // n = 7: 2^9 accumulations, the load, and the last step with its space; accumulators of 7 + 1 + 9 bits.
    let stepgen = row("stepgen");
    assert_eq!(
        (&stepgen[1..3], &stepgen[6..]),
        (&["512", "517"].map(str::to_owned)[..], &["accx 17 bits", "exact"].map(str::to_owned)[..])
    );
    assert_eq!(row("stepgen --preset half")[1], "512");
    let bresenham = row("bresenham");
    assert_eq!(
        (&bresenham[1..3], &bresenham[6..]),
        (&["100", "201"].map(str::to_owned)[..], &["cntx 8 bits", "exact"].map(str::to_owned)[..])
    );
}
