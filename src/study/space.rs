//! The geometries of a sweep: cells of a grid, random samples of them, or the lines of a file. Every geometry has a
//! number, from which alone it is made, so that any part of a sweep can be done anywhere.

use stepwave_models::Millionths;
use stepwave_nc::{Curve, Description, Direction, Drawn, GeometryError};

use super::{Range, free_curves};

/// A grid of geometries: every size, with every start point, with every end point, in every direction.
#[derive(Clone, Debug)]
pub struct Cells {
    /// The curve.
    pub drawn: Drawn,
    /// Radius of circles, and height of helices; semi-axes or parameter of conics; of free curves all that gives them, as
    /// in a [`Description`].
    pub sizes: Vec<Range>,
    /// Start points; none where the size gives it: (R, 0), or the vertex, about the centre.
    pub from: Option<Vec<Range>>,
    /// End points; none where the curve comes back to its start (a helix at its height).
    pub to: Option<Vec<Range>>,
    /// Centre.
    pub center: [i64; 2],
    /// Directions; one that does not count for lines and open curves.
    pub directions: Vec<Direction>,
    /// How far the two radii of an arc may differ beyond what rounding makes, in BLU.
    pub radii: Millionths,
}

/// A geometry, or why there is none.
pub type Geometry = Result<Curve, GeometryError>;

impl Cells {
    fn ranges(&self) -> impl Iterator<Item = &Range> {
        self.sizes.iter().chain(self.from.iter().flatten()).chain(self.to.iter().flatten())
    }

    /// How many cells there are; saturates.
    #[must_use]
    pub fn count(&self) -> u128 {
        let directions = self.directions.len().max(1) as u128;
        self.ranges().fold(directions, |cells, range| cells.saturating_mul(range.count().into()))
    }

    /// The geometry of a cell; none where the ends of the cell lie on no such curve.
    #[must_use]
    pub fn site(&self, cell: u64) -> Option<(Description, Geometry)> {
        let mut rest = cell;
        let mut digit = |count: u64| {
            let digit = rest % count;
            rest /= count;
            digit
        };
        let direction = self.directions.get(usize::try_from(digit(self.directions.len().max(1) as u64)).ok()?);
        // The last axis changes fastest.
        let ranges: Vec<&Range> = self.ranges().collect();
        let mut numbers: Vec<i64> = ranges.iter().rev().map(|range| range.at(digit(range.count()))).collect();
        numbers.reverse();
        let (sizes, points) = numbers.split_at(self.sizes.len());
        if self.drawn.is_spline() {
            return Some(free_curves::site(self.drawn, sizes.to_vec()));
        }
        let (from, to) = points.split_at(self.from.as_ref().map_or(0, Vec::len));
        let from = if self.from.is_some() { from.to_vec() } else { self.vertex(sizes) };
        let mut to = if self.to.is_some() { to.to_vec() } else { from.clone() };
        if let (Drawn::Helix, None, Some(z), Some(height)) = (self.drawn, &self.to, to.get_mut(2), sizes.get(1)) {
            *z = z.saturating_add(*height);
        }
        let direction = direction.copied().unwrap_or(Direction::CounterClockwise);
        let (drawn, sizes, center, radii) = (self.drawn, sizes.to_vec(), self.center, self.radii.units());
        let site = Description { drawn, sizes, from, to, center, direction, radii };
        let geometry = site.curve();
        let none = self.count() > 1 && geometry.as_ref().is_err_and(lies_on_no_curve);
        (!none).then_some((site, geometry))
    }

    /// Where a curve of this size begins.
    fn vertex(&self, sizes: &[i64]) -> Vec<i64> {
        let [x, y] = self.drawn.vertex(sizes.first().copied().unwrap_or(0));
        let mut start = vec![self.center[0].saturating_add(x), self.center[1].saturating_add(y)];
        start.resize(self.drawn.axes(), 0);
        start
    }
}

/// The points of a cell are no ends of one curve, as most of a grid are not.
fn lies_on_no_curve(error: &GeometryError) -> bool {
    matches!(
        error,
        GeometryError::EndOffCircle { .. }
            | GeometryError::EndAtCenter { .. }
            | GeometryError::ZeroRadius { .. }
            | GeometryError::OffCurve { .. }
            | GeometryError::OffBranch { .. }
            | GeometryError::EndsAcrossCurve { .. }
            | GeometryError::ZeroLengthConic { .. }
    )
}

/// Cells that a random sample looks at until one holds a geometry.
const TRIES: u64 = 1 << 16;

