//! What was measured as a drawing: curves over two logarithmic axes, as SVG.

use std::fmt::Write as _;

/// A curve: a name, and points.
pub(crate) struct Series {
    pub(crate) name: &'static str,
    pub(crate) points: Vec<[f64; 2]>,
}

/// A pair of axes with their curves.
pub(crate) struct Panel {
    pub(crate) title: &'static str,
    /// What the horizontal axis counts.
    pub(crate) across: &'static str,
    pub(crate) series: Vec<Series>,
}

/// Size of a panel with its margins, and the margins.
const WIDTH: f64 = 430.0;
const HEIGHT: f64 = 330.0;
const LEFT: f64 = 60.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 46.0;
const COLOURS: [&str; 4] = ["#0b6e99", "#c1440e", "#3f7d20", "#6b4c9a"];

/// Panels side by side; those without a point are left out.
pub(crate) fn svg(panels: &[Panel]) -> String {
    let panels: Vec<&Panel> =
        panels.iter().filter(|panel| panel.series.iter().any(|series| !series.points.is_empty())).collect();
    let across = WIDTH * f64::from(u32::try_from(panels.len()).unwrap_or(0));
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {across} {HEIGHT}\" width=\"{across}\" \
         height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"11\">\n\
         <rect width=\"{across}\" height=\"{HEIGHT}\" fill=\"white\"/>\n"
    );
    let mut left = 0.0;
    for panel in panels {
        // Writing into a string does not fail.
        _ = writeln!(text, "<g transform=\"translate({left} 0)\">{}</g>", drawn(panel));
        left += WIDTH;
    }
    text + "</svg>\n"
}

/// The powers of ten around the values of a coordinate.
fn decades(panel: &Panel, coordinate: usize) -> [i32; 2] {
    let values = panel.series.iter().flat_map(|series| &series.points).map(|point| point[coordinate].log10());
    let [least, greatest] =
        values.fold([f64::MAX, f64::MIN], |[least, most], value| [least.min(value), most.max(value)]);
    // A few decades.
    #[allow(clippy::cast_possible_truncation)]
    let whole = [least.floor(), greatest.ceil()].map(|decade| decade as i32);
    [whole[0], whole[1].max(whole[0] + 1)]
}

fn drawn(panel: &Panel) -> String {
    let (across, up) = (decades(panel, 0), decades(panel, 1));
    let part = |value: f64, [from, to]: [i32; 2]| (value.log10() - f64::from(from)) / f64::from(to - from);
    let x = |value: f64| LEFT + part(value, across) * (WIDTH - LEFT - RIGHT);
    let y = |value: f64| HEIGHT - BOTTOM - part(value, up) * (HEIGHT - TOP - BOTTOM);
    let mut text = format!("<text x=\"{LEFT}\" y=\"18\" font-weight=\"bold\">{}</text>\n", panel.title);
    for decade in across[0]..=across[1] {
        let at = x(10f64.powi(decade));
        text += &format!(
            "<path d=\"M{at:.1} {TOP}V{:.1}\" stroke=\"#ddd\"/><text x=\"{at:.1}\" y=\"{:.1}\" \
             text-anchor=\"middle\">10<tspan dy=\"-4\" font-size=\"8\">{decade}</tspan></text>\n",
            HEIGHT - BOTTOM,
            HEIGHT - BOTTOM + 16.0
        );
    }
    for decade in up[0]..=up[1] {
        let at = y(10f64.powi(decade));
        text += &format!(
            "<path d=\"M{LEFT} {at:.1}H{:.1}\" stroke=\"#ddd\"/><text x=\"{:.1}\" y=\"{:.1}\" \
             text-anchor=\"end\">{}</text>\n",
            WIDTH - RIGHT,
            LEFT - 6.0,
            at + 4.0,
            10f64.powi(decade)
        );
    }
    for (index, series) in panel.series.iter().enumerate() {
        let colour = COLOURS[index % COLOURS.len()];
        let points: Vec<String> =
            series.points.iter().map(|point| format!("{:.1},{:.1}", x(point[0]), y(point[1]))).collect();
        let row = HEIGHT - BOTTOM - 10.0 - 14.0 * f64::from(u32::try_from(index).unwrap_or(0));
        text += &format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>\
             <text x=\"{:.1}\" y=\"{row:.1}\" fill=\"{colour}\">{}</text>\n",
            points.join(" "),
            LEFT + 8.0,
            series.name
        );
        for point in &series.points {
            text += &format!("<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"{colour}\"/>", x(point[0]), y(point[1]));
        }
    }
    text + &format!(
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}; upwards: million clocks a second</text>\n",
        (LEFT + WIDTH - RIGHT) / 2.0,
        HEIGHT - 8.0,
        panel.across
    )
}
