//! The load words that several models share.

use stepwave_nc::{Arc, Conic, ConicSector, Crossing, Direction, Line, Sector};

use crate::hardware::Hardware;
use crate::machine::Words;
use crate::options::{END_POINT, EndPoint, Weights};

/// Quadrant and direction of a sector, and the position at its start.
pub(crate) fn sector(arc: &Arc, sector: &Sector) -> Words {
    let [x, y] = [0, 1].map(|axis| i128::from(arc.center()[axis]) + i128::from(sector.start[axis]));
    vec![
        ("quad", i128::from(sector.quadrant.index())),
        ("ccw", i128::from(arc.direction() == Direction::CounterClockwise)),
        ("x", x),
        ("y", y),
    ]
}

/// Steps of a sector: of each axis, or of both.
pub(crate) fn end_counters(hardware: &Hardware, steps: [i64; 2]) -> Words {
    let [ex, ey] = steps.map(i128::from);
    if hardware.get(&END_POINT) == EndPoint::PerAxis { vec![("ex", ex), ("ey", ey)] } else { vec![("e", ex + ey)] }
}

/// Integrands J_VX and J_VY, and the remainders.
pub(crate) fn integrators(hardware: &Hardware, [jvx, jvy]: [i128; 2]) -> Words {
    let [jrx, jry] = [(0, "jrx"), (1, "jry")].map(|(axis, name)| hardware.preset(axis, name));
    vec![("jvx", jvx), ("jvy", jvy), ("jrx", jrx), ("jry", jry)]
}

/// Integrands of a sector of an arc, J_VX = |y| and J_VY = |x|, remainders, end counters, and [`sector`].
pub(crate) fn integrated_sector(hardware: &Hardware, arc: &Arc, at: &Sector) -> Words {
    let [x, y] = at.start.map(|c| i128::from(c.abs()));
    [integrators(hardware, [y, x]), end_counters(hardware, at.steps()), sector(arc, at)].concat()
}

/// Blocks of a machine that judges every step of an arc: one where the hardware crosses the axes by itself, else one
/// for each sector.
pub(crate) fn judged_arc(hardware: &Hardware, arc: &Arc, crossing: Crossing) -> Vec<Words> {
    let sectors = arc.sectors(crossing);
    let begin = |at: &Sector| -> Words {
        let [x, y] = at.start.map(i128::from);
        let own = vec![("f", x * x + y * y - arc.radius_squared()), ("xi", x.abs()), ("yi", y.abs())];
        [own, sector(arc, at)].concat()
    };
    if hardware.get(&END_POINT) == EndPoint::PerAxis {
        let block = |sector: &Sector| [begin(sector), end_counters(hardware, sector.steps())].concat();
        return sectors.iter().map(block).collect();
    }
    // Counted to its end.
    let steps: i128 = sectors.iter().flat_map(Sector::steps).map(i128::from).sum();
    sectors.first().map(|first| [begin(first), vec![("e", steps)]].concat()).into_iter().collect()
}

/// The displacements |dx| and |dy| of a line in two axes, and the words of its directions and start.
pub(crate) fn line(line: &Line) -> ([i128; 2], Words) {
    let [dx, dy] = [0, 1].map(|axis| i128::from(line.delta()[axis]));
    let words = vec![
        ("sx", i128::from(dx < 0)),
        ("sy", i128::from(dy < 0)),
        ("x", i128::from(line.from()[0])),
        ("y", i128::from(line.from()[1])),
    ];
    ([dx.abs(), dy.abs()], words)
}

/// As [`line`], with the words of the long axis.
pub(crate) fn judged_line(at: &Line) -> ([i128; 2], Words) {
    let ([a, b], mut words) = line(at);
    words.extend([("x_is_longest", i128::from(a >= b)), ("e", a.max(b))]);
    ([a, b], words)
}

/// Directions and growth of a sector of a conic, and the position at its start.
pub(crate) fn conic_sector(conic: &Conic, sector: &ConicSector) -> Words {
    let [x, y] = [0, 1].map(|axis| i128::from(conic.center()[axis]) + i128::from(sector.start[axis]));
    vec![
        ("sx", i128::from(sector.motion[0] < 0)),
        ("sy", i128::from(sector.motion[1] < 0)),
        ("x_grows", i128::from(sector.grows[0])),
        ("y_grows", i128::from(sector.grows[1])),
        ("x", x),
        ("y", y),
    ]
}

/// F of comparison-integral at the start of a sector whose point has these interval weights: with `mid` the exact
/// `deviation` there, turned over where an X step lowers it, and once more where Y is the base axis.
pub(crate) fn weighed(rule: Weights, [a, b]: [i128; 2], x_raises: bool, deviation: i128) -> i128 {
    let base_x = a < b;
    match rule {
        Weights::Mid if x_raises == base_x => deviation,
        Weights::Mid => -deviation,
        Weights::Pre | Weights::Post => 0,
    }
}
