//! A heat map as SVG or PNG: a number for every point of a grid as a colour, with a scale of the colours, and the point of
//! the greatest number marked.
//!
//! The memory is bounded whatever the grid: of a large one several points share a cell, which shows the greatest of
//! their numbers. The same numbers give the same bytes, in whatever order they come.

mod picture;

use super::plot::{CENTRED, FONT, HEAD, Page, TITLE_FONT, View, WORST, cut, escaped, text_width};
use super::png::{base64, png};
use crate::study::Range;

/// Most cells of an axis.
const MOST_CELLS: u64 = 1024;
/// Pixels of the longer side of the map, and least of the shorter.
const MAP_MOST: f64 = 620.0;
const MAP_LEAST: f64 = 160.0;
/// Pixels of the embedded picture at least, so that cells have sharp edges however a viewer scales it.
const SHARP: usize = 1240;
const BAR: f64 = 16.0;

/// From dark to light, as even to the eye as its beginning and end: blue-violet over green to yellow.
const COLOURS: [[u8; 3]; 10] = [
    [68, 1, 84],
    [72, 40, 120],
    [62, 73, 137],
    [49, 104, 142],
    [38, 130, 142],
    [31, 158, 137],
    [53, 183, 121],
    [110, 206, 88],
    [181, 222, 43],
    [253, 231, 37],
];
/// Of a cell without a point, and of one whose point has no number.
const EMPTY: [[u8; 3]; 2] = [[255; 3], [190; 3]];
/// Colours of numbers; a picture has room for some of letters and lines besides.
const SHADES: usize = 250;

/// What is known of a cell.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Cell {
    Empty,
    /// There was a point, but no number.
    Without,
    Number(f64),
}

/// Numbers over a grid.
#[derive(Clone, Debug)]
pub struct HeatMap {
    names: [String; 2],
    ranges: [Range; 2],
    /// Cells of each axis, and points of the axis that share one.
    size: [usize; 2],
    share: [u64; 2],
    cells: Vec<Cell>,
    least: f64,
    worst: Option<(f64, [i64; 2])>,
}

/// A colour of the scale, from 0 to 1.
fn shade(place: f64) -> [u8; 3] {
    let at = place.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to the last but one")]
    let below = (at as usize).min(COLOURS.len() - 2);
    let part = at - below as f64;
    let mix = |channel: usize| {
        let [a, b] = [COLOURS[below][channel], COLOURS[below + 1][channel]].map(f64::from);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
        let level = (a + (b - a) * part).round() as u8;
        level
    };
    [mix(0), mix(1), mix(2)]
}

/// A number in at most four digits after the point.
fn number(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.replace('-', "\u{2212}") }
}

impl HeatMap {
    /// An empty map over these points, with the names of both axes.
    #[must_use]
    pub fn new(names: [&str; 2], ranges: [Range; 2]) -> HeatMap {
        let share = ranges.map(|range| range.count().div_ceil(MOST_CELLS));
        let cells = |axis: usize| ranges[axis].count().div_ceil(share[axis]);
        let size = [0, 1].map(|axis| usize::try_from(cells(axis)).unwrap_or(1));
        HeatMap {
            names: names.map(str::to_owned),
            ranges,
            size,
            share,
            cells: vec![Cell::Empty; size[0] * size[1]],
            least: f64::INFINITY,
            worst: None,
        }
    }

    /// Takes the number of a point, or that it has none; true if it is the greatest so far. A point off the grid is
    /// left out.
    pub fn point(&mut self, point: [i64; 2], number: Option<f64>) -> bool {
        let place = |axis: usize| Some(self.ranges[axis].index(point[axis])? / self.share[axis]);
        let (Some(x), Some(y)) = (place(0), place(1)) else { return false };
        let place = usize::try_from(y).unwrap_or(0) * self.size[0] + usize::try_from(x).unwrap_or(0);
        let Some(cell) = self.cells.get_mut(place) else { return false };
        let Some(number) = number.filter(|number| number.is_finite()) else {
            if *cell == Cell::Empty {
                *cell = Cell::Without;
            }
            return false;
        };
        if !matches!(*cell, Cell::Number(before) if before >= number) {
            *cell = Cell::Number(number);
        }
        self.least = self.least.min(number);
        let worst = self.worst.is_none_or(|(worst, _)| number > worst);
        if worst {
            self.worst = Some((number, point));
        }
        worst
    }

    /// The greatest number and the first point that had it.
    #[must_use]
    pub fn worst(&self) -> Option<(f64, [i64; 2])> {
        self.worst
    }

