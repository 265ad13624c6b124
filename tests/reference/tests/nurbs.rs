//! The table of a quarter circle as the contract prints it.

use super::super::{Sampled, sampled_nurbs};

#[test]
fn a_quarter_circle_by_the_table() {
    let points = [[1000, 0], [1000, 1000], [0, 1000]];
    let curve = Sampled {
        degree: 2,
        points: &points,
        weights: &[1 << 16, 46_341, 1 << 16],
        knots: &[0, 0, 0, 1 << 32, 1 << 32, 1 << 32],
        fraction: 16,
        step: 200 << 16,
        tolerance: None,
    };
    let rows = sampled_nurbs(&curve).unwrap();
    let places: Vec<i128> = rows.iter().map(|row| row.u).collect();
    let wanted = [
        0,
        607_399_444,
        1_171_590_880,
        1_708_413_564,
        2_230_583_355,
        2_749_166_389,
        3_274_598_556,
        3_817_547_460,
        1 << 32,
    ];
    assert_eq!(places, wanted);
    assert_eq!(rows[1].point, [64_125_589, 13_526_509]);
    let whole: Vec<[i128; 2]> = rows.iter().map(|row| row.point.map(|c| (c + (1 << 15)) >> 16)).collect();
    let wanted =
        [[1000, 0], [978, 206], [916, 402], [816, 578], [684, 729], [526, 850], [350, 937], [161, 987], [0, 1000]];
    assert_eq!(whole, wanted);
    // The chords of 200 BLU leave the circle of 1000 BLU by 5 BLU, and their halves by more than 1.2 BLU.
    let held = |tolerance| sampled_nurbs(&Sampled { tolerance: Some(tolerance), ..curve.clone() }).unwrap().len();
    assert_eq!(held(10_000_000), 9);
    assert!(held(1_200_000) > 2 * 9 - 1);
}
