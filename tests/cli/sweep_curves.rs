//! `sweep` of free curves: ranges of the coordinates of their points, or points from a file.

use super::sweep::{assert_as_run, rows};
use super::{Folder, good, refused};
use crate::reference::{Basis, spline_dda};

#[test]
fn ends_and_errors_of_swept_free_curves_are_those_of_the_curves_in_exact_numbers() {
    let all = rows(&good("sweep spline-dda --bezier 0,0,-5..5/5,-5..5/5,-5..5/5,5,4,-5..5/5 --csv -"));
    assert_eq!(all.len(), 81);
    for row in &all {
        let number = |name: String| row[&name].parse::<i64>().unwrap();
        let points: Vec<[i64; 2]> =
            (0..4).map(|index| ["x", "y"].map(|axis| number(format!("p{index}_{axis}")))).collect();
        let s = number("steps".to_owned()).ilog2();
        let table = spline_dda(&[(Basis::Bezier, points.clone())], s);
        let column = |name: &str| table.columns.iter().position(|column| column == name).unwrap();
        let last = table.rows.last().unwrap();
        for (axis, pulse) in [("x", "dx"), ("y", "dy")] {
            assert_eq!(number(format!("reached_{axis}")), last[column(axis)], "{row:?}");
            let pulses: i64 = table.rows.iter().map(|row| row[column(pulse)].abs()).sum();
            assert_eq!(number(format!("pulses_{axis}")), pulses, "{row:?}");
        }
        // The distance of each row from the curve, looked for along 4000 parts of it.
        let at = |u: f64| {
            let weights = [(1.0 - u).powi(3), 3.0 * u * (1.0 - u).powi(2), 3.0 * u * u * (1.0 - u), u.powi(3)];
            [0, 1].map(|axis| (0..4).map(|point| weights[point] * points[point][axis] as f64).sum::<f64>())
        };
        let curve: Vec<[f64; 2]> = (0..=4000).map(|part| at(f64::from(part) / 4000.0)).collect();
        let off = |row: &Vec<i64>| {
            let place = ["x", "y"].map(|axis| row[column(axis)] as f64);
            curve.iter().map(|c| (c[0] - place[0]).hypot(c[1] - place[1])).fold(f64::MAX, f64::min)
        };
        let worst = table.rows.iter().map(off).fold(0.0, f64::max);
        let reported: f64 = row["error_max"].parse().unwrap();
        assert!((worst - reported).abs() < 0.01, "{worst}: {row:?}");
    }
}

