//! The columns of `sweep --ripple`, against what the rows of a step table say one by one.

use super::sweep::{assert_as_run, rows};
use super::{Folder, good, refused};

/// Least and greatest speed over v_max, and the ripple, of a table of `run --steps` with these columns of places: a step takes
/// `beats` clocks, and the curve has this length.
fn recomputed(table: &str, axes: &[&str], beats: f64, length: f64) -> [f64; 3] {
    let heading: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let place = |name: &str| heading.iter().position(|column| *column == name).unwrap();
    let (clock, axes) = (place("clock"), axes.iter().map(|axis| place(axis)).collect::<Vec<_>>());
    let numbers = |line: &str| line.split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect::<Vec<f64>>();
    let steps: Vec<Vec<f64>> = table.lines().skip(1).map(numbers).collect();
    let window = (steps.len() - 1).min(32);
    let speeds = steps.windows(window + 1).map(|rows| {
        let (first, last) = (&rows[0], &rows[window]);
        let apart = axes.iter().map(|&axis| (last[axis] - first[axis]).powi(2)).sum::<f64>().sqrt();
        beats * apart / (last[clock] - first[clock])
    });
    let [least, greatest] =
        speeds.fold([f64::INFINITY, 0.0], |[least, greatest], speed| [least.min(speed), greatest.max(speed)]);
    let mean = beats * length / (steps[steps.len() - 1][clock] - steps[0][clock]);
    [least, greatest, (greatest - least) / mean]
}

#[test]
fn extremes_of_the_speed_are_those_of_the_step_table() {
    let folder = Folder::new();
    let mut checked = 0;
    for (model, geometries, options, beats, axes) in [
        ("ppc-line", "--to-grid 3..120/39x-62..70/44", "", 4.0, &["x", "y"][..]),
        ("ppc-line", "--to-grid 3..120/39x-62..70/44", "--beats 1", 1.0, &["x", "y"]),
        ("dda-line", "--to-grid 3..120/39x-62..70/44", "", 1.0, &["x", "y"]),
        ("cim-line", "--to-grid 3..120/39x-62..70/44", "", 4.0, &["x", "y"]),
        ("ppc-line", "--to-grid 3..90/29x-62..70/44x5..40/35", "--beats 1", 1.0, &["x", "y", "z"]),
        // Blocks are loaded at each quadrant.
        ("dda-arc", "--radius 5..47/7 --ccw", "--preset half", 1.0, &["x", "y"]),
        ("ppc-arc", "--radius 5..47/7 --cw", "", 4.0, &["x", "y"]),
    ] {
        let all = rows(&good(&format!("sweep {model} {geometries} {options} --ripple --csv -")));
        for row in &all {
            let number = |name: String| row[&name].parse::<f64>().unwrap();
            let point = |end: &str| axes.iter().map(|axis| number(format!("{end}_{axis}"))).collect::<Vec<_>>();
            let (from, to) = (point("from"), point("to"));
            let list = |place: &[f64]| place.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
            let (turn, length) = match row.get("direction") {
                Some(direction) => (format!(" --{direction}"), std::f64::consts::TAU * from[0].hypot(from[1])),
                None => (String::new(), from.iter().zip(&to).map(|(a, b)| (b - a).powi(2)).sum::<f64>().sqrt()),
            };
            let words = format!("run {model} --from {} --to {} {options}{turn} --steps -", list(&from), list(&to));
            let expected = recomputed(&folder.good(&words), axes, beats, length);
            for (name, expected) in ["v_least", "v_greatest", "ripple"].into_iter().zip(expected) {
                let given = row[name].parse::<f64>().unwrap();
                assert!((given - expected).abs() < 1e-12, "{name} of {words}: {given}, not {expected}");
            }
            checked += 1;
        }
    }
    assert!(checked > 80, "{checked}");
    // The worked line of the documentation.
    let all = rows(&good("sweep ppc-line --to-grid 100x62 --beats 1 --ripple --csv -"));
    let said = ["v_least", "v_mean", "v_greatest", "ripple"].map(|name| all[0][name].parse::<f64>().unwrap());
    assert_eq!(said.map(|number| (number * 1e4).round() / 1e4), [0.7194, 0.7263, 0.7289, 0.0130]);
    assert_as_run("ppc-line", &all[0]);
}

#[test]
fn all_other_columns_are_what_they_are_without_it() {
    let folder = Folder::new();
    for words in
        ["dda-line --to-grid -9..20x-9..20", "ppc-arc --radius 1..40 --ccw --cw", "sampled-line --to-grid 9..99/30x7"]
    {
        folder.good(&format!("sweep {words} --csv plain.csv"));
        folder.good(&format!("sweep {words} --ripple --csv ripple.csv"));
        let (plain, ripple) = (rows(&folder.read("plain.csv")), rows(&folder.read("ripple.csv")));
        assert_eq!(plain.len(), ripple.len());
        for (plain, ripple) in plain.iter().zip(&ripple) {
            assert_eq!(ripple.len(), plain.len() + 3);
            assert!(plain.iter().all(|(name, value)| ripple[name] == *value), "{plain:?}\n{ripple:?}");
        }
    }
    // A map of it wants the columns.
    refused("sweep dda-line --to-grid 1..9x1..9 --heat ripple --plot a.svg", &["'ripple'", "give --ripple"]);
    folder.good("sweep dda-line --to-grid 1..9x1..9 --ripple --heat ripple --plot a.svg");
}