/// All geometries of a sweep.
#[derive(Clone, Debug)]
pub enum Space {
    /// Every cell of a grid.
    Cells(Cells),
    /// Random cells of a grid, drawn anew each time; the same for the same seed.
    Samples {
        /// The grid.
        cells: Cells,
        /// How many.
        count: u64,
        /// Distinguishes this draw from others.
        seed: u64,
    },
    /// The geometries of a file.
    Points {
        /// In the order of its lines.
        points: Vec<Description>,
        /// Distinguishes the file from others of the same name.
        content: u64,
    },
}

impl Space {
    /// How many numbers there are; some may have no geometry.
    #[must_use]
    pub fn count(&self) -> u128 {
        match self {
            Space::Cells(cells) => cells.count(),
            Space::Samples { count, .. } => u128::from(*count),
            Space::Points { points, .. } => points.len() as u128,
        }
    }

    /// The geometry with a number, if there is one.
    #[must_use]
    pub fn site(&self, number: u64) -> Option<(Description, Geometry)> {
        match self {
            Space::Cells(cells) => cells.site(number),
            Space::Samples { cells, seed, .. } => {
                let mut draw = Draw::new(*seed, number);
                let count = u64::try_from(cells.count()).unwrap_or(u64::MAX);
                (0..TRIES).find_map(|_| cells.site(draw.below(count)))
            }
            Space::Points { points, .. } => {
                let site = points.get(usize::try_from(number).ok()?)?.clone();
                let geometry = site.curve();
                Some((site, geometry))
            }
        }
    }

    /// The ranges of end points, or of start points where these are the ones that vary, or of the first point of free
    /// curves that does: what a map shows.
    #[must_use]
    pub fn map(&self) -> Option<(String, [Range; 2])> {
        let (Space::Cells(cells) | Space::Samples { cells, .. }) = self else { return None };
        if cells.drawn.is_spline() {
            return free_curves::map(cells.drawn, &cells.sizes);
        }
        let varies = |ranges: &&Vec<Range>| ranges.iter().take(2).any(|range| range.count() > 1);
        let plane = |ranges: &Vec<Range>| Some([*ranges.first()?, *ranges.get(1)?]);
        let to = cells.to.as_ref().filter(varies).and_then(plane).map(|ranges| ("to".to_owned(), ranges));
        to.or_else(|| cells.from.as_ref().filter(varies).and_then(plane).map(|ranges| ("from".to_owned(), ranges)))
    }

    /// The curves, and the axes of their points.
    pub(super) fn drawn(&self) -> Option<(Drawn, usize)> {
        match self {
            Space::Cells(cells) | Space::Samples { cells, .. } => {
                let axes = cells.to.as_ref().or(cells.from.as_ref()).map_or(2, Vec::len);
                // A travel of one axis is a line.
                let least = if cells.drawn == Drawn::Line { axes } else { cells.drawn.axes() };
                Some((cells.drawn, axes.max(least)))
            }
            Space::Points { points, .. } => points.first().map(|site| (site.drawn, site.to.len())),
        }
    }

    /// Most points of a free curve.
    pub(super) fn points(&self) -> usize {
        match self {
            Space::Cells(cells) | Space::Samples { cells, .. } => {
                let first: Vec<i64> = cells.sizes.iter().map(|range| range.at(0)).collect();
                free_curves::count(cells.drawn, &first)
            }
            Space::Points { points, .. } => {
                let counts = points.iter().map(|site| free_curves::count(site.drawn, &site.sizes));
                counts.max().unwrap_or(0)
            }
        }
    }
}

/// Random numbers that follow from a seed and a number alone.
struct Draw(u64);

impl Draw {
    fn new(seed: u64, number: u64) -> Draw {
        let mut draw = Draw(seed);
        let mixed = draw.next() ^ number;
        Draw(Draw(mixed).next())
    }

    /// The splitmix generator: a counter and a mixer of 64 bits.
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// One of so many.
    fn below(&mut self, count: u64) -> u64 {
        // The high half of a product of 128 bits is less than `count`.
        let product = u128::from(self.next()) * u128::from(count);
        u64::try_from(product >> 64).unwrap_or(0)
    }
}

/// Which geometries of a sweep are done here: every `of`-th, from `number` on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SweepPart {
    /// From 1.
    pub number: u64,
    /// How many parts there are.
    pub of: u64,
}

impl SweepPart {
    /// The only part.
    pub const WHOLE: SweepPart = SweepPart { number: 1, of: 1 };

    /// How many of `all` geometries this part has.
    #[must_use]
    pub fn count(self, all: u64) -> u64 {
        all.saturating_add(self.of).saturating_sub(self.number) / self.of
    }

    /// Number in the whole sweep of this part's geometry `place`.
    #[must_use]
    pub fn geometry(self, place: u64) -> u64 {
        place * self.of + self.number - 1
    }
}

