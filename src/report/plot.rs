//! The picture of a run as SVG: the pulses as a staircase over the ideal curve, and below it the deviation after every step,
//! of an arc also over its angle, the pulses of a short run in time, and the speed over 32 steps.
//!
//! Both axes have one scale. The memory is bounded whatever the length of the run: a long path is thinned, but the
//! greatest deviation and its step are exact, and no peak is lost from the chart. The same run gives the same bytes.

mod angle;
mod envelope;
mod pulses;

use stepwave_nc::Curve;

use self::angle::Angle;
use self::envelope::Envelope;
use self::pulses::Pulses;
use crate::testbench::SpeedTrack;

/// Points of the path that are kept; when they are full, every second one goes.
const PATH_LIMIT: usize = 8192;
/// Marks that are kept, and characters of a label and of the title.
const MARK_LIMIT: usize = 8;
const LABEL_LIMIT: usize = 60;
const TITLE_LIMIT: usize = 100;
/// Steps up to which each has a dot and a bar of its own.
const FEW_STEPS: usize = 200;
/// Points of the ideal curve: on a full circle of the largest picture, less than 0.01 pixel off.
const OUTLINE_POINTS: usize = 721;

// Sizes in pixels, scales in pixels per BLU. Below the coarse scale no single pulse shows.
const SCALE_MOST: f64 = 52.0;
const SCALE_COARSE: f64 = 4.0;
const PANEL_LEAST: Pair = [280.0, 110.0];
const PANEL_MOST: Pair = [860.0, 520.0];
const CHART_HEIGHT: f64 = 120.0;
/// From one panel to the next, and below the last.
const BETWEEN: f64 = 58.0;
const BELOW: f64 = 42.0;
pub(super) const FONT: f64 = 11.0;
pub(super) const TITLE_FONT: f64 = 15.0;

