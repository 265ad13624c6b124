use super::write_merged;
use crate::diverge::{By, Options};
use crate::read::Wave;
use crate::read::tests::{COUNTER, Counter, file, wave};

fn merged(a: &Wave, b: &Wave, options: &Options) -> String {
    let mut bytes = Vec::new();
    write_merged(a, b, options, &mut bytes).expect("a merged wave");
    String::from_utf8(bytes).expect("text")
}

#[test]
fn both_sides_and_their_exclusive_or_stand_under_their_own_scopes() {
    let vars = "$var wire 1 ! clk $end $var wire 4 \" q $end $var real 64 # r $end";
    let a = wave(&file(vars, "#0 0! b1 \" r0 # #5 1! #6 b1010 \" #10 0! #15 1! r0.5 # #20 0!"));
    let b = wave(&file(vars, "#0 0! b1 \" r0 # #50 1! b1011 \" #100 0! #150 1! bx \" #200 0!"));
    assert_eq!(
        merged(&a, &b, &Options::default()),
        "$version stepwave $end
$comment two waves a and b; xor is 0 where they agree $end
$timescale 1 ns $end
$scope module a $end
$var wire 1 ! clk $end
$scope module m $end
$var wire 4 \" q [3:0] $end
$var real 64 # r $end
$upscope $end
$upscope $end
$scope module b $end
$scope module m $end
$var wire 4 $ q [3:0] $end
$var real 64 % r $end
$upscope $end
$upscope $end
$scope module xor $end
$scope module m $end
$var wire 4 & q [3:0] $end
$upscope $end
$upscope $end
$enddefinitions $end
#0
$dumpvars
0!
b0001 \"
r0.0 #
b0001 $
r0.0 %
b0000 &
$end
#5
1!
b1010 \"
b1011 $
b0001 &
#10
0!
#15
1!
r0.5 #
bxxxx $
bxxxx &
#20
0!
"
    );
}

#[test]
fn the_exclusive_or_of_a_flipped_bit_is_that_bit_in_that_cycle() {
    let (a, b) = (COUNTER.wave(), Counter { flip: Some(7), period: 64, delay: 5, ..COUNTER }.wave());
    let merged = wave(&merged(&a, &b, &Options::default()));
    let xor = merged.find("xor.dda_line.x.count").expect("the signal");
    let row: Vec<String> =
        (0..12).map(|k| merged.value_at_cycle(xor, k).expect("the clock of A").expect("a cycle").cell()).collect();
    assert_eq!(row.join(" "), ["0000"; 12].join(" ").replacen("0000", "0100", 8).replacen("0100", "0000", 7));
    assert_eq!(merged.times().last(), a.times().last());
}

#[test]
fn by_time_each_change_is_at_its_own_time_in_the_finer_unit() {
    let by_time = Options { by: By::Time, ..Options::default() };
    let late = Counter { unit: "100 ps", period: 100, delay: 7, cycles: 13, ..COUNTER }.wave();
    let merged = wave(&merged(&COUNTER.wave(), &late, &by_time));
    let value = |path: &str, time| {
        let signal = merged.find(path).expect("the signal");
        merged.value_at_time(signal, time).expect("a signal").cell()
    };
    let scale = merged.timescale().expect("a timescale");
    assert_eq!((scale.factor, scale.exponent), (100, -12));
    assert_eq!((value("a.dda_line.x.count", 206), value("b.dda_line.x.count", 206)), ("0010".into(), "0001".into()));
    assert_eq!(
        (value("xor.dda_line.x.count", 206), value("xor.dda_line.x.count", 207)),
        ("0011".into(), "0000".into())
    );
    assert_eq!(merged.times().last(), Some(&1300));
}

#[test]
fn signals_of_one_side_other_kinds_and_odd_names_are_kept_too() {
    let a = wave(&file(
        "$var wire 1 ! clk $end $var string 1 \" s $end $var event 1 # ev $end
            $var wire 1 $ 1st $end $var wire 1 $ clk_ $end",
        "#0 0! sA\\x20B\\\\ \" 1$ #5 1! 1# #10 0! #15 1! 1# x$",
    ));
    let b = wave(&file("$var wire 1 ! clk $end $var integer 8 \" e $end", "#0 0! b11111111 \" #5 1! #10 0! #15 1!"));
    let merged = wave(&merged(&a, &b, &Options::default()));
    let paths: Vec<&str> = merged.signals().iter().map(|signal| signal.path.as_str()).collect();
    assert_eq!(paths, ["a.clk", "a.m.s", "a.m.ev", "a.m._1st", "a.m.clk_", "b.m.e"]);
    let last: Vec<String> =
        (1..6).map(|signal| merged.value_at_time(signal, 15).expect("a signal").to_string()).collect();
    assert_eq!(last, ["\"A B\\\\\"", "event no. 2", "x", "x", "11111111 (-1)"]);
}

#[test]
fn wide_vectors_are_written_with_their_fewest_digits() {
    let vars = "$var wire 1 ! clk $end $var wire 1000000 \" q $end $var wire 130 # w $end $var wire 0 $ none $end";
    let ones = "1".repeat(130);
    let a = wave(&file(vars, &format!("#0 0! b1 \" b{ones} # #5 1! b110 \" bx #")));
    let b = wave(&file(vars, "#0 0! b11 \" b0 # #5 1! bx01 \" bx #"));
    let merged = merged(&a, &b, &Options::default());
    assert!(merged.len() < 2000, "{}", merged.len());
    let read = wave(&merged);
    let shown = |path: &str, time| {
        let signal = read.find(path).unwrap_or_else(|| panic!("{path} in {merged}"));
        read.value_at_time(signal, time).expect("a signal").to_string()
    };
    assert_eq!((shown("a.m.q", 0), shown("b.m.q", 5)), ("1000000'b1".into(), "1000000'bx01".into()));
    assert_eq!((shown("xor.m.q", 0), shown("xor.m.q", 5)), ("1000000'b10".into(), "1000000'bx11".into()));
    assert_eq!((shown("xor.m.w", 0), shown("xor.m.w", 5)), (ones, "0".repeat(130)));
}

#[test]
fn a_time_scale_that_is_not_1_10_or_100_becomes_one_that_is() {
    let text = |unit: &str| {
        file("$var wire 1 ! clk $end $var wire 1 \" q $end", "#0 0! 0\" #5 1! #9 1\"").replace("1 ns", unit)
    };
    let odd = merged(&wave(&text("500 ps")), &wave(&text("500 ps")), &Options::default());
    // The samples of a cycle are shown from its edge on, which comes after 5 times 500 ps; the end after 9.
    assert!(odd.contains("$timescale 100 ps $end") && odd.ends_with("#25\n1!\n1\"\n1#\n#45\n"), "{odd}");
    let none = text("1 ns").replace("$timescale 1 ns $end", "");
    let none = merged(&wave(&none), &wave(&none), &Options { by: By::Time, ..Options::default() });
    assert!(!none.contains("$timescale") && none.contains("\n#9\n"), "{none}");
}
