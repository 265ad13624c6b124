//! Cubic Bézier curves of a box.

use stepwave_models::Options;
use stepwave_models::options::{DIVISIONS, FRACTION};
use stepwave_nc::{Curve, Nurbs, Spline, SplineForm};
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
    let fours = fours(&values);
    let curve = |(x, y): (&[i64; 4], &[i64; 4])| Spline::new(SplineForm::Bezier, &points(x, y)).ok().map(Curve::Spline);
    fours.iter().zip(fours.iter().rev()).filter_map(curve).collect()
}

/// Extreme ones among the same curves, as NURBS: the step of u follows from both axes at once, so that all of them would be
/// those of every four on one axis with every four on the other. Each axis has all fours of the greatest coordinate, of
/// none and of the least; the other one rests, goes with it or against it, or is as it is backwards.
pub(super) fn nurbs(k: u32, _: bool) -> Vec<Curve> {
    let greatest = (1_i64 << k) - 1;
    let fours = fours(&[-greatest, 0, greatest]);
    let both = fours.iter().flat_map(|own| {
        let rest = [0; 4];
        let against = own.map(|coordinate| -coordinate);
        let [a, b, c, d] = *own;
        [(*own, rest), (rest, *own), (*own, *own), (*own, against), (*own, [d, c, b, a])]
    });
    both.filter_map(|(x, y)| Nurbs::bezier(&points(&x, &y)).ok().map(Into::into)).collect()
}

/// All fours of these values.
fn fours(values: &[i64]) -> Vec<[i64; 4]> {
    let four = |index: usize| {
        let digit = |place: u32| values[index / values.len().pow(place) % values.len()];
        [3, 2, 1, 0].map(digit)
    };
    (0..values.len().pow(4)).map(four).collect()
}

fn points(x: &[i64; 4], y: &[i64; 4]) -> Vec<[i64; 2]> {
    x.iter().zip(y).map(|(x, y)| [*x, *y]).collect()
}

/// The choices with as many bits of fraction as the greatest coordinate has by default.
pub(super) fn fractioned(choices: &Options, k: u32) -> Options {
    match choices.value(&FRACTION) {
        Some(_) => choices.clone(),
        None => choices.clone().with(&FRACTION, Some(k + 8)),
    }
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