// Okabe and Ito's colours. The second style is for a coarse scale: a pale band that thin pulses do not hide.
const IDEAL: [&str; 2] = [r##"stroke="#d55e00" stroke-width="1.4""##, r##"stroke="#eebf99" stroke-width="5""##];
const PULSES: [&str; 2] = [r##"stroke="#0072b2" stroke-width="1.8""##, r##"stroke="#0072b2""##];
const GRID: &str = r##"stroke="#ccc""##;
pub(super) const HEAD: &str =
    r#"xmlns="http://www.w3.org/2000/svg" font-family="Helvetica, Arial, sans-serif" fill="none""#;
pub(super) const CENTRED: &str = r#"text-anchor="middle""#;

// Symbols about the point that they mark.
const START: &str = r##"<circle r="4" fill="#000"/>"##;
const END: &str = r##"<circle r="7" stroke="#000" stroke-width="1.6"/>"##;
const CENTER: &str = r##"<path d="M-5 0H5M0 -5V5" stroke="#000"/>"##;
pub(super) const WORST: &str = r##"<path d="M0 -8L8 0L0 8L-8 0Z" stroke="#cc79a7" stroke-width="2.2"/>"##;

/// A point in x and y, a size, or the least and the greatest value of a range.
pub(super) type Pair = [f64; 2];

/// Collects the machine positions of a run, step by step, in bounded memory.
#[derive(Debug, Clone)]
pub struct Plot {
    curve: Curve,
    /// The last step and the position after it.
    last: Option<(u64, Vec<i64>)>,
    /// The ranges in x and in y, over the ideal curve and all points.
    ranges: [Pair; 2],
    /// Every `stride`-th point.
    path: Vec<Pair>,
    stride: u64,
    /// The deviation after each step.
    deviation: Envelope,
    /// The same over the angle of an arc.
    angle: Option<Angle>,
    pulses: Pulses,
    /// The speed over 32 steps, over v_max; in BLU a clock where that is not known.
    speed: Envelope,
    track: SpeedTrack,
    step_clocks: Option<f64>,
    /// The first step with the greatest magnitude of deviation, the position and the deviation.
    worst: Option<(u64, Vec<i64>, f64)>,
    /// Greatest distance of all pulses from the curve, in BLU, where it is known.
    between: Option<f64>,
    marks: Vec<(u64, Vec<i64>, String)>,
}

impl Plot {
    /// A picture of a run along a curve, still without points, by hardware whose steps take so long, in clocks, where that is
    /// known.
    #[must_use]
    pub fn new(curve: &Curve, step_clocks: Option<f64>) -> Plot {
        let ranges = curve.outline(OUTLINE_POINTS).into_iter().fold([[f64::INFINITY, f64::NEG_INFINITY]; 2], reaching);
        let track = SpeedTrack::new(curve.axes());
        Plot {
            curve: curve.clone(),
            last: None,
            ranges,
            path: Vec::new(),
            stride: 1,
            deviation: Envelope::new(0),
            angle: if let Curve::Arc(arc) = curve { Some(Angle::new(arc)) } else { None },
            pulses: Pulses::default(),
            speed: Envelope::new(SpeedTrack::STEPS),
            track,
            step_clocks,
            worst: None,
            between: None,
            marks: Vec::new(),
        }
    }

    /// Takes the position after a step, every axis of the curve in BLU, and its clock; the first one is the start of the run.
    ///
    /// A position with too few axes is left out.
    pub fn point(&mut self, position: &[i64], clock: u64) {
        let deviation = self.curve.signed_deviation(position);
        if deviation.is_nan() {
            return;
        }
        let (at, step) = (plane(position), self.last.as_ref().map_or(0, |(step, _)| step + 1));
        self.last = Some((step, position.to_vec()));
        self.ranges = reaching(self.ranges, at);

        if self.path.len() == PATH_LIMIT {
            self.path = self.path.iter().step_by(2).copied().collect();
            self.stride *= 2;
        }
        if step.is_multiple_of(self.stride) {
            self.path.push(at);
        }
        self.deviation.take(deviation);
        self.pulses.take(clock, position);
        if let Some(angle) = &mut self.angle {
            angle.take(at, deviation);
        }
        if let Some(window) = self.track.row(position, clock) {
            self.speed.take(self.step_clocks.unwrap_or(1.0) * window.speed());
        }
        if self.worst.as_ref().is_none_or(|(.., worst)| deviation.abs() > worst.abs()) {
            self.worst = Some((step, position.to_vec(), deviation));
        }
    }

    /// Marks the last point given so far, for example where an overflow trapped; before the first it does nothing.
    ///
    /// Labels at one step are joined, and cut to 60 characters. Eight steps can be marked, further ones are not.
    pub fn mark(&mut self, label: &str) {
        let Some((step, position)) = self.last.clone() else { return };
        let first = self.marks.pop_if(|mark| mark.0 == step).map_or(String::new(), |mark| mark.2 + "; ");
        if self.marks.len() < MARK_LIMIT {
            self.marks.push((step, position, cut(&(first + label), LABEL_LIMIT)));
        }
    }

    /// Reports the greatest distance of all pulses from the curve, in BLU, also of those between two points.
    pub fn between_steps(&mut self, error: f64) {
        self.between = Some(error);
    }

    /// The picture of the points given so far, a complete SVG document.
    #[must_use]
    pub fn svg(&self, title: &str) -> String {
        let (headline, symbols) = (cut(title, TITLE_LIMIT), self.symbols());
        let widths = symbols.iter().map(|(.., text)| 24.0 + text_width(text, FONT));
        let width = widths.fold(text_width(&headline, TITLE_FONT), f64::max).clamp(PANEL_LEAST[0], PANEL_MOST[0]);
        let mut panel = View::equal(self.ranges, [width, PANEL_LEAST[1]]);
        let width = panel.size[0];

        let usual = if self.curve.axes() == 2 { [-1.0, 1.0] } else { [0.0, 1.0] };
        let [least, most] = self.deviation.range().map_or(usual, |range| union(usual, range));
        let steps = self.last.as_ref().map_or(0, |(step, _)| *step) as f64;
        let (aside, above) = (0.5 + 0.012 * steps, 0.1 * (most - least));
        let ranges = [[-aside, steps + aside], [least - above, most + above]];

        let speeds = self.speed.range().map(|[slow, fast]| [0.0, fast + 0.1 * fast.max(slow).max(0.1)]);
        let left = 32.0 + label_width(panel.ranges[1]).max(label_width(ranges[1]));
        let coarse = usize::from(panel.scale(0) < SCALE_COARSE);
        let mut page =
            Page(format!("<title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n", escaped(title)));
        page.text([left, 26.0], &format!(r#"font-size="{TITLE_FONT}" font-weight="bold""#), &headline);
        panel.origin = [left, page.legend([left, 48.0], width, coarse, &symbols)];
        self.draw_path(&mut page, &panel, coarse);
        symbols.iter().for_each(|(point, symbol, _)| page.symbol(symbol, panel.at(*point)));
        let mut top = panel.origin[1] + panel.size[1] + BETWEEN;
        let mut chart = |height: f64, ranges: [Pair; 2]| {
            let view = View { origin: [left, top], size: [width, height], ranges };
            top += height + BETWEEN;
            view
        };
        self.draw_deviation(&mut page, &chart(CHART_HEIGHT, ranges), steps);
        if let Some(angle) = &self.angle {
            angle.draw(&mut page, &chart(CHART_HEIGHT, [angle.range(), ranges[1]]));
        }
        if let Some(height) = self.pulses.height() {
            self.pulses.draw(&mut page, &chart(height, self.pulses.ranges()));
        }
        if let Some(speeds) = speeds {
            self.draw_speed(&mut page, &chart(CHART_HEIGHT, [ranges[0], speeds]), steps);
        }
        let (wide, high) = ((left + width + 26.0).ceil(), (top - BETWEEN + BELOW).ceil());
        let size = format!(r#"width="{wide}" height="{high}" viewBox="0 0 {wide} {high}" font-size="{FONT}""#);
        format!("<svg {HEAD} {size}>\n{}</svg>\n", page.0)
    }

    /// The symbols of the panel, the topmost last: point, shape and text.
    fn symbols(&self) -> Vec<(Pair, String, String)> {
        let mut symbols = vec![(plane(self.curve.from()), START.to_owned(), "start".to_owned())];
        symbols.push((plane(self.curve.to()), END.to_owned(), "programmed end".to_owned()));
        let center = if let Curve::Arc(arc) = &self.curve { Some(plane(&arc.center())) } else { None };
        let seen = center.filter(|&center| reaching(self.ranges, center) == self.ranges);
        symbols.extend(seen.map(|center| (center, CENTER.to_owned(), "centre".to_owned())));
        if let Some((step, position, deviation)) = &self.worst {
            let mut text = format!("greatest deviation {deviation:.3} BLU, step {step} at {}", coordinates(position));
            // A step of several pulses may go farther off than where it ends.
            if let Some(error) = self.between.filter(|error| error - deviation.abs() > 5e-4) {
                text = format!("{text}; between steps {error:.3} BLU");
            }
            symbols.push((plane(position), WORST.to_owned(), text.replace('-', "\u{2212}")));
        }
        for (number, (step, position, label)) in (1..).zip(&self.marks) {
            let digit = format!(r##"<text y="3.5" fill="#fff" font-size="10" {CENTRED}>{number}</text>"##);
            let text = format!("{label}, step {step} at {}", coordinates(position));
            symbols.push((plane(position), format!(r##"<circle r="6" fill="#000"/>{digit}"##), text));
        }
        symbols
    }

    fn draw_path(&self, page: &mut Page, view: &View, coarse: usize) {
        page.axes(view, ["x (BLU)", "y (BLU)"], true, [1.0; 2]);
        let path: Vec<Pair> = self.path.iter().copied().chain(self.last.iter().map(|last| plane(&last.1))).collect();
        page.path(view, IDEAL[coarse], &self.curve.outline(OUTLINE_POINTS));
        page.path(view, PULSES[coarse], &path);
        if coarse == 0 && self.path.len() <= FEW_STEPS + 1 {
            let dot = format!(r##"<circle r="{:.1}" fill="#0072b2"/>"##, (0.16 * view.scale(0)).clamp(1.2, 2.4));
            self.path.iter().for_each(|&point| page.symbol(&dot, view.at(point)));
        }
    }

    /// The deviation against the step as an area from zero: bars if they are few, otherwise an envelope.
    fn draw_deviation(&self, page: &mut Page, view: &View, steps: f64) {
        let step = format!("step (deviation {})", self.curve.positive_side());
        page.axes(view, [&step, "deviation (BLU)"], false, [1.0, 0.1]);
        let spans = &self.deviation.spans;
        let gap = if spans.len() <= FEW_STEPS + 1 { (0.5 - 8.0 / view.scale(0)).max(0.15) } else { 0.0 };
        let (mut area, mut below) = (Vec::new(), Vec::new());
        for (place, &[least, most]) in spans.iter().enumerate() {
            let [from, to] = self.deviation.place(place, steps);
            let (from, to) = (from + gap, to - gap);
            for (side, end) in [(&mut area, most.max(0.0)), (&mut below, least.min(0.0))] {
                let foot = if gap > 0.0 { 0.0 } else { end };
                side.extend([[from, foot], [from, end], [to, end], [to, foot]]);
            }
        }
        area.extend(below.into_iter().rev());
        page.path(view, r##"fill="#56b4e9""##, &area);
        page.levels(view);
        self.worst.iter().for_each(|(step, _, worst)| page.symbol(WORST, view.at([*step as f64, *worst])));
    }

    /// The speed against the last step of a window, as an area from the least to the greatest of each span.
    fn draw_speed(&self, page: &mut Page, view: &View, steps: f64) {
        let unit = if self.step_clocks.is_some() { "v/v_max" } else { "BLU/clock" };
        page.axes(view, ["step (speed over the 32 steps to it)", unit], false, [1.0, 0.1]);
        let (mut upper, mut lower) = (Vec::new(), Vec::new());
        for (place, &[least, most]) in self.speed.spans.iter().enumerate() {
            let [from, to] = self.speed.place(place, steps);
            upper.extend([[from, most], [to, most]]);
            lower.extend([[from, least], [to, least]]);
        }
        upper.extend(lower.into_iter().rev());
        page.path(view, r##"fill="#56b4e9" stroke="#0072b2""##, &upper);
    }
}

/// A rectangle of the page, by its upper left corner and its size in pixels, that shows a rectangle of the data.
pub(super) struct View {
    pub(super) origin: Pair,
    pub(super) size: Pair,
    pub(super) ranges: [Pair; 2],
}

impl View {
    /// Shows two ranges and a margin, with one scale for both, and more if a greater size is needed.
    pub(super) fn equal(ranges: [Pair; 2], least: Pair) -> View {
        let extent = ranges.map(|[low, high]| high - low);
        let padded = extent.map(|side| side + 2.0 * (0.04 * extent[0].max(extent[1])).max(0.7));
        let scale = SCALE_MOST.min(PANEL_MOST[0] / padded[0]).min(PANEL_MOST[1] / padded[1]);
        let size = [0, 1].map(|axis| (padded[axis] * scale).clamp(least[axis], PANEL_MOST[axis]));
        let margin = [0, 1].map(|axis| (size[axis] / scale - extent[axis]) / 2.0);
        let ranges = [0, 1].map(|axis| [ranges[axis][0] - margin[axis], ranges[axis][1] + margin[axis]]);
        View { origin: [0.0; 2], size, ranges }
    }

    /// Pixels per unit of an axis.
    fn scale(&self, axis: usize) -> f64 {
        self.size[axis] / (self.ranges[axis][1] - self.ranges[axis][0])
    }

    /// The place on the page.
    pub(super) fn at(&self, [x, y]: Pair) -> Pair {
        let (right, down) = (x - self.ranges[0][0], self.ranges[1][1] - y);
        [self.origin[0] + right * self.scale(0), self.origin[1] + down * self.scale(1)]
    }

    /// The distance of the ticks of an axis: 1, 2 or 5 times a power of ten, and wide enough for the labels.
    pub(super) fn tick(&self, axis: usize, finest: f64) -> f64 {
        let room = if axis == 0 { label_width(self.ranges[0]) + 14.0 } else { 24.0 };
        let decades = std::iter::successors(Some(finest), |decade| Some(decade * 10.0));
        let mut ticks = decades.flat_map(|decade| [1.0, 2.0, 5.0].map(|factor| factor * decade));
        ticks.find(|tick| tick * self.scale(axis) >= room).unwrap_or(f64::MAX)
    }

    /// The multiples of a step within the range of an axis, 256 at most.
    pub(super) fn multiples(&self, axis: usize, step: f64) -> impl Iterator<Item = f64> {
        let [low, high] = self.ranges[axis];
        let first = (low / step).ceil();
        (0..=u8::MAX).map(move |n| (first + f64::from(n)) * step).take_while(move |value| *value <= high)
    }
}

/// The elements so far.
pub(super) struct Page(pub(super) String);

impl Page {
    pub(super) fn path(&mut self, view: &View, style: &str, points: &[Pair]) {
        let places = points.iter().map(|&point| view.at(point));
        let mut data: Vec<String> = places.map(|[x, y]| format!("{x:.2} {y:.2}")).collect();
        data.dedup();
        if !data.is_empty() {
            self.0 += &format!("<path d=\"M{}\" {style}/>\n", data.join("L"));
        }
    }

    pub(super) fn symbol(&mut self, symbol: &str, [x, y]: Pair) {
        self.0 += &format!("<g transform=\"translate({x:.2} {y:.2})\">{symbol}</g>\n");
    }

    pub(super) fn text(&mut self, [x, y]: Pair, style: &str, text: &str) {
        let text = escaped(text);
        self.0 += &format!("<text x=\"{x:.2}\" y=\"{y:.2}\" fill=\"#000\" {style}>{text}</text>\n");
    }

    /// Symbols with their texts, in rows from a point on; returns where the next element may start.
    fn legend(&mut self, [left, mut y]: Pair, width: f64, coarse: usize, symbols: &[(Pair, String, String)]) -> f64 {
        let ideal = (format!(r#"<path d="M-9 0H9" {}/>"#, IDEAL[coarse]), "ideal curve");
        let pulses = (format!(r#"<path d="M-9 4H-3V0H3V-4H9" {}/>"#, PULSES[coarse]), "pulses");
        let items = symbols.iter().map(|(_, symbol, text)| (symbol.clone(), text.as_str()));
        let mut x = left;
        for (symbol, text) in [ideal, pulses].into_iter().chain(items) {
            let room = 24.0 + text_width(text, FONT);
            if x > left && x + room > left + width {
                (x, y) = (left, y + 18.0);
            }
            self.symbol(&symbol, [x + 9.0, y - 4.0]);
            self.text([x + 24.0, y], "", text);
            x += room + 12.0;
        }
        y + 12.0
    }

    /// Lines where a deviation is 0, and where it is 1 BLU.
    fn levels(&mut self, view: &View) {
        for (level, dash) in [(0.0, "none"), (1.0, "5 3"), (-1.0, "5 3")] {
            if level == 0.0 || (level > view.ranges[1][0] && view.scale(1) > 6.0) {
                let style = format!(r##"stroke="#000" stroke-dasharray="{dash}""##);
                self.path(view, &style, &view.ranges[0].map(|along| [along, level]));
            }
        }
    }

    /// Grid, ticks no finer than given to the right and upwards, none where that is infinite, frame and names of both axes;
    /// where `pulses` show, a fine line for every BLU.
    pub(super) fn axes(&mut self, view: &View, names: [&str; 2], pulses: bool, finest: Pair) {
        let ticks = [view.tick(0, finest[0]), view.tick(1, finest[1])];
        let ticks = if pulses { [ticks[0].max(ticks[1]); 2] } else { ticks };
        let fine = (pulses && view.scale(0) >= 8.0).then_some((1.0, r##"stroke="#eee""##));
        for (axis, tick) in ticks.into_iter().enumerate() {
            for (step, style) in fine.into_iter().chain([(tick, GRID)]) {
                for value in view.multiples(axis, step) {
                    let [mut from, mut to] = [0, 1].map(|end| view.ranges.map(|range| range[end]));
                    (from[axis], to[axis]) = (value, value);
                    self.path(view, style, &[from, to]);
                    if style == GRID {
                        let [x, y] = view.at(from);
                        let label = format!("{:.*}", usize::from(tick < 1.0), value + 0.0).replace('-', "\u{2212}");
                        let (at, place) =
                            [([x, y + 15.0], CENTRED), ([x - 6.0, y + 4.0], r#"text-anchor="end""#)][axis];
                        self.text(at, place, &label);
                    }
                }
            }
        }
        let ([x, y], [width, height]) = (view.origin, view.size);
        let [[left, right], [low, high]] = view.ranges;
        self.path(view, r##"stroke="#666""##, &[[left, low], [left, high], [right, high], [right, low], [left, low]]);
        self.text([x + width / 2.0, y + height + 31.0], CENTRED, names[0]);
        let turned = format!(r#"{CENTRED} transform="rotate(-90 14 {:.2})""#, y + height / 2.0);
        self.text([14.0, y + height / 2.0], &turned, names[1]);
    }
}

/// The first two axes of a position.
fn plane(position: &[i64]) -> Pair {
    [0, 1].map(|axis| position.get(axis).map_or(0.0, |&coordinate| coordinate as f64))
}

fn coordinates(position: &[i64]) -> String {
    format!("({})", position.iter().map(i64::to_string).collect::<Vec<_>>().join(", ")).replace('-', "\u{2212}")
}

fn union(a: Pair, b: Pair) -> Pair {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The ranges in x and in y, extended to a point.
pub(super) fn reaching([x, y]: [Pair; 2], point: Pair) -> [Pair; 2] {
    [union(x, [point[0]; 2]), union(y, [point[1]; 2])]
}

/// A generous guess of the width of a text, in pixels.
pub(super) fn text_width(text: &str, font: f64) -> f64 {
    text.chars().map(|c| if c < '\u{1100}' { 0.56 } else { 1.0 }).sum::<f64>() * font
}

/// The width of the labels of an axis.
fn label_width(range: Pair) -> f64 {
    range.map(|end| text_width(&format!("{end:.0}"), FONT)).into_iter().fold(text_width("-1.0", FONT), f64::max)
}

/// A text of at most this many characters, with an ellipsis where it was cut.
pub(super) fn cut(text: &str, limit: usize) -> String {
    let long = text.chars().nth(limit).is_some();
    if long { text.chars().take(limit - 1).chain(['…']).collect() } else { text.to_owned() }
}

/// A text as XML content; characters that XML does not have are replaced.
pub(super) fn escaped(text: &str) -> String {
    let foreign = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    text.replace(foreign, "\u{fffd}").replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use stepwave_nc::{Arc, Direction, Line};

    /// Checks that every element closes where it must, and that no text holds a bare bracket.
    fn check_markup(svg: &str) {
        let mut open = Vec::new();
        for part in svg.split('<').skip(1) {
            let (tag, text) = part.split_once('>').unwrap_or_default();
            match tag.strip_prefix('/') {
                Some(name) => assert_eq!(open.pop(), Some(name)),
                None if tag.ends_with('/') => {}
                None => open.push(tag.split(' ').next().unwrap()),
            }
            assert!(!tag.is_empty() && tag.matches('"').count() % 2 == 0 && !text.contains('>'), "{part}");
        }
        assert!(open.is_empty(), "{open:?}");
    }

    #[test]
    fn the_picture_is_well_formed_and_always_the_same_and_its_texts_are_escaped() {
        let mut plot = Plot::new(&Arc::new([6, 0], [0, 6], [0, 0], Direction::CounterClockwise).unwrap().into(), None);
        check_markup(&plot.svg("no points"));
        (1..).zip([[6, 0], [5, 0], [5, 1]]).for_each(|(clock, position)| plot.point(&position, clock));
        plot.mark("jr < 0 & f > 5");
        let svg = plot.svg("R \"6\" <&>\u{1}");
        check_markup(&svg);
        assert_eq!(svg, plot.clone().svg("R \"6\" <&>\u{1}"));
        assert!(svg.contains("<title>R \"6\" &lt;&amp;&gt;\u{fffd}</title>"), "{svg}");
        assert!(svg.contains("jr &lt; 0 &amp; f &gt; 5, step 2 at (5, 1)"), "{svg}");
    }

    #[test]
    fn a_million_points_take_bounded_memory_and_keep_the_greatest_deviation() {
        let mut plot = Plot::new(&Line::new(vec![0, 0], vec![1_000_000, 0]).unwrap().into(), Some(4.0));
        for x in 0..=1_000_000_u32 {
            let y = if x == 765_432 { -3 } else { i64::from(x % 2) };
            // A step of eight clocks in the middle of others of four.
            plot.point(&[x.into(), y], u64::from(4 * x) + if x > 500_000 { 4 } else { 0 });
        }
        assert!(plot.path.len() <= PATH_LIMIT);
        assert!([&plot.deviation, &plot.speed].iter().all(|envelope| envelope.spans.len() <= envelope::SPAN_LIMIT));
        let [slow, fast] = plot.speed.range().unwrap();
        assert!((slow - 32.0 / 33.0).abs() < 1e-12 && (1.0..1.01).contains(&fast), "{slow} {fast}");
        assert!(plot.svg("long").contains(">v/v_max</text>"));
        assert_eq!(plot.worst, Some((765_432, vec![765_432, -3], -3.0)));
        assert_eq!(plot.deviation.range(), Some([-3.0, 1.0]));
        assert!(plot.svg("long").len() < 300_000);
    }
}
