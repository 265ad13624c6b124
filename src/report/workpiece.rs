//! The picture of a program as SVG: the programmed contour, and the pulses of the tool's centre next to it, with those after a filter
//! where they leave it; below it the speed over time.
//!
//! The memory is bounded whatever the length of the program: a long path is thinned.

use std::collections::VecDeque;
use std::io::{self, Write};

use stepwave_nc::{Cause, Direction, Point, SegmentShape, Side, ToolMove, swept};

use super::output_path::OutputPath;
use super::plot::{FONT, HEAD, Page, Pair, TITLE_FONT, View, cut, escaped, reaching, text_width};
use super::speed_chart::SpeedChart;
use super::{Report, RunFile};
use crate::engine::Rows;
use crate::testbench::{BlockReport, Observer, ObserverError, OutputPlace, OutputTrack, Step};

/// Points of the path that are kept; when they are full, every second one goes.
const PATH_LIMIT: usize = 1 << 13;
/// Segments of the contour that are kept; of a longer program the first ones.
const CONTOUR_LIMIT: usize = 4096;

// Okabe and Ito's colours; the contour pale and broad, so that it shows under the path of the tool.
const PROGRAMMED: &str = r##"stroke="#eebf99" stroke-width="5""##;
const CUT: &str = r##"stroke="#0072b2" stroke-width="1.2""##;
const RAPID: &str = r##"stroke="#009e73" stroke-width="1" stroke-dasharray="6 4""##;
const OUTPUT: &str = r##"stroke="#d55e00" stroke-width="1.2""##;
const TOOL: &str = r##"stroke="#999" stroke-width="0.8""##;

/// Collects the path of a program as seen along one axis.
pub struct Workpiece<W> {
    out: W,
    title: String,
    /// The axes shown to the right and upwards.
    axes: [usize; 2],
    contour: Vec<Vec<Pair>>,
    tools: VecDeque<(Pair, f64)>,
    /// Pieces of the path: rapid or not, and its points.
    path: Vec<(bool, Vec<Pair>)>,
    points: usize,
    stride: u64,
    seen: u64,
    last: Option<Pair>,
    ranges: [Pair; 2],
    speed: Option<SpeedChart>,
    output: Option<OutputPath>,
}

/// Height of the speed, and what is between it and the contour.
const CHART_HEIGHT: f64 = 120.0;
const BETWEEN: f64 = 58.0;

impl<W> Workpiece<W> {
    /// A picture in x and y, for an output.
    #[must_use]
    pub fn new(title: &str, out: W) -> Workpiece<W> {
        Workpiece {
            out,
            title: title.to_owned(),
            axes: [0, 1],
            contour: Vec::new(),
            tools: VecDeque::new(),
            path: Vec::new(),
            points: 0,
            stride: 1,
            seen: 0,
            last: None,
            ranges: [[0.0, 0.0]; 2],
            speed: None,
            output: None,
        }
    }

    /// With the speed over time, of a clock in Hz, a BLU in mm, and one of a rotary axis in degrees.
    #[must_use]
    pub fn with_speed(self, hz: f64, blu_mm: f64, blu_degrees: f64) -> Workpiece<W> {
        Workpiece { speed: Some(SpeedChart::new(hz, [blu_mm, blu_degrees])), ..self }
    }

    /// With the output of acceleration after the interpolator where it leaves the contour, if there is one.
    #[must_use]
    pub fn with_output(self, track: Option<OutputTrack>) -> Workpiece<W> {
        // Below it the speed is that of the output.
        let output = track.map(|track| OutputPath::new(track, self.axes));
        Workpiece { output, ..self }
    }

    fn shown(&self, point: Point) -> Pair {
        self.axes.map(|axis| point[axis])
    }

    fn thin(&mut self) {
        self.stride *= 2;
        for (_, points) in &mut self.path {
            let last = points.last().copied();
            *points = points.iter().step_by(2).copied().collect();
            points.extend(last.filter(|last| points.last() != Some(last)));
        }
        self.points = self.path.iter().map(|(_, points)| points.len()).sum();
        if self.points > PATH_LIMIT / 2 * 3 {
            // Nothing but short pieces: the oldest go.
            self.path.drain(..self.path.len() / 2);
            self.points = self.path.iter().map(|(_, points)| points.len()).sum();
        }
    }

