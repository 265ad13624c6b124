//! A heat map as a picture of pixels: map, axes, scale and letters drawn on one plane of few colours.

use std::convert::Infallible;

use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::mono_font::iso_8859_1::{FONT_6X10, FONT_9X15_BOLD};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::raw::RawU8;
use embedded_graphics::prelude::{DrawTarget, Drawable, Pixel, PixelColor, Primitive};
use embedded_graphics::primitives::{Line, PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};

use super::super::plot::{View, cut};
use super::super::png::png;
use super::{Cell, HeatMap, SHADES};

/// Place of a colour.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Ink(u8);

impl PixelColor for Ink {
    type Raw = RawU8;
}

/// White, and grey of a point without a value; after them the shades.
const PAPER: Ink = Ink(0);
const WITHOUT: Ink = Ink(1);
const FIRST_SHADE: u8 = 2;
/// After the shades.
const OWN: [[u8; 3]; 3] = [[0; 3], [102; 3], [204, 121, 167]];
const BLACK: Ink = Ink(252);
const FRAME: Ink = Ink(253);
const MARK: Ink = Ink(254);

// Sizes in pixels.
const HEADLINE: &MonoFont<'static> = &FONT_9X15_BOLD;
const LETTERS: &MonoFont<'static> = &FONT_6X10;
/// Above the map: three lines of text, and the names of the y axis and of the scale.
const TOP: i32 = 84;
const BOTTOM: i32 = 46;
const EDGE: i32 = 14;
const TICK: i32 = 4;
const BAR: i32 = 16;
const BAR_MOST: i32 = 300;
/// Half of the mark's width.
const REACH: i32 = 8;

/// Where a text is next to its point.
#[derive(Clone, Copy)]
enum Side {
    Right,
    Left,
    Centred,
}

/// Pixels, each the place of its colour.
struct Plane {
    size: [usize; 2],
    pixels: Vec<u8>,
}

impl OriginDimensions for Plane {
    fn size(&self) -> Size {
        let [width, height] = self.size.map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        Size::new(width, height)
    }
}

impl DrawTarget for Plane {
    type Color = Ink;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Ink>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        let [width, height] = self.size;
        for Pixel(Point { x, y }, Ink(ink)) in pixels {
            if let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y))
                && x < width
                && y < height
            {
                self.pixels[y * width + x] = ink;
            }
        }
        Ok(())
    }
}

/// What the fonts have for a text: letters of Western Europe.
fn plain(text: &str) -> String {
    text.replace('\u{2212}', "-").replace('…', "...")
}

/// Width of a text in pixels.
fn width(text: &str, font: &MonoFont<'_>) -> i32 {
    let letters = i32::try_from(plain(text).chars().count()).unwrap_or(i32::MAX);
    letters.saturating_mul(pixels(font.character_size.width + font.character_spacing))
}

fn pixels(size: impl TryInto<i32>) -> i32 {
    size.try_into().unwrap_or(i32::MAX)
}

#[expect(clippy::cast_possible_truncation, reason = "a cast saturates")]
fn rounded(place: f64) -> i32 {
    place.round() as i32
}

impl Plane {
    /// White, of this width and height.
    fn new(width: i32, height: i32) -> Plane {
        let size = [width, height].map(|side| usize::try_from(side).unwrap_or(0));
        Plane { size, pixels: vec![PAPER.0; size[0] * size[1]] }
    }

    /// The middle of the text's first line is at this height.
    fn text(&mut self, font: &'static MonoFont<'static>, [x, y]: [i32; 2], side: Side, text: &str) {
        let alignment = match side {
            Side::Right => Alignment::Left,
            Side::Left => Alignment::Right,
            Side::Centred => Alignment::Center,
        };
        let place = TextStyleBuilder::new().alignment(alignment).baseline(Baseline::Middle).build();
        let text = plain(text);
        let style = MonoTextStyle::new(font, BLACK);
        // A plane takes every pixel.
        let _ = Text::with_text_style(&text, Point::new(x, y), style, place).draw(self);
    }

