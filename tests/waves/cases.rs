//! The runs whose waves are tested.

use stepwave_models::options::{BEATS, CASCADE, END_POINT, FORM, NORMALIZE, ON_OVERFLOW, OVERRIDE, PRESET, RADIX};
use stepwave_models::{Beats, EndPoint, Form, Options, Preset, Radix};
use stepwave_nc::{Arc, Conic, Curve, Direction, Line};
use stepwave_netlist::OnOverflow;

use super::GOOD;
use crate::models::widths;

/// A run whose wave is tested.
pub(super) struct Case {
    pub(super) what: &'static str,
    pub(super) model: &'static str,
    pub(super) curve: Curve,
    pub(super) choices: Options,
}

pub(super) fn line(to: &[i64]) -> Curve {
    Curve::Line(Line::new(vec![0; to.len()], to.to_vec()).expect(GOOD))
}

fn arc(from: [i64; 2], to: [i64; 2], center: [i64; 2], direction: Direction) -> Curve {
    Curve::Arc(Arc::new(from, to, center, direction).expect(GOOD))
}

fn quarter([a, b]: [i64; 2]) -> Curve {
    Conic::ellipse([a, b], [a, 0], [0, b], [0, 0], Direction::CounterClockwise).expect(GOOD).into()
}

/// All models, in four beats and one, with every end-point scheme, overflows, negative positions and wide registers.
pub(super) fn cases() -> Vec<Case> {
    use Direction::{Clockwise, CounterClockwise};
    let (usual, one_beat) = (Options::default(), Options::default().with(&BEATS, Beats::One));
    let case = |what, model, curve, choices: &Options| Case { what, model, curve, choices: choices.clone() };
    let ending = |end_point| Options::default().with(&END_POINT, end_point);
    let overflowing = |on_overflow| widths(&[("f", 3)]).with(&ON_OVERFLOW, on_overflow);
    let preset = |preset| Options::default().with_all(&PRESET, preset);
    let bits = |bits| stepwave_netlist::Width::new(bits).ok();
    let six_axes = [9, -30, 4, 0, -17, 31];
    vec![
        case("line in four beats", "ppc-line", line(&[6, 4]), &usual),
        case("line in one beat", "ppc-line", line(&[-5, 3]), &one_beat),
        case("signed line", "ppc-line", line(&[-3, -7]), &usual.clone().with(&FORM, Form::Signed)),
        case("line counted per axis", "ppc-line", line(&[4, -4]), &ending(EndPoint::PerAxis)),
        case("line counted on the longest axis", "ppc-line", line(&[4, 9]), &ending(EndPoint::Longest)),
        case("line of one step", "ppc-line", line(&[0, -1]), &one_beat),
        case("line in wide registers", "ppc-line", line(&[6, 4]), &widths(&[("f", 63), ("x", 64), ("e", 64)])),
        case("trapped line", "ppc-line", line(&[6, 4]), &overflowing(OnOverflow::Trap)),
        case("wrapped line", "ppc-line", line(&[6, 4]), &overflowing(OnOverflow::Wrap)),
        case("saturated line", "ppc-line", line(&[6, 4]), &overflowing(OnOverflow::Saturate)),
        case("arc in four beats", "ppc-arc", arc([6, 0], [0, 6], [0, 0], CounterClockwise), &usual),
        case("full circle in one beat", "ppc-arc", arc([-3, 4], [-3, 4], [0, 0], Clockwise), &one_beat),
        case("arc far off", "ppc-arc", arc([-95, 70], [-104, 67], [-100, 70], Clockwise), &usual),
        case("arc that ends next to its circle", "ppc-arc", arc([6, 0], [-5, -4], [0, 0], CounterClockwise), &usual),
        case("comparison-integral line", "cim-line", line(&[5, 3]), &usual),
        case("comparison-integral arc", "cim-arc", arc([-5, -3], [-3, 5], [0, 0], Clockwise), &one_beat),
        case("comparison-integral ellipse", "cim-conic", quarter([3, 2]), &usual),
        case("ellipse in one beat", "ppc-conic", quarter([6, 4]), &one_beat),
        case("minimum deviation line", "mindev-line", line(&[-3, 5]), &usual),
        case("minimum deviation circle", "mindev-arc", arc([5, 0], [5, 0], [0, 0], Clockwise), &one_beat),
        case("vector line", "vector-line", line(&[-7, -2]), &one_beat),
        case("vector arc", "vector-arc", arc([5, 0], [0, 5], [0, 0], CounterClockwise), &usual),
        case("dda line", "dda-line", line(&[8, 6]), &usual),
        case("dda line of 256 iterations", "dda-line", line(&[200, -131]), &preset(Preset::Half)),
        case("dda line of six axes", "dda-line", line(&six_axes), &ending(EndPoint::PerAxis)),
        case("dda line of three axes", "dda-line", line(&[1, 2, -3]), &ending(EndPoint::Total)),
        case("normalised dda line", "dda-line", line(&[3, 2]), &widths(&[("jv", 9), ("jr", 9)]).with(&NORMALIZE, true)),
        case("pulse multiplier", "dpm-line", line(&[5, -3]), &usual),
        case("pulse multiplier of six axes", "dpm-line", line(&six_axes), &usual.clone().with(&CASCADE, bits(2))),
        case(
            "decades at 35 per cent",
            "dpm-line",
            line(&[42, 7]),
            &usual.clone().with(&RADIX, Radix::Decimal).with(&OVERRIDE, Some(35)),
        ),
        case("dda arc", "dda-arc", arc([5, 0], [0, 5], [0, 0], CounterClockwise), &usual),
        case("dda full circle", "dda-arc", arc([0, -9], [0, -9], [0, 0], Clockwise), &preset(Preset::Half)),
        case("dda arc far off", "dda-arc", arc([-103, -4], [-104, 3], [-100, 0], Clockwise), &preset(Preset::Full)),
        case(
            "normalised dda arc",
            "dda-arc",
            arc([5, 0], [0, 5], [0, 0], CounterClockwise),
            &widths(&[("jv", 6), ("jr", 6)])
                .with(&NORMALIZE, true)
                .with(&END_POINT, EndPoint::Total)
                .with_all(&PRESET, Preset::Half),
        ),
    ]
}
