//! Cubic Bézier curves of a box.

use stepwave_models::Options;
use stepwave_models::options::DIVISIONS;
use stepwave_nc::{Curve, Spline, SplineForm};
use stepwave_netlist::Width;

/// Cubic Bézier curves whose control points have coordinates of k bits. Each
/// axis has registers of its own, which its four coordinates alone decide: the curves have all fours of a coordinate on each of their
/// axes, or the extreme ones, two different ones at once.
pub(super) fn curves(k: u32, all: bool) -> Vec<Curve> {
    let greatest = (1_i64 << k) - 1;
    let values: Vec<i64> = match all {
        true => (-greatest..=greatest).collect(),
        false => vec![-greatest, -1, 0, 1, greatest],
    };
    let count = values.len().pow(4);
    let four = |index: usize| {
        let digit = |place: u32| values[index / values.len().pow(place) % values.len()];
        [3, 2, 1, 0].map(digit)
    };
    let curve = |index: usize| {
        let (x, y) = (four(index), four(count - 1 - index));
        let points: Vec<[i64; 2]> = x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
        Spline::new(SplineForm::Bezier, &points).ok().map(Curve::Spline)
    };
    (0..count).filter_map(curve).collect()
}

/// The choices with as many steps as any of them may need: three times the longest way between two neighbouring points.
pub(super) fn divided(choices: &Options, k: u32) -> Options {
    if choices.value(&DIVISIONS).is_some() {
        return choices.clone();
    }
    let steps = 6 * ((1_u128 << k) - 1);
    let s = Width::needed_unsigned(steps - 1);
    choices.clone().with(&DIVISIONS, Some(u64::from(s)))
}