    fn line(&mut self, from: [i32; 2], to: [i32; 2], ink: Ink, wide: u32) {
        let [from, to] = [from, to].map(|[x, y]| Point::new(x, y));
        let _ = Line::new(from, to).into_styled(PrimitiveStyle::with_stroke(ink, wide)).draw(self);
    }

    fn fill(&mut self, [x, y]: [i32; 2], size: [i32; 2], ink: Ink) {
        let [width, height] = size.map(|side| u32::try_from(side).unwrap_or(0));
        let area = Rectangle::new(Point::new(x, y), Size::new(width, height));
        let _ = area.into_styled(PrimitiveStyle::with_fill(ink)).draw(self);
    }

    /// A line about an area.
    fn frame(&mut self, [x, y]: [i32; 2], [width, height]: [i32; 2]) {
        let (left, right, top, bottom) = (x - 1, x + width, y - 1, y + height);
        for (from, to) in [
            ([left, top], [right, top]),
            ([right, top], [right, bottom]),
            ([right, bottom], [left, bottom]),
            ([left, bottom], [left, top]),
        ] {
            self.line(from, to, FRAME, 1);
        }
    }

    /// A diamond about a point, light outside so that it shows on every shade.
    fn mark(&mut self, [x, y]: [i32; 2]) {
        for (reach, ink, wide) in [(REACH, PAPER, 4), (REACH, MARK, 2)] {
            let corners = [[x, y - reach], [x + reach, y], [x, y + reach], [x - reach, y]];
            for place in 0..4 {
                self.line(corners[place], corners[(place + 1) % 4], ink, wide);
            }
        }
    }
}

impl HeatMap {
    /// The map as a PNG file: what [`svg`](HeatMap::svg) shows, with cells of whole pixels. The same numbers give the same
    /// bytes.
    #[must_use]
    pub fn png(&self, title: &str, what: &str, unit: &str, worst: &str) -> Vec<u8> {
        let ranges = self.extent();
        let wanted = HeatMap::side(ranges);
        let zoom = [0, 1].map(|axis| {
            let cells = self.size[axis].max(1);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 620")]
            let zoom = (wanted[axis] / cells as f64).round() as usize;
            zoom.max(1)
        });
        let size = [0, 1].map(|axis| pixels(self.size[axis] * zoom[axis]));

        let headline = cut(title, 100);
        let scale = self.scale();
        let label = |range: [f64; 2]| range.map(|end| width(&format!("{end:.0}"), LETTERS));
        let left = EDGE + label(ranges[1]).into_iter().fold(30, i32::max) + TICK;
        let bar = left + size[0] + 24;
        let numbers = scale.iter().map(|(_, text)| width(text, LETTERS)).fold(width("no value", LETTERS), i32::max);
        let unit_of_scale = if unit.is_empty() { what.to_owned() } else { format!("{what} ({unit})") };
        let greatest = self.worst.map(|(number, point)| HeatMap::greatest(what, unit, number, point));
        let right = [
            left + width(&headline, HEADLINE),
            left + 24 + width(greatest.as_deref().unwrap_or_default(), LETTERS),
            left + 24 + width(worst, LETTERS),
            bar + BAR + 6 + numbers,
            bar + width(&unit_of_scale, LETTERS),
        ];
        let mut plane = Plane::new(right.into_iter().fold(0, i32::max) + EDGE, TOP + size[1].max(60) + BOTTOM);

        plane.text(HEADLINE, [left, 18], Side::Right, &headline);
        if let Some(greatest) = &greatest {
            plane.mark([left + 9, 42]);
            plane.text(LETTERS, [left + 24, 38], Side::Right, greatest);
            plane.text(LETTERS, [left + 24, 51], Side::Right, worst);
        }
        let origin = [left, TOP];
        self.cells_at(&mut plane, origin, zoom);
        plane.frame(origin, size);
        let view = View { origin: origin.map(f64::from), size: size.map(f64::from), ranges };
        self.axes_of(&mut plane, &view, size);
        if let Some((_, point)) = self.worst {
            plane.mark(view.at(point.map(|coordinate| coordinate as f64)).map(rounded));
        }
        self.scale_at(&mut plane, [bar, TOP], size[1].min(BAR_MOST), &scale, &unit_of_scale);
        png(plane.size[0], &plane.pixels, &[HeatMap::colours(), OWN.to_vec()].concat())
    }

