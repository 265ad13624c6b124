//! Lines in space: worked tables, and what the methods are known for.

use super::super::{
    AXES, EndPoint, Form, Table, cim_line, cim_space_line, mindev_line, mindev_space_line, ppc_line, ppc_space_line,
};

type InSpace = fn(&[i64], &[i64]) -> Table;
const METHODS: [InSpace; 3] = [ppc_space_line, cim_space_line, mindev_space_line];

/// The moves of a table, axis by axis in each step: `XYZ X XY`.
fn moves(table: &Table, axes: usize) -> String {
    let pulses: Vec<_> = (0..axes).map(|axis| table.column(&format!("d{}", AXES[axis]))).collect();
    let step = |row: usize| -> String {
        (0..axes).filter(|&axis| pulses[axis][row] != 0).map(|axis| AXES[axis].to_uppercase()).collect()
    };
    (1..table.rows.len()).map(step).collect::<Vec<_>>().join(" ")
}

#[test]
fn the_worked_tables_of_the_line_to_5_3_2() {
    let worked: [(&str, &[[i64; 2]]); 3] = [
        (
            "X Y Z X Y X Z X Y X",
            &[[0, 0], [-3, -2], [2, -2], [2, 3], [-1, 1], [4, 1], [1, -1], [1, 4], [-2, 2], [3, 2], [0, 0]],
        ),
        ("XYZ X XY XZ XY", &[[0, 0], [-2, -3], [1, -1], [-1, 1], [2, -2], [0, 0]]),
        ("XY XZ XY XZ XY", &[[1, -1], [-3, 3], [3, -3], [-1, 1], [5, -5], [1, -1]]),
    ];
    for (method, (steps, deviations)) in METHODS.into_iter().zip(worked) {
        let table = method(&[0, 0, 0], &[5, 3, 2]);
        assert_eq!(moves(&table, 3), steps);
        let of = |axis: usize| deviations.iter().map(|row| row[axis]).collect::<Vec<_>>();
        assert_eq!([table.column("fy"), table.column("fz")], [of(0), of(1)]);
    }
}

/// The pulses of G and of another axis, in the order in which a table has them, steps with neither left out.
fn projected(table: &Table, longest: usize, other: usize) -> Vec<[i64; 2]> {
    let [g, s] = [longest, other].map(|axis| table.column(&format!("d{}", AXES[axis])));
    g.into_iter().zip(s).map(|(g, s)| [g.abs(), s.abs()]).filter(|pulses| *pulses != [0, 0]).collect()
}

#[test]
fn each_axis_steps_against_the_longest_as_in_the_plane() {
    for x in 0..=9 {
        for (y, z) in (0..=9).flat_map(|y| (0..=9).map(move |z| (y, z))).filter(|yz| x.max(yz.0).max(yz.1) > 0) {
            let to = [x, y, z];
            let long = x.max(y).max(z);
            let first = to.iter().position(|length| *length == long).unwrap();
            let last = to.iter().rposition(|length| *length == long).unwrap();
            for other in 0..3 {
                let plane = |table: Table| projected(&table, 0, 1);
                let short = to[other];
                if other != first {
                    let table = ppc_space_line(&[0; 3], &to);
                    let wanted = plane(ppc_line([0, 0], [long, short], Form::Magnitude, EndPoint::Total));
                    assert_eq!(projected(&table, first, other), wanted, "{to:?}");
                    let table = mindev_space_line(&[0; 3], &to);
                    assert_eq!(projected(&table, first, other), plane(mindev_line([0, 0], [long, short])), "{to:?}");
                }
                if other != last {
                    let table = cim_space_line(&[0; 3], &to);
                    assert_eq!(projected(&table, last, other), plane(cim_line([0, 0], [long, short])), "{to:?}");
                }
            }
        }
    }
}

/// Greatest distance from the line of the points of a table.
fn distance(table: &Table, to: [i64; 3]) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|axis| table.column(AXES[axis]));
    let length = to.iter().map(|c| (c * c) as f64).sum::<f64>();
    let mut worst = 0f64;
    for ((x, y), z) in x.into_iter().zip(y).zip(z) {
        let cross = [y * to[2] - z * to[1], z * to[0] - x * to[2], x * to[1] - y * to[0]];
        worst = worst.max((cross.iter().map(|c| (c * c) as f64).sum::<f64>() / length).sqrt());
    }
    worst
}

#[test]
fn the_worst_lines_of_three_axes_to_40_are_where_they_are_known_to_be() {
    let known = [1.378, 1.378, 0.707];
    for (method, known) in METHODS.into_iter().zip(known) {
        let mut worst = (0.0, [0; 3]);
        for x in 1..=40 {
            for (y, z) in (0..=x).flat_map(|y| (0..=y).map(move |z| (y, z))) {
                let table = method(&[0; 3], &[x, y, z]);
                assert_eq!(table.rows.last().unwrap()[table.columns.len() - 3..], [x, y, z]);
                let distance = distance(&table, [x, y, z]);
                if distance > worst.0 + 1e-9 {
                    worst = (distance, [x, y, z]);
                }
            }
        }
        assert!((worst.0 - known).abs() < 5e-4 && worst.1 == [40, 1, 1], "{worst:?}");
    }
}