#[cfg(test)]
mod tests {
    use stepwave_nc::Opens;

    use super::*;

    fn cells(drawn: Drawn, sizes: &[&str], to: Option<[&str; 2]>) -> Cells {
        let range = |text: &&str| text.parse::<Range>().unwrap();
        Cells {
            drawn,
            sizes: sizes.iter().map(range).collect(),
            from: (drawn == Drawn::Line).then(|| vec![Range::one(0); 2]),
            to: to.map(|to| to.iter().map(range).collect()),
            center: [0, 0],
            directions: vec![Direction::CounterClockwise],
            radii: Millionths(0),
        }
    }

    fn all(space: &Space) -> Vec<Geometry> {
        (0..u64::try_from(space.count()).unwrap()).filter_map(|number| Some(space.site(number)?.1)).collect()
    }

    #[test]
    fn a_grid_of_lines_has_every_end_point_and_reports_the_one_at_the_start() {
        let lines = all(&Space::Cells(cells(Drawn::Line, &[], Some(["0..2", "-1..1/2"]))));
        let ends: Vec<Vec<i64>> = lines.iter().flatten().map(|line| line.to().to_vec()).collect();
        assert_eq!(ends, [[0, -1], [0, 1], [1, -1], [1, 1], [2, -1], [2, 1]]);
        let lines = all(&Space::Cells(cells(Drawn::Line, &[], Some(["0..1", "0..1"]))));
        assert_eq!((lines.len(), lines[0].clone()), (4, Err(GeometryError::ZeroLength)));
    }

    #[test]
    fn circles_are_whole_or_end_at_every_grid_point_within_one_blu_of_them() {
        let whole = all(&Space::Cells(cells(Drawn::Arc, &["1..4"], None)));
        assert!(whole.iter().flatten().all(|arc| arc.from() == arc.to()) && whole.len() == 4);
        let arcs = all(&Space::Cells(cells(Drawn::Arc, &["5"], Some(["-9..9", "-9..9"]))));
        let near = |x: i64, y: i64| ((x * x + y * y) as f64).sqrt();
        let expected = (-9..=9).flat_map(|x| (-9..=9).map(move |y| near(x, y))).filter(|r| (r - 5.0).abs() <= 1.0);
        assert_eq!(arcs.len(), expected.count());
        assert!(arcs.iter().all(Result::is_ok));
    }

    #[test]
    fn conics_and_helices_begin_at_their_vertex() {
        let ellipses = all(&Space::Cells(cells(Drawn::Ellipse, &["2..3", "1"], None)));
        assert_eq!(ellipses.iter().flatten().map(Curve::from).collect::<Vec<_>>(), [[2, 0], [3, 0]]);
        let branches = cells(Drawn::Hyperbola(Some(Opens::MinusY)), &["4", "3"], Some(["-20..20", "-20..20"]));
        let branches = all(&Space::Cells(branches));
        assert!(branches.len() > 10 && branches.iter().flatten().all(|branch| branch.from() == [0, -4]));
        let helices = all(&Space::Cells(cells(Drawn::Helix, &["5", "-2..2/2"], None)));
        let ends: Vec<&[i64]> = helices.iter().flatten().map(Curve::to).collect();
        assert!(ends.contains(&[5, 0, -2].as_slice()) && ends.contains(&[5, 0, 2].as_slice()), "{helices:?}");
    }

    #[test]
    fn samples_follow_from_the_seed_and_lie_in_the_grid() {
        let cells = cells(Drawn::Line, &[], Some(["1..1000", "-50..50"]));
        let samples = |seed| all(&Space::Samples { cells: cells.clone(), count: 200, seed });
        assert_eq!(samples(7), samples(7));
        assert_ne!(samples(7), samples(8));
        let ends: Vec<Vec<i64>> = samples(7).iter().flatten().map(|line| line.to().to_vec()).collect();
        assert!(ends.len() == 200 && ends.iter().all(|end| (1..=1000).contains(&end[0]) && end[1].abs() <= 50));
        let mean = ends.iter().map(|end| end[0]).sum::<i64>() / 200;
        assert!((400..600).contains(&mean), "{mean}");
    }

    #[test]
    fn the_parts_have_every_geometry_once() {
        for (all, of) in [(0, 3), (1, 3), (10, 3), (12, 5), (7, 1)] {
            let mut seen: Vec<u64> = (1..=of)
                .flat_map(|number| {
                    let part = SweepPart { number, of };
                    (0..part.count(all)).map(move |place| part.geometry(place))
                })
                .collect();
            seen.sort_unstable();
            assert_eq!(seen, (0..all).collect::<Vec<_>>(), "{all} in {of}");
        }
    }
}