    /// The cells, the left upper one at this place.
    fn cells_at(&self, plane: &mut Plane, [x, y]: [i32; 2], zoom: [usize; 2]) {
        let [x, y] = [x, y].map(|side| usize::try_from(side).unwrap_or(0));
        let across = plane.size[0];
        for (line, row) in plane.pixels.chunks_mut(across).skip(y).zip(self.rows(zoom)) {
            line[x..].iter_mut().zip(row).for_each(|(pixel, ink)| *pixel = ink);
        }
    }

    /// Ticks with numbers, and the names of both axes.
    fn axes_of(&self, plane: &mut Plane, view: &View, size: [i32; 2]) {
        let [left, top] = view.origin.map(rounded);
        let bottom = top + size[1];
        for axis in [0, 1] {
            for value in view.multiples(axis, view.tick(axis, 1.0)) {
                let label = format!("{:.0}", value + 0.0);
                let mut point = view.ranges.map(|[low, _]| low);
                point[axis] = value;
                let [x, y] = view.at(point).map(rounded);
                if axis == 0 {
                    plane.line([x, bottom], [x, bottom + TICK], FRAME, 1);
                    plane.text(LETTERS, [x, bottom + TICK + 8], Side::Centred, &label);
                } else {
                    plane.line([left - 1 - TICK, y], [left - 1, y], FRAME, 1);
                    plane.text(LETTERS, [left - TICK - 4, y], Side::Left, &label);
                }
            }
        }
        plane.text(LETTERS, [left + size[0] / 2, bottom + 30], Side::Centred, &format!("{} (BLU)", self.names[0]));
        plane.text(LETTERS, [left - 24, top - 14], Side::Right, &format!("{} (BLU)", self.names[1]));
    }

