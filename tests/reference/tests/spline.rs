//! Free curves: the worked table, and what is known of small ones.

use super::super::{Basis, Segment, spline_dda, spline_owes};

#[test]
fn the_worked_table_of_a_bezier_curve_is_reproduced_to_the_digit() {
    let table = spline_dda(&[(Basis::Bezier, vec![[0, 0], [4, 0], [8, 4], [8, 8]])], 4);
    let jrx = [2048, 1020, 4064, 2964, 1792, 524, 3232, 1700, 0, 2204, 96, 1844, 3328, 428, 1312, 1860, 2048];
    assert_eq!(table.column("jrx"), jrx);
    let px = [3068, 3044, 2996, 2924, 2828, 2708, 2564, 2396, 2204, 1988, 1748, 1484, 1196, 884, 548, 188, -196];
    assert_eq!(table.column("px"), px);
    assert_eq!(table.column("qx"), (1..=17).map(|i| -24 * i).collect::<Vec<_>>());
    assert_eq!((table.column("rx"), table.column("ry")), (vec![-24; 17], vec![-24; 17]));
    assert_eq!(table.column("x"), [0, 1, 1, 2, 3, 4, 4, 5, 6, 6, 7, 7, 7, 8, 8, 8, 8]);
    assert_eq!(table.column("y"), [0, 0, 0, 0, 1, 1, 1, 2, 3, 3, 4, 4, 5, 6, 7, 7, 8]);
    let jry: Vec<i64> = (0..17).map(|i| (-jrx[16 - i]).rem_euclid(4096)).collect();
    assert_eq!(table.column("jry"), jry);
    assert_eq!(table.column("py")[..16], px[..16].iter().rev().copied().collect::<Vec<_>>()[..]);
    assert_eq!(table.column("py")[16], 3068);
}

/// Of the 1331 curves of one axis with P0 = 0 and the others in -5..=5.
#[test]
fn more_steps_than_the_least_may_owe_a_pulse_again() {
    let sides = || -5..=5;
    let mut fails = 0;
    for p in sides().flat_map(|a| sides().flat_map(move |b| sides().map(move |c| [0, a, b, c]))) {
        let segment: [Segment; 1] = [(Basis::Bezier, p.map(|x| [x, 0]).to_vec())];
        let least = (1..).find(|&s| spline_owes(&segment, s).is_none()).unwrap();
        fails += u32::from((1..=3).any(|more| spline_owes(&segment, least + more).is_some()));
        let longest = p.windows(2).map(|pair| (pair[1] - pair[0]).abs()).max().unwrap();
        let enough = (1..).find(|&s| 1 << s >= 3 * longest).unwrap();
        assert!((enough..enough + 4).all(|s| spline_owes(&segment, s).is_none()), "{p:?}");
    }
    assert_eq!(fails, 66);
}
