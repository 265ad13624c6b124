//! Acceleration after the interpolator: the worked rows.

use super::super::{Filter, smooth};

#[test]
fn the_worked_periods_are_reproduced_to_the_digit() {
    let sum = smooth(Filter::Sum(4), 60, 10, 0);
    assert_eq!(sum.column("dx")[1..], [2, 5, 8, 10, 10, 10, 7, 5, 3]);
    assert_eq!(sum.column("s")[1..], [10, 20, 30, 40, 40, 40, 30, 20, 10]);
    assert_eq!(sum.column("rem")[1..], [2, 2, 0, 0, 0, 0, 2, 2, 0]);
    let exponential = smooth(Filter::Exponential(2), 40, 10, 0);
    assert_eq!(exponential.column("dx")[1..], [3, 5, 6, 7, 5, 4, 3, 2, 2, 1, 1, 1]);
}
