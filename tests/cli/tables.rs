//! The worked examples of the textbooks, digit by digit.

use super::{Csv, engines, good, run_refused};

/// The table of a run on every engine, which must be the same.
fn on_every_engine(words: &str) -> Csv {
    let table = Csv::of(words);
    for engine in engines() {
        assert_eq!(Csv::of(&format!("{words} --engine {engine}")), table, "{words} on {engine}");
    }
    table
}

/// The table of a run that judges every step, on every engine. Four beats and one give the same but for the clocks: row
/// k is at clock 4k+1 and k+1.
fn judged(words: &str) -> Csv {
    let [four, one] = ["4", "1"].map(|beats| on_every_engine(&format!("{words} --beats {beats}")));
    let clocks = |table: &Csv, beats: i64| {
        let expected: Vec<i64> = table.column("step").into_iter().map(|step| beats * step + 1).collect();
        assert_eq!(table.column("clock"), expected, "{words} --beats {beats}");
    };
    clocks(&four, 4);
    clocks(&one, 1);
    for name in four.heading.iter().filter(|name| *name != "clock") {
        assert_eq!(four.column(name), one.column(name), "{words}: {name}");
    }
    four
}

#[test]
fn point_by_point_line_to_6_4() {
    let table = judged("ppc-line --to 6,4");
    assert_eq!(table.heading.join(","), "step,clock,xe,ye,f,e,dx,dy,x,y");
    assert_eq!(table.column("f"), [0, -4, 2, -2, 4, 0, -4, 2, -2, 4, 0]);
    assert_eq!(table.moves(), "X Y X Y X X Y X Y X");
    assert_eq!(table.column("e"), [10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0]);
    assert_eq!(table.path().last(), Some(&(6, 4)));
}

#[test]
fn point_by_point_line_to_5_3() {
    let table = judged("ppc-line --to 5,3");
    assert_eq!(table.column("f"), [0, -3, 2, -1, 4, 1, -2, 3, 0]);
    assert_eq!(table.moves(), "X Y X Y X X Y X");
}

#[test]
fn point_by_point_signed_line_in_quadrant_2_gives_the_tie_to_y() {
    let table = judged("ppc-line --from -1,1 --to -4,2 --form signed");
    assert_eq!(table.column("f"), [0, -3, -2, -1, 0]);
    assert_eq!(table.path(), [(-1, 1), (-1, 2), (-2, 2), (-3, 2), (-4, 2)]);
}

#[test]
fn point_by_point_arc_nr1() {
    let table = judged("ppc-arc --from 6,0 --to 0,6 --ccw");
    assert_eq!(table.heading.join(","), "step,clock,f,xi,yi,quad,e,dx,dy,x,y");
    assert_eq!(table.column("f"), [0, -11, -10, -7, -2, 5, -4, 5, -2, 9, 4, 1, 0]);
    assert_eq!(table.moves(), "-X Y Y Y Y -X Y -X Y -X -X -X");
    assert_eq!(table.path().last(), Some(&(0, 6)));
}

#[test]
fn point_by_point_arc_sr1() {
    let table = judged("ppc-arc --from 0,5 --to 5,0 --cw");
    assert_eq!(table.column("f"), [0, -9, -8, -5, 0, -7, 0, -5, 4, 1, 0]);
    assert_eq!(table.moves(), "-Y X X X -Y X -Y X -Y -Y");
}

#[test]
fn point_by_point_arc_across_the_negative_x_axis() {
    let table = judged("ppc-arc --from -5,-3 --to -3,5 --cw");
    assert_eq!(table.column("e")[0], 12);
    assert_eq!(table.column("f"), [0, -5, 6, 3, 2, -9, -8, -5, 0, -9, -2, 7, 0]);
    let [to_axis, after] = [
        [(-5, -3), (-5, -2), (-6, -2), (-6, -1), (-6, 0)].as_slice(),
        &[(-5, 0), (-5, 1), (-5, 2), (-5, 3), (-4, 3), (-4, 4), (-4, 5), (-3, 5)],
    ];
    assert_eq!(table.path(), [to_axis, after].concat());
}

