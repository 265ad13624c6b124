//! Helices over the arcs of a box.

use stepwave_models::Region;
use stepwave_models::extremes::{self, Reach};
use stepwave_nc::{Curve, Helix};

use super::sizes;

/// The arcs inside a quadrant of k-bit coordinates, each with every travel in z that has k bits; or the extreme ones of
/// both.
pub(super) fn helices(k: u32, all: bool) -> Vec<Curve> {
    let region = Region::QuadrantArcs;
    let kinds = region.kinds();
    let mut arcs: Vec<Curve> = if all {
        region.curves(k, usize::MAX)
    } else {
        extremes::arcs([Reach::within((1 << k) - 1); 2]).into_iter().filter_map(extremes::inside).collect()
    };
    arcs.retain(|arc| kinds.iter().any(|kind| region.symbols(kind, arc).is_some()));
    let travels = if all {
        sizes(k, true)
    } else {
        let greatest = (1 << k) - 1;
        vec![1, greatest / 2 + 1, greatest]
    };
    let mut helices = Vec::new();
    for arc in &arcs {
        let Curve::Arc(arc) = arc else { continue };
        for z in travels.iter().flat_map(|z| [*z, -z]).chain([0]) {
            let [[x, y], [to_x, to_y]] = [arc.from(), arc.to()];
            helices.extend(Helix::new([x, y, 0], [to_x, to_y, z], [0, 0], arc.direction()).ok().map(Curve::Helix));
        }
    }
    helices
}
