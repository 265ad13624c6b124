//! Free curves: how they are given, and what is refused.

use super::{Folder, good, refused, run_refused};

#[test]
fn a_bezier_curve_gives_the_worked_step_table() {
    let table = good("run spline-dda --bezier 0,0,4,0,8,4,8,8 --steps -");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines[0], "step,clock,jrx,jry,px,py,qx,qy,rx,ry,e,dx,dy,x,y");
    assert_eq!(lines[2], "1,2,1020,2236,3044,548,-48,336,-24,-24,15,1,0,1,0");
    assert_eq!(lines[17], "16,17,2048,2048,-196,3068,-408,-24,-24,-24,0,0,1,8,8");
}

#[test]
fn points_come_from_a_file_with_or_without_a_heading_or_from_the_command() {
    let folder = Folder::new();
    folder.write("a.csv", "x,y\n0,0\n30, 50\n\n60,-20\n90,30\n");
    folder.write("c.csv", "\u{feff}X,Y\r\n0,0\r\n30,50\r\n60,-20\r\n90,30\r\n");
    folder.write("b.csv", "0,0\n30,50\n60,-20\n90,30");
    for form in ["", " --b-spline"] {
        let ran = |points: &str| folder.run(&format!("run spline-dda --points {points}{form} --steps -"));
        let inline = ran("0,0,30,50,60,-20,90,30");
        assert!(inline.code == 0 && inline.out.lines().count() > 60, "{inline:?}");
        assert_eq!([ran("a.csv"), ran("b.csv"), ran("c.csv")], [inline.clone(), inline.clone(), inline]);
    }
}

#[test]
fn the_report_has_the_points_and_the_command_that_repeats_it() {
    let report: serde_json::Value =
        serde_json::from_str(&good("run spline-dda --points 0,0,30,50,60,-20,90,30 --b-spline --json -")).unwrap();
    assert_eq!(report["geometry"]["points"], serde_json::json!([[0, 0], [30, 50], [60, -20], [90, 30]]));
    assert_eq!(report["geometry"]["curve"], "uniform B-spline");
}

#[test]
fn a_step_that_owes_more_than_a_pulse_says_what_to_give() {
    let ran = Folder::new().run("run spline-dda --bezier 0,0,4,0,8,4,8,8 --divisions 3");
    assert_eq!(ran.code, 1, "{ran:?}");
    for hint in ["one_pulse", "512 - 764 = -252", "give --divisions greater than 3"] {
        assert!(ran.err.contains(hint), "{hint}: {ran:?}");
    }
}

#[test]
fn what_is_not_a_free_curve_is_refused() {
    run_refused("spline-dda", &["the curve is missing", "--bezier", "--hermite", "--points"]);
    run_refused("spline-dda --to 5,3", &["the curve is missing", "--bezier"]);
    run_refused("spline-dda --bezier 0,0,4,0,8", &["5 numbers", "X,Y of each point"]);
    run_refused("spline-dda --bezier 0,0,4,0", &["3 or 4 points", "2 were given"]);
    run_refused("spline-dda --hermite 0,0,4,0,4,4", &["tangent", "3 were given"]);
    run_refused("spline-dda --points 0,0,4,0,4,4 --b-spline", &["4 points or more", "3 were given"]);
    run_refused("spline-dda --bezier 1,1,1,1,1,1", &["single point (1, 1)", "length 0"]);
    run_refused("spline-dda --points no.csv", &["no.csv", "cannot be read"]);
    for option in ["--to 8,4", "--from 1,1", "--cw", "--ccw", "--center 1,1", "--opens +x", "--b-spline"] {
        let name = option.split(' ').next().unwrap();
        run_refused(&format!("spline-dda --bezier 0,0,4,0,8,4 {option}"), &[name, "out"]);
    }
    run_refused("spline-dda --bezier 0,0,4,0,8,4 --hermite 0,0,1,1,2,2,3,3", &["--hermite"]);
    run_refused("dda-line --to 5,3 --bezier 0,0,4,0,8,4", &["dda-line", "--bezier", "leave it out"]);
    run_refused("dda-conic --ellipse 5,4 --from 5,0 --to 0,4 --ccw --b-spline", &["--b-spline"]);
    run_refused("spline-dda --bezier 0,0,4,0,8,4 --divisions 21", &["21", "1 to 20"]);
    run_refused("spline-dda --bezier 0,0,4,0,8,4 --fraction 0", &["--fraction 0", "1 to 60"]);
    run_refused("spline-dda --bezier 0,0,4000000,0,8,4", &["2^20 steps", "more segments"]);
    refused("widths spline-dda --box 0..9x0..9", &["given in bits"]);
    refused("widths spline-dda --box 20", &["16 bits"]);
}