#[test]
fn free_curves_of_a_file_are_those_of_the_grid_and_parts_join() {
    let folder = Folder::new();
    let grid = rows(&folder.good("sweep spline-dda --bezier 0,0,3..5,0,8,4 --csv -"));
    folder.write("c.csv", "curve,p0_x,p0_y,p1_x,p1_y,p2_x,p2_y,p3_x,p3_y\nbezier,0,0,3,0,8,4,,\nbezier,,,4,,8,4,,\nbezier,0,0,5,0,8,4,,\nhermite,0,0,9,0,8,4,0,9\n");
    let file = rows(&folder.good("sweep spline-dda --file c.csv --csv -"));
    assert_eq!((grid.len(), file.len()), (3, 4));
    for (one, other) in grid.iter().zip(&file) {
        assert!(one.iter().all(|(name, value)| other[name] == *value), "{one:?}\n{other:?}");
    }
    assert_as_run("spline-dda", &file[3]);
    folder.write(
        "n.csv",
        "p0_x,p0_y,p0_w,p1_x,p1_y,p1_w,p2_x,p2_y,degree,knots\n100,0,1,100,100,0.707106781,0,100,2,\"0,0,0,1,1,1\"\n",
    );
    let nurbs = rows(&folder.good("sweep sampled-spline --file n.csv --csv -"));
    assert_eq!((nurbs[0]["p1_w"].as_str(), nurbs[0]["exact"].as_str()), ("0.707106781", "true"));
    assert_as_run("sampled-spline", &nurbs[0]);

    let sweep = "sweep spline-dda --bezier 0,0,-20..20/4,-20..20/4,40,0 --heat pulses_y --plot w.svg";
    folder.good(&format!("{sweep} --csv whole.csv"));
    assert!(folder.read("w.svg").contains("p1_x"));
    for part in 1..=2 {
        folder.good(&format!("{sweep} --shard {part}/2 --csv {part}.csv"));
    }
    folder.good("sweep merge joined.csv 2.csv 1.csv");
    assert_eq!(folder.read("joined.csv"), folder.read("whole.csv"));
    let many = vec!["1,2"; 65].join(",");
    for (words, hints) in [
        ("spline-dda --to 1,1", &["points alone", "--to"][..]),
        ("spline-dda", &["the curves are missing", "--bezier", "range"]),
        ("spline-dda --bezier 0,0,1..3,4,5", &["5 numbers", "X,Y of each point"]),
        ("spline-dda --bezier 0,0,1..3,4", &["3 or 4 points", "2 were given"]),
        ("spline-dda --nurbs 0,0,1,4,4,1", &["spline-dda", "--nurbs", "leave it out"]),
        ("sampled-spline --hermite 0,0,1,1,2,2,3,3", &["--hermite", "leave it out"]),
        ("sampled-spline --nurbs 0,0,1,4,4,a..b", &["invalid weight 'a..b'", "0.5..2/0.25"]),
        ("sampled-spline --nurbs 0,0,1,4,4,1 --degree 2", &["degree"]),
        ("sampled-spline --bezier 0,0,1..2,4", &["three or four points"]),
        ("dda-line --bezier 0,0,1..2,4,5,6", &["dda-line", "--bezier", "leave it out"]),
        (&format!("spline-dda --points {many}"), &["at most 64 points", "65 were given"]),
    ] {
        refused(&format!("sweep {words}"), hints);
    }
    for (text, hints) in [
        ("curve,p0_x,p0_y,p1_x,p1_y\nbezir,0,0,1,1\n", ["line 2", "bezier, hermite, catmull-rom, b-spline"]),
        ("curve,to_x,to_y\nbezier,0,0\n", ["to_x", "p0_x"]),
        ("curve,p0_x,p0_y\nbezier,0,0\n", ["p0_x, p0_y, p1_x", "missing"]),
    ] {
        folder.write("bad.csv", text);
        let ran = folder.run("sweep spline-dda --file bad.csv");
        assert!(ran.code == 2 && hints.iter().all(|hint| ran.err.contains(hint)), "{text}: {ran:?}");
    }
}

/// A curve so small that every row is at its end has no pulse, in a sweep as in a run.
#[test]
fn a_free_curve_without_a_pulse_ends_where_it_should() {
    let all = rows(&good("sweep spline-dda --bezier=-1,-1,-2,-2..0,-1,-1 --csv -"));
    for row in &all {
        assert_eq!([&row["pulses_x"], &row["reached_x"], &row["reached_y"], &row["exact"]], ["0", "-1", "-1", "true"]);
    }
    assert_eq!(all.len(), 3);
}

#[test]
fn what_says_something_of_other_curves_is_never_ignored() {
    let folder = Folder::new();
    folder.write("c.csv", "\u{feff}curve,p0_x,p0_y,p1_x,p1_y,p2_x,p2_y\r\nbezier,0,0,3,0,8,4\r\n");
    assert_eq!(rows(&folder.good("sweep spline-dda --file c.csv --csv -"))[0]["exact"], "true");
    for of in ["spline-dda --bezier 0,0,1,4,8,8", "spline-dda --file c.csv", "ppc-conic --ellipse 5,4 --ccw"] {
        for option in ["--b-spline", "--degree 2", "--knots 0,0,0,1,1,1"] {
            for words in [format!("sweep {of} {option}"), format!("sweep {option} {of}")] {
                let ran = folder.run(&words);
                let named = ran.err.contains(option.split(' ').next().unwrap());
                assert!(ran.code == 2 && named, "{words}: {ran:?}");
            }
        }
    }
    refused("sweep dda-helix --from 5,0,0 --height 3 --ccw", &["--height", "--radius"]);
    refused("sweep sampled-spline --nurbs 0,0,1,4,4,1..2/-0.5", &["'1..2/-0.5'", "more than 0", "0.5..2/0.25"]);
    refused("sweep sampled-spline --nurbs 0,0,1,4,4,2..1/0.5", &["'2..1/0.5'", "goes up"]);
    refused("export dda-line --to 5,3 --method ppc --netlist -", &["--method"]);
    for option in ["--tool 1=2mm", "--home 1,1,1", "--rapid 100", "--chords 0.3", "--corner circular"] {
        let name = option.split(' ').next().unwrap();
        refused(&format!("export dda-line --to 5,3 {option} --netlist -"), &[name, "--program"]);
    }
}
