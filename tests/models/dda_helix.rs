//! Digital differential analyser along helices.

use proptest::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::options::{PRESET, WIDTH};
use stepwave_models::{Options, Preset, find};
use stepwave_nc::{Curve, Direction, Helix};
use stepwave_netlist::Width;

use super::dda::{check_hang, preset_value};
use super::{check, every_lattice_arc, run, squares_below};
use crate::reference::{dda_helix, helix_words};

pub(super) fn helix(from: [i64; 3], to: [i64; 3], center: [i64; 2], clockwise: bool) -> Curve {
    let direction = if clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
    Helix::new(from, to, center, direction).unwrap_or_else(|error| panic!("{from:?} {to:?}: {error}")).into()
}

/// Compares, hang for hang, and says whether the helix hung. `spare` more bits of n than the least, and the bits of the
/// fraction.
fn check_helix(curve: &Curve, spare: u32, fraction: u32, preset: Preset, engine: EngineKind) -> bool {
    let Curve::Helix(given) = curve else { panic!("a helix") };
    let (from, to, center) = (given.from(), given.to(), given.arc().center());
    let clockwise = given.arc().direction() == Direction::Clockwise;
    let words = helix_words(from, to, center, clockwise, fraction);
    // A short fraction, rounded up, may make a word one bit longer.
    let longest = words.iter().map(|(jvz, _)| Width::needed_unsigned(jvz.unsigned_abs().into())).max().unwrap();
    let least = find("dda-helix").unwrap().plan(curve, &Options::default()).unwrap().widths["jrx"].get();
    let n = least.max(longest - longest.min(fraction)) + spare;
    let wide = |bits: u32| Width::new(bits.into()).unwrap();
    let widths = [("jvz".to_owned(), wide(n + fraction)), ("jrz".to_owned(), wide(n + fraction))];
    let choices =
        Options::default().with_all(&WIDTH, wide(n)).with_single(&WIDTH, widths.into()).with_all(&PRESET, preset);
    let presets = [n, n, n + fraction].map(|bits| preset_value(preset, bits));
    let table = dda_helix(n, fraction, from, to, center, clockwise, &words, presets);
    if table.finished {
        check("dda-helix", curve, &choices, engine, &table);
    } else {
        check_hang("dda-helix", curve, &choices, engine, &table);
    }
    !table.finished
}

#[test]
fn every_lattice_helix_up_to_radius_5_upwards_downwards_and_flat() {
    check_helices(26);
}

#[test]
#[ignore = "exhaustive"]
fn every_lattice_helix_up_to_radius_8_upwards_downwards_and_flat() {
    check_helices(65);
}

/// Of radii whose square is below this.
fn check_helices(limit: i64) {
    every_lattice_arc(&squares_below(limit), |from, to, clockwise| {
        for (rise, preset) in [(0, Preset::Zero), (1, Preset::Half), (-2, Preset::Full), (7, Preset::Zero)] {
            let curve = helix([from[0], from[1], 3], [to[0], to[1], 3 + rise], [0, 0], clockwise);
            check_helix(&curve, 0, 8, preset, EngineKind::Word);
        }
        // Steeper than the arc is wide.
        let steep = helix([from[0], from[1], 0], [to[0], to[1], -60], [0, 0], clockwise);
        assert!(!check_helix(&steep, 0, 8, Preset::Half, EngineKind::Word), "{steep:?} hangs");
    });
}

#[test]
fn a_word_that_a_short_fraction_makes_longer_has_its_bit() {
    check_helix(&helix([0, -1, 5], [0, -1, 206], [0, 0], false), 0, 4, Preset::Half, EngineKind::Word);
}

#[test]
fn helices_of_one_quadrant_and_full_turns_on_every_engine() {
    for engine in EngineKind::ALL {
        for clockwise in [true, false] {
            for rise in [-40, 0, 9] {
                for to in [[13, -4], [6, -5], [10, -13]] {
                    let curve = helix([13, -4, -7], [to[0], to[1], rise - 7], [10, -8], clockwise);
                    check_helix(&curve, 0, 8, Preset::Half, engine);
                    check_helix(&curve, 2, 3, Preset::Zero, engine);
                }
            }
        }
    }
}

#[test]
fn a_helix_comes_to_a_stand_where_its_arc_does_and_z_still_arrives() {
    let zero = Options::default().with_all(&PRESET, Preset::Zero);
    for engine in EngineKind::ALL {
        let curve = helix([3, 7, 0], [0, 8, 5], [0, 0], false);
        assert!(check_helix(&curve, 0, 8, Preset::Zero, engine));
        let ran = run("dda-helix", &curve, &zero, engine);
        assert_eq!(ran.outcome.reached, [0, 7, 5]);
        // By default it starts from half.
        assert_eq!(run("dda-helix", &curve, &Options::default(), engine).outcome.reached, [0, 8, 5]);
    }
}

#[test]
fn a_quarter_turn_to_the_digit_from_every_engine() {
    // NR1 (5, 0) to (0, 5) in three bits as the worked table of the arc has it; J_VZ = 3·256·2/π = 488.9, up.
    let curve = helix([5, 0, 0], [0, 5, 3], [0, 0], false);
    let zero = Options::default().with_all(&PRESET, Preset::Zero);
    for engine in EngineKind::ALL {
        let ran = run("dda-helix", &curve, &zero, engine);
        let column = |name: &str| -> Vec<i64> {
            let index = ran.columns.iter().position(|column| column == name).unwrap();
            ran.rows.iter().map(|row| row[index]).collect()
        };
        let pulses = |name: &str| -> Vec<usize> {
            let column = column(name);
            (0..column.len()).filter(|&step| column[step] != 0).collect()
        };
        assert_eq!(pulses("dy"), [2, 4, 5, 7, 9]);
        assert_eq!(pulses("dx"), [7, 9, 11, 12, 14]);
        // Multiples of 489 beyond 2048, 4096 and 6144: the fifth, the ninth, the thirteenth.
        assert_eq!(pulses("dz"), [5, 9, 13]);
        assert_eq!(column("jvz"), [489; 15]);
        assert_eq!(column("jrz")[..7], [0, 489, 978, 1467, 1956, 397, 886]);
        assert_eq!(ran.outcome.reached, [0, 5, 3]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn full_turns_of_any_size(
        start in prop::array::uniform2(-200i64..200),
        rise in -3000i64..3000,
        clockwise: bool,
        fraction in 4..12u32,
    ) {
        prop_assume!(start != [0, 0]);
        let curve = helix([start[0], start[1], 5], [start[0], start[1], 5 + rise], [0, 0], clockwise);
        check_helix(&curve, 0, fraction, Preset::Half, EngineKind::Word);
    }

    #[test]
    fn helices_of_any_angle(
        radius in 5f64..300.0,
        angles in prop::array::uniform2(0f64..std::f64::consts::TAU),
        rise in -2000i64..2000,
        clockwise: bool,
        center in prop::array::uniform2(-500i64..500),
    ) {
        #[expect(clippy::cast_possible_truncation, reason = "rounded, and small")]
        let point = |angle: f64| [radius * angle.cos(), radius * angle.sin()].map(|c| c.round() as i64);
        let [[x0, y0], [x1, y1]] = angles.map(point);
        let from = [center[0] + x0, center[1] + y0, 0];
        let to = [center[0] + x1, center[1] + y1, rise];
        let direction = if clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
        let curve = Helix::new(from, to, center, direction);
        prop_assume!(curve.is_ok());
        check_helix(&curve.unwrap().into(), 0, 8, Preset::Half, EngineKind::Word);
    }
}