#[test]
fn the_file_of_points_is_never_written_over() {
    const POINTS: &str = "0,0\n30,50\n60,-20\n90,30\n";
    for (command, option) in [("run", "--steps p.csv"), ("run", "--steps ./p.csv"), ("export", "--verilog p.csv")] {
        let folder = Folder::new();
        folder.write("p.csv", POINTS);
        let ran = folder.run(&format!("{command} spline-dda --points p.csv {option}"));
        assert_eq!((ran.code, folder.read("p.csv").as_str()), (2, POINTS), "{command} {option}: {ran:?}");
        let refused = command == "export" || ran.err.contains("which this command reads and would destroy");
        assert!(refused && folder.files() == ["p.csv"], "{command} {option}: {ran:?}");
    }
}

#[test]
fn a_recorded_case_keeps_its_points_and_takes_them_from_its_folder_alone() {
    for (name, points, hint) in [
        ("curve", "curve.csv", "which this command reads and would destroy"),
        ("line", "../curve.csv", "the file of points ../curve.csv is not in the folder w"),
    ] {
        let folder = Folder::new();
        folder.make("w");
        let args = format!("args = [\"spline-dda\", \"--points\", \"{points}\"]");
        folder.write("w/cases.toml", &format!("[[case]]\nname = \"{name}\"\n{args}\n"));
        folder.write("w/curve.csv", "0,0\n30,50\n60,-20\n");
        folder.write("curve.csv", "0,0\n30,50\n60,-20\n");
        let ran = folder.run("golden record w");
        assert!(ran.code == 2 && ran.err.contains(hint), "{name}: {ran:?}");
        assert_eq!(folder.read("w/curve.csv"), "0,0\n30,50\n60,-20\n");
    }
}

#[test]
fn a_mistake_in_a_file_of_points_is_reported_with_its_line() {
    for (text, hints) in [
        ("x,y\n0,0\n1,2,3\n", ["line 3", "one point"]),
        ("0,0\n1;2\n", ["line 2", "1;2"]),
        ("x,y\n0,0\nx,y\n", ["line 3", "x"]),
        ("0,0\n1.5,2\n", ["line 2", "1.5"]),
        ("", ["0 were given", "2 points or more"]),
    ] {
        let folder = Folder::new();
        folder.write("p.csv", text);
        let ran = folder.run("run spline-dda --points p.csv --vcd w.vcd");
        assert!(ran.code == 2 && hints.iter().all(|hint| ran.err.contains(hint)), "{text:?}: {ran:?}");
        assert_eq!(folder.files(), ["p.csv"]);
    }
}

#[test]
fn a_bezier_curve_is_compared_as_polynomials_and_as_a_nurbs() {
    let folder = Folder::new();
    let table = folder.good("compare --bezier 0,0,10,20,30,-10,40,5");
    let rows: Vec<&str> = table.lines().skip(1).filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(rows, ["sampled-spline", "sampled-spline", "spline-dda"], "{table}");
    // The same rows as each alone.
    let alone = folder.good("compare sampled-spline --nurbs 0,0,1,10,20,1,30,-10,1,40,5,1");
    let words =
        |text: &str| text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect::<Vec<_>>();
    assert_eq!(words(&table)[1..3], words(&alone)[1..3]);
}