#[test]
fn dda_line_to_8_6_in_four_bits() {
    let table = on_every_engine("dda-line --to 8,6");
    assert_eq!(table.heading.join(","), "step,clock,jvx,jrx,jvy,jry,e,dx,dy,x,y");
    assert_eq!(table.pulses("x"), [2, 4, 6, 8, 10, 12, 14, 16]);
    assert_eq!(table.pulses("y"), [3, 6, 8, 11, 14, 16]);
    assert_eq!(table.column("jry"), [0, 6, 12, 2, 8, 14, 4, 10, 0, 6, 12, 2, 8, 14, 4, 10, 0]);
    assert_eq!(table.column("jrx"), [0, 8, 0, 8, 0, 8, 0, 8, 0, 8, 0, 8, 0, 8, 0, 8, 0]);
    assert_eq!(table.path().last(), Some(&(8, 6)));
}

#[test]
fn dda_line_in_quadrant_2_in_three_bits() {
    let table = on_every_engine("dda-line --to -3,4");
    assert_eq!(table.rows.len(), 1 + 8);
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![3, 6, 8], vec![2, 4, 6, 8]));
    assert_eq!(table.path().last(), Some(&(-3, 4)));
}

#[test]
fn dda_line_to_7_5_in_three_bits() {
    let table = on_every_engine("dda-line --to 7,5");
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![2, 3, 4, 5, 6, 7, 8], vec![2, 4, 5, 7, 8]));
}

#[test]
fn dda_arc_nr1_in_three_bits() {
    let table = on_every_engine("dda-arc --from 5,0 --to 0,5 --ccw --preset zero");
    assert_eq!(table.heading.join(","), "step,clock,jvx,jrx,jvy,jry,unit,quad,ex,ey,dx,dy,x,y");
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![7, 9, 11, 12, 14], vec![2, 4, 5, 7, 9]));
    assert_eq!(table.column("jvx"), [0, 0, 1, 1, 2, 3, 3, 4, 4, 5, 5, 5, 5, 5, 5]);
    assert_eq!(table.path()[6..=9], [(5, 3), (4, 4), (4, 4), (3, 5)]);
}

#[test]
fn dda_arc_across_the_negative_x_axis_in_three_bits() {
    let table = on_every_engine("dda-arc --from -3,-4 --to -4,3 --cw --preset zero");
    // 8 steps in quadrant 3 to (-5, 0), then 7 in quadrant 2. The row that ends a sector still shows its quadrant.
    assert_eq!(table.column("quad"), [2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1]);
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![2, 5, 8 + 7], vec![3, 5, 7, 8, 8 + 2, 8 + 4, 8 + 5]));
    assert_eq!((table.column("dx")[2], table.column("dx")[15], table.path()[8]), (-1, 1, (-5, 0)));
    assert_eq!(table.path().last(), Some(&(-4, 3)));
}

#[test]
fn the_printed_table_of_a_line_is_that_of_the_textbook() {
    let expected = "\
step  xe  ye   f   e  pulse  x  y
─────────────────────────────────
   0   6   4   0  10         0  0
   1   6   4  -4   9     +X  1  0
   2   6   4   2   8     +Y  1  1
   3   6   4  -2   7     +X  2  1
   4   6   4   4   6     +Y  2  2
   5   6   4   0   5     +X  3  2
   6   6   4  -4   4     +X  4  2
   7   6   4   2   3     +Y  4  3
   8   6   4  -2   2     +X  5  3
   9   6   4   4   1     +Y  5  4
  10   6   4   0   0     +X  6  4

ppc-line: line (0, 0) to (6, 4)
10 steps in 41 clocks; pulses x 6, y 4
end point (6, 4) reached exactly
";
    for engine in engines() {
        let printed = good(&format!("run ppc-line --to 6,4 --engine {engine}"));
        assert!(printed.starts_with(expected), "{engine}:\n{printed}");
    }
}

