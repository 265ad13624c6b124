//! With any widths a model builds, or refuses them with a remedy for the user: its netlist is never wrong.

use stepwave_models::options::{
    ADDER, BEATS, CASCADE, COMPARE, END_POINT, FORM, FRACTION, NORMALIZE, ON_OVERFLOW, OVERRIDE, PICK_OFF, RADIX, STEP,
    SYSTEM, TIMING, WIDTH,
};
use stepwave_models::{
    Adder, Beats, Compare, EndPoint, Form, Millionths, Model, ModelError, OnOverflow, Options, Radix, StepTiming,
    System, catalogue,
};
use stepwave_nc::{Conic, Curve, Direction, Helix};
use stepwave_netlist::Width;

use super::{arc, line};

/// Every form of every model: geometry, and the options other than widths.
fn forms(model: &Model) -> Vec<(Curve, Options)> {
    let curves = match model.name {
        name if name.ends_with("helix") => {
            vec![Helix::new([5, 0, 0], [0, 5, -9], [0, 0], Direction::CounterClockwise).unwrap().into()]
        }
        "dda-line" | "stepgen" | "bresenham" => vec![line(&[0, 0], &[8, -6]), line(&[1, 2, 3], &[4, -9, 12])],
        "dpm-line" => return pulse_multipliers(),
        name if name.ends_with("line") => vec![line(&[0, 0], &[6, -4])],
        name if name.ends_with("conic") => vec![
            Conic::ellipse([6, 4], [6, 0], [0, 4], [0, 0], Direction::CounterClockwise).unwrap().into(),
            Conic::parabola(4, None, [1, -2], [4, 4], [0, 0]).unwrap().into(),
        ],
        _ => vec![arc([5, 0], [0, 5], [0, 0], false), arc([7, -2], [-2, 7], [0, 0], true)],
    };
    let mut forms = Vec::new();
    for curve in curves {
        for end_point in [None, Some(EndPoint::Total), Some(EndPoint::PerAxis), Some(EndPoint::Longest)] {
            for form in [None, Some(Form::Signed)] {
                for beats in [None, Some(Beats::One)] {
                    for normalize in [false, true] {
                        for (radix, adder) in ADDERS {
                            let choices = Options::default()
                                .with(&END_POINT, end_point)
                                .with(&FORM, form)
                                .with(&BEATS, beats)
                                .with(&NORMALIZE, normalize)
                                .with(&RADIX, radix)
                                .with(&ADDER, adder);
                            if model.plan(&curve, &choices).is_ok() {
                                forms.push((curve.clone(), choices));
                            }
                        }
                    }
                }
            }
        }
        for choices in step_generators().into_iter().chain(coarse_stages()) {
            if model.plan(&curve, &choices).is_ok() {
                forms.push((curve.clone(), choices));
            }
        }
    }
    forms
}

/// The choices that step generators alone have.
fn step_generators() -> Vec<Options> {
    let timing = StepTiming { length: 1, space: 3, setup: 0, hold: 1 << 20 };
    vec![
        Options::default().with(&COMPARE, Compare::Greater),
        Options::default().with(&COMPARE, Compare::AtLeast).with(&FORM, Form::Signed),
        Options::default().with(&PICK_OFF, Some(32)).with(&TIMING, timing),
        Options::default().with(&PICK_OFF, Some(4)).with(&ON_OVERFLOW, OnOverflow::Saturate),
    ]
}

/// The choices that data sampling alone has.
fn coarse_stages() -> [Options; 1] {
    let (system, step) = (Some(System::StepFactor), Some(Millionths(500_000)));
    [Options::default().with(&SYSTEM, system).with(&FRACTION, Some(24)).with(&STEP, step)]
}

/// One unit, two of three bits, two decades, each with a feed override and without.
fn pulse_multipliers() -> Vec<(Curve, Options)> {
    let units = [
        Options::default(),
        Options::default().with(&CASCADE, Some(Width::new(3).unwrap())),
        Options::default().with(&RADIX, Radix::Decimal),
    ];
    let all =
        units.into_iter().flat_map(|units| [None, Some(35)].map(|percent| units.clone().with(&OVERRIDE, percent)));
    all.map(|choices| (line(&[0, 0], &[42, -7]), choices)).collect()
}

/// Number systems and adders.
const ADDERS: [(Option<Radix>, Option<Adder>); 4] = [
    (None, None),
    (None, Some(Adder::Serial)),
    (Some(Radix::Decimal), None),
    (Some(Radix::Decimal), Some(Adder::Serial)),
];

#[test]
#[ignore = "exhaustive"]
fn any_two_registers_of_any_width_build_or_are_refused() {
    const WIDTHS: [u64; 6] = [1, 2, 3, 8, 33, 64];
    let (mut built, mut refused) = (0, 0);
    for model in catalogue().iter() {
        for (curve, choices) in forms(model) {
            let names: Vec<String> =
                model.plan(&curve, &choices).unwrap().widths.into_keys().map(str::to_owned).collect();
            for (index, first) in names.iter().enumerate() {
                for second in &names[index..] {
                    for (a, b) in WIDTHS.iter().flat_map(|a| WIDTHS.iter().map(move |b| (*a, *b))) {
                        let widths =
                            [(first, a), (second, b)].map(|(name, bits)| (name.clone(), Width::new(bits).unwrap()));
                        let choices = choices.clone().with_single(&WIDTH, widths.into());
                        let machine = model.plan(&curve, &choices).and_then(|hardware| model.machine(&hardware));
                        match machine {
                            Ok(_) => built += 1,
                            Err(error @ (ModelError::Netlist(_) | ModelError::MissingPort(_))) => {
                                panic!("{} {choices:?}: {error}", model.name)
                            }
                            Err(_) => refused += 1,
                        }
                    }
                }
            }
        }
    }
    assert!(built > 10_000 && refused > 1_000, "{built} built, {refused} refused");
}