/// Every Bézier curve of coordinates of 2 bits, an axis at a time: the ranges of p, q and r over all rows, by the curve itself.
#[test]
fn least_widths_of_a_box_hold_the_differences_of_every_curve_and_one_bit_less_does_not() {
    let (k, s) = (2_u32, 5_u32);
    let folder = Folder::new();
    let json: serde_json::Value = serde_json::from_str(&folder.good("widths spline-dda --box 2 --json")).unwrap();
    assert_eq!(json["all"], true);
    let (most, steps) = ((1_i64 << k) - 1, 1_i64 << s);
    // 3 times the longest way of 6 is 18, of which 32 is the least power of two.
    assert!(3 * 2 * most <= steps && 3 * 2 * most > steps / 2);
    let mut ranges = [[0_i64; 2]; 3];
    let all = || -most..=most;
    let fours = all().flat_map(|a| all().flat_map(move |b| all().flat_map(move |c| all().map(move |d| [a, b, c, d]))));
    for [a, b, c, d] in fours {
        let at = |i: i64| {
            let (u, v) = (i, steps - i);
            a * v * v * v + 3 * b * u * v * v + 3 * c * u * u * v + d * u * u * u
        };
        for i in 0..=steps {
            let [v0, v1, v2, v3] = [0, 1, 2, 3].map(|ahead| at(i + ahead));
            for (range, value) in ranges.iter_mut().zip([v1 - v0, v2 - 2 * v1 + v0, v3 - 3 * v2 + 3 * v1 - v0]) {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
    }
    for register in json["registers"].as_array().unwrap() {
        let name = register["name"].as_str().unwrap();
        let Some(order) = ["p", "q", "r"].iter().position(|letter| name.len() == 2 && name.starts_with(letter)) else {
            continue;
        };
        let seen = ["least", "greatest"].map(|end| register[end].as_i64().unwrap());
        assert_eq!(seen, ranges[order], "{name}");
        let bits = (1..)
            .find(|bits| ranges[order].iter().all(|value| (*value >> (bits - 1)) == 0 || (*value >> (bits - 1)) == -1))
            .unwrap();
        assert_eq!(
            (register["needed"].as_i64(), register["known"].as_str()),
            (Some(bits), Some("exhaustive")),
            "{name}"
        );
        let below = register["one_bit_below"].as_str().unwrap().trim_start_matches("stepwave ").to_owned();
        assert_ne!(folder.run(&below).code, 0, "{name}: {below}");
    }
    // Hardware that is given one width has all others by default.
    let given = |words: &str| -> Vec<i64> {
        let ran = folder.run(&format!("widths spline-dda --box 2 --json {words}"));
        let json: serde_json::Value = serde_json::from_str(&ran.out).unwrap();
        json["registers"].as_array().unwrap().iter().map(|register| register["given"].as_i64().unwrap()).collect()
    };
    assert_eq!(folder.run("widths spline-dda --box 2 --width e=6").code, 0);
    assert_eq!(given("--width e=6"), given(""));
}

/// Where 2^s steps are too few for some curves of a box, widths are known of the others alone, and the verdict says how many
/// these are: those of which no axis goes farther than a BLU in a step, by the curve itself.
#[test]
fn widths_of_a_part_of_a_box_are_never_called_exhaustive() {
    let folder = Folder::new();
    for (s, share) in [(1_u32, "304 of 2394"), (3, "1240 of 2394"), (4, "2236 of 2394"), (5, "exhaustive")] {
        let steps = 1_i64 << s;
        let (mut drawn, mut all) = (0_usize, 0_usize);
        for index in 0..7_i64.pow(4) {
            let [a, b, c, d] = [1, 7, 49, 343].map(|place| index / place % 7 - 3);
            if [b, c, d] == [a; 3] {
                continue;
            }
            let at = |i: i64| {
                let (u, v) = (i, steps - i);
                a * v * v * v + 3 * b * u * v * v + 3 * c * u * u * v + d * u * u * u
            };
            all += 1;
            drawn += usize::from((0..steps).all(|i| (at(i + 1) - at(i)).abs() <= steps.pow(3)));
        }
        assert_eq!(share, if drawn == all { "exhaustive".to_owned() } else { format!("{drawn} of {all}") });
        let table = folder.good(&format!("widths spline-dda --box 2 --divisions {s}"));
        let whole = drawn == all;
        assert_eq!(table.contains("exhaustive"), whole, "{table}");
        let known = table.lines().skip(3).filter(|line| line.contains("stepwave run"));
        assert!(known.clone().count() == 9 && known.clone().all(|line| line.contains(share)), "{table}");
        assert_eq!(
            table.starts_with(&format!("spline-dda: {share} geometries of 2 bits, all that run to their end\n")),
            !whole
        );
        let text = folder.good(&format!("widths spline-dda --box 2 --divisions {s} --json"));
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!((&json["all"], &json["ran"], &json["geometries"]), (&whole.into(), &drawn.into(), &all.into()));
        assert!(json["registers"].as_array().unwrap().iter().all(|register| register["known"] == share), "{text}");
    }
}