#[test]
fn the_printed_table_of_an_arc_is_that_of_the_textbook() {
    let expected = "\
step  jvx  jrx  jvy  jry  unit  quad  ex  ey  pulse  x  y
─────────────────────────────────────────────────────────
   0    0    0    5    0     1     0   5   5         5  0
   1    0    0    5    5     1     0   5   5         5  0
   2    1    0    5    2     1     0   5   4     +Y  5  1
   3    1    1    5    7     1     0   5   4         5  1
   4    2    2    5    4     1     0   5   3     +Y  5  2
   5    3    4    5    1     1     0   5   2     +Y  5  3
   6    3    7    5    6     1     0   5   2         5  3
   7    4    2    4    3     1     0   4   1   -X+Y  4  4
   8    4    6    4    7     1     0   4   1         4  4
   9    5    2    3    3     1     0   3   0   -X+Y  3  5
  10    5    7    3    3     1     0   3   0         3  5
  11    5    4    2    3     1     0   2   0     -X  2  5
  12    5    1    1    3     1     0   1   0     -X  1  5
  13    5    6    1    3     1     0   1   0         1  5
  14    5    3    0    3     1     0   0   0     -X  0  5

dda-arc: arc (5, 0) to (0, 5) counter-clockwise about (0, 0)
14 steps in 15 clocks; pulses x 5, y 5
end point (0, 5) reached exactly
";
    let printed = good("run dda-arc --from 5,0 --to 0,5 --ccw --preset zero");
    assert!(printed.starts_with(expected), "{printed}");
}

#[test]
fn comparison_integral_line_to_5_3() {
    for weights in ["mid", "pre", "post"] {
        let table = judged(&format!("cim-line --to 5,3 --weights {weights}"));
        assert_eq!(table.heading.join(","), "step,clock,f,a,b,base,ex,ey,dx,dy,x,y");
        assert_eq!(table.column("f"), [0, -2, 1, -1, 2, 0]);
        assert_eq!((table.pulses("x"), table.pulses("y")), (vec![1, 2, 3, 4, 5], vec![1, 3, 5]));
        assert_eq!(table.column("base"), [0; 6]);
    }
}

#[test]
fn comparison_integral_ellipse_clockwise_in_quadrant_3() {
    let table = judged("cim-conic --ellipse 3,2 --from 0,-2 --to -3,0 --cw --weights post");
    assert_eq!(table.column("f"), [0, -5, 3, -15]);
    assert_eq!(table.path(), [(0, -2), (-1, -1), (-2, -1), (-3, 0)]);
    let left: Vec<i64> = table.column("ex").iter().zip(table.column("ey")).map(|(ex, ey)| ex + ey).collect();
    assert_eq!(left, [5, 3, 2, 0]);
    // The base axis changes with the last step, and turns F over.
    assert_eq!(table.column("base"), [0, 0, 0, 1]);
}

#[test]
fn comparison_integral_arc_loads_the_deviation_of_an_axis_off_the_circle() {
    let table = on_every_engine("cim-arc --from -5,-3 --to -3,5 --cw");
    let crossing = table.path().iter().position(|&point| point == (-6, 0)).unwrap();
    // (-6, 0) is 2 off 34. After it Y is the base axis, whose weight is the smaller one, and |x| shrinks: 36 - 34 = 2
    // keeps its sign, and the first step of Y alone or both adds 1, and takes 11 off for an X pulse.
    let [fx, fy] = ["dx", "dy"].map(|name| table.column(name)[crossing + 1]);
    assert_eq!((fx, fy, table.column("f")[crossing + 1]), (1, 1, 2 + 1 - 11));
    assert_eq!(table.path().last(), Some(&(-3, 5)));
}

#[test]
fn minimum_deviation_arc_nr1() {
    let table = judged("mindev-arc --from 5,0 --to 0,5 --ccw");
    assert_eq!(table.column("f"), [0, 1, 4, 0, 0, 4, 1, 0]);
    assert_eq!((table.pulses("y"), table.pulses("x")), (vec![1, 2, 3, 4, 5], vec![3, 4, 5, 6, 7]));
}

#[test]
fn minimum_deviation_line_to_5_3() {
    // D0 = 2S - L = 1; D >= 0: diagonal, D += 2(S - L) = -4; else the axis, D += 2S = 6.
    let table = judged("mindev-line --to 5,3");
    assert_eq!(table.column("f"), [1, -3, 3, -1, 5, 1]);
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![1, 2, 3, 4, 5], vec![1, 3, 5]));
}

#[test]
fn pulse_multiplier_to_5_3_in_three_bits() {
    let table = on_every_engine("dpm-line --to 5,3 --width 3");
    assert_eq!(table.heading.join(","), "step,clock,q,mx,my,dx,dy,x,y");
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![1, 3, 4, 5, 7], vec![2, 4, 6]));
    assert_eq!(table.column("q"), [0, 1, 2, 3, 4, 5, 6, 7, 0]);
    assert_eq!(table.path().last(), Some(&(5, 3)));
}

