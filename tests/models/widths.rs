//! Whatever widths are chosen, a model builds, or refuses them with the user's way out: its netlist is never wrong.

use stepwave_kernel::Width;
use stepwave_models::{
    Adder, Beats, Choices, Compare, EndPoint, Form, Millionths, Model, ModelError, OnOverflow, Radix, StepTiming,
    System, catalogue,
};
use stepwave_nc::{Conic, Curve, Direction, Helix};

use super::{arc, line};

/// Every form of every model: geometry, and the choices beside the widths.
fn forms(model: &Model) -> Vec<(Curve, Choices)> {
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
                            let choices =
                                Choices { end_point, form, beats, normalize, radix, adder, ..Choices::default() };
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
fn step_generators() -> Vec<Choices> {
    let timing = StepTiming { length: 1, space: 3, setup: 0, hold: 1 << 20 };
    vec![
        Choices { compare: Some(Compare::Greater), ..Choices::default() },
        Choices { compare: Some(Compare::AtLeast), form: Some(Form::Signed), ..Choices::default() },
        Choices { pick_off: Some(32), timing: Some(timing), ..Choices::default() },
        Choices { pick_off: Some(4), on_overflow: Some(OnOverflow::Saturate), ..Choices::default() },
    ]
}

/// The choices that data sampling alone has.
fn coarse_stages() -> [Choices; 1] {
    let (system, step) = (Some(System::StepFactor), Some(Millionths(500_000)));
    [Choices { system, fraction: Some(24), step, ..Choices::default() }]
}

/// One unit, two of three bits, two decades, each with a feed override and without.
fn pulse_multipliers() -> Vec<(Curve, Choices)> {
    let units = [
        Choices::default(),
        Choices { cascade: Some(Width::new(3).unwrap()), ..Choices::default() },
        Choices { radix: Some(Radix::Decimal), ..Choices::default() },
    ];
    let all = units
        .into_iter()
        .flat_map(|units| [None, Some(35)].map(|percent| Choices { feed_override: percent, ..units.clone() }));
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
fn any_two_registers_of_any_width_build_or_are_refused() {
    const WIDTHS: [u64; 6] = [1, 2, 3, 8, 33, 64];
    let (mut built, mut refused) = (0, 0);
    for model in catalogue() {
        for (curve, choices) in forms(model) {
            let names: Vec<String> = model.plan(&curve, &choices).unwrap().widths.into_keys().collect();
            for (index, first) in names.iter().enumerate() {
                for second in &names[index..] {
                    for (a, b) in WIDTHS.iter().flat_map(|a| WIDTHS.iter().map(move |b| (*a, *b))) {
                        let widths =
                            [(first, a), (second, b)].map(|(name, bits)| (name.clone(), Width::new(bits).unwrap()));
                        let choices = Choices { widths: widths.into(), ..choices.clone() };
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
