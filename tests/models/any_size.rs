//! Lines and full circles of any size, by every method of two curves whose recurrences take no width.

use proptest::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::Beats;

use super::{cim, mindev_vector};

type CheckLine = fn([i64; 2], [i64; 2], Beats, EngineKind);
type CheckArc = fn([i64; 2], [i64; 2], [i64; 2], bool, Beats, EngineKind);

const METHODS: [(CheckLine, CheckArc); 2] =
    [(cim::check_line, cim::check_arc), (mindev_vector::check_line, mindev_vector::check_arc)];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn lines_of_any_size(from in prop::array::uniform2(-100_000i64..100_000), d in prop::array::uniform2(-3000i64..3000)) {
        prop_assume!(d != [0, 0]);
        for (check_line, _) in METHODS {
            check_line(from, [from[0] + d[0], from[1] + d[1]], Beats::One, EngineKind::Word);
        }
    }

    #[test]
    fn full_circles_of_any_size(start in prop::array::uniform2(-400i64..400), clockwise: bool) {
        prop_assume!(start != [0, 0]);
        for (_, check_arc) in METHODS {
            check_arc(start, start, [0, 0], clockwise, Beats::Four, EngineKind::Word);
        }
    }
}