#[test]
fn pulse_multiplier_of_one_decade() {
    // 8 in the counts 0 to 3 and 5 to 8; 7 = 4 + 2 + 1 in 1, 3, 5, 7 and 2, 6 and 4. The clock is one more than the
    // count.
    let table = on_every_engine("dpm-line --to 8,-7 --radix 10");
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![1, 2, 3, 4, 6, 7, 8, 9], vec![2, 3, 4, 5, 6, 7, 8]));
    assert_eq!(table.column("q"), [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0]);
}

#[test]
fn pulse_multiplier_of_two_units_of_two_bits() {
    // 11 = 10|11: every second clock, and of the second unit its own first and second stage: 4, 12 and 8.
    let table = on_every_engine("dpm-line --to 11,6 --cascade 2");
    assert_eq!(table.heading.join(","), "step,clock,q1,q2,mx,my,dx,dy,x,y");
    assert_eq!(table.pulses("x"), [1, 3, 4, 5, 7, 8, 9, 11, 12, 13, 15]);
    assert_eq!(table.pulses("y"), [2, 4, 6, 10, 12, 14]);
    assert_eq!(table.column("q1"), [0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0]);
    assert_eq!(table.column("q2"), [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 0]);
}

#[test]
fn pulse_multiplier_at_35_per_cent() {
    // 3 = 2 + 1 in the counts 2, 4, 6 of every ten, and 5 = 4 + 1 in the counts 1, 3, 4, 5, 7 of the second decade.
    let table = on_every_engine("dpm-line --to 5,3 --width 3 --override 35");
    let clocks = table.column("clock");
    assert_eq!(clocks[0], 1);
    assert_eq!(clocks[1..].iter().map(|clock| clock - 1).collect::<Vec<_>>(), [3, 5, 7, 13, 15, 17, 20, 23]);
    assert_eq!(table.column("o"), [0, 3, 5, 7, 13, 15, 17, 20, 23]);
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![1, 3, 4, 5, 7], vec![2, 4, 6]));
}

#[test]
fn textbooks_print_the_integrands_that_a_step_used() {
    let words = "dda-arc --from 5,0 --to 0,5 --ccw --preset zero";
    let column = |text: &str, name: &str| -> Vec<String> {
        let mut lines = text.lines();
        let place = lines.next().unwrap().split_whitespace().position(|heading| heading == name).unwrap();
        let rows = lines.skip(1).take_while(|line| !line.is_empty());
        rows.map(|row| row.split_whitespace().nth(place).unwrap().to_owned()).collect()
    };
    let text = good(&format!("run {words} --textbook"));
    // The worked table: J_VX is the 0 of the start in the first two steps, and 1 from the third on.
    let jvx = ["0", "0", "0", "1", "1", "2", "3", "3", "4", "4", "5", "5", "5", "5", "5"];
    assert_eq!(column(&text, "jvx"), jvx);
    // All else is after the step as ever.
    let plain = good(&format!("run {words}"));
    assert_eq!(column(&text, "jrx"), column(&plain, "jrx"));
    assert_eq!(column(&text, "ex"), column(&plain, "ex"));
    // After an axis the integrands are those that were loaded: (-5, 0) gives |y| = 0 and |x| = 5.
    let text = good("run dda-arc --from -3,-4 --to -4,3 --cw --preset zero --textbook");
    assert_eq!((&column(&text, "jvx")[9], &column(&text, "jvy")[9]), (&"0".to_owned(), &"5".to_owned()));
    run_refused("dda-line --to 8,6 --textbook", &["--textbook", "dda-arc, dda-conic, dda-helix"]);
    run_refused("ppc-arc --from 5,0 --to 0,5 --ccw --textbook", &["--textbook", "leave"]);
}

/// Long enough that most samples are taken together, of which the word engine sees each.
#[test]
fn reports_of_long_lines_are_those_of_an_engine_that_sees_every_sample() {
    for (from, to) in
        [("0,0", "40000,20003"), ("-7000,300", "50000,-18699"), ("5,5", "-40000,6"), ("3,-9", "-31000,-31040")]
    {
        for beats in [4, 1] {
            let report = |engine: &str| {
                let words = format!("run ppc-line --from {from} --to {to} --beats {beats} --json - --engine {engine}");
                good(&words).replace(&format!("\"engine\": \"{engine}\""), "")
            };
            assert_eq!(report("compiled"), report("word"), "{from} {to} {beats}");
        }
    }
}