    /// The ranges of x and y that the cells cover, in BLU.
    fn extent(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| {
            let first = self.ranges[axis].at(0) as f64 - self.step(axis) / 2.0;
            [first, first + self.step(axis) * self.size[axis] as f64 * self.share[axis] as f64]
        })
    }

    /// Pixels of the map over these ranges.
    fn side(ranges: [[f64; 2]; 2]) -> [f64; 2] {
        let extent = ranges.map(|[low, high]| high - low);
        extent.map(|side| (MAP_MOST * side / extent[0].max(extent[1])).max(MAP_LEAST))
    }

    /// The sentence with the greatest number and its point.
    fn greatest(what: &str, unit: &str, number: f64, [x, y]: [i64; 2]) -> String {
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let at = format!("({x}, {y})").replace('-', "\u{2212}");
        format!("greatest {what} {}{unit} at {at}:", self::number(number))
    }

    /// The numbers next to the scale of the colours, each with its place from 0 to 1.
    fn scale(&self) -> Vec<(f64, String)> {
        let [least, greatest] = self.worst.map_or([0.0; 2], |(greatest, _)| [self.least, greatest]);
        let ticks = if least < greatest { 5 } else { 1 };
        let parts = (0..ticks).map(|place| f64::from(place) / 4.0);
        parts.map(|part| (part, number(least + (greatest - least) * part))).collect()
    }

    /// The colours of cells; after them there is room for others.
    fn colours() -> Vec<[u8; 3]> {
        let shades = (0..SHADES).map(|place| shade(place as f64 / (SHADES - 1) as f64));
        EMPTY.into_iter().chain(shades).collect()
    }

    /// The colour of each cell, the greatest y first and each as large as `zoom`: a row as it is in a picture.
    fn rows(&self, zoom: [usize; 2]) -> impl Iterator<Item = Vec<u8>> {
        let greatest = self.worst.map_or(0.0, |(greatest, _)| greatest);
        let span = if greatest > self.least { greatest - self.least } else { 1.0 };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 2 to 251")]
        let index = move |cell: &Cell| match cell {
            Cell::Empty => 0,
            Cell::Without => 1,
            Cell::Number(number) => 2 + ((number - self.least) / span * (SHADES - 1) as f64).round() as u8,
        };
        self.cells.chunks(self.size[0].max(1)).rev().flat_map(move |row| {
            let line: Vec<u8> = row.iter().flat_map(|cell| std::iter::repeat_n(index(cell), zoom[0])).collect();
            std::iter::repeat_n(line, zoom[1])
        })
    }

    /// The page, a complete SVG document: `what` the colours mean and in which unit, and words that name the marked
    /// point.
    #[must_use]
    pub fn svg(&self, title: &str, what: &str, unit: &str, worst: &str) -> String {
        let ranges = self.extent();
        let size = HeatMap::side(ranges);
        let headline = cut(title, 100);
        let left = 34.0 + ranges[1].map(|end| text_width(&format!("{end:.0}"), FONT)).into_iter().fold(30.0, f64::max);
        let view = View { origin: [left, 76.0], size, ranges };
        let mut page =
            Page(format!("<title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n", escaped(title)));
        page.text([left, 26.0], &format!(r#"font-size="{TITLE_FONT}" font-weight="bold""#), &headline);
        if let Some((greatest, point)) = self.worst {
            page.symbol(WORST, [left + 9.0, 44.0]);
            page.text([left + 24.0, 48.0], "", &HeatMap::greatest(what, unit, greatest, point));
            page.text([left + 24.0, 63.0], r#"font-family="monospace""#, worst);
        }
        page.axes(&view, [&format!("{} (BLU)", self.names[0]), &format!("{} (BLU)", self.names[1])], false, [1.0; 2]);
        self.draw(&mut page, &view);
        if let Some((_, point)) = self.worst {
            page.symbol(WORST, view.at(point.map(|coordinate| coordinate as f64)));
        }
        let right = left + size[0] + 22.0;
        let bar = self.bar(&mut page, [right, view.origin[1]], size[1], &format!("{what} ({unit})").replace(" ()", ""));
        let texts = [(&headline, TITLE_FONT), (&worst.to_owned(), FONT * 1.1)];
        let texts = texts.map(|(text, font)| left + 24.0 + text_width(text, font));
        let wide = texts.into_iter().fold(bar + 14.0, f64::max).ceil();
        let high = (view.origin[1] + size[1] + 46.0).ceil();
        let size = format!(r#"width="{wide}" height="{high}" viewBox="0 0 {wide} {high}" font-size="{FONT}""#);
        format!("<svg {HEAD} {size}>\n{}</svg>\n", page.0)
    }

    /// Distance of two points of an axis, in BLU.
    fn step(&self, axis: usize) -> f64 {
        let range = self.ranges[axis];
        if range.count() > 1 { (range.at(1) as f64) - (range.at(0) as f64) } else { 1.0 }
    }

    /// The cells as a picture, the greatest y on top.
    fn draw(&self, page: &mut Page, view: &View) {
        let zoom = self.size.map(|side| SHARP.div_ceil(side.max(1)));
        let pixels: Vec<u8> = self.rows(zoom).flatten().collect();
        let [x, y] = view.origin;
        let data = base64(&png(self.size[0] * zoom[0], &pixels, &HeatMap::colours()));
        page.0 += &format!(
            "<image x=\"{x:.2}\" y=\"{y:.2}\" width=\"{:.2}\" height=\"{:.2}\" preserveAspectRatio=\"none\" \
             href=\"data:image/png;base64,{data}\"/>\n",
            view.size[0], view.size[1],
        );
    }

    /// The scale of the colours; gives its right edge.
    fn bar(&self, page: &mut Page, [x, y]: [f64; 2], height: f64, what: &str) -> f64 {
        let colour = |[r, g, b]: [u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
        let height = height.min(300.0);
        let stops = (0..COLOURS.len()).map(|place| {
            let at = place as f64 / (COLOURS.len() - 1) as f64;
            format!("<stop offset=\"{at:.4}\" stop-color=\"{}\"/>", colour(COLOURS[place]))
        });
        let stops: String = stops.collect();
        page.0 +=
            &format!("<linearGradient id=\"scale\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">{stops}</linearGradient>\n");
        let area = |y: f64, height: f64, fill: &str| {
            format!(
                "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{BAR}\" height=\"{height:.2}\" fill=\"{fill}\" stroke=\"#666\"/>\n"
            )
        };
        page.0 += &area(y, height, "url(#scale)");
        let mut right = x + BAR;
        let mut label = |page: &mut Page, y: f64, text: &str| {
            page.text([x + BAR + 6.0, y + 4.0], "", text);
            right = right.max(x + BAR + 6.0 + text_width(text, FONT));
        };
        for (part, text) in self.scale() {
            label(page, y + height * (1.0 - part), &text);
        }
        if self.cells.contains(&Cell::Without) {
            page.0 += &area(y + height + 14.0, 12.0, &colour(EMPTY[1]));
            label(page, y + height + 20.0, "no value");
        }
        let turned = format!(r#"{CENTRED} transform="rotate(-90 {:.2} {:.2})""#, right + 14.0, y + height / 2.0);
        page.text([right + 14.0, y + height / 2.0], &turned, what);
        right + 18.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(x: &str, y: &str) -> HeatMap {
        HeatMap::new(["to_x", "to_y"], [x, y].map(|text| text.parse().unwrap()))
    }

    #[test]
    fn a_cell_shows_the_greatest_number_of_its_points_in_whatever_order_they_come() {
        let points =
            [([0, 0], Some(0.5)), ([4, 1], Some(0.25)), ([0, 0], Some(0.75)), ([2, 1], None), ([3, 0], Some(9.0))];
        let mut there = map("0..4/2", "0..1");
        points.iter().for_each(|(point, number)| _ = there.point(*point, *number));
        let mut back = map("0..4/2", "0..1");
        points.iter().rev().for_each(|(point, number)| _ = back.point(*point, *number));
        use Cell::{Empty, Number, Without};
        assert_eq!(there.cells, [Number(0.75), Empty, Empty, Empty, Without, Number(0.25)]);
        assert_eq!((there.worst(), &there.cells), (Some((0.75, [0, 0])), &back.cells));
        assert_eq!(there.svg("t", "error_max", "BLU", "w"), back.svg("t", "error_max", "BLU", "w"));
    }

    #[test]
    fn a_large_grid_takes_bounded_memory_and_keeps_its_greatest_number() {
        let mut large = map("0..999999", "-500000..500000");
        assert!(large.cells.len() <= 1 << 20);
        assert!(large.point([999_999, 500_000], Some(2.0)) && !large.point([0, -500_000], Some(1.0)));
        assert_eq!(large.cells.iter().filter(|cell| **cell == Cell::Number(2.0)).count(), 1);
        assert!(!large.point([1_000_000, 0], Some(3.0)));
    }

    #[test]
    fn the_page_has_axes_scale_and_the_words_that_repeat_the_worst() {
        let mut some = map("-3..3", "0..2");
        some.point([-3, 2], Some(0.125));
        some.point([1, 1], Some(1.0));
        some.point([2, 0], None);
        let svg = some.svg("a < b", "error_max", "BLU", "stepwave run dda-line --to 1,1");
        for part in ["to_x (BLU)", "error_max (BLU)", "stepwave run dda-line --to 1,1", "0.125", "no value", "a &lt; b"]
        {
            assert!(svg.contains(part), "{part}");
        }
    }
}
