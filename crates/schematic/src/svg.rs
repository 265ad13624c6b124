//! A drawing as SVG: attributes alone, no style sheet, so that it is the same in a document and in a page that allows none.

use std::fmt::Write;

use stepwave_netlist::Net;

use crate::figure::{Figure, Font, Shape, Style};

const FONT: &str = r#"font-family="DejaVu Sans Mono, Menlo, Consolas, Liberation Mono, monospace" font-size="11""#;
const MARGIN: i32 = 10;

/// The file.
pub(crate) fn svg(figure: &Figure, title: &str) -> String {
    let [width, height] = [figure.size[0] + 2 * MARGIN, figure.size[1] + 2 * MARGIN];
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"schematic\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"{} {} {width} {height}\" {FONT} fill=\"#000\" stroke-linejoin=\"round\">\n<title>{}</title>\n",
        -MARGIN,
        -MARGIN,
        escaped(title)
    );
    // Frames of scopes first, then wires, so that neither hides a symbol.
    let scopes = |shape: &&Shape| matches!(shape, Shape::Frame { style: Style::Scope, .. });
    let wires = |shape: &&Shape| matches!(shape, Shape::Wire { .. } | Shape::Slash { .. });
    figure.shapes.iter().filter(scopes).for_each(|shape| one(&mut svg, shape));
    figure.shapes.iter().filter(wires).for_each(|shape| one(&mut svg, shape));
    figure.shapes.iter().filter(|shape| !scopes(shape) && !wires(shape)).for_each(|shape| one(&mut svg, shape));
    svg.push_str("</svg>\n");
    svg
}

fn one(svg: &mut String, shape: &Shape) {
    // Writing to a string cannot fail.
    let _ = match shape {
        Shape::Frame { at, style, cells, flags } => writeln!(svg, "{}/>", frame(*at, *style, cells, flags)),
        Shape::Closed { at, path, about, cells, flags } => {
            let look = "fill=\"#f2f2f2\" stroke=\"#000\" stroke-width=\"1.6\"";
            let open = rectangle(*at, ["closed", look], 4, cells, flags);
            writeln!(svg, "{open} data-scope=\"{}\"><title>{}</title></rect>", escaped(path), escaped(about))
        }
        Shape::Text { text, net: None, .. } if text.is_empty() => Ok(()),
        Shape::Text { at: [x, y], font, text, net } => {
            let (class, extra) = match font {
                Font::Title => ("title", " font-weight=\"bold\""),
                Font::Text => ("text", ""),
                Font::Small => ("width", " font-size=\"9\" fill=\"#555\""),
                Font::Value => ("value", " font-size=\"9\" fill=\"#0a5fb4\""),
            };
            let net = net.map_or_else(String::new, |net| format!(" data-net=\"{}\"", net.index()));
            writeln!(svg, "<text class=\"{class}\" x=\"{x}\" y=\"{y}\"{extra}{net}>{}</text>", escaped(text))
        }
        Shape::Sign { at: [x, y], text } => {
            writeln!(svg, "<text class=\"sign\" x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">{}</text>", escaped(text))
        }
        Shape::Clock { at: [x, y] } => {
            writeln!(svg, "<path class=\"clock\" d=\"M{x} {}l-7 4l7 4\" fill=\"none\" stroke=\"#000\"/>", y - 4)
        }
        Shape::Slash { at: [x, y] } => {
            writeln!(svg, "<path class=\"slash\" d=\"M{} {}l5 -8\" stroke=\"#000\"/>", x - 2, y + 4)
        }
        Shape::Wire { net, bits, lines, dots, ends } => {
            wire(svg, *net, *bits, [dots, ends], lines);
            Ok(())
        }
    };
}

fn frame(at: [i32; 4], style: Style, cells: &[Net], flags: &[String]) -> String {
    let (class, look) = match style {
        Style::Register => ("register", "fill=\"#e8eef7\" stroke=\"#000\" stroke-width=\"1.6\""),
        Style::Logic => ("logic", "fill=\"#fff\" stroke=\"#000\""),
        Style::Choice => ("choice", "fill=\"#f4f0e4\" stroke=\"#000\""),
        Style::Operator => ("operator", "fill=\"#fff\" stroke=\"#000\" stroke-width=\"1.4\""),
        Style::Memory => ("memory", "fill=\"#eaf3ea\" stroke=\"#000\" stroke-width=\"1.6\""),
        Style::Scope => ("scope", "fill=\"none\" stroke=\"#777\" stroke-dasharray=\"6 3\""),
        Style::Port => ("port", "fill=\"#fff\" stroke=\"#000\""),
    };
    let round = match style {
        Style::Operator => at[3] / 2,
        Style::Port => 9,
        Style::Scope => 4,
        _ => 0,
    };
    rectangle(at, [class, look], round, cells, flags)
}

/// A rectangle, but for the end of its tag.
fn rectangle(
    [x, y, width, height]: [i32; 4],
    [class, look]: [&str; 2],
    round: i32,
    cells: &[Net],
    flags: &[String],
) -> String {
    let mut more = String::new();
    if !cells.is_empty() {
        let cells: Vec<String> = cells.iter().map(|net| net.index().to_string()).collect();
        let _ = write!(more, " data-cells=\"{}\"", cells.join(" "));
    }
    if !flags.is_empty() {
        let _ = write!(more, " data-component=\"{}\"", flags.join(" "));
    }
    format!(
        "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"{round}\" {look}{more}"
    )
}

fn wire(svg: &mut String, net: Net, bits: u32, [dots, ends]: [&[[i32; 2]]; 2], lines: &[[i32; 4]]) {
    let thick = if bits > 1 { "2" } else { "1" };
    let class = if bits > 1 { "wire bus" } else { "wire" };
    let mut path = String::new();
    for [x0, y0, x1, y1] in lines {
        let _ = if y0 == y1 { write!(path, "M{x0} {y0}H{x1}") } else { write!(path, "M{x0} {y0}V{y1}") };
    }
    let index = net.index();
    let _ = writeln!(
        svg,
        "<path class=\"{class}\" data-net=\"{index}\" d=\"{path}\" fill=\"none\" stroke=\"#000\" stroke-width=\"{thick}\"/>"
    );
    for [x, y] in dots {
        let _ = writeln!(svg, "<circle class=\"dot\" data-net=\"{index}\" cx=\"{x}\" cy=\"{y}\" r=\"2.8\"/>");
    }
    for [x, y] in ends {
        let _ = writeln!(svg, "<path class=\"end\" data-net=\"{index}\" d=\"M{x} {y}l-6 -3v6z\"/>");
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