    /// The picture so far, a complete SVG document.
    #[must_use]
    pub fn svg(&self) -> String {
        let mut view = View::equal(self.ranges, [420.0, 200.0]);
        let headline = cut(&self.title, 100);
        let mut page = Page(format!(
            "<title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            escaped(&self.title)
        ));
        let left = 70.0;
        page.text([left, 26.0], &format!(r#"font-size="{TITLE_FONT}" font-weight="bold""#), &headline);
        let mut x = left;
        for (style, name) in [
            (PROGRAMMED, "programmed contour"),
            (CUT, "tool's centre, pulse by pulse"),
            (RAPID, "rapid"),
            (TOOL, "tool at the end of a block"),
        ]
        .into_iter()
        .chain(self.output.iter().map(|_| (OUTPUT, "output, where it is off the contour")))
        {
            page.symbol(&format!(r#"<path d="M-12 0H12" {style}/>"#), [x + 12.0, 44.0]);
            page.text([x + 30.0, 48.0], "", name);
            x += 46.0 + text_width(name, FONT);
        }
        view.origin = [left, 62.0];
        let names = self.axes.map(|axis| ["x (BLU)", "y (BLU)", "z (BLU)"][axis]);
        page.axes(&view, names, true, [1.0; 2]);
        let scale = view.size[0] / (view.ranges[0][1] - view.ranges[0][0]);
        for &(at, radius) in &self.tools {
            page.symbol(&format!(r#"<circle r="{:.2}" {TOOL}/>"#, radius * scale), view.at(at));
        }
        self.contour.iter().for_each(|points| page.path(&view, PROGRAMMED, points));
        for (rapid, points) in &self.path {
            page.path(&view, if *rapid { RAPID } else { CUT }, points);
        }
        for points in self.output.iter().flat_map(OutputPath::pieces) {
            page.path(&view, OUTPUT, points);
        }
        let wide = (left + view.size[0] + 26.0).max(x).ceil();
        let mut bottom = view.origin[1] + view.size[1];
        let (origin, size) = ([left, bottom + BETWEEN], [wide - left - 26.0, CHART_HEIGHT]);
        if let Some((chart, view)) = self.speed.as_ref().and_then(|chart| Some((chart, chart.view(origin, size)?))) {
            chart.draw(&mut page, &view, self.output.is_some());
            bottom = origin[1] + CHART_HEIGHT;
        }
        let high = (bottom + 46.0).ceil();
        let size = format!(r#"width="{wide}" height="{high}" viewBox="0 0 {wide} {high}" font-size="{FONT}""#);
        format!("<svg {HEAD} {size}>\n{}</svg>\n", page.0)
    }
}

/// The programmed segment of a move, as points.
pub(super) fn outline(of: &ToolMove) -> Vec<[f64; 3]> {
    let (segment, points) = (&of.programmed, 90);
    if let Some(curve) = segment.bezier() {
        let [.., third] = segment.from;
        let point = |index: i32| curve.at(f64::from(index) / f64::from(points));
        return (0..=points).map(point).map(|[x, y]| [x, y, third]).collect();
    }
    let SegmentShape::Arc { plane, center, direction } = segment.shape else {
        return vec![segment.from, segment.to];
    };
    let angle = swept(segment, plane, center, direction);
    let angle = if direction == Direction::Clockwise { -angle } else { angle };
    let [u, v, from] = plane.of(segment.from);
    let [_, _, to] = plane.of(segment.to);
    let (dx, dy) = (u - center[0], v - center[1]);
    let point = |index: i32| {
        let part = f64::from(index) / f64::from(points);
        let (sin, cos) = (angle * part).sin_cos();
        let along = [center[0] + dx * cos - dy * sin, center[1] + dx * sin + dy * cos, from + (to - from) * part];
        plane.point(along)
    };
    (0..=points).map(point).collect()
}

impl<W: Write> RunFile for Workpiece<W> {
    fn finish(&mut self, _: &Report) -> io::Result<()> {
        let Workpiece { output, speed, .. } = self;
        if let Some(output) = output {
            output.finish(|at| sent(speed.as_mut(), at));
        }
        let svg = self.svg();
        self.out.write_all(svg.as_bytes())?;
        self.out.flush()
    }
}

/// The speed is that of the output, where there is one.
fn sent(speed: Option<&mut SpeedChart>, at: &OutputPlace) {
    if let Some(chart) = speed {
        chart.step(&at.place, at.clock);
    }
}

impl<W> Observer for Workpiece<W> {
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let Workpiece { output, speed, .. } = self;
        if let Some(output) = output {
            output.samples(rows, |at| sent(speed.as_mut(), at));
        }
        Ok(())
    }

    fn block_begun(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        if let Some(chart) = &mut self.speed {
            chart.begin(&block.of);
        }
        if let Some(output) = &mut self.output {
            output.begun(block);
        }
        let rapid = block.of.feed == stepwave_nc::Feed::Rapid;
        if self.path.last().is_none_or(|(before, _)| *before != rapid) {
            self.path.push((rapid, self.last.into_iter().collect()));
        }
        Ok(())
    }

    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        if let Some(chart) = self.speed.as_mut().filter(|_| self.output.is_none()) {
            chart.step(&step.position, step.clock);
        }
        let at = self.axes.map(|axis| step.position.get(axis).map_or(0.0, |&c| c as f64));
        self.ranges = reaching(self.ranges, at);
        self.last = Some(at);
        self.seen += 1;
        if self.seen.is_multiple_of(self.stride)
            && let Some((_, points)) = self.path.last_mut()
            && points.last() != Some(&at)
        {
            points.push(at);
            self.points += 1;
            if self.points >= PATH_LIMIT {
                self.thin();
            }
        }
        Ok(())
    }

    fn block_ended(&mut self, report: &BlockReport) -> Result<(), ObserverError> {
        if let Some(output) = &mut self.output {
            output.ended(report);
        }
        let end = self.axes.map(|axis| report.reached.get(axis).map_or(0.0, |&c| c as f64));
        if let Some((_, points)) = self.path.last_mut()
            && points.last() != Some(&end)
        {
            points.push(end);
            self.points += 1;
        }
        if self.contour.len() >= CONTOUR_LIMIT {
            return Ok(());
        }
        if report.of.cause == Cause::Programmed && report.of.feed != stepwave_nc::Feed::Rapid {
            let outline: Vec<Pair> = outline(&report.of).into_iter().map(|point| self.shown(point)).collect();
            self.ranges = outline.iter().fold(self.ranges, |ranges, &point| reaching(ranges, point));
            self.contour.push(outline);
        }
        if let Side::Left(radius) | Side::Right(radius) = report.of.side {
            self.tools.push_back((end, radius));
            self.ranges = reaching(reaching(self.ranges, end.map(|c| c - radius)), end.map(|c| c + radius));
        }
        Ok(())
    }
}