    /// The scale of the colours from this place downwards, its numbers next to it and its name above.
    fn scale_at(&self, plane: &mut Plane, [x, y]: [i32; 2], height: i32, scale: &[(f64, String)], name: &str) {
        plane.text(LETTERS, [x, y - 14], Side::Right, name);
        for line in 0..height {
            let part = f64::from(height - 1 - line) / f64::from((height - 1).max(1));
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 249")]
            let shade = (part * (SHADES - 1) as f64).round() as u8;
            plane.fill([x, y + line], [BAR, 1], Ink(FIRST_SHADE + shade));
        }
        plane.frame([x, y], [BAR, height]);
        for (part, text) in scale {
            let place = y + rounded(f64::from(height - 1) * (1.0 - part));
            plane.line([x + BAR, place], [x + BAR + TICK - 1, place], FRAME, 1);
            plane.text(LETTERS, [x + BAR + 6, place], Side::Right, text);
        }
        if self.cells.contains(&Cell::Without) {
            plane.fill([x, y + height + 14], [BAR, 12], WITHOUT);
            plane.frame([x, y + height + 14], [BAR, 12]);
            plane.text(LETTERS, [x + BAR + 6, y + height + 20], Side::Right, "no value");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Width and pixels of a file.
    fn read_back(file: &[u8]) -> (usize, Vec<u8>) {
        let width = u32::from_be_bytes(file[16..20].try_into().unwrap()) as usize;
        let data = file.windows(4).position(|four| four == b"IDAT").unwrap() + 4;
        let rows = miniz_oxide::inflate::decompress_to_vec_zlib(&file[data..]).unwrap();
        (width, rows.chunks(width + 1).flat_map(|row| row[1..].to_vec()).collect())
    }

    #[test]
    fn letters_and_lines_have_colours_of_their_own_after_those_of_the_cells() {
        assert_eq!(HeatMap::colours().len(), usize::from(BLACK.0));
        assert_eq!(OWN[usize::from(MARK.0 - BLACK.0)], [204, 121, 167]);
    }

    #[test]
    fn every_cell_has_its_colour_the_greatest_number_is_marked_and_the_scale_has_all_shades() {
        let mut map = HeatMap::new(["to_x", "to_y"], ["0..3", "0..1"].map(|text| text.parse().unwrap()));
        map.point([0, 0], Some(0.0));
        map.point([1, 0], Some(1.0));
        map.point([2, 1], Some(2.0));
        map.point([3, 1], None);
        let words = ["t", "error_max", "BLU", "stepwave run dda-line --to 2,1"];
        let [title, what, unit, worst] = words;
        let file = map.png(title, what, unit, worst);
        let (width, pixels) = read_back(&file);
        // 620 by 310 pixels in 4 by 2 cells of 155; near their left upper corners nothing is marked.
        let left = pixels.chunks(width).position(|row| row.contains(&253)).unwrap();
        assert_eq!(i32::try_from(left).unwrap(), TOP - 1);
        let first = pixels[left * width..].iter().position(|ink| *ink == 253).unwrap() + 1;
        let cell = |x: usize, y: usize| pixels[(left + 1 + 155 * y + 20) * width + first + 155 * x + 20];
        let row = |y| [0, 1, 2, 3].map(|x| cell(x, y));
        assert_eq!((row(0), row(1)), ([0, 0, 251, 1], [2, 127, 0, 0]));
        // The mark is about the middle of its cell.
        let middle = |x: usize, y: usize| (left + 1 + 155 * y + 77) * width + first + 155 * x + 77;
        let marked = |x, y| pixels[middle(x, y) - 12..middle(x, y)].contains(&MARK.0);
        assert!(marked(2, 0) && !marked(1, 1) && !marked(0, 0));
        assert!((2..=251).all(|shade| pixels.contains(&shade)) && pixels.contains(&BLACK.0));
        assert_eq!(file, map.png(title, what, unit, worst));
        // Letters of the words that repeat the worst: another word, another picture.
        assert_ne!(file, map.png(title, what, unit, "stepwave run dda-line --to 3,1"));
    }

    #[test]
    fn cells_are_as_wide_and_as_high_as_the_steps_of_the_grid() {
        let mut map = HeatMap::new(["to_x", "to_y"], ["0..9/3", "0..1"].map(|text| text.parse().unwrap()));
        for x in 0..4_i32 {
            for y in 0..2_i32 {
                map.point([i64::from(3 * x), i64::from(y)], Some(f64::from(x + 4 * y)));
            }
        }
        let (width, pixels) = read_back(&map.png("t", "clocks", "", "w"));
        // Columns of 155 pixels, and two rows that share the least height of a map: the lowest shade is in the left lower
        // corner.
        let row = |y: usize| pixels.chunks(width).nth(usize::try_from(TOP).unwrap() + y).unwrap();
        let left = row(20).iter().position(|ink| *ink == 253).unwrap() + 1;
        let shades = |y: usize| [0, 1, 2, 3].map(|x| row(y)[left + 155 * x + 150]);
        let height = 80;
        let [upper, lower] = [height - 2, height + 2].map(shades);
        assert!(upper.is_sorted() && lower.is_sorted() && lower[0] == 2 && upper[0] > lower[3], "{upper:?} {lower:?}");
        assert_eq!((shades(2), shades(2 * height - 2)), (upper, lower));
    }

    #[test]
    fn a_large_or_flat_grid_gives_a_picture_of_bounded_size() {
        for ranges in [["0..999999", "-500000..500000"], ["0..1000000", "7"], ["-3", "4"]] {
            let mut map = HeatMap::new(["to_x", "to_y"], ranges.map(|text| text.parse().unwrap()));
            map.point(ranges.map(|text| text.split('.').next().unwrap().parse().unwrap()), Some(1.0));
            let (width, pixels) = read_back(&map.png("t", "clocks", "", "w"));
            assert!(width < 1500 && pixels.len() / width < 1500, "{ranges:?}: {width}");
        }
    }
}
